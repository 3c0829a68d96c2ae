//! Questions about the runs of a scenario.
//!
//! A figure comes from the runs: the error of a filter over some steps, the paired difference of two filters, their consistency, or the
//! delay until they notice a change. The judges and the record of [`super::result`] use these.
//!
//! A run in which a step could not be computed is left out of the figures of that filter.

use super::simulation::{Average, Run, Simulation};
use crate::statistics::delay::detection_delays;
use crate::statistics::estimate::{Estimate, mean, paired_difference, root_mean_square};
use crate::statistics::rmse;
use nalgebra::Vector4;
use serde::Serialize;

/// A quantity whose error is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ErrorQuantity {
    /// The position along x, m.
    X,
    /// The velocity along x, m/s.
    VelocityX,
    /// The position along y, m.
    Y,
    /// The velocity along y, m/s.
    VelocityY,
    /// The position, m.
    Position,
    /// The velocity, m/s.
    Velocity,
}

impl ErrorQuantity {
    /// All quantities.
    pub const ALL: [Self; 6] = [
        Self::X,
        Self::VelocityX,
        Self::Y,
        Self::VelocityY,
        Self::Position,
        Self::Velocity,
    ];

    /// The quantity's squared error, from the error of the state [x, ẋ, y, ẏ].
    pub fn squared(self, error: &Vector4<f64>) -> f64 {
        let square = |i: usize| error[i] * error[i];
        match self {
            Self::X => square(0),
            Self::VelocityX => square(1),
            Self::Y => square(2),
            Self::VelocityY => square(3),
            Self::Position => square(0) + square(2),
            Self::Velocity => square(1) + square(3),
        }
    }

    /// The quantity in words, with its unit.
    pub fn label(self) -> &'static str {
        match self {
            Self::X => "x (m)",
            Self::VelocityX => "x velocity (m/s)",
            Self::Y => "y (m)",
            Self::VelocityY => "y velocity (m/s)",
            Self::Position => "position (m)",
            Self::Velocity => "velocity (m/s)",
        }
    }
}

/// The raw runs of a scenario, `[run][contestant]`.
#[derive(Debug, Clone, Copy)]
pub struct Comparison<'a> {
    /// The scenario.
    pub scenario: &'a dyn Simulation,
    /// The runs.
    pub runs: &'a [Vec<Run>],
}

