//! Goal: the whole cycle obeys the laws of what it is: a set of filters, a Markov chain between them, Bayes' rule, and a scene that
//! can be mirrored, turned and measured in other units.
//!
//! Method: whole runs in doubles through [`immaculate::imm::Imm`] (constant velocity and two turns, n = 4, m = 2, linear and
//! range-bearing measurements, every filter, steps without a detection among them), each compared with another run that a law says
//! must agree. Kind of evidence: property. Where a law holds for rounded arithmetic too, the runs agree to the last bit; elsewhere the
//! tolerance is the rounding that [`common::rounding_of`] derives, in standard deviations.

#![allow(
    clippy::needless_range_loop,
    reason = "i and j are the numbers of modes, in several lists at once"
)]

mod common;

use common::{
    CHAIN, ROUNDOFF, RULES, Scene, TURN_RATE, all_scenes, bits, bits_of, converted_scene, distance, distance_of_runs,
    fixed_gain_scene, linear_scene, linear_scene_with, mode, polar_scene, polar_scene_seen_from, rounding_of, rule_of,
    scene_over_the_sensor, truth, unscented_of,
};
use immaculate::filter::extended::measurement_jacobian;
use immaculate::filter::fixed_gain::FixedGain;
use immaculate::filter::{Filter, Transform, Update, cubature, kalman, raw, update};
use immaculate::gaussian::{Gaussian, log_density, mixture_covariance, mixture_mean};
use immaculate::imm::probability::predicted_mode_probability;
use immaculate::imm::{Equations, Imm, Initial, Interaction, Problem, Quantity, Step};
use immaculate::matrix::{Holds, Shapes, cholesky, is_positive_semidefinite, is_symmetric, ldl};
use immaculate::model::angle::wrap;
use immaculate::model::function::Function;
use immaculate::model::motion::{Mode, Motion, constant_velocity, coordinated_turn, integrated_noise};
use immaculate::model::space::{Component, Space};
use immaculate::model::{Conversion, PolarComponent, Sensor};
use immaculate::number::{self, Field, RandomRounding, Rational};
use immaculate::paper::zhu2016::diagonal_mixing;
use immaculate::rule::{Rule, RuleName};
use nalgebra::{
    Const, DMatrix, DVector, Dim, Dyn, Matrix3, Matrix4, RowVector3, SMatrix, SVector, U2, U4, U8, Vector2, Vector4,
    matrix, vector,
};
use proptest::prelude::*;
use std::f64::consts::PI;
use std::sync::Arc;

// One filter

/// One mode is the filter inside it, bit for bit: to mix one estimate with itself rounds nothing.
#[test]
fn one_mode_is_the_plain_filter() {
    for (name, scene) in all_scenes() {
        for j in 0..3 {
            let alone = with_modes(&scene, &[j]);
            let plain = plain_run(&alone, 0);
            for (step, plain) in alone.run().iter().zip(&plain) {
                assert_eq!(bits_of(&step.updated[0]), bits_of(plain), "{name}");
                assert_eq!(bits_of(&step.combined), bits_of(plain), "{name}");
                assert_eq!(
                    bits_of(&step.combined_prediction),
                    bits_of(&step.predicted[0]),
                    "{name}"
                );
                assert_eq!(step.mode_probabilities, [1.0], "{name}");
            }
        }
    }
}

/// Under the identity no mode is left for another: each runs by itself, bit for bit, and only the probabilities know of the others.
#[test]
fn the_identity_transition_never_mixes() {
    for (name, mut scene) in all_scenes() {
        scene.problem.chain = identity_chain(3);
        let run = scene.run();
        for j in 0..3 {
            let plain = plain_run(&scene, j);
            for (step, plain) in run.iter().zip(&plain) {
                assert_eq!(bits_of(&step.updated[j]), bits_of(plain), "{name}");
                for i in 0..3 {
                    let expected = f64::from(i == j);
                    assert_eq!(bits([&step.mixing_probabilities[j][i]]), bits([&expected]));
                }
            }
        }
        // The probabilities are those of three models of which one is right all the time: the product of all likelihoods.
        let mut log_weights: Vec<f64> = scene.initial.mode_probabilities.iter().map(|p| p.ln()).collect();
        for step in run.iter().filter(|step| step.measurement.is_some()) {
            for j in 0..3 {
                log_weights[j] += step.log_likelihoods[j];
            }
        }
        let greatest = log_weights.iter().copied().fold(f64::MIN, f64::max);
        let sum: f64 = log_weights.iter().map(|w| (w - greatest).exp()).sum();
        for j in 0..3 {
            let expected = (log_weights[j] - greatest).exp() / sum;
            let probability = run.last().unwrap().mode_probabilities[j];
            // 30 steps of sums of logarithms below 10³ in size, rounded a few times each.
            assert!((probability - expected).abs() <= 30.0 * 10.0 * 1000.0 * ROUNDOFF);
        }
    }
}

