//! Goal: the figures of the reproduced tables are what their doc comments say, and so are their uncertainties.
//!
//! Method: small cases by hand; the delta method against the spread of many repeated experiments; published quantiles and closed
//! forms; the generator against numbers that an independent program made. Kinds of evidence: exact, and statistical with fixed
//! seeds, so that a test has one outcome for ever; where a bound is statistical, its distance in standard deviations is said.

// What is exact is compared exactly.
#![allow(clippy::float_cmp)]

use immaculate::gaussian::Gaussian;
use immaculate::imm::{Failure, Step, failure::Cause};
use immaculate::paper::Paper;
use immaculate::paper::comparison::{Comparison, ErrorQuantity};
use immaculate::paper::monte_carlo::{Generator, run};
use immaculate::paper::result::{Figure, Reproduction};
use immaculate::paper::scenario::Scenario;
use immaculate::paper::simulation::Average;
use immaculate::paper::simulation::Run;
use immaculate::paper::simulation::{Competitor, Path, Simulation};
use immaculate::paper::specification::Choices;
use immaculate::statistics::Estimate;
use immaculate::statistics::consistency::{bounds, nees, nis};
use immaculate::statistics::delay::detection_delays;
use immaculate::statistics::estimate::{figure, mean, paired_difference, root_mean_square};
use immaculate::statistics::rmse;
use nalgebra::{U1, Vector4, matrix, vector};
use quickcheck::QuickCheck;
use std::time::Duration;

// Errors

/// Exact: 7 ± 2 is three standard errors above 1 and two below 11.
#[test]
fn a_distance_is_counted_in_standard_errors() {
    let estimate = Estimate {
        value: 7.0,
        standard_error: 2.0,
    };
    assert_eq!(
        [1.0, 7.0, 11.0].map(|value| estimate.distance_from(value)),
        [3.0, 0.0, -2.0]
    );
}

/// Exact, as every number here has few digits: a standard error does not know where zero is, however far away. Squares about zero would
/// lose the digits.
#[test]
fn a_standard_error_does_not_depend_on_where_zero_is() {
    let values = [-3.0, -1.0, 1.0, 3.0].map(|value| value / 1024.0);
    let moved = values.map(|value| value + 2.0_f64.powi(41));
    assert_eq!(mean(&moved).standard_error, mean(&values).standard_error);
    assert_eq!(mean(&moved).value, 2.0_f64.powi(41));
}

/// Exact: four significant digits, as long as they stand beside the point.
#[test]
fn a_figure_has_four_significant_digits() {
    let figures = [
        12_345.6,
        1234.56,
        12.3456,
        0.012_345_6,
        1.234_56e-4,
        1.234_56e-5,
        999_999.0,
        1e6,
        0.0,
        f64::NAN,
    ];
    let written = figures.map(figure);
    let expected = [
        "12346",
        "1235",
        "12.35",
        "0.01235",
        "0.0001235",
        "1.23e-5",
        "999999",
        "1.00e6",
        "0",
        "—",
    ];
    assert_eq!(written, expected);
}

#[test]
fn printed_rmse_is_not_the_root_mean_square_over_runs() {
    // Two runs, three steps: squared errors of 1, 9, 25 and of 1, 25, 25.
    let squares = [vec![1.0, 9.0, 25.0], vec![1.0, 25.0, 25.0]];
    let corrected = |k: usize| rmse::root_mean_square(&[squares[0][k - 1], squares[1][k - 1]]);
    let printed = |k: usize| rmse::as_printed_in_zhu2016(&squares, k);
    // At the first step both say the same.
    assert_eq!(printed(1), 1.0);
    assert_eq!(corrected(1), 1.0);
    // (9 + 25)/2 = 17 against ((1 + 9)/2 + (1 + 25)/2)/2 = 9: the past is in it.
    assert_eq!(corrected(2), 17.0_f64.sqrt());
    assert_eq!(printed(2), 3.0);
    // At the third step both runs are off by 5, and only the corrected form says 5.
    assert_eq!(corrected(3), 5.0);
    assert_eq!(printed(3), (43.0_f64 / 3.0).sqrt());
    // The case of the erratum: one run, errors of 3 and 4.
    assert_eq!(rmse::root_mean_square(&[16.0]), 4.0);
    assert_eq!(rmse::as_printed_in_zhu2016(&[vec![9.0, 16.0]], 2), 12.5_f64.sqrt());
}

#[test]
fn the_accumulated_error_is_the_root_mean_square_over_runs_and_steps() {
    assert_eq!(rmse::accumulated(&[3.0, 4.0, 0.0, 0.0]), 2.5);
    let law = |seed: u64, runs: u8, steps: u8| {
        let (runs, steps) = (usize::from(runs % 20) + 1, usize::from(steps % 20) + 1);
        let mut generator = Generator::new(seed, 0);
        let squares: Vec<Vec<f64>> = (0..steps)
            .map(|_| (0..runs).map(|_| 1e4 * generator.uniform()).collect())
            .collect();
        let of_steps: Vec<f64> = squares.iter().map(|at_k| rmse::root_mean_square(at_k)).collect();
        let all: Vec<f64> = squares.into_iter().flatten().collect();
        let (two_stages, at_once) = (rmse::accumulated(&of_steps), rmse::root_mean_square(&all));
        let plain_mean = of_steps.iter().sum::<f64>() / of_steps.len() as f64;
        // Sums of at most 400 positive numbers: fewer than 400 roundings of 2⁻⁵³ each, and a few for the roots.
        let rounding = 500.0 * f64::EPSILON;
        (two_stages / at_once - 1.0).abs() <= rounding && plain_mean <= two_stages * (1.0 + rounding)
    };
    QuickCheck::new().quickcheck(law as fn(u64, u8, u8) -> bool);
}

