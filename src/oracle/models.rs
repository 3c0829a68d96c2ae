//! The additions of format 2 to problem files: components with units and angles, formulas, named models, and changes from step to step.
//!
//! This file has the keys. `bound` uses them, and `well_formed` checks them.

use super::problem::{FilterFile, ModeFile, Rows, if_there_at_all};
use crate::model::space::{Component, ComponentKind};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::fmt;

/// A component of a state or of a measurement: `"x"`, `["x", "m"]` or `["psi", "rad", "angle"]`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ComponentFile {
    /// The name under which formulas know it.
    pub name: String,
    /// Its unit.
    pub unit: Option<String>,
    /// Whether it is an angle.
    pub kind: ComponentKind,
}

impl From<&str> for ComponentFile {
    fn from(name: &str) -> Self {
        name.to_owned().into()
    }
}

impl From<String> for ComponentFile {
    fn from(name: String) -> Self {
        let (unit, kind) = (None, ComponentKind::Number);
        Self { name, unit, kind }
    }
}

impl ComponentFile {
    /// The component, with a unit from elsewhere if it has none of its own.
    pub(super) fn component(&self, unit: Option<&String>) -> Component {
        Component {
            name: self.name.clone(),
            unit: self.unit.as_ref().or(unit).cloned().unwrap_or_default(),
            kind: self.kind,
        }
    }
}

impl Serialize for ComponentFile {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match (&self.unit, self.kind) {
            (None, _) => serializer.serialize_str(&self.name),
            (Some(unit), ComponentKind::Number) => [&self.name, unit].serialize(serializer),
            (Some(unit), ComponentKind::Angle) => [self.name.as_str(), unit, "angle"].serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for ComponentFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = ComponentFile;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a string")
            }
            fn visit_str<E: Error>(self, name: &str) -> Result<ComponentFile, E> {
                Ok(name.into())
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<ComponentFile, A::Error> {
                let words = Vec::<String>::deserialize(SeqAccessDeserializer::new(list))?;
                let (name, unit, kind) = match &words[..] {
                    [name, unit] => (name, unit, ComponentKind::Number),
                    [name, unit, kind] if kind == "angle" => (name, unit, ComponentKind::Angle),
                    _ => return Err(A::Error::custom("is not a name, a unit and perhaps \"angle\"")),
                };
                let (name, unit) = (name.clone(), Some(unit.clone()));
                Ok(ComponentFile { name, unit, kind })
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

impl JsonSchema for ComponentFile {
    fn schema_name() -> Cow<'static, str> {
        "ComponentFile".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A component: its name, or name and unit, or name, `rad` and `angle`.",
            "oneOf": [
                { "type": "string" },
                { "type": "array", "items": { "type": "string" }, "minItems": 2, "maxItems": 2 },
                {
                    "type": "array",
                    "prefixItems": [{ "type": "string" }, { "const": "rad" }, { "const": "angle" }],
                    "minItems": 3,
                    "maxItems": 3,
                },
            ],
        })
    }
}

/// Names with their numbers, in the order of the file. A name stands once.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModelParameters(pub Vec<(String, f64)>);

impl ModelParameters {
    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The number of a name.
    pub fn get(&self, name: &str) -> Option<f64> {
        self.0.iter().find(|(own, _)| own == name).map(|(_, value)| *value)
    }
}

impl Serialize for ModelParameters {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in &self.0 {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for ModelParameters {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = ModelParameters;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("names with their numbers")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<ModelParameters, A::Error> {
                let mut parameters = ModelParameters::default();
                while let Some((name, value)) = map.next_entry::<String, f64>()? {
                    if parameters.get(&name).is_some() {
                        return Err(A::Error::custom(format!("has the name `{name}` twice")));
                    }
                    parameters.0.push((name, value));
                }
                Ok(parameters)
            }
        }
        deserializer.deserialize_map(Reader)
    }
}

