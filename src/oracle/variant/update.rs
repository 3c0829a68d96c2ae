//! Variants of the update: the gain, the updated mean and the updated covariance.
//!
//! These are the mistakes that can be made in C S⁻¹, x̂⁻ + W ν and P⁻ − W S Wᵀ.

use super::super::setup::Setup;
use super::{diagonal, draws_no_points, measurement_matrix, noise};
use crate::filter::{kalman, update};
use crate::imm::equations::Factored;
use crate::imm::{Problem, Step};
use crate::matrix::{check_positive_definite, ldl, mirrored, solve};
use crate::number::Real;
use nalgebra::{DMatrix, Dyn};

/// Applies a variant of the update; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    of_gain(id, setup) || of_mean(id, setup) || of_covariance(id, setup)
}

/// The gain.
fn of_gain<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let no_points = draws_no_points(setup);
    let is_square = setup.problems().all(|problem| problem.n() == problem.m());
    let entry = &mut setup.equations.gain;
    match id {
        // derbez2000 (2) as printed: P⁰ʲ Hᵀ (H P⁰ʲ Hᵀ + R)⁻¹
        "gain-of-mixed-covariance" => {
            if no_points {
                *entry = gain_of_mixed;
            }
        }
        // derbez2000 (2) as printed: that gain, and (I − K H) P⁰ʲ
        "update-from-the-mixed-covariance" => {
            if no_points {
                setup.equations.gain = gain_of_mixed;
                setup.equations.updated_covariance = |problem, _, now, j| rest_of_mixed(problem, now, j);
            }
        }
        // C (S − R)⁻¹
        "gain-without-measurement-noise" => {
            *entry = |problem, _, now, j| {
                let s = &now.innovation_covariances[j] - noise(problem, now, j);
                gain(&now.cross_covariances[j], &s)
            }
        }
        // C diag(S)⁻¹
        "gain-of-variances-alone" => {
            *entry = |_, _, now, j| {
                let s = diagonal(&now.innovation_covariances[j], T::clone);
                gain(&now.cross_covariances[j], &s)
            }
        }
        // C (1/Sᵢⱼ)
        "gain-by-entrywise-inverse" => {
            *entry = |_, _, now, j| {
                let inverses = now.innovation_covariances[j].map(|entry| T::one() / entry);
                Ok(&now.cross_covariances[j] * inverses)
            }
        }
        // S⁻¹ C, which has a shape only for n = m
        "gain-factors-exchanged" => {
            if is_square {
                *entry = |_, _, now, j| Ok(left_quotient(&now.innovation_covariances[j], &now.cross_covariances[j]));
            }
        }
        // W of step k−1; its own where there was none
        "gain-of-the-step-before" => {
            *entry = |_, previous, now, j| match previous.measurement {
                // A gain of another sensor may have no place here.
                Some(_) if previous.gains[j].shape() == now.cross_covariances[j].shape() => {
                    Ok(previous.gains[j].clone())
                }
                _ => gain(&now.cross_covariances[j], &now.innovation_covariances[j]),
            }
        }
        _ => return false,
    }
    true
}

/// The updated mean.
fn of_mean<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let entry = &mut setup.equations.updated_mean;
    match id {
        // x̂⁻ − W ν
        "update-subtracted" => *entry = |_, _, now, j| &now.predicted[j].mean - &now.gains[j] * &now.innovations[j],
        // x̂⁰ʲ + W ν
        "update-of-the-mixed-mean" => {
            *entry = |_, _, now, j| update::updated_mean(&now.mixed[j].mean, &now.gains[j], &now.innovations[j]);
        }
        // x̂⁻ of all modes + W ν
        "update-of-the-combined-prediction" => {
            *entry = |_, _, now, j| {
                let (mean, gain) = (&now.combined_prediction.mean, &now.gains[j]);
                update::updated_mean(mean, gain, &now.innovations[j])
            }
        }
        // x̂⁻ + W z
        "update-by-the-measurement" => {
            *entry = |_, _, now, j| {
                let mean = &now.predicted[j].mean;
                match &now.measurement {
                    Some(z) => update::updated_mean(mean, &now.gains[j], z),
                    None => mean.clone(),
                }
            }
        }
        _ => return false,
    }
    true
}

