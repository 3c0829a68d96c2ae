//! Goal: what an enclosure says is true: the exact result is inside, whatever the operands and the precision.
//!
//! Method: exact rational arithmetic. Results of + − × ÷ √ are compared with exact ones. The elementary functions are bracketed by their
//! series with remainder, summed in rational numbers: that bracket is a proof, it is far narrower than the enclosure, and must be inside
//! it. The precision is low (24 to 60 bits), where a missing error bound shows often. Then identities, known digits, and another
//! library's doubles. Kind of evidence: enclosed; the inputs are drawn from a named generator with a seed.

// Doubles are compared exactly: that they are equal to the last bit is what these laws say.
#![allow(clippy::float_cmp)]

use immaculate::model::motion::{constant_velocity, coordinated_turn, integrated_noise, turn_noise};
use immaculate::number::{Dual, Enclosure, Field, Rational, Real, Roots, Surd};
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Zero};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::cmp::Ordering;

// The series with their remainders, in exact arithmetic

/// Two rationals with the true value between them.
#[derive(Clone, Debug)]
struct Bracket(Rational, Rational);

impl Bracket {
    fn around(middle: Rational, error: &Rational) -> Self {
        let error = error.abs();
        Self(&middle - &error, middle + error)
    }

    fn plus(&self, other: &Self) -> Self {
        Self(&self.0 + &other.0, &self.1 + &other.1)
    }

    fn times(&self, factor: &Rational) -> Self {
        let (a, b) = (&self.0 * factor, &self.1 * factor);
        if a <= b { Self(a, b) } else { Self(b, a) }
    }

    fn is_inside(&self, enclosure: &Enclosure) -> bool {
        enclosure.contains(&self.0) && enclosure.contains(&self.1)
    }
}

/// The fraction P/Q to 200 bits after the point, with the error of a series.
fn cut(p: &BigInt, q: &BigInt, error: Rational) -> Bracket {
    let unit = Rational::one() / Rational::integer(2).pow(200);
    let quotient = Rational::from_integer((p << 200_u8).div_floor(q));
    Bracket::around(quotient * &unit, &(error + unit))
}

/// 2^−k.
fn small(k: u32) -> Rational {
    Rational::one() / Rational::integer(2).pow(k)
}

/// Numerator and denominator.
fn parts(x: &Rational) -> (BigInt, BigInt) {
    let value = x.value().expect("a number");
    (value.numer().clone(), value.denom().clone())
}

/// The sum Σ cₙ, 0 ≤ n < N, of terms with the ratio x/dₙ between the one before and the term n, as P/Q by Horner's rule in integers.
fn nested(x: &Rational, terms: i64, divisor: impl Fn(i64) -> i64) -> (BigInt, BigInt) {
    let (a, b) = parts(x);
    let (mut p, mut q) = (BigInt::one(), BigInt::one());
    for n in (1..terms).rev() {
        q *= &b * divisor(n);
        p = &q + &a * p;
        // 1 + (x/d)(P/Q) = (Q b d + a P)/(Q b d).
    }
    (p, q)
}

/// eˣ = Σ xⁿ/n! for |x| ≤ 4: what follows 50 terms is below 2 · 4⁵⁰/50! < 2⁻¹¹².
fn exact_exp(x: &Rational) -> Bracket {
    assert!(x.abs() <= Rational::integer(4));
    let (p, q) = nested(x, 50, |n| n);
    cut(&p, &q, small(112))
}

/// sin x (q = 1) or cos x (q = 0) for |x| ≤ 4: Σ (−1)ⁿ x²ⁿ⁺q/(2n+q)!, alternating and falling: what follows 25 terms is below
/// 4⁵¹/50! < 2⁻¹¹².
fn exact_circular(x: &Rational, odd: i64) -> Bracket {
    assert!(x.abs() <= Rational::integer(4));
    let (mut p, mut q) = nested(&-(x * x), 25, |n| (2 * n + odd) * (2 * n + odd - 1));
    if odd == 1 {
        let (a, b) = parts(x);
        p *= a;
        q *= b;
    }
    cut(&p, &q, small(112))
}

/// Σ (±1)ⁿ u²ⁿ⁺¹/(2n+1), 0 ≤ n < N, by Horner's rule: 1/(2n+1) ± u² (P/Q).
fn odd_series(u: &Rational, sign: i32, terms: i64, error: Rational) -> Bracket {
    let (a, b) = parts(u);
    let (a_square, b_square) = (&a * &a * sign, &b * &b);
    let (mut p, mut q) = (BigInt::zero(), BigInt::one());
    for n in (0..terms).rev() {
        p = &q * &b_square + &a_square * p * (2 * n + 1);
        q = q * &b_square * (2 * n + 1);
    }
    cut(&(p * a), &(q * b), error)
}

/// artanh u for |u| ≤ 1/3: what follows 36 terms is below 3⁻⁷³/73 · 9/8 < 2⁻¹²¹.
fn exact_artanh(u: &Rational) -> Bracket {
    assert!(u.abs() <= Rational::new(1, 3));
    odd_series(u, 1, 36, small(121))
}

/// ln x = k ln 2 + 2 artanh((f − 1)/(f + 1)) with f = x/2ᵏ between 1/2 and 2.
fn exact_ln(x: &Rational) -> Bracket {
    let (mut f, mut k) = (x.clone(), 0);
    let (one, two) = (Rational::one(), Rational::integer(2));
    while f > two {
        f /= &two;
        k += 1;
    }
    while f < Rational::new(1, 2) {
        f *= &two;
        k -= 1;
    }
    let ln_2 = exact_artanh(&Rational::new(1, 3)).times(&two);
    let rest = exact_artanh(&((&f - &one) / (&f + &one))).times(&two);
    rest.plus(&ln_2.times(&Rational::integer(k)))
}

/// arctan z for 0 ≤ z ≤ 1/2: alternating, so what follows 55 terms is below 2⁻¹¹¹/111 < 2⁻¹¹⁷.
fn exact_short_arctan(z: &Rational) -> Bracket {
    assert!(*z <= Rational::new(1, 2));
    odd_series(z, -1, 55, small(117))
}

/// arctan z for 0 ≤ z ≤ 1: arctan z = arctan(1/2) + arctan((z − 1/2)/(1 + z/2)) above 1/2.
fn exact_arctan(z: &Rational) -> Bracket {
    let half = Rational::new(1, 2);
    if *z <= half {
        return exact_short_arctan(z);
    }
    let rest = (z - &half) / (Rational::one() + z * &half);
    exact_short_arctan(&half).plus(&exact_short_arctan(&rest))
}

/// π = 4 arctan 1.
fn exact_pi() -> Bracket {
    exact_arctan(&Rational::one()).times(&Rational::integer(4))
}

