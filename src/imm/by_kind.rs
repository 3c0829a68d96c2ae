//! Which equation each kind of filter takes for a value of one mode.
//!
//! Here, and nowhere else, the cycle asks what kind a filter is. Each function is one value: it takes what the value is computed from,
//! looks at the filter of mode j, and calls the equation of its kind. The [table](super::equations) calls them with what stands in the
//! record, the [plain cycle](super::plain) with what it has just computed, so that both compute the same bits.
//!
//! They are inlined, since a compiler that sees them all together asks for the kind once: a plain step of three Kalman filters then has
//! 6275 instructions instead of 7512.

use super::Problem;
use super::angles::{points_near, wrapped};
use super::equations::{Factored, Iterate, Points};
use super::probability;
use super::problem::Interaction;
use super::state_conversion::Reader;
use crate::filter::{Transform, Update, converted, correlated, cubature, extended, iterated, kalman, update};
use crate::gaussian::Gaussian;
use crate::matrix::{Holds, Shapes};
use crate::model::motion::Motion;
use crate::number::Real;
use nalgebra::{Dim, OMatrix, OVector};
use std::borrow::Cow;

/// μᵢ∣ⱼ.
#[inline(always)]
pub(super) fn mixing_probability<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    mode_probabilities: &[T],
    predicted_mode_probability: &T,
    i: usize,
    j: usize,
) -> T
where
    Shapes: Holds<N, M>,
{
    match &problem.interaction {
        Interaction::Imm | Interaction::Converted(_) => {
            probability::mixing_probability(&problem.chain, mode_probabilities, predicted_mode_probability, i, j)
        }
        Interaction::Gpb1 => mode_probabilities[i].clone(),
        Interaction::Unmixed if i == j => T::one(),
        Interaction::Unmixed => T::zero(),
    }
}

/// The points of the mixed estimate; none for a filter that draws none.
#[inline(always)]
pub(super) fn mixed_points<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    j: usize,
    mixed: &Gaussian<T, N>,
) -> Factored<Points<T, N>>
where
    Shapes: Holds<N, M>,
{
    match &problem.filter(j).predict {
        Transform::Exact | Transform::Linearised => Ok(Vec::new()),
        Transform::Points(rule) => cubature::points(rule, mixed),
    }
}

/// The points after the motion.
#[inline(always)]
pub(super) fn propagated_points<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    j: usize,
    mixed_points: &[OVector<T, N>],
) -> Points<T, N>
where
    Shapes: Holds<N, M>,
{
    let points = mixed_points.iter();
    match &problem.modes[j].motion {
        Motion::Linear(f) => points.map(|point| cubature::propagated_point(f, point)).collect(),
        motion => points.map(|point| motion.of(point)).collect(),
    }
}

/// The predicted mean.
#[inline(always)]
pub(super) fn predicted_mean<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    j: usize,
    mixed_mean: &OVector<T, N>,
    propagated_points: &[OVector<T, N>],
) -> OVector<T, N>
where
    Shapes: Holds<N, M>,
{
    let motion = &problem.modes[j].motion;
    match &problem.filter(j).predict {
        Transform::Exact | Transform::Linearised => match motion {
            Motion::Linear(f) => kalman::predicted_mean(f, mixed_mean),
            motion => motion.of(mixed_mean),
        },
        Transform::Points(rule) if problem.angles_of(Reader::Mode(j)).is_empty() => {
            cubature::weighted_mean(&rule.weights, propagated_points)
        }
        Transform::Points(rule) => {
            let points = points_near(problem, j, propagated_points, &motion.of(mixed_mean));
            cubature::weighted_mean(&rule.weights, &points)
        }
    }
}

/// The Jacobian of the motion; none for a filter that does not linearise it.
#[inline(always)]
pub(super) fn motion_jacobian<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    j: usize,
    mixed_mean: &OVector<T, N>,
) -> Option<OMatrix<T, N, N>>
where
    Shapes: Holds<N, M>,
{
    match &problem.filter(j).predict {
        Transform::Linearised => Some(extended::motion_jacobian(&problem.modes[j].motion, mixed_mean)),
        Transform::Exact | Transform::Points(_) => None,
    }
}

/// F as the filter uses it, or would: the matrix of its motion, or the Jacobian of a function.
#[inline(always)]
pub(super) fn motion_matrix<'a, T: Real, N: Dim, M: Dim>(
    problem: &'a Problem<T, N, M>,
    j: usize,
    mixed_mean: &OVector<T, N>,
    jacobian: Option<&'a OMatrix<T, N, N>>,
) -> Cow<'a, OMatrix<T, N, N>>
where
    Shapes: Holds<N, M>,
{
    match (jacobian, &problem.modes[j].motion) {
        (Some(jacobian), _) => Cow::Borrowed(jacobian),
        (None, motion @ Motion::Function { .. }) => Cow::Owned(extended::motion_jacobian(motion, mixed_mean)),
        (None, motion) => motion.matrix(),
    }
}

