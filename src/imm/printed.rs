//! The misprinted equations of the cycle, exactly as printed.
//!
//! They can be run to see what they do. The tests use each form to show that it is wrong, and the scenarios use it to measure its effect.

use super::Equations;
use crate::matrix::{Holds, Ldl, Shapes, ldl, log_determinant, quadratic_form};
use crate::number::Real;
use nalgebra::{Dim, OVector};

/// liu2017 (21) as printed: ln L = −½ νᵀ S⁻¹ ν − (n_z/2) ln|2πS|.
///
/// |2πS| already carries (2π)^n_z; with n_z = 2 the exponent −n_z/2 squares the determinant's share, which favours the mode with the
/// smaller innovation covariance.
///
/// Example: two modes whose prediction is hit exactly, with covariances of 1 and 4 in both components. The densities are 4 to 1; as printed
/// they are 16 to 1.
///
/// ```
/// use immaculate::{gaussian::log_density, imm::printed::log_density_21, matrix::ldl, number::Real};
/// use nalgebra::{Matrix2, vector};
///
/// let (near, wide) = (ldl(&Matrix2::identity()), ldl(&(Matrix2::identity() * 4.0)));
/// let nu = vector![0.0, 0.0];
/// let right = log_density(&nu, &near) - log_density(&nu, &wide); // ½ ln(4 · 4/1)
/// let printed: f64 = log_density_21(&nu, &near) - log_density_21(&nu, &wide); // ln(4 · 4/1)
/// // Differences of numbers up to 7: a few units in the last place of those.
/// assert!((right - Real::ln(&4.0)).abs() < 8.0 * f64::EPSILON);
/// assert!((printed - Real::ln(&16.0)).abs() < 8.0 * f64::EPSILON);
/// ```
pub fn log_density_21<T: Real, M: Dim>(residual: &OVector<T, M>, covariance: &Ldl<T, M>) -> T
where
    Shapes: Holds<M>,
{
    let dimension = T::integer(i64::try_from(residual.len()).unwrap_or(i64::MAX));
    let two_pi = T::pi() * T::integer(2);
    let log_determinant_of_two_pi_s = log_determinant(covariance) + dimension.clone() * two_pi.ln();
    -(quadratic_form(covariance, residual) + dimension * log_determinant_of_two_pi_s) / T::integer(2)
}

/// zhu2016 (57) read as it stands, with 2π outside the determinant: ln L = −½ νᵀ V⁻¹ ν − ½ ln(2π|V|).
///
/// The matrix under the scalar root has no other reading that gives a number; it is the density only for a scalar measurement.
///
/// Example: for one component it is the density; for two it lacks a factor 2π under the root.
///
/// ```
/// use immaculate::{gaussian::log_density, imm::printed::log_density_57, matrix::ldl, number::Real};
/// use nalgebra::{Matrix2, matrix, vector};
///
/// let (nu, s) = (vector![2.0], ldl(&matrix![4.0]));
/// let lacking: f64 = log_density_57(&nu, &s) - log_density(&nu, &s);
/// assert!(lacking.abs() < 4.0 * f64::EPSILON); // the same sum in another order, about 2
/// let (nu, s) = (vector![0.0, 0.0], ldl(&Matrix2::identity()));
/// let lacking: f64 = log_density_57(&nu, &s) - log_density(&nu, &s);
/// assert!((lacking - Real::ln(&(2.0 * std::f64::consts::PI)) / 2.0).abs() < 4.0 * f64::EPSILON);
/// ```
pub fn log_density_57<T: Real, M: Dim>(residual: &OVector<T, M>, covariance: &Ldl<T, M>) -> T
where
    Shapes: Holds<M>,
{
    let two_pi = T::pi() * T::integer(2);
    let log_of_two_pi_det = log_determinant(covariance) + two_pi.ln();
    -(quadratic_form(covariance, residual) + log_of_two_pi_det) / T::integer(2)
}

/// liu2017 (22) as printed: C = Σᵢ Lʲ Cᵢ, so μʲ = Lʲ Cⱼ / C = Cⱼ / Σᵢ Cᵢ.
///
/// The likelihood stands in every term of the sum with the index j, and cancels.
///
/// Example: the measurement is a thousand times or e⁻⁵ times as likely, and the probability stays what was predicted.
///
/// ```
/// use immaculate::imm::printed::mode_probability_22;
///
/// for log_likelihood in [1000.0_f64.ln(), -5.0] {
///     assert_eq!(mode_probability_22(&log_likelihood, &[0.5, 0.5], 0), 0.5); // L · ½ / (L · ½ + L · ½)
/// }
/// ```
pub fn mode_probability_22<T: Real>(log_likelihood: &T, predicted_mode_probabilities: &[T], mode: usize) -> T {
    let likelihood = log_likelihood.exp();
    let mut c = T::zero();
    for predicted in predicted_mode_probabilities {
        c += likelihood.clone() * predicted.clone();
    }
    likelihood * predicted_mode_probabilities[mode].clone() / c
}

impl<T: Real, N: Dim, M: Dim> Equations<T, N, M>
where
    Shapes: Holds<N, M>,
{
    /// The table with the likelihood of liu2017 (21) as printed.
    #[must_use]
    pub fn with_likelihood_21(self) -> Self {
        Self {
            log_likelihood: |_, _, now, j| log_density_21(&now.innovations[j], &ldl(&now.innovation_covariances[j])),
            ..self
        }
    }
}
