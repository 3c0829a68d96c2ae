//! A target that flies straight and turns, a sensor that sees it, and the filters that compete.
//!
//! The simulations of zhu2016 and liu2017 share this: a schedule of motions, one run's draw of truth, measurements and initial estimate,
//! and contestants that all see the same draw.

use super::monte_carlo::{Generator, follow};
use super::simulation::{Average, Competitor, Path, Run, Simulation};
use super::specification::Choices;
use crate::filter::Filter;
use crate::gaussian::Gaussian;
use crate::imm::{Equations, Imm, Initial, Problem, Step};
use crate::model::motion::{constant_velocity, coordinated_turn};
use crate::model::{Conversion, Sensor};
use crate::rule::{Rule, RuleName};
use crate::statistics::consistency::{nees, nis};
use nalgebra::{Matrix4, U2, U4, Vector2, Vector4};

/// What the target does in a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Course {
    /// Constant velocity.
    Straight,
    /// A turn to the left.
    LeftTurn,
    /// A turn to the right.
    RightTurn,
}

impl Course {
    /// The name of the mode that models this motion.
    pub fn name(self) -> &'static str {
        match self {
            Self::Straight => "constant velocity",
            Self::LeftTurn => "left turn",
            Self::RightTurn => "right turn",
        }
    }

    /// The transition matrix of this motion, for turns of `turn_rate` rad/s.
    pub fn transition(self, turn_rate: f64, interval: f64) -> Matrix4<f64> {
        match self {
            Self::Straight => constant_velocity(&interval),
            Self::LeftTurn => coordinated_turn(&turn_rate, &interval),
            Self::RightTurn => coordinated_turn(&-turn_rate, &interval),
        }
    }
}

/// A filter of the comparison.
#[derive(Debug, Clone)]
pub struct Contestant {
    /// The paper's name for it.
    pub name: String,
    /// Its modes, chain, measurement and rule.
    pub problem: Problem<f64, U4, U2>,
    /// Its equations.
    pub equations: Equations<f64, U4, U2>,
    /// Its probabilities at step 0.
    pub initial_probabilities: Vec<f64>,
    /// The number of points of its rule, and of those with a weight other than zero; none for a Kalman filter.
    pub points: Option<(usize, usize)>,
}

impl Contestant {
    /// A filter with points: a problem without a rule, and the rule to use.
    ///
    /// # Panics
    ///
    /// When the rule has no exact form in four dimensions, as a Gauss-Hermite rule has not.
    pub fn with_rule(
        name: &str,
        problem: Problem<f64, U4, U2>,
        rule: &RuleName,
        initial_probabilities: Vec<f64>,
    ) -> Self {
        let exact = rule.exact(4).expect("the papers' rules exist in four dimensions");
        let rule = Rule::from_exact(&exact).expect("the rule was made for four dimensions");
        Self {
            name: name.to_owned(),
            problem: Problem {
                filters: vec![Filter::points(rule)],
                ..problem
            },
            equations: Equations::standard(),
            initial_probabilities,
            points: Some((exact.points.len(), exact.effective_points())),
        }
    }
}

/// A paper's scenario with every choice made.
#[derive(Debug, Clone)]
pub struct Scenario {
    /// The paper's key.
    pub paper: &'static str,
    /// The choices that differ from the defaults.
    pub choices: Choices,
    /// The paper's number of runs.
    pub runs: usize,
    /// The time of step 1, s.
    pub first_time: f64,
    /// T, s.
    pub interval: f64,
    /// |ω| of the true turns, rad/s.
    pub turn_rate: f64,
    /// The true state at step 0.
    pub initial_state: Vector4<f64>,
    /// P₀ of the filters.
    pub initial_covariance: Matrix4<f64>,
    /// Whether the filters start from an estimate drawn from N(x₀, P₀), or from x₀ itself.
    pub draws_initial_estimate: bool,
    /// What the target does in steps 1, 2, …
    pub schedule: Vec<Course>,
    /// A square root of the truth's process noise; none for a deterministic trajectory.
    pub truth_noise_root: Option<Matrix4<f64>>,
    /// What the sensor sees.
    pub sensor: Sensor<f64, U4, U2>,
    /// The standard deviations of the measurement noise.
    pub measurement_deviations: Vector2<f64>,
    /// Whether every contestant sees the same noise.
    pub paired: bool,
    /// How errors at single steps become the figure of a table.
    pub average: Average,
    /// The filters.
    pub contestants: Vec<Contestant>,
}

/// One run's truth, measurements and initial estimate.
#[derive(Debug, Clone, PartialEq)]
pub struct Draw {
    /// The true states of steps 1, 2, …
    pub truth: Vec<Vector4<f64>>,
    /// The measurements of steps 1, 2, …
    pub measurements: Vec<Vector2<f64>>,
    /// The estimate at step 0, the same for every mode.
    pub initial: Gaussian<f64, U4>,
}

