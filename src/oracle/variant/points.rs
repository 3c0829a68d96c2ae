//! Variants of the points and weights of a rule.
//!
//! They include the papers' misprinted weights, and roots that are read by rows.

use super::super::setup::Setup;
use super::{drawn, draws_points};
use crate::imm::equations::Factored;
use crate::matrix::cholesky;
use crate::number::Real;
use crate::rule::{ExactRule, InvalidRule, Rule, fifth_degree, printed, simplex};
use nalgebra::{DMatrix, DVector, Dyn};

/// Applies a variant of the points; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    of_weights(id, setup) || of_points(id, setup)
}

/// The weights.
fn of_weights<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let n = setup.problem.n().0;
    let change: &dyn Fn(&mut Rule<T, Dyn>) = match id {
        "covariance-weights-for-means" => &|rule| rule.weights.clone_from(&rule.covariance_weights),
        // the centre's weight without 1 − α² + β
        "mean-weights-for-covariances" => &|rule| rule.covariance_weights.clone_from(&rule.weights),
        "centre-point-dropped" => &drop_centre,
        "cubature-5-weight-13" => &|rule| exchange(rule, fifth_degree::fifth_degree(n), printed::fifth_degree(n)),
        "simplex-5-weight-11" => &|rule| exchange(rule, simplex::simplex(n), printed::simplex_11(n)),
        "simplex-5-weight-16" => &|rule| exchange(rule, simplex::simplex(n), printed::simplex_16(n)),
        _ => return false,
    };
    change_rules(setup, change);
    true
}

/// Changes the rules of all filters that draw points.
fn change_rules<T: Real>(setup: &mut Setup<T>, change: impl Fn(&mut Rule<T, Dyn>)) {
    for filter in &mut setup.problem.filters {
        filter.rules_mut().into_iter().flatten().for_each(&change);
    }
}

/// The points.
fn of_points<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let points = draws_points(setup);
    let equations = &mut setup.equations;
    match id {
        // Sᵀ ξ + x̂
        "points-from-rows-of-the-root" => {
            equations.mixed_points = |problem, _, now, j| drawn(problem, j, &now.mixed[j], rows_of_root);
            equations.predicted_points = |problem, _, now, j| drawn(problem, j, &now.predicted[j], rows_of_root);
        }
        // P ξ + x̂
        "points-without-root" => {
            equations.mixed_points = |problem, _, now, j| drawn(problem, j, &now.mixed[j], no_root);
            equations.predicted_points = |problem, _, now, j| drawn(problem, j, &now.predicted[j], no_root);
        }
        // √Pᵢᵢ on the diagonal, nothing beside it
        "points-without-correlation" => {
            equations.mixed_points = |problem, _, now, j| drawn(problem, j, &now.mixed[j], root_of_variances);
            equations.predicted_points = |problem, _, now, j| drawn(problem, j, &now.predicted[j], root_of_variances);
        }
        // ξ / |ξ|: √n, √(n + λ) or √(n + 2) forgotten
        "points-on-the-unit-sphere" => scale_points(setup, |radius| T::one() / radius.clone()),
        // |ξ| ξ: n for √n
        "points-scaled-by-the-square" => scale_points(setup, T::clone),
        // χ = X*
        "points-not-drawn-afresh" => {
            if points {
                equations.predicted_points = |_, _, now, j| Ok(now.propagated_points[j].clone());
            }
        }
        // χ = X
        "points-not-moved" => {
            if points {
                equations.predicted_points = |_, _, now, j| Ok(now.mixed_points[j].clone());
            }
        }
        _ => return false,
    }
    true
}

/// Exchanges a rule for another, if it is the expected one.
fn exchange<T: Real>(
    rule: &mut Rule<T, Dyn>,
    expected: Result<ExactRule, InvalidRule>,
    other: Result<ExactRule, InvalidRule>,
) {
    let (Ok(expected), Ok(other)) = (expected, other) else {
        return;
    };
    let (Ok(expected), Ok(other)) = (Rule::<T, Dyn>::from_exact(&expected), Rule::from_exact(&other)) else {
        return;
    };
    if has_points_of(rule, &expected) {
        *rule = other;
    }
}

/// Whether the points of two rules are the same but for rounding: the squares of the distances are below 10⁻¹².
fn has_points_of<T: Real>(rule: &Rule<T, Dyn>, other: &Rule<T, Dyn>) -> bool {
    let small = T::ratio(1, 1_000_000_000_000);
    let is_near = |(a, b): (&DVector<T>, &DVector<T>)| norm_squared(&(a - b)) < small;
    rule.points.len() == other.points.len() && rule.points.iter().zip(&other.points).all(is_near)
}

/// Takes the weight of the point at zero away.
fn drop_centre<T: Real>(rule: &mut Rule<T, Dyn>) {
    for (s, point) in rule.points.iter().enumerate() {
        if point.iter().all(T::is_zero) {
            rule.weights[s] = T::zero();
            rule.covariance_weights[s] = T::zero();
        }
    }
}

/// Multiplies each point by a factor of its distance from zero.
fn scale_points<T: Real>(setup: &mut Setup<T>, factor: fn(&T) -> T) {
    change_rules(setup, |rule| {
        for point in &mut rule.points {
            let square = norm_squared(point);
            if !square.is_zero() {
                *point = &*point * factor(&square.sqrt());
            }
        }
    });
}

/// Sᵀ.
fn rows_of_root<T: Real>(covariance: &DMatrix<T>) -> Factored<DMatrix<T>> {
    Ok(cholesky(covariance)?.transpose())
}

/// P itself.
#[allow(clippy::unnecessary_wraps, reason = "one of several roots, and the others may fail")]
fn no_root<T: Real>(covariance: &DMatrix<T>) -> Factored<DMatrix<T>> {
    Ok(covariance.clone())
}

/// √Pᵢᵢ on the diagonal.
fn root_of_variances<T: Real>(covariance: &DMatrix<T>) -> Factored<DMatrix<T>> {
    cholesky(covariance)?;
    Ok(super::diagonal(covariance, T::sqrt))
}

fn norm_squared<T: Real>(vector: &DVector<T>) -> T {
    let squares = vector.iter().map(|entry| entry.clone() * entry.clone());
    squares.fold(T::zero(), |sum, square| sum + square)
}
