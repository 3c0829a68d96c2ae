//! Goal: the equations of filter and cycle that the papers print wrongly are wrong, and their corrected forms are right.
//!
//! Method: for each erratum one test in which the printed form fails and the corrected one passes the same question. Kind of
//! evidence: exact where the form is algebra (rationals and surds, no tolerance), quadrature or a comparison of doubles where it
//! is a density, with the reason of each tolerance beside it. The weights of the rules are printed wrongly too; they are elsewhere.

mod common;

use common::{ROUNDOFF, polar_scene};
use immaculate::filter::cubature::{point, propagated_point, weighted_covariance, weighted_mean};
use immaculate::filter::raw::{raw_covariance, raw_second_moment};
use immaculate::filter::{kalman, update};
use immaculate::gaussian::{Gaussian, log_density, mixture_covariance, mixture_mean};
use immaculate::imm::Equations;
use immaculate::imm::printed::{log_density_21, log_density_57, mode_probability_22};
use immaculate::imm::probability::{
    evidence, mixing_probability, mode_probability, predicted_mode_probability, relative_likelihood,
};
use immaculate::matrix::ldl;
use immaculate::model::acceleration::{
    acceleration_response, constant_acceleration, embedded_constant_velocity, embedded_velocity_response,
    position_matrix, response_noise,
};
use immaculate::model::{PolarComponent, Sensor};
use immaculate::number::{Field, Rational, Real, Surd};
use immaculate::rule::Rule;
use immaculate::rule::fifth_degree::{diagonals_minus, diagonals_plus, fifth_degree};
use immaculate::rule::third_degree::third_degree;
use nalgebra::{
    Matrix1, Matrix2, Matrix3, Matrix4, SMatrix, SVector, U1, U2, U3, U4, Vector1, Vector2, Vector3, Vector4, matrix,
    vector,
};
use num_traits::Zero;
use std::f64::consts::PI;

// zhu2016

/// zhu2016 (24): the printed form has no − x̂ x̂ᵀ and no + Q.
#[test]
fn printed_predicted_covariance_is_a_raw_second_moment_without_noise() {
    // The numbers of the erratum: a scalar that stays where it is, prior mean 3 and variance 1, Q = 2.
    let rule = Rule::<Surd, U1>::from_exact(&third_degree(1).unwrap()).unwrap();
    let points: Vec<_> = rule
        .points
        .iter()
        .map(|xi| point(&Matrix1::new(whole(1)), xi, &Vector1::new(whole(3))))
        .collect();
    let mean = weighted_mean(&rule.weights, &points);
    for noise in [2, 7] {
        let q = Matrix1::new(whole(noise));
        let printed = raw_second_moment(&rule.weights, &points);
        let corrected = raw_covariance(&rule.weights, &points, &mean, &q);
        assert_eq!(printed[0], whole(10), "whatever the noise is");
        assert_eq!(corrected[0], whole(1 + noise));
    }

    // In general the printed form is too large by x̂ x̂ᵀ − Q: here for the fifth-degree rule, with a motion.
    let rule = Rule::<Surd, U3>::from_exact(&fifth_degree(3).unwrap()).unwrap();
    let root = matrix![2, 0, 0; 1, 3, 0; -1, 2, 1].map(whole);
    let motion = matrix![1, 1, 0; 0, 1, -2; 3, 0, 1].map(whole);
    let noise = matrix![2, 1, 0; 1, 2, 0; 0, 0, 5].map(whole);
    let centre = vector![1000, -180, 7].map(whole);
    let points: Vec<_> = rule
        .points
        .iter()
        .map(|xi| propagated_point(&motion, &point(&root, xi, &centre)))
        .collect();
    let mean = weighted_mean(&rule.weights, &points);
    let expected = &motion * &root * root.transpose() * motion.transpose() + &noise;
    let corrected = raw_covariance(&rule.weights, &points, &mean, &noise);
    let centred = weighted_covariance(&rule.weights, &points, &mean, &noise);
    assert_eq!(corrected, expected);
    assert_eq!(centred, expected);
    let printed = raw_second_moment(&rule.weights, &points);
    assert_ne!(printed, expected);
    assert_eq!(printed - expected, &mean * mean.transpose() - noise);
}

