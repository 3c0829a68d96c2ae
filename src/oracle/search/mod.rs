//! The search for a problem on which a program fails, and for the smallest such problem.
//!
//! ```text
//! seed, number ─▶ scene ─▶ event ─▶ certified, fair? ─▶ asked and judged ─▶ failed? ─▶ shrink ─▶ checked with a diagnosis
//! own problem  ─▶ around ───────────┘
//! ```
//!
//! - `scene`: modes, estimates, sensor; `event`: measurements, and what every filter must bear; `around`: a given problem, changed;
//! - `draw`: random numbers; `place`: the numbers of a problem by what they are;
//! - `asked`: certifying, asking, judging, and what counts as a failure;
//! - `size`, `reduce`, `simplify`, `shrink`: how a problem becomes smaller.
//!
//! Shrinking works on the problem file and not on the random choices behind it, as libraries for random tests do: a component of the state
//! is a row and a column of every matrix at once, a problem of a user was never drawn, and what is left has to be a file that a person
//! reads. A list of reductions says that in less than a tree of strategies would.

mod around;
mod asked;
mod draw;
mod event;
mod place;
mod reduce;
mod scene;
mod shrink;
mod simplify;
pub mod size;

pub use asked::Symptom;
pub use scene::Offer;
pub use shrink::{Shrinking, ShrinkingLimits, count, in_words, reductions};

use super::behaviour::Behaviour;
use super::check::{NotMade, Outcome, Report, check_known, check_problems};
use super::diagnose::Diagnosis;
use super::problem::{FORMAT_2, ProblemFile, kinds};
use super::subject::{Ready, Subject, echoed};
use super::variant::Variant;
use super::verdict::CaseReport;
use asked::{Asked, Certified};
use draw::Draw;
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// What is searched for, and how long.
#[derive(Debug, Clone)]
pub struct Request {
    /// The seed of all problems.
    pub seed: u64,
    /// The longest time, without that of shrinking.
    pub time: Duration,
    /// The most problems that are drawn.
    pub most: u64,
    /// Only these kinds of filter; all where there is none.
    pub kinds: Vec<String>,
    /// The problems around which is searched; any problem where there is none.
    pub around: Vec<ProblemFile>,
    /// How long shrinking may take.
    pub shrinking: ShrinkingLimits,
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The number of the problem, of its seed.
    pub number: u64,
    /// How the program failed.
    pub failure: Symptom,
    /// The problem as it was drawn.
    pub drawn: ProblemFile,
    /// The verdict on it alone, of a program that was started anew: a larger problem may tell more of the cause.
    pub report_as_drawn: Report,
    /// The smallest problem.
    pub problem: ProblemFile,
    /// How it became so small.
    pub shrinking: Shrinking,
    /// The verdict on the smallest problem, likewise.
    pub report: Report,
}

/// How a search went.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Searched {
    /// What the program said of itself.
    pub ready: Ready,
    /// The seed.
    pub seed: u64,
    /// The number of judged problems, by kind of filter.
    pub kinds: BTreeMap<String, usize>,
    /// The number of judged problems with each behaviour.
    pub behaviours: BTreeMap<Behaviour, usize>,
    /// The number of judged problems.
    pub problems: usize,
    /// The number of judged values.
    pub values: usize,
    /// The number of draws that were not fair problems: they could not be certified, or are too nearly singular.
    pub dropped: usize,
    /// The number of problems that the program skipped.
    pub skipped: usize,
    /// The number that were not asked because the program had skipped similar ones.
    pub not_asked: usize,
    /// The number that drowned in rounding noise.
    pub cannot_tell: usize,
    /// The conventions and forms, not declared, by which answers were explained; by them the program was judged from then on.
    pub otherwise: Vec<&'static Variant>,
    /// How long it took, without shrinking.
    pub time: Duration,
    /// What was found.
    pub found: Option<Found>,
}

