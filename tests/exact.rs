//! Goal: the rules, the factorisations and the transition matrices are exactly what their doc comments say.
//!
//! Method: both sides are computed in rationals and surds, or in doubles where every step is exact (small integers), and
//! compared with `==`. Kind of evidence: exact; there is no tolerance in this file. What holds for every dimension at
//! once is proven in `symbolic.rs`; here the points themselves are looked at, dimension by dimension.

// Doubles are compared exactly: either every operation on them is exact, or they must be the nearest ones.
#![allow(clippy::float_cmp)]

use immaculate::filter::{cubature, kalman, update};
use immaculate::gaussian::{Gaussian, mixture_covariance, mixture_mean};
use immaculate::matrix::{
    NotPositiveDefinite, check_positive_definite, cholesky, is_positive_semidefinite, ldl, quadratic_form, solve,
};
use immaculate::model::acceleration::{
    acceleration_response, constant_acceleration, embedded_constant_velocity, embedded_velocity_response,
    position_matrix, response_noise,
};
use immaculate::model::motion::{
    Mode, Motion, acceleration_noise, constant_velocity, coordinated_turn, integrated_noise,
};
use immaculate::model::{PolarComponent, Sensor};
use immaculate::number::{Enclosure, Field, Rational, RationalFunction, Surd};
use immaculate::paper::operations::{CoastalRadar, Sums};
use immaculate::paper::sustika2015::reasoning::{
    difficult_jacobian, exact_moments, execution_time, kalman_needs_modification, keeps_both_moments, no_linearisation,
    signs_of_linearity, vanishes,
};
use immaculate::paper::verdict::Verdict;
use immaculate::paper::zhu2016::diagonal_mixing;
use immaculate::rule::fifth_degree::{self, fifth_degree};
use immaculate::rule::gauss_hermite::{Node, gauss_hermite, moment, nodes};
use immaculate::rule::moment::{exactness, gaussian_moment, rule_moment, wrong_moment_of_degree};
use immaculate::rule::simplex::{self, edge_midpoints, simplex, vertices};
use immaculate::rule::sphere::{
    SphericalRule, harmonic_sum, on_axes, on_axes_and_diagonals, on_simplex, radial_moment,
};
use immaculate::rule::third_degree::{self, third_degree};
use immaculate::rule::unscented::{self, Parameters, unscented};
use immaculate::rule::{ExactRule, InvalidRule, Rule, RuleName, printed};
use immaculate::steady::gains::{
    alpha_beta_covariance, alpha_beta_gain, alpha_beta_gamma_covariance, alpha_beta_gamma_gain, alpha_beta_gamma_index,
    alpha_beta_index, innovation_variance,
};
use nalgebra::{Const, Matrix4, SMatrix, SVector, U0, U1, U2, U3, U4, Vector3, matrix, vector};
use num_traits::{One, Zero};
use std::collections::BTreeMap;

// The degrees of the rules

#[test]
fn third_degree_rule_is_exact_to_degree_three_and_not_four() {
    for n in 1..=10 {
        let found = exactness(&third_degree(n).unwrap(), 4);
        assert_eq!(found.degree, Some(3), "n = {n}");
        // E x₁⁴ is 2 · n²/(2n) = n. At n = 3 that is right, and a product of two squares is not.
        let first_wrong = match n {
            3 => "E x1^2 x2^2 = 0, where the Gaussian has 1".to_owned(),
            _ => format!("E x1^4 = {n}, where the Gaussian has 3"),
        };
        assert_eq!(found.failure.unwrap().to_string(), first_wrong);
    }
}

/// α is how far the points are from the mean, in parts of where they are for α = 1.
#[test]
fn the_spread_of_the_unscented_rule_is_its_first_parameter() {
    for n in 1..=5 {
        for kappa in [Rational::new(1, 2), Rational::new(2, 1)] {
            let whole_spread = unscented(n, &Parameters::of_kappa(kappa.clone())).unwrap();
            let parameters = Parameters {
                alpha: Rational::new(1, 3),
                ..Parameters::of_kappa(kappa)
            };
            let third = surd(&Rational::new(1, 3));
            let narrow = unscented(n, &parameters).unwrap();
            for (near, far) in narrow.points.iter().zip(&whole_spread.points) {
                let shrunk: Vec<Surd> = far.iter().map(|entry| entry.clone() * third.clone()).collect();
                assert_eq!(near, &shrunk);
            }
        }
    }
}

#[test]
fn unscented_rule_is_exact_to_degree_three_and_not_four() {
    for n in 1..=10 {
        for parameters in unscented_parameters(n) {
            let radius_squared = whole(n) + parameters.lambda(n);
            let found = exactness(&unscented(n, &parameters).unwrap(), 6);
            let first_wrong = found.failure.unwrap().to_string();
            // With the square of the radius 3 the fourth moment of a coordinate is right. In one dimension that is every
            // moment of degree four, and the rule is the Gauss-Hermite rule of three nodes.
            let (degree, text) = match (n, radius_squared == whole(3)) {
                (1, true) => (5, "E x1^6 = 9, where the Gaussian has 15".to_owned()),
                (_, true) => (3, "E x1^2 x2^2 = 0, where the Gaussian has 1".to_owned()),
                (_, false) => (3, format!("E x1^4 = {radius_squared}, where the Gaussian has 3")),
            };
            assert_eq!(found.degree, Some(degree), "n = {n}, {parameters:?}");
            assert_eq!(first_wrong, text);
        }
    }
}

#[test]
fn unscented_rule_of_one_dimension_has_degree_five_when_its_radius_squared_is_three() {
    let three_nodes = fifth_degree(1).unwrap();
    let kappa_two = unscented(1, &Parameters::of_kappa(whole(2))).unwrap();
    assert_eq!(kappa_two.points, three_nodes.points);
    assert_eq!(kappa_two.weights, three_nodes.weights);
    assert_eq!(exactness(&kappa_two, 5).degree, Some(5));
    // Another κ, another degree.
    let kappa_one = unscented(1, &Parameters::of_kappa(whole(1))).unwrap();
    assert_eq!(exactness(&kappa_one, 5).degree, Some(3));
}

#[test]
fn fifth_degree_rule_is_exact_to_degree_five_and_not_six() {
    for n in 1..=10 {
        let found = exactness(&fifth_degree(n).unwrap(), 6);
        assert_eq!(found.degree, Some(5), "n = {n}");
        // E x₁⁶ = (n + 2)(7 − n)/2: zero at n = 7 and negative beyond, for a power that is never negative.
        let sixth = (whole(n) + whole(2)) * (whole(7) - whole(n)) / whole(2);
        assert_eq!(
            found.failure.unwrap().to_string(),
            format!("E x1^6 = {sixth}, where the Gaussian has 15")
        );
    }
}

#[test]
fn simplex_rule_is_exact_to_degree_five_and_not_six() {
    for n in 2..=10 {
        let found = exactness(&simplex(n).unwrap(), 6);
        assert_eq!(found.degree, Some(5), "n = {n}");
        let wrong = found.failure.unwrap();
        let mut first = vec![0; n];
        first[0] = 6;
        assert_eq!(wrong.exponents, first);
        // The coordinates of the points along the first vertex: 1, −1/n; (n−1)/(2n) and 2/(n(n−1)) when squared.
        let n = whole(n);
        let along_midpoints = |times: Rational, squared: Rational| times * squared.pow(3);
        let vertices = (whole(1) + n.clone() / n.pow(6)) * simplex::vertex_weight(&n);
        let midpoints = along_midpoints(n.clone(), (n.clone() - whole(1)) / (whole(2) * n.clone()))
            + along_midpoints(
                n.clone() * (n.clone() - whole(1)) / whole(2),
                whole(2) / (n.clone() * (n.clone() - whole(1))),
            );
        let radius_to_the_sixth = (n.clone() + whole(2)).pow(3);
        let sixth = whole(2) * radius_to_the_sixth * (vertices + midpoints * simplex::edge_weight(&n));
        assert_eq!(wrong.rule, Surd::rational(&sixth));
        assert_eq!(wrong.gaussian, whole(15));
    }
}

#[test]
fn a_rule_with_one_wrong_point_or_weight_loses_its_degree() {
    let right = fifth_degree(3).unwrap();
    assert_eq!(exactness(&right, 5).degree, Some(5));

    let mut wrong_sign = right.clone();
    wrong_sign.points[1][0] = -wrong_sign.points[1][0].clone();
    assert_eq!(exactness(&wrong_sign, 5).degree, Some(0));

    let mut wrong_weight = right.clone();
    wrong_weight.weights[0] += Rational::new(1, 1_000_000_000_000);
    assert_eq!(exactness(&wrong_weight, 5).degree, None);

    // Opposite points that are moved outwards together keep the odd moments, and lose the second ones.
    let mut wrong_length = right;
    for point in &mut wrong_length.points[1..=6] {
        for coordinate in point {
            *coordinate *= Surd::ratio(1_000_001, 1_000_000);
        }
    }
    assert_eq!(exactness(&wrong_length, 5).degree, Some(1));
}

#[test]
fn sixth_moments_of_the_fifth_degree_rules_in_four_dimensions() {
    let gaussian = ["15", "3", "1"];
    let exponents = [[6, 0, 0, 0], [4, 2, 0, 0], [2, 2, 2, 0]];
    let fifth = fifth_degree(4).unwrap();
    let moments = |rule: &ExactRule| exponents.map(|e| rule_moment(rule, &e).to_string());
    assert_eq!(exponents.map(|e| gaussian_moment(&e).to_string()), gaussian);
    // The points of zhu2016 have at most two coordinates that are not zero: the product of three squares vanishes.
    assert_eq!(moments(&fifth), ["9", "3", "0"]);
    assert_eq!(moments(&simplex(4).unwrap()), ["435/32", "47/32", "91/96"]);
}

