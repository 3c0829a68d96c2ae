//! Runs every mutant of Immaculate from one build.
//!
//! ```text
//! mutation prepare TREE WORK     all mutants into a copy of the tree; what the compiler refuses is set aside
//! mutation trace WORK SECONDS    each test once, stopped after so long: how long it takes, and which mutants it reaches; of some files of
//!                                tests if their names follow
//! mutation run WORK ROOM SECONDS each mutant of a room against the tests that reach it, the likeliest first, so long in all
//! mutation table WORK            the score of each room, and what survived
//! ```
//!
//! `cargo mutants` builds the crate and its tests anew for each mutant. Here they are built once; a mutant is alive in those processes
//! that have its number in their environment.

mod instrument;
mod mutant;
mod prepare;
mod run;
mod table;
mod trace;

use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match words[..] {
        ["prepare", tree, work] => folder(work).and_then(|work| prepare::prepare(Path::new(tree), &work)),
        ["trace", work, seconds, ref files @ ..] => {
            number(seconds).and_then(|seconds| trace::trace(&folder(work)?, seconds, files))
        }
        ["run", work, room, seconds] => number(seconds).and_then(|seconds| run::run(&folder(work)?, room, seconds)),
        ["table", work] => table::table(Path::new(work)),
        _ => Err("prepare TREE WORK | trace WORK SECONDS [FILE…] | run WORK ROOM SECONDS | table WORK".into()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(sentence) => {
            eprintln!("mutation: {sentence}");
            ExitCode::FAILURE
        }
    }
}

/// A folder, made if it is not there: absolute, as tests have working directories of their own.
fn folder(text: &str) -> Result<PathBuf, String> {
    let made = std::fs::create_dir_all(text).and_then(|()| Path::new(text).canonicalize());
    made.map_err(|error| format!("{text}: {error}"))
}

fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| format!("{text} is not a number of seconds"))
}

fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, String> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    serde_json::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))
}

fn write_json<T: Serialize>(path: &Path, value: &T) -> Result<(), String> {
    let text = serde_json::to_string(value).map_err(|error| error.to_string())?;
    std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}
