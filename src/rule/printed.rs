//! The weights that the papers print wrongly, as they are printed.
//!
//! After this file the reader can run what the papers literally say, and see in which moment it breaks. Nothing else in this
//! crate uses these forms but the tests and the ledger of claims.

use super::{ExactRule, InvalidRule, dimension_as_rational, fifth_degree, simplex};
use crate::number::{Field, Rational};

/// The fifth-degree rule with w₂ as zhu2016 (13) prints it.
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
pub fn diagonal_weight<T: Field>(n: &T) -> T {
    let n_plus_2 = n.clone() + T::integer(2);
    T::integer(2) / (n_plus_2.clone() * n_plus_2)
}

/// The simplex rule with the edges' weight as liu2017 (11) prints it.
///
/// # Errors
///
/// As [`simplex::simplex`].
pub fn simplex_11(n: usize) -> Result<ExactRule, InvalidRule> {
    simplex_with_edge_weight(n, &edge_weight_11(&dimension_as_rational(n)))
}

/// The simplex rule with the edges' weight as liu2017 (16) prints it.
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
pub fn edge_weight_11<T: Field>(n: &T) -> T {
    simplex::edge_weight(n) / T::integer(2)
}

/// liu2017 (16) as printed: 2(n−1)² / (n(n+1)²(n+2)²), an n-th of the right weight.
pub fn edge_weight_16<T: Field>(n: &T) -> T {
    simplex::edge_weight(n) / n.clone()
}

/// liu2017 (4) as printed, vertices: (7−n)n² / (2(n+1)²(n+2)²) of the sphere's surface.
pub fn sphere_vertex_weight<T: Field>(n: &T) -> T {
    simplex::vertex_weight(n)
}

/// liu2017 (4) as printed, edges: 2(n−1)² / (2(n+1)²(n+2)²) of the sphere's surface.
pub fn sphere_edge_weight<T: Field>(n: &T) -> T {
    edge_weight_11(n)
}
