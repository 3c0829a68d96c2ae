//! The steady gains of the two models of derbez2000 in closed form.
//!
//! One number decides them: the tracking index Λ, which compares the target's random motion in one scan with the accuracy of the
//! measurement. Another number is easier to compute with, the *damping root* θ = √(1 − α): every gain is a polynomial or a small fraction
//! in θ, so a rational θ gives a filter in rationals.
//!
//! ```text
//!                          Λ                    α         β             γ
//! constant velocity        2(1 − θ)²/θ          1 − θ²    2(1 − θ)²
//! constant acceleration    2(1 − θ)³/(θ(1 + θ)) 1 − θ²    2(1 − θ)²     β²/α = 4(1 − θ)³/(1 + θ)
//! ```
//!
//! The gain is K = [α, β/t, γ/(2t²)]ᵀ, and the innovation variance S = R/(1 − α) = R/θ². As the target becomes predictable, Λ → 0, θ tends
//! to one; as it becomes erratic, θ tends to zero and the filter believes its last measurement.
//!
//! That these gains solve the Riccati equation is proven for all θ at once in `tests/symbolic.rs`; that they are the ones of the only
//! solution that stabilises is [`super::riccati`]'s work.

use crate::number::{Field, Real};
use nalgebra::{Matrix3, Vector3};

/// Tracking index.
///
/// ```text
/// Λ = √(q/R) t²
/// ```
///
/// | here                   | unit    | meaning                                                          |
/// |------------------------|---------|------------------------------------------------------------------|
/// | `noise_variance`       | (m/s²)² | q, variance of the acceleration (or its change) over a scan        |
/// | `measurement_variance` | m²      | R                                                                |
/// | `interval`             | s       | t                                                                |
///
/// Source: Kalata 1984.
///
/// Example: for q = 1, R = 4, t = 2: √(1/4) · 4.
///
/// ```
/// use immaculate::steady::gains::tracking_index;
///
/// assert_eq!(tracking_index(&1.0, &4.0, &2.0), 2.0);
/// ```
pub fn tracking_index<T: Real>(noise_variance: &T, measurement_variance: &T, interval: &T) -> T {
    (noise_variance.clone() / measurement_variance.clone()).sqrt() * interval.clone() * interval.clone()
}

/// Tracking index of a constant velocity filter with the damping root θ: Λ = 2(1 − θ)²/θ.
///
/// Source: Kalata 1984, Λ² = β²/(1 − α), with α = 1 − θ² and β = 2(1 − θ)².
///
/// Example: for θ = 1/2: 2 · 1/4 / (1/2).
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::gains::alpha_beta_index;
///
/// assert_eq!(alpha_beta_index(&Rational::new(1, 2)), Rational::new(1, 1));
/// ```
///
/// Evidence: `the_alpha_beta_gain_solves_the_riccati_equation` (symbolic).
pub fn alpha_beta_index<T: Field>(root: &T) -> T {
    let rest = T::one() - root.clone();
    T::integer(2) * rest.clone() * rest / root.clone()
}

/// Tracking index of a constant acceleration filter with the damping root θ: Λ = 2(1 − θ)³/(θ(1 + θ)).
///
/// Source: Kalata 1984, Λ² = γ²/(4(1 − α)), with γ = β²/α.
///
/// Example: for θ = 1/2: 2 · 1/8 / (1/2 · 3/2).
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::gains::alpha_beta_gamma_index;
///
/// assert_eq!(alpha_beta_gamma_index(&Rational::new(1, 2)), Rational::new(1, 3));
/// ```
///
/// Evidence: `the_alpha_beta_gamma_gain_solves_the_riccati_equation` (symbolic).
pub fn alpha_beta_gamma_index<T: Field>(root: &T) -> T {
    let rest = T::one() - root.clone();
    T::integer(2) * rest.clone() * rest.clone() * rest / (root.clone() * (T::one() + root.clone()))
}

/// Damping root θ of the constant velocity filter with tracking index Λ.
///
/// ```text
/// y² − 1 = 8/Λ,   θ = (y − 1)/(y + 1) = (8/Λ)/(y + 1)²
/// ```
///
/// Why: with y = (1 + θ)/(1 − θ) the equation 2(1 − θ)² = Λθ of [`alpha_beta_index`] loses its first power. The last form of θ has
/// nothing that could cancel, however small or large Λ is.
///
/// Source: Kalata 1984, the quadratic for α; solved by this substitution here.
///
/// Example: for Λ = 1: y = √(1 + 8) = 3, θ = 8/16.
///
/// ```
/// use immaculate::steady::gains::alpha_beta_root;
///
/// assert_eq!(alpha_beta_root(&1.0), 0.5);
/// ```
///
/// Evidence: `the_damping_roots_give_back_their_index` (enclosed).
pub fn alpha_beta_root<T: Real>(index: &T) -> T {
    let c = T::integer(8) / index.clone();
    let y = (T::one() + c.clone()).sqrt();
    let sum = y + T::one();
    c / (sum.clone() * sum)
}

