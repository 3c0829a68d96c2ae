//! The constant operations of a formula, and their exact values.
//!
//! A division is refused if it is known to have no result.
//!
//! What depends on no name, on no value of π and on no function at an argument where it is irrational is a rational number, and is
//! computed exactly. A constant whose numerator and denominator have more than a few thousand bits is not followed further.

use super::Operation;
use super::error::Fault;
use super::name::Elementary;
use crate::number::{Field, Rational};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Zero};
use std::cmp::Ordering;

/// The bits of the largest constant that is followed.
const MOST_BITS: u64 = 4096;

/// The exact values of the operations before this one, where they are known.
pub(super) type Constants = Vec<Option<Rational>>;

/// The exact value of an operation, if it is known: `definitions` are the operations that definitions stand for.
pub(super) fn constant(
    operation: &Operation,
    constants: &Constants,
    definitions: &[usize],
) -> Result<Option<Rational>, Fault> {
    let of = |index: &usize| constants[*index].clone();
    let both = |a: &usize, b: &usize, of_both: fn(Rational, Rational) -> Rational| Some(of_both(of(a)?, of(b)?));
    let value = match operation {
        Operation::Integer(value) => Some(Rational::integer(*value)),
        Operation::Number(value) => Some(value.clone()),
        Operation::Name(_) => None,
        Operation::Definition(index) => of(&definitions[*index]),
        Operation::Sum(a, b) => both(a, b, |a, b| a + b),
        Operation::Difference(a, b) => both(a, b, |a, b| a - b),
        // Zero times a number that varies is zero as well.
        Operation::Product(a, b) if [a, b].iter().any(|index| is_zero(constants, **index)) => Some(Rational::zero()),
        Operation::Product(a, b) => both(a, b, |a, b| a * b),
        Operation::Quotient(_, b) if is_zero(constants, *b) => return Err(Fault::DivisionByZero),
        Operation::Quotient(a, b) => both(a, b, |a, b| a / b),
        Operation::Negative(a) => of(a).map(|value| -value),
        Operation::Power(_, 0) => Some(Rational::one()),
        Operation::Power(a, exponent) if *exponent < 0 && is_zero(constants, *a) => return Err(Fault::DivisionByZero),
        Operation::Power(a, exponent) => of(a).and_then(|value| power(&value, *exponent)),
        Operation::Call(function, arguments) => {
            let arguments: Option<Vec<Rational>> = arguments.iter().map(of).collect();
            match arguments {
                Some(arguments) => call(*function, &arguments)?,
                None => None,
            }
        }
    };
    Ok(value.filter(|value| bits(value) <= MOST_BITS))
}

fn is_zero(constants: &Constants, index: usize) -> bool {
    constants[index].as_ref().is_some_and(Rational::is_zero)
}

/// The bits of numerator and denominator together.
fn bits(value: &Rational) -> u64 {
    value
        .value()
        .map_or(u64::MAX, |value| value.numer().bits() + value.denom().bits())
}

/// A power. The exponent is small, so that it has no more than a few ten thousand bits before it is given up.
fn power(value: &Rational, exponent: i64) -> Option<Rational> {
    let power = value.pow(u32::try_from(exponent.unsigned_abs()).ok()?);
    Some(if exponent < 0 { Rational::one() / power } else { power })
}

/// A function at rational arguments, where its value is rational.
fn call(function: Elementary, arguments: &[Rational]) -> Result<Option<Rational>, Fault> {
    let (zero, one) = (Rational::zero(), Rational::one());
    let no_value = || Err(Fault::NoValue(function.name()));
    let value = match (function, arguments) {
        (Elementary::Sqrt, [x]) if *x < zero => return no_value(),
        (Elementary::Sqrt, [x]) => root(x),
        (Elementary::Hypot, [x, y]) => root(&(x * x + y * y)),
        (Elementary::Ln, [x]) if *x <= zero => return no_value(),
        (Elementary::Ln, [x]) if *x == one => Some(zero),
        (Elementary::Exp | Elementary::Cos, [x]) if *x == zero => Some(one),
        (Elementary::Sin | Elementary::Tan, [x]) if *x == zero => Some(zero),
        (Elementary::Atan2, [y, x]) if *y == zero => match x.sign() {
            Some(Ordering::Greater) => Some(zero),
            Some(Ordering::Equal) => return no_value(),
            _ => None,
        },
        (Elementary::Stumpff(k), [t]) if *t == zero => {
            let factorial: BigInt = (1..=k).map(BigInt::from).product();
            Some(one / Rational::from_integer(factorial))
        }
        _ => None,
    };
    Ok(value)
}

/// The square root, if it is rational.
fn root(value: &Rational) -> Option<Rational> {
    let value = value.value()?;
    let (numerator, denominator) = (value.numer().sqrt(), value.denom().sqrt());
    let is_exact = &numerator * &numerator == *value.numer() && &denominator * &denominator == *value.denom();
    is_exact.then(|| Rational::from_big(BigRational::new(numerator, denominator)))
}
