//! Which filter should I use? Every kind of filter and every interaction on the simulated truth of one problem.
//!
//! The truth is drawn from the problem's own model, so the comparison says which filter is best *if the model is right*. All filters see
//! the same truth and the same measurements. Their differences are therefore known far better than the errors themselves.
//!
//! - [`contenders`]: which filters the problem can be given to, and why others cannot;
//! - [`truth`]: how a run is drawn; [`group`]: which errors are summed;
//! - [`race`]: the runs, and the operations of a step;
//! - [`standing`]: errors, consistency and cost, with their uncertainty, and the order of the filters.
//!
//! Example: a linear problem, on which the extended and the cubature filter are the Kalman filter.
//!
//! ```
//! use immaculate::compare::{Contest, Sample};
//! use immaculate::oracle::case;
//!
//! let case = case::all().unwrap().iter().find(|case| case.problem.id == "update.kalman").unwrap();
//! let sample = Sample { runs: Some(20), seed: 1, steps: Some(3) };
//! let result = Contest::new(&case.problem, sample).unwrap().run(&|| {});
//! let kinds = &result.tables[0];
//! let error = |name: &str| kinds.standings.iter().find(|one| one.name == name).unwrap().groups[0].error.value;
//! assert!((error("kalman") / error("cubature-3") - 1.0).abs() < 1e-9);
//! ```

pub mod contenders;
pub mod group;
pub mod race;
pub mod standing;
pub mod truth;

use crate::number::RandomRounding;
use crate::oracle::invalid::Invalid;
use crate::oracle::problem::ProblemFile;
use crate::oracle::setup::Setup;
use contenders::Entrants;
use race::RunDone;
use standing::FilterComparison;
use truth::{SimulatedRun, TruthModel};

/// How much is simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sample {
    /// The number of runs; none for a number that takes some seconds.
    pub runs: Option<usize>,
    /// The seed.
    pub seed: u64,
    /// The number of steps; none for those of the file.
    pub steps: Option<usize>,
}

/// The fewest runs: a standard error takes two.
pub const FEWEST_RUNS: usize = 2;

/// Why a problem's filters cannot be compared.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotCompared {
    /// The problem is refused.
    #[error(transparent)]
    Problem(Invalid),
    /// There is nothing to simulate.
    #[error(
        "problem.measurements: is empty, and its steps are what is simulated; `\"z\": null` makes a step without a measurement"
    )]
    NoSteps,
    /// A standard error takes two runs.
    #[error("{0} runs have no standard error; at least {FEWEST_RUNS} are needed")]
    FewRuns(usize),
    /// A covariance is not positive semidefinite.
    #[error("no truth can be drawn: the covariance of {0} is not positive semidefinite")]
    Covariance(String),
    /// A run has no truth.
    #[error("no truth can be drawn: in run {run}, step {step}, {reason}")]
    Truth {
        /// The run, counted from 1.
        run: usize,
        /// The step.
        step: usize,
        /// What is wrong.
        reason: String,
    },
    /// The runs would not fit into memory.
    #[error("{runs} runs of {steps} steps need more than a gigabyte; at most {most} fit")]
    TooLarge {
        /// The runs.
        runs: usize,
        /// The steps of each.
        steps: usize,
        /// The most runs.
        most: usize,
    },
}

impl NotCompared {
    /// For a covariance of something.
    pub(crate) fn covariance(of: String) -> Self {
        Self::Covariance(of)
    }
}

/// Everything that is needed to compare the filters of a problem.
#[derive(Debug)]
pub struct Contest {
    entrants: Entrants,
    filters: Vec<(Setup<RandomRounding>, bool)>,
    operations: Vec<Option<f64>>,
    runs: Vec<SimulatedRun>,
    seed: u64,
}

/// This many operations take some ten seconds on two cores.
const OPERATIONS: f64 = 1.5e9;

/// The numbers of runs to choose from.
const RUNS: [usize; 7] = [1000, 500, 200, 100, 50, 20, 10];

/// This many numbers fit into a gigabyte.
const MOST_NUMBERS: usize = 1 << 27;

impl Contest {
    /// Finds the filters that apply, and draws the truth of every run.
    ///
    /// # Errors
    ///
    /// [`NotCompared`] with the reason in a sentence.
    pub fn new(problem: &ProblemFile, sample: Sample) -> Result<Self, NotCompared> {
        let steps = sample.steps.unwrap_or(problem.measurements.len());
        if problem.measurements.is_empty() || steps == 0 {
            return Err(NotCompared::NoSteps);
        }
        if let Some(runs) = sample.runs.filter(|runs| *runs < FEWEST_RUNS) {
            return Err(NotCompared::FewRuns(runs));
        }
        // Of each step and filter: errors, NEES, NIS, their lists, and what is true and measured.
        let of_step = (problem.state.len() + 8) * (contenders::MOST + problem.modes.len());
        let most = MOST_NUMBERS / of_step.saturating_mul(steps);
        let asked = sample.runs.unwrap_or(FEWEST_RUNS);
        if asked > most {
            let runs = asked;
            return Err(NotCompared::TooLarge { runs, steps, most });
        }
        let problem = truth::with_steps(problem, steps).map_err(NotCompared::Problem)?;
        let entrants = Entrants::new(&problem);
        let simulation = TruthModel::new(&problem)?;
        let first = simulation.run(sample.seed, 0)?;
        let mut filters = Vec::with_capacity(entrants.contenders.len());
        let mut operations = Vec::with_capacity(entrants.contenders.len());
        for contender in &entrants.contenders {
            let mut problem = contender.problem.clone();
            // Neither the time nor the filter needs the modes' own normalised innovations.
            problem.lacks_consistency = true;
            let setup = problem.setup_in_doubles().map_err(NotCompared::Problem)?;
            filters.push((setup, contender.is_second_order));
            operations.push(race::operations(contender, &first).map_err(NotCompared::Problem)?);
        }
        let of_run: f64 = operations.iter().flatten().sum::<f64>() * steps as f64;
        let affordable = RUNS.into_iter().find(|runs| *runs as f64 * of_run <= OPERATIONS);
        let runs = sample
            .runs
            .unwrap_or_else(|| affordable.unwrap_or(RUNS[RUNS.len() - 1]).min(most));
        Ok(Self {
            runs: simulation.runs(sample.seed, runs)?,
            entrants,
            filters,
            operations,
            seed: sample.seed,
        })
    }

    /// The number of runs.
    pub fn count(&self) -> usize {
        self.runs.len()
    }

    /// Runs every filter and compares them.
    pub fn run(&self, done: RunDone) -> FilterComparison {
        let groups = group::groups(&self.entrants.contenders[0].problem);
        let outcomes = race::race(&self.filters, &groups, &self.runs, done);
        standing::compare(self, &groups, &outcomes)
    }
}
