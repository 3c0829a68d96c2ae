//! Moments by points and weights: the equations of every cubature filter, unscented and Gauss-Hermite included.
//!
//! After this file the reader knows that such a filter is a Kalman filter whose four moments (predicted mean and covariance, ẑ and
//! its covariances) are weighted sums over points. The rule ([`crate::rule`]) is an argument; nothing here depends on which.
//!
//! The equations are in the centred form of liu2017. Those of zhu2016 about the origin are in [`super::raw`].

use crate::model::Measurement;
use crate::number::{Field, Real};
use nalgebra::{SMatrix, SVector};

/// A point of the estimate — sustika2015 (27)-(29), zhu2016 (2)-(8), (28)-(34), liu2017 (14), (18).
///
/// ```text
/// X = S ξ + x̂
/// ```
///
/// | paper | here          | shape | meaning                                                                    |
/// |-------|---------------|-------|----------------------------------------------------------------------------|
/// | S     | `square_root` | N × N | Cholesky factor of the covariance, [`cholesky`](crate::matrix::cholesky)    |
/// | ξ     | `point`       | N     | a point of the rule for the standard Gaussian                               |
/// | x̂     | `mean`        | N     | the centre                                                                 |
///
/// Why: if ξ has zero mean and unit covariance under the rule's weights, X has mean x̂ and covariance S Sᵀ.
///
/// After the prediction the points are drawn afresh from the predicted mean and covariance, zhu2016 (28)-(34) and
/// liu2017 (18): the propagated ones know nothing of the process noise. sustika2015 draws points for the measurement only and
/// predicts by the Kalman filter's equations, which for a linear motion gives the same moments.
///
/// Errata: liu2017 (14) leaves the hat off the mean, and zhu2016 (2), (28) give the centre a superfluous index (notational).
///
/// Evidence: `a_linear_filter_with_any_rule_of_degree_two_is_the_kalman_filter` (symbolic).
pub fn point<T: Field, const N: usize>(
    square_root: &SMatrix<T, N, N>,
    point: &SVector<T, N>,
    mean: &SVector<T, N>,
) -> SVector<T, N> {
    square_root * point + mean
}

/// A propagated point — zhu2016 (14)-(20), liu2017 (14).
///
/// ```text
/// X* = f(X) = F X
/// ```
///
/// | paper | here         | shape | meaning                           |
/// |-------|--------------|-------|-----------------------------------|
/// | f     | `transition` | N × N | the papers' models are all linear |
/// | X     | `point`      | N     | a point of the mixed estimate     |
///
/// Evidence: as [`point`](fn@point).
pub fn propagated_point<T: Field, const N: usize>(
    transition: &SMatrix<T, N, N>,
    point: &SVector<T, N>,
) -> SVector<T, N> {
    transition * point
}

/// Predicted mean — zhu2016 (21)-(23), liu2017 (17).
///
/// ```text
/// x̂⁻ = Σₛ wₛ X*ₛ
/// ```
///
/// | paper | here      | shape | meaning               |
/// |-------|-----------|-------|-----------------------|
/// | wₛ    | `weights` | L     | the rule's weights    |
/// | X*ₛ   | `points`  | L × N | the propagated points |
///
/// Why: the rule's approximation of E f(x). zhu2016 sums its three orbits apart, in (22) and (23).
///
/// Evidence: as [`point`](fn@point).
pub fn weighted_mean<T: Field, const N: usize>(weights: &[T], points: &[SVector<T, N>]) -> SVector<T, N> {
    let mut mean = SVector::zeros();
    for (weight, point) in weights.iter().zip(points) {
        mean += point * weight.clone();
    }
    mean
}

