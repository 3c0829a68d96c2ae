//! `immaculate equation`: the book of equations, one equation at a time.

use super::{Done, Refusal, json_text};
use clap::Args;
use immaculate::book::{Entry, entries, find::find};
use immaculate::report;
use serde_json::json;

#[derive(Args)]
pub struct EquationArguments {
    /// A paper's key and a number or name (`zhu2016 56`), or the name of a value (`mixed.covariance`) or function (`mixture_covariance`);
    /// a paper alone lists its equations, and nothing lists all
    #[arg(value_name = "ID")]
    name: Vec<String>,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &EquationArguments) -> Result<Done, Refusal> {
    let name = arguments.name.join(" ");
    let found: Vec<&Entry> = if name.trim().is_empty() {
        entries().iter().collect()
    } else {
        find(&name).map_err(Refusal::request)?
    };
    Ok(match (found.as_slice(), arguments.json) {
        ([one], true) => json_text(&report::equation::json(one)),
        ([one], false) => report::equation::in_full(one),
        (all, true) => {
            let equations: Vec<_> = all.iter().map(|entry| report::equation::json(entry)).collect();
            json_text(&json!({ "equations": equations }))
        }
        (all, false) => report::equation::table_of(all),
    }
    .into())
}
