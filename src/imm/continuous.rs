//! Markov chains in continuous time: the transition matrix of a step of any length, from rates or from mean sojourn times.
//!
//! A chain that is written down per second need not be written down again for every step length. e^(G T) is computed without losing a
//! digit.
//!
//! ```text
//! τᵢ, rᵢⱼ ─ rates_of_sojourns ─▶ G ─ transition_over(T) ─▶ P = e^(G T), the chain of a step of length T
//! ```

use crate::number::{Field, Real};

/// Rates of a Markov chain from its mean sojourn times.
///
/// Source: J. L. Doob, Stochastic Processes, 1953, chapter VI: the time that a chain stays in a state is exponential, and where it goes
/// then does not depend on how long it stayed.
///
/// ```text
/// gᵢⱼ = rᵢⱼ / τᵢ for i ≠ j,   gᵢᵢ = −Σⱼ≠ᵢ gᵢⱼ
/// ```
///
/// | literature | here               | shape | unit | meaning                                                   |
/// |------------|--------------------|-------|------|-----------------------------------------------------------|
/// | τᵢ         | `sojourn_times[i]` | r     | s    | how long the target stays in mode i, on average            |
/// | rᵢⱼ        | `jumps[i][j]`      | r × r | 1    | P(mode j is next ∣ mode i is left); rᵢᵢ is not read        |
/// | gᵢⱼ        | result             | r × r | 1/s  | rate from mode i to mode j; rows sum to zero               |
///
/// Why: an exponential time with the mean τ has the rate 1/τ.
///
/// Example: straight for 4 s on average, then left or right alike; each of these for 2 s, and straight again. Taken for rates, the times
/// would make the straight mode the shortest.
///
/// ```
/// use immaculate::imm::continuous::rates_of_sojourns;
///
/// let jumps = vec![vec![0.0, 0.5, 0.5], vec![1.0, 0.0, 0.0], vec![1.0, 0.0, 0.0]];
/// let rates = rates_of_sojourns(&[4.0, 2.0, 2.0], &jumps);
/// assert_eq!(rates, [[-0.25, 0.125, 0.125], [0.5, -0.5, 0.0], [0.5, 0.0, -0.5]]);
/// ```
///
/// Evidence: `a_mean_sojourn_time_is_the_mean_of_the_time_to_leave` (exact).
pub fn rates_of_sojourns<T: Field>(sojourn_times: &[T], jumps: &[Vec<T>]) -> Vec<Vec<T>> {
    let of_row = |(i, row): (usize, &Vec<T>)| {
        let of_entry = |(j, jump): (usize, &T)| {
            if i == j {
                T::zero()
            } else {
                jump.clone() / sojourn_times[i].clone()
            }
        };
        row.iter().enumerate().map(of_entry).collect()
    };
    let rates: Vec<Vec<T>> = jumps.iter().enumerate().map(of_row).collect();
    over(&rates, &T::one())
}

/// The transition matrix of a chain in continuous time over a step of length T.
///
/// Source: A. N. Kolmogorov, Über die analytischen Methoden in der Wahrscheinlichkeitsrechnung, 1931: dP/dT = P G, P(0) = I. Scaling and
/// squaring: C. Moler and C. Van Loan, Nineteen Dubious Ways to Compute the Exponential of a Matrix, 1978, method 3.
///
/// ```text
/// P = e^(G T) = ( Σₖ Aᵏ/k! )^(2ˢ),   A = G T/2ˢ with s so large that a = 2 Σᵢ |aᵢᵢ| ≤ ½
/// ```
///
/// | literature | here          | shape | unit | meaning                                                                |
/// |------------|---------------|-------|------|------------------------------------------------------------------------|
/// | gᵢⱼ        | `rates[i][j]` | r × r | 1/s  | rate from mode i to mode j ≠ i; gᵢᵢ is minus their sum, and is not read  |
/// | T          | `interval`    |       | s    | length of the step                                                     |
/// | P          | result        | r × r | 1    | P(mode j at k ∣ mode i at k−1); rows sum to one                         |
///
/// Why: in a short time dT the target leaves mode i for j with the probability gᵢⱼ dT. I + G T is the first two terms only: it is no
/// chain at all where T is longer than a sojourn.
///
/// What is left of the series after K terms is at most 2 a^(K+1)/(K+1)! in each entry, as a bounds the norm of A and each further term is
/// at most half of the one before; number systems that know how far they are off take it in. A mode that cannot be reached keeps its zero.
/// Every row is divided by its sum, which is one: so errors of squaring do not add up in it. A number too large for all this leaves
/// every entry undecided.
///
/// Example: modes that change at the same rate g, ½(1 − e^(−2gT)) of them in a step: ¼ for 2gT = ln 2. After the Euler step it is gT.
///
/// ```
/// use immaculate::{imm::continuous::transition_over, number::Real};
///
/// let rate = Real::ln(&2.0_f64) / 2.0;
/// let chain = transition_over(&[vec![-rate, rate], vec![rate, -rate]], &1.0);
/// assert!((chain[0][1] - 0.25).abs() < 1e-16 && (chain[0][0] - 0.75).abs() < 1e-16);
/// assert!(rate > 0.34);
/// ```
///
/// Evidence: `a_chain_of_two_modes_is_its_closed_form`, `two_steps_of_a_half_are_one_step`, `the_rows_of_a_chain_over_any_time_sum_to_one`,
/// `a_mode_that_no_rate_leads_to_is_never_reached` (enclosed).
pub fn transition_over<T: Real>(rates: &[Vec<T>], interval: &T) -> Vec<Vec<T>> {
    let half = T::ratio(1, 2);
    let mut step = over(rates, interval);
    for doublings in 0..MOST_DOUBLINGS {
        let size = size_of(&step);
        if size <= half {
            let mut chain = exponential(&step, &size);
            for _ in 0..doublings {
                chain = summing_to_one(product(&chain, &chain));
            }
            return chain;
        }
        step = scaled(&step, &half);
    }
    vec![vec![T::undecided(); rates.len()]; rates.len()]
}

