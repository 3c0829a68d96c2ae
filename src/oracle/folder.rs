//! Answers as files: one `ID.json` or `ID.csv` per case in a folder, and perhaps a `ready.json`.
//!
//! Users of MATLAB, for example, answer without a process. Files are judged like messages; a case without a file is reported.

use super::csv;
use super::problem::ProblemFile;
use super::process::read_answer;
use super::subject::{Answer, Broken, Ready, Subject};
use super::trace::read_json;
use crate::file;
use crate::file::shortened;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A folder of answers.
#[derive(Debug, Clone)]
pub struct Folder {
    /// Where it is.
    pub path: PathBuf,
}

/// Reads a file of bounded size; none if there is no such file.
fn read_file(path: &Path) -> Result<Option<String>, Broken> {
    let wrong = |reason: String| Broken::NotStarted(format!("{}: {reason}", path.display()));
    match std::fs::metadata(path) {
        Err(_) => return Ok(None),
        // A pipe would be waited for without an end.
        Ok(metadata) if !metadata.is_file() => return Err(wrong("is not a file".into())),
        Ok(_) => {}
    }
    file::read(path).map(Some).map_err(|error| wrong(error.to_string()))
}

impl Subject for Folder {
    fn start(&mut self) -> Result<Ready, Broken> {
        if !self.path.is_dir() {
            return Err(Broken::NotStarted(format!("{} is not a folder", self.path.display())));
        }
        let Some(text) = read_file(&self.path.join("ready.json"))? else {
            return Ok(Ready {
                name: self.path.display().to_string(),
                ..Ready::default()
            });
        };
        read_json(&text)
            .map_err(|error| error.reason)
            .and_then(|message| Ready::read(&message))
            .map_err(|reason| Broken::NotStarted(format!("{}: {reason}", self.path.join("ready.json").display())))
    }

    fn run(&mut self, problem: &ProblemFile) -> Answer {
        self.read(problem).unwrap_or_else(Answer::Broken)
    }

    fn forgets_at_start(&self) -> bool {
        false
    }
}

impl Folder {
    fn read(&self, problem: &ProblemFile) -> Result<Answer, Broken> {
        let dimensions = problem.dimensions();
        let path = self.path.join(format!("{}.json", problem.id));
        if let Some(text) = read_file(&path)? {
            let message = read_json(&text).map_err(|error| Broken::Garbage {
                line: path.display().to_string(),
                reason: error.reason,
            })?;
            return match message.get("id").and_then(Value::as_str) {
                Some(id) if id != problem.id => Err(Broken::OutOfOrder {
                    asked: problem.id.clone(),
                    answered: shortened(id, 100),
                }),
                _ => read_answer(&message, &dimensions),
            };
        }
        if let Some(text) = read_file(&self.path.join(format!("{}.csv", problem.id)))? {
            let trace = csv::read(&text, &problem.id, &dimensions).map_err(Broken::Invalid)?;
            return Ok(Answer::Steps { trace, error: None });
        }
        Ok(Answer::Skipped {
            reason: "there is no answer file".into(),
        })
    }
}
