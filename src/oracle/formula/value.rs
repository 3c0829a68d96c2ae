//! The value of a formula on the numbers of a step: a matrix, or a list of matrices.
//!
//! An operation that has no result, such as a product of the wrong sizes, gives none.

use super::instance::Instance;
use super::tree::{Definition, Operation, Tree};
use crate::matrix::{cholesky, ldl};
use crate::number::{Field, RandomRounding, Real};
use nalgebra::DMatrix;
use num_traits::{One as _, Zero as _};

/// The numbers of formulas: doubles, which are perturbed where their rounding is asked for.
pub(super) type Number = RandomRounding;

/// A matrix; vectors have one column, numbers one row, too.
pub(super) type Matrix = DMatrix<Number>;

/// The value of a formula.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Term {
    One(Matrix),
    /// A list, over modes or points.
    Each(Vec<Matrix>),
}

/// What a formula is evaluated with, besides the values of a step: a fitted number, and another definition.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct With<'a> {
    pub(super) number: Option<f64>,
    pub(super) definition: Option<(Definition, &'a Tree)>,
}

impl Tree {
    /// The value at an instance.
    pub(super) fn value(&self, at: &Instance, with: With) -> Option<Term> {
        match self {
            Self::Leaf(leaf) => at.leaf(*leaf, with),
            Self::Fitted => Some(Term::One(DMatrix::from_element(1, 1, Number::exact(with.number?)))),
            Self::Node(operation, parts) => {
                let first = parts.first()?.value(at, with)?;
                match parts.get(1) {
                    None if *operation == Operation::Stacked => first.stacked(),
                    None => first.each(|member, a| operation.of_one(a, at, member)),
                    Some(second) if *operation == Operation::Sum => first.weighted_sum(&second.value(at, with)?),
                    Some(second) => first.pairs(&second.value(at, with)?, |a, b| operation.of_two(a, b)),
                }
            }
        }
    }

    /// The value as one matrix.
    pub(super) fn matrix(&self, at: &Instance, with: With) -> Option<Matrix> {
        match self.value(at, with)? {
            Term::One(matrix) => Some(matrix),
            Term::Each(_) => None,
        }
    }
}

impl Term {
    /// Rows and columns, and whether it is a list.
    pub(super) fn shape(&self) -> (usize, usize, bool) {
        match self {
            Self::One(matrix) => (matrix.nrows(), matrix.ncols(), false),
            Self::Each(list) => (list[0].nrows(), list[0].ncols(), true),
        }
    }

    /// The operation knows which member of a list it is done to.
    fn each(&self, operation: impl Fn(Option<usize>, &Matrix) -> Option<Matrix>) -> Option<Self> {
        match self {
            Self::One(matrix) => operation(None, matrix).map(Self::One),
            Self::Each(list) => {
                let members = list.iter().enumerate();
                let all = members.map(|(index, member)| operation(Some(index), member));
                all.collect::<Option<_>>().map(Self::Each)
            }
        }
    }

    /// What is no list stands beside each member of one.
    fn pairs(&self, other: &Self, operation: impl Fn(&Matrix, &Matrix) -> Option<Matrix>) -> Option<Self> {
        let list: Option<Vec<Matrix>> = match (self, other) {
            (Self::One(a), Self::One(b)) => return operation(a, b).map(Self::One),
            (Self::One(a), Self::Each(b)) => b.iter().map(|b| operation(a, b)).collect(),
            (Self::Each(a), Self::One(b)) => a.iter().map(|a| operation(a, b)).collect(),
            (Self::Each(a), Self::Each(b)) if a.len() == b.len() => {
                a.iter().zip(b).map(|(a, b)| operation(a, b)).collect()
            }
            _ => None,
        };
        list.map(Self::Each)
    }

    /// A list of numbers as a vector.
    fn stacked(&self) -> Option<Self> {
        let Self::Each(list) = self else { return None };
        let are_numbers = list.iter().all(|member| member.shape() == (1, 1));
        let numbers = list.iter().map(|member| member[(0, 0)]);
        are_numbers.then(|| Self::One(DMatrix::from_iterator(list.len(), 1, numbers)))
    }

    /// Σ wᵢ aᵢ, with a vector of weights.
    fn weighted_sum(&self, list: &Self) -> Option<Self> {
        let (Self::One(weights), Self::Each(list)) = (self, list) else {
            return None;
        };
        if weights.len() != list.len() || weights.ncols() != 1 {
            return None;
        }
        let mut sum = DMatrix::zeros(list[0].nrows(), list[0].ncols());
        for (weight, member) in weights.iter().zip(list) {
            sum += scaled(member, *weight);
        }
        Some(Self::One(sum))
    }
}

/// The numbers of a matrix, by rows.
pub(super) fn by_rows(matrix: &Matrix) -> Vec<f64> {
    matrix.transpose().iter().copied().map(Number::value).collect()
}

fn scaled(matrix: &Matrix, factor: Number) -> Matrix {
    matrix.map(|entry| entry * factor)
}

/// A matrix of the same size, entry by entry from row, column and the old entry.
fn mapped(matrix: &Matrix, entry: impl Fn(usize, usize, Number) -> Number) -> Matrix {
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, k| entry(i, k, matrix[(i, k)]))
}

/// The entries for which something is true, and zero elsewhere.
fn kept(matrix: &Matrix, is_kept: impl Fn(usize, usize) -> bool) -> Matrix {
    mapped(matrix, |i, k, entry| if is_kept(i, k) { entry } else { Number::zero() })
}

fn double(number: Number, function: impl Fn(f64) -> f64) -> Number {
    Number::exact(function(number.value()))
}

