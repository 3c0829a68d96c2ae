//! Moment matching as a perturbation of fixed gains: which part of derbez2000's argument is right, and where it breaks.
//!
//! A gain moves if a mixed covariance replaces the filter's own, and nothing keeps this change small when one mode dominates.
//!
//! The paper's argument has four steps, each of which is a function here:
//!
//! | step                                                  | here                              | it is                         |
//! |-------------------------------------------------------|-----------------------------------|-------------------------------|
//! | the closed loop under P⁻ → P⁻ + ε F ΔP Fᵀ             | [`Perturbation::closed_loop`]     | right                         |
//! | its Taylor expansion                                  | [`Perturbation::first_order`]     | right to first order          |
//! | the spread of the means, from the filters' own errors | [`printed_spread_bound`]          | no bound; [`spread_bound`] is |
//! | ε ≈ (1 − a)² for ε = (μ¹∣²)²                          | [`printed_weight`]                | right only at μ₁ = μ₂ = ½     |

use super::riccati::closed_loop;
use crate::imm::probability;
use crate::number::Field;
use nalgebra::{RowSVector, SMatrix, SVector};

/// A filter of a scalar measurement whose covariance is moved.
#[derive(Debug, Clone, PartialEq)]
pub struct Perturbation<T, const N: usize> {
    /// F.
    pub transition: SMatrix<T, N, N>,
    /// H.
    pub measurement: RowSVector<T, N>,
    /// R.
    pub measurement_variance: T,
    /// P⁻.
    pub predicted: SMatrix<T, N, N>,
    /// ΔP, the change of the covariance before the prediction.
    pub change: SMatrix<T, N, N>,
}

impl<T: Field, const N: usize> Perturbation<T, N> {
    /// The change of the predicted covariance, ΔP⁻ = F ΔP Fᵀ.
    ///
    /// Source: derbez2000, section 3.1, not numbered.
    ///
    /// Example: constant velocity over two seconds, whose velocity becomes less certain.
    ///
    /// ```
    /// use immaculate::steady::perturbation::Perturbation;
    /// use nalgebra::matrix;
    ///
    /// let filter = Perturbation {
    ///     transition: matrix![1.0, 2.0; 0.0, 1.0],
    ///     measurement: matrix![1.0, 0.0],
    ///     measurement_variance: 1.0,
    ///     predicted: matrix![1.0, 0.0; 0.0, 1.0],
    ///     change: matrix![0.0, 0.0; 0.0, 3.0],
    /// };
    /// // A variance of 3 of the velocity becomes 2² · 3 of the position in two seconds.
    /// assert_eq!(filter.predicted_change(), matrix![12.0, 6.0; 6.0, 3.0]);
    /// ```
    pub fn predicted_change(&self) -> SMatrix<T, N, N> {
        &self.transition * &self.change * self.transition.transpose()
    }

    /// The matrix that carries the state from one update to the next, under the perturbation — derbez2000 (perturbed-transition).
    ///
    /// Source: derbez2000, section 3.1, not numbered.
    ///
    /// ```text
    /// A(ε) = ( I − (P⁻ + ε F ΔP Fᵀ) Hᵀ (P⁻₁₁ + ε (F ΔP Fᵀ)₁₁ + R)⁻¹ H ) F
    /// ```
    ///
    /// | paper  | here                   | shape | meaning                                        |
    /// |--------|------------------------|-------|------------------------------------------------|
    /// | P⁻     | `predicted`            | N × N | predicted covariance                            |
    /// | ΔP     | `change`               | N × N | what moment matching adds to the covariance     |
    /// | ε      | `epsilon`              |       | its size                                        |
    /// | P⁻₁₁   | H P⁻ Hᵀ                |       | variance of the predicted measurement           |
    /// | R      | `measurement_variance` |       | variance of the measurement                     |
    ///
    /// Why: A = (I − K H) F with the gain at the moved covariance.
    ///
    /// Example: for F = H = R = P⁻ = ΔP = 1: A(ε) = 1 − (1 + ε)/(2 + ε), 1/2 and 1/3.
    ///
    /// ```
    /// use immaculate::number::Rational;
    /// use immaculate::steady::perturbation::Perturbation;
    /// use nalgebra::matrix;
    ///
    /// let one = || matrix![Rational::new(1, 1)];
    /// let [transition, predicted, change] = [one(), one(), one()];
    /// let filter = Perturbation { transition, measurement: one(), measurement_variance: Rational::new(1, 1), predicted, change };
    /// assert_eq!(filter.closed_loop(&Rational::new(0, 1)), matrix![Rational::new(1, 2)]);
    /// assert_eq!(filter.closed_loop(&Rational::new(1, 1)), matrix![Rational::new(1, 3)]);
    /// ```
    ///
    /// Errata: the paper prints P₁₁ without its superscript.
    ///
    /// Evidence: `the_expansion_of_the_closed_loop_is_its_derivative` (symbolic).
    pub fn closed_loop(&self, epsilon: &T) -> SMatrix<T, N, N> {
        let moved = &self.predicted + self.predicted_change() * epsilon.clone();
        let gain = &moved * self.measurement.transpose() * (T::one() / self.innovation_variance(&moved));
        closed_loop(&gain, &self.measurement, &self.transition)
    }

