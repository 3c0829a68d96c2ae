//! Factorisations of symmetric positive definite matrices, for every number system.
//!
//! The filters use two triangular factorisations, for two reasons:
//!
//! - [`cholesky`], P = S Sᵀ, needs square roots. The cubature filters draw their points with it.
//! - [`ldl`], P = L D Lᵀ with a unit diagonal in L, needs only + − × ÷. Gains, log-determinants and quadratic forms come
//!   from it, so these equations run on exact rationals and on rational functions too.
//!
//! ```text
//! P ─ cholesky ─▶ S ─▶ points                                     mixed and predicted covariances of filters with points
//! S ─ ldl ─▶ L, D ─ check_positive_definite ─▶ solve              gain
//!                                          └─▶ quadratic_form     exponent of the density
//! lower triangle ─ mirrored ─▶ P                                  predicted and updated covariances
//! ```
//!
//! Both read the lower triangle only. Neither repairs a matrix: a pivot that is not positive is an error. A row of zeros is no pivot: an
//! entry of the state that is known exactly has one in its covariance, and in the square root.

mod shapes;

pub(crate) use shapes::rows;
pub use shapes::{Holds, Shapes};

use crate::number::{Field, Real};
use nalgebra::allocator::Allocator;
use nalgebra::{Dim, OMatrix, OVector, U1};
use std::cmp::Ordering;

/// A pivot of a factorisation was not positive, or could not be shown to be.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("is not positive definite: pivot {} of {dimension} is {}", pivot + 1, if *.decided { "not positive" } else { "not a number, or of undecided sign" })]
pub struct NotPositiveDefinite {
    /// The row of the pivot, counted from 0.
    pub pivot: usize,
    /// The number of rows.
    pub dimension: usize,
    /// Whether the pivot is known to be zero or negative; otherwise its sign could not be decided.
    pub decided: bool,
}

/// The square root of a covariance: its lower Cholesky factor — zhu2016 (1), (27).
///
/// ```text
/// P = S Sᵀ,   Sⱼⱼ = √(Pⱼⱼ − Σ₍k<j₎ Sⱼₖ²),   Sᵢⱼ = (Pᵢⱼ − Σ₍k<j₎ Sᵢₖ Sⱼₖ) / Sⱼⱼ  for i > j
/// ```
///
/// | paper | here       | shape | meaning                                                     |
/// |-------|------------|-------|-------------------------------------------------------------|
/// | P     | `matrix`   | N × N | a covariance; only its lower triangle is read                |
/// | S     | the result | N × N | lower triangular, positive diagonal; unit: root of P's unit  |
///
/// Why: with x = x̂ + S ξ and ξ of zero mean and unit covariance, x has mean x̂ and covariance S Sᵀ = P. Any other square
/// root would do as well; the lower Cholesky factor is the papers' choice and this crate's convention.
///
/// An entry that is known exactly has a row and a column of zeros in P, and so in S: the acceleration of a constant velocity motion that
/// shares the state of another. The formula is then that of the other entries alone.
///
/// Example: a covariance of deviations 2 and √10 by hand, one with an entry that is known exactly, and one that is none.
///
/// ```
/// use immaculate::matrix::cholesky;
/// use nalgebra::matrix;
///
/// // √4, 2/2, √(10 − 1²)
/// assert_eq!(cholesky(&matrix![4.0, 2.0; 2.0, 10.0]).unwrap(), matrix![2.0, 0.0; 1.0, 3.0]);
/// assert_eq!(cholesky(&matrix![0.0, 0.0; 0.0, 9.0]).unwrap(), matrix![0.0, 0.0; 0.0, 3.0]);
/// // 1 − 2² is negative: a correlation of 2 does not exist.
/// assert_eq!(cholesky(&matrix![1.0, 2.0; 2.0, 1.0]).unwrap_err().pivot, 1);
/// ```
///
/// # Errors
///
/// [`NotPositiveDefinite`] when the pivot of another row is not positive.
///
/// Evidence: `the_cholesky_factor_times_its_transpose_is_the_matrix` (exact),
/// `an_entry_without_variance_has_a_row_of_zeros_in_the_square_root` (exact),
/// `a_matrix_that_is_not_positive_definite_has_no_cholesky_factor`.
pub fn cholesky<T: Real, N: Dim>(matrix: &OMatrix<T, N, N>) -> Result<OMatrix<T, N, N>, NotPositiveDefinite>
where
    Shapes: Holds<N>,
{
    let n = matrix.nrows();
    let mut root = OMatrix::<T, N, N>::zeros_generic(rows(matrix), rows(matrix));
    for j in 0..n {
        if is_row_of_zeros(matrix, j) {
            continue;
        }
        let mut pivot = matrix[(j, j)].clone();
        for k in 0..j {
            pivot -= root[(j, k)].clone() * root[(j, k)].clone();
        }
        check_pivot(&pivot, j, n)?;
        root[(j, j)] = pivot.sqrt();
        for i in j + 1..n {
            let mut entry = matrix[(i, j)].clone();
            for k in 0..j {
                entry -= root[(i, k)].clone() * root[(j, k)].clone();
            }
            root[(i, j)] = entry / root[(j, j)].clone();
        }
    }
    Ok(root)
}

