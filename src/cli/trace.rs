//! `immaculate trace`: runs a problem file and prints every value of every step.
//!
//! A trace is printed as text, JSON or long CSV, in doubles or in proven digits, or as literals of a language.

use super::{Done, Refusal, json_text, read_problem};
use clap::Args;
use immaculate::oracle::certify::{certified_as_far_as_it_goes, certified_decimals};
use immaculate::oracle::check::{NotMade, convention};
use immaculate::oracle::csv;
use immaculate::oracle::invalid::Invalid;
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::run::{lost_covariance, run_in_doubles};
use immaculate::oracle::trace::{FORMAT, numbers_as_json};
use immaculate::report;
use immaculate::report::literal::{self, Language};
use serde_json::json;
use std::path::PathBuf;

#[derive(Args)]
pub struct TraceArguments {
    /// The problem file (`-` for standard input), or the id of a published case
    file: PathBuf,
    /// Print N certified digits of every value, proven by enclosure, instead of doubles
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    digits: Option<u32>,
    /// Print JSON instead of text
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// Print the long CSV instead of text
    #[arg(long, conflicts_with = "digits")]
    csv: bool,
    /// Print certified doubles as literals of a language, for a unit test
    #[arg(long = "as", value_name = "LANGUAGE", value_enum, conflicts_with_all = ["digits", "json", "csv"])]
    language: Option<Language>,
    /// Follow another convention than the papers, such as `first_step=predicted`; may be repeated
    #[arg(long = "convention", value_name = "KEY=VALUE")]
    conventions: Vec<String>,
}

pub fn run(arguments: &TraceArguments) -> Result<Done, Refusal> {
    let (name, mut problem) = read_problem(&arguments.file)?;
    let wrong = |error: &dyn std::fmt::Display| Refusal::Request(format!("{name}: {error}"));
    problem.declared = declared(&arguments.conventions)?;
    if let Some(language) = arguments.language {
        let (trace, certified) = certified_as_far_as_it_goes(&problem).map_err(|error| wrong(&error))?;
        return Ok(literal::text(&problem.id, &trace, certified, language).into());
    }
    let Some(digits) = arguments.digits else {
        return in_doubles(arguments, &problem).map_err(|error| wrong(&error));
    };
    let (decimals, bits) = certified_decimals(&problem, digits).map_err(|error| wrong(&error))?;
    if arguments.json {
        let steps = decimals.to_json(|place, numbers| numbers_as_json(place, &decimals.dimensions, numbers));
        let value = json!({ "format": FORMAT, "id": problem.id, "digits": digits, "bits": bits, "steps": steps });
        return Ok(json_text(&value).into());
    }
    let text = report::trace::text(&problem, &decimals);
    Ok(format!("{text}{digits} digits of every value, proven with {bits} bits\n").into())
}

/// The variants of conventions that are given as `KEY=VALUE`.
pub(super) fn declared(conventions: &[String]) -> Result<Vec<&'static str>, Refusal> {
    let mut variants = Vec::new();
    for given in conventions {
        let Some((key, value)) = given.split_once('=') else {
            return Err(Refusal::Request(format!(
                "--convention {given}: needs a value, as in --convention first_step=predicted"
            )));
        };
        variants.extend(convention(key, value).map_err(|error| match error {
            NotMade::Convention { known, .. } => {
                Refusal::Request(format!("there is no convention `{key}`: {value:?}; known are {known}"))
            }
            error => Refusal::request(error),
        })?);
    }
    Ok(variants)
}

/// The run in doubles. A run that stops early is shown as far as it came, with the reason as a complaint; so is a run that loses all its
/// digits to rounding.
fn in_doubles(arguments: &TraceArguments, problem: &ProblemFile) -> Result<Done, Invalid> {
    let (values, failure) = run_in_doubles(problem)?;
    let failure = failure.or_else(|| lost_covariance(problem, &values));
    let text = if arguments.csv {
        csv::write(&problem.id, &values, "", |_, _| String::new())
    } else if arguments.json {
        let steps = values.steps_as_json();
        drop(values);
        let mut object = json!({ "format": FORMAT, "id": problem.id, "steps": null, "error": failure });
        object["steps"] = steps.into(); // moved: inside the macro they would be copied
        json_text(&object)
    } else {
        let texts = values.map(|_, numbers| numbers.iter().map(|number| format!("{number:?}")).collect());
        report::trace::text(problem, &texts)
    };
    Ok(Done {
        complaint: failure.map(|failure| format!("{}: {failure}", problem.id)),
        ..text.into()
    })
}
