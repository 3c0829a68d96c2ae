//! Goal: the filter of second order is Bayes' rule for all pairs of modes within a step, and the interacting filter exactly where that has
//! mixed nothing away.
//!
//! Method: whole runs in enclosures against one another, against single filters, and against the posterior of all pairs, written out;
//! one run in doubles to the last bit. Kind of evidence: enclosed.
#![allow(clippy::unwrap_used, reason = "in tests a panic is the failure")]

use immaculate::filter::Filter;
use immaculate::gaussian::{Gaussian, log_density, mixture_covariance, mixture_mean};
use immaculate::imm::state_conversion::{Reader, StateConversion, StateConversions};
use immaculate::imm::{Gpb2, Imm, Initial, Interaction, Problem};
use immaculate::matrix::ldl;
use immaculate::model::Sensor;
use immaculate::model::motion::{Mode, Motion};
use immaculate::number::{Enclosure, Field, Rational, Real};
use immaculate::rule::RuleName;
use nalgebra::{Matrix2, U1, U2, Vector1, matrix, vector};

/// The bits of enclosures: the runs here lose a few dozen.
const BITS: u32 = 200;

const LASTING: [[i64; 3]; 3] = [[18, 6, 0], [3, 15, 6], [8, 4, 12]];
const FORGETFUL: [[i64; 3]; 3] = [[12, 9, 3]; 3];
const ETERNAL: [[i64; 3]; 3] = [[24, 0, 0], [0, 24, 0], [0, 0, 24]];
const MEASURED: [Option<i64>; 4] = [Some(4), Some(-3), None, Some(7)];

type Scene<T> = (Problem<T, U2, U1>, Initial<T, U2>);

fn matrix_of<T: Field>(entries: [[i64; 2]; 2]) -> Matrix2<T> {
    Matrix2::from_fn(|row, column| T::integer(entries[row][column]))
}

/// Three modes that differ in everything, under a chain in parts of 24.
fn scene<T: Real>(chain: [[i64; 3]; 3]) -> Scene<T> {
    let mode = |name: &str, f, q| Mode {
        name: name.into(),
        motion: Motion::Linear(matrix_of(f)),
        noise: matrix_of(q),
    };
    let at = |x: i64, v: i64, covariance| Gaussian {
        mean: vector![T::ratio(x, 2), T::ratio(v, 4)],
        covariance: matrix_of(covariance),
    };
    let problem = Problem {
        modes: vec![
            mode("straight", [[1, 1], [0, 1]], [[2, 1], [1, 3]]),
            mode("turn", [[1, 2], [-1, 1]], [[3, -1], [-1, 1]]),
            mode("stay", [[1, 0], [0, 1]], [[9, 0], [0, 4]]),
        ],
        filters: vec![Filter::kalman()],
        interaction: Interaction::Imm,
        angles: vec![],
        chain: chain.map(|row| row.map(|p| T::ratio(p, 24)).to_vec()).to_vec(),
        sensor: Sensor::Linear(matrix![T::integer(2), T::integer(-1)]),
        measurement_noise: matrix![T::integer(3)],
    };
    let initial = Initial {
        modes: vec![
            at(1, 2, [[5, 1], [1, 4]]),
            at(-3, 1, [[3, -1], [-1, 2]]),
            at(2, -4, [[6, 2], [2, 5]]),
        ],
        mode_probabilities: vec![T::ratio(1, 2), T::ratio(1, 4), T::ratio(1, 4)],
    };
    (problem, initial)
}

/// One of the modes by itself.
fn alone<T: Real>((problem, initial): &Scene<T>, j: usize) -> Scene<T> {
    let mut one = problem.clone();
    one.modes = vec![problem.modes[j].clone()];
    one.chain = vec![vec![T::one()]];
    let initial = Initial {
        modes: vec![initial.modes[j].clone()],
        mode_probabilities: vec![T::one()],
    };
    (one, initial)
}

/// What a filter knows after a step: of the modes, and combined.
type Known<T> = (Vec<Gaussian<T, U2>>, Vec<T>, Gaussian<T, U2>);

fn second_order<T: Real>((problem, initial): &Scene<T>, measured: &[Option<i64>]) -> Vec<Known<T>> {
    let mut filter = Gpb2::new(problem.clone(), initial).unwrap();
    let step = |z: &Option<i64>| {
        filter.step(z.map(|z| Vector1::new(T::integer(z))).as_ref()).unwrap();
        let known = (filter.modes().to_vec(), filter.mode_probabilities().to_vec());
        (known.0, known.1, filter.combined().clone())
    };
    measured.iter().map(step).collect()
}

