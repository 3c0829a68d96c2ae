//! Goal: the published problems are what their purposes and flags say.
//!
//! Method: every problem is checked and run in doubles, and each flag whose meaning can be computed is computed from the problem or from
//! its run. Kind of evidence: oracle. That the expected values are right is not the question here.

#![allow(clippy::float_cmp, reason = "zeros and ones of a file are exact")]

mod common;
mod published;

use common::program::names;
use immaculate::file::digest;
use immaculate::imm::{Failure, Quantity};
use immaculate::matrix::is_positive_definite;
use immaculate::number::{Rational, Real};
use immaculate::oracle::behaviour::Behaviour;
use immaculate::oracle::case::{self, Case, Expected};
use immaculate::oracle::flags::FLAGS;
use immaculate::oracle::problem::{FAMILIES, FilterFile, MeasurementAt, MeasurementFile, ModeFile, ProblemFile, Rows};
use immaculate::oracle::trace::Trace;
use nalgebra::DMatrix;
use published::write::write;
use published::{all, rejected};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Digits that every common reader of JSON reads rightly.
const DIGITS: usize = 15;

#[test]
fn ids_are_unique_and_of_lower_case_words() {
    let mut ids = BTreeSet::new();
    for problem in everything() {
        let id = &problem.id;
        let is_word = |word: &str| {
            let mut letters = word.chars();
            !word.is_empty() && letters.all(|c| c.is_ascii_lowercase() || c.is_ascii_digit())
        };
        assert!(id.split(['.', '-']).all(is_word), "{id}");
        assert!(id.contains('.') && id.len() <= 40, "{id}");
        assert!(ids.insert(id.clone()), "{id} twice");
    }
}

#[test]
fn every_flag_is_explained_and_every_explained_flag_is_used() {
    let mut used = BTreeSet::new();
    for problem in everything() {
        let flags: BTreeSet<String> = problem.flags.iter().cloned().collect();
        assert_eq!(flags.len(), problem.flags.len(), "{}: a flag twice", problem.id);
        used.extend(flags);
    }
    let explained: BTreeSet<String> = FLAGS.iter().map(|(flag, _)| (*flag).to_owned()).collect();
    assert_eq!(explained.len(), FLAGS.len(), "a flag is explained twice");
    assert_eq!(used, explained);
    for (flag, sentence) in FLAGS {
        assert!(sentence.ends_with('.'), "{flag}: {sentence}");
    }
}

#[test]
fn every_problem_has_a_purpose_and_numbers_of_its_own() {
    let mut purposes = BTreeSet::new();
    let mut contents = BTreeMap::new();
    for problem in everything() {
        let is_sentence = problem.about.len() > 40 && problem.about.ends_with('.') && !problem.about.contains("  ");
        assert!(is_sentence, "{}: {}", problem.id, problem.about);
        assert!(
            purposes.insert(problem.about.clone()),
            "{}: the purpose of another",
            problem.id
        );
        let (id, bare) = (problem.id.clone(), bare(&problem).to_string());
        if let Some(other) = contents.insert(bare, id.clone()) {
            panic!("{id} is {other} over again");
        }
    }
}

#[test]
fn there_are_many_short_problems_and_few_long_ones() {
    let problems = all();
    let long = problems.iter().filter(|problem| problem.measurements.len() > 6).count();
    assert!((70..220).contains(&problems.len()), "{}", problems.len());
    assert!(long <= problems.len() / 10, "{long}");
    for problem in &problems {
        let steps = problem.measurements.len();
        let expected = match steps {
            1 => ["single-step", "single-equation"].as_slice(),
            2..=6 => &["sequence"],
            _ => &["run"],
        };
        let is_told = expected.iter().any(|flag| has(problem, flag));
        assert!(is_told, "{}: {steps} steps", problem.id);
    }
}

/// Exact: the files hold the problems that the program makes, number by number, those that must be refused with their class, and no others.
#[test]
fn the_published_files_are_what_the_program_makes() {
    let made = all().into_iter().map(|problem| (problem, None));
    let refused = rejected().into_iter().map(|(problem, class, _)| (problem, Some(class)));
    let made: BTreeMap<String, _> = made.chain(refused).map(|made| (made.0.id.clone(), made)).collect();
    let published = case::all().unwrap();
    for case in published {
        let class = match &case.expected {
            Expected::Trace(_) => None,
            Expected::Rejection(class) => Some(*class),
        };
        let mut problem = case.problem.clone();
        problem.lacks_consistency = false; // that is known of a trace
        assert_eq!(
            made.get(&case.problem.id),
            Some(&(problem, class)),
            "{}",
            case.problem.id
        );
    }
    assert_eq!(published.len(), made.len());
}

