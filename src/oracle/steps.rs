//! The checks of format 2's additions to a problem: its functions, and changes from step to step.
//!
//! A file of format 1 that needs format 2 is refused here, as is a step that replaces something that it may not.

use super::invalid::{Class, Invalid};
use super::problem::{
    FORMAT, FORMAT_2, FilterFile, MeasurementFile, ModeFile, ProblemFile, Rows, SensorAt, if_there_at_all,
};
use super::well_formed::{check_length, check_matrix};
use crate::imm::Needs;
use crate::model::binding::STEP;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The measurement of a step; `null` is a missed detection. What format 2 adds replaces the problem's for this step.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeasurementAt {
    /// The step, counted from 1.
    pub step: usize,
    /// m numbers, or null. In format 2 an entry may be null, too: it is missing.
    #[serde(deserialize_with = "Option::deserialize")]
    #[schemars(required)]
    pub z: Option<Vec<Option<f64>>>,
    /// The name of the sensor that sees in this step. Format 2.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "String")]
    pub sensor: Option<String>,
    /// The length of the step, T in formulas. Format 2.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all",
        rename = "T"
    )]
    #[schemars(with = "f64")]
    pub interval: Option<f64>,
    /// F of each mode. Format 2.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all",
        rename = "F"
    )]
    #[schemars(with = "Vec<Rows>")]
    pub transitions: Option<Vec<Rows>>,
    /// Q of each mode. Format 2.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all",
        rename = "Q"
    )]
    #[schemars(with = "Vec<Rows>")]
    pub noises: Option<Vec<Rows>>,
    /// H of a linear measurement. Format 2.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all",
        rename = "H"
    )]
    #[schemars(with = "Rows")]
    pub matrix: Option<Rows>,
    /// Covariance of the measurement's noise. Format 2.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all",
        rename = "R"
    )]
    #[schemars(with = "Rows")]
    pub noise: Option<Rows>,
    /// The Markov chain from the step before to this one. Format 2.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "Rows")]
    pub transition: Option<Rows>,
    /// The true state, as a simulation knows it: what nees is of. Format 2.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "Vec<f64>")]
    pub truth: Option<Vec<f64>>,
}

impl MeasurementAt {
    /// The entries of z that are there, with their places; none at a missed detection.
    pub fn entries(&self) -> impl Iterator<Item = (usize, f64)> {
        let all = self.z.iter().flatten().enumerate();
        all.filter_map(|(row, entry)| Some((row, (*entry)?)))
    }

    /// The places of the entries that are there, where some are missing.
    pub(super) fn rows(&self) -> Option<Vec<usize>> {
        let is_partial = self.z.iter().flatten().any(Option::is_none);
        is_partial.then(|| self.entries().map(|(row, _)| row).collect())
    }

    /// Whether anything is another in this step than in the problem.
    pub(super) fn has_changes(&self) -> bool {
        self.first_change().is_some()
    }

    /// The first key that changes something.
    pub(super) fn first_change(&self) -> Option<&'static str> {
        let keys = [
            ("z", self.rows().is_some()),
            ("sensor", self.sensor.is_some()),
            ("T", self.interval.is_some()),
            ("F", self.transitions.is_some()),
            ("Q", self.noises.is_some()),
            ("H", self.matrix.is_some()),
            ("R", self.noise.is_some()),
            ("transition", self.transition.is_some()),
        ];
        keys.into_iter().find(|(_, is_there)| *is_there).map(|(key, _)| key)
    }

    /// The first key that format 1 has not.
    fn first_new_key(&self) -> Option<&'static str> {
        self.first_change().or(self.truth.as_ref().map(|_| "truth"))
    }
}

impl ProblemFile {
    /// A problem of format 1 has nothing of format 2.
    pub(super) fn check_new_keys(&self) -> Result<(), Invalid> {
        if self.format != FORMAT {
            return Ok(());
        }
        match self.first_new_key() {
            None => Ok(()),
            Some(place) => {
                let reason = format!("needs the format {FORMAT_2:?}, and this file says {FORMAT:?}");
                Err(Invalid::new(Class::Format, place, reason))
            }
        }
    }

    /// Where the first key stands that format 1 has not.
    fn first_new_key(&self) -> Option<String> {
        if let Some(index) = self.state.iter().position(|component| component.unit.is_some()) {
            return Some(format!("problem.state[{index}]"));
        }
        let of_problem = [
            ("parameters", !self.parameters.is_empty()),
            ("let", !self.definitions.is_empty()),
            ("conversions", !self.conversions.is_empty()),
            ("interaction", self.interaction.is_some()),
            ("rates", self.rates.is_some()),
            ("sojourn_times", self.sojourn_times.is_some()),
            ("jumps", self.jumps.is_some()),
        ];
        if let Some((key, _)) = of_problem.into_iter().find(|(_, is_there)| *is_there) {
            return Some(format!("problem.{key}"));
        }
        for (j, mode) in self.modes.iter().enumerate() {
            if let Some(key) = new_key_of_mode(mode) {
                return Some(format!("problem.modes[{j}].{key}"));
            }
        }
        if self.measurement.is_function() {
            return Some("problem.measurement.kind".to_owned());
        }
        if !self.sensors.is_empty() {
            return Some("problem.sensors".to_owned());
        }
        if matches!(self.filter, FilterFile::Extended { .. }) {
            return Some("problem.filter.kind".to_owned());
        }
        let mut steps = self.measurements.iter().enumerate();
        steps.find_map(|(k, entry)| Some(format!("problem.measurements[{k}].{}", entry.first_new_key()?)))
    }