    /// The first-order term: dA/dε at ε = 0 — derbez2000 (perturbed-transition).
    ///
    /// Source: derbez2000, section 3.1, not numbered.
    ///
    /// ```text
    /// A′ = ( K (F ΔP Fᵀ)₁₁ − F ΔP Fᵀ Hᵀ ) H F / (P⁻₁₁ + R)
    /// ```
    ///
    /// Why: d(P Hᵀ/(P₁₁ + R)) = ΔP Hᵀ/(P₁₁ + R) − P Hᵀ ΔP₁₁/(P₁₁ + R)², and K = P Hᵀ/(P₁₁ + R).
    ///
    /// Example: for F = H = R = P⁻ = ΔP = 1: A(ε) = 1/(2 + ε), whose derivative at zero is −1/4; here (1/2 − 1)/2.
    ///
    /// ```
    /// use immaculate::number::Rational;
    /// use immaculate::steady::perturbation::Perturbation;
    /// use nalgebra::matrix;
    ///
    /// let one = || matrix![Rational::new(1, 1)];
    /// let [transition, predicted, change] = [one(), one(), one()];
    /// let filter = Perturbation { transition, measurement: one(), measurement_variance: Rational::new(1, 1), predicted, change };
    /// assert_eq!(filter.first_order(), matrix![Rational::new(-1, 4)]);
    /// ```
    ///
    /// Evidence: `the_expansion_of_the_closed_loop_is_its_derivative` (symbolic).
    pub fn first_order(&self) -> SMatrix<T, N, N> {
        let (along_gain, along_change) = self.corrections();
        let variance = self.innovation_variance(&self.predicted);
        (along_gain - along_change) * (T::one() / variance)
    }

    /// The Taylor expansion as it is printed, with ε still in the second denominator.
    ///
    /// Source: derbez2000, section 3.1, not numbered.
    ///
    /// ```text
    /// A + ε K (F ΔP Fᵀ)₁₁ H F (P⁻₁₁ + R)⁻¹ − ε F ΔP Fᵀ Hᵀ (P⁻₁₁ + ε (F ΔP Fᵀ)₁₁ + R)⁻¹ H F
    /// ```
    ///
    /// Why: it agrees with [`Perturbation::closed_loop`] to first order and not beyond. With the same denominator, the one with ε, in both
    /// terms it would be no expansion but the exact value: [`Perturbation::exact_expansion`].
    ///
    /// Example: for F = H = R = P⁻ = ΔP = 1 and ε = 1: 1/2 + 1/2 · 1/2 − 1 · 1/3, where the closed loop is 1/3.
    ///
    /// ```
    /// use immaculate::number::Rational;
    /// use immaculate::steady::perturbation::Perturbation;
    /// use nalgebra::matrix;
    ///
    /// let one = || matrix![Rational::new(1, 1)];
    /// let [transition, predicted, change] = [one(), one(), one()];
    /// let filter = Perturbation { transition, measurement: one(), measurement_variance: Rational::new(1, 1), predicted, change };
    /// assert_eq!(filter.printed_expansion(&Rational::new(1, 1)), matrix![Rational::new(5, 12)]);
    /// ```
    ///
    /// Evidence: `the_expansion_of_the_closed_loop_is_its_derivative` (symbolic).
    pub fn printed_expansion(&self, epsilon: &T) -> SMatrix<T, N, N> {
        let (along_gain, along_change) = self.corrections();
        let here = T::one() / self.innovation_variance(&self.predicted);
        let moved = &self.predicted + self.predicted_change() * epsilon.clone();
        let there = T::one() / self.innovation_variance(&moved);
        self.closed_loop(&T::zero()) + (along_gain * here - along_change * there) * epsilon.clone()
    }

