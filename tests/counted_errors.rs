//! Goal: the errors that an enclosure counts are not too few, where no other error hides them, and its digits not fewer than asked for.
//!
//! Method: an elementary function counts its errors in units some twenty bits below the last bit of its result, and half of that last bit
//! hides them nearly always. Here they are in the open: arguments are solved for (with the inverse function at many more bits) whose
//! results are a unit or two beside the middle of two neighbours, where the rounded result uses up its half bit; or whose results are
//! nearly zero, where nothing is rounded. The same function at many more bits, which other tests compare with proven series, has the truth.
//! Kind of evidence: enclosed; the inputs are drawn from a named generator with a seed.

// That a bound is reached, and a point a point, is equality to the last bit.
#![allow(clippy::float_cmp)]

use immaculate::number::{Enclosure, Field, Rational, Real};
use num_traits::{One, Zero};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// The bits of the truth: far more than those of any result here.
const FINE: u32 = 400;

/// The bits between the last bit of a result and the unit in which its errors are counted.
const GUARD: i32 = 24;

/// 2ᵏ.
fn power(k: i32) -> Rational {
    let power = Rational::integer(2).pow(k.unsigned_abs());
    if k < 0 { Rational::one() / power } else { power }
}

/// A dyadic number of up to 2000 bits as a point.
fn point(value: &Rational) -> Enclosure {
    let point = Enclosure::with_precision(2000, || Enclosure::rational(value));
    assert_eq!(point.width(), 0.0);
    point
}

/// Whether the coarse enclosure holds all of the fine one.
fn holds(coarse: &Enclosure, fine: &Enclosure) -> bool {
    coarse.contains(&fine.lower()) && coarse.contains(&fine.upper())
}

type Function = fn(&Enclosure) -> Enclosure;

/// A function, its inverse, and results to aim at: for each exponent e those from 2ᵉ⁻¹ to 2ᵉ.
struct Target {
    name: &'static str,
    function: Function,
    inverse: Function,
    exponents: &'static [i32],
}

/// √(1 − y²).
fn beside(y: &Enclosure) -> Enclosure {
    (Enclosure::one() - y * y).sqrt()
}

const TARGETS: [Target; 6] = [
    Target {
        name: "exp",
        function: Real::exp,
        inverse: Real::ln,
        exponents: &[-20, 0, 1, 2, 40],
    },
    Target {
        name: "ln",
        function: Real::ln,
        inverse: Real::exp,
        exponents: &[-20, -1, 0, 1, 4],
    },
    Target {
        name: "sin",
        function: Real::sin,
        inverse: |y| y.atan2(&beside(y)),
        exponents: &[-12, -1, 0],
    },
    Target {
        name: "cos",
        function: Real::cos,
        inverse: |y| beside(y).atan2(y),
        exponents: &[-12, -1, 0],
    },
    Target {
        name: "arctan",
        function: |x| x.atan2(&Enclosure::one()),
        inverse: |y| y.sin() / y.cos(),
        exponents: &[-40, -12, -1, 0],
    },
    Target {
        name: "the angle of (1/x, 1)",
        function: |x| Enclosure::one().atan2(x),
        inverse: |y| y.cos() / y.sin(),
        exponents: &[0, 1, 2],
    },
];

#[test]
fn results_beside_the_middle_of_two_neighbours_are_inside() {
    let mut generator = ChaCha8Rng::seed_from_u64(71);
    for Target {
        name,
        function,
        inverse,
        exponents,
    } in TARGETS
    {
        for (&exponent, bits) in exponents.iter().flat_map(|e| [24, 41, 100].map(|bits| (e, bits))) {
            let last = exponent - i32::try_from(bits).unwrap();
            // Half of the guard bits' unit, where the result has its leading bit; a result near zero is counted in smaller ones.
            let step = power(last - GUARD - 1);
            for _ in 0..8 {
                let odd = Rational::integer(i64::from(generator.next_u32() >> 9) * 2 + 1);
                let leading = power(exponent - 1);
                // From 2ᵉ⁻¹ on, this many last bits and a half.
                let middle = leading + odd * power(last - 1);
                for halves in -6..=6 {
                    let wanted = &middle + &step * Rational::integer(halves);
                    let argument = Enclosure::with_precision(FINE, || inverse(&point(&wanted)).lower());
                    let argument = point(&argument);
                    let fine = Enclosure::with_precision(FINE, || function(&argument));
                    let coarse = Enclosure::with_precision(bits, || function(&argument));
                    assert!(
                        holds(&coarse, &fine),
                        "{name} of {argument} at {bits} bits: {coarse} does not hold {fine}"
                    );
                }
            }
        }
    }
}

