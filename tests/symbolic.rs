//! Goal: the equations hold for all inputs, and the rules have their degree in every dimension.
//!
//! Method: the code of the equations is run on rational functions of named unknowns, and both sides of a law are compared as
//! fractions of polynomials. Kind of evidence: symbolic; an identity that passes here holds for all values of its unknowns for
//! which no denominator is zero. Beside each law stands a form that is a little wrong and is refused.
//!
//! One test runs on random rationals and surds instead, where four unknown dimensions would be too many.

use immaculate::filter::cubature::{point, propagated_point, weighted_covariance, weighted_mean};
use immaculate::filter::kalman::{cross_covariance, innovation_covariance, predicted_covariance, predicted_mean};
use immaculate::filter::raw::{raw_covariance, raw_cross_covariance, raw_second_moment};
use immaculate::filter::update::{gain, updated_covariance, updated_mean};
use immaculate::gaussian::{Gaussian, mixture_covariance, mixture_mean};
use immaculate::imm::probability::{mixing_probability, predicted_mode_probability};
use immaculate::matrix::{ldl, quadratic_form, solve};
use immaculate::model::motion::{
    acceleration_input, acceleration_noise, constant_velocity, integrated_noise, turn_matrix, turn_noise_matrix,
};
use immaculate::model::wiener::{
    acceleration_noise_in_the_plane, constant_acceleration_in_the_plane, constant_velocity_in_the_plane, in_the_plane,
    velocity_noise_in_the_plane,
};
use immaculate::number::{Field, Rational, RationalFunction, Roots, Surd};
use immaculate::paper::zhu2016::diagonal_mixing;
use immaculate::rule::simplex::{self, below_diagonal_squared, on_diagonal_squared, radial_rule, simplex};
use immaculate::rule::sphere::{
    SphericalRule, every_dimension, gegenbauer, harmonic_sum, on_axes, on_axes_and_diagonals, on_simplex, radial_moment,
};
use immaculate::rule::unscented::{self, Parameters};
use immaculate::rule::{ExactRule, Rule, fifth_degree, printed, third_degree};
use nalgebra::{Const, Matrix2, Matrix3, Matrix4, Matrix4x2, SMatrix, SVector, U2, Vector2, matrix, vector};
use num_traits::{One, Zero};

/// A number with unknowns.
type Unknown = RationalFunction;

// The degrees of the rules, for every n at once: every n but 1, where the polynomials of the harmonic sums divide by n − 1, and
// which `exact.rs` covers

#[test]
fn third_degree_rule_has_degree_three_in_every_dimension() {
    let n = every_dimension();
    let rule = on_axes(&n, Unknown::zero(), &third_degree::axis_weight(&n), n.clone());
    assert_eq!(rule.degree(), Some(3));
    // Degree four fails in both of its conditions: the radius, and the directions.
    assert_ne!(radial_sum(&rule, 2), radial_moment(&n, 2));
    assert!(!harmonic_sum(&n, 2, &rule.products).is_zero());
    // Another radius or weight has no such degree.
    let longer = on_axes(
        &n,
        Unknown::zero(),
        &third_degree::axis_weight(&n),
        n.clone() + Unknown::one(),
    );
    assert_eq!(longer.degree(), Some(1));
    let heavier = on_axes(&n, Unknown::zero(), &(Unknown::one() / n.clone()), n.clone());
    assert_eq!(heavier.degree(), None);
}

#[test]
fn unscented_rule_has_degree_three_in_every_dimension() {
    let (n, lambda) = (every_dimension(), unknown("lambda"));
    let of_lambda = |lambda: &Unknown| {
        on_axes(
            &n,
            unscented::centre_weight(&n, lambda),
            &unscented::axis_weight(&n, lambda),
            n.clone() + lambda.clone(),
        )
    };
    let rule = of_lambda(&lambda);
    assert_eq!(rule.degree(), Some(3));
    assert_ne!(radial_sum(&rule, 2), radial_moment(&n, 2));
    // λ = 2 gets the radial moment of degree four right as well; the directions stay those of the axes.
    let with_two = of_lambda(&number(2));
    assert_eq!(radial_sum(&with_two, 2), radial_moment(&n, 2));
    assert!(!harmonic_sum(&n, 2, &with_two.products).is_zero());
    assert_eq!(with_two.degree(), Some(3));
    // Weights of one λ with the radius of another.
    let mismatched = SphericalRule {
        radius_squared: n.clone(),
        ..of_lambda(&lambda)
    };
    assert_eq!(mismatched.degree(), Some(1));
}

#[test]
fn fifth_degree_rule_has_degree_five_in_every_dimension() {
    let n = every_dimension();
    let rule = on_axes_and_diagonals(&n, &fifth_degree::diagonal_weight(&n));
    check_degree_five_and_not_six(&rule);
    // The weight as printed, and others, sum to something else than one.
    let as_printed = on_axes_and_diagonals(&n, &printed::diagonal_weight(&n));
    assert_eq!(as_printed.degree(), None);
    let sum = as_printed.centre + as_printed.sphere;
    let n_plus_2_squared = square(&(n.clone() + number(2)));
    assert_eq!(
        sum,
        (number(3) * square(&n) + number(2) * n + number(4)) / n_plus_2_squared
    );
}

#[test]
fn simplex_rule_has_degree_five_in_every_dimension() {
    let n = every_dimension();
    let rule = on_simplex(&n, &simplex::edge_weight(&n));
    check_degree_five_and_not_six(&rule);
    for as_printed in [printed::edge_weight_11(&n), printed::edge_weight_16(&n)] {
        assert_eq!(on_simplex(&n, &as_printed).degree(), None);
    }
}

#[test]
fn a_count_or_a_weight_that_is_a_little_off_loses_the_degree_in_every_dimension() {
    let n = every_dimension();
    for rule in [
        on_axes_and_diagonals(&n, &fifth_degree::diagonal_weight(&n)),
        on_simplex(&n, &simplex::edge_weight(&n)),
    ] {
        for index in 0..rule.products.len() {
            let mut one_more = rule.clone();
            one_more.products[index].pairs += Unknown::one();
            // One pair more or less is seen in degree two already.
            assert_eq!(one_more.degree(), Some(1), "{index}");
        }
    }
}

#[test]
fn sphere_weights_of_the_simplex_sum_to_the_surface_in_every_dimension() {
    let n = every_dimension();
    let vertices = number(2) * (n.clone() + Unknown::one());
    let midpoints = n.clone() * (n.clone() + Unknown::one());
    let sum = |vertex: Unknown, edge: Unknown| vertices.clone() * vertex + midpoints.clone() * edge;
    let corrected = sum(simplex::sphere_vertex_weight(&n), simplex::sphere_edge_weight(&n));
    assert_eq!(corrected, Unknown::one());
    let as_printed = sum(printed::sphere_vertex_weight(&n), printed::sphere_edge_weight(&n));
    assert_eq!(
        as_printed,
        n.clone() * (number(5) * n.clone() + number(1)) / ((n.clone() + number(1)) * square(&(n.clone() + number(2))))
    );
    // The rule's weights are those of the sphere times the weight n/(n + 2) of the radial rule, and its centre's is the rest.
    let (centre, sphere, _) = radial_rule(&n);
    assert_eq!(simplex::centre_weight(&n), centre);
    assert_eq!(
        simplex::vertex_weight(&n),
        simplex::sphere_vertex_weight(&n) * sphere.clone()
    );
    assert_eq!(simplex::edge_weight(&n), simplex::sphere_edge_weight(&n) * sphere);
}

