//! The check of a program under test over the published cases.
//!
//! After this file the reader knows how a verdict over all cases comes about: the echo first, then each case that the program has the
//! filter for, then, if anything is faulty, the search for what was done.

use super::case::{self, BadCase, Case, Expected};
use super::diagnose::{Diagnosis, Evidence, diagnose};
use super::invalid::Invalid;
use super::judge::{self, Finding, Judged, Judgement, LIMIT, Reference};
use super::problem::{FilterFile, ProblemFile};
use super::subject::{Answer, Broken, Precision, Ready, Subject, echoed};
use super::trace::{Dimensions, Trace};
use super::variant::{Variant, catalogue};
use crate::imm::Quantity;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, PoisonError};

/// Which cases are asked for; empty lists ask for all.
#[derive(Debug, Clone, Default)]
pub struct Selection {
    /// Ids, or beginnings of ids.
    pub ids: Vec<String>,
    /// Flags, of which a case must have one.
    pub flags: Vec<String>,
    /// Filters, of which a case must have one.
    pub kinds: Vec<String>,
}

impl Selection {
    /// Whether a case is asked for.
    pub fn has(&self, case: &Case) -> bool {
        let problem = &case.problem;
        let any = |wanted: &[String], is: &dyn Fn(&String) -> bool| wanted.is_empty() || wanted.iter().any(is);
        any(&self.ids, &|id| problem.id.starts_with(id.as_str()))
            && any(&self.flags, &|flag| problem.flags.contains(flag))
            && any(&self.kinds, &|kind| problem.filter.name() == kind)
    }
}

/// Why a check could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotMade {
    /// The cases themselves are damaged.
    #[error("the cases are damaged: {0}")]
    Cases(#[from] BadCase),
    /// The program could not be used.
    #[error("{0}")]
    Subject(#[from] Broken),
    /// A convention that is not known.
    #[error("the program declares `{key}`: {value:?}; known are {known}")]
    Convention {
        /// Its key.
        key: String,
        /// Its value.
        value: String,
        /// What is known.
        known: String,
    },
    /// The selection is empty.
    #[error("no case has what was selected")]
    NoCase,
    /// A problem that cannot be set up.
    #[error("{0}")]
    Problem(#[from] Invalid),
}

/// How a case went.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// Every value that was shown is right or inherited from none but right ones.
    Right,
    /// At least one equation is not what it should be.
    Wrong,
    /// The noise is as large as the values.
    CannotTell,
    /// Rejected as it must be; the class that the program gave may be another one.
    Rejected {
        /// The program's class where it differs.
        other_class: Option<String>,
    },
    /// Not rejected, though it must be.
    NotRejected,
    /// Rejected, though it is a good problem.
    WronglyRejected {
        /// The program's reason.
        reason: String,
    },
    /// Passed over by the program.
    Skipped {
        /// Its reason.
        reason: String,
    },
    /// Nothing was shown.
    NothingShown,
    /// The program stopped by itself, before the end.
    Stopped {
        /// Its reason.
        reason: String,
    },
    /// No answer.
    Broken(Broken),
}

impl Outcome {
    /// Whether it says that something is wrong.
    pub fn is_wrong(&self) -> bool {
        matches!(
            self,
            Self::Wrong
                | Self::NotRejected
                | Self::WronglyRejected { .. }
                | Self::Stopped { .. }
                | Self::Broken(_)
                | Self::NothingShown
        )
    }
}

/// A case, judged.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseReport {
    /// Its id.
    pub id: String,
    /// Its filter.
    pub filter: FilterFile,
    /// Its dimensions.
    pub dimensions: Dimensions,
    /// How it went.
    pub outcome: Outcome,
    /// The judged values.
    pub judgement: Option<Judgement>,
    /// The number of values that were judged, of those that the case has.
    pub judged: usize,
    /// The number of values of the case.
    pub of: usize,
    /// The digits that the worst of the values that are right has, in its scale.
    pub digits: Option<f64>,
    /// Why the program stopped before the end, if it did.
    pub stopped: Option<String>,
}

impl CaseReport {
    /// The report of a case before anything of it is judged.
    pub fn new(problem: &ProblemFile) -> Self {
        Self {
            id: problem.id.clone(),
            filter: problem.filter.clone(),
            dimensions: problem.dimensions(),
            outcome: Outcome::NothingShown,
            judgement: None,
            judged: 0,
            of: 0,
            digits: None,
            stopped: None,
        }
    }

