//! Runs: the two papers' scenarios, step by step.
//!
//! A long problem takes modes, Markov chain and noise from a paper's scenario at its defaults, and measurements and initial estimate from
//! one draw of a named generator, all rounded. The rounded numbers are the problem; the draw is not needed to use it.

use super::draft::{Draft, estimate, filter, mode, rounded_to, unscented, words};
use super::numbers::rounded_rows;
use immaculate::model::Sensor;
use immaculate::oracle::problem::{FilterFile, MeasurementFile, ProblemFile};
use immaculate::paper::Paper;
use immaculate::paper::monte_carlo::Generator;
use immaculate::paper::scenario::{Draw, Scenario};
use immaculate::paper::specification::Choices;

/// The seed of the draws.
const SEED: u64 = 2017;
/// Significant digits of what is drawn.
const DRAWN_DIGITS: usize = 9;
/// Significant digits of a probability: as many as a problem may have, so that thirds sum to one.
const PROBABILITY_DIGITS: usize = 15;

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    [zhu2016(), liu2017()].concat()
}

/// The first steps of a paper's scenario, from one stream of random numbers.
fn scene(paper: Paper, stream: u64, steps: usize) -> Draft {
    let scenario = paper
        .scenario(&Choices::default())
        .expect("a scenario without choices is part of the program");
    let draw = scenario.draw(&mut Generator::new(SEED, stream));
    let drawn = |values: &[f64]| -> Vec<f64> { values.iter().map(|&value| rounded_to(value, DRAWN_DIGITS)).collect() };
    let seen: Vec<Option<[f64; 2]>> = draw.measurements[..steps.min(draw.measurements.len())]
        .iter()
        .map(|z| Some([rounded_to(z[0], DRAWN_DIGITS), rounded_to(z[1], DRAWN_DIGITS)]))
        .collect();
    inputs(&scenario, &draw, &drawn(draw.initial.mean.as_slice())).sees_or_misses(&seen)
}

/// What does not change from step to step.
fn inputs(scenario: &Scenario, draw: &Draw, mean: &[f64]) -> Draft {
    let contestant = &scenario.contestants[0];
    let problem = &contestant.problem;
    let start = estimate(mean, rounded_rows(&draw.initial.covariance));
    let parts = problem.modes.iter().map(|m| {
        let mode = mode(&m.name, rounded_rows(&m.motion.matrix()), rounded_rows(&m.noise));
        (mode, start.clone())
    });
    let probabilities: Vec<f64> = contestant
        .initial_probabilities
        .iter()
        .map(|&probability| rounded_to(probability, PROBABILITY_DIGITS))
        .collect();
    let draft = Draft::new(&["x", "vx", "y", "vy"], &["m", "m/s", "m", "m/s"], parts.collect())
        .chain(problem.chain.clone(), &probabilities);
    draft.with(|file| {
        file.noise = rounded_rows(&problem.measurement_noise);
        file.measurement = match &problem.sensor {
            Sensor::Linear(h) => MeasurementFile::Linear {
                matrix: rounded_rows(h),
            },
            Sensor::Polar { position, location, .. } => MeasurementFile::RangeBearing {
                components: words(&["range", "bearing"]),
                position: *position,
                sensor: *location,
            },
            Sensor::Function { .. } => unreachable!("no paper has one"),
        };
    })
}

fn zhu2016() -> Vec<ProblemFile> {
    let flags = ["published-scenario", "run", "zeros"];
    let run = |id: &str, filter: FilterFile, more: &[&str], about: &str| {
        let flags = [&flags[..], more].concat();
        scene(Paper::Zhu2016, 1, 40).filter(filter).named(id, &flags, about)
    };
    vec![
        run(
            "zhu2016.kalman.run",
            filter("kalman"),
            &["singular-noise"],
            "The first forty steps of zhu2016's scenario, straight and then a right turn, with Kalman filters; Q has rank two.",
        ),
        run(
            "zhu2016.cubature-3.run",
            filter("cubature-3"),
            &["singular-noise", "as-kalman"],
            "zhu2016.kalman.run with the paper's IMMCKF: since motion and measurement are linear, the same values to the last digit.",
        ),
        run(
            "zhu2016.cubature-5.run",
            filter("cubature-5"),
            &["singular-noise", "as-kalman"],
            "zhu2016.kalman.run with the paper's IMM5CKF: the same values again, although the paper's table has others.",
        ),
        run(
            "zhu2016.unscented.run",
            unscented(1.0, 0.0, -1.0),
            &["singular-noise", "as-kalman", "negative-weight"],
            "zhu2016.kalman.run with the paper's IMMUKF, kappa = 3 - n: the same values again.",
        ),
        scene(Paper::Zhu2016, 2, 100).named(
            "zhu2016.kalman.long",
            &[&flags[..], &["singular-noise"]].concat(),
            "All hundred steps of another draw of zhu2016's scenario, with both turns: whether errors die out or add up.",
        ),
    ]
}

/// The first forty steps of liu2017's scenario.
pub(super) fn liu2017_run(filter: FilterFile) -> Draft {
    scene(Paper::Liu2017, 1, 40).filter(filter)
}

fn liu2017() -> Vec<ProblemFile> {
    let flags = ["published-scenario", "run", "zeros"];
    let run = |id: &str, filter: FilterFile, more: &[&str], about: &str| {
        let flags = [&flags[..], more].concat();
        liu2017_run(filter).named(id, &flags, about)
    };
    vec![
        run(
            "liu2017.cubature-3.run",
            filter("cubature-3"),
            &[],
            "The first forty steps of liu2017's scenario, straight and then a right turn, with the paper's IMMCKF.",
        ),
        run(
            "liu2017.cubature-5.run",
            filter("cubature-5"),
            &[],
            "The steps of liu2017.cubature-3.run with the paper's IMM5thCKF.",
        ),
        run(
            "liu2017.simplex-5.run",
            filter("simplex-5"),
            &[],
            "The steps of liu2017.cubature-3.run with the paper's IMM5thSSRCKF, the filter that it proposes.",
        ),
        run(
            "liu2017.unscented.run",
            unscented(1.0, 0.0, -1.0),
            &["negative-weight"],
            "The steps of liu2017.cubature-3.run with the paper's IMMUKF, kappa = 3 - n.",
        ),
        scene(Paper::Liu2017, 1, 10).filter(filter("gauss-hermite-3")).named(
            "liu2017.gauss-hermite-3.run",
            &flags,
            "The first ten steps of liu2017.cubature-3.run with Gauss-Hermite filters of 81 points, for comparison.",
        ),
        scene(Paper::Liu2017, 2, 60)
            .without(&[1, 7, 21, 22, 23, 24, 40, 57, 58, 60])
            .filter(filter("cubature-3"))
            .named(
                "liu2017.cubature-3.missed",
                &[&flags[..], &["missed-detection", "missed-in-a-row"]].concat(),
                "Sixty steps of another draw of liu2017's scenario, ten of them without a detection: single ones, several in a row at the \
                 start of the turn, the first and the last.",
            ),
    ]
}