/// The angle of (x, y) from the octants.
fn exact_angle(y: &Rational, x: &Rational) -> Bracket {
    let is_steep = y.abs() > x.abs();
    let ratio = if is_steep { x.abs() / y.abs() } else { y.abs() / x.abs() };
    let octant = exact_arctan(&ratio);
    let minus = Rational::integer(-1);
    let quarter = exact_pi().times(&Rational::new(1, 2));
    let is_left = *x < Rational::zero();
    let upper = match (is_steep, is_left) {
        (false, false) => octant,
        (true, false) => quarter.plus(&octant.times(&minus)),
        (true, true) => quarter.plus(&octant),
        (false, true) => quarter.times(&Rational::integer(2)).plus(&octant.times(&minus)),
    };
    if *y < Rational::zero() {
        upper.times(&minus)
    } else {
        upper
    }
}

/// Σ (−x)ʲ/(2j + k)! for |x| ≤ 441: what follows 70 terms is below 2 · 441⁷⁰/140! < 2⁻¹⁸⁰.
fn exact_stumpff(k: i64, x: &Rational) -> Bracket {
    assert!(x.abs() <= Rational::integer(441));
    let (p, q) = nested(&-x, 70, |n| (2 * n + k - 1) * (2 * n + k));
    let factorial: BigInt = (1..=k).map(BigInt::from).product();
    cut(&p, &(q * factorial), small(180))
}

// What is drawn

struct Draw(ChaCha8Rng);

impl Draw {
    fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// An integer from 0 up to, and without, `end`.
    fn below(&mut self, end: u32) -> u32 {
        self.0.next_u32() % end
    }

    /// A double with the given number of random bits and either sign, from 2^(exponent − 1) on up to 2^exponent.
    fn double(&mut self, bits: u32, exponent: i32) -> f64 {
        let mantissa = (self.0.next_u64() >> 11 | 1 << 52) >> (53 - bits) << (53 - bits);
        let sign = if self.below(2) == 0 { 1.0 } else { -1.0 };
        sign * mantissa as f64 * power_of_two(-53) * power_of_two(exponent)
    }

    /// A double of ordinary size with few or many bits, and now and then a very large, a very small or a vanishing one.
    fn any_double(&mut self) -> f64 {
        let bits = [3, 20, 53][self.below(3) as usize];
        match self.below(40) {
            0..3 => 0.0,
            3 => self.double(bits, 1000),
            4 => self.double(bits, -1000),
            5..8 => self.double(bits, 90),
            _ => {
                let exponent = i32::try_from(self.below(40)).unwrap() - 20;
                self.double(bits, exponent)
            }
        }
    }

    /// A ball around a double: a point, a narrow one, or a wide one that comes near zero or holds it.
    fn ball_around(&mut self, middle: f64) -> Enclosure {
        match self.below(3) {
            0 => Enclosure::exact(middle),
            1 => Enclosure::around(middle, (middle * power_of_two(-20) * self.double(30, 0)).abs()),
            _ => {
                let exponent = i32::from(self.below(2) == 0);
                Enclosure::around(middle, (middle * self.double(30, exponent)).abs())
            }
        }
    }

    fn any_ball(&mut self) -> Enclosure {
        let middle = self.any_double();
        self.ball_around(middle)
    }

    /// 24 to 60 bits.
    fn precision(&mut self) -> u32 {
        24 + self.below(37)
    }

    /// The ends of an enclosure, its middle, and some points between them.
    fn points(&mut self, ball: &Enclosure) -> Vec<Rational> {
        let (lower, upper) = (ball.lower(), ball.upper());
        if lower == upper {
            return vec![lower];
        }
        let width = &upper - &lower;
        let mut points = vec![lower.clone(), upper, &lower + &width / Rational::integer(2)];
        for _ in 0..2 {
            let part = Rational::new(i64::from(self.below(1 << 16)), 1 << 16);
            points.push(&lower + &width * part);
        }
        points
    }
}

fn power_of_two(exponent: i32) -> f64 {
    2.0_f64.powi(exponent)
}

/// Runs a law a number of times, each with its precision.
fn repeat(seed: u64, times: u32, mut law: impl FnMut(&mut Draw)) {
    let mut draw = Draw::new(seed);
    for _ in 0..times {
        let bits = draw.precision();
        Enclosure::with_precision(bits, || law(&mut draw));
    }
}

// Arithmetic contains the exact result

/// An operation on enclosures, and the same on rationals.
fn check_operation(
    seed: u64,
    of_balls: impl Fn(&Enclosure, &Enclosure) -> Enclosure,
    exactly: impl Fn(&Rational, &Rational) -> Rational,
) {
    let mut decided = 0;
    repeat(seed, 1000, |draw| {
        let (x, y) = (draw.any_ball(), draw.any_ball());
        let result = of_balls(&x, &y);
        if !result.is_decided() {
            return;
        }
        decided += 1;
        let ys = draw.points(&y);
        for point in draw.points(&x) {
            for other in &ys {
                let exact = exactly(&point, other);
                assert!(result.contains(&exact), "{x} and {y} give {result}, not {exact}");
            }
        }
    });
    assert!(decided > 500, "{decided} had an answer");
}

#[test]
fn sums_and_differences_contain_the_exact_ones() {
    check_operation(1, |x, y| x + y, |x, y| x + y);
    check_operation(2, |x, y| x - y, |x, y| x - y);
}

#[test]
fn products_contain_the_exact_ones() {
    check_operation(3, |x, y| x * y, |x, y| x * y);
}

#[test]
fn quotients_contain_the_exact_ones() {
    check_operation(4, |x, y| x / y, |x, y| x / y);
}

#[test]
fn fractions_contain_the_exact_ones() {
    repeat(5, 3000, |draw| {
        let (p, q) = (draw.0.next_u64().cast_signed(), i64::from(draw.0.next_u32()) + 1);
        let exact = Rational::new(p, q);
        let result = Enclosure::rational(&exact);
        assert!(result.contains(&exact));
        assert!(result.relative_bits() >= i64::from(Enclosure::precision().unwrap()) - 1);
    });
}

#[test]
fn the_square_root_squared_contains_the_number() {
    repeat(6, 4000, |draw| {
        let middle = draw.any_double().abs();
        let x = draw.ball_around(middle);
        let root = x.sqrt();
        assert_eq!(root.is_decided(), x.lower() >= Rational::zero(), "{x}");
        if !root.is_decided() {
            return;
        }
        let (lower, upper) = (root.lower(), root.upper());
        for point in draw.points(&x) {
            let is_above_lower = !lower.is_positive() || lower.pow(2) <= point;
            assert!(is_above_lower && upper.pow(2) >= point, "√({x}) is not in {root}");
        }
    });
}

