//! A set of errors that is carried from step to step without growing: an ellipsoid, whose image is bounded by two inequalities.
//!
//! The errors of a run are known to lie in {A v : |v| ≤ e}, with a matrix A of doubles and one number e. After a step they are J A v + w,
//! where J is known to lie in a matrix of intervals, and w, what was rounded in the step, in a box. The new set is
//!
//! ```text
//! {A′ v : |v| ≤ e′},   e′ = e √(1 + ‖E‖) / (1 − ‖F‖),
//! E = X [ (1 + 1/b) M Mᵀ + (1 + b) (ρ/e)² T Tᵀ ] Xᵀ − I,   M = J A,   F = X A′ − I
//! ```
//!
//! with Frobenius norms, and ρ such that {T w : |w| ≤ ρ} holds the box. **A′, X, T and b > 0 may be any doubles whatever**: they
//! decide how small the new set is, and not whether it holds. They are computed in plain arithmetic, A′ as a Cholesky factor of the
//! bracket and X as its inverse, so that E and F are rounding only.
//!
//! The proof. Let |v| ≤ e and |w| ≤ ρ, M any matrix in the intervals, d = M v + T w, and y any unit vector. By Cauchy and Schwarz, and
//! since (p + q)² ≤ (1 + 1/b) p² + (1 + b) q²,
//!
//! ```text
//! (yᵀ X d)² ≤ ( e |Mᵀ Xᵀ y| + ρ |Tᵀ Xᵀ y| )² ≤ e² yᵀ (I + E) y ≤ e² (1 + ‖E‖)
//! ```
//!
//! so that |X d| ≤ e √(1 + ‖E‖). If ‖F‖ < 1, X A′ = I + F can be inverted, so A′ can, and A′⁻¹ = (I + F)⁻¹ X: |A′⁻¹ d| ≤ |X d|/(1 − ‖F‖)
//! ≤ e′. E and F are computed in [`Interval`]s, their norms upward. The same with F alone bounds |T⁻¹ w| over the box.
//!
//! Why an ellipsoid, and one number: boxes wrap, and their width grows by 0.7 bits a step however they are scaled or turned by hand; a
//! fixed norm does not contract either, since a filter forgets only over some ten steps. The ellipsoid is the norm in which it
//! forgets: A follows J by itself. The best b makes the trace of the bracket least.
//!
//! Source: the sum of two ellipsoids in one, F. L. Chernousko, State Estimation for Dynamic Systems, 1994; the bound on an approximate
//! inverse, S. M. Rump, Verification methods: Rigorous results using floating-point arithmetic, Acta Numerica 19, 2010.

use crate::matrix::cholesky;
use crate::number::{Field, Interval, Real};
use nalgebra::DMatrix;
use num_traits::Zero;

/// What was rounded counts as at least this part of the set, 2⁻¹², so that no direction becomes so thin that A′ is singular in doubles. It
/// costs less than 0.001 bits a step.
const LEAST_PART: f64 = 1.0 / 4096.0;

/// The least b: where the set before counts for nothing.
const LEAST_SHARE: f64 = 1e-3;

/// All A v with |v| ≤ e.
///
/// Example: the errors of two numbers that are halved in a step, and rounded by no more than 2⁻³⁰.
///
/// ```
/// use immaculate::{number::Interval, oracle::ellipsoid::Ellipsoid};
/// use nalgebra::DMatrix;
///
/// let units = DMatrix::identity(2, 2);
/// let before = Ellipsoid { shape: units.clone(), size: 2.0_f64.powi(-20) };
/// let half = DMatrix::from_diagonal_element(2, 2, Interval::exact(0.5));
/// let after = before.image(&half, &[2.0_f64.powi(-30); 2], &units).unwrap();
/// let widths = after.half_widths();
/// assert!(widths[0] > 2.0_f64.powi(-21) && widths[0] < 1.1 * 2.0_f64.powi(-21));
/// ```
///
/// Evidence: `the_image_of_an_ellipsoid_holds_every_image_of_its_points`, `without_the_share_of_the_old_set_the_image_is_too_small`
/// (certified_runs).
#[derive(Debug, Clone, PartialEq)]
pub struct Ellipsoid {
    /// A.
    pub shape: DMatrix<f64>,
    /// e.
    pub size: f64,
}

