//! Goal: modes whose states mean different things read each other's estimates as their conversions say.
//!
//! Method: one problem in two coordinate systems must have the same certified digits; identity conversions are no conversions, to the bit;
//! a sensor that is composed by hand sees what the filter composes; Jacobians are difference quotients; a turned scene has the turned
//! answer wherever its heading is cut; a forgotten part of a conversion is named, and a wrong conversion is refused in a sentence.

use immaculate::filter::Filter;
use immaculate::filter::extended::motion_jacobian;
use immaculate::filter::kalman::{predicted_covariance, predicted_mean};
use immaculate::gaussian::{Gaussian, mixture_covariance, mixture_mean};
use immaculate::imm::state_conversion::{Reader, StateConversion, StateConversions, converted_estimate};
use immaculate::imm::{Imm, Initial, Interaction, Problem, Quantity, Step};
use immaculate::matrix::{Holds, Shapes};
use immaculate::model::Sensor;
use immaculate::model::function::Function;
use immaculate::model::motion::{Mode, Motion};
use immaculate::model::space::{Component, Space};
use immaculate::number::{Field, Rational};
use immaculate::oracle::case;
use immaculate::oracle::certify::certify;
use immaculate::oracle::check::check_problems;
use immaculate::oracle::diagnose::Diagnosis;
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::subject::{Answer, Broken, Level, Planted, Ready, Subject};
use immaculate::rule::RuleName;
use nalgebra::{
    DMatrix, DimName, Matrix4, Matrix5, OMatrix, OVector, U2, U3, U4, U5, Vector4, Vector5, matrix, vector,
};
use serde_json::{Value, json};
use std::f64::consts::PI;

// ------------------------------------------------------------------------------------------------------ two coordinate systems

/// What leads from [x, y, ẋ, ẏ] to the coordinates of the second mode; its inverse is exact in doubles, too.
const FORTH: Matrix4<f64> = Matrix4::new(
    2.0, 0.0, 4.0, 0.0, //
    0.0, 1.0, 0.0, -2.0, //
    0.0, 0.0, 1.0, 0.0, //
    0.0, 0.5, 0.0, 1.0,
);
const BACK: Matrix4<f64> = Matrix4::new(
    0.5, 0.0, -2.0, 0.0, //
    0.0, 0.5, 0.0, 1.0, //
    0.0, 0.0, 1.0, 0.0, //
    0.0, -0.25, 0.0, 0.5,
);

fn listed<const N: usize>(matrix: &OMatrix<f64, nalgebra::Const<N>, nalgebra::Const<N>>) -> Value {
    let row = |i| (0..N).map(|k| matrix[(i, k)]).collect::<Vec<f64>>();
    json!((0..N).map(row).collect::<Vec<_>>())
}

/// Two modes with constant velocities and other noises, the second one in coordinates of its own or not.
fn in_two_systems(kind: &str, is_converted: bool) -> ProblemFile {
    let straight = matrix![1.0, 0.0, 1.0, 0.0; 0.0, 1.0, 0.0, 1.0; 0.0, 0.0, 1.0, 0.0; 0.0, 0.0, 0.0, 1.0];
    let slanted = matrix![1.0, 0.0, 1.0, 0.25; 0.0, 1.0, -0.25, 1.0; 0.0, 0.0, 0.75, 0.5; 0.0, 0.0, -0.5, 0.75];
    let noise = matrix![1.0, 0.25, 0.5, 0.0; 0.25, 2.0, 0.0, 0.5; 0.5, 0.0, 1.0, 0.125; 0.0, 0.5, 0.125, 1.0];
    let (first, second) = (vector![64.0, 20.0, -6.0, 3.0], vector![60.0, 24.0, -4.0, 5.0]);
    let covariance = noise * 8.0;
    let (there, back) = if is_converted {
        (FORTH, BACK)
    } else {
        (Matrix4::identity(), Matrix4::identity())
    };
    let mean = |mean: Vector4<f64>| json!(mean.as_slice());
    let mut file = json!({
        "format": "immaculate-problem/2",
        "id": "two-systems",
        "state": ["x", "y", "vx", "vy"],
        "modes": [
            { "name": "straight", "F": listed(&straight), "Q": listed(&noise) },
            { "name": "slanted", "F": listed(&(there * slanted * back)), "Q": listed(&(there * noise * 4.0 * there.transpose())) },
        ],
        "measurement": { "kind": "linear", "H": [[1, 0, 0, 0], [0, 1, 0.5, 0]] },
        "R": [[9, 1], [1, 16]],
        "filter": { "kind": kind },
        "transition": [[0.9, 0.1], [0.25, 0.75]],
        "initial": { "mode_probabilities": [0.5, 0.5], "modes": [
            { "mean": mean(first), "covariance": listed(&covariance) },
            { "mean": mean(there * second), "covariance": listed(&(there * covariance * 2.0 * there.transpose())) },
        ] },
        "measurements": [{ "step": 1, "z": [55, 26] }, { "step": 2, "z": null }, { "step": 3, "z": [44, 30] }],
    });
    if kind == "extended" {
        file["measurement"] = json!({ "kind": "range-bearing", "components": ["range", "bearing"], "position": [0, 1], "sensor": [8, -4] });
        file["R"] = json!([[9, 0.0], [0.0, 0.0025]]);
        file["measurements"] =
            json!([{ "step": 1, "z": [55, 0.55] }, { "step": 2, "z": null }, { "step": 3, "z": [51, 0.75] }]);
    }
    if is_converted {
        file["modes"][1]["state"] = json!(["p", "q", "u", "w"]);
        file["conversions"] = json!([
            { "from": "straight", "to": "slanted", "matrix": listed(&FORTH) },
            { "from": "slanted", "to": "straight", "matrix": listed(&BACK) },
            { "from": "slanted", "matrix": listed(&BACK) },
        ]);
    }
    ProblemFile::read(&file.to_string()).unwrap()
}