#[test]
fn sixth_moments_of_the_simplex_rule_depend_on_the_axis() {
    let sixth = |rule: &ExactRule| -> Vec<String> {
        (0..4)
            .map(|axis| {
                let mut exponents = [0; 4];
                exponents[axis] = 6;
                rule_moment(rule, &exponents).to_string()
            })
            .collect()
    };
    assert_eq!(sixth(&fifth_degree(4).unwrap()), ["9", "9", "9", "9"]);
    assert_eq!(sixth(&simplex(4).unwrap()), ["435/32", "1225/96", "275/24", "75/8"]);
}

// Gauss-Hermite

#[test]
fn gauss_hermite_rule_has_degree_two_m_minus_one() {
    for m in 2..=5 {
        let nodes = nodes(m).unwrap();
        assert_eq!(nodes.len(), m);
        // One coordinate: every power up to 2m − 1, and not 2m.
        for power in 0..2 * m {
            assert_eq!(moment(&nodes, power), gaussian(&[power]), "m = {m}");
        }
        assert_ne!(moment(&nodes, 2 * m), gaussian(&[2 * m]), "m = {m}");
        // Products: the sum over mⁿ points is a product of sums, so a monomial is right when each exponent is below 2m.
        for (n, up_to) in [(2, 2 * m), (3, 2 * m)] {
            for exponents in exponents_of_degree_up_to(n, up_to) {
                let product = exponents
                    .iter()
                    .fold(Surd::one(), |product, &power| product * moment(&nodes, power));
                let is_right = product == gaussian(&exponents);
                assert_eq!(is_right, exponents.iter().all(|&e| e < 2 * m));
            }
        }
    }
    assert!(nodes(1).is_err());
    assert!(nodes(6).is_err());
}

#[test]
fn gauss_hermite_nodes_come_in_pairs_of_opposite_sign() {
    for m in 2..=5 {
        let nodes = nodes(m).unwrap();
        for node in &nodes {
            let opposite = Node {
                sign: -node.sign,
                ..node.clone()
            };
            assert_eq!(nodes.iter().filter(|other| **other == opposite).count(), 1);
            assert_eq!(node.sign == 0, node.square.is_zero());
            assert!(node.weight.is_positive());
        }
    }
}

#[test]
fn gauss_hermite_nodes_are_the_roots_of_the_hermite_polynomial() {
    for m in 2..=5 {
        let factorial = (1..=m).fold(Surd::one(), |product, i| product * surd(&whole(i)));
        for node in nodes(m).unwrap() {
            assert!(hermite_squared(m, &node.square).is_zero(), "m = {m}");
            assert!(!hermite_squared(m, &(node.square.clone() + Surd::one())).is_zero());
            // Abramowitz and Stegun 25.4.46 in the variable √2 x: w = m! / (m² He₍m−1₎(x)²).
            let squared = hermite_squared(m - 1, &node.square);
            let weight = factorial.clone() / (surd(&whole(m * m)) * squared);
            assert_eq!(node.weight, weight, "m = {m}");
        }
    }
}

#[test]
fn gauss_hermite_rule_of_two_nodes_is_the_corners_of_a_cube() {
    // Every number here is a double: ±1 and 1/8.
    let rule = gauss_hermite::<f64, _>(U3, 2).unwrap();
    assert_eq!(rule.weights, vec![0.125; 8]);
    for corner in 0..8 {
        let sign = |axis: usize| if corner >> axis & 1 == 0 { 1.0 } else { -1.0 };
        let place = SVector::<f64, 3>::from_fn(|axis, _| sign(axis));
        assert_eq!(rule.points.iter().filter(|p| **p == place).count(), 1);
    }
}

// The points

#[test]
fn simplex_vertices_are_unit_vectors_with_equal_angles() {
    for n in 2..=10 {
        let vertices = vertices(n);
        assert_eq!(vertices.len(), n + 1);
        for (i, first) in vertices.iter().enumerate() {
            for (l, second) in vertices.iter().enumerate() {
                let expected = if i == l {
                    Surd::one()
                } else {
                    -Surd::one() / surd(&whole(n))
                };
                assert_eq!(inner(first, second), expected, "n = {n}, {i}, {l}");
            }
        }
        for axis in 0..n {
            let sum = vertices.iter().fold(Surd::zero(), |sum, v| sum + &v[axis]);
            assert!(sum.is_zero(), "n = {n}");
        }
    }
}

#[test]
fn simplex_edge_midpoints_are_unit_vectors_along_the_sums_of_two_vertices() {
    for n in 2..=10 {
        let vertices = vertices(n);
        let midpoints = edge_midpoints(n);
        assert_eq!(midpoints.len(), n * (n + 1) / 2);
        let mut next = midpoints.iter();
        for i in 0..=n {
            for l in i + 1..=n {
                let midpoint = next.next().unwrap();
                assert_eq!(inner(midpoint, midpoint), Surd::one());
                // Equally near to the two vertices, and nearer than to any other: (n − 1)/(2n) and 2/(n(n − 1)), squared.
                let near = inner(midpoint, &vertices[i]);
                assert_eq!(near, inner(midpoint, &vertices[l]));
                assert_eq!(
                    near.clone() * near.clone(),
                    surd(&((whole(n) - whole(1)) / (whole(2) * whole(n))))
                );
                assert!(near.is_positive());
            }
        }
    }
}

#[test]
fn simplex_points_coincide_at_dimension_two() {
    let rule = simplex(2).unwrap();
    assert_eq!(rule.points.len(), 13);
    assert_eq!(rule.distinct_points(), 7);
    // The midpoint between two vertices is the mirror image of the third.
    let (vertices, midpoints) = (vertices(2), edge_midpoints(2));
    for (midpoint, third) in midpoints.iter().zip([2, 1, 0]) {
        let mirror: Vec<Surd> = vertices[third].iter().map(|x| -x.clone()).collect();
        assert_eq!(*midpoint, mirror);
    }
    // At n = 3 the midpoints of opposite edges of the tetrahedron are each other's mirror images: 12 points at 6 places.
    let in_space = simplex(3).unwrap();
    assert_eq!((in_space.points.len(), in_space.distinct_points()), (21, 15));
    let tetrahedron = edge_midpoints(3);
    for (midpoint, opposite) in tetrahedron.iter().zip(tetrahedron.iter().rev()) {
        assert!(midpoint.iter().zip(opposite).all(|(x, y)| *x == -y.clone()));
    }
    for n in 4..=7 {
        let rule = simplex(n).unwrap();
        assert_eq!(rule.distinct_points(), rule.points.len(), "n = {n}");
    }
}

#[test]
fn rules_have_the_documented_number_of_points() {
    for n in 1..=10 {
        let parameters = Parameters::of_kappa(whole(1));
        assert_eq!(third_degree(n).unwrap().points.len(), 2 * n);
        assert_eq!(unscented(n, &parameters).unwrap().points.len(), 2 * n + 1);
        assert_eq!(fifth_degree(n).unwrap().points.len(), 2 * n * n + 1);
        if n > 1 {
            assert_eq!(simplex(n).unwrap().points.len(), n * n + 3 * n + 3);
        }
    }
    assert_eq!(gauss_hermite::<f64, _>(U4, 3).unwrap().points.len(), 81);
    for rule in all_rules(4) {
        assert_eq!(rule.points.len(), rule.weights.len());
        assert_eq!(rule.points.len(), rule.covariance_weights.len());
        assert!(rule.points.iter().all(|point| point.len() == 4));
    }
}

#[test]
fn rules_of_a_mean_and_a_covariance_exist_from_dimension_one_and_the_simplex_from_two() {
    assert!(third_degree(0).is_err());
    assert!(fifth_degree(0).is_err());
    assert!(unscented(0, &Parameters::of_kappa(whole(1))).is_err());
    assert!(simplex(1).is_err());
    assert!(gauss_hermite::<f64, _>(U0, 3).is_err());
    // n + λ = 0 and below have no radius.
    assert!(unscented(2, &Parameters::of_kappa(-whole(2))).is_err());
    assert!(unscented(2, &Parameters::of_kappa(-whole(3))).is_err());
}

#[test]
fn effective_points_are_25_of_33_and_57_of_73() {
    let fifth = fifth_degree(4).unwrap();
    assert_eq!((fifth.effective_points(), fifth.points.len()), (25, 33));
    let simplex_seven = simplex(7).unwrap();
    assert_eq!((simplex_seven.effective_points(), simplex_seven.points.len()), (57, 73));
    assert_eq!(fifth_degree(5).unwrap().effective_points(), 51);
    assert_eq!(simplex(4).unwrap().effective_points(), 31);
}

#[test]
fn unscented_rule_with_kappa_zero_is_the_third_degree_rule_and_a_centre_without_weight() {
    for n in 1..=10 {
        let third = third_degree(n).unwrap();
        let with_centre = unscented(n, &Parameters::of_kappa(whole(0))).unwrap();
        assert_eq!(with_centre.points[1..], third.points, "n = {n}");
        assert_eq!(with_centre.weights[1..], third.weights);
        assert!(with_centre.weights[0].is_zero());
        assert!(with_centre.points[0].iter().all(Zero::is_zero));
        // κ = 3 − n gives the same rule at n = 3, and at no other n.
        let for_gaussian = unscented(n, &Parameters::for_gaussian(n)).unwrap();
        assert_eq!(for_gaussian == with_centre, n == 3, "n = {n}");
    }
}