#[test]
fn surds_contain_the_exact_ones() {
    let root = |n| Surd::root(&Rational::integer(n));
    let surd = Surd::ratio(-7, 3) * root(2) + root(30) / Surd::integer(11) + Surd::ratio(1, 7);
    for bits in 24..200 {
        let value = Enclosure::with_precision(bits, || Enclosure::surd(&surd));
        assert!(Surd::rational(&value.lower()) < surd && surd < Surd::rational(&value.upper()));
        assert!(value.relative_bits() > i64::from(bits) - 6);
    }
    let undecided = Enclosure::with_precision(60, || Enclosure::surd(&Surd::undecided()));
    assert!(!undecided.is_decided());
}

#[test]
fn an_operation_on_points_costs_two_bits_at_most() {
    repeat(7, 2000, |draw| {
        let (x, y) = (
            Enclosure::exact(draw.double(53, 3)),
            Enclosure::exact(draw.double(53, -2)),
        );
        let least = i64::from(Enclosure::precision().unwrap()) - 1;
        for result in [&x + &y, &x - &y, &x * &y, &x / &y, (&x * &x).sqrt()] {
            assert!(
                result.relative_bits() >= least,
                "{result} has {}",
                result.relative_bits()
            );
        }
        let positive = &x * &x;
        for result in [x.exp(), positive.ln(), x.sin(), x.cos(), y.atan2(&x), x.atan2(&y)] {
            // The square is off by half a unit in its last place, and so is each result.
            let size = result.magnitude();
            let is_near_zero = size < 0.125;
            assert!(
                is_near_zero || result.relative_bits() >= least - 6,
                "{result} has {}",
                result.relative_bits()
            );
        }
    });
}

// Elementary functions contain their series with remainder

/// A function of enclosures, and its bracket at each point of the ball.
fn check_function(
    seed: u64,
    mut argument: impl FnMut(&mut Draw) -> Enclosure,
    of_ball: impl Fn(&Enclosure) -> Enclosure,
    exactly: impl Fn(&Rational) -> Bracket,
) {
    repeat(seed, 600, |draw| {
        let x = argument(draw);
        let result = of_ball(&x);
        assert!(result.is_decided(), "of {x}");
        for point in draw.points(&x) {
            let exact = exactly(&point);
            assert!(
                exact.is_inside(&result),
                "of {x}: {result} does not contain {:e}",
                exact.0.to_f64()
            );
        }
    });
}

/// A point with few bits (so that the rational series stay short), from 2⁻²⁰ to 2 in size.
fn short_point(draw: &mut Draw) -> f64 {
    let exponent = 2 - i32::try_from(draw.below(22)).unwrap();
    draw.double(20, exponent.min(1))
}

/// The same as a point, or as a ball of any width up to half of it.
fn short_ball(draw: &mut Draw) -> Enclosure {
    let middle = short_point(draw);
    let width = i32::try_from(draw.below(60)).unwrap();
    if draw.below(3) == 0 {
        Enclosure::exact(middle)
    } else {
        Enclosure::around(middle, (middle * power_of_two(-1 - width)).abs())
    }
}

#[test]
fn the_exponential_contains_its_series_with_remainder() {
    check_function(11, |draw| Enclosure::exact(short_point(draw)), Real::exp, exact_exp);
}

#[test]
fn sine_and_cosine_contain_their_series_with_remainder() {
    let argument = |draw: &mut Draw| Enclosure::exact(short_point(draw));
    check_function(12, argument, Real::sin, |x| exact_circular(x, 1));
    check_function(13, argument, Real::cos, |x| exact_circular(x, 0));
}

#[test]
fn the_logarithm_contains_its_series_with_remainder() {
    check_function(14, |draw| Enclosure::exact(short_point(draw).abs()), Real::ln, exact_ln);
    // Near one, where digits cancel.
    let near_one = |draw: &mut Draw| Enclosure::exact(1.0 + short_point(draw) * power_of_two(-10));
    check_function(15, near_one, Real::ln, exact_ln);
}

#[test]
fn the_arcus_tangent_contains_its_series_with_remainder() {
    repeat(16, 1500, |draw| {
        let (y, x) = (short_point(draw), short_point(draw));
        let result = Enclosure::exact(y).atan2(&Enclosure::exact(x));
        let exact = exact_angle(&Rational::from_f64(y), &Rational::from_f64(x));
        assert!(exact.is_inside(&result), "angle of ({x}, {y}): {result}");
    });
}

/// Where the first term of a series is the result, the next two bracket the truth: x + c₁xᵃ and x + c₁xᵃ + c₂xᵇ.
fn two_terms(x: &Rational, first: (Rational, u32), second: (Rational, u32)) -> Bracket {
    let near = x + first.0 * x.pow(first.1);
    let far = &near + second.0 * x.pow(second.1);
    if near <= far {
        Bracket(near, far)
    } else {
        Bracket(far, near)
    }
}

#[test]
fn tiny_arguments_contain_their_series_with_remainder() {
    let sine = |x: &Rational| two_terms(x, (Rational::new(-1, 6), 3), (Rational::new(1, 120), 5));
    let arctan = |x: &Rational| two_terms(x, (Rational::new(-1, 3), 3), (Rational::new(1, 5), 5));
    // ln (1 + z) for z > 0.
    let ln = |z: &Rational| two_terms(z, (Rational::new(-1, 2), 2), (Rational::new(1, 3), 3));
    repeat(17, 1500, |draw| {
        let exponent = -i32::try_from(draw.below(120)).unwrap() - 40;
        let middle = draw.double(10, exponent);
        // A point, a ball wider than the first term of the remainder, or one that is not.
        let x = Enclosure::around(
            middle,
            (middle * [0.0, 1.0 / 64.0, power_of_two(-150)][draw.below(3) as usize]).abs(),
        );
        let (sines, logarithm) = (x.sin(), Enclosure::with_precision(300, || &x + Enclosure::one()).ln());
        let (one, seven) = (Enclosure::one(), Enclosure::integer(7));
        for point in draw.points(&x) {
            assert!(sine(&point).is_inside(&sines), "sin {x}: {sines}");
            assert!(arctan(&point).is_inside(&x.atan2(&one)), "arctan {x}");
            let seventh = &point / Rational::integer(7);
            assert!(arctan(&seventh).is_inside(&x.atan2(&seven)), "arctan ({x})/7");
            assert!(
                !point.is_positive() || ln(&point).is_inside(&logarithm),
                "ln (1 + {x}): {logarithm}"
            );
        }
    });
}

#[test]
fn the_circle_number_contains_its_series_with_remainder() {
    for bits in 8..90 {
        let pi = Enclosure::with_precision(bits, Enclosure::pi);
        assert!(exact_pi().is_inside(&pi), "{bits} bits: {pi}");
        assert!(pi.relative_bits() > i64::from(bits) - 2);
    }
}

