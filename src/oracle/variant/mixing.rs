//! Variants of the mixing: the Markov chain, the mixing probabilities and the mixed estimates.
//!
//! The two indices of the chain can be exchanged, and the spread can be taken about the wrong mean.

use super::super::chain::ChainOfRates;
use super::super::setup::Setup;
use crate::filter::extended::motion_jacobian;
use crate::filter::kalman;
use crate::gaussian::{Gaussian, mixture_covariance, mixture_mean};
use crate::imm::continuous::{rates_of_sojourns, transition_over};
use crate::imm::probability::{mixing_probability, predicted_mode_probability};
use crate::imm::state_conversion::{Reader, estimates_read};
use crate::imm::{Interaction, Problem, Step};
use crate::number::Real;
use nalgebra::{DMatrix, Dyn};
use std::borrow::Cow;

/// Applies a variant of the mixing; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    of_chain(id, setup)
        || of_mixing_probability(id, setup)
        || of_mixed_estimate(id, setup)
        || of_mixed_covariance(id, setup)
}

/// The predicted mode probabilities.
fn of_chain<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // cⱼ = Σᵢ pⱼᵢ μᵢ, and the mixing probabilities by the same matrix
        "transition-transposed" => setup.problem.chain = transposed(&setup.problem.chain),
        // I + G T instead of e^(G T)
        "chain-by-an-euler-step" => {
            if let Some(ChainOfRates { rates, interval, .. }) = setup.rates.get(&0) {
                setup.problem.chain = euler_step(rates, interval);
            }
        }
        // the rate τᵢ instead of 1/τᵢ
        "sojourn-times-as-rates" => {
            if let Some(ChainOfRates {
                sojourns: Some((times, jumps)),
                interval,
                ..
            }) = setup.rates.get(&0)
            {
                let inverses: Vec<T> = times.iter().map(|time| T::one() / time.clone()).collect();
                setup.problem.chain = transition_over(&rates_of_sojourns(&inverses, jumps), interval);
            }
        }
        // cⱼ = μⱼ; the mixing probabilities are those of the chain
        "chain-skipped" => {
            equations.predicted_mode_probability = |_, previous, _, j| previous.mode_probabilities[j].clone();
            if setup.problem.interaction != Interaction::Gpb1 {
                equations.mixing_probabilities =
                    |problem, previous, _, j| each(problem, |i| mixing(problem, previous, i, j));
            }
        }
        // no chain and no mixing: filters side by side
        "modes-without-interaction" => {
            equations.predicted_mode_probability = |_, previous, _, j| previous.mode_probabilities[j].clone();
            equations.mixing_probabilities = |problem, _, _, j| each(problem, |i| identity(i, j));
        }
        _ => return false,
    }
    true
}

/// The mixing probabilities of all previous modes i in current mode j.
fn of_mixing_probability<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let entry = &mut setup.equations.mixing_probabilities;
    match id {
        // μᵢ
        "mixing-with-mode-probabilities-alone" => *entry = |_, previous, _, _| previous.mode_probabilities.clone(),
        // pᵢⱼ μᵢ / cⱼ where each mode is to start from the combined estimate
        "common-start-mixed-by-the-chain" => {
            if setup.problem.interaction == Interaction::Gpb1 {
                *entry = |problem, previous, _, j| each(problem, |i| mixing(problem, previous, i, j));
            }
        }
        // pⱼᵢ μᵢ / cⱼ
        "transition-transposed-in-mixing" => {
            *entry = |problem, previous, now, j| {
                let (chain, predicted) = (transposed(&problem.chain), &now.predicted_mode_probabilities[j]);
                each(problem, |i| {
                    mixing_probability(&chain, &previous.mode_probabilities, predicted, i, j)
                })
            }
        }
        // pᵢⱼ μᵢ
        "mixing-not-normalised" => {
            *entry = |problem, previous, _, j| {
                each(problem, |i| {
                    problem.chain[i][j].clone() * previous.mode_probabilities[i].clone()
                })
            }
        }
        // μⱼ∣ᵢ instead of μᵢ∣ⱼ
        "mixing-indices-swapped" => {
            *entry = |problem, previous, _, j| each(problem, |i| mixing(problem, previous, j, i));
        }
        // pᵢⱼ cᵢ / cⱼ
        "mixing-with-predicted-probabilities" => {
            *entry = |problem, _, now, j| {
                let predicted = &now.predicted_mode_probabilities;
                each(problem, |i| {
                    mixing_probability(&problem.chain, predicted, &predicted[j], i, j)
                })
            }
        }
        // pᵢⱼ μᵢ / Σⱼ pᵢⱼ μᵢ = pᵢⱼ
        "mixing-normalised-by-rows" => {
            *entry = |problem, _, _, j| each(problem, |i| problem.chain[i][j].clone());
        }
        // pᵢⱼ / Σᵢ pᵢⱼ
        "mixing-without-mode-probabilities" => {
            *entry = |problem, _, _, j| {
                let ones = vec![T::one(); problem.modes.len()];
                let sum = predicted_mode_probability(&problem.chain, &ones, j);
                each(problem, |i| mixing_probability(&problem.chain, &ones, &sum, i, j))
            }
        }
        _ => return false,
    }
    true
}

