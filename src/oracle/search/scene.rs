//! Random problems without measurements: modes, estimates and a sensor, for a kind of filter.
//!
//! A search asks for one to three modes, one to five steps, and states of one to four numbers, with dense F, H and covariances, or range
//! and bearing, or turns and headings by named models. All of it is well conditioned, so that a right filter has no excuse to stop;
//! `event` adds the situations that are deliberately hard.

use super::draw::{Draw, rounded};
use crate::model::Conversion;
use crate::number::Real;
use crate::oracle::chain::CONTINUOUS_CHAIN;
use crate::oracle::filter_file::{CORRELATED_NOISE, GPB1, STATE_CONVERSION};
use crate::oracle::problem::{Conventions, FORMAT, FORMAT_2, InteractionFile, ProblemFile, Rows, UNMIXED};
use serde::Deserialize;
use serde_json::{Value, json};

/// What a program may be asked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Offer {
    /// The kinds of filter, by [`FilterFile::name`](crate::oracle::problem::FilterFile::name).
    pub kinds: Vec<String>,
    /// Whether it reads format 2.
    pub is_format_2: bool,
}

impl Offer {
    /// The kinds that are drawn. Some need format 2; modes with their own states and chains by rates are never drawn.
    pub(super) fn possible(&self) -> Vec<&str> {
        let kinds = self
            .kinds
            .iter()
            .map(String::as_str)
            .filter(|kind| ![STATE_CONVERSION, CONTINUOUS_CHAIN].contains(kind));
        kinds.filter(|kind| self.is_format_2 || !is_new(kind)).collect()
    }
}

/// Whether a kind needs format 2.
fn is_new(kind: &str) -> bool {
    kind.starts_with("extended") || OF_KALMAN.contains(&kind)
}

/// What a Kalman filter may have, and not every one has.
const OF_KALMAN: [&str; 3] = [CORRELATED_NOISE, GPB1, UNMIXED];

/// The motion of a target and its measurement.
#[derive(Clone, Copy, PartialEq)]
enum Scene {
    /// Dense matrices.
    Linear,
    /// Dense motions, range and bearing.
    Polar,
    /// A speed and a heading, by formulas.
    Formulas,
    /// A straight and a turn whose rate is in the state.
    Turn,
    /// A turn with a heading, which is an angle, in the state.
    Heading,
}

impl Scene {
    /// The scenes of a kind; the last three need format 2, and as many points as a state of five numbers has not too many of.
    fn of(kind: &str, offer: &Offer) -> &'static [Self] {
        match kind {
            "kalman" | "fixed-gain" | "fixed-gain-unmixed" | CORRELATED_NOISE | GPB1 | UNMIXED => &[Self::Linear],
            "converted" => &[Self::Polar],
            _ if offer.is_format_2 && most_components(kind) > 4 => {
                &[Self::Linear, Self::Polar, Self::Formulas, Self::Turn, Self::Heading]
            }
            _ => &[Self::Linear, Self::Polar],
        }
    }
}

/// The most components of a state for a kind of filter: a Gauss-Hermite rule of k nodes has kⁿ points, and 81 are enough.
fn most_components(kind: &str) -> usize {
    match kind {
        "gauss-hermite-5" => 2,
        "gauss-hermite-4" => 3,
        "gauss-hermite-2" | "gauss-hermite-3" => 4,
        _ => 5,
    }
}

/// The parts of a problem file that depend on the scene.
struct Parts {
    state: Vec<Value>,
    modes: Vec<Value>,
    estimates: Vec<Value>,
    measurement: Value,
    noise: Rows,
    flags: Vec<&'static str>,
}

