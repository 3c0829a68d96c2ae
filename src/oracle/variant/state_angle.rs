//! Variants of angles in the state: headings averaged as plain numbers, or by sine and cosine.

use super::super::setup::Setup;
use crate::gaussian::{mixture_covariance, mixture_mean};
use crate::imm::Interaction;
use crate::imm::state_conversion::{Reader, estimates_read};
use crate::number::Real;

/// Applies a variant of angles in the state; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // nothing in the state is an angle
        "state-angles-as-numbers" => {
            setup.problem.angles.clear();
            if let Interaction::Converted(conversions) = &mut setup.problem.interaction {
                conversions.angles.iter_mut().for_each(Vec::clear);
            }
        }
        // Σᵢ μᵢ∣ⱼ x̂ⁱ, and the spread about it
        "mixed-angles-as-numbers" => {
            equations.mixed_mean = |problem, previous, now, j| {
                let estimates = estimates_read(problem, &previous.updated, Reader::Mode(j));
                mixture_mean(&now.mixing_probabilities[j], &estimates)
            };
            equations.mixed_covariance = |problem, previous, now, j| {
                let estimates = estimates_read(problem, &previous.updated, Reader::Mode(j));
                mixture_covariance(&now.mixing_probabilities[j], &estimates, &now.mixed[j].mean)
            };
        }
        // Σⱼ μⱼ x̂ʲ, and the spread about it
        "combined-angles-as-numbers" => {
            equations.combined_mean = |problem, _, now, _| {
                let estimates = estimates_read(problem, &now.updated, Reader::Common);
                mixture_mean(&now.mode_probabilities, &estimates)
            };
            equations.combined_covariance = |problem, _, now, _| {
                let estimates = estimates_read(problem, &now.updated, Reader::Common);
                mixture_covariance(&now.mode_probabilities, &estimates, &now.combined.mean)
            };
        }
        // atan2(Σ w sin θ, Σ w cos θ)
        "state-angle-mean-vector" => *equations = equations.clone().with_mean_directions(),
        _ => return false,
    }
    true
}
