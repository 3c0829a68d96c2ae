//! Variants of the predicted measurement, the innovation and their covariances.
//!
//! After this file the reader knows how R is lost or counted twice, and which points and means are taken for others.

use super::super::setup::Setup;
use super::{draws_points, noise, sum_of_covariance_weights, used, weights};
use crate::filter::{cubature, kalman};
use crate::imm::{Equations, Problem, Step};
use crate::number::Real;
use nalgebra::{SMatrix, SVector};

/// Applies a variant of the measurement; whether it is one.
pub(super) fn apply<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    of_predicted_measurement(id, setup) || of_innovation_covariance(id, setup) || of_cross_covariance(id, setup)
}

/// The predicted measurement and the innovation.
fn of_predicted_measurement<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // ẑ = h(x̂⁻)
        "measurement-of-the-mean" => {
            equations.predicted_measurement = |problem, _, now, j| problem.measurement.of(&now.predicted[j].mean);
        }
        // ẑ = h(x̂⁰ʲ)
        "measurement-of-the-mixed-mean" => {
            equations.predicted_measurement = |problem, _, now, j| problem.measurement.of(&now.mixed[j].mean);
        }
        // ẑ = h(x̂⁻ of all modes)
        "measurement-of-the-combined-prediction" => {
            equations.predicted_measurement =
                |problem, _, now, _| problem.measurement.of(&now.combined_prediction.mean);
        }
        // ν = ẑ − z
        "innovation-reversed" => {
            equations.innovation = |problem, _, now, j| match used(problem, now) {
                Some(z) => problem.measurement.difference(&now.predicted_measurements[j], z),
                None => SVector::from_fn(|_, _| T::undecided()),
            }
        }
        _ => return false,
    }
    true
}

/// The innovation covariance.
fn of_innovation_covariance<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    let points = draws_points(setup);
    let equations = &mut setup.equations;
    match id {
        "measurement-noise-omitted" => {
            equations.innovation_covariance =
                |problem, previous, now, j| with_noise(problem, previous, now, j, SMatrix::zeros());
        }
        "measurement-noise-doubled" => {
            equations.innovation_covariance = |problem, previous, now, j| {
                let noise = noise(problem, now) + noise(problem, now);
                with_noise(problem, previous, now, j, noise)
            }
        }
        // Σₛ wₛ [ (Zₛ − ẑ)(Zₛ − ẑ)ᵀ + R ], where the weights do not sum to one
        "measurement-noise-inside-the-sum" => {
            if points {
                equations.innovation_covariance = |problem, previous, now, j| {
                    let noise = noise(problem, now) * sum_of_covariance_weights(problem);
                    with_noise(problem, previous, now, j, noise)
                }
            }
        }
        // S = H P⁰ʲ Hᵀ + R, C = P⁰ʲ Hᵀ
        "measured-before-the-prediction" => {
            if !points {
                equations.innovation_covariance = |problem, _, now, j| {
                    let h = problem.measurement.matrix();
                    kalman::innovation_covariance(&h, &now.mixed[j].covariance, noise(problem, now))
                };
                equations.cross_covariance = |problem, _, now, j| {
                    kalman::cross_covariance(&now.mixed[j].covariance, &problem.measurement.matrix())
                };
            }
        }
        _ => return false,
    }
    true
}

/// The cross-covariance.
fn of_cross_covariance<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    let points = draws_points(setup);
    let equations = &mut setup.equations;
    match id {
        // C = Σₛ wₛ (X*ₛ − x̂⁻)(Zₛ − ẑ)ᵀ
        "cross-covariance-of-propagated-points" => {
            if points {
                equations.cross_covariance = |problem, _, now, j| {
                    cubature::cross_covariance(
                        &problem.measurement,
                        weights(problem).1,
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
            if !points {
                equations.cross_covariance = |problem, _, now, j| {
                    kalman::cross_covariance(&now.mixed[j].covariance, &problem.measurement.matrix())
                }
            }
        }
        _ => return false,
    }
    true
}

/// The innovation covariance with another noise.
fn with_noise<T: Real, const N: usize, const M: usize>(
    problem: &Problem<T, N, M>,
    previous: &Step<T, N, M>,
    now: &Step<T, N, M>,
    j: usize,
    noise: SMatrix<T, M, M>,
) -> SMatrix<T, M, M> {
    let equations = Equations::standard(problem);
    if equations.converts {
        let other = Step {
            converted_covariance: noise,
            ..now.clone()
        };
        return (equations.innovation_covariance)(problem, previous, &other, j);
    }
    let other = Problem {
        measurement_noise: noise,
        ..problem.clone()
    };
    (equations.innovation_covariance)(&other, previous, now, j)
}