#[test]
fn the_figure_of_a_table_is_the_average_of_its_history() {
    for (paper, choices, average) in [
        (
            Paper::Liu2017,
            Choices::default(),
            rmse::accumulated as fn(&[f64]) -> f64,
        ),
        (Paper::Zhu2016, Choices::default(), rmse::accumulated),
        (Paper::Zhu2016, Choices::of("table-average", "mean"), |rmses| {
            rmses.iter().sum::<f64>() / rmses.len() as f64
        }),
    ] {
        let scenario = paper.scenario(&choices).unwrap();
        let runs = run(&scenario, 4, 7, &|| ());
        let comparison = Comparison {
            scenario: &scenario,
            runs: &runs,
        };
        for quantity in ErrorQuantity::ALL {
            let figure = comparison.error(0, quantity).value;
            let history = comparison.rmse(0, quantity);
            let by_history = average(&history.iter().map(|rmse| rmse.value).collect::<Vec<f64>>());
            // Sums of at most 4 · 200 positive numbers.
            assert!(
                (figure / by_history - 1.0).abs() < 1000.0 * f64::EPSILON,
                "{}, {quantity:?}",
                choices.describe()
            );
        }
    }
}

#[test]
fn a_quantity_is_the_error_of_its_components() {
    let error = Vector4::new(3.0, 5.0, 4.0, 12.0);
    let squared = ErrorQuantity::ALL.map(|quantity| quantity.squared(&error));
    assert_eq!(squared, [9.0, 25.0, 16.0, 144.0, 25.0, 169.0]);
}

#[test]
fn a_failed_run_is_named_and_left_out_of_the_errors() {
    let mut scenario = scenario_of(Paper::Zhu2016);
    scenario.schedule.truncate(2);
    scenario.contestants.truncate(2);
    let good = |error: f64| hand_made_run(&[error, error]);
    let mut failed = hand_made_run(&[1e9]);
    failed.failure = Some(Failure {
        step: 2,
        mode: "left turn".into(),
        value: "measurement",
        cause: Cause::MeasurementNotFinite,
    });
    let runs = [
        vec![good(3.0), good(1.0)],
        vec![failed, good(1.0)],
        vec![good(4.0), good(2.0)],
    ];
    let comparison = Comparison {
        scenario: &scenario,
        runs: &runs,
    };
    assert_eq!(comparison.error(0, ErrorQuantity::X).value, 12.5_f64.sqrt());
    assert_eq!(comparison.error(1, ErrorQuantity::X).value, 2.0_f64.sqrt());
    // A difference needs both: runs 1 and 3 only.
    let difference = comparison.difference(0, 1, ErrorQuantity::X).value;
    assert_eq!(difference, 12.5_f64.sqrt() - 2.5_f64.sqrt());
    let reproduction = Reproduction::new(&scenario, 3, 1, &runs);
    assert_eq!(reproduction.filters[0].completed_runs, 2);
    assert_eq!(reproduction.filters[0].failures[0].run, 2);
    let sentence = &reproduction.filters[0].failures[0].failure;
    assert!(
        sentence.starts_with("step 2, mode `left turn`, measurement:"),
        "{sentence}"
    );
    assert!(reproduction.filters[1].failures.is_empty());
}

// Delays

#[test]
fn a_change_is_detected_when_its_mode_is_more_likely_than_not() {
    // The probabilities of mode 1; mode 0 has the rest.
    let delays = |modes: &[usize], of_mode_1: &[f64]| {
        let probabilities: Vec<Vec<f64>> = of_mode_1.iter().map(|p| vec![1.0 - p, *p]).collect();
        detection_delays(modes, &probabilities)
    };
    // At once, one step later, two steps later.
    assert_eq!(delays(&[0, 1, 1, 1], &[0.1, 0.6, 0.7, 0.8]), [Some(0)]);
    assert_eq!(delays(&[0, 1, 1, 1], &[0.1, 0.4, 0.7, 0.8]), [Some(1)]);
    // Exactly one half is not more likely than not.
    assert_eq!(delays(&[0, 1, 1, 1], &[0.1, 0.5, 0.5, 0.501]), [Some(2)]);
    // What was likely before the change and not after it was not detected.
    assert_eq!(delays(&[0, 1, 1, 1], &[0.9, 0.4, 0.4, 0.4]), [None]);
    // The first time counts, even if it does not last.
    assert_eq!(delays(&[0, 1, 1, 1], &[0.1, 0.6, 0.2, 0.9]), [Some(0)]);
    // The next change ends the search; going back is a change too.
    assert_eq!(delays(&[0, 1, 1, 0, 0], &[0.1, 0.2, 0.3, 0.9, 0.1]), [None, Some(1)]);
    // No change, no delay; a probability that is not a number detects nothing.
    assert_eq!(delays(&[1, 1, 1], &[0.1, 0.6, 0.9]), []);
    assert_eq!(delays(&[0, 1], &[0.1, f64::NAN]), [None]);
}

