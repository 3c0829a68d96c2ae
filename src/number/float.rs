//! Doubles as a number system, with the same bits on every platform.
//!
//! Equations call only functions that give the same bits everywhere.
//!
//! How the same bits are obtained:
//!
//! - IEEE 754 requires that + − × ÷ and the square root are rounded correctly, so they have one answer everywhere; Rust
//!   compiles `f64::sqrt` to that operation, and never contracts `a * b + c` to a fused multiply-add by itself.
//! - Exponential, logarithm, sine, cosine and arcus tangent have no such requirement, and the C libraries of different
//!   platforms differ in the last bit. Here they come from the crate `libm` alone, which is one text in Rust, compiled
//!   to IEEE operations.
//! - Rationals and surds become the nearest double by exact integer arithmetic.
//!
//! Nothing else may be called in an equation: neither the methods of the standard library (`f64::exp`, `f64::powi`,
//! `f64::mul_add`, …) nor the decompositions and norms of nalgebra. The sign and the payload of a NaN are the one
//! thing that may differ between platforms, and no equation looks at them. (Processors that only have the x87 unit,
//! which rounds twice, are not supported.)
//!
//! A double has its own way to say that an operation has no answer: NaN, which is unequal to itself as
//! [`Field::undecided`] demands. Division of a non-zero number by zero is an infinity, as IEEE 754 has it.

use super::{Field, Rational, Real, Roots, Surd};

/// Up to here, 2⁵³, every integer is a double.
const LARGEST_EXACT_INTEGER: u64 = 1 << 53;

impl Field for f64 {
    fn rational(value: &Rational) -> Self {
        value.to_f64()
    }

    fn undecided() -> Self {
        f64::NAN
    }

    fn is_decided(&self) -> bool {
        self.is_finite()
    }

    /// The nearest double, by the conversion of IEEE 754: equations ask for small integers at every step, and the way
    /// over [`Rational`] would cost more than the equation.
    fn integer(value: i64) -> Self {
        value as f64
    }

    /// The nearest double. Where both integers are doubles themselves it is their quotient, which IEEE 754 rounds
    /// correctly; that is the short way, for the same reason.
    fn ratio(numerator: i64, denominator: i64) -> Self {
        let is_double = |value: i64| value.unsigned_abs() <= LARGEST_EXACT_INTEGER;
        if denominator != 0 && is_double(numerator) && is_double(denominator) {
            // 0/−1 is −0.0 in IEEE 754; adding 0.0 makes it the 0.0 that it is on the long way.
            Self::integer(numerator) / Self::integer(denominator) + 0.0
        } else {
            Self::rational(&Rational::new(numerator, denominator))
        }
    }
}

impl Roots for f64 {
    fn surd(value: &Surd) -> Self {
        value.to_f64()
    }
}

impl Real for f64 {
    fn pi() -> Self {
        std::f64::consts::PI
    }

    fn sqrt(&self) -> Self {
        f64::sqrt(*self)
    }

    fn exp(&self) -> Self {
        libm::exp(*self)
    }

    fn ln(&self) -> Self {
        libm::log(*self)
    }

    fn sin(&self) -> Self {
        libm::sin(*self)
    }

    fn cos(&self) -> Self {
        libm::cos(*self)
    }

    /// As the others, except that a zero has no sign: the angle of (−1, −0.0) is π, and not −π as in IEEE 754, because
    /// −0 is the number 0 in every other number system and −π is outside of (−π, π].
    fn atan2(&self, x: &Self) -> Self {
        // −0.0 + 0.0 is 0.0, and every other number stays what it is.
        libm::atan2(self + 0.0, x + 0.0)
    }

    fn bits() -> u32 {
        f64::MANTISSA_DIGITS
    }

    fn up_to(_: &Self) -> Self {
        0.0
    }

    /// From c₁ or c₂ upwards by c_k = (1/(k−2)! − c₍k−2₎)/t where |t| > k², and by the series else, so that neither cancels.
    ///
    /// The error, with u = 2⁻⁵³: for t > 0 at most 6u of the result and what 2u of t move it by; for t < 0 at most (6 + √−t) u of the
    /// result.
    ///
    /// Evidence: `stumpff_functions_of_doubles_are_those_of_enclosures` (enclosed).
    fn stumpff(&self, k: usize) -> Self {
        let size = k as f64;
        match k {
            0 if *self < 0.0 => libm::cosh((-self).sqrt()),
            0 => libm::cos(self.sqrt()),
            1 => sine_quotient(*self),
            // 1 − cos θ = 2 sin²(θ/2), without its cancellation.
            2 => 0.5 * sine_quotient(self / 4.0) * sine_quotient(self / 4.0),
            _ if self.abs() <= size * size => stumpff_series(k, *self),
            _ => {
                let start = 2 - k % 2;
                let lower = (start..k - 1).step_by(2);
                lower.fold(self.stumpff(start), |value, j| (inverse_factorial(j) - value) / self)
            }
        }
    }
}

/// c₁(t): sin √t / √t or sinh √−t / √−t.
fn sine_quotient(t: f64) -> f64 {
    let root = t.abs().sqrt();
    if t == 0.0 {
        1.0
    } else if t < 0.0 {
        libm::sinh(root) / root
    } else {
        libm::sin(root) / root
    }
}

/// Σⱼ (−t)ʲ/(2j + k)!, until a term changes nothing.
#[allow(clippy::float_cmp, reason = "the sum that a term leaves as it is")]
fn stumpff_series(k: usize, t: f64) -> f64 {
    let mut term = inverse_factorial(k);
    let mut sum = 0.0;
    let mut n = k as f64;
    while sum + term != sum {
        sum += term;
        term *= -t / ((n + 1.0) * (n + 2.0));
        n += 2.0;
    }
    sum
}

/// 1/k!, from the product of the integers, which is exact up to 22! and infinite from 171! on.
fn inverse_factorial(k: usize) -> f64 {
    1.0 / (1..=k.min(171)).map(|i| i as f64).product::<f64>()
}
