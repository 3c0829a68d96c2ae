//! The wiring: evaluates any table of equations in the papers' order.
//!
//! The cycle fixes the order of the computation, the handling of a missed detection, and the report of a step that cannot be computed. An
//! [`Observer`] sees every value as soon as it is computed.
//!
//! ```text
//! step before ─▶ mix ─▶ predict each mode ─▶ combine the prediction ─┬─ z ─▶ convert ─▶ update each mode ─▶ weigh ─┬─▶ combine ─▶ step
//!                                                                    └─ no detection ─▶ the prediction stays ──────┘
//! ```

use super::failure::{Cause, Failure, check_combined, check_measurement, check_slopes, failure, not_definite};
use super::observer::Observer;
use super::record::Quantity;
use super::update::update;
use super::{Equations, Initial, InvalidProblem, Problem, Step};
use crate::matrix::{Holds, Shapes, is_finite};
use crate::number::{Field, Real};
use nalgebra::{Dim, OVector};

/// The filter: a problem, a table of equations, and the step before and now.
///
/// Example: a scalar random walk with one mode, which is a Kalman filter.
///
/// ```
/// use immaculate::filter::Filter;
/// use immaculate::{gaussian::Gaussian, imm::{Imm, Initial, Interaction, Problem}};
/// use immaculate::model::{Sensor, motion::{Mode, Motion}};
/// use nalgebra::{matrix, vector};
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
/// let mut filter = Imm::new(problem, &initial).unwrap();
/// // The prediction has the variance 1 + 1, the gain is 2 / (2 + 2), and 0 + ½ · (4 − 0) = 2.
/// assert_eq!(filter.step(Some(&vector![4.0])).unwrap().combined.mean, vector![2.0]);
/// // A missed detection: the mean stays, the variance 2 − ½ · 4 · ½ = 1 grows by 1.
/// let missed = filter.step(None).unwrap();
/// assert_eq!((missed.combined.mean, missed.combined.covariance), (vector![2.0], matrix![2.0]));
/// ```
#[derive(Debug, Clone)]
pub struct Imm<T: Field, N: Dim, M: Dim>
where
    Shapes: Holds<N, M>,
{
    problem: Problem<T, N, M>,
    equations: Equations<T, N, M>,
    previous: Step<T, N, M>,
    now: Step<T, N, M>,
    /// The true state of the next step.
    pub(crate) truth: Option<OVector<T, N>>,
}

/// The equations, the problem, the step before, and the step so far.
type Parts<'a, T, N, M> = (
    &'a Equations<T, N, M>,
    &'a Problem<T, N, M>,
    &'a Step<T, N, M>,
    &'a mut Step<T, N, M>,
);

