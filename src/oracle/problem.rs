//! The problem file: the inputs of a filter, read, checked and converted to any number system.
//!
//! The formats `immaculate-problem/1` and `/2` are described in `spec/formats.md`. Format 1 is format 2 without the additions of
//! [`super::models`]. `well_formed` checks the conditions that a file must meet.

use super::chain::CONTINUOUS_CHAIN;
pub use super::conventions::Conventions;
use super::filter_file::{CORRELATED_NOISE, STATE_CONVERSION};
pub use super::filter_file::{FAMILIES, FilterFile, FixedGainFile, InteractionFile, MIXINGS, RULES, UNMIXED, kinds};
use super::invalid::{Class, Invalid};
use super::models::{ComponentFile, ModeKeys, ModeModels, ModelParameters};
use super::single;
use super::state_conversions::StateConversionFile;
pub use super::steps::MeasurementAt;
use super::trace::Dimensions;
use super::unreadable;
use crate::imm::{Needs, Quantity};
use crate::model::space::ComponentKind;
use schemars::JsonSchema;
use serde::de::IgnoredAny;
use serde::{Deserialize, Deserializer, Serialize};

/// The format of the published problems: motions and measurements are matrices, or range and bearing.
pub const FORMAT: &str = "immaculate-problem/1";

/// The format in which they may be formulas and named models, too, and may change from step to step.
pub const FORMAT_2: &str = "immaculate-problem/2";

/// A matrix as a list of rows.
pub type Rows = Vec<Vec<f64>>;

/// A problem file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProblemFile {
    /// `immaculate-problem/1` or `immaculate-problem/2`.
    pub format: String,
    /// The name of the case; never changed and never used again.
    pub id: String,
    /// What the case is for.
    #[serde(default)]
    pub about: String,
    /// What the case is for, in words of the list that `immaculate cases list` knows.
    #[serde(default)]
    pub flags: Vec<String>,
    /// The names of the n entries of the state; in format 2 perhaps with their units.
    pub state: Vec<ComponentFile>,
    /// Their units.
    #[serde(default)]
    pub units: Vec<String>,
    /// Names with numbers, known in all formulas; `T` is the length of a step. Format 2.
    #[serde(default, skip_serializing_if = "ModelParameters::is_empty")]
    pub parameters: ModelParameters,
    /// Names for formulas: each a name and a formula of what stands before it, known in all formulas. Format 2.
    #[serde(default, rename = "let", skip_serializing_if = "Vec::is_empty")]
    pub definitions: Vec<[String; 2]>,
    /// The modes, at least one.
    #[schemars(with = "Vec<ModeKeys>")]
    pub modes: Vec<ModeFile>,
    /// How the modes read each other's estimates, where their states differ. Format 2.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub conversions: Vec<StateConversionFile>,
    /// What the sensor sees.
    pub measurement: MeasurementFile,
    /// Covariance of the measurement's noise, m × m.
    #[serde(rename = "R")]
    pub noise: Rows,
    /// Further sensors; a step that names none is seen by `measurement`. Format 2.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sensors: Vec<SensorFile>,
    /// The filter of every mode that has none of its own.
    pub filter: FilterFile,
    /// Which estimates the filters start from: `imm`, `gpb1` or `unmixed`; absent, `imm`. Format 2.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "InteractionFile")]
    pub interaction: Option<InteractionFile>,
    /// `transition[i][j]` = P(mode j at k ∣ mode i at k−1); empty where the chain is given otherwise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub transition: Rows,
    /// `rates[i][j]`, the rate from mode i to mode j in a unit of time, in place of `transition`; rows sum to zero. Format 2.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "Rows")]
    pub rates: Option<Rows>,
    /// How long each mode lasts on average, in place of `transition`. Format 2.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "Vec<f64>")]
    pub sojourn_times: Option<Vec<f64>>,
    /// `jumps[i][j]` = P(mode j is next ∣ mode i is left), with `sojourn_times`. Format 2.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "Rows")]
    pub jumps: Option<Rows>,
    /// The estimate at step 0, a posterior.
    pub initial: InitialFile,
    /// The choices that the papers leave open.
    #[serde(default)]
    pub conventions: Conventions,
    /// One entry a step: 1, 2, 3, …
    pub measurements: Vec<MeasurementAt>,
    /// Conventions that are not the papers', by the ids of their variants. They are no key of the file; the program under test declares
    /// them.
    #[serde(skip)]
    pub declared: Vec<&'static str>,
    /// Whether it has no values that need [`Needs::Consistency`]: a case that was published before there were any. No key of the file.
    #[serde(skip)]
    pub lacks_consistency: bool,
}