/// The predicted covariance.
#[inline(always)]
pub(super) fn predicted_covariance<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    j: usize,
    mixed: &Gaussian<T, N>,
    jacobian: Option<&OMatrix<T, N, N>>,
    propagated_points: &[OVector<T, N>],
    predicted_mean: &OVector<T, N>,
) -> OMatrix<T, N, N>
where
    Shapes: Holds<N, M>,
{
    let q = &problem.modes[j].noise;
    match &problem.filter(j).predict {
        Transform::Exact | Transform::Linearised => {
            let f = motion_matrix(problem, j, &mixed.mean, jacobian);
            kalman::predicted_covariance(&f, &mixed.covariance, q)
        }
        Transform::Points(rule) => {
            let points = points_near(problem, j, propagated_points, predicted_mean);
            cubature::weighted_covariance(&rule.covariance_weights, &points, predicted_mean, q)
        }
    }
}

/// D, the covariance of the state before the motion and after it: what a smoother makes its gain of.
#[inline(always)]
pub(crate) fn motion_cross_covariance<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    j: usize,
    mixed: &Gaussian<T, N>,
    jacobian: Option<&OMatrix<T, N, N>>,
    mixed_points: &[OVector<T, N>],
    propagated_points: &[OVector<T, N>],
    predicted_mean: &OVector<T, N>,
) -> OMatrix<T, N, N>
where
    Shapes: Holds<N, M>,
{
    match &problem.filter(j).predict {
        Transform::Exact | Transform::Linearised => {
            let f = motion_matrix(problem, j, &mixed.mean, jacobian);
            kalman::cross_covariance::<T, N, N>(&mixed.covariance, &f)
        }
        Transform::Points(rule) => {
            let propagated = points_near(problem, j, propagated_points, predicted_mean);
            let weights = &rule.covariance_weights;
            cubature::motion_cross_covariance(weights, mixed_points, &mixed.mean, &propagated, predicted_mean)
        }
    }
}

/// x_{N−1}; none for a filter that linearises the measurement at the predicted mean, or not at all.
#[inline(always)]
pub(super) fn linearisation_point<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    j: usize,
    predicted: &Gaussian<T, N>,
    z: &OVector<T, M>,
) -> Factored<Iterate<T, N>>
where
    Shapes: Holds<N, M>,
{
    match &problem.filter(j).update {
        Update::Iterated(times) => {
            iterated::linearisation_point(*times, &problem.sensor, predicted, z, &problem.measurement_noise)
        }
        _ => Ok(None),
    }
}

/// The points of the prediction; none for a filter that draws none.
#[inline(always)]
pub(super) fn predicted_points<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    j: usize,
    predicted: &Gaussian<T, N>,
) -> Factored<Points<T, N>>
where
    Shapes: Holds<N, M>,
{
    match &problem.filter(j).update {
        Update::By(Transform::Points(rule)) => cubature::points(rule, predicted),
        _ => Ok(Vec::new()),
    }
}

/// What the filter expects to measure of a state: h(x), or the position, to which range and bearing are converted.
#[inline(always)]
pub(crate) fn seen<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    state: &OVector<T, N>,
    j: usize,
) -> OVector<T, M>
where
    Shapes: Holds<N, M>,
{
    let state = &*problem.in_common_state(j, state);
    match &problem.filter(j).update {
        Update::Converted(_) => &*problem.h() * state,
        _ => problem.sensor.of(state),
    }
}

/// ẑ.
#[inline(always)]
pub(super) fn predicted_measurement<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    j: usize,
    predicted_mean: &OVector<T, N>,
    linearisation_point: Option<&OVector<T, N>>,
    measured_points: &[OVector<T, M>],
) -> OVector<T, M>
where
    Shapes: Holds<N, M>,
{
    match (&problem.filter(j).update, linearisation_point) {
        (Update::By(Transform::Points(rule)), _) => {
            let centre = seen(problem, predicted_mean, j);
            problem.sensor.mean(&rule.weights, measured_points, &centre)
        }
        (_, Some(at)) => iterated::measurement_of_the_tangent(&problem.sensor, at, predicted_mean),
        (_, None) => seen(problem, predicted_mean, j),
    }
}

/// How far two measurements are apart for the filter of mode j: angles are wrapped, and a converted measurement has none.
#[inline(always)]
pub(crate) fn difference<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    a: &OVector<T, M>,
    b: &OVector<T, M>,
    j: usize,
) -> OVector<T, M>
where
    Shapes: Holds<N, M>,
{
    match &problem.filter(j).update {
        Update::Converted(_) => a - b,
        _ => problem.sensor.difference(a, b),
    }
}

/// The measurement as a position; none where no filter converts.
#[inline(always)]
pub(super) fn converted_measurement<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    z: &OVector<T, M>,
) -> Option<OVector<T, M>>
where
    Shapes: Holds<N, M>,
{
    converted::converted_measurement(problem.conversion()?, &problem.sensor, z, &problem.measurement_noise)
}

