//! Judging the values of one case: each against the certified trace, and against its own equation on the program's own earlier values.
//!
//! A value is right, inherits an error, or is a fault:
//!
//! - an error within [`LIMIT`] times its rounding noise of the certified value is **right**;
//! - else, within as much of what its own equation gives on the program's own inputs, it is **propagated**: the error was made before;
//! - else it is a **fault** of this equation, or, where inputs are hidden, of one of the equations since the last shown values;
//! - unless these hidden values were under suspicion already: then it is **undetermined**;
//! - or it is of a mode of probability zero, which no output depends on: then it is **unused**;
//! - and where the noise is as large as the value's unit, nobody **can tell**.

use super::formula::Explanation;
use super::invalid::Invalid;
use super::noise;
use super::problem::ProblemFile;
pub use super::reference::Reference;
use super::reference::{Run, is_drowned};
use super::subject::Precision;
use super::trace::Trace;
use super::variant::{self, Kind};
use crate::imm::Needs;
use crate::imm::Quantity;
use crate::imm::record::Input;
use std::collections::BTreeSet;

/// An error larger than this multiple of the rounding noise cannot be rounding. Right filters with other algebra and precision stay below
/// about 12, other conventions start at some 200, mistakes at 10⁷ (measured over the published cases; see `tests/oracle.rs`).
pub const LIMIT: f64 = 100.0;

/// No noise is meant beyond so much of it; the spread of two runs is hardly ever a ten-thousandth of what eight would give.
pub(super) const FAR: f64 = 1e6;

/// A value of a trace: step, quantity, mode.
pub type Place = (usize, Quantity, usize);

/// What is known of a shown value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Finding {
    /// As certified.
    Right,
    /// As its own inputs have it; the error was made before.
    Propagated,
    /// Rounding noise as large as the value's unit.
    CannotTell,
    /// Built on hidden values that are under suspicion.
    Undetermined,
    /// Of a mode of probability zero: no output depends on it.
    Unused,
    /// Shown although there is none: no detection, or a covariance of a filter that has none.
    Stale,
    /// Not finite.
    NotFinite,
    /// Not what its equation gives.
    Fault,
}

impl Finding {
    /// Whether it is an error of the value's own equation.
    pub fn is_fault(self) -> bool {
        matches!(self, Self::Fault | Self::NotFinite)
    }
}

/// A shown value, judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// Which value.
    pub place: Place,
    /// The finding.
    pub finding: Finding,
    /// The greatest error of its numbers against the certified ones, in their scale.
    pub error: f64,
    /// The same against its own equation on the program's own inputs, with the number at which it is.
    pub own: Option<OwnError>,
    /// The quantities that were not shown between this value and the shown ones that it depends on.
    pub hidden: Vec<Quantity>,
    /// Of the first fault of each equation, the equation with the program's numbers in it.
    pub explained: Option<Explanation>,
}

/// The error of a value against its own equation on the program's own inputs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OwnError {
    /// Which number, by rows.
    pub index: usize,
    /// The number that is shown.
    pub shown: f64,
    /// The number that it should have been from the program's own inputs.
    pub expected: f64,
    /// The error in rounding noise.
    pub ratio: f64,
    /// The error in the number's scale.
    pub size: f64,
}

/// A judged case.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgement {
    /// All shown values in the order in which they are computed.
    pub values: Vec<Judged>,
    /// Steps that could not be evaluated on the program's own values, a sentence each: a covariance that is not positive definite, say.
    pub failures: Vec<String>,
}

impl Judgement {
    /// The faults, in the order in which they are computed.
    pub fn faults(&self) -> impl Iterator<Item = &Judged> {
        self.values.iter().filter(|value| value.finding.is_fault())
    }
}