#[test]
fn the_mode_of_the_truth_is_found_by_name() {
    let scenario = scenario_of(Paper::Liu2017);
    let comparison = Comparison {
        scenario: &scenario,
        runs: &[],
    };
    let modes = comparison.true_modes(0).unwrap();
    // The states at 2, 21, 71 and 121 s: straight, right (mode 3), straight, left (mode 2).
    assert_eq!([modes[0], modes[19], modes[69], modes[119]], [0, 2, 0, 1]);
    let single = scenario_of(Paper::Zhu2016);
    let comparison = Comparison {
        scenario: &single,
        runs: &[],
    };
    assert_eq!(comparison.true_modes(3), None, "a filter of one mode has no turns");
}

// Standard errors

#[test]
fn the_standard_error_of_a_mean_is_the_spread_of_repeated_means() {
    // Five numbers a mean, the least that a careless M for M − 1 would show at: 20 % of SE².
    let mut generator = Generator::new(1, 0);
    let repetitions = 20_000;
    let estimates: Vec<_> = (0..repetitions)
        .map(|_| {
            mean(&std::array::from_fn::<f64, 5, _>(|_| {
                3.0 + 2.0 * generator.standard_normal()
            }))
        })
        .collect();
    let average_square = estimates.iter().map(|e| e.standard_error.powi(2)).sum::<f64>() / f64::from(repetitions);
    // SE² is unbiased: σ²/M = 4/5. Its relative spread is √(2/4)/√20000 = 0.5 %; 3 % is six times that.
    assert!((average_square / 0.8 - 1.0).abs() < 0.03, "{average_square}");
    // The mean itself: six standard errors of its own, 6 · √(0.8/20000).
    let average = estimates.iter().map(|e| e.value).sum::<f64>() / f64::from(repetitions);
    assert!((average - 3.0).abs() < 0.038, "{average}");
}

#[test]
fn the_delta_method_gives_the_spread_of_repeated_experiments() {
    // Mean squares of two filters: χ² of four degrees of freedom, most of it shared.
    let mut generator = Generator::new(2, 0);
    let experiment = |generator: &mut Generator| {
        let mut square = |deviation: f64| (deviation * generator.standard_normal()).powi(2);
        let shared: Vec<f64> = (0..200).map(|_| (0..4).map(|_| square(1.0)).sum()).collect();
        let a: Vec<f64> = shared.iter().map(|s| 2.0 * s + square(0.5)).collect();
        let b: Vec<f64> = shared.iter().map(|s| 2.5 * s + square(0.5)).collect();
        (a, b)
    };
    let repetitions = 2000;
    let (mut roots, mut differences) = (Vec::new(), Vec::new());
    for _ in 0..repetitions {
        let (a, b) = experiment(&mut generator);
        roots.push(root_mean_square(&a));
        differences.push(paired_difference(&a, &b));
    }
    for (name, estimates) in [("root mean square", roots), ("difference", differences)] {
        let spread = sample_deviation(&estimates.iter().map(|e| e.value).collect::<Vec<_>>());
        let claimed = estimates.iter().map(|e| e.standard_error).sum::<f64>() / f64::from(repetitions);
        // A deviation from 2000 repetitions is known to 1/√4000 = 1.6 %; 8 % is five times that. The delta method is off by the
        // order of 1/200 itself.
        assert!(
            (claimed / spread - 1.0).abs() < 0.08,
            "{name}: {claimed} against {spread}"
        );
    }
}

#[test]
fn the_band_of_an_error_over_time_is_the_spread_of_repeated_experiments() {
    // Forty runs of one filter along ten steps, again and again with other random numbers.
    let mut scenario = scenario_of(Paper::Zhu2016);
    scenario.schedule.truncate(10);
    scenario.contestants.truncate(1);
    let (repetitions, runs) = (400, 40);
    let histories: Vec<_> = (0..repetitions)
        .map(|seed| {
            let runs = run(&scenario, runs, seed, &|| ());
            let comparison = Comparison {
                scenario: &scenario,
                runs: &runs,
            };
            (
                comparison.rmse(0, ErrorQuantity::Position),
                comparison.mean_mode_probabilities(0),
            )
        })
        .collect();
    for k in 0..scenario.schedule.len() {
        let errors: Vec<Estimate> = histories.iter().map(|(rmse, _)| rmse[k]).collect();
        let probabilities: Vec<Estimate> = histories.iter().map(|(_, modes)| modes[k][1]).collect();
        for (name, estimates) in [("RMSE", errors), ("mode probability", probabilities)] {
            let spread = sample_deviation(&estimates.iter().map(|e| e.value).collect::<Vec<_>>());
            let claimed = estimates.iter().map(|e| e.standard_error).sum::<f64>() / estimates.len() as f64;
            // A deviation from 400 repetitions is known to 1/√800 = 3.5 %, the mean of the claims better. 20 % is more than five times
            // that, a false alarm in a million such figures; what the delta method leaves out is of the order of 1/40.
            assert!(
                (claimed / spread - 1.0).abs() < 0.2,
                "{name} at step {}: {claimed} against {spread}",
                k + 1
            );
        }
    }
}

