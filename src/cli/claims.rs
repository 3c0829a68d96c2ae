//! `immaculate claims`: the papers' claims, each judged by a computation.

use super::progress::bar;
use super::{Done, MOST_RUNS, Refusal, check_that_memory_does, effort, json_text, papers};
use clap::Args;
use immaculate::paper::Paper;
use immaculate::paper::monte_carlo::Progress;
use immaculate::report;
use serde_json::json;

#[derive(Args)]
pub struct ClaimsArguments {
    /// The papers; all when none is given [possible: derbez2000, sustika2015, zhu2016, liu2017]
    papers: Vec<Paper>,
    /// The number of Monte-Carlo runs; when not given the paper's own, and 4000 of sustika2015, whose 50 tell little. At most
    /// 2000 of derbez2000 and of liu2017, 15000 of zhu2016: they are kept in memory
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=MOST_RUNS))]
    runs: Option<u64>,
    /// The seed of the random numbers
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &ClaimsArguments) -> Result<Done, Refusal> {
    let effort = effort(arguments.runs, arguments.seed);
    check_that_memory_does(&papers(&arguments.papers), effort)?;
    let bar = bar(0, "{spinner} judging: {pos} runs, {elapsed}");
    let advance: Progress = &|| bar.inc(1);
    let mut text = report::claims::legend();
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
        return Ok(json_text(
            &json!({ "seed": arguments.seed, "verdicts": report::claims::legend_json(), "papers": values }),
        )
        .into());
    }
    Ok(text.into())
}
