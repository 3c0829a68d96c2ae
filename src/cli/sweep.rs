//! `immaculate reproduce sustika2015 --sweep`: scenario 3 of that paper, with 280 settings of the noise that the filters assume.
//!
//! A sweep writes its points as CSV and as JSON, and two figures.

use super::progress::bar;
use super::{Refusal, json_text, make_directory, write_file};
use immaculate::paper::Effort;
use immaculate::paper::specification::Choices;
use immaculate::paper::sustika2015::RUNS;
use immaculate::paper::sustika2015::sweep::{Sweep, SweepPoint, SweepSetting, SweptTrajectory, settings};
use immaculate::report::fit_error;
use serde_json::json;
use std::path::Path;

/// The sweep under some choices: the text or JSON of all its points, with files if there is a directory.
pub fn run(choices: &Choices, effort: Effort, directory: Option<&Path>, is_json: bool) -> Result<String, Refusal> {
    let sweep = Sweep::new(choices, effort.runs.unwrap_or(RUNS), effort.seed).map_err(Refusal::request)?;
    let bar = bar(
        settings().len() * sweep.runs,
        "sweeping {wide_bar} {pos}/{len} runs, {eta} left",
    );
    let advance = || bar.inc(1);
    // A directory that cannot be written to is refused before the runs, not after them.
    directory.map_or(Ok(()), make_directory)?;
    let points = sweep.run(&advance);
    bar.finish_and_clear();
    if let Some(directory) = directory {
        write_files(&sweep, &points, directory)?;
    }
    Ok(if is_json {
        json_text(&as_json(&sweep, &points))
    } else {
        fit_error::text(&points, sweep.runs)
    })
}

/// The points as a table, the figures, and the points as JSON.
fn write_files(sweep: &Sweep, points: &[(SweepSetting, SweepPoint)], directory: &Path) -> Result<(), Refusal> {
    write_file(&directory.join("sustika2015-sweep.csv"), &sweep.csv(points))?;
    for (trajectory, name) in SweptTrajectory::ALL.into_iter().zip(["figure-2", "figure-4"]) {
        let figure = fit_error::draw(points, trajectory, sweep.runs);
        let figure = figure.map_err(|error| Refusal::Output(error.to_string()))?;
        write_file(&directory.join(format!("sustika2015-{name}.svg")), &figure)?;
    }
    write_file(
        &directory.join("sustika2015-sweep.json"),
        &json_text(&as_json(sweep, points)),
    )
}

fn as_json(sweep: &Sweep, points: &[(SweepSetting, SweepPoint)]) -> serde_json::Value {
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
