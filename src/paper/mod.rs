//! The papers: their scenarios, their published tables, their claims.
//!
//! For each paper this folder shows what it reports, and what its own equations give with its own parameters and under each choice that it
//! leaves open. The subfolders follow their papers, and each begins with a guide from the paper's sections to the code; this level holds
//! what they share.
//!
//! - [`zhu2016`], [`liu2017`], [`derbez2000`], [`sustika2015`]: the papers;
//! - [`specification`]: the papers' equations, tables, open parameters and claims, from the files in `spec/`;
//! - [`simulation`]: what can be run, and what the statistics ask about it;
//! - [`scenario`]: a target that flies straight and turns, seen by a sensor, and the filters that compete on it;
//! - [`monte_carlo`]: runs, on all cores, the same for any number of them;
//! - [`comparison`]: questions to the runs;
//! - [`result`]: what the runs show, as a record;
//! - [`experiment`]: a scenario together with its runs;
//! - [`verdict`]: how a claim is judged.
//!
//! ```
//! use immaculate::paper::Paper;
//!
//! // Everything that a paper prints is there as data: here its (13), which is wrong, with the reason.
//! let specification = "zhu2016".parse::<Paper>()?.specification();
//! let weight = specification.equations.iter().find(|equation| equation.number == Some(13)).unwrap();
//! assert_eq!(weight.status, "corrected");
//! assert!(weight.erratum.as_ref().unwrap().printed.contains(r"\frac{2}{(n+2)^2}"));
//! # Ok::<(), String>(())
//! ```

pub mod comparison;
pub mod derbez2000;
pub mod experiment;
pub mod liu2017;
pub mod monte_carlo;
pub mod operations;
pub mod result;
pub mod scenario;
pub mod simulation;
pub mod specification;
pub mod sustika2015;
pub mod verdict;
pub mod zhu2016;

use monte_carlo::Progress;
use result::{Figure, Reproduction};
use simulation::Simulation;
use specification::{Choices, InvalidChoice, Specification};
use verdict::JudgedClaim;

/// A paper that can be reproduced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Paper {
    /// Derbez, Rémillard and Jouan 2000.
    Derbez2000,
    /// Sustika and Suryana 2015.
    Sustika2015,
    /// Zhu, Wang and Yuan 2016.
    Zhu2016,
    /// Liu and Wu 2017.
    Liu2017,
}

/// How much is computed, and from which random numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// The number of runs; the paper's own when none is given, or what its judges ask for.
    pub runs: Option<usize>,
    /// The seed of the random numbers.
    pub seed: u64,
}

/// The most runs of a simulation. All are kept until its figures are computed, 41 to 82 kB a run (measured): four gigabytes at most.
pub const MOST_RUNS: usize = 50_000;

impl Paper {
    /// All papers, in the order of their years.
    pub const ALL: [Self; 4] = [Self::Derbez2000, Self::Sustika2015, Self::Zhu2016, Self::Liu2017];

