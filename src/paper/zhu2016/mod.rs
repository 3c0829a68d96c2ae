//! Zhu, Wang and Yuan 2016: the IMM filter with fifth-degree cubature Kalman filters.
//!
//! A guide from each equation of the paper to the code, its simulation with every open choice, and the verdicts on its claims
//! ([`claims`]).
//!
//! The paper in its own order, section by section:
//!
//! - 2.1 points of the estimate, (1)-(10): [`cholesky`](crate::matrix::cholesky),
//!   [`fifth_degree`](crate::rule::fifth_degree::fifth_degree), [`diagonals_plus`](crate::rule::fifth_degree::diagonals_plus),
//!   [`diagonals_minus`](crate::rule::fifth_degree::diagonals_minus), [`point`](crate::filter::cubature::point)
//! - 2.1 their weights, (11)-(13): [`centre_weight`](crate::rule::fifth_degree::centre_weight),
//!   [`axis_weight`](crate::rule::fifth_degree::axis_weight), [`diagonal_weight`](crate::rule::fifth_degree::diagonal_weight), which (13)
//!   [prints](crate::rule::printed::diagonal_weight) twice too large
//! - 2.1 prediction, (14)-(26): [`propagated_point`](crate::filter::cubature::propagated_point),
//!   [`weighted_mean`](crate::filter::cubature::weighted_mean), [`raw_covariance`](crate::filter::raw::raw_covariance), of which (24)
//!   lacks two terms; the filter has the equal [`weighted_covariance`](crate::filter::cubature::weighted_covariance)
//! - 2.2 measured points, (27)-(44): the same points of the prediction, [`Sensor::of`](crate::model::Sensor::of),
//!   [`Sensor::mean`](crate::model::Sensor::mean)
//! - 2.2 update, (45)-(53): [`innovation_covariance`](crate::filter::cubature::innovation_covariance),
//!   [`cross_covariance`](crate::filter::cubature::cross_covariance), [`gain`](crate::filter::update::gain),
//!   [`updated_mean`](crate::filter::update::updated_mean), [`updated_covariance`](crate::filter::update::updated_covariance)
//! - 3.1 input integration, (54)-(56): [`mixing_probability`](crate::imm::probability::mixing_probability),
//!   [`mixture_mean`](crate::gaussian::mixture_mean), [`mixture_covariance`](crate::gaussian::mixture_covariance)
//! - 3.2 filtering, as (1)-(53): [`Filter::points`](crate::filter::Filter::points)
//! - 3.3 model probabilities, (57), (58): [`log_density`](crate::gaussian::log_density),
//!   [`mode_probability`](crate::imm::probability::mode_probability); as printed in [`imm::printed`](crate::imm::printed)
//! - 3.4 output integration, (59), (60): the mixture again
//! - 4 scenario, (61)-(63): [`coordinated_turn`](crate::model::motion::coordinated_turn),
//!   [`acceleration_noise`], [`TRANSITION`], [`scenario`]
//! - 4 figures, table 1, (64): [`root_mean_square`](crate::statistics::rmse::root_mean_square),
//!   [`Reproduction`](super::result::Reproduction)
//! - the fifth column of table 1: [`diagonal_mixing`], a labelled stand-in for OMTM-IMM, of which no equations are printed
//! - the claims: [`claims::judge`], those that need no runs in [`arithmetic`]
//!
//! Motion and measurement are linear here. Any rule that is exact to degree two then *is* the Kalman filter, so that three of the five
//! columns of the paper's table must be equal; they are not.

pub mod arithmetic;
pub mod claims;
pub mod diagonal_mixing;

use super::comparison::ErrorQuantity;
use super::scenario::{Contestant, Course, Scenario};
use super::simulation::Average;
use super::specification::{Choices, InvalidChoice, zhu2016 as specification};
use crate::filter::Filter;
use crate::imm::{Equations, Interaction, Problem};
use crate::model::motion::{Mode, Motion, acceleration_input, acceleration_noise};
use crate::model::{PolarComponent, Sensor};
use crate::number::Rational;
use crate::rule::RuleName;
use crate::rule::unscented::Parameters;
use nalgebra::{Matrix4, U2, U4, Vector2, Vector4, matrix};

