//! Goal: a search finds what is wrong with a program, says nothing of a right one, and leaves the smallest problem that shows it.
//!
//! Method: this crate's own filter is searched, right or with a mistake of the catalogue in it, and programs that stop, skip, forget or
//! end. Each seed is fixed, so that each run is the same. Kind of evidence: example, and exhaustion over the kinds of filter.

mod common;

use common::program::immaculate;
use immaculate::imm::Quantity;
use immaculate::oracle::case::problem_text;
use immaculate::oracle::certify::certified_as_far_as_it_goes;
use immaculate::oracle::check::{NotMade, Outcome, check_problems};
use immaculate::oracle::diagnose::Diagnosis;
use immaculate::oracle::problem::{FORMAT, ProblemFile, kinds};
use immaculate::oracle::search::size::Size;
use immaculate::oracle::search::{
    Found, Offer, Request, Searched, ShrinkingLimits, Symptom, drawn, drawn_around, in_words, reductions, search,
};
use immaculate::oracle::subject::{Answer, Broken, Level, Planted, Ready, Subject};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::Duration;

// What is drawn

/// All kinds, in both formats.
fn everything() -> Offer {
    Offer {
        kinds: kinds().map(str::to_owned).collect(),
        is_format_2: true,
    }
}

/// The drawn problems of some numbers.
fn some(numbers: std::ops::Range<u64>) -> Vec<ProblemFile> {
    let all = everything();
    numbers.filter_map(|number| drawn(5, number, &all)).collect()
}

#[test]
fn a_drawn_problem_is_read_from_its_own_file() {
    let problems = some(0..300);
    assert!(problems.len() > 250, "{} of 300", problems.len());
    for problem in &problems {
        let text = problem_text(problem);
        assert_eq!(ProblemFile::read(&text).as_ref(), Ok(problem), "{text}");
    }
}

/// Modes with states of their own, and chains in continuous time, are not drawn.
fn is_drawn(kind: &&str) -> bool {
    !["state-conversion", "continuous-chain"].contains(kind)
}

#[test]
fn every_kind_and_every_behaviour_is_drawn() {
    let problems = some(0..300);
    let drawn: BTreeSet<&str> = problems.iter().flat_map(ProblemFile::kinds).collect();
    assert_eq!(drawn, kinds().filter(is_drawn).collect());
    let flags: BTreeSet<&str> = problems
        .iter()
        .flat_map(|problem| &problem.flags)
        .map(String::as_str)
        .collect();
    let expected = [
        "absorbing",
        "changing-steps",
        "formulas",
        "input",
        "missed-detection",
        "missing-entry",
        "outlier",
        "several-sensors",
        "state-angle",
        "units",
        "unreachable",
        "wrap",
    ];
    assert_eq!(flags, BTreeSet::from(expected));
}

#[test]
fn a_number_of_a_seed_is_one_problem_whatever_was_asked_before() {
    let all = everything();
    let [first, second] = [(); 2].map(|()| some(0..40));
    assert_eq!(first, second);
    // Some numbers draw a problem that would be refused.
    let (number, alone) = (17..40)
        .find_map(|number| Some((number, drawn(5, number, &all)?)))
        .unwrap();
    assert!(first.contains(&alone));
    assert_ne!(drawn(6, number, &all), Some(alone), "another seed");
}

#[test]
fn a_program_of_format_1_is_offered_nothing_of_format_2() {
    let offer = Offer {
        is_format_2: false,
        ..everything()
    };
    for number in 0..100 {
        let problem = drawn(5, number, &offer);
        assert!(problem.is_none_or(|problem| problem.format == FORMAT));
    }
}

fn car() -> ProblemFile {
    ProblemFile::read(include_str!("adapters/automotive.json")).unwrap()
}

#[test]
fn a_problem_around_another_keeps_its_formulas_and_shapes() {
    let car = car();
    let all = [car.clone()];
    let first = drawn_around(5, 0, &all).unwrap();
    assert_eq!((&first.measurements, &first.initial), (&car.measurements, &car.initial));
    for number in 1..20 {
        let problem = drawn_around(5, number, &all).unwrap();
        assert_eq!(ProblemFile::read(&problem_text(&problem)).as_ref(), Ok(&problem));
        assert_ne!(problem.measurements[0].z, car.measurements[0].z);
        assert_ne!(problem.initial, car.initial);
        assert_eq!((&problem.state, &problem.definitions), (&car.state, &car.definitions));
        for (mode, own) in problem.modes.iter().zip(&car.modes) {
            assert_eq!(mode.models.formulas, own.models.formulas);
        }
    }
}

// What shrinking does

