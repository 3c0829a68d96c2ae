//! Goal: the file formats are what `spec/formats.md` and the schemas say, a defect of a file is named with its place, and the published
//! cases are what they promise to be.
//!
//! Method: right files in which one thing is made wrong at every place where it can be; every published file read, written and proven
//! again; and the plain user's unit test on Immaculate's own doubles. Kind of evidence: oracle, with examples good and bad, and no
//! tolerance but the cases' own.

use immaculate::file::digest;
use immaculate::imm::Quantity;
use immaculate::oracle::case::{self, BadCase, Case, Expected, LOCK, Lock};
use immaculate::oracle::certify::{Certified, certified_decimals, certify, long_csv};
use immaculate::oracle::csv;
use immaculate::oracle::invalid::{Class, Invalid};
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::schema;
use immaculate::oracle::subject::{Answer, Level, Planted, Subject};
use immaculate::oracle::trace::{Dimensions, Trace, read_json};
use immaculate::steady::certificate_file::CertificateFile;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// A plain Kalman problem of two modes, and one of three modes with range and bearing; and one of every other kind of filter.
const LINEAR: &str = "step.n4-m2.two-modes";
const POLAR: &str = "step.cubature-5";
const UNSCENTED: &str = "step.unscented";
const FIXED: &str = "step.fixed-gain";
const CONVERTED: &str = "converted.generic";
const RIGHT: [&str; 5] = [LINEAR, POLAR, UNSCENTED, FIXED, CONVERTED];
/// The only key of theirs that may be missing.
const OPTIONAL: &str = "/conventions/converted_covariance";

// Problems that cannot be read

#[test]
fn the_problems_that_are_spoilt_below_are_right() {
    for id in RIGHT {
        assert_eq!(ProblemFile::read(&text_of(id)).map(|problem| problem.id), Ok(id.into()));
    }
}

/// A first file lacks more than one.
#[test]
fn keys_that_are_missing_together_are_named_together() {
    let lacking = |keys: &[&str]| {
        let mut file = value_of(LINEAR);
        for key in keys {
            file.as_object_mut().unwrap().shift_remove(*key).unwrap();
        }
        refusal(&file).to_string()
    };
    assert_eq!(
        lacking(&["R", "transition", "measurements"]),
        "problem: lacks the keys `R`, `transition`, `measurements`"
    );
    assert_eq!(lacking(&["R", "units"]), "problem: lacks the keys `R`, `units`");
    assert_eq!(lacking(&["flags", "units"]), "problem: lacks the keys `flags`, `units`");
    let mut file = value_of(LINEAR);
    file["format"] = json!("immaculate-problem/2");
    for key in ["R", "units", "filter"] {
        file.as_object_mut().unwrap().shift_remove(key).unwrap();
    }
    assert_eq!(refusal(&file).to_string(), "problem: lacks the keys `R`, `filter`");
}

#[test]
fn what_is_no_number_in_json_is_told_what_to_write() {
    for word in ["NaN", "Infinity", "-Infinity"] {
        let text = text_of(LINEAR).replacen("29.7", word, 1);
        let invalid = ProblemFile::read(&text).unwrap_err();
        assert!(invalid.reason.contains("a missing measurement is null"), "{invalid}");
    }
    let text = text_of(LINEAR).replacen("29.7", "nil", 1);
    assert!(!ProblemFile::read(&text).unwrap_err().reason.contains("null"));
}

/// Exact, over every key of every object of five files.
#[test]
fn every_key_that_is_missing_is_named_with_its_place() {
    for id in RIGHT {
        let whole = value_of(id);
        for pointer in pointers(&whole).into_iter().filter(|pointer| pointer != OPTIONAL) {
            let (parent, key) = pointer.rsplit_once('/').unwrap();
            let mut spoilt = whole.clone();
            let Some(object) = spoilt.pointer_mut(parent).and_then(Value::as_object_mut) else {
                continue;
            };
            object.shift_remove(key).unwrap();
            let invalid = refusal(&spoilt);
            assert_eq!(
                invalid,
                Invalid::new(Class::Format, place_of(&pointer), "is missing"),
                "{id}{pointer}"
            );
        }
    }
}

/// Exact, over every object of five files.
#[test]
fn every_key_that_does_not_exist_is_named_with_its_place() {
    for id in RIGHT {
        let whole = value_of(id);
        for pointer in std::iter::once(String::new()).chain(pointers(&whole)) {
            let mut spoilt = whole.clone();
            let Some(object) = spoilt.pointer_mut(&pointer).and_then(Value::as_object_mut) else {
                continue;
            };
            object.insert("colour".into(), json!(1));
            let invalid = refusal(&spoilt);
            let at = format!("{id}{pointer}: {invalid}");
            assert_eq!(invalid.place, format!("{}.colour", place_of(&pointer)), "{at}");
            assert_eq!(invalid.class, Class::Format, "{at}");
            assert!(
                invalid.reason.contains("field `colour`") || invalid.reason.contains("is not a key"),
                "{at}"
            );
        }
    }
}

/// Exact, over every value of five files.
#[test]
fn every_value_of_the_wrong_kind_is_named_with_its_place() {
    for id in RIGHT {
        let whole = value_of(id);
        for pointer in pointers(&whole) {
            let mut spoilt = whole.clone();
            *spoilt.pointer_mut(&pointer).unwrap() = json!(true);
            let invalid = refusal(&spoilt);
            let at = format!("{id}{pointer}: {invalid}");
            assert_eq!(invalid.place, place_of(&pointer), "{at}");
            let class = if pointer.ends_with("/kind") {
                Class::Unknown
            } else {
                Class::Format
            };
            assert_eq!(invalid.class, class, "{at}");
            assert!(
                ["true", "is not an object"]
                    .iter()
                    .any(|word| invalid.reason.contains(word)),
                "{at}"
            );
        }
    }
}

/// Exact, over every number of five files. In JSON a number that is not finite is one beyond the doubles, or a word.
#[test]
fn every_number_that_is_not_finite_is_named_with_its_place() {
    for id in RIGHT {
        let whole = value_of(id);
        for pointer in pointers(&whole) {
            if !whole.pointer(&pointer).unwrap().is_f64() {
                continue;
            }
            let mut spoilt = whole.clone();
            *spoilt.pointer_mut(&pointer).unwrap() = json!("HERE");
            let text = spoilt.to_string();
            for (word, class) in [
                ("1e999", Class::NotFinite),
                ("-1e999", Class::NotFinite),
                ("NaN", Class::Format),
            ] {
                let invalid = ProblemFile::read(&text.replace("\"HERE\"", word)).unwrap_err();
                let at = format!("{id}{pointer}: {word}: {invalid}");
                assert_eq!(invalid.place, place_of(&pointer), "{at}");
                assert_eq!(invalid.class, class, "{at}");
                assert!(invalid.reason.contains("line 1 column"), "{at}");
            }
        }
    }
}

#[test]
fn what_is_not_json_is_refused_with_line_and_column() {
    let good = text_of(LINEAR);
    for (text, words) in [
        (String::new(), "EOF while parsing a value at line 1 column 0"),
        ("step".into(), "expected value at line 1 column 1"),
        ("[]".into(), "invalid length 0"),
        ("null".into(), "invalid type: null"),
        (good[..200].to_owned(), "EOF while parsing"),
        (format!("{good}{good}"), "trailing characters at line"),
        (good.replacen(':', "", 1), "expected `:` at line 2 column"),
        (good.replacen("\"R\"", "\"format\"", 1), "duplicate field `format`"),
    ] {
        let invalid = ProblemFile::read(&text).unwrap_err();
        assert!(invalid.place.starts_with("problem"), "{invalid}");
        assert!(invalid.reason.contains(words), "{words} in {invalid}");
    }
}

// Problems that can be read and are wrong

/// A defect: the file, the place of the change, what stands there instead; the class, the place and words of the refusal.
type Defect = (&'static str, &'static str, Value, Class, &'static str, &'static str);

/// Each defect of the table in the file gives its own sentence: exact, by examples.
#[test]
fn every_defect_has_its_class_its_place_and_its_sentence() {
    for (id, pointer, new, class, place, words) in wrong_shapes()
        .into_iter()
        .chain(wrong_values())
        .chain(wrong_fixed_gains())
    {
        let mut spoilt = value_of(id);
        *spoilt.pointer_mut(pointer).unwrap_or_else(|| panic!("{id}{pointer}")) = new;
        let invalid = refusal(&spoilt);
        let at = format!("{id}{pointer}: {invalid}");
        assert_eq!(invalid.class, class, "{at}");
        assert_eq!(invalid.place, place, "{at}");
        assert!(invalid.reason.contains(words), "{words} in {at}");
        assert!(!invalid.to_string().contains('\n'), "one sentence: {at}");
    }
}

