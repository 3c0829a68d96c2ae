//! Extended filters, several sensors, and steps that differ: problems of format 2.
//!
//! They repeat the scenes of the papers' filters with Jacobians, and add a turn whose rate is in the state, headings, and steps that
//! differ.

use super::draft::{Draft, covariance, map, rounded, rows};
use super::scene::{PLANE_TRACK, RADAR_TRACK, plane, radar};
use immaculate::oracle::problem::{FORMAT_2, FilterFile, MeasurementFile, ProblemFile, Rows};
use serde_json::{Value, json};

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    [single(), turns(), crossings(), chains(), numbers(), steps(), headings()].concat()
}

/// A draft with extended filters.
pub(super) fn extended(draft: Draft) -> Draft {
    draft
        .filter(FilterFile::Extended { iterations: None })
        .with(|problem| problem.format = FORMAT_2.into())
}

fn single() -> Vec<ProblemFile> {
    vec![
        extended(radar("cubature-3").keep(&[2])).named(
            "extended.one-mode",
            &["single-step", "one-mode", "full-correlation"],
            "One extended Kalman filter, one step: range and bearing at their slopes, a linear motion.",
        ),
        extended(radar("cubature-3")).named(
            "extended.generic",
            &["single-step", "full-correlation", "spread", "transition-order", "row-order"],
            "Three modes with extended filters and one step: every Jacobian is used, and none is symmetric.",
        ),
        extended(plane()).named(
            "extended.as-kalman",
            &["single-step", "as-kalman", "full-correlation", "row-order"],
            "All is linear: the Jacobians are F and H themselves, wherever they are evaluated, and every other value is the Kalman filter's.",
        ),
    ]
}

/// What a turn with its rate in the state sees of its target: modes, estimates and a radar. `more` is put on top of it.
fn turning(id: &str, flags: &[&str], about: &str, more: &Value) -> ProblemFile {
    let q = |rate: &str| {
        json!([
            ["q*T^3/3", "q*T^2/2", 0, 0, 0],
            ["q*T^2/2", "q*T", 0, 0, 0],
            [0, 0, "q*T^3/3", "q*T^2/2", 0],
            [0, 0, "q*T^2/2", "q*T", 0],
            [0, 0, 0, 0, rate]
        ])
    };
    let first = covariance(
        &[4.0, 1.1, 5.0, 1.3, 0.1],
        &[0.3, -0.2, 0.15, 0.1, 0.35, -0.25, 0.2, -0.15, 0.3, 0.12],
    );
    let second = covariance(
        &[5.0, 1.6, 3.5, 0.9, 0.15],
        &[-0.25, 0.2, 0.3, -0.18, 0.1, 0.22, 0.35, -0.2, 0.16, -0.28],
    );
    let mut file = json!({
        "format": FORMAT_2,
        "id": id,
        "about": about,
        "flags": flags,
        "state": [["x", "m"], ["vx", "m/s"], ["y", "m"], ["vy", "m/s"], ["w", "rad/s"]],
        "parameters": { "T": 1.5 },
        "modes": [
            {
                "name": "straight",
                "motion": { "model": "constant-velocity", "others": "keep" },
                "Q": q("0.002*T"),
                "parameters": { "q": 0.8 }
            },
            {
                "name": "turn",
                "motion": { "model": "coordinated-turn-unknown-rate" },
                "Q": q("0.01*T"),
                "parameters": { "q": 1.7 }
            }
        ],
        "measurement": { "kind": "range-bearing", "components": ["range", "bearing"], "position": [0, 2], "sensor": [-40, 25] },
        "R": covariance(&[3.0, 0.04], &[0.3]),
        "filter": { "kind": "extended" },
        "transition": [[0.9, 0.1], [0.25, 0.75]],
        "initial": {
            "mode_probabilities": [0.6, 0.4],
            "modes": [
                { "mean": [60, 9, 10, -4, 0.05], "covariance": first },
                { "mean": [56, 8, 14, -6.5, 0.3], "covariance": second }
            ]
        },
        "measurements": [
            { "step": 1, "z": [113, -0.2] },
            { "step": 2, "z": [131, -0.16] },
            { "step": 3, "z": null },
            { "step": 4, "z": [151, 0.05] },
            { "step": 5, "z": [153, 0.1] }
        ]
    });
    for (key, value) in more.as_object().into_iter().flatten() {
        file[key] = value.clone();
    }
    serde_json::from_value(file).expect("a problem of the program")
}

