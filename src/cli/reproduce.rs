//! `immaculate reproduce`: the papers' simulations beside the published figures, and the files written by `--out`.

use super::progress::bar;
use super::{Done, MOST_RUNS, Refusal, effort, json_text, make_directory, papers, write_file};
use clap::Args;
use immaculate::paper::monte_carlo::Progress;
use immaculate::paper::specification::Choices;
use immaculate::paper::sustika2015::divergence;
use immaculate::paper::{Effort, Paper};
use immaculate::report;
use immaculate::report::reproduction::SideBySide;
use serde_json::json;
use std::path::{Path, PathBuf};

// Each is a switch of the command line.
#[allow(clippy::struct_excessive_bools)]
#[derive(Args)]
pub struct ReproduceArguments {
    /// The papers; all when none is given [possible: derbez2000, sustika2015, zhu2016, liu2017]
    papers: Vec<Paper>,
    /// The number of Monte-Carlo runs, all of which are kept in memory; the paper's own when not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=MOST_RUNS))]
    runs: Option<u64>,
    /// The seed of the random numbers
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Choose an alternative for an open parameter and run that alone; may be given again (`immaculate choices` lists them)
    #[arg(long = "set", value_name = "PARAMETER=ALTERNATIVE")]
    choices: Vec<String>,
    /// Print all: delays, consistency, cost, choices that change no figure, and where converted measurements can be trusted; --json and
    /// --out have it, too
    #[arg(long)]
    full: bool,
    /// Leave out the runs of every open choice by itself
    #[arg(long)]
    brief: bool,
    /// In place of these runs: scenario 3 of sustika2015, which varies the noise that the filters take for granted; with --out it
    /// goes on from where it was interrupted
    #[arg(long, conflicts_with = "brief")]
    sweep: bool,
    /// Write the results as JSON, and errors, mode probabilities and the first run as CSV and SVG, to this directory
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON instead of tables
    #[arg(long)]
    json: bool,
}

/// Reruns the papers' simulations.
pub fn run(arguments: &ReproduceArguments) -> Result<Done, Refusal> {
    let papers = papers(&arguments.papers);
    let chosen = Choices::parse(&arguments.choices).map_err(Refusal::request)?;
    if arguments.sweep {
        return sweep(arguments, &papers, &chosen).map(Done::from);
    }
    check_that_some_paper_has(&papers, &chosen)?;
    let effort = effort(arguments.runs, arguments.seed);
    let plan = plan(arguments, &papers, &chosen)?;
    if let Some(directory) = &arguments.out {
        make_directory(directory)?;
    }
    let asks_for_cause = arguments.choices.is_empty() && papers.contains(&Paper::Sustika2015);
    let runs_for_cause = effort.runs.unwrap_or(divergence::RUNS);
    let mut total: usize = plan.iter().map(|planned| planned.choices.len() * planned.runs).sum();
    if asks_for_cause {
        total += divergence::SIMULATIONS.len() * runs_for_cause;
    }
    let bar = bar(total, "reproducing {wide_bar} {pos}/{len} runs, {eta} left");
    let advance: Progress = &|| bar.inc(1);
    let mut text = String::new();
    let (mut values, mut published) = (Vec::new(), Vec::new());
    for planned in plan {
        let (of_paper, value, comparisons) = one_simulation(arguments, &planned, effort, advance)?;
        values.push(value);
        text.push_str(&of_paper);
        published.push((planned.paper, comparisons));
    }
    if let Some(directory) = &arguments.out {
        write_published(directory, &published)?;
    }
    let mut answer = json!({ "papers": values });
    if asks_for_cause {
        let rows = divergence::rows(runs_for_cause, effort.seed, advance).map_err(Refusal::request)?;
        answer["divergence"] = json!({ "runs": runs_for_cause, "simulations": rows });
        text.push_str(&report::divergence::text(&rows, runs_for_cause));
        text.push('\n');
        let conversions = conversions(arguments.out.as_deref())?;
        if arguments.full {
            text.push_str(&conversions);
            text.push('\n');
        }
    }
    bar.finish_and_clear();
    if arguments.json {
        return Ok(json_text(&answer).into());
    }
    let mut text = report::outcome::opening(&published) + &text;
    text.push_str("What these figures say of the papers' claims: immaculate claims\n");
    Ok(text.into())
}

