//! Polynomials in named unknowns, with surds as coefficients.
//!
//! Polynomials have a canonical form: two of them are equal exactly if they are written the same.
//!
//! They are the numerators and denominators of [`RationalFunction`](super::RationalFunction), the number system in
//! which an identity is proven for all values of its unknowns at once. A polynomial is kept as a map from monomials to
//! non-zero coefficients, and that form is unique: two polynomials are equal, as functions too, exactly if their maps
//! are.

use super::operators::ring_operators;
use super::surd::sum_text;
use super::{Field, Rational, Roots, Surd};
use num_traits::{One, Zero};
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// A product of powers of unknowns: the exponent of each name. No exponent is zero; one is the empty product.
pub(super) type Monomial = BTreeMap<Arc<str>, u32>;

/// The coefficient of each monomial. Every coefficient is decided, and none is zero.
type Terms = BTreeMap<Monomial, Surd>;

/// The degree of a monomial, and the exponent of each name: what printed terms are sorted by.
type PrintingOrder = (Reverse<u64>, Vec<(Arc<str>, Reverse<u32>)>);

/// A polynomial in named unknowns, or the statement that an operation had no answer.
///
/// Example: (x + y)² is multiplied out, and evaluated at ½ and 5/2.
///
/// ```
/// use immaculate::number::{Polynomial, Rational};
///
/// let (x, y) = (Polynomial::unknown("x"), Polynomial::unknown("y"));
/// let square = (&x + &y) * (&x + &y);
/// assert_eq!(square, &x * &x + &x * &y + &y * &x + &y * &y);
/// assert_eq!((&x * &x - y).to_string(), "x^2 - y");
/// let value = square.evaluate(&[("x", Rational::new(1, 2)), ("y", Rational::new(5, 2))]);
/// assert_eq!(value.unwrap().to_string(), "9");
/// ```
#[derive(Clone)]
pub struct Polynomial {
    /// The terms; none at all for zero, and `None` for undecided.
    terms: Option<Terms>,
}

impl Polynomial {
    /// The unknown of that name.
    pub fn unknown(name: &str) -> Self {
        Self::from_term(Monomial::from([(Arc::from(name), 1)]), Surd::one())
    }

    /// The polynomial that has the same value everywhere; undecided if the value is.
    pub fn constant(value: &Surd) -> Self {
        Self::from_term(Monomial::new(), value.clone())
    }

    /// The polynomial that says that an operation had no answer; it is unequal to every polynomial, itself included.
    pub fn undecided() -> Self {
        Self { terms: None }
    }

    /// Whether the polynomial has an answer at all.
    pub fn is_decided(&self) -> bool {
        self.terms.is_some()
    }

    /// The exact value where the unknowns have the given values; `None` if one of them is not given, or if there is no
    /// decided value.
    pub fn evaluate(&self, assignments: &[(&str, Rational)]) -> Option<Surd> {
        let assignments: Vec<(&str, Surd)> = assignments
            .iter()
            .map(|(name, value)| (*name, Surd::rational(value)))
            .collect();
        Some(self.substitute(&assignments)).filter(Surd::is_decided)
    }

    /// The value, in any number system with roots, where the unknowns have the given values; undecided if one of them
    /// is not given.
    pub fn substitute<T: Roots>(&self, assignments: &[(&str, T)]) -> T {
        let Some(terms) = &self.terms else {
            return T::undecided();
        };
        let mut sum = T::zero();
        for (monomial, coefficient) in terms {
            let mut product = T::surd(coefficient);
            for (unknown, &exponent) in monomial {
                let Some((_, value)) = assignments.iter().find(|(name, _)| **name == **unknown) else {
                    return T::undecided();
                };
                product *= num_traits::pow(value.clone(), exponent as usize);
            }
            sum += product;
        }
        sum
    }

    /// The polynomial of one term.
    fn from_term(monomial: Monomial, coefficient: Surd) -> Self {
        let mut terms = Terms::new();
        Self {
            terms: add_term(&mut terms, monomial, coefficient).map(|()| terms),
        }
    }

    /// The sum.
    fn plus(&self, other: &Self) -> Self {
        self.combine(other, |left, right| {
            let mut sum = left.clone();
            for (monomial, coefficient) in right {
                add_term(&mut sum, monomial.clone(), coefficient.clone())?;
            }
            Some(sum)
        })
    }

