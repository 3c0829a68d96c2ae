//! Goal: nothing that comes from outside (files of every kind, messages, arguments) makes the program panic, hang or take what is not a
//! number for one; each is read, or refused in a sentence of bounded length; and what is accepted is what it says it is.
//!
//! Method: published files of every kind with mutations of their tree (keys and values that are removed, doubled, renamed, moved, nested or
//! exchanged for strangers) and of their bytes (cut, flipped, inserted); random words for the arguments of every command, read by the
//! program's own parser in this process. Kind of evidence: property, with a fixed number of cases and fixed seeds. `FUZZ_TIMES=100` makes
//! it a longer search, `FUZZ_SEED=7` another one.

#[allow(dead_code)]
#[path = "../src/main.rs"]
mod program;

use clap::Parser;
use immaculate::file::{self, digest};
use immaculate::imm::Quantity;
use immaculate::oracle::answer::respond;
use immaculate::oracle::case::{self, Lock};
use immaculate::oracle::csv;
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::process::read_answer;
use immaculate::oracle::run::run_in_doubles;
use immaculate::oracle::subject::{Level, Planted, Ready};
use immaculate::oracle::trace::{Dimensions, Trace, read_json};
use immaculate::paper::Paper;
use immaculate::paper::specification::Choices;
use immaculate::steady::certificate_file::CertificateFile;
use immaculate::steady::verdict::{Depth, StabilityVerdict};
use proptest::prelude::*;
use proptest::sample::{Index, select};
use proptest::test_runner::RngSeed;
use serde_json::{Map, Value, json};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// No reader takes longer for a file of some kilobytes, and no command for its arguments; a thousandth of it is usual, and the rest is for
/// machines that do other things besides.
const PATIENCE: Duration = Duration::from_secs(3);

/// No sentence is longer, in characters: a place and a reason of 500 each, and some words.
const LONGEST_SENTENCE: usize = 1100;

fn config(cases: u32, seed: u64) -> ProptestConfig {
    let number = |name: &str, usual: u64| {
        std::env::var(name)
            .ok()
            .and_then(|text| text.parse().ok())
            .unwrap_or(usual)
    };
    ProptestConfig {
        cases: cases * u32::try_from(number("FUZZ_TIMES", 1)).unwrap(),
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(seed + 1000 * number("FUZZ_SEED", 0)),
        // What fails is shown soon rather than as small as can be.
        max_shrink_iters: 200,
        ..ProptestConfig::default()
    }
}

// Mutations of a tree

/// One thing that is done to a tree; the indices say where.
#[derive(Debug, Clone)]
enum Mutation {
    Delete(Index),
    Double(Index),
    Rename(Index, String),
    Move(Index, Index),
    Swap(Index, Index),
    Nest(Index, bool),
    Resize(Index, usize),
    Exchange(Index, &'static str),
    Scale(Index, f64),
    Lengthen(Index),
}

/// What values are exchanged for, as they stand in a file.
const STRANGERS: [&str; 34] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "2",
    "0.5",
    "1e308",
    "-1e308",
    "1e-320",
    "1e999",
    "-1e999",
    "NaN",
    "-Infinity",
    "1000000000",
    "18446744073709551615",
    "18446744073709551616",
    "9007199254740993",
    "0.1000000000000000055511151231257827021181583404541015625",
    "null",
    "true",
    "\"\"",
    "\"NaN\"",
    "\"1/0\"",
    "\"1e10000\"",
    "\"-3/7\"",
    "\"\\u0000\\u001b[31m\\ud83d\\ude00\"",
    "\"mixed\"",
    "[]",
    "[[]]",
    "{}",
    "[[1,0],[0,1]]",
    "[1e300,1e300,1e300,1e300]",
    "{\"kind\":\"linear\"}",
    "[[[[[[[[[[[[[[[[0]]]]]]]]]]]]]]]]",
];

