//! The formulas and named models of a problem as functions in a number system.
//!
//! This file resolves the names in a formula and reports errors with their place in the file. A function that is linear becomes a matrix,
//! so that filters without points can use it too.
//!
//! ```text
//! state, parameters, let ─▶ names ─┬─ f, Q, h in formulas ─▶ Bound ─ step length, number system ─▶ Motion, Q, Sensor
//! spec/models.toml ────────────────┘
//! ```

use super::invalid::{Class, Invalid};
use super::models::{ComponentFile, ModelFile, ModelParameters, NoiseFile, OthersFile};
use super::problem::{MeasurementFile, ModeFile, ProblemFile, SensorAt};
use crate::matrix::mirrored;
use crate::model::binding::{InvalidModel, Others, STEP};
use crate::model::formula::{Fault, InvalidFormula, InvalidName, check_names};
use crate::model::function::{Function, InvalidFunction};
use crate::model::motion::Motion;
use crate::model::registry::{Model, ModelKind, model, models};
use crate::model::space::{InvalidSpace, Space};
use crate::model::{Sensor, nearest::nearest};
use crate::number::{Rational, Real};
use nalgebra::{DMatrix, DVector, Dyn};
use std::sync::Arc;

/// A function with the values that it is given besides the state.
#[derive(Debug, Clone)]
pub(super) struct Bound {
    function: Arc<Function>,
    given: Vec<Source>,
    place: String,
}

/// Where a given value comes from.
#[derive(Debug, Clone)]
enum Source {
    /// The length of the step.
    Step,
    /// The file.
    Value(f64),
}

/// What is not a matrix in a problem.
#[derive(Debug, Clone)]
pub(super) struct Functions {
    /// Of each mode the motion and the noise.
    pub(super) modes: Vec<[Option<Bound>; 2]>,
    /// Of each sensor the measurement.
    pub(super) sensors: Vec<Option<(Bound, Arc<Space>)>>,
    /// Of each conversion the map, if it is given by formulas.
    pub(super) conversions: Vec<Option<Bound>>,
}

