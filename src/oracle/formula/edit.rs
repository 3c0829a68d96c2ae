//! The formulas one edit away from a right one.
//!
//! The edits are the mistakes that programs make: a wrong operand, a term left out or added, a sign, an order, a transpose, a forgotten
//! inverse, an entry-by-entry product, part of a matrix, a factor, a floor.

use super::instance::Instance;
use super::right::definitions;
use super::tree::{Definition, Given, Leaf, Of, Operation, Tree, UNARY, Value};
use super::value::With;
use crate::imm::Quantity;

/// A formula that a program may have computed.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    /// How far it is from the right one; what programs do more often costs less.
    pub(super) cost: f64,
    pub(super) tree: Tree,
    /// From where its number is fitted.
    pub(super) start: Option<Start>,
    /// The definition that is another for all its uses; then the tree is the right one.
    pub(super) definition: Option<(Definition, Tree)>,
}

/// Where a fit begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Start {
    At(f64),
    /// The least diagonal entry of what is shown.
    LeastVariance,
    /// The greatest.
    GreatestVariance,
}

impl Candidate {
    fn new(cost: f64, tree: Tree) -> Self {
        Self {
            cost,
            tree,
            start: None,
            definition: None,
        }
    }

    fn fitted(cost: f64, operation: Operation, of: &Tree, start: Start, place: impl Fn(&Tree) -> Tree) -> Self {
        let tree = place(&Tree::of(operation, [Tree::Fitted, of.clone()]));
        Self {
            cost,
            tree,
            start: Some(start),
            definition: None,
        }
    }
}

/// The shape of a formula's value: rows, columns, whether it is a list.
type Shape = Option<(usize, usize, bool)>;

/// The leaves that stand for themselves, with their shapes.
pub(super) struct Names {
    all: Vec<(Leaf, Shape)>,
}

const OF: [Of; 9] = [
    Of::Itself,
    Of::Each,
    Of::First,
    Of::Last,
    Of::Before,
    Of::EachBefore,
    Of::Right,
    Of::EachRight,
    Of::EachRightBefore,
];

const GIVEN: [Given; 15] = [
    Given::MotionMatrix,
    Given::MotionNoise,
    Given::MeasurementMatrix,
    Given::MeasurementNoise,
    Given::NoiseCrossCovariance,
    Given::Measurement,
    Given::Chain,
    Given::Column,
    Given::Row,
    Given::Identity,
    Given::InitialMean,
    Given::InitialCovariance,
    Given::InitialProbabilities,
    Given::Weights,
    Given::CovarianceWeights,
];

const POINTS: [(Definition, Quantity); 3] = [
    (Definition::MixedPoints, Quantity::MixedCovariance),
    (Definition::PropagatedPoints, Quantity::MixedCovariance),
    (Definition::PredictedPoints, Quantity::PredictedCovariance),
];

impl Names {
    /// The values that are there before the ones that are to be explained, and none that is made of them.
    pub(super) fn of(probes: &[&Instance]) -> Self {
        let mut all: Vec<(Leaf, Shape)> = Vec::new();
        for (leaf, shape) in probes.iter().flat_map(|at| Self::at(at).all) {
            if !all.iter().any(|(other, _)| *other == leaf) {
                all.push((leaf, shape));
            }
        }
        Self { all }
    }

    fn at(at: &Instance) -> Self {
        let (_, target, _) = at.place;
        let is_before = |of: Of| matches!(of, Of::Before | Of::EachBefore | Of::EachRightBefore);
        let is_there = |quantity: Quantity, of: Of| {
            quantity < target || is_before(of) || quantity == target && matches!(of, Of::First | Of::Last)
        };
        let traced = Quantity::ALL
            .into_iter()
            .flat_map(|quantity| OF.map(|of| (quantity, of)));
        let traced = traced
            .filter(|(quantity, of)| is_there(*quantity, *of))
            .map(|(quantity, of)| (Value::Traced(quantity), of));
        let given = GIVEN.into_iter().flat_map(|given| {
            [Of::Itself, Of::First, Of::Last, Of::Before, Of::AtFirstStep].map(|of| (Value::Given(given), of))
        });
        let points = POINTS.into_iter().filter(|(_, last)| *last < target);
        let points = points.map(|(name, _)| (Value::Defined(name), Of::Itself));
        let leaves = traced.chain(given).chain(points).map(|(value, of)| Leaf { value, of });
        let with_shape = |leaf: Leaf| (leaf, shape_of(&Tree::Leaf(leaf), at));
        Self {
            all: leaves.map(with_shape).filter(|(_, shape)| shape.is_some()).collect(),
        }
    }