#[test]
fn no_number_has_more_than_fifteen_significant_digits() {
    for problem in everything() {
        let text = serde_json::to_string(&problem).unwrap();
        assert_eq!(ProblemFile::parse(&text).unwrap(), problem, "{}: read back", problem.id);
        let mut numbers = Vec::new();
        collect(&serde_json::from_str(&text).unwrap(), &mut numbers);
        for number in numbers {
            let mantissa = number.split('e').next().unwrap_or_default();
            let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
            let significant = digits.trim_matches('0').len();
            assert!(significant <= DIGITS, "{}: {number}", problem.id);
            assert_ne!(number, "-0.0", "{}", problem.id);
        }
    }
}

#[test]
fn every_problem_runs_in_doubles() {
    for problem in all() {
        if let Err(error) = problem.check() {
            panic!("{}: {error}", problem.id);
        }
        let run = run(&problem);
        assert!(run.failures.is_empty(), "{}: {:?}", problem.id, run.failures);
        for (step, quantity, mode) in run.values.all_places() {
            let Some(values) = run.values.get(step, quantity, mode) else {
                continue;
            };
            let is_finite = values.iter().all(|value| value.is_finite());
            assert!(is_finite, "{}: step {step}, {}", problem.id, quantity.name());
        }
    }
}

#[test]
fn every_rejected_problem_is_rejected_for_its_reason() {
    let classes = rejected().into_iter().map(|(problem, class, reason)| {
        let error = problem.check().expect_err(&problem.id);
        assert_eq!(error.class, class, "{}: {error}", problem.id);
        assert!(problem.about.contains(reason), "{}: {reason}", problem.id);
        class.name()
    });
    let classes: BTreeSet<_> = classes.collect();
    let documented = [
        "shape",
        "not-a-probability",
        "not-symmetric",
        "not-positive-definite",
        "unknown",
        "angle",
        "range",
        "format",
    ];
    assert_eq!(classes, BTreeSet::from(documented));
}

#[test]
fn a_rejected_problem_differs_from_a_published_one_in_exactly_one_thing() {
    let published = all();
    for (problem, ..) in rejected() {
        let of = published
            .iter()
            .find(|other| problem.about.contains(&format!("The problem {},", other.id)))
            .unwrap_or_else(|| panic!("{} names its origin", problem.id));
        let places = differences("", &bare(&problem), &bare(of));
        assert_eq!(places.len(), 1, "{}: {places:?}", problem.id);
    }
}

#[test]
fn covariances_have_no_zeros_unless_it_is_said() {
    for problem in everything() {
        let initial = problem
            .initial
            .modes
            .iter()
            .filter_map(|estimate| estimate.covariance.as_ref());
        let noises = problem.modes.iter().map(|mode| &mode.noise);
        let mut entries = initial.chain(noises).chain([&problem.noise]).flatten().flatten();
        let has_zero = entries.any(|&entry| entry == 0.0);
        assert_eq!(has_zero, has(&problem, "zeros"), "{}", problem.id);
        assert_eq!(has_zero, !has(&problem, "full-correlation"), "{}", problem.id);
    }
}

