//! Derbez, Rémillard and Jouan 2000: an IMM filter of constant velocity and constant acceleration whose gains are fixed.
//!
//! A guide from each equation of the paper to the code, its simulations with every open choice, and the verdicts on its claims
//! ([`claims`]).
//!
//! The paper in its own order, section by section:
//!
//! - 2.1 the IMM algorithm, (1)-(4): [`mixture_covariance`](crate::gaussian::mixture_covariance), [`kalman`](crate::filter::kalman) and
//!   [`update`](crate::filter::update), [`mixing_probability`](crate::imm::probability::mixing_probability),
//!   [`innovation_covariance`](crate::filter::kalman::innovation_covariance)
//! - 2.2 motion, (5), (6): [`embedded_constant_velocity`](crate::model::acceleration::embedded_constant_velocity),
//!   [`acceleration_part`](crate::model::acceleration::acceleration_part),
//!   [`constant_acceleration`](crate::model::acceleration::constant_acceleration)
//! - 2.2 proposition, (7): [`Mismatch`](crate::steady::mismatch::Mismatch), whose
//!   [`long_term_error`](crate::steady::mismatch::Mismatch::long_term_error) it is
//! - 2.2 theorem: [`instances`]: what refutes it, and what holds in its place
//! - 2.2 algorithm, figures 1 and 2: [`predict`](crate::steady::long_term::predict), [`Grid`](crate::steady::simulated::Grid)
//! - 2.2 remark 1: [`remark_1_matrix`](crate::steady::pair::remark_1_matrix), [`frozen_matrix`](crate::steady::pair::frozen_matrix)
//! - 2.2 the recursion undone, (8): [`unrolled`](crate::steady::unrolled::unrolled)
//! - 3 fixed gains: [`gains`](crate::steady::gains), [`riccati`](crate::steady::riccati), [`fixed_gain`](crate::filter::fixed_gain)
//! - 3.1 moment matching: [`perturbation`](crate::steady::perturbation)
//! - 3.2 coordinates: [`radar`], [`contestants::Coordinates`]
//! - 4 simulations, tables 1 and 2: [`path`], [`contestants`], [`scenario`](mod@scenario), [`operations`](super::operations),
//!   [`search`]
//! - 5 stability of the whole: [`verdict`](crate::steady::verdict), [`map`](crate::steady::map)
//! - the claims: [`claims::judge`]
//!
//! The files of this folder:
//!
//! - [`path`]: where the target goes in scenarios 1 and 2;
//! - [`radar`]: range and bearing, and the positions that are made of them;
//! - [`scenario`](mod@scenario): two filters, one a coordinate, and a run of them;
//! - [`contestants`]: the three filters that are compared;
//! - [`search`]: whether anything that scenario 2 leaves open gives the figures of the published table;
//! - [`claims`], [`arithmetic`]: the judges of the claims, with runs and without;
//! - [`stability`], [`instances`]: the judges of the claims on stability, and the small filters that decide them;
//! - [`long_term`]: those on the long-term error and on the cost;
//! - [`relative`]: how a claim is judged whose configuration was not published.
//!
//! Scenario 3 uses measurements of another paper that were not published: nothing of it can be run.

pub mod arithmetic;
pub mod claims;
pub mod contestants;
pub mod instances;
pub mod long_term;
pub mod path;
pub mod radar;
pub mod relative;
pub mod scenario;
pub mod search;
pub mod stability;

use super::comparison::ErrorQuantity;
use super::specification::{Choices, InvalidChoice, derbez2000 as specification};
use crate::model::Conversion;
use contestants::{CoordinateSetup, MeasurementNoise, Reading};
use path::{Line, Manoeuvres, TruePath};
use scenario::CoordinateScenario;

/// t of scenario 1, s: "one rotation every 2 seconds".
pub const INTERVAL: f64 = 2.0;
/// The number of runs of scenario 2.
pub const RUNS: usize = 100;
/// The acceleration of scenario 1, m/s².
pub const ACCELERATION: f64 = 5.0;
/// The distance of the closest approach of scenario 1, m.
pub const CLOSEST_APPROACH: f64 = 500.0;
/// The data point of the closest approach.
pub const CLOSEST_POINT: usize = 60;
/// The number of data points of scenario 1.
pub const POINTS: usize = 120;
/// The numbers of steps of scenario 2: acceleration, straight, turn, straight.
pub const PHASES: [usize; 4] = [10, 10, 30, 20];
/// The variances of range and bearing, m² and rad².
pub const MEASUREMENT_VARIANCES: [f64; 2] = [0.0025, 0.0001];
/// The transition matrix of the Markov chain, constant velocity first: section 3 — derbez2000 (transition).
///
/// Example: whatever the mode is now, some mode comes next.
///
/// ```
/// use immaculate::paper::derbez2000::TRANSITION;
///
/// assert!(TRANSITION.iter().all(|row| row[0] + row[1] == 1.0));
/// ```
///
/// Evidence: `the_constants_of_derbez2000_are_the_printed_ones` (traceability).
pub const TRANSITION: [[f64; 2]; 2] = crate::steady::map::CHAIN;
/// Operations a cycle of IMM, fixed gain and CA, in section 4.
pub const OPERATIONS_OF_SECTION_4: [u32; 3] = [1332, 242, 590];
/// The same in section 4.1.
pub const OPERATIONS_OF_SECTION_4_1: [u32; 3] = [242, 590, 1322];
/// The mode probabilities at step 0.
pub const INITIAL_PROBABILITIES: [f64; 2] = [0.5, 0.5];
/// The variance of each entry of the state at step 0: "all covariances … were initialised to the identity".
pub const INITIAL_VARIANCE: f64 = 1.0;