    /// The perturbed closed loop for every ε, however large: the printed expansion with ε in both denominators.
    ///
    /// ```text
    /// A(ε) = A + ε ( K (F ΔP Fᵀ)₁₁ − F ΔP Fᵀ Hᵀ ) H F / (P⁻₁₁ + ε (F ΔP Fᵀ)₁₁ + R)
    /// ```
    ///
    /// Source: P⁻Hᵀ/(S + εδ) = K − K εδ/(S + εδ) with S = P⁻₁₁ + R and δ = (F ΔP Fᵀ)₁₁; found here.
    ///
    /// Example: for F = H = R = P⁻ = ΔP = 1 and ε = 1: 1/2 + (1/2 − 1)/3, the closed loop itself.
    ///
    /// ```
    /// use immaculate::number::Rational;
    /// use immaculate::steady::perturbation::Perturbation;
    /// use nalgebra::matrix;
    ///
    /// let one = || matrix![Rational::new(1, 1)];
    /// let [transition, predicted, change] = [one(), one(), one()];
    /// let filter = Perturbation { transition, measurement: one(), measurement_variance: Rational::new(1, 1), predicted, change };
    /// assert_eq!(filter.exact_expansion(&Rational::new(1, 1)), matrix![Rational::new(1, 3)]);
    /// ```
    ///
    /// Evidence: `the_expansion_of_the_closed_loop_is_its_derivative` (symbolic).
    pub fn exact_expansion(&self, epsilon: &T) -> SMatrix<T, N, N> {
        let (along_gain, along_change) = self.corrections();
        let moved = &self.predicted + self.predicted_change() * epsilon.clone();
        let there = T::one() / self.innovation_variance(&moved);
        self.closed_loop(&T::zero()) + (along_gain - along_change) * (there * epsilon.clone())
    }

    /// K (F ΔP Fᵀ)₁₁ H F and F ΔP Fᵀ Hᵀ H F.
    fn corrections(&self) -> (SMatrix<T, N, N>, SMatrix<T, N, N>) {
        let h = &self.measurement;
        let change = self.predicted_change();
        let gain = &self.predicted * h.transpose() * (T::one() / self.innovation_variance(&self.predicted));
        let row = h * &self.transition;
        let along_gain = gain * self.seen(&change) * &row;
        (along_gain, change * h.transpose() * row)
    }

    /// H P Hᵀ + R.
    fn innovation_variance(&self, predicted: &SMatrix<T, N, N>) -> T {
        self.seen(predicted) + self.measurement_variance.clone()
    }

    /// H P Hᵀ, P₁₁ in the paper.
    fn seen(&self, predicted: &SMatrix<T, N, N>) -> T {
        let seen = &self.measurement * predicted * self.measurement.transpose();
        seen[(0, 0)].clone()
    }
}

