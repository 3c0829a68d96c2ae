//! Goal: a comparison draws the truth from the model of its problem, gives all filters the same measurements, and reports errors,
//! consistency and cost as they are.
//!
//! Method: laws on problems whose answer is known: moments of what is drawn, χ² of a matched filter, filters that are equal, modes that are
//! equal; then the program with good and bad arguments. Kind of evidence: exact, statistical with fixed seeds, behaviour, a snapshot.

mod common;

use common::problems::{published, read};
use common::program::{error_of, immaculate, names};
use immaculate::compare::standing::{Calibration, Differs, FilterComparison, Standing, StandingTable};
use immaculate::compare::truth::{SimulatedRun, TruthModel, square_root, with_steps};
use immaculate::compare::{Contest, NotCompared, Sample};
use immaculate::matrix::ldl;
use immaculate::number::Counted;
use immaculate::oracle::problem::ProblemFile;
use immaculate::paper::monte_carlo::Generator;
use immaculate::report::{comparison, comparison_figure};
use immaculate::statistics::consistency::bounds;
use immaculate::statistics::estimate::{mean, paired_log_ratio};
use nalgebra::{DMatrix, Matrix2, Vector2, dmatrix, matrix, vector};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// A statistic of a law that holds is outside of its bounds with this probability; each has a fixed seed.
const FALSE_ALARM: f64 = 1e-4;

/// A target with one mode, or with a second one, that does not stand still and is measured in one number; Q has rank one.
fn linear(modes: usize) -> Value {
    let mode =
        |name: &str, f: f64| json!({ "name": name, "F": [[1.0, 0.9], [-0.2, f]], "Q": [[0.25, 0.5], [0.5, 1.0]] });
    let estimate = json!({ "mean": [3.0, -1.0], "covariance": [[2.0, 0.3], [0.3, 1.0]] });
    let chain = if modes == 1 {
        json!([[1.0]])
    } else {
        json!([[0.8, 0.2], [0.4, 0.6]])
    };
    let both = [mode("one", 0.8), mode("other", -0.7)];
    let probabilities = if modes == 1 { json!([1.0]) } else { json!([0.3, 0.7]) };
    json!({
        "format": "immaculate-problem/2",
        "id": "linear",
        "state": [["x", "m"], ["v", "m/s"]],
        "modes": both[..modes],
        "measurement": { "kind": "linear", "H": [[1.1, 0.3]] },
        "R": [[0.7]],
        "filter": { "kind": "kalman" },
        "transition": chain,
        "initial": { "mode_probabilities": probabilities, "modes": vec![estimate; modes] },
        "measurements": [{ "step": 1, "z": [2.0] }, { "step": 2, "z": null }, { "step": 3, "z": [1.0] }],
    })
}

/// A target with a heading whose range and bearing are measured.
fn curved() -> Value {
    serde_json::from_str(include_str!("../spec/example.json")).unwrap()
}

fn compared(problem: &Value, runs: usize, steps: usize) -> FilterComparison {
    contest(problem, runs, steps).unwrap().run(&|| {})
}

fn contest(problem: &Value, runs: usize, steps: usize) -> Result<Contest, NotCompared> {
    let sample = Sample {
        runs: Some(runs),
        seed: 1,
        steps: Some(steps),
    };
    Contest::new(&read(problem), sample)
}

fn standing<'a>(table: &'a StandingTable, name: &str) -> &'a Standing {
    let found = table.standings.iter().find(|one| one.name == name);
    found.unwrap_or_else(|| panic!("{name} is not compared"))
}

/// Relative difference of the errors of two filters.
fn apart(a: &Standing, b: &Standing) -> f64 {
    let pairs = a.groups.iter().zip(&b.groups);
    pairs
        .map(|(a, b)| (a.error.value / b.error.value - 1.0).abs())
        .fold(0.0, f64::max)
}

fn drawn(problem: &ProblemFile, steps: usize, runs: usize) -> Vec<SimulatedRun> {
    let problem = with_steps(problem, steps).unwrap();
    TruthModel::new(&problem).unwrap().runs(1, runs).unwrap()
}

