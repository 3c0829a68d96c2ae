//! The papers: their scenarios, their published tables, their claims.
//!
//! After this folder the reader knows what each paper reports, what its own equations give under its own parameters, and under each
//! choice that it leaves open. The folders follow their papers; this level holds what they share.
//!
//! - [`specification`]: the papers' equations, tables, open parameters and claims, from the files in `spec/`;
//! - [`simulation`]: what can be run, and what the statistics ask about it;
//! - [`scenario`]: a target that flies straight and turns, seen by a sensor, and the filters that compete on it;
//! - [`monte_carlo`]: runs, on all cores, the same for any number of them;
//! - [`result`]: what the runs show;
//! - [`experiment`]: a scenario together with its runs;
//! - [`verdict`]: how a claim is judged.

pub mod experiment;
pub mod liu2017;
pub mod monte_carlo;
pub mod result;
pub mod scenario;
pub mod simulation;
pub mod specification;
pub mod verdict;
pub mod zhu2016;

use monte_carlo::Progress;
use result::Reproduction;
use specification::{Choices, InvalidChoice, Specification};
use verdict::Judgement;

/// A paper that can be reproduced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Paper {
    /// Zhu, Wang and Yuan 2016.
    Zhu2016,
    /// Liu and Wu 2017.
    Liu2017,
}

/// How much is computed, and from which random numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// The number of runs; the paper's own when none is given.
    pub runs: Option<usize>,
    /// The seed of the random numbers.
    pub seed: u64,
}

impl Paper {
    /// All papers, in the order of their years.
    pub const ALL: [Self; 2] = [Self::Zhu2016, Self::Liu2017];

    /// The paper's key.
    pub fn key(self) -> &'static str {
        match self {
            Self::Zhu2016 => "zhu2016",
            Self::Liu2017 => "liu2017",
        }
    }

    /// The paper's half of the specification.
    pub fn specification(self) -> &'static Specification {
        match self {
            Self::Zhu2016 => specification::zhu2016(),
            Self::Liu2017 => specification::liu2017(),
        }
    }

    /// The paper's scenario under the given choices.
    ///
    /// # Errors
    ///
    /// [`InvalidChoice`] when a choice names no parameter or no alternative of this paper.
    pub fn scenario(self, choices: &Choices) -> Result<scenario::Scenario, InvalidChoice> {
        match self {
            Self::Zhu2016 => zhu2016::scenario(choices),
            Self::Liu2017 => liu2017::scenario(choices),
        }
    }

    /// Runs the paper's scenario.
    ///
    /// # Errors
    ///
    /// As [`Paper::scenario`].
    pub fn reproduce(
        self,
        choices: &Choices,
        effort: Effort,
        progress: Progress,
    ) -> Result<Reproduction, InvalidChoice> {
        let scenario = self.scenario(choices)?;
        let runs = effort.runs.unwrap_or(scenario.runs);
        let results = monte_carlo::run(&scenario, runs, effort.seed, progress);
        Ok(Reproduction::new(&scenario, runs, effort.seed, &results))
    }

    /// Judges the paper's claims.
    ///
    /// # Errors
    ///
    /// [`InvalidChoice`] never, unless the specification and the code disagree about the scenario's parameters.
    pub fn judge(self, effort: Effort, progress: Progress) -> Result<Vec<Judgement>, InvalidChoice> {
        match self {
            Self::Zhu2016 => zhu2016::claims::judge(effort, progress),
            Self::Liu2017 => liu2017::claims::judge(effort, progress),
        }
    }
}

impl std::str::FromStr for Paper {
    type Err = String;

    fn from_str(key: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|paper| paper.key() == key).ok_or_else(|| {
            let keys: Vec<_> = Self::ALL.iter().map(|paper| paper.key()).collect();
            format!("there is no paper `{key}`; there are {}", keys.join(", "))
        })
    }
}