#[test]
fn every_reduction_is_smaller_so_that_shrinking_ends() {
    let mut tried = 0;
    for problem in some(0..30) {
        let size = Size::of(&problem);
        for smaller in reductions(&problem) {
            assert!(Size::of(&smaller) < size, "{size:?}: {}", problem_text(&smaller));
            tried += 1;
        }
    }
    assert!(tried > 3000, "{tried}");
    // From the first reduction to the first of that, and so on, there is an end, at a problem of nothing.
    let mut problem = some(0..1).remove(0);
    while let Some(smaller) = reductions(&problem).into_iter().next() {
        problem = smaller;
    }
    assert_eq!(in_words(&problem), "1 step, 1 mode, 1 component, 1 measured");
}

// What is found

fn planted(variants: &[&str]) -> Planted {
    Planted {
        variants: variants.iter().map(|&id| id.to_owned()).collect(),
        level: Level::Everything,
    }
}

/// A search by numbers and not by time.
fn request(most: u64, only: &[&str]) -> Request {
    let time = Duration::from_secs(3600);
    Request {
        seed: 1,
        time,
        most,
        kinds: only.iter().map(|&kind| kind.to_owned()).collect(),
        around: Vec::new(),
        shrinking: ShrinkingLimits { tries: 3000, time },
    }
}

fn searched(program: &mut dyn Subject, request: &Request) -> Searched {
    search(program, request, &|_| {}).unwrap()
}

fn found(program: &mut dyn Subject, request: &Request) -> Found {
    searched(program, request).found.expect("something is found")
}

/// A mistake, where it is, and the steps, modes, components of the state and of the measurement by which it is shown, at most. The motion
/// of the first step differs from that of the second by its length alone, which only formulas know: they need what they name.
const MISTAKES: [(&str, Quantity, [usize; 4]); 12] = [
    (
        "transition-transposed",
        Quantity::PredictedModeProbabilities,
        [1, 2, 1, 1],
    ),
    ("mixed-spread-omitted", Quantity::MixedCovariance, [1, 2, 1, 1]),
    ("mixing-normalised-by-rows", Quantity::MixingProbabilities, [1, 2, 1, 1]),
    ("process-noise-doubled", Quantity::PredictedCovariance, [1, 1, 1, 1]),
    (
        "measurement-matrix-by-columns",
        Quantity::PredictedMeasurement,
        [1, 1, 2, 2],
    ),
    ("innovation-not-wrapped", Quantity::Innovation, [1, 1, 2, 1]),
    ("covariance-not-updated", Quantity::UpdatedCovariance, [1, 1, 1, 1]),
    ("determinant-omitted", Quantity::LogLikelihood, [1, 1, 1, 1]),
    // The first that shows it converts range and bearing, of which there are two.
    ("likelihood-floor-1e-300", Quantity::ModeProbabilities, [1, 2, 2, 2]),
    ("probabilities-not-advanced", Quantity::ModeProbabilities, [1, 2, 1, 1]),
    // A named model keeps its components: those of a turn.
    ("motion-of-the-first-step", Quantity::PredictedMean, [2, 1, 5, 1]),
    ("combined-spread-omitted", Quantity::CombinedCovariance, [1, 2, 1, 1]),
];

#[test]
fn a_mistake_is_found_and_shown_by_no_more_than_it_needs() {
    for (id, quantity, [steps, modes, components, measured]) in MISTAKES {
        let found = found(&mut planted(&[id]), &request(400, &[]));
        assert_eq!(found.failure, Symptom::Fault(quantity), "{id}");
        let problem = &found.problem;
        let dimensions = problem.dimensions();
        let size = [dimensions.steps(), dimensions.r, dimensions.n, problem.noise.len()];
        let limits = [steps, modes, components, measured];
        let is_small = size.iter().zip(limits).all(|(found, limit)| *found <= limit);
        assert!(is_small, "{id}: {}", problem_text(problem));
        assert_eq!(found.shrinking.cut_short, None, "{id}");
        // The verdict is an ordinary one, of the file as it is read again, and the mistake is among those that it names.
        let read = ProblemFile::read(&problem_text(problem)).unwrap();
        let report = check_problems(&mut planted(&[id]), &[read], &|_| {}).unwrap();
        assert!(report.is_wrong(), "{id}");
        assert_eq!(report, found.report, "{id}");
        let Diagnosis::One(variants) = &report.diagnosis else {
            panic!("{id}: {:?}", report.diagnosis)
        };
        assert!(variants.iter().any(|variant| variant.id == id), "{id}");
    }
}

