//! The search for a formula that gives the values a program shows.
//!
//! A formula is accepted if it gives every shown number, to rounding, at faulty values where the right formula does not. It is better if
//! it also gives the values at which the right formula holds, and if it is closer to the right formula.

use super::edit::{Candidate, Names, candidates};
use super::fit::fitted;
use super::instance::{Along, Instance};
use super::right::{right, starts};
use super::solve::solved;
use super::tree::Tree;
use super::value::{With, by_rows};
use crate::imm::Quantity;
use crate::number::RandomRounding;
use crate::oracle::diagnose::Evidence;
use crate::oracle::invalid::Invalid;
use crate::oracle::judge::{Case, FAR, LIMIT, Place, Reference, compare};
use crate::oracle::noise::RUNS;
use crate::oracle::problem::ProblemFile;
use crate::oracle::run::run_in_doubles;
use crate::oracle::subject::Precision;
use rayon::prelude::*;

/// What a program computed for a quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct ComputedFormula {
    /// The quantity.
    pub quantity: Quantity,
    /// The filters for which it was computed so.
    pub filters: Vec<String>,
    /// The formula that gives what is shown.
    pub computed: String,
    /// The right one.
    pub right: String,
    /// The number of faulty values at which it gives the shown value.
    pub explains: usize,
    /// The number of faulty values.
    pub of: usize,
    /// Where it was computed and not elsewhere, if not everywhere.
    pub condition: Option<String>,
}

/// What a program computed in place of right formulas.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ComputedFormulas {
    /// Quantity by quantity, in the order in which they are computed.
    pub found: Vec<ComputedFormula>,
    /// Whether every faulty value is explained, and from values that are all shown: from hidden ones much can be explained.
    pub is_complete: bool,
}

/// This many faulty values are tried first; a formula that fails at one of them is dropped.
const PROBES: usize = 4;

/// At most this many values, faulty and right, are examined: in a long run, one step says the same as the next.
const VALUES: usize = 40;

/// A fitted number must reproduce at least this many shown numbers: any formula can be fitted to one or two.
const NUMBERS_OF_A_FIT: usize = 3;

/// The number of randomly rounded runs that show how far a candidate may be off.
const CANDIDATE_RUNS: u64 = 4;

/// Finds the formulas of the faulty quantities.
///
/// # Errors
///
/// [`Invalid`] for a problem that cannot be set up.
pub fn find(evidence: &[Evidence], conventions: &[&str]) -> Result<ComputedFormulas, Invalid> {
    let is_meant = |piece: &&Evidence| !is_told_by_its_beginning(piece, evidence);
    let pieces: Vec<&Evidence> = evidence.iter().filter(is_meant).collect();
    let runs = pieces.iter().map(|piece| along(piece, conventions));
    let runs: Vec<Along> = runs.collect::<Result<_, _>>()?;
    let mut groups: Vec<Group> = Vec::new();
    for (run, piece) in runs.iter().zip(pieces) {
        collect(run, piece, conventions, &mut groups)?;
    }
    groups.sort_by_key(|group| group.quantity);
    groups.retain(|group| group.instances.iter().any(|at| at.is_wrong));
    let mut fitting: Vec<Vec<Fitting>> = groups.iter().map(Group::fitting).collect();
    prefer_shared(&mut fitting);
    let pairs = groups.iter().zip(&fitting);
    let found: Vec<ComputedFormula> = pairs.filter_map(|(group, fitting)| group.explained(fitting)).collect();
    let is_complete = found.len() == groups.len()
        && found.iter().all(|found| found.explains == found.of)
        && groups.iter().all(Group::is_of_shown_values);
    Ok(ComputedFormulas {
        found: merged(found),
        is_complete,
    })
}

