//! Goal: what derbez2000 says of a filter's long-term error, of moment matching and of the cost of the filters is true, or is refuted by
//! an instance.
//!
//! Method: identities on rational functions, and on dual numbers over them for expansions (symbolic); exact rational instances where a
//! claim fails (exact); runs with a named generator and seed, against quantiles with a stated false-alarm probability (statistics).
//! Kind of evidence: stated with each test.

// Doubles are compared exactly where they are given or rounded.
#![allow(clippy::float_cmp)]

use immaculate::filter::kalman::predicted_covariance;
use immaculate::matrix::{check_positive_definite, ldl};
use immaculate::model::acceleration::{
    acceleration_response, constant_acceleration, embedded_constant_velocity, embedded_velocity_response,
    position_matrix, response_noise,
};
use immaculate::number::{Dual, Field, Rational, RationalFunction};
use immaculate::paper::monte_carlo::Generator;
use immaculate::paper::operations::{CovarianceUpdate, OneCoordinate, Sums};
use immaculate::report::long_term::{Panel, heat_maps};
use immaculate::steady::gains;
use immaculate::steady::linear::stein;
use immaculate::steady::long_term::{Form as Algorithm, JointErrors, LongTerm, Setting, predict};
use immaculate::steady::mismatch::{
    Mismatch, alpha_beta_innovation, alpha_beta_lag, alpha_beta_scatter, inverse, motion_missed,
};
use immaculate::steady::perturbation::{
    Perturbation, other_mode_weight, printed_spread_bound, printed_weight, second_moment, spread_bound, spread_term,
};
use immaculate::steady::polynomial::{has_radius_below, rows_of};
use immaculate::steady::riccati::{NoSteadyState, Riccati, SteadyState};
use immaculate::steady::simulated::{Grid, POINTS, Simulated, Start, simulate};
use immaculate::steady::unrolled::{FilterStep, recursion, unrolled, unrolled_as_printed};
use nalgebra::{Matrix1, Matrix2, Matrix3, SMatrix, SVector, Vector1, Vector2, Vector3};
use num_traits::{One, Zero};
use statrs::distribution::{ChiSquared, ContinuousCDF};

type Unknown = RationalFunction;

fn unknown(name: &str) -> Unknown {
    Unknown::unknown(name)
}

fn rational(text: &str) -> Rational {
    let (p, q) = text.split_once('/').unwrap_or((text, "1"));
    Rational::from_decimal(p).unwrap() / Rational::from_decimal(q).unwrap()
}

/// A symmetric matrix of unknowns.
fn symmetric(name: &str) -> Matrix3<Unknown> {
    Matrix3::from_fn(|i, j| unknown(&format!("{name}{}{}", i.min(j), i.max(j))))
}

// Moment matching as a perturbation

/// The perturbation of a filter of constant acceleration, all of whose numbers are unknown.
fn perturbation() -> Perturbation<Unknown, 3> {
    Perturbation {
        transition: constant_acceleration(&unknown("t")),
        measurement: position_matrix(),
        measurement_variance: unknown("R"),
        predicted: symmetric("P"),
        change: symmetric("D"),
    }
}

fn as_dual(problem: &Perturbation<Unknown, 3>) -> Perturbation<Dual<Unknown>, 3> {
    let constant = |entry: Unknown| Dual::constant(entry);
    Perturbation {
        transition: problem.transition.clone().map(constant),
        measurement: problem.measurement.clone().map(constant),
        measurement_variance: constant(problem.measurement_variance.clone()),
        predicted: problem.predicted.clone().map(constant),
        change: problem.change.clone().map(constant),
    }
}

#[test]
fn the_expansion_of_the_closed_loop_is_its_derivative() {
    // Symbolic, for all P⁻, ΔP, R and t: both sides are run on ε itself.
    let problem = perturbation();
    let dual = as_dual(&problem);
    let epsilon = Dual::variable(Unknown::zero());
    let moved = dual.closed_loop(&epsilon);
    let slope = moved.map(|entry| entry.slope().clone());
    assert_eq!(slope, problem.first_order());
    assert_eq!(
        moved.map(|entry| entry.value().clone()),
        problem.closed_loop(&Unknown::zero())
    );
    // As printed, with ε in one denominator: the same to first order, and not beyond.
    assert_eq!(dual.printed_expansion(&epsilon), moved);
    assert_eq!(dual.exact_expansion(&epsilon), moved);
    let small = Perturbation {
        transition: constant_acceleration(&Unknown::one()),
        predicted: Matrix3::identity(),
        change: Matrix3::identity() * unknown("d"),
        ..problem
    };
    let epsilon = unknown("e");
    assert_eq!(small.exact_expansion(&epsilon), small.closed_loop(&epsilon));
    assert_ne!(small.printed_expansion(&epsilon), small.closed_loop(&epsilon));
    // What the printed form is off by, beyond the first order: K δ H F with 1/S for 1/(S + εδ), δ = (F ΔP Fᵀ)₁₁.
    let denominator = |epsilon: Unknown| {
        let moved = &small.predicted + small.predicted_change() * epsilon;
        Unknown::one() / (moved[(0, 0)].clone() + small.measurement_variance.clone())
    };
    let here = denominator(Unknown::zero());
    let along_gain = &small.predicted * small.measurement.transpose() * here.clone() * &small.measurement;
    let along_gain = along_gain * &small.transition * small.predicted_change()[(0, 0)].clone();
    let off = along_gain * (epsilon.clone() * (here - denominator(epsilon.clone())));
    assert_eq!(small.printed_expansion(&epsilon), small.exact_expansion(&epsilon) + off);
}

#[test]
fn the_perturbed_closed_loop_is_that_of_the_moved_covariance() {
    // Symbolic: ΔP is carried through the prediction as a covariance is, and the gain is the Kalman gain of what comes out.
    let (problem, epsilon) = (perturbation(), unknown("e"));
    let filter = Riccati {
        transition: problem.transition.clone(),
        measurement: problem.measurement.clone(),
        noise: Matrix3::zeros(),
        measurement_noise: Matrix1::new(problem.measurement_variance.clone()),
    };
    let change = predicted_covariance(&problem.transition, &problem.change, &filter.noise);
    assert_eq!(problem.predicted_change(), change);
    let moved = &problem.predicted + change * epsilon.clone();
    assert_eq!(problem.closed_loop(&epsilon), filter.closed_loop(&filter.gain(&moved)));
}