/// A mode.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "ModeKeys", into = "ModeKeys")]
pub struct ModeFile {
    /// Its name.
    pub name: String,
    /// Transition matrix, n × n; empty where the motion is given otherwise.
    pub transition: Rows,
    /// Covariance of the process noise, n × n; empty where it is given otherwise.
    pub noise: Rows,
    /// What format 2 adds.
    pub models: ModeModels,
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
    /// Formulas of the state. Format 2.
    Formulas {
        /// What each entry of z is.
        z: Vec<ComponentFile>,
        /// One formula an entry of z.
        h: Vec<String>,
    },
    /// A named model. Format 2.
    Model {
        /// Its name.
        model: String,
        /// Its parameters.
        #[serde(default, skip_serializing_if = "ModelParameters::is_empty")]
        parameters: ModelParameters,
    },
}

/// A further sensor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SensorFile {
    /// Its name.
    pub name: String,
    /// What it sees.
    pub measurement: MeasurementFile,
    /// Covariance of its noise; it may have another dimension than the others.
    #[serde(rename = "R")]
    pub noise: Rows,
}

/// A sensor of a problem, with its place in the file.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorAt<'a> {
    /// What it sees.
    pub measurement: &'a MeasurementFile,
    /// R.
    pub noise: &'a Rows,
    /// Where both stand: `problem` or `problem.sensors[0]`.
    pub place: String,
}

impl MeasurementFile {
    /// Whether it is given by formulas or by a model.
    pub(super) fn is_function(&self) -> bool {
        matches!(self, Self::Formulas { .. } | Self::Model { .. })
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
pub(super) fn if_there_at_all<'de, D: Deserializer<'de>, V: Deserialize<'de>>(
    deserializer: D,
) -> Result<Option<V>, D::Error> {
    V::deserialize(deserializer).map(Some)
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
    /// assert_eq!((problem.state.len(), problem.noise.len()), (4, 2));
    /// // What is wrong with a file is said in a sentence with the place.
    /// let spoilt = case.problem_text.replacen("\"transition\"", "\"transitions\"", 1);
    /// assert!(ProblemFile::read(&spoilt).unwrap_err().to_string().contains("transitions"));
    /// ```
    ///
    /// # Errors
    ///
    /// [`Invalid`] with the place inside the file.
    pub fn read(text: &str) -> Result<Self, Invalid> {
        let read = || {
            let problem = Self::parse(text)?;
            problem.check()?;
            Ok(problem)
        };
        match single::long_form(text) {
            None => read(),
            Some(_) => read().map_err(single::of_short_form),
        }
    }

    /// Reads a problem whose contents may be wrong; only the JSON and the keys must be right.
    ///
    /// # Errors
    ///
    /// [`Invalid`] with the place inside the file.
    pub fn parse(text: &str) -> Result<Self, Invalid> {
        if let Some(file) = single::long_form(text) {
            let long = file.to_string();
            return serde_path_to_error::deserialize(file)
                .map_err(|error| unreadable::reason(&long, &error.path().to_string(), &error.inner().to_string()));
        }
        let mut deserializer = serde_json::Deserializer::from_str(text);
        let problem: Self = serde_path_to_error::deserialize(&mut deserializer)
            .map_err(|error| unreadable::reason(text, &error.path().to_string(), &error.inner().to_string()))?;
        deserializer
            .end()
            .map_err(|error| Invalid::new(Class::Format, "problem", error.to_string()))?;
        if problem.format == FORMAT {
            check_keys(text)?;
        }
        Ok(problem)
    }

    /// The filter of a mode.
    pub fn filter_of(&self, mode: usize) -> &FilterFile {
        let own = self.modes.get(mode).and_then(|mode| mode.models.filter.as_ref());
        own.unwrap_or(&self.filter)
    }

    /// The filters of the modes by [`FilterFile::name`], each once, and what they must take beside that.
    pub fn kinds(&self) -> Vec<&str> {
        let mut kinds = Vec::new();
        for mode in 0..self.modes.len() {
            let name = self.filter_of(mode).name();
            if !kinds.contains(&name) {
                kinds.push(name);
            }
        }
        if self.has_correlated_noises() {
            kinds.push(CORRELATED_NOISE);
        }
        if !self.conversions.is_empty() {
            kinds.push(STATE_CONVERSION);
        }
        if self.has_rates() {
            kinds.push(CONTINUOUS_CHAIN);
        }
        if self.interaction() != InteractionFile::Imm {
            kinds.push(self.interaction().name());
        }
        kinds
    }

    /// Which estimates the filters start from. Of fixed gains their own key says it.
    pub fn interaction(&self) -> InteractionFile {
        self.interaction.unwrap_or(InteractionFile::Imm)
    }

    /// The printed equations that give a quantity in a mode.
    pub fn equation(&self, quantity: Quantity, mode: usize) -> &'static str {
        self.interaction().equation(self.filter_of(mode), quantity)
    }

