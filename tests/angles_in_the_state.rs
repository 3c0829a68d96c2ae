//! Goal: a filter with a heading in its state does not know where the circle is cut.
//!
//! Method: the same scene turned about the origin, so that the headings cross ±π or stay far from it, must have the same probabilities and
//! the turned estimates; headings that are whole turns away are the same; and a program that averages headings as numbers is named.

use immaculate::filter::Filter;
use immaculate::gaussian::Gaussian;
use immaculate::imm::Quantity;
use immaculate::imm::{Equations, Imm, Initial, Interaction, Problem, Step};
use immaculate::model::Sensor;
use immaculate::model::function::Function;
use immaculate::model::motion::{Mode, Motion};
use immaculate::oracle::case;
use immaculate::oracle::check::check_problems;
use immaculate::oracle::diagnose::Diagnosis;
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::subject::{Answer, Broken, Level, Planted, Ready, Subject};
use immaculate::rule::RuleName;
use nalgebra::{Matrix4, U2, U4, Vector2, Vector4, matrix, vector};
use std::f64::consts::PI;

/// A problem, its initial estimates, and what is measured.
type Scene = (Problem<f64, U4, U2>, Initial<f64, U4>, Vec<Vector2<f64>>);

/// A scene turned by an angle about the origin: state [x, y, speed, heading], the position measured.
fn scene(filter: Filter<f64, U4, U2>, angle: f64, turns: [f64; 2]) -> Scene {
    let state = ["x", "y", "v", "psi"];
    let (sine, cosine) = angle.sin_cos();
    let mut turn = Matrix4::identity();
    turn.fixed_view_mut::<2, 2>(0, 0)
        .copy_from(&matrix![cosine, -sine; sine, cosine]);
    let mode = |name: &str, rate: &str, noise: f64| Mode {
        name: name.into(),
        motion: Motion::Function {
            function: Function::of_formulas(
                &state,
                &[],
                &[],
                &[],
                &[
                    ("x", "x + v*cos(psi)"),
                    ("y", "y + v*sin(psi)"),
                    ("v", "v"),
                    ("psi", rate),
                ],
            )
            .unwrap()
            .into(),
            given: Vec::new(),
        },
        noise: Matrix4::from_diagonal(&vector![0.2, 0.2, 0.4, noise]),
    };
    let problem = Problem {
        modes: vec![mode("straight", "psi", 0.01), mode("left", "psi + 0.3", 0.03)],
        filters: vec![filter],
        interaction: Interaction::Imm,
        angles: vec![3],
        chain: vec![vec![0.9, 0.1], vec![0.2, 0.8]],
        sensor: Sensor::Linear(matrix![1.0, 0.0, 0.0, 0.0; 0.0, 1.0, 0.0, 0.0]),
        measurement_noise: matrix![0.8, 0.0; 0.0, 0.8],
    };
    let covariance = matrix![
        2.0, 0.3, 0.1, 0.05; 0.3, 1.5, -0.2, 0.1; 0.1, -0.2, 0.9, 0.02; 0.05, 0.1, 0.02, 0.08
    ];
    let estimate = |mean: Vector4<f64>, turns: f64| Gaussian {
        mean: turn * mean + vector![0.0, 0.0, 0.0, angle + 2.0 * PI * turns],
        covariance: turn * covariance * turn.transpose(),
    };
    let symmetric = |mut gaussian: Gaussian<f64, U4>| {
        gaussian.covariance = (gaussian.covariance + gaussian.covariance.transpose()) / 2.0;
        gaussian
    };
    let initial = Initial {
        modes: vec![
            symmetric(estimate(vector![5.0, 1.0, 3.0, 0.15], turns[0])),
            symmetric(estimate(vector![5.5, 0.5, 3.5, -0.2], turns[1])),
        ],
        mode_probabilities: vec![0.5, 0.5],
    };
    let track = [
        vector![8.2, 1.4],
        vector![11.1, 2.5],
        vector![13.7, 4.3],
        vector![15.9, 6.8],
    ];
    let seen = track.map(|z| matrix![cosine, -sine; sine, cosine] * z);
    (problem, initial, seen.to_vec())
}

fn run(equations: &Equations<f64, U4, U2>, (problem, initial, seen): Scene) -> Vec<Step<f64, U4, U2>> {
    let mut filter = Imm::with_equations(problem, *equations, &initial).unwrap();
    seen.iter().map(|z| filter.step(Some(z)).unwrap().clone()).collect()
}

fn filters() -> [Filter<f64, U4, U2>; 2] {
    [
        Filter::extended(),
        Filter::points(RuleName::FifthDegree.rule().unwrap()),
    ]
}

fn apart(a: f64, b: f64) -> f64 {
    let turns = ((a - b) / (2.0 * PI)).round();
    (a - b - 2.0 * PI * turns).abs()
}

/// The heading of this scene goes on to grow: turned by about π it crosses the cut, in the estimates and in the points. Points of the fifth
/// degree go through the sine as their rule does, whatever the angle: a turn of the plane is linear in x and y, and shifts the heading.
#[test]
fn the_answer_does_not_depend_on_where_the_heading_is_cut() {
    for filter in filters() {
        let plain = run(&Equations::standard(), scene(filter.clone(), 0.0, [0.0; 2]));
        for angle in [PI, 3.0, -2.9, 1.0] {
            let turned = run(&Equations::standard(), scene(filter.clone(), angle, [0.0; 2]));
            for (a, b) in plain.iter().zip(&turned) {
                // The points of a Cholesky factor are others after a turn; extended filters have none and agree to rounding.
                let tolerance = if filter == Filter::extended() { 1e-11 } else { 2e-2 };
                let headings = [a, b].map(|step| step.combined.mean[3]);
                assert!(
                    apart(headings[0] + angle, headings[1]) < tolerance,
                    "{angle}: {headings:?}"
                );
                let variances = [a, b].map(|step| step.combined.covariance[(3, 3)]);
                assert!(
                    (variances[0] - variances[1]).abs() < tolerance,
                    "{angle}: {variances:?}"
                );
                for j in 0..2 {
                    let difference = a.mode_probabilities[j] - b.mode_probabilities[j];
                    assert!(difference.abs() < tolerance, "{angle}: {difference}");
                }
            }
        }
    }
}