#[test]
fn images_of_points_are_inside_the_image_of_the_ball() {
    check_function(21, short_ball, Real::exp, exact_exp);
    check_function(22, short_ball, Real::sin, |x| exact_circular(x, 1));
    check_function(23, short_ball, Real::cos, |x| exact_circular(x, 0));
    let positive = |draw: &mut Draw| {
        let ball = short_ball(draw);
        if ball.lower().is_positive() { ball } else { -ball }
    };
    check_function(24, positive, Real::ln, exact_ln);
    let mut decided = 0;
    repeat(25, 800, |draw| {
        let (y, x) = (short_ball(draw), short_ball(draw));
        let result = y.atan2(&x);
        if !result.is_decided() {
            return;
        }
        decided += 1;
        let xs = draw.points(&x);
        for y in draw.points(&y) {
            for x in &xs {
                assert!(exact_angle(&y, x).is_inside(&result), "angle of ({x}, {y}): {result}");
            }
        }
    });
    assert!(decided > 600, "{decided}");
}

#[test]
fn stumpff_functions_contain_their_series_with_remainder() {
    for k in 0..=11_usize {
        let order = i64::try_from(k).unwrap();
        let seed = 400 + 10 * u64::try_from(k).unwrap();
        let point = |draw: &mut Draw| Enclosure::exact(short_point(draw));
        check_function(seed, point, |t| t.stumpff(k), |t| exact_stumpff(order, t));
        check_function(seed + 1, short_ball, |t| t.stumpff(k), |t| exact_stumpff(order, t));
        // As far as the other functions take over, on both sides; points, narrow balls, and those that reach over zero.
        let far = |draw: &mut Draw| {
            let middle = short_point(draw) * 70.0;
            draw.ball_around(middle)
        };
        check_function(seed + 2, far, |t| t.stumpff(k), |t| exact_stumpff(order, t));
    }
    // The series with the other sign is another function.
    Enclosure::with_precision(60, || {
        let one = Rational::one();
        assert!(exact_stumpff(1, &one).is_inside(&Enclosure::one().stumpff(1)));
        assert!(!exact_stumpff(1, &-one).is_inside(&Enclosure::one().stumpff(1)));
    });
}

#[test]
fn a_stumpff_function_around_zero_is_as_narrow_as_its_argument() {
    Enclosure::with_precision(256, || {
        for k in 0..=11 {
            let t = Enclosure::around(0.0, 1e-60);
            let value = t.stumpff(k);
            assert!(value.width() <= 1.1e-60, "{k}: {value}");
            let factorial: i64 = (1..=i64::try_from(k).unwrap()).product();
            assert!(value.contains(&Rational::new(1, factorial)));
        }
        // The quotient that it stands for has no answer there.
        let angle = Enclosure::around(0.0, 1e-60);
        assert!(!(angle.sin() / angle).is_decided());
        // Of a ball as wide as this, only the bound of all t ≥ 0 is known; of one that reaches far below zero, much less.
        let wide = Enclosure::around(1e6, 1e6).stumpff(2);
        let half = Rational::new(1, 2);
        assert!(wide.contains(&half) && wide.contains(&-half) && wide.magnitude() < 0.500_001);
        assert!(
            Enclosure::around(0.0, 1e4)
                .stumpff(0)
                .contains(&Rational::integer(10).pow(43))
        );
        assert!(!Enclosure::exact(-power_of_two(100)).stumpff(1).is_decided());
        assert!(Enclosure::exact(power_of_two(200)).stumpff(2).is_decided());
    });
}

#[test]
fn a_turn_whose_rate_is_enclosed_around_zero_is_decided() {
    Enclosure::with_precision(256, || {
        let (rate, interval, density) = (
            Enclosure::around(0.0, 1e-60),
            Enclosure::integer(2),
            Enclosure::integer(3),
        );
        let turn = coordinated_turn(&rate, &interval);
        let noise = turn_noise(&density, &rate, &interval);
        for (turned, straight) in turn.iter().zip(&constant_velocity(&interval)) {
            assert!(turned.contains(&straight.lower()) && turned.width() < 1e-59, "{turned}");
        }
        for (turned, straight) in noise.iter().zip(&integrated_noise(&density, &interval)) {
            assert!(turned.contains(&straight.lower()) && turned.width() < 1e-58, "{turned}");
        }
        // From the quotient as it is printed there is no matrix.
        assert!(!((rate.clone() * interval.clone()).sin() / rate).is_decided());
        // And at zero itself the matrices are those of constant velocity, as points.
        assert_eq!(
            coordinated_turn(&Enclosure::zero(), &interval),
            constant_velocity(&interval)
        );
    });
}

/// For t > 0: six units of the result, and what two units of t move it by. For t < 0: six units and √−t of the result, which is what
/// half a unit of √−t does to its exponential, twice.
#[test]
fn stumpff_functions_of_doubles_are_those_of_enclosures() {
    let unit = power_of_two(-53);
    let mut draw = Draw::new(430);
    let mut largest = [0.0_f64; 2];
    for round in 0..30_000_u32 {
        let k = (round % 12) as usize;
        let exponent = i32::try_from(draw.below(24)).unwrap() - 7;
        let t = draw.double(53, exponent);
        let (value, moved, error) = Enclosure::with_precision(120, || {
            let dual = Dual::variable(Enclosure::exact(t)).stumpff(k);
            let error = (dual.value().clone() - Enclosure::exact(t.stumpff(k))).magnitude();
            (dual.value().magnitude(), (t * dual.slope().middle()).abs(), error)
        });
        let units = if t > 0.0 {
            6.0 * value + 2.0 * moved
        } else {
            (6.0 + t.abs().sqrt()) * value
        };
        let part = &mut largest[usize::from(t > 0.0)];
        *part = part.max(error / (unit * units));
    }
    // The bounds hold, and are not slack.
    assert!(largest.iter().all(|part| (0.3..1.0).contains(part)), "{largest:?}");
}

#[test]
fn angles_of_wide_boxes_are_those_of_their_corners() {
    Enclosure::with_precision(60, || {
        // The box from (1/2, −1) to (3/2, 11) sees the origin from far more than a right angle's half.
        let (y, x) = (Enclosure::around(5.0, 6.0), Enclosure::around(1.0, 0.5));
        let angle = y.atan2(&x);
        let least = exact_angle(&Rational::integer(-1), &Rational::new(1, 2));
        let greatest = exact_angle(&Rational::integer(11), &Rational::new(1, 2));
        assert!(least.is_inside(&angle) && greatest.is_inside(&angle));
        let slack = Rational::new(1, 1 << 26);
        assert!(&angle.upper() - &greatest.1 < slack && least.0 - angle.lower() < slack);
    });
}

// Identities

/// Whether two enclosures can be the same number.
fn agree(a: &Enclosure, b: &Enclosure) -> bool {
    a.lower() <= b.upper() && b.lower() <= a.upper()
}

