//! Goal: motions and measurements that a problem file gives as formulas or as named models are those of the filter, certified as matrices
//! are; what is wrong with them is said in a sentence, with the place.
//!
//! Method: the same problem is written in two ways and certified twice, a plain filter in doubles is written here, and bad files go
//! through the real command line. Kind of evidence: enclosures, golden doubles, and behaviour on bad input.

mod common;

use common::program::immaculate;
use immaculate::imm::Quantity;
use immaculate::oracle::certify::{Certified, certify};
use immaculate::oracle::invalid::Class;
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::run::run_in_doubles;
use immaculate::oracle::trace::Trace;
use immaculate::oracle::variant;
use nalgebra::{SMatrix, SVector, matrix};
use serde_json::{Value, json};
use std::io::Write;
use std::process::Stdio;

/// Two modes in the plane, range and bearing across ±π, and a missed detection.
fn plane() -> Value {
    let covariance = json!([[25, 1, 0, 0], [1, 4, 0, 0], [0, 0, 25, -1], [0, 0, -1, 4]]);
    json!({
        "format": "immaculate-problem/2",
        "id": "plane",
        "state": ["x", ["vx", "m/s"], ["y", "m"], "vy"],
        "modes": [
            { "name": "straight", "F": [[1, 1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 1], [0, 0, 0, 1]], "Q": quarter(1.0) },
            { "name": "turn", "F": turn(), "Q": quarter(4.0) },
        ],
        "measurement": { "kind": "range-bearing", "components": ["range", "bearing"], "position": [0, 2], "sensor": [0, 0] },
        "R": [[4, 0], [0, 0.015_625]],
        "filter": { "kind": "cubature", "rule": "cubature-5" },
        "transition": [[0.95, 0.05], [0.1, 0.9]],
        "initial": {
            "mode_probabilities": [0.5, 0.5],
            "modes": [
                { "mean": [-40, 1, 3, -4], "covariance": covariance },
                { "mean": [-41, 2, 4, -4], "covariance": covariance },
            ],
        },
        "measurements": [
            { "step": 1, "z": [40, 3.1] },
            { "step": 2, "z": [38, -3.05] },
            { "step": 3, "z": null },
            { "step": 4, "z": [35, -2.9] },
        ],
    })
}

/// A quarter of a number on the diagonal.
fn quarter(size: f64) -> Value {
    let entry = |row: usize, column: usize| if row == column { size / 4.0 } else { 0.0 };
    json!(
        (0..4)
            .map(|row| (0..4).map(|column| entry(row, column)).collect::<Vec<_>>())
            .collect::<Vec<_>>()
    )
}

/// A turn whose entries are doubles: T = 2, sin ωT/ω = ¾ T, (1 − cos ωT)/ω = ¼ T, and 0.6, 0.8 for cos ωT, sin ωT.
fn turn() -> Value {
    json!([[1, 1.5, 0, -0.5], [0, 0.6, 0, -0.8], [0, 0.5, 1, 1.5], [0, 0.8, 0, 0.6]])
}

fn read(file: &Value) -> ProblemFile {
    ProblemFile::read(&file.to_string()).unwrap_or_else(|invalid| panic!("{invalid}"))
}

fn certified(file: &Value) -> Certified {
    certify(&read(file)).unwrap_or_else(|error| panic!("{error}"))
}

/// A problem with a value at another place.
fn with(file: &Value, pointer: &str, value: Value) -> Value {
    let mut changed = file.clone();
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    match changed.pointer_mut(parent).unwrap() {
        Value::Object(object) => drop(object.insert(key.to_owned(), value)),
        Value::Array(list) => list[key.parse::<usize>().unwrap()] = value,
        _ => panic!("{pointer}"),
    }
    changed
}

fn without(file: &Value, parent: &str, key: &str) -> Value {
    let mut changed = file.clone();
    changed
        .pointer_mut(parent)
        .unwrap()
        .as_object_mut()
        .unwrap()
        .shift_remove(key);
    changed
}

// The same problem in two ways

