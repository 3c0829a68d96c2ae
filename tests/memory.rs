//! Goal: memory does not grow with the length of a run, of a check or of a conversation, and what would need more than a machine has is
//! refused in a sentence.
//!
//! Method: measured, by what Linux says of a process: the greatest size that it had (VmHWM) early and late, and a limit on its addresses
//! that the shell sets. The tests of this file that measure do so in processes of their own.

#![cfg(target_os = "linux")]

mod common;

use common::program::{error_of, immaculate};
use immaculate::oracle::case;
use immaculate::oracle::problem::{FilterFile, ProblemFile};
use serde_json::json;
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

/// Measures in this test's own process instead of one of many threads.
const ALONE: &str = "IMMACULATE_MEASURES_ALONE";

/// What allocators keep for themselves, kB; a leak of eight bytes a step would be as large.
const SLACK: u64 = 8_000;

/// The greatest size that a process had, kB.
fn greatest_size(process: &str) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

/// The filter holds the step before and the one that it computes.
#[test]
fn a_million_steps_take_no_more_memory_than_a_thousand() {
    if std::env::var(ALONE).is_err() {
        let name = "a_million_steps_take_no_more_memory_than_a_thousand";
        let own = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", name])
            .env(ALONE, "")
            .output()
            .unwrap();
        assert!(own.status.success(), "{}", String::from_utf8_lossy(&own.stdout));
        return;
    }
    let setup = small().setup_in_doubles().unwrap();
    let mut filter = setup.filter();
    let z = setup.measurements[0].clone().unwrap();
    let mut run = |steps: usize| {
        for _ in 0..steps {
            filter.step(Some(&z)).unwrap();
        }
        greatest_size("self")
    };
    let early = run(1_000);
    let late = run(1_000_000);
    assert!(
        late < early + SLACK,
        "{early} kB after a thousand steps, {late} kB after a million"
    );
}

