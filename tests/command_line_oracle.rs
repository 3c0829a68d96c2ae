//! Goal: the commands of the oracle do what their help says, and whatever they are given they answer with a sentence, an exit status, and
//! no half-written file.
//!
//! Method: the program is run as a reader would run it, with its output in pipes, and its output is held against the library and the
//! published files. Kind of evidence: behaviour, by examples, good and bad. The command `check` has a file of its own.

mod common;

use common::program::{error_of, immaculate, names};
use immaculate::imm::{Needs, Quantity};
use immaculate::oracle::case::{self, Case, Expected};
use immaculate::oracle::certify::certify;
use immaculate::oracle::csv;
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::run::run_in_doubles;
use immaculate::oracle::trace::{FORMAT, Trace};
use immaculate::oracle::variant::catalogue;
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Output, Stdio};

// Help

#[test]
fn every_command_has_help_with_its_options() {
    for (arguments, words) in [
        (
            &["check"][..],
            &[
                "--answers",
                "--case",
                "--flag",
                "--kind",
                "--timeout",
                "--json",
                "--strict",
                "Exit status: 0 all that was judged is right, 1",
            ][..],
        ),
        (&["trace"], &["--digits", "--json", "--csv", "standard input"]),
        (&["cases"], &["list", "show", "copy", "verify", "schema"]),
        (&["cases", "list"], &["--case", "--flag", "--kind", "--json"]),
        (&["cases", "show"], &["--json"]),
        (&["cases", "copy"], &["--case", "long CSV"]),
        (&["cases", "verify"], &["--case", "--json"]),
        (&["cases", "schema"], &["problem", "trace"]),
        (&["variants"], &["--json"]),
        (
            &["answer"],
            &["--plant", "--show", "everything", "posteriors", "combined"],
        ),
    ] {
        let help = succeeds(&[arguments, &["--help"]].concat());
        for word in words {
            assert!(help.contains(word), "{arguments:?}: {word} in\n{help}");
        }
    }
}

// Traces

#[test]
fn a_trace_shows_every_value_with_its_equation() {
    let text = succeeds(&["trace", "update.kalman"]);
    assert!(
        text.contains("step 1: z = [160.0, -35.0]") && text.contains("left turn"),
        "{text}"
    );
    // A Kalman filter converts nothing, and linearises nothing.
    let is_there = |needed| matches!(needed, Needs::Covariances | Needs::Detection);
    for quantity in Quantity::ALL.into_iter().filter(|quantity| quantity.exists(is_there)) {
        let heading = format!("  {}  —  {}\n", quantity.name(), quantity.equation());
        assert!(text.contains(&heading), "{heading}");
    }
    assert!(!text.contains("converted"), "nothing is converted:\n{text}");
    let converted = succeeds(&["trace", "converted.generic"]);
    for heading in [
        "  converted_measurement  —  sustika2015 (20)-(21)\n",
        "  converted_covariance  —  sustika2015 (22)-(26)\n",
        "  innovation  —  sustika2015 (18)\n",
    ] {
        assert!(converted.contains(heading), "{heading}{converted}");
    }
    assert!(succeeds(&["trace", "missed.one"]).contains("no detection"));
    let text = succeeds(&["trace", "step.fixed-gain"]);
    assert!(text.contains("  gain  —  derbez2000, section 3, given\n"), "{text}");
    assert!(
        !text.contains("covariance  —  zhu2016"),
        "there is no covariance:\n{text}"
    );
}

