//! Gaussian estimates: mean and covariance, the density of a residual, and the moments of a mixture.
//!
//! The interacting multiple model filter rests on three facts about Gaussians: the likelihood of a residual ([`log_density`]), and the
//! mean and covariance of a weighted mixture ([`mixture_mean`], [`mixture_covariance`]). Each cycle replaces a mixture by one Gaussian
//! with the same two moments twice: once to mix the estimates, and once to combine them for output.
//!
//! ```text
//! weights, (x̂ⁱ, Pⁱ) ─ mixture_mean ─▶ x̂ ─ mixture_covariance ─▶ P      several estimates become one
//! ν, S = L D Lᵀ ─ log_density ─▶ ln L                                   how well a mode explains the measurement
//! ```

use crate::matrix::{Holds, Ldl, Shapes, quadratic_form, rows};
use crate::number::{Field, Real};
use nalgebra::{Dim, OMatrix, OVector, U1};

/// A mean and a covariance.
#[derive(Debug, Clone, PartialEq)]
pub struct Gaussian<T: Field, N: Dim>
where
    Shapes: Holds<N>,
{
    /// The mean, in the units of the state.
    pub mean: OVector<T, N>,
    /// The covariance, N × N, symmetric, in products of the units of the state.
    pub covariance: OMatrix<T, N, N>,
}

impl<T: Field, N: Dim> Gaussian<T, N>
where
    Shapes: Holds<N>,
{
    /// The estimate with zero mean and zero covariance, to be overwritten.
    pub fn zeros(n: N) -> Self {
        Self {
            mean: OVector::zeros_generic(n, U1),
            covariance: OMatrix::zeros_generic(n, n),
        }
    }
}

/// Mean of a mixture — sustika2015 (7), (12), zhu2016 (55), (59), liu2017 (12), (23), derbez2000 (mixed-mean),
/// (combined-estimate).
///
/// ```text
/// x̂⁰ʲ = Σᵢ μᵢ∣ⱼ · x̂ⁱ   (mixed)          x̂ = Σⱼ μʲ · x̂ʲ   (combined)
/// ```
///
/// | paper     | here                  | shape | meaning                                             |
/// |-----------|-----------------------|-------|-----------------------------------------------------|
/// | μᵢ∣ⱼ, μʲ  | `weights[i]`          | R     | probability of component i, Σ = 1                    |
/// | x̂ⁱ        | `components[i].mean`  | N     | mean of component i, units of the state              |
///
/// Why: law of total expectation, E x = Σᵢ P(i) E(x ∣ i).
///
/// Example: three to one for the estimate at 0, against the one at 4.
///
/// ```
/// use immaculate::gaussian::{Gaussian, mixture_mean};
/// use nalgebra::{matrix, vector};
///
/// let low = Gaussian { mean: vector![0.0], covariance: matrix![1.0] };
/// let high = Gaussian { mean: vector![4.0], covariance: matrix![1.0] };
/// // ¾ · 0 + ¼ · 4
/// assert_eq!(mixture_mean(&[0.75, 0.25], &[low, high]), vector![1.0]);
/// ```
///
/// Errata: zhu2016 (55) lacks its limits i = 1…r and (59) a hat; liu2017 (12) starts its sum at i = 0. All notational.
///
/// Evidence: `mixed_moments_are_those_of_the_mixture` (symbolic).
pub fn mixture_mean<T: Field, N: Dim>(weights: &[T], components: &[Gaussian<T, N>]) -> OVector<T, N>
where
    Shapes: Holds<N>,
{
    let mut sum = OVector::zeros_generic(rows(&components[0].mean), U1);
    for (weight, component) in weights.iter().zip(components) {
        sum += &component.mean * weight.clone();
    }
    sum
}

