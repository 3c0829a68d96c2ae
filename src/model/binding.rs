//! A named model for a given state: its formulas with the axes written out and the parameters bound.
//!
//! This file also handles components of the state that the model does not need, and axes that the state does not have.
//!
//! A row that holds for each axis is written out for the axes of which the state has a component. So the same row is a motion along one
//! line, in the plane and in space, and the state says which. The components may stand in any order.

use super::function::{Function, InvalidFunction, Lacking};
use super::nearest::nearest;
use super::registry::{ListedComponent, Model, ModelKind};
use super::space::{Component, ComponentKind, InvalidSpace, Space};
use crate::number::Rational;
use thiserror::Error;

/// What stands for the axis in a row.
const AXIS: char = '@';

/// The step length in the formulas.
pub const STEP: &str = "T";

/// What a motion does with components of the state that it does not have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Others {
    /// There may be none.
    Refuse,
    /// They become zero, as the acceleration does in constant velocity among states with an acceleration.
    Zero,
    /// They stay as they are.
    Keep,
}

/// Why a model cannot be bound.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum InvalidModel {
    /// It is of another kind.
    #[error("`{id}` is a model of a {} and not of a {}", .is.name(), .wanted.name())]
    Kind {
        /// The model.
        id: String,
        /// What it is.
        is: ModelKind,
        /// What was wanted.
        wanted: ModelKind,
    },
    /// The state lacks components.
    #[error(transparent)]
    Lacking(#[from] Lacking),
    /// The state has a component as a number that is an angle, or the other way around.
    #[error("`{component}` is {} in the state, and {} in the model `{id}`", described(*.in_state), described(*.in_model))]
    ComponentKind {
        /// The model.
        id: String,
        /// The component.
        component: String,
        /// What the state says.
        in_state: ComponentKind,
        /// What the model says.
        in_model: ComponentKind,
    },
    /// The state has components that the motion does not move.
    #[error(
        "the motion `{id}` says nothing of the component `{component}` of the state; say whether it becomes zero or is kept"
    )]
    Other {
        /// The model.
        id: String,
        /// The first such component.
        component: String,
    },
    /// A parameter is not given.
    #[error("the model `{id}` needs the parameter `{name}`, {meaning}, in {unit}")]
    MissingParameter {
        /// The model.
        id: String,
        /// The parameter.
        name: String,
        /// What it is.
        meaning: String,
        /// Its unit.
        unit: String,
    },
    /// A parameter is given that the model has not, or twice.
    #[error("the model `{id}` has no parameter `{name}`{}", .nearest.as_ref().map_or_else(String::new, |name| format!("; the nearest name is `{name}`")))]
    UnknownParameter {
        /// The model.
        id: String,
        /// The name.
        name: String,
        /// The nearest one that there is, if one is near.
        nearest: Option<String>,
    },
    /// A parameter is given twice.
    #[error("the parameter `{0}` is given twice")]
    ParameterTwice(String),
    /// The formulas of the row are not formulas.
    #[error(transparent)]
    Function(#[from] InvalidFunction),
    /// What the row measures is not a space.
    #[error(transparent)]
    Space(#[from] InvalidSpace),
}

/// A kind of component in a sentence.
fn described(kind: ComponentKind) -> &'static str {
    match kind {
        ComponentKind::Number => "a number",
        ComponentKind::Angle => "an angle",
    }
}

