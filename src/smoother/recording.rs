//! A run as a smoother needs it, and the way back through it.
//!
//! ```text
//! step ─ record ─▶ updated estimates, predictions of pairs, D ─┬─ fixed_interval ─▶ every state, given all measurements
//!                                                              └─ fixed_lag ─▶ one state, given those up to some steps later
//! ```
//!
//! With one mode it is the smoother of Rauch, Tung and Striebel, of every kind of filter that has covariances. With several it is a
//! [`SwitchingSmoother`], after the interacting multiple model filter or another [`Interaction`].

use super::rauch_tung_striebel::{smoothed_covariance, smoothed_mean, smoother_gain};
use super::switching::{SwitchingSmoother, pair_probability};
use super::unsmoothable::Unsmoothable;
use crate::gaussian::{Gaussian, log_density};
use crate::imm::angles::{merged, wrapped};
use crate::imm::gpb2::weighed;
use crate::imm::plain::predict_mode;
use crate::imm::probability::{mixing_probability, predicted_mode_probability};
use crate::imm::state_conversion::Reader;
use crate::imm::{Failure, Imm, Interaction, Problem, by_kind};
use crate::matrix::{Holds, Shapes, all_finite, ldl};
use crate::number::{Field, Real};
use nalgebra::{Dim, OMatrix};

/// What is known of a step, by its own measurement and those before, or by later ones too.
#[derive(Debug, Clone, PartialEq)]
pub struct SmoothedStep<T: Field, N: Dim>
where
    Shapes: Holds<N>,
{
    /// k.
    pub step: usize,
    /// The estimates of the modes.
    pub modes: Vec<Gaussian<T, N>>,
    /// The mode probabilities.
    pub mode_probabilities: Vec<T>,
    /// The combined estimate.
    pub combined: Gaussian<T, N>,
}

/// From a step to the next: what each mode j makes of the updated estimate of each mode i.
#[derive(Debug, Clone)]
struct Passage<T: Field, N: Dim>
where
    Shapes: Holds<N>,
{
    /// Which entries of the state are angles.
    angles: Vec<usize>,
    /// The pairs of modes that are possible.
    pairs: Vec<Pair<T, N>>,
}

/// Mode i at a step and mode j at the next.
#[derive(Debug, Clone)]
struct Pair<T: Field, N: Dim>
where
    Shapes: Holds<N>,
{
    i: usize,
    j: usize,
    /// μᵢ∣ⱼ.
    mixing_probability: T,
    /// The prediction of mode j from the updated estimate of mode i.
    predicted: Gaussian<T, N>,
    /// D, the covariance of the state before the motion and after it.
    cross_covariance: OMatrix<T, N, N>,
}

/// The steps of a run that were recorded, and the smoothers of it.
///
/// Example: the random walk of [`Imm`]. What is measured at step 1 says half of its correction about step 0.
///
/// ```
/// use immaculate::filter::Filter;
/// use immaculate::{gaussian::Gaussian, imm::{Imm, Initial, Interaction, Problem}};
/// use immaculate::model::{Sensor, motion::{Mode, Motion}};
/// use immaculate::smoother::Recording;
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
/// let estimate = Gaussian { mean: vector![0.0], covariance: matrix![1.0] };
/// let mut filter = Imm::new(problem, &Initial { modes: vec![estimate], mode_probabilities: vec![1.0] })?;
/// let mut run = Recording::new(&filter)?;
/// for z in [Some(vector![4.0]), None] {
///     filter.step(z.as_ref())?;
///     run.record(&filter)?; // after every step
/// }
/// let smoothed = run.fixed_interval()?;
/// let of = |k: usize| (smoothed[k].combined.mean[0], smoothed[k].combined.covariance[0]);
/// assert_eq!([of(0), of(1), of(2)], [(1.0, 0.75), (2.0, 1.0), (2.0, 2.0)]); // 0 + ½ · (2 − 0), 1 + ½ · (1 − 2) · ½
/// assert_eq!(run.fixed_lag(2)?, smoothed[0]);
/// let sentence = "a lag of 3 is longer than the recorded run; ask for a lag of at most 2";
/// assert_eq!(run.fixed_lag(3).unwrap_err().to_string(), sentence);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Evidence: `a_recorded_run_is_smoothed_by_these_equations`, `a_lag_of_the_whole_run_is_the_fixed_interval` (smoothers, enclosed).
#[derive(Debug, Clone)]
pub struct Recording<T: Field, N: Dim>
where
    Shapes: Holds<N>,
{
    /// The names of the modes.
    names: Vec<String>,
    /// What the filter knew at each step.
    steps: Vec<SmoothedStep<T, N>>,
    /// How it came from each of them to the next.
    passages: Vec<Passage<T, N>>,
    /// What says which mode was before another.
    form: SwitchingSmoother,
}