/// Exact: a convention changes what it is of, in every form of a trace; one that is the papers' changes nothing.
#[test]
fn a_trace_follows_a_declared_convention() {
    let first = |arguments: &[&str]| {
        json_of(&[&["trace", "convention.first-step", "--json"], arguments].concat())["steps"][0].clone()
    };
    let of_papers = first(&[]);
    assert_eq!(first(&["--convention", "first_step=mixed"]), of_papers);
    let predicted = first(&["--convention", "first_step=predicted"]);
    let problem = &of("convention.first-step").problem;
    let given: Vec<&Vec<f64>> = problem.initial.modes.iter().map(|estimate| &estimate.mean).collect();
    for (mode, mean) in given.iter().enumerate() {
        assert_eq!(
            predicted["modes"][mode]["predicted"]["mean"],
            serde_json::json!(mean),
            "the estimate is the prediction"
        );
        assert_ne!(of_papers["modes"][mode]["predicted"]["mean"], serde_json::json!(mean));
    }
    let certified = succeeds(&[
        "trace",
        "convention.first-step",
        "--digits",
        "6",
        "--convention",
        "first_step=predicted",
    ]);
    assert_ne!(
        certified,
        succeeds(&["trace", "convention.first-step", "--digits", "6"])
    );
    for (given, said) in [
        ("first_step", "needs a value"),
        (
            "first_step=prior",
            "there is no convention `first_step`: \"prior\"; known are",
        ),
    ] {
        let output = run(&["trace", "convention.first-step", "--convention", given]);
        assert_eq!(output.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&output.stderr).contains(said), "{output:?}");
    }
}

/// Exact: JSON and CSV are the doubles of the library.
#[test]
fn a_trace_as_json_and_as_csv_is_that_of_the_library() {
    for id in ["update.kalman", "missed.one", "step.n1-m1.two-modes"] {
        // As a file of its own: it has what the case was published without.
        let problem = ProblemFile::read(of(id).problem_text).unwrap();
        let (expected, failure) = run_in_doubles(&problem).unwrap();
        assert_eq!(failure, None);
        let value = json_of(&["trace", id, "--json"]);
        assert_eq!(value["format"], FORMAT);
        assert_eq!(value["id"], id);
        assert_eq!(value["error"], Value::Null);
        assert_eq!(
            Trace::from_json(&value["steps"], &expected.dimensions),
            Ok(expected.clone()),
            "{id}"
        );
        let text = succeeds(&["trace", id, "--csv"]);
        assert_eq!(csv::read(&text, id, &expected.dimensions), Ok(expected), "{id}");
    }
}

/// Exact: the published numbers are the doubles nearest to the decimals, of which there are as many as were asked for.
#[test]
fn certified_digits_round_to_the_published_numbers() {
    for id in ["update.kalman", "missed.one"] {
        let mut value = json_of(&["trace", id, "--digits", "30", "--json"]);
        assert_eq!(value["digits"], 30);
        for step in value["steps"].as_array_mut().unwrap() {
            for mode in step["modes"].as_array_mut().unwrap() {
                mode.as_object_mut().unwrap().remove("nis"); // without which these cases were published
            }
        }
        let file = parsed(of(id).trace_text);
        let (mut decimals, mut published) = (Vec::new(), Vec::new());
        leaves(&value["steps"], &mut decimals);
        leaves(&file["steps"], &mut published);
        assert_eq!(decimals.len(), published.len());
        assert!(decimals.len() > 50);
        for (decimal, number) in decimals.iter().zip(&published) {
            let Value::String(decimal) = decimal else {
                // The number of the step.
                assert_eq!(decimal, number);
                continue;
            };
            let double: f64 = decimal.parse().unwrap();
            assert_eq!(Some(double), number.as_f64(), "{id}: {decimal}");
            let mantissa = decimal.split(['e', 'E']).next().unwrap();
            let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
            assert!(
                decimal == "0" || digits.trim_start_matches('0').len() == 30,
                "{id}: {decimal}"
            );
        }
    }
    let text = succeeds(&["trace", "update.kalman", "--digits", "40"]);
    assert!(text.contains("40 digits of every value, proven with "), "{text}");
}

#[test]
fn a_problem_comes_from_a_file_or_from_standard_input() {
    let folder = temporary("file");
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("my problem.json");
    std::fs::write(&file, of("update.kalman").problem_text).unwrap();
    let expected = succeeds(&["trace", "update.kalman"]);
    assert_eq!(succeeds(&["trace", file.to_str().unwrap()]), expected);
    let output = run_with(&["trace", "-"], of("update.kalman").problem_text.as_bytes());
    assert!(output.status.success());
    assert_eq!(String::from_utf8(output.stdout).unwrap(), expected);
}

