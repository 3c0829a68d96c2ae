//! The table of the cycle's equations: one entry for each value of a step.
//!
//! After this file the reader knows, for every field of [`Step`], which equation gives it from which other values. An entry sees
//! the problem, the step before, the step so far and its mode; the wiring in [`super::cycle`] runs the entries in order.
//! The filter proper is [`Equations::kalman`], [`Equations::cubature`], [`Equations::converted`] or [`Equations::fixed_gain`]; a *variant*
//! is such a table with some entries exchanged:
//!
//! ```
//! use immaculate::imm::Equations;
//!
//! let own_estimates_only = Equations::<f64, 4, 2> {
//!     mixing_probability: |_, _, _, previous, current| f64::from(previous == current),
//!     ..Equations::kalman()
//! };
//! ```

use super::probability;
use super::{Problem, Step};
use crate::filter::{converted, cubature, kalman, raw, update};
use crate::gaussian::{log_density, mixture_covariance, mixture_mean};
use crate::matrix::{NotPositiveDefinite, check_positive_definite, cholesky, ldl};
use crate::number::Real;
use nalgebra::{SMatrix, SVector};

/// An equation for a value of one mode: from the problem, the previous step, the current step so far, and the mode.
pub type OfMode<T, const N: usize, const M: usize, V> =
    fn(&Problem<T, N, M>, &Step<T, N, M>, &Step<T, N, M>, usize) -> V;

/// An equation for one of several values of a mode: the fifth argument is the previous mode, or the point.
pub type OfModeAnd<T, const N: usize, const M: usize, V> =
    fn(&Problem<T, N, M>, &Step<T, N, M>, &Step<T, N, M>, usize, usize) -> V;

/// An equation for a value of all modes together: from the problem, the previous step and the current step so far.
pub type OfAll<T, const N: usize, const M: usize, V> = fn(&Problem<T, N, M>, &Step<T, N, M>, &Step<T, N, M>) -> V;

/// A matrix, or the pivot at which it could not be had.
pub type Factored<T, const R: usize, const C: usize> = Result<SMatrix<T, R, C>, NotPositiveDefinite>;

