//! The backward step of Rauch, Tung and Striebel: what the next state says about this one.
//!
//! It is the same for every kind of filter that computes its gain. The kinds differ in D only, the covariance of a state and the next one:
//!
//! ```text
//! Kalman and extended filters     D = P Fᵀ                             kalman::cross_covariance, with F instead of H
//! filters that draw points        D = Σₛ wₛ (χₛ − x̂)(χ*ₛ − x̂⁻)ᵀ        cubature::motion_cross_covariance
//!
//! D, P⁻ ─ smoother_gain ─▶ G       x̂, G, x̂ˢ₊ − x̂⁻ ─ smoothed_mean ─▶ x̂ˢ       P, G, Pˢ₊, P⁻ ─ smoothed_covariance ─▶ Pˢ
//! ```
//!
//! The examples of this file are one step of a random walk: x̂ = 0 and P = 1, Q = 1, so that x̂⁻ = 0 and P⁻ = 2; R = 2 and z = 4, so that
//! the next estimate is 2 with the variance 1.

use crate::filter::update;
use crate::matrix::{Holds, NotPositiveDefinite, Shapes, check_positive_definite, ldl, mirrored};
use crate::number::Field;
use nalgebra::{Dim, OMatrix, OVector};

/// Smoother gain, G = D P⁻⁻¹.
///
/// Source: H. E. Rauch, F. Tung and C. T. Striebel, Maximum Likelihood Estimates of Linear Dynamic Systems, 1965; with points, S. Särkkä,
/// Unscented Rauch-Tung-Striebel Smoother, 2008.
///
/// | literature | here                   | shape | meaning                                                                  |
/// |------------|------------------------|-------|--------------------------------------------------------------------------|
/// | D          | `cross_covariance`     | N × N | cov(x(k), x(k+1)) given z₁…z₍k₎; row: entry of x(k)                       |
/// | P⁻         | `predicted_covariance` | N × N | predicted covariance of step k+1                                         |
/// | G          | the result             | N × N | how much of a correction of x(k+1) is one of x(k)                        |
///
/// Why: given z₁…z₍k₎ the states x(k) and x(k+1) are jointly Gaussian. Once x(k+1) is known, what is measured later says nothing about
/// x(k), so that x(k) is estimated from x(k+1) as a filter estimates x from z: the [gain](update::gain) with D for C and P⁻ for S.
///
/// Example: half of what the walk turns out to have moved was there before.
///
/// ```
/// use immaculate::smoother::rauch_tung_striebel::smoother_gain;
/// use nalgebra::matrix;
///
/// assert_eq!(smoother_gain(&matrix![1.0], &matrix![2.0])?, matrix![0.5]); // 1/2
/// # Ok::<(), immaculate::matrix::NotPositiveDefinite>(())
/// ```
///
/// # Errors
///
/// [`NotPositiveDefinite`] when P⁻ is not: an entry of the next state is then known exactly, and the equation has no answer.
///
/// Evidence: `smoothed_estimates_are_the_joint_gaussian_given_all_measurements` (smoothers, exact).
pub fn smoother_gain<T: Field + PartialOrd, N: Dim>(
    cross_covariance: &OMatrix<T, N, N>,
    predicted_covariance: &OMatrix<T, N, N>,
) -> Result<OMatrix<T, N, N>, NotPositiveDefinite>
where
    Shapes: Holds<N>,
{
    let factors = ldl(predicted_covariance);
    check_positive_definite(&factors)?;
    Ok(update::gain(cross_covariance, &factors))
}

/// Smoothed mean, x̂ˢ = x̂ + G (x̂ˢ₊ − x̂⁻).
///
/// Source: as [`smoother_gain`].
///
/// | literature | here         | shape | meaning                                                                     |
/// |------------|--------------|-------|-----------------------------------------------------------------------------|
/// | x̂          | `mean`       | N     | updated mean of step k                                                      |
/// | G          | `gain`       | N × N | [`smoother_gain`]                                                           |
/// | x̂ˢ₊ − x̂⁻   | `correction` | N     | smoothed less predicted mean of step k+1, differences of angles wrapped     |
///
/// Why: E[x(k) ∣ x(k+1), z₁…z₍k₎] = x̂ + G (x(k+1) − x̂⁻), averaged over what is known of x(k+1) in the end.
///
/// Example: the next estimate is 2 where 0 was predicted.
///
/// ```
/// use immaculate::smoother::rauch_tung_striebel::smoothed_mean;
/// use nalgebra::{matrix, vector};
///
/// assert_eq!(smoothed_mean(&vector![0.0], &matrix![0.5], &vector![2.0 - 0.0]), vector![1.0]); // 0 + ½ · 2
/// ```
///
/// Evidence: as [`smoother_gain`].
pub fn smoothed_mean<T: Field, N: Dim>(
    mean: &OVector<T, N>,
    gain: &OMatrix<T, N, N>,
    correction: &OVector<T, N>,
) -> OVector<T, N>
where
    Shapes: Holds<N>,
{
    mean + gain * correction
}

/// Smoothed covariance, Pˢ = P + G (Pˢ₊ − P⁻) Gᵀ, with its lower triangle [`mirrored`].
///
/// Source: as [`smoother_gain`].
///
/// | literature | here         | shape | meaning                               |
/// |------------|--------------|-------|---------------------------------------|
/// | P          | `covariance` | N × N | updated covariance of step k          |
/// | G          | `gain`       | N × N | [`smoother_gain`]                     |
/// | Pˢ₊        | `smoothed`   | N × N | smoothed covariance of step k+1       |
/// | P⁻         | `predicted`  | N × N | predicted covariance of step k+1      |
///
/// Why: P − G P⁻ Gᵀ is left of x(k) when x(k+1) is known, and G Pˢ₊ Gᵀ comes back as it is known to Pˢ₊ only. Pˢ₊ is at most P⁻, so the
/// smoothed covariance is at most the updated one.
///
/// Example: of the walk's start, measured two noises away: 1 − 1 · ¼ · 1, as S = 1 + 1 + 2.
///
/// ```
/// use immaculate::smoother::rauch_tung_striebel::smoothed_covariance;
/// use nalgebra::matrix;
///
/// let smoothed = smoothed_covariance(&matrix![1.0], &matrix![0.5], &matrix![1.0], &matrix![2.0]);
/// assert_eq!(smoothed, matrix![0.75]); // 1 + ½ · (1 − 2) · ½
/// ```
///
/// Evidence: as [`smoother_gain`], `a_smoothed_covariance_is_at_most_the_updated_one` (smoothers, exact).
pub fn smoothed_covariance<T: Field, N: Dim>(
    covariance: &OMatrix<T, N, N>,
    gain: &OMatrix<T, N, N>,
    smoothed: &OMatrix<T, N, N>,
    predicted: &OMatrix<T, N, N>,
) -> OMatrix<T, N, N>
where
    Shapes: Holds<N>,
{
    mirrored(covariance + gain * (smoothed - predicted) * gain.transpose())
}
