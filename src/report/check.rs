//! The verdict on a program under test, for people and as JSON.
//!
//! After this file the reader knows how a verdict looks: the cases, the faults by equation, what was done, and last the sentence that
//! matters.

use super::behaviour::behaviours;
use super::formula;
use super::observation::observations;
use super::{table, wrapped};
use crate::imm::Quantity;
use crate::oracle::behaviour::Unasked;
use crate::oracle::check::{CaseReport, Outcome, Report};
use crate::oracle::diagnose::{Diagnosis, Share};
use crate::oracle::formula::ComputedFormulas;
use crate::oracle::judge::{Finding, Judged};
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

/// The reason that an outcome carries.
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
        Outcome::NotRejected => Some("the problem is wrong and was run all the same".into()),
        _ => None,
    }
}

/// One line a case: what was judged and to how many digits.
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
            "NOT REJECTED: {} problems that must be rejected, all that were asked, were run all the same. A program that leaves the checking \
             of its input to its caller says so: `\"validates\": false` in the ready message.",
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

/// The faults by equation: how many, and the first in full.
fn faults(report: &Report) -> String {
    let mut text = String::new();
    for quantity in Quantity::ALL {
        let heading = if report.is_otherwise(quantity) {
            "OTHERWISE"
        } else {
            "FAULT"
        };
        let faults: Vec<(&CaseReport, &Judged)> = report
            .faults()
            .filter(|(_, judged)| judged.place.1 == quantity)
            .collect();
        let Some((case, judged)) = faults.first() else { continue };
        let mut cases: Vec<&str> = faults.iter().map(|(case, _)| case.id.as_str()).collect();
        cases.dedup();
        let _ = writeln!(
            text,
            "\n{heading}  {}  —  {}",
            quantity.name(),
            case.filters[judged.place.2].equation(quantity)
        );
        text.push_str(&wrapped(&first_fault(case, judged, report), "  "));
        if let Some(explained) = &judged.explained {
            text.push_str(&formula::explained(explained));
        }
        if !judged.hidden.is_empty() {
            let names: Vec<&str> = judged.hidden.iter().map(|quantity| quantity.name()).collect();
            let sentence = format!(
                "The fault is in this equation or in one before it that is not shown: {}.",
                names.join(", ")
            );
            text.push_str(&wrapped(&sentence, "  "));
        }
        if faults.len() > 1 {
            let others = match cases.len() - 1 {
                0 => String::new(),
                1 => " and one other".into(),
                others => format!(" and {others} others"),
            };
            let sentence = format!("And {} more of these values, in this case{others}.", faults.len() - 1);
            text.push_str(&wrapped(&sentence, "  "));
        }
    }
    text
}

/// The place of a number inside its quantity.
fn entry(judged: &Judged, index: usize, report: &CaseReport) -> String {
    let quantity = judged.place.1;
    let columns = report.columns(judged.place.0, quantity);
    match quantity.rank() {
        0 => String::new(),
        1 => format!("[{index}]"),
        _ => format!("[{}][{}]", index / columns, index % columns),
    }
}

fn first_fault(case: &CaseReport, judged: &Judged, report: &Report) -> String {
    let (step, quantity, mode) = judged.place;
    let of_mode = if quantity.is_of_mode() {
        format!("modes[{mode}].")
    } else {
        String::new()
    };
    let place = format!("{}, step {step}, {of_mode}{}", case.id, quantity.name());
    let Some(own) = judged.own else {
        return format!("{place}: the value is not finite.");
    };
    if judged.finding == Finding::NotFinite {
        return format!(
            "{place}: the value is not finite; from the program's own values it is {}.",
            own.expected
        );
    }
    let noise = if own.ratio.is_finite() {
        format!("{:.0e} times", own.ratio)
    } else {
        "infinitely many times".into()
    };
    format!(
        "{place}{} is {}, and should be {} by the program's own values before it: off by {:.2e}{}, {noise} the rounding noise of {}.",
        entry(judged, own.index, case),
        number(own.shown),
        number(own.expected),
        own.size,
        unit(quantity),
        report.ready.precision,
    )
}

