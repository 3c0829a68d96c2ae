//! Goal: no file, answer or message, however broken or hostile, makes a reader panic, hang or fill the memory; and what is accepted runs.
//!
//! Method: random bytes, broken copies of published files, and monsters (deep nests, endless numbers, huge counts) are given to every
//! reader, each with a time limit; the monsters also to the program itself, whose memory the shell limits. Kind of evidence: property, with
//! a fixed number of cases and fixed seeds.

use immaculate::imm::Quantity;
use immaculate::oracle::answer::respond;
use immaculate::oracle::case;
use immaculate::oracle::csv;
use immaculate::oracle::judge::{self, Finding, Reference};
use immaculate::oracle::problem::{MeasurementFile, ProblemFile};
use immaculate::oracle::process::read_answer;
use immaculate::oracle::run::run_in_doubles;
use immaculate::oracle::subject::{Level, Planted, Precision, Ready};
use immaculate::oracle::trace::{Dimensions, Trace, read_json};
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::RngSeed;
use serde_json::{Value, json};
use std::cell::Cell;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use std::sync::LazyLock;
use std::time::{Duration, Instant};

/// No reader takes longer for a file of a few kilobytes, and no run of a small problem either. Both take a thousandth of it; the rest is
/// for machines that do other things besides.
const PATIENCE: Duration = Duration::from_secs(2);

/// The same for files of some megabytes.
const PATIENCE_WITH_MONSTERS: Duration = Duration::from_secs(8);

/// The problems of which broken copies are made: linear, with bearings, without a detection, unscented.
const BROKEN: [&str; 4] = [
    "step.n4-m2.two-modes",
    "step.cubature-5",
    "missed.one",
    "step.unscented",
];

fn config(cases: u32, seed: u64) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(seed),
        // What fails is shown soon rather than as small as can be.
        max_shrink_iters: 200,
        ..ProptestConfig::default()
    }
}

// Garbage

proptest! {
    #![proptest_config(config(2000, 1))]

    #[test]
    fn random_bytes_are_refused_in_time(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let fate = given_to_all(&String::from_utf8_lossy(&bytes));
        prop_assert!(!fate.is_problem, "nobody writes a problem by chance");
    }

    #[test]
    fn random_tokens_are_refused_in_time(tokens in prop::collection::vec(prop::sample::select(&TOKENS[..]), 0..60)) {
        let fate = given_to_all(&tokens.concat());
        prop_assert!(!fate.is_problem, "nobody writes a problem by chance");
    }
}

/// What JSON, CSV and the messages are made of.
const TOKENS: [&str; 30] = [
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    "\"",
    "\\",
    "\n",
    " ",
    "0",
    "-1",
    "1e999",
    "1e-999",
    "NaN",
    "-Infinity",
    "null",
    "true",
    "\"type\"",
    "\"ready\"",
    "\"run\"",
    "\"problem\"",
    "\"steps\"",
    "\"step\"",
    "\"modes\"",
    "\"id\"",
    "id,step,mode,quantity,row,column,value",
    "x,1,1,gain,1,1,",
    "\u{feff}",
    "\u{1d54a}",
];

// Broken copies

/// One thing that is done to a text.
#[derive(Debug, Clone)]
enum Break {
    Flip(Index, u8),
    Cut(Index, Index),
    Repeat(Index, Index),
    Truncate(Index),
    Swap(Index, Index),
    Exchange(Index, &'static str),
}

/// What numbers, names and lists are exchanged for.
const STRANGERS: [&str; 26] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "1e308",
    "-1e308",
    "5e-324",
    "1e999",
    "-1e999",
    "NaN",
    "Infinity",
    "18446744073709551615",
    "18446744073709551616",
    "9007199254740993",
    "0.1000000000000000055511151231257827021181583404541015625",
    "1.5",
    "null",
    "true",
    "\"\"",
    "\"range\"",
    "[]",
    "[[]]",
    "{}",
    "[0,0,0,0]",
    "[[1e300,0],[0,1e300]]",
    "{\"kind\":\"kalman\"}",
];

fn any_break() -> impl Strategy<Value = Break> {
    prop_oneof![
        2 => (any::<Index>(), any::<u8>()).prop_map(|(at, byte)| Break::Flip(at, byte)),
        1 => (any::<Index>(), any::<Index>()).prop_map(|(a, b)| Break::Cut(a, b)),
        1 => (any::<Index>(), any::<Index>()).prop_map(|(a, b)| Break::Repeat(a, b)),
        1 => any::<Index>().prop_map(Break::Truncate),
        4 => (any::<Index>(), any::<Index>()).prop_map(|(a, b)| Break::Swap(a, b)),
        12 => (any::<Index>(), prop::sample::select(&STRANGERS[..])).prop_map(|(at, other)| Break::Exchange(at, other)),
    ]
}

