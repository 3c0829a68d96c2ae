//! Observations about the answers as a whole, as sentences and as JSON.

use super::check::number;
use super::wrapped;
use crate::imm::Quantity;
use crate::oracle::observation::{Discrepancy, Observation, SingleInput};
use crate::oracle::run::Triangle;
use serde_json::{Value, json};

/// A heading and a sentence for each.
pub(super) fn observations(observations: &[Observation]) -> String {
    let one = |observation: &Observation| format!("\nNOTICE\n{}", wrapped(&sentence(observation), "  "));
    observations.iter().map(one).collect()
}

/// One sentence for each observation that alone makes a verdict wrong.
pub(super) fn sentences(observations: &[Observation]) -> Vec<String> {
    let wrong = observations.iter().filter(|observation| observation.is_wrong());
    wrong.map(sentence).collect()
}

/// A sentence.
pub(super) fn sentence(observation: &Observation) -> String {
    match observation {
        Observation::AnswersDiffer {
            id,
            difference,
            is_rounding,
        } => differ(id, difference.as_ref(), *is_rounding),
        Observation::RightAlone { ids } => format!(
            "{}: right when asked alone, in a new process: something is kept between problems, or chance decides.",
            ids.join(", ")
        ),
        Observation::FewDigits { digits } => few_digits(*digits),
        Observation::FewDecimals { decimals } => format!(
            "No shown number has more than {decimals} digits after the decimal point, whatever its size. Print 17 significant digits \
             (`%.17g`)."
        ),
        Observation::SinglePrecision => {
            "Every shown number has only single precision, but the program declared a higher one. Compute and \
             print in double precision, or declare `\"precision\": \"single\"`."
                .to_owned()
        }
        Observation::SingleInput { input } => rounded(*input),
        Observation::StepsAlike { id, step } => {
            let of_step = step.map_or_else(
                || "the same values".to_owned(),
                |step| format!("the values of step {step}"),
            );
            format!(
                "{id}: all steps show {of_step}. Does the program list one record several times and overwrite it in every step?"
            )
        }
        Observation::SymmetryLost {
            ids,
            covariance: (quantity, mode),
            first,
            most,
        } => symmetry(ids, (*quantity, *mode), *first, *most),
        Observation::OneTriangle { triangle, quantities } => {
            let names: Vec<&str> = quantities.iter().map(|quantity| quantity.name()).collect();
            let shown = match triangle {
                Triangle::Upper => "upper",
                Triangle::Lower => "lower",
            };
            format!(
                "Only the {shown} triangle of {} is shown; the other one is zero. Show both triangles of a covariance.",
                names.join(", ")
            )
        }
        Observation::ShownAs { quantity, way } => {
            format!("{} is right, but shown as {way}.", quantity.name())
        }
    }
}

/// An answer that is not the same again.
fn differ(id: &str, difference: Option<&Discrepancy>, is_rounding: bool) -> String {
    let what = difference.map_or_else(|| "without values".to_owned(), in_words);
    let cause = if is_rounding {
        "Both are right: only their rounding differs, as in sums whose order varies."
    } else {
        "It depends on chance (uninitialised memory, random numbers, threads), or something is kept between problems."
    };
    format!("{id} answers differently when asked again, in the same process: {what}. {cause}")
}

/// Input that lost digits.
fn rounded(input: SingleInput) -> String {
    let what = match input {
        SingleInput::Estimates => "The initial estimates were",
        SingleInput::Everything => "The input was",
    };
    format!("{what} rounded to single precision before anything was computed. This explains every shown value.")
}

/// Numbers that are printed short.
fn few_digits(digits: usize) -> String {
    let single = if digits > 6 {
        " If it computes in single precision, declare `\"precision\": \"single\"`."
    } else {
        ""
    };
    format!(
        "No shown number has more than {digits} significant digits. Print 17 digits, or declare \
         `\"precision\": {{\"decimal_digits\": {digits}}}`.{single}"
    )
}