#[test]
fn formulas_of_range_and_bearing_are_the_native_ones() {
    let native = certified(&plane());
    let formulas = |kind: Value| {
        let z = json!([["range", "m"], kind]);
        let h = json!(["sqrt(x*x + y*y)", "atan2(y, x)"]);
        with(&plane(), "/measurement", json!({ "kind": "formulas", "z": z, "h": h }))
    };
    let as_formulas = certified(&formulas(json!(["bearing", "rad", "angle"])));
    assert_eq!(native.trace, as_formulas.trace);
    assert_eq!(native.scale, as_formulas.scale);
    let model = json!({ "kind": "model", "model": "range-bearing" });
    assert_eq!(native.trace, certified(&with(&plane(), "/measurement", model)).trace);
    // A bearing that nobody calls an angle is not wrapped.
    assert_ne!(native.trace, certified(&formulas(json!(["bearing", "rad"]))).trace);
}

#[test]
fn formulas_of_a_turn_are_its_matrix() {
    let formulas = |sign: &str| {
        json!({ "name": "turn", "Q": quarter(4.0),
            "parameters": { "T": 2, "c": 0.6, "s": 0.8 },
            "let": [["along", "0.75*T"], ["across", "T/4"]],
            "f": ["x + along*vx - across*vy", format!("c*vx {sign} s*vy"), "y + across*vx + along*vy", "s*vx + c*vy"] })
    };
    for filter in [
        json!({ "kind": "cubature", "rule": "cubature-3" }),
        json!({ "kind": "kalman" }),
    ] {
        let sensor = json!({ "kind": "linear", "H": [[1, 0, 0, 0], [0, 0, 1, 0]] });
        let file = with(&with(&plane(), "/filter", filter), "/measurement", sensor);
        let as_matrix = certified(&file);
        assert_eq!(
            as_matrix.trace,
            certified(&with(&file, "/modes/1", formulas("-"))).trace
        );
        assert_ne!(
            as_matrix.trace,
            certified(&with(&file, "/modes/1", formulas("+"))).trace
        );
    }
}

#[test]
fn a_named_turn_is_its_formulas() {
    let noise = json!({ "model": "constant-velocity-white-noise", "parameters": { "q": 0.5 } });
    let rows = json!([
        ["q*T^3/3", "q*T^2/2", 0, 0],
        ["q*T^2/2", "q*T", 0, 0],
        [0, 0, "q*T^3/3", "q*T^2/2"],
        [0, 0, "q*T^2/2", "q*T"],
    ]);
    let model = json!({ "model": "coordinated-turn", "parameters": { "w": 0.1 } });
    let named = json!({ "name": "turn", "motion": model, "Q": noise });
    let formulas = json!({ "name": "turn", "Q": rows, "parameters": { "w": 0.1, "q": 0.5 },
        "let": [["a", "w*T"]],
        "f": ["x + sin(a)/w*vx - (1 - cos(a))/w*vy", "cos(a)*vx - sin(a)*vy",
              "y + (1 - cos(a))/w*vx + sin(a)/w*vy", "sin(a)*vx + cos(a)*vy"] });
    let file = with(&plane(), "/parameters", json!({ "T": 1.5 }));
    let [named, formulas] = [named, formulas].map(|mode| certified(&with(&file, "/modes/1", mode)));
    assert_eq!(named.trace, formulas.trace);
}

#[test]
fn a_known_input_moves_the_mean_and_not_the_covariance() {
    let mode = |f: &str| json!({ "name": "fall", "parameters": { "g": 9.75, "T": 2 }, "f": [f], "Q": [[1]] });
    let file = |f: &str| {
        json!({ "format": "immaculate-problem/2", "id": "fall", "state": [["v", "m/s"]], "modes": [mode(f)],
            "measurement": { "kind": "linear", "H": [[1]] }, "R": [[5]], "filter": { "kind": "kalman" }, "transition": [[1]],
            "initial": { "mode_probabilities": [1], "modes": [{ "mean": [3], "covariance": [[4]] }] },
            "measurements": [{ "step": 1, "z": [-20] }] })
    };
    let trace = certified(&file("v - g*T")).trace;
    // 3 − 9.75 · 2, 4 + 1, and half of the way to −20
    assert_eq!(trace.get(1, Quantity::PredictedMean, 0), Some(&vec![-16.5]));
    assert_eq!(trace.get(1, Quantity::PredictedCovariance, 0), Some(&vec![5.0]));
    assert_eq!(trace.get(1, Quantity::UpdatedMean, 0), Some(&vec![-18.25]));
    let refused = ProblemFile::read(&file("v - g*T*v*v").to_string())
        .unwrap_err()
        .to_string();
    assert!(refused.starts_with("problem.modes[0].f: is not linear"), "{refused}");
}