fn broken(text: &str, what: &Break) -> String {
    let range = |a: &Index, b: &Index| {
        let (a, b) = (a.index(text.len() + 1), b.index(text.len() + 1));
        // Not more than a few tokens, so that something is left to be read.
        let end = a.max(b).min(a.min(b) + 40);
        (floor(text, a.min(b)), floor(text, end))
    };
    match what {
        _ if text.is_empty() => String::new(),
        Break::Flip(at, byte) => {
            let mut bytes = text.as_bytes().to_vec();
            let at = at.index(bytes.len());
            bytes[at] ^= byte;
            String::from_utf8_lossy(&bytes).into_owned()
        }
        Break::Cut(a, b) => {
            let (start, end) = range(a, b);
            format!("{}{}", &text[..start], &text[end..])
        }
        Break::Repeat(a, b) => {
            let (start, end) = range(a, b);
            format!("{}{}", &text[..end], &text[start..])
        }
        Break::Truncate(at) => text[..floor(text, at.index(text.len()))].to_owned(),
        Break::Swap(a, b) => {
            let mut tokens = tokens(text);
            let (a, b) = (a.index(tokens.len()), b.index(tokens.len()));
            tokens.swap(a, b);
            tokens.concat()
        }
        Break::Exchange(at, other) => {
            let mut tokens = tokens(text);
            let values: Vec<usize> = (0..tokens.len()).filter(|&i| is_value(tokens[i])).collect();
            if !values.is_empty() {
                tokens[*at.get(&values)] = other;
            }
            tokens.concat()
        }
    }
}

/// What became of the broken copies, so that a test can say that it was not all the same.
#[derive(Default)]
struct Fates {
    refused: Cell<u32>,
    accepted: Cell<u32>,
}

impl Fates {
    fn count(&self, is_accepted: bool) {
        let count = if is_accepted { &self.accepted } else { &self.refused };
        count.set(count.get() + 1);
    }
}

/// A broken problem is refused with a place, or it runs.
#[test]
fn a_broken_problem_is_refused_or_runs() {
    let fates = Fates::default();
    let breaks = (
        prop::sample::select(&BROKEN[..]),
        prop::collection::vec(any_break(), 1..4),
    );
    proptest!(config(2500, 2), |((id, breaks) in breaks)| {
        let text = breaks.iter().fold(text_of(id).to_owned(), |text, what| broken(&text, what));
        let fate = given_to_all(&text);
        fates.count(fate.is_problem);
    });
    assert!(fates.refused.get() > 700, "most are broken: {}", fates.refused.get());
    assert!(fates.accepted.get() > 100, "not all are: {}", fates.accepted.get());
}

/// A broken answer, as JSON and as CSV, is refused with a place, or read.
#[test]
fn a_broken_answer_is_refused_or_read() {
    let case = of("step.n4-m2.two-modes");
    let case::Expected::Trace(trace) = &case.expected else {
        panic!("a trace");
    };
    let json = json!({ "type": "answer", "id": "x", "steps": trace.steps_as_json() }).to_string();
    let long = csv::write("x", trace, "", |_, _| String::new());
    for (text, seed) in [(json, 3), (long, 4)] {
        let fates = Fates::default();
        proptest!(config(1000, seed), |(breaks in prop::collection::vec(any_break(), 1..3))| {
            let text = breaks.iter().fold(text.clone(), |text, what| broken(&text, what));
            let fate = given_to_all(&text);
            fates.count(fate.is_answer);
        });
        assert!(
            fates.refused.get() > 200 && fates.accepted.get() > 20,
            "{} and {}",
            fates.refused.get(),
            fates.accepted.get()
        );
    }
}

proptest! {
    #![proptest_config(config(1500, 5))]

    #[test]
    fn broken_messages_are_refused_or_read(breaks in prop::collection::vec(any_break(), 1..4), ready in any::<bool>()) {
        let message = if ready {
            "{\"type\":\"ready\",\"name\":\"x\",\"precision\":{\"decimal_digits\":7},\"conventions\":{\"first_step\":\"mixed\"},\
             \"kinds\":[\"kalman\"],\"echo\":[321,754],\"validates\":true}".to_owned()
        } else {
            format!("{{\"type\":\"run\",\"problem\":{}}}", text_of("missed.one").replace('\n', ""))
        };
        given_to_all(&breaks.iter().fold(message, |text, what| broken(&text, what)));
    }
}

