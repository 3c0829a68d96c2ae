//! A formula as a tree: operations on the values of a step.
//!
//! Two formulas combine into one sum or product: `predicted.covariance − gain · innovation_covariance · gainᵀ`.

use crate::imm::Quantity;
use std::ops::{Add, Mul, Sub};

/// A formula.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Tree {
    /// A value of the step.
    Leaf(Leaf),
    /// A number that is found by fitting.
    Fitted,
    /// An operation on the values of other formulas.
    Node(Operation, Vec<Tree>),
}

/// A value of a step, of one of the modes or of all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Leaf {
    pub(super) value: Value,
    pub(super) of: Of,
}

/// What a leaf stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Value {
    /// A value of the trace.
    Traced(Quantity),
    /// A value of the problem.
    Given(Given),
    /// A formula that others are made of, such as the points of a filter.
    Defined(Definition),
}

/// A value of the problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Given {
    MotionMatrix,
    MotionNoise,
    MeasurementMatrix,
    MeasurementNoise,
    NoiseCrossCovariance,
    Measurement,
    LinearisationPoint,
    Truth,
    Chain,
    /// What leads to the mode, by columns of the chain.
    Column,
    /// What leads from the mode, the row of the chain.
    Row,
    Identity,
    InitialMean,
    InitialCovariance,
    InitialProbabilities,
    Gain,
    InnovationCovariance,
    /// m ln(2π)/2.
    HalfLogOfTurns,
    /// The directions of the points of a rule with their lengths.
    RulePoints,
    /// The directions alone.
    RuleAxes,
    Weights,
    CovarianceWeights,
    Alpha,
    Beta,
    Kappa,
    Components,
    /// A list of each mode: what is added to its covariance where its estimate is read in another state.
    Added,
    One,
    /// One for the first point and zero for the others.
    FirstPoint,
    /// Zero for the first point and one for the others.
    OtherPoints,
}

/// A formula that others are made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Definition {
    /// λ = α² (n + κ) − n.
    Lambda,
    /// n + λ, the square of the points' distance.
    Spread,
    /// 1/(2 (n + λ)).
    Weight,
    /// λ/(n + λ).
    FirstWeight,
    /// That of covariances: λ/(n + λ) + 1 − α² + β.
    FirstCovarianceWeight,
    /// The weights of means.
    Weights,
    /// The weights of covariances.
    CovarianceWeights,
    /// The points ξ of the rule.
    RulePoints,
    /// The points of the mixed estimate.
    MixedPoints,
    /// These a step later.
    PropagatedPoints,
    /// The points of the predicted estimate.
    PredictedPoints,
    /// Their measurements, from the predicted measurement, wrapped.
    MeasuredDeviations,
}

/// Whose value a leaf is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Of {
    /// Of the mode itself, or of all together where no mode has its own.
    Itself,
    /// A list, of each mode.
    Each,
    /// Of the first mode.
    First,
    /// Of the last mode.
    Last,
    /// Of the mode itself, a step before.
    Before,
    /// A list, of each mode a step before.
    EachBefore,
    /// What the equations give of the program's own values, which is not what it shows.
    Right,
    /// A list of these, of each mode.
    EachRight,
    /// A list of these, of each mode a step before.
    EachRightBefore,
    /// A value of the problem, as it is at the first step.
    AtFirstStep,
}

/// What is done with the values of other formulas.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Operation {
    Plus,
    Minus,
    /// The product of matrices, or of a number and a matrix.
    Times,
    /// Entry by entry.
    Entrywise,
    Over,
    /// Σ wᵢ aᵢ over a list.
    Sum,
    /// A list of numbers as a vector.
    Stacked,
    /// a aᵀ.
    Outer,
    Transpose,
    Inverse,
    /// ln det, by pivots.
    LogDeterminant,
    /// The lower factor of Cholesky.
    Factor,
    Negative,
    Twice,
    Half,
    Exponential,
    Logarithm,
    Root,
    Square,
    Absolute,
    Truncated,
    Single,
    Wrapped,
    Diagonal,
    Upper,
    Lower,
    FirstRow,
    FirstColumn,
    LastEntry,
    Zero,
    /// Divided by the sum.
    Normalised,
    /// exp(a − max a).
    Likelihood,
    /// Diagonal entries of at least so much.
    Floor,
    /// Diagonal entries of at most so much.
    Ceiling,
    /// Diagonal entries and so much.
    OnDiagonal,
    /// f, of a state or of each.
    Move,
    /// h, of a state or of each.
    Measure,
    MotionSlope,
    MeasurementSlope,
    /// c, of each mode: its state converted to the reader's state.
    Read,
    ReadSlope,
}

