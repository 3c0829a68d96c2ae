//! Chains in continuous time: rates or mean sojourn times, from which the length of each step makes a transition matrix.
//!
//! After this file the reader knows the problems that tell e^(G T) from what is taken for it.

use super::draft::{Draft, rows};
use super::extended::extended;
use super::scene::{PLANE_TRACK, RADAR_TRACK, plane, radar};
use immaculate::oracle::problem::{FORMAT_2, ProblemFile};

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    vec![
        plane()
            .sees(&PLANE_TRACK[..5])
            .without(&[4])
            .lasting(&[1.0, 0.25, 1.75, 0.5, 0.0])
            .with(|problem| problem.rates = Some(rows([[-0.15, 0.1, 0.05], [0.25, -0.375, 0.125], [0.0, 0.5, -0.5]])))
            .named(
                "rates.changing-steps",
                &["sequence", "rates", "changing-steps", "missed-detection", "transition-order", "spread", "full-correlation"],
                "Rates in the place of a transition matrix, and steps of five lengths: short ones, in which I + G T is nearly right, one \
                 nearly as long as a sojourn, in which it is far off, and none at all. The third mode comes to the first by way of the \
                 second alone.",
            ),
        extended(radar("cubature-3"))
            .sees(&RADAR_TRACK[..3])
            .with(|problem| {
                problem.transition.clear();
                problem.parameters.0.push(("T".to_owned(), 1.5));
                problem.sojourn_times = Some(vec![8.0, 2.5, 5.0]);
                problem.jumps = Some(rows([[0.0, 0.75, 0.25], [0.5, 0.0, 0.5], [0.875, 0.125, 0.0]]));
            })
            .named(
                "sojourns.extended",
                &["sequence", "rates", "transition-order", "spread", "full-correlation"],
                "Mean sojourn times, and where a mode goes that is left, under extended filters and steps of one length.",
            ),
    ]
}

impl Draft {
    /// Steps of these lengths, and no transition matrix.
    fn lasting(self, intervals: &[f64]) -> Self {
        self.with(|problem| {
            problem.format = FORMAT_2.into();
            problem.transition.clear();
            for (entry, interval) in problem.measurements.iter_mut().zip(intervals) {
                entry.interval = Some(*interval);
            }
        })
    }
}
