//! Goal: the equations obey the laws of what they name (an angle, a turn, a density, an expectation), whatever their inputs are.
//!
//! Method: random inputs by proptest where they have a structure and by quickcheck where they are plain numbers; each result is
//! compared with a law or with a second way to the same number that shares no code with the first. Kind of evidence: property. Where
//! exact arithmetic can decide there is no tolerance; elsewhere it is a bound on rounding, derived beside it. u is 2⁻⁵³, the unit
//! roundoff of a double.

use immaculate::filter::cubature::{point, weighted_mean};
use immaculate::gaussian::{Gaussian, log_density, mixture_covariance, mixture_mean};
use immaculate::matrix::{cholesky, is_positive_semidefinite, is_symmetric, ldl, log_determinant};
use immaculate::model::angle::wrap;
use immaculate::model::motion::{constant_velocity, coordinated_turn};
use immaculate::model::{PolarComponent, Sensor};
use immaculate::number::{Field, Rational, Real, Roots, Surd};
use immaculate::rule::unscented::{Parameters, unscented, unscented_in};
use immaculate::rule::{Rule, RuleName};
use immaculate::statistics::fit_error::{FitForm, percentage_fit_error, position_fit_error};
use nalgebra::{Const, SMatrix, SVector, U2, U3, U4, Vector3, vector};
use num_traits::Zero;
use proptest::prelude::*;
use quickcheck::QuickCheck;
use std::f64::consts::PI;

/// The unit roundoff of a double: no operation is off by more than this part of its result.
const ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// Proptest with a number of cases; failures are printed, not written to a file.
fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

// Angles

/// How many turns `wrap` took away, as an exact number.
fn turns_between(angle: f64, wrapped: f64) -> Rational {
    let two_pi = Rational::from_f64(2.0 * PI);
    (Rational::from_f64(angle) - Rational::from_f64(wrapped)) / two_pi
}

/// How far an exact number is from the nearest integer.
fn distance_to_integer(value: &Rational) -> Rational {
    let nearest = value.to_f64().round();
    (value.clone() - Rational::from_f64(nearest)).abs()
}

/// Differences of two bearings are at most a few turns apart, and for them nothing is rounded: a number between half of 2π and its
/// double minus 2π is exact (Sterbenz), and one step of `wrap` brings every angle up to 4π there or home.
#[test]
fn a_wrapped_angle_is_in_the_half_open_turn_and_differs_by_whole_turns() {
    let law = |seed: i64| {
        // Any of 2⁶³ angles evenly over ±4π.
        let angle = seed as f64 / 9.3e18 * 4.0 * PI;
        let wrapped = wrap(angle);
        let is_whole = distance_to_integer(&turns_between(angle, wrapped)).is_zero();
        -PI < wrapped && wrapped <= PI && is_whole
    };
    QuickCheck::new().tests(20_000).quickcheck(law as fn(i64) -> bool);

    // The ends of the interval and their neighbours.
    for angle in [
        PI,
        -PI,
        PI.next_up(),
        PI.next_down(),
        (-PI).next_up(),
        (-PI).next_down(),
    ] {
        let wrapped = wrap(angle);
        assert!(-PI < wrapped && wrapped <= PI, "{angle}");
        assert!(distance_to_integer(&turns_between(angle, wrapped)).is_zero());
    }
    assert_eq!(wrap(-PI).to_bits(), PI.to_bits());
    assert_eq!(wrap(PI).to_bits(), PI.to_bits());
    // Inside of the interval nothing is touched.
    for angle in [0.0, -0.0, 1.5, -3.0] {
        assert_eq!(wrap(angle).to_bits(), angle.to_bits());
    }
}

proptest! {
    #![proptest_config(cases(2000))]

    /// Up to a thousand turns each turn that is taken away is rounded once, by at most u times the angle.
    #[test]
    fn an_angle_of_many_turns_is_wrapped_up_to_a_rounding_a_turn(angle in -6200.0..6200.0_f64) {
        let wrapped = wrap(angle);
        prop_assert!(-PI < wrapped && wrapped <= PI);
        let turns = turns_between(angle, wrapped);
        let allowed = (turns.to_f64().abs() + 1.0) * ROUNDOFF * angle.abs() / (2.0 * PI);
        prop_assert!(distance_to_integer(&turns).to_f64() <= allowed);
    }

    /// A difference of bearings of a thousand turns is no difference of bearings.
    #[test]
    fn an_angle_beyond_a_thousand_turns_is_undecided(turns in 1001.0..1e12_f64, negative: bool) {
        let angle = if negative { -turns } else { turns } * 2.0 * PI;
        prop_assert!(wrap(angle).is_nan());
    }
}

// Measurements

/// The order of two measurements turns the sign of their difference, but for a difference of half a turn, which is π both ways.
#[test]
fn the_difference_of_two_measurements_is_antisymmetric_off_the_cut() {
    let law = |ranges: (i32, i32), bearings: (i32, i32)| {
        let measurement = range_bearing([0.0, 0.0]);
        let bearing = |seed: i32| f64::from(seed) / 2_147_483_648.0 * PI;
        let a = vector![f64::from(ranges.0), bearing(bearings.0)];
        let b = vector![f64::from(ranges.1), bearing(bearings.1)];
        let forth = measurement.difference(&a, &b);
        let back = measurement.difference(&b, &a);
        if forth[1].to_bits() == PI.to_bits() {
            return back[1].to_bits() == PI.to_bits();
        }
        forth == -back && forth[1].abs() < PI
    };
    QuickCheck::new()
        .tests(20_000)
        .quickcheck(law as fn((i32, i32), (i32, i32)) -> bool);

    // On the cut: π both ways, and never −π.
    let (left, right) = (vector![1.0, PI], vector![1.0, 0.0]);
    let measurement = range_bearing([0.0, 0.0]);
    assert_eq!(measurement.difference(&left, &right)[1].to_bits(), PI.to_bits());
    assert_eq!(measurement.difference(&right, &left)[1].to_bits(), PI.to_bits());
}

