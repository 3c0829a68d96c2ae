//! Goal: the number systems are what their names say, so that a proof that is run on them is a proof.
//!
//! Method: the laws of fields, orders, canonical forms and rounding, on random inputs. Kind of evidence: property (the
//! inputs are drawn, by proptest where they have a structure and by quickcheck where they are plain numbers), and each
//! single check is exact: nothing here has a tolerance. Doubles are compared by their bits.

// Doubles are compared exactly: that they are equal to the last bit is what these laws say.
#![allow(clippy::float_cmp)]

use immaculate::matrix::is_finite;
use immaculate::number::{
    Counted, Dual, Enclosure, Field, Polynomial, RandomRounding, Rational, RationalFunction, Real, Roots, Surd,
};
use nalgebra::{Matrix2, Vector2};
use num_traits::{One, Zero};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use quickcheck::QuickCheck;
use std::cmp::Ordering;

// What is drawn

/// Small fractions, zero among them.
fn rationals() -> impl Strategy<Value = Rational> {
    (-12_i64..=12, 1_i64..=9).prop_map(|(numerator, denominator)| Rational::new(numerator, denominator))
}

/// Fractions of any sign and size: `numerator / denominator · 2ᵉ`, from far below the smallest double to far above the
/// largest.
fn rationals_of_any_size() -> impl Strategy<Value = Rational> {
    (any::<i64>(), 1..=i64::MAX, -1200_i32..=1200)
        .prop_map(|(numerator, denominator, exponent)| Rational::new(numerator, denominator) * power_of_two(exponent))
}

/// Sums of up to three terms `fraction · √radicand`.
fn surds() -> impl Strategy<Value = Surd> {
    let term =
        (rationals(), 1_i64..=15).prop_map(|(coefficient, radicand)| Surd::rational(&coefficient) * root(radicand));
    proptest::collection::vec(term, 0..=3)
        .prop_map(|terms| terms.into_iter().fold(Surd::zero(), |sum, term| sum + term))
}

/// Small expressions in the unknowns x and y, √2 and small fractions.
fn rational_functions() -> impl Strategy<Value = RationalFunction> {
    let leaf = prop_oneof![
        Just(RationalFunction::unknown("x")),
        Just(RationalFunction::unknown("y")),
        Just(RationalFunction::surd(&root(2))),
        rationals().prop_map(|value| RationalFunction::rational(&value)),
    ];
    expressions(leaf, 2)
}

/// Expressions in the unknown x alone, of at most eight leaves, so that numerator and denominator have a degree of
/// eight at most.
fn rational_functions_of_x() -> impl Strategy<Value = RationalFunction> {
    let leaf = prop_oneof![
        2 => Just(RationalFunction::unknown("x")),
        1 => rationals().prop_map(|value| RationalFunction::rational(&value)),
    ];
    expressions(leaf, 3)
}

/// Expressions with the four operations, at most so deep; one that divides by zero is replaced by one.
fn expressions(
    leaf: impl Strategy<Value = RationalFunction> + 'static,
    depth: u32,
) -> impl Strategy<Value = RationalFunction> {
    leaf.prop_recursive(depth, 8, 2, |smaller| {
        (smaller.clone(), smaller, 0..4).prop_map(|(left, right, operation)| {
            let result = match operation {
                0 => left + right,
                1 => left - right,
                2 => left * right,
                _ => left / right,
            };
            if result.is_decided() {
                result
            } else {
                RationalFunction::one()
            }
        })
    })
}

/// The square root of a non-negative integer.
fn root(value: i64) -> Surd {
    Surd::root(&Rational::integer(value))
}

/// 2ᵉ, exactly.
fn power_of_two(exponent: i32) -> Rational {
    let power = Rational::integer(2).pow(exponent.unsigned_abs());
    if exponent < 0 { Rational::one() / power } else { power }
}

// Fields

/// The axioms of a field, at three of its numbers.
fn check_field_axioms<T: Field>(a: &T, b: &T, c: &T) -> Result<(), TestCaseError> {
    let (a, b, c) = (|| a.clone(), || b.clone(), || c.clone());
    prop_assert_eq!(a() + b(), b() + a());
    prop_assert_eq!(a() * b(), b() * a());
    prop_assert_eq!((a() + b()) + c(), a() + (b() + c()));
    prop_assert_eq!((a() * b()) * c(), a() * (b() * c()));
    prop_assert_eq!(a() * (b() + c()), a() * b() + a() * c());
    prop_assert_eq!(a() + T::zero(), a());
    prop_assert_eq!(a() * T::one(), a());
    prop_assert_eq!(a() * T::zero(), T::zero());
    prop_assert_eq!(a() + (-a()), T::zero());
    prop_assert_eq!(a() - b(), a() + (-b()));
    if !b().is_zero() {
        prop_assert_eq!(b() * (T::one() / b()), T::one());
        prop_assert_eq!(a() / b() * b(), a());
    }
    let mut in_place = a();
    in_place += b();
    in_place *= c();
    in_place -= b();
    prop_assert_eq!(in_place, (a() + b()) * c() - b());
    Ok(())
}

