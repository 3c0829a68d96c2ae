//! Goal: the extended Kalman filter is the Kalman filter at the slopes of its functions, and these slopes are right.
//!
//! Method: equality to the bit where the functions are matrices; closed forms of slopes, certified; the first-order expansion that the
//! filter claims, at two widths; and problems from files, whose formulas and native sensors must give the same certified digits.

use immaculate::filter::Filter;
use immaculate::filter::extended::{measurement_jacobian, motion_jacobian};
use immaculate::gaussian::Gaussian;
use immaculate::imm::{Imm, Initial, Interaction, Problem, Quantity};
use immaculate::model::PolarComponent::{Bearing, Range};
use immaculate::model::Sensor;
use immaculate::model::function::Function;
use immaculate::model::motion::{Mode, Motion};
use immaculate::number::{Enclosure, Field, Rational, Real};
use immaculate::oracle::certify::{certified_decimals, certify};
use immaculate::oracle::problem::ProblemFile;
use immaculate::rule::RuleName;
use nalgebra::{Matrix2, U2, matrix, vector};
use serde_json::{Value, json};

/// A walk along a curve, and its measurements.
fn curved(filter: Filter<f64, U2, U2>, width: f64) -> (Problem<f64, U2, U2>, Initial<f64, U2>) {
    let curve = [("x", "x + 0.3*sin(y)"), ("y", "y + 0.1*x*y")];
    let function = Function::of_formulas(&["x", "y"], &[], &[], &[], &curve).unwrap();
    let motion = Motion::Function {
        function: function.into(),
        given: Vec::new(),
    };
    let problem = Problem {
        modes: vec![Mode {
            name: "curve".into(),
            motion,
            noise: Matrix2::zeros(),
        }],
        filters: vec![filter],
        interaction: Interaction::Imm,
        angles: vec![],
        chain: vec![vec![1.0]],
        sensor: radar(),
        measurement_noise: matrix![1e-4, 0.0; 0.0, 1e-4],
    };
    let initial = Initial {
        modes: vec![Gaussian {
            mean: vector![2.0, 1.5],
            covariance: matrix![1.0, 0.3; 0.3, 0.8] * (width * width),
        }],
        mode_probabilities: vec![1.0],
    };
    (problem, initial)
}

fn radar<T: Real>() -> Sensor<T, U2, U2> {
    Sensor::Polar {
        components: vec![Range, Bearing],
        position: [0, 1],
        location: [T::integer(-1), T::integer(-2)],
    }
}

#[test]
fn an_extended_filter_of_matrices_is_the_kalman_filter() {
    let run = |filter: Filter<f64, U2, U2>| {
        let problem = Problem {
            modes: vec![
                Mode {
                    name: "one".into(),
                    motion: Motion::Linear(matrix![1.0, 0.7; -0.2, 0.9]),
                    noise: matrix![0.3, 0.1; 0.1, 0.4],
                },
                Mode {
                    name: "two".into(),
                    motion: Motion::Affine {
                        matrix: matrix![0.8, 0.1; 0.3, 1.1],
                        offset: vector![0.5, -0.25],
                    },
                    noise: matrix![0.2, -0.05; -0.05, 0.6],
                },
            ],
            filters: vec![filter],
            interaction: Interaction::Imm,
            angles: vec![],
            chain: vec![vec![0.9, 0.1], vec![0.3, 0.7]],
            sensor: Sensor::Linear(matrix![1.0, 0.2; -0.1, 1.3]),
            measurement_noise: matrix![0.5, 0.1; 0.1, 0.7],
        };
        let estimate = Gaussian {
            mean: vector![1.0, 2.0],
            covariance: matrix![1.0, 0.4; 0.4, 2.0],
        };
        let initial = Initial {
            modes: vec![estimate.clone(), estimate],
            mode_probabilities: vec![0.5, 0.5],
        };
        let mut filter = Imm::new(problem, &initial).unwrap();
        [Some(vector![1.5, 2.5]), None, Some(vector![2.5, 3.0])].map(|z| filter.step(z.as_ref()).unwrap().clone())
    };
    for (kalman, extended) in run(Filter::kalman()).iter().zip(&run(Filter::extended())) {
        for quantity in Quantity::ALL {
            for j in 0..2 {
                let (ours, other) = (extended.values(quantity, j), kalman.values(quantity, j));
                match quantity {
                    Quantity::MotionJacobian => assert!(ours.is_some() && other.is_none()),
                    Quantity::MeasurementJacobian => {
                        assert_eq!((ours.is_some(), other.is_some()), (kalman.measurement.is_some(), false));
                    }
                    _ => assert_eq!(ours, other, "{}", quantity.name()),
                }
            }
        }
    }
}

