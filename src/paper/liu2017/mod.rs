//! Liu and Wu 2017: the IMM filter with fifth-degree spherical simplex-radial cubature Kalman filters.
//!
//! A guide from each equation of the paper to the code, its simulation with every open choice, and the verdicts on its claims
//! ([`claims`]).
//!
//! The paper in its own order, section by section:
//!
//! - 2 motion and measurement, (1): [`Mode`], [`Sensor`]
//! - 2.1 the integral, (2), (3): the head of [`crate::rule`]
//! - 2.1.1 spherical rule, (4)-(7): [`sphere_vertex_weight`](crate::rule::simplex::sphere_vertex_weight),
//!   [`sphere_edge_weight`](crate::rule::simplex::sphere_edge_weight), [`vertices`](crate::rule::simplex::vertices),
//!   [`edge_midpoints`](crate::rule::simplex::edge_midpoints)
//! - 2.1.2 radial rule, (8)-(10): [`radial_rule`](crate::rule::simplex::radial_rule)
//! - 2.1.3 the rule, (11): [`simplex`](crate::rule::simplex::simplex), [printed](crate::rule::printed::edge_weight_11) with half of a
//!   weight
//! - 3, step 1, interaction, (12), (13): [`mixture_mean`](crate::gaussian::mixture_mean),
//!   [`mixture_covariance`](crate::gaussian::mixture_covariance), [`mixing_probability`](crate::imm::probability::mixing_probability)
//! - 3, step 2 A, time update, (14)-(17): [`point`](crate::filter::cubature::point), [`edge_weight`](crate::rule::simplex::edge_weight),
//!   [printed](crate::rule::printed::edge_weight_16) as an n-th of it, [`weighted_mean`](crate::filter::cubature::weighted_mean),
//!   [`weighted_covariance`](crate::filter::cubature::weighted_covariance)
//! - 3, step 2 B, measurement update, (18)-(20): [`Sensor::of`](crate::model::Sensor::of),
//!   [`innovation_covariance`](crate::filter::cubature::innovation_covariance),
//!   [`cross_covariance`](crate::filter::cubature::cross_covariance), [`gain`](crate::filter::update::gain) and the rest of
//!   [`update`](crate::filter::update)
//! - 3, step 3, probabilities, (21), (22): [`log_density`](crate::gaussian::log_density),
//!   [`mode_probability`](crate::imm::probability::mode_probability); as printed in [`imm::printed`](crate::imm::printed)
//! - 3, step 4, output, (23), (24): the mixture again
//! - 4.1 models, (25)-(32): [`constant_velocity`],
//!   [`coordinated_turn`](crate::model::motion::coordinated_turn), [`integrated_noise`],
//!   [`Sensor::Polar`], [`TRANSITION`], [`scenario`]
//! - 4.2 figures, table 1, (33), (34): [`root_mean_square`](crate::statistics::rmse::root_mean_square),
//!   [`accumulated`](crate::statistics::rmse::accumulated), [`Reproduction`](super::result::Reproduction)
//! - the claims: [`claims::judge`], those that need no runs in [`arithmetic`]
//!
//! The motion is linear, the measurement is range and bearing: only the update differs from a Kalman filter's, and by how much the four
//! filters can differ from each other is a question of how curved the measurement is over the width of an estimate.

pub mod arithmetic;
pub mod claims;

use super::comparison::ErrorQuantity;
use super::scenario::{Contestant, Course, Scenario};
use super::simulation::Average;
use super::specification::{Choices, InvalidChoice, liu2017 as specification};
use crate::filter::Filter;
use crate::imm::{Equations, Interaction, Problem};
use crate::matrix::cholesky;
use crate::model::motion::{Mode, Motion, constant_velocity, integrated_noise};
use crate::model::{PolarComponent, Sensor};
use crate::number::Rational;
use crate::rule::RuleName;
use crate::rule::unscented::Parameters;
use nalgebra::{Matrix2, Matrix4, U2, U4, Vector2, Vector4};