/// The names that formulas may use.
#[derive(Clone)]
pub(super) struct Scope<'a> {
    parameters: Vec<(&'a str, Source)>,
    /// Definitions with their places.
    definitions: Vec<(String, &'a [String; 2])>,
}

impl ProblemFile {
    /// The functions among the motions, noises and measurements.
    ///
    /// # Errors
    ///
    /// [`Invalid`] with the place inside the file.
    pub(super) fn functions(&self) -> Result<Functions, Invalid> {
        let is_plain = |mode: &ModeFile| mode.models == super::models::ModeModels::default();
        let sensors = self.sensors_at();
        let is_function = |sensor: &SensorAt| sensor.measurement.is_function();
        let has_functions = !self.definitions.is_empty() || !self.conversions.is_empty();
        if !has_functions && !sensors.iter().any(is_function) && self.modes.iter().all(is_plain) {
            return Ok(Functions {
                conversions: Vec::new(),
                modes: self.modes.iter().map(|_| [None, None]).collect(),
                sensors: sensors.iter().map(|_| None).collect(),
            });
        }
        let state = self.space()?;
        let scope = self.scope(&state)?;
        let mut modes = Vec::with_capacity(self.modes.len());
        for (j, mode) in self.modes.iter().enumerate() {
            let place = format!("problem.modes[{j}]");
            let state = self.space_of(j)?;
            let scope = scope.with(&place, &state, &mode.models.parameters, &mode.models.definitions)?;
            modes.push([
                motion(mode, &place, &state, &scope)?,
                noise(mode, &place, &state, &scope)?,
            ]);
        }
        let of_sensor = |sensor| Self::sensor_function(sensor, &state, &scope);
        let sensors = sensors.iter().map(of_sensor).collect::<Result<_, Invalid>>()?;
        Ok(Functions {
            conversions: self.conversion_functions(&scope)?,
            modes,
            sensors,
        })
    }

    /// What the state of a mode is.
    pub(super) fn space_of(&self, j: usize) -> Result<Space, Invalid> {
        match &self.modes[j].models.state {
            Some(state) => space(&format!("problem.modes[{j}].state"), state, &[]),
            None => self.space(),
        }
    }

    /// What the state is.
    ///
    /// # Errors
    ///
    /// [`Invalid`] for a name that formulas cannot use.
    pub(super) fn space(&self) -> Result<Space, Invalid> {
        space("problem.state", &self.state, &self.units)
    }

    /// What a measurement by formulas or by a model is.
    ///
    /// # Errors
    ///
    /// [`Invalid`] as for [`ProblemFile::functions`].
    pub(super) fn measured_space(&self, sensor: &SensorAt) -> Result<Space, Invalid> {
        let place = format!("{}.measurement", sensor.place);
        match sensor.measurement {
            MeasurementFile::Formulas { z, .. } => space(&format!("{place}.z"), z, &[]),
            MeasurementFile::Model { model, parameters } => {
                measured(model, parameters, &self.space()?, &place).map(|(space, _)| space)
            }
            _ => Err(Invalid::new(Class::Unknown, place, "is no function")),
        }
    }

    /// The names that are known everywhere; the step length if any step has one.
    fn scope(&self, state: &Space) -> Result<Scope<'_>, Invalid> {
        let has_steps = self.measurements.iter().any(|entry| entry.interval.is_some());
        let step = (has_steps && self.parameters.get(STEP).is_none()).then_some((STEP, Source::Step));
        let scope = Scope {
            parameters: step.into_iter().collect(),
            definitions: Vec::new(),
        };
        scope.with("problem", state, &self.parameters, &self.definitions)
    }

    fn sensor_function(
        sensor: &SensorAt,
        state: &Space,
        scope: &Scope,
    ) -> Result<Option<(Bound, Arc<Space>)>, Invalid> {
        let place = format!("{}.measurement", sensor.place);
        match sensor.measurement {
            MeasurementFile::Formulas { z, h } => {
                let space = space(&format!("{place}.z"), z, &[])?;
                if h.len() != z.len() {
                    let reason = format!("has {} formulas where z has {} entries", h.len(), z.len());
                    return Err(Invalid::new(Class::Shape, format!("{place}.h"), reason));
                }
                let bound = scope.bound(&state.names(), h, |row| format!("{place}.h[{row}]"))?;
                Ok(Some((bound, space.into())))
            }
            MeasurementFile::Model { model, parameters } => {
                let (space, function) = measured(model, parameters, state, &place)?;
                Ok(Some((scope.given(function, &place, model)?, space.into())))
            }
            _ => Ok(None),
        }
    }

    /// The length of a step, counted from 0; that of the problem if the step has none.
    pub(super) fn interval(&self, step: usize) -> Option<f64> {
        let own = self.measurements.get(step).and_then(|entry| entry.interval);
        own.or_else(|| self.parameters.get(STEP))
    }
}

/// The space of components; `place` is where they stand.
fn space(place: &str, components: &[ComponentFile], units: &[String]) -> Result<Space, Invalid> {
    let all = components.iter().enumerate();
    let all = all.map(|(index, component)| component.component(units.get(index)));
    Space::new(all.collect()).map_err(|error| {
        let class = if error == InvalidSpace::Empty {
            Class::Shape
        } else {
            Class::Format
        };
        Invalid::new(class, place, error.to_string())
    })
}

/// The motion of a mode that is no matrix.
fn motion(mode: &ModeFile, place: &str, state: &Space, scope: &Scope) -> Result<Option<Bound>, Invalid> {
    if let Some(formulas) = &mode.models.formulas {
        let (found, n) = (formulas.len(), state.dimension());
        if found != n {
            let reason = format!("has {found} formulas where the state has {n} components");
            return Err(Invalid::new(Class::Shape, format!("{place}.f"), reason));
        }
        let bound = scope.bound(&state.names(), formulas, |row| format!("{place}.f[{row}]"))?;
        return Ok(Some(bound));
    }
    let Some(file) = &mode.models.motion else {
        return Ok(None);
    };
    let place = format!("{place}.motion");
    let others = match file.others {
        None => Others::Refuse,
        Some(OthersFile::Zero) => Others::Zero,
        Some(OthersFile::Keep) => Others::Keep,
    };
    let named = named(&file.model, ModelKind::Motion, &place)?;
    let function = named.motion(state, &numbers(&file.parameters), others);
    let function = function.map_err(|error| of_model(&error, &place))?;
    scope.given(function, &place, &file.model).map(Some)
}

