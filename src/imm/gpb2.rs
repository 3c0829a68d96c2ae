//! The generalised pseudo-Bayesian filter of second order: every mode after every mode before, merged once the measurement is used.
//!
//! The interacting multiple model filter mixes the estimates of the modes before it predicts. This one predicts and updates mode j from the
//! estimate of every mode i by itself, r² branches, and merges those that end in the same mode:
//!
//! ```text
//! x̂ⁱ, Pⁱ ─ prediction and update of mode j ─▶ x̂ⁱʲ, Pⁱʲ, ln Lᵢⱼ         one branch for each i and j
//! μᵢ∣ⱼ = pᵢⱼ μᵢ / cⱼ      P(i ∣ j, z) = Lᵢⱼ μᵢ∣ⱼ / Σₗ Lₗⱼ μₗ∣ⱼ          probability::mixing_probability, mode_probability
//! Lⱼ = Σᵢ Lᵢⱼ μᵢ∣ⱼ        μⱼ = Lⱼ cⱼ / Σₗ Lₗ cₗ                        probability::log_evidence, mode_probability
//! x̂ʲ, Pʲ                  moments of the branches of j                 gaussian::mixture_mean, mixture_covariance
//! ```
//!
//! Each mode is a static bank of branches, and its likelihood is the evidence of that bank, so that no equation is new. From Gaussian
//! modes, one step of linear filters is Bayes' rule for all pairs of modes; only the merging after it is an approximation.
//!
//! When it is the interacting filter: without a detection, if the motions are linear; where every mode can be reached from one only, as
//! where modes never change; and where all estimates that are mixed are equal. That the chain forgets, pᵢⱼ = qⱼ, is not enough: both then
//! mix with μᵢ, but only this filter weighs what it merges by the measurement.
//!
//! The branches of one mode are merged before those of the next are computed, so that r of them are held at once.

use super::angles::merged;
use super::by_kind;
use super::failure::{Cause, Failure, check_combined, check_measurement, failure};
use super::plain::{mixture, predict_mode, update_mode};
use super::record::Quantity;
use super::state_conversion::{Reader, estimates_read};
use super::{Initial, Interaction, InvalidProblem, Problem, probability};
use crate::gaussian::Gaussian;
use crate::matrix::{Holds, Shapes, is_finite};
use crate::number::Real;
use nalgebra::{Dim, OVector};

/// The generalised pseudo-Bayesian filter of second order, GPB2. It keeps no record of its steps.
///
/// Source: C. B. Chang and M. Athans, State Estimation for Discrete Systems with Switching Parameters, 1978; Y. Bar-Shalom, X. R. Li and
/// T. Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, chapter 11 (GPB2).
///
/// Example: two equal modes at 0 and at 4, and a measurement of 2 between them. Each branch believes half of it, 0 + ½ · 2 and 4 − ½ · 2,
/// and the variance 1 of each stands beside the spread of 1 and 3. The interacting filter has mixed them to 2 with the variance 5 before,
/// and ends with 6 − ¾ · 6.
///
/// ```
/// use immaculate::filter::Filter;
/// use immaculate::{gaussian::Gaussian, imm::{Gpb2, Imm, Initial, Interaction, Problem}};
/// use immaculate::model::{Sensor, motion::{Mode, Motion}};
/// use nalgebra::{matrix, vector};
///
/// let mode = Mode { name: "walk".into(), motion: Motion::Linear(matrix![1.0]), noise: matrix![1.0] };
/// let problem = Problem {
///     modes: vec![mode; 2],
///     filters: vec![Filter::kalman()],
///     interaction: Interaction::Imm,
///     angles: vec![],
///     chain: vec![vec![0.5, 0.5], vec![0.5, 0.5]],
///     sensor: Sensor::Linear(matrix![1.0]),
///     measurement_noise: matrix![2.0],
/// };
/// let at = |x| Gaussian { mean: vector![x], covariance: matrix![1.0] };
/// let initial = Initial { modes: vec![at(0.0), at(4.0)], mode_probabilities: vec![0.5, 0.5] };
/// let mut filter = Gpb2::new(problem.clone(), &initial)?;
/// let combined = filter.step(Some(&vector![2.0]))?;
/// assert_eq!((combined.mean, combined.covariance), (vector![2.0], matrix![2.0])); // 1 + 1
/// let mut interacting = Imm::new(problem, &initial)?;
/// assert_eq!(interacting.step(Some(&vector![2.0]))?.combined.covariance, matrix![1.5]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Evidence: `one_step_is_the_rule_of_bayes_for_all_pairs_of_modes`, `without_a_detection_it_is_the_interacting_filter`,
/// `where_the_chain_forgets_it_is_the_interacting_filter_only_if_estimates_are_equal` (gpb2, enclosed).
#[derive(Debug, Clone)]
pub struct Gpb2<T: Real, N: Dim, M: Dim>
where
    Shapes: Holds<N, M>,
{
    problem: Problem<T, N, M>,
    /// k.
    step: usize,
    /// The estimates of the modes.
    modes: Vec<Gaussian<T, N>>,
    /// μⱼ.
    mode_probabilities: Vec<T>,
    /// The combined estimate.
    combined: Gaussian<T, N>,
}

