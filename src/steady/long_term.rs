//! The long-term error of the IMM filter of constant velocity and constant acceleration: the algorithm of derbez2000.
//!
//! The six steps appear as printed, with the corrections marked. The algorithm remains an approximation.
//!
//! | step | printed                                                      | corrected                                               |
//! |------|--------------------------------------------------------------|---------------------------------------------------------|
//! | 2    | errors of two filters that stand alone, (7)                  | second moments of both errors together, with the mixing |
//! | 3    | spread of the means (μⁱˡ)² Pᵉˡ                               | (μˡ∣ʲ)² Dⁱˡ with the gap D of the two estimates         |
//! | 4    | innovation of constant velocity biased by a t²/2, variance s | its bias and its variance under step 2                  |
//! | 6    | Σ μⁱ Pᵉⁱ, an upper bound                                     | Σᵢⱼ μᵢ μⱼ E eⁱ eʲᵀ, the error of the combined estimate  |
//!
//! A third form has the printed steps with the weight of step 3 corrected alone, μˡ∣ʲ for μⁱˡ. With the printed weight the algorithm does
//! not settle: as constant acceleration becomes certain, μ²¹ tends to one, and the whole error of constant velocity is added to the
//! covariance of the filter that has none. With the corrected one it does, so that this may be what the paper's figures were computed with.
//!
//! What stays an approximation in all: probabilities and gains are constants, although they are computed from the data, and the expected
//! probability is a ratio of expected likelihoods. A long-term error that depends on how the run began, and there are such, is beyond both.
//!
//! State [p, ṗ, p̈], mode 0 constant velocity and mode 1 constant acceleration throughout.

use super::mismatch::{Mismatch, motion_missed};
use super::pair::mixing;
use super::perturbation::{printed_spread_bound, second_moment, spread_term};
use super::riccati::{DOUBLINGS, Riccati};
use crate::filter::kalman;
use crate::gaussian::log_density;
use crate::matrix::ldl;
use crate::model::acceleration::{
    acceleration_response, constant_acceleration, embedded_constant_velocity, embedded_velocity_response,
    position_matrix, response_noise,
};
use crate::number::Real;
use nalgebra::{Matrix1, Matrix3, RowVector3, SMatrix, SVector, Vector1, Vector3};

/// What the long-term error depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// t, s.
    pub interval: f64,
    /// a, m/s².
    pub acceleration: f64,
    /// R, m².
    pub measurement_variance: f64,
    /// q_v and q_a, (m/s²)².
    pub noises: [f64; 2],
    /// p_vv = p_aa, the probability that a mode stays.
    pub stay: f64,
}

/// What the algorithm ends with.
#[derive(Debug, Clone, PartialEq)]
pub struct LongTerm {
    /// P_err.
    pub error: Matrix3<f64>,
    /// μ.
    pub probabilities: [f64; 2],
    /// The number of rounds.
    pub rounds: usize,
    /// Whether the last round changed nothing any more; else the rounds were given up.
    pub converged: bool,
}

impl LongTerm {
    /// The total error, trace P_err.
    pub fn total(&self) -> f64 {
        self.error.trace()
    }
}

/// Which form of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// As printed.
    Printed,
    /// As printed, except that the weights of step 3 are those of (1): μˡ∣ʲ for μⁱˡ.
    Reindexed,
    /// With the corrections of the table at the head of this file.
    Corrected,
}

/// The rounds after which the algorithm is given up.
const MOST_ROUNDS: usize = 500;
/// A round that moves no probability by more than this, and no entry of the error by more than this part of its trace, is the last: four
/// digits beyond what is printed of a percentage.
const SETTLED: f64 = 1e-9;

impl Setting {
    pub(super) fn motions(&self) -> [Matrix3<f64>; 2] {
        [
            embedded_constant_velocity(&self.interval),
            constant_acceleration(&self.interval),
        ]
    }

    pub(super) fn process_noises(&self) -> [Matrix3<f64>; 2] {
        let responses = [
            embedded_velocity_response(&self.interval),
            acceleration_response(&self.interval),
        ];
        [0, 1].map(|j| response_noise(&responses[j], &self.noises[j]))
    }

    pub(super) fn chain(&self) -> Vec<Vec<f64>> {
        let switch = 1.0 - self.stay;
        vec![vec![self.stay, switch], vec![switch, self.stay]]
    }