#[test]
fn the_exponential_of_the_logarithm_contains_the_number() {
    repeat(31, 1000, |draw| {
        let x = draw.any_double().abs();
        if x > 0.0 {
            let back = Enclosure::exact(x).ln().exp();
            assert!(back.contains(&Rational::from_f64(x)), "{x:e} became {back}");
        }
    });
}

#[test]
fn the_squares_of_sine_and_cosine_add_to_one() {
    repeat(32, 1000, |draw| {
        let exponent = i32::try_from(draw.below(60)).unwrap() - 10;
        let x = Enclosure::exact(draw.double(53, exponent));
        let (sine, cosine) = (x.sin(), x.cos());
        let sum = &sine * &sine + &cosine * &cosine;
        assert!(sum.contains(&Rational::one()), "{x}: {sum}");
        assert!(sum.width() < 1e-5);
    });
}

#[test]
fn the_angle_of_a_point_on_a_circle_is_its_angle() {
    repeat(33, 1000, |draw| {
        let theta = Enclosure::exact(draw.double(50, 1));
        let radius = Enclosure::exact(draw.double(53, 5).abs());
        let angle = (&radius * theta.sin()).atan2(&(&radius * theta.cos()));
        assert!(agree(&angle, &theta), "{theta}: {angle}");
    });
}

#[test]
fn exponentials_multiply_and_angles_add() {
    repeat(34, 1000, |draw| {
        let (a, b) = (
            Enclosure::exact(draw.double(53, 4)),
            Enclosure::exact(draw.double(53, 6)),
        );
        assert!(agree(&(&a + &b).exp(), &(a.exp() * b.exp())), "{a} {b}");
        let sine = a.sin() * b.cos() + a.cos() * b.sin();
        assert!(agree(&(&a + &b).sin(), &sine), "{a} {b}");
    });
}

#[test]
fn functions_that_rise_are_never_seen_to_fall() {
    repeat(35, 1000, |draw| {
        let x = draw.double(53, 3).abs();
        let (low, high) = (Enclosure::exact(x), Enclosure::exact(x.next_up()));
        let one = Enclosure::integer(1);
        for function in [Real::exp, Real::ln, Real::sqrt, |x: &Enclosure| {
            x.atan2(&Enclosure::integer(1))
        }] {
            assert_ne!(
                function(&low).partial_cmp(&function(&high)),
                Some(Ordering::Greater),
                "{x}"
            );
        }
        assert_eq!((&low + &one).exp().partial_cmp(&low.exp()), Some(Ordering::Greater));
    });
}

// Other sources

#[test]
fn known_digits_of_constants_are_certified() {
    // OEIS A000796, A001113, A002162 and A003881.
    let pi = "3.1415926535897932384626433832795028841971693993751058209749445923078164062862089986280348253421170679";
    let e = "2.7182818284590452353602874713526624977572470936999595749669676277240766303535475945713821785251664274";
    let ln_2 = "6.931471805599453094172321214581765680755001343602552541206800094933936219696947156058633269964186875";
    let arctan_1 =
        "7.853981633974483096156608458198757210492923498437764552437361480769541015715522496570087063355292669";
    for bits in [400, 640, 1000, 4096] {
        Enclosure::with_precision(bits, || {
            let one = Enclosure::integer(1);
            for (value, digits) in [
                (Enclosure::pi(), pi),
                (one.exp(), e),
                (Enclosure::integer(2).ln(), ln_2),
                (one.atan2(&one), arctan_1),
            ] {
                let text = value.to_decimal(110).expect("far fewer digits than bits");
                assert!(text.starts_with(digits), "{bits} bits: {text}");
            }
        });
    }
}

#[test]
fn doubles_of_another_library_are_within_one_last_place() {
    let is_near = |certified: &Enclosure, double: f64| {
        let certified = certified.to_f64().expect("100 bits determine a double");
        [certified.next_down(), certified, certified.next_up()].contains(&double)
    };
    let mut draw = Draw::new(41);
    for _ in 0..2000 {
        let exponent = i32::try_from(draw.below(20)).unwrap() - 10;
        let (x, y) = (draw.double(53, exponent), draw.double(53, exponent - 3));
        Enclosure::with_precision(100, || {
            let (ball, other) = (Enclosure::exact(x), Enclosure::exact(y));
            if x < 700.0 && x > -700.0 {
                assert!(is_near(&ball.exp(), libm::exp(x)), "exp {x}");
            }
            assert!(is_near(&Enclosure::exact(x.abs()).ln(), libm::log(x.abs())), "ln {x}");
            assert!(is_near(&ball.sin(), libm::sin(x)), "sin {x}");
            assert!(is_near(&ball.cos(), libm::cos(x)), "cos {x}");
            assert!(is_near(&other.atan2(&ball), libm::atan2(y, x)), "atan2 {y} {x}");
            assert!(is_near(&ball.atan2(&other), libm::atan2(x, y)), "atan2 {x} {y}");
        });
    }
}

#[test]
fn doubled_precision_narrows_and_stays_inside() {
    for (seed, bits) in [(51, 40), (52, 100), (53, 300), (54, 640), (55, 1500)] {
        let mut draw = Draw::new(seed);
        for _ in 0..60 {
            let (x, y) = (draw.double(53, 2), draw.double(53, 1));
            let values = |bits| {
                Enclosure::with_precision(bits, || {
                    let (x, y) = (Enclosure::exact(x), Enclosure::exact(y));
                    let square = &x * &x;
                    let third = &x / Enclosure::integer(3);
                    let wide = [
                        third.exp(),
                        third.sin(),
                        third.cos(),
                        third.atan2(&y),
                        y.atan2(&-&square),
                    ];
                    let narrow = [
                        x.exp(),
                        square.ln(),
                        square.sqrt(),
                        x.sin(),
                        x.cos(),
                        y.atan2(&x),
                        x.atan2(&y),
                    ];
                    [&wide[..], &narrow[..]].concat()
                })
            };
            for (coarse, fine) in values(bits).iter().zip(values(2 * bits)) {
                assert!(
                    coarse.contains(&fine.lower()) && coarse.contains(&fine.upper()),
                    "{coarse}"
                );
                let gained = fine.relative_bits().saturating_sub(coarse.relative_bits());
                assert!(
                    fine.width() == 0.0 || gained > i64::from(bits) - 10,
                    "{gained} bits for {bits}"
                );
            }
        }
    }
}

// Exactness, order, zero

