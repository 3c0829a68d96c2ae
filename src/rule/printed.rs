//! The misprinted weights of the papers, exactly as printed.
//!
//! They can be run to see which moment they get wrong. Only the tests and the ledger of claims use them.

use super::{ExactRule, InvalidRule, dimension_as_rational, fifth_degree, simplex};
use crate::number::{Field, Rational};

/// The fifth-degree rule with w₂ as zhu2016 (13) prints it.
///
/// Example: for n = 2: 1/2 + 4 · 1/16 + 4 · 2/16 for 1/2 + 4 · 1/16 + 4 · 1/16.
///
/// ```
/// use immaculate::rule::{fifth_degree, printed};
///
/// assert_eq!(printed::fifth_degree(2).unwrap().sum_of_weights().to_string(), "5/4");
/// assert_eq!(fifth_degree::fifth_degree(2).unwrap().sum_of_weights().to_string(), "1");
/// ```
///
/// # Errors
///
/// As [`fifth_degree::fifth_degree`].
pub fn fifth_degree(n: usize) -> Result<ExactRule, InvalidRule> {
    let n_exact: Rational = dimension_as_rational(n);
    fifth_degree::with_weights(
        n,
        fifth_degree::centre_weight(&n_exact),
        fifth_degree::axis_weight(&n_exact),
        diagonal_weight(&n_exact),
    )
}

/// zhu2016 (13) as printed: w₂ = 2/(n + 2)², twice the right weight.
///
/// Example: for n = 2: 2/16, where the rule needs 1/16.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::printed;
///
/// assert_eq!(printed::diagonal_weight(&Rational::new(2, 1)), Rational::new(1, 8));
/// ```
pub fn diagonal_weight<T: Field>(n: &T) -> T {
    let n_plus_2 = n.clone() + T::integer(2);
    T::integer(2) / (n_plus_2.clone() * n_plus_2)
}

/// The simplex rule with the edges' weight as liu2017 (11) prints it.
///
/// Example: for n = 2: 1/2 + 6 · 5/72 + 6 · 1/144, where the last weight should be 1/72.
///
/// ```
/// use immaculate::rule::printed;
///
/// assert_eq!(printed::simplex_11(2).unwrap().sum_of_weights().to_string(), "23/24");
/// assert_eq!(printed::simplex_11(4).unwrap().sum_of_weights().to_string(), "4/5");
/// ```
///
/// # Errors
///
/// As [`simplex::simplex`].
pub fn simplex_11(n: usize) -> Result<ExactRule, InvalidRule> {
    simplex_with_edge_weight(n, &edge_weight_11(&dimension_as_rational(n)))
}

/// The simplex rule with the edges' weight as liu2017 (16) prints it.
///
/// Example: at n = 2 both wrong weights are half of the right one; at n = 4 this one is a fourth.
///
/// ```
/// use immaculate::rule::printed;
///
/// assert_eq!(printed::simplex_16(2).unwrap().sum_of_weights().to_string(), "23/24");
/// assert_eq!(printed::simplex_16(4).unwrap().sum_of_weights().to_string(), "7/10");
/// ```
///
/// # Errors
///
/// As [`simplex::simplex`].
pub fn simplex_16(n: usize) -> Result<ExactRule, InvalidRule> {
    simplex_with_edge_weight(n, &edge_weight_16(&dimension_as_rational(n)))
}

fn simplex_with_edge_weight(n: usize, edge: &Rational) -> Result<ExactRule, InvalidRule> {
    let n_exact: Rational = dimension_as_rational(n);
    simplex::with_weights(
        n,
        &simplex::centre_weight(&n_exact),
        &simplex::vertex_weight(&n_exact),
        edge,
    )
}

/// liu2017 (11) as printed: 2(n−1)² / (2(n+1)²(n+2)²), half of the right weight.
///
/// Example: for n = 2: 2/(2 · 9 · 16), where the rule needs 2/(9 · 16) = 1/72.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::printed;
///
/// assert_eq!(printed::edge_weight_11(&Rational::new(2, 1)), Rational::new(1, 144));
/// ```
pub fn edge_weight_11<T: Field>(n: &T) -> T {
    simplex::edge_weight(n) / T::integer(2)
}

/// liu2017 (16) as printed: 2(n−1)² / (n(n+1)²(n+2)²), an n-th of the right weight.
///
/// Example: for n = 4: 2 · 9/(4 · 25 · 36), where the rule needs 2 · 9/(25 · 36) = 1/50.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::printed;
///
/// assert_eq!(printed::edge_weight_16(&Rational::new(4, 1)), Rational::new(1, 200));
/// ```
pub fn edge_weight_16<T: Field>(n: &T) -> T {
    simplex::edge_weight(n) / n.clone()
}

/// liu2017 (4) as printed, vertices: (7−n)n² / (2(n+1)²(n+2)²) of the sphere's surface.
///
/// Example: for n = 2: 5 · 4/(2 · 9 · 16), half of the right part of the sphere's surface: n/(n + 2) = 1/2.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::{printed, simplex};
///
/// let n = Rational::new(2, 1);
/// assert_eq!(printed::sphere_vertex_weight(&n), Rational::new(5, 72));
/// assert_eq!(simplex::sphere_vertex_weight(&n), Rational::new(5, 36));
/// ```
pub fn sphere_vertex_weight<T: Field>(n: &T) -> T {
    simplex::vertex_weight(n)
}

/// liu2017 (4) as printed, edges: 2(n−1)² / (2(n+1)²(n+2)²) of the sphere's surface.
///
/// Example: for n = 2, 6 vertices and 6 midpoints: 6 · 5/72 + 6 · 1/144 is less than half of the sphere.
///
/// ```
/// use immaculate::number::{Field, Rational};
/// use immaculate::rule::printed;
///
/// let n = Rational::new(2, 1);
/// let six = Rational::integer(6);
/// let sum = six.clone() * printed::sphere_vertex_weight(&n) + six * printed::sphere_edge_weight(&n);
/// assert_eq!(sum, Rational::new(11, 24));
/// ```
pub fn sphere_edge_weight<T: Field>(n: &T) -> T {
    edge_weight_11(n)
}