impl Searched {
    /// Whether something is wrong: a failure, or the echo.
    pub fn is_wrong(&self) -> bool {
        self.found.is_some() || self.is_echo_wrong()
    }

    /// Whether the program gave an echo that is not right.
    pub fn is_echo_wrong(&self) -> bool {
        self.ready.echo.as_ref().is_some_and(|echo| *echo != echoed())
    }

    fn count(&mut self, case: &CaseReport, problem: &ProblemFile) {
        match case.outcome {
            Outcome::Skipped { .. } => self.skipped += 1,
            Outcome::CannotTell => self.cannot_tell += 1,
            _ => {
                self.problems += 1;
                self.values += case.judged;
                for kind in problem.kinds() {
                    *self.kinds.entry(kind.to_owned()).or_default() += 1;
                }
                for behaviour in &case.behaviours {
                    *self.behaviours.entry(*behaviour).or_default() += 1;
                }
            }
        }
    }
}

/// The random problem of a number, of a seed; nothing if the draw cannot be run, or nothing may be asked.
///
/// Example: the same number of the same seed is the same problem.
///
/// ```
/// use immaculate::oracle::search::{Offer, drawn};
///
/// let offer = Offer { kinds: vec!["kalman".into()], is_format_2: false };
/// assert_eq!(drawn(7, 3, &offer), drawn(7, 3, &offer));
/// assert_ne!(drawn(7, 3, &offer), drawn(7, 4, &offer));
/// ```
pub fn drawn(seed: u64, number: u64, offer: &Offer) -> Option<ProblemFile> {
    let mut draw = Draw::new(seed, number);
    let scene = scene::scene(&mut draw, offer)?;
    let problem = event::happen(&mut draw, scene, offer)?;
    problem.check().ok()?;
    Some(named(problem, seed, number))
}

/// The problem of a number around one of several; number 0 and so on are these themselves.
pub fn drawn_around(seed: u64, number: u64, problems: &[ProblemFile]) -> Option<ProblemFile> {
    let count = problems.len() as u64;
    let index = usize::try_from(number.checked_rem(count)?).ok()?;
    if number < count {
        return Some(named(problems[index].clone(), seed, number));
    }
    let changed = around::around(&mut Draw::new(seed, number), &problems[index])?;
    Some(named(changed, seed, number))
}

fn named(mut problem: ProblemFile, seed: u64, number: u64) -> ProblemFile {
    problem.id = format!("search-{seed}-{number}");
    problem.about = format!("Problem {number} of seed {seed}.");
    problem
}

/// Searches for a problem on which a program fails, and makes it small.
///
/// Example: the spread of the means is left out; one step of two modes of one number is enough to see it.
///
/// ```
/// use immaculate::oracle::search::{ShrinkingLimits, Request, search};
/// use immaculate::oracle::subject::{Level, Planted};
/// use std::time::Duration;
///
/// let mut program = Planted { variants: vec!["mixed-spread-omitted".into()], level: Level::Everything };
/// let time = Duration::from_secs(600);
/// let (kinds, around) = (vec!["kalman".into()], vec![]);
/// let request = Request { seed: 1, time, most: 100, kinds, around, shrinking: ShrinkingLimits { tries: 1000, time } };
/// let found = search(&mut program, &request, &|_| {}).unwrap().found.unwrap();
/// assert_eq!((found.problem.measurements.len(), found.problem.modes.len(), found.problem.state.len()), (1, 2, 1));
/// ```
///
/// # Errors
///
/// [`NotMade`] when the program cannot be used, or is offered nothing.
pub fn search(subject: &mut dyn Subject, request: &Request, progress: &dyn Fn(&str)) -> Result<Searched, NotMade> {
    check_known("kind of filter", Some(&request.kinds), kinds().collect())?;
    let mut asked = Asked::start(subject)?;
    let source = Source::of(request, offered(&asked.ready, &request.kinds))?;
    let start = Instant::now();
    let mut searched = Searched {
        ready: asked.ready.clone(),
        seed: request.seed,
        ..Searched::default()
    };
    let mut known = Known::default();
    for number in 0..request.most {
        searched.time = start.elapsed();
        if searched.time >= request.time {
            break;
        }
        let Some(certified) = source.problem(number) else {
            searched.dropped += 1;
            continue;
        };
        if !known.is_asked(&certified.problem, number) {
            searched.not_asked += 1;
            continue;
        }
        let case = asked.ask(&certified)?;
        known.learn(&certified.problem, &case.outcome);
        searched.count(&case, &certified.problem);
        progress(&count(searched.problems, "problem"));
        if let Some(failure) = Symptom::of(&case) {
            let problem = certified.problem;
            searched.found = follow(&mut asked, problem, number, failure, request, &mut searched, progress)?;
        }
        if searched.found.is_some() {
            break;
        }
    }
    asked.subject.stop();
    Ok(searched)
}

