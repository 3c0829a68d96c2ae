//! The long CSV: one number per line, for users of MATLAB, C, embedded systems and spreadsheets.
//!
//! It says the same as the JSON: `id,step,mode,quantity,row,column,value`, counted from 1 and empty if not applicable.

use super::invalid::{Class, Invalid};
use super::json::is_not_finite;
use super::trace::{Dimensions, Trace};
use crate::imm::Quantity;
use std::borrow::Cow;
use std::fmt::Write;

/// The header of a trace or an answer.
pub const HEADER: &str = "id,step,mode,quantity,row,column,value";

/// Writes a trace. `more` gives further columns for each number, each with a comma before it; `header` their names.
pub fn write(
    id: &str,
    trace: &Trace,
    header: &str,
    more: impl Fn((usize, Quantity, usize), usize) -> String,
) -> String {
    let mut text = format!("{HEADER}{header}\n");
    let id = quoted(id);
    for (step, quantity, mode) in trace.all_places() {
        let Some(values) = trace.get(step, quantity, mode) else {
            continue;
        };
        let mode_number = if quantity.is_of_mode() {
            (mode + 1).to_string()
        } else {
            String::new()
        };
        let columns = trace.dimensions.shape(step, quantity).1;
        for (index, value) in values.iter().enumerate() {
            let (row, column) = match quantity.rank() {
                0 => (String::new(), String::new()),
                1 => ((index + 1).to_string(), String::new()),
                _ => ((index / columns + 1).to_string(), (index % columns + 1).to_string()),
            };
            let name = quantity.name();
            let more = more((step, quantity, mode), index);
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{id},{step},{mode_number},{name},{row},{column},{value:?}{more}");
        }
    }
    text
}

/// A text as a field, in quotes where it needs them.
fn quoted(text: &str) -> Cow<'_, str> {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\"")).into()
    } else {
        text.into()
    }
}

/// The numbers of a trace that were read.
type Seen = super::trace::Table<Vec<bool>>;

/// Reads an answer; the lines of other cases are passed over.
///
/// # Errors
///
/// [`Invalid`] with the line.
pub fn read(text: &str, id: &str, dimensions: &Dimensions) -> Result<Trace, Invalid> {
    let mut seen = Seen::empty(dimensions);
    let mut trace = Trace::empty(dimensions);
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .flexible(true)
        .from_reader(text.as_bytes());
    let header = reader.headers().map_err(|error| bad("line 1", error.to_string()))?;
    let columns = header.len();
    let found: Vec<&str> = header.iter().take(7).collect();
    if found.join(",") != HEADER {
        return Err(bad("line 1", format!("is not {HEADER:?}")));
    }
    for record in reader.records() {
        let record = record.map_err(|error| bad("csv", error.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        let place = format!("line {line}");
        let fields: Vec<&str> = record.iter().collect();
        if fields.len() < 7 {
            return Err(bad(&place, "has fewer than seven columns"));
        }
        // Further columns are passed over, whether the header has them or not; one alone is half of a number.
        if fields.len() == columns + 1 {
            let reason = format!(
                "has {} fields where {columns} are needed: is the value written with a decimal comma?",
                fields.len()
            );
            return Err(bad(&place, reason));
        }
        if fields[0] == id {
            read_line(&mut trace, &mut seen, &fields, &place)?;
        }
    }
    check_complete(&trace, &seen)?;
    Ok(trace)
}

fn bad(place: &str, reason: impl Into<String>) -> Invalid {
    Invalid::new(Class::Format, place, reason)
}

fn read_line(trace: &mut Trace, seen: &mut Seen, fields: &[&str], place: &str) -> Result<(), Invalid> {
    let Some(quantity) = Quantity::ALL.into_iter().find(|quantity| quantity.name() == fields[3]) else {
        return Err(bad(place, format!("has {:?}, which is not a quantity", fields[3])));
    };
    let count = |column: usize, most: usize, is_there: bool| -> Result<usize, Invalid> {
        if !is_there || (fields[column].is_empty() && most == 1) {
            return Ok(0);
        }
        let number = fields[column]
            .parse::<f64>()
            .ok()
            .filter(|number| number.fract() == 0.0 && *number >= 1.0);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number, and small"
        )]
        let number = number.map(|number| number as usize).filter(|&number| number <= most);
        number.map(|number| number - 1).ok_or_else(|| {
            let names = ["id", "step", "mode", "quantity", "row", "column"];
            bad(
                place,
                format!("has {} {:?}; it must be 1 to {most}", names[column], fields[column]),
            )
        })
    };
    let step = count(1, trace.dimensions.steps(), true)? + 1;
    let (rows, columns) = trace.dimensions.shape(step, quantity);
    let mode = count(2, trace.dimensions.r, quantity.is_of_mode())?;
    let row = count(4, rows, quantity.rank() > 0)?;
    let column = count(5, columns, quantity.rank() > 1)?;
    let value = match fields[6] {
        "" => f64::NAN,
        word if is_not_finite(word) => f64::NAN,
        word => word
            .parse()
            .map_err(|_| bad(place, format!("has value {word:?}, which is not a number")))?,
    };
    let mut places = seen
        .get(step, quantity, mode)
        .cloned()
        .unwrap_or_else(|| vec![false; rows * columns]);
    if std::mem::replace(&mut places[row * columns + column], true) {
        return Err(bad(place, "has a number that an earlier line has, too"));
    }
    seen.set(step, quantity, mode, places);
    let mut values = trace
        .get(step, quantity, mode)
        .cloned()
        .unwrap_or_else(|| vec![f64::NAN; rows * columns]);
    values[row * columns + column] = value;
    trace.set(step, quantity, mode, values);
    Ok(())
}

/// A quantity is shown whole or not at all, and each of its numbers once.
fn check_complete(trace: &Trace, seen: &Seen) -> Result<(), Invalid> {
    for (step, quantity, mode) in trace.all_places() {
        let (rows, columns) = trace.dimensions.shape(step, quantity);
        let Some(places) = seen.get(step, quantity, mode) else {
            continue;
        };
        let found = places.iter().filter(|is_there| **is_there).count();
        if found != rows * columns {
            let place = format!("step {step}, mode {}, {}", mode + 1, quantity.name());
            let reason = format!("has {found} lines where {rows} × {columns} numbers are needed");
            return Err(Invalid::new(Class::Shape, place, reason));
        }
    }
    Ok(())
}
