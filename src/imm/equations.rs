//! The table of the cycle's equations: one entry for each value of a step.
//!
//! An entry says which equation gives a field of [`Step`] from which other values. It sees the problem, the step before, the step so far
//! and its mode; the wiring in [`super::cycle`] runs the entries in order. What depends on the kind of a mode's filter is asked in
//! `by_kind.rs`. The filter proper is [`Equations::standard`]; a *variant* is this table with some entries exchanged:
//!
//! ```
//! use immaculate::imm::Equations;
//! use nalgebra::{U2, U4};
//!
//! let own_estimates_only = Equations::<f64, U4, U2> {
//!     mixing_probabilities: |problem, _, _, j| (0..problem.modes.len()).map(|i| f64::from(i == j)).collect(),
//!     ..Equations::standard()
//! };
//! ```

use super::angles::{estimates_near, estimates_near_first, wrapped};
use super::by_kind::{self, difference, seen};
use super::probability;
use super::state_conversion::Reader;
use super::{Problem, Step};
use crate::filter::update;
#[cfg(doc)]
use crate::filter::{converted, cubature, extended, iterated, kalman};
use crate::gaussian::{log_density, mixture_covariance, mixture_mean};
use crate::matrix::{Holds, NotPositiveDefinite, Shapes, check_positive_definite, ldl, quadratic_form};
use crate::number::{Field, Real};
use nalgebra::{Dim, OMatrix, OVector};
#[cfg(feature = "oracle")]
use std::borrow::Cow;

/// An equation: from the problem, the step before, the step so far, and the mode (0 for a value of all modes together).
pub type Equation<T, N, M, V> = fn(&Problem<T, N, M>, &Step<T, N, M>, &Step<T, N, M>, usize) -> V;

/// An equation that reads the measurement z: from the problem, z, the step so far, and the mode.
pub type OfMeasurement<T, N, M, V> = fn(&Problem<T, N, M>, &OVector<T, M>, &Step<T, N, M>, usize) -> V;

/// A value, or the pivot of a covariance at which it could not be had.
pub type Factored<V> = Result<V, NotPositiveDefinite>;

/// Points of the state, or their measurements.
pub type Points<T, N> = Vec<OVector<T, N>>;

/// Where a measurement is linearised, if not at the predicted mean.
pub type Iterate<T, N> = Option<OVector<T, N>>;

