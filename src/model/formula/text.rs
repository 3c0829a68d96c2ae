//! Formulas as text again: the printed text reads as the same operations.

use super::{Entry, Formulas, Operation};
use std::fmt;

/// The texts of formulas: each a name and what stands after it.
///
/// Example: parentheses stand where they are needed.
///
/// ```
/// use immaculate::model::formula::Formulas;
///
/// let formulas = Formulas::read(&["x", "T"], &[("a", "((x))·2")], &[("y", "-(a−T)**2/(3*x)")])?;
/// let written = formulas.written();
/// assert_eq!(written.definitions, [("a".to_owned(), "x*2".to_owned())]);
/// assert_eq!(written.formulas, [("y".to_owned(), "-(a - T)^2/(3*x)".to_owned())]);
/// # Ok::<(), immaculate::model::formula::InvalidFormula>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The definitions, in order.
    pub definitions: Vec<(String, String)>,
    /// The formulas, in order.
    pub formulas: Vec<(String, String)>,
}

/// How tightly a text holds together, from a sum to what needs no parentheses anywhere.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
enum Tightness {
    Sum,
    Sign,
    Product,
    Power,
    #[default]
    Atom,
}

/// A text and how tightly it holds together.
type Part = (String, Tightness);

impl Formulas {
    /// The formulas as text, in as few parentheses as they can be read again.
    ///
    /// Evidence: `what_is_printed_is_read_again` (property).
    pub fn written(&self) -> Written {
        // Every operation is used by one other at most, so its text is taken from the list and not copied.
        let mut parts: Vec<Part> = Vec::with_capacity(self.operations.len());
        for operation in &self.operations {
            let part = self.part(operation, &mut parts);
            parts.push(part);
        }
        let texts = |entries: &[Entry]| -> Vec<(String, String)> {
            let text = |entry: &Entry| (entry.name.clone(), parts[entry.result].0.clone());
            entries.iter().map(text).collect()
        };
        Written {
            definitions: texts(&self.definitions),
            formulas: texts(&self.results),
        }
    }

    /// The text of an operation from those of its operands.
    fn part(&self, operation: &Operation, parts: &mut [Part]) -> Part {
        let mut of = |index: &usize, least: Tightness| {
            let (text, tightness) = std::mem::take(&mut parts[*index]);
            if tightness < least { format!("({text})") } else { text }
        };
        match operation {
            Operation::Integer(value) => (value.to_string(), Tightness::Atom),
            // The shortest decimal that is nearest to this double alone.
            Operation::Number(value) => (format!("{:?}", value.to_f64()), Tightness::Atom),
            Operation::Name(index) => (self.names[*index].clone(), Tightness::Atom),
            Operation::Definition(index) => (self.definitions[*index].name.clone(), Tightness::Atom),
            Operation::Sum(a, b) => joined(of(a, Tightness::Sum), " + ", &of(b, Tightness::Product), Tightness::Sum),
            Operation::Difference(a, b) => {
                joined(of(a, Tightness::Sum), " - ", &of(b, Tightness::Product), Tightness::Sum)
            }
            Operation::Product(a, b) => joined(
                of(a, Tightness::Sign),
                "*",
                &of(b, Tightness::Power),
                Tightness::Product,
            ),
            Operation::Quotient(a, b) => joined(
                of(a, Tightness::Sign),
                "/",
                &of(b, Tightness::Power),
                Tightness::Product,
            ),
            Operation::Negative(a) => (format!("-{}", of(a, Tightness::Power)), Tightness::Sign),
            Operation::Power(a, exponent) => (format!("{}^{exponent}", of(a, Tightness::Atom)), Tightness::Power),
            Operation::Call(function, arguments) if arguments.is_empty() => (function.name(), Tightness::Atom),
            Operation::Call(function, arguments) => {
                let mut text = function.name() + "(";
                for (index, argument) in arguments.iter().enumerate() {
                    text += if index > 0 { ", " } else { "" };
                    text += &of(argument, Tightness::Sum);
                }
                (text + ")", Tightness::Atom)
            }
        }
    }
}

/// Two texts with a sign between them; the left one is not copied.
fn joined(mut left: String, sign: &str, right: &str, tightness: Tightness) -> Part {
    left += sign;
    left += right;
    (left, tightness)
}

impl fmt::Display for Formulas {
    /// A line a definition and a formula, `name = text`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let written = self.written();
        for (name, text) in written.definitions.iter().chain(&written.formulas) {
            writeln!(formatter, "{name} = {text}")?;
        }
        Ok(())
    }
}
