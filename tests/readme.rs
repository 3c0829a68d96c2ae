//! Goal: README and the pages for users tell the truth: their commands print what they show, and their numbers are those of today.
//!
//! Method: each `console` block is a command and an excerpt of its output; every line of the excerpt must occur in the output, in that
//! order, spaces aside. Blocks in Rust are run with the documentation's examples; those in other languages by `python/run.sh` and
//! `tests/adapters/run.sh`.

use immaculate::oracle::case;
use immaculate::oracle::judge::LIMIT;
use immaculate::oracle::variant::{Kind, catalogue};
use immaculate::paper::sustika2015::sweep::settings;
use immaculate::paper::{MOST_RUNS, Paper};
use std::process::Command;

const README: &str = include_str!("../README.md");
const CHECKING: &str = include_str!("../spec/checking.md");
const COMPARING: &str = include_str!("../spec/comparing.md");
const FINDINGS: &str = include_str!("../spec/findings.md");
const GUARANTEES: &str = include_str!("../spec/guarantees.md");
const LIBRARY: &str = include_str!("../spec/library.md");
const FORMATS: &str = include_str!("../spec/formats.md");
const MAINTAINING: &str = include_str!("../spec/maintaining.md");
const EXAMPLE: &str = include_str!("../spec/example.json");
const NAMED: &str = include_str!("snapshots/oracle__what_each_level_of_answer_can_tell.snap");

#[test]
fn the_commands_of_the_pages_print_what_they_show() {
    let pages = [README, CHECKING, COMPARING, FINDINGS, GUARANTEES, LIBRARY];
    let blocks = pages
        .into_iter()
        .flat_map(|page| page.split("```console\n").skip(1))
        .map(|rest| rest.split("```").next().unwrap());
    let mut compared = 0;
    for block in blocks {
        let mut lines = block.lines();
        let command = lines.next().unwrap();
        let Some(arguments) = command.strip_prefix("$ cargo run --release -- ") else {
            assert_eq!(command, "$ cargo test", "an unknown command");
            continue;
        };
        let program = env!("CARGO_BIN_EXE_immaculate");
        let own_name = |argument| if argument == "immaculate" { program } else { argument };
        let output = Command::new(program)
            .args(arguments.split(' ').map(own_name))
            .output()
            .unwrap();
        // A check that finds something wrong ends with 1.
        let expected = i32::from(arguments.contains("--plant"));
        assert_eq!(output.status.code(), Some(expected));
        let output = String::from_utf8(output.stdout).unwrap();
        let mut printed = output.lines().map(without_spaces);
        for line in lines.filter(|line| !line.trim().is_empty()) {
            let shown = without_spaces(line);
            assert!(
                printed.any(|printed| printed == shown),
                "`{command}` does not print, or not in this place:\n{line}"
            );
            compared += 1;
        }
    }
    assert!(compared > 30, "the pages show the output of commands: {compared} lines");
}

