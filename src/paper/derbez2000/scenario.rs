//! A scenario of derbez2000 with every choice made, and a run of it.
//!
//! Unlike in the other papers, each coordinate has its own filter with its own mode probabilities, and the two are independent. A run
//! keeps the errors of [x, ẋ, y, ẏ], as in the other papers, so that the same statistics apply; the error of the acceleration is omitted.

use super::contestants::{CoordinateFilters, CoordinateSetup, Coordinates};
use super::path::{PlaneState, Regime, TruePath, position_of};
use super::radar;
use crate::imm::{Failure, Imm, Initial, Problem, Step};
use crate::model::Conversion;
use crate::paper::monte_carlo::Generator;
use crate::paper::simulation::Average;
use crate::paper::simulation::Run;
use crate::paper::simulation::{self, Competitor, Simulation};
use crate::paper::specification::Choices;
use crate::statistics::consistency::{nees, nis};
use nalgebra::{Matrix1, U1, U3, Vector1, Vector2, Vector3, Vector4};
use std::time::{Duration, Instant};

/// A scenario with every choice made.
#[derive(Debug, Clone)]
pub struct CoordinateScenario {
    /// The choices that differ from the defaults.
    pub choices: Choices,
    /// The paper's number of runs.
    pub runs: usize,
    /// The parameters that the filters assume.
    pub setup: CoordinateSetup,
    /// The truth.
    pub path: TruePath,
    /// The variances of range and bearing, m² and rad².
    pub variances: [f64; 2],
    /// How range and bearing become positions, and whether their bias is taken out.
    pub conversion: Conversion,
    /// The filters.
    pub contestants: Vec<CoordinateFilters>,
}

/// One measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Range and bearing, m and rad.
    pub polar: Vector2<f64>,
    /// The same as a position, m.
    pub position: Vector2<f64>,
}

impl CoordinateScenario {
    /// Draws the measurements of one run: for each step the noise of the range, then that of the bearing.
    pub fn draw(&self, generator: &mut Generator) -> Vec<Seen> {
        let deviations = Vector2::from(self.variances.map(f64::sqrt));
        let see = |place: &PlaneState| {
            let noise = deviations.map(|deviation| deviation * generator.standard_normal());
            let polar = radar::polar(position_of(place)) + noise;
            Seen {
                polar,
                position: self.conversion.position(&polar[0], &polar[1], &self.variances[1]),
            }
        };
        self.path.places.iter().map(see).collect()
    }

    /// The measurements of a run.
    pub fn seen(&self, run: usize, seed: u64) -> Vec<Seen> {
        self.draw(&mut Generator::of_run(seed, run))
    }

    /// Whether a coordinate (0 for x, 1 for y) is accelerated in each step: what the constant acceleration model is right for.
    pub fn accelerates(&self, coordinate: usize) -> Vec<bool> {
        let moves =
            |(motion, place): (&Regime, &PlaneState)| *motion != Regime::Straight && place[coordinate][2] != 0.0;
        self.path.motions.iter().zip(&self.path.places).map(moves).collect()
    }
}

impl Simulation for CoordinateScenario {
    fn paper(&self) -> &'static str {
        "derbez2000"
    }

    fn choices(&self) -> &Choices {
        &self.choices
    }

    fn runs(&self) -> usize {
        self.runs
    }

    fn times(&self) -> Vec<f64> {
        (1..=self.path.places.len())
            .map(|k| k as f64 * self.setup.interval)
            .collect()
    }

    fn interval(&self) -> f64 {
        self.setup.interval
    }

    fn motions(&self) -> Vec<&'static str> {
        let name = |(x, y): (&bool, &bool)| match (x, y) {
            (false, false) => "x: constant velocity, y: constant velocity",
            (true, false) => "x: constant acceleration, y: constant velocity",
            (false, true) => "x: constant velocity, y: constant acceleration",
            (true, true) => "x: constant acceleration, y: constant acceleration",
        };
        self.accelerates(0).iter().zip(&self.accelerates(1)).map(name).collect()
    }

    fn average(&self) -> Average {
        Average::RootMeanSquare
    }

    /// Three of the state and one measured, in either coordinate.
    fn components(&self) -> (f64, f64) {
        (6.0, 2.0)
    }

    fn filters(&self) -> Vec<Competitor> {
        let filter = |contestant: &CoordinateFilters| Competitor {
            name: contestant.name.clone(),
            modes: mode_names(contestant),
            points: None,
        };
        self.contestants.iter().map(filter).collect()
    }

    fn one_run(&self, run: usize, seed: u64) -> Vec<Run> {
        let seen = self.seen(run, seed);
        let contestants = self.contestants.iter();
        contestants.map(|contestant| track(self, contestant, &seen)).collect()
    }

    fn first_path(&self, seed: u64) -> Option<simulation::Path> {
        Some(simulation::Path {
            truth: self.path.places.iter().map(position_of).collect(),
            measured: self.seen(0, seed).iter().map(|seen| seen.position).collect(),
            sensor: Some([0.0, 0.0]),
        })
    }
}

