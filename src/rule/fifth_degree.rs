//! The fifth-degree rule of zhu2016: the centre, 2n points on the axes and 2n(n − 1) on the diagonals of the coordinate planes.
//!
//! Points and weights are numbered as in the paper. One weight is printed twice too large.

use super::{ExactRule, InvalidRule, along_axis, dimension_as_rational, opposite};
use crate::number::{Field, Rational, Surd};
use num_traits::Zero;

/// The fifth-degree spherical-radial rule — zhu2016 (2)-(8).
///
/// ```text
/// ξ = 0;   ±√(n+2) eᵢ, i = 1…n;   ±√(n+2) s⁺ᵢ, ±√(n+2) s⁻ᵢ, i = 1…n(n−1)/2
/// ```
///
/// | paper          | here                        | number    | weight                  |
/// |----------------|-----------------------------|-----------|-------------------------|
/// | X₀             | the centre                  | 1         | w₀, [`centre_weight`]   |
/// | X₁, X₂         | ± on the axes               | 2n        | w₁, [`axis_weight`]     |
/// | X₃, X₄         | ± on [`diagonals_plus`]     | n(n − 1)  | w₂, [`diagonal_weight`] |
/// | X₅, X₆         | ± on [`diagonals_minus`]    | n(n − 1)  | w₂                      |
///
/// Here the points of the standard Gaussian; a filter moves them to S ξ + x̂.
///
/// Why: the axes and the diagonals together integrate every polynomial of degree five over the sphere (Stroud's Uₙ 5-1), and
/// the centre with the radius √(n+2) gets the radial moments E r² = n and E r⁴ = n(n + 2) right.
///
/// Example: for n = 2: the centre, 4 points on the axes, 4 on the diagonals, at the distance √4.
///
/// ```
/// use immaculate::number::{Rational, Surd};
/// use immaculate::rule::fifth_degree::fifth_degree;
///
/// let rule = fifth_degree(2).unwrap();
/// let root = Surd::root(&Rational::new(2, 1));
/// assert_eq!(rule.points[1], [Surd::root(&Rational::new(4, 1)), Surd::root(&Rational::new(0, 1))]); // (2, 0)
/// assert_eq!(rule.points[5], [root.clone(), root]); // 2 · √½ (1, 1)
/// // 1/2 + 4 · 1/16 + 4 · 1/16
/// assert_eq!(rule.sum_of_weights(), Rational::new(1, 1));
/// ```
///
/// Errata: the index i of the centre point in (2) is superfluous (notational).
///
/// # Errors
///
/// [`InvalidRule::Dimension`] in dimension zero.
///
/// Evidence: `fifth_degree_rule_is_exact_to_degree_five_and_not_six` (exact, n = 1…10),
/// `fifth_degree_rule_has_degree_five_in_every_dimension` (symbolic).
pub fn fifth_degree(n: usize) -> Result<ExactRule, InvalidRule> {
    let n_exact: Rational = dimension_as_rational(n);
    with_weights(
        n,
        centre_weight(&n_exact),
        axis_weight(&n_exact),
        diagonal_weight(&n_exact),
    )
}

/// The points of [`fifth_degree`] with the given weights of the centre, the axes and the diagonals.
pub(super) fn with_weights(
    n: usize,
    centre: Rational,
    axis: Rational,
    diagonal: Rational,
) -> Result<ExactRule, InvalidRule> {
    if n == 0 {
        return Err(InvalidRule::Dimension {
            rule: "cubature-5",
            least: 1,
            dimension: n,
            reason: "",
        });
    }
    let radius = Surd::root(&dimension_as_rational(n + 2));
    let axes: Vec<_> = (0..n).map(|i| along_axis(n, i, &radius)).collect();
    let plus = scaled(&diagonals_plus(n), &radius);
    let minus = scaled(&diagonals_minus(n), &radius);
    Ok(ExactRule::from_orbits(
        n,
        vec![
            (centre, vec![vec![Surd::zero(); n]]), // X₀
            (axis.clone(), axes.clone()),          // X₁
            (axis, opposite(&axes)),               // X₂
            (diagonal.clone(), plus.clone()),      // X₃
            (diagonal.clone(), opposite(&plus)),   // X₄
            (diagonal.clone(), minus.clone()),     // X₅
            (diagonal, opposite(&minus)),          // X₆
        ],
    ))
}

/// The directions s⁺ of the diagonals — zhu2016 (9).
///
/// ```text
/// s⁺ = √½ (eⱼ + eₗ),   j < l
/// ```
///
/// The pairs (j, l) come in lexicographic order; sums over the points do not depend on it.
///
/// Example: n = 2 has one pair (1, 2), n = 3 has three: (1, 2), (1, 3), (2, 3).
///
/// ```
/// use immaculate::number::{Rational, Surd};
/// use immaculate::rule::fifth_degree::diagonals_plus;
///
/// let half = Surd::root(&Rational::new(1, 2));
/// assert_eq!(diagonals_plus(2), [[half.clone(), half]]);
/// assert_eq!(diagonals_plus(3).len(), 3);
/// ```
///
/// Evidence: as [`fifth_degree`].
pub fn diagonals_plus(n: usize) -> Vec<Vec<Surd>> {
    diagonals(n, &Surd::root(&Rational::new(1, 2)))
}

