//! Variants of modes with different states: how the others read their estimates.
//!
//! A program can forget the conversion, its Jacobian, or the covariance that it adds.

use super::super::setup::Setup;
use crate::gaussian::{Gaussian, mixture_covariance, mixture_mean};
use crate::imm::Interaction;
use crate::imm::angles::estimates_near;
use crate::imm::state_conversion::Reader;
use crate::number::Real;
use nalgebra::Dyn;

/// Applies a variant of the conversion of estimates; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    if let Interaction::Converted(_) = setup.problem.interaction {
        return of_conversion(id, setup);
    }
    ALL.contains(&id)
}

/// The variants of [`of_conversion`].
const ALL: [&str; 4] = [
    "states-mixed-unconverted",
    "states-combined-unconverted",
    "state-conversion-jacobian-omitted",
    "state-conversion-covariance-not-added",
];

fn of_conversion<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // x̂ⁱ for c_ij(x̂ⁱ), and Pⁱ
        "states-mixed-unconverted" => {
            equations.mixed_mean = |_, previous, now, j| mixture_mean(&now.mixing_probabilities[j], &previous.updated);
            equations.mixed_covariance = |_, previous, now, j| {
                mixture_covariance(&now.mixing_probabilities[j], &previous.updated, &now.mixed[j].mean)
            };
        }
        // x̂ʲ for c_j(x̂ʲ), and Pʲ
        "states-combined-unconverted" => {
            equations.combined_mean = |_, _, now, _| mixture_mean(&now.mode_probabilities, &now.updated);
            equations.combined_covariance =
                |_, _, now, _| mixture_covariance(&now.mode_probabilities, &now.updated, &now.combined.mean);
        }
        // Pⁱ + A
        "state-conversion-jacobian-omitted" => {
            equations.mixed_covariance = |problem, previous, now, j| {
                let mean = &now.mixed[j].mean;
                let read = estimates_near(problem, &previous.updated, Reader::Mode(j), mean);
                let with_own_covariance = |(i, read): (usize, &Gaussian<T, Dyn>)| {
                    let mut covariance = previous.updated[i].covariance.clone();
                    if let Some(conversion) = problem.state_conversion(i, Reader::Mode(j)) {
                        covariance += &conversion.added;
                    }
                    Gaussian {
                        mean: read.mean.clone(),
                        covariance,
                    }
                };
                let estimates: Vec<_> = read.iter().enumerate().map(with_own_covariance).collect();
                mixture_covariance(&now.mixing_probabilities[j], &estimates, mean)
            };
        }
        // C Pⁱ Cᵀ
        "state-conversion-covariance-not-added" => {
            if let Interaction::Converted(conversions) = &mut setup.problem.interaction {
                for conversion in &mut conversions.list {
                    conversion.added.fill(T::zero());
                }
            }
        }
        _ => return false,
    }
    true
}
