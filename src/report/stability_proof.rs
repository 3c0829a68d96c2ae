//! A proof of joint stability or of growth, written so that it can be followed with pencil and paper.
//!
//! A proof is printed as the matrices, the forms, each inequality with its pivots; or the product,
//! its characteristic polynomial and the sign that shows a root beyond one; and the bounds of the joint spectral radius.

use super::wrapped;
use crate::matrix::{Holds, Shapes};
use crate::number::{Enclosure, Field, Rational};
use crate::steady::by_hand::{ByHand, Growth};
use crate::steady::certificate::{Product, Quadratics};
use crate::steady::closed_loops::{BITS, Bounds, ClosedLoops, Entries, StabilityVerdict};
use crate::steady::polynomial::{MatrixRows, rows_of};
use crate::steady::reach::polynomial_text;
use nalgebra::{Dim, OMatrix};
use serde_json::{Value, json};
use std::fmt::Write;

/// A longer fraction is written as a decimal.
const LONGEST_FRACTION: usize = 24;

/// Digits after the point of such a decimal.
const DECIMALS: u32 = 9;

/// Forms that are printed; more of them nobody follows by hand.
const PRINTED: usize = 4;

/// The content of the report: the filters' letters, their matrices, the verdict and the bounds.
pub(super) struct Proof<'a, N: Dim>
where
    Shapes: Holds<N>,
{
    pub letters: &'a [String],
    pub loops: &'a ClosedLoops<N>,
    pub verdict: &'a StabilityVerdict<N>,
    pub bounds: &'a Bounds<N>,
}

/// A number that can be computed with: a fraction, or a decimal where the fraction is long.
fn number(value: &Rational) -> String {
    let text = value.to_string();
    if text.len() <= LONGEST_FRACTION {
        return text;
    }
    let mut digits = DECIMALS;
    // A small number keeps four digits.
    while digits < 60 && value.abs() * Rational::integer(10).pow(digits) < Rational::integer(1000) {
        digits += 3;
    }
    value.to_decimal(digits)
}

/// A matrix by rows.
fn matrix(rows: &MatrixRows<Rational>) -> String {
    let row = |entries: &Vec<Rational>| entries.iter().map(number).collect::<Vec<_>>().join(" ");
    format!("[{}]", rows.iter().map(row).collect::<Vec<_>>().join("; "))
}

fn numbers(values: &[Rational]) -> String {
    values.iter().map(number).collect::<Vec<_>>().join(", ")
}

/// A word with its runs as powers.
pub(super) fn word(word: &[usize], letters: &[String]) -> String {
    let superscript = |count: usize| {
        let digit = |c: char| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(c as usize - '0' as usize).unwrap_or(c);
        count.to_string().chars().map(digit).collect::<String>()
    };
    let runs = word.chunk_by(|a, b| a == b);
    runs.map(|run| match run {
        [letter] => letters[*letter].clone(),
        _ => format!("{}{}", letters[run[0]], superscript(run.len())),
    })
    .collect::<Vec<_>>()
    .join(" ")
}

