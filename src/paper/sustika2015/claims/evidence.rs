//! The runs behind the judges of sustika2015, and the questions that several judges share.
//!
//! Two filters with percentage fit errors are compared run by run, because both saw the same, as a difference or as a ratio.
//!
//! ```text
//! scenarios 1 and 2, three trajectories       all runs
//! scenario 3, some settings of table 3        an eighth of them
//! every open choice by itself, scenarios 1, 2  a sixteenth
//! ```

use super::super::outcome::{RunOutcome, outcomes};
use super::super::sweep::{Sweep, SweepSetting, SweptParameter, SweptTrajectory};
use super::super::{NOISE_DENSITY, RUNS, scenario};
use crate::paper::Effort;
use crate::paper::monte_carlo::Progress;
use crate::paper::specification::{Choices, InvalidChoice, Specification, sustika2015 as specification};
use crate::statistics::Estimate;
use crate::statistics::estimate::{figure, mean, paired_difference};
use crate::statistics::fit_error::FitForm;

/// The places of the filters in an outcome.
pub const CONVERTED: usize = 0;
pub const WRAPPED: usize = 1;
pub const PLAIN: usize = 2;

/// The trajectories: without manoeuvres, and with them in either window.
pub const PATHS: [&str; 3] = ["without manoeuvres", "toolbox's window", "printed window"];
/// Those with manoeuvres.
pub const WINDOWS: [usize; 2] = [1, 2];

/// The number of runs where none is given. The paper's 50 leave most of its questions open, which is itself an answer; the judges look
/// further.
const JUDGED_RUNS: usize = 4000;

/// The runs of a simulation.
#[derive(Debug, Clone)]
pub struct Runs(pub Vec<RunOutcome>);

/// An open choice by itself, or none.
#[derive(Debug, Clone)]
pub struct Configuration {
    /// The choice.
    pub choices: Choices,
    /// The place of the unscented filter that this choice means.
    pub unscented: usize,
    /// Scenarios 1 and 2, without and with manoeuvres: `[table][row]` of tables 4 and 5.
    pub tables: [[Runs; 2]; 2],
}

/// What the judges ask about.
#[derive(Debug, Clone)]
pub struct RadarEvidence {
    /// Scenarios 1 and 2 on each of [`PATHS`].
    pub scenarios: [[Runs; 3]; 2],
    /// Some settings of scenario 3 on each of [`PATHS`].
    pub swept: [Vec<(SweepSetting, Runs)>; 3],
    /// What the paper leaves open, choice by choice; the defaults first.
    pub configurations: Vec<Configuration>,
}

impl RadarEvidence {
    /// Runs everything.
    ///
    /// # Errors
    ///
    /// [`InvalidChoice`] when the specification lacks an alternative that is asked for.
    pub fn new(effort: Effort, progress: Progress) -> Result<Self, InvalidChoice> {
        let runs = effort.runs.unwrap_or(JUDGED_RUNS);
        // Of one run there is no standard error.
        let part = |divisor: usize| (runs / divisor).max(2);
        let run = |choices: &Choices, runs: usize| {
            let scenario = scenario(choices)?;
            Ok(Runs(outcomes(&scenario, runs, effort.seed, progress)))
        };
        let of = |name: &str, window: &str| run(&Choices::of("scenario", name).with("window", window), runs);
        let on_paths = |straight: &str, manoeuvring: &str| {
            Ok([
                of(straight, "toolbox")?,
                of(manoeuvring, "toolbox")?,
                of(manoeuvring, "printed")?,
            ])
        };
        let configuration = |choices: Choices| {
            let of = |name: &str| run(&choices.clone().with("scenario", name), part(16));
            Ok(Configuration {
                unscented: if choices.chosen("wrapping").is_some() {
                    PLAIN
                } else {
                    WRAPPED
                },
                tables: [
                    [of("matched-straight")?, of("mismatched-straight")?],
                    [of("matched-manoeuvring")?, of("mismatched-manoeuvring")?],
                ],
                choices,
            })
        };
        let mut open = vec![Choices::default()];
        open.extend(specification().alternatives_of(Some("matched-manoeuvring")));
        // Every form of the fit error is of the same runs.
        open.retain(|choices| choices.chosen("fit-error").is_none());
        Ok(Self {
            scenarios: [
                on_paths("matched-straight", "matched-manoeuvring")?,
                on_paths("mismatched-straight", "mismatched-manoeuvring")?,
            ],
            swept: swept(part(8), effort.seed, progress)?,
            configurations: open.into_iter().map(configuration).collect::<Result<_, _>>()?,
        })
    }