#[test]
fn components_without_variance_change_an_unscented_rule_exactly_when_they_change_its_radius() {
    let with = |n: usize, alpha: &Rational, kappa: &dyn Fn(usize) -> Rational| Parameters {
        alpha: alpha.clone(),
        beta: whole(2),
        kappa: kappa(n),
    };
    let for_gaussian = |n: usize| whole(3) - whole(n);
    let zero = |_: usize| whole(0);
    for (n, larger) in [(1, 2), (2, 3), (3, 5), (4, 6), (5, 8)] {
        for alpha in [whole(1), r(1, 2)] {
            let masses = |kappa: &dyn Fn(usize) -> Rational, dimension: usize| {
                unscented_masses(&with(dimension, &alpha, kappa), n, dimension)
            };
            // κ = 3 − n: the same weights in the same places, for means and for covariances, so that every sum over points is
            // the same, whatever is measured of them.
            assert_eq!(
                masses(&for_gaussian, n),
                masses(&for_gaussian, larger),
                "{n} in {larger}"
            );
            // Any other κ that goes with the dimension in this way does it too; a fixed one does not.
            let fourteen = |n: usize| whole(14) - whole(n);
            assert_eq!(masses(&fourteen, n), masses(&fourteen, larger));
            for fixed in [zero, |_: usize| whole(2)] {
                assert_ne!(masses(&fixed, n), masses(&fixed, larger), "{n} in {larger}");
            }
        }
    }

    // Constant velocity among six components: the points along two of them weigh 4/6 and the centre −1, together −1/3.
    let [four, six] = [4, 6].map(|n| unscented(n, &Parameters::for_gaussian(n)).unwrap().weights);
    assert_eq!(four[..2], [r(-1, 3), r(1, 6)]);
    assert_eq!(six[..2], [r(-1, 1), r(1, 6)]);
    assert_eq!(six[0].clone() + whole(4) * six[1].clone(), four[0]);
}

#[test]
fn constant_velocity_among_six_components_has_the_unscented_moments_of_four_when_kappa_is_three_minus_n() {
    // A predicted estimate of [x, y, vx, vy], by a lower factor of its covariance, and the same with an acceleration of zero.
    let root = matrix![3, 0, 0, 0; -1, 2, 0, 0; 1, 1, 2, 0; 2, -1, 0, 1].map(Surd::integer);
    let mean = vector![-1000, 1000, 4, 3].map(Surd::integer);
    let mut padded_root = SMatrix::<Surd, 6, 6>::zeros();
    padded_root.fixed_view_mut::<4, 4>(0, 0).copy_from(&root);
    let mut padded_mean = SVector::<Surd, 6>::zeros();
    padded_mean.fixed_rows_mut::<4>(0).copy_from(&mean);

    let for_gaussian = |n: usize| whole(3) - whole(n);
    let four = squared_range_moments(&root, &mean, for_gaussian(4));
    let six = squared_range_moments(&padded_root, &padded_mean, for_gaussian(6));
    assert_eq!(four, six);
    // Not so for λ = 0, where the points of the six are at √6 and those of the four at 2.
    let four = squared_range_moments(&root, &mean, whole(0));
    let six = squared_range_moments(&padded_root, &padded_mean, whole(0));
    assert_eq!(four.mean, six.mean, "of degree two, which both rules have");
    assert_ne!(four.variance, six.variance);
    assert_eq!(four.cross_covariance, six.cross_covariance, "of degree three");
}

#[test]
fn covariance_weights_differ_at_the_centre_only_and_give_the_unit_covariance() {
    for n in 1..=6 {
        for parameters in unscented_parameters(n) {
            let rule = unscented(n, &parameters).unwrap();
            assert_eq!(rule.covariance_weights[1..], rule.weights[1..]);
            let alpha_squared = parameters.alpha.pow(2);
            assert_eq!(
                rule.covariance_weights[0].clone() - rule.weights[0].clone(),
                whole(1) - alpha_squared + parameters.beta.clone()
            );
        }
    }
    for rule in all_rules(4) {
        for i in 0..4 {
            for j in 0..4 {
                let weighted = rule.points.iter().zip(&rule.covariance_weights);
                let moment = weighted.fold(Surd::zero(), |sum, (point, weight)| {
                    sum + surd(weight) * point[i].clone() * point[j].clone()
                });
                let expected = if i == j { Surd::one() } else { Surd::zero() };
                assert_eq!(moment, expected);
            }
        }
    }
}

// The weights

#[test]
fn signs_of_the_weights_are_as_documented() {
    for n in 1..=64 {
        let (exact, four, seven, three) = (whole(n), whole(4), whole(7), whole(3));
        let sign_of = |weight: Rational| weight.sign().unwrap();
        let below = |limit: &Rational| limit.partial_cmp(&exact).unwrap();

        assert!(fifth_degree::centre_weight(&exact).is_positive());
        assert!(fifth_degree::diagonal_weight(&exact).is_positive());
        assert_eq!(sign_of(fifth_degree::axis_weight(&exact)), below(&four));

        assert!(simplex::centre_weight(&exact).is_positive());
        assert_eq!(sign_of(simplex::vertex_weight(&exact)), below(&seven));
        assert_eq!(sign_of(simplex::sphere_vertex_weight(&exact)), below(&seven));
        assert_eq!(simplex::edge_weight(&exact).is_positive(), n > 1);
        assert_eq!(simplex::sphere_edge_weight(&exact).is_positive(), n > 1);

        assert!(third_degree::axis_weight(&exact).is_positive());
        let lambda = Parameters::for_gaussian(n).lambda(n);
        let centre = unscented::centre_weight(&exact, &lambda);
        assert_eq!(sign_of(centre), below(&three));
        assert!(unscented::axis_weight(&exact, &lambda).is_positive());
    }
}

#[test]
fn sums_of_absolute_weights_have_their_closed_forms() {
    for n in 1..=12 {
        let exact = whole(n);
        let fifth = fifth_degree(n).unwrap();
        // One while no weight is negative: up to n = 4. (The two forms agree there.)
        let expected = if n < 4 {
            whole(1)
        } else {
            (whole(3) * exact.pow(2) - whole(4) * exact.clone() + whole(4)) / (exact.clone() + whole(2)).pow(2)
        };
        assert_eq!(fifth.sum_of_absolute_weights(), expected, "n = {n}");

        assert_eq!(third_degree(n).unwrap().sum_of_absolute_weights(), whole(1));

        let for_gaussian = unscented(n, &Parameters::for_gaussian(n)).unwrap();
        let expected = if n < 3 {
            whole(1)
        } else {
            (whole(2) * exact.clone() - whole(3)) / whole(3)
        };
        assert_eq!(for_gaussian.sum_of_absolute_weights(), expected, "n = {n}");

        if n > 1 {
            let expected = if n <= 7 {
                whole(1)
            } else {
                whole(1)
                    + whole(2) * (exact.clone() - whole(7)) * exact.pow(2)
                        / ((exact.clone() + whole(1)) * (exact.clone() + whole(2)).pow(2))
            };
            assert_eq!(simplex(n).unwrap().sum_of_absolute_weights(), expected);
        }
    }
    let at_eight = simplex(8).unwrap().sum_of_absolute_weights();
    assert_eq!(at_eight, Rational::new(257, 225));
}

#[test]
fn negative_weights_of_the_fifth_degree_rule_vanish_one_by_one_and_not_in_sum() {
    // zhu2016, section 3: "the negative weights go to 0 when the dimension of the system goes to ∞".
    let of_all = |n: &Rational| whole(2) * n.clone() * fifth_degree::axis_weight(n);
    let mut before = whole(0);
    for n in 5..=64 {
        let n = whole(n);
        // The sum of the negative weights falls towards −1, and Σ|w| = 1 − 2 · sum rises towards 3 ...
        assert!(of_all(&n) < before);
        before = of_all(&n);
    }
    assert_eq!(of_all(&whole(64)), Rational::new(-320, 363));
    for power in 3..=9 {
        let n = whole(10_usize.pow(power));
        let rest = of_all(&n) + whole(1);
        assert!(rest.is_positive() && rest < whole(8) / n.clone());
        // ... while each of them vanishes like −1/(2n).
        assert!(fifth_degree::axis_weight(&n).abs() < whole(1) / n);
    }
}

// What the papers print

#[test]
fn printed_fifth_degree_weight_breaks_the_zeroth_moment() {
    for n in 2..=10 {
        let as_printed = printed::fifth_degree(n).unwrap();
        let exact = whole(n);
        let sum = (whole(3) * exact.pow(2) + whole(2) * exact.clone() + whole(4)) / (exact.clone() + whole(2)).pow(2);
        assert_eq!(as_printed.sum_of_weights(), sum, "n = {n}");
        let found = exactness(&as_printed, 5);
        assert_eq!(found.degree, None);
        assert_eq!(
            found.failure.unwrap().to_string(),
            format!("E 1 = {sum}, where the Gaussian has 1")
        );
        // The second moment is 3n/(n + 2) for 1.
        let second = wrong_moment_of_degree(&as_printed, 2).unwrap();
        let expected = whole(3) * exact.clone() / (exact + whole(2));
        assert_eq!(second.rule, surd(&expected));
        assert_eq!(second.gaussian, whole(1));

        let corrected = fifth_degree(n).unwrap();
        assert_eq!(corrected.points, as_printed.points);
        assert_eq!(corrected.sum_of_weights(), whole(1));
        assert_eq!(exactness(&corrected, 2).degree, Some(2));
    }
    for (n, numerator, denominator) in [(2, 5, 4), (3, 37, 25), (4, 5, 3)] {
        let sum = printed::fifth_degree(n).unwrap().sum_of_weights();
        assert_eq!(sum, Rational::new(numerator, denominator));
    }
    // In one dimension there are no diagonals, and the printed weight has nothing to break.
    assert_eq!(printed::fifth_degree(1), fifth_degree(1));
}

