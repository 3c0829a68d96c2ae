//! Errors in a problem file with wrong JSON or wrong keys, with their place.
//!
//! An error of the JSON reader becomes a sentence with the place inside the file. The reader of objects that have a `kind` must know the
//! kind before it can read the rest, and loses the places on the way; they are recovered here.

use super::invalid::{Class, Invalid};
use super::json::quote_not_finite;
use super::models::{ComponentFile, ModelParameters};
use super::problem::{FORMAT, FixedGainFile, ProblemFile, Rows};
use super::schema::KEYS_OF_FORMAT_1;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::num::NonZeroUsize;

/// Reads a value for nothing but its error: the place inside the value, and the sentence.
type Attempt = fn(&Value) -> Result<(), (String, String)>;

/// A kind with its keys.
type Kind = (&'static str, &'static [(&'static str, Attempt)]);

/// The objects of a problem that have a `kind`, with their kinds.
const OBJECTS: [(&str, &[Kind]); 2] = [
    (
        "measurement",
        &[
            ("linear", &[("H", attempt::<Rows>)]),
            (
                "range-bearing",
                &[
                    ("components", attempt::<Vec<String>>),
                    ("position", attempt::<[usize; 2]>),
                    ("sensor", attempt::<[f64; 2]>),
                ],
            ),
            (
                "formulas",
                &[("z", attempt::<Vec<ComponentFile>>), ("h", attempt::<Vec<String>>)],
            ),
            (
                "model",
                &[("model", attempt::<String>), ("parameters", attempt::<ModelParameters>)],
            ),
        ],
    ),
    (
        "filter",
        &[
            ("kalman", &[]),
            ("extended", &[("iterations", attempt::<NonZeroUsize>)]),
            ("cubature", &[("rule", attempt::<String>)]),
            (
                "unscented",
                &[
                    ("alpha", attempt::<f64>),
                    ("beta", attempt::<f64>),
                    ("kappa", attempt::<f64>),
                ],
            ),
            ("converted", &[("conversion", attempt::<String>)]),
            (
                "fixed-gain",
                &[("mixing", attempt::<String>), ("modes", attempt::<Vec<FixedGainFile>>)],
            ),
        ],
    ),
];

/// The keys that may be absent.
const OPTIONAL: [&str; 2] = ["parameters", "iterations"];

fn attempt<T: DeserializeOwned>(value: &Value) -> Result<(), (String, String)> {
    serde_path_to_error::deserialize::<_, T>(value)
        .map(drop)
        .map_err(|error| (error.path().to_string(), error.inner().to_string()))
}

/// The reason why a problem cannot be read, from the place and the sentence of the JSON reader.
pub(super) fn reason(text: &str, place: &str, sentence: &str) -> Invalid {
    let place = joined("problem", place);
    let object = place.strip_suffix(".kind").unwrap_or(&place);
    for (key, kinds) in OBJECTS {
        if object.ends_with(&format!(".{key}"))
            && let Some(invalid) = inside(text, object, kinds)
        {
            return invalid;
        }
    }
    let is_no_number = ["expected value", "invalid number"]
        .iter()
        .any(|start| sentence.starts_with(start));
    if is_no_number && quote_not_finite(text) != text {
        let reason = format!("{sentence}: NaN and infinities are no JSON; a missing measurement is null");
        return Invalid::new(Class::Format, place, reason);
    }
    let missing = if place == "problem" { missing(text) } else { Vec::new() };
    if missing.len() > 1 && sentence.starts_with("missing field") {
        let reason = format!("lacks the keys {}", missing.join(", "));
        return Invalid::new(Class::Format, place, reason);
    }
    at(place, sentence)
}

/// The keys that a problem must have and has not.
fn missing(text: &str) -> Vec<String> {
    let file: Value = serde_json::from_str(text).unwrap_or_default();
    let of_format_1: &[&str] = if file["format"] == FORMAT {
        &KEYS_OF_FORMAT_1
    } else {
        &[]
    };
    let schema = json!(schemars::schema_for!(ProblemFile));
    let required = schema["required"].as_array().into_iter().flatten();
    let required = required.filter_map(Value::as_str).chain(of_format_1.iter().copied());
    let missing = required.filter(|key| file.get(key).is_none());
    let mut missing: Vec<String> = missing.map(|key| format!("`{key}`")).collect();
    // A chain may be said otherwise; where it is not said at all, it has its place before the estimates.
    let is_said = ["transition", "rates", "sojourn_times", "jumps"]
        .iter()
        .any(|key| file.get(key).is_some());
    if !is_said {
        let later = ["`initial`", "`measurements`"];
        let place = missing.iter().position(|key| later.contains(&key.as_str()));
        missing.insert(place.unwrap_or(missing.len()), "`transition`".to_owned());
    }
    missing
}

/// What a sentence of the JSON reader says of a place.
fn at(place: String, sentence: &str) -> Invalid {
    let missing = sentence.strip_prefix("missing field `");
    match missing.and_then(|rest| rest.split_once('`')) {
        Some((field, _)) => Invalid::new(Class::Format, format!("{place}.{field}"), "is missing"),
        None => Invalid::new(class_of(sentence), place, sentence),
    }
}

/// The class of a sentence of the JSON reader.
fn class_of(sentence: &str) -> Class {
    if sentence.starts_with("number out of range") {
        Class::NotFinite
    } else if sentence.starts_with("invalid length") {
        Class::Shape
    } else {
        Class::Format
    }
}

/// A place inside another; the JSON reader writes a dot for the whole.
fn joined(outer: &str, inner: &str) -> String {
    // A question mark stands for a key that was not read to its end.
    match inner.trim_end_matches(".?") {
        "." | "?" => outer.to_owned(),
        inner if inner.starts_with('[') => format!("{outer}{inner}"),
        inner => format!("{outer}.{inner}"),
    }
}

/// The value at a place of a file, such as `problem.sensors[0].measurement`.
pub(super) fn value_at<'a>(file: &'a Value, place: &str) -> Option<&'a Value> {
    let pointer = place.strip_prefix("problem")?.replace(['.', '['], "/").replace(']', "");
    file.pointer(&pointer)
}

/// What is wrong inside an object that has a kind, if the rest of the file is JSON.
fn inside(text: &str, place: &str, kinds: &[Kind]) -> Option<Invalid> {
    let file: Value = serde_json::from_str(text).ok()?;
    let wrong = |class, inner: &str, reason: String| Some(Invalid::new(class, joined(place, inner), reason));
    let Some(object) = value_at(&file, place)?.as_object() else {
        return wrong(Class::Format, ".", "is not an object".into());
    };
    let Some(name) = object.get("kind") else {
        return wrong(Class::Format, "kind", "is missing".into());
    };
    let Some((_, keys)) = kinds.iter().find(|(kind, _)| name == kind) else {
        let known: Vec<&str> = kinds.iter().map(|(kind, _)| *kind).collect();
        return wrong(
            Class::Unknown,
            "kind",
            format!("is {name}; known are {}", known.join(", ")),
        );
    };
    let is_known = |key: &str| key == "kind" || keys.iter().any(|(known, _)| *known == key);
    if let Some(stranger) = object.keys().find(|key| !is_known(key)) {
        return wrong(Class::Format, stranger, format!("is not a key beside the kind {name}"));
    }
    for (key, attempt) in *keys {
        let Some(value) = object.get(*key) else {
            if OPTIONAL.contains(key) {
                continue;
            }
            return wrong(Class::Format, key, "is missing".into());
        };
        if let Err((inner, sentence)) = attempt(value) {
            return Some(at(joined(place, &joined(key, &inner)), &sentence));
        }
    }
    None
}
