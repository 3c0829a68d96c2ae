//! Filters with fixed gains, and the scenario of derbez2000 from which they come.
//!
//! Gains and innovation covariances are inputs. Some problems are generic, with short gains near the equilibrium of each mode's F, Q, H
//! and R. Others are runs along one coordinate of a target, with the gains of the closed forms. Nothing reads Q and R there; the same runs
//! with Kalman filters do.

use super::draft::{Draft, covariance, estimate, filter, mode, rounded, rounded_to, rows};
use super::numbers::rounded_rows;
use super::scene::{PLANE_TRACK, axis, plane};
use immaculate::model::acceleration::{
    acceleration_response, constant_acceleration, embedded_constant_velocity, embedded_velocity_response,
    position_matrix, response_noise,
};
use immaculate::oracle::problem::{FilterFile, FixedGainFile, ProblemFile, Rows, UNMIXED};
use immaculate::paper::monte_carlo::Generator;
use immaculate::steady::gains::{
    alpha_beta_gain, alpha_beta_gamma_gain, alpha_beta_gamma_root, alpha_beta_root, innovation_variance, tracking_index,
};

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    [single_steps(), several(), derbez2000()].concat()
}

pub(super) const MIXED: &str = "mixed";

/// A gain and an innovation covariance.
fn given(gain: Rows, innovation_covariance: Rows) -> FixedGainFile {
    FixedGainFile {
        gain,
        innovation_covariance,
    }
}

/// The same problem for filters with fixed gains, whose estimates have no covariance.
fn with_gains(draft: Draft, mixing: &str, modes: Vec<FixedGainFile>) -> Draft {
    let filter = FilterFile::FixedGain {
        mixing: mixing.to_owned(),
        modes,
    };
    draft.filter(filter).with(|problem| {
        for estimate in &mut problem.initial.modes {
            estimate.covariance = None;
        }
    })
}

/// The plane with fixed gains.
pub fn plane_with_gains(mixing: &str) -> Draft {
    let modes = vec![
        given(
            rows([[0.414, 0.02], [0.062, 0.003], [-0.096, 0.425], [-0.014, 0.09]]),
            rows([[212.0, 36.0], [36.0, 152.0]]),
        ),
        given(
            rows([[0.316, 0.1], [0.181, -0.013], [-0.077, 0.586], [0.009, 0.158]]),
            rows([[316.0, 55.0], [55.0, 283.0]]),
        ),
        given(
            rows([[0.486, 0.042], [0.052, 0.029], [-0.109, 0.306], [-0.069, 0.184]]),
            rows([[262.0, -34.0], [-34.0, 183.0]]),
        ),
    ];
    with_gains(plane(), mixing, modes)
}

/// The line with fixed gains.
fn axis_with_gains(mixing: &str) -> Draft {
    let modes = [(0.41, 0.08, 36.6), (0.388, 0.033, 34.7), (0.527, 0.205, 48.6)];
    let modes = modes.map(|(position, velocity, s)| given(rows([[position], [velocity]]), rows([[s]])));
    with_gains(axis(), mixing, modes.to_vec())
}

fn single_steps() -> Vec<ProblemFile> {
    let flags = [
        "single-step",
        "fixed-gain",
        "transition-order",
        "spread",
        "full-correlation",
    ];
    vec![
        plane_with_gains(MIXED).named(
            "step.fixed-gain",
            &[&flags[..], &["row-order"]].concat(),
            "One step of three filters of four entries with two measured numbers, whose gains and innovation covariances are given: those of \
             another mode, or a gain read by columns, show here. There are no covariances.",
        ),
        axis_with_gains(UNMIXED).named(
            "step.fixed-gain-unmixed",
            &flags,
            "One step of three filters of position and velocity with fixed gains, each from its own estimate: the probabilities follow the \
             chain, and the combined mean is all that the modes share.",
        ),
    ]
}

fn several() -> Vec<ProblemFile> {
    let flags = [
        "sequence",
        "fixed-gain",
        "transition-order",
        "spread",
        "full-correlation",
    ];
    vec![
        plane_with_gains(MIXED).sees(&PLANE_TRACK).named(
            "steps.fixed-gain",
            &flags,
            "Six steps of three filters with fixed gains whose estimates are mixed: derbez2000's update within the usual cycle. Modes that \
             stand alone, the other reading, show from the first step on.",
        ),
        plane_with_gains(UNMIXED).sees(&PLANE_TRACK).named(
            "steps.fixed-gain-unmixed",
            &flags,
            "The measurements of steps.fixed-gain and its gains, but each mode goes on from its own estimate, as derbez2000's update is \
             printed: no mode's estimate depends on the others, and only the combined mean does.",
        ),
        axis_with_gains(MIXED)
            .sees(&[[54.0], [49.5], [58.2], [66.1]])
            .without(&[2])
            .named(
                "missed.fixed-gain",
                &["sequence", "fixed-gain", "missed-detection", "transition-order", "spread", "full-correlation"],
                "The second of four steps has no detection: a gain that never changes is not used there, and neither is the innovation \
                 covariance.",
            ),
        with_gains(
            axis().keep(&[2]),
            MIXED,
            vec![given(rows([[0.527], [0.205]]), rows([[48.6]]))],
        )
        .sees(&[[54.0], [49.5], [58.2], [66.1]])
        .named(
            "steps.one-mode.fixed-gain",
            &["sequence", "fixed-gain", "one-mode", "full-correlation"],
            "Four steps of one mode: a filter with a fixed gain by itself, whatever the reading.",
        ),
        Coordinate {
            interval: 1.0,
            noise: 2.0,
            accelerations: [0.5, 8.0],
            starts: [[100.0, 8.0, 1.5], [97.0, 11.0, -2.5]],
        }
        .with_gains(MIXED)
        .chain(rows([[0.9, 0.1], [0.25, 0.75]]), &[0.6, 0.4])
        .sees(&[[111.5], [118.2], [137.0], [159.4], [178.9]])
        .named(
            "steps.fixed-gain.embedded",
            &["sequence", "fixed-gain", "embedded", "transition-order", "spread", "singular-noise", "zeros"],
            "Constant velocity and constant acceleration of one coordinate under unequal noises, in one state of three entries: constant \
             velocity sets the acceleration to zero, and gets one from the other mode by mixing. A motion that keeps it shows here.",
        ),
    ]
}

