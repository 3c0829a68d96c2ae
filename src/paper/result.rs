//! The results of a scenario's runs, as a record.
//!
//! A reproduced table is printed or written as JSON from a [`Reproduction`], the list of the answers of [`Comparison`].
//!
//! A run in which a step could not be computed is counted and named, and is left out of the error figures of that filter.

use super::comparison::{Comparison, ErrorQuantity};
use super::simulation::Run;
use super::simulation::{Path, Simulation};
use super::specification::Choices;
use crate::statistics::consistency::bounds;
use crate::statistics::estimate::{Estimate, MedianRatio, median_ratio};
use serde::Serialize;

/// What a row of a published table is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Figure {
    /// The overall error of a quantity.
    Error(ErrorQuantity),
    /// The percentage fit error of the position.
    FitError,
}

/// Everything that a reproduction prints.
#[derive(Debug, Clone, Serialize)]
pub struct Reproduction {
    /// The paper's key.
    pub paper: &'static str,
    /// The choices that differ from the defaults.
    pub choices: Choices,
    /// The number of runs.
    pub runs: usize,
    /// The number of steps of a run.
    pub steps: usize,
    /// The times of the steps, s.
    pub times: Vec<f64>,
    /// The seed of the random numbers.
    pub seed: u64,
    /// What the truth does at each step.
    pub motions: Vec<&'static str>,
    /// What each filter did.
    pub filters: Vec<Performance>,
    /// Paired differences of the filters' overall errors.
    pub differences: Vec<Difference>,
    /// Those of their percentage fit errors, where the paper has this measure.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub fit_differences: Vec<FitDifference>,
    /// The first run, where the filters have one in common.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first_run: Option<FirstRun>,
}

/// Positions of the first run, [x, y] at each step.
#[derive(Debug, Clone, Serialize)]
pub struct FirstRun {
    /// The true ones.
    pub truth: Vec<[f64; 2]>,
    /// The measured ones.
    pub measured: Vec<[f64; 2]>,
    /// The estimated ones of each filter, as far as it came.
    pub estimates: Vec<Vec<[f64; 2]>>,
    /// Where the sensor is, if it is anywhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sensor: Option<[f64; 2]>,
}

/// What one filter did.
#[derive(Debug, Clone, Serialize)]
pub struct Performance {
    /// The paper's name for the filter.
    pub name: String,
    /// The names of its modes.
    pub modes: Vec<String>,
    /// The points of its rule; none for a Kalman filter.
    pub points: Option<usize>,
    /// Those with a weight other than zero.
    pub effective_points: Option<usize>,
    /// The runs that were computed to their end.
    pub completed_runs: usize,
    /// The steps that could not be computed.
    pub failures: Vec<FailedRun>,
    /// Overall errors.
    pub errors: Vec<ErrorFigure>,
    /// The mean percentage fit error of the position, where the paper has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fit_error: Option<Estimate>,
    /// RMSE(k).
    pub rmse: Vec<ErrorHistory>,
    /// Mean mode probabilities, `[step][mode]`.
    pub mode_probabilities: Vec<Vec<f64>>,
    /// Their standard errors.
    pub mode_probability_standard_errors: Vec<Vec<f64>>,
    /// Consistency with the truth: the expectation for a matched filter is the number of components of the state.
    pub nees: Consistency,
    /// Consistency with the measurements: the expectation for a matched filter is the number of components of the measurement.
    pub nis: Consistency,
    /// Delay of detection of each change of motion.
    pub delays: Vec<Delay>,
    /// Mean time spent in the filter's steps, microseconds a step. The only figure that differs from run to run.
    pub microseconds_per_step: f64,
    /// The time of a run beside that of the first filter in the same run; not in files, as no two are alike.
    #[serde(skip)]
    pub time_ratio: Option<MedianRatio>,
}

/// A run that ended early.
#[derive(Debug, Clone, Serialize)]
pub struct FailedRun {
    /// The run, counted from 1.
    pub run: usize,
    /// Step, mode, equation and cause.
    pub failure: String,
}

/// An overall error.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct ErrorFigure {
    /// Of what.
    pub quantity: ErrorQuantity,
    /// The root-mean-square error with its standard error.
    #[serde(flatten)]
    pub estimate: Estimate,
}

/// An error over time.
#[derive(Debug, Clone, Serialize)]
pub struct ErrorHistory {
    /// Of what.
    pub quantity: ErrorQuantity,
    /// RMSE(k), one a step.
    pub values: Vec<f64>,
    /// Their standard errors over the runs.
    pub standard_errors: Vec<f64>,
}