fn any_mutation() -> impl Strategy<Value = Mutation> {
    let at = any::<Index>;
    prop_oneof![
        2 => at().prop_map(Mutation::Delete),
        2 => at().prop_map(Mutation::Double),
        1 => (at(), any::<String>()).prop_map(|(at, name)| Mutation::Rename(at, name)),
        1 => (at(), at()).prop_map(|(from, to)| Mutation::Move(from, to)),
        2 => (at(), at()).prop_map(|(a, b)| Mutation::Swap(a, b)),
        1 => (at(), any::<bool>()).prop_map(|(at, in_list)| Mutation::Nest(at, in_list)),
        2 => (at(), 0_usize..40).prop_map(|(at, length)| Mutation::Resize(at, length)),
        6 => (at(), select(&STRANGERS[..])).prop_map(|(at, other)| Mutation::Exchange(at, other)),
        6 => (at(), any_factor()).prop_map(|(at, factor)| Mutation::Scale(at, factor)),
        1 => at().prop_map(Mutation::Lengthen),
    ]
}

fn any_factor() -> impl Strategy<Value = f64> {
    prop_oneof![select(&[-1.0, 1e-300, 1e300, 1e8, 1e-8, 0.0][..]), 0.9..1.1]
}

/// The text of a tree after mutations. Strangers that are no JSON get to their places as text.
fn mutated(tree: &Value, mutations: &[Mutation]) -> String {
    let mut tree = tree.clone();
    for mutation in mutations {
        mutate(&mut tree, mutation);
    }
    let text = tree.to_string();
    STRANGERS.iter().enumerate().fold(text, |text, (number, stranger)| {
        text.replace(&format!("\"{}\"", stand_in(number)), stranger)
    })
}

fn stand_in(number: usize) -> String {
    format!("@stranger {number}@")
}

fn mutate(tree: &mut Value, mutation: &Mutation) {
    let pointers = pointers(tree);
    let at = |index: &Index| index.get(&pointers).as_str();
    match mutation {
        Mutation::Delete(index) => drop(removed(tree, at(index))),
        Mutation::Double(index) => {
            let (value, (outer, name)) = (tree.pointer(at(index)).cloned(), parent(at(index)));
            match (tree.pointer_mut(&outer), value) {
                (Some(Value::Array(list)), Some(value)) => list.push(value),
                (Some(Value::Object(object)), Some(value)) => drop(object.insert(format!("{name} "), value)),
                _ => {}
            }
        }
        Mutation::Rename(index, name) => {
            if let (Some(value), (outer, _)) = (removed(tree, at(index)), parent(at(index)))
                && let Some(Value::Object(object)) = tree.pointer_mut(&outer)
            {
                object.insert(name.clone(), value);
            }
        }
        Mutation::Move(from, to) => {
            if let Some(value) = removed(tree, at(from))
                && let Some(place) = tree.pointer_mut(at(to))
            {
                *place = value;
            }
        }
        Mutation::Swap(a, b) => {
            let values = [a, b].map(|index| tree.pointer(at(index)).cloned());
            for (index, value) in [a, b].into_iter().zip(values.into_iter().rev()) {
                if let (Some(place), Some(value)) = (tree.pointer_mut(at(index)), value) {
                    *place = value;
                }
            }
        }
        Mutation::Nest(index, in_list) => with(tree, at(index), |value| {
            *value = if *in_list {
                json!([value])
            } else {
                json!({ "inner": value })
            };
        }),
        Mutation::Resize(index, length) => with(tree, at(index), |value| {
            if let Value::Array(list) = value {
                let filler = list.first().cloned().unwrap_or(json!(0));
                list.resize(*length, filler);
            }
        }),
        Mutation::Exchange(index, other) => with(tree, at(index), |value| {
            let number = STRANGERS.iter().position(|stranger| stranger == other).unwrap();
            *value = json!(stand_in(number));
        }),
        Mutation::Scale(index, factor) => scale(tree, at(index), *factor),
        Mutation::Lengthen(index) => with(tree, at(index), |value| {
            if let Value::String(text) = value {
                *text = text.repeat(5000);
            }
        }),
    }
}

