//! `immaculate variants`: the catalogue of mistakes, conventions and forms.

use super::{Done, Refusal, json_text};
use clap::Args;
use immaculate::oracle::variant::{catalogue, find};
use immaculate::report;
use serde_json::json;

#[derive(Args)]
pub struct VariantsArguments {
    /// The variant to show in full; without it, a table of all
    id: Option<String>,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &VariantsArguments) -> Result<Done, Refusal> {
    let Some(id) = &arguments.id else {
        if arguments.json {
            return Ok(json_text(
                &json!({ "variants": catalogue().iter().map(report::variants::json).collect::<Vec<_>>() }),
            )
            .into());
        }
        return Ok(report::variants::table_of(catalogue()).into());
    };
    let variant = find(id)
        .ok_or_else(|| Refusal::request(format!("there is no variant `{id}`; `immaculate variants` lists them")))?;
    if arguments.json {
        return Ok(json_text(&report::variants::json(variant)).into());
    }
    Ok(report::variants::in_full(variant).into())
}