#[test]
fn results_near_zero_are_inside() {
    // Points near the multiples of π/2, from a few bits of them to more bits than the precision has.
    for bits in [24, 41, 100] {
        for (quarters, places) in (1..40).flat_map(|quarters| (10..bits + 30).step_by(7).map(move |p| (quarters, p))) {
            let argument = Enclosure::with_precision(FINE, || {
                let angle = Enclosure::pi() * Enclosure::ratio(quarters, 2);
                let scale = power(i32::try_from(places).unwrap());
                let digits = (angle.lower() * scale.clone()).value().unwrap().floor();
                point(&(Rational::from_big(digits) / scale))
            });
            for function in [Real::sin, Real::cos] {
                let coarse: Enclosure = Enclosure::with_precision(bits, || function(&argument));
                let fine = Enclosure::with_precision(FINE, || function(&argument));
                assert!(holds(&coarse, &fine), "of {argument}: {coarse} does not hold {fine}");
            }
        }
    }
}

#[test]
fn every_short_argument_is_inside_at_the_least_precision() {
    // Exhaustively: all numbers of six bits from 2⁻⁴⁰ to 2⁴⁰, on both sides of every change of method, as points and as balls.
    let functions: [Function; 5] = [Real::exp, Real::ln, Real::sin, Real::cos, |x| {
        x.atan2(&Enclosure::integer(3))
    }];
    // What is far beyond doubles is left to another test: its ends have thousands of digits.
    let is_inside = |coarse: &Enclosure, fine: &Enclosure| {
        let is_double = fine.magnitude() > 1e-300 && fine.magnitude() < 1e300;
        !coarse.is_decided() || !is_double || holds(coarse, fine)
    };
    for (exponent, mantissa) in (-46..=34).flat_map(|exponent| (32..64).map(move |mantissa| (exponent, mantissa))) {
        let middle = f64::from(mantissa) * 2.0_f64.powi(exponent);
        for (function, sign) in functions
            .iter()
            .flat_map(|function| [(function, 1.0), (function, -1.0)])
        {
            let radius = middle / 32.0;
            let coarse = |radius| Enclosure::with_precision(8, || function(&Enclosure::around(sign * middle, radius)));
            let fine = |x: f64| Enclosure::with_precision(160, || function(&Enclosure::exact(x)));
            assert!(is_inside(&coarse(0.0), &fine(sign * middle)), "of {middle}");
            for end in [sign * middle - radius, sign * middle + radius] {
                assert!(
                    is_inside(&coarse(radius), &fine(end)),
                    "of {middle} ± {radius} at {end}"
                );
            }
        }
    }
}

#[test]
fn a_function_of_a_point_has_all_bits_but_one() {
    let mut generator = ChaCha8Rng::seed_from_u64(72);
    // From 0.1 to 0.7, of either sign, scaled by powers of two: large arguments, ordinary and tiny ones.
    let mut draw = |exponent: i32| {
        let part = 0.1 + 0.6 * f64::from(generator.next_u32()) / f64::from(u32::MAX);
        let sign = if generator.next_u32() % 2 == 0 { 1.0 } else { -1.0 };
        Enclosure::exact(sign * part * 2.0_f64.powi(exponent))
    };
    for bits in [24, 60, 100, 250, 700] {
        for exponent in [-900, -400, -200, -110, -70, -30, -10, -3, 0, 1, 3, 10] {
            let (x, other) = (draw(exponent), draw(-2));
            Enclosure::with_precision(bits, || {
                let size = if x < Enclosure::zero() { -&x } else { x.clone() };
                let near_one = Enclosure::with_precision(3000, || Enclosure::one() + &x);
                let (sine, cosine) = (x.sin(), x.cos());
                let values = [
                    ("exp", x.exp()),
                    ("ln", size.ln()),
                    ("ln near 1", near_one.ln()),
                    ("sin", sine),
                    ("cos", cosine),
                    ("atan2", x.atan2(&other)),
                    ("atan2", other.atan2(&x)),
                    ("√", size.sqrt()),
                    ("π", Enclosure::pi()),
                ];
                for (name, value) in values {
                    // A sine of a large angle that happens to be small has fewer by its own size, and so may a logarithm near one have
                    // none, of a number that is negative.
                    let happens = matches!(name, "sin" | "cos") && exponent > 0 && value.magnitude() < 0.125;
                    if happens || name == "ln near 1" && exponent > 0 {
                        continue;
                    }
                    let least = i64::from(bits) - 1;
                    assert!(value.relative_bits() >= least, "{name} of {x} at {bits} bits: {value}");
                }
            });
        }
    }
}