    /// The functions can be read, fit each other, and know how long a step is.
    pub(super) fn check_functions(&self) -> Result<(), Invalid> {
        let has_own_units = self.state.iter().any(|component| component.unit.is_some());
        if has_own_units && !self.units.is_empty() {
            let reason = "is given, and the state has units, too; they are said once";
            return Err(Invalid::new(Class::Format, "problem.units", reason));
        }
        let functions = self.functions()?;
        for (sensor, function) in self.sensors_at().iter().zip(&functions.sensors) {
            let (rows, Some((_, space))) = (sensor.noise.len(), function) else {
                continue;
            };
            if space.dimension() != rows {
                let reason = format!(
                    "has {rows} rows, and the measurement gives {}: {}",
                    space.dimension(),
                    space.names().join(", ")
                );
                return Err(Invalid::new(Class::Shape, format!("{}.R", sensor.place), reason));
            }
        }
        self.check_intervals()?;
        let of_modes = functions.modes.iter().flatten().flatten();
        let of_sensors = functions.sensors.iter().flatten().map(|(bound, _)| bound);
        let of_conversions = functions.conversions.iter().flatten();
        for bound in of_modes
            .chain(of_sensors)
            .chain(of_conversions)
            .filter(|bound| bound.needs_interval())
        {
            if let Some(k) = (0..self.measurements.len()).find(|&k| self.interval(k).is_none()) {
                let reason = format!("is missing: {} needs the length of every step", bound.place());
                return Err(Invalid::new(
                    Class::Format,
                    format!("problem.measurements[{k}].T"),
                    reason,
                ));
            }
        }
        let n = self.state.len();
        for bound in functions.modes.iter().filter_map(|[_, noise]| noise.as_ref()) {
            for k in 0..self.measurements.len() {
                if k == 0 || self.interval(k) != self.interval(k - 1) {
                    bound.check_noise(n, self.interval(k))?;
                }
            }
        }
        Ok(())
    }

    /// No step is shorter than nothing. Two sensors may see at the same time.
    fn check_intervals(&self) -> Result<(), Invalid> {
        let of_steps = self.measurements.iter().enumerate();
        let of_steps = of_steps.map(|(k, entry)| (format!("problem.measurements[{k}].T"), entry.interval));
        let of_problem = ("problem.parameters.T".to_owned(), self.parameters.get(STEP));
        for (place, interval) in of_steps.chain([of_problem]) {
            if let Some(interval) = interval.filter(|interval| *interval < 0.0) {
                let reason = format!("is {interval}; no step is shorter than 0");
                return Err(Invalid::new(Class::Range, place, reason));
            }
        }
        Ok(())
    }

    /// A true state has the entries of the state, and something is there to be compared with it.
    pub(super) fn check_truth(&self, k: usize, entry: &MeasurementAt) -> Result<(), Invalid> {
        let Some(truth) = &entry.truth else { return Ok(()) };
        let place = format!("problem.measurements[{k}].truth");
        if !self.filter.has(Needs::Covariances) {
            let reason =
                "is given, but filters with fixed gains have no covariance by which an error is large or small";
            return Err(Invalid::new(Class::Format, place, reason));
        }
        check_length(&place, truth.len(), self.state.len())?;
        match truth.iter().position(|value| !value.is_finite()) {
            Some(i) => Err(Invalid::new(Class::NotFinite, format!("{place}[{i}]"), "is not finite")),
            None => Ok(()),
        }
    }

    /// What a step replaces has the right shape.
    pub(super) fn check_changes(&self, k: usize, entry: &MeasurementAt, sensor: &SensorAt) -> Result<(), Invalid> {
        let (n, m, r) = (self.state.len(), sensor.noise.len(), self.modes.len());
        let place = |key: &str| format!("problem.measurements[{k}].{key}");
        let lists: [(&str, &Option<Vec<Rows>>); 2] = [("F", &entry.transitions), ("Q", &entry.noises)];
        for (key, list) in lists {
            let Some(list) = list else { continue };
            check_length(&place(key), list.len(), r)?;
            for (j, rows) in list.iter().enumerate() {
                check_matrix(&format!("{}[{j}]", place(key)), rows, n, n)?;
            }
        }
        if let Some(rows) = &entry.matrix {
            if !matches!(sensor.measurement, MeasurementFile::Linear { .. }) {
                let reason = "replaces the matrix of a linear measurement, and this measurement is none";
                return Err(Invalid::new(Class::Format, place("H"), reason));
            }
            check_matrix(&place("H"), rows, m, n)?;
        }
        if let Some(rows) = &entry.noise {
            check_matrix(&place("R"), rows, m, m)?;
        }
        if let Some(rows) = &entry.transition {
            check_matrix(&place("transition"), rows, r, r)?;
        }
        Ok(())
    }
}

/// The first key of a mode that format 1 has not.
fn new_key_of_mode(mode: &ModeFile) -> Option<&'static str> {
    let models = &mode.models;
    let keys = [
        ("state", models.state.is_some()),
        ("f", models.formulas.is_some()),
        ("motion", models.motion.is_some()),
        ("Q", models.noise.is_some()),
        ("let", !models.definitions.is_empty()),
        ("parameters", !models.parameters.is_empty()),
        ("filter", models.filter.is_some()),
        ("M", models.noise_cross_covariance.is_some()),
    ];
    keys.into_iter().find(|(_, is_there)| *is_there).map(|(key, _)| key)
}