fn turns() -> Vec<ProblemFile> {
    let flags = ["sequence", "missed-detection", "spread", "full-correlation", "formulas"];
    let points = json!({ "filter": { "kind": "cubature", "rule": "cubature-3" } });
    let mut modes = serde_json::to_value(turning("", &flags, "", &json!({})).modes).expect("modes are JSON");
    modes[1]["filter"] = json!({ "kind": "unscented", "alpha": 1, "beta": 0, "kappa": -2 });
    vec![
        turning(
            "extended.turn",
            &flags,
            "Constant velocity beside a turn whose rate is in the state: the Jacobian of the motion depends on the mixed mean, and by the rate it \
             has slopes in every row. One of the steps has no detection, and its motion has a Jacobian all the same.",
            &json!({}),
        ),
        turning(
            "cubature-3.turn",
            &flags,
            "The steps of extended.turn with points: a motion that is no matrix, through which every point goes by itself.",
            &points,
        ),
        turning(
            "extended.beside-unscented",
            &[&flags[..], &["negative-weight"]].concat(),
            "The steps of extended.turn with an unscented filter for the turn beside an extended one for the straight: each mode has the values \
             of its own kind.",
            &json!({ "modes": modes }),
        ),
    ]
}

/// The target west of the sensor on its way south, and in the mirror of the x-axis.
fn crossings() -> Vec<ProblemFile> {
    let west = |sign: f64| {
        let draft = extended(radar("cubature-3").keep(&[0, 1])).with(|problem| {
            let means = [[-190.0, -3.0, 45.0, -14.0], [-181.0, -5.4, 37.0, -11.5]];
            for (estimate, mean) in problem.initial.modes.iter_mut().zip(means) {
                estimate.mean = mean.to_vec();
            }
            let turned = |row: usize, column: usize, entry: f64| {
                let of = |index: usize| if index < 2 { 1.0 } else { sign };
                of(row) * of(column) * entry
            };
            for mode in &mut problem.modes {
                mode.transition = map(&mode.transition, turned);
                mode.noise = map(&mode.noise, turned);
            }
            for estimate in &mut problem.initial.modes {
                estimate.covariance = estimate.covariance.as_ref().map(|rows| map(rows, turned));
                estimate.mean[2] *= sign;
                estimate.mean[3] *= sign;
            }
            if let MeasurementFile::RangeBearing { sensor, .. } = &mut problem.measurement {
                sensor[1] *= sign;
            }
            problem.noise = map(
                &problem.noise,
                |row, column, entry| if row == column { entry } else { sign * entry },
            );
        });
        draft.sees(&[[163.0, -3.05], [160.0, -3.1], [151.0, -2.88], [164.0, -2.8]].map(|[r, b]| [r, sign * b]))
    };
    let flags = ["sequence", "wrap", "full-correlation"];
    vec![
        west(1.0).named(
            "extended.wrap.counter-clockwise",
            &flags,
            "The bearing grows beyond pi under extended filters: nothing but the innovation has to be wrapped, and in its right direction.",
        ),
        west(-1.0).named(
            "extended.wrap.clockwise",
            &[&flags[..], &["mirror"]].concat(),
            "extended.wrap.counter-clockwise in the mirror of the x-axis: the bearing falls below -pi.",
        ),
    ]
}

