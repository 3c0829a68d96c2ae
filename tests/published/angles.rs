//! Angles and strongly curved measurements: where wrapping and conventions show.
//!
//! In some problems a bearing crosses ±π, with mirror images; in others the target is so near to the sensor that rules, square roots and
//! means of angles give visibly different answers.

use super::draft::{Draft, covariance, filter, map, rounded, unscented};
use super::scene::{RADAR_TRACK, radar};
use immaculate::number::Real;
use immaculate::oracle::problem::{MeasurementFile, ProblemFile};

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    [crossings(), turns(), near(), conventions()].concat()
}

/// The target west of the sensor on its way south: its bearing grows beyond π.
pub(super) fn west(rule: &str) -> Draft {
    let means = [
        [-190.0, -3.0, 45.0, -14.0],
        [-181.0, -5.4, 37.0, -11.5],
        [-198.5, -1.3, 54.0, -15.8],
    ];
    radar(rule)
        .with(|problem| {
            for (estimate, mean) in problem.initial.modes.iter_mut().zip(means) {
                estimate.mean = mean.to_vec();
            }
        })
        .sees(&[[163.0, -3.05], [160.0, -3.1], [151.0, -2.88], [164.0, -2.8]])
}

/// The mirror image: entries of the state and of the sensor's place change their signs, and every bearing becomes `bearing` of it.
pub(super) fn mirrored(draft: Draft, state: [f64; 4], sensor: [f64; 2], bearing: impl Fn(f64) -> f64) -> Draft {
    draft.with(|problem| {
        let both = |row: usize, column: usize, entry: f64| state[row] * state[column] * entry;
        for mode in &mut problem.modes {
            mode.transition = map(&mode.transition, both);
            mode.noise = map(&mode.noise, both);
        }
        for estimate in &mut problem.initial.modes {
            let mean = estimate.mean.iter().zip(state);
            estimate.mean = mean.map(|(entry, sign)| entry * sign).collect();
            estimate.covariance = estimate.covariance.as_ref().map(|rows| map(rows, both));
        }
        if let MeasurementFile::RangeBearing { sensor: place, .. } = &mut problem.measurement {
            *place = [place[0] * sensor[0], place[1] * sensor[1]];
        }
        problem.noise = map(
            &problem.noise,
            |row, column, entry| if row == column { entry } else { -entry },
        );
        for z in problem.measurements.iter_mut().filter_map(|entry| entry.z.as_mut()) {
            z[1] = z[1].map(|value| rounded(bearing(value)));
        }
    })
}

fn crossings() -> Vec<ProblemFile> {
    let flags = ["sequence", "wrap", "straddling", "full-correlation"];
    let mirror = [&flags[..], &["mirror"]].concat();
    let pi = f64::pi();
    vec![
        west("cubature-5").named(
            "wrap.counter-clockwise",
            &flags,
            "The bearing grows beyond pi while the points of every prediction lie on both sides. Raw moments of the bearings, and an \
             innovation of nearly a whole turn, are wrong by dozens of standard deviations.",
        ),
        west("cubature-3").named(
            "wrap.cubature-3",
            &flags,
            "wrap.counter-clockwise with eight points and none in the centre: bearings are averaged about that of the predicted mean, which \
             is no point's.",
        ),
        mirrored(west("cubature-5"), [1.0, 1.0, -1.0, -1.0], [1.0, -1.0], |bearing| -bearing).named(
            "wrap.clockwise",
            &mirror,
            "wrap.counter-clockwise in the mirror of the x-axis: the bearing falls below -pi. A filter that wraps on one side only shows \
             here or there.",
        ),
        mirrored(west("cubature-5"), [-1.0, -1.0, 1.0, 1.0], [-1.0, 1.0], |bearing| {
            if bearing > 0.0 { pi - bearing } else { -pi - bearing }
        })
        .named(
            "wrap.mirrored-to-zero",
            &["sequence", "mirror", "full-correlation"],
            "wrap.counter-clockwise in the mirror of the y-axis, up to the twelfth digit of the bearings: these cross 0 and nothing needs \
             to be wrapped. A filter that is right here and wrong there has its mistake in the wrapping.",
        ),
    ]
}