#[test]
fn radial_rule_matches_the_moments_zero_two_and_four() {
    let n = every_dimension();
    let (centre, sphere, squared) = radial_rule(&n);
    let half = n.clone() / number(2);
    // ½Γ((n + l)/2) as a part of ½Γ(n/2), by Γ(x + 1) = x Γ(x).
    assert_eq!(centre + sphere.clone(), Unknown::one());
    assert_eq!(sphere.clone() * squared.clone(), half);
    assert_eq!(
        sphere.clone() * square(&squared),
        half.clone() * (half.clone() + Unknown::one())
    );
    // Two nodes at zero and r have no more to give: degree six fails.
    let sixth = half.clone() * (half.clone() + Unknown::one()) * (half.clone() + number(2));
    assert_ne!(sphere.clone() * square(&squared) * squared.clone(), sixth);
    // liu2017 (9) as printed has r₂⁰ in the second row.
    assert_ne!(sphere.clone(), half);
    // In the variable of the standard Gaussian the radius is √2 r₂.
    let in_gaussian = number(2) * squared;
    assert_eq!(sphere.clone() * in_gaussian.clone(), radial_moment(&n, 1));
    assert_eq!(sphere * square(&in_gaussian), radial_moment(&n, 2));
}

// The Gegenbauer polynomials

#[test]
fn gegenbauer_polynomials_have_their_closed_forms() {
    let (n, t) = (every_dimension(), unknown("t"));
    let squared = square(&t);
    for k in 0..=3 {
        let closed = polynomial(&gegenbauer_coefficients(&n, k), &squared);
        assert_eq!(gegenbauer(&n, k, &squared), closed, "degree {}", 2 * k);
        assert_eq!(gegenbauer(&n, k, &Unknown::one()), Unknown::one());
    }
    // The plane: Chebyshev, cos 2kφ in cos φ. Space: Legendre. Four dimensions: Chebyshev's second kind over 2k + 1.
    let known = [
        (2, [[-1, 2, 0, 0], [1, -8, 8, 0], [-1, 18, -48, 32]], [1, 1, 1]),
        (3, [[-1, 3, 0, 0], [3, -30, 35, 0], [-5, 105, -315, 231]], [2, 8, 16]),
        (4, [[-1, 4, 0, 0], [1, -12, 16, 0], [-1, 24, -80, 64]], [3, 5, 7]),
    ];
    for (dimension, numerators, denominators) in known {
        for (k, (numerators, denominator)) in (1..).zip(numerators.iter().zip(denominators)) {
            let coefficients = numerators.map(number);
            let expected = polynomial(&coefficients, &squared) / number(denominator);
            assert_eq!(gegenbauer(&number(dimension), k, &squared), expected);
        }
    }
}

#[test]
fn gegenbauer_polynomials_are_orthogonal_on_the_sphere() {
    let n = every_dimension();
    for k in 0..=3 {
        for l in 0..=3 {
            let left = gegenbauer_coefficients(&n, k);
            let right = gegenbauer_coefficients(&n, l);
            let mut mean = Unknown::zero();
            for (i, a) in left.iter().enumerate() {
                for (j, b) in right.iter().enumerate() {
                    mean += a.clone() * b.clone() * mean_of_power_on_sphere(&n, i + j);
                }
            }
            assert_eq!(mean.is_zero(), k != l, "degrees {} and {}", 2 * k, 2 * l);
        }
    }
}

// The simplex

#[test]
fn simplex_vertices_are_unit_vectors_with_equal_angles() {
    let (n, m) = (every_dimension(), unknown("m"));
    let one = Unknown::one;
    // Below the diagonal: the sum over the first m − 1 coordinates, by induction over m.
    let sum_before = |m: &Unknown| {
        let length = n.clone() + one();
        length.clone() / n.clone() * (one() / (n.clone() - m.clone() + number(2)) - one() / length)
    };
    let next = m.clone() + one();
    assert!(sum_before(&one()).is_zero());
    assert_eq!(sum_before(&next) - sum_before(&m), below_diagonal_squared(&n, &m));
    assert_ne!(sum_before(&next) - sum_before(&m), on_diagonal_squared(&n, &m));

    // Length: the sum before the diagonal and the diagonal; the last vertex, n + 1, has n coordinates below it.
    assert_eq!(sum_before(&m) + on_diagonal_squared(&n, &m), one());
    assert_eq!(sum_before(&(n.clone() + one())), one());

    // The coordinates m of vertex m and of a later one have the product −√(on · below), the root of a square.
    let root = (n.clone() + one()) / (n.clone() * (n.clone() - m.clone() + number(2)));
    assert_eq!(
        square(&root),
        on_diagonal_squared(&n, &m) * below_diagonal_squared(&n, &m)
    );
    // Angle: vertices m < j share the coordinates before m, and differ in sign at m; beyond it vertex m has none.
    assert_eq!(sum_before(&m) - root, -one() / n.clone());

    // Sum zero, coordinate by coordinate: one vertex on the diagonal against n + 1 − m below it.
    let later = n.clone() + one() - m.clone();
    assert_eq!(
        on_diagonal_squared(&n, &m),
        square(&later) * below_diagonal_squared(&n, &m)
    );
}

// Factorisations

#[test]
fn the_ldl_factors_multiply_to_the_matrix() {
    check_ldl_product(&symmetric::<2>("p"));
    check_ldl_product(&symmetric::<3>("p"));
    // Only the lower triangle is read.
    let skew = matrix![unknown("a"), unknown("x"); unknown("b"), unknown("d")];
    let factors = ldl(&skew);
    let product = &factors.lower * Matrix2::from_diagonal(&factors.diagonal) * factors.lower.transpose();
    assert_eq!(product[(0, 1)], unknown("b"));
    assert_ne!(product, skew);
}

#[test]
fn solving_with_the_ldl_factors_inverts_the_matrix() {
    let p2 = symmetric::<2>("p");
    assert_eq!(&p2 * solve(&ldl(&p2), &Matrix2::identity()), Matrix2::identity());
    let p3 = symmetric::<3>("p");
    let inverse = solve(&ldl(&p3), &Matrix3::identity());
    assert_eq!(&p3 * &inverse, Matrix3::identity());
    assert_eq!(inverse, adjugate_inverse(&p3));
    // A matrix that is not symmetric is not inverted: its upper triangle is never seen.
    let skew = matrix![unknown("a"), unknown("x"); unknown("b"), unknown("d")];
    assert_ne!(&skew * solve(&ldl(&skew), &Matrix2::identity()), Matrix2::identity());
}

#[test]
fn the_quadratic_form_is_the_one_of_the_inverse() {
    let p2 = symmetric::<2>("p");
    let v2 = unknowns::<2>("v");
    let determinant = p2[(0, 0)].clone() * p2[(1, 1)].clone() - square(&p2[(0, 1)]);
    let by_hand = (square(&v2[0]) * p2[(1, 1)].clone()
        - number(2) * v2[0].clone() * v2[1].clone() * p2[(0, 1)].clone()
        + square(&v2[1]) * p2[(0, 0)].clone())
        / determinant;
    assert_eq!(quadratic_form(&ldl(&p2), &v2), by_hand);

    let p3 = symmetric::<3>("p");
    let v3 = unknowns::<3>("v");
    let inverse = adjugate_inverse(&p3);
    let form = (v3.transpose() * &inverse * &v3)[(0, 0)].clone();
    assert_eq!(quadratic_form(&ldl(&p3), &v3), form);
    assert_ne!((v3.transpose() * &p3 * &v3)[(0, 0)], form);
}

// Mixtures

