//! The commands, one file each: arguments in, text and exit status out. The library does the work.

pub mod answer;
pub mod cases;
pub mod check;
pub mod choices;
pub mod claims;
pub mod compare;
pub mod demonstration;
pub mod equation;
pub mod init;
pub mod outputs;
pub mod progress;
pub mod report;
pub mod reproduce;
pub mod rule;
pub mod search;
pub mod select;
pub mod stability;
mod stability_bank;
pub mod sweep;
pub mod trace;
pub mod variants;

use immaculate::file;
use immaculate::oracle::case;
use immaculate::oracle::problem::ProblemFile;
use immaculate::paper::{self, Effort, Paper};
use std::io::Write;
use std::path::Path;

/// Why a command could not be carried out.
pub enum Refusal {
    /// It was asked for something that does not exist.
    Request(String),
    /// Its output could not be written.
    Output(String),
}

impl Refusal {
    /// A request that cannot be met.
    pub fn request(error: impl std::fmt::Display) -> Self {
        Self::Request(error.to_string())
    }
}

/// The result of a command: its text and its exit status.
pub struct Done {
    /// What is printed.
    pub text: String,
    /// The exit status.
    pub status: u8,
    /// The reason why the command did not finish: it is printed after the text, and the exit status is 1.
    pub complaint: Option<String>,
}

impl From<String> for Done {
    fn from(text: String) -> Self {
        Self {
            text,
            status: 0,
            complaint: None,
        }
    }
}

/// JSON for people and programs.
pub fn json_text(value: &serde_json::Value) -> String {
    format!("{value:#}\n")
}

/// Writes to standard output, and returns whether it is still read. It is no error if the reader has gone away.
pub fn print(text: &str) -> Result<bool, Refusal> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(false),
        Err(error) => Err(Refusal::Output(format!("standard output: {error}"))),
    }
}

/// Writes a file whole or not at all, as [`file::write`] says.
pub fn write_file(path: &Path, content: &str) -> Result<(), Refusal> {
    file::write(path, content).map_err(|error| Refusal::Output(about(path, &error)))
}

/// Creates a directory and its parents where they do not exist.
pub fn make_directory(path: &Path) -> Result<(), Refusal> {
    std::fs::create_dir_all(path).map_err(|error| Refusal::Output(about(path, &error)))
}

/// Reads a text file of bounded size, or standard input for `-`.
pub fn read_file(path: &Path) -> Result<String, Refusal> {
    let text = if path == Path::new("-") {
        file::read_from(std::io::stdin())
    } else {
        file::read(path)
    };
    text.map_err(|error| Refusal::Request(about(path, &error)))
}

/// Reads a problem file, or the published problem of an id where there is no such file; its name in messages, and the problem.
pub fn read_problem(path: &Path) -> Result<(String, ProblemFile), Refusal> {
    let name = path.display().to_string();
    let published = case::all()
        .map_err(Refusal::request)?
        .iter()
        .find(|case| case.problem.id == name)
        .filter(|_| !path.exists());
    let text = match published {
        Some(case) => case.problem_text.to_owned(),
        None => read_file(path)?,
    };
    let problem = ProblemFile::read(&text).map_err(|error| Refusal::Request(format!("{name}: {error}")))?;
    Ok((name, problem))
}

fn about(path: &Path, error: &std::io::Error) -> String {
    format!("{}: {error}", path.display())
}

/// The given papers; all if none is given.
pub fn papers(given: &[Paper]) -> Vec<Paper> {
    if given.is_empty() {
        Paper::ALL.to_vec()
    } else {
        given.to_vec()
    }
}

/// The greatest number of runs as an argument.
pub const MOST_RUNS: u64 = paper::MOST_RUNS as u64;

/// How much is computed.
pub fn effort(runs: Option<u64>, seed: u64) -> Effort {
    Effort {
        runs: runs.and_then(|runs| usize::try_from(runs).ok()),
        seed,
    }
}

/// Refuses more runs than a paper's judges can keep in memory.
pub fn check_that_memory_does(papers: &[Paper], effort: Effort) -> Result<(), Refusal> {
    for paper in papers {
        let most = paper.most_judged_runs();
        if effort.runs.is_some_and(|runs| runs > most) {
            let key = paper.key();
            return Err(Refusal::request(format!(
                "--runs: the judges of {key} keep all runs in memory, at most {most}"
            )));
        }
    }
    Ok(())
}
