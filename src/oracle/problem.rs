//! The problem file: what a case gives to a filter, read, checked and put into any number system.
//!
//! After this file the reader knows the format `immaculate-problem/1` from the code's side (`spec/formats.md` is its description). What
//! must be true of a file is in `well_formed`.

use super::invalid::{Class, Invalid};
use super::trace::Dimensions;
use super::unreadable;
use crate::imm::{Needs, Quantity};
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

/// The format of problem files.
pub const FORMAT: &str = "immaculate-problem/1";

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

/// A matrix as a list of rows.
pub type Rows = Vec<Vec<f64>>;

/// A problem file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProblemFile {
    /// `immaculate-problem/1`.
    pub format: String,
    /// The name of the case; never changed and never used again.
    pub id: String,
    /// What the case is for.
    pub about: String,
    /// What the case is for, in words of the list that `immaculate cases list` knows.
    pub flags: Vec<String>,
    /// The names of the n entries of the state.
    pub state: Vec<String>,
    /// Their units.
    pub units: Vec<String>,
    /// The modes, at least one.
    pub modes: Vec<ModeFile>,
    /// What the sensor sees.
    pub measurement: MeasurementFile,
    /// Covariance of the measurement's noise, m × m.
    #[serde(rename = "R")]
    pub noise: Rows,
    /// The filter.
    pub filter: FilterFile,
    /// `transition[i][j]` = P(mode j at k ∣ mode i at k−1).
    pub transition: Rows,
    /// The estimate at step 0, a posterior.
    pub initial: InitialFile,
    /// The choices that the papers leave open.
    pub conventions: Conventions,
    /// One entry a step: 1, 2, 3, …
    pub measurements: Vec<MeasurementAt>,
}

/// A mode.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModeFile {
    /// Its name.
    pub name: String,
    /// Transition matrix, n × n.
    #[serde(rename = "F")]
    pub transition: Rows,
    /// Covariance of the process noise, n × n.
    #[serde(rename = "Q")]
    pub noise: Rows,
}

/// What the sensor sees.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum MeasurementFile {
    /// z = H x + v.
    Linear {
        /// m × n.
        #[serde(rename = "H")]
        matrix: Rows,
    },
    /// Distance and direction from a sensor.
    RangeBearing {
        /// What each entry of z is: `range` or `bearing`.
        components: Vec<String>,
        /// Which entries of the state are x and y, counted from 0.
        position: [usize; 2],
        /// Where the sensor stands.
        sensor: [f64; 2],
    },
}

/// The filter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum FilterFile {
    /// Linear motion and measurement.
    Kalman {},
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
    /// The kind's short name: `kalman`, `unscented`, the rule's, `converted`, `fixed-gain` or, where no estimates are mixed,
    /// `fixed-gain-unmixed`.
    pub fn name(&self) -> &str {
        match self {
            Self::Kalman {} => "kalman",
            Self::Cubature { rule } => rule,
            Self::Unscented { .. } => "unscented",
            Self::Converted { .. } => "converted",
            Self::FixedGain { mixing, .. } if mixing == UNMIXED => "fixed-gain-unmixed",
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
            _ => quantity.equation(),
        }
    }

    /// Whether what a value needs is there in filters of this kind, apart from a detection.
    pub fn has(&self, needed: Needs) -> bool {
        match needed {
            Needs::Covariances => !matches!(self, Self::FixedGain { .. }),
            Needs::Conversion => matches!(self, Self::Converted { .. }),
            Needs::Detection => true,
        }
    }
}

/// The estimate at step 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InitialFile {
    /// One a mode.
    pub mode_probabilities: Vec<f64>,
    /// One a mode.
    pub modes: Vec<EstimateFile>,
}

/// Mean and covariance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EstimateFile {
    /// n numbers.
    pub mean: Vec<f64>,
    /// n × n; absent where the filter has fixed gains.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "Rows")]
    pub covariance: Option<Rows>,
}

/// A value that may be absent but, if its key is there, is not null.
fn if_there_at_all<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Rows>, D::Error> {
    Rows::deserialize(deserializer).map(Some)
}

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
            converted_covariance: None,
        }
    }
}

/// The measurement of a step; `null` is a missed detection.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeasurementAt {
    /// The step, counted from 1.
    pub step: usize,
    /// m numbers, or null.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(required)]
    pub z: Option<Vec<f64>>,
}

impl ProblemFile {
    /// Reads a problem from JSON and checks it.
    ///
    /// Example: a published problem, and the same with a key misspelt.
    ///
    /// ```
    /// use immaculate::oracle::{case, problem::ProblemFile};
    ///
    /// let case = case::all().unwrap().iter().find(|case| case.problem.id == "step.n4-m2.two-modes").unwrap();
    /// let problem = ProblemFile::read(&case.problem_text).unwrap();
    /// assert_eq!((problem.dimensions().n, problem.dimensions().m), (4, 2));
    /// // What is wrong with a file is said in a sentence with the place.
    /// let spoilt = case.problem_text.replacen("\"transition\"", "\"transitions\"", 1);
    /// assert!(ProblemFile::read(&spoilt).unwrap_err().to_string().contains("transitions"));
    /// ```
    ///
    /// # Errors
    ///
    /// [`Invalid`] with the place inside the file.
    pub fn read(text: &str) -> Result<Self, Invalid> {
        let problem = Self::parse(text)?;
        problem.check()?;
        Ok(problem)
    }

    /// Reads a problem whose contents may be wrong; only the JSON and the keys must be right.
    ///
    /// # Errors
    ///
    /// [`Invalid`] with the place inside the file.
    pub fn parse(text: &str) -> Result<Self, Invalid> {
        let mut deserializer = serde_json::Deserializer::from_str(text);
        let problem: Self = serde_path_to_error::deserialize(&mut deserializer)
            .map_err(|error| unreadable::reason(text, &error.path().to_string(), &error.inner().to_string()))?;
        deserializer
            .end()
            .map_err(|error| Invalid::new(Class::Format, "problem", error.to_string()))?;
        Ok(problem)
    }

    /// Entries of the state, of the measurement, modes, and steps.
    pub fn dimensions(&self) -> Dimensions {
        Dimensions {
            n: self.state.len(),
            m: self.noise.len(),
            r: self.modes.len(),
            steps: self.measurements.len(),
        }
    }

    /// Whether an entry of the measurement is an angle.
    pub fn is_bearing(&self, row: usize) -> bool {
        self.is_component(row, "bearing")
    }

    /// Whether an entry of the measurement is a distance.
    pub fn is_range(&self, row: usize) -> bool {
        self.is_component(row, "range")
    }

    fn is_component(&self, row: usize, name: &str) -> bool {
        match &self.measurement {
            MeasurementFile::Linear { .. } => false,
            MeasurementFile::RangeBearing { components, .. } => {
                components.get(row).is_some_and(|component| component == name)
            }
        }
    }
}
