//! Single equations: problems in which every equation but one is trivial.
//!
//! Mixing: nothing moves and nothing is detected. Likelihood: the Markov chain stays where it is, so that only likelihoods move the
//! probabilities. Combination: the chain stays, nothing moves, nothing is detected. Update: there is one mode.

use super::draft::{Draft, covariance, estimate, filter, identity, mode, rows, unscented};
use super::scene::{PLANE_TRACK, axis, plane, scalar};
use immaculate::oracle::problem::{FilterFile, ProblemFile};

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    [mixing(), likelihood(), combination(), updates()].concat()
}

fn mixing() -> Vec<ProblemFile> {
    let copy_means = |draft: Draft| {
        draft.with(|problem| {
            let mean = problem.initial.modes[0].mean.clone();
            problem
                .initial
                .modes
                .iter_mut()
                .for_each(|mode| mode.mean.clone_from(&mean));
        })
    };
    let copy_covariances = |draft: Draft| {
        draft.with(|problem| {
            let covariance = problem.initial.modes[0].covariance.clone();
            let modes = problem.initial.modes.iter_mut();
            modes.for_each(|mode| mode.covariance.clone_from(&covariance));
        })
    };
    vec![
        axis().keep(&[0, 1]).still().misses(1).named(
            "mixing.two-modes",
            &["single-equation", "mixing", "spread", "transition-order", "full-correlation"],
            "Nothing moves and nothing is detected: the step is one mixing of two estimates. A transposed transition matrix, weights of \
             another mode or a spread about the wrong mean show in the mixed estimates.",
        ),
        plane().still().misses(1).named(
            "mixing.three-modes",
            &["single-equation", "mixing", "spread", "transition-order", "full-correlation"],
            "Nothing moves and nothing is detected: the step is one mixing of three estimates of four entries, under a chain that is not \
             doubly stochastic. Modes in the wrong order and probabilities divided by the wrong sum show here.",
        ),
        copy_means(plane().still()).misses(1).named(
            "mixing.equal-means",
            &["single-equation", "mixing", "transition-order", "full-correlation"],
            "As mixing.three-modes, but all means are equal: there is no spread, and a filter that mixes means and not covariances is \
             seen by its covariances alone.",
        ),
        copy_covariances(plane().still()).misses(1).named(
            "mixing.equal-covariances",
            &["single-equation", "mixing", "spread", "transition-order", "full-correlation"],
            "As mixing.three-modes, but all covariances are equal: what a mixed covariance has beyond the common one is the spread of \
             the means, so an omitted spread, or one about the wrong mean, is seen by itself.",
        ),
    ]
}

/// Two modes that stand still, with S of the second four times and ν twice that of the first.
fn equal_distance_of_two() -> Draft {
    let part = |name, q, mean: [f64; 2], p| (mode(name, identity(2), rows(q)), estimate(&mean, rows(p)));
    let parts = vec![
        part(
            "sure",
            [[0.5, 0.25], [0.25, 0.5]],
            [5.0, -4.0],
            [[2.5, 0.75], [0.75, 2.5]],
        ),
        part(
            "unsure",
            [[3.0, 1.0], [1.0, 2.5]],
            [3.0, -5.0],
            [[15.0, 4.5], [4.5, 12.5]],
        ),
    ];
    Draft::new(&["x", "y"], &["m", "m"], parts)
        .linear(identity(2), rows([[2.0, 0.5], [0.5, 1.0]]))
        .chain(identity(2), &[0.7, 0.3])
        .sees(&[[7.0, -3.0]])
}

fn likelihood() -> Vec<ProblemFile> {
    let part = |name, q, mean, p| (mode(name, identity(1), rows([[q]])), estimate(&[mean], rows([[p]])));
    let scalars = vec![part("sure", 1.0, 8.0, 2.0), part("unsure", 5.0, 6.0, 10.0)];
    let stays = |draft: Draft| draft.chain(identity(3), &[0.5, 0.3, 0.2]);
    vec![
        Draft::new(&["x"], &["m"], scalars)
            .linear(identity(1), identity(1))
            .chain(identity(2), &[0.7, 0.3])
            .sees(&[[10.0]])
            .named(
                "likelihood.equal-distance.scalar",
                &["single-equation", "likelihood", "determinant", "full-correlation"],
                "S is 4 in one mode and 16 in the other, and the Mahalanobis distance exactly 1 in both: the likelihoods differ by the \
                 determinant alone, ln 2, and a likelihood without it changes no probability.",
            ),
        equal_distance_of_two().named(
            "likelihood.equal-distance.plane",
            &["single-equation", "likelihood", "determinant", "full-correlation"],
            "Two measured entries; S of one mode is four times that of the other and the Mahalanobis distances are equal: the \
             likelihoods differ by ln 4. A determinant that is left out, or raised to -m/2 for -1/2, shows here.",
        ),
        stays(plane())
            .with(|problem| {
                let modes = problem.modes.clone();
                let covariance = problem.initial.modes[0].covariance.clone();
                for (mode, estimate) in problem.modes.iter_mut().zip(&mut problem.initial.modes) {
                    mode.transition.clone_from(&modes[0].transition);
                    mode.noise.clone_from(&modes[0].noise);
                    estimate.covariance.clone_from(&covariance);
                }
            })
            .named(
                "likelihood.equal-covariances",
                &["single-equation", "likelihood", "full-correlation"],
                "All modes have the same S and different innovations: the likelihoods differ by their Mahalanobis distances alone. A \
                 likelihood of the residual after the update, or with its covariance, shows here.",
            ),
        stays(plane()).named(
            "likelihood.generic",
            &["single-equation", "likelihood", "determinant", "full-correlation"],
            "Three modes, all generic, but the chain stays where it is: every mode starts from its own estimate, and only likelihoods \
             move the probabilities.",
        ),
        stays(plane()).sees(&[[-20.0, 150.0]]).named(
            "likelihood.small",
            &["single-equation", "likelihood", "floor", "full-correlation"],
            "A measurement more than ten standard deviations away: the likelihoods are far below a common floor of 1e-12 and far above \
             the least double. Their ratio decides, and a floor under likelihoods makes them equal.",
        ),
        stays(plane()).sees(&[[-246.8, 432.6]]).named(
            "likelihood.vanishing",
            &["single-equation", "likelihood", "floor", "full-correlation"],
            "One likelihood is 1e-278, one 1e-307, between a floor of 1e-300 and the least normal double, and one 1e-374, below every \
             double. Floors of different height are told apart, and from a likelihood that is zero.",
        ),
    ]
}

