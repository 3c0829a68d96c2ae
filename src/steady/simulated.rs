//! The long-term error of the IMM filter from simulation, and the grids of the two figures of derbez2000.
//!
//! The algorithm of [`super::long_term`] is measured against it. The answer can depend on the start of the run: a filter that starts at
//! the truth, and one for which the manoeuvre begins with the run, need not end the same way.

use super::long_term::{Form, Setting, predict};
use crate::filter::Filter;
use crate::gaussian::Gaussian;
use crate::imm::{Failure, Imm, Initial, Interaction, InvalidProblem, Problem};
use crate::model::Sensor;
use crate::model::acceleration::{constant_acceleration, modes, position_matrix};
use crate::number::Real;
use nalgebra::{Matrix1, Matrix3, U1, U3, Vector1, Vector3};
use rayon::prelude::*;

/// How the simulated filter begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// Both filters at the truth, acceleration included.
    AtTheTruth,
    /// Both filters at the truth of a target that has moved without acceleration so far, constant velocity almost certain: the manoeuvre
    /// begins with the run.
    BeforeTheManoeuvre,
}

/// What a simulation shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulated {
    /// The mean of e eᵀ of the combined estimate over the points.
    pub error: Matrix3<f64>,
    /// The mean probability of constant velocity.
    pub probability: f64,
}

impl Simulated {
    /// The total error, its trace.
    pub fn total(&self) -> f64 {
        self.error.trace()
    }
}

/// The number of points over which the paper averages.
pub const POINTS: usize = 800;
/// Steps before the first of them: the filters have some ten steps of memory.
const SETTLING: usize = 100;

/// Why there is no simulation.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotSimulated {
    /// The setting is no problem of the filter.
    #[error(transparent)]
    Invalid(#[from] InvalidProblem),
    /// A step could not be computed.
    #[error(transparent)]
    Failed(#[from] Failure),
}

/// The IMM filter on a target of constant acceleration, averaged over [`POINTS`] points.
///
/// `noise` gives the standard normal numbers of the measurements.
///
/// # Errors
///
/// [`NotSimulated`] when the setting is not valid or a step fails.
pub fn simulate(setting: &Setting, start: Start, mut noise: impl FnMut() -> f64) -> Result<Simulated, NotSimulated> {
    let problem = imm_problem(setting);
    let motion = constant_acceleration(&setting.interval);
    let mut truth = Vector3::new(0.0, 0.0, setting.acceleration);
    let (seen, probabilities) = match start {
        Start::AtTheTruth => (truth, vec![0.5, 0.5]),
        Start::BeforeTheManoeuvre => (Vector3::zeros(), vec![0.99, 0.01]),
    };
    let initial = Initial {
        modes: vec![
            Gaussian {
                mean: seen,
                covariance: Matrix3::identity()
            };
            2
        ],
        mode_probabilities: probabilities,
    };
    let mut filter = Imm::new(problem, &initial)?;
    let deviation = Real::sqrt(&setting.measurement_variance);
    let (mut error, mut probability) = (Matrix3::zeros(), 0.0);
    for step in 0..SETTLING + POINTS {
        truth = motion * truth;
        let z = Vector1::new(truth[0] + deviation * noise());
        let step_record = filter.step(Some(&z))?;
        if step >= SETTLING {
            let off = truth - step_record.combined.mean;
            error += off * off.transpose() / POINTS as f64;
            probability += step_record.mode_probabilities[0] / POINTS as f64;
        }
    }
    Ok(Simulated { error, probability })
}

/// The problem of the IMM filter.
fn imm_problem(setting: &Setting) -> Problem<f64, U3, U1> {
    Problem {
        modes: modes(&setting.interval, &setting.noises).to_vec(),
        chain: setting.chain(),
        sensor: Sensor::Linear(position_matrix()),
        measurement_noise: Matrix1::new(setting.measurement_variance),
        filters: vec![Filter::kalman()],
        interaction: Interaction::Imm,
        angles: vec![],
    }
}

/// One of the paper's two figures: the settings of its grid, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// What varies from row to row, with its unit.
    pub rows_are: &'static str,
    /// The rows' values.
    pub rows: Vec<f64>,
    /// The columns' values: a, m/s².
    pub columns: Vec<f64>,
    /// The settings, row by row.
    pub settings: Vec<Setting>,
}

