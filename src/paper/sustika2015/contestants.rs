//! The filters of the comparison.
//!
//! Both filters have the same two motions, the same Markov chain and the same noises. One converts range and bearing and is linear from
//! then on; the other passes points through range and bearing. Both start from the first measurement, as a position.
//!
//! ```text
//! IMM-CMKF   Kalman filters of converted measurements; there is no bearing in them that could be wrapped
//! IMM-UKF    unscented filters of range and bearing, with bearings on the circle or as plain numbers
//! ```

use super::{INITIAL_PROBABILITIES, INITIAL_VELOCITY_ESTIMATE, INTERVAL, RADAR, TRANSITION};
use crate::filter::Filter;
use crate::gaussian::Gaussian;
use crate::imm::{Equations, Initial, Interaction, Problem};
use crate::model::conversion::Conversion;
use crate::model::motion::{self, Mode};
use crate::model::wiener::{
    acceleration_noise_in_the_plane, constant_acceleration_in_the_plane, constant_velocity_in_the_plane,
    velocity_noise_in_the_plane,
};
use crate::model::{PolarComponent, Sensor};
use crate::rule::unscented::unscented_in;
use nalgebra::{Matrix2, Matrix6, U2, U6, Vector2, Vector6};

/// What is known at first of what the first measurement does not tell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InitialCovariance {
    /// The position's covariance is that of the converted measurement.
    OnePoint {
        /// The variance of each velocity, (m/s)².
        velocity: f64,
        /// That of each acceleration, (m/s²)².
        acceleration: f64,
    },
    /// Variances of each position, velocity and acceleration, whatever was measured.
    Constant([f64; 3]),
}

/// Where the converted covariance is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ConvertedAt {
    /// At the measurement.
    Measurement,
    /// At the predicted position.
    Prediction,
}

/// How estimates are mixed of which one kind has no accelerations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mixing {
    /// Their accelerations are zero.
    Embedded,
    /// They add nothing to the accelerations.
    IndexWise,
    /// They take the accelerations of the mode that they are mixed for.
    Unbiased,
}

/// How a filter with points takes bearings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bearings {
    /// As places on the circle.
    Wrapped,
    /// As plain numbers, never wrapped.
    Plain,
}

/// The parameters that the filters assume.
#[derive(Debug, Clone, PartialEq)]
pub struct RadarSetup {
    /// q of both modes, m²/s³ and m²/s⁵.
    pub noise_density: f64,
    /// σ_r and σ_θ, m and rad.
    pub deviations: [f64; 2],
    /// What is known at first.
    pub initial: InitialCovariance,
    /// How measurements are converted.
    pub conversion: Conversion,
    /// Where their covariance is evaluated.
    pub converted_at: ConvertedAt,
    /// α, β and κ of the unscented rule.
    pub unscented: [f64; 3],
    /// How estimates are mixed.
    pub mixing: Mixing,
}

/// A filter of the comparison.
#[derive(Debug, Clone)]
pub struct RadarFilter {
    /// The paper's name for it.
    pub name: &'static str,
    /// Its modes, chain, measurement and rule.
    pub problem: Problem<f64, U6, U2>,
    /// Its equations.
    pub equations: Equations<f64, U6, U2>,
    /// The number of points of its rule, and of those with a weight other than zero; none for a Kalman filter.
    pub points: Option<(usize, usize)>,
}

/// What a measured range and bearing are of: the entries x and y of the state.
const POSITION: [usize; 2] = [0, 1];

impl RadarSetup {
    /// IMM-CMKF.
    pub fn converted(&self) -> RadarFilter {
        let equations = match self.converted_at {
            ConvertedAt::Measurement => Equations::standard(),
            ConvertedAt::Prediction => Equations::standard().with_conversion_at_prediction(),
        };
        RadarFilter {
            name: "IMM-CMKF",
            problem: self.problem(Filter::converted(self.conversion)),
            equations: self.mixed(&equations),
            points: None,
        }
    }

    /// IMM-UKF.
    ///
    /// # Panics
    ///
    /// When the rule's parameters have no rule; they are part of the program.
    pub fn unscented(&self, bearings: Bearings) -> RadarFilter {
        let [alpha, beta, kappa] = &self.unscented;
        let rule = unscented_in(U6, alpha, beta, kappa).expect("the parameters are part of the program");
        let effective = rule.weights.iter().filter(|weight| **weight != 0.0).count();
        let points = (rule.points.len(), effective);
        let equations = match bearings {
            Bearings::Wrapped => Equations::standard(),
            Bearings::Plain => Equations::standard().with_plain_bearings(),
        };
        RadarFilter {
            name: match bearings {
                Bearings::Wrapped => "IMM-UKF",
                Bearings::Plain => "IMM-UKF, never wrapped",
            },
            problem: self.problem(Filter::points(rule)),
            equations: self.mixed(&equations),
            points: Some(points),
        }
    }

