//! Variants of the log-likelihood.
//!
//! The Gaussian density can be miscalculated, or evaluated at the wrong residual.

use super::super::setup::Setup;
use super::{diagonal, difference, draws_no_points, measurement_matrix, noise, number, seen, used};
use crate::filter::kalman;
use crate::gaussian::log_density;
use crate::imm::printed::{log_density_21, log_density_57};
use crate::imm::{Problem, Step};
use crate::matrix::{ldl, log_determinant, quadratic_form};
use crate::number::Real;
use nalgebra::{DVector, Dyn};

/// Applies a variant of the log-likelihood; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    of_density(id, setup) || of_updated_arguments(id, setup) || of_other_arguments(id, setup)
}

/// The density.
fn of_density<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let entry = &mut setup.equations.log_likelihood;
    match id {
        // liu2017 (21) as printed: −½ νᵀ S⁻¹ ν − (m/2) ln|2πS|
        "likelihood-exponent-21" => {
            *entry = |_, _, now, j| log_density_21(&now.innovations[j], &ldl(&now.innovation_covariances[j]));
        }
        // zhu2016 (57) read as it stands: −½ νᵀ S⁻¹ ν − ½ ln(2π|S|)
        "two-pi-outside-57" => {
            *entry = |_, _, now, j| log_density_57(&now.innovations[j], &ldl(&now.innovation_covariances[j]));
        }
        // −½ νᵀ S⁻¹ ν − (m/2) ln 2π
        "determinant-omitted" => *entry = |_, _, now, j| weighed(now, j, [(1, 2), (0, 1), (1, 2)]),
        // −½ νᵀ S⁻¹ ν
        "likelihood-not-normalised" => *entry = |_, _, now, j| weighed(now, j, [(1, 2), (0, 1), (0, 1)]),
        // −½ νᵀ S⁻¹ ν − ln|S| − (m/2) ln 2π
        "determinant-without-root" => *entry = |_, _, now, j| weighed(now, j, [(1, 2), (1, 1), (1, 2)]),
        // −½ νᵀ S⁻¹ ν + ½ ln|S| − (m/2) ln 2π
        "determinant-in-the-numerator" => *entry = |_, _, now, j| weighed(now, j, [(1, 2), (-1, 2), (1, 2)]),
        // −νᵀ S⁻¹ ν − ½ ln|S| − (m/2) ln 2π
        "exponent-without-half" => *entry = |_, _, now, j| weighed(now, j, [(1, 1), (1, 2), (1, 2)]),
        // −½ νᵀ ν − ½ ln|S| − (m/2) ln 2π
        "exponent-without-covariance" => {
            *entry = |_, _, now, j| {
                let without = weighed(now, j, [(0, 1), (1, 2), (1, 2)]);
                let squares = now.innovations[j].iter().map(|entry| entry.clone() * entry.clone());
                without - squares.fold(T::zero(), |sum, square| sum + square) / T::integer(2)
            }
        }
        _ => return false,
    }
    true
}

/// The residual and the covariance after the update, given to the density.
fn of_updated_arguments<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let no_points = draws_no_points(setup);
    let entry = &mut setup.equations.log_likelihood;
    match id {
        // ν = z − h(x̂)
        "likelihood-of-updated-residual" => {
            *entry = |problem, _, now, j| {
                let residual = updated_residual(problem, now, j);
                log_density(&residual, &ldl(&now.innovation_covariances[j]))
            }
        }
        // S = H P Hᵀ + R
        "likelihood-of-updated-covariance" => {
            if no_points {
                *entry = |problem, _, now, j| {
                    let (h, covariance) = (measurement_matrix(problem, now, j), &now.updated[j].covariance);
                    let s = kalman::innovation_covariance(&h, covariance, noise(problem, now, j));
                    log_density(&now.innovations[j], &ldl(&s))
                }
            }
        }
        // both
        "likelihood-of-updated-estimate" => {
            if no_points {
                *entry = |problem, _, now, j| {
                    let (h, covariance) = (measurement_matrix(problem, now, j), &now.updated[j].covariance);
                    let s = kalman::innovation_covariance(&h, covariance, noise(problem, now, j));
                    log_density(&updated_residual(problem, now, j), &ldl(&s))
                }
            }
        }
        _ => return false,
    }
    true
}

/// Another covariance, or a part of it, given to the density.
fn of_other_arguments<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let is_scalar = setup.problems().all(|problem| problem.m().0 == 1);
    let entry = &mut setup.equations.log_likelihood;
    match id {
        // S = R
        "likelihood-of-measurement-noise" => {
            *entry = |problem, _, now, j| log_density(&now.innovations[j], &ldl(noise(problem, now, j)));
        }
        // S without its covariances
        "likelihood-of-variances-alone" => {
            *entry = |_, _, now, j| {
                let variances = diagonal(&now.innovation_covariances[j], T::clone);
                log_density(&now.innovations[j], &ldl(&variances))
            }
        }
        // N(ν; 0, S²): the variance where a function asks for a standard deviation
        "likelihood-variance-as-standard-deviation" => {
            if is_scalar {
                *entry = |_, _, now, j| {
                    let s = &now.innovation_covariances[j];
                    log_density(&now.innovations[j], &ldl(&(s * s)))
                }
            }
        }
        // the first entry of the measurement alone
        "likelihood-of-the-first-component" => {
            *entry = |_, _, now, j| {
                let first = now.innovation_covariances[j].fixed_view::<1, 1>(0, 0).clone_owned();
                let residual = now.innovations[j].fixed_rows::<1>(0).clone_owned();
                log_density(&residual, &ldl(&first))
            }
        }
        _ => return false,
    }
    true
}

/// −a νᵀ S⁻¹ ν − b ln|S| − c m ln 2π, which is the density for a = b = c = ½.
fn weighed<T: Real>(now: &Step<T, Dyn, Dyn>, j: usize, factors: [(i64, i64); 3]) -> T {
    let s = ldl(&now.innovation_covariances[j]);
    let [a, b, c] = factors.map(|(numerator, denominator)| T::ratio(numerator, denominator));
    let two_pi = T::pi() * T::integer(2);
    -(quadratic_form(&s, &now.innovations[j]) * a
        + log_determinant(&s) * b
        + number::<T>(s.diagonal.len()) * T::ln(&two_pi) * c)
}

/// z − h(x̂) with the updated mean.
fn updated_residual<T: Real>(problem: &Problem<T, Dyn, Dyn>, now: &Step<T, Dyn, Dyn>, j: usize) -> DVector<T> {
    let Some(z) = &now.measurement else {
        return now.innovations[j].clone();
    };
    let seen = seen(problem, &now.updated[j].mean, j);
    difference(problem, used(problem, z, now, j), &seen, j)
}