proptest! {
    #[test]
    fn rationals_are_a_field(a in rationals(), b in rationals(), c in rationals()) {
        check_field_axioms(&a, &b, &c)?;
    }

    #[test]
    fn a_power_is_a_product(a in rationals(), exponent in 0_u32..9) {
        let product = (0..exponent).fold(Rational::one(), |product, _| product * &a);
        prop_assert_eq!(a.pow(exponent), product);
    }

    #[test]
    fn surds_are_a_field(a in surds(), b in surds(), c in surds()) {
        check_field_axioms(&a, &b, &c)?;
    }

    #[test]
    fn rational_functions_are_a_field(
        a in rational_functions(), b in rational_functions(), c in rational_functions(),
    ) {
        check_field_axioms(&a, &b, &c)?;
    }

    #[test]
    fn polynomials_are_a_ring(a in surds(), b in surds()) {
        let (x, y) = (Polynomial::unknown("x"), Polynomial::unknown("y"));
        let (a, b) = (Polynomial::constant(&a), Polynomial::constant(&b));
        let (p, q) = (&a * &x + &y * &b, &b * &x - &a);
        prop_assert_eq!(&p * &q, &q * &p);
        prop_assert_eq!((&p + &q) * (&p - &q), &p * &p - &q * &q);
        prop_assert!((&p - &p).is_zero());
    }

    #[test]
    fn matrices_of_every_number_system_multiply_as_matrices(a in rationals(), b in surds(), c in rational_functions()) {
        check_matrix_product(&a)?;
        check_matrix_product(&b)?;
        check_matrix_product(&c)?;
    }
}

/// The square of (1 a; 0 1) is (1 2a; 0 1), in nalgebra's own product.
fn check_matrix_product<T: Field>(a: &T) -> Result<(), TestCaseError> {
    let shear = |a: T| Matrix2::new(T::one(), a, T::zero(), T::one());
    prop_assert_eq!(shear(a.clone()) * shear(a.clone()), shear(a.clone() + a.clone()));
    let product = shear(a.clone()) * Vector2::new(T::zero(), T::one());
    prop_assert_eq!(product, Vector2::new(a.clone(), T::one()));
    Ok(())
}

// Undecided

/// An undecided number is unequal to itself, and so is the result of every operation on it.
fn check_undecided_is_absorbing<T: Field>(number: &T) {
    let is_undecided = |value: T| {
        let copy = value.clone();
        value != copy
    };
    let (a, undecided) = (|| number.clone(), T::undecided);
    assert!(is_undecided(undecided()));
    for result in [
        undecided() + a(),
        a() + undecided(),
        undecided() - a(),
        a() - undecided(),
        undecided() * a(),
        a() * undecided(),
        undecided() / a(),
        a() / undecided(),
        undecided() - undecided(),
        undecided() / undecided(),
        -undecided(),
    ] {
        assert!(is_undecided(result.clone()), "{result:?} is decided");
    }
    assert!(!undecided().is_zero());
    assert!(!undecided().is_one());
    assert!(undecided() != a() && a() != undecided());
}

#[test]
fn undecided_is_unequal_to_itself_and_absorbs_every_operation() {
    for value in [-1, 0, 1, 7] {
        check_undecided_is_absorbing(&Rational::integer(value));
        check_undecided_is_absorbing(&Surd::integer(value));
        check_undecided_is_absorbing(&RationalFunction::integer(value));
        check_undecided_is_absorbing(&f64::integer(value));
        check_undecided_is_absorbing(&RandomRounding::integer(value));
        check_undecided_is_absorbing(&Counted::integer(value));
        check_undecided_is_absorbing(&Dual::<Rational>::integer(value));
        Enclosure::with_precision(60, || check_undecided_is_absorbing(&Enclosure::integer(value)));
    }
    check_undecided_is_absorbing(&root(2));
    check_undecided_is_absorbing(&RationalFunction::unknown("n"));
}

#[test]
fn only_a_number_is_decided() {
    fn law<T: Field>() {
        for value in [T::zero(), T::one(), -T::one(), T::ratio(2, 3)] {
            assert!(Field::is_decided(&value) && is_finite(&value), "{value:?}");
        }
        assert!(!Field::is_decided(&T::undecided()) && !is_finite(&T::undecided()));
        // An infinity of doubles is no number either.
        let quotient = T::one() / T::zero();
        assert!(!Field::is_decided(&quotient) && !is_finite(&quotient), "{quotient:?}");
    }
    law::<f64>();
    law::<RandomRounding>();
    law::<Counted>();
    law::<Dual<Rational>>();
    law::<Rational>();
    law::<Surd>();
    law::<RationalFunction>();
    Enclosure::with_precision(60, law::<Enclosure>);
    // An interval minus itself is not zero, and a number all the same.
    assert!(is_finite(&Enclosure::around(1.0, 0.5)));
}

#[test]
fn division_by_zero_is_undecided_and_stays_so() {
    let rational = Rational::integer(3) / Rational::integer(0);
    assert!(!rational.is_decided() && !(rational.clone() * Rational::integer(0)).is_decided());
    let surd = root(2) / (root(8) - Surd::integer(2) * root(2));
    assert!(!surd.is_decided() && !(surd.clone() * Surd::integer(0)).is_decided());
    let n = RationalFunction::unknown("n");
    let function = n.clone() / (n.clone() - n.clone());
    assert!(!function.is_decided() && !(function.clone() * RationalFunction::zero()).is_decided());
    assert!(!Rational::new(1, 0).is_decided());
    assert!(!RationalFunction::new(Polynomial::one(), Polynomial::zero()).is_decided());
}

#[test]
fn undecided_has_no_order_no_sign_no_value_and_prints_its_name() {
    let (rational, surd) = (Rational::undecided(), Surd::undecided());
    assert_eq!(rational.partial_cmp(&Rational::one()), None);
    assert_eq!(surd.partial_cmp(&surd.clone()), None);
    assert_eq!((rational.sign(), surd.sign()), (None, None));
    assert!(!rational.is_positive() && !surd.is_positive());
    assert!(rational.value().is_none() && surd.as_rational().is_none());
    assert!(rational.to_f64().is_nan() && surd.to_f64().is_nan());
    assert!(!rational.pow(0).is_decided() && !rational.abs().is_decided() && !surd.abs().is_decided());
    assert_eq!(rational.to_decimal(3), "undecided");
    assert_eq!(surd.to_decimal(3), "undecided");
    assert_eq!(format!("{rational:?} {surd:?}"), "undecided undecided");
    assert_eq!(RationalFunction::undecided().to_string(), "undecided");
    assert_eq!(Polynomial::undecided().to_string(), "undecided");
    assert!(RationalFunction::undecided().evaluate(&[]).is_none());
}

