//! Input that was rounded to single precision before anything was computed from it.
//!
//! The equations are right, and on the rounded input they explain every value in double precision.

use super::evidence::{Answered, passed};
use super::invalid::Invalid;
use super::judge::Case;
use super::observation::{Observation, SingleInput};
use super::problem::ProblemFile;
use super::subject::Precision;
use super::verdict::{CaseReport, Outcome};
use serde_json::{Value, json};

impl SingleInput {
    /// The keys of a problem whose numbers are rounded.
    fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Estimates => &["mean", "covariance"],
            Self::Everything => &[
                "F",
                "Q",
                "H",
                "R",
                "z",
                "transition",
                "rates",
                "sojourn_times",
                "jumps",
                "mean",
                "covariance",
                "mode_probabilities",
            ],
        }
    }
}

/// Which input was rounded, if that explains every answer, the right ones, too.
pub(super) fn found(
    answered: &[Answered],
    cases: &[CaseReport],
    precision: Precision,
    conventions: &[&str],
) -> Result<Option<Observation>, Invalid> {
    // What is wrong is asked first: almost everything fails there.
    let is_wrong = |of: &&Answered| cases[of.index].outcome == Outcome::Wrong;
    let (wrong, others): (Vec<&Answered>, Vec<&Answered>) = answered.iter().partition(is_wrong);
    if wrong.is_empty() {
        return Ok(None);
    }
    'inputs: for input in [SingleInput::Estimates, SingleInput::Everything] {
        for of in wrong.iter().chain(&others) {
            let Some(problem) = rounded(of.problem, input) else {
                continue 'inputs;
            };
            let case = Case {
                problem: &problem,
                shown: &of.shown,
                reference: &of.reference,
                precision,
            };
            if !case.is_explained_by(conventions, &passed(&cases[of.index]))? {
                continue 'inputs;
            }
        }
        return Ok(Some(Observation::SingleInput { input }));
    }
    Ok(None)
}

/// A problem whose numbers are read in single precision.
fn rounded(problem: &ProblemFile, input: SingleInput) -> Option<ProblemFile> {
    let mut file = json!(problem);
    round_under(&mut file, input.keys());
    serde_json::from_value(file).ok()
}

/// Rounds what stands under these keys, wherever they are.
fn round_under(value: &mut Value, keys: &[&str]) {
    match value {
        Value::Object(object) => {
            for (key, value) in object {
                if keys.contains(&key.as_str()) {
                    round(value);
                } else {
                    round_under(value, keys);
                }
            }
        }
        Value::Array(list) => list.iter_mut().for_each(|value| round_under(value, keys)),
        _ => {}
    }
}

/// Rounds all numbers of a value.
fn round(value: &mut Value) {
    match value {
        Value::Number(number) => {
            #[allow(clippy::cast_possible_truncation, reason = "rounding is what is asked for")]
            let single = number.as_f64().map(|number| f64::from(number as f32));
            if let Some(rounded) = single.and_then(serde_json::Number::from_f64) {
                *number = rounded;
            }
        }
        Value::Array(list) => list.iter_mut().for_each(round),
        Value::Object(object) => object.values_mut().for_each(round),
        _ => {}
    }
}