// What is drawn

/// Asserts that Gaussian vectors have a mean and a covariance, which three directions determine: the mean along each and the sum of
/// squares along each have exact laws.
fn assert_moments(samples: &[Vector2<f64>], mean: Vector2<f64>, covariance: Matrix2<f64>, what: &str) {
    for direction in [vector![1.0, 0.0], vector![0.0, 1.0], vector![1.0, -1.0]] {
        let variance = direction.dot(&(covariance * direction));
        let along: Vec<f64> = samples.iter().map(|sample| direction.dot(&(sample - mean))).collect();
        let count = along.len() as f64;
        // χ² of one degree of freedom, and of as many as there are samples.
        let of_mean = along.iter().sum::<f64>().powi(2) / (count * variance);
        let of_squares = along.iter().map(|value| value * value).sum::<f64>() / variance / count;
        let (_, upper) = bounds(1.0, 1, 2.0 * FALSE_ALARM);
        assert!(of_mean < upper, "{what}: mean along {direction:?}: {of_mean}");
        let (low, high) = bounds(1.0, along.len(), FALSE_ALARM);
        assert!(
            (low..high).contains(&of_squares),
            "{what}: square along {direction:?}: {of_squares}"
        );
    }
}

#[test]
fn a_drawn_truth_has_the_moments_of_the_model() {
    let runs = drawn(&read(&linear(1)), 4, 4000);
    let (f, q) = (matrix![1.0, 0.9; -0.2, 0.8], matrix![0.25, 0.5; 0.5, 1.0]);
    let (mut mean, mut covariance) = (vector![3.0, -1.0], matrix![2.0, 0.3; 0.3, 1.0]);
    for k in 0..4 {
        (mean, covariance) = (f * mean, f * covariance * f.transpose() + q);
        let states: Vec<_> = runs
            .iter()
            .map(|run| vector![run.states[k][0], run.states[k][1]])
            .collect();
        assert_moments(&states, mean, covariance, &format!("state of step {}", k + 1));
        // What is measured is the state and a noise that is independent of it.
        let noise = |run: &SimulatedRun| {
            let z = run.measurements[k].as_ref()?;
            Some(vector![
                z[0] - 1.1 * run.states[k][0] - 0.3 * run.states[k][1],
                run.states[k][0] - mean[0]
            ])
        };
        let noises: Vec<_> = runs.iter().filter_map(noise).collect();
        assert_eq!(
            noises.len(),
            if k == 1 { 0 } else { 4000 },
            "step 2 of the file has no measurement"
        );
        if k != 1 {
            assert_moments(
                &noises,
                Vector2::zeros(),
                matrix![0.7, 0.0; 0.0, covariance[(0, 0)]],
                "measurement noise",
            );
        }
    }
    // A noise of rank one moves the state along one line: (½, 1).
    let (first, second) = (&runs[0].states[0], &runs[0].states[1]);
    let moved = vector![second[0], second[1]] - f * vector![first[0], first[1]];
    assert!((moved[0] - 0.5 * moved[1]).abs() < 1e-12, "{moved:?}");
}

#[test]
fn correlated_noises_are_drawn_together() {
    let mut problem = linear(1);
    problem["modes"][0]["Q"] = json!([[0.5, 0.1], [0.1, 1.0]]);
    problem["modes"][0]["M"] = json!([[0.4], [-0.3]]);
    let runs = drawn(&read(&problem), 1, 4000);
    // The initial estimate is known, and with F it gives the mean and the rest of the covariance of (x, z − H x).
    let noises: Vec<_> = runs
        .iter()
        .map(|run| {
            let (x, z) = (&run.states[0], run.measurements[0].as_ref().unwrap()[0]);
            vector![x[0], z - 1.1 * x[0] - 0.3 * x[1]]
        })
        .collect();
    let f = matrix![1.0, 0.9; -0.2, 0.8];
    let predicted = f * matrix![2.0, 0.3; 0.3, 1.0] * f.transpose() + matrix![0.5, 0.1; 0.1, 1.0];
    let expected = (f * vector![3.0, -1.0])[0];
    assert_moments(
        &noises,
        vector![expected, 0.0],
        matrix![predicted[(0, 0)], 0.4; 0.4, 0.7],
        "x and its noise",
    );
}