/// Damping root θ of the constant acceleration filter with tracking index Λ.
///
/// ```text
/// y³ − y = 8/Λ = c,   θ = (y − 1)/(y + 1) = (c/y)/(y + 1)²
///
/// y = u + 1/(3u),  u³ = c/2 + √(c²/4 − 1/27)          for c² ≥ 4/27
/// y = (2/√3) cos(φ/3),  cos φ = √(27/4) c             below
/// ```
///
/// Why: with y = (1 + θ)/(1 − θ) the equation 2(1 − θ)³ = Λθ(1 + θ) of [`alpha_beta_gamma_index`] becomes a cubic without a square,
/// which Cardano's formula solves where it has one real root, and Viète's where it has three; the root above one is wanted.
///
/// Source: Gray and Murray 1993 have the cubic for θ; solved by this substitution here.
///
/// Example: for Λ = 1/3: y³ − y = 24 has the root y = 3, so θ = (3 − 1)/(3 + 1). The cube root by ln and exp costs a few units of the last
/// place.
///
/// ```
/// use immaculate::steady::gains::alpha_beta_gamma_root;
///
/// assert!((alpha_beta_gamma_root(&(1.0_f64 / 3.0)) - 0.5).abs() < 1e-15);
/// ```
///
/// Evidence: `the_damping_roots_give_back_their_index` (enclosed).
pub fn alpha_beta_gamma_root<T: Real>(index: &T) -> T {
    let c = T::integer(8) / index.clone();
    let discriminant = c.clone() * c.clone() / T::integer(4) - T::ratio(1, 27);
    let y = if discriminant >= T::zero() {
        let cube = c.clone() / T::integer(2) + discriminant.sqrt();
        let u = (cube.ln() / T::integer(3)).exp();
        u.clone() + T::one() / (T::integer(3) * u)
    } else {
        let angle = (-discriminant).sqrt().atan2(&(c.clone() / T::integer(2)));
        T::integer(2) / T::integer(3).sqrt() * (angle / T::integer(3)).cos()
    };
    let sum = y.clone() + T::one();
    c / (y * sum.clone() * sum)
}

/// Gain of the constant velocity filter, embedded in three dimensions: K = [α, β/t, 0]ᵀ.
///
/// | here       | unit      | meaning                                   |
/// |------------|-----------|-------------------------------------------|
/// | `root`     | 1         | the damping root θ                        |
/// | `interval` | s         | t                                         |
/// | the result | 1, s⁻¹, s⁻² | the gain for position, velocity, acceleration |
///
/// Source: Kalata 1984, α = 1 − θ², β = 2(2 − α) − 4√(1 − α) = 2(1 − θ)².
///
/// Example: for θ = 1/2: α = 1 − 1/4, β = 2 · 1/4; t = 2.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::gains::alpha_beta_gain;
/// use nalgebra::vector;
///
/// let q = Rational::new;
/// assert_eq!(alpha_beta_gain(&q(1, 2), &q(2, 1)), vector![q(3, 4), q(1, 4), q(0, 1)]);
/// ```
///
/// Evidence: `the_alpha_beta_gain_solves_the_riccati_equation` (symbolic).
pub fn alpha_beta_gain<T: Field>(root: &T, interval: &T) -> Vector3<T> {
    Vector3::new(alpha(root), beta(root) / interval.clone(), T::zero())
}

/// Gain of the constant acceleration filter: K = [α, β/t, γ/(2t²)]ᵀ.
///
/// | here       | unit      | meaning                                   |
/// |------------|-----------|-------------------------------------------|
/// | `root`     | 1         | the damping root θ                        |
/// | `interval` | s         | t                                         |
/// | the result | 1, s⁻¹, s⁻² | the gain for position, velocity, acceleration |
///
/// Source: Kalata 1984, with γ = β²/α.
///
/// Example: for θ = 1/2: α = 3/4, β = 1/2, γ = (1/4)/(3/4) = 1/3; t = 1.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::gains::alpha_beta_gamma_gain;
/// use nalgebra::vector;
///
/// let q = Rational::new;
/// assert_eq!(alpha_beta_gamma_gain(&q(1, 2), &q(1, 1)), vector![q(3, 4), q(1, 2), q(1, 6)]);
/// ```
///
/// Evidence: `the_alpha_beta_gamma_gain_solves_the_riccati_equation` (symbolic).
pub fn alpha_beta_gamma_gain<T: Field>(root: &T, interval: &T) -> Vector3<T> {
    let t = || interval.clone();
    let (alpha, beta) = (alpha(root), beta(root));
    let gamma = beta.clone() * beta.clone() / alpha.clone();
    Vector3::new(alpha, beta / t(), gamma / (T::integer(2) * t() * t()))
}