#[test]
fn the_spread_of_two_means_is_that_of_their_gap() {
    // Symbolic: for each i, and summed over both.
    let mean = |name: &str| Vector2::new(unknown(&format!("{name}0")), unknown(&format!("{name}1")));
    let (first, second, weight) = (mean("x"), mean("y"), unknown("w"));
    let rest = Unknown::one() - weight.clone();
    let mixed = &first * rest.clone() + &second * weight.clone();
    let gap = &first - &second;
    let gap = &gap * gap.transpose();
    let spread = |mean: &Vector2<Unknown>| {
        let deviation = mean - &mixed;
        &deviation * deviation.transpose()
    };
    assert_eq!(spread(&first), spread_term(&weight, &gap));
    assert_eq!(spread(&second), spread_term(&rest, &gap));
    let together = spread(&first) * rest.clone() + spread(&second) * weight.clone();
    assert_eq!(together, gap * (rest * weight));
}

#[test]
fn twice_both_errors_bound_the_spread() {
    // Symbolic: what is left over is the square of the sum, so it is positive semidefinite.
    let error = |name: &str| Vector2::new(unknown(&format!("{name}0")), unknown(&format!("{name}1")));
    let (e, f, weight) = (error("e"), error("f"), unknown("w"));
    let square = |v: &Vector2<Unknown>| v * v.transpose();
    let bound = spread_bound(&weight, [&square(&e), &square(&f)]);
    let left_over = bound - spread_term(&weight, &square(&(&e - &f)));
    assert_eq!(left_over, spread_term(&weight, &square(&(e + f))));
}

/// Two filters with fixed gains and constant mode probabilities ("we may treat the μ's as constant") on a target of constant
/// acceleration: the second moments of their errors, together.
struct Pair {
    /// `mixing[j][i]`.
    mixing: [Vec<Rational>; 2],
    /// The second moment of (e¹, e²).
    moment: SMatrix<Rational, 6, 6>,
}

impl Pair {
    /// With damping root θ of both filters, probability μ of constant velocity, acceleration a; t = 1 and R = 1.
    fn new(root: &Rational, probability: &Rational, acceleration: &Rational, mixes: bool) -> Self {
        let (one, stay) = (Rational::one(), rational("0.95"));
        let other = Rational::one() - probability.clone();
        let mixing = if mixes {
            let to_second = other_mode_weight(&stay, probability);
            let to_first = other_mode_weight(&stay, &other);
            [
                vec![&one - &to_first, to_first],
                vec![to_second.clone(), &one - &to_second],
            ]
        } else {
            [vec![one.clone(), Rational::zero()], vec![Rational::zero(), one.clone()]]
        };
        let gains = [
            gains::alpha_beta_gain(root, &one),
            gains::alpha_beta_gamma_gain(root, &one),
        ];
        let motions = [embedded_constant_velocity(&one), constant_acceleration(&one)];
        let missed = [motion_missed(acceleration, &one), Vector3::zeros()];
        let (mut a, mut b, mut k) = (
            SMatrix::<Rational, 6, 6>::zeros(),
            SVector::<Rational, 6>::zeros(),
            SVector::<Rational, 6>::zeros(),
        );
        for j in 0..2 {
            let filter = Mismatch::new(
                &motions[j],
                &position_matrix(),
                gains[j].clone(),
                &missed[j],
                one.clone(),
            );
            for (i, weight) in mixing[j].iter().enumerate() {
                let block = &filter.closed_loop * weight.clone();
                a.fixed_view_mut::<3, 3>(3 * j, 3 * i).copy_from(&block);
            }
            b.fixed_rows_mut::<3>(3 * j).copy_from(&filter.missed);
            k.fixed_rows_mut::<3>(3 * j).copy_from(&filter.gain);
        }
        // The moments exist.
        assert_eq!(has_radius_below(&rows_of(&a), &one), Some(true));
        let mean = settle(&a, &b);
        let covariance = stein(&a, &(&k * k.transpose())).unwrap();
        Self {
            mixing,
            moment: second_moment(&mean, &covariance),
        }
    }

    fn block(&self, i: usize, j: usize) -> Matrix3<Rational> {
        self.moment.fixed_view::<3, 3>(3 * i, 3 * j).into_owned()
    }

    /// Pᵉ of both.
    fn errors(&self) -> [Matrix3<Rational>; 2] {
        [self.block(0, 0), self.block(1, 1)]
    }

    /// D.
    fn gap(&self) -> Matrix3<Rational> {
        self.block(0, 0) + self.block(1, 1) - self.block(0, 1) - self.block(1, 0)
    }
}

fn settle(a: &SMatrix<Rational, 6, 6>, b: &SVector<Rational, 6>) -> SVector<Rational, 6> {
    let rest = SMatrix::<Rational, 6, 6>::identity() - a;
    let solved = immaculate::steady::linear::solve(rows_of(&rest), rows_of(b)).unwrap();
    SVector::from_fn(|i, _| solved[i][0].clone())
}

/// Whether A ⪯ B, decided exactly; a difference of no full rank does not occur here.
fn is_below(a: &Matrix3<Rational>, b: &Matrix3<Rational>) -> bool {
    check_positive_definite(&ldl(&(b - a))).is_ok()
}

#[test]
fn the_printed_bound_of_the_spread_fails() {
    // Exact. Both modes equally likely, a symmetric chain with a = .95, and the paper's own target with an acceleration of 10.
    let half = rational("1/2");
    for mixes in [true, false] {
        let pair = Pair::new(&half, &half, &rational("10"), mixes);
        let (errors, gap) = (pair.errors(), pair.gap());
        // μⁱ∣ʲ as `[j][i]`. Filters that are not mixed are weighed the same way.
        let (own, other) = (rational("0.95"), rational("0.05"));
        let mixing = [vec![own.clone(), other.clone()], vec![other, own]];
        assert!(!mixes || pair.mixing == mixing);
        let spread = |i: usize, j: usize| spread_term(&mixing[j][1 - i], &gap);
        let printed = |i: usize| printed_spread_bound(&mixing, &errors, i);
        // Mode i = constant velocity: the small error stands for the large gap, and already the variance of the position is above.
        for j in 0..2 {
            let (spread, printed) = (spread(0, j)[(0, 0)].clone(), printed(0)[(0, 0)].clone());
            assert!(spread > printed.clone() * Rational::integer(10), "{spread} {printed}");
        }
        // Mode i = constant acceleration: in the mixture of its own mode the variance of the position is within the bound, and another
        // direction is not. In the sense of matrices the claim fails for both modes and both mixtures.
        assert!(spread(1, 1)[(0, 0)] < printed(1)[(0, 0)]);
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            assert!(!is_below(&spread(i, j), &printed(i)), "{i} {j}");
        }
        // In the mixture of the other mode its weight is the large one, .95, and the bound has the small one.
        assert!(spread(1, 0)[(0, 0)] > printed(1)[(0, 0)]);
        // The sum over i, what the mixture really adds, is above its bound for both mixtures.
        for (j, weights) in mixing.iter().enumerate() {
            let sum = |term: &dyn Fn(usize) -> Rational| {
                (0..2).fold(Rational::zero(), |sum, i| sum + weights[i].clone() * term(i))
            };
            let (true_sum, printed_sum) = (
                sum(&|i| spread(i, j)[(0, 0)].clone()),
                sum(&|i| printed(i)[(0, 0)].clone()),
            );
            assert!(true_sum > printed_sum, "{j}: {true_sum} {printed_sum}");
        }
        // The bound by twice both errors holds in all four.
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let bound = spread_bound(&mixing[j][1 - i], [&errors[0], &errors[1]]);
            assert!(is_below(&spread(i, j), &bound), "{i} {j}");
        }
    }
}

