//! Motion in the plane with the accelerations in the state: the two models of sustika2015.
//!
//! The six-dimensional state [x, y, ẋ, ẏ, ẍ, ÿ] consists of two coordinates that move alike and independently. The noise is white in
//! continuous time. With constant velocity it acts on the acceleration, so the velocity is a Wiener process; with constant acceleration it
//! acts on the jerk, so the acceleration is a Wiener process.
//!
//! ```text
//! F = e^{At},     Q = ∫₀ᵗ e^{Aτ} g q gᵀ e^{Aᵀτ} dτ
//! ```
//!
//! Units: metres, seconds. The matrices of one coordinate [p, ṗ, p̈] are 3 × 3; F of both motions is that of [`acceleration`].
//!
//! [`acceleration`]: super::acceleration

use super::acceleration;
use crate::number::Field;
use nalgebra::{Matrix3, Matrix6};

/// The matrix of two coordinates that move alike: A ⊗ I₂.
///
/// ```text
/// row 2i + c, column 2j + d:   Aᵢⱼ where c = d, 0 where c ≠ d
/// ```
///
/// Source: sustika2015, section 2.1: the state is [x y ẋ ẏ ẍ ÿ]ᵀ, so that the coordinate c of the plane changes faster than the derivative.
///
/// Example: positions first, then velocities, then accelerations.
///
/// ```
/// use immaculate::model::wiener::in_the_plane;
/// use nalgebra::{matrix, vector};
///
/// let two_seconds = in_the_plane(&matrix![1.0, 2.0, 0.0; 0.0, 1.0, 0.0; 0.0, 0.0, 1.0]);
/// // 10 + 2 · 3, 20 + 2 · (−1)
/// assert_eq!(two_seconds * vector![10.0, 20.0, 3.0, -1.0, 0.0, 0.0], vector![16.0, 18.0, 3.0, -1.0, 0.0, 0.0]);
/// ```
///
/// Evidence: `the_motion_of_the_plane_is_that_of_each_coordinate` (symbolic).
pub fn in_the_plane<T: Field>(axis: &Matrix3<T>) -> Matrix6<T> {
    Matrix6::from_fn(|row, column| {
        if row % 2 == column % 2 {
            axis[(row / 2, column / 2)].clone()
        } else {
            T::zero()
        }
    })
}

/// Transition matrix of constant velocity in the plane, embedded in six dimensions — sustika2015 (1), (constant-velocity).
///
/// ```text
///     ⎡ 1 T 0 ⎤
/// A = ⎢ 0 1 0 ⎥ ⊗ I₂
///     ⎣ 0 0 0 ⎦
/// ```
///
/// | paper | here       | unit | meaning               |
/// |-------|------------|------|-----------------------|
/// | T     | `interval` | s    | the sampling interval |
///
/// Why: the model has no acceleration; its estimate of one is zero, and so is the variance of it. Everything else is the model of four
/// dimensions [x, y, ẋ, ẏ].
///
/// Example: two seconds at (3, −1) m/s; the accelerations are dropped.
///
/// ```
/// use immaculate::model::wiener::constant_velocity_in_the_plane;
/// use nalgebra::vector;
///
/// let state = vector![10.0, 20.0, 3.0, -1.0, 5.0, 7.0];
/// // 10 + 2 · 3, 20 + 2 · (−1)
/// assert_eq!(constant_velocity_in_the_plane(&2.0) * state, vector![16.0, 18.0, 3.0, -1.0, 0.0, 0.0]);
/// ```
///
/// Errata: the matrix is never printed.
///
/// Evidence: `the_motions_of_the_plane_compose_over_time` (symbolic).
pub fn constant_velocity_in_the_plane<T: Field>(interval: &T) -> Matrix6<T> {
    in_the_plane(&acceleration::embedded_constant_velocity(interval))
}

/// Transition matrix of constant acceleration in the plane — sustika2015 (1), (constant-acceleration).
///
/// ```text
///     ⎡ 1 T T²/2 ⎤
/// A = ⎢ 0 1 T    ⎥ ⊗ I₂
///     ⎣ 0 0 1    ⎦
/// ```
///
/// | paper | here       | unit | meaning               |
/// |-------|------------|------|-----------------------|
/// | T     | `interval` | s    | the sampling interval |
///
/// Why: e^{AT} with the generator [0 1 0; 0 0 1; 0 0 0] of either coordinate.
///
/// Example: the same with the accelerations (5, 7) m/s².
///
/// ```
/// use immaculate::model::wiener::constant_acceleration_in_the_plane;
/// use nalgebra::vector;
///
/// let state = vector![10.0, 20.0, 3.0, -1.0, 5.0, 7.0];
/// // 16 + 5 · 2²/2, 18 + 7 · 2²/2; 3 + 5 · 2, −1 + 7 · 2
/// assert_eq!(constant_acceleration_in_the_plane(&2.0) * state, vector![26.0, 32.0, 13.0, 13.0, 5.0, 7.0]);
/// ```
///
/// Errata: the matrix is never printed.
///
/// Evidence: `the_motions_of_the_plane_compose_over_time` (symbolic).
pub fn constant_acceleration_in_the_plane<T: Field>(interval: &T) -> Matrix6<T> {
    in_the_plane(&acceleration::constant_acceleration(interval))
}