#[test]
fn flags_of_modes_and_chains_are_true() {
    for problem in all() {
        let id = &problem.id;
        let r = problem.modes.len();
        assert_eq!(has(&problem, "one-mode"), r == 1, "{id}");
        let is_symmetric = |chain: &Rows| (0..r).all(|i| (0..r).all(|j| chain[i][j] == chain[j][i]));
        // A chain by rates or sojourn times has no transition matrix.
        let by_rates = problem.rates.iter().chain(&problem.jumps).next();
        let chain = by_rates.unwrap_or(&problem.transition);
        let asymmetric = !is_symmetric(chain);
        assert!(
            asymmetric || !has(&problem, "transition-order"),
            "{id}: a symmetric chain"
        );
        let is_same = problem
            .modes
            .iter()
            .all(|mode| (&mode.transition, &mode.noise) == first(&problem));
        let is_same = is_same
            && problem
                .initial
                .modes
                .iter()
                .all(|mode| *mode == problem.initial.modes[0]);
        assert_eq!(has(&problem, "identical-modes"), is_same && r > 1, "{id}");
        let is_absorbing = (0..r).any(|i| chain[i][i] == 1.0) && asymmetric;
        assert_eq!(has(&problem, "absorbing"), is_absorbing, "{id}");
        let is_zero = |row: &Vec<f64>| row.iter().all(|&entry| entry == 0.0);
        let is_embedded = problem.modes.iter().any(|mode| mode.transition.iter().any(is_zero));
        assert_eq!(has(&problem, "embedded"), is_embedded, "{id}");
        let states_unequal = problem.conventions.unequal_dimensions.is_some();
        assert_eq!(has(&problem, "unequal-dimensions"), states_unequal, "{id}");
        assert!(is_embedded || !states_unequal, "{id}");
        let means: BTreeSet<String> = problem.initial.modes.iter().map(|e| format!("{:?}", e.mean)).collect();
        assert!(means.len() == r || !has(&problem, "spread"), "{id}: equal means");

        let run = run(&problem);
        let reached = run.each(Quantity::PredictedModeProbabilities);
        let is_unreachable = reached.iter().any(|(.., probabilities)| probabilities.contains(&0.0));
        assert_eq!(has(&problem, "unreachable"), is_unreachable, "{id}");
    }
}

#[test]
fn flags_of_detections_and_outliers_are_true() {
    for problem in all() {
        let id = &problem.id;
        let missed: Vec<bool> = problem.measurements.iter().map(|entry| entry.z.is_none()).collect();
        let says = has(&problem, "missed-detection") || has(&problem, "single-equation");
        assert!(says || !missed.contains(&true), "{id}");
        assert!(missed.contains(&true) || !has(&problem, "missed-detection"), "{id}");
        let in_a_row = missed.windows(2).any(|pair| pair == [true, true]);
        assert_eq!(has(&problem, "missed-in-a-row"), in_a_row, "{id}");

        let is_partial = |entry: &MeasurementAt| entry.entries().count() < entry.z.as_ref().map_or(0, Vec::len);
        assert_eq!(
            has(&problem, "missing-entry"),
            problem.measurements.iter().any(is_partial),
            "{id}"
        );
        let run = run(&problem);
        let mut greatest = BTreeMap::new();
        for (step, _, value) in run.each(Quantity::LogLikelihood) {
            let best: &mut f64 = greatest.entry(step).or_insert(f64::NEG_INFINITY);
            *best = best.max(value[0]);
        }
        let underflows = greatest.values().any(|&best| libm::exp(best) == 0.0);
        assert_eq!(has(&problem, "outlier"), underflows, "{id}: {greatest:?}");
    }
}

/// What is asked of one kind of filter is asked of every other, or it has no such thing.
#[test]
fn every_filter_meets_every_behaviour_or_a_reason_says_why_not() {
    for family in FAMILIES {
        for behaviour in Behaviour::ALL {
            let has_family =
                |problem: &ProblemFile| (0..problem.modes.len()).any(|mode| problem.filter_of(mode).family() == family);
            let meets = |problem: &&ProblemFile| has_family(problem) && Behaviour::of(problem).contains(&behaviour);
            let cases = all().iter().filter(meets).count();
            let reason = behaviour.impossible_for(family);
            assert_eq!(
                cases == 0,
                reason.is_some(),
                "{family}, {}: {cases} cases, {reason:?}",
                behaviour.name()
            );
        }
    }
}

#[test]
fn flags_of_exact_estimates_and_measurements_are_true() {
    for problem in all() {
        let id = &problem.id;
        let is_singular = |rows: &Rows| {
            let exact = |row: usize, column: usize| Rational::from_f64(rows[row][column]);
            !is_positive_definite(&DMatrix::from_fn(rows.len(), rows.len(), exact))
        };
        let mut given = problem
            .initial
            .modes
            .iter()
            .filter_map(|estimate| estimate.covariance.as_ref());
        // What a mode lacks is not known exactly: it is not there.
        let is_exact = is_singular(&problem.noise) || (!has(&problem, "embedded") && given.any(is_singular));
        assert_eq!(has(&problem, "exact"), is_exact, "{id}");
    }
}

