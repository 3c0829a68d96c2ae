//! Motion along one coordinate with the acceleration in the state: the two models of derbez2000.
//!
//! Constant velocity and constant acceleration share one state [p, ṗ, p̈], so that their estimates can be mixed. Each coordinate of the
//! target is filtered separately. The measurement is the position, H = [1 0 0].
//!
//! ```text
//! constant velocity       F            the acceleration is set to zero at every step
//! constant acceleration   F + ΔF       the acceleration is kept
//! ```
//!
//! Units: metres, seconds. With the coordinates scaled by D = diag(1, t, t²) every matrix here has t = 1.

use super::motion::{Mode, Motion};
use crate::number::Field;
use nalgebra::{Matrix3, RowVector3, U3, Vector3};

/// Transition matrix of constant velocity, embedded in three dimensions — derbez2000 (5).
///
/// ```text
///     ⎡ 1 t 0 ⎤
/// F = ⎢ 0 1 0 ⎥
///     ⎣ 0 0 0 ⎦
/// ```
///
/// | paper | here       | unit | meaning       |
/// |-------|------------|------|---------------|
/// | t, Δt | `interval` | s    | the scan time |
///
/// Why: the model has no acceleration, so its estimate of one is zero; the last row says so, and the last column makes it forget the
/// acceleration that mixing gave it.
///
/// Source: derbez2000, section 2.2.
///
/// Example: two seconds at 3 m/s; an acceleration that mixing left in the state is dropped.
///
/// ```
/// use immaculate::model::acceleration::embedded_constant_velocity;
/// use nalgebra::vector;
///
/// // 10 + 2 · 3
/// assert_eq!(embedded_constant_velocity(&2.0) * vector![10.0, 3.0, 4.0], vector![16.0, 3.0, 0.0]);
/// ```
///
/// Evidence: `the_two_motions_differ_by_the_acceleration` (symbolic).
#[rustfmt::skip]
pub fn embedded_constant_velocity<T: Field>(interval: &T) -> Matrix3<T> {
    let (o, l, t) = (T::zero, T::one, || interval.clone());
    Matrix3::new(
        l(), t(), o(), //
        o(), l(), o(), //
        o(), o(), o(),
    )
}

/// What an acceleration adds to the motion — derbez2000 (5).
///
/// ```text
///      ⎡ 0 0 t²/2 ⎤
/// ΔF = ⎢ 0 0 t    ⎥
///      ⎣ 0 0 1    ⎦
/// ```
///
/// | paper | here       | unit | meaning       |
/// |-------|------------|------|---------------|
/// | t     | `interval` | s    | the scan time |
///
/// Why: a constant acceleration a moves the position by a t²/2 and the velocity by a t, and stays.
///
/// Source: derbez2000, section 2.2.
///
/// Example: what 4 m/s² add in two seconds.
///
/// ```
/// use immaculate::model::acceleration::acceleration_part;
/// use nalgebra::vector;
///
/// // 4 · 2²/2, 4 · 2, 4
/// assert_eq!(acceleration_part(&2.0) * vector![10.0, 3.0, 4.0], vector![8.0, 8.0, 4.0]);
/// ```
///
/// Evidence: `the_two_motions_differ_by_the_acceleration` (symbolic).
#[rustfmt::skip]
pub fn acceleration_part<T: Field>(interval: &T) -> Matrix3<T> {
    let [position, velocity, acceleration] = acceleration_response(interval).data.0[0].clone();
    let o = T::zero;
    Matrix3::new(
        o(), o(), position, //
        o(), o(), velocity, //
        o(), o(), acceleration,
    )
}

/// Transition matrix of constant acceleration, F + ΔF — derbez2000 (6).
///
/// ```text
/// x₍n+1₎ = (F + ΔF) xₙ + G wₙ,   wₙ ~ N(0, Q)
/// ```
///
/// | paper | here       | unit | meaning       |
/// |-------|------------|------|---------------|
/// | t     | `interval` | s    | the scan time |
///
/// Why: e^{At} with A = [0 1 0; 0 0 1; 0 0 0], which is nilpotent.
///
/// Source: derbez2000, section 2.2.
///
/// Example: the sum of the two, and two steps of one second are one of two.
///
/// ```
/// use immaculate::model::acceleration::constant_acceleration;
/// use nalgebra::vector;
///
/// // 10 + 2 · 3 + 8, 3 + 8, 4
/// assert_eq!(constant_acceleration(&2.0) * vector![10.0, 3.0, 4.0], vector![24.0, 11.0, 4.0]);
/// assert_eq!(constant_acceleration(&1.0) * constant_acceleration(&1.0), constant_acceleration(&2.0));
/// ```
///
/// Evidence: `the_two_motions_differ_by_the_acceleration`, `constant_acceleration_composes_over_time` (symbolic).
pub fn constant_acceleration<T: Field>(interval: &T) -> Matrix3<T> {
    embedded_constant_velocity(interval) + acceleration_part(interval)
}