impl Model {
    /// The motion f of a state: what is given at every step is the step length `T` and the inputs of the row.
    ///
    /// Source: the row of the model, its parameters bound.
    ///
    /// Example: constant velocity along two axes, with an acceleration that it does not know.
    ///
    /// ```
    /// use immaculate::model::binding::Others;
    /// use immaculate::model::registry::model;
    /// use immaculate::model::space::{Component, Space};
    ///
    /// let names = ["x", "vx", "y", "vy", "ay"];
    /// let state = Space::new(names.map(|name| Component::number(name, "")).to_vec())?;
    /// let motion = model("constant-velocity")?.motion(&state, &[], Others::Zero)?;
    /// // 10 + 2 · 3, 20 + 2 · (−1)
    /// assert_eq!(motion.at(&[10.0, 3.0, 20.0, -1.0, 9.0], &[2.0]), [16.0, 3.0, 18.0, -1.0, 0.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`InvalidModel`] if the model is no motion, if the state lacks a component or has one too many, or if a parameter is missing or
    /// unknown.
    ///
    /// Evidence: `every_motion_starts_as_its_differential_equation_says`, `every_motion_composes_over_time`,
    /// `turns_are_the_plain_functions` (enclosed), `polynomial_models_are_the_plain_functions_for_all_values` (symbolic).
    pub fn motion(
        &self,
        state: &Space,
        parameters: &[(&str, Rational)],
        others: Others,
    ) -> Result<Function, InvalidModel> {
        let bound = Bound::of(self, ModelKind::Motion, state, parameters)?;
        let own = bound.written_out(&self.formulas);
        let mut formulas = Vec::with_capacity(state.dimension());
        for (name, of_state) in bound.names.iter().zip(state.names()) {
            let text = match own.iter().find(|[result, _]| result == name) {
                Some([_, text]) => text.clone(),
                None => match others {
                    Others::Zero => "0".to_owned(),
                    Others::Keep => name.clone(),
                    Others::Refuse => {
                        let (id, component) = (self.id.clone(), of_state.to_owned());
                        return Err(InvalidModel::Other { id, component });
                    }
                },
            };
            formulas.push([of_state.to_owned(), text]);
        }
        bound.function(&self.definitions_for(&bound), &formulas)
    }

    /// The covariance Q of a motion's noise for a state, by rows, as a function of the state and of the step length `T`; zero for
    /// components that the model does not have.
    ///
    /// Source: the row of the model, its parameters bound.
    ///
    /// Example: white acceleration along one axis, and a height that is known.
    ///
    /// ```
    /// use immaculate::model::registry::model;
    /// use immaculate::model::space::{Component, Space};
    /// use immaculate::number::{Field, Rational};
    ///
    /// let state = Space::new(["height", "x", "vx"].map(|name| Component::number(name, "")).to_vec())?;
    /// let noise = model("constant-velocity-white-noise")?.noise(&state, &[("q", Rational::integer(3))])?;
    /// // 3 · 2³/3, 3 · 2²/2, 3 · 2
    /// assert_eq!(noise.at(&[0.0, 0.0, 0.0], &[2.0]), [0.0, 0.0, 0.0, 0.0, 8.0, 6.0, 0.0, 6.0, 6.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`InvalidModel`] as for a motion.
    ///
    /// Evidence: `white_noise_gathers_along_its_motion` (enclosed),
    /// `polynomial_models_are_the_plain_functions_for_all_values` (symbolic).
    pub fn noise(&self, state: &Space, parameters: &[(&str, Rational)]) -> Result<Function, InvalidModel> {
        let bound = Bound::of(self, ModelKind::Noise, state, parameters)?;
        let mut definitions = self.definitions_for(&bound);
        definitions.extend(self.entries_of_input(&bound));
        let mut formulas = Vec::with_capacity(state.dimension() * state.dimension());
        for row in &bound.names {
            for column in &bound.names {
                let text = self.covariance_of(&bound, row, column);
                formulas.push([format!("Q_{row}_{column}"), text.unwrap_or_else(|| "0".to_owned())]);
            }
        }
        bound.function(&definitions, &formulas)
    }

    /// What a sensor gives of a state: the space of the measurement, and h.
    ///
    /// Source: the row of the model, its parameters bound.
    ///
    /// Example: a radar at (100, 0) that sees a target 3 m east and 4 m north of it.
    ///
    /// ```
    /// use immaculate::model::registry::model;
    /// use immaculate::model::space::{Component, Space};
    /// use immaculate::number::{Field, Rational};
    ///
    /// let state = Space::new(["x", "vx", "y", "vy"].map(|name| Component::number(name, "")).to_vec())?;
    /// let radar = model("range-bearing")?;
    /// let (space, h) = radar.measurement(&state, &[("sensor_x", Rational::integer(100))])?;
    /// assert_eq!(space.names(), ["range", "bearing"]);
    /// assert!(space.is_angle(1));
    /// assert_eq!(h.at(&[103.0, 7.0, 4.0, 8.0], &[])[0], 5.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`InvalidModel`] as for a motion.
    ///
    /// Evidence: `every_worked_example_has_the_digits_that_are_written` (enclosed),
    /// `measurements_are_the_plain_function_to_the_bit` (exact).
    pub fn measurement(
        &self,
        state: &Space,
        parameters: &[(&str, Rational)],
    ) -> Result<(Space, Function), InvalidModel> {
        let bound = Bound::of(self, ModelKind::Measurement, state, parameters)?;
        let function = bound.function(&self.definitions_for(&bound), &bound.written_out(&self.formulas))?;
        Ok((Space::new(on_axes(&self.measured, &bound.axes))?, function))
    }

