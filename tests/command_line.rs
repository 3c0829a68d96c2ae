//! Goal: the command line does what its help says, and whatever it is given it answers with a sentence and an exit status.
//!
//! Method: the program is run as a reader would run it, with its output in pipes. Kind of evidence: behaviour, by examples, good
//! and bad; what the figures are worth is the other files' work.

mod common;

use common::program::{error_of, immaculate};
use immaculate::paper::verdict::Verdict;
use serde_json::Value;
use std::io::Read;
use std::path::PathBuf;
use std::process::{Output, Stdio};

// What it is

#[test]
fn help_and_version_are_there() {
    let help = succeeds(&["--help"]);
    for word in ["compare", "reproduce", "claims", "rule", "choices", "Exit status"] {
        assert!(help.contains(word), "{word}");
    }
    for command in ["compare", "reproduce", "claims", "rule", "choices", "equation"] {
        assert!(succeeds(&[command, "--help"]).contains("--json"), "{command}");
    }
    assert_eq!(
        succeeds(&["--version"]),
        concat!("immaculate ", env!("CARGO_PKG_VERSION"), "\n")
    );
    // Nothing asked: the same help, as a complaint.
    let nothing = run(&[]);
    assert_eq!(nothing.status.code(), Some(2));
    assert!(error_of(&nothing).contains("Usage: immaculate"));
}

// Commands

#[test]
fn a_rule_is_listed_with_its_proven_degree() {
    let text = succeeds(&["rule", "cubature-5", "--dimension", "4"]);
    for part in [
        "33 points at 33 places, 25 of them",
        "degree 5, proven",
        "E x1^6 = 9, where the Gaussian has 15",
        "√6",
    ] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
    let printed = json(&["rule", "cubature-5-printed", "-n", "4", "--json"]);
    assert_eq!(printed["sum_of_weights"], "5/3");
    assert_eq!(printed["proven_degree"], Value::Null);
    let unscented = json(&["rule", "unscented", "-n", "4", "--kappa", "-1", "--json"]);
    assert_eq!(unscented["list"][0]["weight"], "-1/3");
    assert_eq!(
        unscented,
        json(&["rule", "unscented", "-n", "4", "--json"]),
        "−1 is 3 − n"
    );
    let counts = ["cubature-3", "unscented", "cubature-5", "simplex-5", "gauss-hermite-3"]
        .map(|rule| json(&["rule", rule, "-n", "4", "--json"])["points"].clone());
    assert_eq!(counts, [8, 9, 33, 31, 81]);
}

#[test]
fn stability_proves_and_refutes() {
    let text = succeeds(&["stability"]);
    for part in [
        "t = 2 s, R = 0.05 m²",
        "MIXED     certified stable",
        "P = [",
        "UN-MIXED  certified stable",
        "0.04555",
    ] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
    let unstable = json(&["stability", "--roots", "3/4", "1/6", "--json"]);
    assert_eq!(unstable["mixed"]["verdict"], "unstable");
    assert_eq!(unstable["unmixed"]["verdict"], "stable");
    let index = unstable["steady"][0]["tracking_index"].as_str().unwrap();
    assert!(
        index.starts_with("1.66666666666666666666") && index.ends_with("7e-1"),
        "{index}"
    );
    let gain = unstable["steady"][0]["gain"][0].as_str().unwrap();
    assert!(gain.starts_with("4.3750000") && gain.ends_with("0e-1"), "{gain}");
    assert_eq!(unstable["mixed"]["certificate"]["proof"]["unstable"]["word"], "vva");
    // What may be tried is what is asked for: these two need forms that remember.
    let needs_memory = ["stability", "--roots", "4/5", "46/125"];
    assert!(succeeds(&needs_memory).contains("MIXED     certified stable"));
    assert!(succeeds(&[&needs_memory[..], &["--memory", "0"]].concat()).contains("MIXED     undecided"));
    // Four forms are shown, and no more are spoken of.
    let four = succeeds(&["stability", "--roots", "4/5", "17/50"]);
    assert!(
        four.contains("P(aa) = ") && !four.contains("more: --certificate"),
        "{four}"
    );
    let folder = temporary("certificates");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("proof.json");
    let file = path.to_str().unwrap();
    succeeds(&["stability", "--interval", "1", "--certificate", file]);
    assert!(succeeds(&["stability", "--check", file]).ends_with("proven stable\n"));
    assert_eq!(json(&["stability", "--check", file, "--json"])["proves"], "stable");
    // An accidental edit, a proof of something else, and no certificate at all.
    let written = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, written.replacen("\"1\"", "\"2\"", 1)).unwrap();
    assert!(refuses(&["stability", "--check", file], 2).contains("was changed after it was written"));
    std::fs::write(&path, "{}").unwrap();
    assert!(refuses(&["stability", "--check", file], 2).contains("is not a certificate"));
    std::fs::remove_dir_all(folder).unwrap();
    for (arguments, reason) in [
        (["--interval", "0"], "`interval` is 0"),
        (["--measurement-noise", "-1"], "`measurement` is -1"),
        (["--velocity-noise", "0"], "no steady state"),
        (["--acceleration-noise", "1e99"], "is its unit right"),
        (["--check", "nowhere.json"], "nowhere.json"),
    ] {
        let complaint = refuses(&["stability", arguments[0], arguments[1]], 2);
        assert!(complaint.contains(reason), "{complaint}");
    }
}