/// R^c; none where no filter converts.
#[inline(always)]
pub(super) fn converted_covariance<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    z: &OVector<T, M>,
) -> Option<OMatrix<T, M, M>>
where
    Shapes: Holds<N, M>,
{
    converted::converted_covariance(problem.conversion()?, &problem.sensor, z, &problem.measurement_noise)
}

/// What the filter uses of a measurement, z itself or the converted measurement; likewise R.
#[inline(always)]
pub(super) fn used<'a, T: Real, N: Dim, M: Dim, V>(
    problem: &Problem<T, N, M>,
    j: usize,
    measured: &'a V,
    converted: Option<&'a V>,
) -> &'a V
where
    Shapes: Holds<N, M>,
{
    match (&problem.filter(j).update, converted) {
        (Update::Converted(_), Some(converted)) => converted,
        _ => measured,
    }
}

/// The Jacobian of the measurement, of the mode's own state; none for a filter that does not linearise it.
#[inline(always)]
pub(super) fn measurement_jacobian<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    j: usize,
    predicted_mean: &OVector<T, N>,
    linearisation_point: Option<&OVector<T, N>>,
) -> Option<OMatrix<T, M, N>>
where
    Shapes: Holds<N, M>,
{
    let at = linearisation_point.unwrap_or(predicted_mean);
    let linearises = problem.filter(j).linearises_the_measurement();
    linearises.then(|| problem.slopes_of_measurement(j, at))
}

/// H as the filter uses it: the Jacobian of the measurement where it linearises, else the matrix [`Problem::h`].
#[inline(always)]
pub(super) fn measurement_matrix<'a, T: Real, N: Dim, M: Dim>(
    problem: &'a Problem<T, N, M>,
    j: usize,
    jacobian: Option<&'a OMatrix<T, M, N>>,
) -> Cow<'a, OMatrix<T, M, N>>
where
    Shapes: Holds<N, M>,
{
    match jacobian {
        Some(jacobian) => Cow::Borrowed(jacobian),
        None => problem.h_of(j),
    }
}

/// S.
#[inline(always)]
pub(super) fn innovation_covariance<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    j: usize,
    predicted_covariance: &OMatrix<T, N, N>,
    jacobian: Option<&OMatrix<T, M, N>>,
    measured_points: &[OVector<T, M>],
    predicted_measurement: &OVector<T, M>,
    noise: &OMatrix<T, M, M>,
) -> OMatrix<T, M, M>
where
    Shapes: Holds<N, M>,
{
    let filter = problem.filter(j);
    match &filter.update {
        Update::By(Transform::Points(rule)) => {
            let (sensor, weights) = (&problem.sensor, &rule.covariance_weights);
            cubature::innovation_covariance(sensor, weights, measured_points, predicted_measurement, noise)
        }
        Update::Given(given) => given.innovation_covariance.clone(),
        Update::By(Transform::Exact | Transform::Linearised) | Update::Iterated(_) | Update::Converted(_) => {
            let h = measurement_matrix(problem, j, jacobian);
            match &filter.noise_cross_covariance {
                Some(of_noises) => correlated::innovation_covariance(&h, predicted_covariance, noise, of_noises),
                None => kalman::innovation_covariance(&h, predicted_covariance, noise),
            }
        }
    }
}

/// C.
#[inline(always)]
pub(super) fn cross_covariance<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    j: usize,
    predicted: &Gaussian<T, N>,
    jacobian: Option<&OMatrix<T, M, N>>,
    predicted_points: &[OVector<T, N>],
    measured_points: &[OVector<T, M>],
    predicted_measurement: &OVector<T, M>,
) -> OMatrix<T, N, M>
where
    Shapes: Holds<N, M>,
{
    let filter = problem.filter(j);
    match (&filter.update, &filter.noise_cross_covariance) {
        (Update::By(Transform::Points(rule)), _) => cubature::cross_covariance(
            &problem.sensor,
            &rule.covariance_weights,
            predicted_points,
            &predicted.mean,
            measured_points,
            predicted_measurement,
        ),
        (_, Some(of_noises)) => correlated::cross_covariance(
            &predicted.covariance,
            &measurement_matrix(problem, j, jacobian),
            of_noises,
        ),
        (_, None) => kalman::cross_covariance(&predicted.covariance, &measurement_matrix(problem, j, jacobian)),
    }
}

/// W where it is given; none where it is computed.
#[inline(always)]
pub(super) fn given_gain<T: Real, N: Dim, M: Dim>(problem: &Problem<T, N, M>, j: usize) -> Option<&OMatrix<T, N, M>>
where
    Shapes: Holds<N, M>,
{
    match &problem.filter(j).update {
        Update::Given(given) => Some(&given.gain),
        _ => None,
    }
}

/// The updated mean, its angles in (−π, π].
#[inline(always)]
pub(super) fn updated_mean<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    j: usize,
    predicted_mean: &OVector<T, N>,
    gain: &OMatrix<T, N, M>,
    innovation: &OVector<T, M>,
) -> OVector<T, N>
where
    Shapes: Holds<N, M>,
{
    let mean = update::updated_mean(predicted_mean, gain, innovation);
    wrapped(problem.angles_of(Reader::Mode(j)), mean)
}