    /// Scenario 1 or 2 on the trajectories with manoeuvres, in either window.
    pub fn manoeuvring(&self, scenario: usize) -> [&Runs; 2] {
        WINDOWS.map(|path| &self.scenarios[scenario - 1][path])
    }

    /// Scenario 1 or 2 on the trajectory without.
    pub fn straight(&self, scenario: usize) -> &Runs {
        &self.scenarios[scenario - 1][0]
    }

    /// How many settings of how many runs the sweeps are, in words.
    pub fn sweep_in_words(&self) -> String {
        let settings = &self.swept[0];
        let all: usize = SweptParameter::ALL
            .iter()
            .map(|parameter| parameter.values().len())
            .sum();
        let runs = settings.first().map_or(0, |(_, runs)| runs.0.len());
        format!(
            "Scenario 3 at {} of its {all} settings, {runs} runs each",
            settings.len()
        )
    }
}

/// The first value of either parameter, then every tenth of q and every fourth of σ_θ.
fn few_settings(trajectory: SweptTrajectory) -> Vec<SweepSetting> {
    let of_parameter = |parameter: SweptParameter| {
        let every = match parameter {
            SweptParameter::NoiseDensity => 10,
            SweptParameter::BearingDegrees => 4,
        };
        let values = (1..).zip(parameter.values());
        let chosen = values.filter(move |(place, _)| *place == 1 || place % every == 0);
        chosen.map(move |(_, value)| SweepSetting {
            trajectory,
            parameter,
            value,
        })
    };
    SweptParameter::ALL.into_iter().flat_map(of_parameter).collect()
}

fn swept(runs: usize, seed: u64, progress: Progress) -> Result<[Vec<(SweepSetting, Runs)>; 3], InvalidChoice> {
    let of = |trajectory: SweptTrajectory, window: &str| {
        let sweep = Sweep::new(&Choices::of("window", window), runs, seed)?;
        let run = |setting: SweepSetting| (setting, Runs(outcomes(&sweep.scenario(&setting), runs, seed, progress)));
        Ok(few_settings(trajectory).into_iter().map(run).collect())
    };
    Ok([
        of(SweptTrajectory::Straight, "toolbox")?,
        of(SweptTrajectory::Manoeuvring, "toolbox")?,
        of(SweptTrajectory::Manoeuvring, "printed")?,
    ])
}

/// Whether the filters of a setting know the noise.
pub fn is_matched(setting: &SweepSetting) -> bool {
    let truth = match setting.parameter {
        SweptParameter::NoiseDensity => NOISE_DENSITY,
        SweptParameter::BearingDegrees => 1.0,
    };
    // Table 3 has hundredths and tenths.
    (setting.value - truth).abs() < 1e-3
}

/// A setting in words: `q = 0.01`.
pub fn setting_in_words(setting: &SweepSetting) -> String {
    match setting.parameter {
        SweptParameter::NoiseDensity => format!("q = {}", setting.value),
        SweptParameter::BearingDegrees => format!("σ_θ = {}°", setting.value),
    }
}

/// The percentage fit error of a filter in one run.
fn fit(outcome: &RunOutcome, filter: usize) -> Option<f64> {
    outcome.fit(FitForm::RootSumSquare, filter)
}

impl Runs {
    /// The mean percentage fit error of a filter, %.
    pub fn fit(&self, filter: usize) -> Estimate {
        self.fit_in(FitForm::RootSumSquare, filter)
    }

    /// The same with another reading of (39).
    pub fn fit_in(&self, form: FitForm, filter: usize) -> Estimate {
        mean(
            &self
                .0
                .iter()
                .filter_map(|run| run.fit(form, filter))
                .collect::<Vec<f64>>(),
        )
    }

    /// That of one filter less that of another, run by run, %.
    pub fn difference(&self, a: usize, b: usize) -> Estimate {
        self.less(a, self, b)
    }

    /// The same of two simulations with the same random numbers.
    pub fn less(&self, a: usize, other: &Self, b: usize) -> Estimate {
        let pairs = self.pairs(a, other, b);
        mean(&pairs.iter().map(|(of_a, of_b)| of_a - of_b).collect::<Vec<f64>>())
    }