/// Exact: a range is a distance from zero on, and a bearing is taken up to a whole turn on either side.
#[test]
fn a_measurement_is_taken_up_to_its_limits() {
    const TURN: f64 = std::f64::consts::TAU;
    let with = |z: [f64; 2]| {
        let mut changed = value_of(POLAR);
        changed["measurements"][0]["z"] = json!(z);
        ProblemFile::read(&changed.to_string()).map_err(|invalid| invalid.class)
    };
    for z in [[0.0, -0.41], [-0.0, -0.41], [207.0, TURN], [207.0, -TURN]] {
        assert!(with(z).is_ok(), "{z:?}");
    }
    assert_eq!(with([-1e-300, -0.41]), Err(Class::Range));
    for bearing in [TURN.next_up(), -TURN.next_up()] {
        assert_eq!(with([207.0, bearing]), Err(Class::Angle));
    }
}

#[test]
fn every_class_of_refusal_has_a_defect_in_the_tables() {
    let all = wrong_shapes()
        .into_iter()
        .chain(wrong_values())
        .chain(wrong_fixed_gains());
    let mut classes: Vec<&str> = all.map(|defect| defect.3.name()).collect();
    // That one is a law of its own above.
    classes.push(Class::NotFinite.name());
    for class in Class::ALL {
        assert!(classes.contains(&class.name()), "{}", class.name());
    }
}

#[allow(clippy::too_many_lines, reason = "a table")]
fn wrong_shapes() -> Vec<Defect> {
    let row = || json!([1.0, 2.0, 3.0]);
    let three = "has 3 entries where 4 are needed";
    let one = "has 1 entries where 2 are needed";
    let shape = Class::Shape;
    vec![
        (
            LINEAR,
            "/units",
            json!(["m"]),
            shape,
            "problem.units",
            "has 1 entries where 4 are needed",
        ),
        (LINEAR, "/modes/1/F/2", row(), shape, "problem.modes[1].F[2]", three),
        (
            LINEAR,
            "/modes/0/F",
            json!([row(), row(), row()]),
            shape,
            "problem.modes[0].F",
            three,
        ),
        (LINEAR, "/modes/1/Q/0", row(), shape, "problem.modes[1].Q[0]", three),
        (
            LINEAR,
            "/modes/0/Q",
            json!([]),
            shape,
            "problem.modes[0].Q",
            "has 0 entries where 4 are needed",
        ),
        (
            LINEAR,
            "/modes",
            json!([]),
            shape,
            "problem.modes",
            "is empty; the filter needs at least one",
        ),
        (
            LINEAR,
            "/measurement/H/1",
            row(),
            shape,
            "problem.measurement.H[1]",
            three,
        ),
        (
            LINEAR,
            "/measurement/H",
            json!([row()]),
            shape,
            "problem.measurement.H",
            one,
        ),
        (
            LINEAR,
            "/R/0",
            row(),
            shape,
            "problem.R[0]",
            "has 3 entries where 2 are needed",
        ),
        (
            LINEAR,
            "/R",
            json!([[1.0]]),
            shape,
            "problem.measurement.H",
            "has 2 entries where 1 are needed",
        ),
        (
            LINEAR,
            "/transition/1",
            json!([1.0]),
            shape,
            "problem.transition[1]",
            one,
        ),
        (LINEAR, "/transition", json!([[1.0]]), shape, "problem.transition", one),
        (
            LINEAR,
            "/initial/modes",
            json!([]),
            shape,
            "problem.initial.modes",
            "has 0 entries",
        ),
        (
            LINEAR,
            "/initial/mode_probabilities",
            json!([1.0]),
            shape,
            "problem.initial.mode_probabilities",
            one,
        ),
        (
            LINEAR,
            "/initial/modes/1/mean",
            row(),
            shape,
            "problem.initial.modes[1].mean",
            three,
        ),
        (
            LINEAR,
            "/initial/modes/0/covariance/3",
            row(),
            shape,
            "problem.initial.modes[0].covariance[3]",
            three,
        ),
        (
            LINEAR,
            "/measurements/0/z",
            json!([1.0]),
            shape,
            "problem.measurements[0].z",
            one,
        ),
        (
            LINEAR,
            "/measurements/0/step",
            json!(2),
            shape,
            "problem.measurements[0].step",
            "is 2, but steps count 1, 2, 3",
        ),
        (
            LINEAR,
            "/measurements/0/step",
            json!(0),
            shape,
            "problem.measurements[0].step",
            "is 0",
        ),
        (
            POLAR,
            "/measurement/components",
            json!(["range"]),
            shape,
            "problem.measurement.components",
            one,
        ),
        (
            POLAR,
            "/measurement/position",
            json!([0]),
            shape,
            "problem.measurement.position",
            "invalid length 1",
        ),
        (
            POLAR,
            "/measurement/position",
            json!([0, 1, 2]),
            shape,
            "problem.measurement.position",
            "invalid length 3",
        ),
        (
            POLAR,
            "/measurement/sensor",
            json!([]),
            shape,
            "problem.measurement.sensor",
            "invalid length 0",
        ),
        (
            POLAR,
            "/measurement/position/1",
            json!(4),
            shape,
            "problem.measurement.position",
            "entry 4 of a state of 4",
        ),
        (
            POLAR,
            "/measurement/position",
            json!([2, 2]),
            shape,
            "problem.measurement.position",
            "names entry 2 twice",
        ),
        (
            LINEAR,
            "/state",
            json!([]),
            shape,
            "problem.state",
            "has 0 components; there must be 1 to 32",
        ),
    ]
}