/// Every number at a place or below it: a covariance stays one.
fn scale(tree: &mut Value, pointer: &str, factor: f64) {
    with(tree, pointer, |value| match value {
        Value::Number(number) => *value = json!(number.as_f64().unwrap() * factor),
        Value::Array(list) => list.iter_mut().for_each(|value| scale(value, "", factor)),
        Value::Object(object) => object.values_mut().for_each(|value| scale(value, "", factor)),
        _ => {}
    });
}

fn with(tree: &mut Value, pointer: &str, change: impl FnOnce(&mut Value)) {
    if let Some(value) = tree.pointer_mut(pointer) {
        change(value);
    }
}

fn removed(tree: &mut Value, pointer: &str) -> Option<Value> {
    let (outer, name) = parent(pointer);
    match tree.pointer_mut(&outer)? {
        Value::Object(object) => object.remove(&name),
        Value::Array(list) => {
            let place = name.parse().ok().filter(|place| *place < list.len())?;
            Some(list.remove(place))
        }
        _ => None,
    }
}

/// The place in which a value stands, and its name there.
fn parent(pointer: &str) -> (String, String) {
    let (outer, name) = pointer.rsplit_once('/').unwrap_or_default();
    (outer.to_owned(), name.replace("~1", "/").replace("~0", "~"))
}

/// All places of a tree but its root.
fn pointers(tree: &Value) -> Vec<String> {
    let mut found = Vec::new();
    let children: Vec<(String, &Value)> = match tree {
        Value::Object(object) => object
            .iter()
            .map(|(name, value)| (name.replace('~', "~0").replace('/', "~1"), value))
            .collect(),
        Value::Array(list) => list
            .iter()
            .enumerate()
            .map(|(place, value)| (place.to_string(), value))
            .collect(),
        _ => Vec::new(),
    };
    for (name, value) in children {
        found.push(format!("/{name}"));
        found.extend(pointers(value).into_iter().map(|inner| format!("/{name}{inner}")));
    }
    if found.is_empty() {
        found.push(String::new());
    }
    found
}

// Mutations of bytes

#[derive(Debug, Clone)]
enum Damage {
    Cut(Index),
    Flip(Index, u8),
    Insert(Index, Vec<u8>),
    Remove(Index, usize),
    Ends,
    Mark,
    Deep(Index, usize),
}

fn any_damage() -> impl Strategy<Value = Damage> {
    let at = any::<Index>;
    prop_oneof![
        3 => at().prop_map(Damage::Cut),
        4 => (at(), any::<u8>()).prop_map(|(at, bits)| Damage::Flip(at, bits)),
        2 => (at(), prop::collection::vec(any::<u8>(), 1..9)).prop_map(|(at, bytes)| Damage::Insert(at, bytes)),
        2 => (at(), 1_usize..30).prop_map(|(at, count)| Damage::Remove(at, count)),
        1 => Just(Damage::Ends),
        1 => Just(Damage::Mark),
        1 => (at(), 1_usize..5000).prop_map(|(at, depth)| Damage::Deep(at, depth)),
    ]
}

fn damaged(bytes: &[u8], damages: &[Damage]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for damage in damages
        .iter()
        .filter(|_| !bytes.is_empty())
        .cloned()
        .collect::<Vec<_>>()
    {
        let length = bytes.len();
        match damage {
            _ if length == 0 => {}
            Damage::Cut(at) => bytes.truncate(at.index(length)),
            Damage::Flip(at, bits) => bytes[at.index(length)] ^= bits,
            Damage::Insert(at, more) => drop(bytes.splice(at.index(length)..at.index(length), more)),
            Damage::Remove(at, count) => {
                let start = at.index(length);
                bytes.drain(start..length.min(start + count));
            }
            Damage::Ends => bytes = String::from_utf8_lossy(&bytes).replace('\n', "\r\n").into_bytes(),
            Damage::Mark => drop(bytes.splice(0..0, "\u{feff}".bytes())),
            Damage::Deep(at, depth) => {
                let start = at.index(length);
                bytes.splice(start..start, std::iter::repeat_n(b'[', depth));
            }
        }
    }
    bytes
}