#[test]
fn stability_is_asked_of_the_filters_of_a_problem_file() {
    let case = |id: &str| format!("{}/fixtures/cases/{id}.problem.json", env!("CARGO_MANIFEST_DIR"));
    let mixed = json(&["stability", "--problem", &case("derbez2000.fixed-gain.mixed"), "--json"]);
    assert_eq!(
        (&mixed["mixing"], &mixed["verdict"]),
        (&Value::from("mixed"), &Value::from("stable"))
    );
    let text = succeeds(&["stability", "--problem", &case("derbez2000.fixed-gain.mixed")]);
    for part in [
        "MIXED     certified stable",
        "A_0 = [",
        "P − A_1ᵀPA_1",
        "joint spectral radius",
    ] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
    let unmixed = succeeds(&["stability", "--problem", &case("derbez2000.fixed-gain.unmixed")]);
    assert!(unmixed.contains("UN-MIXED  certified stable"), "{unmixed}");
    for (id, reason) in [
        (
            "derbez2000.kalman.run",
            "`filter` is kalman: the question is about filters with fixed gains",
        ),
        ("changing.fixed-gain", "of `measurements` has a motion"),
    ] {
        let complaint = refuses(&["stability", "--problem", &case(id)], 2);
        assert!(complaint.contains(reason), "{complaint}");
    }
    refuses(&["stability", "--problem", "nowhere.json", "--map"], 2);
}

#[test]
fn the_stability_map_is_text_data_and_picture() {
    let folder = temporary("map");
    let text = succeeds(&[
        "stability",
        "--map",
        "--points",
        "7",
        "--from",
        "-2",
        "--to",
        "2",
        "--out",
        folder.to_str().unwrap(),
    ]);
    assert!(
        text.contains("certified stable") && text.lines().filter(|line| line.contains('·')).count() >= 7,
        "{text}"
    );
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    let map: Value = serde_json::from_str(&read("stability-map.json")).unwrap();
    assert_eq!(list(&map["points"]).len(), 49);
    assert_eq!(read("stability-map.csv").lines().count(), 50);
    assert!(read("stability-map.svg").starts_with("<svg"));
    std::fs::remove_dir_all(folder).unwrap();
    assert!(refuses(&["stability", "--map", "--from", "1", "--to", "-1"], 2).contains("below"));
}

