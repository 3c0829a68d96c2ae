//! Exact rational numbers, the basis of every proof without a tolerance.
//!
//! A double is read exactly, and the nearest double is written.
//!
//! [`Rational`] is the fraction of two integers of any size, in lowest terms. What it adds to the number it wraps:
//! division by zero is a value ([`Field::undecided`]) and not a panic, a double goes in exactly
//! ([`Rational::from_f64`]) and comes out as the nearest one ([`Rational::to_f64`]), and a decimal is read exactly
//! ([`Rational::from_decimal`]).

use super::operators::{division_operators, ring_operators};
use super::{Field, decimal};
use num_bigint::{BigInt, Sign};
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::cmp::Ordering;
use std::fmt;

/// An exact rational number, or the statement that an operation had no answer.
///
/// Example: thirds are thirds, decimals are what they say, and a division by zero is a value.
///
/// ```
/// use immaculate::number::{Field, Rational};
///
/// let third = Rational::new(1, 3);
/// assert_eq!(third.clone() + third.clone() + third.clone(), Rational::integer(1));
/// assert_eq!(Rational::from_decimal("-1.5e-1").unwrap().to_string(), "-3/20");
///
/// // A division by zero is a value: unequal to everything, itself included.
/// let undecided = third / Rational::integer(0);
/// assert_ne!(undecided, undecided.clone());
/// assert_eq!(undecided.to_string(), "undecided");
/// ```
#[derive(Clone)]
pub struct Rational {
    /// The number in lowest terms with a positive denominator; `None` is undecided.
    value: Option<BigRational>,
}

impl Rational {
    /// The fraction `numerator / denominator`; undecided if the denominator is zero.
    pub fn new(numerator: i64, denominator: i64) -> Self {
        if denominator == 0 {
            return Self::undecided();
        }
        Self::from_big(BigRational::new(numerator.into(), denominator.into()))
    }

    /// An integer of any size.
    pub fn from_integer(value: BigInt) -> Self {
        Self::from_big(BigRational::from_integer(value))
    }

    /// A fraction of integers of any size; undecided if its denominator is zero.
    pub fn from_big(value: BigRational) -> Self {
        // `BigRational::new_raw` can make a fraction that is not in lowest terms, or has no value.
        let (numerator, denominator) = value.into_raw();
        let value = (!denominator.is_zero()).then(|| BigRational::new(numerator, denominator));
        Self { value }
    }

    /// The exact value of a double; undecided for an infinity or a NaN.
    pub fn from_f64(value: f64) -> Self {
        Self {
            value: BigRational::from_float(value),
        }
    }

    /// The exact value of a decimal such as `0.1`, `-1e-3` or `+12.50E2`.
    ///
    /// `None` if the text is anything else, longer than 10 000 characters, or if its power of ten is beyond ±10 000.
    pub fn from_decimal(text: &str) -> Option<Self> {
        decimal::read(text).map(Self::from_big)
    }

    /// The number itself; `None` if undecided.
    pub fn value(&self) -> Option<&BigRational> {
        self.value.as_ref()
    }

    /// Whether the number has an answer at all.
    pub fn is_decided(&self) -> bool {
        self.value.is_some()
    }

    /// The double nearest to the number, ties to the even one; NaN if undecided.
    ///
    /// As everywhere in IEEE 754, what is nearer to zero than half the smallest double becomes a zero of the same sign,
    /// and what is beyond the largest double by half a unit in its last place or more becomes infinite.
    pub fn to_f64(&self) -> f64 {
        self.value.as_ref().map_or(f64::NAN, nearest_double)
    }

    /// The decimal nearest to the number with a number of digits after the point, ties to the even last digit.
    ///
    /// Example: −2/3 to four digits.
    ///
    /// ```
    /// use immaculate::number::Rational;
    ///
    /// assert_eq!(Rational::new(-2, 3).to_decimal(4), "-0.6667");
    /// ```
    pub fn to_decimal(&self, digits: u32) -> String {
        match &self.value {
            Some(value) => decimal::write(&decimal::nearest(value, digits), digits),
            None => self.to_string(),
        }
    }