#[allow(clippy::too_many_lines, reason = "a table")]
fn wrong_values() -> Vec<Defect> {
    use Class::{Angle, Format, NotAProbability, NotPositiveDefinite, NotSymmetric, Range, Unknown};
    let square = |x: f64, y: f64, z: f64, w: f64| json!([[x, y], [z, w]]);
    let symmetric = "is not symmetric";
    let semidefinite = "is not positive semidefinite";
    vec![
        (
            LINEAR,
            "/format",
            json!("immaculate-problem/3"),
            Format,
            "problem.format",
            "this program reads \"immaculate-problem/1\" and \"immaculate-problem/2\"",
        ),
        (
            LINEAR,
            "/format",
            json!("immaculate-trace/1"),
            Format,
            "problem.format",
            "is \"immaculate-trace/1\"",
        ),
        (
            LINEAR,
            "/measurements/0/step",
            json!(-1),
            Format,
            "problem.measurements[0].step",
            "invalid value: integer `-1`",
        ),
        (
            POLAR,
            "/measurement/position/0",
            json!(-1),
            Format,
            "problem.measurement.position[0]",
            "invalid value: integer `-1`",
        ),
        (
            POLAR,
            "/measurement/position/0",
            json!(0.5),
            Format,
            "problem.measurement.position[0]",
            "0.5",
        ),
        (
            LINEAR,
            "/transition/0",
            json!([0.9, 0.2]),
            NotAProbability,
            "problem.transition[0]",
            "sums to 1.1",
        ),
        (
            LINEAR,
            "/transition/0",
            json!([f64::from(0.8f32), f64::from(0.2f32)]),
            NotAProbability,
            "problem.transition[0]",
            "it looks like single precision",
        ),
        (
            LINEAR,
            "/transition/1",
            json!([-0.5, 1.5]),
            NotAProbability,
            "problem.transition[1]",
            "negative entry, -0.5",
        ),
        (
            LINEAR,
            "/initial/mode_probabilities",
            json!([0.6, 0.5]),
            NotAProbability,
            "problem.initial.mode_probabilities",
            "sums to 1.1",
        ),
        (
            LINEAR,
            "/initial/mode_probabilities",
            json!([1.5, -0.5]),
            NotAProbability,
            "problem.initial.mode_probabilities",
            "negative entry, -0.5",
        ),
        (
            LINEAR,
            "/R",
            square(121.0, 29.7, 29.8, 81.0),
            NotSymmetric,
            "problem.R",
            ": [0][1] is 29.7, [1][0] is 29.8, 1.0e-1 apart; write the same number in both",
        ),
        (
            LINEAR,
            "/modes/1/Q/0/2",
            json!(4.25),
            NotSymmetric,
            "problem.modes[1].Q",
            symmetric,
        ),
        (
            LINEAR,
            "/initial/modes/1/covariance/0/1",
            json!(-11.8),
            NotSymmetric,
            "problem.initial.modes[1].covariance",
            symmetric,
        ),
        (
            LINEAR,
            "/R",
            square(1.0, 2.0, 2.0, 1.0),
            NotPositiveDefinite,
            "problem.R",
            "is not positive semidefinite",
        ),
        (
            LINEAR,
            "/modes/0/Q/1/1",
            json!(-1.21),
            NotPositiveDefinite,
            "problem.modes[0].Q",
            semidefinite,
        ),
        (
            LINEAR,
            "/initial/modes/0/covariance/3/3",
            json!(0),
            NotPositiveDefinite,
            "problem.initial.modes[0].covariance",
            "definite",
        ),
        (
            LINEAR,
            "/measurement/kind",
            json!("polar"),
            Unknown,
            "problem.measurement.kind",
            "\"polar\"; known are linear, range-bearing",
        ),
        (
            LINEAR,
            "/filter/kind",
            json!("particle"),
            Unknown,
            "problem.filter.kind",
            "known are kalman, extended, cubature, unscented, converted, fixed-gain",
        ),
        (
            LINEAR,
            "/filter",
            json!({"kind": "kalman", "rule": "cubature-5"}),
            Format,
            "problem.filter.rule",
            "is not a key beside the kind \"kalman\"",
        ),
        (
            POLAR,
            "/filter",
            json!({"kind": "kalman"}),
            Unknown,
            "problem.filter.kind",
            "no range and bearing",
        ),
        (
            POLAR,
            "/filter/rule",
            json!("cubature-7"),
            Unknown,
            "problem.filter.rule",
            "\"cubature-7\"",
        ),
        (
            POLAR,
            "/filter/rule",
            json!("unscented"),
            Unknown,
            "problem.filter.rule",
            "unscented",
        ),
        (
            POLAR,
            "/filter/rule",
            json!("cubature-5-printed"),
            Unknown,
            "problem.filter.rule",
            "cubature-5-printed",
        ),
        (
            UNSCENTED,
            "/filter/alpha",
            json!(0),
            Unknown,
            "problem.filter",
            "positive",
        ),
        (
            POLAR,
            "/measurement/components/1",
            json!("azimuth"),
            Unknown,
            "problem.measurement.components[1]",
            "\"azimuth\"",
        ),
        (
            LINEAR,
            "/conventions/square_root",
            json!("symmetric"),
            Unknown,
            "problem.conventions.square_root",
            "\"symmetric\"",
        ),
        (
            LINEAR,
            "/conventions/angle_mean",
            json!("vector"),
            Unknown,
            "problem.conventions.angle_mean",
            "\"vector\"",
        ),
        (
            LINEAR,
            "/conventions/first_step",
            json!(""),
            Unknown,
            "problem.conventions.first_step",
            "\"\"",
        ),
        (
            LINEAR,
            "/conventions/log_likelihood",
            json!("Full"),
            Unknown,
            "problem.conventions.log_likelihood",
            "\"Full\"",
        ),
        (
            POLAR,
            "/measurements/0/z",
            json!([207.0, -23.5]),
            Angle,
            "problem.measurements[0].z[1]",
            "is it in degrees?",
        ),
        (
            POLAR,
            "/measurements/0/z",
            json!([-207.0, -0.41]),
            Range,
            "problem.measurements[0].z[0]",
            "a range is a distance",
        ),
        (
            POLAR,
            "/filter",
            json!({ "kind": "converted", "conversion": "by-guess" }),
            Unknown,
            "problem.filter.conversion",
            "known are standard, additive, multiplicative, modified-unbiased",
        ),
        (
            POLAR,
            "/filter",
            json!({ "kind": "converted", "conversion": "standard" }),
            Unknown,
            "problem.R",
            "a covariance between range and bearing",
        ),
        (
            LINEAR,
            "/filter",
            json!({ "kind": "converted", "conversion": "standard" }),
            Unknown,
            "problem.filter.kind",
            "no range and bearing to be converted",
        ),
        (
            LINEAR,
            "/conventions",
            json!({
                "square_root": "cholesky-lower", "angle_mean": "centre-point", "first_step": "mixed", "log_likelihood": "full",
                "unequal_dimensions": "by-guess",
            }),
            Unknown,
            "problem.conventions.unequal_dimensions",
            "by-guess",
        ),
    ]
}

/// What can be wrong with fixed gains, and with covariances where there are none or must be some.
fn wrong_fixed_gains() -> Vec<Defect> {
    use Class::{Format, NotSymmetric, Shape, Unknown};
    vec![
        (
            FIXED,
            "/filter/mixing",
            json!("half-mixed"),
            Unknown,
            "problem.filter.mixing",
            "known are mixed, unmixed",
        ),
        (
            FIXED,
            "/filter/modes",
            json!([]),
            Shape,
            "problem.filter.modes",
            "has 0 entries where 3 are needed",
        ),
        (
            FIXED,
            "/filter/modes/1/gain/3",
            json!([0.009]),
            Shape,
            "problem.filter.modes[1].gain[3]",
            "has 1 entries where 2 are needed",
        ),
        (
            FIXED,
            "/filter/modes/2/innovation_covariance/0/1",
            json!(34),
            NotSymmetric,
            "problem.filter.modes[2].innovation_covariance",
            "not symmetric (derbez2000 (4))",
        ),
        (
            FIXED,
            "/filter/modes/2",
            json!({"gain": [[1]]}),
            Format,
            "problem.filter.modes[2].innovation_covariance",
            "is missing",
        ),
        (
            FIXED,
            "/initial/modes/0",
            json!({"mean": [1, 2, 3, 4], "covariance": [[1]]}),
            Format,
            "problem.initial.modes[0].covariance",
            "filters with fixed gains have no covariance",
        ),
        (
            LINEAR,
            "/initial/modes/0",
            json!({"mean": [1, 2, 3, 4]}),
            Format,
            "problem.initial.modes[0].covariance",
            "is missing",
        ),
        (
            LINEAR,
            "/initial/modes/0/covariance",
            json!(null),
            Format,
            "problem.initial.modes[0].covariance",
            "invalid type: null",
        ),
    ]
}

/// What JSON cannot say, a filter in Rust can: the measurement is checked, too.
#[test]
fn a_measurement_that_is_not_finite_is_refused() {
    let mut problem = ProblemFile::read(&text_of(POLAR)).unwrap();
    problem.measurements[0].z = Some(vec![Some(207.0), Some(f64::NAN)]);
    let invalid = problem.check().unwrap_err();
    assert_eq!(
        (invalid.class, invalid.place.as_str()),
        (Class::NotFinite, "problem.measurements[0].z[1]")
    );
}

/// By hand: the names by which filters are selected, and the equations of those that take a value from another place than most.
#[test]
fn a_filter_has_a_name_and_equations_of_its_paper() {
    let filter = |id: &str| ProblemFile::parse(&value_of(id).to_string()).unwrap().filter;
    let unmixed = "step.fixed-gain-unmixed";
    let names = [LINEAR, POLAR, UNSCENTED, CONVERTED, FIXED, unmixed].map(|id| filter(id).name().to_owned());
    assert_eq!(
        names,
        [
            "kalman",
            "cubature-5",
            "unscented",
            "converted",
            "fixed-gain",
            "fixed-gain-unmixed"
        ]
    );
    for (id, name, equation) in [
        (LINEAR, "gain", "zhu2016 (51), liu2017 (20)"),
        (LINEAR, "cross_covariance", "zhu2016 (48), liu2017 (19)"),
        (CONVERTED, "innovation", "sustika2015 (18)"),
        (CONVERTED, "predicted_measurement", "sustika2015 (18)"),
        (CONVERTED, "innovation_covariance", "sustika2015 (16)"),
        (CONVERTED, "cross_covariance", "sustika2015 (17)"),
        (CONVERTED, "gain", "sustika2015 (17)"),
        (CONVERTED, "updated.mean", "zhu2016 (52), liu2017 (20)"),
        (FIXED, "innovation_covariance", "derbez2000 (4), given"),
        (FIXED, "gain", "derbez2000, section 3, given"),
        (unmixed, "updated.mean", "derbez2000, section 3"),
        (FIXED, "mixed.mean", "zhu2016 (55), liu2017 (12)"),
    ] {
        assert_eq!(filter(id).equation(quantity(name)), equation, "{id}, {name}");
    }
}

// Schemas

