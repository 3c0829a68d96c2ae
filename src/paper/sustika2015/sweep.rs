//! Scenario 3: the filters' noise parameters, varied one at a time.
//!
//! The sweep covers the settings of table 3 and writes the answers at each setting as a table. The truth and the measurements of a run
//! depend only on the seed and the run. All settings and all filters see the same data, so differences between filters are paired run by
//! run. A run is called divergent if its percentage fit error exceeds [`DIVERGENT_FIT_ERROR`]. Its measured bearings jump if two
//! successive ones differ by more than π.

use super::contestants::RadarSetup;
use super::outcome::{RunOutcome, outcomes};
use super::scenario::RadarScenario;
use super::{DEGREE, DIVERGENT_FIT_ERROR, SWEPT_BEARING_DEGREES, SWEPT_NOISE_DENSITIES};
use crate::paper::monte_carlo::Progress;
use crate::paper::specification::{Choices, InvalidChoice};
use crate::statistics::Estimate;
use crate::statistics::estimate::mean;
use crate::statistics::fit_error::FitForm;
use serde::Serialize;
use std::fmt::Write as _;

/// A trajectory of the paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SweptTrajectory {
    /// Without manoeuvres.
    Straight,
    /// With manoeuvres.
    Manoeuvring,
}

impl SweptTrajectory {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Straight, Self::Manoeuvring];

    /// The name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Straight => "straight",
            Self::Manoeuvring => "manoeuvring",
        }
    }
}

/// Which of the filters' noise parameters is varied; the other is the truth's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SweptParameter {
    /// q of both modes.
    NoiseDensity,
    /// σ_θ in degrees.
    BearingDegrees,
}

impl SweptParameter {
    /// Both, in the order of table 3.
    pub const ALL: [Self; 2] = [Self::NoiseDensity, Self::BearingDegrees];

    /// The name.
    pub fn name(self) -> &'static str {
        match self {
            Self::NoiseDensity => "noise-density",
            Self::BearingDegrees => "bearing-degrees",
        }
    }

    /// The values of table 3.
    pub fn values(self) -> Vec<f64> {
        let [_, last, interval] = match self {
            Self::NoiseDensity => SWEPT_NOISE_DENSITIES,
            Self::BearingDegrees => SWEPT_BEARING_DEGREES,
        };
        // Both begin with their interval: whole multiples of it. Quotients of integers are the doubles nearest to the decimals.
        let count = (last / interval).round();
        let parts = (1.0 / interval).round();
        std::iter::successors(Some(1.0), |k| Some(k + 1.0).filter(|next| *next <= count))
            .map(|k| k / parts)
            .collect()
    }

    /// The parameters that the filters assume, with another value of this one.
    fn set(self, setup: &RadarSetup, value: f64) -> RadarSetup {
        let mut setup = setup.clone();
        match self {
            Self::NoiseDensity => setup.noise_density = value,
            Self::BearingDegrees => setup.deviations[1] = value * DEGREE,
        }
        setup
    }
}

/// A setting of the sweep.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SweepSetting {
    /// The trajectory.
    pub trajectory: SweptTrajectory,
    /// What is varied.
    pub parameter: SweptParameter,
    /// Its value, m²/s³ and m²/s⁵, or degrees.
    pub value: f64,
}

/// All settings of scenario 3, in the order in which they are run.
pub fn settings() -> Vec<SweepSetting> {
    let mut settings = Vec::new();
    for trajectory in SweptTrajectory::ALL {
        for parameter in SweptParameter::ALL {
            settings.extend(parameter.values().into_iter().map(|value| SweepSetting {
                trajectory,
                parameter,
                value,
            }));
        }
    }
    settings
}

/// The filters of the sweep: the paper's two, and the second with bearings that are never wrapped.
pub const FILTERS: [&str; 3] = ["IMM-CMKF", "IMM-UKF", "IMM-UKF, never wrapped"];

/// What the runs of one filter show at one setting.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Fit {
    /// The mean of the runs' percentage fit errors, with its standard error, %.
    pub mean: Estimate,
    /// Their median, %.
    pub median: f64,
    /// The divergent runs.
    pub divergent: usize,
    /// Those of them whose measured bearings jump.
    pub divergent_with_jump: usize,
    /// The runs in which a step could not be computed; they are left out of all other figures.
    pub failed: usize,
}

/// What the runs show at one setting.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SweepPoint {
    /// The runs whose measured bearings jump.
    pub runs_with_jump: usize,
    /// Of each of [`FILTERS`].
    pub fits: [Fit; 3],
    /// IMM-UKF less IMM-CMKF, the mean of the runs' differences, %.
    pub unscented_less_converted: Estimate,
    /// IMM-UKF never wrapped less IMM-CMKF, %.
    pub plain_less_converted: Estimate,
}

/// The runs of a scenario with [`FILTERS`] instead of its own filters.
pub fn point(scenario: &RadarScenario, runs: usize, seed: u64, progress: Progress) -> SweepPoint {
    SweepPoint::of(&outcomes(scenario, runs, seed, progress), scenario.fit_form)
}

impl SweepPoint {
    /// What the outcomes show.
    pub fn of(outcomes: &[RunOutcome], form: FitForm) -> Self {
        Self {
            runs_with_jump: outcomes.iter().filter(|outcome| outcome.jumps).count(),
            fits: [0, 1, 2].map(|filter| fit(outcomes, form, filter)),
            unscented_less_converted: difference(outcomes, form, 1, 0),
            plain_less_converted: difference(outcomes, form, 2, 0),
        }
    }
}