proptest! {
    #![proptest_config(cases(4000))]

    /// (r cos θ, r sin θ) is the position as the sensor sees it.
    ///
    /// x and y are seen from the sensor after one rounding each, which the test does the same way. Then r is the root of a sum of
    /// two squares (four roundings, the root halves those before it: under 3u of r in all), and θ is off by one rounding of
    /// atan2 (libm: under one unit in the last place, 2u·π), sine and cosine by one each; the two products by one each. Together less
    /// than 16u of r.
    #[test]
    fn a_range_bearing_measurement_is_the_polar_form_of_the_position(
        x in -1e5..1e5_f64, y in -1e5..1e5_f64, velocity in -300.0..300.0_f64, east in -1e4..1e4_f64, north in -1e4..1e4_f64,
    ) {
        let measured = range_bearing([east, north]).of(&vector![x, velocity, y, -velocity]);
        let (range, bearing) = (measured[0], measured[1]);
        prop_assert!(range >= 0.0 && -PI < bearing && bearing <= PI);
        let (x, y) = (x - east, y - north);
        let allowed = 16.0 * ROUNDOFF * range;
        prop_assert!((range * Real::cos(&bearing) - x).abs() <= allowed);
        prop_assert!((range * Real::sin(&bearing) - y).abs() <= allowed);
    }
}

/// Straight to the left is π, whatever sign the zero has; the sensor's own place has a bearing too.
#[test]
fn the_bearing_of_a_target_straight_to_the_left_is_half_a_turn() {
    let measurement = range_bearing([0.0, 0.0]);
    for zero in [0.0, -0.0] {
        let measured = measurement.of(&vector![-5.0, 1.0, zero, 1.0]);
        assert_eq!(measured, vector![5.0, PI]);
        let ahead = measurement.of(&vector![5.0, 1.0, zero, 1.0]);
        assert_eq!(ahead, vector![5.0, 0.0]);
        assert_eq!(measurement.of(&vector![zero, 1.0, zero, 1.0]), vector![0.0, 0.0]);
    }
}

/// Components may come in any order, and a bearing alone is a measurement too.
#[test]
fn the_components_of_a_polar_measurement_come_as_they_are_named() {
    let swapped = Sensor::<f64, U4, U2>::Polar {
        components: vec![PolarComponent::Bearing, PolarComponent::Range],
        position: [2, 0],
        location: [1.0, 1.0],
    };
    // Seen from (1, 1) the position (x, y) = (entry 2, entry 0) = (1, 3) is two metres to the north.
    let state = vector![3.0, 7.0, 1.0, 7.0];
    assert_eq!(swapped.of(&state), vector![PI / 2.0, 2.0]);
    assert!(swapped.is_angle(0) && !swapped.is_angle(1));
}

// Motion