#[test]
fn results_that_fit_the_precision_are_points() {
    Enclosure::with_precision(60, || {
        let exact = |value: Enclosure, expected: &Rational| {
            assert_eq!(value.width(), 0.0, "{value}");
            assert_eq!((value.lower(), value.upper()), (expected.clone(), expected.clone()));
        };
        let (three, eight) = (Enclosure::integer(3), Enclosure::integer(8));
        exact(&three * &eight, &Rational::integer(24));
        exact(&three - &eight, &Rational::integer(-5));
        exact(&three / &eight, &Rational::new(3, 8));
        exact(Enclosure::rational(&Rational::new(-5, 64)), &Rational::new(-5, 64));
        exact(Enclosure::integer(49).sqrt(), &Rational::integer(7));
        exact(
            Enclosure::exact(power_of_two(-200)).sqrt(),
            &Rational::from_f64(power_of_two(-100)),
        );
        exact(Enclosure::zero().sqrt(), &Rational::zero());
        exact(Enclosure::zero().exp(), &Rational::one());
        exact(Enclosure::one().ln(), &Rational::zero());
        exact(Enclosure::zero().sin(), &Rational::zero());
        exact(Enclosure::zero().cos(), &Rational::one());
        exact(Enclosure::zero().stumpff(0), &Rational::one());
        exact(Enclosure::zero().stumpff(2), &Rational::new(1, 2));
        exact(Enclosure::zero().atan2(&eight), &Rational::zero());
        exact(
            Enclosure::exact(1.0) + Enclosure::exact(power_of_two(-59)),
            &(Rational::one() + Rational::from_f64(power_of_two(-59))),
        );
        exact(Enclosure::surd(&Surd::ratio(7, 4)), &Rational::new(7, 4));
        // And one bit more does not fit.
        assert!((Enclosure::exact(1.0) + Enclosure::exact(power_of_two(-60))).width() > 0.0);
    });
}

#[test]
fn nothing_times_zero_and_plus_zero_is_wide() {
    Enclosure::with_precision(24, || {
        let wide = Enclosure::around(5.0, 7.0);
        assert!((&wide * Enclosure::zero()).is_zero() && (Enclosure::zero() * &wide).is_zero());
        assert!(!(Enclosure::undecided() * Enclosure::zero()).is_decided());
        // A double of 53 bits, and a ball, among 24 bits.
        for value in [Enclosure::exact(0.1), Enclosure::around(0.1, 0.25)] {
            for sum in [
                &value + Enclosure::zero(),
                Enclosure::zero() + &value,
                &value - Enclosure::zero(),
            ] {
                assert_eq!((sum.lower(), sum.upper()), (value.lower(), value.upper()));
            }
        }
        assert!(!wide.is_zero() && !Enclosure::around(0.0, 1.0).is_zero() && Enclosure::exact(-0.0).is_zero());
    });
}

#[test]
fn an_order_is_one_of_all_numbers_of_both() {
    let order = |a: &Enclosure, b: &Enclosure| a.partial_cmp(b);
    let ball = Enclosure::around(1.0, 0.5);
    assert_eq!(order(&ball, &Enclosure::exact(2.0)), Some(Ordering::Less));
    assert_eq!(order(&Enclosure::exact(-1.0), &ball), Some(Ordering::Less));
    assert_eq!(order(&ball, &Enclosure::exact(0.25)), Some(Ordering::Greater));
    // They overlap, or touch in a point.
    assert_eq!(order(&ball, &Enclosure::exact(1.25)), None);
    assert_eq!(order(&ball, &Enclosure::around(2.0, 0.5)), None);
    assert_eq!(order(&ball, &Enclosure::exact(1.5)), None);
    assert_eq!(order(&ball, &ball), None);
    assert_ne!(ball, ball.clone());
    // Points.
    assert_eq!(
        Enclosure::exact(0.5),
        Enclosure::with_precision(99, || Enclosure::ratio(1, 2))
    );
    assert_ne!(Enclosure::exact(0.5), Enclosure::exact(0.5_f64.next_up()));
    assert_eq!(
        order(&Enclosure::exact(0.5), &Enclosure::exact(0.5_f64.next_up())),
        Some(Ordering::Less)
    );
    assert_eq!(order(&Enclosure::undecided(), &ball), None);
    assert_ne!(Enclosure::undecided(), Enclosure::undecided());
}

// Undecided, one by one

#[test]
fn what_has_no_answer_is_undecided() {
    Enclosure::with_precision(60, || {
        let (zero, one) = (Enclosure::zero(), Enclosure::one());
        let (touches, holds) = (Enclosure::around(1.0, 1.0), Enclosure::around(0.0, 1.0));
        let undecided = |value: Enclosure| assert!(!value.is_decided(), "{value}");
        for divisor in [&zero, &touches, &holds] {
            undecided(&one / divisor);
            undecided(divisor.ln());
        }
        undecided((-&one).ln());
        undecided((-&one).sqrt());
        undecided(holds.sqrt());
        undecided(Enclosure::around(1.0, 1.5).sqrt());
        assert!(touches.sqrt().contains(&Rational::zero()));
        undecided(Enclosure::exact(power_of_two(41)).exp());
        undecided(Enclosure::around(0.0, power_of_two(41)).exp());
        for double in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            undecided(Enclosure::exact(double));
            undecided(Enclosure::around(1.0, double));
        }
        undecided(Enclosure::around(1.0, -1.0));
        undecided(Enclosure::rational(&Rational::undecided()));
        let nothing = Enclosure::undecided();
        for value in [
            nothing.sqrt(),
            nothing.exp(),
            nothing.ln(),
            nothing.sin(),
            nothing.cos(),
            nothing.atan2(&one),
            nothing.stumpff(2),
        ] {
            undecided(value);
        }
        assert!(!nothing.contains(&Rational::zero()) && !one.contains(&Rational::undecided()));
        assert!(nothing.to_f64().is_none() && nothing.to_decimal(3).is_none());
        assert!(nothing.magnitude().is_nan() && nothing.width().is_nan());
        assert_eq!(nothing.to_string(), "undecided");
        assert!(!nothing.lower().is_decided() && !nothing.upper().is_decided());
    });
}

