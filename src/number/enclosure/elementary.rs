//! The elementary functions on balls: the value at the midpoint, and its greatest change within the radius.
//!
//! Every step of the argument reduction is accounted for in the radius.
//!
//! Each function is evaluated at the midpoint by the series of `series`, in fixed point with enough bits after the point that the
//! result has the precision asked for; the radius of the argument adds a bound of how far the function moves. Where an argument is so
//! small that fixed point would need more than twice the bits, the first term of the series is the result, and the second is its error.
//!
//! Logarithm and arcus tangent come from their inverses: a double t near to the result is taken, and what is left is small. An
//! error of that double costs terms, not truth.

use super::arithmetic::{BITS_BELOW_RADIUS, Ball};
use super::bound::Bound;
use super::dyadic::{Dyadic, shifted};
use super::series::{self, Fixed, Inverse};
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{Signed, Zero};
use std::cmp::Ordering;

/// Bits after the point beyond the precision of the result, for the errors that are counted in units.
const GUARD: i64 = 24;

/// The least number of bits after the point that the series are made for.
const LEAST_FIXED: i64 = 64;

/// Arguments whose leading bit is this far below the point need no double to begin with: the series is short enough.
const SMALL: i64 = 30;

/// The bits after the point of a double near a result: short factors make cheap products.
const SHORT: i64 = 52;

/// The exponential of arguments up to 2 to this power is computed.
const LARGEST_EXPONENT_OF_EXP: i64 = 40;

/// The sine of angles up to 2 to this power is computed, so that the number of turns is an integer of 64 bits.
const LARGEST_ANGLE: i64 = 62;

/// π.
pub(super) fn pi(precision: i64) -> Option<Ball> {
    let w = precision + GUARD;
    rounded(series::pi(w), w, Bound::ZERO, precision)
}

/// The exponential.
///
/// ```text
/// eˣ = 2ⁿ eʳ,   n = ⌊x / ln 2⌉,   r = x − n ln 2;      |e^X − eˣ| ≤ eˣ (ρ + ρ²) for |X − x| ≤ ρ ≤ 1
/// ```
///
/// Source: e^ρ − 1 = ρ + ρ²(1/2 + ρ/6 + …) ≤ ρ + ρ²(e − 2). For a larger radius e^ρ ≤ 2^⌈3ρ/2⌉, since log₂ e < 3/2.
///
/// Above 2⁴⁰ the result is undecided, below −2⁴⁰ it is a ball around zero.
///
/// Evidence: `the_exponential_contains_its_series_with_remainder`, `images_of_points_are_inside_the_image_of_the_ball`.
pub(super) fn exp(x: &Ball, precision: i64) -> Option<Ball> {
    if x.is_zero() {
        return Some(Ball::integer(1));
    }
    let upper = x.upper();
    if upper.top() > LARGEST_EXPONENT_OF_EXP {
        // eˣ < 2ˣ for x < 0, and x ≤ −2⁴⁰ here.
        let vanishing = Ball::zero().widened(Bound::power(-(1 << LARGEST_EXPONENT_OF_EXP)));
        return upper.is_negative().then_some(vanishing);
    }
    if x.middle.top() > LARGEST_EXPONENT_OF_EXP || x.radius.top() > LARGEST_EXPONENT_OF_EXP {
        return None;
    }
    let w = (precision + GUARD).min(bits_that_matter(x.radius)).max(LEAST_FIXED);
    let extra = x.middle.top().max(0) + 4;
    let reduced = reduce(&x.middle, w + extra, &series::ln_2(w + extra))?;
    let argument = Dyadic::new(reduced.rest.value.clone(), -(w + extra));
    let mut value = series::exponential(&argument, w);
    // The argument's error, below 2^extra small units, is below a unit; eʳ < 2.
    value.error += 2 * reduced.rest.cut(extra).error;
    let turns = reduced.turns;
    let size = Dyadic::new(&value.value + value.error, turns - w).bound_above();
    let moved = size.times(exponential_minus_one(x.radius)?);
    let Fixed { value, error } = value;
    let radius = Bound::above(error.into(), turns - w).plus(moved);
    Ball::rounded(Dyadic::new(value, turns - w), radius, precision)
}