// Problems that only formulas can say

/// A turn whose rate is in the state, seen in range and azimuth.
fn unknown_turn() -> Value {
    json!({
        "format": "immaculate-problem/2",
        "id": "turn",
        "state": [["x", "m"], ["vx", "m/s"], ["y", "m"], ["vy", "m/s"], ["w", "rad/s"]],
        "parameters": { "T": 0.5 },
        "modes": [{ "name": "turn",
            "let": [["a", "w*T"], ["t", "a*a"]],
            "f": ["x + T*(c1(t)*vx - a*c2(t)*vy)", "cos(a)*vx - sin(a)*vy", "y + T*(a*c2(t)*vx + c1(t)*vy)",
                  "sin(a)*vx + cos(a)*vy", "w"],
            "Q": [[0.1, 0, 0, 0, 0], [0, 0.2, 0, 0, 0], [0, 0, 0.1, 0, 0], [0, 0, 0, 0.2, 0], [0, 0, 0, 0, 0.001]] }],
        "measurement": { "kind": "formulas", "z": [["range", "m"], ["azimuth", "rad", "angle"]], "h": ["hypot(x, y)", "atan2(y, x)"] },
        "R": [[25, 0], [0, 0.0001]],
        "filter": { "kind": "cubature", "rule": "cubature-3" },
        "transition": [[1]],
        "initial": { "mode_probabilities": [1], "modes": [{ "mean": [100, 10, 50, -5, 0.1],
            "covariance": [[25, 0, 0, 0, 0], [0, 4, 0, 0, 0], [0, 0, 25, 0, 0], [0, 0, 0, 4, 0], [0, 0, 0, 0, 0.01]] }] },
        "measurements": [{ "step": 1, "z": [112, 0.44] }, { "step": 2, "z": [116, 0.41] }, { "step": 3, "z": [119, 0.4] }],
    })
}

/// The points of the third-degree cubature rule: ±√n along the columns of the Cholesky factor.
fn points(mean: &SVector<f64, 5>, covariance: &SMatrix<f64, 5, 5>) -> Vec<SVector<f64, 5>> {
    let root = covariance.cholesky().unwrap().l() * 5.0_f64.sqrt();
    let both = |i: usize| [mean + root.column(i), mean - root.column(i)];
    (0..5).flat_map(both).collect()
}

/// The plain filter: mean and covariance after each measurement.
fn plain_filter(problem: &Value) -> Vec<(SVector<f64, 5>, SMatrix<f64, 5, 5>)> {
    let q = SMatrix::<f64, 5, 5>::from_diagonal(&SVector::from([0.1, 0.2, 0.1, 0.2, 0.001]));
    let r = matrix![25.0, 0.0; 0.0, 0.0001];
    let mut mean = SVector::from([100.0, 10.0, 50.0, -5.0, 0.1]);
    let mut covariance = SMatrix::<f64, 5, 5>::from_diagonal(&SVector::from([25.0, 4.0, 25.0, 4.0, 0.01]));
    let moved = |s: &SVector<f64, 5>| {
        let (vx, vy, w, a) = (s[1], s[3], s[4], s[4] * 0.5);
        let (sin, cos) = (a.sin(), a.cos());
        let (along, across) = (sin / w, (1.0 - cos) / w);
        SVector::from([
            s[0] + along * vx - across * vy,
            cos * vx - sin * vy,
            s[2] + across * vx + along * vy,
            sin * vx + cos * vy,
            w,
        ])
    };
    let mut estimates = Vec::new();
    for entry in problem["measurements"].as_array().unwrap() {
        let z = SVector::<f64, 2>::from([0, 1].map(|row| entry["z"][row].as_f64().unwrap()));
        let after: Vec<_> = points(&mean, &covariance).iter().map(moved).collect();
        mean = after.iter().sum::<SVector<f64, 5>>() / 10.0;
        covariance = after
            .iter()
            .map(|s| (s - mean) * (s - mean).transpose())
            .sum::<SMatrix<_, 5, 5>>()
            / 10.0
            + q;
        let before = points(&mean, &covariance);
        let seen: Vec<_> = before
            .iter()
            .map(|s| SVector::from([s[0].hypot(s[2]), s[2].atan2(s[0])]))
            .collect();
        let expected = seen.iter().sum::<SVector<f64, 2>>() / 10.0;
        let s = seen
            .iter()
            .map(|z| (z - expected) * (z - expected).transpose())
            .sum::<SMatrix<_, 2, 2>>()
            / 10.0
            + r;
        let pairs = before.iter().zip(&seen);
        let cross = pairs
            .map(|(x, z)| (x - mean) * (z - expected).transpose())
            .sum::<SMatrix<_, 5, 2>>()
            / 10.0;
        let gain = cross * s.try_inverse().unwrap();
        mean += gain * (z - expected);
        covariance -= gain * s * gain.transpose();
        estimates.push((mean, covariance));
    }
    estimates
}

