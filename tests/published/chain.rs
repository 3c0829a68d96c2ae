//! The Markov chain, missed detections and outliers: what moves the probabilities, and what must not.
//!
//! These problems are hard for the probabilities: modes that cannot be reached or left, probabilities next to zero and one, steps without
//! a detection, and measurements that no mode explains.

use super::draft::{covariance, estimate, mode, rows, unscented};
use super::scene::{PLANE_TRACK, RADAR_TRACK, axis, plane, radar, scalar};
use immaculate::oracle::problem::{EstimateFile, ProblemFile};

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    [chains(), ends(), five_modes(), missed(), outliers()].concat()
}

/// Chains that are hard to get right in general.
fn chains() -> Vec<ProblemFile> {
    vec![
        plane()
            .with(|problem| {
                let (first, start) = (problem.modes[0].clone(), problem.initial.modes[0].clone());
                for mode in &mut problem.modes {
                    mode.transition.clone_from(&first.transition);
                    mode.noise.clone_from(&first.noise);
                }
                problem.initial.modes.fill(start);
            })
            .sees(&PLANE_TRACK[..4])
            .named(
                "chain.identical-modes",
                &["sequence", "identical-modes", "transition-order", "full-correlation"],
                "Three modes that are the same in everything: all likelihoods are equal, the probabilities follow the chain alone, and \
                 the estimate is that of one Kalman filter. Transposing the asymmetric chain shows in the probabilities and nowhere else.",
            ),
        plane()
            .chain(rows([[0.6, 0.3, 0.1], [0.1, 0.7, 0.2], [0.15, 0.05, 0.8]]), &[0.02, 0.95, 0.03])
            .sees(&PLANE_TRACK[..2])
            .named(
                "chain.not-stationary",
                &["sequence", "not-stationary", "first-step", "transition-order", "full-correlation"],
                "The first step starts from probabilities far from those that the chain tends to. A filter that takes its initial \
                 probabilities as predicted ones, or does not mix at the first step, shows here.",
            ),
        plane()
            .keep(&[0, 1])
            .chain(rows([[0.999_999_999_999, 1e-12], [3e-12, 0.999_999_999_997]]), &[0.999_999_999_998, 2e-12])
            .sees(&PLANE_TRACK[..3])
            .named(
                "chain.nearly-certain",
                &["sequence", "floor", "full-correlation"],
                "Probabilities of 1e-12 and of one less 1e-12: a floor under probabilities, or a threshold below which a mode is left \
                 out, shows here, and so does 1 - p for a p that was lost.",
            ),
    ]
}

/// Modes that cannot be reached, or not be left.
fn ends() -> Vec<ProblemFile> {
    vec![
        plane()
            .chain(rows([[0.8, 0.2, 0.0], [0.35, 0.65, 0.0], [0.6, 0.4, 0.0]]), &[0.5, 0.3, 0.2])
            .sees(&PLANE_TRACK[..3])
            .named(
                "chain.unreachable",
                &["sequence", "unreachable", "transition-order", "full-correlation"],
                "No mode leads to the third, itself included: its predicted probability is zero, its mixing probabilities are 0/0 and \
                 by convention its own estimate. A filter that divides gives NaN everywhere.",
            ),
        plane()
            .chain(rows([[0.7, 0.3, 0.0], [0.2, 0.5, 0.3], [0.1, 0.3, 0.6]]), &[1.0, 0.0, 0.0])
            .sees(&PLANE_TRACK[..4])
            .named(
                "chain.reached-later",
                &["sequence", "unreachable", "not-stationary", "transition-order", "full-correlation"],
                "The first mode is certain and does not lead to the third, which is reached at the second step only, by way of the \
                 second. Until then the third mode goes its own way, and must be ready when it is needed.",
            ),
        axis()
            .chain(rows([[0.8, 0.15, 0.05], [0.1, 0.75, 0.15], [0.25, 0.1, 0.65]]), &[0.0, 0.55, 0.45])
            .sees(&[[54.0], [53.0], [66.0]])
            .named(
                "chain.initial-zero",
                &["sequence", "not-stationary", "transition-order", "full-correlation"],
                "A mode has the probability zero at step 0 and is reached from the others at once: its own initial estimate counts for \
                 nothing. A filter that works with logarithms of probabilities shows what it does with ln 0.",
            ),
        plane()
            .chain(rows([[1.0, 0.0, 0.0], [0.3, 0.6, 0.1], [0.2, 0.1, 0.7]]), &[0.1, 0.5, 0.4])
            .sees(&PLANE_TRACK[..5])
            .named(
                "chain.absorbing",
                &["sequence", "absorbing", "transition-order", "full-correlation"],
                "The first mode cannot be left. Its column of the transition matrix is full and its row is not: transposed, it is a mode \
                 that no other leads to.",
            ),
    ]
}

