//! Shapes of matrices: one text of an equation for sides that are types and for sides that are known at run time.

use crate::number::Field;
use nalgebra::allocator::Allocator;
use nalgebra::{DefaultAllocator, Dim, OMatrix, U1};

/// Where matrices are kept: in arrays where their sides are types, in lists where a side is known at run time only.
///
/// An equation has one text for both. It says which sides its matrices have, and with one line that they can be kept:
///
/// ```
/// use immaculate::matrix::{Holds, Shapes};
/// use nalgebra::{Dim, OMatrix, dmatrix, matrix};
///
/// fn twice<N: Dim, M: Dim>(h: &OMatrix<f64, M, N>) -> OMatrix<f64, M, N>
/// where
///     Shapes: Holds<N, M>,
/// {
///     h * 2.0
/// }
///
/// assert_eq!(twice(&matrix![1.0, 2.0]), matrix![2.0, 4.0]); // sides in the types
/// assert_eq!(twice(&dmatrix![1.0, 2.0]), dmatrix![2.0, 4.0]); // sides known at run time
/// ```
pub type Shapes = DefaultAllocator;

/// That matrices and vectors with sides of N and M can be kept: n × n, n × m, m × n, m × m, and columns and rows of both.
pub trait Holds<N: Dim, M: Dim = N>:
    Allocator<N>
    + Allocator<M>
    + Allocator<U1, N>
    + Allocator<U1, M>
    + Allocator<N, N>
    + Allocator<N, M>
    + Allocator<M, N>
    + Allocator<M, M>
{
}

impl<N: Dim, M: Dim> Holds<N, M> for DefaultAllocator where
    DefaultAllocator: Allocator<N>
        + Allocator<M>
        + Allocator<U1, N>
        + Allocator<U1, M>
        + Allocator<N, N>
        + Allocator<N, M>
        + Allocator<M, N>
        + Allocator<M, M>
{
}

/// The number of rows, as the type of that side.
pub(crate) fn rows<T: Field, R: Dim, C: Dim>(matrix: &OMatrix<T, R, C>) -> R
where
    Shapes: Allocator<R, C>,
{
    matrix.shape_generic().0
}