#[test]
fn printed_simplex_weights_of_11_break_the_zeroth_moment() {
    let sums = [(2, 23, 24), (3, 22, 25), (4, 4, 5)];
    for (n, numerator, denominator) in sums {
        let sum = printed::simplex_11(n).unwrap().sum_of_weights();
        assert_eq!(sum, Rational::new(numerator, denominator));
    }
    for n in 2..=10 {
        let as_printed = printed::simplex_11(n).unwrap();
        let exact = whole(n);
        let sum = (whole(7) * exact.pow(2) + whole(7) * exact.clone() + whole(4))
            / ((exact.clone() + whole(1)) * (exact + whole(2)).pow(2));
        assert_eq!(as_printed.sum_of_weights(), sum);
        assert_eq!(exactness(&as_printed, 5).degree, None, "n = {n}");
        check_simplex_is_right(n, &as_printed);
    }
}

#[test]
fn printed_simplex_weights_of_16_break_the_zeroth_moment() {
    let sums = [(2, 23, 24), (3, 21, 25), (4, 7, 10)];
    for (n, numerator, denominator) in sums {
        let sum = printed::simplex_16(n).unwrap().sum_of_weights();
        assert_eq!(sum, Rational::new(numerator, denominator));
    }
    for n in 2..=10 {
        let as_printed = printed::simplex_16(n).unwrap();
        let exact = whole(n);
        let sum = (whole(11) * exact.pow(2) - exact.pow(3) + whole(2) * exact.clone() + whole(6))
            / ((exact.clone() + whole(1)) * (exact + whole(2)).pow(2));
        assert_eq!(as_printed.sum_of_weights(), sum);
        assert_eq!(exactness(&as_printed, 5).degree, None, "n = {n}");
        check_simplex_is_right(n, &as_printed);
        // The two printings contradict each other, but at n = 2, where both are wrong.
        assert_eq!(as_printed == printed::simplex_11(n).unwrap(), n == 2);
    }
}

#[test]
fn printed_sphere_weights_do_not_sum_to_the_surface() {
    let printed_sums = [(2, 11, 24), (3, 12, 25), (4, 7, 15)];
    for n in 2..=10 {
        let exact = whole(n);
        let vertices = vertices(n);
        let midpoints = edge_midpoints(n);
        let sum = |vertex: Rational, edge: Rational| {
            whole(2) * (whole(vertices.len()) * vertex + whole(midpoints.len()) * edge)
        };
        let as_printed = sum(
            printed::sphere_vertex_weight(&exact),
            printed::sphere_edge_weight(&exact),
        );
        let expected = exact.clone() * (whole(5) * exact.clone() + whole(1))
            / ((exact.clone() + whole(1)) * (exact.clone() + whole(2)).pow(2));
        assert_eq!(as_printed, expected);
        assert_ne!(as_printed, whole(1));
        if let Some((_, numerator, denominator)) = printed_sums.iter().find(|row| row.0 == n) {
            assert_eq!(as_printed, Rational::new(*numerator, *denominator));
        }

        let vertex = simplex::sphere_vertex_weight(&exact);
        let edge = simplex::sphere_edge_weight(&exact);
        assert_eq!(sum(vertex.clone(), edge.clone()), whole(1));
        // As parts of the surface they are right for every polynomial of degree five on the sphere, and not six.
        let both_signs = |points: &[Vec<Surd>]| {
            let mirrored = points.iter().map(|point| point.iter().map(|x| -x.clone()).collect());
            points.iter().cloned().chain(mirrored).collect::<Vec<_>>()
        };
        let mut on_sphere = ExactRule {
            dimension: n,
            points: both_signs(&vertices),
            weights: vec![vertex; 2 * vertices.len()],
            covariance_weights: Vec::new(),
        };
        on_sphere.points.extend(both_signs(&midpoints));
        on_sphere.weights.extend(vec![edge; 2 * midpoints.len()]);
        if n <= 5 {
            for exponents in exponents_of_degree_up_to(n, 5) {
                assert_eq!(rule_moment(&on_sphere, &exponents), on_unit_sphere(&exponents));
            }
            let mut sixth = vec![0; n];
            sixth[0] = 6;
            assert_ne!(rule_moment(&on_sphere, &sixth), on_unit_sphere(&sixth));
        }
    }
}

#[test]
fn printed_radial_second_moment_row_is_violated() {
    for n in 1..=10 {
        let exact = whole(n);
        // The weights are parts of ½Γ(n/2), and so are the right sides: Γ(n/2 + 1)/Γ(n/2) = n/2. The first radius is zero.
        let (first, second, radius_squared) = simplex::radial_rule(&exact);
        let right_side = exact.clone() / whole(2);
        let first_radius_squared = whole(0);
        let as_printed = first.clone() * first_radius_squared.clone() + second.clone();
        let corrected = first * first_radius_squared + second * radius_squared;
        assert_ne!(as_printed, right_side, "n = {n}");
        assert_eq!(as_printed / right_side.clone(), whole(2) / (exact + whole(2)));
        assert_eq!(corrected, right_side, "n = {n}");
    }
}

#[test]
fn printed_surface_area_is_two_in_every_dimension() {
    // √π is an unknown here, so every equality holds for all its values, and for its own. Γ(1/2) is √π itself.
    let root_pi = RationalFunction::unknown("√π");
    let power = |n: usize| num_traits::pow(root_pi.clone(), n);
    let two = RationalFunction::integer(2);
    for n in 1..=10 {
        let as_printed = two.clone() * power(n) / power(n);
        assert_eq!(as_printed, two, "n = {n}");

        let corrected = two.clone() * power(n) / gamma_of_half(n, &root_pi);
        // ∫ exp(−xᵀx) dx over all space is π^(n/2), and in radius and direction it is A ∫ r^(n−1) exp(−r²) dr = A Γ(n/2)/2.
        let integral = |area: RationalFunction| area * gamma_of_half(n, &root_pi) / two.clone();
        assert_eq!(integral(corrected), power(n), "n = {n}");
        // The unit sphere of one dimension is two points: there, and nowhere else, the printed form is right.
        assert_eq!(integral(as_printed) == power(n), n == 1, "n = {n}");
    }
    let pi = power(2);
    let known = [
        two.clone() * pi.clone(),
        RationalFunction::integer(4) * pi.clone(),
        two.clone() * pi.clone() * pi,
    ];
    for (n, area) in (2..).zip(known) {
        assert_eq!(two.clone() * power(n) / gamma_of_half(n, &root_pi), area);
    }
}

// The counting behind the proofs for every n

/// The numbers of pairs are polynomials in n of degree four at most (two points, each with two indices), and the squared inner
/// products quotients of polynomials of degree two at most: formulas that are right in five dimensions are right in all.
///
/// In some dimensions two kinds of pairs have the same squared product and the same weights, and only their sum is seen: on the axes
/// and diagonals at n = 2 and n = 4, on the simplex at n = 3 and n = 7. That leaves six dimensions to each.
#[test]
fn inner_products_are_counted_as_the_points_have_them() {
    for n in 1..=9 {
        let exact = whole(n);
        let third = on_axes(&exact, whole(0), &third_degree::axis_weight(&exact), exact.clone());
        check_products(&third_degree(n).unwrap(), &third);
        let parameters = Parameters::of_kappa(Rational::new(1, 2));
        let lambda = parameters.lambda(n);
        let with_centre = on_axes(
            &exact,
            unscented::centre_weight(&exact, &lambda),
            &unscented::axis_weight(&exact, &lambda),
            exact.clone() + lambda,
        );
        check_products(&unscented(n, &parameters).unwrap(), &with_centre);
    }
    for n in 2..=9 {
        let exact = whole(n);
        let weight = fifth_degree::diagonal_weight(&exact);
        let on_planes = on_axes_and_diagonals(&exact, &weight);
        check_products(&fifth_degree(n).unwrap(), &on_planes);
        let weight = printed::diagonal_weight(&exact);
        let as_printed = on_axes_and_diagonals(&exact, &weight);
        check_products(&printed::fifth_degree(n).unwrap(), &as_printed);
        let on_edges = on_simplex(&exact, &simplex::edge_weight(&exact));
        check_products(&simplex(n).unwrap(), &on_edges);
    }
}

/// A harmonic sum is Σₘ (Σₛ wₛ Yₘ(s))² up to a positive factor: never negative, and zero only where all harmonics of the degree are right.
#[test]
fn a_harmonic_sum_is_a_sum_of_squares() {
    for n in 2..=8 {
        let exact = whole(n);
        let rules = [
            on_axes(&exact, whole(0), &third_degree::axis_weight(&exact), exact.clone()),
            on_axes_and_diagonals(&exact, &fifth_degree::diagonal_weight(&exact)),
            on_simplex(&exact, &simplex::edge_weight(&exact)),
        ];
        for (rule, degree) in rules.iter().zip([3, 5, 5]) {
            let sums: Vec<Rational> = (1..=4).map(|k| harmonic_sum(&exact, k, &rule.products)).collect();
            assert!(
                sums.iter().all(|sum| sum.is_positive() || sum.is_zero()),
                "n = {n}: {sums:?}"
            );
            assert!(sums[..(degree - 1) / 2].iter().all(Zero::is_zero), "n = {n}: {sums:?}");
        }
        assert!(harmonic_sum(&exact, 2, &rules[0].products).is_positive(), "n = {n}");
    }
}

