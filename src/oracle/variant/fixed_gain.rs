//! Variants of filters with fixed gains: what is given for one mode and used in another, and the two readings of derbez2000's update.
//!
//! After this file the reader knows what can be confused where nothing is computed.

use super::super::setup::Setup;
use crate::filter::fixed_gain::FixedGain;
use crate::imm::Equations;
use crate::number::Real;

/// Applies a variant of filters with fixed gains; whether it is one. On other filters they change nothing.
pub(super) fn apply<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    of_given(id, setup.problem.fixed_gains.as_deref_mut().unwrap_or_default()) || of_reading(id, setup)
}

/// What is given for each mode; nothing where gains are computed.
fn of_given<T: Real, const N: usize, const M: usize>(id: &str, given: &mut [FixedGain<T, N, M>]) -> bool {
    match id {
        // Kʲ⁺¹, and that of the first mode in the last
        "gain-of-the-next-mode" => rotate(given, |mode| &mut mode.gain),
        "gain-of-the-first-mode" => {
            if let Some((first, others)) = given.split_first_mut() {
                for mode in others {
                    mode.gain.clone_from(&first.gain);
                }
            }
        }
        // Sʲ⁺¹
        "innovation-covariance-of-the-next-mode" => rotate(given, |mode| &mut mode.innovation_covariance),
        _ => return false,
    }
    true
}

/// The readings of derbez2000's update.
fn of_reading<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    let (is_fixed, mixes) = (setup.problem.fixed_gains.is_some(), setup.equations.mixes);
    let entry = &mut setup.equations.mixing_probability;
    match id {
        // μᵢ∣ⱼ = 1 for i = j and 0 else, where estimates are mixed
        "unmixed-for-mixed" if is_fixed && mixes => *entry = Equations::fixed_gain_unmixed().mixing_probability,
        // μᵢ∣ⱼ = pᵢⱼ μᵢ / cⱼ, where each mode starts from its own estimate
        "mixed-for-unmixed" if is_fixed && !mixes => *entry = Equations::fixed_gain().mixing_probability,
        "unmixed-for-mixed" | "mixed-for-unmixed" => {}
        _ => return false,
    }
    true
}

/// Mode j has a part of mode j + 1, the last that of the first.
fn rotate<T, V: Clone, const N: usize, const M: usize>(
    given: &mut [FixedGain<T, N, M>],
    part: fn(&mut FixedGain<T, N, M>) -> &mut V,
) {
    let mut parts: Vec<V> = given.iter_mut().map(|mode| part(mode).clone()).collect();
    parts.rotate_left(given.len().min(1));
    for (mode, other) in given.iter_mut().zip(parts) {
        *part(mode) = other;
    }
}