/// zhu2016 (47): the printed limit n(n − 1)2 is past the last direction of (9) and (10), of which there are n(n − 1)/2.
#[test]
fn printed_upper_limit_counts_points_that_do_not_exist() {
    for n in 2..=10 {
        let printed_limit = n * (n - 1) * 2;
        let corrected_limit = n * (n - 1) / 2;
        for directions in [diagonals_plus(n), diagonals_minus(n)] {
            assert_eq!(directions.len(), corrected_limit);
            assert!(directions.get(corrected_limit - 1).is_some());
            assert!(directions.get(printed_limit - 1).is_none());
        }
    }
    // The numbers of the erratum: 6 directions for n = 4, where the printed limit asks for 24.
    assert_eq!(diagonals_plus(4).len(), 6);

    // With as many points as there are, (47) is what is missing of the covariance: (45) with h(x) = x gives P + R.
    let n = 4;
    let rule = Rule::<Surd, U4>::from_exact(&fifth_degree(n).unwrap()).unwrap();
    let first_diagonal = 1 + 2 * n;
    let sum_up_to = |limit: usize| -> Option<SMatrix<Surd, 4, 4>> {
        // P_zz1 of (46); the centre adds nothing, since it is the origin here.
        let mut sum = raw_second_moment(&rule.weights[1..first_diagonal], &rule.points[1..first_diagonal]);
        // P_zz2 of (47): the families 3 to 6 lie one after the other, n(n − 1)/2 points each.
        let families = rule.points[first_diagonal..].chunks(n * (n - 1) / 2);
        assert_eq!(families.len(), 4);
        for family in families {
            let weights = vec![rule.weights[first_diagonal].clone(); limit];
            sum += raw_second_moment(&weights, family.get(..limit)?);
        }
        Some(sum)
    };
    assert_eq!(sum_up_to(n * (n - 1) / 2), Some(SMatrix::identity()));
    assert_eq!(sum_up_to(n * (n - 1) * 2), None);
}

/// zhu2016 (57): 1/√(2πV) with a matrix V. It can be read with 2π outside of the determinant, 1/√(2π|V|), which is the form in
/// `imm::printed`, or without a determinant, 1/√(2π). Neither integrates to one when two components are measured.
#[test]
fn printed_likelihood_without_the_determinant_of_two_pi_is_not_a_density() {
    let without_determinant = |residual: &Vector2<f64>, covariance: &Matrix2<f64>| {
        let squared_distance = (covariance.try_inverse().unwrap() * residual).dot(residual);
        -(squared_distance + (2.0 * PI).ln()) / 2.0
    };
    for root in [
        matrix![2.0, 0.0; 0.0, 2.0], // V = 4 I, the numbers of the erratum
        matrix![40.0, 0.0; 3e-3, 7e-3],
        matrix![0.5, 0.0; -2.0, 8.0],
    ] {
        let covariance: Matrix2<f64> = root * root.transpose();
        let factors = ldl(&covariance);
        let corrected = integral(&root, |residual| log_density(residual, &factors));
        let printed = integral(&root, |residual| log_density_57(residual, &factors));
        let bare = integral(&root, |residual| without_determinant(residual, &covariance));
        let determinant = root[(0, 0)] * root[(1, 1)];
        assert_relative(corrected, 1.0);
        assert_relative(printed, (2.0 * PI).sqrt());
        assert_relative(bare, (2.0 * PI).sqrt() * determinant);
    }

    // One component: all is well with the first reading, and only then.
    let root = Matrix1::new(3.0);
    let factors = ldl(&(root * root.transpose()));
    let printed = integral(&root, |residual| log_density_57(residual, &factors));
    assert_relative(printed, 1.0);

    // Without a determinant a mode is not charged for expecting everything: residuals that are equally near to two modes, in the
    // units of each, move no probability, although the second mode spreads its own over four times the area.
    let (narrow, wide) = (Matrix2::identity(), Matrix2::identity() * 4.0);
    let (near, far) = (vector![1.0, 0.5], vector![2.0, 1.0]);
    let bare = probabilities(
        &[without_determinant(&near, &narrow), without_determinant(&far, &wide)],
        &[0.5, 0.5],
    );
    let corrected = probabilities(
        &[log_density(&near, &ldl(&narrow)), log_density(&far, &ldl(&wide))],
        &[0.5, 0.5],
    );
    assert_relative(bare[0], 0.5);
    assert_relative(corrected[0], 0.8);
    assert_relative(corrected[1], 0.2);
}

/// zhu2016 (62): Z = H + R adds a noise of two components to a matrix of two rows and four columns.
#[test]
fn printed_measurement_adds_noise_to_the_matrix() {
    let h = matrix![1, 0, 0, 0; 0, 0, 1, 0].map(whole_rational);
    let noise = vector![3, -2].map(whole_rational);
    // As printed there is nothing to add: the shapes differ.
    assert_ne!(h.shape(), noise.shape());
    // Were the noise added to each column, the sum would still not be a measurement of two components; and it names no state, so
    // that all targets would measure alike.
    let printed = |_: &Vector4<Rational>| {
        SMatrix::<Rational, 2, 4>::from_fn(|row, column| h[(row, column)].clone() + noise[row].clone())
    };
    let here = vector![1000, 200, 500, -7].map(whole_rational);
    let there = vector![-300, 200, 800, -7].map(whole_rational);
    assert_eq!(printed(&here), printed(&there));
    assert_ne!(printed(&here).shape(), noise.shape());

    // The corrected form measures the position, for every state.
    let measurement = |state: &Vector4<Rational>| &h * state + &noise;
    assert_eq!(measurement(&here), vector![1003, 498].map(whole_rational));
    assert_eq!(measurement(&there), vector![-297, 798].map(whole_rational));
    // And that is what the crate measures.
    let linear = Sensor::Linear(h.map(|entry| entry.to_f64()));
    assert_eq!(linear.of(&here.map(|entry| entry.to_f64())), vector![1000.0, 500.0]);
}

