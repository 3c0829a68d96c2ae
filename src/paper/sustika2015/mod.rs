//! Sustika and Suryana 2015: IMM filters of a coastal radar, with converted measurements or with unscented points.
//!
//! A guide from each equation of the paper to the code, its simulations with every open choice, and the verdicts on its claims
//! ([`claims`]).
//!
//! The paper in its own order, section by section. Its formulas are lost in the available copy and are put together again from what is
//! left:
//!
//! - 2.1 model, (1)-(4): [`wiener`](crate::model::wiener), [`Sensor::of`](crate::model::Sensor::of),
//!   [`Problem`](crate::imm::Problem)
//! - 2.2 interaction, (5)-(8): [`predicted_mode_probability`](crate::imm::probability::predicted_mode_probability),
//!   [`mixing_probability`](crate::imm::probability::mixing_probability), [`mixture_mean`](crate::gaussian::mixture_mean),
//!   [`mixture_covariance`](crate::gaussian::mixture_covariance); of unequal states [`unequal`](crate::imm::unequal)
//! - 2.2 probabilities, output, (9)-(13): [`log_density`](crate::gaussian::log_density), [`evidence`](crate::imm::probability::evidence),
//!   [`mode_probability`](crate::imm::probability::mode_probability), and the mixture again
//! - 3.1 Kalman filter, (14)-(19): [`kalman`](crate::filter::kalman), [`update`](crate::filter::update)
//! - 3.1 converted measurement, (20)-(26): [`converted_position`](crate::model::conversion::converted_position),
//!   [`converted_covariance`](crate::model::conversion::converted_covariance)
//! - 3.2 unscented filter, (27)-(36): [`unscented`](crate::rule::unscented::unscented), [`cubature`](crate::filter::cubature),
//!   [`update`](crate::filter::update)
//! - 4 scenarios, tables 1 to 3: [`truth`], [`contestants`], [`scenario`](mod@scenario)
//! - 4 measure, (37)-(39): [`percentage_fit_error`](crate::statistics::fit_error::percentage_fit_error),
//!   [`position_fit_error`](crate::statistics::fit_error::position_fit_error)
//! - 5.1, 5.2 tables 4 and 5, figures: [`outcome`], [`sweep`], [`divergence`]
//! - 5.3 cost, table 6: [`operations`](super::operations), [`reasoning`]
//! - the claims: [`claims::judge`]
//!
//! The files of this folder:
//!
//! - [`truth`]: where the target goes, and range and bearing of it;
//! - [`contestants`]: the two filters that are compared, and the unscented one with bearings that are never wrapped;
//! - [`scenario`](mod@scenario): a simulation with every choice made, and a run of it;
//! - [`sweep`]: scenario 3, the filters' noise parameters varied one at a time;
//! - [`reasoning`]: the claims that need no simulation;
//! - [`divergence`]: whether the unscented filter diverges because of the noises or because of the cut of the bearings;
//! - [`outcome`]: what a run shows of both filters, and of the second with bearings that are never wrapped;
//! - [`claims`]: the claims, each with its judge;

pub mod claims;
pub mod contestants;
pub mod divergence;
pub mod outcome;
pub mod reasoning;
pub mod scenario;
pub mod sweep;
pub mod truth;

use super::specification::{Choices, InvalidChoice, sustika2015 as specification};
use crate::model::conversion::Conversion;
use crate::statistics::fit_error::FitForm;
use contestants::{Bearings, ConvertedAt, InitialCovariance, Mixing, RadarSetup};
use scenario::{FirstMeasurement, RadarScenario};
use truth::{Trajectory, TruthNoise};