    /// The Riccati equations of the two filters alone.
    fn filters(&self) -> [Riccati<f64, 3, 1>; 2] {
        let (motions, noises) = (self.motions(), self.process_noises());
        [0, 1].map(|j| Riccati {
            transition: motions[j],
            measurement: position_matrix(),
            noise: noises[j],
            measurement_noise: Matrix1::new(self.measurement_variance),
        })
    }

    /// What each filter does not know of the target: constant velocity the acceleration, the other nothing.
    fn missed(&self) -> [Vector3<f64>; 2] {
        [motion_missed(&self.acceleration, &self.interval), Vector3::zeros()]
    }
}

/// One round of the algorithm: everything that is carried to the next.
#[derive(Debug, Clone, PartialEq)]
struct Round {
    /// P⁰ʲ.
    mixed: [Matrix3<f64>; 2],
    /// μ.
    probabilities: [f64; 2],
    /// P_err of step 6.
    error: Matrix3<f64>,
}

/// The long-term error by steps 0 to 6; none where a filter alone has no steady state, or the errors of a round have no bound.
///
/// Source: derbez2000, section 2.2, algorithm.
///
/// Example: A target at a = 50 m/s²: constant acceleration becomes certain. The printed weight then does not let the rounds end.
///
/// ```
/// use immaculate::steady::long_term::{Form, Setting, predict};
///
/// let setting = Setting { interval: 2.0, acceleration: 50.0, measurement_variance: 0.05, noises: [5.0, 5.0], stay: 0.95 };
/// assert!(!predict(&setting, Form::Printed).unwrap().converged);
/// let corrected = predict(&setting, Form::Corrected).unwrap();
/// assert!(corrected.converged && corrected.probabilities[1] > 0.9);
/// ```
///
/// Errata: see the head of this file; the left side of step 3 has the index 0 for 1.
///
/// Evidence: `the_corrected_algorithm_predicts_the_simulated_error`, `the_printed_weight_lets_the_algorithm_run_away` (statistics).
pub fn predict(setting: &Setting, form: Form) -> Option<LongTerm> {
    let mut round = first_round(setting)?;
    for rounds in 1..=MOST_ROUNDS {
        let next = match form {
            Form::Printed => printed_round(setting, &round, printed_spread)?,
            Form::Reindexed => printed_round(setting, &round, reindexed_spread)?,
            Form::Corrected => corrected_round(setting, &round)?,
        };
        let moved = (next.probabilities[0] - round.probabilities[0]).abs();
        let apart = (next.error - round.error).abs().max();
        let converged = moved < SETTLED && apart < SETTLED * next.error.trace();
        round = next;
        if converged || rounds == MOST_ROUNDS {
            return Some(LongTerm {
                error: round.error,
                probabilities: round.probabilities,
                rounds,
                converged,
            });
        }
    }
    None
}

/// Steps 0 and 1: equal probabilities, and the steady covariances of the filters alone.
fn first_round(setting: &Setting) -> Option<Round> {
    let settled = |filter: &Riccati<f64, 3, 1>| Some(filter.updated(&filter.doubled(DOUBLINGS)?));
    let [velocity, acceleration] = setting.filters();
    Some(Round {
        mixed: [settled(&velocity)?, settled(&acceleration)?],
        probabilities: [0.5, 0.5],
        error: Matrix3::zeros(),
    })
}

/// What both forms compute from the mixed covariances by (2): predicted covariances, gains, updated covariances.
struct Filters {
    predicted: [Matrix3<f64>; 2],
    gains: [Vector3<f64>; 2],
    updated: [Matrix3<f64>; 2],
}

fn run_filters(setting: &Setting, mixed: &[Matrix3<f64>; 2]) -> Filters {
    let filters = setting.filters();
    let predicted = [0, 1].map(|j| kalman::predicted_covariance(&filters[j].transition, &mixed[j], &filters[j].noise));
    Filters {
        gains: [0, 1].map(|j| filters[j].gain(&predicted[j])),
        updated: [0, 1].map(|j| filters[j].updated(&predicted[j])),
        predicted,
    }
}

/// What step 3 adds to mode i's covariance in the mixture for mode j.
type Spread = fn(&[Vec<f64>], &[Matrix3<f64>; 2], usize, usize) -> Matrix3<f64>;

