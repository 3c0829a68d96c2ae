//! The numbers of a value in one piece, whether it is a number, a list, a vector or a matrix.

use crate::matrix::Shapes;
use crate::number::Field;
use nalgebra::allocator::Allocator;
use nalgebra::{Dim, OMatrix};

/// Numbers that stand in one piece, by columns: a scalar, a list, a matrix, or nothing.
pub(super) trait Entries<T> {
    fn entries(&self) -> &[T];
    fn entries_mut(&mut self) -> &mut [T];
}

impl<T: Field> Entries<T> for T {
    fn entries(&self) -> &[T] {
        std::slice::from_ref(self)
    }
    fn entries_mut(&mut self) -> &mut [T] {
        std::slice::from_mut(self)
    }
}

impl<T> Entries<T> for Vec<T> {
    fn entries(&self) -> &[T] {
        self
    }
    fn entries_mut(&mut self) -> &mut [T] {
        self
    }
}

impl<T: Field, R: Dim, C: Dim> Entries<T> for OMatrix<T, R, C>
where
    Shapes: Allocator<R, C>,
{
    fn entries(&self) -> &[T] {
        self.as_slice()
    }
    fn entries_mut(&mut self) -> &mut [T] {
        self.as_mut_slice()
    }
}