/// A normalised squared error against its bounds.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Consistency {
    /// Mean over steps and runs, with its standard error from run to run.
    #[serde(flatten)]
    pub mean: Estimate,
    /// The expectation for a matched filter.
    pub expected: f64,
    /// The 95 % interval of the mean over runs at one step, for a matched filter.
    pub bounds: (f64, f64),
    /// The part of the steps whose mean over runs is inside the interval; about 0.95 for a matched filter.
    pub inside: f64,
}

/// A change of motion and how late it was noticed.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Delay {
    /// The time of the first step of the new motion, s.
    pub time: f64,
    /// The runs in which the true mode became more likely than not before the next change.
    pub detected: usize,
    /// Mean delay of these, s.
    pub mean: f64,
    /// Greatest delay of these, s.
    pub greatest: f64,
}

/// A paired difference.
#[derive(Debug, Clone, Serialize)]
pub struct Difference {
    /// The filter whose error comes first.
    pub filter: String,
    /// The filter whose error is subtracted.
    pub minus: String,
    /// Of what.
    pub quantity: ErrorQuantity,
    /// The difference with its standard error.
    #[serde(flatten)]
    pub estimate: Estimate,
}

/// A paired difference of percentage fit errors, %.
#[derive(Debug, Clone, Serialize)]
pub struct FitDifference {
    /// The filter whose error comes first.
    pub filter: String,
    /// The filter whose error is subtracted.
    pub minus: String,
    /// The difference with its standard error.
    #[serde(flatten)]
    pub estimate: Estimate,
}

/// The probability with which a matched filter's mean is outside the bounds of [`Consistency`] at one step.
pub const FALSE_ALARM: f64 = 0.05;

impl Reproduction {
    /// All figures of the runs.
    pub fn new(scenario: &dyn Simulation, runs: usize, seed: u64, results: &[Vec<Run>]) -> Self {
        let comparison = Comparison {
            scenario,
            runs: results,
        };
        let filters = scenario.filters();
        let (mut differences, mut fit_differences) = (Vec::new(), Vec::new());
        for a in 0..filters.len() {
            for b in a + 1..filters.len() {
                for quantity in [ErrorQuantity::Position, ErrorQuantity::Velocity] {
                    differences.push(Difference {
                        filter: filters[a].name.clone(),
                        minus: filters[b].name.clone(),
                        quantity,
                        estimate: comparison.difference(a, b, quantity),
                    });
                }
                fit_differences.extend(comparison.fit_difference(a, b).map(|estimate| FitDifference {
                    filter: filters[a].name.clone(),
                    minus: filters[b].name.clone(),
                    estimate,
                }));
            }
        }
        Self {
            paper: scenario.paper(),
            choices: scenario.choices().clone(),
            runs,
            steps: scenario.motions().len(),
            times: scenario.times(),
            seed,
            motions: scenario.motions(),
            filters: (0..filters.len()).map(|c| performance(&comparison, c)).collect(),
            differences,
            fit_differences,
            first_run: scenario.first_path(seed).map(|path| first_run(&path, results)),
        }
    }

    /// Whether a mode models what the target does in a step, counted from 0.
    pub fn is_true(&self, mode: &str, step: usize) -> bool {
        self.motions[step].split(", ").any(|motion| motion == mode)
    }

    /// The overall error of a filter in a quantity.
    pub fn error(&self, filter: &str, quantity: ErrorQuantity) -> Option<Estimate> {
        let filter = self.filters.iter().find(|performance| performance.name == filter)?;
        let figure = filter.errors.iter().find(|figure| figure.quantity == quantity)?;
        Some(figure.estimate)
    }

    /// A figure of a published table, as computed for a filter.
    pub fn figure(&self, filter: &str, figure: Figure) -> Option<Estimate> {
        match figure {
            Figure::Error(quantity) => self.error(filter, quantity),
            Figure::FitError => {
                self.filters
                    .iter()
                    .find(|performance| performance.name == filter)?
                    .fit_error
            }
        }
    }
}

/// The positions of the first run: what a filter estimated is the truth and its error.
fn first_run(path: &Path, results: &[Vec<Run>]) -> FirstRun {
    let of_filter = |run: &Run| {
        let steps = path.truth.iter().zip(&run.errors);
        steps
            .map(|(truth, error)| [truth[0] + error[0], truth[1] + error[2]])
            .collect()
    };
    FirstRun {
        truth: path.truth.iter().map(|position| [position[0], position[1]]).collect(),
        measured: path
            .measured
            .iter()
            .map(|position| [position[0], position[1]])
            .collect(),
        estimates: results.first().into_iter().flatten().map(of_filter).collect(),
        sensor: path.sensor,
    }
}