    /// The number without its sign.
    #[must_use]
    pub fn abs(&self) -> Self {
        self.map(Signed::abs)
    }

    /// Whether the number is below, equal to or above zero; `None` if undecided.
    pub fn sign(&self) -> Option<Ordering> {
        self.value.as_ref().map(sign_of)
    }

    /// Whether the number is above zero; false if undecided.
    pub fn is_positive(&self) -> bool {
        self.sign() == Some(Ordering::Greater)
    }

    /// The number raised to a power; the power zero of every decided number is one.
    #[must_use]
    pub fn pow(&self, exponent: u32) -> Self {
        // Powers of numbers without a common factor have none either, so the fraction stays in lowest terms.
        self.map(|value| BigRational::new_raw(value.numer().pow(exponent), value.denom().pow(exponent)))
    }

    /// The sum.
    fn plus(&self, other: &Self) -> Self {
        self.combine(other, |left, right| Some(left + right))
    }

    /// The difference.
    fn minus(&self, other: &Self) -> Self {
        self.combine(other, |left, right| Some(left - right))
    }

    /// The product.
    fn times(&self, other: &Self) -> Self {
        self.combine(other, |left, right| Some(left * right))
    }

    /// The quotient; undecided if the divisor is zero.
    fn over(&self, other: &Self) -> Self {
        self.combine(other, |left, right| (!right.is_zero()).then(|| left / right))
    }

    /// The number with the other sign.
    fn negative(&self) -> Self {
        self.map(|value| -value)
    }

    /// A function of the number; undecided if the number is.
    fn map(&self, function: impl Fn(&BigRational) -> BigRational) -> Self {
        Self {
            value: self.value.as_ref().map(function),
        }
    }

    /// A function of two numbers; undecided if either number is, or if the function has no answer.
    fn combine(&self, other: &Self, function: impl Fn(&BigRational, &BigRational) -> Option<BigRational>) -> Self {
        let value = match (&self.value, &other.value) {
            (Some(left), Some(right)) => function(left, right),
            _ => None,
        };
        Self { value }
    }
}

ring_operators!(Rational);
division_operators!(Rational);

impl Zero for Rational {
    fn zero() -> Self {
        Self::from_big(BigRational::zero())
    }

    fn is_zero(&self) -> bool {
        self.sign() == Some(Ordering::Equal)
    }
}

impl One for Rational {
    fn one() -> Self {
        Self::from_big(BigRational::one())
    }
}

impl Field for Rational {
    fn rational(value: &Rational) -> Self {
        value.clone()
    }

    fn undecided() -> Self {
        Self { value: None }
    }

    fn is_decided(&self) -> bool {
        self.value.is_some()
    }
}

impl PartialEq for Rational {
    /// Equality of numbers; an undecided one equals nothing, itself included.
    fn eq(&self, other: &Self) -> bool {
        match (&self.value, &other.value) {
            (Some(left), Some(right)) => left == right,
            _ => false,
        }
    }
}

impl PartialOrd for Rational {
    /// The order of numbers; `None` if either is undecided.
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.value.as_ref()?.cmp(other.value.as_ref()?))
    }
}

impl fmt::Display for Rational {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.value {
            Some(value) => fmt::Display::fmt(value, formatter),
            None => formatter.pad("undecided"),
        }
    }
}

impl fmt::Debug for Rational {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, formatter)
    }
}

/// Whether a number is below, equal to or above zero.
pub(super) fn sign_of(value: &BigRational) -> Ordering {
    value.numer().sign().cmp(&Sign::NoSign)
}

/// The double nearest to a number, ties to the even one.
///
/// num-rational divides the integers exactly and rounds once, among the subnormal doubles too; the test
/// `the_double_of_a_rational_is_the_nearest_one` holds it to that.
pub(super) fn nearest_double(value: &BigRational) -> f64 {
    value.to_f64().unwrap_or(f64::NAN)
}