/// Σ (μⁱˡ)² (1 − δᵢₗ) Pᵉˡ: the weight does not depend on j, and as one mode becomes certain that of the *other* error tends to one.
fn printed_spread(mixing: &[Vec<f64>], errors: &[Matrix3<f64>; 2], i: usize, _: usize) -> Matrix3<f64> {
    printed_spread_bound(mixing, errors, i)
}

/// (μˡ∣ʲ)² Pᵉˡ, l ≠ i.
fn reindexed_spread(mixing: &[Vec<f64>], errors: &[Matrix3<f64>; 2], i: usize, j: usize) -> Matrix3<f64> {
    spread_term(&mixing[j][1 - i], &errors[1 - i])
}

/// Steps 2, 3, 4 and 6 as printed — derbez2000 (algorithm-step-2), (algorithm-step-4).
///
/// Source: derbez2000, section 2.2, algorithm. "The new covariances" of step 5 are read as P⁰ʲ, and Pⁱ of step 3 as the ones of (2), with
/// step 2's for constant acceleration.
///
/// Evidence: `the_printed_weight_lets_the_algorithm_run_away` (property), `the_figures_show_where_the_prediction_is_right` (statistics).
fn printed_round(setting: &Setting, round: &Round, spread: Spread) -> Option<Round> {
    let h = position_matrix::<f64>();
    let (motions, r) = (setting.motions(), setting.measurement_variance);
    let filters = run_filters(setting, &round.mixed);
    // Step 2: (7) for constant velocity; for constant acceleration the recursion without process noise.
    let mismatch = Mismatch::new(&motions[0], &h, filters.gains[0], &setting.missed()[0], r);
    let matched = Mismatch::new(&motions[1], &h, filters.gains[1], &Vector3::zeros(), r);
    let gain = matched.gain;
    let carried = matched.closed_loop * round.mixed[1] * matched.closed_loop.transpose() + gain * gain.transpose() * r;
    let errors = [mismatch.long_term_error()?, carried];
    // Step 3.
    let (mixing, predicted) = mixing(&setting.chain(), &round.probabilities);
    let covariances = [filters.updated[0], carried];
    let mixed = [0, 1].map(|j| {
        (0..2).fold(Matrix3::zeros(), |sum, i| {
            sum + (covariances[i] + spread(&mixing, &errors, i, j)) * mixing[j][i]
        })
    });
    // Step 4: s with Q = 0, and the bias of a filter without a lag.
    let bias = [setting.acceleration * setting.interval * setting.interval / 2.0, 0.0];
    let likelihoods = [0, 1].map(|j| {
        let s = (h * motions[j] * round.mixed[j] * motions[j].transpose() * h.transpose())[(0, 0)] + r;
        expected_log_likelihood(bias[j], s, s)
    });
    let probabilities = normalised(&predicted, &likelihoods);
    // Step 6.
    let error = errors[0] * probabilities[0] + mixed[1] * probabilities[1];
    let next = Round {
        mixed,
        probabilities,
        error,
    };
    next.error.iter().all(|entry| entry.is_finite()).then_some(next)
}

/// Steps 2, 3, 4 and 6 corrected.
///
/// Source: derbez2000, section 2.2, algorithm, corrected here.
fn corrected_round(setting: &Setting, round: &Round) -> Option<Round> {
    let filters = run_filters(setting, &round.mixed);
    let (mixing, predicted) = mixing(&setting.chain(), &round.probabilities);
    // Step 2.
    let errors = JointErrors::new(setting, &filters.gains, &mixing)?;
    // Step 3: (1), with the expectation of its second term.
    let gap = errors.gap();
    let mixed = [0, 1].map(|j| {
        (0..2).fold(Matrix3::zeros(), |sum, i| {
            sum + (filters.updated[i] + spread_term(&mixing[j][1 - i], &gap)) * mixing[j][i]
        })
    });
    // Step 4: what the filter believes of its innovation, (4), and what the innovation is.
    let h = position_matrix::<f64>();
    let likelihoods = [0, 1].map(|j| {
        let believed = (h * filters.predicted[j] * h.transpose())[(0, 0)] + setting.measurement_variance;
        let (bias, variance) = errors.innovation(setting, &mixing, j);
        expected_log_likelihood(bias, believed, variance)
    });
    let probabilities = normalised(&predicted, &likelihoods);
    // Step 6.
    let error = errors.combined(&probabilities);
    Some(Round {
        mixed,
        probabilities,
        error,
    })
}

