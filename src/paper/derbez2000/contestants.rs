//! The three filters of the comparison, for either coordinate.
//!
//! Each filter consists of the two motions, their noises and a Markov chain; the third also has the steady gains of both.
//!
//! ```text
//! IMM          constant velocity and constant acceleration, Kalman filters
//! Fixed Gain   the same with the gains that each would end with alone
//! CA           one Kalman filter of constant acceleration
//! ```

use super::path::{PlaneState, TruePath, position_of};
use super::radar::{self, converted_variances};
use super::{INITIAL_PROBABILITIES, MEASUREMENT_VARIANCES, TRANSITION};
use crate::filter::Filter;
use crate::filter::fixed_gain::FixedGain;
use crate::imm::{Equations, Interaction, Problem};
use crate::model::Sensor;
use crate::model::acceleration::{modes, position_matrix};
use crate::model::conversion::converted_position;
use crate::number::Real;
use crate::steady::gains;
use nalgebra::{Matrix1, U1, U3, Vector2, Vector3, Vector4};

/// The positions of the three in a scenario and in the columns of the tables.
pub const IMM: usize = 0;
/// As [`IMM`].
pub const FIXED_GAIN: usize = 1;
/// As [`IMM`].
pub const CA: usize = 2;

/// What a filter of the comparison filters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coordinates {
    /// x and y of the converted measurements.
    Cartesian,
    /// Range and bearing themselves; only the output is converted.
    Polar,
}

/// A filter of the comparison: two filters of one coordinate each.
#[derive(Debug, Clone)]
pub struct CoordinateFilters {
    /// The paper's name for it.
    pub name: String,
    /// What it filters.
    pub coordinates: Coordinates,
    /// Modes, chain and noises for either coordinate.
    pub problems: [Problem<f64, U3, U1>; 2],
    /// Its equations.
    pub equations: Equations<f64, U3, U1>,
    /// Mode probabilities at step 0.
    pub initial_probabilities: Vec<f64>,
    /// The variance of every coordinate's entries of the state at step 0; zero where there are no covariances.
    pub initial_variance: f64,
    /// Whether R is that of each converted measurement; if not, it is the problem's at all steps.
    pub follows_noise: bool,
}

impl Coordinates {
    /// A place in these coordinates, [r, ṙ, r̈] and [θ, θ̇, θ̈] for polar ones.
    ///
    /// ```text
    /// ṙ = (x ẋ + y ẏ)/r,   r θ̇ = (x ẏ − y ẋ)/r,   r̈ = (x ẍ + y ÿ)/r + r θ̇²,   r θ̈ = (x ÿ − y ẍ)/r − 2 ṙ θ̇
    /// ```
    ///
    /// Source: the accelerations along and across the line of sight, r̈ − r θ̇² and r θ̈ + 2 ṙ θ̇.
    ///
    /// Example: at (2, 0) with the velocity (0, 4) and no acceleration: θ̇ = 4/2, r̈ = 2 · 2² = 8, and nothing else.
    ///
    /// ```
    /// use immaculate::paper::derbez2000::contestants::{Coordinates};
    /// use nalgebra::Vector3;
    ///
    /// let place = [Vector3::new(2.0, 0.0, 0.0), Vector3::new(0.0, 4.0, 0.0)];
    /// let [range, bearing] = Coordinates::Polar.of(&place);
    /// assert_eq!(range, Vector3::new(2.0, 0.0, 8.0));
    /// assert_eq!(bearing, Vector3::new(0.0, 2.0, 0.0));
    /// ```
    ///
    /// Evidence: `range_and_bearing_move_as_their_derivatives_say`.
    pub fn of(self, place: &PlaneState) -> PlaneState {
        if self == Self::Cartesian {
            return *place;
        }
        let [x, y] = place;
        let polar = radar::polar(position_of(place));
        let r = polar[0];
        let along = |i: usize| (x[0] * x[i] + y[0] * y[i]) / r;
        let across = |i: usize| (x[0] * y[i] - y[0] * x[i]) / r;
        let (range_rate, bearing_rate) = (along(1), across(1) / r);
        [
            Vector3::new(r, range_rate, along(2) + r * bearing_rate * bearing_rate),
            Vector3::new(
                polar[1],
                bearing_rate,
                (across(2) - 2.0 * range_rate * bearing_rate) / r,
            ),
        ]
    }

    /// Position and velocity [x, ẋ, y, ẏ] of estimates in these coordinates.
    pub(super) fn back(self, [first, second]: PlaneState) -> Vector4<f64> {
        if self == Self::Cartesian {
            return Vector4::new(first[0], first[1], second[0], second[1]);
        }
        let direction = converted_position(&1.0, &Real::cos(&second[0]), &Real::sin(&second[0]));
        let (r, range_rate, across) = (first[0], first[1], first[0] * second[1]);
        Vector4::new(
            r * direction[0],
            range_rate * direction[0] - across * direction[1],
            r * direction[1],
            range_rate * direction[1] + across * direction[0],
        )
    }
}

