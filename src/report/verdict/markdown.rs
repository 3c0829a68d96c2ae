//! A verdict as Markdown, for a pull request or for the summary of a workflow.
//!
//! A program's own words are set as code, so that they cannot act as markup, links or mentions.

use super::{Overall, coverage, figures, of_the_whole, severity};
use crate::oracle::behaviour::Behaviour;
use crate::oracle::check::{CaseReport, Outcome, Report};
use crate::report::behaviour::{cell, open_questions};
use crate::report::check::{diagnosis, reason, without_answer, words};
use crate::report::fault::faulty_equations;
use crate::report::formula;
use std::fmt::Write;

/// At most this many cases that end without values are listed.
const LISTED: usize = 10;

/// The report as Markdown; the verdict is its first line.
pub fn markdown(report: &Report) -> String {
    let verdict = Overall::of(report).words();
    let (name, figures) = (code(&report.ready.name), figures(report));
    let mut text = format!("### {verdict}: {name}\n\nIn {figures}.\n");
    if let Some(severity) = severity(report) {
        let _ = write!(text, "\n**{severity}**\n");
    }
    for (heading, sentence) in of_the_whole(report) {
        let _ = write!(text, "\n**{heading}**\n\n{}", fenced(&sentence));
    }
    let cause = diagnosis(&report.diagnosis);
    if !cause.is_empty() {
        text.push('\n');
        text.push_str(&fenced(&cause));
    }
    for fault in faulty_equations(report) {
        let (heading, name) = (fault.heading(), code(fault.quantity.name()));
        let mut body = fault.sentence(report.ready.precision) + "\n";
        if let Some(explained) = &fault.first.explained {
            body.push_str(&formula::explained(explained));
        }
        for sentence in fault.hidden().into_iter().chain(fault.others()) {
            let _ = writeln!(body, "{sentence}");
        }
        text.push_str(&details(
            &format!("{heading} {name}, {}", fault.equation()),
            &fenced(&body),
        ));
    }
    text.push_str(&without_values(report));
    text.push_str(&behaviours(report));
    text.push('\n');
    for sentence in coverage(report) {
        let _ = writeln!(text, "- {sentence}");
    }
    text
}

/// The cases that are wrong but have no faulty value: the program ended, said nothing, or refused a valid problem.
fn without_values(report: &Report) -> String {
    let is_one = |case: &&CaseReport| case.outcome.is_wrong() && case.outcome != Outcome::Wrong;
    let cases: Vec<&CaseReport> = report.cases.iter().filter(is_one).collect();
    let one = |case: &&CaseReport| {
        let reason = reason(case).map_or_else(String::new, |reason| format!(": {reason}"));
        format!("{}: {}{reason}\n", case.id, words(&case.outcome))
    };
    let mut body: String = cases.iter().take(LISTED).map(one).collect();
    if cases.len() > LISTED {
        let _ = writeln!(body, "And {} more.", cases.len() - LISTED);
    }
    for sentence in without_answer(report).iter().take(1) {
        let _ = writeln!(
            body,
            "On the program's own values these equations cannot be evaluated: {sentence}"
        );
    }
    if body.is_empty() {
        return String::new();
    }
    let summary = match cases.len() {
        0 => "Steps that cannot be evaluated".to_owned(),
        1 => "1 case that is wrong but has no faulty value".to_owned(),
        several => format!("{several} cases that are wrong but have no faulty value"),
    };
    details(&summary, &fenced(&body))
}

/// One row per behaviour and one column per family of filters.
fn behaviours(report: &Report) -> String {
    let grades = report.grades();
    if grades.is_empty() {
        return String::new();
    }
    let mut text = String::from("\n| situation |");
    for (family, _) in &grades {
        let _ = write!(text, " {family} |");
    }
    let _ = write!(text, "\n|---|{}\n", "---|".repeat(grades.len()));
    for (index, behaviour) in Behaviour::ALL.into_iter().enumerate() {
        let _ = write!(text, "| {} |", behaviour.name());
        for (_, of_family) in &grades {
            let _ = write!(text, " {} |", cell(&of_family[index].1));
        }
        text.push('\n');
    }
    text.push('\n');
    for sentence in open_questions(&grades) {
        let _ = writeln!(text, "- {sentence}");
    }
    text
}

/// A section that unfolds. Markdown inside HTML begins after an empty line.
fn details(summary: &str, body: &str) -> String {
    format!(
        "\n<details><summary>{}</summary>\n\n{body}\n</details>\n",
        html(summary)
    )
}

/// A summary's words, in which a name in backticks is code.
fn html(words: &str) -> String {
    let escaped = words.replace('&', "&amp;").replace('<', "&lt;");
    let parts = escaped.split('`').enumerate();
    parts
        .map(|(index, part)| {
            if index % 2 == 1 {
                format!("<code>{part}</code>")
            } else {
                part.to_owned()
            }
        })
        .collect()
}

/// A program's word inside a line, as code, so that it is never markup.
fn code(text: &str) -> String {
    let plain = |c: char| match c {
        '`' => '\'',
        _ if c.is_control() => ' ',
        _ => c,
    };
    format!("`{}`", text.chars().map(plain).collect::<String>().trim())
}

/// Lines unchanged, in a fence longer than any fence inside them.
fn fenced(text: &str) -> String {
    let longest = text.split(|c| c != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(3.max(longest + 1));
    format!("{fence}text\n{}\n{fence}\n", text.trim_matches('\n'))
}
