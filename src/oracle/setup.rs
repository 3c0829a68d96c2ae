//! A problem in one number system, ready to be run, and to be varied.

use crate::imm::{Equations, Imm, Initial, Problem};
use crate::number::Real;
use nalgebra::SVector;

/// All that a run needs.
#[derive(Debug, Clone)]
pub struct Setup<T, const N: usize, const M: usize> {
    /// The problem.
    pub problem: Problem<T, N, M>,
    /// The equations.
    pub equations: Equations<T, N, M>,
    /// The estimate at step 0.
    pub initial: Initial<T, N>,
    /// The measurements of steps 1, 2, …; none at a missed detection.
    pub measurements: Vec<Option<SVector<T, M>>>,
}

impl<T: Real, const N: usize, const M: usize> Setup<T, N, M> {
    /// The filter at step 0. The problem is not checked: a variant's may be wrong on purpose.
    pub fn filter(&self) -> Imm<T, N, M> {
        Imm::unchecked(self.problem.clone(), self.equations.clone(), &self.initial)
    }
}