fn performance(comparison: &Comparison, c: usize) -> Performance {
    let filter = comparison.scenario.filters().swap_remove(c);
    let (state_components, measured_components) = comparison.scenario.components();
    let of_contestant = || comparison.runs.iter().map(|run| &run[c]);
    let failures = of_contestant()
        .enumerate()
        .filter_map(|(run, result)| {
            result.failure.as_ref().map(|failure| FailedRun {
                run: run + 1,
                failure: failure.to_string(),
            })
        })
        .collect::<Vec<_>>();
    let steps: usize = of_contestant().map(|run| run.errors.len()).sum();
    // Of the steps that were computed, which are fewer in a run that failed.
    let times_of = |c: usize| -> Vec<f64> {
        let time = |run: &Vec<Run>| run[c].time.as_secs_f64() / run[c].errors.len().max(1) as f64;
        comparison.runs.iter().map(time).collect()
    };
    let seconds: f64 = of_contestant().map(|run| run.time.as_secs_f64()).sum();
    let (nees, nis) = comparison.consistency(c);
    let error = |quantity| ErrorFigure {
        quantity,
        estimate: comparison.error(c, quantity),
    };
    let history = |quantity| {
        let (values, standard_errors) = apart(&comparison.rmse(c, quantity));
        ErrorHistory {
            quantity,
            values,
            standard_errors,
        }
    };
    let probabilities = comparison.mean_mode_probabilities(c);
    let (mode_probabilities, mode_probability_standard_errors) = probabilities.iter().map(|step| apart(step)).unzip();
    Performance {
        name: filter.name,
        modes: filter.modes,
        points: filter.points.map(|(points, _)| points),
        effective_points: filter.points.map(|(_, effective)| effective),
        completed_runs: comparison.runs.len() - failures.len(),
        failures,
        errors: ErrorQuantity::ALL.into_iter().map(error).collect(),
        fit_error: comparison.fit_error(c),
        rmse: ErrorQuantity::ALL.into_iter().map(history).collect(),
        mode_probabilities,
        mode_probability_standard_errors,
        nees: consistency(comparison, c, nees, state_components, |run| &run.nees),
        nis: consistency(comparison, c, nis, measured_components, |run| &run.nis),
        delays: delays(comparison, c),
        microseconds_per_step: 1e6 * seconds / steps as f64,
        time_ratio: median_ratio(&times_of(c), &times_of(0)),
    }
}

/// Figures, and their standard errors.
fn apart(estimates: &[Estimate]) -> (Vec<f64>, Vec<f64>) {
    let pair = |estimate: &Estimate| (estimate.value, estimate.standard_error);
    estimates.iter().map(pair).unzip()
}

/// The mean of a normalised squared error, and how often its mean over runs is inside the bounds of a matched filter.
fn consistency(
    comparison: &Comparison,
    contestant: usize,
    mean: Estimate,
    expected: f64,
    values: fn(&Run) -> &Vec<f64>,
) -> Consistency {
    let runs = comparison.completed(&[contestant]);
    let steps = comparison.steps();
    if runs.is_empty() {
        return Consistency {
            mean,
            expected,
            bounds: (f64::NAN, f64::NAN),
            inside: f64::NAN,
        };
    }
    let bounds = bounds(expected, runs.len(), FALSE_ALARM);
    let mean_at = |k: usize| runs.iter().map(|run| values(&run[contestant])[k]).sum::<f64>() / runs.len() as f64;
    let inside = (0..steps)
        .filter(|&k| (bounds.0..=bounds.1).contains(&mean_at(k)))
        .count();
    Consistency {
        mean,
        expected,
        bounds,
        inside: inside as f64 / steps as f64,
    }
}

fn delays(comparison: &Comparison, contestant: usize) -> Vec<Delay> {
    let (motions, times) = (comparison.scenario.motions(), comparison.scenario.times());
    let changes = (1..motions.len()).filter(|&k| motions[k] != motions[k - 1]);
    let delays = comparison.delays(contestant);
    let interval = comparison.scenario.interval();
    changes
        .zip(&delays)
        .map(|(k, of_runs)| {
            let detected: Vec<f64> = of_runs.iter().flatten().map(|steps| *steps as f64 * interval).collect();
            Delay {
                time: times[k],
                detected: detected.len(),
                mean: detected.iter().sum::<f64>() / detected.len() as f64,
                greatest: detected.iter().copied().fold(f64::NAN, f64::max),
            }
        })
        .collect()
}