    /// The columns of a quantity of the case.
    pub fn columns(&self, quantity: Quantity) -> usize {
        let Dimensions { n, m, r, .. } = self.dimensions;
        quantity.shape(n, m, r).1
    }
}

/// The whole verdict.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// What the program said of itself.
    pub ready: Ready,
    /// Whether its echo is right; none if it gave none.
    pub echo: Option<bool>,
    /// The cases.
    pub cases: Vec<CaseReport>,
    /// The cases for which it has no filter, or that its caller must check.
    pub not_asked: usize,
    /// What explains the faults.
    pub diagnosis: Diagnosis,
    /// The quantities that were never shown.
    pub hidden: Vec<Quantity>,
    /// What was strange on the way.
    pub remarks: Vec<String>,
}

impl Report {
    /// Whether all faults are those of a form or a convention, which are not wrong. They do not excuse an early end.
    pub fn is_excused(&self) -> bool {
        let is_early = |case: &CaseReport| case.outcome == Outcome::Wrong && case.stopped.is_some();
        self.diagnosis.is_excuse() && !self.cases.iter().any(is_early)
    }

    /// Whether nothing could be judged at all.
    pub fn is_empty(&self) -> bool {
        let is_judged = |case: &CaseReport| {
            !matches!(
                case.outcome,
                Outcome::Skipped { .. } | Outcome::CannotTell | Outcome::NothingShown
            )
        };
        !self.cases.iter().any(is_judged)
    }

    /// Whether anything is wrong.
    pub fn is_wrong(&self) -> bool {
        let is_excused = self.is_excused();
        self.echo == Some(false)
            || self.cases.iter().any(|case| match case.outcome {
                Outcome::Wrong => !is_excused,
                ref outcome => outcome.is_wrong(),
            })
    }

    /// The faults, each with its case.
    pub fn faults(&self) -> impl Iterator<Item = (&CaseReport, &Judged)> {
        self.cases.iter().flat_map(|case| {
            let values = case.judgement.iter().flat_map(|judgement| &judgement.values);
            values
                .filter(|value| matches!(value.finding, Finding::Fault | Finding::NotFinite))
                .map(move |value| (case, value))
        })
    }
}

/// The variants by which a program that declares conventions is judged.
fn declared(ready: &Ready) -> Result<Vec<&'static str>, NotMade> {
    let mut ids = Vec::new();
    for (key, value) in &ready.conventions {
        let is_ours = super::problem::Conventions::default().has(key, value);
        let variant = catalogue()
            .iter()
            .find(|variant| variant.convention.as_ref() == Some(key) && variant.value.as_ref() == Some(value));
        match variant {
            _ if is_ours => {}
            Some(variant) => ids.push(variant.id.as_str()),
            None => {
                let declaration = |variant: &'static Variant| {
                    Some(format!(
                        "`{}`: {:?}",
                        variant.convention.as_ref()?,
                        variant.value.as_ref()?
                    ))
                };
                let known: Vec<String> = catalogue().iter().filter_map(declaration).collect();
                return Err(NotMade::Convention {
                    key: key.clone(),
                    value: value.clone(),
                    known: known.join(", "),
                });
            }
        }
    }
    Ok(ids)
}