/// The equations of a cycle, in the order in which they are evaluated.
#[derive(Debug, Clone, Copy)]
#[allow(
    clippy::struct_excessive_bools,
    reason = "each says by itself what the wiring leaves out"
)]
pub struct Equations<T, const N: usize, const M: usize> {
    /// Whether the filters draw points; the Kalman filter does not.
    pub draws_points: bool,
    /// Whether the filters carry covariances; those with fixed gains do not, and the wiring skips what does not exist.
    pub keeps_covariances: bool,
    /// Whether the filters convert the measurement before they use it.
    pub converts: bool,
    /// Whether modes start from mixed estimates; where they do not, each starts from its own.
    pub mixes: bool,
    /// cⱼ, [`probability::predicted_mode_probability`].
    pub predicted_mode_probability: OfMode<T, N, M, T>,
    /// μᵢ∣ⱼ of current mode j and previous mode i, [`probability::mixing_probability`].
    pub mixing_probability: OfModeAnd<T, N, M, T>,
    /// x̂⁰ʲ, [`mixture_mean`].
    pub mixed_mean: OfMode<T, N, M, SVector<T, N>>,
    /// P⁰ʲ, [`mixture_covariance`].
    pub mixed_covariance: OfMode<T, N, M, SMatrix<T, N, N>>,
    /// Square root of P⁰ʲ, [`cholesky`].
    pub mixed_square_root: OfMode<T, N, M, Factored<T, N, N>>,
    /// A point of the mixed estimate, [`cubature::point`](fn@cubature::point).
    pub mixed_point: OfModeAnd<T, N, M, SVector<T, N>>,
    /// A propagated point, [`cubature::propagated_point`].
    pub propagated_point: OfModeAnd<T, N, M, SVector<T, N>>,
    /// Predicted mean, [`kalman::predicted_mean`] or [`cubature::weighted_mean`].
    pub predicted_mean: OfMode<T, N, M, SVector<T, N>>,
    /// Predicted covariance, [`kalman::predicted_covariance`] or [`cubature::weighted_covariance`].
    pub predicted_covariance: OfMode<T, N, M, SMatrix<T, N, N>>,
    /// Square root of the predicted covariance, [`cholesky`].
    pub predicted_square_root: OfMode<T, N, M, Factored<T, N, N>>,
    /// A point of the prediction, [`cubature::point`](fn@cubature::point).
    pub predicted_point: OfModeAnd<T, N, M, SVector<T, N>>,
    /// The measurement of a point, [`Measurement::of`](crate::model::Measurement::of).
    pub measured_point: OfModeAnd<T, N, M, SVector<T, M>>,
    /// The measurement as a position, [`converted::converted_measurement`].
    pub converted_measurement: OfAll<T, N, M, SVector<T, M>>,
    /// R^c, [`converted::converted_covariance`].
    pub converted_covariance: OfAll<T, N, M, SMatrix<T, M, M>>,
    /// ẑ, [`Measurement::of`](crate::model::Measurement::of) or [`Measurement::mean`](crate::model::Measurement::mean).
    pub predicted_measurement: OfMode<T, N, M, SVector<T, M>>,
    /// ν of a measurement, [`Measurement::difference`](crate::model::Measurement::difference).
    pub innovation: OfMode<T, N, M, SVector<T, M>>,
    /// S, [`kalman::innovation_covariance`] or [`cubature::innovation_covariance`].
    pub innovation_covariance: OfMode<T, N, M, SMatrix<T, M, M>>,
    /// C, [`kalman::cross_covariance`] or [`cubature::cross_covariance`].
    pub cross_covariance: OfMode<T, N, M, SMatrix<T, N, M>>,
    /// W, [`update::gain`].
    pub gain: OfMode<T, N, M, Factored<T, N, M>>,
    /// Updated mean, [`update::updated_mean`].
    pub updated_mean: OfMode<T, N, M, SVector<T, N>>,
    /// Updated covariance, [`update::updated_covariance`].
    pub updated_covariance: OfMode<T, N, M, SMatrix<T, N, N>>,
    /// ln Lⱼ, [`log_density`].
    pub log_likelihood: OfMode<T, N, M, T>,
    /// The updated mean without a detection: the predicted one.
    pub undetected_mean: OfMode<T, N, M, SVector<T, N>>,
    /// The updated covariance without a detection: the predicted one.
    pub undetected_covariance: OfMode<T, N, M, SMatrix<T, N, N>>,
    /// The log-likelihood without a detection: there is none.
    pub undetected_log_likelihood: OfMode<T, N, M, T>,
    /// The mode probability without a detection: the predicted one.
    pub undetected_mode_probability: OfMode<T, N, M, T>,
    /// Mean of the combined prediction, [`mixture_mean`] under the predicted mode probabilities.
    pub combined_prediction_mean: OfAll<T, N, M, SVector<T, N>>,
    /// Covariance of the combined prediction, [`mixture_covariance`].
    pub combined_prediction_covariance: OfAll<T, N, M, SMatrix<T, N, N>>,
    /// Λⱼ, [`probability::relative_likelihood`].
    pub relative_likelihood: OfMode<T, N, M, T>,
    /// C, [`probability::evidence`].
    pub evidence: OfAll<T, N, M, T>,
    /// m + ln C, [`probability::log_evidence`].
    pub log_evidence: OfAll<T, N, M, T>,
    /// μⱼ, [`probability::mode_probability`].
    pub mode_probability: OfMode<T, N, M, T>,
    /// Mean of the combined estimate, [`mixture_mean`].
    pub combined_mean: OfAll<T, N, M, SVector<T, N>>,
    /// Covariance of the combined estimate, [`mixture_covariance`].
    pub combined_covariance: OfAll<T, N, M, SMatrix<T, N, N>>,
}

