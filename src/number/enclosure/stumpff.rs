//! The Stumpff functions on balls: their series near zero, circular and hyperbolic functions elsewhere.
//!
//! For a ball around zero, c_k is as narrow as the ball itself.
//!
//! ```text
//! c_k(t) = Σⱼ (−t)ʲ/(2j + k)!,      c_k = (1/(k−2)! − c₍k−2₎)/t,      c_k′ = ½(k c₍k+2₎ − c₍k+1₎)
//! ```
//!
//! The value at the midpoint is computed with the operations of balls, which count every rounding; only the remainder of the series
//! and the movement within the radius are derived here.
//!
//! Source: K. Stumpff, Himmelsmechanik I, 1959; the identities follow from the series term by term.

use super::arithmetic::Ball;
use super::bound::Bound;
use super::dyadic::Dyadic;
use super::elementary::{cos, exp, sin};
use num_bigint::BigInt;
use std::cmp::Ordering;

/// Bits beyond those of the result: the terms of the series cancel by less than a factor of 2⁵, and there are less than 2¹⁰ of them.
const GUARD: i64 = 24;

/// c_k(t); `None` if it would be beyond all exponents.
///
/// ```text
/// |c_k(T) − c_k(t)| ≤ r · sup |c_k′|
/// ```
///
/// Evidence: `stumpff_functions_contain_their_series_with_remainder`, `images_of_points_are_inside_the_image_of_the_ball`.
pub(super) fn stumpff(k: usize, t: &Ball, precision: i64) -> Option<Ball> {
    let k = i64::try_from(k).ok()?;
    let Ball { middle, radius } = at_point(k, &t.middle, precision + GUARD)?;
    if t.is_exact() {
        return Ball::rounded(middle, radius, precision);
    }
    let moved = t.radius.times(slope(k, &t.lower())?);
    let whole = size(&inverse_factorial(k, precision)?);
    if !t.lower().is_negative() && moved.compare(whole) == Ordering::Greater {
        // |c_k(t)| ≤ 1/k! for t ≥ 0.
        return Some(Ball::zero().widened(whole));
    }
    Ball::rounded(middle, radius.plus(moved), precision)
}

/// c_k at a point: the series for |t| ≤ max(k, 2)², else the recurrence from c₀ or c₁, which does not cancel there.
fn at_point(k: i64, t: &Dyadic, precision: i64) -> Option<Ball> {
    let limit = k.max(2).checked_mul(k.max(2))?;
    let is_near = t.abs().compare(&Dyadic::new(limit.into(), 0)) != Ordering::Greater;
    let t = Ball::exact(t.clone());
    if is_near {
        return series(k, &t, precision);
    }
    let mut value = first(k % 2, &t, precision)?;
    for lower in (k % 2..k - 1).step_by(2) {
        let rest = inverse_factorial(lower, precision)?.plus(&value.negative(), precision)?;
        value = rest.over(&t, precision)?;
    }
    Some(value)
}

/// Σⱼ (−t)ʲ/(2j + k)!.
///
/// The remainder: a term is the one before times −t/d with d = (2j + k − 1)(2j + k), which grows. Once 2|t| ≤ d each of the following is at
/// most half of the one before, so that all of them together are at most the last one that was added.
fn series(k: i64, t: &Ball, precision: i64) -> Option<Ball> {
    let minus_t = t.negative();
    let doubled = Dyadic::new(t.middle.mantissa.clone(), t.middle.exponent + 1).abs();
    let mut term = inverse_factorial(k, precision)?;
    let least = term.middle.top() - precision;
    let mut sum = term.clone();
    for j in 1.. {
        let d = (2 * j + k - 1) * (2 * j + k);
        term = term.times(&minus_t, precision)?.over(&Ball::integer(d), precision)?;
        sum = sum.plus(&term, precision)?;
        let last = size(&term);
        if last.top() <= least && doubled.compare(&Dyadic::new(d.into(), 0)) != Ordering::Greater {
            return Some(sum.widened(last));
        }
    }
    None
}

/// c₀ or c₁ for |t| > 4.
///
/// ```text
/// c₀ = cos √t,   c₁ = sin √t / √t        for t > 0
/// c₀ = cosh √−t, c₁ = sinh √−t / √−t     for t < 0
/// ```
fn first(k: i64, t: &Ball, precision: i64) -> Option<Ball> {
    let is_negative = t.middle.is_negative();
    let root = Ball::exact(t.middle.abs()).sqrt(precision)?;
    let numerator = if is_negative {
        let power = exp(&root, precision)?;
        let inverse = Ball::integer(1).over(&power, precision)?;
        let inverse = if k == 0 { inverse } else { inverse.negative() };
        power.plus(&inverse, precision)?.over(&Ball::integer(2), precision)?
    } else if k == 0 {
        cos(&root, precision)?
    } else {
        sin(&root, precision)?
    };
    if k == 0 {
        Some(numerator)
    } else {
        numerator.over(&root, precision)
    }
}

/// 1/k!.
fn inverse_factorial(k: i64, precision: i64) -> Option<Ball> {
    let factorial: BigInt = (1..=k).map(BigInt::from).product();
    Ball::integer(1).over(&Ball::exact(Dyadic::new(factorial, 0)), precision)
}

/// A bound of |c_k′| on a ball with this lower end.
///
/// ```text
/// |c_k′(t)| ≤ e^√(−t) / (k+2)!                       for t < 0
/// |c_k′(t)| ≤ 1/(k+2)!,  2/((k−1)! t),  1/(2√t)      for t > 0; the second for k ≥ 1, the third for k = 0
/// ```
///
/// Source: for t < 0 all terms of −c_k′ = Σ j (−t)ʲ⁻¹/(2j+k)! are positive, so it falls, and j (k+2)!/(2j+k)! ≤ 1/(2j−2)!. For t > 0
/// c_k(t) = ∫₀¹ (1−s)ᵏ⁻¹/(k−1)! cos(s√t) ds gives |c_k| ≤ 1/k! and |c_k′| ≤ |c_k′(0)|; and with |c₍k−2₎| ≤ 1/(k−2)! the recurrence gives
/// |c_k| ≤ 2/((k−2)! t), which bounds both terms of c_k′.
fn slope(k: i64, lower: &Dyadic) -> Option<Bound> {
    // The precision of a bound.
    let precision = 64;
    let mut near = size(&inverse_factorial(k + 2, precision)?);
    if lower.is_negative() {
        let root = Ball::exact(lower.abs()).sqrt(precision)?;
        near = near.times(size(&exp(&root, precision)?));
    }
    if lower.is_negative() || lower.is_zero() {
        return Some(near);
    }
    let far = if k == 0 {
        let root = Ball::exact(lower.clone()).sqrt(precision)?;
        Bound::power(-1).over(root.magnitude_below())?
    } else {
        let factor = size(&inverse_factorial(k - 1, precision)?);
        factor.shifted(1).over(lower.bound_below())?
    };
    Some(if far.compare(near) == Ordering::Less { far } else { near })
}

/// A bound of the magnitudes in a ball.
fn size(ball: &Ball) -> Bound {
    ball.middle.bound_above().plus(ball.radius)
}