    fn alike(&self, shape: Shape) -> impl Iterator<Item = Leaf> {
        self.all
            .iter()
            .filter(move |(_, own)| *own == shape)
            .map(|(leaf, _)| *leaf)
    }
}

fn shape_of(tree: &Tree, at: &Instance) -> Shape {
    tree.value(at, With::default()).map(|value| value.shape())
}

/// How far a leaf is from the one for which it stands.
fn distance(old: Leaf, new: Leaf) -> f64 {
    let is_covariance = |leaf: Leaf| matches!(leaf.value, Value::Traced(quantity) if quantity.is_covariance());
    let near = match new.of {
        Of::Right | Of::EachRightBefore => 0.1,
        Of::Itself | Of::Each => 0.4,
        _ if new.value == old.value => 0.3,
        _ => 0.6,
    };
    if is_covariance(old) == is_covariance(new) {
        near
    } else {
        near + 0.1
    }
}

/// Every formula one edit away, and every value that is there already.
pub(super) fn candidates(forms: &[Tree], starts: &[Tree], names: &Names, at: &Instance) -> Vec<Candidate> {
    let mut found = Vec::new();
    let Some(first) = forms.first() else { return found };
    let target = shape_of(first, at);
    let turned = target.map(|(rows, columns, is_list)| (columns, rows, is_list));
    found.extend(
        names
            .alike(target)
            .map(|leaf| Candidate::new(1.2 + far(leaf), Tree::Leaf(leaf))),
    );
    found.extend(
        names
            .alike(turned)
            .map(|leaf| Candidate::new(1.3 + far(leaf), Tree::Leaf(leaf).transpose())),
    );
    for (index, form) in forms.iter().chain(starts).enumerate() {
        let mut of_form = edits(form, names, at);
        for candidate in &mut of_form {
            candidate.cost += if index == 0 { 0.0 } else { 0.05 };
        }
        found.extend(of_form);
    }
    if let Some(used) = with_what_was_used(first, names) {
        let unedited = std::iter::once(Candidate::new(1.0, used.clone()));
        found.extend(unedited.chain(edits(&used, names, at)).map(|one| Candidate {
            cost: one.cost + 0.1,
            ..one
        }));
    }
    found.extend(moved_on(first, at));
    for operation in [Operation::Single, Operation::Truncated] {
        found.push(Candidate::new(1.05, first.with_each(&is_input, operation)));
    }
    for leaf in twice_over(first, at) {
        found.push(Candidate::new(1.4, first.with_all(leaf, first)));
    }
    for &name in definitions(at.drawing()) {
        let Some(tree) = super::right::definition(name, at.drawing()) else {
            continue;
        };
        for edit in edits(&tree, &names.of_definition(name, &tree), at) {
            let definition = Some((name, edit.tree));
            found.push(Candidate {
                cost: edit.cost - 0.05,
                tree: first.clone(),
                start: edit.start,
                definition,
            });
        }
    }
    found
}

/// A program that shows one value may go on with another, the right one: the formula of what it may have used instead of what it shows.
fn with_what_was_used(tree: &Tree, names: &Names) -> Option<Tree> {
    let twin = |leaf: Leaf| {
        let of = match leaf.of {
            Of::Itself => Of::Right,
            Of::Each => Of::EachRight,
            Of::EachBefore => Of::EachRightBefore,
            of => of,
        };
        let right = Leaf { of, ..leaf };
        names.all.iter().any(|(name, _)| *name == right).then_some(right)
    };
    let mut used = tree.clone();
    for leaf in tree.leaves() {
        if let Some(right) = twin(leaf) {
            used = used.with_all(leaf, &Tree::Leaf(right));
        }
    }
    (used != *tree).then_some(used)
}

/// An updated estimate that is the prediction of the next step already: programs that correct first and predict then.
fn moved_on(tree: &Tree, at: &Instance) -> Vec<Candidate> {
    let given = |given| {
        Tree::Leaf(Leaf {
            value: Value::Given(given),
            of: Of::Itself,
        })
    };
    let f = || given(Given::MotionMatrix);
    match at.place.1 {
        Quantity::UpdatedMean => vec![Candidate::new(1.4, f() * tree.clone())],
        Quantity::UpdatedCovariance => {
            let moved = (f() * tree.clone()) * f().transpose();
            vec![
                Candidate::new(1.4, moved.clone() + given(Given::MotionNoise)),
                Candidate::new(1.45, moved),
            ]
        }
        _ => Vec::new(),
    }
}