/// The names of the modes of both coordinates; one name for a filter of one mode, which has no probabilities to show.
fn mode_names(contestant: &CoordinateFilters) -> Vec<String> {
    let axes = match contestant.coordinates {
        Coordinates::Cartesian => ["x", "y"],
        Coordinates::Polar => ["range", "bearing"],
    };
    let modes = &contestant.problems[0].modes;
    match &modes[..] {
        [mode] => vec![mode.name.clone()],
        modes => axes
            .iter()
            .flat_map(|axis| modes.iter().map(move |mode| format!("{axis}: {}", mode.name)))
            .collect(),
    }
}

/// One contestant on one run's measurements, to its end or to the first step that cannot be computed.
pub fn track(scenario: &CoordinateScenario, contestant: &CoordinateFilters, seen: &[Seen]) -> Run {
    let mut run = Run::with_room_for(seen.len());
    let mut keep = |steps: Steps, place: &PlaneState| record(&mut run, contestant, steps, place);
    let (time, failure) = follow(scenario, contestant, seen, &mut keep);
    Run { failure, time, ..run }
}

/// A step of either coordinate.
pub type Steps<'a> = [&'a Step<f64, U3, U1>; 2];

/// One contestant on one run's measurements: `keep` is shown every step with the truth. The time spent in the filters' steps, and the
/// step that could not be computed, if there was one.
pub fn follow(
    scenario: &CoordinateScenario,
    contestant: &CoordinateFilters,
    seen: &[Seen],
    keep: &mut dyn FnMut(Steps, &PlaneState),
) -> (Duration, Option<Failure>) {
    let start = contestant.coordinates.of(&scenario.path.start);
    let mut filters = [0, 1].map(|c| {
        filter(
            contestant,
            contestant.problems[c].clone(),
            &initial(contestant, start[c]),
        )
    });
    let mut time = Duration::ZERO;
    for ((place, seen), step) in scenario.path.places.iter().zip(seen).zip(1..) {
        let begin = Instant::now();
        let outcome = both_steps(scenario, contestant, &mut filters, seen);
        time += begin.elapsed();
        if let Err(failure) = outcome {
            // A filter that goes on as a new one counts its steps anew.
            return (time, Some(Failure { step, ..failure }));
        }
        keep([filters[0].current(), filters[1].current()], place);
    }
    (time, None)
}

/// The estimate at step 0: exact, with the contestant's variance.
fn initial(contestant: &CoordinateFilters, state: Vector3<f64>) -> Initial<f64, U3> {
    let estimate = crate::gaussian::Gaussian {
        mean: state,
        covariance: nalgebra::Matrix3::identity() * contestant.initial_variance,
    };
    Initial {
        modes: vec![estimate; contestant.initial_probabilities.len()],
        mode_probabilities: contestant.initial_probabilities.clone(),
    }
}

/// A filter of one coordinate.
///
/// # Panics
///
/// When the problem is not valid: the paper's problems are part of the program, and a test runs all of them.
fn filter(
    contestant: &CoordinateFilters,
    problem: Problem<f64, U3, U1>,
    initial: &Initial<f64, U3>,
) -> Imm<f64, U3, U1> {
    Imm::with_equations(problem, contestant.equations, initial).expect("the paper's problems are part of the program")
}

/// A step of both coordinates' filters.
fn both_steps(
    scenario: &CoordinateScenario,
    contestant: &CoordinateFilters,
    filters: &mut [Imm<f64, U3, U1>; 2],
    seen: &Seen,
) -> Result<(), Failure> {
    let (measured, noises) = match contestant.coordinates {
        Coordinates::Cartesian => (
            seen.position,
            radar::converted_variances(seen.position, scenario.variances),
        ),
        Coordinates::Polar => (seen.polar, scenario.variances),
    };
    for c in [0, 1] {
        if contestant.follows_noise {
            // The noise is the problem's, so the filter goes on as a new one: its estimates and probabilities are all that a step hands on.
            let last = filters[c].current();
            let initial = Initial {
                modes: last.updated.clone(),
                mode_probabilities: last.mode_probabilities.clone(),
            };
            let problem = Problem {
                measurement_noise: Matrix1::new(noises[c]),
                ..contestant.problems[c].clone()
            };
            // Not checked again: the covariance of constant velocity is singular from its first step on, as it should be.
            filters[c] = Imm::unchecked(problem, contestant.equations, &initial);
        }
        filters[c].step(Some(&Vector1::new(measured[c])))?;
    }
    Ok(())
}

/// Keeps what the statistics need of a step of both coordinates.
fn record(run: &mut Run, contestant: &CoordinateFilters, steps: Steps, place: &PlaneState) {
    let truth = contestant.coordinates.of(place);
    let estimate = contestant
        .coordinates
        .back([steps[0].combined.mean, steps[1].combined.mean]);
    run.errors.push(Vector4::new(
        estimate[0] - place[0][0],
        estimate[1] - place[0][1],
        estimate[2] - place[1][0],
        estimate[3] - place[1][1],
    ));
    run.nees.push((0..2).map(|c| nees(&steps[c].combined, &truth[c])).sum());
    run.nis.push(steps.iter().filter_map(|step| nis(step)).sum());
    let probabilities = steps.iter().flat_map(|step| step.mode_probabilities.iter().copied());
    let shown = if contestant.problems[0].modes.len() == 1 {
        1
    } else {
        usize::MAX
    };
    run.mode_probabilities.push(probabilities.take(shown).collect());
}