impl JsonSchema for ModelParameters {
    fn schema_name() -> Cow<'static, str> {
        "Parameters".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "Names with their numbers.",
            "type": "object",
            "additionalProperties": { "type": "number" },
        })
    }
}

/// A model of `spec/models.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModelFile {
    /// Its name.
    pub model: String,
    /// Its parameters.
    #[serde(default, skip_serializing_if = "ModelParameters::is_empty")]
    pub parameters: ModelParameters,
    /// Of a motion: what becomes of the components of the state that the model does not have. Absent, there may be none.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "OthersFile")]
    pub others: Option<OthersFile>,
}

/// What becomes of components of the state that a motion does not have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OthersFile {
    /// They become zero.
    Zero,
    /// They stay as they are.
    Keep,
}

/// Q in another form than a matrix of numbers.
#[derive(Debug, Clone, PartialEq)]
pub enum NoiseFile {
    /// Numbers by rows.
    Matrix(Rows),
    /// Formulas by rows.
    Formulas(Vec<Vec<String>>),
    /// A named model.
    Model(ModelFile),
}

/// An entry of Q: a number or a formula.
enum Entry {
    Number(f64),
    Formula(String),
}

impl<'de> Deserialize<'de> for Entry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl Visitor<'_> for Reader {
            type Value = Entry;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("f64")
            }
            #[allow(clippy::cast_precision_loss, reason = "as every reader of numbers does")]
            fn visit_u64<E: Error>(self, value: u64) -> Result<Entry, E> {
                Ok(Entry::Number(value as f64))
            }
            #[allow(clippy::cast_precision_loss, reason = "as every reader of numbers does")]
            fn visit_i64<E: Error>(self, value: i64) -> Result<Entry, E> {
                Ok(Entry::Number(value as f64))
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Entry, E> {
                Ok(Entry::Number(value))
            }
            fn visit_str<E: Error>(self, text: &str) -> Result<Entry, E> {
                Ok(Entry::Formula(text.to_owned()))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

impl NoiseFile {
    /// A matrix if all entries are numbers; numbers among formulas are formulas, too.
    fn of(rows: Vec<Vec<Entry>>) -> Self {
        let is_formula = |entry: &Entry| matches!(entry, Entry::Formula(_));
        if rows.iter().flatten().any(is_formula) {
            let text = |entry| match entry {
                Entry::Number(value) => format!("{value:?}"),
                Entry::Formula(text) => text,
            };
            let row = |row: Vec<Entry>| row.into_iter().map(text).collect();
            return Self::Formulas(rows.into_iter().map(row).collect());
        }
        let number = |entry| match entry {
            Entry::Number(value) => Some(value),
            Entry::Formula(_) => None,
        };
        let row = |row: Vec<Entry>| row.into_iter().filter_map(number).collect();
        Self::Matrix(rows.into_iter().map(row).collect())
    }
}

impl Serialize for NoiseFile {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Matrix(rows) => rows.serialize(serializer),
            Self::Formulas(rows) => rows.serialize(serializer),
            Self::Model(model) => model.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for NoiseFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = NoiseFile;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a sequence")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<NoiseFile, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(NoiseFile::of)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<NoiseFile, A::Error> {
                ModelFile::deserialize(MapAccessDeserializer::new(map)).map(NoiseFile::Model)
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

impl JsonSchema for NoiseFile {
    fn schema_name() -> Cow<'static, str> {
        "NoiseFile".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let model = generator.subschema_for::<ModelFile>();
        json_schema!({
            "anyOf": [
                { "type": "array", "items": { "type": "array", "items": { "type": ["number", "string"] } } },
                model,
            ],
        })
    }
}

/// What a mode of format 2 may have beside, or in place of, its two matrices.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModeModels {
    /// The components of the mode's own state, if it is another than the problem's.
    pub state: Option<Vec<ComponentFile>>,
    /// f by formulas, one a component of the state, in place of F.
    pub formulas: Option<Vec<String>>,
    /// f by the name of a model, in place of F.
    pub motion: Option<ModelFile>,
    /// Q by formulas or by the name of a model, in place of its matrix.
    pub noise: Option<NoiseFile>,
    /// Names for formulas: each a name and a formula of what stands before it.
    pub definitions: Vec<[String; 2]>,
    /// Names with numbers, known in this mode.
    pub parameters: ModelParameters,
    /// The filter of this mode, if it is another than the problem's.
    pub filter: Option<FilterFile>,
    /// M = E[w vᵀ] of the noises of motion and measurement, if they are correlated.
    pub noise_cross_covariance: Option<Rows>,
}

/// A mode as it stands in the file.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ModeFile")]
pub(super) struct ModeKeys {
    /// Its name.
    name: String,
    /// The components of its own state, if it is another than the problem's; as many.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "Vec<ComponentFile>")]
    state: Option<Vec<ComponentFile>>,
    /// Transition matrix, n × n; in format 2 `f` or `motion` may stand in its place.
    #[serde(
        default,
        rename = "F",
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "Rows")]
    transition: Option<Rows>,
    /// n formulas.
    #[serde(
        default,
        rename = "f",
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "Vec<String>")]
    formulas: Option<Vec<String>>,
    /// A named model.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "ModelFile")]
    motion: Option<ModelFile>,
    /// Covariance of the process noise, n × n: numbers; in format 2 formulas or a named model, too.
    #[serde(rename = "Q")]
    noise: NoiseFile,
    /// Names for formulas.
    #[serde(default, rename = "let", skip_serializing_if = "Vec::is_empty")]
    definitions: Vec<[String; 2]>,
    /// Names with numbers.
    #[serde(default, skip_serializing_if = "ModelParameters::is_empty")]
    parameters: ModelParameters,
    /// The filter of this mode, if it is another than the problem's.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "FilterFile")]
    filter: Option<FilterFile>,
    /// Covariance of process and measurement noise, n × m.
    #[serde(
        default,
        rename = "M",
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "Rows")]
    noise_cross_covariance: Option<Rows>,
}

