//! Goal: a filter with converted measurements is the Kalman filter of what it converts, and modes of unequal dimensions are mixed as each
//! of the three ways says.
//!
//! Method: exact arithmetic on rationals where no root or angle is needed; the same runs in doubles, bit for bit, where two filters must do
//! the same operations; property tests with stated tolerances for the rest.

mod common;

use common::{CHAIN, ROUNDOFF, all_scenes, converted_scene};
use immaculate::filter::Filter;
use immaculate::filter::converted::{converted_covariance, converted_measurement};
use immaculate::gaussian::{Gaussian, mixture_covariance, mixture_mean};
use immaculate::imm::unequal::{augmented, index_wise_covariance};
use immaculate::imm::{Equations, Imm, Initial, Interaction, Problem};
use immaculate::model::motion::{Mode, Motion};
use immaculate::model::{Conversion, PolarComponent, Sensor};
use immaculate::number::Rational;
use immaculate::rule::RuleName;
use nalgebra::{Matrix2, SMatrix, SVector, U2, U3, U4, U6, vector};
use proptest::prelude::*;

fn radar(location: [f64; 2]) -> Sensor<f64, U4, U2> {
    Sensor::Polar {
        components: vec![PolarComponent::Range, PolarComponent::Bearing],
        position: [0, 2],
        location,
    }
}

// ---- the converted filter

/// Exact: the same operations in doubles, so the same bits. The noise of a Kalman filter is its problem's, so each step is a filter of its
/// own there, started from the estimates of the last.
#[test]
fn a_converted_filter_is_the_kalman_filter_of_the_converted_measurements() {
    for conversion in Conversion::ALL {
        let scene = converted_scene(conversion, [300.0, -200.0]);
        let mut before = scene.initial.clone();
        for step in scene.run() {
            let hands_on = Initial {
                modes: step.updated.clone(),
                mode_probabilities: step.mode_probabilities.clone(),
            };
            let Some(z) = step.measurement else {
                before = hands_on;
                continue;
            };
            let (sensor, noise) = (&scene.problem.sensor, &scene.problem.measurement_noise);
            let position = converted_measurement(conversion, sensor, &z, noise).unwrap();
            let kalman = Problem {
                sensor: Sensor::Linear(scene.problem.h().into_owned()),
                measurement_noise: converted_covariance(conversion, sensor, &z, noise).unwrap(),
                filters: vec![Filter::kalman()],
                ..scene.problem.clone()
            };
            let mut filter = Imm::new(kalman, &before).unwrap();
            let expected = filter.step(Some(&position)).unwrap();
            assert_eq!(step.updated, expected.updated);
            assert_eq!(step.mode_probabilities, expected.mode_probabilities);
            assert_eq!(step.combined, expected.combined);
            assert_eq!(step.innovations, expected.innovations);
            assert_eq!(step.innovation_covariances, expected.innovation_covariances);
            assert_eq!(step.converted_measurement, Some(position));
            before = hands_on;
        }
    }
}

/// Exact: without a detection nothing is converted, and what stood there is gone.
#[test]
fn without_a_detection_nothing_is_converted() {
    let scene = converted_scene(Conversion::Standard, [0.0, 0.0]);
    let mut filter = scene.filter().unwrap();
    let step = filter.step(scene.measurements[0].as_ref()).unwrap();
    assert!(step.converted_measurement.is_some() && step.converted_covariance.is_some());
    let step = filter.step(None).unwrap();
    assert_eq!((step.converted_measurement, step.converted_covariance), (None, None));
    assert_eq!(step.updated, step.predicted);
}

/// A range of zero is defined: the target is where the sensor is, and the standard conversion knows nothing across the line of sight but
/// that; the prediction's own covariance keeps S positive definite.
#[test]
fn a_target_at_the_sensor_is_measured_where_the_sensor_is() {
    for conversion in Conversion::ALL {
        let scene = converted_scene(conversion, [14000.0, 900.0]);
        let mut filter = scene.filter().unwrap();
        let step = filter.step(Some(&vector![0.0, 0.5])).unwrap();
        assert_eq!(step.converted_measurement, Some(vector![14000.0, 900.0]));
        assert!(step.combined.mean.iter().all(|entry| entry.is_finite()));
    }
    // Across the line of sight (bearing 0) the standard variance r² σ_θ² is exactly zero, the others' are not.
    let at_zero = |conversion: Conversion| conversion.covariance(&0.0, &0.0, &100.0, &0.01)[(1, 1)];
    assert_eq!(at_zero(Conversion::Standard).to_bits(), 0.0_f64.to_bits());
    assert!(at_zero(Conversion::ModifiedUnbiased) > 0.0);
}