#[test]
fn an_angle_that_may_jump_is_undecided() {
    Enclosure::with_precision(60, || {
        let ball = Enclosure::around;
        let is_decided = |y: Enclosure, x: Enclosure| y.atan2(&x).is_decided();
        // The origin: a point, inside, on an edge, at a corner.
        assert!(!is_decided(Enclosure::zero(), Enclosure::zero()));
        assert!(!is_decided(ball(0.0, 1.0), ball(0.0, 1.0)));
        assert!(!is_decided(Enclosure::zero(), ball(0.0, 1.0)));
        assert!(!is_decided(ball(1.0, 1.0), ball(0.0, 1.0)));
        assert!(!is_decided(ball(1.0, 1.0), ball(1.0, 1.0)));
        // The negative x-axis: across it, and from below up to it.
        assert!(!is_decided(ball(0.0, 1e-9), Enclosure::exact(-2.0)));
        assert!(!is_decided(ball(-1.0, 1.0), Enclosure::exact(-2.0)));
        assert!(!is_decided(ball(0.0, 1.0), ball(-3.0, 1.0)));
        // From above down to it there is no jump, nor anywhere else.
        let angle = ball(1.0, 1.0).atan2(&Enclosure::exact(-2.0));
        assert!(exact_pi().is_inside(&angle));
        assert!(is_decided(ball(0.0, 1.0), ball(3.0, 1.0)));
        assert!(is_decided(ball(3.0, 1.0), ball(0.0, 1.0)));
        assert!(is_decided(ball(-3.0, 1.0), ball(0.0, 1.0)));
        assert!(is_decided(ball(-3.0, 1.0), ball(-3.0, 1.0)));
        // Points on the axes.
        let half = exact_pi().times(&Rational::new(1, 2));
        let (zero, two) = (Enclosure::zero(), Enclosure::integer(2));
        assert!(exact_pi().is_inside(&zero.atan2(&-&two)));
        assert!(half.is_inside(&two.atan2(&zero)));
        assert!(half.times(&Rational::integer(-1)).is_inside(&(-&two).atan2(&zero)));
    });
}

// Exponents

#[test]
fn exponents_far_beyond_doubles_neither_overflow_nor_take_time() {
    for bits in [24, 640] {
        Enclosure::with_precision(bits, || {
            let (large, small) = (Enclosure::exact(1e6).exp(), Enclosure::exact(-1e6).exp());
            assert!((&large * &small).contains(&Rational::one()));
            assert!(large > small && small > Enclosure::zero() && -&large < -&small);
            assert_eq!((large.to_f64(), small.to_f64()), (None, Some(0.0)));
            assert_eq!(
                (large.magnitude(), small.magnitude()),
                (f64::INFINITY, f64::from_bits(1))
            );
            assert_eq!((large.width(), small.width()), (f64::INFINITY, f64::MIN_POSITIVE));
            assert_eq!(large.ln().to_f64().map_or(1e6, f64::round), 1e6);
            assert!((&large + &small) > large.clone() / Enclosure::integer(2));
            assert!(large.atan2(&small).is_decided() && small.atan2(&-&large).is_decided());
            assert!(small.atan2(&large) > Enclosure::zero());
            assert!((Enclosure::one() + &small).ln().is_decided());
            assert!(small.sin() > Enclosure::zero() && small.cos().contains(&Rational::one()));
            // Squared again and again: above it is undecided, below it is a ball around zero.
            let (mut above, mut below) = (large, small.clone());
            let mut power = Enclosure::exact(power_of_two(-1000));
            for _ in 0..80 {
                above *= above.clone();
                below *= below.clone();
                power *= power.clone();
            }
            assert!(!above.is_decided());
            assert!(below.is_decided() && !below.is_zero() && below.contains(&Rational::zero()));
            assert!(power.is_decided() && !power.is_zero() && power.contains(&Rational::zero()));
            assert_eq!(below.to_f64(), Some(0.0));
            let vanishing = Enclosure::exact(-power_of_two(300)).exp();
            assert!(vanishing.contains(&Rational::zero()) && vanishing.to_f64() == Some(0.0));
            let tiny = Enclosure::exact(-power_of_two(39)).exp();
            assert!(tiny > Enclosure::zero() && !tiny.lower().is_decided() && tiny.to_decimal(3).is_none());
            assert!(!tiny.to_string().is_empty() && !tiny.contains(&Rational::zero()));
            let box_of_both = tiny.atan2(&Enclosure::around(0.0, 1.0));
            assert!(box_of_both.is_decided() && (&tiny + Enclosure::one()).is_decided());
            assert!(
                (Enclosure::around(1.0, 0.5) + &tiny)
                    .atan2(&Enclosure::one())
                    .is_decided()
            );
            // An angle of which nothing is known has a sine all the same.
            let unknown = Enclosure::exact(1e300);
            assert!(unknown.sin().contains(&Rational::one()) && unknown.cos().contains(&Rational::integer(-1)));
        });
    }
}

#[test]
fn reduced_arguments_lose_no_digits() {
    // 2⁶⁰ and e⁴⁰: more than 60 bits go into the multiple of the constant.
    Enclosure::with_precision(100, || {
        let x = Enclosure::exact(power_of_two(60));
        assert_eq!(x.sin().to_f64(), Some(libm::sin(power_of_two(60))));
        assert_eq!(x.cos().to_f64(), Some(libm::cos(power_of_two(60))));
        // 16! = 20 922 789 888 000, less than 2⁴⁵: eˣ of its logarithm.
        let factorial = Enclosure::exact(20_922_789_888_000.0);
        assert!(factorial.ln().exp().contains(&Rational::from_f64(20_922_789_888_000.0)));
    });
}

// Scopes

#[test]
fn a_precision_holds_within_its_scope() {
    assert_eq!(Enclosure::precision(), None);
    let (one, three) = (Enclosure::integer(1), Enclosure::integer(3));
    assert!(!(&one / &three).is_decided() && !(&one + &three).is_decided());
    assert!(!Enclosure::pi().is_decided() && !Enclosure::ratio(1, 3).is_decided() && !one.exp().is_decided());
    assert!(Enclosure::exact(0.5).is_decided() && (-&one).is_decided() && Enclosure::one().is_decided());
    Enclosure::with_precision(100, || {
        assert_eq!(Enclosure::precision(), Some(100));
        let inner = Enclosure::with_precision(30, || &one / &three);
        assert_eq!(Enclosure::precision(), Some(100));
        assert!(inner.relative_bits() < 32 && (&one / &three).relative_bits() > 98);
        let panics = || Enclosure::with_precision(50, || std::panic::resume_unwind(Box::new(())));
        assert!(std::panic::catch_unwind(panics).is_err());
        assert_eq!(Enclosure::precision(), Some(100));
        // Another thread has its own.
        std::thread::scope(|scope| {
            scope.spawn(|| assert_eq!(Enclosure::precision(), None));
        });
    });
    assert_eq!(Enclosure::precision(), None);
    assert_eq!(Enclosure::with_precision(0, Enclosure::precision), Some(8));
}

// What is read off

