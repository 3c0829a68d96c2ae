//! What the three filters of derbez2000 cost: their own equations, run once on numbers that count.
//!
//! After this file the reader knows how many operations a cycle of each filter takes, under which convention, and beside which printed
//! number that stands.
//!
//! The paper counts with "MATLAB's built-in function", `flops`, for both coordinates together. Its program is not printed. What is counted
//! here is one cycle of this crate's equations, which are the paper's, from the state before to the combined state after; what the
//! paper does not compute (the combined prediction, the likelihood of all modes together) is left out. The two coordinates are
//! filtered separately, so that both cost twice one.

use crate::filter::fixed_gain::FixedGain;
use crate::filter::{kalman, update};
use crate::gaussian::Gaussian;
use crate::imm::{Equations, Imm, Initial, Problem};
use crate::matrix::ldl;
use crate::model::acceleration::{self, position_matrix};
use crate::model::{Measurement, motion::Mode};
use crate::number::{Convention, Counting, Field, Rational, Tally};
use crate::steady::gains;
use nalgebra::{Matrix1, Matrix3, SMatrix, SVector, Vector1, Vector3};
use num_traits::Zero;

/// A filter whose operations the paper counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Filter {
    /// The IMM filter with fixed gains.
    FixedGain,
    /// The Kalman filter of constant acceleration.
    ConstantAcceleration,
    /// The IMM filter of constant velocity and constant acceleration.
    Imm,
}

impl Filter {
    /// The three filters, from the cheapest.
    pub const ALL: [Self; 3] = [Self::FixedGain, Self::ConstantAcceleration, Self::Imm];

    /// What the paper prints: in section 4, in section 4.1, in table 1. Section 4.1 names the filters in another order than the numbers.
    pub fn printed(self) -> [usize; 3] {
        match self {
            Self::FixedGain => [242, 242, 242],
            Self::ConstantAcceleration => [590, 590, 590],
            Self::Imm => [1332, 1322, 1326],
        }
    }

    /// The filter's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::FixedGain => "fixed-gain IMM",
            Self::ConstantAcceleration => "CA Kalman filter",
            Self::Imm => "CA-CV IMM",
        }
    }
}

/// How a covariance is updated; the two are equal at the Kalman gain, and cost differently.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// P⁻ − K S Kᵀ, this crate's.
    Short,
    /// (I − K H) P⁻, which the paper prints in (2).
    Printed,
}

impl Form {
    /// Both forms.
    pub const ALL: [Self; 2] = [Self::Short, Self::Printed];
}

/// The operations of one cycle in one coordinate; twice as many for both.
///
/// Source: derbez2000, section 4, remark on the counting of operations.
///
/// Example: both coordinates cost twice one: with full matrices 2 · 114 operations, beside the printed 242.
///
/// ```
/// use immaculate::number::Convention;
/// use immaculate::steady::operations::{Filter, Form, cycle};
///
/// let tally = cycle(Filter::FixedGain, Form::Printed, Convention::Dense);
/// assert_eq!((2 * tally.total(Convention::Dense), Filter::FixedGain.printed()[0]), (228, 242));
/// // The two forms of the covariance update, P⁻ − K S Kᵀ and the printed (I − K H) P⁻, are equal and cost differently.
/// let cost = |form| cycle(Filter::ConstantAcceleration, form, Convention::Dense).total(Convention::Dense);
/// assert!(cost(Form::Short) < cost(Form::Printed));
/// ```
///
/// Evidence: `the_filters_cost_what_their_equations_cost` (exact).
pub fn cycle(filter: Filter, form: Form, convention: Convention) -> Tally {
    match filter {
        Filter::ConstantAcceleration => kalman_cycle(form, convention),
        Filter::Imm => imm_cycle(convention, &equations(form, convention), None),
        Filter::FixedGain => imm_cycle(
            convention,
            &shortened(&Equations::fixed_gain()),
            Some(fixed_gains(convention)),
        ),
    }
}

/// The scan time, the process noises and the measurement noise; no count depends on them.
const INTERVAL: f64 = 2.0;
const NOISE: f64 = 5.0;
const MEASUREMENT_VARIANCE: f64 = 0.05;

type Table = Equations<Counting, 3, 1>;

/// The matrix as an input.
pub(crate) fn given<const R: usize, const C: usize>(
    matrix: &SMatrix<f64, R, C>,
    convention: Convention,
) -> SMatrix<Counting, R, C> {
    matrix.map(|entry| Counting::input(entry, convention))
}

/// One cycle of the Kalman filter of constant acceleration.
fn kalman_cycle(form: Form, convention: Convention) -> Tally {
    let [_, mode] = modes(convention);
    let h = given(&position_matrix(), convention);
    let r = Matrix1::new(Counting::input(MEASUREMENT_VARIANCE, convention));
    let z = Vector1::new(Counting::input(7.0, convention));
    let before = estimate(convention);
    let (_, tally) = Counting::count(|| {
        let mean = kalman::predicted_mean(&mode.transition, &before.mean);
        let covariance = kalman::predicted_covariance(&mode.transition, &before.covariance, &mode.noise);
        let innovation = z - h * mean;
        let s = kalman::innovation_covariance(&h, &covariance, &r);
        let gain = update::gain(&kalman::cross_covariance(&covariance, &h), &ldl(&s));
        let updated = match form {
            Form::Short => update::updated_covariance(&covariance, &gain, &s),
            Form::Printed => printed_update(&identity(convention), &gain, &h, &covariance),
        };
        (update::updated_mean(&mean, &gain, &innovation), updated)
    });
    tally
}

