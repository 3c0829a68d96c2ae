//! What was done: the variants of the catalogue, and pairs of them, that explain every shown value.
//!
//! After this file the reader knows how a mistake gets its name. Each variant is run along the program's own values; the ones under
//! which nothing is left unexplained, in the faulty cases and in the others, are named. Forms go before conventions, and these before
//! mistakes: a filter that is right in other algebra is not called wrong.

use super::invalid::Invalid;
use super::judge::{Case, Place};
use super::variant::{Kind, Variant, catalogue};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// A case to be explained.
pub struct Evidence<'a> {
    /// The case.
    pub case: Case<'a>,
    /// The places that say nothing about variants: stale, not finite, drowned, or right against what its own inputs give.
    pub passed: BTreeSet<Place>,
    /// Whether the case has a fault.
    pub is_faulty: bool,
}

/// What explains the faults.
#[derive(Debug, Clone, PartialEq)]
pub enum Diagnosis {
    /// There is no fault.
    Nothing,
    /// Each of these variants alone explains all; with what is shown they cannot be told apart.
    One(Vec<&'static Variant>),
    /// Each of these pairs explains all.
    Two(Vec<[&'static Variant; 2]>),
    /// Nothing in the catalogue explains all; the variants that explain most cases with a fault, and how many of how many.
    Unknown {
        /// The best.
        best: Vec<&'static Variant>,
        /// The number of faulty cases that each explains.
        explained: usize,
        /// The number of faulty cases.
        of: usize,
    },
}

/// Looks for the variants that explain the evidence, together with the declared conventions.
///
/// # Errors
///
/// [`Invalid`] for a problem that cannot be set up.
pub fn diagnose(evidence: &[Evidence], conventions: &[&str]) -> Result<Diagnosis, Invalid> {
    if evidence.iter().all(|evidence| !evidence.is_faulty) {
        return Ok(Diagnosis::Nothing);
    }
    // What fails fails early: faulty cases first, short ones before long ones.
    let mut order: Vec<&Evidence> = evidence.iter().collect();
    order.sort_by_key(|evidence| (!evidence.is_faulty, evidence.case.shown.count()));
    let explains = |variants: &[&str]| -> Result<bool, Invalid> {
        let all: Vec<&str> = conventions.iter().chain(variants).copied().collect();
        for evidence in &order {
            if !evidence.case.is_explained_by(&all, &evidence.passed)? {
                return Ok(false);
            }
        }
        Ok(true)
    };
    let candidates: Vec<&'static Variant> = catalogue()
        .iter()
        .filter(|variant| !conventions.contains(&variant.id.as_str()))
        .collect();
    let found: Result<Vec<bool>, Invalid> = candidates.par_iter().map(|variant| explains(&[&variant.id])).collect();
    let found = chosen(&candidates, &found?);
    if let Some(best) = gentlest(&found) {
        return Ok(Diagnosis::One(best));
    }
    let mut pairs = Vec::new();
    for (index, first) in candidates.iter().enumerate() {
        for second in &candidates[index + 1..] {
            pairs.push([*first, *second]);
        }
    }
    // Where both exchange the same entry the last one counts, so the order may matter.
    let found: Result<Vec<bool>, Invalid> = pairs
        .par_iter()
        .map(|[first, second]| {
            let is_either = first.quantity == second.quantity;
            Ok(explains(&[&first.id, &second.id])? || (is_either && explains(&[&second.id, &first.id])?))
        })
        .collect();
    let found = chosen(&pairs, &found?);
    if !found.is_empty() {
        return Ok(Diagnosis::Two(without_needless_forms(found)));
    }
    best_of(&candidates, &order, conventions)
}

fn chosen<X: Copy>(all: &[X], found: &[bool]) -> Vec<X> {
    all.iter()
        .zip(found)
        .filter(|(_, found)| **found)
        .map(|(x, _)| *x)
        .collect()
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

/// Pairs with the fewest mistakes.
fn without_needless_forms(found: Vec<[&'static Variant; 2]>) -> Vec<[&'static Variant; 2]> {
    let mistakes = |pair: &[&Variant; 2]| pair.iter().filter(|variant| variant.kind == Kind::Mistake).count();
    let fewest = found.iter().map(mistakes).min().unwrap_or(0);
    found.into_iter().filter(|pair| mistakes(pair) == fewest).collect()
}

/// The variants that explain most faulty cases, when none explains all.
fn best_of(
    candidates: &[&'static Variant],
    evidence: &[&Evidence],
    conventions: &[&str],
) -> Result<Diagnosis, Invalid> {
    let faulty: Vec<&&Evidence> = evidence.iter().filter(|evidence| evidence.is_faulty).collect();
    let counts: Result<Vec<usize>, Invalid> = candidates
        .par_iter()
        .map(|variant| {
            let mut all = conventions.to_vec();
            all.push(&variant.id);
            let mut count = 0;
            for evidence in &faulty {
                count += usize::from(evidence.case.is_explained_by(&all, &evidence.passed)?);
            }
            Ok(count)
        })
        .collect();
    let counts = counts?;
    let most = counts.iter().copied().max().unwrap_or(0);
    let is_best: Vec<bool> = counts.iter().map(|&count| count == most && most > 0).collect();
    Ok(Diagnosis::Unknown {
        best: chosen(candidates, &is_best),
        explained: most,
        of: faulty.len(),
    })
}