#[test]
fn a_run_that_stops_says_at_which_step() {
    let mut problem = of("steps.kalman").problem.clone();
    problem.measurements[1].z = Some(vec![Some(1e200), Some(-1e200)]);
    let text = json!(problem).to_string();
    for form in [&["trace", "-"][..], &["trace", "-", "--csv"], &["trace", "-", "--json"]] {
        let output = run_with(form, text.as_bytes());
        assert_eq!(output.status.code(), Some(1), "{form:?}");
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.starts_with("immaculate: steps.kalman: step 2, "), "{said}");
        assert!(!output.stdout.is_empty(), "{form:?}: what came before is shown");
    }
    let output = run_with(&["trace", "-", "--json"], text.as_bytes());
    let value: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(value["error"].as_str().unwrap().starts_with("step 2, "), "{value}");
    assert_eq!(value["steps"][0]["step"], 1);
}

/// A prior of 10¹⁵ beside a noise of 10⁻⁴ leaves doubles no digit of a variance.
#[test]
fn a_variance_that_rounding_made_negative_is_a_complaint() {
    let problem = json!({
        "format": "immaculate-problem/2", "id": "diffuse", "state": ["x", "vx"],
        "F": [[1, 0.1], [0, 1]], "Q": [[2.5e-5, 5e-4], [5e-4, 0.01]],
        "measurement": { "kind": "linear", "H": [[1, 0]] }, "R": [[1e-4]], "filter": { "kind": "kalman" },
        "initial": { "mean": [0, 1], "covariance": [[1e15, 0], [0, 1e15]] },
        "measurements": [{ "step": 1, "z": [1.5] }, { "step": 2, "z": [1.7] }]
    });
    let output = run_with(&["trace", "-"], problem.to_string().as_bytes());
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.starts_with("immaculate: diffuse: step 2, mode `filter`, updated.covariance: a variance is -"),
        "{said}"
    );
    let output = run_with(&["trace", "-", "--digits", "6"], problem.to_string().as_bytes());
    assert!(output.status.success());
}

#[test]
fn a_bad_problem_file_is_named_with_the_place_inside() {
    let folder = temporary("bad files");
    std::fs::create_dir_all(&folder).unwrap();
    let good = of("update.kalman").problem_text;
    let bytes = |text: String| text.into_bytes();
    for (name, content, words) in [
        ("not json", bytes("{".into()), "problem: EOF while parsing"),
        ("empty", Vec::new(), "problem: EOF while parsing"),
        ("not text", vec![0xff, 0xfe, 0], "valid UTF-8"),
        (
            "a trace",
            bytes(of("update.kalman").trace_text.into()),
            "problem.steps: unknown field `steps`",
        ),
        (
            "key",
            bytes(good.replacen("\"R\"", "\"r\"", 1)),
            "problem.r: unknown field `r`",
        ),
        (
            "symmetry",
            bytes(good.replacen("29.7]", "29.8]", 1)),
            "problem.R: is not symmetric",
        ),
        (
            "number",
            bytes(good.replacen("25.0", "1e999", 1)),
            "problem.modes[0].Q[0][0]: number out of range",
        ),
    ] {
        let file = folder.join(name);
        std::fs::write(&file, content).unwrap();
        for more in [&[][..], &["--json"], &["--csv"], &["--digits", "20"]] {
            let complaint = refuses(&[&["trace", file.to_str().unwrap()], more].concat(), 2);
            assert!(
                complaint.starts_with(&format!("immaculate: {}: ", file.display())),
                "{complaint}"
            );
            assert!(complaint.contains(words), "{words} in {complaint}");
            assert_eq!(complaint.lines().count(), 1, "{complaint}");
        }
    }
    for (arguments, words) in [
        (&["trace", "no.such.case"][..], "no.such.case: "),
        (
            &["trace", "rejected.shape.matrix"],
            "rejected.shape.matrix: problem.modes[0].F[3]: has 3 entries where 4",
        ),
        (&["trace", folder.to_str().unwrap()], "directory"),
        (&["trace"], "<FILE>"),
        (&["trace", "update.kalman", "--digits", "0"], "'0'"),
        (&["trace", "update.kalman", "--digits", "1001"], "'1001'"),
        (&["trace", "update.kalman", "--csv", "--json"], "cannot be used with"),
        (
            &["trace", "update.kalman", "--csv", "--digits", "20"],
            "cannot be used with",
        ),
    ] {
        let complaint = refuses(arguments, 2);
        assert!(complaint.contains(words), "{words} in {complaint}");
    }
}

