//! Systems of linear equations of any size, solved by elimination.
//!
//! They solve the Lyapunov equation exactly, and serve the division in the doubling iteration of the Riccati equation.

use super::polynomial::MatrixRows;
use crate::matrix::{Holds, Shapes, rows};
use crate::number::Field;
use nalgebra::{Dim, OMatrix};

/// The solution X of A X = B; none if a pivot that is known to differ from zero cannot be found.
///
/// The pivot is the greatest of its column as far as the number system can tell, which in exact arithmetic costs nothing and in rounded
/// arithmetic keeps the digits.
///
/// Source: Golub and Van Loan, Matrix Computations, 4th edition, section 3.4.
///
/// Example: 2x + y = 4, x + 3y = 7: x = 1, y = 2.
///
/// ```
/// use immaculate::number::{Field, Rational};
/// use immaculate::steady::linear::solve;
///
/// let rows = |rows: [[i64; 2]; 2]| rows.map(|row| row.map(Rational::integer).to_vec()).to_vec();
/// let column = |column: [i64; 2]| column.map(|entry| vec![Rational::integer(entry)]).to_vec();
/// assert_eq!(solve(rows([[2, 1], [1, 3]]), column([4, 7])), Some(column([1, 2])));
/// // x + y = 1 twice has no one solution.
/// assert_eq!(solve(rows([[1, 1], [1, 1]]), column([1, 1])), None);
/// ```
///
/// Evidence: `elimination_solves_what_can_be_solved` (exact).
pub fn solve<T: Field + PartialOrd>(mut matrix: MatrixRows<T>, mut right_side: MatrixRows<T>) -> Option<MatrixRows<T>> {
    let n = matrix.len();
    for column in 0..n {
        let pivot = greatest(&matrix, column)?;
        matrix.swap(column, pivot);
        right_side.swap(column, pivot);
        let divisor = matrix[column][column].clone();
        let (pivot_row, pivot_side) = (matrix[column].clone(), right_side[column].clone());
        for row in (0..n).filter(|row| *row != column) {
            let factor = matrix[row][column].clone() / divisor.clone();
            subtract(&mut matrix[row], &pivot_row, &factor);
            subtract(&mut right_side[row], &pivot_side, &factor);
        }
    }
    for (row, side) in right_side.iter_mut().enumerate() {
        for entry in side {
            *entry /= matrix[row][row].clone();
        }
    }
    Some(right_side)
}

fn subtract<T: Field>(row: &mut [T], pivot_row: &[T], factor: &T) {
    for (entry, pivot) in row.iter_mut().zip(pivot_row) {
        *entry -= pivot.clone() * factor.clone();
    }
}

/// The row from the diagonal down with the greatest entry of a column; none if no entry is known to differ from zero.
fn greatest<T: Field + PartialOrd>(matrix: &MatrixRows<T>, column: usize) -> Option<usize> {
    let square = |row: usize| matrix[row][column].clone() * matrix[row][column].clone();
    let mut best = None;
    let mut greatest = T::zero();
    for row in column..matrix.len() {
        let candidate = square(row);
        if candidate > greatest {
            greatest = candidate;
            best = Some(row);
        }
    }
    best
}

/// The solution X of X = A X Aᵀ + C; none if there is not exactly one.
///
/// Source: the linear system for the entries of X, (I − A ⊗ A) vec X = vec C.
///
/// Example: x = ½ · x · ½ + 3 has the solution 4; x = x + 3 has none.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::linear::stein;
/// use nalgebra::matrix;
///
/// let number = |p, q| matrix![Rational::new(p, q)];
/// assert_eq!(stein(&number(1, 2), &number(3, 1)), Some(number(4, 1)));
/// assert_eq!(stein(&number(1, 1), &number(3, 1)), None);
/// ```
///
/// Evidence: `the_stein_equation_is_solved_exactly` (exact).
pub fn stein<T: Field + PartialOrd, N: Dim>(
    a: &OMatrix<T, N, N>,
    constant: &OMatrix<T, N, N>,
) -> Option<OMatrix<T, N, N>>
where
    Shapes: Holds<N>,
{
    let n = a.nrows();
    let place = |index: usize| (index / n, index % n);
    let row = |index: usize| {
        let (i, j) = place(index);
        let entry = |other: usize| {
            let (k, l) = place(other);
            let own = if index == other { T::one() } else { T::zero() };
            own - a[(i, k)].clone() * a[(j, l)].clone()
        };
        (0..n * n).map(entry).collect()
    };
    let matrix: MatrixRows<T> = (0..n * n).map(row).collect();
    let side = (0..n * n).map(|index| vec![constant[place(index)].clone()]).collect();
    let solved = solve(matrix, side)?;
    let entry = |i: usize, j: usize| solved[i * n + j][0].clone();
    Some(OMatrix::from_fn_generic(rows(a), rows(a), entry))
}
