//! The equations of smoothing among modes: which mode was before, if this one is after.
//!
//! Every pair of a mode i at a step and a mode j at the next goes back by the step of
//! [`rauch_tung_striebel`](super::rauch_tung_striebel): from the smoothed estimate of mode j, through the motion of mode j, to the updated
//! estimate of mode i. The pairs are weighed, and merged for each mode i:
//!
//! ```text
//! x̂ⁱ, Pⁱ ─ motion of mode j ─▶ x̂⁻ⁱʲ, P⁻ⁱʲ, Dⁱʲ ─ with x̂ˢ₊ʲ, Pˢ₊ʲ, smoother_gain, … ─▶ x̂ⁱʲ, Pⁱʲ ─ mixture over j ─▶ x̂ˢⁱ, Pˢⁱ
//! μᵢ∣ⱼ, x̂ˢ₊ʲ, x̂⁻ⁱʲ, P⁻ⁱʲ ─ SwitchingSmoother ─▶ P(i ∣ j) ─ with μˢ₊ⱼ, pair_probability ─▶ P(i, j) ─ sum over j ─▶ μˢᵢ
//! ```
//!
//! Two published smoothers differ in P(i ∣ j) alone: [`SwitchingSmoother`]. Both take the estimate of mode j for that of the pair,
//! whichever mode was before.
//!
//! Two other forms are not here. One divides the smoothed mixture by the mixed one, to take the modes apart again (information form, see
//! R. Lopez and P. Danès, Low-Complexity IMM Smoothing for Jump Markov Nonlinear Systems, 2017): where modes disagree, the smoothed
//! covariance of a mode can exceed the predicted one, and the quotient is no Gaussian. The other runs a second filter backward
//! (R. E. Helmick, W. D. Blair and S. A. Hoffman, Fixed-Interval Smoothing for Markovian Switching Systems, 1995), and undoes the motion.

#[cfg(doc)]
use crate::gaussian::log_density;
use crate::number::Field;

/// What says which mode was before, if mode j is after: P(i ∣ j).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SwitchingSmoother {
    /// The chain, and the smoothed estimate of mode j, which the prediction from the right mode i meets: expectation correction.
    ///
    /// Source: D. Barber, Expectation Correction for Smoothed Inference in Switching Linear Dynamical Systems, 2006, here with one Gaussian
    /// a mode.
    ///
    /// ```text
    /// P(i ∣ j) = Λᵢⱼ μᵢ∣ⱼ / Σₗ Λₗⱼ μₗ∣ⱼ,   ln Λᵢⱼ = ln N(x̂ˢ₊ʲ; x̂⁻ⁱʲ, P⁻ⁱʲ)
    /// ```
    ///
    /// Why: P(i ∣ x(k+1), j, z₁…z₍k₎) is in proportion to μᵢ∣ⱼ N(x(k+1); x̂⁻ⁱʲ, P⁻ⁱʲ), exactly. Its average over x(k+1) has no closed form;
    /// it is taken at the mean, by [`log_density`] of the difference, angles wrapped.
    ///
    /// Example: two modes at 0 and 8 whose motion doubles nothing; the one after is at 7 in the end, so that it came from 8.
    ///
    /// ```
    /// use immaculate::imm::probability::{evidence, mode_probability, relative_likelihood};
    /// use immaculate::{gaussian::log_density, matrix::ldl};
    /// use nalgebra::{matrix, vector};
    ///
    /// let log_likelihoods = [0.0, 8.0].map(|predicted| log_density(&vector![7.0 - predicted], &ldl(&matrix![2.0])));
    /// let mixing = [0.75, 0.25];
    /// let likelihoods = [0, 1].map(|i| relative_likelihood(&log_likelihoods, &mixing, i));
    /// let of = |i: usize| mode_probability(&likelihoods[i], &mixing[i], &evidence(&likelihoods, &mixing));
    /// assert!(of(1) > 0.9999); // by e^(½ (7² − 1²)/2) = e¹², against ¾ to ¼
    /// ```
    ///
    /// Evidence: `one_step_back_to_a_known_mode_is_the_posterior_of_bayes`,
    /// `smoothing_lessens_the_error_of_a_target_that_switches` (smoothers).
    ExpectationCorrection,
    /// The chain alone.
    ///
    /// Source: C.-J. Kim, Dynamic linear models with Markov-switching, 1994.
    ///
    /// ```text
    /// P(i ∣ j) = μᵢ∣ⱼ = pᵢⱼ μᵢ / cⱼ
    /// ```
    ///
    /// Why: where all modes have one estimate, what comes later knows of mode i through mode j only. Else it is the coarser
    /// approximation. Where a mode has little noise it can be worse than no smoothing: a pair that the estimates exclude keeps its weight.
    ///
    /// Example: the same two modes. That the target is at 7 changes nothing.
    ///
    /// ```
    /// use immaculate::imm::probability::mixing_probability;
    ///
    /// let chain = vec![vec![0.75, 0.25], vec![0.25, 0.75]];
    /// assert_eq!([0, 1].map(|i| mixing_probability(&chain, &[0.5, 0.5], &0.5, i, 0)), [0.75, 0.25]);
    /// ```
    ///
    /// Evidence: `the_chain_read_backward_is_the_sum_over_all_sequences` (smoothers, exact),
    /// `smoothing_lessens_the_error_of_a_target_that_switches` (smoothers).
    Kim,
}

/// Probability that mode i was before and mode j after, given all measurements.
///
/// Source: as [`SwitchingSmoother`]; for the chain alone, L. E. Baum, T. Petrie, G. Soules and N. Weiss, A Maximization Technique Occurring
/// in the Statistical Analysis of Probabilistic Functions of Markov Chains, 1970.
///
/// ```text
/// P(i, j) = P(i ∣ j) μˢ₊ⱼ,   μˢᵢ = Σⱼ P(i, j)
/// ```
///
/// | literature | here       | meaning                                                       |
/// |------------|------------|---------------------------------------------------------------|
/// | P(i ∣ j)   | `backward` | of the mode before, [`SwitchingSmoother`]                     |
/// | μˢ₊ⱼ       | `smoothed` | smoothed probability of mode j at step k+1                    |
///
/// Why: the product rule, and the law of total probability.
///
/// Example: mode j is as probable as not in the end; if it is, it came from itself with ¾.
///
/// ```
/// use immaculate::smoother::switching::pair_probability;
///
/// assert_eq!(pair_probability(&0.75, &0.5), 0.375); // ¾ · ½
/// ```
///
/// Evidence: `the_chain_read_backward_is_the_sum_over_all_sequences` (smoothers, exact).
pub fn pair_probability<T: Field>(backward: &T, smoothed: &T) -> T {
    backward.clone() * smoothed.clone()
}
