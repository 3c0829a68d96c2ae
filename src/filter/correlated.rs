//! The Kalman filter whose process and measurement noise are correlated: what the noise that leads to a state has in common with the
//! noise of its measurement.
//!
//! ```text
//! x = f(x before) + w,   z = H x + v,   E[w wᵀ] = Q,   E[v vᵀ] = R,   E[w vᵀ] = M
//!
//! P⁻ ─ cross_covariance ──────▶ C = P⁻Hᵀ + M ──────────────────┐
//!    └ innovation_covariance ─▶ S = H P⁻Hᵀ + H M + MᵀHᵀ + R ───┴─▶ gain and update as usual: super::update
//! ```
//!
//! The prediction is unchanged, too: P⁻ contains Q and nothing of v. Once the measurement is used, the noises of the next step are new.
//!
//! Some texts correlate v with the noise that *leaves* the state, E[w(k) v(k)ᵀ] with x(k+1) = F x(k) + w(k); that is another filter, whose
//! prediction depends on the measurement. Here w and v are of the same step, as in Simon 2006, section 7.1.

use crate::filter::kalman;
use crate::matrix::{Holds, Shapes};
use crate::number::Field;
use nalgebra::{Dim, OMatrix};

/// Cross-covariance of state and measurement, C = P⁻ Hᵀ + M.
///
/// Source: Simon, Optimal State Estimation, 2006, section 7.1.
///
/// | paper | here                     | shape | meaning                                             |
/// |-------|--------------------------|-------|-----------------------------------------------------|
/// | P⁻    | `covariance`             | N × N | predicted covariance                                 |
/// | H     | `h`                      | M × N | measurement matrix, or its Jacobian                  |
/// | M     | `noise_cross_covariance` | N × M | E[w vᵀ], units of the state times the measurement's  |
///
/// Why: the error of the prediction, e = x − x̂⁻, has w in it, so that E[e vᵀ] = E[w vᵀ] = M, and E[e (H e + v)ᵀ] = P⁻Hᵀ + M.
///
/// Example: 25 · 2, and 10 that the noises have in common.
///
/// ```
/// use immaculate::filter::correlated::cross_covariance;
/// use nalgebra::matrix;
///
/// assert_eq!(cross_covariance(&matrix![25.0], &matrix![2.0], &matrix![10.0]), matrix![60.0]);
/// ```
///
/// Evidence: `correlated_noises_are_conditioning_of_the_joint_gaussian` (correlated_noise, exact).
pub fn cross_covariance<T: Field, N: Dim, M: Dim>(
    covariance: &OMatrix<T, N, N>,
    h: &OMatrix<T, M, N>,
    noise_cross_covariance: &OMatrix<T, N, M>,
) -> OMatrix<T, N, M>
where
    Shapes: Holds<N, M>,
{
    kalman::cross_covariance(covariance, h) + noise_cross_covariance
}

/// Innovation covariance, S = H P⁻ Hᵀ + H M + Mᵀ Hᵀ + R.
///
/// Source: as [`cross_covariance`].
///
/// | paper | here                     | shape | meaning                             |
/// |-------|--------------------------|-------|-------------------------------------|
/// | H     | `h`                      | M × N | measurement matrix, or its Jacobian |
/// | P⁻    | `covariance`             | N × N | predicted covariance                |
/// | R     | `noise`                  | M × M | measurement noise                   |
/// | M     | `noise_cross_covariance` | N × M | E[w vᵀ]                             |
///
/// Why: the innovation is H e + v, and E[H e vᵀ] = H M. The noises can cancel in it, or add up.
///
/// Example: 2 · 25 · 2 + 100, and twice 2 · 10 that they have in common.
///
/// ```
/// use immaculate::filter::correlated::innovation_covariance;
/// use nalgebra::matrix;
///
/// let s = innovation_covariance(&matrix![2.0], &matrix![25.0], &matrix![100.0], &matrix![10.0]);
/// assert_eq!(s, matrix![240.0]);
/// ```
///
/// Evidence: as [`cross_covariance`].
pub fn innovation_covariance<T: Field, N: Dim, M: Dim>(
    h: &OMatrix<T, M, N>,
    covariance: &OMatrix<T, N, N>,
    noise: &OMatrix<T, M, M>,
    noise_cross_covariance: &OMatrix<T, N, M>,
) -> OMatrix<T, M, M>
where
    Shapes: Holds<N, M>,
{
    let seen = h * noise_cross_covariance;
    kalman::innovation_covariance(h, covariance, noise) + &seen + seen.transpose()
}