// Files

/// How many were accepted and how many refused, so that a test can say that it was not all the same.
#[derive(Default)]
struct Fates([Cell<u32>; 2]);

impl Fates {
    fn count(&self, is_accepted: bool) {
        let fate = &self.0[usize::from(is_accepted)];
        fate.set(fate.get() + 1);
    }

    fn assert_at_least(&self, refused: u32, accepted: u32) {
        let found = [self.0[0].get(), self.0[1].get()];
        assert!(
            found[0] >= refused && found[1] >= accepted,
            "refused, accepted: {found:?}"
        );
    }
}

/// A problem is refused with its place, or it runs: every number that it gives is finite, up to the end or to a step that is named with
/// mode and equation.
fn problem_law(text: &str) -> bool {
    let problem = match ProblemFile::read(text) {
        Ok(problem) => problem,
        Err(invalid) => {
            assert!(
                invalid.place.starts_with("problem") && !invalid.reason.is_empty(),
                "{invalid}"
            );
            assert_sentence(&invalid.to_string());
            return false;
        }
    };
    let missed = problem.measurements.iter().filter(|entry| entry.z.is_none()).count();
    assert_eq!(nulls(&json!(problem)), missed, "no number is anything but one");
    let (trace, failure) = run_in_doubles(&problem).unwrap();
    let finished = failure.as_deref().map_or(problem.measurements.len(), |sentence| {
        assert!(
            sentence.starts_with("step ") && sentence.contains(", mode `"),
            "{sentence}"
        );
        let value = sentence.split(", ").nth(2).and_then(|rest| rest.split_once(": "));
        assert!(
            value.is_some_and(|(name, cause)| !name.contains(' ') && cause.len() > 10),
            "a value and a cause: {sentence}"
        );
        sentence[5..].split(',').next().unwrap().parse::<usize>().unwrap() - 1
    });
    for (step, quantity, mode) in trace.all_places().filter(|place| place.0 <= finished) {
        for value in trace.get(step, quantity, mode).into_iter().flatten() {
            // A mode that a measurement is out of all proportion to: another mode explains it.
            let is_beyond = quantity == Quantity::LogLikelihood && *value == f64::NEG_INFINITY;
            assert!(
                value.is_finite() || is_beyond,
                "step {step}: {} is {value}",
                quantity.name()
            );
        }
    }
    true
}

fn nulls(value: &Value) -> usize {
    match value {
        Value::Null => 1,
        Value::Array(list) => list.iter().map(nulls).sum(),
        Value::Object(object) => object.values().map(nulls).sum(),
        _ => 0,
    }
}

fn assert_sentence(sentence: &str) {
    assert!(
        !sentence.is_empty() && sentence.chars().count() <= LONGEST_SENTENCE,
        "{sentence}"
    );
}

/// Whether an answer, as JSON or CSV, is read; then it has the problem's dimensions.
fn answer_law(text: &str, dimensions: &Dimensions) -> bool {
    let mut is_read = false;
    if let Ok(value) = read_json(text) {
        let answer = read_answer(&value, dimensions);
        is_read |= answer.is_ok();
        answer
            .err()
            .iter()
            .for_each(|broken| assert_sentence(&broken.to_string()));
        if let Ok(trace) = Trace::from_json(value.get("steps").unwrap_or(&Value::Null), dimensions) {
            assert_eq!(trace.check(dimensions), Ok(()));
        }
        let _ = Ready::read(&value);
    }
    match csv::read(text, "x", dimensions) {
        Ok(trace) => {
            assert_eq!(trace.check(dimensions), Ok(()));
            is_read = true;
        }
        Err(invalid) => assert_sentence(&invalid.to_string()),
    }
    is_read
}