/// x/r, y/r and −y/r², x/r² of a target at (x, y) about the sensor.
#[test]
fn the_slopes_of_range_and_bearing_are_their_closed_forms() {
    Enclosure::with_precision(200, || {
        let at = vector![2.0, 1.5].map(Enclosure::exact);
        let (x, y) = (Enclosure::exact(3.0), Enclosure::exact(3.5));
        let square = x.clone() * x.clone() + y.clone() * y.clone();
        let range = square.sqrt();
        let expected = matrix![
            x.clone() / range.clone(), y.clone() / range.clone();
            -y.clone() / square.clone(), x.clone() / square.clone()
        ];
        let found = measurement_jacobian(&radar(), &at);
        for (found, expected) in found.iter().zip(&expected) {
            let digits = |number: &Enclosure| number.to_decimal(40).expect("decided");
            assert_eq!(digits(found), digits(expected));
        }
        // The transposed matrix is another.
        assert_ne!(found[(0, 1)].to_decimal(40), expected[(1, 0)].to_decimal(40));
    });
}

#[test]
fn the_slopes_of_range_and_bearing_are_those_of_their_formulas() {
    let texts = [("range", "hypot(x + 1, y + 2)"), ("bearing", "atan2(y + 2, x + 1)")];
    let function = Function::of_formulas(&["x", "y"], &[], &[], &[], &texts).unwrap();
    Enclosure::with_precision(200, || {
        let at = vector![2.0, 1.5].map(Enclosure::exact);
        let native = measurement_jacobian(&radar(), &at);
        let of_formulas = function.jacobian_at(at.as_slice(), &[]);
        for i in 0..2 {
            for k in 0..2 {
                assert_eq!(
                    native[(i, k)].to_decimal(40),
                    of_formulas[i][k].to_decimal(40),
                    "{i} {k}"
                );
            }
        }
    });
}

/// f(x̂ + δ) − f(x̂) − F δ is of second order: a hundredth of δ leaves a ten-thousandth of it, exactly for a polynomial.
#[test]
fn what_the_motion_jacobian_leaves_is_of_second_order() {
    let curve = [("x", "x + y*y/2"), ("y", "y + x*y/4")];
    let function = Function::of_formulas(&["x", "y"], &[], &[], &[], &curve).unwrap();
    let motion = Motion::Function {
        function: function.clone().into(),
        given: Vec::new(),
    };
    let at = [Rational::new(3, 2), Rational::new(-2, 3)];
    // A rational of formulas has no elementary functions to ask for; the slopes are those of doubles, exact here.
    let slopes = motion_jacobian(&motion, &vector![1.5, -0.75]);
    assert_eq!(slopes, matrix![1.0, -0.75; -0.1875, 1.375]);
    let formulas = function.formulas().unwrap();
    let value = |at: &[Rational]| formulas.rational_at(at).unwrap();
    let left = |scale: i64| {
        let step = [Rational::new(1, scale), Rational::new(-2, scale)];
        let moved = [at[0].clone() + step[0].clone(), at[1].clone() + step[1].clone()];
        let jacobian = [
            [Rational::integer(1), at[1].clone()],
            [
                at[1].clone() / Rational::integer(4),
                Rational::integer(1) + at[0].clone() / Rational::integer(4),
            ],
        ];
        let (from, to) = (value(&at), value(&moved));
        [0, 1].map(|i| {
            let linear = jacobian[i][0].clone() * step[0].clone() + jacobian[i][1].clone() * step[1].clone();
            to[i].clone() - from[i].clone() - linear
        })
    };
    let (coarse, fine) = (left(1), left(100));
    for i in 0..2 {
        assert_eq!(fine[i].clone() * Rational::integer(10_000), coarse[i]);
        assert_ne!(coarse[i], Rational::integer(0));
    }
}

