//! Traces in memory and as JSON: the values of a filter, step by step, under the names of [`Quantity`].
//!
//! This reads and writes the format `immaculate-trace/1`. Traces of other programs are read leniently: a scalar for a 1 × 1 matrix, an
//! object for a list of one, any nesting with the right count of numbers.

use super::invalid::{Class, Invalid};
use super::json::is_not_finite;
pub use super::json::{NotJson, read_json};
use crate::imm::{Needs, Quantity};
use crate::number::Real;
use serde::Serialize;
use serde_json::{Map, Value, json};

/// The format of trace files.
pub const FORMAT: &str = "immaculate-trace/1";

/// The dimensions of the problem that a trace belongs to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dimensions {
    /// Entries of the state.
    pub n: usize,
    /// Modes.
    pub r: usize,
    /// Entries of the measurement of each step: sensors differ.
    pub m: Vec<usize>,
}

impl Dimensions {
    /// Those of a problem with one sensor: entries of the state and of the measurement, modes, and steps.
    pub fn new(n: usize, m: usize, r: usize, steps: usize) -> Self {
        let m = vec![m; steps];
        Self { n, r, m }
    }

    /// Steps.
    pub fn steps(&self) -> usize {
        self.m.len()
    }

    /// Rows and columns of a quantity in a step, which counts from 1.
    pub fn shape(&self, step: usize, quantity: Quantity) -> (usize, usize) {
        let m = self.m.get(step - 1).copied().unwrap_or(0);
        quantity.shape(self.n, m, self.r)
    }

    /// The numbers of a trace in which everything is shown.
    pub fn numbers(&self) -> usize {
        let mut numbers: usize = 0;
        for step in 1..=self.steps() {
            for quantity in Quantity::ALL {
                let (rows, columns) = self.shape(step, quantity);
                let modes = if quantity.is_of_mode() { self.r } else { 1 };
                numbers = numbers.saturating_add(rows.saturating_mul(columns).saturating_mul(modes));
            }
        }
        numbers
    }
}

/// One value for each step, quantity and mode, where there is one.
#[derive(Debug, Clone, PartialEq)]
pub struct Table<V> {
    /// The dimensions of the problem.
    pub dimensions: Dimensions,
    cells: Vec<Option<V>>,
}

/// The numbers of a trace, by rows.
pub type Trace = Table<Vec<f64>>;

impl<V> Table<V> {
    /// A table in which nothing is shown.
    pub fn empty(dimensions: &Dimensions) -> Self {
        let cells = dimensions.steps() * Quantity::ALL.len() * dimensions.r;
        Self {
            dimensions: dimensions.clone(),
            cells: std::iter::repeat_with(|| None).take(cells).collect(),
        }
    }

    /// The place of a value; steps count from 1, and a quantity of all modes stands at mode 0.
    fn place(&self, step: usize, quantity: Quantity, mode: usize) -> usize {
        ((step - 1) * Quantity::ALL.len() + quantity as usize) * self.dimensions.r + mode
    }

    /// The value of a quantity, if there is one.
    pub fn get(&self, step: usize, quantity: Quantity, mode: usize) -> Option<&V> {
        self.cells
            .get(self.place(step, quantity, mode))
            .and_then(Option::as_ref)
    }

    /// Sets a value.
    pub fn set(&mut self, step: usize, quantity: Quantity, mode: usize, value: V) {
        let place = self.place(step, quantity, mode);
        if let Some(cell) = self.cells.get_mut(place) {
            *cell = Some(value);
        }
    }

    /// All places of a step in the order in which they are computed: quantity by quantity, mode by mode.
    pub fn places(&self, step: usize) -> impl Iterator<Item = (usize, Quantity, usize)> + use<V> {
        let r = self.dimensions.r;
        Quantity::ALL.into_iter().flat_map(move |quantity| {
            let modes = if quantity.is_of_mode() { r } else { 1 };
            (0..modes).map(move |mode| (step, quantity, mode))
        })
    }

