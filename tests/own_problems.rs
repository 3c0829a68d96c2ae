//! Goal: a filter is judged on the problems of its author: any model, several sensors, steps that differ, any length.
//!
//! Method: this crate's own filter answers, right or with a mistake planted in it, and the verdict must name the equation; problems that
//! cannot be read or run are refused with the place; and a long run is certified and judged to its end.

mod common;

use common::program::immaculate;
use immaculate::imm::Quantity;
use immaculate::oracle::case;
use immaculate::oracle::certify::{certified_as_far_as_it_goes, certify};
use immaculate::oracle::check::{Outcome, Report, check_problems};
use immaculate::oracle::diagnose::Diagnosis;
use immaculate::oracle::judge::{self, Finding, Reference};
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::run::run_in_doubles;
use immaculate::oracle::subject::{Level, Planted, Precision};
use serde_json::{Value, json};
use std::path::PathBuf;

/// A car under a radar and a lidar.
fn car() -> ProblemFile {
    ProblemFile::read(include_str!("adapters/automotive.json")).unwrap()
}

fn verdict(problem: ProblemFile, variants: &[&str]) -> Report {
    let mut program = Planted {
        variants: variants.iter().map(|&id| id.to_owned()).collect(),
        level: Level::Everything,
    };
    check_problems(&mut program, &[problem], &|_| {}).unwrap()
}

#[test]
fn a_right_filter_is_right_on_a_problem_of_its_own() {
    let report = verdict(car(), &[]);
    assert!(!report.is_wrong());
    assert_eq!(report.cases[0].outcome, Outcome::Right);
    assert_eq!(report.cases[0].judged, report.cases[0].of);
    assert_eq!(report.cases[0].certified, Some(40), "all of it");
}

/// A mistake, and the equation in which it is found.
#[test]
fn a_mistake_is_named_on_a_problem_of_its_own() {
    for (id, quantity) in [
        ("motion-jacobian-transposed", Quantity::MotionJacobian),
        ("motion-jacobian-at-the-prediction", Quantity::MotionJacobian),
        ("motion-jacobian-last-column-omitted", Quantity::MotionJacobian),
        ("measurement-jacobian-at-the-mixed-mean", Quantity::MeasurementJacobian),
        ("bearing-jacobian-negated", Quantity::MeasurementJacobian),
        ("motion-by-jacobian", Quantity::PredictedMean),
        ("measurement-by-jacobian", Quantity::PredictedMeasurement),
        ("motion-of-the-first-step", Quantity::PredictedMean),
        ("process-noise-of-the-first-step", Quantity::PredictedCovariance),
        ("innovation-not-wrapped", Quantity::Innovation),
        ("mixed-spread-omitted", Quantity::MixedCovariance),
        ("transition-transposed", Quantity::PredictedModeProbabilities),
        ("determinant-omitted", Quantity::LogLikelihood),
        ("covariance-not-updated", Quantity::UpdatedCovariance),
        ("combined-spread-omitted", Quantity::CombinedCovariance),
    ] {
        let mut problem = car();
        problem.measurements.truncate(13); // both sensors, both directions across the cut, a missed detection
        let report = verdict(problem, &[id]);
        assert!(report.is_wrong(), "{id}");
        let first = report.faults().map(|(_, judged)| judged.place.1).min();
        assert_eq!(first, Some(quantity), "{id}");
        let Diagnosis::One(variants) = &report.diagnosis else {
            panic!("{id}: {:?}", report.diagnosis)
        };
        assert!(
            variants.iter().any(|variant| variant.id == id),
            "{id} is among {variants:?}"
        );
    }
}

/// Every value of a step with a detection, off by a part in a million, is a fault of its own equation; a value in a Jacobian, too.
#[test]
fn every_value_that_is_a_little_off_is_a_fault() {
    let problem = {
        let mut problem = car();
        problem.measurements.truncate(5);
        problem
    };
    let (expected, _) = certified_as_far_as_it_goes(&problem).unwrap();
    let reference = Reference::new(&problem, Some(&expected), &[], Precision::Double).unwrap();
    let mut asked = 0;
    for (step, quantity, mode) in expected.all_places().filter(|place| place.0 == 4) {
        let Some(numbers) = expected.get(step, quantity, mode) else {
            continue;
        };
        for index in 0..numbers.len() {
            let unit = reference.scale.get(step, quantity, mode).unwrap()[index];
            let mut off = numbers.clone();
            off[index] += 1e-6 * unit;
            let mut shown = expected.clone();
            shown.set(step, quantity, mode, off);
            let case = judge::Case {
                problem: &problem,
                shown: &shown,
                reference: &reference,
                precision: Precision::Double,
            };
            let values = case.judge(&[]).unwrap().values;
            let first = values.iter().find(|value| value.finding == Finding::Fault);
            let place = first.map(|value| (value.place, value.own.unwrap().index));
            // Nothing that was computed before it depends on it; a covariance may be read by its other triangle.
            let (found, entry) = place.unwrap_or_else(|| panic!("{quantity:?}[{index}] is no fault"));
            assert_eq!((found, entry), ((step, quantity, mode), index));
            asked += 1;
        }
    }
    assert!(asked > 400, "{asked}");
}