fn nearest(fitting: &[Fitting]) -> Option<&Fitting> {
    fitting.iter().min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// A definition that explains several quantities was more likely edited than several of them were.
fn prefer_shared(fitting: &mut [Vec<Fitting>]) {
    let shared: Vec<Vec<String>> = fitting
        .iter()
        .map(|group| group.iter().filter_map(Fitting::definition).collect())
        .collect();
    for one in fitting.iter_mut().flatten() {
        let Some(definition) = one.definition() else { continue };
        let others = shared
            .iter()
            .filter(|group| group.contains(&definition))
            .count()
            .saturating_sub(1);
        #[allow(clippy::cast_precision_loss, reason = "at most as many as there are quantities")]
        let worth = SHARED * others as f64;
        one.cost -= worth;
    }
}

/// What it is worth that a definition explains one more quantity: more than one edit is nearer than another, less than one edit.
const SHARED: f64 = 0.6;

/// One entry for what was computed alike by several filters.
fn merged(all: Vec<ComputedFormula>) -> Vec<ComputedFormula> {
    let mut merged: Vec<ComputedFormula> = Vec::new();
    for mut one in all {
        let is_alike = |other: &&mut ComputedFormula| {
            (other.quantity, &other.computed, &other.right, &other.condition)
                == (one.quantity, &one.computed, &one.right, &one.condition)
        };
        match merged.iter_mut().find(is_alike) {
            None => merged.push(one),
            Some(other) => {
                other.filters.append(&mut one.filters);
                other.filters.sort_unstable();
                other.filters.dedup();
                other.explains += one.explains;
                other.of += one.of;
            }
        }
    }
    merged
}

/// The right formulas that do not give what the equations give, on a run of the filter itself: there should be none. What has no formula
/// here is passed over.
///
/// # Errors
///
/// [`Invalid`] for a problem that cannot be set up.
pub fn unlike_the_equations(problem: &ProblemFile) -> Result<Vec<(Place, String)>, Invalid> {
    let (shown, _) = run_in_doubles(problem)?;
    let reference = Reference::new(problem, None, &[], Precision::Double)?;
    let case = Case {
        problem,
        shown: &shown,
        reference: &reference,
        precision: Precision::Double,
    };
    let run = along(&Evidence::of_right(case), &[])?;
    let mut unlike = Vec::new();
    let is_asked = |place: &Place| !reference.is_drowned(*place) && !reference.is_unused(*place);
    for place in shown.all_places().filter(is_asked) {
        let (step, quantity, mode) = place;
        if shown.get(step, quantity, mode).is_none() || run.steps.get(step).is_none_or(Option::is_none) {
            continue;
        }
        let at = Instance {
            run: &run,
            place,
            is_wrong: false,
        };
        let wrong = right(&at)
            .into_iter()
            .filter(|form| holds(form, With::default(), &at) != Some(true));
        unlike.extend(wrong.map(|form| (place, form.text(None))));
    }
    Ok(unlike)
}

/// Whether the beginning of the same run is among the evidence.
fn is_told_by_its_beginning(piece: &Evidence, evidence: &[Evidence]) -> bool {
    let id = &piece.case.problem.id;
    !piece.is_beginning
        && evidence
            .iter()
            .any(|other| other.is_beginning && other.case.problem.id == *id)
}

/// The right equations along a program's values.
pub(super) fn along<'a>(piece: &Evidence<'a>, conventions: &[&str]) -> Result<Along<'a>, Invalid> {
    let setup = piece.case.problem.setup_in_doubles()?.varied(conventions);
    let (steps, computed) = setup.steps_along(piece.case.shown);
    Ok(Along {
        case: piece.case,
        steps,
        own: computed.in_doubles(),
        setup,
    })
}

/// The values of one quantity whose right formulas are the same.
struct Group<'a> {
    quantity: Quantity,
    forms: Vec<Tree>,
    starts: Vec<Tree>,
    instances: Vec<Instance<'a>>,
}

/// Sorts the values of a run into groups.
fn collect<'a>(
    run: &'a Along<'a>,
    piece: &Evidence,
    conventions: &[&str],
    groups: &mut Vec<Group<'a>>,
) -> Result<(), Invalid> {
    let runs = if piece.is_faulty { RUNS } else { 0 };
    let noise = run.case.run(conventions).noise(&run.own, runs)?;
    for place in run.case.shown.all_places() {
        let (step, quantity, mode) = place;
        let is_there = run.case.shown.finite(step, quantity, mode).is_some()
            && run.steps.get(step).is_some_and(Option::is_some)
            && !piece.passed.contains(&place);
        let Some(error) = run.case.error(place, &run.own, &noise).filter(|_| is_there) else {
            continue;
        };
        let is_wrong = piece.is_faulty && error.ratio > LIMIT;
        let at = Instance { run, place, is_wrong };
        let forms = right(&at);
        let is_same = |group: &&mut Group| group.quantity == quantity && group.forms == forms;
        match groups.iter_mut().find(is_same) {
            Some(group) => group.instances.push(at),
            None => groups.push(Group {
                quantity,
                starts: starts(&at),
                forms,
                instances: vec![at],
            }),
        }
    }
    Ok(())
}

