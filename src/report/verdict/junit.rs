//! A verdict as JUnit XML, which GitLab, Jenkins and the test reporters of GitHub show: one suite per kind of filter, one test per case.
//!
//! A test fails if and only if the verdict is wrong.

use super::{in_figures, is_wrong, of_the_whole};
use crate::oracle::check::{CaseReport, Outcome, Report};
use crate::report::check::{diagnosis, reason, words};
use crate::report::fault::faulty_equations_of;
use crate::report::formula;
use quick_junit::{NonSuccessKind, SerializeError, TestCase, TestCaseStatus, TestSuite};
use std::collections::BTreeMap;
use std::fmt::Write;

/// At most this many faults of a case are described; the rest mostly follow from them.
const DESCRIBED: usize = 3;

/// The report as JUnit XML.
///
/// # Errors
///
/// [`SerializeError`] when the library that writes XML cannot.
pub fn junit(report: &Report) -> Result<String, SerializeError> {
    let mut suites: BTreeMap<String, TestSuite> = BTreeMap::new();
    for case in &report.cases {
        let kinds = kinds(case);
        let suite = suites
            .entry(kinds.clone())
            .or_insert_with(|| TestSuite::new(kinds.as_str()));
        suite.add_test_case(test_of(report, case, &kinds));
    }
    let whole = of_the_whole(report);
    if !whole.is_empty() {
        let mut suite = TestSuite::new("the program as a whole");
        for (heading, sentence) in whole {
            let mut test = TestCase::new(heading, failure(heading, &sentence));
            test.set_classname("the program as a whole");
            suite.add_test_case(test);
        }
        suites.insert("the program as a whole".to_owned(), suite);
    }
    let mut all = quick_junit::Report::new(report.ready.name.as_str());
    all.add_test_suites(suites.into_values());
    // The schema of Jenkins knows no such count of the root. In the name before it, quotes are escaped.
    let count = format!(" skipped=\"{}\"", all.skipped);
    Ok(all.to_string()?.replacen(&count, "", 1))
}

/// The kinds of a case's filters, each once.
fn kinds(case: &CaseReport) -> String {
    let mut kinds: Vec<&str> = Vec::new();
    for filter in &case.filters {
        if !kinds.contains(&filter.name()) {
            kinds.push(filter.name());
        }
    }
    kinds.join(" + ")
}

/// A case as a test.
fn test_of(report: &Report, case: &CaseReport, kinds: &str) -> TestCase {
    let reason = reason(case);
    let status = if is_wrong(report, case) {
        failure(words(&case.outcome), &explanation(report, case))
    } else if matches!(
        case.outcome,
        Outcome::Skipped { .. } | Outcome::CannotTell | Outcome::NothingShown
    ) {
        let mut skipped = TestCaseStatus::skipped();
        skipped.set_message(reason.unwrap_or_else(|| words(&case.outcome).to_owned()));
        skipped
    } else {
        TestCaseStatus::success()
    };
    let is_success = matches!(status, TestCaseStatus::Success { .. });
    let mut test = TestCase::new(case.id.as_str(), status);
    test.set_classname(kinds);
    if is_success {
        test.set_system_out(passed(report, case));
    }
    test
}

/// A failure with its kind, the first line of its text, and the text.
fn failure(kind: &str, text: &str) -> TestCaseStatus {
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    status.set_type(kind);
    status.set_message(text.lines().next().unwrap_or(kind));
    status.set_description(text);
    status
}

/// What is wrong in a case, and what explains it.
fn explanation(report: &Report, case: &CaseReport) -> String {
    let mut text = String::new();
    let faults = faulty_equations_of(report, case);
    for fault in faults.iter().take(DESCRIBED) {
        let (name, equation) = (fault.quantity.name(), fault.equation());
        let _ = writeln!(text, "{}  {name}  —  {equation}", fault.heading());
        let _ = writeln!(text, "  {}", fault.sentence(report.ready.precision));
        if let Some(explained) = &fault.first.explained {
            text.push_str(&formula::explained(explained));
        }
        if let Some(hidden) = fault.hidden() {
            let _ = writeln!(text, "  {hidden}");
        }
    }
    if faults.len() > DESCRIBED {
        let names: Vec<&str> = faults[DESCRIBED..].iter().map(|fault| fault.quantity.name()).collect();
        let _ = writeln!(text, "And faults in {}.", names.join(", "));
    }
    if let Some(reason) = reason(case) {
        let _ = writeln!(text, "{reason}");
    }
    for failure in case.judgement.iter().flat_map(|judgement| &judgement.failures).take(1) {
        let _ = writeln!(
            text,
            "On the program's own values these equations cannot be evaluated: {failure}."
        );
    }
    if text.is_empty() {
        let _ = writeln!(text, "{}", words(&case.outcome));
    }
    if !faults.is_empty() {
        text.push_str(&diagnosis(&report.diagnosis));
    }
    text
}

/// The text of a case that passed.
fn passed(report: &Report, case: &CaseReport) -> String {
    let mut text = words(&case.outcome).to_owned();
    if case.outcome == Outcome::Wrong {
        text = format!("otherwise: {}", diagnosis(&report.diagnosis).trim());
    }
    if case.of > 0 {
        let _ = write!(text, "; {} of {} values were judged", case.judged, case.of);
    }
    if let Some(digits) = case.digits {
        let _ = write!(text, ", right to {} digits or more", in_figures(digits));
    }
    text
}