#[test]
fn an_equation_is_shown_with_its_code_and_what_catches_mistakes_in_it() {
    let text = succeeds(&["equation", "zhu2016", "56"]);
    for part in [
        "zhu2016 (56)  Covariance of a mixture",
        "The paper prints this form.",
        r"P^{0j}_{k-1|k-1}=\sum_{i=1}^{r}",
        "P⁰ʲ = Σᵢ μᵢ∣ⱼ · [ Pⁱ + (x̂ⁱ − x̂⁰ʲ)(x̂ⁱ − x̂⁰ʲ)ᵀ ]",
        "components[i].covariance",
        "law of total covariance",
        "CODE  mixture_covariance (function)  src/gaussian.rs:",
        "let spread = &deviation * deviation.transpose();",
        "mixed_moments_are_those_of_the_mixture (symbolic)",
        "mixed-spread-omitted",
        "mixing.two-modes",
        "cargo test --test symbolic mixed_moments_are_those_of_the_mixture",
    ] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
    // Formulas and code are as wide as they are; sentences and tables fit.
    let tables = text.lines().filter(|line| line.starts_with('─'));
    assert!(tables.into_iter().all(|line| line.chars().count() <= 100), "{text}");
    for other in ["zhu2016 (56)", "zhu2016-56"] {
        assert_eq!(succeeds(&["equation", other]), text);
    }
    let erratum = succeeds(&["equation", "zhu2016 13"]);
    for part in [
        "ERRATUM  zhu2016-w2 (mathematical), as printed",
        r"w_2=\frac{2}{(n+2)^2}",
        "proof: w_0 + 2n",
    ] {
        assert!(erratum.contains(part), "{part} in\n{erratum}");
    }
    let outside = succeeds(&["equation", "zhu2016", "turn-rate"]);
    assert!(
        outside.contains("OUTSIDE A STEP\n  A number of the scenario"),
        "{outside}"
    );
    for (name, first, count) in [
        ("mixed.covariance", "derbez2000 (1)", 6),
        ("mixture_covariance", "derbez2000 (1)", 9),
    ] {
        let table = succeeds(&["equation", name]);
        assert!(
            table.contains(first) && table.contains(&format!("\n{count} equations")),
            "{table}"
        );
    }
    let all = succeeds(&["equation"]);
    assert!(all.contains("\n190 equations"), "{all}");
    assert!(succeeds(&["equation", "liu2017"]).contains("\n43 equations"));
}

#[test]
fn an_equation_as_json_has_what_the_text_has() {
    let value = json(&["equation", "zhu2016", "57", "--json"]);
    assert_eq!(value["id"], "zhu2016-57");
    assert_eq!(value["number"], 57);
    assert_eq!(value["erratum"]["id"], "zhu2016-likelihood-determinant");
    assert_eq!(value["code"][0]["name"], "log_density");
    assert_eq!(value["code"][0]["dictionary"][0][0], "paper");
    assert!(
        value["code"][0]["code"]
            .as_str()
            .unwrap()
            .starts_with("pub fn log_density")
    );
    assert_eq!(value["quantities"][0], "log_likelihood");
    let test = &value["erratum"]["test"];
    assert!(list(&value["tests"]).iter().any(|held| &held["name"] == test), "{test}");
    assert!(
        list(&value["mistakes"])
            .iter()
            .any(|mistake| mistake["id"] == "two-pi-outside-57")
    );
    assert_eq!(list(&json(&["equation", "--json"])["equations"]).len(), 190);
    let outside = json(&["equation", "liu2017 (turn-rate)", "--json"]);
    assert_eq!(
        (&outside["number"], &outside["name"]),
        (&Value::Null, &Value::from("turn-rate"))
    );
    assert!(outside["outside"].is_string() && list(&outside["cases"]).is_empty());
}

#[test]
fn an_equation_that_does_not_exist_is_named_beside_those_that_do() {
    for (asked, reason) in [
        (
            vec!["zhu2016", "65"],
            "there is no equation `zhu2016 65`; the nearest names are zhu2016-",
        ),
        (vec!["mixture_covarianse"], "mixture_covariance"),
        (vec!["zhu2016-w3"], "zhu2016-"),
    ] {
        let complaint = refuses(&[vec!["equation"], asked].concat(), 2);
        assert!(complaint.contains(reason), "{complaint}");
    }
}

