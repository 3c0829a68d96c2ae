//! Goal: a filter whose models are those of the truth is as good as it says, and one whose models are not is found out.
//!
//! Method: truth, measurements and initial estimate are drawn from the filter's own models (or from others), and the normalised
//! squared errors are held against what a matched filter keeps. Kind of evidence: statistical, with fixed seeds, so that each test
//! has one outcome for ever. Each bound has a stated probability of false alarm, and each wrong filter is so far outside that a
//! draw of this size would miss it less than once in a million times; how far is computed where the equations allow it, and
//! measured where they do not.
//!
//! | law                                | holds                                                                          |
//! |------------------------------------|--------------------------------------------------------------------------------|
//! | NEES and NIS are χ²                | exactly for one linear mode with Gaussian noise                                |
//! | E NEES = 4, E NIS = 2              | exactly for the mean and covariance of a posterior, whatever its shape         |
//! | P(mode j is true) = E μⱼ           | exactly for the mode probabilities of a posterior                              |
//!
//! Points on a curved measurement and merged modes approximate the posterior. What that may cost is an allowance with its reason.

use immaculate::filter::Filter;
use immaculate::filter::{kalman, update};
use immaculate::gaussian::{Gaussian, log_density, mixture_covariance, mixture_mean};
use immaculate::imm::printed::log_density_21;
use immaculate::imm::{Equations, Imm, Initial, Interaction, Problem, Step};
use immaculate::matrix::{cholesky, ldl, quadratic_form};
use immaculate::model::motion::{Mode, Motion, constant_velocity, coordinated_turn, integrated_noise};
use immaculate::model::{PolarComponent, Sensor};
use immaculate::paper::Paper;
use immaculate::paper::comparison::{Comparison, ErrorQuantity};
use immaculate::paper::monte_carlo::{Generator, run};
use immaculate::paper::specification::Choices;
use immaculate::rule::RuleName;
use immaculate::statistics::Estimate;
use immaculate::statistics::consistency::{bounds, nees, nis};
use immaculate::statistics::estimate::mean;
use nalgebra::{Matrix2, Matrix4, SMatrix, SVector, U2, U4, Vector2, Vector4, matrix};
use rayon::prelude::*;

type Model = Problem<f64, U4, U2>;
type Table = Equations<f64, U4, U2>;

/// The seed of this file; run m has stream m.
const SEED: u64 = 2016;
/// Runs of each experiment.
const RUNS: usize = 4000;
/// Steps of each run: a constant-velocity filter has settled after about ten.
const STEPS: usize = 30;
/// The probability with which a matched filter is rejected by one χ² test, half of it on either side. There are some forty.
const FALSE_ALARM: f64 = 1e-6;
/// The same in standard errors, for figures that are means of many: false alarms of 6e-7.
const STANDARD_ERRORS: f64 = 5.0;

// One linear mode: everything is exact

#[test]
fn a_matched_kalman_filter_is_as_good_as_it_says() {
    let truth = linear(1.0, 1.0);
    let cubature = with_rule(truth.clone(), &RuleName::FifthDegree);
    for (name, filter, equations) in [
        ("Kalman", &truth, Equations::standard()),
        ("cubature", &cubature, Equations::standard()),
        (
            "cubature about the origin",
            &cubature,
            Equations::standard().with_raw_moments(),
        ),
    ] {
        let outcomes = experiment(&truth, filter, &equations, RUNS);
        // Runs are independent of each other, so at any one step the sum over runs is χ².
        for k in [0, 1, 4, STEPS - 1] {
            let found = at_step(&outcomes, k, |outcome| &outcome.nees);
            assert!(is_inside(found, 4.0, RUNS), "{name}: NEES {found} at step {}", k + 1);
        }
        // Innovations of a matched filter are independent from step to step too.
        let all: Vec<f64> = outcomes.iter().flat_map(|outcome| outcome.nis.clone()).collect();
        let found = mean(&all).value;
        assert!(is_inside(found, 2.0, all.len()), "{name}: NIS {found}");
    }
    // The prediction below, for noises that are right: 4 and 2, inside.
    let (of_nees, of_nis) = moments_of_a_mismatched_filter(&truth, &truth);
    // Thirty steps of 4 × 4 matrices in doubles.
    assert!((of_nees.mean - 4.0).abs() < 1e-9 && (of_nis.mean - 2.0).abs() < 1e-9);
    assert!(of_nees.distance(4.0) < 0.0 && of_nis.distance(2.0) < 0.0);
}