/// Innovation variance of either filter in its steady state: S = R/(1 − α) = R/θ², m².
///
/// Source: α = P⁻₁₁/S and S = P⁻₁₁ + R.
///
/// Example: for θ = 1/2, R = 1: P⁻₁₁ = α S = 3 and S = 3 + 1.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::gains::innovation_variance;
///
/// assert_eq!(innovation_variance(&Rational::new(1, 2), &Rational::new(1, 1)), Rational::new(4, 1));
/// ```
///
/// Evidence: `the_alpha_beta_gain_solves_the_riccati_equation` (symbolic).
pub fn innovation_variance<T: Field>(root: &T, measurement_variance: &T) -> T {
    measurement_variance.clone() / (root.clone() * root.clone())
}

/// Predicted covariance of the constant velocity filter in its steady state, embedded in three dimensions.
///
/// ```text
///          ⎡ α      β/t           0 ⎤
/// P⁻ = S · ⎢ β/t    β(2α + β)/2t² 0 ⎥
///          ⎣ 0      0             0 ⎦
/// ```
///
/// Source: the first column is S K; the rest follows from P⁻ = F (I − KH) P⁻ Fᵀ + G q Gᵀ entry by entry.
///
/// Example: for θ = 1/2, R = 1, t = 1: S = 4, so 4 · 3/4, 4 · 1/2 and 4 · 1/2 · (3/2 + 1/2)/2.
///
/// ```
/// use immaculate::number::{Field, Rational};
/// use immaculate::steady::gains::alpha_beta_covariance;
/// use nalgebra::matrix;
///
/// let one = Rational::integer(1);
/// let predicted = alpha_beta_covariance(&Rational::new(1, 2), &one, &one);
/// assert_eq!(predicted, matrix![3, 2, 0; 2, 2, 0; 0, 0, 0].map(Rational::integer));
/// ```
///
/// Evidence: `the_alpha_beta_gain_solves_the_riccati_equation` (symbolic).
#[rustfmt::skip]
pub fn alpha_beta_covariance<T: Field>(root: &T, measurement_variance: &T, interval: &T) -> Matrix3<T> {
    let (o, t) = (T::zero, || interval.clone());
    let (alpha, beta) = (alpha(root), beta(root));
    let position_velocity = beta.clone() / t();
    let velocity = beta.clone() * (T::integer(2) * alpha.clone() + beta) / (T::integer(2) * t() * t());
    let scaled = Matrix3::new(
        alpha, position_velocity.clone(), o(), //
        position_velocity, velocity, o(), //
        o(), o(), o(),
    );
    scaled * innovation_variance(root, measurement_variance)
}

/// Predicted covariance of the constant acceleration filter in its steady state.
///
/// ```text
///          ⎡ α       β/t                                   γ/2t²         ⎤
/// P⁻ = S · ⎢ β/t     (αβ + β² − γ/2 − αγ/4 + βγ/8)/t²      γ(2α + β)/4t³ ⎥
///          ⎣ γ/2t²   γ(2α + β)/4t³                         βγ/2t⁴        ⎦
/// ```
///
/// Source: as [`alpha_beta_covariance`].
///
/// Example: for θ = 1/2, R = 1, t = 1: S = 4 and α, β, γ = 3/4, 1/2, 1/3. The first column is 4 · [3/4, 1/2, 1/6], S times the gain.
///
/// ```
/// use immaculate::number::{Field, Rational};
/// use immaculate::steady::gains::alpha_beta_gamma_covariance;
/// use nalgebra::matrix;
///
/// let one = Rational::integer(1);
/// let predicted = alpha_beta_gamma_covariance(&Rational::new(1, 2), &one, &one);
/// assert_eq!(predicted, matrix![9, 6, 2; 6, 5, 2; 2, 2, 1].map(|entry| Rational::new(entry, 3)));
/// ```
///
/// Evidence: `the_alpha_beta_gamma_gain_solves_the_riccati_equation` (symbolic).
#[rustfmt::skip]
pub fn alpha_beta_gamma_covariance<T: Field>(root: &T, measurement_variance: &T, interval: &T) -> Matrix3<T> {
    let (t, n) = (|| interval.clone(), |value: i64| T::integer(value));
    let (a, b) = (|| alpha(root), || beta(root));
    let c = || b() * b() / a();
    let position_velocity = b() / t();
    let position_acceleration = c() / (n(2) * t() * t());
    let velocity = (a() * b() + b() * b() - c() / n(2) - a() * c() / n(4) + b() * c() / n(8)) / (t() * t());
    let velocity_acceleration = c() * (n(2) * a() + b()) / (n(4) * t() * t() * t());
    let acceleration = b() * c() / (n(2) * t() * t() * t() * t());
    let scaled = Matrix3::new(
        a(), position_velocity.clone(), position_acceleration.clone(), //
        position_velocity, velocity, velocity_acceleration.clone(), //
        position_acceleration, velocity_acceleration, acceleration,
    );
    scaled * innovation_variance(root, measurement_variance)
}

/// α = 1 − θ².
fn alpha<T: Field>(root: &T) -> T {
    T::one() - root.clone() * root.clone()
}

/// β = 2(1 − θ)².
fn beta<T: Field>(root: &T) -> T {
    let rest = T::one() - root.clone();
    T::integer(2) * rest.clone() * rest
}