/// Checks a program on the selected cases; `progress` is told of each case that is done.
///
/// Example: this crate's own filter, with a mistake in it that is to be found: the spread of the means is left out.
///
/// ```
/// use immaculate::imm::Quantity;
/// use immaculate::oracle::check::{Selection, check};
/// use immaculate::oracle::diagnose::Diagnosis;
/// use immaculate::oracle::subject::{Level, Planted};
///
/// let mut program = Planted { variants: vec!["mixed-spread-omitted".into()], level: Level::Everything };
/// let case = Selection { ids: vec!["step.n4-m2.two-modes".into()], ..Selection::default() };
/// let report = check(&mut program, &case, &|_| {}).unwrap();
///
/// // Where: the mixed covariance of mode 0 at step 1.
/// let (_, judged) = report.faults().next().unwrap();
/// assert_eq!(judged.place, (1, Quantity::MixedCovariance, 0));
/// // What:
/// let Diagnosis::One(variants) = report.diagnosis else { panic!("one mistake explains all") };
/// assert_eq!(variants[0].id, "mixed-spread-omitted");
/// ```
///
/// # Errors
///
/// [`NotMade`] when the check cannot be made.
pub fn check(subject: &mut dyn Subject, selection: &Selection, progress: &dyn Fn(&str)) -> Result<Report, NotMade> {
    let selected: Vec<&Case> = case::all()?.iter().filter(|case| selection.has(case)).collect();
    if selected.is_empty() {
        return Err(NotMade::NoCase);
    }
    let ready = subject.start()?;
    let conventions = declared(&ready)?;
    let has = |case: &&&Case| {
        let kinds = ready.kinds.as_ref();
        let has_filter = kinds.is_none_or(|kinds| kinds.iter().any(|kind| kind == case.problem.filter.name()));
        match case.expected {
            Expected::Trace(_) => has_filter,
            Expected::Rejection(_) => ready.validates,
        }
    };
    let asked: Vec<&Case> = selected.iter().filter(has).copied().collect();
    let mut answered = Vec::new();
    let mut cases = Vec::new();
    for case in &asked {
        let answer = subject.run(&case.problem);
        let (report, shown) = judge_answer(case, answer, &ready, &conventions)?;
        if let Some(shown) = shown {
            answered.push((cases.len(), *case, shown));
        }
        cases.push(report);
        progress(&case.problem.id);
    }
    let remarks = subject.stop();
    let evidence: Vec<Evidence> = answered
        .iter()
        .map(|(index, case, (shown, reference))| evidence_of(&cases[*index], case, shown, reference, &ready))
        .collect();
    let diagnosis = diagnose(&evidence, &conventions)?;
    let exists = |quantity: &Quantity| {
        asked
            .iter()
            .any(|case| quantity.exists(|needed| case.problem.filter.has(needed)))
    };
    let hidden = Quantity::ALL.into_iter().filter(exists).filter(|quantity| {
        !answered.iter().any(|(_, _, (shown, _))| {
            shown.all_places().any(|(step, shown_quantity, mode)| {
                shown_quantity == *quantity && shown.get(step, shown_quantity, mode).is_some()
            })
        })
    });
    Ok(Report {
        echo: ready.echo.as_ref().map(|echo| *echo == echoed()),
        not_asked: selected.len() - asked.len(),
        hidden: hidden.collect(),
        ready,
        cases,
        diagnosis,
        remarks,
    })
}

/// What can be said of one answer, and what is shown with its reference if there is something to explain.
type JudgedAnswer = (CaseReport, Option<(Trace, Reference)>);

fn judge_answer(case: &Case, answer: Answer, ready: &Ready, conventions: &[&str]) -> Result<JudgedAnswer, Invalid> {
    let mut report = CaseReport::new(&case.problem);
    let expected = match &case.expected {
        Expected::Trace(trace) => trace,
        Expected::Rejection(class) => {
            report.outcome = match answer {
                Answer::Rejected { class: given, .. } => Outcome::Rejected {
                    other_class: (given != class.name()).then_some(given),
                },
                Answer::Skipped { reason } => Outcome::Skipped { reason },
                // Values of any shape are values: the problem was run.
                Answer::Steps { .. } | Answer::Broken(Broken::Invalid(_)) => Outcome::NotRejected,
                Answer::Broken(broken) => Outcome::Broken(broken),
            };
            return Ok((report, None));
        }
    };
    report.of = expected.count();
    let (shown, error) = match shown_by(answer, report.dimensions) {
        Ok(shown) => shown,
        Err(outcome) => {
            report.outcome = outcome;
            return Ok((report, None));
        }
    };
    let reference = reference_of(case, expected, conventions, ready.precision)?;
    let judgement = judge::Case {
        problem: &case.problem,
        shown: &shown,
        reference: &reference,
        precision: ready.precision,
    }
    .judge(conventions)?;
    let is_drowned = error.is_some() && stops_where_noise_drowns(&shown, &reference);
    summarise(&mut report, &judgement, error, is_drowned);
    report.judgement = Some(judgement);
    Ok((report, Some((shown, reference))))
}

