//! Moments by points and weights: the equations of every cubature filter, unscented and Gauss-Hermite included.
//!
//! Such a filter is a Kalman filter whose four moments (predicted mean and covariance, ẑ and its covariances) are weighted sums over
//! points. The rule ([`crate::rule`]) is an argument; nothing here depends on which rule it is.
//!
//! ```text
//! x̂⁰, P⁰ ─ cholesky ─▶ S ─ point ─▶ X ─ propagated_point ─▶ X* ─ weighted_mean, weighted_covariance ─▶ x̂⁻, P⁻
//! x̂⁻, P⁻ ─ cholesky ─▶ S ─ point ─▶ X ─ Sensor::of ──▶ Z ─ Sensor::mean ─▶ ẑ
//!                                   └──────────────────────┴─ innovation_covariance, cross_covariance ─▶ S, C ─▶ super::update
//! ```
//!
//! The equations are in the centred form of liu2017. Those of zhu2016 about the origin are in [`super::raw`].

use crate::gaussian::Gaussian;
use crate::matrix::{Holds, NotPositiveDefinite, Shapes, cholesky, rows};
use crate::model::Sensor;
use crate::number::{Field, Real};
use crate::rule::Rule;
use nalgebra::{Dim, OMatrix, OVector, U1};

/// A point of the estimate — sustika2015 (27)-(29), zhu2016 (2)-(8), (28)-(34), liu2017 (14), (18).
///
/// ```text
/// X = S ξ + x̂
/// ```
///
/// | paper | here          | shape | meaning                                                                    |
/// |-------|---------------|-------|----------------------------------------------------------------------------|
/// | S     | `square_root` | N × N | Cholesky factor of the covariance, [`cholesky`]    |
/// | ξ     | `point`       | N     | a point of the rule for the standard Gaussian                               |
/// | x̂     | `mean`        | N     | the centre                                                                 |
///
/// Why: if ξ has zero mean and unit covariance under the rule's weights, X has mean x̂ and covariance S Sᵀ.
///
/// After the prediction the points are drawn afresh from the predicted mean and covariance, zhu2016 (28)-(34) and
/// liu2017 (18): the propagated ones know nothing of the process noise. sustika2015 draws points for the measurement only and
/// predicts by the Kalman filter's equations, which for a linear motion gives the same moments.
///
/// Example: in one dimension the two points of the third-degree rule, ξ = ±1, lie one deviation beside the mean. In two it matters that the
/// factor is the lower one: the upper one, which some libraries return, gives another point.
///
/// ```
/// use immaculate::filter::cubature::point;
/// use nalgebra::{matrix, vector};
///
/// assert_eq!(point(&matrix![2.0], &vector![1.0], &vector![5.0]), vector![7.0]); // 2 · 1 + 5
/// assert_eq!(point(&matrix![2.0], &vector![-1.0], &vector![5.0]), vector![3.0]);
///
/// let lower = matrix![2.0, 0.0; 1.0, 3.0];
/// // (2 · 1 + 10, 1 · 1 − 3 · 1 + 20)
/// assert_eq!(point(&lower, &vector![1.0, -1.0], &vector![10.0, 20.0]), vector![12.0, 18.0]);
/// assert_eq!(point(&lower.transpose(), &vector![1.0, -1.0], &vector![10.0, 20.0]), vector![11.0, 17.0]);
/// ```
///
/// Errata: liu2017 (14) leaves the hat off the mean, and zhu2016 (2), (28) give the centre a superfluous index (notational).
///
/// Evidence: `a_linear_filter_with_any_rule_of_degree_two_is_the_kalman_filter` (symbolic).
pub fn point<T: Field, N: Dim>(
    square_root: &OMatrix<T, N, N>,
    point: &OVector<T, N>,
    mean: &OVector<T, N>,
) -> OVector<T, N>
where
    Shapes: Holds<N>,
{
    square_root * point + mean
}

