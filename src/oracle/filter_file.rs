//! The filter of a problem file: its kind, with what the kind needs.

use super::chain::CONTINUOUS_CHAIN;
use super::problem::{Rows, if_there_at_all};
use crate::imm::{Needs, Quantity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::num::NonZeroUsize;

/// The rules of cubature filters. What a paper prints wrongly is no rule of a problem.
pub const RULES: [&str; 7] = [
    "cubature-3",
    "cubature-5",
    "simplex-5",
    "gauss-hermite-2",
    "gauss-hermite-3",
    "gauss-hermite-4",
    "gauss-hermite-5",
];

/// The readings of filters with fixed gains: each mode starts from a mixed estimate, or from its own.
pub const MIXINGS: [&str; 2] = ["mixed", UNMIXED];

/// The reading in which each mode starts from its own estimate.
pub const UNMIXED: &str = "unmixed";

/// The kinds of filter whose name is not that of a rule.
const OTHER_KINDS: [&str; 12] = [
    "kalman",
    "extended",
    "extended-iterated",
    "unscented",
    "converted",
    "fixed-gain",
    "fixed-gain-unmixed",
    CORRELATED_NOISE,
    STATE_CONVERSION,
    CONTINUOUS_CHAIN,
    GPB1,
    UNMIXED,
];

/// What a filter must take, beside its own kind, where the noises of motion and measurement are correlated.
pub(super) const CORRELATED_NOISE: &str = "correlated-noise";

/// What a filter must take, beside its own kind, where modes have states of their own.
pub(super) const STATE_CONVERSION: &str = "state-conversion";

/// What a filter must take, beside its own kind, where all modes start from the combined estimate.
pub(super) const GPB1: &str = "gpb1";

/// The families of filters, which differ in their equations and not only in a rule: [`FilterFile::family`].
pub const FAMILIES: [&str; 6] = ["kalman", "extended", "cubature", "unscented", "converted", "fixed-gain"];

/// The names of all kinds of filter, [`FilterFile::name`], and of what not every one of a kind takes.
pub fn kinds() -> impl Iterator<Item = &'static str> {
    OTHER_KINDS.into_iter().chain(RULES)
}

/// The filter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum FilterFile {
    /// Linear motion and measurement.
    Kalman {},
    /// Motion and measurement by their Jacobians. Format 2.
    Extended {
        /// How often the measurement is linearised in an update; absent, once.
        #[serde(
            default,
            skip_serializing_if = "Option::is_none",
            deserialize_with = "if_there_at_all"
        )]
        #[schemars(with = "NonZeroUsize")]
        iterations: Option<NonZeroUsize>,
    },
    /// Moments by the points of a rule.
    Cubature {
        /// `cubature-3`, `cubature-5`, `simplex-5`, `gauss-hermite-2` to `gauss-hermite-5`.
        rule: String,
    },
    /// Moments by the points of the unscented rule.
    Unscented {
        /// α.
        alpha: f64,
        /// β.
        beta: f64,
        /// κ.
        kappa: f64,
    },
    /// Linear motion; range and bearing that are turned into a position.
    Converted {
        /// `standard`, `additive`, `multiplicative` or `modified-unbiased`.
        conversion: String,
    },
    /// Linear motion and measurement, with gains that are given and no covariances.
    FixedGain {
        /// `mixed` or `unmixed`: whether a mode starts from a mixed estimate, or from its own.
        mixing: String,
        /// One a mode.
        modes: Vec<FixedGainFile>,
    },
}

/// Which estimates the filters of the modes start from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum InteractionFile {
    /// Those of all modes, mixed.
    Imm,
    /// The combined one.
    Gpb1,
    /// Their own.
    Unmixed,
}

