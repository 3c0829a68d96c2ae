//! A scenario and its runs, for judges that ask about several scenarios.
//!
//! After this file the reader knows how a judge gets the runs that it asks for.

use super::Effort;
use super::monte_carlo::{Progress, Run, run};
use super::result::Comparison;
use super::scenario::Scenario;

/// A scenario and its runs.
#[derive(Debug, Clone)]
pub struct Experiment {
    /// The scenario.
    pub scenario: Scenario,
    /// The runs, `[run][contestant]`.
    pub runs: Vec<Vec<Run>>,
}

impl Experiment {
    /// Runs a scenario.
    pub fn new(scenario: Scenario, effort: Effort, progress: Progress) -> Self {
        let runs = run(&scenario, effort.runs.unwrap_or(scenario.runs), effort.seed, progress);
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
}