#[test]
fn harmonic_sums_and_moments_find_the_same_degree() {
    for n in 2..=8 {
        let exact = whole(n);
        let on_planes = on_axes_and_diagonals(&exact, &fifth_degree::diagonal_weight(&exact));
        assert_eq!(on_planes.degree(), Some(5));
        let on_edges = on_simplex(&exact, &simplex::edge_weight(&exact));
        assert_eq!(on_edges.degree(), Some(5));
        let weight = third_degree::axis_weight(&exact);
        let third = on_axes(&exact, whole(0), &weight, exact.clone());
        assert_eq!(third.degree(), Some(3));
        let as_printed = on_axes_and_diagonals(&exact, &printed::diagonal_weight(&exact));
        assert_eq!(as_printed.degree(), None);
    }
}

// Rules as doubles

#[test]
fn rules_become_the_nearest_doubles() {
    for exact in all_rules(4) {
        let rule = Rule::<f64, U4>::from_exact(&exact).unwrap();
        for (double_point, point) in rule.points.iter().zip(&exact.points) {
            for (double, coordinate) in double_point.iter().zip(point) {
                check_nearest(*double, coordinate);
            }
        }
        let weights = rule.weights.iter().zip(&exact.weights);
        let covariance_weights = rule.covariance_weights.iter().zip(&exact.covariance_weights);
        for (double, weight) in weights.chain(covariance_weights) {
            check_nearest(*double, &surd(weight));
        }
    }
    assert!(Rule::<f64, U3>::from_exact(&fifth_degree(4).unwrap()).is_err());
    // Three Gauss-Hermite nodes are the fifth-degree rule of one dimension, to the last bit: the root of the double 3 is the
    // double nearest to √3.
    let three_nodes = gauss_hermite::<f64, _>(U1, 3).unwrap();
    let fifth = Rule::<f64, U1>::from_exact(&fifth_degree(1).unwrap()).unwrap();
    assert_eq!(three_nodes, fifth);
}

#[test]
fn every_rule_name_gives_its_rule() {
    let exact = |name: &str| name.parse::<RuleName>().unwrap().exact(4);
    assert_eq!(exact("cubature-3"), third_degree(4));
    assert_eq!(exact("unscented"), unscented(4, &Parameters::for_gaussian(4)));
    assert_eq!(exact("cubature-5"), fifth_degree(4));
    assert_eq!(exact("simplex-5"), simplex(4));
    assert_eq!(exact("cubature-5-printed"), printed::fifth_degree(4));
    assert_eq!(exact("simplex-5-printed-11"), printed::simplex_11(4));
    assert_eq!(exact("simplex-5-printed-16"), printed::simplex_16(4));
    let kappa_one = Parameters::of_kappa(whole(1));
    let with_parameters = RuleName::Unscented(Some(kappa_one.clone()));
    assert_eq!(with_parameters.exact(4), unscented(4, &kappa_one));
    // All names, those of the Gauss-Hermite rules too, give a rule in doubles; and no two the same.
    let rules: Vec<Rule<f64, U4>> = RuleName::NAMES
        .iter()
        .map(|name| name.parse::<RuleName>().unwrap().rule().unwrap())
        .collect();
    for (i, rule) in rules.iter().enumerate() {
        assert!(!rules[..i].contains(rule), "{}", RuleName::NAMES[i]);
    }
    for m in 2..=5 {
        let name = format!("gauss-hermite-{m}").parse::<RuleName>().unwrap();
        assert_eq!(name.rule::<f64, U2>(), gauss_hermite::<f64, _>(U2, m));
        assert_eq!(name.exact(2), Err(InvalidRule::NestedRoots));
    }
}

// Filters in small integers

#[test]
fn in_small_integers_a_cubature_filter_is_the_kalman_filter_bit_for_bit() {
    // The points ±2 e of the third-degree rule in four dimensions and its weights 1/8 keep all sums exact in doubles; so here are
    // the equations that need an ordered number, with their measurement.
    let rule = Rule::<f64, U4>::from_exact(&third_degree(4).unwrap()).unwrap();
    let mut draw = Integers::new();
    for _ in 0..50 {
        let root = draw.unit_lower::<4>().map(|x| x as f64);
        let covariance = root * root.transpose();
        let mean = draw.doubles::<4, 1>();
        let h = draw.doubles::<2, 4>();
        let noise_root = draw.doubles::<2, 2>();
        let noise = noise_root * noise_root.transpose();
        let measurement = Sensor::Linear(h);
        let points: Vec<_> = rule.points.iter().map(|xi| cubature::point(&root, xi, &mean)).collect();
        let values: Vec<_> = points.iter().map(|point| measurement.of(point)).collect();
        // The centre serves angles only; another one must change nothing.
        let anywhere = draw.doubles::<2, 1>();
        let value_mean = measurement.mean(&rule.weights, &values, &anywhere);
        assert_eq!(value_mean, h * mean);

        let weights = &rule.covariance_weights;
        let innovation = |values: &[SVector<f64, 2>]| {
            cubature::innovation_covariance(&measurement, weights, values, &value_mean, &noise)
        };
        assert_eq!(
            innovation(&values),
            kalman::innovation_covariance(&h, &covariance, &noise)
        );
        let cross = |values: &[SVector<f64, 2>]| {
            cubature::cross_covariance(&measurement, weights, &points, &mean, values, &value_mean)
        };
        assert_eq!(cross(&values), kalman::cross_covariance(&covariance, &h));
        // The values of the points are not those of other points.
        let mut mixed_up = values.clone();
        mixed_up.swap(0, 1);
        if values[0] != values[1] {
            assert_ne!(cross(&mixed_up), cross(&values));
        }
    }
}

#[test]
fn diagonal_mixing_with_equal_weights_is_the_mixture() {
    // Four estimates of equal variances weigh 1/4 each, and a half on either side.
    let mut draw = Integers::new();
    let weights = vec![0.25; 4];
    for _ in 0..20 {
        let estimates: Vec<Gaussian<f64, U3>> = (0..4)
            .map(|_| {
                let (a, b, c) = (draw.next_double(), draw.next_double(), draw.next_double());
                Gaussian {
                    mean: draw.doubles(),
                    covariance: matrix![64.0, a, b; a, 128.0, c; b, c, 32.0],
                }
            })
            .collect();
        let mean = diagonal_mixing::mixed_mean(&estimates);
        assert_eq!(mean, mixture_mean(&weights, &estimates));
        let covariance = diagonal_mixing::mixed_covariance(&estimates, &mean);
        let of_mixture = mixture_covariance(&weights, &estimates, &mean);
        assert_eq!(covariance, of_mixture);
        // With other variances the components weigh differently.
        let mut unequal = estimates.clone();
        unequal[0].covariance[(0, 0)] = 256.0;
        assert_ne!(diagonal_mixing::mixed_covariance(&unequal, &mean), of_mixture);
    }
}

// Matrices

/// For one measured component. P is asymmetric, P = M + A with M = Mᵀ and A = −Aᵀ, and the gain is W = P Hᵀ / S.
#[test]
fn only_one_form_of_the_update_forgets_an_asymmetry() {
    let symmetric = matrix![9, 2, 1; 2, 7, -3; 1, -3, 8].map(Rational::integer);
    let asymmetry = matrix![0, 1, -2; -1, 0, 3; 2, -3, 0].map(Rational::integer);
    let h = matrix![2, -1, 3].map(Rational::integer);
    let noise = matrix![Rational::integer(5)];
    let antisymmetric =
        |matrix: SMatrix<Rational, 3, 3>| (&matrix - matrix.transpose()).map(|entry| entry / Rational::integer(2));
    let identity = SMatrix::<Rational, 3, 3>::identity();
    let p = &symmetric + &asymmetry;
    let s = &h * &p * h.transpose() + noise;
    let gain_of = |covariance: &SMatrix<Rational, 3, 3>| (covariance * h.transpose()).map(|entry| entry / s[0].clone());
    let gain = gain_of(&p);
    // P − W S Wᵀ leaves A as it is; (I − W H) P leaves (I − W₀ H) A (I − W₀ H)ᵀ, with the gain W₀ of M alone.
    assert_eq!(antisymmetric(&p - &gain * &s * gain.transpose()), asymmetry);
    let shrinking = &identity - gain_of(&symmetric) * &h;
    let left = antisymmetric((&identity - &gain * &h) * &p);
    assert_eq!(left, &shrinking * &asymmetry * shrinking.transpose());
    assert_ne!(left, asymmetry);
}

#[test]
fn the_cholesky_factor_times_its_transpose_is_the_matrix() {
    // Small integers: every product, sum, quotient and root on the way is an integer, and a double holds it exactly.
    let mut draw = Integers::new();
    for _ in 0..100 {
        check_cholesky::<1>(&mut draw);
        check_cholesky::<2>(&mut draw);
        check_cholesky::<4>(&mut draw);
        check_cholesky::<6>(&mut draw);
    }
}

#[test]
fn an_entry_without_variance_has_a_row_of_zeros_in_the_square_root() {
    // 2 by 2 blocks of [4 2; 2 10] with zeros between: in exact doubles, and in the square root of the rest alone.
    let known = matrix![4.0, 0.0, 2.0, 0.0; 0.0, 0.0, 0.0, 0.0; 2.0, 0.0, 10.0, 0.0; 0.0, 0.0, 0.0, 0.0];
    let root = matrix![2.0, 0.0, 0.0, 0.0; 0.0, 0.0, 0.0, 0.0; 1.0, 0.0, 3.0, 0.0; 0.0, 0.0, 0.0, 0.0];
    assert_eq!(cholesky(&known).unwrap(), root);
    assert_eq!(cholesky(&Matrix4::<f64>::zeros()).unwrap(), Matrix4::zeros());
    // A variance of zero with a covariance is none, wherever the covariance stands; nor is one that is only nearly zero.
    for (row, column, value) in [(1, 0, 1e-300), (2, 1, 1e-300), (3, 1, 1e-300), (1, 1, -1e-300)] {
        let mut wrong = known;
        wrong[(row, column)] = value;
        let pivot = if row == 1 || column == 1 { 1 } else { 3 };
        assert_eq!(cholesky(&wrong).unwrap_err().pivot, pivot, "{row}, {column}");
    }
}

