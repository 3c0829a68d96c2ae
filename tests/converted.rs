//! Goal: the four conversions of range and bearing have the position and the covariance that they are defined by.
//!
//! Method: the code is run on rational functions. A bearing is a point of the circle with a rational parameter t, the Gaussian noise is
//! replaced by points with weights that have its moments up to degree two in r̃, cos θ̃ and sin θ̃, which is all that the definitions
//! contain; so an expectation is a finite sum, and every law holds for all r, θ, σ_r and w. That the moments of cos θ̃ and sin θ̃ are
//! those of a Gaussian is proven apart, by its series with remainder inside enclosures. Kinds of evidence: symbolic; enclosed where a law
//! is about a certain number; property, by quadrature, where it is about the wiring of the conversions in doubles; consistency, by drawn
//! measurements. Beside each law stands
//! a form that is a little wrong and is refused.

mod common;

use common::ROUNDOFF;
use immaculate::matrix::cholesky;
use immaculate::model::Conversion;
use immaculate::model::conversion::{
    additive_factor, additive_variances, converted_covariance, converted_position, in_the_plane,
    modified_unbiased_factor, modified_unbiased_variances, multiplicative_factor, multiplicative_variances,
    standard_variances,
};
use immaculate::model::conversion_moments::{
    attenuation, errors_as_measured, mean_squared_errors, over_bearings, second_moments,
};
use immaculate::model::conversion_validity::{nonlinearity, validity};
use immaculate::number::{Dual, Enclosure, Field, Rational, RationalFunction};
use immaculate::paper::monte_carlo::Generator;
use nalgebra::{Matrix2, Vector2, vector};
use num_traits::{One, Zero};
use proptest::prelude::*;

/// A number with unknowns.
type Unknown = RationalFunction;

fn unknown(name: &str) -> Unknown {
    Unknown::unknown(name)
}

fn integer(value: i64) -> Unknown {
    Unknown::integer(value)
}

fn squared(x: &Unknown) -> Unknown {
    x.clone() * x.clone()
}

/// Any direction but straight to the left, (−1, 0), to which all others tend: the cosine and the sine of 2 arctan t.
fn direction() -> Vector2<Unknown> {
    let t = unknown("t");
    let below = integer(1) + squared(&t);
    vector![(integer(1) - squared(&t)) / below.clone(), (integer(2) * t) / below]
}

/// One value of the noise, with its weight.
struct Noise {
    weight: Unknown,
    /// r̃.
    range: Unknown,
    /// cos θ̃ and sin θ̃, each replaced by the other's expectation: the pairs are on no circle.
    turn: Vector2<Unknown>,
}

/// A number that is −1, 0 or 1 and has the given mean and mean square, with the three weights.
fn three_points(mean: &Unknown, square: &Unknown) -> [(Unknown, i64); 3] {
    let half = Unknown::ratio(1, 2);
    [
        ((square.clone() - mean.clone()) * half.clone(), -1),
        (integer(1) - square.clone(), 0),
        ((square.clone() + mean.clone()) * half, 1),
    ]
}

/// Points with the moments of the noise up to degree two in r̃ and up to degree two in (cos θ̃, sin θ̃).
///
/// ```text
/// E r̃ = 0, E r̃² = σ_r²;   E cos = w, E sin = 0, E cos² = ½(1 + w⁴), E sin² = ½(1 − w⁴), E cos sin = ½ E sin 2θ̃ = 0
/// ```
fn noises() -> Vec<Noise> {
    let fourth = squared(&squared(&unknown("w")));
    let half = Unknown::ratio(1, 2);
    let ranges = three_points(&integer(0), &unknown("v"));
    let cosines = three_points(&unknown("w"), &((integer(1) + fourth.clone()) * half.clone()));
    let sines = three_points(&integer(0), &((integer(1) - fourth) * half));
    let mut noises = Vec::new();
    for (of_range, range) in &ranges {
        for (of_cosine, cosine) in &cosines {
            for (of_sine, sine) in &sines {
                noises.push(Noise {
                    weight: of_range.clone() * of_cosine.clone() * of_sine.clone(),
                    range: integer(*range),
                    turn: vector![integer(*cosine), integer(*sine)],
                });
            }
        }
    }
    noises
}

