//! Variants of the points and weights of a rule.
//!
//! After this file the reader knows what the papers' misprinted weights do to a filter, and how a square root is taken by its rows.

use super::super::setup::Setup;
use super::draws_points;
use crate::matrix::cholesky;
use crate::number::Real;
use crate::rule::{ExactRule, InvalidRule, Rule, fifth_degree, printed, simplex};
use nalgebra::SVector;

/// Applies a variant of the points; whether it is one.
pub(super) fn apply<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    of_weights(id, setup) || of_points(id, setup)
}

/// The weights.
fn of_weights<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    let rule = &mut setup.problem.rule;
    match (id, rule) {
        ("covariance-weights-for-means", Some(rule)) => rule.weights.clone_from(&rule.covariance_weights),
        // the centre's weight without 1 − α² + β
        ("mean-weights-for-covariances", Some(rule)) => rule.covariance_weights.clone_from(&rule.weights),
        ("centre-point-dropped", Some(rule)) => drop_centre(rule),
        ("cubature-5-weight-13", rule) => exchange(rule, fifth_degree::fifth_degree(N), printed::fifth_degree(N)),
        ("simplex-5-weight-11", rule) => exchange(rule, simplex::simplex(N), printed::simplex_11(N)),
        ("simplex-5-weight-16", rule) => exchange(rule, simplex::simplex(N), printed::simplex_16(N)),
        ("covariance-weights-for-means" | "mean-weights-for-covariances" | "centre-point-dropped", None) => {}
        _ => return false,
    }
    true
}

/// The points.
fn of_points<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    let points = draws_points(setup);
    let equations = &mut setup.equations;
    match id {
        // Sᵀ ξ + x̂
        "points-from-rows-of-the-root" => {
            if points {
                equations.mixed_square_root = |_, _, now, j| Ok(cholesky(&now.mixed[j].covariance)?.transpose());
                equations.predicted_square_root =
                    |_, _, now, j| Ok(cholesky(&now.predicted[j].covariance)?.transpose());
            }
        }
        // P ξ + x̂
        "points-without-root" => {
            if points {
                equations.mixed_square_root = |_, _, now, j| Ok(now.mixed[j].covariance.clone());
                equations.predicted_square_root = |_, _, now, j| Ok(now.predicted[j].covariance.clone());
            }
        }
        // √Pᵢᵢ on the diagonal, nothing beside it
        "points-without-correlation" => {
            if points {
                equations.mixed_square_root = |_, _, now, j| {
                    cholesky(&now.mixed[j].covariance)?;
                    Ok(super::diagonal(&now.mixed[j].covariance, T::sqrt))
                };
                equations.predicted_square_root = |_, _, now, j| {
                    cholesky(&now.predicted[j].covariance)?;
                    Ok(super::diagonal(&now.predicted[j].covariance, T::sqrt))
                };
            }
        }
        // ξ / |ξ|: √n, √(n + λ) or √(n + 2) forgotten
        "points-on-the-unit-sphere" => scale_points(setup, |radius| T::one() / radius.clone()),
        // |ξ| ξ: n for √n
        "points-scaled-by-the-square" => scale_points(setup, T::clone),
        // χ = X*
        "points-not-drawn-afresh" => {
            if points {
                equations.predicted_point = |_, _, now, j, s| now.propagated_points[j][s].clone();
            }
        }
        // χ = X
        "points-not-moved" => {
            if points {
                equations.predicted_point = |_, _, now, j, s| now.mixed_points[j][s].clone();
            }
        }
        _ => return false,
    }
    true
}

/// Exchanges a rule for another, if it is the expected one.
fn exchange<T: Real, const N: usize>(
    rule: &mut Option<Rule<T, N>>,
    expected: Result<ExactRule, InvalidRule>,
    other: Result<ExactRule, InvalidRule>,
) {
    let (Some(rule), Ok(expected), Ok(other)) = (rule, expected, other) else {
        return;
    };
    let (Ok(expected), Ok(other)) = (Rule::<T, N>::from_exact(&expected), Rule::from_exact(&other)) else {
        return;
    };
    if has_points_of(rule, &expected) {
        *rule = other;
    }
}

/// Whether the points of two rules are the same but for rounding: the squares of the distances are below 10⁻¹².
fn has_points_of<T: Real, const N: usize>(rule: &Rule<T, N>, other: &Rule<T, N>) -> bool {
    let small = T::ratio(1, 1_000_000_000_000);
    let is_near = |(a, b): (&SVector<T, N>, &SVector<T, N>)| norm_squared(&(a - b)) < small;
    rule.points.len() == other.points.len() && rule.points.iter().zip(&other.points).all(is_near)
}

/// Takes the weight of the point at zero away.
fn drop_centre<T: Real, const N: usize>(rule: &mut Rule<T, N>) {
    for (s, point) in rule.points.iter().enumerate() {
        if point.iter().all(T::is_zero) {
            rule.weights[s] = T::zero();
            rule.covariance_weights[s] = T::zero();
        }
    }
}

/// Multiplies each point by a factor of its distance from zero.
fn scale_points<T: Real, const N: usize, const M: usize>(setup: &mut Setup<T, N, M>, factor: fn(&T) -> T) {
    let Some(rule) = &mut setup.problem.rule else {
        return;
    };
    for point in &mut rule.points {
        let square = norm_squared(point);
        if !square.is_zero() {
            *point = &*point * factor(&square.sqrt());
        }
    }
}

fn norm_squared<T: Real, const N: usize>(vector: &SVector<T, N>) -> T {
    let squares = vector.iter().map(|entry| entry.clone() * entry.clone());
    squares.fold(T::zero(), |sum, square| sum + square)
}