fn interacting<T: Real>((problem, initial): &Scene<T>, measured: &[Option<i64>]) -> Vec<Known<T>> {
    let mut filter = Imm::new(problem.clone(), initial).unwrap();
    let step = |z: &Option<i64>| {
        let step = filter.step(z.map(|z| Vector1::new(T::integer(z))).as_ref()).unwrap();
        (
            step.updated.clone(),
            step.mode_probabilities.clone(),
            step.combined.clone(),
        )
    };
    measured.iter().map(step).collect()
}

/// That two enclosures are of one number, as far as they know it.
fn is_one(a: &Enclosure, b: &Enclosure) -> bool {
    let difference = a.clone() - b.clone();
    difference.contains(&Rational::new(0, 1)) && difference.width() < 1e-20
}

fn is_one_estimate(a: &Gaussian<Enclosure, U2>, b: &Gaussian<Enclosure, U2>) -> bool {
    let means = a.mean.iter().zip(b.mean.iter());
    means
        .chain(a.covariance.iter().zip(b.covariance.iter()))
        .all(|(a, b)| is_one(a, b))
}

fn is_one_run(a: &[Known<Enclosure>], b: &[Known<Enclosure>]) -> bool {
    let is_one_step = |(a, b): (&Known<Enclosure>, &Known<Enclosure>)| {
        a.0.iter().zip(&b.0).all(|(a, b)| is_one_estimate(a, b))
            && a.1.iter().zip(&b.1).all(|(a, b)| is_one(a, b))
            && is_one_estimate(&a.2, &b.2)
    };
    a.len() == b.len() && a.iter().zip(b).all(is_one_step)
}

#[test]
fn a_mode_that_is_alone_is_its_filter_to_the_last_bit() {
    let one = alone(&scene::<f64>(LASTING), 1);
    assert_eq!(second_order(&one, &MEASURED), interacting(&one, &MEASURED));
}

#[test]
fn identical_modes_are_one_filter_and_their_probabilities_follow_the_chain() {
    Enclosure::with_precision(BITS, || {
        let mut same = scene::<Enclosure>(LASTING);
        same.0.modes = vec![same.0.modes[0].clone(); 3];
        same.1.modes = vec![same.1.modes[0].clone(); 3];
        let expected = interacting(&alone(&same, 0), &MEASURED);
        let mut probabilities = same.1.mode_probabilities.clone();
        for (found, expected) in second_order(&same, &MEASURED).iter().zip(&expected) {
            assert!(is_one_estimate(&found.2, &expected.2));
            let of_mode = |j: usize| {
                let parts = (0..3).map(|i| same.0.chain[i][j].clone() * probabilities[i].clone());
                parts.fold(Enclosure::integer(0), |sum, part| sum + part)
            };
            probabilities = (0..3).map(of_mode).collect();
            assert!(found.1.iter().zip(&probabilities).all(|(a, b)| is_one(a, b)));
        }
    });
}

#[test]
fn modes_that_never_change_are_the_static_bank() {
    Enclosure::with_precision(BITS, || {
        let bank = scene::<Enclosure>(ETERNAL);
        let found = second_order(&bank, &MEASURED);
        assert!(is_one_run(&found, &interacting(&bank, &MEASURED)));
        for j in 0..3 {
            for (found, alone) in found.iter().zip(interacting(&alone(&bank, j), &MEASURED)) {
                assert!(is_one_estimate(&found.0[j], &alone.2), "mode {j}");
            }
        }
    });
}