/// Steps whose equations have no answer on the program's own values.
fn failures(report: &Report) -> String {
    let failed: Vec<String> = report
        .cases
        .iter()
        .filter(|case| case.outcome.is_wrong())
        .filter_map(|case| Some(format!("{}: {}.", case.id, case.judgement.as_ref()?.failures.first()?)))
        .collect();
    if failed.is_empty() {
        return String::new();
    }
    let mut text = String::from("\nON THE PROGRAM'S OWN VALUES the equations have no answer here:\n");
    for failure in failed.iter().take(3) {
        text.push_str(&wrapped(failure, "  "));
    }
    if failed.len() > 3 {
        let _ = writeln!(text, "  And so it is in {} more of the cases.", failed.len() - 3);
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

const EXPLAINED: &str = "every value that was shown is explained by the program's own values before it.";

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
                text.push_str("  These cannot be told apart by what was shown.\n");
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
                    "  {} pairs do, and cannot be told apart by what was shown.",
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

/// What is said where no one thing explains all.
fn in_parts(parts: &[Share], unexplained: &[String], formulas: &ComputedFormulas, of: usize, pairs: bool) -> String {
    let mut text = String::from(match (unexplained.is_empty(), formulas.is_complete) {
        (true, _) => "\nMOST LIKELY, IN DIFFERENT CASES\n",
        (false, true) => "\nCAUSE  What no entry of the catalogue explains, the formulas below do.\n",
        (false, false) => "\nCAUSE  Nothing in the catalogue, alone or with others, explains every value.\n",
    });
    if !pairs && !unexplained.is_empty() && !formulas.is_complete {
        text.push_str("  Of pairs in the same equation not all were tried: the run is long until its first fault.\n");
    }
    for (index, part) in parts.iter().enumerate() {
        let _ = match index {
            0 => writeln!(text, "  This explains {} of the {of} cases with a fault:", part.cases),
            _ => writeln!(text, "  And this, alone or with the others, {} more:", part.cases),
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
            "The catalogue leaves"
        } else {
            "Unexplained"
        };
        text.push_str(&wrapped(&format!("{by_it}: {}{more}", named.join(", ")), "  "));
    }
    text + &formula::text(formulas)
}

/// What was judged and what was not.
fn coverage(report: &Report) -> String {
    let (judged, of) = counts(report);
    let mut text = format!("\nCOVERAGE  {judged} of {of} values of the cases that were asked for were judged.\n");
    text.push_str(&passed_over(report));
    for case in &report.cases {
        if let Some(certified) = case.certified {
            let sentence = certified_steps(&case.id, certified, case.dimensions.steps());
            text.push_str(&wrapped(&sentence, "  "));
        }
    }
    if !report.hidden.is_empty() && judged > 0 {
        let names: Vec<&str> = report.hidden.iter().map(|quantity| quantity.name()).collect();
        let sentence = format!(
            "Never shown: {}. A mistake there is seen only by what follows from it, and what was right there by chance or \
             cancels later is not seen at all.",
            names.join(", ")
        );
        text.push_str(&wrapped(&sentence, "  "));
    }
    let not_asked = report
        .not_asked
        .iter()
        .filter(|case| case.why != Unasked::Selection)
        .count();
    if not_asked > 0 {
        let sentence = format!(
            "Cases not asked for: {not_asked}, of filters or formats that the program does not have, or with input that it leaves to its \
             caller to check."
        );
        text.push_str(&wrapped(&sentence, "  "));
    }
    match report.echo {
        None => {
            text.push_str("  The program gave no echo: whether it reads matrices by rows is seen by the cases only.\n");
        }
        Some(true) => {}
        Some(false) => text.push_str(
            "  ECHO WRONG: matrix times vector is not what it should be. Does the program read matrices by columns?\n",
        ),
    }
    text
}

/// The values that were shown and not judged, by the reason.
fn passed_over(report: &Report) -> String {
    let mut text = String::new();
    for (finding, sentence) in [
        (
            Finding::CannotTell,
            "cannot be judged: rounding in this precision moves them by as much as their unit",
        ),
        (
            Finding::Undetermined,
            "are undetermined: they rest on hidden values that are under suspicion",
        ),
        (
            Finding::Unused,
            "belong to a mode of probability zero, which no output depends on, and were passed over",
        ),
        (
            Finding::Stale,
            "are shown where there are none, without a detection or as covariances of fixed gains, and were passed over",
        ),
    ] {
        let values = report
            .cases
            .iter()
            .flat_map(|case| &case.judgement)
            .flat_map(|judgement| &judgement.values);
        let count = values.filter(|value| value.finding == finding).count();
        if count > 0 {
            let _ = writeln!(text, "  {count} {sentence}.");
        }
    }
    text
}

/// What of a problem of the user is proven.
fn certified_steps(id: &str, certified: usize, all: usize) -> String {
    if certified == all {
        return format!("{id}: every expected value is certified.");
    }
    format!(
        "{id}: the expected values are certified to step {certified} of {all}; after it they are those of Immaculate's own run in doubles, with \
         its rounding noise, and each equation is judged on the program's own values as before."
    )
}

pub(super) fn counts(report: &Report) -> (usize, usize) {
    let sum = |of: fn(&CaseReport) -> usize| report.cases.iter().map(of).sum();
    (sum(|case| case.judged), sum(|case| case.of))
}

/// The sentence that matters.
fn summary(report: &Report) -> String {
    let count = |is: fn(&Outcome) -> bool| report.cases.iter().filter(|case| is(&case.outcome)).count();
    let right = count(|outcome| matches!(outcome, Outcome::Right | Outcome::Rejected { .. }));
    let wrong = count(Outcome::is_wrong);
    let skipped = count(|outcome| matches!(outcome, Outcome::Skipped { .. }));
    let cannot_tell = count(|outcome| matches!(outcome, Outcome::CannotTell));
    let parts: Vec<String> = [
        (right, "right"),
        (wrong, if report.is_excused() { "otherwise" } else { "wrong" }),
        (cannot_tell, "drowned in rounding noise"),
        (skipped, "skipped"),
    ]
    .into_iter()
    .filter(|(number, _)| *number > 0)
    .map(|(number, word)| format!("{number} {word}"))
    .collect();
    let least = report.cases.iter().filter_map(|case| Some((case.digits?, &case.id)));
    let least = least.reduce(|a, b| if b.0 < a.0 { b } else { a });
    let digits = least.map_or(String::new(), |(digits, id)| {
        format!("; right values to {digits:.1} digits or more, the fewest in {id}")
    });
    let verdict = match (&report.diagnosis, report.is_wrong()) {
        (_, true) => "WRONG",
        (Diagnosis::Nothing, false) if right == 0 => "NOTHING JUDGED",
        (Diagnosis::Nothing, false) if !report.is_complete() => "RIGHT on what was judged",
        (Diagnosis::Nothing, false) => "RIGHT",
        (_, false) => "RIGHT, but otherwise, see above",
    };
    let name = &report.ready.name;
    let sentence = format!(
        "{verdict}: {name}, {}: {} of {} cases{digits}",
        report.ready.precision,
        parts.join(", "),
        report.cases.len()
    );
    format!("\n{}", wrapped(&sentence, ""))
}

/// A number with an exponent where it would be long without.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 || (1e-4..1e9).contains(&value.abs()) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// In what a quantity's errors are counted, after a blank; nothing where they are counted in themselves.
fn unit(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::PredictedModeProbabilities | Quantity::MixingProbabilities | Quantity::ModeProbabilities => {
            " of itself"
        }
        Quantity::LogLikelihood => "",
        Quantity::Gain => " √(Pᵢᵢ/Sⱼⱼ)",
        Quantity::MotionJacobian => " √(P⁻ᵢᵢ/P⁰ⱼⱼ)",
        Quantity::MeasurementJacobian => " √(Sᵢᵢ/P⁻ⱼⱼ)",
        Quantity::CrossCovariance => " √(Pᵢᵢ Sⱼⱼ)",
        quantity if quantity.is_covariance() => " √(Pᵢᵢ Pⱼⱼ)",
        _ => " standard deviations",
    }
}