#[test]
fn a_band_has_no_width_where_all_runs_agree() {
    let mut scenario = scenario_of(Paper::Zhu2016);
    scenario.schedule.truncate(2);
    scenario.contestants.truncate(1);
    let history = |runs: &[Vec<Run>]| {
        let reproduction = Reproduction::new(&scenario, runs.len(), 1, runs);
        let filter = &reproduction.filters[0];
        let rmse = filter.rmse[0].clone();
        (
            rmse.values,
            rmse.standard_errors,
            filter.mode_probability_standard_errors.clone(),
        )
    };
    // No error at the first step: neither a band nor 0/0.
    let agreeing = [0, 1, 2].map(|_| vec![hand_made_run(&[0.0, 3.0])]);
    let (values, errors, of_modes) = history(&agreeing);
    assert_eq!((values, errors), (vec![0.0, 3.0], vec![0.0, 0.0]));
    assert_eq!(of_modes, vec![vec![0.0; 3]; 2]);
    // And it has one where they do not: squares of 1 and 9 have a mean of 5 ± 4, their root is √5 ± 4/(2√5).
    let differing = [1.0, 3.0].map(|error| vec![hand_made_run(&[error, 3.0])]);
    let (values, errors, _) = history(&differing);
    assert_eq!(values, [5.0_f64.sqrt(), 3.0]);
    assert_eq!(errors, [4.0 / (2.0 * 5.0_f64.sqrt()), 0.0]);
}

// Consistency

#[test]
fn nees_is_the_squared_distance_in_the_metric_of_the_covariance() {
    // The inverse of [2 1; 1 1] is [1 −1; −1 2]: with (3, 1) it gives 9 − 3 − 3 + 2.
    let estimate = Gaussian {
        mean: vector![1.0, 2.0],
        covariance: matrix![2.0, 1.0; 1.0, 1.0],
    };
    assert_eq!(nees(&estimate, &vector![4.0, 3.0]), 5.0);
    assert_eq!(nees(&estimate, &vector![1.0, 2.0]), 0.0);
}

#[test]
fn nis_is_taken_under_the_mixture_that_predicts_the_measurement() {
    let estimate = Gaussian {
        mean: vector![0.0],
        covariance: matrix![1.0],
    };
    let mut step = Step::<f64, U1, U1>::initial(&[estimate.clone(), estimate], &[0.5, 0.5]);
    assert_eq!(nis(&step), None, "no measurement, no innovation");
    step.measurement = Some(vector![0.0]);
    step.innovations = vec![vector![4.0], vector![0.0]];
    step.innovation_covariances = vec![matrix![1.0], matrix![5.0]];
    // One mode alone: 4²/1.
    step.predicted_mode_probabilities = vec![1.0, 0.0];
    assert_eq!(nis(&step), Some(16.0));
    // Both: mean 1, covariance ¼ (1 + 3²) + ¾ (5 + 1²) = 7.
    step.predicted_mode_probabilities = vec![0.25, 0.75];
    assert_eq!(nis(&step), Some(1.0 / 7.0));
}

#[test]
fn chi_square_bounds_are_the_published_quantiles() {
    // Abramowitz and Stegun, table 26.8, to the digits printed there; the last digit may be off by one half.
    for (degrees, count, false_alarm, lower, upper, half_digit) in [
        (4.0, 1, 0.05, 0.484_419, 11.143_3, 5e-5),
        (2.0, 1, 0.01, 0.010_025_1, 10.596_6, 5e-5),
        // 100 degrees of freedom in all: 74.2219 and 129.561.
        (4.0, 25, 0.05, 74.221_9 / 25.0, 129.561 / 25.0, 5e-4 / 25.0),
        (2.0, 50, 0.05, 74.221_9 / 50.0, 129.561 / 50.0, 5e-4 / 50.0),
    ] {
        let (low, high) = bounds(degrees, count, false_alarm);
        assert!((low - lower).abs() <= half_digit, "{degrees} {count}: {low}");
        assert!((high - upper).abs() <= half_digit, "{degrees} {count}: {high}");
    }
    // Two degrees of freedom have a closed form, −2 ln(1 − p). The quantiles are found by a search that ends at about 1e-8.
    for false_alarm in [0.5, 0.05, 1e-3, 1e-6] {
        let (low, high) = bounds(2.0, 1, false_alarm);
        let (half, rest) = (false_alarm / 2.0, 1.0 - false_alarm / 2.0);
        assert!((low + 2.0 * f64::ln(rest)).abs() < 1e-7, "{false_alarm}: {low}");
        assert!((high + 2.0 * f64::ln(half)).abs() < 1e-7, "{false_alarm}: {high}");
    }
}

#[test]
fn chi_square_bounds_hold_as_often_as_they_say() {
    let mut generator = Generator::new(3, 0);
    let (low, high) = bounds(4.0, 10, 0.05);
    let experiments = 20_000;
    let inside = (0..experiments)
        .filter(|_| {
            let mean = (0..40).map(|_| generator.standard_normal().powi(2)).sum::<f64>() / 10.0;
            (low..=high).contains(&mean)
        })
        .count();
    // The count is binomial with a deviation of √(20000 · 0.95 · 0.05) = 31; 160 is five times that.
    assert!(inside.abs_diff(19_000) < 160, "{inside}");
}