#[test]
fn the_published_schemas_are_those_of_the_code() {
    for (name, schema) in [
        ("problem", schema::of_problems()),
        ("trace", schema::of_traces()),
        ("certificate", immaculate::steady::certificate_file::schema()),
    ] {
        let path = root().join(format!("spec/schemas/{name}.schema.json"));
        let published = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(
            published == format!("{schema:#}\n"),
            "spec/schemas/{name}.schema.json is out of date; renew: immaculate cases schema {name} > spec/schemas/{name}.schema.json"
        );
    }
}

/// The schemas take every published file, and none in which a key is missing, is not known, or has a value of another kind.
#[test]
fn the_schemas_take_what_is_published_and_refuse_what_is_spoilt() {
    let (problems, traces) = (schema::of_problems(), schema::of_traces());
    for case in all() {
        let id = &case.problem.id;
        let (problem, trace) = (parsed(case.problem_text), parsed(case.trace_text));
        // A problem that must be refused for its structure is the schema's to refuse, too.
        let is_of_the_format = case.expected != Expected::Rejection(Class::Format);
        let found = against_schema(&problem, &problems, &problems, "problem");
        assert_eq!(found.is_ok(), is_of_the_format, "{id}: {found:?}");
        assert_eq!(against_schema(&trace, &traces, &traces, "trace"), Ok(()), "{id}");
    }
    for id in RIGHT {
        let whole = value_of(id);
        for pointer in pointers(&whole) {
            let mut spoilt = whole.clone();
            *spoilt.pointer_mut(&pointer).unwrap() = json!(true);
            assert!(
                against_schema(&spoilt, &problems, &problems, "").is_err(),
                "{id}{pointer} of the wrong kind"
            );
            let (parent, key) = pointer.rsplit_once('/').unwrap();
            let mut spoilt = whole.clone();
            if let Some(object) = spoilt.pointer_mut(parent).and_then(Value::as_object_mut) {
                object.shift_remove(key);
                assert_eq!(
                    against_schema(&spoilt, &problems, &problems, "").is_ok(),
                    pointer == OPTIONAL,
                    "{id}{pointer} is missing"
                );
                object_at(&mut spoilt, parent).insert("colour".into(), json!(1));
                assert!(
                    against_schema(&spoilt, &problems, &problems, "").is_err(),
                    "{id}{parent}: another key"
                );
            }
        }
    }
}

/// The schema of certificates takes every published one and a counterexample, and refuses what the reader refuses: a key that is missing
/// or not known, a value of another kind, a letter that names no filter, a form that is not 3 × 3, and more than a certificate may have.
#[test]
fn the_schema_of_certificates_refuses_what_the_reader_refuses() {
    let schema = immaculate::steady::certificate_file::schema();
    let is_taken = |value: &Value| against_schema(value, &schema, &schema, "certificate").is_ok();
    let is_read = |value: &Value| {
        CertificateFile::read(&with_digest(value))
            .and_then(|file| file.check())
            .is_ok()
    };
    for whole in certificates() {
        assert!(is_taken(&whole) && is_read(&whole), "{whole}");
        for pointer in pointers(&whole) {
            let mut spoilt = whole.clone();
            *spoilt.pointer_mut(&pointer).unwrap() = json!(true);
            assert!(!is_taken(&spoilt) && !is_read(&spoilt), "{pointer} of the wrong kind");
            let (parent, key) = pointer.rsplit_once('/').unwrap();
            let mut spoilt = whole.clone();
            match spoilt.pointer_mut(parent).unwrap() {
                Value::Object(object) => object.shift_remove(key).map(drop).unwrap(),
                // An edge or a node that is not there is a matter of the proof, and not of its form.
                Value::Array(_) if parent.ends_with("/edges") || parent.ends_with("/forms") => continue,
                Value::Array(list) => drop(list.remove(key.parse().unwrap())),
                _ => unreachable!(),
            }
            assert!(!is_taken(&spoilt) && !is_read(&spoilt), "{pointer} is missing");
            if let Some(object) = spoilt.pointer_mut(parent).and_then(Value::as_object_mut) {
                *object = object_at(&mut whole.clone(), parent).clone();
                object.insert("colour".into(), json!(1));
                assert!(!is_taken(&spoilt) && !is_read(&spoilt), "{parent}: another key");
            }
        }
    }
    let all = certificates();
    let stable = all
        .iter()
        .find(|certificate| certificate.pointer("/proof/stable").is_some())
        .unwrap();
    for (pointer, times) in [("/proof/stable/edges", 257), ("/proof/stable/forms", 257)] {
        let mut long = stable.clone();
        let list = long.pointer_mut(pointer).unwrap().as_array_mut().unwrap();
        *list = list.iter().cycle().take(list.len() * times).cloned().collect();
        assert!(!is_taken(&long) && !is_read(&long), "{pointer}");
    }
    let mut letter = stable.clone();
    *letter.pointer_mut("/proof/stable/edges/0/1").unwrap() = json!("w");
    assert!(!is_taken(&letter) && !is_read(&letter));
}

/// The published certificates, of stability and of instability.
fn certificates() -> Vec<Value> {
    let folder = std::fs::read_dir(root().join("fixtures/certificates")).unwrap();
    let texts = folder.map(|entry| std::fs::read_to_string(entry.unwrap().path()).unwrap());
    let all: Vec<Value> = texts.map(|text| parsed(&text)).collect();
    for kind in [
        "/proof/stable",
        "/proof/unstable",
        "/filters/noises",
        "/filters/damping-roots",
    ] {
        assert!(
            all.iter().any(|certificate| certificate.pointer(kind).is_some()),
            "{kind}"
        );
    }
    all
}

/// The text of a certificate, its digest, if it has one, that of what stands in it.
fn with_digest(value: &Value) -> String {
    let mut value = value.clone();
    if value["digest"].is_string() {
        value["digest"] = json!(digest(&format!("{}{}", value["filters"], value["proof"])));
    }
    value.to_string()
}

// Traces

/// JSON → trace → JSON, and JSON → trace → long CSV → trace: exact, over every published case.
#[test]
fn reading_and_writing_a_trace_is_the_identity() {
    let mut read = 0;
    for case in all() {
        let Expected::Trace(trace) = &case.expected else {
            continue;
        };
        let id = &case.problem.id;
        let steps = parsed(case.trace_text)["steps"].clone();
        let again = Trace::from_json(&steps, &trace.dimensions).unwrap();
        assert_eq!(&again, trace, "{id}");
        assert!(Value::Array(trace.steps_as_json()) == steps, "{id}: JSON");
        for text in [
            csv::write(id, trace, "", |_, _| String::new()),
            long_csv(&case.problem, trace, case.trace_text),
        ] {
            assert!(
                csv::read(&text, id, &trace.dimensions).as_ref() == Ok(trace),
                "{id}: CSV"
            );
        }
        read += 1;
    }
    assert!(read > 90, "{read}");
}

/// A trace of one mode, two states and one measurement, one step.
static SMALL: LazyLock<Dimensions> = LazyLock::new(|| Dimensions::new(2, 1, 1, 2));

/// A likelihood is its logarithm, as long as a double has its digits; where both are shown the logarithm counts, in any order.
#[test]
fn a_likelihood_is_read_as_its_logarithm() {
    let read = |mode: Value| {
        let trace = Trace::from_json(&json!([{ "step": 1, "modes": [mode] }]), &SMALL)?;
        Ok::<_, Invalid>(trace.get(1, Quantity::LogLikelihood, 0).cloned())
    };
    assert_eq!(read(json!({ "likelihood": 1.0 })), Ok(Some(vec![0.0])));
    assert_eq!(
        read(json!({ "likelihood": [2.0] })),
        Ok(Some(vec![std::f64::consts::LN_2]))
    );
    assert_eq!(read(json!({ "likelihood": f64::MIN_POSITIVE / 2.0 })), Ok(None));
    assert_eq!(read(json!({ "likelihood": 0 })), Ok(None));
    for both in [
        json!({ "likelihood": 2.0, "log_likelihood": -7.0 }),
        json!({ "log_likelihood": -7.0, "likelihood": 2.0 }),
    ] {
        assert_eq!(read(both), Ok(Some(vec![-7.0])));
    }
    for wrong in [json!(-1.0), json!(null)] {
        let found = read(json!({ "likelihood": wrong })).unwrap().unwrap();
        assert!(!found[0].is_finite(), "{wrong}");
    }
    let invalid = read(json!({ "likelihood": [1.0, 2.0] })).unwrap_err();
    assert_eq!(
        invalid.to_string(),
        "steps[0].modes[0].likelihood: has 2 numbers where 1 × 1 are needed"
    );
}