impl<N: Dim> Proof<'_, N>
where
    Shapes: Holds<N>,
{
    /// The proof for people.
    pub fn text(&self) -> String {
        match self.verdict {
            StabilityVerdict::Stable(found) => self.stable(found),
            StabilityVerdict::Unstable(found) => self.unstable(found),
            StabilityVerdict::Undecided { .. } => String::new(),
        }
    }

    /// The forms, up to four of them, and every inequality of a single one.
    fn stable(&self, found: &Quadratics<N>) -> String {
        let mut text = String::new();
        let by_hand = ByHand::new(self.loops, found);
        if let Some(proof) = by_hand.as_ref().filter(|_| found.forms.len() == 1) {
            for (letter, c) in self.letters.iter().zip(&proof.matrices) {
                let within = if proof.distance.is_positive() {
                    format!("   each entry ± {}", proof.distance)
                } else {
                    String::new()
                };
                let _ = writeln!(text, "    A_{letter} = {}{within}", matrix(&rows_of(c)));
            }
        }
        for (node, form) in found.forms.iter().enumerate().take(PRINTED) {
            let _ = writeln!(
                text,
                "    {} = {}",
                self.form_name(node, found.forms.len()),
                matrix(&rows_of(form))
            );
        }
        if found.forms.len() > PRINTED {
            let _ = writeln!(text, "    … {} more, in --json", found.forms.len() - PRINTED);
        }
        match &by_hand {
            Some(proof) if found.forms.len() == 1 => self.inequalities(proof, &mut text),
            Some(_) => {}
            None => text.push_str("    The inequalities need more digits than can be followed by hand.\n"),
        }
        text
    }

    fn inequalities(&self, proof: &ByHand, text: &mut String) {
        let _ = writeln!(text, "    P has the pivots {}", numbers(&proof.forms[0]));
        for found in &proof.edges {
            let a = format!("A_{}", self.letters[found.edge.letter]);
            let (name, is_within) = (format!("P − {a}ᵀP{a}"), proof.distance.is_positive());
            let (value, pivots) = (matrix(&rows_of(&found.matrix)), numbers(&found.pivots));
            let _ = if is_within {
                let slack = number(&found.slack);
                writeln!(
                    text,
                    "    {name} ⪰ {value} with the pivots {pivots}; {slack} I was subtracted for the ±"
                )
            } else {
                writeln!(text, "    {name} = {value} with the pivots {pivots}")
            };
        }
        text.push_str("    Pivots that are all positive make a matrix positive definite.\n");
    }

    fn form_name(&self, node: usize, count: usize) -> String {
        if count == 1 {
            return "P".to_owned();
        }
        let letters = self.letters.len();
        let mut remembered = Vec::new();
        let (mut rest, mut left) = (node, count);
        while left > 1 {
            remembered.insert(0, self.letters[rest % letters].clone());
            (rest, left) = (rest / letters, left / letters);
        }
        let separator = if self.letters.iter().all(|letter| letter.len() == 1) {
            ""
        } else {
            " "
        };
        format!("P({})", remembered.join(separator))
    }

    /// The product and why it grows.
    fn unstable(&self, found: &Product) -> String {
        match &self.loops.matrices {
            Entries::Exact(matrices) => {
                let mut text = String::new();
                for (letter, a) in self.letters.iter().zip(matrices) {
                    let _ = writeln!(text, "    A_{letter} = {}", matrix(&rows_of(a)));
                }
                let growth = Growth::new(&found.word, matrices, &found.radius);
                let _ = writeln!(
                    text,
                    "    {} = {}",
                    self.product_name(&found.word),
                    matrix(&growth.product)
                );
                let is_short = growth
                    .polynomial
                    .iter()
                    .all(|c| c.to_string().len() <= LONGEST_FRACTION);
                if is_short {
                    let _ = writeln!(text, "    p(λ) = {}", polynomial_text(&growth.polynomial));
                }
                text + &beyond(growth.beyond.map(|(place, value)| (place, number(&value))))
            }
            Entries::Enclosed(matrices) => Enclosure::with_precision(BITS, || {
                let growth = Growth::new(&found.word, matrices, &found.radius);
                let decimal = |value: &Enclosure| value.to_decimal(6).unwrap_or_else(|| value.to_string());
                let terms: Vec<String> = growth.polynomial.iter().rev().map(decimal).collect();
                let head = format!(
                    "    the characteristic polynomial p of {} has the coefficients {} from λ^{} down\n",
                    self.product_name(&found.word),
                    terms.join(", "),
                    terms.len() - 1
                );
                head + &beyond(growth.beyond.map(|(place, value)| (place, decimal(&value))))
            }),
        }
    }

    /// The matrices of a word in the order in which they are multiplied.
    fn product_name(&self, of: &[usize]) -> String {
        let names: Vec<String> = self.letters.iter().map(|letter| format!("A_{letter}")).collect();
        let reversed: Vec<usize> = of.iter().rev().copied().collect();
        word(&reversed, &names)
    }

    /// The bounds of the joint spectral radius for people.
    pub fn bounds_text(&self) -> String {
        let below = format!(
            "at least {}, the growth a step of {}",
            self.bounds.below,
            word(&self.bounds.word, self.letters)
        );
        let above = match &self.bounds.above {
            Some((rate, forms)) => {
                let of = match forms.forms.len() {
                    1 => format!("P = {}, since λ²P − AᵀPA", matrix(&rows_of(&forms.forms[0]))),
                    count => format!("{count} forms, in --json, since λ²P(w) − AᵀP(w′)A"),
                };
                format!("below {rate} = λ by {of} is positive definite for every A")
            }
            None => "no bound from above was found".to_owned(),
        };
        wrapped(
            &format!(
                "The joint spectral radius, by which errors grow or shrink a step in the worst case, is {below}, and {above}."
            ),
            "  ",
        )
    }

    /// The same for programs.
    pub fn json(&self) -> Value {
        let form = |form: &OMatrix<Rational, N, N>| -> Vec<Vec<String>> {
            let row = |i: usize| form.row(i).iter().map(ToString::to_string).collect();
            (0..form.nrows()).map(row).collect()
        };
        let of_forms = |found: &Quadratics<N>| -> Value {
            let edges: Vec<Value> = (found.edges.iter())
                .map(|edge| json!([edge.from, self.letters[edge.letter], edge.to]))
                .collect();
            json!({ "edges": edges, "forms": found.forms.iter().map(form).collect::<Vec<_>>() })
        };
        let letters = |word: &[usize]| {
            word.iter()
                .map(|&letter| self.letters[letter].clone())
                .collect::<Vec<_>>()
        };
        let proof = match self.verdict {
            StabilityVerdict::Stable(found) => {
                json!({ "stable": of_forms(found), "by_hand": by_hand(self.loops, found) })
            }
            StabilityVerdict::Unstable(found) => {
                json!({ "unstable": { "word": letters(&found.word), "radius": found.radius.to_string() } })
            }
            StabilityVerdict::Undecided { growth } => json!({ "greatest_growth_tried": growth }),
        };
        let above = self.bounds.above.as_ref();
        json!({
            "proof": proof,
            "joint_spectral_radius": {
                "at_least": self.bounds.below.to_string(),
                "word": letters(&self.bounds.word),
                "below": above.map(|(rate, _)| rate.to_string()),
                "forms": above.map(|(_, found)| of_forms(found)),
            },
        })
    }
}

