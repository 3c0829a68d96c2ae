//! Surds: sums of rational multiples of square roots, such as `1 + 3/2·√2`, exactly.
//!
//! Sums of square roots are compared without a tolerance.
//!
//! The points and weights of cubature rules are made of them. A surd is kept as a map from square-free radicands to
//! non-zero rational coefficients, and that form is unique, because the square roots of different square-free integers
//! are linearly independent over the rationals (Besicovitch 1940). So two surds are equal exactly if their maps are,
//! and a surd with a term is not zero: both are decided without any tolerance.
//!
//! What cannot be answered is [`Field::undecided`]: a division by zero, the root of a negative number, and a radicand
//! (of the result or on the way to it) that does not fit into 64 bits.

use super::operators::{division_operators, ring_operators};
use super::radicals::{Terms, add_term, bracket, product, quotient, rational_value, root_terms, single_term};
use super::rational::{nearest_double, sign_of};
use super::{Field, Rational, Roots, decimal};
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use std::cmp::Ordering;
use std::fmt;

/// An exact sum of rational multiples of square roots, or the statement that an operation had no answer.
///
/// Example: √8 · √3 = 2√6, a denominator that is made rational, and an order without a tolerance.
///
/// ```
/// use immaculate::number::{Field, Rational, Surd};
///
/// let root = |n| Surd::root(&Rational::integer(n));
/// assert_eq!(root(8) * root(3), Surd::integer(2) * root(6));
/// assert_eq!((Surd::integer(1) / (root(2) - Surd::integer(1))).to_string(), "√2 + 1");
/// assert!(root(2) + root(3) > Surd::ratio(314, 100));
/// assert_eq!(root(2).to_decimal(30), "1.414213562373095048801688724210");
/// ```
#[derive(Clone)]
pub struct Surd {
    /// The terms; none at all for zero, and `None` for undecided.
    terms: Option<Terms>,
}

impl Surd {
    /// The square root of a rational; undecided if it is negative (or undecided itself), or if its radicand is too
    /// large.
    ///
    /// The root of a square is found whatever its size. For any other p/q in lowest terms, p and q must fit into
    /// 128 bits, and the square-free part of their product into 64.
    pub fn root(value: &Rational) -> Self {
        Self {
            terms: value.value().and_then(root_terms),
        }
    }

    /// Whether the number has an answer at all.
    pub fn is_decided(&self) -> bool {
        self.terms.is_some()
    }

    /// The number as a rational; `None` if it is irrational or undecided.
    pub fn as_rational(&self) -> Option<Rational> {
        let terms = self.terms.as_ref()?;
        rational_value(terms).map(Rational::from_big)
    }

    /// Whether the number is below, equal to or above zero; `None` if undecided.
    pub fn sign(&self) -> Option<Ordering> {
        self.round(sign_of)
    }

    /// Whether the number is above zero; false if undecided.
    pub fn is_positive(&self) -> bool {
        self.sign() == Some(Ordering::Greater)
    }

    /// The number without its sign.
    #[must_use]
    pub fn abs(&self) -> Self {
        if self.sign() == Some(Ordering::Less) {
            self.negative()
        } else {
            self.clone()
        }
    }

    /// The double nearest to the number, ties to the even one; NaN if undecided. See [`Rational::to_f64`].
    pub fn to_f64(&self) -> f64 {
        // The bits are compared, since −0.0 and 0.0 are different answers.
        self.round(|value| nearest_double(value).to_bits())
            .map_or(f64::NAN, f64::from_bits)
    }

    /// The decimal nearest to the number with a number of digits after the point.
    pub fn to_decimal(&self, digits: u32) -> String {
        match self.round(|value| decimal::nearest(value, digits)) {
            Some(scaled) => decimal::write(&scaled, digits),
            None => self.to_string(),
        }
    }

    /// The result of rounding the number by a rule that is written for rationals and monotone; `None` if undecided.
    ///
    /// An irrational number is bracketed between two rationals, closer and closer, until both round to the same. This
    /// ends: the result changes only at rational numbers (zero, for the sign; the middle of two doubles, for the
    /// nearest double), the number is not among them, and so a bracket that is small enough contains none.
    fn round<R: PartialEq>(&self, rounding: impl Fn(&BigRational) -> R) -> Option<R> {
        let terms = self.terms.as_ref()?;
        if let Some(rational) = rational_value(terms) {
            return Some(rounding(&rational));
        }
        let mut bits = 64;
        loop {
            let (lower, upper) = bracket(terms, bits);
            let (low, high) = (rounding(&lower), rounding(&upper));
            if low == high {
                return Some(low);
            }
            bits *= 2;
        }
    }