/// The same step in the ways of different writers.
#[test]
fn answers_are_read_with_patience() {
    let plain = json!([{ "step": 1, "modes": [{ "mixing_probabilities": [1.0], "gain": [[0.5], [0.25]], "innovation_covariance": [[4.0]],
        "mixed": { "mean": [1.0, 2.0], "covariance": [[1.0, 0.5], [0.5, 2.0]] }, "log_likelihood": -1.5 }],
        "mode_probabilities": [1.0] }]);
    let expected = Trace::from_json(&plain, &SMALL).unwrap();
    assert_eq!(expected.count(), 7);
    let change = |pointer: &str, new: Value| {
        let mut changed = plain.clone();
        *changed.pointer_mut(pointer).unwrap() = new;
        changed
    };
    for (what, patient) in [
        (
            "a scalar for a list of one",
            change("/0/mode_probabilities", json!(1.0)),
        ),
        (
            "a scalar for a 1 × 1 matrix",
            change("/0/modes/0/innovation_covariance", json!(4.0)),
        ),
        (
            "a list for a 1 × 1 matrix",
            change("/0/modes/0/innovation_covariance", json!([4])),
        ),
        (
            "a list of lists for a scalar",
            change("/0/modes/0/log_likelihood", json!([[-1.5]])),
        ),
        (
            "an object for a list of one mode",
            change("/0/modes", plain[0]["modes"][0].clone()),
        ),
        ("an object for a list of one step", plain[0].clone()),
        (
            "a column vector as rows",
            change("/0/modes/0/mixed/mean", json!([[1.0], [2.0]])),
        ),
        (
            "a row vector as a row",
            change("/0/modes/0/mixed/mean", json!([[1.0, 2.0]])),
        ),
        (
            "a matrix as one list, by rows",
            change("/0/modes/0/mixed/covariance", json!([1.0, 0.5, 0.5, 2.0])),
        ),
        (
            "a matrix nested deeper",
            change("/0/modes/0/gain", json!([[[[0.5]], [[0.25]]]])),
        ),
        ("a step with a decimal point", change("/0/step", json!(1.0))),
        (
            "whole numbers without one",
            change("/0/modes/0/mixed/mean", json!([1, 2])),
        ),
    ] {
        assert_eq!(Trace::from_json(&patient, &SMALL), Ok(expected.clone()), "{what}");
    }
    let empty = change("/0/modes/0/gain", json!([]));
    let count = Trace::from_json(&empty, &SMALL).unwrap().count();
    assert_eq!(count, 6, "an empty list is not shown");
}

/// The words of Python, JavaScript, Julia, C and MATLAB for what is not finite.
#[test]
fn what_is_not_finite_is_read_as_such() {
    for word in [
        "NaN",
        "nan",
        "-NaN",
        "Infinity",
        "-Infinity",
        "inf",
        "-inf",
        "+Inf",
        "null",
        "\"NaN\"",
        "\"-Inf\"",
    ] {
        let one = format!("{{\"steps\":[{{\"step\":1,\"modes\":[{{\"predicted\":{{\"mean\":[1.5, {word}]}}}}]}}]}}");
        let trace = Trace::from_json(&read_json(&one).unwrap()["steps"], &SMALL).unwrap();
        let mean = trace.get(1, quantity("predicted.mean"), 0).unwrap();
        assert!(
            (mean[0] - 1.5).abs() < f64::MIN_POSITIVE && mean[1].is_nan(),
            "{word}: {mean:?}"
        );
        // The first alone does not stand for all.
        let first = one.replace(&format!("[1.5, {word}]"), &format!("[{word}, 1.5]"));
        let trace = Trace::from_json(&read_json(&first).unwrap()["steps"], &SMALL).unwrap();
        let mean = trace.get(1, quantity("predicted.mean"), 0).unwrap();
        assert!(mean[0].is_nan() && mean[1].is_finite(), "{word}: {mean:?}");
        // One for a whole matrix.
        let whole = format!("[{{\"step\":2,\"combined\":{{\"covariance\":{word}}}}}]");
        let trace = Trace::from_json(&read_json(&whole).unwrap(), &SMALL).unwrap();
        let covariance = trace.get(2, quantity("combined.covariance"), 0).unwrap();
        assert!(
            covariance.len() == 4 && covariance.iter().all(|value| value.is_nan()),
            "{word}"
        );
        let line = format!(
            "{}\nx,1,,mode_probabilities,1,,{}\n",
            csv::HEADER,
            word.trim_matches('"')
        );
        if word != "null" {
            let trace = csv::read(&line, "x", &SMALL).unwrap();
            assert!(
                trace.get(1, quantity("mode_probabilities"), 0).unwrap()[0].is_nan(),
                "{line}"
            );
        }
    }
    // Words inside of texts are left as they are.
    let text = "{\"a\":\"NaN \\\" Infinity\",\"b\\\\\":[-Infinity,\"inf\"],\"nano\":1}";
    let expected = json!({ "a": "NaN \" Infinity", "b\\": ["-Infinity", "inf"], "nano": 1 });
    assert_eq!(read_json(text), Ok(expected));
    for not_json in ["[nano]", "[NaNs]", "[1 NaN]", "{NaN:1}x"] {
        assert!(read_json(not_json).is_err(), "{not_json}");
    }
}

#[test]
fn a_wrong_answer_is_refused_with_its_place() {
    for (steps, place, words) in [
        (
            json!([{ "step": 1, "colour": 1 }]),
            "steps[0].colour",
            "is not a key of a trace",
        ),
        (
            json!([{ "step": 1, "modes": [{ "colour": 1 }] }]),
            "steps[0].modes[0].colour",
            "is not a key",
        ),
        (
            json!([{ "step": 1, "combined": { "gain": 1 } }]),
            "steps[0].combined.gain",
            "is not a key",
        ),
        (
            json!([{ "step": 1, "combined.mean": [1, 2] }]),
            "steps[0].combined.mean",
            "is not a key",
        ),
        (json!([{ "step": 1, "gain": [1, 2] }]), "steps[0].gain", "is not a key"),
        (
            json!([{ "step": 1, "modes": [{ "combined": { "mean": [1, 2] } }] }]),
            "steps[0].modes[0].combined",
            "is not a key",
        ),
        (
            json!([{ "step": 1, "combined": [1, 2] }]),
            "steps[0].combined",
            "is not an object",
        ),
        (
            json!([{ "step": 1, "modes": [1] }]),
            "steps[0].modes[0]",
            "is not an object",
        ),
        (
            json!([{ "step": 1, "modes": [{}, {}] }]),
            "steps[0].modes",
            "has 2 entries where there are 1 modes",
        ),
        (
            json!([{ "step": 1, "mode_probabilities": [0.5, 0.5] }]),
            "steps[0].mode_probabilities",
            "has 2 numbers where 1 × 1",
        ),
        (
            json!([{ "step": 2, "combined": { "mean": [1] } }]),
            "steps[0].combined.mean",
            "has 1 numbers where 2 × 1",
        ),
        (
            json!([{ "step": 2, "combined": { "mean": [1, "one"] } }]),
            "steps[0].combined.mean[1]",
            "is not a number",
        ),
        (
            json!([{ "step": 2, "combined": { "mean": [1, true] } }]),
            "steps[0].combined.mean[1]",
            "is not a number",
        ),
        (
            json!([{ "step": 2, "combined": { "mean": { "x": 1 } } }]),
            "steps[0].combined.mean",
            "is not a number",
        ),
        (
            json!([{ "step": 1 }, { "step": 1 }]),
            "steps[1].step",
            "is 1 a second time",
        ),
        (
            json!([{ "step": 0 }]),
            "steps[0].step",
            "is 0, but the problem has steps 1 to 2",
        ),
        (
            json!([{ "step": 1 }, { "step": 3 }]),
            "steps[1].step",
            "is 3, but the problem has steps 1 to 2",
        ),
        (json!([{ "step": 1.5 }]), "steps[0].step", "not a whole number"),
        (json!([{ "step": "1" }]), "steps[0].step", "not a whole number"),
        (json!([{ "modes": [] }]), "steps[0].step", "is missing"),
        (json!(["step"]), "steps[0]", "is not an object"),
    ] {
        let invalid = Trace::from_json(&steps, &SMALL).unwrap_err();
        assert_eq!(invalid.place, place, "{invalid}");
        assert!(invalid.reason.contains(words), "{words} in {invalid}");
    }
}