#[test]
fn what_is_not_a_number_becomes_undecided() {
    for double in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(!Rational::from_f64(double).is_decided());
    }
    assert!(!Surd::root(&Rational::integer(-1)).is_decided());
    assert!(!Surd::root(&Rational::undecided()).is_decided());
    assert!(!Surd::rational(&Rational::undecided()).is_decided());
    assert!(!RationalFunction::rational(&Rational::undecided()).is_decided());
    assert!(f64::rational(&Rational::undecided()).is_nan());
}

#[test]
fn a_radicand_beyond_64_bits_is_undecided_and_one_below_is_exact() {
    // 2⁶⁴ − 59 is the largest prime below 2⁶⁴.
    let prime = Rational::from_decimal("18446744073709551557").expect("a decimal");
    let largest = Surd::root(&prime);
    assert_eq!(largest.clone() * largest.clone(), Surd::rational(&prime));
    assert!(!(largest.clone() * root(2)).is_decided());
    // Its square is found by the square root; its product with 4 in lowest terms is not free of squares.
    assert_eq!(Surd::root(&prime.pow(2)), Surd::rational(&prime));
    let four_times = prime.clone() * Rational::integer(4);
    assert_eq!(Surd::root(&four_times), &largest * Surd::integer(2));
    assert!(!Surd::root(&(prime.pow(2) * Rational::integer(2))).is_decided());
    // Products of two such roots, below the line of a function: it is undecided as a whole.
    let other = Surd::root(&Rational::from_decimal("18446744073709551533").expect("a decimal"));
    let x = RationalFunction::unknown("x");
    let line = RationalFunction::surd(&largest) * &x + RationalFunction::surd(&other);
    assert!(line.is_decided());
    assert!(!RationalFunction::new(Polynomial::one(), line.numerator().clone()).is_decided());
    // The root of an even power of two is exact however small it is.
    assert_eq!(Surd::root(&power_of_two(-2148)), Surd::rational(&power_of_two(-1074)));
}

// Decimals and doubles

#[test]
fn a_decimal_is_read_exactly() {
    for (text, value) in [
        ("0.1", Rational::new(1, 10)),
        ("-1e-3", Rational::new(-1, 1000)),
        ("+12.50E2", Rational::integer(1250)),
        ("-0", Rational::integer(0)),
        (".5", Rational::new(1, 2)),
        ("5.", Rational::integer(5)),
        ("0.125e+1", Rational::new(5, 4)),
        ("1e-400", Rational::one() / Rational::integer(10).pow(400)),
    ] {
        assert_eq!(Rational::from_decimal(text), Some(value), "{text}");
    }
    for text in [
        "",
        ".",
        "-",
        "e5",
        "1e",
        "1e+",
        "--1",
        "1_000",
        "0x1",
        "1.2.3",
        "1e2.5",
        "1e10001",
        "1e-10001",
        "inf",
        "NaN",
        " 1",
        "1 ",
        "1/2",
        "1e99999999999999999999",
        "٣",
    ] {
        assert!(Rational::from_decimal(text).is_none(), "{text} was read");
    }
    // The longest text and the greatest exponents that are read, and one more.
    for length in [9_999, 10_000, 10_001, 20_000] {
        let text = format!("{:0>length$}", 7);
        assert_eq!(
            Rational::from_decimal(&text),
            (length <= 10_000).then(|| Rational::integer(7)),
            "{length}"
        );
    }
    for exponent in ["10000", "-10000"] {
        let number = Rational::from_decimal(&format!("1e{exponent}")).unwrap();
        let back = Rational::from_decimal(&format!(
            "1e{}",
            exponent.strip_prefix('-').map_or(format!("-{exponent}"), str::to_owned)
        ));
        assert_eq!(number * back.unwrap(), Rational::one());
    }
}

#[test]
fn a_double_goes_in_exactly_and_comes_out_again() {
    fn law(double: f64) -> bool {
        let exact = Rational::from_f64(double);
        if !double.is_finite() {
            return !exact.is_decided();
        }
        // Rust prints a double with the fewest digits that lead back to it, and reads to the nearest.
        let reread = Rational::from_decimal(&format!("{double:e}")).map(|value| value.to_f64());
        // The sign of a zero is lost, since it is not part of the number.
        exact.to_f64() == double && reread == Some(double)
    }
    QuickCheck::new().tests(2000).quickcheck(law as fn(f64) -> bool);
    assert_eq!(
        Rational::from_f64(0.1).to_string(),
        "3602879701896397/36028797018963968"
    );
}

#[test]
fn integers_and_fractions_are_those_of_every_number_system() {
    fn law(numerator: i64, denominator: i64, shift: u8) -> bool {
        // A shift makes small integers as frequent as large ones.
        let (p, q) = (numerator >> (shift % 63), denominator >> (shift / 4));
        if q == 0 {
            return f64::ratio(p, q).is_nan();
        }
        let exact = Rational::new(p, q);
        exact.clone() * Rational::integer(q) == Rational::integer(p)
            && Surd::ratio(p, q).as_rational() == Some(exact.clone())
            && RationalFunction::ratio(p, q).evaluate(&[]) == Some(Surd::rational(&exact))
            && f64::ratio(p, q).to_bits() == exact.to_f64().to_bits()
            && f64::integer(p).to_bits() == Rational::integer(p).to_f64().to_bits()
    }
    QuickCheck::new()
        .tests(2000)
        .quickcheck(law as fn(i64, i64, u8) -> bool);
    assert_eq!(f64::ratio(0, -1).to_bits(), 0.0_f64.to_bits());
    assert!(f64::ratio(1, 0).is_nan() && f64::ratio(0, 0).is_nan());
}