// liu2017

/// liu2017 (21): the exponent −n_z/2 of |2πS|, which carries the dimension already.
#[test]
fn printed_likelihood_exponent_squares_the_determinant() {
    // The density does not integrate to one but to |2πS|^(−½).
    for root in [
        matrix![2.0, 0.0; 0.0, 2.0],
        matrix![40.0, 0.0; 3e-3, 7e-3],
        matrix![0.5, 0.0; -2.0, 8.0],
    ] {
        let factors = ldl(&(root * root.transpose()));
        let corrected = integral(&root, |residual| log_density(residual, &factors));
        let printed = integral(&root, |residual| log_density_21(residual, &factors));
        let root_of_determinant = 2.0 * PI * root[(0, 0)] * root[(1, 1)];
        assert_relative(corrected, 1.0);
        assert_relative(printed, 1.0 / root_of_determinant);
    }

    // The numbers of the erratum: two modes with equal residual terms and |S| = 1 and 4. The odds are the ratio of the
    // deviations' products, √4 = 2; the printed ones are its square.
    let (small, large) = (matrix![1.0, 0.0; 0.0, 1.0], matrix![2.0, 0.0; 0.0, 2.0]);
    let (near, far) = (vector![1.0, 0.0], vector![std::f64::consts::SQRT_2, 0.0]);
    let corrected = probabilities(
        &[log_density(&near, &ldl(&small)), log_density(&far, &ldl(&large))],
        &[0.5, 0.5],
    );
    let printed = probabilities(
        &[log_density_21(&near, &ldl(&small)), log_density_21(&far, &ldl(&large))],
        &[0.5, 0.5],
    );
    assert_relative(corrected[0], 2.0 / 3.0);
    assert_relative(corrected[1], 1.0 / 3.0);
    assert_relative(printed[0], 4.0 / 5.0);
    assert_relative(printed[1], 1.0 / 5.0);

    // For one component the printed form is right.
    let scalar = ldl(&Matrix1::new(9.0));
    let residual = Vector1::new(2.0);
    assert_eq!(
        log_density_21(&residual, &scalar).to_bits(),
        log_density(&residual, &scalar).to_bits()
    );
}

/// liu2017 (21) in the paper's own setting: the first step's odds of any two modes are off by √(|Sᵢ|/|Sⱼ|), to the advantage of the
/// smaller innovation covariance.
#[test]
fn printed_likelihood_exponent_moves_probability_to_the_smaller_covariance() {
    let corrected = polar_scene("simplex-5");
    let mut printed = corrected.clone();
    printed.equations = Equations::standard().with_likelihood_21();
    let corrected = &corrected.run()[0];
    let printed = &printed.run()[0];
    let covariances = &corrected.innovation_covariances;
    assert_eq!(&printed.innovation_covariances, covariances);
    for i in 0..3 {
        for j in 0..3 {
            let odds = corrected.mode_probabilities[i] / corrected.mode_probabilities[j];
            let printed_odds = printed.mode_probabilities[i] / printed.mode_probabilities[j];
            let ratio = determinant(&covariances[j]) / determinant(&covariances[i]);
            assert_relative(printed_odds / odds, ratio.sqrt());
            if ratio > 1.01 {
                assert!(printed_odds > odds, "mode {i} has the smaller covariance");
            }
        }
    }
}

