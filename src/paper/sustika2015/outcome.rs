//! The outcome of one run for the two filters, and for the unscented one with bearings that are never wrapped.
//!
//! There are many runs, so each keeps only a few numbers. These answer every question about percentage fit errors and divergence. All
//! three filters see the same truth and the same measurements.

use super::contestants::Bearings;
use super::scenario::RadarScenario;
use super::truth::{Manoeuvre, RadarDraw, bearing_jumps};
use crate::paper::comparison::ErrorQuantity;
use crate::paper::monte_carlo::Progress;
use crate::paper::simulation::Run;
use crate::paper::simulation::Simulation;
use crate::statistics::fit_error::FitForm;
use rayon::prelude::*;
use std::f64::consts::PI;

/// What one filter did in a run that came to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Track {
    /// The percentage fit errors, in the order of [`FitForm::ALL`].
    pub fits: [f64; FitForm::ALL.len()],
    /// The mean squared position error in the steps of constant velocity and in those of constant acceleration, m²; not a number where
    /// there are none.
    pub mean_squares: [f64; 2],
}

/// What one run shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunOutcome {
    /// Whether two measured bearings that follow each other differ by more than π.
    pub jumps: bool,
    /// The least angle between a measured bearing and the negative x-axis, rad.
    pub to_cut: f64,
    /// IMM-CMKF, IMM-UKF, IMM-UKF never wrapped; none where a step could not be computed.
    pub filters: [Option<Track>; 3],
    /// The greatest distance between the positions that the two unscented filters estimate, m.
    pub apart: f64,
}

impl RunOutcome {
    /// The percentage fit error of a filter.
    pub fn fit(&self, form: FitForm, filter: usize) -> Option<f64> {
        let place = FitForm::ALL.iter().position(|other| *other == form)?;
        Some(self.filters[filter]?.fits[place])
    }
}

/// The outcomes of a scenario, of all its runs.
pub fn outcomes(scenario: &RadarScenario, runs: usize, seed: u64, progress: Progress) -> Vec<RunOutcome> {
    let setup = &scenario.setup;
    let contestants = [
        setup.converted(),
        setup.unscented(Bearings::Wrapped),
        setup.unscented(Bearings::Plain),
    ];
    (0..runs)
        .into_par_iter()
        .map(|run| {
            let draw = scenario.trajectory.draw(run, seed);
            let runs = contestants
                .each_ref()
                .map(|contestant| scenario.track(contestant, &draw));
            progress();
            outcome(scenario, &draw, &runs)
        })
        .collect()
}

fn outcome(scenario: &RadarScenario, draw: &RadarDraw, runs: &[Run; 3]) -> RunOutcome {
    let manoeuvres: Vec<bool> = scenario
        .motions()
        .into_iter()
        .map(|motion| motion == Manoeuvre::Manoeuvre.name())
        .collect();
    let track = |run: &Run| {
        Some(Track {
            fits: scenario.fit_errors(run, draw)?,
            mean_squares: [false, true].map(|kind| mean_square(run, &manoeuvres, kind)),
        })
    };
    let [_, wrapped, plain] = runs;
    let between = wrapped.errors.iter().zip(&plain.errors);
    RunOutcome {
        jumps: bearing_jumps(&draw.measurements) > 0,
        to_cut: draw.measurements.iter().map(|z| PI - z[1].abs()).fold(PI, f64::min),
        filters: runs.each_ref().map(track),
        apart: between
            .map(|(a, b)| ErrorQuantity::Position.squared(&(a - b)).sqrt())
            .fold(0.0, f64::max),
    }
}

/// The mean squared position error in the steps that are manoeuvres or in those that are not, m².
fn mean_square(run: &Run, manoeuvres: &[bool], kind: bool) -> f64 {
    let steps = run.errors.iter().zip(manoeuvres);
    let squares: Vec<f64> = steps
        .filter(|(_, manoeuvre)| **manoeuvre == kind)
        .map(|(error, _)| ErrorQuantity::Position.squared(error))
        .collect();
    squares.iter().sum::<f64>() / squares.len() as f64
}