#[test]
fn flags_of_filters_and_angles_are_true() {
    for problem in all() {
        let id = &problem.id;
        let is_linear = matches!(problem.measurement, MeasurementFile::Linear { .. });
        let draws = |filter: &FilterFile| matches!(filter, FilterFile::Cubature { .. } | FilterFile::Unscented { .. });
        let has_points = (0..problem.modes.len()).any(|mode| draws(problem.filter_of(mode)));
        let is_matrix = |mode: &ModeFile| mode.models.formulas.is_none() && mode.models.motion.is_none();
        let moves_linearly = problem.modes.iter().all(is_matrix);
        let is_extended = matches!(problem.filter, FilterFile::Extended { .. });
        let is_fixed = matches!(problem.filter, FilterFile::FixedGain { .. });
        assert_eq!(has(&problem, "fixed-gain"), is_fixed, "{id}");
        let is_converted = matches!(problem.filter, FilterFile::Converted { .. });
        assert_eq!(has(&problem, "converted"), is_converted, "{id}");
        assert_eq!(
            has(&problem, "as-kalman"),
            is_linear && moves_linearly && (has_points || is_extended),
            "{id}"
        );
        let is_same = |step: usize| {
            let entry = &problem.measurements[step];
            let keeps_length = entry.interval.is_none();
            keeps_length
                && entry.transitions.is_none()
                && entry.noises.is_none()
                && entry.noise.is_none()
                && entry.transition.is_none()
        };
        let has_angle = problem.conventions.state_angle_mean.is_some();
        assert_eq!(has(&problem, "state-angle"), has_angle, "{id}");
        let changes = !(0..problem.measurements.len()).all(is_same);
        assert_eq!(has(&problem, "changing-steps"), changes, "{id}");

        let run = run(&problem);
        assert_eq!(has(&problem, "negative-weight"), run.has_negative_weight, "{id}");
        let mut wraps = false;
        let mut straddles = false;
        for (step, mode, innovation) in run.each(Quantity::Innovation) {
            let of = |quantity| run.values.get(step, quantity, mode).unwrap();
            let predicted = of(Quantity::PredictedMeasurement);
            let s = of(Quantity::InnovationCovariance);
            let entry = &problem.measurements[step - 1];
            let sensor = problem.sensor_of(entry).unwrap();
            let angles = problem.angles_of(&problem.sensors_at()[sensor]);
            let m = entry.entries().count();
            let is_angle = |(_, (place, _)): &(usize, (usize, f64))| angles[*place] && !is_converted;
            for (row, (_, z)) in entry.entries().enumerate().filter(is_angle) {
                wraps |= (z - predicted[row] - innovation[row]).abs() > 1.0;
                // A point of every rule in use lies beyond one standard deviation.
                straddles |= has_points && predicted[row].abs() + s[row * m + row].sqrt() > f64::pi();
            }
        }
        assert_eq!(has(&problem, "wrap"), wraps, "{id}");
        assert_eq!(has(&problem, "straddling"), straddles, "{id}");
    }
}

#[test]
fn equal_distances_are_equal_and_determinants_are_not() {
    for (id, ratio) in [
        ("likelihood.equal-distance.scalar", 4.0),
        ("likelihood.equal-distance.plane", 16.0),
    ] {
        let run = run(&of(id));
        let likelihoods: Vec<f64> = run
            .each(Quantity::LogLikelihood)
            .iter()
            .map(|(.., value)| value[0])
            .collect();
        // Only the logarithms round: two of them, each of a number below 20.
        let difference = likelihoods[0] - likelihoods[1];
        approx::assert_abs_diff_eq!(difference, 0.5 * Real::ln(&ratio), epsilon = 8.0 * f64::EPSILON);
    }
}

#[test]
fn mirror_images_have_the_same_likelihoods() {
    let original = run(&of("wrap.counter-clockwise")).each(Quantity::LogLikelihood);
    for (id, relative) in [("wrap.clockwise", 1e-11), ("wrap.mirrored-to-zero", 1e-9)] {
        // The first image is exact, and five steps lose a few digits; the bearings of the second have twelve digits.
        let image = run(&of(id)).each(Quantity::LogLikelihood);
        for (a, b) in original.iter().zip(&image) {
            approx::assert_relative_eq!(a.2[0], b.2[0], max_relative = relative);
        }
    }
}

