//! The command line: reads arguments, calls the library, prints.
//!
//! Exit status: 0 when the command did what was asked, 1 when its output could not be written or what it checked is wrong, 2 when it
//! was asked for something that does not exist.

mod cli;

use clap::{Args, Parser, Subcommand};
use cli::{Done, Refusal, json_text, write_file};
use immaculate::number::Rational;
use immaculate::paper::monte_carlo::Progress;
use immaculate::paper::specification::Choices;
use immaculate::paper::{Effort, Paper};
use immaculate::report;
use immaculate::rule::{RuleName, unscented};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The executable specification of the interacting multiple model filter.
#[derive(Parser)]
#[command(version, about, arg_required_else_help = true)]
#[command(
    after_help = "Exit status: 0 done, 1 output could not be written or something that was checked is wrong, 2 asked for something that does not exist."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Rerun the papers' simulations and set their tables beside the published ones
    Reproduce(Reproduce),
    /// Judge what the papers claim, each claim by computation
    Claims(Claims),
    /// List a cubature rule: points and weights, exact and decimal, with its proven degree
    Rule(Rule),
    /// List the open parameters of the papers' scenarios and their alternatives
    Choices(ListChoices),
    /// Judge a filter in any language: right to so many digits, or wrong in which equation, and why
    Check(cli::check::Check),
    /// Run a problem file and print every value of every step; with --digits, proven
    Trace(cli::trace::Trace),
    /// List, show, copy and prove the certified cases
    Cases(cli::cases::Cases),
    /// List the catalogue of mistakes, conventions and forms that `check` can name
    Variants(cli::variants::Variants),
    /// Prove two fixed-gain filters that exchange estimates stable together, or unstable; map, certificates
    Stability(cli::stability::Stability),
    /// Be a program under test: this crate's own filter, with mistakes planted on demand
    Answer(cli::answer::Answer),
}

#[derive(Args)]
struct Reproduce {
    /// The papers; all when none is given [possible: derbez2000, sustika2015, zhu2016, liu2017]
    papers: Vec<Paper>,
    /// The number of Monte-Carlo runs; the paper's own when not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=1_000_000))]
    runs: Option<u64>,
    /// The seed of the random numbers
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Choose an alternative for an open parameter and run that alone; may be given again (`immaculate choices` lists them)
    #[arg(long = "set", value_name = "PARAMETER=ALTERNATIVE")]
    choices: Vec<String>,
    /// Leave out the runs of every open choice by itself
    #[arg(long)]
    brief: bool,
    /// In place of these runs: scenario 3 of sustika2015, which varies the noise that the filters take for granted; with --out it
    /// goes on from where it was interrupted
    #[arg(long, conflicts_with = "brief")]
    sweep: bool,
    /// Write the results as JSON, and errors and mode probabilities over time as CSV and SVG, to this directory
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON instead of tables
    #[arg(long)]
    json: bool,
}