/// A direction that is turned by the noise.
fn turned(direction: &Vector2<Unknown>, by: &Vector2<Unknown>) -> Vector2<Unknown> {
    let ([c, s], [cosine, sine]) = ([0, 1].map(|i| direction[i].clone()), [0, 1].map(|i| by[i].clone()));
    vector![
        c.clone() * cosine.clone() - s.clone() * sine.clone(),
        s * cosine + c * sine
    ]
}

/// The expectation of a matrix that is a function of range and direction, where these are r and `direction` up to the noise.
fn expectation<const C: usize>(
    of: impl Fn(&Unknown, &Vector2<Unknown>) -> nalgebra::SMatrix<Unknown, 2, C>,
) -> nalgebra::SMatrix<Unknown, 2, C> {
    let mut sum = nalgebra::SMatrix::zeros();
    for noise in noises() {
        let value = of(&(unknown("r") + noise.range), &turned(&direction(), &noise.turn));
        sum += value * noise.weight;
    }
    sum
}

/// r u of a range and a direction.
fn position(range: &Unknown, direction: &Vector2<Unknown>) -> Vector2<Unknown> {
    converted_position(range, &direction[0], &direction[1])
}

/// a u uᵀ + b n nᵀ about a direction.
fn about(direction: &Vector2<Unknown>, variances: &[Unknown; 2]) -> Matrix2<Unknown> {
    in_the_plane(variances, &direction[0], &direction[1])
}

fn square(deviation: &Vector2<Unknown>) -> Matrix2<Unknown> {
    deviation * deviation.transpose()
}

/// The measured position without noise.
fn middle() -> Vector2<Unknown> {
    position(&unknown("r"), &direction())
}

// The plain conversion

#[test]
fn a_covariance_has_its_variances_along_and_across_the_line_of_sight() {
    let (a, b, u) = (unknown("a"), unknown("b"), direction());
    let n = vector![-u[1].clone(), u[0].clone()];
    let covariance = about(&u, &[a.clone(), b.clone()]);
    assert_eq!(&covariance * &u, &u * a.clone());
    assert_eq!(&covariance * &n, &n * b.clone());
    assert_ne!(&covariance * &u, &u * b);
    assert_ne!(about(&n, &[a, unknown("b")]), covariance);
}

#[test]
fn the_standard_covariance_is_the_first_order_propagation() {
    // dr and dθ by running the position on dual numbers; θ = 2 arctan t, so that dθ = 2 dt/(1 + t²).
    let (r, t) = (unknown("r"), unknown("t"));
    let of = |range: Dual<Unknown>, t: Dual<Unknown>| {
        let one = Dual::<Unknown>::one();
        let below = one.clone() + t.clone() * t.clone();
        let cosine = (one - t.clone() * t.clone()) / below.clone();
        let sine = Dual::integer(2) * t / below;
        converted_position(&range, &cosine, &sine).map(|part| part.slope().clone())
    };
    let by_range = of(Dual::variable(r.clone()), Dual::constant(t.clone()));
    let by_t = of(Dual::constant(r.clone()), Dual::variable(t.clone()));
    let by_bearing = by_t * ((integer(1) + squared(&t)) / integer(2));
    let propagated = square(&by_range) * unknown("v") + square(&by_bearing) * unknown("s");
    let u = direction();
    let converted = converted_covariance(&r, &u[0], &u[1], &unknown("v"), &unknown("s"));
    assert_eq!(converted, propagated);
    // The entries one by one, as (24), (25) and (26) are printed.
    let (across, along) = (squared(&r) * unknown("s"), unknown("v"));
    assert_eq!(
        converted[(0, 0)],
        across.clone() * squared(&u[1]) + along.clone() * squared(&u[0])
    );
    assert_eq!(
        converted[(1, 1)],
        across.clone() * squared(&u[0]) + along.clone() * squared(&u[1])
    );
    assert_eq!(
        converted[(0, 1)],
        (along.clone() - across.clone()) * u[1].clone() * u[0].clone()
    );
    // With the other sign of (26) it is none.
    assert_ne!(propagated[(0, 1)], (across - along) * u[1].clone() * u[0].clone());
}

// The moments