/// The noise of a mode that is no matrix of numbers.
fn noise(mode: &ModeFile, place: &str, state: &Space, scope: &Scope) -> Result<Option<Bound>, Invalid> {
    let (place, n) = (format!("{place}.Q"), state.dimension());
    match &mode.models.noise {
        None | Some(NoiseFile::Matrix(_)) => Ok(None),
        Some(NoiseFile::Formulas(rows)) => {
            if rows.len() != n || rows.iter().any(|row| row.len() != n) {
                let reason = format!("is not {n} × {n}, as the state asks for");
                return Err(Invalid::new(Class::Shape, place, reason));
            }
            let entry = |index: usize| format!("{place}[{}][{}]", index / n, index % n);
            scope.bound(&state.names(), &rows.concat(), entry).map(Some)
        }
        Some(NoiseFile::Model(ModelFile {
            model,
            parameters,
            others,
        })) => {
            if others.is_some() {
                let reason = "is for motions; a noise is zero for components that the model does not have";
                return Err(Invalid::new(Class::Format, format!("{place}.others"), reason));
            }
            let function = named(model, ModelKind::Noise, &place)?.noise(state, &numbers(parameters));
            let function = function.map_err(|error| of_model(&error, &place))?;
            scope.given(function, &place, model).map(Some)
        }
    }
}

/// A measurement by the name of a model.
fn measured(id: &str, parameters: &ModelParameters, state: &Space, place: &str) -> Result<(Space, Function), Invalid> {
    let found = named(id, ModelKind::Measurement, place)?.measurement(state, &numbers(parameters));
    found.map_err(|error| of_model(&error, place))
}

/// The model of a name, if it is of the kind that is wanted; the nearest name is one of that kind.
fn named(id: &str, kind: ModelKind, place: &str) -> Result<&'static Model, Invalid> {
    model(id).map_err(|error| {
        let of_kind = models().iter().filter(|model| model.kind == kind);
        let near = nearest(id, of_kind.map(|model| model.id.as_str())).or(error.nearest);
        let near = near.map_or_else(String::new, |near| format!("; the nearest name is `{near}`"));
        let reason = format!("is {:?}, and there is no such model{near}", error.id);
        Invalid::new(Class::Unknown, format!("{place}.model"), reason)
    })
}

/// Parameters as exact numbers.
fn numbers(parameters: &ModelParameters) -> Vec<(&str, Rational)> {
    let exact = parameters.0.iter();
    exact
        .map(|(name, value)| (name.as_str(), Rational::from_f64(*value)))
        .collect()
}

/// The class of what is wrong with a model.
fn of_model(error: &InvalidModel, place: &str) -> Invalid {
    let class = match error {
        InvalidModel::Lacking(_) | InvalidModel::Other { .. } | InvalidModel::ComponentKind { .. } => Class::Shape,
        InvalidModel::UnknownParameter { .. } | InvalidModel::Kind { .. } => Class::Unknown,
        _ => Class::Format,
    };
    Invalid::new(class, place, error.to_string())
}