/// Where problems come from.
struct Source {
    seed: u64,
    offer: Offer,
    around: Vec<ProblemFile>,
    /// Whether only fair problems are asked: not so around problems that are not fair themselves.
    is_fair: bool,
}

impl Source {
    /// That of a request; it is a mistake to ask a program for what it does not have.
    fn of(request: &Request, offer: Offer) -> Result<Self, NotMade> {
        let is_offered = |problem: &&ProblemFile| {
            problem
                .kinds()
                .iter()
                .all(|kind| offer.kinds.iter().any(|own| own == kind))
        };
        let around: Vec<ProblemFile> = request.around.iter().filter(is_offered).cloned().collect();
        if offer.possible().is_empty() || around.is_empty() && !request.around.is_empty() {
            return Err(NotMade::NoCase);
        }
        let is_fair =
            |problem: &ProblemFile| Certified::of(problem.clone()).is_some_and(|certified| certified.is_fair());
        Ok(Self {
            seed: request.seed,
            is_fair: around.iter().all(is_fair),
            around,
            offer,
        })
    }

    /// The problem of a number; nothing if it is none that a program can be asked.
    fn problem(&self, number: u64) -> Option<Certified> {
        let problem = match &self.around[..] {
            [] => drawn(self.seed, number, &self.offer),
            problems => drawn_around(self.seed, number, problems),
        };
        Certified::of(problem?).filter(|certified| !self.is_fair || certified.is_fair())
    }
}

/// What a program may be asked for: what it declares, as far as it is wanted.
fn offered(ready: &Ready, wanted: &[String]) -> Offer {
    let is_declared = |kind: &str| {
        ready
            .kinds
            .as_ref()
            .is_none_or(|kinds| kinds.iter().any(|own| own == kind))
    };
    let is_wanted = |kind: &str| wanted.is_empty() || wanted.iter().any(|own| own == kind);
    let offered = kinds().filter(|kind| is_declared(kind) && is_wanted(kind));
    Offer {
        kinds: offered.map(str::to_owned).collect(),
        is_format_2: ready
            .formats
            .as_ref()
            .is_none_or(|formats| formats.iter().any(|format| format == FORMAT_2)),
    }
}

/// Follows a failure: is it one when the problem is asked alone, and is it no convention or form? Then it is made small. Nothing if the
/// answer is only otherwise; from then on the program is judged by that.
fn follow(
    asked: &mut Asked,
    drawn: ProblemFile,
    number: u64,
    failure: Symptom,
    request: &Request,
    searched: &mut Searched,
    progress: &dyn Fn(&str),
) -> Result<Option<Found>, NotMade> {
    progress("a failure: asking again");
    let report = alone(asked, &drawn)?;
    if report.is_excused() && !report.is_wrong() {
        for variant in explaining(&report.diagnosis) {
            if !asked.conventions.contains(&variant.id.as_str()) {
                asked.conventions.push(&variant.id);
                searched.otherwise.push(variant);
            }
        }
        asked.subject.start()?;
        return Ok(None);
    }
    let mut found = Found {
        number,
        failure,
        problem: drawn.clone(),
        drawn,
        shrinking: Shrinking::default(),
        report_as_drawn: report.clone(),
        report,
    };
    if found.report.is_wrong() {
        asked.subject.start()?;
        let (way, shrinking) = shrink::shrink(asked, &found.drawn, &found.failure, request.shrinking, progress)?;
        found.shrinking = shrinking;
        // The smallest may be so small that a convention explains it, too; then a larger one tells more.
        for mut problem in way.into_iter().skip(1).rev() {
            problem.flags.clear();
            problem.id.push_str("-shrunk");
            let report = alone(asked, &problem)?;
            if report.is_wrong() {
                (found.problem, found.report) = (problem, report);
                break;
            }
        }
    }
    Ok(Some(found))
}

