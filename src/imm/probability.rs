//! The mode probabilities: forward along the Markov chain, backward to the previous mode, and updated by Bayes' rule.
//!
//! This is the only part of the cycle that is not linear algebra. It is written in logarithms, because likelihoods underflow.
//!
//! ```text
//! pᵢⱼ, μᵢ ─ predicted_mode_probability ─▶ cⱼ ─ mixing_probability ─▶ μᵢ∣ⱼ ─▶ the estimates are mixed, predicted and updated ─▶ ln Lⱼ
//! ln Lⱼ ─ relative_likelihood ─▶ Λⱼ ─ with cⱼ, evidence ─▶ C ─ mode_probability ─▶ μⱼ of the next step
//! ```

use crate::number::{Field, Real};

/// Predicted mode probability — derbez2000 (3), sustika2015 (5), zhu2016 (54), liu2017 (13).
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
/// Example: the target is in mode 0 and stays there with ¾. Read by columns, the same chain gives numbers that are no probabilities.
///
/// ```
/// use immaculate::imm::probability::predicted_mode_probability;
///
/// let chain = vec![vec![0.75, 0.25], vec![0.5, 0.5]];
/// let c = [0, 1].map(|j| predicted_mode_probability(&chain, &[1.0, 0.0], j));
/// assert_eq!(c, [0.75, 0.25]); // ¾ · 1 + ½ · 0, ¼ · 1 + ½ · 0
/// let transposed = vec![vec![0.75, 0.5], vec![0.25, 0.5]];
/// let wrong = [0, 1].map(|j| predicted_mode_probability(&transposed, &[1.0, 0.0], j));
/// assert_eq!(wrong, [0.75, 0.5]);
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

/// Mixing probability — derbez2000 (3), sustika2015 (6), zhu2016 (54), liu2017 (13).
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
/// Example: both modes are equally likely before, and mode 0 is the one that keeps its targets.
///
/// ```
/// use immaculate::imm::probability::mixing_probability;
///
/// let chain = vec![vec![0.75, 0.25], vec![0.5, 0.5]];
/// // ¾ · ½ / (¾ · ½ + ½ · ½), ½ · ½ / (¾ · ½ + ½ · ½)
/// let into_mode_0 = [0, 1].map(|i| mixing_probability(&chain, &[0.5, 0.5], &0.625, i, 0));
/// assert_eq!(into_mode_0, [0.6, 0.4]);
/// ```
///
/// Errata: derbez2000 takes μ₁∣₂ for 1 − a, where p₁₂ = p₂₁ = 1 − a (section 3.1); it is that at even odds only, and tends to one with μ₁.
///
/// Evidence: `mixing_probabilities_sum_to_one_over_the_previous_modes` (symbolic),
/// `a_mode_that_cannot_be_reached_keeps_its_own_estimate_and_no_weight`,
/// `printed_size_of_the_mixing_probability_holds_at_even_odds_only` (exact).
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

/// Likelihood of a mode relative to the greatest one — sustika2015 (11), zhu2016 (58), liu2017 (22).
///
/// ```text
/// Λⱼ = Lⱼ / e^m = exp( ln Lⱼ − m ),   m = max ln L over the modes that can be reached
/// ```
///
/// | paper | here                           | shape | meaning                      |
/// |-------|--------------------------------|-------|------------------------------|
/// | ln Lⱼ | `log_likelihoods[j]`           | R     | log-likelihood of mode j     |
/// | cⱼ    | `predicted_mode_probabilities` | R     | predicted mode probabilities |
/// | j     | `mode`                         |       | the mode                     |
///
/// Why: the mode probabilities depend on ratios of likelihoods only, so all may be divided by the greatest. Then one is 1 and none
/// overflows, however small they are, and an outlier costs no digits of the probabilities' sum. A mode that cannot be reached has
/// no say in m, and a likelihood of zero.
///
/// Example: e⁻¹⁰⁰⁰ and e⁻¹⁰⁰¹ are zero as doubles; their ratio is e⁻¹.
///
/// ```
/// use immaculate::{imm::probability::relative_likelihood, number::Real};
///
/// let relative = [0, 1].map(|j| relative_likelihood(&[-1000.0, -1001.0], &[0.5, 0.5], j));
/// assert_eq!(relative, [1.0, Real::exp(&-1.0)]);
/// assert_eq!(Real::exp(&-1000.0_f64), 0.0);
/// ```
///
/// Evidence: `likelihoods_that_underflow_a_double_leave_the_probabilities_right`.
pub fn relative_likelihood<T: Real>(log_likelihoods: &[T], predicted_mode_probabilities: &[T], mode: usize) -> T {
    if predicted_mode_probabilities[mode].is_zero() {
        return T::zero();
    }
    let m = greatest(log_likelihoods, predicted_mode_probabilities);
    (log_likelihoods[mode].clone() - m).exp()
}