/// An extended filter of one mode over a number of steps, written without mentioning modes.
fn long(steps: usize) -> Value {
    let measurements: Vec<Value> = (1..=steps)
        .map(|step| {
            let t = 0.2 * step as f64;
            let (x, y) = (40.0 * (0.1 * t).sin() + 3.0, 25.0 - 40.0 * (0.1 * t).cos());
            let rounded = |value: f64| (value * 1e4).round() / 1e4;
            let ripple = 0.02 * ((step * 7919) % 101) as f64 - 1.0;
            json!({ "step": step, "z": [rounded(x.hypot(y) + ripple), rounded(y.atan2(x) + 0.01 * ripple)] })
        })
        .collect();
    json!({
        "format": "immaculate-problem/2",
        "id": "long",
        "state": [["x", "m"], ["vx", "m/s"], ["y", "m"], ["vy", "m/s"], ["w", "rad/s"]],
        "parameters": { "T": 0.2 },
        "motion": { "model": "coordinated-turn-unknown-rate" },
        "Q": { "model": "coordinated-turn-unknown-rate-piecewise-noise", "parameters": { "q": 0.5, "q_turn": 0.01 } },
        "measurement": { "kind": "model", "model": "range-bearing" },
        "R": [[0.5, 0], [0, 1e-4]],
        "filter": { "kind": "extended" },
        "initial": { "mean": [3, 4, -15, 0, 0.1], "covariance": [
            [4, 0, 0, 0, 0], [0, 4, 0, 0, 0], [0, 0, 4, 0, 0], [0, 0, 0, 4, 0], [0, 0, 0, 0, 0.04]
        ] },
        "measurements": measurements
    })
}

#[test]
fn a_long_run_is_certified_and_judged_to_its_end() {
    let problem = ProblemFile::read(&long(500).to_string()).unwrap();
    let (trace, certified) = certified_as_far_as_it_goes(&problem).unwrap();
    assert_eq!(certified, 500);
    // The beginning is what enclosures alone give.
    let mut beginning = problem.clone();
    beginning.measurements.truncate(8);
    let proven = certify(&beginning).unwrap().trace;
    for quantity in Quantity::ALL {
        assert_eq!(trace.get(8, quantity, 0), proven.get(8, quantity, 0));
    }
    let report = verdict(problem.clone(), &[]);
    assert_eq!((report.is_wrong(), report.cases[0].certified), (false, Some(500)));
    assert_eq!(report.cases[0].judged, report.cases[0].of);
    let report = verdict(problem, &["motion-jacobian-at-the-prediction"]);
    let place = report.faults().map(|(_, judged)| judged.place.1).min();
    assert_eq!(place, Some(Quantity::MotionJacobian));
    assert!(
        matches!(&report.diagnosis, Diagnosis::One(variants) if variants[0].id == "motion-jacobian-at-the-prediction")
    );
}

/// A run by another convention is not carried from step to step: enclosures alone go as far as they go, and doubles to the end.
#[test]
fn a_long_run_that_is_not_carried_is_certified_as_far_as_it_goes() {
    let mut problem = ProblemFile::read(&long(400).to_string()).unwrap();
    problem.declared = vec!["first-step-unmixed"];
    let (trace, certified) = certified_as_far_as_it_goes(&problem).unwrap();
    assert!((8..400).contains(&certified), "{certified}");
    let mut beginning = problem.clone();
    beginning.measurements.truncate(8);
    let proven = certify(&beginning).unwrap().trace;
    let (doubles, _) = run_in_doubles(&problem).unwrap();
    for quantity in Quantity::ALL {
        assert_eq!(trace.get(8, quantity, 0), proven.get(8, quantity, 0));
        assert_eq!(trace.get(400, quantity, 0), doubles.get(400, quantity, 0));
    }
}

