//! A trace as literals of a programming language, to paste into a unit test.
//!
//! Every number is the shortest decimal that reads as the same double.

use crate::imm::Quantity;
use crate::oracle::trace::Trace;
use std::fmt::Write;

/// A language.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Language {
    /// C and C++: constant arrays.
    C,
    /// Python: a dictionary.
    Python,
    /// MATLAB and Octave: a structure.
    Matlab,
    /// Rust: constants.
    Rust,
}

impl Language {
    /// What begins a comment.
    fn comment(self) -> &'static str {
        match self {
            Self::C | Self::Rust => "//",
            Self::Python => "#",
            Self::Matlab => "%",
        }
    }

    /// A statement that gives a value of a step, and of a mode where it has one, its numbers.
    fn statement(self, (step, quantity, mode): (usize, Quantity, usize), values: &Values) -> String {
        let of_mode = quantity.is_of_mode().then_some(mode);
        let Values { numbers, rank, columns } = values;
        let (rows, columns) = (numbers.len() / columns, *columns);
        let name = quantity.name();
        let flat = format!(
            "step_{step}{}_{}",
            of_mode.map_or_else(String::new, |mode| format!("_mode_{mode}")),
            name.replace('.', "_")
        );
        match self {
            Self::C => {
                let sides = match rank {
                    0 => String::new(),
                    1 => format!("[{rows}]"),
                    _ => format!("[{rows}][{columns}]"),
                };
                format!(
                    "static const double {flat}{sides} = {};",
                    values.nested(["{", "}"], ", ")
                )
            }
            Self::Rust => {
                let kind = match rank {
                    0 => "f64".to_owned(),
                    1 => format!("[f64; {rows}]"),
                    _ => format!("[[f64; {columns}]; {rows}]"),
                };
                let flat = flat.to_uppercase();
                format!("const {flat}: {kind} = {};", values.nested(["[", "]"], ", "))
            }
            Self::Python => {
                let mode = of_mode.map_or_else(String::new, |mode| format!(", {mode}"));
                format!(
                    "expected[{step}{mode}, \"{name}\"] = {}",
                    values.nested(["[", "]"], ", ")
                )
            }
            Self::Matlab => {
                let mode = of_mode.map_or_else(String::new, |mode| format!(".modes({})", mode + 1));
                format!("expected({step}){mode}.{name} = {};", values.matlab())
            }
        }
    }
}

/// The numbers of a value.
struct Values<'a> {
    numbers: &'a [f64],
    rank: usize,
    columns: usize,
}

impl Values<'_> {
    /// A number, a list, or a list of rows, between brackets.
    fn nested(&self, [open, close]: [&str; 2], comma: &str) -> String {
        let list = |numbers: &[f64]| -> String {
            let texts: Vec<String> = numbers.iter().map(|number| format!("{number:?}")).collect();
            format!("{open}{}{close}", texts.join(comma))
        };
        match self.rank {
            0 => format!("{:?}", self.numbers[0]),
            1 => list(self.numbers),
            _ => {
                let rows: Vec<String> = self.numbers.chunks(self.columns).map(list).collect();
                format!("{open}{}{close}", rows.join(comma))
            }
        }
    }

    /// Rows between semicolons; a vector is a column.
    fn matlab(&self) -> String {
        let row = |numbers: &[f64]| -> String {
            let texts: Vec<String> = numbers.iter().map(|number| format!("{number:?}")).collect();
            texts.join(" ")
        };
        if self.rank == 0 {
            return format!("{:?}", self.numbers[0]);
        }
        let rows: Vec<String> = self.numbers.chunks(self.columns).map(row).collect();
        format!("[{}]", rows.join("; "))
    }
}

/// The values of a trace as statements, one a line. The steps after `certified` are not proven.
pub fn text(id: &str, trace: &Trace, certified: usize, language: Language) -> String {
    let comment = language.comment();
    let steps = trace.dimensions.steps();
    let mut text = format!("{comment} {id}: the doubles nearest to the exact values");
    if certified < steps {
        let _ = write!(text, " to step {certified}; after it those of a run in doubles");
    }
    text.push('\n');
    match language {
        Language::Python => {
            text.push_str("expected = {}  # by step and name; by step, mode and name where each mode has its own\n");
        }
        Language::Matlab => text.push_str("expected = struct();\n"),
        Language::C | Language::Rust => {}
    }
    for place in trace.all_places() {
        let (step, quantity, mode) = place;
        let Some(numbers) = trace.get(step, quantity, mode) else {
            continue;
        };
        let values = Values {
            numbers,
            rank: quantity.rank(),
            columns: trace.dimensions.shape(step, quantity).1,
        };
        text.push_str(&language.statement(place, &values));
        text.push('\n');
    }
    text
}
