//! The cause of the unscented filter's divergence.
//!
//! Three filters see the same trajectories and the same measurements: the converted filter, the unscented one with bearings on the circle,
//! and the unscented one with bearings as plain numbers. If mismatched noises were the cause, both unscented filters would diverge. If the
//! cut of the bearings at ±π is the cause, only the last one does, in runs whose measured bearing jumps.

use super::scenario;
use super::sweep::{SweepPoint, point};
use crate::paper::monte_carlo::Progress;
use crate::paper::specification::{Choices, InvalidChoice};
use serde::Serialize;

/// The number of runs of each simulation where none is given: as many as tell a wrapped from an unwrapped filter by many standard errors.
pub const RUNS: usize = 500;

/// The paper's simulations with manoeuvres, in either reading of when they are: scenario and window.
pub const SIMULATIONS: [(&str, &str); 4] = [
    ("matched-manoeuvring", "toolbox"),
    ("mismatched-manoeuvring", "toolbox"),
    ("matched-manoeuvring", "printed"),
    ("mismatched-manoeuvring", "printed"),
];

/// One simulation with all three filters.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DivergenceRow {
    /// The scenario.
    pub scenario: &'static str,
    /// When the manoeuvres are.
    pub window: &'static str,
    /// What its runs show.
    pub point: SweepPoint,
}

/// Runs the simulations.
///
/// # Errors
///
/// [`InvalidChoice`] never, unless the specification and this file disagree about the names.
pub fn rows(runs: usize, seed: u64, progress: Progress) -> Result<Vec<DivergenceRow>, InvalidChoice> {
    let row = |&(name, window): &(&'static str, &'static str)| {
        let choices = Choices::of("scenario", name).with("window", window);
        Ok(DivergenceRow {
            scenario: name,
            window,
            point: point(&scenario(&choices)?, runs, seed, progress),
        })
    };
    SIMULATIONS.iter().map(row).collect()
}

/// Runs of several settings together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Divergences {
    /// All runs.
    pub runs: usize,
    /// The divergent ones, of each filter of the sweep.
    pub divergent: [usize; 3],
    /// Those of them whose measured bearings jump.
    pub divergent_with_jump: [usize; 3],
}

impl Divergences {
    /// The sums over points of a number of runs each.
    pub fn of<'a>(points: impl Iterator<Item = &'a SweepPoint>, runs: usize) -> Self {
        let mut tally = Self {
            runs: 0,
            divergent: [0; 3],
            divergent_with_jump: [0; 3],
        };
        for point in points {
            tally.runs += runs;
            for (filter, fit) in point.fits.iter().enumerate() {
                tally.divergent[filter] += fit.divergent;
                tally.divergent_with_jump[filter] += fit.divergent_with_jump;
            }
        }
        tally
    }

    /// What the counts say of the cause, in a sentence.
    pub fn cause(&self) -> String {
        let [converted, wrapped, plain] = self.divergent;
        let counts = format!(
            "Of {} runs each, {plain} of the unscented filter diverge if its bearings are never wrapped, {} of these in runs whose measured \
             bearing jumps by more than π; {wrapped} if they are, on the same measurements, and {converted} of the converted filter.",
            self.runs, self.divergent_with_jump[2],
        );
        // A tenth: what the noises do to a wrapped filter must be much rarer than what the cut does to an unwrapped one.
        let verdict = if plain == 0 {
            "None diverges, so nothing is said of a cause."
        } else if 10 * wrapped <= plain && 10 * (plain - self.divergent_with_jump[2]) <= plain {
            "The cause is the unwrapped azimuth, not the noises: both see the same and take the same noises for granted."
        } else if wrapped >= plain {
            "The cause is not the azimuth: the wrapped filter diverges as often."
        } else {
            "The azimuth is one cause among others."
        };
        format!("{counts} {verdict}")
    }
}