    /// The definitions, those that name an axis for each axis.
    fn definitions_for(&self, bound: &Bound) -> Vec<[String; 2]> {
        let mut written = Vec::new();
        for definition in &self.definitions {
            if definition[0].contains(AXIS) {
                written.extend(bound.written_out(std::slice::from_ref(definition)));
            } else {
                written.push(definition.clone());
            }
        }
        written
    }

    /// The entries of G as definitions, axis by axis.
    fn entries_of_input(&self, bound: &Bound) -> Vec<[String; 2]> {
        let mut definitions = Vec::new();
        for axis in &bound.axes {
            for (ListedComponent(component), row) in self.state.iter().zip(&self.input) {
                for (source, text) in row.iter().enumerate() {
                    definitions.push([
                        entry_of_input(&on_axis(&component.name, axis), source),
                        on_axis(text, axis),
                    ]);
                }
            }
        }
        definitions
    }

    /// The formula of an entry of Q; `None` where it is zero: between axes, and for components that the model does not have.
    fn covariance_of(&self, bound: &Bound, row: &str, column: &str) -> Option<String> {
        let place = |axis: &str, name: &str| {
            self.state
                .iter()
                .position(|ListedComponent(part)| on_axis(&part.name, axis) == name)
        };
        let mut axes = bound.axes.iter();
        let (axis, i, j) = axes.find_map(|axis| Some((axis, place(axis, row)?, place(axis, column)?)))?;
        if let Some(text) = self.covariance.get(i).and_then(|row| row.get(j)) {
            return Some(on_axis(text, axis));
        }
        let mut terms = Vec::new();
        for (source, variance) in self.variances.iter().enumerate() {
            let is_zero = |place: usize| {
                self.input
                    .get(place)
                    .and_then(|row| row.get(source))
                    .is_none_or(|text| text == "0")
            };
            if !is_zero(i) && !is_zero(j) {
                let (left, right) = (entry_of_input(row, source), entry_of_input(column, source));
                terms.push(format!("{variance}*{left}*{right}"));
            }
        }
        (!terms.is_empty()).then(|| terms.join(" + "))
    }
}

/// The components of a list with their axes written out, axis by axis.
fn on_axes(parts: &[ListedComponent], axes: &[String]) -> Vec<Component> {
    let mut written = Vec::with_capacity(parts.len() * axes.len());
    for axis in axes {
        for ListedComponent(part) in parts {
            written.push(Component {
                name: on_axis(&part.name, axis),
                ..part.clone()
            });
        }
    }
    written
}

/// The name of an entry of G.
fn entry_of_input(component: &str, source: usize) -> String {
    format!("G_{component}_{source}")
}

/// A text with its axis.
fn on_axis(text: &str, axis: &str) -> String {
    text.replace(AXIS, axis)
}

/// A model and a state that fit each other.
struct Bound<'a> {
    /// The axes for which the row is written out; an empty one for a row without axes.
    axes: Vec<String>,
    /// The names of the state's components in the formulas: their own, or a number for one that the model does not need.
    names: Vec<String>,
    inputs: &'a [[String; 2]],
    /// The kind says whether there is a step.
    has_step: bool,
    parameters: Vec<(&'a str, Rational)>,
}