/// A certificate is refused, or what it proves is not refuted by the search, which knows nothing of it.
fn certificate_law(text: &str) -> bool {
    let Ok(file) = CertificateFile::read(text) else {
        return false;
    };
    let Ok(proven) = file.check() else { return false };
    let shallow = Depth {
        word: 8,
        run: 8,
        memory: 1,
    };
    let found = file.filters.filters().unwrap().decide(shallow);
    let contradicts = matches!(
        (&proven, &found),
        (StabilityVerdict::Stable(_), StabilityVerdict::Unstable(_))
            | (StabilityVerdict::Unstable(_), StabilityVerdict::Stable(_))
    );
    assert!(!contradicts, "{text}");
    true
}

/// The digest detects accidental edits and is not a lock: anyone who changes a proof can write a new one.
fn with_digest(text: &str) -> String {
    let Ok(mut tree) = serde_json::from_str::<Value>(text) else {
        return text.to_owned();
    };
    let empty = json!({});
    let digest = digest(&format!(
        "{}{}",
        tree.get("filters").unwrap_or(&empty),
        tree.get("proof").unwrap_or(&empty)
    ));
    if let Value::Object(object) = &mut tree {
        object.insert("digest".into(), json!(digest));
    }
    tree.to_string()
}

/// Does something within the patience of this file.
fn in_time<T>(text: &str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    assert!(start.elapsed() < PATIENCE, "{:?}: {text:.2000}", start.elapsed());
    result
}

/// A problem of every kind of filter, the shortest, and one that must be refused.
fn problems() -> Vec<Value> {
    let mut shortest: BTreeMap<String, &str> = BTreeMap::new();
    for case in case::all().unwrap() {
        let is_rejected = matches!(case.expected, case::Expected::Rejection(_));
        let kind = format!("{} {is_rejected}", case.problem.filter.name());
        let text = shortest.entry(kind).or_insert(case.problem_text);
        if case.problem_text.len() < text.len() {
            *text = case.problem_text;
        }
    }
    assert!(shortest.len() > 10, "every kind");
    shortest
        .values()
        .map(|text| serde_json::from_str(text).unwrap())
        .collect()
}

#[test]
fn a_mutated_problem_is_refused_or_runs() {
    let fates = Fates::default();
    let mutations = (select(problems()), prop::collection::vec(any_mutation(), 1..4));
    proptest!(config(2500, 11), |((tree, mutations) in mutations)| {
        let text = mutated(&tree, &mutations);
        fates.count(in_time(&text, || problem_law(&text)));
        in_time(&text, || respond(&mut own(), &format!("{{\"type\":\"run\",\"problem\":{text}}}")));
    });
    fates.assert_at_least(800, 200);
}

fn own() -> Planted {
    Planted {
        variants: Vec::new(),
        level: Level::Everything,
    }
}

/// An answer to a problem of every kind.
fn answers() -> Vec<(Dimensions, Value, String)> {
    let mut found: BTreeMap<String, (Dimensions, Value, String)> = BTreeMap::new();
    for case in case::all().unwrap() {
        let case::Expected::Trace(trace) = &case.expected else {
            continue;
        };
        if case.problem.measurements.len() == 1 {
            let answer = json!({ "type": "answer", "id": "x", "steps": trace.steps_as_json() });
            let long = csv::write("x", trace, "", |_, _| String::new());
            found
                .entry(case.problem.filter.name().to_owned())
                .or_insert((trace.dimensions.clone(), answer, long));
        }
    }
    found.into_values().collect()
}

#[test]
fn a_mutated_answer_is_refused_or_read() {
    let fates = Fates::default();
    let mutations = (select(answers()), prop::collection::vec(any_mutation(), 1..4));
    proptest!(config(1500, 12), |(((dimensions, tree, _), mutations) in mutations)| {
        let text = mutated(&tree, &mutations);
        fates.count(in_time(&text, || answer_law(&text, &dimensions)));
    });
    fates.assert_at_least(300, 100);
}

/// The text of each published certificate.
fn certificates() -> Vec<String> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("fixtures/certificates");
    let files = std::fs::read_dir(folder).unwrap();
    files
        .map(|file| std::fs::read_to_string(file.unwrap().path()).unwrap())
        .collect()
}