#[test]
fn the_moments_are_those_of_range_and_bearing() {
    let (r, v, w, f) = (unknown("r"), unknown("v"), unknown("w"), unknown("f"));
    let (r2, u) = (squared(&r), direction());
    assert_eq!(expectation(position), middle() * w.clone());
    let moment = expectation(|range, direction| square(&position(range, direction)));
    assert_eq!(moment, about(&u, &second_moments(&r2, &v, &w)));
    assert_ne!(moment, about(&u, &second_moments(&r2, &v, &squared(&w))));
    let variances = [unknown("a"), unknown("b")];
    let average = expectation(|_, direction| about(direction, &variances));
    assert_eq!(average, about(&u, &over_bearings(&variances, &w)));
    // The errors of f r u, in the axes of the truth and in those of the measurement.
    let error = |range: &Unknown, direction: &Vector2<Unknown>| position(range, direction) * f.clone() - middle();
    let errors = expectation(|range, direction| square(&error(range, direction)));
    assert_eq!(errors, about(&u, &mean_squared_errors(&f, &r2, &v, &w)));
    let parts = |range: &Unknown, direction: &Vector2<Unknown>| {
        let n = vector![-direction[1].clone(), direction[0].clone()];
        // |u|² is one, also where the points that replace a turn are not on the circle: r̂ is f r̂ u along u.
        let along = f.clone() * range.clone() - direction.dot(&middle());
        let across = n.dot(&middle());
        vector![squared(&along), squared(&across)]
    };
    let as_measured = errors_as_measured(&f, &r2, &v, &w);
    assert_eq!(expectation(parts), Vector2::from(as_measured.clone()));
    assert_ne!(as_measured, mean_squared_errors(&f, &r2, &v, &w));
}

/// Given the noise as θ̃ ~ N(0, σ²), |cos x − Σₖ₍<K₎ (−1)ᵏ x²ᵏ/(2k)!| ≤ x²ᴷ/(2K)! for every x, and E θ̃²ᵏ = (2k − 1)!! σ²ᵏ. So the sum of
/// the expectations of the terms is off by less than the expectation of the first one left out.
#[test]
fn the_mean_cosine_of_a_gaussian_angle_is_the_exponential() {
    const TERMS: i64 = 60;
    for (m, variance) in [(1, 0.125), (1, 2.0), (2, 0.0625), (2, 1.5), (3, 0.25), (4, 0.5)] {
        let exact = Rational::from_f64(variance);
        let angle = Rational::integer(m * m);
        // Term by term: (2k − 1)!! and (2k)! by their own products.
        let (mut sum, mut double_factorial, mut factorial) = (Rational::zero(), Rational::one(), Rational::one());
        let mut remainder = Rational::zero();
        for k in 0..=TERMS {
            if k > 0 {
                double_factorial *= Rational::integer(2 * k - 1);
                factorial *= Rational::integer(2 * k * (2 * k - 1));
            }
            let power = u32::try_from(k).unwrap();
            let term = (&angle * &exact).pow(power) * double_factorial.clone() / factorial.clone();
            match k {
                TERMS => remainder = term,
                _ if k % 2 == 0 => sum += term,
                _ => sum -= term,
            }
        }
        // 16 bits beside a remainder below 2⁻⁶⁴: were the two not the same number, the bracket would stick out.
        assert!(remainder < Rational::one() / Rational::integer(2).pow(64));
        let within = |w: &Enclosure, power: i64| {
            let mut cosine = Enclosure::one();
            for _ in 0..power {
                cosine *= w.clone();
            }
            cosine.contains(&(&sum - &remainder)) && cosine.contains(&(&sum + &remainder))
        };
        for bits in [16, 24, 40] {
            Enclosure::with_precision(bits, || {
                let w = attenuation(&Enclosure::exact(variance));
                assert!(within(&w, m * m), "E cos {m}θ̃ at the variance {variance}");
                assert!(!within(&w, m * m + 1));
                assert!(!within(&attenuation(&Enclosure::exact(2.0 * variance)), m * m));
            });
        }
    }
}

// The three debiased conversions