/// Linear conversions that have inverses and add nothing are other names for the same numbers: certified, the two problems agree in every
/// bit of what is not in coordinates of the second mode.
#[test]
fn one_problem_in_two_coordinate_systems_has_one_combined_estimate() {
    assert_eq!(FORTH * BACK, Matrix4::identity());
    for kind in ["kalman", "extended"] {
        let [one, two] = [false, true].map(|is_converted| certify(&in_two_systems(kind, is_converted)).unwrap().trace);
        let shared: Vec<_> = one
            .all_places()
            .filter(|(_, quantity, mode)| {
                let is_of_state = ["mean", "covariance", "gain", "jacobian"];
                let name = quantity.name();
                !(*mode == 1 && name != "innovation_covariance" && is_of_state.iter().any(|part| name.ends_with(part)))
            })
            .collect();
        for place in shared {
            let (step, quantity, mode) = place;
            assert_eq!(
                one.get(step, quantity, mode),
                two.get(step, quantity, mode),
                "{kind}, {step}, {}, {mode}",
                quantity.name()
            );
        }
    }
}

/// The same of the moments alone, in exact numbers: to mix and to convert by a matrix commute.
#[test]
fn moments_of_a_mixture_commute_with_linear_conversions() {
    let exact = |value: f64| Rational::from_f64(value);
    let matrix = FORTH.map(exact);
    let zero = Matrix4::from_element(Rational::integer(0));
    let estimates = [1.0, -3.0].map(|scale| Gaussian {
        mean: vector![3.0, 1.0, -2.0, 0.5].map(|entry| exact(entry * scale)),
        covariance: (matrix![2.0, 0.5, 0.25, 0.0; 0.5, 3.0, 0.0, 1.0; 0.25, 0.0, 1.0, 0.5; 0.0, 1.0, 0.5, 4.0]
            * scale.abs())
        .map(exact),
    });
    let read = |estimate: &Gaussian<Rational, U4>| Gaussian {
        mean: predicted_mean(&matrix, &estimate.mean),
        covariance: predicted_covariance(&matrix, &estimate.covariance, &zero),
    };
    let weights = [Rational::new(2, 7), Rational::new(5, 7)];
    let mixed = |estimates: &[Gaussian<Rational, U4>]| {
        let mean = mixture_mean(&weights, estimates);
        let covariance = mixture_covariance(&weights, estimates, &mean);
        Gaussian { mean, covariance }
    };
    let converted: Vec<_> = estimates.iter().map(read).collect();
    assert_eq!(mixed(&converted), read(&mixed(&estimates)));
}

// ------------------------------------------------------------------------------- constant velocity and a turn, each in its state

/// The components of the two states, of which the first has one too many.
const CARTESIAN: [&str; 5] = ["x", "y", "vx", "vy", "none"];
const POLAR: [&str; 5] = ["x", "y", "v", "psi", "w"];

