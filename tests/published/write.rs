//! How new cases are certified, written and locked: what is published is never changed, and the lock has new cases last.

use super::{all, rejected};
use immaculate::file::{self, digest};
use immaculate::oracle::case::{self, LOCK, Lock, Locked};
use immaculate::oracle::certify::certify;
use immaculate::oracle::problem::ProblemFile;
use rayon::prelude::*;
use std::path::Path;

/// A case that is to be written: its id, and its two files.
type Written = (String, String, String);

/// Certifies and writes the cases that the lock of the folder does not have; how many there are.
///
/// # Errors
///
/// A lock that cannot be read; a problem that is published and was changed or withdrawn; one that cannot be certified; a file that cannot
/// be written.
pub fn write(folder: &Path) -> Result<usize, String> {
    let path = folder.join(LOCK);
    let of_the_lock = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let text = file::read(&path).map_err(|error| of_the_lock(&error))?;
    let mut lock = Lock::read(&text).map_err(|error| of_the_lock(&error))?;
    let (problems, rejected) = (all(), rejected());
    for problem in problems.iter().chain(rejected.iter().map(|(problem, ..)| problem)) {
        check_unchanged(problem, &lock)?;
    }
    let is_new = |problem: &ProblemFile| !lock.cases.iter().any(|locked| locked.id == problem.id);
    let certified = problems.par_iter().filter(|problem| is_new(problem)).map(|problem| {
        let certified = certify(problem).map_err(|error| format!("{}: {error}", problem.id))?;
        let trace = case::trace_text(&problem.id, &certified);
        Ok((problem.id.clone(), case::problem_text(problem), trace))
    });
    let mut written: Vec<Written> = certified.collect::<Result<_, String>>()?;
    for (problem, class, reason) in rejected.iter().filter(|(problem, ..)| is_new(problem)) {
        let trace = case::rejection_text(&problem.id, *class, reason);
        written.push((problem.id.clone(), case::problem_text(problem), trace));
    }
    for (id, problem, trace) in &written {
        write_file(&folder.join(case::problem_name(id)), problem)?;
        write_file(&folder.join(case::trace_name(id)), trace)?;
        lock.cases.push(Locked {
            id: id.clone(),
            problem: digest(problem),
            trace: digest(trace),
            withdrawn: None,
        });
    }
    let text = serde_json::to_string_pretty(&lock).map_err(|error| error.to_string())?;
    write_file(&path, &format!("{text}\n"))?;
    Ok(written.len())
}

fn write_file(path: &Path, text: &str) -> Result<(), String> {
    file::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

/// A published problem must be what it was.
fn check_unchanged(problem: &ProblemFile, lock: &Lock) -> Result<(), String> {
    let Some(locked) = lock.cases.iter().find(|locked| locked.id == problem.id) else {
        return Ok(());
    };
    if locked.withdrawn.is_none() && locked.problem == digest(&case::problem_text(problem)) {
        return Ok(());
    }
    Err(format!(
        "`{}` is published and was changed or withdrawn; a published case stays as it is: give the new one another id",
        problem.id
    ))
}
