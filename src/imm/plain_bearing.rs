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
    ///
    /// Example: a bearing of 135° is measured where −135° is expected. The innovation is a quarter turn backwards; as a plain number it is
    /// three quarters forwards, and turns the correction round.
    ///
    /// ```
    /// use immaculate::{gaussian::Gaussian, imm::{Equations, Imm, Initial, Problem}};
    /// use immaculate::{model::{Measurement, PolarComponent, motion::Mode}, rule::RuleName};
    /// use nalgebra::{Matrix2, matrix, vector};
    /// use std::f64::consts::PI;
    ///
    /// let problem = Problem {
    ///     modes: vec![Mode { name: "still".into(), transition: Matrix2::identity(), noise: Matrix2::zeros() }],
    ///     transition: vec![vec![1.0]],
    ///     measurement: Measurement::Polar { components: [PolarComponent::Bearing], position: [0, 1], sensor: [0.0, 0.0] },
    ///     measurement_noise: matrix![0.01],
    ///     rule: Some("cubature-3".parse::<RuleName>()?.rule()?),
    ///     fixed_gains: None,
    /// };
    /// let start = Gaussian { mean: vector![-1.0, -1.0], covariance: Matrix2::identity() * 1e-6 };
    /// let initial = Initial { modes: vec![start], mode_probabilities: vec![1.0] };
    /// let innovation = |equations| -> Result<f64, Box<dyn std::error::Error>> {
    ///     Ok(Imm::new(problem.clone(), equations, &initial)?.step(Some(&vector![0.75 * PI]))?.innovations[0][0])
    /// };
    /// // The points scatter by 1e-3 about (−1, −1), and the mean of their bearings moves by its square at most.
    /// assert!((innovation(Equations::cubature())? - -0.5 * PI).abs() < 1e-6);
    /// assert!((innovation(Equations::cubature().with_plain_bearings())? - 1.5 * PI).abs() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
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
