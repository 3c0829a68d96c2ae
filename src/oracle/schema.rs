//! The JSON Schemas of the file formats, generated from the types and the table that read the files.
//!
//! A test compares the schemas in `spec/schemas/` with them, so that they cannot drift from the code.

use super::invalid::Class;
use super::problem::{self, ProblemFile};
use super::single;
use super::trace;
use crate::imm::Quantity;
use serde_json::{Map, Value, json};

/// The schema of problem files.
pub fn of_problems() -> Value {
    let mut schema = json!(schemars::schema_for!(ProblemFile));
    schema["properties"]["format"]["enum"] = json!([problem::FORMAT, problem::FORMAT_2]);
    schema["anyOf"] = json!([
        of_format_1(),
        { "properties": { "format": { "const": problem::FORMAT_2 } } },
    ]);
    for key in KEYS_OF_FORMAT_1 {
        if let Some(property) = schema["properties"][key].as_object_mut() {
            property.remove("default");
        }
    }
    // A motion is said in one of three ways.
    let one_motion = json!([{ "required": ["F"] }, { "required": ["f"] }, { "required": ["motion"] }]);
    schema["$defs"]["ModeFile"]["oneOf"] = one_motion.clone();
    with_short_form(&mut schema, &one_motion);
    // So is a conversion, in one of two.
    schema["$defs"]["StateConversionFile"]["oneOf"] = json!([{ "required": ["matrix"] }, { "required": ["formulas"] }]);
    // The key is required, and null says that there is no detection.
    schema["$defs"]["MeasurementAt"]["properties"]["z"]["type"] = json!(["array", "null"]);
    // Whether an estimate has a covariance depends on the filter.
    let kinds = schema["$defs"]["FilterFile"]["oneOf"].as_array().into_iter().flatten();
    let kinds: Vec<Value> = kinds.map(|kind| kind["properties"]["kind"]["const"].clone()).collect();
    let (fixed, others): (Vec<Value>, Vec<Value>) = kinds.into_iter().partition(|kind| kind == "fixed-gain");
    schema["oneOf"] = json!([
        with_estimates(
            &fixed,
            &json!({ "properties": { "mean": {} }, "additionalProperties": false })
        ),
        with_estimates(&others, &json!({ "required": ["covariance"] })),
    ]);
    schema
}

/// The keys that may be absent in format 2 only.
pub(super) const KEYS_OF_FORMAT_1: [&str; 4] = ["about", "flags", "units", "conventions"];

/// A problem of one filter may have what its mode has at the top, and its estimate alone.
fn with_short_form(schema: &mut Value, one_motion: &Value) {
    let of_modes = ["modes", "transition", "rates", "sojourn_times", "jumps"];
    for key in single::KEYS {
        schema["properties"][key] = schema["$defs"]["ModeFile"]["properties"][key].clone();
    }
    if let Some(required) = schema["required"].as_array_mut() {
        required.retain(|key| of_modes.iter().all(|of_modes| key != of_modes));
    }
    let estimate = json!({ "$ref": "#/$defs/EstimateFile" });
    let any_initial = json!({ "anyOf": [schema["properties"]["initial"], estimate.clone()] });
    // A chain is said in one of three ways.
    let one_chain =
        json!([{ "required": ["transition"] }, { "required": ["rates"] }, { "required": ["sojourn_times", "jumps"] }]);
    let initial = json!({ "initial": schema["properties"]["initial"] });
    let long = json!({ "required": ["modes"], "oneOf": one_chain, "properties": initial });
    schema["properties"]["initial"] = any_initial;
    let nothing = |keys: &[&str]| -> Map<String, Value> {
        keys.iter()
            .map(|key| ((*key).to_owned(), json!({ "enum": [] })))
            .collect()
    };
    let mut long = long;
    for (key, never) in nothing(&single::KEYS) {
        long["properties"][key] = never;
    }
    let short = json!({ "required": ["Q"], "oneOf": one_motion, "properties": nothing(&of_modes) });
    schema["allOf"] = json!([{ "oneOf": [long, short] }]);
}

