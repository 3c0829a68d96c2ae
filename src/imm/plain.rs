//! The cycle without a record: the same equations in the same order, in local variables, for programs that need the estimates alone.
//!
//! [`Imm`](super::Imm) writes every value of a step into its record, where observers, variants and the judge find it, and moving those
//! lists costs more than the arithmetic of a Kalman filter. [`PlainImm`] keeps the estimates of the modes, their probabilities, and the
//! combined estimate. It has no combined prediction, no normalised squares and no variants; what it has is the same to the last bit.
//!
//! ```text
//! estimates, probabilities ─▶ mix ─▶ predict each mode ─▶ update each mode ─▶ weigh ─▶ combine ─▶ estimates, probabilities
//! ```

use super::angles::{estimates_near, estimates_near_first, wrapped};
use super::by_kind;
use super::equations::Points;
use super::failure::{Cause, Failure, check_combined, check_measurement, check_slopes, failure, not_definite};
use super::record::Quantity;
use super::state_conversion::Reader;
use super::{Initial, InvalidProblem, Problem, probability};
use crate::filter::update;
use crate::gaussian::{Gaussian, log_density, mixture_covariance, mixture_mean};
use crate::matrix::{Holds, Shapes, check_positive_definite, is_finite, ldl};
use crate::number::Real;
use nalgebra::{Dim, OMatrix, OVector};
use std::array::from_fn;

/// The filter without a record, for a number of modes that is known when the program is built.
///
/// Example: the random walk of [`Imm`](super::Imm), with the same numbers.
///
/// ```
/// use immaculate::filter::Filter;
/// use immaculate::{gaussian::Gaussian, imm::{Initial, Interaction, PlainImm, Problem}};
/// use immaculate::model::{Sensor, motion::{Mode, Motion}};
/// use nalgebra::{U1, matrix, vector};
///
/// let problem = Problem {
///     modes: vec![Mode { name: "walk".into(), motion: Motion::Linear(matrix![1.0]), noise: matrix![1.0] }],
///     chain: vec![vec![1.0]],
///     sensor: Sensor::Linear(matrix![1.0]),
///     measurement_noise: matrix![2.0],
///     filters: vec![Filter::kalman()],
///     interaction: Interaction::Imm,
///     angles: vec![],
/// };
/// let initial = Initial {
///     modes: vec![Gaussian { mean: vector![0.0], covariance: matrix![1.0] }],
///     mode_probabilities: vec![1.0],
/// };
/// let mut filter = PlainImm::<f64, U1, U1, 1>::new(problem, &initial)?;
/// assert_eq!(filter.step(Some(&vector![4.0]))?.mean, vector![2.0]);
/// assert_eq!(filter.step(None)?.covariance, matrix![2.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct PlainImm<T: Real, N: Dim, M: Dim, const MODES: usize>
where
    Shapes: Holds<N, M>,
{
    problem: Problem<T, N, M>,
    now: Box<Estimates<T, N, MODES>>,
    /// The place of the next step.
    next: Box<Estimates<T, N, MODES>>,
}

/// What a step ends with, and the next one begins with.
#[derive(Debug, Clone)]
struct Estimates<T: Real, N: Dim, const MODES: usize>
where
    Shapes: Holds<N>,
{
    /// k.
    step: usize,
    /// The estimates of the modes: predicted within a step, updated after it.
    modes: [Gaussian<T, N>; MODES],
    /// μⱼ.
    mode_probabilities: [T; MODES],
    /// The combined estimate.
    combined: Gaussian<T, N>,
}