fn chains() -> Vec<ProblemFile> {
    vec![
        extended(radar("cubature-3")).sees(&RADAR_TRACK[..3]).without(&[2]).named(
            "extended.missed",
            &["sequence", "missed-detection", "full-correlation"],
            "Three steps with extended filters, the second without a detection: there is no Jacobian of a measurement that is not there.",
        ),
        extended(radar("cubature-3"))
            .chain(rows([[0.8, 0.2, 0.0], [0.35, 0.65, 0.0], [0.6, 0.4, 0.0]]), &[0.5, 0.3, 0.2])
            .sees(&RADAR_TRACK[..3])
            .named(
                "extended.unreachable",
                &["sequence", "unreachable", "transition-order", "full-correlation"],
                "No mode leads to the third, itself included. By convention it keeps its own estimate; a filter that divides by zero gives NaN.",
            ),
        extended(radar("cubature-3"))
            .with(|problem| problem.noise = covariance(&[2.0, 0.004], &[0.3]))
            .sees(&[[197.0, -0.45], [5207.0, 0.9], [206.0, -0.27]])
            .named(
                "extended.outlier",
                &["sequence", "outlier", "floor", "full-correlation"],
                "The second measurement is so far away that every likelihood is zero as a double.",
            ),
    ]
}

/// The radar's scene in kilometres, the sensor with it, with noise of the measurement in kilometres.
pub(super) fn in_kilometres(draft: Draft, noise: Rows) -> Draft {
    draft.with(|problem| {
        let unit = |entry: f64| rounded(entry * 1e-3);
        for mode in &mut problem.modes {
            mode.noise = map(&mode.noise, |_, _, entry| entry * 1e-6);
        }
        for estimate in &mut problem.initial.modes {
            estimate.mean.iter_mut().for_each(|entry| *entry = unit(*entry));
            estimate.covariance = estimate
                .covariance
                .as_ref()
                .map(|rows| map(rows, |_, _, entry| entry * 1e-6));
        }
        if let MeasurementFile::RangeBearing { sensor, .. } = &mut problem.measurement {
            *sensor = sensor.map(unit);
        }
        problem.noise = noise;
        problem.units = ["km", "km/s", "km", "km/s"].map(String::from).to_vec();
        for z in problem.measurements.iter_mut().filter_map(|entry| entry.z.as_mut()) {
            z[0] = z[0].map(|range| rounded(range / 1000.0));
        }
    })
}

fn numbers() -> Vec<ProblemFile> {
    let embedded = |problem: &mut ProblemFile| {
        problem.modes[1].transition[3] = vec![0.0; 4];
        problem.modes[1].noise[3] = vec![0.0; 4];
        for row in &mut problem.modes[1].noise {
            row[3] = 0.0;
        }
        let estimate = &mut problem.initial.modes[1];
        estimate.mean[3] = 0.0;
        for (index, row) in estimate.covariance.iter_mut().flatten().enumerate() {
            row[3] = 0.0;
            if index == 3 {
                row.fill(0.0);
            }
        }
        problem.conventions.unequal_dimensions = Some("embedded".into());
    };
    vec![
        extended(radar("cubature-3").keep(&[0, 1]))
            .with(embedded)
            .sees(&RADAR_TRACK[..3])
            .named(
                "extended.embedded",
                &["sequence", "embedded", "unequal-dimensions", "zeros"],
                "A mode without the last entry of the state, whose covariances have a row of zeros there, under extended filters.",
            ),
        in_kilometres(extended(radar("cubature-3")).sees(&RADAR_TRACK[..3]), covariance(&[0.009, 0.055], &[0.3]))
            .named(
                "extended.units",
                &["sequence", "units", "full-correlation"],
                "The radar's target in kilometres: slopes of the bearing are a thousand times as large, those of the range are not.",
            ),
    ]
}

/// F, Q, R and chain become others in each of five steps.
pub(super) fn changing(draft: Draft) -> Draft {
    let scaled = |rows: &Rows, factor: f64| map(rows, |_, _, entry| entry * factor);
    draft.with(|problem| {
        problem.format = FORMAT_2.into();
        let modes = problem.modes.clone();
        let noise = problem.noise.clone();
        for (index, entry) in problem.measurements.iter_mut().enumerate() {
            let factor = [1.0, 0.6, 1.7, 1.2, 0.8][index];
            if index != 2 {
                entry.transitions = Some(
                    modes
                        .iter()
                        .map(|mode| {
                            map(
                                &mode.transition,
                                |row, column, entry| if row == column { entry } else { entry * factor },
                            )
                        })
                        .collect(),
                );
            }
            if index != 1 {
                entry.noises = Some(modes.iter().map(|mode| scaled(&mode.noise, factor)).collect());
            }
            if index % 2 == 0 {
                entry.noise = Some(scaled(&noise, 2.0 - factor / 2.0));
            }
        }
        problem.measurements[3].transition = Some(rows([[0.7, 0.3], [0.15, 0.85]]));
    })
}