/// From what the fixed-gain filters start. Un-mixed filters stand alone, and each is stable as its gain is; mixed ones feed each other,
/// and are not judged one by one.
///
/// Evidence: `frozen_probabilities_are_not_judged_by_the_averaged_matrices` (exact).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reading {
    /// From mixed estimates, as in the usual IMM algorithm.
    Mixed,
    /// Each from its own estimate, as the update is printed.
    Unmixed,
}

/// R of a coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MeasurementNoise {
    /// The mean over the true path of the converted measurement's variance, for all filters.
    MeanOverThePath,
    /// That of each converted measurement for the Kalman filters, the mean for the fixed gains.
    OfEachMeasurement,
    /// A number, for all filters, m².
    Constant(f64),
}

/// The parameters that the filters assume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoordinateSetup {
    /// t, s.
    pub interval: f64,
    /// From what the fixed-gain filters start.
    pub reading: Reading,
    /// q of both modes, (m/s²)².
    pub noise_variance: f64,
    /// R.
    pub noise: MeasurementNoise,
    /// The variance of each entry of the Kalman filters' state at step 0.
    pub initial_variance: f64,
}

impl CoordinateSetup {
    /// The paper's three filters, in the order of its tables.
    pub fn contestants(&self, path: &TruePath) -> Vec<CoordinateFilters> {
        let variances = self.measurement_variances(path);
        vec![self.imm(variances), self.fixed_gain(variances), self.single(variances)]
    }

    /// The full IMM filter.
    pub fn imm(&self, variances: [f64; 2]) -> CoordinateFilters {
        CoordinateFilters {
            name: "IMM".to_owned(),
            coordinates: Coordinates::Cartesian,
            problems: variances.map(|variance| self.problem(variance)),
            equations: Equations::standard(),
            initial_probabilities: INITIAL_PROBABILITIES.to_vec(),
            initial_variance: self.initial_variance,
            follows_noise: self.noise == MeasurementNoise::OfEachMeasurement,
        }
    }

    /// The IMM filter with fixed gains.
    pub fn fixed_gain(&self, variances: [f64; 2]) -> CoordinateFilters {
        CoordinateFilters {
            name: "Fixed Gain".to_owned(),
            problems: variances.map(|variance| Problem {
                filters: self.steady_gains(variance).into_iter().map(Filter::given).collect(),
                interaction: match self.reading {
                    Reading::Mixed => Interaction::Imm,
                    Reading::Unmixed => Interaction::Unmixed,
                },
                ..self.problem(variance)
            }),
            initial_variance: 0.0,
            follows_noise: false,
            ..self.imm(variances)
        }
    }

    /// The Kalman filter of constant acceleration.
    pub fn single(&self, variances: [f64; 2]) -> CoordinateFilters {
        let imm = self.imm(variances);
        CoordinateFilters {
            name: "CA".to_owned(),
            problems: imm.problems.clone().map(|problem| Problem {
                modes: problem.modes[1..].to_vec(),
                chain: vec![vec![1.0]],
                ..problem
            }),
            initial_probabilities: vec![1.0],
            ..imm
        }
    }

    /// R of either coordinate, where it is constant.
    pub fn measurement_variances(&self, path: &TruePath) -> [f64; 2] {
        if let MeasurementNoise::Constant(variance) = self.noise {
            return [variance; 2];
        }
        let at = |place: &[Vector3<f64>; 2]| {
            Vector2::from(converted_variances(
                Vector2::new(place[0][0], place[1][0]),
                MEASUREMENT_VARIANCES,
            ))
        };
        let sum: Vector2<f64> = path.places.iter().map(at).sum();
        (sum / path.places.len() as f64).into()
    }

    /// Both modes of one coordinate, constant velocity first.
    fn problem(&self, measurement_variance: f64) -> Problem<f64, U3, U1> {
        Problem {
            modes: modes(&self.interval, &[self.noise_variance; 2]).to_vec(),
            chain: TRANSITION.iter().map(|row| row.to_vec()).collect(),
            sensor: Sensor::Linear(position_matrix()),
            measurement_noise: Matrix1::new(measurement_variance),
            filters: vec![Filter::kalman()],
            interaction: Interaction::Imm,
            angles: vec![],
        }
    }

    /// The steady gain and innovation variance of either mode.
    ///
    /// Evidence: `the_fixed_gains_are_those_with_which_the_kalman_filters_end`.
    fn steady_gains(&self, measurement_variance: f64) -> Vec<FixedGain<f64, U3, U1>> {
        let index = gains::tracking_index(&self.noise_variance, &measurement_variance, &self.interval);
        let of_velocity = gains::alpha_beta_root(&index);
        let of_acceleration = gains::alpha_beta_gamma_root(&index);
        let fixed = |gain, root| FixedGain {
            gain,
            innovation_covariance: Matrix1::new(gains::innovation_variance(root, &measurement_variance)),
        };
        vec![
            fixed(gains::alpha_beta_gain(&of_velocity, &self.interval), &of_velocity),
            fixed(
                gains::alpha_beta_gamma_gain(&of_acceleration, &self.interval),
                &of_acceleration,
            ),
        ]
    }
}