/// The wrong form: as numbers, the turned scene has another answer by far.
#[test]
fn headings_as_numbers_depend_on_the_cut() {
    for filter in filters() {
        let spread = |is_angle: bool| {
            let mut scene = scene(filter.clone(), PI, [0.0, -1.0]);
            if !is_angle {
                scene.0.angles.clear();
            }
            run(&Equations::standard(), scene)[0].mixed[0].covariance[(3, 3)]
        };
        assert!(
            spread(true) < 0.5 && spread(false) > 2.0,
            "{} {}",
            spread(true),
            spread(false)
        );
    }
}

#[test]
fn turning_a_scene_by_whole_turns_changes_nothing() {
    for filter in filters() {
        for equations in [Equations::standard(), Equations::standard().with_mean_directions()] {
            let plain = run(&equations, scene(filter.clone(), 3.0, [0.0; 2]));
            let turned = run(&equations, scene(filter.clone(), 3.0, [2.0, -1.0]));
            for (a, b) in plain.iter().zip(&turned) {
                // Two turns are 12.6: adding them rounds the heading in its fifteenth digit.
                assert!(apart(a.combined.mean[3], b.combined.mean[3]) < 1e-12);
                assert!((a.combined.covariance - b.combined.covariance).norm() < 1e-11);
                assert!((a.mode_probabilities[0] - b.mode_probabilities[0]).abs() < 1e-11);
            }
        }
    }
}

/// With narrow estimates both means of directions are the same to the third order.
#[test]
fn the_mean_direction_of_near_headings_is_their_mean() {
    let mut means = [Equations::standard(), Equations::standard().with_mean_directions()].map(|equations| {
        let run = run(&equations, scene(Filter::extended(), 3.0, [0.0; 2]));
        run[0].mixed[0].mean[3]
    });
    means.sort_by(f64::total_cmp);
    let difference = apart(means[1], means[0]);
    // 0.35 rad apart: ½ · ½ · ½ · 0.35³/6 and less.
    assert!((1e-6..1e-2).contains(&difference), "{difference}");
}

// Judged

fn heading(id: &str) -> ProblemFile {
    let case = case::all().unwrap().iter().find(|case| case.problem.id == id).unwrap();
    ProblemFile {
        id: "mine".into(),
        ..case.problem.clone()
    }
}

/// A program that keeps its headings in (−π, π], as most do.
struct Wrapping;

impl Subject for Wrapping {
    fn start(&mut self) -> Result<Ready, Broken> {
        Ok(Ready::default())
    }

    fn run(&mut self, problem: &ProblemFile) -> Answer {
        let mut own = Planted {
            variants: Vec::new(),
            level: Level::Everything,
        };
        let Answer::Steps { mut trace, error } = own.run(problem) else {
            panic!("a good problem")
        };
        let means = [
            Quantity::MixedMean,
            Quantity::PredictedMean,
            Quantity::CombinedPredictionMean,
            Quantity::UpdatedMean,
            Quantity::CombinedMean,
        ];
        for (step, quantity, mode) in trace.clone().all_places().filter(|place| means.contains(&place.1)) {
            let mut numbers = trace.get(step, quantity, mode).unwrap().clone();
            numbers[3] = numbers[3].sin().atan2(numbers[3].cos());
            trace.set(step, quantity, mode, numbers);
        }
        Answer::Steps { trace, error }
    }
}

#[test]
fn a_heading_counts_modulo_a_turn_and_its_averages_are_judged() {
    for id in ["heading.extended", "heading.unscented"] {
        let report = check_problems(&mut Wrapping, &[heading(id)], &|_| {}).unwrap();
        assert!(!report.is_wrong(), "{id}");
        assert_eq!(report.cases[0].judged, report.cases[0].of, "{id}");
        for (variant, quantity) in [
            ("state-angles-as-numbers", Quantity::MixedMean),
            ("combined-angles-as-numbers", Quantity::CombinedMean),
        ] {
            let mut planted = Planted {
                variants: vec![variant.into()],
                level: Level::Everything,
            };
            let report = check_problems(&mut planted, &[heading(id)], &|_| {}).unwrap();
            let first = report.faults().map(|(_, judged)| judged.place.1).min();
            assert_eq!(first, Some(quantity), "{id}");
            let Diagnosis::One(variants) = &report.diagnosis else {
                panic!("{variant}: {:?}", report.diagnosis)
            };
            assert!(
                variants.iter().any(|found| found.id == variant),
                "{variant} is among {variants:?}"
            );
        }
        // Sine and cosine are a convention.
        let mut planted = Planted {
            variants: vec!["state-angle-mean-vector".into()],
            level: Level::Everything,
        };
        let report = check_problems(&mut planted, &[heading(id)], &|_| {}).unwrap();
        assert!(report.faults().next().is_some() && !report.is_wrong(), "{id}");
    }
}