#[test]
fn a_mutated_certificate_is_refused_or_true() {
    let trees: Vec<Value> = certificates()
        .iter()
        .map(|text| serde_json::from_str(text).unwrap())
        .collect();
    let fates = Fates::default();
    let mutations = (select(trees), prop::collection::vec(any_mutation(), 0..3));
    proptest!(config(400, 13), |((tree, mutations) in mutations)| {
        let text = with_digest(&mutated(&tree, &mutations));
        fates.count(in_time(&text, || certificate_law(&text)));
    });
    fates.assert_at_least(100, 50);
}

/// Numbers and proofs that are as long as a file may be are refused before anything is multiplied.
#[test]
fn a_certificate_of_monsters_is_refused_in_time() {
    let of = |roots: [&str; 2], proof: &Value| {
        let file = json!({
            "format": "immaculate-certificate/1", "about": "", "filters": { "damping-roots": roots }, "proof": proof, "digest": "",
        });
        with_digest(&file.to_string())
    };
    let unstable = |word: &str, radius: &str| json!({ "unstable": { "word": word, "radius": radius } });
    let long = format!("0.{}", "3".repeat(3_000_000));
    let near = format!("0.{}", "9".repeat(150));
    let form = vec![vec!["1"; 3]; 3];
    let edges = vec![json!([0, "v", 0]); 300_000];
    for (name, text) in [
        ("digits", of([&long, "1/6"], &unstable("va", "119/100"))),
        (
            "a long fraction",
            of(["1/3", &"7/".repeat(1_000_000)], &unstable("va", "119/100")),
        ),
        ("a radius", of(["3/4", "1/6"], &unstable("va", &long))),
        ("a small exponent", of(["1e-9999", "1/6"], &unstable("va", "119/100"))),
        (
            "a word",
            of(["3/4", "1/6"], &unstable(&"va".repeat(1_000_000), "119/100")),
        ),
        (
            "the longest word",
            of([&near, "1e-300"], &unstable(&"va".repeat(64), "119/100")),
        ),
        (
            "forms",
            of(
                ["3/4", "1/6"],
                &json!({ "stable": { "edges": [], "forms": vec![&form; 100_000] } }),
            ),
        ),
        (
            "edges",
            of(
                ["3/4", "1/6"],
                &json!({ "stable": { "edges": edges, "forms": [form] } }),
            ),
        ),
        (
            "a form",
            of(
                ["3/4", "1/6"],
                &json!({ "stable": { "edges": [[0, "v", 0], [0, "a", 0]], "forms": [vec![vec![&long; 3]; 3]] } }),
            ),
        ),
    ] {
        let outcome = in_time(name, || CertificateFile::read(&text).unwrap().check());
        if let Err(error) = outcome {
            assert_sentence(&error.to_string());
        }
    }
}

/// Every kind of file with damaged bytes, read as the program reads it.
#[test]
fn damaged_bytes_are_refused_or_read() {
    let problems: Vec<String> = case::all()
        .unwrap()
        .iter()
        .take(40)
        .map(|case| case.problem_text.to_owned())
        .collect();
    let answers = answers();
    let dimensions = &answers[0].0;
    let others = [
        answers[0].1.to_string(),
        answers[0].2.clone(),
        json!(case::lock().unwrap()).to_string(),
    ];
    let texts: Vec<String> = [problems, others.to_vec(), certificates()].concat();
    let fates = Fates::default();
    let damages = (select(texts), prop::collection::vec(any_damage(), 1..3));
    proptest!(config(2500, 15), |((text, damages) in damages)| {
        let bytes = damaged(text.as_bytes(), &damages);
        let text = match file::read_from(&bytes[..]) {
            Ok(text) => text,
            Err(error) => {
                fates.count(false);
                prop_assert!(error.to_string().contains("UTF-8"), "{}", error);
                return Ok(());
            }
        };
        let is_read = in_time(&text, || {
            problem_law(&text) | answer_law(&text, dimensions) | certificate_law(&text) | Lock::read(&text).is_ok()
        });
        fates.count(is_read);
        in_time(&text, || respond(&mut own(), &text));
    });
    fates.assert_at_least(600, 150);
}