/// T, s.
pub const INTERVAL: f64 = 1.0;
/// The number of steps: a simulated time of 100 s.
pub const STEPS: usize = 100;
/// The number of runs.
pub const RUNS: usize = 100;
/// |ω|, rad/s: printed as 3°, taken per second — zhu2016 (turn-rate).
///
/// Example: twenty seconds turn by 60°.
///
/// ```
/// use immaculate::paper::zhu2016::TURN_RATE;
///
/// let degrees = (TURN_RATE * 20.0).to_degrees();
/// assert!((degrees - 60.0).abs() < 1e-12); // a few units of the last place
/// ```
///
/// Evidence: `the_constants_of_zhu2016_are_the_printed_ones` (traceability).
pub const TURN_RATE: f64 = 3.0 * std::f64::consts::PI / 180.0;
/// X₀, m and m/s.
pub const INITIAL_STATE: [f64; 4] = [1000.0, 200.0, 1000.0, 200.0];
/// The diagonal of P₀, m² and (m/s)².
pub const INITIAL_VARIANCES: [f64; 4] = [1000.0, 10.0, 1000.0, 10.0];
/// The diagonal entries of q, (m/s²)² — zhu2016 (acceleration-noise).
///
/// Example: in one second it moves the velocity by a variance of 10 (m/s)², and the position by a quarter of that in m².
///
/// ```
/// use immaculate::paper::zhu2016::ACCELERATION_VARIANCE;
///
/// let noise = immaculate::model::motion::acceleration_noise(&ACCELERATION_VARIANCE, &1.0);
/// assert_eq!((noise[(1, 1)], noise[(0, 0)]), (10.0, 2.5));
/// ```
///
/// Evidence: `the_constants_of_zhu2016_are_the_printed_ones` (traceability).
pub const ACCELERATION_VARIANCE: f64 = 10.0;
/// The diagonal of r, m² — zhu2016 (measurement-noise).
///
/// Example: x is off by √20 m, y by √0.1 m: their variances are 200 to one.
///
/// ```
/// use immaculate::paper::zhu2016::MEASUREMENT_VARIANCES;
///
/// let [x, y] = MEASUREMENT_VARIANCES;
/// assert_eq!(x / y, 200.0);
/// ```
///
/// Evidence: `the_constants_of_zhu2016_are_the_printed_ones` (traceability).
pub const MEASUREMENT_VARIANCES: [f64; 2] = [20.0, 0.1];

/// The transition matrix of the Markov chain — zhu2016 (63).
///
/// Rows are the modes at k − 1: constant velocity, right turn, left turn (the paper does not number its turns).
///
/// Example: a target that is certainly in the right turn, the second mode, moves on by the second row.
///
/// ```
/// use immaculate::imm::probability::predicted_mode_probability;
/// use immaculate::paper::zhu2016::TRANSITION;
///
/// let chain = TRANSITION.map(Vec::from);
/// let predicted = [0, 1, 2].map(|mode| predicted_mode_probability(&chain, &[0.0, 1.0, 0.0], mode));
/// assert_eq!(predicted, [0.1, 0.8, 0.1]);
/// ```
///
/// Evidence: `the_constants_of_zhu2016_are_the_printed_ones` (traceability).
pub const TRANSITION: [[f64; 3]; 3] = [[0.9, 0.05, 0.05], [0.1, 0.8, 0.1], [0.05, 0.15, 0.8]];