/// Predicted covariance — liu2017 (17).
///
/// ```text
/// P⁻ = Σₛ wₛ (X*ₛ − x̂⁻)(X*ₛ − x̂⁻)ᵀ + Q
/// ```
///
/// | paper | here      | shape | meaning                                |
/// |-------|-----------|-------|----------------------------------------|
/// | wₛ    | `weights` | L     | the rule's weights for covariances     |
/// | X*ₛ   | `points`  | L × N | the propagated points                  |
/// | x̂⁻    | `mean`    | N     | [`weighted_mean`]                      |
/// | Q     | `noise`   | N × N | process noise                          |
///
/// Why: the noise is independent of the state, so covariances add, and add once.
///
/// Errata: liu2017 (17) is typeset with Q inside the braces of the sum (notational as long as the weights sum to one).
///
/// Evidence: as [`point`](fn@point), `raw_and_centred_second_moments_agree` (symbolic).
pub fn weighted_covariance<T: Field, const N: usize>(
    weights: &[T],
    points: &[SVector<T, N>],
    mean: &SVector<T, N>,
    noise: &SMatrix<T, N, N>,
) -> SMatrix<T, N, N> {
    let mut covariance = noise.clone();
    for (weight, point) in weights.iter().zip(points) {
        let deviation = point - mean;
        covariance += (&deviation * deviation.transpose()) * weight.clone();
    }
    covariance
}

/// Innovation covariance — sustika2015 (32), liu2017 (19).
///
/// ```text
/// P_zz = Σₛ wₛ (Zₛ − ẑ)(Zₛ − ẑ)ᵀ + R
/// ```
///
/// | paper | here          | shape | meaning                                                     |
/// |-------|---------------|-------|-------------------------------------------------------------|
/// | wₛ    | `weights`     | L     | the rule's weights for covariances                           |
/// | Zₛ    | `values`      | L × M | the measurements of the points, angles' differences wrapped  |
/// | ẑ     | `mean`        | M     | predicted measurement, [`Measurement::mean`]                 |
/// | R     | `noise`       | M × M | measurement noise                                            |
///
/// Errata: R is typeset inside the sum, as Q in (17) (notational).
///
/// Evidence: as [`point`](fn@point).
pub fn innovation_covariance<T: Real, const N: usize, const M: usize>(
    measurement: &Measurement<T, N, M>,
    weights: &[T],
    values: &[SVector<T, M>],
    mean: &SVector<T, M>,
    noise: &SMatrix<T, M, M>,
) -> SMatrix<T, M, M> {
    let mut covariance = noise.clone();
    for (weight, value) in weights.iter().zip(values) {
        let deviation = measurement.difference(value, mean);
        covariance += (&deviation * deviation.transpose()) * weight.clone();
    }
    covariance
}

/// Cross-covariance of state and measurement — sustika2015 (33), liu2017 (19).
///
/// ```text
/// P_xz = Σₛ wₛ (χₛ − x̂⁻)(Zₛ − ẑ)ᵀ
/// ```
///
/// | paper | here           | shape | meaning                                                     |
/// |-------|----------------|-------|-------------------------------------------------------------|
/// | wₛ    | `weights`      | L     | the rule's weights for covariances                           |
/// | χₛ    | `points`       | L × N | the points drawn afresh from the prediction                  |
/// | x̂⁻    | `mean`         | N     | predicted mean                                               |
/// | Zₛ    | `values`       | L × M | the measurements of the points, angles' differences wrapped  |
/// | ẑ     | `value_mean`   | M     | predicted measurement                                        |
///
/// Evidence: as [`point`](fn@point).
pub fn cross_covariance<T: Real, const N: usize, const M: usize>(
    measurement: &Measurement<T, N, M>,
    weights: &[T],
    points: &[SVector<T, N>],
    mean: &SVector<T, N>,
    values: &[SVector<T, M>],
    value_mean: &SVector<T, M>,
) -> SMatrix<T, N, M> {
    let mut covariance = SMatrix::zeros();
    for ((weight, point), value) in weights.iter().zip(points).zip(values) {
        let state_deviation = point - mean;
        let deviation = measurement.difference(value, value_mean);
        covariance += (state_deviation * deviation.transpose()) * weight.clone();
    }
    covariance
}