/// Whether the double is the one nearest to the number, ties to the even one. In exact arithmetic: it is at least as
/// near as its two neighbours, and has an even last bit if it is as near as one of them. Beyond the largest double,
/// 2¹⁰²⁴ takes the place of the neighbour. A zero has the sign of the number.
fn is_nearest_double(number: &Surd, double: f64) -> bool {
    let exact = |double: f64| {
        let magnitude = if double.is_finite() {
            Rational::from_f64(double.abs())
        } else {
            power_of_two(1024)
        };
        Surd::rational(&if double < 0.0 { -magnitude } else { magnitude })
    };
    let distance = (exact(double) - number.clone()).abs();
    if double.is_infinite() {
        // Half of the last place of the largest double, 2⁹⁷⁰, below 2¹⁰²⁴, or anything beyond.
        let limit = Surd::rational(&(power_of_two(1024) - power_of_two(970)));
        return (double > 0.0) == number.is_positive() && number.abs() >= limit;
    }
    let sign_agrees = number.is_zero() || double.is_sign_positive() == number.is_positive();
    sign_agrees
        && [double.next_down(), double.next_up()].into_iter().all(|neighbour| {
            match distance.partial_cmp(&(exact(neighbour) - number.clone()).abs()) {
                Some(Ordering::Less) => true,
                Some(Ordering::Equal) => double.to_bits().is_multiple_of(2),
                _ => false,
            }
        })
}

/// The middle between a finite double and the next one away from zero.
fn halfway_beyond(double: f64) -> Rational {
    let next = f64::from_bits(double.to_bits() + 1);
    let next = if next.is_finite() {
        Rational::from_f64(next)
    } else if next > 0.0 {
        power_of_two(1024)
    } else {
        -power_of_two(1024)
    };
    (Rational::from_f64(double) + next) / Rational::integer(2)
}

/// Doubles at which rounding changes its ways: zero, the smallest and largest subnormal and normal ones, powers of two.
const EDGES: [f64; 10] = [
    0.0,
    5e-324,
    1e-323,
    2.225_073_858_507_201e-308,
    f64::MIN_POSITIVE,
    1.0 - f64::EPSILON / 2.0,
    1.0,
    9_007_199_254_740_991.0,
    9_007_199_254_740_992.0,
    f64::MAX,
];

proptest! {
    #[test]
    fn the_double_of_a_rational_is_the_nearest_one(number in rationals_of_any_size()) {
        prop_assert!(is_nearest_double(&Surd::rational(&number), number.to_f64()));
    }

    #[test]
    fn the_double_of_a_surd_is_the_nearest_one(number in surds(), exponent in -1100_i32..=1020) {
        let number = number * Surd::rational(&power_of_two(exponent));
        prop_assert!(is_nearest_double(&number, number.to_f64()));
    }

    #[test]
    fn halfway_between_two_doubles_the_even_one_is_nearest(double in any::<f64>(), exponent in -2000_i32..=-1100) {
        check_halfway(double, &power_of_two(exponent))?;
    }
}

#[test]
fn halfway_between_two_doubles_at_the_edges_the_even_one_is_nearest() -> Result<(), TestCaseError> {
    for edge in EDGES {
        check_halfway(edge, &power_of_two(-1200))?;
        check_halfway(-edge, &power_of_two(-1200))?;
    }
    Ok(())
}

/// The middle of two doubles rounds to the even one, and a rational or irrational number as little as 2⁻¹¹⁰⁰ beside it
/// to the one on its side.
fn check_halfway(double: f64, little: &Rational) -> Result<(), TestCaseError> {
    let middle = halfway_beyond(double);
    for offset in [Rational::zero(), little.clone(), -little.clone()] {
        let number = middle.clone() + offset.clone();
        prop_assert!(is_nearest_double(&Surd::rational(&number), number.to_f64()));
        let surd = Surd::rational(&middle) + Surd::rational(&offset) * root(2);
        prop_assert!(is_nearest_double(&surd, surd.to_f64()));
    }
    Ok(())
}

#[test]
fn what_rounds_to_zero_keeps_its_sign() {
    // About 2⁻²⁶⁰⁴: a bracket of 2048 bits does not see on which side of zero it lies, and both ends round to a zero.
    let tiny = num_traits::pow(root(3) - root(2), 1575);
    assert_eq!(tiny.to_f64().to_bits(), 0.0_f64.to_bits());
    assert_eq!((-tiny).to_f64().to_bits(), (-0.0_f64).to_bits());
    let tiny = power_of_two(-1100);
    assert_eq!(tiny.to_f64().to_bits(), 0.0_f64.to_bits());
    assert_eq!((-tiny).to_f64().to_bits(), (-0.0_f64).to_bits());
    assert_eq!(Surd::zero().to_f64().to_bits(), 0.0_f64.to_bits());
}

#[test]
fn the_decimal_of_a_number_is_the_nearest_one() {
    assert_eq!(Rational::new(1, 8).to_decimal(2), "0.12");
    assert_eq!(Rational::new(3, 8).to_decimal(2), "0.38");
    assert_eq!(Rational::new(-5, 2).to_decimal(0), "-2");
    assert_eq!(Rational::new(-1, 1000).to_decimal(2), "0.00");
    assert_eq!((-root(3)).to_decimal(10), "-1.7320508076");
    assert_eq!(Surd::integer(2).to_decimal(3), "2.000");
    // (3 + √8)²⁰ + (3 − √8)²⁰ is an integer, and the second power is 4.9e-16.
    let power = num_traits::pow(Surd::integer(3) + root(8), 20);
    assert_eq!(power.to_decimal(15), "2046573816377474.000000000000000");
    assert_eq!(power.to_decimal(16), "2046573816377473.9999999999999995");
}

// Surds