/// Whether row j of a symmetric matrix, of which the lower triangle is read, has nothing but zeros.
fn is_row_of_zeros<T: Field, N: Dim>(matrix: &OMatrix<T, N, N>, j: usize) -> bool
where
    Shapes: Holds<N>,
{
    matrix[(j, j)].is_zero() && (0..matrix.nrows()).all(|i| matrix[(i.max(j), i.min(j))].is_zero())
}

/// A pivot must be known to be positive.
fn check_pivot<T: Field + PartialOrd>(pivot: &T, row: usize, dimension: usize) -> Result<(), NotPositiveDefinite> {
    let order = pivot.partial_cmp(&T::zero());
    if order == Some(Ordering::Greater) {
        return Ok(());
    }
    Err(NotPositiveDefinite {
        pivot: row,
        dimension,
        decided: order.is_some(),
    })
}

/// The factors of P = L D Lᵀ; see [`ldl`].
#[derive(Debug, Clone, PartialEq)]
pub struct Ldl<T: Field, N: Dim>
where
    Shapes: Holds<N>,
{
    /// L: lower triangular with ones on the diagonal.
    pub lower: OMatrix<T, N, N>,
    /// The diagonal of D.
    pub diagonal: OVector<T, N>,
}

/// The factorisation P = L D Lᵀ.
///
/// ```text
/// Dⱼ = Pⱼⱼ − Σ₍k<j₎ Lⱼₖ² Dₖ,   Lᵢⱼ = (Pᵢⱼ − Σ₍k<j₎ Lᵢₖ Lⱼₖ Dₖ) / Dⱼ  for i > j
/// ```
///
/// Source: Golub and Van Loan, Matrix Computations, 4th edition, section 4.1.2.
///
/// A pivot of zero makes what follows it [`Field::undecided`]; for an ordered number system [`check_positive_definite`]
/// says so as an error.
///
/// Example: no root is needed, so the factors of a rational matrix are rational, for doubles and for unknowns alike.
///
/// ```
/// use immaculate::matrix::ldl;
/// use nalgebra::{matrix, vector};
///
/// let factors = ldl(&matrix![4.0, 2.0; 2.0, 10.0]);
/// // 4, 10 − (2/4)² · 4
/// assert_eq!(factors.diagonal, vector![4.0, 9.0]);
/// assert_eq!(factors.lower, matrix![1.0, 0.0; 0.5, 1.0]);
///
/// use immaculate::number::RationalFunction;
/// let [p, c, r] = ["p", "c", "r"].map(RationalFunction::unknown);
/// let pivots = ldl(&matrix![p.clone(), c.clone(); c.clone(), r.clone()]).diagonal;
/// assert_eq!(pivots[1], r - c.clone() * c / p);
/// ```
///
/// Evidence: `the_ldl_factors_multiply_to_the_matrix` (symbolic).
pub fn ldl<T: Field, N: Dim>(matrix: &OMatrix<T, N, N>) -> Ldl<T, N>
where
    Shapes: Holds<N>,
{
    let n = matrix.nrows();
    let mut lower = OMatrix::<T, N, N>::identity_generic(rows(matrix), rows(matrix));
    let mut diagonal = OVector::<T, N>::zeros_generic(rows(matrix), U1);
    for j in 0..n {
        let mut pivot = matrix[(j, j)].clone();
        for k in 0..j {
            pivot -= lower[(j, k)].clone() * lower[(j, k)].clone() * diagonal[k].clone();
        }
        diagonal[j] = pivot;
        for i in j + 1..n {
            let mut entry = matrix[(i, j)].clone();
            for k in 0..j {
                entry -= lower[(i, k)].clone() * lower[(j, k)].clone() * diagonal[k].clone();
            }
            lower[(i, j)] = entry / diagonal[j].clone();
        }
    }
    Ldl { lower, diagonal }
}