proptest! {
    #![proptest_config(cases(4000))]

    /// The turn's matrix differs from that of constant velocity by no more than the first term of each series that it leaves out:
    /// |sin φ/ω − T| ≤ T φ²/6, |(1 − cos φ)/ω| ≤ T φ/2, |cos φ − 1| ≤ φ²/2, |sin φ| ≤ φ, with φ = ωT. (Each is a theorem for
    /// every φ.) An entry is computed in five roundings or fewer and is at most max(T, 1).
    ///
    /// The slowest turn here is 10⁻³⁰⁰ rad/s: below 10⁻³⁰⁸ φ itself has no more digits.
    #[test]
    fn a_slow_turn_tends_to_constant_velocity(exponent in -300.0..0.0_f64, interval in 0.01..100.0_f64, right: bool) {
        let turn_rate = 10.0_f64.powf(exponent) * if right { -1.0 } else { 1.0 };
        let turn = coordinated_turn(&turn_rate, &interval);
        let straight = constant_velocity(&interval);
        let angle = (turn_rate * interval).abs();
        let rounding = 8.0 * ROUNDOFF * interval.max(1.0);
        let along = interval * angle * angle / 6.0;
        let across = interval * angle / 2.0;
        let cosine = angle * angle / 2.0;
        let bounds = SMatrix::<f64, 4, 4>::from_row_slice(&[
            0.0, along, 0.0, across,
            0.0, cosine, 0.0, angle,
            0.0, across, 0.0, along,
            0.0, angle, 0.0, cosine,
        ]);
        for (entry, (limit, bound)) in turn.iter().zip(straight.iter().zip(&bounds)) {
            prop_assert!((entry - limit).abs() <= bound + rounding, "{} {} {}", entry, limit, bound);
        }
        // And it does tend there, no faster than it may: a turn is not a straight line. sin φ ≥ 2φ/π up to a quarter turn.
        if angle < PI / 2.0 {
            prop_assert!(turn[(3, 1)].abs() >= 2.0 / PI * angle * (1.0 - 8.0 * ROUNDOFF));
            prop_assert_eq!(turn[(3, 1)] > 0.0, turn_rate > 0.0);
        }
    }

    /// To turn for a time and then for another is to turn for both.
    ///
    /// Every entry of the product is a sum of at most three products of entries that are off by 4u or less of their bound: 1 for
    /// sines and cosines, min(T, 2/ω) ≤ T for the others. And φ₁ + φ₂ is rounded where φ is: 2u φ in the sines and
    /// cosines.
    #[test]
    fn turns_compose_over_time(turn_rate in -1.0..1.0_f64, first in 0.01..10.0_f64, second in 0.01..10.0_f64) {
        prop_assume!(turn_rate.abs() > 1e-300);
        let both = coordinated_turn(&turn_rate, &(first + second));
        let one_by_one = coordinated_turn(&turn_rate, &second) * coordinated_turn(&turn_rate, &first);
        let time = first + second;
        let allowed = 32.0 * ROUNDOFF * (1.0 + time) * (1.0 + turn_rate.abs() * time);
        for (a, b) in both.iter().zip(&one_by_one) {
            prop_assert!((a - b).abs() <= allowed, "{} {}", a, b);
        }
    }

    /// A turn goes around a circle: its centre, a quarter turn to the left of the velocity and v/ω away, stays where it is. A coordinate
    /// of the centre is a sum of numbers that are off by 4u of |x|, v/ω and vT each.
    #[test]
    fn a_turn_goes_around_a_circle(
        turn_rate in 1e-3..1.0_f64, right: bool, interval in 0.01..10.0_f64,
        state in [-1e5..1e5_f64, -300.0..300.0, -1e5..1e5, -300.0..300.0],
    ) {
        let turn_rate = if right { -turn_rate } else { turn_rate };
        let before = SVector::from(state);
        let after = coordinated_turn(&turn_rate, &interval) * before;
        let centre = |state: &SVector<f64, 4>| vector![state[0] - state[3] / turn_rate, state[2] + state[1] / turn_rate];
        let size = before.abs().max() + 600.0 * (1.0 / turn_rate.abs() + interval);
        prop_assert!((centre(&after) - centre(&before)).abs().max() <= 16.0 * ROUNDOFF * size);
        // To the left it goes counter-clockwise: the velocity turns by ωT, here less than half a turn or not looked at.
        let area = before[1] * after[3] - before[3] * after[1];
        if (turn_rate * interval).abs() < 3.0 && before[1].abs() > 1.0 {
            prop_assert_eq!(area > 0.0, turn_rate > 0.0);
        }
    }

    /// A turn keeps the speed: its velocity block is a rotation. Two squares of numbers that are off by 2u, and the sums.
    #[test]
    fn a_turn_keeps_the_speed(
        turn_rate in -1.0..1.0_f64, interval in 0.01..10.0_f64, vx in -300.0..300.0_f64, vy in -300.0..300.0_f64,
    ) {
        let after = coordinated_turn(&turn_rate, &interval) * vector![0.0, vx, 0.0, vy];
        let (before, after) = (vx.hypot(vy), after[1].hypot(after[3]));
        prop_assert!((before - after).abs() <= 16.0 * ROUNDOFF * before);
    }
}

// Matrices

/// Integers below the diagonal of a unit triangle, and a diagonal of small integers: the factors of an integer matrix.
fn integer_factors(pivots: std::ops::RangeInclusive<i32>) -> impl Strategy<Value = (SMatrix<f64, 4, 4>, [i32; 4])> {
    let below = prop::collection::vec(-5..=5_i32, 6);
    (below, [pivots.clone(), pivots.clone(), pivots.clone(), pivots]).prop_map(|(below, diagonal)| {
        let mut lower = SMatrix::<f64, 4, 4>::identity();
        let mut below = below.into_iter();
        for i in 0..4 {
            for j in 0..i {
                lower[(i, j)] = f64::from(below.next().unwrap_or(0));
            }
        }
        (lower, diagonal)
    })
}

/// L D Lᵀ, exactly: all numbers are integers far below 2⁵³.
fn product(lower: &SMatrix<f64, 4, 4>, diagonal: [i32; 4]) -> SMatrix<f64, 4, 4> {
    lower * SMatrix::from_diagonal(&SVector::from(diagonal.map(f64::from))) * lower.transpose()
}

/// The determinant by Laplace's expansion along the first column, in exact arithmetic.
fn determinant(matrix: &[Vec<Rational>]) -> Rational {
    if matrix.is_empty() {
        return Rational::integer(1);
    }
    let mut sum = Rational::zero();
    for (i, row) in matrix.iter().enumerate() {
        let mut minor = matrix.to_vec();
        minor.remove(i);
        for row in &mut minor {
            row.remove(0);
        }
        let sign = if i % 2 == 0 { 1 } else { -1 };
        sum += row[0].clone() * determinant(&minor) * Rational::integer(sign);
    }
    sum
}

/// Random 3 × 3 covariances S Sᵀ of a triangular root with a diagonal away from zero.
fn roots_of_covariances() -> impl Strategy<Value = SMatrix<f64, 3, 3>> {
    let diagonal = [0.25..4.0_f64, 0.25..4.0_f64, 0.25..4.0_f64];
    let below = [-2.0..2.0_f64, -2.0..2.0_f64, -2.0..2.0_f64];
    let scales = [-3..=3_i32, -3..=3_i32, -3..=3_i32];
    (diagonal, below, scales).prop_map(|(d, b, scales)| {
        let root = SMatrix::<f64, 3, 3>::new(d[0], 0.0, 0.0, b[0], d[1], 0.0, b[1], b[2], d[2]);
        // Units may differ by many orders of magnitude.
        SMatrix::from_diagonal(&Vector3::from(scales.map(|scale| 10.0_f64.powi(scale)))) * root
    })
}

