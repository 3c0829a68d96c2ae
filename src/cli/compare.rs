//! `immaculate compare`: which filter to use for a problem, by simulation of its own model.

use super::progress::bar;
use super::{Done, MOST_RUNS, Refusal, json_text, make_directory, read_problem, write_file};
use clap::Args;
use immaculate::compare::standing::FilterComparison;
use immaculate::compare::{Contest, Sample};
use immaculate::report::{comparison, comparison_figure};
use serde_json::json;
use std::path::{Path, PathBuf};

#[derive(Args)]
#[command(
    after_help = "The truth is drawn from the file's own model: the initial state from the initial estimates, the modes from the chain, motion and measurements with their noises. The steps, their lengths, sensors and changes are those of the file; what it measured is replaced. The answer is about the model: if the target moves otherwise, another filter may be better."
)]
pub struct CompareArguments {
    /// The problem file (`-` for standard input), or the id of a published case
    file: PathBuf,
    /// The number of runs; by default a number that takes some seconds, at most 1000
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=MOST_RUNS))]
    runs: Option<u64>,
    /// The seed of the random numbers
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// The number of steps; if the file has fewer, they begin again with its first
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u64).range(1..=MOST_STEPS))]
    steps: Option<u64>,
    /// Write the results as JSON, and the errors over the steps as SVG, to this directory
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

/// The most steps that can be asked for.
const MOST_STEPS: u64 = 1_000_000;

pub fn run(arguments: &CompareArguments) -> Result<Done, Refusal> {
    let (name, problem) = read_problem(&arguments.file)?;
    let size = |number: Option<u64>| number.and_then(|number| usize::try_from(number).ok());
    let sample = Sample {
        runs: size(arguments.runs),
        seed: arguments.seed,
        steps: size(arguments.steps),
    };
    let wrong = |error| Refusal::Request(comparison::refusal(&name, &error));
    let contest = Contest::new(&problem, sample).map_err(wrong)?;
    // A directory that cannot be written to is refused before the runs, not after them.
    arguments.out.as_deref().map_or(Ok(()), make_directory)?;
    let bar = bar(contest.count(), "comparing {wide_bar} {pos}/{len} runs, {eta} left");
    let result = contest.run(&|| bar.inc(1));
    bar.finish_and_clear();
    if let Some(directory) = &arguments.out {
        write_files(&result, directory)?;
    }
    Ok(if arguments.json {
        json_text(&json!(result)).into()
    } else {
        comparison::text(&result).into()
    })
}

/// The results as JSON, and a figure of each table.
fn write_files(result: &FilterComparison, directory: &Path) -> Result<(), Refusal> {
    for table in &result.tables {
        let figure = comparison_figure::draw(result, table).map_err(|error| Refusal::Output(error.to_string()))?;
        let name = format!("comparison-{}s.svg", comparison_figure::what(table));
        write_file(&directory.join(name), &figure)?;
    }
    write_file(&directory.join("comparison.json"), &json_text(&json!(result)))
}