#[test]
fn a_kalman_filter_with_wrong_noise_is_rejected() {
    let truth = linear(1.0, 1.0);
    for (name, filter) in [
        ("Q × 4", linear(4.0, 1.0)),
        ("Q / 4", linear(0.25, 1.0)),
        ("R × 2", linear(1.0, 2.0)),
        ("R / 2", linear(1.0, 0.5)),
    ] {
        let outcomes = experiment(&truth, &filter, &Equations::standard(), RUNS);
        let (of_nees, of_nis) = moments_of_a_mismatched_filter(&truth, &filter);
        let (nees, nis): (Values, Values) = (|outcome| &outcome.nees, |outcome| &outcome.nis);
        for (figure, degrees, expected, values) in [("NEES", 4.0, of_nees, nees), ("NIS", 2.0, of_nis, nis)] {
            let found = at_step(&outcomes, STEPS - 1, values);
            assert!(
                !is_inside(found, degrees, RUNS),
                "{name}: {figure} {found} is not found out"
            );
            // It is where the equations put it.
            let deviation = (expected.variance / RUNS as f64).sqrt();
            let off = (found - expected.mean).abs() / deviation;
            assert!(
                off < STANDARD_ERRORS,
                "{name}: {figure} {found}, expected {}",
                expected.mean
            );
            // The power: the mean over runs is Gaussian, and its expectation lies this many of its deviations outside the bounds;
            // 5.6 for the NIS of Q × 4, 10 to 46 for the others. At 5 one draw in 3 million misses it.
            assert!(expected.distance(degrees) > 5.0, "{name}: {figure}");
        }
    }
}

#[test]
fn a_filter_with_printed_weights_is_rejected() {
    let truth = linear(1.0, 1.0);
    let tracked = |rule: &RuleName, equations: &Table| {
        let filter = with_rule(truth.clone(), rule);
        experiment(&truth, &filter, equations, RUNS)
    };
    // The right rule: the error is that of the measurement, 4 to 5 m along an axis; 50 m is ten times that.
    let right = tracked(&RuleName::FifthDegree, &Equations::standard());
    assert!(
        right
            .iter()
            .all(|outcome| outcome.first_error < 50.0 && !outcome.failed)
    );

    // zhu2016 (13): the weights sum to 5/3, so the first prediction is two thirds of the target's distance too far out. The
    // deviations about it are as large and enter the covariance, which hides the error from the NEES: too careful, and useless.
    let printed = tracked(&RuleName::FifthDegreePrinted, &Equations::standard());
    assert!(
        printed.iter().all(|outcome| outcome.first_error > 100.0),
        "off the track at the first step"
    );
    assert!(!is_inside(at_step(&printed, 0, |outcome| &outcome.nees), 4.0, RUNS));
    assert!(printed.iter().all(|outcome| outcome.failed), "and it does not last");
    // About the origin, as the paper writes the covariance, 5/3 x̂x̂ᵀ − (5/3)² x̂x̂ᵀ is negative: no first step at all.
    let printed = tracked(&RuleName::FifthDegreePrinted, &Equations::standard().with_raw_moments());
    assert!(printed.iter().all(|outcome| outcome.failed && outcome.nees.is_empty()));

    // liu2017 (11) and (16): the weights sum to 4/5 and 7/10, and every prediction falls short.
    for rule in [RuleName::SimplexPrinted11, RuleName::SimplexPrinted16] {
        let printed = tracked(&rule, &Equations::standard());
        let found = at_step(&printed, STEPS - 1, |outcome| &outcome.nees);
        // Measured 64 and 110, where 4.2 is the bound.
        assert!(found > 40.0, "{rule:?}: NEES {found}");
    }
}

// Range and bearing

