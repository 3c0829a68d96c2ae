//! Steps that all show the same: one record that is filled again in every step and listed once for each.

use super::evidence::Answered;
use super::judge::Finding;
use super::observation::Observation;
use super::trace::{Trace, same};
use super::verdict::CaseReport;

/// The first answer whose steps are all the same, though they should not be.
pub(super) fn steps_alike(answered: &[Answered], cases: &[CaseReport]) -> Option<Observation> {
    let of = answered.iter().find(|of| is_alike(of))?;
    let judgement = cases[of.index].judgement.as_ref()?;
    let right_in = |step: usize| {
        let values = judgement.values.iter().filter(|value| value.place.0 == step);
        values.filter(|value| value.finding == Finding::Right).count()
    };
    let step = (1..=of.shown.dimensions.steps()).max_by_key(|step| right_in(*step))?;
    Some(Observation::StepsAlike {
        id: of.problem.id.clone(),
        step: (right_in(step) > 0).then_some(step),
    })
}

/// Whether every value is that of the last step, in several steps, and none should be.
fn is_alike(of: &Answered) -> bool {
    let last = of.shown.dimensions.steps();
    let mut is_several = false;
    for (step, quantity, mode) in of.shown.all_places().filter(|place| place.0 < last) {
        let at = |trace: &Trace, step: usize| trace.get(step, quantity, mode).cloned();
        let Some((here, there)) = at(&of.shown, step).zip(at(&of.shown, last)) else {
            continue;
        };
        if here.len() != there.len() || !here.iter().zip(&there).all(|(a, b)| same(*a, *b)) {
            return false;
        }
        is_several |= at(&of.reference.trace, step) != at(&of.reference.trace, last);
    }
    is_several
}
