//! Variants of a step without a detection.
//!
//! After this file the reader knows what programs do when there is nothing to update with.

use super::super::setup::Setup;
use crate::gaussian::log_density;
use crate::imm::probability::{evidence, mode_probability, relative_likelihood};
use crate::imm::{Equations, Problem, Step};
use crate::matrix::{NotPositiveDefinite, ldl};
use crate::number::Real;
use nalgebra::{SMatrix, SVector};

/// Applies a variant of a step without a detection; whether it is one.
pub(super) fn apply<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    of_measurement(id, setup) || of_estimate(id, setup) || of_probability(id, setup)
}

/// A measurement is put where there is none.
fn of_measurement<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    match id {
        "missed-detection-as-zero" => {
            for measurement in &mut setup.measurements {
                measurement.get_or_insert_with(SVector::zeros);
            }
        }
        "missed-detection-as-the-last-measurement" => {
            for k in 1..setup.measurements.len() {
                if setup.measurements[k].is_none() {
                    setup.measurements[k] = setup.measurements[k - 1].clone();
                }
            }
        }
        _ => return false,
    }
    true
}

/// The estimates.
fn of_estimate<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // ν = 0, and everything else as with a detection
        "missed-detection-as-zero-innovation" => {
            equations.undetected_covariance = |problem, previous, now, j| {
                let found = detected(problem, previous, now, j);
                found.map_or_else(|_| undecided(), |found| found.updated[j].covariance.clone())
            };
            equations.undetected_log_likelihood = |problem, previous, now, j| {
                let found = detected(problem, previous, now, j);
                found.map_or_else(
                    |_| T::undecided(),
                    |found| log_density(&SVector::zeros(), &ldl(&found.innovation_covariances[j])),
                )
            };
            equations.undetected_mode_probability = |_, _, now, j| by_bayes(now, j);
        }
        // ν = 0 for the covariance alone
        "missed-detection-updates-the-covariance" => {
            equations.undetected_covariance = |problem, previous, now, j| {
                let found = detected(problem, previous, now, j);
                found.map_or_else(|_| undecided(), |found| found.updated[j].covariance.clone())
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
fn of_probability<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // μⱼ of step k−1
        "probabilities-not-advanced" => {
            equations.undetected_mode_probability = |_, previous, _, j| previous.mode_probabilities[j].clone();
        }
        // N(0; 0, S) with the S of the last detection
        "last-covariance-used-again" => {
            equations.undetected_log_likelihood = |_, previous, _, j| match previous.measurement {
                Some(_) => log_density(&SVector::zeros(), &ldl(&previous.innovation_covariances[j])),
                None => previous.log_likelihoods[j].clone(),
            };
            equations.undetected_mode_probability = |_, _, now, j| by_bayes(now, j);
        }
        // Lⱼ of the last detection; before the first there is none, and all are one
        "last-likelihood-used-again" => {
            equations.undetected_log_likelihood = |_, previous, _, j| previous.log_likelihoods[j].clone();
            equations.undetected_mode_probability = |_, _, now, j| by_bayes(now, j);
        }
        _ => return false,
    }
    true
}

/// The step with values of mode j as if the predicted measurement had been measured.
fn detected<T: Real, const N: usize, const M: usize>(
    problem: &Problem<T, N, M>,
    previous: &Step<T, N, M>,
    now: &Step<T, N, M>,
    j: usize,
) -> Result<Step<T, N, M>, NotPositiveDefinite> {
    let (e, mut now) = (Equations::standard(problem), now.clone());
    if e.draws_points {
        now.predicted_square_roots[j] = (e.predicted_square_root)(problem, previous, &now, j)?;
        for s in 0..now.predicted_points[j].len() {
            now.predicted_points[j][s] = (e.predicted_point)(problem, previous, &now, j, s);
            now.measured_points[j][s] = (e.measured_point)(problem, previous, &now, j, s);
        }
    }
    if e.converts {
        // R^c where the prediction is: there is nothing else.
        now.converted_covariance = (Equations::converted_at_prediction().converted_covariance)(problem, previous, &now);
    }
    now.predicted_measurements[j] = (e.predicted_measurement)(problem, previous, &now, j);
    now.innovation_covariances[j] = (e.innovation_covariance)(problem, previous, &now, j);
    now.cross_covariances[j] = (e.cross_covariance)(problem, previous, &now, j);
    now.gains[j] = (e.gain)(problem, previous, &now, j)?;
    now.updated[j].covariance = (e.updated_covariance)(problem, previous, &now, j);
    Ok(now)
}

/// μⱼ by Bayes' rule from the log-likelihoods that stand in the record.
fn by_bayes<T: Real, const N: usize, const M: usize>(now: &Step<T, N, M>, j: usize) -> T {
    let (logarithms, predicted) = (&now.log_likelihoods, &now.predicted_mode_probabilities);
    let likelihoods: Vec<T> = (0..predicted.len())
        .map(|i| relative_likelihood(logarithms, predicted, i))
        .collect();
    mode_probability(&likelihoods[j], &predicted[j], &evidence(&likelihoods, predicted))
}

fn undecided<T: Real, const N: usize>() -> SMatrix<T, N, N> {
    SMatrix::from_fn(|_, _| T::undecided())
}