fn without_spaces(line: &str) -> String {
    line.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn the_numbers_of_cases_and_variants_are_those_of_the_catalogues() {
    let words = |page: &str| page.split_whitespace().collect::<Vec<_>>().join(" ");
    let count = |kind| catalogue().iter().filter(|variant| variant.kind == kind).count();
    let (mistakes, conventions, forms) = (count(Kind::Mistake), count(Kind::Convention), count(Kind::Form));
    let cases = case::all().unwrap().len();
    let planted = format!("Of {} mistakes and conventions", mistakes + conventions);
    for (page, sentence) in [
        (
            CHECKING,
            format!("{mistakes} mistakes, {conventions} conventions and {forms} forms"),
        ),
        (CHECKING, format!("the {cases} certified cases")),
        (CHECKING, planted.clone()),
        (README, planted),
    ] {
        assert!(words(page).contains(&sentence), "the page does not say: {sentence}");
    }
}

/// Numbers in sentences: each is computed, or is that of a page or a snapshot that another test holds.
#[test]
fn the_other_numbers_of_the_pages_are_those_of_today() {
    let words = |page: &str| page.split_whitespace().collect::<Vec<_>>().join(" ");
    let named = |level: &str| -> String {
        let line = NAMED.lines().find_map(|line| line.strip_prefix(level)).unwrap();
        line.split(" named").next().unwrap().trim().to_owned()
    };
    let (posteriors, combined) = (named("posteriors:"), named("combined alone:"));
    let judged_runs = |paper: Paper| paper.most_judged_runs();
    let (derbez, liu, zhu) = (Paper::Derbez2000, Paper::Liu2017, Paper::Zhu2016);
    assert_eq!(
        judged_runs(derbez),
        judged_runs(liu),
        "the page has one number for both"
    );
    for (page, sentence) in [
        (
            README,
            format!("an extended Kalman filter in {} lines", EXAMPLE.lines().count()),
        ),
        (
            CHECKING,
            format!(
                "all are named if the program reports every value, {posteriors} if it reports only posteriors, and {combined} from the combined"
            ),
        ),
        (CHECKING, format!("larger than {} times this noise", in_words(LIMIT))),
        (FORMATS, format!("< {LIMIT} · noise")),
        (
            FORMATS,
            format!(
                "{} of derbez2000 and of liu2017, {}",
                judged_runs(derbez),
                in_thousands(judged_runs(zhu))
            ),
        ),
        (FORMATS, format!("| `--runs` | {};", in_thousands(MOST_RUNS))),
        (FINDINGS, format!("--sweep` runs {} settings", settings().len())),
    ] {
        assert!(words(page).contains(&sentence), "the page does not say: {sentence}");
    }
}

fn in_words(limit: f64) -> &'static str {
    assert_eq!(limit.to_bits(), 100.0_f64.to_bits(), "the page says it in words");
    "a hundred"
}

fn in_thousands(number: usize) -> String {
    format!("{} {:03}", number / 1000, number % 1000)
}

/// The mutants that `guarantees.md` counts are those of the table in `maintaining.md`.
#[test]
fn the_mutants_of_the_guarantees_are_those_of_the_table() {
    let row = |room: &str| -> Vec<usize> {
        let line = MAINTAINING
            .lines()
            .find(|line| line.starts_with(&format!("| {room} |")))
            .unwrap();
        line.split(" | ").filter_map(|cell| cell.trim().parse().ok()).collect()
    };
    // mutants, do not compile, not chosen, compile, run, caught, out of time, survived
    let all = row("**all**");
    let rooms =
        ["gaussian", "matrix", "rule", "model", "filter", "imm", "statistics"].map(|room| row(&format!("`{room}`")));
    let of_equations = |column: usize| rooms.iter().map(|row| row[column]).sum::<usize>();
    let text = GUARANTEES.split_whitespace().collect::<Vec<_>>().join(" ");
    for sentence in [
        format!(
            "finds {} such mutants, and {} of them compile",
            in_thousands(all[0]),
            in_thousands(all[3])
        ),
        format!("All {} in the folders of the equations", in_thousands(of_equations(4))),
        format!("were run, and {} turned a test red.", in_thousands(of_equations(5))),
        format!(
            "Elsewhere {} of {} were run, and {} turned",
            in_thousands(all[4] - of_equations(4)),
            in_thousands(all[3] - of_equations(3)),
            in_thousands(all[5] - of_equations(5))
        ),
    ] {
        assert!(text.contains(&sentence), "the page does not say: {sentence}");
    }
}

#[test]
fn every_finding_rests_on_a_claim_or_an_erratum() {
    let section = FINDINGS.split("\n## ").next().unwrap();
    let specifications = Paper::ALL.map(Paper::specification);
    let exists = |id: &str| {
        specifications.iter().any(|specification| {
            let mut equations = specification.equations.iter().chain(&specification.unnumbered);
            specification.claims.iter().any(|claim| claim.id == id)
                || equations.any(|equation| equation.erratum.as_ref().is_some_and(|erratum| erratum.id == id))
        })
    };
    let rows: Vec<&str> = section.lines().filter(|line| line.starts_with("| ")).skip(1).collect();
    assert!((12..=16).contains(&rows.len()), "a short table: {} rows", rows.len());
    for row in rows {
        let ground = row.split('|').nth(3).unwrap();
        let ids: Vec<&str> = ground.split('`').skip(1).step_by(2).collect();
        assert!(!ids.is_empty(), "it rests on nothing: {row}");
        for id in ids {
            assert!(exists(id), "no claim and no erratum: {id}");
        }
    }
}
