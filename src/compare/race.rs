//! The runs: every filter along the same measurements, and what becomes of each.

use super::contenders::Contender;
use super::group::ErrorGroup;
use super::truth::SimulatedRun;
use crate::imm::{Equations, Failure, Gpb2, Imm, Problem, angles};
use crate::number::{Counted, RandomRounding, Real};
use crate::oracle::invalid::Invalid;
use crate::oracle::setup::Setup;
use crate::statistics::consistency::nis;
use crate::statistics::estimate::quantile;
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

/// A filter on its way.
#[derive(Debug, Clone)]
struct Runner<T: Real> {
    /// The cycle, with the record of its step; of GPB2 only the combined estimate is recorded.
    filter: Imm<T, Dyn, Dyn>,
    second_order: Option<Gpb2<T, Dyn, Dyn>>,
}

impl<T: Real> Runner<T> {
    /// The filter at step 0.
    fn new(setup: &Setup<T>, is_second_order: bool) -> Self {
        Self {
            filter: setup.filter(),
            second_order: is_second_order.then(|| Gpb2::unchecked(setup.problem.clone(), &setup.initial)),
        }
    }

    /// The next step, in the problem that it has.
    fn step(&mut self, setup: &Setup<T>, step: usize, z: Option<&DVector<T>>) -> Result<(), Failure> {
        if !setup.changes.is_empty() {
            self.filter.change_unchecked(setup.problem_of(step));
        }
        match &mut self.second_order {
            None => self.filter.step(z).map(drop),
            Some(filter) => {
                if !setup.changes.is_empty() {
                    filter.change_unchecked(setup.problem_of(step));
                }
                self.filter.current_mut().combined.clone_from(filter.step(z)?);
                Ok(())
            }
        }
    }
}

/// Called once for each finished run.
pub type RunDone<'a> = &'a (dyn Fn() + Sync);

/// Every filter along every run; the result is `[run][filter]`. Beside each problem stands whether GPB2 runs it.
pub fn race(
    filters: &[(Setup<Double>, bool)],
    groups: &[ErrorGroup],
    runs: &[SimulatedRun],
    done: RunDone,
) -> Vec<Vec<FilterRun>> {
    let one = |(number, run): (usize, &SimulatedRun)| {
        let mut outcomes: Vec<Option<FilterRun>> = vec![None; filters.len()];
        // Each run begins with another filter, so that none is always the first to be timed.
        for place in 0..filters.len() {
            let filter = (number + place) % filters.len();
            outcomes[filter] = Some(follow(&filters[filter], groups, run));
        }
        done();
        outcomes.into_iter().flatten().collect()
    };
    runs.par_iter().enumerate().map(one).collect()
}

/// A filter along the measurements of a run, to their end or to the first step that cannot be computed.
fn follow((setup, is_second_order): &(Setup<Double>, bool), groups: &[ErrorGroup], run: &SimulatedRun) -> FilterRun {
    let mut runner = Runner::new(setup, *is_second_order);
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
        let start = Instant::now();
        let failure = runner.step(setup, k + 1, z.as_ref()).err();
        times.push(start.elapsed().as_secs_f64());
        if let Some(failure) = failure {
            outcome.failure = Some(failure.to_string());
            return outcome;
        }
        let truth = numbers(truth, Double::exact);
        let filter = &mut runner.filter;
        let errors = errors(filter.problem(), &filter.current().combined.mean, &truth);
        for (sum, error) in outcome.components.iter_mut().zip(&errors) {
            *sum += error * error / run.states.len() as f64;
        }
        let of_group = |group: &ErrorGroup| group.entries.iter().map(|&entry| errors[entry] * errors[entry]).sum();
        outcome.squares.push(groups.iter().map(of_group).collect());
        if !is_second_order {
            outcome.nis.extend(nis(filter.current()).map(Double::value));
        }
        filter.current_mut().truth = Some(truth);
        let square = setup.problem.has_covariances().then(|| {
            let now = filter.current();
            (nees)(filter.problem(), now, now, 0)
        });
        outcome.nees.push(square.flatten().map_or(f64::NAN, Double::value));
    }
    outcome.time = quantile(&mut times, 0.5).unwrap_or(f64::NAN);
    outcome
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
pub fn operations(contender: &Contender, run: &SimulatedRun) -> Result<Option<f64>, Invalid> {
    let mut problem = contender.problem.clone();
    // The normalised innovations are no part of the filter.
    problem.lacks_consistency = true;
    let setup = problem.setup_undeclared(Counted::new)?;
    let mut runner = Runner::new(&setup, contender.is_second_order);
    let (mut sum, mut steps) = (0, 0_u32);
    for (k, z) in run.measurements.iter().enumerate() {
        let z = z.as_ref().map(|z| numbers(z, Counted::new));
        let (is_computed, operations) = Counted::during(|| runner.step(&setup, k + 1, z.as_ref()).is_ok());
        if !is_computed {
            break;
        }
        (sum, steps) = (sum + operations, steps + 1);
    }
    Ok((steps > 0).then(|| sum as f64 / f64::from(steps)))
}
