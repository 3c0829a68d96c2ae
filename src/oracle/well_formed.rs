//! The checks that a problem file must pass before it is run.
//!
//! Every defect of a file becomes one sentence with the place inside the file. Shapes are checked here, values by the cycle itself.

use super::invalid::{Class, Invalid};
use super::problem::{
    Conventions, FORMAT, FORMAT_2, FilterFile, FixedGainFile, InteractionFile, MIXINGS, MeasurementAt, MeasurementFile,
    ProblemFile, RULES, Rows, SensorFile,
};
use super::trace::Dimensions;
use super::unreadable::value_at;
use crate::file::shortened;
use crate::imm::{InvalidProblem, Needs};
use crate::model::Conversion;
use crate::model::nearest::nearest;
use serde::Deserialize;
use serde_json::json;

impl ProblemFile {
    /// Checks all that the filter relies on.
    ///
    /// # Errors
    ///
    /// [`Invalid`] with the place inside the file.
    pub fn check(&self) -> Result<(), Invalid> {
        if ![FORMAT, FORMAT_2].contains(&self.format.as_str()) {
            let reason = format!(
                "is {:?}, but this program reads {FORMAT:?} and {FORMAT_2:?}",
                self.format
            );
            return Err(Invalid::new(Class::Format, "problem.format", reason));
        }
        self.check_new_keys()?;
        self.check_conventions()?;
        self.check_shapes()?;
        check_size(&self.dimensions())?;
        self.check_functions()?;
        self.check_filters()?;
        self.check_interaction()?;
        self.check_noise_cross_covariances()?;
        self.check_measurements()?;
        self.check_values()
    }

    /// Puts the problem into doubles and lets the cycle check it.
    fn check_values(&self) -> Result<(), Invalid> {
        let setup = self.setup_in_doubles()?;
        setup
            .problem
            .check(&setup.initial)
            .map_err(|error| self.with_entries(of_problem(&error)))?;
        for (step, problem) in &setup.changes {
            problem.check(&setup.initial).map_err(|error| Invalid {
                place: format!("problem.measurements[{}]", step - 1),
                ..Invalid::new(
                    of_problem(&error).class,
                    "",
                    format!("changes the problem so that {error}"),
                )
            })?;
        }
        Ok(())
    }

    /// Of a matrix that is not symmetric, the two entries that are farthest apart.
    fn with_entries(&self, invalid: Invalid) -> Invalid {
        let rows = || Rows::deserialize(value_at(&json!(self), &invalid.place)?).ok();
        let Some(rows) = rows().filter(|_| invalid.class == Class::NotSymmetric) else {
            return invalid;
        };
        let below = (0..rows.len()).flat_map(|row| (0..row).map(move |column| (row, column)));
        let apart = |(row, column): &(usize, usize)| (rows[*row][*column] - rows[*column][*row]).abs();
        let Some((row, column)) = below.max_by(|a, b| apart(a).total_cmp(&apart(b))) else {
            return invalid;
        };
        let reason = format!(
            "{}: [{column}][{row}] is {}, [{row}][{column}] is {}, {:.1e} apart; write the same number in both",
            invalid.reason,
            rows[column][row],
            rows[row][column],
            apart(&(row, column))
        );
        Invalid { reason, ..invalid }
    }