/// A bound of e^ρ − 1; `None` if it would be beyond all exponents, which a radius below 2⁴⁰ is far from.
fn exponential_minus_one(radius: Bound) -> Option<Bound> {
    if radius.top() <= 0 {
        return Some(radius.plus(radius.times(radius)));
    }
    // 3ρ/2, rounded up.
    let half = radius.shifted(-1);
    let exponent = Dyadic::zero().plus_bound(radius.plus(half));
    let exponent = exponent.fixed(0) + 1;
    Some(Bound::power(i64::try_from(exponent).ok()?))
}

/// The logarithm; `None` if the ball touches zero or negative numbers.
///
/// ```text
/// x = f 2ᵏ,   ln x = k ln 2 + ln f,   ln f = t + 2 artanh((f − eᵗ)/(f + eᵗ));      |ln X − ln x| ≤ r / (x − r)
/// ```
///
/// Source: artanh u = ½ ln((1 + u)/(1 − u)), here with (1 + u)/(1 − u) = f/eᵗ; and ln′ = 1/x falls.
///
/// Evidence: `the_logarithm_contains_its_series_with_remainder`, `the_exponential_of_the_logarithm_contains_the_number`.
pub(super) fn ln(x: &Ball, precision: i64) -> Option<Ball> {
    let lower = x.lower();
    if lower.is_negative() || lower.is_zero() {
        return None;
    }
    let moved = x.radius.over(lower.bound_below())?;
    let mut k = x.middle.top();
    let mut f = Dyadic::new(x.middle.mantissa.clone(), x.middle.exponent - k);
    // From [1/2, 1) to about [0.7, 1.4), so that k = 0 for all x near 1.
    if f.nearest_double() < 0.7 {
        k -= 1;
        f.exponent += 1;
    }
    let beyond_one = f.plus(&Dyadic::new((-1).into(), 0));
    let s = (-beyond_one.top()).max(0);
    if k == 0 && beyond_one.is_zero() && x.is_exact() {
        return Some(Ball::zero());
    }
    if k == 0 && s > precision + GUARD {
        // |ln(1 + z) − z| ≤ z² for |z| ≤ 1/2.
        let size = beyond_one.bound_above();
        return Ball::rounded(beyond_one, moved.plus(size.times(size)), precision);
    }
    let fractional = precision + GUARD + if k == 0 { s } else { 0 };
    let w = fractional.min(bits_that_matter(moved)).max(LEAST_FIXED);
    let mut sum = logarithm_near_one(&f, s, w);
    let ln_2 = series::ln_2(w);
    sum.value += ln_2.value * k;
    sum.error = sum.error.saturating_add(ln_2.error.saturating_mul(k.unsigned_abs()));
    rounded(sum, w, moved, precision)
}

/// ln f for 0.69 < f < 1.41, of which |f − 1| < 2⁻ˢ is known, in units of 2⁻ʷ.
///
/// The error: f is off by one unit, E = eᵗ by its own e. The quotient u moves by (1 + e)(1 + |u|)/(f + E) ≤ 1 + e, and the division cuts
/// one more; artanh moves by at most 1/(1 − u²) < 2 times that, and is doubled.
fn logarithm_near_one(f: &Dyadic, s: i64, w: i64) -> Fixed {
    let near = if s < SMALL {
        series::short(libm::log(f.nearest_double()), SHORT)
    } else {
        Dyadic::zero()
    };
    let f = f.fixed(w);
    let exponential = if near.is_zero() {
        Fixed::new(BigInt::from(1) << w.unsigned_abs(), 0)
    } else {
        series::exponential(&near, w)
    };
    let quotient = shifted(&(&f - &exponential.value), w).div_floor(&(&f + &exponential.value));
    let rest = series::inverse_tangent(&quotient, w, Inverse::HyperbolicTangent);
    let value = near.fixed(w) + (rest.value << 1_u8);
    Fixed::new(value, 2 * (2 * (exponential.error + 2) + rest.error))
}

