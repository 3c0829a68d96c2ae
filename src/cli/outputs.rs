//! The files to which `immaculate check` writes its verdict. A path that cannot be written is refused before anything is checked.

use super::{Refusal, write_file};
use clap::Args;
use immaculate::oracle::check::Report;
use immaculate::report::verdict::{badge, junit, markdown, page};
use std::path::{Path, PathBuf};

#[derive(Args)]
#[command(next_help_heading = "Output files")]
pub struct Outputs {
    /// Write the verdict as JUnit XML for GitLab, Jenkins and GitHub: one suite per kind of filter, one test per case
    #[arg(long, value_name = "FILE", conflicts_with = "search")]
    junit: Option<PathBuf>,
    /// Write a summary for a pull request, or for the file that `$GITHUB_STEP_SUMMARY` names
    #[arg(long, value_name = "FILE", conflicts_with = "search")]
    markdown: Option<PathBuf>,
    /// Write one HTML page, which needs no network and no script: causes, and each fault in its equation and over the steps
    #[arg(long, value_name = "FILE", conflicts_with = "search")]
    report: Option<PathBuf>,
    /// Write an SVG badge: RIGHT, RIGHT on what was judged, or WRONG with the number of cases
    #[arg(long, value_name = "FILE", conflicts_with = "search")]
    badge: Option<PathBuf>,
}

impl Outputs {
    /// The requested files.
    fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        [&self.junit, &self.markdown, &self.report, &self.badge]
            .into_iter()
            .flatten()
    }

    /// Whether no file is requested.
    pub fn is_empty(&self) -> bool {
        self.paths().next().is_none()
    }

    /// A check of several minutes should not end with a path that cannot be written.
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

/// Whether a file can be written at a path, as far as that can be known beforehand.
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
