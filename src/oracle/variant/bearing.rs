//! Variants of range and bearing: the measurement function and the circle.
//!
//! A bearing can go wrong by its axes, its sign, its unit and its cut at ±π.

use super::super::setup::Setup;
use super::{draws_points, is_linear, weights};
use crate::imm::{Problem, Step};
use crate::model::{PolarComponent, Sensor};
use crate::number::Real;
use nalgebra::{DVector, Dyn};

/// Applies a variant of range and bearing; whether it is one.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    of_function(id, setup) || of_place(id, setup) || of_wrapping(id, setup)
}

/// The measurement function, of the points and of the centre about which their bearings are averaged.
fn of_function<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let is_polar = !setup.problems().all(is_linear) && draws_points(setup);
    if !is_polar {
        return FUNCTIONS.contains(&id);
    }
    let equations = &mut setup.equations;
    match id {
        "bearing-by-plain-arctangent" => {
            equations.measured_points = |problem, _, now, j| measured(problem, now, j, plain_arctangent);
            equations.predicted_measurement = |problem, _, now, j| mean(problem, now, j, plain_arctangent);
        }
        "bearing-from-the-y-axis" => {
            equations.measured_points = |problem, _, now, j| measured(problem, now, j, from_y_axis);
            equations.predicted_measurement = |problem, _, now, j| mean(problem, now, j, from_y_axis);
        }
        "bearing-clockwise" => {
            equations.measured_points = |problem, _, now, j| measured(problem, now, j, clockwise);
            equations.predicted_measurement = |problem, _, now, j| mean(problem, now, j, clockwise);
        }
        "bearing-in-degrees" => {
            equations.measured_points = |problem, _, now, j| measured(problem, now, j, in_degrees);
            equations.predicted_measurement = |problem, _, now, j| mean(problem, now, j, in_degrees);
        }
        "range-without-root" => {
            equations.measured_points = |problem, _, now, j| measured(problem, now, j, without_root);
            equations.predicted_measurement = |problem, _, now, j| mean(problem, now, j, without_root);
        }
        _ => return false,
    }
    true
}

/// The variants of [`of_function`].
const FUNCTIONS: [&str; 5] = [
    "bearing-by-plain-arctangent",
    "bearing-from-the-y-axis",
    "bearing-clockwise",
    "bearing-in-degrees",
    "range-without-root",
];

/// Where the sensor and the target are.
fn of_place<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let n = setup.problem.n().0;
    let mut nowhere = ([0; 2], [T::zero(), T::zero()]);
    let (position, sensor) = match &mut setup.problem.sensor {
        Sensor::Polar { position, location, .. } => (position, location),
        Sensor::Linear(_) | Sensor::Function { .. } => (&mut nowhere.0, &mut nowhere.1),
    };
    match id {
        "sensor-position-ignored" => *sensor = [T::zero(), T::zero()],
        "sensor-position-added" => *sensor = sensor.clone().map(|coordinate| -coordinate),
        "position-from-the-first-entries" => *position = [0, 1.min(n - 1)],
        _ => return false,
    }
    true
}

/// The cut at ±π.
fn of_wrapping<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let points = draws_points(setup);
    let equations = &mut setup.equations;
    let (mean, deviations, innovation) = match id {
        "bearing-mean-not-wrapped" => (true, false, false),
        "bearing-deviations-not-wrapped" => (false, true, false),
        "innovation-not-wrapped" => (false, false, true),
        "bearings-never-wrapped" => (true, true, true),
        _ => return false,
    };
    if mean && points {
        *equations = equations.clone().with_plain_mean();
    }
    if deviations && points {
        *equations = equations.clone().with_plain_deviations();
    }
    // A converted measurement has no bearing any more.
    if innovation && setup.problem.conversion().is_none() {
        *equations = equations.clone().with_plain_innovation();
    }
    true
}

/// What is measured of a state.
type OfState<T> = fn(&Problem<T, Dyn, Dyn>, &DVector<T>) -> DVector<T>;

/// The mean of the points' measurements about the measurement of the centre by the same function.
fn mean<T: Real>(
    problem: &Problem<T, Dyn, Dyn>,
    now: &Step<T, Dyn, Dyn>,
    j: usize,
    function: OfState<T>,
) -> DVector<T> {
    let centre = function(problem, &problem.in_common_state(j, &now.predicted[j].mean));
    problem
        .sensor
        .mean(weights(problem, j).0, &now.measured_points[j], &centre)
}

/// What a function of the state gives for the points of the prediction.
fn measured<T: Real>(
    problem: &Problem<T, Dyn, Dyn>,
    now: &Step<T, Dyn, Dyn>,
    j: usize,
    function: OfState<T>,
) -> Vec<DVector<T>> {
    now.predicted_points[j]
        .iter()
        .map(|point| function(problem, &problem.in_common_state(j, point)))
        .collect()
}

/// atan(y/x)
fn plain_arctangent<T: Real>(problem: &Problem<T, Dyn, Dyn>, state: &DVector<T>) -> DVector<T> {
    polar(
        problem,
        state,
        |x, y| T::atan2(&(y.clone() / x.clone()), &T::one()),
        T::sqrt,
    )
}

/// atan2(x, y), the compass bearing of a y-axis to the north
fn from_y_axis<T: Real>(problem: &Problem<T, Dyn, Dyn>, state: &DVector<T>) -> DVector<T> {
    polar(problem, state, |x, y| T::atan2(x, y), T::sqrt)
}

/// −atan2(y, x), of a y-axis that points down
fn clockwise<T: Real>(problem: &Problem<T, Dyn, Dyn>, state: &DVector<T>) -> DVector<T> {
    polar(problem, state, |x, y| -T::atan2(y, x), T::sqrt)
}

/// 180 atan2(y, x) / π
fn in_degrees<T: Real>(problem: &Problem<T, Dyn, Dyn>, state: &DVector<T>) -> DVector<T> {
    polar(
        problem,
        state,
        |x, y| T::atan2(y, x) * T::integer(180) / T::pi(),
        T::sqrt,
    )
}

/// x² + y²
fn without_root<T: Real>(problem: &Problem<T, Dyn, Dyn>, state: &DVector<T>) -> DVector<T> {
    polar(problem, state, |x, y| T::atan2(y, x), T::clone)
}

/// Range and bearing of a state; the range from its square, the bearing from the coordinates.
fn polar<T: Real>(
    problem: &Problem<T, Dyn, Dyn>,
    state: &DVector<T>,
    bearing: fn(&T, &T) -> T,
    range: fn(&T) -> T,
) -> DVector<T> {
    let Sensor::Polar {
        components,
        position,
        location,
    } = &problem.sensor
    else {
        return problem.sensor.of(state);
    };
    let x = state[position[0]].clone() - location[0].clone();
    let y = state[position[1]].clone() - location[1].clone();
    DVector::from_fn(components.len(), |row, _| match components[row] {
        PolarComponent::Range => range(&(x.clone() * x.clone() + y.clone() * y.clone())),
        PolarComponent::Bearing => bearing(&x, &y),
    })
}