#[derive(Args)]
struct Claims {
    /// The papers; all when none is given [possible: derbez2000, sustika2015, zhu2016, liu2017]
    papers: Vec<Paper>,
    /// The number of Monte-Carlo runs; the paper's own when not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=1_000_000))]
    runs: Option<u64>,
    /// The seed of the random numbers
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

#[derive(Args)]
struct Rule {
    /// The rule's name: cubature-3, unscented, cubature-5, simplex-5, gauss-hermite-2 to -5, and the printed forms
    /// cubature-5-printed, simplex-5-printed-11, simplex-5-printed-16
    name: String,
    /// The dimension n
    #[arg(long, short = 'n', value_name = "N")]
    dimension: usize,
    /// α of the unscented rule, as a decimal
    #[arg(long, value_name = "DECIMAL", allow_negative_numbers = true)]
    alpha: Option<String>,
    /// β of the unscented rule, as a decimal
    #[arg(long, value_name = "DECIMAL", allow_negative_numbers = true)]
    beta: Option<String>,
    /// κ of the unscented rule, as a decimal; 3 − n when not given
    #[arg(long, value_name = "DECIMAL", allow_negative_numbers = true)]
    kappa: Option<String>,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
}

#[derive(Args)]
struct ListChoices {
    /// The papers; all when none is given [possible: derbez2000, sustika2015, zhu2016, liu2017]
    papers: Vec<Paper>,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let outcome = match &cli.command {
        Command::Reproduce(arguments) => reproduce(arguments).map(Done::from),
        Command::Claims(arguments) => claims(arguments).map(Done::from),
        Command::Rule(arguments) => rule(arguments).map(Done::from),
        Command::Choices(arguments) => Ok(choices(arguments).into()),
        Command::Check(arguments) => cli::check::run(arguments),
        Command::Trace(arguments) => cli::trace::run(arguments),
        Command::Cases(arguments) => cli::cases::run(arguments),
        Command::Variants(arguments) => cli::variants::run(arguments),
        Command::Stability(arguments) => cli::stability::run(arguments),
        Command::Answer(arguments) => cli::answer::run(arguments),
    };
    match outcome.and_then(|done| print(&done.text).map(|()| done.status)) {
        Ok(status) => ExitCode::from(status),
        Err(Refusal::Output(sentence)) => complain(&sentence, 1),
        Err(Refusal::Request(sentence)) => complain(&sentence, 2),
    }
}

fn complain(sentence: &str, status: u8) -> ExitCode {
    // Nothing is left to be done when not even the complaint can be written.
    let _ = writeln!(std::io::stderr(), "immaculate: {sentence}");
    ExitCode::from(status)
}

/// Writes to standard output; a reader that has gone away has read enough.
fn print(text: &str) -> Result<(), Refusal> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Refusal::Output(format!("standard output: {error}")))
        }
        _ => Ok(()),
    }
}

fn papers(given: &[Paper]) -> Vec<Paper> {
    if given.is_empty() {
        Paper::ALL.to_vec()
    } else {
        given.to_vec()
    }
}

fn effort(runs: Option<u64>, seed: u64) -> Effort {
    Effort {
        runs: runs.and_then(|runs| usize::try_from(runs).ok()),
        seed,
    }
}

/// A progress bar on standard error; it shows itself only where a person is watching.
fn progress_bar(length: u64, what: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} runs, {eta} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length).with_style(style).with_message(what)
}

fn reproduce(arguments: &Reproduce) -> Result<String, Refusal> {
    let papers = papers(&arguments.papers);
    let chosen = Choices::parse(&arguments.choices).map_err(Refusal::request)?;
    let effort = effort(arguments.runs, arguments.seed);
    if arguments.sweep {
        return sweep(arguments, &papers, &chosen);
    }
    let mut plan = Vec::new();
    check_that_some_paper_has(&papers, &chosen)?;
    for paper in &papers {
        let chosen = paper.specification().choices_of_this_paper(&chosen);
        for chosen in paper.simulations(&chosen) {
            let simulation = paper.simulation(&chosen).map_err(Refusal::request)?;
            let mut choices = vec![chosen];
            if !arguments.brief && arguments.choices.is_empty() {
                choices.extend(paper.open_choices(&choices[0]));
            }
            plan.push((*paper, choices, effort.runs.unwrap_or_else(|| simulation.runs())));
        }
    }
    if let Some(directory) = &arguments.out {
        std::fs::create_dir_all(directory)
            .map_err(|error| Refusal::Output(format!("{}: {error}", directory.display())))?;
    }
    let total: usize = plan.iter().map(|(_, choices, runs)| choices.len() * runs).sum();
    let bar = progress_bar(total as u64, "reproducing");
    let advance: Progress = &|| bar.inc(1);
    let mut text = String::new();
    let mut values = Vec::new();
    for (paper, choices, _) in plan {
        let reproductions = choices
            .iter()
            .map(|choices| paper.reproduce(choices, effort, advance))
            .collect::<Result<Vec<_>, _>>()
            .map_err(Refusal::request)?;
        let (main, alternatives) = (&reproductions[0], &reproductions[1..]);
        let comparisons = report::reproduction::published_and_computed(paper, main);
        let value = json!({
            "published_and_computed": comparisons,
            "reproduction": main,
            "alternatives": alternatives.iter().map(report::reproduction::errors_of).collect::<Vec<_>>(),
        });
        if let Some(directory) = &arguments.out {
            write_files(directory, main, &value)?;
        }
        values.push(value);
        text.push_str(&report::reproduction::text(paper, main));
        if !alternatives.is_empty() {
            text.push('\n');
            text.push_str(&report::reproduction::alternatives(paper, &reproductions));
        }
        text.push('\n');
    }
    bar.finish_and_clear();
    if arguments.json {
        return Ok(json_text(&json!({ "papers": values })));
    }
    text.push_str("What these figures say of the papers' claims: immaculate claims\n");
    Ok(text)
}