/// The ends of lines and the mark of an editor change nothing.
#[test]
fn ends_of_lines_and_marks_change_nothing() {
    for case in case::all().unwrap() {
        let other = damaged(case.problem_text.as_bytes(), &[Damage::Ends, Damage::Mark]);
        let text = file::read_from(&other[..]).unwrap();
        assert_eq!(
            ProblemFile::parse(&text).as_ref(),
            ProblemFile::parse(case.problem_text).as_ref()
        );
    }
}

/// What no file may have in it is not read to its end.
#[test]
fn a_file_and_a_line_have_a_greatest_length() {
    let endless = || std::io::BufReader::new(std::io::repeat(b'7'));
    let sentence = file::read_from(endless()).unwrap_err().to_string();
    assert_eq!(sentence, format!("is longer than {} bytes", file::LONGEST_FILE));
    let sentence = file::read_line(&mut endless()).unwrap_err().to_string();
    assert_eq!(sentence, format!("a line longer than {} bytes", file::LONGEST_LINE));
    assert_eq!(
        file::read_line(&mut &b"a\nb"[..]).unwrap().as_deref(),
        Some(&b"a\n"[..])
    );
    assert_eq!(file::read_line(&mut &b""[..]).unwrap(), None);
}

// Arguments

/// Every command with places for words.
const COMMANDS: [(&[&str], &[&str]); 20] = [
    (&["equation", "_"], &[]),
    (&["rule", "_", "-n", "_"], &["--json"]),
    (&["rule", "unscented", "-n", "4"], &["--alpha", "--beta", "--kappa"]),
    (&["choices", "_"], &["--json"]),
    (&["variants", "_"], &["--json"]),
    (&["cases", "list"], &["--case", "--flag", "--kind", "--json"]),
    (&["cases", "show", "_"], &["--json"]),
    (&["cases", "schema", "_"], &[]),
    (&["trace", "_"], &["--json", "--csv"]),
    (&["compare", "_", "--runs", "2"], &["--seed", "--json"]),
    (&["trace", "update.kalman"], &["--digits", "--json"]),
    (
        &["stability"],
        &[
            "--interval",
            "--measurement-noise",
            "--velocity-noise",
            "--acceleration-noise",
            "--json",
        ],
    ),
    (&["stability", "--roots", "_", "_"], &["--json"]),
    (&["stability", "--check", "_"], &["--json"]),
    (
        &["stability", "--map", "--points", "_"],
        &["--from", "--to", "--word", "--memory"],
    ),
    (
        &["reproduce", "_"],
        &["--runs", "--seed", "--set", "--out", "--sweep", "--brief"],
    ),
    (&["claims", "_"], &["--runs", "--seed"]),
    (&["report", "--out", "_"], &["--runs", "--seed"]),
    (
        &["check", "--answers", "_"],
        &["--case", "--flag", "--kind", "--timeout"],
    ),
    (&["answer"], &["--plant", "--show"]),
];

/// Words that something could be: names, numbers, fractions and their likes.
const WORDS: [&str; 45] = [
    "zhu2016(56)",
    "",
    " ",
    "0",
    "-0",
    "1",
    "2",
    "4",
    "5",
    "0.5",
    "1/6",
    "3/4",
    "-1/2",
    "1/0",
    "0/0",
    "1/-3",
    "1/3/5",
    "1e-5",
    "1e5",
    "1e10000",
    "1e-10000",
    "1e99999999999999999999",
    ".",
    "5.",
    ".5",
    "+3",
    "--",
    "-1",
    "NaN",
    "inf",
    "0x10",
    "1_000",
    "١",
    "18446744073709551615",
    "18446744073709551616",
    "-9223372036854775808",
    "cubature-5",
    "gauss-hermite-3",
    "gauss-hermite-9",
    "update.kalman",
    "zhu2016",
    "measurement=range-bearing",
    "=",
    "problem",
    "everything",
];

