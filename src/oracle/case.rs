//! The published cases: problems with their certified traces, locked by digests and built into the program.
//!
//! An id is never changed and never reused, and a published case is never edited. A file whose digest differs from the lock is an error.

use super::certify::{Certified, NotCertified, certify};
use super::invalid::{Class, Invalid};
use super::problem::ProblemFile;
use super::trace::{FORMAT, Trace};
use crate::file::digest;
use crate::imm::Needs;
use include_dir::{Dir, include_dir};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::sync::LazyLock;

/// The folder of the cases, as it was when the program was built.
static FILES: Dir = include_dir!("$CARGO_MANIFEST_DIR/fixtures/cases");

/// The lock.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lock {
    /// `immaculate-lock/1`.
    pub format: String,
    /// One entry per case, in the order of the list.
    pub cases: Vec<Locked>,
}

/// A published case in the lock.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Locked {
    /// The id.
    pub id: String,
    /// SHA-256 of the problem file.
    pub problem: String,
    /// SHA-256 of the trace file.
    pub trace: String,
    /// Why the case was withdrawn, if it was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub withdrawn: Option<String>,
}

/// The name of the lock file.
pub const LOCK: &str = "lock.json";

/// The name of a case's problem file.
pub fn problem_name(id: &str) -> String {
    format!("{id}.problem.json")
}

/// The name of a case's trace file.
pub fn trace_name(id: &str) -> String {
    format!("{id}.trace.json")
}

/// What a case expects.
#[derive(Debug, Clone, PartialEq)]
pub enum Expected {
    /// A certified trace.
    Trace(Trace),
    /// The problem must be rejected, for a reason of this class.
    Rejection(Class),
}

/// A published case.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// The text of the problem file.
    pub problem_text: &'static str,
    /// The text of the trace file.
    pub trace_text: &'static str,
    /// The problem, which is wrong if it must be rejected.
    pub problem: ProblemFile,
    /// What is expected.
    pub expected: Expected,
}

/// What is wrong with the folder of the cases.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BadCase {
    /// A file is missing.
    #[error("{0} is missing")]
    Missing(String),
    /// A file is not what was published.
    #[error("{file} is not what was published: its digest is {found}, and {locked} in the lock")]
    Changed {
        /// The file.
        file: String,
        /// Its digest.
        found: String,
        /// The digest in the lock.
        locked: String,
    },
    /// A file cannot be read.
    #[error("{file}: {reason}")]
    Unreadable {
        /// The file.
        file: String,
        /// Why.
        reason: String,
    },
    /// A trace cannot be certified again.
    #[error("{id}: {reason}")]
    NotCertified {
        /// The case.
        id: String,
        /// Why.
        reason: NotCertified,
    },
    /// The certified trace is another one.
    #[error("{id}: the certified trace differs from the published one, first in line {line}")]
    Differs {
        /// The case.
        id: String,
        /// The first line that differs.
        line: usize,
    },
    /// The rounding noise of a case is another.
    #[error(
        "{id}: the rounding noise is {noise:.2} times the published one on average; another order of operations moves it by less than 3"
    )]
    Noise {
        /// The case.
        id: String,
        /// Measured over published, the geometric mean over all numbers.
        noise: f64,
    },
    /// A problem that must be rejected is not.
    #[error("{id}: must be rejected as {expected}, but {found}")]
    NotRejected {
        /// The case.
        id: String,
        /// The class.
        expected: &'static str,
        /// What happened.
        found: String,
    },
}

/// All published cases that were not withdrawn, in the order of the lock.
///
/// Example: one is found by its id.
///
/// ```
/// use immaculate::oracle::case;
///
/// let cases = case::all().unwrap();
/// assert!(cases.iter().any(|case| case.problem.id == "step.n4-m2.two-modes"));
/// ```
///
/// # Errors
///
/// [`BadCase`] for a file that is missing, changed or unreadable.
pub fn all() -> Result<&'static [Case], BadCase> {
    static CASES: LazyLock<Result<Vec<Case>, BadCase>> = LazyLock::new(read_all);
    CASES.as_ref().map(Vec::as_slice).map_err(Clone::clone)
}

/// The lock.
///
/// # Errors
///
/// [`BadCase`] when it is missing or unreadable.
pub fn lock() -> Result<Lock, BadCase> {
    Lock::read(text(LOCK)?).map_err(|reason| BadCase::Unreadable {
        file: LOCK.into(),
        reason,
    })
}