// Cases

#[test]
fn the_list_has_every_case_and_every_selection_its_own() {
    let text = succeeds(&["cases", "list"]);
    let listed = json_of(&["cases", "list", "--json"]);
    let cases = listed["cases"].as_array().unwrap();
    assert_eq!(cases.len(), all().len());
    for (value, case) in cases.iter().zip(all()) {
        let problem = &case.problem;
        assert_eq!(value["id"], problem.id);
        assert_eq!(value["modes"], problem.modes.len());
        let class = match case.expected {
            Expected::Rejection(class) => json!(class.name()),
            Expected::Trace(_) => Value::Null,
        };
        assert_eq!(value["rejected"], class);
        assert!(text.contains(&problem.id), "{}", problem.id);
    }
    assert!(text.contains(&format!("{} cases. The filters:", all().len())) && text.contains("\nThe flags:\n"));
    let ids = |selection: &[&str]| {
        let value = json_of(&[&["cases", "list", "--json"], selection].concat());
        let ids = value["cases"].as_array().unwrap().iter();
        ids.map(|case| case["id"].as_str().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    assert_eq!(ids(&["--case", "update.kalman"]), ["update.kalman"]);
    let wrapped: Vec<String> = all()
        .iter()
        .filter(|case| case.problem.flags.contains(&"wrap".to_owned()) && case.problem.filter.name() == "cubature-5")
        .map(|case| case.problem.id.clone())
        .collect();
    assert_eq!(ids(&["--flag", "wrap", "--kind", "cubature-5"]), wrapped);
    for action in [&["list"][..], &["verify"], &["copy", "unused"]] {
        for selection in [["--case", "no.such"], ["--flag", "no-such"], ["--kind", "no-such"]] {
            let complaint = refuses(&[&["cases"], action, &selection].concat(), 2);
            assert!(complaint.contains("no case matches the selection"), "{complaint}");
        }
    }
}

/// Exact: what is shown is what is published.
#[test]
fn a_case_is_shown_as_it_is_published() {
    let case = of("update.kalman");
    let text = succeeds(&["cases", "show", "update.kalman"]);
    assert!(text.contains(case.problem_text) && text.contains(case.trace_text));
    let value = json_of(&["cases", "show", "update.kalman", "--json"]);
    assert_eq!(
        value,
        json!({ "problem": parsed(case.problem_text), "trace": parsed(case.trace_text) })
    );
    let complaint = refuses(&["cases", "show", "update"], 2);
    assert!(complaint.contains("there is no case `update`"), "{complaint}");
}

/// Exact: what is copied is what is published.
#[test]
fn copied_cases_are_the_published_files() {
    let folder = temporary("copy").join("made").join("on the way");
    let text = succeeds(&[
        "cases",
        "copy",
        folder.to_str().unwrap(),
        "--case",
        "update.kalman",
        "--case",
        "rejected.shape.matrix",
    ]);
    assert!(text.starts_with("2 cases, 5 files written to "), "{text}");
    assert_eq!(
        names(&folder),
        [
            "rejected.shape.matrix.problem.json",
            "rejected.shape.matrix.trace.json",
            "update.kalman.problem.json",
            "update.kalman.trace.csv",
            "update.kalman.trace.json",
        ]
    );
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    let case = of("update.kalman");
    assert_eq!(read("update.kalman.problem.json"), case.problem_text);
    assert_eq!(read("update.kalman.trace.json"), case.trace_text);
    let Expected::Trace(trace) = &case.expected else {
        panic!("a trace");
    };
    let long = read("update.kalman.trace.csv");
    assert_eq!(csv::read(&long, "update.kalman", &trace.dimensions).as_ref(), Ok(trace));
    let head = format!("{},scale,noise", csv::HEADER);
    assert_eq!(long.lines().next(), Some(head.as_str()));
    for line in long.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        assert!(
            fields.len() == 9 && fields[7..].iter().all(|number| number.parse::<f64>().unwrap() > 0.0),
            "{line}"
        );
    }
}

/// Exact: with a convention, the copied trace is that of `trace` with the same convention, and the folder says which it is.
#[test]
fn copied_cases_follow_a_declared_convention() {
    let folder = temporary("copy with a convention");
    let id = "convention.first-step";
    let copied = |convention: &str| {
        succeeds(&[
            "cases",
            "copy",
            folder.to_str().unwrap(),
            "--case",
            id,
            "--convention",
            convention,
        ]);
        let text = std::fs::read_to_string(folder.join(format!("{id}.trace.json"))).unwrap();
        let steps = parsed(&text)["steps"].clone();
        Trace::from_json(&steps, &of(id).problem.dimensions()).unwrap()
    };
    assert_eq!(Expected::Trace(copied("first_step=mixed")), of(id).expected);
    let mut problem = of(id).problem.clone();
    problem.declared = vec!["first-step-predicted"];
    assert_eq!(copied("first_step=predicted"), certify(&problem).unwrap().trace);
    let chosen = parsed(&std::fs::read_to_string(folder.join("conventions.json")).unwrap());
    assert_eq!(chosen, json!({ "first_step": "predicted" }));
}

#[test]
fn nothing_is_written_when_copying_is_refused() {
    let folder = temporary("not copied");
    let place = folder.to_str().unwrap();
    for selection in [
        &["--case", "no.such"][..],
        &["--flag", "no-such"],
        &["--colour", "red"],
        &["--convention", "first_step=prior"],
    ] {
        refuses(&[&["cases", "copy", place], selection].concat(), 2);
        assert!(!folder.exists(), "{selection:?}");
    }
    // A file where the folder should be, and a folder where a file should be.
    std::fs::create_dir_all(folder.parent().unwrap()).unwrap();
    std::fs::write(&folder, "in the way").unwrap();
    let complaint = refuses(&["cases", "copy", place, "--case", "update.kalman"], 1);
    assert!(complaint.contains(place), "{complaint}");
    assert_eq!(std::fs::read_to_string(&folder).unwrap(), "in the way");
    let folder = temporary("in the way");
    std::fs::create_dir_all(folder.join("update.kalman.problem.json")).unwrap();
    let complaint = refuses(
        &["cases", "copy", folder.to_str().unwrap(), "--case", "update.kalman"],
        1,
    );
    assert!(complaint.contains("update.kalman.problem.json"), "{complaint}");
    assert_eq!(
        names(&folder),
        ["update.kalman.problem.json"],
        "no part of a file is left"
    );
}

#[test]
fn verified_cases_are_counted() {
    let text = succeeds(&["cases", "verify", "--case", "update.kalman", "--case", "rejected.shape"]);
    assert!(
        text.contains("6 of 6 cases proven again") && text.contains("rejected, as they must be: 5"),
        "{text}"
    );
    let value = json_of(&["cases", "verify", "--case", "update.kalman", "--json"]);
    let case = &value["cases"][0];
    assert_eq!(
        (&case["id"], &case["proven"], &case["wrong"]),
        (&json!("update.kalman"), &json!(true), &Value::Null)
    );
    assert!(
        case["values"].as_u64().unwrap() > 100 && case["digits_left"].as_u64().unwrap() > 50,
        "{case}"
    );
}

/// Exact: what is printed is what is published.
#[test]
fn schemas_are_printed_as_they_are_published() {
    for name in ["problem", "trace", "certificate"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("spec/schemas/{name}.schema.json"));
        let published = std::fs::read_to_string(path).unwrap();
        assert_eq!(succeeds(&["cases", "schema", name]), published);
    }
    assert!(refuses(&["cases", "schema", "answer"], 2).contains("[possible values: problem, trace, certificate]"));
}