#[test]
fn other_units_give_the_same_probabilities() {
    let metres = run(&of("steps.kalman")).each(Quantity::ModeProbabilities);
    for id in ["units.nanometres", "units.gigametres", "units.mixed"] {
        let image = run(&of(id)).each(Quantity::ModeProbabilities);
        assert_eq!(image.len(), 3, "{id}");
        for (a, b) in metres.iter().zip(&image) {
            for (a, b) in a.2.iter().zip(&b.2) {
                // The numbers of the file have twelve digits, and three steps cost a few of a double's.
                approx::assert_relative_eq!(*a, *b, max_relative = 1e-10);
            }
        }
    }
}

#[test]
fn every_rule_gives_the_kalman_filter_where_all_is_linear() {
    let linear = all().into_iter().filter(|problem| has(problem, "as-kalman"));
    for mut problem in linear {
        let with_points = run(&problem);
        problem.filter = FilterFile::Kalman {};
        let plain = run(&problem);
        let mut last = (0, f64::NAN, f64::NAN);
        for (a, b) in with_points
            .each(Quantity::LogLikelihood)
            .iter()
            .zip(&plain.each(Quantity::LogLikelihood))
        {
            // Tens of steps, each with a Cholesky factor, of covariances of condition 10⁶ or so.
            if (a.2[0] - b.2[0]).abs() > 1e-8 {
                last = (a.0, a.2[0], b.2[0]);
            }
        }
        assert_eq!(last.0, 0, "{}: {last:?}", problem.id);
    }
}

// Writing cases

/// For maintainers, when a draft is new:
///
/// ```console
/// $ cargo test --test cases -- --ignored write_the_cases_that_are_new
/// ```
#[test]
#[ignore = "writes files into fixtures/cases"]
fn write_the_cases_that_are_new() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/cases");
    println!("{} cases written", write(&folder).unwrap());
}

/// A published case is never changed: neither its problem, nor its name after it was withdrawn.
#[test]
fn a_published_case_is_not_written_again() {
    let lock = json!(case::lock().unwrap());
    let place = lock["cases"]
        .as_array()
        .unwrap()
        .iter()
        .position(|case| case["id"] == "update.kalman")
        .unwrap();
    let mut changed = lock.clone();
    let digest = digest("another problem");
    changed["cases"][place]["problem"] = json!(digest);
    let mut withdrawn = lock.clone();
    withdrawn["cases"][place]["withdrawn"] = json!("its purpose was another case's");
    // One is new besides: it is not written either.
    for lock in [&mut changed, &mut withdrawn] {
        lock["cases"]
            .as_array_mut()
            .unwrap()
            .retain(|case| case["id"] != "update.cubature-3");
        let folder = with_lock("not written again", &lock.to_string());
        let complaint = write(&folder).unwrap_err();
        assert!(
            complaint.contains("`update.kalman` is published and was changed or withdrawn"),
            "{complaint}"
        );
        assert_eq!(names(&folder), ["lock.json"]);
        assert_eq!(
            std::fs::read_to_string(folder.join("lock.json")).unwrap(),
            lock.to_string()
        );
    }
}

#[test]
fn a_lock_that_cannot_be_read_is_named_and_nothing_is_written() {
    for (lock, words) in [
        ("", "EOF"),
        ("{\"format\":\"immaculate-lock/1\"}", "missing field `cases`"),
        ("{\"format\":\"immaculate-lock/2\",\"cases\":[]}", "immaculate-lock/2"),
        (
            "{\"format\":\"immaculate-lock/1\",\"cases\":[],\"colour\":1}",
            "unknown field `colour`",
        ),
    ] {
        let folder = with_lock("bad lock", lock);
        let complaint = write(&folder).unwrap_err();
        assert!(
            complaint.contains("lock.json: ") && complaint.contains(words),
            "{complaint}"
        );
        assert_eq!(names(&folder), ["lock.json"]);
    }
    let nowhere = temporary("no folder");
    let complaint = write(&nowhere).unwrap_err();
    assert!(complaint.contains("lock.json: ") && !nowhere.exists(), "{complaint}");
}