#[test]
fn a_matched_cubature_filter_is_as_good_as_it_says() {
    // 15 km away, the bearing's 2 mrad are 30 m across: the circle bends by 30²/30 000 = 0.03 m over that width, a thousandth of
    // the range's deviation. What the points miss of it moves a mean NEES by far less than its standard error of 0.02.
    let truth = range_bearing(1.0, 1.0);
    for rule in [
        RuleName::ThirdDegree,
        RuleName::Unscented(None),
        RuleName::FifthDegree,
        RuleName::Simplex,
        RuleName::GaussHermite(3),
    ] {
        let outcomes = experiment(&truth, &with_rule(truth.clone(), &rule), &Equations::standard(), RUNS);
        for k in [0, 1, 4, STEPS - 1] {
            let found = at_step(&outcomes, k, |outcome| &outcome.nees);
            assert!(is_inside(found, 4.0, RUNS), "{rule:?}: NEES {found} at step {}", k + 1);
        }
        let all: Vec<f64> = outcomes.iter().flat_map(|outcome| outcome.nis.clone()).collect();
        let found = mean(&all).value;
        assert!(is_inside(found, 2.0, all.len()), "{rule:?}: NIS {found}");
    }
}

#[test]
fn a_cubature_filter_with_wrong_noise_is_rejected() {
    let truth = range_bearing(1.0, 1.0);
    // Mean NEES over all steps as measured: 2.93, 6.78, 2.81, 6.44, with standard errors of 0.05 at most.
    for (name, filter) in [
        ("Q × 4", range_bearing(4.0, 1.0)),
        ("Q / 4", range_bearing(0.25, 1.0)),
        ("R × 2", range_bearing(1.0, 2.0)),
        ("R / 2", range_bearing(1.0, 0.5)),
    ] {
        let filter = with_rule(filter, &RuleName::FifthDegree);
        let outcomes = experiment(&truth, &filter, &Equations::standard(), RUNS);
        let figure = Figure::new("NEES", 4.0, 0.0, over_runs(&outcomes, |outcome| &outcome.nees));
        // So far beyond the bound that another draw would be outside as well, but for one in 700: three standard errors more.
        assert!(figure.excess() > STANDARD_ERRORS + 3.0, "{name}: {figure:?}");
    }
}

// Several modes: the truth switches by the chain of the filter

#[test]
fn the_first_step_of_the_cycle_is_exact_and_merging_costs_little_later() {
    // The exact posterior has a Gaussian for every history of modes, 3⁵ after five steps.
    const SHORT: usize = 5;
    let truth = switching(linear(1.0, 1.0));
    let runs: Vec<_> = (0..RUNS)
        .into_par_iter()
        .map(|run| {
            let draw = draw(&truth, SHORT, &mut Generator::new(SEED, run as u64));
            let exact = exact_posteriors(&truth, &draw);
            let mut imm = Imm::new(truth.clone(), &draw.initial).unwrap();
            let merged: Vec<_> = draw
                .measurements
                .iter()
                .map(|z| imm.step(Some(z)).unwrap().clone())
                .collect();
            (draw, exact, merged)
        })
        .collect();
    for (_, exact, merged) in &runs {
        // All modes start from one estimate, so nothing is merged before the first measurement. Rounding: a dozen operations at
        // 10⁴ m is 10⁻¹¹ m.
        let difference = (exact[0].combined.mean - merged[0].combined.mean).abs().max();
        assert!(difference < 1e-9, "{difference} m");
        for (p, q) in exact[0].mode_probabilities.iter().zip(&merged[0].mode_probabilities) {
            assert!((p - q).abs() < 1e-9, "{p} {q}");
        }
    }
    let of_step = |k: usize, merged_too: bool| -> Vec<f64> {
        let value = |(draw, exact, merged): &Run| {
            let combined = if merged_too {
                &merged[k].combined
            } else {
                &exact[k].combined
            };
            nees(combined, &draw.states[k])
        };
        runs.iter().map(value).collect()
    };
    for k in 0..SHORT {
        let exact = Figure::new("NEES of the exact posterior", 4.0, 0.0, mean(&of_step(k, false)));
        assert!(exact.excess() < STANDARD_ERRORS, "step {}: {exact:?}", k + 1);
    }
    let last = SHORT - 1;
    let pairs = of_step(last, true).into_iter().zip(of_step(last, false));
    let differences: Vec<f64> = pairs.map(|(merged, exact)| merged - exact).collect();
    // Run by run they do differ; in the mean by less than a hundredth.
    let cost = Figure::new("NEES, merged minus exact", 0.0, 0.04, mean(&differences));
    assert!(
        differences.iter().any(|difference| difference.abs() > 0.01),
        "something was merged"
    );
    assert!(cost.excess() < STANDARD_ERRORS, "{cost:?}");
}

