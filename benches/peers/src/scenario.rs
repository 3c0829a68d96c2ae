//! The problem that all are given: constant velocity and two turns, n = 4, m = 2, and a target that flies straight, turns, and flies
//! straight again.

use immaculate::model::motion::{constant_velocity, coordinated_turn, integrated_noise};
use nalgebra::{Matrix2, Matrix2x4, Matrix4, Vector2, Vector4, matrix, vector};

/// The number of modes.
pub const MODES: usize = 3;

/// The number of measurements.
pub const STEPS: usize = 200;

/// The Markov chain of the modes.
pub const CHAIN: [[f64; MODES]; MODES] = [[0.95, 0.025, 0.025], [0.025, 0.95, 0.025], [0.025, 0.025, 0.95]];

/// The mode probabilities at the start.
pub const PROBABILITIES: [f64; MODES] = [0.8, 0.1, 0.1];

/// What the sensor measures, with the variances of its noise.
#[derive(Clone, Copy, PartialEq)]
pub enum Sensor {
    /// x and y, 40 m each.
    Position,
    /// Range, 40 m, and bearing, 7 mrad.
    RangeBearing,
}

impl Sensor {
    /// R.
    pub fn noise(self) -> Matrix2<f64> {
        Matrix2::from_diagonal(&match self {
            Self::Position => vector![1600.0, 1600.0],
            Self::RangeBearing => vector![1600.0, 49e-6],
        })
    }

    /// h(x).
    pub fn of(self, state: &Vector4<f64>) -> Vector2<f64> {
        match self {
            Self::Position => vector![state[0], state[2]],
            Self::RangeBearing => vector![state[0].hypot(state[2]), state[2].atan2(state[0])],
        }
    }

    /// The measurements of the run, with noise of a named generator: Knuth's MMIX, and Box and Muller's normal numbers.
    pub fn measurements(self) -> Vec<Vector2<f64>> {
        let mut seed = 12345_u64;
        let mut uniform = move || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((seed >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
        };
        let mut normal = move || (-2.0 * uniform().ln()).sqrt() * (std::f64::consts::TAU * uniform()).cos();
        let [straight, _, right] = transitions();
        let mut state = start().0;
        let deviations = self.noise().diagonal().map(f64::sqrt);
        (0..STEPS)
            .map(|k| {
                state = if (80..120).contains(&k) { right } else { straight } * state;
                self.of(&state) + vector![normal(), normal()].component_mul(&deviations)
            })
            .collect()
    }
}

/// H of [`Sensor::Position`].
pub fn h() -> Matrix2x4<f64> {
    matrix![1.0, 0.0, 0.0, 0.0; 0.0, 0.0, 1.0, 0.0]
}

/// F of each mode.
pub fn transitions() -> [Matrix4<f64>; MODES] {
    let turn = 3.0_f64.to_radians();
    [
        constant_velocity(&1.0),
        coordinated_turn(&turn, &1.0),
        coordinated_turn(&-turn, &1.0),
    ]
}

/// Q, the same of all modes.
pub fn process_noise() -> Matrix4<f64> {
    integrated_noise(&1.0, &1.0)
}

/// Mean and covariance of every mode at the start.
pub fn start() -> (Vector4<f64>, Matrix4<f64>) {
    (
        vector![15000.0, -180.0, 1000.0, 200.0],
        Matrix4::from_diagonal(&vector![1e4, 1e2, 1e4, 1e2]),
    )
}