impl<'a> Scope<'a> {
    /// With more parameters and definitions, those of `place`; the definitions are read.
    fn with(
        &self,
        place: &str,
        state: &Space,
        parameters: &'a ModelParameters,
        definitions: &'a [[String; 2]],
    ) -> Result<Self, Invalid> {
        let mut scope = self.clone();
        for (name, value) in &parameters.0 {
            // The T of the problem may be another in some steps; that of a mode is a number like others.
            let source = if name == STEP && place == "problem" {
                Source::Step
            } else {
                Source::Value(*value)
            };
            scope.parameters.push((name, source));
            scope.check_names(state, &format!("{place}.parameters"))?;
        }
        for (index, definition) in definitions.iter().enumerate() {
            let of_definition = format!("{place}.let[{index}]");
            scope.definitions.push((of_definition.clone(), definition));
            scope.check_names(state, &of_definition)?;
        }
        scope.bound(&state.names(), &[], |_| String::new())?;
        Ok(scope)
    }

    /// Every name is one, and stands for one thing.
    fn check_names(&self, state: &Space, place: &str) -> Result<(), Invalid> {
        let parameters = self.parameters.iter().map(|(name, _)| *name);
        let definitions = self.definitions.iter().map(|(_, [name, _])| name.as_str());
        let names = state.names().into_iter().chain(parameters).chain(definitions);
        check_names(names).map_err(|error: InvalidName| Invalid::new(Class::Format, place, error.to_string()))
    }

    /// Formulas of these components; `place` says where each stands.
    pub(super) fn bound(
        &self,
        components: &[&str],
        texts: &[String],
        place: impl Fn(usize) -> String,
    ) -> Result<Bound, Invalid> {
        let given: Vec<&str> = self.parameters.iter().map(|(name, _)| *name).collect();
        let definitions = &self.definitions;
        let pairs: Vec<(&str, &str)> = definitions
            .iter()
            .map(|(_, [name, text])| (name.as_str(), text.as_str()))
            .collect();
        let numbers: Vec<String> = (0..texts.len()).map(|index| index.to_string()).collect();
        let formulas: Vec<(&str, &str)> = numbers
            .iter()
            .map(String::as_str)
            .zip(texts.iter().map(String::as_str))
            .collect();
        let function = Function::of_formulas(components, &given, &[], &pairs, &formulas).map_err(|error| {
            let InvalidFunction::Formula(InvalidFormula::Text {
                of,
                column,
                near,
                fault,
            }) = &error
            else {
                return Invalid::new(Class::Format, place(0), error.to_string());
            };
            let definition = definitions.iter().find(|(_, [name, _])| name == of);
            let place = match (of.parse(), definition) {
                (Ok(index), _) => place(index),
                (_, Some((place, _))) => format!("{place}[1]"),
                _ => place(0),
            };
            let class = match fault {
                Fault::UnknownName { .. } | Fault::UnknownFunction { .. } => Class::Unknown,
                _ => Class::Format,
            };
            let fault = match fault {
                Fault::UnknownName { name, .. } if name == STEP => {
                    "no step has a length `T`; give it in `parameters`, or with every measurement".to_owned()
                }
                fault => fault.to_string(),
            };
            Invalid::new(class, place, format!("column {column}, at `{near}`: {fault}"))
        })?;
        Ok(Bound {
            function: function.into(),
            given: self.parameters.iter().map(|(_, source)| source.clone()).collect(),
            place: place(0),
        })
    }

    /// The function of a model, which is given the step length and its inputs by their names.
    fn given(&self, function: Function, place: &str, id: &str) -> Result<Bound, Invalid> {
        let mut given = Vec::new();
        for name in function.given() {
            let known = self.parameters.iter().find(|(known, _)| known == name);
            given.push(match known {
                Some((_, source)) => source.clone(),
                None if name == STEP => Source::Step,
                None => {
                    let reason =
                        format!("`{id}` needs the input `{name}`; give it in `parameters` of the mode or the problem");
                    return Err(Invalid::new(Class::Format, place, reason));
                }
            });
        }
        Ok(Bound {
            function: function.into(),
            given,
            place: place.to_owned(),
        })
    }
}

impl Bound {
    /// The values that the function is given, in a step of this length.
    fn values<T: Real>(&self, number: fn(f64) -> T, interval: Option<f64>) -> Vec<T> {
        let value = |source: &Source| match source {
            Source::Step => interval.map_or_else(T::undecided, number),
            Source::Value(value) => number(*value),
        };
        self.given.iter().map(value).collect()
    }

