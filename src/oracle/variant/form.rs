//! Forms: different algebra for the same exact value.
//!
//! A right filter may be written in each of these ways; only rounding differs.

use super::super::setup::Setup;
use super::{
    draws_no_points, draws_points, has_correlated_noises, is_linear, measurement_matrix, motion_matrix, noise,
    sum_of_covariance_weights, weights,
};
use crate::filter::{cubature, kalman};
use crate::gaussian::{Gaussian, mixture_covariance, mixture_mean};
use crate::imm::Equations;
use crate::imm::angles::{estimates_near, estimates_near_first, points_near, wrapped};
use crate::imm::state_conversion::Reader;
use crate::imm::{Problem, Step};
use crate::matrix::{check_positive_definite, cholesky, ldl, mirrored, solve};
use crate::number::Real;
use nalgebra::{DMatrix, DVector, Dyn};

/// Applies a form; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    of_mean(id, setup)
        || of_update(id, setup)
        || of_inverse(id, setup)
        || of_moments(id, setup)
        || of_prediction(id, setup)
        || of_probability(id, setup)
}

/// The update of the mean.
fn of_mean<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    if id != "information-update-of-the-mean" {
        return false;
    }
    // x̂ = P (P⁻⁻¹ x̂⁻ + Hᵀ R⁻¹ z), P = (P⁻⁻¹ + Hᵀ R⁻¹ H)⁻¹
    if has_information(setup) {
        setup.equations.updated_mean = |problem, _, now, j| {
            let h = measurement_matrix(problem, now, j).into_owned();
            let of_measurement = h.transpose() * inverse(noise(problem, now, j));
            let before = inverse(&now.predicted[j].covariance);
            let mean = &now.predicted[j].mean;
            let measurement = &now.innovations[j] + &h * mean;
            let updated = inverse(&(&before + &of_measurement * &h)) * (before * mean + of_measurement * measurement);
            wrapped(problem.angles_of(Reader::Mode(j)), updated)
        };
    }
    true
}

/// The updated covariance.
fn of_update<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let (points, no_points, has_information) =
        (!draws_no_points(setup), draws_no_points(setup), has_information(setup));
    let is_correlated = has_correlated_noises(setup);
    let entry = &mut setup.equations.updated_covariance;
    match id {
        // (I − W H) P⁻ (I − W H)ᵀ + W R Wᵀ; with points or correlated noises P⁻ − W Cᵀ − C Wᵀ + W S Wᵀ
        "joseph-update" if points || is_correlated => {
            *entry = |_, _, now, j| {
                let (w, c, s) = (&now.gains[j], &now.cross_covariances[j], &now.innovation_covariances[j]);
                &now.predicted[j].covariance - w * c.transpose() - c * w.transpose() + w * s * w.transpose()
            }
        }
        "joseph-update" => {
            *entry = |problem, _, now, j| {
                let w = &now.gains[j];
                let rest = rest(problem, now, j);
                let noise = w * noise(problem, now, j) * w.transpose();
                &rest * &now.predicted[j].covariance * rest.transpose() + noise
            }
        }
        // P⁻ − W Cᵀ
        "update-by-cross-covariance" => {
            *entry = |_, _, now, j| &now.predicted[j].covariance - &now.gains[j] * now.cross_covariances[j].transpose();
        }
        // (I − W H) P⁻, and − W Mᵀ where the noises are correlated
        "update-by-identity-minus-gain" => {
            if no_points {
                *entry = |problem, _, now, j| {
                    let updated = rest(problem, now, j) * &now.predicted[j].covariance;
                    match &problem.filter(j).noise_cross_covariance {
                        Some(of_noises) => updated - &now.gains[j] * of_noises.transpose(),
                        None => updated,
                    }
                }
            }
        }
        // (P⁻⁻¹ + Hᵀ R⁻¹ H)⁻¹
        "information-update" => {
            if has_information {
                *entry = |problem, _, now, j| {
                    let h = measurement_matrix(problem, now, j);
                    let information = h.transpose() * solve(&ldl(noise(problem, now, j)), &h);
                    inverse(&(inverse(&now.predicted[j].covariance) + information))
                }
            }
        }
        // ½ (P + Pᵀ)
        "symmetrised-by-the-average" => {
            *entry = |_, _, now, j| {
                let w = &now.gains[j];
                let updated = &now.predicted[j].covariance - w * &now.innovation_covariances[j] * w.transpose();
                (&updated + updated.transpose()) * T::ratio(1, 2)
            }
        }
        _ => return false,
    }
    true
}