/// The sine.
///
/// ```text
/// x = n π/2 + r;      |sin X − sin x| ≤ |X − x|,   and within [−1, 1] whatever X is
/// ```
///
/// Evidence: `sine_and_cosine_contain_their_series_with_remainder`, `tiny_arguments_contain_their_series_with_remainder`,
/// `images_of_points_are_inside_the_image_of_the_ball`.
pub(super) fn sin(x: &Ball, precision: i64) -> Option<Ball> {
    let s = -x.middle.top();
    if x.is_zero() {
        return Some(Ball::zero());
    }
    if s > precision + GUARD {
        // |sin x − x| ≤ |x|³.
        let size = x.middle.bound_above();
        let error = size.times(size).times(size);
        return Ball::rounded(x.middle.clone(), x.radius.plus(error), precision);
    }
    circular(x, 0, precision + s.max(0), precision)
}

/// The cosine.
///
/// ```text
/// cos x = sin(x + π/2);      |cos X − cos x| ≤ |X − x|
/// ```
///
/// Evidence: as for the sine: `sine_and_cosine_contain_their_series_with_remainder`.
pub(super) fn cos(x: &Ball, precision: i64) -> Option<Ball> {
    if x.is_zero() {
        return Some(Ball::integer(1));
    }
    circular(x, 1, precision, precision)
}

/// sin(x + q π/2) with a number of bits after the point.
fn circular(x: &Ball, q: i64, fractional: i64, precision: i64) -> Option<Ball> {
    // Nothing is known of an angle that is known to a turn, or so large that reducing it is not worth its bits.
    if x.radius.top() > 1 || x.middle.top() > LARGEST_ANGLE {
        return Some(Ball::zero().widened(Bound::power(0)));
    }
    let w = (fractional + GUARD).min(bits_that_matter(x.radius)).max(LEAST_FIXED);
    let extra = x.middle.top().max(0) + 4;
    // π in units of 2^−(v−1) is π/2 in units of 2⁻ᵛ.
    let quarter = series::pi(w + extra - 1);
    let reduced = reduce(&x.middle, w + extra, &quarter)?;
    let argument = Dyadic::new(reduced.rest.value.abs(), -(w + extra));
    let (sine, cosine) = series::sine_and_cosine(&argument, w);
    let is_negative = reduced.rest.value.is_negative();
    let quadrant = (reduced.turns + q).rem_euclid(4);
    let mut value = if quadrant % 2 == 0 { sine } else { cosine };
    if (quadrant >= 2) != (quadrant % 2 == 0 && is_negative) {
        value.value = -value.value;
    }
    value.error += reduced.rest.cut(extra).error;
    rounded(value, w, x.radius, precision)
}

/// An argument less a multiple of a constant.
struct Reduced {
    turns: i64,
    rest: Fixed,
}

/// x − n c with the n that makes it smallest, |x − n c| ≤ c/2 and a little, in units of 2⁻ᵛ; `None` if n is no integer of 64 bits. The
/// error: one unit of x, and n times that of c.
fn reduce(x: &Dyadic, v: i64, constant: &Fixed) -> Option<Reduced> {
    let x = x.fixed(v);
    let doubled: BigInt = (&x << 1_u8) + &constant.value;
    let turns = i64::try_from(doubled.div_floor(&(&constant.value << 1_u8))).ok()?;
    let rest = x - &constant.value * turns;
    let error = constant.error.checked_mul(turns.unsigned_abs())?.checked_add(1)?;
    Some(Reduced {
        turns,
        rest: Fixed::new(rest, error),
    })
}

