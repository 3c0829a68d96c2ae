//! Bearings as plain numbers: the filters with points as programs run them that know nothing of angles.
//!
//! After this file the reader can exchange each of the three places at which a bearing of 179° and one of −179° are 358° apart: the mean of
//! the points' bearings, their deviations from it, and the innovation. Far from the negative x-axis nothing changes.

use super::Equations;
use super::equations::{covariance_weights, weights};
use crate::filter::cubature;
use crate::model::Measurement;
use crate::number::Real;
use nalgebra::{SMatrix, SVector};

impl<T: Real, const N: usize, const M: usize> Equations<T, N, M> {
    /// The table with plain bearings in all three places, as in the EKF/UKF toolbox (Hartikainen, Solin and Särkkä 2011).
    #[must_use]
    pub fn with_plain_bearings(self) -> Self {
        self.with_plain_mean().with_plain_deviations().with_plain_innovation()
    }

    /// ẑ = Σₛ wₛ Zₛ.
    #[must_use]
    pub fn with_plain_mean(self) -> Self {
        Self {
            predicted_measurement: |problem, _, now, j| {
                cubature::weighted_mean(weights(problem), &now.measured_points[j])
            },
            ..self
        }
    }

    /// Zₛ − ẑ as a number.
    #[must_use]
    pub fn with_plain_deviations(self) -> Self {
        Self {
            innovation_covariance: |problem, _, now, j| {
                let (values, mean) = (&now.measured_points[j], &now.predicted_measurements[j]);
                cubature::weighted_covariance(covariance_weights(problem), values, mean, &problem.measurement_noise)
            },
            cross_covariance: |problem, _, now, j| {
                cubature::cross_covariance(
                    &Measurement::Linear(SMatrix::zeros()), // which has no angles
                    covariance_weights(problem),
                    &now.predicted_points[j],
                    &now.predicted[j].mean,
                    &now.measured_points[j],
                    &now.predicted_measurements[j],
                )
            },
            ..self
        }
    }

    /// z − ẑ as a number.
    #[must_use]
    pub fn with_plain_innovation(self) -> Self {
        Self {
            innovation: |_, _, now, j| match &now.measurement {
                Some(z) => z - &now.predicted_measurements[j],
                None => SVector::from_fn(|_, _| T::undecided()),
            },
            ..self
        }
    }
}