#[test]
fn the_modes_follow_the_chain() {
    let runs = drawn(&read(&linear(2)), 50, 400);
    let first = runs.iter().filter(|run| run.modes[0] == 0).count() as f64;
    let chain = [[0.8, 0.2], [0.4, 0.6]];
    // From 0.3 and 0.7 one step on.
    let expected = 0.3 * 0.8 + 0.7 * 0.4;
    let distance = |count: f64, all: f64, p: f64| (count - all * p) / (all * p * (1.0 - p)).sqrt();
    // Counts are binomial; their distance from the mean exceeds four standard deviations with a probability below 1e-4.
    assert!(distance(first, 400.0, expected).abs() < 4.0, "{first} of 400");
    for (i, row) in chain.iter().enumerate() {
        let pairs = runs
            .iter()
            .flat_map(|run| run.modes.windows(2))
            .filter(|pair| pair[0] == i);
        let (stayed, all) = pairs.fold((0.0, 0.0), |(stayed, all), pair| {
            (stayed + f64::from(u8::from(pair[1] == 0)), all + 1.0)
        });
        assert!(distance(stayed, all, row[0]).abs() < 4.0, "from {i}: {stayed} of {all}");
    }
    // A mode that cannot be reached is never drawn.
    let mut problem = linear(2);
    problem["transition"] = json!([[1.0, 0.0], [0.0, 1.0]]);
    problem["initial"]["mode_probabilities"] = json!([1.0, 0.0]);
    assert!(
        drawn(&read(&problem), 20, 50)
            .iter()
            .all(|run| run.modes.iter().all(|mode| *mode == 0))
    );
}

#[test]
fn a_square_root_times_its_transpose_is_the_covariance() {
    // Ranks 3, 2, 1 and 0, and units that are far apart.
    let full = dmatrix![4.0, 2.0, 1.0; 2.0, 5.0, 3.0; 1.0, 3.0, 6.0];
    let one = dmatrix![1e-12, 2e-6, 0.0; 2e-6, 4.0, 0.0; 0.0, 0.0, 0.0];
    let two = dmatrix![1.0, 1.0, 0.0; 1.0, 2.0, 1.0; 0.0, 1.0, 1.0];
    for (matrix, rank) in [(full, 3), (two, 2), (one, 1), (DMatrix::zeros(3, 3), 0)] {
        let root = square_root(&matrix).unwrap();
        // A few roundings of the diagonal.
        let error = &root * root.transpose() - &matrix;
        for i in 0..3 {
            for j in 0..3 {
                let scale = (matrix[(i, i)] * matrix[(j, j)]).sqrt();
                assert!(error[(i, j)].abs() <= 1e-15 * scale, "{error}");
            }
        }
        assert_eq!(root.column_iter().filter(|column| column.norm() > 0.0).count(), rank);
    }
    assert_eq!(square_root(&dmatrix![1.0, 0.0; 0.0, -1e-3]), None);
}

#[test]
fn the_steps_of_the_file_are_kept_and_begin_again() {
    let mut problem = linear(2);
    problem["measurements"][2]["truth"] = json!([1.0, 2.0]);
    let planned = with_steps(&read(&problem), 7).unwrap();
    let there: Vec<bool> = planned.measurements.iter().map(|entry| entry.z.is_some()).collect();
    assert_eq!(there, [true, false, true, true, false, true, true]);
    assert!(planned.measurements.iter().all(|entry| entry.truth.is_none()));
    let result = compared(&problem, 2, 7);
    assert_eq!((result.steps, result.detections), (7, 5));
}

// What is compared