// Random numbers

#[test]
fn the_first_numbers_are_the_same_everywhere() {
    // Made by another program from the definitions: a 64-bit seed expanded by PCG32 to a key, ChaCha with eight rounds, a 64-bit
    // stream number in the nonce; the upper 53 bits of each 64-bit word, plus one, times 2⁻⁵³.
    for (seed, stream, expected) in [
        (
            1,
            0,
            [3_625_268_569_805_954_u64, 724_032_083_165_650, 5_373_336_417_124_577],
        ),
        (
            1,
            1,
            [7_673_342_580_260_534, 458_586_832_309_824, 5_032_795_548_619_591],
        ),
        (
            2,
            0,
            [7_938_411_560_579_396, 4_939_826_993_346_189, 7_108_939_277_731_946],
        ),
    ] {
        let mut generator = Generator::new(seed, stream);
        for count in expected {
            assert_eq!(
                generator.uniform(),
                count as f64 / (1_u64 << 53) as f64,
                "{seed} {stream}"
            );
        }
    }
    // √(−2 ln u) cos 2πv of the first two, by hand in another language; the bits are those of the portable functions.
    let normal = Generator::new(1, 0).standard_normal();
    assert!((normal - 1.180_694_150_218_984_3).abs() < 1e-15, "{normal}");
    assert_eq!(normal.to_bits(), 0x3ff2_e41f_8c9c_4e06, "{:#x}", normal.to_bits());
}

#[test]
fn uniform_numbers_are_above_zero_and_evenly_spread() {
    const CELLS: usize = 100;
    let mut generator = Generator::new(4, 0);
    let count = 200_000;
    let edges: [f64; CELLS - 1] = std::array::from_fn(|cell| (cell + 1) as f64 / CELLS as f64);
    let mut cells = [0_u32; CELLS];
    for _ in 0..count {
        let u = generator.uniform();
        // ln u must be finite, so zero is not drawn; one is.
        assert!(u > 0.0 && u <= 1.0);
        cells[edges.partition_point(|edge| *edge < u)] += 1;
    }
    let expected = f64::from(count) / CELLS as f64;
    let chi_square: f64 = cells
        .iter()
        .map(|&cell| (f64::from(cell) - expected).powi(2) / expected)
        .sum();
    // χ² with 99 degrees of freedom: the mean and five deviations, 99 + 5 √198; too even is as suspect as too uneven.
    assert!((chi_square - 99.0).abs() < 70.0, "{chi_square}");
}

#[test]
fn normal_numbers_have_the_moments_of_the_normal_distribution() {
    let mut generator = Generator::new(5, 0);
    let count = 400_000;
    let numbers: Vec<f64> = (0..count).map(|_| generator.standard_normal()).collect();
    let average = |f: &dyn Fn(f64) -> f64| numbers.iter().map(|x| f(*x)).sum::<f64>() / f64::from(count);
    // Moments of x^p: expectation and variance of one term. Each average is within five of its standard deviations, which a right
    // generator misses once in two million such figures.
    for (power, expected, variance) in [(1, 0.0, 1.0), (2, 1.0, 2.0), (3, 0.0, 15.0), (4, 3.0, 96.0)] {
        let found = average(&|x| x.powi(power));
        let bound = 5.0 * f64::sqrt(variance / f64::from(count));
        assert!((found - expected).abs() < bound, "E x^{power} = {found}");
    }
    // The tails: P(|x| > 1.959964) = 0.05 and P(|x| > 3.290527) = 0.001.
    for (limit, probability) in [(1.959_964, 0.05), (3.290_527, 0.001)] {
        let found = average(&|x| f64::from(x.abs() > limit));
        let bound = 5.0 * f64::sqrt(probability * (1.0 - probability) / f64::from(count));
        assert!((found - probability).abs() < bound, "P(|x| > {limit}) = {found}");
    }
}

#[test]
fn streams_seeds_and_neighbours_are_uncorrelated() {
    let count = 100_000;
    let numbers = |seed, stream| {
        let mut generator = Generator::new(seed, stream);
        (0..count).map(|_| generator.standard_normal()).collect::<Vec<f64>>()
    };
    let first = numbers(1, 0);
    let mut shifted = first.clone();
    shifted.rotate_left(1);
    for (name, other) in [
        ("stream", numbers(1, 1)),
        ("seed", numbers(2, 0)),
        ("neighbour", shifted),
    ] {
        let products = first.iter().zip(&other).map(|(a, b)| a * b);
        let correlation = products.sum::<f64>() / f64::from(count);
        // Five standard deviations, 5/√100000.
        assert!(correlation.abs() < 0.016, "{name}: {correlation}");
    }
}

// Runs

#[test]
fn runs_do_not_depend_on_the_number_of_threads() {
    for paper in Paper::ALL {
        let simulation = paper.simulation(&Choices::default()).unwrap();
        let on_threads = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| without_time(run(&*simulation, 4, 1, &|| ())))
        };
        // As text: a filter without covariances has a NEES that is not a number, which equals nothing.
        let one = on_threads(1);
        assert_eq!(format!("{one:?}"), format!("{:?}", on_threads(2)));
        assert_ne!(one[0], one[1], "runs differ from each other");
    }
}