/// The directions s⁻ of the diagonals — zhu2016 (10).
///
/// ```text
/// s⁻ = √½ (eⱼ − eₗ),   j < l
/// ```
///
/// Example: for n = 2, √½ (1, −1).
///
/// ```
/// use immaculate::number::{Rational, Surd};
/// use immaculate::rule::fifth_degree::diagonals_minus;
///
/// let half = Surd::root(&Rational::new(1, 2));
/// assert_eq!(diagonals_minus(2), [[half.clone(), -half]]);
/// ```
///
/// Evidence: as [`fifth_degree`].
pub fn diagonals_minus(n: usize) -> Vec<Vec<Surd>> {
    diagonals(n, &-Surd::root(&Rational::new(1, 2)))
}

/// √½ eⱼ + `second` eₗ for all j < l.
fn diagonals(n: usize, second: &Surd) -> Vec<Vec<Surd>> {
    let mut directions = Vec::new();
    for j in 0..n {
        for l in j + 1..n {
            let mut direction = along_axis(n, j, &Surd::root(&Rational::new(1, 2)));
            direction[l] = second.clone();
            directions.push(direction);
        }
    }
    directions
}

/// Points times a radius.
fn scaled(points: &[Vec<Surd>], radius: &Surd) -> Vec<Vec<Surd>> {
    points
        .iter()
        .map(|point| {
            point
                .iter()
                .map(|coordinate| coordinate.clone() * radius.clone())
                .collect()
        })
        .collect()
}

/// Weight of the centre — zhu2016 (11): w₀ = 2/(n + 2).
///
/// Why: the radial rule. With weight W on the sphere of radius √(n+2), E r² = n asks for W = n/(n + 2); the centre has the rest.
///
/// Example: 2/(2 + 2) and 2/(4 + 2).
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::fifth_degree::centre_weight;
///
/// assert_eq!(centre_weight(&Rational::new(2, 1)), Rational::new(1, 2));
/// assert_eq!(centre_weight(&Rational::new(4, 1)), Rational::new(1, 3));
/// ```
///
/// Evidence: as [`fifth_degree`].
pub fn centre_weight<T: Field>(n: &T) -> T {
    T::integer(2) / (n.clone() + T::integer(2))
}

/// Weight of each of the 2n points on the axes — zhu2016 (12): w₁ = (4 − n) / (2(n + 2)²).
///
/// Why: Stroud's weight (4 − n)/(2n(n + 2)) on the unit sphere, times n/(n + 2) of the radial rule. Positive for n < 4, zero at
/// n = 4 (8 of the 33 points then count for nothing), negative for n > 4.
///
/// Example: (4 − 2)/(2 · 16), (4 − 4)/(2 · 36), (4 − 5)/(2 · 49).
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::fifth_degree::axis_weight;
///
/// assert_eq!(axis_weight(&Rational::new(2, 1)), Rational::new(1, 16));
/// assert_eq!(axis_weight(&Rational::new(4, 1)), Rational::new(0, 1));
/// assert_eq!(axis_weight(&Rational::new(5, 1)), Rational::new(-1, 98));
/// ```
///
/// Evidence: as [`fifth_degree`], `signs_of_the_weights_are_as_documented` (exact).
pub fn axis_weight<T: Field>(n: &T) -> T {
    let n_plus_2 = n.clone() + T::integer(2);
    (T::integer(4) - n.clone()) / (T::integer(2) * n_plus_2.clone() * n_plus_2)
}

/// Weight of each of the 2n(n − 1) points on the diagonals — zhu2016 (13): w₂ = 1/(n + 2)².
///
/// Why: Stroud's weight 1/(n(n + 2)) on the unit sphere, times n/(n + 2) of the radial rule.
///
/// Example: for n = 4: 1 centre, 8 points on the axes, 24 on the diagonals.
///
/// ```
/// use immaculate::number::{Field, Rational};
/// use immaculate::rule::fifth_degree::{axis_weight, centre_weight, diagonal_weight};
/// use immaculate::rule::printed;
///
/// let n = Rational::new(4, 1);
/// let sum = |w2: Rational| centre_weight(&n) + Rational::integer(8) * axis_weight(&n) + Rational::integer(24) * w2;
/// // 1/3 + 8 · 0 + 24 · 1/36
/// assert_eq!(sum(diagonal_weight(&n)), Rational::new(1, 1));
/// // As printed: 1/3 + 8 · 0 + 24 · 2/36
/// assert_eq!(sum(printed::diagonal_weight(&n)), Rational::new(5, 3));
/// ```
///
/// Errata: the paper prints 2/(n + 2)², with which the weights sum to (3n² + 2n + 4)/(n + 2)², that is 5/3 at n = 4, and a
/// filter of the paper's scenario is off by a hundred metres after one step and has no covariance after two; see
/// [`printed`](super::printed::diagonal_weight).
///
/// Evidence: as [`fifth_degree`], `printed_fifth_degree_weight_breaks_the_zeroth_moment` (exact).
pub fn diagonal_weight<T: Field>(n: &T) -> T {
    let n_plus_2 = n.clone() + T::integer(2);
    T::one() / (n_plus_2.clone() * n_plus_2)
}