/// Forms: R^c at the prediction is R^c of another place, and nothing else changes before it is used.
#[test]
fn the_covariance_at_the_prediction_is_that_of_the_predicted_place() {
    let mut scene = converted_scene(Conversion::Standard, [100.0, 50.0]);
    let at_measurement = scene.run();
    scene.equations = Equations::standard().with_conversion_at_prediction();
    let at_prediction = scene.run();
    assert_eq!(
        at_measurement[0].converted_measurement,
        at_prediction[0].converted_measurement
    );
    assert_ne!(
        at_measurement[0].converted_covariance,
        at_prediction[0].converted_covariance
    );
    let mean = &at_prediction[0].combined_prediction.mean;
    let (x, y) = (mean[0] - 100.0, mean[2] - 50.0);
    let noise = &scene.problem.measurement_noise;
    let expected = Conversion::Standard.covariance(&x.hypot(y), &y.atan2(x), &noise[(0, 0)], &noise[(1, 1)]);
    // hypot and atan2 of the platform against a root and the portable arctangent: some units in the last place.
    let difference = (at_prediction[0].converted_covariance.unwrap() - expected).abs().max();
    assert!(difference <= 64.0 * ROUNDOFF * expected.abs().max(), "{difference}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// Property: the position is s + r (cos θ, sin θ), times the factor of the conversion. Tolerance: a cosine and a product are right to
    /// two units of the range, the sum to one of the sum.
    #[test]
    fn a_converted_measurement_is_where_range_and_bearing_point(
        range in 0.0..1e5_f64, bearing in -6.2..6.2_f64, deviation in 1e-3..0.3_f64, x in -1e4..1e4_f64, y in -1e4..1e4_f64,
    ) {
        let noise = Matrix2::from_diagonal(&vector![25.0, deviation * deviation]);
        for conversion in Conversion::ALL {
            let position = converted_measurement(conversion, &radar([x, y]), &vector![range, bearing], &noise).unwrap();
            let factor = conversion.position(&1.0, &0.0, &noise[(1, 1)])[0];
            let expected = vector![x, y] + vector![bearing.cos(), bearing.sin()] * (range * factor);
            let tolerance = 4.0 * f64::EPSILON * (2.0 * range + x.abs() + y.abs());
            prop_assert!((position - expected).abs().max() <= tolerance, "{position} {expected}");
        }
    }

    /// Property: bearing before range is the same measurement. Bit for bit.
    #[test]
    fn the_converted_covariance_does_not_depend_on_the_order_of_the_components(
        range in 0.0..1e5_f64, bearing in -6.2..6.2_f64, r in 1.0..1e3_f64, b in 1e-6..0.1_f64,
    ) {
        for conversion in Conversion::ALL {
            let one = radar([3.0, 4.0]);
            let mut other = one.clone();
            if let Sensor::Polar { components, .. } = &mut other {
                components.swap(0, 1);
            }
            let (z, noise) = (vector![range, bearing], Matrix2::from_diagonal(&vector![r, b]));
            let (turned, turned_noise) = (vector![bearing, range], Matrix2::from_diagonal(&vector![b, r]));
            let measurement = converted_measurement(conversion, &one, &z, &noise);
            prop_assert!(measurement.is_some());
            prop_assert_eq!(measurement, converted_measurement(conversion, &other, &turned, &turned_noise));
            let covariance = converted_covariance(conversion, &one, &z, &noise);
            prop_assert!(covariance.is_some());
            prop_assert_eq!(covariance, converted_covariance(conversion, &other, &turned, &turned_noise));
        }
    }

    /// Property: the same bearing one turn on is the same measurement: no angle is ever subtracted from another. Tolerance: the argument
    /// of the sine is rounded at 2π, 4·10⁻¹⁶ absolute, and so is the direction, times the range.
    #[test]
    fn a_converted_measurement_knows_no_turns(range in 1.0..1e4_f64, bearing in -3.1..3.1_f64) {
        let radar = radar([0.0, 0.0]);
        let noise = Matrix2::from_diagonal(&vector![100.0, 3e-4]);
        let turned = bearing - bearing.signum() * 2.0 * std::f64::consts::PI;
        let position = |bearing| converted_measurement(Conversion::Standard, &radar, &vector![range, bearing], &noise).unwrap();
        prop_assert!((position(bearing) - position(turned)).abs().max() <= 8.0 * f64::EPSILON * range);
    }
}

// ---- modes of unequal dimensions

/// Two modes over [p, v, a]: constant velocity, which lacks the acceleration, and constant acceleration. All numbers are small rationals.
fn unequal_modes() -> Vec<Mode<Rational, U3>> {
    let n = |value: i64| Rational::new(value, 1);
    let matrix = |entries: [i64; 9]| SMatrix::<Rational, 3, 3>::from_row_iterator(entries.map(n));
    let mode = |name: &str, transition, noise| Mode {
        name: name.to_owned(),
        motion: Motion::Linear(matrix(transition)),
        noise: matrix(noise),
    };
    vec![
        mode(
            "constant velocity",
            [1, 1, 0, 0, 1, 0, 0, 0, 0],
            [2, 1, 0, 1, 2, 0, 0, 0, 0],
        ),
        mode(
            "constant acceleration",
            [1, 1, 1, 0, 1, 1, 0, 0, 1],
            [3, 1, 0, 1, 3, 1, 0, 1, 3],
        ),
    ]
}

fn unequal_estimates() -> Vec<Gaussian<Rational, U3>> {
    let n = |value: i64| Rational::new(value, 1);
    let estimate = |mean: [i64; 3], covariance: [i64; 9]| Gaussian {
        mean: SVector::from(mean.map(n)),
        covariance: SMatrix::from_row_iterator(covariance.map(n)),
    };
    vec![
        estimate([1, 2, 0], [5, 1, 0, 1, 4, 0, 0, 0, 0]),
        estimate([3, -1, 8], [6, 2, 1, 2, 7, 2, 1, 2, 9]),
    ]
}

/// Exact: embedded mixing is the law of total covariance; index by index, exactly the terms with the missing entry of the mode that
/// lacks it are left out. Here w = (1/4, 3/4), ā = 6, the deviation of constant velocity (−3/2, 9/4, −6).
#[test]
fn index_wise_mixing_leaves_out_the_spread_of_a_missing_entry() {
    let weights = [Rational::new(1, 4), Rational::new(3, 4)];
    let (modes, estimates) = (unequal_modes(), unequal_estimates());
    assert!(modes[0].lacks(2) && !modes[0].lacks(1) && !modes[1].lacks(2));
    let mean = mixture_mean(&weights, &estimates);
    let embedded = mixture_covariance(&weights, &estimates, &mean);
    let index_wise = index_wise_covariance(&weights, &estimates, &mean, &modes);
    let lost = embedded - index_wise;
    let deviation = &estimates[0].mean - &mean;
    for (row, column) in (0..3).flat_map(|row| (0..3).map(move |column| (row, column))) {
        let expected = if row == 2 || column == 2 {
            deviation[row].clone() * deviation[column].clone() * weights[0].clone()
        } else {
            Rational::new(0, 1)
        };
        assert_eq!(lost[(row, column)], expected, "{row}, {column}");
    }
    // The variance of the acceleration lacks μ₍CV₎ ā² = 1/4 · 36.
    assert_eq!(lost[(2, 2)], Rational::new(9, 1));
}

/// Exact: mixed for constant acceleration, the acceleration and its variance are those of constant acceleration, whatever the weights; the
/// other entries are the mixture's.
#[test]
fn unbiased_mixing_keeps_the_entry_that_one_mode_alone_has() {
    let (modes, estimates) = (unequal_modes(), unequal_estimates());
    for numerator in 0..=4 {
        let weights = [Rational::new(numerator, 4), Rational::new(4 - numerator, 4)];
        let for_acceleration: Vec<_> = (0..2)
            .map(|i| augmented(&estimates[i], &estimates[1], &modes[i]))
            .collect();
        let mean = mixture_mean(&weights, &for_acceleration);
        let covariance = mixture_covariance(&weights, &for_acceleration, &mean);
        assert_eq!(mean[2], estimates[1].mean[2]);
        assert_eq!(covariance[(2, 2)], estimates[1].covariance[(2, 2)]);
        let plain = mixture_mean(&weights, &estimates);
        let plain_covariance = mixture_covariance(&weights, &estimates, &plain);
        for row in 0..2 {
            assert_eq!(mean[row], plain[row]);
            for column in 0..2 {
                assert_eq!(covariance[(row, column)], plain_covariance[(row, column)]);
            }
        }
        // A mode that has all entries is taken as it is.
        assert_eq!(for_acceleration[1], estimates[1]);
    }
}

/// Exact, in doubles bit for bit: where no mode lacks an entry the three ways are one.
#[test]
fn modes_of_equal_dimensions_are_mixed_alike_in_all_three_ways() {
    for (name, scene) in all_scenes() {
        let usual = scene.run();
        for equations in [
            scene.equations.with_index_wise_mixing(),
            scene.equations.with_unbiased_mixing(),
        ] {
            let mut other = scene.clone();
            other.equations = equations;
            for (one, two) in usual.iter().zip(other.run()) {
                assert_eq!(one.combined.mean, two.combined.mean, "{name}");
                assert_eq!(one.updated, two.updated, "{name}");
            }
        }
    }
}

/// Two modes of six entries [x, y, ẋ, ẏ, ẍ, ÿ], the first of constant velocity: its acceleration is exactly zero.
fn six_states() -> (Problem<f64, U6, U2>, Initial<f64, U6>) {
    let velocity = SMatrix::<f64, 6, 6>::from_fn(|row, column| match (row, column) {
        (row, column) if row == column && row < 4 => 1.0,
        (0, 2) | (1, 3) => 1.0,
        _ => 0.0,
    });
    let mut acceleration = velocity;
    for (row, column, entry) in [
        (4, 4, 1.0),
        (5, 5, 1.0),
        (0, 4, 0.5),
        (1, 5, 0.5),
        (2, 4, 1.0),
        (3, 5, 1.0),
    ] {
        acceleration[(row, column)] = entry;
    }
    let noise = |entries: [f64; 6]| SMatrix::from_diagonal(&SVector::from(entries));
    let modes = vec![
        Mode {
            name: "constant velocity".into(),
            motion: Motion::Linear(velocity),
            noise: noise([0.1, 0.1, 0.2, 0.2, 0.0, 0.0]),
        },
        Mode {
            name: "constant acceleration".into(),
            motion: Motion::Linear(acceleration),
            noise: noise([0.1, 0.1, 0.2, 0.2, 0.3, 0.3]),
        },
    ];
    let problem = Problem {
        modes,
        chain: CHAIN[..2].iter().map(|row| vec![row[0], 1.0 - row[0]]).collect(),
        sensor: Sensor::Polar {
            components: vec![PolarComponent::Range, PolarComponent::Bearing],
            position: [0, 1],
            location: [0.0, 0.0],
        },
        measurement_noise: Matrix2::from_diagonal(&vector![100.0, 3e-4]),
        filters: vec![Filter::points(RuleName::Unscented(None).rule().unwrap())],
        interaction: Interaction::Imm,
        angles: vec![],
    };
    let estimate = |variances| Gaussian {
        mean: vector![-1000.0, 1000.0, 4.0, 3.0, 0.0, 0.0],
        covariance: noise(variances),
    };
    let initial = Initial {
        modes: vec![
            estimate([200.0, 200.0, 100.0, 100.0, 0.0, 0.0]),
            estimate([200.0, 200.0, 100.0, 100.0, 1.0, 1.0]),
        ],
        mode_probabilities: vec![0.9, 0.1],
    };
    (problem, initial)
}

/// Exact zeros: a filter with points runs on a mode that knows two entries exactly, and goes on knowing them.
#[test]
fn a_filter_with_points_keeps_what_a_mode_knows_exactly() {
    let (problem, initial) = six_states();
    let mut filter = Imm::new(problem, &initial).unwrap();
    for k in 1..=20 {
        let (x, y) = (-1000.0 + 4.0 * f64::from(k), 1000.0 + 3.0 * f64::from(k));
        let step = filter.step(Some(&vector![x.hypot(y), y.atan2(x)])).unwrap();
        let velocity = &step.updated[0];
        for entry in [4, 5] {
            assert!(velocity.mean[entry] == 0.0);
            assert!(velocity.covariance.row(entry).iter().all(|value| *value == 0.0));
        }
        assert!(step.updated[1].covariance[(4, 4)] > 0.0);
    }
}

/// Bad input: an entry may have no variance, whether the mode lacks it or not; then nothing is correlated with it.
#[test]
fn an_entry_without_variance_has_no_covariance() {
    let (problem, initial) = six_states();
    let mut exact = initial.clone();
    for entry in 0..6 {
        exact.modes[1].covariance[(5, entry)] = 0.0;
        exact.modes[1].covariance[(entry, 5)] = 0.0;
    }
    assert!(Imm::new(problem.clone(), &exact).is_ok());
    for (place, entry) in [((4, 4), -1.0), ((5, 1), 0.5)] {
        let mut wrong = initial.clone();
        wrong.modes[0].covariance[place] = entry;
        wrong.modes[0].covariance[(place.1, place.0)] = entry;
        let error = Imm::new(problem.clone(), &wrong).unwrap_err();
        assert_eq!(
            error.to_string(),
            "`initial.modes[0].covariance` is not positive semidefinite (zhu2016 (56))"
        );
    }
}

/// Exact, bit for bit: in the table every covariance of a mixture is index by index, that of the combined prediction too.
#[test]
fn a_filter_mixes_index_by_index_wherever_it_mixes() {
    let (problem, mut initial) = six_states();
    (initial.modes[1].mean[4], initial.modes[1].mean[5]) = (2.0, -3.0);
    let modes = problem.modes.clone();
    let mut filter = Imm::with_equations(problem, Equations::standard().with_index_wise_mixing(), &initial).unwrap();
    let step = filter.step(Some(&vector![1410.0, 2.35])).unwrap();
    for (weights, components, mixture) in [
        (&step.mixing_probabilities[0], &initial.modes, &step.mixed[0]),
        (&step.mixing_probabilities[1], &initial.modes, &step.mixed[1]),
        (
            &step.predicted_mode_probabilities,
            &step.predicted,
            &step.combined_prediction,
        ),
        (&step.mode_probabilities, &step.updated, &step.combined),
    ] {
        let index_wise = index_wise_covariance(weights, components, &mixture.mean, &modes);
        assert_eq!(mixture.covariance, index_wise);
        assert_ne!(
            mixture.covariance,
            mixture_covariance(weights, components, &mixture.mean)
        );
    }
}

/// Exact, bit for bit: in the table with unbiased mixing a mode starts from the mixture of the estimates, each with what it lacks taken
/// from this mode; the combined estimate is the mixture as it is.
#[test]
fn a_filter_with_unbiased_mixing_mixes_what_is_augmented() {
    let (problem, mut initial) = six_states();
    (initial.modes[1].mean[4], initial.modes[1].mean[5]) = (2.0, -3.0);
    let modes = problem.modes.clone();
    let mut filter = Imm::with_equations(problem, Equations::standard().with_unbiased_mixing(), &initial).unwrap();
    let step = filter.step(Some(&vector![1410.0, 2.35])).unwrap();
    for j in 0..2 {
        let weights = &step.mixing_probabilities[j];
        let estimates: Vec<_> = (0..2)
            .map(|i| augmented(&initial.modes[i], &initial.modes[j], &modes[i]))
            .collect();
        assert_eq!(step.mixed[j].mean, mixture_mean(weights, &estimates));
        assert_eq!(
            step.mixed[j].covariance,
            mixture_covariance(weights, &estimates, &step.mixed[j].mean)
        );
    }
    // Mixed for the mode that has all entries, plain estimates are another mixture.
    assert_ne!(
        step.mixed[1].mean,
        mixture_mean(&step.mixing_probabilities[1], &initial.modes)
    );
    assert_eq!(
        step.combined.mean,
        mixture_mean(&step.mode_probabilities, &step.updated)
    );
    assert_eq!(
        step.combined.covariance,
        mixture_covariance(&step.mode_probabilities, &step.updated, &step.combined.mean)
    );
}

/// Property: at the negative x-axis each of the three places of a plain bearing has its own effect, and a filter with plain bearings has
/// all.
#[test]
fn plain_bearings_are_plain_in_all_three_places() {
    let (problem, mut initial) = six_states();
    for estimate in &mut initial.modes {
        estimate.mean[1] = 0.0;
    }
    let usual = Equations::standard;
    let step = |equations| {
        let mut filter = Imm::with_equations(problem.clone(), equations, &initial).unwrap();
        filter.step(Some(&vector![1000.0, -3.13])).unwrap().clone()
    };
    let plain = step(usual().with_plain_bearings());
    let one_by_one = step(
        usual()
            .with_plain_innovation()
            .with_plain_deviations()
            .with_plain_mean(),
    );
    assert_eq!(plain.updated, one_by_one.updated);
    let without_mean = step(usual().with_plain_deviations().with_plain_innovation());
    let without_deviations = step(usual().with_plain_mean().with_plain_innovation());
    let without_innovation = step(usual().with_plain_mean().with_plain_deviations());
    assert_ne!(plain.predicted_measurements[0], without_mean.predicted_measurements[0]);
    assert_ne!(
        plain.innovation_covariances[0],
        without_deviations.innovation_covariances[0]
    );
    assert_ne!(plain.cross_covariances[0], without_deviations.cross_covariances[0]);
    assert_ne!(plain.innovations[0], without_innovation.innovations[0]);
}
