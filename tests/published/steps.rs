//! Whole steps: one generic step for each shape and filter, and several generic steps in a row.
//!
//! Nothing is trivial and nothing is special. A filter that is right on these is right, apart from what the other files of this folder
//! test.

use super::draft::{covariance, filter, map, rows, seen, unscented};
use super::scene::{PLANE_TRACK, RADAR_TRACK, SENSOR, axis, derivatives, plane, radar, scalar};
use immaculate::oracle::problem::{MeasurementFile, ProblemFile};

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    [linear_steps(), polar_steps(), components(), several()].concat()
}

const GENERIC: [&str; 4] = ["single-step", "transition-order", "spread", "full-correlation"];

fn linear_steps() -> Vec<ProblemFile> {
    vec![
        scalar().named(
            "step.n1-m1.two-modes",
            &GENERIC,
            "One step of two Kalman filters of one number: matrices of one entry, which some languages write as numbers.",
        ),
        axis().named(
            "step.n2-m1.three-modes",
            &GENERIC,
            "One step of three Kalman filters of position and velocity with one measured number: more modes than entries of the state.",
        ),
        plane()
            .linear(rows([[0.9, 0.3, -0.4, 0.2]]), rows([[130.0]]))
            .sees(&[[152.0]])
            .named(
                "step.n4-m1.three-modes",
                &GENERIC,
                "One step of three Kalman filters of four entries with one measured number.",
            ),
        plane().keep(&[0, 1]).named(
            "step.n4-m2.two-modes",
            &[&GENERIC[..], &["row-order"]].concat(),
            "One step of two Kalman filters of four entries with two measured numbers. F, H and the chain are far from symmetric: a \
             matrix read by columns, or transposed, shows here.",
        ),
        plane().named(
            "step.n4-m2.three-modes",
            &[&GENERIC[..], &["row-order"]].concat(),
            "One step of three Kalman filters of four entries with two measured numbers: the usual size of a tracker.",
        ),
    ]
}

fn polar_steps() -> Vec<ProblemFile> {
    let flags = [&GENERIC[..], &["fresh-points"]].concat();
    vec![
        radar("cubature-3").named(
            "step.cubature-3",
            &flags,
            "One step of three third-degree cubature filters with range and bearing.",
        ),
        radar("cubature-5").named(
            "step.cubature-5",
            &flags,
            "One step of three fifth-degree cubature filters with range and bearing. At n = 4 the points on the axes have weight zero, \
             so a wrong weight of the diagonals cannot hide.",
        ),
        radar("simplex-5").named(
            "step.simplex-5",
            &flags,
            "One step of three fifth-degree simplex filters with range and bearing.",
        ),
        radar("cubature-3").filter(unscented(1.0, 0.0, -1.0)).named(
            "step.unscented",
            &[&flags[..], &["negative-weight"]].concat(),
            "One step of three unscented filters with range and bearing and a negative centre.",
        ),
        radar("gauss-hermite-3").named(
            "step.gauss-hermite-3",
            &flags,
            "One step of three Gauss-Hermite filters of 81 points with range and bearing.",
        ),
        derivatives(6, "cubature-5").named(
            "step.n6.acceleration",
            &[&flags[..], &["negative-weight"]].concat(),
            "One step of two fifth-degree filters of position, velocity and acceleration in the plane, with range and bearing.",
        ),
    ]
}

/// What the entries of z and of the state are.
fn components() -> Vec<ProblemFile> {
    let flags = [&GENERIC[..], &["components"]].concat();
    let reordered = |matrix: &Vec<Vec<f64>>| map(matrix, |row, column, _| matrix[3 - row][3 - column]);
    vec![
        radar("cubature-5").with(|problem| {
            if let MeasurementFile::RangeBearing { components, .. } = &mut problem.measurement {
                components.reverse();
            }
            problem.noise = covariance(&[0.055, 9.0], &[0.3]);
            problem.measurements[0].z = Some(seen(&[-0.41, 207.0]));
        })
        .named(
            "step.bearing-range",
            &flags,
            "The problem of step.cubature-5 with the bearing before the range: all values of the modes are the same, with the measured \
             entries exchanged. A filter that wraps a fixed entry shows here.",
        ),
        radar("cubature-5")
            .polar(&["bearing"], [0, 2], SENSOR, rows([[0.003_025]]))
            .sees(&[[-0.41]])
            .named("step.bearing-only", &flags, "Only the bearing is measured: m = 1, and the one entry is an angle."),
        radar("cubature-5")
            .polar(&["range"], [0, 2], SENSOR, rows([[81.0]]))
            .sees(&[[207.0]])
            .named("step.range-only", &flags, "Only the range is measured: m = 1, and nothing is an angle."),
        radar("simplex-5")
            .with(|problem| {
                problem.state.reverse();
                problem.units.reverse();
                for mode in &mut problem.modes {
                    mode.transition = reordered(&mode.transition);
                    mode.noise = reordered(&mode.noise);
                }
                for estimate in &mut problem.initial.modes {
                    estimate.mean.reverse();
                    estimate.covariance = estimate.covariance.as_ref().map(reordered);
                }
                if let MeasurementFile::RangeBearing { position, .. } = &mut problem.measurement {
                    *position = [3, 1];
                }
            })
            .named(
                "step.position-last",
                &flags,
                "The target of step.simplex-5 with its state backwards, vy, y, vx, x: x is entry 3 and y entry 1. The points are others, \
                 since the Cholesky factor is. Positions taken from fixed entries, or x and y exchanged, show here.",
            ),
    ]
}

fn several() -> Vec<ProblemFile> {
    let flags = ["sequence", "transition-order", "spread", "full-correlation"];
    vec![
        plane().sees(&PLANE_TRACK).named(
            "steps.kalman",
            &flags,
            "Six steps of three Kalman filters: values that are taken from the wrong step, such as mixing after prediction, show from \
             the second step on.",
        ),
        radar("cubature-5").sees(&RADAR_TRACK).named(
            "steps.cubature-5",
            &flags,
            "Six steps of three fifth-degree cubature filters with range and bearing.",
        ),
        plane().keep(&[0]).sees(&PLANE_TRACK).named(
            "steps.one-mode.kalman",
            &["sequence", "one-mode", "full-correlation"],
            "Six steps of one mode: the whole filter is a plain Kalman filter, and every probability is one.",
        ),
        radar("cubature-3").keep(&[0]).sees(&RADAR_TRACK[..4]).named(
            "steps.one-mode.cubature-3",
            &["sequence", "one-mode", "fresh-points", "full-correlation"],
            "Four steps of one mode with range and bearing: a plain cubature Kalman filter.",
        ),
        plane().filter(filter("cubature-5")).sees(&PLANE_TRACK[..3]).named(
            "steps.linear.cubature-5",
            &["sequence", "as-kalman", "transition-order", "full-correlation"],
            "The first three steps of steps.kalman with fifth-degree cubature filters: the same values to the last digit, since all is \
             linear. An error of the points that one step hides grows here.",
        ),
    ]
}