/// Covariance of a mixture — derbez2000 (1), (combined-estimate), (moment-matching), sustika2015 (8), (13), zhu2016 (56), (60),
/// liu2017 (12), (24).
///
/// ```text
/// P⁰ʲ = Σᵢ μᵢ∣ⱼ · [ Pⁱ + (x̂ⁱ − x̂⁰ʲ)(x̂ⁱ − x̂⁰ʲ)ᵀ ]   (mixed)
/// P   = Σⱼ μʲ   · [ Pʲ + (x̂ʲ − x̂)(x̂ʲ − x̂)ᵀ ]        (combined)
/// ```
///
/// | paper     | here                        | shape | meaning                                     |
/// |-----------|-----------------------------|-------|---------------------------------------------|
/// | μᵢ∣ⱼ, μʲ  | `weights[i]`                | R     | probability of component i, Σ = 1           |
/// | Pⁱ        | `components[i].covariance`  | N × N | covariance of component i                   |
/// | x̂ⁱ        | `components[i].mean`        | N     | mean of component i                         |
/// | x̂⁰ʲ, x̂    | `mean`                      | N     | mean of the mixture, [`mixture_mean`]       |
///
/// Why: law of total covariance. The second term is the spread of the means; without it the filter is over-confident
/// exactly when its models disagree.
///
/// Of two components the spread is μ₁μ₂(x̂¹ − x̂²)(x̂¹ − x̂²)ᵀ, so that of any two estimates at most a quarter of their squared difference.
///
/// Example: the same two estimates. Three quarters of the covariance are the spread, and two famous mistakes lose it or take it about
/// another mean.
///
/// ```
/// use immaculate::gaussian::{Gaussian, mixture_covariance};
/// use nalgebra::{matrix, vector};
///
/// let weights = [0.75, 0.25];
/// let low = Gaussian { mean: vector![0.0], covariance: matrix![1.0] };
/// let high = Gaussian { mean: vector![4.0], covariance: matrix![1.0] };
/// let both = [low.clone(), high.clone()];
/// // ¾ · (1 + 1²) + ¼ · (1 + 3²)
/// assert_eq!(mixture_covariance(&weights, &both, &vector![1.0]), matrix![4.0]);
/// // Without the spread, ¾ · 1 + ¼ · 1: the disagreement is forgotten.
/// assert_eq!(low.covariance * weights[0] + high.covariance * weights[1], matrix![1.0]);
/// // About the mean of one of the two, ¾ · (1 + 0²) + ¼ · (1 + 4²).
/// assert_eq!(mixture_covariance(&weights, &both, &vector![0.0]), matrix![5.0]);
/// ```
///
/// Errata: liu2017 (12) starts its sum at i = 0 (notational). derbez2000 weighs the spread of two models in step 3 of its algorithm with
/// another mixing probability than μ₍l∣j₎, bounds it by a square of one in section 3.1, and takes Σ μʲ Pʲ for the error of the combined
/// estimate, of which it is only an upper bound.
///
/// Evidence: `mixed_moments_are_those_of_the_mixture` (symbolic), `printed_spread_of_two_models_is_not_the_mixed_covariance`,
/// `printed_bound_of_the_moment_matching_term_is_exceeded`, `printed_blend_of_the_errors_is_only_an_upper_bound` (exact).
pub fn mixture_covariance<T: Field, N: Dim>(
    weights: &[T],
    components: &[Gaussian<T, N>],
    mean: &OVector<T, N>,
) -> OMatrix<T, N, N>
where
    Shapes: Holds<N>,
{
    let mut sum = OMatrix::zeros_generic(rows(mean), rows(mean));
    for (weight, component) in weights.iter().zip(components) {
        let deviation = &component.mean - mean;
        let spread = &deviation * deviation.transpose();
        sum += (&component.covariance + spread) * weight.clone();
    }
    sum
}

/// Natural logarithm of the Gaussian density of a residual — sustika2015 (9), zhu2016 (57), liu2017 (21), derbez2000 (likelihood).
///
/// ```text
/// ln L = −½ ( νᵀ S⁻¹ ν + ln|2πS| ),     that is  L = |2πS|^(−½) · exp(−½ νᵀ S⁻¹ ν)
/// ln|2πS| = Σᵢ ln(2π Dᵢ)
/// ```
///
/// | paper    | here         | shape | meaning                                                              |
/// |----------|--------------|-------|----------------------------------------------------------------------|
/// | z − ẑ, ν | `residual`   | M     | the innovation, angles wrapped                                        |
/// | V, S     | `covariance` | M × M | innovation covariance as L D Lᵀ, [`ldl`](crate::matrix::ldl)          |
///
/// Why: the density of N(0, S) at ν, with |2πS| = (2π)ᴹ|S|. The logarithm is taken here and never left before the
/// probabilities are normalised, so a likelihood that would underflow a double is an ordinary number. The constant
/// (2π)^(−M/2) is common to all modes and cancels in their probabilities; |S|^(−½) is not and does not.
///
/// Example: a residual of 2 where the deviation is 2.
///
/// ```
/// use immaculate::{gaussian::log_density, matrix::ldl, number::Real};
/// use nalgebra::{matrix, vector};
///
/// let log_likelihood: f64 = log_density(&vector![2.0], &ldl(&matrix![4.0]));
/// // −½ (2²/4 + ln(2π · 4)); the product is the same one, so nothing is rounded differently
/// let by_hand = -(1.0 + Real::ln(&(2.0 * std::f64::consts::PI * 4.0))) / 2.0;
/// assert_eq!(log_likelihood, by_hand);
///
/// // A likelihood of e⁻⁵⁰⁰⁰⁰ is zero as a double, and its logarithm is an ordinary number: −½ (200²/0.4 + ln(0.8π)).
/// let far: f64 = log_density(&vector![200.0], &ldl(&matrix![0.4]));
/// assert_eq!((far.round(), far.exp()), (-50_000.0, 0.0));
/// ```
///
/// Errata: zhu2016 (57) writes the matrix 2πV under a scalar root and names the residual as the third argument of N;
/// liu2017 (21) prints the exponent −n_z/2 for −½, which squares the determinant when n_z = 2 and favours models with a small
/// innovation covariance. derbez2000 (not numbered) has 2π outside the determinant as zhu2016 has, which is right for its one component.
///
/// Evidence: `the_density_integrates_to_one` (property), `printed_likelihood_exponent_squares_the_determinant`,
/// `printed_likelihood_without_the_determinant_of_two_pi_is_not_a_density`,
/// `printed_likelihood_is_a_density_for_scalar_measurements_only`.
pub fn log_density<T: Real, M: Dim>(residual: &OVector<T, M>, covariance: &Ldl<T, M>) -> T
where
    Shapes: Holds<M>,
{
    let two_pi = T::pi() * T::integer(2);
    let mut log_determinant_of_two_pi_s = T::zero();
    for pivot in covariance.diagonal.iter() {
        log_determinant_of_two_pi_s += (two_pi.clone() * pivot.clone()).ln();
    }
    let squared_distance = quadratic_form(covariance, residual);
    -(squared_distance + log_determinant_of_two_pi_s) / T::integer(2)
}