fn function(state: [&str; 5], texts: [&str; 5]) -> Motion<f64, U5> {
    let formulas: Vec<(&str, &str)> = ["0", "1", "2", "3", "4"].into_iter().zip(texts).collect();
    let function = Function::of_formulas(&state, &[], &[], &[], &formulas).unwrap();
    Motion::Function {
        function: function.into(),
        given: vec![],
    }
}

fn to_polar() -> Motion<f64, U5> {
    function(CARTESIAN, ["x", "y", "hypot(vx, vy)", "atan2(vy, vx)", "0"])
}

fn to_cartesian() -> Motion<f64, U5> {
    function(POLAR, ["x", "y", "v*cos(psi)", "v*sin(psi)", "0"])
}

/// A problem, its initial estimates, and what is measured.
type Seen<M> = (Problem<f64, U5, M>, Initial<f64, U5>, Vec<Option<OVector<f64, M>>>);
type Scene = Seen<U2>;

/// The scene turned by an angle about the origin; whole turns are put on the heading.
fn scene(filter: Filter<f64, U5, U2>, angle: f64, turns: f64) -> Scene {
    let (sine, cosine) = angle.sin_cos();
    let turn = |v: Vector5<f64>| {
        vector![
            cosine * v[0] - sine * v[1],
            sine * v[0] + cosine * v[1],
            v[2],
            v[3],
            v[4]
        ]
    };
    let straight = matrix![
        1.0, 0.0, 1.0, 0.0, 0.0; 0.0, 1.0, 0.0, 1.0, 0.0; 0.0, 0.0, 1.0, 0.0, 0.0; 0.0, 0.0, 0.0, 1.0, 0.0; 0.0, 0.0, 0.0, 0.0, 0.0
    ];
    let turning = function(POLAR, ["x + v*cos(psi)", "y + v*sin(psi)", "v", "psi + w", "w"]);
    let mode = |name: &str, motion, noise: [f64; 5]| Mode {
        name: name.into(),
        motion,
        noise: Matrix5::from_diagonal(&Vector5::from(noise)),
    };
    let conversion = |from, to, map, added: f64| StateConversion {
        from,
        to,
        map,
        added: Matrix5::from_diagonal(&vector![0.0, 0.0, 0.0, 0.0, added]),
    };
    let problem = Problem {
        modes: vec![
            mode("straight", Motion::Linear(straight), [0.2, 0.2, 0.1, 0.1, 0.0]),
            mode("turn", turning, [0.2, 0.2, 0.3, 0.01, 0.02]),
        ],
        filters: vec![filter],
        interaction: Interaction::Converted(StateConversions {
            list: vec![
                conversion(0, Reader::Mode(1), to_polar(), 0.04),
                conversion(1, Reader::Mode(0), to_cartesian(), 0.0),
                conversion(1, Reader::Common, to_cartesian(), 0.0),
            ],
            angles: vec![vec![], vec![3]],
        }),
        angles: vec![],
        chain: vec![vec![0.9, 0.1], vec![0.2, 0.8]],
        sensor: Sensor::Linear(matrix![1.0, 0.0, 0.0, 0.0, 0.0; 0.0, 1.0, 0.0, 0.0, 0.0]),
        measurement_noise: matrix![0.8, 0.0; 0.0, 0.8],
    };
    let velocity = vector![3.0 * cosine - 0.4 * sine, 3.0 * sine + 0.4 * cosine];
    let initial = Initial {
        modes: vec![
            Gaussian {
                mean: turn(vector![5.0, 1.0, 0.0, 0.0, 0.0]) + vector![0.0, 0.0, velocity[0], velocity[1], 0.0],
                covariance: Matrix5::from_diagonal(&vector![1.0, 1.0, 0.5, 0.5, 0.0]),
            },
            Gaussian {
                mean: turn(vector![5.5, 0.5, 3.5, angle + 2.0 * PI * turns - 0.2, 0.3]),
                covariance: Matrix5::from_diagonal(&vector![1.0, 1.0, 0.4, 0.05, 0.03]),
            },
        ],
        mode_probabilities: vec![0.5, 0.5],
    };
    let track = [
        vector![8.2, 1.4],
        vector![11.1, 2.5],
        vector![13.7, 4.3],
        vector![15.9, 6.8],
    ];
    let seen = track.map(|z| Some(matrix![cosine, -sine; sine, cosine] * z));
    (problem, initial, seen.into_iter().chain([None]).collect())
}