impl<T: Real, const N: usize, const M: usize> Equations<T, N, M> {
    /// Kalman filters: linear motion, linear measurement, no points.
    #[allow(clippy::too_many_lines, reason = "a table, one short entry an equation")]
    pub fn kalman() -> Self {
        Self {
            draws_points: false,
            keeps_covariances: true,
            converts: false,
            mixes: true,

            predicted_mode_probability: |problem, previous, _, j| {
                let probabilities = &previous.mode_probabilities;
                probability::predicted_mode_probability(&problem.transition, probabilities, j)
            },
            mixing_probability: |problem, previous, now, j, i| {
                let probabilities = &previous.mode_probabilities;
                let predicted = &now.predicted_mode_probabilities[j];
                probability::mixing_probability(&problem.transition, probabilities, predicted, i, j)
            },
            mixed_mean: |_, previous, now, j| mixture_mean(&now.mixing_probabilities[j], &previous.updated),
            mixed_covariance: |_, previous, now, j| {
                let mean = &now.mixed[j].mean;
                mixture_covariance(&now.mixing_probabilities[j], &previous.updated, mean)
            },

            mixed_square_root: |_, _, now, j| cholesky(&now.mixed[j].covariance),
            mixed_point: |problem, _, now, j, s| {
                let root = &now.mixed_square_roots[j];
                cubature::point(root, &points(problem)[s], &now.mixed[j].mean)
            },
            propagated_point: |problem, _, now, j, s| {
                cubature::propagated_point(&problem.modes[j].transition, &now.mixed_points[j][s])
            },
            predicted_mean: |problem, _, now, j| {
                kalman::predicted_mean(&problem.modes[j].transition, &now.mixed[j].mean)
            },
            predicted_covariance: |problem, _, now, j| {
                let mode = &problem.modes[j];
                let covariance = &now.mixed[j].covariance;
                kalman::predicted_covariance(&mode.transition, covariance, &mode.noise)
            },

            predicted_square_root: |_, _, now, j| cholesky(&now.predicted[j].covariance),
            predicted_point: |problem, _, now, j, s| {
                let root = &now.predicted_square_roots[j];
                cubature::point(root, &points(problem)[s], &now.predicted[j].mean)
            },
            measured_point: |problem, _, now, j, s| problem.measurement.of(&now.predicted_points[j][s]),
            converted_measurement: |_, _, _| SVector::from_fn(|_, _| T::undecided()),
            converted_covariance: |_, _, _| undecided(),
            predicted_measurement: |problem, _, now, j| problem.measurement.of(&now.predicted[j].mean),
            innovation: |problem, _, now, j| {
                let Some(z) = &now.measurement else {
                    return SVector::from_fn(|_, _| T::undecided());
                };
                problem.measurement.difference(z, &now.predicted_measurements[j])
            },
            innovation_covariance: |problem, _, now, j| {
                let h = problem.measurement.matrix();
                let covariance = &now.predicted[j].covariance;
                kalman::innovation_covariance(&h, covariance, &problem.measurement_noise)
            },
            cross_covariance: |problem, _, now, j| {
                kalman::cross_covariance(&now.predicted[j].covariance, &problem.measurement.matrix())
            },

            gain: |_, _, now, j| {
                let factors = ldl(&now.innovation_covariances[j]);
                check_positive_definite(&factors)?;
                Ok(update::gain(&now.cross_covariances[j], &factors))
            },
            updated_mean: |_, _, now, j| {
                update::updated_mean(&now.predicted[j].mean, &now.gains[j], &now.innovations[j])
            },
            updated_covariance: |_, _, now, j| {
                let innovation_covariance = &now.innovation_covariances[j];
                let covariance = &now.predicted[j].covariance;
                update::updated_covariance(covariance, &now.gains[j], innovation_covariance)
            },
            log_likelihood: |_, _, now, j| log_density(&now.innovations[j], &ldl(&now.innovation_covariances[j])),

            undetected_mean: |_, _, now, j| now.predicted[j].mean.clone(),
            undetected_covariance: |_, _, now, j| now.predicted[j].covariance.clone(),
            undetected_log_likelihood: |_, _, _, _| T::undecided(),
            undetected_mode_probability: |_, _, now, j| now.predicted_mode_probabilities[j].clone(),

            combined_prediction_mean: |_, _, now| mixture_mean(&now.predicted_mode_probabilities, &now.predicted),
            combined_prediction_covariance: |_, _, now| {
                let mean = &now.combined_prediction.mean;
                mixture_covariance(&now.predicted_mode_probabilities, &now.predicted, mean)
            },
            relative_likelihood: |_, _, now, j| {
                probability::relative_likelihood(&now.log_likelihoods, &now.predicted_mode_probabilities, j)
            },
            evidence: |_, _, now| probability::evidence(&now.relative_likelihoods, &now.predicted_mode_probabilities),
            log_evidence: |_, _, now| {
                let predicted = &now.predicted_mode_probabilities;
                probability::log_evidence(&now.log_likelihoods, predicted, &now.evidence)
            },
            mode_probability: |_, _, now, j| {
                let predicted = &now.predicted_mode_probabilities[j];
                probability::mode_probability(&now.relative_likelihoods[j], predicted, &now.evidence)
            },
            combined_mean: |_, _, now| mixture_mean(&now.mode_probabilities, &now.updated),
            combined_covariance: |_, _, now| {
                mixture_covariance(&now.mode_probabilities, &now.updated, &now.combined.mean)
            },
        }
    }

