//! Measurements with a missing entry, and estimates and measurements that are exact in a direction: problems of format 2.
//!
//! Neither needs another equation: a measurement has the remaining rows, and only the innovation covariance must be definite.

use super::draft::{Draft, filter, map, rows, unscented};
use super::scene::{PLANE_TRACK, RADAR_TRACK, axis, plane, radar};
use immaculate::oracle::problem::{FORMAT_2, FilterFile, ProblemFile, Rows};

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    [missing(), exact()].concat()
}

impl Draft {
    /// These entries, by step from 1 and place from 0, are missing.
    fn lacks(self, entries: &[(usize, usize)]) -> Self {
        self.in_format_2().with(|problem| {
            for &(step, row) in entries {
                if let Some(z) = &mut problem.measurements[step - 1].z {
                    z[row] = None;
                }
            }
        })
    }

    fn in_format_2(self) -> Self {
        self.with(|problem| problem.format = FORMAT_2.into())
    }
}

fn missing() -> Vec<ProblemFile> {
    let flags = ["sequence", "missing-entry", "transition-order", "full-correlation"];
    let with_points = [&flags[..], &["row-order"]].concat();
    let radar = |filter| radar("cubature-3").filter(filter).sees(&RADAR_TRACK[..4]);
    vec![
        plane().sees(&PLANE_TRACK[..4]).lacks(&[(1, 0), (3, 1)]).named(
            "missing.kalman",
            &flags,
            "The first of four measurements lacks its first entry, the third its second: what is there is used with its own rows of H \
             and R, and the constant of the likelihood is that of one number.",
        ),
        radar(FilterFile::Extended { iterations: None }).lacks(&[(2, 1)]).named(
            "missing.extended",
            &with_points,
            "An extended filter whose second measurement is a range alone.",
        ),
        radar(FilterFile::Extended { iterations: None }).lacks(&[(1, 0), (4, 1)]).named(
            "missing.extended.either",
            &with_points,
            "An extended filter that has a bearing alone in its first measurement, and a range alone in its last.",
        ),
        radar(filter("cubature-3")).lacks(&[(1, 0)]).named(
            "missing.cubature-3",
            &with_points,
            "A cubature filter whose first measurement is a bearing alone.",
        ),
        radar(unscented(1.0, 0.0, -1.0)).lacks(&[(2, 0), (3, 1)]).named(
            "missing.unscented",
            &[&with_points[..], &["negative-weight"]].concat(),
            "An unscented filter that has a bearing in one step, and a range in the next.",
        ),
    ]
}

fn exact() -> Vec<ProblemFile> {
    let flags = ["sequence", "exact"];
    let one = [&flags[..], &["one-mode", "zeros"]].concat();
    let axis = || axis().sees(&[[54.0], [57.5]]).in_format_2();
    let radar = |filter| radar("cubature-3").filter(filter).sees(&RADAR_TRACK[..2]).in_format_2();
    vec![
        axis()
            .with(|problem| {
                problem.initial.modes[0].covariance = Some(rows([[0.0, 0.0], [0.0, 2.25]]));
                problem.initial.modes[1].covariance = Some(rows([[36.0, -12.0], [-12.0, 4.0]]));
            })
            .named(
                "exact.initial.kalman",
                &[&flags[..], &["transition-order", "spread", "zeros"]].concat(),
                "One mode knows its position at the beginning and not its velocity, another only a combination of both: covariances of \
                 rank one, whose innovations have definite ones all the same.",
            ),
        plane()
            .sees(&PLANE_TRACK[..2])
            .in_format_2()
            .with(|problem| problem.noise = rows([[121.0, 33.0], [33.0, 9.0]]))
            .named(
                "exact.measurement.kalman",
                &[&flags[..], &["transition-order", "spread", "row-order", "full-correlation"]].concat(),
                "The noise of two measured numbers is one and the same, up to a factor: R has rank one, and a combination is measured exactly.",
            ),
        radar(FilterFile::Extended { iterations: None })
            .keep(&[1])
            .with(|problem| problem.noise = rows([[0.0, 0.0], [0.0, 0.003]]))
            .named(
                "exact.measurement.extended",
                &one,
                "A range without noise beside a bearing that has some: R has a row of zeros, and the updated covariance is singular.",
            ),
        radar(filter("cubature-3"))
            .keep(&[0])
            .with(|problem| {
                let covariance = &mut problem.initial.modes[0].covariance;
                let cleared = |rows: &Rows| map(rows, |i, j, entry| if i * j == 0 { 0.0 } else { entry });
                *covariance = covariance.as_ref().map(cleared);
            })
            .named(
                "exact.initial.cubature-3",
                &one,
                "One entry of the state is known at the beginning: points do not leave it until the motion takes it along.",
            ),
        radar(unscented(1.0, 0.0, 1.0))
            .keep(&[2])
            .with(|problem| problem.noise = rows([[0.0, 0.0], [0.0, 0.003]]))
            .named(
                "exact.measurement.unscented",
                &one,
                "A range without noise in a filter with points: that the measurement is curved leaves its innovation a variance.",
            ),
    ]
}
