//! Goal: the iterated extended filter is the extended filter of the measurement's tangent where the estimate turns out to be.
//!
//! Method: equality to the bit for one linearisation, to the certified double for linear measurements; each turn from the turns before
//! it; and the slope of what is minimised, which must vanish after many turns and does not after one.
#![allow(clippy::unwrap_used, reason = "in tests a panic is the failure")]

mod common;

use common::problems::{published, read};
use immaculate::filter::extended::measurement_jacobian;
use immaculate::imm::Quantity;
use immaculate::oracle::certify::certify;
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::run::run_in_doubles;
use immaculate::oracle::trace::Trace;
use nalgebra::{DMatrix, DVector};
use serde_json::{Value, json};

/// The same problem with a number of linearisations in every mode.
fn iterated(problem: &Value, times: usize) -> Value {
    let mut other = problem.clone();
    other["format"] = json!("immaculate-problem/2");
    other["filter"] = json!({ "kind": "extended", "iterations": times });
    for mode in other["modes"].as_array_mut().unwrap() {
        mode.as_object_mut().unwrap().remove("filter");
    }
    other
}

fn bits(trace: &Trace) -> Vec<Vec<u64>> {
    let values = trace
        .all_places()
        .filter_map(|place| trace.get(place.0, place.1, place.2));
    values
        .map(|values| values.iter().map(|value| value.to_bits()).collect())
        .collect()
}

#[test]
fn one_iteration_is_the_extended_filter_to_the_last_bit() {
    for id in [
        "extended.generic",
        "extended.turn",
        "extended.wrap.clockwise",
        "heading.extended",
        "missing.extended",
    ] {
        let mut plain = published(id);
        for mode in plain["modes"].as_array_mut().unwrap() {
            mode.as_object_mut().unwrap().remove("filter");
        }
        let run = |problem: &Value| run_in_doubles(&read(problem)).unwrap();
        let (one, stopped) = run(&iterated(&plain, 1));
        assert_eq!(stopped, None);
        assert_eq!(bits(&one), bits(&run(&plain).0), "{id}");
        if id != "heading.extended" {
            assert_ne!(bits(&one), bits(&run(&iterated(&plain, 2)).0), "{id}: nothing is bent");
        }
    }
}

/// The tangent of a matrix is the matrix: values that are equal have equal certified doubles.
#[test]
fn a_linear_measurement_leaves_nothing_to_the_second_turn() {
    let problem = published("extended.as-kalman");
    let trace = |times| certify(&read(&iterated(&problem, times))).unwrap().trace;
    assert_eq!(bits(&trace(1)), bits(&trace(3)));
}

/// A target near the sensor that is hardly known, one mode.
fn near() -> Value {
    published("extended.iterated.one-mode")
}

fn value(trace: &Trace, quantity: Quantity) -> DVector<f64> {
    DVector::from_row_slice(trace.get(1, quantity, 0).unwrap())
}

fn matrix(trace: &Trace, quantity: Quantity) -> DMatrix<f64> {
    DMatrix::from_row_slice(2, 2, trace.get(1, quantity, 0).unwrap())
}

/// The measurement and its slopes at a state.
fn seen(problem: &ProblemFile, state: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>) {
    let setup = problem.setup::<f64>(|value| value).unwrap();
    (
        setup.problem.sensor.of(state),
        measurement_jacobian(&setup.problem.sensor, state),
    )
}

/// h(x) + H(x̂⁻ − x) and H at the x that one turn less gives.
#[test]
fn every_turn_is_linearised_where_the_turns_before_it_end() {
    let trace = |times| certify(&read(&iterated(&near(), times))).unwrap().trace;
    for times in 2..=4 {
        let (before, now) = (trace(times - 1), trace(times));
        let at = value(&before, Quantity::UpdatedMean);
        let (h, slopes) = seen(&read(&near()), &at);
        let mean = value(&now, Quantity::PredictedMean);
        let expected = h + &slopes * (mean - &at);
        assert!((value(&now, Quantity::PredictedMeasurement) - expected).norm() < 1e-12);
        assert!((matrix(&now, Quantity::MeasurementJacobian) - &slopes).norm() < 1e-14);
        // And the rest is the Kalman filter's, with these slopes.
        let p = matrix(&now, Quantity::PredictedCovariance);
        assert!((matrix(&now, Quantity::CrossCovariance) - p * slopes.transpose()).norm() < 1e-11);
        // Linearised at the prediction it would be another filter.
        let (_, elsewhere) = seen(&read(&near()), &value(&now, Quantity::PredictedMean));
        assert!((slopes - elsewhere).norm() > 1e-3);
    }
}

/// The most probable state has P⁻⁻¹(x − x̂⁻) = Hᵀ R⁻¹ (z − h(x)).
#[test]
fn an_iterated_update_ends_where_nothing_is_left_to_be_corrected() {
    let rest = |times: usize| {
        let problem = read(&iterated(&near(), times));
        let (trace, _) = run_in_doubles(&problem).unwrap();
        let x = value(&trace, Quantity::UpdatedMean);
        let z = DVector::from_vec(problem.measurements[0].entries().map(|(_, value)| value).collect());
        let (h, slopes) = seen(&problem, &x);
        let inverse = |matrix: DMatrix<f64>| matrix.try_inverse().unwrap();
        let noise = DMatrix::from_fn(2, 2, |i, k| problem.noise[i][k]);
        let of_state =
            inverse(matrix(&trace, Quantity::PredictedCovariance)) * (x - value(&trace, Quantity::PredictedMean));
        (of_state - slopes.transpose() * inverse(noise) * (z - h)).norm()
    };
    assert!(rest(1) > 0.01, "{}", rest(1));
    assert!(rest(2) < rest(1));
    assert!(rest(40) < 1e-9, "{}", rest(40));
}

#[test]
fn a_count_that_is_none_is_refused_with_its_place() {
    let refusal = |filter: Value| {
        let mut problem = near();
        problem["filter"] = filter;
        ProblemFile::read(&problem.to_string()).unwrap_err().to_string()
    };
    let place = "problem.filter.iterations";
    let none = refusal(json!({ "kind": "extended", "iterations": 0 }));
    assert!(none.starts_with(place), "{none}");
    let half = refusal(json!({ "kind": "extended", "iterations": 1.5 }));
    assert!(half.starts_with(place), "{half}");
    let many = refusal(json!({ "kind": "extended", "iterations": 1000 }));
    assert!(many.starts_with(place) && many.contains("at most 100"), "{many}");
    let other = refusal(json!({ "kind": "kalman", "iterations": 2 }));
    assert!(other.contains("iterations"), "{other}");
    let mut correlated = near();
    correlated["modes"][0]["M"] = json!([[0, 0], [0, 0]]);
    let sentence = ProblemFile::read(&correlated.to_string()).unwrap_err().to_string();
    assert!(
        sentence.starts_with("problem.modes[0].M: is given, and the filter is extended-iterated"),
        "{sentence}"
    );
}

/// A program that has the extended filter need not have this one.
#[test]
fn more_than_one_linearisation_is_a_kind_of_its_own() {
    let kinds = |times| read(&iterated(&near(), times)).kinds().join(" ");
    assert_eq!([1, 2].map(kinds), ["extended", "extended-iterated"]);
}