impl Lock {
    /// The format of lock files.
    pub const FORMAT: &str = "immaculate-lock/1";

    /// Reads a lock.
    ///
    /// # Errors
    ///
    /// The reason why it cannot be read.
    pub fn read(text: &str) -> Result<Self, String> {
        let lock: Self = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if lock.format == Self::FORMAT {
            return Ok(lock);
        }
        let (found, known) = (&lock.format, Self::FORMAT);
        Err(format!("format is {found:?}, but this program reads {known:?}"))
    }
}

fn text(name: &str) -> Result<&'static str, BadCase> {
    FILES
        .get_file(name)
        .and_then(include_dir::File::contents_utf8)
        .ok_or_else(|| BadCase::Missing(name.to_owned()))
}

fn read_all() -> Result<Vec<Case>, BadCase> {
    let published = lock()?.cases.into_iter().filter(|locked| locked.withdrawn.is_none());
    published.map(|locked| read(&locked)).collect()
}

/// A file with the digest that the lock has for it.
fn locked_text(name: &str, locked: &str) -> Result<&'static str, BadCase> {
    let text = text(name)?;
    let found = digest(text);
    if found == locked {
        return Ok(text);
    }
    Err(BadCase::Changed {
        file: name.to_owned(),
        found,
        locked: locked.to_owned(),
    })
}

/// Reads a case and holds its files against the lock.
///
/// # Errors
///
/// As [`all`].
pub fn read(locked: &Locked) -> Result<Case, BadCase> {
    let (problem_name, trace_name) = (problem_name(&locked.id), trace_name(&locked.id));
    let problem_text = locked_text(&problem_name, &locked.problem)?;
    let trace_text = locked_text(&trace_name, &locked.trace)?;
    let unreadable = |file: &str, reason: String| BadCase::Unreadable {
        file: file.into(),
        reason,
    };
    let mut problem = ProblemFile::parse(problem_text).map_err(|error| unreadable(&problem_name, error.to_string()))?;
    let value: Value = serde_json::from_str(trace_text).map_err(|error| unreadable(&trace_name, error.to_string()))?;
    let expected = read_expected(&value, &problem).map_err(|error| unreadable(&trace_name, error.to_string()))?;
    // What a trace was published without, a case never asks for.
    problem.lacks_consistency = matches!(&expected, Expected::Trace(trace) if !trace.holds(Needs::Consistency));
    Ok(Case {
        problem_text,
        trace_text,
        problem,
        expected,
    })
}

fn read_expected(value: &Value, problem: &ProblemFile) -> Result<Expected, Invalid> {
    if value["format"] != FORMAT {
        return Err(Invalid::new(Class::Format, "format", format!("is not {FORMAT:?}")));
    }
    if let Some(rejected) = value.get("rejected") {
        let name = rejected["class"].as_str().unwrap_or_default();
        return Class::ALL
            .into_iter()
            .find(|class| class.name() == name)
            .map(Expected::Rejection)
            .ok_or_else(|| Invalid::new(Class::Format, "rejected.class", "is not a class"));
    }
    let trace = Trace::from_json(&value["steps"], &problem.dimensions())?;
    Ok(Expected::Trace(trace))
}

/// JSON with two levels of lines: one a key, one an entry of the outermost lists, so that a reader finds a step and a difference shows its
/// line.
pub fn pretty(value: &Value) -> String {
    let Value::Object(object) = value else {
        return value.to_string();
    };
    let lines: Vec<String> = object
        .iter()
        .map(|(key, value)| {
            let key = json!(key);
            match value {
                Value::Array(list) if list.iter().any(Value::is_object) => {
                    let entries: Vec<String> = list.iter().map(|entry| format!("    {entry}")).collect();
                    format!("  {key}: [\n{}\n  ]", entries.join(",\n"))
                }
                value => format!("  {key}: {value}"),
            }
        })
        .collect();
    format!("{{\n{}\n}}\n", lines.join(",\n"))
}

/// The text of a problem file.
pub fn problem_text(problem: &ProblemFile) -> String {
    pretty(&json!(problem))
}

/// The text of a trace file for a problem that must be rejected.
pub fn rejection_text(id: &str, class: Class, reason: &str) -> String {
    pretty(&json!({ "format": FORMAT, "id": id, "rejected": { "class": class.name(), "reason": reason } }))
}

