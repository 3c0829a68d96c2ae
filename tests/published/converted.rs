//! Converted measurements, and modes of unequal dimensions, with the models of sustika2015.
//!
//! In some problems range and bearing become a position before a filter uses them. In others constant velocity and constant acceleration
//! share one state, above all across ±π, where a converted measurement needs no wrapping but an unscented filter does.

use super::draft::{Draft, covariance, estimate, mode, rounded_to, rows, unscented};
use super::numbers::rounded_rows;
use super::scene::{RADAR_TRACK, SENSOR, radar};
use immaculate::model::Conversion;
use immaculate::model::angle::wrap;
use immaculate::model::wiener::{
    acceleration_noise_in_the_plane, constant_acceleration_in_the_plane, constant_velocity_in_the_plane,
    velocity_noise_in_the_plane,
};
use immaculate::number::Real;
use immaculate::oracle::problem::{FilterFile, MeasurementFile, ProblemFile};
use immaculate::paper::monte_carlo::Generator;
use nalgebra::{Matrix6, Vector6};

/// The seed of the draws, and how many digits of them are kept.
const SEED: u64 = 2015;
const DIGITS: usize = 9;

/// Of sustika2015: T, s; q, m²/s³ and m²/s⁵; σ_r, m; σ_θ, 1°.
const INTERVAL: f64 = 1.0;
const DENSITY: f64 = 0.1;
const RANGE_DEVIATION: f64 = 10.0;
const BEARING_DEVIATION: f64 = std::f64::consts::PI / 180.0;

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    [generic(), special(), unequal(), sustika2015()].concat()
}

/// A filter of a conversion.
pub fn conversion(conversion: Conversion) -> FilterFile {
    FilterFile::Converted {
        conversion: conversion.name().to_owned(),
    }
}

/// The radar, whose measurements are converted; with noise of these deviations.
pub fn converted(kind: Conversion, deviations: [f64; 2]) -> Draft {
    radar("cubature-3")
        .polar(&["range", "bearing"], [0, 2], SENSOR, covariance(&deviations, &[0.0]))
        .filter(conversion(kind))
        .with(|problem| problem.conventions.converted_covariance = Some("at-measurement".into()))
}

fn generic() -> Vec<ProblemFile> {
    let step = ["single-step", "converted", "transition-order", "spread", "zeros"];
    let sequence = ["sequence", "converted", "spread", "zeros"];
    let debiased = |kind: Conversion, id: &str, how: &str| {
        let about = format!(
            "Six steps of three filters with converted measurements, {how}. The noise of the bearing is 0.3 rad, so that the conversions are \
             far apart."
        );
        converted(kind, [9.0, 0.3])
            .sees(&RADAR_TRACK)
            .named(id, &sequence, &about)
    };
    vec![
        converted(Conversion::Standard, [9.0, 0.055]).named(
            "converted.generic",
            &step,
            "One step of three filters of four entries whose range and bearing are converted to a position, with the covariance of the \
             first-order expansion: axes, signs and the turning of the noise show here.",
        ),
        converted(Conversion::Standard, [9.0, 0.055])
            .sees(&RADAR_TRACK)
            .named(
                "converted.several",
                &sequence,
                "Six steps of the filters of converted.generic.",
            ),
        debiased(
            Conversion::Additive,
            "converted.additive",
            "debiased by what the bias is on the average over the truth",
        ),
        debiased(
            Conversion::Multiplicative,
            "converted.multiplicative",
            "multiplied by e^(σ²/2) so that the position has no bias given the truth",
        ),
        debiased(
            Conversion::ModifiedUnbiased,
            "converted.modified-unbiased",
            "with the moments of the position given what was measured",
        ),
    ]
}

