//! The problem file: what a case gives to a filter, read, checked and put into any number system.
//!
//! After this file the reader knows the format `immaculate-problem/1` from the code's side (`spec/formats.md` is its description)
//! and how every defect of a file becomes one sentence with the place inside the file.

use super::invalid::{Class, Invalid};
use super::trace::Dimensions;
use super::{shape, unreadable};
use crate::imm::{InvalidProblem, Quantity};
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
    /// The kind's short name: `kalman`, `unscented`, the rule's, `fixed-gain` or, where no estimates are mixed, `fixed-gain-unmixed`.
    pub fn name(&self) -> &str {
        match self {
            Self::Kalman {} => "kalman",
            Self::Cubature { rule } => rule,
            Self::Unscented { .. } => "unscented",
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
            _ => quantity.equation(),
        }
    }

    /// Whether it carries covariances.
    pub fn keeps_covariances(&self) -> bool {
        !matches!(self, Self::FixedGain { .. })
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

/// The choices that the papers leave open; every key is always there.
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
}

impl Conventions {
    /// Whether a convention has this value here.
    pub fn has(&self, key: &str, value: &str) -> bool {
        let own = match key {
            "square_root" => &self.square_root,
            "angle_mean" => &self.angle_mean,
            "first_step" => &self.first_step,
            "log_likelihood" => &self.log_likelihood,
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

    /// Checks all that the filter relies on.
    ///
    /// # Errors
    ///
    /// [`Invalid`] with the place inside the file.
    pub fn check(&self) -> Result<(), Invalid> {
        if self.format != FORMAT {
            let reason = format!("is {:?}, but this program reads {FORMAT:?}", self.format);
            return Err(Invalid::new(Class::Format, "problem.format", reason));
        }
        self.check_conventions()?;
        self.check_shapes()?;
        self.check_filter()?;
        self.check_measurements()?;
        shape::dispatch(self.state.len(), self.noise.len(), TypedCheck(self))?
    }

    fn check_conventions(&self) -> Result<(), Invalid> {
        let given = &self.conventions;
        let pairs = [
            ("square_root", &given.square_root),
            ("angle_mean", &given.angle_mean),
            ("first_step", &given.first_step),
            ("log_likelihood", &given.log_likelihood),
        ];
        for (key, value) in pairs {
            if !Conventions::default().has(key, value) {
                let reason = format!("is {value:?}, which no problem of this format has");
                return Err(Invalid::new(
                    Class::Unknown,
                    format!("problem.conventions.{key}"),
                    reason,
                ));
            }
        }
        Ok(())
    }

    fn check_shapes(&self) -> Result<(), Invalid> {
        let Dimensions { n, m, r, .. } = self.dimensions();
        check_length("problem.units", self.units.len(), n)?;
        check_matrix("problem.R", &self.noise, m, m)?;
        if r == 0 {
            return Err(Invalid::new(
                Class::Shape,
                "problem.modes",
                "is empty; the filter needs at least one",
            ));
        }
        for (j, mode) in self.modes.iter().enumerate() {
            check_matrix(&format!("problem.modes[{j}].F"), &mode.transition, n, n)?;
            check_matrix(&format!("problem.modes[{j}].Q"), &mode.noise, n, n)?;
        }
        match &self.measurement {
            MeasurementFile::Linear { matrix } => check_matrix("problem.measurement.H", matrix, m, n)?,
            MeasurementFile::RangeBearing { components, .. } => {
                check_length("problem.measurement.components", components.len(), m)?;
            }
        }
        check_matrix("problem.transition", &self.transition, r, r)?;
        check_length("problem.initial.modes", self.initial.modes.len(), r)?;
        check_length(
            "problem.initial.mode_probabilities",
            self.initial.mode_probabilities.len(),
            r,
        )?;
        for (j, estimate) in self.initial.modes.iter().enumerate() {
            check_length(&format!("problem.initial.modes[{j}].mean"), estimate.mean.len(), n)?;
            let field = format!("problem.initial.modes[{j}].covariance");
            match &estimate.covariance {
                Some(rows) if self.filter.keeps_covariances() => check_matrix(&field, rows, n, n)?,
                Some(_) => {
                    let reason = "is given, but filters with fixed gains have no covariance";
                    return Err(Invalid::new(Class::Format, field, reason));
                }
                None if self.filter.keeps_covariances() => {
                    return Err(Invalid::new(Class::Format, field, "is missing"));
                }
                None => {}
            }
        }
        Ok(())
    }

    fn check_filter(&self) -> Result<(), Invalid> {
        match &self.filter {
            FilterFile::Cubature { rule } if !RULES.contains(&rule.as_str()) => {
                let reason = format!("is {rule:?}; known are {}", RULES.join(", "));
                Err(Invalid::new(Class::Unknown, "problem.filter.rule", reason))
            }
            FilterFile::Kalman {} | FilterFile::FixedGain { .. }
                if !matches!(self.measurement, MeasurementFile::Linear { .. }) =>
            {
                let name = self.filter.name();
                let reason = format!("is {name}, which has no range and bearing; use a filter with points");
                Err(Invalid::new(Class::Unknown, "problem.filter.kind", reason))
            }
            FilterFile::FixedGain { mixing, modes } => self.check_fixed_gains(mixing, modes),
            FilterFile::Kalman {} | FilterFile::Cubature { .. } | FilterFile::Unscented { .. } => Ok(()),
        }
    }

    fn check_fixed_gains(&self, mixing: &str, modes: &[FixedGainFile]) -> Result<(), Invalid> {
        let Dimensions { n, m, r, .. } = self.dimensions();
        if !MIXINGS.contains(&mixing) {
            let reason = format!("is {mixing:?}; known are {}", MIXINGS.join(", "));
            return Err(Invalid::new(Class::Unknown, "problem.filter.mixing", reason));
        }
        check_length("problem.filter.modes", modes.len(), r)?;
        for (j, mode) in modes.iter().enumerate() {
            check_matrix(&format!("problem.filter.modes[{j}].gain"), &mode.gain, n, m)?;
            let field = format!("problem.filter.modes[{j}].innovation_covariance");
            check_matrix(&field, &mode.innovation_covariance, m, m)?;
        }
        Ok(())
    }

    fn check_measurements(&self) -> Result<(), Invalid> {
        let m = self.noise.len();
        for (place, entry) in self.measurements.iter().enumerate() {
            if entry.step != place + 1 {
                let field = format!("problem.measurements[{place}].step");
                let reason = format!(
                    "is {}, but steps count 1, 2, 3 without a gap: {}",
                    entry.step,
                    place + 1
                );
                return Err(Invalid::new(Class::Shape, field, reason));
            }
            let Some(z) = &entry.z else { continue };
            let field = format!("problem.measurements[{place}].z");
            check_length(&field, z.len(), m)?;
            for (row, value) in z.iter().enumerate() {
                if !value.is_finite() {
                    return Err(Invalid::new(
                        Class::NotFinite,
                        format!("{field}[{row}]"),
                        "is not finite",
                    ));
                }
                if self.is_bearing(row) && value.abs() > 2.0 * std::f64::consts::PI {
                    let reason = format!("is {value}, a bearing outside ±2π: is it in degrees?");
                    return Err(Invalid::new(Class::Angle, format!("{field}[{row}]"), reason));
                }
            }
        }
        Ok(())
    }

    /// Whether an entry of the measurement is an angle.
    pub fn is_bearing(&self, row: usize) -> bool {
        match &self.measurement {
            MeasurementFile::Linear { .. } => false,
            MeasurementFile::RangeBearing { components, .. } => {
                components.get(row).is_some_and(|component| component == "bearing")
            }
        }
    }
}

/// Puts a problem into doubles and lets the cycle check it.
struct TypedCheck<'a>(&'a ProblemFile);

impl shape::Work for TypedCheck<'_> {
    type Output = Result<(), Invalid>;

