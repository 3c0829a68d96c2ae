//! Variants of the problem: numbers read in another order, in another unit or not at all.
//!
//! Right equations then give wrong values.

use super::super::setup::Setup;
use super::{diagonal, number};
use crate::imm::Problem;
use crate::model::{PolarComponent, Sensor};
use crate::number::Real;
use nalgebra::{DMatrix, DVector, Dyn};

/// Applies a variant of the problem; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    of_matrices(id, setup) || of_modes(id, setup) || of_initial(id, setup) || of_measurements(id, setup)
}

/// The matrices.
fn of_matrices<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let problem = &mut setup.problem;
    match id {
        "motion-by-columns" => {
            for mode in &mut problem.modes {
                if let Some(f) = mode.motion.matrix_mut() {
                    *f = f.transpose();
                }
            }
        }
        // the numbers of H, row after row, taken for its columns
        "measurement-matrix-by-columns" => {
            if let Sensor::Linear(h) = &mut problem.sensor {
                let by_rows = h.transpose();
                let (m, n) = h.shape();
                *h = DMatrix::from_fn(m, n, |row, column| by_rows.as_slice()[column * m + row].clone());
            }
        }
        "process-noise-of-variances-alone" => {
            for mode in &mut problem.modes {
                mode.noise = diagonal(&mode.noise, T::clone);
            }
        }
        "measurement-noise-of-variances-alone" => {
            problem.measurement_noise = diagonal(&problem.measurement_noise, T::clone);
        }
        // √Rᵢᵢ on the diagonal
        "measurement-noise-of-standard-deviations" => {
            problem.measurement_noise = diagonal(&problem.measurement_noise, T::sqrt);
        }
        // Rᵢᵢ² on the diagonal
        "measurement-noise-squared" => {
            problem.measurement_noise = diagonal(&problem.measurement_noise, |variance| {
                variance.clone() * variance.clone()
            });
        }
        // the bearing's σ read as degrees
        "bearing-noise-in-degrees" => {
            let is_angle: Vec<bool> = (0..problem.m().0).map(|row| is_bearing(problem, row)).collect();
            let unit = |row: usize| if is_angle[row] { degree() } else { T::one() };
            let noise = &problem.measurement_noise;
            problem.measurement_noise = noise.map_with_location(|row, column, entry| entry * unit(row) * unit(column));
        }
        _ => return false,
    }
    true
}

/// The order of the modes.
fn of_modes<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    match id {
        // F and Q of the last mode first
        "modes-reversed" => setup.problem.modes.reverse(),
        "initial-estimates-reversed" => setup.initial.modes.reverse(),
        "initial-probabilities-reversed" => setup.initial.mode_probabilities.reverse(),
        _ => return false,
    }
    true
}

/// The initial estimate.
fn of_initial<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let initial = &mut setup.initial;
    match id {
        "initial-probabilities-equal" => {
            let modes = initial.modes.len();
            initial.mode_probabilities = vec![T::one() / number::<T>(modes); modes];
        }
        "initial-estimate-of-the-first-mode" => {
            let first = initial.modes[0].clone();
            initial
                .modes
                .iter_mut()
                .for_each(|estimate| estimate.clone_from(&first));
        }
        "initial-covariance-of-variances-alone" => {
            for estimate in &mut initial.modes {
                estimate.covariance = diagonal(&estimate.covariance, T::clone);
            }
        }
        "initial-covariance-of-standard-deviations" => {
            for estimate in &mut initial.modes {
                estimate.covariance = diagonal(&estimate.covariance, T::sqrt);
            }
        }
        "initial-covariance-ignored" => {
            for estimate in &mut initial.modes {
                estimate.covariance.fill_with_identity();
            }
        }
        "initial-mean-ignored" => {
            for estimate in &mut initial.modes {
                estimate.mean.fill(T::zero());
            }
        }
        _ => return false,
    }
    true
}

/// The measurements.
fn of_measurements<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let measurements = &mut setup.measurements;
    match id {
        // z(k+1) at step k; the last step keeps its own
        "measurement-of-the-next-step" => {
            for k in 1..measurements.len() {
                measurements[k - 1] = measurements[k].clone();
            }
        }
        // z(k−1) at step k; the first step keeps its own
        "measurement-of-the-step-before" => {
            for k in (1..measurements.len()).rev() {
                measurements[k] = measurements[k - 1].clone();
            }
        }
        "measurement-entries-reversed" => {
            for z in measurements.iter_mut().flatten() {
                let m = z.len();
                *z = DVector::from_fn(m, |row, _| z[m - 1 - row].clone());
            }
        }
        // θ π / 180 of a bearing that is in radians already
        "degrees-for-radians" => {
            for (index, z) in measurements.iter_mut().enumerate() {
                let problem = setup.changes.get(&(index + 1)).unwrap_or(&setup.problem);
                for z in z.iter_mut() {
                    for row in (0..z.len()).filter(|&row| is_bearing(problem, row)) {
                        z[row] *= degree();
                    }
                }
            }
        }
        _ => return false,
    }
    true
}

/// Whether a component of the measurement is a bearing.
fn is_bearing<T: Real>(problem: &Problem<T, Dyn, Dyn>, row: usize) -> bool {
    problem.sensor.reports(row) == Some(PolarComponent::Bearing)
}

/// A degree in radians.
fn degree<T: Real>() -> T {
    T::pi() / T::integer(180)
}
