//! The diagnosis: the variants of the catalogue, alone or together, that explain every shown value.
//!
//! Each variant is run along the program's own values. A variant is named if it explains everything, in the faulty cases and in the
//! others. Forms go before conventions, and conventions before mistakes: a filter that is right in different algebra is not called wrong.
//!
//! Where no variant explains all alone, equations are taken one after the other: every value is judged on the program's own inputs, so
//! where enough is shown, mistakes in different equations are independent. Where too little is shown for that, all pairs are tried. Where
//! only some filters of a program are wrong, they are taken by themselves.

use super::formula::{self, ComputedFormulas};
use super::invalid::Invalid;
use super::judge::{Case, Place};
use super::setup::Setup;
use super::variant::{Kind, Variant, catalogue};
use crate::imm::Quantity;
use crate::number::RandomRounding;
use rayon::prelude::*;
use std::collections::BTreeSet;

/// The most mistakes that are looked for at once.
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
    /// The number of steps that were right, except the last.
    pub steps_to_fault: usize,
    /// Whether it is the beginning of another piece of evidence: what does not explain the first fault is found out early.
    pub is_beginning: bool,
}

impl<'a> Evidence<'a> {
    /// That of a case in which everything is right.
    pub fn of_right(case: Case<'a>) -> Self {
        Self {
            case,
            passed: BTreeSet::new(),
            is_faulty: false,
            steps_to_fault: usize::MAX,
            is_beginning: false,
        }
    }
}

/// Pairs are tried only if the shortest faulty run has at most this many steps: with two modes of five states that takes half a minute.
const MOST_STEPS_FOR_PAIRS: usize = 12;

/// What explains the faults.
#[derive(Debug, Clone, PartialEq)]
pub enum Diagnosis {
    /// There is no fault.
    Nothing,
    /// Each of these variants alone explains everything; the shown values cannot distinguish them.
    One(Vec<&'static Variant>),
    /// These together explain everything; each with those that the shown values cannot distinguish from it.
    Several(Vec<Vec<&'static Variant>>),
    /// Each of these pairs explains all.
    Pairs(Vec<[&'static Variant; 2]>),
    /// By filter, since what explains one does not explain the others.
    ByFilter(Vec<(String, Diagnosis)>),
    /// What explains some of the faulty cases, and other things that explain others.
    InParts {
        /// What explains most of them first, then what explains most of the rest.
        parts: Vec<Share>,
        /// The faulty cases that nothing explains.
        unexplained: Vec<String>,
        /// The number of faulty cases.
        of: usize,
        /// What was computed in these instead.
        formulas: ComputedFormulas,
        /// Whether all pairs were tried, too; for long runs they are too many.
        pairs: bool,
    },
}

/// What explains some of the faulty cases, alone or together with what explains others.
#[derive(Debug, Clone, PartialEq)]
pub struct Share {
    /// Each explains the same cases; the shown values cannot distinguish them.
    pub variants: Vec<&'static Variant>,
    /// The number of cases that it explains and nothing before it does.
    pub cases: usize,
}

impl Diagnosis {
    /// Whether the catalogue explains every faulty case.
    fn is_named(&self) -> bool {
        !matches!(self, Self::InParts { unexplained, .. } if !unexplained.is_empty())
    }

    /// Whether it does, or formulas do.
    fn is_known(&self) -> bool {
        self.is_named() || matches!(self, Self::InParts { formulas, .. } if formulas.is_complete)
    }

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
            Self::InParts { parts, unexplained, .. } => {
                unexplained.is_empty() && parts.iter().flat_map(|part| &part.variants).all(is_no_mistake)
            }
            Self::Nothing => false,
        }
    }
}

/// Looks for the variants that explain the evidence, together with the declared conventions.
///
/// # Errors
///
/// [`Invalid`] for a problem that cannot be set up.
pub fn diagnose(evidence: &[Evidence], conventions: &[&str]) -> Result<Diagnosis, Invalid> {
    let search = Search::new(evidence, conventions)?;
    if let Some(found) = search.quickly()? {
        return Ok(found);
    }
    let by_filter = by_filter(evidence, conventions)?;
    if !by_filter.is_empty() && by_filter.iter().all(|(_, found)| found.is_named()) {
        return Ok(Diagnosis::ByFilter(by_filter));
    }
    let in_parts = with_formulas(search.in_parts()?, evidence, conventions)?;
    if in_parts.is_known() {
        return Ok(in_parts);
    }
    if let Some(found) = search.pairs()? {
        return Ok(found);
    }
    let with_its_formulas = |(name, found): (String, Diagnosis)| {
        let found = with_formulas(found, &of_filter(evidence, &name), conventions)?;
        Ok((name, found))
    };
    let by_filter: Vec<(String, Diagnosis)> = by_filter
        .into_iter()
        .map(with_its_formulas)
        .collect::<Result<_, Invalid>>()?;
    if by_filter.iter().any(|(_, found)| found.is_known()) {
        return Ok(Diagnosis::ByFilter(by_filter));
    }
    Ok(in_parts)
}

/// What the catalogue explains in parts, with the formulas that were computed in what it does not explain.
fn with_formulas(mut found: Diagnosis, evidence: &[Evidence], conventions: &[&str]) -> Result<Diagnosis, Invalid> {
    if let Diagnosis::InParts {
        unexplained, formulas, ..
    } = &mut found
        && !unexplained.is_empty()
    {
        let is_open = |piece: &&Evidence| !piece.is_faulty || unexplained.contains(&piece.case.problem.id);
        let rest: Vec<Evidence> = evidence.iter().filter(is_open).cloned().collect();
        *formulas = formula::find(&rest, conventions)?;
    }
    Ok(found)
}

/// The same without pairs and parts, which take long: where the answers themselves say already what is wrong.
///
/// # Errors
///
/// [`Invalid`] for a problem that cannot be set up.
pub(super) fn diagnose_quickly(evidence: &[Evidence], conventions: &[&str]) -> Result<Diagnosis, Invalid> {
    let found = Search::new(evidence, conventions)?.quickly()?;
    Ok(found.unwrap_or(Diagnosis::Nothing))
}

/// The evidence filter by filter; nothing where there is one filter only.
fn by_filter(evidence: &[Evidence], conventions: &[&str]) -> Result<Vec<(String, Diagnosis)>, Invalid> {
    let mut names: Vec<String> = evidence.iter().map(name_of_filter).collect();
    names.sort_unstable();
    names.dedup();
    let mut found = Vec::new();
    if names.len() == 1 {
        return Ok(found);
    }
    for name in names {
        let own = of_filter(evidence, &name);
        let search = Search::new(&own, conventions)?;
        let diagnosis = match search.quickly()? {
            Some(diagnosis) => diagnosis,
            None => search.in_parts()?,
        };
        found.push((name, diagnosis));
    }
    Ok(found)
}

fn name_of_filter(evidence: &Evidence) -> String {
    evidence.case.problem.kinds().join(" + ")
}

/// The evidence of one filter.
fn of_filter<'a>(evidence: &[Evidence<'a>], name: &str) -> Vec<Evidence<'a>> {
    let is_own = |evidence: &&Evidence| name_of_filter(evidence) == name;
    evidence.iter().filter(is_own).cloned().collect()
}

