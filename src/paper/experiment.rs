//! A scenario and its runs, for judges that ask about several scenarios.
//!
//! A scenario is run once, and every question about it is answered from the same runs, so that answers can be compared.

use super::Effort;
use super::comparison::Comparison;
use super::monte_carlo::{Progress, run};
use super::scenario::Scenario;
use super::simulation::Run;
use super::simulation::Simulation;
use super::verdict::DECISIVE;
use crate::statistics::estimate::figure;
use std::fmt::Write;

/// A scenario and its runs.
#[derive(Debug, Clone)]
pub struct Experiment<S = Scenario> {
    /// The scenario.
    pub scenario: S,
    /// The runs, `[run][contestant]`.
    pub runs: Vec<Vec<Run>>,
}

impl<S: Simulation> Experiment<S> {
    /// Runs a scenario.
    pub fn new(scenario: S, effort: Effort, progress: Progress) -> Self {
        let runs = run(
            &scenario,
            effort.runs.unwrap_or_else(|| scenario.runs()),
            effort.seed,
            progress,
        );
        Self { scenario, runs }
    }

    /// Questions about the runs.
    pub fn comparison(&self) -> Comparison<'_> {
        Comparison {
            scenario: &self.scenario,
            runs: &self.runs,
        }
    }

    /// The number of runs in which a contestant could not compute a step.
    pub fn failures(&self, contestant: usize) -> usize {
        self.runs.iter().filter(|run| run[contestant].failure.is_some()).count()
    }

    /// Whether no run fails and no position error of any filter reaches a limit, in metres, with the figures in words; and, which decides
    /// nothing, which filters have errors that are certainly larger than their covariances say.
    pub fn stays_within(&self, limit: f64) -> (bool, String) {
        let comparison = self.comparison();
        let mut bounded = true;
        let (expected, _) = self.scenario.components();
        let mut beyond = Vec::new();
        let mut words = format!("Mean NEES ({expected} expected) and greatest position error of any run:");
        for (c, filter) in self.scenario.filters().iter().enumerate() {
            let (nees, _) = comparison.consistency(c);
            let greatest = comparison.greatest_position_error(c);
            bounded &= self.failures(c) == 0 && greatest < limit;
            if nees.distance_from(expected) >= DECISIVE {
                beyond.push(filter.name.clone());
            }
            let (name, nees, greatest) = (&filter.name, figure(nees.value), figure(greatest));
            let _ = write!(words, " {name} {nees}, {greatest} m;");
        }
        let verdict = if bounded {
            "no run fails and none reaches"
        } else {
            "a run fails or reaches"
        };
        let beyond = if beyond.is_empty() {
            "none".to_owned()
        } else {
            beyond.join(", ")
        };
        let _ = write!(
            words,
            " {verdict} {} m. Errors certainly larger than the covariance says, which is another question: {beyond}.",
            figure(limit)
        );
        (bounded, words)
    }
}
