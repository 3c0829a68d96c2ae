//! Two modes of constant velocity in the plane that differ in their noise, with measured positions: the most common tracker.
//!
//! n = 4, m = 2, a quiet mode and a noisy one, and zeros wherever the two axes meet.

use super::draft::{Draft, estimate, map, mode, rounded, rows, square};
use immaculate::oracle::problem::{EstimateFile, ModeFile, ProblemFile, Rows};

/// The length of a step, s.
const T: f64 = 0.5;

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    let flags = ["sequence", "zeros", "spread", "transition-order"];
    let run = ["run", "zeros", "spread", "transition-order"];
    let with = |flags: &[&'static str], more: &[&'static str]| [flags, more].concat();
    vec![
        pair().sees(&TRACK[..1]).named(
            "pair.one-step",
            &["single-step", "zeros", "spread", "transition-order"],
            "One step of two modes of constant velocity, a quiet one and one that manoeuvres, with both positions measured.",
        ),
        pair().sees(&TRACK).named(
            "pair.manoeuvre",
            &run,
            "Eight steps of a quiet mode and one that manoeuvres: the target goes straight, turns and goes straight again, and the \
             probabilities follow.",
        ),
        pair().sees(&TRACK).without(&[3, 6, 7]).named(
            "pair.missed",
            &with(&run, &["missed-detection", "missed-in-a-row"]),
            "The steps of pair.manoeuvre, three of them without a detection, two in a row.",
        ),
        pair()
            .with(|problem| {
                let noise = map(&problem.modes[0].noise, |_, _, entry| entry * 1.21);
                problem.modes[1].noise = noise;
            })
            .sees(&TRACK[..4])
            .named(
                "pair.alike",
                &flags,
                "Two modes whose noises differ by a fifth: likelihoods are nearly equal, and the determinant counts as much as the distance.",
            ),
        pair()
            .chain(rows([[0.98, 0.02], [0.1, 0.9]]), &[0.999, 0.001])
            .sees(&[TRACK[0], [59.0, -31.5], [61.5, -27.0]])
            .named(
                "pair.surprised",
                &with(&flags, &["not-stationary"]),
                "The quiet mode is all but certain, and then the target is seen seven of its deviations away: one measurement turns the \
                 probabilities over.",
            ),
    ]
}

/// Eight positions, m: straight, a turn, and straight again.
const TRACK: [[f64; 2]; 8] = [
    [56.2, -43.1],
    [59.9, -41.8],
    [65.3, -40.2],
    [68.7, -36.6],
    [69.9, -31.3],
    [69.4, -26.0],
    [69.8, -20.7],
    [69.1, -14.9],
];

fn pair() -> Draft {
    let parts = vec![
        (
            constant_velocity("quiet", 0.3),
            known([51.0, 9.4, -44.5, 2.1], [2.5, 1.5]),
        ),
        (
            constant_velocity("manoeuvring", 24.0),
            known([51.6, 8.1, -44.1, 3.7], [3.0, 3.5]),
        ),
    ];
    let h = rows([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);
    Draft::new(&["x", "vx", "y", "vy"], &["m", "m/s", "m", "m/s"], parts)
        .linear(h, rows([[2.25, 0.0], [0.0, 4.0]]))
        .chain(rows([[0.95, 0.05], [0.12, 0.88]]), &[0.7, 0.3])
}

/// Constant velocity along both axes, whose acceleration is white noise of intensity q, m²/s³.
fn constant_velocity(name: &str, q: f64) -> ModeFile {
    let along = |noise: [[f64; 2]; 2]| on_both_axes(noise);
    let transition = along([[1.0, T], [0.0, 1.0]]);
    let noise = along([[q * T * T * T / 3.0, q * T * T / 2.0], [q * T * T / 2.0, q * T]]);
    mode(name, transition, noise)
}

/// An estimate whose position and velocity have these deviations, correlated by ½ along either axis.
fn known(mean: [f64; 4], [position, velocity]: [f64; 2]) -> EstimateFile {
    let both = position * velocity / 2.0;
    estimate(
        &mean,
        on_both_axes([[position * position, both], [both, velocity * velocity]]),
    )
}

/// The same two rows and columns along x and along y, and nothing between the axes.
fn on_both_axes(of_axis: [[f64; 2]; 2]) -> Rows {
    square(4, |row, column| {
        if row / 2 == column / 2 {
            rounded(of_axis[row % 2][column % 2])
        } else {
            0.0
        }
    })
}