#[test]
fn choices_lists_what_set_understands() {
    let text = succeeds(&["choices"]);
    let listed = json(&["choices", "--json"]);
    let mut tried = 0;
    for paper in list(&listed["papers"]) {
        let key = paper["paper"].as_str().unwrap();
        assert!(text.contains(key));
        for parameter in list(&paper["parameters"]) {
            let name = parameter["name"].as_str().unwrap();
            for alternative in list(&parameter["alternative"]) {
                let alternative = alternative["name"].as_str().unwrap();
                assert!(text.contains(name) && text.contains(alternative));
                let set = format!("{name}={alternative}");
                let shown = json(&["reproduce", key, "--runs", "2", "--set", &set, "--json"]);
                let choices = &shown["papers"][0]["reproduction"]["choices"];
                assert_eq!(choices[name], alternative, "{set}");
                tried += 1;
            }
        }
    }
    assert!(tried > 40, "{tried} alternatives");
}

#[test]
fn reproduce_sets_published_and_computed_figures_side_by_side() {
    let text = succeeds(&["reproduce", "--runs", "5", "--brief"]);
    for part in [
        "RMSE_X (m)",
        "Position ARMSE (m)",
        "74.3",
        "5 runs of 199 steps, seed 1",
        "IMM5thSSRCKF",
    ] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
    // The first line says what is to be seen; what is beside it is asked for.
    let one_line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let first = one_line(text.split('.').next().unwrap());
    assert!(
        first.contains("published figures") && first.contains("standard errors from the computed ones"),
        "{first}"
    );
    assert!(
        one_line(&text).contains("of 20 published figures are more than 4 standard errors from the computed ones."),
        "{text}"
    );
    let whole = succeeds(&["reproduce", "--runs", "5", "--brief", "--full"]);
    for part in ["Consistency and cost", "Delay until", "Converted measurements"] {
        assert!(!text.contains(part) && whole.contains(part), "{part}");
    }
    let all = json(&["reproduce", "--runs", "5", "--json"]);
    let [manoeuvres, acceleration, coastal @ .., zhu, liu] = &list(&all["papers"])[..] else {
        panic!("four papers, one of them with two scenarios and one with four");
    };
    assert_eq!(coastal.len(), 4);
    for (paper, key, filters, figures) in [
        (manoeuvres, "derbez2000", 3, 9),
        (acceleration, "derbez2000", 3, 0),
        (&coastal[0], "sustika2015", 2, 2),
        (&coastal[3], "sustika2015", 2, 2),
        (zhu, "zhu2016", 5, 20),
        (liu, "liu2017", 4, 8),
    ] {
        assert_eq!(list(&paper["published_and_computed"]).len(), figures);
        for figure in list(&paper["published_and_computed"]) {
            for field in [
                "published",
                "computed",
                "standard_error",
                "difference_in_standard_errors",
            ] {
                assert!(figure[field].is_f64(), "{key}: {field} of {figure}");
            }
        }
        let reproduction = &paper["reproduction"];
        assert_eq!(reproduction["paper"], key);
        assert_eq!(reproduction["runs"], 5);
        assert_eq!(reproduction["seed"], 1);
        let steps = reproduction["steps"].as_u64().unwrap();
        assert_eq!(list(&reproduction["times"]).len() as u64, steps);
        assert_eq!(list(&reproduction["filters"]).len(), filters);
        for filter in list(&reproduction["filters"]) {
            assert_eq!(filter["completed_runs"], 5, "{key}: {}", filter["name"]);
            assert_eq!(list(&filter["mode_probabilities"]).len() as u64, steps);
            for history in list(&filter["rmse"]) {
                assert_eq!(list(&history["values"]).len() as u64, steps);
            }
        }
        assert!(!list(&paper["alternatives"]).is_empty(), "every open choice by itself");
    }
    let brief = json(&["reproduce", "liu2017", "--runs", "2", "--brief", "--json"]);
    assert_eq!(list(&brief["papers"]).len(), 1);
    assert!(list(&brief["papers"][0]["alternatives"]).is_empty());
    let of_choices = "Each open choice by itself";
    assert!(succeeds(&["reproduce", "zhu2016", "--runs", "2"]).contains(of_choices));
    assert!(!succeeds(&["reproduce", "zhu2016", "--runs", "2", "--brief"]).contains(of_choices));
}