/// The mixed estimates, mean and covariance.
fn of_mixed_estimate<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // each mode starts from its own estimate
        "mixing-skipped" => {
            equations.mixed_mean = |_, previous, _, j| previous.updated[j].mean.clone();
            equations.mixed_covariance = |_, previous, _, j| previous.updated[j].covariance.clone();
        }
        // all modes start from the combined estimate
        "common-mixing" => {
            equations.mixed_mean = |_, previous, _, _| previous.combined.mean.clone();
            equations.mixed_covariance = |_, previous, _, _| previous.combined.covariance.clone();
        }
        // x̂⁰ʲ = Σᵢ μⱼ∣ᵢ x̂ⁱ
        "mixed-with-transposed-probabilities" => {
            equations.mixed_mean =
                |problem, previous, _, j| mixture_mean(&swapped(problem, previous, j), &read(problem, previous, j));
            equations.mixed_covariance = |problem, previous, now, j| {
                let mean = &now.mixed[j].mean;
                mixture_covariance(&swapped(problem, previous, j), &read(problem, previous, j), mean)
            };
        }
        // the mixed estimates of the modes before j replace their estimates
        "mixing-in-place" => {
            equations.mixed_mean = |problem, previous, now, j| {
                let estimates = overwritten(problem, previous, now, j);
                mixture_mean(&now.mixing_probabilities[j], &estimates)
            };
            equations.mixed_covariance = |problem, previous, now, j| {
                let estimates = overwritten(problem, previous, now, j);
                mixture_covariance(&now.mixing_probabilities[j], &estimates, &now.mixed[j].mean)
            };
        }
        // each mode predicts its own estimate, and the predictions are mixed
        "mixing-after-prediction" => {
            equations.mixed_mean = |_, previous, _, j| previous.updated[j].mean.clone();
            equations.mixed_covariance = |_, previous, _, j| previous.updated[j].covariance.clone();
            equations.predicted_mean =
                |problem, _, now, j| mixture_mean(&now.mixing_probabilities[j], &own_predictions(problem, now, j));
            equations.predicted_covariance = |problem, _, now, j| {
                let predictions = own_predictions(problem, now, j);
                mixture_covariance(&now.mixing_probabilities[j], &predictions, &now.predicted[j].mean)
            };
        }
        _ => return false,
    }
    true
}

/// The mixed covariances.
fn of_mixed_covariance<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let entry = &mut setup.equations.mixed_covariance;
    match id {
        // P⁰ʲ = Σᵢ μᵢ∣ⱼ Pⁱ
        "mixed-spread-omitted" => {
            *entry =
                |problem, previous, now, j| without_spread(&now.mixing_probabilities[j], &read(problem, previous, j));
        }
        // x̂ⁱ − x̂
        "mixed-spread-about-combined-mean" => {
            *entry = |problem, previous, now, j| {
                let mean = &previous.combined.mean;
                mixture_covariance(&now.mixing_probabilities[j], &read(problem, previous, j), mean)
            }
        }
        // x̂ⁱ − x̂ʲ
        "mixed-spread-about-own-mean" => {
            *entry = |problem, previous, now, j| {
                let own = &previous.updated[j].mean;
                mixture_covariance(&now.mixing_probabilities[j], &read(problem, previous, j), own)
            }
        }
        // x̂ⁱ − x̂⁰ⁱ
        "mixed-spread-about-previous-index" => {
            *entry = |problem, previous, now, j| {
                let n = problem.n().0;
                let mut sum = DMatrix::zeros(n, n);
                let estimates = read(problem, previous, j);
                for (i, estimate) in estimates.iter().enumerate() {
                    let weights: Vec<T> = (0..problem.modes.len())
                        .map(|l| mixing(problem, previous, l, i))
                        .collect();
                    let mean = mixture_mean(&weights, &estimates);
                    let one = std::slice::from_ref(estimate);
                    sum += mixture_covariance(&now.mixing_probabilities[j][i..=i], one, &mean);
                }
                sum
            }
        }
        // P⁰ʲ = Pʲ
        "covariances-not-mixed" => *entry = |_, previous, _, j| previous.updated[j].covariance.clone(),
        // Σᵢ μᵢ∣ⱼ² · [ … ]
        "mixed-covariance-weights-squared" => {
            *entry = |problem, previous, now, j| {
                let weights = squared(&now.mixing_probabilities[j]);
                mixture_covariance(&weights, &read(problem, previous, j), &now.mixed[j].mean)
            }
        }
        // the scalar (x̂ⁱ − x̂⁰ʲ)ᵀ(x̂ⁱ − x̂⁰ʲ) added to every entry
        "mixed-spread-inner-product" => {
            *entry = |problem, previous, now, j| {
                let (weights, mean) = (&now.mixing_probabilities[j], &now.mixed[j].mean);
                with_inner_products(weights, &read(problem, previous, j), mean)
            }
        }
        _ => return false,
    }
    true
}

