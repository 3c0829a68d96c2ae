//! Second moments about the origin, as zhu2016 prints them: the same numbers as the centred form, with fewer digits.
//!
//! Both forms are tied by the identity Σ w (X − x̂)(X − x̂)ᵀ = Σ w X Xᵀ − x̂ x̂ᵀ, valid if Σ w = 1 and x̂ = Σ w X. The price of this form:
//! at a position of 10⁴ m with a covariance of 1 m², it subtracts two numbers of 10⁸ m² and loses eight of sixteen digits.
//!
//! These are *forms*: other algebra for the same exact values. They are right for measurements without angles only, since the
//! raw moment of an angle depends on where the circle is cut, and for weights that sum to one, which the covariance weights of the
//! (α, β, κ) unscented rule do not.

use crate::matrix::{Holds, Shapes, rows};
use crate::number::Field;
use nalgebra::{Dim, OMatrix, OVector};

/// Predicted covariance about the origin — zhu2016 (24)-(26).
///
/// ```text
/// P⁻ = Σₛ wₛ X*ₛ X*ₛᵀ − x̂⁻ x̂⁻ᵀ + Q
/// ```
///
/// | paper | here      | shape | meaning                            |
/// |-------|-----------|-------|------------------------------------|
/// | wₛ    | `weights` | L     | the rule's weights                 |
/// | X*ₛ   | `points`  | L × N | the propagated points              |
/// | x̂⁻    | `mean`    | N     | predicted mean                     |
/// | Q     | `noise`   | N × N | process noise                      |
///
/// With Zₛ, ẑ and R in the places of X*ₛ, x̂⁻ and Q this is the innovation covariance — zhu2016 (45)-(47).
///
/// Example: the points 14 and 6 have the mean square 116. Less the squared mean that is 16, and with the noise 25; at a large distance it
/// is nothing but rounding.
///
/// ```
/// use immaculate::filter::raw::raw_covariance;
/// use nalgebra::{matrix, vector};
///
/// let of = |at: f64| {
///     let points = [vector![at + 4.0], vector![at - 4.0]];
///     raw_covariance(&[0.5, 0.5], &points, &vector![at], &matrix![9.0])
/// };
/// assert_eq!(of(10.0), matrix![25.0]); // ½ · 14² + ½ · 6² − 10² + 9
/// assert_eq!(of(1e9), matrix![9.0]); // 10¹⁸ + 16 is 10¹⁸ as a double
/// ```
///
/// Errata: (24) lacks the last two terms: as printed it is the raw second moment, about 10⁶ m² at the paper's start, and never
/// sees the noise. (45) has them. (47) prints its upper limit as n(n − 1)2 for n(n − 1)/2.
///
/// Evidence: `raw_and_centred_second_moments_agree` (symbolic),
/// `printed_predicted_covariance_is_a_raw_second_moment_without_noise`,
/// `printed_upper_limit_counts_points_that_do_not_exist`, `the_raw_form_loses_the_digits_of_the_squared_position` (property).
pub fn raw_covariance<T: Field, N: Dim>(
    weights: &[T],
    points: &[OVector<T, N>],
    mean: &OVector<T, N>,
    noise: &OMatrix<T, N, N>,
) -> OMatrix<T, N, N>
where
    Shapes: Holds<N>,
{
    raw_second_moment(weights, points) - mean * mean.transpose() + noise
}

/// The sum of weighted squares alone, which zhu2016 (24) prints for the predicted covariance: Σₛ wₛ X*ₛ X*ₛᵀ.
///
/// Example: of the points 14 and 6, where the covariance of the prediction is 25.
///
/// ```
/// use immaculate::filter::raw::raw_second_moment;
/// use nalgebra::{matrix, vector};
///
/// assert_eq!(raw_second_moment(&[0.5, 0.5], &[vector![14.0], vector![6.0]]), matrix![116.0]); // ½ · 14² + ½ · 6²
/// ```
///
/// Evidence: `printed_predicted_covariance_is_a_raw_second_moment_without_noise`.
pub fn raw_second_moment<T: Field, N: Dim>(weights: &[T], points: &[OVector<T, N>]) -> OMatrix<T, N, N>
where
    Shapes: Holds<N>,
{
    let mut moment = OMatrix::zeros_generic(rows(&points[0]), rows(&points[0]));
    for (weight, point) in weights.iter().zip(points) {
        moment += (point * point.transpose()) * weight.clone();
    }
    moment
}

/// Cross-covariance about the origin — zhu2016 (48)-(50).
///
/// ```text
/// P_xz = Σₛ wₛ Xₛ Zₛᵀ − x̂⁻ ẑᵀ
/// ```
///
/// | paper | here         | shape | meaning                                       |
/// |-------|--------------|-------|-----------------------------------------------|
/// | wₛ    | `weights`    | L     | the rule's weights                            |
/// | Xₛ    | `points`     | L × N | the points drawn afresh from the prediction   |
/// | x̂⁻    | `mean`       | N     | predicted mean                                |
/// | Zₛ    | `values`     | L × M | the measurements of the points                |
/// | ẑ     | `value_mean` | M     | predicted measurement                         |
///
/// Example: the points 15 and 5 with their measurements 30 and 10.
///
/// ```
/// use immaculate::filter::raw::raw_cross_covariance;
/// use nalgebra::{matrix, vector};
///
/// let (points, values) = ([vector![15.0], vector![5.0]], [vector![30.0], vector![10.0]]);
/// let covariance = raw_cross_covariance(&[0.5, 0.5], &points, &vector![10.0], &values, &vector![20.0]);
/// assert_eq!(covariance, matrix![50.0]); // ½ · 15 · 30 + ½ · 5 · 10 − 10 · 20
/// ```
///
/// Evidence: `raw_and_centred_second_moments_agree` (symbolic).
pub fn raw_cross_covariance<T: Field, N: Dim, M: Dim>(
    weights: &[T],
    points: &[OVector<T, N>],
    mean: &OVector<T, N>,
    values: &[OVector<T, M>],
    value_mean: &OVector<T, M>,
) -> OMatrix<T, N, M>
where
    Shapes: Holds<N, M>,
{
    let mut moment = OMatrix::zeros_generic(rows(mean), rows(value_mean));
    for ((weight, point), value) in weights.iter().zip(points).zip(values) {
        moment += (point * value.transpose()) * weight.clone();
    }
    moment - mean * value_mean.transpose()
}
