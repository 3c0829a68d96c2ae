//! Tables with some entries exchanged: what the papers leave open, another form, and a run that shows less.

use super::Equations;
use super::angles::points_near;
use crate::filter::{Transform, Update, converted, raw};
use crate::matrix::{Holds, Shapes};
use crate::number::Real;
use nalgebra::Dim;

impl<T: Real, N: Dim, M: Dim> Equations<T, N, M>
where
    Shapes: Holds<N, M>,
{
    /// Without the values that say how consistent a filter is, νᵀ S⁻¹ ν and (x − x̂)ᵀ P⁻¹ (x − x̂), on which nothing depends.
    #[must_use]
    pub fn without_consistency(self) -> Self {
        Self {
            nis: |_, _, _, _| None,
            nees: |_, _, _, _| None,
            ..self
        }
    }

    /// R^c evaluated at the combined prediction instead of at the measurement: the noise of the bearing, which moves the measured position
    /// across, then does not turn the covariance with it.
    ///
    /// Source: sustika2015 does not say where (24)-(26) are evaluated; both are in use.
    ///
    /// Example: a target expected 8 m away and measured at 10 m, where the bearing's ½ rad is more of an arc.
    ///
    /// ```
    /// use immaculate::filter::Filter;
    /// use immaculate::{gaussian::Gaussian, imm::{Equations, Imm, Initial, Interaction, Problem}};
    /// use immaculate::model::{Conversion, Sensor, PolarComponent, motion::{Mode, Motion}};
    /// use nalgebra::{Matrix2, matrix, vector};
    ///
    /// let problem = Problem {
    ///     modes: vec![Mode { name: "still".into(), motion: Motion::Linear(Matrix2::identity()), noise: Matrix2::zeros() }],
    ///     filters: vec![Filter::converted(Conversion::Standard)],
    ///     interaction: Interaction::Imm,
    ///     angles: vec![],
    ///     chain: vec![vec![1.0]],
    ///     sensor: Sensor::Polar {
    ///         components: vec![PolarComponent::Range, PolarComponent::Bearing],
    ///         position: [0, 1],
    ///         location: [0.0, 0.0],
    ///     },
    ///     measurement_noise: matrix![4.0, 0.0; 0.0, 0.25],
    /// };
    /// let expected = Gaussian { mean: vector![8.0, 0.0], covariance: matrix![4.0, 0.0; 0.0, 75.0] };
    /// let initial = Initial { modes: vec![expected], mode_probabilities: vec![1.0] };
    /// let equations = Equations::standard().with_conversion_at_prediction();
    /// let mut filter = Imm::with_equations(problem, equations, &initial)?;
    /// let step = filter.step(Some(&vector![10.0, 0.0]))?;
    /// assert_eq!(step.converted_covariance, Some(matrix![4.0, 0.0; 0.0, 16.0])); // diag(2², 8² · ¼)
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_conversion_at_prediction(self) -> Self {
        Self {
            converted_covariance: |problem, _, now, _| {
                let at = problem.sensor.of(&now.combined_prediction.mean);
                converted::converted_covariance(problem.conversion()?, &problem.sensor, &at, &problem.measurement_noise)
            },
            ..self
        }
    }

    /// Second moments of filters with points taken about the origin, as zhu2016 (24), (45) and (48) print them: a form, equal in exact
    /// arithmetic for measurements without angles and rules whose covariance weights sum to one (the (α, β, κ) unscented rule's do only
    /// for β = α² − 1).
    #[must_use]
    pub fn with_raw_moments(self) -> Self {
        Self {
            predicted_covariance: |problem, previous, now, j| match &problem.filter(j).predict {
                Transform::Exact | Transform::Linearised => {
                    (Self::standard().predicted_covariance)(problem, previous, now, j)
                }
                Transform::Points(rule) => {
                    let mean = &now.predicted[j].mean;
                    let points = points_near(problem, j, &now.propagated_points[j], mean);
                    raw::raw_covariance(&rule.covariance_weights, &points, mean, &problem.modes[j].noise)
                }
            },
            innovation_covariance: |problem, previous, now, j| match &problem.filter(j).update {
                Update::By(Transform::Points(rule)) => {
                    let (values, mean) = (&now.measured_points[j], &now.predicted_measurements[j]);
                    raw::raw_covariance(&rule.covariance_weights, values, mean, &problem.measurement_noise)
                }
                _ => (Self::standard().innovation_covariance)(problem, previous, now, j),
            },
            cross_covariance: |problem, previous, now, j| match &problem.filter(j).update {
                Update::By(Transform::Points(rule)) => raw::raw_cross_covariance(
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
}
