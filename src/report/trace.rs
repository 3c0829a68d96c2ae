//! A trace as text: step by step, every value under its name, with its equations.
//!
//! A step is printed in the order of the cycle. Each value has its name from the file format and the printed numbers of its equation, so
//! that you can read a paper beside it.

use super::wrapped;
use crate::imm::Quantity;
use crate::oracle::models::ComponentFile;
use crate::oracle::problem::ProblemFile;
use crate::oracle::trace::Table;
use std::fmt::Write;

/// The trace of a problem, its numbers already written.
pub fn text(problem: &ProblemFile, values: &Table<Vec<String>>) -> String {
    let dimensions = &values.dimensions;
    let mut text = format!("{}\n", problem.id);
    if !problem.about.is_empty() {
        text.push_str(&wrapped(&problem.about, "  "));
    }
    let _ = writeln!(text, "{}", states(problem));
    for step in 1..=dimensions.steps() {
        let detection = match problem.measurements.get(step - 1).and_then(|entry| entry.z.as_ref()) {
            Some(z) => {
                let of_entry = |entry: &Option<f64>| entry.map_or("missing".to_owned(), |value| format!("{value:?}"));
                format!("z = [{}]", z.iter().map(of_entry).collect::<Vec<_>>().join(", "))
            }
            None => "no detection".into(),
        };
        let _ = writeln!(text, "\nstep {step}: {detection}");
        for quantity in Quantity::ALL {
            let modes = if quantity.is_of_mode() { dimensions.r } else { 1 };
            let Some(first) = (0..modes).find(|&mode| values.get(step, quantity, mode).is_some()) else {
                continue;
            };
            let equation = problem.equation(quantity, first);
            let _ = writeln!(text, "  {}  —  {equation}", quantity.name());
            for mode in 0..modes {
                let Some(numbers) = values.get(step, quantity, mode) else {
                    continue;
                };
                let label = if quantity.is_of_mode() {
                    problem.modes[mode].name.as_str()
                } else {
                    ""
                };
                let columns = if quantity.rank() == 2 {
                    dimensions.shape(step, quantity).1
                } else {
                    numbers.len()
                };
                write_rows(&mut text, label, numbers, columns);
            }
        }
    }
    text
}

/// Rows of numbers in columns, with a label before the first.
fn write_rows(text: &mut String, label: &str, numbers: &[String], columns: usize) {
    let width = numbers.iter().map(|number| number.chars().count()).max().unwrap_or(0);
    for (index, row) in numbers.chunks(columns).enumerate() {
        let label = if index == 0 { label } else { "" };
        let row: Vec<String> = row.iter().map(|number| format!("{number:>width$}")).collect();
        let _ = writeln!(text, "    {label:<20} {}", row.join("  "));
    }
}

/// The components of the state, and of each mode that has its own, with their units where they have any.
fn states(problem: &ProblemFile) -> String {
    let units = &problem.units;
    let mut text = format!("state {}", state(&problem.state, units));
    for mode in &problem.modes {
        if let Some(own) = &mode.models.state {
            let _ = write!(text, "\nstate of {} {}", mode.name, state(own, &[]));
        }
    }
    text
}

fn state(components: &[ComponentFile], units: &[String]) -> String {
    let names: Vec<&str> = components.iter().map(|component| component.name.as_str()).collect();
    let own = components
        .iter()
        .map(|component| component.unit.as_deref().unwrap_or("1"));
    let units: Vec<&str> = if units.is_empty() {
        own.collect()
    } else {
        units.iter().map(String::as_str).collect()
    };
    format!("{} in {}", names.join(", "), units.join(", "))
}