/// Points and slopes agree to second order in the width of the estimate: at a tenth of the width the covariances, measured in the
/// square of the width, are a hundred times nearer.
#[test]
fn a_narrow_estimate_goes_through_points_as_through_slopes() {
    let apart = |width: f64| {
        let predicted = |filter| {
            let (problem, initial) = curved(filter, width);
            Imm::new(problem, &initial).unwrap().step(None).unwrap().predicted[0].covariance
        };
        let rule = RuleName::FifthDegree.rule().unwrap();
        (predicted(Filter::extended()) - predicted(Filter::points(rule))).norm() / (width * width)
    };
    let ratio = apart(0.1) / apart(0.01);
    assert!((90.0..110.0).contains(&ratio), "{ratio}");
}

/// Written out for one step, from the functions' own equations.
#[test]
fn a_step_of_an_extended_filter_is_its_equations() {
    let (problem, initial) = curved(Filter::extended(), 0.2);
    let (motion, sensor) = (problem.modes[0].motion.clone(), problem.sensor.clone());
    let Gaussian { mean, covariance } = initial.modes[0].clone();
    let z = vector![4.7, 0.9];
    let step = Imm::new(problem.clone(), &initial)
        .unwrap()
        .step(Some(&z))
        .unwrap()
        .clone();

    let f = motion_jacobian(&motion, &mean);
    let predicted = motion.of(&mean);
    let p = f * covariance * f.transpose();
    let h = measurement_jacobian(&sensor, &predicted);
    let s = h * p * h.transpose() + problem.measurement_noise;
    let gain = p * h.transpose() * s.try_inverse().unwrap();
    let updated = predicted + gain * (z - sensor.of(&predicted));
    // Another order of the same operations: a few roundings of numbers of size one.
    let is_near = |found: f64, expected: f64| (found - expected).abs() < 1e-13;
    assert!(
        step.predicted[0]
            .covariance
            .iter()
            .zip(p.iter())
            .all(|(a, b)| is_near(*a, *b))
    );
    assert!(
        step.innovation_covariances[0]
            .iter()
            .zip(s.iter())
            .all(|(a, b)| is_near(*a, *b))
    );
    assert!(step.gains[0].iter().zip(gain.iter()).all(|(a, b)| is_near(*a, *b)));
    assert!(
        step.updated[0]
            .mean
            .iter()
            .zip(updated.iter())
            .all(|(a, b)| is_near(*a, *b))
    );
    assert_eq!(step.motion_jacobians[0], Some(f));
    assert_eq!(step.measurement_jacobians[0], Some(h));
    // No points are drawn.
    assert!(step.mixed_points[0].is_empty() && step.predicted_points[0].is_empty());
}

// From files