#[test]
fn mixed_moments_are_those_of_the_mixture() {
    let components = gaussians::<2>(3);
    let weights = weights_that_sum_to_one(3);
    let mean = mixture_mean(&weights, &components);
    let covariance = mixture_covariance(&weights, &components, &mean);
    // The mean and the raw second moment of a mixture are the weighted ones, E x = E E(x∣i) and E xxᵀ = E E(xxᵀ∣i).
    let mut expected_mean = Vector2::zeros();
    let mut second_moment = Matrix2::zeros();
    for (weight, component) in weights.iter().zip(&components) {
        let raw = &component.covariance + &component.mean * component.mean.transpose();
        expected_mean += &component.mean * weight.clone();
        second_moment += raw * weight.clone();
    }
    assert_eq!(mean, expected_mean);
    assert_eq!(&covariance + &mean * mean.transpose(), second_moment);

    // Without the spread of the means, or about another mean, or with weights that do not sum to one, it is not so.
    let mut within = Matrix2::zeros();
    for (weight, component) in weights.iter().zip(&components) {
        within += &component.covariance * weight.clone();
    }
    assert_ne!(covariance, within);
    let about_first = mixture_covariance(&weights, &components, &components[0].mean);
    assert_ne!(about_first, covariance);
    let loose = [unknown("u1"), unknown("u2"), unknown("u3")];
    let loose_mean = mixture_mean(&loose, &components);
    let loose_covariance = mixture_covariance(&loose, &components, &loose_mean);
    let mut loose_second_moment = Matrix2::zeros();
    for (weight, component) in loose.iter().zip(&components) {
        let raw = &component.covariance + &component.mean * component.mean.transpose();
        loose_second_moment += raw * weight.clone();
    }
    assert_ne!(
        loose_covariance + &loose_mean * loose_mean.transpose(),
        loose_second_moment
    );
}

#[test]
fn the_spread_of_a_mixture_is_that_of_its_pairs() {
    // Σᵢ wᵢ (mᵢ − m)(mᵢ − m)ᵀ = Σ₍i<l₎ wᵢ wₗ (mᵢ − mₗ)(mᵢ − mₗ)ᵀ: positive semidefinite, and zero where all means agree.
    let mut components = gaussians::<2>(3);
    for component in &mut components {
        component.covariance = Matrix2::zeros();
    }
    let weights = weights_that_sum_to_one(3);
    let mean = mixture_mean(&weights, &components);
    let mut of_pairs = Matrix2::zeros();
    for i in 0..3 {
        for l in i + 1..3 {
            let difference = &components[i].mean - &components[l].mean;
            let weight = weights[i].clone() * weights[l].clone();
            of_pairs += (&difference * difference.transpose()) * weight;
        }
    }
    assert_eq!(mixture_covariance(&weights, &components, &mean), of_pairs);
}

// Motion

#[test]
fn motion_composes_over_time() {
    let (s, t) = (unknown("s"), unknown("t"));
    let together = s.clone() + t.clone();
    let straight = constant_velocity(&s) * constant_velocity(&t);
    assert_eq!(straight, constant_velocity(&together));
    assert_ne!(straight, constant_velocity(&s));

    // Two turns of the same rate by two angles: sine and cosine of the sum.
    let rate = unknown("omega");
    let (first, second) = (Angle::of("u"), Angle::of("v"));
    let sum = first.plus(&second);
    assert_eq!(first.turn(&rate) * second.turn(&rate), sum.turn(&rate));
    assert_ne!(first.turn(&rate) * second.turn(&rate), first.turn(&rate));
    // Back by the same angle, and by the angle zero, it is the identity. Back and forth is the same with the other rate.
    let back = first.opposite();
    assert_eq!(first.turn(&rate) * back.turn(&rate), Matrix4::identity());
    assert_eq!(Angle::zero().turn(&rate), Matrix4::identity());
    // The speed does not change, and the square of the velocity is a sum of squares.
    let state = unknowns::<4>("x");
    let turned = first.turn(&rate) * &state;
    assert_eq!(
        square(&turned[1]) + square(&turned[3]),
        square(&state[1]) + square(&state[3])
    );
}

#[test]
fn transition_matrices_are_the_exponentials_of_their_generators() {
    // F' = A F and F(0) = I have one solution, e^{AT}.
    let t = unknown("t");
    let straight = derivative(|h| constant_velocity(&(t.clone() + h.clone())));
    assert_eq!(straight, straight_generator() * constant_velocity(&t));
    assert_eq!(constant_velocity(&Unknown::zero()), Matrix4::identity());

    let rate = unknown("omega");
    let angle = Angle::of("u");
    let turn = derivative(|h| angle.later(&rate, h).turn(&rate));
    assert_eq!(turn, turn_generator(&rate) * angle.turn(&rate));
    assert_ne!(turn, turn_generator(&-rate.clone()) * angle.turn(&rate));
}

#[test]
fn constant_velocity_noise_is_its_integral() {
    // Q' = F L q Lᵀ Fᵀ and Q(0) = 0.
    let (q, t) = (unknown("q"), unknown("t"));
    let growth = derivative(|h| integrated_noise(&q, &(t.clone() + h.clone())));
    let driven = constant_velocity(&t) * on_velocities();
    let expected = (&driven * driven.transpose()) * q.clone();
    assert_eq!(growth, expected);
    assert_eq!(integrated_noise(&q, &Unknown::zero()), Matrix4::zeros());
    // And over two intervals: what has been gathered is carried along, and more is gathered.
    let s = unknown("s");
    let carried = constant_velocity(&t) * integrated_noise(&q, &s) * constant_velocity(&t).transpose();
    assert_eq!(
        carried + integrated_noise(&q, &t),
        integrated_noise(&q, &(s + t.clone()))
    );
    // The noise of a piecewise constant acceleration is another one, of the same units but for one.
    let piecewise = derivative(|h| acceleration_noise(&q, &(t.clone() + h.clone())));
    assert_ne!(piecewise, expected);
}

#[test]
fn turn_noise_is_its_integral() {
    let (q, rate, t) = (unknown("q"), unknown("omega"), unknown("t"));
    let angle = Angle::of("u");
    let noise = |interval: &Unknown, angle: &Angle| angle.noise(&q, &rate, interval);
    let growth = derivative(|h| noise(&(t.clone() + h.clone()), &angle.later(&rate, h)));
    let driven = angle.turn(&rate) * on_velocities();
    let expected = (&driven * driven.transpose()) * q.clone();
    assert_eq!(growth, expected);
    // At T = 0, where c₂ = 1/2 and c₃ = 1/6.
    let (zero, half, sixth) = (Unknown::zero(), Unknown::ratio(1, 2), Unknown::ratio(1, 6));
    assert_eq!(turn_noise_matrix(&q, &zero, &zero, &half, &sixth), Matrix4::zeros());
    // Over two intervals.
    let (s, second) = (unknown("s"), Angle::of("v"));
    let carried = angle.turn(&rate) * noise(&s, &second) * angle.turn(&rate).transpose();
    assert_eq!(
        carried + noise(&t, &angle),
        noise(&(s + t.clone()), &second.plus(&angle))
    );
    // The noise of constant velocity, which liu2017 (30) uses, is not this integral.
    let straight = derivative(|h| integrated_noise(&q, &(t.clone() + h.clone())));
    assert_ne!(straight, expected);
}

#[test]
fn turn_and_noise_tend_to_those_of_constant_velocity() {
    // Taylor's theorem: sin ωT = ωT − ω³T³/6 + ω⁵ u and cos ωT = 1 − ω²T²/2 + ω⁴ v with u and v bounded as ω → 0.
    let (q, rate, t) = (unknown("q"), unknown("omega"), unknown("t"));
    let power = |k: usize| num_traits::pow(rate.clone() * t.clone(), k);
    let rest = |name: &str, k: usize| unknown(name) * num_traits::pow(rate.clone(), k);
    let angle = Angle {
        sine: power(1) - power(3) / number(6) + rest("u", 5),
        cosine: Unknown::one() - power(2) / number(2) + rest("v", 4),
    };
    let noise = angle.noise(&q, &rate, &t);
    let at_rate_zero = |entry: &Unknown| at_zero("omega", entry);
    let turn = angle.turn(&rate);
    assert_eq!(turn.map(|entry| at_rate_zero(&entry)), constant_velocity(&t));
    let straight = integrated_noise(&q, &t);
    assert_eq!(noise.map(|entry| at_rate_zero(&entry)), straight);
    // To first order in ω they differ in the terms that couple the axes, by ωT/3 of the entry T²/2.
    let first_order = (noise - &straight).map(|entry| at_rate_zero(&(entry / rate.clone())));
    let coupling = straight[(0, 1)].clone() * t / number(3);
    let mut expected = Matrix4::zeros();
    expected[(0, 3)] = coupling.clone();
    expected[(3, 0)] = coupling.clone();
    expected[(1, 2)] = -coupling.clone();
    expected[(2, 1)] = -coupling;
    assert_eq!(first_order, expected);
}