/// T, s.
pub const INTERVAL: f64 = 1.0;
/// The time at which the target starts, s.
pub const FIRST_SECOND: usize = 1;
/// The time at which it ends, s.
pub const LAST_SECOND: usize = 200;
/// |ω|, rad/s: printed as 3°, taken per second — liu2017 (turn-rate).
///
/// Example: fifty seconds turn by 150°.
///
/// ```
/// use immaculate::paper::liu2017::TURN_RATE;
///
/// let degrees = (TURN_RATE * 50.0).to_degrees();
/// assert!((degrees - 150.0).abs() < 1e-12); // a few units of the last place
/// ```
///
/// Evidence: `the_constants_of_liu2017_are_the_printed_ones` (traceability).
pub const TURN_RATE: f64 = 3.0 * std::f64::consts::PI / 180.0;
/// The initial x, m.
pub const INITIAL_X: f64 = 15000.0;
/// The initial velocity, m/s.
pub const INITIAL_VELOCITY: [f64; 2] = [-180.0, 200.0];
/// q of the constant velocity and of the turns, m²/s³.
pub const NOISE_DENSITY: f64 = 1.0;
/// σ of the range, m — liu2017 (measurement-noise).
///
/// Example: the entry of R is its square.
///
/// ```
/// use immaculate::paper::liu2017::RANGE_DEVIATION;
///
/// assert_eq!(RANGE_DEVIATION * RANGE_DEVIATION, 1600.0);
/// ```
///
/// Evidence: `the_constants_of_liu2017_are_the_printed_ones` (traceability).
pub const RANGE_DEVIATION: f64 = 40.0;
/// σ of the bearing, rad — liu2017 (measurement-noise).
///
/// Example: at 15 km it is as far across as 105 m.
///
/// ```
/// use immaculate::paper::liu2017::BEARING_DEVIATION;
///
/// assert!((BEARING_DEVIATION * 15_000.0 - 105.0).abs() < 1e-10); // rounding
/// ```
///
/// Evidence: `the_constants_of_liu2017_are_the_printed_ones` (traceability).
pub const BEARING_DEVIATION: f64 = 0.007;
/// The probabilities of the modes at the start: constant velocity, left turn, right turn.
pub const INITIAL_PROBABILITIES: [f64; 3] = [0.8, 0.1, 0.1];

/// The transition matrix of the Markov chain — liu2017 (32).
///
/// Rows are the modes at k − 1: constant velocity, left turn, right turn.
///
/// Example: from constant velocity: 0.95 stay, 0.025 into either turn.
///
/// ```
/// use immaculate::imm::probability::predicted_mode_probability;
/// use immaculate::paper::liu2017::TRANSITION;
///
/// let chain = TRANSITION.map(Vec::from);
/// let predicted = [0, 1, 2].map(|mode| predicted_mode_probability(&chain, &[1.0, 0.0, 0.0], mode));
/// assert_eq!(predicted, [0.95, 0.025, 0.025]);
/// ```
///
/// Evidence: `the_constants_of_liu2017_are_the_printed_ones` (traceability).
pub const TRANSITION: [[f64; 3]; 3] = [[0.95, 0.025, 0.025], [0.025, 0.95, 0.025], [0.025, 0.025, 0.95]];