/// All pivots of a factorisation must be known to be positive: only then is L D Lᵀ positive definite.
///
/// Source: vᵀ L D Lᵀ v = Σᵢ Dᵢ yᵢ² with y = Lᵀ v, and L is invertible.
///
/// Example: the error says which pivot it was.
///
/// ```
/// use immaculate::matrix::{check_positive_definite, ldl};
/// use nalgebra::matrix;
///
/// assert!(check_positive_definite(&ldl(&matrix![4.0, 2.0; 2.0, 10.0])).is_ok());
/// // 1, then 1 − 2²/1
/// let error = check_positive_definite(&ldl(&matrix![1.0, 2.0; 2.0, 1.0])).unwrap_err();
/// assert_eq!(error.to_string(), "is not positive definite: pivot 2 of 2 is not positive");
/// ```
///
/// # Errors
///
/// [`NotPositiveDefinite`] with the first pivot that is not.
pub fn check_positive_definite<T: Field + PartialOrd, N: Dim>(factors: &Ldl<T, N>) -> Result<(), NotPositiveDefinite>
where
    Shapes: Holds<N>,
{
    for (row, pivot) in factors.diagonal.iter().enumerate() {
        check_pivot(pivot, row, factors.diagonal.len())?;
    }
    Ok(())
}

/// The solution X of L D Lᵀ X = B, column by column: forward substitution, division by D, back substitution.
///
/// Source: Golub and Van Loan, Matrix Computations, 4th edition, section 3.1.
///
/// Example: 4x + 2y = 8 and 2x + 10y = 22.
///
/// ```
/// use immaculate::matrix::{ldl, solve};
/// use nalgebra::{matrix, vector};
///
/// let factors = ldl(&matrix![4.0, 2.0; 2.0, 10.0]);
/// // forward (8, 22 − ½ · 8), divided (8/4, 18/9), back (2 − ½ · 2, 2)
/// assert_eq!(solve(&factors, &vector![8.0, 22.0]), vector![1.0, 2.0]);
/// ```
///
/// Evidence: `solving_with_the_ldl_factors_inverts_the_matrix` (symbolic).
pub fn solve<T: Field, N: Dim, C: Dim>(factors: &Ldl<T, N>, right_side: &OMatrix<T, N, C>) -> OMatrix<T, N, C>
where
    Shapes: Holds<N> + Allocator<N, C>,
{
    let (n, columns) = right_side.shape();
    let mut solution = right_side.clone();
    for column in 0..columns {
        for i in 0..n {
            for k in 0..i {
                let known = factors.lower[(i, k)].clone() * solution[(k, column)].clone();
                solution[(i, column)] -= known;
            }
        }
        for i in 0..n {
            solution[(i, column)] /= factors.diagonal[i].clone();
        }
        for i in (0..n).rev() {
            for k in i + 1..n {
                let known = factors.lower[(k, i)].clone() * solution[(k, column)].clone();
                solution[(i, column)] -= known;
            }
        }
    }
    solution
}

/// The quadratic form vᵀ P⁻¹ v = Σᵢ yᵢ² / Dᵢ with L y = v.
///
/// Source: P⁻¹ = L⁻ᵀ D⁻¹ L⁻¹, so vᵀ P⁻¹ v = (L⁻¹v)ᵀ D⁻¹ (L⁻¹v).
///
/// Example: the squared distance of (2, 4) from zero, in deviations.
///
/// ```
/// use immaculate::matrix::{ldl, quadratic_form};
/// use nalgebra::{matrix, vector};
///
/// let factors = ldl(&matrix![4.0, 2.0; 2.0, 10.0]);
/// // y = (2, 4 − ½ · 2):   2²/4 + 3²/9
/// assert_eq!(quadratic_form(&factors, &vector![2.0, 4.0]), 2.0);
/// ```
///
/// Evidence: `the_quadratic_form_is_the_one_of_the_inverse` (symbolic).
pub fn quadratic_form<T: Field, N: Dim>(factors: &Ldl<T, N>, vector: &OVector<T, N>) -> T
where
    Shapes: Holds<N>,
{
    let mut y = vector.clone();
    let mut sum = T::zero();
    for i in 0..y.len() {
        for k in 0..i {
            let known = factors.lower[(i, k)].clone() * y[k].clone();
            y[i] -= known;
        }
        sum += y[i].clone() * y[i].clone() / factors.diagonal[i].clone();
    }
    sum
}