/// Evidence with its problem, which says where a variant applies.
type Piece<'a> = (&'a Evidence<'a>, Setup<RandomRounding>);

/// The variants that explain the same pieces of evidence, and the pieces that they leave.
type Explained<'a> = (Vec<&'static Variant>, Vec<&'a Piece<'a>>);

/// A search over some evidence.
struct Search<'a> {
    /// What fails fails early: faulty cases first, short ones before long ones.
    evidence: Vec<Piece<'a>>,
    conventions: Vec<&'a str>,
    candidates: Vec<&'static Variant>,
}

impl<'a> Search<'a> {
    fn new(evidence: &'a [Evidence<'a>], conventions: &[&'a str]) -> Result<Self, Invalid> {
        let mut order: Vec<&Evidence> = evidence.iter().collect();
        order.sort_by_key(|evidence| (!evidence.is_faulty, evidence.case.shown.count()));
        let with_problem =
            |evidence: &'a Evidence<'a>| Ok((evidence, evidence.case.problem.setup_in_doubles()?.varied(conventions)));
        let is_undeclared = |variant: &&Variant| !conventions.contains(&variant.id.as_str());
        Ok(Self {
            evidence: order.into_iter().map(with_problem).collect::<Result<_, Invalid>>()?,
            conventions: conventions.to_vec(),
            candidates: catalogue().iter().filter(is_undeclared).collect(),
        })
    }