/// What the spread of the means adds to mode i's covariance in the mixture for mode j, for two modes —
/// derbez2000 (algorithm-step-3), (moment-matching-bound).
///
/// Source: derbez2000 (1), and the identity below.
///
/// ```text
/// E (x̂ⁱ − x̂⁰ʲ)(x̂ⁱ − x̂⁰ʲ)ᵀ = (μˡ∣ʲ)² Dⁱˡ,   l ≠ i,   Dⁱˡ = E (x̂ⁱ − x̂ˡ)(x̂ⁱ − x̂ˡ)ᵀ
/// ```
///
/// | paper | here     | shape | meaning                                                                  |
/// |-------|----------|-------|--------------------------------------------------------------------------|
/// | μˡ∣ʲ  | `weight` |       | probability that mode j comes from the other mode, l                      |
/// | Dⁱˡ   | `gap`    | N × N | second moment of the difference of the two estimates                      |
///
/// Why: x̂ⁱ − x̂⁰ʲ = x̂ⁱ − μⁱ∣ʲ x̂ⁱ − μˡ∣ʲ x̂ˡ = μˡ∣ʲ (x̂ⁱ − x̂ˡ). Over both i with their weights it sums to μ¹∣ʲ μ²∣ʲ D.
///
/// Example: estimates 0 and 4, mixed 3/4 to 1/4: the mixed one is 1, and the first is 1 away from it, (1/4 · 4)².
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::perturbation::spread_term;
/// use nalgebra::matrix;
///
/// assert_eq!(spread_term(&Rational::new(1, 4), &matrix![Rational::new(16, 1)]), matrix![Rational::new(1, 1)]);
/// ```
///
/// Evidence: `the_spread_of_two_means_is_that_of_their_gap` (symbolic).
pub fn spread_term<T: Field, const N: usize>(weight: &T, gap: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
    gap * (weight.clone() * weight.clone())
}

/// What section 3.1 says bounds [`spread_term`].
///
/// Source: derbez2000, section 3.1, not numbered.
///
/// ```text
/// Σⱼ (μⁱ∣ʲ)² (1 − δᵢⱼ) Pᵉʲ
/// ```
///
/// | paper | here           | shape | meaning                                                              |
/// |-------|----------------|-------|----------------------------------------------------------------------|
/// | μⁱ∣ʲ  | `mixing[j][i]` | R × R | mixing probabilities, inside the current mode as everywhere here      |
/// | Pᵉʲ   | `errors[j]`    | N × N | true second moment of filter j's error                                |
/// | i     | `mode`         |       | the mode whose covariance is mixed                                    |
///
/// Example: errors 1 and −1: each has the second moment 1, their difference 4. Mixed in halves, the spread is 1/4 · 4 and its "bound" 1/4 ·
/// 1.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::perturbation::{printed_spread_bound, spread_term};
/// use nalgebra::matrix;
///
/// let q = Rational::new;
/// let mixing = vec![vec![q(1, 2), q(1, 2)]; 2];
/// let bound = printed_spread_bound(&mixing, &[matrix![q(1, 1)], matrix![q(1, 1)]], 0);
/// assert_eq!(bound, matrix![q(1, 4)]);
/// assert_eq!(spread_term(&q(1, 2), &matrix![q(4, 1)]), matrix![q(1, 1)]);
/// ```
///
/// Errata: it is no bound. The difference of two estimates is not the error of one of them: Dⁱˡ = Pᵉⁱ + Pᵉˡ − C − Cᵀ with the
/// covariance C of the two errors, and the paper keeps Pᵉˡ alone. For i = constant velocity that is the *small* one of the two. That the
/// chain is symmetric does not help: it only makes the weights (μⁱ∣ʲ)² and (μʲ∣ⁱ)² equal when μᵢ = μⱼ. [`spread_bound`] holds always.
///
/// Evidence: `the_printed_bound_of_the_spread_fails` (exact).
pub fn printed_spread_bound<T: Field, const N: usize>(
    mixing: &[Vec<T>],
    errors: &[SMatrix<T, N, N>],
    mode: usize,
) -> SMatrix<T, N, N> {
    let mut bound = SMatrix::zeros();
    for (j, error) in errors.iter().enumerate().filter(|(j, _)| *j != mode) {
        let weight = mixing[j][mode].clone();
        bound += error * (weight.clone() * weight);
    }
    bound
}

/// What does bound [`spread_term`], in the sense of matrices and whatever the two errors have in common.
///
/// ```text
/// (μˡ∣ʲ)² Dⁱˡ ⪯ 2 (μˡ∣ʲ)² (Pᵉⁱ + Pᵉˡ)
/// ```
///
/// Source: 2eeᵀ + 2ffᵀ − (e − f)(e − f)ᵀ = (e + f)(e + f)ᵀ ⪰ 0; the factor 2 is reached for f = −e.
///
/// Example: errors 1 and −1, mixed in halves: the spread is 1/4 · 4 = 1, and the bound 2 · 1/4 · (1 + 1) is reached.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::perturbation::spread_bound;
/// use nalgebra::matrix;
///
/// let one = matrix![Rational::new(1, 1)];
/// assert_eq!(spread_bound(&Rational::new(1, 2), [&one, &one]), one);
/// ```
///
/// Evidence: `twice_both_errors_bound_the_spread` (symbolic), `the_printed_bound_of_the_spread_fails` (exact).
pub fn spread_bound<T: Field, const N: usize>(weight: &T, errors: [&SMatrix<T, N, N>; 2]) -> SMatrix<T, N, N> {
    (errors[0] + errors[1]) * (T::integer(2) * weight.clone() * weight.clone())
}

