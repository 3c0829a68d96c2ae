//! What was done: the variants of the catalogue, alone or together, that explain every shown value.
//!
//! After this file the reader knows how a mistake gets its name. Each variant is run along the program's own values; the ones under
//! which nothing is left unexplained, in the faulty cases and in the others, are named. Forms go before conventions, and these before
//! mistakes: a filter that is right in other algebra is not called wrong.
//!
//! Where no variant explains all alone, equations are taken one after the other: every value is judged on the program's own inputs, so
//! where enough is shown, mistakes in different equations are independent. Where too little is shown for that, all pairs are tried. Where
//! only some filters of a program are wrong, they are taken by themselves.

use super::invalid::Invalid;
use super::judge::{Case, Place};
use super::variant::{Kind, Variant, catalogue};
use crate::imm::Quantity;
use rayon::prelude::*;
use std::collections::BTreeSet;

/// So many mistakes at once are looked for.
const MOST: usize = 6;

/// A case to be explained.
#[derive(Clone)]
pub struct Evidence<'a> {
    /// The case.
    pub case: Case<'a>,
    /// The places that say nothing about variants: stale, drowned, or right against what its own inputs give.
    pub passed: BTreeSet<Place>,
    /// Whether the case has a fault.
    pub is_faulty: bool,
    /// Whether it is the beginning of another piece of evidence: what does not explain the first fault is found out early.
    pub is_beginning: bool,
}

/// Pairs are looked for where the shortest faulty run has at most so many steps: on two modes of five states that takes half a minute.
const MOST_STEPS_FOR_PAIRS: usize = 12;

