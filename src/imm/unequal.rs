//! Modes of unequal dimensions: how to mix if a mode lacks an entry of the state.
//!
//! There are three answers. Constant velocity has no acceleration, constant acceleration has one. Embedded in the larger state, the first
//! mode knows its acceleration exactly: it is zero ([`Mode::lacks`]).
//!
//! | mixing     | the missing entry counts as                   | what that keeps, and what it gives up                       |
//! |------------|-----------------------------------------------|-------------------------------------------------------------|
//! | embedded   | zero, without variance                        | both moments, (7) and (8); acceleration is drawn to zero    |
//! | index-wise | zero in the mean, not there in the covariance | the mean; the spread between none and some is lost          |
//! | unbiased   | what the mode that is mixed for has           | that mode's acceleration; zero is not believed to be likely |
//!
//! The tables of [`Equations`] are *embedded*: it is what the law of total covariance gives for the models as they are stated. The others
//! are made from such a table by [`Equations::with_index_wise_mixing`] and [`Equations::with_unbiased_mixing`]. Where no mode lacks an
//! entry all three are the same. Where modes have states of their own, what one lacks of another's is said by their conversion,
//! [`state_conversion`](super::state_conversion), and *embedded* is the only mixing.

use super::Equations;
use super::angles::{estimates_near, estimates_near_first};
use super::state_conversion::Reader;
use crate::gaussian::{Gaussian, mixture_covariance, mixture_mean};
use crate::matrix::{Holds, Shapes, rows};
use crate::model::motion::Mode;
use crate::number::{Field, Real};
use nalgebra::{Dim, OMatrix, OVector};

/// The covariance of a mixture, index by index: a component adds to the rows and columns that its mode has.
///
/// ```text
/// P = Σᵢ wᵢ Eᵢ [ Pⁱ + (x̂ⁱ − x̂)(x̂ⁱ − x̂)ᵀ ] Eᵢ,   Eᵢ = diag(1 where mode i has the entry, 0 where it lacks it)
/// ```
///
/// | here         | shape | meaning                           |
/// |--------------|-------|-----------------------------------|
/// | `weights`    | R     | wᵢ                                |
/// | `components` | R     | x̂ⁱ and Pⁱ                          |
/// | `mean`       | N     | x̂, the mean of the mixture         |
/// | `modes`      | R     | whose entries are asked for        |
///
/// Source: the EKF/UKF toolbox of Hartikainen, Solin and Särkkä, `imm_predict`: lists of indices for each model, and sums over these.
///
/// Example: a mode that knows of no acceleration and one that has 4 ± 1, half and half. The law of total covariance counts the first as a
/// zero.
///
/// ```
/// use immaculate::{gaussian::{Gaussian, mixture_covariance}, imm::unequal::index_wise_covariance, model::motion::{Mode, Motion}};
/// use nalgebra::{matrix, vector};
///
/// let mode = |f| Mode { name: "acceleration".into(), motion: Motion::Linear(matrix![f]), noise: matrix![0.0] };
/// let modes = [mode(0.0), mode(1.0)];
/// let none = Gaussian { mean: vector![0.0], covariance: matrix![0.0] };
/// let some = Gaussian { mean: vector![4.0], covariance: matrix![1.0] };
/// let (weights, both, mean) = ([0.5, 0.5], [none, some], vector![2.0]);
/// assert_eq!(index_wise_covariance(&weights, &both, &mean, &modes), matrix![2.5]); // ½ · (1 + 2²)
/// assert_eq!(mixture_covariance(&weights, &both, &mean), matrix![4.5]); // ½ · (0 + 2²) + ½ · (1 + 2²)
/// ```
///
/// Evidence: `index_wise_mixing_leaves_out_the_spread_of_a_missing_entry` (exact).
pub fn index_wise_covariance<T: Field, N: Dim>(
    weights: &[T],
    components: &[Gaussian<T, N>],
    mean: &OVector<T, N>,
    modes: &[Mode<T, N>],
) -> OMatrix<T, N, N>
where
    Shapes: Holds<N>,
{
    let mut covariance = OMatrix::zeros_generic(rows(mean), rows(mean));
    for ((weight, component), mode) in weights.iter().zip(components).zip(modes) {
        let deviation = &component.mean - mean;
        let second_moment = &component.covariance + &deviation * deviation.transpose();
        covariance += without_missing_entries(second_moment, mode) * weight.clone();
    }
    covariance
}

/// A matrix with zeros in the rows and columns of the entries that a mode lacks.
fn without_missing_entries<T: Field, N: Dim>(matrix: OMatrix<T, N, N>, mode: &Mode<T, N>) -> OMatrix<T, N, N>
where
    Shapes: Holds<N>,
{
    let mut kept = matrix;
    for entry in (0..kept.nrows()).filter(|&entry| mode.lacks(entry)) {
        kept.row_mut(entry).fill(T::zero());
        kept.column_mut(entry).fill(T::zero());
    }
    kept
}