/// liu2017 (22): Lʲ under the sum over i cancels, and the measurement moves no probability.
#[test]
fn printed_normaliser_makes_the_likelihood_cancel() {
    let predicted = [0.5, 0.375, 0.125];
    // Likelihoods of 1/16, 1 and 8.
    let log_likelihoods = [-4.0, 0.0, 3.0].map(|power: f64| power * 2.0_f64.ln());
    let corrected = probabilities(&log_likelihoods, &predicted);
    // By hand: 2⁻⁴/2, 3/8 and 2³/8, over their sum.
    let terms = [1.0 / 32.0, 3.0 / 8.0, 1.0];
    let sum: f64 = terms.iter().sum();
    for j in 0..3 {
        let printed = mode_probability_22(&log_likelihoods[j], &predicted, j);
        assert_relative(printed, predicted[j]);
        assert_relative(corrected[j], terms[j] / sum);
        assert!((corrected[j] - predicted[j]).abs() > 0.1);
    }

    // Whatever is measured: here the mode is fifty standard deviations off, and keeps its probability.
    let hopeless = -1250.0 / 2.0;
    assert_relative(mode_probability_22(&hopeless, &predicted, 0), predicted[0]);
    assert!(probabilities(&[hopeless, 0.0, 0.0], &predicted)[0] < 1e-200);

    // And where the likelihood is zero as a double the printed form has no answer at all.
    assert!(mode_probability_22(&-1000.0, &predicted, 0).is_nan());
}

/// liu2017 (31): tan⁻¹(y/x) has the same value for opposite directions.
#[test]
fn plain_arctangent_confuses_opposite_quadrants() {
    let measurement = Sensor::<f64, U2, U1>::Polar {
        components: vec![PolarComponent::Bearing],
        position: [0, 1],
        location: [0.0, 0.0],
    };
    let printed = |state: &Vector2<f64>| libm::atan(state[1] / state[0]);
    let corrected = |state: &Vector2<f64>| measurement.of(state)[0];

    for direction in 0..16 {
        // Directions off the axes, all around.
        let angle = (f64::from(direction) + 0.5) * PI / 8.0;
        let state = vector![angle.cos(), angle.sin()] * 15_000.0;
        let opposite = -state;
        // The printed form cannot tell the two directions; the corrected one has them half a turn apart.
        assert_eq!(printed(&state).to_bits(), printed(&opposite).to_bits());
        assert_relative((corrected(&state) - corrected(&opposite)).abs(), PI);
        // The corrected form points to the target, the printed one only when the target is in front.
        let points_to = |bearing: f64| vector![bearing.cos(), bearing.sin()].dot(&state) / 15_000.0;
        assert_relative(points_to(corrected(&state)), 1.0);
        assert_relative(points_to(printed(&state)), state[0].signum());
        if state[0] > 0.0 {
            assert_relative(printed(&state), corrected(&state));
        }
    }
    // Where the sensor stands under the target's path, y/x has no value; here (0, 0) divides zero by zero.
    assert!(printed(&vector![0.0, 0.0]).is_nan());
    assert!(corrected(&vector![0.0, 0.0]).is_finite());
    // Straight to the left: the printed bearing is 0, the corrected one π.
    assert_eq!(printed(&vector![-1.0, 0.0]).abs().to_bits(), 0.0_f64.to_bits());
    assert_eq!(corrected(&vector![-1.0, 0.0]).to_bits(), PI.to_bits());
}

// sustika2015

/// sustika2015 (3): tan⁻¹(y/x) where the paper's target starts and flies.
#[test]
fn printed_arctangent_converts_the_first_point_to_the_opposite_one() {
    let measurement = Sensor::<f64, U2, U2>::Polar {
        components: vec![PolarComponent::Range, PolarComponent::Bearing],
        position: [0, 1],
        location: [0.0, 0.0],
    };
    let corrected = |place: &Vector2<f64>| measurement.of(place);
    let printed = |place: &Vector2<f64>| vector![measurement.of(place)[0], libm::atan(place[1] / place[0])];
    // The conversion back, (20) and (21).
    let converted = |polar: Vector2<f64>| vector![polar[0] * libm::cos(polar[1]), polar[0] * libm::sin(polar[1])];

    // The numbers of the erratum: (−1000, 1000) m lies at 135°, and at −45° as printed.
    let first = vector![-1000.0, 1000.0];
    assert_relative(corrected(&first)[1], 0.75 * PI);
    assert_relative(printed(&first)[1], -0.25 * PI);
    // Table 1's velocity, (4, 3) m/s, leaves the target to the left of the radar for all of the 200 s: no point comes back.
    for second in 0..=200 {
        let place = first + vector![4.0, 3.0] * f64::from(second);
        for component in 0..2 {
            assert_relative(converted(corrected(&place))[component], place[component]);
            assert_relative(converted(printed(&place))[component], -place[component]);
        }
        assert_relative(corrected(&place)[1] - printed(&place)[1], PI);
    }
    // To the right of the radar both are the same, and the printed form jumps by half a turn in between.
    let [left, right] = [-1.0, 1.0].map(|x| vector![x, 1600.0]);
    assert_relative(printed(&right)[1], corrected(&right)[1]);
    assert!(printed(&right)[1] - printed(&left)[1] > 0.99 * PI);
    assert!((corrected(&right)[1] - corrected(&left)[1]).abs() < 0.01 * PI);
}

// derbez2000

