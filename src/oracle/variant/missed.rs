//! Variants of a step without a detection: what programs do when there is nothing to update with.

use super::super::setup::Setup;
use crate::gaussian::log_density;
use crate::imm::probability::{evidence, mode_probability, relative_likelihood};
use crate::imm::{Equations, Failure, Problem, Step, update};
use crate::matrix::ldl;
use crate::number::Real;
use nalgebra::{DMatrix, DVector, Dyn};

/// Applies a variant of a step without a detection; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    of_measurement(id, setup) || of_estimate(id, setup) || of_probability(id, setup)
}

/// A measurement is put where there is none.
fn of_measurement<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    match id {
        "missed-detection-as-zero" => {
            for (index, measurement) in setup.measurements.iter_mut().enumerate() {
                let problem = setup.changes.get(&(index + 1)).unwrap_or(&setup.problem);
                measurement.get_or_insert_with(|| DVector::zeros(problem.m().0));
            }
        }
        "missed-detection-as-the-last-measurement" => {
            for k in 1..setup.measurements.len() {
                // That of a sensor of another dimension no program can take.
                let m = setup.problem_of(k + 1).m().0;
                let last = setup.measurements[k - 1].clone().filter(|z| z.len() == m);
                setup.measurements[k] = setup.measurements[k].take().or(last);
            }
        }
        _ => return false,
    }
    true
}

/// The estimates.
fn of_estimate<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // ν = 0, and everything else as with a detection
        "missed-detection-as-zero-innovation" => {
            equations.undetected_covariance = |problem, previous, now, j| {
                let found = detected(problem, previous, now, j);
                found.map_or_else(|_| undecided(problem), |found| found.updated[j].covariance.clone())
            };
            equations.undetected_log_likelihood = |problem, previous, now, j| {
                let found = detected(problem, previous, now, j).ok()?;
                Some(log_density(
                    &DVector::zeros(problem.m().0),
                    &ldl(&found.innovation_covariances[j]),
                ))
            };
            equations.undetected_mode_probability = |_, _, now, j| by_bayes(now, j);
        }
        // ν = 0 for the covariance alone
        "missed-detection-updates-the-covariance" => {
            equations.undetected_covariance = |problem, previous, now, j| {
                let found = detected(problem, previous, now, j);
                found.map_or_else(|_| undecided(problem), |found| found.updated[j].covariance.clone())
            };
        }
        // the estimate of the step before
        "missed-detection-not-predicted" => {
            equations.undetected_mean = |_, previous, _, j| previous.updated[j].mean.clone();
            equations.undetected_covariance = |_, previous, _, j| previous.updated[j].covariance.clone();
        }
        // the mixed estimate
        "missed-detection-only-mixed" => {
            equations.undetected_mean = |_, _, now, j| now.mixed[j].mean.clone();
            equations.undetected_covariance = |_, _, now, j| now.mixed[j].covariance.clone();
        }
        _ => return false,
    }
    true
}

/// The mode probabilities.
fn of_probability<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // μⱼ of step k−1
        "probabilities-not-advanced" => {
            equations.undetected_mode_probability = |_, previous, _, j| previous.mode_probabilities[j].clone();
        }
        // N(0; 0, S) with the S of the last detection
        "last-covariance-used-again" => {
            equations.undetected_log_likelihood = |_, previous, _, j| match previous.measurement {
                Some(_) => {
                    let factors = ldl(&previous.innovation_covariances[j]);
                    Some(log_density(&DVector::zeros(factors.diagonal.len()), &factors))
                }
                None => Some(last_likelihood(previous, j)),
            };
            equations.undetected_mode_probability = |_, _, now, j| by_bayes(now, j);
        }
        // Lⱼ of the last detection; before the first there is none, and all are one
        "last-likelihood-used-again" => {
            equations.undetected_log_likelihood = |_, previous, _, j| Some(last_likelihood(previous, j));
            equations.undetected_mode_probability = |_, _, now, j| by_bayes(now, j);
        }
        _ => return false,
    }
    true
}

/// The step with values of the modes up to j as if the combined prediction had been measured, which is also where R^c is taken: there is
/// nothing else.
fn detected<T: Real>(
    problem: &Problem<T, Dyn, Dyn>,
    previous: &Step<T, Dyn, Dyn>,
    now: &Step<T, Dyn, Dyn>,
    j: usize,
) -> Result<Step<T, Dyn, Dyn>, Failure> {
    let (e, mut now) = (Equations::standard(), now.clone());
    let z = problem.sensor.of(&now.combined_prediction.mean);
    now.converted_measurement = (e.converted_measurement)(problem, &z, &now, 0);
    now.converted_covariance = (e.converted_covariance)(problem, &z, &now, 0);
    for i in 0..=j {
        update::update(&e, problem, previous, &mut now, &z, i, &mut ())?;
    }
    Ok(now)
}

/// The log-likelihood of the step before; before the first detection there is none, and all likelihoods are one.
fn last_likelihood<T: Real>(previous: &Step<T, Dyn, Dyn>, j: usize) -> T {
    previous.log_likelihoods.get(j).cloned().unwrap_or_else(T::zero)
}

/// μⱼ by Bayes' rule from the log-likelihoods that stand in the record; undecided where a mode has none.
fn by_bayes<T: Real>(now: &Step<T, Dyn, Dyn>, j: usize) -> T {
    let (logarithms, predicted) = (&now.log_likelihoods, &now.predicted_mode_probabilities);
    if logarithms.len() < predicted.len() {
        return T::undecided();
    }
    let likelihoods: Vec<T> = (0..predicted.len())
        .map(|i| relative_likelihood(logarithms, predicted, i))
        .collect();
    mode_probability(&likelihoods[j], &predicted[j], &evidence(&likelihoods, predicted))
}

fn undecided<T: Real>(problem: &Problem<T, Dyn, Dyn>) -> DMatrix<T> {
    DMatrix::from_element(problem.n().0, problem.n().0, T::undecided())
}