/// ln E N(ν; 0, s) for an innovation ν ~ N(bias, variance): ln N(bias; 0, s + variance) — derbez2000 (algorithm-step-4).
///
/// Source: derbez2000, step 4, which has s for both; ∫ N(ν; 0, s) N(ν; b, v) dν = N(b; 0, s + v).
///
/// Example: an innovation with the mean 2 and the variance 3, believed to have 1: ln N(2; 0, 4) = −(ln 8π + 2²/4)/2.
///
/// ```
/// use immaculate::steady::long_term::expected_log_likelihood;
///
/// let exact = -((8.0 * std::f64::consts::PI).ln() + 1.0) / 2.0;
/// assert!((expected_log_likelihood(2.0, 1.0, 3.0) - exact).abs() < 1e-15); // a few units of the last place
/// ```
///
/// Evidence: `the_corrected_algorithm_predicts_the_simulated_error` (statistics).
pub fn expected_log_likelihood(bias: f64, believed: f64, variance: f64) -> f64 {
    log_density(&Vector1::new(bias), &ldl(&Matrix1::new(believed + variance)))
}

/// μⱼ ∝ cⱼ Lⱼ.
fn normalised(predicted: &[f64; 2], log_likelihoods: &[f64; 2]) -> [f64; 2] {
    let greatest = log_likelihoods[0].max(log_likelihoods[1]);
    let weights = [0, 1].map(|j| predicted[j] * Real::exp(&(log_likelihoods[j] - greatest)));
    weights.map(|weight| weight / (weights[0] + weights[1]))
}

/// Mean and covariance of the errors (e⁰, e¹) of both filters, updated, with constant gains and constant mixing probabilities —
/// derbez2000 (algorithm-step-2).
///
/// ```text
/// e = A (U ⊗ I) e + b − K v,   A = diag(A₀, A₁),   b = (b₊, 0),   K = (K₀, K₁)
/// ```
///
/// Source: derbez2000 (7) for two filters at once; exact as long as gains and probabilities are constant.
///
/// Example: two filters that do not mix; t = a = R = 1. Constant velocity errs by a variance of 2/3 and a lag of 1/2: 2/3 + 1/4.
///
/// ```
/// use immaculate::steady::long_term::{JointErrors, Setting};
/// use nalgebra::vector;
///
/// let setting = Setting { interval: 1.0, acceleration: 1.0, measurement_variance: 1.0, noises: [1.0, 1.0], stay: 1.0 };
/// let gains = [vector![0.75, 0.5, 0.0], vector![0.75, 0.5, 1.0 / 6.0]];
/// let errors = JointErrors::new(&setting, &gains, &[vec![1.0, 0.0], vec![0.0, 1.0]]).unwrap();
/// assert!((errors.moment(0, 0)[(0, 0)] - 11.0 / 12.0).abs() < 1e-14); // rounding of the doubled sums
/// ```
///
/// Evidence: `the_corrected_algorithm_predicts_the_simulated_error` (statistics).
#[derive(Debug, Clone, PartialEq)]
pub struct JointErrors {
    mean: SVector<f64, 6>,
    covariance: SMatrix<f64, 6, 6>,
}

impl JointErrors {
    /// None where the errors are not bounded.
    pub fn new(setting: &Setting, gains: &[Vector3<f64>; 2], mixing: &[Vec<f64>]) -> Option<Self> {
        let (motions, missed) = (setting.motions(), setting.missed());
        let (mut a, mut b) = (SMatrix::<f64, 6, 6>::zeros(), SVector::<f64, 6>::zeros());
        let mut noise = SVector::<f64, 6>::zeros();
        for j in 0..2 {
            let r = setting.measurement_variance;
            let filter = Mismatch::new(&motions[j], &position_matrix(), gains[j], &missed[j], r);
            for (i, weight) in mixing[j].iter().enumerate() {
                let block = filter.closed_loop * *weight;
                a.fixed_view_mut::<3, 3>(3 * j, 3 * i).copy_from(&block);
            }
            b.fixed_rows_mut::<3>(3 * j).copy_from(&filter.missed);
            noise.fixed_rows_mut::<3>(3 * j).copy_from(&filter.gain);
        }
        let constant = noise * noise.transpose() * setting.measurement_variance;
        let (mean, covariance) = settle(a, b, constant)?;
        Some(Self { mean, covariance })
    }