/// derbez2000 (2): the last line starts from the mixed covariance of the step before.
#[test]
fn printed_update_from_the_mixed_covariance_is_not_conditioning() {
    // The numbers of the erratum: F = 2, Q = 1, R = 1, mixed variance 1.
    let one = Matrix1::new(whole_rational(1));
    let predicted = kalman::predicted_covariance(&Matrix1::new(whole_rational(2)), &one, &one);
    let s = kalman::innovation_covariance(&one, &predicted, &one);
    let gain = update::gain(&kalman::cross_covariance(&predicted, &one), &ldl(&s));
    let corrected = update::updated_covariance(&predicted, &gain, &s);
    let printed = (&one - &gain * &one) * &one;
    assert_eq!(gain[0], Rational::new(5, 6));
    // Conditioning: the inverses of the variances add.
    assert_eq!(corrected[0], Rational::new(5, 6));
    assert_eq!(
        Rational::new(1, 1) / corrected[0].clone(),
        Rational::new(1, 5) + Rational::new(1, 1)
    );
    assert_eq!(printed[0], Rational::new(1, 6));

    // Constant acceleration: what is printed is no covariance at all, and the corrected line is the filter's.
    let h = position_matrix::<Rational>();
    let motion = constant_acceleration(&whole_rational(2));
    let mixed = matrix![3, 1, 0; 1, 2, 1; 0, 1, 4].map(whole_rational);
    let noise = response_noise(&acceleration_response(&whole_rational(2)), &whole_rational(5));
    let predicted = kalman::predicted_covariance(&motion, &mixed, &noise);
    let s = kalman::innovation_covariance(&h, &predicted, &one);
    let gain = update::gain(&kalman::cross_covariance(&predicted, &h), &ldl(&s));
    let rest = Matrix3::identity() - &gain * &h;
    assert_eq!(&rest * &predicted, update::updated_covariance(&predicted, &gain, &s));
    let printed = &rest * &mixed;
    assert_ne!(printed, printed.transpose());
}

/// derbez2000 (8): Π from 1 to n, read from left to right, has the matrices in the wrong order.
#[test]
fn printed_order_of_the_product_is_not_the_recursion() {
    // The numbers of the erratum: constant velocity with t = 1, measured in position, and two gains.
    let (motion, h) = (
        matrix![1, 1; 0, 1].map(whole_rational),
        matrix![1, 0].map(whole_rational),
    );
    let gains = [vector![1, 0].map(whole_rational), vector![0, 1].map(whole_rational)];
    let [first, second] = gains.clone().map(|gain| (Matrix2::identity() - gain * &h) * &motion);
    assert_eq!(&second * &first, matrix![0, 1; 0, 0].map(whole_rational));
    assert_eq!(&first * &second, matrix![0, 0; -1, 0].map(whole_rational));
    let start = vector![2, -3].map(whole_rational);
    let seen = [5, 7].map(whole_rational);
    // The filter itself, step by step.
    let step = |state: SVector<Rational, 2>, k: usize| {
        let predicted = &motion * state;
        let innovation = Vector1::new(seen[k].clone()) - &h * &predicted;
        update::updated_mean(&predicted, &gains[k], &innovation)
    };
    let filtered = step(step(start.clone(), 0), 1);
    let inputs = |k: usize| &gains[k] * seen[k].clone();
    let corrected = &second * &first * &start + &second * inputs(0) + inputs(1);
    let printed = &first * &second * &start + &second * inputs(0) + inputs(1);
    assert_eq!(filtered, corrected);
    assert_ne!(filtered, printed);
}

/// derbez2000, c = Σᵢ Λʲ c̄ⱼ: the index of the sum is not that of its terms.
#[test]
fn printed_index_of_the_normaliser_leaves_probabilities_that_do_not_sum_to_one() {
    let (likelihoods, predicted) = ([1, 3].map(whole_rational), [Rational::new(1, 2), Rational::new(1, 2)]);
    let corrected = evidence(&likelihoods, &predicted);
    assert_eq!(corrected, whole_rational(2));
    let sum = |normaliser: &Rational| {
        let of_mode = |j: usize| mode_probability(&likelihoods[j], &predicted[j], normaliser);
        of_mode(0) + of_mode(1)
    };
    assert_eq!(sum(&corrected), whole_rational(1));
    for j in 0..2 {
        // Two times the term with the index j, whichever that is.
        let printed = whole_rational(2) * likelihoods[j].clone() * predicted[j].clone();
        assert_ne!(sum(&printed), whole_rational(1), "j = {j}");
    }
}