/// A problem without measurements; nothing if the program may be asked for nothing.
pub(super) fn scene(draw: &mut Draw, offer: &Offer) -> Option<ProblemFile> {
    let kinds = offer.possible();
    let kind = draw.one_of(&kinds)?;
    let scene = draw.one_of(Scene::of(kind, offer))?;
    let r = 1 + draw.below(3);
    let n = 1 + draw.below(most_components(kind).min(4));
    let mut parts = match scene {
        Scene::Linear => linear(draw, n, r),
        Scene::Polar => polar(draw, n.max(2), r, kind),
        Scene::Formulas => formulas(draw),
        Scene::Turn => turn(draw),
        Scene::Heading => heading(draw),
    };
    let is_fixed = kind.starts_with("fixed-gain");
    let (n, m, r) = (parts.state.len(), parts.noise.len(), parts.modes.len());
    let filter = if is_fixed {
        fixed_gain(draw, kind, n, m, r)
    } else {
        filter(draw, kind, n)
    };
    if is_fixed {
        for estimate in parts.estimates.iter_mut().filter_map(Value::as_object_mut) {
            estimate.remove("covariance");
        }
    }
    if kind == CORRELATED_NOISE {
        share_noise(draw, &mut parts);
    }
    let is_function = matches!(scene, Scene::Formulas | Scene::Turn | Scene::Heading);
    let mut is_new = is_function || is_new(kind);
    let others: Vec<&str> = kinds
        .into_iter()
        .filter(|other| *other != "converted" && !OF_KALMAN.contains(other))
        .filter(|other| !other.starts_with("fixed-gain") && most_components(other) >= n)
        .filter(|other| Scene::of(other, offer).contains(&scene))
        .collect();
    if offer.is_format_2 && others.contains(&kind) && draw.happens(0.15) {
        let other = draw.one_of(&others)?;
        parts.modes[r - 1]["filter"] = self::filter(draw, other, n);
        is_new = true;
    }
    let mut problem = assembled(draw, &parts, &filter, is_new)?;
    problem.interaction = match kind {
        GPB1 => Some(InteractionFile::Gpb1),
        UNMIXED => Some(InteractionFile::Unmixed),
        _ => None,
    };
    Some(problem)
}

/// The file.
fn assembled(draw: &mut Draw, parts: &Parts, filter: &Value, is_new: bool) -> Option<ProblemFile> {
    let r = parts.modes.len();
    let steps = 1 + draw.below(5);
    let chain: Vec<Vec<f64>> = (0..r).map(|i| draw.probabilities(r, i)).collect();
    let favourite = draw.below(r);
    let conventions = Conventions {
        state_angle_mean: parts.flags.contains(&"state-angle").then(|| "reference".to_owned()),
        converted_covariance: (filter["kind"] == "converted").then(|| "at-measurement".to_owned()),
        ..Conventions::default()
    };
    let units = if is_new { vec![] } else { vec!["1"; parts.state.len()] };
    let mut file = json!({
        "format": if is_new { FORMAT_2 } else { FORMAT },
        "id": "search",
        "about": "",
        "flags": parts.flags,
        "state": parts.state,
        "units": units,
        "modes": parts.modes,
        "measurement": parts.measurement,
        "R": parts.noise,
        "filter": filter,
        "transition": chain,
        "initial": { "mode_probabilities": draw.probabilities(r, favourite), "modes": parts.estimates },
        "conventions": conventions,
        "measurements": (1..=steps).map(|step| json!({ "step": step, "z": null })).collect::<Vec<_>>(),
    });
    if parts.flags.contains(&"formulas") {
        file["parameters"] = json!({ "T": rounded(draw.between(0.5, 1.5), 1) });
    }
    serde_json::from_value(file).ok()
}

/// A filter of a kind without gains.
fn filter(draw: &mut Draw, kind: &str, n: usize) -> Value {
    match kind {
        CORRELATED_NOISE | GPB1 | UNMIXED => json!({ "kind": "kalman" }),
        "kalman" | "extended" => json!({ "kind": kind }),
        "extended-iterated" => json!({ "kind": "extended", "iterations": 2 + draw.below(3) }),
        "unscented" => {
            // n + λ = α² (n + κ) is positive in all of them, and negative is a weight in the last.
            let parameters = [
                (1.0, 0.0, 1.0),
                (1.0, 2.0, 0.0),
                (0.5, 2.0, 1.0),
                (1.0, 0.0, 3.0 - n as f64),
            ];
            let (alpha, beta, kappa) = parameters[draw.below(parameters.len())];
            json!({ "kind": kind, "alpha": alpha, "beta": beta, "kappa": kappa })
        }
        "converted" => {
            let conversion = Conversion::ALL[draw.below(Conversion::ALL.len())];
            json!({ "kind": kind, "conversion": conversion.name() })
        }
        rule => json!({ "kind": "cubature", "rule": rule }),
    }
}