#[test]
fn the_weight_of_the_other_mode_is_small_only_between_equals() {
    // Symbolic: for all a and μ₁ the weight is 1 − a exactly where (1 − a) a (2μ₁ − 1) = 0.
    let (a, mu) = (unknown("a"), unknown("mu"));
    let one = Unknown::one;
    let weight = other_mode_weight(&a, &mu);
    let below = (one() - a.clone()) * mu.clone() + a.clone() * (one() - mu.clone());
    let factor = (one() - a.clone()) * a.clone() * (Unknown::integer(2) * mu - one());
    assert_eq!(weight - printed_weight(&a), factor / below);
    // Exact: with a = .95 and μ₁ = .95 it is ½, so that ε = ¼ and not .0025.
    let stay = rational("0.95");
    assert_eq!(other_mode_weight(&stay, &stay), rational("1/2"));
    assert_eq!(other_mode_weight(&stay, &rational("1/2")), printed_weight(&stay));
    let epsilon = |weight: &Rational| weight.clone() * weight.clone();
    assert_eq!(
        epsilon(&rational("1/2")) / epsilon(&printed_weight(&stay)),
        rational("100")
    );
    // As one mode becomes certain it tends to one, however small 1 − a is.
    for stay in ["0.95", "0.999", "0.999999"] {
        let nearly = other_mode_weight(&rational(stay), &rational("0.999999999999"));
        assert!(nearly > rational("0.999998"), "{stay}: {nearly}");
        assert_eq!(other_mode_weight(&rational(stay), &Rational::one()), Rational::one());
    }
}

// The mismatched filter

/// The α-β filter of unknown θ, t, R on a target of unknown acceleration.
fn alpha_beta_mismatch() -> (Mismatch<Unknown>, Vector3<Unknown>) {
    let (t, a) = (unknown("t"), unknown("a"));
    let gain = gains::alpha_beta_gain(&unknown("theta"), &t);
    let missed = motion_missed(&a, &t);
    let f = embedded_constant_velocity(&t);
    (
        Mismatch::new(&f, &position_matrix(), gain.clone(), &missed, unknown("R")),
        gain,
    )
}

#[test]
fn the_mismatch_equation_has_the_stated_solution() {
    // Symbolic, for all θ, t, a and R.
    let (filter, gain) = alpha_beta_mismatch();
    let (t, a, r) = (unknown("t"), unknown("a"), unknown("R"));
    let scatter = alpha_beta_scatter(&gain, &r, &t);
    let carried = &filter.closed_loop * &scatter * filter.closed_loop.transpose();
    assert_eq!(carried + &gain * gain.transpose() * r, scatter);
    let error = second_moment(&alpha_beta_lag(&gain, &a, &t), &scatter);
    assert_eq!(filter.right_side(&error), error);
    // Without the lag, or with it once too often, it is no solution.
    assert_ne!(filter.right_side(&scatter), scatter);
    let lag = filter.lag();
    let more = &error + &lag * lag.transpose();
    assert_ne!(filter.right_side(&more), more);
    // Exact: the general solution is this one, and that of a gain which is no filter's steady one solves (7) too.
    let one = Rational::one;
    let missed = motion_missed(&rational("3"), &rational("2"));
    let f = embedded_constant_velocity(&rational("2"));
    for gain in [
        gains::alpha_beta_gain(&rational("1/3"), &rational("2")),
        Vector3::new(rational("1/2"), rational("1/5"), rational("1/7")),
    ] {
        let filter = Mismatch::new(&f, &position_matrix(), gain.clone(), &missed, rational("1/4"));
        assert_eq!(has_radius_below(&rows_of(&filter.closed_loop), &one()), Some(true));
        let error = filter.long_term_error().unwrap();
        assert_eq!(filter.right_side(&error), error);
        if gain[2].is_zero() {
            let closed = alpha_beta_scatter(&gain, &rational("1/4"), &rational("2"));
            let lag = alpha_beta_lag(&gain, &rational("3"), &rational("2"));
            assert_eq!(error, second_moment(&lag, &closed));
        }
    }
}

#[test]
fn the_lag_has_a_closed_form() {
    // Symbolic.
    let (filter, gain) = alpha_beta_mismatch();
    let (t, a) = (unknown("t"), unknown("a"));
    let lag = alpha_beta_lag(&gain, &a, &t);
    assert_eq!(filter.lag(), lag);
    assert_eq!(&filter.closed_loop * &lag + &filter.missed, lag);
    let innovation = position_matrix() * (embedded_constant_velocity(&t) * &lag + motion_missed(&a, &t));
    let expected = alpha_beta_innovation(&gain, &a, &t);
    assert_eq!(innovation[(0, 0)], expected);
    // The bias of step 4, a t²/2, is smaller by β/2.
    let beta = gain[1].clone() * t.clone();
    let printed = acceleration_response(&t)[0].clone() * a;
    assert_eq!(printed, expected * beta / Unknown::integer(2));
    // The inverse that the closed form came from.
    let matrix = Matrix3::from_fn(|i, j| unknown(&format!("m{i}{j}")));
    assert_eq!(inverse(&matrix) * matrix, Matrix3::identity());
}

