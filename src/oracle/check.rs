//! The check of a program under test over the published cases.
//!
//! First comes the echo, then each case for the program's kinds of filter. If anything is faulty, the diagnosis looks for the cause.

use super::again::ask_again;
use super::behaviour::{NotAsked, Unasked};
use super::case::{self, BadCase, Case, Expected};
use super::certify::certified_as_far_as_it_goes;
use super::evidence::{Answered, explain, explain_first_faults};
use super::invalid::Invalid;
use super::judge::{self, Reference};
use super::observation::observe;
use super::problem::{FORMAT, FORMAT_2, ProblemFile, kinds};
use super::subject::{Answer, Broken, Precision, Ready, Subject, echoed};
use super::trace::{Dimensions, Trace};
use super::variant::{Variant, catalogue};
pub use super::verdict::{CaseReport, Outcome, Report};
use crate::imm::{Needs, Quantity};
use crate::model::nearest::nearest;
use std::collections::BTreeMap;
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
            && any(&self.kinds, &|kind| problem.kinds().contains(&kind.as_str()))
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
    /// A kind of filter, or a format, that is not known.
    #[error("the program declares the {what} {name:?}, which does not exist{}", .nearest.as_ref().map_or_else(String::new, |near| format!("; the nearest is `{near}`")))]
    Unknown {
        /// Kind or format.
        what: &'static str,
        /// Its name.
        name: String,
        /// The nearest name that there is, if one is near.
        nearest: Option<String>,
    },
    /// The selection is empty.
    #[error("no case matches the selection")]
    NoCase,
    /// A problem that cannot be set up.
    #[error("{0}")]
    Problem(#[from] Invalid),
    /// A problem of the user is wrong.
    #[error("`{id}`: {invalid}")]
    OwnProblem {
        /// Its id.
        id: String,
        /// What is wrong.
        invalid: Invalid,
    },
    /// Two problems have the same id.
    #[error("two problems have the id `{0}`, so their answers could not be distinguished")]
    SameId(String),
    /// The subject was interrupted.
    #[error("the check was interrupted")]
    Interrupted,
}

/// Every declared name is one that there is.
pub(super) fn check_known(what: &'static str, declared: Option<&Vec<String>>, known: Vec<&str>) -> Result<(), NotMade> {
    let is_unknown = |name: &&String| !known.contains(&name.as_str());
    match declared.into_iter().flatten().find(is_unknown) {
        None => Ok(()),
        Some(name) => Err(NotMade::Unknown {
            what,
            name: name.clone(),
            nearest: nearest(name, known),
        }),
    }
}

/// The variants by which a program that declares conventions is judged.
pub(super) fn declared(ready: &Ready) -> Result<Vec<&'static str>, NotMade> {
    check_known("kind of filter", ready.kinds.as_ref(), kinds().collect())?;
    check_known("format", ready.formats.as_ref(), vec![FORMAT, FORMAT_2])?;
    let ids = ready.conventions.iter().map(|(key, value)| convention(key, value));
    Ok(ids.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
}

/// The variant of a declared convention; none of one that the papers have.
///
/// # Errors
///
/// [`NotMade::Convention`] for one that there is not.
pub fn convention(key: &str, value: &str) -> Result<Option<&'static str>, NotMade> {
    if super::problem::Conventions::default().has(key, value) {
        return Ok(None);
    }
    let of = |variant: &'static Variant| variant.convention.as_deref().zip(variant.value.as_deref());
    let mut variants = catalogue().iter();
    if let Some(variant) = variants.find(|variant| of(variant) == Some((key, value))) {
        return Ok(Some(&variant.id));
    }
    let all = catalogue().iter().filter_map(of);
    let known: Vec<String> = all.map(|(key, value)| format!("`{key}`: {value:?}")).collect();
    Err(NotMade::Convention {
        key: key.to_owned(),
        value: value.to_owned(),
        known: known.join(", "),
    })
}

/// Checks a program on the selected cases; `progress` is called after each case.
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
    let (selected, others): (Vec<&Case>, Vec<&Case>) = case::all()?.iter().partition(|case| selection.has(case));
    let questions: Vec<Question> = selected.into_iter().map(Question::Published).collect();
    if questions.is_empty() {
        return Err(NotMade::NoCase);
    }
    let others = others
        .into_iter()
        .map(|case| NotAsked::of(&case.problem, Unasked::Selection));
    let mut report = ask(subject, &questions, progress)?;
    report.not_asked.extend(others);
    Ok(report)
}