proptest! {
    #![proptest_config(cases(1000))]

    /// Against the determinant by Laplace's expansion, which shares nothing with a factorisation.
    ///
    /// On integer matrices with integer factors the factorisation is exact, so what is rounded is the logarithms: one rounding of each,
    /// three of the sums, and one of the logarithm of the whole, each at most 2u of its size, and ln D ≤ ln 9.
    #[test]
    fn the_log_determinant_is_the_logarithm_of_the_determinant((lower, diagonal) in integer_factors(1..=9)) {
        let matrix = product(&lower, diagonal);
        let rows: Vec<Vec<Rational>> = matrix
            .row_iter()
            .map(|row| row.iter().map(|entry| Rational::from_f64(*entry)).collect())
            .collect();
        let exact = determinant(&rows);
        prop_assert_eq!(&exact, &Rational::integer(diagonal.map(i64::from).iter().product()));
        let sum = log_determinant(&ldl(&matrix));
        prop_assert!((sum - exact.to_f64().ln()).abs() <= 16.0 * ROUNDOFF * 4.0 * 9.0_f64.ln());
    }

    /// The first pivot that is not positive is named, and every pivot before it is right; a row of zeros is no pivot.
    #[test]
    fn the_cholesky_factor_exists_exactly_when_all_pivots_are_positive((lower, diagonal) in integer_factors(-2..=9)) {
        // Squares on the diagonal of D make the factor's diagonal integers: nothing is rounded.
        let squares = diagonal.map(|pivot| pivot * pivot.abs());
        let matrix = product(&lower, squares);
        let has_no_root = |&j: &usize| squares[j] < 0 || (squares[j] == 0 && matrix.row(j).iter().any(|entry| *entry != 0.0));
        match (cholesky(&matrix), (0..4).find(has_no_root)) {
            (Ok(root), None) => {
                for j in 0..4 {
                    prop_assert_eq!(root[(j, j)].to_bits(), f64::from(diagonal[j]).to_bits());
                    prop_assert!((j + 1..4).all(|i| root[(j, i)] == 0.0));
                }
                prop_assert_eq!(root * root.transpose(), matrix);
            }
            (Err(error), Some(pivot)) => prop_assert_eq!((error.pivot, error.decided), (pivot, true)),
            (result, expected) => prop_assert!(false, "{:?} {:?}", result, expected),
        }
    }

    /// L D Lᵀ is positive semidefinite exactly when no entry of D is negative. Nothing is rounded, since all numbers are integers.
    #[test]
    fn a_matrix_is_positive_semidefinite_exactly_when_no_pivot_is_negative((lower, diagonal) in integer_factors(-1..=4)) {
        let matrix = product(&lower, diagonal);
        let has_negative = diagonal.iter().any(|&pivot| pivot < 0);
        prop_assert_eq!(is_positive_semidefinite(&matrix), !has_negative);
    }

    /// A noise that enters through fewer inputs than the state has entries is positive semidefinite as it is rounded, too.
    #[test]
    fn a_covariance_of_low_rank_is_positive_semidefinite_as_rounded(
        input in prop::collection::vec(-10.0..10.0_f64, 8), scales in [-3..=3_i32, -3..=3_i32, -3..=3_i32, -3..=3_i32],
    ) {
        let scales = SVector::from(scales.map(|scale| 10.0_f64.powi(scale)));
        let input = SMatrix::from_diagonal(&scales) * SMatrix::<f64, 4, 2>::from_vec(input);
        let covariance = input * input.transpose();
        prop_assert!(is_positive_semidefinite(&covariance));
    }

    /// A covariance of rank one has full correlations; a millionth part of one variance less, and it is a covariance no longer.
    #[test]
    fn a_variance_too_small_for_its_covariances_is_no_variance(
        input in [0.1..10.0_f64, 0.1..10.0, 0.1..10.0, 0.1..10.0], signs: [bool; 4], i in 0..4_usize,
    ) {
        let input = SVector::<f64, 4>::from_fn(|row, _| if signs[row] { input[row] } else { -input[row] });
        let mut covariance = input * input.transpose();
        prop_assert!(is_positive_semidefinite(&covariance));
        covariance[(i, i)] *= 1.0 - 1e-6;
        prop_assert!(!is_positive_semidefinite(&covariance));
    }

    /// The factor's product is the matrix up to (n + 2)u of √(PᵢᵢPⱼⱼ) for the factor (Higham, Accuracy and Stability of Numerical
    /// Algorithms, theorem 10.3) and as much again for the product here.
    #[test]
    fn the_cholesky_factor_times_its_transpose_is_the_matrix_but_for_rounding(root in roots_of_covariances()) {
        let covariance = root * root.transpose();
        let factor = cholesky(&covariance).unwrap();
        let back = factor * factor.transpose();
        for i in 0..3 {
            prop_assert!(factor[(i, i)] > 0.0);
            for j in 0..3 {
                let size = (covariance[(i, i)] * covariance[(j, j)]).sqrt();
                prop_assert!((back[(i, j)] - covariance[(i, j)]).abs() <= 10.0 * ROUNDOFF * size);
            }
        }
    }
}

// Gaussians

