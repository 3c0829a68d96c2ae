//! The short way to write a problem of one filter: without anything that speaks of modes.
//!
//! ```text
//! F, f or motion, and Q, at the top   ─▶  modes: [ { … } ],  transition: [[1]]
//! initial: { mean, covariance }       ─▶  initial: { mode_probabilities: [1],  modes: [ { mean, covariance } ] }
//! ```
//!
//! What is sent to programs is always the long form.

use super::invalid::Invalid;
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::{Map, Value, json};

/// The keys of a mode that stand at the top of a short problem.
pub(super) const KEYS: [&str; 5] = ["F", "f", "motion", "Q", "M"];

/// What tells a short problem from a long one.
#[derive(Deserialize)]
struct Shape {
    format: String,
    #[serde(rename = "F")]
    matrix: Option<IgnoredAny>,
    #[serde(rename = "f")]
    formulas: Option<IgnoredAny>,
    motion: Option<IgnoredAny>,
    #[serde(rename = "Q")]
    noise: Option<IgnoredAny>,
    modes: Option<IgnoredAny>,
    transition: Option<IgnoredAny>,
}

/// The long form of a short problem of format 2; `None` for any other text.
pub(super) fn long_form(text: &str) -> Option<Value> {
    let shape: Shape = serde_json::from_str(text).ok()?;
    let has_motion = shape.matrix.is_some() || shape.formulas.is_some() || shape.motion.is_some();
    let speaks_of_modes = shape.modes.is_some() || shape.transition.is_some();
    let is_short = (has_motion || shape.noise.is_some()) && !speaks_of_modes;
    if shape.format != super::problem::FORMAT_2 || !is_short {
        return None;
    }
    let Value::Object(mut file) = serde_json::from_str(text).ok()? else {
        return None;
    };
    let mut mode = Map::new();
    mode.insert("name".into(), json!("filter"));
    for key in KEYS {
        if let Some(value) = file.shift_remove(key) {
            mode.insert(key.into(), value);
        }
    }
    file.insert("modes".into(), json!([mode]));
    file.insert("transition".into(), json!([[1.0]]));
    if let Some(estimate) = file.get_mut("initial").filter(|initial| initial.get("modes").is_none()) {
        *estimate = json!({ "mode_probabilities": [1.0], "modes": [estimate.take()] });
    }
    Some(Value::Object(file))
}

/// A sentence about the long form as one about the short form.
pub(super) fn of_short_form(invalid: Invalid) -> Invalid {
    let place = invalid
        .place
        .replace("problem.modes[0].", "problem.")
        .replace("problem.modes[0]", "problem")
        .replace("problem.initial.modes[0]", "problem.initial");
    Invalid { place, ..invalid }
}