/// The error of numbers against expected ones: the greatest in rounding noise, and where.
///
/// A quantity has one noise, in units of scale: the greatest of its numbers', and at least a unit roundoff. A number that happens to be
/// spared, because it is zero by structure or its errors cancel, is not spared in other algebra.
pub(super) fn compare(
    shown: &[f64],
    expected: &[f64],
    noise: &[f64],
    scale: &[f64],
    precision: Precision,
    turn: &dyn Fn(usize) -> bool,
) -> OwnError {
    let mut worst = OwnError {
        index: 0,
        shown: shown[0],
        expected: expected[0],
        ratio: -1.0,
        size: 0.0,
    };
    let noise = noise
        .iter()
        .zip(scale)
        .map(|(noise, scale)| noise / scale)
        .fold(precision.unit_roundoff(), f64::max);
    for index in 0..shown.len() {
        let mut error = (shown[index] - expected[index]).abs();
        if turn(index) {
            let turns = (error / (2.0 * std::f64::consts::PI)).round();
            error = (error - turns * 2.0 * std::f64::consts::PI).abs();
        }
        let least = (precision.unit_roundoff() * expected[index].abs()).max(precision.least_number());
        let ratio = if error == 0.0 {
            0.0
        } else {
            error / (noise * scale[index]).max(least)
        };
        // A value that should not be a number is not near any number.
        let ratio = if ratio.is_nan() { f64::INFINITY } else { ratio };
        if ratio > worst.ratio {
            worst = OwnError {
                index,
                shown: shown[index],
                expected: expected[index],
                ratio,
                size: error / scale[index],
            };
        }
    }
    worst
}

/// What is compared with what.
#[derive(Clone, Copy)]
pub struct Case<'a> {
    /// The problem.
    pub problem: &'a ProblemFile,
    /// What the program shows.
    pub shown: &'a Trace,
    /// What it is judged by.
    pub reference: &'a Reference,
    /// Its precision.
    pub precision: Precision,
}