// Wild numbers in files that are otherwise right

/// Every double, the extreme ones as often as the others.
fn any_double() -> impl Strategy<Value = f64> {
    let extreme = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        f64::MAX,
        f64::MIN,
        f64::MIN_POSITIVE,
        5e-324,
        1e154,
        -1e155,
        1e-170,
        3.25,
        1e16,
    ];
    prop_oneof![
        prop::sample::select(extreme.to_vec()),
        prop::num::f64::NORMAL,
        -1e3..1e3
    ]
}

/// Every problem that is accepted runs to its end or to a step that cannot be computed, in time.
#[test]
fn every_accepted_problem_runs() {
    let fates = Fates::default();
    let stopped = Cell::new(0);
    let wild = (
        prop::sample::select(&BROKEN[..]),
        prop::collection::vec((0_usize..6, any::<Index>(), any_double()), 1..4),
    );
    proptest!(config(2500, 6), |((id, changes) in wild)| {
        let mut problem = of(id).problem.clone();
        for (what, at, number) in changes {
            change(&mut problem, what, at, number);
        }
        let text = json!(problem).to_string();
        let start = Instant::now();
        let is_accepted = ProblemFile::read(&text).is_ok();
        fates.count(is_accepted);
        if is_accepted {
            let (trace, failure) = run_in_doubles(&problem).unwrap();
            stopped.set(stopped.get() + u32::from(failure.is_some()));
            if let Some(sentence) = failure {
                prop_assert!(sentence.starts_with("step "), "{}", sentence);
            }
            prop_assert!(trace.check(&trace.dimensions).is_ok());
        }
        prop_assert!(start.elapsed() < PATIENCE, "{:?}: {}", start.elapsed(), text);
    });
    assert!(
        fates.accepted.get() > 1000 && fates.refused.get() > 100,
        "{} and {}",
        fates.accepted.get(),
        fates.refused.get()
    );
    assert!(stopped.get() > 100, "{} stopped", stopped.get());
}

/// One number, or one covariance as a whole.
fn change(problem: &mut ProblemFile, what: usize, at: Index, number: f64) {
    let scale = |rows: &mut Vec<Vec<f64>>| rows.iter_mut().flatten().for_each(|entry| *entry *= number.abs());
    let modes = problem.modes.len();
    let mode = at.index(modes);
    let any = |rows: &mut Vec<Vec<f64>>| {
        let row = at.index(rows.len());
        let column = at.index(rows[row].len());
        rows[row][column] = number;
    };
    match what {
        0 => any(&mut problem.modes[mode].transition),
        1 => scale(&mut problem.modes[mode].noise),
        2 => problem.initial.modes[mode].covariance.iter_mut().for_each(scale),
        3 => {
            let mean = &mut problem.initial.modes[mode].mean;
            let entry = at.index(mean.len());
            mean[entry] = number;
        }
        4 => match &mut problem.measurement {
            MeasurementFile::Linear { matrix } => any(matrix),
            MeasurementFile::RangeBearing { sensor, .. } => sensor[at.index(2)] = number,
            MeasurementFile::Formulas { .. } | MeasurementFile::Model { .. } => {}
        },
        _ => {
            if let Some(z) = problem.measurements[0].z.as_mut() {
                z[0] = Some(number);
            }
        }
    }
}