fn run<M: DimName>(scene: Seen<M>) -> Vec<Step<f64, U5, M>>
where
    Shapes: Holds<U5, M>,
{
    let (problem, initial, seen) = scene;
    let mut filter = Imm::new(problem, &initial).unwrap();
    seen.iter().map(|z| filter.step(z.as_ref()).unwrap().clone()).collect()
}

fn conversions(problem: &mut Problem<f64, U5, U2>) -> &mut StateConversions<f64, U5> {
    match &mut problem.interaction {
        Interaction::Converted(conversions) => conversions,
        _ => panic!("the scene has conversions"),
    }
}

/// The position is measured, and the plane has no direction of its own: turned, the scene has the same probabilities and the turned
/// combined estimate, whether the heading crosses ±π or not.
#[test]
fn a_turned_scene_has_the_turned_combined_estimate() {
    let plain = run(scene(Filter::extended(), 0.0, 0.0));
    for (angle, turns) in [(PI, 0.0), (3.0, 0.0), (-2.9, 0.0), (1.0, 0.0), (0.0, 1.0), (2.0, -3.0)] {
        let (sine, cosine) = f64::sin_cos(angle);
        let turn = matrix![
            cosine, -sine, 0.0, 0.0, 0.0; sine, cosine, 0.0, 0.0, 0.0; 0.0, 0.0, cosine, -sine, 0.0; 0.0, 0.0, sine, cosine, 0.0;
            0.0, 0.0, 0.0, 0.0, 1.0
        ];
        for (a, b) in plain.iter().zip(run(scene(Filter::extended(), angle, turns))) {
            // Some hundred roundings of numbers up to 20.
            assert!((turn * a.combined.mean - b.combined.mean).amax() < 1e-11, "{angle}");
            let covariance = turn * a.combined.covariance * turn.transpose();
            assert!((covariance - b.combined.covariance).amax() < 1e-11, "{angle}");
            assert!(
                (a.mode_probabilities[0] - b.mode_probabilities[0]).abs() < 1e-11,
                "{angle}"
            );
        }
    }
}

/// The wrong form: with the heading as a number, the turned scene has another answer by far.
#[test]
fn headings_as_numbers_depend_on_the_cut_after_a_conversion_too() {
    let answer = |angle| {
        let mut scene = scene(Filter::extended(), angle, 0.0);
        conversions(&mut scene.0).angles = vec![vec![], vec![]];
        run(scene).last().unwrap().mode_probabilities[0]
    };
    assert!((answer(0.0) - answer(PI)).abs() > 1e-3);
}

#[test]
fn identity_conversions_are_no_conversions_to_the_bit() {
    let points = Filter::points(RuleName::FifthDegree.rule().unwrap());
    for filter in [Filter::extended(), points] {
        let (mut plain, mut initial, seen) = scene(filter, 3.0, 0.0);
        let turning = plain.modes[1].clone();
        plain.modes[0] = Mode {
            motion: function(POLAR, ["x + v*cos(psi)", "y + v*sin(psi)", "v", "psi", "w"]),
            ..turning
        };
        initial.modes[0] = initial.modes[1].clone();
        initial.modes[0].mean += vector![0.5, -0.3, 0.2, 0.4, -0.1];
        plain.angles = vec![3];
        let mut converted = plain.clone();
        plain.interaction = Interaction::Imm;
        let identity = function(POLAR, POLAR);
        let readers = [
            (0, Reader::Mode(1)),
            (1, Reader::Mode(0)),
            (0, Reader::Common),
            (1, Reader::Common),
        ];
        let as_they_are = |(from, to)| StateConversion {
            from,
            to,
            map: if from == 0 {
                identity.clone()
            } else {
                Motion::Linear(Matrix5::identity())
            },
            added: Matrix5::zeros(),
        };
        *conversions(&mut converted) = StateConversions {
            list: readers.map(as_they_are).to_vec(),
            angles: vec![vec![3]; 2],
        };
        assert_eq!(
            run((plain, initial.clone(), seen.clone())),
            run((converted, initial, seen))
        );
    }
}

// ------------------------------------------------------------------------------------------------------------------ the sensor

