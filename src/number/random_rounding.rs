//! Monte Carlo arithmetic: doubles whose operations are rounded at random, to measure the rounding noise of a result.
//!
//! Exact operations are not perturbed.
//!
//! A rounded operation gives its exact result times 1 + δ with |δ| ≤ u, the unit roundoff of the precision. Here every result of a
//! double is multiplied by 1 + ξ with ξ drawn evenly from (−2u, 2u), so that the same equations, evaluated a few times, scatter
//! about as much as implementations of that precision scatter among each other. It is 2u and not u because doubles carry the numbers:
//! at u = 2⁻⁵³ a perturbation within ±u would almost always be rounded away again.
//!
//! What IEEE arithmetic gives exactly is not perturbed: x + 0, x · 0, x · 1, x / 1, 0 / x, negation and integers.
//!
//! Source: D. Stott Parker, Monte Carlo Arithmetic, 1997; J. Vignes, A stochastic arithmetic for reliable scientific computation, 1993. The
//! random numbers are those of SplitMix64 (Steele, Lea and Flood, Fast splittable pseudorandom number generators, 2014): a few lines,
//! the same everywhere, and cheap enough to be drawn for every operation.

use super::operators::{division_operators, ring_operators};
use super::{Field, Rational, Real, Roots, Surd};
use num_traits::{One, Zero};
use std::cell::Cell;
use std::cmp::Ordering;
use std::fmt;

thread_local! {
    /// The noise of the innermost scope.
    static NOISE: Cell<Noise> = const { Cell::new(Noise { step: 0.0, state: 0 }) };
}

/// How large the perturbations are, and where they come from.
#[derive(Clone, Copy)]
struct Noise {
    /// 4u / 2³²: what a step of a random integer of 32 bits is worth; zero outside of all scopes.
    step: f64,
    /// The state of the generator.
    state: u64,
}

impl Noise {
    /// The next random integer of 32 bits, with a sign: the upper half of the next number of SplitMix64.
    fn next(&mut self) -> i32 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        #[allow(clippy::cast_possible_truncation, reason = "the upper half of 64 bits")]
        let upper = (z >> 32) as u32;
        upper.cast_signed()
    }
}

/// A double that is perturbed at random by every operation.
///
/// Example: a third in single precision, with a noise that the seed repeats.
///
/// ```
/// use immaculate::number::RandomRounding;
///
/// // In single precision, u = 2⁻²⁴, the four perturbations of at most 2u move a third by at most 8u/3 = 1.6e-7.
/// let third = || (RandomRounding::input(1.0) / RandomRounding::input(3.0)).output();
/// let value = RandomRounding::with(2.0_f64.powi(-24), 1, third);
/// assert!(value != 1.0 / 3.0 && (value - 1.0 / 3.0).abs() < 2e-7);
///
/// // The same seed gives the same noise, and outside of a scope there is none.
/// assert_eq!(value, RandomRounding::with(2.0_f64.powi(-24), 1, third));
/// assert_eq!(third(), 1.0 / 3.0);
/// ```
#[derive(Clone, Copy, PartialEq)]
pub struct RandomRounding(f64);

impl RandomRounding {
    /// Runs `work` with perturbations within twice the unit roundoff, drawn from the seed.
    ///
    /// Scopes can be nested; the outer noise goes on where it was at the end of the inner one, also if `work` panics. A scope holds
    /// for the thread it is opened in.
    ///
    /// Evidence: `the_same_seed_gives_the_same_random_rounding`, `nothing_is_perturbed_outside_of_a_scope`.
    pub fn with<R>(unit_roundoff: f64, seed: u64, work: impl FnOnce() -> R) -> R {
        struct Restore(Noise);
        impl Drop for Restore {
            fn drop(&mut self) {
                NOISE.set(self.0);
            }
        }
        let noise = Noise {
            step: unit_roundoff * (4.0 / 4_294_967_296.0),
            state: seed,
        };
        let _restore = Restore(NOISE.replace(noise));
        work()
    }

    /// An input: the double, perturbed, since an implementation of another precision rounds it.
    pub fn input(value: f64) -> Self {
        perturbed(value)
    }

    /// The double itself.
    pub fn exact(value: f64) -> Self {
        Self(value)
    }