#[test]
fn a_piecewise_constant_acceleration_enters_through_its_integral() {
    // G' = F L and G(0) = 0: an acceleration a, constant over T, moves the state by G a.
    let t = unknown("t");
    let growth = derivative(|h| acceleration_input(&(t.clone() + h.clone())));
    assert_eq!(growth, constant_velocity(&t) * on_velocities());
    assert_eq!(acceleration_input(&Unknown::zero()), Matrix4x2::zeros());
    // Q = G q Gᵀ has rank two: in each axis its determinant is zero.
    let noise = acceleration_noise(&unknown("q"), &t);
    let product = |i: usize, j: usize| noise[(i, j)].clone();
    assert_eq!(product(0, 0) * product(1, 1), product(0, 1) * product(1, 0));
    assert_eq!(product(2, 2) * product(3, 3), product(2, 3) * product(3, 2));
    assert!(!product(0, 0).is_zero() && !product(3, 3).is_zero());
}

#[test]
fn the_motion_of_the_plane_is_that_of_each_coordinate() {
    // Any matrix of one coordinate [p, ṗ, p̈], on the state [x, y, ẋ, ẏ, ẍ, ÿ].
    let axis: Matrix3<Unknown> = Matrix3::from_fn(|row, column| unknown(&format!("a{row}{column}")));
    let state = unknowns::<6>("x");
    let moved = in_the_plane(&axis) * &state;
    for coordinate in 0..2 {
        let of = |state: &SVector<Unknown, 6>| SVector::<Unknown, 3>::from_fn(|i, _| state[2 * i + coordinate].clone());
        assert_eq!(of(&moved), &axis * of(&state));
        // And of nothing but itself: the other coordinate's matrix could be any.
        assert_ne!(of(&moved), axis.transpose() * of(&state));
    }
}

#[test]
fn the_motions_of_the_plane_compose_over_time() {
    let (s, t) = (unknown("s"), unknown("t"));
    let together = s.clone() + t.clone();
    for motion in [constant_velocity_in_the_plane, constant_acceleration_in_the_plane] {
        assert_eq!(motion(&s) * motion(&t), motion(&together));
        assert_ne!(motion(&s) * motion(&t), motion(&s));
    }
    // Without an acceleration they are the same, and what there is of one after constant velocity is none.
    let mut still = unknowns::<6>("x");
    still[4] = Unknown::zero();
    still[5] = Unknown::zero();
    let straight = constant_velocity_in_the_plane(&t) * &still;
    assert_eq!(straight, constant_acceleration_in_the_plane(&t) * &still);
    let forgetful = constant_velocity_in_the_plane(&t) * unknowns::<6>("x");
    assert_eq!(forgetful.fixed_rows::<2>(4), still.fixed_rows::<2>(4));
}

#[test]
fn noise_in_the_plane_is_its_integral() {
    let (q, s, t) = (unknown("q"), unknown("s"), unknown("t"));
    let together = s.clone() + t.clone();
    let models = [
        (
            constant_velocity_in_the_plane as fn(&Unknown) -> _,
            velocity_noise_in_the_plane as fn(&Unknown, &Unknown) -> _,
            1,
        ),
        (constant_acceleration_in_the_plane, acceleration_noise_in_the_plane, 2),
    ];
    for (motion, noise, driven) in models {
        // Over two intervals: what has been gathered is carried along, and more is gathered. With Q(0) = 0 and Q'(0) = g q gᵀ this is
        // the integral.
        let carried = motion(&t) * noise(&q, &s) * motion(&t).transpose();
        assert_eq!(carried + noise(&q, &t), noise(&q, &together));
        assert_eq!(noise(&q, &Unknown::zero()), nalgebra::Matrix6::zeros());
        let growth = derivative(|h| noise(&q, h));
        let mut axis = Matrix3::zeros();
        axis[(driven, driven)] = q.clone();
        assert_eq!(growth, in_the_plane(&axis));
        // Noise of another density over one of the intervals is no integral.
        let carried = motion(&t) * noise(&number(2), &s) * motion(&t).transpose();
        assert_ne!(carried + noise(&q, &t), noise(&q, &together));
    }
    // The noise of the one motion does not go with the other.
    let carried = constant_acceleration_in_the_plane(&t)
        * velocity_noise_in_the_plane(&q, &s)
        * constant_acceleration_in_the_plane(&t).transpose();
    assert_eq!(
        carried + velocity_noise_in_the_plane(&q, &t),
        velocity_noise_in_the_plane(&q, &together),
        "without an acceleration the two motions are the same"
    );
    let carried = constant_velocity_in_the_plane(&t)
        * acceleration_noise_in_the_plane(&q, &s)
        * constant_velocity_in_the_plane(&t).transpose();
    assert_ne!(
        carried + acceleration_noise_in_the_plane(&q, &t),
        acceleration_noise_in_the_plane(&q, &together)
    );
}

#[test]
fn velocity_noise_in_the_plane_is_that_of_the_other_papers() {
    let (q, t) = (unknown("q"), unknown("t"));
    // Where [x, ẋ, y, ẏ] stand in [x, y, ẋ, ẏ, ẍ, ÿ].
    let places = [0, 2, 1, 3];
    let four = |matrix: nalgebra::Matrix6<Unknown>| {
        Matrix4::from_fn(|row, column| matrix[(places[row], places[column])].clone())
    };
    assert_eq!(four(velocity_noise_in_the_plane(&q, &t)), integrated_noise(&q, &t));
    assert_eq!(four(constant_velocity_in_the_plane(&t)), constant_velocity(&t));
    assert_ne!(four(acceleration_noise_in_the_plane(&q, &t)), integrated_noise(&q, &t));
    // There is nothing else in it.
    let all = velocity_noise_in_the_plane(&q, &t);
    assert_eq!(all.fixed_rows::<2>(4), SMatrix::<Unknown, 2, 6>::zeros());
    assert_eq!(all.fixed_columns::<2>(4), SMatrix::<Unknown, 6, 2>::zeros());
}

// Kalman

#[test]
fn the_kalman_update_is_conditioning_of_a_gaussian() {
    // State and measurement are jointly Gaussian with covariance J = [P C; Cᵀ S]. With I W; 0 I around the blocks P⁺ and S,
    // the density of the two is that of the measurement times N(x̂ + W ν, P⁺): the conditional one. This for any C.
    check_factored_joint_covariance::<2, 1>();
    check_factored_joint_covariance::<2, 2>();
    // The information form: P⁺⁻¹ = P⁻¹ + Hᵀ R⁻¹ H and P⁺⁻¹ x̂⁺ = P⁻¹ x̂ + Hᵀ R⁻¹ z.
    let row = matrix![unknown("h0"), unknown("h1")];
    check_information_form(
        &symmetric::<2>("p"),
        &symmetric("r"),
        &row,
        &unknowns("x"),
        &unknowns("z"),
    );
    // Two measured components: the whole state, in the coordinates in which H is the identity and R diagonal ...
    let whole_state = Matrix2::identity();
    let (p, r) = (symmetric::<2>("p"), Matrix2::from_diagonal(&unknowns("r")));
    check_information_form(&p, &r, &whole_state, &unknowns("x"), &unknowns("z"));
    // ... and any two components of four, in fractions without a pattern.
    let mut draw = Fractions::new();
    for _ in 0..5 {
        let (p, r) = (draw.matrix::<4, 4>(), draw.matrix::<2, 2>());
        check_information_form(
            &(&p * p.transpose()),
            &(&r * r.transpose()),
            &draw.matrix::<2, 4>(),
            &draw.matrix::<4, 1>(),
            &draw.matrix::<2, 1>(),
        );
    }
}