/// Exact: new cases are written as the published ones were, and the lock has them last.
#[test]
fn new_cases_are_written_and_locked() {
    let mut lock = case::lock().unwrap();
    let new = ["consistency.kalman", "rejected.shape.matrix"];
    lock.cases.retain(|case| !new.contains(&case.id.as_str()));
    let before = lock.cases.len();
    let folder = with_lock("new", &json!(lock).to_string());
    assert_eq!(write(&folder), Ok(2));
    assert_eq!(names(&folder).len(), 5);
    for id in new {
        let read = |name: String| std::fs::read_to_string(folder.join(name)).unwrap();
        assert_eq!(read(case::problem_name(id)), locked(id).problem_text);
        assert_eq!(read(case::trace_name(id)), locked(id).trace_text);
    }
    let written: case::Lock =
        serde_json::from_str(&std::fs::read_to_string(folder.join("lock.json")).unwrap()).unwrap();
    assert_eq!(written.cases[..before], lock.cases);
    assert_eq!([&written.cases[before].id, &written.cases[before + 1].id], new);
    // Once more: nothing is new.
    let text = std::fs::read_to_string(folder.join("lock.json")).unwrap();
    assert_eq!(write(&folder), Ok(0));
    assert_eq!(std::fs::read_to_string(folder.join("lock.json")).unwrap(), text);
}

// What the tests ask of a problem and of its run

/// All problems, those that must be rejected among them.
fn everything() -> Vec<ProblemFile> {
    let rejected = rejected().into_iter().map(|(problem, ..)| problem);
    all().into_iter().chain(rejected).collect()
}

fn of(id: &str) -> ProblemFile {
    all().into_iter().find(|problem| problem.id == id).unwrap()
}

fn has(problem: &ProblemFile, flag: &str) -> bool {
    problem.flags.iter().any(|has| has == flag)
}

fn first(problem: &ProblemFile) -> (&Rows, &Rows) {
    (&problem.modes[0].transition, &problem.modes[0].noise)
}

/// A problem as JSON without its name and purpose.
fn bare(problem: &ProblemFile) -> Value {
    let mut value = serde_json::to_value(problem).unwrap();
    let object = value.as_object_mut().unwrap();
    for key in ["id", "about", "flags"] {
        object.remove(key);
    }
    value
}

/// The numbers of a JSON value as they are written.
fn collect(value: &Value, numbers: &mut Vec<String>) {
    match value {
        Value::Number(number) => numbers.push(number.to_string()),
        Value::Array(list) => list.iter().for_each(|value| collect(value, numbers)),
        Value::Object(map) => map.values().for_each(|value| collect(value, numbers)),
        _ => {}
    }
}

/// The places at which two JSON values differ; a list of numbers is one place.
fn differences(place: &str, a: &Value, b: &Value) -> Vec<String> {
    match (a, b) {
        (Value::Object(a), Value::Object(b)) if a.keys().eq(b.keys()) => a
            .iter()
            .flat_map(|(key, a)| differences(&format!("{place}.{key}"), a, &b[key]))
            .collect(),
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() && !a.iter().any(Value::is_number) => {
            let pairs = a.iter().zip(b).enumerate();
            pairs
                .flat_map(|(index, (a, b))| differences(&format!("{place}[{index}]"), a, b))
                .collect()
        }
        (a, b) if a == b => Vec::new(),
        _ => vec![place.to_owned()],
    }
}

/// A run in doubles.
struct Run {
    values: Trace,
    failures: Vec<Failure>,
    has_negative_weight: bool,
}

impl Run {
    /// Step, mode and value of a quantity wherever it has one.
    fn each(&self, quantity: Quantity) -> Vec<(usize, usize, Vec<f64>)> {
        let places = self.values.all_places().filter(|place| place.1 == quantity);
        places
            .filter_map(|(step, quantity, mode)| {
                let value = self.values.get(step, quantity, mode)?;
                Some((step, mode, value.clone()))
            })
            .collect()
    }
}

fn run(problem: &ProblemFile) -> Run {
    let setup = problem.setup_in_doubles().unwrap();
    let rules = setup.problem.filters.iter().flat_map(|filter| filter.rules());
    let mut weights = rules
        .flatten()
        .flat_map(|rule| rule.weights.iter().chain(&rule.covariance_weights));
    let computed = setup.run();
    Run {
        has_negative_weight: weights.any(|weight| weight.value() < 0.0),
        values: computed.in_doubles(),
        failures: computed.failures,
    }
}

fn locked(id: &str) -> &'static Case {
    let all = case::all().unwrap();
    all.iter().find(|case| case.problem.id == id).unwrap()
}

/// A folder that holds nothing but a lock.
fn with_lock(name: &str, lock: &str) -> PathBuf {
    let folder = temporary(name);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("lock.json"), lock).unwrap();
    folder
}

/// A place of this test's own, where nothing is.
fn temporary(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cases").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    folder
}