fn special() -> Vec<ProblemFile> {
    let flags = ["sequence", "converted", "zeros"];
    let with = |more: &[&'static str]| [&flags[..], more].concat();
    // West of the sensor on its way south.
    let means = [
        [-190.0, -3.0, 45.0, -14.0],
        [-181.0, -5.4, 37.0, -11.5],
        [-198.5, -1.3, 54.0, -15.8],
    ];
    let west = converted(Conversion::Standard, [9.0, 0.055]).with(|problem| {
        for (estimate, mean) in problem.initial.modes.iter_mut().zip(means) {
            estimate.mean = mean.to_vec();
        }
    });
    let turned = |draft: Draft| {
        draft.with(|problem| {
            if let MeasurementFile::RangeBearing { components, .. } = &mut problem.measurement {
                components.reverse();
            }
            problem.noise = covariance(&[0.055, 9.0], &[0.0]);
            for z in problem.measurements.iter_mut().filter_map(|entry| entry.z.as_mut()) {
                z.reverse();
            }
        })
    };
    vec![
        west.sees(&[[163.0, -3.05], [160.0, 3.1], [151.0, -2.88], [164.0, 3.48]])
            .named(
                "converted.across-pi",
                &with(&[]),
                "The bearing goes to and fro across ±π, and once it is given as more than π: a converted measurement has no angle \
                 left to wrap, and whoever wraps or unwraps something changes it.",
            ),
        turned(converted(Conversion::Standard, [9.0, 0.055]).sees(&RADAR_TRACK)).named(
            "converted.components",
            &with(&["components"]),
            "The measurements of converted.several, the bearing before the range.",
        ),
        converted(Conversion::Standard, [9.0, 0.055])
            .sees(&RADAR_TRACK)
            .without(&[2, 5])
            .named(
                "converted.missed",
                &with(&["missed-detection"]),
                "The measurements of converted.several, two of them missing: nothing is converted there, and no covariance either.",
            ),
        at_the_sensor(),
    ]
}

/// The target passes over the sensor.
fn at_the_sensor() -> ProblemFile {
    converted(Conversion::ModifiedUnbiased, [9.0, 0.055])
            .with(|problem| {
                for estimate in &mut problem.initial.modes {
                    estimate.mean[0] -= 155.0;
                    estimate.mean[2] += 90.0;
                }
            })
            .sees(&[[12.0, -0.9], [0.0, 2.1], [6.5, 2.9]])
            .named(
                "converted.at-the-sensor",
                &["sequence", "converted", "zeros", "curved"],
                "The target passes over the sensor. A range of zero is measured: the position is the sensor's, and what is left of its \
                 covariance comes from the noise of the range.",
            )
}

/// Constant velocity and constant acceleration in the state of the larger: [x, y, ẋ, ẏ, ẍ, ÿ].
fn two_motions(starts: [&[f64]; 2], covariances: [Vec<Vec<f64>>; 2]) -> Draft {
    let motions = [
        (
            "constant velocity",
            constant_velocity_in_the_plane(&INTERVAL),
            velocity_noise_in_the_plane(&DENSITY, &INTERVAL),
        ),
        (
            "constant acceleration",
            constant_acceleration_in_the_plane(&INTERVAL),
            acceleration_noise_in_the_plane(&DENSITY, &INTERVAL),
        ),
    ];
    let estimates = starts.iter().zip(covariances);
    let parts = motions.iter().zip(estimates);
    let parts = parts.map(|((name, transition, noise), (mean, covariance))| {
        let noise: Matrix6<f64> = noise.map(|entry| rounded_to(entry, DIGITS));
        (
            mode(name, rounded_rows(transition), rounded_rows(&noise)),
            estimate(mean, covariance),
        )
    });
    let variances = [RANGE_DEVIATION, BEARING_DEVIATION].map(|deviation| rounded_to(deviation * deviation, DIGITS));
    Draft::new(
        &["x", "y", "vx", "vy", "ax", "ay"],
        &["m", "m", "m/s", "m/s", "m/s^2", "m/s^2"],
        parts.collect(),
    )
    .polar(
        &["range", "bearing"],
        [0, 1],
        [0.0, 0.0],
        rows([[variances[0], 0.0], [0.0, variances[1]]]),
    )
    .chain(rows([[0.95, 0.05], [0.05, 0.95]]), &[0.9, 0.1])
    .with(|problem| problem.conventions.unequal_dimensions = Some("embedded".into()))
}

/// The converting filter of the paper.
fn converting(draft: Draft) -> Draft {
    draft
        .filter(conversion(Conversion::Standard))
        .with(|problem| problem.conventions.converted_covariance = Some("at-measurement".into()))
}

/// The unscented filter of the paper in six entries, κ = 3 − n: on the four of constant velocity its points are those of four.
fn with_points(draft: Draft) -> Draft {
    draft.filter(unscented(1.0, 0.0, -3.0))
}

fn unequal() -> Vec<ProblemFile> {
    // A full covariance of the six entries; of the first four alone where there are no others.
    let of_six = covariance(
        &[14.0, 11.0, 3.0, 4.0, 0.8, 0.7],
        &[
            0.2, -0.15, 0.3, 0.25, 0.1, -0.2, 0.12, -0.08, 0.3, 0.15, 0.05, 0.18, -0.1, 0.35, 0.22,
        ],
    );
    let of_four: Vec<Vec<f64>> = (0..6)
        .map(|row| {
            (0..6)
                .map(|column| {
                    if row < 4 && column < 4 {
                        of_six[row][column] * 1.25
                    } else {
                        0.0
                    }
                })
                .collect()
        })
        .collect();
    let scene = || {
        two_motions(
            [
                &[-640.0, 310.0, 9.0, -14.0, 0.0, 0.0],
                &[-652.0, 301.0, 12.0, -11.0, 1.3, -2.1],
            ],
            [of_four.clone(), of_six.clone()],
        )
        .sees(&[[700.0, 2.71], [713.0, 2.74], [681.0, 2.79], [690.0, 2.76]])
    };
    let flags = ["sequence", "unequal-dimensions", "embedded", "spread", "zeros"];
    vec![
        converting(scene()).named(
            "converted.unequal",
            &[&flags[..], &["converted"]].concat(),
            "Constant velocity, which knows its acceleration to be zero, and constant acceleration are mixed in six entries: what becomes of \
             the acceleration of a mode that has none is seen in its covariance.",
        ),
        with_points(scene()).named(
            "unscented.unequal",
            &[&flags[..], &["negative-weight"]].concat(),
            "The measurements of converted.unequal with unscented filters: the covariance of constant velocity has rows of zeros, and so has \
             its square root; no point leaves the four entries that the mode has.",
        ),
    ]
}

/// What the radar of the paper sees of a target on the negative x-axis: straight on, accelerated, straight on. Step 0 is the first.
fn seen(steps: usize) -> Vec<[f64; 2]> {
    let mut generator = Generator::new(SEED, 1);
    let mut state = Vector6::new(-1000.0, 50.0, 4.0, -3.0, 0.0, 0.0);
    let mut measurements = Vec::new();
    for k in 0..=steps {
        if k == 12 {
            state[4] = -0.6;
            state[5] = 0.9;
        }
        if k > 0 {
            let motion = if (12..24).contains(&k) {
                constant_acceleration_in_the_plane(&INTERVAL)
            } else {
                constant_velocity_in_the_plane(&INTERVAL)
            };
            state = motion * state;
        }
        let (x, y) = (state[0], state[1]);
        let range = Real::sqrt(&(x * x + y * y)) + RANGE_DEVIATION * generator.standard_normal();
        let bearing = Real::atan2(&y, &x) + BEARING_DEVIATION * generator.standard_normal();
        measurements.push([rounded_to(range, DIGITS), rounded_to(wrap(bearing), DIGITS)]);
    }
    measurements
}

fn sustika2015() -> Vec<ProblemFile> {
    let seen = seen(40);
    let [first, later @ ..] = &seen[..] else {
        return Vec::new();
    };
    // One-point initiation: the position of the first measurement with its covariance, no velocity and no acceleration.
    let [range_variance, bearing_variance] =
        [RANGE_DEVIATION, BEARING_DEVIATION].map(|deviation| deviation * deviation);
    let standard = Conversion::Standard;
    let position = standard.position(&first[0], &first[1], &bearing_variance);
    let position_covariance = standard.covariance(&first[0], &first[1], &range_variance, &bearing_variance);
    let start = [position[0], position[1], 0.0, 0.0, 0.0, 0.0].map(|entry| rounded_to(entry, DIGITS));
    let variances = |acceleration: f64| -> Vec<Vec<f64>> {
        let entry = |row: usize, column: usize| match (row, column) {
            (0 | 1, 0 | 1) => rounded_to(position_covariance[(row.max(column), row.min(column))], DIGITS),
            (2, 2) | (3, 3) => 100.0,
            (4, 4) | (5, 5) => acceleration,
            _ => 0.0,
        };
        (0..6)
            .map(|row| (0..6).map(|column| entry(row, column)).collect())
            .collect()
    };
    let scene = || two_motions([&start, &start], [variances(0.0), variances(1.0)]).sees(later);
    let flags = ["published-scenario", "run", "unequal-dimensions", "embedded", "zeros"];
    vec![
        converting(scene()).named(
            "sustika2015.converted.run",
            &[&flags[..], &["converted"]].concat(),
            "Forty steps of the filters of sustika2015 with converted measurements, from one point, on a target that crosses the negative \
             x-axis: the measured bearing jumps by a turn again and again, and nothing follows from it.",
        ),
        with_points(scene()).named(
            "sustika2015.unscented.run",
            &[&flags[..], &["wrap", "straddling", "negative-weight"]].concat(),
            "The measurements of sustika2015.converted.run with the unscented filters of the paper: every mean and difference of bearings has \
             to be wrapped, or the estimate is thrown away at the first jump.",
        ),
    ]
}