#[test]
fn an_imm_filter_whose_chain_is_that_of_the_truth_is_nearly_as_good_as_it_says() {
    // Allowances: what merging costs over thirty steps, measured with 40 000 runs and doubled. NEES 3.950 ± 0.005 and 3.850 ± 0.006,
    // NIS 2.004 ± 0.002 and 1.976 ± 0.002, probabilities off by 0.0023 and 0.0038.
    let linear = switching(linear(1.0, 1.0));
    let polar = with_rule(switching(range_bearing(1.0, 1.0)), &RuleName::FifthDegree);
    for (name, model, equations, allowed) in [
        ("linear", &linear, Equations::standard(), LINEAR),
        ("range and bearing", &polar, Equations::standard(), RANGE_BEARING),
    ] {
        let outcomes = experiment(model, model, &equations, RUNS);
        for figure in figures(&outcomes, allowed) {
            assert!(figure.excess() < STANDARD_ERRORS, "{name}: {figure:?}");
        }
    }
}

#[test]
fn an_imm_filter_without_a_part_of_its_equations_is_rejected() {
    let linear = switching(linear(1.0, 1.0));
    let polar = with_rule(switching(range_bearing(1.0, 1.0)), &RuleName::FifthDegree);
    for (measurement, model, right, allowed) in [
        ("linear", &linear, Equations::standard(), LINEAR),
        ("range and bearing", &polar, Equations::standard(), RANGE_BEARING),
    ] {
        let of_right = experiment(model, model, &right, RUNS);
        for (name, telling, equations) in variants(&right) {
            let outcomes = experiment(model, model, &equations, RUNS);
            let mut found = figures(&outcomes, allowed);
            // The probabilities of a posterior have the least expected Brier score there is, on the same draws.
            let pairs = outcomes.iter().zip(&of_right);
            let worse: Vec<f64> = pairs.map(|(variant, right)| variant.brier - right.brier).collect();
            found.push(Figure::new("Brier score, minus the right one", 0.0, 0.0, mean(&worse)));
            let telling = found.iter().find(|figure| figure.name == telling).unwrap();
            // So far beyond the bound that another draw would be outside as well, but for one in 700: three standard errors more.
            assert!(
                telling.excess() > STANDARD_ERRORS + 3.0,
                "{measurement}, {name}: {found:?}"
            );
        }
    }
}

/// Tables with an equation exchanged, and the figure that tells.
fn variants(right: &Table) -> [(&'static str, &'static str, Table); 5] {
    [
        (
            "mixed without the spread of the means",
            "NEES",
            Equations {
                mixed_covariance: |_, previous, now, j| without_spread(&now.mixing_probabilities[j], &previous.updated),
                ..*right
            },
        ),
        (
            "combined without the spread of the means",
            "NEES",
            Equations {
                combined_covariance: |_, _, now, _| without_spread(&now.mode_probabilities, &now.updated),
                ..*right
            },
        ),
        (
            "not mixed",
            "NEES",
            Equations {
                mixing_probabilities: |problem, _, _, j| (0..problem.modes.len()).map(|i| f64::from(i == j)).collect(),
                ..*right
            },
        ),
        (
            // Nothing is charged for a large S any more: it favours the modes of much noise.
            "likelihood without |S|",
            "Brier score, minus the right one",
            Equations {
                log_likelihood: |_, _, now, j| {
                    quadratic_form(&ldl(&now.innovation_covariances[j]), &now.innovations[j]) / -2.0
                },
                ..*right
            },
        ),
        (
            // A large S is charged for twice: it favours the mode of little noise.
            "likelihood as printed in liu2017 (21)",
            "Brier score, minus the right one",
            Equations {
                log_likelihood: |_, _, now, j| {
                    log_density_21(&now.innovations[j], &ldl(&now.innovation_covariances[j]))
                },
                ..*right
            },
        ),
    ]
}

// Pairing