#[test]
fn claims_gives_every_claim_a_verdict_and_evidence() {
    let all = json(&["claims", "--runs", "2", "--json"]);
    let text = succeeds(&["claims", "--runs", "2"]);
    for paper in list(&all["papers"]) {
        assert!(!list(&paper["claims"]).is_empty());
        for claim in list(&paper["claims"]) {
            let verdict = claim["verdict"].as_str().unwrap();
            let known = Verdict::ALL.map(Verdict::name);
            assert!(known.iter().any(|name| name == verdict), "{verdict}");
            assert!(text.contains(claim["id"].as_str().unwrap()));
            assert!(!claim["evidence"].as_str().unwrap().is_empty());
        }
    }
}

#[test]
fn out_writes_the_files_that_it_names() {
    let directory = temporary("out").join("made").join("on the way");
    succeeds(&[
        "reproduce",
        "zhu2016",
        "--runs",
        "2",
        "--brief",
        "--out",
        directory.to_str().unwrap(),
    ]);
    let text = |name: &str| std::fs::read_to_string(directory.join(name)).unwrap();
    let value: Value = serde_json::from_str(&text("zhu2016.json")).unwrap();
    assert_eq!(value["reproduction"]["runs"], 2);
    for (name, head, columns) in [
        ("zhu2016-errors.csv", "time,filter,quantity,rmse,standard_error", 5),
        (
            "zhu2016-mode-probabilities.csv",
            "time,filter,mode,probability,truth,standard_error",
            6,
        ),
    ] {
        let text = text(name);
        assert_eq!(text.lines().next(), Some(head));
        assert!(text.lines().count() > 500, "{name}");
        for line in text.lines() {
            assert_eq!(line.split(',').count(), columns, "{name}: {line}");
        }
    }
    assert!(text("zhu2016-published.svg").contains("Table 1: RMSE_X"));
    for name in [
        "zhu2016-errors.svg",
        "zhu2016-mode-probabilities.svg",
        "zhu2016-path.svg",
    ] {
        let figure = text(name);
        assert!(
            figure.starts_with("<svg") && figure.trim_end().ends_with("</svg>"),
            "{name}"
        );
        assert!(figure.contains("IMM5CKF") && figure.contains("time (s)"), "{name}");
        assert!(!figure.contains("NaN"), "{name}");
    }
}

#[test]
fn out_writes_both_scenarios_of_a_paper_with_two_and_the_run_that_it_shows() {
    let directory = temporary("out of two scenarios");
    let place = directory.to_str().unwrap();
    let text = succeeds(&["reproduce", "derbez2000", "--runs", "2", "--brief", "--out", place]);
    assert!(!text.contains("Converted measurements"), "of another paper");
    for stem in ["derbez2000", "derbez2000-acceleration"] {
        let text = |name: &str| std::fs::read_to_string(directory.join(format!("{stem}{name}"))).unwrap();
        let value: Value = serde_json::from_str(&text(".json")).unwrap();
        let steps = value["reproduction"]["steps"].as_u64().unwrap();
        let first_run = &value["reproduction"]["first_run"];
        assert_eq!(list(&first_run["truth"]).len() as u64, steps);
        assert_eq!(list(&first_run["estimates"]).len(), 3);
        let path = text("-path.csv");
        assert_eq!(path.lines().next(), Some("time,what,x,y"));
        // Truth, measurements and three filters.
        assert_eq!(path.lines().count() as u64, 1 + 5 * steps);
        for name in ["-path.svg", "-errors.svg", "-mode-probabilities.svg"] {
            let figure = text(name);
            assert!(
                figure.starts_with("<svg") && figure.contains("Fixed Gain"),
                "{stem}{name}"
            );
            assert!(!figure.contains("NaN"), "{stem}{name}");
        }
    }
    assert!(directory.join("derbez2000-figures-1-and-2.svg").exists());
}