#[test]
fn cholesky_reads_the_lower_triangle_only() {
    let lower = matrix![4.0, f64::NAN; 2.0, 10.0];
    assert_eq!(cholesky(&lower).unwrap(), matrix![2.0, 0.0; 1.0, 3.0]);
    assert_eq!(ldl(&lower).diagonal, vector![4.0, 9.0]);
}

#[test]
fn a_matrix_that_is_not_positive_definite_has_no_cholesky_factor() {
    let refused = |pivot, dimension, decided| NotPositiveDefinite {
        pivot,
        dimension,
        decided,
    };
    let check2 = |matrix: SMatrix<f64, 2, 2>, expected: &NotPositiveDefinite| {
        assert_eq!(cholesky(&matrix).unwrap_err(), *expected);
        assert_eq!(check_positive_definite(&ldl(&matrix)).unwrap_err(), *expected);
    };
    check2(matrix![0.0, 1.0; 1.0, 1.0], &refused(0, 2, true));
    check2(matrix![-1.0, 0.0; 0.0, 1.0], &refused(0, 2, true));
    check2(matrix![1.0, 2.0; 2.0, 1.0], &refused(1, 2, true));
    check2(matrix![4.0, 2.0; 2.0, 1.0], &refused(1, 2, true)); // singular
    check2(matrix![f64::NAN, 0.0; 0.0, 1.0], &refused(0, 2, false));
    check2(matrix![1.0, 0.0; f64::NAN, 1.0], &refused(1, 2, false));
    // Rank two in four dimensions: the pivots stop at the second row.
    let rank_two = acceleration_noise(&1.0, &2.0);
    assert_eq!(cholesky(&rank_two).unwrap_err(), refused(1, 4, true));
    assert_eq!(
        refused(1, 4, true).to_string(),
        "is not positive definite: pivot 2 of 4 is not positive"
    );
    assert_eq!(
        refused(0, 2, false).to_string(),
        "is not positive definite: pivot 1 of 2 is not a number, or of undecided sign"
    );
    // And one that is.
    assert!(cholesky(&matrix![2.0, 1.0; 1.0, 1.0]).is_ok());
    assert!(check_positive_definite(&ldl(&matrix![2.0, 1.0; 1.0, 1.0])).is_ok());
}

#[test]
fn the_ldl_factors_solve_exactly_in_rationals() {
    let mut draw = Integers::new();
    for _ in 0..20 {
        let lower = draw.unit_lower::<5>().map(|x| Rational::new(x, 3));
        let unit = SMatrix::<Rational, 5, 5>::from_fn(|i, j| if i == j { whole(1) } else { lower[(i, j)].clone() });
        // Any pivots but zero: the factorisation does not need a positive definite matrix.
        let diagonal = SVector::<Rational, 5>::from_fn(|_, _| Rational::new(draw.up_to(9) * 2 + 1, draw.up_to(4) + 5));
        let matrix = &unit * SMatrix::from_diagonal(&diagonal) * unit.transpose();
        let factors = ldl(&matrix);
        assert_eq!(factors.lower, unit);
        assert_eq!(factors.diagonal, diagonal);

        let right = SMatrix::<Rational, 5, 2>::from_fn(|_, _| Rational::new(draw.up_to(9), 2));
        let solution = solve(&factors, &right);
        assert_eq!(&matrix * &solution, right);
        let column = right.column(0).into_owned();
        let form = (column.transpose() * solution.column(0))[(0, 0)].clone();
        assert_eq!(quadratic_form(&factors, &column), form);
    }
}

#[test]
fn positive_semidefinite_matrices_of_low_rank_are_accepted_and_indefinite_ones_refused() {
    assert!(is_positive_semidefinite(&SMatrix::<f64, 4, 4>::zeros()));
    for interval in [1.0, 2.0, 0.1, 0.3, 0.7, 1e-3, 17.3, 1e4] {
        for scale in [1.0, 10.0, 0.1, 1e-12, 1e9] {
            assert!(is_positive_semidefinite(&acceleration_noise(&scale, &interval)));
            assert!(is_positive_semidefinite(&integrated_noise(&scale, &interval)));
            let negative = -acceleration_noise(&scale, &interval);
            assert!(!is_positive_semidefinite(&negative));
        }
    }
    // v vᵀ of integers, of rank one.
    let mut draw = Integers::new();
    for _ in 0..100 {
        let vector = SVector::<f64, 5>::from_fn(|_, _| draw.up_to(9) as f64);
        let square = vector * vector.transpose();
        assert!(is_positive_semidefinite(&square));
        // Less than nothing along one axis.
        let mut less = square;
        less[(4, 4)] -= 1.0;
        assert!(!is_positive_semidefinite(&less));
    }
    for indefinite in [
        matrix![1.0, 2.0; 2.0, 1.0],
        matrix![1.0, 0.0; 0.0, -1.0],
        matrix![-1.0, 0.0; 0.0, 1.0],
        matrix![0.0, 1.0; 1.0, 0.0],
        matrix![0.0, 1.0; 1.0, 5.0],
        matrix![5.0, 1.0; 1.0, 0.0],
        matrix![1.0, 1.0; 1.0, 0.999_999],
    ] {
        assert!(!is_positive_semidefinite(&indefinite), "{indefinite}");
    }
}

/// Three variances with full correlations but for one pair: elimination leaves pivots of zero with an entry beside them, which no
/// semidefinite matrix has, whatever its sign and whatever the units. All numbers are powers of two and the like, so nothing is rounded.
#[test]
fn an_entry_beside_a_pivot_of_zero_is_refused_in_any_units() {
    for exponent in [0, 30, -30] {
        let unit = 2.0_f64.powi(exponent);
        let units = SMatrix::from_diagonal(&Vector3::new(1.0, unit, unit));
        for (entry, is_covariance) in [(1.0, true), (0.75, false), (1.25, false)] {
            let correlations = matrix![1.0, 1.0, 1.0; 1.0, 1.0, entry; 1.0, entry, 1.0];
            let covariance = units * correlations * units;
            assert_eq!(is_positive_semidefinite(&covariance), is_covariance, "{entry}, {unit}");
        }
    }
}

// Motion

/// An entry of the state is lacking where the motion makes it zero and no noise moves it; one of the two is not enough.
#[test]
fn a_mode_lacks_what_neither_motion_nor_noise_gives_it() {
    let (nothing, all) = (SMatrix::<f64, 2, 2>::zeros(), SMatrix::<f64, 2, 2>::identity());
    for (transition, noise, lacks) in [
        (nothing, nothing, true),
        (nothing, all, false),
        (all, nothing, false),
        (all, all, false),
    ] {
        let mode = Mode {
            name: String::new(),
            motion: Motion::Linear(transition),
            noise,
        };
        assert_eq!([mode.lacks(0), mode.lacks(1)], [lacks; 2]);
    }
}

#[test]
fn a_turn_of_rate_zero_is_constant_velocity() {
    for interval in [1.0, 0.1, 3.7, 1e-9, 1e9] {
        let straight = constant_velocity(&interval);
        assert_eq!(coordinated_turn(&0.0, &interval), straight);
        assert_eq!(coordinated_turn(&-0.0, &interval), straight);
        // A rate that is not zero turns, however slowly: the velocity is rotated.
        assert_ne!(coordinated_turn(&0.01, &interval), straight);
    }
}

// Filters with fixed gains

/// Modes that are the same are one filter whatever weights mix them: to mix equal means under weights that sum to one is to keep them.
#[test]
fn identical_modes_with_fixed_gains_are_the_filter_alone() {
    let h: SMatrix<Rational, 1, 3> = position_matrix();
    let (motion, gain) = (constant_acceleration(&r(2, 1)), steady(&r(1, 3), &r(2, 1)).1);
    let start = vector![r(5, 1), r(-3, 2), r(1, 4)];
    let mut alone = start.clone();
    let mut modes = vec![estimate_of(start); 3];
    for k in 0..6 {
        let z = vector![r(7 * k * k - 20, 3)];
        let weights = |j: i64| {
            let (first, second) = (r(j + k, 11 + k), r(2 * j + 1, 12 + j));
            vec![first.clone(), second.clone(), r(1, 1) - first - second]
        };
        let mixed: Vec<_> = (0..3).map(|j| mixture_mean(&weights(j), &modes)).collect();
        modes = mixed
            .iter()
            .map(|mean| estimate_of(fixed_step(&motion, &h, &gain, mean, &z)))
            .collect();
        alone = fixed_step(&motion, &h, &gain, &alone, &z);
        for mode in &modes {
            assert_eq!(mode.mean, alone, "step {k}");
        }
        assert_eq!(mixture_mean(&weights(1), &modes), alone, "combined, step {k}");
    }
}

