//! The result of a search, for people and as JSON.
//!
//! A search ends in one of two ways: it finds nothing and lists what was judged, or it finds a smallest problem and shows its verdict.

use super::{check, check_json, wrapped};
use crate::oracle::search::{Found, Searched, count, in_words};
use serde_json::{Value, json};
use std::fmt::Write;

/// The whole report; `again` is the command that checks what was found again.
pub fn text(searched: &Searched, again: &str) -> String {
    let mut text = match &searched.found {
        Some(found) => found_text(searched, found, again),
        None => nothing(searched),
    };
    if searched.is_echo_wrong() {
        text.push_str(
            "ECHO WRONG: the product of matrix and vector is wrong. Does the program read matrices by columns?\n",
        );
    }
    text
}

fn found_text(searched: &Searched, found: &Found, again: &str) -> String {
    let mut text = wrapped(
        &format!(
            "FOUND: {}, in problem {} of seed {}, after {} and {:.1} s.",
            found.failure.words(),
            found.number,
            searched.seed,
            count(searched.problems, "problem"),
            searched.time.as_secs_f64(),
        ),
        "",
    );
    text.push_str(&wrapped(&shrunk(found), "  "));
    let _ = write!(text, "\n{}", check::text(&found.report));
    if found.report_as_drawn.diagnosis != found.report.diagnosis {
        let cause = check::diagnosis(&found.report_as_drawn.diagnosis);
        let _ = write!(text, "\nAS IT WAS DRAWN the problem gives this cause:\n{cause}");
    }
    let _ = write!(text, "\nSEE IT AGAIN\n  {again}\n");
    text
}

/// How far the problem was shrunk, or why it was not.
fn shrunk(found: &Found) -> String {
    let (before, after) = (in_words(&found.drawn), in_words(&found.problem));
    if !found.report.is_wrong() {
        return "The program does not fail if it is asked this problem alone: its answers depend on earlier problems. The problem is written as it \
                was drawn."
            .into();
    }
    let end = match found.shrinking.cut_short {
        Some(what) => format!("shrinking ended early, its {what} used up: perhaps more could be removed"),
        None => "nothing more can be removed".to_owned(),
    };
    format!("From {before} to {after} in {} tries; {end}.", found.shrinking.tries)
}

/// What was judged if nothing was found.
fn nothing(searched: &Searched) -> String {
    if searched.problems == 0 {
        return wrapped(
            &format!(
                "NOTHING JUDGED: {} problems were skipped, {} drowned in rounding noise, {} draws could not be certified; seed {}.",
                searched.skipped + searched.not_asked,
                searched.cannot_tell,
                searched.dropped,
                searched.seed
            ),
            "",
        );
    }
    let counts = |names: Vec<(&str, usize)>| -> String {
        let each: Vec<String> = names
            .into_iter()
            .map(|(name, count)| format!("{name} {count}"))
            .collect();
        each.join(", ")
    };
    let kinds = counts(
        searched
            .kinds
            .iter()
            .map(|(kind, count)| (kind.as_str(), *count))
            .collect(),
    );
    let behaviours = searched
        .behaviours
        .iter()
        .map(|(behaviour, count)| (behaviour.name(), *count));
    let mut text = wrapped(
        &format!(
            "FOUND NOTHING: {}, {} of filter, {} in {:.0} s; seed {}.",
            count(searched.problems, "problem"),
            count(searched.kinds.len(), "kind"),
            count(searched.values, "value"),
            searched.time.as_secs_f64(),
            searched.seed
        ),
        "",
    );
    text.push_str(&wrapped(&format!("Kinds of filter: {kinds}."), "  "));
    text.push_str(&wrapped(
        &format!("Situations: {}.", counts(behaviours.collect())),
        "  ",
    ));
    text.push_str(&wrapped(&left_out(searched), "  "));
    for variant in &searched.otherwise {
        let sentence = format!(
            "The answers follow, and were judged by: {}  ({}; {})",
            variant.about,
            variant.id,
            variant.kind.name()
        );
        text.push_str(&wrapped(&sentence, "  "));
    }
    text
}

fn left_out(searched: &Searched) -> String {
    let parts = [
        (searched.skipped, "skipped by the program"),
        (searched.not_asked, "not asked, because it had skipped similar ones"),
        (searched.cannot_tell, "drowned in rounding noise"),
        (
            searched.dropped,
            "drawn and dropped as not certified or nearly singular",
        ),
    ];
    let said: Vec<String> = parts
        .into_iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, what)| format!("{count} {what}"))
        .collect();
    if said.is_empty() {
        "Every drawn problem was judged.".into()
    } else {
        format!("Not judged: {}.", said.join(", "))
    }
}

/// The report as JSON.
pub fn json(searched: &Searched, again: &str) -> Value {
    let behaviours = searched
        .behaviours
        .iter()
        .map(|(behaviour, count)| (behaviour.name(), *count));
    let otherwise: Vec<&str> = searched.otherwise.iter().map(|variant| variant.id.as_str()).collect();
    json!({
        "format": "immaculate-search/1",
        "name": searched.ready.name,
        "seed": searched.seed,
        "wrong": searched.is_wrong(),
        "echo": searched.ready.echo.as_ref().map(|_| !searched.is_echo_wrong()),
        "problems": searched.problems,
        "values": searched.values,
        "kinds": searched.kinds,
        "behaviours": behaviours.collect::<std::collections::BTreeMap<_, _>>(),
        "skipped": searched.skipped,
        "not_asked": searched.not_asked,
        "cannot_tell": searched.cannot_tell,
        "dropped": searched.dropped,
        "otherwise": otherwise,
        "seconds": searched.time.as_secs_f64(),
        "found": searched.found.as_ref().map(|found| json!({
            "number": found.number,
            "failure": found.failure.words(),
            "tries": found.shrinking.tries,
            "cut_short": found.shrinking.cut_short,
            "problem": found.problem,
            "report": check_json::json(&found.report),
            "diagnosis_as_drawn": check_json::diagnosis_json(&found.report_as_drawn.diagnosis),
            "again": again,
        })),
    })
}