/// The angle of the point (x, y); `None` if the box of both touches the origin, or may be on either side of the negative x-axis.
///
/// ```text
/// |θ(X, Y) − θ(x, y)| ≤ (|x| s + |y| r) / (x² + y² − |x| r − |y| s)   while the denominator is positive
/// ```
///
/// for |X − x| ≤ r, |Y − y| ≤ s.
///
/// Source: the tangent of the angle between the two points is (x Y − y X)/(x X + y Y), and |θ| ≤ |tan θ| for |θ| < π/2. Where that
/// is too coarse, the corners of the box are taken: the angle has no extremum inside, and none along an edge but at its ends.
///
/// Evidence: `the_arcus_tangent_contains_its_series_with_remainder`, `images_of_points_are_inside_the_image_of_the_ball`.
pub(super) fn atan2(y: &Ball, x: &Ball, precision: i64) -> Option<Ball> {
    if y.is_exact() && x.is_exact() {
        return angle(&y.middle, &x.middle, Bound::ZERO, precision);
    }
    let (bottom, top) = (y.lower(), y.upper());
    let left = x.lower();
    let may_be_on_axis = (bottom.is_negative() || bottom.is_zero()) && !top.is_negative();
    let reaches_left = left.is_negative() || left.is_zero();
    if may_be_on_axis && reaches_left {
        let right = x.upper();
        if bottom.is_negative() || !right.is_negative() {
            return None;
        }
    }
    let (x_size, y_size) = (x.middle.bound_above(), y.middle.bound_above());
    let cross = x_size.times(y.radius).plus(y_size.times(x.radius));
    let (x_least, y_least) = (x.middle.bound_below(), y.middle.bound_below());
    let square = x_least.times_below(x_least).largest(y_least.times_below(y_least));
    // With less than a quarter of the greater square taken away, more than half of it is left.
    if cross.shifted(2).compare(square) == Ordering::Less {
        let dot = x_size.times(x.radius).plus(y_size.times(y.radius));
        if dot.shifted(2).compare(square) == Ordering::Less {
            let moved = cross.over(square.minus_below(dot))?;
            return angle(&y.middle, &x.middle, moved, precision);
        }
    }
    hull_of_corners(&[bottom, top], &[left, x.upper()], precision)
}

/// The smallest ball that holds the angles of all four corners.
fn hull_of_corners(ys: &[Dyadic; 2], xs: &[Dyadic; 2], precision: i64) -> Option<Ball> {
    let mut ends: Option<(Dyadic, Dyadic)> = None;
    for y in ys {
        for x in xs {
            let corner = angle(y, x, Bound::ZERO, precision)?;
            let (low, high) = (corner.lower(), corner.upper());
            ends = Some(match ends {
                None => (low, high),
                Some((least, greatest)) => (
                    if low.compare(&least) == Ordering::Less {
                        low
                    } else {
                        least
                    },
                    if high.compare(&greatest) == Ordering::Greater {
                        high
                    } else {
                        greatest
                    },
                ),
            });
        }
    }
    let (low, high) = ends?;
    // (low + high)/2 ± (high − low)/2.
    let (low, high) = (Ball::exact(low), Ball::exact(high));
    let sum = low.plus(&high, precision)?;
    let difference = high.plus(&low.negative(), precision)?;
    let width = difference.middle.bound_above().plus(difference.radius);
    let mut middle = sum.middle;
    middle.exponent -= 1;
    Ball::rounded(middle, sum.radius.plus(width).shifted(-1), precision)
}