impl<T: Real, N: Dim, M: Dim> Gpb2<T, N, M>
where
    Shapes: Holds<N, M>,
{
    /// The filter at step 0.
    ///
    /// # Errors
    ///
    /// [`InvalidProblem`] when the problem or the initial estimate is wrong, or its interaction is of another filter: a problem of this one
    /// is one of the interacting filter.
    pub fn new(problem: Problem<T, N, M>, initial: &Initial<T, N>) -> Result<Self, InvalidProblem> {
        if matches!(problem.interaction, Interaction::Gpb1 | Interaction::Unmixed) {
            return Err(InvalidProblem::OtherInteraction);
        }
        problem.check(initial)?;
        Ok(Self::unchecked(problem, initial))
    }

    /// The filter at step 0, of a problem that has been checked.
    pub(crate) fn unchecked(problem: Problem<T, N, M>, initial: &Initial<T, N>) -> Self {
        let modes = problem.estimates_at_start(initial);
        let mode_probabilities = initial.mode_probabilities.clone();
        let combined = mixture(&problem, Reader::Common, &mode_probabilities, &modes);
        Self {
            problem,
            step: 0,
            modes,
            mode_probabilities,
            combined,
        }
    }

    /// The problem from the next step on, which has been checked.
    #[cfg(feature = "cli")]
    pub(crate) fn change_unchecked(&mut self, problem: &Problem<T, N, M>) {
        self.problem.clone_from(problem);
    }

    /// The combined estimate of the last step; of the initial estimates before the first.
    pub fn combined(&self) -> &Gaussian<T, N> {
        &self.combined
    }

    /// The estimates of the modes.
    pub fn modes(&self) -> &[Gaussian<T, N>] {
        &self.modes
    }

    /// The mode probabilities.
    pub fn mode_probabilities(&self) -> &[T] {
        &self.mode_probabilities
    }

    /// One step, with a measurement or without a detection; gives the combined estimate.
    ///
    /// # Errors
    ///
    /// As [`Imm::step`](super::Imm::step); the filter is then still at the step before.
    pub fn step(&mut self, measurement: Option<&OVector<T, M>>) -> Result<&Gaussian<T, N>, Failure> {
        let (problem, step) = (&self.problem, self.step + 1);
        if let Some(z) = measurement {
            check_measurement(problem, step, z)?;
        }
        let predicted: Vec<T> = (0..self.modes.len())
            .map(|j| probability::predicted_mode_probability(&problem.chain, &self.mode_probabilities, j))
            .collect();
        let (mut modes, mut log_likelihoods) = (Vec::new(), Vec::new());
        for (j, predicted_probability) in predicted.iter().enumerate() {
            let (estimate, log_likelihood) = self.merged_mode(j, predicted_probability, measurement)?;
            modes.push(estimate);
            log_likelihoods.push(log_likelihood);
        }
        let (mode_probabilities, log_evidence) = weighed(&log_likelihoods, &predicted);
        if measurement.is_some() && !is_finite(&log_evidence) {
            let value = Quantity::ModeProbabilities.name();
            return Err(failure(problem, step, None, value, Cause::NoEvidence));
        }
        let combined = mixture(problem, Reader::Common, &mode_probabilities, &modes);
        check_combined(problem, step, &combined)?;
        self.step = step;
        (self.modes, self.mode_probabilities, self.combined) = (modes, mode_probabilities, combined);
        Ok(&self.combined)
    }

    /// The branches that end in mode j as one estimate, and ln Lⱼ; 0 without a detection.
    fn merged_mode(
        &self,
        j: usize,
        predicted_probability: &T,
        measurement: Option<&OVector<T, M>>,
    ) -> Result<(Gaussian<T, N>, T), Failure> {
        let (problem, step) = (&self.problem, self.step + 1);
        let converted = measurement.and_then(|z| by_kind::converted_measurement(problem, z));
        let converted_covariance = measurement.and_then(|z| by_kind::converted_covariance(problem, z));
        let (mut branches, mut mixing, mut log_likelihoods) = (Vec::new(), Vec::new(), Vec::new());
        for (i, before) in estimates_read(problem, &self.modes, Reader::Mode(j)).iter().enumerate() {
            let (chain, probabilities) = (&problem.chain, &self.mode_probabilities);
            let probability = probability::mixing_probability(chain, probabilities, predicted_probability, i, j);
            if probability.is_zero() {
                continue;
            }
            let mut branch = before.clone();
            predict_mode(problem, step, j, before, &mut branch)?;
            let log_likelihood = match measurement {
                Some(z) => {
                    let z = by_kind::used(problem, j, z, converted.as_ref());
                    let noise = by_kind::used(problem, j, &problem.measurement_noise, converted_covariance.as_ref());
                    update_mode(problem, step, j, &mut branch, z, noise)?
                }
                None => T::zero(),
            };
            branches.push(branch);
            mixing.push(probability);
            log_likelihoods.push(log_likelihood);
        }
        let (weights, log_likelihood) = weighed(&log_likelihoods, &mixing);
        Ok((
            merged(problem.angles_of(Reader::Mode(j)), &weights, &branches),
            log_likelihood,
        ))
    }
}

/// Probabilities after a measurement with these likelihoods, and the log-likelihood of it under all together.
pub(crate) fn weighed<T: Real>(log_likelihoods: &[T], probabilities: &[T]) -> (Vec<T>, T) {
    let relative = |place| probability::relative_likelihood(log_likelihoods, probabilities, place);
    let relative: Vec<T> = (0..probabilities.len()).map(relative).collect();
    let evidence = probability::evidence(&relative, probabilities);
    let log_evidence = probability::log_evidence(log_likelihoods, probabilities, &evidence);
    let after = |(likelihood, before): (&T, &T)| probability::mode_probability(likelihood, before, &evidence);
    (relative.iter().zip(probabilities).map(after).collect(), log_evidence)
}
