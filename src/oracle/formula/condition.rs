//! Where a program computes another formula, if it does not do so everywhere.

use super::instance::Instance;
use super::right::distance;
use super::value::With;

/// What sets the faulty values apart from the right ones, in words.
pub(super) fn condition(wrong: &[&Instance], right: &[&Instance]) -> String {
    let found = [by_step(wrong, right), by_mode(wrong, right), by_distance(wrong, right)];
    let found: Vec<String> = found.into_iter().flatten().collect();
    if found.is_empty() {
        "at some values only".to_owned()
    } else {
        found.join("; ")
    }
}

/// Whether the faulty ones have other numbers than the right ones, in one interval.
fn apart(wrong: &[usize], right: &[usize]) -> Option<(usize, usize)> {
    let (first, last) = (*wrong.iter().min()?, *wrong.iter().max()?);
    (!right.iter().any(|number| (first..=last).contains(number))).then_some((first, last))
}

fn by_step(wrong: &[&Instance], right: &[&Instance]) -> Option<String> {
    let steps = |of: &[&Instance]| of.iter().map(|at| at.place.0).collect::<Vec<_>>();
    let (first, last) = apart(&steps(wrong), &steps(right))?;
    let is_last = right.iter().all(|at| at.place.0 < first);
    Some(match (first == last, is_last) {
        (true, false) => format!("at step {first} only"),
        (_, true) => format!("from step {first} on"),
        (false, false) => format!("at steps {first} to {last} only"),
    })
}

fn by_mode(wrong: &[&Instance], right: &[&Instance]) -> Option<String> {
    if !wrong.first()?.place.1.is_of_mode() {
        return None;
    }
    let modes = |of: &[&Instance]| of.iter().map(|at| at.place.2).collect::<Vec<_>>();
    let (first, last) = apart(&modes(wrong), &modes(right))?;
    Some(if first == last {
        format!("in mode {first} only")
    } else {
        format!("in modes {first} to {last} only")
    })
}

/// A gate: what is far from its prediction is treated otherwise.
fn by_distance(wrong: &[&Instance], right: &[&Instance]) -> Option<String> {
    let distances = |of: &[&Instance]| -> Option<Vec<f64>> {
        let one = |at: &&Instance| Some(distance().matrix(at, With::default())?[(0, 0)].value());
        of.iter().map(one).collect()
    };
    let (wrong, right) = (distances(wrong)?, distances(right)?);
    let least = wrong.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = right.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (greatest < least).then(|| format!("where νᵀS⁻¹ν is {least:.3} or more; right where it is {greatest:.3} or less"))
}