    /// All places of all steps.
    pub fn all_places(&self) -> impl Iterator<Item = (usize, Quantity, usize)> + use<'_, V> {
        (1..=self.dimensions.steps()).flat_map(|step| self.places(step))
    }

    /// A table with another value in each place that has one.
    pub fn map<W>(&self, mut other: impl FnMut((usize, Quantity, usize), &V) -> W) -> Table<W> {
        let mut table = Table::empty(&self.dimensions);
        for place in self.all_places() {
            if let Some(value) = self.get(place.0, place.1, place.2) {
                table.set(place.0, place.1, place.2, other(place, value));
            }
        }
        table
    }

    /// The first steps alone.
    #[must_use]
    pub fn beginning(&self, steps: usize) -> Self
    where
        V: Clone,
    {
        let dimensions = Dimensions {
            m: self.dimensions.m.iter().take(steps).copied().collect(),
            ..self.dimensions.clone()
        };
        let mut table = Self::empty(&dimensions);
        for (cell, own) in table.cells.iter_mut().zip(&self.cells) {
            cell.clone_from(own);
        }
        table
    }

    /// Whether there is a value that needs something.
    pub(super) fn holds(&self, needed: Needs) -> bool {
        let mut places = self.all_places();
        places.any(|(step, quantity, mode)| quantity.needs(needed) && self.get(step, quantity, mode).is_some())
    }

    /// Without the values that need something.
    #[must_use]
    pub(super) fn without(&self, needed: Needs) -> Self
    where
        V: Clone,
    {
        let mut table = Self::empty(&self.dimensions);
        for (step, quantity, mode) in self.all_places().filter(|place| !place.1.needs(needed)) {
            if let Some(value) = self.get(step, quantity, mode) {
                table.set(step, quantity, mode, value.clone());
            }
        }
        table
    }

    /// The number of values.
    pub fn count(&self) -> usize {
        self.cells.iter().filter(|cell| cell.is_some()).count()
    }

    /// The list of steps as JSON; `leaf` writes a value.
    pub fn to_json(&self, leaf: impl Fn((usize, Quantity), &V) -> Value) -> Vec<Value> {
        let r = self.dimensions.r;
        (1..=self.dimensions.steps())
            .map(|step| {
                let mut whole = Map::new();
                whole.insert("step".into(), json!(step));
                let mut modes = vec![Map::new(); r];
                for (step, quantity, mode) in self.places(step) {
                    let Some(value) = self.get(step, quantity, mode) else {
                        continue;
                    };
                    let value = leaf((step, quantity), value);
                    if quantity.is_of_mode() {
                        // The modes stand where the first of their values is computed.
                        whole.entry("modes").or_insert(Value::Null);
                        insert(&mut modes[mode], quantity.name(), value);
                    } else {
                        insert(&mut whole, quantity.name(), value);
                    }
                }
                if let Some(place) = whole.get_mut("modes") {
                    *place = modes.into_iter().map(Value::Object).collect();
                }
                Value::Object(whole)
            })
            .collect()
    }
}

/// Inserts a value under a name that may have a dot.
fn insert(object: &mut Map<String, Value>, name: &str, value: Value) {
    match name.split_once('.') {
        None => {
            object.insert(name.to_owned(), value);
        }
        Some((outer, inner)) => {
            let nested = object.entry(outer).or_insert_with(|| Value::Object(Map::new()));
            if let Value::Object(nested) = nested {
                nested.insert(inner.to_owned(), value);
            }
        }
    }
}

/// The numbers of a quantity as JSON: a number, a list, or a list of rows (one of length one, too).
pub fn numbers_as_json<X: Serialize>((step, quantity): (usize, Quantity), of: &Dimensions, values: &[X]) -> Value {
    match quantity.rank() {
        0 => json!(values[0]),
        1 => json!(values),
        _ => values
            .chunks(of.shape(step, quantity).1)
            .map(|row| json!(row))
            .collect(),
    }
}

impl Trace {
    /// Checks that the trace has a problem's dimensions, and every value its own.
    ///
    /// # Errors
    ///
    /// [`Invalid`] with the place.
    pub fn check(&self, dimensions: &Dimensions) -> Result<(), Invalid> {
        if self.dimensions != *dimensions {
            let reason = format!("has {:?} where the problem has {dimensions:?}", self.dimensions);
            return Err(Invalid::new(Class::Shape, "trace", reason));
        }
        for (step, quantity, mode) in self.all_places() {
            let (rows, columns) = dimensions.shape(step, quantity);
            let found = self.get(step, quantity, mode).map_or(rows * columns, Vec::len);
            if found != rows * columns {
                let place = format!("step {step}, mode {mode}: {}", quantity.name());
                let reason = format!("has {found} numbers where {rows} × {columns} are needed");
                return Err(Invalid::new(Class::Shape, place, reason));
            }
        }
        Ok(())
    }