proptest! {
    #[test]
    fn a_root_squared_is_its_radicand(value in rationals()) {
        let value = value.abs();
        let root = Surd::root(&value);
        prop_assert_eq!(root.clone() * root.clone(), Surd::rational(&value));
        prop_assert_eq!(root.is_zero(), value.is_zero());
        prop_assert_eq!(root.is_positive(), value.is_positive());
    }

    #[test]
    fn a_product_of_roots_is_the_root_of_the_product(a in 0_i64..5000, b in 0_i64..5000) {
        prop_assert_eq!(root(a) * root(b), root(a * b));
    }

    #[test]
    fn the_square_part_of_a_radicand_is_found(square in 1_i64..3_000_000, radicand in 1_i64..1_000_000) {
        let value = Rational::integer(square).pow(2) * Rational::integer(radicand);
        prop_assert_eq!(Surd::root(&value), Surd::integer(square) * root(radicand));
        prop_assert_eq!(Surd::root(&(Rational::one() / value)) * Surd::integer(square) * root(radicand), Surd::one());
    }

    #[test]
    fn the_order_of_surds_is_that_of_their_doubles_and_of_their_difference(a in surds(), b in surds()) {
        // Rounding to the nearest is monotone: different doubles are in the order of the numbers.
        match a.to_f64().partial_cmp(&b.to_f64()) {
            Some(Ordering::Less) => prop_assert!(a < b),
            Some(Ordering::Greater) => prop_assert!(a > b),
            _ => prop_assert_eq!(a.partial_cmp(&b), (a.clone() - b.clone()).sign()),
        }
        prop_assert_eq!(a.partial_cmp(&b), b.partial_cmp(&a).map(Ordering::reverse));
        prop_assert_eq!(a == b, a.partial_cmp(&b) == Some(Ordering::Equal));
        prop_assert!(a.abs() >= a);
    }
}

#[test]
fn equal_surds_are_equal_however_they_are_written() {
    let sum = root(2) + root(3);
    assert_eq!(sum.clone() * sum.clone(), Surd::integer(5) + Surd::integer(2) * root(6));
    assert_eq!(root(12) - root(3) - root(3), Surd::zero());
    let denominator = Surd::one() + root(2) + root(3);
    assert_eq!(Surd::one() / denominator.clone() * denominator, Surd::one());
    // 6, 10 and 15 have common factors in pairs and none in all. Changing the sign of √6 alone leads from here to
    // 20 + 10·√6 + 2·√10 + 2·√15 and so on without end: the signs of two roots have to change together.
    let denominator = Surd::one() + root(6) + root(10) + root(15);
    assert_eq!(Surd::one() / denominator.clone() * denominator, Surd::one());
}

#[test]
fn the_order_of_surds_is_exact_where_doubles_cannot_tell() {
    // Convergents p/q of √2, from p, q to p + 2q, p + q, are above and below it in turn.
    let (mut p, mut q) = (Rational::integer(1), Rational::integer(1));
    for step in 0..200 {
        let convergent = Surd::rational(&(p.clone() / q.clone()));
        assert_eq!(convergent > root(2), step % 2 == 1);
        (p, q) = (p.clone() + Rational::integer(2) * q.clone(), p + q);
    }
    assert!(Surd::ratio(665_857, 470_832) > root(2));
    // The powers of √3 − √2 are differences of two large multiples of roots, and positive.
    let mut power = Surd::one();
    for _ in 0..100 {
        power *= root(3) - root(2);
        assert!(power.is_positive() && !(-&power).is_positive());
    }
    // The square of √2 + √3 is 5 + 2·√6, and that to the last of a hundred digits.
    let tiny = num_traits::pow(root(2) - Surd::one(), 256);
    assert!(tiny.is_positive() && tiny < Surd::rational(&power_of_two(-325)));
    let sum = root(2) + root(3);
    let square = Surd::integer(5) + Surd::integer(2) * root(6);
    assert!(sum.clone() * sum.clone() + tiny.clone() > square);
    assert!(sum.clone() * sum - tiny < square);
}

/// A dual number is decided where its value and its slope are.
#[test]
fn what_a_number_carries_takes_part() {
    let (one, undecided) = (Rational::one(), Rational::undecided());
    assert!(Dual::new(one.clone(), one.clone()).is_decided());
    assert!(!Dual::new(one.clone(), undecided.clone()).is_decided() && !Dual::new(undecided, one).is_decided());
}

/// A dual number is written with its slope beside ε, in the width that is asked for.
#[test]
fn numbers_that_carry_something_say_what() {
    let dual = Dual::new(Rational::new(1, 2), Rational::new(3, 1));
    assert_eq!(format!("{dual:>14} {dual:?}"), "    1/2 + (3)ε 1/2 + (3)ε");
}

#[test]
fn surds_print_as_they_are_written() {
    let number = Surd::one() - Surd::ratio(3, 2) * root(2);
    assert_eq!(number.to_string(), "-3/2·√2 + 1");
    assert_eq!((root(6) - root(2)).to_string(), "√6 - √2");
    assert_eq!(root(6).to_string(), "√6");
    assert_eq!(Surd::zero().to_string(), "0");
    assert_eq!(Surd::ratio(-2, 4).to_string(), "-1/2");
}

// Rational functions

