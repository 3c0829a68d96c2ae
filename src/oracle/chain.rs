//! The Markov chain of a problem file: one matrix for all steps, or rates from which the length of each step makes one.
//!
//! Rates and sojourn times are checked here, and become the chain of a step.

use super::invalid::{Class, Invalid};
use super::problem::{ProblemFile, Rows};
use super::well_formed::{check_length, check_matrix};
use crate::imm::continuous::{rates_of_sojourns, transition_over};
use crate::number::Real;

/// What a filter must take, beside its own kind, where the chain is given by rates or sojourn times.
pub(super) const CONTINUOUS_CHAIN: &str = "continuous-chain";

/// The rates of a chain in a number system, with what they were made of.
#[derive(Debug, Clone, PartialEq)]
pub struct ChainOfRates<T> {
    /// G.
    pub rates: Vec<Vec<T>>,
    /// The mean sojourn times and the jumps, if the file gives these.
    pub sojourns: Option<(Vec<T>, Vec<Vec<T>>)>,
    /// The length of a step.
    pub interval: T,
}

impl ProblemFile {
    /// Whether the chain is given by rates or by sojourn times, and so depends on the length of a step.
    pub(super) fn has_rates(&self) -> bool {
        self.rates.is_some() || self.sojourn_times.is_some()
    }

    /// The rates, for steps of this length; none where the chain is a matrix.
    pub(super) fn chain_of_rates<T: Real>(
        &self,
        number: fn(f64) -> T,
        interval: Option<f64>,
    ) -> Option<ChainOfRates<T>> {
        let list = |values: &[f64]| -> Vec<T> { values.iter().map(|&value| number(value)).collect() };
        let rows = |rows: &Rows| -> Vec<Vec<T>> { rows.iter().map(|row| list(row)).collect() };
        let sojourns = self.sojourn_times.as_ref().zip(self.jumps.as_ref());
        let sojourns = sojourns.map(|(times, jumps)| (list(times), rows(jumps)));
        let rates = match (&self.rates, &sojourns) {
            (Some(rates), _) => rows(rates),
            (None, Some((times, jumps))) => rates_of_sojourns(times, jumps),
            (None, None) => return None,
        };
        let interval = number(interval.unwrap_or(0.0));
        Some(ChainOfRates {
            rates,
            sojourns,
            interval,
        })
    }

    /// The chain of a step of this length.
    pub(super) fn chain<T: Real>(&self, number: fn(f64) -> T, interval: Option<f64>) -> Vec<Vec<T>> {
        if let Some(chain) = self.chain_of_rates(number, interval) {
            return transition_over(&chain.rates, &chain.interval);
        }
        let row = |row: &Vec<f64>| row.iter().map(|&value| number(value)).collect();
        self.transition.iter().map(row).collect()
    }

    /// The chain is said once, has the right shape, and knows how long a step is if it must.
    pub(super) fn check_chain(&self) -> Result<(), Invalid> {
        let r = self.modes.len();
        let is_missing = |key: &str, why: &str| {
            Err(Invalid::new(
                Class::Format,
                format!("problem.{key}"),
                format!("is missing{why}"),
            ))
        };
        match (
            self.transition.is_empty(),
            &self.rates,
            &self.sojourn_times,
            &self.jumps,
        ) {
            (false, None, None, None) => check_matrix("problem.transition", &self.transition, r, r),
            (true, Some(rates), None, None) => check_rates(rates, r),
            (true, None, Some(times), Some(jumps)) => check_sojourns(times, jumps, r),
            (true, None, None, None) => is_missing("transition", ""),
            (true, None, Some(_), None) => is_missing(
                "jumps",
                ", which says where a mode goes that is left after its `sojourn_times`",
            ),
            (true, None, None, Some(_)) => {
                is_missing("sojourn_times", ", which says when a mode is left for its `jumps`")
            }
            _ => {
                let reason = "has more than one of `transition`, `rates` and `sojourn_times`; a chain is said once";
                Err(Invalid::new(Class::Format, "problem", reason))
            }
        }?;
        let mut steps = self.measurements.iter().enumerate();
        let lacks = |(k, entry): &(usize, &_)| {
            let entry: &super::steps::MeasurementAt = entry;
            entry.transition.is_none() && self.interval(*k).is_none()
        };
        match steps.find(lacks).filter(|_| self.has_rates()) {
            Some((k, _)) => {
                let key = if self.rates.is_some() { "rates" } else { "sojourn_times" };
                let reason = format!("is missing: problem.{key} needs the length of every step");
                Err(Invalid::new(
                    Class::Format,
                    format!("problem.measurements[{k}].T"),
                    reason,
                ))
            }
            None => Ok(()),
        }
    }
}

/// Rates are finite, none is negative beside the diagonal, and each row sums to zero, within 10⁻¹⁵ an entry of its greatest.
fn check_rates(rates: &Rows, r: usize) -> Result<(), Invalid> {
    check_matrix("problem.rates", rates, r, r)?;
    for (i, row) in rates.iter().enumerate() {
        check_numbers(&format!("problem.rates[{i}]"), row, |j| j != i)?;
        let (sum, greatest) = (
            row.iter().sum::<f64>(),
            row.iter().fold(0.0, |most: f64, rate| most.max(rate.abs())),
        );
        if sum.abs() > 1e-15 * r as f64 * greatest {
            let reason = format!(
                "sums to {sum}; it must sum to 0: its diagonal is minus the rate at which the mode is left (Kolmogorov 1931)"
            );
            return Err(Invalid::new(
                Class::NotAProbability,
                format!("problem.rates[{i}]"),
                reason,
            ));
        }
    }
    Ok(())
}

/// Sojourn times are positive; jumps lead to other modes, and are probabilities.
fn check_sojourns(times: &[f64], jumps: &Rows, r: usize) -> Result<(), Invalid> {
    check_length("problem.sojourn_times", times.len(), r)?;
    check_matrix("problem.jumps", jumps, r, r)?;
    for (i, time) in times.iter().enumerate() {
        if !(time.is_finite() && *time > 0.0) {
            let reason = format!("is {time}; a mode lasts for some time, longer than 0 (Doob 1953)");
            return Err(Invalid::new(
                Class::Range,
                format!("problem.sojourn_times[{i}]"),
                reason,
            ));
        }
    }
    for (i, row) in jumps.iter().enumerate() {
        let place = format!("problem.jumps[{i}]");
        check_numbers(&place, row, |_| true)?;
        if row[i] != 0.0 {
            let reason = format!(
                "is {}; a mode that is left is left for another, so it must be 0",
                row[i]
            );
            return Err(Invalid::new(Class::NotAProbability, format!("{place}[{i}]"), reason));
        }
        let sum = row.iter().sum::<f64>();
        if r > 1 && (sum - 1.0).abs() > 1e-15 * r as f64 {
            let reason = format!("sums to {sum}; it must sum to 1 (Doob 1953)");
            return Err(Invalid::new(Class::NotAProbability, place, reason));
        }
    }
    Ok(())
}

/// Numbers are finite, and those of some places are not negative.
fn check_numbers(place: &str, row: &[f64], is_positive: impl Fn(usize) -> bool) -> Result<(), Invalid> {
    for (j, value) in row.iter().enumerate() {
        if !value.is_finite() {
            return Err(Invalid::new(Class::NotFinite, format!("{place}[{j}]"), "is not finite"));
        }
        if *value < 0.0 && is_positive(j) {
            let reason = format!("is {value}; it must not be negative");
            return Err(Invalid::new(Class::NotAProbability, format!("{place}[{j}]"), reason));
        }
    }
    Ok(())
}