#[test]
fn pairing_removes_the_noise_that_two_filters_share() {
    let compared = |paper: Paper, pairing: &str, a: usize, b: usize| {
        let scenario = paper.scenario(&Choices::of("pairing", pairing)).unwrap();
        let runs = run(&scenario, 50, 1, &|| ());
        let comparison = Comparison {
            scenario: &scenario,
            runs: &runs,
        };
        let [of_a, of_b] = [a, b].map(|filter| comparison.error(filter, ErrorQuantity::Position));
        (of_a, of_b, comparison.difference(a, b, ErrorQuantity::Position))
    };
    // liu2017's third-degree and fifth-degree filters: errors of 70 m that differ by less than a millimetre.
    let (_, _, paired) = compared(Paper::Liu2017, "paired", 1, 2);
    let (of_a, of_b, unpaired) = compared(Paper::Liu2017, "unpaired", 1, 2);
    assert!(
        paired.standard_error < 1e-4 * unpaired.standard_error,
        "{paired:?} {unpaired:?}"
    );
    assert!(
        unpaired.value.abs() > 100.0 * paired.value.abs(),
        "what unpaired runs show is chance"
    );
    // Without pairing the variances add, but for a sample's chance correlation of about 1/√50 = 0.14.
    let added = of_a.standard_error.hypot(of_b.standard_error);
    assert!(
        (unpaired.standard_error / added - 1.0).abs() < 0.3,
        "{unpaired:?} {added}"
    );

    // zhu2016's fifth-degree filter against the single one: a difference that is real, and surer in pairs.
    let (of_a, of_b, paired) = compared(Paper::Zhu2016, "paired", 0, 3);
    let added = of_a.standard_error.hypot(of_b.standard_error);
    assert!(paired.standard_error < 0.8 * added, "{paired:?} {added}");
}

// Truths and filters

/// A truth of one linear mode, or a filter that believes in other noises: factors of Q and R.
fn linear(noise_factor: f64, measurement_factor: f64) -> Model {
    Problem {
        modes: vec![Mode {
            name: "constant velocity".into(),
            motion: Motion::Linear(constant_velocity(&1.0)),
            noise: integrated_noise(&(0.5 * noise_factor), &1.0),
        }],
        chain: vec![vec![1.0]],
        sensor: Sensor::Linear(matrix![1.0, 0.0, 0.0, 0.0; 0.0, 0.0, 1.0, 0.0]),
        measurement_noise: matrix![25.0, 5.0; 5.0, 16.0] * measurement_factor,
        filters: vec![Filter::kalman()],
        interaction: Interaction::Imm,
        angles: vec![],
    }
}

/// The same target seen in range and bearing: 20 m and 2 mrad, at 15 km.
fn range_bearing(noise_factor: f64, measurement_factor: f64) -> Model {
    Problem {
        sensor: Sensor::Polar {
            components: vec![PolarComponent::Range, PolarComponent::Bearing],
            position: [0, 2],
            location: [0.0, 0.0],
        },
        measurement_noise: matrix![400.0, 0.0; 0.0, 4e-6] * measurement_factor,
        ..linear(noise_factor, 1.0)
    }
}

/// The same, with a target that is quiet or turns to either side.
fn switching(single: Model) -> Model {
    let mode = |name: &str, transition: Matrix4<f64>, density: f64| Mode {
        name: name.into(),
        motion: Motion::Linear(transition),
        noise: integrated_noise(&density, &1.0),
    };
    Problem {
        modes: vec![
            mode("constant velocity", constant_velocity(&1.0), 0.1),
            mode("left turn", coordinated_turn(&0.1, &1.0), 4.0),
            mode("right turn", coordinated_turn(&-0.1, &1.0), 4.0),
        ],
        chain: vec![vec![0.9, 0.05, 0.05], vec![0.1, 0.85, 0.05], vec![0.1, 0.05, 0.85]],
        ..single
    }
}

fn with_rule(problem: Model, rule: &RuleName) -> Model {
    Problem {
        filters: vec![Filter::points(rule.rule().unwrap())],
        ..problem
    }
}

/// Where every run starts, and how well it is known.
fn start() -> Gaussian<f64, U4> {
    Gaussian {
        mean: Vector4::new(12_000.0, -100.0, 9_000.0, 150.0),
        covariance: Matrix4::from_diagonal(&Vector4::new(2500.0, 100.0, 2500.0, 100.0)),
    }
}

