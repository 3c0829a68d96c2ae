//! The rules: one step of one mode with range and bearing, for each rule and dimension.
//!
//! They isolate the points and weights of a rule. The target is so near that the measurement is curved over the width of its estimate, and
//! so every rule has its own answer.

use super::draft::{Draft, filter, unscented};
use super::scene::{buoy, derivatives, radar, scalar};
use immaculate::oracle::problem::{FilterFile, ProblemFile};

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    let mut all = Vec::new();
    for (name, rule, about) in RULES {
        all.extend([
            two(name, filter(rule), &[], about),
            four(name, filter(rule), &[], about),
        ]);
    }
    all.extend([
        two(
            "unscented",
            unscented(1.0, 0.0, 1.0),
            &[],
            "The unscented rule with kappa = 3 - n = 1 and a positive centre",
        ),
        four(
            "unscented",
            unscented(1.0, 0.0, -1.0),
            &["negative-weight"],
            "The unscented rule with kappa = 3 - n = -1 and a negative centre",
        ),
    ]);
    for (name, alpha, flags, about) in SCALED {
        all.extend([
            two(name, unscented(alpha, 2.0, 0.0), flags, about),
            four(name, unscented(alpha, 2.0, 0.0), flags, about),
        ]);
    }
    all.push(buoy().filter(filter("gauss-hermite-5")).named(
        "rule.gauss-hermite-5.n2",
        &["single-equation", "rule", "one-mode", "full-correlation"],
        "The Gauss-Hermite rule of five nodes, 25 points whose coordinates are nested roots: the nearest to the exact moments of the \
         problems rule.*.n2.",
    ));
    all.push(scalar().keep(&[1]).filter(unscented(1.0, 0.0, 2.0)).named(
        "rule.unscented.n1",
        &["single-equation", "rule", "one-mode", "as-kalman", "full-correlation"],
        "The unscented rule in one dimension, kappa = 3 - n = 2: three points, the nodes of Gauss and Hermite. The measurement is \
         linear, and the answer that of a Kalman filter.",
    ));
    all.extend(negative_weights());
    all
}

/// Rules without parameters: name in the id, name of the rule, what it is.
const RULES: [(&str, &str, &str); 4] = [
    ("cubature-3", "cubature-3", "The third-degree rule, 2n points"),
    ("cubature-5", "cubature-5", "The fifth-degree rule, 2n^2 + 1 points"),
    (
        "simplex-5",
        "simplex-5",
        "The fifth-degree simplex rule, n^2 + 3n + 3 points",
    ),
    (
        "gauss-hermite-3",
        "gauss-hermite-3",
        "The Gauss-Hermite rule of three nodes, 3^n points",
    ),
];

/// Scaled unscented rules: name in the id, alpha, flags, what it is.
const SCALED: [(&str, f64, &[&str], &str); 2] = [
    (
        "unscented-scaled",
        0.5,
        &["negative-weight"],
        "The scaled unscented rule with alpha = 0.5, beta = 2 and kappa = 0, whose centre has another weight for covariances than for \
         means",
    ),
    (
        "unscented-narrow",
        1e-3,
        &["negative-weight", "cancellation"],
        "The scaled unscented rule with alpha = 0.001, beta = 2 and kappa = 0: weights of a million that nearly cancel, and cost half \
         of the digits",
    ),
];

/// A rule in two dimensions.
fn two(name: &str, filter: FilterFile, flags: &[&str], about: &str) -> ProblemFile {
    let flags = [&["single-equation", "rule", "one-mode", "full-correlation"], flags].concat();
    let about = format!(
        "{about}; a position in the plane, seen from near by. Wrong weights or points, degrees for radians and the wrong triangle of \
         the Cholesky factor show here."
    );
    buoy().filter(filter).named(&format!("rule.{name}.n2"), &flags, &about)
}

/// A rule in four dimensions.
fn four(name: &str, filter: FilterFile, flags: &[&str], about: &str) -> ProblemFile {
    let flags = [
        &[
            "single-equation",
            "rule",
            "one-mode",
            "fresh-points",
            "full-correlation",
        ],
        flags,
    ]
    .concat();
    let about = format!(
        "{about}; position and velocity in the plane. Q is large, so that points which are not drawn afresh from the prediction show \
         here, as do wrong weights."
    );
    radar("cubature-3")
        .keep(&[2])
        .filter(filter)
        .named(&format!("rule.{name}.n4"), &flags, &about)
}

fn negative_weights() -> Vec<ProblemFile> {
    let one = |n, rule| -> Draft { derivatives(n, rule).keep(&[0]) };
    let negative = [
        "single-equation",
        "rule",
        "one-mode",
        "negative-weight",
        "full-correlation",
    ];
    let positive = ["single-equation", "rule", "one-mode", "full-correlation"];
    vec![
        one(5, "cubature-5").named(
            "rule.cubature-5.n5",
            &negative,
            "Five entries of the state: the first dimension in which the fifth-degree rule has negative weights, (4 - n)/(2(n + 2)^2) \
             for the points on the axes.",
        ),
        one(8, "cubature-5").named(
            "rule.cubature-5.n8",
            &negative,
            "Eight entries of the state: the fifth-degree rule's weights on the axes sum to -0.32, and a filter that takes their roots \
             fails.",
        ),
        one(5, "simplex-5").named(
            "rule.simplex-5.n5",
            &positive,
            "Five entries of the state, an odd number: the simplex rule's weights are all positive here, where those of the other \
             fifth-degree rule are not.",
        ),
        one(8, "simplex-5").named(
            "rule.simplex-5.n8",
            &negative,
            "Eight entries of the state: the first dimension in which the simplex rule has negative weights, \
             (7 - n)n^2/(2(n + 1)^2(n + 2)^2) for the vertices.",
        ),
    ]
}