    fn mixed(&self, equations: &Equations<f64, U6, U2>) -> Equations<f64, U6, U2> {
        match self.mixing {
            Mixing::Embedded => *equations,
            Mixing::IndexWise => equations.with_index_wise_mixing(),
            Mixing::Unbiased => equations.with_unbiased_mixing(),
        }
    }

    /// Both modes, constant velocity first.
    fn problem(&self, filter: Filter<f64, U6, U2>) -> Problem<f64, U6, U2> {
        let (t, q) = (&INTERVAL, &self.noise_density);
        Problem {
            modes: vec![
                Mode {
                    name: "constant velocity".to_owned(),
                    motion: motion::Motion::Linear(constant_velocity_in_the_plane(t)),
                    noise: velocity_noise_in_the_plane(q, t),
                },
                Mode {
                    name: "constant acceleration".to_owned(),
                    motion: motion::Motion::Linear(constant_acceleration_in_the_plane(t)),
                    noise: acceleration_noise_in_the_plane(q, t),
                },
            ],
            filters: vec![filter],
            interaction: Interaction::Imm,
            angles: vec![],
            chain: TRANSITION.iter().map(|row| row.to_vec()).collect(),
            sensor: Sensor::Polar {
                components: vec![PolarComponent::Range, PolarComponent::Bearing],
                position: POSITION,
                location: RADAR,
            },
            measurement_noise: Matrix2::from_diagonal(&self.variances()),
        }
    }

    fn variances(&self) -> Vector2<f64> {
        Vector2::from(self.deviations.map(|deviation| deviation * deviation))
    }

    /// The estimate of one measured point — sustika2015 (one-point-initiation).
    ///
    /// Its position, and no velocity or acceleration; constant velocity knows that it has none.
    ///
    /// Example: one kilometre on the x-axis.
    ///
    /// ```
    /// use immaculate::paper::specification::Choices;
    /// use immaculate::paper::sustika2015::scenario;
    /// use nalgebra::vector;
    ///
    /// let setup = scenario(&Choices::default())?.setup;
    /// let estimate = setup.initial(&vector![1000.0, 0.0]);
    /// assert_eq!(estimate.modes[0].mean, vector![1000.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    /// assert_eq!(estimate.modes[0].covariance[(4, 4)], 0.0); // constant velocity has no acceleration
    /// # Ok::<(), immaculate::paper::specification::InvalidChoice>(())
    /// ```
    ///
    /// Evidence: `a_run_begins_at_the_first_measurement_and_is_measured_from_the_first_step_that_is_filtered`.
    pub fn initial(&self, first: &Vector2<f64>) -> Initial<f64, U6> {
        let ([range, bearing], variances) = ([first[0], first[1]], self.variances());
        let position = self.conversion.position(&range, &bearing, &variances[1]);
        let (of_position, [of_velocity, of_acceleration]) = match self.initial {
            InitialCovariance::OnePoint { velocity, acceleration } => (
                self.conversion
                    .covariance(&range, &bearing, &variances[0], &variances[1]),
                [velocity, acceleration],
            ),
            InitialCovariance::Constant([position, velocity, acceleration]) => {
                (Matrix2::identity() * position, [velocity, acceleration])
            }
        };
        let estimate = |of_acceleration: f64| {
            let [vx, vy] = INITIAL_VELOCITY_ESTIMATE;
            let variances = [0.0, 0.0, of_velocity, of_velocity, of_acceleration, of_acceleration];
            let mut covariance = Matrix6::from_diagonal(&Vector6::from(variances));
            covariance.fixed_view_mut::<2, 2>(0, 0).copy_from(&of_position);
            Gaussian {
                mean: Vector6::new(RADAR[0] + position[0], RADAR[1] + position[1], vx, vy, 0.0, 0.0),
                covariance,
            }
        };
        Initial {
            modes: vec![estimate(0.0), estimate(of_acceleration)],
            mode_probabilities: INITIAL_PROBABILITIES.to_vec(),
        }
    }
}
