//! What is explained: the answers of a program, long ones by their beginnings first.

use super::diagnose::Evidence;
use super::formula::explain;
use super::invalid::Invalid;
use super::judge::{self, Finding, Judged, LIMIT, Reference};
use super::problem::ProblemFile;
use super::subject::Ready;
use super::trace::Trace;
use super::verdict::{CaseReport, Outcome};
use std::collections::BTreeSet;

/// The beginning of a long answer, to a little after its first fault.
pub(super) struct Beginning {
    /// Which of the answered cases it is of.
    pub(super) case: usize,
    pub(super) problem: ProblemFile,
    pub(super) shown: Trace,
    pub(super) reference: Reference,
}

impl Beginning {
    /// The steps after the first fault: in two of them a mistake in almost any equation is made again, and the last is not judged.
    const STEPS_AFTER: usize = 3;

    /// None of an answer without a fault, or where it would be the greater part.
    pub(super) fn of(
        index: usize,
        report: &CaseReport,
        problem: &ProblemFile,
        shown: &Trace,
        reference: &Reference,
    ) -> Option<Self> {
        let steps = report.first_fault()? + Self::STEPS_AFTER;
        if 2 * steps > problem.measurements.len() {
            return None;
        }
        let mut problem = problem.clone();
        problem.measurements.truncate(steps);
        Some(Self {
            case: index,
            problem,
            shown: shown.beginning(steps),
            reference: reference.beginning(steps),
        })
    }
}

/// What an answer says to whoever looks for what was done.
pub(super) fn evidence_of<'a>(
    report: &CaseReport,
    problem: &'a ProblemFile,
    shown: &'a Trace,
    reference: &'a Reference,
    ready: &Ready,
) -> Evidence<'a> {
    let values = report.judgement.iter().flat_map(|judgement| &judgement.values);
    let says_nothing = |value: &&Judged| match value.finding {
        Finding::Stale | Finding::CannotTell | Finding::Unused => true,
        Finding::NotFinite => false,
        Finding::Right => value.own.is_none_or(|own| own.ratio > LIMIT),
        _ => value.own.is_none(),
    };
    let passed: BTreeSet<_> = values.filter(says_nothing).map(|value| value.place).collect();
    Evidence {
        case: judge::Case {
            problem,
            shown,
            reference,
            precision: ready.precision,
        },
        passed,
        is_faulty: report.outcome == Outcome::Wrong,
        steps_to_fault: report.first_fault().unwrap_or(usize::MAX),
        is_beginning: false,
    }
}

/// Puts numbers into the equation of the first fault of each quantity. Each piece of evidence stands with the place of its case.
pub(super) fn explain_first_faults(
    cases: &mut [CaseReport],
    evidence: &[(usize, &Evidence)],
    conventions: &[&str],
) -> Result<(), Invalid> {
    let mut seen = BTreeSet::new();
    for (case, evidence) in evidence {
        let values = cases[*case]
            .judgement
            .iter_mut()
            .flat_map(|judgement| &mut judgement.values);
        let is_first = |value: &&mut Judged| value.finding.is_fault() && seen.insert(value.place.1);
        let mut first: Vec<(&mut Judged, usize)> = values
            .filter(is_first)
            .filter_map(|value| value.own.map(|own| (value, own.index)))
            .collect();
        if first.is_empty() {
            continue;
        }
        let entries: Vec<_> = first.iter().map(|(value, index)| (value.place, *index)).collect();
        for ((value, _), explained) in first.iter_mut().zip(explain(evidence, conventions, &entries)?) {
            value.explained = explained;
        }
    }
    Ok(())
}
