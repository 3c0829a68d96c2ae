//! A problem as Python sees it: its file, and its models in doubles, evaluated by the crate.

use immaculate::filter::extended;
use immaculate::imm::{self, Quantity};
use immaculate::model::motion::Mode;
use immaculate::model::{PolarComponent, Sensor};
use immaculate::number::RandomRounding;
use immaculate::oracle::case;
use immaculate::oracle::certify::certify;
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::setup::Setup;
use nalgebra::{DMatrix, DVector, Dim, Dyn};
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::sync::OnceLock;

/// A problem file. Step 0 stands for the problem itself, and k for step k.
#[pyclass(frozen, module = "immaculate._immaculate")]
pub struct Problem {
    file: ProblemFile,
    /// Made when it is first needed; a published problem that must be rejected has none.
    setup: OnceLock<Result<Setup<RandomRounding>, String>>,
}

/// A sentence as what Python raises.
pub fn refused(sentence: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(sentence.to_string())
}

impl From<ProblemFile> for Problem {
    fn from(file: ProblemFile) -> Self {
        let setup = OnceLock::new();
        Self { file, setup }
    }
}

#[pymethods]
impl Problem {
    /// Reads a problem from JSON and checks it.
    #[staticmethod]
    fn read(text: &str) -> PyResult<Self> {
        ProblemFile::read(text).map(Self::from).map_err(refused)
    }

    /// The file, in the long form.
    fn json(&self) -> PyResult<String> {
        serde_json::to_string(&self.file).map_err(refused)
    }

    /// The names of its filters.
    fn kinds(&self) -> Vec<&str> {
        self.file.kinds()
    }

    /// The models of a step as JSON.
    fn models(&self, step: usize) -> PyResult<String> {
        let problem = self.at(step)?;
        let entry = step.checked_sub(1).and_then(|index| self.file.measurements.get(index));
        let modes: Vec<Value> = problem.modes.iter().map(mode_json).collect();
        let m = problem.sensor.dimension().value();
        let chain: Vec<Vec<f64>> = problem.chain.iter().map(|row| list(row)).collect();
        let all = self.file.sensors_at();
        let sensor = &all[entry.and_then(|entry| self.file.sensor_of(entry)).unwrap_or(0)];
        let z: Option<Vec<f64>> = entry
            .filter(|entry| entry.z.is_some())
            .map(|entry| entry.entries().map(|it| it.1).collect());
        let rows: Vec<usize> = match entry {
            Some(entry) if entry.z.is_some() => entry.entries().map(|it| it.0).collect(),
            _ => (0..sensor.noise.len()).collect(),
        };
        Ok(json!({
            "modes": modes,
            "H": if let Sensor::Linear(matrix) = &problem.sensor { json!(rows_of(matrix)) } else { Value::Null },
            "R": rows_of(&problem.measurement_noise),
            "transition": chain,
            "measured": (0..m).map(|row| measured_name(&problem.sensor, row)).collect::<Vec<_>>(),
            "measured_angles": (0..m).map(|row| problem.sensor.is_angle(row)).collect::<Vec<_>>(),
            "T": entry.and_then(|entry| entry.interval).or_else(|| self.file.parameters.get("T")),
            "sensor": entry.and_then(|entry| entry.sensor.clone()),
            "z": z,
            "rows": rows,
            "changed": self.setup()?.changes.contains_key(&step),
        })
        .to_string())
    }

    /// Which entries of the state are angles.
    fn angles(&self) -> PyResult<Vec<bool>> {
        let angles = &self.setup()?.problem.angles;
        let n = self.file.state.len();
        Ok((0..n).map(|entry| angles.contains(&entry)).collect())
    }

    /// f of a mode at a state.
    fn motion(&self, step: usize, mode: usize, state: Vec<f64>) -> PyResult<Vec<f64>> {
        let moved = self.mode(step, mode)?.motion.of(&self.state(state)?);
        Ok(list(moved.as_slice()))
    }

    /// ∂f/∂x of a mode at a state.
    fn motion_jacobian(&self, step: usize, mode: usize, state: Vec<f64>) -> PyResult<Vec<Vec<f64>>> {
        let motion = &self.mode(step, mode)?.motion;
        Ok(rows_of(&extended::motion_jacobian(motion, &self.state(state)?)))
    }