/// A simulation, and each of its open choices by itself.
struct Planned {
    paper: Paper,
    choices: Vec<Choices>,
    runs: usize,
}

/// What is to be run.
fn plan(arguments: &ReproduceArguments, papers: &[Paper], chosen: &Choices) -> Result<Vec<Planned>, Refusal> {
    let mut plan = Vec::new();
    for &paper in papers {
        let chosen = paper.specification().choices_of_this_paper(chosen);
        for chosen in paper.simulations(&chosen) {
            let simulation = paper.simulation(&chosen).map_err(Refusal::request)?;
            let runs = effort(arguments.runs, arguments.seed).runs;
            let mut choices = vec![chosen];
            if !arguments.brief && arguments.choices.is_empty() {
                choices.extend(paper.open_choices(&choices[0]));
            }
            plan.push(Planned {
                paper,
                choices,
                runs: runs.unwrap_or_else(|| simulation.runs()),
            });
        }
    }
    Ok(plan)
}

/// Runs a simulation with its open choices: the text, the same as JSON, and the published figures beside the computed ones.
fn one_simulation(
    arguments: &ReproduceArguments,
    planned: &Planned,
    effort: Effort,
    advance: Progress,
) -> Result<(String, serde_json::Value, Vec<SideBySide>), Refusal> {
    let paper = planned.paper;
    let reproductions = planned
        .choices
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
    let mut text = report::reproduction::text(paper, main, arguments.full);
    if !alternatives.is_empty() {
        text.push('\n');
        text.push_str(&report::reproduction::alternatives(
            paper,
            &reproductions,
            arguments.full,
        ));
    }
    text.push('\n');
    Ok((text, value, comparisons))
}

/// The published figures of each paper beside the computed ones of all its simulations, as figures.
fn write_published(directory: &Path, published: &[(Paper, Vec<SideBySide>)]) -> Result<(), Refusal> {
    for of_paper in published.chunk_by(|a, b| a.0 == b.0) {
        let paper = of_paper[0].0;
        let comparisons: Vec<SideBySide> = of_paper.iter().flat_map(|(_, of_one)| of_one.clone()).collect();
        if let Some(figure) = report::published::published_and_computed(paper, &comparisons) {
            let name = format!("{}-published.svg", paper.key());
            write_file(&directory.join(name), &figure_of(figure)?)?;
        }
    }
    Ok(())
}

/// Where converted measurements can be trusted, as a table and, in a directory, as a figure.
fn conversions(directory: Option<&Path>) -> Result<String, Refusal> {
    if let Some(directory) = directory {
        let figure = figure_of(report::conversion::figure())?;
        write_file(&directory.join("sustika2015-conversions.svg"), &figure)?;
    }
    Ok(report::conversion::table())
}

/// Scenario 3 of sustika2015 instead of the papers' runs.
fn sweep(arguments: &ReproduceArguments, papers: &[Paper], chosen: &Choices) -> Result<String, Refusal> {
    if !arguments.papers.is_empty() && papers != [Paper::Sustika2015] {
        return Err(Refusal::request("sustika2015 alone has a sweep"));
    }
    let effort = effort(arguments.runs, arguments.seed);
    super::sweep::run(chosen, effort, arguments.out.as_deref(), arguments.json)
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
fn figure_of(drawn: Result<String, report::chart::NotDrawn>) -> Result<String, Refusal> {
    drawn.map_err(|error| Refusal::Output(error.to_string()))
}

/// The files of `reproduce --out`: everything as JSON, errors over time and mode probabilities as CSV and as figures.
fn write_files(
    directory: &Path,
    reproduction: &immaculate::paper::result::Reproduction,
    value: &serde_json::Value,
) -> Result<(), Refusal> {
    let paper = report::figure::stem(reproduction);
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
            figure_of(report::path::path(reproduction, first_run))?,
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
