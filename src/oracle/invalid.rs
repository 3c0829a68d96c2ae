//! Why a file is refused: the place inside it, the reason, and the class of the reason.
//!
//! The refusals of different programs are compared by these classes.

use crate::file::shortened;
use serde::Serialize;

/// The class of a reason, by which the refusals of different programs can be compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// Not JSON, an unknown or missing key, another format.
    Format,
    /// A list or matrix of the wrong size.
    Shape,
    /// A number that is not finite.
    NotFinite,
    /// A negative probability, or probabilities that do not sum to one.
    NotAProbability,
    /// A covariance that is not symmetric.
    NotSymmetric,
    /// A covariance that is not positive semidefinite, or one of innovations that is not definite.
    NotPositiveDefinite,
    /// A filter, rule, measurement or convention that does not exist.
    Unknown,
    /// A bearing beyond two turns.
    Angle,
    /// A negative range.
    Range,
}

impl Class {
    /// All classes.
    pub const ALL: [Self; 9] = [
        Self::Format,
        Self::Shape,
        Self::NotFinite,
        Self::NotAProbability,
        Self::NotSymmetric,
        Self::NotPositiveDefinite,
        Self::Unknown,
        Self::Angle,
        Self::Range,
    ];

    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Format => "format",
            Self::Shape => "shape",
            Self::NotFinite => "not-finite",
            Self::NotAProbability => "not-a-probability",
            Self::NotSymmetric => "not-symmetric",
            Self::NotPositiveDefinite => "not-positive-definite",
            Self::Unknown => "unknown",
            Self::Angle => "angle",
            Self::Range => "range",
        }
    }
}

/// A file that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {reason}")]
pub struct Invalid {
    /// The class of the reason.
    pub class: Class,
    /// The place inside the file, such as `problem.modes[1].Q[0][2]`.
    pub place: String,
    /// The reason.
    pub reason: String,
}

impl Invalid {
    /// A refusal. What it quotes of the file is shortened: a name may be megabytes long.
    pub fn new(class: Class, place: impl Into<String>, reason: impl Into<String>) -> Self {
        const KEPT: usize = 500;
        Self {
            class,
            place: shortened(&place.into(), KEPT),
            reason: shortened(&reason.into(), KEPT),
        }
    }
}