/// What an answer to a good problem shows, with the error if it stopped; or the outcome where there is nothing to be judged.
fn shown_by(answer: Answer, dimensions: Dimensions) -> Result<(Trace, Option<String>), Outcome> {
    match answer {
        Answer::Steps { trace, error } => match trace.check(dimensions) {
            Ok(()) => Ok((trace, error)),
            Err(invalid) => Err(Outcome::Broken(Broken::Invalid(invalid))),
        },
        Answer::Skipped { reason } => Err(Outcome::Skipped { reason }),
        Answer::Rejected { reason, .. } => Err(Outcome::WronglyRejected { reason }),
        Answer::Broken(broken) => Err(Outcome::Broken(broken)),
    }
}

/// The references of cases that were asked for before, by id and unit roundoff.
static REFERENCES: Mutex<BTreeMap<(String, u64), Reference>> = Mutex::new(BTreeMap::new());

/// What a case is judged by. Without declared conventions it is always the same, and kept.
fn reference_of(
    case: &Case,
    expected: &Trace,
    conventions: &[&str],
    precision: Precision,
) -> Result<Reference, Invalid> {
    if !conventions.is_empty() {
        return Reference::new(&case.problem, None, conventions, precision);
    }
    let key = (case.problem.id.clone(), precision.unit_roundoff().to_bits());
    let kept = || REFERENCES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(reference) = kept().get(&key) {
        return Ok(reference.clone());
    }
    let reference = Reference::new(&case.problem, Some(expected), &[], precision)?;
    kept().insert(key, reference.clone());
    Ok(reference)
}

/// Whether a program stopped in a step in which rounding in its precision is as large as a value: no program could be sure to go on.
fn stops_where_noise_drowns(shown: &Trace, reference: &Reference) -> bool {
    let is_there = |place: &(usize, Quantity, usize)| shown.get(place.0, place.1, place.2).is_some();
    let last = shown
        .all_places()
        .filter(is_there)
        .map(|place| place.0)
        .max()
        .unwrap_or(0);
    let steps = last.max(1)..=(last + 1).min(shown.dimensions.steps);
    let mut places = steps.flat_map(|step| shown.places(step));
    places.any(|place| reference.is_drowned(place))
}

/// Outcome, counts and digits from the judged values.
fn summarise(report: &mut CaseReport, judgement: &Judgement, error: Option<String>, is_drowned: bool) {
    let findings = || judgement.values.iter().map(|value| value.finding);
    let decided = |finding: &Finding| {
        matches!(
            finding,
            Finding::Right | Finding::Propagated | Finding::Fault | Finding::NotFinite
        )
    };
    report.judged = findings().filter(decided).count();
    report.digits = judgement
        .values
        .iter()
        .filter(|value| value.finding == Finding::Right)
        .map(|value| -libm::log10(value.error.max(f64::EPSILON / 2.0)))
        .reduce(f64::min);
    report.stopped.clone_from(&error);
    report.outcome = if findings().any(|finding| matches!(finding, Finding::Fault | Finding::NotFinite)) {
        Outcome::Wrong
    } else if let Some(reason) = error.filter(|_| !is_drowned) {
        Outcome::Stopped { reason }
    } else if is_drowned {
        Outcome::CannotTell
    } else if judgement.values.is_empty() {
        Outcome::NothingShown
    } else if report.judged == 0 {
        Outcome::CannotTell
    } else {
        Outcome::Right
    };
}

fn evidence_of<'a>(
    report: &CaseReport,
    case: &'a Case,
    shown: &'a Trace,
    reference: &'a Reference,
    ready: &Ready,
) -> Evidence<'a> {
    let values = report.judgement.iter().flat_map(|judgement| &judgement.values);
    let says_nothing = |value: &&Judged| match value.finding {
        Finding::Stale | Finding::CannotTell => true,
        Finding::NotFinite => false,
        Finding::Right => value.own.is_none_or(|own| own.ratio > LIMIT),
        _ => value.own.is_none(),
    };
    let passed: BTreeSet<_> = values.filter(says_nothing).map(|value| value.place).collect();
    Evidence {
        case: judge::Case {
            problem: &case.problem,
            shown,
            reference,
            precision: ready.precision,
        },
        passed,
        is_faulty: report.outcome == Outcome::Wrong,
    }
}