/// μᵢ∣ⱼ = pᵢⱼ μᵢ / Σᵢ pᵢⱼ μᵢ, whatever stands in the record for cⱼ.
fn mixing<T: Real>(problem: &Problem<T, Dyn, Dyn>, previous: &Step<T, Dyn, Dyn>, i: usize, j: usize) -> T {
    let (chain, probabilities) = (&problem.chain, &previous.mode_probabilities);
    mixing_probability(
        chain,
        probabilities,
        &predicted_mode_probability(chain, probabilities, j),
        i,
        j,
    )
}

/// The mixing probabilities with their indices swapped.
fn swapped<T: Real>(problem: &Problem<T, Dyn, Dyn>, previous: &Step<T, Dyn, Dyn>, j: usize) -> Vec<T> {
    each(problem, |i| mixing(problem, previous, j, i))
}

/// The estimates of the step before, as mode j reads them.
pub(super) fn read<'a, T: Real>(
    problem: &Problem<T, Dyn, Dyn>,
    previous: &'a Step<T, Dyn, Dyn>,
    j: usize,
) -> Cow<'a, [Gaussian<T, Dyn>]> {
    estimates_read(problem, &previous.updated, Reader::Mode(j))
}

/// One number for each previous mode i.
fn each<T: Real>(problem: &Problem<T, Dyn, Dyn>, of: impl Fn(usize) -> T) -> Vec<T> {
    (0..problem.modes.len()).map(of).collect()
}

/// The updated estimates of the step before, those of modes below j overwritten by the mixed ones, as mode j reads them.
fn overwritten<T: Real>(
    problem: &Problem<T, Dyn, Dyn>,
    previous: &Step<T, Dyn, Dyn>,
    now: &Step<T, Dyn, Dyn>,
    j: usize,
) -> Vec<Gaussian<T, Dyn>> {
    let mut estimates = previous.updated.clone();
    estimates[..j].clone_from_slice(&now.mixed[..j]);
    estimates_read(problem, &estimates, Reader::Mode(j)).into_owned()
}

/// The predictions of the estimates from which the modes start, as mode j reads them.
fn own_predictions<T: Real>(
    problem: &Problem<T, Dyn, Dyn>,
    now: &Step<T, Dyn, Dyn>,
    j: usize,
) -> Vec<Gaussian<T, Dyn>> {
    let modes = problem.modes.iter().zip(&now.mixed);
    let predictions = modes.map(|(mode, start)| Gaussian {
        mean: mode.motion.of(&start.mean),
        covariance: kalman::predicted_covariance(
            &motion_jacobian(&mode.motion, &start.mean),
            &start.covariance,
            &mode.noise,
        ),
    });
    let predictions: Vec<Gaussian<T, Dyn>> = predictions.collect();
    estimates_read(problem, &predictions, Reader::Mode(j)).into_owned()
}

/// Σᵢ wᵢ Pⁱ.
pub(super) fn without_spread<T: Real>(weights: &[T], components: &[Gaussian<T, Dyn>]) -> DMatrix<T> {
    let n = components[0].mean.len();
    let mut sum = DMatrix::zeros(n, n);
    for (weight, component) in weights.iter().zip(components) {
        sum += &component.covariance * weight.clone();
    }
    sum
}

/// Σᵢ wᵢ [ Pⁱ + (x̂ⁱ − x̂)ᵀ(x̂ⁱ − x̂) ], the scalar added to every entry.
pub(super) fn with_inner_products<T: Real>(
    weights: &[T],
    components: &[Gaussian<T, Dyn>],
    mean: &nalgebra::DVector<T>,
) -> DMatrix<T> {
    let mut sum = without_spread(weights, components);
    for (weight, component) in weights.iter().zip(components) {
        let deviation = &component.mean - mean;
        let mut square = T::zero();
        for entry in &deviation {
            square += entry.clone() * entry.clone();
        }
        sum += DMatrix::from_element(mean.len(), mean.len(), square * weight.clone());
    }
    sum
}

/// The squares of weights.
pub(super) fn squared<T: Real>(weights: &[T]) -> Vec<T> {
    weights.iter().map(|weight| weight.clone() * weight.clone()).collect()
}

/// I + G T.
fn euler_step<T: Real>(rates: &[Vec<T>], interval: &T) -> Vec<Vec<T>> {
    let entry = |i: usize, j: usize, rate: &T| identity::<T>(i, j) + rate.clone() * interval.clone();
    let of_row = |(i, row): (usize, &Vec<T>)| row.iter().enumerate().map(|(j, rate)| entry(i, j, rate)).collect();
    rates.iter().enumerate().map(of_row).collect()
}

fn transposed<T: Real>(chain: &[Vec<T>]) -> Vec<Vec<T>> {
    (0..chain.len())
        .map(|i| chain.iter().map(|row| row[i].clone()).collect())
        .collect()
}

fn identity<T: Real>(i: usize, j: usize) -> T {
    if i == j { T::one() } else { T::zero() }
}