    fn pairs(&self, a: usize, other: &Self, b: usize) -> Vec<(f64, f64)> {
        let both = self.0.iter().zip(&other.0);
        both.filter_map(|(run_a, run_b)| Some((fit(run_a, a)?, fit(run_b, b)?)))
            .collect()
    }

    /// The difference of two filters as a part of the second's fit error.
    pub fn part(&self, a: usize, b: usize) -> Estimate {
        let ratio = ratio(&self.pairs(a, self, b));
        Estimate {
            value: ratio.value - 1.0,
            ..ratio
        }
    }

    /// The fit error of a filter here over that in another simulation with the same random numbers.
    pub fn over(&self, other: &Self, filter: usize) -> Estimate {
        ratio(&self.pairs(filter, other, filter))
    }

    /// That ratio less the same of two other simulations with the same random numbers.
    pub fn over_less(&self, over: &Self, others: [&Self; 2], filter: usize) -> Estimate {
        ratio_less(
            &self.pairs(filter, over, filter),
            &others[0].pairs(filter, others[1], filter),
        )
    }

    /// The root mean square position error of a filter in the steps of constant acceleration less that in the others, m.
    pub fn manoeuvre_less_rest(&self, filter: usize) -> Estimate {
        let squares = |kind: usize| {
            let tracks = self.0.iter().filter_map(|run| run.filters[filter]);
            tracks.map(|track| track.mean_squares[kind]).collect::<Vec<f64>>()
        };
        paired_difference(&squares(1), &squares(0))
    }

    /// The standard error that a figure of these runs has over as many as the paper has.
    pub fn error_of_fifty(&self, figure: Estimate) -> f64 {
        figure.standard_error * (self.0.len() as f64 / RUNS as f64).sqrt()
    }
}

/// The ratio of two means, and what each run adds to it to first order.
fn ratio_terms(pairs: &[(f64, f64)]) -> (f64, Vec<f64>) {
    let count = pairs.len() as f64;
    let above = pairs.iter().map(|pair| pair.0).sum::<f64>() / count;
    let below = pairs.iter().map(|pair| pair.1).sum::<f64>() / count;
    let value = above / below;
    (value, pairs.iter().map(|(a, b)| (a - value * b) / below).collect())
}

/// The ratio of two means, with its standard error to first order.
fn ratio(pairs: &[(f64, f64)]) -> Estimate {
    let (value, terms) = ratio_terms(pairs);
    Estimate {
        value,
        standard_error: mean(&terms).standard_error,
    }
}

/// The ratio of two means less another of the same runs, with its standard error to first order.
pub fn ratio_less(pairs: &[(f64, f64)], others: &[(f64, f64)]) -> Estimate {
    let (here, terms) = ratio_terms(pairs);
    let (there, other_terms) = ratio_terms(others);
    let terms = terms.iter().zip(&other_terms).map(|(a, b)| a - b);
    Estimate {
        value: here - there,
        standard_error: mean(&terms.collect::<Vec<f64>>()).standard_error,
    }
}

/// A row of table 4 or 5, IMM-CMKF and IMM-UKF, %.
pub fn published(s: &Specification, table: u32, scenario: usize) -> [f64; 2] {
    let name = ["1st scenario", "2nd scenario"][scenario - 1];
    let rows = s.tables.iter().filter(|t| t.number == table).flat_map(|t| &t.rows);
    let row = rows.into_iter().find(|row| row.name == name);
    row.map_or([f64::NAN; 2], |row| [row.values[0], row.values[1]])
}

/// A figure with its standard error and a unit, in words.
pub fn words(estimate: Estimate, unit: &str) -> String {
    format!("{} ± {}{unit}", figure(estimate.value), figure(estimate.standard_error))
}

/// The same less a limit, for a verdict on being below it.
pub fn less_limit(estimate: Estimate, limit: f64) -> Estimate {
    Estimate {
        value: estimate.value - limit,
        ..estimate
    }
}

/// The opposite, for a verdict on being above.
pub fn opposite(estimate: Estimate) -> Estimate {
    Estimate {
        value: -estimate.value,
        ..estimate
    }
}

/// One clause a trajectory: `toolbox's window …, printed window …`.
pub fn clauses(paths: &[usize], clause: impl Fn(usize) -> String) -> String {
    let clauses = paths.iter().map(|&path| format!("{} {}", PATHS[path], clause(path)));
    clauses.collect::<Vec<String>>().join(", ")
}