#[test]
fn without_process_noise_nothing_settles() {
    // Exact. The printed hypothesis: (F, G) is stabilisable; it is with G = G_v, for the noise reaches all that does not decay. But
    // the gains "may" be computed with a noise, or without.
    let one = Rational::one;
    let problem = |noise: &str| Riccati {
        transition: embedded_constant_velocity(&one()),
        measurement: position_matrix(),
        noise: response_noise(
            &Vector3::new(rational("1/2"), one(), Rational::zero()),
            &rational(noise),
        ),
        measurement_noise: Matrix1::new(one()),
    };
    assert!(SteadyState::certify(&problem("5"), 64).is_ok());
    let refused = SteadyState::certify(&problem("0"), 64);
    assert!(
        matches!(refused, Err(NoSteadyState::NotStabilisable { .. })),
        "{refused:?}"
    );
    // What happens instead: after n steps the gain is that of a straight line through n points, 2(2n − 1)/(n(n + 1)) and
    // 6/(n(n + 1)), which falls to zero; the closed loop with the gain at the end is F, whose double root is one.
    let without = problem("0");
    let diffuse = 1_000_000_000_000_i64;
    let mut predicted = Matrix3::identity() * Rational::integer(diffuse);
    for n in 1..=12_i64 {
        let gain = without.gain(&predicted);
        if n >= 2 {
            let points = Rational::integer(n * (n + 1));
            let line = [
                Rational::integer(2 * (2 * n - 1)) / points.clone(),
                Rational::integer(6) / points,
            ];
            for (entry, expected) in gain.iter().zip(line) {
                // The initial covariance is finite: its information is a part in 10¹², of at most n² points.
                assert!(
                    (entry.clone() - expected).abs() < Rational::new(1000, diffuse),
                    "{n}: {entry}"
                );
            }
        }
        predicted = without.next(&predicted);
    }
    let settled = Mismatch::new(
        &without.transition,
        &without.measurement,
        Vector3::zeros(),
        &motion_missed(&one(), &one()),
        one(),
    );
    assert_eq!(has_radius_below(&rows_of(&settled.closed_loop), &one()), Some(false));
    assert_eq!(settled.long_term_error(), None);
    assert!(settled.lag().iter().all(|entry| !entry.is_decided()));
}

/// The bound that a χ² variable exceeds with this probability.
fn quantile(degrees: f64, exceeded_with: f64) -> f64 {
    ChiSquared::new(degrees).unwrap().inverse_cdf(1.0 - exceeded_with)
}

#[test]
fn the_long_term_error_is_that_of_a_simulation() {
    // Statistics. Seed 2000, stream 7; the probability that a right equation fails is 3e-6, one part for each bound.
    const RUNS: usize = 4000;
    const FALSE_ALARM: f64 = 1e-6;
    let (t, a, r): (f64, f64, f64) = (2.0, 30.0, 0.05);
    let root = gains::alpha_beta_root(&gains::tracking_index(&5.0, &r, &t));
    let gain = gains::alpha_beta_gain(&root, &t);
    let (f, h) = (embedded_constant_velocity(&t), position_matrix::<f64>());
    let filter = Mismatch::new(&f, &h, gain, &motion_missed(&a, &t), r);
    let lag = filter.lag();
    let error = filter.long_term_error().unwrap();
    let scatter: Matrix2<f64> = (error - lag * lag.transpose()).fixed_view::<2, 2>(0, 0).into_owned();
    let factors = ldl(&scatter);
    let mut generator = Generator::new(2000, 7);
    let (mut sum, mut squares) = (Vector2::zeros(), 0.0);
    for _ in 0..RUNS {
        // The filter itself, on the target itself, from the truth; ρ(A₊) < 0.5, so that after 60 steps the start is forgotten.
        let (mut truth, mut estimate) = (Vector3::new(0.0, 0.0, a), Vector3::new(0.0, 0.0, a));
        for _ in 0..60 {
            truth = constant_acceleration(&t) * truth;
            let predicted = f * estimate;
            let z = truth[0] + f64::sqrt(r) * generator.standard_normal();
            estimate = predicted + gain * (z - predicted[0]);
        }
        let off: Vector3<f64> = truth - estimate - lag;
        assert!(
            off[2].abs() < f64::MIN_POSITIVE,
            "the acceleration is missed altogether"
        );
        let off = Vector2::new(off[0], off[1]);
        sum += off;
        squares += immaculate::matrix::quadratic_form(&factors, &off);
    }
    let mean = immaculate::matrix::quadratic_form(&factors, &sum) / RUNS as f64;
    assert!(mean < quantile(2.0, FALSE_ALARM), "the lag: {mean}");
    let degrees = 2.0 * RUNS as f64;
    assert!(
        squares < quantile(degrees, FALSE_ALARM),
        "the scatter: {squares} of {degrees}"
    );
    assert!(
        squares > quantile(degrees, 1.0 - FALSE_ALARM),
        "the scatter: {squares} of {degrees}"
    );
    // The bias of step 4 would be noticed: the innovation's mean is a t²/β, and not a t²/2.
    assert!((alpha_beta_innovation(&gain, &a, &t) / (a * t * t / 2.0) - 1.0).abs() > 0.05);
}

// The recursion undone

#[test]
fn the_recursion_unrolls_with_the_latest_matrix_on_the_left() {
    // Symbolic: three steps with any matrices.
    let matrix = |name: &str| Matrix2::from_fn(|i, j| unknown(&format!("{name}{i}{j}")));
    let vector = |name: &str| Vector2::new(unknown(&format!("{name}0")), unknown(&format!("{name}1")));
    let step = |number: usize| FilterStep {
        closed_loop: matrix(&format!("A{number}")),
        gain: vector(&format!("K{number}")),
        measurement: Vector1::new(unknown(&format!("y{number}"))),
    };
    let (initial, steps) = (vector("x"), [step(1), step(2), step(3)]);
    let estimate = recursion(&initial, &steps);
    assert_eq!(unrolled(&initial, &steps), estimate);
    assert_ne!(unrolled_as_printed(&initial, &steps), estimate);
    // Exact: two steps of a filter that starts from a prior, whose gains change from one to the other.
    let one = Rational::one;
    let problem = Riccati {
        transition: constant_acceleration(&one()),
        measurement: position_matrix(),
        noise: response_noise(&acceleration_response(&one()), &one()),
        measurement_noise: Matrix1::new(one()),
    };
    let mut predicted = Matrix3::identity();
    let steps: Vec<FilterStep<Rational, 3, 1>> = [3, 7]
        .into_iter()
        .map(|y| {
            let gain = problem.gain(&predicted);
            let closed_loop = problem.closed_loop(&gain);
            predicted = problem.next(&predicted);
            FilterStep {
                closed_loop,
                gain,
                measurement: Vector1::new(Rational::integer(y)),
            }
        })
        .collect();
    let initial = Vector3::new(one(), one(), one());
    let estimate = recursion(&initial, &steps);
    assert_eq!(unrolled(&initial, &steps), estimate);
    assert_ne!(unrolled_as_printed(&initial, &steps), estimate);
    // With one gain for ever the matrices commute, and the order does not matter.
    let settled = vec![steps[1].clone(); 4];
    assert_eq!(unrolled_as_printed(&initial, &settled), recursion(&initial, &settled));
}

// The algorithm for the long-term error