/// Correlations between the noises of motion and measurement. Where they are too many to be, the problem is refused.
fn share_noise(draw: &mut Draw, parts: &mut Parts) {
    let deviation = |rows: &Rows, i: usize| Real::sqrt(&rows[i][i]);
    for mode in &mut parts.modes {
        let Ok(noise) = Rows::deserialize(&mode["Q"]) else {
            continue;
        };
        let mut shared = |i: usize, k: usize| {
            rounded(
                draw.between(-0.35, 0.35) * deviation(&noise, i) * deviation(&parts.noise, k),
                2,
            )
        };
        let row = |i: usize| (0..parts.noise.len()).map(|k| shared(i, k)).collect();
        mode["M"] = json!((0..noise.len()).map(row).collect::<Rows>());
    }
}

/// Gains near those of a filter that sees the first components.
fn fixed_gain(draw: &mut Draw, kind: &str, n: usize, m: usize, r: usize) -> Value {
    let of_mode = |_| {
        let gain = dense(draw, n, m, [0.3, 0.6], 0.2);
        let deviations = draw.deviations(m, 2.0, 5.0);
        json!({ "gain": gain, "innovation_covariance": draw.covariance(&deviations) })
    };
    let modes: Vec<Value> = (0..r).map(of_mode).collect();
    let mixing = if kind == "fixed-gain" { "mixed" } else { "unmixed" };
    json!({ "kind": "fixed-gain", "mixing": mixing, "modes": modes })
}

/// A matrix of two decimals without zeros, larger where row and column agree.
fn dense(draw: &mut Draw, rows: usize, columns: usize, diagonal: [f64; 2], others: f64) -> Rows {
    let mut entry = |row: usize, column: usize| {
        let value = if row % columns == column {
            draw.between(diagonal[0], diagonal[1])
        } else {
            draw.between(-others, others)
        };
        let value = (100.0 * value).round() / 100.0;
        if value == 0.0 { 0.01 } else { value }
    };
    (0..rows)
        .map(|row| (0..columns).map(|column| entry(row, column)).collect())
        .collect()
}

/// A mode with these matrices.
fn mode(index: usize, motion: &Rows, noise: &Rows) -> Value {
    let name = ["first", "second", "third"][index % 3];
    json!({ "name": name, "F": motion, "Q": noise })
}

/// An estimate about a centre, off by about a standard deviation.
fn estimate(draw: &mut Draw, centre: &[f64], deviations: &[f64]) -> Value {
    let mean: Vec<f64> = centre
        .iter()
        .zip(deviations)
        .map(|(centre, deviation)| super::draw::rounded_to_spread(centre + deviation * draw.normal(), 3.0 * deviation))
        .collect();
    json!({ "mean": mean, "covariance": draw.covariance(deviations) })
}

/// States and measurements of any shape. By Gershgorin's circles no eigenvalue of F is beyond 1.5.
fn linear(draw: &mut Draw, n: usize, r: usize) -> Parts {
    let m = 1 + draw.below(3);
    let centre: Vec<f64> = (0..n).map(|_| draw.between(-20.0, 20.0)).collect();
    let (mut modes, mut estimates) = (Vec::new(), Vec::new());
    for index in 0..r {
        let motion = dense(draw, n, n, [0.7, 1.1], 0.4 / (n.max(2) - 1) as f64);
        let deviations = draw.deviations(n, 0.5, 2.0);
        modes.push(mode(index, &motion, &draw.covariance(&deviations)));
        let deviations = draw.deviations(n, 1.0, 4.0);
        estimates.push(estimate(draw, &centre, &deviations));
    }
    let matrix = dense(draw, m, n, [0.6, 1.4], 0.5);
    let deviations = draw.deviations(m, 0.5, 3.0);
    Parts {
        state: (1..=n).map(|index| json!(format!("x{index}"))).collect(),
        modes,
        estimates,
        measurement: json!({ "kind": "linear", "H": matrix }),
        noise: draw.covariance(&deviations),
        flags: vec![],
    }
}

/// The names of a state in the plane of two to five numbers, and which of them are the position.
const IN_THE_PLANE: [(&[&str], [usize; 2]); 3] = [
    (&["x", "y"], [0, 1]),
    (&["x", "y", "u"], [0, 1]),
    (&["x", "vx", "y", "vy"], [0, 2]),
];