#[test]
fn the_additive_conversion_subtracts_the_mean_of_the_bias_and_has_the_mean_of_the_covariance() {
    let (r, v, w) = (unknown("r"), unknown("v"), unknown("w"));
    // Given the truth, r u is biased by (w − 1) times it; and the truth is around the measurement.
    let bias = expectation(|range, direction| position(range, direction) * (w.clone() - integer(1)));
    assert_eq!(middle() - bias, middle() * additive_factor(&w));
    let given_truth = |range: &Unknown, direction: &Vector2<Unknown>| {
        let moment = about(direction, &second_moments(&squared(range), &v, &w));
        moment - square(&(position(range, direction) * w.clone()))
    };
    let average = expectation(given_truth);
    assert_eq!(average, about(&direction(), &additive_variances(&squared(&r), &v, &w)));
    // At the measurement itself, without the average, it is another: that of modified unbiased.
    assert_ne!(given_truth(&r, &direction()), average);
    let modified = modified_unbiased_variances(&squared(&r), &v, &w);
    assert_eq!(given_truth(&r, &direction()), about(&direction(), &modified));
}

#[test]
fn the_additive_covariance_is_the_published_one() {
    let (r2, v, w, u) = (squared(&unknown("r")), unknown("v"), unknown("w"), direction());
    // e^(nσ²/2) is w⁻ⁿ.
    let power = |n: u32| (0..n).fold(integer(1), |power, _| power * w.clone());
    let half = Unknown::ratio(1, 2);
    let hyperbolic = |n: u32, sign: i64| (integer(1) / power(2 * n) + integer(sign) * power(2 * n)) * half.clone();
    let (cosh, sinh) = (|n| hyperbolic(n, 1), |n| hyperbolic(n, -1));
    let printed = |c2: &Unknown, s2: &Unknown| {
        let of_range = c2.clone() * (cosh(2) - cosh(1)) + s2.clone() * (sinh(2) - sinh(1));
        let of_noise = c2.clone() * (integer(2) * cosh(2) - cosh(1)) + s2.clone() * (integer(2) * sinh(2) - sinh(1));
        (r2.clone() * of_range + v.clone() * of_noise) * power(4)
    };
    let (c2, s2) = (squared(&u[0]), squared(&u[1]));
    let ours = about(&u, &additive_variances(&r2, &v, &w));
    assert_eq!(ours[(0, 0)], printed(&c2, &s2));
    assert_eq!(ours[(1, 1)], printed(&s2, &c2));
    let crossed = v.clone() + (r2.clone() + v) * (integer(1) - integer(1) / power(2));
    assert_eq!(ours[(0, 1)], u[1].clone() * u[0].clone() * power(8) * crossed);
}

#[test]
fn the_multiplicative_conversion_is_unbiased_given_the_truth_and_has_its_error_given_the_measurement() {
    let (r, v, w) = (unknown("r"), unknown("v"), unknown("w"));
    let f = multiplicative_factor(&w);
    assert_eq!(
        expectation(|range, direction| position(range, direction) * f.clone()),
        middle()
    );
    // The truth is around the measurement, and the error about z = f r u.
    let z = middle() * f.clone();
    let errors = expectation(|range, direction| square(&(position(range, direction) - z.clone())));
    let claimed = about(&direction(), &multiplicative_variances(&squared(&r), &v, &w));
    assert_eq!(errors, claimed);
    // It is not the error given the truth, for which the position is unbiased.
    let given_truth = about(&direction(), &mean_squared_errors(&f, &squared(&r), &v, &w));
    assert_ne!(claimed, given_truth);
}

#[test]
fn the_modified_unbiased_conversion_is_mean_and_covariance_given_the_measurement() {
    let (r, v, w) = (unknown("r"), unknown("v"), unknown("w"));
    let mean = expectation(position);
    assert_eq!(mean, middle() * modified_unbiased_factor(&w));
    let covariance = expectation(|range, direction| square(&(position(range, direction) - mean.clone())));
    let claimed = about(&direction(), &modified_unbiased_variances(&squared(&r), &v, &w));
    assert_eq!(covariance, claimed);
    // The published entries.
    let (c, s) = (direction()[0].clone(), direction()[1].clone());
    let (w2, w4) = (squared(&w), squared(&squared(&w)));
    let half = (squared(&r) + v) / integer(2);
    let twice = squared(&c) - squared(&s);
    let mean_square = |a: Unknown| w2.clone() * squared(&r) * a;
    let xx = half.clone() * (integer(1) + w4.clone() * twice.clone()) - mean_square(squared(&c));
    let yy = half.clone() * (integer(1) - w4.clone() * twice) - mean_square(squared(&s));
    let xy = half * w4 * integer(2) * s.clone() * c.clone() - mean_square(s * c);
    assert_eq!(claimed, Matrix2::new(xx, xy.clone(), xy, yy));
}