// Variants and answers

#[test]
fn the_catalogue_is_listed_and_each_variant_shown_in_full() {
    let text = succeeds(&["variants"]);
    let value = json_of(&["variants", "--json"]);
    let listed = value["variants"].as_array().unwrap();
    assert_eq!(listed.len(), catalogue().len());
    for (variant, listed) in catalogue().iter().zip(listed) {
        assert_eq!(listed["id"], variant.id.as_str());
        assert!(text.contains(&variant.id), "{}", variant.id);
    }
    let id = "mixed-spread-omitted";
    let full = succeeds(&["variants", id]);
    assert!(
        full.starts_with(&format!("{id}  (")) && full.contains("what: "),
        "{full}"
    );
    assert_eq!(json_of(&["variants", id, "--json"])["id"], id);
    assert!(refuses(&["variants", "no-such"], 2).contains("there is no variant `no-such`"));
}

#[test]
fn the_answering_side_says_what_it_does_not_understand() {
    assert!(refuses(&["answer", "--plant", "no-such"], 2).contains("there is no variant `no-such`"));
    for line in ["hello\n", "{}\n", "[]\n"] {
        let output = run_with(&["answer"], line.as_bytes());
        let complaint = error_of(&output);
        assert_eq!(output.status.code(), Some(2), "{complaint}");
        assert!(
            complaint.starts_with("immaculate: ") && output.stdout.is_empty(),
            "{complaint}"
        );
    }
    let output = run_with(
        &["answer"],
        b"{\"type\":\"start\"}\n{\"type\":\"stop\"}\nnot read any more\n",
    );
    assert!(output.status.success());
    assert_eq!(String::from_utf8(output.stdout).unwrap().lines().count(), 1);
    // The end of the input is an end, too.
    assert!(run_with(&["answer"], b"").status.success());
}