proptest! {
    #[test]
    fn evaluation_carries_operations_over(
        f in rational_functions(), g in rational_functions(), x in rationals(), y in rationals(),
    ) {
        let at = |function: &RationalFunction| function.evaluate(&[("x", x.clone()), ("y", y.clone())]);
        // At a pole there is nothing to compare.
        let (Some(f_value), Some(g_value)) = (at(&f), at(&g)) else {
            return Ok(());
        };
        prop_assert_eq!(at(&(&f + &g)), Some(&f_value + &g_value));
        prop_assert_eq!(at(&(&f - &g)), Some(&f_value - &g_value));
        prop_assert_eq!(at(&(&f * &g)), Some(&f_value * &g_value));
        prop_assert_eq!(at(&-&f), Some(-&f_value));
        if !g_value.is_zero() {
            prop_assert_eq!(at(&(&f / &g)), Some(&f_value / &g_value));
        }
        prop_assert_eq!(f.substitute(&[("x", Surd::rational(&x)), ("y", Surd::rational(&y))]), f_value);
    }

    #[test]
    fn equal_fractions_are_equal_at_every_point_and_others_are_not(
        f in rational_functions_of_x(), g in rational_functions_of_x(), rewritten in any::<bool>(),
    ) {
        // Half of the time, the same function in another form.
        let other = if rewritten && !g.is_zero() { &(&f * &g) / &g } else { g };
        // The degrees above and below the line are at most 8 in f and 24 in the other, so there are at most 32 poles,
        // and the difference has at most 32 zeros unless it is zero everywhere: 65 points decide.
        let equal_everywhere = (0..65).all(|point| {
            let at = |function: &RationalFunction| function.evaluate(&[("x", Rational::integer(point))]);
            match (at(&f), at(&other)) {
                (Some(left), Some(right)) => left == right,
                _ => true,
            }
        });
        prop_assert_eq!(f == other, equal_everywhere);
    }

    #[test]
    fn an_unknown_can_be_replaced_by_a_function(
        f in rational_functions_of_x(), g in rational_functions_of_x(), x in rationals(),
    ) {
        let composed: RationalFunction = f.substitute(&[("x", g.clone())]);
        let value = |function: &RationalFunction, x: Surd| function.substitute(&[("x", x)]);
        let expected = value(&f, value(&g, Surd::rational(&x)));
        if expected.is_decided() && composed.is_decided() {
            prop_assert_eq!(value(&composed, Surd::rational(&x)), expected);
        }
    }
}

#[test]
fn a_polynomial_has_the_value_that_its_terms_add_up_to() {
    // 3x²y − √2·x + 5 at x = 2, y = −1: −12 − 2√2 + 5.
    let (x, y) = (Polynomial::unknown("x"), Polynomial::unknown("y"));
    let constant = |value: &Surd| Polynomial::constant(value);
    let polynomial = constant(&Surd::integer(3)) * &x * &x * &y - constant(&root(2)) * &x + constant(&Surd::integer(5));
    let value = Surd::integer(-7) - Surd::integer(2) * root(2);
    let at = [("y", Rational::integer(-1)), ("x", Rational::integer(2))];
    assert_eq!(polynomial.evaluate(&at), Some(value.clone()));
    assert_eq!(
        polynomial.substitute(&[("x", Surd::integer(2)), ("y", Surd::integer(-1))]),
        value
    );
    assert_eq!(polynomial.evaluate(&at[..1]), None);
    assert_eq!(Polynomial::zero().evaluate(&[]), Some(Surd::zero()));
}

#[test]
fn an_unknown_without_a_value_leaves_the_function_undecided() {
    let (n, m) = (RationalFunction::unknown("n"), RationalFunction::unknown("m"));
    let function = &n / &m;
    let (one, zero) = (Rational::one(), Rational::zero());
    assert!(function.evaluate(&[("n", one.clone())]).is_none());
    assert!(function.evaluate(&[("n", one.clone()), ("m", zero)]).is_none());
    assert_eq!(function.evaluate(&[("n", one.clone()), ("m", one)]), Some(Surd::one()));
    assert!(function.substitute(&[("n", 1.0)]).is_nan());
    assert_eq!(function.substitute(&[("n", 1.0), ("m", 4.0)]), 0.25);
}

#[test]
fn rational_functions_print_as_they_are_written() {
    let n = || RationalFunction::unknown("n");
    let integer = RationalFunction::integer;
    assert_eq!(((n() + integer(2)) / (n() - integer(1))).to_string(), "(n + 2)/(n - 1)");
    assert_eq!((integer(1) / n()).to_string(), "1/n");
    assert_eq!((n() * n() / n()).to_string(), "n");
    assert_eq!((integer(1) / (integer(2) * n())).to_string(), "(1/2)/n");
    let coefficient = RationalFunction::surd(&(root(2) + Surd::one()));
    assert_eq!((coefficient * n() - integer(3)).to_string(), "(√2 + 1)·n - 3");
    let m = RationalFunction::unknown("m");
    let product = m * n();
    assert_eq!((integer(1) / product.clone()).to_string(), "1/(m·n)");
    // In messages of tests too, numerator and denominator as well.
    assert_eq!(
        format!("{product:?} {:?} {:?}", product.numerator(), Surd::ratio(1, 2)),
        "m·n m·n 1/2"
    );
}

// Doubles