    fn check_conventions(&self) -> Result<(), Invalid> {
        let given = &self.conventions;
        let pairs = [
            ("square_root", &given.square_root),
            ("angle_mean", &given.angle_mean),
            ("first_step", &given.first_step),
            ("log_likelihood", &given.log_likelihood),
        ];
        let later = [
            ("unequal_dimensions", &given.unequal_dimensions),
            ("state_angle_mean", &given.state_angle_mean),
            ("converted_covariance", &given.converted_covariance),
        ];
        let later = later
            .into_iter()
            .filter_map(|(key, value)| Some((key, value.as_ref()?)));
        for (key, value) in pairs.into_iter().chain(later) {
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
        let (n, r) = (self.state.len(), self.modes.len());
        check_count("problem.state", n, MOST_STATES)?;
        if self.format == FORMAT || !self.units.is_empty() {
            check_length("problem.units", self.units.len(), n)?;
        }
        for sensor in self.sensors_at() {
            let (place, m) = (format!("{}.R", sensor.place), sensor.noise.len());
            check_count(&place, m, MOST_MEASURED)?;
            check_matrix(&place, sensor.noise, m, m)?;
        }
        if r == 0 {
            return Err(Invalid::new(
                Class::Shape,
                "problem.modes",
                "is empty; the filter needs at least one",
            ));
        }
        for (j, mode) in self.modes.iter().enumerate() {
            if mode.models.formulas.is_none() && mode.models.motion.is_none() {
                check_matrix(&format!("problem.modes[{j}].F"), &mode.transition, n, n)?;
            }
            if mode.models.noise.is_none() {
                check_matrix(&format!("problem.modes[{j}].Q"), &mode.noise, n, n)?;
            }
        }
        for sensor in self.sensors_at() {
            let (place, m) = (format!("{}.measurement", sensor.place), sensor.noise.len());
            match sensor.measurement {
                MeasurementFile::Linear { matrix } => check_matrix(&format!("{place}.H"), matrix, m, n)?,
                MeasurementFile::RangeBearing { components, .. } => {
                    check_length(&format!("{place}.components"), components.len(), m)?;
                }
                MeasurementFile::Formulas { z, .. } => check_length(&format!("{place}.z"), z.len(), m)?,
                MeasurementFile::Model { .. } => {}
            }
        }
        self.check_chain()?;
        self.check_state_conversions()?;
        self.check_initial_shapes()
    }

    fn check_initial_shapes(&self) -> Result<(), Invalid> {
        let (n, r) = (self.state.len(), self.modes.len());
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
                Some(rows) if self.filter.has(Needs::Covariances) => check_matrix(&field, rows, n, n)?,
                Some(_) => {
                    let reason = "is given, but filters with fixed gains have no covariance";
                    return Err(Invalid::new(Class::Format, field, reason));
                }
                None if self.filter.has(Needs::Covariances) => {
                    return Err(Invalid::new(Class::Format, field, "is missing"));
                }
                None => {}
            }
        }
        Ok(())
    }

    /// Which estimates the filters start from is said once, and modes with states of their own are mixed.
    fn check_interaction(&self) -> Result<(), Invalid> {
        let Some(interaction) = self.interaction else {
            return Ok(());
        };
        let name = interaction.name();
        let reason = if let FilterFile::FixedGain { .. } = self.filter {
            format!("is {name:?}, and `filter.mixing` says it of fixed gains; leave `interaction` out")
        } else if interaction != InteractionFile::Imm && !self.conversions.is_empty() {
            format!("is {name:?}, and `conversions` give modes states of their own, which \"imm\" alone mixes")
        } else {
            return Ok(());
        };
        Err(Invalid::new(Class::Unknown, "problem.interaction", reason))
    }

    /// What is said of correlated noises belongs to a sensor, and to a filter that takes it.
    fn check_noise_cross_covariances(&self) -> Result<(), Invalid> {
        for (j, mode) in self.modes.iter().enumerate() {
            let Some(rows) = &mode.models.noise_cross_covariance else {
                continue;
            };
            let place = format!("problem.modes[{j}].M");
            let filter = self.filter_of(j);
            if !matches!(
                filter,
                FilterFile::Kalman {} | FilterFile::Extended { iterations: None }
            ) {
                let reason = format!(
                    "is given, and the filter is {}; only kalman and extended have the matrix of the measurement that it needs",
                    filter.name()
                );
                return Err(Invalid::new(Class::Unknown, place, reason));
            }
            if !self.sensors.is_empty() {
                let reason = "is given, and there are further sensors; the noise of one measurement is meant";
                return Err(Invalid::new(Class::Unknown, place, reason));
            }
            check_matrix(&place, rows, self.state.len(), self.noise.len())?;
        }
        Ok(())
    }

    fn check_filters(&self) -> Result<(), Invalid> {
        for (filter, place) in self.filters_with_places() {
            for sensor in self.sensors_at() {
                self.check_filter(filter, &place, sensor.measurement)?;
            }
        }
        Ok(())
    }

    /// A filter is there for what a sensor measures.
    fn check_filter(&self, filter: &FilterFile, place: &str, measurement: &MeasurementFile) -> Result<(), Invalid> {
        let is_polar = matches!(measurement, MeasurementFile::RangeBearing { .. });
        let unknown = |key: &str, reason: String| Err(Invalid::new(Class::Unknown, format!("{place}.{key}"), reason));
        match filter {
            FilterFile::Cubature { rule } if !RULES.contains(&rule.as_str()) => {
                unknown("rule", format!("is {rule:?}; known are {}", RULES.join(", ")))
            }
            FilterFile::Extended {
                iterations: Some(times),
            } if times.get() > MOST_ITERATIONS => {
                let reason = format!(
                    "is {times}; at most {MOST_ITERATIONS} are computed, and those after the first few change nothing"
                );
                Err(Invalid::new(Class::Range, format!("{place}.iterations"), reason))
            }
            FilterFile::Kalman {} | FilterFile::FixedGain { .. } if is_polar => unknown(
                "kind",
                format!(
                    "is {}, which has no range and bearing; use extended, a filter with points, or converted",
                    filter.name()
                ),
            ),
            FilterFile::Converted { conversion } if conversion.parse::<Conversion>().is_err() => {
                let known = Conversion::ALL.map(Conversion::name).join(", ");
                unknown("conversion", format!("is {conversion:?}; known are {known}"))
            }
            FilterFile::Converted { .. } if !is_polar => {
                let reason = match measurement {
                    MeasurementFile::Linear { .. } => {
                        "is converted, but a linear measurement is no range and bearing to be converted"
                    }
                    _ => "is converted, which asks for a measurement of the kind \"range-bearing\"",
                };
                unknown("kind", reason.to_owned())
            }
            FilterFile::FixedGain { .. } if place != "problem.filter" => unknown(
                "kind",
                "is fixed-gain, which is said of all modes at once, in `problem.filter`".to_owned(),
            ),
            FilterFile::FixedGain { .. } if self.modes.iter().any(|mode| mode.models.filter.is_some()) => unknown(
                "kind",
                "is fixed-gain, and a mode has a filter of its own; gains are given to all or none".to_owned(),
            ),
            FilterFile::FixedGain { .. } if !self.sensors.is_empty() => unknown(
                "kind",
                "is fixed-gain, and there are further sensors; gains are given for one".to_owned(),
            ),
            FilterFile::FixedGain { mixing, modes } => self.check_fixed_gains(mixing, modes),
            _ => Ok(()),
        }
    }

    /// Sensors are distinguished by their names.
    fn check_names_of_sensors(&self) -> Result<(), Invalid> {
        for (index, sensor) in self.sensors.iter().enumerate() {
            let has_name = |other: &SensorFile| other.name == sensor.name;
            if self.sensors[..index].iter().any(has_name) {
                let (place, reason) = (
                    format!("problem.sensors[{index}].name"),
                    "is the name of another sensor",
                );
                return Err(Invalid::new(Class::Format, place, reason));
            }
        }
        Ok(())
    }

    /// What is said of a step whose sensor does not exist.
    fn no_such_sensor(&self, place: usize, entry: &MeasurementAt) -> Invalid {
        let name = entry.sensor.as_deref().unwrap_or_default();
        let known = || self.sensors.iter().map(|sensor| sensor.name.as_str());
        let hint = match nearest(name, known()) {
            Some(near) => format!("; the nearest name is `{near}`"),
            None if self.sensors.is_empty() => "; `sensors` is empty".to_owned(),
            None => format!("; known are {}", known().collect::<Vec<_>>().join(", ")),
        };
        let reason = format!("is {:?}, and there is no such sensor{hint}", shortened(name, 64));
        Invalid::new(Class::Unknown, format!("problem.measurements[{place}].sensor"), reason)
    }

    fn check_fixed_gains(&self, mixing: &str, modes: &[FixedGainFile]) -> Result<(), Invalid> {
        let (n, m, r) = (self.state.len(), self.noise.len(), self.modes.len());
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

    /// Entries may be missing where an update has a meaning without them.
    fn check_missing(&self, field: &str, entry: &MeasurementAt) -> Result<(), Invalid> {
        let Some(rows) = entry.rows() else { return Ok(()) };
        let wrong = |reason: String| Err(Invalid::new(Class::Format, field, reason));
        if rows.is_empty() {
            return wrong("has no entry that is there; a step without a detection says null for all of it".to_owned());
        }
        for (filter, _) in self.filters_with_places() {
            if matches!(filter, FilterFile::Converted { .. } | FilterFile::FixedGain { .. }) {
                let reason = format!("lacks an entry, and {} needs all of them", filter.name());
                return wrong(reason);
            }
        }
        Ok(())
    }

    fn check_measurements(&self) -> Result<(), Invalid> {
        let sensors = self.sensors_at();
        self.check_names_of_sensors()?;
        let angles: Vec<Vec<bool>> = sensors.iter().map(|sensor| self.angles_of(sensor)).collect();
        let ranges: Vec<Vec<bool>> = sensors.iter().map(|sensor| self.ranges_of(sensor)).collect();
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
            let index = self.sensor_of(entry).ok_or_else(|| self.no_such_sensor(place, entry))?;
            let sensor = &sensors[index];
            self.check_changes(place, entry, sensor)?;
            self.check_truth(place, entry)?;
            let Some(z) = &entry.z else { continue };
            let field = format!("problem.measurements[{place}].z");
            check_length(&field, z.len(), sensor.noise.len())?;
            self.check_missing(&field, entry)?;
            for (row, value) in entry.entries() {
                if !value.is_finite() {
                    return Err(Invalid::new(
                        Class::NotFinite,
                        format!("{field}[{row}]"),
                        "is not finite",
                    ));
                }
                if ranges[index].get(row) == Some(&true) && value < 0.0 {
                    let reason = format!("is {value}, a negative range; a range is a distance");
                    return Err(Invalid::new(Class::Range, format!("{field}[{row}]"), reason));
                }
                if angles[index].get(row) == Some(&true) && value.abs() > 2.0 * std::f64::consts::PI {
                    let reason = format!("is {value}, a bearing outside ±2π: is it in degrees?");
                    return Err(Invalid::new(Class::Angle, format!("{field}[{row}]"), reason));
                }
            }
        }
        Ok(())
    }
}

