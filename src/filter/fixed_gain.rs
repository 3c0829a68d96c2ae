//! The fixed-gain filter: the problem gives the gain; the data do not change it.
//!
//! Without covariances, a mode's filter consists of two constant matrices: one corrects the prediction, the other gives the likelihood of
//! a residual. [`crate::steady::gains`] and [`crate::steady::riccati`] derive them; [`Filter::given`](super::Filter::given) makes a filter
//! from them.

use crate::matrix::{Holds, Shapes};
use crate::number::Field;
use nalgebra::{Dim, OMatrix};

/// Gain and innovation covariance of one mode, both constant — derbez2000 (fixed-gain-update), (fixed-gain-likelihood).
///
/// Source: derbez2000, section 3, not numbered.
///
/// ```text
/// x̂ = F x̂⁰ + K (z − H F x̂⁰)          ln L = ln N(z − H F x̂⁰; 0, S)
/// ```
///
/// | paper   | here                    | shape | meaning                                                   |
/// |---------|-------------------------|-------|-----------------------------------------------------------|
/// | K∞      | `gain`                  | N × M | units of the state over units of the measurement           |
/// | S       | `innovation_covariance` | M × M | H P⁻ Hᵀ + R, derbez2000 (4), symmetric positive definite   |
/// | x̂⁰      |                         | N     | what the prediction starts from                            |
///
/// Why: the covariances of a Kalman filter do not depend on what is measured. With constant F, H, Q and R they tend to the equilibrium P⁻
/// of a Riccati equation, and K = P⁻ Hᵀ S⁻¹ with them. A filter that has K and S from the start needs no covariance at all, which is
/// most of the arithmetic. Nothing here asks that they are of that origin.
///
/// Example: the filter of the other files here at its first step, with its gain and its S once and for all.
///
/// ```
/// use immaculate::filter::{fixed_gain::FixedGain, kalman::predicted_mean, update::updated_mean};
/// use nalgebra::{matrix, vector};
///
/// let fixed = FixedGain { gain: matrix![0.25], innovation_covariance: matrix![200.0] };
/// let prediction = predicted_mean(&matrix![2.0], &vector![5.0]);
/// let innovation = vector![24.0] - matrix![2.0] * &prediction;
/// // 2 · 5 + ¼ · (24 − 2 · 10)
/// assert_eq!(updated_mean(&prediction, &fixed.gain, &innovation), vector![11.0]);
/// ```
///
/// Errata: the update is printed without the superscript 0 of the mixed state, although "one proceeds with the usual IMM algorithm".
/// Both readings exist and are kept apart: [`Interaction::Imm`](crate::imm::Interaction::Imm) and
/// [`Interaction::Unmixed`](crate::imm::Interaction::Unmixed).
///
/// Evidence: `a_kalman_filter_at_its_equilibrium_is_the_fixed_gain_filter` (exact).
#[derive(Debug, Clone, PartialEq)]
pub struct FixedGain<T: Field, N: Dim, M: Dim>
where
    Shapes: Holds<N, M>,
{
    /// K.
    pub gain: OMatrix<T, N, M>,
    /// S.
    pub innovation_covariance: OMatrix<T, M, M>,
}
