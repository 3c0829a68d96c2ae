//! Goal: process and measurement noise that are correlated are used as they are in the joint Gaussian of state and measurement.
//!
//! Method: the equations in exact rationals against the joint covariance of what is drawn; whole certified runs against the same problem
//! with the measurement noise in the state, where nothing is correlated any more; and problems that must be refused.
#![allow(clippy::unwrap_used, reason = "in tests a panic is the failure")]
#![allow(clippy::float_cmp, reason = "certified doubles of equal values are equal")]

mod common;

use common::problems::{published, read, refusal};
use immaculate::filter::{correlated, kalman, update};
use immaculate::imm::Quantity;
use immaculate::matrix::ldl;
use immaculate::number::{Field, Rational};
use immaculate::oracle::certify::certify;
use immaculate::oracle::trace::Trace;
use nalgebra::{Matrix2, SMatrix};
use serde_json::{Value, json};

fn rational<const R: usize, const C: usize>(entries: [[i64; C]; R]) -> SMatrix<Rational, R, C> {
    SMatrix::from_fn(|row, column| Rational::integer(entries[row][column]))
}

/// (x, z) are a matrix of (x before, w, v), whose covariance is P, and Q, M, R in one piece.
#[test]
fn correlated_noises_are_conditioning_of_the_joint_gaussian() {
    let (f, h) = (rational([[1, 2], [-1, 3]]), rational([[2, 1], [1, -1]]));
    let p = rational([[5, 1], [1, 4]]);
    let (q, m, r) = (
        rational([[7, 2], [2, 9]]),
        rational([[1, -2], [3, 1]]),
        rational([[8, -1], [-1, 6]]),
    );
    let mut drawn = SMatrix::<Rational, 6, 6>::zeros();
    drawn.fixed_view_mut::<2, 2>(0, 0).copy_from(&p);
    drawn.fixed_view_mut::<2, 2>(2, 2).copy_from(&q);
    drawn.fixed_view_mut::<2, 2>(2, 4).copy_from(&m);
    drawn.fixed_view_mut::<2, 2>(4, 2).copy_from(&m.transpose());
    drawn.fixed_view_mut::<2, 2>(4, 4).copy_from(&r);
    let mut seen = SMatrix::<Rational, 4, 6>::zeros();
    seen.fixed_view_mut::<2, 2>(0, 0).copy_from(&f);
    seen.fixed_view_mut::<2, 2>(0, 2).copy_from(&Matrix2::identity());
    seen.fixed_view_mut::<2, 2>(2, 0).copy_from(&(&h * &f));
    seen.fixed_view_mut::<2, 2>(2, 2).copy_from(&h);
    seen.fixed_view_mut::<2, 2>(2, 4).copy_from(&Matrix2::identity());
    let joint = &seen * drawn * seen.transpose();
    let part = |row, column| joint.fixed_view::<2, 2>(row, column).into_owned();

    let predicted = kalman::predicted_covariance(&f, &p, &q);
    let s = correlated::innovation_covariance(&h, &predicted, &r, &m);
    let c = correlated::cross_covariance(&predicted, &h, &m);
    assert_eq!(
        (predicted.clone(), c.clone(), s.clone()),
        (part(0, 0), part(0, 2), part(2, 2))
    );
    // What is left of x once z is known: P − C S⁻¹ Cᵀ, with the inverse of two rows written out.
    let determinant = s[(0, 0)].clone() * s[(1, 1)].clone() - s[(0, 1)].clone() * s[(1, 0)].clone();
    let adjugate = Matrix2::new(
        s[(1, 1)].clone(),
        -s[(0, 1)].clone(),
        -s[(1, 0)].clone(),
        s[(0, 0)].clone(),
    );
    let known = (&c * adjugate * c.transpose()).map(|entry| entry / determinant.clone());
    let gain = update::gain(&c, &ldl(&s));
    assert_eq!(update::updated_covariance(&predicted, &gain, &s), &predicted - known);
    // As if they were independent it is another filter.
    assert_ne!(kalman::innovation_covariance(&h, &predicted, &r), s);
    assert_ne!(kalman::cross_covariance(&predicted, &h), c);
}