    /// The paper's key.
    pub fn key(self) -> &'static str {
        match self {
            Self::Derbez2000 => "derbez2000",
            Self::Sustika2015 => "sustika2015",
            Self::Zhu2016 => "zhu2016",
            Self::Liu2017 => "liu2017",
        }
    }

    /// The paper's half of the specification.
    pub fn specification(self) -> &'static Specification {
        match self {
            Self::Derbez2000 => specification::derbez2000(),
            Self::Sustika2015 => specification::sustika2015(),
            Self::Zhu2016 => specification::zhu2016(),
            Self::Liu2017 => specification::liu2017(),
        }
    }

    /// The simulations that the paper reports, under the given choices: the first is that of its tables.
    pub fn simulations(self, chosen: &Choices) -> Vec<Choices> {
        let mut all = vec![chosen.clone()];
        let parameters = self.specification().parameters.iter();
        for parameter in parameters.filter(|p| p.name == "scenario" && chosen.chosen("scenario").is_none()) {
            let others = parameter
                .alternatives
                .iter()
                .filter(|other| other.name != parameter.default);
            all.extend(others.map(|other| chosen.clone().with("scenario", &other.name)));
        }
        all
    }

    /// Every open choice by itself, of those that matter to a simulation, the others as in it.
    pub fn open_choices(self, simulation: &Choices) -> Vec<Choices> {
        let all = self.specification().alternatives_of(simulation.chosen("scenario"));
        all.into_iter()
            .map(|choices| simulation.clone().and(&choices))
            .collect()
    }

    /// The paper's simulation under the given choices.
    ///
    /// # Errors
    ///
    /// [`InvalidChoice`] when a choice names no parameter or no alternative of this paper.
    pub fn simulation(self, choices: &Choices) -> Result<Box<dyn Simulation>, InvalidChoice> {
        Ok(match self {
            Self::Derbez2000 => Box::new(derbez2000::scenario(choices)?),
            Self::Sustika2015 => Box::new(sustika2015::scenario(choices)?),
            Self::Zhu2016 => Box::new(zhu2016::scenario(choices)?),
            Self::Liu2017 => Box::new(liu2017::scenario(choices)?),
        })
    }

    /// The paper's scenario under the given choices, of a paper that has one of the usual form: a target in the plane, filtered as a
    /// whole.
    ///
    /// # Errors
    ///
    /// [`InvalidChoice`] when a choice names no parameter or no alternative of this paper, or the paper has no such scenario.
    pub fn scenario(self, choices: &Choices) -> Result<scenario::Scenario, InvalidChoice> {
        match self {
            Self::Derbez2000 | Self::Sustika2015 => Err(InvalidChoice::OtherForm {
                paper: self.key().to_owned(),
            }),
            Self::Zhu2016 => zhu2016::scenario(choices),
            Self::Liu2017 => liu2017::scenario(choices),
        }
    }

    /// Runs the paper's simulation.
    ///
    /// Example: zhu2016 is linear, so two of its filters are one: the same errors but for rounding, in two runs as in a hundred.
    ///
    /// ```
    /// use immaculate::paper::comparison::ErrorQuantity;
    /// use immaculate::paper::specification::Choices;
    /// use immaculate::paper::{Effort, Paper};
    ///
    /// let effort = Effort { runs: Some(2), seed: 1 };
    /// let result = Paper::Zhu2016.reproduce(&Choices::default(), effort, &|| {}).unwrap();
    /// let error = |filter| result.error(filter, ErrorQuantity::X).unwrap().value;
    /// assert!((error("IMM5CKF") - error("IMMCKF")).abs() < 1e-9); // 10⁻¹⁰ m is the greatest difference of any estimate
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Paper::simulation`].
    pub fn reproduce(
        self,
        choices: &Choices,
        effort: Effort,
        progress: Progress,
    ) -> Result<Reproduction, InvalidChoice> {
        let simulation = self.simulation(choices)?;
        let runs = effort.runs.unwrap_or_else(|| simulation.runs());
        let results = monte_carlo::run(&*simulation, runs, effort.seed, progress);
        Ok(Reproduction::new(&*simulation, runs, effort.seed, &results))
    }

    /// What a row of a published table measures, where the simulation under these choices is the one that the table is of.
    pub fn figure_of_row(self, choices: &Choices, table: u32, row: &str) -> Option<Figure> {
        match self {
            // Table 2 is of scenario 3, and scenario 1 has none.
            Self::Derbez2000 => {
                let scenario = specification::derbez2000().chosen(choices, "scenario").ok()?;
                let is_of_table = table == 1 && scenario == "manoeuvres";
                derbez2000::quantity_of_row(row)
                    .filter(|_| is_of_table)
                    .map(Figure::Error)
            }
            Self::Sustika2015 => {
                let scenario = specification::sustika2015().chosen(choices, "scenario").ok()?;
                (sustika2015::scenario_of_row(table, row) == Some(scenario)).then_some(Figure::FitError)
            }
            Self::Zhu2016 => zhu2016::quantity_of_row(row).map(Figure::Error),
            Self::Liu2017 => liu2017::quantity_of_row(row).map(Figure::Error),
        }
    }

    /// The most runs with which the claims can be judged. The judges keep the runs of several scenarios in memory, which then takes
    /// four to five gigabytes: 2.4 MB, measured, for a run of each scenario of derbez2000, 2.1 MB of liu2017, 0.3 MB of zhu2016 and
    /// 4 kB of sustika2015.
    pub fn most_judged_runs(self) -> usize {
        match self {
            Self::Derbez2000 | Self::Liu2017 => 2_000,
            Self::Zhu2016 => 15_000,
            Self::Sustika2015 => MOST_RUNS,
        }
    }

    /// Judges the paper's claims.
    ///
    /// # Errors
    ///
    /// [`InvalidChoice`] never, unless the specification and the code disagree about the scenario's parameters.
    pub fn judge(self, effort: Effort, progress: Progress) -> Result<Vec<JudgedClaim>, InvalidChoice> {
        match self {
            Self::Derbez2000 => derbez2000::claims::judge(effort, progress),
            Self::Sustika2015 => sustika2015::claims::judge(effort, progress),
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