#[test]
fn constants_have_as_many_bits_as_are_asked_for_in_any_order() {
    // Each thread keeps what it has computed: more bits than were ever asked for are computed anew, and fewer are cut.
    let constants = |bits| Enclosure::with_precision(bits, || [Enclosure::pi(), Enclosure::integer(2).ln()]);
    let fine = std::thread::spawn(move || constants(3000)).join().unwrap();
    let orders = [
        [64, 100, 101, 400, 2000, 401, 90],
        [2000, 64, 1999, 1200, 1201, 500, 24],
    ];
    for order in orders {
        let coarse = std::thread::spawn(move || order.map(constants)).join().unwrap();
        for (bits, coarse) in order.iter().zip(coarse) {
            for (coarse, fine) in coarse.iter().zip(&fine) {
                assert!(holds(coarse, fine), "{bits} bits: {coarse}");
                assert!(coarse.relative_bits() >= i64::from(*bits) - 1, "{bits} bits: {coarse}");
            }
        }
    }
}

#[test]
fn a_vanishing_exponential_is_inside_of_its_ball_around_zero() {
    // At −2⁴⁰ and below nothing is computed. One above, at −2⁴⁰ + 1, it is, and e times smaller is the truth at −2⁴⁰.
    let limit = -2.0_f64.powi(40);
    for bits in [24, 100] {
        Enclosure::with_precision(bits, || {
            let (vanishing, computed) = (Enclosure::exact(limit).exp(), Enclosure::exact(limit + 1.0).exp());
            let truth = computed.clone() / Enclosure::one().exp();
            assert!(vanishing.contains(&Rational::zero()) && !vanishing.is_zero());
            assert!(computed > Enclosure::zero() && truth > Enclosure::zero());
            // Two numbers of which the one may hold the other are in no order; and the ball is not a wide one.
            assert_eq!(vanishing.partial_cmp(&truth), None);
            assert!(vanishing < Enclosure::exact(limit / 2.0).exp());
        });
    }
}

// Radii and the ends of exponents

#[test]
fn a_radius_that_fits_its_thirty_bits_is_not_enlarged() {
    // Products and sums of radii of few bits, whatever their size: the ends are what they are on paper.
    Enclosure::with_precision(64, || {
        let around_zero = |radius: f64| Enclosure::around(0.0, radius);
        for (r, s) in [
            (1.0, 1.0),
            (3.0, 5.0),
            (0.75, 1024.0),
            (2.0_f64.powi(-70), 3.0),
            (32767.0, 32769.0),
        ] {
            let (product, sum) = (around_zero(r) * around_zero(s), around_zero(r) + around_zero(s));
            assert_eq!(
                product.upper(),
                Rational::from_f64(r) * Rational::from_f64(s),
                "{r} {s}"
            );
            if r / s > 2.0_f64.powi(-20) {
                assert_eq!(sum.upper(), Rational::from_f64(r) + Rational::from_f64(s), "{r} {s}");
            }
        }
    });
}

#[test]
fn a_radius_is_rounded_up_by_a_unit_of_its_thirty_bits_at_most() {
    let mut generator = ChaCha8Rng::seed_from_u64(73);
    let unit = power(-29);
    Enclosure::with_precision(64, || {
        for _ in 0..500 {
            let [r, s] =
                [0, 1].map(|_| f64::from(generator.next_u32()) + f64::from(generator.next_u32()) / 2.0_f64.powi(21));
            let exact = |x: f64| Rational::from_f64(x);
            let (ball, other) = (Enclosure::around(0.0, r), Enclosure::around(0.0, s));
            let divisor = Enclosure::exact(s);
            for (upper, radius, roundings) in [
                (ball.upper(), exact(r), 1),
                ((&ball * &other).upper(), exact(r) * exact(s), 3),
                ((&ball + &other).upper(), exact(r) + exact(s), 3),
                ((&ball / &divisor).upper(), exact(r) / exact(s), 3),
            ] {
                let most = &radius * (Rational::one() + &unit * Rational::integer(roundings));
                assert!(radius <= upper && upper <= most, "{r} {s}: {upper} for {radius}");
            }
        }
        // All thirty bits, and one more: the next number is a power of two.
        let ones = 2.0_f64.powi(31) - 1.0;
        assert_eq!(Enclosure::around(0.0, ones).upper(), power(31));
        // A quotient that has no remainder is not rounded.
        for divisor in [3.0, 7.0, 48.0] {
            let quotient = Enclosure::around(0.0, 5.0 * divisor) / Enclosure::exact(divisor);
            assert_eq!(quotient.upper(), Rational::integer(5));
        }
    });
}