/// The short and the long form of a problem are the same problem; a program is sent the long one.
#[test]
fn a_problem_of_one_filter_is_written_without_modes() {
    let short = long(3);
    let mut full = short.clone();
    let object = full.as_object_mut().unwrap();
    let (motion, noise) = (object.remove("motion").unwrap(), object.remove("Q").unwrap());
    object.insert(
        "modes".into(),
        json!([{ "name": "filter", "motion": motion, "Q": noise }]),
    );
    object.insert("transition".into(), json!([[1]]));
    let estimate = object.remove("initial").unwrap();
    object.insert(
        "initial".into(),
        json!({ "mode_probabilities": [1], "modes": [estimate] }),
    );
    let [short, full] = [short, full].map(|file| ProblemFile::read(&file.to_string()).unwrap());
    assert_eq!(short, full);
    assert!(json!(short)["modes"].is_array());
}

/// What is wrong with a short problem is said of its own keys.
#[test]
fn a_defect_of_a_short_problem_has_the_place_that_was_written() {
    for (change, sentence) in [
        (
            json!({ "motion": { "model": "coordinated-turn-unknown-rat" } }),
            "problem.motion.model: is \"coordinated-turn-unknown-rat\"",
        ),
        (json!({ "Q": [[1]] }), "problem.Q: has 1 entries where 5 are needed"),
        (
            json!({ "initial": { "mean": [1, 0, 0, 0, 0] } }),
            "problem.initial.covariance: is missing",
        ),
        (
            json!({ "initial": { "mean": [1], "covariance": [[1]] } }),
            "problem.initial.mean: has 1 entries where 5 are needed",
        ),
        (
            json!({ "filter": { "kind": "extendet" } }),
            "problem.filter.kind: is \"extendet\"; known are kalman, extended",
        ),
        (json!({ "colour": 1 }), "problem.colour"),
    ] {
        let mut file = long(2);
        for (key, value) in change.as_object().unwrap() {
            file[key] = value.clone();
        }
        let error = ProblemFile::read(&file.to_string()).unwrap_err().to_string();
        assert!(error.contains(sentence), "{error}");
    }
}

/// Four steps of a target in the plane: what is measured, R, the filter, and the measurements.
fn target(measurement: &Value, noise: &Value, filter: &Value, seen: &[Value]) -> Value {
    let entry = |(index, z): (usize, &Value)| json!({ "step": index + 1, "z": z });
    json!({
        "format": "immaculate-problem/2",
        "id": "target",
        "state": ["x", "y"],
        "F": [[1.1, 0.2], [-0.1, 0.9]],
        "Q": [[1, 0.3], [0.3, 2]],
        "measurement": measurement,
        "R": noise,
        "filter": filter,
        "initial": { "mean": [3, 4], "covariance": [[2, 0.5], [0.5, 1]] },
        "measurements": seen.iter().enumerate().map(entry).collect::<Vec<_>>()
    })
}

/// z without its first entry is z of a sensor that does not have it, bit for bit, whatever the sensor and the filter.
#[test]
fn entries_that_are_missing_are_those_of_a_sensor_that_does_not_see_them() {
    let (kalman, extended) = (json!({ "kind": "kalman" }), json!({ "kind": "extended" }));
    let cubature = json!({ "kind": "cubature", "rule": "cubature-5" });
    let unscented = json!({ "kind": "unscented", "alpha": 1, "beta": 2, "kappa": 1 });
    let polar = |components: Value| json!({ "kind": "range-bearing", "components": components, "position": [0, 1], "sensor": [-1, 0] });
    let formulas = |z: Value, h: Value| json!({ "kind": "formulas", "z": z, "h": h });
    let bearing = json!(["bearing", "rad", "angle"]);
    let sensors = [
        (
            json!({ "kind": "linear", "H": [[1, 0.5], [0.2, 1]] }),
            json!({ "kind": "linear", "H": [[0.2, 1]] }),
            vec![&kalman, &extended, &cubature, &unscented],
        ),
        (
            polar(json!(["range", "bearing"])),
            polar(json!(["bearing"])),
            vec![&extended, &cubature, &unscented],
        ),
        (
            formulas(json!(["square", bearing]), json!(["x*y", "atan2(y, x)"])),
            formulas(json!([bearing]), json!(["atan2(y, x)"])),
            vec![&extended, &cubature, &unscented],
        ),
    ];
    let values = |problem: &Value| {
        let problem = ProblemFile::read(&problem.to_string()).unwrap();
        let (trace, failure) = run_in_doubles(&problem).unwrap();
        assert_eq!(failure, None);
        trace
    };
    for (whole, part, filters) in sensors {
        for filter in filters {
            let noise = json!([[0.5, 0.1], [0.1, 0.25]]);
            let missing = target(&whole, &noise, filter, &[json!([null, 0.9]), json!([null, 0.8])]);
            let unseen = target(&part, &json!([[0.25]]), filter, &[json!([0.9]), json!([0.8])]);
            assert_eq!(values(&missing), values(&unseen), "{whole} {filter}");
        }
    }
}