/// Whether a leaf is a number of the problem; in the first step the estimates before it are.
fn is_input(leaf: Leaf) -> bool {
    matches!(leaf.value, Value::Given(_)) || matches!(leaf.of, Of::Before | Of::EachBefore)
}

/// The operands of which a value is the same a little later: what is done twice is done to them.
fn twice_over(tree: &Tree, at: &Instance) -> Vec<Leaf> {
    use Quantity::{MixedCovariance, MixedMean, ModeProbabilities};
    let starts = [MixedMean, MixedCovariance, ModeProbabilities].map(Value::Traced);
    let shape = shape_of(tree, at);
    let leaves = tree.leaves().into_iter().filter(|leaf| starts.contains(&leaf.value));
    leaves
        .filter(|leaf| shape_of(&Tree::Leaf(*leaf), at) == shape)
        .collect()
}

fn far(leaf: Leaf) -> f64 {
    if matches!(leaf.of, Of::Itself | Of::Each) {
        0.0
    } else {
        0.05
    }
}

impl Names {
    /// What may stand in a definition: in one of numbers the other numbers, in one of points all that is there.
    fn of_definition(&self, name: Definition, tree: &Tree) -> Self {
        let is_of_points = matches!(
            name,
            Definition::MixedPoints
                | Definition::PropagatedPoints
                | Definition::PredictedPoints
                | Definition::MeasuredDeviations
        );
        if is_of_points {
            return Self { all: self.all.clone() };
        }
        let mut values: Vec<Value> = tree.leaves().iter().map(|leaf| leaf.value).collect();
        values.extend([Given::Alpha, Given::Beta, Given::Kappa, Given::Components, Given::One].map(Value::Given));
        values.sort_by_key(|value| format!("{value:?}"));
        values.dedup();
        let leaf = |value| (Leaf { value, of: Of::Itself }, Some((1, 1, false)));
        Self {
            all: values.into_iter().map(leaf).collect(),
        }
    }
}

/// The formulas one edit away from one.
fn edits(tree: &Tree, names: &Names, at: &Instance) -> Vec<Candidate> {
    let mut found = Vec::new();
    for leaf in twice(tree) {
        let shape = shape_of(&Tree::Leaf(leaf), at);
        for other in names.alike(shape).filter(|other| *other != leaf) {
            let everywhere = tree.with_all(leaf, &Tree::Leaf(other));
            found.push(Candidate::new(1.0 + distance(leaf, other), everywhere));
        }
        for (cost, operation) in unary() {
            let everywhere = tree.with_all(leaf, &Tree::Leaf(leaf).unary(operation));
            found.push(Candidate::new(cost, everywhere));
        }
    }
    for (way, part) in tree.places() {
        let place = |new: &Tree| tree.with(&way, new);
        let shape = shape_of(part, at);
        exchanged(part, way.is_empty(), shape, names, &place, &mut found);
        structural(part, shape, way.is_empty(), at, &place, &mut found);
        added(part, shape, names, &place, &mut found);
        fitted(part, shape, &place, &mut found);
    }
    found
}

/// What one value can be turned into, with what it costs: what stands first in the list is done more often.
fn unary() -> impl Iterator<Item = (f64, Operation)> {
    #[allow(clippy::cast_precision_loss, reason = "an index into a short list")]
    let cost = |index: usize| 1.1 + 0.02 * index as f64;
    UNARY
        .into_iter()
        .enumerate()
        .map(move |(index, operation)| (cost(index), operation))
}

/// The leaves that stand more than once in a formula.
fn twice(tree: &Tree) -> Vec<Leaf> {
    let leaves = tree.leaves();
    let mut found = Vec::new();
    for leaf in &leaves {
        if leaves.iter().filter(|other| *other == leaf).count() > 1 && !found.contains(leaf) {
            found.push(*leaf);
        }
    }
    found
}