    /// Cubature filters, unscented and Gauss-Hermite included: the moments by the problem's rule, in centred form.
    pub fn cubature() -> Self {
        Self {
            draws_points: true,
            predicted_mean: |problem, _, now, j| cubature::weighted_mean(weights(problem), &now.propagated_points[j]),
            predicted_covariance: |problem, _, now, j| {
                let (points, mean) = (&now.propagated_points[j], &now.predicted[j].mean);
                let noise = &problem.modes[j].noise;
                cubature::weighted_covariance(covariance_weights(problem), points, mean, noise)
            },
            predicted_measurement: |problem, _, now, j| {
                let centre = problem.measurement.of(&now.predicted[j].mean);
                let values = &now.measured_points[j];
                problem.measurement.mean(weights(problem), values, &centre)
            },
            innovation_covariance: |problem, _, now, j| {
                cubature::innovation_covariance(
                    &problem.measurement,
                    covariance_weights(problem),
                    &now.measured_points[j],
                    &now.predicted_measurements[j],
                    &problem.measurement_noise,
                )
            },
            cross_covariance: |problem, _, now, j| {
                cubature::cross_covariance(
                    &problem.measurement,
                    covariance_weights(problem),
                    &now.predicted_points[j],
                    &now.predicted[j].mean,
                    &now.measured_points[j],
                    &now.predicted_measurements[j],
                )
            },
            ..Self::kalman()
        }
    }

    /// Filters with converted measurements: Kalman filters whose measurement and noise are those of the position that was measured.
    ///
    /// Source: sustika2015, section 3.1.
    ///
    /// ```text
    /// ν = z^c − H x̂⁻     S = H P⁻ Hᵀ + R^c
    /// ```
    ///
    /// Example: a target expected at (8, 0) is measured 10 m straight ahead, with σ_r = 2 m and σ_θ = ½ rad.
    ///
    /// ```
    /// use immaculate::{gaussian::Gaussian, imm::{Equations, Imm, Initial, Problem}};
    /// use immaculate::model::{Conversion, Measurement, PolarComponent, motion::Mode};
    /// use nalgebra::{Matrix2, matrix, vector};
    ///
    /// let problem = Problem {
    ///     modes: vec![Mode { name: "still".into(), transition: Matrix2::identity(), noise: Matrix2::zeros() }],
    ///     transition: vec![vec![1.0]],
    ///     measurement: Measurement::Converted {
    ///         components: [PolarComponent::Range, PolarComponent::Bearing],
    ///         position: [0, 1],
    ///         sensor: [0.0, 0.0],
    ///         conversion: Conversion::Standard,
    ///     },
    ///     measurement_noise: matrix![4.0, 0.0; 0.0, 0.25],
    ///     rule: None,
    ///     fixed_gains: None,
    /// };
    /// let expected = Gaussian { mean: vector![8.0, 0.0], covariance: matrix![4.0, 0.0; 0.0, 75.0] };
    /// let initial = Initial { modes: vec![expected], mode_probabilities: vec![1.0] };
    /// let mut filter = Imm::new(problem, Equations::converted(), &initial)?;
    /// let step = filter.step(Some(&vector![10.0, 0.0]))?;
    /// // R^c = diag(2², 10² · ¼), S = diag(4 + 4, 75 + 25)
    /// assert_eq!(step.innovation_covariances[0], matrix![8.0, 0.0; 0.0, 100.0]);
    /// assert_eq!(step.combined.mean, vector![9.0, 0.0]); // 8 + 4/8 · (10 − 8)
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Evidence: `a_converted_filter_is_the_kalman_filter_of_the_converted_measurements` (exact).
    pub fn converted() -> Self {
        Self {
            converts: true,
            converted_measurement: |problem, _, now| {
                let Some(z) = &now.measurement else {
                    return SVector::from_fn(|_, _| T::undecided());
                };
                converted::converted_measurement(&problem.measurement, z, &problem.measurement_noise)
            },
            converted_covariance: |problem, _, now| {
                let Some(z) = &now.measurement else {
                    return undecided();
                };
                converted::converted_covariance(&problem.measurement, z, &problem.measurement_noise)
            },
            innovation: |_, _, now, j| &now.converted_measurement - &now.predicted_measurements[j],
            innovation_covariance: |problem, _, now, j| {
                let h = problem.measurement.matrix();
                kalman::innovation_covariance(&h, &now.predicted[j].covariance, &now.converted_covariance)
            },
            ..Self::kalman()
        }
    }