/// Whether there is an information form: independent noises, no points, no entry of the state that a mode knows exactly, and nothing
/// that is measured exactly, whose covariances have no inverse.
fn has_information<T: Real>(setup: &Setup<T>) -> bool {
    let modes = &setup.problem.modes;
    draws_no_points(setup)
        && !has_correlated_noises(setup)
        && setup.problems().all(|problem| has_inverse(&problem.measurement_noise))
        && !modes
            .iter()
            .any(|mode| (0..setup.problem.n().0).any(|entry| mode.lacks(entry)))
}

/// Whether a covariance has an inverse, and has it still when its entries are rounded: no pivot is below 2⁻⁴⁰ of its variance.
fn has_inverse<T: Real>(covariance: &DMatrix<T>) -> bool {
    let least = T::one() / T::integer(1 << 40);
    let pivots = ldl(covariance).diagonal;
    (0..pivots.len()).all(|row| pivots[row] > covariance[(row, row)].clone() * least.clone())
}

/// The gain and the likelihood, by an inverse or another factor.
fn of_inverse<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // C · S⁻¹ and νᵀ · S⁻¹ · ν
        "explicit-inverse" => {
            equations.gain = |_, _, now, j| {
                let s = &now.innovation_covariances[j];
                check_positive_definite(&ldl(s))?;
                Ok(&now.cross_covariances[j] * inverse(s))
            };
            equations.log_likelihood = |_, _, now, j| {
                let (s, v) = (&now.innovation_covariances[j], &now.innovations[j]);
                let logarithm = log_determinant_of_two_pi(&ldl(s).diagonal);
                -((v.transpose() * inverse(s) * v)[(0, 0)].clone() + logarithm) / T::integer(2)
            };
        }
        // S = L Lᵀ, ln|S| = 2 Σ ln Lᵢᵢ, νᵀ S⁻¹ ν = |L⁻¹ ν|²
        "likelihood-by-cholesky" => {
            equations.log_likelihood = |_, _, now, j| {
                let Ok(root) = cholesky(&now.innovation_covariances[j]) else {
                    return T::undecided();
                };
                let pivots = root.diagonal().map(|entry| entry.clone() * entry);
                let mut distance = T::zero();
                for entry in &forward(&root, &now.innovations[j]) {
                    distance += entry.clone() * entry.clone();
                }
                -(distance + log_determinant_of_two_pi(&pivots)) / T::integer(2)
            }
        }
        _ => return false,
    }
    true
}

/// Moments of points and mixtures.
fn of_moments<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let points = draws_points(setup);
    let is_raw = points && setup.problems().all(is_linear) && sums_to_one(&setup.problem);
    let equations = &mut setup.equations;
    match id {
        // zhu2016 (24) completed, (45), (48)
        "raw-moments" => {
            if is_raw {
                *equations = equations.clone().with_raw_moments();
            }
        }
        // Σᵢ wᵢ (Pⁱ + x̂ⁱ x̂ⁱᵀ) − x̂ x̂ᵀ
        "mixture-by-raw-moments" => {
            equations.mixed_covariance = |problem, previous, now, j| {
                let mean = &now.mixed[j].mean;
                let estimates = estimates_near(problem, &previous.updated, Reader::Mode(j), mean);
                raw_mixture(&now.mixing_probabilities[j], &estimates, mean)
            };
            equations.combined_covariance = |problem, _, now, _| {
                let mean = &now.combined.mean;
                raw_mixture(
                    &now.mode_probabilities,
                    &estimates_near(problem, &now.updated, Reader::Common, mean),
                    mean,
                )
            };
        }
        // the last term first
        "summation-reversed" => {
            equations.mixed_mean = |problem, previous, now, j| {
                let estimates = estimates_near_first(problem, &previous.updated, Reader::Mode(j));
                mixture_mean(&reversed(&now.mixing_probabilities[j]), &reversed(&estimates))
            };
            equations.mixed_covariance = |problem, previous, now, j| {
                let mean = &now.mixed[j].mean;
                let estimates = estimates_near(problem, &previous.updated, Reader::Mode(j), mean);
                mixture_covariance(&reversed(&now.mixing_probabilities[j]), &reversed(&estimates), mean)
            };
            equations.combined_mean = |problem, _, now, _| {
                let estimates = estimates_near_first(problem, &now.updated, Reader::Common);
                mixture_mean(&reversed(&now.mode_probabilities), &reversed(&estimates))
            };
            equations.combined_covariance = |problem, _, now, _| {
                let mean = &now.combined.mean;
                let estimates = estimates_near(problem, &now.updated, Reader::Common, mean);
                mixture_covariance(&reversed(&now.mode_probabilities), &reversed(&estimates), mean)
            };
            if points {
                reverse_points(equations);
            }
        }
        _ => return false,
    }
    true
}