impl Ellipsoid {
    /// The smallest set of this kind around a box: {T w} that holds every w with |wᵢ| no greater than its bound. None if T is singular.
    pub fn around(bounds: &[f64], units: &DMatrix<f64>) -> Option<Self> {
        let size = Units::of(units)?.radius_of(bounds)?;
        let shape = units.clone();
        (size.is_finite() && size > 0.0).then_some(Self { shape, size })
    }

    /// Upper bounds of the entries of what is in the set.
    pub fn half_widths(&self) -> Vec<f64> {
        let size = Interval::exact(self.size);
        let of_row = |row: usize| {
            let entries = self.shape.row(row).map(Interval::exact);
            (root_of_squares(entries.iter().copied()) * size).magnitude()
        };
        (0..self.shape.nrows()).map(of_row).collect()
    }

    /// A set that holds J a + w for every a of this one, every J of the intervals, and every w with |wᵢ| no greater than its bound.
    ///
    /// None where no such set was found: a matrix is singular in doubles, or the intervals are too wide.
    pub fn image(&self, jacobian: &DMatrix<Interval>, bounds: &[f64], units: &DMatrix<f64>) -> Option<Self> {
        let units = Units::of(units)?;
        let step = Moved {
            moved: product(jacobian, &exact(&self.shape)),
            part: self.part_of(bounds, &units)?,
        };
        self.checked(&Choice::of(&step, &units)?, &step, &units)
    }

    /// As [`Ellipsoid::image`], with a choice that is given. Any choice is sound; a bad one gives a large set.
    pub fn image_as_chosen(
        &self,
        jacobian: &DMatrix<Interval>,
        bounds: &[f64],
        units: &DMatrix<f64>,
        choice: &Choice,
    ) -> Option<Self> {
        let units = Units::of(units)?;
        let step = Moved {
            moved: product(jacobian, &exact(&self.shape)),
            part: self.part_of(bounds, &units)?,
        };
        self.checked(choice, &step, &units)
    }

    /// An upper bound of ρ/e, and not less than [`LEAST_PART`].
    fn part_of(&self, bounds: &[f64], units: &Units) -> Option<f64> {
        let rounded = units.radius_of(bounds)?.max(self.size * LEAST_PART);
        let part = (Interval::exact(rounded) / Interval::exact(self.size)).magnitude();
        part.is_finite().then_some(part)
    }

    /// The set with the e′ that two residuals prove: E of M and T, and F of the approximate inverse X.
    fn checked(&self, choice: &Choice, step: &Moved, units: &Units) -> Option<Self> {
        let one = Interval::integer(1);
        let (inverse, share) = (exact(&choice.inverse), Interval::exact(choice.share));
        let of_old = (one + one / share).sqrt();
        let of_new = (one + share).sqrt() * Interval::exact(step.part);
        let old = product(&inverse, &step.moved).map(|entry| entry * of_old);
        let new = product(&inverse, &exact(&units.matrix)).map(|entry| entry * of_new);
        let mut squares = product(&old, &old.transpose()) + product(&new, &new.transpose());
        let mut identity = product(&inverse, &exact(&choice.shape));
        for i in 0..squares.nrows() {
            squares[(i, i)] -= one;
            identity[(i, i)] -= one;
        }
        let excess = one + root_of_squares(squares.iter().copied());
        let kept = one - root_of_squares(identity.iter().copied());
        let size = (Interval::exact(self.size) * excess.sqrt() / kept).magnitude();
        let shape = choice.shape.clone();
        // Undecided where the norm of F may be one.
        (share > Interval::zero() && kept > Interval::zero() && size.is_finite()).then_some(Self { shape, size })
    }
}

/// A choice that decides how small the image is, and not whether it holds: any doubles with b > 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// A′.
    pub shape: DMatrix<f64>,
    /// X, about A′⁻¹.
    pub inverse: DMatrix<f64>,
    /// b.
    pub share: f64,
}

impl Choice {
    /// The choice that makes the set small, in plain doubles: b for the least trace of the bracket, A′ its Cholesky factor, X the inverse.
    fn of(step: &Moved, units: &Units) -> Option<Self> {
        let dimension = units.matrix.nrows();
        let part = step.part;
        // In units of T.
        let whitened = product(&units.inverse, &step.moved).map(Interval::middle);
        let share = (norm(whitened.iter().copied()) / (part * (dimension as f64).sqrt())).max(LEAST_SHARE);
        let bracket = DMatrix::from_fn(dimension, dimension, |i, j| {
            let old: f64 = (0..whitened.ncols()).map(|k| whitened[(i, k)] * whitened[(j, k)]).sum();
            let new = if i == j { (1.0 + share) * part * part } else { 0.0 };
            old * (1.0 + 1.0 / share) + new
        });
        let root = cholesky(&bracket).ok()?;
        let shape = product(&exact(&units.matrix), &exact(&root)).map(Interval::middle);
        let inverse = inverse_of_triangle(&shape)?;
        Some(Self { shape, inverse, share })
    }
}