#[test]
fn the_predicted_covariance_is_that_of_a_linear_function_with_independent_noise() {
    // Entry by entry: Cov(Σₖ Fᵢₖ xₖ + wᵢ, Σₗ Fⱼₗ xₗ + wⱼ).
    let f = SMatrix::<Unknown, 2, 2>::from_fn(|i, j| unknown(&format!("f{i}{j}")));
    let (p, q) = (symmetric::<2>("p"), symmetric::<2>("q"));
    let predicted = predicted_covariance(&f, &p, &q);
    for i in 0..2 {
        for j in 0..2 {
            let mut sum = q[(i, j)].clone();
            for k in 0..2 {
                for l in 0..2 {
                    sum += f[(i, k)].clone() * p[(k, l)].clone() * f[(j, l)].clone();
                }
            }
            assert_eq!(predicted[(i, j)], sum);
        }
    }
    assert_ne!(predicted, predicted_covariance(&f.transpose(), &p, &q));
}

// Points and weights on linear models

#[test]
fn raw_and_centred_second_moments_agree() {
    let weights = weights_that_sum_to_one(3);
    let points = points_of_unknowns::<2>("x", 3);
    let values = points_of_unknowns::<1>("z", 3);
    let (mean, value_mean) = (weighted_mean(&weights, &points), weighted_mean(&weights, &values));
    let q = symmetric::<2>("q");
    let centred = weighted_covariance(&weights, &points, &mean, &q);
    assert_eq!(raw_covariance(&weights, &points, &mean, &q), centred);

    // The cross-covariance is a block of the covariance of state and measurement together.
    let joint: Vec<SVector<Unknown, 3>> = points.iter().zip(&values).map(stacked).collect();
    let joint_mean = stacked((&mean, &value_mean));
    let together = weighted_covariance(&weights, &joint, &joint_mean, &Matrix3::zeros());
    let cross = raw_cross_covariance(&weights, &points, &mean, &values, &value_mean);
    assert_eq!(cross, together.fixed_view::<2, 1>(0, 2).into_owned());

    // zhu2016 (24) as printed, and weights that do not sum to one.
    assert_ne!(raw_second_moment(&weights, &points), centred);
    let loose = [unknown("u1"), unknown("u2"), unknown("u3")];
    let loose_mean = weighted_mean(&loose, &points);
    assert_ne!(
        raw_covariance(&loose, &points, &loose_mean, &q),
        weighted_covariance(&loose, &points, &loose_mean, &q)
    );
}

#[test]
fn the_raw_form_needs_covariance_weights_that_sum_to_one() {
    // The covariance weights of the unscented rule sum to 2 − α² + β. A linear filter in centred form does not notice, since its
    // centre does not deviate; the raw form is off by (1 − α² + β) x̂ x̂ᵀ. For α = 1 and β = 0 both are Kalman's.
    let problem = LinearProblem::<Unknown, 2, 1>::of_unknowns();
    let q = Rational::new;
    for (alpha, beta) in [(q(1, 1), q(0, 1)), (q(1, 2), q(0, 1)), (q(1, 1), q(2, 1))] {
        let excess = q(1, 1) - alpha.pow(2) + beta.clone();
        let kappa = q(1, 1);
        let parameters = Parameters { alpha, beta, kappa };
        let exact = unscented::unscented(2, &parameters).unwrap();
        let rule = Rule::<Unknown, U2>::from_exact(&exact).unwrap();
        let points = drawn_points(&problem.square_root, &rule.points, &problem.mean);
        let mean = weighted_mean(&rule.weights, &points);
        let weights = &rule.covariance_weights;
        let centred = weighted_covariance(weights, &points, &mean, &problem.noise);
        let raw = raw_covariance(weights, &points, &mean, &problem.noise);
        let squared_mean = &mean * mean.transpose();
        assert_eq!(raw - centred, squared_mean * Unknown::rational(&excess));
    }
}

#[test]
fn a_linear_filter_with_any_rule_of_degree_two_is_the_kalman_filter() {
    // Two dimensions, everything unknown: S lower triangular with P = S Sᵀ, F, Q, x̂, H, R.
    let problem = LinearProblem::<Unknown, 2, 1>::of_unknowns();
    for rule in rules_of_degree_two(2) {
        assert!(problem.is_kalman(&Rule::from_exact(&rule).unwrap()));
    }
    for rule in rules_as_printed(2) {
        assert!(!problem.is_kalman(&Rule::from_exact(&rule).unwrap()));
    }
    // Four dimensions in surds, with fractions without a pattern for all that is unknown.
    let mut draw = Fractions::new();
    for _ in 0..3 {
        let problem = LinearProblem::<Surd, 4, 2>::of_fractions(&mut draw);
        for rule in rules_of_degree_two(4) {
            assert!(problem.is_kalman(&Rule::from_exact(&rule).unwrap()));
        }
        for rule in rules_as_printed(4) {
            assert!(!problem.is_kalman(&Rule::from_exact(&rule).unwrap()));
        }
    }
}

#[test]
fn a_linear_filter_sees_the_first_two_moments_of_its_rule_and_nothing_else() {
    // Any three points and weights: the prediction is a function of Σw, Σwξ and Σwξξᵀ. So with 1, 0 and I it is Kalman's.
    let weights = [unknown("w1"), unknown("w2"), unknown("w3")];
    let points = points_of_unknowns::<2>("xi", 3);
    let problem = LinearProblem::<Unknown, 2, 1>::of_unknowns();
    let (f, s, x) = (&problem.transition, &problem.square_root, &problem.mean);
    let drawn = drawn_points(s, &points, x);
    let carried: Vec<_> = drawn.iter().map(|p| propagated_point(f, p)).collect();

    let total = weights.iter().fold(Unknown::zero(), |sum, weight| sum + weight);
    let first = weighted_mean(&weights, &points);
    let second = raw_second_moment(&weights, &points);
    assert_eq!(weighted_mean(&weights, &carried), f * (s * &first + x * total.clone()));
    let moment = s * second * s.transpose()
        + s * &first * x.transpose()
        + x * first.transpose() * s.transpose()
        + (x * x.transpose()) * total;
    assert_eq!(raw_second_moment(&weights, &carried), f * moment * f.transpose());
}

// Mode probabilities

#[test]
fn mixing_probabilities_sum_to_one_over_the_previous_modes() {
    let chain = unknown_chain(3);
    let before = [unknown("mu1"), unknown("mu2"), unknown("mu3")];
    let mixing = mixing_of(&chain, &before);
    for row in &mixing {
        assert_eq!(sum_of(row), Unknown::one());
    }
    // With the current mode and the previous one confused they do not.
    for i in 0..3 {
        let over_current: Vec<Unknown> = mixing.iter().map(|row| row[i].clone()).collect();
        assert_ne!(sum_of(&over_current), Unknown::one());
    }
}

#[test]
fn predicted_mode_probabilities_sum_to_one_when_the_rows_of_the_chain_do() {
    let row = |i: usize| {
        let (a, b) = (unknown(&format!("a{i}")), unknown(&format!("b{i}")));
        vec![a.clone(), b.clone(), Unknown::one() - a - b]
    };
    let before = weights_that_sum_to_one(3);
    let total = |chain: &[Vec<Unknown>]| sum_of(&[0, 1, 2].map(|j| predicted_mode_probability(chain, &before, j)));
    let chain = [row(1), row(2), row(3)];
    assert_eq!(total(&chain), Unknown::one());
    assert_ne!(total(&unknown_chain(3)), Unknown::one());
    // Columns that sum to one are not enough.
    let transposed: Vec<Vec<Unknown>> = (0..3).map(|i| (0..3).map(|j| chain[j][i].clone()).collect()).collect();
    assert_ne!(total(&transposed), Unknown::one());
}

