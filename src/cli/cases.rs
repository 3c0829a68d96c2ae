//! `immaculate cases`: the published cases.
//!
//! After this file the reader knows how cases are listed, copied and proven again, and that only `cases write` writes them and never
//! changes one.

use super::progress::bar;
use super::select::Select;
use super::{Done, Refusal, json_text, make_directory, read_file, write_file};
use clap::{Args, Subcommand, ValueEnum};
use immaculate::oracle::case::{self, Expected, LOCK, Lock, Locked};
use immaculate::oracle::certify::{certify, long_csv};
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::published;
use immaculate::oracle::schema;
use immaculate::oracle::trace::Dimensions;
use immaculate::report;
use rayon::prelude::*;
use serde_json::json;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct Cases {
    #[command(subcommand)]
    action: Action,
}

#[derive(Subcommand)]
enum Action {
    /// List the cases with what each is for
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
        /// The folder; it is made if it is not there
        folder: PathBuf,
        #[command(flatten)]
        select: Select,
    },
    /// Prove every number of the cases again, from nothing but the problems
    Verify {
        #[command(flatten)]
        select: Select,
        /// Print JSON instead of text
        #[arg(long)]
        json: bool,
    },
    /// Print the JSON Schema of problem, trace or certificate files
    Schema {
        /// Which
        #[arg(value_enum)]
        of: Format,
    },
    /// Certify and write the cases that are not published yet (for maintainers)
    Write {
        /// The folder of the cases in the source tree
        #[arg(long, value_name = "DIR", default_value = "fixtures/cases")]
        folder: PathBuf,
    },
}

/// A file format.
#[derive(Clone, Copy, ValueEnum)]
enum Format {
    Problem,
    Trace,
    Certificate,
}

pub fn run(arguments: &Cases) -> Result<Done, Refusal> {
    match &arguments.action {
        Action::List { select, json } => list(select, *json),
        Action::Show { id, json } => show(id, *json),
        Action::Copy { folder, select } => copy(folder, select),
        Action::Verify { select, json } => verify(select, *json),
        Action::Schema { of: Format::Problem } => Ok(json_text(&schema::of_problems()).into()),
        Action::Schema { of: Format::Trace } => Ok(json_text(&schema::of_traces()).into()),
        Action::Schema {
            of: Format::Certificate,
        } => Ok(json_text(&schema::of_certificates()).into()),
        Action::Write { folder } => write(folder),
    }
}

fn list(select: &Select, as_json: bool) -> Result<Done, Refusal> {
    let cases = select.cases()?;
    if as_json {
        let values: Vec<_> = cases
            .iter()
            .map(|case| {
                let problem = &case.problem;
                let Dimensions { n, m, r, steps } = problem.dimensions();
                json!({
                    "id": problem.id, "about": problem.about, "flags": problem.flags, "filter": problem.filter,
                    "n": n, "m": m, "modes": r, "steps": steps,
                    "rejected": match case.expected { Expected::Rejection(class) => Some(class.name()), Expected::Trace(_) => None },
                })
            })
            .collect();
        return Ok(json_text(&json!({ "cases": values, "flags": published::FLAGS.to_vec() })).into());
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

fn copy(folder: &Path, select: &Select) -> Result<Done, Refusal> {
    let cases = select.cases()?;
    make_directory(folder)?;
    let mut files = 0;
    for case in &cases {
        let id = &case.problem.id;
        write_file(&folder.join(case::problem_name(id)), case.problem_text)?;
        write_file(&folder.join(case::trace_name(id)), case.trace_text)?;
        files += 2;
        if let Expected::Trace(trace) = &case.expected {
            write_file(
                &folder.join(format!("{id}.trace.csv")),
                &long_csv(&case.problem, trace, case.trace_text),
            )?;
            files += 1;
        }
    }
    let text = format!("{} cases, {files} files written to {}\n", cases.len(), folder.display());
    Ok(text.into())
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
        text,
        status: u8::from(is_wrong),
    })
}

/// A case that is to be written: its id, and its two files.
type Written = (String, String, String);

fn write(folder: &Path) -> Result<Done, Refusal> {
    let path = folder.join(LOCK);
    let text = read_file(&path)?;
    let mut lock = Lock::read(&text).map_err(|error| Refusal::request(format!("{}: {error}", path.display())))?;
    let problems = published::all();
    for problem in problems
        .iter()
        .chain(published::rejected().iter().map(|(problem, ..)| problem))
    {
        check_unchanged(problem, &lock)?;
    }
    let is_new = |id: &str| !lock.cases.iter().any(|locked| locked.id == id);
    let new: Vec<&ProblemFile> = problems.iter().filter(|problem| is_new(&problem.id)).collect();
    let bar = bar(new.len(), "certifying {wide_bar} {pos}/{len} cases, {elapsed}");
    let written: Result<Vec<Written>, Refusal> = new
        .par_iter()
        .map(|problem| {
            let certified = certify(problem).map_err(|error| Refusal::request(format!("{}: {error}", problem.id)))?;
            bar.inc(1);
            let id = problem.id.clone();
            Ok((
                id.clone(),
                case::problem_text(problem),
                case::trace_text(&id, &certified),
            ))
        })
        .collect();
    bar.finish_and_clear();
    let mut written = written?;
    for (problem, class, reason) in published::rejected() {
        if is_new(&problem.id) {
            let id = problem.id.clone();
            written.push((
                id.clone(),
                case::problem_text(&problem),
                case::rejection_text(&id, class, reason),
            ));
        }
    }
    for (id, problem, trace) in &written {
        write_file(&folder.join(case::problem_name(id)), problem)?;
        write_file(&folder.join(case::trace_name(id)), trace)?;
        lock.cases.push(Locked {
            id: id.clone(),
            problem: case::digest(problem),
            trace: case::digest(trace),
            withdrawn: None,
        });
    }
    write_file(&path, &json_text(&json!(lock)))?;
    Ok(format!(
        "{} cases written to {}, {} were there\n",
        written.len(),
        folder.display(),
        lock.cases.len() - written.len()
    )
    .into())
}

/// A published problem must be what it was.
fn check_unchanged(problem: &ProblemFile, lock: &Lock) -> Result<(), Refusal> {
    let Some(locked) = lock.cases.iter().find(|locked| locked.id == problem.id) else {
        return Ok(());
    };
    if locked.withdrawn.is_none() && locked.problem == case::digest(&case::problem_text(problem)) {
        return Ok(());
    }
    Err(Refusal::request(format!(
        "`{}` is published and was changed or withdrawn; a published case stays as it is: give the new one another id",
        problem.id
    )))
}