/// The scenario under the given choices.
///
/// # Errors
///
/// [`InvalidChoice`] for a parameter or an alternative that the paper's scenario does not have.
pub fn scenario(choices: &Choices) -> Result<Scenario, InvalidChoice> {
    let specification = specification();
    specification.check(choices)?;
    let chosen = |parameter| specification.chosen(choices, parameter);

    let (sensor, measurement_deviations) = sensor(chosen("measurement")?);
    let noise = match chosen("filter-noise")? {
        "tenth" => ACCELERATION_VARIANCE / 10.0,
        "hundredth" => ACCELERATION_VARIANCE / 100.0,
        _ => ACCELERATION_VARIANCE,
    };
    let truth_noise_root = match chosen("truth-noise")? {
        "as-in-the-filters" => Some(truth_noise_root()),
        _ => None,
    };
    let turns = match chosen("model-order")? {
        "left-second" => [Course::LeftTurn, Course::RightTurn],
        _ => [Course::RightTurn, Course::LeftTurn],
    };
    let initial_probabilities = match chosen("initial-probabilities")? {
        "stationary" => vec![10.0 / 23.0, 7.0 / 23.0, 6.0 / 23.0],
        "mostly-constant-velocity" => vec![0.8, 0.1, 0.1],
        _ => vec![1.0 / 3.0; 3],
    };
    let schedule_shift = match chosen("switch-instants")? {
        "from-21-to-40" => 1,
        _ => 0,
    };
    let unscented = match chosen("unscented")? {
        "kappa-0" => Parameters::of_kappa(Rational::new(0, 1)),
        "scaled" => Parameters {
            alpha: Rational::new(1, 1000),
            beta: Rational::new(2, 1),
            kappa: Rational::new(0, 1),
        },
        _ => Parameters::for_gaussian(4),
    };
    let build = Builder {
        sensor: sensor.clone(),
        measurement_deviations,
        noise,
        initial_probabilities,
    };
    let motions = [Course::Straight, turns[0], turns[1]];
    let mut contestants = vec![
        build.imm("IMM5CKF", &motions, &RuleName::FifthDegree),
        build.imm("IMMCKF", &motions, &RuleName::ThirdDegree),
        build.imm("IMMUKF", &motions, &RuleName::Unscented(Some(unscented))),
        build.single(chosen("single-model")?),
    ];
    if chosen("omtm-imm")? == "stand-in" {
        contestants.push(build.stand_in(&motions));
    }
    Ok(Scenario {
        paper: "zhu2016",
        choices: choices.clone(),
        runs: RUNS,
        first_time: INTERVAL,
        interval: INTERVAL,
        turn_rate: TURN_RATE,
        initial_state: Vector4::from(INITIAL_STATE),
        initial_covariance: Matrix4::from_diagonal(&Vector4::from(INITIAL_VARIANCES)),
        draws_initial_estimate: chosen("initial-estimate")? == "drawn",
        schedule: schedule(schedule_shift),
        truth_noise_root,
        sensor,
        measurement_deviations,
        paired: chosen("pairing")? == "paired",
        average: match chosen("table-average")? {
            "mean" => Average::Mean,
            _ => Average::RootMeanSquare,
        },
        contestants,
    })
}

/// "The target turns right during 20 s ~ 40 s, turns left during 60 s ~ 80 s, and maintains uniform motion during the other time": the
/// motion of steps 1 to 100, with turns in 20 ≤ k < 40 and 60 ≤ k < 80, or `shift` steps later.
fn schedule(shift: usize) -> Vec<Course> {
    (1..=STEPS)
        .map(|k| match k {
            k if (20 + shift..40 + shift).contains(&k) => Course::RightTurn,
            k if (60 + shift..80 + shift).contains(&k) => Course::LeftTurn,
            _ => Course::Straight,
        })
        .collect()
}

/// The measurement and the standard deviations of its noise. "r = diag(20, 0.1)" reads like a range and a bearing, which are the
/// alternatives.
fn sensor(name: &str) -> (Sensor<f64, U4, U2>, Vector2<f64>) {
    let positions = Sensor::Linear(matrix![1.0, 0.0, 0.0, 0.0; 0.0, 0.0, 1.0, 0.0]);
    let polar = Sensor::Polar {
        components: vec![PolarComponent::Range, PolarComponent::Bearing],
        position: [0, 2],
        location: [0.0, 0.0],
    };
    let [in_x, in_y] = MEASUREMENT_VARIANCES;
    let (measurement, variances) = match name {
        "equal-noise" => (positions, [in_x, in_x]),
        "range-bearing" => (polar, [in_x, 1e-8]),
        "range-bearing-coarse" => (polar, [in_x, 1e-7]),
        _ => (positions, [in_x, in_y]),
    };
    (measurement, Vector2::from(variances.map(f64::sqrt)))
}