/// The results of the elementary functions as bits. They come from libm 0.2 and are the same on every platform; each is
/// within one unit in the last place of the exact value, but for the Stumpff functions, whose bound has its own test. A difference here
/// means that this platform, or another version of libm, changes every trace.
#[test]
fn elementary_functions_have_the_same_bits_on_every_platform() {
    for (x, bits) in [
        (1.0, 0x4005_bf0a_8b14_576a),
        (-0.5, 0x3fe3_68b2_fc6f_960a),
        (10.25, 0x40db_9ea2_aed2_a0f2),
        (-700.125, 0x00ce_8cfc_0420_616b),
        (1e-10, 0x3ff0_0000_0006_df38),
        (709.5, 0x7fe8_1e9b_4b52_d0c9),
        (-745.0, 0x0000_0000_0000_0001),
    ] {
        assert_bits("exp", &[x], Real::exp(&x), bits);
    }
    for (x, bits) in [
        (2.0, 0x3fe6_2e42_fefa_39ef),
        (0.1, 0xc002_6bb1_bbb5_5515),
        (3.0, 0x3ff1_93ea_7aad_030a),
        (1e-300, 0xc085_9634_47f8_7fb5),
        (1.000_000_1, 0x3e7a_d7f2_847b_6492),
        (12_345.678, 0x4022_d795_5979_1e31),
        (5e-324, 0xc087_4385_446d_71c3),
    ] {
        assert_bits("ln", &[x], Real::ln(&x), bits);
    }
    for (x, bits) in [
        (1.0, 0x3fea_ed54_8f09_0cee),
        (0.1, 0x3fb9_8eae_cb8b_cb2c),
        (3.0, 0x3fc2_1038_6db6_d55b),
        (-2.5, 0xbfe3_26af_0dcf_cab0),
        (100.0, 0xbfe0_3425_b78c_4db8),
        (1e22, 0xbfeb_453a_b76b_f397),
        (1e-5, 0x3ee4_f8b5_88e1_e8a2),
    ] {
        assert_bits("sin", &[x], Real::sin(&x), bits);
    }
    for (x, bits) in [
        (1.0, 0x3fe1_4a28_0fb5_068c),
        (0.1, 0x3fef_d712_f9a8_17c1),
        (std::f64::consts::FRAC_PI_2, 0x3c91_a626_3314_5c07),
        (-2.5, 0xbfe9_a2f7_ef85_8b7d),
        (100.0, 0x3feb_981d_bf66_5fdf),
        (1e22, 0x3fe0_be2c_ef01_c8f4),
        (3.0, 0xbfef_ae04_be85_e5d2),
    ] {
        assert_bits("cos", &[x], Real::cos(&x), bits);
    }
    for (y, x, bits) in [
        (1.0, 2.0, 0x3fdd_ac67_0561_bb4f),
        (0.1, -0.3, 0x4006_8f09_5fdf_593c),
        (-1.0, -1.0, 0xc002_d97c_7f33_21d2),
        (-3.0, 0.7, 0xbff5_770c_39ba_330a),
        (1e-300, 2.0, 0x0195_6e1f_c2f8_f359),
        (5.0, 1e-5, 0x3ff9_21f9_3b65_3902),
        (-1e-9, -3.0, 0xc009_21fb_5438_b910),
    ] {
        assert_bits("atan2", &[y, x], Real::atan2(&y, &x), bits);
    }
    for (k, t, bits) in [
        (0, 2.0, 0x3fc3_f5f6_8684_70b3),
        (0, -2.0, 0x4001_6ceb_8022_8cdb),
        (1, 0.01, 0x3fef_f25a_7e6e_bdf7),
        (1, -50.0, 0x4054_d052_3862_9be2),
        (2, 1e-9, 0x3fdf_ffff_fff4_8bf8),
        (3, 4.0, 0x3fc1_7384_8a97_25dc),
        (5, 700.0, 0x3f2e_f32e_ae68_22f0),
        (4, -700.0, 0x4113_431f_ab89_7bed),
    ] {
        assert_bits(&format!("c{k}"), &[t], t.stumpff(k), bits);
    }
    for (x, bits) in [
        (2.0, 0x3ff6_a09e_667f_3bcd),
        (0.1, 0x3fd4_3d13_6248_490f),
        (3.0, 0x3ffb_b67a_e858_4caa),
        (1e-310, 0x1fc1_2978_72d9_cbae),
        (f64::MAX, 0x5fef_ffff_ffff_ffff),
    ] {
        assert_bits("sqrt", &[x], Real::sqrt(&x), bits);
    }
}

/// Fails, with the arguments and both bit patterns, unless the result has exactly these bits.
fn assert_bits(function: &str, arguments: &[f64], result: f64, bits: u64) {
    assert_eq!(
        result.to_bits(),
        bits,
        "{function} of {arguments:?} is {result:e}, {:#018x}, and not {:e}, {bits:#018x}",
        result.to_bits(),
        f64::from_bits(bits)
    );
}

#[test]
fn a_zero_has_no_sign_as_an_argument_of_the_angle() {
    let pi = std::f64::consts::PI;
    assert_eq!(Real::atan2(&-0.0, &-1.0), pi);
    assert_eq!(Real::atan2(&0.0, &-1.0), pi);
    assert_eq!(Real::atan2(&-1.0, &-0.0), -pi / 2.0);
    assert_eq!(Real::atan2(&-0.0, &-0.0), 0.0);
    assert_eq!(f64::pi(), pi);
}

#[test]
fn the_square_root_of_a_double_is_the_nearest_one() {
    fn law(double: f64) -> bool {
        let double = double.abs();
        let exact = Rational::from_f64(double);
        // The largest exact radicands are those that fit into 128 bits.
        let root = Surd::root(&exact);
        !root.is_decided() || is_nearest_double(&root, Real::sqrt(&double))
    }
    QuickCheck::new().quickcheck(law as fn(f64) -> bool);
    assert!(Real::sqrt(&-1.0).is_nan());
}

// Dual numbers

/// Dual numbers over small fractions.
fn duals() -> impl Strategy<Value = Dual<Rational>> {
    (rationals(), rationals()).prop_map(|(value, slope)| Dual::new(value, slope))
}

proptest! {
    #[test]
    fn dual_numbers_with_a_value_can_be_divided_by(a in duals(), b in duals(), c in duals()) {
        // ε and its multiples have no inverse; all else is as in a field.
        prop_assume!(!b.value().is_zero() || b.slope().is_zero());
        check_field_axioms(&a, &b, &c)?;
    }

    #[test]
    fn the_slope_is_the_limit_of_the_difference_quotient(f in rational_functions_of_x()) {
        let (x, h) = (RationalFunction::unknown("x"), RationalFunction::unknown("h"));
        let dual = f.substitute(&[("x", Dual::variable(x.clone()))]);
        prop_assert_eq!(dual.value(), &f);
        // h is cancelled from the quotient as a common monomial, so that the limit is the value at h = 0.
        let moved: RationalFunction = f.substitute(&[("x", &x + &h)]);
        let quotient = (moved - &f) / h;
        let limit = quotient.substitute(&[("x", x), ("h", RationalFunction::zero())]);
        prop_assert!(limit.is_decided());
        prop_assert_eq!(dual.slope(), &limit);
    }
}