/// derbez2000, the likelihood: √(2π|S|) has one 2π, whatever the dimension.
#[test]
fn printed_likelihood_is_a_density_for_scalar_measurements_only() {
    // It is the form of zhu2016 (57).
    let scalar = Matrix1::new(3.0);
    let plane = matrix![2.0, 0.0; 1.0, 0.5];
    let of_scalar = integral(&scalar, |residual| {
        log_density_57(residual, &ldl(&(scalar * scalar.transpose())))
    });
    let of_plane = integral(&plane, |residual| {
        log_density_57(residual, &ldl(&(plane * plane.transpose())))
    });
    assert_relative(of_scalar, 1.0);
    assert_relative(of_plane, (2.0 * PI).sqrt());
    let corrected = integral(&plane, |residual| {
        log_density(residual, &ldl(&(plane * plane.transpose())))
    });
    assert_relative(corrected, 1.0);
}

/// derbez2000, the Proposition: "one may use a non zero noise Q for the gain calculations". One must.
#[test]
fn without_noise_in_the_gain_calculation_the_mismatched_error_is_not_bounded() {
    let h = position_matrix::<f64>();
    let motion = embedded_constant_velocity(&1.0);
    // The mean error after a number of steps of a constant velocity filter that assumes `noise`, on a target with unit acceleration.
    let error_after = |steps: usize, noise: f64| {
        let noise = response_noise(&embedded_velocity_response(&1.0), &noise);
        let (mut covariance, mut error) = (Matrix3::identity(), Vector3::<f64>::zeros());
        for _ in 0..steps {
            let predicted = kalman::predicted_covariance(&motion, &covariance, &noise);
            let s = kalman::innovation_covariance(&h, &predicted, &Matrix1::identity());
            let gain = update::gain(&kalman::cross_covariance(&predicted, &h), &ldl(&s));
            covariance = update::updated_covariance(&predicted, &gain, &s);
            error = (Matrix3::identity() - gain * h) * (motion * error + acceleration_response(&1.0));
        }
        error[0]
    };
    let settled = error_after(400, 1.0);
    // It has settled: the error decays by a factor of about θ = 1 − √α < 0.6 a step, and 200 steps of that are below a rounding.
    assert_relative(error_after(200, 1.0), settled);
    // Without noise it grows like the square of time: four times as large after twice the time, in the limit.
    let growth = error_after(800, 0.0) / error_after(400, 0.0);
    assert!((growth - 4.0).abs() < 0.1, "{growth}");

    // (7) has no solution then: the gain tends to zero, A to F, and I − F has no inverse.
    let rest = Matrix3::identity() - embedded_constant_velocity(&whole_rational(1));
    assert_eq!(rest.column(0).into_owned(), Vector3::zeros());
}

/// derbez2000, step 3 of the algorithm: the spread of two models.
#[test]
fn printed_spread_of_two_models_is_not_the_mixed_covariance() {
    let estimate = |mean: i64, variance: i64| Gaussian {
        mean: Vector1::new(whole_rational(mean)),
        covariance: Matrix1::new(whole_rational(variance)),
    };
    // The truth is 0, which the second model knows exactly.
    let (components, truth) = ([estimate(4, 2), estimate(0, 1)], whole_rational(0));
    let weights = [Rational::new(3, 4), Rational::new(1, 4)];
    let mean = mixture_mean(&weights, &components);
    let mixed = mixture_covariance(&weights, &components, &mean)[0].clone();
    // By hand: ¾·2 + ¼·1, and a spread of ¾·1 + ¼·9.
    assert_eq!(mixed, Rational::new(7, 4) + whole_rational(3));
    let square = |value: Rational| value.clone() * value;
    let difference = square(components[0].mean[0].clone() - components[1].mean[0].clone());
    let error = |l: usize| square(components[l].mean[0].clone() - truth.clone());
    let sum = |spread: &dyn Fn(usize, usize) -> Rational| {
        let of = |i: usize| weights[i].clone() * (components[i].covariance[0].clone() + spread(i, 1 - i));
        of(0) + of(1)
    };
    assert_eq!(sum(&|_, l| square(weights[l].clone()) * difference.clone()), mixed);
    // The error of the other model for the difference of both, even with the right weight.
    assert_ne!(sum(&|_, l| square(weights[l].clone()) * error(l)), mixed);
    // And with the printed weight: μ^{il} of the chain p = 0.95 and even odds is 0.05, whichever of the two is meant.
    let printed = sum(&|_, l| square(Rational::new(1, 20)) * error(l));
    assert_ne!(printed, mixed);
}

