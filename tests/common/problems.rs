//! Published problems as JSON, to be changed, read and refused.

use immaculate::oracle::case;
use immaculate::oracle::problem::ProblemFile;
use serde_json::Value;

/// A published problem as it stands in its file.
pub fn published(id: &str) -> Value {
    let mut all = case::all().unwrap().iter();
    serde_json::from_str(all.find(|case| case.problem.id == id).unwrap().problem_text).unwrap()
}

/// The problem of a file.
pub fn read(problem: &Value) -> ProblemFile {
    ProblemFile::read(&problem.to_string()).unwrap()
}

/// Why a file is refused.
pub fn refusal(problem: &Value) -> String {
    ProblemFile::read(&problem.to_string()).unwrap_err().to_string()
}
