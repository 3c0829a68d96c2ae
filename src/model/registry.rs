//! The named models of `spec/models.toml`, built into the program.
//!
//! A model is found by its name. [`super::binding`] turns its row into a model for a given state.

use super::nearest::nearest;
use super::space::{Component, ComponentKind};
use serde::Deserialize;
use std::sync::LazyLock;
use thiserror::Error;

/// What a model describes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ModelKind {
    /// f, the motion of a state.
    Motion,
    /// Q, the covariance of a motion's noise.
    Noise,
    /// h, what a sensor gives of a state.
    Measurement,
}

impl ModelKind {
    /// The word in the file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Motion => "motion",
            Self::Noise => "noise",
            Self::Measurement => "measurement",
        }
    }
}

/// A row of the file: a model.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Model {
    /// The name under which it is asked for.
    pub id: String,
    /// What it describes.
    pub kind: ModelKind,
    /// For people.
    pub title: String,
    /// The axes for each of which the row holds by itself; empty if it holds once.
    #[serde(default)]
    pub axes: Vec<String>,
    /// The components of the state that it needs.
    pub state: Vec<ListedComponent>,
    /// What a measurement gives.
    #[serde(default)]
    pub measured: Vec<ListedComponent>,
    /// What is given at every step besides the step length: name and unit.
    #[serde(default)]
    pub inputs: Vec<[String; 2]>,
    /// What is bound once.
    #[serde(default)]
    pub parameters: Vec<ModelParameter>,
    /// Names for formulas, in order.
    #[serde(default)]
    pub definitions: Vec<[String; 2]>,
    /// Formulas of a motion or a measurement, each with what it gives.
    #[serde(default)]
    pub formulas: Vec<[String; 2]>,
    /// Q by rows.
    #[serde(default, rename = "Q")]
    pub covariance: Vec<Vec<String>>,
    /// G by rows, in Q = G diag(q) Gᵀ.
    #[serde(default, rename = "G")]
    pub input: Vec<Vec<String>>,
    /// q.
    #[serde(default, rename = "q")]
    pub variances: Vec<String>,
    /// The model in the letters of the literature.
    pub latex: String,
    /// Where it is from.
    pub source: Source,
    /// The plain function of this crate that is the same.
    pub rust: Option<String>,
    /// Limits and choices.
    pub note: Option<String>,
    /// Exact numbers and results.
    #[serde(rename = "example")]
    pub examples: Vec<Example>,
}

/// A component as the file writes it: name, unit, and perhaps `angle`.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(try_from = "Vec<String>")]
pub struct ListedComponent(pub Component);

impl TryFrom<Vec<String>> for ListedComponent {
    type Error = String;

    fn try_from(words: Vec<String>) -> Result<Self, String> {
        let kind = match words.get(2).map(String::as_str) {
            None => ComponentKind::Number,
            Some("angle") => ComponentKind::Angle,
            Some(other) => return Err(format!("`{other}` is no kind of component; there is `angle`")),
        };
        match &words[..] {
            [name, unit] | [name, unit, _] => Ok(Self(Component {
                name: name.clone(),
                unit: unit.clone(),
                kind,
            })),
            _ => Err("a component is a name, a unit, and perhaps `angle`".to_owned()),
        }
    }
}

/// What is bound once.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelParameter {
    /// Its name in the formulas.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// What it is.
    pub meaning: String,
    /// Its value where none is given, as a decimal.
    pub default: Option<String>,
}

/// Where a model is from.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// Who wrote it.
    pub author: String,
    /// Its title.
    pub title: String,
    /// The year.
    pub year: u16,
    /// The equation or section.
    #[serde(rename = "where")]
    pub place: Option<String>,
}

/// A worked example: decimals that are exact, and results with up to 30 digits.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Example {
    /// The components of the state with their values.
    pub state: Vec<[String; 2]>,
    /// The parameters with their values.
    #[serde(default)]
    pub parameters: Vec<[String; 2]>,
    /// The step length and the inputs with their values.
    #[serde(default)]
    pub given: Vec<[String; 2]>,
    /// The values, of a covariance by rows.
    pub result: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    model: Vec<Model>,
}

/// No model has this name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("there is no model `{id}`{}", .nearest.as_ref().map_or_else(String::new, |name| format!("; the nearest name is `{name}`")))]
pub struct UnknownModel {
    /// The name.
    pub id: String,
    /// The nearest one that there is, if one is near.
    pub nearest: Option<String>,
}

static MODELS: LazyLock<Vec<Model>> = LazyLock::new(|| {
    let file: File =
        toml::from_str(include_str!("../../spec/models.toml")).expect("spec/models.toml is part of the program");
    file.model
});

/// All named models, in the order of the file.
pub fn models() -> &'static [Model] {
    &MODELS
}

/// The model of a name.
///
/// Example: a motion, and a slip.
///
/// ```
/// use immaculate::model::registry::model;
///
/// assert_eq!(model("coordinated-turn")?.state.len(), 4);
/// let slip = model("cordinated-turn").unwrap_err();
/// assert_eq!(slip.to_string(), "there is no model `cordinated-turn`; the nearest name is `coordinated-turn`");
/// # Ok::<(), immaculate::model::registry::UnknownModel>(())
/// ```
///
/// # Errors
///
/// [`UnknownModel`] with the nearest name.
pub fn model(id: &str) -> Result<&'static Model, UnknownModel> {
    let found = models().iter().find(|model| model.id == id);
    found.ok_or_else(|| UnknownModel {
        id: id.chars().take(64).collect(),
        nearest: nearest(id, models().iter().map(|model| model.id.as_str())),
    })
}