/// derbez2000, section 3.1: (x̂ⁱ − x̂⁰ʲ)² is not bounded by Σ (μ^{ij})² P^{e,j}, for a symmetric chain either.
#[test]
fn printed_bound_of_the_moment_matching_term_is_exceeded() {
    // Even odds, p = 0.95; model 1 is off by 1, model 2 right: P^{e,1} = 1 and P^{e,2} = 0.
    let mixing = |previous: usize, current: usize| mixing_of(&Rational::new(1, 2), previous, current);
    let weights = [mixing(0, 1), mixing(1, 1)];
    let estimate = |mean: i64| Gaussian {
        mean: Vector1::new(whole_rational(mean)),
        covariance: Matrix1::new(whole_rational(0)),
    };
    let components = [estimate(1), estimate(0)];
    let mean = mixture_mean(&weights, &components);
    let spread = mixture_covariance(&weights, &components, &mean)[0].clone();
    assert_eq!(spread, Rational::new(475, 10_000));
    assert_eq!(spread, weights[0].clone() * weights[1].clone());
    // For i = 1 the bound is (μ^{12})² P^{e,2} = 0, for i = 2 it is (μ^{21})² P^{e,1}.
    let printed = weights[1].clone() * mixing(1, 0).pow(2);
    assert_eq!(printed, Rational::new(2375, 1_000_000));
    assert!(spread > printed);
    // The corrected bound holds for all odds.
    for hundredths in 0..=100 {
        let of_first = Rational::new(hundredths, 100);
        let product = mixing_of(&of_first, 0, 1) * mixing_of(&of_first, 1, 1);
        assert!(product <= Rational::new(1, 4));
    }
}

/// derbez2000, section 3.1: ε = (μ^{1|2})² is (1 − a)² at even odds, and not elsewhere.
#[test]
fn printed_size_of_the_mixing_probability_holds_at_even_odds_only() {
    let printed = Rational::new(1, 20).pow(2);
    for hundredths in 0..=100 {
        let epsilon = mixing_of(&Rational::new(hundredths, 100), 0, 1).pow(2);
        assert_eq!(epsilon == printed, hundredths == 50, "{hundredths}");
    }
    // The numbers of the erratum.
    assert_eq!(mixing_of(&Rational::new(95, 100), 0, 1), Rational::new(1, 2));
    assert_eq!(mixing_of(&Rational::new(1, 1), 0, 1), Rational::new(1, 1));
}

/// derbez2000, step 6 of the algorithm: Σ μⁱ P^{e,i} is not the error of the combined estimate.
#[test]
fn printed_blend_of_the_errors_is_only_an_upper_bound() {
    let square = |error: &SVector<Rational, 2>| error * error.transpose();
    for (errors, of_first) in [
        ([vector![1, 0], vector![-1, 0]], Rational::new(1, 2)),
        ([vector![3, -2], vector![1, 5]], Rational::new(1, 5)),
    ] {
        let errors = errors.map(|error| error.map(whole_rational));
        let weights = [of_first.clone(), whole_rational(1) - of_first];
        let combined = &errors[0] * weights[0].clone() + &errors[1] * weights[1].clone();
        let printed = square(&errors[0]) * weights[0].clone() + square(&errors[1]) * weights[1].clone();
        let excess = printed - square(&combined);
        let difference = &errors[0] - &errors[1];
        assert_eq!(excess, square(&difference) * (weights[0].clone() * weights[1].clone()));
        assert_ne!(excess, Matrix2::zeros());
    }
}

/// derbez2000, remark 1: the averages of (I − K H) F do not decide whether the filter is stable, even with frozen probabilities.
#[test]
fn frozen_probabilities_are_not_judged_by_the_averaged_matrices() {
    let half = |entries: [[i64; 2]; 2]| Matrix2::from_fn(|i, j| Rational::new(entries[i][j], 2));
    // Two pairs of stable matrices with μ^{1|1} and μ^{2|2}.
    let unstable = Frozen {
        matrices: [half([[-1, -4], [0, 0]]), half([[2, 2], [-3, -2]])],
        stays: [Rational::new(1, 2), Rational::new(1, 4)],
    };
    let stable = Frozen {
        matrices: [half([[3, -1], [4, -1]]), half([[-3, -3], [2, 1]])],
        stays: [Rational::new(3, 4), Rational::new(9, 10)],
    };
    for pair in [&unstable, &stable] {
        assert!(pair.matrices.iter().all(is_stable), "each is stable");
    }
    // The averages are stable and the filter is not.
    assert!(unstable.averages().iter().all(is_stable));
    assert!(!is_stable(&unstable.filter()));
    // The filter is stable and an average is not.
    assert!(!stable.averages().iter().all(is_stable));
    assert!(is_stable(&stable.filter()));
}

/// Two modes' matrices with frozen mixing probabilities.
struct Frozen {
    matrices: [Matrix2<Rational>; 2],
    /// μ^{1|1} and μ^{2|2}.
    stays: [Rational; 2],
}