/// Replaces one operand by another.
fn exchanged(
    part: &Tree,
    is_whole: bool,
    shape: Shape,
    names: &Names,
    place: &dyn Fn(&Tree) -> Tree,
    found: &mut Vec<Candidate>,
) {
    let turned = shape.map(|(rows, columns, is_list)| (columns, rows, is_list));
    match part {
        Tree::Leaf(leaf) => {
            for other in names.alike(shape).filter(|other| other != leaf) {
                found.push(Candidate::new(1.0 + distance(*leaf, other), place(&Tree::Leaf(other))));
            }
            for other in names.alike(turned).filter(|other| other != leaf) {
                found.push(Candidate::new(
                    1.5 + distance(*leaf, other),
                    place(&Tree::Leaf(other).transpose()),
                ));
            }
        }
        _ if is_whole => {}
        _ => {
            for other in names.alike(shape) {
                found.push(Candidate::new(2.0 + far(other), place(&Tree::Leaf(other))));
            }
        }
    }
}

/// A part left out, a sign, an order, an operation of one value added or another of two.
fn structural(
    part: &Tree,
    shape: Shape,
    is_whole: bool,
    at: &Instance,
    place: &dyn Fn(&Tree) -> Tree,
    found: &mut Vec<Candidate>,
) {
    for child in part.parts() {
        if shape.is_none() || shape_of(child, at) == shape {
            found.push(Candidate::new(1.0, place(child)));
        }
    }
    if let Tree::Node(operation, parts) = part {
        let other = |operation: Operation| Tree::Node(operation, parts.clone());
        match operation {
            Operation::Plus => found.push(Candidate::new(1.0, place(&other(Operation::Minus)))),
            Operation::Minus => found.push(Candidate::new(1.0, place(&other(Operation::Plus)))),
            Operation::Times => {
                found.push(Candidate::new(1.0, place(&other(Operation::Entrywise))));
                let turned = Tree::of(Operation::Times, [parts[1].clone(), parts[0].clone()]);
                found.push(Candidate::new(1.2, place(&turned)));
            }
            _ => {}
        }
    }
    let inside = if is_whole || matches!(part, Tree::Leaf(_)) {
        0.0
    } else {
        0.1
    };
    for (cost, operation) in unary() {
        let new = part.clone().unary(operation);
        found.push(Candidate::new(cost + inside, place(&new)));
    }
}

/// Another term beside one, or another factor.
fn added(part: &Tree, shape: Shape, names: &Names, place: &dyn Fn(&Tree) -> Tree, found: &mut Vec<Candidate>) {
    let Some((rows, columns, _)) = shape else { return };
    for other in names.alike(shape) {
        let cost = 1.5 + 10.0 * far(other);
        found.push(Candidate::new(cost, place(&(part.clone() + Tree::Leaf(other)))));
        found.push(Candidate::new(cost, place(&(part.clone() - Tree::Leaf(other)))));
    }
    if (rows, columns) == (1, 1) {
        return;
    }
    for (leaf, own) in &names.all {
        let Some((own_rows, own_columns, _)) = *own else {
            continue;
        };
        if own_rows != own_columns || own_rows == 1 {
            continue;
        }
        let factor = Tree::Leaf(*leaf);
        for factor in [
            factor.clone(),
            factor.clone().transpose(),
            factor.clone().inverse(),
            factor.unary(Operation::Factor),
        ] {
            let cost = 2.0 + far(*leaf);
            if columns == own_rows {
                found.push(Candidate::new(cost, place(&(part.clone() * factor.clone()))));
            }
            if rows == own_rows {
                found.push(Candidate::new(cost, place(&(factor * part.clone()))));
            }
        }
    }
}

/// A number that is found by fitting.
fn fitted(part: &Tree, shape: Shape, place: &dyn Fn(&Tree) -> Tree, found: &mut Vec<Candidate>) {
    let Some((rows, columns, _)) = shape else { return };
    found.push(Candidate::fitted(1.7, Operation::Times, part, Start::At(0.9), place));
    if rows == columns {
        found.push(Candidate::fitted(
            1.8,
            Operation::OnDiagonal,
            part,
            Start::At(0.0),
            place,
        ));
    }
    if rows == columns && rows > 1 {
        found.push(Candidate::fitted(
            1.9,
            Operation::Floor,
            part,
            Start::LeastVariance,
            place,
        ));
        found.push(Candidate::fitted(
            1.9,
            Operation::Ceiling,
            part,
            Start::GreatestVariance,
            place,
        ));
    }
}
