//! The square roots of a covariance other than its lower Cholesky factor.
//!
//! Two others are in use. Both give different points with the right mean and covariance.

use crate::matrix::{NotPositiveDefinite, cholesky};
use crate::number::Real;
use nalgebra::DMatrix;

/// A square root, or the pivot that is not positive.
type Root<T> = Result<DMatrix<T>, NotPositiveDefinite>;

/// The upper triangular U with P = U Uᵀ: the lower factor of P with its rows and columns in reversed order, reversed back.
///
/// Source: with J the reversal, J P J = L Lᵀ and U = J L J.
pub(super) fn upper<T: Real>(covariance: &DMatrix<T>) -> Root<T> {
    // The lower triangle alone is read, as by the Cholesky factorisation.
    let entry = |row: usize, column: usize| covariance[(row.max(column), row.min(column))].clone();
    let last = covariance.nrows() - 1;
    let reversed = covariance.map_with_location(|row, column, _| entry(last - row, last - column));
    let lower = cholesky(&reversed)?;
    Ok(lower.map_with_location(|row, column, _| lower[(last - row, last - column)].clone()))
}

/// The symmetric S with P = S S: V √D Vᵀ from the eigenvectors V and eigenvalues D of P.
///
/// Source: the cyclic Jacobi method, Golub and Van Loan, Matrix Computations, 4th edition, section 8.5. A rotation makes one entry
/// beside the diagonal zero. From some sweep on the digits of agreement double with each; what twelve sweeps leave beside the
/// diagonal is below the rounding of every number system in use, and is dropped.
pub(super) fn symmetric<T: Real>(covariance: &DMatrix<T>) -> Root<T> {
    cholesky(covariance)?;
    let mut values = covariance.clone();
    let n = covariance.nrows();
    let mut vectors = DMatrix::identity(n, n);
    for _ in 0..SWEEPS {
        for p in 0..n {
            for q in p + 1..n {
                rotate(&mut values, &mut vectors, p, q);
            }
        }
    }
    let mut root = DMatrix::zeros(n, n);
    for i in 0..n {
        let vector = vectors.column(i).clone_owned();
        root += (&vector * vector.transpose()) * values[(i, i)].sqrt();
    }
    Ok(root)
}

/// How often every entry beside the diagonal is made zero.
const SWEEPS: usize = 12;

/// Makes the entries (p, q) and (q, p) zero.
///
/// ```text
/// t = 2 a / (d ± √(d² + 4 a²)),   a = Aₚ_q,   d = A_qq − Aₚₚ,   c = 1/√(1 + t²),   s = t c
/// ```
///
/// Both signs make it zero; that of d is the one of the smaller angle.
fn rotate<T: Real>(values: &mut DMatrix<T>, vectors: &mut DMatrix<T>, p: usize, q: usize) {
    let a = values[(q, p)].clone();
    if a.is_zero() {
        return;
    }
    let (two, d) = (T::integer(2), values[(q, q)].clone() - values[(p, p)].clone());
    let twice = two * a.clone();
    let root = (d.clone() * d.clone() + twice.clone() * twice.clone()).sqrt();
    let signed = if d < T::zero() { -root } else { root };
    let t = twice / (d + signed);
    let c = T::one() / (T::one() + t.clone() * t.clone()).sqrt();
    let s = t.clone() * c.clone();

    let shift = t * a;
    values[(p, p)] -= shift.clone();
    values[(q, q)] += shift;
    values[(p, q)] = T::zero();
    values[(q, p)] = T::zero();
    for k in 0..values.nrows() {
        if k != p && k != q {
            let (kp, kq) = (values[(k, p)].clone(), values[(k, q)].clone());
            let turned = (
                c.clone() * kp.clone() - s.clone() * kq.clone(),
                s.clone() * kp + c.clone() * kq,
            );
            (values[(k, p)], values[(k, q)]) = turned.clone();
            (values[(p, k)], values[(q, k)]) = turned;
        }
        let (kp, kq) = (vectors[(k, p)].clone(), vectors[(k, q)].clone());
        vectors[(k, p)] = c.clone() * kp.clone() - s.clone() * kq.clone();
        vectors[(k, q)] = s.clone() * kp + c.clone() * kq;
    }
}
