//! The Kalman filter's predictions: exact when motion and measurement are linear.
//!
//! The cubature filters approximate these predictions and must equal them on a linear problem.
//!
//! ```text
//! x̂⁰ ─ predicted_mean ───────▶ x̂⁻ ─ H ─▶ ẑ
//! P⁰ ─ predicted_covariance ─▶ P⁻ ─ innovation_covariance ─▶ S ─┐
//!                              └─── cross_covariance ──────▶ C ─┴─▶ gain and update, which all filters share: super::update
//! ```
//!
//! The examples of this file, of [`cubature`](super::cubature), [`raw`](super::raw) and [`update`](super::update) are one step of one
//! filter: x̂⁰ = 5 and P⁰ = 4, F = 2 and Q = 9, H = 2 and R = 100, z = 24. It is put together in the [head of the folder](super).

use crate::matrix::{Holds, Shapes, mirrored};
use crate::number::Field;
use nalgebra::{Dim, OMatrix, OVector};

/// Predicted mean, x̂⁻ = F x̂ — derbez2000 (2), sustika2015 (14).
///
/// Source: Kalman 1960; liu2017 (1) without noise.
///
/// Example: the state doubles at every step.
///
/// ```
/// use immaculate::filter::kalman::predicted_mean;
/// use nalgebra::{matrix, vector};
///
/// assert_eq!(predicted_mean(&matrix![2.0], &vector![5.0]), vector![10.0]); // 2 · 5
/// ```
///
/// Evidence: `a_linear_filter_with_any_rule_of_degree_two_is_the_kalman_filter` (symbolic).
pub fn predicted_mean<T: Field, N: Dim>(transition: &OMatrix<T, N, N>, mean: &OVector<T, N>) -> OVector<T, N>
where
    Shapes: Holds<N>,
{
    transition * mean
}

/// Predicted covariance, P⁻ = F P Fᵀ + Q, with its lower triangle [`mirrored`] — derbez2000 (2), sustika2015 (15).
///
/// Source: Kalman 1960.
///
/// Example: doubled, a variance of 4 is one of 16, and the motion adds 9. Without F on both sides it would be 8 + 9.
///
/// ```
/// use immaculate::filter::kalman::predicted_covariance;
/// use nalgebra::matrix;
///
/// assert_eq!(predicted_covariance(&matrix![2.0], &matrix![4.0], &matrix![9.0]), matrix![25.0]); // 2 · 4 · 2 + 9
/// ```
///
/// Evidence: `the_kalman_update_is_conditioning_of_a_gaussian` (symbolic).
pub fn predicted_covariance<T: Field, N: Dim>(
    transition: &OMatrix<T, N, N>,
    covariance: &OMatrix<T, N, N>,
    noise: &OMatrix<T, N, N>,
) -> OMatrix<T, N, N>
where
    Shapes: Holds<N>,
{
    mirrored(transition * covariance * transition.transpose() + noise)
}

/// Cross-covariance of state and measurement, C = P⁻ Hᵀ, of which the gain is made — sustika2015 (17).
///
/// Source: Kalman 1960.
///
/// Example: the prediction has the variance 25, and twice the state is measured.
///
/// ```
/// use immaculate::filter::kalman::cross_covariance;
/// use nalgebra::matrix;
///
/// assert_eq!(cross_covariance(&matrix![25.0], &matrix![2.0]), matrix![50.0]); // 25 · 2
/// ```
///
/// Evidence: `the_kalman_update_is_conditioning_of_a_gaussian` (symbolic).
pub fn cross_covariance<T: Field, N: Dim, M: Dim>(
    covariance: &OMatrix<T, N, N>,
    h: &OMatrix<T, M, N>,
) -> OMatrix<T, N, M>
where
    Shapes: Holds<N, M>,
{
    covariance * h.transpose()
}

/// Innovation covariance, S = H P⁻ Hᵀ + R — derbez2000 (4), sustika2015 (16).
///
/// Source: Kalman 1960.
///
/// Example: what the prediction does not know, seen by the sensor, and what the sensor does not know.
///
/// ```
/// use immaculate::filter::kalman::innovation_covariance;
/// use nalgebra::matrix;
///
/// assert_eq!(innovation_covariance(&matrix![2.0], &matrix![25.0], &matrix![100.0]), matrix![200.0]); // 2 · 25 · 2 + 100
/// ```
///
/// Evidence: `the_kalman_update_is_conditioning_of_a_gaussian` (symbolic).
pub fn innovation_covariance<T: Field, N: Dim, M: Dim>(
    h: &OMatrix<T, M, N>,
    covariance: &OMatrix<T, N, N>,
    noise: &OMatrix<T, M, M>,
) -> OMatrix<T, M, M>
where
    Shapes: Holds<N, M>,
{
    h * covariance * h.transpose() + noise
}
