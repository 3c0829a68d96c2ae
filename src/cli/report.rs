//! `immaculate report --out DIR`: everything as a small static site.

use super::progress::style;
use super::{Done, MOST_RUNS, Refusal, check_that_memory_does, effort, make_directory, write_file};
use clap::Args;
use immaculate::paper::Paper;
use immaculate::report::page;
use immaculate::report::page::content::{Content, Extent, Watch};
use indicatif::ProgressBar;
use std::path::PathBuf;

/// Writes a small static site: how filters are checked, the catalogue of mistakes, the cases, the papers' figures, tables, claims and
/// errata, and the book of equations. Open index.html; the site needs no network and no script. With the papers' numbers of runs it
/// takes some minutes.
#[derive(Args)]
pub struct ReportArguments {
    /// The folder to write; it is created if needed
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// The number of Monte Carlo runs for everything; by default the papers' own numbers, and for the claims what their judges need
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=MOST_RUNS))]
    runs: Option<u64>,
    /// The seed of the random numbers
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
}

/// Points along each side of the stability map, as in `immaculate stability --map`.
const MAP_POINTS: usize = 49;

/// Computes the pages and writes them.
pub fn run(arguments: &ReportArguments) -> Result<Done, Refusal> {
    let extent = Extent {
        effort: effort(arguments.runs, arguments.seed),
        map_points: MAP_POINTS,
    };
    check_that_memory_does(&Paper::ALL, extent.effort)?;
    make_directory(&arguments.out)?; // before minutes of computing
    let bar = ProgressBar::new(0);
    let watch = Watch {
        begin: &|step, length| begin(&bar, step, length),
        advance: &|| bar.inc(1),
    };
    let content = Content::compute(extent, &watch).map_err(Refusal::request)?;
    bar.finish_and_clear();
    let pages = page::site(&content).map_err(|error| Refusal::Output(error.to_string()))?;
    for page in &pages {
        write_file(&arguments.out.join(&page.file), &page.html)?;
    }
    let size: usize = pages.iter().map(|page| page.html.len()).sum();
    let first = arguments.out.join(&pages[0].file);
    Ok(format!("{} pages, {} kB; open {}\n", pages.len(), size / 1000, first.display()).into())
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