/// A turn with its rate in the state beside constant velocity, seen by a radar.
fn turning(measurement: &Value) -> ProblemFile {
    let file = json!({
        "format": "immaculate-problem/2",
        "id": "turning",
        "state": [["x", "m"], ["vx", "m/s"], ["y", "m"], ["vy", "m/s"], ["w", "rad/s"]],
        "parameters": { "T": 0.5 },
        "modes": [
            {
                "name": "straight",
                "motion": { "model": "constant-velocity", "others": "keep" },
                "Q": { "model": "constant-velocity-white-noise", "parameters": { "q": 0.5 } }
            },
            {
                "name": "turn",
                "let": [["a", "w*T"], ["t", "a*a"]],
                "f": ["x + T*(c1(t)*vx - a*c2(t)*vy)", "cos(a)*vx - sin(a)*vy", "y + T*(a*c2(t)*vx + c1(t)*vy)", "sin(a)*vx + cos(a)*vy", "w"],
                "Q": [["q", 0, 0, 0, 0], [0, "q", 0, 0, 0], [0, 0, "q", 0, 0], [0, 0, 0, "q", 0], [0, 0, 0, 0, "0.01*T"]],
                "parameters": { "q": 0.3 }
            }
        ],
        "measurement": measurement,
        "R": [[4, 0], [0, 0.0025]],
        "filter": { "kind": "extended" },
        "transition": [[0.9, 0.1], [0.2, 0.8]],
        "initial": {
            "mode_probabilities": [0.5, 0.5],
            "modes": [
                { "mean": [40, 3, 30, -2, 0], "covariance": diagonal([4.0, 1.0, 5.0, 1.0, 0.01]) },
                { "mean": [41, 2.5, 29, -2.5, 0.1], "covariance": diagonal([3.0, 1.5, 4.0, 2.0, 0.02]) }
            ]
        },
        "measurements": [{ "step": 1, "z": [51, 0.6] }, { "step": 2, "z": null }, { "step": 3, "z": [53, 0.5] }]
    });
    ProblemFile::read(&file.to_string()).unwrap()
}

fn diagonal(variances: [f64; 5]) -> Vec<Vec<f64>> {
    let entry = |row: usize, column: usize| if row == column { variances[row] } else { 0.0 };
    (0..5)
        .map(|row| (0..5).map(|column| entry(row, column)).collect())
        .collect()
}

#[test]
fn an_extended_filter_of_formulas_and_of_native_sensors_has_the_same_digits() {
    let native =
        json!({ "kind": "range-bearing", "components": ["range", "bearing"], "position": [0, 2], "sensor": [0, 0] });
    let formulas = json!({ "kind": "formulas", "z": [["range", "m"], ["bearing", "rad", "angle"]], "h": ["hypot(x, y)", "atan2(y, x)"] });
    let model = json!({ "kind": "model", "model": "range-bearing" });
    let [native, formulas, model] =
        [native, formulas, model].map(|measurement| certified_decimals(&turning(&measurement), 30).unwrap().0);
    assert_eq!(native, formulas);
    assert_eq!(native, model);
    assert!(native.get(1, Quantity::MeasurementJacobian, 1).is_some());
    assert!(
        native.get(2, Quantity::MeasurementJacobian, 1).is_none(),
        "a missed detection has none"
    );
    assert!(native.get(2, Quantity::MotionJacobian, 1).is_some());
}

/// One mode draws points, the other linearises; each has the values of its kind only.
#[test]
fn modes_may_have_filters_of_their_own() {
    let measurement = json!({ "kind": "model", "model": "range-bearing" });
    let mut file = serde_json::to_value(turning(&measurement)).unwrap();
    file["modes"][1]["filter"] = json!({ "kind": "cubature", "rule": "cubature-3" });
    let mixed = ProblemFile::read(&file.to_string()).unwrap();
    assert_eq!(mixed.kinds(), ["extended", "cubature-3"]);
    let trace = certify(&mixed).unwrap().trace;
    assert!(trace.get(1, Quantity::MotionJacobian, 0).is_some());
    assert!(trace.get(1, Quantity::MotionJacobian, 1).is_none());
    // Before anything was measured the first mode is what it is among its like.
    let alike = certify(&turning(&measurement)).unwrap().trace;
    let of =
        |trace: &immaculate::oracle::trace::Trace, mode| trace.get(1, Quantity::PredictedCovariance, mode).cloned();
    assert_eq!(of(&trace, 0), of(&alike, 0));
    assert_ne!(of(&trace, 1), of(&alike, 1));
}