#[test]
fn diagonal_weights_sum_to_one_in_each_component() {
    let estimates = gaussians::<2>(3);
    let mut sum = Vector2::zeros();
    for i in 0..3 {
        sum += diagonal_mixing::diagonal_weight(&estimates, i);
    }
    assert_eq!(sum, Vector2::from_element(Unknown::one()));
    // Equal variances weigh equally, and the weight falls with the variance: 1/p₁ : 1/p₂ = p₂ : p₁.
    let (first, second) = (
        diagonal_mixing::diagonal_weight(&estimates, 0),
        diagonal_mixing::diagonal_weight(&estimates, 1),
    );
    for l in 0..2 {
        assert_eq!(
            first[l].clone() * estimates[0].covariance[(l, l)].clone(),
            second[l].clone() * estimates[1].covariance[(l, l)].clone()
        );
    }
    // The mean of equal estimates is theirs.
    let same = vec![estimates[0].clone(); 3];
    assert_eq!(diagonal_mixing::mixed_mean(&same), estimates[0].mean);
}

// Mixing

#[test]
fn one_mode_keeps_its_estimate() {
    let estimates = gaussians::<2>(1);
    let mixed = mixed_estimates(&unknown_chain(1), &[unknown("mu1")], &estimates);
    assert_eq!(mixed, estimates);
}

#[test]
fn identical_estimates_stay_what_they_are_whatever_the_chain() {
    let estimate = gaussians::<2>(1).remove(0);
    let same = vec![estimate.clone(); 3];
    let before = [unknown("mu1"), unknown("mu2"), unknown("mu3")];
    let mixed = mixed_estimates(&unknown_chain(3), &before, &same);
    assert_eq!(mixed, same);
    // If one of them differs, all mixed ones do.
    let mut one_differs = same.clone();
    one_differs[1].mean[0] += Unknown::one();
    for estimate in mixed_estimates(&unknown_chain(3), &before, &one_differs) {
        assert_ne!(estimate, same[0]);
    }
}

#[test]
fn equal_rows_of_the_chain_give_equal_mixed_estimates() {
    // The chain forgets where it was: every mode starts from the combined estimate.
    let rows = vec![vec![unknown("p1"), unknown("p2")]; 2];
    let before = weights_that_sum_to_one(2);
    let estimates = gaussians::<1>(2);
    let mixed = mixed_estimates(&rows, &before, &estimates);
    let mean = mixture_mean(&before, &estimates);
    let combined = Gaussian {
        covariance: mixture_covariance(&before, &estimates, &mean),
        mean,
    };
    assert_eq!(mixed, [combined.clone(), combined]);
    let different = mixed_estimates(&unknown_chain(2), &before, &estimates);
    assert_ne!(different[0], different[1]);
}

#[test]
fn a_chain_that_never_switches_never_mixes() {
    let (o, l) = (Unknown::zero, Unknown::one);
    let identity = [vec![l(), o(), o()], vec![o(), l(), o()], vec![o(), o(), l()]];
    let before = [unknown("mu1"), unknown("mu2"), unknown("mu3")];
    for (j, probability) in before.iter().enumerate() {
        assert_eq!(predicted_mode_probability(&identity, &before, j), *probability);
    }
    let estimates = gaussians::<2>(3);
    assert_eq!(mixed_estimates(&identity, &before, &estimates), estimates);
    assert_ne!(mixed_estimates(&unknown_chain(3), &before, &estimates), estimates);
}

#[test]
fn a_mode_that_no_mode_leads_to_keeps_its_estimate() {
    // The column of the second mode is zero, and so is its predicted probability: μᵢ∣ⱼ = 0/0 is replaced by a choice.
    let chain = vec![
        vec![unknown("p00"), Unknown::zero()],
        vec![unknown("p10"), Unknown::zero()],
    ];
    let before = [unknown("mu1"), unknown("mu2")];
    assert!(predicted_mode_probability(&chain, &before, 1).is_zero());
    let estimates = gaussians::<2>(2);
    let mixed = mixed_estimates(&chain, &before, &estimates);
    assert_eq!(mixed[1], estimates[1]);
    assert_ne!(mixed[0], estimates[0]);
}

// Helpers: numbers

/// The unknown of that name.
fn unknown(name: &str) -> Unknown {
    Unknown::unknown(name)
}

/// An integer.
fn number(value: i64) -> Unknown {
    Unknown::integer(value)
}

/// The square.
fn square(value: &Unknown) -> Unknown {
    value.clone() * value.clone()
}

/// The sum.
fn sum_of(values: &[Unknown]) -> Unknown {
    values.iter().fold(Unknown::zero(), |sum, value| sum + value)
}

/// Σⱼ cⱼ xʲ.
fn polynomial(coefficients: &[Unknown], x: &Unknown) -> Unknown {
    let mut sum = Unknown::zero();
    for coefficient in coefficients.iter().rev() {
        sum = sum * x.clone() + coefficient.clone();
    }
    sum
}

/// The derivative along h of a matrix of functions of h at h = 0: the difference quotient, which has no h in its denominator.
fn derivative<const R: usize, const C: usize>(
    function: impl Fn(&Unknown) -> SMatrix<Unknown, R, C>,
) -> SMatrix<Unknown, R, C> {
    let h = unknown("h");
    let difference = function(&h) - function(&Unknown::zero());
    difference.map(|entry| at_zero("h", &(entry / h.clone())))
}

/// The value where one unknown is zero, the other unknowns of this file's motion staying what they are.
fn at_zero(name: &str, function: &Unknown) -> Unknown {
    let others = ["h", "omega", "q", "s", "t", "u", "v"].into_iter();
    let mut values: Vec<_> = others
        .filter(|other| *other != name)
        .map(|other| (other, unknown(other)))
        .collect();
    values.push((name, Unknown::zero()));
    let value = function.substitute(&values);
    assert!(value.is_decided());
    value
}

// Helpers: rules

/// W r^(2k): the radial moment of degree 2k of a rule.
fn radial_sum(rule: &SphericalRule<Unknown>, k: usize) -> Unknown {
    rule.sphere.clone() * num_traits::pow(rule.radius_squared.clone(), k)
}

/// Each condition of the degrees up to five holds, and both of degree six fail.
fn check_degree_five_and_not_six(rule: &SphericalRule<Unknown>) {
    let n = every_dimension();
    assert_eq!(rule.degree(), Some(5));
    assert_eq!(rule.centre.clone() + rule.sphere.clone(), Unknown::one());
    for k in 1..=2 {
        assert_eq!(radial_sum(rule, k), radial_moment(&n, k));
        assert!(harmonic_sum(&n, k, &rule.products).is_zero());
    }
    assert_ne!(radial_sum(rule, 3), radial_moment(&n, 3));
    assert!(!harmonic_sum(&n, 3, &rule.products).is_zero());
}

/// The coefficients of 1, t², t⁴ and t⁶ in the Gegenbauer polynomial P₂ₖ(t), k ≤ 3.
fn gegenbauer_coefficients(n: &Unknown, k: usize) -> Vec<Unknown> {
    let plus = |value: i64| n.clone() + number(value);
    match k {
        0 => vec![number(1)],
        1 => vec![number(-1) / plus(-1), n.clone() / plus(-1)],
        2 => {
            let below = plus(-1) * plus(1);
            let above = [number(3), number(-6) * plus(2), plus(2) * plus(4)];
            above.map(|value| value / below.clone()).to_vec()
        }
        _ => {
            let below = plus(-1) * plus(1) * plus(3);
            let above = [
                number(-15),
                number(45) * plus(4),
                number(-15) * plus(4) * plus(6),
                plus(4) * plus(6) * plus(8),
            ];
            above.map(|value| value / below.clone()).to_vec()
        }
    }
}

