//! Goal: the scenarios of derbez2000 are what they say, and their filters are made of what they say.
//!
//! Method: laws of the truth, of the measurement and of the filters' parts, by quadrature, by differences and against filters that are run
//! until they have settled. Kind of evidence: property. What the scenarios show is `tests/scenario.rs` and the claims.

mod common;

use common::ROUNDOFF;
use immaculate::filter::{Filter, Update};
use immaculate::imm::{Imm, Initial, Problem};
use immaculate::model::Conversion;
use immaculate::paper::derbez2000::contestants::MeasurementNoise;
use immaculate::paper::derbez2000::contestants::{CoordinateFilters, Coordinates};
use immaculate::paper::derbez2000::radar::{converted_variances, polar};
use immaculate::paper::derbez2000::relative::{Relative, below, within};
use immaculate::paper::derbez2000::scenario::{CoordinateScenario, track};
use immaculate::paper::derbez2000::search::distance;
use immaculate::paper::derbez2000::{self, path};
use immaculate::paper::specification::Choices;
use immaculate::paper::verdict::Verdict;
use immaculate::statistics::Estimate;
use nalgebra::{Matrix1, Matrix3, U1, U3, Vector1, Vector2, Vector3};

// The truth

#[test]
fn the_manoeuvres_accelerate_go_straight_turn_and_go_straight() {
    let scenario = of(&Choices::default());
    let places = &scenario.path.places;
    let speed = |k: usize| places[k][0][1].hypot(places[k][1][1]);
    // Ten steps of 2 s at 5 m/s² from rest.
    assert!((speed(9) - 100.0).abs() < 1e-12);
    // No step after that changes the speed: 60 products with rotations, a few roundings each.
    assert!((10..70).all(|k| (speed(k) / 100.0 - 1.0).abs() < 1000.0 * ROUNDOFF));
    // 30 steps of 2 s at 3°/s are half a turn to the left.
    let heading = |k: usize| places[k][1][1].atan2(places[k][0][1]).to_degrees();
    assert!(heading(19).abs() < 1e-9 && (heading(34) - 90.0).abs() < 1e-9 && (heading(49).abs() - 180.0).abs() < 1e-9);
    // In the turn the acceleration is ω v, at right angles to the velocity.
    let [x, y] = places[30];
    assert!((x[1] * x[2] + y[1] * y[2]).abs() < 1e-9);
    assert!((x[2].hypot(y[2]) - 100.0 * 3.0_f64.to_radians()).abs() < 1e-9);
    let accelerated = |c: usize| scenario.accelerates(c).iter().filter(|a| **a).count();
    assert_eq!(
        [accelerated(0), accelerated(1)],
        [40, 30],
        "the first acceleration is along x"
    );
}

#[test]
fn every_line_passes_the_radar_at_its_closest_point() {
    for line in ["from-rest", "turning-point", "reversed"] {
        let scenario = of(&Choices::of("scenario", "acceleration").with("path", line));
        let x = |k: usize| scenario.path.places[k - 1][0];
        assert_eq!(x(60)[0].abs().to_bits(), 0.0_f64.to_bits(), "{line}");
        for k in 1..120 {
            // Half a m t² is exact here: whole numbers of metres. Where the acceleration changes its sign, both sides hold.
            let (before, after) = (x(k), x(k + 1));
            let moved = |acceleration: f64| before[0] + 2.0 * before[1] + 2.0 * acceleration;
            assert!([5.0, -5.0].map(moved).contains(&after[0]), "{line}, step {k}");
        }
    }
}

#[test]
fn range_and_bearing_move_as_their_derivatives_say() {
    let h = 1e-4;
    let place = |t: f64| -> path::PlaneState {
        [
            Vector3::new(300.0 - 20.0 * t + 1.5 * t * t, -20.0 + 3.0 * t, 3.0),
            Vector3::new(-40.0 + 7.0 * t - t * t, 7.0 - 2.0 * t, -2.0),
        ]
    };
    let at = |t: f64| Coordinates::Polar.of(&place(t));
    let (before, now, after) = (at(-h), at(0.0), at(h));
    for c in [0, 1] {
        for derivative in [1, 2] {
            let slope = (after[c][derivative - 1] - before[c][derivative - 1]) / (2.0 * h);
            // The error of a central difference is of the order h² of the value's own scale, and its rounding 10⁻¹⁶/h of it.
            assert!(
                (slope - now[c][derivative]).abs() < 1e-8 * (1.0 + now[0][derivative].abs()),
                "{c}, {derivative}"
            );
        }
    }
    assert_eq!(Coordinates::Cartesian.of(&place(0.0)), place(0.0));
}

