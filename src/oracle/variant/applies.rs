//! Where a variant can make a difference: the kinds of problem that the catalogue names.

use super::super::setup::Setup;
use super::{draws_no_points, draws_points, has_correlated_noises, has_state_conversions, zero_rows};
use crate::filter::{Filter, Transform, Update};
use crate::imm::state_conversion::Reader;
use crate::imm::{Interaction, Problem};
use crate::model::{PolarComponent, Sensor};
use crate::number::Real;
use nalgebra::Dyn;
use serde::{Deserialize, Serialize};

/// Where a variant can make a difference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Applies {
    /// Everywhere.
    All,
    /// In filters with points.
    Points,
    /// In filters that convert range and bearing to a position.
    Conversions,
    /// In Kalman filters.
    Kalman,
    /// In filters that linearise the motion or the measurement.
    Linearised,
    /// Where process and measurement noise are correlated.
    #[serde(rename = "correlated noises")]
    CorrelatedNoises,
    /// In problems whose steps differ.
    #[serde(rename = "changing steps")]
    ChangingSteps,
    /// In filters that carry covariances.
    Covariances,
    /// In filters with fixed gains.
    #[serde(rename = "fixed gains")]
    FixedGains,
    /// Where a motion sets an entry of the state to zero.
    #[serde(rename = "embedded motion")]
    EmbeddedMotion,
    /// Where a mode lacks an entry of the state that another has.
    #[serde(rename = "unequal dimensions")]
    UnequalDimensions,
    /// Where residuals of bearings are formed.
    Angles,
    /// Where an entry of the state is an angle.
    #[serde(rename = "state angles")]
    StateAngles,
    /// Where modes have states of their own.
    #[serde(rename = "state conversions")]
    StateConversions,
    /// Where all modes start from the combined estimate.
    #[serde(rename = "common start")]
    CommonStart,
    /// Where the chain is given by rates or sojourn times.
    Rates,
    /// Where it is given by sojourn times.
    #[serde(rename = "sojourn times")]
    SojournTimes,
    /// Where a bearing is measured, converted or not.
    Bearings,
    /// Where a detection is missing.
    Missed,
    /// Where there are several modes.
    #[serde(rename = "several modes")]
    SeveralModes,
}

impl Applies {
    /// The words for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Points => "points",
            Self::Conversions => "conversions",
            Self::Kalman => "kalman",
            Self::Linearised => "linearised",
            Self::CorrelatedNoises => "correlated noises",
            Self::ChangingSteps => "changing steps",
            Self::Covariances => "covariances",
            Self::FixedGains => "fixed gains",
            Self::EmbeddedMotion => "embedded motion",
            Self::UnequalDimensions => "unequal dimensions",
            Self::Angles => "angles",
            Self::StateAngles => "state angles",
            Self::StateConversions => "state conversions",
            Self::CommonStart => "common start",
            Self::Rates => "rates",
            Self::SojournTimes => "sojourn times",
            Self::Bearings => "bearings",
            Self::Missed => "missed",
            Self::SeveralModes => "several modes",
        }
    }

    /// Whether it can make a difference here, in any mode. Where it cannot, the variant leaves every value as it is.
    pub fn to<T: Real>(self, setup: &Setup<T>) -> bool {
        let problem = &setup.problem;
        match self {
            Self::All => true,
            Self::Points => !draws_no_points(setup),
            Self::Conversions => problem.conversion().is_some(),
            Self::Kalman => !draws_points(setup) && problem.has_covariances(),
            Self::Linearised => {
                let linearises = |filter: &Filter<T, Dyn, Dyn>| {
                    filter.predict == Transform::Linearised || filter.linearises_the_measurement()
                };
                problem.filters.iter().any(linearises)
            }
            Self::CorrelatedNoises => has_correlated_noises(setup),
            Self::ChangingSteps => !setup.changes.is_empty(),
            Self::Covariances => problem.has_covariances(),
            Self::FixedGains => !problem.has_covariances(),
            Self::EmbeddedMotion => problem
                .modes
                .iter()
                .any(|mode| zero_rows(&mode.motion.matrix()).next().is_some()),
            Self::UnequalDimensions => {
                let lacks = |entry: usize| problem.modes.iter().filter(move |mode| mode.lacks(entry)).count();
                (0..problem.n().0).any(|entry| (1..problem.modes.len()).contains(&lacks(entry)))
            }
            Self::Angles => {
                let has_angle =
                    |problem: &Problem<T, Dyn, Dyn>| (0..problem.m().0).any(|row| problem.sensor.is_angle(row));
                let converts = |filter: &Filter<T, Dyn, Dyn>| matches!(filter.update, Update::Converted(_));
                !problem.filters.iter().all(converts) && setup.problems().any(has_angle)
            }
            Self::StateAngles => {
                let of_modes = (0..problem.modes.len()).map(Reader::Mode);
                let mut readers = of_modes.chain([Reader::Common]);
                readers.any(|reader| !problem.angles_of(reader).is_empty())
            }
            Self::StateConversions => has_state_conversions(setup),
            Self::CommonStart => problem.interaction == Interaction::Gpb1,
            Self::Rates => !setup.rates.is_empty(),
            Self::SojournTimes => setup.rates.values().any(|chain| chain.sojourns.is_some()),
            Self::Bearings => {
                let is_bearing =
                    |sensor: &Sensor<T, Dyn, Dyn>, row| sensor.reports(row) == Some(PolarComponent::Bearing);
                setup
                    .problems()
                    .any(|problem| (0..problem.m().0).any(|row| is_bearing(&problem.sensor, row)))
            }
            Self::Missed => setup.measurements.iter().any(Option::is_none),
            Self::SeveralModes => problem.modes.len() > 1,
        }
    }
}