impl<T: Real, N: Dim> Recording<T, N>
where
    Shapes: Holds<N>,
{
    /// A recording that begins with the last step of a filter, step 0 or a later one.
    ///
    /// # Errors
    ///
    /// [`Unsmoothable`] when these equations do not hold for the filter.
    pub fn new<M: Dim>(filter: &Imm<T, N, M>) -> Result<Self, Unsmoothable>
    where
        Shapes: Holds<N, M>,
    {
        check(filter.problem())?;
        Ok(Self {
            names: filter.problem().modes.iter().map(|mode| mode.name.clone()).collect(),
            steps: vec![updated(filter)],
            passages: Vec::new(),
            form: SwitchingSmoother::ExpectationCorrection,
        })
    }

    /// The same by another smoother among modes than expectation correction; for one mode they are the same.
    #[must_use]
    pub fn by(self, form: SwitchingSmoother) -> Self {
        Self { form, ..self }
    }

    /// Records the step that the filter has just made.
    ///
    /// # Errors
    ///
    /// [`Unsmoothable`] when a step was left out, the filter is another one, or the equations do not hold for the problem that it has gone
    /// on with.
    pub fn record<M: Dim>(&mut self, filter: &Imm<T, N, M>) -> Result<(), Unsmoothable>
    where
        Shapes: Holds<N, M>,
    {
        check(filter.problem())?;
        let (last, now) = (self.last(), filter.current());
        if now.updated.len() != last.modes.len() || now.combined.mean.len() != last.combined.mean.len() {
            return Err(Unsmoothable::OtherFilter);
        }
        let (expected, found) = (last.step + 1, now.step);
        if found != expected {
            return Err(Unsmoothable::OtherStep { expected, found });
        }
        let passage = passage(filter, self.last()).map_err(Unsmoothable::Prediction)?;
        self.passages.push(passage);
        self.steps.push(updated(filter));
        Ok(())
    }

    /// The steps that were recorded after the first.
    pub fn recorded(&self) -> usize {
        self.passages.len()
    }

    /// Forgets all but the last steps, as a smoother with a fixed lag needs no others: its memory then does not grow with the run.
    pub fn keep(&mut self, lag: usize) {
        let forgotten = self.passages.len().saturating_sub(lag);
        self.passages.drain(..forgotten);
        self.steps.drain(..forgotten);
    }

    /// Every recorded step, given the measurements of all of them; the last is the filter's own.
    ///
    /// # Errors
    ///
    /// [`Unsmoothable`] with step and mode when an equation has no answer.
    pub fn fixed_interval(&self) -> Result<Vec<SmoothedStep<T, N>>, Unsmoothable> {
        let mut smoothed = vec![self.last().clone()];
        for k in (0..self.passages.len()).rev() {
            let before = self.step_back(k, &smoothed[smoothed.len() - 1])?;
            smoothed.push(before);
        }
        smoothed.reverse();
        Ok(smoothed)
    }

    /// The step that is `lag` steps before the last one, given all measurements so far; for a lag of 0 that is the filter's own.
    ///
    /// # Errors
    ///
    /// As [`Recording::fixed_interval`], and for a lag longer than what was recorded.
    pub fn fixed_lag(&self, lag: usize) -> Result<SmoothedStep<T, N>, Unsmoothable> {
        let recorded = self.passages.len();
        if lag > recorded {
            return Err(Unsmoothable::Lag { lag, recorded });
        }
        let mut smoothed = self.last().clone();
        for k in (recorded - lag..recorded).rev() {
            smoothed = self.step_back(k, &smoothed)?;
        }
        Ok(smoothed)
    }

    fn last(&self) -> &SmoothedStep<T, N> {
        &self.steps[self.steps.len() - 1]
    }

    /// Step k from the smoothed step k+1.
    fn step_back(&self, k: usize, after: &SmoothedStep<T, N>) -> Result<SmoothedStep<T, N>, Unsmoothable> {
        let (before, passage) = (&self.steps[k], &self.passages[k]);
        // Mode i, P(i, j) and the estimate of each pair.
        let mut parts = Vec::new();
        for (j, probability_after) in after.mode_probabilities.iter().enumerate() {
            if probability_after.is_zero() {
                continue;
            }
            let pairs: Vec<_> = passage.pairs.iter().filter(|pair| pair.j == j).collect();
            let backward = self.backward(&passage.angles, &pairs, &after.modes[j]);
            for (pair, backward) in pairs.into_iter().zip(backward) {
                let estimate = self.smoothed_pair(passage, pair, &before.modes[pair.i], after)?;
                parts.push((pair.i, pair_probability(&backward, probability_after), estimate));
            }
        }
        let mut smoothed = before.clone();
        for (i, mode) in smoothed.modes.iter_mut().enumerate() {
            let of_mode = || parts.iter().filter(|part| part.0 == i);
            let probability = of_mode().fold(T::zero(), |sum, part| sum + part.1.clone());
            // A mode without probability keeps its own estimate, as it does in the filter.
            if !probability.is_zero() {
                let weights: Vec<T> = of_mode().map(|part| part.1.clone() / probability.clone()).collect();
                let estimates: Vec<_> = of_mode().map(|part| part.2.clone()).collect();
                *mode = merged(&passage.angles, &weights, &estimates);
            }
            smoothed.mode_probabilities[i] = probability;
        }
        smoothed.combined = merged(&passage.angles, &smoothed.mode_probabilities, &smoothed.modes);
        if all_finite(&smoothed.combined.mean) && all_finite(&smoothed.combined.covariance) {
            return Ok(smoothed);
        }
        Err(Unsmoothable::NotFinite { step: before.step })
    }

    /// P(i ∣ j), the mode before.
    fn backward(&self, angles: &[usize], pairs: &[&Pair<T, N>], after: &Gaussian<T, N>) -> Vec<T> {
        let mixing: Vec<T> = pairs.iter().map(|pair| pair.mixing_probability.clone()).collect();
        if self.form == SwitchingSmoother::Kim {
            return mixing;
        }
        let of_pair = |pair: &&Pair<T, N>| {
            let difference = wrapped(angles, &after.mean - &pair.predicted.mean);
            log_density(&difference, &ldl(&pair.predicted.covariance))
        };
        let log_likelihoods: Vec<T> = pairs.iter().map(of_pair).collect();
        weighed(&log_likelihoods, &mixing).0
    }

    /// The state before, if mode i was its own and mode j the next.
    fn smoothed_pair(
        &self,
        passage: &Passage<T, N>,
        pair: &Pair<T, N>,
        updated: &Gaussian<T, N>,
        after: &SmoothedStep<T, N>,
    ) -> Result<Gaussian<T, N>, Unsmoothable> {
        let (predicted, smoothed) = (&pair.predicted, &after.modes[pair.j]);
        let gain =
            smoother_gain(&pair.cross_covariance, &predicted.covariance).map_err(|pivot| Unsmoothable::Singular {
                step: after.step,
                mode: self.names[pair.j].clone(),
                pivot,
            })?;
        let correction = wrapped(&passage.angles, &smoothed.mean - &predicted.mean);
        let covariance = smoothed_covariance(&updated.covariance, &gain, &smoothed.covariance, &predicted.covariance);
        Ok(Gaussian {
            mean: smoothed_mean(&updated.mean, &gain, &correction),
            covariance,
        })
    }
}