/// With W = w² = e^(−σ²), which is between 0 and 1, each variance is a sum of products of positive factors.
#[test]
fn every_covariance_is_positive_definite_but_the_standard_one_at_the_sensor() {
    let (r, v, w) = (unknown("r"), unknown("v"), unknown("w"));
    let (r2, one) = (squared(&r), || integer(1));
    let power = |n: u32| (0..n).fold(integer(1), |power, _| power * squared(&w));
    let less = |n: u32| one() - power(n);
    let half = |x: Unknown| x / integer(2);
    let across = || half((r2.clone() + v.clone()) * less(2));
    assert_eq!(
        modified_unbiased_variances(&r2, &v, &w),
        [
            half(r2.clone() * squared(&less(1)) + v.clone() * (one() + power(2))),
            across()
        ]
    );
    let bent = squared(&less(1)) * (power(1) + integer(2)) / power(1);
    assert_eq!(
        multiplicative_variances(&r2, &v, &w),
        [half(r2.clone() * bent + v.clone() * (one() + power(2))), across()]
    );
    let (along, sideways) = (less(1) * less(3), less(1) * (one() + power(3)));
    assert_eq!(
        additive_variances(&r2, &v, &w),
        [
            half(r2.clone() * along.clone() + v.clone() * (along + one() + power(4))),
            half(r2.clone() * sideways.clone() + v.clone() * (sideways + less(4))),
        ]
    );
    // The determinant of the standard one is σ_r² r² σ_θ².
    let u = direction();
    let standard = |r: &Unknown| converted_covariance(r, &u[0], &u[1], &v, &unknown("s"));
    let determinant =
        |m: Matrix2<Unknown>| m[(0, 0)].clone() * m[(1, 1)].clone() - m[(0, 1)].clone() * m[(1, 0)].clone();
    assert_eq!(determinant(standard(&r)), v.clone() * r2.clone() * unknown("s"));
    assert_eq!(determinant(standard(&Unknown::zero())), Unknown::zero());
    assert_eq!(
        standard_variances(&r2, &v, &unknown("s")),
        [v.clone(), r2 * unknown("s")]
    );
}

#[test]
fn the_covariances_agree_to_first_order_and_the_factors_do_not() {
    // ε is the size of both variances; w = e^(−σ²/2) is 1 − σ²/2 to first order.
    let first_order = |name: &str| Dual::new(Unknown::zero(), unknown(name));
    let (v, s) = (first_order("v"), first_order("s"));
    let w = Dual::new(integer(1), -unknown("s") / integer(2));
    let r2 = Dual::constant(squared(&unknown("r")));
    let mut slopes = Vec::new();
    for conversion in Conversion::ALL {
        let [along, across] = conversion.variances(&r2, &v, &s, &w);
        assert_eq!(
            [along.value(), across.value()],
            [&Unknown::zero(), &Unknown::zero()],
            "{conversion}"
        );
        assert_eq!(*along.slope(), unknown("v"), "{conversion}");
        assert_eq!(*across.slope(), squared(&unknown("r")) * unknown("s"), "{conversion}");
        let factor = conversion.factor(&w);
        assert_eq!(*factor.value(), integer(1));
        slopes.push(factor.slope().clone());
    }
    let half = || unknown("s") / integer(2);
    assert_eq!(slopes, [integer(0), half(), half(), -half()]);
}

// Where they are valid