    /// E eⁱ eʲᵀ.
    pub fn moment(&self, i: usize, j: usize) -> Matrix3<f64> {
        let all = second_moment(&self.mean, &self.covariance);
        all.fixed_view::<3, 3>(3 * i, 3 * j).into_owned()
    }

    /// D, the second moment of the difference of the two estimates.
    pub fn gap(&self) -> Matrix3<f64> {
        self.moment(0, 0) + self.moment(1, 1) - self.moment(0, 1) - self.moment(1, 0)
    }

    /// The second moment of the combined estimate's error, Σᵢⱼ μᵢ μⱼ E eⁱ eʲᵀ — derbez2000 (algorithm-step-6).
    ///
    /// Source: derbez2000, step 6 corrected: the paper's Σ μᵢ E eⁱ eⁱᵀ is above it, since Σ μᵢ eⁱeⁱᵀ − e eᵀ = Σ μᵢ (eⁱ − e)(eⁱ − e)ᵀ.
    ///
    /// Example: two filters that mix in halves, on an acceleration of 1 m/s².
    ///
    /// ```
    /// use immaculate::steady::long_term::{JointErrors, Setting};
    /// use nalgebra::vector;
    ///
    /// let setting = Setting { interval: 1.0, acceleration: 1.0, measurement_variance: 1.0, noises: [1.0, 1.0], stay: 0.5 };
    /// let gains = [vector![0.75, 0.5, 0.0], vector![0.75, 0.5, 1.0 / 6.0]];
    /// let errors = JointErrors::new(&setting, &gains, &[vec![0.5, 0.5], vec![0.5, 0.5]]).unwrap();
    /// // With one filter certain its own error is left; between equals the printed sum has half of their gap's spread too much.
    /// assert_eq!(errors.combined(&[1.0, 0.0]), errors.moment(0, 0));
    /// let printed = (errors.moment(0, 0) + errors.moment(1, 1)) * 0.5;
    /// let apart = printed - errors.combined(&[0.5, 0.5]) - errors.gap() * 0.25;
    /// assert!(apart.abs().max() < 1e-12 * printed.abs().max()); // rounding
    /// ```
    ///
    /// Evidence: `the_error_of_step_6_is_below_its_upper_bound` (property).
    pub fn combined(&self, probabilities: &[f64; 2]) -> Matrix3<f64> {
        let mut sum = Matrix3::zeros();
        for i in 0..2 {
            for j in 0..2 {
                sum += self.moment(i, j) * (probabilities[i] * probabilities[j]);
            }
        }
        sum
    }

    /// Mean and variance of filter j's innovation, H (Fⱼ e⁰ʲ + bⱼ) + v.
    fn innovation(&self, setting: &Setting, mixing: &[Vec<f64>], j: usize) -> (f64, f64) {
        let row: RowVector3<f64> = position_matrix::<f64>() * setting.motions()[j];
        let mut weights = SMatrix::<f64, 1, 6>::zeros();
        for (i, weight) in mixing[j].iter().enumerate() {
            weights.fixed_view_mut::<1, 3>(0, 3 * i).copy_from(&(row * *weight));
        }
        let bias = (weights * self.mean)[(0, 0)] + setting.missed()[j][0];
        let variance = (weights * self.covariance * weights.transpose())[(0, 0)] + setting.measurement_variance;
        (bias, variance)
    }
}

/// The steady mean and covariance of e ← A e + b + w, by doubling: each round sums as many steps again.
///
/// Source: Smith 1968, X = Σ Aᵏ C Aᵏᵀ and m = Σ Aᵏ b. None where the sums do not end.
fn settle<const N: usize>(
    mut a: SMatrix<f64, N, N>,
    mut mean: SVector<f64, N>,
    mut covariance: SMatrix<f64, N, N>,
) -> Option<(SVector<f64, N>, SMatrix<f64, N, N>)> {
    // 2⁴⁰ steps: a spectral radius that is nearer to one than 1e-10 has no steady state for doubles.
    for _ in 0..40 {
        mean += a * mean;
        covariance += a * covariance * a.transpose();
        a = a * a;
        if !a.iter().chain(mean.iter()).all(|entry| entry.is_finite()) {
            return None;
        }
        // What is left changes no digit.
        if a.abs().max() < 1e-20 {
            return Some((mean, covariance));
        }
    }
    None
}