#[test]
fn nothing_is_found_against_a_right_filter_of_any_kind() {
    for kind in kinds().filter(is_drawn) {
        let searched = searched(&mut planted(&[]), &request(12, &[kind]));
        assert_eq!(searched.found, None, "{kind}");
        assert!(!searched.is_wrong());
        assert!(searched.problems > 6, "{kind}: {searched:?}");
        assert_eq!(
            searched.problems + searched.dropped + searched.cannot_tell,
            12,
            "{kind}"
        );
        // Correlated noises and other starts are something that Kalman filters may have.
        let of_kalman = ["correlated-noise", "gpb1", "unmixed"]
            .contains(&kind)
            .then_some("kalman");
        let kinds: BTreeSet<&str> = std::iter::once(kind).chain(of_kalman).collect();
        assert!(searched.kinds.keys().eq(kinds), "{:?}", searched.kinds);
    }
}

#[test]
fn the_same_seed_finds_the_same_problem() {
    let mut other = request(100, &[]);
    let [first, second] = [(); 2].map(|()| found(&mut planted(&["mixed-spread-omitted"]), &request(100, &[])));
    assert_eq!(first, second);
    other.seed = 2;
    assert_ne!(
        found(&mut planted(&["mixed-spread-omitted"]), &other).drawn,
        first.drawn
    );
}

#[test]
fn a_search_around_a_problem_finds_what_is_wrong_there_and_nothing_else() {
    let mut about = request(4, &[]);
    about.around = vec![car()];
    let right = searched(&mut planted(&[]), &about);
    assert_eq!((right.found, right.problems), (None, 4));
    let found = found(&mut planted(&["bearing-jacobian-negated"]), &about);
    assert_eq!(found.failure, Symptom::Fault(Quantity::MeasurementJacobian));
    assert_eq!(
        (
            found.number,
            found.problem.measurements.len(),
            found.problem.modes.len()
        ),
        (0, 1, 1)
    );
}

#[test]
fn shrinking_that_is_cut_short_says_so() {
    let mut short = request(100, &[]);
    short.shrinking.tries = 3;
    let found = found(&mut planted(&["mixed-spread-omitted"]), &short);
    assert_eq!((found.shrinking.tries, found.shrinking.cut_short), (3, Some("tries")));
    assert!(found.report.is_wrong());
}

/// A convention that is not declared explains the answers: it is no mistake, and the program is judged by it from then on.
#[test]
fn a_convention_is_no_find() {
    let searched = searched(
        &mut planted(&["log-likelihood-without-two-pi"]),
        &request(30, &["kalman"]),
    );
    assert_eq!(searched.found, None);
    let ids: Vec<&str> = searched.otherwise.iter().map(|variant| variant.id.as_str()).collect();
    assert_eq!(ids, ["log-likelihood-without-two-pi"]);
    assert!(searched.problems > 20);
    // A mistake beside it is found all the same.
    let program = &mut planted(&["log-likelihood-without-two-pi", "combined-spread-omitted"]);
    assert!(
        search(program, &request(30, &["kalman"]), &|_| {})
            .unwrap()
            .found
            .is_some()
    );
}

/// A program with a fault of behaviour: it answers as this crate does, but for some problems.
struct Faulty {
    right: Planted,
    asked: usize,
    answer: fn(&ProblemFile, usize) -> Option<Answer>,
}

impl Faulty {
    fn new(answer: fn(&ProblemFile, usize) -> Option<Answer>) -> Self {
        let (right, asked) = (planted(&[]), 0);
        Self { right, asked, answer }
    }
}

impl Subject for Faulty {
    fn start(&mut self) -> Result<Ready, Broken> {
        self.asked = 0;
        self.right.start()
    }

    fn run(&mut self, problem: &ProblemFile) -> Answer {
        self.asked += 1;
        (self.answer)(problem, self.asked).unwrap_or_else(|| self.right.run(problem))
    }
}

fn misses(problem: &ProblemFile) -> bool {
    problem.measurements.iter().any(|entry| entry.z.is_none())
}

#[test]
fn a_program_that_ends_at_missed_detections_is_found_and_shown_by_one_step() {
    let crashed = |problem: &ProblemFile, _| {
        let (status, stderr) = ("exit status: 1".to_owned(), format!(":\nTypeError at {}", problem.id));
        misses(problem).then_some(Answer::Broken(Broken::Crashed { status, stderr }))
    };
    let found = found(&mut Faulty::new(crashed), &request(100, &[]));
    assert!(
        matches!(found.failure, Symptom::Outcome("ended", _)),
        "{:?}",
        found.failure
    );
    assert_eq!(in_words(&found.problem), "1 step, 1 mode, 1 component, 1 measured");
    assert_eq!(found.problem.measurements[0].z, None);
    assert!(matches!(
        found.report.cases[0].outcome,
        Outcome::Broken(Broken::Crashed { .. })
    ));
    // Nothing that does not matter is left of it.
    assert_eq!(found.problem.modes[0].transition, [[1.0]]);
    assert_eq!(found.problem.initial.modes[0].mean, [0.0]);
    assert_eq!(found.problem.format, FORMAT);
}

