//! Random numbers for problems that people read: short decimals, covariances far from singular.
//!
//! A problem depends only on its seed and its number: each number has its own stream of one named, portable generator.

use crate::number::Real;
use crate::oracle::problem::Rows;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// The random numbers of one problem.
pub(super) struct Draw(ChaCha8Rng);

impl Draw {
    /// Those of the problem of this number, of this seed.
    pub(super) fn new(seed: u64, number: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(number);
        Self(generator)
    }

    /// A number between two others, uniform.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        const SPACING: f64 = 1.0 / (1_u64 << 53) as f64;
        low + (high - low) * ((self.0.next_u64() >> 11) as f64 * SPACING)
    }

    /// Whether something happens that has this probability.
    pub(super) fn happens(&mut self, probability: f64) -> bool {
        self.between(0.0, 1.0) < probability
    }

    /// One of 0, 1, …, `count` − 1. The remainder prefers none of so few by more than 2⁻⁶⁰.
    pub(super) fn below(&mut self, count: usize) -> usize {
        let number = self.0.next_u64() % (count.max(1) as u64);
        usize::try_from(number).unwrap_or(0)
    }

    /// One of several.
    pub(super) fn one_of<T: Copy>(&mut self, several: &[T]) -> Option<T> {
        several.get(self.below(several.len())).copied()
    }

    /// A standard Gaussian number, by the Box-Muller transform.
    pub(super) fn normal(&mut self) -> f64 {
        let (u, v) = (1.0 - self.between(0.0, 1.0), self.between(0.0, 1.0));
        Real::sqrt(&(-2.0 * Real::ln(&u))) * Real::cos(&(2.0 * f64::pi() * v))
    }

    /// Standard deviations between two bounds.
    pub(super) fn deviations(&mut self, count: usize, low: f64, high: f64) -> Vec<f64> {
        (0..count).map(|_| self.between(low, high)).collect()
    }

    /// A covariance with these deviations and all its correlations, of two digits.
    ///
    /// C = ⅖ I + ⅗ G, where G has the cosines between random directions: no eigenvalue of C is below ⅖, and two digits move none by more
    /// than 0.05 n.
    pub(super) fn covariance(&mut self, deviations: &[f64]) -> Rows {
        let n = deviations.len();
        let directions: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| self.normal()).collect()).collect();
        let product =
            |i: usize, j: usize| -> f64 { directions[i].iter().zip(&directions[j]).map(|(a, b)| a * b).sum() };
        let entry = |i: usize, j: usize| {
            let cosine = product(i, j) / Real::sqrt(&(product(i, i) * product(j, j)));
            let correlation = if i == j { 1.0 } else { 0.6 * cosine };
            rounded(deviations[i] * deviations[j] * correlation, 2)
        };
        (0..n)
            .map(|i| (0..n).map(|j| entry(i.max(j), i.min(j))).collect())
            .collect()
    }

    /// A given number of probabilities with two decimals, none of them zero, that sum to one; the one at `favourite` is the greatest.
    pub(super) fn probabilities(&mut self, count: usize, favourite: usize) -> Vec<f64> {
        // At most 3 · 15 of 100 are given away.
        let mut hundredths: Vec<usize> = (0..count).map(|_| 3 + self.below(13)).collect();
        let others: usize = (0..count).filter(|&i| i != favourite).map(|i| hundredths[i]).sum();
        hundredths[favourite] = 100 - others;
        hundredths.into_iter().map(|part| part as f64 / 100.0).collect()
    }
}

/// The double nearest to the decimal with a number of significant digits; a zero has no sign.
pub(super) fn rounded(value: f64, digits: usize) -> f64 {
    let places = digits.max(1) - 1;
    format!("{value:.places$e}").parse().unwrap_or(value) + 0.0
}

/// A number rounded to about a hundredth of a spread.
pub(super) fn rounded_to_spread(value: f64, spread: f64) -> f64 {
    let digits = libm::log10(value.abs().max(spread)) - libm::log10(spread) + 2.0;
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 1 and 15"
    )]
    let digits = if digits.is_finite() {
        digits.clamp(1.0, 15.0) as usize
    } else {
        3
    };
    rounded(value, digits)
}

/// The matrix with ones where row and column are the same.
pub(super) fn leading_identity(rows: usize, columns: usize) -> Rows {
    let entry = |row: usize, column: usize| f64::from(u8::from(row == column));
    (0..rows)
        .map(|row| (0..columns).map(|column| entry(row, column)).collect())
        .collect()
}