    /// The numbers of a quantity if there are any and all are finite.
    pub fn finite(&self, step: usize, quantity: Quantity, mode: usize) -> Option<&Vec<f64>> {
        let values = self.get(step, quantity, mode);
        values.filter(|values| values.iter().all(|value| value.is_finite()))
    }

    /// The list of steps as JSON.
    pub fn steps_as_json(&self) -> Vec<Value> {
        self.to_json(|place, values| numbers_as_json(place, &self.dimensions, values))
    }

    /// Reads the list of steps of a trace or an answer, with patience. What is not finite becomes NaN.
    ///
    /// Example: one mode, one state, one measurement: a 1 × 1 matrix may come as a number, a list of one mode as an object.
    ///
    /// ```
    /// use immaculate::imm::Quantity;
    /// use immaculate::oracle::trace::{Dimensions, Trace};
    /// use serde_json::json;
    ///
    /// let dimensions = Dimensions::new(1, 1, 1, 1);
    /// let steps = json!([{ "step": 1, "modes": { "gain": 0.75 } }]);
    /// let trace = Trace::from_json(&steps, &dimensions).unwrap();
    /// assert_eq!(trace.get(1, Quantity::Gain, 0), Some(&vec![0.75]));
    /// ```
    ///
    /// # Errors
    ///
    /// [`Invalid`] with the place, for a key that does not exist, a step that does not exist or comes twice, and a wrong count of numbers.
    pub fn from_json(steps: &Value, dimensions: &Dimensions) -> Result<Self, Invalid> {
        let steps_of_problem = dimensions.steps();
        let mut trace = Self::empty(dimensions);
        let mut seen = vec![false; steps_of_problem];
        for (index, step) in as_list(steps).iter().enumerate() {
            let place = format!("steps[{index}]");
            let object = as_object(step, &place)?;
            let number = object.get("step").and_then(whole_number).ok_or_else(|| {
                Invalid::new(
                    Class::Shape,
                    format!("{place}.step"),
                    "is missing, or not a whole number",
                )
            })?;
            if number == 0 || number > steps_of_problem {
                let reason = format!("is {number}, but the problem has steps 1 to {steps_of_problem}");
                return Err(Invalid::new(Class::Shape, format!("{place}.step"), reason));
            }
            if std::mem::replace(&mut seen[number - 1], true) {
                let reason = format!("is {number} a second time");
                return Err(Invalid::new(Class::Shape, format!("{place}.step"), reason));
            }
            read_step(&mut trace, number, object, &place)?;
        }
        Ok(trace)
    }
}

fn read_step(trace: &mut Trace, step: usize, object: &Map<String, Value>, place: &str) -> Result<(), Invalid> {
    for (key, value) in object {
        let place = format!("{place}.{key}");
        match key.as_str() {
            "step" => {}
            "modes" => {
                let modes = as_list(value);
                let r = trace.dimensions.r;
                if modes.len() != r {
                    let reason = format!("has {} entries where there are {r} modes", modes.len());
                    return Err(Invalid::new(Class::Shape, place, reason));
                }
                for (mode, value) in modes.iter().enumerate() {
                    let place = format!("{place}[{mode}]");
                    for (key, value) in as_object(value, &place)? {
                        read_key(trace, (step, Some(mode)), key, value, &format!("{place}.{key}"))?;
                    }
                }
            }
            _ => read_key(trace, (step, None), key, value, &place)?,
        }
    }
    Ok(())
}