/// Noise covariance of constant velocity in the plane, white noise on the accelerations — sustika2015 (1), (constant-velocity).
///
/// ```text
///       ⎡ T³/3 T²/2 0 ⎤
/// Q = q ⎢ T²/2 T    0 ⎥ ⊗ I₂
///       ⎣ 0    0    0 ⎦
/// ```
///
/// | paper | here       | unit  | meaning                                        |
/// |-------|------------|-------|------------------------------------------------|
/// | q_cv  | `density`  | m²/s³ | spectral density of the white acceleration      |
/// | T     | `interval` | s     | the sampling interval                           |
///
/// Why: ∫₀ᵀ [τ; 1] q [τ; 1]ᵀ dτ per coordinate. "Psd of process noise" in table 1 is a density, so the noise is white in continuous time.
///
/// Example: two seconds with q = 3, the rows and columns of x and ẋ, and of ẍ.
///
/// ```
/// use immaculate::model::wiener::velocity_noise_in_the_plane;
///
/// let noise = velocity_noise_in_the_plane(&3.0, &2.0);
/// // 3 · 2³/3, 3 · 2²/2, 3 · 2
/// assert_eq!([(0, 0), (0, 2), (2, 2)].map(|at| noise[at]), [8.0, 6.0, 6.0]);
/// assert_eq!(noise[(4, 4)], 0.0);
/// ```
///
/// Errata: the matrix is never printed.
///
/// Evidence: `noise_in_the_plane_is_its_integral`, `velocity_noise_in_the_plane_is_that_of_the_other_papers` (symbolic).
pub fn velocity_noise_in_the_plane<T: Field>(density: &T, interval: &T) -> Matrix6<T> {
    let q = |power: usize, divisor: i64| moment(density, interval, power, divisor);
    let o = T::zero;
    #[rustfmt::skip]
    let axis = Matrix3::new(
        q(3, 3), q(2, 2), o(), //
        q(2, 2), q(1, 1), o(), //
        o(), o(), o(),
    );
    in_the_plane(&axis)
}

/// Noise covariance of constant acceleration in the plane, white noise on the rates of the accelerations —
/// sustika2015 (1), (constant-acceleration).
///
/// ```text
///       ⎡ T⁵/20 T⁴/8 T³/6 ⎤
/// Q = q ⎢ T⁴/8  T³/3 T²/2 ⎥ ⊗ I₂
///       ⎣ T³/6  T²/2 T    ⎦
/// ```
///
/// | paper | here       | unit  | meaning                                                |
/// |-------|------------|-------|--------------------------------------------------------|
/// | q_ca  | `density`  | m²/s⁵ | spectral density of the white rate of the acceleration  |
/// | T     | `interval` | s     | the sampling interval                                   |
///
/// Why: ∫₀ᵀ [τ²/2; τ; 1] q [τ²/2; τ; 1]ᵀ dτ per coordinate.
///
/// Example: two seconds with q = 15, the rows and columns of x, ẋ and ẍ. The noise of another q is no multiple of the constant velocity's.
///
/// ```
/// use immaculate::model::wiener::acceleration_noise_in_the_plane;
///
/// let noise = acceleration_noise_in_the_plane(&15.0, &2.0);
/// // 15 · 2⁵/20, 15 · 2⁴/8, 15 · 2³/6
/// assert_eq!([(0, 0), (0, 2), (0, 4)].map(|at| noise[at]), [24.0, 30.0, 20.0]);
/// // 15 · 2³/3, 15 · 2²/2, 15 · 2
/// assert_eq!([(2, 2), (2, 4), (4, 4)].map(|at| noise[at]), [40.0, 30.0, 30.0]);
/// ```
///
/// Errata: the matrix is never printed; table 1 gives one number for both densities, whose units differ.
///
/// Evidence: `noise_in_the_plane_is_its_integral` (symbolic).
pub fn acceleration_noise_in_the_plane<T: Field>(density: &T, interval: &T) -> Matrix6<T> {
    let q = |power: usize, divisor: i64| moment(density, interval, power, divisor);
    #[rustfmt::skip]
    let axis = Matrix3::new(
        q(5, 20), q(4, 8), q(3, 6), //
        q(4, 8), q(3, 3), q(2, 2), //
        q(3, 6), q(2, 2), q(1, 1),
    );
    in_the_plane(&axis)
}

/// q Tᵖ / d.
fn moment<T: Field>(density: &T, interval: &T, power: usize, divisor: i64) -> T {
    let product = (0..power).fold(density.clone(), |product, _| product * interval.clone());
    product / T::integer(divisor)
}