#[test]
fn a_turn_rate_in_the_state_certifies_as_a_plain_filter_computes() {
    let certified = certified(&unknown_turn());
    assert!(certified.digits > 16, "{} digits", certified.digits);
    for (k, (mean, covariance)) in plain_filter(&unknown_turn()).iter().enumerate() {
        let of = |quantity| certified.trace.get(k + 1, quantity, 0).unwrap();
        let scale = |quantity| certified.scale.get(k + 1, quantity, 0).unwrap();
        // Some tens of operations on numbers that lose three digits in the differences of range and azimuth.
        for (quantity, own) in [
            (Quantity::UpdatedMean, mean.as_slice()),
            (Quantity::UpdatedCovariance, covariance.transpose().as_slice()),
        ] {
            for (index, (exact, own)) in of(quantity).iter().zip(own).enumerate() {
                assert!(
                    (exact - own).abs() < 1e-10 * scale(quantity)[index],
                    "step {}, {}: {exact} and {own}",
                    k + 1,
                    quantity.name()
                );
            }
        }
    }
}

#[test]
fn range_azimuth_elevation_and_range_rate_certify() {
    let n = 6;
    let diagonal = |of: fn(usize) -> f64| {
        let entry = |row: usize, column: usize| if row == column { of(row) } else { 0.0 };
        (0..n)
            .map(|row| (0..n).map(|column| entry(row, column)).collect::<Vec<_>>())
            .collect::<Vec<_>>()
    };
    let file = json!({
        "format": "immaculate-problem/2",
        "id": "space",
        "state": ["x", "y", "z", "vx", "vy", "vz"],
        "parameters": { "T": 2 },
        "modes": [{ "name": "straight", "motion": { "model": "constant-velocity" },
            "Q": { "model": "constant-velocity-white-noise", "parameters": { "q": 1 } } }],
        "measurement": { "kind": "model", "model": "range-azimuth-elevation-range-rate", "parameters": { "sensor_z": 25 } },
        "R": [[100, 0, 0, 0], [0, 1e-6, 0, 0], [0, 0, 1e-6, 0], [0, 0, 0, 1]],
        "filter": { "kind": "unscented", "alpha": 1, "beta": 0, "kappa": 1 },
        "transition": [[1]],
        "initial": { "mode_probabilities": [1], "modes": [{ "mean": [12000, -9000, 1500, -150, 100, 5],
            "covariance": diagonal(|row| if row < 3 { 2500.0 } else { 100.0 }) }] },
        "measurements": [{ "step": 1, "z": [14780, -0.64, 0.101, -185] }, { "step": 2, "z": [14410, -0.637, 0.104, -184] }],
    });
    let found = certified(&file);
    assert!(found.digits > 16, "{} digits", found.digits);
    // By hand: 12000 − 2 · 150 and −9000 + 2 · 100.
    let predicted = found.trace.get(1, Quantity::PredictedMean, 0).unwrap();
    assert_eq!(predicted[..3], [11700.0, -8800.0, 1510.0]);
}