/// How a covariance loses its symmetry.
fn symmetry(ids: &[String], covariance: (Quantity, usize), first: (usize, f64), most: (usize, f64)) -> String {
    let (quantity, mode) = covariance;
    let of_mode = if quantity.is_of_mode() {
        format!("modes[{mode}].")
    } else {
        String::new()
    };
    let others = match ids.len() - 1 {
        0 => String::new(),
        1 => "; the same in one other case".to_owned(),
        others => format!("; the same in {others} other cases"),
    };
    format!(
        "{}: P loses its symmetry, and rounding grows: max |P − Pᵀ| of {of_mode}{} is {:.0e} √(Pᵢᵢ Pⱼⱼ) at step {} and {:.0e} at step \
         {}{others}. Make P symmetric after every update, ½(P + Pᵀ), or use a symmetric form: P⁻ − K S Kᵀ.",
        ids[0],
        quantity.name(),
        first.1,
        first.0,
        most.1,
        most.0,
    )
}

/// Where two answers differ.
fn in_words(difference: &Discrepancy) -> String {
    let (step, quantity, mode) = difference.place;
    let of_mode = if quantity.is_of_mode() {
        format!("modes[{mode}].")
    } else {
        String::new()
    };
    let shown = |value: Option<f64>| value.map_or_else(|| "not shown".to_owned(), number);
    format!(
        "step {step}, {of_mode}{}, number {} by rows, was {} and is now {}",
        quantity.name(),
        difference.index + 1,
        shown(difference.first),
        shown(difference.again),
    )
}

/// For programs.
pub(super) fn json(observations: &[Observation]) -> Vec<Value> {
    let one = |observation: &Observation| {
        let mut value = fields(observation);
        value["wrong"] = json!(observation.is_wrong());
        value["sentence"] = json!(sentence(observation));
        value
    };
    observations.iter().map(one).collect()
}

/// What is seen, and its numbers.
fn fields(observation: &Observation) -> Value {
    match observation {
        Observation::AnswersDiffer {
            id,
            difference,
            is_rounding,
        } => json!({
            "seen": "answers differ",
            "ids": [id],
            "is_rounding": is_rounding,
            "difference": difference.as_ref().map(|difference| json!({
                "step": difference.place.0,
                "quantity": difference.place.1.name(),
                "mode": difference.place.1.is_of_mode().then_some(difference.place.2),
                "entry": difference.index,
                "first": difference.first,
                "again": difference.again,
            })),
        }),
        Observation::RightAlone { ids } => json!({ "seen": "right alone", "ids": ids }),
        Observation::FewDigits { digits } => json!({ "seen": "few digits", "digits": digits }),
        Observation::FewDecimals { decimals } => json!({ "seen": "few decimals", "digits": decimals }),
        Observation::SinglePrecision => json!({ "seen": "single precision" }),
        Observation::SingleInput { input } => {
            json!({ "seen": "input in single precision", "estimates_alone": *input == SingleInput::Estimates })
        }
        Observation::StepsAlike { id, step } => json!({ "seen": "steps alike", "ids": [id], "step": step }),
        Observation::SymmetryLost {
            ids,
            covariance: (quantity, mode),
            first,
            most,
        } => {
            let asymmetry = [first, most].map(|(step, size)| json!({ "step": step, "in_units": size }));
            json!({
                "seen": "symmetry lost",
                "ids": ids,
                "quantities": [quantity.name()],
                "mode": quantity.is_of_mode().then_some(mode),
                "asymmetry": asymmetry,
            })
        }
        Observation::OneTriangle { triangle, quantities } => json!({
            "seen": "one triangle",
            "quantities": quantities.iter().map(|quantity| quantity.name()).collect::<Vec<_>>(),
            "shown": if *triangle == Triangle::Upper { "upper" } else { "lower" },
        }),
        Observation::ShownAs { quantity, way } => {
            json!({ "seen": "shown as something else", "quantities": [quantity.name()], "as": way })
        }
    }
}