/// The paper's figure 1 at one point: both process noises 5.
fn setting(interval: f64, acceleration: f64) -> Setting {
    Setting {
        interval,
        acceleration,
        measurement_variance: 0.05,
        noises: [5.0, 5.0],
        stay: 0.95,
    }
}

fn simulated(setting: &Setting, start: Start, stream: u64) -> Simulated {
    let mut generator = Generator::new(2000, stream);
    simulate(setting, start, || generator.standard_normal()).unwrap()
}

fn predicted(setting: &Setting, form: Algorithm) -> LongTerm {
    predict(setting, form).unwrap()
}

/// The mean of the simulated total error over a number of runs, and its standard error.
fn mean_total(setting: &Setting, runs: u64) -> (f64, f64) {
    let totals: Vec<f64> = (0..runs)
        .map(|run| simulated(setting, Start::AtTheTruth, run).total())
        .collect();
    let mean = totals.iter().sum::<f64>() / runs as f64;
    let variance = totals.iter().map(|total| (total - mean) * (total - mean)).sum::<f64>() / (runs - 1) as f64;
    (mean, f64::sqrt(variance / runs as f64))
}

#[test]
fn the_corrected_algorithm_predicts_the_simulated_error() {
    // Statistics. Where one mode is certain the gains and probabilities are constant, and nothing is approximated: the mean of 60 runs is
    // within five standard errors (false alarm: 6e-7 for a Gaussian mean, below 1e-5 with the estimated deviation; three settings).
    for (interval, variance, acceleration) in [(1.0, 0.05, 95.0), (2.0, 0.05, 50.0), (2.0, 0.5, 95.0)] {
        let setting = Setting {
            measurement_variance: variance,
            ..setting(interval, acceleration)
        };
        let (mean, deviation) = mean_total(&setting, 60);
        let corrected = predicted(&setting, Algorithm::Corrected);
        assert!(
            corrected.converged && corrected.probabilities[0] < 1e-6,
            "{corrected:?}"
        );
        assert!(
            (corrected.total() - mean).abs() < 5.0 * deviation,
            "{} {mean} {deviation}",
            corrected.total()
        );
        // The upper bound of step 6 is above it, and a single run of the paper's 800 points scatters by several per cent.
        let reindexed = predicted(&setting, Algorithm::Reindexed);
        assert!(reindexed.total() > mean + 5.0 * deviation, "{}", reindexed.total());
        let one_run = deviation * f64::sqrt(60.0) / mean;
        assert!(one_run > 0.03 && one_run < 0.15, "{one_run}");
    }
    // Where the modes change hands it stays an approximation. The greatest of its errors on figure 1 is where the acceleration is about
    // what the process noise makes of it, √5: 15 % at a = 5, t = 1.
    let middle = setting(1.0, 5.0);
    let (mean, deviation) = mean_total(&middle, 60);
    let off = predicted(&middle, Algorithm::Corrected).total() / mean - 1.0;
    assert!(off < -0.1 && off > -0.2 && deviation < 0.02 * mean, "{off}");
}

/// The moments of the errors of both filters are those that exact arithmetic finds, to the rounding of the sums.
#[test]
fn the_joint_errors_solve_their_equations() {
    let (root, acceleration) = (rational("1/2"), rational("10"));
    for (probability, mixes) in [("1/2", true), ("9/10", true), ("1/1000", true), ("1/2", false)] {
        let exact = Pair::new(&root, &rational(probability), &acceleration, mixes);
        let double = |entry: &Rational| entry.to_f64();
        let setting = Setting {
            measurement_variance: 1.0,
            ..setting(1.0, 10.0)
        };
        let gains = [
            gains::alpha_beta_gain(&root, &Rational::one()).map(|entry| double(&entry)),
            gains::alpha_beta_gamma_gain(&root, &Rational::one()).map(|entry| double(&entry)),
        ];
        let mixing = exact
            .mixing
            .clone()
            .map(|row| row.iter().map(double).collect::<Vec<f64>>());
        let errors = JointErrors::new(&setting, &gains, &mixing).unwrap();
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let expected = exact.block(i, j).map(|entry| double(&entry));
            let apart = (errors.moment(i, j) - expected).abs().max();
            // A hundred roundings or so, of entries of the size of a², magnified by sums whose terms shrink by less than a half.
            assert!(apart < 1e-12 * 100.0, "{probability}: {apart:e}");
        }
        let gap = (errors.gap() - exact.gap().map(|entry| double(&entry))).abs().max();
        assert!(gap < 1e-12 * 100.0, "{probability}: {gap:e}");
    }
}

