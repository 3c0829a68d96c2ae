//! The two fixed-gain filters of derbez2000, and the growth of their errors when they mix their estimates.
//!
//! There are three criteria of stability, and each answers a different question.
//!
//! Between two measurements filter j starts from the mixed estimate, so its error without noise is eⱼ ↦ Aⱼ Σᵢ μᵢ∣ⱼ eᵢ, Aⱼ = (I − Kⱼ H) Fⱼ:
//!
//! | the mixing probabilities μᵢ∣ⱼ are | the errors stay bounded exactly if                                | here                    |
//! |-----------------------------------|-------------------------------------------------------------------|-------------------------|
//! | none: filters do not mix          | each Aⱼ has a spectral radius below one, which the Riccati equation grants | [`super::riccati`] |
//! | constant                          | diag(Aⱼ) (U ⊗ I) has, U\[j\]\[i\] = μᵢ∣ⱼ                          | [`frozen_matrix`]       |
//! | any, at every step                | the joint spectral radius of {Aⱼ} is below one                     | [`super::certificate`]  |
//!
//! Why the last line holds. *Enough*: with a joint spectral radius below one there is a norm in which every ‖Aⱼ‖ ≤ λ < 1 (Rota and
//! Strang 1960), and ‖Aⱼ Σᵢ μᵢ∣ⱼ eᵢ‖ ≤ λ maxᵢ ‖eᵢ‖, since the μᵢ∣ⱼ sum to one. Whatever the data do, bounded noise makes a bounded error.
//! *Necessary*: with μ near (1, 0) both filters start from the first, with μ near (0, 1) from the second; so each product
//! Aⱼₙ ⋯ Aⱼ₁ is approached, and one with a spectral radius above one carries errors away.
//!
//! A joint spectral radius below one bounds the error; it does not make two filters that see the same data agree in the end, since their
//! mode probabilities depend on their own estimates.
//!
//! The matrices are in coordinates scaled by D = diag(1, t, t²), in which every scan time is one; a change of coordinates alters no
//! spectral radius.

use super::gains;
use super::polynomial::MatrixRows;
use super::riccati::closed_loop;
use crate::imm::probability::{mixing_probability, predicted_mode_probability};
use crate::matrix::{Holds, Shapes, rows};
use crate::model::acceleration::{constant_acceleration, embedded_constant_velocity, position_matrix};
use crate::number::Field;
use nalgebra::{Dim, Matrix3, OMatrix, SMatrix};

/// (I − K H) F of the constant velocity filter with a damping root, in scaled coordinates — derbez2000 (7).
///
/// Why it is stable for every θ in (0, 1): its characteristic polynomial is λ p(λ) with p(1) = 2(1 − θ)² > 0, p(−1) = 4θ > 0 and
/// p(0) = θ² < 1, which puts both roots of p inside the unit circle.
///
/// Source: derbez2000, section 2.2.
///
/// Example: for θ = 1/2: K = [3/4, 1/2, 0]ᵀ, so (I − K H) F has 1/4 of F's first row, and its second less 1/2 of the first.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::pair::velocity_matrix;
/// use nalgebra::matrix;
///
/// let closed_loop = velocity_matrix(&Rational::new(1, 2));
/// assert_eq!(closed_loop, matrix![1, 1, 0; -2, 2, 0; 0, 0, 0].map(|entry| Rational::new(entry, 4)));
/// ```
///
/// Evidence: `each_filter_by_itself_is_stable` (symbolic).
pub fn velocity_matrix<T: Field>(root: &T) -> Matrix3<T> {
    let gain = gains::alpha_beta_gain(root, &T::one());
    closed_loop(&gain, &position_matrix(), &embedded_constant_velocity(&T::one()))
}

/// (I − K H) F of the constant acceleration filter with a damping root, in scaled coordinates.
///
/// Why it is stable for every θ in (0, 1): its characteristic polynomial is (λ − θ) p(λ) with p(1) = 2(1 − θ)²/(1 + θ) > 0,
/// p(−1) = 8θ/(1 + θ) > 0 and p(0) = θ < 1.
///
/// Source: derbez2000, section 2.2, as [`velocity_matrix`].
///
/// Example: for θ = 1/2: K = [3/4, 1/2, 1/6]ᵀ and F's first row is [1, 1, 1/2].
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::pair::acceleration_matrix;
/// use nalgebra::matrix;
///
/// let closed_loop = acceleration_matrix(&Rational::new(1, 2));
/// assert_eq!(closed_loop, matrix![6, 6, 3; -12, 12, 18; -4, -4, 22].map(|entry| Rational::new(entry, 24)));
/// ```
///
/// Evidence: `each_filter_by_itself_is_stable` (symbolic).
pub fn acceleration_matrix<T: Field>(root: &T) -> Matrix3<T> {
    let gain = gains::alpha_beta_gamma_gain(root, &T::one());
    closed_loop(&gain, &position_matrix(), &constant_acceleration(&T::one()))
}

