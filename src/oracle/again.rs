//! Asking again: whether answers depend on chance, or on what was asked before.
//!
//! ```text
//! start, case 1, case 2, … case n, case 1 again, stop          the same answer, bit for bit?
//! start, a wrong case alone, stop                              right there? then something is kept between problems
//! ```

use super::check::that_it_has;
use super::evidence::Answered;
use super::invalid::Invalid;
use super::observation::{Discrepancy, Observation};
use super::subject::{Answer, Subject};
use super::trace::Trace;
use super::verdict::{CaseReport, Outcome};

/// At most this many wrong cases are asked alone: starting a program may take seconds, and one case that is right alone is enough.
const ASKED_ALONE: usize = 3;

/// Judges an answer to one of the cases that were asked for.
type IsRight<'a> = &'a dyn Fn(usize, Answer) -> Result<bool, Invalid>;

/// Asks once more and ends the program: what is seen, and what was strange on the way.
pub(super) fn ask_again(
    subject: &mut dyn Subject,
    answered: &[Answered],
    cases: &[CaseReport],
    is_right: IsRight,
) -> Result<(Vec<Observation>, Vec<String>), Invalid> {
    let mut observations = Vec::new();
    if let Some(first) = answered.first() {
        let was_right = cases[first.index].outcome == Outcome::Right;
        observations.extend(differs(subject, first, was_right, is_right)?);
    }
    let mut remarks = subject.stop();
    // What was asked first was asked alone.
    let is_asked = |case: &&Answered| case.index > 0 && cases[case.index].outcome.is_wrong();
    let wrong = answered.iter().filter(is_asked);
    let mut ids = Vec::new();
    for case in wrong.take(ASKED_ALONE) {
        if !subject.forgets_at_start() || subject.start().is_err() {
            break;
        }
        let answer = subject.run(case.problem);
        let new: Vec<String> = subject
            .stop()
            .into_iter()
            .filter(|new| !remarks.contains(new))
            .collect();
        remarks.extend(new);
        // The same answer is as wrong as before.
        let is_same = values(&answer, case).is_some_and(|again| Discrepancy::between(&case.shown, &again).is_none());
        if !is_same && is_right(case.index, answer)? {
            ids.push(case.problem.id.clone());
        }
    }
    if !ids.is_empty() {
        observations.push(Observation::RightAlone { ids });
    }
    Ok((observations, remarks))
}

/// Asks a case in the same process.
fn differs(
    subject: &mut dyn Subject,
    first: &Answered,
    was_right: bool,
    is_right: IsRight,
) -> Result<Option<Observation>, Invalid> {
    let answer = subject.run(first.problem);
    let again = values(&answer, first);
    let difference = again
        .as_ref()
        .and_then(|again| Discrepancy::between(&first.shown, again));
    if again.is_some() && difference.is_none() {
        return Ok(None);
    }
    Ok(Some(Observation::AnswersDiffer {
        id: first.problem.id.clone(),
        difference,
        is_rounding: was_right && is_right(first.index, answer)?,
    }))
}

/// The values of an answer that are judged, if it has those of the problem.
fn values(answer: &Answer, of: &Answered) -> Option<Trace> {
    match answer {
        Answer::Steps { trace, .. } if trace.check(&of.shown.dimensions).is_ok() => {
            Some(that_it_has(of.problem, trace.clone()))
        }
        _ => None,
    }
}