/// The equations of a cycle, in the order in which they are evaluated.
#[derive(Debug, Clone, Copy)]
pub struct Equations<T: Field, N: Dim, M: Dim>
where
    Shapes: Holds<N, M>,
{
    /// cⱼ, [`probability::predicted_mode_probability`].
    pub predicted_mode_probability: Equation<T, N, M, T>,
    /// μᵢ∣ⱼ of all previous modes i, [`probability::mixing_probability`].
    pub mixing_probabilities: Equation<T, N, M, Vec<T>>,
    /// x̂⁰ʲ, [`mixture_mean`].
    pub mixed_mean: Equation<T, N, M, OVector<T, N>>,
    /// P⁰ʲ, [`mixture_covariance`].
    pub mixed_covariance: Equation<T, N, M, OMatrix<T, N, N>>,
    /// The points of the mixed estimate, [`cubature::points`]; none for a filter that draws none.
    pub mixed_points: Equation<T, N, M, Factored<Points<T, N>>>,
    /// The propagated points, [`cubature::propagated_point`].
    pub propagated_points: Equation<T, N, M, Points<T, N>>,
    /// Predicted mean, [`kalman::predicted_mean`] or [`cubature::weighted_mean`].
    pub predicted_mean: Equation<T, N, M, OVector<T, N>>,
    /// F, [`extended::motion_jacobian`]; none for a filter that does not linearise the motion.
    pub motion_jacobian: Equation<T, N, M, Option<OMatrix<T, N, N>>>,
    /// Predicted covariance, [`kalman::predicted_covariance`] or [`cubature::weighted_covariance`].
    pub predicted_covariance: Equation<T, N, M, OMatrix<T, N, N>>,
    /// Mean of the combined prediction, [`mixture_mean`] under the predicted mode probabilities.
    pub combined_prediction_mean: Equation<T, N, M, OVector<T, N>>,
    /// Covariance of the combined prediction, [`mixture_covariance`].
    pub combined_prediction_covariance: Equation<T, N, M, OMatrix<T, N, N>>,
    /// The measurement as a position, [`converted::converted_measurement`]; none where no filter converts.
    pub converted_measurement: OfMeasurement<T, N, M, Option<OVector<T, M>>>,
    /// R^c, [`converted::converted_covariance`]; none where no filter converts.
    pub converted_covariance: OfMeasurement<T, N, M, Option<OMatrix<T, M, M>>>,
    /// x_{N−1}, [`iterated::linearisation_point`]; none for a filter that does not iterate.
    pub linearisation_point: OfMeasurement<T, N, M, Factored<Iterate<T, N>>>,
    /// The points of the prediction, [`cubature::points`]; none for a filter that draws none.
    pub predicted_points: Equation<T, N, M, Factored<Points<T, N>>>,
    /// The measurements of these points, [`Sensor::of`](crate::model::Sensor::of).
    pub measured_points: Equation<T, N, M, Points<T, M>>,
    /// ẑ, [`Sensor::of`](crate::model::Sensor::of) or [`Sensor::mean`](crate::model::Sensor::mean).
    pub predicted_measurement: Equation<T, N, M, OVector<T, M>>,
    /// ν, [`Sensor::difference`](crate::model::Sensor::difference).
    pub innovation: OfMeasurement<T, N, M, OVector<T, M>>,
    /// H, [`extended::measurement_jacobian`], of the mode's own state; none for a filter that does not linearise the measurement.
    pub measurement_jacobian: Equation<T, N, M, Option<OMatrix<T, M, N>>>,
    /// S, [`kalman::innovation_covariance`] or [`cubature::innovation_covariance`].
    pub innovation_covariance: Equation<T, N, M, OMatrix<T, M, M>>,
    /// C, [`kalman::cross_covariance`] or [`cubature::cross_covariance`].
    pub cross_covariance: Equation<T, N, M, OMatrix<T, N, M>>,
    /// W, [`update::gain`].
    pub gain: Equation<T, N, M, Factored<OMatrix<T, N, M>>>,
    /// Updated mean, [`update::updated_mean`].
    pub updated_mean: Equation<T, N, M, OVector<T, N>>,
    /// Updated covariance, [`update::updated_covariance`].
    pub updated_covariance: Equation<T, N, M, OMatrix<T, N, N>>,
    /// ln Lⱼ, [`log_density`].
    pub log_likelihood: Equation<T, N, M, T>,
    /// νᵀ S⁻¹ ν, [`quadratic_form`].
    pub nis: Equation<T, N, M, Option<T>>,
    /// The updated mean without a detection: the predicted one.
    pub undetected_mean: Equation<T, N, M, OVector<T, N>>,
    /// The updated covariance without a detection: the predicted one.
    pub undetected_covariance: Equation<T, N, M, OMatrix<T, N, N>>,
    /// The log-likelihood without a detection: there is none.
    pub undetected_log_likelihood: Equation<T, N, M, Option<T>>,
    /// The mode probability without a detection: the predicted one.
    pub undetected_mode_probability: Equation<T, N, M, T>,
    /// Λⱼ, [`probability::relative_likelihood`].
    pub relative_likelihood: Equation<T, N, M, T>,
    /// C, [`probability::evidence`].
    pub evidence: Equation<T, N, M, T>,
    /// m + ln C, [`probability::log_evidence`].
    pub log_evidence: Equation<T, N, M, T>,
    /// μⱼ, [`probability::mode_probability`].
    pub mode_probability: Equation<T, N, M, T>,
    /// Mean of the combined estimate, [`mixture_mean`].
    pub combined_mean: Equation<T, N, M, OVector<T, N>>,
    /// Covariance of the combined estimate, [`mixture_covariance`].
    pub combined_covariance: Equation<T, N, M, OMatrix<T, N, N>>,
    /// (x − x̂)ᵀ P⁻¹ (x − x̂), [`quadratic_form`]; none where the true state x is not known, or P is singular.
    pub nees: Equation<T, N, M, Option<T>>,
}