// How the program is run

fn all() -> &'static [Case] {
    case::all().unwrap()
}

fn of(id: &str) -> &'static Case {
    all().iter().find(|case| case.problem.id == id).unwrap()
}

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

fn run(arguments: &[&str]) -> Output {
    run_with(arguments, b"")
}

fn run_with(arguments: &[&str], input: &[u8]) -> Output {
    let mut child = immaculate(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A program that has read enough may be gone.
    let _ = child.stdin.take().unwrap().write_all(input);
    child.wait_with_output().unwrap()
}

fn succeeds(arguments: &[&str]) -> String {
    let output = run(arguments);
    let complaint = error_of(&output);
    assert!(
        output.status.success() && complaint.is_empty(),
        "{arguments:?}: {complaint}"
    );
    String::from_utf8(output.stdout).unwrap()
}

fn json_of(arguments: &[&str]) -> Value {
    parsed(&succeeds(arguments))
}

/// The complaint of a command that fails with this status: it writes nothing else, and it is no panic.
fn refuses(arguments: &[&str], status: i32) -> String {
    let output = run(arguments);
    let complaint = error_of(&output);
    assert_eq!(output.status.code(), Some(status), "{arguments:?}: {complaint}");
    assert!(
        output.stdout.is_empty() && !complaint.contains("panicked"),
        "{arguments:?}: {complaint}"
    );
    complaint
}

/// A place of this test's own that does not exist yet.
fn temporary(name: &str) -> PathBuf {
    let place = PathBuf::from(env!("CARGO_TARGET_TMPDIR"))
        .join("command_line_oracle")
        .join(name);
    // What an earlier run left, if it left anything.
    let _ = std::fs::remove_dir_all(&place);
    let _ = std::fs::remove_file(&place);
    place
}

/// The values of a JSON value that are neither lists nor objects, in their order.
fn leaves<'a>(value: &'a Value, found: &mut Vec<&'a Value>) {
    match value {
        Value::Array(list) => list.iter().for_each(|value| leaves(value, found)),
        Value::Object(object) => object.values().for_each(|value| leaves(value, found)),
        leaf => found.push(leaf),
    }
}