impl<T: Real, N: Dim, M: Dim, const MODES: usize> PlainImm<T, N, M, MODES>
where
    Shapes: Holds<N, M>,
{
    /// The filter at step 0.
    ///
    /// # Errors
    ///
    /// [`InvalidProblem`] when the problem or the initial estimate is wrong, or the problem has not as many modes as the filter.
    pub fn new(problem: Problem<T, N, M>, initial: &Initial<T, N>) -> Result<Self, InvalidProblem> {
        problem.check(initial)?;
        let modes = problem.estimates_at_start(initial);
        let found = modes.len();
        let probabilities = initial.mode_probabilities.clone();
        let as_arrays = (<[_; MODES]>::try_from(modes), <[T; MODES]>::try_from(probabilities));
        let (Ok(modes), Ok(mode_probabilities)) = as_arrays else {
            return Err(InvalidProblem::OtherModes { found, expected: MODES });
        };
        let combined = mixture(&problem, Reader::Common, &mode_probabilities, &modes);
        let now = Box::new(Estimates {
            step: 0,
            modes,
            mode_probabilities,
            combined,
        });
        Ok(Self {
            problem,
            next: now.clone(),
            now,
        })
    }

    /// The combined estimate of the last step; of the initial estimates before the first.
    pub fn combined(&self) -> &Gaussian<T, N> {
        &self.now.combined
    }

    /// The estimates of the modes.
    pub fn modes(&self) -> &[Gaussian<T, N>; MODES] {
        &self.now.modes
    }

    /// The mode probabilities.
    pub fn mode_probabilities(&self) -> &[T; MODES] {
        &self.now.mode_probabilities
    }

    /// One step, with a measurement or without a detection; gives the combined estimate.
    ///
    /// # Errors
    ///
    /// As [`Imm::step`](super::Imm::step); the filter is then still at the step before.
    pub fn step(&mut self, measurement: Option<&OVector<T, M>>) -> Result<&Gaussian<T, N>, Failure> {
        let (problem, before, now) = (&self.problem, &*self.now, &mut *self.next);
        now.step = before.step + 1;
        if let Some(z) = measurement {
            check_measurement(problem, now.step, z)?;
        }
        let predicted_probabilities =
            from_fn(|j| probability::predicted_mode_probability(&problem.chain, &before.mode_probabilities, j));
        predict(problem, before, &predicted_probabilities, now)?;
        match measurement {
            Some(z) => correct(problem, &predicted_probabilities, z, now)?,
            None => go_without_detection(problem, predicted_probabilities, now),
        }
        now.combined = mixture(problem, Reader::Common, &now.mode_probabilities, &now.modes);
        check_combined(problem, now.step, &now.combined)?;
        std::mem::swap(&mut self.now, &mut self.next);
        Ok(&self.now.combined)
    }
}

/// Mean and covariance of a mixture, as the reader has the states.
#[inline(always)]
pub(super) fn mixture<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    reader: Reader,
    weights: &[T],
    estimates: &[Gaussian<T, N>],
) -> Gaussian<T, N>
where
    Shapes: Holds<N, M>,
{
    let mean = mixture_mean(weights, &estimates_near_first(problem, estimates, reader));
    let covariance = if problem.has_covariances() {
        mixture_covariance(weights, &estimates_near(problem, estimates, reader, &mean), &mean)
    } else {
        estimates[0].covariance.clone() // undecided, as all are
    };
    Gaussian { mean, covariance }
}

/// Mixes the estimates and predicts each mode.
#[inline(always)]
fn predict<T: Real, N: Dim, M: Dim, const MODES: usize>(
    problem: &Problem<T, N, M>,
    before: &Estimates<T, N, MODES>,
    predicted_probabilities: &[T; MODES],
    now: &mut Estimates<T, N, MODES>,
) -> Result<(), Failure>
where
    Shapes: Holds<N, M>,
{
    for (j, predicted_probability) in predicted_probabilities.iter().enumerate() {
        let probabilities = &before.mode_probabilities;
        let mixing: [T; MODES] =
            from_fn(|i| by_kind::mixing_probability(problem, probabilities, predicted_probability, i, j));
        let mixed = mixture(problem, Reader::Mode(j), &mixing, &before.modes);
        predict_mode(problem, now.step, j, &mixed, &mut now.modes[j])?;
    }
    Ok(())
}

/// What a prediction was computed from.
pub(crate) struct Moved<T: Real, N: Dim>
where
    Shapes: Holds<N>,
{
    /// The points before the motion; none for a filter that draws none.
    pub(crate) points: Points<T, N>,
    /// The points after the motion.
    pub(crate) propagated: Points<T, N>,
    /// F, of a filter that linearises the motion.
    pub(crate) jacobian: Option<OMatrix<T, N, N>>,
}

/// Writes the prediction of mode j from an estimate, mixed or not: in its place, as moving a covariance there takes time.
#[inline(always)]
pub(crate) fn predict_mode<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    step: usize,
    j: usize,
    from: &Gaussian<T, N>,
    predicted: &mut Gaussian<T, N>,
) -> Result<Moved<T, N>, Failure>
where
    Shapes: Holds<N, M>,
{
    let points = by_kind::mixed_points(problem, j, from)
        .map_err(|pivot| not_definite(problem, step, j, Quantity::PredictedMean, "mixed covariance", pivot))?;
    let propagated = by_kind::propagated_points(problem, j, &points);
    predicted.mean = by_kind::predicted_mean(problem, j, &from.mean, &propagated);
    let mut jacobian = None;
    if problem.has_covariances() {
        jacobian = by_kind::motion_jacobian(problem, j, &from.mean);
        check_slopes(problem, step, j, Quantity::MotionJacobian, jacobian.as_ref())?;
        predicted.covariance =
            by_kind::predicted_covariance(problem, j, from, jacobian.as_ref(), &propagated, &predicted.mean);
    }
    Ok(Moved {
        points,
        propagated,
        jacobian,
    })
}

