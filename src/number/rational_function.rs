//! Rational functions of named unknowns: the number system that proves an identity for all inputs.
//!
//! Running code on them proves an identity.
//!
//! An equation that is evaluated on unknowns gives a fraction of polynomials, and two of these are equal exactly if
//! a · d = c · b for a/b and c/d. So an identity is proven by running the code of its two sides. No greatest common
//! divisor is needed for that; a few cheap simplifications keep the polynomials small.

use super::operators::{division_operators, ring_operators};
use super::{Field, Polynomial, Rational, Roots, Surd};
use num_traits::{One, Zero};
use std::fmt;

/// A fraction of two polynomials, or the statement that an operation had no answer.
///
/// Example: (n² − 1)/(n − 1) is n + 1 for every n, and a function has no value where its denominator is zero.
///
/// ```
/// use immaculate::number::{Field, Rational, RationalFunction};
///
/// let n = RationalFunction::unknown("n");
/// let one = RationalFunction::integer(1);
/// let ratio = (n.clone() + RationalFunction::integer(2)) / (n.clone() - one.clone());
/// assert_eq!(ratio.to_string(), "(n + 2)/(n - 1)");
/// assert_eq!((n.clone() * n.clone() - one.clone()) / (n.clone() - one.clone()), n + one);
/// assert_eq!(ratio.evaluate(&[("n", Rational::integer(4))]).unwrap().to_string(), "2");
/// assert!(ratio.evaluate(&[("n", Rational::integer(1))]).is_none());
/// ```
#[derive(Clone)]
pub struct RationalFunction {
    /// The polynomial above the line; undecided if the whole is.
    numerator: Polynomial,
    /// The polynomial below the line; never zero and never undecided, with one as its leading coefficient.
    denominator: Polynomial,
}

impl RationalFunction {
    /// The unknown of that name.
    pub fn unknown(name: &str) -> Self {
        Self::from_polynomial(Polynomial::unknown(name))
    }

    /// A polynomial as a fraction.
    pub fn from_polynomial(numerator: Polynomial) -> Self {
        Self {
            numerator,
            denominator: Polynomial::one(),
        }
    }

    /// The fraction of two polynomials; undecided if the denominator is zero or either of them is undecided.
    pub fn new(numerator: Polynomial, denominator: Polynomial) -> Self {
        // A zero and an undecided denominator have no leading coefficient.
        let Some(leading) = denominator.leading_coefficient() else {
            return Self::undecided();
        };
        if numerator.is_zero() {
            return Self::zero();
        }
        if numerator == denominator {
            return Self::one();
        }
        // Neither of the following steps is needed for an exact result; both keep the polynomials small.
        let (numerator, denominator) = if leading.is_one() {
            (numerator, denominator)
        } else {
            let factor = Polynomial::constant(&(Surd::one() / leading.clone()));
            (&numerator * &factor, &denominator * &factor)
        };
        if !numerator.is_decided() || !denominator.is_decided() {
            return Self::undecided();
        }
        let common = numerator.common_monomial(&denominator);
        if common.is_empty() {
            return Self { numerator, denominator };
        }
        Self {
            numerator: numerator.without_monomial(&common),
            denominator: denominator.without_monomial(&common),
        }
    }

    /// The polynomial above the line.
    pub fn numerator(&self) -> &Polynomial {
        &self.numerator
    }

    /// The polynomial below the line. It is not zero.
    pub fn denominator(&self) -> &Polynomial {
        &self.denominator
    }

    /// The exact value where the unknowns have the given values; `None` if one of them is not given, if the denominator
    /// is zero there, or if the function is undecided.
    ///
    /// A common factor that has been cancelled is gone: `(n · n)/n` has the value 0 at n = 0.
    pub fn evaluate(&self, assignments: &[(&str, Rational)]) -> Option<Surd> {
        let numerator = self.numerator.evaluate(assignments)?;
        let denominator = self.denominator.evaluate(assignments)?;
        Some(numerator / denominator).filter(Surd::is_decided)
    }

    /// The value, in any number system with roots, where the unknowns have the given values; undecided if one of them
    /// is not given.
    pub fn substitute<T: Roots>(&self, assignments: &[(&str, T)]) -> T {
        self.numerator.substitute(assignments) / self.denominator.substitute(assignments)
    }

    /// Whether the function has an answer at all.
    pub fn is_decided(&self) -> bool {
        self.numerator.is_decided()
    }

    /// The sum.
    fn plus(&self, other: &Self) -> Self {
        if self.denominator == other.denominator {
            return Self::new(&self.numerator + &other.numerator, self.denominator.clone());
        }
        Self::new(
            &self.numerator * &other.denominator + &other.numerator * &self.denominator,
            &self.denominator * &other.denominator,
        )
    }

    /// The difference.
    fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negative())
    }

    /// The product. A numerator that equals the other fraction's denominator is cancelled.
    fn times(&self, other: &Self) -> Self {
        if self.numerator == other.denominator {
            return Self::new(other.numerator.clone(), self.denominator.clone());
        }
        if self.denominator == other.numerator {
            return Self::new(self.numerator.clone(), other.denominator.clone());
        }
        Self::new(
            &self.numerator * &other.numerator,
            &self.denominator * &other.denominator,
        )
    }

    /// The quotient; undecided if the divisor is zero.
    fn over(&self, other: &Self) -> Self {
        self.times(&Self::new(other.denominator.clone(), other.numerator.clone()))
    }

    /// The function with the other sign.
    fn negative(&self) -> Self {
        Self {
            numerator: -&self.numerator,
            denominator: self.denominator.clone(),
        }
    }
}

ring_operators!(RationalFunction);
division_operators!(RationalFunction);

impl Zero for RationalFunction {
    fn zero() -> Self {
        Self::from_polynomial(Polynomial::zero())
    }

    fn is_zero(&self) -> bool {
        self.numerator.is_zero()
    }
}

impl One for RationalFunction {
    fn one() -> Self {
        Self::from_polynomial(Polynomial::one())
    }
}

impl Field for RationalFunction {
    fn rational(value: &Rational) -> Self {
        Self::surd(&Surd::rational(value))
    }

    fn undecided() -> Self {
        Self::from_polynomial(Polynomial::undecided())
    }

    fn is_decided(&self) -> bool {
        Self::is_decided(self)
    }
}

impl Roots for RationalFunction {
    fn surd(value: &Surd) -> Self {
        Self::from_polynomial(Polynomial::constant(value))
    }
}

impl PartialEq for RationalFunction {
    /// Equality as fractions: a/b = c/d if a · d = c · b. An undecided one equals nothing, itself included.
    fn eq(&self, other: &Self) -> bool {
        if self.denominator == other.denominator {
            return self.numerator == other.numerator;
        }
        &self.numerator * &other.denominator == &other.numerator * &self.denominator
    }
}

impl fmt::Display for RationalFunction {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let above = self.numerator.to_string();
        if !self.numerator.is_decided() || self.denominator.is_one() {
            return formatter.pad(&above);
        }
        let below = self.denominator.to_string();
        let above = in_brackets_if(above.contains([' ', '/']), above);
        let below = in_brackets_if(below.contains([' ', '·']), below);
        formatter.pad(&format!("{above}/{below}"))
    }
}

impl fmt::Debug for RationalFunction {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, formatter)
    }
}

/// The text, with brackets around it if they are needed.
fn in_brackets_if(needed: bool, text: String) -> String {
    if needed { format!("({text})") } else { text }
}