// The measurement

/// E f(v) of v ~ N(0, σ²), by the trapezoid rule out to ten deviations in steps of a quarter, whose error is far below a rounding.
fn expectation(deviation: f64, f: impl Fn(f64) -> f64) -> f64 {
    let weight = |i: i32| (-0.5 * (f64::from(i) / 4.0).powi(2)).exp();
    let nodes = || -40..=40;
    let total: f64 = nodes().map(weight).sum();
    nodes()
        .map(|i| weight(i) * f(deviation * f64::from(i) / 4.0))
        .sum::<f64>()
        / total
}

#[test]
fn the_variances_of_a_converted_measurement_are_right_to_first_order() {
    let [range, bearing] = derbez2000::MEASUREMENT_VARIANCES;
    let position = |polar: Vector2<f64>| Conversion::Standard.position(&polar[0], &polar[1], &bearing);
    for place in [
        Vector2::new(3000.0, 400.0),
        Vector2::new(-20.0, 500.0),
        Vector2::new(0.0, 500.0),
    ] {
        let at = polar(place);
        assert!((position(at) - place).norm() < 1e-12 * place.norm());
        let of = converted_variances(place, [range, bearing]);
        for c in [0, 1] {
            let moment = |power: i32| {
                expectation(range.sqrt(), |v| {
                    expectation(bearing.sqrt(), |w| {
                        let seen = position(at + Vector2::new(v, w));
                        (seen[c] - place[c]).powi(power)
                    })
                })
            };
            let variance = moment(2) - moment(1).powi(2);
            // What is left out is of the order r² σ⁴ and σ_r² σ².
            let left_out = place.norm_squared() * bearing * bearing + range * bearing;
            assert!((variance - of[c]).abs() < 3.0 * left_out, "{place}: {variance} {of:?}");
        }
    }
}

// The filters

#[test]
fn the_fixed_gains_are_those_with_which_the_kalman_filters_end() {
    for choices in [
        Choices::default(),
        Choices::of("measurement-variance", "0-05"),
        Choices::of("scan-time", "1"),
    ] {
        let scenario = of(&choices);
        for problem in &scenario.contestants[1].problems {
            for (mode, filter) in problem.modes.iter().zip(&problem.filters) {
                let Update::Given(fixed) = &filter.update else {
                    panic!("the gains are given");
                };
                let alone = Problem {
                    modes: vec![mode.clone()],
                    chain: vec![vec![1.0]],
                    filters: vec![Filter::kalman()],
                    ..problem.clone()
                };
                let settled = settled(alone);
                let [gain, innovation] = [
                    settled.0 - fixed.gain,
                    Vector3::from_element(settled.1 - fixed.innovation_covariance[0]),
                ];
                // The recursion forgets its start by a factor below 0.8 a step, for 2000 steps: what is left is rounding.
                assert!(gain.norm() < 1e-12 * fixed.gain.norm(), "{}: {gain}", mode.name);
                assert!(innovation[0].abs() < 1e-12 * settled.1, "{}", mode.name);
            }
        }
    }
}

/// The gain and the innovation variance of a Kalman filter of one mode after many steps.
fn settled(problem: Problem<f64, U3, U1>) -> (Vector3<f64>, f64) {
    let initial = Initial {
        modes: vec![immaculate::gaussian::Gaussian {
            mean: Vector3::zeros(),
            covariance: Matrix3::identity(),
        }],
        mode_probabilities: vec![1.0],
    };
    let mut filter = Imm::new(problem, &initial).unwrap();
    for _ in 0..2000 {
        filter.step(Some(&Vector1::new(0.0))).unwrap();
    }
    (filter.current().gains[0], filter.current().innovation_covariances[0][0])
}