#[test]
fn a_matched_kalman_filter_is_consistent_and_a_wrong_one_is_not() {
    // The false alarm of each verdict is 1 %, and the seed is fixed.
    let matched = compared(&linear(1), 300, 12);
    let kalman = standing(&matched.tables[0], "kalman");
    let (nees, nis) = (kalman.nees.as_ref().unwrap(), kalman.nis.as_ref().unwrap());
    assert_eq!(
        (nees.calibration, nis.calibration),
        (Calibration::Consistent, Calibration::Consistent)
    );
    assert_eq!((nees.expected, nis.expected), (2.0, 1.0));
    assert_eq!((kalman.failed, kalman.diverged), (0, Some(0)));
    assert!(nees.bounds.0 < 2.0 && 2.0 < nees.bounds.1);
    // Where the mode changes, a filter that knows one mode alone believes too much.
    let changing = compared(&linear(2), 300, 12);
    let alone = standing(&changing.tables[1], "one alone");
    assert_eq!(alone.nees.as_ref().unwrap().calibration, Calibration::OverConfident);
    assert_eq!(alone.nis.as_ref().unwrap().calibration, Calibration::OverConfident);
}

#[test]
fn on_a_linear_problem_every_kind_is_the_kalman_filter() {
    for modes in [1, 2] {
        let result = compared(&linear(modes), 20, 6);
        let kinds = &result.tables[0];
        // Kalman, two extended, two unscented, four rules.
        assert_eq!(kinds.standings.len(), 9);
        for one in &kinds.standings {
            // Weights of 10⁶ cost six digits of sixteen.
            assert!(apart(one, standing(kinds, "kalman")) < 1e-7, "{}", one.name);
        }
        assert!(
            comparison::verdict(kinds).contains("kalman, equal but for rounding to"),
            "{}",
            comparison::verdict(kinds)
        );
    }
    // A sensor of range and bearing is missing for the others, and the reader says so.
    let absent = &compared(&linear(1), 2, 1).absent;
    assert_eq!(absent.len(), 4);
    assert!(
        absent.iter().all(|one| one.reason.contains("range and bearing")),
        "{absent:?}"
    );
}

#[test]
fn identical_modes_need_no_interaction() {
    let mut problem = linear(2);
    problem["modes"][1]["F"] = problem["modes"][0]["F"].clone();
    let result = compared(&problem, 20, 6);
    let table = &result.tables[1];
    assert_eq!(table.differs, Differs::Interaction);
    let names: Vec<&str> = table.standings.iter().map(|one| one.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "IMM",
            "GPB1",
            "unmixed",
            "static bank",
            "GPB2",
            "one alone",
            "other alone"
        ]
    );
    for one in &table.standings {
        // A few hundred roundings.
        assert!(apart(one, &table.standings[0]) < 1e-12, "{}", one.name);
    }
}

#[test]
fn where_modes_never_change_gpb2_is_the_static_bank_and_gpb1_is_not() {
    let mut problem = linear(2);
    problem["transition"] = json!([[1.0, 0.0], [0.0, 1.0]]);
    problem["measurements"][2]["R"] = json!([[0.2]]); // a step of its own
    let result = compared(&problem, 20, 6);
    let table = &result.tables[1];
    let bank = standing(table, "static bank");
    // A few hundred roundings.
    assert!(apart(standing(table, "GPB2"), bank) < 1e-12);
    assert!(apart(standing(table, "GPB1"), bank) > 1e-3);
    assert!(
        standing(table, "GPB2").nis.is_none(),
        "it has no innovation of its own to show"
    );
}

#[test]
fn a_filter_does_not_depend_on_those_beside_it() {
    // The same filter as the file's own, and as one of the others, gives the same bits.
    let mut problem = curved();
    let extended = compared(&problem, 10, 4);
    problem["filter"] = json!({ "kind": "cubature", "rule": "cubature-3" });
    let cubature = compared(&problem, 10, 4);
    for name in ["extended", "cubature-3", "gauss-hermite-3"] {
        let [a, b] = [&extended, &cubature].map(|result| standing(&result.tables[0], name));
        assert_eq!(a.components, b.components, "{name}");
        assert_eq!(
            a.nees.as_ref().unwrap().over_steps,
            b.nees.as_ref().unwrap().over_steps,
            "{name}"
        );
    }
    // And what they share is not in the uncertainty of their difference.
    let (best, other) = (
        &extended.tables[0].standings[0],
        standing(&extended.tables[0], "extended"),
    );
    assert!(other.groups[0].difference.standard_error < 0.2 * best.groups[0].error.standard_error);
}

