//! Filters with fixed gains: the table of equations when gain and innovation covariance are inputs.
//!
//! After this file the reader knows which entries change, and the two readings of a sentence that decide whether the filters exchange what
//! they know:
//!
//! ```text
//! mixed      x̂⁰ʲ = Σᵢ μᵢ∣ⱼ x̂ⁱ ─ F ─▶ x̂⁻ʲ ─ Kʲ (z − H x̂⁻ʲ) ─▶ x̂ʲ        Equations::fixed_gain
//! unmixed    x̂⁰ʲ = x̂ʲ           ─ F ─▶ x̂⁻ʲ ─ Kʲ (z − H x̂⁻ʲ) ─▶ x̂ʲ        Equations::fixed_gain_unmixed
//! ```
//!
//! What one mode needs is a [`FixedGain`]; where such gains come from is in [`crate::steady`].

use super::equations::undecided;
use super::{Equations, Problem};
use crate::filter::fixed_gain::FixedGain;
use crate::number::Real;

impl<T: Real, const N: usize, const M: usize> Equations<T, N, M> {
    /// Filters with fixed gains that start from mixed estimates — derbez2000 (fixed-gain-update), (fixed-gain-likelihood).
    ///
    /// Source: derbez2000, section 3, not numbered.
    ///
    /// ```text
    /// x̂⁰ʲ = Σᵢ μᵢ∣ⱼ x̂ⁱ     x̂⁻ʲ = Fʲ x̂⁰ʲ     νʲ = z − H x̂⁻ʲ     x̂ʲ = x̂⁻ʲ + Kʲ νʲ     ln Lⱼ = ln N(νʲ; 0, Sʲ)
    /// ```
    ///
    /// Probabilities and the combined mean are those of any interacting multiple model filter; there is no covariance anywhere. Kʲ and Sʲ
    /// are the problem's, see [`FixedGain`].
    ///
    /// Why: with its mixed states this is "the usual IMM algorithm", each of whose filters has the gain that it would end with if it
    /// were alone. The gain that the mixed covariance would give, which has the spread of the means in it, is another.
    ///
    /// Example: two filters with the gain ½, at 0 and at 4, exchange what they know and then see 6.
    ///
    /// ```
    /// use immaculate::filter::fixed_gain::FixedGain;
    /// use immaculate::{gaussian::Gaussian, imm::{Equations, Imm, Initial, Problem}};
    /// use immaculate::model::{Measurement, motion::Mode};
    /// use nalgebra::{matrix, vector};
    ///
    /// let still = Mode { name: "still".into(), transition: matrix![1.0], noise: matrix![1.0] };
    /// let problem = Problem {
    ///     modes: vec![still.clone(), still],
    ///     transition: vec![vec![0.5, 0.5], vec![0.5, 0.5]],
    ///     measurement: Measurement::Linear(matrix![1.0]),
    ///     measurement_noise: matrix![1.0],
    ///     rule: None,
    ///     fixed_gains: Some(vec![FixedGain { gain: matrix![0.5], innovation_covariance: matrix![2.0] }; 2]),
    /// };
    /// let at = |x| Gaussian { mean: vector![x], covariance: matrix![0.0] };
    /// let initial = Initial { modes: vec![at(0.0), at(4.0)], mode_probabilities: vec![0.5, 0.5] };
    /// let mut filter = Imm::new(problem, Equations::fixed_gain(), &initial)?;
    /// let step = filter.step(Some(&vector![6.0]))?;
    /// // Both start from ½ · 0 + ½ · 4, and end at 2 + ½ · (6 − 2).
    /// assert_eq!([&step.mixed[0].mean, &step.mixed[1].mean], [&vector![2.0], &vector![2.0]]);
    /// assert_eq!([&step.updated[0].mean, &step.updated[1].mean], [&vector![4.0], &vector![4.0]]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Evidence: `identical_modes_with_fixed_gains_are_the_filter_alone` (exact).
    pub fn fixed_gain() -> Self {
        Self {
            keeps_covariances: false,
            innovation_covariance: |problem, _, _, j| {
                given(problem, j, |given| given.innovation_covariance.clone()).unwrap_or_else(undecided)
            },
            gain: |problem, _, _, j| Ok(given(problem, j, |given| given.gain.clone()).unwrap_or_else(undecided)),
            ..Self::kalman()
        }
    }

    /// Filters with fixed gains that each go on from their own estimate: the same update read as it is printed, without mixed states —
    /// derbez2000 (fixed-gain-update).
    ///
    /// Source: derbez2000, section 3, not numbered.
    ///
    /// ```text
    /// μᵢ∣ⱼ = 1 for i = j and 0 else, so that x̂⁰ʲ = x̂ʲ
    /// ```
    ///
    /// Only the probabilities, which follow the chain, and the combined mean know of the other modes.
    ///
    /// Example: the two filters of [`Equations::fixed_gain`], each by itself.
    ///
    /// ```
    /// use immaculate::filter::fixed_gain::FixedGain;
    /// use immaculate::{gaussian::Gaussian, imm::{Equations, Imm, Initial, Problem}};
    /// use immaculate::model::{Measurement, motion::Mode};
    /// use nalgebra::{matrix, vector};
    ///
    /// let still = Mode { name: "still".into(), transition: matrix![1.0], noise: matrix![1.0] };
    /// let problem = Problem {
    ///     modes: vec![still.clone(), still],
    ///     transition: vec![vec![0.5, 0.5], vec![0.5, 0.5]],
    ///     measurement: Measurement::Linear(matrix![1.0]),
    ///     measurement_noise: matrix![1.0],
    ///     rule: None,
    ///     fixed_gains: Some(vec![FixedGain { gain: matrix![0.5], innovation_covariance: matrix![2.0] }; 2]),
    /// };
    /// let at = |x| Gaussian { mean: vector![x], covariance: matrix![0.0] };
    /// let initial = Initial { modes: vec![at(0.0), at(4.0)], mode_probabilities: vec![0.5, 0.5] };
    /// let mut filter = Imm::new(problem, Equations::fixed_gain_unmixed(), &initial)?;
    /// let step = filter.step(Some(&vector![6.0]))?;
    /// // 0 + ½ · (6 − 0), 4 + ½ · (6 − 4)
    /// assert_eq!([&step.updated[0].mean, &step.updated[1].mean], [&vector![3.0], &vector![5.0]]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Evidence: `unmixed_modes_with_fixed_gains_stand_alone` (exact).
    pub fn fixed_gain_unmixed() -> Self {
        Self {
            mixes: false,
            mixing_probability: |_, _, _, j, i| if i == j { T::one() } else { T::zero() },
            ..Self::fixed_gain()
        }
    }
}

/// A part of what is given for mode j in place of covariances; none where nothing is.
fn given<T, V, const N: usize, const M: usize>(
    problem: &Problem<T, N, M>,
    j: usize,
    part: fn(&FixedGain<T, N, M>) -> V,
) -> Option<V> {
    problem.fixed_gains.as_ref()?.get(j).map(part)
}