/// The logarithm of the determinant, ln|P| = Σᵢ ln Dᵢ.
///
/// Source: |L D Lᵀ| = |D|, since L has a unit diagonal.
///
/// Example: a determinant may underflow; its logarithm does not.
///
/// ```
/// use immaculate::{matrix::{ldl, log_determinant}, number::Real};
/// use nalgebra::matrix;
///
/// // |P| = 4 · 10 − 2² = 36 = 4 · 9
/// let factors = ldl(&matrix![4.0, 2.0; 2.0, 10.0]);
/// assert_eq!(log_determinant(&factors), Real::ln(&4.0) + Real::ln(&9.0));
///
/// let small = ldl(&matrix![1e-200, 0.0; 0.0, 1e-200]);
/// assert_eq!(small.diagonal.product(), 0.0);
/// assert_eq!(log_determinant(&small), 2.0 * Real::ln(&1e-200));
/// ```
///
/// Evidence: `the_log_determinant_is_the_logarithm_of_the_determinant` (property).
pub fn log_determinant<T: Real, N: Dim>(factors: &Ldl<T, N>) -> T
where
    Shapes: Holds<N>,
{
    let mut sum = T::zero();
    for pivot in factors.diagonal.iter() {
        sum += pivot.ln();
    }
    sum
}

/// The symmetric matrix with the given lower triangle: P = Pᵀ, the definition of a covariance, for a product that has it up to rounding.
///
/// ```text
/// Pᵢⱼ := Pⱼᵢ  for i < j
/// ```
///
/// Source: the definition; zhu2016 and liu2017 say nothing of it.
///
/// Why: in exact arithmetic this changes nothing. In rounded arithmetic F P Fᵀ and P − W S Wᵀ are a few last places off symmetry, and
/// the two triangles then go different ways: the antisymmetric part E follows E ← F E Fᵀ, which no measurement corrects. Along a straight
/// track with the chain and noise of liu2017 it grows until, after some thousand steps, a covariance is not positive definite any more.
///
/// Example: what stands above the diagonal is not read.
///
/// ```
/// use immaculate::matrix::mirrored;
/// use nalgebra::matrix;
///
/// assert_eq!(mirrored(matrix![4.0, 2.000001; 2.0, 10.0]), matrix![4.0, 2.0; 2.0, 10.0]);
/// ```
///
/// Evidence: `without_the_mirrored_triangle_a_long_run_fails` (property).
pub fn mirrored<T: Field, N: Dim>(lower: OMatrix<T, N, N>) -> OMatrix<T, N, N>
where
    Shapes: Holds<N>,
{
    let mut matrix = lower;
    let n = matrix.nrows();
    for i in 0..n {
        for j in i + 1..n {
            matrix[(i, j)] = matrix[(j, i)].clone();
        }
    }
    matrix
}

/// A symmetric matrix is positive definite when all its pivots are positive.
///
/// Source: [`check_positive_definite`].
///
/// Example: definite, semidefinite, and neither.
///
/// ```
/// use immaculate::matrix::is_positive_definite;
/// use nalgebra::matrix;
///
/// assert!(is_positive_definite(&matrix![4.0, 2.0; 2.0, 10.0]));
/// assert!(!is_positive_definite(&matrix![1.0, 1.0; 1.0, 1.0])); // 1, then 1 − 1²
/// assert!(!is_positive_definite(&matrix![1.0, 2.0; 2.0, 1.0])); // 1, then 1 − 2²
/// ```
pub fn is_positive_definite<T: Field + PartialOrd, N: Dim>(matrix: &OMatrix<T, N, N>) -> bool
where
    Shapes: Holds<N>,
{
    check_positive_definite(&ldl(matrix)).is_ok()
}

/// A matrix is symmetric when it equals its transpose entry by entry.
pub fn is_symmetric<T: Field, N: Dim>(matrix: &OMatrix<T, N, N>) -> bool
where
    Shapes: Holds<N>,
{
    (0..matrix.nrows()).all(|i| (0..i).all(|j| matrix[(i, j)] == matrix[(j, i)]))
}

