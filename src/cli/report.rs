//! `immaculate report --out FILE`: everything on one page.
//!
//! After this file the reader knows how the page is asked for, and what is shown while it is computed.

use super::progress::style;
use super::{Done, MOST_RUNS, Refusal, check_that_memory_does, effort, write_file};
use clap::Args;
use immaculate::paper::Paper;
use immaculate::report::page;
use immaculate::report::page::content::{Content, Extent, Watch};
use indicatif::ProgressBar;
use std::path::{Path, PathBuf};

/// Writes one HTML page: the papers' figures and tables, their claims with verdict and evidence, their errata, and the book of equations.
/// It needs no network to be read. With the papers' numbers of runs it takes some minutes.
#[derive(Args)]
pub struct ReportArguments {
    /// The file that is written
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// The number of Monte-Carlo runs of everything; when not given the papers' own, and what the judges of claims ask for
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=MOST_RUNS))]
    runs: Option<u64>,
    /// The seed of the random numbers
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
}

/// Points a side of the stability map, as `immaculate stability --map` has them.
const MAP_POINTS: usize = 49;

/// Computes the page and writes it.
pub fn run(arguments: &ReportArguments) -> Result<Done, Refusal> {
    let extent = Extent {
        effort: effort(arguments.runs, arguments.seed),
        map_points: MAP_POINTS,
    };
    check_that_memory_does(&Paper::ALL, extent.effort)?;
    check_that_a_file_can_be_there(&arguments.out)?;
    let bar = ProgressBar::new(0);
    let watch = Watch {
        begin: &|step, length| begin(&bar, step, length),
        advance: &|| bar.inc(1),
    };
    let content = Content::compute(extent, &watch).map_err(Refusal::request)?;
    bar.finish_and_clear();
    let page = page::html(&content).map_err(|error| Refusal::Output(error.to_string()))?;
    write_file(&arguments.out, &page)?;
    Ok(format!("{}: {} kB\n", arguments.out.display(), page.len() / 1000).into())
}

/// Minutes of computing should not end with a directory that is missing.
fn check_that_a_file_can_be_there(path: &Path) -> Result<(), Refusal> {
    let directory = path.parent().filter(|directory| *directory != Path::new(""));
    let wrong = if path.is_dir() {
        "is a directory, not a file"
    } else if directory.is_some_and(|directory| !directory.is_dir()) {
        "its directory does not exist"
    } else {
        return Ok(());
    };
    Err(Refusal::Output(format!("{}: {wrong}", path.display())))
}

/// A new step, and its length where that is known before.
fn begin(bar: &ProgressBar, step: String, length: Option<usize>) {
    let template = match length {
        Some(_) => "{msg} {wide_bar} {pos}/{len}, {eta} left",
        None => "{spinner} {msg}: {pos} runs, {elapsed}",
    };
    bar.set_style(style(template));
    bar.reset();
    bar.set_length(length.unwrap_or(0) as u64);
    bar.set_message(step);
}
