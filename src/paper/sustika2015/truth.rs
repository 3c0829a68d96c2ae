//! The path of the target and the measurements of the radar.
//!
//! In both trajectories the state moves with constant velocity or constant acceleration and the model's noise, and begins every manoeuvre
//! without an acceleration. The measurements are range and bearing with noise; the bearing is reported in (−π, π], as radars do. The
//! target starts at the upper left of the radar and may cross the negative x-axis, where such a bearing jumps by almost 2π.
//!
//! The random numbers of a run come from two streams in a fixed order, so that neither depends on how many the other takes: those of the
//! trajectory from stream 2m of the seed, six a step (of [x, y, ẋ, ẏ, ẍ, ÿ]; a straight step does not use the last two), and those of the
//! measurements from stream 2m + 1, range and then bearing. Filters and settings of filters that are compared see the same.

use super::{DURATION, INITIAL_POSITION, INITIAL_VELOCITY, INTERVAL, MEASUREMENT_DEVIATIONS, NOISE_DENSITY};
use crate::matrix::cholesky;
use crate::model::angle::wrap;
use crate::model::wiener::{
    acceleration_noise_in_the_plane, constant_acceleration_in_the_plane, constant_velocity_in_the_plane,
    velocity_noise_in_the_plane,
};
use crate::number::Real;
use crate::paper::monte_carlo::Generator;
use nalgebra::{Matrix6, Vector2, Vector6};
use std::f64::consts::PI;

/// What the target does in a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Manoeuvre {
    /// Constant velocity.
    Straight,
    /// Constant acceleration.
    Manoeuvre,
}

impl Manoeuvre {
    /// The name of the mode that models this motion.
    pub fn name(self) -> &'static str {
        match self {
            Self::Straight => "constant velocity",
            Self::Manoeuvre => "constant acceleration",
        }
    }
}

/// How random the trajectory is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TruthNoise {
    /// Process noise, anew in every run.
    EachRun,
    /// Process noise, the same in every run.
    OneTrajectory,
    /// None.
    Free,
}

/// What the target does, and how random it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    /// The motions of steps 2, 3, …, 200; the state of step 1 is the initial one.
    pub motions: Vec<Manoeuvre>,
    /// How random it is.
    pub noise: TruthNoise,
}

/// What is true and what is seen in one run, of steps 1, 2, …, 200.
#[derive(Debug, Clone, PartialEq)]
pub struct RadarDraw {
    /// The true states.
    pub truth: Vec<Vector6<f64>>,
    /// Range and bearing, m and rad.
    pub measurements: Vec<Vector2<f64>>,
}

impl Trajectory {
    /// A trajectory with manoeuvres at the given times, first and last second of each.
    pub fn new(manoeuvres: &[[usize; 2]], noise: TruthNoise) -> Self {
        let motion = |second: usize| {
            let is_in = |[first, last]: &[usize; 2]| (*first..=*last).contains(&second);
            if manoeuvres.iter().any(is_in) {
                Manoeuvre::Manoeuvre
            } else {
                Manoeuvre::Straight
            }
        };
        Self {
            motions: (2..=DURATION).map(motion).collect(),
            noise,
        }
    }

    /// The truth and the measurements of a run.
    pub fn draw(&self, run: usize, seed: u64) -> RadarDraw {
        let stream =
            |run: usize, which: u64| Generator::new(seed, 2 * u64::try_from(run).unwrap_or(u64::MAX / 4) + which);
        let run_of_truth = match self.noise {
            TruthNoise::EachRun => run,
            TruthNoise::OneTrajectory | TruthNoise::Free => 0,
        };
        let truth = self.truth(&mut stream(run_of_truth, 0));
        let mut generator = stream(run, 1);
        RadarDraw {
            measurements: truth.iter().map(|state| measure(state, &mut generator)).collect(),
            truth,
        }
    }

    /// The states of steps 1, 2, …
    fn truth(&self, generator: &mut Generator) -> Vec<Vector6<f64>> {
        let [straight, manoeuvre] = [
            (
                constant_velocity_in_the_plane(&INTERVAL),
                velocity_noise_in_the_plane(&NOISE_DENSITY, &INTERVAL),
            ),
            (
                constant_acceleration_in_the_plane(&INTERVAL),
                acceleration_noise_in_the_plane(&NOISE_DENSITY, &INTERVAL),
            ),
        ]
        .map(|(transition, noise)| (transition, self.noise_root(&noise)));
        let ([x, y], [vx, vy]) = (INITIAL_POSITION, INITIAL_VELOCITY);
        let mut state = Vector6::new(x, y, vx, vy, 0.0, 0.0);
        let mut states = vec![state];
        for motion in &self.motions {
            let (transition, root) = match motion {
                Manoeuvre::Straight => &straight,
                Manoeuvre::Manoeuvre => &manoeuvre,
            };
            // The transition of constant velocity has no acceleration in it, so that what a manoeuvre leaves ends with it.
            state = transition * state + root * Vector6::from_fn(|_, _| generator.standard_normal());
            states.push(state);
        }
        states
    }

    /// A square root of the process noise.
    ///
    /// # Panics
    ///
    /// When a covariance of the models has none; they are constant, and every draw uses them.
    fn noise_root(&self, covariance: &Matrix6<f64>) -> Matrix6<f64> {
        match self.noise {
            TruthNoise::EachRun | TruthNoise::OneTrajectory => {
                cholesky(covariance).expect("the models' noises are covariances")
            }
            TruthNoise::Free => Matrix6::zeros(),
        }
    }
}

/// Range and bearing of a state with noise, m and rad; the bearing in (−π, π].
fn measure(state: &Vector6<f64>, generator: &mut Generator) -> Vector2<f64> {
    let [range, bearing] = MEASUREMENT_DEVIATIONS.map(|deviation| deviation * generator.standard_normal());
    let position = Vector2::new(state[0], state[1]);
    Vector2::new(
        position.norm() + range,
        wrap(Real::atan2(&position[1], &position[0]) + bearing),
    )
}

/// How often a bearing differs from the one before by more than π: where the target, or its noise, crosses the negative x-axis.
pub fn bearing_jumps(measurements: &[Vector2<f64>]) -> usize {
    let jumps = |pair: &&[Vector2<f64>]| (pair[1][1] - pair[0][1]).abs() > PI;
    measurements.windows(2).filter(jumps).count()
}
