//! Variants of the mode probabilities.
//!
//! Bayes' rule can use the wrong prior, the wrong likelihood or the wrong normaliser.

use super::super::setup::Setup;
use crate::imm::printed::mode_probability_22;
use crate::imm::probability::{evidence, mode_probability, relative_likelihood};
use crate::imm::{Problem, Step};
use crate::number::Real;
use nalgebra::Dyn;
use std::cmp::Ordering;

/// Applies a variant of the mode probabilities; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    of_bayes(id, setup) || of_likelihood(id, setup) || of_result(id, setup)
}

/// Prior and normaliser.
fn of_bayes<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // μⱼ = Lⱼ μⱼ(k−1) / Σᵢ Lᵢ μᵢ(k−1)
        "updated-with-old-probabilities" => {
            equations.relative_likelihood =
                |_, previous, now, j| relative_likelihood(&now.log_likelihoods, &previous.mode_probabilities, j);
            equations.evidence =
                |_, previous, now, _| evidence(&now.relative_likelihoods, &previous.mode_probabilities);
            equations.mode_probability = |_, previous, now, j| {
                mode_probability(
                    &now.relative_likelihoods[j],
                    &previous.mode_probabilities[j],
                    &now.evidence,
                )
            };
        }
        // μⱼ = Lⱼ / Σᵢ Lᵢ
        "prior-omitted" => {
            equations.evidence = |_, _, now, _| evidence(&now.relative_likelihoods, &vec![T::one(); now.updated.len()]);
            equations.mode_probability =
                |_, _, now, j| mode_probability(&now.relative_likelihoods[j], &T::one(), &now.evidence);
        }
        // liu2017 (22) as printed; the likelihood cancels, whatever it is
        "normaliser-22" => {
            equations.mode_probability =
                |_, _, now, j| mode_probability_22(&T::zero(), &now.predicted_mode_probabilities, j);
        }
        // μⱼ = Lⱼ cⱼ
        "probabilities-not-normalised" => {
            equations.mode_probability =
                |_, _, now, j| T::exp(&now.log_likelihoods[j]) * now.predicted_mode_probabilities[j].clone();
        }
        _ => return false,
    }
    true
}

/// The likelihoods.
fn of_likelihood<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    let entry = &mut equations.relative_likelihood;
    match id {
        // the likelihood of mode r + 1 − j
        "likelihoods-reversed" => {
            *entry = |_, _, now, j| {
                let reversed: Vec<T> = now.log_likelihoods.iter().rev().cloned().collect();
                relative_likelihood(&reversed, &now.predicted_mode_probabilities, j)
            }
        }
        // Lⱼ itself, which may be too small for a double
        "likelihoods-exponentiated-before-comparing" => {
            *entry = |_, _, now, j| T::exp(&now.log_likelihoods[j]);
            equations.log_evidence = |_, _, now, _| T::ln(&now.evidence);
        }
        // max(Lⱼ, 2⁻¹⁰²²), the smallest normal double
        "likelihood-floor-smallest-double" => *entry = |_, _, now, j| floored(now, j, 2, 1022),
        "likelihood-floor-1e-300" => *entry = |_, _, now, j| floored(now, j, 10, 300),
        "likelihood-floor-1e-10" => *entry = |_, _, now, j| floored(now, j, 10, 10),
        // ln Lⱼ for Lⱼ
        "likelihood-not-exponentiated" => {
            *entry = |_, _, now, j| now.log_likelihoods[j].clone();
            // their sum may be negative, and has no logarithm then
            equations.log_evidence = |_, _, now, _| now.evidence.clone();
        }
        // all below half the smallest double, 2⁻¹⁰⁷⁵: they are zeros, and the predicted probabilities stand
        "vanishing-likelihoods-ignored" => {
            equations.mode_probability = |problem, _, now, j| {
                let smallest = log_power(2, 1075);
                if now.log_likelihoods.iter().all(|logarithm| *logarithm < smallest) {
                    return now.predicted_mode_probabilities[j].clone();
                }
                standard(problem, now, j)
            }
        }
        _ => return false,
    }
    true
}

/// What is done with the probabilities after Bayes' rule.
fn of_result<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let entry = &mut setup.equations.mode_probability;
    match id {
        "probability-floor-1e-3" => *entry = |problem, _, now, j| raised(problem, now, j, 1_000),
        "probability-floor-1e-6" => *entry = |problem, _, now, j| raised(problem, now, j, 1_000_000),
        // 1 for the greatest, 0 for the others
        "most-probable-mode-alone" => {
            *entry = |problem, _, now, j| {
                let all = all(problem, now);
                let is_greatest = (0..all.len()).all(|i| i == j || all[j] > all[i] || (all[j] == all[i] && j < i));
                if is_greatest { T::one() } else { T::zero() }
            }
        }
        _ => return false,
    }
    true
}

/// μⱼ by Bayes' rule.
fn standard<T: Real>(_: &Problem<T, Dyn, Dyn>, now: &Step<T, Dyn, Dyn>, j: usize) -> T {
    let predicted = &now.predicted_mode_probabilities[j];
    mode_probability(&now.relative_likelihoods[j], predicted, &now.evidence)
}

/// The probabilities of all modes by Bayes' rule.
fn all<T: Real>(problem: &Problem<T, Dyn, Dyn>, now: &Step<T, Dyn, Dyn>) -> Vec<T> {
    (0..problem.modes.len()).map(|j| standard(problem, now, j)).collect()
}

/// Λⱼ of likelihoods that are at least base⁻ᵉ.
fn floored<T: Real>(now: &Step<T, Dyn, Dyn>, j: usize, base: i64, exponent: i64) -> T {
    let floor = log_power(base, exponent);
    let logarithms: Vec<T> = now.log_likelihoods.iter().map(|l| at_least(l, &floor)).collect();
    relative_likelihood(&logarithms, &now.predicted_mode_probabilities, j)
}

/// μⱼ at least 1/n, and then all divided by their sum.
fn raised<T: Real>(problem: &Problem<T, Dyn, Dyn>, now: &Step<T, Dyn, Dyn>, j: usize, n: i64) -> T {
    let floor = T::ratio(1, n);
    let raised: Vec<T> = all(problem, now).iter().map(|value| at_least(value, &floor)).collect();
    let sum = raised.iter().cloned().fold(T::zero(), |sum, value| sum + value);
    raised[j].clone() / sum
}

/// The greater of two numbers.
fn at_least<T: Real>(value: &T, floor: &T) -> T {
    match value.partial_cmp(floor) {
        Some(Ordering::Less) => floor.clone(),
        Some(_) => value.clone(),
        None => T::undecided(),
    }
}

/// ln base⁻ᵉ = −e ln base
fn log_power<T: Real>(base: i64, exponent: i64) -> T {
    -(T::ln(&T::integer(base)) * T::integer(exponent))
}