/// Reads a quantity, or the two quantities under one key.
fn read_key(
    trace: &mut Trace,
    at: (usize, Option<usize>),
    key: &str,
    value: &Value,
    place: &str,
) -> Result<(), Invalid> {
    let of_this_kind = |quantity: &&Quantity| quantity.is_of_mode() == at.1.is_some();
    let named = |name: &str| {
        Quantity::ALL
            .iter()
            .filter(of_this_kind)
            .find(|q| q.name() == name)
            .copied()
    };
    let is_nested = Quantity::ALL
        .iter()
        .filter(of_this_kind)
        .any(|quantity| quantity.name().split_once('.').is_some_and(|(outer, _)| outer == key));
    if let Some(quantity) = named(key).filter(|_| !key.contains('.')) {
        return read_numbers(trace, at, quantity, value, place);
    }
    if is_nested {
        for (inner, value) in as_object(value, place)? {
            let place = format!("{place}.{inner}");
            let Some(quantity) = named(&format!("{key}.{inner}")) else {
                return Err(unknown_key(place));
            };
            read_numbers(trace, at, quantity, value, &place)?;
        }
        return Ok(());
    }
    if key == "likelihood" && at.1.is_some() {
        return read_likelihood(trace, at, value, place);
    }
    Err(unknown_key(place.to_owned()))
}

/// Reads a likelihood as its logarithm, unless that is shown too. What is below the normal numbers has lost its digits, or has become zero:
/// of it nothing is known.
fn read_likelihood(trace: &mut Trace, at: (usize, Option<usize>), value: &Value, place: &str) -> Result<(), Invalid> {
    let quantity = Quantity::LogLikelihood;
    if trace.get(at.0, quantity, at.1.unwrap_or(0)).is_some() {
        return Ok(());
    }
    let mut numbers = Vec::new();
    flatten(value, place, &mut numbers)?;
    if numbers.iter().any(|number| (0.0..f64::MIN_POSITIVE).contains(number)) {
        return Ok(());
    }
    let logarithms: Vec<f64> = numbers.iter().map(Real::ln).collect();
    read_numbers(trace, at, quantity, &json!(logarithms), place)
}

fn unknown_key(place: String) -> Invalid {
    Invalid::new(Class::Format, place, "is not a key of a trace")
}

fn read_numbers(
    trace: &mut Trace,
    at: (usize, Option<usize>),
    quantity: Quantity,
    value: &Value,
    place: &str,
) -> Result<(), Invalid> {
    let (rows, columns) = trace.dimensions.shape(at.0, quantity);
    let mut numbers = Vec::new();
    flatten(value, place, &mut numbers)?;
    if numbers.is_empty() {
        // An empty list is how some writers say that there is nothing.
        return Ok(());
    }
    if numbers.len() == 1 && rows * columns > 1 && numbers[0].is_nan() {
        // One null for the whole quantity: it is not finite as a whole.
        numbers = vec![f64::NAN; rows * columns];
    }
    if numbers.len() != rows * columns {
        let reason = format!("has {} numbers where {rows} × {columns} are needed", numbers.len());
        return Err(Invalid::new(Class::Shape, place, reason));
    }
    trace.set(at.0, quantity, at.1.unwrap_or(0), numbers);
    Ok(())
}

/// The numbers of a value in the order in which they stand; null and the words for what is not finite become NaN.
fn flatten(value: &Value, place: &str, numbers: &mut Vec<f64>) -> Result<(), Invalid> {
    match value {
        Value::Null => numbers.push(f64::NAN),
        Value::Number(number) => numbers.push(number.as_f64().unwrap_or(f64::NAN)),
        Value::String(word) if is_not_finite(word) => numbers.push(f64::NAN),
        Value::Array(list) => {
            for (index, value) in list.iter().enumerate() {
                flatten(value, &format!("{place}[{index}]"), numbers)?;
            }
        }
        _ => return Err(Invalid::new(Class::Format, place, "is not a number")),
    }
    Ok(())
}

/// Whether two numbers are the same as they were read: bit for bit, but that nothing is known of what is not finite.
pub(super) fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || !a.is_finite() && !b.is_finite()
}

/// A list, or one value as a list of one.
fn as_list(value: &Value) -> Vec<&Value> {
    match value {
        Value::Array(list) => list.iter().collect(),
        value => vec![value],
    }
}

fn as_object<'a>(value: &'a Value, place: &str) -> Result<&'a Map<String, Value>, Invalid> {
    value
        .as_object()
        .ok_or_else(|| Invalid::new(Class::Format, place, "is not an object"))
}

/// A whole number, written as 3 or as 3.0.
fn whole_number(value: &Value) -> Option<usize> {
    let number = value.as_f64()?;
    let is_whole = number >= 0.0 && number.fract() == 0.0 && number < 1e9;
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number below 10⁹"
    )]
    is_whole.then_some(number as usize)
}
