//! The runs: every filter along the same measurements, and what becomes of each.

use super::group::ErrorGroup;
use super::truth::SimulatedRun;
use crate::imm::{Equations, Problem, angles};
use crate::number::{Counted, RandomRounding, Real};
use crate::oracle::invalid::Invalid;
use crate::oracle::problem::ProblemFile;
use crate::oracle::setup::Setup;
use crate::statistics::consistency::nis;
use nalgebra::{DVector, Dyn};
use rayon::prelude::*;
use std::time::Instant;

type Double = RandomRounding;

/// What one filter did in one run.
#[derive(Debug, Clone)]
pub struct FilterRun {
    /// Squared errors, `[step][group]`, as many steps as were computed.
    pub squares: Vec<Vec<f64>>,
    /// The mean over the steps of the squared error of each component.
    pub components: Vec<f64>,
    /// The normalised estimation error squared of each step; not a number where there is none.
    pub nees: Vec<f64>,
    /// The normalised innovations squared of the steps with a measurement.
    pub nis: Vec<f64>,
    /// The first step that could not be computed, in a sentence.
    pub failure: Option<String>,
    /// The median time of a step, s: a step in which the machine did something else counts no more than any other.
    pub time: f64,
}

/// Called once for each finished run.
pub type RunDone<'a> = &'a (dyn Fn() + Sync);

/// Every filter along every run; the result is `[run][filter]`.
pub fn race(
    setups: &[Setup<Double>],
    groups: &[ErrorGroup],
    runs: &[SimulatedRun],
    done: RunDone,
) -> Vec<Vec<FilterRun>> {
    let one = |(number, run): (usize, &SimulatedRun)| {
        let mut outcomes: Vec<Option<FilterRun>> = vec![None; setups.len()];
        // Each run begins with another filter, so that none is always the first to be timed.
        for place in 0..setups.len() {
            let filter = (number + place) % setups.len();
            outcomes[filter] = Some(follow(&setups[filter], groups, run));
        }
        done();
        outcomes.into_iter().flatten().collect()
    };
    runs.par_iter().enumerate().map(one).collect()
}

/// A filter along the measurements of a run, to their end or to the first step that cannot be computed.
fn follow(setup: &Setup<Double>, groups: &[ErrorGroup], run: &SimulatedRun) -> FilterRun {
    let mut filter = setup.filter();
    let n = setup.problem.n().0;
    let nees = Equations::standard().nees;
    let mut outcome = FilterRun {
        squares: Vec::with_capacity(run.states.len()),
        components: vec![0.0; n],
        nees: Vec::with_capacity(run.states.len()),
        nis: Vec::with_capacity(run.states.len()),
        failure: None,
        time: f64::NAN,
    };
    let mut times = Vec::with_capacity(run.states.len());
    for (k, truth) in run.states.iter().enumerate() {
        let z = run.measurements[k].as_ref().map(|z| numbers(z, Double::exact));
        if !setup.changes.is_empty() {
            filter.change_unchecked(setup.problem_of(k + 1));
        }
        let start = Instant::now();
        let failure = filter.step(z.as_ref()).err();
        times.push(start.elapsed().as_secs_f64());
        if let Some(failure) = failure {
            outcome.failure = Some(failure.to_string());
            return outcome;
        }
        let truth = numbers(truth, Double::exact);
        let errors = errors(filter.problem(), &filter.current().combined.mean, &truth);
        for (sum, error) in outcome.components.iter_mut().zip(&errors) {
            *sum += error * error / run.states.len() as f64;
        }
        let of_group = |group: &ErrorGroup| group.entries.iter().map(|&entry| errors[entry] * errors[entry]).sum();
        outcome.squares.push(groups.iter().map(of_group).collect());
        outcome.nis.extend(nis(filter.current()).map(Double::value));
        filter.current_mut().truth = Some(truth);
        let square = setup.problem.has_covariances().then(|| {
            let now = filter.current();
            (nees)(filter.problem(), now, now, 0)
        });
        outcome.nees.push(square.flatten().map_or(f64::NAN, Double::value));
    }
    outcome.time = quantile(&mut times, 0.5);
    outcome
}

/// The value below which a part of the others lie; not a number where there is none.
pub(super) fn quantile(values: &mut [f64], part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and the length"
    )]
    let place = (part * values.len().saturating_sub(1) as f64).round() as usize;
    values.get(place).copied().unwrap_or(f64::NAN)
}

/// Estimate minus truth, angles the short way round.
fn errors(problem: &Problem<Double, Dyn, Dyn>, mean: &DVector<Double>, truth: &DVector<Double>) -> Vec<f64> {
    let truth = angles::in_the_turn_of(&problem.angles, mean, truth);
    (mean - truth).iter().map(|error| error.value()).collect()
}

fn numbers<T: Real>(values: &[f64], number: fn(f64) -> T) -> DVector<T> {
    DVector::from_iterator(values.len(), values.iter().map(|&value| number(value)))
}

/// The operations of a step, averaged over the steps of a run that can be computed; none where the first cannot.
///
/// # Errors
///
/// [`Invalid`] for a problem that cannot be set up.
pub fn operations(problem: &ProblemFile, run: &SimulatedRun) -> Result<Option<f64>, Invalid> {
    let mut problem = problem.clone();
    // The normalised innovations are no part of the filter.
    problem.lacks_consistency = true;
    let setup = problem.setup(Counted::new)?;
    let mut filter = setup.filter();
    let (mut sum, mut steps) = (0, 0_u32);
    for (k, z) in run.measurements.iter().enumerate() {
        let z = z.as_ref().map(|z| numbers(z, Counted::new));
        if !setup.changes.is_empty() {
            filter.change_unchecked(setup.problem_of(k + 1));
        }
        let (is_computed, operations) = Counted::during(|| filter.step(z.as_ref()).is_ok());
        if !is_computed {
            break;
        }
        (sum, steps) = (sum + operations, steps + 1);
    }
    Ok((steps > 0).then(|| sum as f64 / f64::from(steps)))
}
