//! Why a run cannot be smoothed: each error says where, and what to do.

use crate::imm::Failure;
use crate::matrix::NotPositiveDefinite;

/// Why a run cannot be smoothed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Unsmoothable {
    /// Filters with given gains.
    #[error("`filters` gives gains, and a smoother needs covariances; use filters that compute their gain")]
    NoCovariances,
    /// Modes with states of their own.
    #[error(
        "`conversions` give modes states of their own, and the smoother compares the state of one mode with that of the next; give all modes one state"
    )]
    OwnStates,
    /// Process and measurement noise are correlated.
    #[error(
        "mode `{mode}` has a `noise_cross_covariance`; a measurement then depends on the state before it too, which these equations leave out; put the noise into the state instead"
    )]
    CorrelatedNoise {
        /// The mode.
        mode: String,
    },
    /// A step was left out, or recorded twice.
    #[error("step {found} is recorded where step {expected} comes next; record every step once, as soon as it is made")]
    OtherStep {
        /// The step that comes next.
        expected: usize,
        /// The step of the filter.
        found: usize,
    },
    /// A filter with other modes or another state than the recording has.
    #[error(
        "the filter has another number of modes or components than the one that was recorded; begin a new recording"
    )]
    OtherFilter,
    /// A lag longer than the run.
    #[error("a lag of {lag} is longer than the recorded run; ask for a lag of at most {recorded}")]
    Lag {
        /// The lag.
        lag: usize,
        /// The steps after the first.
        recorded: usize,
    },
    /// A predicted covariance is singular.
    #[error(
        "step {step}, mode `{mode}`: the predicted covariance {pivot}; give that entry of the state process noise, or leave it out of the state"
    )]
    Singular {
        /// The step that was predicted.
        step: usize,
        /// The mode.
        mode: String,
        /// The pivot.
        pivot: NotPositiveDefinite,
    },
    /// A mode cannot be predicted from the estimate of another.
    #[error(transparent)]
    Prediction(Failure),
    /// A smoothed estimate is not finite.
    #[error(
        "step {step}: the smoothed estimate has an entry that is not finite; the numbers are beyond the number system"
    )]
    NotFinite {
        /// The step.
        step: usize,
    },
}
