//! The explanation of a faulty number: its equation with the program's own numbers in it, term by term.
//!
//! For example, `6` is compared with `0.6·(4 + 0.5²) + 0.4·(9 + 0.75²) = 6.375`. Sums and products of two values are written out; anything
//! nested deeper is one number. If the difference equals one of the terms, that term is named.

use super::instance::Instance;
use super::right::right;
use super::search::along;
use super::tree::{Operation, Tree};
use super::value::{Term, With};
use crate::oracle::diagnose::Evidence;
use crate::oracle::invalid::Invalid;
use crate::oracle::judge::Place;
use serde::Serialize;

/// An equation with numbers in it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Explanation {
    /// The equation by the names of the trace.
    pub equation: String,
    /// The same with the numbers of the program that stand at the entry.
    pub numbers: String,
    /// What they give.
    pub gives: f64,
    /// What is shown.
    pub shown: f64,
    /// The term that the difference is, and what was done with it.
    pub term: Option<String>,
}

/// Explains an entry, counted by rows, of each of some values of a program.
///
/// # Errors
///
/// [`Invalid`] for a problem that cannot be set up.
pub fn explain(
    evidence: &Evidence,
    conventions: &[&str],
    entries: &[(Place, usize)],
) -> Result<Vec<Option<Explanation>>, Invalid> {
    let run = along(evidence, conventions)?;
    let one = |(place, index): &(Place, usize)| {
        let at = Instance {
            run: &run,
            place: *place,
            is_wrong: true,
        };
        at.explained(*index)
    };
    Ok(entries.iter().map(one).collect())
}

/// An entry of a matrix, of a member of a list where it is one.
#[derive(Clone, Copy)]
struct Entry {
    row: usize,
    column: usize,
    member: usize,
}

impl Instance<'_> {
    fn explained(&self, index: usize) -> Option<Explanation> {
        let tree = right(self).into_iter().next()?;
        let value = tree.matrix(self, With::default())?;
        let entry = Entry {
            row: index / value.ncols(),
            column: index % value.ncols(),
            member: 0,
        };
        let gives = value.get((entry.row, entry.column))?.value();
        let shown = *self.shown_numbers()?.get(index)?;
        let mut terms = Vec::new();
        tree.terms(self, entry, 1.0, &mut terms);
        Some(Explanation {
            equation: tree.text(None),
            numbers: tree.numbers(self, entry)?.0,
            gives,
            shown,
            term: told_by(&terms, shown - gives),
        })
    }
}

/// The term that a difference is.
fn told_by(terms: &[(String, f64)], difference: f64) -> Option<String> {
    let is = |value: f64| (difference - value).abs() <= NEAR * value.abs();
    terms
        .iter()
        .filter(|(_, value)| *value != 0.0 && terms.len() > 1)
        .find_map(|(text, value)| {
            [
                (-1.0, "is left out"),
                (-2.0, "has the other sign"),
                (1.0, "is there twice"),
            ]
            .into_iter()
            .find(|(factor, _)| is(factor * value))
            .map(|(_, words)| format!("{text} {words}"))
        })
}

/// A difference of two numbers has lost some digits; a term is meant where so much of it is right.
const NEAR: f64 = 1e-9;

impl Tree {
    /// The number at an entry.
    fn at(&self, at: &Instance, entry: Entry) -> Option<f64> {
        let matrix = match self.value(at, With::default())? {
            Term::One(matrix) => matrix,
            Term::Each(mut list) => list.swap_remove(entry.member.min(list.len() - 1)),
        };
        let is_number = matrix.shape() == (1, 1);
        let place = if is_number { (0, 0) } else { (entry.row, entry.column) };
        Some(matrix.get(place)?.value())
    }

    /// The formula of an entry in numbers, and whether it is a sum.
    fn numbers(&self, at: &Instance, entry: Entry) -> Option<(String, bool)> {
        let Self::Node(operation, parts) = self else {
            return Some((short(self.at(at, entry)?), false));
        };
        let plain = |part: usize| Some(parts[part].numbers(at, entry)?.0);
        let bracketed = |part: usize| parts[part].bracketed(at, entry);
        Some(match operation {
            Operation::Plus => (format!("{} + {}", plain(0)?, bracketed_minus(plain(1)?)), true),
            Operation::Minus => (format!("{} − {}", plain(0)?, bracketed(1)?), true),
            Operation::Half => (format!("½·{}", bracketed(0)?), false),
            Operation::Negative => (format!("−{}", bracketed(0)?), false),
            Operation::Sum => self.members(&parts[0], &parts[1], at, entry)?,
            Operation::Outer => {
                let factor = |row: usize| {
                    parts[0].bracketed(
                        at,
                        Entry {
                            row,
                            column: 0,
                            ..entry
                        },
                    )
                };
                let (first, second) = (factor(entry.row)?, factor(entry.column)?);
                let text = if first == second {
                    format!("{first}²")
                } else {
                    format!("{first}·{second}")
                };
                (text, false)
            }
            Operation::Times => product(&parts[0], &parts[1], at, entry)?,
            _ => (short(self.at(at, entry)?), false),
        })
    }