/// The matrix of remark 1, Mⱼ = Σᵢ μᵢ∣ⱼ Aᵢ: what the paper's criterion looks at.
///
/// | paper | here       | shape | meaning                                               |
/// |-------|------------|-------|-------------------------------------------------------|
/// | μⁱʲ₊  | `mixing`   | R     | μᵢ∣ⱼ over i, for one j                                |
/// | (I − Kʲ₊H)Fʲ | `matrices` | R × N × N | Aᵢ                                          |
///
/// Example: A₁ = 3/2, A₂ = −3/2, and each filter takes 3/4 of its own: M₁ = 3/4 · 3/2 − 1/4 · 3/2 = 3/4, which looks stable.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::pair::{frozen_matrix, remark_1_matrix};
/// use immaculate::steady::polynomial::has_radius_below;
/// use nalgebra::matrix;
///
/// let q = Rational::new;
/// let matrices = [matrix![q(3, 2)], matrix![q(-3, 2)]];
/// let mixing = [vec![q(3, 4), q(1, 4)], vec![q(1, 4), q(3, 4)]];
/// assert_eq!(remark_1_matrix(&mixing[0], &matrices), matrix![q(3, 4)]);
/// // The errors of both together have λ² = 9/8.
/// assert_eq!(has_radius_below(&frozen_matrix(&mixing, &matrices), &q(1, 1)), Some(false));
/// ```
///
/// Errata: it is said to control the stability of the whole and does not, in either direction, even for constant probabilities: the
/// filters' errors differ, so that no single N × N matrix carries them. [`frozen_matrix`] does.
///
/// Source: derbez2000, section 2.2, remark 1, not numbered.
///
/// Evidence: `remark_1_calls_stable_what_is_not`, `remark_1_calls_unstable_what_is_stable` (exact).
pub fn remark_1_matrix<T: Field, const N: usize>(mixing: &[T], matrices: &[SMatrix<T, N, N>]) -> SMatrix<T, N, N> {
    let mut sum = SMatrix::zeros();
    for (probability, matrix) in mixing.iter().zip(matrices) {
        sum += matrix * probability.clone();
    }
    sum
}

/// The matrix that carries the errors of all filters when the mixing probabilities are constant: diag(Aⱼ) (U ⊗ I) — derbez2000
/// (stability-matrices).
///
/// ```text
/// block (j, i) = μᵢ∣ⱼ Aⱼ
/// ```
///
/// | here       | shape     | meaning                                    |
/// |------------|-----------|--------------------------------------------|
/// | `mixing`   | R × R     | `[j][i]` = μᵢ∣ⱼ, rows sum to one             |
/// | `matrices` | R × N × N | Aⱼ                                         |
/// | the result | RN × RN   | as a list of rows                          |
///
/// Source: the mixed estimate of (1) and the update of section 3, without noise.
///
/// Example: e₁ ↦ 2 (3/4 e₁ + 1/4 e₂), e₂ ↦ 4 (1/2 e₁ + 1/2 e₂).
///
/// ```
/// use immaculate::steady::pair::frozen_matrix;
/// use nalgebra::matrix;
///
/// let mixing = [vec![0.75, 0.25], vec![0.5, 0.5]];
/// assert_eq!(frozen_matrix(&mixing, &[matrix![2.0], matrix![4.0]]), [[1.5, 0.5], [2.0, 2.0]]);
/// ```
///
/// Evidence: `the_frozen_matrix_carries_the_errors_of_the_filter` (exact).
pub fn frozen_matrix<T: Field, const N: usize>(mixing: &[Vec<T>], matrices: &[SMatrix<T, N, N>]) -> MatrixRows<T> {
    let row = |index: usize| {
        let (j, row) = (index / N, index % N);
        let entry = |column: usize| mixing[j][column / N].clone() * matrices[j][(row, column % N)].clone();
        (0..matrices.len() * N).map(entry).collect()
    };
    (0..matrices.len() * N).map(row).collect()
}

/// The mixing probabilities μᵢ∣ⱼ of two modes as `[j][i]`, and the predicted mode probabilities, both by (3).
pub(super) fn mixing<T: Field>(chain: &[Vec<T>], probabilities: &[T; 2]) -> (Vec<Vec<T>>, [T; 2]) {
    let predicted = [0, 1].map(|j| predicted_mode_probability(chain, probabilities, j));
    let row = |j: usize| [0, 1].map(|i| mixing_probability(chain, probabilities, &predicted[j], i, j));
    ((0..2).map(|j| row(j).to_vec()).collect(), predicted)
}

/// The product of matrices that a word names, the first letter acting first: A_{σₙ} ⋯ A_{σ₁}.
///
/// Source: derbez2000 (8), with its factors in the order in which they act.
///
/// Example: two matrices that do not commute.
///
/// ```
/// use immaculate::steady::pair::product;
/// use nalgebra::matrix;
///
/// let (a, b) = (matrix![0.0, 1.0; 0.0, 0.0], matrix![0.0, 0.0; 1.0, 0.0]);
/// // The word a b: a acts first, so it stands on the right.
/// assert_eq!(product(&[0, 1], &[a, b]), b * a);
/// assert_eq!(b * a, matrix![0.0, 0.0; 0.0, 1.0]);
/// ```
///
/// Evidence: `a_product_of_two_stable_filters_is_unstable` (exact).
pub fn product<T: Field, N: Dim>(word: &[usize], matrices: &[OMatrix<T, N, N>]) -> OMatrix<T, N, N>
where
    Shapes: Holds<N>,
{
    let side = rows(&matrices[0]);
    let mut product = OMatrix::identity_generic(side, side);
    for &letter in word {
        product = &matrices[letter] * product;
    }
    product
}
