//! `immaculate cases`: the published cases.
//!
//! Cases are listed, shown, copied and proven again.

use super::progress::bar;
use super::select::Select;
use super::trace::declared;
use super::{Done, Refusal, json_text, make_directory, write_file};
use clap::{Args, Subcommand, ValueEnum};
use immaculate::oracle::case::{self, Case, Expected};
use immaculate::oracle::certify::{certify, long_csv};
use immaculate::oracle::flags::FLAGS;
use immaculate::oracle::schema;
use immaculate::oracle::trace::Dimensions;
use immaculate::report;
use rayon::prelude::*;
use serde_json::json;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct CasesArguments {
    #[command(subcommand)]
    action: Action,
}

#[derive(Subcommand)]
enum Action {
    /// List the cases and the purpose of each
    List {
        #[command(flatten)]
        select: Select,
        /// Print JSON instead of text
        #[arg(long)]
        json: bool,
    },
    /// Print a case: its problem and its certified trace
    Show {
        /// The id
        id: String,
        /// Print the two files as one JSON object
        #[arg(long)]
        json: bool,
    },
    /// Copy the cases to a folder: problems and traces as JSON, traces as long CSV
    Copy {
        /// The folder; it is created if needed
        folder: PathBuf,
        #[command(flatten)]
        select: Select,
        /// Certify the traces anew with another convention than the papers, such as `first_step=predicted`; may be repeated
        #[arg(long = "convention", value_name = "KEY=VALUE")]
        conventions: Vec<String>,
    },
    /// Prove every number of the cases again, from the problems alone
    Verify {
        #[command(flatten)]
        select: Select,
        /// Print JSON instead of text
        #[arg(long)]
        json: bool,
    },
    /// Print the JSON Schema of problem, trace or certificate files
    Schema {
        /// The format
        #[arg(value_enum)]
        of: Format,
    },
}

/// A file format.
#[derive(Clone, Copy, ValueEnum)]
enum Format {
    Problem,
    Trace,
    Certificate,
}

pub fn run(arguments: &CasesArguments) -> Result<Done, Refusal> {
    match &arguments.action {
        Action::List { select, json } => list(select, *json),
        Action::Show { id, json } => show(id, *json),
        Action::Copy {
            folder,
            select,
            conventions,
        } => copy(folder, select, conventions),
        Action::Verify { select, json } => verify(select, *json),
        Action::Schema { of: Format::Problem } => Ok(json_text(&schema::of_problems()).into()),
        Action::Schema { of: Format::Trace } => Ok(json_text(&schema::of_traces()).into()),
        Action::Schema {
            of: Format::Certificate,
        } => Ok(json_text(&immaculate::steady::certificate_file::schema()).into()),
    }
}

fn list(select: &Select, as_json: bool) -> Result<Done, Refusal> {
    let cases = select.cases()?;
    if as_json {
        let values: Vec<_> = cases
            .iter()
            .map(|case| {
                let problem = &case.problem;
                let Dimensions { n, r, m } = problem.dimensions();
                let (steps, m) = (m.len(), problem.noise.len());
                json!({
                    "id": problem.id, "about": problem.about, "flags": problem.flags, "filter": problem.filter,
                    "n": n, "m": m, "modes": r, "steps": steps,
                    "rejected": match case.expected { Expected::Rejection(class) => Some(class.name()), Expected::Trace(_) => None },
                })
            })
            .collect();
        return Ok(json_text(&json!({ "cases": values, "flags": FLAGS.to_vec() })).into());
    }
    Ok(report::cases::list(&cases).into())
}

fn show(id: &str, as_json: bool) -> Result<Done, Refusal> {
    let all = case::all().map_err(Refusal::request)?;
    let case = all
        .iter()
        .find(|case| case.problem.id == id)
        .ok_or_else(|| Refusal::request(format!("there is no case `{id}`; `immaculate cases list` lists them")))?;
    if as_json {
        return Ok(format!(
            "{{\"problem\":{},\"trace\":{}}}\n",
            case.problem_text.trim_end(),
            case.trace_text.trim_end()
        )
        .into());
    }
    Ok(report::cases::show(case).into())
}

fn copy(folder: &Path, select: &Select, conventions: &[String]) -> Result<Done, Refusal> {
    let cases = select.cases()?;
    let declared = declared(conventions)?;
    make_directory(folder)?;
    let bar = bar(cases.len(), "copying {wide_bar} {pos}/{len} cases, {eta} left");
    let copies: Vec<_> = cases
        .par_iter()
        .map(|case| {
            let copied = copy_of(case, &declared);
            bar.inc(1);
            (&case.problem.id, copied)
        })
        .collect();
    bar.finish_and_clear();
    let (mut written, mut files, mut left_out) = (0, 0, String::new());
    for (id, copied) in copies {
        match copied {
            Ok(copied) => {
                for (name, text) in &copied {
                    write_file(&folder.join(name), text)?;
                }
                written += 1;
                files += copied.len();
            }
            Err(reason) => writeln!(left_out, "left out: {id}: {reason}").unwrap_or_default(),
        }
    }
    if !conventions.is_empty() {
        let chosen: BTreeMap<_, _> = conventions.iter().filter_map(|given| given.split_once('=')).collect();
        write_file(&folder.join("conventions.json"), &json_text(&json!(chosen)))?;
        files += 1;
    }
    let text = format!("{written} cases, {files} files written to {}\n", folder.display());
    Ok(format!("{left_out}{text}").into())
}

/// The files of a case by name: as published, or with the trace of other conventions.
///
/// # Errors
///
/// The reason why this case has no certified trace with these conventions.
fn copy_of(case: &Case, declared: &[&'static str]) -> Result<Vec<(String, String)>, String> {
    let id = &case.problem.id;
    let (trace, trace_text) = match &case.expected {
        Expected::Trace(_) if !declared.is_empty() => {
            let mut problem = case.problem.clone();
            problem.declared = declared.to_vec();
            let certified = certify(&problem).map_err(|error| error.to_string())?;
            let text = case::trace_text(id, &certified);
            (Some(certified.trace), text)
        }
        Expected::Trace(trace) => (Some(trace.clone()), case.trace_text.to_owned()),
        Expected::Rejection(_) => (None, case.trace_text.to_owned()),
    };
    let csv = trace.map(|trace| {
        let text = long_csv(&case.problem, &trace, &trace_text);
        (format!("{id}.trace.csv"), text)
    });
    let problem = (case::problem_name(id), case.problem_text.to_owned());
    Ok([problem, (case::trace_name(id), trace_text)]
        .into_iter()
        .chain(csv)
        .collect())
}

fn verify(select: &Select, as_json: bool) -> Result<Done, Refusal> {
    let cases = select.cases()?;
    let bar = bar(cases.len(), "verifying {wide_bar} {pos}/{len} cases, {elapsed}");
    let outcomes: Vec<_> = cases
        .par_iter()
        .map(|case| {
            let start = std::time::Instant::now();
            let outcome = case.verify();
            bar.inc(1);
            (case, outcome, start.elapsed())
        })
        .collect();
    bar.finish_and_clear();
    let is_wrong = outcomes.iter().any(|(_, outcome, _)| outcome.is_err());
    let text = if as_json {
        json_text(&report::cases::verified_json(&outcomes))
    } else {
        report::cases::verified(&outcomes)
    };
    Ok(Done {
        status: u8::from(is_wrong),
        ..text.into()
    })
}
