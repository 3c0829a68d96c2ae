//! Which part of a motion a sensor does not see, and a noise does not reach: detectability and stabilisability, exactly.
//!
//! A filter may have no steady state; this file finds the part of the state that is at fault. No eigenvalue is computed: elimination finds
//! the part, and its characteristic polynomial shows whether it decays.

use super::polynomial::{MatrixRows, characteristic_polynomial};
use crate::number::{Field, Rational};
use num_traits::Zero;
use std::fmt::Write;

/// The characteristic polynomial of the motion on the part of the state that the sensor does not see: 1 if it sees all.
///
/// The pair (H, F) is detectable exactly if this polynomial is stable; (F, Q) is stabilisable exactly if (Q, Fᵀ) is detectable.
///
/// ```text
/// unseen states = { x : H x = H F x = … = H Fⁿ⁻¹ x = 0 }
/// ```
///
/// Source: Kalman 1963; the subspace is carried into itself by F (Cayley-Hamilton).
///
/// Example: constant velocity. Who sees the position sees the velocity too; who sees the velocity alone misses a position that stays: λ −
/// 1.
///
/// ```
/// use immaculate::number::{Field, Rational};
/// use immaculate::steady::reach::unseen_part;
///
/// let rows = |rows: &[[i64; 2]]| rows.iter().map(|row| row.map(Rational::integer).to_vec()).collect();
/// let motion = rows(&[[1, 1], [0, 1]]);
/// assert_eq!(unseen_part(&motion, &rows(&[[1, 0]])), [1].map(Rational::integer));
/// assert_eq!(unseen_part(&motion, &rows(&[[0, 1]])), [-1, 1].map(Rational::integer));
/// ```
///
/// Evidence: `what_is_not_seen_and_does_not_decay_is_named` (exact).
pub fn unseen_part(motion: &MatrixRows<Rational>, sensor: &MatrixRows<Rational>) -> Vec<Rational> {
    let n = motion.len();
    let mut seen: MatrixRows<Rational> = Vec::new();
    let mut rows = sensor.clone();
    for _ in 0..n {
        seen.extend(rows.iter().cloned());
        rows = rows.iter().map(|row| row_times(row, motion)).collect();
    }
    let (basis, free) = null_space(seen, n);
    // A vector of the space has its coordinates at the free places, where the basis is the identity.
    let restricted = free.iter().map(|&place| {
        let image = |vector: &Vec<Rational>| dot(&motion[place], vector);
        basis.iter().map(image).collect()
    });
    characteristic_polynomial(&restricted.collect())
}

fn dot(row: &[Rational], vector: &[Rational]) -> Rational {
    row.iter()
        .zip(vector)
        .fold(Rational::zero(), |sum, (a, b)| sum + a.clone() * b.clone())
}

/// vᵀ A.
fn row_times(row: &[Rational], matrix: &MatrixRows<Rational>) -> Vec<Rational> {
    let column = |j: usize| matrix.iter().map(|other| other[j].clone()).collect::<Vec<_>>();
    (0..matrix.len()).map(|j| dot(row, &column(j))).collect()
}

/// A basis of the vectors that all rows are orthogonal to, and the places at which the basis is the identity.
fn null_space(mut rows: MatrixRows<Rational>, n: usize) -> (MatrixRows<Rational>, Vec<usize>) {
    let mut pivots = Vec::new();
    for column in 0..n {
        let Some(found) = (pivots.len()..rows.len()).find(|&row| !rows[row][column].is_zero()) else {
            continue;
        };
        let at = pivots.len();
        rows.swap(at, found);
        let divisor = rows[at][column].clone();
        rows[at].iter_mut().for_each(|entry| *entry /= divisor.clone());
        let pivot = rows[at].clone();
        for row in (0..rows.len()).filter(|row| *row != at) {
            let factor = rows[row][column].clone();
            for (entry, pivot) in rows[row].iter_mut().zip(&pivot) {
                *entry -= factor.clone() * pivot.clone();
            }
        }
        pivots.push(column);
    }
    let free: Vec<usize> = (0..n).filter(|column| !pivots.contains(column)).collect();
    let vector = |&place: &usize| {
        let mut vector = vec![Rational::zero(); n];
        vector[place] = Rational::integer(1);
        for (row, &pivot) in pivots.iter().enumerate() {
            vector[pivot] = -rows[row][place].clone();
        }
        vector
    };
    (free.iter().map(vector).collect(), free)
}

/// A polynomial in λ for people, highest power first.
///
/// Source: for messages.
///
/// Example: the highest power first, and a true minus.
///
/// ```
/// use immaculate::number::{Field, Rational};
/// use immaculate::steady::reach::polynomial_text;
///
/// assert_eq!(polynomial_text(&[6, -5, 1].map(Rational::integer)), "λ^2 − 5λ + 6");
/// ```
pub fn polynomial_text(coefficients: &[Rational]) -> String {
    let mut text = String::new();
    for (power, coefficient) in coefficients.iter().enumerate().rev() {
        if coefficient.is_zero() && coefficients.len() > 1 {
            continue;
        }
        let is_negative = *coefficient < Rational::zero();
        let sign = match (text.is_empty(), is_negative) {
            (true, false) => "",
            (true, true) => "−",
            (false, false) => " + ",
            (false, true) => " − ",
        };
        let magnitude = coefficient.abs();
        let factor = if magnitude == Rational::integer(1) && power > 0 {
            String::new()
        } else {
            magnitude.to_string()
        };
        let unknown = match power {
            0 => String::new(),
            1 => "λ".to_owned(),
            _ => format!("λ^{power}"),
        };
        let _ = write!(text, "{sign}{factor}{unknown}");
    }
    text
}