/// μ¹∣²: how much of mode 2's mixed estimate comes from mode 1, in a symmetric chain of two modes — derbez2000
/// (moment-matching-size).
///
/// Source: derbez2000 (3), with p₁₁ = p₂₂ = a.
///
/// ```text
/// μ¹∣² = (1 − a) μ₁ / ((1 − a) μ₁ + a μ₂)
/// ```
///
/// | paper    | here          | meaning                                      |
/// |----------|---------------|----------------------------------------------|
/// | p₁₁ = p₂₂ | `stay`        | a, the probability that a mode stays          |
/// | μ₁       | `probability` | the probability of mode 1; μ₂ = 1 − μ₁        |
///
/// Why: Bayes' rule. It is 1 − a at μ₁ = ½ and rises to 1 as mode 1 becomes certain, however close to one a is: who is almost surely in
/// mode 1 and arrives in mode 2 has come from mode 1.
///
/// Example: a = 19/20. Between equals the weight is 1 − a; with μ₁ = 19/20 it is 1/20 · 19/20 over twice as much.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::perturbation::{other_mode_weight, printed_weight};
///
/// let (q, stay) = (Rational::new, Rational::new(19, 20));
/// assert_eq!(other_mode_weight(&stay, &q(1, 2)), printed_weight(&stay));
/// assert_eq!(other_mode_weight(&stay, &q(19, 20)), q(1, 2));
/// ```
///
/// Evidence: `the_weight_of_the_other_mode_is_small_only_between_equals` (symbolic, exact).
pub fn other_mode_weight<T: Field>(stay: &T, probability: &T) -> T {
    let switch = T::one() - stay.clone();
    let chain = [vec![stay.clone(), switch.clone()], vec![switch, stay.clone()]];
    let probabilities = [probability.clone(), T::one() - probability.clone()];
    let predicted = probability::predicted_mode_probability(&chain, &probabilities, 1);
    probability::mixing_probability(&chain, &probabilities, &predicted, 0, 1)
}

/// What section 3.1 takes [`other_mode_weight`] for: √ε ≈ 1 − a.
///
/// Source: derbez2000, section 3.1, not numbered: "if p₁₂ = p₂₁ = 1 − a then one can show ε ≈ (1 − a)²".
///
/// Example: a = 19/20.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::perturbation::printed_weight;
///
/// assert_eq!(printed_weight(&Rational::new(19, 20)), Rational::new(1, 20)); // whatever the mode probabilities
/// ```
///
/// Errata: true for μ₁ = μ₂ = ½ alone. With a = .95 and μ₁ = .95 the weight is ½ and ε is ¼, a hundred times the printed .0025. The
/// perturbation is not small exactly when one mode dominates, which is when the filter does what it is for.
///
/// Evidence: `the_weight_of_the_other_mode_is_small_only_between_equals` (symbolic, exact).
pub fn printed_weight<T: Field>(stay: &T) -> T {
    T::one() - stay.clone()
}

/// The second moment of a vector of errors with this mean and covariance: C + m mᵀ.
///
/// Source: the definition of a covariance.
///
/// Example: I + [1, 2]ᵀ [1, 2].
///
/// ```
/// use immaculate::steady::perturbation::second_moment;
/// use nalgebra::{matrix, vector};
///
/// let moment = second_moment(&vector![1.0, 2.0], &matrix![1.0, 0.0; 0.0, 1.0]);
/// assert_eq!(moment, matrix![2.0, 2.0; 2.0, 5.0]);
/// ```
pub fn second_moment<T: Field, const N: usize>(
    mean: &SVector<T, N>,
    covariance: &SMatrix<T, N, N>,
) -> SMatrix<T, N, N> {
    covariance + mean * mean.transpose()
}