/// T, s: "sampling interval on simulation is 1 second".
pub const INTERVAL: f64 = 1.0;
/// The number of measurements, at 1, 2, … s: "a total of 200 seconds".
pub const DURATION: usize = 200;
/// The number of runs.
pub const RUNS: usize = 50;
/// The place of the radar, m.
pub const RADAR: [f64; 2] = [0.0, 0.0];
/// x and y at 1 s, m: table 1.
pub const INITIAL_POSITION: [f64; 2] = [-1000.0, 1000.0];
/// ẋ and ẏ at 1 s, m/s: table 1.
pub const INITIAL_VELOCITY: [f64; 2] = [4.0, 3.0];
/// q of the truth, m²/s³ of constant velocity and m²/s⁵ of constant acceleration: table 1.
pub const NOISE_DENSITY: f64 = 0.1;
/// σ_r and σ_θ of the radar, m and rad: table 1.
pub const MEASUREMENT_DEVIATIONS: [f64; 2] = [10.0, DEGREE];
/// First and last second of each manoeuvre as printed, table 1 — sustika2015 (manoeuvre-window).
///
/// Example: as printed, half of the 200 s are manoeuvres.
///
/// ```
/// use immaculate::paper::sustika2015::MANOEUVRING_SECONDS;
///
/// let seconds: usize = MANOEUVRING_SECONDS.iter().map(|[first, last]| last - first + 1).sum();
/// assert_eq!(seconds, 100);
/// ```
///
/// Evidence: `the_constants_of_sustika2015_are_the_printed_ones` (traceability).
pub const MANOEUVRING_SECONDS: [[usize; 2]; 2] = [[1, 50], [71, 120]];
/// q of the filters in scenario 2: table 2.
pub const FILTER_NOISE_DENSITY: f64 = 0.01;
/// σ_r and σ_θ of the filters in scenario 2, m and rad, table 2 — sustika2015 (azimuth-deviation-of-the-filter).
///
/// Example: the azimuth is taken for four times as noisy as it is, the range as it is.
///
/// ```
/// use immaculate::paper::sustika2015::{FILTER_DEVIATIONS, MEASUREMENT_DEVIATIONS};
///
/// let factors = [0, 1].map(|row| FILTER_DEVIATIONS[row] / MEASUREMENT_DEVIATIONS[row]);
/// assert_eq!(factors, [1.0, 4.0]);
/// ```
///
/// Evidence: `the_constants_of_sustika2015_are_the_printed_ones` (traceability).
pub const FILTER_DEVIATIONS: [f64; 2] = [10.0, 4.0 * DEGREE];
/// The transition matrix of the Markov chain, constant velocity first, table 2 — sustika2015 (transition).
///
/// Example: whatever the mode is now, some mode comes next.
///
/// ```
/// use immaculate::paper::sustika2015::TRANSITION;
///
/// assert!(TRANSITION.iter().all(|row| row[0] + row[1] == 1.0));
/// ```
///
/// Evidence: `the_constants_of_sustika2015_are_the_printed_ones` (traceability).
pub const TRANSITION: [[f64; 2]; 2] = [[0.95, 0.05], [0.05, 0.95]];
/// The mode probabilities at first, table 2 — sustika2015 (initial-probabilities).
///
/// Example: one of the two modes holds.
///
/// ```
/// use immaculate::paper::sustika2015::INITIAL_PROBABILITIES;
///
/// assert_eq!(INITIAL_PROBABILITIES[0] + INITIAL_PROBABILITIES[1], 1.0);
/// ```
///
/// Evidence: `the_constants_of_sustika2015_are_the_printed_ones` (traceability).
pub const INITIAL_PROBABILITIES: [f64; 2] = [0.9, 0.1];
/// The estimate of the velocity at first, m/s: section 4.
pub const INITIAL_VELOCITY_ESTIMATE: [f64; 2] = [0.0, 0.0];
/// From, to and interval of q in scenario 3: table 3.
pub const SWEPT_NOISE_DENSITIES: [f64; 3] = [0.01, 1.0, 0.01];
/// From, to and interval of σ_θ in scenario 3, degrees: table 3.
pub const SWEPT_BEARING_DEGREES: [f64; 3] = [0.1, 4.0, 0.1];
/// The percentage fit error below which "performance is good enough for implementation", %.
pub const GOOD_FIT_ERROR: f64 = 3.0;
/// The percentage fit error above which a run is called divergent here, %: the paper does not say when it does.
pub const DIVERGENT_FIT_ERROR: f64 = 20.0;

/// A degree, rad.
pub const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// First and last second of each manoeuvre in the example of the EKF/UKF toolbox, whose times of constant velocity are those that table 1
/// prints for the manoeuvres — sustika2015 (manoeuvre-window).
///
/// Source: Hartikainen, Solin and Särkkä 2011, the example of an IMM filter with constant velocity and constant acceleration.
///
/// Example: what the paper prints for its manoeuvres ends where those of the toolbox begin.
///
/// ```
/// use immaculate::paper::sustika2015::{MANOEUVRING_SECONDS, TOOLBOX_SECONDS};
///
/// assert_eq!(MANOEUVRING_SECONDS, [[1, 50], [71, 120]]);
/// assert!((0..2).all(|turn| MANOEUVRING_SECONDS[turn][1] + 1 == TOOLBOX_SECONDS[turn][0]));
/// ```
///
/// Evidence: `the_printed_manoeuvres_are_the_times_of_constant_velocity_of_the_toolbox`.
pub const TOOLBOX_SECONDS: [[usize; 2]; 2] = [[51, 70], [121, 150]];

