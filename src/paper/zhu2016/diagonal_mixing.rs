//! A stand-in for OMTM-IMM, the fifth system of zhu2016's comparison.
//!
//! This column is **not** the published filter. The equations of the "optimal mode transition matrix" IMM (Zhou, Cai, Sun and Shen, 2014)
//! could not be obtained. Its abstract fixes three things: linear-minimum-variance weights replace the transition matrix, they come from
//! the estimates' covariances, and they are diagonal matrices, so that each component of the state is weighted separately. This is the
//! plainest filter of that kind.
//!
//! No claim about OMTM-IMM itself follows from it.

use crate::gaussian::Gaussian;
use crate::imm::Equations;
use crate::matrix::{Holds, Shapes, rows};
use crate::number::{Field, Real};
use nalgebra::{Dim, OMatrix, OVector, U1};

/// Linear-minimum-variance weights of uncorrelated estimates, component by component.
///
/// ```text
/// aᵢ⁽ˡ⁾ = (1 / Pⁱₗₗ) / Σₘ (1 / Pᵐₗₗ)
/// ```
///
/// Source: scalar inverse-variance weighting; the cross-covariances of the sub-filters, which the published filter is said to use,
/// make the weights leave [0, 1] and are left out.
///
/// Example: the first estimate knows the position three times as well, and the velocity a third as well.
///
/// ```
/// use immaculate::{gaussian::Gaussian, paper::zhu2016::diagonal_mixing::diagonal_weight, number::{Field, Rational}};
/// use nalgebra::{Matrix2, Vector2, vector};
///
/// let of = |a, b| Gaussian { mean: Vector2::zeros(), covariance: Matrix2::from_diagonal(&vector![a, b].map(Rational::integer)) };
/// let estimates = [of(1, 3), of(3, 1)];
/// // 1/1 / (1/1 + 1/3), 1/3 / (1/3 + 1/1)
/// assert_eq!(diagonal_weight(&estimates, 0), vector![Rational::new(3, 4), Rational::new(1, 4)]);
/// ```
///
/// Evidence: `diagonal_weights_sum_to_one_in_each_component` (symbolic).
pub fn diagonal_weight<T: Field, N: Dim>(estimates: &[Gaussian<T, N>], i: usize) -> OVector<T, N>
where
    Shapes: Holds<N>,
{
    OVector::from_fn_generic(rows(&estimates[i].mean), U1, |l, _| {
        let mut sum = T::zero();
        for estimate in estimates {
            sum += T::one() / estimate.covariance[(l, l)].clone();
        }
        T::one() / estimates[i].covariance[(l, l)].clone() / sum
    })
}

/// The mean mixed with diagonal weights, the same for every mode: x̂⁰ = Σᵢ aᵢ ∘ x̂ⁱ.
///
/// Source: as [`diagonal_weight`].
///
/// Example: estimates at 0 and 4 of which the first has a third of the variance.
///
/// ```
/// use immaculate::{gaussian::Gaussian, paper::zhu2016::diagonal_mixing::mixed_mean, number::{Field, Rational}};
/// use nalgebra::{matrix, vector};
///
/// let at = |x, variance| Gaussian { mean: vector![Rational::integer(x)], covariance: matrix![Rational::integer(variance)] };
/// // ¾ · 0 + ¼ · 4
/// assert_eq!(mixed_mean(&[at(0, 1), at(4, 3)]), vector![Rational::integer(1)]);
/// ```
pub fn mixed_mean<T: Field, N: Dim>(estimates: &[Gaussian<T, N>]) -> OVector<T, N>
where
    Shapes: Holds<N>,
{
    let mut sum = OVector::zeros_generic(rows(&estimates[0].mean), U1);
    for (i, estimate) in estimates.iter().enumerate() {
        sum += diagonal_weight(estimates, i).component_mul(&estimate.mean);
    }
    sum
}

/// The covariance mixed with diagonal weights: P⁰ = Σᵢ Aᵢ^½ [Pⁱ + (x̂ⁱ − x̂⁰)(x̂ⁱ − x̂⁰)ᵀ] Aᵢ^½, with Aᵢ = diag(aᵢ).
///
/// Source: the moment matching of zhu2016 (56) with each weight split evenly over both sides, so that the result is positive definite
/// and equals (56) when the components of a weight agree.
///
/// Example: estimates at 0 and 4 of variance 1 have the weights ½ and the mean 2.
///
/// ```
/// use immaculate::{gaussian::Gaussian, paper::zhu2016::diagonal_mixing::mixed_covariance};
/// use nalgebra::{matrix, vector};
///
/// let at = |x| Gaussian { mean: vector![x], covariance: matrix![1.0] };
/// let mixed = mixed_covariance(&[at(0.0), at(4.0)], &vector![2.0]);
/// // ½ · (1 + 2²) + ½ · (1 + 2²); as a double √½ · √½ is one unit in the last place above ½
/// assert!((mixed[0] - 5.0).abs() < 8.0 * f64::EPSILON);
/// ```
pub fn mixed_covariance<T: Real, N: Dim>(estimates: &[Gaussian<T, N>], mean: &OVector<T, N>) -> OMatrix<T, N, N>
where
    Shapes: Holds<N>,
{
    let mut sum = OMatrix::zeros_generic(rows(mean), rows(mean));
    for (i, estimate) in estimates.iter().enumerate() {
        let root = diagonal_weight(estimates, i).map(|weight| weight.sqrt());
        let deviation = &estimate.mean - mean;
        let moment = &estimate.covariance + &deviation * deviation.transpose();
        sum += moment.component_mul(&(&root * root.transpose()));
    }
    sum
}

/// The table of the stand-in: Kalman filters whose inputs are mixed with diagonal weights, and the mode probabilities of
/// zhu2016 (58) for the output.
pub fn equations<T: Real, N: Dim, M: Dim>() -> Equations<T, N, M>
where
    Shapes: Holds<N, M>,
{
    Equations {
        mixed_mean: |_, previous, _, _| mixed_mean(&previous.updated),
        mixed_covariance: |_, previous, now, j| mixed_covariance(&previous.updated, &now.mixed[j].mean),
        ..Equations::standard()
    }
}