/// What holds in format 1 only: more keys are required, and what is new is not there.
fn of_format_1() -> Value {
    let rows = json!({ "type": "array", "items": { "type": "array", "items": { "type": "number" } } });
    let known = ["name", "F", "Q"].map(|key| (key.to_owned(), json!({})));
    let mut mode = json!({ "properties": Map::from_iter(known), "additionalProperties": false });
    mode["properties"]["Q"] = rows;
    let step = json!({ "properties": { "step": {}, "z": {} }, "additionalProperties": false });
    let required: Vec<&str> = [&KEYS_OF_FORMAT_1[..], &["modes", "transition"]].concat();
    let mut schema = json!({ "required": required, "properties": {
        "format": { "const": problem::FORMAT },
        "state": { "items": { "type": "string" } },
        "modes": { "items": mode },
        "measurement": { "properties": { "kind": { "enum": ["linear", "range-bearing"] } } },
        "filter": { "properties": { "kind": { "enum": ["kalman", "cubature", "unscented", "converted", "fixed-gain"] } } },
        "measurements": { "items": step },
    } });
    // No value is of no type.
    for key in [
        "parameters",
        "let",
        "conversions",
        "interaction",
        "rates",
        "sojourn_times",
        "jumps",
        "sensors",
    ] {
        schema["properties"][key] = json!({ "enum": [] });
    }
    schema
}

/// The schema of a problem of one of these kinds of filter, whose initial estimates have a schema of their own.
fn with_estimates(kinds: &[Value], estimate: &Value) -> Value {
    json!({ "properties": {
        "filter": { "properties": { "kind": { "enum": kinds } } },
        "initial": { "properties": { "modes": { "items": estimate } } },
    } })
}

/// The schema of certified traces.
pub fn of_traces() -> Value {
    let number = json!({ "type": "number" });
    let noise = |_: Quantity| json!({ "type": "number", "exclusiveMinimum": 0 });
    let list = |steps: Value| json!({ "type": "array", "items": steps });
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Trace",
        "description": "What a filter computes, step by step; in certified traces every number is the double nearest to the exact value.",
        "type": "object",
        "properties": {
            "format": { "const": trace::FORMAT },
            "id": { "type": "string", "description": "The id of the problem." },
            "steps": list(step(&|quantity| by_rank(quantity, &number))),
            "scale": list(step(&|quantity| by_rank(quantity, &json!({ "type": "number", "exclusiveMinimum": 0 })))),
            "noise": list(step(&noise)),
            "rejected": {
                "description": "In place of the steps, for a problem that must be rejected.",
                "type": "object",
                "properties": {
                    "class": { "enum": Class::ALL.map(Class::name) },
                    "reason": { "type": "string" },
                },
                "required": ["class", "reason"],
                "additionalProperties": false,
            },
        },
        "required": ["format", "id"],
        "oneOf": [{ "required": ["steps", "scale", "noise"] }, { "required": ["rejected"] }],
        "additionalProperties": false,
    })
}

/// A number, a list or a list of lists, by the rank of a quantity.
fn by_rank(quantity: Quantity, number: &Value) -> Value {
    let list = |items: Value| json!({ "type": "array", "items": items });
    match quantity.rank() {
        0 => number.clone(),
        1 => list(number.clone()),
        _ => list(list(number.clone())),
    }
}

/// The schema of a step whose values have a schema each.
fn step(leaf: &dyn Fn(Quantity) -> Value) -> Value {
    let mut of_all = properties(false, leaf);
    of_all.insert("step".into(), json!({ "type": "integer", "minimum": 1 }));
    let modes = json!({ "type": "array", "items": object(&properties(true, leaf)) });
    of_all.insert("modes".into(), modes);
    let mut schema = object(&of_all);
    schema["required"] = json!(["step"]);
    schema
}

fn object(properties: &Map<String, Value>) -> Value {
    json!({ "type": "object", "properties": properties, "additionalProperties": false })
}

/// The properties for the quantities of a mode, or of all modes together.
fn properties(is_of_mode: bool, leaf: &dyn Fn(Quantity) -> Value) -> Map<String, Value> {
    let mut properties = Map::new();
    for quantity in Quantity::ALL
        .into_iter()
        .filter(|quantity| quantity.is_of_mode() == is_of_mode)
    {
        let mut value = leaf(quantity);
        value["description"] = json!(quantity.equation());
        match quantity.name().split_once('.') {
            None => {
                properties.insert(quantity.name().to_owned(), value);
            }
            Some((outer, inner)) => {
                let nested = properties.entry(outer).or_insert_with(|| object(&Map::new()));
                nested["properties"][inner] = value;
            }
        }
    }
    properties
}
