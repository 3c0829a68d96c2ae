//! A program that is asked one problem after another: each is certified, asked and judged, without a diagnosis.
//!
//! This file defines a failure, failures of the same kind, and the problems that are fair to ask.

use crate::imm::Quantity;
use crate::number::Real;
use crate::oracle::case::Expected;
use crate::oracle::certify::certified_as_far_as_it_goes;
use crate::oracle::check::{CaseReport, NotMade, Outcome, Question, declared, judge_answer};
use crate::oracle::judge::{Finding, Judgement};
use crate::oracle::problem::ProblemFile;
use crate::oracle::subject::{Answer, Broken, Ready, Subject};
use crate::oracle::trace::Trace;

/// What went wrong; two that are equal are taken for the same.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Symptom {
    /// A value that is not what its equation gives: the first one in the order of computation.
    Fault(Quantity),
    /// The first such value is no number.
    NotFinite(Quantity),
    /// No values, or an early end: what the outcome is called, and the program's words about it without their numbers.
    Outcome(&'static str, String),
}

impl Symptom {
    /// That of a judged problem, if there is one.
    pub(super) fn of(case: &CaseReport) -> Option<Self> {
        let first = case.judgement.iter().flat_map(Judgement::faults).next();
        let outcome = |name, words: &str| Some(Self::Outcome(name, without_numbers(words)));
        match &case.outcome {
            Outcome::Wrong => first.map(|judged| match judged.finding {
                Finding::NotFinite => Self::NotFinite(judged.place.1),
                _ => Self::Fault(judged.place.1),
            }),
            Outcome::Stopped { reason } => outcome("stopped before the end", reason),
            Outcome::WronglyRejected { reason } => outcome("rejected a good problem", reason),
            Outcome::NothingShown => outcome("showed nothing", ""),
            Outcome::Broken(Broken::Crashed { status, stderr }) => {
                outcome("ended", stderr.lines().last().unwrap_or(status))
            }
            Outcome::Broken(Broken::Garbage { reason, .. }) => {
                outcome("answered something that is not a message", reason)
            }
            Outcome::Broken(broken @ Broken::TimedOut { .. }) => outcome("did not answer", &broken.to_string()),
            Outcome::Broken(broken) => outcome("gave an answer that cannot be used", &broken.to_string()),
            _ => None,
        }
    }

    /// In words.
    pub fn words(&self) -> String {
        match self {
            Self::Fault(quantity) => format!("{} is wrong", quantity.name()),
            Self::NotFinite(quantity) => format!("{} is not finite", quantity.name()),
            Self::Outcome(name, _) => format!("the program {name}"),
        }
    }
}

/// What a program says of one problem and of the next differs in numbers.
fn without_numbers(words: &str) -> String {
    words
        .chars()
        .filter(|c| !c.is_ascii_digit() && !".-+e".contains(*c))
        .collect()
}

/// A problem with what is expected of it.
pub(super) struct Certified {
    pub(super) problem: ProblemFile,
    pub(super) trace: Trace,
    pub(super) steps: usize,
}

impl Certified {
    /// The problem, certified as far as it goes; nothing if it cannot be run.
    pub(super) fn of(problem: ProblemFile) -> Option<Self> {
        let (trace, steps) = certified_as_far_as_it_goes(&problem).ok()?;
        Some(Self { problem, trace, steps })
    }

    /// Whether a right filter has no excuse: all of it is certified, and in units of its own variances no covariance is nearly singular.
    pub(super) fn is_fair(&self) -> bool {
        let is_tame = |(step, quantity, mode): (usize, Quantity, usize)| {
            let columns = self.trace.dimensions.shape(step, quantity).1;
            let numbers = self.trace.get(step, quantity, mode);
            !quantity.is_covariance() || numbers.is_none_or(|numbers| is_well_conditioned(numbers, columns))
        };
        self.steps == self.problem.measurements.len() && self.trace.all_places().all(is_tame)
    }
}

/// The least part of a variance that may be left when the components before it are known. A double has twelve more digits, a single
/// three; no filter that is well written stops there.
const LEAST_PART: f64 = 1e-4;

/// Whether every pivot of a covariance is at least [`LEAST_PART`] of its variance; its columns are n, its entries by rows.
fn is_well_conditioned(numbers: &[f64], n: usize) -> bool {
    let mut factor = vec![vec![0.0; n]; n];
    for row in 0..n {
        for column in 0..=row {
            let known: f64 = (0..column).map(|k| factor[row][k] * factor[column][k]).sum();
            let left = numbers[row * n + column] - known;
            if row == column {
                if left.is_nan() || left <= LEAST_PART * numbers[row * n + row] {
                    return false;
                }
                factor[row][row] = Real::sqrt(&left);
            } else {
                factor[row][column] = left / factor[column][column];
            }
        }
    }
    true
}

/// A program that has started.
pub(super) struct Asked<'a> {
    pub(super) subject: &'a mut dyn Subject,
    pub(super) ready: Ready,
    /// The variants by which it is judged: those that it declares, and those by which its answers were explained without a mistake.
    pub(super) conventions: Vec<&'static str>,
}

impl<'a> Asked<'a> {
    /// Starts a program.
    ///
    /// # Errors
    ///
    /// [`NotMade`] when it does not start, or declares what is not known.
    pub(super) fn start(subject: &'a mut dyn Subject) -> Result<Self, NotMade> {
        let ready = subject.start()?;
        let conventions = declared(&ready)?;
        Ok(Self {
            subject,
            ready,
            conventions,
        })
    }

    /// Asks a problem and judges the answer.
    ///
    /// # Errors
    ///
    /// [`NotMade`] when the program cannot be started again, or the problem cannot be set up.
    pub(super) fn ask(&mut self, certified: &Certified) -> Result<CaseReport, NotMade> {
        let answer = self.subject.run(&certified.problem);
        if let Answer::Broken(broken @ Broken::NotStarted(_)) = answer {
            return Err(broken.into());
        }
        let question = Question::Own {
            problem: &certified.problem,
            expected: Expected::Trace(certified.trace.clone()),
            steps: certified.steps,
        };
        Ok(judge_answer(&question, answer, &self.ready, &self.conventions)?.0)
    }
}