#[test]
fn a_root_of_a_ball_that_comes_near_zero_holds_both_ends() {
    // Squares, so that no rounding of the middle hides a radius that is too small; and from nearly all of the number down to little of it.
    let parts = (1..=20).flat_map(|k| {
        let little = power(-k);
        [
            Rational::one() - &little,
            &little * (Rational::one() - power(-20)),
            little,
        ]
    });
    for (part, bits) in parts.flat_map(|part| [24, 60].map(|bits| (part.clone(), bits))) {
        for middle in [1.0, 4.0, 0.25, 9.0, 12.25, 2.0_f64.powi(40)] {
            let (x, radius) = (
                Rational::from_f64(middle),
                (part.clone() * Rational::from_f64(middle)).to_f64(),
            );
            Enclosure::with_precision(bits, || {
                let (ball, r) = (Enclosure::around(middle, radius), Rational::from_f64(radius));
                let root = ball.sqrt();
                assert!(root.is_decided(), "{ball}");
                let (lower, upper) = (root.lower(), root.upper());
                assert!(!lower.is_positive() || lower.pow(2) <= &x - &r, "√({ball}) is {root}");
                assert!(upper.pow(2) >= &x + &r, "√({ball}) is {root}");
                // And no more than twice as wide as the lower end demands: r/√x against r/(√x + √(x − r)).
                let demanded = Rational::from_f64((middle.sqrt() - (middle - radius).max(0.0).sqrt()) * 1.000_001);
                assert!(
                    (&upper - &lower) / Rational::integer(2) <= demanded * Rational::integer(2),
                    "√({ball}) is {root}"
                );
            });
        }
    }
}

#[test]
fn an_exponential_of_a_wide_ball_is_no_wider_than_its_bound() {
    // e^(x ± ρ) within eˣ (1 ± 2ᵏ), k = ⌊3ρ/2⌋ + 1: e^ρ ≤ 2^(3ρ/2), and one more for what is rounded.
    Enclosure::with_precision(64, || {
        for (radius, k) in [(1.0, 2), (1.25, 2), (1.5, 3), (2.0, 4), (10.0, 16), (100.0, 151)] {
            for middle in [0.0, -3.0, 20.0] {
                let wide = Enclosure::around(middle, radius).exp();
                let most = Enclosure::exact(middle).exp() * (Enclosure::one() + Enclosure::rational(&power(k)));
                let end = Enclosure::exact(middle + radius).exp();
                assert!(
                    wide.contains(&end.lower()) && wide.contains(&end.upper()),
                    "{middle} ± {radius}"
                );
                assert!(
                    wide.upper() <= most.upper() * (Rational::one() + power(-27)),
                    "{middle} ± {radius}"
                );
            }
        }
    });
}

#[test]
fn numbers_beyond_what_is_written_out_are_known_and_not_written() {
    // Ends of more than 2²⁴ bits would fill megabytes: no decimal, and no fraction.
    Enclosure::with_precision(24, || {
        for argument in [2e7, -2e7] {
            let value = Enclosure::exact(argument).exp();
            assert!(value > Enclosure::zero() && value.relative_bits() > 20);
            assert!(!value.lower().is_decided() && !value.upper().is_decided());
            assert_eq!(value.to_decimal(3), None);
        }
        // And not much below they are.
        for (argument, decimal) in [(1e5, "2.807e43429"), (-1e5, "3.563e-43430")] {
            assert_eq!(
                Enclosure::with_precision(60, || Enclosure::exact(argument).exp())
                    .to_decimal(4)
                    .as_deref(),
                Some(decimal)
            );
        }
    });
}

#[test]
fn a_radius_covers_bits_far_below_its_own() {
    // 1 + 2⁻ᵏ in [−1, 1] · (1 + 2⁻ᵏ): thirty bits do not show the last one, however many zeros are before it.
    for places in [20, 29, 30, 31, 63, 64, 65, 100, 126, 127, 128, 129, 150, 300] {
        let number = Rational::one() + power(-places);
        Enclosure::with_precision(400, || {
            let ball = Enclosure::around(0.0, 1.0);
            for product in [point(&number) * &ball, point(&-number.clone()) * &ball] {
                assert!(
                    product.contains(&number) && product.contains(&-number.clone()),
                    "{places}"
                );
                assert!(!product.contains(&(&number + power(-28))), "{places}");
            }
            let sum = Enclosure::around(0.0, 1.0) + Enclosure::rational(&power(-places)) * &ball;
            assert!(sum.contains(&number), "{places}");
        });
    }
}

#[test]
fn powers_that_outgrow_all_exponents_are_undecided() {
    // Exact powers of two, squared again and again: at 2^(2⁵⁰) there is no number any more, and no overflow.
    for bits in [8, 24, 640] {
        Enclosure::with_precision(bits, || {
            let mut square = Enclosure::exact(2.0_f64.powi(1000));
            let mut rounds = 0;
            while square.is_decided() {
                square *= square.clone();
                rounds += 1;
                assert!(rounds < 60, "1000 · 2⁶⁰ bits");
            }
            // 1000 · 2⁴⁰ < 2⁵⁰ < 1000 · 2⁴¹.
            assert_eq!(rounds, 41);
        });
    }
}
