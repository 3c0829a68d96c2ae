//! Modes with different states: constant velocity in the plane beside a turn that has speed, heading and turn rate.
//!
//! Estimates are converted before they are mixed and combined.

use super::draft::{covariance, rows, square};
use immaculate::oracle::problem::{FORMAT_2, ProblemFile, Rows};
use serde_json::{Value, json};

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    [curved(), linear()].concat()
}

/// A covariance among the first entries of five; the last one is not there.
fn of_four(deviations: &[f64], correlations: &[f64]) -> Rows {
    let four = covariance(deviations, correlations);
    square(
        5,
        |row, column| if row < 4 && column < 4 { four[row][column] } else { 0.0 },
    )
}

/// A target that heads west: its heading is near the cut at π, above in the turn's estimate and below in the velocity of the other.
fn turning(id: &str, filter: &Value, more: &[&str], about: &str, changes: &Value) -> ProblemFile {
    let flags = [
        "sequence",
        "missed-detection",
        "formulas",
        "state-angle",
        "spread",
        "zeros",
        "embedded",
        "states",
    ];
    let flags = [&flags[..], more].concat();
    let five = [0.25, -0.2, 0.15, 0.3, 0.1, -0.25, 0.2, -0.15, 0.3, 0.12];
    let four = [-0.25, 0.2, 0.3, -0.18, 0.1, 0.22];
    let mut problem = json!({
        "format": FORMAT_2,
        "id": id,
        "about": about,
        "flags": flags,
        "state": [["x", "m"], ["y", "m"], ["vx", "m/s"], ["vy", "m/s"], ["none", "1"]],
        "parameters": { "T": 0.8 },
        "modes": [
            {
                "name": "straight",
                "F": [[1, 0, 0.8, 0, 0], [0, 1, 0, 0.8, 0], [0, 0, 1, 0, 0], [0, 0, 0, 1, 0], [0, 0, 0, 0, 0]],
                "Q": of_four(&[0.4, 0.3, 0.5, 0.6], &four)
            },
            {
                "name": "turn",
                "state": [["x", "m"], ["y", "m"], ["v", "m/s"], ["heading", "rad", "angle"], ["w", "rad/s"]],
                "let": [["a", "w*T"], ["ahead", "v*T*c1(a^2)"], ["aside", "v*T*a*c2(a^2)"]],
                "f": [
                    "x + ahead*cos(heading) - aside*sin(heading)", "y + ahead*sin(heading) + aside*cos(heading)", "v", "heading + a", "w"
                ],
                "Q": covariance(&[0.3, 0.4, 0.5, 0.06, 0.08], &five)
            }
        ],
        "conversions": [
            {
                "from": "straight", "to": "turn",
                "formulas": ["x", "y", "hypot(vx, vy)", "atan2(vy, vx)", "0"],
                "added": square(5, |row, column| if (row, column) == (4, 4) { 0.09 } else { 0.0 })
            },
            { "from": "turn", "to": "straight", "formulas": ["x", "y", "v*cos(heading)", "v*sin(heading)", "0"] },
            { "from": "turn", "formulas": ["x", "y", "v*cos(heading)", "v*sin(heading)", "0"] }
        ],
        "measurement": { "kind": "range-bearing", "components": ["range", "bearing"], "position": [0, 1], "sensor": [-30, -25] },
        "R": covariance(&[0.9, 0.03], &[0.3]),
        "filter": filter,
        "transition": [[0.85, 0.15], [0.3, 0.7]],
        "initial": {
            "mode_probabilities": [0.45, 0.55],
            "modes": [
                { "mean": [20, 3, -6, -0.4, 0], "covariance": of_four(&[1.6, 1.2, 0.8, 0.7], &[0.3, -0.2, 0.15, 0.1, 0.35, -0.25]) },
                { "mean": [20.5, 2.6, 5.5, 3.05, 0.2], "covariance": covariance(&[1.3, 1.7, 0.6, 0.15, 0.12], &five) }
            ]
        },
        "conventions": {
            "square_root": "cholesky-lower", "angle_mean": "centre-point", "first_step": "mixed", "log_likelihood": "full",
            "state_angle_mean": "reference"
        },
        "measurements": [
            { "step": 1, "z": [53.6, 0.54] },
            { "step": 2, "z": [49.2, 0.57] },
            { "step": 3, "z": null },
            { "step": 4, "z": [40.5, 0.62] },
            { "step": 5, "z": [35.8, 0.6] }
        ]
    });
    for (key, value) in changes.as_object().into_iter().flatten() {
        problem[key] = value.clone();
    }
    serde_json::from_value(problem).expect("a problem of the program")
}