impl Comparison<'_> {
    /// The number of steps of a run.
    pub(super) fn steps(&self) -> usize {
        self.scenario.motions().len()
    }

    /// The runs that all the given contestants completed.
    pub(super) fn completed(&self, contestants: &[usize]) -> Vec<&Vec<Run>> {
        let complete = |run: &&Vec<Run>| contestants.iter().all(|&c| run[c].failure.is_none());
        self.runs.iter().filter(complete).collect()
    }

    /// The mean squared error of each run over the steps that are chosen, one number a run; linearised about RMSE(k) when the
    /// average is the plain mean over steps, so that its root is that mean and its spread is right to first order.
    fn mean_squares(
        &self,
        runs: &[&Vec<Run>],
        contestant: usize,
        quantity: ErrorQuantity,
        chosen: &dyn Fn(usize) -> bool,
    ) -> Vec<f64> {
        let steps: Vec<usize> = (0..self.steps()).filter(|k| chosen(*k)).collect();
        let count = steps.len() as f64;
        let squared = |run: &Vec<Run>, k: usize| quantity.squared(&run[contestant].errors[k]);
        match self.scenario.average() {
            Average::RootMeanSquare => {
                let of_run = |run: &&Vec<Run>| steps.iter().map(|&k| squared(run, k)).sum::<f64>() / count;
                runs.iter().map(of_run).collect()
            }
            Average::Mean => {
                let at_step = |k: usize| {
                    let squares: Vec<f64> = runs.iter().map(|run| squared(run, k)).collect();
                    rmse::root_mean_square(&squares)
                };
                let rmses: Vec<f64> = steps.iter().map(|&k| at_step(k)).collect();
                let figure = rmses.iter().sum::<f64>() / count;
                // d(mean of RMSE)/d(square of a run at k) = 1/(2 RMSE(k)): the same as for √s̄ with s = figure · Σ e²/RMSE(k).
                let of_run = |run: &&Vec<Run>| {
                    let terms = steps.iter().zip(&rmses).map(|(&k, rmse)| squared(run, k) / rmse);
                    figure * terms.sum::<f64>() / count
                };
                runs.iter().map(of_run).collect()
            }
        }
    }

    /// The overall error of a contestant.
    pub fn error(&self, contestant: usize, quantity: ErrorQuantity) -> Estimate {
        self.error_over(contestant, quantity, &|_| true)
    }

    /// The error of a contestant over some of the steps, counted from 0.
    pub fn error_over(&self, contestant: usize, quantity: ErrorQuantity, chosen: &dyn Fn(usize) -> bool) -> Estimate {
        let runs = self.completed(&[contestant]);
        root_mean_square(&self.mean_squares(&runs, contestant, quantity, chosen))
    }

    /// The error of contestant `a` minus that of contestant `b`, paired run by run.
    pub fn difference(&self, a: usize, b: usize, quantity: ErrorQuantity) -> Estimate {
        self.difference_over(a, b, quantity, &|_| true)
    }

    /// As [`Comparison::difference`], over some of the steps, counted from 0.
    pub fn difference_over(
        &self,
        a: usize,
        b: usize,
        quantity: ErrorQuantity,
        chosen: &dyn Fn(usize) -> bool,
    ) -> Estimate {
        let runs = self.completed(&[a, b]);
        paired_difference(
            &self.mean_squares(&runs, a, quantity, chosen),
            &self.mean_squares(&runs, b, quantity, chosen),
        )
    }

    /// The mean of a contestant's percentage fit errors, one a run; none where the paper has no such measure.
    pub fn fit_error(&self, contestant: usize) -> Option<Estimate> {
        let runs = self.completed(&[contestant]);
        let of_runs: Option<Vec<f64>> = runs.iter().map(|run| run[contestant].fit_error).collect();
        of_runs
            .filter(|of_runs| !of_runs.is_empty())
            .map(|of_runs| mean(&of_runs))
    }

    /// The mean over runs of one contestant's percentage fit error less another's; none where the paper has no such measure.
    pub fn fit_difference(&self, a: usize, b: usize) -> Option<Estimate> {
        let runs = self.completed(&[a, b]);
        let of_run = |run: &&Vec<Run>| Some(run[a].fit_error? - run[b].fit_error?);
        let of_runs: Option<Vec<f64>> = runs.iter().map(of_run).collect();
        of_runs
            .filter(|of_runs| !of_runs.is_empty())
            .map(|of_runs| mean(&of_runs))
    }

    /// RMSE(k) of a contestant at every step, each with its standard error over the runs.
    pub fn rmse(&self, contestant: usize, quantity: ErrorQuantity) -> Vec<Estimate> {
        let runs = self.completed(&[contestant]);
        let at_step = |k: usize| {
            let squared = |run: &&Vec<Run>| quantity.squared(&run[contestant].errors[k]);
            let squares: Vec<f64> = runs.iter().map(squared).collect();
            root_mean_square(&squares)
        };
        (0..self.steps()).map(at_step).collect()
    }

    /// The greatest difference of two contestants' estimates of a state, component by component, over all steps of all runs; they
    /// must have seen the same draws.
    pub fn greatest_estimate_difference(&self, a: usize, b: usize) -> Vector4<f64> {
        let mut greatest = Vector4::zeros();
        for run in self.completed(&[a, b]) {
            for (error_a, error_b) in run[a].errors.iter().zip(&run[b].errors) {
                greatest = greatest.sup(&(error_a - error_b).abs());
            }
        }
        greatest
    }

    /// The greatest difference of two contestants' mode probabilities over all steps of all runs.
    pub fn greatest_probability_difference(&self, a: usize, b: usize) -> f64 {
        let mut greatest: f64 = 0.0;
        for run in self.completed(&[a, b]) {
            let steps = run[a].mode_probabilities.iter().zip(&run[b].mode_probabilities);
            for (p, q) in steps.flat_map(|(step_a, step_b)| step_a.iter().zip(step_b)) {
                greatest = greatest.max((p - q).abs());
            }
        }
        greatest
    }

    /// The mean of all NEES values, and of all NIS values, of a contestant, each with its standard error from run to run.
    pub fn consistency(&self, contestant: usize) -> (Estimate, Estimate) {
        let runs = self.completed(&[contestant]);
        let mean_of = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let nees: Vec<f64> = runs.iter().map(|run| mean_of(&run[contestant].nees)).collect();
        let nis: Vec<f64> = runs.iter().map(|run| mean_of(&run[contestant].nis)).collect();
        (mean(&nees), mean(&nis))
    }

    /// The greatest position error of a contestant at any step of any run, m.
    pub fn greatest_position_error(&self, contestant: usize) -> f64 {
        let runs = self.runs.iter().flat_map(|run| &run[contestant].errors);
        runs.map(|error| ErrorQuantity::Position.squared(error).sqrt())
            .fold(0.0, f64::max)
    }

    /// The mode of a contestant that models the truth at each step; none when it has no such mode.
    pub fn true_modes(&self, contestant: usize) -> Option<Vec<usize>> {
        let modes = &self.scenario.filters()[contestant].modes;
        let of_motion = |name: &str| modes.iter().position(|mode| mode == name);
        self.scenario.motions().into_iter().map(of_motion).collect()
    }

    /// The delay of detection of each change of motion, `[change][run]`, in steps; empty for a filter of one mode.
    pub fn delays(&self, contestant: usize) -> Vec<Vec<Option<usize>>> {
        let Some(true_modes) = self.true_modes(contestant) else {
            return Vec::new();
        };
        let runs = self.completed(&[contestant]);
        let of_run = |run: &&Vec<Run>| detection_delays(&true_modes, &run[contestant].mode_probabilities);
        let by_run: Vec<Vec<Option<usize>>> = runs.iter().map(of_run).collect();
        let changes = by_run.first().map_or(0, Vec::len);
        let of_change = |change: usize| by_run.iter().map(|delays| delays[change]).collect();
        (0..changes).map(of_change).collect()
    }

    /// The mean over runs of a contestant's mode probabilities with its standard error, `[step][mode]`.
    pub fn mean_mode_probabilities(&self, contestant: usize) -> Vec<Vec<Estimate>> {
        let runs = self.completed(&[contestant]);
        let modes = self.scenario.filters()[contestant].modes.len();
        let at = |k: usize, j: usize| {
            let of_run = |run: &&Vec<Run>| run[contestant].mode_probabilities[k][j];
            mean(&runs.iter().map(of_run).collect::<Vec<f64>>())
        };
        let steps = 0..self.steps();
        steps.map(|k| (0..modes).map(|j| at(k, j)).collect()).collect()
    }
}