/// What the outcomes show of one filter.
fn fit(outcomes: &[RunOutcome], form: FitForm, filter: usize) -> Fit {
    let completed = outcomes
        .iter()
        .filter_map(|outcome| Some((outcome.jumps, outcome.fit(form, filter)?)));
    let fits: Vec<f64> = completed.clone().map(|(_, fit)| fit).collect();
    let divergent = || completed.clone().filter(|(_, fit)| *fit > DIVERGENT_FIT_ERROR);
    Fit {
        mean: mean(&fits),
        median: median(&fits),
        divergent: divergent().count(),
        divergent_with_jump: divergent().filter(|(jumps, _)| *jumps).count(),
        failed: outcomes.len() - fits.len(),
    }
}

/// The mean over runs of one filter's fit error less another's.
fn difference(outcomes: &[RunOutcome], form: FitForm, a: usize, b: usize) -> Estimate {
    let of_run = |outcome: &RunOutcome| Some(outcome.fit(form, a)? - outcome.fit(form, b)?);
    mean(&outcomes.iter().filter_map(of_run).collect::<Vec<f64>>())
}

/// The value in the middle, or the mean of the two there.
fn median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => f64::NAN,
        odd if odd % 2 == 1 => values[middle],
        _ => f64::midpoint(values[middle - 1], values[middle]),
    }
}

/// The sweep under some choices.
#[derive(Debug, Clone)]
pub struct Sweep {
    /// The choices that differ from the defaults.
    pub choices: Choices,
    /// The number of runs at each setting.
    pub runs: usize,
    /// The seed of the random numbers.
    pub seed: u64,
    straight: RadarScenario,
    manoeuvring: RadarScenario,
}

impl Sweep {
    /// A sweep; the choices are those of the paper's simulations but for `scenario` and `wrapping`, of which it runs all.
    ///
    /// # Errors
    ///
    /// [`InvalidChoice`] for a parameter or an alternative that there is not, and for a choice of these two.
    pub fn new(choices: &Choices, runs: usize, seed: u64) -> Result<Self, InvalidChoice> {
        if let Some(parameter) = ["scenario", "wrapping"]
            .into_iter()
            .find(|name| choices.chosen(name).is_some())
        {
            return Err(InvalidChoice::Swept {
                parameter: parameter.to_owned(),
            });
        }
        let of = |scenario: &str| super::scenario(&choices.clone().with("scenario", scenario));
        Ok(Self {
            choices: choices.clone(),
            runs,
            seed,
            straight: of("matched-straight")?,
            manoeuvring: of("matched-manoeuvring")?,
        })
    }

    /// The scenario of a setting.
    pub fn scenario(&self, setting: &SweepSetting) -> RadarScenario {
        let scenario = match setting.trajectory {
            SweptTrajectory::Straight => &self.straight,
            SweptTrajectory::Manoeuvring => &self.manoeuvring,
        };
        RadarScenario {
            setup: setting.parameter.set(&scenario.setup, setting.value),
            ..scenario.clone()
        }
    }

    /// The runs at one setting.
    pub fn point(&self, setting: &SweepSetting, progress: Progress) -> SweepPoint {
        point(&self.scenario(setting), self.runs, self.seed, progress)
    }

    /// All settings, in their order.
    pub fn run(&self, progress: Progress) -> Vec<(SweepSetting, SweepPoint)> {
        let settings = settings().into_iter();
        settings
            .map(|setting| (setting, self.point(&setting, progress)))
            .collect()
    }

    /// The points as comma-separated text: a line that names the format, the seed, the number of runs and the choices; the names of the
    /// columns; a line a setting. Numbers are the shortest decimals that are read back to the same double.
    ///
    /// ```text
    /// # immaculate-sweep/1; seed 1; runs 50; choices defaults
    /// trajectory,parameter,value,runs_with_jump,cmkf_mean,…
    /// straight,noise-density,0.01,12,1.8…,…
    /// ```
    pub fn csv(&self, points: &[(SweepSetting, SweepPoint)]) -> String {
        let Self { seed, runs, .. } = self;
        let mut text = format!(
            "# {FORMAT}; seed {seed}; runs {runs}; choices {}\n",
            self.choices.describe()
        );
        text.push_str(&columns());
        text.push('\n');
        for (setting, point) in points {
            text.push_str(&line(setting, point));
            text.push('\n');
        }
        text
    }
}

/// The name and the version of the format of [`Sweep::csv`].
const FORMAT: &str = "immaculate-sweep/1";

/// The names of the columns.
pub fn columns() -> String {
    let mut names = String::from("trajectory,parameter,value,runs_with_jump");
    for filter in ["cmkf", "ukf", "plain_ukf"] {
        for what in [
            "mean",
            "standard_error",
            "median",
            "divergent",
            "divergent_with_jump",
            "failed",
        ] {
            let _ = write!(names, ",{filter}_{what}");
        }
    }
    for difference in ["ukf_minus_cmkf", "plain_ukf_minus_cmkf"] {
        let _ = write!(names, ",{difference},{difference}_standard_error");
    }
    names
}

/// A setting and its point as a line.
pub fn line(setting: &SweepSetting, point: &SweepPoint) -> String {
    let (trajectory, parameter) = (setting.trajectory.name(), setting.parameter.name());
    let mut line = format!("{trajectory},{parameter},{:?},{}", setting.value, point.runs_with_jump);
    for fit in &point.fits {
        let Fit {
            mean,
            median,
            divergent,
            divergent_with_jump,
            failed,
        } = fit;
        let _ = write!(
            line,
            ",{:?},{:?},{median:?},{divergent},{divergent_with_jump},{failed}",
            mean.value, mean.standard_error
        );
    }
    for difference in [point.unscented_less_converted, point.plain_less_converted] {
        let _ = write!(line, ",{:?},{:?}", difference.value, difference.standard_error);
    }
    line
}