#[test]
fn a_run_is_the_same_in_a_shorter_experiment() {
    for pairing in ["paired", "unpaired"] {
        let scenario = Paper::Zhu2016.scenario(&Choices::of("pairing", pairing)).unwrap();
        let long = without_time(run(&scenario, 5, 1, &|| ()));
        let short = without_time(run(&scenario, 2, 1, &|| ()));
        assert_eq!(short[..], long[..2], "{pairing}");
        assert_ne!(
            short,
            without_time(run(&scenario, 2, 2, &|| ())),
            "another seed is another experiment"
        );
    }
}

#[test]
fn paired_filters_see_the_same_draws_and_unpaired_ones_different_draws() {
    for paper in [Paper::Zhu2016, Paper::Liu2017] {
        let twins = |pairing: &str| {
            let mut scenario = paper.scenario(&Choices::of("pairing", pairing)).unwrap();
            // Three copies of one filter: only their draws can tell them apart.
            scenario.contestants = vec![scenario.contestants[0].clone(); 3];
            without_time(run(&scenario, 4, 1, &|| ()))
        };
        for run in twins("paired") {
            assert_eq!(run[0], run[1]);
            assert_eq!(run[0], run[2]);
        }
        let unpaired: Vec<Run> = twins("unpaired").into_iter().flatten().collect();
        for (index, run) in unpaired.iter().enumerate() {
            assert!(!unpaired[..index].contains(run), "a draw was used twice");
        }
    }
}

#[test]
fn progress_is_told_once_a_run() {
    let told = std::sync::atomic::AtomicUsize::new(0);
    let scenario = scenario_of(Paper::Zhu2016);
    run(&scenario, 5, 1, &|| {
        told.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    });
    assert_eq!(told.into_inner(), 5);
}

// A reproduction by hand

/// Two filters along four steps of 2 s: straight, two steps of a turn, straight. The second has one mode.
#[derive(Debug)]
struct ByHand {
    choices: Choices,
    average: Average,
}

impl Simulation for ByHand {
    fn paper(&self) -> &'static str {
        "by hand"
    }
    fn choices(&self) -> &Choices {
        &self.choices
    }
    fn runs(&self) -> usize {
        7
    }
    fn times(&self) -> Vec<f64> {
        vec![10.0, 12.0, 14.0, 16.0]
    }
    fn interval(&self) -> f64 {
        2.0
    }
    fn motions(&self) -> Vec<&'static str> {
        vec!["straight", "turn", "turn", "straight"]
    }
    fn average(&self) -> Average {
        self.average
    }
    fn components(&self) -> (f64, f64) {
        (4.0, 2.0)
    }
    fn filters(&self) -> Vec<Competitor> {
        let filter = |name: &str, modes: &[&str], points| Competitor {
            name: name.to_owned(),
            modes: modes.iter().map(|mode| (*mode).to_owned()).collect(),
            points,
        };
        vec![
            filter("two", &["straight", "turn"], Some((33, 25))),
            filter("one", &["straight"], None),
        ]
    }
    fn one_run(&self, run: usize, _: u64) -> Vec<Run> {
        let of_run = |first: Run, second: Run| vec![first, second];
        let run_of = |error: Vector4<f64>, nees: [f64; 4], turn: &[f64], fit: f64, microseconds: u64| Run {
            errors: vec![error; 4],
            nees: nees.to_vec(),
            nis: vec![2.0, 0.1, 2.0, 7.0],
            mode_probabilities: turn.iter().map(|p| vec![1.0 - p, *p]).collect(),
            fit_error: Some(fit),
            failure: None,
            time: Duration::from_micros(microseconds),
        };
        let single = |error: Vector4<f64>, fit: f64| Run {
            mode_probabilities: vec![vec![1.0]; 4],
            ..run_of(error, [4.0; 4], &[], fit, 4)
        };
        match run {
            // The turn is noticed a step late, its end at once.
            0 => of_run(
                run_of(
                    vector![1.0, 3.0, 0.0, 4.0],
                    [4.0, 4.0, 100.0, 4.0],
                    &[0.25, 0.25, 0.75, 0.25],
                    3.0,
                    8,
                ),
                single(vector![3.0, 0.0, 4.0, 1.0], 1.0),
            ),
            // The turn at once, its end never.
            _ => of_run(
                run_of(
                    vector![7.0_f64.sqrt(), 3.0, 0.0, 4.0],
                    [2.0, 4.0, 4.0, 4.0],
                    &[0.25, 0.75, 0.75, 0.75],
                    5.0,
                    16,
                ),
                single(vector![3.0, 0.0, 4.0, 1.0], 2.0),
            ),
        }
    }
    fn first_path(&self, seed: u64) -> Option<Path> {
        let places = |x: f64| (0..4).map(|k| vector![x + f64::from(k), -f64::from(k)]).collect();
        // A seed of its own, to see that it arrives.
        Some(Path {
            truth: places(100.0),
            measured: places(seed as f64),
            sensor: Some([5.0, 6.0]),
        })
    }
}

fn by_hand(average: Average) -> Reproduction {
    let simulation = ByHand {
        choices: Choices::of("of", "hand"),
        average,
    };
    let runs = run(&simulation, 2, 9, &|| ());
    Reproduction::new(&simulation, 2, 9, &runs)
}