impl<'a> Bound<'a> {
    fn of(
        model: &'a Model,
        wanted: ModelKind,
        state: &Space,
        parameters: &[(&str, Rational)],
    ) -> Result<Self, InvalidModel> {
        let id = || model.id.clone();
        if model.kind != wanted {
            let is = model.kind;
            return Err(InvalidModel::Kind { id: id(), is, wanted });
        }
        let axes = axes_of(model, state);
        let needed = on_axes(&model.state, &axes);
        let names: Vec<&str> = needed.iter().map(|component| component.name.as_str()).collect();
        if let Some(lacking) = Lacking::of(&model.id, &names, &state.names()) {
            return Err(lacking.into());
        }
        let mut in_formulas = Vec::with_capacity(state.dimension());
        for (index, component) in state.components().iter().enumerate() {
            let Some(wanted) = needed.iter().find(|needed| needed.name == component.name) else {
                in_formulas.push(format!("_{index}"));
                continue;
            };
            if wanted.kind != component.kind {
                return Err(InvalidModel::ComponentKind {
                    id: id(),
                    component: component.name.clone(),
                    in_state: component.kind,
                    in_model: wanted.kind,
                });
            }
            in_formulas.push(component.name.clone());
        }
        Ok(Self {
            axes,
            names: in_formulas,
            inputs: &model.inputs,
            has_step: wanted != ModelKind::Measurement,
            parameters: values_of(model, parameters)?,
        })
    }

    /// Names and formulas for each axis.
    fn written_out(&self, formulas: &[[String; 2]]) -> Vec<[String; 2]> {
        let mut written = Vec::with_capacity(formulas.len() * self.axes.len());
        for axis in &self.axes {
            for [name, text] in formulas {
                written.push([on_axis(name, axis), on_axis(text, axis)]);
            }
        }
        written
    }

    fn function(&self, definitions: &[[String; 2]], formulas: &[[String; 2]]) -> Result<Function, InvalidModel> {
        fn pairs(texts: &[[String; 2]]) -> Vec<(&str, &str)> {
            texts
                .iter()
                .map(|[name, text]| (name.as_str(), text.as_str()))
                .collect()
        }
        let state: Vec<&str> = self.names.iter().map(String::as_str).collect();
        let step = self.has_step.then_some(STEP).into_iter();
        let given: Vec<&str> = step.chain(self.inputs.iter().map(|[name, _]| name.as_str())).collect();
        let function = Function::of_formulas(&state, &given, &self.parameters, &pairs(definitions), &pairs(formulas))?;
        Ok(function)
    }
}

/// The axes of a row of which the state has a component; the first one if it has none, so that what is lacking can be named. A row without
/// axes has one without a name.
fn axes_of(model: &Model, state: &Space) -> Vec<String> {
    if model.axes.is_empty() {
        return vec![String::new()];
    }
    let is_there = |axis: &&String| {
        let mut names = model
            .state
            .iter()
            .map(|ListedComponent(part)| on_axis(&part.name, axis));
        names.any(|name| state.position(&name).is_some())
    };
    let axes: Vec<String> = model.axes.iter().filter(is_there).cloned().collect();
    if axes.is_empty() {
        model.axes[..1].to_vec()
    } else {
        axes
    }
}

/// The values of a model's parameters, in its order.
fn values_of<'a>(model: &'a Model, given: &[(&str, Rational)]) -> Result<Vec<(&'a str, Rational)>, InvalidModel> {
    let known = || model.parameters.iter().map(|parameter| parameter.name.as_str());
    for (index, (name, _)) in given.iter().enumerate() {
        if !known().any(|parameter| parameter == *name) {
            return Err(InvalidModel::UnknownParameter {
                id: model.id.clone(),
                name: (*name).to_owned(),
                nearest: nearest(name, known()),
            });
        }
        if given[..index].iter().any(|(other, _)| other == name) {
            return Err(InvalidModel::ParameterTwice((*name).to_owned()));
        }
    }
    let mut values = Vec::with_capacity(model.parameters.len());
    for parameter in &model.parameters {
        let value = given
            .iter()
            .find(|(name, _)| *name == parameter.name)
            .map(|(_, value)| value.clone());
        let default = || Rational::from_decimal(parameter.default.as_deref()?);
        let value = value.or_else(default).ok_or_else(|| InvalidModel::MissingParameter {
            id: model.id.clone(),
            name: parameter.name.clone(),
            meaning: parameter.meaning.clone(),
            unit: parameter.unit.clone(),
        })?;
        values.push((parameter.name.as_str(), value));
    }
    Ok(values)
}