/// A target in the plane, far from its sensor in units of what is known of it: a bearing's spread is a few degrees.
fn polar(draw: &mut Draw, n: usize, r: usize, kind: &str) -> Parts {
    let (names, position) = IN_THE_PLANE[n - 2];
    let sensor = [0, 1].map(|_| draw.between(-50.0, 50.0).round());
    let is_west = draw.happens(0.3);
    let direction = if is_west {
        f64::pi() + draw.between(-0.1, 0.1)
    } else {
        draw.between(-3.0, 3.0)
    };
    let distance = draw.between(60.0, 200.0);
    let mut centre: Vec<f64> = (0..n).map(|_| draw.between(-5.0, 5.0)).collect();
    centre[position[0]] = sensor[0] + distance * Real::cos(&direction);
    centre[position[1]] = sensor[1] + distance * Real::sin(&direction);
    let (mut modes, mut estimates) = (Vec::new(), Vec::new());
    for index in 0..r {
        let mut motion = dense(draw, n, n, [0.97, 1.03], 0.06);
        if n == 4 {
            motion[0][1] = rounded(motion[0][1] + 1.0, 3);
            motion[2][3] = rounded(motion[2][3] + 1.0, 3);
        }
        let deviations = draw.deviations(n, 0.5, 2.0);
        modes.push(mode(index, &motion, &draw.covariance(&deviations)));
        let deviations = draw.deviations(n, 1.0, 4.0);
        estimates.push(estimate(draw, &centre, &deviations));
    }
    // A conversion needs both, and their noise without correlation.
    let is_converted = kind == "converted";
    let all: [&[&str]; 4] = [&["range", "bearing"], &["bearing", "range"], &["bearing"], &["range"]];
    let components = all[draw.below(if is_converted { 2 } else { 4 })];
    let deviations: Vec<f64> = components
        .iter()
        .map(|component| {
            if *component == "range" {
                draw.between(2.0, 9.0)
            } else {
                draw.between(0.01, 0.06)
            }
        })
        .collect();
    let mut noise = draw.covariance(&deviations);
    if is_converted {
        (noise[0][1], noise[1][0]) = (0.0, 0.0);
    }
    let is_wrapping = is_west && components.contains(&"bearing") && !is_converted;
    Parts {
        state: names.iter().map(|name| json!(name)).collect(),
        modes,
        estimates,
        measurement: json!({ "kind": "range-bearing", "components": components, "position": position, "sensor": sensor }),
        noise,
        flags: if is_wrapping { vec!["wrap"] } else { vec![] },
    }
}

/// A target with a speed and a heading that is a number, not an angle, and is far from ±π; one mode goes straight, the other turns.
fn formulas(draw: &mut Draw) -> Parts {
    let centre = [
        70.0,
        draw.between(-60.0, 60.0),
        draw.between(4.0, 9.0),
        draw.between(-1.0, 1.0),
    ];
    let deviations = [3.0, 3.0, 1.0, 0.2].map(|deviation| deviation * draw.between(0.7, 1.3));
    let mut part = |(name, turn): (&str, &str)| {
        let noise = json!([
            ["q*T", 0, 0, 0],
            [0, "q*T", 0, 0],
            [0, 0, "0.5*T", "0.02*T"],
            [0, 0, "0.02*T", "0.01*T"]
        ]);
        let parameters = json!({ "q": rounded(draw.between(0.3, 2.0), 1), "rate": rounded(draw.between(0.1, 0.4), 1) });
        let motion = json!(["x + T*v*cos(psi)", "y + T*v*sin(psi)", "v", turn]);
        let mode = json!({ "name": name, "f": motion, "Q": noise, "parameters": parameters });
        (mode, estimate(draw, &centre, &deviations))
    };
    let parts = [("straight", "psi"), ("turn", "psi + T*rate")].map(&mut part);
    let (modes, estimates) = parts.into_iter().unzip();
    let seen = json!([["range", "m"], ["bearing", "rad", "angle"]]);
    let deviations = [draw.between(2.0, 5.0), draw.between(0.02, 0.06)];
    Parts {
        state: json!([["x", "m"], ["y", "m"], ["v", "m/s"], ["psi", "rad"]])
            .as_array()
            .cloned()
            .unwrap_or_default(),
        modes,
        estimates,
        measurement: json!({ "kind": "formulas", "z": seen, "h": ["sqrt(x^2 + y^2)", "atan2(y, x)"] }),
        noise: draw.covariance(&deviations),
        flags: vec!["formulas"],
    }
}