/// A Kalman filter that starts with its equilibrium covariance stays there, and its gain is the fixed one: the same means for ever.
#[test]
fn a_kalman_filter_at_its_equilibrium_is_the_fixed_gain_filter() {
    let h: SMatrix<Rational, 1, 3> = position_matrix();
    let (t, noise) = (r(2, 1), r(1, 20));
    for root in [r(1, 2), r(1, 7), r(9, 10)] {
        let (velocity, acceleration) = steady(&root, &t);
        let s = innovation_variance(&root, &noise);
        let scale =
            |index: Rational| index.clone() * index * noise.clone() / (t.clone() * t.clone() * t.clone() * t.clone());
        let filters = [
            (
                embedded_constant_velocity(&t),
                response_noise(&embedded_velocity_response(&t), &scale(alpha_beta_index(&root))),
                alpha_beta_covariance(&root, &noise, &t),
                velocity,
            ),
            (
                constant_acceleration(&t),
                response_noise(&acceleration_response(&t), &scale(alpha_beta_gamma_index(&root))),
                alpha_beta_gamma_covariance(&root, &noise, &t),
                acceleration,
            ),
        ];
        for (motion, process_noise, predicted, gain) in filters {
            let mut fixed = vector![r(500, 1), r(-18, 1), r(0, 1)];
            let mut mean = fixed.clone();
            let mut covariance = update::updated_covariance(&predicted, &gain, &matrix![s.clone()]);
            for k in 0..4 {
                let z = vector![r(13 * k * k - 90, 7)];
                let before = kalman::predicted_covariance(&motion, &covariance, &process_noise);
                let innovation_covariance = kalman::innovation_covariance(&h, &before, &matrix![noise.clone()]);
                let cross_covariance = kalman::cross_covariance(&before, &h);
                let own = update::gain(&cross_covariance, &ldl(&innovation_covariance));
                covariance = update::updated_covariance(&before, &own, &innovation_covariance);
                mean = fixed_step(&motion, &h, &own, &mean, &z);
                fixed = fixed_step(&motion, &h, &gain, &fixed, &z);
                assert_eq!((before, own), (predicted.clone(), gain.clone()), "step {k}");
                assert_eq!(innovation_covariance, matrix![s.clone()], "step {k}");
                assert_eq!(mean, fixed, "step {k}");
            }
        }
    }
}

// The filters of the coastal radar

#[test]
fn both_filters_of_the_coastal_radar_cost_what_their_equations_cost() {
    let total = |filter: CoastalRadar| Sums::ALL.map(|sums| filter.operations(sums));
    // By hand, every matrix full and every sum from nothing. In either filter: c 8, μᵢ∣ⱼ 8, x̂⁰ 48, P⁰ 744, A x̂⁰ 144, A P⁰ Aᵀ + Q 1800,
    // Λ 4, C 4, μ 4, x̂ 24, P 372.
    let common = 8 + 8 + 48 + 744 + 144 + 1800 + 4 + 4 + 4 + 24 + 372;
    // In each mode: ν 2, factors of S 4, K 36, x̂⁻ + K ν 30, P⁻ − K S Kᵀ 228, ln L 20.
    let update = 2 + 4 + 36 + 30 + 228 + 20;
    // The conversion: z 6, R 22; in each mode H x̂⁻ 24, H P⁻ Hᵀ + R 196, P⁻ Hᵀ 144.
    let converted = common + 6 + 22 + 2 * (update + 24 + 196 + 144);
    // In each mode: h 13 · 5 and once more of the centre, ẑ 66, S 234, C 728; root and points of six components 91 + 114, and of those of
    // constant velocity, which knows that it has no acceleration, 62 + 108.
    let unscented = common + 2 * (update + 70 + 66 + 234 + 728) + 91 + 114 + 62 + 108;
    // Points for the prediction too, in each mode: root and points 91 + 114, F X 13 · 72, x̂⁻ 156 for 72, P⁻ 1950 for 900.
    let twice = unscented + 2 * (91 + 114 + 13 * 72 + 156 - 72 + 1950 - 900);
    assert_eq!(total(CoastalRadar::Converted), [converted, 3881]);
    assert_eq!(total(CoastalRadar::Unscented), [unscented, 5248]);
    assert_eq!(total(CoastalRadar::UnscentedTwice), [twice, 8790]);
    assert_eq!(
        CoastalRadar::ALL.map(CoastalRadar::roots_and_functions),
        [[0, 11], [38, 34], [50, 34]]
    );
}

#[test]
fn the_arguments_of_sustika2015_are_judged_by_what_can_be_computed() {
    let judged = [
        difficult_jacobian(),
        kalman_needs_modification(),
        exact_moments(),
        execution_time(),
        no_linearisation(),
    ];
    let found = judged
        .each_ref()
        .map(|judgement| (judgement.id.as_str(), judgement.verdict));
    let expected = [
        ("sustika2015-difficult-jacobian", Verdict::Refuted),
        ("sustika2015-kalman-needs-modification", Verdict::Proven),
        ("sustika2015-exact-moments", Verdict::Proven),
        ("sustika2015-execution-time", Verdict::Proven),
        ("sustika2015-no-linearisation", Verdict::Refuted),
    ];
    assert_eq!(found, expected);
}

/// What is proven by it must fail where there is nothing to prove: a number that is not zero, and one of which too little is known.
#[test]
fn only_what_is_known_to_be_zero_vanishes() {
    let third = || Enclosure::ratio(1, 3) * Enclosure::integer(3) - Enclosure::integer(1);
    assert!(vanishes(&Enclosure::integer(0)));
    assert!(vanishes(&Enclosure::with_precision(192, third)));
    // 3 · ⅓ − 1 to 64 bits may be 10⁻²⁰; 10⁻⁵⁰ is known not to be zero.
    assert!(!vanishes(&Enclosure::with_precision(64, third)));
    assert!(!vanishes(&Enclosure::exact(1e-50)));
}

/// A measurement that is linear has all signs of it.
#[test]
fn a_linear_measurement_has_the_signs_of_linearity_and_range_and_bearing_have_none() {
    let position = SMatrix::<Enclosure, 2, 6>::identity();
    assert_eq!(signs_of_linearity(&Sensor::Linear(position)), [Some(true); 3]);
    let polar = Sensor::Polar {
        components: vec![PolarComponent::Range, PolarComponent::Bearing],
        position: [0, 1],
        location: [0, 0].map(Enclosure::integer),
    };
    assert_eq!(signs_of_linearity(&polar), [Some(false); 3]);
}

/// With one weight of the means or one of the covariances changed the points have only the other moment.
#[test]
fn points_keep_both_moments_where_both_weights_are_right() {
    let rule = unscented(4, &Parameters::for_gaussian(4)).unwrap();
    assert!(keeps_both_moments::<4>(&rule));
    let doubled = |weights: &[Rational]| -> Vec<Rational> {
        let mut doubled = weights.to_vec();
        doubled[1] = doubled[1].clone() + doubled[1].clone();
        doubled
    };
    let mean_is_wrong = ExactRule {
        weights: doubled(&rule.weights),
        ..rule.clone()
    };
    let covariance_is_wrong = ExactRule {
        covariance_weights: doubled(&rule.covariance_weights),
        ..rule
    };
    for wrong in [mean_is_wrong, covariance_is_wrong] {
        assert!(Rule::<RationalFunction, U4>::from_exact(&wrong).is_ok());
        assert!(!keeps_both_moments::<4>(&wrong));
    }
}

/// The steady gains of constant velocity and constant acceleration with the same damping root.
fn steady(root: &Rational, interval: &Rational) -> (Vector3<Rational>, Vector3<Rational>) {
    (alpha_beta_gain(root, interval), alpha_beta_gamma_gain(root, interval))
}

/// F x̂ + K (z − H F x̂), the fixed-gain update as derbez2000 prints it.
fn fixed_step(
    motion: &SMatrix<Rational, 3, 3>,
    h: &SMatrix<Rational, 1, 3>,
    gain: &Vector3<Rational>,
    mean: &Vector3<Rational>,
    z: &SVector<Rational, 1>,
) -> Vector3<Rational> {
    let predicted = motion * mean;
    &predicted + gain * (z - h * &predicted)
}

/// An estimate without a covariance.
fn estimate_of(mean: Vector3<Rational>) -> Gaussian<Rational, U3> {
    Gaussian {
        mean,
        ..Gaussian::zeros(U3)
    }
}

fn r(numerator: i64, denominator: i64) -> Rational {
    Rational::new(numerator, denominator)
}

// Helpers

/// An integer as an exact number.
fn whole(value: usize) -> Rational {
    Rational::integer(i64::try_from(value).unwrap())
}

/// A rational as a surd.
fn surd(value: &Rational) -> Surd {
    Surd::rational(value)
}

/// The Gaussian's moment as a surd.
fn gaussian(exponents: &[usize]) -> Surd {
    surd(&gaussian_moment(exponents))
}

/// The mean of a monomial over the unit sphere: the Gaussian's moment without its radial part.
fn on_unit_sphere(exponents: &[usize]) -> Surd {
    let degree: usize = exponents.iter().sum();
    let radial = radial_moment(&whole(exponents.len()), degree / 2);
    surd(&(gaussian_moment(exponents) / radial))
}

/// The inner product.
fn inner(a: &[Surd], b: &[Surd]) -> Surd {
    let products = a.iter().zip(b).filter(|(x, y)| !x.is_zero() && !y.is_zero());
    products.fold(Surd::zero(), |sum, (x, y)| sum + x * y)
}

/// Parameters for n dimensions: κ = 0, ½, 2 and 3 − n, and sets with α and β, some with n + λ = 3.
fn unscented_parameters(n: usize) -> Vec<Parameters> {
    let q = Rational::new;
    let mut all: Vec<Parameters> = [q(0, 1), q(1, 2), q(2, 1)]
        .into_iter()
        .map(Parameters::of_kappa)
        .collect();
    all.push(Parameters::for_gaussian(n));
    let with = |alpha, beta, kappa| Parameters { alpha, beta, kappa };
    all.push(with(q(1, 2), q(2, 1), q(0, 1)));
    all.push(with(q(1, 1000), q(2, 1), whole(3) - whole(n)));
    all.push(with(q(1, 2), q(2, 1), whole(12) - whole(n)));
    all
}

