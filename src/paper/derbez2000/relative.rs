//! Errors of one filter relative to another's, under every open choice of the paper.
//!
//! This judges a claim about filters whose configuration was not published. In each configuration the claim is certainly true, certainly
//! false, or neither; the verdict says whether the open choices decide it.

use super::path::Regime;
use super::scenario::CoordinateScenario;
use crate::paper::comparison::ErrorQuantity;
use crate::paper::experiment::Experiment;
use crate::paper::verdict::{DECISIVE, Tally};
use crate::statistics::Estimate;
use crate::statistics::estimate::figure;

/// A difference as a part of the second filter's error.
#[derive(Debug, Clone)]
pub struct Relative {
    /// The choices of the configuration.
    pub choices: String,
    /// The part.
    pub difference: Estimate,
}

impl Relative {
    /// The certain bounds of the part.
    pub fn bounds(&self) -> (f64, f64) {
        let certainty = DECISIVE * self.difference.standard_error;
        (self.difference.value - certainty, self.difference.value + certainty)
    }

    /// The part in per cent, in words.
    pub fn words(&self) -> String {
        let (value, error) = (100.0 * self.difference.value, 100.0 * self.difference.standard_error);
        format!("{} ± {} % ({})", figure(value), figure(error), self.choices)
    }
}

/// The error of filter `a` less that of `b`, as a part of the latter, in each experiment, over the steps that are chosen.
pub fn relative(
    experiments: &[Experiment<CoordinateScenario>],
    [a, b]: [usize; 2],
    quantity: ErrorQuantity,
    chosen: fn(Regime) -> bool,
) -> Vec<Relative> {
    let of_experiment = |experiment: &Experiment<CoordinateScenario>| {
        let motions = &experiment.scenario.path.motions;
        let steps = |k: usize| chosen(motions[k]);
        let comparison = experiment.comparison();
        let error = comparison.error_over(b, quantity, &steps).value;
        let difference = comparison.difference_over(a, b, quantity, &steps);
        Relative {
            choices: experiment.scenario.choices.describe(),
            difference: Estimate {
                value: difference.value / error,
                standard_error: difference.standard_error / error,
            },
        }
    };
    experiments.iter().map(of_experiment).collect()
}

/// The first, which is at the defaults, and the least and the greatest of all, in words.
pub fn extremes(all: &[Relative]) -> String {
    let by_value = |a: &&Relative, b: &&Relative| a.difference.value.total_cmp(&b.difference.value);
    let (least, greatest) = (all.iter().min_by(by_value), all.iter().max_by(by_value));
    match (all.first(), least, greatest) {
        (Some(first), Some(least), Some(greatest)) => format!(
            "{}; from {} to {} over {} configurations",
            first.words(),
            least.words(),
            greatest.words(),
            all.len()
        ),
        _ => String::new(),
    }
}

/// "The first's error is another by less than `limit`", as a part of the second's.
pub fn within(all: &[Relative], limit: f64) -> Tally {
    Tally::of(all.iter().map(|relative| match relative.bounds() {
        (low, high) if -limit < low && high < limit => Some(true),
        (low, high) if high < -limit || limit < low => Some(false),
        _ => None,
    }))
}

/// "The first's error is larger by less than `limit`", or, with a negative one, smaller by more than its amount.
pub fn below(all: &[Relative], limit: f64) -> Tally {
    Tally::of(all.iter().map(|relative| match relative.bounds() {
        (_, high) if high < limit => Some(true),
        (low, _) if limit < low => Some(false),
        _ => None,
    }))
}