/// A symmetric matrix is positive semidefinite when its elimination meets no negative pivot, and below a pivot of zero
/// nothing but zeros.
///
/// Noise covariances of low rank are legitimate (zhu2016's has rank two), and elimination in rounded arithmetic leaves a
/// rest of their zero pivots: of the order of N roundings of the diagonal, if the greatest pivot always goes first. A pivot counts
/// as zero below N · 2⁻⁵⁰ of its diagonal entry, and an entry below it when its square does against the product of its two
/// diagonal entries (it is no greater in a semidefinite matrix, by Cauchy's inequality).
///
/// Source: Golub and Van Loan, Matrix Computations, 4th edition, section 4.2, positive semidefinite matrices; the pivots are
/// compared as parts of their diagonal entries, so that units do not matter.
///
/// Example: the noise of an acceleration, G q Gᵀ with G = (½, 1), has rank one and is a covariance.
///
/// ```
/// use immaculate::matrix::is_positive_semidefinite;
/// use nalgebra::matrix;
///
/// assert!(is_positive_semidefinite(&matrix![0.25, 0.5; 0.5, 1.0]));
/// assert!(!is_positive_semidefinite(&matrix![0.25, 0.75; 0.75, 1.0])); // 1, then ¼ − ¾²
/// assert!(!is_positive_semidefinite(&matrix![0.0, 1.0; 1.0, 4.0])); // no variance, and yet a covariance
/// ```
///
/// Evidence: `a_matrix_is_positive_semidefinite_exactly_when_no_pivot_is_negative`,
/// `a_covariance_of_low_rank_is_positive_semidefinite_as_rounded` (property).
pub fn is_positive_semidefinite<T: Field + PartialOrd, N: Dim>(matrix: &OMatrix<T, N, N>) -> bool
where
    Shapes: Holds<N>,
{
    if !all_finite(matrix) {
        return false;
    }
    let rounding = T::integer(i64::try_from(matrix.nrows()).unwrap_or(i64::MAX)) / T::integer(1 << 50);
    let mut rest = matrix.clone();
    let mut rows: Vec<usize> = (0..matrix.nrows()).collect();
    while !rows.is_empty() {
        let j = take_greatest_pivot(&mut rows, matrix, &rest);
        let noise = rounding.clone() * matrix[(j, j)].clone();
        let pivot = rest[(j, j)].clone();
        let is_negligible = pivot <= noise;
        if is_negligible && pivot < -noise {
            return false;
        }
        if is_negligible {
            let vanishes = |&i: &usize| {
                let square = rest[(i, j)].clone() * rest[(i, j)].clone();
                let bound = matrix[(i, i)].clone() * matrix[(j, j)].clone();
                square <= bound * rounding.clone()
            };
            if !rows.iter().all(vanishes) {
                return false;
            }
            continue;
        }
        for &i in &rows {
            let factor = rest[(i, j)].clone() / pivot.clone();
            for &k in &rows {
                let eliminated = factor.clone() * rest[(j, k)].clone();
                rest[(i, k)] -= eliminated;
            }
        }
    }
    true
}

/// Takes out the row whose pivot is the greatest part of its diagonal entry.
fn take_greatest_pivot<T: Field + PartialOrd, N: Dim>(
    rows: &mut Vec<usize>,
    matrix: &OMatrix<T, N, N>,
    rest: &OMatrix<T, N, N>,
) -> usize
where
    Shapes: Holds<N>,
{
    let mut best = 0;
    for place in 1..rows.len() {
        let (i, j) = (rows[place], rows[best]);
        // restᵢᵢ/Pᵢᵢ > restⱼⱼ/Pⱼⱼ, without a division by a variance of zero.
        let is_greater = rest[(i, i)].clone() * matrix[(j, j)].clone() > rest[(j, j)].clone() * matrix[(i, i)].clone();
        if is_greater {
            best = place;
        }
    }
    rows.remove(best)
}

/// An entry is finite when it is decided: an infinity, a value that is not a number and an undecided value are not.
pub fn is_finite<T: Field>(value: &T) -> bool {
    value.is_decided()
}

/// All entries are finite; see [`is_finite`].
pub fn all_finite<T: Field, R: Dim, C: Dim>(matrix: &OMatrix<T, R, C>) -> bool
where
    Shapes: Allocator<R, C>,
{
    matrix.iter().all(is_finite)
}
