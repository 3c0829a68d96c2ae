//! The fitted number of a formula: a factor, an added multiple of I, a floor.
//!
//! It is fitted by least squares in units of noise, and replaced by the short number that people write if there is one.

use super::edit::{Candidate, Start};
use super::instance::Instance;
use super::value::by_rows;

/// The number with which a candidate gives the probes best, by least squares; a floor is what is shown itself.
pub(super) fn fitted(candidate: &Candidate, start: Start, probes: &[&Instance]) -> Option<f64> {
    let variances = || {
        probes
            .iter()
            .filter_map(|at| at.shown_numbers())
            .flat_map(|shown| shown.iter().copied().step_by(shown.len().isqrt() + 1))
    };
    let mut number = match start {
        Start::At(number) => number,
        Start::LeastVariance => return variances().reduce(f64::min),
        Start::GreatestVariance => return variances().reduce(f64::max),
    };
    for _ in 0..ITERATIONS {
        let width = 1e-4 * number.abs().max(1.0);
        let (mut slope_squares, mut slope_rests) = (0.0, 0.0);
        for at in probes {
            let value = |number: f64| Some(by_rows(&candidate.tree.matrix(at, candidate.with(Some(number)))?));
            let (here, there, shown) = (value(number)?, value(number + width)?, at.shown_numbers()?);
            let (step, quantity, mode) = at.place;
            let noise = at.run.case.reference.noise.get(step, quantity, mode)?;
            let scale = at.run.case.reference.scale.get(step, quantity, mode)?;
            if here.len() != shown.len() {
                return None;
            }
            for index in 0..shown.len() {
                let unit = noise[index].max(f64::EPSILON * scale[index]);
                let slope = (there[index] - here[index]) / width / unit;
                slope_squares += slope * slope;
                slope_rests += slope * (shown[index] - here[index]) / unit;
            }
        }
        let change = slope_rests / slope_squares;
        if !change.is_finite() {
            return None;
        }
        number += change;
    }
    Some(plain(number))
}

/// A number that is a short one to eight digits is the short one: people write 0.1 and 3.
fn plain(number: f64) -> f64 {
    let short: f64 = format!("{number:.3e}").parse().unwrap_or(number);
    if (number - short).abs() <= 1e-8 * short.abs() {
        short
    } else {
        number
    }
}

/// The number of Newton steps: a number enters a formula linearly, or nearly so.
const ITERATIONS: usize = 8;
