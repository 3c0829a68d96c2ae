//! The probabilities of the modes: forward along the Markov chain, backward to where a mode came from, and updated by Bayes' rule.
//!
//! After this file the reader knows the only part of the cycle that is not linear algebra, and why it is written in logarithms.

use crate::number::{Field, Real};
use std::cmp::Ordering;

/// Predicted mode probability — zhu2016 (54), liu2017 (13).
///
/// ```text
/// cⱼ = Σᵢ pᵢⱼ μᵢ
/// ```
///
/// | paper | here                    | shape | meaning                                                     |
/// |-------|-------------------------|-------|-------------------------------------------------------------|
/// | pᵢⱼ   | `transition[i][j]`      | R × R | P(mode j at k ∣ mode i at k−1); rows sum to one              |
/// | μᵢ    | `mode_probabilities[i]` | R     | P(mode i at k−1 ∣ z₁…z₍k−1₎)                                 |
/// | j     | `mode`                  |       | the current mode                                            |
///
/// Why: law of total probability.
///
/// # Examples
///
/// ```
/// use immaculate::imm::probability::predicted_mode_probability;
///
/// let chain = vec![vec![0.75, 0.25], vec![0.5, 0.5]];
/// assert_eq!(predicted_mode_probability(&chain, &[1.0, 0.0], 1), 0.25);
/// ```
///
/// Evidence: `without_information_probabilities_follow_the_markov_chain` (exact).
pub fn predicted_mode_probability<T: Field>(transition: &[Vec<T>], mode_probabilities: &[T], mode: usize) -> T {
    let mut sum = T::zero();
    for (row, probability) in transition.iter().zip(mode_probabilities) {
        sum += row[mode].clone() * probability.clone();
    }
    sum
}

/// Mixing probability — zhu2016 (54), liu2017 (13).
///
/// ```text
/// μᵢ∣ⱼ = pᵢⱼ μᵢ / cⱼ
/// ```
///
/// | paper | here                         | shape | meaning                                                      |
/// |-------|------------------------------|-------|--------------------------------------------------------------|
/// | pᵢⱼ   | `transition[i][j]`           | R × R | P(mode j at k ∣ mode i at k−1); rows sum to one               |
/// | μᵢ    | `mode_probabilities[i]`      | R     | P(mode i at k−1 ∣ z₁…z₍k−1₎)                                  |
/// | cⱼ    | `predicted_mode_probability` |       | [`predicted_mode_probability`]                               |
/// | i, j  | `previous`, `current`        |       | the mode come from, the mode come to                         |
///
/// Why: Bayes' rule, P(i at k−1 ∣ j at k) = P(j at k ∣ i at k−1) P(i at k−1) / P(j at k). Over i they sum to one.
///
/// A mode that cannot be reached has cⱼ = 0 and no answer. It keeps its own estimate, μᵢ∣ⱼ = 1 for i = j: its probability is
/// zero, so no value with a positive probability depends on this choice, and it is ready when the chain reaches it.
///
/// # Examples
///
/// ```
/// use immaculate::imm::probability::mixing_probability;
///
/// let chain = vec![vec![0.75, 0.25], vec![0.5, 0.5]];
/// // ¾ · ½ / (¾ · ½ + ½ · ½)
/// assert_eq!(mixing_probability(&chain, &[0.5, 0.5], &0.625, 0, 0), 0.6);
/// ```
///
/// Evidence: `mixing_probabilities_sum_to_one_over_the_previous_modes` (symbolic),
/// `a_mode_that_cannot_be_reached_keeps_its_own_estimate_and_no_weight`.
pub fn mixing_probability<T: Field>(
    transition: &[Vec<T>],
    mode_probabilities: &[T],
    predicted_mode_probability: &T,
    previous: usize,
    current: usize,
) -> T {
    if predicted_mode_probability.is_zero() {
        return if previous == current { T::one() } else { T::zero() };
    }
    transition[previous][current].clone() * mode_probabilities[previous].clone() / predicted_mode_probability.clone()
}