#[test]
fn products_and_quotients_of_dual_numbers_follow_leibniz() {
    let unknown = RationalFunction::unknown;
    let (a, b, c, d) = (unknown("a"), unknown("b"), unknown("c"), unknown("d"));
    let (left, right) = (Dual::new(a.clone(), b.clone()), Dual::new(c.clone(), d.clone()));
    let epsilon = Dual::new(RationalFunction::zero(), RationalFunction::one());
    assert_eq!(&left * &right, Dual::new(&a * &c, &a * &d + &b * &c));
    assert_eq!(&left / &right, Dual::new(&a / &c, (&b * &c - &a * &d) / (&c * &c)));
    assert!((&epsilon * &epsilon).is_zero() && !epsilon.is_zero());
    assert!(!Field::is_decided(&(left / epsilon)));
}

#[test]
fn elementary_functions_of_dual_numbers_follow_the_chain_rule() {
    type Function = fn(&Dual<Enclosure>) -> Dual<Enclosure>;
    // Each with a bound of its second derivative on [0.7, 0.8]; that of x² + 1 over x has the chain rule in both arguments.
    let functions: [(&str, Function, f64); 7] = [
        ("sqrt", |x| x.sqrt(), 1.0),
        ("exp", |x| x.exp(), 3.0),
        ("ln", |x| x.ln(), 3.0),
        ("sin", |x| x.sin(), 1.0),
        ("cos", |x| x.cos(), 1.0),
        ("atan2", |x| (x * x).atan2(&(x + Dual::one())), 5.0),
        ("composed", |x| (x.sin() * x).exp().sqrt(), 10.0),
    ];
    Enclosure::with_precision(256, || {
        let x = Enclosure::ratio(3, 4);
        let h = Enclosure::rational(&power_of_two(-80));
        for (name, function, second) in functions {
            let here = function(&Dual::variable(x.clone()));
            let there = function(&Dual::constant(&x + &h));
            assert!(
                there.slope().contains(&Rational::zero()) && there.slope().width() == 0.0,
                "{name}"
            );
            // Taylor's remainder: ½ h² sup|f″|.
            let rest = there.value().clone() - here.value().clone() - here.slope().clone() * h.clone();
            let remainder = h.clone() * h.clone() * Enclosure::exact(second) / Enclosure::integer(2);
            assert!(rest < remainder && rest > -remainder, "{name}: {rest}");
            // And a slope that is off by 2⁻⁷⁰ is refused: the bound is not slack.
            let off = rest + h.clone() * Enclosure::rational(&power_of_two(-70));
            let is_below = off < h.clone() * h.clone() * Enclosure::exact(second);
            assert!(!is_below, "{name}");
        }
    });
}

/// Arguments of Stumpff functions: zero, near to it, and where other functions take over from the series, on both sides.
fn stumpff_arguments() -> [Enclosure; 9] {
    [0.0, 1e-30, -1e-30, 0.75, -2.0, 30.0, -30.0, 1e4, -1e4].map(Enclosure::exact)
}

#[test]
fn each_stumpff_function_is_tied_to_the_one_two_above() {
    Enclosure::with_precision(400, || {
        for t in stumpff_arguments() {
            for k in 0..=9 {
                let factorial: i64 = (1..=i64::try_from(k).unwrap()).product();
                let tied =
                    |sign: i64| Enclosure::ratio(1, factorial) - Enclosure::integer(sign) * &t * t.stumpff(k + 2);
                let difference = t.stumpff(k) - tied(1);
                let scale = t.stumpff(k).magnitude().max(1.0);
                assert!(
                    difference.contains(&Rational::zero()) && difference.magnitude() < 1e-100 * scale,
                    "{k}, {t}"
                );
                // With the other sign it does not hold.
                let other = t.stumpff(k) - tied(-1);
                assert_eq!(other.contains(&Rational::zero()), t.is_zero(), "{k}, {t}");
            }
        }
    });
}

#[test]
fn the_slope_of_a_stumpff_function_is_made_of_the_next_two() {
    Enclosure::with_precision(400, || {
        let h = Enclosure::rational(&power_of_two(-80));
        for t in stumpff_arguments()
            .into_iter()
            .filter(|t| *t > Enclosure::integer(-100))
        {
            for k in 0..=9 {
                // The slope is that of the difference quotient: Taylor's remainder is below h², as |c_k″| < 1 for t > −31.
                let slope = Dual::variable(t.clone()).stumpff(k).slope().clone();
                let quotient = ((&t + &h).stumpff(k) - t.stumpff(k)) / h.clone();
                let off = (quotient - &slope).magnitude();
                assert!(off < h.magnitude(), "{k}, {t}: {off:e}");
                // And without the factor k it is another one.
                let other = (t.stumpff(k + 2) - t.stumpff(k + 1)) / Enclosure::integer(2);
                assert_eq!((other - slope).contains(&Rational::zero()), k == 1, "{k}, {t}");
            }
        }
        // A quotient has no slope where it has no value.
        let zero = Dual::variable(Enclosure::zero());
        assert!(!Field::is_decided(&(zero.sin() / zero.clone())));
        assert!(Field::is_decided(&(&zero * &zero).stumpff(1)));
    });
}

#[test]
fn an_infinitesimal_is_positive_and_below_every_positive_number() {
    let dual = |value, slope| Dual::new(Rational::integer(value), Rational::integer(slope));
    assert!(dual(0, 1) > Dual::zero() && dual(0, -1) < Dual::zero());
    assert!(dual(0, 1000) < Dual::rational(&power_of_two(-1000)));
    assert!(dual(2, -7) < dual(2, 7) && dual(2, 7) < dual(3, -7));
    assert_eq!(dual(2, 1).partial_cmp(&Dual::undecided()), None);
}