/// What the tests keep of a run.
struct Outcome {
    /// NEES, one a step.
    nees: Vec<f64>,
    /// NIS, one a step.
    nis: Vec<f64>,
    /// For each mode: the part of the steps in which it was the true one, minus its mean probability.
    surplus: Vec<f64>,
    /// The mean over steps of Σⱼ (1 if mode j is true else 0, minus μⱼ)².
    brier: f64,
    /// The position error at the first step, m; infinite when that could not be computed.
    first_error: f64,
    /// Whether a step could not be computed.
    failed: bool,
}

/// One run's truth, measurements and first estimate.
struct Draw {
    modes: Vec<usize>,
    states: Vec<Vector4<f64>>,
    measurements: Vec<Vector2<f64>>,
    initial: Initial<f64, U4>,
}

/// Runs of a filter on draws from a truth.
fn experiment(truth: &Model, filter: &Model, equations: &Table, runs: usize) -> Vec<Outcome> {
    let one_run = |run| tracked(filter, equations, &draw(truth, STEPS, &mut Generator::new(SEED, run)));
    (0..runs as u64).into_par_iter().map(one_run).collect()
}

/// A target that moves and switches as the model says, and a first estimate that is off by its own covariance.
fn draw(truth: &Model, steps: usize, generator: &mut Generator) -> Draw {
    let start = start();
    let equal = vec![1.0 / truth.modes.len() as f64; truth.modes.len()];
    let estimate = Gaussian {
        mean: start.mean + normal(&start.covariance, generator),
        covariance: start.covariance,
    };
    let mut draw = Draw {
        modes: Vec::new(),
        states: Vec::new(),
        measurements: Vec::new(),
        initial: Initial {
            modes: vec![estimate; truth.modes.len()],
            mode_probabilities: equal.clone(),
        },
    };
    let mut mode = chosen(&equal, generator);
    let mut state = start.mean;
    for _ in 0..steps {
        mode = chosen(&truth.chain[mode], generator);
        state = truth.modes[mode].motion.of(&state) + normal(&truth.modes[mode].noise, generator);
        let noise = normal(&truth.measurement_noise, generator);
        draw.modes.push(mode);
        draw.states.push(state);
        draw.measurements.push(truth.sensor.of(&state) + noise);
    }
    draw
}

/// A filter on a draw, to its end or to the first step that cannot be computed.
fn tracked(filter: &Model, equations: &Table, draw: &Draw) -> Outcome {
    let mut imm = Imm::with_equations(filter.clone(), *equations, &draw.initial).unwrap();
    let mut outcome = Outcome {
        nees: Vec::new(),
        nis: Vec::new(),
        surplus: vec![0.0; filter.modes.len()],
        brier: 0.0,
        first_error: f64::INFINITY,
        failed: false,
    };
    for (k, state) in draw.states.iter().enumerate() {
        let Ok(step) = imm.step(Some(&draw.measurements[k])) else {
            outcome.failed = true;
            break;
        };
        outcome.nees.push(nees(&step.combined, state));
        outcome.nis.extend(nis(step));
        for (j, probability) in step.mode_probabilities.iter().enumerate() {
            let surplus = f64::from(j == draw.modes[k]) - probability;
            outcome.surplus[j] += surplus / draw.states.len() as f64;
            outcome.brier += surplus * surplus / draw.states.len() as f64;
        }
        if k == 0 {
            let error = step.combined.mean - state;
            outcome.first_error = error[0].hypot(error[2]);
        }
    }
    outcome
}

/// A draw, its exact posteriors, and the steps of the filter.
type Run = (Draw, Vec<Posterior>, Vec<Step<f64, U4, U2>>);

/// The exact posterior after a step: mean and covariance of the whole mixture, and the probabilities of the modes.
struct Posterior {
    combined: Gaussian<f64, U4>,
    mode_probabilities: Vec<f64>,
}