fn certified(problem: &Value) -> Trace {
    certify(&read(problem)).unwrap().trace
}

fn rows_of(value: &Value) -> Vec<Vec<f64>> {
    serde_json::from_value(value.clone()).unwrap()
}

/// Two matrices on the diagonal of one, with another beside them.
fn block(a: &[Vec<f64>], beside: Option<&[Vec<f64>]>, b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let (n, m) = (a.len(), b.len());
    let entry = |i: usize, k: usize| match (i < n, k < n) {
        (true, true) => a[i][k],
        (true, false) => beside.map_or(0.0, |beside| beside[i][k - n]),
        (false, true) => beside.map_or(0.0, |beside| beside[k][i - n]),
        (false, false) => b[i - n][k - n],
    };
    (0..n + m).map(|i| (0..n + m).map(|k| entry(i, k)).collect()).collect()
}

/// The same problem with the noise of the measurement as two more entries of the state, of which nothing is left from step to step. What
/// is measured is then exact, and Q has the correlation.
fn with_noise_in_the_state(problem: &Value) -> Value {
    let mut other = problem.clone();
    let nothing = vec![vec![0.0; 2]; 2];
    other["state"]
        .as_array_mut()
        .unwrap()
        .extend([json!("v0"), json!("v1")]);
    other["units"].as_array_mut().unwrap().extend([json!("m"), json!("m")]);
    for mode in other["modes"].as_array_mut().unwrap() {
        let of_noises = mode.as_object_mut().unwrap().remove("M").map(|rows| rows_of(&rows));
        mode["F"] = json!(block(&rows_of(&mode["F"]), None, &nothing));
        mode["Q"] = json!(block(
            &rows_of(&mode["Q"]),
            of_noises.as_deref(),
            &rows_of(&problem["R"])
        ));
    }
    let mut h = rows_of(&problem["measurement"]["H"]);
    for (i, row) in h.iter_mut().enumerate() {
        row.extend([f64::from(i == 0), f64::from(i == 1)]);
    }
    other["measurement"]["H"] = json!(h);
    other["R"] = json!(nothing);
    for estimate in other["initial"]["modes"].as_array_mut().unwrap() {
        estimate["mean"].as_array_mut().unwrap().extend([json!(0), json!(0)]);
        estimate["covariance"] = json!(block(&rows_of(&estimate["covariance"]), None, &nothing));
    }
    other
}

/// Certified doubles of equal values are equal doubles: mixing, missed detections and missing entries included.
#[test]
fn the_noise_of_the_measurement_may_as_well_be_in_the_state() {
    let problem = published("correlated.kalman");
    let (ours, other) = (certified(&problem), certified(&with_noise_in_the_state(&problem)));
    let n = 4;
    let mut asked = 0;
    for (step, quantity, mode) in ours.all_places() {
        let (Some(ours), Some(other)) = (ours.get(step, quantity, mode), other.get(step, quantity, mode)) else {
            continue;
        };
        let cut: Vec<f64> = match quantity {
            _ if ours.len() == other.len() => other.clone(),
            _ if ours.len() == n * n => other.chunks(n + 2).take(n).flat_map(|row| row[..n].to_vec()).collect(),
            _ => other[..ours.len()].to_vec(),
        };
        assert_eq!(*ours, cut, "step {step}, {}", quantity.name());
        asked += 1;
    }
    assert!(asked > 150, "{asked}");
}

/// Without the noise of the prediction there is another one.
#[test]
fn the_correlation_is_seen_in_the_innovation_and_in_the_gain() {
    let problem = published("correlated.kalman");
    let mut independent = problem.clone();
    for mode in independent["modes"].as_array_mut().unwrap() {
        mode.as_object_mut().unwrap().remove("M");
    }
    let (ours, other) = (certified(&problem), certified(&independent));
    for quantity in [
        Quantity::InnovationCovariance,
        Quantity::CrossCovariance,
        Quantity::Gain,
    ] {
        assert_ne!(ours.get(1, quantity, 0), other.get(1, quantity, 0));
        // The third mode has no such noise.
        assert_eq!(ours.get(1, quantity, 2), other.get(1, quantity, 2));
    }
    for quantity in [Quantity::PredictedCovariance, Quantity::PredictedMeasurement] {
        assert_eq!(ours.get(1, quantity, 0), other.get(1, quantity, 0));
    }
}

