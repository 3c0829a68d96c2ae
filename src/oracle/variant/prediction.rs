//! Variants of the prediction: the mistakes that can be made in F P Fᵀ + Q.

use super::super::setup::Setup;
use super::{draws_no_points, draws_points, motion_matrix, sum_of_covariance_weights, weights, zero_rows};
use crate::filter::{cubature, kalman, raw};
use crate::imm::Equations;
use crate::matrix::mirrored;
use crate::number::Real;

/// Applies a variant of the prediction; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    of_noise(id, setup) || of_mean(id, setup) || of_covariance(id, setup)
}

/// The process noise.
fn of_noise<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let modes = &mut setup.problem.modes;
    match id {
        "process-noise-omitted" => modes.iter_mut().for_each(|mode| mode.noise.fill(T::zero())),
        "process-noise-doubled" => {
            for mode in modes {
                mode.noise = &mode.noise + &mode.noise;
            }
        }
        "process-noise-of-the-next-mode" => {
            let mut noises: Vec<_> = modes.iter().map(|mode| mode.noise.clone()).collect();
            noises.rotate_left(1);
            for (mode, noise) in modes.iter_mut().zip(noises) {
                mode.noise = noise;
            }
        }
        "process-noise-of-the-first-mode" => {
            let first = modes[0].noise.clone();
            for mode in modes {
                mode.noise.clone_from(&first);
            }
        }
        // F (P + Q) Fᵀ
        "process-noise-before-motion" => {
            setup.equations.predicted_covariance = |problem, _, now, j| {
                let mode = &problem.modes[j];
                let covariance = &now.mixed[j].covariance + &mode.noise;
                kalman::predicted_covariance(&motion_matrix(problem, now, j), &covariance, &(&mode.noise * T::zero()))
            }
        }
        // Σₛ wₛ [ (X*ₛ − x̂⁻)(X*ₛ − x̂⁻)ᵀ + Q ], where the weights do not sum to one
        "process-noise-inside-the-sum" => {
            if draws_points(setup) {
                setup.equations.predicted_covariance = |problem, _, now, j| {
                    let (points, mean) = (&now.propagated_points[j], &now.predicted[j].mean);
                    let noise = &problem.modes[j].noise * sum_of_covariance_weights(problem, j);
                    cubature::weighted_covariance(weights(problem, j).1, points, mean, &noise)
                }
            }
        }
        _ => return false,
    }
    true
}

/// The predicted mean, and what follows from it.
fn of_mean<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // what was mixed is not used: F x̂ʲ, F Pʲ Fᵀ + Q
        "prediction-from-own-estimate" => {
            equations.predicted_mean = |problem, previous, _, j| problem.modes[j].motion.of(&previous.updated[j].mean);
            equations.predicted_covariance = |problem, previous, now, j| {
                let mode = &problem.modes[j];
                kalman::predicted_covariance(
                    &motion_matrix(problem, now, j),
                    &previous.updated[j].covariance,
                    &mode.noise,
                )
            };
        }
        // x̂⁻ = x̂⁰ʲ
        "mean-not-moved" => equations.predicted_mean = |_, _, now, j| now.mixed[j].mean.clone(),
        // x̂⁻ = F F x̂⁰ʲ
        "motion-applied-twice" => {
            equations.predicted_mean = |problem, previous, now, j| {
                let once = (Equations::standard().predicted_mean)(problem, previous, now, j);
                problem.modes[j].motion.of(&once)
            }
        }
        // Fᵢᵢ = 1 where the row i of F is zero
        "embedded-entries-kept" => {
            for mode in &mut setup.problem.modes {
                let Some(f) = mode.motion.matrix_mut() else { continue };
                let rows: Vec<usize> = zero_rows(f).collect();
                for row in rows {
                    f[(row, row)] = T::one();
                }
            }
        }
        "motion-of-the-next-mode" => rotate_motions(setup),
        "motion-of-the-first-mode" => {
            let first = setup.problem.modes[0].motion.clone();
            for mode in &mut setup.problem.modes {
                mode.motion.clone_from(&first);
            }
        }
        _ => return false,
    }
    true
}

/// The predicted covariance.
fn of_covariance<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let (points, no_points) = (draws_points(setup), draws_no_points(setup));
    let entry = &mut setup.equations.predicted_covariance;
    match id {
        // P⁻ = Fᵀ P F + Q
        "prediction-transposed" => {
            if no_points {
                *entry = |problem, _, now, j| {
                    let mode = &problem.modes[j];
                    let transposed = motion_matrix(problem, now, j).transpose();
                    kalman::predicted_covariance(&transposed, &now.mixed[j].covariance, &mode.noise)
                }
            }
        }
        // P⁻ = P⁰ + Q
        "covariance-not-moved" => {
            *entry = |problem, _, now, j| mirrored(&now.mixed[j].covariance + &problem.modes[j].noise);
        }
        // P⁻ = F P⁰ + Q
        "motion-on-one-side" => {
            *entry = |problem, _, now, j| {
                let mode = &problem.modes[j];
                mirrored(&*motion_matrix(problem, now, j) * &now.mixed[j].covariance + &mode.noise)
            }
        }
        // zhu2016 (24) as printed: Σₛ wₛ X*ₛ X*ₛᵀ
        "raw-predicted-covariance" => {
            if points {
                *entry = |problem, _, now, j| raw::raw_second_moment(weights(problem, j).1, &now.propagated_points[j]);
            }
        }
        // the points' deviations from the centre x̂⁰ʲ that was not moved
        "prediction-spread-about-mixed-mean" => {
            if points {
                *entry = |problem, _, now, j| {
                    let (points, mean) = (&now.propagated_points[j], &now.mixed[j].mean);
                    cubature::weighted_covariance(weights(problem, j).1, points, mean, &problem.modes[j].noise)
                }
            }
        }
        // F P Fᵀ + Q of the combined P, while the means are the modes' own
        "prediction-of-combined-covariance" => {
            *entry = |problem, previous, now, j| {
                let mode = &problem.modes[j];
                kalman::predicted_covariance(
                    &motion_matrix(problem, now, j),
                    &previous.combined.covariance,
                    &mode.noise,
                )
            }
        }
        _ => return false,
    }
    true
}

/// Mode j moves as mode j + 1 does, the last as the first.
fn rotate_motions<T: Real>(setup: &mut Setup<T>) {
    let modes = &mut setup.problem.modes;
    let mut motions: Vec<_> = modes.iter().map(|mode| mode.motion.clone()).collect();
    motions.rotate_left(1);
    for (mode, motion) in modes.iter_mut().zip(motions) {
        mode.motion = motion;
    }
}
