//! How the numbers of a problem become simpler: identity, zero, one, few digits.
//!
//! These are the smaller steps of shrinking: first whole matrices and vectors, then single numbers. They never make a covariance zero or
//! singular, because a program may rightly stop there.

use super::draw::{leading_identity, rounded};
use super::place::{Place, places};
use super::reduce::with;
use crate::oracle::problem::{ProblemFile, Rows};

/// Each matrix or vector as simple as it can be; a covariance first identity, then diagonal.
pub(super) fn wholes(problem: &ProblemFile) -> Vec<ProblemFile> {
    let count = places(&mut problem.clone()).len();
    let mut simpler = Vec::new();
    for index in 0..count {
        simpler.push(with(problem, |problem| at(problem, index, simplest)));
        simpler.push(with(problem, |problem| at(problem, index, diagonal)));
    }
    simpler
}

/// Does something to the numbers at a place.
fn at(problem: &mut ProblemFile, index: usize, change: impl FnOnce(Place)) {
    if let Some(place) = places(problem).into_iter().nth(index) {
        change(place);
    }
}

fn simplest(place: Place) {
    match place {
        Place::Motion(rows) | Place::Map(rows) | Place::Covariance(rows) => {
            *rows = leading_identity(rows.len(), rows.first().map_or(0, Vec::len));
        }
        Place::Chain(rows) => {
            let equal = equal(rows.len());
            for row in rows {
                row.clone_from(&equal);
            }
        }
        Place::Probabilities(list) => *list = equal(list.len()),
        Place::Mean(list) => list.fill(0.0),
        Place::Measured(z) => z.iter_mut().flatten().for_each(|value| *value = 0.0),
        Place::Coordinate(value) => *value = 0.0,
        // A density or a length of nothing is another problem.
        Place::Parameter(value) => *value = 1.0,
    }
}

fn diagonal(place: Place) {
    if let Place::Covariance(rows) = place {
        for (row, entries) in rows.iter_mut().enumerate() {
            let others = entries.iter_mut().enumerate().filter(|(column, _)| *column != row);
            others.for_each(|(_, entry)| *entry = 0.0);
        }
    }
}

/// Probabilities that are as equal as two decimals make them.
fn equal(count: usize) -> Vec<f64> {
    let part = (100.0 / count as f64).floor() / 100.0;
    let first = rounded(1.0 - part * (count as f64 - 1.0), 6);
    let mut all = vec![part; count];
    all.iter_mut().take(1).for_each(|entry| *entry = first);
    all
}

/// Each number by itself: zero, one, or with fewer digits.
pub(super) fn numbers(problem: &ProblemFile) -> Vec<ProblemFile> {
    let mut counts = Vec::new();
    for place in places(&mut problem.clone()) {
        counts.push(entries_of(&place));
    }
    let mut simpler = Vec::new();
    for (index, count) in counts.into_iter().enumerate() {
        for entry in 0..count {
            for how in [
                Simpler::Zero,
                Simpler::One,
                Simpler::Whole,
                Simpler::OneDigit,
                Simpler::TwoDigits,
            ] {
                simpler.push(with(problem, |problem| {
                    at(problem, index, |place| change(place, entry, how));
                }));
            }
        }
    }
    simpler
}

/// What becomes of a number.
#[derive(Clone, Copy)]
enum Simpler {
    Zero,
    One,
    Whole,
    OneDigit,
    TwoDigits,
}

impl Simpler {
    fn of(self, value: f64) -> f64 {
        match self {
            Self::Zero => 0.0,
            Self::One => 1.0,
            Self::Whole => value.round() + 0.0,
            Self::OneDigit => rounded(value, 1),
            Self::TwoDigits => rounded(value, 2),
        }
    }
}

/// How many things at a place are changed one by one: numbers; of a chain rows.
fn entries_of(place: &Place) -> usize {
    match place {
        Place::Motion(rows) | Place::Map(rows) | Place::Covariance(rows) => rows.iter().map(Vec::len).sum(),
        Place::Chain(rows) => rows.len(),

        Place::Mean(list) => list.len(),
        Place::Measured(z) => z.len(),
        Place::Probabilities(_) | Place::Coordinate(_) | Place::Parameter(_) => 1,
    }
}

fn change(place: Place, index: usize, how: Simpler) {
    match place {
        Place::Motion(rows) | Place::Map(rows) => {
            // What leads from a component to itself may become one, and not nothing.
            let columns = rows.first().map_or(1, Vec::len);
            let is_kept = index / columns == index % columns;
            let entry = rows.iter_mut().flatten().nth(index);
            simplify(entry, how, is_kept);
        }
        Place::Covariance(rows) => symmetrically(rows, index, how),
        Place::Chain(rows) => rows.iter_mut().skip(index).take(1).for_each(|row| of_all(row, how)),
        Place::Probabilities(list) => of_all(list, how),
        Place::Mean(list) => simplify(list.get_mut(index), how, false),
        Place::Measured(z) => simplify(z.get_mut(index).and_then(Option::as_mut), how, false),
        Place::Coordinate(value) => simplify(Some(value), how, false),
        Place::Parameter(value) => simplify(Some(value), how, true),
    }
}

/// Makes a number simpler; one that is kept does not become zero.
fn simplify(value: Option<&mut f64>, how: Simpler, is_kept: bool) {
    if let Some(value) = value {
        let simpler = how.of(*value);
        if !is_kept || simpler != 0.0 {
            *value = simpler;
        }
    }
}

/// A number of a symmetric matrix, and the one that is the same; a variance does not become zero.
fn symmetrically(rows: &mut Rows, index: usize, how: Simpler) {
    let n = rows.len();
    let (row, column) = (index / n, index % n);
    let value = how.of(rows[row][column]);
    if row != column || value != 0.0 {
        rows[row][column] = value;
        rows[column][row] = value;
    }
}

/// Probabilities that are all equal, or of one digit. None becomes zero: what no mode leads to is another problem.
fn of_all(row: &mut Vec<f64>, how: Simpler) {
    match how {
        Simpler::Zero => *row = equal(row.len()),
        Simpler::OneDigit => {
            let others: f64 = row.iter().skip(1).map(|entry| how.of(*entry)).sum();
            row.iter_mut().skip(1).for_each(|entry| *entry = how.of(*entry));
            row.iter_mut()
                .take(1)
                .for_each(|entry| *entry = rounded(1.0 - others, 6));
        }
        Simpler::One | Simpler::Whole | Simpler::TwoDigits => {}
    }
}