/// A candidate that gives what is shown where it was tried.
struct Fitting {
    candidate: Candidate,
    number: Option<f64>,
    cost: f64,
}

impl Fitting {
    /// What was defined otherwise, in words.
    fn definition(&self) -> Option<String> {
        let (name, tree) = self.candidate.definition.as_ref()?;
        Some(format!("{} = {}", name.text(), tree.text(self.number)))
    }
}

impl Group<'_> {
    fn instances(&self, is_wrong: bool) -> impl Iterator<Item = &Instance<'_>> {
        self.instances.iter().filter(move |at| at.is_wrong == is_wrong)
    }

    /// The formulas that give what is shown.
    fn fitting(&self) -> Vec<Fitting> {
        let wrong = thinned(self.instances(true), VALUES);
        let right = thinned(self.instances(false), VALUES);
        let all: Vec<&Instance> = wrong.iter().chain(&right).copied().collect();
        let probes = thinned(wrong.iter().copied(), PROBES);
        let names = Names::of(&probes);
        let candidates = candidates(&self.forms, &self.starts, &names, probes[0]);
        let fitting = candidates
            .into_par_iter()
            .filter_map(|candidate| fit_all(candidate, &probes, &all));
        fitting.collect()
    }

    /// Whether all that the right formula is made of is shown, wherever a value is faulty.
    fn is_of_shown_values(&self) -> bool {
        let is_shown = |at: &Instance| self.forms.first().is_none_or(|form| at.shows_inputs_of(form));
        self.instances(true).all(is_shown)
    }

    /// The nearest formula that explains all; else the input that does, or what explains some.
    fn explained(&self, fitting: &[Fitting]) -> Option<ComputedFormula> {
        // What explains less than half is chance, or has no one cause.
        let found = nearest(fitting).map(|chosen| self.found(chosen));
        let found = found.filter(|found| 2 * found.explains >= found.of);
        if found.as_ref().is_some_and(|found| found.explains == found.of) {
            return found;
        }
        solved(&self.instances(true).collect::<Vec<_>>()).or(found)
    }

    /// What is said of the chosen one, counted over all values.
    fn found(&self, chosen: &Fitting) -> ComputedFormula {
        let with = chosen.candidate.with(chosen.number);
        let holds = |at: &&Instance| holds(&chosen.candidate.tree, with, at);
        let wrong: Vec<&Instance> = self.instances(true).collect();
        let right: Vec<&Instance> = self.instances(false).collect();
        let explains = wrong.iter().filter(|at| holds(at) == Some(true)).count();
        let is_elsewhere_too = !right.iter().any(|at| holds(at) == Some(false));
        let mut filters: Vec<String> = wrong.iter().map(|at| at.filter_name()).collect();
        filters.sort_unstable();
        filters.dedup();
        ComputedFormula {
            quantity: self.quantity,
            filters,
            computed: chosen.candidate.text(chosen.number),
            right: self.forms.first().map_or_else(String::new, |form| form.text(None)),
            explains,
            of: wrong.len(),
            condition: (!is_elsewhere_too).then(|| super::condition::condition(&wrong, &right)),
        }
    }
}

/// At most a given number, evenly from the first to the last.
fn thinned<'b, 'a: 'b>(all: impl Iterator<Item = &'b Instance<'a>>, most: usize) -> Vec<&'b Instance<'a>> {
    let all: Vec<&Instance> = all.collect();
    if all.len() <= most {
        return all;
    }
    (0..most)
        .map(|index| all[index * (all.len() - 1) / (most - 1)])
        .collect()
}

impl Candidate {
    pub(super) fn with(&self, number: Option<f64>) -> With<'_> {
        With {
            number,
            definition: self.definition.as_ref().map(|(name, tree)| (*name, tree)),
        }
    }

    fn text(&self, number: Option<f64>) -> String {
        match &self.definition {
            None => self.tree.text(number),
            Some((name, tree)) => format!(
                "{}, where {} = {}",
                self.tree.text(None),
                name.text(),
                tree.text(number)
            ),
        }
    }
}