/// An answer with wild numbers is judged, in time; what is not finite is found where it stands.
#[test]
fn an_answer_with_wild_numbers_is_judged() {
    let cases = ["steps.kalman", "step.cubature-5", "missed.one"].map(|id| {
        let case = of(id);
        let case::Expected::Trace(trace) = &case.expected else {
            panic!("{id}");
        };
        let reference = Reference::new(&case.problem, Some(trace), &[], Precision::Double).unwrap();
        (&case.problem, trace, reference)
    });
    let number =
        prop_oneof![4 => any_double(), 1 => prop::sample::select(&[f64::NAN, f64::INFINITY, f64::NEG_INFINITY][..])];
    let wild = (
        0_usize..3,
        prop::collection::vec((any::<Index>(), any::<Index>(), number), 1..4),
        any::<bool>(),
    );
    proptest!(config(400, 7), |((which, changes, hides) in wild)| {
        let (problem, expected, reference) = &cases[which];
        let mut shown = (*expected).clone();
        let places: Vec<_> = expected.all_places().filter(|place| expected.get(place.0, place.1, place.2).is_some()).collect();
        for (place, at, number) in &changes {
            let (step, quantity, mode) = *place.get(&places);
            let mut value = shown.get(step, quantity, mode).unwrap().clone();
            let entry = at.index(value.len());
            value[entry] = *number;
            shown.set(step, quantity, mode, value);
        }
        if hides {
            shown = without(&shown, *changes[0].1.get(&Quantity::ALL));
        }
        let start = Instant::now();
        let case = judge::Case { problem, shown: &shown, reference, precision: Precision::Double };
        let judgement = case.judge(&[]).unwrap();
        prop_assert!(start.elapsed() < PATIENCE, "{:?}", start.elapsed());
        // The first value that is not finite is found; those after it may come of it.
        let mut was_finite = true;
        for judged in &judgement.values {
            let (step, quantity, mode) = judged.place;
            let is_finite = shown.get(step, quantity, mode).unwrap().iter().all(|value| value.is_finite());
            let expected: &[Finding] = match (is_finite, was_finite) {
                (true, _) => &[Finding::Right, Finding::Propagated, Finding::CannotTell, Finding::Undetermined, Finding::Fault],
                (false, true) => &[Finding::NotFinite],
                (false, false) => &[Finding::NotFinite, Finding::Propagated],
            };
            prop_assert!(expected.contains(&judged.finding), "{:?}", judged);
            was_finite &= is_finite;
        }
    });
}

// Monsters

/// Megabytes of one thing, or of two in turns.
fn monsters() -> Vec<(&'static str, String)> {
    let many = |what: &str, times: usize| what.repeat(times);
    let number = |digits: String| text_of("missed.one").replacen("\"R\": [[", &format!("\"R\": [[{digits}, "), 1);
    vec![
        ("brackets", many("[", 100_000)),
        ("braces", many("{\"a\":", 100_000)),
        ("closed brackets", many("[", 100_000) + &many("]", 100_000)),
        ("brackets in a problem", number(many("[", 100_000))),
        (
            "brackets in an answer",
            format!("{{\"type\":\"answer\",\"id\":\"x\",\"steps\":{}", many("[", 100_000)),
        ),
        (
            "braces in a kind",
            text_of("missed.one").replacen("\"H\":", &format!("\"H\":{}", many("{\"a\":", 100_000)), 1),
        ),
        ("digits", number(many("7", 2_000_000))),
        ("decimals", number(format!("0.{}", many("7", 2_000_000)))),
        ("an exponent", number(format!("1e{}", many("9", 1_000_000)))),
        ("a small exponent", number(format!("1e-{}", many("9", 1_000_000)))),
        (
            "digits in an answer",
            format!("{{\"steps\":[{{\"step\":{}}}]}}", many("1", 1_000_000)),
        ),
        (
            "digits in CSV",
            format!("{}\nx,1,,combined.mean,1,,{}\n", csv::HEADER, many("7", 1_000_000)),
        ),
        (
            "a step in CSV",
            format!("{}\nx,{},,combined.mean,1,,0\n", csv::HEADER, many("7", 1_000_000)),
        ),
        ("a word", many("a", 3_000_000)),
        ("words", many("NaN", 1_000_000)),
        ("many words", many("nan ", 500_000)),
        ("signs", many("-", 3_000_000)),
        ("quotes", many("\"", 3_000_000)),
        ("escapes", format!("\"{}", many("\\\\", 1_000_000))),
        ("commas", many(",", 3_000_000)),
        ("lines", format!("{}\n{}", csv::HEADER, many("\n", 1_000_000))),
        (
            "lines of CSV",
            format!("{}\n{}", csv::HEADER, many("y,1,,combined.mean,1,,0\n", 100_000)),
        ),
        ("a key", format!("{{\"{}\":1}}", many("k", 3_000_000))),
        ("keys", format!("{{{}\"a\":1}}", many("\"a\":1,", 300_000))),
        (
            "a name",
            text_of("missed.one").replacen("missed.one", &many("name", 500_000), 1),
        ),
        ("zeros", number(many("0,", 1_000_000))),
        (
            "zeros in a kind",
            text_of("missed.one").replacen("\"H\":[[", &format!("\"H\":[[{}", many("0,", 1_000_000)), 1),
        ),
        (
            "rows",
            text_of("missed.one").replacen("\"H\":[", &format!("\"H\":[{}", many("[0],", 500_000)), 1),
        ),
        (
            "zeros in an answer",
            format!(
                "{{\"steps\":[{{\"step\":1,\"mode_probabilities\":[{}0]}}]}}",
                many("0,", 1_000_000)
            ),
        ),
        (
            "steps in an answer",
            format!("{{\"steps\":[{}{{\"step\":1}}]}}", many("{\"step\":1},", 200_000)),
        ),
        ("null characters", many("\0", 3_000_000)),
        ("wide characters", many("\u{1d54a}", 1_000_000)),
        (
            "names of a state",
            text_of("missed.one").replacen("\"state\": [", &format!("\"state\": [{}", many("\"x\",", 500_000)), 1),
        ),
    ]
}

