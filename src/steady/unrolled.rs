//! A filter's recursion unrolled: its estimate as a sum over all measurements so far.
//!
//! The closed loops of a filter multiply in a definite order; the printed product has another order.

use crate::number::Field;
use nalgebra::{SMatrix, SVector};

/// One step of a linear filter: what carries the estimate on, and what a measurement adds.
#[derive(Debug, Clone, PartialEq)]
pub struct FilterStep<T, const N: usize, const M: usize> {
    /// Aᵢ = (I − KᵢH) F.
    pub closed_loop: SMatrix<T, N, N>,
    /// Kᵢ.
    pub gain: SMatrix<T, N, M>,
    /// yᵢ.
    pub measurement: SVector<T, M>,
}

/// The estimate after all steps, from the recursion itself: x̂ᵢ = Aᵢ x̂₍i−1₎ + Kᵢ yᵢ.
///
/// Source: derbez2000 (2), its third line, with Aᵢ = (I − KᵢH) F.
///
/// Example: ½ · 4 + 1 · 3 = 5, then ½ · 5 + 1 · 2.
///
/// ```
/// use immaculate::steady::unrolled::{FilterStep, recursion};
/// use nalgebra::{matrix, vector};
///
/// let step = |z| FilterStep { closed_loop: matrix![0.5], gain: matrix![1.0], measurement: vector![z] };
/// assert_eq!(recursion(&vector![4.0], &[step(3.0), step(2.0)]), vector![4.5]);
/// ```
pub fn recursion<T: Field, const N: usize, const M: usize>(
    initial: &SVector<T, N>,
    steps: &[FilterStep<T, N, M>],
) -> SVector<T, N> {
    let mut estimate = initial.clone();
    for step in steps {
        estimate = &step.closed_loop * estimate + &step.gain * &step.measurement;
    }
    estimate
}

/// The recursion undone — derbez2000 (8).
///
/// ```text
/// x̂ₙ = Aₙ⋯A₁ x̂₀ + Σⱼ Aₙ⋯A₍j+1₎ Kⱼ yⱼ
/// ```
///
/// | paper | here                   | shape | meaning                                  |
/// |-------|------------------------|-------|------------------------------------------|
/// | Aᵢ    | `steps[i].closed_loop` | N × N | (I − KᵢH) F                              |
/// | Kᵢ    | `steps[i].gain`        | N × M | gain                                     |
/// | yᵢ    | `steps[i].measurement` | M     | measurement                              |
/// | x̂₀    | `initial`              | N     | the estimate at step 0                   |
///
/// Why: x̂ᵢ = Aᵢ x̂₍i−1₎ + Kᵢ yᵢ, inserted into itself. The latest matrix stands on the left.
///
/// Example: A₁ moves the second entry up, A₂ the first one down, and nothing is measured.
///
/// ```
/// use immaculate::number::{Field, Rational};
/// use immaculate::steady::unrolled::{FilterStep, recursion, unrolled, unrolled_as_printed};
/// use nalgebra::{SMatrix, SVector, matrix, vector};
///
/// let whole = Rational::integer;
/// let step = |a: SMatrix<i64, 2, 2>| FilterStep {
///     closed_loop: a.map(whole),
///     gain: SMatrix::zeros(),
///     measurement: SVector::<Rational, 1>::zeros(),
/// };
/// let (start, steps) = (vector![1, 2].map(whole), [step(matrix![0, 1; 0, 0]), step(matrix![0, 0; 1, 0])]);
/// // [1, 2] ↦ [2, 0] ↦ [0, 2]
/// assert_eq!(unrolled(&start, &steps), vector![0, 2].map(whole));
/// assert_eq!(recursion(&start, &steps), vector![0, 2].map(whole));
/// // As printed, A₁A₂ acts with A₂ first: [1, 2] ↦ [0, 1] ↦ [1, 0].
/// assert_eq!(unrolled_as_printed(&start, &steps), vector![1, 0].map(whole));
/// ```
///
/// Errata: the paper writes ∏ᵢ Aᵢ for i from 1 to n, which is A₁A₂⋯Aₙ as products are read; the matrices of a filter do not commute while
/// its gain still changes, nor do those of two models. [`unrolled_as_printed`] has that order.
///
/// Evidence: `the_recursion_unrolls_with_the_latest_matrix_on_the_left` (symbolic, exact).
pub fn unrolled<T: Field, const N: usize, const M: usize>(
    initial: &SVector<T, N>,
    steps: &[FilterStep<T, N, M>],
) -> SVector<T, N> {
    unrolled_with(initial, steps, |product, next| next * product)
}

/// The recursion undone in the printed order of the product, A₁A₂⋯Aₙ: wrong.
///
/// Source: derbez2000 (8), as printed.
///
/// Example: where the closed loops commute, as numbers do, nobody notices: 1/2 · 1/4 · 8 either way.
///
/// ```
/// use immaculate::steady::unrolled::{FilterStep, unrolled, unrolled_as_printed};
/// use nalgebra::{matrix, vector};
///
/// let step = |a| FilterStep { closed_loop: matrix![a], gain: matrix![0.0], measurement: vector![0.0] };
/// let (start, steps) = (vector![8.0], [step(0.5), step(0.25)]);
/// assert_eq!(unrolled_as_printed(&start, &steps), unrolled(&start, &steps));
/// ```
///
/// Evidence: `the_recursion_unrolls_with_the_latest_matrix_on_the_left` (symbolic, exact).
pub fn unrolled_as_printed<T: Field, const N: usize, const M: usize>(
    initial: &SVector<T, N>,
    steps: &[FilterStep<T, N, M>],
) -> SVector<T, N> {
    unrolled_with(initial, steps, |product, next| product * next)
}

/// (∏ᵢ Aᵢ) x̂₀ + Σⱼ (∏₍i>j₎ Aᵢ) Kⱼ yⱼ, with the product put together in the order that is asked for.
fn unrolled_with<T: Field, const N: usize, const M: usize>(
    initial: &SVector<T, N>,
    steps: &[FilterStep<T, N, M>],
    multiply: impl Fn(&SMatrix<T, N, N>, &SMatrix<T, N, N>) -> SMatrix<T, N, N>,
) -> SVector<T, N> {
    let product = |steps: &[FilterStep<T, N, M>]| {
        steps.iter().fold(SMatrix::identity(), |product, step| {
            multiply(&product, &step.closed_loop)
        })
    };
    let mut estimate = product(steps) * initial;
    for (j, step) in steps.iter().enumerate() {
        estimate += product(&steps[j + 1..]) * &step.gain * &step.measurement;
    }
    estimate
}