impl TryFrom<ModeKeys> for ModeFile {
    type Error = &'static str;

    fn try_from(keys: ModeKeys) -> Result<Self, &'static str> {
        let ways = [
            keys.transition.is_some(),
            keys.formulas.is_some(),
            keys.motion.is_some(),
        ];
        match ways.iter().filter(|is_there| **is_there).count() {
            0 => return Err("missing field `F`"),
            1 => {}
            _ => return Err("has more than one of `F`, `f` and `motion`; a motion is said once"),
        }
        let (noise, other_noise) = match keys.noise {
            NoiseFile::Matrix(rows) => (rows, None),
            other => (Rows::new(), Some(other)),
        };
        Ok(Self {
            name: keys.name,
            transition: keys.transition.unwrap_or_default(),
            noise,
            models: ModeModels {
                state: keys.state,
                formulas: keys.formulas,
                motion: keys.motion,
                noise: other_noise,
                definitions: keys.definitions,
                parameters: keys.parameters,
                filter: keys.filter,
                noise_cross_covariance: keys.noise_cross_covariance,
            },
        })
    }
}

impl From<ModeFile> for ModeKeys {
    fn from(mode: ModeFile) -> Self {
        let is_otherwise = mode.models.formulas.is_some() || mode.models.motion.is_some();
        Self {
            name: mode.name,
            state: mode.models.state,
            transition: (!is_otherwise).then_some(mode.transition),
            formulas: mode.models.formulas,
            motion: mode.models.motion,
            noise: mode.models.noise.unwrap_or(NoiseFile::Matrix(mode.noise)),
            definitions: mode.models.definitions,
            parameters: mode.models.parameters,
            filter: mode.models.filter,
            noise_cross_covariance: mode.models.noise_cross_covariance,
        }
    }
}