#[test]
fn a_long_csv_is_read_with_patience() {
    let plain = format!("{}\nx,1,,combined.mean,1,,0.5\nx,1,,combined.mean,2,,-2\n", csv::HEADER);
    let expected = csv::read(&plain, "x", &SMALL).unwrap();
    for patient in [
        plain.replace('\n', "\r\n"),
        plain.replace(',', " , "),
        format!("\u{feff}{plain}"),
        format!("{plain}other,9,9,colour,,,red\n\n"),
        plain.replace("-2\n", "-2,1,1e-16\n"),
        plain.replace("x,1", "\"x\",1.0"),
        plain.replace("-2", "-2.0e+0"),
        plain.replacen("x,1,,combined.mean,1,,0.5\n", "", 1) + "x,1,,combined.mean,1,1,0.5\n",
        // A value of all modes has no mode, and a vector no column, whatever stands there.
        plain.replacen("x,1,,combined.mean,1,,0.5\n", "", 1) + "x,1,7,combined.mean,1,9,0.5\n",
    ] {
        assert_eq!(csv::read(&patient, "x", &SMALL), Ok(expected.clone()), "{patient:?}");
    }
    let scalar = |row: &str| {
        let text = format!("{}\nx,1,1,log_likelihood,{row},,-1.5\n", csv::HEADER);
        csv::read(&text, "x", &SMALL)
    };
    assert_eq!(scalar("7"), scalar(""), "a scalar has no row");
    assert_eq!(scalar("").map(|trace| trace.count()), Ok(1));
    // An id is written so that it is read again, whatever it is.
    for id in ["a,b", "a\"b\"", "a\nb"] {
        let text = csv::write(id, &expected, "", |_, _| String::new());
        assert_eq!(csv::read(&text, id, &SMALL), Ok(expected.clone()), "{text}");
    }
}

/// A number by itself has no row, one of a vector no column; scale and noise of each are those of its own step and mode.
#[test]
fn the_lines_of_a_long_csv_say_where_a_number_stands() {
    let case = of("steps.kalman");
    let Expected::Trace(trace) = &case.expected else {
        panic!("a trace")
    };
    let text = long_csv(&case.problem, trace, case.trace_text);
    let file = parsed(case.trace_text);
    let line = |start: &str| {
        let start = format!("{},{start},", case.problem.id);
        let mut lines = text.lines().filter_map(|line| line.strip_prefix(&start));
        let [value, scale, noise]: [f64; 3] = {
            let columns = lines.next().unwrap().split(',');
            columns
                .map(|number| number.parse().unwrap())
                .collect::<Vec<_>>()
                .try_into()
                .unwrap()
        };
        assert_eq!(lines.next(), None, "{start}");
        (value, scale, noise)
    };
    for (start, value, noise) in [
        (
            "2,1,log_likelihood,,",
            "/steps/1/modes/0/log_likelihood",
            "/noise/1/modes/0/log_likelihood",
        ),
        (
            "2,2,updated.mean,3,",
            "/steps/1/modes/1/updated/mean/2",
            "/noise/1/modes/1/updated/mean",
        ),
        ("1,2,gain,4,2", "/steps/0/modes/1/gain/3/1", "/noise/0/modes/1/gain"),
        (
            "2,,mode_probabilities,2,",
            "/steps/1/mode_probabilities/1",
            "/noise/1/mode_probabilities",
        ),
    ] {
        let number = |pointer: &str| file.pointer(pointer).and_then(Value::as_f64).unwrap();
        let (found, scale, found_noise) = line(start);
        assert_eq!((found, found_noise), (number(value), number(noise)), "{start}");
        // The file has three digits of it: half a unit of the third is at most a two-hundredth.
        let three_digits = number(&value.replace("/steps/", "/scale/"));
        assert!(
            scale > 0.0 && (scale / three_digits - 1.0).abs() <= 0.005,
            "{start}: {scale}"
        );
    }
}

#[test]
fn a_wrong_long_csv_is_refused_with_its_line() {
    for (line, place, words) in [
        ("x,1,,colour,1,,0", "line 3", "\"colour\", which is not a quantity"),
        ("x,3,,combined.mean,1,,0", "line 3", "has step \"3\"; it must be 1 to 2"),
        ("x,0,,combined.mean,1,,0", "line 3", "has step \"0\""),
        ("x,,,combined.mean,1,,0", "line 3", "has step \"\""),
        ("x,1e300,,combined.mean,1,,0", "line 3", "has step \"1e300\""),
        ("x,NaN,,combined.mean,1,,0", "line 3", "has step \"NaN\""),
        ("x,1,2,updated.mean,1,,0", "line 3", "has mode \"2\"; it must be 1 to 1"),
        ("x,1,1,updated.mean,3,,0", "line 3", "has row \"3\"; it must be 1 to 2"),
        ("x,1,1,updated.mean,,,0", "line 3", "has row \"\""),
        (
            "x,1,1,updated.covariance,1,3,0",
            "line 3",
            "has column \"3\"; it must be 1 to 2",
        ),
        ("x,1,1,updated.covariance,1,-1,0", "line 3", "has column \"-1\""),
        ("x,1,,combined.mean,2,,nought", "line 3", "has value \"nought\""),
        ("x,1,,combined.mean,2", "line 3", "fewer than seven columns"),
        (
            "x,1,,combined.mean,2,,0,5",
            "line 3",
            "has 8 fields where 7 are needed: is the value written with a decimal comma?",
        ),
        ("x,2,,mode_probabilities,1,,1", "line 3", "an earlier line has"),
        (
            "x,1,,combined.mean,2,,0",
            "step 1, mode 1, combined.mean",
            "has 1 lines where 2 × 1 numbers are needed",
        ),
    ] {
        let text = format!("{}\nx,2,,mode_probabilities,1,,1\n{line}\n", csv::HEADER);
        let invalid = csv::read(&text, "x", &SMALL).unwrap_err();
        assert_eq!(invalid.place, place, "{line}: {invalid}");
        assert!(invalid.reason.contains(words), "{words} in {invalid}");
    }
    for text in [
        "",
        "id;step;mode;quantity;row;column;value\n",
        "step,id,mode,quantity,row,column,value\n",
    ] {
        let invalid = csv::read(text, "x", &SMALL).unwrap_err();
        assert_eq!(invalid.place, "line 1", "{invalid}");
        assert!(invalid.reason.contains(csv::HEADER), "{invalid}");
    }
}

// The published cases

/// Exact, on the texts of the files.
#[test]
fn the_numbers_of_published_problems_have_at_most_fifteen_digits() {
    for case in all() {
        for number in numbers_in(case.problem_text) {
            let mantissa = number.split(['e', 'E']).next().unwrap();
            let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
            assert!(digits.trim_matches('0').len() <= 15, "{}: {number}", case.problem.id);
        }
    }
    assert_eq!(numbers_in("{\"a1\":[-1.5e-3,20],\"b\\\"2\":\"3\"}"), ["-1.5e-3", "20"]);
}

#[test]
fn the_lock_holds_every_file_of_the_folder_and_nothing_else() {
    let lock = case::lock().unwrap();
    assert_eq!(lock.format, Lock::FORMAT);
    let mut expected = BTreeSet::from([LOCK.to_owned()]);
    let mut ids = BTreeSet::new();
    for locked in &lock.cases {
        assert!(ids.insert(&locked.id), "{} twice", locked.id);
        expected.extend([case::problem_name(&locked.id), case::trace_name(&locked.id)]);
        for (name, expected) in [
            (case::problem_name(&locked.id), &locked.problem),
            (case::trace_name(&locked.id), &locked.trace),
        ] {
            let text = std::fs::read_to_string(folder().join(&name)).unwrap();
            assert_eq!(&digest(&text), expected, "{name}");
        }
    }
    let entries = std::fs::read_dir(folder()).unwrap();
    let found: BTreeSet<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    assert_eq!(found, expected);
    // SHA-256 of nothing and of three letters, from the standard (FIPS 180-4, examples).
    assert!(digest("").starts_with("e3b0c44298fc1c149afbf4c8996fb924"));
    assert!(digest("abc").starts_with("ba7816bf8f01cfea414140de5dae2223"));
    let other = serde_json::to_string(&json!({ "format": "immaculate-lock/2", "cases": [] })).unwrap();
    assert!(Lock::read(&other).unwrap_err().contains("immaculate-lock/2"));
}

/// Certified: every number of every case, from nothing but the problems.
#[test]
fn every_case_is_proven_again() {
    let proven: Vec<(usize, bool)> = all()
        .par_iter()
        .map(|case| {
            let certified = case.verify().unwrap_or_else(|bad| panic!("{bad}"));
            assert_eq!(
                certified.is_some(),
                matches!(case.expected, Expected::Trace(_)),
                "{}",
                case.problem.id
            );
            (certified.map_or(0, |certified| certified.trace.count()), true)
        })
        .collect();
    assert_eq!(proven.len(), case::lock().unwrap().cases.len());
    assert!(proven.iter().map(|(values, _)| values).sum::<usize>() > 10_000);
}