/// The angle of one point, with what its box adds to the radius; `None` at the origin.
///
/// The greater coordinate is a, the smaller one b: θ₀ = arctan(b/a) is between 0 and π/4, and the angle is a multiple of π/2 with θ₀
/// added or taken away.
fn angle(y: &Dyadic, x: &Dyadic, moved: Bound, precision: i64) -> Option<Ball> {
    let (x_size, y_size) = (x.abs(), y.abs());
    let is_steep = y_size.compare(&x_size) == Ordering::Greater;
    let (a, b) = if is_steep { (y_size, x_size) } else { (x_size, y_size) };
    if a.is_zero() {
        return None;
    }
    // The angle of the upper half plane is quarters · π/2 ± θ₀.
    let (quarters, is_less) = match (is_steep, x.is_negative()) {
        (false, false) => (0, false),
        (true, false) => (1, true),
        (true, true) => (1, false),
        (false, true) => (2, true),
    };
    let is_below = y.is_negative();
    if quarters == 0 && b.is_zero() {
        return Some(Ball::zero().widened(moved));
    }
    // 2^−(s+1) < b/a < 2^−(s−1).
    let s = a.top() - b.top();
    if quarters == 0 && s > precision + GUARD {
        // |arctan z − z| ≤ z³.
        let ratio = Ball::exact(b).over(&Ball::exact(a), precision + 2)?;
        let size = ratio.middle.bound_above().plus(ratio.radius);
        let radius = ratio.radius.plus(size.times(size).times(size)).plus(moved);
        let middle = if is_below {
            ratio.middle.negative()
        } else {
            ratio.middle
        };
        return Ball::rounded(middle, radius, precision);
    }
    let fractional = precision + GUARD + if quarters == 0 { s } else { 0 };
    let w = fractional.min(bits_that_matter(moved)).max(LEAST_FIXED);
    let mut sum = arcus_tangent(&a, &b, s, w);
    if is_less {
        sum.value = -sum.value;
    }
    if quarters > 0 {
        let pi = series::pi(w);
        // quarters · π/2, with quarters no more than two: half of an odd multiple is cut by less than a unit.
        sum.value += (pi.value * quarters) >> 1_u8;
        sum.error += pi.error + 1;
    }
    if is_below {
        sum.value = -sum.value;
    }
    rounded(sum, w, moved, precision)
}

/// arctan(b/a) for 0 ≤ b ≤ a in units of 2⁻ʷ, where b/a < 2^(1−s).
///
/// ```text
/// arctan(b/a) = t + arctan u,   u = (b cos t − a sin t) / (a cos t + b sin t)
/// ```
///
/// Source: u is the tangent of the difference of the two angles.
///
/// The error: a, scaled to [1/2, 1), and b are off by one unit each, which turns the point by at most 2√2 < 3 units (its distance from the
/// origin is 1/2 at least). Sine and cosine are off by e: numerator and denominator by 2e, and with a denominator above 0.49 and |u| < 1/4
/// the quotient by less than 6e. The division cuts one unit, and the products are not cut.
fn arcus_tangent(a: &Dyadic, b: &Dyadic, s: i64, w: i64) -> Fixed {
    let scale = a.top();
    let a = Dyadic::new(a.mantissa.clone(), a.exponent - scale).fixed(w);
    let b = Dyadic::new(b.mantissa.clone(), b.exponent - scale).fixed(w);
    let double = |value: &BigInt| Dyadic::new(value.clone(), -w).nearest_double();
    let near = if s < SMALL {
        series::short(libm::atan2(double(&b), double(&a)), SHORT)
    } else {
        Dyadic::zero()
    };
    if near.is_zero() {
        let quotient = shifted(&b, w).div_floor(&a);
        let rest = series::inverse_tangent(&quotient, w, Inverse::Tangent);
        return Fixed::new(rest.value, rest.error + 4);
    }
    let (sine, cosine) = series::sine_and_cosine(&near, w);
    let across = &b * &cosine.value - &a * &sine.value;
    let along = a * cosine.value + b * sine.value;
    let quotient = shifted(&across, w).div_floor(&along);
    let rest = series::inverse_tangent(&quotient, w, Inverse::Tangent);
    let value = near.fixed(w) + rest.value;
    Fixed::new(value, 3 + 6 * sine.error.max(cosine.error) + 1 + rest.error)
}

/// The number of bits after the point that matter beside a radius.
fn bits_that_matter(radius: Bound) -> i64 {
    if radius.is_zero() {
        i64::MAX
    } else {
        BITS_BELOW_RADIUS - radius.top()
    }
}

/// A number in fixed point as a ball.
fn rounded(number: Fixed, w: i64, moved: Bound, precision: i64) -> Option<Ball> {
    let middle = if number.value.is_zero() {
        Dyadic::zero()
    } else {
        Dyadic::new(number.value, -w)
    };
    let radius = Bound::above(number.error.into(), -w).plus(moved);
    Ball::rounded(middle, radius, precision)
}