/// What a sensor sees of x and y in a scene of named models.
fn sight(draw: &mut Draw, position: [usize; 2], sensor: [f64; 2]) -> (Value, Rows) {
    let polar =
        json!({ "kind": "range-bearing", "components": ["range", "bearing"], "position": position, "sensor": sensor });
    let named = json!({ "kind": "model", "model": "range-bearing", "parameters": { "sensor_x": sensor[0], "sensor_y": sensor[1] } });
    let (measurement, deviations) = match draw.below(3) {
        0 => (polar, [3.0, 0.04]),
        1 => (named, [5.0, 0.03]),
        _ => (json!({ "kind": "model", "model": "position" }), [3.0, 4.0]),
    };
    let deviations: Vec<f64> = deviations
        .iter()
        .map(|deviation| deviation * draw.between(0.5, 1.5))
        .collect();
    (measurement, draw.covariance(&deviations))
}

/// A target that goes straight or turns at a rate that is in the state.
fn turn(draw: &mut Draw) -> Parts {
    let sensor = [0, 1].map(|_| draw.between(-30.0, 30.0).round());
    let centre = [
        sensor[0] + 90.0,
        draw.between(5.0, 12.0),
        sensor[1] + draw.between(-60.0, 60.0),
        draw.between(-8.0, 8.0),
        0.1,
    ];
    let deviations = [4.0, 1.5, 4.0, 1.5, 0.1].map(|deviation| deviation * draw.between(0.7, 1.3));
    let estimates = (0..2).map(|_| estimate(draw, &centre, &deviations)).collect();
    // White acceleration, and a random walk of the rate.
    let noise = |draw: &mut Draw, turning: f64| {
        let q = rounded(draw.between(0.3, 2.0), 1);
        let [place, mixed, velocity] = ["T^3/3", "T^2/2", "T"].map(|of_step| json!(format!("{q}*{of_step}")));
        json!([
            [place, mixed, 0, 0, 0],
            [mixed, velocity, 0, 0, 0],
            [0, 0, place, mixed, 0],
            [0, 0, mixed, velocity, 0],
            [0, 0, 0, 0, format!("{turning}*T")],
        ])
    };
    let (measurement, r) = sight(draw, [0, 2], sensor);
    Parts {
        state: json!([["x", "m"], ["vx", "m/s"], ["y", "m"], ["vy", "m/s"], ["w", "rad/s"]])
            .as_array()
            .cloned()
            .unwrap_or_default(),
        modes: vec![
            json!({ "name": "straight", "motion": { "model": "constant-velocity", "others": "keep" }, "Q": noise(draw, 0.002) }),
            json!({ "name": "turn", "motion": { "model": "coordinated-turn-unknown-rate" }, "Q": noise(draw, 0.01) }),
        ],
        estimates,
        measurement,
        noise: r,
        flags: vec!["formulas"],
    }
}

/// A target with a speed and a heading near ±π or anywhere; one mode or two.
fn heading(draw: &mut Draw) -> Parts {
    let sensor = [0, 1].map(|_| draw.between(-30.0, 30.0).round());
    let direction = if draw.happens(0.5) {
        f64::pi()
    } else {
        draw.between(-2.5, 2.5)
    };
    let centre = [
        sensor[0] + 90.0,
        sensor[1] + draw.between(-60.0, 60.0),
        draw.between(4.0, 9.0),
        direction,
        0.1,
    ];
    let deviations = [3.0, 3.0, 1.0, 0.2, 0.08].map(|deviation| deviation * draw.between(0.7, 1.3));
    let mut part = |index: usize| {
        // Not zero: a turn that accelerates at random has no noise along two of its five components, which is no mistake but singular.
        let noise = [0.3, 0.3, 0.5, 0.1, 0.05].map(|deviation| deviation * draw.between(0.7, 1.3));
        let name = ["one", "other"][index];
        let motion = json!({ "model": "constant-turn-rate-and-speed" });
        let mode = json!({ "name": name, "motion": motion, "Q": draw.covariance(&noise) });
        (mode, estimate(draw, &centre, &deviations))
    };
    let (modes, estimates) = (0..2).map(&mut part).unzip();
    let (measurement, r) = sight(draw, [0, 1], sensor);
    Parts {
        state: json!([
            ["x", "m"],
            ["y", "m"],
            ["v", "m/s"],
            ["heading", "rad", "angle"],
            ["w", "rad/s"]
        ])
        .as_array()
        .cloned()
        .unwrap_or_default(),
        modes,
        estimates,
        measurement,
        noise: r,
        flags: vec!["formulas", "state-angle"],
    }
}