/// The proof notices one digit of any line of a trace, be it value, scale or noise.
/// The digits left to an enclosure are given in the unit of its value: in units of 2⁻⁴⁰ m every width is 2⁴⁰ times as large, and so is
/// every unit.
#[test]
fn the_digits_that_are_left_do_not_depend_on_the_units() {
    let plain = value_of(LINEAR);
    let mut scaled = plain.clone();
    let times = |value: &mut Value, factor: f64| {
        let product = value.as_f64().unwrap() * factor;
        *value = json!(product);
    };
    let unit = 2.0_f64.powi(40);
    for pointer in pointers(&plain)
        .iter()
        .filter(|pointer| plain.pointer(pointer).unwrap().is_number())
    {
        let is_in = |words: &[&str]| words.iter().any(|word| pointer.contains(word));
        if is_in(&["/mean/", "/z/"]) {
            times(scaled.pointer_mut(pointer).unwrap(), unit);
        } else if is_in(&["/Q/", "/R/", "/covariance/"]) {
            times(scaled.pointer_mut(pointer).unwrap(), unit * unit);
        }
    }
    let digits = |problem: &Value| {
        let problem = ProblemFile::read(&problem.to_string()).unwrap();
        let certified = certify(&problem).unwrap();
        (certified.digits, certified.bits)
    };
    assert_eq!(digits(&scaled), digits(&plain));
    assert!(digits(&plain).0 > 50);
}

/// A target on the x-axis that is as uncertain to the left as to the right: its bearing is expected to be zero, as a sum of irrational
/// numbers of which no number of digits shows it. It is certified as zero, in doubles and in decimals.
#[test]
fn what_is_zero_by_symmetry_is_certified_as_zero() {
    let mut problem = value_of("rule.cubature-3.n2");
    let diagonal = |a: f64, b: f64| json!([[a, 0.0], [0.0, b]]);
    problem["measurement"]["sensor"] = json!([0.0, 0.0]);
    problem["modes"][0]["F"] = diagonal(1.0, 1.0);
    problem["modes"][0]["Q"] = diagonal(2.0, 3.0);
    problem["initial"]["modes"][0] = json!({ "mean": [50.0, 0.0], "covariance": diagonal(7.0, 5.0) });
    let problem = ProblemFile::read(&problem.to_string()).unwrap();
    let expected = (1, quantity("predicted_measurement"), 0);
    let certified = certify(&problem).unwrap().trace;
    let numbers = certified.get(expected.0, expected.1, expected.2).unwrap();
    assert!(numbers[0] > 50.0 && numbers[1].to_bits() == 0, "{numbers:?}");
    let (decimals, _) = certified_decimals(&problem, 20).unwrap();
    assert_eq!(decimals.get(expected.0, expected.1, expected.2).unwrap()[1], "0");
}

#[test]
fn a_case_with_another_digit_is_not_proven() {
    let good = of("update.kalman");
    assert!(good.verify().is_ok());
    for (line, digits) in (1..).zip(good.trace_text.lines()) {
        let Some(at) = digits
            .rfind(|c: char| c.is_ascii_digit())
            .filter(|_| digits.contains("step\""))
        else {
            continue;
        };
        let mut changed = digits.to_owned();
        let other = if &digits[at..=at] == "1" { "2" } else { "1" };
        changed.replace_range(at..=at, other);
        let spoilt = Case {
            trace_text: good.trace_text.replacen(digits, &changed, 1).leak(),
            ..good.clone()
        };
        let bad = spoilt.verify().unwrap_err();
        assert_eq!(
            bad,
            BadCase::Differs {
                id: "update.kalman".into(),
                line
            }
        );
    }
    let longer = Case {
        trace_text: format!("{}\n", good.trace_text).leak(),
        ..good.clone()
    };
    assert!(longer.verify().is_err());
}

/// The noise is a measurement: another order of operations in an equation draws another sample, and a case is proven with it all the same.
#[test]
fn another_sample_of_the_noise_is_accepted_and_another_noise_is_not() {
    let good = of("update.kalman");
    let certified = certify(&good.problem).unwrap();
    // Published with another noise: each number times the factor of its place.
    let published = |factor: &dyn Fn((usize, Quantity, usize)) -> f64| {
        let noise = certified
            .noise
            .map(|place, spread| spread.iter().map(|one| one * factor(place)).collect());
        let text = case::trace_text(
            &good.problem.id,
            &Certified {
                noise,
                ..certified.clone()
            },
        );
        Case {
            trace_text: text.leak(),
            ..good.clone()
        }
    };
    assert!(published(&|_| 1.0).verify().is_ok());
    // All numbers three and a half times as large, or as small, are those of other equations; twice as large is another sample.
    for factor in [3.5, 1.0 / 3.5] {
        let refused = published(&|_| factor).verify();
        assert!(matches!(refused, Err(BadCase::Noise { .. })), "{factor}: {refused:?}");
    }
    assert!(published(&|_| 2.0).verify().is_ok());
    // One number eight times as large is another sample; fifty times as large it is not this noise.
    let one = |factor: f64| move |place| if place == (1, Quantity::Gain, 0) { factor } else { 1.0 };
    assert!(published(&one(8.0)).verify().is_ok());
    assert!(matches!(published(&one(50.0)).verify(), Err(BadCase::Differs { .. })));
}

#[test]
fn a_case_with_another_problem_is_not_proven() {
    let mut spoilt = of("update.kalman").clone();
    spoilt.problem.noise[0][0] = spoilt.problem.noise[0][0].next_up();
    assert!(matches!(spoilt.verify(), Err(BadCase::Differs { .. })));
    spoilt.problem.noise[0][0] = f64::NAN;
    assert!(matches!(spoilt.verify(), Err(BadCase::NotCertified { .. })));
    // What must be rejected and is not, or for another reason.
    let mut spoilt = of("rejected.symmetric.noise").clone();
    assert!(spoilt.verify().is_ok());
    spoilt.expected = Expected::Rejection(Class::Shape);
    let sentence = spoilt.verify().unwrap_err().to_string();
    assert!(
        sentence.contains("must be rejected as shape, but is rejected as not-symmetric"),
        "{sentence}"
    );
    spoilt.problem.noise[1][0] = spoilt.problem.noise[0][1];
    let sentence = spoilt.verify().unwrap_err().to_string();
    assert!(sentence.contains("but is accepted"), "{sentence}");
}

#[test]
fn a_case_with_another_digest_is_not_read() {
    let good = case::lock().unwrap().cases.remove(0);
    assert!(case::read(&good).is_ok());
    let other = |digest: &str| {
        let first = if digest.starts_with('0') { "1" } else { "0" };
        format!("{first}{}", &digest[1..])
    };
    let mut spoilt = good.clone();
    spoilt.problem = other(&good.problem);
    let sentence = case::read(&spoilt).unwrap_err().to_string();
    assert!(
        sentence.contains(&case::problem_name(&good.id)) && sentence.contains("is not what was published"),
        "{sentence}"
    );
    let mut spoilt = good.clone();
    spoilt.trace = other(&good.trace);
    assert!(matches!(case::read(&spoilt), Err(BadCase::Changed { file, .. }) if file == case::trace_name(&good.id)));
    let mut spoilt = good;
    spoilt.id = "no.such".into();
    assert_eq!(
        case::read(&spoilt).unwrap_err(),
        BadCase::Missing("no.such.problem.json".into())
    );
}

/// `max(|x − expected| / scale) < 100 · noise`, from the JSON files alone, holds for this crate's own doubles.
#[test]
fn the_plain_unit_test_passes_for_the_filter_itself() {
    let mut compared = 0;
    for case in all() {
        if matches!(case.expected, Expected::Trace(_)) {
            let (numbers, wrong) = plain_unit_test(case, &[]);
            assert_eq!(wrong, Vec::<String>::new(), "{}", case.problem.id);
            compared += numbers;
        }
    }
    assert!(compared > 100_000, "{compared} numbers");
}

/// The negative side: two mistakes, each seen where it was made.
#[test]
fn the_plain_unit_test_fails_for_a_mistake() {
    for (id, variant, place) in [
        ("mixing.three-modes", "mixed-spread-omitted", "mixed.covariance"),
        (
            "combination.three-modes",
            "combined-spread-omitted",
            "combined.covariance",
        ),
    ] {
        let (_, wrong) = plain_unit_test(of(id), &[variant]);
        assert!(wrong.iter().any(|at| at.ends_with(place)), "{variant}: {wrong:?}");
    }
}