impl Case<'_> {
    /// The error of a shown value against what is expected, in noise and in its scale; none where nothing is expected.
    pub(super) fn error(&self, place: Place, expected: &Trace, noise: &Trace) -> Option<OwnError> {
        let (step, quantity, mode) = place;
        let shown = self.shown.get(step, quantity, mode)?;
        let expected = expected.get(step, quantity, mode)?;
        let noise = noise.get(step, quantity, mode)?;
        let scale = self.reference.scale.get(step, quantity, mode)?;
        let turn = |index| self.reference.turns.has(place, index);
        Some(compare(shown, expected, noise, scale, self.precision, &turn))
    }

    /// Whether a shown value is as certified.
    pub(super) fn is_right(&self, place: Place) -> bool {
        let error = self.error(place, &self.reference.trace, &self.reference.noise);
        error.is_some_and(|error| error.ratio <= LIMIT)
    }

    /// Judges all shown values.
    ///
    /// # Errors
    ///
    /// [`Invalid`] for a problem that cannot be set up.
    pub fn judge(&self, conventions: &[&str]) -> Result<Judgement, Invalid> {
        let run = self.run(conventions);
        let (own, failures) = run.values()?;
        // What a program computes as this one does has no error, whatever the noise; it is measured for the others.
        let none = run.noise(&own, 0)?;
        let is_exact = self.is_within(0.0, &own, &none, &|_| true)
            && !self.shown.all_places().any(|place| self.reference.is_drowned(place));
        let noise = if is_exact { none } else { run.noise(&own, noise::RUNS)? };
        let mut values = Vec::new();
        let mut suspects = BTreeSet::new();
        for place in self.shown.all_places() {
            let (step, quantity, mode) = place;
            if self.shown.get(step, quantity, mode).is_none() {
                continue;
            }
            let (hidden, last_shown) = inputs(self.problem, self.shown, place);
            let against_certified = self.error(place, &self.reference.trace, &self.reference.noise);
            let against_own = self.error(place, &own, &noise);
            let is_right = against_certified.is_some_and(|error| error.ratio <= LIMIT);
            let is_inherited = against_own.is_some_and(|error| error.ratio <= LIMIT);
            let finding = if self.reference.trace.get(step, quantity, mode).is_none() {
                Finding::Stale
            } else if self.shown.finite(step, quantity, mode).is_none() {
                let is_finite = |&(step, input, mode): &Place| self.shown.finite(step, input, mode).is_some();
                if last_shown.iter().all(is_finite) {
                    Finding::NotFinite
                } else {
                    Finding::Propagated
                }
            } else if self.reference.is_drowned(place) && (is_right || is_drowned(place, &noise, &self.reference.scale))
            {
                Finding::CannotTell
            } else if is_right {
                Finding::Right
            } else if is_inherited {
                Finding::Propagated
            } else if self.reference.is_unused(place) {
                Finding::Unused
            } else if against_own.is_none() || hidden.iter().any(|place| suspects.contains(place)) {
                Finding::Undetermined
            } else {
                Finding::Fault
            };
            if finding.is_fault() {
                suspects.extend(hidden.iter().copied());
            }
            let mut names: Vec<Quantity> = hidden.iter().map(|place| place.1).collect();
            names.sort_unstable();
            names.dedup();
            values.push(Judged {
                place,
                finding,
                error: against_certified.map_or(f64::NAN, |error| error.size),
                own: against_own,
                hidden: names,
                explained: None,
            });
        }
        Ok(Judgement { values, failures })
    }

    /// Whether the equations with these variants explain all shown values from the program's own; places in `passed` are passed over.
    ///
    /// # Errors
    ///
    /// [`Invalid`] for a problem that cannot be set up.
    pub fn is_explained_by(&self, variants: &[&str], passed: &BTreeSet<Place>) -> Result<bool, Invalid> {
        self.is_explained(variants, &|place| !passed.contains(place))
    }

    /// Whether the equations with these variants explain all shown values of one quantity.
    ///
    /// # Errors
    ///
    /// [`Invalid`] for a problem that cannot be set up.
    pub fn is_quantity_explained_by(
        &self,
        variants: &[&str],
        quantity: Quantity,
        passed: &BTreeSet<Place>,
    ) -> Result<bool, Invalid> {
        self.is_explained(variants, &|place| place.1 == quantity && !passed.contains(place))
    }

    /// Noise is measured as far as it matters: an error that is small without it is small with it, and most variants are far off, which
    /// two runs show.
    fn is_explained(&self, variants: &[&str], is_asked: &dyn Fn(&Place) -> bool) -> Result<bool, Invalid> {
        let run = self.run(variants);
        let (own, _) = run.values()?;
        let is_asked = |place: &Place| is_asked(place) && self.shown.get(place.0, place.1, place.2).is_some();
        if self.has_no_answer(&is_asked)? {
            return Ok(false);
        }
        let is_form = |id: &&str| variant::find(id).is_some_and(|variant| variant.kind == Kind::Form);
        let has_form = variants.iter().any(is_form);
        let is_within = |limit, runs| {
            let noise = run.noise(&own, runs)?;
            let runs_away = |place: Place| has_form && is_asked(&place) && self.runs_away(place, &own, &noise);
            Ok(self.is_within(limit, &own, &noise, &is_asked) && !self.shown.all_places().any(runs_away))
        };
        Ok(is_within(LIMIT, 0)? || is_within(FAR, 2)? && is_within(LIMIT, noise::RUNS)?)
    }

    /// Whether nothing needs an explanation but values that are not finite where the equations as they are have no answer either: whatever
    /// leaves these as they are would explain them.
    fn has_no_answer(&self, is_asked: &dyn Fn(&Place) -> bool) -> Result<bool, Invalid> {
        let is_gap = |place: &Place| is_asked(place) && self.shown.finite(place.0, place.1, place.2).is_none();
        if !self.shown.all_places().any(|place| is_gap(&place)) {
            return Ok(false);
        }
        let run = self.run(&[]);
        let (own, _) = run.values()?;
        let has_answer = |place: &Place| own.finite(place.0, place.1, place.2).is_some();
        if self
            .shown
            .all_places()
            .all(|place| !is_gap(&place) || has_answer(&place))
        {
            return Ok(false);
        }
        Ok(self.is_within(LIMIT, &own, &run.noise(&own, noise::RUNS)?, is_asked))
    }

    /// Whether a shown value is beyond what a form may excuse, which is rounding: it is not finite; or the form's noise is as large as the
    /// value's unit, so that it would excuse anything, and the value is off by more than rounding that is not ([`Reference::is_drowned`]).
    fn runs_away(&self, place: Place, own: &Trace, noise: &Trace) -> bool {
        self.shown.finite(place.0, place.1, place.2).is_none()
            || is_drowned(place, noise, &self.reference.scale)
                && self
                    .error(place, own, noise)
                    .is_some_and(|error| LIMIT * error.size > 1.0)
    }

    /// Whether the equations with these variants are so far off in the first steps that no noise can be meant: those up to the first fault,
    /// until which the program was right, and the noise is about that of the right filter.
    ///
    /// # Errors
    ///
    /// [`Invalid`] for a problem that cannot be set up.
    pub fn is_far_off(&self, variants: &[&str], passed: &BTreeSet<Place>, steps: usize) -> Result<bool, Invalid> {
        let (own, _) = self.run(variants).values()?;
        let is_asked = |place: &Place| place.0 <= steps && !passed.contains(place);
        Ok(!self.is_within(FAR, &own, &self.reference.noise, &is_asked))
    }

    /// The run along the shown values.
    pub(super) fn run<'b>(&'b self, variants: &'b [&'b str]) -> Run<'b> {
        Run {
            problem: self.problem,
            variants,
            shown: Some(self.shown),
            precision: self.precision,
        }
    }

    /// Whether shown values are so near to own ones, in units of noise.
    fn is_within(&self, limit: f64, own: &Trace, noise: &Trace, is_asked: &dyn Fn(&Place) -> bool) -> bool {
        let is_shown = |place: &Place| self.shown.get(place.0, place.1, place.2).is_some();
        let is_within = |place: Place| {
            let (step, quantity, mode) = place;
            if self.shown.finite(step, quantity, mode).is_none() {
                // What is not finite is explained by equations that have no answer either.
                return own.finite(step, quantity, mode).is_none();
            }
            self.error(place, own, noise).is_some_and(|error| error.ratio <= limit)
        };
        let mut places = self.shown.all_places();
        places.all(|place| !is_shown(&place) || !is_asked(&place) || is_within(place))
    }
}