    /// The same with R^c evaluated at the combined prediction instead of at the measurement: the noise of the bearing, which moves the
    /// measured position across, then does not turn the covariance with it.
    ///
    /// Source: sustika2015 does not say where (24)-(26) are evaluated; both are in use.
    ///
    /// Example: the same target, expected at 8 m, where the bearing's ½ rad is less of an arc than at the measured 10 m.
    ///
    /// ```
    /// use immaculate::{gaussian::Gaussian, imm::{Equations, Imm, Initial, Problem}};
    /// use immaculate::model::{Conversion, Measurement, PolarComponent, motion::Mode};
    /// use nalgebra::{Matrix2, matrix, vector};
    ///
    /// let problem = Problem {
    ///     modes: vec![Mode { name: "still".into(), transition: Matrix2::identity(), noise: Matrix2::zeros() }],
    ///     transition: vec![vec![1.0]],
    ///     measurement: Measurement::Converted {
    ///         components: [PolarComponent::Range, PolarComponent::Bearing],
    ///         position: [0, 1],
    ///         sensor: [0.0, 0.0],
    ///         conversion: Conversion::Standard,
    ///     },
    ///     measurement_noise: matrix![4.0, 0.0; 0.0, 0.25],
    ///     rule: None,
    ///     fixed_gains: None,
    /// };
    /// let expected = Gaussian { mean: vector![8.0, 0.0], covariance: matrix![4.0, 0.0; 0.0, 75.0] };
    /// let initial = Initial { modes: vec![expected], mode_probabilities: vec![1.0] };
    /// let mut filter = Imm::new(problem, Equations::converted_at_prediction(), &initial)?;
    /// let step = filter.step(Some(&vector![10.0, 0.0]))?;
    /// assert_eq!(step.converted_covariance, matrix![4.0, 0.0; 0.0, 16.0]); // diag(2², 8² · ¼)
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn converted_at_prediction() -> Self {
        Self {
            converted_covariance: |problem, _, now| {
                let at = converted::polar_position(&problem.measurement, &now.combined_prediction.mean);
                converted::converted_covariance(&problem.measurement, &at, &problem.measurement_noise)
            },
            ..Self::converted()
        }
    }

    /// The table for a problem: filters with points where it has a rule, with converted measurements where they are to be converted, with
    /// fixed gains (and mixed states) where it has those, else Kalman filters.
    pub fn standard(problem: &Problem<T, N, M>) -> Self {
        if problem.rule.is_some() {
            Self::cubature()
        } else if problem.measurement.is_converted() {
            Self::converted()
        } else if problem.fixed_gains.is_some() {
            Self::fixed_gain()
        } else {
            Self::kalman()
        }
    }

    /// Cubature filters with second moments about the origin, as zhu2016 (24), (45) and (48) print them: a form, equal in exact
    /// arithmetic for measurements without angles and rules whose covariance weights sum to one (the (α, β, κ) unscented rule's do only
    /// for β = α² − 1).
    pub fn raw_cubature() -> Self {
        Self {
            predicted_covariance: |problem, _, now, j| {
                let (points, mean) = (&now.propagated_points[j], &now.predicted[j].mean);
                let noise = &problem.modes[j].noise;
                raw::raw_covariance(covariance_weights(problem), points, mean, noise)
            },
            innovation_covariance: |problem, _, now, j| {
                let (values, mean) = (&now.measured_points[j], &now.predicted_measurements[j]);
                let noise = &problem.measurement_noise;
                raw::raw_covariance(covariance_weights(problem), values, mean, noise)
            },
            cross_covariance: |problem, _, now, j| {
                raw::raw_cross_covariance(
                    covariance_weights(problem),
                    &now.predicted_points[j],
                    &now.predicted[j].mean,
                    &now.measured_points[j],
                    &now.predicted_measurements[j],
                )
            },
            ..Self::cubature()
        }
    }
}

/// A matrix that has no answer.
pub(super) fn undecided<T: Real, const R: usize, const C: usize>() -> SMatrix<T, R, C> {
    SMatrix::from_fn(|_, _| T::undecided())
}

/// The points of the problem's rule; none without one.
fn points<T, const N: usize, const M: usize>(problem: &Problem<T, N, M>) -> &[SVector<T, N>] {
    problem.rule.as_ref().map_or(&[], |rule| &rule.points)
}

/// The weights of the problem's rule; none without one.
pub(super) fn weights<T, const N: usize, const M: usize>(problem: &Problem<T, N, M>) -> &[T] {
    problem.rule.as_ref().map_or(&[], |rule| &rule.weights)
}

/// The covariance weights of the problem's rule; none without one.
pub(super) fn covariance_weights<T, const N: usize, const M: usize>(problem: &Problem<T, N, M>) -> &[T] {
    problem.rule.as_ref().map_or(&[], |rule| &rule.covariance_weights)
}
