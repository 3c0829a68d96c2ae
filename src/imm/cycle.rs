//! The wiring: runs a table of equations in the papers' order, for every table the same.
//!
//! After this file the reader knows the cycle: what is computed before what, what happens without a detection, how a step that
//! cannot be computed is reported, and how an [`Observer`] sees every value as soon as it is there.
//!
//! ```text
//! step before ─▶ mix ─▶ predict each mode ─▶ combine the prediction ─┬─ z ─▶ convert ─▶ update each mode ─▶ weigh ─┬─▶ combine ─▶ step
//!                                                                    └─ no detection ─▶ the prediction stays ──────┘
//! ```

use super::quantity::Quantity;
use super::{Equations, Initial, InvalidProblem, Problem, Step};
use crate::matrix::{NotPositiveDefinite, all_finite, is_finite};
use crate::model::{Measurement, PolarComponent};
use crate::number::Real;
use nalgebra::SVector;

/// Is told of every traced value of a step, in the order in which they are computed, and may put others in their place: what
/// follows is then computed from these.
///
/// The filter that nobody observes has the observer `()`, which does nothing and costs nothing.
///
/// Example: what is computed in a step, by name.
///
/// ```
/// use immaculate::{gaussian::Gaussian, imm::{Equations, Imm, Initial, Observer, Problem, Quantity, Step}};
/// use immaculate::model::{Measurement, motion::Mode};
/// use nalgebra::{matrix, vector};
///
/// struct Names(Vec<&'static str>);
/// impl Observer<f64, 1, 1> for Names {
///     fn computed(&mut self, quantity: Quantity, _mode: usize, _now: &mut Step<f64, 1, 1>) {
///         self.0.push(quantity.name());
///     }
/// }
///
/// let problem = Problem {
///     modes: vec![Mode { name: "walk".into(), transition: matrix![1.0], noise: matrix![1.0] }],
///     transition: vec![vec![1.0]],
///     measurement: Measurement::Linear(matrix![1.0]),
///     measurement_noise: matrix![2.0],
///     rule: None,
///     fixed_gains: None,
/// };
/// let initial = Initial {
///     modes: vec![Gaussian { mean: vector![0.0], covariance: matrix![1.0] }],
///     mode_probabilities: vec![1.0],
/// };
/// let mut names = Names(Vec::new());
/// Imm::new(problem, Equations::kalman(), &initial)?.step_observed(None, &mut names)?;
/// assert_eq!(names.0[2..6], ["mixed.mean", "mixed.covariance", "predicted.mean", "predicted.covariance"]);
/// assert!(!names.0.contains(&"gain")); // without a detection
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Observer<T, const N: usize, const M: usize> {
    /// The quantity of mode j (0 for a quantity of all modes together) has just been computed and stands in the record.
    fn computed(&mut self, quantity: Quantity, j: usize, now: &mut Step<T, N, M>);
}

impl<T, const N: usize, const M: usize> Observer<T, N, M> for () {
    fn computed(&mut self, _: Quantity, _: usize, _: &mut Step<T, N, M>) {}
}

/// A step that could not be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("step {step}, mode `{mode}`, {equation}: {cause}")]
pub struct Failure {
    /// The step, counted from 1.
    pub step: usize,
    /// The name of the mode, or "all".
    pub mode: String,
    /// The equation that had no answer.
    pub equation: &'static str,
    /// Why.
    pub cause: Cause,
}

/// Why a step could not be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Cause {
    /// A covariance stopped being positive definite.
    #[error("the {what} {pivot}")]
    NotPositiveDefinite {
        /// Which covariance.
        what: &'static str,
        /// The pivot.
        pivot: NotPositiveDefinite,
    },
    /// The measurement has an entry that is not finite.
    #[error("the measurement has an entry that is not finite")]
    MeasurementNotFinite,
    /// A range below zero.
    #[error("the measured range {range} is negative; a range is a distance")]
    NegativeRange {
        /// The range.
        range: String,
    },
    /// A bearing outside two turns of zero.
    #[error("the measured bearing {bearing} is outside ±2π: is it in degrees?")]
    BearingOutOfRange {
        /// The bearing.
        bearing: String,
    },
    /// The combined estimate has an entry that is not finite: the problem's numbers are beyond the number system.
    #[error("the combined estimate has an entry that is not finite")]
    EstimateNotFinite,
    /// The likelihood of the measurement is beyond the number system.
    #[error("the log-likelihood of the measurement under all modes together is not finite")]
    NoEvidence,
}