/// 0, 5, …, 95.
fn accelerations() -> Vec<f64> {
    (0..20).map(|k| f64::from(5 * k)).collect()
}

impl Grid {
    /// Figure 1: both process noises 5, R from 0.05 to 0.5, a from 0 to 95. The spacing is not printed.
    ///
    /// Source: derbez2000, figure 1.
    ///
    /// Example: ten rows of twenty columns.
    ///
    /// ```
    /// use immaculate::steady::simulated::Grid;
    ///
    /// let grid = Grid::figure_1(2.0);
    /// assert_eq!((grid.rows.len(), grid.columns.len(), grid.settings.len()), (10, 20, 200));
    /// assert_eq!((grid.settings[1].measurement_variance, grid.settings[1].acceleration), (0.05, 5.0));
    /// ```
    pub fn figure_1(interval: f64) -> Self {
        let rows: Vec<f64> = (1..=10).map(|k| f64::from(5 * k) / 100.0).collect();
        Self::new("R (m²)", rows, |r, acceleration| Setting {
            interval,
            acceleration,
            measurement_variance: r,
            noises: [5.0, 5.0],
            stay: 0.95,
        })
    }

    /// Figure 2: R = 0.05, process noise of constant velocity from 2 to 40, of constant acceleration 5, a from 0 to 95.
    ///
    /// Source: derbez2000, figure 2.
    ///
    /// Example: twenty rows of twenty columns.
    ///
    /// ```
    /// use immaculate::steady::simulated::Grid;
    ///
    /// let grid = Grid::figure_2(2.0);
    /// assert_eq!((grid.rows.len(), grid.columns.len(), grid.settings.len()), (20, 20, 400));
    /// assert_eq!(grid.settings[0].noises, [2.0, 5.0]);
    /// ```
    pub fn figure_2(interval: f64) -> Self {
        let rows: Vec<f64> = (1..=20).map(|k| f64::from(2 * k)).collect();
        Self::new("q_v (m²/s⁴)", rows, |q, acceleration| Setting {
            interval,
            acceleration,
            measurement_variance: 0.05,
            noises: [q, 5.0],
            stay: 0.95,
        })
    }

    fn new(rows_are: &'static str, rows: Vec<f64>, setting: impl Fn(f64, f64) -> Setting) -> Self {
        let columns = accelerations();
        let settings = rows
            .iter()
            .flat_map(|row| columns.iter().map(|column| setting(*row, *column)).collect::<Vec<_>>())
            .collect();
        Self {
            rows_are,
            rows,
            columns,
            settings,
        }
    }

    /// 100 (predicted − simulated)/simulated, of the traces, row by row; not a number where there is no prediction.
    ///
    /// `noise` gives the standard normal numbers of a grid point's run.
    ///
    /// Example: one point of figure 1, at rest, with a noise that is +1 and −1 in turn.
    ///
    /// ```
    /// use immaculate::steady::long_term::{Form, predict};
    /// use immaculate::steady::simulated::{Grid, Start, simulate};
    ///
    /// let in_turn = || { let mut sign = -1.0; move || { sign = -sign; sign } };
    /// let mut grid = Grid::figure_1(2.0);
    /// grid.settings.truncate(1);
    /// let percent = grid.percentages(Form::Corrected, Start::AtTheTruth, |_| in_turn()).unwrap()[0];
    /// let simulated = simulate(&grid.settings[0], Start::AtTheTruth, in_turn()).unwrap().total();
    /// let predicted = predict(&grid.settings[0], Form::Corrected).unwrap().total();
    /// assert_eq!(percent, 100.0 * (predicted - simulated) / simulated);
    /// ```
    ///
    /// # Errors
    ///
    /// As [`simulate`].
    ///
    /// Source: derbez2000, figures 1 and 2: "the percentage error between the predicted error and the simulated error".
    pub fn percentages<N: FnMut() -> f64>(
        &self,
        form: Form,
        start: Start,
        noise: impl Fn(usize) -> N + Sync,
    ) -> Result<Vec<f64>, NotSimulated> {
        let one = |(index, setting): (usize, &Setting)| {
            let simulated = simulate(setting, start, noise(index))?.total();
            let predicted = predict(setting, form).map_or(f64::NAN, |predicted| predicted.total());
            Ok(100.0 * (predicted - simulated) / simulated)
        };
        self.settings.par_iter().enumerate().map(one).collect()
    }
}