fn curved() -> Vec<ProblemFile> {
    let in_the_plane = json!({
        "measurement": { "kind": "linear", "H": [[1, 0, 0, 0, 0], [0, 1, 0, 0, 0]] },
        "R": covariance(&[0.9, 0.7], &[0.2]),
        "measurements": [
            { "step": 1, "z": [15.9, 2.5] },
            { "step": 2, "z": [11.2, 1.6] },
            { "step": 3, "z": null },
            { "step": 4, "z": [2.4, -1.9] },
            { "step": 5, "z": [-0.6, -4.7] }
        ]
    });
    vec![
        turning(
            "states.extended",
            &json!({ "kind": "extended" }),
            &[],
            "Constant velocity in x, y, vx, vy beside a turn in x, y, speed, heading, turn rate, with extended filters. Each reads the other's \
             estimate by a conversion: the mean by its formulas, the covariance by their slopes, and what constant velocity does not know of \
             the turn rate is added. Estimates that are mixed as they stand, or without their Jacobian, show here.",
            &json!({}),
        ),
        turning(
            "states.cubature-3",
            &json!({ "kind": "cubature", "rule": "cubature-3" }),
            &[],
            "The steps of states.extended with points, which the turn measures through its conversion to the common state. Conversions are by \
             slopes all the same.",
            &json!({}),
        ),
        turning(
            "states.position",
            &json!({ "kind": "extended" }),
            &[],
            "The target of states.extended with its position measured: H of the turn is the matrix times the slopes of its conversion.",
            &in_the_plane,
        ),
    ]
}

/// Modes whose states are matrices of each other, but for what one does not know.
fn linear() -> Vec<ProblemFile> {
    let first = covariance(&[4.0, 1.1, 5.0], &[0.3, -0.2, 0.15]);
    let second = covariance(&[3.0, 1.4, 2.5], &[-0.25, 0.2, 0.3]);
    let third = covariance(&[3.5, 0.9, 4.0], &[0.2, 0.35, -0.15]);
    let forth = rows([[0.6, 0.8, 0.2], [-0.8, 0.6, 0.1], [0.3, -0.1, 0.9]]);
    let back = rows([[0.7, -0.9, -0.1], [0.9, 0.6, -0.2], [-0.1, 0.4, 1.2]]);
    let problem = json!({
        "format": FORMAT_2,
        "id": "states.kalman",
        "about": "Three modes with Kalman filters, the second in coordinates of its own: it is converted by a matrix to be mixed for the others, by \
                  formulas with an offset to be combined, and nothing is the inverse of anything. The sensor sees it through that conversion.",
        "flags": ["sequence", "full-correlation", "spread", "transition-order", "row-order", "states"],
        "state": ["x", "vx", "b"],
        "parameters": { "shift": 2.5 },
        "modes": [
            { "name": "first", "F": [[1, 0.5, 0.1], [-0.2, 0.9, 0.3], [0.1, 0.2, 0.8]], "Q": covariance(&[1.0, 0.7, 1.2], &[0.3, -0.2, 0.1]) },
            {
                "name": "own",
                "state": ["p", "q", "s"],
                "F": [[0.9, -0.3, 0.2], [0.4, 1.1, -0.1], [0.2, 0.1, 0.7]],
                "Q": covariance(&[0.8, 1.1, 0.9], &[-0.25, 0.15, 0.35])
            },
            { "name": "third", "F": [[0.8, 0.2, -0.3], [0.3, 1, 0.1], [-0.1, 0.4, 0.9]], "Q": covariance(&[1.3, 0.6, 0.5], &[0.2, 0.1, -0.3]) }
        ],
        "conversions": [
            { "from": "first", "to": "own", "matrix": forth, "added": covariance(&[1.5, 0.8, 1.1], &[0.2, -0.3, 0.25]) },
            { "from": "third", "to": "own", "matrix": forth },
            { "from": "own", "to": "first", "matrix": back },
            { "from": "own", "to": "third", "matrix": back, "added": covariance(&[0.7, 1.2, 0.6], &[0.1, 0.3, -0.2]) },
            { "from": "own", "formulas": ["0.7*p - 0.9*q + shift", "0.9*p + 0.6*q - 0.2*s", "1.2*s - 0.1*p - shift"] }
        ],
        "measurement": { "kind": "linear", "H": [[1.1, 0.3, -0.2], [0.2, -0.5, 0.9]] },
        "R": covariance(&[2.0, 1.5], &[0.3]),
        "filter": { "kind": "kalman" },
        "transition": [[0.8, 0.15, 0.05], [0.25, 0.6, 0.15], [0.1, 0.3, 0.6]],
        "initial": {
            "mode_probabilities": [0.5, 0.3, 0.2],
            "modes": [
                { "mean": [12, -3, 5], "covariance": first },
                { "mean": [7, -10, 8], "covariance": second },
                { "mean": [10, -1.5, 7], "covariance": third }
            ]
        },
        "measurements": [{ "step": 1, "z": [9.5, 8.4] }, { "step": 2, "z": [11.2, 5.1] }, { "step": 3, "z": [8.7, 9.9] }]
    });
    vec![serde_json::from_value(problem).expect("a problem of the program")]
}