#[test]
fn the_double_of_an_enclosure_is_the_nearest_one() {
    // Exact products of doubles, against the nearest double of a rational; many are subnormal, or at a tie.
    let mut draw = Draw::new(61);
    Enclosure::with_precision(200, || {
        for _ in 0..4000 {
            let bits = [2, 27, 28, 53][draw.below(4) as usize];
            let exponent = [-537, -530, 511, 512, 0][draw.below(5) as usize];
            let product = Enclosure::exact(draw.double(bits, exponent)) * Enclosure::exact(draw.double(bits, exponent));
            let nearest = product.lower().to_f64();
            let expected = nearest.is_finite().then_some(nearest + 0.0);
            assert_eq!(
                product.to_f64().map(f64::to_bits),
                expected.map(f64::to_bits),
                "{product}"
            );
        }
        let tie = Enclosure::exact(1.0) + Enclosure::exact(power_of_two(-53));
        assert_eq!(tie.to_f64(), Some(1.0));
        let tiny = Enclosure::exact(power_of_two(-100));
        assert_eq!((&tie + &tiny).to_f64(), Some(1.0_f64.next_up()));
        assert_eq!((&tie - &tiny).to_f64(), Some(1.0));
        let around_the_tie = &tie + Enclosure::around(0.0, power_of_two(-100));
        assert_eq!(around_the_tie.to_f64(), None);
        assert_eq!(
            (&around_the_tie + Enclosure::exact(power_of_two(-90))).to_f64(),
            Some(1.0_f64.next_up())
        );
        assert_eq!(Enclosure::around(0.0, power_of_two(-1074)).to_f64(), None);
        assert_eq!(Enclosure::around(0.0, power_of_two(-1074) / 2.0).to_f64(), Some(0.0));
        assert_eq!(Enclosure::exact(-0.0).to_f64().map(f64::to_bits), Some(0));
        // Half of the least double, from either side: the even one is zero, and has no sign.
        let half_of_least = Enclosure::exact(power_of_two(-537)) * Enclosure::exact(power_of_two(-538));
        for tie in [half_of_least.clone(), -half_of_least] {
            assert_eq!(tie.to_f64().map(f64::to_bits), Some(0));
        }
        let largest = Enclosure::exact(f64::MAX);
        assert_eq!(largest.to_f64(), Some(f64::MAX));
        let half = Enclosure::exact(power_of_two(969));
        assert_eq!((&largest + &half).to_f64(), Some(f64::MAX));
        assert_eq!((&largest + &half + &half).to_f64(), None);
    });
}

#[test]
fn the_decimal_of_an_enclosure_is_the_nearest_one() {
    let mut draw = Draw::new(62);
    for _ in 0..3000 {
        let double = draw.any_double();
        let digits = draw.below(25);
        let text = Enclosure::exact(double).to_decimal(digits);
        // The standard library writes the exact value of a double, ties to the even digit.
        let expected = format!("{double:.*e}", digits.max(1) as usize - 1);
        let expected = if double == 0.0 { "0".to_owned() } else { expected };
        assert_eq!(text.as_deref(), Some(expected.as_str()));
    }
    let decimal = |middle, radius, digits| Enclosure::around(middle, radius).to_decimal(digits);
    assert_eq!(decimal(2.5, 0.0, 1).as_deref(), Some("2e0"));
    assert_eq!(decimal(3.5, 0.0, 1).as_deref(), Some("4e0"));
    assert_eq!(decimal(-9.9996, 0.0, 4).as_deref(), Some("-1.000e1"));
    assert_eq!(decimal(2.5, 1e-9, 1), None);
    assert_eq!(decimal(2.25, 1e-9, 1).as_deref(), Some("2e0"));
    assert_eq!(decimal(0.0, 1e-9, 1), None);
    // The double is 1.00000000000000005250476…e300.
    assert_eq!(decimal(1e300, 1e280, 19), None);
    assert_eq!(decimal(1e300, 1e280, 20).as_deref(), Some("1.0000000000000000525e300"));
    assert_eq!(decimal(1e300, 1e280, 21), None);
    assert_eq!(decimal(1e300, 1e270, 15).as_deref(), Some("1.00000000000000e300"));
    // A decimal that an enclosure determines is that of each of its points.
    repeat(63, 500, |draw| {
        let value = Enclosure::exact(draw.double(53, 3)) / Enclosure::exact(draw.double(53, 30));
        for digits in 1..20 {
            let Some(text) = value.to_decimal(digits) else { continue };
            let exact = Rational::from_decimal(&text).expect("a decimal");
            let nearest =
                |point: &Rational| (&exact - point).abs() <= exact.abs() * Rational::new(1, 10_i64.pow(digits - 1));
            assert!(nearest(&value.lower()) && nearest(&value.upper()));
        }
    });
}

#[test]
fn size_width_and_certain_bits_are_bounds() {
    repeat(64, 2000, |draw| {
        let (x, y) = (draw.any_ball(), draw.any_ball());
        let value = &x * &y;
        let (lower, upper) = (value.lower(), value.upper());
        let size = if lower.abs() > upper.abs() {
            lower.abs()
        } else {
            upper.abs()
        };
        let magnitude = value.magnitude();
        if magnitude.is_finite() {
            assert!(Rational::from_f64(magnitude) >= size);
            assert!(magnitude == 0.0 || Rational::from_f64(magnitude.next_down()) < size);
        }
        let width = value.width();
        assert_eq!(width == 0.0, lower == upper);
        assert!(width.is_infinite() || Rational::from_f64(width) >= &upper - &lower);
        let bits = value.relative_bits();
        if bits.abs() < 2000 {
            let middle = (&upper + &lower).abs();
            let ratio = middle / (&upper - &lower);
            let power = |k: i64| {
                let power = Rational::integer(2).pow(u32::try_from(k.abs()).unwrap());
                if k < 0 { Rational::one() / power } else { power }
            };
            assert!(power(bits) <= ratio && ratio < power(bits + 1), "{value}: {bits}");
        }
    });
    assert_eq!(Enclosure::exact(3.0).relative_bits(), i64::MAX);
    assert_eq!(Enclosure::around(0.0, 1.0).relative_bits(), i64::MIN);
    assert_eq!(Enclosure::around(1.0, 0.25).relative_bits(), 2);
    assert_eq!(Enclosure::around(1.0, 4.0).relative_bits(), -2);
}

#[test]
fn the_middle_is_the_double_nearest_to_it() {
    repeat(65, 500, |draw| {
        let (x, y) = (draw.any_double(), draw.double(53, 3));
        assert_eq!(draw.ball_around(x).middle(), x);
        // (lower + upper)/2, rounded once.
        let value = Enclosure::exact(x) / Enclosure::exact(y);
        let middle = (value.lower() + value.upper()) / Rational::integer(2);
        assert_eq!(value.middle(), middle.to_f64() + 0.0, "{value}");
    });
    assert!(Enclosure::undecided().middle().is_nan());
}

#[test]
fn an_enclosure_prints_its_middle_and_radius() {
    assert_eq!(Enclosure::around(3.0, 0.001).to_string(), "3.0000e0 ± 1.0e-3");
    assert_eq!(Enclosure::exact(-0.5).to_string(), "-5.0000000000000000e-1");
    assert_eq!(format!("{:?}", Enclosure::zero()), "0");
}

#[test]
fn enclosures_are_shared_between_threads() {
    fn is_shared<T: Send + Sync + 'static>() {}
    is_shared::<Enclosure>();
}