/// Range, bearing and range rate in either state: the second is what the first becomes when the velocity is written in speed and heading.
fn radar(state: [&str; 5]) -> Sensor<f64, U5, U3> {
    let rate = if state == POLAR {
        "(x*v*cos(psi) + y*v*sin(psi))/hypot(x, y)"
    } else {
        "(x*vx + y*vy)/hypot(x, y)"
    };
    let h = [("r", "hypot(x, y)"), ("b", "atan2(y, x)"), ("d", rate)];
    let components = vec![
        Component::number("r", "m"),
        Component::angle("b"),
        Component::number("d", "m/s"),
    ];
    Sensor::Function {
        function: Function::of_formulas(&state, &[], &[], &[], &h).unwrap().into(),
        space: Space::new(components).unwrap().into(),
        given: vec![],
    }
}

/// The turn alone, seen by this radar; its state is its own, or the problem's.
fn seen_by_radar(filter: Filter<f64, U5, U3>, is_own: bool) -> Vec<Step<f64, U5, U3>> {
    let (problem, initial, _) = scene(Filter::extended(), 0.0, 0.0);
    let conversion = StateConversion {
        from: 0,
        to: Reader::Common,
        map: to_cartesian(),
        added: Matrix5::zeros(),
    };
    let own = StateConversions {
        list: vec![conversion],
        angles: vec![vec![3]],
    };
    let problem = Problem {
        modes: problem.modes[1..].to_vec(),
        filters: vec![filter],
        interaction: if is_own {
            Interaction::Converted(own)
        } else {
            Interaction::Imm
        },
        angles: if is_own { vec![] } else { vec![3] },
        chain: vec![vec![1.0]],
        sensor: radar(if is_own { CARTESIAN } else { POLAR }),
        measurement_noise: matrix![0.5, 0.02, 0.0; 0.02, 0.01, 0.0; 0.0, 0.0, 0.3],
    };
    let initial = Initial {
        modes: initial.modes[1..].to_vec(),
        mode_probabilities: vec![1.0],
    };
    let seen = [
        vector![8.4, 0.15, 3.3],
        vector![11.2, 0.3, 2.9],
        vector![13.9, 0.37, 3.0],
    ];
    run((problem, initial, seen.into_iter().map(Some).collect()))
}

#[test]
fn a_mode_measures_what_the_sensor_sees_of_its_converted_state() {
    let points = Filter::points(RuleName::FifthDegree.rule().unwrap());
    for filter in [Filter::extended(), points] {
        let [own, by_hand] = [true, false].map(|is_own| seen_by_radar(filter.clone(), is_own));
        for (a, b) in own.iter().zip(&by_hand) {
            assert!((a.innovations[0] - b.innovations[0]).amax() < 1e-12);
            assert!((a.innovation_covariances[0] - b.innovation_covariances[0]).amax() < 1e-12);
            assert!((a.gains[0] - b.gains[0]).amax() < 1e-12);
            assert!((a.updated[0].mean - b.updated[0].mean).amax() < 1e-12);
            assert!((a.log_likelihoods[0] - b.log_likelihoods[0]).abs() < 1e-12);
            assert_eq!(
                a.combined,
                converted_estimate(&to_cartesian(), &Matrix5::zeros(), &a.updated[0])
            );
        }
    }
}

/// ∂h(c(x))/∂x as a limit: halving the step quarters the error of a symmetric difference.
#[test]
fn the_slopes_of_a_converted_measurement_are_its_difference_quotients() {
    let steps = seen_by_radar(Filter::extended(), true);
    let (sensor, c) = (radar(CARTESIAN), to_cartesian());
    let at = steps[1].predicted[0].mean;
    let slopes = steps[1].measurement_jacobians[0].unwrap();
    let error = |step: f64| {
        let mut greatest: f64 = 0.0;
        for k in 0..5 {
            let mut away = Vector5::zeros();
            away[k] = step;
            let quotient = (sensor.of(&c.of(&(at + away))) - sensor.of(&c.of(&(at - away)))) / (2.0 * step);
            greatest = greatest.max((quotient - slopes.column(k)).amax());
        }
        greatest
    };
    let [coarse, fine] = [2e-3, 1e-3].map(error);
    assert!(
        coarse > 1e-8 && (3.9..4.1).contains(&(coarse / fine)),
        "{coarse:e} {fine:e}"
    );
}

// -------------------------------------------------------------------------------------------------------------------- the judge

