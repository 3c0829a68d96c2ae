//! What is explained: the answers of a program, long ones by their beginnings first.

use super::diagnose::{Diagnosis, Evidence, diagnose, diagnose_quickly};
use super::formula;
use super::invalid::Invalid;
use super::judge::{self, Finding, Judged, Judgement, LIMIT, Place, Reference};
use super::observation::Observation;
use super::problem::ProblemFile;
use super::subject::Ready;
use super::trace::Trace;
use super::verdict::{CaseReport, Outcome};
use std::collections::BTreeSet;

/// A case that was answered with values.
pub(super) struct Answered<'a> {
    /// Its place among the cases that were asked for.
    pub(super) index: usize,
    pub(super) problem: &'a ProblemFile,
    pub(super) shown: Trace,
    pub(super) reference: Reference,
}

/// What explains the faults of the answers.
pub(super) fn explain(
    answered: &[Answered],
    cases: &[CaseReport],
    ready: &Ready,
    conventions: &[&str],
    observations: &[Observation],
) -> Result<Diagnosis, Invalid> {
    let faults = cases.iter().flat_map(|case| {
        let faults = case.judgement.iter().flat_map(Judgement::faults);
        faults.map(move |value| (case, value))
    });
    let is_open = |(case, value): &(&CaseReport, &Judged)| {
        let mut seen = observations.iter();
        !seen.any(|observation| observation.is_cause(&case.id, value.place.1))
    };
    let open: Vec<(&CaseReport, &Judged)> = faults.filter(is_open).collect();
    if open.is_empty() {
        return Ok(Diagnosis::Nothing);
    }
    let beginnings: Vec<(&CaseReport, Beginning)> = answered
        .iter()
        .filter_map(|of| Some((&cases[of.index], Beginning::of(&cases[of.index], of)?)))
        .collect();
    let mut evidence: Vec<Evidence> = answered
        .iter()
        .map(|of| evidence_of(&cases[of.index], of.problem, &of.shown, &of.reference, ready))
        .collect();
    for (case, beginning) in &beginnings {
        let Beginning {
            problem,
            shown,
            reference,
        } = beginning;
        let mut of_beginning = evidence_of(case, problem, shown, reference, ready);
        of_beginning.is_beginning = true;
        // What a mistake takes from the step after it is not there at the end.
        of_beginning.passed.extend(shown.places(problem.measurements.len()));
        evidence.push(of_beginning);
    }
    // Chance and rounding that runs away are no equations of their own, and what is not finite says nothing about the rest.
    let is_unsteady = observations.iter().any(Observation::is_unsteady);
    let says_it_all = |(case, value): &(&CaseReport, &Judged)| {
        value.finding == Finding::NotFinite || observations.iter().any(|seen| seen.is_lost_symmetry_of(&case.id))
    };
    if is_unsteady || open.iter().all(says_it_all) {
        return diagnose_quickly(&evidence, conventions);
    }
    diagnose(&evidence, conventions)
}

/// The beginning of a long answer, to a little after its first fault.
struct Beginning {
    problem: ProblemFile,
    shown: Trace,
    reference: Reference,
}

impl Beginning {
    /// The steps after the first fault: in two of them a mistake in almost any equation is made again, and the last is not judged.
    const STEPS_AFTER: usize = 3;

    /// None of an answer without a fault, or where it would be the greater part.
    fn of(report: &CaseReport, answered: &Answered) -> Option<Self> {
        let problem = answered.problem;
        let steps = report.first_fault()? + Self::STEPS_AFTER;
        if 2 * steps > problem.measurements.len() {
            return None;
        }
        let mut problem = problem.clone();
        problem.measurements.truncate(steps);
        Some(Self {
            problem,
            shown: answered.shown.beginning(steps),
            reference: answered.reference.beginning(steps),
        })
    }
}

/// The evidence in an answer, for the diagnosis.
fn evidence_of<'a>(
    report: &CaseReport,
    problem: &'a ProblemFile,
    shown: &'a Trace,
    reference: &'a Reference,
    ready: &Ready,
) -> Evidence<'a> {
    Evidence {
        case: judge::Case {
            problem,
            shown,
            reference,
            precision: ready.precision,
        },
        passed: passed(report),
        is_faulty: report.outcome == Outcome::Wrong,
        steps_to_fault: report.first_fault().unwrap_or(usize::MAX),
        is_beginning: false,
    }
}

/// The places of an answer that say nothing about what was done.
pub(super) fn passed(report: &CaseReport) -> BTreeSet<Place> {
    let values = report.judgement.iter().flat_map(|judgement| &judgement.values);
    let says_nothing = |value: &&Judged| match value.finding {
        Finding::Stale | Finding::CannotTell | Finding::Unused => true,
        Finding::NotFinite => false,
        Finding::Right => value.own.is_none_or(|own| own.ratio > LIMIT),
        _ => value.own.is_none(),
    };
    values.filter(says_nothing).map(|value| value.place).collect()
}

/// Puts numbers into the equation of the first fault of each quantity.
pub(super) fn explain_first_faults(
    cases: &mut [CaseReport],
    answered: &[Answered],
    ready: &Ready,
    conventions: &[&str],
) -> Result<(), Invalid> {
    let mut seen = BTreeSet::new();
    for of in answered {
        if cases[of.index].first_fault().is_none() {
            continue;
        }
        let evidence = evidence_of(&cases[of.index], of.problem, &of.shown, &of.reference, ready);
        let judgement = &mut cases[of.index].judgement;
        let values = judgement.iter_mut().flat_map(|judgement| &mut judgement.values);
        let is_first = |value: &&mut Judged| value.finding.is_fault() && seen.insert(value.place.1);
        let mut first: Vec<(&mut Judged, usize)> = values
            .filter(is_first)
            .filter_map(|value| value.own.map(|own| (value, own.index)))
            .collect();
        if first.is_empty() {
            continue;
        }
        let entries: Vec<_> = first.iter().map(|(value, index)| (value.place, *index)).collect();
        let explained = formula::explain(&evidence, conventions, &entries)?;
        for ((value, _), explained) in first.iter_mut().zip(explained) {
            value.explained = explained;
        }
    }
    Ok(())
}
