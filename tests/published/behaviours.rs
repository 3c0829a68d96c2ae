//! Problems for every kind of filter: one for each behaviour and kind without a problem elsewhere, made from the kind's scene.
//!
//! Each behaviour is the same change of a scene, whatever the filter.

use super::angles::{mirrored, west};
use super::converted::converted;
use super::draft::{Draft, covariance, map, rounded, rows, unscented};
use super::extended::{changing, extended, in_kilometres};
use super::fixed_gain::{MIXED, plane_with_gains};
use super::numbers::scaled;
use super::runs::liu2017_run;
use super::scene::{PLANE_TRACK, RADAR_TRACK, plane, radar};
use immaculate::model::Conversion;
use immaculate::oracle::models::ModelParameters;
use immaculate::oracle::problem::{FORMAT_2, FilterFile, MeasurementFile, ProblemFile, Rows, SensorFile};

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    [
        wraps(),
        outliers(),
        unreachable(),
        units(),
        runs(),
        steps(),
        sensors(),
        inputs(),
    ]
    .concat()
}

/// A kind of filter by the name of its problems, with its scene of a number of steps, and the flags of that scene.
fn scene(kind: &'static str, steps: usize) -> (Draft, Vec<&'static str>) {
    let seen = |draft: Draft| draft.sees(&RADAR_TRACK[..steps]);
    let in_plane = |draft: Draft| draft.sees(&PLANE_TRACK[..steps]);
    match kind {
        "kalman" => (in_plane(plane()), vec!["full-correlation"]),
        "extended" => (extended(seen(radar("cubature-3"))), vec!["full-correlation"]),
        "cubature-3" => (seen(radar("cubature-3")), vec!["full-correlation"]),
        "unscented" => (
            seen(radar("cubature-3").filter(unscented(1.0, 0.0, -1.0))),
            vec!["full-correlation", "negative-weight"],
        ),
        "converted" => (
            seen(converted(Conversion::Standard, [9.0, 0.055])),
            vec!["converted", "zeros"],
        ),
        _ => (
            in_plane(plane_with_gains(MIXED)),
            vec!["full-correlation", "fixed-gain"],
        ),
    }
}

/// A problem of each of these kinds: its scene, changed, with the flags of the behaviour.
fn each(
    kinds: &[&'static str],
    steps: usize,
    behaviour: &str,
    flags: &[&str],
    about: &str,
    change: impl Fn(Draft) -> Draft,
) -> Vec<ProblemFile> {
    let of_kind = |&kind: &&'static str| {
        let (draft, own) = scene(kind, steps);
        let flags = [&["sequence"], flags, &own].concat();
        change(draft).named(
            &format!("{behaviour}.{kind}"),
            &flags,
            &format!("{} filters. {about}", spoken(kind)),
        )
    };
    kinds.iter().map(of_kind).collect()
}

/// A kind of filter at the beginning of a sentence.
fn spoken(kind: &str) -> &'static str {
    match kind {
        "kalman" => "Kalman",
        "extended" => "Extended",
        "cubature-3" => "Cubature",
        "unscented" => "Unscented",
        "converted" => "Converted-measurement",
        _ => "Fixed-gain",
    }
}

fn in_format_2(draft: Draft) -> Draft {
    draft.with(|problem| problem.format = FORMAT_2.into())
}

fn wraps() -> Vec<ProblemFile> {
    let flags = ["sequence", "wrap", "straddling", "full-correlation", "negative-weight"];
    let west = || west("cubature-3").filter(unscented(1.0, 0.0, -1.0));
    vec![
        west().named(
            "wrap.unscented.counter-clockwise",
            &flags,
            "wrap.counter-clockwise with unscented filters, whose centre point has a negative weight: the bearing grows beyond pi.",
        ),
        mirrored(west(), [1.0, 1.0, -1.0, -1.0], [1.0, -1.0], |bearing| -bearing).named(
            "wrap.unscented.clockwise",
            &[&flags[..], &["mirror"]].concat(),
            "wrap.unscented.counter-clockwise in the mirror of the x-axis: the bearing falls below -pi.",
        ),
    ]
}

fn outliers() -> Vec<ProblemFile> {
    let far = |draft: Draft| {
        draft.with(|problem| {
            problem.measurements[1].z = match problem.measurement {
                MeasurementFile::Linear { .. } => Some(vec![Some(9160.0), Some(-4035.0)]),
                _ => Some(vec![Some(5207.0), Some(0.9)]),
            };
        })
    };
    each(
        &["unscented", "converted", "fixed-gain"],
        3,
        "outlier",
        &["outlier", "floor"],
        "The second measurement is so far away that every likelihood is zero as a double; their logarithms tell which mode is the least \
         unlikely.",
        far,
    )
}

fn unreachable() -> Vec<ProblemFile> {
    let chain = || rows([[0.8, 0.2, 0.0], [0.35, 0.65, 0.0], [0.6, 0.4, 0.0]]);
    each(
        &["cubature-3", "unscented", "converted", "fixed-gain"],
        3,
        "unreachable",
        &["unreachable", "transition-order"],
        "No mode leads to the third, itself included. By convention it keeps its own estimate; a filter that divides by zero gives NaN.",
        |draft| draft.chain(chain(), &[0.5, 0.3, 0.2]),
    )
}