/// The mean of t^(2j) over the sphere, t one coordinate: 1·3 ⋯ (2j − 1) / (n(n + 2) ⋯ (n + 2j − 2)).
fn mean_of_power_on_sphere(n: &Unknown, j: usize) -> Unknown {
    let above: usize = (1..2 * j).step_by(2).product();
    number(i64::try_from(above).unwrap()) / radial_moment(n, j)
}

/// Rules whose first two moments are right.
fn rules_of_degree_two(n: usize) -> Vec<ExactRule> {
    let q = Rational::new;
    let unscented = |parameters| unscented::unscented(n, &parameters).unwrap();
    let mut rules = vec![
        third_degree::third_degree(n).unwrap(),
        fifth_degree::fifth_degree(n).unwrap(),
        simplex(n).unwrap(),
        unscented(Parameters::for_gaussian(n)),
    ];
    for kappa in [q(0, 1), q(-1, 1), q(5, 7)] {
        rules.push(unscented(Parameters::of_kappa(kappa)));
    }
    rules.push(unscented(Parameters {
        alpha: q(1, 10),
        beta: q(2, 1),
        kappa: q(1, 2),
    }));
    rules
}

/// Rules with the weights that the papers print.
fn rules_as_printed(n: usize) -> Vec<ExactRule> {
    vec![
        printed::fifth_degree(n).unwrap(),
        printed::simplex_11(n).unwrap(),
        printed::simplex_16(n).unwrap(),
    ]
}

// Helpers: matrices and estimates

/// A symmetric matrix of unknowns.
fn symmetric<const N: usize>(name: &str) -> SMatrix<Unknown, N, N> {
    SMatrix::from_fn(|i, j| unknown(&format!("{name}{}{}", i.min(j), i.max(j))))
}

/// A vector of unknowns.
fn unknowns<const N: usize>(name: &str) -> SVector<Unknown, N> {
    SVector::from_fn(|i, _| unknown(&format!("{name}{i}")))
}

/// Points with unknown coordinates.
fn points_of_unknowns<const N: usize>(name: &str, number: usize) -> Vec<SVector<Unknown, N>> {
    (0..number).map(|s| unknowns(&format!("{name}{s}"))).collect()
}

/// Unknown weights, the last of which makes their sum one.
fn weights_that_sum_to_one(number: usize) -> Vec<Unknown> {
    let mut weights: Vec<Unknown> = (1..number).map(|i| unknown(&format!("w{i}"))).collect();
    weights.push(Unknown::one() - sum_of(&weights));
    weights
}

/// Unknown estimates.
fn gaussians<const N: usize>(number: usize) -> Vec<Gaussian<Unknown, Const<N>>> {
    (0..number)
        .map(|i| Gaussian {
            mean: unknowns(&format!("m{i}")),
            covariance: symmetric(&format!("p{i}")),
        })
        .collect()
}

/// State over measurement.
fn stacked((state, value): (&SVector<Unknown, 2>, &SVector<Unknown, 1>)) -> SVector<Unknown, 3> {
    vector![state[0].clone(), state[1].clone(), value[0].clone()]
}

/// L D Lᵀ is the matrix.
fn check_ldl_product<const N: usize>(matrix: &SMatrix<Unknown, N, N>) {
    let factors = ldl(matrix);
    let diagonal = SMatrix::from_diagonal(&factors.diagonal);
    assert_eq!(&factors.lower * &diagonal * factors.lower.transpose(), *matrix);
    assert_ne!(&factors.lower * &diagonal * &factors.lower, *matrix);
}

/// The inverse of a symmetric matrix by Cramer's rule.
fn adjugate_inverse(matrix: &Matrix3<Unknown>) -> Matrix3<Unknown> {
    let m = |i: usize, j: usize| matrix[(i % 3, j % 3)].clone();
    let cofactor = |i: usize, j: usize| m(i + 1, j + 1) * m(i + 2, j + 2) - m(i + 1, j + 2) * m(i + 2, j + 1);
    let mut determinant = Unknown::zero();
    for j in 0..3 {
        determinant += m(0, j) * cofactor(0, j);
    }
    Matrix3::from_fn(|i, j| cofactor(j, i) / determinant.clone())
}

// Helpers: motion

/// An angle by its sine and cosine.
struct Angle {
    sine: Unknown,
    cosine: Unknown,
}

impl Angle {
    /// Any angle but π: 2 arctan u, with sine 2u/(1 + u²) and cosine (1 − u²)/(1 + u²).
    fn of(name: &str) -> Self {
        let u = unknown(name);
        let below = Unknown::one() + square(&u);
        Self {
            sine: number(2) * u.clone() / below.clone(),
            cosine: (Unknown::one() - square(&u)) / below,
        }
    }

    fn zero() -> Self {
        Self {
            sine: Unknown::zero(),
            cosine: Unknown::one(),
        }
    }

    fn opposite(&self) -> Self {
        Self {
            sine: -self.sine.clone(),
            cosine: self.cosine.clone(),
        }
    }

    fn plus(&self, other: &Self) -> Self {
        Self {
            sine: &self.sine * &other.cosine + &self.cosine * &other.sine,
            cosine: &self.cosine * &other.cosine - &self.sine * &other.sine,
        }
    }

    /// The angle a time h later, to first order in h: (sin)' = ω cos, (cos)' = −ω sin.
    fn later(&self, rate: &Unknown, h: &Unknown) -> Self {
        Self {
            sine: self.sine.clone() + rate * h * &self.cosine,
            cosine: self.cosine.clone() - rate * h * &self.sine,
        }
    }

    fn turn(&self, rate: &Unknown) -> Matrix4<Unknown> {
        let along = self.sine.clone() / rate.clone();
        let across = (Unknown::one() - self.cosine.clone()) / rate.clone();
        turn_matrix(&along, &across, &self.sine, &self.cosine)
    }

    /// The noise of the turn, with c₂(θ²) = (1 − cos θ)/θ² and c₃(θ²) = (θ − sin θ)/θ³.
    fn noise(&self, density: &Unknown, rate: &Unknown, interval: &Unknown) -> Matrix4<Unknown> {
        let angle = rate * interval;
        let square = &angle * &angle;
        let c_2 = (Unknown::one() - &self.cosine) / square.clone();
        let c_3 = (&angle - &self.sine) / (square * &angle);
        turn_noise_matrix(density, interval, &angle, &c_2, &c_3)
    }
}

/// A of constant velocity: the derivative of a position is its velocity.
fn straight_generator() -> Matrix4<Unknown> {
    turn_generator(&Unknown::zero())
}

/// A of a turn: the velocity is turned to its left.
fn turn_generator(rate: &Unknown) -> Matrix4<Unknown> {
    let mut a = Matrix4::zeros();
    a[(0, 1)] = Unknown::one();
    a[(2, 3)] = Unknown::one();
    a[(1, 3)] = -rate.clone();
    a[(3, 1)] = rate.clone();
    a
}

/// L: the noise enters the two velocities.
fn on_velocities() -> Matrix4x2<Unknown> {
    let mut l = Matrix4x2::zeros();
    l[(1, 0)] = Unknown::one();
    l[(3, 1)] = Unknown::one();
    l
}

// Helpers: Kalman

/// [P C; Cᵀ S] = [I W; 0 I] · diag(P⁺, S) · [I 0; Wᵀ I], so that x − x̂ − W ν is independent of ν and has the covariance P⁺.
///
/// Every C is W S for some W, as long as S has an inverse: so W, S and P are the unknowns here, and the gain must find W again.
fn check_factored_joint_covariance<const N: usize, const M: usize>() {
    let (p, s) = (symmetric::<N>("p"), symmetric::<M>("s"));
    let w = SMatrix::<Unknown, N, M>::from_fn(|i, j| unknown(&format!("w{i}{j}")));
    let c = &w * &s;
    assert_eq!(gain(&c, &ldl(&s)), w);
    let updated = updated_covariance(&p, &w, &s);
    assert_eq!(&updated + &w * &s * w.transpose(), p);
    // Cov(x − V ν) = P − V Cᵀ − C Vᵀ + V S Vᵀ of any gain V is that of W, and (V − W) S (V − W)ᵀ more.
    let with_gain = |v: &SMatrix<Unknown, N, M>| &p - v * c.transpose() - &c * v.transpose() + v * &s * v.transpose();
    assert_eq!(with_gain(&w), updated);
    let v = SMatrix::<Unknown, N, M>::from_fn(|i, j| unknown(&format!("v{i}{j}")));
    let more = (&v - &w) * &s * (&v - &w).transpose();
    assert_eq!(with_gain(&v), &updated + more);
    assert_ne!(updated_covariance(&p, &v, &s), updated);
    // The mean moves by W ν.
    let (mean, innovation) = (unknowns::<N>("x"), unknowns::<M>("nu"));
    let moved = updated_mean(&mean, &w, &innovation);
    assert_eq!(moved - mean, &w * innovation);
}

