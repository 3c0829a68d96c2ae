//! The interface between simulations and statistics.
//!
//! The comparison of filters needs little from a paper's scenario: names and times, the target's motion over time, and a run whose result
//! depends only on its number and the seed. Two papers share one scenario; each of the others has its own.

use super::specification::Choices;
use crate::imm::Failure;
use nalgebra::{Vector2, Vector4};
use std::fmt::Debug;
use std::time::Duration;

/// A filter of a simulation, by what is printed about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Competitor {
    /// The paper's name for it.
    pub name: String,
    /// The names of its modes.
    pub modes: Vec<String>,
    /// The number of points of its rule, and of those with a weight other than zero; none for a filter without points.
    pub points: Option<(usize, usize)>,
}

/// What is true and what is seen in one run.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// The true positions of steps 1, 2, …
    pub truth: Vec<Vector2<f64>>,
    /// The measured positions of steps 1, 2, …
    pub measured: Vec<Vector2<f64>>,
    /// Where the sensor is, if positions are not measured themselves.
    pub sensor: Option<[f64; 2]>,
}

/// How errors at single steps become one figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Average {
    /// The root of the mean square over steps, liu2017 (34).
    RootMeanSquare,
    /// The mean of RMSE(k) over steps.
    Mean,
}

/// What one contestant did in one run.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Estimate minus truth, one a step; as many as were computed.
    pub errors: Vec<Vector4<f64>>,
    /// Normalised estimation errors squared.
    pub nees: Vec<f64>,
    /// Normalised innovations squared.
    pub nis: Vec<f64>,
    /// Mode probabilities.
    pub mode_probabilities: Vec<Vec<f64>>,
    /// The percentage fit error of the position, where the paper has one and the run came to its end.
    pub fit_error: Option<f64>,
    /// The step that could not be computed, if there was one.
    pub failure: Option<Failure>,
    /// Time spent in the filter's steps.
    pub time: Duration,
}

impl Run {
    /// A run that has not begun, with room for a number of steps.
    pub fn with_room_for(steps: usize) -> Self {
        Self {
            errors: Vec::with_capacity(steps),
            nees: Vec::with_capacity(steps),
            nis: Vec::with_capacity(steps),
            mode_probabilities: Vec::with_capacity(steps),
            fit_error: None,
            failure: None,
            time: Duration::ZERO,
        }
    }
}

/// A paper's simulation with every choice made.
pub trait Simulation: Debug + Sync {
    /// The paper's key.
    fn paper(&self) -> &'static str;
    /// The choices that differ from the defaults.
    fn choices(&self) -> &Choices;
    /// The paper's number of runs.
    fn runs(&self) -> usize;
    /// The times of the steps, s.
    fn times(&self) -> Vec<f64>;
    /// The time between two steps, s.
    fn interval(&self) -> f64;
    /// The modes that model what the target does in steps 1, 2, …, separated by `, ` where there are several.
    fn motions(&self) -> Vec<&'static str>;
    /// How errors at single steps become the figure of a table.
    fn average(&self) -> Average;
    /// The numbers of components of the state and of the measurement: what NEES and NIS are expected to be.
    fn components(&self) -> (f64, f64);
    /// The filters, in the order of the results.
    fn filters(&self) -> Vec<Competitor>;
    /// What every filter did in run `run`, counted from 0.
    fn one_run(&self, run: usize, seed: u64) -> Vec<Run>;
    /// The first run's truth and measurements; none where each filter has its own.
    fn first_path(&self, seed: u64) -> Option<Path>;
}