impl<T: Real, N: Dim, M: Dim> Imm<T, N, M>
where
    Shapes: Holds<N, M>,
{
    /// The filter proper at step 0, [`Equations::standard`].
    ///
    /// # Errors
    ///
    /// [`InvalidProblem`] when the problem or the initial estimate is wrong.
    pub fn new(problem: Problem<T, N, M>, initial: &Initial<T, N>) -> Result<Self, InvalidProblem> {
        Self::with_equations(problem, Equations::standard(), initial)
    }

    /// A variant of the filter at step 0.
    ///
    /// # Errors
    ///
    /// As [`Imm::new`].
    pub fn with_equations(
        problem: Problem<T, N, M>,
        equations: Equations<T, N, M>,
        initial: &Initial<T, N>,
    ) -> Result<Self, InvalidProblem> {
        problem.check(initial)?;
        Ok(Self::unchecked(problem, equations, initial))
    }

    /// A filter at step 0 whose problem may be wrong on purpose: what a variant of the filter is run with.
    pub(crate) fn unchecked(problem: Problem<T, N, M>, equations: Equations<T, N, M>, initial: &Initial<T, N>) -> Self {
        let has_covariances = problem.has_covariances();
        let estimates = problem.estimates_at_start(initial);
        let mut now = Step::initial(&estimates, &initial.mode_probabilities);
        now.combined.mean = (equations.combined_mean)(&problem, &now, &now, 0);
        if has_covariances {
            now.combined.covariance = (equations.combined_covariance)(&problem, &now, &now, 0);
        }
        now.combined_prediction.clone_from(&now.combined);
        Self {
            previous: now.clone(),
            problem,
            equations,
            now,
            truth: None,
        }
    }

    /// The last step that was computed; step 0 is the initial estimate.
    pub fn current(&self) -> &Step<T, N, M> {
        &self.now
    }

    /// The last step, to be overwritten by one that was computed elsewhere.
    pub fn current_mut(&mut self) -> &mut Step<T, N, M> {
        &mut self.now
    }

    /// The problem that is run.
    pub fn problem(&self) -> &Problem<T, N, M> {
        &self.problem
    }

    /// Goes on with another problem from the next step: another step length with its F and Q, another sensor, another chain.
    ///
    /// Example: a random walk that is seen twice as well from its second step on.
    ///
    /// ```
    /// use immaculate::filter::Filter;
    /// use immaculate::{gaussian::Gaussian, imm::{Imm, Initial, Interaction, Problem}};
    /// use immaculate::model::{Sensor, motion::{Mode, Motion}};
    /// use nalgebra::{matrix, vector};
    ///
    /// let mut problem = Problem {
    ///     modes: vec![Mode { name: "walk".into(), motion: Motion::Linear(matrix![1.0]), noise: matrix![1.0] }],
    ///     filters: vec![Filter::kalman()],
    ///     interaction: Interaction::Imm,
    ///     angles: vec![],
    ///     chain: vec![vec![1.0]],
    ///     sensor: Sensor::Linear(matrix![1.0]),
    ///     measurement_noise: matrix![2.0],
    /// };
    /// let estimate = Gaussian { mean: vector![0.0], covariance: matrix![1.0] };
    /// let initial = Initial { modes: vec![estimate], mode_probabilities: vec![1.0] };
    /// let mut filter = Imm::new(problem.clone(), &initial)?;
    /// assert_eq!(filter.step(Some(&vector![4.0]))?.gains[0], matrix![0.5]); // (1 + 1) / (2 + 2)
    /// problem.measurement_noise = matrix![1.0];
    /// filter.change(problem)?;
    /// assert_eq!(filter.step(Some(&vector![4.0]))?.gains[0], matrix![2.0 / 3.0]); // (1 + 1) / (2 + 1)
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`InvalidProblem`] when the problem is wrong, or has other modes or another state; the filter then keeps the one that it has.
    pub fn change(&mut self, problem: Problem<T, N, M>) -> Result<(), InvalidProblem> {
        let estimates = Initial {
            modes: self.now.updated.clone(),
            mode_probabilities: self.now.mode_probabilities.clone(),
        };
        problem.check_inputs(&estimates)?;
        if problem.has_covariances() != self.problem.has_covariances() {
            return Err(InvalidProblem::OtherKind);
        }
        self.problem = problem;
        Ok(())
    }

    /// As [`Imm::change`], with a problem that may be wrong on purpose.
    #[cfg(feature = "oracle")]
    pub(crate) fn change_unchecked(&mut self, problem: &Problem<T, N, M>) {
        self.problem.clone_from(problem);
    }

    /// Says what the true state of the next step is, as a simulation knows it; its [`Step::nees`] is then there, and nothing else changes.
    ///
    /// Example: the random walk is at 3 where 2 is estimated, with the variance 1.
    ///
    /// ```
    /// use immaculate::filter::Filter;
    /// use immaculate::{gaussian::Gaussian, imm::{Imm, Initial, Interaction, Problem}};
    /// use immaculate::model::{Sensor, motion::{Mode, Motion}};
    /// use nalgebra::{matrix, vector};
    ///
    /// let problem = Problem {
    ///     modes: vec![Mode { name: "walk".into(), motion: Motion::Linear(matrix![1.0]), noise: matrix![1.0] }],
    ///     filters: vec![Filter::kalman()],
    ///     interaction: Interaction::Imm,
    ///     angles: vec![],
    ///     chain: vec![vec![1.0]],
    ///     sensor: Sensor::Linear(matrix![1.0]),
    ///     measurement_noise: matrix![2.0],
    /// };
    /// let estimate = Gaussian { mean: vector![0.0], covariance: matrix![1.0] };
    /// let mut filter = Imm::new(problem, &Initial { modes: vec![estimate], mode_probabilities: vec![1.0] })?;
    /// filter.set_truth(vector![3.0])?;
    /// let step = filter.step(Some(&vector![4.0]))?;
    /// assert_eq!((step.nis[0], step.nees), (Some(4.0), Some(1.0))); // 4²/(2 + 2), (3 − 2)²/1
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`InvalidProblem`] for another number of entries than the state has, or one that is not finite.
    pub fn set_truth(&mut self, truth: OVector<T, N>) -> Result<(), InvalidProblem> {
        self.problem.check_truth(&truth)?;
        self.truth = Some(truth);
        Ok(())
    }

    /// One step of the cycle, with a measurement or without a detection.
    ///
    /// # Errors
    ///
    /// [`Failure`] with step, mode and value when a value cannot be computed; the filter is then still at the step before.
    pub fn step(&mut self, measurement: Option<&OVector<T, M>>) -> Result<&Step<T, N, M>, Failure> {
        self.step_observed(measurement, &mut ())
    }

    /// As [`Imm::step`], with an observer of every value.
    ///
    /// # Errors
    ///
    /// As [`Imm::step`].
    pub fn step_observed(
        &mut self,
        measurement: Option<&OVector<T, M>>,
        observer: &mut impl Observer<T, N, M>,
    ) -> Result<&Step<T, N, M>, Failure> {
        std::mem::swap(&mut self.previous, &mut self.now);
        match self.advance(measurement, observer) {
            Ok(()) => Ok(&self.now),
            Err(failure) => {
                std::mem::swap(&mut self.previous, &mut self.now);
                Err(failure)
            }
        }
    }

    /// Fills in the record `now` from the record `previous`.
    fn advance(
        &mut self,
        measurement: Option<&OVector<T, M>>,
        observer: &mut impl Observer<T, N, M>,
    ) -> Result<(), Failure> {
        self.now.clear();
        self.now.step = self.previous.step + 1;
        self.now.measurement = measurement.cloned();
        self.now.truth = self.truth.take();
        if let Some(z) = measurement {
            check_measurement(&self.problem, self.now.step, z)?;
        }
        let modes = self.problem.modes.len();
        self.mix(observer);
        for j in 0..modes {
            self.predict(j, observer)?;
        }
        self.combine_prediction(observer);
        if let Some(z) = measurement {
            self.convert(z, observer);
            for j in 0..modes {
                let (e, problem, previous, now) = self.parts();
                update(e, problem, previous, now, z, j, observer)?;
            }
            self.weigh(observer)?;
        } else {
            self.go_without_detection(observer);
        }
        self.combine(observer);
        check_combined(&self.problem, self.now.step, &self.now.combined)
    }

    /// Mode probabilities along the chain, and the estimates mixed accordingly.
    fn mix(&mut self, observer: &mut impl Observer<T, N, M>) {
        let (e, problem, previous, now) = self.parts();
        let has_covariances = problem.has_covariances();
        for j in 0..problem.modes.len() {
            now.predicted_mode_probabilities[j] = (e.predicted_mode_probability)(problem, previous, now, j);
        }
        observer.computed(Quantity::PredictedModeProbabilities, 0, now);
        for j in 0..problem.modes.len() {
            now.mixing_probabilities[j] = (e.mixing_probabilities)(problem, previous, now, j);
            observer.computed(Quantity::MixingProbabilities, j, now);
            now.mixed[j].mean = (e.mixed_mean)(problem, previous, now, j);
            observer.computed(Quantity::MixedMean, j, now);
            if has_covariances {
                now.mixed[j].covariance = (e.mixed_covariance)(problem, previous, now, j);
                observer.computed(Quantity::MixedCovariance, j, now);
            }
        }
    }

    /// One mode's prediction, with points if its filter draws them.
    fn predict(&mut self, j: usize, observer: &mut impl Observer<T, N, M>) -> Result<(), Failure> {
        let (e, problem, previous, now) = self.parts();
        let points = (e.mixed_points)(problem, previous, now, j)
            .map_err(|pivot| not_definite(problem, now.step, j, Quantity::PredictedMean, "mixed covariance", pivot))?;
        now.mixed_points.push(points);
        let points = (e.propagated_points)(problem, previous, now, j);
        now.propagated_points.push(points);
        now.predicted[j].mean = (e.predicted_mean)(problem, previous, now, j);
        observer.computed(Quantity::PredictedMean, j, now);
        let jacobian = (e.motion_jacobian)(problem, previous, now, j);
        check_slopes(problem, now.step, j, Quantity::MotionJacobian, jacobian.as_ref())?;
        now.motion_jacobians.push(jacobian);
        if now.motion_jacobians[j].is_some() {
            observer.computed(Quantity::MotionJacobian, j, now);
        }
        if problem.has_covariances() {
            now.predicted[j].covariance = (e.predicted_covariance)(problem, previous, now, j);
            observer.computed(Quantity::PredictedCovariance, j, now);
        }
        Ok(())
    }

    /// The measurement z as a position, if a filter converts it.
    fn convert(&mut self, z: &OVector<T, M>, observer: &mut impl Observer<T, N, M>) {
        let (e, problem, _, now) = self.parts();
        now.converted_measurement = (e.converted_measurement)(problem, z, now, 0);
        if now.converted_measurement.is_none() {
            return;
        }
        observer.computed(Quantity::ConvertedMeasurement, 0, now);
        now.converted_covariance = (e.converted_covariance)(problem, z, now, 0);
        observer.computed(Quantity::ConvertedCovariance, 0, now);
    }

    /// The mode probabilities after the measurement.
    fn weigh(&mut self, observer: &mut impl Observer<T, N, M>) -> Result<(), Failure> {
        let (e, problem, previous, now) = self.parts();
        for j in 0..problem.modes.len() {
            let likelihood = (e.relative_likelihood)(problem, previous, now, j);
            now.relative_likelihoods.push(likelihood);
        }
        now.evidence = (e.evidence)(problem, previous, now, 0);
        now.log_evidence = (e.log_evidence)(problem, previous, now, 0);
        if !is_finite(&now.log_evidence) {
            return Err(failure(
                problem,
                now.step,
                None,
                Quantity::ModeProbabilities.name(),
                Cause::NoEvidence,
            ));
        }
        for j in 0..problem.modes.len() {
            now.mode_probabilities[j] = (e.mode_probability)(problem, previous, now, j);
        }
        observer.computed(Quantity::ModeProbabilities, 0, now);
        Ok(())
    }

    /// No detection: nothing is learnt, and the probabilities follow the chain.
    fn go_without_detection(&mut self, observer: &mut impl Observer<T, N, M>) {
        let (e, problem, previous, now) = self.parts();
        for j in 0..problem.modes.len() {
            now.updated[j].mean = (e.undetected_mean)(problem, previous, now, j);
            observer.computed(Quantity::UpdatedMean, j, now);
            if problem.has_covariances() {
                now.updated[j].covariance = (e.undetected_covariance)(problem, previous, now, j);
                observer.computed(Quantity::UpdatedCovariance, j, now);
            }
            let log_likelihood = (e.undetected_log_likelihood)(problem, previous, now, j);
            now.log_likelihoods.extend(log_likelihood);
        }
        for j in 0..problem.modes.len() {
            now.mode_probabilities[j] = (e.undetected_mode_probability)(problem, previous, now, j);
        }
        observer.computed(Quantity::ModeProbabilities, 0, now);
    }

    /// The estimate before the measurement, for output.
    fn combine_prediction(&mut self, observer: &mut impl Observer<T, N, M>) {
        let (e, problem, previous, now) = self.parts();
        now.combined_prediction.mean = (e.combined_prediction_mean)(problem, previous, now, 0);
        observer.computed(Quantity::CombinedPredictionMean, 0, now);
        if problem.has_covariances() {
            now.combined_prediction.covariance = (e.combined_prediction_covariance)(problem, previous, now, 0);
            observer.computed(Quantity::CombinedPredictionCovariance, 0, now);
        }
    }

    /// The estimate after the measurement, for output.
    fn combine(&mut self, observer: &mut impl Observer<T, N, M>) {
        let (e, problem, previous, now) = self.parts();
        now.combined.mean = (e.combined_mean)(problem, previous, now, 0);
        observer.computed(Quantity::CombinedMean, 0, now);
        if problem.has_covariances() {
            now.combined.covariance = (e.combined_covariance)(problem, previous, now, 0);
            observer.computed(Quantity::CombinedCovariance, 0, now);
            now.nees = (e.nees)(problem, previous, now, 0);
            observer.computed(Quantity::Nees, 0, now);
        }
    }

    /// What every equation is given.
    fn parts(&mut self) -> Parts<'_, T, N, M> {
        (&self.equations, &self.problem, &self.previous, &mut self.now)
    }
}