/// The update of a linear measurement is the sum of the informations.
fn check_information_form<T: Field, const N: usize, const M: usize>(
    p: &SMatrix<T, N, N>,
    r: &SMatrix<T, M, M>,
    h: &SMatrix<T, M, N>,
    mean: &SVector<T, N>,
    z: &SVector<T, M>,
) {
    let s = innovation_covariance(h, p, r);
    let w = gain(&cross_covariance(p, h), &ldl(&s));
    let updated = updated_covariance(p, &w, &s);

    let identity = SMatrix::<T, N, N>::identity();
    let of_prior = solve(&ldl(p), &identity);
    let of_measurement = h.transpose() * solve(&ldl(r), h);
    assert_eq!(&updated * (&of_prior + of_measurement), identity);
    assert_ne!(&updated * &of_prior, identity);

    let updated_mean = updated_mean(mean, &w, &(z - h * mean));
    let information = of_prior * mean + h.transpose() * solve(&ldl(r), z);
    assert_eq!(&updated * information, updated_mean);
}

/// A linear problem of one filter.
struct LinearProblem<T, const N: usize, const M: usize> {
    square_root: SMatrix<T, N, N>,
    mean: SVector<T, N>,
    transition: SMatrix<T, N, N>,
    noise: SMatrix<T, N, N>,
    /// The square root of the predicted covariance. That it is this root is the work of `cholesky`, and no matter here: the
    /// second half of the cycle starts from any prediction.
    predicted_square_root: SMatrix<T, N, N>,
    h: SMatrix<T, M, N>,
    measurement_noise: SMatrix<T, M, M>,
}

impl LinearProblem<Unknown, 2, 1> {
    fn of_unknowns() -> Self {
        let lower = |name: &str| {
            let entry = |i, j| unknown(&format!("{name}{i}{j}"));
            SMatrix::from_fn(|i, j| if i < j { Unknown::zero() } else { entry(i, j) })
        };
        Self {
            square_root: lower("s"),
            mean: unknowns("x"),
            transition: SMatrix::from_fn(|i, j| unknown(&format!("f{i}{j}"))),
            noise: symmetric("q"),
            predicted_square_root: lower("l"),
            h: SMatrix::from_fn(|i, j| unknown(&format!("h{i}{j}"))),
            measurement_noise: symmetric("r"),
        }
    }
}

impl<const N: usize, const M: usize> LinearProblem<Surd, N, M> {
    fn of_fractions(draw: &mut Fractions) -> Self {
        let lower = |draw: &mut Fractions| {
            let full = draw.matrix::<N, N>();
            SMatrix::from_fn(|i, j| if i < j { Surd::zero() } else { full[(i, j)].clone() })
        };
        let (process, measurement) = (draw.matrix::<N, N>(), draw.matrix::<M, M>());
        Self {
            square_root: lower(draw),
            mean: draw.matrix::<N, 1>(),
            transition: draw.matrix::<N, N>(),
            noise: &process * process.transpose(),
            predicted_square_root: lower(draw),
            h: draw.matrix::<M, N>(),
            measurement_noise: &measurement * measurement.transpose(),
        }
    }
}

impl<T: Roots, const N: usize, const M: usize> LinearProblem<T, N, M> {
    /// Whether a filter with this rule computes what the Kalman filter computes: all six moments.
    fn is_kalman(&self, rule: &Rule<T, Const<N>>) -> bool {
        let (weights, covariance_weights) = (&rule.weights, &rule.covariance_weights);
        // Prediction.
        let drawn = drawn_points(&self.square_root, &rule.points, &self.mean);
        let carried: Vec<_> = drawn
            .iter()
            .map(|point| propagated_point(&self.transition, point))
            .collect();
        let mean = weighted_mean(weights, &carried);
        let covariance = weighted_covariance(covariance_weights, &carried, &mean, &self.noise);
        let p = &self.square_root * self.square_root.transpose();
        let prediction_agrees = mean == predicted_mean(&self.transition, &self.mean)
            && covariance == predicted_covariance(&self.transition, &p, &self.noise);

        // Update, from points drawn afresh about any mean, here the prior one.
        let p = &self.predicted_square_root * self.predicted_square_root.transpose();
        let fresh = drawn_points(&self.predicted_square_root, &rule.points, &self.mean);
        let values: Vec<_> = fresh.iter().map(|point| &self.h * point).collect();
        let value_mean = weighted_mean(weights, &values);
        let noise = &self.measurement_noise;
        let s = weighted_covariance(covariance_weights, &values, &value_mean, noise);
        let c = raw_cross_covariance(weights, &fresh, &self.mean, &values, &value_mean);
        let update_agrees = value_mean == &self.h * &self.mean
            && s == innovation_covariance(&self.h, &p, noise)
            && c == cross_covariance(&p, &self.h);
        prediction_agrees && update_agrees
    }
}

/// The points of an estimate.
fn drawn_points<T: Field, const N: usize>(
    square_root: &SMatrix<T, N, N>,
    points: &[SVector<T, N>],
    mean: &SVector<T, N>,
) -> Vec<SVector<T, N>> {
    points.iter().map(|xi| point(square_root, xi, mean)).collect()
}

/// Small fractions without a pattern, the same in every run: a linear congruential generator (Knuth's MMIX).
struct Fractions(u64);

impl Fractions {
    fn new() -> Self {
        Self(20_170_613)
    }

    fn next(&mut self) -> Surd {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let drawn = i64::try_from(self.0 >> 40).unwrap();
        Surd::ratio(drawn % 19 - 9, drawn / 19 % 6 + 1)
    }

    fn matrix<const R: usize, const C: usize>(&mut self) -> SMatrix<Surd, R, C> {
        SMatrix::from_fn(|_, _| self.next())
    }
}

// Helpers: mode probabilities

/// A chain of unknown entries. Nothing says that its rows sum to one.
fn unknown_chain(modes: usize) -> Vec<Vec<Unknown>> {
    let row = |i: usize| (0..modes).map(|j| unknown(&format!("p{i}_{j}"))).collect();
    (0..modes).map(row).collect()
}

/// The mixing probabilities as `[current][previous]`.
fn mixing_of(chain: &[Vec<Unknown>], before: &[Unknown]) -> Vec<Vec<Unknown>> {
    let modes = before.len();
    let row = |j: usize| {
        let predicted = predicted_mode_probability(chain, before, j);
        let entry = |i: usize| mixing_probability(chain, before, &predicted, i, j);
        (0..modes).map(entry).collect()
    };
    (0..modes).map(row).collect()
}

/// The mixed estimates of all modes.
fn mixed_estimates<const N: usize>(
    chain: &[Vec<Unknown>],
    before: &[Unknown],
    estimates: &[Gaussian<Unknown, Const<N>>],
) -> Vec<Gaussian<Unknown, Const<N>>> {
    let mix = |weights: &Vec<Unknown>| {
        let mean = mixture_mean(weights, estimates);
        let covariance = mixture_covariance(weights, estimates, &mean);
        Gaussian { mean, covariance }
    };
    mixing_of(chain, before).iter().map(mix).collect()
}