/// What a user without Immaculate would write: three lists walked side by side. The numbers compared, and the places that are wrong.
fn plain_unit_test(case: &Case, variants: &[&str]) -> (usize, Vec<String>) {
    let mut own = Planted {
        variants: variants.iter().map(|id| (*id).to_owned()).collect(),
        level: Level::Everything,
    };
    let Answer::Steps { trace, error: None } = own.run(&case.problem) else {
        panic!("{}", case.problem.id);
    };
    let file = parsed(case.trace_text);
    let mut found = (0, Vec::new());
    let own = Value::Array(trace.steps_as_json());
    compare(
        &own,
        [&file["steps"], &file["scale"], &file["noise"]],
        "steps",
        &mut found,
    );
    found
}

fn compare(own: &Value, [expected, scale, noise]: [&Value; 3], place: &str, found: &mut (usize, Vec<String>)) {
    match noise {
        Value::Number(noise) => {
            let [own, expected, scale] = [own, expected, scale].map(numbers);
            assert!(own.len() == expected.len() && own.len() == scale.len(), "{place}");
            found.0 += own.len();
            let errors = (0..own.len()).map(|i| (own[i] - expected[i]).abs() / scale[i]);
            if errors.fold(0.0, f64::max) >= 100.0 * noise.as_f64().unwrap() {
                found.1.push(place.to_owned());
            }
        }
        Value::Array(list) => {
            for (i, noise) in list.iter().enumerate() {
                compare(
                    &own[i],
                    [&expected[i], &scale[i], noise],
                    &format!("{place}[{i}]"),
                    found,
                );
            }
        }
        Value::Object(object) => {
            assert!(expected.as_object().unwrap().keys().eq(object.keys()), "{place}");
            for (key, noise) in object.iter().filter(|(key, _)| *key != "step") {
                let place = format!("{place}.{key}");
                compare(&own[key], [&expected[key], &scale[key], noise], &place, found);
            }
        }
        _ => panic!("{place}"),
    }
}

// How the files are read and spoilt

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn folder() -> PathBuf {
    root().join("fixtures/cases")
}

fn all() -> &'static [Case] {
    case::all().unwrap()
}

fn of(id: &str) -> &'static Case {
    all().iter().find(|case| case.problem.id == id).unwrap()
}

fn text_of(id: &str) -> String {
    of(id).problem_text.to_owned()
}

fn value_of(id: &str) -> Value {
    parsed(of(id).problem_text)
}

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

fn refusal(problem: &Value) -> Invalid {
    match ProblemFile::read(&problem.to_string()) {
        Err(invalid) => invalid,
        Ok(_) => panic!("was accepted: {problem}"),
    }
}

fn quantity(name: &str) -> Quantity {
    let mut all = Quantity::ALL.into_iter();
    all.find(|quantity| quantity.name() == name).unwrap()
}

fn object_at<'a>(value: &'a mut Value, pointer: &str) -> &'a mut serde_json::Map<String, Value> {
    value.pointer_mut(pointer).unwrap().as_object_mut().unwrap()
}

/// The places of all values inside of one, as JSON pointers.
fn pointers(value: &Value) -> Vec<String> {
    let inner: Vec<(String, &Value)> = match value {
        Value::Object(object) => object.iter().map(|(key, value)| (key.clone(), value)).collect(),
        Value::Array(list) => list
            .iter()
            .enumerate()
            .map(|(i, value)| (i.to_string(), value))
            .collect(),
        _ => Vec::new(),
    };
    let below = inner.iter().flat_map(|(key, value)| {
        let deeper = pointers(value).into_iter().map(move |rest| format!("/{key}{rest}"));
        std::iter::once(format!("/{key}")).chain(deeper)
    });
    below.collect()
}

/// A JSON pointer as refusals write it.
fn place_of(pointer: &str) -> String {
    pointer.split('/').skip(1).fold("problem".to_owned(), |place, key| {
        if key.parse::<usize>().is_ok() {
            format!("{place}[{key}]")
        } else {
            format!("{place}.{key}")
        }
    })
}

/// The numbers inside a value, in their order.
fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(list) => list.iter().flat_map(numbers).collect(),
        value => vec![value.as_f64().unwrap()],
    }
}

/// The numbers of a JSON text as they are written.
fn numbers_in(text: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some(at) = rest.find(|c: char| c == '"' || c == '-' || c.is_ascii_digit()) {
        rest = &rest[at..];
        let end = if rest.starts_with('"') {
            let mut escaped = false;
            let closing = rest.char_indices().skip(1).find(|(_, c)| {
                let is_end = *c == '"' && !escaped;
                escaped = *c == '\\' && !escaped;
                is_end
            });
            closing.unwrap().0 + 1
        } else {
            rest.find([',', ']', '}', ' ', '\n']).unwrap_or(rest.len())
        };
        if !rest.starts_with('"') {
            found.push(&rest[..end]);
        }
        rest = &rest[end..];
    }
    found
}

/// As much of JSON Schema as the schemas use; a word that is not known here fails.
fn against_schema(value: &Value, schema: &Value, root: &Value, place: &str) -> Result<(), String> {
    let wrong = |what: &str| Err(format!("{place}: {what}"));
    let empty = serde_json::Map::new();
    let object = value.as_object().unwrap_or(&empty);
    let number = value.as_f64();
    for (word, rule) in schema.as_object().unwrap() {
        let is_right = match word.as_str() {
            "$schema" | "title" | "description" | "format" | "$defs" => true,
            "$ref" => {
                let target = root.pointer(rule.as_str().unwrap().trim_start_matches('#')).unwrap();
                against_schema(value, target, root, place)?;
                true
            }
            "type" => is_of_type(value, rule),
            "const" => value == rule,
            "enum" => list(rule).contains(value),
            "minimum" => number.is_none_or(|number| number >= rule.as_f64().unwrap()),
            "exclusiveMinimum" => number.is_none_or(|number| number > rule.as_f64().unwrap()),
            "required" => !value.is_object() || list(rule).iter().all(|key| object.contains_key(key.as_str().unwrap())),
            "minLength" => value
                .as_str()
                .is_none_or(|text| text.chars().count() as u64 >= rule.as_u64().unwrap()),
            "maxLength" => value
                .as_str()
                .is_none_or(|text| text.chars().count() as u64 <= rule.as_u64().unwrap()),
            "prefixItems" => {
                for (i, (item, rule)) in value.as_array().into_iter().flatten().zip(list(rule)).enumerate() {
                    against_schema(item, rule, root, &format!("{place}[{i}]"))?;
                }
                true
            }
            "minItems" => value
                .as_array()
                .is_none_or(|items| items.len() as u64 >= rule.as_u64().unwrap()),
            "maxItems" => value
                .as_array()
                .is_none_or(|items| items.len() as u64 <= rule.as_u64().unwrap()),
            "items" => {
                for (i, item) in value.as_array().into_iter().flatten().enumerate() {
                    against_schema(item, rule, root, &format!("{place}[{i}]"))?;
                }
                true
            }
            "properties" => {
                for (key, rule) in rule.as_object().unwrap() {
                    if let Some(inner) = object.get(key) {
                        against_schema(inner, rule, root, &format!("{place}.{key}"))?;
                    }
                }
                true
            }
            "additionalProperties" if *rule == json!(false) => {
                object.keys().all(|key| schema["properties"].get(key).is_some())
            }
            "additionalProperties" => {
                for inner in object
                    .iter()
                    .filter(|(key, _)| schema["properties"].get(key.as_str()).is_none())
                {
                    against_schema(inner.1, rule, root, &format!("{place}.{}", inner.0))?;
                }
                true
            }
            "oneOf" | "anyOf" => {
                let fitting = list(rule)
                    .iter()
                    .filter(|rule| against_schema(value, rule, root, place).is_ok());
                if word == "oneOf" {
                    fitting.count() == 1
                } else {
                    fitting.count() > 0
                }
            }
            "allOf" => {
                for rule in list(rule) {
                    against_schema(value, rule, root, place)?;
                }
                true
            }
            unknown => panic!("{place}: `{unknown}` is not known here"),
        };
        if !is_right {
            return wrong(word);
        }
    }
    Ok(())
}

fn is_of_type(value: &Value, rule: &Value) -> bool {
    if let Value::Array(rules) = rule {
        return rules.iter().any(|rule| is_of_type(value, rule));
    }
    match rule.as_str().unwrap() {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_i64() || value.is_u64(),
        "null" => value.is_null(),
        other => panic!("type {other}"),
    }
}

fn list(value: &Value) -> &Vec<Value> {
    value.as_array().unwrap()
}
