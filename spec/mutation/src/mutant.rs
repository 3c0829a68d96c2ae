//! The mutants as `cargo mutants --list --json` names them, with their states and rooms.

use serde::{Deserialize, Serialize};
use std::path::Path;
use std::process::Command;

/// A place in a file: line and column from 1, columns in characters.
#[derive(Debug, Clone, Copy, Deserialize)]
pub struct Place {
    pub line: usize,
    pub column: usize,
}

#[derive(Debug, Clone, Copy, Deserialize)]
pub struct Span {
    pub start: Place,
    pub end: Place,
}

/// A mutant as the list has it.
#[derive(Debug, Clone, Deserialize)]
pub struct Listed {
    pub name: String,
    pub file: String,
    pub genre: String,
    pub replacement: String,
    pub span: Span,
}

/// What the build makes of a mutant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Build {
    /// It is in the build.
    In,
    /// The compiler refuses it, with this message.
    Unviable(String),
    /// It cannot be chosen at run time: it stands in a constant, or its function returns `impl Trait`.
    NotChosen(String),
}

/// A mutant of the build.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Mutant {
    pub id: usize,
    /// The first id of its site; the mutants of one place in the code have ids that follow each other.
    pub site: usize,
    pub name: String,
    pub file: String,
    pub build: Build,
}

/// The room of a file: its folder in `src/`, or its name.
pub fn room(file: &str) -> &str {
    let inside = file.strip_prefix("src/").unwrap_or(file);
    let first = inside.split('/').next().unwrap_or(inside);
    first.strip_suffix(".rs").unwrap_or(first)
}

/// Every mutant that `cargo mutants` makes of the tree.
pub fn list(tree: &Path) -> Result<Vec<Listed>, String> {
    let output = Command::new("cargo")
        .args(["mutants", "--list", "--json"])
        .current_dir(tree)
        .output()
        .map_err(|error| format!("cargo mutants: {error}"))?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    serde_json::from_slice(&output.stdout).map_err(|error| format!("the list of mutants: {error}"))
}