/// Scenario 3 of sustika2015 in the place of the papers' runs.
fn sweep(arguments: &Reproduce, papers: &[Paper], chosen: &Choices) -> Result<String, Refusal> {
    if !arguments.papers.is_empty() && papers != [Paper::Sustika2015] {
        return Err(Refusal::request("sustika2015 alone has a sweep"));
    }
    let effort = effort(arguments.runs, arguments.seed);
    let bar = |length| progress_bar(length, "sweeping");
    cli::sweep::run(chosen, effort, arguments.out.as_deref(), arguments.json, bar)
}

/// A parameter that none of the papers has is a mistake; one that some have is set for these.
fn check_that_some_paper_has(papers: &[Paper], choices: &Choices) -> Result<(), Refusal> {
    for parameter in choices.parameters() {
        let has = |paper: &Paper| paper.specification().parameters.iter().any(|p| p.name == parameter);
        if !papers.iter().any(has) {
            let of_paper = |paper: &Paper| {
                let names: Vec<&str> = paper
                    .specification()
                    .parameters
                    .iter()
                    .map(|p| p.name.as_str())
                    .collect();
                format!("{} has {}", paper.key(), names.join(", "))
            };
            let known: Vec<String> = papers.iter().map(of_paper).collect();
            return Err(Refusal::request(format!(
                "there is no parameter `{parameter}`; {}",
                known.join("; ")
            )));
        }
    }
    Ok(())
}

/// A figure, or why it could not be drawn.
fn figure_of(drawn: Result<String, report::figure::NotDrawn>) -> Result<String, Refusal> {
    drawn.map_err(|error| Refusal::Output(error.to_string()))
}

/// What the names of a reproduction's files begin with: the paper, and the scenario where it has several.
fn file_stem(reproduction: &immaculate::paper::result::Reproduction) -> String {
    match reproduction.choices.chosen("scenario") {
        Some(scenario) => format!("{}-{scenario}", reproduction.paper),
        None => reproduction.paper.to_owned(),
    }
}

/// The files of `reproduce --out`: everything as JSON, errors over time and mode probabilities as CSV and as figures.
fn write_files(
    directory: &Path,
    reproduction: &immaculate::paper::result::Reproduction,
    value: &serde_json::Value,
) -> Result<(), Refusal> {
    let paper = file_stem(reproduction);
    let mut files = vec![
        (format!("{paper}.json"), json_text(value)),
        (
            format!("{paper}-errors.csv"),
            report::reproduction::errors_csv(reproduction),
        ),
        (
            format!("{paper}-mode-probabilities.csv"),
            report::reproduction::mode_probabilities_csv(reproduction),
        ),
        (
            format!("{paper}-errors.svg"),
            figure_of(report::figure::errors(reproduction))?,
        ),
        (
            format!("{paper}-mode-probabilities.svg"),
            figure_of(report::figure::mode_probabilities(reproduction))?,
        ),
    ];
    if let Some(first_run) = &reproduction.first_run {
        files.push((
            format!("{paper}-path.svg"),
            figure_of(report::figure::path(reproduction, first_run))?,
        ));
        files.push((
            format!("{paper}-path.csv"),
            report::reproduction::path_csv(reproduction, first_run),
        ));
    }
    if paper == Paper::Derbez2000.key() {
        let figures = report::long_term::figures_1_and_2(reproduction.seed);
        files.push((format!("{paper}-figures-1-and-2.svg"), figure_of(figures)?));
    }
    for (name, content) in files {
        let path = directory.join(name);
        write_file(&path, &content)?;
    }
    Ok(())
}

