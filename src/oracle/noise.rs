//! Rounding noise: how far rounding moves each value, measured by Monte Carlo arithmetic.
//!
//! Errors are measured in this unit. No fixed tolerance separates right from wrong: a right filter may be off by 10⁻⁷ of a standard
//! deviation on a hard problem, and a wrong one by 10⁻⁸ on an easy one. So the same equations are run a few times in [`RandomRounding`],
//! and the scatter of the values is the unit.

use super::invalid::Invalid;
use super::run::Computed;
use super::trace::{Table, Trace};
use crate::number::RandomRounding;

/// The number of randomly rounded runs. With eight the greatest of the deviations is within a factor of three of a standard deviation's
/// double in more than 99 of 100 cases (Gaussian deviations), which is far below the factor of 100 at which an error counts.
pub const RUNS: u64 = 8;

/// The greatest deviation of any of the runs from the centre, for each number; infinite where a run could not be computed.
///
/// `run` makes one run with random rounding, given its number; it is called `runs` times.
///
/// # Errors
///
/// The first of `run`.
pub fn spread(
    centre: &Trace,
    unit_roundoff: f64,
    runs: u64,
    run: impl Fn(u64) -> Result<Computed<RandomRounding>, Invalid>,
) -> Result<Trace, Invalid> {
    let mut spread = centre.map(|_, values| vec![0.0_f64; values.len()]);
    for seed in 0..runs {
        let sample = RandomRounding::with(unit_roundoff, seed, || {
            let computed = run(seed)?;
            let output = |values: &Vec<RandomRounding>| values.iter().map(|value| value.output()).collect::<Vec<_>>();
            Ok(computed.values.map(|_, values| output(values)))
        })?;
        widen(&mut spread, centre, &sample);
    }
    Ok(spread)
}

/// Takes the deviations of one run into the spread.
fn widen(spread: &mut Trace, centre: &Trace, sample: &Table<Vec<f64>>) {
    for (step, quantity, mode) in centre.all_places() {
        let (Some(old), Some(middle)) = (spread.get(step, quantity, mode), centre.get(step, quantity, mode)) else {
            continue;
        };
        let found = sample.get(step, quantity, mode);
        let wider = old.iter().zip(middle).enumerate().map(|(index, (old, middle))| {
            let deviation = found.map_or(f64::INFINITY, |values| (values[index] - middle).abs());
            if deviation.is_nan() {
                f64::INFINITY
            } else {
                old.max(deviation)
            }
        });
        let wider = wider.collect();
        spread.set(step, quantity, mode, wider);
    }
}