#[test]
fn swapped_filters_have_the_opposite_difference() {
    let mut generator = Generator::new(5, 0);
    let mut squares = || {
        (0..40)
            .map(|_| generator.standard_normal().powi(2) + 0.1)
            .collect::<Vec<f64>>()
    };
    let (a, b) = ([squares(), squares()], [squares(), squares()]);
    let (there, back) = (paired_log_ratio(&a, &b), paired_log_ratio(&b, &a));
    assert!((there.value + back.value).abs() < 1e-15 && (there.standard_error - back.standard_error).abs() < 1e-15);
    assert!(paired_log_ratio(&a, &a).value.abs() < 1e-15);
    // Errors in other units are the same.
    let scaled = |of: &[Vec<f64>; 2]| [of[0].iter().map(|square| 1e6 * square).collect(), of[1].clone()];
    let other = paired_log_ratio(&scaled(&a), &scaled(&b));
    assert!((other.value - there.value).abs() < 1e-14, "{other:?} {there:?}");
}

#[test]
fn the_standard_error_of_a_ratio_is_its_spread_over_repetitions() {
    // 400 experiments of 100 runs. The spread of a standard deviation over 400 values is 1/√800 or 3.5 %; five of these are a false alarm
    // of less than 1e-6, and the delta method is off by a few per cent with 100 runs.
    let experiment = |number: u64| {
        let mut generator = Generator::new(9, number);
        let mut pairs = (Vec::new(), Vec::new());
        for _ in 0..100 {
            let (shared, own) = (generator.standard_normal(), generator.standard_normal());
            pairs.0.push(shared * shared + 0.2);
            pairs.1.push((shared + 0.5 * own).powi(2) + 0.2);
        }
        paired_log_ratio(&[pairs.0], &[pairs.1])
    };
    let all: Vec<_> = (0..400).map(experiment).collect();
    let values: Vec<f64> = all.iter().map(|ratio| ratio.value).collect();
    let spread = mean(&values).standard_error * 20.0;
    let stated = all.iter().map(|ratio| ratio.standard_error).sum::<f64>() / 400.0;
    assert!((spread / stated - 1.0).abs() < 0.2, "{spread} {stated}");
}

#[test]
fn angles_are_compared_the_short_way_round() {
    // A heading near π: the estimates are on both sides of the cut, and no error of a whole turn is in the mean.
    let result = compared(&published("heading.extended"), 50, 5);
    let heading = result.components.iter().position(|one| one.names == ["psi"]).unwrap();
    for one in &result.tables[0].standings {
        assert!(
            one.components[heading] < 1.0,
            "{}: {}",
            one.name,
            one.components[heading]
        );
    }
}

#[test]
fn components_with_one_unit_are_one_error() {
    let result = compared(&curved(), 4, 2);
    let names: Vec<_> = result.groups.iter().map(|group| group.names.join(" ")).collect();
    assert_eq!(names, ["x y", "v", "psi"]);
    let one = &result.tables[0].standings[0];
    let sum = one.components[0].hypot(one.components[1]);
    assert!((one.groups[0].error.value / sum - 1.0).abs() < 1e-12);
}

/// Four numbers, of which the square roots are measured: points two standard deviations away from 1 have none.
fn with_roots() -> Value {
    let row = |i: usize, diagonal: f64| (0..4).map(|j| if i == j { diagonal } else { 0.0 }).collect::<Vec<_>>();
    let unit = |diagonal: f64| json!((0..4).map(|i| row(i, diagonal)).collect::<Vec<_>>());
    json!({
        "format": "immaculate-problem/2",
        "id": "roots",
        "state": ["a", "b", "c", "d"],
        "f": ["a", "b", "c", "d"],
        "Q": unit(1e-4),
        "measurement": { "kind": "formulas", "z": ["r"], "h": ["sqrt(a) + b + c + d"] },
        "R": [[0.01]],
        "filter": { "kind": "extended" },
        "initial": { "mean": [1.0, 1.0, 1.0, 1.0], "covariance": unit(0.27) },
        "measurements": [{ "step": 1, "z": [4.0] }],
    })
}