/// How an acceleration that is constant over a step enters the state of constant acceleration: G_a = [t²/2, t, 1]ᵀ — derbez2000
/// (noise-inputs), (constant-acceleration-input).
///
/// Times a it is the paper's b, what the constant velocity model does not know of a target with the acceleration a: ΔF xₙ = b.
///
/// Source: derbez2000, sections 2.2 and 3, not numbered.
///
/// Example: what the constant velocity model does not know of a target with 4 m/s².
///
/// ```
/// use immaculate::model::acceleration::{acceleration_part, acceleration_response};
/// use nalgebra::vector;
///
/// assert_eq!(acceleration_response(&2.0), vector![2.0, 2.0, 1.0]); // 2²/2, 2, 1
/// assert_eq!(acceleration_response(&2.0) * 4.0, acceleration_part(&2.0) * vector![10.0, 3.0, 4.0]);
/// ```
///
/// Errata: section 3 calls the noise inputs of "the CA/CV plant" G_v and G_a "respectively"; it is the other order.
///
/// Evidence: `the_alpha_beta_gamma_gain_solves_the_riccati_equation` (symbolic).
pub fn acceleration_response<T: Field>(interval: &T) -> Vector3<T> {
    let t = || interval.clone();
    Vector3::new(t() * t() / T::integer(2), t(), T::one())
}

/// How an acceleration that is constant over a step enters the state of constant velocity: G_v = [t²/2, t, 0]ᵀ — derbez2000 (noise-inputs).
///
/// Source: derbez2000, section 3, not numbered; printed for a state of two, and embedded here as F is in (5).
///
/// Example: as the response with acceleration, but for the entry that the model lacks.
///
/// ```
/// use immaculate::model::acceleration::embedded_velocity_response;
/// use nalgebra::vector;
///
/// assert_eq!(embedded_velocity_response(&2.0), vector![2.0, 2.0, 0.0]); // 2²/2, 2
/// ```
///
/// Evidence: `the_alpha_beta_gain_solves_the_riccati_equation` (symbolic).
pub fn embedded_velocity_response<T: Field>(interval: &T) -> Vector3<T> {
    let t = || interval.clone();
    Vector3::new(t() * t() / T::integer(2), t(), T::zero())
}

/// Noise covariance of rank one: G q Gᵀ — derbez2000 (noise-inputs).
///
/// | paper    | here       | unit    | meaning                                                             |
/// |----------|------------|---------|---------------------------------------------------------------------|
/// | G_v, G_a | `response` | s², s, 1 | [`embedded_velocity_response`] or [`acceleration_response`]           |
/// | Q_v, Q_a | `variance` | (m/s²)² | variance of the acceleration, or of its change, over one step         |
///
/// Source: derbez2000, section 3, not numbered: "the noise matrix for the CV process noise is then G_v Q_v G_vᵀ".
///
/// Example: an acceleration of variance 3 over two seconds. Every entry is a product of two responses, so that no pair of columns is
/// independent.
///
/// ```
/// use immaculate::model::acceleration::{acceleration_response, response_noise};
/// use nalgebra::matrix;
///
/// // (2, 2, 1)ᵀ · 3 · (2, 2, 1)
/// let noise = response_noise(&acceleration_response(&2.0), &3.0);
/// assert_eq!(noise, matrix![12.0, 12.0, 6.0; 12.0, 12.0, 6.0; 6.0, 6.0, 3.0]);
/// ```
///
/// Evidence: as [`embedded_velocity_response`] and [`acceleration_response`].
pub fn response_noise<T: Field>(response: &Vector3<T>, variance: &T) -> Matrix3<T> {
    (response * response.transpose()) * variance.clone()
}

/// The two models as modes of one filter, constant velocity first, from the variances of their accelerations.
///
/// Source: derbez2000, sections 2.2 and 3.
///
/// Example: the same variance moves the acceleration of the second and not of the first, which has none.
///
/// ```
/// use immaculate::model::acceleration::modes;
///
/// let [velocity, acceleration] = modes(&2.0, &[3.0, 3.0]);
/// assert_eq!([&*velocity.name, &*acceleration.name], ["constant velocity", "constant acceleration"]);
/// assert_eq!([velocity.noise[(2, 2)], acceleration.noise[(2, 2)]], [0.0, 3.0]);
/// ```
pub fn modes<T: Field>(interval: &T, [of_velocity, of_acceleration]: &[T; 2]) -> [Mode<T, U3>; 2] {
    [
        Mode {
            name: "constant velocity".to_owned(),
            motion: Motion::Linear(embedded_constant_velocity(interval)),
            noise: response_noise(&embedded_velocity_response(interval), of_velocity),
        },
        Mode {
            name: "constant acceleration".to_owned(),
            motion: Motion::Linear(constant_acceleration(interval)),
            noise: response_noise(&acceleration_response(interval), of_acceleration),
        },
    ]
}

/// The matrix of a measured position, H = [1 0 0].
///
/// Source: derbez2000, section 2.2, not numbered.
///
/// Example: of position, velocity and acceleration the first is seen.
///
/// ```
/// use immaculate::model::acceleration::position_matrix;
/// use nalgebra::vector;
///
/// assert_eq!(position_matrix() * vector![10.0, 3.0, 4.0], vector![10.0]);
/// ```
pub fn position_matrix<T: Field>() -> RowVector3<T> {
    RowVector3::new(T::one(), T::zero(), T::zero())
}
