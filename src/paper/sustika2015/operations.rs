//! What the two filters of sustika2015 cost: their own equations, run once on numbers that count.
//!
//! After this file the reader knows how many operations a cycle of each filter takes in six dimensions, under which convention, and how
//! many of them are roots and elementary functions.
//!
//! The paper's programs are not printed, and it gives seconds, not operations. What is counted is one cycle of this crate's equations at
//! the paper's setting, from the state before to the combined state after; what the paper does not compute (the combined prediction, the
//! likelihood of all modes together) is left out. A point is drawn as (27)-(29) have it: a column of the square root, scaled and added to
//! the mean; what stands above the diagonal of a Cholesky factor, and the place of the radar, are no numbers under any convention.

use super::contestants::Bearings;
use super::{Choices, scenario};
use crate::filter::kalman;
use crate::gaussian::Gaussian;
use crate::imm::{Equations, Imm, Initial, Problem};
use crate::model::{Measurement, motion::Mode};
use crate::number::{Convention, Counting, Field, Rational, Tally};
use crate::rule::unscented::unscented_in;
use crate::steady::operations::{given, shortened};
use nalgebra::{Matrix6, SMatrix, SVector, Vector2, Vector6};
use num_traits::Zero;

/// A filter whose operations are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Filter {
    /// IMM-CMKF.
    Converted,
    /// IMM-UKF as the paper has it: predicted by (14) and (15), with points for the measurement only.
    Unscented,
    /// IMM-UKF as it is run here: with points for the prediction too, which gives the same.
    UnscentedTwice,
}

type Table = Equations<Counting, 6, 2>;

/// The operations of one cycle.
///
/// Source: sustika2015, section 5.3, which compares execution times.
///
/// Example: points cost more than one converted position, and points for a linear motion more again, for the same estimate.
///
/// ```
/// use immaculate::number::Convention;
/// use immaculate::paper::sustika2015::operations::{Filter, cycle};
///
/// let cost = |filter| cycle(filter, Convention::Dense).total(Convention::Dense);
/// assert!(cost(Filter::Converted) < cost(Filter::Unscented));
/// assert!(cost(Filter::Unscented) < cost(Filter::UnscentedTwice));
/// ```
///
/// Evidence: `both_filters_of_the_coastal_radar_cost_what_their_equations_cost` (exact).
///
/// # Panics
///
/// When the defaults of what the paper leaves open are no choices; they are part of the program.
pub fn cycle(filter: Filter, convention: Convention) -> Tally {
    let setup = scenario(&Choices::default()).expect("the defaults can be chosen").setup;
    let number = |value: f64| Counting::input(value, convention);
    let (contestant, equations) = match filter {
        Filter::Converted => (setup.converted(), converted(convention)),
        Filter::Unscented => (setup.unscented(Bearings::Wrapped), unscented_with_linear_prediction()),
        Filter::UnscentedTwice => (setup.unscented(Bearings::Wrapped), unscented()),
    };
    let initial = setup.initial(&FIRST.into());
    let mut filter = Imm::unchecked(
        counting_problem(&contestant.problem, &setup.unscented, convention),
        shortened(&equations),
        &Initial {
            modes: initial
                .modes
                .iter()
                .map(|estimate| counting_estimate(estimate, convention))
                .collect(),
            mode_probabilities: initial.mode_probabilities.iter().map(|value| number(*value)).collect(),
        },
    );
    // The third measurement is counted: at the first the modes still agree on all but the acceleration.
    let _ = filter.step(Some(&Vector2::from(SECOND.map(number))));
    let third = Vector2::from(THIRD.map(number));
    let (_, tally) = Counting::count(|| filter.step(Some(&third)).is_ok());
    tally
}

/// Measured ranges and bearings, m and rad, of a target that is not far from the paper's first position; no count depends on them.
const FIRST: [f64; 2] = [1414.0, 2.36];
const SECOND: [f64; 2] = [1421.0, 2.34];
const THIRD: [f64; 2] = [1409.0, 2.35];

/// IMM-CMKF; its H takes two entries out of the state, which is free where zeros and ones are known.
fn converted(convention: Convention) -> Table {
    let table = Table::converted();
    if convention == Convention::Structural {
        return table;
    }
    Table {
        predicted_measurement: |problem, _, now, j| full_matrix(problem) * now.predicted[j].mean,
        innovation_covariance: |problem, _, now, j| {
            let (h, covariance) = (full_matrix(problem), &now.predicted[j].covariance);
            kalman::innovation_covariance(&h, covariance, &now.converted_covariance)
        },
        cross_covariance: |problem, _, now, j| {
            kalman::cross_covariance(&now.predicted[j].covariance, &full_matrix(problem))
        },
        ..table
    }
}