/// The estimate of mode i, with the entries that it lacks taken from mode j.
///
/// ```text
/// x̂ = Eᵢ x̂ⁱ + (I − Eᵢ) x̂ʲ,   P = Eᵢ Pⁱ Eᵢ + (I − Eᵢ) Pʲ (I − Eᵢ)
/// ```
///
/// | here   | meaning                                       |
/// |--------|-----------------------------------------------|
/// | `own`  | x̂ⁱ, Pⁱ: where mode i has the entries            |
/// | `of`   | x̂ʲ, Pʲ: where it lacks them                     |
/// | `mode` | mode i                                        |
///
/// Source: T. Yuan, Y. Bar-Shalom, P. Willett, E. Mozeson, S. Pollak, D. Hardiman, "A Multiple IMM Estimation Approach with Unbiased
/// Mixing for Thrusting Projectiles", IEEE Transactions on Aerospace and Electronic Systems 48(4), 2012: the missing entries and
/// their covariance come from the model that has them, uncorrelated with the rest.
///
/// Why: if the target accelerates, zero is a biased guess of its acceleration; the guess of the mode that models it is not.
///
/// Example: position and acceleration; the first mode has no acceleration and takes it from the second.
///
/// ```
/// use immaculate::{gaussian::Gaussian, imm::unequal::augmented, model::motion::{Mode, Motion}};
/// use nalgebra::{matrix, vector};
///
/// let mode = Mode { name: "still".into(), motion: Motion::Linear(matrix![1.0, 0.0; 0.0, 0.0]), noise: matrix![1.0, 0.0; 0.0, 0.0] };
/// let own = Gaussian { mean: vector![1.0, 0.0], covariance: matrix![2.0, 0.0; 0.0, 0.0] };
/// let of = Gaussian { mean: vector![3.0, 4.0], covariance: matrix![5.0, 6.0; 6.0, 9.0] };
/// let both = augmented(&own, &of, &mode);
/// assert_eq!((both.mean, both.covariance), (vector![1.0, 4.0], matrix![2.0, 0.0; 0.0, 9.0]));
/// ```
///
/// Evidence: `unbiased_mixing_keeps_the_entry_that_one_mode_alone_has` (exact).
pub fn augmented<T: Field, N: Dim>(own: &Gaussian<T, N>, of: &Gaussian<T, N>, mode: &Mode<T, N>) -> Gaussian<T, N>
where
    Shapes: Holds<N>,
{
    let mut estimate = Gaussian {
        mean: own.mean.clone(),
        covariance: without_missing_entries(own.covariance.clone(), mode),
    };
    let missing: Vec<usize> = (0..own.mean.len()).filter(|&entry| mode.lacks(entry)).collect();
    for &row in &missing {
        estimate.mean[row] = of.mean[row].clone();
        for &column in &missing {
            estimate.covariance[(row, column)] = of.covariance[(row, column)].clone();
        }
    }
    estimate
}

/// The estimates of all modes as they are mixed for mode j: each with what it lacks taken from j.
fn augmented_for<T: Field, N: Dim>(estimates: &[Gaussian<T, N>], modes: &[Mode<T, N>], j: usize) -> Vec<Gaussian<T, N>>
where
    Shapes: Holds<N>,
{
    let with_modes = estimates.iter().zip(modes);
    with_modes
        .map(|(estimate, mode)| augmented(estimate, &estimates[j], mode))
        .collect()
}

impl<T: Real, N: Dim, M: Dim> Equations<T, N, M>
where
    Shapes: Holds<N, M>,
{
    /// The table with mixed and combined covariances index by index, [`index_wise_covariance`].
    #[must_use]
    pub fn with_index_wise_mixing(self) -> Self {
        Self {
            mixed_covariance: |problem, previous, now, j| {
                let (weights, mean) = (&now.mixing_probabilities[j], &now.mixed[j].mean);
                let estimates = estimates_near(problem, &previous.updated, Reader::Mode(j), mean);
                index_wise_covariance(weights, &estimates, mean, &problem.modes)
            },
            combined_prediction_covariance: |problem, _, now, _| {
                let (weights, mean) = (&now.predicted_mode_probabilities, &now.combined_prediction.mean);
                let estimates = estimates_near(problem, &now.predicted, Reader::Common, mean);
                index_wise_covariance(weights, &estimates, mean, &problem.modes)
            },
            combined_covariance: |problem, _, now, _| {
                let (weights, mean) = (&now.mode_probabilities, &now.combined.mean);
                let estimates = estimates_near(problem, &now.updated, Reader::Common, mean);
                index_wise_covariance(weights, &estimates, mean, &problem.modes)
            },
            ..self
        }
    }

    /// The table with unbiased mixing, [`augmented`]. The combined estimate is still the mixture's.
    #[must_use]
    pub fn with_unbiased_mixing(self) -> Self {
        Self {
            mixed_mean: |problem, previous, now, j| {
                let estimates = estimates_near_first(problem, &previous.updated, Reader::Mode(j));
                let augmented = augmented_for(&estimates, &problem.modes, j);
                mixture_mean(&now.mixing_probabilities[j], &augmented)
            },
            mixed_covariance: |problem, previous, now, j| {
                let mean = &now.mixed[j].mean;
                let estimates = estimates_near(problem, &previous.updated, Reader::Mode(j), mean);
                let augmented = augmented_for(&estimates, &problem.modes, j);
                mixture_covariance(&now.mixing_probabilities[j], &augmented, mean)
            },
            ..self
        }
    }
}