/// The integral of the density over all residuals, by the trapezoid rule on a lattice of half a standard deviation out to nine. The
/// covariance's root moves the lattice to where the density lives; its cell has the volume h^M · S₁₁ ⋯ S_MM, without any
/// determinant.
///
/// On a Gaussian of unit covariance the rule is off by 2M·exp(−2π²/h²) = 2M·e⁻⁷⁹ of the integral (Poisson's summation formula), and
/// what lies beyond nine deviations is 2M·10⁻¹⁹ of it: nothing against rounding.
fn integral_of_density<const M: usize>(root: &SMatrix<f64, M, M>) -> f64 {
    let covariance = ldl(&(root * root.transpose()));
    let side = 37_usize;
    let mut sum = 0.0;
    for index in 0..side.pow(u32::try_from(M).unwrap()) {
        let mut digits = index;
        let node = SVector::<f64, M>::from_fn(|_, _| {
            let coordinate = (digits % side) as f64 * 0.5 - 9.0;
            digits /= side;
            coordinate
        });
        sum += Real::exp(&log_density(&(root * node), &covariance));
    }
    sum * (0..M).map(|i| 0.5 * root[(i, i)]).product::<f64>()
}

proptest! {
    #![proptest_config(cases(200))]

    /// In one, two and three dimensions. The tolerance is rounding. The roots here have condition numbers below 10⁴, so the quadratic
    /// form at q = O(M) standard deviations squared is off by 10⁴ · 10u, and so is the logarithm; that is the relative error of
    /// the density, and of the integral: 10⁵ u = 10⁻¹¹. A wrong constant is off by 2 or more.
    #[test]
    fn the_density_integrates_to_one(root in roots_of_covariances()) {
        let allowed = 1e5 * ROUNDOFF;
        let of_one = SMatrix::<f64, 1, 1>::new(root[(0, 0)]);
        let of_two = root.fixed_view::<2, 2>(0, 0).into_owned();
        prop_assert!((integral_of_density(&of_one) - 1.0).abs() <= allowed);
        prop_assert!((integral_of_density(&of_two) - 1.0).abs() <= allowed);
        prop_assert!((integral_of_density(&root) - 1.0).abs() <= allowed);
    }
}

/// Weights that sum to one up to rounding, and estimates of different means and covariances.
fn mixtures() -> impl Strategy<Value = (Vec<f64>, Vec<Gaussian<f64, U3>>)> {
    let component = (
        [-100.0..100.0_f64, -100.0..100.0, -100.0..100.0],
        roots_of_covariances(),
    );
    let component = component.prop_map(|(mean, root)| Gaussian {
        mean: Vector3::from(mean),
        covariance: root * root.transpose(),
    });
    prop::collection::vec((0.0..1.0_f64, component), 1..5).prop_map(|parts| {
        let (weights, components): (Vec<f64>, Vec<_>) = parts.into_iter().unzip();
        let sum: f64 = weights.iter().sum::<f64>().max(1e-300);
        (weights.iter().map(|weight| weight / sum).collect(), components)
    })
}

proptest! {
    #![proptest_config(cases(2000))]

    /// Symmetric to the last bit, since every term is. And the spread of the means is never negative: in any direction v the mixture's
    /// variance is at least the mean of the components' variances, up to the rounding of the sums (under 64 roundings of numbers
    /// that are at most Σ w (vᵀPv + (v·(x̂ⁱ − x̂))²), with |v·P·v| bounded by its terms' absolute values).
    #[test]
    fn the_covariance_of_a_mixture_is_symmetric_and_not_less_than_the_mean_covariance(
        (weights, components) in mixtures(), direction in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
    ) {
        let mean = mixture_mean(&weights, &components);
        let covariance = mixture_covariance(&weights, &components, &mean);
        prop_assert!(is_symmetric(&covariance));
        let v = Vector3::from(direction);
        let mut within = 0.0;
        let mut size = 0.0;
        for (weight, component) in weights.iter().zip(&components) {
            within += weight * (v.transpose() * component.covariance * v)[0];
            let deviation = (component.mean - mean).abs();
            let terms = component.covariance.abs() + deviation * deviation.transpose();
            size += weight * (v.abs().transpose() * terms * v.abs())[0];
        }
        let of_mixture = (v.transpose() * covariance * v)[0];
        prop_assert!(of_mixture >= within - 64.0 * ROUNDOFF * size);
        // The spread about any other point is larger: the mean is the right one.
        let elsewhere = mixture_covariance(&weights, &components, &(mean + v));
        let trace = |matrix: &SMatrix<f64, 3, 3>| matrix.trace();
        prop_assert!(trace(&elsewhere) >= trace(&covariance) - 64.0 * ROUNDOFF * trace(&elsewhere));
    }
}

// Expectations of polynomials

/// A product of affine forms aᵀx + b, with small integers.
type Forms<const N: usize> = Vec<(SVector<i32, N>, i32)>;

/// The expectation of a product of affine forms of a Gaussian, exactly, from means m and covariances c of the forms:
/// E l₁ l₂ ⋯ = m₁ E(l₂ ⋯) + Σₖ c₁ₖ E(the rest without lₖ). It is Stein's lemma, and uses no points.
fn expectation(means: &[Rational], covariances: &[Vec<Rational>], forms: &[usize]) -> Rational {
    let Some((&first, rest)) = forms.split_first() else {
        return Rational::integer(1);
    };
    let mut sum = means[first].clone() * expectation(means, covariances, rest);
    for (k, &other) in rest.iter().enumerate() {
        let mut without = rest.to_vec();
        without.remove(k);
        sum += covariances[first][other].clone() * expectation(means, covariances, &without);
    }
    sum
}

