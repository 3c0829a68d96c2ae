//! Where a conversion states its own error correctly.
//!
//! This explains the rule r σ_θ²/σ_r < 0.4, σ_θ < 0.4 rad, and the two senses in which a conversion's covariance can be right. Everything
//! is a closed form of the exact moments ([`conversion_moments`](super::conversion_moments)) in two numbers: ρ = r σ_θ²/σ_r, which is
//! twice the bias r σ_θ²/2 of the plain conversion in units of σ_r, and σ_θ itself.
//!
//! ```text
//! as σ_θ tends to 0 at the same ρ   standard       additive, multiplicative   modified unbiased
//! bias along, in σ_r                −ρ/2           0                          −ρ
//! along the measured line of sight
//!   mean squared error, in σ_r²     1 + ¾ρ²        1 + 3/2 ρ²                 1 + ½ρ²
//!   claimed, in σ_r²                1              1 + 3/2 ρ²                 1 + ½ρ²
//! along the true line of sight
//!   mean squared error, in σ_r²     1 + ¾ρ²        1 + ½ρ²                    1 + 3/2 ρ²
//!   claimed on average, in σ_r²     1 + ρ²         1 + 5/2 ρ²                 1 + 3/2 ρ²
//! ```
//!
//! So at ρ = 0.4 the standard conversion is off by 0.2 σ_r, and its mean squared error along the line of sight that it takes for true is
//! 1.12 of what it claims; at σ_θ = 0.4 rad, the other half of the rule, it is 0.86 across ((1 − w⁴)/2 against σ_θ²). Modified unbiased is
//! right in both senses. The other two are right in the axes of the measurement only: on average over measurements they claim more than
//! their error, as the variance across leaks into that along.

use super::conversion::Conversion;
use super::conversion_moments::{errors_as_measured, mean_squared_errors, over_bearings};
use crate::number::Field;

/// How a conversion's error compares with its claim, given the truth.
#[derive(Debug, Clone, PartialEq)]
pub struct Validity<T> {
    /// The mean of z along the line of sight less the true range, in σ_r.
    pub bias: T,
    /// Mean squared errors along and across the measured line of sight over the variances that are claimed there, on average over r.
    pub as_measured: [T; 2],
    /// Mean squared errors along and across the true line of sight over the average of the covariance that is claimed.
    pub as_true: [T; 2],
}

/// The nonlinearity ρ of a radar at a range.
///
/// ```text
/// ρ = r σ_θ²/σ_r
/// ```
///
/// Why: the arc on which the measurements lie bends by r σ_θ²/2 over one deviation of the bearing; ρ compares that with σ_r.
///
/// Source: Bar-Shalom, Li and Kirubarajan 2001, section 10.4.3, where it is to be below 0.4.
///
/// Example: a radar with σ_r = 10 m at 1 km, with σ_θ = 1/50 rad, which is about one degree, and four times that: inside the rule, and
/// beyond.
///
/// ```
/// use immaculate::{model::conversion_validity::nonlinearity, number::Rational};
///
/// let q = Rational::new;
/// let at_deviation = |deviation: Rational| nonlinearity(&q(1000, 1), &q(10, 1), &(deviation.clone() * deviation));
/// // 1000 · (1/50)² / 10, and sixteen times as much
/// assert_eq!(at_deviation(q(1, 50)), q(4, 100));
/// assert_eq!(at_deviation(q(4, 50)), q(64, 100));
/// ```
///
/// Evidence: `a_conversion_is_as_valid_as_its_nonlinearity_says` (symbolic).
pub fn nonlinearity<T: Field>(range: &T, range_deviation: &T, bearing_variance: &T) -> T {
    range.clone() * bearing_variance.clone() / range_deviation.clone()
}

/// How a conversion's error compares with its claim, from ρ, σ_θ² and w = e^(−σ_θ²/2).
///
/// ```text
/// r = ρ/σ_θ², σ_r = 1;   claimed: the variances a, b of the conversion, linear in r²
/// as measured:  E[(uᵀ(z − x))²] / a(r² + σ_r²),   E[(nᵀ(z − x))²] / b(r² + σ_r²)
/// as true:      the entries of E[(z − x)(z − x)ᵀ] over those of E[R], along and across
/// ```
///
/// Source: the moments of [`conversion_moments`](super::conversion_moments); R is linear in r̂², and E r̂² = r² + σ_r².
///
/// Example: the rule of thumb at its limit, ρ = 0.4, for the standard conversion at one degree.
///
/// ```
/// use immaculate::model::Conversion;
/// use immaculate::model::conversion_moments::attenuation;
/// use immaculate::model::conversion_validity::validity;
///
/// let variance = 1.0_f64.to_radians() * 1.0_f64.to_radians();
/// let at_limit = validity(Conversion::Standard, &0.4, &variance, &attenuation(&variance));
/// // −ρ/2, 1 + ¾ρ² and (1 + ¾ρ²)/(1 + ρ²) hold as σ_θ tends to zero; at one degree σ_θ² = 0.0003 is left of them.
/// assert!((at_limit.bias - -0.2).abs() < 1e-3);
/// assert!((at_limit.as_measured[0] - 1.12).abs() < 1e-3);
/// assert!((at_limit.as_true[0] - 1.12 / 1.16).abs() < 1e-3);
/// ```
///
/// Evidence: `a_conversion_is_as_valid_as_its_nonlinearity_says` (symbolic), `errors_and_claims_are_those_of_runs` (consistency).
pub fn validity<T: Field>(
    conversion: Conversion,
    nonlinearity: &T,
    bearing_variance: &T,
    attenuation: &T,
) -> Validity<T> {
    let (one, w) = (T::one(), attenuation);
    let range = nonlinearity.clone() / bearing_variance.clone();
    let squared_range = range.clone() * range.clone();
    let factor = conversion.factor(w);
    let claimed = conversion.variances(&(squared_range.clone() + T::one()), &one, bearing_variance, w);
    Validity {
        bias: range * (factor.clone() * w.clone() - T::one()),
        as_measured: quotients(errors_as_measured(&factor, &squared_range, &one, w), &claimed),
        as_true: quotients(
            mean_squared_errors(&factor, &squared_range, &one, w),
            &over_bearings(&claimed, w),
        ),
    }
}

/// Entry by entry.
fn quotients<T: Field>([a, b]: [T; 2], [c, d]: &[T; 2]) -> [T; 2] {
    [a / c.clone(), b / d.clone()]
}