/// The text of a certified trace file.
pub fn trace_text(id: &str, certified: &Certified) -> String {
    pretty(&certified.to_json(id))
}

impl Case {
    /// Proves the case again from nothing but its problem; the bits that it took.
    ///
    /// Example: certified again, on enclosures: the same doubles, or an error.
    ///
    /// ```
    /// use immaculate::oracle::case;
    ///
    /// let case = case::all().unwrap().iter().find(|case| case.problem.id == "step.n4-m2.two-modes").unwrap();
    /// let certified = case.verify().unwrap().unwrap();
    /// assert!(certified.digits > 16); // more digits than a double has
    /// ```
    ///
    /// # Errors
    ///
    /// [`BadCase`] with what is different.
    pub fn verify(&self) -> Result<Option<Certified>, BadCase> {
        let id = &self.problem.id;
        if let Expected::Rejection(class) = self.expected {
            let found = match self.problem.check() {
                Err(invalid) if invalid.class == class => return Ok(None),
                Err(invalid) => format!("is rejected as {}: {invalid}", invalid.class.name()),
                Ok(()) => "is accepted".into(),
            };
            return Err(BadCase::NotRejected {
                id: id.clone(),
                expected: class.name(),
                found,
            });
        }
        let certified = certify(&self.problem).map_err(|reason| BadCase::NotCertified { id: id.clone(), reason })?;
        let (file, noise) = with_published_noise(certified.to_json(id), self.trace_text);
        if noise > NOISE_FACTOR || noise.recip() > NOISE_FACTOR {
            return Err(BadCase::Noise { id: id.clone(), noise });
        }
        let text = pretty(&file);
        let first = text
            .lines()
            .zip(self.trace_text.lines())
            .position(|(new, old)| new != old);
        match first {
            None if text.len() == self.trace_text.len() => Ok(Some(certified)),
            line => Err(BadCase::Differs {
                id: id.clone(),
                line: line.unwrap_or(0) + 1,
            }),
        }
    }
}

/// By how much the noise of a whole case, its geometric mean, may differ from the published one.
///
/// Steps and scales are theorems and are compared exactly. The noise is a measurement: each number is the largest of
/// [`RUNS`](super::noise::RUNS) random deviations, and an equation that is written in another order, equal in exact arithmetic, draws
/// another sample. Two samples of the largest of eight Gaussian deviations differ by more than 3 once in 84 numbers, so the mean over a
/// case differs by that much only where the equations really lose more digits, or fewer.
const NOISE_FACTOR: f64 = 3.0;

/// By how much the noise of a single number may differ: two samples do by more once in 450 000 numbers. Among the 39 594 published ones,
/// drawn again from other seeds, the greatest ratio was 7.1.
const NOISE_FACTOR_OF_ONE: f64 = 10.0;

/// The trace file with the published noise wherever it is close enough to the one that was measured now, and the geometric mean of
/// measured over published.
fn with_published_noise(mut measured: Value, published: &str) -> (Value, f64) {
    let published: Value = serde_json::from_str(published).unwrap_or_default();
    let mut logarithms = Vec::new();
    keep_close(&mut measured["noise"], &published["noise"], &mut logarithms);
    let mean = logarithms.iter().sum::<f64>() / (logarithms.len().max(1) as f64);
    (measured, libm::exp(mean))
}

/// Replaces every number by the published one at the same place if they are within [`NOISE_FACTOR_OF_ONE`]; collects the logarithms of
/// the ratios.
fn keep_close(measured: &mut Value, published: &Value, logarithms: &mut Vec<f64>) {
    match measured {
        Value::Array(entries) => {
            for (index, entry) in entries.iter_mut().enumerate() {
                keep_close(entry, &published[index], logarithms);
            }
        }
        Value::Object(entries) => {
            for (key, entry) in entries {
                keep_close(entry, &published[key], logarithms);
            }
        }
        _ => {
            let (Some(new), Some(old)) = (measured.as_f64(), published.as_f64()) else {
                return;
            };
            let ratio = new / old;
            logarithms.push(libm::log(ratio));
            if ratio <= NOISE_FACTOR_OF_ONE && ratio.recip() <= NOISE_FACTOR_OF_ONE {
                *measured = published.clone();
            }
        }
    }
}