    /// Whether the noises of a mode and of the sensor have something in common.
    pub(super) fn has_correlated_noises(&self) -> bool {
        let mut modes = self.modes.iter();
        modes.any(|mode| mode.models.noise_cross_covariance.is_some())
    }

    /// Whether what a value needs is there in a mode, apart from a detection.
    pub fn has(&self, needed: Needs, mode: usize) -> bool {
        match needed {
            // A converted measurement belongs to all modes together.
            Needs::Conversion => (0..self.modes.len()).any(|mode| self.filter_of(mode).has(needed)),
            Needs::Consistency => !self.lacks_consistency,
            Needs::Truth => self.measurements.iter().any(|entry| entry.truth.is_some()),
            _ => self.filter_of(mode).has(needed),
        }
    }

    /// Entries of the state, of the measurement, modes, and steps.
    pub fn dimensions(&self) -> Dimensions {
        let sensors = self.sensors_at();
        let of_step = |entry: &MeasurementAt| match entry.rows() {
            Some(rows) => rows.len(),
            None => sensors[self.sensor_of(entry).unwrap_or(0)].noise.len(),
        };
        Dimensions {
            n: self.state.len(),
            r: self.modes.len(),
            m: self.measurements.iter().map(of_step).collect(),
        }
    }

    /// All sensors: that of `measurement` first.
    pub fn sensors_at(&self) -> Vec<SensorAt<'_>> {
        let of_problem = SensorAt {
            measurement: &self.measurement,
            noise: &self.noise,
            place: "problem".to_owned(),
        };
        let mut sensors = vec![of_problem];
        for (index, sensor) in self.sensors.iter().enumerate() {
            sensors.push(SensorAt {
                measurement: &sensor.measurement,
                noise: &sensor.noise,
                place: format!("problem.sensors[{index}]"),
            });
        }
        sensors
    }

    /// Which of the sensors sees in a step; `None` if none has the name.
    pub fn sensor_of(&self, entry: &MeasurementAt) -> Option<usize> {
        let Some(name) = &entry.sensor else { return Some(0) };
        let index = self.sensors.iter().position(|sensor| sensor.name == *name)?;
        Some(index + 1)
    }

    /// Which entries of a sensor's measurement are distances; of formulas nobody knows.
    pub(super) fn ranges_of(&self, sensor: &SensorAt) -> Vec<bool> {
        match sensor.measurement {
            MeasurementFile::RangeBearing { components, .. } => {
                components.iter().map(|component| component == "range").collect()
            }
            MeasurementFile::Model { .. } => self.measured_space(sensor).map_or_else(
                |_| Vec::new(),
                |space| space.names().into_iter().map(|name| name == "range").collect(),
            ),
            MeasurementFile::Linear { .. } | MeasurementFile::Formulas { .. } => Vec::new(),
        }
    }

    /// Which entries of a sensor's measurement are angles.
    pub fn angles_of(&self, sensor: &SensorAt) -> Vec<bool> {
        match sensor.measurement {
            MeasurementFile::Linear { matrix } => vec![false; matrix.len()],
            MeasurementFile::RangeBearing { components, .. } => {
                components.iter().map(|component| component == "bearing").collect()
            }
            MeasurementFile::Formulas { z, .. } => z
                .iter()
                .map(|component| component.kind == ComponentKind::Angle)
                .collect(),
            MeasurementFile::Model { .. } => self.measured_space(sensor).map_or_else(
                |_| Vec::new(),
                |space| (0..space.dimension()).map(|entry| space.is_angle(entry)).collect(),
            ),
        }
    }
}

/// The keys that may be absent in format 2.
#[derive(Deserialize)]
struct Keys {
    about: Option<IgnoredAny>,
    flags: Option<IgnoredAny>,
    units: Option<IgnoredAny>,
    conventions: Option<IgnoredAny>,
}

/// In format 1 every key is there.
fn check_keys(text: &str) -> Result<(), Invalid> {
    let Ok(keys) = serde_json::from_str::<Keys>(text) else {
        return Ok(());
    };
    let all = [
        ("about", keys.about),
        ("flags", keys.flags),
        ("units", keys.units),
        ("conventions", keys.conventions),
    ];
    let missing: Vec<&str> = all
        .into_iter()
        .filter(|(_, value)| value.is_none())
        .map(|(key, _)| key)
        .collect();
    match missing[..] {
        [] => Ok(()),
        [key] => Err(Invalid::new(Class::Format, format!("problem.{key}"), "is missing")),
        _ => {
            let reason = format!("lacks the keys `{}`", missing.join("`, `"));
            Err(Invalid::new(Class::Format, "problem", reason))
        }
    }
}
