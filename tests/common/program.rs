//! The program as a process: how it is started, and how what it did is read.

use std::path::Path;
use std::process::{Command, Output};

/// The program with these arguments, not started yet.
pub fn immaculate(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_immaculate"));
    command.args(arguments);
    command
}

/// What the program complained of.
pub fn error_of(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// The names of the files of a folder, in order.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}