fn published(id: &str) -> ProblemFile {
    let case = case::all().unwrap().iter().find(|case| case.problem.id == id).unwrap();
    ProblemFile {
        id: "mine".into(),
        ..case.problem.clone()
    }
}

#[test]
fn what_is_forgotten_of_a_conversion_is_named() {
    let mistakes = [
        ("states-mixed-unconverted", Quantity::MixedMean),
        ("states-combined-unconverted", Quantity::CombinedMean),
        ("state-conversion-jacobian-omitted", Quantity::MixedCovariance),
        ("state-conversion-covariance-not-added", Quantity::MixedCovariance),
    ];
    for id in ["states.extended", "states.cubature-3", "states.kalman"] {
        let judged = |variants: &[&str]| {
            let variants = variants.iter().map(|&id| id.to_owned()).collect();
            let level = Level::Everything;
            check_problems(&mut Planted { variants, level }, &[published(id)], &|_| {}).unwrap()
        };
        let right = judged(&[]);
        assert!(!right.is_wrong(), "{id}");
        assert_eq!(right.cases[0].judged, right.cases[0].of, "{id}");
        for (variant, quantity) in mistakes {
            let report = judged(&[variant]);
            let first = report.faults().map(|(_, judged)| judged.place.1).min();
            assert_eq!(first, Some(quantity), "{variant} in {id}");
            let Diagnosis::One(variants) = &report.diagnosis else {
                panic!("{variant} in {id}: {:?}", report.diagnosis)
            };
            assert_eq!(variants[0].id, variant, "{id}");
        }
    }
}

/// A program that reads an estimate by C P C + A.
struct Untransposed;

impl Subject for Untransposed {
    fn start(&mut self) -> Result<Ready, Broken> {
        Ok(Ready::default())
    }

    fn run(&mut self, problem: &ProblemFile) -> Answer {
        let mut setup = problem.setup_in_doubles().unwrap();
        setup.equations.mixed_covariance = |problem, previous, now, j| {
            let mut covariance = DMatrix::zeros(problem.n().0, problem.n().0);
            for (i, estimate) in previous.updated.iter().enumerate() {
                let (mut mean, mut p) = (estimate.mean.clone(), estimate.covariance.clone());
                if let Some(conversion) = problem.state_conversion(i, Reader::Mode(j)) {
                    let slopes = motion_jacobian(&conversion.map, &mean);
                    p = &slopes * p * &slopes + &conversion.added;
                    mean = conversion.map.of(&mean);
                }
                let away = mean - &now.mixed[j].mean;
                covariance += (p + &away * away.transpose()) * now.mixing_probabilities[j][i];
            }
            covariance
        };
        let computed = setup.run();
        Answer::Steps {
            error: computed.failures.first().map(ToString::to_string),
            trace: computed.in_doubles(),
        }
    }
}

#[test]
fn a_conversion_that_has_no_name_is_found_as_a_formula() {
    let report = check_problems(&mut Untransposed, &[published("states.kalman")], &|_| {}).unwrap();
    let Diagnosis::InParts { formulas, .. } = &report.diagnosis else {
        panic!("{:?}", report.diagnosis)
    };
    let [found] = &formulas.found[..] else {
        panic!("{formulas:?}")
    };
    assert_eq!(
        found.computed,
        "Σᵢ mixing_probabilities·(c'(previous updated.mean[i]) · previous updated.covariance[i] · c'(previous updated.mean[i]) + A[i] + \
         outer(c(previous updated.mean[i]) − mixed.mean))"
    );
}

// -------------------------------------------------------------------------------------------------------------------- the files

/// The problem of two systems as JSON, changed.
fn refused(change: impl FnOnce(&mut Value)) -> String {
    let mut file = serde_json::to_value(in_two_systems("kalman", true)).unwrap();
    change(&mut file);
    ProblemFile::read(&file.to_string()).unwrap_err().to_string()
}