    /// The ids of the declared conventions and of variants.
    fn ids(&self, variants: &[&'static Variant]) -> Vec<&'a str> {
        let ids = variants.iter().map(|variant| variant.id.as_str());
        self.conventions.iter().copied().chain(ids).collect()
    }

    /// Whether variants together explain every value of every case.
    fn explains(&self, variants: &[&'static Variant]) -> Result<bool, Invalid> {
        for (evidence, setup) in &self.evidence {
            if !self.explains_one(variants, evidence, setup)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Whether variants together explain every value of a case. Those that change nothing in it explain what has no fault.
    fn explains_one(
        &self,
        variants: &[&'static Variant],
        evidence: &Evidence,
        setup: &Setup<RandomRounding>,
    ) -> Result<bool, Invalid> {
        if !variants.iter().any(|variant| variant.applies_to(setup)) {
            return Ok(!evidence.is_faulty);
        }
        let (case, ids) = (&evidence.case, self.ids(variants));
        // Forms have a noise of their own, which may be far greater.
        let has_form = variants.iter().any(|variant| variant.kind == Kind::Form);
        if !has_form && case.is_far_off(&ids, &evidence.passed, evidence.steps_to_fault)? {
            return Ok(false);
        }
        case.is_explained_by(&ids, &evidence.passed)
    }

    /// Whether variants together explain every value of one quantity.
    fn explains_quantity(&self, variants: &[&'static Variant], quantity: Quantity) -> Result<bool, Invalid> {
        let ids = self.ids(variants);
        for (evidence, _) in &self.evidence {
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
        if self.evidence.iter().all(|(evidence, _)| !evidence.is_faulty) {
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
        let first = self.evidence.first();
        first.is_none_or(|(first, _)| first.case.shown.dimensions.steps() <= MOST_STEPS_FOR_PAIRS)
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

    /// What explains most faulty cases and no right case refutes; then what does of the rest.
    fn in_parts(&self) -> Result<Diagnosis, Invalid> {
        let is_whole = |(evidence, _): &&Piece| evidence.is_faulty && !evidence.is_beginning;
        let mut open: Vec<&Piece> = self.evidence.iter().filter(is_whole).collect();
        let of = open.len();
        let (mut parts, mut chosen) = (Vec::new(), Vec::new());
        while let Some((variants, rest)) = self.part(&chosen, &open)?.filter(|_| parts.len() < MOST) {
            chosen.push(variants[0]);
            parts.push(Share {
                variants,
                cases: open.len() - rest.len(),
            });
            open = rest;
        }
        let unexplained: Vec<String> = open
            .iter()
            .map(|(evidence, _)| evidence.case.problem.id.clone())
            .collect();
        Ok(Diagnosis::InParts {
            parts,
            unexplained,
            formulas: ComputedFormulas::default(),
            of,
            pairs: self.has_time_for_pairs(),
        })
    }

    /// The variants that explain most of these cases, alone or with what is chosen already, and the cases that they leave.
    fn part<'b>(&self, chosen: &[&'static Variant], open: &[&'b Piece<'b>]) -> Result<Option<Explained<'b>>, Invalid> {
        let left_by = |variant: &&'static Variant| {
            let with = [chosen, &[*variant]].concat();
            let is_left = |(evidence, setup): &Piece| {
                let is_explained = self.explains_one(&[variant], evidence, setup)?
                    || (!chosen.is_empty() && self.explains_one(&with, evidence, setup)?);
                Ok(!is_explained)
            };
            let left: Result<Vec<bool>, Invalid> = open.iter().map(|piece| is_left(piece)).collect();
            Ok((*variant, left?))
        };
        let all: Result<Vec<_>, Invalid> = self.candidates.par_iter().map(left_by).collect();
        let count = |left: &[bool]| left.iter().filter(|is_left| **is_left).count();
        let mut all: Vec<(&'static Variant, Vec<bool>)> = all?;
        all.retain(|(_, left)| count(left) < open.len());
        all.sort_by_key(|(_, left)| count(left));
        let mut found: Vec<&'static Variant> = Vec::new();
        let mut left_by_found: Option<&Vec<bool>> = None;
        for (variant, left) in &all {
            if left_by_found.is_none_or(|found| found == left) && self.is_refuted_by_none(variant)? {
                left_by_found = Some(left);
                found.push(variant);
            }
        }
        let left = left_by_found.zip(gentlest(&found));
        Ok(left.map(|(left, found)| {
            let rest = open.iter().zip(left).filter(|(_, is_left)| **is_left);
            (found, rest.map(|(piece, _)| *piece).collect())
        }))
    }

    /// Whether a variant leaves every right case right.
    fn is_refuted_by_none(&self, variant: &'static Variant) -> Result<bool, Invalid> {
        for (evidence, setup) in self.evidence.iter().filter(|(evidence, _)| !evidence.is_faulty) {
            if !self.explains_one(&[variant], evidence, setup)? {
                return Ok(false);
            }
        }
        Ok(true)
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
