//! The extended Kalman filter: the linear equations with the Jacobians of motion and measurement.
//!
//! The mean goes through the functions themselves, the covariance through their Jacobians. Everything else is the Kalman filter:
//!
//! ```text
//! x̂⁰ ─ f ─▶ x̂⁻        P⁰ ─ F = ∂f/∂x at x̂⁰ ─▶ P⁻ = F P⁰ Fᵀ + Q                      super::kalman
//! x̂⁻ ─ h ─▶ ẑ         P⁻ ─ H = ∂h/∂x at x̂⁻ ─▶ S = H P⁻ Hᵀ + R,  C = P⁻ Hᵀ            super::kalman, super::update
//! ```
//!
//! Jacobians are not written by hand: each column is the derivative of the function itself, run in [`Dual`] numbers. One written by hand
//! is compared with it entry by entry.

use crate::matrix::{Holds, Shapes, rows};
use crate::model::Sensor;
use crate::model::motion::Motion;
use crate::number::{Dual, Real};
use nalgebra::{Dim, OMatrix, OVector};

/// The Jacobian of the motion, F = ∂f/∂x.
///
/// Source: Smith, Schmidt and McGee 1962; Bar-Shalom, Li and Kirubarajan 2001, section 10.3.
///
/// ```text
/// Fᵢₖ = ∂fᵢ/∂xₖ at x̂⁰
/// ```
///
/// | symbol | here     | shape | meaning                                                   |
/// |--------|----------|-------|-----------------------------------------------------------|
/// | f      | `motion` |       | the motion of the mode                                    |
/// | x̂⁰     | `at`     | N     | the mixed mean, from which the mode's prediction starts   |
///
/// Why: f(x̂⁰ + δ) = f(x̂⁰) + F δ + …, so that to first order the error δ of the estimate becomes F δ. Evaluated anywhere else, F belongs
/// to another error. A matrix is its own Jacobian, wherever it is evaluated.
///
/// Example: a heading ψ that turns a speed of 2 into steps along x; at ψ = 0 it moves x to second order only.
///
/// ```
/// use immaculate::filter::extended::motion_jacobian;
/// use immaculate::model::{function::Function, motion::Motion};
/// use nalgebra::{matrix, vector};
///
/// let step = [("x", "x + 2*cos(psi)"), ("psi", "psi")];
/// let function = Function::of_formulas(&["x", "psi"], &[], &[], &[], &step)?;
/// let motion = Motion::Function { function: function.into(), given: vec![] };
/// assert_eq!(motion_jacobian(&motion, &vector![5.0, 0.0]), matrix![1.0, 0.0; 0.0, 1.0]);
/// # Ok::<(), immaculate::model::function::InvalidFunction>(())
/// ```
///
/// Evidence: `a_jacobian_is_the_limit_of_difference_quotients` (symbolic),
/// `an_extended_filter_of_matrices_is_the_kalman_filter` (extended).
pub fn motion_jacobian<T: Real, N: Dim>(motion: &Motion<T, N>, at: &OVector<T, N>) -> OMatrix<T, N, N>
where
    Shapes: Holds<N>,
{
    match motion {
        Motion::Linear(f) | Motion::Affine { matrix: f, .. } => f.clone(),
        Motion::Function { function, given } => {
            let slopes = function.jacobian_at(at.as_slice(), given);
            OMatrix::from_fn_generic(rows(at), rows(at), |i, k| slopes[i][k].clone())
        }
    }
}

/// The Jacobian of the measurement, H = ∂h/∂x.
///
/// Source: Smith, Schmidt and McGee 1962; Bar-Shalom, Li and Kirubarajan 2001, section 10.3.
///
/// ```text
/// Hᵢₖ = ∂hᵢ/∂xₖ at x̂⁻
/// ```
///
/// | symbol | here     | shape | meaning              |
/// |--------|----------|-------|----------------------|
/// | h      | `sensor` |       | the measurement      |
/// | x̂⁻     | `at`     | N     | the predicted mean   |
///
/// Why: as for the motion. At the sensor itself range and bearing have no derivatives; an entry is then undecided, and the step is refused.
///
/// Example: range and bearing of a target 3 m east and 4 m north of the sensor, x/r, y/r and −y/r², x/r².
///
/// ```
/// use immaculate::filter::extended::measurement_jacobian;
/// use immaculate::model::{PolarComponent::{Bearing, Range}, Sensor};
/// use nalgebra::{U2, matrix, vector};
///
/// let radar = Sensor::<f64, U2, U2>::Polar { components: vec![Range, Bearing], position: [0, 1], location: [0.0, 0.0] };
/// let slopes = measurement_jacobian(&radar, &vector![3.0, 4.0]);
/// assert!((slopes - matrix![0.6, 0.8; -0.16, 0.12]).norm() < 1e-15);
/// ```
///
/// Evidence: `the_slopes_of_range_and_bearing_are_those_of_their_formulas` (extended).
pub fn measurement_jacobian<T: Real, N: Dim, M: Dim>(sensor: &Sensor<T, N, M>, at: &OVector<T, N>) -> OMatrix<T, M, N>
where
    Shapes: Holds<N, M>,
{
    match sensor {
        Sensor::Linear(h) => h.clone(),
        Sensor::Polar {
            components,
            position,
            location,
        } => {
            let sensor = Sensor::<Dual<T>, N, M>::Polar {
                components: components.clone(),
                position: *position,
                location: location.clone().map(Dual::constant),
            };
            let mut jacobian = OMatrix::zeros_generic(sensor.dimension(), rows(at));
            for k in 0..at.len() {
                let changing = at.map_with_location(|row, _, entry| {
                    if row == k {
                        Dual::variable(entry)
                    } else {
                        Dual::constant(entry)
                    }
                });
                for (i, value) in sensor.of(&changing).iter().enumerate() {
                    jacobian[(i, k)] = value.slope().clone();
                }
            }
            jacobian
        }
        Sensor::Function { function, given, .. } => {
            let slopes = function.jacobian_at(at.as_slice(), given);
            OMatrix::from_fn_generic(sensor.dimension(), rows(at), |i, k| slopes[i][k].clone())
        }
    }
}
