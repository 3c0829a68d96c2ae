//! Gain, updated mean and updated covariance, for every filter.
//!
//! The residual corrects the prediction from ẑ, S and C, in the same way for every kind of filter.
//!
//! ```text
//! C, S ─ gain ─▶ W         x̂⁻, W, ν = z − ẑ ─ updated_mean ─▶ x̂         P⁻, W, S ─ updated_covariance ─▶ P
//! ```

use crate::matrix::{Holds, Ldl, Shapes, mirrored, solve};
use crate::number::Field;
use nalgebra::{Dim, OMatrix, OVector};

/// Gain — derbez2000 (2), sustika2015 (17), (34), zhu2016 (51), liu2017 (20).
///
/// ```text
/// W = C S⁻¹
/// ```
///
/// | paper       | here                    | shape | meaning                                                     |
/// |-------------|-------------------------|-------|-------------------------------------------------------------|
/// | P_xz        | `cross_covariance`      | N × M | covariance of state and measurement                          |
/// | P_zz        | `innovation_covariance` | M × M | as L D Lᵀ, [`ldl`](crate::matrix::ldl)                       |
/// | W, K        | the result              | N × M | units of the state over units of the measurement             |
///
/// Why: of all linear corrections x̂⁻ + W ν this one leaves the least covariance. It is solved from S Wᵀ = Cᵀ; no inverse is formed.
///
/// Example: a covariance of 50 between state and measurement, and a variance of 200 of the measurement.
///
/// ```
/// use immaculate::{filter::update::gain, matrix::ldl};
/// use nalgebra::matrix;
///
/// assert_eq!(gain(&matrix![50.0], &ldl(&matrix![200.0])), matrix![0.25]); // 50/200
/// // The velocity is corrected too, though only the position was measured: their estimates are correlated.
/// assert_eq!(gain(&matrix![2.0; 1.0], &ldl(&matrix![4.0])), matrix![0.5; 0.25]);
/// ```
///
/// Evidence: `the_kalman_update_is_conditioning_of_a_gaussian` (symbolic).
pub fn gain<T: Field, N: Dim, M: Dim>(
    cross_covariance: &OMatrix<T, N, M>,
    innovation_covariance: &Ldl<T, M>,
) -> OMatrix<T, N, M>
where
    Shapes: Holds<N, M>,
{
    solve(innovation_covariance, &cross_covariance.transpose()).transpose()
}

/// Updated mean — derbez2000 (2), (8), sustika2015 (18), (35), zhu2016 (52), liu2017 (20).
///
/// ```text
/// x̂ = x̂⁻ + W ν,   ν = z − ẑ
/// ```
///
/// | paper | here         | shape | meaning                        |
/// |-------|--------------|-------|--------------------------------|
/// | x̂⁻    | `mean`       | N     | predicted mean                 |
/// | W     | `gain`       | N × M | [`gain`]                       |
/// | z − ẑ | `innovation` | M     | the residual, angles wrapped   |
///
/// Why: the conditional mean of a joint Gaussian. With x̂⁻ = F x̂ and ẑ = H x̂⁻ it is x̂ₙ = Aₙ x̂ₙ₋₁ + Kₙ yₙ, Aₙ = (I − Kₙ H) F, and undone
/// to the start x̂ₙ = Aₙ⋯A₁ x̂₀ + Σⱼ Aₙ⋯A₍j+1₎ Kⱼ yⱼ, which is derbez2000 (8).
///
/// Example: 20 was expected and 24 is measured, and a quarter of the difference is believed.
///
/// ```
/// use immaculate::filter::update::updated_mean;
/// use nalgebra::{matrix, vector};
///
/// assert_eq!(updated_mean(&vector![10.0], &matrix![0.25], &vector![24.0 - 20.0]), vector![11.0]); // 10 + ¼ · 4
/// ```
///
/// Errata: derbez2000 (8) has the product from the first matrix to the last.
///
/// Evidence: `the_kalman_update_is_conditioning_of_a_gaussian` (symbolic), `printed_order_of_the_product_is_not_the_recursion` (exact).
pub fn updated_mean<T: Field, N: Dim, M: Dim>(
    mean: &OVector<T, N>,
    gain: &OMatrix<T, N, M>,
    innovation: &OVector<T, M>,
) -> OVector<T, N>
where
    Shapes: Holds<N, M>,
{
    mean + gain * innovation
}

/// Updated covariance — derbez2000 (2), sustika2015 (19), (36), zhu2016 (53), liu2017 (20).
///
/// ```text
/// P = P⁻ − W S Wᵀ
/// ```
///
/// | paper | here                    | shape | meaning                |
/// |-------|-------------------------|-------|------------------------|
/// | P⁻    | `covariance`            | N × N | predicted covariance   |
/// | W     | `gain`                  | N × M | [`gain`]               |
/// | P_zz  | `innovation_covariance` | M × M | innovation covariance  |
///
/// Why: the conditional covariance of a joint Gaussian. Its lower triangle is kept and [`mirrored`]: rounding must not let the two
/// triangles part, for this form never forgets a difference between them. With W = P⁻HᵀS⁻¹ it is the (I − WH)P⁻ of derbez2000, which does.
///
/// Example: half of the variance 25 is left. That is what two independent pieces of information give, the prediction's and the
/// measurement's; the printed (I − WH)P⁰, from the mixed covariance 4, is another number.
///
/// ```
/// use immaculate::filter::update::updated_covariance;
/// use nalgebra::matrix;
///
/// let updated = updated_covariance(&matrix![25.0], &matrix![0.25], &matrix![200.0]);
/// assert_eq!(updated, matrix![12.5]); // 25 − ¼ · 200 · ¼
/// assert_eq!(1.0 / updated[0], 1.0 / 25.0 + 2.0 * 2.0 / 100.0); // 1/P = 1/P⁻ + H²/R
/// let (gain, h, mixed) = (0.25, 2.0, 4.0);
/// assert_eq!((1.0 - gain * h) * mixed, 2.0);
/// ```
///
/// Errata: derbez2000 (2) prints (I − WH)P⁰ with the mixed covariance, which has seen neither the motion nor its noise.
///
/// Evidence: `the_kalman_update_is_conditioning_of_a_gaussian` (symbolic),
/// `printed_update_from_the_mixed_covariance_is_not_conditioning`, `only_one_form_of_the_update_forgets_an_asymmetry` (exact).
pub fn updated_covariance<T: Field, N: Dim, M: Dim>(
    covariance: &OMatrix<T, N, N>,
    gain: &OMatrix<T, N, M>,
    innovation_covariance: &OMatrix<T, M, M>,
) -> OMatrix<T, N, N>
where
    Shapes: Holds<N, M>,
{
    mirrored(covariance - gain * innovation_covariance * gain.transpose())
}