impl<T: Real, N: Dim, M: Dim> Equations<T, N, M>
where
    Shapes: Holds<N, M>,
{
    /// The filter proper, for every kind of filter.
    #[allow(clippy::too_many_lines, reason = "a table, one short entry an equation")]
    pub fn standard() -> Self {
        Self {
            predicted_mode_probability: |problem, previous, _, j| {
                probability::predicted_mode_probability(&problem.chain, &previous.mode_probabilities, j)
            },
            mixing_probabilities: |problem, previous, now, j| {
                let (before, predicted) = (&previous.mode_probabilities, &now.predicted_mode_probabilities[j]);
                let mixing = |i| by_kind::mixing_probability(problem, before, predicted, i, j);
                (0..problem.modes.len()).map(mixing).collect()
            },
            mixed_mean: |problem, previous, now, j| {
                let estimates = estimates_near_first(problem, &previous.updated, Reader::Mode(j));
                mixture_mean(&now.mixing_probabilities[j], &estimates)
            },
            mixed_covariance: |problem, previous, now, j| {
                let mean = &now.mixed[j].mean;
                let estimates = estimates_near(problem, &previous.updated, Reader::Mode(j), mean);
                mixture_covariance(&now.mixing_probabilities[j], &estimates, mean)
            },

            mixed_points: |problem, _, now, j| by_kind::mixed_points(problem, j, &now.mixed[j]),
            propagated_points: |problem, _, now, j| by_kind::propagated_points(problem, j, &now.mixed_points[j]),
            predicted_mean: |problem, _, now, j| {
                by_kind::predicted_mean(problem, j, &now.mixed[j].mean, &now.propagated_points[j])
            },
            motion_jacobian: |problem, _, now, j| by_kind::motion_jacobian(problem, j, &now.mixed[j].mean),
            predicted_covariance: |problem, _, now, j| {
                let (jacobian, points) = (now.motion_jacobians[j].as_ref(), &now.propagated_points[j]);
                by_kind::predicted_covariance(problem, j, &now.mixed[j], jacobian, points, &now.predicted[j].mean)
            },
            combined_prediction_mean: |problem, _, now, _| {
                let estimates = estimates_near_first(problem, &now.predicted, Reader::Common);
                mixture_mean(&now.predicted_mode_probabilities, &estimates)
            },
            combined_prediction_covariance: |problem, _, now, _| {
                let mean = &now.combined_prediction.mean;
                let estimates = estimates_near(problem, &now.predicted, Reader::Common, mean);
                mixture_covariance(&now.predicted_mode_probabilities, &estimates, mean)
            },

            converted_measurement: |problem, z, _, _| by_kind::converted_measurement(problem, z),
            converted_covariance: |problem, z, _, _| by_kind::converted_covariance(problem, z),
            linearisation_point: |problem, z, now, j| by_kind::linearisation_point(problem, j, &now.predicted[j], z),
            predicted_points: |problem, _, now, j| by_kind::predicted_points(problem, j, &now.predicted[j]),
            measured_points: |problem, _, now, j| {
                let points = now.predicted_points[j].iter();
                points.map(|point| seen(problem, point, j)).collect()
            },
            predicted_measurement: |problem, _, now, j| {
                let (at, values) = (now.linearisation_points[j].as_ref(), &now.measured_points[j]);
                by_kind::predicted_measurement(problem, j, &now.predicted[j].mean, at, values)
            },
            innovation: |problem, z, now, j| {
                difference(problem, used(problem, z, now, j), &now.predicted_measurements[j], j)
            },
            measurement_jacobian: |problem, _, now, j| {
                let at = now.linearisation_points[j].as_ref();
                by_kind::measurement_jacobian(problem, j, &now.predicted[j].mean, at)
            },
            innovation_covariance: |problem, _, now, j| {
                by_kind::innovation_covariance(
                    problem,
                    j,
                    &now.predicted[j].covariance,
                    now.measurement_jacobians[j].as_ref(),
                    &now.measured_points[j],
                    &now.predicted_measurements[j],
                    noise(problem, now, j),
                )
            },
            cross_covariance: |problem, _, now, j| {
                by_kind::cross_covariance(
                    problem,
                    j,
                    &now.predicted[j],
                    now.measurement_jacobians[j].as_ref(),
                    &now.predicted_points[j],
                    &now.measured_points[j],
                    &now.predicted_measurements[j],
                )
            },

            gain: |problem, _, now, j| {
                if let Some(given) = by_kind::given_gain(problem, j) {
                    return Ok(given.clone());
                }
                let factors = ldl(&now.innovation_covariances[j]);
                check_positive_definite(&factors)?;
                Ok(update::gain(&now.cross_covariances[j], &factors))
            },
            updated_mean: |problem, _, now, j| {
                by_kind::updated_mean(problem, j, &now.predicted[j].mean, &now.gains[j], &now.innovations[j])
            },
            updated_covariance: |_, _, now, j| {
                let innovation_covariance = &now.innovation_covariances[j];
                let covariance = &now.predicted[j].covariance;
                update::updated_covariance(covariance, &now.gains[j], innovation_covariance)
            },
            log_likelihood: |_, _, now, j| log_density(&now.innovations[j], &ldl(&now.innovation_covariances[j])),
            nis: |_, _, now, j| {
                Some(quadratic_form(
                    &ldl(&now.innovation_covariances[j]),
                    &now.innovations[j],
                ))
            },

            undetected_mean: |problem, _, now, j| {
                wrapped(problem.angles_of(Reader::Mode(j)), now.predicted[j].mean.clone())
            },
            undetected_covariance: |_, _, now, j| now.predicted[j].covariance.clone(),
            undetected_log_likelihood: |_, _, _, _| None,
            undetected_mode_probability: |_, _, now, j| now.predicted_mode_probabilities[j].clone(),

            relative_likelihood: |_, _, now, j| {
                probability::relative_likelihood(&now.log_likelihoods, &now.predicted_mode_probabilities, j)
            },
            evidence: |_, _, now, _| {
                probability::evidence(&now.relative_likelihoods, &now.predicted_mode_probabilities)
            },
            log_evidence: |_, _, now, _| {
                probability::log_evidence(&now.log_likelihoods, &now.predicted_mode_probabilities, &now.evidence)
            },
            mode_probability: |_, _, now, j| {
                let predicted = &now.predicted_mode_probabilities[j];
                probability::mode_probability(&now.relative_likelihoods[j], predicted, &now.evidence)
            },
            combined_mean: |problem, _, now, _| {
                let estimates = estimates_near_first(problem, &now.updated, Reader::Common);
                mixture_mean(&now.mode_probabilities, &estimates)
            },
            combined_covariance: |problem, _, now, _| {
                let mean = &now.combined.mean;
                let estimates = estimates_near(problem, &now.updated, Reader::Common, mean);
                mixture_covariance(&now.mode_probabilities, &estimates, mean)
            },
            nees: |problem, _, now, _| {
                let error = wrapped(&problem.angles, now.truth.as_ref()? - &now.combined.mean);
                let factors = ldl(&now.combined.covariance);
                check_positive_definite(&factors).ok()?;
                Some(quadratic_form(&factors, &error))
            },
        }
    }
}

