//! The third-degree rule: 2n points on the axes, equal weights.
//!
//! This is the rule of the cubature Kalman filter, the smallest fully symmetric rule with the right mean and covariance.

use super::{ExactRule, InvalidRule, along_axis, dimension_as_rational, opposite};
use crate::number::{Field, Rational, Surd};

/// The third-degree spherical-radial rule.
///
/// ```text
/// ξₛ = ±√n eᵢ,   wₛ = 1/(2n),   i = 1…n
/// ```
///
/// Source: Arasaratnam and Haykin, Cubature Kalman Filters, IEEE Transactions on Automatic Control 54(6), 2009; the rule of
/// the filter that both papers compare themselves with (IMMCKF).
///
/// Example: for n = 2: (±√2, 0) and (0, ±√2), each with 1/4, so that E x₁² = 2 · 1/4 · 2 = 1.
///
/// ```
/// use immaculate::rule::third_degree::third_degree;
///
/// let rule = third_degree(2).unwrap();
/// assert_eq!(format!("{} {}", rule.points[0][0], rule.points[2][0]), "√2 -√2");
/// assert_eq!(rule.weights[0].to_string(), "1/4");
/// ```
///
/// # Errors
///
/// [`InvalidRule::Dimension`] in dimension zero.
///
/// Evidence: `third_degree_rule_is_exact_to_degree_three_and_not_four` (exact, n = 1…10),
/// `third_degree_rule_has_degree_three_in_every_dimension` (symbolic).
pub fn third_degree(n: usize) -> Result<ExactRule, InvalidRule> {
    if n == 0 {
        return Err(InvalidRule::Dimension {
            rule: "cubature-3",
            least: 1,
            dimension: n,
            reason: "",
        });
    }
    let radius = Surd::root(&dimension_as_rational(n));
    let axes: Vec<_> = (0..n).map(|i| along_axis(n, i, &radius)).collect();
    let mut points = axes.clone();
    points.extend(opposite(&axes));
    let weight: Rational = axis_weight(&dimension_as_rational(n));
    Ok(ExactRule::from_orbits(n, vec![(weight, points)]))
}

/// The weight of each of the 2n points, 1/(2n).
///
/// Source: as [`third_degree`].
///
/// Example: for n = 2.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::third_degree::axis_weight;
///
/// assert_eq!(axis_weight(&Rational::new(2, 1)), Rational::new(1, 4)); // 1/(2 · 2)
/// ```
pub fn axis_weight<T: Field>(n: &T) -> T {
    T::one() / (T::integer(2) * n.clone())
}
