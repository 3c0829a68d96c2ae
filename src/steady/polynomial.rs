//! The characteristic polynomial of a matrix, and whether all its roots are inside the unit circle.
//!
//! The stability of a matrix is decided without computing an eigenvalue, by additions and multiplications alone. In exact rational
//! arithmetic the answer is a proof; on enclosures it is a proof or no answer.
//!
//! A matrix is a list of rows here, of any size: the frozen criterion joins several filters into one matrix.

use crate::matrix::Shapes;
use crate::number::Field;
use nalgebra::allocator::Allocator;
use nalgebra::{Dim, OMatrix};
use std::cmp::Ordering;

/// A matrix as a list of rows.
pub type MatrixRows<T> = Vec<Vec<T>>;

/// The rows of a matrix.
///
/// Source: a change of form.
///
/// Example: two rows of two.
///
/// ```
/// use immaculate::steady::polynomial::rows_of;
/// use nalgebra::matrix;
///
/// assert_eq!(rows_of(&matrix![1.0, 2.0; 3.0, 4.0]), [[1.0, 2.0], [3.0, 4.0]]);
/// ```
pub fn rows_of<T: Field, R: Dim, C: Dim>(matrix: &OMatrix<T, R, C>) -> MatrixRows<T>
where
    Shapes: Allocator<R, C>,
{
    let row = |i: usize| (0..matrix.ncols()).map(|j| matrix[(i, j)].clone()).collect();
    (0..matrix.nrows()).map(row).collect()
}

/// The characteristic polynomial det(λI − A), its coefficients from λ⁰ up to λⁿ.
///
/// ```text
/// M₁ = I,   cₙ₋ₖ = −tr(A Mₖ)/k,   Mₖ₊₁ = A Mₖ + cₙ₋ₖ I
/// ```
///
/// Source: Faddeev and Leverrier; Gantmacher, The Theory of Matrices, chapter IV, section 5.
///
/// Example: (λ − 2)(λ − 3) = 6 − 5λ + λ².
///
/// ```
/// use immaculate::number::{Field, Rational};
/// use immaculate::steady::polynomial::{characteristic_polynomial, rows_of};
/// use nalgebra::matrix;
///
/// let matrix = matrix![2, 1; 0, 3].map(Rational::integer);
/// assert_eq!(characteristic_polynomial(&rows_of(&matrix)), [6, -5, 1].map(Rational::integer));
/// ```
///
/// Evidence: `a_matrix_is_a_root_of_its_characteristic_polynomial` (symbolic).
pub fn characteristic_polynomial<T: Field>(matrix: &MatrixRows<T>) -> Vec<T> {
    let n = matrix.len();
    let mut coefficients = vec![T::one()];
    let mut power = identity(n);
    for k in 1..=n {
        let product = times(matrix, &power);
        let mut trace = T::zero();
        for (i, row) in product.iter().enumerate() {
            trace += row[i].clone();
        }
        let coefficient = -trace / T::integer(i64::try_from(k).unwrap_or(i64::MAX));
        power = product;
        for (i, row) in power.iter_mut().enumerate() {
            row[i] += coefficient.clone();
        }
        coefficients.push(coefficient);
    }
    coefficients.reverse();
    coefficients
}

fn identity<T: Field>(n: usize) -> MatrixRows<T> {
    let entry = |i, j| if i == j { T::one() } else { T::zero() };
    (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
}

fn times<T: Field>(left: &MatrixRows<T>, right: &MatrixRows<T>) -> MatrixRows<T> {
    let entry = |row: &Vec<T>, j: usize| {
        let mut sum = T::zero();
        for (a, b) in row.iter().zip(right) {
            sum += a.clone() * b[j].clone();
        }
        sum
    };
    left.iter()
        .map(|row| (0..right.len()).map(|j| entry(row, j)).collect())
        .collect()
}

/// Whether all roots of a polynomial (coefficients from λ⁰ up, the last not zero) are inside the unit circle; none if the number
/// system cannot tell.
///
/// ```text
/// p = a₀ + … + aₙ λⁿ is stable   exactly if   |a₀| < |aₙ| and (aₙ p − a₀ p*)/λ is stable,   p* = aₙ + … + a₀ λⁿ
/// ```
///
/// Why: |p| = |p*| on the circle, so with |a₀| < |aₙ| Rouché's theorem gives aₙ p and aₙ p − a₀ p* as many roots inside; the second
/// has one at zero, which is divided out. With |a₀| ≥ |aₙ| the product of the roots has a magnitude of one or more.
///
/// Source: Schur 1917, Cohn 1922.
///
/// Example: ½ − λ + λ² has the roots (1 ± i)/2, whose square of the magnitude is ½.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::polynomial::is_stable_polynomial;
///
/// let q = Rational::new;
/// assert_eq!(is_stable_polynomial(&[q(1, 2), q(-1, 1), q(1, 1)]), Some(true));
/// // 1 − 5/2 λ + λ² has ½ and 2.
/// assert_eq!(is_stable_polynomial(&[q(1, 1), q(-5, 2), q(1, 1)]), Some(false));
/// ```
///
/// Evidence: `the_schur_cohn_test_knows_where_roots_are` (exact).
pub fn is_stable_polynomial<T: Field + PartialOrd>(coefficients: &[T]) -> Option<bool> {
    let Some((highest, rest)) = coefficients.split_last().filter(|(_, rest)| !rest.is_empty()) else {
        return Some(true);
    };
    let lowest = &rest[0];
    let squares = |value: &T| value.clone() * value.clone();
    match squares(lowest).partial_cmp(&squares(highest))? {
        Ordering::Less => {}
        Ordering::Equal | Ordering::Greater => return Some(false),
    }
    let n = rest.len();
    let next = |k: usize| highest.clone() * coefficients[k].clone() - lowest.clone() * coefficients[n - k].clone();
    let reduced: Vec<T> = (1..=n).map(next).collect();
    is_stable_polynomial(&reduced)
}

/// Whether the spectral radius of a matrix is below a bound; none if the number system cannot tell.
///
/// Source: the roots of det(λI − A) are bound times those of the polynomial with coefficients cₖ boundᵏ.
///
/// Example: [0 1; −½ 1] has the eigenvalues (1 ± i)/2 of magnitude √½ = 0.707….
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::polynomial::has_radius_below;
///
/// let q = Rational::new;
/// let rows = vec![vec![q(0, 1), q(1, 1)], vec![q(-1, 2), q(1, 1)]];
/// assert_eq!(has_radius_below(&rows, &q(71, 100)), Some(true));
/// assert_eq!(has_radius_below(&rows, &q(70, 100)), Some(false));
/// ```
///
/// Evidence: `the_schur_cohn_test_knows_where_roots_are` (exact).
pub fn has_radius_below<T: Field + PartialOrd>(matrix: &MatrixRows<T>, bound: &T) -> Option<bool> {
    let mut scaled = characteristic_polynomial(matrix);
    let mut power = T::one();
    for coefficient in &mut scaled {
        *coefficient *= power.clone();
        power *= bound.clone();
    }
    is_stable_polynomial(&scaled)
}