/// F as the filter of mode j uses it, or would: the matrix of its motion, or the Jacobian of a function.
#[cfg(feature = "oracle")]
pub(crate) fn motion_matrix<'a, T: Real, N: Dim, M: Dim>(
    problem: &'a Problem<T, N, M>,
    now: &'a Step<T, N, M>,
    j: usize,
) -> Cow<'a, OMatrix<T, N, N>>
where
    Shapes: Holds<N, M>,
{
    let jacobian = now.motion_jacobians.get(j).and_then(Option::as_ref);
    by_kind::motion_matrix(problem, j, &now.mixed[j].mean, jacobian)
}

/// H as the filter of mode j uses it: the Jacobian of the measurement where it linearises, else the matrix [`Problem::h`].
#[cfg(feature = "oracle")]
pub(crate) fn measurement_matrix<'a, T: Real, N: Dim, M: Dim>(
    problem: &'a Problem<T, N, M>,
    now: &'a Step<T, N, M>,
    j: usize,
) -> Cow<'a, OMatrix<T, M, N>>
where
    Shapes: Holds<N, M>,
{
    let jacobian = now.measurement_jacobians.get(j).and_then(Option::as_ref);
    by_kind::measurement_matrix(problem, j, jacobian)
}

/// What the filter of mode j uses of a measurement: z itself, or the converted measurement.
pub(crate) fn used<'a, T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    z: &'a OVector<T, M>,
    now: &'a Step<T, N, M>,
    j: usize,
) -> &'a OVector<T, M>
where
    Shapes: Holds<N, M>,
{
    by_kind::used(problem, j, z, now.converted_measurement.as_ref())
}

/// The covariance of the noise of what the filter of mode j uses: R, or that of the converted measurement.
pub(crate) fn noise<'a, T: Real, N: Dim, M: Dim>(
    problem: &'a Problem<T, N, M>,
    now: &'a Step<T, N, M>,
    j: usize,
) -> &'a OMatrix<T, M, M>
where
    Shapes: Holds<N, M>,
{
    by_kind::used(
        problem,
        j,
        &problem.measurement_noise,
        now.converted_covariance.as_ref(),
    )
}