/// The values that one depends on: the hidden ones between it and the last shown ones, and these.
fn inputs(problem: &ProblemFile, shown: &Trace, place: Place) -> (BTreeSet<Place>, BTreeSet<Place>) {
    let r = shown.dimensions.r;
    let has_detection = |step: usize| {
        problem
            .measurements
            .get(step - 1)
            .is_some_and(|entry| entry.z.is_some())
    };
    let knows_truth = |step: usize| {
        problem
            .measurements
            .get(step - 1)
            .is_some_and(|entry| entry.truth.is_some())
    };
    let needed_is_there = |step: usize, mode: usize, needed: Needs| match needed {
        Needs::Detection => has_detection(step),
        Needs::Truth => knows_truth(step),
        _ => problem.has(needed, mode),
    };
    let (mut hidden, mut last_shown) = (BTreeSet::new(), BTreeSet::new());
    let mut open = vec![place];
    while let Some((step, quantity, mode)) = open.pop() {
        for input in quantity.inputs(|needed| needed_is_there(step, mode, needed)) {
            let (step, input, is_before) = match input {
                Input::Now(input) => (step, input, false),
                Input::Before(input) if step > 1 => (step - 1, input, true),
                Input::Before(_) => continue,
            };
            let modes = match (input.is_of_mode(), quantity.is_of_mode() && !is_before) {
                (true, true) => mode..mode + 1,
                (true, false) => 0..r,
                (false, _) => 0..1,
            };
            for mode in modes {
                let next = (step, input, mode);
                if shown.get(step, input, mode).is_some() {
                    last_shown.insert(next);
                } else if hidden.insert(next) {
                    open.push(next);
                }
            }
        }
    }
    (hidden, last_shown)
}
