//! Variants of problems whose steps differ: values of the first step used in all.
//!
//! A filter written for equal steps goes wrong in these ways.

use super::super::setup::Setup;
use crate::imm::Problem;
use crate::number::Real;
use nalgebra::Dyn;

/// Takes something of the first step's problem into another's.
type Change<T> = fn(&mut Problem<T, Dyn, Dyn>, &Problem<T, Dyn, Dyn>);

/// Applies a variant of the steps; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let change: Change<T> = match id {
        "motion-of-the-first-step" => |problem, first| {
            for (mode, first) in problem.modes.iter_mut().zip(&first.modes) {
                mode.motion.clone_from(&first.motion);
            }
        },
        "process-noise-of-the-first-step" => |problem, first| {
            for (mode, first) in problem.modes.iter_mut().zip(&first.modes) {
                mode.noise.clone_from(&first.noise);
            }
        },
        // of a sensor of another dimension no program can take it
        "measurement-noise-of-the-first-step" => |problem, first| {
            if problem.measurement_noise.shape() == first.measurement_noise.shape() {
                problem.measurement_noise.clone_from(&first.measurement_noise);
            }
        },
        _ => return false,
    };
    let first = setup.problem_of(1).clone();
    change(&mut setup.problem, &first);
    for problem in setup.changes.values_mut() {
        change(problem, &first);
    }
    true
}