/// The filter: a problem, a table of equations, and the step before and now.
///
/// Example: a scalar random walk with one mode, which is a Kalman filter.
///
/// ```
/// use immaculate::{gaussian::Gaussian, imm::{Equations, Imm, Initial, Problem}};
/// use immaculate::model::{Measurement, motion::Mode};
/// use nalgebra::{matrix, vector};
///
/// let problem = Problem {
///     modes: vec![Mode { name: "walk".into(), transition: matrix![1.0], noise: matrix![1.0] }],
///     transition: vec![vec![1.0]],
///     measurement: Measurement::Linear(matrix![1.0]),
///     measurement_noise: matrix![2.0],
///     rule: None,
///     fixed_gains: None,
/// };
/// let initial = Initial {
///     modes: vec![Gaussian { mean: vector![0.0], covariance: matrix![1.0] }],
///     mode_probabilities: vec![1.0],
/// };
/// let mut filter = Imm::new(problem, Equations::kalman(), &initial).unwrap();
/// // The prediction has the variance 1 + 1, the gain is 2 / (2 + 2), and 0 + ½ · (4 − 0) = 2.
/// assert_eq!(filter.step(Some(&vector![4.0])).unwrap().combined.mean, vector![2.0]);
/// // A missed detection: the mean stays, the variance 2 − ½ · 4 · ½ = 1 grows by 1.
/// let missed = filter.step(None).unwrap();
/// assert_eq!((missed.combined.mean, missed.combined.covariance), (vector![2.0], matrix![2.0]));
/// ```
#[derive(Debug, Clone)]
pub struct Imm<T, const N: usize, const M: usize> {
    problem: Problem<T, N, M>,
    equations: Equations<T, N, M>,
    previous: Step<T, N, M>,
    now: Step<T, N, M>,
}

impl<T: Real, const N: usize, const M: usize> Imm<T, N, M> {
    /// A filter at step 0.
    ///
    /// # Errors
    ///
    /// [`InvalidProblem`] when the problem, the initial estimate or their match with the equations is wrong.
    pub fn new(
        problem: Problem<T, N, M>,
        equations: Equations<T, N, M>,
        initial: &Initial<T, N>,
    ) -> Result<Self, InvalidProblem> {
        problem.check(initial)?;
        if equations.draws_points != problem.rule.is_some() {
            return Err(InvalidProblem::Rule {
                given: problem.rule.is_some(),
            });
        }
        if equations.keeps_covariances == problem.fixed_gains.is_some() {
            return Err(InvalidProblem::FixedGains {
                given: problem.fixed_gains.is_some(),
            });
        }
        let is_converted = problem.measurement.is_converted();
        if equations.converts != is_converted {
            return Err(InvalidProblem::Conversion { given: is_converted });
        }
        if !equations.draws_points && !is_converted && !matches!(problem.measurement, Measurement::Linear(_)) {
            return Err(InvalidProblem::NotLinear);
        }
        Ok(Self::unchecked(problem, equations, initial))
    }