/// The exact posteriors after each step of a short draw: one Kalman filter for every history of modes, none merged.
fn exact_posteriors(truth: &Model, draw: &Draw) -> Vec<Posterior> {
    let h = truth.h();
    let initial = &draw.initial;
    // Logarithm of the weight, last mode, estimate.
    let mut histories: Vec<(f64, usize, Gaussian<f64, U4>)> = (0..truth.modes.len())
        .map(|i| (initial.mode_probabilities[i].ln(), i, initial.modes[i].clone()))
        .collect();
    let mut posteriors = Vec::new();
    for z in &draw.measurements {
        let mut longer = Vec::new();
        for (weight, i, estimate) in &histories {
            for (j, mode) in truth.modes.iter().enumerate() {
                let predicted = kalman::predicted_mean(&mode.motion.matrix(), &estimate.mean);
                let covariance = kalman::predicted_covariance(&mode.motion.matrix(), &estimate.covariance, &mode.noise);
                let s = kalman::innovation_covariance(&h, &covariance, &truth.measurement_noise);
                let gain = update::gain(&kalman::cross_covariance(&covariance, &h), &ldl(&s));
                let innovation = z - h.as_ref() * predicted;
                let updated = Gaussian {
                    mean: update::updated_mean(&predicted, &gain, &innovation),
                    covariance: covariance - gain * s * gain.transpose(),
                };
                let weight = weight + truth.chain[*i][j].ln() + log_density(&innovation, &ldl(&s));
                longer.push((weight, j, updated));
            }
        }
        histories = longer;
        posteriors.push(posterior(&histories, truth.modes.len()));
    }
    posteriors
}

fn posterior(histories: &[(f64, usize, Gaussian<f64, U4>)], modes: usize) -> Posterior {
    let greatest = histories
        .iter()
        .map(|history| history.0)
        .fold(f64::NEG_INFINITY, f64::max);
    let unscaled: Vec<f64> = histories.iter().map(|history| (history.0 - greatest).exp()).collect();
    let sum: f64 = unscaled.iter().sum();
    let weights: Vec<f64> = unscaled.iter().map(|weight| weight / sum).collect();
    let estimates: Vec<_> = histories.iter().map(|history| history.2.clone()).collect();
    let mean = mixture_mean(&weights, &estimates);
    let of_mode = |j: usize| {
        let pairs = histories.iter().zip(&weights).filter(|(history, _)| history.1 == j);
        pairs.map(|(_, weight)| weight).sum()
    };
    Posterior {
        combined: Gaussian {
            covariance: mixture_covariance(&weights, &estimates, &mean),
            mean,
        },
        mode_probabilities: (0..modes).map(of_mode).collect(),
    }
}

/// An index drawn with these probabilities.
fn chosen(probabilities: &[f64], generator: &mut Generator) -> usize {
    let u = generator.uniform();
    let mut sum = 0.0;
    let below = probabilities.iter().position(|probability| {
        sum += probability;
        u <= sum
    });
    below.unwrap_or(probabilities.len() - 1)
}

/// A draw of N(0, P).
fn normal<const D: usize>(covariance: &SMatrix<f64, D, D>, generator: &mut Generator) -> SVector<f64, D> {
    cholesky(covariance).unwrap() * SVector::from_fn(|_, _| generator.standard_normal())
}

// Figures and their bounds

/// Values of a run, one a step.
type Values = fn(&Outcome) -> &Vec<f64>;

/// The mean over the runs that reached a step, counted from 0.
fn at_step(outcomes: &[Outcome], k: usize, values: Values) -> f64 {
    let reached = outcomes.iter().filter_map(|outcome| values(outcome).get(k).copied());
    mean(&reached.collect::<Vec<_>>()).value
}

/// The mean over steps and runs, with its standard error from run to run.
fn over_runs(outcomes: &[Outcome], values: Values) -> Estimate {
    let of_run = |outcome: &Outcome| mean(values(outcome)).value;
    mean(&outcomes.iter().map(of_run).collect::<Vec<_>>())
}

/// A figure beside its expectation.
#[derive(Debug)]
struct Figure {
    name: String,
    expected: f64,
    allowance: f64,
    found: Estimate,
}

impl Figure {
    fn new(name: &str, expected: f64, allowance: f64, found: Estimate) -> Self {
        Self {
            name: name.to_owned(),
            expected,
            allowance,
            found,
        }
    }

    /// How many standard errors the figure is off beyond what is allowed.
    fn excess(&self) -> f64 {
        ((self.found.value - self.expected).abs() - self.allowance) / self.found.standard_error
    }
}