impl Frozen {
    /// μ^{i|j}.
    fn mixing(&self, i: usize, j: usize) -> Rational {
        if i == j {
            self.stays[j].clone()
        } else {
            whole_rational(1) - self.stays[j].clone()
        }
    }

    /// What the paper looks at: Σⱼ μ^{j|i} Aʲ.
    fn averages(&self) -> [Matrix2<Rational>; 2] {
        [0, 1].map(|i| &self.matrices[0] * self.mixing(0, i) + &self.matrices[1] * self.mixing(1, i))
    }

    /// What the filter does to both estimates: block (j, i) is μ^{i|j} Aʲ.
    fn filter(&self) -> Matrix4<Rational> {
        Matrix4::from_fn(|row, column| {
            let (j, i) = (row / 2, column / 2);
            self.matrices[j][(row % 2, column % 2)].clone() * self.mixing(i, j)
        })
    }
}

/// Whether the spectral radius is below one: certainly so when a power has a row sum norm below one, and certainly not when the trace of
/// a power is above the dimension. The power 256, by squaring, in doubles: a rounding is far from either.
fn is_stable<const N: usize>(matrix: &SMatrix<Rational, N, N>) -> bool {
    let mut power = matrix.map(|entry| entry.to_f64());
    for _ in 0..8 {
        power *= power;
    }
    let norm = power
        .row_iter()
        .map(|row| row.iter().map(|entry| entry.abs()).sum::<f64>())
        .fold(0.0, f64::max);
    let trace = power.trace().abs();
    assert!(norm < 0.5 || trace > 2.0 * N as f64, "undecided: {norm}, {trace}");
    norm < 0.5
}

/// μ^{i|j} of two models with p = 0.95 on the diagonal, by the probability of the first.
fn mixing_of(of_first: &Rational, previous: usize, current: usize) -> Rational {
    let transition = [[19, 1], [1, 19]].map(|row| row.map(|entry| Rational::new(entry, 20)).to_vec());
    let probabilities = [of_first.clone(), whole_rational(1) - of_first.clone()];
    let predicted = predicted_mode_probability(&transition, &probabilities, current);
    mixing_probability(&transition, &probabilities, &predicted, previous, current)
}

// Helpers

/// An integer as a surd.
fn whole(value: i64) -> Surd {
    Surd::integer(value)
}

/// An integer as a rational.
fn whole_rational(value: i64) -> Rational {
    Rational::integer(value)
}

/// The determinant of a 2 × 2 matrix.
fn determinant(matrix: &Matrix2<f64>) -> f64 {
    matrix[(0, 0)] * matrix[(1, 1)] - matrix[(0, 1)] * matrix[(1, 0)]
}

/// The probabilities of modes after a measurement with these log-likelihoods.
fn probabilities<const R: usize>(log_likelihoods: &[f64; R], predicted: &[f64; R]) -> [f64; R] {
    let likelihoods = std::array::from_fn::<_, R, _>(|j| relative_likelihood(log_likelihoods, predicted, j));
    let evidence = evidence(&likelihoods, predicted);
    std::array::from_fn(|j| mode_probability(&likelihoods[j], &predicted[j], &evidence))
}

/// The integral of exp f over all residuals, by the trapezoid rule on a lattice of half a standard deviation that the root of the
/// covariance moves to where f lives, out to nine standard deviations.
///
/// For a Gaussian of unit covariance the rule's error is 2M·exp(−2π²/h²) = 2M·e⁻⁷⁹ of the integral with h = ½ (Poisson's
/// summation formula), and what lies farther out is 2M·10⁻¹⁹ of it: both are far below a rounding.
fn integral<const M: usize>(root: &SMatrix<f64, M, M>, log_density: impl Fn(&SVector<f64, M>) -> f64) -> f64 {
    let (step, reach) = (0.5, 18_i32);
    let side = usize::try_from(2 * reach + 1).unwrap();
    let cell: f64 = (0..M).map(|i| step * root[(i, i)]).product();
    let mut sum = 0.0;
    for index in 0..side.pow(u32::try_from(M).unwrap()) {
        let mut digits = index;
        let node = SVector::<f64, M>::from_fn(|_, _| {
            let coordinate = i32::try_from(digits % side).unwrap() - reach;
            digits /= side;
            f64::from(coordinate) * step
        });
        sum += Real::exp(&log_density(&(root * node)));
    }
    sum * cell
}

/// Two numbers agree but for rounding: a thousand roundings, which is more than any of the sums here has terms that count (a term
/// e^(−q/2) adds q/2 roundings of its argument, but is as much smaller).
fn assert_relative(value: f64, expected: f64) {
    approx::assert_relative_eq!(value, expected, max_relative = 1000.0 * ROUNDOFF, epsilon = 0.0);
    // The comparison can fail: an exact zero is never expected here.
    assert!(!expected.is_zero());
}