/// A degree, rad.
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// The scenario under the given choices.
///
/// # Errors
///
/// [`InvalidChoice`] for a parameter or an alternative that the paper's scenarios do not have.
pub fn scenario(choices: &Choices) -> Result<CoordinateScenario, InvalidChoice> {
    let specification = specification();
    specification.check(choices)?;
    let chosen = |parameter| specification.chosen(choices, parameter);
    let (path, interval) = match (chosen("scenario")?, chosen("scan-time")?) {
        ("acceleration", _) => (accelerated(chosen("path")?), INTERVAL),
        (_, "1") => (path::manoeuvres(&manoeuvres(choices)?, PHASES, 1.0), 1.0),
        _ => (path::manoeuvres(&manoeuvres(choices)?, PHASES, INTERVAL), INTERVAL),
    };
    let setup = CoordinateSetup {
        interval,
        reading: match chosen("mixing")? {
            "unmixed" => Reading::Unmixed,
            _ => Reading::Mixed,
        },
        noise_variance: match chosen("noise-variance")? {
            "40" => 40.0,
            "1" => 1.0,
            "0-01" => 0.01,
            _ => 5.0,
        },
        noise: match chosen("measurement-variance")? {
            "per-step" => MeasurementNoise::OfEachMeasurement,
            "range" => MeasurementNoise::Constant(MEASUREMENT_VARIANCES[0]),
            "0-05" => MeasurementNoise::Constant(0.05),
            "0-5" => MeasurementNoise::Constant(0.5),
            _ => MeasurementNoise::MeanOverThePath,
        },
        initial_variance: match chosen("initial-covariance")? {
            "small" => 1e-6,
            _ => INITIAL_VARIANCE,
        },
    };
    let conversion = match chosen("debiasing")? {
        "multiplicative" => Conversion::Multiplicative,
        "additive" => Conversion::Additive,
        _ => Conversion::Standard,
    };
    Ok(assembled(choices.clone(), path, conversion, &setup))
}

/// A scenario on a path with the paper's three filters.
pub fn assembled(
    choices: Choices,
    path: TruePath,
    conversion: Conversion,
    setup: &CoordinateSetup,
) -> CoordinateScenario {
    CoordinateScenario {
        choices,
        runs: RUNS,
        setup: *setup,
        variances: MEASUREMENT_VARIANCES,
        conversion,
        contestants: setup.contestants(&path),
        path,
    }
}

/// Scenario 1: "moving at an acceleration of 5", "in a straight line with a distance of closest approach to the radar of 500 at the 60th
/// data point".
fn accelerated(alternative: &str) -> TruePath {
    let line = match alternative {
        "turning-point" => Line::TurningPoint,
        "reversed" => Line::Reversed,
        _ => Line::FromRest,
    };
    path::line(line, ACCELERATION, CLOSEST_APPROACH, CLOSEST_POINT, POINTS, INTERVAL)
}

/// What scenario 2 leaves open, under the given choices.
fn manoeuvres(choices: &Choices) -> Result<Manoeuvres, InvalidChoice> {
    let chosen = |parameter| specification().chosen(choices, parameter);
    let distance = match chosen("start")? {
        "100" => 100.0,
        "20" => 20.0,
        _ => CLOSEST_APPROACH,
    };
    Ok(Manoeuvres {
        start: [0.0, distance],
        heading: match chosen("heading")? {
            "diagonal" => 45.0 * DEGREE,
            "away" => 90.0 * DEGREE,
            _ => 0.0,
        },
        speed: match chosen("initial-speed")? {
            "1" => 1.0,
            "10" => 10.0,
            _ => 0.0,
        },
        acceleration: match chosen("acceleration")? {
            "1" => 1.0,
            "0-2" => 0.2,
            _ => ACCELERATION,
        },
        turn_rate: DEGREE
            * match chosen("turn-rate")? {
                "3-right" => -3.0,
                "1-left" => 1.0,
                "9-left" => 9.0,
                _ => 3.0,
            },
    })
}

/// The quantity of a row of the paper's table 1; none for its costs.
pub fn quantity_of_row(name: &str) -> Option<ErrorQuantity> {
    match name {
        "x-RMS" => Some(ErrorQuantity::X),
        "y-RMS" => Some(ErrorQuantity::Y),
        "Overall" => Some(ErrorQuantity::Position),
        _ => None,
    }
}