/// Property: where modes never change, each filter is by itself, the likelier one becomes certain, and the long-term error is its own.
/// Likelihoods and errors are closed forms of the steady filters here, so that the acceleration at which the other filter is the likelier
/// one is known; the algorithm is asked on both sides of it.
#[test]
fn without_changes_of_mode_the_likelier_filter_stays_with_its_own_error() {
    for (interval, variance) in [(1.0, 0.05), (2.0, 0.5), (3.0, 0.05)] {
        let at = |acceleration: f64| Setting {
            measurement_variance: variance,
            stay: 1.0,
            ..setting(interval, acceleration)
        };
        let index = gains::tracking_index(&5.0, &variance, &interval);
        let roots = [gains::alpha_beta_root(&index), gains::alpha_beta_gamma_root(&index)];
        let gains = [
            gains::alpha_beta_gain(&roots[0], &interval),
            gains::alpha_beta_gamma_gain(&roots[1], &interval),
        ];
        let motions = [embedded_constant_velocity(&interval), constant_acceleration(&interval)];
        let h = position_matrix::<f64>();
        let filter = |j: usize, acceleration: f64| {
            let missed = motion_missed(&acceleration, &interval) * [1.0, 0.0][j];
            Mismatch::new(&motions[j], &h, gains[j], &missed, variance)
        };
        // Corrected. S as the filter believes it, R/θ², and as it is: the scatter, moved, and R. In N(b; 0, S + V) the bias is a t²/β.
        let width = [0, 1].map(|j| {
            let scatter = filter(j, 0.0).long_term_error().unwrap();
            let moved = h * motions[j] * scatter * motions[j].transpose() * h.transpose();
            gains::innovation_variance(&roots[j], &variance) + moved[(0, 0)] + variance
        });
        let bias = alpha_beta_innovation(&gains[0], &1.0, &interval);
        let limit = f64::sqrt(width[0] * f64::ln(width[1] / width[0])) / bias;
        for (acceleration, winner) in [(0.0, 0), (0.5 * limit, 0), (1.5 * limit, 1), (4.0 * limit, 1)] {
            let found = predicted(&at(acceleration), Algorithm::Corrected);
            assert!(
                found.converged && found.probabilities[winner] > 1.0 - 1e-6,
                "{acceleration}: {found:?}"
            );
            let own = filter(winner, acceleration).long_term_error().unwrap();
            // The other filter has a millionth of the probability at most, and a gap of the size of a² t⁴.
            let apart = (found.error - own).abs().max() / own.trace().max(acceleration * acceleration);
            assert!(apart < 1e-5, "{acceleration}: {} for {own}", found.error);
        }
        // As printed. Constant velocity has the variance H F P Fᵀ Hᵀ + R with the steady P = P⁻ − K S Kᵀ, and the bias a t²/2; constant
        // acceleration goes on with A P Aᵀ + K R Kᵀ, the recursion without process noise, whose gain has it.
        let steady = gains::alpha_beta_covariance(&roots[0], &variance, &interval);
        let s = gains::innovation_variance(&roots[0], &variance);
        let noise = response_noise(&acceleration_response(&interval), &5.0);
        let own = Riccati {
            transition: motions[1],
            measurement: h,
            noise,
            measurement_noise: Matrix1::new(variance),
        };
        let mut carried = Matrix3::identity();
        for _ in 0..200 {
            let gain = own.gain(&predicted_covariance(&motions[1], &carried, &noise));
            let a = own.closed_loop(&gain);
            carried = a * carried * a.transpose() + gain * gain.transpose() * variance;
        }
        let before = [steady - gains[0] * gains[0].transpose() * s, carried];
        let width =
            [0, 1].map(|j| (h * motions[j] * before[j] * motions[j].transpose() * h.transpose())[(0, 0)] + variance);
        let ratio = width[1] / width[0];
        let errors = |acceleration| [filter(0, acceleration).long_term_error().unwrap(), carried];
        let cases = if ratio > 1.0 {
            let limit = f64::sqrt(2.0 * width[0] * f64::ln(ratio)) / (interval * interval / 2.0);
            vec![(0.0, 0), (0.5 * limit, 0), (1.5 * limit, 1), (4.0 * limit, 1)]
        } else {
            // Constant acceleration is the likelier one even of a target that has none.
            vec![(0.0, 1), (10.0, 1)]
        };
        for (acceleration, winner) in cases {
            for form in [Algorithm::Printed, Algorithm::Reindexed] {
                let found = predicted(&at(acceleration), form);
                assert!(
                    found.converged && found.probabilities[winner] > 1.0 - 1e-6,
                    "{acceleration}: {found:?}"
                );
                let own = errors(acceleration)[winner];
                let apart = (found.error - own).abs().max() / own.trace().max(acceleration * acceleration);
                assert!(apart < 1e-5, "{acceleration}: {} for {own}", found.error);
            }
        }
    }
}

/// Figures, and no proof: what the three forms come to where both modes have a share, and after how many rounds. The laws above hold where
/// one mode is certain; between, what each form says is its own, and a difference here says that the algorithm is another.
#[test]
fn predictions_between_two_modes_are_these() {
    use Algorithm::{Corrected, Printed, Reindexed};
    for (interval, acceleration, variance, form, total, velocity, rounds) in [
        (1.0, 5.0, 0.05, Printed, 8.739_026_950, 0.053_252_295, 94),
        (1.0, 5.0, 0.05, Reindexed, 1.397_125_385, 0.011_647_213, 48),
        (1.0, 5.0, 0.05, Corrected, 0.905_800_358, 0.023_478_782, 17),
        (1.0, 0.0, 0.05, Printed, 0.633_887_932, 0.718_560_518, 117),
        (1.0, 0.0, 0.05, Reindexed, 0.614_376_210, 0.796_427_421, 136),
        (1.0, 0.0, 0.05, Corrected, 0.432_819_960, 0.821_576_161, 75),
        (2.0, 2.0, 0.5, Printed, 3.336_798_132, 0.232_999_487, 69),
        (2.0, 2.0, 0.5, Reindexed, 3.065_330_612, 0.191_728_561, 93),
        (2.0, 2.0, 0.5, Corrected, 2.166_351_898, 0.276_489_441, 110),
    ] {
        let setting = Setting {
            measurement_variance: variance,
            ..setting(interval, acceleration)
        };
        let found = predicted(&setting, form);
        assert!(found.converged && found.rounds == rounds, "{setting:?} {found:?}");
        let apart = [found.total() - total, found.probabilities[0] - velocity];
        // The last digit that is written.
        assert!(apart.iter().all(|apart| apart.abs() < 1e-9), "{setting:?} {found:?}");
        assert!((found.probabilities[0] + found.probabilities[1] - 1.0).abs() < 1e-12);
    }
}

/// Property: a sensor that is always off by twice its deviation moves the estimate by as much, and the error of a filter that is locked
/// into constant velocity with it: e = m − [2√R, 0, 0]ᵀ, with the lag m in closed form.
#[test]
fn a_sensor_that_is_off_moves_the_simulated_error_by_as_much() {
    let locked = Setting {
        noises: [20.0, 5.0],
        ..setting(2.0, 50.0)
    };
    let simulated = simulate(&locked, Start::BeforeTheManoeuvre, || 2.0).unwrap();
    let root = gains::alpha_beta_root(&gains::tracking_index(&20.0, &0.05, &2.0));
    let gain = gains::alpha_beta_gain(&root, &2.0);
    let off = alpha_beta_lag(&gain, &50.0, &2.0) - Vector3::new(2.0 * f64::sqrt(0.05), 0.0, 0.0);
    let expected = off * off.transpose();
    // The other mode has a probability below a millionth, and a hundred steps settle to far less.
    assert!(
        (simulated.error - expected).abs().max() < 1e-5 * expected.trace(),
        "{} {expected}",
        simulated.error
    );
    assert!((simulated.probability - 1.0).abs() < 1e-6, "{simulated:?}");
}

#[test]
fn the_printed_weight_lets_the_algorithm_run_away() {
    // Property, on doubles. The error of constant acceleration is below one, and so is what the simulation shows (statistics above). With
    // the printed weight the algorithm ends, without converging, hundreds of times above.
    let target = setting(1.0, 95.0);
    let printed = predicted(&target, Algorithm::Printed);
    assert!(!printed.converged && printed.total() > 50.0, "{printed:?}");
    let reindexed = predicted(&target, Algorithm::Reindexed);
    assert!(reindexed.converged && reindexed.total() < 1.5, "{reindexed:?}");
}