    /// A filter at step 0 whose problem may be wrong on purpose: what a variant of the filter is run with.
    pub(crate) fn unchecked(problem: Problem<T, N, M>, equations: Equations<T, N, M>, initial: &Initial<T, N>) -> Self {
        let points = problem.rule.as_ref().map_or(0, |rule| rule.points.len());
        let mut now = Step::zeros(problem.modes.len(), points);
        now.updated.clone_from(&initial.modes);
        now.mode_probabilities.clone_from(&initial.mode_probabilities);
        now.combined.mean = (equations.combined_mean)(&problem, &now, &now);
        if equations.keeps_covariances {
            now.combined.covariance = (equations.combined_covariance)(&problem, &now, &now);
        } else {
            now.forget_covariances();
        }
        Self {
            previous: now.clone(),
            problem,
            equations,
            now,
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

    /// One step of the cycle, with a measurement or without a detection.
    ///
    /// # Errors
    ///
    /// [`Failure`] with step, mode and equation when a value cannot be computed; the filter is then still at the step before.
    pub fn step(&mut self, measurement: Option<&SVector<T, M>>) -> Result<&Step<T, N, M>, Failure> {
        self.step_observed(measurement, &mut ())
    }

    /// As [`Imm::step`], with an observer of every value.
    ///
    /// # Errors
    ///
    /// As [`Imm::step`].
    pub fn step_observed(
        &mut self,
        measurement: Option<&SVector<T, M>>,
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
        measurement: Option<&SVector<T, M>>,
        observer: &mut impl Observer<T, N, M>,
    ) -> Result<(), Failure> {
        self.now.step = self.previous.step + 1;
        self.now.measurement = measurement.cloned();
        if let Some(z) = measurement {
            self.check_measurement(z)?;
        }
        self.mix(observer);
        for j in 0..self.problem.modes.len() {
            self.predict(j, observer)?;
        }
        self.combine_prediction(observer);
        if measurement.is_some() {
            self.convert(observer);
            for j in 0..self.problem.modes.len() {
                self.update(j, observer)?;
            }
            self.weigh(observer)?;
        } else {
            self.go_without_detection(observer);
        }
        self.combine(observer);
        let combined = &self.now.combined;
        let is_finite = |covariance| !self.equations.keeps_covariances || all_finite(covariance);
        if all_finite(&combined.mean) && is_finite(&combined.covariance) {
            return Ok(());
        }
        Err(Failure {
            step: self.now.step,
            mode: "all".into(),
            equation: "zhu2016 (60)",
            cause: Cause::EstimateNotFinite,
        })
    }

    /// Mode probabilities along the chain, and the estimates mixed accordingly.
    fn mix(&mut self, observer: &mut impl Observer<T, N, M>) {
        let (e, problem, previous, now) = self.parts();
        let modes = problem.modes.len();
        for j in 0..modes {
            now.predicted_mode_probabilities[j] = (e.predicted_mode_probability)(problem, previous, now, j);
        }
        observer.computed(Quantity::PredictedModeProbabilities, 0, now);
        for j in 0..modes {
            for i in 0..modes {
                now.mixing_probabilities[j][i] = (e.mixing_probability)(problem, previous, now, j, i);
            }
            observer.computed(Quantity::MixingProbabilities, j, now);
            now.mixed[j].mean = (e.mixed_mean)(problem, previous, now, j);
            observer.computed(Quantity::MixedMean, j, now);
            if e.keeps_covariances {
                now.mixed[j].covariance = (e.mixed_covariance)(problem, previous, now, j);
                observer.computed(Quantity::MixedCovariance, j, now);
            }
        }
    }

    /// One mode's prediction, with points if its filter draws them.
    fn predict(&mut self, j: usize, observer: &mut impl Observer<T, N, M>) -> Result<(), Failure> {
        let (e, problem, previous, now) = self.parts();
        if e.draws_points {
            now.mixed_square_roots[j] = (e.mixed_square_root)(problem, previous, now, j)
                .map_err(|pivot| failure(problem, now, j, "zhu2016 (1)", "mixed covariance", pivot))?;
            for s in 0..now.mixed_points[j].len() {
                now.mixed_points[j][s] = (e.mixed_point)(problem, previous, now, j, s);
                now.propagated_points[j][s] = (e.propagated_point)(problem, previous, now, j, s);
            }
        }
        now.predicted[j].mean = (e.predicted_mean)(problem, previous, now, j);
        observer.computed(Quantity::PredictedMean, j, now);
        if e.keeps_covariances {
            now.predicted[j].covariance = (e.predicted_covariance)(problem, previous, now, j);
            observer.computed(Quantity::PredictedCovariance, j, now);
        }
        Ok(())
    }

    /// The measurement as a position, if the filters convert it.
    fn convert(&mut self, observer: &mut impl Observer<T, N, M>) {
        let (e, problem, previous, now) = self.parts();
        if e.converts {
            now.converted_measurement = (e.converted_measurement)(problem, previous, now);
            observer.computed(Quantity::ConvertedMeasurement, 0, now);
            now.converted_covariance = (e.converted_covariance)(problem, previous, now);
            observer.computed(Quantity::ConvertedCovariance, 0, now);
        }
    }

    /// One mode's update with a measurement, and its likelihood.
    fn update(&mut self, j: usize, observer: &mut impl Observer<T, N, M>) -> Result<(), Failure> {
        let (e, problem, previous, now) = self.parts();
        if e.draws_points {
            now.predicted_square_roots[j] = (e.predicted_square_root)(problem, previous, now, j)
                .map_err(|pivot| failure(problem, now, j, "zhu2016 (27)", "predicted covariance", pivot))?;
            for s in 0..now.predicted_points[j].len() {
                now.predicted_points[j][s] = (e.predicted_point)(problem, previous, now, j, s);
                now.measured_points[j][s] = (e.measured_point)(problem, previous, now, j, s);
            }
        }
        now.predicted_measurements[j] = (e.predicted_measurement)(problem, previous, now, j);
        observer.computed(Quantity::PredictedMeasurement, j, now);
        now.innovations[j] = (e.innovation)(problem, previous, now, j);
        observer.computed(Quantity::Innovation, j, now);
        now.innovation_covariances[j] = (e.innovation_covariance)(problem, previous, now, j);
        observer.computed(Quantity::InnovationCovariance, j, now);
        if e.keeps_covariances {
            now.cross_covariances[j] = (e.cross_covariance)(problem, previous, now, j);
            observer.computed(Quantity::CrossCovariance, j, now);
        }
        now.gains[j] = (e.gain)(problem, previous, now, j)
            .map_err(|pivot| failure(problem, now, j, "zhu2016 (51)", "innovation covariance", pivot))?;
        observer.computed(Quantity::Gain, j, now);
        now.updated[j].mean = (e.updated_mean)(problem, previous, now, j);
        observer.computed(Quantity::UpdatedMean, j, now);
        if e.keeps_covariances {
            now.updated[j].covariance = (e.updated_covariance)(problem, previous, now, j);
            observer.computed(Quantity::UpdatedCovariance, j, now);
        }
        now.log_likelihoods[j] = (e.log_likelihood)(problem, previous, now, j);
        observer.computed(Quantity::LogLikelihood, j, now);
        Ok(())
    }

    /// The mode probabilities after the measurement.
    fn weigh(&mut self, observer: &mut impl Observer<T, N, M>) -> Result<(), Failure> {
        let (e, problem, previous, now) = self.parts();
        for j in 0..problem.modes.len() {
            now.relative_likelihoods[j] = (e.relative_likelihood)(problem, previous, now, j);
        }
        now.evidence = (e.evidence)(problem, previous, now);
        now.log_evidence = (e.log_evidence)(problem, previous, now);
        if !is_finite(&now.log_evidence) {
            return Err(Failure {
                step: now.step,
                mode: "all".into(),
                equation: "zhu2016 (58)",
                cause: Cause::NoEvidence,
            });
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
        now.forget_measured_values();
        for j in 0..problem.modes.len() {
            now.updated[j].mean = (e.undetected_mean)(problem, previous, now, j);
            observer.computed(Quantity::UpdatedMean, j, now);
            if e.keeps_covariances {
                now.updated[j].covariance = (e.undetected_covariance)(problem, previous, now, j);
                observer.computed(Quantity::UpdatedCovariance, j, now);
            }
            now.log_likelihoods[j] = (e.undetected_log_likelihood)(problem, previous, now, j);
        }
        for j in 0..problem.modes.len() {
            now.mode_probabilities[j] = (e.undetected_mode_probability)(problem, previous, now, j);
        }
        observer.computed(Quantity::ModeProbabilities, 0, now);
    }

    /// The estimate before the measurement, for output.
    fn combine_prediction(&mut self, observer: &mut impl Observer<T, N, M>) {
        let (e, problem, previous, now) = self.parts();
        now.combined_prediction.mean = (e.combined_prediction_mean)(problem, previous, now);
        observer.computed(Quantity::CombinedPredictionMean, 0, now);
        if e.keeps_covariances {
            now.combined_prediction.covariance = (e.combined_prediction_covariance)(problem, previous, now);
            observer.computed(Quantity::CombinedPredictionCovariance, 0, now);
        }
    }

    /// The estimate after the measurement, for output.
    fn combine(&mut self, observer: &mut impl Observer<T, N, M>) {
        let (e, problem, previous, now) = self.parts();
        now.combined.mean = (e.combined_mean)(problem, previous, now);
        observer.computed(Quantity::CombinedMean, 0, now);
        if e.keeps_covariances {
            now.combined.covariance = (e.combined_covariance)(problem, previous, now);
            observer.computed(Quantity::CombinedCovariance, 0, now);
        }
    }

    /// What every equation is given.
    fn parts(
        &mut self,
    ) -> (
        &Equations<T, N, M>,
        &Problem<T, N, M>,
        &Step<T, N, M>,
        &mut Step<T, N, M>,
    ) {
        (&self.equations, &self.problem, &self.previous, &mut self.now)
    }

    /// A measurement is finite, its ranges are not negative, and its bearings are angles in radians.
    fn check_measurement(&self, z: &SVector<T, M>) -> Result<(), Failure> {
        let fail = |equation, cause| {
            Err(Failure {
                step: self.now.step,
                mode: "all".into(),
                equation,
                cause,
            })
        };
        if !all_finite(z) {
            return fail("liu2017 (1)", Cause::MeasurementNotFinite);
        }
        let two_turns = T::pi() * T::integer(2);
        for (component, value) in z.iter().enumerate() {
            match self.problem.measurement.reports(component) {
                Some(PolarComponent::Range) if *value < T::zero() => {
                    let range = format!("{value:?}");
                    return fail("liu2017 (31)", Cause::NegativeRange { range });
                }
                Some(PolarComponent::Bearing) if *value > two_turns || *value < -two_turns.clone() => {
                    let bearing = format!("{value:?}");
                    return fail("liu2017 (31)", Cause::BearingOutOfRange { bearing });
                }
                _ => {}
            }
        }
        Ok(())
    }
}

/// A covariance of mode j that is not positive definite.
fn failure<T, const N: usize, const M: usize>(
    problem: &Problem<T, N, M>,
    now: &Step<T, N, M>,
    j: usize,
    equation: &'static str,
    what: &'static str,
    pivot: NotPositiveDefinite,
) -> Failure {
    Failure {
        step: now.step,
        mode: problem.modes[j].name.clone(),
        equation,
        cause: Cause::NotPositiveDefinite { what, pivot },
    }
}