/// With w = 1 − s/2 + s²/8 − c s³, s = σ_θ²: the exponential series with all that follows in c, which is bounded. What is true for every c
/// at s = 0 is the limit. A fraction of polynomials whose common powers of s are cancelled has it as its value at s = 0.
#[test]
fn a_conversion_is_as_valid_as_its_nonlinearity_says() {
    let (rho, s) = (unknown("rho"), unknown("s"));
    let w = integer(1) - s.clone() / integer(2) + squared(&s) / integer(8) - unknown("c") * squared(&s) * s.clone();
    let at_zero = |function: &Unknown| {
        let assignments = [("s", Unknown::zero()), ("rho", unknown("rho")), ("c", unknown("c"))];
        function.substitute(&assignments)
    };
    let of = |numerator: i64, denominator: i64| Unknown::ratio(numerator, denominator);
    let grown = |by: &Unknown| integer(1) + by.clone() * squared(&rho);
    // Bias, error and claim along the measured and along the true line of sight.
    let expected = [
        (of(-1, 2), [of(3, 4), of(0, 1), of(3, 4), of(1, 1)]),
        (of(0, 1), [of(3, 2), of(3, 2), of(1, 2), of(5, 2)]),
        (of(0, 1), [of(3, 2), of(3, 2), of(1, 2), of(5, 2)]),
        (of(-1, 1), [of(1, 2), of(1, 2), of(3, 2), of(3, 2)]),
    ];
    for (conversion, (bias, [error, claim, true_error, true_claim])) in Conversion::ALL.into_iter().zip(expected) {
        let found = validity(conversion, &rho, &s, &w);
        assert_eq!(at_zero(&found.bias), bias * rho.clone(), "{conversion}");
        assert_eq!(
            at_zero(&found.as_measured[0]),
            grown(&error) / grown(&claim),
            "{conversion}"
        );
        assert_eq!(
            at_zero(&found.as_true[0]),
            grown(&true_error) / grown(&true_claim),
            "{conversion}"
        );
        // What is claimed is the average over measured ranges: at r ± σ_r, which have the mean r and the variance σ_r².
        let (r, factor) = (rho.clone() / s.clone(), conversion.factor(&w));
        let claims = [r.clone() + integer(1), r.clone() - integer(1)]
            .map(|range| conversion.variances(&squared(&range), &integer(1), &s, &w));
        let errors = errors_as_measured(&factor, &squared(&r), &integer(1), &w);
        for axis in 0..2 {
            let claim = (claims[0][axis].clone() + claims[1][axis].clone()) / integer(2);
            assert_eq!(found.as_measured[axis].clone() * claim, errors[axis], "{conversion}");
        }
        for across in [&found.as_measured[1], &found.as_true[1]] {
            assert_eq!(at_zero(across), integer(1), "{conversion}");
            assert_ne!(*across, integer(1), "and only in the limit");
        }
    }
    // ρ/2 is the bias to first order in units of σ_r.
    let half_bend = unknown("r") * s.clone() / integer(2) / unknown("d");
    assert_eq!(nonlinearity(&unknown("r"), &unknown("d"), &s) / integer(2), half_bend);
}

/// Measurements are drawn and converted as a filter would, and each average is compared with its closed form.
///
/// 4 conversions × 2 deviations × 5 averages: were all deviations Gaussian, one in forty would be beyond 4.5 standard errors with a
/// probability of 3·10⁻⁴. The seed is fixed.
#[test]
fn errors_and_claims_are_those_of_runs() {
    const RUNS: u32 = 40_000;
    let mut generator = Generator::new(20_150_301, 0);
    for deviation in [0.02, 0.3_f64] {
        // ρ = 1 with σ_r = 1 m, and the target at an angle off the axes.
        let (s, rho, bearing) = (deviation * deviation, 1.0, 0.7_f64);
        let range = rho / s;
        let u = vector![bearing.cos(), bearing.sin()];
        let truth = u * range;
        for conversion in Conversion::ALL {
            let expected = validity(conversion, &rho, &s, &attenuation(&s));
            let mut samples: [Vec<f64>; 5] = Default::default();
            for _ in 0..RUNS {
                let measured = range + generator.standard_normal();
                let angle = bearing + deviation * generator.standard_normal();
                let error = conversion.position(&measured, &angle, &s) - truth;
                let claimed = conversion.covariance(&measured, &angle, &1.0, &s);
                let line = vector![angle.cos(), angle.sin()];
                let across = |u: &Vector2<f64>| vector![-u[1], u[0]];
                let ratio = |axis: Vector2<f64>, ratio: f64| {
                    // Zero on average, if error² is `ratio` times what is claimed.
                    axis.dot(&error) * axis.dot(&error) - ratio * axis.dot(&(claimed * axis))
                };
                samples[0].push(u.dot(&error) - expected.bias);
                samples[1].push(ratio(line, expected.as_measured[0]));
                samples[2].push(ratio(across(&line), expected.as_measured[1]));
                samples[3].push(ratio(u, expected.as_true[0]));
                samples[4].push(ratio(across(&u), expected.as_true[1]));
            }
            for (kind, sample) in samples.iter().enumerate() {
                let n = sample.len() as f64;
                let mean = sample.iter().sum::<f64>() / n;
                let variance = sample.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0);
                let off = mean / (variance / n).sqrt();
                assert!(
                    off.abs() < 4.5,
                    "{conversion}, {deviation}, average {kind}: {off} standard errors"
                );
            }
        }
    }
}