/// The inequalities as fractions.
fn by_hand<N: Dim>(loops: &ClosedLoops<N>, found: &Quadratics<N>) -> Value
where
    Shapes: Holds<N>,
{
    let Some(proof) = ByHand::new(loops, found) else {
        return Value::Null;
    };
    let texts = |values: &[Rational]| values.iter().map(ToString::to_string).collect::<Vec<_>>();
    let rows = |a: &nalgebra::DMatrix<Rational>| -> Vec<Vec<String>> {
        a.row_iter()
            .map(|row| row.iter().map(ToString::to_string).collect())
            .collect()
    };
    let edges = proof.edges.iter().map(|found| {
        json!({ "slack": found.slack.to_string(), "matrix": rows(&found.matrix), "pivots": texts(&found.pivots) })
    });
    json!({
        "matrices": proof.matrices.iter().map(rows).collect::<Vec<_>>(),
        "distance": proof.distance.to_string(),
        "pivots_of_forms": proof.forms.iter().map(|pivots| texts(pivots)).collect::<Vec<_>>(),
        "edges": edges.collect::<Vec<_>>(),
    })
}

/// The sign that shows a root.
fn beyond(found: Option<(Rational, String)>) -> String {
    match found {
        Some((place, value)) => {
            let side = if place.is_positive() { "above" } else { "below" };
            let (place, infinity) = (number(&place), if place.is_positive() { "∞" } else { "−∞" });
            format!("    p({place}) = {value}, of the other sign than p at {infinity}: a root {side} {place}\n")
        }
        None => "    the root beyond is not real: the Schur-Cohn test counts it\n".to_owned(),
    }
}
