//! A simulation of sustika2015 with every choice made, and a run of it.
//!
//! It defines how the filters begin, what is kept of a run, and the run's percentage fit error: over all filtered steps, from the errors
//! of x and y and the true positions. Errors are kept as [x, ẋ, y, ẏ], as in the other papers, so that the same statistics apply; the
//! errors of the accelerations are omitted.

use super::contestants::{RadarFilter, RadarSetup};
use super::truth::{Manoeuvre, RadarDraw, Trajectory};
use super::{DURATION, INTERVAL, RADAR, RUNS};
use crate::imm::{Imm, Step};
use crate::model::conversion::Conversion;
use crate::paper::monte_carlo::follow;
use crate::paper::simulation::Average;
use crate::paper::simulation::Run;
use crate::paper::simulation::{self, Competitor, Simulation};
use crate::paper::specification::Choices;
use crate::statistics::consistency::{nees, nis};
use crate::statistics::fit_error::{FitForm, position_fit_error};
use nalgebra::{U2, U6, Vector2, Vector4, Vector6};

/// What the first measurement is used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FirstMeasurement {
    /// The estimate at its own time; filtering begins with the second.
    Initiation,
    /// The estimate one step before; it is filtered again.
    FilteredAgain,
}

/// A simulation with every choice made.
#[derive(Debug, Clone)]
pub struct RadarScenario {
    /// The choices that differ from the defaults.
    pub choices: Choices,
    /// What the target does.
    pub trajectory: Trajectory,
    /// What the first measurement is used for.
    pub first_measurement: FirstMeasurement,
    /// How the fit errors of x and y become one.
    pub fit_form: FitForm,
    /// The parameters that the filters assume.
    pub setup: RadarSetup,
    /// The filters.
    pub contestants: Vec<RadarFilter>,
}

impl RadarScenario {
    /// The first measurement that is filtered, counted from 0.
    fn first_filtered(&self) -> usize {
        match self.first_measurement {
            FirstMeasurement::Initiation => 1,
            FirstMeasurement::FilteredAgain => 0,
        }
    }

    /// One contestant on one draw, to its end or to the first step that cannot be computed.
    ///
    /// # Panics
    ///
    /// When the contestant's problem is not valid: the paper's problems are part of the program, and a test runs all of them.
    pub fn track(&self, contestant: &RadarFilter, draw: &RadarDraw) -> Run {
        let mut run = Run::with_room_for(DURATION);
        let initial = self.setup.initial(&draw.measurements[0]);
        let mut filter = Imm::with_equations(contestant.problem.clone(), contestant.equations, &initial)
            .expect("the paper's problems are part of the program");
        let truth = &draw.truth[self.first_filtered()..];
        follow(
            &mut run,
            &mut filter,
            truth,
            &draw.measurements[self.first_filtered()..],
            record,
        );
        if run.failure.is_none() {
            run.fit_error = Some(fit_error(self.fit_form, &run.errors, truth));
        }
        run
    }

    /// The percentage fit error of a run in every form; none when it did not come to its end.
    pub fn fit_errors(&self, run: &Run, draw: &RadarDraw) -> Option<[f64; FitForm::ALL.len()]> {
        let truth = &draw.truth[self.first_filtered()..];
        let is_complete = run.failure.is_none();
        is_complete.then(|| FitForm::ALL.map(|form| fit_error(form, &run.errors, truth)))
    }
}

/// The percentage fit error of a run, from the errors of [x, ẋ, y, ẏ] and the true states.
fn fit_error(form: FitForm, errors: &[Vector4<f64>], truth: &[Vector6<f64>]) -> f64 {
    let of_errors = |entry: usize| errors.iter().map(|error| error[entry]).collect::<Vec<f64>>();
    let of_truth = |axis: usize| {
        truth
            .iter()
            .map(|state| state[axis] - RADAR[axis])
            .collect::<Vec<f64>>()
    };
    let (x, y) = (of_errors(0), of_errors(2));
    position_fit_error(form, [&x, &y], [&of_truth(0), &of_truth(1)])
}

/// Keeps what the statistics need of a step.
fn record(run: &mut Run, step: &Step<f64, U6, U2>, truth: &Vector6<f64>) {
    let error = step.combined.mean - truth;
    run.errors.push(Vector4::new(error[0], error[2], error[1], error[3]));
    run.nees.push(nees(&step.combined, truth));
    run.nis.extend(nis(step));
    run.mode_probabilities.push(step.mode_probabilities.clone());
}

impl Simulation for RadarScenario {
    fn paper(&self) -> &'static str {
        "sustika2015"
    }

    fn choices(&self) -> &Choices {
        &self.choices
    }

    fn runs(&self) -> usize {
        RUNS
    }

    fn times(&self) -> Vec<f64> {
        (self.first_filtered()..DURATION)
            .map(|k| (k + 1) as f64 * INTERVAL)
            .collect()
    }

    fn interval(&self) -> f64 {
        INTERVAL
    }

    fn motions(&self) -> Vec<&'static str> {
        // Nothing moves to the first state.
        let first = Some(Manoeuvre::Straight).filter(|_| self.first_filtered() == 0);
        let motions = first.iter().chain(&self.trajectory.motions);
        motions.map(|motion| motion.name()).collect()
    }

    fn average(&self) -> Average {
        Average::RootMeanSquare
    }

    fn components(&self) -> (f64, f64) {
        (6.0, 2.0)
    }

    fn filters(&self) -> Vec<Competitor> {
        let filter = |contestant: &RadarFilter| Competitor {
            name: contestant.name.to_owned(),
            modes: contestant.problem.modes.iter().map(|mode| mode.name.clone()).collect(),
            points: contestant.points,
        };
        self.contestants.iter().map(filter).collect()
    }

    fn one_run(&self, run: usize, seed: u64) -> Vec<Run> {
        let draw = self.trajectory.draw(run, seed);
        let contestants = self.contestants.iter();
        contestants.map(|contestant| self.track(contestant, &draw)).collect()
    }

    fn first_path(&self, seed: u64) -> Option<simulation::Path> {
        let draw = self.trajectory.draw(0, seed);
        let position = |z: &Vector2<f64>| Conversion::Standard.position(&z[0], &z[1], &0.0) + Vector2::from(RADAR);
        let first = self.first_filtered();
        Some(simulation::Path {
            truth: draw.truth[first..]
                .iter()
                .map(|state| Vector2::new(state[0], state[1]))
                .collect(),
            measured: draw.measurements[first..].iter().map(position).collect(),
            sensor: Some(RADAR),
        })
    }
}
