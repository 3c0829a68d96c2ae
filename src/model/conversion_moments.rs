//! The exact moments of a converted measurement x = r cos θ, y = r sin θ under Gaussian noise of range and bearing.
//!
//! Every conversion of [`conversion`](super::conversion) is judged against these moments. They all follow from one expectation:
//!
//! ```text
//! E[cos mθ̃] = e^(−m²σ²/2) = w^(m²),   E[sin mθ̃] = 0,   w = e^(−σ²/2)
//!
//! u = (cos θ, sin θ)   along the line of sight,   n = (−sin θ, cos θ)   across it
//! E[u(θ + θ̃)]               = w u
//! E[u(θ + θ̃) u(θ + θ̃)ᵀ]     = ½(1 + w⁴) u uᵀ + ½(1 − w⁴) n nᵀ
//! ```
//!
//! The noise enters with either sign alike. So the same functions hold in both directions: for what is measured when the truth is given,
//! and, where nothing is known of range and bearing before (a flat prior in both), for the truth when the measurement is given.
//!
//! Every matrix here is diagonal along and across the line of sight, and is written as these two variances;
//! [`in_the_plane`](super::conversion::in_the_plane) turns them.

use crate::number::{Field, Real};

/// The attenuation of a bearing's noise: E[cos θ̃].
///
/// ```text
/// w = e^(−σ_θ²/2)
/// ```
///
/// Why: θ̃ has the moments E[θ̃²ᵏ] = (2k − 1)!! σ²ᵏ, and (2k − 1)!!/(2k)! = 1/(2ᵏ k!), so that E[cos mθ̃] = Σ (−m²σ²/2)ᵏ/k!.
///
/// Source: the characteristic function of a Gaussian.
///
/// Example: a noise of one degree takes 0.15 ‰ of the range away, one of 20° takes 6 %.
///
/// ```
/// use immaculate::model::conversion_moments::attenuation;
///
/// let of_degrees = |degrees: f64| attenuation(&(degrees.to_radians() * degrees.to_radians()));
/// assert_eq!((1e5 * of_degrees(1.0)).round(), 99_985.0);
/// assert_eq!((1e2 * of_degrees(20.0)).round(), 94.0);
/// ```
///
/// Evidence: `the_mean_cosine_of_a_gaussian_angle_is_the_exponential` (enclosed).
pub fn attenuation<T: Real>(bearing_variance: &T) -> T {
    (-bearing_variance.clone() / T::integer(2)).exp()
}

/// The second moments E[z zᵀ] of a converted measurement z = r u, along and across the line of sight, m².
///
/// ```text
/// E[z zᵀ] = (r² + σ_r²) ( ½(1 + w⁴) u uᵀ + ½(1 − w⁴) n nᵀ )
/// ```
///
/// | symbol | here             | unit | meaning                                                   |
/// |--------|------------------|------|-----------------------------------------------------------|
/// | r²     | `squared_range`  | m²   | of the truth; or of the measurement, for E[x xᵀ ∣ z]       |
/// | σ_r²   | `range_variance` | m²   |                                                           |
/// | w      | `attenuation`    |      | [`attenuation`](fn@attenuation)                            |
///
/// Source: the head of this file, and E[(r + r̃)²] = r² + σ_r².
///
/// Example: at 10 m, with σ_r² = 4 m² and w² = 1/2, the mean square of 104 m² is shared five to three.
///
/// ```
/// use immaculate::model::conversion_moments::second_moments;
/// use immaculate::number::{Field, Rational, Surd};
///
/// let w = Surd::root(&Rational::new(1, 2));
/// // ½ · (1 + ¼) · 104, ½ · (1 − ¼) · 104
/// assert_eq!(second_moments(&Surd::integer(100), &Surd::integer(4), &w), [65, 39].map(Surd::integer));
/// ```
///
/// Evidence: `the_moments_are_those_of_range_and_bearing` (symbolic).
pub fn second_moments<T: Field>(squared_range: &T, range_variance: &T, attenuation: &T) -> [T; 2] {
    over_bearings(
        &[squared_range.clone() + range_variance.clone(), T::zero()],
        attenuation,
    )
}

/// What two variances along and across the line of sight are on average over the noise of the bearing.
///
/// ```text
/// E[a u uᵀ + b n nᵀ] = ½[(1 + w⁴) a + (1 − w⁴) b] u uᵀ + ½[(1 − w⁴) a + (1 + w⁴) b] n nᵀ
/// ```
///
/// Source: the head of this file; n nᵀ is I − u uᵀ.
///
/// Example: without noise nothing is mixed; where all bearings are equally likely, w = 0, both get the mean.
///
/// ```
/// use immaculate::model::conversion_moments::over_bearings;
///
/// assert_eq!(over_bearings(&[3.0, 1.0], &1.0), [3.0, 1.0]);
/// assert_eq!(over_bearings(&[3.0, 1.0], &0.0), [2.0, 2.0]);
/// ```
///
/// Evidence: `the_moments_are_those_of_range_and_bearing` (symbolic).
pub fn over_bearings<T: Field>([along, across]: &[T; 2], attenuation: &T) -> [T; 2] {
    let squared = attenuation.clone() * attenuation.clone();
    let fourth = squared.clone() * squared;
    let (stays, turns) = (
        (T::one() + fourth.clone()) / T::integer(2),
        (T::one() - fourth) / T::integer(2),
    );
    [
        stays.clone() * along.clone() + turns.clone() * across.clone(),
        turns * along.clone() + stays * across.clone(),
    ]
}