#[test]
fn a_filter_that_fails_is_counted_and_its_errors_are_not_compared() {
    // The first seed with which the truth has roots.
    let problem = read(&with_roots());
    let sample = |seed| Sample {
        runs: Some(10),
        seed,
        steps: Some(2),
    };
    let contest = (1..)
        .find_map(|seed| Contest::new(&problem, sample(seed)).ok())
        .unwrap();
    let result = contest.run(&|| {});
    let table = &result.tables[0];
    let failing = standing(table, "cubature-3");
    assert_eq!((failing.failed, failing.log_ratio), (10, None));
    assert!(
        failing.failure.as_ref().unwrap().contains("step 1"),
        "{:?}",
        failing.failure
    );
    assert_eq!(table.common_runs, 10);
    assert!(standing(table, "extended").log_ratio.is_some());
    let text = comparison::text(&result);
    assert!(
        text.contains("cubature-3 fails in 10 runs, the first time in step 1"),
        "{text}"
    );
    assert!(text.contains("not compared"), "{text}");
}

#[test]
fn an_operation_counts_unless_it_is_known_beforehand() {
    let number = Counted::new;
    let matrix = |entries: [f64; 4]| Matrix2::from_row_slice(&entries.map(number));
    let (a, b) = (matrix([2.0, 3.0, 5.0, 7.0]), matrix([11.0, 13.0, 17.0, 19.0]));
    // Two products and a sum for each entry.
    let (product, operations) = Counted::during(|| a * b);
    assert_eq!((product[(0, 0)].value(), operations), (73.0, 12));
    assert_eq!(Counted::during(|| a * Matrix2::identity()).1, 0);
    // A quotient, two products and a difference.
    assert_eq!(Counted::during(|| ldl(&matrix([4.0, 2.0, 2.0, 10.0]))).1, 4);
    // The file's filter takes the same operations beside any other, and points take more than matrices.
    let result = compared(&linear(1), 2, 3);
    let cost = |name: &str| standing(&result.tables[0], name).operations.unwrap();
    assert!(cost("kalman") < cost("cubature-3") && cost("cubature-3") < cost("gauss-hermite-3"));
}

// What is printed

/// The comparison without its times, which are others in every run.
fn without_times(mut result: FilterComparison) -> FilterComparison {
    for one in result.tables.iter_mut().flat_map(|table| &mut table.standings) {
        assert!(
            one.time
                .is_some_and(|time| time.ratio.median > 0.0 && time.microseconds > 0.0),
            "{}",
            one.name
        );
        one.time = None;
    }
    result
}

#[test]
fn a_comparison_as_text() {
    insta::assert_snapshot!("text", comparison::text(&without_times(compared(&linear(2), 100, 6))));
    insta::assert_snapshot!(
        "text_curved",
        comparison::text(&without_times(compared(&curved(), 50, 3)))
    );
}

#[test]
fn a_comparison_as_a_figure() {
    let result = without_times(compared(&linear(2), 20, 6));
    for table in &result.tables {
        let svg = comparison_figure::draw(&result, table).unwrap();
        let document = roxmltree::Document::parse(&svg).unwrap();
        let described = document.descendants().find(|node| node.has_tag_name("desc")).unwrap();
        assert!(described.text().unwrap().contains("The most accurate"), "{svg}");
    }
    // A single step is drawn, too.
    let single = compared(&curved(), 3, 1);
    assert!(
        comparison_figure::draw(&single, &single.tables[0])
            .unwrap()
            .contains("<svg")
    );
}

// The program