#[test]
fn the_error_of_step_6_is_below_its_upper_bound() {
    // Property: Σ μᵢ E eⁱeⁱᵀ − E e eᵀ = μ₀ μ₁ D ⪰ 0, to rounding.
    let gains = [Vector3::new(0.8, 0.6, 0.0), Vector3::new(0.9, 0.9, 0.4)];
    let mixing = [vec![0.95, 0.05], vec![0.05, 0.95]];
    let errors = JointErrors::new(&setting(1.0, 10.0), &gains, &mixing).unwrap();
    let bound = errors.moment(0, 0) * 0.3 + errors.moment(1, 1) * 0.7;
    let left_over = bound - errors.combined(&[0.3, 0.7]) - errors.gap() * (0.3 * 0.7);
    // Some twenty roundings of entries of the size of a², 100.
    assert!(left_over.abs().max() < 20.0 * 100.0 * f64::EPSILON, "{left_over}");
    // Gains that do not settle have no long-term error.
    assert_eq!(
        JointErrors::new(&setting(1.0, 10.0), &[Vector3::zeros(); 2], &mixing),
        None
    );
}

#[test]
fn a_filter_that_expects_more_noise_of_constant_velocity_locks_into_it() {
    // Statistics with one run each, but the two ends are seven orders of magnitude apart in probability. Seed 2000.
    let locked = Setting {
        noises: [20.0, 5.0],
        ..setting(2.0, 50.0)
    };
    let from_truth = simulated(&locked, Start::AtTheTruth, 1);
    let from_before = simulated(&locked, Start::BeforeTheManoeuvre, 1);
    assert!(
        from_truth.probability < 1e-6 && from_truth.total() < 1.0,
        "{from_truth:?}"
    );
    // For all 800 points: its acceleration is zero, so the total is above a² = 2500.
    assert!(
        from_before.probability > 1.0 - 1e-6 && from_before.total() > 2500.0,
        "{from_before:?}"
    );
    // With equal noises, or the smaller one in constant velocity, both starts end the same way.
    for noise in [2.0, 5.0] {
        let free = Setting {
            noises: [noise, 5.0],
            ..locked
        };
        let ends = [Start::AtTheTruth, Start::BeforeTheManoeuvre].map(|start| simulated(&free, start, 1));
        assert!(
            (ends[0].total() / ends[1].total() - 1.0).abs() < 1e-6,
            "{noise}: {ends:?}"
        );
    }
    // Why (symbolic): once constant velocity is certain both filters start from its estimate, which has no acceleration. They predict
    // the same, S_v − S_a = (q_v − q_a) t⁴/4, and the greater S has the greater likelihood of whatever is far off.
    let (t, covariance) = (unknown("t"), alpha_beta_like());
    let (velocity, acceleration) = (embedded_constant_velocity(&t), constant_acceleration(&t));
    let estimate = Vector3::new(unknown("p"), unknown("v"), Unknown::zero());
    assert_eq!(&velocity * &estimate, &acceleration * &estimate);
    let innovation_variance = |motion: &Matrix3<Unknown>, response: &Vector3<Unknown>, q: &str| {
        let predicted = motion * &covariance * motion.transpose() + response_noise(response, &unknown(q));
        predicted[(0, 0)].clone()
    };
    let s_v = innovation_variance(&velocity, &embedded_velocity_response(&t), "qv");
    let s_a = innovation_variance(&acceleration, &acceleration_response(&t), "qa");
    let t4 = &t * &t * (&t * &t);
    assert_eq!(s_v - s_a, (unknown("qv") - unknown("qa")) * t4 / Unknown::integer(4));
}

/// A covariance of the constant velocity filter: nothing in the acceleration.
fn alpha_beta_like() -> Matrix3<Unknown> {
    let mut covariance = symmetric("P");
    for k in 0..3 {
        covariance[(2, k)] = Unknown::zero();
        covariance[(k, 2)] = Unknown::zero();
    }
    covariance
}

/// Exact: the axes are those that the paper prints, 0 to 95 m/s² in steps of five, R from 0.05 to 0.5 m², q_v from 2 to 40 m²/s⁴; all else
/// is as it is everywhere. A row of the grid is a row of its settings.
#[test]
fn the_grids_are_those_of_the_figures() {
    let accelerations: Vec<f64> = (0..20_u32).map(|k| 5.0 * f64::from(k)).collect();
    for (grid, names_unit, first, last, rows) in [
        (Grid::figure_1(2.0), "m²", 0.05, 0.5, 10),
        (Grid::figure_2(2.0), "m²/s⁴", 2.0, 40.0, 20),
    ] {
        assert!(grid.rows_are.contains(names_unit), "{}", grid.rows_are);
        assert_eq!((&grid.columns, grid.rows.len()), (&accelerations, rows));
        assert_eq!((grid.rows[0], grid.rows[rows - 1]), (first, last));
        // Evenly: no step differs from the first by more than the rounding of the decimals.
        let step = (last - first) / (rows - 1) as f64;
        assert!(
            grid.rows
                .windows(2)
                .all(|pair| (pair[1] - pair[0] - step).abs() < 1e-12)
        );
        assert_eq!(grid.settings.len(), rows * 20);
        for (index, found) in grid.settings.iter().enumerate() {
            let row = grid.rows[index / 20];
            let (measurement_variance, velocity) = if names_unit == "m²" { (row, 5.0) } else { (0.05, row) };
            let expected = Setting {
                measurement_variance,
                noises: [velocity, 5.0],
                ..setting(2.0, accelerations[index % 20])
            };
            assert_eq!(found, &expected, "{index}");
        }
    }
}

/// Property: each point has its own noise, and 100 (predicted − simulated)/simulated of the traces is its percentage.
#[test]
fn a_percentage_is_that_of_its_own_point() {
    let noise = |point: usize| {
        let mut generator = Generator::new(2000, point as u64);
        move || generator.standard_normal()
    };
    let mut grid = Grid::figure_1(2.0);
    grid.settings = vec![setting(2.0, 0.0), setting(2.0, 50.0), setting(1.0, 95.0)];
    let found = grid
        .percentages(Algorithm::Corrected, Start::AtTheTruth, noise)
        .unwrap();
    assert_eq!(found.len(), 3);
    for (point, (setting, found)) in grid.settings.iter().zip(&found).enumerate() {
        let simulated = simulate(setting, Start::AtTheTruth, noise(point)).unwrap().total();
        let expected = 100.0 * (predicted(setting, Algorithm::Corrected).total() / simulated - 1.0);
        // Three roundings of a ratio near one, in per cent.
        assert!((found - expected).abs() < 1e-12 * 100.0, "{point}: {found} {expected}");
    }
    assert!(found.iter().all(|percentage| percentage.abs() > 1e-3), "{found:?}");
}