/// The prediction.
fn of_prediction<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let no_points = draws_no_points(setup);
    // Points of a function have moments of their own.
    let is_linear = setup
        .problems()
        .all(|problem| problem.modes.iter().all(|mode| mode.motion.is_linear()));
    let equations = &mut setup.equations;
    match id {
        // F P Fᵀ + Q with the two triangles as they come
        "prediction-not-mirrored" => {
            if no_points {
                equations.predicted_covariance = |problem, _, now, j| {
                    let mode = &problem.modes[j];
                    let f = &*motion_matrix(problem, now, j);
                    f * (&now.mixed[j].covariance * f.transpose()) + &mode.noise
                }
            }
        }
        // the moments of linear motion without points
        "prediction-by-matrices" if !(is_linear || no_points) => {}
        "prediction-by-matrices" => {
            equations.predicted_mean = |problem, _, now, j| problem.modes[j].motion.of(&now.mixed[j].mean);
            equations.predicted_covariance = |problem, _, now, j| {
                let mode = &problem.modes[j];
                kalman::predicted_covariance(&motion_matrix(problem, now, j), &now.mixed[j].covariance, &mode.noise)
            };
        }
        _ => return false,
    }
    true
}

/// The mode probabilities.
fn of_probability<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    match id {
        // μⱼ = exp( ln Lⱼ + ln cⱼ − ln Σᵢ exp(ln Lᵢ + ln cᵢ) )
        "probabilities-by-log-sum-exp" => {
            equations.mode_probability = |_, _, now, j| {
                let predicted = &now.predicted_mode_probabilities[j];
                if predicted.is_zero() {
                    return T::zero();
                }
                let logarithm = now.log_likelihoods[j].clone() + T::ln(predicted);
                T::exp(&(logarithm - now.log_evidence.clone()))
            }
        }
        _ => return false,
    }
    true
}

/// The sums over points in reversed order.
fn reverse_points<T: Real>(equations: &mut Equations<T, Dyn, Dyn>) {
    equations.predicted_mean = |problem, _, now, j| {
        let centre = problem.modes[j].motion.of(&now.mixed[j].mean);
        let points = points_near(problem, j, &now.propagated_points[j], &centre);
        cubature::weighted_mean(&reversed(weights(problem, j).0), &reversed(&points))
    };
    equations.predicted_covariance = |problem, _, now, j| {
        let mean = &now.predicted[j].mean;
        let points = points_near(problem, j, &now.propagated_points[j], mean);
        let weights = reversed(weights(problem, j).1);
        cubature::weighted_covariance(&weights, &reversed(&points), mean, &problem.modes[j].noise)
    };
}

/// I − W H.
fn rest<T: Real>(problem: &Problem<T, Dyn, Dyn>, now: &Step<T, Dyn, Dyn>, j: usize) -> DMatrix<T> {
    identity(problem.n().0) - &now.gains[j] * &*measurement_matrix(problem, now, j)
}

/// The inverse of a positive definite matrix, formed.
fn inverse<T: Real>(matrix: &DMatrix<T>) -> DMatrix<T> {
    mirrored(solve(&ldl(matrix), &identity(matrix.nrows())))
}

/// The solution y of L y = v.
fn forward<T: Real>(lower: &DMatrix<T>, vector: &DVector<T>) -> DVector<T> {
    let mut solution = vector.clone();
    for i in 0..vector.len() {
        for k in 0..i {
            let known = lower[(i, k)].clone() * solution[k].clone();
            solution[i] -= known;
        }
        solution[i] /= lower[(i, i)].clone();
    }
    solution
}

/// Σᵢ ln(2π dᵢ)
fn log_determinant_of_two_pi<T: Real>(pivots: &DVector<T>) -> T {
    let two_pi = T::pi() * T::integer(2);
    let logarithms = pivots.iter().map(|pivot| T::ln(&(two_pi.clone() * pivot.clone())));
    logarithms.fold(T::zero(), |sum, logarithm| sum + logarithm)
}

/// Σᵢ wᵢ (Pⁱ + x̂ⁱ x̂ⁱᵀ) − x̂ x̂ᵀ
fn raw_mixture<T: Real>(weights: &[T], components: &[Gaussian<T, Dyn>], mean: &DVector<T>) -> DMatrix<T> {
    mixture_covariance(weights, components, &DVector::zeros(mean.len())) - mean * mean.transpose()
}

/// Whether the weights for covariances sum to one, but for rounding.
fn sums_to_one<T: Real>(problem: &Problem<T, Dyn, Dyn>) -> bool {
    let excess: T = sum_of_covariance_weights::<T>(problem, 0) - T::one();
    excess.clone() * excess < T::ratio(1, 1_000_000_000_000)
}

fn reversed<V: Clone>(values: &[V]) -> Vec<V> {
    values.iter().rev().cloned().collect()
}

/// The unit matrix.
fn identity<T: Real>(n: usize) -> DMatrix<T> {
    DMatrix::identity(n, n)
}