// Steps that differ

/// Three steps of different lengths, of which the second has another R and the third another chain.
fn varying() -> Value {
    let model = |model: &str, parameters: Value| json!({ "model": model, "parameters": parameters });
    let noise = |q: f64| model("constant-velocity-white-noise", json!({ "q": q }));
    let file = with(&plane(), "/parameters", json!({ "T": 1 }));
    let straight = json!({ "name": "straight", "motion": { "model": "constant-velocity" }, "Q": noise(1.0) });
    let turn = json!({ "name": "turn", "motion": model("coordinated-turn", json!({ "w": -0.25 })), "Q": noise(4.0) });
    let file = with(&with(&file, "/modes/0", straight), "/modes/1", turn);
    with(
        &file,
        "/measurements",
        json!([
            { "step": 1, "z": [40, 3.1] },
            { "step": 2, "z": [38, -3.05], "T": 0.5, "R": [[9, 0], [0, 0.015_625]] },
            { "step": 3, "z": [35, -2.9], "T": 3, "transition": [[0.5, 0.5], [0.25, 0.75]] },
            { "step": 4, "z": null },
        ]),
    )
}

/// The values of a step.
fn step_of(trace: &Trace, step: usize) -> Value {
    without(&trace.steps_as_json()[step - 1], "", "step")
}

#[test]
fn steps_that_differ_are_a_chain_of_problems_of_one_step() {
    let (whole, stopped) = run_in_doubles(&read(&varying())).unwrap();
    assert_eq!(stopped, None);
    let mut one = varying();
    for entry in varying()["measurements"].as_array().unwrap() {
        let step = usize::try_from(entry["step"].as_u64().unwrap()).unwrap();
        let mut of_step = with(&one, "/measurements", json!([{ "step": 1, "z": entry["z"] }]));
        for (key, pointer) in [("T", "/parameters/T"), ("R", "/R"), ("transition", "/transition")] {
            if let Some(value) = entry.get(key) {
                of_step = with(&of_step, pointer, value.clone());
            }
        }
        let (alone, _) = run_in_doubles(&read(&of_step)).unwrap();
        assert_eq!(step_of(&whole, step), step_of(&alone, 1), "step {step}");
        let after = step_of(&alone, 1);
        one = with(&one, "/initial/mode_probabilities", after["mode_probabilities"].clone());
        for j in 0..2 {
            one = with(
                &one,
                &format!("/initial/modes/{j}"),
                after["modes"][j]["updated"].clone(),
            );
        }
    }
    let equal = with(&varying(), "/measurements/1/T", json!(1));
    assert_ne!(whole, run_in_doubles(&read(&equal)).unwrap().0);
}

#[test]
fn a_step_length_is_the_matrices_that_it_makes() {
    let of_length = |t: f64| json!([[1, t, 0, 0], [0, 1, 0, 0], [0, 0, 1, t], [0, 0, 0, 1]]);
    let noise = |q: f64| quarter(4.0 * q);
    let f = json!(["x + T*vx", "vx", "y + T*vy", "vy"]);
    let q = json!([["T*q", 0, 0, 0], [0, "T*q", 0, 0], [0, 0, "T*q", 0], [0, 0, 0, "T*q"]]);
    let z = json!([-38, 2]);
    let sensor = json!({ "kind": "linear", "H": [[1, 0, 0, 0], [0, 0, 1, 0]] });
    let plain = with(
        &with(&plane(), "/measurement", sensor),
        "/filter",
        json!({ "kind": "kalman" }),
    );
    let mut lengths = plain.clone();
    for j in ["0", "1"] {
        let mode = json!({ "name": j, "f": f, "Q": q, "parameters": { "q": 2 } });
        lengths = with(&lengths, &format!("/modes/{j}"), mode);
    }
    let lengths = with(
        &lengths,
        "/measurements",
        json!([{ "step": 1, "z": z, "T": 0.5 }, { "step": 2, "z": z, "T": 4 }]),
    );
    let step = |step: usize, t: f64| {
        let (f, q) = (of_length(t), noise(2.0 * t));
        json!({ "step": step, "z": z, "F": [f, f], "Q": [q, q], "H": [[1, 0, 0, 0], [0, 0, 1, 0]] })
    };
    let matrices = with(&plain, "/measurements", json!([step(1, 0.5), step(2, 4.0)]));
    assert_eq!(certified(&lengths).trace, certified(&matrices).trace);
}