/// P(i, j ∣ z) is in proportion to μᵢ pᵢⱼ N(z; ẑⁱʲ, Sⁱʲ), and given both modes the state is the Kalman filter's.
#[test]
fn one_step_is_the_rule_of_bayes_for_all_pairs_of_modes() {
    Enclosure::with_precision(BITS, || {
        let scene = scene::<Enclosure>(LASTING);
        let (problem, initial) = &scene;
        let h = matrix![Enclosure::integer(2), Enclosure::integer(-1)];
        let pair = |i: usize, j: usize| {
            let Motion::Linear(f) = &problem.modes[j].motion else {
                panic!()
            };
            let mean = f * &initial.modes[i].mean;
            let covariance = f * &initial.modes[i].covariance * f.transpose() + &problem.modes[j].noise;
            let s = &h * &covariance * h.transpose() + &problem.measurement_noise;
            let innovation = Vector1::new(Enclosure::integer(4)) - &h * &mean;
            let gain = &covariance * h.transpose() / s[0].clone();
            let prior = initial.mode_probabilities[i].clone() * problem.chain[i][j].clone();
            let estimate = Gaussian {
                mean: mean + &gain * &innovation,
                covariance: &covariance - &gain * &h * &covariance,
            };
            (prior * log_density(&innovation, &ldl(&s)).exp(), estimate)
        };
        let merged = |parts: &[(Enclosure, Gaussian<Enclosure, U2>)]| {
            let total = parts
                .iter()
                .fold(Enclosure::integer(0), |sum, part| sum + part.0.clone());
            let weights: Vec<_> = parts.iter().map(|part| part.0.clone() / total.clone()).collect();
            let estimates: Vec<_> = parts.iter().map(|part| part.1.clone()).collect();
            let mean = mixture_mean(&weights, &estimates);
            let covariance = mixture_covariance(&weights, &estimates, &mean);
            (total, Gaussian { mean, covariance })
        };
        let modes: Vec<_> = (0..3).map(|j| merged(&[0, 1, 2].map(|i| pair(i, j)))).collect();
        let (total, combined) = merged(&modes);
        let found = second_order(&scene, &MEASURED[..1]).remove(0);
        let mixed = interacting(&scene, &MEASURED[..1]).remove(0);
        for (j, (weight, estimate)) in modes.iter().enumerate() {
            let probability = weight.clone() / total.clone();
            assert!(
                is_one(&found.1[j], &probability) && is_one_estimate(&found.0[j], estimate),
                "mode {j}"
            );
            // The interacting filter, which merged before it measured, has others.
            assert!(
                !is_one(&mixed.1[j], &probability) && !is_one_estimate(&mixed.0[j], estimate),
                "mode {j}"
            );
        }
        assert!(is_one_estimate(&found.2, &combined));
    });
}

/// A linear motion of a mixture is the mixture of the moved ones, so that nothing is lost by mixing first.
#[test]
fn without_a_detection_it_is_the_interacting_filter() {
    Enclosure::with_precision(BITS, || {
        let mut scene = scene::<Enclosure>(LASTING);
        let points = Filter::points(RuleName::ThirdDegree.rule().unwrap());
        for filters in [
            vec![Filter::kalman()],
            vec![points, Filter::extended(), Filter::kalman()],
        ] {
            scene.0.filters = filters;
            let found = second_order(&scene, &[None, None, None]);
            assert!(is_one_run(&found, &interacting(&scene, &[None, None, None])));
        }
        assert!(!is_one_run(
            &second_order(&scene, &[Some(1)]),
            &interacting(&scene, &[Some(1)])
        ));
    });
}

#[test]
fn where_the_chain_forgets_it_is_the_interacting_filter_only_if_estimates_are_equal() {
    Enclosure::with_precision(BITS, || {
        let mut scene = scene::<Enclosure>(FORGETFUL);
        let both = |scene: &Scene<Enclosure>| {
            is_one_run(
                &second_order(scene, &MEASURED[..1]),
                &interacting(scene, &MEASURED[..1]),
            )
        };
        assert!(!both(&scene));
        scene.1.modes = vec![scene.1.modes[0].clone(); 3];
        assert!(both(&scene));
        // With equal estimates it is so under any chain.
        scene.0.chain = self::scene::<Enclosure>(LASTING).0.chain;
        assert!(both(&scene));
    });
}

#[test]
fn permuting_the_modes_permutes_the_answer() {
    Enclosure::with_precision(BITS, || {
        let plain = scene::<Enclosure>(LASTING);
        let order = [2, 0, 1];
        let mut permuted = plain.clone();
        permuted.0.modes = order.map(|j| plain.0.modes[j].clone()).to_vec();
        permuted.0.chain = order
            .map(|i| order.map(|j| plain.0.chain[i][j].clone()).to_vec())
            .to_vec();
        permuted.1.modes = order.map(|j| plain.1.modes[j].clone()).to_vec();
        permuted.1.mode_probabilities = order.map(|j| plain.1.mode_probabilities[j].clone()).to_vec();
        let back = |step: Known<Enclosure>| {
            let place = |j: usize| order.iter().position(|&mode| mode == j).unwrap();
            let modes = (0..3).map(|j| step.0[place(j)].clone()).collect();
            (modes, (0..3).map(|j| step.1[place(j)].clone()).collect(), step.2)
        };
        let found: Vec<_> = second_order(&permuted, &MEASURED).into_iter().map(back).collect();
        assert!(is_one_run(&found, &second_order(&plain, &MEASURED)));
    });
}

