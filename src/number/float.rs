//! Doubles as a number system, with the same bits on every platform.
//!
//! After this file the reader knows why a run gives the same bits everywhere, and what an equation may not call.
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
}
