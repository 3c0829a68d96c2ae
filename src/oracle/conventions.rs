//! The choices that the papers leave open, as a problem file says them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The choices that the papers leave open. The first four keys are always there; the others are where they make a difference.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Conventions {
    /// `cholesky-lower`.
    pub square_root: String,
    /// `centre-point`.
    pub angle_mean: String,
    /// `mixed`.
    pub first_step: String,
    /// `full`.
    pub log_likelihood: String,
    /// `embedded`; where a mode sets an entry of the state to zero that another has.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unequal_dimensions: Option<String>,
    /// `reference`; where an entry of the state is an angle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub state_angle_mean: Option<String>,
    /// `at-measurement`; where measurements are converted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub converted_covariance: Option<String>,
}

impl Conventions {
    /// Whether a convention has this value here.
    pub fn has(&self, key: &str, value: &str) -> bool {
        let own: &str = match key {
            "square_root" => &self.square_root,
            "angle_mean" => &self.angle_mean,
            "first_step" => &self.first_step,
            "log_likelihood" => &self.log_likelihood,
            "unequal_dimensions" => self.unequal_dimensions.as_deref().unwrap_or("embedded"),
            "state_angle_mean" => self.state_angle_mean.as_deref().unwrap_or("reference"),
            "converted_covariance" => self.converted_covariance.as_deref().unwrap_or("at-measurement"),
            _ => return false,
        };
        own == value
    }
}

impl Default for Conventions {
    fn default() -> Self {
        Self {
            square_root: "cholesky-lower".into(),
            angle_mean: "centre-point".into(),
            first_step: "mixed".into(),
            log_likelihood: "full".into(),
            unequal_dimensions: None,
            state_angle_mean: None,
            converted_covariance: None,
        }
    }
}
