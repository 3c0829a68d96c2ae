//! The cycle around filters that have none: mixing, weighing and combining in plain nalgebra, as one writes it for one problem.

use crate::contender::{Outcome, Run};
use crate::scenario::{CHAIN, MODES, PROBABILITIES, start};
use nalgebra::{Matrix2, Matrix4, Vector2, Vector4};
use std::array::from_fn;
use std::hint::black_box;
use std::time::Instant;

/// Mean and covariance.
pub type Estimate = (Vector4<f64>, Matrix4<f64>);

/// What a mode's filter makes of a mixed estimate and a measurement: prediction, update, log-likelihood.
pub type ModeStep = (Estimate, Estimate, f64);

/// The cycle around `step`, which is given the mode, its mixed estimate, and the measurement.
pub fn around(mut step: impl FnMut(usize, &Estimate, &Vector2<f64>) -> ModeStep + 'static) -> Run {
    Box::new(move |measurements| {
        let mut estimates = [start(); MODES];
        let mut probabilities = PROBABILITIES;
        let mut combined = start();
        let begin = Instant::now();
        for z in measurements {
            let z = black_box(z);
            let predicted: [f64; MODES] = from_fn(|j| (0..MODES).map(|i| CHAIN[i][j] * probabilities[i]).sum());
            let outcomes: [ModeStep; MODES] = from_fn(|j| {
                let mixing = from_fn(|i| CHAIN[i][j] * probabilities[i] / predicted[j]);
                step(j, &merged(&mixing, &estimates), z)
            });
            black_box(merged(&predicted, &outcomes.map(|(prediction, ..)| prediction)));
            estimates = outcomes.map(|(_, update, _)| update);
            probabilities = weighed(&predicted, &outcomes.map(|(.., log_likelihood)| log_likelihood));
            combined = black_box(merged(&probabilities, &estimates));
        }
        let seconds = begin.elapsed().as_secs_f64();
        (
            seconds,
            Outcome {
                mode_probabilities: probabilities,
                mean: combined.0,
            },
        )
    })
}

/// Mean and covariance of a mixture.
fn merged(weights: &[f64; MODES], estimates: &[Estimate; MODES]) -> Estimate {
    let mean: Vector4<f64> = (0..MODES).map(|i| estimates[i].0 * weights[i]).sum();
    let covariance = (0..MODES).map(|i| {
        let deviation = estimates[i].0 - mean;
        (estimates[i].1 + deviation * deviation.transpose()) * weights[i]
    });
    (mean, covariance.sum())
}

/// The mode probabilities after a measurement.
fn weighed(predicted: &[f64; MODES], log_likelihoods: &[f64; MODES]) -> [f64; MODES] {
    let greatest = log_likelihoods.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let joint: [f64; MODES] = from_fn(|j| (log_likelihoods[j] - greatest).exp() * predicted[j]);
    let evidence: f64 = joint.iter().sum();
    joint.map(|value| value / evidence)
}

/// ln N(ν; 0, S) from νᵀ S⁻¹ ν and S.
pub fn log_density(squared_distance: f64, s: &Matrix2<f64>) -> f64 {
    let determinant = s[(0, 0)] * s[(1, 1)] - s[(0, 1)] * s[(1, 0)];
    -0.5 * (squared_distance + (std::f64::consts::TAU.powi(2) * determinant).ln())
}