#[test]
fn what_cannot_be_missing_is_said() {
    let linear = json!({ "kind": "linear", "H": [[1, 0], [0, 1]] });
    let polar =
        json!({ "kind": "range-bearing", "components": ["range", "bearing"], "position": [0, 1], "sensor": [0, 0] });
    let noise = json!([[0.5, 0], [0, 0.25]]);
    let kalman = json!({ "kind": "kalman" });
    let converted = json!({ "kind": "converted", "conversion": "standard" });
    let partial = [json!([1.5, null])];
    for (mut problem, sentence) in [
        (
            target(&linear, &noise, &kalman, &[json!([null, null])]),
            "problem.measurements[0].z: has no entry that is there; a step without a detection says null for all of it",
        ),
        (
            target(&polar, &noise, &converted, &partial),
            "problem.measurements[0].z: lacks an entry, and converted needs all of them",
        ),
        (
            target(&linear, &noise, &kalman, &[json!([1.5])]),
            "problem.measurements[0].z: has 1 entries where 2 are needed",
        ),
    ] {
        let said = ProblemFile::read(&problem.to_string()).unwrap_err().to_string();
        assert_eq!(said, sentence);
        // Format 1 has no measurements with gaps.
        problem["format"] = json!("immaculate-problem/1");
        assert!(ProblemFile::read(&problem.to_string()).is_err());
    }
    let mut first = json!(case::all().unwrap()[0].problem);
    first["measurements"][0]["z"] = json!([null, 1]);
    let said = ProblemFile::read(&first.to_string()).unwrap_err().to_string();
    assert!(
        said.starts_with("problem.measurements[0].z: needs the format"),
        "{said}"
    );
}

/// What is known exactly needs no definite covariance, as long as the innovation has one.
#[test]
fn exact_estimates_and_measurements_are_filtered() {
    let linear = json!({ "kind": "linear", "H": [[1, 0], [0, 1]] });
    let kalman = json!({ "kind": "kalman" });
    let mut problem = target(&linear, &json!([[0, 0], [0, 0.25]]), &kalman, &[json!([2, 3])]);
    let run = |problem: &Value| {
        let problem = ProblemFile::read(&problem.to_string()).unwrap();
        run_in_doubles(&problem).unwrap()
    };
    let (trace, failure) = run(&problem);
    assert_eq!(failure, None);
    // What is measured exactly is known, but for the roundings of a gain.
    let known = trace.get(1, Quantity::UpdatedMean, 0).unwrap()[0];
    approx::assert_abs_diff_eq!(known, 2.0, epsilon = 8.0 * f64::EPSILON);
    // Nothing is known and nothing moves: z has no variance at all.
    problem["Q"] = json!([[0, 0], [0, 0]]);
    problem["initial"]["covariance"] = json!([[0, 0], [0, 0]]);
    let (_, failure) = run(&problem);
    assert_eq!(
        failure.unwrap(),
        "step 1, mode `filter`, gain: the innovation covariance is not positive definite: pivot 1 of 2 is not positive"
    );
}

#[test]
fn what_is_wrong_with_sensors_is_said_with_the_place() {
    for (pointer, value, sentence) in [
        (
            "/measurements/2/sensor",
            json!("lidr"),
            "problem.measurements[2].sensor: is \"lidr\", and there is no such sensor; the nearest name is `lidar`",
        ),
        (
            "/sensors/0/R",
            json!([[0.02]]),
            "problem.sensors[0].measurement.H: has 2 entries where 1 are needed",
        ),
        (
            "/sensors/0/measurement/kind",
            json!("linea"),
            "problem.sensors[0].measurement.kind: is \"linea\"; known are linear",
        ),
        (
            "/measurements/2/z",
            json!([1, 2, 3]),
            "problem.measurements[2].z: has 3 entries where 2 are needed",
        ),
        (
            "/measurements/2/T",
            json!(-0.1),
            "problem.measurements[2].T: is -0.1; no step is shorter than 0",
        ),
        (
            "/measurements/0/z",
            json!([-20, 1, 3]),
            "problem.measurements[0].z[0]: is -20, a negative range; a range is a distance",
        ),
        (
            "/measurements/0/z",
            json!([20, 179, 3]),
            "problem.measurements[0].z[1]: is 179, a bearing outside ±2π: is it in degrees?",
        ),
        (
            "/modes/0/filter",
            json!({ "kind": "fixed-gain", "mixing": "mixed", "modes": [] }),
            "problem.modes[0].filter.kind: is fixed-gain, which is said of all modes at once",
        ),
        (
            "/modes/0/filter",
            json!({ "kind": "kalman" }),
            "problem.measurement: is not linear, and the Kalman filter takes matrices",
        ),
    ] {
        let mut file = json!(car());
        match file.pointer_mut(pointer) {
            Some(place) => *place = value,
            None => file["modes"][0]["filter"] = value,
        }
        let error = ProblemFile::read(&file.to_string()).unwrap_err().to_string();
        assert!(error.contains(sentence), "{pointer}: {error}");
    }
}

