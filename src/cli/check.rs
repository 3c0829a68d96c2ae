//! `immaculate check`: judges a program under test.
//!
//! The arguments of a check, and its exit status.

use super::outputs::Outputs;
use super::progress::bar;
use super::search::{self, About, SearchArguments};
use super::select::Select;
use super::{Done, Refusal, demonstration, json_text, read_file};
use clap::Args;
use immaculate::oracle::check::{check, check_problems};
use immaculate::oracle::folder::Folder;
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::process::Process;
use immaculate::oracle::subject::Subject;
use immaculate::report;
use std::path::{Path, PathBuf};
use std::time::Duration;

#[derive(Args)]
#[command(
    after_help = "Exit status: 0 all that was judged is right, 1 something is wrong (with --strict: or was not judged), 2 the check could not be made or nothing was judged. Of a search: 0 nothing was found, 1 something was, 2 nothing could be judged.\n\n\
    `immaculate init` writes a small adapter to begin with. The protocol and the file formats are in spec/formats.md; examples in several languages are in tests/adapters."
)]
pub struct CheckArguments {
    /// The program under test and its arguments; it is started once and exchanges JSON lines
    #[arg(last = true, value_name = "COMMAND")]
    command: Vec<String>,
    /// Judge answer files instead of a program: ID.json or ID.csv for each case, in this folder
    #[arg(long, value_name = "DIR", conflicts_with = "command")]
    answers: Option<PathBuf>,
    /// Use your own problem instead of the published cases: a file, or a folder of `*.json` files; may be repeated
    #[arg(long = "problem", value_name = "FILE", conflicts_with_all = ["cases", "flags", "kinds"])]
    problems: Vec<PathBuf>,
    #[command(flatten)]
    select: Select,
    /// The time limit for each case, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..=3600))]
    timeout: u64,
    /// Also end with status 1 if some situation was not judged
    #[arg(long, conflicts_with = "problems")]
    strict: bool,
    #[command(flatten)]
    search: SearchArguments,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    outputs: Outputs,
}

impl CheckArguments {
    /// Whether only the demonstration is asked for.
    fn is_bare(&self) -> bool {
        let has_subject = self.answers.is_some() || !self.command.is_empty();
        let is_about_something = !self.problems.is_empty() || self.search.time().is_some() || !self.select.is_empty();
        !(has_subject || is_about_something || self.strict || self.json) && self.outputs.is_empty()
    }
}

pub fn run(arguments: &CheckArguments) -> Result<Done, Refusal> {
    arguments.outputs.check()?;
    if arguments.is_bare() {
        return Ok(demonstration::text()?.into());
    }
    let mut subject: Box<dyn Subject> = match &arguments.answers {
        Some(path) => Box::new(Folder { path: path.clone() }),
        None if arguments.command.is_empty() => {
            return Err(Refusal::request(
                "nothing to check: give the command of your program after `--`, or a folder of answers with --answers",
            ));
        }
        None => Box::new(Process::new(
            arguments.command.clone(),
            Duration::from_secs(arguments.timeout),
        )),
    };
    let problems = own_problems(&arguments.problems)?;
    if let Some(time) = arguments.search.time() {
        let about = About {
            time,
            kinds: arguments.select.selection().kinds,
            problems,
            command: arguments.command.clone(),
            is_json: arguments.json,
        };
        return search::run(&arguments.search, about, subject.as_mut());
    }
    let selected = if arguments.problems.is_empty() {
        arguments.select.cases()?.len()
    } else {
        problems.len()
    };
    let bar = bar(selected, "checking {wide_bar} {pos}/{len} {msg}");
    let progress = |id: &str| {
        bar.set_message(id.to_owned());
        bar.inc(1);
    };
    let report = if arguments.problems.is_empty() {
        check(subject.as_mut(), &arguments.select.selection(), &progress)
    } else {
        check_problems(subject.as_mut(), &problems, &progress)
    };
    let report = report.map_err(Refusal::request)?;
    bar.finish_and_clear();
    arguments.outputs.write(&report)?;
    let text = if arguments.json {
        json_text(&report::check_json::json(&report))
    } else {
        report::check::text(&report)
    };
    let status = match (report.is_wrong(), report.is_empty()) {
        (true, _) => 1,
        (false, true) => 2,
        (false, false) => u8::from(arguments.strict && !report.is_complete()),
    };
    Ok(Done { status, ..text.into() })
}

/// The problems of files and of folders, the files of a folder in the order of their names.
fn own_problems(paths: &[PathBuf]) -> Result<Vec<ProblemFile>, Refusal> {
    let mut problems = Vec::new();
    for path in paths {
        for file in files_of(path)? {
            let problem = ProblemFile::read(&read_file(&file)?);
            problems.push(problem.map_err(|invalid| Refusal::Request(format!("{}: {invalid}", file.display())))?);
        }
    }
    Ok(problems)
}

/// A file itself, or the `*.json` files of a folder; a folder without any is an error.
fn files_of(path: &Path) -> Result<Vec<PathBuf>, Refusal> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let cannot = |reason: &dyn std::fmt::Display| Refusal::Request(format!("{}: {reason}", path.display()));
    let mut files = Vec::new();
    for entry in path.read_dir().map_err(|error| cannot(&error))? {
        let file = entry.map_err(|error| cannot(&error))?.path();
        if file.extension().is_some_and(|extension| extension == "json") {
            files.push(file);
        }
    }
    files.sort();
    if files.is_empty() {
        return Err(cannot(&"has no problem file, `*.json`"));
    }
    Ok(files)
}
