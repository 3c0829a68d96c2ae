//! A program under test in Python, in the same process.
//!
//! The Python object has two methods: `ready()` gives the message of this name, `run(problem)` the answer to a problem, both as the JSON of
//! the protocol. What is raised in them is no answer: it ends the check, and is raised again where the check was called.

use crate::problem::Problem;
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::process::read_answer;
use immaculate::oracle::subject::{Answer, Broken, Ready, Subject};
use immaculate::oracle::trace::read_json;
use pyo3::prelude::*;

/// The Python object that is asked.
pub struct PythonSubject {
    asked: Py<PyAny>,
    /// What was raised in it.
    pub interruption: Option<PyErr>,
}

impl PythonSubject {
    /// A subject that nobody has interrupted.
    pub fn new(asked: Py<PyAny>) -> Self {
        Self {
            asked,
            interruption: None,
        }
    }

    /// Keeps what was raised, and says so in place of an answer that nobody will read.
    fn interrupted(&mut self, raised: PyErr) -> Broken {
        let sentence = raised.to_string();
        self.interruption = Some(raised);
        Broken::NotStarted(sentence)
    }
}

/// A message that cannot be read.
fn garbage(line: &str, reason: String) -> Broken {
    let line = immaculate::file::shortened(line, 100);
    Broken::Garbage { line, reason }
}

impl Subject for PythonSubject {
    fn start(&mut self) -> Result<Ready, Broken> {
        let said = Python::attach(|py| self.asked.call_method0(py, "ready")?.extract::<String>(py));
        let line = said.map_err(|raised| self.interrupted(raised))?;
        let message = read_json(&line).map_err(|reason| garbage(&line, reason.to_string()))?;
        Ready::read(&message).map_err(|reason| garbage(&line, reason))
    }

    fn run(&mut self, problem: &ProblemFile) -> Answer {
        let asked = Problem::from(problem.clone());
        let said = Python::attach(|py| self.asked.call_method1(py, "run", (asked,))?.extract::<String>(py));
        let line = match said {
            Ok(line) => line,
            Err(raised) => return Answer::Broken(self.interrupted(raised)),
        };
        let message = read_json(&line).map_err(|reason| garbage(&line, reason.to_string()));
        let answer = message.and_then(|message| read_answer(&message, &problem.dimensions()));
        answer.unwrap_or_else(Answer::Broken)
    }

    fn is_interrupted(&self) -> bool {
        self.interruption.is_some()
    }
}