/// H, whose zeros and ones are numbers like any other.
fn full_matrix(problem: &Problem<Counting, 6, 2>) -> SMatrix<Counting, 2, 6> {
    given(&problem.measurement.matrix().map(Counting::value), Convention::Dense)
}

/// IMM-UKF, with points for prediction and measurement.
fn unscented() -> Table {
    Table {
        mixed_point: |problem, _, now, j, s| axis_point(problem, &now.mixed_square_roots[j], &now.mixed[j].mean, s),
        predicted_point: |problem, _, now, j, s| {
            axis_point(problem, &now.predicted_square_roots[j], &now.predicted[j].mean, s)
        },
        ..Table::cubature()
    }
}

/// A point of a rule on the axes, (27)-(29): the mean, and it plus and minus a column of the scaled square root.
fn axis_point(
    problem: &Problem<Counting, 6, 2>,
    root: &Matrix6<Counting>,
    mean: &Vector6<Counting>,
    s: usize,
) -> Vector6<Counting> {
    let point = problem.rule.as_ref().map(|rule| rule.points[s]);
    let entries = point.iter().flat_map(Vector6::iter).enumerate();
    let on_an_axis = entries.filter(|(_, entry)| !entry.is_zero());
    on_an_axis.fold(*mean, |sum, (axis, distance)| root.column(axis) * *distance + sum)
}

/// IMM-UKF with the prediction of a Kalman filter, and no points drawn for it.
fn unscented_with_linear_prediction() -> Table {
    let kalman = Table::kalman();
    Table {
        mixed_square_root: |_, _, _, _| Ok(SMatrix::zeros()),
        mixed_point: |_, _, _, _, _| SVector::zeros(),
        propagated_point: |_, _, _, _, _| SVector::zeros(),
        predicted_mean: kalman.predicted_mean,
        predicted_covariance: kalman.predicted_covariance,
        ..unscented()
    }
}

/// The filter's problem in numbers that count.
fn counting_problem(
    problem: &Problem<f64, 6, 2>,
    [alpha, beta, kappa]: &[f64; 3],
    convention: Convention,
) -> Problem<Counting, 6, 2> {
    let mode = |mode: &Mode<f64, 6>| Mode {
        name: mode.name.clone(),
        transition: given(&mode.transition, convention),
        noise: given(&mode.noise, convention),
    };
    // The rule's radius and weights depend on nothing that is measured.
    let constant = |value: &f64| Counting::rational(&Rational::from_f64(*value));
    let rule = unscented_in(&constant(alpha), &constant(beta), &constant(kappa));
    let chain = problem.transition.iter();
    Problem {
        modes: problem.modes.iter().map(mode).collect(),
        transition: chain
            .map(|row| row.iter().map(|entry| Counting::input(*entry, convention)).collect())
            .collect(),
        measurement: counting_measurement(&problem.measurement),
        measurement_noise: given(&problem.measurement_noise, convention),
        rule: problem.rule.as_ref().and(rule.ok()),
        fixed_gains: None,
    }
}

/// The filter's measurement. The radar stands at the origin: its place is no number.
fn counting_measurement(measurement: &Measurement<f64, 6, 2>) -> Measurement<Counting, 6, 2> {
    let at_origin = [Counting::zero(), Counting::zero()];
    match measurement {
        Measurement::Linear(h) => Measurement::Linear(given(h, Convention::Structural)),
        Measurement::Polar {
            components, position, ..
        } => Measurement::Polar {
            components: *components,
            position: *position,
            sensor: at_origin,
        },
        Measurement::Converted {
            components,
            position,
            conversion,
            ..
        } => Measurement::Converted {
            components: *components,
            position: *position,
            sensor: at_origin,
            conversion: *conversion,
        },
    }
}

/// The estimate in numbers that count.
fn counting_estimate(estimate: &Gaussian<f64, 6>, convention: Convention) -> Gaussian<Counting, 6> {
    Gaussian {
        mean: given(&estimate.mean, convention),
        covariance: given(&estimate.covariance, convention),
    }
}
