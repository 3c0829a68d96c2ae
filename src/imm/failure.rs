//! Why a step could not be computed: the step, the mode, the value, and the cause.

use super::record::Quantity;
use super::{Problem, Step};
use crate::matrix::{Holds, NotPositiveDefinite, Shapes};
use crate::number::Field;
use nalgebra::Dim;

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
    now: &Step<T, N, M>,
    j: Option<usize>,
    value: &'static str,
    cause: Cause,
) -> Failure
where
    Shapes: Holds<N, M>,
{
    Failure {
        step: now.step,
        mode: j.map_or_else(|| "all".into(), |j| problem.modes[j].name.clone()),
        value,
        cause,
    }
}

/// A value of mode j that needs a covariance which is not positive definite.
pub(super) fn not_definite<T: Field, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    now: &Step<T, N, M>,
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
        now,
        Some(j),
        value.name(),
        Cause::NotPositiveDefinite { what, pivot },
    )
}