/// Logarithm of the measurement's likelihood under all modes together — zhu2016 (58), liu2017 (22).
///
/// ```text
/// ln C,   C = Σⱼ Lⱼ cⱼ
///       = m + ln Σⱼ exp( ln Lⱼ + ln cⱼ − m ),   m = maxⱼ ( ln Lⱼ + ln cⱼ )
/// ```
///
/// | paper | here                           | shape | meaning                         |
/// |-------|--------------------------------|-------|---------------------------------|
/// | ln Lⱼ | `log_likelihoods[j]`           | R     | log-likelihood of mode j        |
/// | cⱼ    | `predicted_mode_probabilities` | R     | predicted mode probabilities    |
///
/// Why: the second line is the first for any m; with the greatest term as m one exponential is 1 and none overflows, however small
/// the likelihoods are. Modes of probability zero have no term.
///
/// Errata: zhu2016 (58) sums to "nm" for r (notational). liu2017 (22) prints Lʲ under the sum over i, with which it cancels and the
/// measurement changes no probability: [`printed::mode_probability_22`](super::printed::mode_probability_22).
///
/// Evidence: `likelihoods_that_underflow_a_double_leave_the_probabilities_right`,
/// `printed_normaliser_makes_the_likelihood_cancel`.
pub fn log_evidence<T: Real>(log_likelihoods: &[T], predicted_mode_probabilities: &[T]) -> T {
    // (m, Σ exp(term − m)) over the terms so far; a new greatest term rescales the sum.
    let mut so_far: Option<(T, T)> = None;
    for (log_likelihood, probability) in log_likelihoods.iter().zip(predicted_mode_probabilities) {
        if probability.is_zero() {
            continue;
        }
        let term = log_likelihood.clone() + probability.ln();
        so_far = Some(match so_far {
            None => (term, T::one()),
            Some((m, sum)) if term.partial_cmp(&m) == Some(Ordering::Greater) => {
                let rescaled = sum * (m - term.clone()).exp();
                (term, rescaled + T::one())
            }
            Some((m, sum)) => {
                let share = (term - m.clone()).exp();
                (m, sum + share)
            }
        });
    }
    match so_far {
        Some((m, sum)) => m + sum.ln(),
        None => T::undecided(),
    }
}

/// Mode probability — zhu2016 (58), liu2017 (22).
///
/// ```text
/// μⱼ = Lⱼ cⱼ / C = exp( ln Lⱼ + ln cⱼ − ln C )
/// ```
///
/// | paper | here                         | meaning                                                |
/// |-------|------------------------------|--------------------------------------------------------|
/// | ln Lⱼ | `log_likelihood`             | log-likelihood of mode j                               |
/// | cⱼ    | `predicted_mode_probability` | predicted probability of mode j                        |
/// | ln C  | `log_evidence`               | [`log_evidence`]                                       |
///
/// Why: Bayes' rule. A mode of predicted probability zero keeps it.
///
/// # Examples
///
/// ```
/// use immaculate::imm::probability::{log_evidence, mode_probability};
///
/// // Likelihoods e⁻¹⁰⁰⁰ and e⁻¹⁰⁰¹ are zero as doubles; their ratio is e.
/// let evidence = log_evidence(&[-1000.0, -1001.0], &[0.5, 0.5]);
/// let first: f64 = mode_probability(&-1000.0, &0.5, &evidence);
/// assert!((first - 1.0 / (1.0 + (-1.0_f64).exp())).abs() < 1e-12);
/// ```
///
/// Evidence: as [`log_evidence`], `permuting_the_modes_permutes_the_answer` (property).
pub fn mode_probability<T: Real>(log_likelihood: &T, predicted_mode_probability: &T, log_evidence: &T) -> T {
    if predicted_mode_probability.is_zero() {
        return T::zero();
    }
    (log_likelihood.clone() + predicted_mode_probability.ln() - log_evidence.clone()).exp()
}