/// What one value can be turned into.
pub(super) const UNARY: [Operation; 23] = [
    Operation::Transpose,
    Operation::Inverse,
    Operation::Negative,
    Operation::Twice,
    Operation::Half,
    Operation::Root,
    Operation::Square,
    Operation::Absolute,
    Operation::Exponential,
    Operation::Logarithm,
    Operation::Diagonal,
    Operation::Upper,
    Operation::Lower,
    Operation::FirstRow,
    Operation::FirstColumn,
    Operation::LastEntry,
    Operation::Factor,
    Operation::Single,
    Operation::Truncated,
    Operation::Wrapped,
    Operation::Normalised,
    Operation::Outer,
    Operation::Zero,
];

impl Tree {
    pub(super) fn of(operation: Operation, parts: impl Into<Vec<Tree>>) -> Self {
        Self::Node(operation, parts.into())
    }

    pub(super) fn unary(self, operation: Operation) -> Self {
        Self::of(operation, [self])
    }

    pub(super) fn transpose(self) -> Self {
        self.unary(Operation::Transpose)
    }

    pub(super) fn inverse(self) -> Self {
        self.unary(Operation::Inverse)
    }

    pub(super) fn outer(self) -> Self {
        self.unary(Operation::Outer)
    }

    pub(super) fn wrapped(self) -> Self {
        self.unary(Operation::Wrapped)
    }

    /// Σ wᵢ aᵢ.
    pub(super) fn sum(weights: Self, list: Self) -> Self {
        Self::of(Operation::Sum, [weights, list])
    }

    pub(super) fn parts(&self) -> &[Tree] {
        match self {
            Self::Node(_, parts) => parts,
            _ => &[],
        }
    }

    /// Every formula inside of this one with the way to it, itself first.
    pub(super) fn places(&self) -> Vec<(Vec<usize>, &Tree)> {
        let mut found = vec![(Vec::new(), self)];
        for (index, part) in self.parts().iter().enumerate() {
            for (mut way, tree) in part.places() {
                way.insert(0, index);
                found.push((way, tree));
            }
        }
        found
    }

    /// The same with another formula at a place.
    pub(super) fn with(&self, way: &[usize], new: &Tree) -> Tree {
        match (self, way) {
            (Self::Node(operation, parts), [first, rest @ ..]) => {
                let mut parts = parts.clone();
                parts[*first] = parts[*first].with(rest, new);
                Self::Node(*operation, parts)
            }
            _ => new.clone(),
        }
    }

    /// The same with another formula for every leaf of a kind.
    pub(super) fn with_all(&self, old: Leaf, new: &Tree) -> Tree {
        match self {
            Self::Leaf(leaf) if *leaf == old => new.clone(),
            Self::Node(operation, parts) => {
                let parts = parts.iter().map(|part| part.with_all(old, new)).collect();
                Self::Node(*operation, parts)
            }
            _ => self.clone(),
        }
    }

    /// The leaves, each as often as it stands there.
    pub(super) fn leaves(&self) -> Vec<Leaf> {
        let leaf = |(_, tree): (Vec<usize>, &Tree)| match tree {
            Self::Leaf(leaf) => Some(*leaf),
            _ => None,
        };
        self.places().into_iter().filter_map(leaf).collect()
    }

    /// The same with something done to every leaf of a kind.
    pub(super) fn with_each(&self, is_meant: &dyn Fn(Leaf) -> bool, operation: Operation) -> Tree {
        match self {
            Self::Leaf(leaf) if is_meant(*leaf) => self.clone().unary(operation),
            Self::Node(own, parts) => {
                let parts = parts.iter().map(|part| part.with_each(is_meant, operation)).collect();
                Self::Node(*own, parts)
            }
            _ => self.clone(),
        }
    }
}

impl Add for Tree {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::of(Operation::Plus, [self, other])
    }
}

impl Sub for Tree {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::of(Operation::Minus, [self, other])
    }
}

impl Mul for Tree {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self::of(Operation::Times, [self, other])
    }
}