fn any_word() -> impl Strategy<Value = String> {
    prop_oneof![
        6 => select(&WORDS[..]).prop_map(str::to_owned),
        2 => "[0-9./e+-]{0,12}",
        2 => any::<String>(),
        1 => ("[0-9.a]", 1_usize..20_000).prop_map(|(letter, times)| letter.repeat(times)),
    ]
}

fn any_arguments() -> impl Strategy<Value = Vec<String>> {
    let words = prop::collection::vec(any_word(), 8);
    let options = prop::collection::vec((any::<Index>(), any::<bool>()), 0..4);
    (select(&COMMANDS[..]), words, options).prop_map(|((fixed, known), words, options)| {
        let mut words = words.into_iter();
        let mut arguments = vec!["immaculate".to_owned()];
        for part in fixed {
            let word = if *part == "_" { words.next() } else { None };
            arguments.push(word.unwrap_or_else(|| (*part).to_owned()));
        }
        for (index, joined) in options.into_iter().filter(|_| !known.is_empty()) {
            let option = *index.get(known);
            let has_value = !["--json", "--csv", "--sweep", "--brief"].contains(&option);
            match (has_value, joined, words.next()) {
                (true, true, Some(word)) => arguments.push(format!("{option}={word}")),
                (true, false, Some(word)) => arguments.extend([option.to_owned(), word]),
                _ => arguments.push(option.to_owned()),
            }
        }
        arguments
    })
}

/// Arguments are refused with a sentence and status 2, or the command does something: those that only compute are run.
#[test]
fn any_arguments_are_refused_or_obeyed() {
    let fates = Fates::default();
    proptest!(config(1500, 16), |(arguments in any_arguments())| {
        let text = arguments.join(" ");
        match program::Cli::try_parse_from(&arguments) {
            Err(error) => {
                fates.count(false);
                prop_assert_eq!(error.exit_code(), 2 * i32::from(error.use_stderr()));
                prop_assert!(!error.to_string().is_empty());
            }
            Ok(cli) if only_computes(&arguments) => {
                let outcome = in_time(&text, || program::run(&cli));
                fates.count(outcome.is_ok());
                match outcome {
                    Ok(done) => prop_assert!(done.status <= 2 && !done.text.is_empty()),
                    Err(program::Refusal::Request(sentence) | program::Refusal::Output(sentence)) => {
                        prop_assert!(!sentence.is_empty());
                    }
                }
            }
            Ok(_) => choices_law(&arguments),
        }
    });
    fates.assert_at_least(300, 100);
}

/// Commands that neither read standard input, nor write, nor run for minutes.
fn only_computes(arguments: &[String]) -> bool {
    let reads_input = arguments.iter().any(|word| word == "-");
    let is_long = ["reproduce", "claims", "report", "answer"].contains(&arguments[1].as_str())
        || arguments.iter().any(|word| word == "--map");
    let digits = arguments.iter().position(|word| word.starts_with("--digits"));
    !reads_input && !is_long && digits.is_none()
}

/// The choices of `--set` are those of a paper, or refused by name.
fn choices_law(arguments: &[String]) {
    let words: Vec<String> = arguments.iter().filter(|word| word.contains('=')).cloned().collect();
    let Ok(choices) = Choices::parse(&words) else { return };
    for paper in Paper::ALL {
        if let Err(invalid) = paper.simulation(&choices) {
            assert!(invalid.to_string().contains(paper.key()), "{invalid}");
        }
    }
}

/// Which of two values is meant nobody knows.
#[test]
fn a_key_that_comes_twice_is_refused() {
    for case in case::all().unwrap() {
        let tree: Map<String, Value> = serde_json::from_str(case.problem_text).unwrap();
        let (key, value) = tree.iter().next().unwrap();
        let twice = case
            .problem_text
            .replacen('{', &format!("{{{}:{value},", json!(key)), 1);
        let sentence = ProblemFile::read(&twice).unwrap_err().to_string();
        assert!(sentence.contains("duplicate field"), "{sentence}");
    }
}
