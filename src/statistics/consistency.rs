//! Is a filter as accurate as it claims? Normalised squared errors and their bounds.
//!
//! Two tests check a filter's own covariance: one against the truth (NEES), and one without the truth, against the measurements (NIS).
//!
//! A matched filter's error is Gaussian with the covariance that the filter reports, so its square in that metric is χ² with as many
//! degrees of freedom as it has components. A mean above the bounds says that the filter is over-confident, one below that it is
//! too careful.

use crate::gaussian::Gaussian;
use crate::imm::Step;
use crate::matrix::{Holds, Shapes, ldl, quadratic_form, rows};
use crate::number::Field;
use nalgebra::{Const, Dim, OMatrix, OVector, SVector, U1};
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Normalised estimation error squared: (x − x̂)ᵀ P⁻¹ (x − x̂), without a unit; its expectation is N.
///
/// Source: Bar-Shalom, Li and Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, section 5.4.
///
/// Example: an error of 4 with the standard deviation 2: (4/2)².
///
/// ```
/// use immaculate::{gaussian::Gaussian, statistics::consistency::nees};
/// use nalgebra::{matrix, vector};
///
/// let estimate = Gaussian { mean: vector![1.0], covariance: matrix![4.0] };
/// assert_eq!(nees(&estimate, &vector![5.0]), 4.0);
/// ```
pub fn nees<const N: usize>(estimate: &Gaussian<f64, Const<N>>, truth: &SVector<f64, N>) -> f64 {
    quadratic_form(&ldl(&estimate.covariance), &(truth - estimate.mean))
}

/// Normalised innovation squared of a step with a measurement: ν̄ᵀ S̄⁻¹ ν̄ with the moments of the modes' innovations under the
/// predicted mode probabilities, without a unit; its expectation is M. `None` without a measurement.
///
/// ```text
/// ν̄ = Σⱼ cⱼ νⱼ,    S̄ = Σⱼ cⱼ [ Sⱼ + (νⱼ − ν̄)(νⱼ − ν̄)ᵀ ]
/// ```
///
/// Source: as [`nees`]; for several modes the moments of the mixture that predicts the measurement.
///
/// Example: two equally likely modes with innovations 1 and 3 and variances 2 and 4: ν̄ = 2, S̄ = 3 + 1.
///
/// ```
/// use immaculate::{gaussian::Gaussian, imm::Step};
/// use immaculate::statistics::consistency::nis;
/// use nalgebra::{U1, matrix, vector};
///
/// let estimate = Gaussian { mean: vector![0.0], covariance: matrix![1.0] };
/// let mut step = Step::<f64, U1, U1>::initial(&[estimate.clone(), estimate], &[0.5, 0.5]);
/// step.measurement = Some(vector![0.0]);
/// step.predicted_mode_probabilities = vec![0.5, 0.5];
/// step.innovations = vec![vector![1.0], vector![3.0]];
/// step.innovation_covariances = vec![matrix![2.0], matrix![4.0]];
/// assert_eq!(nis(&step), Some(1.0)); // 2²/4
/// step.measurement = None;
/// assert_eq!(nis(&step), None);
/// ```
pub fn nis<T: Field, N: Dim, M: Dim>(step: &Step<T, N, M>) -> Option<T>
where
    Shapes: Holds<N, M>,
{
    let m = rows(step.measurement.as_ref()?);
    let probabilities = &step.predicted_mode_probabilities;
    let mut mean = OVector::<T, M>::zeros_generic(m, U1);
    for (probability, innovation) in probabilities.iter().zip(&step.innovations) {
        mean += innovation * probability.clone();
    }
    let mut covariance = OMatrix::<T, M, M>::zeros_generic(m, m);
    for (j, probability) in probabilities.iter().enumerate() {
        let deviation = &step.innovations[j] - &mean;
        let spread = &deviation * deviation.transpose();
        covariance += (&step.innovation_covariances[j] + spread) * probability.clone();
    }
    Some(quadratic_form(&ldl(&covariance), &mean))
}

/// The interval in which the mean of `count` independent χ² variables of `degrees` degrees of freedom lies with probability
/// 1 − `false_alarm`, half of the rest on either side.
///
/// Source: the sum of independent χ² variables is χ² with the sum of their degrees of freedom.
///
/// Example: one χ² variable of one degree of freedom: a standard Gaussian squared, below 1.959964² with probability 0.95. The tabulated
/// quantile has seven digits.
///
/// ```
/// use immaculate::statistics::consistency::bounds;
///
/// let (_, upper) = bounds(1.0, 1, 0.1);
/// assert!((upper - 1.959964_f64 * 1.959964).abs() < 1e-5);
/// ```
///
/// # Panics
///
/// When `degrees` or `count` is zero, or `false_alarm` no probability.
pub fn bounds(degrees: f64, count: usize, false_alarm: f64) -> (f64, f64) {
    let count = count as f64;
    let sum = ChiSquared::new(degrees * count).expect("a positive number of degrees of freedom");
    (
        sum.inverse_cdf(false_alarm / 2.0) / count,
        sum.inverse_cdf(1.0 - false_alarm / 2.0) / count,
    )
}
