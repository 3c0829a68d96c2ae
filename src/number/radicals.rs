//! The terms of a surd and their arithmetic.
//!
//! Four short algorithms do everything that square roots need.
//!
//! - [`product`]: √a · √b = g · √(ab/g²) with g = gcd(a, b).
//! - [`quotient`]: a denominator becomes rational when it is multiplied by its conjugates.
//! - [`bracket`]: rationals below and above, as near as asked, from integer square roots.
//! - [`root_terms`]: √(p/q) in canonical form, by trial division.
//!
//! Everything is exact; `None` stands for what has no answer, and becomes the surd that says so.

use num_bigint::BigInt;
use num_integer::{Integer, Roots};
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use std::collections::BTreeMap;

/// The terms of a surd: the coefficient of √r for each square-free r. No coefficient is zero.
pub(super) type Terms = BTreeMap<u64, BigRational>;

/// How far divisors are tried when the square part of a number is sought.
///
/// A number without a divisor up to here that is below the cube of this limit, 2⁶⁶, has at most two prime factors, so
/// it is square-free or a square. One that is above counts as too large for a radicand, unless it is a square.
const LARGEST_TRIAL_DIVISOR: u128 = 1 << 22;

/// The terms of `coefficient · √radicand`: none if the coefficient is zero.
pub(super) fn single_term(radicand: u64, coefficient: BigRational) -> Terms {
    let mut terms = Terms::new();
    add_term(&mut terms, radicand, coefficient);
    terms
}

/// Adds `coefficient · √radicand` to a sum, and removes the term if it becomes zero.
pub(super) fn add_term(sum: &mut Terms, radicand: u64, coefficient: BigRational) {
    let total = match sum.remove(&radicand) {
        Some(present) => present + coefficient,
        None => coefficient,
    };
    if !total.is_zero() {
        sum.insert(radicand, total);
    }
}

/// The number as a rational, if it has no term but the rational one.
pub(super) fn rational_value(terms: &Terms) -> Option<BigRational> {
    match (terms.len(), terms.get(&1)) {
        (0, _) => Some(BigRational::zero()),
        (1, Some(rational)) => Some(rational.clone()),
        _ => None,
    }
}

/// The product, term by term: √a · √b = g · √(a/g · b/g) with g = gcd(a, b).
///
/// a/g and b/g are square-free and have no common factor, so the new radicand is square-free again.
pub(super) fn product(left: &Terms, right: &Terms) -> Option<Terms> {
    let mut sum = Terms::new();
    for (&a, left_coefficient) in left {
        for (&b, right_coefficient) in right {
            let g = a.gcd(&b);
            let radicand = (a / g).checked_mul(b / g)?;
            let mut coefficient = left_coefficient * right_coefficient;
            if g != 1 {
                coefficient *= BigInt::from(g);
            }
            add_term(&mut sum, radicand, coefficient);
        }
    }
    Some(sum)
}

/// The quotient: numerator and denominator are multiplied by conjugates of the denominator until that is rational.
///
/// Let d be a factor as [`factor_to_remove`] finds it, and write the denominator as u + v·√d with no d left in u and v.
/// Then (u + v·√d)(u − v·√d) = u² − d·v² has no term with d, and is not zero because neither factor is. Each step
/// removes at least one prime from the radicands of the denominator, so there are finitely many.
pub(super) fn quotient(numerator: &Terms, denominator: &Terms) -> Option<Terms> {
    let (mut numerator, mut denominator) = (numerator.clone(), denominator.clone());
    while let Some(d) = factor_to_remove(&denominator) {
        let conjugate: Terms = denominator
            .iter()
            .map(|(&r, c)| (r, if r.is_multiple_of(d) { -c } else { c.clone() }))
            .collect();
        numerator = product(&numerator, &conjugate)?;
        denominator = product(&denominator, &conjugate)?;
    }
    // What is left has a rational term only, or none if it was zero from the start.
    let divisor = denominator.get(&1)?;
    Some(numerator.iter().map(|(&r, c)| (r, c / divisor)).collect())
}

