//! Variations of a given problem: other numbers in the same shapes and formulas, other measurements, fewer steps.
//!
//! A zero stays zero, and a covariance of any rank keeps its rank.

use super::draw::{Draw, rounded, rounded_to_spread};
use super::event::see;
use super::place::{Place, places};
use crate::oracle::problem::{ProblemFile, Rows};

/// The most steps of a changed problem, which can be certified in a moment.
const MOST_STEPS: usize = 8;

/// The problem, changed a little; nothing if it cannot be run.
pub(super) fn around(draw: &mut Draw, problem: &ProblemFile) -> Option<ProblemFile> {
    let mut changed = problem.clone();
    let all = changed.measurements.len();
    let steps = 1 + draw.below(all.min(MOST_STEPS));
    let first = draw.below(all - steps + 1);
    changed.measurements = changed.measurements.drain(first..first + steps).collect();
    for (index, entry) in changed.measurements.iter_mut().enumerate() {
        entry.step = index + 1;
    }
    for place in places(&mut changed) {
        change(draw, place);
    }
    move_means(draw, &mut changed);
    // Each measurement is drawn about what is predicted from those before; where there was none, there is none.
    for step in 0..steps {
        let Some(old) = changed.measurements[step].z.take() else {
            continue;
        };
        if draw.happens(0.1) {
            continue;
        }
        let is_outlier = draw.happens(0.03);
        see(draw, &mut changed, step, is_outlier)?;
        let z = changed.measurements[step].z.iter_mut().flatten();
        z.zip(old)
            .filter(|(_, old)| old.is_none())
            .for_each(|(value, _)| *value = None);
    }
    Some(changed)
}

fn change(draw: &mut Draw, place: Place) {
    match place {
        Place::Motion(rows) | Place::Map(rows) => rows.iter_mut().flatten().for_each(|value| jitter(draw, value)),
        Place::Coordinate(value) | Place::Parameter(value) => jitter(draw, value),
        Place::Covariance(rows) => rescale(draw, rows),
        Place::Chain(rows) => {
            let r = rows.len();
            for (i, row) in rows.iter_mut().enumerate() {
                // A path that is closed stays closed.
                if row.iter().all(|entry| *entry > 0.0) && draw.happens(0.5) {
                    *row = draw.probabilities(r, i);
                }
            }
        }
        Place::Probabilities(list) => {
            let favourite = draw.below(list.len());
            *list = draw.probabilities(list.len(), favourite);
        }
        Place::Mean(_) | Place::Measured(_) => {}
    }
}

/// A number changes by a tenth of itself; a one, which is often meant to be one, only sometimes.
fn jitter(draw: &mut Draw, value: &mut f64) {
    let is_one = (*value - 1.0).abs() == 0.0;
    if draw.happens(if is_one { 0.2 } else { 0.7 }) {
        *value = rounded(*value * (1.0 + 0.1 * draw.normal()), 3);
    }
}

/// A covariance with each standard deviation halved, kept or doubled: exact in doubles, so that the rank is kept.
fn rescale(draw: &mut Draw, rows: &mut Rows) {
    let factors: Vec<f64> = rows
        .iter()
        .map(|_| draw.one_of(&[0.5, 1.0, 1.0, 2.0]).unwrap_or(1.0))
        .collect();
    for (row, entries) in rows.iter_mut().enumerate() {
        for (column, entry) in entries.iter_mut().enumerate() {
            *entry *= factors[row] * factors[column];
        }
    }
}

/// Means move by about a standard deviation where there is one.
fn move_means(draw: &mut Draw, problem: &mut ProblemFile) {
    for estimate in &mut problem.initial.modes {
        for (index, value) in estimate.mean.iter_mut().enumerate() {
            let variance = estimate.covariance.as_ref().map_or(0.0, |rows| rows[index][index]);
            let deviation = crate::number::Real::sqrt(&variance);
            if deviation > 0.0 {
                *value = rounded_to_spread(*value + deviation * draw.normal(), deviation);
            }
        }
    }
}