impl InteractionFile {
    /// The word for it in files.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Imm => "imm",
            Self::Gpb1 => GPB1,
            Self::Unmixed => UNMIXED,
        }
    }

    /// The printed equations that give a quantity in a filter.
    pub fn equation(self, filter: &FilterFile, quantity: Quantity) -> &'static str {
        match (self, quantity) {
            (Self::Gpb1, Quantity::MixingProbabilities) => "Bar-Shalom, Li and Kirubarajan 2001, section 11.6.4",
            (Self::Unmixed, Quantity::MixingProbabilities) => "Bar-Shalom, Li and Kirubarajan 2001, section 11.6.2",
            _ => filter.equation(quantity),
        }
    }
}

/// What a mode has in place of covariances.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FixedGainFile {
    /// n × m.
    pub gain: Rows,
    /// m × m.
    pub innovation_covariance: Rows,
}

impl FilterFile {
    /// Whether the measurement is linearised more than once in an update.
    pub(super) fn iterates(&self) -> bool {
        matches!(self, Self::Extended { iterations: Some(times) } if times.get() > 1)
    }

    /// The kind's short name: `kalman`, `extended`, `extended-iterated`, `unscented`, the rule's, `converted`, `fixed-gain` or, where no
    /// estimates are mixed, `fixed-gain-unmixed`.
    pub fn name(&self) -> &str {
        match self {
            Self::Kalman {} => "kalman",
            Self::Extended { .. } if self.iterates() => "extended-iterated",
            Self::Extended { .. } => "extended",
            Self::Cubature { rule } => rule,
            Self::Unscented { .. } => "unscented",
            Self::Converted { .. } => "converted",
            Self::FixedGain { mixing, .. } if mixing == UNMIXED => "fixed-gain-unmixed",
            Self::FixedGain { .. } => "fixed-gain",
        }
    }

    /// The family: the kind's word in a file.
    pub fn family(&self) -> &'static str {
        match self {
            Self::Kalman {} => "kalman",
            Self::Extended { .. } => "extended",
            Self::Cubature { .. } => "cubature",
            Self::Unscented { .. } => "unscented",
            Self::Converted { .. } => "converted",
            Self::FixedGain { .. } => "fixed-gain",
        }
    }

    /// The printed equations that give a quantity: with fixed gains the gain and the innovation covariance are not computed but given.
    pub fn equation(&self, quantity: Quantity) -> &'static str {
        match (self, quantity) {
            (Self::FixedGain { .. }, Quantity::InnovationCovariance) => "derbez2000 (4), given",
            (Self::FixedGain { .. }, Quantity::Gain) => "derbez2000, section 3, given",
            (Self::FixedGain { .. }, Quantity::UpdatedMean) => "derbez2000, section 3",
            (Self::Converted { .. }, Quantity::Innovation | Quantity::PredictedMeasurement) => "sustika2015 (18)",
            (Self::Converted { .. }, Quantity::InnovationCovariance) => "sustika2015 (16)",
            (Self::Converted { .. }, Quantity::CrossCovariance | Quantity::Gain) => "sustika2015 (17)",
            (
                Self::Extended { .. },
                Quantity::PredictedMeasurement
                | Quantity::MeasurementJacobian
                | Quantity::InnovationCovariance
                | Quantity::CrossCovariance,
            ) if self.iterates() => "Bar-Shalom, Li and Kirubarajan 2001, section 10.5.2",
            (
                Self::Extended { .. },
                Quantity::PredictedMean
                | Quantity::PredictedCovariance
                | Quantity::PredictedMeasurement
                | Quantity::InnovationCovariance
                | Quantity::CrossCovariance,
            ) => "Bar-Shalom, Li and Kirubarajan 2001, section 10.3",
            _ => quantity.equation(),
        }
    }

    /// Whether what a value needs is there in filters of this kind, apart from a detection.
    pub fn has(&self, needed: Needs) -> bool {
        match needed {
            Needs::Covariances => !matches!(self, Self::FixedGain { .. }),
            Needs::Conversion => matches!(self, Self::Converted { .. }),
            Needs::LinearisedMotion | Needs::LinearisedMeasurement => matches!(self, Self::Extended { .. }),
            Needs::Iterations => self.iterates(),
            Needs::Detection | Needs::Consistency | Needs::Truth => true,
        }
    }
}