fn claims(arguments: &Claims) -> Result<String, Refusal> {
    let effort = effort(arguments.runs, arguments.seed);
    let bar = ProgressBar::new_spinner().with_message("judging");
    bar.set_style(
        ProgressStyle::with_template("{spinner} {msg}: {pos} runs, {elapsed}")
            .unwrap_or_else(|_| ProgressStyle::default_spinner()),
    );
    let advance: Progress = &|| bar.inc(1);
    let mut text = String::new();
    let mut values = Vec::new();
    for paper in papers(&arguments.papers) {
        let judgements = paper.judge(effort, advance).map_err(Refusal::request)?;
        text.push_str(&report::claims::heading(paper.specification()));
        text.push_str(&report::claims::text(&judgements));
        text.push_str(&report::claims::summary(&judgements));
        values.push(json!({ "paper": paper.key(), "claims": judgements }));
    }
    bar.finish_and_clear();
    if arguments.json {
        return Ok(json_text(&json!({ "seed": arguments.seed, "papers": values })));
    }
    Ok(text)
}

fn rule(arguments: &Rule) -> Result<String, Refusal> {
    let mut name: RuleName = arguments.name.parse().map_err(Refusal::request)?;
    let parameters = [&arguments.alpha, &arguments.beta, &arguments.kappa];
    if parameters.iter().any(|parameter| parameter.is_some()) {
        if !matches!(name, RuleName::Unscented(_)) {
            let sentence = "--alpha, --beta and --kappa are parameters of the rule `unscented`";
            return Err(Refusal::request(sentence));
        }
        name = RuleName::Unscented(Some(unscented_parameters(arguments)?));
    }
    let description = report::rule::describe(&name, &arguments.name, arguments.dimension).map_err(Refusal::request)?;
    if arguments.json {
        return Ok(json_text(&json!(description)));
    }
    Ok(report::rule::text(&description))
}

/// The parameters that are given, the others as in Julier and Uhlmann's original form.
fn unscented_parameters(arguments: &Rule) -> Result<unscented::Parameters, Refusal> {
    let mut parameters = unscented::Parameters::for_gaussian(arguments.dimension);
    let given = [
        ("alpha", &arguments.alpha, &mut parameters.alpha),
        ("beta", &arguments.beta, &mut parameters.beta),
        ("kappa", &arguments.kappa, &mut parameters.kappa),
    ];
    for (name, text, parameter) in given {
        if let Some(text) = text {
            *parameter = Rational::from_decimal(text)
                .ok_or_else(|| Refusal::request(format!("--{name}: `{text}` is not a decimal number")))?;
        }
    }
    Ok(parameters)
}

fn choices(arguments: &ListChoices) -> String {
    let papers = papers(&arguments.papers);
    if arguments.json {
        let parameters =
            |paper: &Paper| json!({ "paper": paper.key(), "parameters": paper.specification().parameters });
        let values: Vec<_> = papers.iter().map(parameters).collect();
        return json_text(&json!({ "papers": values }));
    }
    papers
        .iter()
        .map(|paper| report::reproduction::choices(paper.specification()))
        .collect()
}