/// More halvings than the ratio of the largest to the smallest double has bits.
const MOST_DOUBLINGS: usize = 2200;

/// G T, the diagonal from the other entries.
fn over<T: Field>(rates: &[Vec<T>], interval: &T) -> Vec<Vec<T>> {
    let mut step = scaled(rates, interval);
    for (i, row) in step.iter_mut().enumerate() {
        row[i] = T::zero();
        row[i] = -sum(row);
    }
    step
}

/// a, which is at least the sum of the magnitudes in any row.
fn size_of<T: Field>(step: &[Vec<T>]) -> T {
    let leaving: Vec<T> = step.iter().enumerate().map(|(i, row)| -row[i].clone()).collect();
    sum(&leaving) * T::integer(2)
}

/// Σₖ Aᵏ/k! for a small A, with what is left of it.
fn exponential<T: Real>(step: &[Vec<T>], size: &T) -> Vec<Vec<T>> {
    let r = step.len();
    let one = |i: usize, j: usize| if i == j { T::one() } else { T::zero() };
    let mut term: Vec<Vec<T>> = (0..r).map(|i| (0..r).map(|j| one(i, j)).collect()).collect();
    let mut chain = term.clone();
    let mut rest = size.clone() * T::integer(2);
    // After r terms an entry that is zero still is one that no way leads to.
    for k in (1..).take(terms::<T>().max(r)) {
        term = scaled(&product(&term, step), &T::ratio(1, k));
        rest = rest * size.clone() / T::integer(k + 1);
        for (row, of_term) in chain.iter_mut().zip(&term) {
            for (entry, added) in row.iter_mut().zip(of_term) {
                *entry += added.clone();
            }
        }
    }
    for entry in chain.iter_mut().flatten().filter(|entry| !entry.is_zero()) {
        *entry += T::up_to(&rest);
    }
    summing_to_one(chain)
}

/// K, the number of terms of e^a, a ≤ ½, that leaves less than 2⁻ᵇ⁻¹⁶ of its b bits: the factors 2k of 2ᴷ K! have that many bits together.
fn terms<T: Real>() -> usize {
    let (mut bits, mut k) = (0, 0_u32);
    while bits < T::bits() + 16 {
        k += 1;
        bits += (2 * k).ilog2();
    }
    k as usize
}

/// The matrix times a number.
fn scaled<T: Field>(matrix: &[Vec<T>], factor: &T) -> Vec<Vec<T>> {
    let of_row = |row: &Vec<T>| row.iter().map(|entry| entry.clone() * factor.clone()).collect();
    matrix.iter().map(of_row).collect()
}

/// The product of two square matrices.
fn product<T: Field>(a: &[Vec<T>], b: &[Vec<T>]) -> Vec<Vec<T>> {
    let entry = |row: &Vec<T>, j: usize| {
        let parts: Vec<T> = row.iter().zip(b).map(|(x, of_b)| x.clone() * of_b[j].clone()).collect();
        sum(&parts)
    };
    a.iter()
        .map(|row| (0..b.len()).map(|j| entry(row, j)).collect())
        .collect()
}

/// Each row divided by its sum.
fn summing_to_one<T: Field>(chain: Vec<Vec<T>>) -> Vec<Vec<T>> {
    let of_row = |row: Vec<T>| {
        let total = sum(&row);
        row.into_iter().map(|entry| entry / total.clone()).collect()
    };
    chain.into_iter().map(of_row).collect()
}

fn sum<T: Field>(values: &[T]) -> T {
    values.iter().cloned().fold(T::zero(), |sum, value| sum + value)
}
