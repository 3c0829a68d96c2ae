//! Variants of angles in the state: headings that are averaged as numbers, or by sine and cosine.
//!
//! After this file the reader knows which averages have to know of the circle.

use super::super::setup::Setup;
use crate::gaussian::{mixture_covariance, mixture_mean};
use crate::number::Real;

/// Applies a variant of angles in the state; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // nothing in the state is an angle
        "state-angles-as-numbers" => {
            setup.problem.angles.clear();
        }
        // Σᵢ μᵢ∣ⱼ x̂ⁱ, and the spread about it
        "mixed-angles-as-numbers" => {
            equations.mixed_mean = |_, previous, now, j| mixture_mean(&now.mixing_probabilities[j], &previous.updated);
            equations.mixed_covariance = |_, previous, now, j| {
                mixture_covariance(&now.mixing_probabilities[j], &previous.updated, &now.mixed[j].mean)
            };
        }
        // Σⱼ μⱼ x̂ʲ, and the spread about it
        "combined-angles-as-numbers" => {
            equations.combined_mean = |_, _, now, _| mixture_mean(&now.mode_probabilities, &now.updated);
            equations.combined_covariance =
                |_, _, now, _| mixture_covariance(&now.mode_probabilities, &now.updated, &now.combined.mean);
        }
        // atan2(Σ w sin θ, Σ w cos θ)
        "state-angle-mean-vector" => *equations = equations.clone().with_mean_directions(),
        _ => return false,
    }
    true
}