#[test]
fn a_monster_is_refused_in_time() {
    for (name, text) in monsters() {
        let start = Instant::now();
        let fate = given(&text, PATIENCE_WITH_MONSTERS);
        assert!(!fate.is_problem || name == "a name", "{name} is a problem");
        assert!(
            start.elapsed() < PATIENCE_WITH_MONSTERS,
            "{name}: {:?}",
            start.elapsed()
        );
    }
}

/// Long, and right: the time grows with the length and with nothing more.
#[test]
fn a_long_problem_runs_in_time() {
    let start = Instant::now();
    let mut problem = of("step.n1-m1.two-modes").problem.clone();
    let first = problem.measurements[0].clone();
    problem.measurements = (1..=20_000)
        .map(|step| {
            let mut entry = first.clone();
            entry.step = step;
            entry
        })
        .collect();
    let text = json!(problem).to_string();
    let problem = ProblemFile::read(&text).unwrap();
    let (trace, failure) = run_in_doubles(&problem).unwrap();
    assert_eq!(failure, None);
    let steps = Value::Array(trace.steps_as_json());
    assert_eq!(Trace::from_json(&steps, &trace.dimensions).as_ref(), Ok(&trace));
    let long = csv::write("x", &trace, "", |_, _| String::new());
    assert_eq!(csv::read(&long, "x", &trace.dimensions), Ok(trace));
    assert!(start.elapsed() < PATIENCE_WITH_MONSTERS, "{:?}", start.elapsed());
}

/// Counts that no memory holds are refused before anything is made for them.
#[test]
fn a_huge_count_is_refused() {
    for count in [
        "1e18",
        "18446744073709551615",
        "1e300",
        "4294967296",
        "9007199254740993",
    ] {
        let answer = format!("{{\"id\":\"x\",\"steps\":[{{\"step\":{count}}}]}}");
        assert!(!given(&answer, PATIENCE).is_answer, "{count}");
        for line in [
            format!("x,{count},,combined.mean,1,,0"),
            format!("x,1,{count},updated.mean,1,,0"),
            format!("x,1,,combined.mean,{count},,0"),
            format!("x,1,,combined.covariance,1,{count},0"),
        ] {
            assert!(
                !given(&format!("{}\n{line}\n", csv::HEADER), PATIENCE).is_answer,
                "{line}"
            );
        }
        let text = text_of("missed.one").replacen("\"step\":1,", &format!("\"step\":{count},"), 1);
        assert!(!given(&text, PATIENCE).is_problem, "{count}");
        let text = text_of("step.cubature-5").replacen("[0,2]", &format!("[0,{count}]"), 1);
        assert!(!given(&text, PATIENCE).is_problem, "{count}");
    }
    assert!(text_of("step.cubature-5").contains("[0,2]") && text_of("missed.one").contains("\"step\":1,"));
}

/// The shell limits the memory of the program to a gigabyte of addresses: files of megabytes are refused with a sentence all the same,
/// and a program under test that floods does not fill it.
#[cfg(target_os = "linux")]
#[test]
fn the_memory_is_bounded() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("hostile_files");
    std::fs::create_dir_all(&folder).unwrap();
    let wanted = [
        "brackets",
        "braces in a kind",
        "digits",
        "zeros",
        "zeros in a kind",
        "words",
        "names of a state",
    ];
    for (name, text) in monsters().into_iter().filter(|(name, _)| wanted.contains(name)) {
        let file = folder.join(name.replace(' ', "-"));
        std::fs::write(&file, text).unwrap();
        let output = limited(&format!("exec \"$0\" trace '{}'", file.display()));
        let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{name}: {complaint:.300}");
        assert!(complaint.contains(": problem"), "{name}: {complaint:.300}");
    }
    for flood in ["exec yes", "exec yes '{}'", "cat /dev/zero"] {
        let under_test = format!("read -r line; echo \"{{\\\"type\\\":\\\"ready\\\"}}\"; {flood}").replace('\'', "\"");
        let output = limited(&format!(
            "exec \"$0\" check --timeout 1 --case update.kalman -- /bin/sh -c '{under_test}'"
        ));
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(
            output.status.code(),
            Some(1),
            "{flood}: {said} {}",
            String::from_utf8_lossy(&output.stderr)
        );
        assert!(said.contains("0 of 19"), "{flood}: {said}");
    }
}

