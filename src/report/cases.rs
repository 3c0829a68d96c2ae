//! The published cases for people.
//!
//! Cases are listed, shown, and reported after they have been proven again.

use super::{never_broken, table, wrapped};
use crate::oracle::case::{BadCase, Case};
use crate::oracle::certify::Certified;
use crate::oracle::flags::FLAGS;
use crate::oracle::trace::Dimensions;
use comfy_table::CellAlignment;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::time::Duration;

/// One line per case, then the filters and the flags.
pub fn list(cases: &[&Case]) -> String {
    let mut table = table(&["case", "n", "m", "modes", "steps", "filter", "flags"]);
    for column in table.column_iter_mut().skip(5) {
        column.set_cell_alignment(CellAlignment::Left);
    }
    never_broken(&mut table, 0);
    for case in cases {
        let problem = &case.problem;
        let Dimensions { n, r, m } = problem.dimensions();
        let (steps, m) = (m.len(), problem.noise.len());
        table.add_row(vec![
            problem.id.clone(),
            n.to_string(),
            m.to_string(),
            r.to_string(),
            steps.to_string(),
            problem.kinds().join(" + "),
            problem.flags.join(" "),
        ]);
    }
    let filters: BTreeSet<&str> = cases.iter().flat_map(|case| case.problem.kinds()).collect();
    let filters = filters.into_iter().collect::<Vec<&str>>().join(", ");
    let mut text = format!(
        "{table}\n{} cases. The filters:\n{}",
        cases.len(),
        wrapped(&filters, "  ")
    );
    text.push_str("The flags:\n");
    for (flag, meaning) in FLAGS {
        if cases
            .iter()
            .any(|case| case.problem.flags.iter().any(|own| own == flag))
        {
            text.push_str(&wrapped(&format!("{flag}: {meaning}"), "  "));
        }
    }
    text
}

/// A case in full.
pub fn show(case: &Case) -> String {
    let mut text = format!("{}\n", case.problem.id);
    text.push_str(&wrapped(&case.problem.about, "  "));
    let _ = write!(text, "\n{}\n{}", case.problem_text, case.trace_text);
    text
}

/// A case that was verified, with the result and the time it took.
pub type Verified<'a> = (&'a &'a Case, Result<Option<Certified>, BadCase>, Duration);

/// The result of proving cases again.
pub fn verified(outcomes: &[Verified]) -> String {
    let mut table = table(&["case", "steps", "values", "bits", "digits left", "time (s)"]);
    let mut wrong = String::new();
    let (mut values, mut good, mut rejected) = (0, 0, 0);
    for (case, outcome, time) in outcomes {
        let id = case.problem.id.clone();
        let seconds = format!("{:.2}", time.as_secs_f64());
        match outcome {
            Ok(Some(certified)) => {
                good += 1;
                let count: usize = numbers(certified);
                values += count;
                let (steps, bits) = (case.problem.measurements.len(), certified.bits);
                table.add_row(vec![
                    id,
                    steps.to_string(),
                    count.to_string(),
                    bits.to_string(),
                    certified.digits.to_string(),
                    seconds,
                ]);
            }
            Ok(None) => {
                good += 1;
                rejected += 1;
            }
            Err(bad) => wrong.push_str(&wrapped(&format!("WRONG: {bad}"), "")),
        }
    }
    format!(
        "{table}\n{wrong}{good} of {} cases proven again: {values} numbers, each the double nearest to the exact value; \
         rejected, as they must be: {rejected}\n",
        outcomes.len()
    )
}

fn numbers(certified: &Certified) -> usize {
    certified
        .trace
        .all_places()
        .filter_map(|(step, quantity, mode)| certified.trace.get(step, quantity, mode))
        .map(Vec::len)
        .sum()
}

/// The same as JSON.
pub fn verified_json(outcomes: &[Verified]) -> Value {
    let cases: Vec<Value> = outcomes
        .iter()
        .map(|(case, outcome, time)| {
            let certified = outcome.as_ref().ok().and_then(Option::as_ref);
            json!({
                "id": case.problem.id,
                "proven": outcome.is_ok(),
                "wrong": outcome.as_ref().err().map(ToString::to_string),
                "steps": case.problem.measurements.len(),
                "values": certified.map(numbers),
                "bits": certified.map(|certified| certified.bits),
                "digits_left": certified.map(|certified| certified.digits),
                "seconds": time.as_secs_f64(),
            })
        })
        .collect();
    json!({ "cases": cases })
}