/// m, the greatest log-likelihood of the modes that can be reached.
///
/// Source: as [`relative_likelihood`].
fn greatest<T: Real>(log_likelihoods: &[T], predicted_mode_probabilities: &[T]) -> T {
    let reachable = log_likelihoods
        .iter()
        .zip(predicted_mode_probabilities)
        .filter(|(_, probability)| !probability.is_zero())
        .map(|(log_likelihood, _)| log_likelihood);
    let greater = |a, b| if b > a { b } else { a };
    reachable.reduce(greater).map_or_else(T::undecided, Clone::clone)
}

/// The normaliser of the mode probabilities — sustika2015 (10), zhu2016 (58), liu2017 (22).
///
/// ```text
/// C = Σⱼ Λⱼ cⱼ
/// ```
///
/// | paper  | here                           | shape | meaning                                                   |
/// |--------|--------------------------------|-------|-----------------------------------------------------------|
/// | Lⱼ, Λⱼ | `likelihoods[j]`               | R     | likelihoods, all relative to the same one                  |
/// | cⱼ     | `predicted_mode_probabilities` | R     | predicted mode probabilities                               |
///
/// Why: law of total probability; C e^m is the likelihood of the measurement under all modes together.
///
/// Example: likelihoods of 1 and ½ for modes of which the second is twice as probable.
///
/// ```
/// use immaculate::imm::probability::evidence;
/// assert_eq!(evidence(&[1.0, 0.5], &[0.25, 0.5]), 0.5); // 1 · ¼ + ½ · ½
/// ```
///
/// Errata: zhu2016 (58) sums to "nm" for r (notational). liu2017 (22) prints Lʲ under the sum over i, with which it cancels and the
/// measurement changes no probability: [`printed::mode_probability_22`](super::printed::mode_probability_22). derbez2000 (not numbered)
/// sums terms with the index j over i, which is a multiple of one of them.
///
/// Evidence: `printed_normaliser_makes_the_likelihood_cancel`,
/// `printed_index_of_the_normaliser_leaves_probabilities_that_do_not_sum_to_one` (exact).
pub fn evidence<T: Field>(likelihoods: &[T], predicted_mode_probabilities: &[T]) -> T {
    let mut sum = T::zero();
    for (likelihood, probability) in likelihoods.iter().zip(predicted_mode_probabilities) {
        sum += likelihood.clone() * probability.clone();
    }
    sum
}

/// Logarithm of the measurement's likelihood under all modes together, ln(C e^m) = m + ln C.
///
/// Source: zhu2016 (58), whose denominator it is; what a Bayesian comparison of whole filters sums over the steps.
///
/// Example: both modes find the measurement equally unlikely, and so does the filter.
///
/// ```
/// use immaculate::imm::probability::log_evidence;
/// // −1000 + ln(1 · ½ + 1 · ½)
/// assert_eq!(log_evidence(&[-1000.0, -1000.0], &[0.5, 0.5], &1.0), -1000.0);
/// ```
///
/// Evidence: `a_factor_common_to_all_likelihoods_changes_no_probability` (property).
pub fn log_evidence<T: Real>(log_likelihoods: &[T], predicted_mode_probabilities: &[T], evidence: &T) -> T {
    greatest(log_likelihoods, predicted_mode_probabilities) + evidence.ln()
}

/// Mode probability — sustika2015 (11), zhu2016 (58), liu2017 (22), derbez2000 (mode-probability).
///
/// ```text
/// μⱼ = Λⱼ cⱼ / C
/// ```
///
/// | paper  | here                         | meaning                                  |
/// |--------|------------------------------|------------------------------------------|
/// | Lⱼ, Λⱼ | `likelihood`                 | [`relative_likelihood`]                  |
/// | cⱼ     | `predicted_mode_probability` | predicted probability of mode j          |
/// | C      | `evidence`                   | [`evidence`]                             |
///
/// Why: Bayes' rule.
///
/// Example: the first mode was half as probable as the second and explains the measurement twice as well.
///
/// ```
/// use immaculate::imm::probability::{evidence, mode_probability};
///
/// let (likelihoods, predicted) = ([1.0, 0.5], [0.25, 0.5]);
/// let c = evidence(&likelihoods, &predicted);
/// assert_eq!([0, 1].map(|j| mode_probability(&likelihoods[j], &predicted[j], &c)), [0.5, 0.5]); // 1 · ¼ / ½, ½ · ½ / ½
/// ```
///
/// Evidence: `likelihoods_that_underflow_a_double_leave_the_probabilities_right`, `permuting_the_modes_permutes_the_answer` (property).
pub fn mode_probability<T: Field>(likelihood: &T, predicted_mode_probability: &T, evidence: &T) -> T {
    likelihood.clone() * predicted_mode_probability.clone() / evidence.clone()
}