/// The expectation of the product of the forms under a Gaussian of this mean and square root.
fn exact_expectation<const N: usize>(forms: &Forms<N>, mean: &SVector<i32, N>, root: &SMatrix<i32, N, N>) -> Rational {
    let integer = |value: i32| Rational::integer(i64::from(value));
    let means: Vec<_> = forms.iter().map(|(a, b)| integer(a.dot(mean) + b)).collect();
    let covariance =
        |a: &SVector<i32, N>, b: &SVector<i32, N>| integer((root.transpose() * a).dot(&(root.transpose() * b)));
    let covariances: Vec<Vec<_>> = forms
        .iter()
        .map(|(a, _)| forms.iter().map(|(b, _)| covariance(a, b)).collect())
        .collect();
    expectation(&means, &covariances, &(0..forms.len()).collect::<Vec<_>>())
}

/// The rule's expectation of the product of the forms, with the points that a filter draws.
fn rule_expectation<T: Roots, const N: usize>(
    rule: &Rule<T, Const<N>>,
    forms: &Forms<N>,
    mean: &SVector<i32, N>,
    root: &SMatrix<i32, N, N>,
) -> T {
    let number = |value: i32| T::integer(i64::from(value));
    let values: Vec<_> = rule
        .points
        .iter()
        .map(|xi| {
            let x = point(&root.map(number), xi, &mean.map(number));
            let value = forms.iter().fold(T::one(), |product, (a, b)| {
                product * (scalar_product(&a.map(number), &x) + number(*b))
            });
            SVector::<T, 1>::new(value)
        })
        .collect();
    weighted_mean(&rule.weights, &values)[0].clone()
}

/// The scalar product, for numbers that are not floats.
fn scalar_product<T: Field, const N: usize>(a: &SVector<T, N>, b: &SVector<T, N>) -> T {
    let products = a.iter().zip(b);
    products.fold(T::zero(), |sum, (a, b)| sum + a.clone() * b.clone())
}

/// Random forms, means and roots in N dimensions.
fn gaussian_and_forms<const N: usize>(
    degree: std::ops::RangeInclusive<usize>,
) -> impl Strategy<Value = (Forms<N>, SVector<i32, N>, SMatrix<i32, N, N>)> {
    let entries = move |range: std::ops::RangeInclusive<i32>, count: usize| prop::collection::vec(range, count);
    let form = (entries(-3..=3, N), -3..=3_i32).prop_map(|(a, b)| (SVector::from_vec(a), b));
    let root = (entries(-3..=3, N * N), entries(1..=4, N)).prop_map(|(below, diagonal)| {
        SMatrix::from_fn(|i, j| match i.cmp(&j) {
            std::cmp::Ordering::Less => 0,
            std::cmp::Ordering::Equal => diagonal[i],
            std::cmp::Ordering::Greater => below[i * N + j],
        })
    });
    let forms = prop::collection::vec(form, degree);
    (forms, entries(-5..=5, N).prop_map(SVector::from_vec), root)
}

/// The rules that are right, with their degrees.
const DEGREES: [(&str, usize); 4] = [("cubature-3", 3), ("unscented", 3), ("cubature-5", 5), ("simplex-5", 5)];

/// No tolerance: the points are surds, and the expectation is a rational.
fn check_exact_expectation<const N: usize>(
    forms: &Forms<N>,
    mean: &SVector<i32, N>,
    root: &SMatrix<i32, N, N>,
) -> Result<(), TestCaseError> {
    let expected = Surd::rational(&exact_expectation(forms, mean, root));
    for (name, degree) in DEGREES {
        let rule = rule_of_surds::<N>(name);
        if forms.len() <= degree {
            prop_assert_eq!(&rule_expectation(&rule, forms, mean, root), &expected, "{}", name);
        }
    }
    Ok(())
}

/// The rule of a name, in surds.
fn rule_of_surds<const N: usize>(name: &str) -> Rule<Surd, Const<N>> {
    let exact = name.parse::<RuleName>().unwrap().exact(N).unwrap();
    Rule::from_exact(&exact).unwrap()
}

/// In doubles the answer is right up to rounding: each value is a product of `degree` forms, and each form a sum of N products of a
/// coordinate that is itself a sum of N products: fewer than 4N + 4 roundings a form. A point adds N more, and the weighted sum
/// one for each of the L points and one of the weight: (degree · (4N + 4) + L + 2) u of Σ |w| Π (Σ |a| |x|₊ + |b|), where |x|₊ is
/// Σ |S| |ξ| + |x̂|.
fn check_expectation_in_doubles<const N: usize>(
    rules: &[(&str, usize, Rule<f64, Const<N>>)],
    (forms, mean, root): &(Forms<N>, SVector<i32, N>, SMatrix<i32, N, N>),
) -> Result<(), TestCaseError> {
    let expected = exact_expectation(forms, mean, root).to_f64();
    for (name, degree, rule) in rules {
        if forms.len() > *degree {
            continue;
        }
        let value = rule_expectation(rule, forms, mean, root);
        let size: f64 = rule
            .points
            .iter()
            .zip(&rule.weights)
            .map(|(xi, weight)| {
                let x = root.map(f64::from).abs() * xi.abs() + mean.map(f64::from).abs();
                let product: f64 = forms
                    .iter()
                    .map(|(a, b)| a.map(f64::from).abs().dot(&x) + f64::from(b.abs()))
                    .product();
                weight.abs() * product
            })
            .sum();
        let roundings = forms.len() * (4 * N + 4) + rule.points.len() + 2;
        let allowed = roundings as f64 * ROUNDOFF * size;
        prop_assert!(
            (value - expected).abs() <= allowed,
            "{}: {} for {}",
            name,
            value,
            expected
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(50))]

    #[test]
    fn rules_give_the_exact_expectation_of_polynomials_of_their_degree_in_two_dimensions(
        (forms, mean, root) in gaussian_and_forms::<2>(0..=5),
    ) {
        check_exact_expectation(&forms, &mean, &root)?;
    }

    #[test]
    fn rules_give_the_exact_expectation_of_polynomials_of_their_degree_in_three_dimensions(
        (forms, mean, root) in gaussian_and_forms::<3>(0..=5),
    ) {
        check_exact_expectation(&forms, &mean, &root)?;
    }

    #[test]
    fn rules_give_the_exact_expectation_of_polynomials_of_their_degree_in_four_dimensions(
        (forms, mean, root) in gaussian_and_forms::<4>(0..=5),
    ) {
        check_exact_expectation(&forms, &mean, &root)?;
    }
}

