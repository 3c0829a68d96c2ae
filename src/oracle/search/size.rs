//! The size of a problem, which shrinking reduces until it ends.
//!
//! A step counts for more than any number of modes, a mode for more than any number of components, and digits for least.

use crate::model::space::ComponentKind;
use crate::oracle::models::ComponentFile;
use crate::oracle::problem::{FORMAT_2, FilterFile, MeasurementFile, ModeFile, ProblemFile};
use crate::oracle::steps::MeasurementAt;
use serde_json::{Value, json};

/// The size of a problem; sizes are compared from the first part on. All parts are whole numbers: nothing becomes smaller for ever.

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Size {
    /// Steps.
    pub steps: usize,
    /// Modes.
    pub modes: usize,
    /// Components of the state and of what the sensors measure.
    pub components: usize,
    /// What makes it special: missed detections and missing entries, sensors and steps of their own, functions, angles, parameters,
    /// probabilities of zero, filters that are not the Kalman filter.
    pub extras: usize,
    /// What has to be written: digits and exponents of all numbers. A zero is nothing, a one is little.
    pub written: usize,
}

impl Size {
    /// That of a problem.
    ///
    /// Example: without a component of its measurement a problem is smaller, and with shorter numbers.
    ///
    /// ```
    /// use immaculate::oracle::{case, search::size::Size};
    ///
    /// let case = case::all().unwrap().iter().find(|case| case.problem.id == "update.kalman").unwrap();
    /// let mut shorter = case.problem.clone();
    /// shorter.initial.modes[0].mean[0] = 0.0;
    /// assert!(Size::of(&shorter) < Size::of(&case.problem));
    /// ```
    pub fn of(problem: &ProblemFile) -> Self {
        let sensors = problem.sensors_at();
        let measured: usize = sensors.iter().map(|sensor| sensor.noise.len()).sum();
        let of_modes: usize = problem.modes.iter().map(|mode| of_mode(mode, &problem.state)).sum();
        let of_steps: usize = problem.measurements.iter().map(of_step).sum();
        let functions = sensors
            .iter()
            .filter(|sensor| !matches!(sensor.measurement, MeasurementFile::Linear { .. }));
        let closed = problem
            .transition
            .iter()
            .flatten()
            .chain(&problem.initial.mode_probabilities);
        let angles = problem
            .state
            .iter()
            .filter(|component| component.kind == ComponentKind::Angle);
        let extras = [
            of_modes,
            of_steps,
            functions.count(),
            angles.count(),
            closed.filter(|probability| **probability == 0.0).count(),
            3 * problem.sensors.len(),
            problem.parameters.0.len() + problem.definitions.len(),
            usize::from(problem.format == FORMAT_2),
            usize::from(!matches!(problem.filter, FilterFile::Kalman {})),
        ];
        Self {
            steps: problem.measurements.len(),
            modes: problem.modes.len(),
            components: problem.state.len() + measured,
            extras: extras.iter().sum(),
            written: written(&json!(problem)),
        }
    }
}

/// A formula that is no more than the component's own name is nothing special.
fn of_mode(mode: &ModeFile, state: &[ComponentFile]) -> usize {
    let models = &mode.models;
    let functions = [
        models.formulas.is_some(),
        models.motion.is_some(),
        models.noise.is_some(),
        models.filter.is_some(),
    ];
    let names = models.definitions.len() + models.parameters.0.len();
    let formulas = models.formulas.iter().flatten().zip(state);
    let moving = formulas.filter(|(formula, component)| **formula != component.name);
    names + moving.count() + functions.into_iter().filter(|is_there| *is_there).count()
}

fn of_step(entry: &MeasurementAt) -> usize {
    let changes = [
        entry.sensor.is_some(),
        entry.interval.is_some(),
        entry.transitions.is_some(),
        entry.noises.is_some(),
        entry.matrix.is_some(),
        entry.noise.is_some(),
        entry.transition.is_some(),
    ];
    let missing = entry
        .z
        .as_ref()
        .map_or(1, |z| z.iter().filter(|value| value.is_none()).count());
    missing + changes.into_iter().filter(|is_there| *is_there).count()
}

/// What the numbers of a file have to be written with.
fn written(file: &Value) -> usize {
    match file {
        Value::Array(list) => list.iter().map(written).sum(),
        Value::Object(entries) => entries.values().map(written).sum(),
        Value::Number(number) => number.as_f64().map_or(0, of_number),
        _ => 0,
    }
}

/// Two for each digit, and one for a sign and for each place of the decimal point.
fn of_number(value: f64) -> usize {
    if value == 0.0 {
        return 0;
    }
    let text = format!("{:e}", value.abs());
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let places: usize = exponent.trim_start_matches('-').parse().unwrap_or(0);
    let digits = digits.len() - usize::from(digits.contains('.'));
    let sign = usize::from(value < 0.0);
    if digits == 1 && places + sign == 0 && text.starts_with('1') {
        1
    } else {
        2 * digits + places + sign
    }
}