/// Checks a program over problems that are not published; each is certified first, as far as that goes.
///
/// Example: a problem of one's own, here a published one under another name, and this crate's own filter.
///
/// ```
/// use immaculate::oracle::case;
/// use immaculate::oracle::check::check_problems;
/// use immaculate::oracle::subject::{Level, Planted};
///
/// let case = case::all().unwrap().iter().find(|case| case.problem.id == "step.n4-m2.two-modes").unwrap();
/// let mut problem = case.problem.clone();
/// problem.id = "mine".into();
/// let mut program = Planted { variants: vec!["innovation-reversed".into()], level: Level::Everything };
/// let report = check_problems(&mut program, &[problem], &|_| {}).unwrap();
/// assert!(report.is_wrong());
/// assert_eq!(report.cases[0].certified, Some(1)); // its one step
/// ```
///
/// # Errors
///
/// [`NotMade`] when the check cannot be made; so it is for a problem that is wrong.
pub fn check_problems(
    subject: &mut dyn Subject,
    problems: &[ProblemFile],
    progress: &dyn Fn(&str),
) -> Result<Report, NotMade> {
    let mut questions = Vec::with_capacity(problems.len());
    for (index, problem) in problems.iter().enumerate() {
        if problems[..index].iter().any(|other| other.id == problem.id) {
            return Err(NotMade::SameId(problem.id.clone()));
        }
        let (trace, steps) = certified_as_far_as_it_goes(problem).map_err(|invalid| NotMade::OwnProblem {
            id: problem.id.clone(),
            invalid,
        })?;
        questions.push(Question::Own {
            problem,
            expected: Expected::Trace(trace),
            steps,
        });
    }
    if questions.is_empty() {
        return Err(NotMade::NoCase);
    }
    ask(subject, &questions, progress)
}

/// A problem that a program is asked, with what is expected.
pub(super) enum Question<'a> {
    /// A published case.
    Published(&'a Case),
    /// A problem of the user, certified up to a step.
    Own {
        problem: &'a ProblemFile,
        expected: Expected,
        steps: usize,
    },
}

impl Question<'_> {
    fn problem(&self) -> &ProblemFile {
        match self {
            Self::Published(case) => &case.problem,
            Self::Own { problem, .. } => problem,
        }
    }

    fn expected(&self) -> &Expected {
        match self {
            Self::Published(case) => &case.expected,
            Self::Own { expected, .. } => expected,
        }
    }

    /// Why a program with these filters and formats is not asked it. A problem of the user is asked in whatever format it has.
    fn why_not(&self, ready: &Ready) -> Option<Unasked> {
        let is_known = |kind: &str| {
            ready
                .kinds
                .as_ref()
                .is_none_or(|kinds| kinds.iter().any(|known| known == kind))
        };
        let is_read = match self {
            Self::Own { .. } => true,
            Self::Published(case) => {
                let formats = ready.formats.as_ref();
                formats.is_none_or(|formats| formats.contains(&case.problem.format))
            }
        };
        match self.expected() {
            Expected::Rejection(_) => (!ready.validates).then_some(Unasked::Validation),
            Expected::Trace(_) if !self.problem().kinds().into_iter().all(is_known) => Some(Unasked::Kind),
            Expected::Trace(_) => (!is_read).then_some(Unasked::Format),
        }
    }
}

/// The questions that a program is asked, and those that it is not.
fn asked_of<'a, 'b>(ready: &Ready, questions: &'b [Question<'a>]) -> (Vec<&'b Question<'a>>, Vec<NotAsked>) {
    let (mut asked, mut others) = (Vec::new(), Vec::new());
    for question in questions {
        match question.why_not(ready) {
            None => asked.push(question),
            Some(why) => others.push(NotAsked::of(question.problem(), why)),
        }
    }
    (asked, others)
}