#[cfg(target_os = "linux")]
fn limited(script: &str) -> Output {
    let script = format!("ulimit -v 1048576; {script}");
    Command::new("/bin/sh")
        .args(["-c", &script, env!("CARGO_BIN_EXE_immaculate")])
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

// Who is given the texts

/// What readers took a text for.
struct Fate {
    is_problem: bool,
    is_answer: bool,
}

fn given_to_all(text: &str) -> Fate {
    given(text, PATIENCE)
}

/// Gives a text to every reader there is. Each is done in time, and each refusal has a place.
fn given(text: &str, patience: Duration) -> Fate {
    let start = Instant::now();
    let problem = ProblemFile::read(text);
    match &problem {
        Ok(problem) => {
            let (trace, _) = run_in_doubles(problem).unwrap();
            assert!(trace.check(&trace.dimensions).is_ok());
        }
        Err(invalid) => assert!(
            invalid.place.starts_with("problem") && !invalid.reason.is_empty(),
            "{invalid}"
        ),
    }
    let long = csv::read(text, "x", &DIMENSIONS);
    if let Err(invalid) = &long {
        assert!(!invalid.place.is_empty() && !invalid.reason.is_empty(), "{invalid}");
    }
    let mut is_answer = long.is_ok();
    if let Ok(value) = read_json(text) {
        is_answer |= matches!(
            value.get("steps").map(|steps| Trace::from_json(steps, &DIMENSIONS)),
            Some(Ok(_))
        ) && read_answer(&value, &DIMENSIONS).is_ok();
        if let Err(invalid) = Trace::from_json(&value, &DIMENSIONS) {
            assert!(invalid.place.starts_with("steps"), "{invalid}");
        }
        let _ = Ready::read(&value);
    }
    let mut own = Planted {
        variants: Vec::new(),
        level: Level::Everything,
    };
    let _ = respond(&mut own, text);
    assert!(start.elapsed() < patience, "{:?}: {text:.2000}", start.elapsed());
    Fate {
        is_problem: problem.is_ok(),
        is_answer,
    }
}

/// Those of `step.n4-m2.two-modes`.
static DIMENSIONS: LazyLock<Dimensions> = LazyLock::new(|| Dimensions::new(4, 2, 2, 1));

fn of(id: &str) -> &'static case::Case {
    let all = case::all().unwrap();
    all.iter().find(|case| case.problem.id == id).unwrap()
}

fn text_of(id: &str) -> &'static str {
    of(id).problem_text
}

/// A trace in which a quantity is not shown.
fn without(trace: &Trace, hidden: Quantity) -> Trace {
    let mut shown = Trace::empty(&trace.dimensions);
    for (step, quantity, mode) in trace.all_places().filter(|place| place.1 != hidden) {
        if let Some(value) = trace.get(step, quantity, mode) {
            shown.set(step, quantity, mode, value.clone());
        }
    }
    shown
}

/// The next place at or before one where a character starts.
fn floor(text: &str, at: usize) -> usize {
    (0..=at.min(text.len()))
        .rev()
        .find(|&at| text.is_char_boundary(at))
        .unwrap()
}

/// A text in pieces: words, numbers, texts in quotes, and single characters.
fn tokens(text: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let end = if first == '"' {
            rest[1..].find('"').map_or(rest.len(), |end| end + 2)
        } else {
            let is_word = |c: char| c.is_alphanumeric() || "+-._".contains(c);
            let word = rest.find(|c: char| !is_word(c)).unwrap_or(rest.len());
            word.max(first.len_utf8())
        };
        found.push(&rest[..end]);
        rest = &rest[end..];
    }
    found
}

/// Whether a piece is a number or a text, but not a single character.
fn is_value(token: &str) -> bool {
    token.starts_with(|c: char| c.is_ascii_digit() || c == '-' || c == '"') && token != "\""
}