    /// The same as a factor.
    fn bracketed(&self, at: &Instance, entry: Entry) -> Option<String> {
        let (text, is_sum) = self.numbers(at, entry)?;
        Some(if is_sum {
            format!("({text})")
        } else {
            bracketed_minus(text)
        })
    }

    /// A weighted sum, member by member where there are few.
    fn members(&self, weights: &Self, list: &Self, at: &Instance, entry: Entry) -> Option<(String, bool)> {
        let Term::Each(members) = list.value(at, With::default())? else {
            return None;
        };
        if members.len() > MEMBERS {
            return Some((short(self.at(at, entry)?), false));
        }
        let weighted = |member: usize| {
            let weight = weights.at(
                at,
                Entry {
                    row: member,
                    column: 0,
                    member,
                },
            )?;
            Some(format!(
                "{}·{}",
                short(weight),
                list.bracketed(at, Entry { member, ..entry })?
            ))
        };
        let all: Option<Vec<String>> = (0..members.len()).map(weighted).collect();
        Some((all?.join(" + "), true))
    }

    /// The terms of a sum with their numbers at an entry.
    fn terms(&self, at: &Instance, entry: Entry, sign: f64, found: &mut Vec<(String, f64)>) {
        match self {
            Self::Node(Operation::Plus, parts) => {
                parts[0].terms(at, entry, sign, found);
                parts[1].terms(at, entry, sign, found);
            }
            Self::Node(Operation::Minus, parts) => {
                parts[0].terms(at, entry, sign, found);
                parts[1].terms(at, entry, -sign, found);
            }
            Self::Node(Operation::Sum, parts) => match &parts[1] {
                Self::Node(Operation::Plus, inner) => {
                    for part in inner {
                        Self::sum(parts[0].clone(), part.clone()).terms(at, entry, sign, found);
                    }
                }
                _ => found.extend(self.at(at, entry).map(|value| (self.text(None), sign * value))),
            },
            Self::Node(Operation::Negative, parts) => parts[0].terms(at, entry, -sign, found),
            Self::Node(Operation::Half, parts) => parts[0].terms(at, entry, sign / 2.0, found),
            _ => found.extend(self.at(at, entry).map(|value| (self.text(None), sign * value))),
        }
    }
}

/// Lists and products of more are one number.
const MEMBERS: usize = 4;

/// Row times column, written out where it is short and made of values that are shown.
fn product(left: &Tree, right: &Tree, at: &Instance, entry: Entry) -> Option<(String, bool)> {
    let matrix = |tree: &Tree| match tree.value(at, With::default())? {
        Term::One(matrix) => Some(matrix),
        Term::Each(list) => list.into_iter().nth(entry.member),
    };
    let (a, b) = (matrix(left)?, matrix(right)?);
    if a.ncols() != b.nrows() || a.ncols() > MEMBERS {
        let whole = Tree::of(Operation::Times, [left.clone(), right.clone()]);
        return Some((short(whole.at(at, entry)?), false));
    }
    let factor = |k: usize| {
        let (a, b) = (a[(entry.row, k)].value(), b[(k, entry.column)].value());
        (a != 0.0 && b != 0.0).then(|| format!("{}·{}", bracketed_number(a), bracketed_number(b)))
    };
    let all: Vec<String> = (0..a.ncols()).filter_map(factor).collect();
    Some(match all.len() {
        0 => ("0".to_owned(), false),
        1 => (all[0].clone(), false),
        _ => (all.join(" + "), true),
    })
}

fn bracketed_minus(text: String) -> String {
    if text.starts_with('−') {
        format!("({text})")
    } else {
        text
    }
}

fn bracketed_number(value: f64) -> String {
    bracketed_minus(short(value))
}

/// A number to six digits.
pub fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    let is_plain = rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs());
    let text = if is_plain {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    };
    text.replacen('-', if text.starts_with('-') { "−" } else { "-" }, 1)
}
