//! The update of one mode, in the order in which its equations are evaluated.
//!
//! ```text
//! x_{N−1} ─▶ points ─▶ ẑ ─▶ ν ─▶ H ─▶ S ─▶ C ─▶ gain ─▶ updated mean, covariance ─▶ ln L, νᵀ S⁻¹ ν
//! ```

use super::failure::{Failure, check_slopes, not_definite};
use super::observer::Observer;
use super::record::Quantity;
use super::{Equations, Problem, Step};
use crate::matrix::{Holds, Shapes};
use crate::number::Real;
use nalgebra::{Dim, OVector};

/// The update of mode j with the measurement z, and its likelihood. The modes before it must have been updated.
///
/// # Errors
///
/// [`Failure`] when a covariance is not positive definite.
pub(crate) fn update<T: Real, N: Dim, M: Dim>(
    e: &Equations<T, N, M>,
    problem: &Problem<T, N, M>,
    previous: &Step<T, N, M>,
    now: &mut Step<T, N, M>,
    z: &OVector<T, M>,
    j: usize,
    observer: &mut impl Observer<T, N, M>,
) -> Result<(), Failure>
where
    Shapes: Holds<N, M>,
{
    let point = (e.linearisation_point)(problem, z, now, j)
        .map_err(|pivot| not_definite(problem, now.step, j, Quantity::Gain, "innovation covariance", pivot))?;
    now.linearisation_points.push(point);
    let points = (e.predicted_points)(problem, previous, now, j).map_err(|pivot| {
        not_definite(
            problem,
            now.step,
            j,
            Quantity::PredictedMeasurement,
            "predicted covariance",
            pivot,
        )
    })?;
    now.predicted_points.push(points);
    let values = (e.measured_points)(problem, previous, now, j);
    now.measured_points.push(values);
    let predicted = (e.predicted_measurement)(problem, previous, now, j);
    now.predicted_measurements.push(predicted);
    observer.computed(Quantity::PredictedMeasurement, j, now);
    let innovation = (e.innovation)(problem, z, now, j);
    now.innovations.push(innovation);
    observer.computed(Quantity::Innovation, j, now);
    let jacobian = (e.measurement_jacobian)(problem, previous, now, j);
    check_slopes(problem, now.step, j, Quantity::MeasurementJacobian, jacobian.as_ref())?;
    now.measurement_jacobians.push(jacobian);
    if now.measurement_jacobians[j].is_some() {
        observer.computed(Quantity::MeasurementJacobian, j, now);
    }
    let covariance = (e.innovation_covariance)(problem, previous, now, j);
    now.innovation_covariances.push(covariance);
    observer.computed(Quantity::InnovationCovariance, j, now);
    if problem.has_covariances() {
        let covariance = (e.cross_covariance)(problem, previous, now, j);
        now.cross_covariances.push(covariance);
        observer.computed(Quantity::CrossCovariance, j, now);
    }
    let gain = (e.gain)(problem, previous, now, j)
        .map_err(|pivot| not_definite(problem, now.step, j, Quantity::Gain, "innovation covariance", pivot))?;
    now.gains.push(gain);
    observer.computed(Quantity::Gain, j, now);
    correct(e, problem, previous, now, j, observer);
    Ok(())
}

/// The estimate of mode j corrected by its gain, and how well the mode explains the measurement.
fn correct<T: Real, N: Dim, M: Dim>(
    e: &Equations<T, N, M>,
    problem: &Problem<T, N, M>,
    previous: &Step<T, N, M>,
    now: &mut Step<T, N, M>,
    j: usize,
    observer: &mut impl Observer<T, N, M>,
) where
    Shapes: Holds<N, M>,
{
    now.updated[j].mean = (e.updated_mean)(problem, previous, now, j);
    observer.computed(Quantity::UpdatedMean, j, now);
    if problem.has_covariances() {
        now.updated[j].covariance = (e.updated_covariance)(problem, previous, now, j);
        observer.computed(Quantity::UpdatedCovariance, j, now);
    }
    let log_likelihood = (e.log_likelihood)(problem, previous, now, j);
    now.log_likelihoods.push(log_likelihood);
    observer.computed(Quantity::LogLikelihood, j, now);
    let square = (e.nis)(problem, previous, now, j);
    now.nis.push(square);
    observer.computed(Quantity::Nis, j, now);
}