/// What explains the faults.
#[derive(Debug, Clone, PartialEq)]
pub enum Diagnosis {
    /// There is no fault.
    Nothing,
    /// Each of these variants alone explains all; with what is shown they cannot be told apart.
    One(Vec<&'static Variant>),
    /// These together explain all; each with those that cannot be told from it.
    Several(Vec<Vec<&'static Variant>>),
    /// Each of these pairs explains all.
    Pairs(Vec<[&'static Variant; 2]>),
    /// By filter, since what explains one does not explain the others.
    ByFilter(Vec<(String, Diagnosis)>),
    /// Nothing in the catalogue explains all.
    Unknown {
        /// The variants that explain most faulty cases.
        best: Vec<&'static Variant>,
        /// The faulty cases that the first of them does not explain.
        unexplained: Vec<String>,
        /// The number of faulty cases.
        of: usize,
        /// Whether all pairs were tried, too; for long runs they are too many.
        pairs: bool,
    },
}

impl Diagnosis {
    /// Whether all that was found is forms and conventions, which are not wrong.
    pub fn is_excuse(&self) -> bool {
        let is_no_mistake = |variant: &&Variant| variant.kind != Kind::Mistake;
        match self {
            Self::One(variants) => variants.iter().all(is_no_mistake),
            Self::Several(members) => members.iter().flatten().all(is_no_mistake),
            Self::Pairs(pairs) => pairs.iter().flatten().all(is_no_mistake),
            Self::ByFilter(filters) => filters
                .iter()
                .all(|(_, of_filter)| matches!(of_filter, Self::Nothing) || of_filter.is_excuse()),
            Self::Nothing | Self::Unknown { .. } => false,
        }
    }
}

/// Looks for the variants that explain the evidence, together with the declared conventions.
///
/// # Errors
///
/// [`Invalid`] for a problem that cannot be set up.
pub fn diagnose(evidence: &[Evidence], conventions: &[&str]) -> Result<Diagnosis, Invalid> {
    let search = Search::new(evidence, conventions);
    if let Some(found) = search.quickly()? {
        return Ok(found);
    }
    let by_filter = by_filter(evidence, conventions)?;
    let is_known = |(_, found): &(String, Diagnosis)| !matches!(found, Diagnosis::Unknown { .. });
    if by_filter.len() > 1 && by_filter.iter().all(is_known) {
        return Ok(Diagnosis::ByFilter(by_filter));
    }
    if let Some(found) = search.pairs()? {
        return Ok(found);
    }
    if by_filter.len() > 1 && by_filter.iter().any(is_known) {
        return Ok(Diagnosis::ByFilter(by_filter));
    }
    search.best()
}

/// The evidence filter by filter, as long as there are several and one is without fault or explained.
fn by_filter(evidence: &[Evidence], conventions: &[&str]) -> Result<Vec<(String, Diagnosis)>, Invalid> {
    let name_of = |evidence: &Evidence| evidence.case.problem.kinds().join(" + ");
    let mut names: Vec<String> = evidence.iter().map(name_of).collect();
    names.sort_unstable();
    names.dedup();
    let mut found = Vec::new();
    for name in names {
        let of_filter = |evidence: &&Evidence| name_of(evidence) == name;
        let own: Vec<Evidence> = evidence.iter().filter(of_filter).cloned().collect();
        let search = Search::new(&own, conventions);
        let diagnosis = match search.quickly()? {
            Some(diagnosis) => diagnosis,
            None => search.best()?,
        };
        found.push((name, diagnosis));
    }
    Ok(found)
}

/// A search over some evidence.
struct Search<'a> {
    /// What fails fails early: faulty cases first, short ones before long ones.
    evidence: Vec<&'a Evidence<'a>>,
    conventions: Vec<&'a str>,
    candidates: Vec<&'static Variant>,
}

impl<'a> Search<'a> {
    fn new(evidence: &'a [Evidence<'a>], conventions: &[&'a str]) -> Self {
        let mut order: Vec<&Evidence> = evidence.iter().collect();
        order.sort_by_key(|evidence| (!evidence.is_faulty, evidence.case.shown.count()));
        let is_undeclared = |variant: &&Variant| !conventions.contains(&variant.id.as_str());
        Self {
            evidence: order,
            conventions: conventions.to_vec(),
            candidates: catalogue().iter().filter(is_undeclared).collect(),
        }
    }

    /// The ids of the declared conventions and of variants.
    fn ids(&self, variants: &[&'static Variant]) -> Vec<&'a str> {
        let ids = variants.iter().map(|variant| variant.id.as_str());
        self.conventions.iter().copied().chain(ids).collect()
    }

    /// Whether variants together explain every value of every case.
    fn explains(&self, variants: &[&'static Variant]) -> Result<bool, Invalid> {
        let ids = self.ids(variants);
        for evidence in &self.evidence {
            if !evidence.case.is_explained_by(&ids, &evidence.passed)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Whether variants together explain every value of one quantity.
    fn explains_quantity(&self, variants: &[&'static Variant], quantity: Quantity) -> Result<bool, Invalid> {
        let ids = self.ids(variants);
        for evidence in &self.evidence {
            if !evidence
                .case
                .is_quantity_explained_by(&ids, quantity, &evidence.passed)?
            {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// One variant, or one for each faulty equation.
    fn quickly(&self) -> Result<Option<Diagnosis>, Invalid> {
        if self.evidence.iter().all(|evidence| !evidence.is_faulty) {
            return Ok(Some(Diagnosis::Nothing));
        }
        let found = filter(&self.candidates, |variant| self.explains(&[variant]))?;
        match gentlest(&found) {
            Some(best) => Ok(Some(Diagnosis::One(best))),
            None => self.equation_by_equation(),
        }
    }

    /// For the first equation that is not explained, in the order of computation, a variant that is made in it; then for the next.
    fn equation_by_equation(&self) -> Result<Option<Diagnosis>, Invalid> {
        let mut chosen: Vec<&'static Variant> = Vec::new();
        let mut alternatives: Vec<Vec<&'static Variant>> = Vec::new();
        for quantity in Quantity::ALL {
            if self.explains_quantity(&chosen, quantity)? {
                continue;
            }
            let made_here: Vec<_> = self
                .candidates
                .iter()
                .copied()
                .filter(|variant| variant.is_made_in(quantity))
                .collect();
            let found = filter(&made_here, |variant| {
                let mut with = chosen.clone();
                with.push(variant);
                self.explains_quantity(&with, quantity)
            })?;
            let Some(found) = gentlest(&found).filter(|_| chosen.len() < MOST) else {
                return Ok(None);
            };
            chosen.push(found[0]);
            alternatives.push(found);
        }
        // The first of each may fail where another explains the equations after it, too.
        for place in 0..chosen.len() {
            let others = filter(&alternatives[place], |variant| {
                let mut with = chosen.clone();
                with[place] = variant;
                self.explains(&with)
            })?;
            let Some(first) = others.first() else {
                return Ok(None);
            };
            chosen[place] = first;
            alternatives[place] = others;
        }
        Ok((chosen.len() > 1).then_some(Diagnosis::Several(alternatives)))
    }

    /// Whether the first evidence, which almost every pair fails at, is short enough for all pairs.
    fn has_time_for_pairs(&self) -> bool {
        let steps = |evidence: &&Evidence| evidence.case.shown.dimensions.steps();
        self.evidence
            .first()
            .is_none_or(|first| steps(first) <= MOST_STEPS_FOR_PAIRS)
    }

    /// All pairs.
    fn pairs(&self) -> Result<Option<Diagnosis>, Invalid> {
        if !self.has_time_for_pairs() {
            return Ok(None);
        }
        let mut pairs = Vec::new();
        for (index, first) in self.candidates.iter().enumerate() {
            for second in &self.candidates[index + 1..] {
                pairs.push([*first, *second]);
            }
        }
        let found: Result<Vec<bool>, Invalid> = pairs
            .par_iter()
            .map(|[first, second]| {
                // Where both exchange the same entry the last one counts, so the order may matter.
                let is_either = first.quantity == second.quantity;
                Ok(self.explains(&[first, second])? || (is_either && self.explains(&[second, first])?))
            })
            .collect();
        let found: Vec<_> = pairs
            .iter()
            .zip(found?)
            .filter(|(_, found)| *found)
            .map(|(pair, _)| *pair)
            .collect();
        let mistakes = |pair: &[&Variant; 2]| pair.iter().filter(|variant| variant.kind == Kind::Mistake).count();
        let Some(fewest) = found.iter().map(mistakes).min() else {
            return Ok(None);
        };
        Ok(Some(Diagnosis::Pairs(
            found.into_iter().filter(|pair| mistakes(pair) == fewest).collect(),
        )))
    }

    /// The variants that explain most faulty cases, when nothing explains all.
    fn best(&self) -> Result<Diagnosis, Invalid> {
        let is_whole = |evidence: &&&Evidence| evidence.is_faulty && !evidence.is_beginning;
        let faulty: Vec<&&Evidence> = self.evidence.iter().filter(is_whole).collect();
        let unexplained: Result<Vec<Vec<String>>, Invalid> = self
            .candidates
            .par_iter()
            .map(|variant| {
                let ids = self.ids(&[variant]);
                let mut unexplained = Vec::new();
                for evidence in &faulty {
                    if !evidence.case.is_explained_by(&ids, &evidence.passed)? {
                        unexplained.push(evidence.case.problem.id.clone());
                    }
                }
                Ok(unexplained)
            })
            .collect();
        let unexplained = unexplained?;
        let fewest = unexplained.iter().map(Vec::len).min().unwrap_or(0);
        let is_best = |index: &usize| unexplained[*index].len() == fewest && fewest < faulty.len();
        let best: Vec<usize> = (0..self.candidates.len()).filter(is_best).collect();
        Ok(Diagnosis::Unknown {
            best: best.iter().map(|&index| self.candidates[index]).collect(),
            unexplained: best.first().map_or_else(Vec::new, |&index| unexplained[index].clone()),
            of: faulty.len(),
            pairs: self.has_time_for_pairs(),
        })
    }
}

/// The candidates of which something is true, found on all cores.
fn filter(
    candidates: &[&'static Variant],
    is_true: impl Fn(&'static Variant) -> Result<bool, Invalid> + Sync,
) -> Result<Vec<&'static Variant>, Invalid> {
    let found: Result<Vec<bool>, Invalid> = candidates.par_iter().map(|variant| is_true(variant)).collect();
    let found = candidates.iter().zip(found?).filter(|(_, found)| *found);
    Ok(found.map(|(variant, _)| *variant).collect())
}

/// The variants of the gentlest kind among those found.
fn gentlest(found: &[&'static Variant]) -> Option<Vec<&'static Variant>> {
    [Kind::Form, Kind::Convention, Kind::Mistake]
        .into_iter()
        .find_map(|kind| {
            let of_kind: Vec<_> = found.iter().copied().filter(|variant| variant.kind == kind).collect();
            (!of_kind.is_empty()).then_some(of_kind)
        })
}
