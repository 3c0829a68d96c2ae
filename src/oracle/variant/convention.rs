//! Conventions: choices that the papers leave open and that change exact values.
//!
//! A program may declare any of these values of `conventions`; none is wrong.

use super::super::setup::Setup;
use super::{drawn, draws_points, number, square_root, weights};
use crate::gaussian::log_density;
use crate::imm::{Equations, Interaction, Problem, Step};
use crate::matrix::ldl;
use crate::number::Real;
use nalgebra::{DVector, Dyn};

/// Applies a convention; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    of_any_filter(id, setup) || of_the_first_step(id, setup) || of_sustika2015(id, setup)
}

/// What sustika2015 leaves open: modes of unequal dimensions, and where R^c is evaluated.
fn of_sustika2015<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // P = Σᵢ wᵢ Eᵢ [ Pⁱ + (x̂ⁱ − x̂)(x̂ⁱ − x̂)ᵀ ] Eᵢ
        "unequal-dimensions-index-wise" => *equations = equations.clone().with_index_wise_mixing(),
        // x̂ⁱ with the entries that mode i lacks taken from mode j
        "unequal-dimensions-unbiased" => *equations = equations.clone().with_unbiased_mixing(),
        // R^c at the range and bearing of the combined prediction
        "converted-covariance-at-prediction" => {
            *equations = equations.clone().with_conversion_at_prediction();
        }
        _ => return false,
    }
    true
}

/// The square root, angles and the constant of the likelihood.
fn of_any_filter<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let points = draws_points(setup);
    let equations = &mut setup.equations;
    match id {
        // P = U Uᵀ
        "square-root-upper" => {
            if points {
                equations.mixed_points = |problem, _, now, j| drawn(problem, j, &now.mixed[j], square_root::upper);
                equations.predicted_points =
                    |problem, _, now, j| drawn(problem, j, &now.predicted[j], square_root::upper);
            }
        }
        // P = S S
        "square-root-symmetric" => {
            if points {
                equations.mixed_points = |problem, _, now, j| drawn(problem, j, &now.mixed[j], square_root::symmetric);
                equations.predicted_points =
                    |problem, _, now, j| drawn(problem, j, &now.predicted[j], square_root::symmetric);
            }
        }
        // θ̂ = atan2(Σₛ wₛ sin θₛ, Σₛ wₛ cos θₛ)
        "angle-mean-vector" => {
            if points {
                equations.predicted_measurement = |problem, previous, now, j| {
                    let usual = (Equations::standard().predicted_measurement)(problem, previous, now, j);
                    DVector::from_fn(usual.len(), |row, _| {
                        if problem.sensor.is_angle(row) {
                            mean_direction(weights(problem, j).0, &now.measured_points[j], row)
                        } else {
                            usual[row].clone()
                        }
                    })
                }
            }
        }
        // ln L + (m/2) ln 2π
        "log-likelihood-without-two-pi" => {
            equations.log_likelihood = |_, _, now, j| {
                let full = log_density(&now.innovations[j], &ldl(&now.innovation_covariances[j]));
                let two_pi = T::pi() * T::integer(2);
                full + number::<T>(now.innovations[j].len()) * T::ln(&two_pi) / T::integer(2)
            }
        }
        _ => return false,
    }
    true
}

/// What the initial estimate is.
fn of_the_first_step<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // step 1: cⱼ = μⱼ, μᵢ∣ⱼ = 1 for i = j and 0 else
        "first-step-unmixed" => leave_the_first_step_unmixed(setup),
        // and x̂⁻, P⁻ of step 1 are the initial estimates
        "first-step-predicted" => {
            equations.predicted_mean = |problem, previous, now, j| match now.step {
                1 => now.mixed[j].mean.clone(),
                _ => (Equations::standard().predicted_mean)(problem, previous, now, j),
            };
            equations.predicted_covariance = |problem, previous, now, j| match now.step {
                1 => now.mixed[j].covariance.clone(),
                _ => (Equations::standard().predicted_covariance)(problem, previous, now, j),
            };
            leave_the_first_step_unmixed(setup);
        }
        _ => return false,
    }
    true
}

/// In step 1 every mode goes on from its own initial estimate, with its own initial probability.
fn leave_the_first_step_unmixed<T: Real>(setup: &mut Setup<T>) {
    setup.equations.predicted_mode_probability = |problem, previous, now, j| match now.step {
        1 => previous.mode_probabilities[j].clone(),
        _ => (Equations::standard().predicted_mode_probability)(problem, previous, now, j),
    };
    if setup.problem.interaction != Interaction::Unmixed {
        setup.equations.mixing_probabilities = mixed_from_the_second_step;
    }
}

/// μᵢ∣ⱼ, at step 1 of modes that keep what they have.
fn mixed_from_the_second_step<T: Real>(
    problem: &Problem<T, Dyn, Dyn>,
    previous: &Step<T, Dyn, Dyn>,
    now: &Step<T, Dyn, Dyn>,
    j: usize,
) -> Vec<T> {
    if now.step > 1 {
        return (Equations::standard().mixing_probabilities)(problem, previous, now, j);
    }
    let own = |i| if i == j { T::one() } else { T::zero() };
    (0..problem.modes.len()).map(own).collect()
}

/// The direction of the weighted sum of unit vectors.
fn mean_direction<T: Real>(weights: &[T], values: &[DVector<T>], row: usize) -> T {
    let (mut y, mut x) = (T::zero(), T::zero());
    for (weight, value) in weights.iter().zip(values) {
        y += weight.clone() * T::sin(&value[row]);
        x += weight.clone() * T::cos(&value[row]);
    }
    T::atan2(&y, &x)
}
