//! `immaculate choices`: what the papers leave open, and the alternatives by name.
//!
//! `reproduce --set` takes these names.

use super::{Done, json_text, papers};
use clap::Args;
use immaculate::paper::Paper;
use immaculate::report;
use serde_json::json;

#[derive(Args)]
pub struct ChoicesArguments {
    /// The papers; all by default [possible: derbez2000, sustika2015, zhu2016, liu2017]
    papers: Vec<Paper>,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &ChoicesArguments) -> Done {
    let papers = papers(&arguments.papers);
    if arguments.json {
        let parameters =
            |paper: &Paper| json!({ "paper": paper.key(), "parameters": paper.specification().parameters });
        let values: Vec<_> = papers.iter().map(parameters).collect();
        return json_text(&json!({ "papers": values })).into();
    }
    let texts = papers
        .iter()
        .map(|paper| report::reproduction::choices(paper.specification()));
    texts.collect::<String>().into()
}