/// A step as the inequalities see it.
struct Moved {
    /// M = J A.
    moved: DMatrix<Interval>,
    /// ρ/e, or more.
    part: f64,
}

/// A matrix T, and what is known of its inverse.
struct Units {
    matrix: DMatrix<f64>,
    /// About T⁻¹.
    inverse: DMatrix<Interval>,
    /// A lower bound of 1 − ‖inverse · T − I‖.
    kept: Interval,
}

impl Units {
    fn of(matrix: &DMatrix<f64>) -> Option<Self> {
        let inverse = exact(&inverse_of_triangle(matrix)?);
        let mut residual = product(&inverse, &exact(matrix));
        for i in 0..residual.nrows() {
            residual[(i, i)] -= Interval::integer(1);
        }
        let kept = Interval::integer(1) - root_of_squares(residual.iter().copied());
        let matrix = matrix.clone();
        (kept > Interval::zero()).then_some(Self { matrix, inverse, kept })
    }

    /// ρ: an upper bound of |T⁻¹ w| over all w with |wᵢ| no greater than its bound.
    fn radius_of(&self, bounds: &[f64]) -> Option<f64> {
        let of_row = |row: usize| {
            let mut sum = Interval::zero();
            for (column, &bound) in bounds.iter().enumerate() {
                sum += Interval::exact(self.inverse[(row, column)].magnitude()) * Interval::exact(bound);
            }
            sum
        };
        let radius = (root_of_squares((0..bounds.len()).map(of_row)) / self.kept).magnitude();
        radius.is_finite().then_some(radius)
    }
}

/// A matrix of doubles as intervals.
fn exact(matrix: &DMatrix<f64>) -> DMatrix<Interval> {
    matrix.map(Interval::exact)
}

/// The product of two matrices. The inner loop goes along columns, which are contiguous, and passes over the zeros of triangles.
fn product(left: &DMatrix<Interval>, right: &DMatrix<Interval>) -> DMatrix<Interval> {
    let rows = left.nrows();
    let mut result = DMatrix::from_element(rows, right.ncols(), Interval::zero());
    if rows == 0 {
        return result;
    }
    for (column, sums) in result.as_mut_slice().chunks_exact_mut(rows).enumerate() {
        for (k, entries) in left.as_slice().chunks_exact(rows).enumerate() {
            let factor = right[(k, column)];
            if factor.is_zero() {
                continue;
            }
            for (sum, entry) in sums.iter_mut().zip(entries) {
                if !entry.is_zero() {
                    *sum += *entry * factor;
                }
            }
        }
    }
    result
}

/// An interval that holds √Σ xᵢ² for the magnitudes of the entries, so that its magnitude is an upper bound of the norm.
fn root_of_squares(entries: impl Iterator<Item = Interval>) -> Interval {
    let mut sum = Interval::zero();
    for entry in entries {
        let size = Interval::exact(entry.magnitude());
        sum += size * size;
    }
    if sum.is_zero() {
        return sum;
    }
    Interval::exact(Interval::exact(sum.magnitude()).sqrt().magnitude())
}

/// √Σ xᵢ² in doubles, about.
fn norm(entries: impl Iterator<Item = f64>) -> f64 {
    entries.map(|entry| entry * entry).sum::<f64>().sqrt()
}

/// About the inverse of a lower triangular matrix; none where a diagonal entry is zero.
fn inverse_of_triangle(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = matrix.nrows();
    let mut inverse = DMatrix::zeros(n, n);
    for column in 0..n {
        for row in column..n {
            let known: f64 = (column..row).map(|k| matrix[(row, k)] * inverse[(k, column)]).sum();
            let unit = if row == column { 1.0 } else { 0.0 };
            let entry: f64 = (unit - known) / matrix[(row, row)];
            if !entry.is_finite() {
                return None;
            }
            inverse[(row, column)] = entry;
        }
    }
    Some(inverse)
}