/// The simulation under the given choices.
///
/// # Errors
///
/// [`InvalidChoice`] for a parameter or an alternative that the paper's simulations do not have.
pub fn scenario(choices: &Choices) -> Result<RadarScenario, InvalidChoice> {
    let specification = specification();
    specification.check(choices)?;
    let chosen = |parameter| specification.chosen(choices, parameter);
    let (noise_density, deviations) = match chosen("scenario")? {
        "mismatched-straight" | "mismatched-manoeuvring" => (FILTER_NOISE_DENSITY, FILTER_DEVIATIONS),
        _ => (NOISE_DENSITY, MEASUREMENT_DEVIATIONS),
    };
    let bearings = match chosen("wrapping")? {
        "never" => Bearings::Plain,
        _ => Bearings::Wrapped,
    };
    let setup = RadarSetup {
        noise_density,
        deviations,
        ..setup(choices)?
    };
    Ok(RadarScenario {
        choices: choices.clone(),
        trajectory: trajectory(choices)?,
        first_measurement: match chosen("first-measurement")? {
            "filtered" => FirstMeasurement::FilteredAgain,
            _ => FirstMeasurement::Initiation,
        },
        fit_form: match chosen("fit-error")? {
            "joint-norm" => FitForm::JointNorm,
            "root-mean-square" => FitForm::RootMeanSquare,
            "mean" => FitForm::Mean,
            "sum" => FitForm::Sum,
            _ => FitForm::RootSumSquare,
        },
        contestants: vec![setup.converted(), setup.unscented(bearings)],
        setup,
    })
}

/// The trajectory under the given choices.
fn trajectory(choices: &Choices) -> Result<Trajectory, InvalidChoice> {
    let chosen = |parameter| specification().chosen(choices, parameter);
    let noise = match chosen("truth")? {
        "one-trajectory" => TruthNoise::OneTrajectory,
        "noise-free" => TruthNoise::Free,
        _ => TruthNoise::EachRun,
    };
    let manoeuvres: &[[usize; 2]] = match (chosen("scenario")?, chosen("window")?) {
        ("matched-manoeuvring" | "mismatched-manoeuvring", "printed") => &MANOEUVRING_SECONDS,
        ("matched-manoeuvring" | "mismatched-manoeuvring", "complement") => &[[51, 70], [121, DURATION]],
        ("matched-manoeuvring" | "mismatched-manoeuvring", _) => &TOOLBOX_SECONDS,
        _ => &[],
    };
    Ok(Trajectory::new(manoeuvres, noise))
}

/// The parameters that the filters assume under the given choices, in scenario 1.
fn setup(choices: &Choices) -> Result<RadarSetup, InvalidChoice> {
    let chosen = |parameter| specification().chosen(choices, parameter);
    Ok(RadarSetup {
        noise_density: NOISE_DENSITY,
        deviations: MEASUREMENT_DEVIATIONS,
        initial: match chosen("initial-covariance")? {
            "velocity-25" => InitialCovariance::OnePoint {
                velocity: 25.0,
                acceleration: 1.0,
            },
            "toolbox" => InitialCovariance::Constant([0.1, 0.1, 0.5]),
            _ => InitialCovariance::OnePoint {
                velocity: 100.0,
                acceleration: 1.0,
            },
        },
        conversion: chosen("conversion")?.parse().unwrap_or(Conversion::Standard),
        converted_at: match chosen("conversion-noise")? {
            "predicted" => ConvertedAt::Prediction,
            _ => ConvertedAt::Measurement,
        },
        // α, β and κ; n = 6.
        unscented: match chosen("unscented")? {
            "half" => [0.5, 2.0, -3.0],
            "zero" => [1.0, 0.0, 0.0],
            "scaled" => [1e-3, 2.0, 0.0],
            _ => [1.0, 0.0, -3.0],
        },
        mixing: match chosen("mixing")? {
            "index-wise" => Mixing::IndexWise,
            "unbiased" => Mixing::Unbiased,
            _ => Mixing::Embedded,
        },
    })
}

/// The simulation that a row of the paper's tables 4 and 5 is of; none for its execution times.
pub fn scenario_of_row(table: u32, row: &str) -> Option<&'static str> {
    match (table, row) {
        (4, "1st scenario") => Some("matched-straight"),
        (4, "2nd scenario") => Some("mismatched-straight"),
        (5, "1st scenario") => Some("matched-manoeuvring"),
        (5, "2nd scenario") => Some("mismatched-manoeuvring"),
        _ => None,
    }
}
