//! Variants of range and bearing: the measurement function and the circle.
//!
//! After this file the reader knows how a bearing goes wrong by its axes, its sign, its unit and its cut at ±π.

use super::super::setup::Setup;
use super::{draws_points, weights};
use crate::imm::{Problem, Step};
use crate::model::{Measurement, PolarComponent};
use crate::number::Real;
use nalgebra::SVector;

/// Applies a variant of range and bearing; whether it is one.
pub(super) fn apply<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    of_function(id, setup) || of_place(id, setup) || of_wrapping(id, setup)
}

/// The measurement function, of the points and of the centre about which their bearings are averaged.
fn of_function<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    let is_polar = matches!(setup.problem.measurement, Measurement::Polar { .. }) && draws_points(setup);
    if !is_polar {
        return FUNCTIONS.contains(&id);
    }
    let equations = &mut setup.equations;
    match id {
        "bearing-by-plain-arctangent" => {
            equations.measured_point = |problem, _, now, j, s| plain_arctangent(problem, &now.predicted_points[j][s]);
            equations.predicted_measurement = |problem, _, now, j| mean(problem, now, j, plain_arctangent);
        }
        "bearing-from-the-y-axis" => {
            equations.measured_point = |problem, _, now, j, s| from_y_axis(problem, &now.predicted_points[j][s]);
            equations.predicted_measurement = |problem, _, now, j| mean(problem, now, j, from_y_axis);
        }
        "bearing-clockwise" => {
            equations.measured_point = |problem, _, now, j, s| clockwise(problem, &now.predicted_points[j][s]);
            equations.predicted_measurement = |problem, _, now, j| mean(problem, now, j, clockwise);
        }
        "bearing-in-degrees" => {
            equations.measured_point = |problem, _, now, j, s| in_degrees(problem, &now.predicted_points[j][s]);
            equations.predicted_measurement = |problem, _, now, j| mean(problem, now, j, in_degrees);
        }
        "range-without-root" => {
            equations.measured_point = |problem, _, now, j, s| without_root(problem, &now.predicted_points[j][s]);
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
fn of_place<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    let mut nowhere = ([0; 2], [T::zero(), T::zero()]);
    let (position, sensor) = match &mut setup.problem.measurement {
        Measurement::Polar { position, sensor, .. } | Measurement::Converted { position, sensor, .. } => {
            (position, sensor)
        }
        Measurement::Linear(_) => (&mut nowhere.0, &mut nowhere.1),
    };
    match id {
        "sensor-position-ignored" => *sensor = [T::zero(), T::zero()],
        "sensor-position-added" => *sensor = sensor.clone().map(|coordinate| -coordinate),
        "position-from-the-first-entries" => *position = [0, 1.min(N - 1)],
        _ => return false,
    }
    true
}

/// The cut at ±π.
fn of_wrapping<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
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
    if innovation && !setup.problem.measurement.is_converted() {
        *equations = equations.clone().with_plain_innovation();
    }
    true
}

/// The mean of the points' measurements about the measurement of the centre by the same function.
fn mean<T: Real, const N: usize, const M: usize>(
    problem: &Problem<T, N, M>,
    now: &Step<T, N, M>,
    j: usize,
    function: fn(&Problem<T, N, M>, &SVector<T, N>) -> SVector<T, M>,
) -> SVector<T, M> {
    let centre = function(problem, &now.predicted[j].mean);
    problem
        .measurement
        .mean(weights(problem).0, &now.measured_points[j], &centre)
}

/// atan(y/x)
fn plain_arctangent<T: Real, const N: usize, const M: usize>(
    problem: &Problem<T, N, M>,
    state: &SVector<T, N>,
) -> SVector<T, M> {
    polar(
        problem,
        state,
        |x, y| T::atan2(&(y.clone() / x.clone()), &T::one()),
        T::sqrt,
    )
}

/// atan2(x, y), the compass bearing of a y-axis to the north
fn from_y_axis<T: Real, const N: usize, const M: usize>(
    problem: &Problem<T, N, M>,
    state: &SVector<T, N>,
) -> SVector<T, M> {
    polar(problem, state, |x, y| T::atan2(x, y), T::sqrt)
}

/// −atan2(y, x), of a y-axis that points down
fn clockwise<T: Real, const N: usize, const M: usize>(
    problem: &Problem<T, N, M>,
    state: &SVector<T, N>,
) -> SVector<T, M> {
    polar(problem, state, |x, y| -T::atan2(y, x), T::sqrt)
}

/// 180 atan2(y, x) / π
fn in_degrees<T: Real, const N: usize, const M: usize>(
    problem: &Problem<T, N, M>,
    state: &SVector<T, N>,
) -> SVector<T, M> {
    polar(
        problem,
        state,
        |x, y| T::atan2(y, x) * T::integer(180) / T::pi(),
        T::sqrt,
    )
}

/// x² + y²
fn without_root<T: Real, const N: usize, const M: usize>(
    problem: &Problem<T, N, M>,
    state: &SVector<T, N>,
) -> SVector<T, M> {
    polar(problem, state, |x, y| T::atan2(y, x), T::clone)
}

/// Range and bearing of a state; the range from its square, the bearing from the coordinates.
fn polar<T: Real, const N: usize, const M: usize>(
    problem: &Problem<T, N, M>,
    state: &SVector<T, N>,
    bearing: fn(&T, &T) -> T,
    range: fn(&T) -> T,
) -> SVector<T, M> {
    let Measurement::Polar {
        components,
        position,
        sensor,
    } = &problem.measurement
    else {
        return problem.measurement.of(state);
    };
    let x = state[position[0]].clone() - sensor[0].clone();
    let y = state[position[1]].clone() - sensor[1].clone();
    SVector::from_fn(|row, _| match components[row] {
        PolarComponent::Range => range(&(x.clone() * x.clone() + y.clone() * y.clone())),
        PolarComponent::Bearing => bearing(&x, &y),
    })
}