/// The candidate with its number, if it gives what is shown at all probes.
fn fit_all(candidate: Candidate, probes: &[&Instance], all: &[&Instance]) -> Option<Fitting> {
    let number = match candidate.start {
        None => None,
        Some(start) => Some(fitted(&candidate, start, probes)?),
    };
    let holds = |at: &&Instance| holds(&candidate.tree, candidate.with(number), at);
    let at_probes: Vec<Option<bool>> = probes.iter().map(holds).collect();
    if at_probes.contains(&Some(false)) || !at_probes.contains(&Some(true)) {
        return None;
    }
    let everywhere: Vec<Option<bool>> = all.iter().map(holds).collect();
    let given = all
        .iter()
        .zip(&everywhere)
        .filter(|(at, holds)| at.is_wrong && **holds == Some(true));
    let numbers: usize = given.filter_map(|(at, _)| at.shown_numbers()).map(<[f64]>::len).sum();
    if number.is_some() && numbers < NUMBERS_OF_A_FIT {
        return None;
    }
    let penalty = |is_wrong: bool| {
        let fails = all
            .iter()
            .zip(&everywhere)
            .any(|(at, holds)| at.is_wrong == is_wrong && *holds == Some(false));
        if fails { 3.0 } else { 0.0 }
    };
    let cost = candidate.cost + penalty(true) + penalty(false) + unknown(all, &everywhere);
    Some(Fitting {
        candidate,
        number,
        cost,
    })
}

/// What cannot be said of faulty values counts against a candidate.
#[allow(clippy::cast_precision_loss, reason = "at most a few dozens")]
fn unknown(all: &[&Instance], holds: &[Option<bool>]) -> f64 {
    let wrong = all.iter().zip(holds).filter(|(at, _)| at.is_wrong);
    let (none, some): (Vec<_>, Vec<_>) = wrong.partition(|(_, holds)| holds.is_none());
    2.0 * none.len() as f64 / (none.len() + some.len()).max(1) as f64
}

/// Whether a formula gives what is shown, to rounding; none where it has no value.
pub(super) fn holds(tree: &Tree, with: With, at: &Instance) -> Option<bool> {
    let exact = by_rows(&tree.matrix(at, with)?);
    let error = |noise: &[f64]| at.error(&exact, noise);
    let still = vec![0.0; exact.len()];
    let ratio = error(&still)?;
    if ratio <= LIMIT || ratio > FAR {
        return Some(ratio <= LIMIT);
    }
    let mut noise = still;
    for seed in 0..CANDIDATE_RUNS {
        let sample = RandomRounding::with(at.run.case.precision.unit_roundoff(), seed, || tree.matrix(at, with))?;
        for (noise, (sample, exact)) in noise.iter_mut().zip(by_rows(&sample).iter().zip(&exact)) {
            *noise = noise.max((sample - exact).abs());
        }
    }
    Some(error(&noise)? <= LIMIT)
}

impl Instance<'_> {
    /// What the program shows.
    pub(super) fn shown_numbers(&self) -> Option<&[f64]> {
        let (step, quantity, mode) = self.place;
        self.run.case.shown.get(step, quantity, mode).map(Vec::as_slice)
    }

    /// How far numbers are from what is shown, in noise; none where they are no numbers, or not as many. The noise is that of the formula
    /// or of the right one, whichever is greater: what is shown has some of its own.
    fn error(&self, numbers: &[f64], noise: &[f64]) -> Option<f64> {
        let (step, quantity, mode) = self.place;
        let (shown, reference) = (self.shown_numbers()?, self.run.case.reference);
        let scale = reference.scale.get(step, quantity, mode)?;
        let of_right = reference.noise.get(step, quantity, mode)?;
        let noise: Vec<f64> = noise.iter().zip(of_right).map(|(own, right)| own.max(*right)).collect();
        let is_alike = numbers.len() == shown.len() && numbers.iter().all(|number| number.is_finite());
        let turn = |index| reference.turns.has(self.place, index);
        is_alike.then(|| compare(shown, numbers, &noise, scale, self.run.case.precision, &turn).ratio)
    }

    /// The filter of the mode, or the filters of all.
    pub(super) fn filter_name(&self) -> String {
        let problem = self.run.case.problem;
        if self.place.1.is_of_mode() {
            problem.filter_of(self.place.2).name().to_owned()
        } else {
            problem.kinds().join(" + ")
        }
    }
}
