//! The commands, one file each: arguments in, text and exit status out.
//!
//! After this folder the reader knows how each command calls the library, and that files are written whole or not at all.

pub mod answer;
pub mod cases;
pub mod check;
pub mod equation;
pub mod report;
pub mod reproduce;
pub mod stability;
pub mod sweep;
pub mod trace;
pub mod variants;

use immaculate::paper::{Effort, Paper};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::Write;
use std::path::Path;

/// What a command could not do.
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

/// What a command did: what it prints, and its exit status.
pub struct Done {
    /// What is printed.
    pub text: String,
    /// The exit status.
    pub status: u8,
}

impl From<String> for Done {
    fn from(text: String) -> Self {
        Self { text, status: 0 }
    }
}

/// JSON for people and programs.
pub fn json_text(value: &serde_json::Value) -> String {
    format!("{value:#}\n")
}

/// Writes a file whole or not at all: what was there before stays until all is written.
pub fn write_file(path: &Path, content: &str) -> Result<(), Refusal> {
    let wrong = |error: std::io::Error| Refusal::Output(format!("{}: {error}", path.display()));
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    let part = path.with_file_name(name);
    let written = std::fs::File::create(&part).and_then(|mut file| {
        file.write_all(content.as_bytes())?;
        file.sync_all()
    });
    written.and_then(|()| std::fs::rename(&part, path)).map_err(|error| {
        // What was written of it is of no use.
        let _ = std::fs::remove_file(&part);
        wrong(error)
    })
}

/// Reads a text file of bounded size, or standard input for `-`.
pub fn read_file(path: &Path) -> Result<String, Refusal> {
    const GREATEST: u64 = 1 << 28;
    let wrong = |reason: String| Refusal::Request(format!("{}: {reason}", path.display()));
    let reader: Box<dyn std::io::Read> = if path == Path::new("-") {
        Box::new(std::io::stdin())
    } else {
        Box::new(std::fs::File::open(path).map_err(|error| wrong(error.to_string()))?)
    };
    let mut text = String::new();
    let length = std::io::Read::take(reader, GREATEST)
        .read_to_string(&mut text)
        .map_err(|error| wrong(error.to_string()))?;
    if length as u64 == GREATEST {
        return Err(wrong(format!("is larger than {GREATEST} bytes")));
    }
    Ok(text)
}

use std::io::Read as _;

/// The given papers; all when there is none.
pub fn papers(given: &[Paper]) -> Vec<Paper> {
    if given.is_empty() {
        Paper::ALL.to_vec()
    } else {
        given.to_vec()
    }
}

/// How much is computed.
pub fn effort(runs: Option<u64>, seed: u64) -> Effort {
    Effort {
        runs: runs.and_then(|runs| usize::try_from(runs).ok()),
        seed,
    }
}

/// A progress bar on standard error; it shows itself only where a person is watching.
pub fn progress_bar(length: u64, what: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} runs, {eta} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length).with_style(style).with_message(what)
}