/// The third mode counts in units half as large.
#[test]
fn one_problem_in_two_coordinate_systems_has_one_combined_estimate() {
    Enclosure::with_precision(BITS, || {
        let plain = scene::<Enclosure>(LASTING);
        let mut converted = plain.clone();
        let by = |factor: Enclosure, from, to| StateConversion {
            from,
            to,
            map: Motion::Linear(Matrix2::identity() * factor),
            added: Matrix2::zeros(),
        };
        let (double, half) = (|| Enclosure::integer(2), || Enclosure::ratio(1, 2));
        let list = vec![
            by(double(), 0, Reader::Mode(2)),
            by(double(), 1, Reader::Mode(2)),
            by(half(), 2, Reader::Mode(0)),
            by(half(), 2, Reader::Mode(1)),
            by(half(), 2, Reader::Common),
        ];
        let angles = vec![vec![], vec![], vec![]];
        converted.0.interaction = Interaction::Converted(StateConversions { list, angles });
        converted.0.modes[2].noise *= Enclosure::integer(4);
        converted.1.modes[2].mean *= double();
        converted.1.modes[2].covariance *= Enclosure::integer(4);
        let found = second_order(&converted, &MEASURED);
        for (found, plain) in found.iter().zip(second_order(&plain, &MEASURED)) {
            assert!(is_one_estimate(&found.2, &plain.2));
            assert!(found.1.iter().zip(&plain.1).all(|(a, b)| is_one(a, b)));
        }
    });
}

/// Headings that no motion changes and no sensor sees, all turned by one angle: across the cut, and by whole turns.
#[test]
fn turning_all_headings_turns_the_answer() {
    let run = |angle: f64, turns: f64| {
        let (mut problem, mut initial) = scene::<f64>(LASTING);
        problem.angles = vec![1];
        problem.sensor = Sensor::Linear(matrix![1.0, 0.0]);
        for mode in &mut problem.modes {
            mode.motion = Motion::Linear(Matrix2::identity());
        }
        for (estimate, turns) in initial.modes.iter_mut().zip([0.0, turns, 0.0]) {
            estimate.mean[1] += angle + turns * std::f64::consts::TAU;
        }
        second_order(&(problem, initial), &MEASURED)
    };
    for (angle, turns) in [(0.0, 1.0), (3.0, 0.0), (-2.5, -1.0)] {
        for (plain, turned) in run(0.0, 0.0).iter().zip(&run(angle, turns)) {
            let difference = turned.2.mean - plain.2.mean - vector![0.0, angle];
            let heading = Real::atan2(&difference[1].sin(), &difference[1].cos());
            // Some dozen roundings, and a turn of 2π as a double is off by 2.5e-16.
            assert!(
                difference[0].abs() < 1e-12 && heading.abs() < 1e-12,
                "{angle}: {difference}"
            );
            assert!((turned.2.covariance - plain.2.covariance).norm() < 1e-12, "{angle}");
        }
    }
}

#[test]
fn a_step_that_cannot_be_computed_is_refused_and_leaves_the_filter_where_it_was() {
    let (problem, initial) = scene::<f64>(LASTING);
    let mut filter = Gpb2::new(problem.clone(), &initial).unwrap();
    filter.step(Some(&Vector1::new(4.0))).unwrap();
    let before = filter.combined().clone();
    let sentence = filter.step(Some(&Vector1::new(f64::NAN))).unwrap_err().to_string();
    assert_eq!(
        sentence,
        "step 2, mode `all`, measurement: the measurement has an entry that is not finite"
    );
    assert_eq!(*filter.combined(), before);
    let sentence = filter.step(Some(&Vector1::new(1e200))).unwrap_err().to_string();
    assert!(sentence.starts_with("step 2, mode `all`, "), "{sentence}");
    assert_eq!(*filter.combined(), before);
    // Each prediction multiplies the covariances by 10²⁰⁰: the second one is beyond the doubles.
    let mut growing = problem;
    for mode in &mut growing.modes {
        mode.motion = Motion::Linear(Matrix2::identity() * 1e100);
    }
    let mut filter = Gpb2::new(growing, &initial).unwrap();
    filter.step(None).unwrap();
    let sentence = filter.step(None).unwrap_err().to_string();
    let expected = "step 2, mode `all`, combined: the combined estimate has an entry that is not finite";
    assert_eq!(sentence, expected);
}
