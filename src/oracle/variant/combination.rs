//! Variants of the combined estimates, before and after the measurement.
//!
//! An output can be combined with the wrong probabilities, or from the wrong estimates.

use super::super::setup::Setup;
use super::mixing::{squared, with_inner_products, without_spread};
use super::or_initial;
use crate::gaussian::{Gaussian, mixture_covariance, mixture_mean};
use crate::imm::state_conversion::{Reader, estimates_read};
use crate::imm::{Problem, Step};
use crate::number::Real;
use nalgebra::Dyn;
use std::borrow::Cow;

/// Applies a variant of the combination; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    of_prediction(id, setup) || of_estimate(id, setup) || of_covariance(id, setup)
}

/// The combined prediction.
fn of_prediction<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // μ(k−1) for c
        "prediction-combined-with-old-probabilities" => {
            equations.combined_prediction_mean = |problem, previous, now, _| {
                mixture_mean(&previous.mode_probabilities, &common(problem, &now.predicted))
            };
            equations.combined_prediction_covariance = |problem, previous, now, _| {
                let mean = &now.combined_prediction.mean;
                mixture_covariance(&previous.mode_probabilities, &common(problem, &now.predicted), mean)
            };
        }
        "prediction-spread-omitted" => {
            equations.combined_prediction_covariance = |problem, _, now, _| {
                without_spread(&now.predicted_mode_probabilities, &common(problem, &now.predicted))
            };
        }
        _ => return false,
    }
    true
}

/// The combined estimate, mean and covariance.
fn of_estimate<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // c for μ
        "combined-with-predicted-probabilities" => {
            equations.combined_mean = |problem, _, now, _| {
                let weights = or_initial(now, &now.predicted_mode_probabilities);
                mixture_mean(weights, &common(problem, &now.updated))
            };
            equations.combined_covariance = |problem, _, now, _| {
                let weights = or_initial(now, &now.predicted_mode_probabilities);
                mixture_covariance(weights, &common(problem, &now.updated), &now.combined.mean)
            };
        }
        // μ(k−1) for μ
        "combined-with-old-probabilities" => {
            equations.combined_mean =
                |problem, previous, now, _| mixture_mean(&previous.mode_probabilities, &common(problem, &now.updated));
            equations.combined_covariance = |problem, previous, now, _| {
                let estimates = common(problem, &now.updated);
                mixture_covariance(&previous.mode_probabilities, &estimates, &now.combined.mean)
            };
        }
        // 1/r for μ
        "combined-with-equal-weights" => {
            equations.combined_mean = |problem, _, now, _| mixture_mean(&equal(now), &common(problem, &now.updated));
            equations.combined_covariance = |problem, _, now, _| {
                mixture_covariance(&equal(now), &common(problem, &now.updated), &now.combined.mean)
            };
        }
        "combined-of-the-most-probable-mode" => {
            equations.combined_mean = |problem, _, now, _| {
                let estimates = common(problem, &now.updated);
                estimates[most_probable(&now.mode_probabilities)].mean.clone()
            };
            equations.combined_covariance = |problem, _, now, _| {
                let estimates = common(problem, &now.updated);
                estimates[most_probable(&now.mode_probabilities)].covariance.clone()
            };
        }
        // x̂⁻, P⁻ for x̂, P
        "combined-of-predicted-estimates" => {
            equations.combined_mean =
                |problem, _, now, _| mixture_mean(&now.mode_probabilities, &common(problem, shown(now)));
            equations.combined_covariance = |problem, _, now, _| {
                mixture_covariance(
                    &now.mode_probabilities,
                    &common(problem, shown(now)),
                    &now.combined.mean,
                )
            };
        }
        _ => return false,
    }
    true
}

/// The combined covariance.
fn of_covariance<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let entry = &mut setup.equations.combined_covariance;
    match id {
        // Σⱼ μⱼ Pʲ
        "combined-spread-omitted" => {
            *entry = |problem, _, now, _| without_spread(&now.mode_probabilities, &common(problem, &now.updated));
        }
        // Σⱼ μⱼ² · [ … ]
        "combined-covariance-weights-squared" => {
            *entry = |problem, _, now, _| {
                let weights = squared(&now.mode_probabilities);
                mixture_covariance(&weights, &common(problem, &now.updated), &now.combined.mean)
            };
        }
        // the scalar (x̂ʲ − x̂)ᵀ(x̂ʲ − x̂) added to every entry
        "combined-spread-inner-product" => {
            *entry = |problem, _, now, _| {
                with_inner_products(
                    &now.mode_probabilities,
                    &common(problem, &now.updated),
                    &now.combined.mean,
                )
            };
        }
        // x̂ʲ − x̂⁻ of all modes
        "combined-spread-about-prediction" => {
            *entry = |problem, _, now, _| {
                let mean = if now.step == 0 {
                    &now.combined.mean
                } else {
                    &now.combined_prediction.mean
                };
                mixture_covariance(&now.mode_probabilities, &common(problem, &now.updated), mean)
            }
        }
        _ => return false,
    }
    true
}

/// Estimates of all modes in the common state.
fn common<'a, T: Real>(
    problem: &Problem<T, Dyn, Dyn>,
    estimates: &'a [Gaussian<T, Dyn>],
) -> Cow<'a, [Gaussian<T, Dyn>]> {
    estimates_read(problem, estimates, Reader::Common)
}

/// The predicted estimates; at step 0 the initial ones.
fn shown<T: Real>(now: &Step<T, Dyn, Dyn>) -> &[Gaussian<T, Dyn>] {
    if now.step == 0 { &now.updated } else { &now.predicted }
}

/// 1/r for each of r modes.
fn equal<T: Real>(now: &Step<T, Dyn, Dyn>) -> Vec<T> {
    let modes = now.updated.len();
    vec![T::one() / super::number::<T>(modes); modes]
}

/// The mode of the greatest probability; of equal ones the first.
fn most_probable<T: Real>(probabilities: &[T]) -> usize {
    (0..probabilities.len()).fold(0, |best, j| {
        if probabilities[j] > probabilities[best] {
            j
        } else {
            best
        }
    })
}
