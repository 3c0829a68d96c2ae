//! Mixing and combination again, in steps that have a measurement.
//!
//! They suit filters that need a detection in every step.

use super::draft::Draft;
use super::equations;
use super::scene::{PLANE_TRACK, axis, plane, scalar};
use immaculate::oracle::problem::ProblemFile;

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    vec![
        twin("mixing.two-modes").sees(&[[44.0]]).named(
            "mixing.two-modes.seen",
            &["mixing", "single-step", "spread", "transition-order", "full-correlation"],
            "The modes of mixing.two-modes, which stand still, with a measurement: what is mixed is what the update starts from, up to a \
             ten-thousandth of Q.",
        ),
        twin("mixing.three-modes").sees(&[[112.0, -48.0]]).named(
            "mixing.three-modes.seen",
            &["mixing", "single-step", "spread", "transition-order", "full-correlation"],
            "The modes of mixing.three-modes with a measurement.",
        ),
        twin("mixing.equal-means").sees(&[[112.0, -48.0]]).named(
            "mixing.equal-means.seen",
            &["mixing", "single-step", "transition-order", "full-correlation"],
            "The modes of mixing.equal-means with a measurement: a filter that mixes means alone is seen by the covariances that it updates.",
        ),
        twin("mixing.equal-covariances").sees(&[[112.0, -48.0]]).named(
            "mixing.equal-covariances.seen",
            &["mixing", "single-step", "spread", "transition-order", "full-correlation"],
            "The modes of mixing.equal-covariances with a measurement: without the spread of the means all gains are nearly the same.",
        ),
        twin("combination.three-modes").sees(&[[112.0, -48.0]]).named(
            "combination.three-modes.seen",
            &["combination", "single-step", "spread", "full-correlation"],
            "The modes of combination.three-modes, which keep their own estimates, with a measurement: they are combined as updated.",
        ),
        scalar().sees(&[[8.9], [5.3], [9.9]]).named(
            "combination.scalar.seen",
            &["combination", "sequence", "spread", "full-correlation"],
            "Three steps of two modes of one number, each with a detection: every value can be checked by hand.",
        ),
        axis().sees(&[[54.0], [59.5], [61.0], [70.5]]).named(
            "steps.axis",
            &["sequence", "transition-order", "spread", "full-correlation"],
            "Four steps of three modes of position and velocity, each with a detection: mixing takes the estimates of the step before, and \
             not those of the beginning.",
        ),
        plane().keep(&[0, 2]).sees(&PLANE_TRACK).named(
            "steps.two-modes.kalman",
            &["sequence", "transition-order", "spread", "full-correlation", "row-order"],
            "Six steps of two Kalman filters of four entries, each with a detection: two modes hide what three show, and the reverse.",
        ),
    ]
}

/// The problem of an equation by itself, to be measured.
fn twin(id: &str) -> Draft {
    let mut all = equations::all().into_iter();
    Draft(all.find(|problem| problem.id == id).expect("a problem of another file"))
}
