//! Variants of the predicted measurement, the innovation and their covariances.
//!
//! R can be lost or counted twice, and the wrong points or means can be used.

use super::super::setup::Setup;
use super::{
    difference, draws_no_points, draws_points, has_correlated_noises, measurement_matrix, noise, seen,
    sum_of_covariance_weights, used, weights,
};
use crate::filter::{cubature, kalman};
use crate::imm::{Equations, Problem, Step};
use crate::number::Real;
use nalgebra::{DMatrix, Dyn};

/// Applies a variant of the measurement; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    of_predicted_measurement(id, setup)
        || of_innovation_covariance(id, setup)
        || of_cross_covariance(id, setup)
        || of_correlated_noises(id, setup)
}

/// The predicted measurement and the innovation.
fn of_predicted_measurement<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let points = draws_points(setup);
    let equations = &mut setup.equations;
    match id {
        // ẑ = h(x̂⁻)
        "measurement-of-the-mean" => {
            if points {
                equations.predicted_measurement = |problem, _, now, j| seen(problem, &now.predicted[j].mean, j);
            }
        }
        // ẑ = h(x̂⁰ʲ)
        "measurement-of-the-mixed-mean" => {
            equations.predicted_measurement = |problem, _, now, j| seen(problem, &now.mixed[j].mean, j);
        }
        // ẑ = h(x̂⁻ of all modes)
        "measurement-of-the-combined-prediction" => {
            equations.predicted_measurement = |problem, _, now, j| seen(problem, &now.combined_prediction.mean, j);
        }
        // ν = ẑ − z
        "innovation-reversed" => {
            equations.innovation =
                |problem, z, now, j| difference(problem, &now.predicted_measurements[j], used(problem, z, now, j), j);
        }
        _ => return false,
    }
    true
}

/// The innovation covariance.
fn of_innovation_covariance<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let (points, no_points) = (draws_points(setup), draws_no_points(setup));
    let equations = &mut setup.equations;
    match id {
        "measurement-noise-omitted" => {
            equations.innovation_covariance = |problem, previous, now, j| {
                let none = noise(problem, now, j) * T::zero();
                with_noise(problem, previous, now, j, none)
            }
        }
        "measurement-noise-doubled" => {
            equations.innovation_covariance = |problem, previous, now, j| {
                let noise = noise(problem, now, j) + noise(problem, now, j);
                with_noise(problem, previous, now, j, noise)
            }
        }
        // Σₛ wₛ [ (Zₛ − ẑ)(Zₛ − ẑ)ᵀ + R ], where the weights do not sum to one
        "measurement-noise-inside-the-sum" => {
            if points {
                equations.innovation_covariance = |problem, previous, now, j| {
                    let noise = noise(problem, now, j) * sum_of_covariance_weights(problem, j);
                    with_noise(problem, previous, now, j, noise)
                }
            }
        }
        // S = H P⁰ʲ Hᵀ + R, C = P⁰ʲ Hᵀ
        "measured-before-the-prediction" => {
            if no_points {
                equations.innovation_covariance = |problem, _, now, j| {
                    let h = measurement_matrix(problem, now, j);
                    kalman::innovation_covariance(&h, &now.mixed[j].covariance, noise(problem, now, j))
                };
                equations.cross_covariance = |problem, _, now, j| {
                    kalman::cross_covariance(&now.mixed[j].covariance, &measurement_matrix(problem, now, j))
                };
            }
        }
        _ => return false,
    }
    true
}

/// The cross-covariance.
fn of_cross_covariance<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let (points, no_points) = (draws_points(setup), draws_no_points(setup));
    let equations = &mut setup.equations;
    match id {
        // C = Σₛ wₛ (X*ₛ − x̂⁻)(Zₛ − ẑ)ᵀ
        "cross-covariance-of-propagated-points" => {
            if points {
                equations.cross_covariance = |problem, _, now, j| {
                    cubature::cross_covariance(
                        &problem.sensor,
                        weights(problem, j).1,
                        &now.propagated_points[j],
                        &now.predicted[j].mean,
                        &now.measured_points[j],
                        &now.predicted_measurements[j],
                    )
                }
            }
        }
        // C = P⁰ʲ Hᵀ
        "cross-covariance-of-mixed-covariance" => {
            if no_points {
                equations.cross_covariance = |problem, _, now, j| {
                    kalman::cross_covariance(&now.mixed[j].covariance, &measurement_matrix(problem, now, j))
                };
            }
        }
        _ => return false,
    }
    true
}

/// What process and measurement noise have in common.
fn of_correlated_noises<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let is_correlated = has_correlated_noises(setup);
    let equations = &mut setup.equations;
    // S = H P⁻ Hᵀ + R, C = P⁻ Hᵀ
    let (in_innovation, in_gain) = match id {
        "noise-correlation-omitted-in-the-innovation" => (true, false),
        "noise-correlation-omitted-in-the-gain" => (false, true),
        "noise-correlation-omitted" => (true, true),
        _ => return false,
    };
    if is_correlated && in_innovation {
        equations.innovation_covariance = |problem, _, now, j| {
            let h = measurement_matrix(problem, now, j);
            kalman::innovation_covariance(&h, &now.predicted[j].covariance, noise(problem, now, j))
        };
    }
    if is_correlated && in_gain {
        equations.cross_covariance = |problem, _, now, j| {
            kalman::cross_covariance(&now.predicted[j].covariance, &measurement_matrix(problem, now, j))
        };
    }
    true
}

/// The innovation covariance with another noise.
fn with_noise<T: Real>(
    problem: &Problem<T, Dyn, Dyn>,
    previous: &Step<T, Dyn, Dyn>,
    now: &Step<T, Dyn, Dyn>,
    j: usize,
    noise: DMatrix<T>,
) -> DMatrix<T> {
    let equation = Equations::standard().innovation_covariance;
    if problem.conversion().is_some() {
        let other = Step {
            converted_covariance: Some(noise),
            ..now.clone()
        };
        return equation(problem, previous, &other, j);
    }
    let other = Problem {
        measurement_noise: noise,
        ..problem.clone()
    };
    equation(&other, previous, now, j)
}