/// The command line: files, folders, and what is refused.
#[test]
fn the_command_judges_files_and_folders() {
    let folder = folder("own");
    let write = |name: &str, file: &Value| std::fs::write(folder.join(name), file.to_string()).unwrap();
    let mut other = long(5);
    other["id"] = json!("other");
    write("a.json", &long(4));
    write("b.json", &other);
    let program = env!("CARGO_BIN_EXE_immaculate");
    let check = |problem: &str, more: &[&str]| {
        let path = folder.join(problem);
        let mut arguments = vec!["check", "--problem", path.to_str().unwrap(), "--", program, "answer"];
        arguments.extend(more);
        immaculate(&arguments).output().unwrap()
    };
    let whole = check("", &[]);
    assert_eq!(whole.status.code(), Some(0), "{whole:?}");
    let text = String::from_utf8(whole.stdout).unwrap();
    assert!(text.contains(" long ") && text.contains(" other "), "{text}");
    assert!(
        text.contains("2 problems: every expected value is certified."),
        "{text}"
    );
    assert!(text.contains("RIGHT: "), "{text}");
    let planted = check("a.json", &["--plant", "covariance-not-updated"]);
    assert_eq!(planted.status.code(), Some(1));
    let text = String::from_utf8(planted.stdout).unwrap();
    assert!(
        text.contains("FAULT  updated.covariance") && text.contains("(covariance-not-updated; mistake)"),
        "{text}"
    );

    let complaint = |problem: &str| {
        let refused = check(problem, &[]);
        assert_eq!(
            (refused.status.code(), refused.stdout.len()),
            (Some(2), 0),
            "{refused:?}"
        );
        String::from_utf8(refused.stderr).unwrap()
    };
    assert!(complaint("c.json").contains("c.json: No such file"));
    write("b.json", &long(5));
    assert!(complaint("").contains("two problems have the id `long`"));
    std::fs::write(folder.join("b.json"), "{").unwrap();
    assert!(complaint("").contains("b.json: problem: EOF"));
    std::fs::create_dir(folder.join("empty")).unwrap();
    assert!(complaint("empty").contains("empty: has no problem file, `*.json`"));
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Literals are read back as the certified doubles.
#[test]
fn literals_hold_the_certified_doubles() {
    let file = folder("literals").join("problem.json");
    let problem = ProblemFile::read(&long(2).to_string()).unwrap();
    std::fs::write(&file, long(2).to_string()).unwrap();
    let trace = certify(&problem).unwrap().trace;
    let gain = trace.get(2, Quantity::Gain, 0).unwrap();
    for (language, line, separators) in [
        ("c", "static const double step_2_mode_0_gain[5][2] = ", "{},; "),
        ("rust", "const STEP_2_MODE_0_GAIN: [[f64; 2]; 5] = ", "[],; "),
        ("python", "expected[2, 0, \"gain\"] = ", "[], "),
        ("matlab", "expected(2).modes(1).gain = ", "[]; "),
    ] {
        let output = immaculate(&["trace", file.to_str().unwrap(), "--as", language])
            .output()
            .unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(
            text.lines()
                .next()
                .unwrap()
                .ends_with("long: the doubles nearest to the exact values"),
            "{text}"
        );
        let numbers = text
            .lines()
            .find_map(|own| own.strip_prefix(line))
            .unwrap_or_else(|| panic!("{language}: {text}"));
        let is_separator = |character: char| separators.contains(character);
        let numbers: Vec<f64> = numbers
            .split(is_separator)
            .filter_map(|word| word.parse().ok())
            .collect();
        assert_eq!(&numbers, gain, "{language}");
    }
    std::fs::remove_dir_all(file.parent().unwrap()).unwrap();
}

/// An empty folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("immaculate-own-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}
