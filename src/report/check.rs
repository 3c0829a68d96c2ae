//! The verdict on a program under test, as text.
//!
//! A verdict lists the cases, the faults by equation and their causes, and ends with one sentence that sums it up.

use super::behaviour::behaviours;
use super::fault::faulty_equations;
use super::formula;
use super::observation::observations;
use super::{table, verdict, wrapped};
use crate::oracle::check::{CaseReport, Outcome, Report};
use crate::oracle::diagnose::{Diagnosis, Share};
use crate::oracle::formula::ComputedFormulas;
use crate::oracle::subject::Broken;
use crate::oracle::variant::{Kind, Variant};
use std::fmt::Write;

/// The whole report.
pub fn text(report: &Report) -> String {
    let mut text = cases(report);
    text.push_str(&observations(&report.observations));
    text.push_str(&faults(report));
    text.push_str(&failures(report));
    text.push_str(&diagnosis(&report.diagnosis));
    for remark in &report.remarks {
        let _ = write!(text, "\nREMARK\n{}", wrapped(remark, "  "));
    }
    text.push_str(&behaviours(report));
    text.push_str(&coverage(report));
    text.push_str(&summary(report));
    text
}

/// What a case's outcome is called.
pub(super) fn words(outcome: &Outcome) -> &'static str {
    match outcome {
        Outcome::Right => "right",
        Outcome::Wrong => "WRONG",
        Outcome::CannotTell => "cannot tell",
        Outcome::Rejected { .. } => "rejected, as it must be",
        Outcome::NotRejected => "NOT REJECTED",
        Outcome::WronglyRejected { .. } => "REJECTED",
        Outcome::Skipped { .. } => "skipped",
        Outcome::NothingShown => "NOTHING SHOWN",
        Outcome::Stopped { .. } => "STOPPED",
        Outcome::Broken(Broken::Invalid(_) | Broken::Garbage { .. }) => "UNREADABLE",
        Outcome::Broken(_) => "NO ANSWER",
    }
}

/// The reason for an outcome.
pub(super) fn reason(case: &CaseReport) -> Option<String> {
    match &case.outcome {
        Outcome::Rejected {
            other_class: Some(class),
        } => Some(format!("for another reason: {class:?}")),
        Outcome::WronglyRejected { reason } | Outcome::Skipped { reason } | Outcome::Stopped { reason } => {
            Some(reason.clone())
        }
        Outcome::Broken(broken) => Some(broken.to_string()),
        Outcome::Wrong => Some(format!(
            "the program stopped before the end: {}",
            case.stopped.as_ref()?
        )),
        Outcome::NotRejected => Some("the problem is invalid, but the program ran it".into()),
        _ => None,
    }
}

/// One line per case: how much was judged, and to how many digits.
fn cases(report: &Report) -> String {
    let mut table = table(&["case", "verdict", "judged", "digits"]);
    let rejects = report.rejects_anything();
    let is_listed = |case: &&CaseReport| rejects || case.outcome != Outcome::NotRejected;
    for case in report.cases.iter().filter(is_listed) {
        let judged = if case.of == 0 {
            String::new()
        } else {
            format!("{} of {}", case.judged, case.of)
        };
        let digits = case.digits.map_or(String::new(), |digits| format!("{digits:.1}"));
        table.add_row(vec![case.id.clone(), words(&case.outcome).to_owned(), judged, digits]);
    }
    let mut text = format!("{table}\n");
    if !rejects {
        let run = report.cases.iter().filter(|case| case.outcome == Outcome::NotRejected);
        let sentence = format!(
            "NOT REJECTED: the program ran all {} problems that it should have rejected. If it leaves input checks to its caller, declare \
             `\"validates\": false` in the ready message.",
            run.count()
        );
        text.push_str(&wrapped(&sentence, "  "));
    }
    for case in report.cases.iter().filter(is_listed) {
        if let Some(reason) = reason(case) {
            // What a program writes keeps its lines.
            let mut lines = reason.lines();
            let first = lines.next().unwrap_or_default();
            text.push_str(&wrapped(&format!("{}: {first}", case.id), "  "));
            for line in lines {
                let _ = writeln!(text, "    {line}");
            }
        }
    }
    text
}

/// The faults by equation: their number, and the first in full.
fn faults(report: &Report) -> String {
    let mut text = String::new();
    for fault in faulty_equations(report) {
        let (heading, name) = (fault.heading(), fault.quantity.name());
        let _ = writeln!(text, "\n{heading}  {name}  —  {}", fault.equation());
        text.push_str(&wrapped(&fault.sentence(report.ready.precision), "  "));
        if let Some(explained) = &fault.first.explained {
            text.push_str(&formula::explained(explained));
        }
        for sentence in fault.hidden().into_iter().chain(fault.others()) {
            text.push_str(&wrapped(&sentence, "  "));
        }
    }
    text
}

/// Steps whose equations cannot be evaluated on the program's own values: one sentence for the first of each case.
pub(super) fn without_answer(report: &Report) -> Vec<String> {
    let wrong = report.cases.iter().filter(|case| case.outcome.is_wrong());
    wrong
        .filter_map(|case| Some(format!("{}: {}.", case.id, case.judgement.as_ref()?.failures.first()?)))
        .collect()
}

