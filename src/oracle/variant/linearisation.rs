//! Variants of the extended filter's Jacobians.
//!
//! A Jacobian can be evaluated at the wrong point, written down wrongly, or used in place of the function.

use super::super::setup::Setup;
use crate::filter::Transform;
use crate::filter::extended::motion_jacobian;
use crate::imm::{Equations, Problem, Step};
use crate::number::Real;
use nalgebra::{DMatrix, DVector, Dyn};

/// Applies a variant of the linearisation; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    of_motion(id, setup) || of_measurement(id, setup)
}

/// The Jacobian of the motion.
fn of_motion<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // Fᵀ
        "motion-jacobian-transposed" => {
            equations.motion_jacobian =
                |problem, _, now, j| Some(motion_slopes(problem, j, &now.mixed[j].mean)?.transpose());
        }
        // ∂f/∂x at x̂⁻
        "motion-jacobian-at-the-prediction" => {
            equations.motion_jacobian = |problem, _, now, j| motion_slopes(problem, j, &now.predicted[j].mean);
        }
        // ∂f/∂x at x̂ʲ of step k−1
        "motion-jacobian-at-the-own-estimate" => {
            equations.motion_jacobian = |problem, previous, _, j| motion_slopes(problem, j, &previous.updated[j].mean);
        }
        // Fᵢₙ = 0 for i ≠ n
        "motion-jacobian-last-column-omitted" => {
            equations.motion_jacobian = |problem, _, now, j| {
                let mut slopes = motion_slopes(problem, j, &now.mixed[j].mean)?;
                let last = slopes.ncols() - 1;
                slopes.view_mut((0, last), (last, 1)).fill(T::zero());
                Some(slopes)
            }
        }
        // x̂⁻ = F x̂⁰ʲ
        "motion-by-jacobian" => {
            equations.predicted_mean = |problem, previous, now, j| {
                let mean = &now.mixed[j].mean;
                match motion_slopes(problem, j, mean) {
                    Some(slopes) => slopes * mean,
                    None => (Equations::standard().predicted_mean)(problem, previous, now, j),
                }
            }
        }
        _ => return false,
    }
    true
}

/// The Jacobian of the measurement.
fn of_measurement<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // ∂h/∂x at x̂⁰ʲ
        "measurement-jacobian-at-the-mixed-mean" => {
            equations.measurement_jacobian = |problem, _, now, j| measurement_slopes(problem, j, &now.mixed[j].mean);
        }
        // ∂h/∂x of step k−1; its own where there was none, or that of another sensor
        "measurement-jacobian-of-the-step-before" => {
            equations.measurement_jacobian = |problem, previous, now, j| {
                let own = measurement_slopes(problem, j, &now.predicted[j].mean)?;
                Some(last_slopes(previous, j, &own).unwrap_or(own))
            }
        }
        // −∂θ/∂x of an angle θ
        "bearing-jacobian-negated" => {
            equations.measurement_jacobian = |problem, _, now, j| {
                let mut slopes = measurement_slopes(problem, j, &now.predicted[j].mean)?;
                for row in (0..slopes.nrows()).filter(|&row| problem.sensor.is_angle(row)) {
                    slopes.row_mut(row).iter_mut().for_each(|slope| *slope = -slope.clone());
                }
                Some(slopes)
            }
        }
        // 180 ∂θ/∂x / π of an angle θ
        "bearing-jacobian-in-degrees" => {
            equations.measurement_jacobian = |problem, _, now, j| {
                let mut slopes = measurement_slopes(problem, j, &now.predicted[j].mean)?;
                for row in (0..slopes.nrows()).filter(|&row| problem.sensor.is_angle(row)) {
                    for slope in &mut slopes.row_mut(row) {
                        *slope *= T::integer(180) / T::pi();
                    }
                }
                Some(slopes)
            }
        }
        // ẑ = H x̂⁻
        "measurement-by-jacobian" => {
            equations.predicted_measurement = |problem, previous, now, j| {
                let mean = &now.predicted[j].mean;
                match measurement_slopes(problem, j, mean) {
                    Some(slopes) => slopes * mean,
                    None => (Equations::standard().predicted_measurement)(problem, previous, now, j),
                }
            }
        }
        _ => return false,
    }
    true
}

/// The Jacobian of the motion of mode j; none where its filter does not linearise.
fn motion_slopes<T: Real>(problem: &Problem<T, Dyn, Dyn>, j: usize, at: &DVector<T>) -> Option<DMatrix<T>> {
    let is_linearised = problem.filter(j).predict == Transform::Linearised;
    is_linearised.then(|| motion_jacobian(&problem.modes[j].motion, at))
}

/// The Jacobian of the measurement for mode j; none where its filter does not linearise.
fn measurement_slopes<T: Real>(problem: &Problem<T, Dyn, Dyn>, j: usize, at: &DVector<T>) -> Option<DMatrix<T>> {
    let is_linearised = problem.filter(j).linearises_the_measurement();
    is_linearised.then(|| problem.slopes_of_measurement(j, at))
}

/// The Jacobian of the step before, if it has the shape of `own`.
fn last_slopes<T: Real>(previous: &Step<T, Dyn, Dyn>, j: usize, own: &DMatrix<T>) -> Option<DMatrix<T>> {
    let last = previous.measurement_jacobians.get(j)?.as_ref()?;
    (last.shape() == own.shape()).then(|| last.clone())
}