/// The updated covariance.
fn of_covariance<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let entry = &mut setup.equations.updated_covariance;
    match id {
        // P⁻
        "covariance-not-updated" => *entry = |_, _, now, j| now.predicted[j].covariance.clone(),
        // P⁻ + W S Wᵀ
        "covariance-update-added" => {
            *entry = |_, _, now, j| {
                let s = -now.innovation_covariances[j].clone();
                update::updated_covariance(&now.predicted[j].covariance, &now.gains[j], &s)
            }
        }
        // P⁰ʲ − W S Wᵀ
        "covariance-update-of-mixed" => {
            *entry = |_, _, now, j| {
                let s = &now.innovation_covariances[j];
                update::updated_covariance(&now.mixed[j].covariance, &now.gains[j], s)
            }
        }
        // P⁻ − W Wᵀ
        "covariance-update-without-s" => {
            *entry = |problem, _, now, j| {
                let m = problem.m().0;
                update::updated_covariance(&now.predicted[j].covariance, &now.gains[j], &DMatrix::identity(m, m))
            }
        }
        // P⁻ − W R Wᵀ
        "covariance-update-by-noise" => {
            *entry = |problem, _, now, j| {
                update::updated_covariance(&now.predicted[j].covariance, &now.gains[j], noise(problem, now, j))
            }
        }
        // (I − W H) P⁻ (I − W H)ᵀ, which is P⁻ − W Cᵀ − C Wᵀ + W (S − R) Wᵀ
        "joseph-update-without-noise" => *entry = |problem, _, now, j| joseph(problem, now, j, &T::zero()),
        // (I − W H) P⁻ (I − W H)ᵀ + 2 W R Wᵀ
        "joseph-update-noise-doubled" => *entry = |problem, _, now, j| joseph(problem, now, j, &T::integer(2)),
        _ => return false,
    }
    true
}

/// The Joseph form with a multiple of the noise: P⁻ − W Cᵀ − C Wᵀ + W (S − R) Wᵀ + times · W R Wᵀ.
fn joseph<T: Real>(problem: &Problem<T, Dyn, Dyn>, now: &Step<T, Dyn, Dyn>, j: usize, times: &T) -> DMatrix<T> {
    let (w, c) = (&now.gains[j], &now.cross_covariances[j]);
    let noise = noise(problem, now, j) * (times.clone() - T::one());
    let s = &now.innovation_covariances[j] + noise;
    mirrored(&now.predicted[j].covariance - w * c.transpose() - c * w.transpose() + w * s * w.transpose())
}

/// P⁰ʲ Hᵀ (H P⁰ʲ Hᵀ + R)⁻¹.
fn gain_of_mixed<T: Real>(
    problem: &Problem<T, Dyn, Dyn>,
    _: &Step<T, Dyn, Dyn>,
    now: &Step<T, Dyn, Dyn>,
    j: usize,
) -> Factored<DMatrix<T>> {
    let (h, covariance) = (measurement_matrix(problem, now, j), &now.mixed[j].covariance);
    let s = kalman::innovation_covariance(&h, covariance, noise(problem, now, j));
    gain(&kalman::cross_covariance(covariance, &h), &s)
}

/// (I − K H) P⁰ʲ.
fn rest_of_mixed<T: Real>(problem: &Problem<T, Dyn, Dyn>, now: &Step<T, Dyn, Dyn>, j: usize) -> DMatrix<T> {
    let h = measurement_matrix(problem, now, j);
    let identity = DMatrix::identity(problem.n().0, problem.n().0);
    (identity - &now.gains[j] * &*h) * &now.mixed[j].covariance
}

/// C S⁻¹ with an S that must be positive definite.
fn gain<T: Real>(c: &DMatrix<T>, s: &DMatrix<T>) -> Factored<DMatrix<T>> {
    let factors = ldl(s);
    check_positive_definite(&factors)?;
    Ok(update::gain(c, &factors))
}

/// S⁻¹ C of matrices that have as many rows, N = M.
fn left_quotient<T: Real>(s: &DMatrix<T>, c: &DMatrix<T>) -> DMatrix<T> {
    solve(&ldl(s), c)
}