/// Updates each mode and the mode probabilities.
#[inline(always)]
fn correct<T: Real, N: Dim, M: Dim, const MODES: usize>(
    problem: &Problem<T, N, M>,
    predicted_probabilities: &[T; MODES],
    z: &OVector<T, M>,
    now: &mut Estimates<T, N, MODES>,
) -> Result<(), Failure>
where
    Shapes: Holds<N, M>,
{
    let converted = by_kind::converted_measurement(problem, z);
    let converted_covariance = by_kind::converted_covariance(problem, z);
    let mut log_likelihoods: [T; MODES] = from_fn(|_| T::zero());
    for (j, log_likelihood) in log_likelihoods.iter_mut().enumerate() {
        let z = by_kind::used(problem, j, z, converted.as_ref());
        let noise = by_kind::used(problem, j, &problem.measurement_noise, converted_covariance.as_ref());
        *log_likelihood = update_mode(problem, now.step, j, &mut now.modes[j], z, noise)?;
    }
    let relative: [T; MODES] =
        from_fn(|j| probability::relative_likelihood(&log_likelihoods, predicted_probabilities, j));
    let evidence = probability::evidence(&relative, predicted_probabilities);
    if !is_finite(&probability::log_evidence(
        &log_likelihoods,
        predicted_probabilities,
        &evidence,
    )) {
        let value = Quantity::ModeProbabilities.name();
        return Err(failure(problem, now.step, None, value, Cause::NoEvidence));
    }
    now.mode_probabilities =
        from_fn(|j| probability::mode_probability(&relative[j], &predicted_probabilities[j], &evidence));
    Ok(())
}

/// Updates the prediction of mode j with what its filter uses of the measurement, and its covariance; gives ln Lⱼ.
#[inline(always)]
pub(super) fn update_mode<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    step: usize,
    j: usize,
    estimate: &mut Gaussian<T, N>,
    z: &OVector<T, M>,
    noise: &OMatrix<T, M, M>,
) -> Result<T, Failure>
where
    Shapes: Holds<N, M>,
{
    let indefinite = |value, what| move |pivot| not_definite(problem, step, j, value, what, pivot);
    let at = by_kind::linearisation_point(problem, j, estimate, z)
        .map_err(indefinite(Quantity::Gain, "innovation covariance"))?;
    let points = by_kind::predicted_points(problem, j, estimate)
        .map_err(indefinite(Quantity::PredictedMeasurement, "predicted covariance"))?;
    let values: Vec<_> = points.iter().map(|point| by_kind::seen(problem, point, j)).collect();
    let expected = by_kind::predicted_measurement(problem, j, &estimate.mean, at.as_ref(), &values);
    let innovation = by_kind::difference(problem, z, &expected, j);
    let jacobian = by_kind::measurement_jacobian(problem, j, &estimate.mean, at.as_ref());
    let jacobian = jacobian.as_ref();
    check_slopes(problem, step, j, Quantity::MeasurementJacobian, jacobian)?;
    let covariance = &estimate.covariance;
    let innovation_covariance =
        by_kind::innovation_covariance(problem, j, covariance, jacobian, &values, &expected, noise);
    let factors = ldl(&innovation_covariance);
    let gain = if let Some(given) = by_kind::given_gain(problem, j) {
        given.clone()
    } else {
        check_positive_definite(&factors).map_err(indefinite(Quantity::Gain, "innovation covariance"))?;
        let cross_covariance = by_kind::cross_covariance(problem, j, estimate, jacobian, &points, &values, &expected);
        update::gain(&cross_covariance, &factors)
    };
    estimate.mean = by_kind::updated_mean(problem, j, &estimate.mean, &gain, &innovation);
    if problem.has_covariances() {
        estimate.covariance = update::updated_covariance(&estimate.covariance, &gain, &innovation_covariance);
    }
    Ok(log_density(&innovation, &factors))
}

/// The prediction stays, and the probabilities follow the chain.
fn go_without_detection<T: Real, N: Dim, M: Dim, const MODES: usize>(
    problem: &Problem<T, N, M>,
    predicted_probabilities: [T; MODES],
    now: &mut Estimates<T, N, MODES>,
) where
    Shapes: Holds<N, M>,
{
    for (j, estimate) in now.modes.iter_mut().enumerate() {
        estimate.mean = wrapped(problem.angles_of(Reader::Mode(j)), estimate.mean.clone());
    }
    now.mode_probabilities = predicted_probabilities;
}