impl Scenario {
    /// The time of step k + 1, s.
    pub fn time(&self, k: usize) -> f64 {
        self.first_time + k as f64 * self.interval
    }

    /// Draws one run. The numbers are taken in a fixed order: initial estimate, then for each step process noise and measurement noise.
    pub fn draw(&self, generator: &mut Generator) -> Draw {
        let mut mean = self.initial_state;
        if self.draws_initial_estimate {
            mean += self
                .initial_covariance
                .diagonal()
                .map(|variance| variance.sqrt() * generator.standard_normal());
        }
        let mut state = self.initial_state;
        let mut truth = Vec::with_capacity(self.schedule.len());
        let mut measurements = Vec::with_capacity(self.schedule.len());
        for motion in &self.schedule {
            state = motion.transition(self.turn_rate, self.interval) * state;
            if let Some(root) = &self.truth_noise_root {
                state += root * Vector4::from_fn(|_, _| generator.standard_normal());
            }
            let noise = self
                .measurement_deviations
                .map(|deviation| deviation * generator.standard_normal());
            truth.push(state);
            measurements.push(self.sensor.of(&state) + noise);
        }
        Draw {
            truth,
            measurements,
            initial: Gaussian {
                mean,
                covariance: self.initial_covariance,
            },
        }
    }
}

impl Simulation for Scenario {
    fn paper(&self) -> &'static str {
        self.paper
    }

    fn choices(&self) -> &Choices {
        &self.choices
    }

    fn runs(&self) -> usize {
        self.runs
    }

    fn times(&self) -> Vec<f64> {
        (0..self.schedule.len()).map(|k| self.time(k)).collect()
    }

    fn interval(&self) -> f64 {
        self.interval
    }

    fn motions(&self) -> Vec<&'static str> {
        self.schedule.iter().map(|motion| motion.name()).collect()
    }

    fn average(&self) -> Average {
        self.average
    }

    fn components(&self) -> (f64, f64) {
        (4.0, 2.0)
    }

    fn filters(&self) -> Vec<Competitor> {
        let filter = |contestant: &Contestant| Competitor {
            name: contestant.name.clone(),
            modes: contestant.problem.modes.iter().map(|mode| mode.name.clone()).collect(),
            points: contestant.points,
        };
        self.contestants.iter().map(filter).collect()
    }

    /// All contestants on one run's draw, or each on a draw of its own when the scenario is not paired.
    fn one_run(&self, run: usize, seed: u64) -> Vec<Run> {
        let draw = |stream: usize| self.draw(&mut Generator::of_run(seed, stream));
        let count = self.contestants.len();
        if self.paired {
            let shared = draw(run);
            let contestants = self.contestants.iter();
            return contestants.map(|contestant| track(contestant, &shared)).collect();
        }
        // Streams of the contestants are interleaved, so that no two share one.
        let contestants = self.contestants.iter().enumerate();
        contestants
            .map(|(index, contestant)| track(contestant, &draw(run * count + index)))
            .collect()
    }

    fn first_path(&self, seed: u64) -> Option<Path> {
        if !self.paired {
            return None;
        }
        let draw = self.draw(&mut Generator::of_run(seed, 0));
        let sensor = match &self.sensor {
            Sensor::Polar { location, .. } => Some(*location),
            _ => None,
        };
        let position = |z: &Vector2<f64>| match sensor {
            Some(sensor) => Conversion::Standard.position(&z[0], &z[1], &0.0) + Vector2::from(sensor),
            None => *z,
        };
        Some(Path {
            truth: draw
                .truth
                .iter()
                .map(|state| Vector2::new(state[0], state[2]))
                .collect(),
            measured: draw.measurements.iter().map(position).collect(),
            sensor,
        })
    }
}

/// One contestant on one draw, to its end or to the first step that cannot be computed.
///
/// # Panics
///
/// When the contestant's problem is not valid: the papers' problems are part of the program, and a test runs all of them.
pub fn track(contestant: &Contestant, draw: &Draw) -> Run {
    let mut run = Run::with_room_for(draw.truth.len());
    let initial = Initial {
        modes: vec![draw.initial.clone(); contestant.problem.modes.len()],
        mode_probabilities: contestant.initial_probabilities.clone(),
    };
    let mut filter = Imm::with_equations(contestant.problem.clone(), contestant.equations, &initial)
        .expect("the scenarios' problems are part of the program");
    follow(&mut run, &mut filter, &draw.truth, &draw.measurements, record);
    run
}

/// Keeps what the statistics need of a step.
fn record(run: &mut Run, step: &Step<f64, U4, U2>, truth: &Vector4<f64>) {
    run.errors.push(step.combined.mean - truth);
    run.nees.push(nees(&step.combined, truth));
    run.nis.extend(nis(step));
    run.mode_probabilities.push(step.mode_probabilities.clone());
}