#[test]
fn the_figures_show_where_the_prediction_is_right() {
    // Statistics over the grids of figures 1 and 2 with one run of 800 points a point, as in the paper, seed 2000; the medians are far
    // from their bounds, and the stream of each point is its number.
    let noise = |point: usize| {
        let mut generator = Generator::new(2000, point as u64);
        move || generator.standard_normal()
    };
    let median = |percentages: &[f64]| {
        let mut sizes: Vec<f64> = percentages.iter().map(|percentage| percentage.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        sizes[sizes.len() / 2]
    };
    let (first, second) = (Grid::figure_1(2.0), Grid::figure_2(2.0));
    assert_eq!((first.settings.len(), second.settings.len(), POINTS), (200, 400, 800));
    let of = |grid: &Grid, form, start| grid.percentages(form, start, noise).unwrap();
    let corrected = of(&first, Algorithm::Corrected, Start::AtTheTruth);
    // 6 % is what 800 points scatter.
    assert!(median(&corrected) < 10.0, "{}", median(&corrected));
    let reindexed = of(&first, Algorithm::Reindexed, Start::AtTheTruth);
    assert!(
        median(&reindexed) > 12.0 && median(&reindexed) < 30.0,
        "{}",
        median(&reindexed)
    );
    let printed = of(&first, Algorithm::Printed, Start::AtTheTruth);
    assert!(median(&printed) > 1000.0, "{}", median(&printed));
    // Figure 2, when the manoeuvre begins with the run: locked on most of the grid, and a hundredth of the error is predicted.
    let locked = of(&second, Algorithm::Corrected, Start::BeforeTheManoeuvre);
    assert!(median(&locked) > 99.0, "{}", median(&locked));
    let panels =
        [("figure 1", first, corrected), ("figure 2", second, locked)].map(|(title, grid, percentages)| Panel {
            title: title.to_owned(),
            grid,
            percentages,
        });
    let svg = heat_maps(&panels, 2).unwrap();
    // Where it locks, figure 2 is of one colour, and neighbours of one colour are one rectangle: one a row of most of the twenty rows.
    let locked_rows = svg
        .lines()
        .filter(|line| line.contains("opacity=\"1\" fill=\"#0072B2\""))
        .count();
    assert!((15..30).contains(&locked_rows), "{locked_rows}");
    // Elsewhere a prediction is off by what 800 points scatter, up and down: most cells differ from their neighbours.
    let cells = svg.matches("<rect").count();
    assert!((100..600).contains(&cells), "{cells}");
}

// What the filters cost

/// Operations of one cycle for both coordinates, under the conventions from the one that counts most.
fn both_coordinates(filter: OneCoordinate, update: CovarianceUpdate) -> [usize; 2] {
    Sums::ALL.map(|sums| filter.operations(update, sums))
}

#[test]
fn the_filters_cost_what_their_equations_cost() {
    // Exact. The fixed-gain filter by hand, one coordinate, every matrix full and every sum from nothing:
    // c 8, μᵢ∣ⱼ 8, x̂⁰ 24, F x̂⁰ 36, H x̂⁻ 12, ν 2, K ν 12, x̂⁻ + K ν 6, ln L 10, Λ 4, C 4, μ 4, x̂ 12.
    let by_hand = 8 + 8 + 24 + 36 + 12 + 2 + 12 + 6 + 10 + 4 + 4 + 4 + 12;
    assert_eq!(
        both_coordinates(OneCoordinate::FixedGain, CovarianceUpdate::Short),
        [2 * by_hand, 228]
    );
    assert_eq!(
        both_coordinates(OneCoordinate::FixedGain, CovarianceUpdate::Printed),
        [284, 228]
    );
    // The Kalman filter with the printed update, by hand: F x̂ 18, F P Fᵀ + Q 117, H P Hᵀ + R 25, P Hᵀ 18, K 3, H x̂⁻ 6, ν 1, K ν 6,
    // x̂⁻ + K ν 3, K H 18, I − K H 9, (I − K H) P 54.
    let by_hand = 18 + 117 + 25 + 18 + 3 + 6 + 1 + 6 + 3 + 18 + 9 + 54;
    let kalman = |form| both_coordinates(OneCoordinate::ConstantAcceleration, form);
    assert_eq!(kalman(CovarianceUpdate::Printed), [2 * by_hand, 456]);
    assert_eq!(kalman(CovarianceUpdate::Short), [460, 372]);
    let imm = |form| both_coordinates(OneCoordinate::Imm, form);
    assert_eq!(imm(CovarianceUpdate::Printed), [1848, 1454]);
    assert_eq!(imm(CovarianceUpdate::Short), [1656, 1286]);
}

#[test]
fn the_printed_operation_counts_stand_beside_the_equations() {
    // Exact, as far as it goes: the paper's program is not printed, so a number can only be inside or outside of what its equations
    // cost when every sum starts from nothing and when it starts from its first term, with either update.
    let range = |filter: OneCoordinate| {
        let totals: Vec<usize> = CovarianceUpdate::ALL
            .iter()
            .flat_map(|form| both_coordinates(filter, *form))
            .collect();
        (*totals.iter().min().unwrap(), *totals.iter().max().unwrap())
    };
    let is_reachable = |filter: OneCoordinate| {
        let (least, most) = range(filter);
        filter.printed().iter().all(|printed| (least..=most).contains(printed))
    };
    assert!(is_reachable(OneCoordinate::FixedGain), "228 ≤ 242 ≤ 284");
    assert!(is_reachable(OneCoordinate::Imm), "1286 ≤ 1322, 1326, 1332 ≤ 1848");
    // 590 is more than the printed equations cost with every matrix full: something was computed twice.
    assert!(!is_reachable(OneCoordinate::ConstantAcceleration), "372 ≤ 556 < 590");
    // No single convention gives all three.
    let ratio = |form, above: OneCoordinate, below: OneCoordinate| {
        let (above, below) = (both_coordinates(above, form), both_coordinates(below, form));
        // In per cent, to the nearest.
        [0, 1].map(|k| (100 * above[k] + below[k] / 2) / below[k])
    };
    // "Half the computational load": so it is for full matrices and the printed update; the printed numbers have 0.41.
    let load = |form| ratio(form, OneCoordinate::FixedGain, OneCoordinate::ConstantAcceleration);
    assert_eq!(load(CovarianceUpdate::Printed), [51, 50]);
    assert_eq!(load(CovarianceUpdate::Short), [62, 61]);
    // Against the IMM filter it saves what the paper says, 1326/242 = 5.48, or more.
    let saved = |form| ratio(form, OneCoordinate::Imm, OneCoordinate::FixedGain);
    assert_eq!(saved(CovarianceUpdate::Printed), [651, 638]);
    assert_eq!(saved(CovarianceUpdate::Short), [583, 564]);
}