/// All points of an estimate: [`point`](fn@point) for each ξ of the rule, with the Cholesky factor of the covariance.
///
/// Source: sustika2015 (27)-(29), zhu2016 (1)-(8), (27)-(34), liu2017 (14), (18).
///
/// Example: two points, one deviation of 2 beside the mean 5.
///
/// ```
/// use immaculate::{filter::cubature::points, gaussian::Gaussian, rule::{Rule, third_degree::third_degree}};
/// use nalgebra::{matrix, vector};
///
/// let rule = Rule::from_exact(&third_degree(1)?)?;
/// let estimate = Gaussian { mean: vector![5.0], covariance: matrix![4.0] };
/// assert_eq!(points(&rule, &estimate).unwrap(), [vector![7.0], vector![3.0]]);
/// # Ok::<(), immaculate::rule::InvalidRule>(())
/// ```
///
/// # Errors
///
/// [`NotPositiveDefinite`] as of [`cholesky`].
pub fn points<T: Real, N: Dim>(
    rule: &Rule<T, N>,
    estimate: &Gaussian<T, N>,
) -> Result<Vec<OVector<T, N>>, NotPositiveDefinite>
where
    Shapes: Holds<N>,
{
    let root = cholesky(&estimate.covariance)?;
    let points = rule.points.iter().map(|xi| point(&root, xi, &estimate.mean));
    Ok(points.collect())
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
/// Example: the points 7 and 3 under a motion that doubles the state.
///
/// ```
/// use immaculate::filter::cubature::propagated_point;
/// use nalgebra::{matrix, vector};
///
/// let [high, low] = [7.0, 3.0].map(|x| propagated_point(&matrix![2.0], &vector![x]));
/// assert_eq!((high, low), (vector![14.0], vector![6.0]));
/// ```
///
/// Evidence: as [`point`](fn@point).
pub fn propagated_point<T: Field, N: Dim>(transition: &OMatrix<T, N, N>, point: &OVector<T, N>) -> OVector<T, N>
where
    Shapes: Holds<N>,
{
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
/// Example: of the propagated points 14 and 6, which weigh the same. A linear filter has it from the mean alone: 2 · 5.
///
/// ```
/// use immaculate::filter::cubature::weighted_mean;
/// use nalgebra::vector;
///
/// assert_eq!(weighted_mean(&[0.5, 0.5], &[vector![14.0], vector![6.0]]), vector![10.0]); // ½ · 14 + ½ · 6
/// ```
///
/// Evidence: as [`point`](fn@point).
pub fn weighted_mean<T: Field, N: Dim>(weights: &[T], points: &[OVector<T, N>]) -> OVector<T, N>
where
    Shapes: Holds<N>,
{
    let mut mean = OVector::zeros_generic(rows(&points[0]), U1);
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
/// Example: of the same points, with Q = 9. A linear filter has 2 · 4 · 2 + 9 too. Without Q, or about another mean, it is another number.
///
/// ```
/// use immaculate::filter::cubature::weighted_covariance;
/// use nalgebra::{matrix, vector};
///
/// let points = [vector![14.0], vector![6.0]];
/// let of = |mean: f64, noise: f64| weighted_covariance(&[0.5, 0.5], &points, &vector![mean], &matrix![noise]);
/// assert_eq!(of(10.0, 9.0), matrix![25.0]); // ½ · 4² + ½ · 4² + 9
/// assert_eq!(of(10.0, 0.0), matrix![16.0]);
/// assert_eq!(of(5.0, 9.0), matrix![50.0]); // ½ · 9² + ½ · 1² + 9, about the mean before the motion
/// ```
///
/// Errata: liu2017 (17) is typeset with Q inside the braces of the sum (notational as long as the weights sum to one).
///
/// Evidence: as [`point`](fn@point), `raw_and_centred_second_moments_agree` (symbolic).
pub fn weighted_covariance<T: Field, N: Dim>(
    weights: &[T],
    points: &[OVector<T, N>],
    mean: &OVector<T, N>,
    noise: &OMatrix<T, N, N>,
) -> OMatrix<T, N, N>
where
    Shapes: Holds<N>,
{
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
/// | ẑ     | `mean`        | M     | predicted measurement, [`Sensor::mean`]                 |
/// | R     | `noise`       | M × M | measurement noise                                            |
///
/// Example: the points drawn afresh from 10 and 25 are 15 and 5; of a sensor that sees twice the state they are 30 and 10. The propagated
/// ones, 14 and 6, are too near to each other: they know nothing of Q.
///
/// ```
/// use immaculate::{filter::cubature::innovation_covariance, model::Sensor};
/// use nalgebra::{matrix, vector};
///
/// let (sensor, weights) = (Sensor::Linear(matrix![2.0]), [0.5, 0.5]);
/// let of = |values: [f64; 2]| {
///     innovation_covariance(&sensor, &weights, &values.map(|z| vector![z]), &vector![20.0], &matrix![100.0])
/// };
/// assert_eq!(of([30.0, 10.0]), matrix![200.0]); // ½ · 10² + ½ · 10² + 100
/// assert_eq!(of([28.0, 12.0]), matrix![164.0]); // ½ · 8² + ½ · 8² + 100
/// ```
///
/// Errata: R is typeset inside the sum, as Q in (17) (notational).
///
/// Evidence: as [`point`](fn@point).
pub fn innovation_covariance<T: Real, N: Dim, M: Dim>(
    sensor: &Sensor<T, N, M>,
    weights: &[T],
    values: &[OVector<T, M>],
    mean: &OVector<T, M>,
    noise: &OMatrix<T, M, M>,
) -> OMatrix<T, M, M>
where
    Shapes: Holds<N, M>,
{
    let mut covariance = noise.clone();
    for (weight, value) in weights.iter().zip(values) {
        let deviation = sensor.difference(value, mean);
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
/// Example: the same points 15 and 5 with their measurements 30 and 10.
///
/// ```
/// use immaculate::{filter::cubature::cross_covariance, model::Sensor};
/// use nalgebra::{matrix, vector};
///
/// let (points, values) = ([vector![15.0], vector![5.0]], [vector![30.0], vector![10.0]]);
/// let sensor = Sensor::Linear(matrix![2.0]);
/// let covariance = cross_covariance(&sensor, &[0.5, 0.5], &points, &vector![10.0], &values, &vector![20.0]);
/// assert_eq!(covariance, matrix![50.0]); // ½ · 5 · 10 + ½ · (−5) · (−10)
/// ```
///
/// Evidence: as [`point`](fn@point).
pub fn cross_covariance<T: Real, N: Dim, M: Dim>(
    sensor: &Sensor<T, N, M>,
    weights: &[T],
    points: &[OVector<T, N>],
    mean: &OVector<T, N>,
    values: &[OVector<T, M>],
    value_mean: &OVector<T, M>,
) -> OMatrix<T, N, M>
where
    Shapes: Holds<N, M>,
{
    let mut covariance = OMatrix::zeros_generic(rows(mean), rows(value_mean));
    for ((weight, point), value) in weights.iter().zip(points).zip(values) {
        let state_deviation = point - mean;
        let deviation = sensor.difference(value, value_mean);
        covariance += (state_deviation * deviation.transpose()) * weight.clone();
    }
    covariance
}

/// Covariance of a state and the next one, D, from which smoothers compute their gain.
///
/// Source: S. Särkkä, Unscented Rauch-Tung-Striebel Smoother, 2008.
///
/// ```text
/// D = Σₛ wₛ (χₛ − x̂⁰)(χ*ₛ − x̂⁻)ᵀ
/// ```
///
/// | literature | here             | shape | meaning                                                            |
/// |------------|------------------|-------|--------------------------------------------------------------------|
/// | wₛ         | `weights`        | L     | the rule's weights for covariances                                 |
/// | χₛ         | `points`         | L × N | the points of the estimate before the motion                       |
/// | x̂⁰         | `mean`           | N     | its mean                                                           |
/// | χ*ₛ        | `propagated`     | L × N | the propagated points, angles in the turn of x̂⁻                    |
/// | x̂⁻         | `predicted_mean` | N     | predicted mean                                                     |
///
/// Why: the noise of the motion is independent of the state before it, so that Q has no part in D.
///
/// Example: the points 7 and 3 of a state that doubles. By matrices it is 4 · 2.
///
/// ```
/// use immaculate::filter::cubature::motion_cross_covariance;
/// use nalgebra::{matrix, vector};
///
/// let (points, propagated) = ([vector![7.0], vector![3.0]], [vector![14.0], vector![6.0]]);
/// let covariance = motion_cross_covariance(&[0.5, 0.5], &points, &vector![5.0], &propagated, &vector![10.0]);
/// assert_eq!(covariance, matrix![8.0]); // ½ · 2 · 4 + ½ · (−2) · (−4)
/// ```
///
/// Evidence: `points_of_a_linear_motion_have_the_cross_covariance_of_its_matrix` (smoothers, exact).
pub fn motion_cross_covariance<T: Field, N: Dim>(
    weights: &[T],
    points: &[OVector<T, N>],
    mean: &OVector<T, N>,
    propagated: &[OVector<T, N>],
    predicted_mean: &OVector<T, N>,
) -> OMatrix<T, N, N>
where
    Shapes: Holds<N>,
{
    let mut covariance = OMatrix::zeros_generic(rows(mean), rows(mean));
    for ((weight, point), moved) in weights.iter().zip(points).zip(propagated) {
        let deviation = moved - predicted_mean;
        covariance += ((point - mean) * deviation.transpose()) * weight.clone();
    }
    covariance
}
