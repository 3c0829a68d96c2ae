//! Variants of filters with fixed gains: inputs of one mode used in another, and the two readings of derbez2000's update.

use super::super::setup::Setup;
use crate::filter::fixed_gain::FixedGain;
use crate::filter::{Filter, Update};
use crate::imm::Interaction;
use crate::number::Real;
use nalgebra::Dyn;

/// Applies a variant of what is given; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    of_given(id, setup) || of_reading(id, setup)
}

/// Gains and innovation covariances.
fn of_given<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let mut given: Vec<_> = setup.problem.filters.iter_mut().filter_map(given_of).collect();
    match id {
        // Kʲ⁺¹, and that of the first mode in the last
        "gain-of-the-next-mode" => rotate(&mut given, |mode| &mut mode.gain),
        "gain-of-the-first-mode" => {
            if let Some((first, others)) = given.split_first_mut() {
                for mode in others {
                    mode.gain.clone_from(&first.gain);
                }
            }
        }
        // Sʲ⁺¹
        "innovation-covariance-of-the-next-mode" => rotate(&mut given, |mode| &mut mode.innovation_covariance),
        _ => return false,
    }
    true
}

/// What a filter is given, if it is.
fn given_of<T: Real>(filter: &mut Filter<T, Dyn, Dyn>) -> Option<&mut FixedGain<T, Dyn, Dyn>> {
    match &mut filter.update {
        Update::Given(given) => Some(given),
        _ => None,
    }
}

/// The two readings of filters with given gains.
fn of_reading<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let is_given = !setup.problem.has_covariances();
    let interaction = &mut setup.problem.interaction;
    match id {
        // μᵢ∣ⱼ = 1 for i = j and 0 else, where estimates are mixed
        "unmixed-for-mixed" if is_given => *interaction = Interaction::Unmixed,
        // μᵢ∣ⱼ = pᵢⱼ μᵢ / cⱼ, where each mode starts from its own estimate
        "mixed-for-unmixed" if is_given => *interaction = Interaction::Imm,
        "unmixed-for-mixed" | "mixed-for-unmixed" => {}
        _ => return false,
    }
    true
}

/// Gives each mode a part of the next one.
fn rotate<T: Real, V: Clone>(
    given: &mut [&mut FixedGain<T, Dyn, Dyn>],
    part: fn(&mut FixedGain<T, Dyn, Dyn>) -> &mut V,
) {
    let mut parts: Vec<V> = given.iter_mut().map(|mode| part(mode).clone()).collect();
    parts.rotate_left(given.len().min(1));
    for (mode, other) in given.iter_mut().zip(parts) {
        *part(mode) = other;
    }
}