/// The rules in doubles, with their degrees; the product rule too, where its 5ⁿ points are not too many to be quick.
fn rules_in_doubles<const N: usize>() -> Vec<(&'static str, usize, Rule<f64, Const<N>>)> {
    DEGREES
        .into_iter()
        .chain([("gauss-hermite-5", 9)])
        .filter(|(name, _)| *name != "gauss-hermite-5" || N <= 3)
        .map(|(name, degree)| (name, degree, name.parse::<RuleName>().unwrap().rule().unwrap()))
        .collect()
}

/// A number of random Gaussians and forms in N dimensions, through the rules in doubles.
fn check_rules_in_doubles<const N: usize>(count: u32) {
    let rules = rules_in_doubles::<N>();
    proptest!(cases(count), |(drawn in gaussian_and_forms::<N>(0..=5))| {
        check_expectation_in_doubles(&rules, &drawn)?;
    });
}

#[test]
fn rules_in_doubles_give_the_expectation_of_polynomials_of_their_degree_up_to_rounding() {
    check_rules_in_doubles::<2>(500);
    check_rules_in_doubles::<3>(500);
    check_rules_in_doubles::<4>(500);
    check_rules_in_doubles::<5>(300);
    check_rules_in_doubles::<6>(300);
}

/// One degree more is too much for each rule: the sixth (fourth) power of one coordinate of the standard Gaussian.
#[test]
fn rules_are_wrong_one_degree_above_their_own() {
    for (name, degree) in DEGREES {
        let rule = rule_of_surds::<4>(name);
        // The unscented rule with κ = 3 − n has the fourth power of a coordinate right, and x₁² x₂² wrong.
        let first = vector![1, 0, 0, 0];
        let second = if name == "unscented" {
            vector![0, 1, 0, 0]
        } else {
            first
        };
        let mut forms = vec![(first, 0); degree - 1];
        forms.extend([(second, 0), (second, 0)]);
        let mean = SVector::zeros();
        let root = SMatrix::identity();
        let value = rule_expectation(&rule, &forms, &mean, &root);
        let expected = exact_expectation(&forms, &mean, &root);
        assert_ne!(value, Surd::rational(&expected), "{name}");
    }
}

// Helpers

/// Range and bearing of [x, ẋ, y, ẏ].
fn range_bearing(location: [f64; 2]) -> Sensor<f64, U4, U2> {
    Sensor::Polar {
        components: vec![PolarComponent::Range, PolarComponent::Bearing],
        position: [0, 2],
        location,
    }
}

#[test]
fn the_unscented_rule_of_doubles_is_the_exact_one_rounded() {
    // Parameters that are dyadic: the exact rule has the same ones. One operation after the other is rounded, so a few units in the last
    // place of the greatest number in each sum are allowed.
    for (alpha, beta, kappa) in [
        ((1, 1), (0, 1), (-1, 1)),
        ((1, 2), (2, 1), (0, 1)),
        ((3, 4), (1, 2), (5, 2)),
    ] {
        let exact_number = |(p, q): (i64, i64)| Rational::new(p, q);
        let parameters = Parameters {
            alpha: exact_number(alpha),
            beta: exact_number(beta),
            kappa: exact_number(kappa),
        };
        let exact = Rule::<f64, U4>::from_exact(&unscented(4, &parameters).unwrap()).unwrap();
        let double = |(p, q): (i64, i64)| f64::ratio(p, q);
        let rounded = unscented_in(U4, &double(alpha), &double(beta), &double(kappa)).unwrap();
        assert_eq!(exact.points.len(), rounded.points.len());
        let near = |a: f64, b: f64| (a - b).abs() <= 8.0 * f64::EPSILON * a.abs().max(1.0);
        for (exact, rounded) in exact.points.iter().zip(&rounded.points) {
            assert!(
                exact.iter().zip(rounded).all(|(&a, &b)| near(a, b)),
                "{exact} {rounded}"
            );
        }
        let weights = exact.weights.iter().zip(&rounded.weights);
        let covariance_weights = exact.covariance_weights.iter().zip(&rounded.covariance_weights);
        assert!(
            weights.chain(covariance_weights).all(|(&a, &b)| near(a, b)),
            "{alpha:?}"
        );
    }
}

// The percentage fit error