/// Every problem is another, with a rule of its own or gains of its own: nothing of it is kept.
#[test]
fn answers_take_no_more_memory_after_thousands_of_problems() {
    let mut answering = immaculate(&["answer"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = answering.stdin.take().unwrap();
    let mut output = BufReader::new(answering.stdout.take().unwrap());
    let unscented = problem("step.unscented");
    let fixed = first_of("fixed-gain");
    let mut answer = |number: u32| {
        for mut problem in [unscented.clone(), fixed.clone()] {
            match &mut problem.filter {
                FilterFile::Unscented { kappa, .. } => *kappa = 0.5 + f64::from(number) / 1024.0,
                FilterFile::FixedGain { modes, .. } => modes[0].gain[0][0] = f64::from(number) / 1e6,
                _ => unreachable!("of these two kinds"),
            }
            let _ = writeln!(input, "{}", json!({ "type": "run", "problem": problem }));
            let mut line = String::new();
            output.read_line(&mut line).unwrap();
            assert!(line.starts_with("{\"type\":\"answer\""), "{line}");
        }
    };
    let id = answering.id().to_string();
    (0..500).for_each(&mut answer);
    let early = greatest_size(&id);
    (500..5_000).for_each(&mut answer);
    let late = greatest_size(&id);
    answering.kill().unwrap();
    answering.wait().unwrap();
    assert!(
        late < early + 2_000,
        "{early} kB after 1000 problems, {late} kB after 10 000"
    );
}

/// A line that is as long as it may be, of the values that take the most memory; and one without an end.
#[test]
fn a_check_of_a_program_with_endless_lines_stays_in_bounds() {
    for flood in [
        "printf '{\"id\":['; head -c 16000000 /dev/zero | tr '\\000' '0' | sed 's/00/0,/g'; echo '0]}'",
        "printf '{'; cat /dev/zero",
        "yes 'no message'",
    ] {
        let under_test = format!("read -r line; echo \"{{\\\"type\\\":\\\"ready\\\"}}\"; {flood}");
        let output = limited(
            "exec \"$0\" check --timeout 5 --case update.kalman -- /bin/sh -c \"$1\"",
            &under_test,
        );
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(output.status.code(), Some(1), "{flood}: {said} {}", error_of(&output));
        assert!(said.contains("0 of"), "{flood}: {said}");
    }
}

/// A trace is held as a whole: one that fits is printed in every form within three gigabytes, and one that does not is refused.
#[test]
fn a_long_trace_is_printed_in_bounds_or_refused() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("memory");
    std::fs::create_dir_all(&folder).unwrap();
    let file = |name: &str, problem: &ProblemFile| {
        let place = folder.join(name);
        std::fs::write(&place, json!(problem).to_string()).unwrap();
        place.to_str().unwrap().to_owned()
    };
    let long = file("long.json", &repeated(&small(), 100_000));
    for form in ["", "--json", "--csv"] {
        let output = limited(&format!("exec \"$0\" trace \"$1\" {form} > /dev/null"), &long);
        assert_eq!(output.status.code(), Some(0), "{form}: {}", error_of(&output));
    }
    let too_long = file("too-long.json", &repeated(&problem("step.n4-m2.two-modes"), 100_000));
    let output = limited("exec \"$0\" trace \"$1\"", &too_long);
    assert_eq!(output.status.code(), Some(2), "{}", error_of(&output));
    assert!(
        error_of(&output).contains("problem.measurements: has 100000 steps, and their trace "),
        "{}",
        error_of(&output)
    );
}

/// Raw runs are held as a whole, too: more than fit are refused before anything is run.
#[test]
fn more_runs_than_fit_are_refused() {
    for (arguments, words) in [
        (&["reproduce", "--runs", "50001"][..], "2..=50000"),
        (
            &["claims", "liu2017", "--runs", "2001"],
            "the judges of liu2017 keep all runs in memory, at most 2000",
        ),
        (&["claims", "--runs", "15000"], "the judges of derbez2000"),
        (
            &["report", "--out", "/nowhere/site", "--runs", "3000"],
            "the judges of derbez2000",
        ),
    ] {
        let output = immaculate(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(
            error_of(&output).contains(words),
            "{arguments:?}: {}",
            error_of(&output)
        );
    }
}

/// What is quoted of megabytes is shortened, and cannot steer a terminal.
#[test]
fn sentences_are_short_and_plain() {
    let long = "x".repeat(100_000);
    for arguments in [
        &["rule", &long, "-n", "4"][..],
        &["choices", "\u{1b}[31m\u{7}"],
        &["equation", "\u{1b}[31m\u{7}"],
        &["trace", "\u{1b}[31m\u{7}"],
        &["trace", &long],
        &["variants", &long],
        &["cases", "show", &long],
        &["reproduce", "--set", &long],
        &["stability", "--interval", &long],
    ] {
        let output = immaculate(arguments).output().unwrap();
        let complaint = error_of(&output);
        assert_eq!(output.status.code(), Some(2), "{complaint:.200}");
        assert!(
            complaint.chars().count() < 2_100 && !complaint.contains('\u{1b}'),
            "{complaint:.200}"
        );
    }
    let mut problem = small();
    problem.format = long;
    let sentence = ProblemFile::read(&json!(problem).to_string()).unwrap_err().to_string();
    assert!(
        sentence.starts_with("problem.format: is \"xxx") && sentence.contains('…'),
        "{sentence:.200}"
    );
    assert!(
        sentence.ends_with("but this program reads \"immaculate-problem/1\" and \"immaculate-problem/2\""),
        "{sentence:.200}"
    );
}

fn problem(id: &str) -> ProblemFile {
    let all = case::all().unwrap();
    all.iter().find(|case| case.problem.id == id).unwrap().problem.clone()
}

fn first_of(kind: &str) -> ProblemFile {
    let all = case::all().unwrap();
    let is_right = |case: &&case::Case| matches!(case.expected, case::Expected::Trace(_));
    let mut right = all.iter().filter(is_right);
    right
        .find(|case| case.problem.filter.name() == kind)
        .unwrap()
        .problem
        .clone()
}

fn small() -> ProblemFile {
    problem("step.n1-m1.two-modes")
}

/// The first measurement of a problem again and again.
fn repeated(problem: &ProblemFile, steps: usize) -> ProblemFile {
    let mut problem = problem.clone();
    let first = problem.measurements[0].clone();
    problem.measurements = (1..=steps)
        .map(|step| {
            let mut entry = first.clone();
            entry.step = step;
            entry
        })
        .collect();
    problem
}

/// A script with three gigabytes of addresses; the program is `$0`.
fn limited(script: &str, argument: &str) -> Output {
    let script = format!("ulimit -v 3145728; {script}");
    Command::new("/bin/sh")
        .args(["-c", &script, env!("CARGO_BIN_EXE_immaculate"), argument])
        .stdin(Stdio::null())
        .output()
        .unwrap()
}