fn turns() -> Vec<ProblemFile> {
    let turn = 2.0 * f64::pi();
    vec![
        west("simplex-5")
            .with(|problem| {
                problem.noise = covariance(&[9.0, 0.15], &[0.3]);
                for estimate in &mut problem.initial.modes {
                    estimate.mean = vec![-190.0, -3.0, 72.0, -14.0];
                    estimate.covariance = estimate
                        .covariance
                        .as_ref()
                        .map(|rows| map(rows, |_, _, entry| 0.06 * entry));
                }
            })
            .sees(&[[160.0, -3.05]])
            .named(
                "wrap.innovation",
                &["single-step", "wrap", "full-correlation"],
                "All points lie on one side and the measurement on the other: nothing but the innovation needs to be wrapped.",
            ),
        west("simplex-5")
            .sees(&[[163.0, rounded(turn - 3.05)], [160.0, rounded(turn - 3.1)], [151.0, rounded(turn - 2.88)]])
            .named(
                "wrap.other-turn",
                &["sequence", "wrap", "straddling", "full-correlation"],
                "Measured bearings a little above pi, as a sensor gives them that counts from 0 to 2 pi: an innovation must be wrapped \
                 from wherever it is.",
            ),
    ]
}

/// The target a few standard deviations from the sensor.
fn beside() -> Draft {
    radar("cubature-5")
        .polar(
            &["range", "bearing"],
            [0, 2],
            [95.0, -25.0],
            covariance(&[5.0, 0.12], &[0.3]),
        )
        .sees(&[[57.0, -0.62], [61.0, -0.55]])
}

fn near() -> Vec<ProblemFile> {
    let flags = [
        "sequence",
        "curved",
        "rule",
        "angle-mean",
        "square-root",
        "full-correlation",
    ];
    vec![
        beside().named(
            "near.cubature-5",
            &flags,
            "The target is a few standard deviations from the sensor: range and bearing are so curved that every rule has visibly \
             another answer. Fifth-degree cubature.",
        ),
        beside().filter(filter("simplex-5")).named(
            "near.simplex-5",
            &flags,
            "The scene of near.cubature-5 with the simplex rule: another rule of the same degree, and another answer. Its points \
             change when a coordinate changes its sign or two coordinates change places.",
        ),
        beside().filter(unscented(1.0, 0.0, -1.0)).named(
            "near.unscented",
            &[&flags[..], &["negative-weight"]].concat(),
            "The scene of near.cubature-5 with unscented filters and a negative centre weight.",
        ),
    ]
}

fn conventions() -> Vec<ProblemFile> {
    let correlated = |draft: Draft| {
        draft.with(|problem| {
            for estimate in &mut problem.initial.modes {
                let correlations = [0.6, -0.55, -0.4, -0.3, -0.45, 0.5];
                estimate.covariance = Some(covariance(&[14.0, 3.0, 11.0, 2.6], &correlations));
            }
        })
    };
    vec![
        correlated(beside()).filter(filter("cubature-3")).sees(&[[57.0, -0.62]]).named(
            "convention.square-root",
            &["single-step", "square-root", "curved", "full-correlation"],
            "Strong correlations close to the sensor, and a rule that is not invariant under rotation: lower and upper Cholesky factors \
             and the symmetric root give visibly different answers. A lower factor used as if it were an upper one is wrong with any.",
        ),
        correlated(beside()).filter(filter("cubature-5")).keep(&[2]).sees(&[[57.0, -0.62]]).named(
            "convention.angle-mean",
            &["single-step", "angle-mean", "one-mode", "curved", "full-correlation"],
            "One mode close to the sensor, its points spread over more than a right angle: a mean of bearings by sine and cosine differs \
             visibly from the mean of their differences to the centre.",
        ),
        radar("cubature-3")
            .with(|problem| {
                for (estimate, shift) in problem.initial.modes.iter_mut().zip([-12.0, 16.0, 3.0]) {
                    estimate.mean[0] += shift;
                    estimate.mean[2] -= shift;
                }
            })
            .sees(&RADAR_TRACK[..2])
            .named(
                "convention.first-step",
                &["sequence", "first-step", "spread", "transition-order", "full-correlation"],
                "The initial estimates of the modes lie far apart: a filter that predicts from them at step 1 without mixing them has \
                 visibly another answer at every step.",
            ),
    ]
}