/// The weights of an unscented rule in `dimension` components by the places of its points, when only the first `n` components have a
/// variance, here one, so that the others leave no trace: means' weights and covariances', as lists of places and weights.
fn unscented_masses(parameters: &Parameters, n: usize, dimension: usize) -> Vec<(Vec<Surd>, [Rational; 2])> {
    let rule = unscented(dimension, parameters).unwrap();
    let mut masses: Vec<(Vec<Surd>, [Rational; 2])> = Vec::new();
    for (s, point) in rule.points.iter().enumerate() {
        let place = &point[..n];
        let weights = [&rule.weights[s], &rule.covariance_weights[s]];
        if let Some((_, sums)) = masses.iter_mut().find(|(known, _)| known == place) {
            for (sum, weight) in sums.iter_mut().zip(weights) {
                *sum += weight.clone();
            }
        } else {
            masses.push((place.to_vec(), weights.map(Clone::clone)));
        }
    }
    masses
}

/// What an unscented filter computes of a measurement.
#[derive(Debug, PartialEq)]
struct Moments {
    mean: Surd,
    variance: Surd,
    /// With the first four components of the state.
    cross_covariance: Vec<Surd>,
}

/// The unscented moments of the squared range x² + y², a polynomial, so that they are surds.
fn squared_range_moments<const N: usize>(
    root: &SMatrix<Surd, N, N>,
    mean: &SVector<Surd, N>,
    kappa: Rational,
) -> Moments {
    let rule = Rule::<Surd, Const<N>>::from_exact(&unscented(N, &Parameters::of_kappa(kappa)).unwrap()).unwrap();
    let points: Vec<_> = rule.points.iter().map(|xi| cubature::point(root, xi, mean)).collect();
    let squared_range = |point: &SVector<Surd, N>| point[0].clone() * &point[0] + point[1].clone() * &point[1];
    let values: Vec<_> = points.iter().map(|point| vector![squared_range(point)]).collect();
    let value_mean = cubature::weighted_mean(&rule.weights, &values);
    let none = matrix![Surd::zero()];
    let variance = cubature::weighted_covariance(&rule.covariance_weights, &values, &value_mean, &none);
    let mut cross = SVector::<Surd, N>::zeros();
    for ((weight, point), value) in rule.covariance_weights.iter().zip(&points).zip(&values) {
        cross += (point - mean) * ((value[0].clone() - &value_mean[0]) * weight.clone());
    }
    Moments {
        mean: value_mean[0].clone(),
        variance: variance[0].clone(),
        cross_covariance: cross.as_slice()[..4].to_vec(),
    }
}

/// One rule of each kind that has a degree.
fn all_rules(n: usize) -> Vec<ExactRule> {
    let mut rules = vec![third_degree(n).unwrap(), fifth_degree(n).unwrap(), simplex(n).unwrap()];
    for parameters in unscented_parameters(n) {
        rules.push(unscented(n, &parameters).unwrap());
    }
    rules
}

/// All exponents of n coordinates with a sum of at most `degree`.
fn exponents_of_degree_up_to(n: usize, degree: usize) -> Vec<Vec<usize>> {
    if n == 0 {
        return vec![Vec::new()];
    }
    let mut all = Vec::new();
    for first in 0..=degree {
        for mut rest in exponents_of_degree_up_to(n - 1, degree - first) {
            rest.insert(0, first);
            all.push(rest);
        }
    }
    all
}

/// The square of the Hermite polynomial He₍m₎(x), from x²: He₍m+1₎ = x He₍m₎ − m He₍m−1₎, the odd ones carried without their x.
fn hermite_squared(m: usize, squared: &Surd) -> Surd {
    let (mut before, mut now) = (Surd::zero(), Surd::one());
    for k in 0..m {
        // From an even to an odd one the factor x is left out; from an odd to an even one it comes twice.
        let raised = if k % 2 == 0 { now.clone() } else { squared * &now };
        let next = raised - surd(&whole(k)) * before;
        (before, now) = (now, next);
    }
    let square = now.clone() * now;
    if m.is_multiple_of(2) { square } else { squared * square }
}

/// Γ(n/2) in terms of √π: Γ(1/2) = √π, Γ(1) = 1 and Γ(x + 1) = x Γ(x).
fn gamma_of_half(n: usize, root_pi: &RationalFunction) -> RationalFunction {
    let first = if n % 2 == 1 {
        root_pi.clone()
    } else {
        RationalFunction::one()
    };
    let steps = (2 - n % 2..n).step_by(2);
    steps.fold(first, |gamma, twice| {
        gamma * RationalFunction::rational(&(whole(twice) / whole(2)))
    })
}

/// The corrected simplex rule has the same points as a printed one, other weights on the midpoints, and is of degree two at least.
fn check_simplex_is_right(n: usize, as_printed: &ExactRule) {
    let corrected = simplex(n).unwrap();
    assert_eq!(corrected.points, as_printed.points);
    assert_eq!(corrected.sum_of_weights(), whole(1));
    assert_eq!(exactness(&corrected, 2).degree, Some(2));
    // The centre and the vertices are printed right, the midpoints are not.
    let midpoints = 1 + 2 * (n + 1);
    assert_eq!(corrected.weights[..midpoints], as_printed.weights[..midpoints]);
    for (right, wrong) in corrected.weights.iter().zip(&as_printed.weights).skip(midpoints) {
        assert_ne!(right, wrong);
    }
}

/// How many ordered pairs have a squared inner product and a product of weights; both as text, which is unique.
type Pairs = BTreeMap<(String, String), Rational>;

/// The pairs of a rule's points on its sphere are those of the spherical rule, and so are radius and sums of weights.
fn check_products(rule: &ExactRule, spherical: &SphericalRule<Rational>) {
    let mut centre = Rational::zero();
    let mut sphere = Rational::zero();
    let mut directions = Vec::new();
    for (point, weight) in rule.points.iter().zip(&rule.weights) {
        let length = inner(point, point);
        if length.is_zero() {
            centre += weight;
            continue;
        }
        assert_eq!(length, surd(&spherical.radius_squared));
        sphere += weight;
        directions.push((point, weight));
    }
    assert_eq!(centre, spherical.centre);
    assert_eq!(sphere, spherical.sphere);
    assert_eq!(whole(rule.dimension), spherical.n);

    let mut of_points = Pairs::new();
    for (s, s_weight) in &directions {
        for (t, t_weight) in &directions {
            let product = inner(s, t) / surd(&spherical.radius_squared);
            let squared = (product.clone() * product).as_rational().unwrap();
            let weights = *s_weight * *t_weight / (&sphere * &sphere);
            count(&mut of_points, &squared, &weights, &whole(1));
        }
    }
    let mut of_formulas = Pairs::new();
    for product in &spherical.products {
        if !product.pairs.is_zero() {
            count(&mut of_formulas, &product.squared, &product.weights, &product.pairs);
        }
    }
    assert_eq!(of_points, of_formulas, "n = {}", rule.dimension);
}

/// Adds pairs to a table.
fn count(table: &mut Pairs, squared: &Rational, weights: &Rational, pairs: &Rational) {
    let key = (squared.to_string(), weights.to_string());
    *table.entry(key).or_insert_with(Rational::zero) += pairs;
}

/// No neighbour of the double is nearer to the exact number than the double itself.
fn check_nearest(double: f64, exact: &Surd) {
    let distance = |value: f64| (surd(&Rational::from_f64(value)) - exact).abs();
    let own = distance(double);
    assert!(own <= distance(double.next_up()), "{double} for {exact}");
    assert!(own <= distance(double.next_down()), "{double} for {exact}");
}

/// A lower triangular matrix of integers with a positive diagonal is the Cholesky factor of its square, exactly.
fn check_cholesky<const N: usize>(draw: &mut Integers) {
    let mut lower = draw.unit_lower::<N>();
    for i in 0..N {
        lower[(i, i)] = draw.up_to(9).abs() + 1;
    }
    let root = lower.map(|x| x as f64);
    let square = root * root.transpose();
    let factor = cholesky(&square).unwrap();
    assert_eq!(factor, root);
    assert_eq!(factor * factor.transpose(), square);
    // L D Lᵀ of the same matrix is exact in rationals.
    let exact = lower.map(|x| Rational::new(x, 1));
    let factors = ldl(&(&exact * exact.transpose()));
    let diagonal = SMatrix::from_diagonal(&factors.diagonal);
    assert_eq!(
        &factors.lower * diagonal * factors.lower.transpose(),
        &exact * exact.transpose()
    );
    for i in 0..N {
        assert_eq!(factors.diagonal[i], exact[(i, i)].pow(2));
    }
}

/// Small integers without a pattern, the same in every run: the upper bits of a linear congruential generator (Knuth's MMIX).
struct Integers(u64);

impl Integers {
    fn new() -> Self {
        Self(20_160_608)
    }

    /// An integer from −bound to bound.
    fn up_to(&mut self, bound: i64) -> i64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        i64::try_from(self.0 >> 40).unwrap() % (2 * bound + 1) - bound
    }

    /// An integer from −9 to 9 as a double.
    fn next_double(&mut self) -> f64 {
        self.up_to(9) as f64
    }

    /// A matrix of such integers.
    fn doubles<const R: usize, const C: usize>(&mut self) -> SMatrix<f64, R, C> {
        SMatrix::from_fn(|_, _| self.next_double())
    }

    /// A lower triangular matrix with ones on its diagonal.
    fn unit_lower<const N: usize>(&mut self) -> SMatrix<i64, N, N> {
        SMatrix::from_fn(|i, j| match i.cmp(&j) {
            std::cmp::Ordering::Less => 0,
            std::cmp::Ordering::Equal => 1,
            std::cmp::Ordering::Greater => self.up_to(9),
        })
    }
}
