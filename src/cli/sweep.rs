//! `immaculate reproduce sustika2015 --sweep`: scenario 3 of that paper, 280 settings of what the filters take the noise to be.
//!
//! After this file the reader knows where the journal of a sweep is, from which an interrupted one goes on, and what else is written.

use super::progress::bar;
use super::{Refusal, json_text, make_directory, write_file};
use immaculate::paper::Effort;
use immaculate::paper::specification::Choices;
use immaculate::paper::sustika2015::RUNS;
use immaculate::paper::sustika2015::journal::BadJournal;
use immaculate::paper::sustika2015::sweep::{Point, Setting, Sweep, Trajectory, settings};
use immaculate::report::fit_error;
use serde_json::json;
use std::path::Path;

/// The sweep under some choices, with its files in a directory if there is one; the text, or JSON, of all its points.
pub fn run(choices: &Choices, effort: Effort, directory: Option<&Path>, is_json: bool) -> Result<String, Refusal> {
    let sweep = Sweep::new(choices, effort.runs.unwrap_or(RUNS), effort.seed).map_err(Refusal::request)?;
    let bar = bar(
        settings().len() * sweep.runs,
        "sweeping {wide_bar} {pos}/{len} runs, {eta} left",
    );
    let advance = || bar.inc(1);
    let points = match directory {
        Some(directory) => with_files(&sweep, directory, &advance)?,
        None => sweep.run_without_journal(&advance),
    };
    bar.finish_and_clear();
    Ok(if is_json {
        json_text(&as_json(&sweep, &points))
    } else {
        fit_error::text(&points, sweep.runs)
    })
}

/// The sweep with a journal, and its figures.
fn with_files(sweep: &Sweep, directory: &Path, advance: &(dyn Fn() + Sync)) -> Result<Vec<(Setting, Point)>, Refusal> {
    make_directory(directory)?;
    let journal = directory.join("sustika2015-sweep.csv");
    let points = sweep.run(&journal, advance).map_err(|error| match error {
        BadJournal::File { .. } => Refusal::Output(error.to_string()),
        _ => Refusal::request(error),
    })?;
    for (trajectory, name) in Trajectory::ALL.into_iter().zip(["figure-2", "figure-4"]) {
        let figure = fit_error::draw(&points, trajectory, sweep.runs);
        let figure = figure.map_err(|error| Refusal::Output(error.to_string()))?;
        write_file(&directory.join(format!("sustika2015-{name}.svg")), &figure)?;
    }
    write_file(
        &directory.join("sustika2015-sweep.json"),
        &json_text(&as_json(sweep, &points)),
    )?;
    Ok(points)
}

fn as_json(sweep: &Sweep, points: &[(Setting, Point)]) -> serde_json::Value {
    let points = points
        .iter()
        .map(|(setting, point)| json!({ "setting": setting, "point": point }));
    json!({
        "paper": "sustika2015",
        "seed": sweep.seed,
        "runs": sweep.runs,
        "choices": sweep.choices,
        "points": points.collect::<Vec<_>>(),
    })
}