#[test]
fn a_variant_of_the_filter_is_one_in_every_step() {
    let mut setup = read(&varying()).setup_in_doubles().unwrap();
    assert_eq!(setup.changes.keys().collect::<Vec<_>>(), [&2, &3]);
    assert!(variant::apply("process-noise-omitted", &mut setup));
    let problems = setup.changes.values().chain([&setup.problem]);
    assert!(
        problems
            .flat_map(|problem| &problem.modes)
            .all(|mode| mode.noise.iter().all(|entry| entry.value() == 0.0))
    );
}

// Files

#[test]
fn a_problem_is_written_as_it_was_read() {
    for file in [plane(), unknown_turn(), varying()] {
        let problem = read(&file);
        let text = serde_json::to_string(&problem).unwrap();
        assert_eq!(ProblemFile::read(&text).unwrap(), problem, "{text}");
    }
}

#[test]
fn format_1_is_refused_what_needs_format_2() {
    let mut old = with(&plane(), "/format", json!("immaculate-problem/1"));
    for (key, value) in [
        ("about", json!("words")),
        ("flags", json!([])),
        ("units", json!(["m", "m/s", "m", "m/s"])),
        ("state", json!(["x", "vx", "y", "vy"])),
        ("conventions", serde_json::to_value(read(&plane()).conventions).unwrap()),
    ] {
        old = with(&old, &format!("/{key}"), value);
    }
    read(&old);
    let f = json!({ "name": "f", "f": ["x", "vx", "y", "vy"], "Q": quarter(1.0) });
    let model = json!({ "name": "f", "motion": { "model": "constant-velocity" }, "Q": quarter(1.0) });
    let q = json!([["1", 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]);
    for (pointer, value, place) in [
        ("/state/1", json!(["vx", "m/s"]), "problem.state[1]"),
        ("/parameters", json!({ "T": 1 }), "problem.parameters"),
        ("/let", json!([["a", "1"]]), "problem.let"),
        ("/modes/1", f, "problem.modes[1].f"),
        ("/modes/0", model, "problem.modes[0].motion"),
        ("/modes/0/Q", q, "problem.modes[0].Q"),
        ("/modes/0/let", json!([["a", "1"]]), "problem.modes[0].let"),
        ("/modes/0/parameters", json!({ "a": 1 }), "problem.modes[0].parameters"),
        (
            "/measurement",
            json!({ "kind": "model", "model": "range-bearing" }),
            "problem.measurement.kind",
        ),
        ("/measurements/1/T", json!(1), "problem.measurements[1].T"),
        (
            "/measurements/1/R",
            json!([[1, 0], [0, 1]]),
            "problem.measurements[1].R",
        ),
    ] {
        let refused = ProblemFile::read(&with(&old, pointer, value).to_string()).unwrap_err();
        assert_eq!(
            (refused.class, refused.place.as_str()),
            (Class::Format, place),
            "{refused}"
        );
        assert!(
            refused.reason.starts_with("needs the format \"immaculate-problem/2\""),
            "{refused}"
        );
    }
    for key in ["about", "flags", "units", "conventions"] {
        let refused = ProblemFile::read(&without(&old, "", key).to_string())
            .unwrap_err()
            .to_string();
        assert_eq!(refused, format!("problem.{key}: is missing"));
    }
}

// The command line

/// Runs `immaculate trace -` on a text: exit status, standard output, and standard error.
fn trace(text: &str, options: &[&str]) -> (Option<i32>, String, String) {
    let mut command = immaculate(&[&["trace", "-"], options].concat());
    command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    // A program that refuses early may close its input.
    drop(child.stdin.take().unwrap().write_all(text.as_bytes()));
    let output = child.wait_with_output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

#[test]
fn a_problem_with_formulas_is_traced_in_every_form() {
    let file = unknown_turn().to_string();
    for (options, begins, has) in [
        (
            &[][..],
            "turn\nstate x, vx, y, vy, w in m, m/s, m, m/s, rad/s\n",
            "predicted_measurement",
        ),
        (&["--digits", "20"], "turn\n", "1.0000000000000000000e2"),
        (&["--json"], "{", "\"immaculate-trace/1\""),
        (
            &["--csv"],
            "id,step,mode,quantity,row,column,value\nturn,1,",
            "turn,3,,combined.mean,5,,",
        ),
    ] {
        let (status, output, error) = trace(&file, options);
        assert_eq!((status, error.as_str()), (Some(0), ""), "{options:?}");
        assert!(
            output.starts_with(begins) && output.contains(has),
            "{options:?}:\n{output}"
        );
    }
}

/// Formulas and names that are wrong, and the sentence.
fn bad_formulas() -> Vec<(Value, &'static str)> {
    let turn = unknown_turn();
    let f = |text: &str| with(&turn, "/modes/0/f/0", json!(text));
    let definitions = |list: Value| with(&turn, "/modes/0/let", list);
    vec![
        (
            f("x + T*vz"),
            "problem.modes[0].f[0]: column 7, at `x + T*vz`: `vz` is not known here; the nearest name is `vx`",
        ),
        (
            f("sine(x)"),
            "problem.modes[0].f[0]: column 1, at `sine(x)`: there is no function `sine`; the nearest name is `sin`",
        ),
        (
            f("x + (T*vx"),
            "the parenthesis of column 5 is not closed before the end",
        ),
        (
            f("x/(1 - 1)"),
            "problem.modes[0].f[0]: column 3, at `x/(1 - 1)`: what stands here is a constant, exactly zero",
        ),
        (
            f("c12(x)"),
            "there is no function `c12`: the Stumpff functions are c0 to c9",
        ),
        (
            f(&("(".repeat(1000) + "x" + &")".repeat(1000))),
            "are nested more than 100 deep",
        ),
        (
            f(&"x+".repeat(500_000)),
            "problem.modes[0].f[0]: column 1, at `x+x+x+x+x+x+x+x+x+x+…`: a formula has at most 10000 bytes",
        ),
        (f(""), "problem.modes[0].f[0]: column 1, at ``: nothing is written"),
        (
            with(&turn, "/modes/0/f", json!(["x"])),
            "problem.modes[0].f: has 1 formulas where the state has 5 components",
        ),
        (
            definitions(json!([["a", "a*T"]])),
            "problem.modes[0].let[0][1]: column 1, at `a*T`: `a` is used in its own definition",
        ),
        (
            definitions(json!([["a", "w"], ["a", "w"]])),
            "problem.modes[0].let[1]: the name `a` is used twice",
        ),
        (
            definitions(json!([["vx", "w"]])),
            "problem.modes[0].let[0]: the name `vx` is used twice",
        ),
        (
            with(&turn, "/state/1", json!("x")),
            "problem.state: the name `x` is used twice",
        ),
        (
            with(&turn, "/parameters", json!({})),
            "problem.modes[0].let[0][1]: column 3, at `w*T`: no step has a length `T`; give it in `parameters`, or with",
        ),
    ]
}

/// Models and noises that are wrong, and the sentence.
fn bad_models() -> Vec<(Value, &'static str)> {
    let turn = unknown_turn();
    let motion = |model: Value| with(&without(&turn, "/modes/0", "f"), "/modes/0/motion", model);
    let noise = |model: Value| with(&turn, "/modes/0/Q", model);
    vec![
        (
            motion(json!({ "model": "cordinated-turn" })),
            "problem.modes[0].motion.model: is \"cordinated-turn\", and there is no such model; the nearest name is `coordinated-turn`",
        ),
        (
            motion(json!({ "model": "coordinated-turn", "others": "keep", "parameters": { "v": 1 } })),
            "has no parameter `v`",
        ),
        (
            motion(json!({ "model": "constant-acceleration" })),
            "problem.modes[0].motion: `constant-acceleration` needs the components `ax` and `ay`",
        ),
        (
            motion(json!({ "model": "constant-velocity" })),
            "says nothing of the component `w` of the state; say whether it becomes zero or is kept",
        ),
        (
            motion(json!({ "model": "range-bearing" })),
            "is a model of a measurement and not of a motion",
        ),
        (
            noise(json!({ "model": "constant-velocity-white-noise" })),
            "needs the parameter `q`",
        ),
        (
            noise(json!([["x"]])),
            "problem.modes[0].Q: is not 5 × 5, as the state asks for",
        ),
        (
            with(&turn, "/modes/0/Q/1/1", json!("vx*vx")),
            "problem.modes[0].Q[1][1]: has no value; a noise does not depend on the state",
        ),
        (
            with(&turn, "/modes/0/Q/1/0", json!("T")),
            "problem.modes[0].Q: is not symmetric",
        ),
        (
            with(&turn, "/modes/0/Q/1/1", json!("-T")),
            "problem.modes[0].Q: is not positive semidefinite",
        ),
    ]
}

/// Measurements, filters and steps that are wrong, and the sentence.
fn bad_measurements() -> Vec<(Value, &'static str)> {
    let turn = unknown_turn();
    let measurement = |value: Value| with(&turn, "/measurement", value);
    vec![
        (
            measurement(json!({ "kind": "model", "model": "range-azimuth-elevation" })),
            "problem.measurement: `range-azimuth-elevation` needs the component `z`, and the state has",
        ),
        (
            measurement(json!({ "kind": "formula" })),
            "problem.measurement.kind: is \"formula\"; known are linear, range-bearing, formulas, model",
        ),
        (
            measurement(json!({ "kind": "formulas", "z": ["r"], "h": ["x"] })),
            "problem.measurement.z: has 1 entries where 2 are needed",
        ),
        (
            measurement(
                json!({ "kind": "range-bearing", "components": ["range", "bearing"], "position": [0, 7], "sensor": [0, 0] }),
            ),
            "problem.measurement.position: names entry 7 of a state of 5",
        ),
        (
            with(&turn, "/measurement/h", json!(["x"])),
            "problem.measurement.h: has 1 formulas where z has 2 entries",
        ),
        (
            with(&turn, "/measurement/z/1", json!(["azimuth", "deg", "angle"])),
            "angles are in radians, `rad`",
        ),
        (
            with(&turn, "/filter", json!({ "kind": "kalman" })),
            "problem.modes[0].f: is not linear, and the Kalman filter takes matrices",
        ),
        (
            with(&turn, "/measurements/1/T", json!(-1)),
            "problem.measurements[1].T: is -1; no step is shorter than 0",
        ),
        (
            with(&turn, "/measurements/1/Q", json!([])),
            "problem.measurements[1].Q: has 0 entries where 1 are needed",
        ),
        (
            with(&turn, "/measurements/1/R", json!([[1, 0], [0, -1]])),
            "problem.measurements[1]: changes the problem so that `R` is not positive semidefinite",
        ),
        (
            with(&turn, "/measurements/1/z", json!([112, 44])),
            "problem.measurements[1].z[1]: is 44, a bearing outside ±2π: is it in degrees?",
        ),
        (
            with(&turn, "/format", json!("immaculate-problem/3")),
            "problem.format: is \"immaculate-problem/3\"",
        ),
    ]
}

#[test]
fn a_bad_file_is_refused_in_one_sentence_with_the_place() {
    let twice = unknown_turn().to_string().replace("{\"T\":0.5}", "{\"T\":0.5,\"T\":1}");
    let deep = "[".repeat(1_000_000);
    let texts = [(twice, "problem.parameters: has the name `T` twice"), (deep, "problem")];
    let files = bad_formulas().into_iter().chain(bad_models()).chain(bad_measurements());
    let files = files.map(|(file, sentence)| (file.to_string(), sentence));
    for (text, sentence) in files.chain(texts) {
        let (status, output, error) = trace(&text, &[]);
        assert_eq!((status, output.as_str()), (Some(2), ""), "{sentence}: {error}");
        assert!(error.contains(sentence), "{sentence} in {error}");
        assert!(
            error.starts_with("immaculate: -: problem") && error.trim_end().lines().count() == 1,
            "{error}"
        );
    }
}
