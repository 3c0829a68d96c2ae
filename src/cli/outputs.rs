//! Where `immaculate check` writes its verdict beside the terminal.
//!
//! After this file the reader knows which files there are, and that a path at which none can be is refused before anything is checked.

use super::{Refusal, write_file};
use clap::Args;
use immaculate::oracle::check::Report;
use immaculate::report::verdict::{badge, junit, markdown, page};
use std::path::{Path, PathBuf};

#[derive(Args)]
#[command(next_help_heading = "Files beside what is printed")]
pub struct Outputs {
    /// Write the verdict as JUnit XML: a suite a kind of filter, a test a case, for GitLab, Jenkins and GitHub
    #[arg(long, value_name = "FILE", conflicts_with = "search")]
    junit: Option<PathBuf>,
    /// Write a summary for a pull request, or for the file that `$GITHUB_STEP_SUMMARY` names
    #[arg(long, value_name = "FILE", conflicts_with = "search")]
    markdown: Option<PathBuf>,
    /// Write one page of HTML, which needs no network and no script: causes, each fault in its equation and over the steps
    #[arg(long, value_name = "FILE", conflicts_with = "search")]
    report: Option<PathBuf>,
    /// Write a badge, an SVG picture: RIGHT, WRONG and how often, or right on what was judged
    #[arg(long, value_name = "FILE", conflicts_with = "search")]
    badge: Option<PathBuf>,
}

impl Outputs {
    /// The files that are asked for.
    fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        [&self.junit, &self.markdown, &self.report, &self.badge]
            .into_iter()
            .flatten()
    }

    /// Whether none is asked for.
    pub fn is_empty(&self) -> bool {
        self.paths().next().is_none()
    }

    /// Minutes of checking should not end with a path at which there can be no file.
    pub fn check(&self) -> Result<(), Refusal> {
        self.paths().try_for_each(|path| check_that_a_file_can_be_there(path))
    }

    /// Writes them.
    pub fn write(&self, report: &Report) -> Result<(), Refusal> {
        let write = |path: &Option<PathBuf>, content: &dyn Fn() -> Result<String, String>| match path {
            Some(path) => write_file(path, &content().map_err(|reason| not_made(path, &reason))?),
            None => Ok(()),
        };
        write(&self.junit, &|| junit::junit(report).map_err(|error| error.to_string()))?;
        write(&self.markdown, &|| Ok(markdown::markdown(report)))?;
        write(&self.report, &|| page::html(report).map_err(|error| error.to_string()))?;
        write(&self.badge, &|| Ok(badge::badge(report)))
    }
}

fn not_made(path: &Path, reason: &str) -> Refusal {
    Refusal::Output(format!("{}: {reason}", path.display()))
}

/// Whether a file can be at a path, as far as that can be seen without writing it.
fn check_that_a_file_can_be_there(path: &Path) -> Result<(), Refusal> {
    let directory = path.parent().filter(|directory| *directory != Path::new(""));
    let wrong = if path.is_dir() {
        "is a directory, not a file"
    } else if directory.is_some_and(|directory| !directory.is_dir()) {
        "its directory does not exist"
    } else {
        return Ok(());
    };
    Err(Refusal::Output(format!("{}: {wrong}", path.display())))
}