#[test]
fn a_conversion_that_is_missing_or_too_much_is_said_with_its_place() {
    let conversion = |k: usize, key: &'static str, value: Value| refused(|file| file["conversions"][k][key] = value);
    let without = |k: usize| {
        refused(|file| {
            file["conversions"].as_array_mut().unwrap().remove(k);
        })
    };
    let sentences = [
        (
            without(0),
            "problem.conversions: lacks the one from \"straight\" to \"slanted\", whose states differ",
        ),
        (
            without(2),
            "problem.conversions: lacks the one from \"slanted\" to the combined estimates (without `to`), whose states differ",
        ),
        (
            conversion(1, "to", json!("slantd")),
            "problem.conversions[1].to: is \"slantd\", and no mode has this name; the nearest name is `slanted`",
        ),
        (
            conversion(1, "from", json!("curved")),
            "problem.conversions[1].from: is \"curved\", and no mode has this name",
        ),
        (
            conversion(1, "to", json!("slanted")),
            "problem.conversions[1]: is from \"slanted\" to \"slanted\", and both have the same state; leave it out",
        ),
        (
            refused(|file| file["conversions"][1] = file["conversions"][2].clone()),
            "problem.conversions[2]: is from \"slanted\" to the combined estimates (without `to`) as problem.conversions[1] is; each is given \
             once",
        ),
        (
            refused(|file| file["modes"][0]["name"] = json!("slanted")),
            "problem.conversions[0].from: is \"straight\", and no mode has this name",
        ),
        (
            refused(|file| {
                file["modes"][0]["name"] = json!("slanted");
                file["conversions"][0]["from"] = json!("slanted");
            }),
            "problem.conversions[0].from: is \"slanted\", which is the name of several modes; give each a name of its own",
        ),
        (
            refused(|file| drop(file["modes"][1].as_object_mut().unwrap().remove("state"))),
            "problem.conversions[0]: is from \"straight\" to \"slanted\", and both have the same state; leave it out",
        ),
        (
            refused(|file| file["modes"][1]["state"] = json!(["p", "q", "u"])),
            "problem.modes[1].state: has 3 entries where 4 are needed",
        ),
    ];
    for (sentence, expected) in sentences {
        assert_eq!(sentence, expected);
    }
}

#[test]
fn what_is_wrong_inside_a_conversion_is_said_with_its_place() {
    let conversion = |change: &dyn Fn(&mut Value)| refused(|file| change(&mut file["conversions"][1]));
    let by = |formulas: Value| {
        conversion(&|one| {
            one.as_object_mut().unwrap().remove("matrix");
            one["formulas"] = formulas.clone();
        })
    };
    let added = |rows: Value| conversion(&|one| one["added"] = rows.clone());
    let sentences = [
        (
            conversion(&|one| drop(one.as_object_mut().unwrap().remove("matrix"))),
            "problem.conversions[1]: has neither `matrix` nor `formulas`",
        ),
        (
            conversion(&|one| one["formulas"] = json!(["p", "q", "u", "w"])),
            "problem.conversions[1]: has both `matrix` and `formulas`; a conversion is said once",
        ),
        (
            conversion(&|one| one["matrix"][2] = json!([1, 0, 0])),
            "problem.conversions[1].matrix[2]: has 3 entries where 4 are needed",
        ),
        (
            by(json!(["p", "q", "u"])),
            "problem.conversions[1].formulas: has 3 formulas where the state has 4 components",
        ),
        (
            by(json!(["p", "q", "u + vx", "w"])),
            "problem.conversions[1].formulas[2]: column 5, at `u + vx`: `vx` is not known here",
        ),
        (
            added(json!([[1, 0], [0, 1]])),
            "problem.conversions[1].added: has 2 entries where 4 are needed",
        ),
        (
            added(json!([[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0], [2, 0, 0, 1]])),
            "problem.conversions[1].added: is not positive semidefinite (Granström, Willett and Bar-Shalom 2015)",
        ),
        (
            added(json!([[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])),
            "problem.conversions[1].added: is not symmetric (Granström, Willett and Bar-Shalom 2015): [0][3] is 2, [3][0] is 0, 2.0e0 apart; \
             write the same number in both",
        ),
    ];
    for (sentence, expected) in sentences {
        assert_eq!(sentence, expected);
    }
    let curved = refused(|file| {
        file["conversions"][2] = json!({ "from": "slanted", "formulas": ["p*q", "q", "u", "w"] });
    });
    assert_eq!(
        curved,
        "problem.conversions[2].formulas: is not linear, and the Kalman filter takes matrices; use an extended, unscented or cubature filter \
         (zhu2016 (42))"
    );
    let of_format_1 = refused(|file| {
        file["format"] = json!("immaculate-problem/1");
        file["units"] = json!(["m", "m", "m/s", "m/s"]);
    });
    assert_eq!(
        of_format_1,
        "problem.conversions: needs the format \"immaculate-problem/2\", and this file says \"immaculate-problem/1\""
    );
}