fn failures(report: &Report) -> String {
    let failed = without_answer(report);
    if failed.is_empty() {
        return String::new();
    }
    let mut text = String::from("\nON THE PROGRAM'S OWN VALUES these equations cannot be evaluated:\n");
    for failure in failed.iter().take(3) {
        text.push_str(&wrapped(failure, "  "));
    }
    if failed.len() > 3 {
        let _ = writeln!(text, "  The same holds in {} more of the cases.", failed.len() - 3);
    }
    text
}

/// A kind in a sentence.
fn kind(variant: &Variant) -> &'static str {
    match variant.kind {
        Kind::Mistake => "mistake",
        Kind::Convention => "another convention, not a mistake",
        Kind::Form => "another form of the same equation, right",
    }
}

fn one(variant: &Variant) -> String {
    format!("{}  ({}; {})", variant.about, variant.id, kind(variant))
}

const EXPLAINED: &str = "every shown value is explained by the program's own earlier values.";

pub(super) fn diagnosis(diagnosis: &Diagnosis) -> String {
    let mut text = String::new();
    match diagnosis {
        Diagnosis::Nothing => {}
        Diagnosis::One(variants) => {
            text.push_str("\nMOST LIKELY\n");
            for variant in variants {
                text.push_str(&wrapped(&one(variant), "  "));
            }
            let _ = writeln!(text, "  With this, {EXPLAINED}");
            if variants.len() > 1 {
                text.push_str("  The shown values cannot distinguish them.\n");
            }
        }
        Diagnosis::Several(members) => {
            let number = ["", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX"];
            let number = number.get(members.len()).copied().unwrap_or("SEVERAL");
            let _ = writeln!(text, "\nMOST LIKELY, {number} AT ONCE");
            for alternatives in members {
                for (index, variant) in alternatives.iter().enumerate() {
                    let or = if index > 0 { "or " } else { "" };
                    text.push_str(&wrapped(&format!("{or}{}", one(variant)), "  "));
                }
            }
            let _ = writeln!(text, "  With these together, {EXPLAINED}");
        }
        Diagnosis::Pairs(pairs) => {
            text.push_str("\nMOST LIKELY, TWO AT ONCE\n");
            for [first, second] in pairs.iter().take(5) {
                text.push_str(&wrapped(&one(first), "  "));
                text.push_str(&wrapped(&format!("and {}", one(second)), "    "));
            }
            let _ = writeln!(text, "  With both, {EXPLAINED}");
            if pairs.len() > 1 {
                let _ = writeln!(
                    text,
                    "  {} pairs do; the shown values cannot distinguish them.",
                    pairs.len()
                );
            }
        }
        Diagnosis::ByFilter(filters) => {
            for (name, of_filter) in filters {
                let sentence = match of_filter {
                    Diagnosis::Nothing => "nothing wrong\n".to_owned(),
                    of_filter => self::diagnosis(of_filter).trim_start().to_owned(),
                };
                let _ = write!(text, "\nFILTER {name}: {sentence}");
            }
        }
        Diagnosis::InParts {
            parts,
            unexplained,
            formulas,
            of,
            pairs,
        } => text.push_str(&in_parts(parts, unexplained, formulas, *of, *pairs)),
    }
    text
}

/// The diagnosis when no single entry explains every value.
fn in_parts(parts: &[Share], unexplained: &[String], formulas: &ComputedFormulas, of: usize, pairs: bool) -> String {
    let mut text = String::from(match (unexplained.is_empty(), formulas.is_complete) {
        (true, _) => "\nMOST LIKELY, IN DIFFERENT CASES\n",
        (false, true) => "\nCAUSE  The formulas below explain what no entry of the catalogue explains.\n",
        (false, false) => "\nCAUSE  No entry of the catalogue, alone or with others, explains every value.\n",
    });
    if !pairs && !unexplained.is_empty() && !formulas.is_complete {
        text.push_str(
            "  Not all pairs in the same equation were tried, because the first fault comes late in the run.\n",
        );
    }
    for (index, part) in parts.iter().enumerate() {
        let _ = match index {
            0 => writeln!(text, "  This explains {} of the {of} cases with a fault:", part.cases),
            _ => writeln!(text, "  This, alone or with the others, explains {} more:", part.cases),
        };
        for (index, variant) in part.variants.iter().enumerate() {
            let or = if index > 0 { "or " } else { "" };
            text.push_str(&wrapped(&format!("{or}{}", one(variant)), "    "));
        }
    }
    if !unexplained.is_empty() && !parts.is_empty() {
        let named: Vec<&str> = unexplained.iter().take(5).map(String::as_str).collect();
        let more = if unexplained.len() > named.len() { ", …" } else { "" };
        let by_it = if formulas.is_complete {
            "Not explained by the catalogue"
        } else {
            "Unexplained"
        };
        text.push_str(&wrapped(&format!("{by_it}: {}{more}", named.join(", ")), "  "));
    }
    text + &formula::text(formulas)
}

/// What was judged and what was not.
fn coverage(report: &Report) -> String {
    let mut sentences = verdict::coverage(report).into_iter();
    let judged = sentences.next().unwrap_or_default();
    let mut text = format!("\nCOVERAGE  {judged}\n");
    for sentence in sentences {
        text.push_str(&wrapped(&sentence, "  "));
    }
    text
}

/// The verdict in one sentence.
fn summary(report: &Report) -> String {
    format!("\n{}", wrapped(&verdict::sentence(report), ""))
}

/// A number with an exponent where it would be long without.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 || (1e-4..1e9).contains(&value.abs()) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}