    /// Whether the function needs the length of the step.
    pub(super) fn needs_interval(&self) -> bool {
        let formulas = self.function.formulas();
        formulas.is_some_and(|formulas| formulas.uses(STEP))
            && self.given.iter().any(|source| matches!(source, Source::Step))
    }

    /// Where it stands in the file.
    pub(super) fn place(&self) -> &str {
        &self.place
    }

    /// The motion: a matrix if the function is linear.
    pub(super) fn motion<T: Real>(&self, number: fn(f64) -> T, interval: Option<f64>) -> Motion<T, Dyn> {
        let given = self.values(number, interval);
        match self.matrix_and_offset(&given) {
            Some((matrix, offset)) if offset.iter().all(T::is_zero) => Motion::Linear(matrix),
            Some((matrix, offset)) => Motion::Affine { matrix, offset },
            None => Motion::Function {
                function: Arc::clone(&self.function),
                given,
            },
        }
    }

    /// The sensor: a matrix if the function is linear and nothing is an angle.
    pub(super) fn sensor<T: Real>(
        &self,
        space: &Arc<Space>,
        number: fn(f64) -> T,
        interval: Option<f64>,
    ) -> Sensor<T, Dyn, Dyn> {
        let given = self.values(number, interval);
        let has_angles = (0..space.dimension()).any(|component| space.is_angle(component));
        match self.matrix_and_offset(&given) {
            Some((matrix, offset)) if !has_angles && offset.iter().all(T::is_zero) => Sensor::Linear(matrix),
            _ => Sensor::Function {
                function: Arc::clone(&self.function),
                space: Arc::clone(space),
                given,
            },
        }
    }

    /// The noise, by rows. Its lower triangle is read: the triangles are equal up to rounding, which [`Bound::check_noise`] holds.
    pub(super) fn noise<T: Real>(&self, n: usize, number: fn(f64) -> T, interval: Option<f64>) -> DMatrix<T> {
        mirrored(self.entries(n, number, interval))
    }

    /// Checks that a noise has numbers, and that its triangles agree up to rounding.
    pub(super) fn check_noise(&self, n: usize, interval: Option<f64>) -> Result<(), Invalid> {
        let entries = self.entries::<f64>(n, |value| value, interval);
        let place = self.place.trim_end_matches("[0][0]");
        if let Some(index) = entries.transpose().iter().position(|entry| !entry.is_finite()) {
            let place = format!("{place}[{}][{}]", index / n, index % n);
            let reason = "has no value; a noise does not depend on the state";
            return Err(Invalid::new(Class::NotFinite, place, reason));
        }
        // A few operations on either side round a few times.
        let is_near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * a.abs().max(b.abs());
        for row in 0..n {
            for column in 0..row {
                if !is_near(entries[(row, column)], entries[(column, row)]) {
                    return Err(Invalid::new(
                        Class::NotSymmetric,
                        place,
                        "is not symmetric (liu2017 (17))",
                    ));
                }
            }
        }
        Ok(())
    }

    /// A noise knows nothing of the state.
    fn entries<T: Real>(&self, n: usize, number: fn(f64) -> T, interval: Option<f64>) -> DMatrix<T> {
        let state = vec![T::undecided(); self.function.components()];
        DMatrix::from_row_iterator(n, n, self.function.at(&state, &self.values(number, interval)))
    }

    /// F and b of a linear function.
    fn matrix_and_offset<T: Real>(&self, given: &[T]) -> Option<(DMatrix<T>, DVector<T>)> {
        if !self.function.is_linear() {
            return None;
        }
        let (rows, columns) = (self.function.dimension(), self.function.components());
        let zero = vec![T::zero(); columns];
        let slopes = self.function.jacobian_at(&zero, given);
        let matrix = DMatrix::from_row_iterator(rows, columns, slopes.into_iter().flatten());
        Some((matrix, DVector::from_vec(self.function.at(&zero, given))))
    }
}