/// A trace is held in memory as a whole: this many numbers take about a gigabyte while they are written.
const MOST_NUMBERS: usize = 10_000_000;

/// The most linearisations of an update.
const MOST_ITERATIONS: usize = 100;

/// The most components of a state. A problem of this size is certified in minutes; nothing else limits it.
pub const MOST_STATES: usize = 32;

/// The most components of a measurement.
pub const MOST_MEASURED: usize = 16;

/// A state or a measurement has at least one component, and not more than are computed with.
fn check_count(field: &str, found: usize, most: usize) -> Result<(), Invalid> {
    if (1..=most).contains(&found) {
        return Ok(());
    }
    let reason = format!("has {found} components; there must be 1 to {most}");
    Err(Invalid::new(Class::Shape, field, reason))
}

fn check_size(dimensions: &Dimensions) -> Result<(), Invalid> {
    let numbers = dimensions.numbers();
    if numbers <= MOST_NUMBERS {
        return Ok(());
    }
    let reason = format!(
        "has {} steps, and their trace {numbers} numbers; this program is built for at most {MOST_NUMBERS}",
        dimensions.steps()
    );
    Err(Invalid::new(Class::Shape, "problem.measurements", reason))
}

/// The class and the place of what the cycle refuses.
fn of_problem(error: &InvalidProblem) -> Invalid {
    let class = match error {
        InvalidProblem::Length { .. }
        | InvalidProblem::NoModes
        | InvalidProblem::NoFilters
        | InvalidProblem::Shape { .. }
        | InvalidProblem::RuleLengths { .. }
        | InvalidProblem::Angle { .. }
        | InvalidProblem::Position { .. }
        | InvalidProblem::PositionTwice { .. } => Class::Shape,
        InvalidProblem::NotFinite { .. } => Class::NotFinite,
        InvalidProblem::NegativeProbability { .. } | InvalidProblem::NotNormalised { .. } => Class::NotAProbability,
        InvalidProblem::NotSymmetric { .. } => Class::NotSymmetric,
        InvalidProblem::NotPositive { .. } | InvalidProblem::NotJoint { .. } => Class::NotPositiveDefinite,
        InvalidProblem::NotLinear { .. }
        | InvalidProblem::SomeGiven
        | InvalidProblem::CorrelationWithoutSlopes { .. }
        | InvalidProblem::OtherKind
        | InvalidProblem::OtherModes { .. }
        | InvalidProblem::OtherInteraction
        | InvalidProblem::NothingToDrawFrom
        | InvalidProblem::TwoConversions
        | InvalidProblem::NotRangeAndBearing
        | InvalidProblem::CorrelatedNoise
        | InvalidProblem::ConversionsOfGiven => Class::Unknown,
        InvalidProblem::CovarianceGiven { .. } | InvalidProblem::Conversion { .. } => Class::Format,
    };
    let hint = match error {
        InvalidProblem::NotNormalised { sum, .. } if is_single(sum) => {
            "; it looks like single precision: write the decimals as they are meant"
        }
        _ => "",
    };
    // The sentence starts with the field in backquotes.
    let sentence = format!("{error}{hint}");
    match sentence.strip_prefix('`').and_then(|rest| rest.split_once('`')) {
        Some((field, rest)) => Invalid::new(class, format!("problem.{field}"), rest.trim_start()),
        None => Invalid::new(class, "problem", sentence),
    }
}

/// Whether a sum of probabilities is one but for rounding in single precision, by a unit in the last place of 1 at most.
fn is_single(sum: &str) -> bool {
    let excess = sum.parse::<f64>().map_or(f64::NAN, |sum| (sum - 1.0).abs());
    (1e-10..=f64::from(f32::EPSILON)).contains(&excess)
}

pub(super) fn check_length(field: &str, found: usize, expected: usize) -> Result<(), Invalid> {
    if found == expected {
        return Ok(());
    }
    let reason = format!("has {found} entries where {expected} are needed");
    Err(Invalid::new(Class::Shape, field, reason))
}

pub(super) fn check_matrix(field: &str, rows: &Rows, height: usize, width: usize) -> Result<(), Invalid> {
    check_length(field, rows.len(), height)?;
    for (place, row) in rows.iter().enumerate() {
        check_length(&format!("{field}[{place}]"), row.len(), width)?;
    }
    Ok(())
}