/// Modes that are the same are one filter, whatever the chain and the probabilities are. To mix an estimate with itself under rounded
/// weights is a rounding of the estimate, so the tolerance is that of a run.
#[test]
fn identical_modes_are_the_plain_filter_for_any_transition_matrix() {
    let asymmetric = CHAIN.map(|row| row.to_vec()).to_vec();
    let cyclic = vec![vec![0.0, 1.0, 0.0], vec![0.0, 0.0, 1.0], vec![1.0, 0.0, 0.0]];
    let absorbing = vec![vec![0.5, 0.3, 0.2], vec![0.0, 0.6, 0.4], vec![0.0, 0.0, 1.0]];
    for chain in [asymmetric, cyclic, absorbing] {
        for (name, scene) in all_scenes() {
            let mut scene = with_identical_modes(&scene);
            scene.problem.chain.clone_from(&chain);
            let run = scene.run();
            let plain = plain_run(&scene, 0);
            let allowed = rounding_of(&run);
            for (step, plain) in run.iter().zip(&plain) {
                assert!(distance(&step.combined, plain) <= allowed, "{name}");
                for estimate in &step.updated {
                    assert!(distance(estimate, plain) <= allowed, "{name}");
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    /// The same for random chains and random probabilities at the start.
    #[test]
    fn identical_modes_are_the_plain_filter_for_random_transition_matrices(
        rows in [probabilities(), probabilities(), probabilities()], start in probabilities(), polar: bool,
    ) {
        let scene = if polar { polar_scene_seen_from([0.0, 0.0], "simplex-5") } else { linear_scene() };
        let mut scene = with_identical_modes(&scene);
        scene.problem.chain = rows.to_vec();
        scene.initial.mode_probabilities = start;
        let run = scene.run();
        let allowed = rounding_of(&run);
        for (step, plain) in run.iter().zip(&plain_run(&scene, 0)) {
            prop_assert!(distance(&step.combined, plain) <= allowed);
        }
    }
}

/// Three probabilities that sum to one exactly: multiples of 1/64, zero and one among them.
fn probabilities() -> impl Strategy<Value = Vec<f64>> {
    (0..=64_u32, 0..=64_u32).prop_map(|(a, b)| {
        let (low, high) = (a.min(b), a.max(b));
        [low, high - low, 64 - high].map(|part| f64::from(part) / 64.0).to_vec()
    })
}

// The chain

/// When all modes explain the measurement equally well it says nothing about the mode: the probabilities follow the chain. On rationals
/// they are those of the chain's powers, πᵀPᵏ, exactly; in a run of identical modes, whose likelihoods differ by the rounding of
/// their estimates, up to that rounding.
#[test]
fn without_information_probabilities_follow_the_markov_chain() {
    let q = Rational::new;
    let chain = Matrix3::new(
        q(9, 10),
        q(6, 100),
        q(4, 100),
        q(3, 20),
        q(4, 5),
        q(1, 20),
        q(1, 50),
        q(2, 25),
        q(9, 10),
    );
    let rows: Vec<Vec<Rational>> = chain.row_iter().map(|row| row.iter().cloned().collect()).collect();
    let start = [q(5, 8), q(1, 4), q(1, 8)];
    let (mut power, mut probabilities) = (Matrix3::identity(), start.to_vec());
    for _ in 0..10 {
        power = &power * &chain;
        let next = |j| predicted_mode_probability(&rows, &probabilities, j);
        probabilities = (0..3).map(next).collect();
        let expected = RowVector3::from(start.clone()) * &power;
        assert_eq!(probabilities, expected.iter().cloned().collect::<Vec<_>>());
        let sum = probabilities.iter().cloned().fold(q(0, 1), |sum, p| sum + p);
        assert_eq!(sum, q(1, 1));
    }

    for (name, scene) in all_scenes() {
        let scene = with_identical_modes(&scene);
        let run = scene.run();
        let allowed = rounding_of(&run);
        let mut expected = scene.initial.mode_probabilities.clone();
        for step in &run {
            expected = along_the_chain(&CHAIN.map(|row| row.to_vec()), &expected);
            for (probability, expected) in step.mode_probabilities.iter().zip(&expected) {
                assert!((probability - expected).abs() <= allowed, "{name}");
            }
        }
        // After thirty steps nearly nothing is left of the start: the chain's own distribution, by the transposed chain another.
        let transposed = transposed(&CHAIN.map(|row| row.to_vec()));
        let wrong = (0..30).fold(vec![0.625, 0.25, 0.125], |p, _| along_the_chain(&transposed, &p));
        assert!((wrong[0] - expected[0]).abs() > 0.05, "{wrong:?} {expected:?}");
    }
}

/// A step without a detection learns nothing: the probabilities follow the chain, and the estimates are the predicted ones, bit for
/// bit. What comes from a measurement is not there, also when it was a step before.
#[test]
fn steps_without_a_detection_predict_and_nothing_else() {
    for (name, scene) in all_scenes() {
        let run = scene.run();
        let missed: Vec<usize> = (1..run.len()).filter(|&k| run[k].measurement.is_none()).collect();
        assert_eq!(missed, [6, 14, 15, 16], "one alone, and three in a row");
        for k in missed {
            let (before, step) = (&run[k - 1], &run[k]);
            let chain = &scene.problem.chain;
            let expected = along_the_chain(chain, &before.mode_probabilities);
            assert_eq!(step.mode_probabilities, expected, "{name}");
            assert_eq!(step.predicted_mode_probabilities, expected, "{name}");
            assert_eq!(step.updated, step.predicted, "{name}");
            assert_eq!(step.combined, step.combined_prediction, "{name}");
            // Nothing was measured: its probability is one.
            assert_eq!(bits([&step.evidence, &step.log_evidence]), bits([&1.0, &0.0]), "{name}");
            let measured = [
                step.innovations.len(),
                step.predicted_measurements.len(),
                step.innovation_covariances.len(),
                step.cross_covariances.len(),
                step.gains.len(),
                step.log_likelihoods.len(),
                step.relative_likelihoods.len(),
                step.measured_points.len(),
                step.predicted_points.len(),
            ];
            assert_eq!(measured, [0; 9], "{name}");
            assert_eq!(
                (before.gains.len(), before.log_likelihoods.len()),
                if k > 14 && k < 17 { (0, 0) } else { (3, 3) }
            );
            // The points of the motion are those of every step.
            assert_eq!(step.propagated_points.len(), 3, "{name}");
        }
    }
}

/// The first step mixes like every other one: step 0 is an estimate after a measurement.
#[test]
fn the_first_step_mixes() {
    for (name, scene) in all_scenes() {
        let first = &scene.run()[0];
        let initial = &scene.initial;
        let predicted = along_the_chain(&scene.problem.chain, &initial.mode_probabilities);
        assert_eq!(first.predicted_mode_probabilities, predicted, "{name}");
        for j in 0..3 {
            for i in 0..3 {
                let joint = CHAIN[i][j] * initial.mode_probabilities[i];
                assert_eq!(
                    bits([&first.mixing_probabilities[j][i]]),
                    bits([&(joint / predicted[j])])
                );
            }
            let mean = mixture_mean(&first.mixing_probabilities[j], &initial.modes);
            let covariance = mixture_covariance(&first.mixing_probabilities[j], &initial.modes, &mean);
            let mixed = Gaussian { mean, covariance };
            assert_eq!(first.mixed[j], mixed, "{name}");
            // It is not the mode's own estimate.
            assert!(distance(&mixed, &initial.modes[j]) > 0.01, "{name}");
        }
    }
}

/// Where all rows of the chain are equal the mode before says nothing about the mode now, so all modes start from the same mixture. Rows
/// of powers of two scale exactly: bit for bit. Other rows round each weight once.
#[test]
fn equal_rows_give_every_mode_the_same_input() {
    for (name, scene) in all_scenes() {
        let with_row = |row: [f64; 3]| {
            let mut scene = scene.clone();
            scene.problem.chain = vec![row.to_vec(); 3];
            scene.run()
        };
        for step in with_row([0.5, 0.25, 0.25]) {
            assert_eq!(bits_of(&step.mixed[1]), bits_of(&step.mixed[0]), "{name}");
            assert_eq!(bits_of(&step.mixed[2]), bits_of(&step.mixed[0]), "{name}");
        }
        let run = with_row([0.7, 0.2, 0.1]);
        let allowed = rounding_of(&run);
        for step in &run {
            assert!(distance(&step.mixed[1], &step.mixed[0]) <= allowed, "{name}");
            assert!(distance(&step.mixed[2], &step.mixed[0]) <= allowed, "{name}");
        }
        // Other chains do not.
        assert!(distance(&scene.run()[5].mixed[1], &scene.run()[5].mixed[0]) > 0.01);
    }
}

/// Mode 3 can be reached from mode 2 alone, and mode 2 from mode 1; all probability starts on mode 1. So mode 3 is out of reach in step
/// 1, keeps its own estimate, and has no weight; from step 2 on it is reached, and then nothing of its own start is left, whatever
/// that was.
#[test]
fn a_mode_that_cannot_be_reached_keeps_its_own_estimate_and_no_weight() {
    for (name, mut scene) in all_scenes() {
        scene.problem.chain = vec![vec![0.75, 0.25, 0.0], vec![0.0, 0.5, 0.5], vec![0.0, 0.0, 1.0]];
        scene.initial.mode_probabilities = vec![1.0, 0.0, 0.0];
        let run = scene.run();

        let first = &run[0];
        assert_eq!(first.mixing_probabilities[2], [0.0, 0.0, 1.0], "{name}");
        assert_eq!(first.mixed[2], scene.initial.modes[2], "{name}");
        assert_eq!(first.predicted_mode_probabilities[2].to_bits(), 0);
        assert_eq!(first.mode_probabilities[2].to_bits(), 0);
        assert!(first.mode_probabilities[1] > 0.0, "{name}");
        // It is filtered all the same, and ready.
        assert!(first.updated[2].mean.iter().all(|entry| entry.is_finite()));

        let second = &run[1];
        assert_eq!(second.mixing_probabilities[2], [0.0, 1.0, 0.0], "{name}");
        assert_eq!(second.mixed[2], first.updated[1], "{name}");
        assert!(second.mode_probabilities[2] > 0.0, "{name}");

        // Its own start, and mode 2's, which nothing could come from, are without any effect on the answer.
        let mut elsewhere = scene.clone();
        for j in [1, 2] {
            elsewhere.initial.modes[j].mean = vector![-3e4, 1.0, 2e4, 50.0];
            elsewhere.initial.modes[j].covariance *= 4.0;
        }
        let other = elsewhere.run();
        assert_eq!(bits_of(&other[0].combined), bits_of(&first.combined), "{name}");
        for (a, b) in other.iter().zip(&run).skip(1) {
            assert_eq!(bits_of(&a.combined), bits_of(&b.combined), "{name}");
            assert_eq!(a.mode_probabilities, b.mode_probabilities, "{name}");
        }
    }
}

// Bayes' rule

/// A measurement forty and more standard deviations away: every likelihood is zero as a double, and the ratios of the probabilities are
/// what they were.
#[test]
fn likelihoods_that_underflow_a_double_leave_the_probabilities_right() {
    for (name, scene) in all_scenes() {
        let mut filter = scene.filter().unwrap();
        filter.step(scene.measurements[0].as_ref()).unwrap();
        let mut z = scene.measurements[1].unwrap();
        z[0] += 1e4;
        let step = filter.step(Some(&z)).unwrap();
        let logs = &step.log_likelihoods;
        for j in 0..3 {
            assert_eq!(logs[j].exp().to_bits(), 0, "{name}: {}", logs[j]);
            assert!(step.mode_probabilities[j].is_finite());
        }
        // The logarithm of the sum of Lⱼ cⱼ is off by some roundings of a number below |ln L|.
        let size = logs.iter().map(|log| log.abs()).fold(0.0, f64::max);
        let allowed = 8.0 * ROUNDOFF * size;
        let sum: f64 = step.mode_probabilities.iter().sum();
        // Relative likelihoods: the sum owes nothing to the size of the logarithms.
        assert!((sum - 1.0).abs() <= 8.0 * ROUNDOFF, "{name}: {sum}");
        for j in 1..3 {
            let ratio = step.mode_probabilities[j] / step.mode_probabilities[0];
            let prior = &step.predicted_mode_probabilities;
            let expected = (logs[j] - logs[0]).exp() * prior[j] / prior[0];
            assert!((ratio / expected - 1.0).abs() <= allowed, "{name}: {ratio} {expected}");
        }
        // The same from likelihoods as doubles has no answer: 0/0.
        let likelihoods: Vec<f64> = logs.iter().map(|log| log.exp()).collect();
        let naive = likelihoods[0] / likelihoods.iter().sum::<f64>();
        assert!(naive.is_nan());
    }
}

/// The farther off the outlier is the coarser are the logarithms of its likelihoods: ln L is rounded by u·|ln L|, up to 2·10¹⁰ for a
/// measurement 10⁷ m off. The probabilities still sum to one, and with identical modes each stays at its prior up to that rounding:
/// they depend on differences of the logarithms.
#[test]
fn an_outlier_costs_the_digits_of_its_log_likelihood_and_no_more() {
    for (name, scene) in all_scenes() {
        let scene = with_identical_modes(&scene);
        for offset in [1e3, 1e4, 1e5, 1e6, 1e7] {
            let mut z = scene.measurements[0].unwrap();
            z[0] += offset;
            let mut filter = scene.filter().unwrap();
            let step = filter.step(Some(&z)).unwrap();
            let size = step.log_likelihoods[0].abs();
            let sum: f64 = step.mode_probabilities.iter().sum();
            assert!((sum - 1.0).abs() <= 8.0 * ROUNDOFF, "{name}: {sum}");
            assert!(step.mode_probabilities.iter().all(|p| (0.0..=1.0).contains(p)));
            for (posterior, prior) in step.mode_probabilities.iter().zip(&step.predicted_mode_probabilities) {
                assert!(
                    (posterior / prior - 1.0).abs() <= 100.0 * ROUNDOFF * size,
                    "{name} {offset}: {posterior} {prior}"
                );
            }
        }
    }
}

/// The likelihood of the measurement under all modes together is Σ Lⱼ cⱼ. Where no likelihood underflows it can be computed as it
/// stands: a few roundings of logarithms below 100.
#[test]
fn the_log_evidence_is_the_logarithm_of_the_total_probability_of_the_measurement() {
    for (name, scene) in all_scenes() {
        for step in scene.run().iter().skip(1).filter(|step| step.measurement.is_some()) {
            let terms = step.log_likelihoods.iter().zip(&step.predicted_mode_probabilities);
            let total: f64 = terms.map(|(log, c)| log.exp() * c).sum();
            let distance = (step.log_evidence - total.ln()).abs();
            assert!(distance <= 8.0 * 100.0 * ROUNDOFF, "{name} {}: {distance}", step.step);
        }
    }
}

/// The stand-in for OMTM-IMM gives all modes the same input, mixed with diagonal weights, and only its mixing differs from the cycle.
#[test]
fn the_stand_in_mixes_with_diagonal_weights_and_changes_nothing_else() {
    let mut scene = linear_scene();
    scene.equations = diagonal_mixing::equations();
    let mut filter = scene.filter().unwrap();
    let z = scene.measurements[0].unwrap();
    let step = filter.step(Some(&z)).unwrap();
    let mean = diagonal_mixing::mixed_mean(&scene.initial.modes);
    let covariance = diagonal_mixing::mixed_covariance(&scene.initial.modes, &mean);
    for j in 0..3 {
        assert_eq!(step.mixed[j].mean, mean);
        assert_eq!(step.mixed[j].covariance, covariance);
    }
    let by_the_chain = linear_scene().filter().unwrap().step(Some(&z)).unwrap().clone();
    assert_ne!(step.mixed[0].mean, by_the_chain.mixed[0].mean);
    assert_eq!(step.mixing_probabilities, by_the_chain.mixing_probabilities);
    assert_eq!(
        step.predicted_mode_probabilities,
        by_the_chain.predicted_mode_probabilities
    );
}

/// A constant common to all modes cancels: units, or a forgotten 2π. Adding 64 to logarithms of about 10 rounds each once, by 64u.
#[test]
fn a_factor_common_to_all_likelihoods_changes_no_probability() {
    for (name, scene) in all_scenes() {
        let run = scene.run();
        let mut scaled = scene.clone();
        scaled.equations.log_likelihood =
            |_, _, now, j| log_density(&now.innovations[j], &ldl(&now.innovation_covariances[j])) + 64.0;
        let scaled = scaled.run();
        let allowed = rounding_of(&run);
        assert!(distance_of_runs(&scaled, &run) <= allowed, "{name}");
        let evidence = scaled[0].log_evidence - run[0].log_evidence;
        assert!((evidence - 64.0).abs() <= 8.0 * 64.0 * ROUNDOFF, "{name}");
        // A factor that differs between modes does not cancel.
        let mut unequal = scene.clone();
        unequal.equations.log_likelihood = |_, _, now, j| {
            let factor = if j == 0 { 1.0 } else { 0.0 };
            log_density(&now.innovations[j], &ldl(&now.innovation_covariances[j])) + factor
        };
        assert!(distance_of_runs(&unequal.run(), &run) > 0.01, "{name}");
    }
}

/// All that are called probabilities are: not negative, and one together. Mixing and mode probabilities are quotients by their own sum,
/// which a few roundings keep from one; predicted ones inherit that.
#[test]
fn probabilities_sum_to_one() {
    for (name, scene) in all_scenes() {
        for step in scene.run() {
            let modes = [&step.predicted_mode_probabilities, &step.mode_probabilities];
            for probabilities in step.mixing_probabilities.iter().chain(modes) {
                let sum: f64 = probabilities.iter().sum();
                assert!((sum - 1.0).abs() <= 16.0 * ROUNDOFF, "{name}: {sum}");
                assert!(probabilities.iter().all(|p| (0.0..=1.0).contains(p)), "{name}");
            }
        }
    }
}

// Moments

/// What is output before the measurement is the mixture of the predictions under the predicted mode probabilities; the probabilities of
/// the step before, or after the measurement, give something else.
#[test]
fn the_combined_prediction_is_weighted_with_the_predicted_mode_probabilities() {
    for (name, scene) in all_scenes() {
        let mut before = scene.initial.mode_probabilities.clone();
        let mut is_different = [false, false];
        for step in scene.run() {
            let mixture = |weights: &[f64]| {
                let mut mean = Vector4::zeros();
                for j in 0..3 {
                    mean += step.predicted[j].mean * weights[j];
                }
                let mut covariance = Matrix4::zeros();
                for j in 0..3 {
                    let away = step.predicted[j].mean - mean;
                    covariance += (step.predicted[j].covariance + away * away.transpose()) * weights[j];
                }
                Gaussian { mean, covariance }
            };
            let expected = mixture(&step.predicted_mode_probabilities);
            assert_eq!(step.combined_prediction, expected, "{name}");
            is_different[0] |= distance(&mixture(&before), &expected) > 1e-3;
            is_different[1] |= distance(&mixture(&step.mode_probabilities), &expected) > 1e-3;
            before.clone_from(&step.mode_probabilities);
        }
        assert_eq!(is_different, [true, true], "{name}");
    }
}

/// The spread of the modes' means is added to the mean of their covariances, and is positive semidefinite; it is what tells the user
/// that the modes disagree.
#[test]
fn the_combined_covariance_is_at_least_the_mean_of_the_covariances() {
    for (name, scene) in all_scenes() {
        let mut greatest_spread = 0.0_f64;
        for step in scene.run() {
            let mut within = Matrix4::zeros();
            for j in 0..3 {
                within += step.updated[j].covariance * step.mode_probabilities[j];
            }
            let spread = step.combined.covariance - within;
            // The difference of two nearly equal matrices carries their rounding: ten roundings of the diagonal.
            let rounding = step.combined.covariance.diagonal() * (10.0 * 16.0 * ROUNDOFF);
            let symmetric = (spread + spread.transpose()) * 0.5;
            let lifted = symmetric + Matrix4::from_diagonal(&rounding);
            assert!(is_positive_semidefinite(&lifted), "{name}: {spread}");
            greatest_spread = greatest_spread.max(spread[(0, 0)] / step.combined.covariance[(0, 0)]);
        }
        assert!(greatest_spread > 0.01, "{name}: the modes never disagree");
    }
}

/// Every covariance of a step is symmetric to the last bit.
#[test]
fn covariances_stay_symmetric_to_the_last_bit() {
    for (name, scene) in all_scenes() {
        for step in scene.run() {
            for j in 0..3 {
                for estimate in [&step.mixed[j], &step.predicted[j], &step.updated[j]] {
                    assert!(is_symmetric(&estimate.covariance), "{name}, step {}", step.step);
                }
                let is_measured = step.measurement.is_some();
                assert!(!is_measured || is_symmetric(&step.innovation_covariances[j]), "{name}");
            }
            assert!(is_symmetric(&step.combined_prediction.covariance), "{name}");
            assert!(is_symmetric(&step.combined.covariance), "{name}");
        }
    }
}

/// The combined estimates are for output: no filter ever starts from them.
#[test]
fn the_combined_estimate_is_output_only() {
    for (name, scene) in all_scenes() {
        let mut other = scene.clone();
        other.equations.combined_mean = |_, _, _, _| vector![1.0, 2.0, 3.0, 4.0];
        other.equations.combined_covariance = |_, _, _, _| Matrix4::zeros();
        other.equations.combined_prediction_mean = |_, _, _, _| vector![4.0, 3.0, 2.0, 1.0];
        other.equations.combined_prediction_covariance = |_, _, _, _| Matrix4::zeros();
        for (a, b) in other.run().iter().zip(&scene.run()) {
            for j in 0..3 {
                assert_eq!(bits_of_mode(a, j), bits_of_mode(b, j), "{name}");
            }
            assert_eq!(a.mode_probabilities, b.mode_probabilities, "{name}");
        }
    }
}

/// Step 0 is the initial estimate, and its combination the mixture of it.
#[test]
fn step_zero_is_the_initial_estimate() {
    for (name, scene) in all_scenes() {
        let filter = scene.filter().unwrap();
        let (zero, initial) = (filter.current(), &scene.initial);
        assert_eq!((zero.step, zero.measurement), (0, None));
        assert_eq!(zero.updated, initial.modes, "{name}");
        assert_eq!(zero.mode_probabilities, initial.mode_probabilities);
        let mean = mixture_mean(&initial.mode_probabilities, &initial.modes);
        let covariance = mixture_covariance(&initial.mode_probabilities, &initial.modes, &mean);
        assert_eq!(zero.combined, Gaussian { mean, covariance }, "{name}");
    }
}

// Symmetries

/// To list the modes in another order is to list the answers in that order. Two sums of three numbers agree to the last bit when the
/// first two are exchanged, and to a rounding otherwise.
#[test]
fn permuting_the_modes_permutes_the_answer() {
    for (name, scene) in all_scenes() {
        let run = scene.run();
        for order in [[1, 0, 2], [1, 2, 0], [2, 1, 0], [0, 2, 1], [2, 0, 1]] {
            let permuted = with_modes(&scene, &order).run();
            let is_exchange_of_the_first_two = order == [1, 0, 2];
            let allowed = rounding_of(&run);
            for (a, b) in permuted.iter().zip(&run) {
                for (place, &j) in order.iter().enumerate() {
                    if is_exchange_of_the_first_two {
                        assert_eq!(bits_of_mode(a, place), bits_of_mode(b, j), "{name}");
                    }
                    let (a, b) = (
                        (&a.updated[place], a.mode_probabilities[place]),
                        (&b.updated[j], b.mode_probabilities[j]),
                    );
                    assert!(distance(a.0, b.0) <= allowed, "{name}");
                    assert!((a.1 - b.1).abs() <= allowed, "{name}");
                }
                assert!(distance(&a.combined, &b.combined) <= allowed, "{name}");
            }
        }
        // To permute the modes and not the chain is another problem.
        let mut wrong = with_modes(&scene, &[1, 2, 0]);
        wrong.problem.chain.clone_from(&scene.problem.chain);
        let (wrong, right) = (&wrong.run()[29], &run[29]);
        assert!(distance(&wrong.combined, &right.combined) > 0.01, "{name}");
    }
}

/// In the mirror (y → −y) a left turn is a right turn, a bearing has the other sign, and so has all that follows. Signs round nothing:
/// with the rule's points mirrored too, both runs agree to the last bit. Rules that are their own mirror image need no mirror, but
/// add in another order. The simplex has no such symmetry: what it leaves out of a range-bearing measurement differs.
#[test]
fn mirroring_the_scene_mirrors_the_answer() {
    // The motion first.
    let mirrored_turn = MIRROR() * coordinated_turn(&TURN_RATE, &1.0) * MIRROR();
    assert_eq!(mirrored_turn, coordinated_turn(&-TURN_RATE, &1.0));

    for (name, scene) in all_scenes() {
        let run = scene.run();
        let mut in_the_mirror = mirrored(&scene);
        let filters = in_the_mirror.problem.filters.iter_mut();
        for rule in filters.flat_map(|filter| filter.rules_mut()).flatten() {
            for point in &mut rule.points {
                *point = MIRROR() * *point;
            }
        }
        for (a, b) in in_the_mirror.run().iter().zip(&run) {
            for j in 0..3 {
                assert_eq!(mirror_image(&a.mixed[j]), b.mixed[j], "{name}");
                assert_eq!(mirror_image(&a.predicted[j]), b.predicted[j], "{name}");
                assert_eq!(mirror_image(&a.updated[j]), b.updated[j], "{name}");
            }
            assert_eq!(mirror_image(&a.combined), b.combined, "{name}");
            assert_eq!(a.mode_probabilities, b.mode_probabilities, "{name}");
        }

        // With the rule as it is.
        let mut apart = 0.0_f64;
        for (a, b) in mirrored(&scene).run().iter().zip(&run) {
            apart = apart.max(distance(&mirror_image(&a.combined), &b.combined));
        }
        if name == "polar, simplex-5" {
            assert!(apart > rounding_of(&run), "{name}: {apart}");
        } else {
            assert!(apart <= rounding_of(&run), "{name}: {apart}");
        }

        // A mirrored scene with the turns as they were is another scene.
        let mut wrong = mirrored(&scene);
        wrong.problem.modes.clone_from(&scene.problem.modes);
        let image = mirror_image(&wrong.run()[20].combined);
        assert!(distance(&image, &run[20].combined) > 0.01, "{name}");
    }
}

/// A scene is turned by half a turn, so that its bearings cross ±π where they crossed 0, and the answer turns with it. Every rule here is
/// its own image under ξ → −ξ. The angle π is rounded, by u·π; in deviations of the bearing that is less than the rounding of the
/// position.
///
/// The sensor stands at several places, so that the target crosses the cut at several times.
#[test]
fn the_answer_does_not_depend_on_where_the_bearing_is_cut() {
    for rule in RULES {
        let mut is_caught = [false; 3];
        for north in [1800.0, 2200.0, 2600.0, 3000.0, 3100.0, 3200.0, 3400.0] {
            let scene = polar_scene_seen_from([0.0, north], rule);
            let run = scene.run();
            let mut turned = scene.clone();
            turned.problem.sensor = common::range_bearing_from([0.0, -north]);
            for estimate in &mut turned.initial.modes {
                estimate.mean = -estimate.mean;
            }
            for z in turned.measurements.iter_mut().flatten() {
                z[1] = wrap(z[1] + PI);
            }
            // The scene is worth its name: the bearings lie on both sides of the cut.
            let bearings: Vec<f64> = turned.measurements.iter().flatten().map(|z| z[1]).collect();
            assert!(bearings.iter().any(|&bearing| bearing > 3.0));
            assert!(bearings.iter().any(|&bearing| bearing < -3.0));

            let allowed = rounding_of(&run);
            let apart = |scene: &Scene| match scene.try_run() {
                Ok(answer) => distance_of_runs(&turned_back(&answer), &run),
                Err(_) => f64::INFINITY,
            };
            assert!(apart(&turned) <= allowed, "{rule}: {}", apart(&turned));

            // A bearing that is given a turn away is the same bearing.
            let mut a_turn_away = turned.clone();
            for z in a_turn_away.measurements.iter_mut().flatten() {
                z[1] += if z[1] < 0.0 { 2.0 * PI } else { -2.0 * PI };
            }
            assert!(apart(&a_turn_away) <= allowed, "{rule}: {}", apart(&a_turn_away));

            // Without wrapping the innovation, the points' mean or the points' differences it is another answer, at one of the
            // crossings at least.
            let mut without_wrap = [turned.clone(), turned.clone(), turned.clone()];
            without_wrap[0].equations.innovation = |_, z, now, j| z - now.predicted_measurements[j];
            without_wrap[1].equations.predicted_measurement = |problem, _, now, j| {
                let [_, rule] = problem.filter(j).rules();
                cubature::weighted_mean(&rule.unwrap().weights, &now.measured_points[j])
            };
            without_wrap[2].equations = Equations::standard().with_raw_moments();
            for (caught, scene) in is_caught.iter_mut().zip(&without_wrap) {
                *caught |= apart(scene) > 0.01;
            }
        }
        assert_eq!(is_caught, [true; 3], "{rule}");
    }
}

/// Metres or units of 1024 metres: powers of two scale every number exactly. Only the logarithm of the likelihood, a density per square
/// metre, is another number and so rounded otherwise. It moves no probability if there is one mode; with three the
/// probabilities are off by a rounding.
#[test]
fn other_units_of_length_scale_the_answer() {
    for (name, scene) in all_scenes() {
        let scale = 1.0 / 1024.0;
        let alone = with_modes(&scene, &[1]);
        for (a, b) in in_units(&alone, scale).run().iter().zip(&alone.run()) {
            assert_eq!(a.mixed[0], scaled(&b.mixed[0], scale), "{name}");
            assert_eq!(a.predicted[0], scaled(&b.predicted[0], scale), "{name}");
            assert_eq!(a.updated[0], scaled(&b.updated[0], scale), "{name}");
            assert_eq!(a.combined, scaled(&b.combined, scale), "{name}");
        }
        let run = scene.run();
        let other = in_units(&scene, scale).run();
        // Up to the likelihood also three modes agree to the last bit.
        for j in 0..3 {
            assert_eq!(other[0].updated[j], scaled(&run[0].updated[j], scale), "{name}");
        }
        for (a, b) in other.iter().zip(&run) {
            let apart = distance(&scaled(&a.combined, 1.0 / scale), &b.combined);
            assert!(apart <= rounding_of(&run), "{name}: {apart}");
        }
        // A kilometre is not a power of two of metres, and differs by roundings.
        let kilometres = in_units(&scene, 1e-3).run();
        for (a, b) in kilometres.iter().zip(&run) {
            let apart = distance(&scaled(&a.combined, 1e3), &b.combined);
            assert!(apart <= rounding_of(&run), "{name}: {apart}");
        }
    }
}

// Linear problems

/// When motion and measurement are linear every rule of degree two has all moments right: each filter is the Kalman filter, up to
/// the rounding of a run.
#[test]
fn with_linear_models_every_rule_is_the_kalman_filter_along_a_whole_run() {
    let kalman = linear_scene().run();
    for rule in RULES {
        let run = linear_scene_with(rule).run();
        let apart = distance_of_runs(&run, &kalman);
        assert!(apart <= rounding_of(&kalman), "{rule}: {apart}");
    }
    // The rules with the weights that the papers print are another filter, or none.
    for rule in ["cubature-5-printed", "simplex-5-printed-11", "simplex-5-printed-16"] {
        match linear_scene_with(rule).try_run() {
            Ok(run) => assert!(distance_of_runs(&run, &kalman) > 0.01, "{rule}"),
            Err(failure) => assert!(failure.to_string().contains("not positive"), "{failure}"),
        }
    }
}

/// The moments about the origin are those about the mean in exact arithmetic. In doubles they cost the square of what the centred form
/// costs: |x|²/σ² roundings instead of |x|/σ.
#[test]
fn the_raw_form_is_the_centred_form_up_to_its_greater_rounding() {
    let kalman = linear_scene().run();
    for rule in RULES {
        let mut scene = linear_scene_with(rule);
        scene.equations = Equations::standard().with_raw_moments();
        let run = scene.run();
        let apart = distance_of_runs(&run, &kalman);
        let steps = run.len() as f64;
        let digits_lost = rounding_of(&kalman) / (1000.0 * steps * ROUNDOFF);
        assert!(
            apart <= 1000.0 * steps * digits_lost * digits_lost * ROUNDOFF,
            "{rule}: {apart}"
        );
    }
}

/// The raw form subtracts two numbers of size x² and leaves σ²: what it loses is x²/σ² roundings, no more and, at some entry of
/// some step, not much less. The centred form loses x/σ at most.
///
/// Upper bound: a sum of L products, each rounded three times, of size Σ|w| (|x| + ξσ)², and two differences. Lower bound: of the
/// thirty steps' sums at least one is off by an eighth of a rounding of x².
#[test]
fn the_raw_form_loses_the_digits_of_the_squared_position() {
    for rule in ["cubature-3", "cubature-5", "simplex-5"] {
        let mut losses = Vec::new();
        for position in [1e3, 1e4, 1e5, 1e6] {
            let deviation: f64 = 4.0;
            let (mut raw_error, mut centred_error) = (0.0_f64, 0.0_f64);
            for k in 0..30 {
                let root = Matrix4::from_diagonal(&vector![deviation, 1.0, deviation, 1.0]);
                let mean = vector![position + 7.3 * f64::from(k), -180.0, position / 3.0, 200.0];
                let rule = common::rule_of(rule);
                let points: Vec<_> = rule.points.iter().map(|xi| cubature::point(&root, xi, &mean)).collect();
                let about = cubature::weighted_mean(&rule.weights, &points);
                let noise = Matrix4::zeros();
                let raw = raw::raw_covariance(&rule.weights, &points, &about, &noise);
                let centred = cubature::weighted_covariance(&rule.weights, &points, &about, &noise);
                let variance = deviation * deviation;
                raw_error = raw_error.max((raw[(0, 0)] - variance).abs() / variance);
                centred_error = centred_error.max((centred[(0, 0)] - variance).abs() / variance);
            }
            let ratio = position / deviation;
            let terms = common::rule_of(rule).points.len() as f64 + 5.0;
            let (lower, upper) = (0.125 * ROUNDOFF * ratio * ratio, 2.0 * terms * ROUNDOFF * ratio * ratio);
            assert!(
                lower <= raw_error && raw_error <= upper,
                "{rule}: {raw_error} {lower} {upper}"
            );
            assert!(
                centred_error <= 2.0 * terms * ROUNDOFF * ratio,
                "{rule}: {centred_error}"
            );
            losses.push(raw_error);
        }
        // Ten times as far away is a hundred times as bad: six digits over three powers of ten, within a power of ten.
        let growth = losses[3] / losses[0];
        assert!((1e5..1e7).contains(&growth), "{rule}: {growth}");
    }
}

/// Far enough away nothing is left: the raw form's covariance is not positive definite and the step fails, with the value's name,
/// where the centred form goes on.
#[test]
fn the_raw_form_fails_where_the_centred_form_goes_on() {
    let far_away = |equations| {
        let mut scene = linear_scene_with("cubature-5");
        scene.equations = equations;
        let offset = vector![3e11, 0.0, 3e11, 0.0];
        for estimate in &mut scene.initial.modes {
            estimate.mean += offset;
        }
        for z in scene.measurements.iter_mut().flatten() {
            *z += vector![offset[0], offset[2]];
        }
        scene
    };
    assert!(far_away(Equations::standard()).try_run().is_ok());
    let failure = far_away(Equations::standard().with_raw_moments())
        .try_run()
        .unwrap_err();
    assert_eq!((failure.step, failure.value), (1, "predicted_measurement"));
    let cause = failure.cause.to_string();
    assert!(
        cause.starts_with("the predicted covariance is not positive definite"),
        "{cause}"
    );
}

// Failures

/// A step that fails leaves the filter where it was, and the next good measurement is filtered as if nothing had happened.
#[test]
fn a_failed_step_leaves_the_filter_at_the_step_before() {
    for (name, scene) in all_scenes() {
        let mut filter = scene.filter().unwrap();
        for (z, undisturbed) in scene.measurements.iter().zip(scene.run()) {
            let before = filter.current().clone();
            // One failure before anything is computed, and one after all modes are updated.
            for bad in [vector![f64::NAN, 0.0], vector![1e200, 1.0]] {
                assert!(filter.step(Some(&bad)).is_err(), "{name}");
                assert_eq!(filter.current().step, before.step);
                assert_eq!(bits_of_step(filter.current()), bits_of_step(&before), "{name}");
            }
            let step = filter.step(z.as_ref()).unwrap();
            assert_eq!(bits_of_step(step), bits_of_step(&undisturbed), "{name}");
        }
    }
}

/// A weight may be negative, and a weighted sum of squares then too. The unscented rule with κ = −5/2 has the weights −5/3 at its
/// centre and 1/3 at √(3/2) deviations along each axis; the two points a velocity stand where the centre does. Over the sensor, at a
/// deviation σ of each position, all ranges are 0 or r = √(3/2) σ, so ẑ = 4/3 r and
/// S = −1/3 (4/3 r)² + 4/3 (1/3 r)² + R = −2/3 σ² + R: negative for σ = 1 km and R = (40 m)².
///
/// With κ = −3/2 the innovation covariance is positive, and it takes two updates until an estimate's own covariance is not.
#[test]
fn negative_weights_can_leave_no_covariance_and_the_failure_names_it() {
    let failure = scene_over_the_sensor(unscented_of(-5)).try_run().unwrap_err();
    assert_eq!(
        failure.to_string(),
        "step 1, mode `constant velocity`, gain: the innovation covariance is not positive definite: pivot 1 of 2 is not positive"
    );
    let failure = scene_over_the_sensor(unscented_of(-3)).try_run().unwrap_err();
    assert_eq!(
        failure.to_string(),
        "step 3, mode `constant velocity`, predicted.mean: the mixed covariance is not positive definite: pivot 3 of 4 is not \
         positive"
    );
    // Rules whose weights at the positions are positive go through; κ = 3 − n is among them, with its −1/3 at the centre.
    for rule in RULES {
        assert!(scene_over_the_sensor(common::rule_of(rule)).try_run().is_ok(), "{rule}");
    }
}

// Filters with fixed gains

/// Read without mixed states, each mode is its filter alone, bit for bit, whatever is measured and whatever the others are.
#[test]
fn unmixed_modes_with_fixed_gains_stand_alone() {
    let mut scene = fixed_gain_scene();
    scene.problem.interaction = Interaction::Unmixed;
    let run = scene.run();
    for j in 0..3 {
        let alone = fixed_gain_run(&scene, j);
        for (step, alone) in run.iter().zip(&alone) {
            assert_eq!(bits(&step.updated[j].mean), bits(alone), "mode {j}, step {}", step.step);
        }
    }
    // With other modes beside it, another chain and other likelihoods, the first mode does the same.
    let mut other = scene.clone();
    other.problem.chain = CHAIN.iter().rev().map(|row| row.to_vec()).collect();
    for given in other.problem.filters[1..].iter_mut().map(given_mut) {
        given.gain *= 0.5;
        given.innovation_covariance *= 3.0;
    }
    other.initial.modes[2].mean *= 1.5;
    for (a, b) in run.iter().zip(&other.run()) {
        assert_eq!(bits(&a.updated[0].mean), bits(&b.updated[0].mean));
        assert_ne!(a.mode_probabilities, b.mode_probabilities);
    }
    // The other reading does not stand alone.
    scene.problem.interaction = Interaction::Imm;
    assert_ne!(scene.run()[0].updated[0].mean, run[0].updated[0].mean);
}

/// Where no mode is left for another the two readings are one, bit for bit.
#[test]
fn the_two_readings_of_fixed_gains_agree_under_the_identity_transition() {
    let mut scene = fixed_gain_scene();
    scene.problem.chain = identity_chain(3);
    let mixed = scene.run();
    scene.problem.interaction = Interaction::Unmixed;
    for (a, b) in mixed.iter().zip(&scene.run()) {
        assert_eq!(bits_of_step(a), bits_of_step(b), "step {}", a.step);
    }
}

/// Modes with the same motion, gain and innovation covariance are one filter along a whole run, for any chain; exactly so in `exact.rs`.
#[test]
fn identical_modes_with_fixed_gains_are_one_filter_for_any_transition_matrix() {
    let cyclic = vec![vec![0.0, 1.0, 0.0], vec![0.0, 0.0, 1.0], vec![1.0, 0.0, 0.0]];
    for chain in [CHAIN.map(|row| row.to_vec()).to_vec(), cyclic] {
        let mut scene = with_identical_modes(&fixed_gain_scene());
        // One for all.
        scene.problem.filters.truncate(1);
        scene.problem.chain = chain;
        for (step, alone) in scene.run().iter().zip(&fixed_gain_run(&scene, 0)) {
            // Each step rounds an entry fewer than a hundred times, and the gains forget what was.
            let allowed = 100.0 * 30.0 * ROUNDOFF * alone.amax();
            assert!((step.combined.mean - alone).amax() <= allowed, "step {}", step.step);
        }
    }
}

/// What a filter with fixed gains does not compute is undecided in its record, and what it is given is there where it is used.
#[test]
fn a_filter_with_fixed_gains_has_no_covariance_in_its_record() {
    let scene = fixed_gain_scene();
    let zero = scene.filter().unwrap();
    for step in std::iter::once(zero.current()).chain(&scene.run()) {
        let modes = step.mixed.iter().chain(&step.predicted).chain(&step.updated);
        for estimate in modes.chain([&step.combined_prediction, &step.combined]) {
            assert!(
                estimate.covariance.iter().all(|entry| entry.is_nan()),
                "step {}",
                step.step
            );
        }
        assert!(step.combined.mean.iter().all(|entry| entry.is_finite()));
        for j in (0..3).filter(|_| step.step > 0) {
            let is_used = step.measurement.is_some();
            let given = given(&scene.problem.filters[j]);
            assert_eq!(step.gains.get(j), is_used.then_some(&given.gain), "step {}", step.step);
            let covariance = is_used.then_some(&given.innovation_covariance);
            assert_eq!(step.innovation_covariances.get(j), covariance, "step {}", step.step);
        }
        assert!(step.cross_covariances.is_empty(), "step {}", step.step);
    }
}

/// The means of mode j's filter by itself.
fn fixed_gain_run(scene: &Scene, j: usize) -> Vec<Vector4<f64>> {
    let (h, mode) = (scene.problem.h().into_owned(), &scene.problem.modes[j]);
    let gain = given(scene.problem.filter(j)).gain;
    let mut mean = scene.initial.modes[j].mean;
    let step = |z: &Option<Vector2<f64>>| {
        let predicted = mode.motion.of(&mean);
        mean = z.map_or(predicted, |z| predicted + gain * (z - h * predicted));
        mean
    };
    scene.measurements.iter().map(step).collect()
}

/// What a filter is given.
fn given(filter: &Filter<f64, U4, U2>) -> &FixedGain<f64, U4, U2> {
    let Update::Given(given) = &filter.update else {
        panic!("a filter with a given gain");
    };
    given
}

/// As [`given`], to be changed.
fn given_mut(filter: &mut Filter<f64, U4, U2>) -> &mut FixedGain<f64, U4, U2> {
    let Update::Given(given) = &mut filter.update else {
        panic!("a filter with a given gain");
    };
    given
}

// Other filters in other modes

/// A filter with points for one of its two transforms and matrices for the other, both ways, and one with points of two rules.
fn half_filters(rule: &str) -> [Filter<f64, U4, U2>; 5] {
    let points = |name: &str| Transform::Points(rule_of(name));
    let filter = |predict, update| Filter {
        predict,
        update: Update::By(update),
        noise_cross_covariance: None,
    };
    [
        filter(Transform::Exact, points(rule)),
        filter(points(rule), Transform::Exact),
        filter(points(rule), points("cubature-3")),
        filter(Transform::Linearised, points(rule)),
        filter(points(rule), Transform::Linearised),
    ]
}

/// On a linear problem every transform has all moments right, so modes with different filters are modes with Kalman filters, up to the
/// rounding of a run.
#[test]
fn with_linear_models_modes_of_any_filters_are_kalman_filters() {
    let kalman = linear_scene().run();
    for rule in RULES {
        let [measured, moved, both, at_slopes, to_slopes] = half_filters(rule);
        for filters in [
            vec![measured.clone(), Filter::kalman(), Filter::kalman()],
            vec![Filter::kalman(), both, measured.clone()],
            vec![moved.clone(), measured, Filter::points(rule_of(rule))],
            vec![moved],
            vec![at_slopes, to_slopes, Filter::extended()],
        ] {
            let mut scene = linear_scene();
            scene.problem.filters = filters;
            let run = scene.run();
            let apart = distance_of_runs(&run, &kalman);
            assert!(apart <= rounding_of(&kalman), "{rule}: {apart}");
            // Points are there where they are drawn, and nowhere else.
            for step in &run {
                for j in 0..3 {
                    let [predict, update] = scene.problem.filter(j).rules();
                    let count = |rule: Option<&Rule<f64, U4>>| rule.map_or(0, |rule| rule.points.len());
                    assert_eq!(step.propagated_points[j].len(), count(predict), "{rule}, mode {j}");
                    let is_measured = step.measurement.is_some();
                    let measured_points = step.measured_points.get(j).map(Vec::len);
                    assert_eq!(
                        measured_points,
                        is_measured.then_some(count(update)),
                        "{rule}, mode {j}"
                    );
                }
            }
        }
    }
}

/// Matrices for the motion and points for the measurement are points for both: the motions are linear. Up to the rounding of a run.
#[test]
fn points_for_the_measurement_alone_are_points_for_both() {
    for rule in RULES {
        let scene = polar_scene(rule);
        let run = scene.run();
        let mut other = scene.clone();
        let [measured, ..] = half_filters(rule);
        other.problem.filters = vec![measured.clone(), Filter::points(rule_of(rule)), measured];
        let apart = distance_of_runs(&other.run(), &run);
        assert!(apart <= rounding_of(&run), "{rule}: {apart}");
    }
}

/// Where no mode is left for another, each mode is its own filter and not its neighbour's, bit for bit; and in another order the answers
/// come in that order.
#[test]
fn each_mode_has_its_own_filter() {
    let [measured, moved, both, ..] = half_filters("simplex-5");
    let points = |rule| Filter::points(rule_of(rule));
    for (scene, filters) in [
        (linear_scene(), [Filter::kalman(), measured.clone(), both]),
        (linear_scene(), [moved, Filter::kalman(), points("unscented")]),
        (
            polar_scene("cubature-5"),
            [points("cubature-3"), measured, points("cubature-5")],
        ),
    ] {
        let mut scene = scene;
        scene.problem.filters = filters.to_vec();
        let run = scene.run();
        for (a, b) in with_modes(&scene, &[1, 0, 2]).run().iter().zip(&run) {
            for (place, j) in [1, 0, 2].into_iter().enumerate() {
                assert_eq!(bits_of_mode(a, place), bits_of_mode(b, j));
            }
        }
        scene.problem.chain = identity_chain(3);
        let run = scene.run();
        for j in 0..3 {
            for (step, plain) in run.iter().zip(&plain_run(&scene, j)) {
                assert_eq!(
                    bits_of(&step.updated[j]),
                    bits_of(plain),
                    "mode {j}, step {}",
                    step.step
                );
            }
        }
    }
}

/// Read without mixed states the modes of every filter stand alone, bit for bit, for any chain.
#[test]
fn unmixed_modes_of_every_filter_stand_alone() {
    for (name, mut scene) in all_scenes() {
        scene.problem.interaction = Interaction::Unmixed;
        let run = scene.run();
        for j in 0..3 {
            for (step, plain) in run.iter().zip(&plain_run(&scene, j)) {
                assert_eq!(bits_of(&step.updated[j]), bits_of(plain), "{name}, mode {j}");
            }
        }
        // The probabilities follow the chain all the same.
        let first = along_the_chain(&scene.problem.chain, &scene.initial.mode_probabilities);
        assert_eq!(run[0].predicted_mode_probabilities, first, "{name}");
    }
}

// A problem that changes from step to step

/// Problems of one state and with other steps, noises, sensors, chains and filters, all of filters with covariances or all without.
fn changing_problems(scene: &Scene, filters: &[Vec<Filter<f64, U4, U2>>]) -> Vec<Problem<f64, U4, U2>> {
    let mut problems = Vec::new();
    for (k, filters) in filters.iter().cycle().take(30).enumerate() {
        let mut problem = scene.problem.clone();
        // Steps of ½, 1 and 2 s.
        let interval = [0.5, 1.0, 2.0][k % 3];
        let motions = [
            constant_velocity(&interval),
            coordinated_turn(&TURN_RATE, &interval),
            coordinated_turn(&-TURN_RATE, &interval),
        ];
        for (mode, motion) in problem.modes.iter_mut().zip(motions) {
            mode.motion = Motion::Linear(motion);
            mode.noise = integrated_noise(&1.0, &interval);
        }
        match &mut problem.sensor {
            Sensor::Linear(h) => h[(0, 1)] = [0.0, 0.25][k % 2],
            Sensor::Polar { location, .. } => *location = [[0.0, 0.0], [500.0, -2000.0]][k % 2],
            Sensor::Function { .. } => panic!("no scene of these has one"),
        }
        problem.measurement_noise *= [1.0, 2.0, 0.5, 4.0][k % 4];
        if k % 5 == 4 {
            problem.chain.reverse();
        }
        problem.filters.clone_from(filters);
        problem.interaction = if k % 7 == 6 {
            Interaction::Unmixed
        } else {
            Interaction::Imm
        };
        problems.push(problem);
    }
    problems
}

/// A filter that goes on with another problem is the filter of that problem, started from the estimates of the step before, bit for bit.
/// Steps without a detection are among them.
#[test]
fn a_problem_that_changes_is_a_new_filter_from_the_last_estimates() {
    let points = |rule| vec![Filter::points(rule_of(rule))];
    let [measured, moved, both, ..] = half_filters("cubature-5");
    let kalman = || Filter::kalman();
    let gains = fixed_gain_scene();
    let mut reversed = gains.problem.filters.clone();
    reversed.reverse();
    for (name, scene, filters) in [
        ("Kalman", linear_scene(), vec![vec![kalman()]]),
        (
            "linear",
            linear_scene(),
            vec![vec![kalman()], points("simplex-5"), vec![moved, kalman(), both]],
        ),
        (
            "polar",
            polar_scene("unscented"),
            vec![points("unscented"), points("cubature-3"), vec![measured]],
        ),
        (
            "converted",
            converted_scene(Conversion::Standard, [0.0, 0.0]),
            vec![
                vec![Filter::converted(Conversion::Standard)],
                points("cubature-5"),
                vec![Filter::converted(Conversion::ModifiedUnbiased)],
            ],
        ),
        (
            "given",
            gains.clone(),
            vec![
                gains.problem.filters.clone(),
                reversed,
                vec![gains.problem.filters[1].clone()],
            ],
        ),
    ] {
        let mut filter = scene.filter().unwrap();
        let (mut states, detected) = (truth().into_iter().skip(1), &scene.measurements);
        for (k, problem) in changing_problems(&scene, &filters).into_iter().enumerate() {
            let z = problem.sensor.of(&states.next().unwrap());
            let z = detected[k].map(|_| z + vector![10.0, 1e-3]);
            let last = filter.current();
            let mut initial = Initial {
                modes: last.updated.clone(),
                mode_probabilities: last.mode_probabilities.clone(),
            };
            if !problem.has_covariances() {
                for estimate in &mut initial.modes {
                    estimate.covariance.fill(0.0);
                }
            }
            let mut anew = Imm::with_equations(problem.clone(), scene.equations, &initial).unwrap();
            filter.change(problem).unwrap();
            let expected = anew.step(z.as_ref()).unwrap();
            let step = filter.step(z.as_ref()).unwrap();
            assert_eq!(bits_of_step(step), bits_of_step(expected), "{name}, step {}", step.step);
            assert_eq!((step.step, expected.step), (k + 1, 1));
        }
    }
}

/// To go on with the same problem is to go on.
#[test]
fn a_problem_that_changes_to_itself_changes_nothing() {
    for (name, scene) in all_scenes() {
        let mut filter = scene.filter().unwrap();
        for (z, expected) in scene.measurements.iter().zip(scene.run()) {
            filter.change(scene.problem.clone()).unwrap();
            assert_eq!(
                bits_of_step(filter.step(z.as_ref()).unwrap()),
                bits_of_step(&expected),
                "{name}"
            );
        }
    }
}

// Formulas

/// The scene of range and bearing with formulas in the places of its matrices and of its sensor, whose numbers they are given.
fn in_formulas(scene: &Scene) -> Scene {
    let mut other = scene.clone();
    let (names, entries) = (["x", "vx", "y", "vy"], ["a", "b", "c", "d", "e", "f", "g", "h"]);
    let moved = [
        ("x", "x + a*vx + b*vy"),
        ("vx", "c*vx + d*vy"),
        ("y", "e*vx + y + f*vy"),
        ("vy", "g*vx + h*vy"),
    ];
    let motion = Arc::new(Function::of_formulas(&names, &entries, &[], &[], &moved).unwrap());
    for mode in &mut other.problem.modes {
        let f = mode.motion.matrix().into_owned();
        let given = (0..4).flat_map(|row| [f[(row, 1)], f[(row, 3)]]).collect();
        mode.motion = Motion::Function {
            function: motion.clone(),
            given,
        };
    }
    let seen = [("range", "sqrt(x*x + y*y)"), ("bearing", "atan2(y, x)")];
    other.problem.sensor = Sensor::Function {
        function: Function::of_formulas(&names, &[], &[], &[], &seen).unwrap().into(),
        space: Space::new(vec![Component::number("range", "m"), Component::angle("bearing")])
            .unwrap()
            .into(),
        given: vec![],
    };
    other
}

/// A motion and a sensor in formulas are the matrix and the sensor that they say, bit for bit: the sums are in the same order, and what a
/// matrix adds besides is zero.
#[test]
fn a_scene_in_formulas_is_the_scene_itself() {
    for rule in RULES {
        let scene = polar_scene(rule);
        for (a, b) in in_formulas(&scene).run().iter().zip(&scene.run()) {
            assert_eq!(bits_of_step(a), bits_of_step(b), "{rule}, step {}", a.step);
        }
    }
}

// Sides that are known at run time

/// A problem with sides in its types, to be run with sides that are known at run time, in numbers T.
struct AtRunTime<T> {
    /// The number of a double.
    number: fn(f64) -> T,
    /// The double that a number is.
    double: fn(&T) -> f64,
}

impl<T: number::Real> AtRunTime<T> {
    fn list(&self, numbers: &[f64]) -> Vec<T> {
        numbers.iter().map(|number| (self.number)(*number)).collect()
    }

    fn vector<const R: usize>(&self, vector: &SVector<f64, R>) -> DVector<T> {
        self.list(vector.as_slice()).into()
    }

    fn matrix<const R: usize, const C: usize>(&self, matrix: &SMatrix<f64, R, C>) -> DMatrix<T> {
        DMatrix::from_fn(R, C, |row, column| (self.number)(matrix[(row, column)]))
    }

    fn rule<const N: usize>(&self, rule: &Rule<f64, Const<N>>) -> Rule<T, Dyn> {
        Rule {
            points: rule.points.iter().map(|point| self.vector(point)).collect(),
            weights: self.list(&rule.weights),
            covariance_weights: self.list(&rule.covariance_weights),
        }
    }

    fn transform<const N: usize>(&self, transform: &Transform<f64, Const<N>>) -> Transform<T, Dyn> {
        match transform {
            Transform::Exact => Transform::Exact,
            Transform::Linearised => Transform::Linearised,
            Transform::Points(rule) => Transform::Points(self.rule(rule)),
        }
    }

    fn filter<const N: usize, const M: usize>(&self, filter: &Filter<f64, Const<N>, Const<M>>) -> Filter<T, Dyn, Dyn> {
        Filter {
            predict: self.transform(&filter.predict),
            update: match &filter.update {
                Update::By(update) => Update::By(self.transform(update)),
                Update::Iterated(times) => Update::Iterated(*times),
                Update::Converted(conversion) => Update::Converted(*conversion),
                Update::Given(given) => Update::Given(FixedGain {
                    gain: self.matrix(&given.gain),
                    innovation_covariance: self.matrix(&given.innovation_covariance),
                }),
            },
            noise_cross_covariance: filter
                .noise_cross_covariance
                .as_ref()
                .map(|of_noises| self.matrix(of_noises)),
        }
    }

    fn problem<const N: usize, const M: usize>(
        &self,
        problem: &Problem<f64, Const<N>, Const<M>>,
    ) -> Problem<T, Dyn, Dyn> {
        let mode = |mode: &Mode<f64, Const<N>>| Mode {
            name: mode.name.clone(),
            motion: match &mode.motion {
                Motion::Linear(matrix) => Motion::Linear(self.matrix(matrix)),
                Motion::Affine { matrix, offset } => Motion::Affine {
                    matrix: self.matrix(matrix),
                    offset: self.vector(offset),
                },
                Motion::Function { function, given } => Motion::Function {
                    function: function.clone(),
                    given: self.list(given),
                },
            },
            noise: self.matrix(&mode.noise),
        };
        Problem {
            modes: problem.modes.iter().map(mode).collect(),
            filters: problem.filters.iter().map(|filter| self.filter(filter)).collect(),
            interaction: match &problem.interaction {
                Interaction::Imm => Interaction::Imm,
                Interaction::Gpb1 => Interaction::Gpb1,
                Interaction::Unmixed => Interaction::Unmixed,
                Interaction::Converted(_) => unreachable!("no scene of this file has one"),
            },
            angles: problem.angles.clone(),
            chain: problem.chain.iter().map(|row| self.list(row)).collect(),
            sensor: match &problem.sensor {
                Sensor::Linear(h) => Sensor::Linear(self.matrix(h)),
                Sensor::Polar {
                    components,
                    position,
                    location,
                } => Sensor::Polar {
                    components: components.clone(),
                    position: *position,
                    location: location.map(self.number),
                },
                Sensor::Function { function, space, given } => Sensor::Function {
                    function: function.clone(),
                    space: space.clone(),
                    given: self.list(given),
                },
            },
            measurement_noise: self.matrix(&problem.measurement_noise),
        }
    }

    fn initial<const N: usize>(&self, initial: &Initial<f64, Const<N>>) -> Initial<T, Dyn> {
        let estimate = |estimate: &Gaussian<f64, Const<N>>| Gaussian {
            mean: self.vector(&estimate.mean),
            covariance: self.matrix(&estimate.covariance),
        };
        Initial {
            modes: initial.modes.iter().map(estimate).collect(),
            mode_probabilities: self.list(&initial.mode_probabilities),
        }
    }

    /// Runs a problem with sides in its types in doubles, and with sides that are known at run time: every value of every step has the same
    /// bits.
    fn assert_same_bits<const N: usize, const M: usize>(
        &self,
        name: &str,
        problem: &Problem<f64, Const<N>, Const<M>>,
        initial: &Initial<f64, Const<N>>,
        measurements: &[Option<SVector<f64, M>>],
    ) {
        let mut in_types = Imm::new(problem.clone(), initial).unwrap();
        let mut at_run_time = Imm::new(self.problem(problem), &self.initial(initial)).unwrap();
        let same = |a: &Step<f64, Const<N>, Const<M>>, b: &Step<T, Dyn, Dyn>| {
            assert_eq!(
                every_bit(a, |number| *number),
                every_bit(b, self.double),
                "{name}, step {}",
                a.step
            );
        };
        same(in_types.current(), at_run_time.current());
        for z in measurements {
            let carried = z.as_ref().map(|z| self.vector(z));
            same(
                in_types.step(z.as_ref()).unwrap(),
                at_run_time.step(carried.as_ref()).unwrap(),
            );
        }
    }
}

/// Doubles in random rounding: outside of a scope every operation gives what it gives in doubles.
const UNPERTURBED: AtRunTime<RandomRounding> = AtRunTime {
    number: RandomRounding::exact,
    double: |number| number.value(),
};

/// Doubles as they are.
const DOUBLES: AtRunTime<f64> = AtRunTime {
    number: |number| number,
    double: |number| *number,
};

/// Sides in types or known at run time are one text, and give the same bits: n = 4, every filter, in both numbers that are doubles.
#[test]
fn sides_known_at_run_time_give_the_same_bits_with_four_entries() {
    let mut scenes = all_scenes();
    scenes.push(("given".into(), fixed_gain_scene()));
    for conversion in Conversion::ALL {
        scenes.push((format!("{conversion:?}"), converted_scene(conversion, [300.0, -200.0])));
    }
    let mut of_many = polar_scene("cubature-3");
    let [measured, _, both, ..] = half_filters("simplex-5");
    of_many.problem.filters = vec![measured, Filter::converted(Conversion::Standard), both];
    scenes.push(("different filters".into(), of_many));
    let mut unmixed = linear_scene();
    unmixed.problem.interaction = Interaction::Unmixed;
    scenes.push(("unmixed".into(), unmixed));
    scenes.push(("formulas".into(), in_formulas(&polar_scene("cubature-5"))));
    for (name, scene) in scenes {
        let Scene {
            problem,
            initial,
            measurements,
            ..
        } = scene;
        UNPERTURBED.assert_same_bits(&name, &problem, &initial, &measurements);
        DOUBLES.assert_same_bits(&name, &problem, &initial, &measurements);
    }
}

/// The same with n = 8: position, velocity, acceleration and jerk along two axes. Products of this many columns are where a library of
/// matrices sums plain doubles in an order of its own, and so only random rounding has the same bits. The second mode lacks the jerk, and
/// knows it exactly.
#[test]
fn sides_known_at_run_time_give_the_same_bits_with_eight_entries() {
    let (modes, initial) = (jerking_modes(), jerking_initial());
    let polar = Sensor::Polar {
        components: vec![PolarComponent::Range, PolarComponent::Bearing],
        position: [0, 4],
        location: [-300.0, 200.0],
    };
    let of_entry = |entry: bool| f64::from(u8::from(entry));
    let h = SMatrix::<f64, 2, 8>::from_fn(|row, column| {
        of_entry(column == 4 * row) + 0.125 * of_entry(column == 4 * row + 1)
    });
    let points = |rule: RuleName| Filter::points(rule.rule().unwrap());
    for (name, sensor, filters) in [
        ("linear, Kalman", Sensor::Linear(h), vec![Filter::kalman()]),
        ("linear, points", Sensor::Linear(h), vec![points(RuleName::FifthDegree)]),
        (
            "polar, third and fifth degree",
            polar.clone(),
            vec![points(RuleName::ThirdDegree), points(RuleName::FifthDegree)],
        ),
        (
            "polar, simplex and unscented",
            polar.clone(),
            vec![points(RuleName::Simplex), points(RuleName::Unscented(None))],
        ),
        (
            "polar, converted",
            polar,
            vec![Filter::converted(Conversion::ModifiedUnbiased)],
        ),
    ] {
        let variances = match &sensor {
            Sensor::Linear(_) => vector![1600.0, 400.0],
            _ => vector![1600.0, 49e-6],
        };
        let measure = |state: &Vector4<f64>| {
            let state = SVector::<f64, 8>::from([state[0], state[1], 0.0, 0.0, state[2], state[3], 0.0, 0.0]);
            sensor.of(&state) + vector![11.7, 0.003]
        };
        let mut measurements: Vec<_> = truth().iter().skip(1).map(|state| Some(measure(state))).collect();
        measurements[7] = None;
        let problem = Problem {
            modes: modes.clone(),
            filters,
            interaction: Interaction::Imm,
            angles: vec![],
            chain: vec![vec![0.9, 0.1], vec![0.2, 0.8]],
            sensor,
            measurement_noise: SMatrix::from_diagonal(&variances),
        };
        UNPERTURBED.assert_same_bits(name, &problem, &initial, &measurements);
    }
}

/// Constant jerk along both axes, and constant acceleration, which lacks the jerk. Steps of a second.
fn jerking_modes() -> Vec<Mode<f64, U8>> {
    let axis = matrix![
        1.0, 1.0, 0.5, 1.0 / 6.0;
        0.0, 1.0, 1.0, 0.5;
        0.0, 0.0, 1.0, 1.0;
        0.0, 0.0, 0.0, 1.0];
    let input = vector![1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0];
    let without_jerk = |matrix: Matrix4<f64>| {
        let mut kept = matrix;
        kept.row_mut(3).fill(0.0);
        kept.column_mut(3).fill(0.0);
        kept
    };
    let on_both_axes = |x: Matrix4<f64>, y: Matrix4<f64>| {
        let mut both = SMatrix::<f64, 8, 8>::zeros();
        both.fixed_view_mut::<4, 4>(0, 0).copy_from(&x);
        both.fixed_view_mut::<4, 4>(4, 4).copy_from(&y);
        both
    };
    let noise = |variance: f64| input * input.transpose() * variance + Matrix4::identity() * (variance / 64.0);
    vec![
        Mode {
            name: "constant jerk".into(),
            motion: Motion::Linear(on_both_axes(axis, axis)),
            noise: on_both_axes(noise(0.3), noise(0.7)),
        },
        Mode {
            name: "constant acceleration".into(),
            motion: Motion::Linear(on_both_axes(without_jerk(axis), without_jerk(axis))),
            noise: on_both_axes(without_jerk(noise(0.1)), without_jerk(noise(0.2))),
        },
    ]
}

/// Two estimates of such a target with correlated entries; the second knows that there is no jerk.
fn jerking_initial() -> Initial<f64, U8> {
    let root = SMatrix::<f64, 8, 8>::from_fn(|row, column| {
        let size = [100.0, 10.0, 3.0, 1.0][row % 4];
        size * if row == column {
            1.0
        } else {
            0.1 / (1.0 + row as f64 + 2.0 * column as f64)
        }
    });
    let mut known = root;
    for entry in [3, 7] {
        known.row_mut(entry).fill(0.0);
    }
    let start = truth()[0];
    let mean = SVector::from([
        start[0] + 30.0,
        start[1],
        0.4,
        0.0,
        start[2] - 20.0,
        start[3],
        -0.3,
        0.0,
    ]);
    // A product with its own transpose is symmetric up to rounding; the lower triangle is taken for both.
    let covariance = |root: SMatrix<f64, 8, 8>| immaculate::matrix::mirrored(root * root.transpose());
    Initial {
        modes: vec![
            Gaussian {
                mean,
                covariance: covariance(root),
            },
            Gaussian {
                mean: mean.map(|entry| entry * 1.001),
                covariance: covariance(known),
            },
        ],
        mode_probabilities: vec![0.625, 0.375],
    }
}

// Helpers

/// x̂ → D x̂: y and ẏ change their signs.
#[allow(non_snake_case, reason = "a constant, but for nalgebra")]
fn MIRROR() -> Matrix4<f64> {
    Matrix4::from_diagonal(&vector![1.0, 1.0, -1.0, -1.0])
}

/// The estimate in the mirror.
fn mirror_image(estimate: &Gaussian<f64, U4>) -> Gaussian<f64, U4> {
    Gaussian {
        mean: MIRROR() * estimate.mean,
        covariance: MIRROR() * estimate.covariance * MIRROR(),
    }
}

/// The scene in the mirror, with the turns exchanged; the rule is as it was.
fn mirrored(scene: &Scene) -> Scene {
    let mut image = scene.clone();
    image.problem.modes[1] = mode("right turn", coordinated_turn(&-TURN_RATE, &1.0));
    image.problem.modes[2] = mode("left turn", coordinated_turn(&TURN_RATE, &1.0));
    for estimate in &mut image.initial.modes {
        *estimate = mirror_image(estimate);
    }
    // The second component is y or the bearing; noises are diagonal.
    for z in image.measurements.iter_mut().flatten() {
        z[1] = -z[1];
    }
    image
}

/// The steps of a run whose scene was turned by half a turn, turned back.
fn turned_back(run: &[Step<f64, U4, U2>]) -> Vec<Step<f64, U4, U2>> {
    let mut run = run.to_vec();
    for step in &mut run {
        let modes = step
            .mixed
            .iter_mut()
            .chain(&mut step.predicted)
            .chain(&mut step.updated);
        for estimate in modes.chain([&mut step.combined_prediction, &mut step.combined]) {
            estimate.mean = -estimate.mean;
        }
    }
    run
}

/// The scene in units of length that are `1/scale` metres.
fn in_units(scene: &Scene, scale: f64) -> Scene {
    let mut other = scene.clone();
    let lengths: [f64; 2] = match &mut other.problem.sensor {
        Sensor::Linear(_) => [scale, scale],
        Sensor::Polar { location, .. } => {
            *location = location.map(|coordinate| coordinate * scale);
            [scale, 1.0]
        }
        Sensor::Function { .. } => panic!("no scene of these has one"),
    };
    let lengths = Vector2::from(lengths);
    for mode in &mut other.problem.modes {
        mode.noise *= scale * scale;
    }
    other
        .problem
        .measurement_noise
        .component_mul_assign(&(lengths * lengths.transpose()));
    for estimate in &mut other.initial.modes {
        *estimate = scaled(estimate, scale);
    }
    for z in other.measurements.iter_mut().flatten() {
        z.component_mul_assign(&lengths);
    }
    other
}

/// The estimate in units of length that are `1/scale` of its own.
fn scaled(estimate: &Gaussian<f64, U4>, scale: f64) -> Gaussian<f64, U4> {
    Gaussian {
        mean: estimate.mean * scale,
        covariance: estimate.covariance * (scale * scale),
    }
}

/// The scene with these of its modes, in this order; the chain too, if all of them are there, else one that stays.
fn with_modes(scene: &Scene, order: &[usize]) -> Scene {
    let mut other = scene.clone();
    let pick = |j: &usize| scene.problem.modes[*j].clone();
    other.problem.modes = order.iter().map(pick).collect();
    other.initial.modes = order.iter().map(|&j| scene.initial.modes[j].clone()).collect();
    other.initial.mode_probabilities = vec![1.0];
    other.problem.chain = identity_chain(1);
    if scene.problem.filters.len() > 1 {
        other.problem.filters = order.iter().map(|&j| scene.problem.filters[j].clone()).collect();
    }
    if order.len() == scene.problem.modes.len() {
        let chain = &scene.problem.chain;
        let row = |&i: &usize| order.iter().map(|&j| chain[i][j]).collect();
        other.problem.chain = order.iter().map(row).collect();
        let probabilities = &scene.initial.mode_probabilities;
        other.initial.mode_probabilities = order.iter().map(|&j| probabilities[j]).collect();
    }
    other
}

/// The scene with the left turn instead of every mode, under the same names of places, and one start for all.
fn with_identical_modes(scene: &Scene) -> Scene {
    let mut other = scene.clone();
    for j in 0..3 {
        other.problem.modes[j] = scene.problem.modes[1].clone();
        other.initial.modes[j] = scene.initial.modes[1].clone();
    }
    other
}

/// The chain that never moves.
fn identity_chain(modes: usize) -> Vec<Vec<f64>> {
    let row = |i: usize| (0..modes).map(|j| f64::from(i == j)).collect();
    (0..modes).map(row).collect()
}

/// The probabilities one step later along the chain: πⱼ = Σᵢ πᵢ pᵢⱼ.
fn along_the_chain(chain: &[Vec<f64>], probabilities: &[f64]) -> Vec<f64> {
    let mut next = vec![0.0; probabilities.len()];
    for (row, probability) in chain.iter().zip(probabilities) {
        for (entry, transition) in next.iter_mut().zip(row) {
            *entry += probability * transition;
        }
    }
    next
}

/// The transposed matrix.
fn transposed(chain: &[Vec<f64>]) -> Vec<Vec<f64>> {
    (0..chain.len())
        .map(|j| chain.iter().map(|row| row[j]).collect())
        .collect()
}

/// All bits of a step.
fn bits_of_step(step: &Step<f64, U4, U2>) -> Vec<u64> {
    every_bit(step, |number| *number)
}

/// The bits of all values of a step, where `double` gives the double that a number is: those of the table, the points, the evidence.
fn every_bit<T: Field, N: Dim, M: Dim>(step: &Step<T, N, M>, double: impl Fn(&T) -> f64) -> Vec<u64>
where
    Shapes: Holds<N, M>,
{
    let mut numbers = vec![step.evidence.clone(), step.log_evidence.clone()];
    numbers.extend(step.relative_likelihoods.iter().cloned());
    for quantity in Quantity::ALL {
        let modes = if quantity.is_of_mode() { step.updated.len() } else { 1 };
        for j in 0..modes {
            // A value that is absent differs from one that is present: its shape is a number too.
            let values = step.values(quantity, j).unwrap_or_default();
            numbers.push(T::integer(i64::try_from(values.len()).unwrap()));
            numbers.extend(values);
        }
    }
    for points in [&step.mixed_points, &step.propagated_points, &step.predicted_points] {
        numbers.extend(points.iter().flatten().flat_map(|point| point.iter().cloned()));
    }
    numbers.extend(
        step.measured_points
            .iter()
            .flatten()
            .flat_map(|point| point.iter().cloned()),
    );
    let doubles: Vec<f64> = numbers.iter().map(double).collect();
    bits(&doubles)
}

/// The bits of all values of a step for one mode, of those that come from a measurement too where there is one.
fn bits_of_mode(step: &Step<f64, U4, U2>, j: usize) -> Vec<u64> {
    let mut all = Vec::new();
    for quantity in Quantity::ALL {
        // Mixing probabilities are read off the place of every other mode.
        if quantity.is_of_mode() && quantity != Quantity::MixingProbabilities {
            let values = step.values(quantity, j).unwrap_or_default();
            all.push(values.len() as u64);
            all.extend(bits(&values));
        }
    }
    all
}

/// The updated estimates of mode j's filter by itself: no mixing, no probabilities, written out from the filter's equations.
fn plain_run(scene: &Scene, j: usize) -> Vec<Gaussian<f64, U4>> {
    let problem = &scene.problem;
    let mode = &problem.modes[j];
    let mut estimate = scene.initial.modes[j].clone();
    let mut run = Vec::new();
    for z in &scene.measurements {
        let Gaussian { mean, covariance } = &estimate;
        let predicted = match &problem.filter(j).predict {
            Transform::Exact | Transform::Linearised => Gaussian {
                mean: kalman::predicted_mean(&mode.motion.matrix(), mean),
                covariance: kalman::predicted_covariance(&mode.motion.matrix(), covariance, &mode.noise),
            },
            Transform::Points(rule) => {
                let moved: Vec<_> = points_of(rule, &estimate)
                    .iter()
                    .map(|point| cubature::propagated_point(&mode.motion.matrix(), point))
                    .collect();
                let mean = cubature::weighted_mean(&rule.weights, &moved);
                let weights = &rule.covariance_weights;
                Gaussian {
                    mean,
                    covariance: cubature::weighted_covariance(weights, &moved, &mean, &mode.noise),
                }
            }
        };
        estimate = match z {
            None => predicted,
            Some(z) => plain_update(scene, j, &predicted, z),
        };
        run.push(estimate.clone());
    }
    run
}

/// One filter's update.
fn plain_update(scene: &Scene, j: usize, predicted: &Gaussian<f64, U4>, z: &Vector2<f64>) -> Gaussian<f64, U4> {
    let sensor = &scene.problem.sensor;
    let noise = &scene.problem.measurement_noise;
    let Update::By(transform) = &scene.problem.filter(j).update else {
        panic!("a filter that computes its gain from the measurement as it is");
    };
    let (expected, innovation_covariance, cross_covariance) = match transform {
        Transform::Exact | Transform::Linearised => {
            let h = measurement_jacobian(sensor, &predicted.mean);
            (
                sensor.of(&predicted.mean),
                kalman::innovation_covariance(&h, &predicted.covariance, noise),
                kalman::cross_covariance(&predicted.covariance, &h),
            )
        }
        Transform::Points(rule) => {
            let points = points_of(rule, predicted);
            let values: Vec<_> = points.iter().map(|point| sensor.of(point)).collect();
            let centre = sensor.of(&predicted.mean);
            let expected = sensor.mean(&rule.weights, &values, &centre);
            let weights = &rule.covariance_weights;
            let s = cubature::innovation_covariance(sensor, weights, &values, &expected, noise);
            let mean = &predicted.mean;
            let c = cubature::cross_covariance(sensor, weights, &points, mean, &values, &expected);
            (expected, s, c)
        }
    };
    let innovation = sensor.difference(z, &expected);
    let gain = update::gain(&cross_covariance, &ldl(&innovation_covariance));
    Gaussian {
        mean: update::updated_mean(&predicted.mean, &gain, &innovation),
        covariance: update::updated_covariance(&predicted.covariance, &gain, &innovation_covariance),
    }
}

/// The rule's points for an estimate.
fn points_of(rule: &Rule<f64, U4>, estimate: &Gaussian<f64, U4>) -> Vec<SVector<f64, 4>> {
    let root = cholesky(&estimate.covariance).expect("a covariance");
    let at = |xi| cubature::point(&root, xi, &estimate.mean);
    rule.points.iter().map(at).collect()
}
