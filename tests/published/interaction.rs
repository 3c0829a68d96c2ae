//! Modes that start from the combined estimate, or each from its own: what there was before modes interacted.
//!
//! After this file the reader knows the problems that tell these filters from one another: the chain is far from symmetric, the
//! probabilities are unequal, and the modes' estimates differ.

use super::draft::{Draft, identity, rows};
use super::extended::extended;
use super::scene::{PLANE_TRACK, PROBABILITIES, RADAR_TRACK, plane, radar};
use immaculate::oracle::problem::{FORMAT_2, InteractionFile, ProblemFile};

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    [common(), own()].concat()
}

impl Draft {
    /// The filters start from these estimates.
    fn starting(self, interaction: InteractionFile) -> Self {
        self.with(|problem| {
            problem.format = FORMAT_2.into();
            problem.interaction = Some(interaction);
        })
    }
}

/// Generalised pseudo-Bayesian filters of first order.
fn common() -> Vec<ProblemFile> {
    let flags = [
        "sequence",
        "interaction",
        "missed-detection",
        "transition-order",
        "spread",
        "full-correlation",
    ];
    vec![
        plane()
            .starting(InteractionFile::Gpb1)
            .sees(&PLANE_TRACK[..4])
            .without(&[3])
            .named(
                "gpb1.kalman",
                &flags,
                "All three modes start from the combined estimate of the step before, whatever the chain says of where they come from; the \
                 chain moves the probabilities. One step has no detection.",
            ),
        radar("cubature-3")
            .starting(InteractionFile::Gpb1)
            .chain(rows([[0.8, 0.2, 0.0], [0.35, 0.65, 0.0], [0.6, 0.4, 0.0]]), &[0.5, 0.3, 0.2])
            .sees(&RADAR_TRACK[..3])
            .named(
                "gpb1.unreachable",
                &["sequence", "interaction", "unreachable", "transition-order", "spread", "full-correlation"],
                "No mode leads to the third, itself included: its predicted probability is zero, and it starts from the combined estimate \
                 as the others do, without a division.",
            ),
    ]
}

/// Filters side by side.
fn own() -> Vec<ProblemFile> {
    vec![
        plane()
            .starting(InteractionFile::Unmixed)
            .sees(&PLANE_TRACK[..4])
            .without(&[2])
            .named(
                "unmixed.kalman",
                &["sequence", "interaction", "missed-detection", "transition-order", "spread", "full-correlation"],
                "Each mode goes on from its own estimate; the chain moves the probabilities alone. One step has no detection.",
            ),
        extended(radar("cubature-3"))
            .starting(InteractionFile::Unmixed)
            .chain(identity(3), &PROBABILITIES)
            .sees(&RADAR_TRACK)
            .named(
                "unmixed.static-bank",
                &["sequence", "interaction", "spread", "full-correlation"],
                "The static bank: no mode leads to another, and the probabilities are those of Bayes' rule on products of likelihoods.",
            ),
    ]
}