// In doubles and in enclosures

/// The rounding that the head of `src/model/conversion.rs` speaks of, in units of r² 2⁻⁵³: the exponential is off by 2 at most, which
/// makes 4 of each variance, whose slopes by w are 0 along and −2 across where w is near 1; and a dozen roundings of halves of such terms
/// add 6. The bound is the next power of two. Met are 4, r² 2⁻⁵¹.
#[test]
fn doubles_lose_the_squared_range_times_their_last_place() {
    let mut greatest = 0.0_f64;
    for k in 0..200 {
        let (range, deviation) = (1e3 + 997.3 * f64::from(k), 1e-4 * (1.0 + f64::from(k)));
        let (v, s) = (1e-6, deviation * deviation);
        for conversion in Conversion::ALL {
            let [along, across] = conversion.variances(&(range * range), &v, &s, &attenuation(&s));
            let exact = Enclosure::with_precision(300, || {
                let of = Enclosure::exact;
                let r2 = of(range) * of(range);
                let exact = conversion.variances(&r2, &of(v), &of(s), &attenuation(&of(s)));
                exact.map(|value| value.to_f64().expect("300 bits are enough"))
            });
            let lost = (along - exact[0]).abs().max((across - exact[1]).abs()) / (range * range);
            assert!(lost < 16.0 * ROUNDOFF, "{conversion}: {}", lost / ROUNDOFF);
            greatest = greatest.max(lost);
        }
    }
    // And it is lost: no better is promised.
    assert!(greatest > ROUNDOFF, "{}", greatest / ROUNDOFF);
}