/// Nothing in common is what it is without the key.
#[test]
fn a_cross_covariance_of_zeros_changes_nothing() {
    let mut problem = published("steps.kalman");
    problem["format"] = json!("immaculate-problem/2");
    let without = certified(&problem);
    problem["modes"][1]["M"] = json!(vec![vec![0; 2]; 4]);
    assert_eq!(certified(&problem), without);
}

/// At the slopes of a matrix, which are the matrix.
#[test]
fn an_extended_filter_of_matrices_is_the_kalman_filter_with_correlated_noises_too() {
    let problem = published("correlated.kalman");
    let mut extended = problem.clone();
    extended["filter"] = json!({ "kind": "extended" });
    let (kalman, extended) = (certified(&problem), certified(&extended));
    for (step, quantity, mode) in kalman.all_places() {
        if let Some(values) = kalman.get(step, quantity, mode) {
            assert_eq!(Some(values), extended.get(step, quantity, mode), "{}", quantity.name());
        }
    }
}

#[test]
fn what_cannot_be_in_common_is_refused_with_its_place() {
    let problem = published("correlated.kalman");
    let with = |change: &dyn Fn(&mut Value)| {
        let mut other = problem.clone();
        change(&mut other);
        refusal(&other)
    };
    // A correlation above one.
    let sentence = with(&|problem| problem["modes"][1]["M"][0][0] = json!(1000));
    assert!(
        sentence.starts_with("problem.modes[1].M: is more than Q and R allow"),
        "{sentence}"
    );
    // A measurement without noise has nothing in common with anything, whatever step says so.
    let sentence = with(&|problem| problem["measurements"][0]["R"] = json!([[0, 0], [0, 0]]));
    assert!(
        sentence.starts_with("problem.measurements[0]: changes the problem so that `modes[0].M`"),
        "{sentence}"
    );
    let sentence = with(&|problem| problem["modes"][0]["M"] = json!([[1, 2]]));
    assert_eq!(sentence, "problem.modes[0].M: has 1 entries where 4 are needed");
    let sentence = with(&|problem| problem["filter"] = json!({ "kind": "cubature", "rule": "cubature-3" }));
    assert!(
        sentence.starts_with("problem.modes[0].M: is given, and the filter is cubature-3"),
        "{sentence}"
    );
    let sentence = with(&|problem| {
        let sensor = json!({ "name": "other", "measurement": problem["measurement"], "R": problem["R"] });
        problem["sensors"] = json!([sensor]);
    });
    assert!(
        sentence.starts_with("problem.modes[0].M: is given, and there are further sensors"),
        "{sentence}"
    );
    let mut first = published("steps.kalman");
    first["modes"][2]["M"] = json!(vec![vec![0; 2]; 4]);
    let sentence = refusal(&first);
    assert!(
        sentence.starts_with("problem.modes[2].M: needs the format"),
        "{sentence}"
    );
}

/// Exactly on the border: w and v are one and the same.
#[test]
fn noises_may_be_one_and_the_same() {
    let problem = |shared: f64| {
        json!({
            "format": "immaculate-problem/2", "id": "same", "state": ["x"], "F": [[1]], "Q": [[4]], "M": [[shared]],
            "measurement": { "kind": "linear", "H": [[1]] }, "R": [[9]], "filter": { "kind": "kalman" },
            "initial": { "mean": [0], "covariance": [[5]] }, "measurements": [{ "step": 1, "z": [17] }]
        })
    };
    // S = 5 + 4 + 2 · 6 + 9, C = 9 + 6, and 0 + 15/30 · 17.
    let trace = certified(&problem(6.0));
    let value = |quantity| trace.get(1, quantity, 0).unwrap()[0];
    let found = [
        Quantity::InnovationCovariance,
        Quantity::CrossCovariance,
        Quantity::UpdatedMean,
    ]
    .map(value);
    assert_eq!(found, [30.0, 15.0, 8.5]);
    assert!(refusal(&problem(6.5)).starts_with("problem.M: is more than Q and R allow"));
}