    fn run<const N: usize, const M: usize>(self) -> Self::Output {
        let setup = self.0.setup_in_doubles::<N, M>()?;
        setup.problem.check(&setup.initial).map_err(|error| of_problem(&error))
    }
}

/// The class and the place of what the cycle refuses.
fn of_problem(error: &InvalidProblem) -> Invalid {
    let class = match error {
        InvalidProblem::Length { .. }
        | InvalidProblem::NoModes
        | InvalidProblem::RuleLengths { .. }
        | InvalidProblem::Position { .. } => Class::Shape,
        InvalidProblem::NotFinite { .. } => Class::NotFinite,
        InvalidProblem::NegativeProbability { .. } | InvalidProblem::NotNormalised { .. } => Class::NotAProbability,
        InvalidProblem::NotSymmetric { .. } => Class::NotSymmetric,
        InvalidProblem::NotPositive { .. } => Class::NotPositiveDefinite,
        InvalidProblem::NotLinear | InvalidProblem::Rule { .. } | InvalidProblem::FixedGains { .. } => Class::Unknown,
        InvalidProblem::CovarianceGiven { .. } => Class::Format,
    };
    // The sentence starts with the field in backquotes.
    let sentence = error.to_string();
    match sentence.strip_prefix('`').and_then(|rest| rest.split_once('`')) {
        Some((field, rest)) => Invalid::new(class, format!("problem.{field}"), rest.trim_start()),
        None => Invalid::new(class, "problem", sentence),
    }
}

fn check_length(field: &str, found: usize, expected: usize) -> Result<(), Invalid> {
    if found == expected {
        return Ok(());
    }
    let reason = format!("has {found} entries where {expected} are needed");
    Err(Invalid::new(Class::Shape, field, reason))
}

fn check_matrix(field: &str, rows: &Rows, height: usize, width: usize) -> Result<(), Invalid> {
    check_length(field, rows.len(), height)?;
    for (place, row) in rows.iter().enumerate() {
        check_length(&format!("{field}[{place}]"), row.len(), width)?;
    }
    Ok(())
}
