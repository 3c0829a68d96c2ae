//! Goal: the equations of filter and cycle that the papers print wrongly are wrong, and their corrected forms are right.
//!
//! Method: for each erratum one test in which the printed form fails and the corrected one passes the same question. Kind of
//! evidence: exact where the form is algebra (rationals and surds, no tolerance), quadrature or a comparison of doubles where it
//! is a density, with the reason of each tolerance beside it. The weights of the rules are printed wrongly too; they are elsewhere.

mod common;

use common::{ROUNDOFF, polar_scene};
use immaculate::filter::cubature::{point, propagated_point, weighted_covariance, weighted_mean};
use immaculate::filter::raw::{raw_covariance, raw_second_moment};
use immaculate::gaussian::log_density;
use immaculate::imm::printed::{cubature_with_likelihood_21, log_density_21, log_density_57, mode_probability_22};
use immaculate::imm::probability::{evidence, mode_probability, relative_likelihood};
use immaculate::matrix::ldl;
use immaculate::model::{Measurement, PolarComponent};
use immaculate::number::{Field, Rational, Real, Surd};
use immaculate::rule::Rule;
use immaculate::rule::fifth_degree::{diagonals_minus, diagonals_plus, fifth_degree};
use immaculate::rule::third_degree::third_degree;
use nalgebra::{Matrix1, Matrix2, SMatrix, SVector, Vector1, Vector2, Vector4, matrix, vector};
use num_traits::Zero;
use std::f64::consts::PI;

// zhu2016

/// zhu2016 (24): the printed form has no − x̂ x̂ᵀ and no + Q.
#[test]
fn printed_predicted_covariance_is_a_raw_second_moment_without_noise() {
    // The numbers of the erratum: a scalar that stays where it is, prior mean 3 and variance 1, Q = 2.
    let rule = Rule::<Surd, 1>::from_exact(&third_degree(1).unwrap()).unwrap();
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
    let rule = Rule::<Surd, 3>::from_exact(&fifth_degree(3).unwrap()).unwrap();
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
    let rule = Rule::<Surd, 4>::from_exact(&fifth_degree(n).unwrap()).unwrap();
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
    let linear = Measurement::Linear(h.map(|entry| entry.to_f64()));
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
    printed.equations = cubature_with_likelihood_21();
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
    let measurement = Measurement::<f64, 2, 1>::Polar {
        components: [PolarComponent::Bearing],
        position: [0, 1],
        sensor: [0.0, 0.0],
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