#[test]
fn a_program_that_passes_over_problems_is_asked_less_of_their_kind() {
    let skipped = |problem: &ProblemFile, _| {
        let reason = "no missed detections".to_owned();
        misses(problem).then_some(Answer::Skipped { reason })
    };
    let searched = searched(&mut Faulty::new(skipped), &request(80, &["kalman"]));
    assert_eq!(searched.found, None);
    assert!((3..10).contains(&searched.skipped), "{}", searched.skipped);
    assert!(searched.not_asked > searched.skipped, "{}", searched.not_asked);
    // What it does answer it is still asked.
    assert!(searched.problems > 40, "{}", searched.problems);
}

#[test]
fn a_fault_that_depends_on_what_was_asked_before_is_said_to_be_one() {
    let tired = |problem: &ProblemFile, asked| {
        let (class, reason) = (problem.id.clone(), "no more".to_owned());
        (asked > 5).then_some(Answer::Rejected { class, reason })
    };
    let found = found(&mut Faulty::new(tired), &request(100, &["kalman"]));
    assert_eq!(found.problem, found.drawn);
    assert!(!found.report.is_wrong());
}

#[test]
fn a_search_for_nothing_is_refused() {
    let nothing = |kinds: &[&str]| search(&mut planted(&[]), &request(1, kinds), &|_| {}).unwrap_err();
    assert!(matches!(nothing(&["kalmann"]), NotMade::Unknown { .. }));
    let skips = |_: &ProblemFile, _| Some(Answer::Skipped { reason: String::new() });
    let searched = searched(&mut Faulty::new(skips), &request(10, &["kalman"]));
    assert_eq!((searched.problems, searched.is_wrong()), (0, false));
}

// The command

/// What the program prints, its exit status, and the file that it writes.
fn command(arguments: &[&str], plants: &[&str], name: &str) -> (String, Option<i32>, PathBuf) {
    let file = std::env::temp_dir().join(format!("immaculate-{}-{name}.json", std::process::id()));
    let program = env!("CARGO_BIN_EXE_immaculate");
    let mut all = vec!["check", "--search", "2", "--out", file.to_str().unwrap()];
    all.extend(arguments);
    all.extend(["--", program, "answer"]);
    all.extend(plants.iter().flat_map(|&plant| ["--plant", plant]));
    let output = immaculate(&all).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap() + &String::from_utf8(output.stderr).unwrap();
    (text, output.status.code(), file)
}

#[test]
fn the_command_writes_what_it_finds_and_says_how_to_see_it_again() {
    let (text, status, file) = command(&["--seed", "3"], &["combined-spread-omitted"], "found");
    assert_eq!(status, Some(1), "{text}");
    for part in [
        "FOUND: combined.covariance is wrong",
        "of seed 3",
        "MOST LIKELY",
        "SEE IT AGAIN",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let line = text.lines().last().unwrap().trim();
    let arguments: Vec<&str> = line.split(' ').skip(1).collect();
    let again = immaculate(&arguments).output().unwrap();
    assert_eq!(again.status.code(), Some(1));
    assert!(
        String::from_utf8(again.stdout)
            .unwrap()
            .contains("FAULT  combined.covariance")
    );
    let problem = ProblemFile::read(&std::fs::read_to_string(&file).unwrap()).unwrap();
    assert!(certified_as_far_as_it_goes(&problem).is_ok());
    std::fs::remove_file(file).unwrap();
}

#[test]
fn the_command_says_what_was_judged_where_it_finds_nothing() {
    let (text, status, file) = command(&["--kind", "kalman"], &[], "nothing");
    assert_eq!(status, Some(0), "{text}");
    assert!(
        text.contains("FOUND NOTHING: ") && text.contains("1 kind of filter"),
        "{text}"
    );
    assert!(!file.exists());
    let (text, status, _) = command(&["--kind", "kalman", "--json"], &[], "json");
    let value: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(status, Some(0));
    assert_eq!((&value["found"], &value["wrong"]), (&Value::Null, &Value::Bool(false)));
    assert!(value["problems"].as_u64() > Some(10));
}

#[test]
fn a_search_excludes_what_has_no_meaning_for_it() {
    for other in [
        &["--answers", "."][..],
        &["--case", "step"],
        &["--flag", "run"],
        &["--strict"],
    ] {
        let mut arguments = vec!["check", "--search", "1"];
        arguments.extend(other);
        let output = immaculate(&arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{other:?}");
    }
    let output = immaculate(&["check", "--seed", "1", "--", "true"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "a seed without a search");
}