/// The published figures of all its scenarios are in one picture; what the paper's conversion is good for is beside them.
#[test]
fn out_writes_the_published_figures_of_all_scenarios_and_the_conversions() {
    let directory = temporary("out of four scenarios");
    let place = directory.to_str().unwrap();
    let text = succeeds(&[
        "reproduce",
        "sustika2015",
        "--runs",
        "2",
        "--brief",
        "--full",
        "--out",
        place,
    ]);
    assert!(
        text.contains("Converted measurements: up to which"),
        "the table of conversions in\n{text}"
    );
    let figure = |name: &str| std::fs::read_to_string(directory.join(format!("sustika2015-{name}.svg"))).unwrap();
    let published = figure("published");
    for table in ["Table 4", "Table 5"] {
        assert!(published.contains(table), "{table}");
    }
    assert!(figure("conversions").contains("ρ"));
    assert!(
        !directory.join("sustika2015-figures-1-and-2.svg").exists(),
        "of another paper"
    );
}

#[test]
fn a_sweep_writes_its_table_and_its_figures_and_the_same_again() {
    let directory = temporary("sweep");
    let place = directory.to_str().unwrap();
    let sweep = |runs: &str, more: &[&str]| {
        let arguments = ["reproduce", "sustika2015", "--sweep", "--runs", runs, "--out", place];
        [&arguments[..], more]
            .concat()
            .iter()
            .map(|text| (*text).to_owned())
            .collect::<Vec<String>>()
    };
    let run = |arguments: Vec<String>| succeeds(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
    let whole = run(sweep("2", &[]));
    assert!(whole.contains("Figure 4a") && whole.contains("with a jump"), "{whole}");
    let names = ["sweep.csv", "sweep.json", "figure-2.svg", "figure-4.svg"];
    let files = || names.map(|name| std::fs::read_to_string(directory.join(format!("sustika2015-{name}"))).unwrap());
    let before = files();
    assert_eq!(before[0].lines().count(), 2 + 280);
    for figure in &before[2..] {
        assert!(figure.starts_with("<svg") && figure.contains("IMM-UKF, never wrapped") && !figure.contains("NaN"));
    }
    assert_eq!(run(sweep("2", &[])), whole);
    assert_eq!(files(), before);
    let value: Value = serde_json::from_str(&run(sweep("2", &["--json"]))).unwrap();
    assert_eq!(list(&value["points"]).len(), 280);
}

#[test]
fn a_sweep_of_another_paper_or_of_what_it_varies_is_refused() {
    for (arguments, words) in [
        (
            &["reproduce", "zhu2016", "--sweep"][..],
            "sustika2015 alone has a sweep",
        ),
        (
            &["reproduce", "--sweep", "--set", "wrapping=never"],
            "a sweep runs every alternative of `wrapping`",
        ),
        (
            &["reproduce", "--sweep", "--set", "window=none"],
            "has no alternative `none`",
        ),
    ] {
        let complaint = refuses(arguments, 2);
        assert!(complaint.contains(words), "{complaint}");
    }
}

// The same answer to the same question

#[test]
fn the_same_seed_gives_the_same_figures_and_another_seed_others() {
    let figures = |seed: &str| {
        let mut answer = json(&["reproduce", "--runs", "3", "--brief", "--seed", seed, "--json"]);
        let removed = remove_times(&mut answer);
        assert_eq!(removed, 23, "one time a filter, and nothing else differs");
        answer
    };
    assert_eq!(figures("5"), figures("5"));
    assert_ne!(figures("5"), figures("6"));
    // The greatest seed is a seed.
    figures("18446744073709551615");
    let verdicts = |seed: &str| json(&["claims", "--runs", "2", "--seed", seed, "--json"]);
    assert_eq!(verdicts("5"), verdicts("5"));
}

// Pipes

#[test]
fn nothing_but_text_is_written_where_nobody_watches() {
    for arguments in [
        &["reproduce", "--runs", "3"][..],
        &["claims", "--runs", "2"],
        &["rule", "simplex-5", "-n", "3"],
        &["choices"],
    ] {
        let output = run(arguments);
        assert!(output.status.success());
        let text = String::from_utf8(output.stdout.clone()).unwrap();
        let is_text = |c: char| c == '\n' || !c.is_control();
        assert!(text.chars().all(is_text), "no colour, no progress bar: {arguments:?}");
        assert_eq!(error_of(&output), "", "{arguments:?}");
    }
}

#[test]
fn a_reader_that_stops_reading_is_no_error() {
    for arguments in [
        &["rule", "cubature-5", "-n", "16", "--json"][..],
        &["reproduce", "--runs", "2", "--brief"],
        &["choices"],
    ] {
        let mut child = immaculate(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // Closed before the program has anything to say.
        drop(child.stdout.take());
        let mut complaint = String::new();
        child.stderr.take().unwrap().read_to_string(&mut complaint).unwrap();
        assert_eq!(complaint, "", "{arguments:?}");
        assert!(child.wait().unwrap().success(), "{arguments:?}");
    }
}

// What does not exist

#[test]
fn what_does_not_exist_is_named_beside_what_does() {
    for (arguments, parts) in [
        (
            &["reproduce", "zhu2017"][..],
            &["`zhu2017`", "derbez2000, sustika2015, zhu2016, liu2017"][..],
        ),
        (
            &["claims", "derbez2001"],
            &["`derbez2001`", "derbez2000, sustika2015, zhu2016, liu2017"],
        ),
        (&["choices", "x"], &["`x`", "derbez2000, sustika2015, zhu2016, liu2017"]),
        (
            &["rule", "simplex", "-n", "4"],
            &["`simplex`", "cubature-3, unscented, cubature-5, simplex-5"],
        ),
        (
            &["reproduce", "--set", "noise=1"],
            &["`noise`", "zhu2016 has measurement, ", "liu2017 has "],
        ),
        (
            &["reproduce", "liu2017", "--set", "measurement=as-printed"],
            &["`measurement`", "liu2017 has "],
        ),
        (
            &["reproduce", "zhu2016", "--set", "measurement=polar"],
            &[
                "`measurement` of zhu2016",
                "`polar`",
                "as-printed, equal-noise, range-bearing",
            ],
        ),
        (
            &["reproduce", "--set", "measurement"],
            &["`measurement`", "parameter=alternative"],
        ),
        (&["reproduce", "--set", ""], &["``", "parameter=alternative"]),
        (
            &["reproduce", "--set", "measurement="],
            &["no alternative ``", "as-printed"],
        ),
        (&["reproduce", "--runs", "1"], &["'1'", "--runs", "2..=50000"]),
        (&["reproduce", "--runs", "many"], &["'many'", "--runs"]),
        (&["reproduce", "--seed", "-1"], &["'-1'"]),
        (&["rule", "cubature-5"], &["--dimension"]),
        (
            &["rule", "cubature-5", "-n", "0"],
            &["`cubature-5`", "at least 1, not 0"],
        ),
        (
            &["rule", "simplex-5", "-n", "1"],
            &["`simplex-5`", "at least 2, not 1", "liu2017 (6)"],
        ),
        (&["rule", "cubature-5", "-n", "33"], &["33", "at most 32"]),
        (&["rule", "gauss-hermite-5", "-n", "32"], &["32", "at most"]),
        (&["rule", "gauss-hermite-3", "-n", "0"], &["at least 1, not 0"]),
        (
            &["rule", "cubature-5", "-n", "4", "--kappa", "1"],
            &["--kappa", "`unscented`"],
        ),
        (
            &["rule", "unscented", "-n", "4", "--kappa", "1/2"],
            &["--kappa", "`1/2`"],
        ),
        (&["rule", "unscented", "-n", "4", "--beta", "NaN"], &["--beta", "`NaN`"]),
        (
            &["rule", "unscented", "-n", "4", "--kappa", "1e999999999"],
            &["--kappa", "1e999999999"],
        ),
        (
            &["rule", "unscented", "-n", "4", "--kappa", "-4"],
            &["n + lambda = 0", "positive"],
        ),
        (
            &["rule", "unscented", "-n", "4", "--alpha", "0"],
            &["n + lambda = 0", "positive"],
        ),
        (
            &["rule", "unscented", "-n", "4", "--kappa", "1e-30"],
            &["n + lambda", "fewer decimals"],
        ),
        (&["prove"], &["'prove'"]),
        (&["reproduce", "--fast"], &["'--fast'"]),
    ] {
        let complaint = refuses(arguments, 2);
        for part in parts {
            assert!(complaint.contains(part), "{arguments:?}: {part} in\n{complaint}");
        }
    }
}

#[test]
fn output_that_cannot_be_written_is_named() {
    let file = temporary("a file");
    std::fs::create_dir_all(file.parent().unwrap()).unwrap();
    std::fs::write(&file, "in the way").unwrap();
    // A file where a directory should be, and below one.
    for place in [file.clone(), file.join("below")] {
        let place = place.to_str().unwrap();
        let complaint = refuses(&["reproduce", "zhu2016", "--runs", "2", "--brief", "--out", place], 1);
        assert!(complaint.contains(place), "{complaint}");
    }
    // A directory where a file should be.
    let directory = temporary("a directory");
    let in_the_way = directory.join("zhu2016-errors.csv");
    std::fs::create_dir_all(&in_the_way).unwrap();
    let arguments = [
        "reproduce",
        "zhu2016",
        "--runs",
        "2",
        "--brief",
        "--out",
        directory.to_str().unwrap(),
    ];
    let complaint = refuses(&arguments, 1);
    assert!(complaint.contains(in_the_way.to_str().unwrap()), "{complaint}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    // Linux has a file that is always full.
    let full = std::fs::File::create("/dev/full").unwrap();
    let output = immaculate(&["choices"]).stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(error_of(&output).contains("standard output"), "{}", error_of(&output));
}

// How the program is run

fn run(arguments: &[&str]) -> Output {
    immaculate(arguments).output().unwrap()
}

/// What a command that succeeds writes; it complains about nothing.
fn succeeds(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert!(output.status.success(), "{arguments:?}: {}", error_of(&output));
    assert_eq!(error_of(&output), "", "{arguments:?}");
    String::from_utf8(output.stdout).unwrap()
}

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&succeeds(arguments)).unwrap()
}

/// The complaint of a command that fails with this status: it writes nothing else, and it is no panic.
fn refuses(arguments: &[&str], status: i32) -> String {
    let output = run(arguments);
    let complaint = error_of(&output);
    assert_eq!(output.status.code(), Some(status), "{arguments:?}: {complaint}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    assert!(!complaint.contains("panicked"), "{arguments:?}: {complaint}");
    let first = complaint.lines().next().unwrap_or_default();
    assert!(
        first.starts_with("immaculate: ") || first.starts_with("error: "),
        "{arguments:?}: {complaint}"
    );
    complaint
}

fn list(value: &Value) -> &Vec<Value> {
    value.as_array().unwrap()
}

/// A place of this test's own that does not exist yet.
fn temporary(name: &str) -> PathBuf {
    let root = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("command_line");
    let place = root.join(name);
    // What an earlier run left, if it left anything.
    let _ = std::fs::remove_dir_all(&place);
    let _ = std::fs::remove_file(&place);
    place
}

/// Takes every time out of an answer and says how many there were.
fn remove_times(value: &mut Value) -> usize {
    match value {
        Value::Object(fields) => {
            let here = usize::from(fields.remove("microseconds_per_step").is_some());
            here + fields.values_mut().map(remove_times).sum::<usize>()
        }
        Value::Array(values) => values.iter_mut().map(remove_times).sum(),
        _ => 0,
    }
}

#[test]
fn a_site_that_could_not_be_written_is_refused_before_it_is_computed() {
    // A file where the folder would be. With the papers' numbers of runs: were they run, this would take minutes.
    let file = env!("CARGO_BIN_EXE_immaculate");
    let output = immaculate(&["report", "--out", file]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let complaint = String::from_utf8(output.stderr).unwrap();
    assert!(complaint.contains(file) && complaint.contains("exists"), "{complaint}");
}