/// A factor d > 1 of some radicand such that each radicand is either a multiple of d or has no factor in common with
/// it; `None` if the number is rational.
///
/// Such a factor can be treated like a prime, and is found without factoring: starting from a radicand, any common
/// factor with another radicand that is neither 1 nor all of it is a smaller candidate.
fn factor_to_remove(terms: &Terms) -> Option<u64> {
    let mut factor = *terms.keys().find(|&&radicand| radicand != 1)?;
    while let Some(smaller) = terms
        .keys()
        .map(|radicand| radicand.gcd(&factor))
        .find(|&common| common != 1 && common != factor)
    {
        factor = smaller;
    }
    Some(factor)
}

/// Rationals below and above the number, closer together with more bits.
///
/// |p/q|·√r = √(p²·r·4ᵏ) / (q·2ᵏ), and the integer square root s of p²·r·4ᵏ is at most that root and less than one
/// below it.
pub(super) fn bracket(terms: &Terms, bits: u32) -> (BigRational, BigRational) {
    let mut lower = BigRational::zero();
    let mut upper = BigRational::zero();
    for (&radicand, coefficient) in terms {
        if radicand == 1 {
            lower += coefficient;
            upper += coefficient;
            continue;
        }
        let numerator = coefficient.numer();
        let scaled: BigInt = (numerator * numerator * radicand) << (2 * bits);
        let root = scaled.sqrt();
        let denominator: BigInt = coefficient.denom() << bits;
        let below = BigRational::new(root.clone(), denominator.clone());
        let above = BigRational::new(root + 1u8, denominator);
        if coefficient.is_positive() {
            lower += below;
            upper += above;
        } else {
            lower -= above;
            upper -= below;
        }
    }
    (lower, upper)
}

/// The terms of the square root of a rational.
pub(super) fn root_terms(value: &BigRational) -> Option<Terms> {
    if value.is_negative() {
        return None;
    }
    // √(p/q) = √(p·q) / q. In lowest terms p and q have no common factor, and so their square-free parts have none.
    let (p_root, p_radicand) = square_part(value.numer())?;
    let (q_root, q_radicand) = square_part(value.denom())?;
    let radicand = p_radicand.checked_mul(q_radicand)?;
    let coefficient = BigRational::new(p_root * q_root, value.denom().clone());
    Some(single_term(radicand, coefficient))
}

/// Writes a non-negative integer as s²·r with r square-free, and gives s and r.
///
/// `None` if r does not fit into 64 bits, or if the integer is not a square and does not fit into 128.
fn square_part(value: &BigInt) -> Option<(BigInt, u64)> {
    let root = value.sqrt();
    if &root * &root == *value {
        return Some((root, 1));
    }
    let mut rest = u128::try_from(value).ok()?;
    let mut square_root: u128 = 1;
    let mut radicand: u128 = 1;
    let mut divisor: u128 = 2;
    // All divisors are tried up to the cube root of what is left. That then has at most two prime factors, so it is
    // either square-free or the square of a prime.
    while divisor <= LARGEST_TRIAL_DIVISOR && divisor * divisor * divisor <= rest {
        while rest.is_multiple_of(divisor * divisor) {
            rest /= divisor * divisor;
            square_root *= divisor;
        }
        if rest.is_multiple_of(divisor) {
            rest /= divisor;
            radicand *= divisor;
        }
        divisor += 1;
    }
    let rest_root = rest.sqrt();
    if rest_root * rest_root == rest {
        square_root *= rest_root;
    } else {
        // A rest above 2⁶⁶ may still hide a square; as a radicand it is taken to be too large in any case.
        radicand = radicand.checked_mul(rest)?;
    }
    Some((square_root.into(), u64::try_from(radicand).ok()?))
}