    /// The double that carries the number.
    pub fn value(self) -> f64 {
        self.0
    }

    /// An output: the double, perturbed once more.
    pub fn output(self) -> f64 {
        perturbed(self.0).0
    }
}

#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "the operators are wired for numbers of any size"
)]
impl RandomRounding {
    /// The sum; one with zero is exact.
    fn plus(self, other: &Self) -> Self {
        let sum = self.0 + other.0;
        if self.0 == 0.0 || other.0 == 0.0 {
            Self(sum)
        } else {
            perturbed(sum)
        }
    }

    /// The difference; one with zero is exact.
    fn minus(self, other: &Self) -> Self {
        self.plus(&other.negative())
    }

    /// The product; one by 1 is exact, and one by 0 is a zero, which no factor changes.
    fn times(self, other: &Self) -> Self {
        let product = self.0 * other.0;
        if is_unit(self.0) || is_unit(other.0) {
            Self(product)
        } else {
            perturbed(product)
        }
    }

    /// The quotient; one by 1 is exact.
    fn over(self, other: &Self) -> Self {
        let quotient = self.0 / other.0;
        if is_unit(other.0) {
            Self(quotient)
        } else {
            perturbed(quotient)
        }
    }

    /// The number with the other sign, exactly.
    fn negative(self) -> Self {
        Self(-self.0)
    }
}

/// Whether a factor changes nothing but the sign.
#[allow(clippy::float_cmp, reason = "only the number one itself is meant")]
fn is_unit(value: f64) -> bool {
    value.abs() == 1.0
}

/// The double times 1 + ξ; what is not finite stays what it is.
fn perturbed(value: f64) -> RandomRounding {
    let mut noise = NOISE.get();
    if noise.step == 0.0 || !value.is_finite() {
        return RandomRounding(value);
    }
    // A random integer of 32 bits with a sign, in units of 2u/2³¹.
    let relative = f64::from(noise.next()) * noise.step;
    NOISE.set(noise);
    RandomRounding(value + value * relative)
}

ring_operators!(RandomRounding);
division_operators!(RandomRounding);

impl Zero for RandomRounding {
    fn zero() -> Self {
        Self(0.0)
    }

    fn is_zero(&self) -> bool {
        self.0 == 0.0
    }
}

impl One for RandomRounding {
    fn one() -> Self {
        Self(1.0)
    }
}

impl Field for RandomRounding {
    fn rational(value: &Rational) -> Self {
        perturbed(value.to_f64())
    }

    fn undecided() -> Self {
        Self(f64::NAN)
    }

    fn is_decided(&self) -> bool {
        self.0.is_finite()
    }

    fn ratio(numerator: i64, denominator: i64) -> Self {
        perturbed(f64::ratio(numerator, denominator))
    }

    /// The integer, exactly.
    fn integer(value: i64) -> Self {
        Self(f64::integer(value))
    }
}

impl Roots for RandomRounding {
    fn surd(value: &Surd) -> Self {
        perturbed(value.to_f64())
    }
}

impl Real for RandomRounding {
    fn pi() -> Self {
        perturbed(f64::pi())
    }

    fn sqrt(&self) -> Self {
        perturbed(Real::sqrt(&self.0))
    }

    fn exp(&self) -> Self {
        perturbed(Real::exp(&self.0))
    }

    fn ln(&self) -> Self {
        perturbed(Real::ln(&self.0))
    }

    fn sin(&self) -> Self {
        perturbed(Real::sin(&self.0))
    }

    fn cos(&self) -> Self {
        perturbed(Real::cos(&self.0))
    }

    fn atan2(&self, x: &Self) -> Self {
        perturbed(Real::atan2(&self.0, &x.0))
    }

    fn stumpff(&self, k: usize) -> Self {
        perturbed(self.0.stumpff(k))
    }

    fn bits() -> u32 {
        f64::bits()
    }

    fn up_to(_: &Self) -> Self {
        Self(0.0)
    }
}

impl PartialOrd for RandomRounding {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.0.partial_cmp(&other.0)
    }
}

impl fmt::Display for RandomRounding {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.0, formatter)
    }
}

impl fmt::Debug for RandomRounding {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.0, formatter)
    }
}