fn units() -> Vec<ProblemFile> {
    let of_kind = |kind: &'static str, noise: &Rows, about: &str| {
        let (draft, own) = scene(kind, 3);
        let flags = [&["sequence", "units"][..], &own].concat();
        let about = format!("{} filters. {about}", spoken(kind));
        in_kilometres(draft, noise.clone()).named(&format!("units.{kind}"), &flags, &about)
    };
    let correlated = covariance(&[0.009, 0.055], &[0.3]);
    let about =
        "The radar's target in kilometres: covariances are a million times as small, and those of the bearing are not.";
    let (gains, own) = scene("fixed-gain", 3);
    let gains = scaled(gains, [1e9; 4], 1e9).with(|problem| {
        if let FilterFile::FixedGain { modes, .. } = &mut problem.filter {
            for mode in modes {
                mode.innovation_covariance = map(&mode.innovation_covariance, |_, _, entry| entry * 1e18);
            }
        }
        problem.units = ["nm", "nm/s", "nm", "nm/s"].map(str::to_owned).to_vec();
    });
    vec![
        of_kind("cubature-3", &correlated, about),
        of_kind("unscented", &correlated, about),
        of_kind("converted", &covariance(&[0.009, 0.055], &[0.0]), about),
        gains.named(
            "units.fixed-gain",
            &[&["sequence", "units"][..], &own].concat(),
            "The plane's target in nanometres: the gains are the same, and log-likelihoods differ by -2 ln 1e9.",
        ),
    ]
}

fn runs() -> Vec<ProblemFile> {
    vec![in_format_2(liu2017_run(FilterFile::Extended { iterations: None })).named(
        "extended.run",
        &["run", "published-scenario", "zeros"],
        "The first forty steps of liu2017's scenario with extended filters, which the paper does not try: whether errors die out or add up.",
    )]
}

fn steps() -> Vec<ProblemFile> {
    each(
        &["extended", "cubature-3", "unscented", "converted", "fixed-gain"],
        5,
        "changing",
        &["changing-steps", "missed-detection", "transition-order"],
        "Five steps of different lengths: F, Q and R are others in almost every one, and the chain in the fourth, which has no detection.",
        |draft| changing(in_format_2(draft).keep(&[0, 1]).without(&[4])),
    )
}

/// A second sensor sees in the second and the fourth of five steps.
fn sensors() -> Vec<ProblemFile> {
    let with_second = |measurement: MeasurementFile, noise: Rows, seen: [Vec<f64>; 2]| {
        move |draft: Draft| {
            in_format_2(draft).with(|problem| {
                problem.sensors = vec![SensorFile {
                    name: "second".into(),
                    measurement: measurement.clone(),
                    noise: noise.clone(),
                }];
                for (step, z) in [1, 3].into_iter().zip(&seen) {
                    problem.measurements[step].sensor = Some("second".into());
                    problem.measurements[step].z = Some(z.iter().copied().map(Some).collect());
                }
            })
        }
    };
    let line = |matrix: [f64; 4]| MeasurementFile::Linear {
        matrix: vec![matrix.to_vec()],
    };
    let other_place = MeasurementFile::RangeBearing {
        components: vec!["bearing".into(), "range".into()],
        position: [0, 2],
        sensor: [30.0, -60.0],
    };
    let flags = ["several-sensors", "transition-order"];
    [
        each(
            &["kalman"],
            5,
            "sensors",
            &flags,
            "Two sensors in turn, one of two numbers and one of one: H and R are those of the sensor that sees.",
            with_second(line([0.4, 0.1, 0.9, -0.2]), rows([[17.0]]), [vec![20.0], vec![31.0]]),
        ),
        each(
            &["extended", "cubature-3", "unscented"],
            5,
            "sensors",
            &flags,
            "Range and bearing, and in turn with them a sensor of one linear number: two functions, one of which has an angle, and two R.",
            with_second(line([1.0, 0.3, 0.2, -0.1]), rows([[17.0]]), [vec![124.0], vec![160.0]]),
        ),
        each(
            &["converted"],
            5,
            "sensors",
            &flags,
            "Two radars in turn, at two places, the second with the bearing first: each measurement becomes a position from its own place.",
            with_second(
                other_place,
                rows([[0.0025, 0.0], [0.0, 49.0]]),
                [vec![0.03, 100.0], vec![0.15, 134.0]],
            ),
        ),
    ]
    .concat()
}

/// A number as a formula has it.
fn written(number: f64) -> String {
    format!("({number:?})")
}

/// Each F with an input, as formulas: x(k) = F x(k−1) + g u + w with another g in each mode.
fn with_input(draft: Draft) -> Draft {
    in_format_2(draft).with(|problem| {
        let names: Vec<String> = problem.state.iter().map(|component| component.name.clone()).collect();
        problem.parameters = ModelParameters(vec![("u".to_owned(), 1.5)]);
        for (j, mode) in problem.modes.iter_mut().enumerate() {
            let of_row = |(row, entries): (usize, &Vec<f64>)| {
                let terms = entries.iter().zip(&names);
                let terms: Vec<String> = terms
                    .map(|(entry, name)| format!("{}*{name}", written(*entry)))
                    .collect();
                let through = rounded([0.8, -1.2, 2.0, 0.6][row] * [1.0, -0.5, 1.7][j]);
                format!("{} + {}*u", terms.join(" + "), written(through))
            };
            mode.models.formulas = Some(mode.transition.iter().enumerate().map(of_row).collect());
            mode.transition = Vec::new();
        }
    })
}

fn inputs() -> Vec<ProblemFile> {
    each(
        &[
            "kalman",
            "extended",
            "cubature-3",
            "unscented",
            "converted",
            "fixed-gain",
        ],
        3,
        "input",
        &["input", "transition-order"],
        "A known input moves every mode by another amount: it belongs in predicted means, once, and in no covariance.",
        with_input,
    )
}