#[test]
fn a_filter_that_is_told_the_same_noise_at_every_step_goes_on_as_if_it_were_not() {
    // Range and bearing have the same noise everywhere, so that starting afresh from the last estimates must change nothing.
    let scenario = of(&Choices::of("scenario", "acceleration"));
    for contestant in [&scenario.contestants[0], &scenario.contestants[2]] {
        let mut polar = contestant.clone();
        polar.coordinates = Coordinates::Polar;
        for (problem, variance) in polar.problems.iter_mut().zip(scenario.variances) {
            problem.measurement_noise = Matrix1::new(variance);
        }
        let told = CoordinateFilters {
            follows_noise: true,
            ..polar.clone()
        };
        let seen = scenario.seen(0, 1);
        let [constant, told] = [polar, told].map(|contestant| track(&scenario, &contestant, &seen));
        assert_eq!(constant.errors, told.errors);
        assert_eq!(constant.mode_probabilities, told.mode_probabilities);
        assert_eq!(constant.failure, None);
    }
}

#[test]
fn the_mean_noise_is_that_of_the_path() {
    let scenario = of(&Choices::default());
    assert_eq!(scenario.setup.noise, MeasurementNoise::MeanOverThePath);
    let [x, y] = scenario.setup.measurement_variances(&scenario.path);
    // Both together are the mean of σ_r² + r² σ_θ², whatever the direction.
    let squares = scenario
        .path
        .places
        .iter()
        .map(|place| place[0][0].powi(2) + place[1][0].powi(2));
    let mean = squares.sum::<f64>() / scenario.path.places.len() as f64;
    let [range, bearing] = scenario.variances;
    assert!(((x + y) / (range + mean * bearing) - 1.0).abs() < 1000.0 * ROUNDOFF);
}

// The verdicts

#[test]
fn a_claim_may_depend_on_what_is_open() {
    let relative = |value: f64, standard_error: f64| Relative {
        choices: String::new(),
        difference: Estimate { value, standard_error },
    };
    let (small, large, unsure) = (relative(0.05, 0.01), relative(0.3, 0.01), relative(0.1, 0.01));
    let verdict = |all: &[&Relative]| {
        let all: Vec<Relative> = all.iter().map(|one| (*one).clone()).collect();
        below(&all, 0.1).verdict()
    };
    assert_eq!(verdict(&[&small, &small]), Verdict::Confirmed);
    assert_eq!(verdict(&[&large]), Verdict::Refuted);
    assert_eq!(verdict(&[&small, &large, &unsure]), Verdict::DependsOnChoice);
    assert_eq!(verdict(&[&small, &unsure]), Verdict::Undecided);
    assert_eq!(verdict(&[&unsure]), Verdict::Undecided);
    let verdict_of = |one: &Relative| within(std::slice::from_ref(one), 0.1).verdict();
    assert_eq!(
        verdict_of(&relative(-0.3, 0.01)),
        Verdict::Refuted,
        "smaller is different too"
    );
    assert_eq!(below(&[relative(-0.3, 0.01)], 0.1).verdict(), Verdict::Confirmed);
}

#[test]
fn the_distance_from_a_table_is_the_greatest_ratio() {
    let published = [[1.0, 2.0, 4.0], [1.0, 1.0, 1.0]];
    let errors = |last: f64| {
        let mut errors = published.map(|row| {
            row.map(|value| Estimate {
                value,
                standard_error: 0.0,
            })
        });
        errors[0][2].value = last;
        errors
    };
    assert_eq!(distance(&errors(4.0), &published).to_bits(), 0.0_f64.to_bits());
    for last in [2.0, 8.0] {
        assert!((distance(&errors(last), &published) - 2.0_f64.ln()).abs() < 10.0 * ROUNDOFF);
    }
    assert!(distance(&errors(f64::NAN), &published).is_infinite());
}

fn of(choices: &Choices) -> CoordinateScenario {
    derbez2000::scenario(choices).unwrap()
}
