//! Goal: random rounding perturbs what rounding perturbs, by the given amount, and nothing else.
//!
//! Method: laws of the noise on drawn numbers and on sums whose spread is known. Kind of evidence: property. The generator is named and
//! seeded, so that a statistic either is within its bounds or is not.

// That nothing is perturbed, and that a seed repeats, is equality to the last bit.
#![allow(clippy::float_cmp)]

use immaculate::number::{Field, RandomRounding, Rational, Real, Roots, Surd};
use num_traits::{One, Zero};

/// The unit roundoffs of single and of double precision.
const SINGLE: f64 = f32::EPSILON as f64 / 2.0;
const DOUBLE: f64 = f64::EPSILON / 2.0;

/// Root mean square.
fn spread(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// The relative errors of a computation of a known result, repeated with different seeds.
fn errors(unit_roundoff: f64, times: u64, exact: f64, work: impl Fn() -> RandomRounding) -> Vec<f64> {
    let error = |seed| RandomRounding::with(unit_roundoff, seed, || work().value() / exact - 1.0);
    (0..times).map(error).collect()
}

#[test]
fn a_perturbation_is_even_within_twice_the_unit_roundoff() {
    for unit_roundoff in [SINGLE, 1e-3] {
        let errors = errors(unit_roundoff, 20_000, 1.5, || RandomRounding::input(1.5));
        let greatest = errors.iter().fold(0.0_f64, |greatest, error| greatest.max(error.abs()));
        assert!(greatest <= 2.0 * unit_roundoff * (1.0 + 1e-6) && greatest > 1.99 * unit_roundoff);
        // The standard deviation of an even distribution on (−2u, 2u) is 2u/√3; that of its estimate from n draws less than 1/√n of it.
        let expected = 2.0 * unit_roundoff / 3.0_f64.sqrt();
        assert!((spread(&errors) / expected - 1.0).abs() < 4.0 / 20_000.0_f64.sqrt());
        let mean = errors.iter().sum::<f64>() / 20_000.0;
        assert!(mean.abs() < 4.0 * expected / 20_000.0_f64.sqrt());
    }
}

#[test]
fn perturbations_survive_in_double_precision() {
    let errors = errors(DOUBLE, 2000, 1.0, || RandomRounding::input(1.0));
    let moved = errors.iter().filter(|error| **error != 0.0).count();
    assert!(moved > 1000, "{moved} of 2000 were not rounded away");
}

#[test]
fn the_noise_of_a_sum_grows_as_that_of_independent_roundings() {
    // Partial sums 1, 2, …, n of ones are perturbed one by one (the ones are exact, and so is the first sum with zero). The errors add up
    // to Σ ξₖ k, of variance (4u²/3) Σ k² with k from 2 to n.
    for n in [10, 100, 1000] {
        let sum = || (0..n).fold(RandomRounding::zero(), |sum, _| sum + RandomRounding::one());
        let exact = f64::from(n);
        let variance: f64 = (2..=n).map(|k| f64::from(k).powi(2)).sum::<f64>() * 4.0 * SINGLE * SINGLE / 3.0;
        let expected = variance.sqrt() / exact;
        let ratio = spread(&errors(SINGLE, 1000, exact, sum)) / expected;
        // The spread of 1000 draws is off by 1/√2000 = 2.2 % of itself: four of these.
        assert!((ratio - 1.0).abs() < 0.09, "{n} terms: {ratio} of the expected spread");
    }
}

#[test]
fn every_operation_is_perturbed() {
    RandomRounding::with(SINGLE, 7, || {
        let (x, y) = (RandomRounding::exact(1.25), RandomRounding::exact(-3.5));
        for (name, value, exact) in [
            ("+", x + y, 1.25 - 3.5),
            ("−", x - y, 1.25 + 3.5),
            ("×", x * y, 1.25 * -3.5),
            ("÷", x / y, 1.25 / -3.5),
            ("√", x.sqrt(), 1.25_f64.sqrt()),
            ("exp", x.exp(), libm::exp(1.25)),
            ("ln", x.ln(), libm::log(1.25)),
            ("sin", x.sin(), libm::sin(1.25)),
            ("cos", x.cos(), libm::cos(1.25)),
            ("atan2", y.atan2(&x), libm::atan2(-3.5, 1.25)),
            ("π", RandomRounding::pi(), std::f64::consts::PI),
            ("1/3", RandomRounding::ratio(1, 3), 1.0 / 3.0),
            ("rational", RandomRounding::rational(&Rational::new(1, 3)), 1.0 / 3.0),
            (
                "surd",
                RandomRounding::surd(&Surd::root(&Rational::integer(2))),
                2.0_f64.sqrt(),
            ),
            ("input", RandomRounding::input(1.25), 1.25),
            ("output", RandomRounding::exact(x.output()), 1.25),
        ] {
            let error = (value.value() / exact - 1.0).abs();
            assert!(error > 0.0 && error < 2.01 * SINGLE, "{name}: {error:e}");
        }
    });
}

#[test]
fn what_is_exact_is_not_perturbed() {
    RandomRounding::with(1e-3, 3, || {
        let exact = RandomRounding::exact;
        let (x, zero, one) = (exact(0.1), RandomRounding::zero(), RandomRounding::one());
        for value in [
            x,
            x + zero,
            zero + x,
            x - zero,
            -(zero - x),
            x * one,
            one * x,
            x / one,
            -(x * -one),
            -(x / -one),
            -(-x),
        ] {
            assert_eq!(value.value(), 0.1);
        }
        for value in [x * zero, zero * x, zero / x, zero + zero] {
            assert!(value.is_zero());
        }
        for integer in [0, 1, -7, 1 << 40] {
            assert_eq!(RandomRounding::integer(integer).value(), integer as f64);
        }
        assert!(exact(0.1) < exact(0.2) && exact(0.1) == x);
        assert!(x.partial_cmp(&RandomRounding::undecided()).is_none());
    });
}

#[test]
fn nothing_is_perturbed_outside_of_a_scope() {
    let work = || {
        let third = RandomRounding::input(1.0) / RandomRounding::input(3.0);
        (third.exp() + RandomRounding::pi()).atan2(&third.sqrt()).output()
    };
    let third = 1.0_f64 / 3.0;
    assert_eq!(
        work(),
        libm::atan2(libm::exp(third) + std::f64::consts::PI, third.sqrt())
    );
    let within = RandomRounding::with(SINGLE, 1, work);
    assert!(within != work());
}

#[test]
fn the_same_seed_gives_the_same_random_rounding() {
    let draw = || RandomRounding::input(1.0).value();
    let three = |seed| RandomRounding::with(SINGLE, seed, || [draw(), draw(), draw()]);
    assert_eq!(three(1), three(1));
    assert!(three(1) != three(2));
    // An inner scope does not disturb the outer one, also if it panics.
    let nested = RandomRounding::with(SINGLE, 1, || {
        let first = draw();
        assert_eq!(three(2), three(2));
        let panics = || RandomRounding::with(1.0, 9, || std::panic::resume_unwind(Box::new(())));
        assert!(std::panic::catch_unwind(panics).is_err());
        [first, draw(), draw()]
    });
    assert_eq!(nested, three(1));
    assert_eq!(draw(), 1.0);
}

#[test]
fn infinities_and_values_that_are_no_numbers_stay_what_they_are() {
    RandomRounding::with(SINGLE, 5, || {
        let (zero, one) = (RandomRounding::zero(), RandomRounding::exact(1.5));
        for _ in 0..100 {
            assert!((one / zero).value().is_infinite() && !(one / zero).is_decided());
        }
        assert!((zero / zero).value().is_nan() && RandomRounding::exact(-1.0).sqrt().value().is_nan());
        assert_eq!(zero.ln().value(), f64::NEG_INFINITY);
    });
}

/// The first numbers of SplitMix64 from the states 0 and 1234567, as its users publish them for comparison; the noise is their upper
/// halves, which a perturbation of a whole unit shows bit by bit.
#[test]
fn the_noise_is_that_of_the_named_generator() {
    const KNOWN: [(u64, [u64; 5]); 2] = [
        (
            0,
            [
                0xe220_a839_7b1d_cdaf,
                0x6e78_9e6a_a1b9_65f4,
                0x06c4_5d18_8009_454f,
                0xf88b_b8a8_724c_81ec,
                0x1b39_896a_51a8_749b,
            ],
        ),
        (
            1_234_567,
            [
                6_457_827_717_110_365_317,
                3_203_168_211_198_807_973,
                9_817_491_932_198_370_423,
                4_593_380_528_125_082_431,
                16_408_922_859_458_223_821,
            ],
        ),
    ];
    let draw = |_| (RandomRounding::input(1.0).value() - 1.0) * 2.0_f64.powi(30);
    for (state, known) in KNOWN {
        let drawn = RandomRounding::with(1.0, state, || [0; 5].map(draw));
        let expected = known.map(|known| f64::from(u32::try_from(known >> 32).unwrap().cast_signed()));
        assert_eq!(drawn, expected);
    }
}

/// A perturbed number is written as the double that carries it, in the width that is asked for.
#[test]
fn a_perturbed_number_is_written_as_its_double() {
    let number = RandomRounding::exact(2.5);
    assert_eq!(format!("{number:6.2} {number:?}"), "  2.50 2.5");
}