    /// h at a state.
    fn measurement(&self, step: usize, state: Vec<f64>) -> PyResult<Vec<f64>> {
        Ok(list(self.at(step)?.sensor.of(&self.state(state)?).as_slice()))
    }

    /// ∂h/∂x at a state.
    fn measurement_jacobian(&self, step: usize, state: Vec<f64>) -> PyResult<Vec<Vec<f64>>> {
        let sensor = &self.at(step)?.sensor;
        Ok(rows_of(&extended::measurement_jacobian(sensor, &self.state(state)?)))
    }

    /// The quantities of a trace in a step: name, whether each mode has its own, and shape.
    fn shapes(&self, step: usize) -> Vec<(&'static str, bool, Vec<usize>)> {
        let dimensions = self.file.dimensions();
        let of = |quantity: Quantity| {
            let (rows, columns) = dimensions.shape(step, quantity);
            let shape = [rows, columns][..quantity.rank()].to_vec();
            (quantity.name(), quantity.is_of_mode(), shape)
        };
        Quantity::ALL.into_iter().map(of).collect()
    }

    /// The certified trace, with scale and noise, as JSON.
    fn trace(&self, py: Python<'_>) -> PyResult<String> {
        let certified = py.detach(|| certify(&self.file)).map_err(refused)?;
        Ok(case::trace_text(&self.file.id, &certified))
    }
}

impl Problem {
    fn setup(&self) -> PyResult<&Setup<RandomRounding>> {
        let make = || {
            self.file.check().map_err(|invalid| invalid.to_string())?;
            self.file.setup_in_doubles().map_err(|invalid| invalid.to_string())
        };
        self.setup.get_or_init(make).as_ref().map_err(refused)
    }

    fn at(&self, step: usize) -> PyResult<&imm::Problem<RandomRounding, Dyn, Dyn>> {
        let steps = self.file.measurements.len();
        if step > steps {
            return Err(PyIndexError::new_err(format!(
                "there is no step {step}: the problem has {steps}"
            )));
        }
        Ok(self.setup()?.problem_of(step))
    }

    fn mode(&self, step: usize, mode: usize) -> PyResult<&Mode<RandomRounding, Dyn>> {
        let modes = &self.at(step)?.modes;
        let count = modes.len();
        let sentence = || PyIndexError::new_err(format!("there is no mode {mode}: the problem has {count}"));
        modes.get(mode).ok_or_else(sentence)
    }

    fn state(&self, state: Vec<f64>) -> PyResult<DVector<RandomRounding>> {
        let (n, found) = (self.file.state.len(), state.len());
        if found != n {
            return Err(refused(format!("the state has {n} entries, and {found} were given")));
        }
        Ok(DVector::from_iterator(n, state.into_iter().map(RandomRounding::exact)))
    }
}

/// A mode as JSON: F where it is linear, with the offset if there is one.
fn mode_json(mode: &Mode<RandomRounding, Dyn>) -> Value {
    let matrix = mode.motion.is_linear().then(|| rows_of(&mode.motion.matrix()));
    let offset = mode.motion.offset().map(|offset| list(offset.as_slice()));
    json!({ "name": mode.name, "F": matrix, "offset": offset, "Q": rows_of(&mode.noise) })
}

/// The name of an entry of z; a linear measurement has no names.
fn measured_name(sensor: &Sensor<RandomRounding, Dyn, Dyn>, row: usize) -> Option<String> {
    match sensor {
        Sensor::Linear(_) => None,
        Sensor::Polar { components, .. } => Some(match components[row] {
            PolarComponent::Range => "range".to_owned(),
            PolarComponent::Bearing => "bearing".to_owned(),
        }),
        Sensor::Function { space, .. } => space.names().get(row).map(|&name| name.to_owned()),
    }
}

fn list(values: &[RandomRounding]) -> Vec<f64> {
    values.iter().map(|value| value.value()).collect()
}

fn rows_of(matrix: &DMatrix<RandomRounding>) -> Vec<Vec<f64>> {
    let row = |row: usize| matrix.row(row).iter().map(|value| value.value()).collect();
    (0..matrix.nrows()).map(row).collect()
}