    /// The difference.
    fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negative())
    }

    /// The product, term by term.
    fn times(&self, other: &Self) -> Self {
        self.combine(other, |left, right| {
            let mut sum = Terms::new();
            for (left_monomial, left_coefficient) in left {
                for (right_monomial, right_coefficient) in right {
                    let monomial = monomial_product(left_monomial, right_monomial)?;
                    add_term(&mut sum, monomial, left_coefficient * right_coefficient)?;
                }
            }
            Some(sum)
        })
    }

    /// The polynomial with the other sign.
    fn negative(&self) -> Self {
        let negated = |terms: &Terms| {
            let term = |(monomial, coefficient): (&Monomial, &Surd)| (monomial.clone(), -coefficient);
            terms.iter().map(term).collect()
        };
        Self {
            terms: self.terms.as_ref().map(negated),
        }
    }

    /// A function of two polynomials; undecided if either is, or if the function has no answer.
    fn combine(&self, other: &Self, function: impl Fn(&Terms, &Terms) -> Option<Terms>) -> Self {
        let terms = match (&self.terms, &other.terms) {
            (Some(left), Some(right)) => function(left, right),
            _ => None,
        };
        Self { terms }
    }

    /// The coefficient of the last monomial in the order of the map; `None` for zero and undecided.
    pub(super) fn leading_coefficient(&self) -> Option<&Surd> {
        self.terms.as_ref()?.values().next_back()
    }

    /// The largest monomial that divides every term of both polynomials.
    pub(super) fn common_monomial(&self, other: &Self) -> Monomial {
        let mut monomials = self.terms.iter().chain(&other.terms).flat_map(Terms::keys);
        let Some(first) = monomials.next() else {
            return Monomial::new();
        };
        let mut common = first.clone();
        for monomial in monomials {
            common.retain(|name, exponent| {
                *exponent = (*exponent).min(monomial.get(name).copied().unwrap_or(0));
                *exponent > 0
            });
        }
        common
    }

    /// The polynomial divided by a monomial that divides every one of its terms.
    pub(super) fn without_monomial(&self, divisor: &Monomial) -> Self {
        let quotient = |monomial: &Monomial| -> Monomial {
            let reduced = |(name, exponent): (&Arc<str>, &u32)| {
                let rest = exponent - divisor.get(name).copied().unwrap_or(0);
                (rest > 0).then(|| (name.clone(), rest))
            };
            monomial.iter().filter_map(reduced).collect()
        };
        let divided = |terms: &Terms| {
            let term = |(monomial, coefficient): (&Monomial, &Surd)| (quotient(monomial), coefficient.clone());
            terms.iter().map(term).collect()
        };
        Self {
            terms: self.terms.as_ref().map(divided),
        }
    }
}

ring_operators!(Polynomial);

impl Zero for Polynomial {
    fn zero() -> Self {
        Self::constant(&Surd::zero())
    }

    fn is_zero(&self) -> bool {
        self.terms.as_ref().is_some_and(Terms::is_empty)
    }
}

impl One for Polynomial {
    fn one() -> Self {
        Self::constant(&Surd::one())
    }
}

impl PartialEq for Polynomial {
    /// Equality as polynomials, and so as functions; an undecided one equals nothing, itself included.
    fn eq(&self, other: &Self) -> bool {
        match (&self.terms, &other.terms) {
            (Some(left), Some(right)) => left == right,
            _ => false,
        }
    }
}

impl fmt::Display for Polynomial {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.terms {
            Some(terms) => {
                let mut sorted: Vec<(&Monomial, &Surd)> = terms.iter().collect();
                sorted.sort_by_cached_key(|(monomial, _)| printing_order(monomial));
                let printed: Vec<(bool, String)> = sorted.into_iter().map(printed_term).collect();
                formatter.pad(&sum_text(&printed))
            }
            None => formatter.pad("undecided"),
        }
    }
}

impl fmt::Debug for Polynomial {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, formatter)
    }
}

/// Adds a term to a sum, and removes it if its coefficient becomes zero; `None` if that is undecided.
fn add_term(sum: &mut Terms, monomial: Monomial, coefficient: Surd) -> Option<()> {
    let total = match sum.remove(&monomial) {
        Some(present) => present + coefficient,
        None => coefficient,
    };
    if !total.is_decided() {
        return None;
    }
    if !total.is_zero() {
        sum.insert(monomial, total);
    }
    Some(())
}

/// The product of two monomials: exponents add. `None` if an exponent outgrows its type.
fn monomial_product(left: &Monomial, right: &Monomial) -> Option<Monomial> {
    let mut product = left.clone();
    for (name, exponent) in right {
        let total = product.entry(name.clone()).or_insert(0);
        *total = total.checked_add(*exponent)?;
    }
    Some(product)
}

/// The key by which terms are sorted for printing: high degrees first, then by names, then high powers first.
fn printing_order(monomial: &Monomial) -> PrintingOrder {
    let degree = monomial.values().map(|&exponent| u64::from(exponent)).sum();
    let powers = monomial
        .iter()
        .map(|(name, &exponent)| (name.clone(), Reverse(exponent)))
        .collect();
    (Reverse(degree), powers)
}

/// A term for printing: whether it is negative, and the text of its magnitude.
fn printed_term((monomial, coefficient): (&Monomial, &Surd)) -> (bool, String) {
    let power = |(name, exponent): (&Arc<str>, &u32)| match exponent {
        1 => name.to_string(),
        _ => format!("{name}^{exponent}"),
    };
    let powers: Vec<String> = monomial.iter().map(power).collect();
    let (negative, number) = match coefficient.printed_terms().as_slice() {
        [(negative, magnitude)] => (*negative, magnitude.clone()),
        _ => (false, format!("({coefficient})")),
    };
    let text = match (powers.is_empty(), number.as_str()) {
        (true, _) => number,
        (false, "1") => powers.join("·"),
        (false, _) => format!("{number}·{}", powers.join("·")),
    };
    (negative, text)
}
