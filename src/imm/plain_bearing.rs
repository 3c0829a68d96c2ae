//! Bearings as plain numbers: filters with points as written by programs that ignore angles.
//!
//! Three places, each of which can be exchanged, treat bearings of 179° and −179° as 358° apart: the mean of the points' bearings, their
//! deviations from it, and the innovation. Far from the negative x-axis nothing changes.

use super::Equations;
use super::equations::used;
use crate::filter::{Transform, Update, cubature};
use crate::matrix::{Holds, Shapes};
use crate::model::Sensor;
use crate::number::Real;
use nalgebra::{Dim, OMatrix};

impl<T: Real, N: Dim, M: Dim> Equations<T, N, M>
where
    Shapes: Holds<N, M>,
{
    /// The table with plain bearings in all three places, as in the EKF/UKF toolbox (Hartikainen, Solin and Särkkä 2011).
    ///
    /// Example: a bearing of 135° is measured where −135° is expected. The innovation is a quarter turn backwards; as a plain number it is
    /// three quarters forwards, and turns the correction round.
    ///
    /// ```
    /// use immaculate::{gaussian::Gaussian, imm::{Equations, Imm, Initial, Interaction, Problem}};
    /// use immaculate::filter::Filter;
    /// use immaculate::{model::{PolarComponent, Sensor, motion::{Mode, Motion}}, rule::RuleName};
    /// use nalgebra::{Matrix2, matrix, vector};
    /// use std::f64::consts::PI;
    ///
    /// let problem = Problem {
    ///     modes: vec![Mode { name: "still".into(), motion: Motion::Linear(Matrix2::identity()), noise: Matrix2::zeros() }],
    ///     chain: vec![vec![1.0]],
    ///     sensor: Sensor::Polar { components: vec![PolarComponent::Bearing], position: [0, 1], location: [0.0, 0.0] },
    ///     measurement_noise: matrix![0.01],
    ///     filters: vec![Filter::points("cubature-3".parse::<RuleName>()?.rule()?)],
    ///     interaction: Interaction::Imm,
    ///     angles: vec![],
    /// };
    /// let start = Gaussian { mean: vector![-1.0, -1.0], covariance: Matrix2::identity() * 1e-6 };
    /// let initial = Initial { modes: vec![start], mode_probabilities: vec![1.0] };
    /// let innovation = |equations| -> Result<f64, Box<dyn std::error::Error>> {
    ///     Ok(Imm::with_equations(problem.clone(), equations, &initial)?.step(Some(&vector![0.75 * PI]))?.innovations[0][0])
    /// };
    /// // The points scatter by 1e-3 about (−1, −1), and the mean of their bearings moves by its square at most.
    /// assert!((innovation(Equations::standard())? - -0.5 * PI).abs() < 1e-6);
    /// assert!((innovation(Equations::standard().with_plain_bearings())? - 1.5 * PI).abs() < 1e-6);
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
            predicted_measurement: |problem, previous, now, j| match &problem.filter(j).update {
                Update::By(Transform::Points(rule)) => cubature::weighted_mean(&rule.weights, &now.measured_points[j]),
                _ => (Self::standard().predicted_measurement)(problem, previous, now, j),
            },
            ..self
        }
    }

    /// Zₛ − ẑ as a number.
    #[must_use]
    pub fn with_plain_deviations(self) -> Self {
        Self {
            innovation_covariance: |problem, previous, now, j| match &problem.filter(j).update {
                Update::By(Transform::Points(rule)) => {
                    let (values, mean) = (&now.measured_points[j], &now.predicted_measurements[j]);
                    cubature::weighted_covariance(&rule.covariance_weights, values, mean, &problem.measurement_noise)
                }
                _ => (Self::standard().innovation_covariance)(problem, previous, now, j),
            },
            cross_covariance: |problem, previous, now, j| match &problem.filter(j).update {
                Update::By(Transform::Points(rule)) => cubature::cross_covariance(
                    &Sensor::Linear(OMatrix::zeros_generic(problem.m(), problem.n())), // which has no angles
                    &rule.covariance_weights,
                    &now.predicted_points[j],
                    &now.predicted[j].mean,
                    &now.measured_points[j],
                    &now.predicted_measurements[j],
                ),
                _ => (Self::standard().cross_covariance)(problem, previous, now, j),
            },
            ..self
        }
    }

    /// z − ẑ as a number.
    #[must_use]
    pub fn with_plain_innovation(self) -> Self {
        Self {
            innovation: |problem, z, now, j| used(problem, z, now, j) - &now.predicted_measurements[j],
            ..self
        }
    }
}
