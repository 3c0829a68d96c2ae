//! Shrinking: reduces a problem on which a program fails to the smallest one on which it fails in the same way.
//!
//! Every problem that is tried is smaller than the one before, so shrinking ends by itself. It ends earlier if its tries or its time are
//! used up.

use super::asked::{Asked, Certified, Symptom};
use super::size::Size;
use super::{reduce, simplify};
use crate::oracle::check::NotMade;
use crate::oracle::problem::ProblemFile;
use std::time::{Duration, Instant};

/// How long shrinking may take.
#[derive(Debug, Clone, Copy)]
pub struct ShrinkingLimits {
    /// The most problems that are asked.
    pub tries: usize,
    /// The longest time.
    pub time: Duration,
}

/// How it went.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Shrinking {
    /// The number of problems that were asked.
    pub tries: usize,
    /// What was used up before nothing could be left out any more.
    pub cut_short: Option<&'static str>,
}

/// All ways to make a problem smaller, the greatest steps first.
const STAGES: [fn(&ProblemFile) -> Vec<ProblemFile>; 7] = [
    reduce::steps,
    reduce::modes,
    reduce::components,
    reduce::measured,
    reduce::extras,
    simplify::wholes,
    simplify::numbers,
];

/// The problems of a stage that are smaller.
fn smaller(problem: &ProblemFile, stage: fn(&ProblemFile) -> Vec<ProblemFile>) -> Vec<ProblemFile> {
    let size = Size::of(problem);
    let mut smaller = stage(problem);
    smaller.retain(|candidate| Size::of(candidate) < size);
    smaller
}

/// The problems that shrinking tries in place of one, in its order. Not all of them are good problems.
pub fn reductions(problem: &ProblemFile) -> Vec<ProblemFile> {
    STAGES.iter().flat_map(|stage| smaller(problem, *stage)).collect()
}

/// Makes a problem smaller as long as a program fails in the same way; all problems on the way, the smallest last.
///
/// # Errors
///
/// [`NotMade`] as when the program is asked.
pub(super) fn shrink(
    asked: &mut Asked,
    from: &ProblemFile,
    failure: &Symptom,
    effort: ShrinkingLimits,
    progress: &dyn Fn(&str),
) -> Result<(Vec<ProblemFile>, Shrinking), NotMade> {
    let start = Instant::now();
    let is_fair = Certified::of(from.clone()).is_some_and(|certified| certified.is_fair());
    let (mut way, mut shrinking) = (vec![from.clone()], Shrinking::default());
    let mut current = from.clone();
    loop {
        let before = way.len();
        for stage in STAGES {
            let (mut candidates, mut next) = (smaller(&current, stage), 0);
            while let Some(candidate) = candidates.get(next) {
                if shrinking.tries >= effort.tries || start.elapsed() >= effort.time {
                    let cut = if shrinking.tries >= effort.tries {
                        "tries"
                    } else {
                        "time"
                    };
                    shrinking.cut_short = Some(cut);
                    return Ok((way, shrinking));
                }
                let mut tried = candidate.clone();
                tried.id = format!("{}-{}", from.id, shrinking.tries + 1);
                if fails(asked, tried, failure, is_fair, &mut shrinking)? {
                    current = candidate.clone();
                    way.push(current.clone());
                    progress(&format!("shrinking: {}, {} tries", in_words(&current), shrinking.tries));
                    candidates = smaller(&current, stage);
                } else {
                    next += 1;
                }
            }
        }
        if way.len() == before {
            return Ok((way, shrinking));
        }
    }
}

/// Whether a program fails on a problem in this way; a problem that cannot be certified, or is less fair than the first, is not asked.
fn fails(
    asked: &mut Asked,
    problem: ProblemFile,
    failure: &Symptom,
    is_fair: bool,
    shrinking: &mut Shrinking,
) -> Result<bool, NotMade> {
    let Some(certified) = Certified::of(problem).filter(|certified| !is_fair || certified.is_fair()) else {
        return Ok(false);
    };
    shrinking.tries += 1;
    let case = asked.ask(&certified)?;
    Ok(Symptom::of(&case).as_ref() == Some(failure))
}

/// A number of things.
pub fn count(number: usize, one: &str) -> String {
    let ending = if number == 1 { "" } else { "s" };
    format!("{number} {one}{ending}")
}

/// What is left of a problem.
pub fn in_words(problem: &ProblemFile) -> String {
    let measured = problem
        .sensors_at()
        .iter()
        .map(|sensor| sensor.noise.len())
        .max()
        .unwrap_or(0);
    format!(
        "{}, {}, {}, {measured} measured",
        count(problem.measurements.len(), "step"),
        count(problem.modes.len(), "mode"),
        count(problem.state.len(), "component"),
    )
}
