//! Why a step could not be computed: the step, the mode, the value, and the cause.

use super::Problem;
use super::record::Quantity;
use crate::gaussian::Gaussian;
use crate::matrix::{Holds, NotPositiveDefinite, Shapes, all_finite};
use crate::model::PolarComponent;
use crate::number::{Field, Real};
use nalgebra::{DefaultAllocator, Dim, OMatrix, OVector, allocator::Allocator};

/// A step that could not be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("step {step}, mode `{mode}`, {value}: {cause}")]
pub struct Failure {
    /// The step, counted from 1.
    pub step: usize,
    /// The name of the mode, or "all".
    pub mode: String,
    /// The name of the value that could not be computed, as in traces.
    pub value: &'static str,
    /// Why.
    pub cause: Cause,
}

/// Why a step could not be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Cause {
    /// A covariance stopped being positive definite.
    #[error("the {what} {pivot}")]
    NotPositiveDefinite {
        /// Which covariance.
        what: &'static str,
        /// The pivot.
        pivot: NotPositiveDefinite,
    },
    /// The measurement has another number of components than R.
    #[error("the measurement has {found} components where R has {expected}")]
    MeasurementLength {
        /// Its components.
        found: usize,
        /// The components that are needed.
        expected: usize,
    },
    /// The measurement has an entry that is not finite.
    #[error("the measurement has an entry that is not finite")]
    MeasurementNotFinite,
    /// A range below zero.
    #[error("the measured range {range} is negative; a range is a distance")]
    NegativeRange {
        /// The range.
        range: String,
    },
    /// A bearing outside two turns of zero.
    #[error("the measured bearing {bearing} is outside ±2π: is it in degrees?")]
    BearingOutOfRange {
        /// The bearing.
        bearing: String,
    },
    /// A function has no slope at the mean where it is linearised, as range and bearing at the sensor.
    #[error("the function has no finite slope at the mean, as range and bearing have none at the sensor")]
    NoSlope,
    /// The combined estimate has an entry that is not finite: the problem's numbers are beyond the number system.
    #[error("the combined estimate has an entry that is not finite")]
    EstimateNotFinite,
    /// The likelihood of the measurement is beyond the number system.
    #[error("the log-likelihood of the measurement under all modes together is not finite")]
    NoEvidence,
}

/// A value of mode j, or of all modes, that could not be computed.
pub(super) fn failure<T: Field, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    step: usize,
    j: Option<usize>,
    value: &'static str,
    cause: Cause,
) -> Failure
where
    Shapes: Holds<N, M>,
{
    Failure {
        step,
        mode: j.map_or_else(|| "all".into(), |j| problem.modes[j].name.clone()),
        value,
        cause,
    }
}

/// A value of mode j that needs a covariance which is not positive definite.
pub(super) fn not_definite<T: Field, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    step: usize,
    j: usize,
    value: Quantity,
    what: &'static str,
    pivot: NotPositiveDefinite,
) -> Failure
where
    Shapes: Holds<N, M>,
{
    failure(
        problem,
        step,
        Some(j),
        value.name(),
        Cause::NotPositiveDefinite { what, pivot },
    )
}

/// A measurement is finite, its ranges are not negative, and its bearings are angles in radians.
///
/// # Errors
///
/// [`Failure`] that says what is wrong with it.
pub(super) fn check_measurement<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    step: usize,
    z: &OVector<T, M>,
) -> Result<(), Failure>
where
    Shapes: Holds<N, M>,
{
    let fail = |cause| Err(failure(problem, step, None, "measurement", cause));
    let (found, expected) = (z.len(), problem.m().value());
    if found != expected {
        return fail(Cause::MeasurementLength { found, expected });
    }
    if !all_finite(z) {
        return fail(Cause::MeasurementNotFinite);
    }
    let two_turns = T::pi() * T::integer(2);
    for (component, value) in z.iter().enumerate() {
        let sensor = &problem.sensor;
        if sensor.reports(component) == Some(PolarComponent::Range) && *value < T::zero() {
            let range = format!("{value:?}");
            return fail(Cause::NegativeRange { range });
        }
        if sensor.is_angle(component) && (*value > two_turns || *value < -two_turns.clone()) {
            let bearing = format!("{value:?}");
            return fail(Cause::BearingOutOfRange { bearing });
        }
    }
    Ok(())
}

/// The combined estimate is finite: its mean, and its covariance where filters have one.
///
/// # Errors
///
/// [`Failure`] where the problem's numbers are beyond the number system.
pub(super) fn check_combined<T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    step: usize,
    combined: &Gaussian<T, N>,
) -> Result<(), Failure>
where
    Shapes: Holds<N, M>,
{
    if all_finite(&combined.mean) && (!problem.has_covariances() || all_finite(&combined.covariance)) {
        return Ok(());
    }
    Err(failure(problem, step, None, "combined", Cause::EstimateNotFinite))
}

/// The Jacobian of mode j, if its filter has one, is finite.
///
/// # Errors
///
/// [`Failure`] where a function has no slope.
pub(super) fn check_slopes<T: Real, N: Dim, M: Dim, R: Dim, C: Dim>(
    problem: &Problem<T, N, M>,
    step: usize,
    j: usize,
    value: Quantity,
    jacobian: Option<&OMatrix<T, R, C>>,
) -> Result<(), Failure>
where
    Shapes: Holds<N, M>,
    DefaultAllocator: Allocator<R, C>,
{
    match jacobian {
        Some(jacobian) if !all_finite(jacobian) => Err(failure(problem, step, Some(j), value.name(), Cause::NoSlope)),
        _ => Ok(()),
    }
}