/// A folder of its own for a test, empty.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("compare-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn file(folder: &Path, problem: &Value) -> String {
    let path = folder.join("problem.json");
    std::fs::write(&path, problem.to_string()).unwrap();
    path.display().to_string()
}

#[test]
fn a_seed_gives_the_same_answer_on_any_number_of_cores() {
    let folder = folder("cores");
    let file = file(&folder, &linear(2));
    let answer = |threads: &str, seed: &str| {
        let arguments = ["compare", &file, "--runs", "16", "--seed", seed, "--json"];
        let output = immaculate(&arguments)
            .env("RAYON_NUM_THREADS", threads)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", error_of(&output));
        let mut answer: Value = serde_json::from_slice(&output.stdout).unwrap();
        for table in answer["tables"].as_array_mut().unwrap() {
            for one in table["standings"].as_array_mut().unwrap() {
                assert!(one.as_object_mut().unwrap().remove("time").unwrap()["median"].is_number());
            }
        }
        answer
    };
    assert_eq!(answer("1", "1"), answer("2", "1"));
    assert_ne!(answer("1", "1"), answer("1", "2"));
}

#[test]
fn the_files_are_figures_and_the_answer_as_json() {
    let folder = folder("files");
    let file = file(&folder, &linear(2));
    let out = folder.join("out");
    let out_name = out.display().to_string();
    let output = immaculate(&["compare", &file, "--runs", "4", "--steps", "5", "--out", &out_name])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", error_of(&output));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.starts_with("Simulated: 4 runs of 5 steps (2 of them without a measurement), drawn"),
        "{text}"
    );
    assert_eq!(
        names(&out),
        [
            "comparison-filters.svg",
            "comparison-interactions.svg",
            "comparison.json"
        ]
    );
    // A published case by its id.
    let output = immaculate(&["compare", "derbez2000.fixed-gain.mixed", "--runs", "2"])
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("fixed-gain *") && text.contains("the file has fixed gains"),
        "{text}"
    );
}

#[test]
fn what_cannot_be_compared_is_refused_in_a_sentence() {
    let folder = folder("refused");
    let out = folder.join("out").display().to_string();
    let refusal = |problem: &Value, more: &[&str]| {
        let file = file(&folder, problem);
        let mut arguments = vec!["compare", &file, "--out", &out];
        arguments.extend(more);
        let output = immaculate(&arguments).output().unwrap();
        let sentence = error_of(&output);
        assert_eq!(output.status.code(), Some(2), "{sentence}");
        assert!(output.stdout.is_empty() && !Path::new(&out).exists(), "{sentence}");
        sentence
    };
    for runs in ["0", "1", "many"] {
        assert!(refusal(&linear(1), &["--runs", runs]).contains("--runs"), "{runs}");
    }
    assert!(refusal(&linear(1), &["--steps", "0"]).contains("--steps"));
    assert!(refusal(&json!({ "format": "none" }), &[]).contains("problem.json: "));
    let too_large = refusal(&linear(1), &["--steps", "100000", "--runs", "1000"]);
    assert!(too_large.contains("need more than a gigabyte; at most"), "{too_large}");
    // A motion whose result is no number for half of what can be drawn.
    let mut rooted = with_roots();
    rooted["f"][0] = json!("sqrt(a)");
    rooted["initial"]["covariance"][0][0] = json!(25.0);
    let sentence = refusal(&rooted, &["--runs", "20"]);
    assert!(
        sentence.contains("no truth can be drawn: in run") && sentence.contains("not finite"),
        "{sentence}"
    );
    let mut without = linear(1);
    without["measurements"] = json!([]);
    let sentence = refusal(&without, &[]);
    assert!(sentence.contains("problem.measurements: "), "{sentence}");
    let nowhere = immaculate(&["compare", "nowhere.json"]).output().unwrap();
    assert_eq!(nowhere.status.code(), Some(2));
    assert!(error_of(&nowhere).contains("nowhere.json: "));
    // The library says of runs what the command line says.
    assert_eq!(contest(&linear(1), 1, 2).unwrap_err(), NotCompared::FewRuns(1));
}