/// The verdict on one problem, of a program that is started anew.
fn alone(asked: &mut Asked, problem: &ProblemFile) -> Result<Report, NotMade> {
    asked.subject.stop();
    check_problems(asked.subject, std::slice::from_ref(problem), &|_| {})
}

/// The variants of a diagnosis, the first of those that cannot be distinguished.
fn explaining(diagnosis: &Diagnosis) -> Vec<&'static Variant> {
    match diagnosis {
        Diagnosis::Nothing => vec![],
        Diagnosis::One(variants) => variants.iter().copied().take(1).collect(),
        Diagnosis::Several(members) => members.iter().filter_map(|member| member.first().copied()).collect(),
        Diagnosis::Pairs(pairs) => pairs.iter().take(1).flatten().copied().collect(),
        Diagnosis::ByFilter(filters) => filters
            .iter()
            .flat_map(|(_, of_filter)| explaining(of_filter))
            .collect(),
        Diagnosis::InParts { parts, .. } => parts.iter().filter_map(|part| part.variants.first().copied()).collect(),
    }
}

/// What a program has been seen to answer and to pass over.
#[derive(Default)]
struct Known {
    /// By what a problem has: how often it was answered, and how often passed over.
    seen: BTreeMap<String, (usize, usize)>,
}

/// After this many skipped problems with some feature and no answered one, the program is assumed not to have the feature.
const PATIENCE: usize = 3;

/// One in this many problems with a feature that the program seems to lack is asked anyway: perhaps something else was the reason.
const RARELY: u64 = 10;

impl Known {
    /// What may be the reason to pass over a problem: the kinds of its filters, what happens, its shape.
    fn features(problem: &ProblemFile) -> Vec<String> {
        let dimensions = problem.dimensions();
        let mut features: Vec<String> = problem.kinds().into_iter().map(str::to_owned).collect();
        features.extend(problem.flags.iter().cloned());
        features.push(problem.format.clone());
        for mode in &problem.modes {
            let models = [
                (mode.models.filter.is_some(), "filters of modes"),
                (mode.models.motion.is_some(), "named models"),
            ];
            features.extend(
                models
                    .into_iter()
                    .filter(|(is_there, _)| *is_there)
                    .map(|(_, name)| name.to_owned()),
            );
        }
        features.push(format!("{} components", dimensions.n));
        features.push(format!("{} measured", problem.noise.len()));
        features.push(format!("{} modes", dimensions.r));
        features
    }

    fn is_asked(&self, problem: &ProblemFile, number: u64) -> bool {
        let is_missing = |feature: &String| {
            self.seen
                .get(feature)
                .is_some_and(|seen| seen.0 == 0 && seen.1 >= PATIENCE)
        };
        number.is_multiple_of(RARELY) || !Self::features(problem).iter().any(is_missing)
    }

    fn learn(&mut self, problem: &ProblemFile, outcome: &Outcome) {
        for feature in Self::features(problem) {
            let (answered, skipped) = self.seen.entry(feature).or_default();
            match outcome {
                Outcome::Skipped { .. } => *skipped += 1,
                _ => *answered += 1,
            }
        }
    }
}