/// What an approximation may cost: in NEES, in NIS, in the probability of a mode.
type Allowance = [f64; 3];
const LINEAR: Allowance = [0.1, 0.01, 0.005];
const RANGE_BEARING: Allowance = [0.3, 0.05, 0.008];

/// All figures that a right filter keeps.
fn figures(outcomes: &[Outcome], [of_nees, of_nis, of_probability]: Allowance) -> Vec<Figure> {
    let mut figures = vec![
        Figure::new("NEES", 4.0, of_nees, over_runs(outcomes, |outcome| &outcome.nees)),
        Figure::new("NIS", 2.0, of_nis, over_runs(outcomes, |outcome| &outcome.nis)),
    ];
    for j in 0..outcomes[0].surplus.len() {
        let surplus: Vec<f64> = outcomes.iter().map(|outcome| outcome.surplus[j]).collect();
        let name = format!("probability of mode {}", j + 1);
        figures.push(Figure::new(&name, 0.0, of_probability, mean(&surplus)));
    }
    figures
}

fn is_inside(found: f64, degrees: f64, count: usize) -> bool {
    let (low, high) = bounds(degrees, count, FALSE_ALARM);
    (low..=high).contains(&found)
}

/// Mean and variance of a squared distance of Gaussian errors.
struct Moments {
    mean: f64,
    variance: f64,
}

impl Moments {
    /// Of vᵀ P⁻¹ v for v ~ N(0, Σ): tr P⁻¹Σ and 2 tr (P⁻¹Σ)².
    fn of<const D: usize>(claimed: &SMatrix<f64, D, D>, actual: &SMatrix<f64, D, D>) -> Self
    where
        nalgebra::Const<D>: nalgebra::DimMin<nalgebra::Const<D>, Output = nalgebra::Const<D>>,
    {
        let ratio = claimed.try_inverse().unwrap() * actual;
        Self {
            mean: ratio.trace(),
            variance: 2.0 * (ratio * ratio).trace(),
        }
    }

    /// How many standard deviations of a mean over all runs lie between its expectation and the nearest bound.
    fn distance(&self, degrees: f64) -> f64 {
        let (low, high) = bounds(degrees, RUNS, FALSE_ALARM);
        let outside = (low - self.mean).max(self.mean - high);
        outside / (self.variance / RUNS as f64).sqrt()
    }
}

/// NEES and NIS at the last step of a Kalman filter whose noises are not those of the truth, from the covariance that its errors
/// really have: with gain W, Σ = (I − W H)(F Σ Fᵀ + Q)(I − W H)ᵀ + W R Wᵀ with the true Q and R.
fn moments_of_a_mismatched_filter(truth: &Model, filter: &Model) -> (Moments, Moments) {
    let Sensor::Linear(h) = &truth.sensor else {
        panic!("a linear measurement");
    };
    let f = &*truth.modes[0].motion.matrix();
    let (mut claimed, mut actual) = (start().covariance, start().covariance);
    let (mut claimed_innovation, mut actual_innovation) = (Matrix2::zeros(), Matrix2::zeros());
    for _ in 0..STEPS {
        claimed = f * claimed * f.transpose() + filter.modes[0].noise;
        actual = f * actual * f.transpose() + truth.modes[0].noise;
        claimed_innovation = h * claimed * h.transpose() + filter.measurement_noise;
        actual_innovation = h * actual * h.transpose() + truth.measurement_noise;
        let gain = claimed * h.transpose() * claimed_innovation.try_inverse().unwrap();
        let rest = Matrix4::identity() - gain * h;
        claimed = rest * claimed;
        actual = rest * actual * rest.transpose() + gain * truth.measurement_noise * gain.transpose();
    }
    (
        Moments::of(&claimed, &actual),
        Moments::of(&claimed_innovation, &actual_innovation),
    )
}

/// A mixture's covariance without the spread of the means.
fn without_spread(weights: &[f64], components: &[Gaussian<f64, U4>]) -> Matrix4<f64> {
    let centred: Vec<_> = components
        .iter()
        .map(|component| Gaussian {
            mean: Vector4::zeros(),
            covariance: component.covariance,
        })
        .collect();
    mixture_covariance(weights, &centred, &Vector4::zeros())
}