/// More modes than any dimension of the problem.
fn five_modes() -> Vec<ProblemFile> {
    let drifts = [(0.97, 0.8), (1.04, 1.1), (0.88, 1.9), (1.01, 0.5), (1.1, 2.6)];
    let starts = [(5.0, 2.3), (6.6, 3.5), (3.9, 1.7), (5.8, 4.4), (4.4, 2.9)];
    let draft = scalar().with(|problem| {
        let names = ["a", "b", "c", "d", "e"];
        let modes = names.iter().zip(drifts);
        problem.modes = modes
            .map(|(name, (f, q))| mode(name, rows([[f]]), rows([[q]])))
            .collect();
        problem.initial.modes = starts.map(|(mean, p)| estimate(&[mean], rows([[p]]))).to_vec();
    });
    let chain = rows([
        [0.6, 0.15, 0.1, 0.1, 0.05],
        [0.05, 0.7, 0.04, 0.06, 0.15],
        [0.2, 0.02, 0.5, 0.18, 0.1],
        [0.01, 0.09, 0.12, 0.75, 0.03],
        [0.3, 0.07, 0.08, 0.15, 0.4],
    ]);
    let draft = draft.chain(chain, &[0.32, 0.11, 0.24, 0.28, 0.05]);
    vec![draft.sees(&[[8.9], [5.1], [9.3], [7.7]]).named(
        "chain.five-modes",
        &["sequence", "transition-order", "spread", "full-correlation"],
        "Five modes of one number: more modes than anything else there is to count, so that a loop over the wrong length, or modes in \
         another order, shows here.",
    )]
}

fn missed() -> Vec<ProblemFile> {
    let flags = ["sequence", "missed-detection", "transition-order", "full-correlation"];
    let in_a_row = [&flags[..], &["missed-in-a-row"]].concat();
    let four = || plane().sees(&PLANE_TRACK[..4]);
    vec![
        four().without(&[2]).named(
            "missed.one",
            &flags,
            "The second of four steps has no detection: the chain moves the probabilities, the last likelihood must not move them again, \
             and the prediction is the estimate.",
        ),
        radar("cubature-3")
            .filter(unscented(1.0, 0.0, -1.0))
            .sees(&RADAR_TRACK[..4])
            .without(&[2])
            .named(
            "missed.unscented",
            &[&flags[..], &["negative-weight"]].concat(),
            "A missed detection in a filter with points and a negative weight: the next points are drawn from the prediction.",
        ),
        plane().sees(&PLANE_TRACK).without(&[2, 3, 4]).named(
            "missed.several",
            &in_a_row,
            "Three of six steps in a row have no detection: estimates are mixed and predicted all the same, and uncertainty grows.",
        ),
        four().without(&[1]).named(
            "missed.first",
            &[&flags[..], &["first-step"]].concat(),
            "The very first step has no detection: there is no earlier likelihood, innovation or gain to fall back on.",
        ),
        four().without(&[4]).named(
            "missed.last",
            &flags,
            "The last step has no detection: values of the step before that are shown again show here.",
        ),
        radar("cubature-5").misses(4).named(
            "missed.all",
            &in_a_row,
            "Four steps and no detection at all: range and bearing play no part, the probabilities follow the chain, and a fifth-degree \
             filter predicts as the Kalman filter does.",
        ),
    ]
}

fn outliers() -> Vec<ProblemFile> {
    let wide = |variances: [f64; 4]| -> EstimateFile {
        estimate(
            &[121.0, 7.6, -76.0, 12.5],
            covariance(&variances, &[0.2, -0.1, 0.15, 0.25, -0.3, 0.1]),
        )
    };
    vec![
        plane()
            .sees(&[[160.0, -35.0], [9160.0, -4035.0], [181.0, -17.0]])
            .named(
                "outlier.linear",
                &["sequence", "outlier", "floor", "full-correlation"],
                "The second measurement is hundreds of standard deviations away: every likelihood is zero as a double, and only their \
                 logarithms tell which mode is the least unlikely. Likelihoods that are exponentiated before they are compared give 0/0.",
            ),
        radar("cubature-5")
            .with(|problem| {
                problem.noise = covariance(&[2.0, 0.004], &[0.3]);
                problem.initial.modes[2] = wide([6.0, 1.5, 5.0, 2.0]);
            })
            .sees(&[[197.0, -0.45], [5207.0, 0.9], [206.0, -0.27]])
            .named(
                "outlier.range-bearing",
                &["sequence", "outlier", "floor", "full-correlation"],
                "The second range and bearing are hundreds of standard deviations away, so that every likelihood is zero as a double; the \
                 third measurement is an ordinary one again, seen from an estimate that was led astray.",
            ),
    ]
}