impl Operation {
    #[allow(clippy::cast_possible_truncation, reason = "single precision is what is meant")]
    fn of_one(self, a: &Matrix, at: &Instance, member: Option<usize>) -> Option<Matrix> {
        let (rows, columns) = a.shape();
        let is_square = rows == columns;
        Some(match self {
            Self::Transpose => a.transpose(),
            Self::Inverse => return inverse(a),
            Self::LogDeterminant => return log_determinant(a),
            Self::Factor if is_square => cholesky(a).ok()?,
            Self::Outer if columns == 1 => a * a.transpose(),
            Self::Negative => -a.clone(),
            Self::Twice => scaled(a, Number::integer(2)),
            Self::Half => scaled(a, Number::ratio(1, 2)),
            Self::Exponential => a.map(|entry| Real::exp(&entry)),
            Self::Logarithm => a.map(|entry| Real::ln(&double(entry, f64::abs))),
            Self::Root => a.map(|entry| Real::sqrt(&double(entry, f64::abs))),
            Self::Square => a.map(|entry| entry * entry),
            Self::Absolute => a.map(|entry| double(entry, f64::abs)),
            Self::Truncated => a.map(|entry| double(entry, f64::trunc)),
            Self::Single => a.map(|entry| double(entry, |value| f64::from(value as f32))),
            Self::Wrapped => return at.wrapped(a),
            Self::Diagonal if is_square => kept(a, |i, k| i == k),
            Self::Upper if is_square => kept(a, |i, k| i <= k),
            Self::Lower if is_square => kept(a, |i, k| i >= k),
            Self::FirstRow => kept(a, |i, _| i == 0),
            Self::FirstColumn if columns > 1 => kept(a, |_, k| k == 0),
            Self::LastEntry => kept(a, |i, k| (i + 1, k + 1) == (rows, columns)),
            Self::Zero => DMatrix::zeros(rows, columns),
            Self::Normalised => {
                let sum = a.iter().fold(Number::zero(), |sum, entry| sum + *entry);
                a.map(|entry| entry / sum)
            }
            Self::Likelihood => {
                let greatest = a.iter().map(|entry| entry.value()).fold(f64::NEG_INFINITY, f64::max);
                a.map(|entry| Real::exp(&(entry - Number::exact(greatest))))
            }
            Self::Move => return at.moved(a),
            Self::Measure => return at.measured(a),
            Self::MotionSlope => return at.motion_slope(a),
            Self::MeasurementSlope => return at.measurement_slope(a),
            Self::Read => return at.read(a, member?),
            Self::ReadSlope => return at.read_slope(a, member?),
            _ => return None,
        })
    }

    fn of_two(self, a: &Matrix, b: &Matrix) -> Option<Matrix> {
        let is_number = |matrix: &Matrix| matrix.shape() == (1, 1);
        let is_alike = a.shape() == b.shape();
        Some(match self {
            Self::Plus if is_alike => a + b,
            Self::Minus if is_alike => a - b,
            Self::Entrywise if is_alike => a.zip_map(b, |a, b| a * b),
            Self::Over if is_number(b) => a.map(|entry| entry / b[(0, 0)]),
            Self::Over if is_alike => a.zip_map(b, |a, b| a / b),
            Self::Times if is_number(a) => scaled(b, a[(0, 0)]),
            Self::Times if is_number(b) => scaled(a, b[(0, 0)]),
            Self::Times if a.ncols() == b.nrows() => a * b,
            Self::Floor if is_number(a) => on_diagonal(b, |entry| double(entry, |value| value.max(a[(0, 0)].value()))),
            Self::Ceiling if is_number(a) => {
                on_diagonal(b, |entry| double(entry, |value| value.min(a[(0, 0)].value())))
            }
            Self::OnDiagonal if is_number(a) => on_diagonal(b, |entry| entry + a[(0, 0)]),
            _ => return None,
        })
    }
}

fn on_diagonal(matrix: &Matrix, of: impl Fn(Number) -> Number) -> Matrix {
    mapped(matrix, |i, k, entry| if i == k { of(entry) } else { entry })
}

/// The inverse by Gauss and Jordan, the greatest entry of each column as its pivot.
fn inverse(matrix: &Matrix) -> Option<Matrix> {
    let n = matrix.nrows();
    if n != matrix.ncols() {
        return None;
    }
    let mut left = matrix.clone();
    let mut right = DMatrix::from_fn(n, n, |i, k| if i == k { Number::one() } else { Number::zero() });
    for column in 0..n {
        let size = |row: &usize| left[(*row, column)].value().abs();
        let pivot = (column..n).max_by(|a, b| size(a).total_cmp(&size(b)))?;
        left.swap_rows(column, pivot);
        right.swap_rows(column, pivot);
        let pivot = left[(column, column)];
        if pivot.is_zero() {
            return None;
        }
        for k in 0..n {
            left[(column, k)] /= pivot;
            right[(column, k)] /= pivot;
        }
        for row in (0..n).filter(|row| *row != column) {
            let factor = left[(row, column)];
            for k in 0..n {
                let (of_left, of_right) = (left[(column, k)], right[(column, k)]);
                left[(row, k)] -= factor * of_left;
                right[(row, k)] -= factor * of_right;
            }
        }
    }
    Some(right)
}

fn log_determinant(matrix: &Matrix) -> Option<Matrix> {
    if matrix.nrows() != matrix.ncols() {
        return None;
    }
    let pivots = ldl(matrix).diagonal;
    let sum = pivots.iter().fold(Number::zero(), |sum, pivot| sum + Real::ln(pivot));
    Some(DMatrix::from_element(1, 1, sum))
}
