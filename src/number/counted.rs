//! Doubles that count their operations: what an evaluation costs, whatever the machine.
//!
//! An operation is +, −, ×, ÷, √, exp, ln, sin, cos, atan2 or a Stumpff function. A change of sign, a comparison and a constant are free.
//! So is what adds a zero, or multiplies by or divides by a one: a program that knows its zeros and ones does not compute it.
//!
//! A Jacobian that is computed with numbers over these costs what its derivatives cost.

use super::operators::{division_operators, ring_operators};
use super::{Field, Rational, Real, Roots, Surd};
use num_traits::{One, Zero};
use std::cell::Cell;
use std::cmp::Ordering;
use std::fmt;

thread_local! {
    static OPERATIONS: Cell<u64> = const { Cell::new(0) };
}

/// A double whose operations are counted, in each thread by itself.
///
/// Example: a polynomial as a sum of powers, and by Horner's scheme.
///
/// ```
/// use immaculate::number::{Counted, Field};
///
/// let [a, b, c, x] = [2.0, 3.0, 5.0, 7.0].map(Counted::new);
/// let (sum, operations) = Counted::during(|| a * x * x + b * x + c);
/// assert_eq!((sum.value(), operations), (124.0, 5));
/// let (scheme, operations) = Counted::during(|| (a * x + b) * x + c);
/// assert_eq!((scheme.value(), operations), (124.0, 4));
/// // A program that knows its zeros and ones does not compute with them.
/// let one = Counted::integer(1);
/// assert_eq!(Counted::during(|| one * x + Counted::integer(0)).1, 0);
/// ```
#[derive(Clone, Copy, PartialEq)]
pub struct Counted(f64);

impl Counted {
    /// The number of a double.
    pub fn new(value: f64) -> Self {
        Self(value)
    }

    /// The double.
    pub fn value(self) -> f64 {
        self.0
    }

    /// The result of some work, and the operations of this thread in it.
    pub fn during<R>(work: impl FnOnce() -> R) -> (R, u64) {
        let before = OPERATIONS.get();
        let result = work();
        (result, OPERATIONS.get() - before)
    }

    /// The result of an operation.
    fn of(result: f64) -> Self {
        OPERATIONS.set(OPERATIONS.get() + 1);
        Self(result)
    }
}

#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "the operators are wired for numbers of any size"
)]
impl Counted {
    fn plus(self, other: &Self) -> Self {
        let sum = self.0 + other.0;
        if self.0 == 0.0 || other.0 == 0.0 {
            Self(sum)
        } else {
            Self::of(sum)
        }
    }

    fn minus(self, other: &Self) -> Self {
        self.plus(&other.negative())
    }

    fn times(self, other: &Self) -> Self {
        let product = self.0 * other.0;
        if is_known(self.0) || is_known(other.0) {
            Self(product)
        } else {
            Self::of(product)
        }
    }

    fn over(self, other: &Self) -> Self {
        let quotient = self.0 / other.0;
        if self.0 == 0.0 || is_known(other.0) {
            Self(quotient)
        } else {
            Self::of(quotient)
        }
    }

    fn negative(self) -> Self {
        Self(-self.0)
    }
}

/// Whether a factor is zero, or one but for its sign.
#[allow(clippy::float_cmp, reason = "only the numbers themselves are meant")]
fn is_known(value: f64) -> bool {
    value == 0.0 || value.abs() == 1.0
}

ring_operators!(Counted);
division_operators!(Counted);

impl Zero for Counted {
    fn zero() -> Self {
        Self(0.0)
    }

    fn is_zero(&self) -> bool {
        self.0 == 0.0
    }
}

impl One for Counted {
    fn one() -> Self {
        Self(1.0)
    }
}

impl Field for Counted {
    fn rational(value: &Rational) -> Self {
        Self(value.to_f64())
    }

    fn undecided() -> Self {
        Self(f64::NAN)
    }

    fn is_decided(&self) -> bool {
        self.0.is_finite()
    }

    fn ratio(numerator: i64, denominator: i64) -> Self {
        Self(f64::ratio(numerator, denominator))
    }

    fn integer(value: i64) -> Self {
        Self(f64::integer(value))
    }
}

impl Roots for Counted {
    fn surd(value: &Surd) -> Self {
        Self(value.to_f64())
    }
}

impl Real for Counted {
    fn pi() -> Self {
        Self(f64::pi())
    }

    fn sqrt(&self) -> Self {
        Self::of(Real::sqrt(&self.0))
    }

    fn exp(&self) -> Self {
        Self::of(Real::exp(&self.0))
    }

    fn ln(&self) -> Self {
        Self::of(Real::ln(&self.0))
    }

    fn sin(&self) -> Self {
        Self::of(Real::sin(&self.0))
    }

    fn cos(&self) -> Self {
        Self::of(Real::cos(&self.0))
    }

    fn atan2(&self, x: &Self) -> Self {
        Self::of(Real::atan2(&self.0, &x.0))
    }

    fn stumpff(&self, k: usize) -> Self {
        Self::of(self.0.stumpff(k))
    }

    fn bits() -> u32 {
        f64::bits()
    }

    fn up_to(_: &Self) -> Self {
        Self(0.0)
    }
}

impl PartialOrd for Counted {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.0.partial_cmp(&other.0)
    }
}

impl fmt::Debug for Counted {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.0, formatter)
    }
}
