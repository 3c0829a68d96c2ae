//! The wrong formulas that a program computed, for people and as JSON.

use super::wrapped;
use crate::oracle::formula::{ComputedFormula, ComputedFormulas, Explanation, short};
use serde_json::{Value, json};
use std::fmt::Write;

pub(super) fn text(formulas: &ComputedFormulas) -> String {
    formulas.found.iter().map(one).collect()
}

/// A paragraph: where, what was computed, and what should have been.
fn one(found: &ComputedFormula) -> String {
    let mut text = format!("\nCOMPUTED  {}, {}", found.quantity.name(), found.filters.join(", "));
    if let Some(condition) = &found.condition {
        let _ = write!(text, ", {condition}");
    }
    text.push('\n');
    text.push_str(&wrapped(&found.computed, "    "));
    let _ = writeln!(
        text,
        "  gives the shown value in {} of {} faulty values, and should be",
        found.explains, found.of
    );
    text.push_str(&wrapped(&found.right, "    "));
    text
}

pub(super) fn json(formulas: &ComputedFormulas) -> Value {
    let of_one = |found: &ComputedFormula| {
        json!({
            "quantity": found.quantity.name(),
            "filters": found.filters,
            "computed": found.computed,
            "right": found.right,
            "explains": found.explains,
            "faulty": found.of,
            "condition": found.condition,
        })
    };
    json!({ "found": formulas.found.iter().map(of_one).collect::<Vec<_>>(), "complete": formulas.is_complete })
}

/// The equation, the equation in numbers, and the wrong term if there is one.
pub(super) fn explained(explanation: &Explanation) -> String {
    in_numbers(explanation)
        .iter()
        .map(|line| wrapped(line, "    "))
        .collect()
}

/// The same as two lines: the sum, and the value shown instead.
pub(super) fn in_numbers(explanation: &Explanation) -> [String; 2] {
    let Explanation {
        equation,
        numbers,
        gives,
        shown,
        term,
    } = explanation;
    let difference = short(shown - gives);
    let what = term.as_ref().map_or_else(String::new, |term| format!(": {term}"));
    let sum = if *numbers == short(*gives) {
        numbers.clone()
    } else {
        format!("{numbers} = {}", short(*gives))
    };
    [
        format!("{equation} = {sum}"),
        format!("yours {}, the difference {difference}{what}", short(*shown)),
    ]
}