/// Kalman filters whose F, Q, R and chain are others in each step.
fn steps() -> Vec<ProblemFile> {
    let problem = plane().keep(&[0, 1]).sees(&PLANE_TRACK[..5]).without(&[4]);
    vec![changing(problem).named(
        "steps.changing",
        &["sequence", "missed-detection", "changing-steps", "row-order", "transition-order", "full-correlation"],
        "Five steps of different lengths: F, Q and R are others in almost every one, and the chain in the fourth, which has no detection. A filter \
         that keeps those of the first step is wrong from the second on.",
    )]
}

/// A heading in the state, near ±π: two modes that are on one side and on the other.
fn headings() -> Vec<ProblemFile> {
    let heading = |id: &str, filter: Value, more: &[&str], about: &str| {
        let flags = [
            "sequence",
            "missed-detection",
            "formulas",
            "state-angle",
            "spread",
            "full-correlation",
        ];
        let flags = [&flags[..], more].concat();
        let first = covariance(&[2.0, 1.5, 0.8, 0.3], &[0.25, -0.2, 0.15, 0.3, 0.1, -0.25]);
        let second = covariance(&[1.6, 2.2, 1.1, 0.4], &[-0.3, 0.2, 0.25, -0.15, 0.3, 0.2]);
        let q = json!([
            ["0.3*T", 0, 0, 0],
            [0, "0.2*T", 0, 0],
            [0, 0, "0.5*T", 0],
            [0, 0, 0, "q*T"]
        ]);
        let motion = |heading: &str| json!(["x + T*v*cos(psi)", "y + T*v*sin(psi)", "v", heading]);
        let problem = json!({
            "format": FORMAT_2,
            "id": id,
            "about": about,
            "flags": flags,
            "state": [["x", "m"], ["y", "m"], ["v", "m/s"], ["psi", "rad", "angle"]],
            "parameters": { "T": 0.8 },
            "modes": [
                { "name": "straight", "f": motion("psi"), "Q": q, "parameters": { "q": 0.01 } },
                { "name": "left", "f": motion("psi + T*rate"), "Q": q, "parameters": { "q": 0.04, "rate": 0.25 } }
            ],
            "measurement": { "kind": "linear", "H": [[1, 0, 0, 0], [0, 1, 0, 0]] },
            "R": covariance(&[0.9, 0.7], &[0.2]),
            "filter": filter,
            "transition": [[0.9, 0.1], [0.25, 0.75]],
            "initial": {
                "mode_probabilities": [0.6, 0.4],
                "modes": [
                    { "mean": [20, 3, 6, 3.05], "covariance": first },
                    { "mean": [20.5, 2.6, 5.5, -3.0], "covariance": second }
                ]
            },
            "conventions": {
                "square_root": "cholesky-lower", "angle_mean": "centre-point", "first_step": "mixed", "log_likelihood": "full",
                "state_angle_mean": "reference"
            },
            "measurements": [
                { "step": 1, "z": [15.4, 3.1] },
                { "step": 2, "z": [10.2, 2.4] },
                { "step": 3, "z": null },
                { "step": 4, "z": [1.9, 0.2] },
                { "step": 5, "z": [-1.4, -2.1] }
            ]
        });
        serde_json::from_value(problem).expect("a problem of the program")
    };
    vec![
        heading(
            "heading.extended",
            json!({ "kind": "extended" }),
            &[],
            "The heading is in the state, and the modes' are on either side of the cut at pi: mixed and combined as numbers they point backwards.",
        ),
        heading(
            "heading.unscented",
            json!({ "kind": "unscented", "alpha": 1, "beta": 0, "kappa": -1 }),
            &["negative-weight"],
            "The steps of heading.extended with points, whose headings lie on either side of the cut, too.",
        ),
    ]
}