/// One coordinate of a target, as derbez2000 tracks it: constant velocity embedded in three entries, and constant acceleration.
struct Coordinate {
    /// t, s.
    interval: f64,
    /// R, m².
    noise: f64,
    /// q of constant velocity and of constant acceleration, (m/s²)².
    accelerations: [f64; 2],
    /// The estimates at step 0.
    starts: [[f64; 3]; 2],
}

impl Coordinate {
    /// The problem for Kalman filters, without chain and measurements.
    fn draft(&self) -> Draft {
        let (t, [velocity, acceleration]) = (&self.interval, &self.accelerations);
        let unit = || covariance(&[1.0, 1.0, 1.0], &[0.0, 0.0, 0.0]);
        let still = mode(
            "constant velocity",
            rounded_rows(&embedded_constant_velocity(t)),
            rounded_rows(&response_noise(&embedded_velocity_response(t), velocity)),
        );
        let driven = mode(
            "constant acceleration",
            rounded_rows(&constant_acceleration(t)),
            rounded_rows(&response_noise(&acceleration_response(t), acceleration)),
        );
        let parts = vec![
            (still, estimate(&self.starts[0], unit())),
            (driven, estimate(&self.starts[1], unit())),
        ];
        Draft::new(&["p", "v", "a"], &["m", "m/s", "m/s^2"], parts)
            .linear(rounded_rows(&position_matrix()), rows([[self.noise]]))
            .chain(rows([[0.95, 0.05], [0.05, 0.95]]), &[0.5, 0.5])
    }

    /// The same for filters with the steady gains of the noises.
    fn with_gains(&self, mixing: &str) -> Draft {
        let (t, r) = (&self.interval, &self.noise);
        let index = self.accelerations.map(|q| tracking_index(&q, r, t));
        let roots = [alpha_beta_root(&index[0]), alpha_beta_gamma_root(&index[1])];
        let gains = [alpha_beta_gain(&roots[0], t), alpha_beta_gamma_gain(&roots[1], t)];
        let modes = gains.iter().zip(&roots).map(|(gain, root)| {
            let s = rounded(innovation_variance(root, r));
            given(rounded_rows(gain), rows([[s]]))
        });
        with_gains(self.draft(), mixing, modes.collect())
    }
}

/// The seed of the measurements' noise.
const SEED: u64 = 2000;
/// Significant digits of a measurement.
const MEASURED_DIGITS: usize = 9;
/// The target's acceleration, m/s², in the steps 15 to 26; else it has none.
const ACCELERATION: f64 = 6.0;

/// Forty measured positions of a target that starts as told, goes straight on, accelerates and goes straight on.
fn measured(interval: f64, noise: f64, [mut position, mut velocity, _]: [f64; 3]) -> Vec<[f64; 1]> {
    let mut generator = Generator::new(SEED, 1);
    let step = |k: usize| {
        let acceleration = if (15..=26).contains(&k) { ACCELERATION } else { 0.0 };
        position += velocity * interval + acceleration * interval * interval / 2.0;
        velocity += acceleration * interval;
        let error = noise.sqrt() * generator.standard_normal();
        [rounded_to(position + error, MEASURED_DIGITS)]
    };
    (1..=40).map(step).collect()
}

fn derbez2000() -> Vec<ProblemFile> {
    // Of derbez2000: t, R, and equal noises of both plants; the state at step 0 is known exactly.
    let start = [500.0, -18.0, 0.0];
    let coordinate = Coordinate {
        interval: 2.0,
        noise: 0.05,
        accelerations: [5.0, 5.0],
        starts: [start; 2],
    };
    let seen = measured(coordinate.interval, coordinate.noise, start);
    let flags = ["published-scenario", "run", "singular-noise", "zeros"];
    let of_two = [&flags[..], &["embedded"]].concat();
    let fixed = [&of_two[..], &["fixed-gain"]].concat();
    vec![
        coordinate.draft().sees(&seen).named(
            "derbez2000.kalman.run",
            &of_two,
            "Forty steps of one coordinate of derbez2000's scenario, straight on, accelerated and straight on, with the Kalman filters of its \
             full IMM. Constant velocity has no acceleration: its predicted covariance is singular, and needs no inverse.",
        ),
        coordinate.draft().keep(&[1]).filter(filter("kalman")).sees(&seen).named(
            "derbez2000.kalman.acceleration",
            &[&flags[..], &["one-mode"]].concat(),
            "The measurements of derbez2000.kalman.run with the constant acceleration Kalman filter alone, which the paper compares with.",
        ),
        coordinate.with_gains(MIXED).sees(&seen).named(
            "derbez2000.fixed-gain.mixed",
            &fixed,
            "The measurements of derbez2000.kalman.run with the steady gains of both noises, within the usual cycle with mixed states.",
        ),
        coordinate.with_gains(UNMIXED).sees(&seen).named(
            "derbez2000.fixed-gain.unmixed",
            &fixed,
            "The measurements of derbez2000.kalman.run with the steady gains of both noises, each mode from its own estimate, as the \
             paper's update is printed.",
        ),
    ]
}