fn combination() -> Vec<ProblemFile> {
    vec![
        plane().still().chain(identity(3), &[0.5, 0.3, 0.2]).misses(1).named(
            "combination.three-modes",
            &["single-equation", "combination", "spread", "full-correlation"],
            "The chain stays, nothing moves and nothing is detected: every mode keeps its own estimate, and what is left is the \
             combination of three estimates, with the spread of their means.",
        ),
        plane()
            .chain(rows([[0.2, 0.3, 0.5], [0.6, 0.3, 0.1], [0.5, 0.1, 0.4]]), &[0.9, 0.06, 0.04])
            .sees(&[[170.0, -90.0]])
            .named(
                "combination.turned-over",
                &["combination", "spread", "single-step", "transition-order", "full-correlation"],
                "The chain and then the likelihoods turn the probabilities over, so that old, predicted and updated ones are three very \
                 different lists: the combined prediction wants the second and the combined estimate the third.",
            ),
        scalar().misses(1).named(
            "combination.scalar",
            &["combination", "spread", "single-step", "missed-detection", "full-correlation"],
            "The smallest problem there is: one entry of the state, two modes, no detection. Every value can be checked by hand.",
        ),
    ]
}

fn updates() -> Vec<ProblemFile> {
    let one = || plane().keep(&[1]).sees(&PLANE_TRACK[..1]);
    let of = |id: &str, filter: FilterFile, weights: &[&str], about: &str| {
        let flags = [
            &["single-equation", "update", "one-mode", "row-order", "full-correlation"],
            weights,
        ]
        .concat();
        one().filter(filter).named(id, &flags, about)
    };
    vec![
        of(
            "update.kalman",
            filter("kalman"),
            &[],
            "One step of a plain Kalman filter: all is trivial but prediction and update. R or Q left out, doubled or added in the wrong \
             place, and matrices read by columns show here.",
        ),
        of(
            "update.cubature-3",
            filter("cubature-3"),
            &["as-kalman"],
            "The problem of update.kalman with the third-degree rule. On a linear problem it is the Kalman filter, to the last digit; if \
             it is not, a weight, the square root or a noise is wrong.",
        ),
        of(
            "update.cubature-5",
            filter("cubature-5"),
            &["as-kalman"],
            "The problem of update.kalman with the fifth-degree rule, of which it is the Kalman filter still. The weight that zhu2016 \
             prints for the points on the diagonals, twice the right one, shows here.",
        ),
        of(
            "update.simplex-5",
            filter("simplex-5"),
            &["as-kalman"],
            "The problem of update.kalman with the simplex rule, of which it is the Kalman filter still. The weights that liu2017 prints \
             in (11) and (16) show here.",
        ),
        of(
            "update.unscented",
            unscented(1.0, 0.0, -1.0),
            &["as-kalman", "negative-weight"],
            "The problem of update.kalman with the unscented rule, kappa = 3 - n = -1: a centre of weight -1/3 must give the Kalman \
             filter all the same.",
        ),
        of(
            "update.gauss-hermite-3",
            filter("gauss-hermite-3"),
            &["as-kalman"],
            "The problem of update.kalman with the Gauss-Hermite rule of three nodes, 81 points: the Kalman filter again.",
        ),
        scaled_update(),
    ]
}

/// A small linear problem for an unscented filter with all three parameters.
fn scaled_update() -> ProblemFile {
    Draft::new(
            &["x", "vx"],
            &["m", "m/s"],
            vec![(
                mode("glide", rows([[1.01, 0.98], [-0.02, 0.97]]), covariance(&[1.4, 0.6], &[0.3])),
                estimate(&[40.0, 6.0], covariance(&[4.0, 1.5], &[0.4])),
            )],
        )
        .linear(rows([[1.0, 0.2]]), rows([[21.0]]))
        .chain(identity(1), &[1.0])
        .sees(&[[54.0]])
        .filter(unscented(0.5, 2.0, 0.0))
        .named(
            "update.unscented.scaled",
            &["single-equation", "update", "one-mode", "as-kalman", "negative-weight", "full-correlation"],
            "Position and velocity on a line with the scaled unscented rule, alpha = 0.5 and beta = 2: on a linear problem the three \
             parameters cancel, beta too, since it weighs the centre only, whose difference from the mean is zero.",
        )
}