    /// The sum.
    fn plus(&self, other: &Self) -> Self {
        self.combine(other, |left, right| {
            let mut sum = left.clone();
            for (&radicand, coefficient) in right {
                add_term(&mut sum, radicand, coefficient.clone());
            }
            Some(sum)
        })
    }

    /// The difference.
    fn minus(&self, other: &Self) -> Self {
        self.combine(other, |left, right| {
            let mut difference = left.clone();
            for (&radicand, coefficient) in right {
                add_term(&mut difference, radicand, -coefficient);
            }
            Some(difference)
        })
    }

    /// The product.
    fn times(&self, other: &Self) -> Self {
        self.combine(other, product)
    }

    /// The quotient; undecided if the divisor is zero.
    fn over(&self, other: &Self) -> Self {
        self.combine(other, quotient)
    }

    /// The number with the other sign.
    fn negative(&self) -> Self {
        let negated = |terms: &Terms| terms.iter().map(|(&r, c)| (r, -c)).collect();
        Self {
            terms: self.terms.as_ref().map(negated),
        }
    }

    /// A function of two numbers; undecided if either number is, or if the function has no answer.
    fn combine(&self, other: &Self, function: impl Fn(&Terms, &Terms) -> Option<Terms>) -> Self {
        let terms = match (&self.terms, &other.terms) {
            (Some(left), Some(right)) => function(left, right),
            _ => None,
        };
        Self { terms }
    }

    /// The terms, from square-free radicands to coefficients; `None` if undecided.
    pub(super) fn terms(&self) -> Option<&Terms> {
        self.terms.as_ref()
    }

    /// The terms for printing, each with whether it is negative and the text of its magnitude, the rational one last.
    pub(super) fn printed_terms(&self) -> Vec<(bool, String)> {
        let printed = |(&radicand, coefficient): (&u64, &BigRational)| {
            let magnitude = coefficient.abs();
            let text = match (radicand, magnitude.is_one()) {
                (1, _) => magnitude.to_string(),
                (_, true) => format!("√{radicand}"),
                (_, false) => format!("{magnitude}·√{radicand}"),
            };
            (coefficient.is_negative(), text)
        };
        self.terms.iter().flatten().rev().map(printed).collect()
    }
}

ring_operators!(Surd);
division_operators!(Surd);

impl Zero for Surd {
    fn zero() -> Self {
        Self {
            terms: Some(Terms::new()),
        }
    }

    fn is_zero(&self) -> bool {
        self.terms.as_ref().is_some_and(Terms::is_empty)
    }
}

impl One for Surd {
    fn one() -> Self {
        Self::integer(1)
    }
}

impl Field for Surd {
    fn rational(value: &Rational) -> Self {
        Self {
            terms: value.value().map(|value| single_term(1, value.clone())),
        }
    }

    fn undecided() -> Self {
        Self { terms: None }
    }

    fn is_decided(&self) -> bool {
        self.terms.is_some()
    }
}

impl Roots for Surd {
    fn surd(value: &Surd) -> Self {
        value.clone()
    }
}

impl PartialEq for Surd {
    /// Equality of numbers; an undecided one equals nothing, itself included.
    fn eq(&self, other: &Self) -> bool {
        match (&self.terms, &other.terms) {
            (Some(left), Some(right)) => left == right,
            _ => false,
        }
    }
}

impl PartialOrd for Surd {
    /// The exact order of numbers, however near; `None` if either is undecided.
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.minus(other).sign()
    }
}

impl fmt::Display for Surd {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_decided() {
            formatter.pad(&sum_text(&self.printed_terms()))
        } else {
            formatter.pad("undecided")
        }
    }
}

impl fmt::Debug for Surd {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, formatter)
    }
}

/// A sum as text, from the sign and the magnitude of each term; "0" without terms.
pub(super) fn sum_text(terms: &[(bool, String)]) -> String {
    let mut text = String::new();
    for (index, (negative, magnitude)) in terms.iter().enumerate() {
        text += match (index, negative) {
            (0, false) => "",
            (0, true) => "-",
            (_, false) => " + ",
            (_, true) => " - ",
        };
        text += magnitude;
    }
    if text.is_empty() {
        text += "0";
    }
    text
}