/// Whether these equations hold for a problem.
fn check<T: Real, N: Dim, M: Dim>(problem: &Problem<T, N, M>) -> Result<(), Unsmoothable>
where
    Shapes: Holds<N, M>,
{
    if !problem.has_covariances() {
        return Err(Unsmoothable::NoCovariances);
    }
    if matches!(problem.interaction, Interaction::Converted(_)) {
        return Err(Unsmoothable::OwnStates);
    }
    let is_correlated = |j: &usize| problem.filter(*j).noise_cross_covariance.is_some();
    match (0..problem.modes.len()).find(is_correlated) {
        Some(j) => Err(Unsmoothable::CorrelatedNoise {
            mode: problem.modes[j].name.clone(),
        }),
        None => Ok(()),
    }
}

/// What a filter knows at its last step.
fn updated<T: Real, N: Dim, M: Dim>(filter: &Imm<T, N, M>) -> SmoothedStep<T, N>
where
    Shapes: Holds<N, M>,
{
    let step = filter.current();
    SmoothedStep {
        step: step.step,
        modes: step.updated.clone(),
        mode_probabilities: step.mode_probabilities.clone(),
        combined: step.combined.clone(),
    }
}

/// How a filter could come to its last step from the one before.
fn passage<T: Real, N: Dim, M: Dim>(
    filter: &Imm<T, N, M>,
    before: &SmoothedStep<T, N>,
) -> Result<Passage<T, N>, Failure>
where
    Shapes: Holds<N, M>,
{
    let (problem, step) = (filter.problem(), filter.current().step);
    let mut pairs = Vec::new();
    for j in 0..problem.modes.len() {
        let c = predicted_mode_probability(&problem.chain, &before.mode_probabilities, j);
        for (i, updated) in before.modes.iter().enumerate() {
            let mixing_probability = mixing_probability(&problem.chain, &before.mode_probabilities, &c, i, j);
            if mixing_probability.is_zero() {
                continue;
            }
            let mut predicted = updated.clone();
            let moved = predict_mode(problem, step, j, updated, &mut predicted)?;
            let cross_covariance = by_kind::motion_cross_covariance(
                problem,
                j,
                updated,
                moved.jacobian.as_ref(),
                &moved.points,
                &moved.propagated,
                &predicted.mean,
            );
            pairs.push(Pair {
                i,
                j,
                mixing_probability,
                predicted,
                cross_covariance,
            });
        }
    }
    Ok(Passage {
        angles: problem.angles_of(Reader::Common).to_vec(),
        pairs,
    })
}