/// Exact: every figure but the bounds of χ², which have a test of their own.
#[test]
fn every_figure_of_a_reproduction_is_that_of_its_runs() {
    let shown = by_hand(Average::RootMeanSquare);
    assert_eq!((shown.paper, shown.runs, shown.steps, shown.seed), ("by hand", 2, 4, 9));
    assert_eq!(
        (shown.choices.describe(), &shown.times),
        ("of=hand".to_owned(), &vec![10.0, 12.0, 14.0, 16.0])
    );
    assert_eq!(shown.motions, ["straight", "turn", "turn", "straight"]);
    let [two, one] = &shown.filters[..] else {
        panic!("two filters")
    };
    assert_eq!(
        (&*two.name, two.modes.join(" "), two.points, two.effective_points),
        ("two", "straight turn".into(), Some(33), Some(25))
    );
    assert_eq!(
        (&*one.name, one.modes.join(" "), one.points, one.effective_points),
        ("one", "straight".into(), None, None)
    );
    assert_eq!((two.completed_runs, two.failures.len()), (2, 0));
    // Squares of x: 1 and 7, so 4 ± 3 and its root 2 ± ¾. Velocities are 5 in both runs.
    let errors = |filter: &str| ErrorQuantity::ALL.map(|quantity| shown.error(filter, quantity).unwrap());
    let sure = |value: f64| Estimate {
        value,
        standard_error: 0.0,
    };
    let x = Estimate {
        value: 2.0,
        standard_error: 0.75,
    };
    assert_near(&errors("two"), &[x, sure(3.0), sure(0.0), sure(4.0), x, sure(5.0)]);
    assert_near(&errors("one"), &[3.0, 0.0, 4.0, 1.0, 5.0, 1.0].map(sure));
    for (history, error) in two.rmse.iter().zip(errors("two")) {
        let step = |k: usize| Estimate {
            value: history.values[k],
            standard_error: history.standard_errors[k],
        };
        assert_near(&[0, 1, 2, 3].map(step), &[error; 4]);
    }
    assert_eq!(
        two.rmse.iter().map(|history| history.quantity).collect::<Vec<_>>(),
        ErrorQuantity::ALL
    );
    assert_eq!(
        (two.rmse[0].values.len(), shown.error("three", ErrorQuantity::X)),
        (4, None)
    );
    // 3 and 5: 4 ± 1; 1 and 2: 1.5 ± ½; and of their differences, 2 and 3.
    let estimate = |value: f64, standard_error: f64| Estimate { value, standard_error };
    assert_near(
        &[two.fit_error.unwrap(), one.fit_error.unwrap()],
        &[estimate(4.0, 1.0), estimate(1.5, 0.5)],
    );
    let [difference] = &shown.fit_differences[..] else {
        panic!("one pair")
    };
    assert_eq!((&*difference.filter, &*difference.minus), ("two", "one"));
    assert_near(&[difference.estimate], &[estimate(2.5, 0.5)]);
    let differences: Vec<_> = shown
        .differences
        .iter()
        .map(|d| (&*d.filter, &*d.minus, d.quantity))
        .collect();
    assert_eq!(
        differences,
        [
            ("two", "one", ErrorQuantity::Position),
            ("two", "one", ErrorQuantity::Velocity)
        ]
    );
    assert_near(
        &[shown.differences[0].estimate, shown.differences[1].estimate],
        &[estimate(-3.0, 0.75), sure(4.0)],
    );
    // Quarters are exact in binary.
    assert_eq!(
        two.mode_probabilities,
        [[0.75, 0.25], [0.5, 0.5], [0.25, 0.75], [0.5, 0.5]]
    );
    assert_eq!(
        two.mode_probability_standard_errors,
        [[0.0, 0.0], [0.25, 0.25], [0.0, 0.0], [0.25, 0.25]]
    );
    assert_eq!(one.mode_probabilities, [[1.0]; 4]);
    // 24 µs in eight steps, 8 in eight.
    assert!((two.microseconds_per_step - 3.0).abs() < 1e-12 && (one.microseconds_per_step - 1.0).abs() < 1e-12);
    assert_eq!(two.time_ratio.map(|ratio| ratio.median), Some(1.0)); // it is the first
}

/// Exact: means of a run's four values, then over the runs; and how many steps are within the bounds of two runs.
#[test]
fn the_consistency_of_a_reproduction_is_that_of_its_runs() {
    let two = &by_hand(Average::RootMeanSquare).filters[0];
    // NEES: 28 and 3.5; the means at the steps are 3, 4, 52 and 4, and χ² of eight degrees is within 2.18 and 17.53.
    assert_near(
        &[two.nees.mean],
        &[Estimate {
            value: 15.75,
            standard_error: 12.25,
        }],
    );
    assert_eq!(
        (two.nees.expected, two.nees.bounds, two.nees.inside),
        (4.0, bounds(4.0, 2, 0.05), 0.75)
    );
    let [low, high] = [two.nees.bounds.0, two.nees.bounds.1].map(|bound| 2.0 * bound);
    assert!(2.17 < low && low < 2.19 && 17.53 < high && high < 17.54);
    // NIS: the same in both runs; χ² of four degrees is within 0.484 and 11.14, so that 0.1 and 7 are outside.
    assert_near(
        &[two.nis.mean],
        &[Estimate {
            value: 11.1 / 4.0,
            standard_error: 0.0,
        }],
    );
    assert_eq!(
        (two.nis.expected, two.nis.bounds, two.nis.inside),
        (2.0, bounds(2.0, 2, 0.05), 0.5)
    );
}