/// The mean squared error of a measurement that is converted with a factor, z = f r u, along and across, m².
///
/// ```text
/// E[(z − x)(z − x)ᵀ] = f² E[r u (r u)ᵀ] − (2 f w − 1) r² u uᵀ
/// ```
///
/// | symbol | here             | unit | meaning                                    |
/// |--------|------------------|------|--------------------------------------------|
/// | f      | `factor`         |      | [`Conversion::factor`](super::conversion::Conversion::factor) |
/// | r²     | `squared_range`  | m²   | of the truth                               |
/// | σ_r²   | `range_variance` | m²   |                                            |
/// | w      | `attenuation`    |      | [`attenuation`](fn@attenuation)             |
///
/// Source: the square multiplied out, with `E[z] = f w r u` and `x = r u`.
///
/// Example: as there, with the factor 1. Of the 65 m² along the line of sight (2w − 1) r² = 41.4 m² are no error.
///
/// ```
/// use immaculate::model::conversion_moments::mean_squared_errors;
/// use immaculate::number::{Field, Rational, Surd};
///
/// let w = Surd::root(&Rational::new(1, 2));
/// let [one, range, noise] = [1, 100, 4].map(Surd::integer);
/// // 65 − (√2 − 1) · 100, and 39
/// let along = Surd::integer(165) - Surd::integer(100) * Surd::root(&Rational::new(2, 1));
/// assert_eq!(mean_squared_errors(&one, &range, &noise, &w), [along, Surd::integer(39)]);
/// ```
///
/// Evidence: `the_moments_are_those_of_range_and_bearing` (symbolic).
pub fn mean_squared_errors<T: Field>(factor: &T, squared_range: &T, range_variance: &T, attenuation: &T) -> [T; 2] {
    let f = || factor.clone();
    let [along, across] = second_moments(squared_range, range_variance, attenuation);
    let crossed = T::integer(2) * f() * attenuation.clone() - T::one();
    [f() * f() * along - crossed * squared_range.clone(), f() * f() * across]
}

/// The mean squared error along and across the line of sight as it is measured, m²: what a filter sees that trusts the measurement.
///
/// ```text
/// E[(uᵀ(z − x))²] = E[(f r̂ − r cos θ̃)²] = f² (r² + σ_r²) − 2 f w r² + ½(1 + w⁴) r²
/// E[(nᵀ(z − x))²] = E[(r sin θ̃)²]        = ½(1 − w⁴) r²
/// ```
///
/// The arguments are those of [`mean_squared_errors`]; u and n are those of the measured bearing, r̂ is the measured range.
///
/// Why: R is diagonal in these axes, so here an error meets the variance that is claimed for it. In the axes of the truth, which nobody
/// knows, the claim is averaged over bearings, and the large variance across leaks into the small one along.
///
/// Source: the squares multiplied out.
///
/// Example: as before, in the axes of the measurement: 25.1 m² along for 23.6, and 37.5 across for 39.
///
/// ```
/// use immaculate::model::conversion_moments::errors_as_measured;
/// use immaculate::number::{Field, Rational, Surd};
///
/// let w = Surd::root(&Rational::new(1, 2));
/// let [one, range, noise] = [1, 100, 4].map(Surd::integer);
/// // 104 − √2 · 100 + ½ · (1 + ¼) · 100, and ½ · (1 − ¼) · 100
/// let along = Surd::ratio(333, 2) - Surd::integer(100) * Surd::root(&Rational::new(2, 1));
/// assert_eq!(errors_as_measured(&one, &range, &noise, &w), [along, Surd::ratio(75, 2)]);
/// ```
///
/// Evidence: `the_moments_are_those_of_range_and_bearing` (symbolic).
pub fn errors_as_measured<T: Field>(factor: &T, squared_range: &T, range_variance: &T, attenuation: &T) -> [T; 2] {
    let f = || factor.clone();
    let [turned, across] = second_moments(squared_range, &T::zero(), attenuation);
    let measured = f() * f() * (squared_range.clone() + range_variance.clone());
    let crossed = T::integer(2) * f() * attenuation.clone() * squared_range.clone();
    [measured - crossed + turned, across]
}