/// A square root of G q Gᵀ: G √q, with two columns of zeros.
fn truth_noise_root() -> Matrix4<f64> {
    let mut root = Matrix4::zeros();
    let input = acceleration_input(&INTERVAL) * ACCELERATION_VARIANCE.sqrt();
    root.fixed_columns_mut::<2>(0).copy_from(&input);
    root
}

/// What the contestants have in common.
struct Builder {
    sensor: Sensor<f64, U4, U2>,
    measurement_deviations: Vector2<f64>,
    noise: f64,
    initial_probabilities: Vec<f64>,
}

impl Builder {
    fn problem(&self, motions: &[Course], noise: f64) -> Problem<f64, U4, U2> {
        let mode = |motion: &Course| Mode {
            name: motion.name().to_owned(),
            motion: Motion::Linear(motion.transition(TURN_RATE, INTERVAL)),
            noise: acceleration_noise(&noise, &INTERVAL),
        };
        let chain = match motions {
            [_] => vec![vec![1.0]],
            _ => TRANSITION.iter().map(|row| row.to_vec()).collect(),
        };
        let variances = self.measurement_deviations.map(|deviation| deviation * deviation);
        Problem {
            modes: motions.iter().map(mode).collect(),
            chain,
            sensor: self.sensor.clone(),
            measurement_noise: nalgebra::Matrix2::from_diagonal(&variances),
            filters: vec![Filter::kalman()],
            interaction: Interaction::Imm,
            angles: vec![],
        }
    }

    fn imm(&self, name: &str, motions: &[Course], rule: &RuleName) -> Contestant {
        let problem = self.problem(motions, self.noise);
        Contestant::with_rule(name, problem, rule, self.initial_probabilities.clone())
    }

    /// The filter of one model that the paper calls 5CKF, without saying of which model.
    fn single(&self, alternative: &str) -> Contestant {
        let (motion, noise) = match alternative {
            "coordinated-turn" => (Course::RightTurn, self.noise),
            "left-turn" => (Course::LeftTurn, self.noise),
            "constant-velocity-ten-times-noise" => (Course::Straight, 10.0 * self.noise),
            _ => (Course::Straight, self.noise),
        };
        let problem = self.problem(&[motion], noise);
        Contestant::with_rule("5CKF", problem, &RuleName::FifthDegree, vec![1.0])
    }

    /// The stand-in for OMTM-IMM: Kalman filters where the measurement is linear, cubature filters of degree three where it is not.
    fn stand_in(&self, motions: &[Course]) -> Contestant {
        let problem = self.problem(motions, self.noise);
        let name = "OMTM-IMM (stand-in)";
        if let Sensor::Linear(_) = self.sensor {
            return Contestant {
                name: name.to_owned(),
                problem,
                equations: diagonal_mixing::equations(),
                initial_probabilities: self.initial_probabilities.clone(),
                points: None,
            };
        }
        let mixing = diagonal_mixing::equations();
        Contestant {
            equations: Equations {
                mixed_mean: mixing.mixed_mean,
                mixed_covariance: mixing.mixed_covariance,
                ..Equations::standard()
            },
            ..self.imm(name, motions, &RuleName::ThirdDegree)
        }
    }
}

/// The quantity of a row of the paper's table 1; none for its times.
pub fn quantity_of_row(name: &str) -> Option<ErrorQuantity> {
    match name {
        "RMSE_X" => Some(ErrorQuantity::X),
        "RMSE_X_V" => Some(ErrorQuantity::VelocityX),
        "RMSE_Y" => Some(ErrorQuantity::Y),
        "RMSE_Y_V" => Some(ErrorQuantity::VelocityY),
        _ => None,
    }
}