/// Asks a program, and judges its answers.
fn ask(subject: &mut dyn Subject, questions: &[Question], progress: &dyn Fn(&str)) -> Result<Report, NotMade> {
    let ready = subject.start()?;
    let conventions = declared(&ready)?;
    let (asked, others) = asked_of(&ready, questions);
    let mut answered = Vec::new();
    let mut cases = Vec::new();
    for question in &asked {
        let problem = question.problem();
        let answer = subject.run(problem);
        if subject.is_interrupted() {
            return Err(NotMade::Interrupted);
        }
        let (report, shown) = judge_answer(question, answer, &ready, &conventions)?;
        if let Some((shown, reference)) = shown {
            answered.push(Answered {
                index: cases.len(),
                problem,
                shown,
                reference,
            });
        }
        cases.push(report);
        progress(&problem.id);
    }
    let is_right = |index: usize, answer: Answer| {
        let (report, _) = judge_answer(asked[index], answer, &ready, &conventions)?;
        Ok(report.outcome == Outcome::Right)
    };
    let mut observations = observe(&answered, &cases, ready.precision, &conventions)?;
    let (of_asking_again, remarks) = ask_again(subject, &answered, &cases, &is_right)?;
    observations.extend(of_asking_again);
    let diagnosis = explain(&answered, &cases, &ready, &conventions, &observations)?;
    explain_first_faults(&mut cases, &answered, &ready, &conventions)?;
    let traces: Vec<&Trace> = answered.iter().map(|answered| &answered.shown).collect();
    let hidden = never_shown(&asked, &traces);
    Ok(Report {
        echo: ready.echo.as_ref().map(|echo| *echo == echoed()),
        not_asked: others,
        hidden,
        ready,
        cases,
        diagnosis,
        observations,
        remarks,
    })
}

/// The quantities that some problem has and no answer shows.
fn never_shown(asked: &[&Question], traces: &[&Trace]) -> Vec<Quantity> {
    let exists = |quantity: &Quantity| {
        asked.iter().any(|question| {
            let problem = question.problem();
            (0..problem.modes.len()).any(|mode| quantity.exists(|needed| problem.has(needed, mode)))
        })
    };
    let is_shown = |quantity: &Quantity| {
        traces.iter().any(|shown| {
            let mut places = shown.all_places();
            places.any(|(step, own, mode)| own == *quantity && shown.get(step, own, mode).is_some())
        })
    };
    let there = Quantity::ALL.into_iter().filter(exists);
    there.filter(|quantity| !is_shown(quantity)).collect()
}

/// What can be said of one answer, and what is shown with its reference if there is something to explain.
pub(super) type JudgedAnswer = (CaseReport, Option<(Trace, Reference)>);

pub(super) fn judge_answer(
    question: &Question,
    answer: Answer,
    ready: &Ready,
    conventions: &[&str],
) -> Result<JudgedAnswer, Invalid> {
    let problem = question.problem();
    let mut report = CaseReport::new(problem);
    if let Question::Own { steps, .. } = question {
        report.certified = Some(*steps);
    }
    let expected = match question.expected() {
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
    let (shown, error) = match shown_by(answer, &report.dimensions) {
        Ok(shown) => shown,
        Err(outcome) => {
            report.outcome = outcome;
            return Ok((report, None));
        }
    };
    let shown = that_it_has(problem, shown);
    let reference = match question {
        Question::Published(_) => reference_of(problem, expected, conventions, ready.precision)?,
        Question::Own { .. } => Reference::new(problem, Some(expected), conventions, ready.precision)?,
    };
    let judgement = judge::Case {
        problem,
        shown: &shown,
        reference: &reference,
        precision: ready.precision,
    }
    .judge(conventions)?;
    let is_drowned = error.is_some() && stops_where_noise_drowns(&shown, &reference);
    report.judged_as(judgement, error, is_drowned);
    Ok((report, Some((shown, reference))))
}

/// Of what is shown, the values that a problem has: a case that was published without some is not judged on them.
pub(super) fn that_it_has(problem: &ProblemFile, shown: Trace) -> Trace {
    if problem.lacks_consistency {
        return shown.without(Needs::Consistency);
    }
    shown
}

/// What an answer to a good problem shows, with the error if it stopped; or the outcome where there is nothing to be judged.
fn shown_by(answer: Answer, dimensions: &Dimensions) -> Result<(Trace, Option<String>), Outcome> {
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

/// What a published case is judged by. Without declared conventions it is always the same, and kept.
fn reference_of(
    problem: &ProblemFile,
    expected: &Trace,
    conventions: &[&str],
    precision: Precision,
) -> Result<Reference, Invalid> {
    if !conventions.is_empty() {
        return Reference::new(problem, None, conventions, precision);
    }
    let key = (problem.id.clone(), precision.unit_roundoff().to_bits());
    let kept = || REFERENCES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(reference) = kept().get(&key) {
        return Ok(reference.clone());
    }
    let reference = Reference::new(problem, Some(expected), &[], precision)?;
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
    let steps = last.max(1)..=(last + 1).min(shown.dimensions.steps());
    let mut places = steps.flat_map(|step| shown.places(step));
    places.any(|place| reference.is_drowned(place))
}