/// Errors and truth of two coordinates over a handful of steps; no true coordinate is near zero.
fn tracked() -> impl Strategy<Value = ([Vec<f64>; 2], [Vec<f64>; 2])> {
    let step = (-50.0..50.0_f64, -50.0..50.0_f64, 100.0..2000.0_f64, -2000.0..-100.0_f64);
    prop::collection::vec(step, 1..12).prop_map(|steps| {
        let column = |of: fn(&(f64, f64, f64, f64)) -> f64| steps.iter().map(of).collect::<Vec<f64>>();
        (
            [column(|step| step.0), column(|step| step.1)],
            [column(|step| step.2), column(|step| step.3)],
        )
    })
}

fn fit(form: FitForm, errors: &[Vec<f64>; 2], truth: &[Vec<f64>; 2]) -> f64 {
    position_fit_error(form, [&errors[0], &errors[1]], [&truth[0], &truth[1]])
}

/// What rounding may do to a fit error: sums of at most 24 positive terms, two roots and a quotient, each a few roundings.
const FIT_ROUNDING: f64 = 64.0 * ROUNDOFF;

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn the_fit_error_is_zero_for_perfect_tracking_and_a_hundred_for_none((errors, truth) in tracked()) {
        let perfect = errors.clone().map(|axis| vec![0.0; axis.len()]);
        let nothing = truth.clone().map(|axis| axis.iter().map(|x| -x).collect());
        for form in FitForm::ALL {
            prop_assert_eq!(fit(form, &perfect, &truth).to_bits(), 0.0_f64.to_bits());
            // The estimate 0: each coordinate has 100 %, and the forms show how they count to two.
            let expected = match form {
                FitForm::RootSumSquare => 100.0 * 2.0_f64.sqrt(),
                FitForm::Sum => 200.0,
                FitForm::JointNorm | FitForm::RootMeanSquare | FitForm::Mean => 100.0,
            };
            prop_assert!((fit(form, &nothing, &truth) / expected - 1.0).abs() <= FIT_ROUNDING);
            prop_assert!(fit(form, &errors, &truth) > 0.0);
        }
    }

    #[test]
    fn the_fit_error_has_no_unit_and_depends_on_where_the_radar_stands(
        (errors, truth) in tracked(),
        exponent in -20..20_i32,
        factor in 0.001..1000.0_f64,
    ) {
        let scaled = |values: &[Vec<f64>; 2], factor: f64| {
            values.clone().map(|axis| axis.iter().map(|x| factor * x).collect::<Vec<f64>>())
        };
        let unit = 2.0_f64.powi(exponent);
        // Twice as far from the radar along the same line: half the fit error of the same errors.
        let further = scaled(&truth, 2.0);
        // Next to the radar's own place the truth is next to nothing, and the same errors are large.
        let nearer = truth.clone().map(|axis| axis.iter().map(|x| x / 1024.0).collect());
        for form in FitForm::ALL {
            let error = fit(form, &errors, &truth);
            // Powers of two do not round, other units do.
            let same = fit(form, &scaled(&errors, unit), &scaled(&truth, unit));
            prop_assert_eq!(same.to_bits(), error.to_bits());
            let other = fit(form, &scaled(&errors, factor), &scaled(&truth, factor));
            prop_assert!((other / error - 1.0).abs() <= 2.0 * FIT_ROUNDING);
            prop_assert_eq!((2.0 * fit(form, &errors, &further)).to_bits(), error.to_bits());
            prop_assert_eq!(fit(form, &errors, &nearer).to_bits(), (1024.0 * error).to_bits());
        }
        // A radar that stands 1 km to the right: the errors are the same, the measure is not.
        let moved = [truth[0].iter().map(|x| x + 1000.0).collect(), truth[1].clone()];
        prop_assert!(fit(FitForm::RootSumSquare, &errors, &moved) < fit(FitForm::RootSumSquare, &errors, &truth));
    }

    #[test]
    fn the_forms_of_the_fit_error_are_ordered((errors, truth) in tracked()) {
        let axes = [0, 1].map(|axis| percentage_fit_error(&errors[axis], &truth[axis]));
        let [rss, joint, rms, mean, sum] = FitForm::ALL.map(|form| fit(form, &errors, &truth));
        let at_most = |a: f64, b: f64| a <= b * (1.0 + FIT_ROUNDING);
        let equal = |a: f64, b: f64| at_most(a, b) && at_most(b, a);
        // Two pairs are the same but for a factor.
        prop_assert!(equal(rss, 2.0_f64.sqrt() * rms));
        prop_assert!(equal(sum, 2.0 * mean));
        // The joint norm is between the coordinates, and so are the two means, of which the root mean square is the greater.
        let (least, greatest) = (axes[0].min(axes[1]), axes[0].max(axes[1]));
        prop_assert!(at_most(least, joint) && at_most(joint, greatest));
        prop_assert!(at_most(least, mean) && at_most(mean, rms) && at_most(rms, greatest));
        // The root of the sum of squares is between the worse coordinate and the sum.
        prop_assert!(at_most(greatest, rss) && at_most(rss, sum) && at_most(sum, 2.0_f64.sqrt() * rss));
        // With one coordinate left out they differ.
        let one = [errors[0].clone(), vec![0.0; errors[1].len()]];
        let [rss, joint, rms, mean, sum] = FitForm::ALL.map(|form| fit(form, &one, &truth));
        prop_assert!(equal(rss, axes[0]) && equal(sum, axes[0]) && equal(2.0 * mean, axes[0]) && rms > mean);
        prop_assert!(joint < axes[0]);
    }
}