/// E f(v) of v ~ N(0, σ²), by the trapezoid rule out to ten deviations in steps of a quarter, whose error is far below a rounding.
fn integral(deviation: f64, f: impl Fn(f64) -> f64) -> f64 {
    let weight = |i: i32| (-0.5 * (f64::from(i) / 4.0).powi(2)).exp();
    let nodes = || -40..=40;
    let total: f64 = nodes().map(weight).sum();
    let sum: f64 = nodes().map(|i| weight(i) * f(deviation * f64::from(i) / 4.0)).sum();
    sum / total
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    /// The wiring in doubles: the variances and not the deviations, the bearing itself, each conversion its own factor.
    #[test]
    fn each_conversion_takes_out_the_bias_that_it_names(
        range in 1.0..1e5_f64,
        bearing in -3.1..3.1_f64,
        deviation in 0.001..0.5_f64,
    ) {
        let variance = deviation * deviation;
        let converted = |conversion: Conversion, noise: f64| {
            conversion.position(&range, &(bearing + noise), &variance) / range
        };
        let truth = vector![bearing.cos(), bearing.sin()];
        let mean = |conversion| Vector2::from([0, 1].map(|i| integral(deviation, |noise| converted(conversion, noise)[i])));
        // A hundred roundings of numbers no larger than two.
        let tolerance = 200.0 * ROUNDOFF;
        prop_assert!((mean(Conversion::Multiplicative) - truth).norm() < tolerance);
        // Given the measurement the target is where a plain conversion of its noise would be.
        let given_measurement = mean(Conversion::Standard);
        prop_assert!((given_measurement - converted(Conversion::ModifiedUnbiased, 0.0)).norm() < tolerance);
        // What the bias is, on average over that.
        let shrink = integral(deviation, f64::cos);
        let without = truth - given_measurement * (shrink - 1.0);
        prop_assert!((without - converted(Conversion::Additive, 0.0)).norm() < tolerance);
        prop_assert!((given_measurement.norm() - 1.0).abs() > variance / 3.0);
    }

    #[test]
    fn the_slopes_of_a_position_give_its_covariance(
        range in 1.0..1e5_f64,
        bearing in -3.1..3.1_f64,
        v in 0.01..1e4_f64,
        s in 1e-8..0.2_f64,
    ) {
        let of = |range: Dual<f64>, bearing: Dual<f64>| {
            let position = Conversion::Standard.position(&range, &bearing, &Dual::constant(s));
            position.map(|part| *part.slope())
        };
        let by_range = of(Dual::variable(range), Dual::constant(bearing));
        let by_bearing = of(Dual::constant(range), Dual::variable(bearing));
        let propagated = by_range * by_range.transpose() * v + by_bearing * by_bearing.transpose() * s;
        let claimed = Conversion::Standard.covariance(&range, &bearing, &v, &s);
        // Fewer than twenty roundings of terms no larger than the greatest entry.
        prop_assert!((claimed - propagated).norm() < 20.0 * ROUNDOFF * (v + range * range * s));
    }

    /// σ_r from a decimetre to 100 m out to 100 km: where doubles lose less than σ_r².
    #[test]
    fn covariances_are_positive_definite_in_doubles(
        range in 1.0..1e5_f64,
        bearing in -3.1..3.1_f64,
        v in 0.01..1e4_f64,
        deviation in 1e-4..0.5_f64,
    ) {
        for conversion in Conversion::ALL {
            let covariance = conversion.covariance(&range, &bearing, &v, &(deviation * deviation));
            prop_assert!(cholesky(&covariance).is_ok(), "{}: {}", conversion, covariance);
        }
    }
}

#[test]
fn every_conversion_is_found_by_its_name() {
    for conversion in Conversion::ALL {
        assert_eq!(conversion.name().parse(), Ok(conversion));
        assert_eq!(conversion.to_string(), conversion.name());
    }
    let refused = "unbiased".parse::<Conversion>().unwrap_err();
    assert!(refused.to_string().starts_with("`unbiased` is no conversion"));
}

// What is printed

/// For small σ_θ the three limits are where |ratio − 1| is 0.1 and where the bias is 0.2 in the closed forms above: √(0.1/0.75) = 0.365,
/// √(0.1/0.15) = 0.816, √(0.1/1.75) = 0.239, and 0.4 and 0.2.
#[test]
fn the_table_has_the_limits_of_the_closed_forms() {
    let table = immaculate::report::conversion::table();
    let of = |conversion: Conversion| -> Vec<&str> {
        let rows = table
            .lines()
            .filter(|line| line.trim_start().starts_with(conversion.name()));
        // The first three tables, and their column of 0.1°.
        rows.take(3).filter_map(|row| row.split_whitespace().nth(1)).collect()
    };
    assert_eq!(of(Conversion::Standard), ["0.37", "0.82", "0.40"]);
    assert_eq!(of(Conversion::Additive), ["every", "0.24", "every"]);
    assert_eq!(of(Conversion::Multiplicative), ["every", "0.24", "every"]);
    assert_eq!(of(Conversion::ModifiedUnbiased), ["every", "every", "0.20"]);
    let words = table.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        words.contains("At ρ = 0.4 its bias is -0.20 σ_r, and its mean squared error 1.12 of"),
        "{table}"
    );
    assert!(table.lines().all(|line| line.chars().count() <= 100), "{table}");
    insta::assert_snapshot!("validity_of_conversions", table);
}

#[test]
fn the_figure_names_what_it_shows() {
    let figure = immaculate::report::conversion::figure().expect("it can be drawn");
    for words in Conversion::ALL.map(Conversion::name) {
        assert!(figure.contains(words), "{words}");
    }
    assert!(figure.contains("σ_θ = 20°") && figure.contains("bias (σ_r)"));
}