/// The scenario under the given choices.
///
/// # Errors
///
/// [`InvalidChoice`] for a parameter or an alternative that the paper's scenario does not have.
pub fn scenario(choices: &Choices) -> Result<Scenario, InvalidChoice> {
    let specification = specification();
    specification.check(choices)?;
    let chosen = |parameter| specification.chosen(choices, parameter);

    let variances = match chosen("initial-covariance")? {
        "cartesian-1600" => [1600.0, 100.0, 1600.0, 100.0],
        "zhu2016" => super::zhu2016::INITIAL_VARIANCES,
        "wide" => [1e6, 1e4, 1e6, 1e4],
        _ => [1e4, 1e2, 1e4, 1e2],
    };
    let y = match chosen("initial-position")? {
        "100" => 100.0,
        _ => 1000.0,
    };
    let [vx, vy] = INITIAL_VELOCITY;
    let initial_state = Vector4::new(INITIAL_X, vx, y, vy);
    let from_first_second = chosen("first-measurement")? == "at-1-s";
    let shift = match chosen("turn-intervals")? {
        "from-22-to-71" => 1,
        _ => 0,
    };
    let bearing_deviation = match chosen("bearing-noise")? {
        "ten-times" => 10.0 * BEARING_DEVIATION,
        _ => BEARING_DEVIATION,
    };
    let unscented = match chosen("unscented")? {
        "kappa-half" => Parameters::of_kappa(Rational::new(1, 2)),
        "scaled" => Parameters {
            alpha: Rational::new(1, 1000),
            beta: Rational::new(2, 1),
            kappa: Rational::new(0, 1),
        },
        _ => Parameters::for_gaussian(4),
    };
    let equations = match chosen("likelihood")? {
        "printed" => Equations::standard().with_likelihood_21(),
        _ => Equations::standard(),
    };
    let deviations = Vector2::new(RANGE_DEVIATION, bearing_deviation);
    let contestant = |name: &str, rule: &RuleName| Contestant {
        equations,
        ..Contestant::with_rule(name, problem(&deviations), rule, INITIAL_PROBABILITIES.to_vec())
    };
    Ok(Scenario {
        paper: "liu2017",
        choices: choices.clone(),
        runs: if chosen("runs")? == "100" { 100 } else { 200 },
        first_time: (if from_first_second {
            FIRST_SECOND
        } else {
            FIRST_SECOND + 1
        }) as f64,
        interval: INTERVAL,
        turn_rate: TURN_RATE,
        initial_state: if from_first_second {
            constant_velocity(&-INTERVAL) * initial_state
        } else {
            initial_state
        },
        initial_covariance: Matrix4::from_diagonal(&Vector4::from(variances)),
        draws_initial_estimate: true,
        schedule: schedule(from_first_second, shift),
        truth_noise_root: match chosen("truth-noise")? {
            "as-in-the-filters" => Some(truth_noise_root()),
            _ => None,
        },
        sensor: sensor(),
        measurement_deviations: deviations,
        paired: chosen("pairing")? == "paired",
        average: Average::RootMeanSquare,
        contestants: vec![
            contestant("IMMUKF", &RuleName::Unscented(Some(unscented))),
            contestant("IMMCKF", &RuleName::ThirdDegree),
            contestant("IMM5thCKF", &RuleName::FifthDegree),
            contestant("IMM5thSSRCKF", &RuleName::Simplex),
        ],
    })
}

/// The motion that reaches the states at 2 s (or 1 s) to 200 s: "from 21 s to 70 s it turns right", "from 121 s to 170 s it maneuvers
/// and turns left", or `shift` seconds later.
fn schedule(from_first_second: bool, shift: usize) -> Vec<Course> {
    let first = if from_first_second {
        FIRST_SECOND
    } else {
        FIRST_SECOND + 1
    };
    (first..=LAST_SECOND)
        .map(|t| match t {
            t if (21 + shift..=70 + shift).contains(&t) => Course::RightTurn,
            t if (121 + shift..=170 + shift).contains(&t) => Course::LeftTurn,
            _ => Course::Straight,
        })
        .collect()
}

/// Range and bearing from a radar at the origin.
fn sensor() -> Sensor<f64, U4, U2> {
    Sensor::Polar {
        components: vec![PolarComponent::Range, PolarComponent::Bearing],
        position: [0, 2],
        location: [0.0, 0.0],
    }
}

/// Three modes with the noise of (27) and (30), and no rule yet.
fn problem(deviations: &Vector2<f64>) -> Problem<f64, U4, U2> {
    let mode = |motion: Course| Mode {
        name: motion.name().to_owned(),
        motion: Motion::Linear(motion.transition(TURN_RATE, INTERVAL)),
        noise: integrated_noise(&NOISE_DENSITY, &INTERVAL),
    };
    Problem {
        modes: [Course::Straight, Course::LeftTurn, Course::RightTurn]
            .map(mode)
            .to_vec(),
        chain: TRANSITION.iter().map(|row| row.to_vec()).collect(),
        sensor: sensor(),
        measurement_noise: Matrix2::from_diagonal(&deviations.map(|deviation| deviation * deviation)),
        filters: vec![Filter::kalman()],
        interaction: Interaction::Imm,
        angles: vec![],
    }
}

/// A square root of (27).
fn truth_noise_root() -> Matrix4<f64> {
    cholesky(&integrated_noise(&NOISE_DENSITY, &INTERVAL)).expect("(27) has full rank")
}

/// The quantity of a row of the paper's table 1; none for the rows of table 2.
pub fn quantity_of_row(name: &str) -> Option<ErrorQuantity> {
    match name {
        "Position ARMSE" => Some(ErrorQuantity::Position),
        "Velocity ARMSE" => Some(ErrorQuantity::Velocity),
        _ => None,
    }
}
