//! The input that would explain the shown values, such as a noise that the program computed differently.
//!
//! The input must stand alone as a term of the right formula; subtracting the rest from the shown value then gives the input that was
//! used. It is accepted if it is the same at all faulty values of a mode, and there are several.

use super::instance::Instance;
use super::right::right;
use super::search::ComputedFormula;
use super::tree::{Given, Leaf, Of, Operation, Tree, Value};
use super::value::{With, by_rows};
use crate::oracle::judge::LIMIT;

/// At least this many values of a mode must agree: some input explains any single value.
const AGREEING: usize = 3;

/// The inputs that stand as terms of their own in some right formula.
const INPUTS: [Given; 2] = [Given::MotionNoise, Given::MeasurementNoise];

/// What a group of faulty values would be explained by: the input, and its numbers by rows in the first faulty mode.
pub(super) fn solved(wrong: &[&Instance]) -> Option<ComputedFormula> {
    let form = right(wrong.first()?).into_iter().next()?;
    INPUTS.into_iter().find_map(|input| of_input(&form, input, wrong))
}

fn of_input(form: &Tree, input: Given, wrong: &[&Instance]) -> Option<ComputedFormula> {
    let leaf = Leaf {
        value: Value::Given(input),
        of: Of::Itself,
    };
    if !is_term(form, leaf) {
        return None;
    }
    let without = form.with_all(leaf, &Tree::Leaf(leaf).unary(Operation::Zero));
    let mut modes: Vec<usize> = wrong.iter().map(|at| at.place.2).collect();
    modes.sort_unstable();
    modes.dedup();
    let of_mode = |mode: usize| agreed(&without, wrong.iter().copied().filter(|at| at.place.2 == mode));
    let all: Vec<Vec<f64>> = modes.iter().map(|mode| of_mode(*mode)).collect::<Option<_>>()?;
    let name = Tree::Leaf(leaf).text(None);
    let numbers: Vec<String> = all[0].iter().map(|number| super::short(*number)).collect();
    let columns = wrong[0].leaf(leaf, With::default())?.shape().1;
    let rows: Vec<String> = numbers.chunks(columns).map(|row| row.join(" ")).collect();
    let of_mode = if modes.len() > 1 {
        format!(" in mode {}", modes[0])
    } else {
        String::new()
    };
    Some(ComputedFormula {
        quantity: wrong[0].place.1,
        filters: vec![wrong[0].filter_name()],
        computed: format!("{}, where {name} = [{}]{of_mode}", form.text(None), rows.join("; ")),
        right: form.text(None),
        explains: wrong.len(),
        of: wrong.len(),
        condition: None,
    })
}

/// Whether a leaf is a term of a sum.
fn is_term(tree: &Tree, leaf: Leaf) -> bool {
    match tree {
        Tree::Node(Operation::Plus, parts) => parts
            .iter()
            .any(|part| *part == Tree::Leaf(leaf) || is_term(part, leaf)),
        _ => false,
    }
}

/// What is left of all values without the input, if it is the same to rounding.
fn agreed<'b, 'a: 'b>(without: &Tree, wrong: impl Iterator<Item = &'b Instance<'a>>) -> Option<Vec<f64>> {
    let mut first: Option<Vec<f64>> = None;
    let mut count = 0;
    for at in wrong {
        let rest = by_rows(&without.matrix(at, With::default())?);
        let shown = at.shown_numbers()?;
        let (step, quantity, mode) = at.place;
        let reference = at.run.case.reference;
        let (scale, noise) = (
            reference.scale.get(step, quantity, mode)?,
            reference.noise.get(step, quantity, mode)?,
        );
        let unit = |index: usize| noise[index].max(f64::EPSILON * scale[index]);
        // A zero that is one but for rounding is said as a zero.
        let difference = |index: usize| {
            let difference = shown[index] - rest[index];
            if difference.abs() <= LIMIT * unit(index) {
                0.0
            } else {
                difference
            }
        };
        let left: Vec<f64> = (0..shown.len().min(rest.len())).map(difference).collect();
        let is_same = |other: &Vec<f64>| {
            other.len() == left.len()
                && (0..left.len()).all(|index| (left[index] - other[index]).abs() <= 2.0 * LIMIT * unit(index))
        };
        match &first {
            None => first = Some(left),
            Some(first) if is_same(first) => {}
            Some(_) => return None,
        }
        count += 1;
    }
    first.filter(|_| count >= AGREEING)
}