/// Exact: delays are counted in steps and shown in seconds.
#[test]
fn the_delays_of_a_reproduction_are_those_of_its_runs() {
    let shown = by_hand(Average::RootMeanSquare);
    let delays: Vec<_> = shown.filters[0]
        .delays
        .iter()
        .map(|d| (d.time, d.detected, d.mean, d.greatest))
        .collect();
    assert_eq!(delays, [(12.0, 2, 1.0, 2.0), (16.0, 1, 0.0, 0.0)]);
    assert!(shown.filters[1].delays.is_empty(), "a filter of one mode has no turns");
    let is_true = |mode: &str| [0, 1, 2, 3].map(|k| shown.is_true(mode, k));
    assert_eq!(is_true("straight"), [true, false, false, true]);
    assert_eq!(is_true("turn"), [false, true, true, false]);
    let mut of_two_axes = shown;
    of_two_axes.motions[0] = "x: straight, y: turn";
    assert!(of_two_axes.is_true("y: turn", 0) && !of_two_axes.is_true("turn", 0));
}

/// Exact: a table asks for errors or for fit errors.
#[test]
fn a_figure_of_a_table_is_found_by_filter_and_by_what_it_is_of() {
    let shown = by_hand(Average::Mean);
    let value = |filter, figure| shown.figure(filter, figure).map(|estimate| estimate.value);
    assert_eq!(value("one", Figure::FitError), Some(1.5));
    assert_eq!(value("two", Figure::FitError), Some(4.0));
    assert_eq!(value("three", Figure::FitError), None);
    // RMSE is 2 at every step, and so is its mean.
    assert!((value("two", Figure::Error(ErrorQuantity::X)).unwrap() - 2.0).abs() < 1e-15);
    assert_eq!(value("one", Figure::Error(ErrorQuantity::Y)), Some(4.0));
    assert_eq!(value("three", Figure::Error(ErrorQuantity::X)), None);
    let labels = ErrorQuantity::ALL.map(ErrorQuantity::label);
    assert_eq!(
        labels,
        [
            "x (m)",
            "x velocity (m/s)",
            "y (m)",
            "y velocity (m/s)",
            "position (m)",
            "velocity (m/s)"
        ]
    );
}

/// Exact: where no run came to its end, or the paper has no such measure, there is no fit error.
#[test]
fn a_fit_error_is_of_completed_runs_that_have_one() {
    let simulation = ByHand {
        choices: Choices::default(),
        average: Average::RootMeanSquare,
    };
    let mut runs = run(&simulation, 2, 1, &|| ());
    let figures = |runs: &[Vec<Run>]| {
        let comparison = Comparison {
            scenario: &simulation,
            runs,
        };
        let value = |estimate: Option<Estimate>| estimate.map(|estimate| estimate.value);
        (value(comparison.fit_error(0)), value(comparison.fit_difference(0, 1)))
    };
    assert_eq!(figures(&runs), (Some(4.0), Some(2.5)));
    let failure = Failure {
        step: 4,
        mode: "turn".into(),
        value: "measurement",
        cause: Cause::MeasurementNotFinite,
    };
    runs[0][0].failure = Some(failure.clone());
    assert_eq!(figures(&runs), (Some(5.0), Some(3.0)));
    runs[1][1].failure = Some(failure.clone());
    assert_eq!(figures(&runs), (Some(5.0), None));
    runs[1][0].failure = Some(failure);
    assert_eq!(figures(&runs), (None, None));
    let mut runs = run(&simulation, 2, 1, &|| ());
    runs[1][1].fit_error = None;
    assert_eq!(figures(&runs), (Some(4.0), None));
}

/// Estimates that are the same but for some roundings.
fn assert_near(found: &[Estimate], expected: &[Estimate]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-14 * b.abs().max(1.0);
        assert!(near(found.value, expected.value), "{found:?} {expected:?}");
        // The square of a root is off by a rounding, and the spread of two such squares is its size.
        assert!(
            near(found.standard_error, expected.standard_error),
            "{found:?} {expected:?}"
        );
    }
}

// How the tests are written

fn scenario_of(paper: Paper) -> Scenario {
    paper.scenario(&Choices::default()).unwrap()
}

/// Everything of the runs but how long they took.
fn without_time(mut runs: Vec<Vec<Run>>) -> Vec<Vec<Run>> {
    for run in runs.iter_mut().flatten() {
        run.time = Duration::ZERO;
    }
    runs
}

/// A run with the given errors in x.
fn hand_made_run(errors: &[f64]) -> Run {
    Run {
        errors: errors.iter().map(|x| Vector4::new(*x, 0.0, 0.0, 0.0)).collect(),
        nees: vec![4.0; errors.len()],
        nis: vec![2.0; errors.len()],
        mode_probabilities: vec![vec![1.0, 0.0, 0.0]; errors.len()],
        fit_error: None,
        failure: None,
        time: Duration::ZERO,
    }
}

fn sample_deviation(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
    (squares / (count - 1.0)).sqrt()
}