/// (I − K H) P⁻ — derbez2000 (2), its last line.
///
/// Errata: the paper prints P⁰ʲ of the step before for P⁻.
fn printed_update(
    identity: &Matrix3<Counting>,
    gain: &Vector3<Counting>,
    h: &SMatrix<Counting, 1, 3>,
    predicted: &Matrix3<Counting>,
) -> Matrix3<Counting> {
    (identity - gain * h) * predicted
}

/// The identity: nine numbers like any other where matrices are full.
fn identity(convention: Convention) -> Matrix3<Counting> {
    given(&Matrix3::identity(), convention)
}

/// One cycle of an IMM filter.
fn imm_cycle(convention: Convention, equations: &Table, fixed_gains: Option<Vec<FixedGain<Counting, 3, 1>>>) -> Tally {
    let number = |value: f64| Counting::input(value, convention);
    let problem = Problem {
        modes: modes(convention).to_vec(),
        transition: vec![vec![number(0.95), number(0.05)], vec![number(0.05), number(0.95)]],
        measurement: Measurement::Linear(given(&position_matrix(), convention)),
        measurement_noise: Matrix1::new(number(MEASUREMENT_VARIANCE)),
        rule: None,
        fixed_gains,
    };
    let initial = Initial {
        modes: vec![estimate(convention); 2],
        mode_probabilities: vec![number(0.5), number(0.5)],
    };
    let mut filter = Imm::unchecked(problem, *equations, &initial);
    // The second step is counted: at the first both modes have the same estimate.
    let _ = filter.step(Some(&Vector1::new(number(7.0))));
    let (_, tally) = Counting::count(|| filter.step(Some(&Vector1::new(number(9.0)))).is_ok());
    tally
}

/// The cycle with covariances, and its covariance update in the given form.
fn equations(form: Form, convention: Convention) -> Table {
    let table = shortened(&Equations::kalman());
    match (form, convention) {
        (Form::Short, _) => table,
        (Form::Printed, Convention::Structural) => Equations {
            updated_covariance: |problem, _, now, j| {
                let (h, covariance) = (problem.measurement.matrix(), &now.predicted[j].covariance);
                printed_update(&identity(Convention::Structural), &now.gains[j], &h, covariance)
            },
            ..table
        },
        (Form::Printed, _) => Equations {
            updated_covariance: |problem, _, now, j| {
                let (h, covariance) = (problem.measurement.matrix(), &now.predicted[j].covariance);
                printed_update(&identity(Convention::Dense), &now.gains[j], &h, covariance)
            },
            ..table
        },
    }
}

/// The table without what the papers do not compute.
pub(crate) fn shortened<const N: usize, const M: usize>(
    table: &Equations<Counting, N, M>,
) -> Equations<Counting, N, M> {
    Equations {
        combined_prediction_mean: |_, _, _| SVector::zeros(),
        combined_prediction_covariance: |_, _, _| SMatrix::zeros(),
        log_evidence: |_, _, _| Counting::zero(),
        ..*table
    }
}

/// Constant velocity and constant acceleration, as inputs.
fn modes(convention: Convention) -> [Mode<Counting, 3>; 2] {
    acceleration::modes(&INTERVAL, &[NOISE; 2]).map(|mode| Mode {
        name: mode.name,
        transition: given(&mode.transition, convention),
        noise: given(&mode.noise, convention),
    })
}

/// Gains and innovation variances. The variances are known before the filter runs, so that ln|2πS| is computed once.
fn fixed_gains(convention: Convention) -> Vec<FixedGain<Counting, 3, 1>> {
    let index = gains::tracking_index(&NOISE, &MEASUREMENT_VARIANCE, &INTERVAL);
    let (velocity, acceleration) = (gains::alpha_beta_root(&index), gains::alpha_beta_gamma_root(&index));
    let fixed = |gain: Vector3<f64>, root: f64| {
        let variance = gains::innovation_variance(&root, &MEASUREMENT_VARIANCE);
        FixedGain {
            gain: given(&gain, convention),
            innovation_covariance: Matrix1::new(Counting::rational(&Rational::from_f64(variance))),
        }
    };
    vec![
        fixed(gains::alpha_beta_gain(&velocity, &INTERVAL), velocity),
        fixed(gains::alpha_beta_gamma_gain(&acceleration, &INTERVAL), acceleration),
    ]
}

/// An estimate with no zeros and ones in it.
fn estimate(convention: Convention) -> Gaussian<Counting, 3> {
    let covariance = Matrix3::new(3.0, 0.2, 0.3, 0.2, 4.0, 0.4, 0.3, 0.4, 5.0);
    Gaussian {
        mean: given(&Vector3::new(2.0, 3.0, 4.0), convention),
        covariance: given(&covariance, convention),
    }
}
