//! Dyadic numbers: exact integers times powers of two, the midpoints and ends of balls.
//!
//! They are compared and converted to doubles and decimals exactly. An exponent of 2⁵⁰ does not need 2⁵⁰ bits.

use super::bound::{Bound, TOP_OF_ZERO};
use crate::number::Rational;
use num_bigint::{BigInt, BigUint};
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};
use std::cmp::Ordering;

/// Beyond 2 to this power, up or down, a number is not written out as a fraction or a decimal: it would fill megabytes.
const LARGEST_WRITTEN_EXPONENT: i64 = 1 << 24;

/// The number m · 2ᵉ.
#[derive(Clone)]
pub(super) struct Dyadic {
    pub(super) mantissa: BigInt,
    pub(super) exponent: i64,
}

impl Dyadic {
    pub(super) fn new(mantissa: BigInt, exponent: i64) -> Self {
        Self { mantissa, exponent }
    }

    pub(super) fn zero() -> Self {
        Self::new(BigInt::zero(), 0)
    }

    /// The exact value of a double; `None` for an infinity or a NaN.
    pub(super) fn from_f64(value: f64) -> Option<Self> {
        if !value.is_finite() {
            return None;
        }
        let (mantissa, exponent, sign) = num_traits::float::FloatCore::integer_decode(value);
        if mantissa == 0 {
            return Some(Self::zero());
        }
        let zeros = mantissa.trailing_zeros();
        let mantissa = BigInt::from(mantissa >> zeros) * sign;
        Some(Self::new(mantissa, i64::from(exponent) + i64::from(zeros)))
    }

    pub(super) fn is_zero(&self) -> bool {
        self.mantissa.is_zero()
    }

    pub(super) fn is_negative(&self) -> bool {
        self.mantissa.is_negative()
    }

    /// The least t with |x| < 2ᵗ, so that the leading bit is worth 2ᵗ⁻¹; below every other one for zero.
    pub(super) fn top(&self) -> i64 {
        if self.is_zero() {
            TOP_OF_ZERO
        } else {
            self.exponent + bits(&self.mantissa)
        }
    }

    pub(super) fn negative(&self) -> Self {
        Self::new(-&self.mantissa, self.exponent)
    }

    pub(super) fn abs(&self) -> Self {
        Self::new(self.mantissa.abs(), self.exponent)
    }

    /// The exact sum. The caller knows that the exponents are not far apart.
    pub(super) fn plus(&self, other: &Self) -> Self {
        if self.is_zero() {
            return other.clone();
        }
        if other.is_zero() {
            return self.clone();
        }
        let gap = self.exponent - other.exponent;
        match gap.cmp(&0) {
            Ordering::Equal => Self::new(&self.mantissa + &other.mantissa, self.exponent),
            Ordering::Greater => Self::new(shifted(&self.mantissa, gap) + &other.mantissa, other.exponent),
            Ordering::Less => Self::new(&self.mantissa + shifted(&other.mantissa, -gap), self.exponent),
        }
    }

    /// The exact sum with a bound, the radius of a ball around this number.
    pub(super) fn plus_bound(&self, bound: Bound) -> Self {
        self.plus(&Self::new(bound.mantissa().into(), bound.exponent()))
    }

    /// The exact order. Numbers whose leading bits stand in different places need no shift, and those whose leading bits
    /// stand in the same place only one as long as a mantissa.
    pub(super) fn compare(&self, other: &Self) -> Ordering {
        let order = self.mantissa.sign().cmp(&other.mantissa.sign());
        if order != Ordering::Equal || self.is_zero() {
            return order;
        }
        let by_size = self.top().cmp(&other.top()).then_with(|| {
            let gap = self.exponent - other.exponent;
            let left = shifted_magnitude(&self.mantissa, gap.max(0));
            left.cmp(&shifted_magnitude(&other.mantissa, (-gap).max(0)))
        });
        if self.is_negative() { by_size.reverse() } else { by_size }
    }

    /// The exact order against a rational n/d: m · 2ᵉ · d against n, with the same care for the shift.
    pub(super) fn compare_with(&self, value: &BigRational) -> Ordering {
        let scaled = Self::new(&self.mantissa * value.denom(), self.exponent);
        scaled.compare(&Self::new(value.numer().clone(), 0))
    }

    /// The integer ⌊x · 2ʷ⌋: the number in fixed point.
    pub(super) fn fixed(&self, w: i64) -> BigInt {
        shifted(&self.mantissa, self.exponent + w)
    }

    /// The 128 leading bits of |x| with their exponent, and whether there are more.
    fn leading(&self) -> (u128, i64, bool) {
        let mut digits = self.mantissa.magnitude().iter_u64_digits();
        let count = i64::try_from(digits.len()).unwrap_or(i64::MAX);
        let high = digits.next_back().unwrap_or(0);
        let Some(low) = digits.next_back() else {
            return (u128::from(high), self.exponent, false);
        };
        let leading = (u128::from(high) << 64) | u128::from(low);
        (leading, self.exponent + 64 * (count - 2), count > 2)
    }

    /// A bound that is not below |x|.
    pub(super) fn bound_above(&self) -> Bound {
        let (leading, exponent, more) = self.leading();
        if more {
            // Half of it, rounded up, leaves room for the carry.
            Bound::above((leading >> 1) + 1, exponent + 1)
        } else {
            Bound::above(leading, exponent)
        }
    }

    /// A bound that is not above |x|.
    pub(super) fn bound_below(&self) -> Bound {
        let (leading, exponent, _) = self.leading();
        Bound::below(leading, exponent)
    }

    /// The number as a fraction; `None` if that would fill megabytes.
    pub(super) fn to_rational(&self) -> Option<Rational> {
        if self.is_zero() {
            return Some(Rational::from_integer(BigInt::zero()));
        }
        if self.exponent.abs() > LARGEST_WRITTEN_EXPONENT {
            return None;
        }
        let power = BigInt::from(1) << self.exponent.unsigned_abs();
        Some(Rational::from_big(if self.exponent < 0 {
            BigRational::new(self.mantissa.clone(), power)
        } else {
            BigRational::from_integer(&self.mantissa * power)
        }))
    }

    /// The double nearest to the number, ties to the even one. As in IEEE 754 it can be infinite, and a zero has no sign here.
    ///
    /// Doubles near x are the multiples of 2^q with q = max(t − 53, −1074), where 2ᵗ⁻¹ ≤ |x| < 2ᵗ; the multiple is an integer
    /// up to 2⁵³, and its product with 2^q is exact.
    ///
    /// Evidence: `the_double_of_an_enclosure_is_the_nearest_one`.
    pub(super) fn nearest_double(&self) -> f64 {
        let top = self.top();
        if top < -1074 {
            return 0.0;
        }
        if top > 1024 {
            return if self.is_negative() {
                f64::NEG_INFINITY
            } else {
                f64::INFINITY
            };
        }
        let quantum = (top - 53).max(-1074);
        let gap = quantum - self.exponent;
        let multiple = if gap <= 0 {
            shifted_magnitude(&self.mantissa, -gap)
        } else {
            nearest_multiple(self.mantissa.magnitude(), gap)
        };
        let size = multiple.to_u64().map_or(f64::INFINITY, |multiple| multiple as f64) * power_of_two(quantum);
        if self.is_negative() && size > 0.0 { -size } else { size }
    }

    /// The least double that is not below a number that is not negative.
    pub(super) fn double_above(&self) -> f64 {
        let nearest = self.nearest_double();
        match Self::from_f64(nearest) {
            Some(double) if double.compare(self) == Ordering::Less => nearest.next_up(),
            Some(_) => nearest,
            // Beyond all doubles.
            None => f64::INFINITY,
        }
    }

    /// The decimal nearest to the number with a number of significant digits, ties to the even one, in scientific notation; "0" for
    /// zero, `None` if the number is so large or small that writing it out would fill megabytes.
    pub(super) fn to_decimal(&self, digits: u32) -> Option<String> {
        if self.is_zero() {
            return Some("0".to_owned());
        }
        if self.top().abs() > LARGEST_WRITTEN_EXPONENT {
            return None;
        }
        let digits = i64::from(digits.max(1));
        // The k with 10ᵏ ≤ |x| < 10ᵏ⁺¹, or one or two less, which the loop raises: 0.30103 is above log₁₀ 2 by less than 10⁻⁸, so that
        // up to 2²⁴ the product is off by less than one, and one is taken away.
        let mut power = (self.top() - 1) * 30103 / 100_000 - 1;
        let (limit, mut whole);
        limit = BigUint::from(10_u8).pow(u32::try_from(digits).ok()?);
        loop {
            whole = self.times_power_of_ten(digits - 1 - power)?;
            if whole < limit {
                break;
            }
            power += 1;
        }
        let text = whole.to_string();
        let (first, rest) = text.split_at(1);
        let sign = if self.is_negative() { "-" } else { "" };
        let point = if rest.is_empty() { "" } else { "." };
        Some(format!("{sign}{first}{point}{rest}e{power}"))
    }

    /// The integer nearest to |x| · 10ᵏ, ties to the even one.
    fn times_power_of_ten(&self, k: i64) -> Option<BigUint> {
        let ten = BigUint::from(10_u8).pow(u32::try_from(k.unsigned_abs()).ok()?);
        let two = BigUint::from(1_u8) << self.exponent.unsigned_abs();
        let (mut numerator, mut denominator) = (self.mantissa.magnitude().clone(), BigUint::from(1_u8));
        if k < 0 {
            denominator *= ten;
        } else {
            numerator *= ten;
        }
        if self.exponent < 0 {
            denominator *= two;
        } else {
            numerator *= two;
        }
        let (below, remainder) = numerator.div_rem(&denominator);
        let round_up = match (remainder << 1_u8).cmp(&denominator) {
            Ordering::Less => false,
            Ordering::Equal => below.is_odd(),
            Ordering::Greater => true,
        };
        Some(below + u8::from(round_up))
    }
}

/// The number of bits of |m|.
pub(super) fn bits(mantissa: &BigInt) -> i64 {
    i64::try_from(mantissa.bits()).unwrap_or(i64::MAX)
}

/// ⌊m · 2ᵏ⌋.
pub(super) fn shifted(mantissa: &BigInt, k: i64) -> BigInt {
    if k < 0 {
        mantissa >> k.unsigned_abs()
    } else {
        mantissa << k.unsigned_abs()
    }
}

/// |m| · 2ᵏ for k ≥ 0.
fn shifted_magnitude(mantissa: &BigInt, k: i64) -> BigUint {
    mantissa.magnitude() << k.unsigned_abs()
}

/// The integer nearest to m / 2ᵏ for k > 0, ties to the even one.
fn nearest_multiple(magnitude: &BigUint, k: i64) -> BigUint {
    let k = k.unsigned_abs();
    let below = magnitude >> k;
    let is_half_or_more = magnitude.bit(k - 1);
    let is_half_or_less = !is_half_or_more || magnitude.trailing_zeros() == Some(k - 1);
    let round_up = is_half_or_more && (!is_half_or_less || below.is_odd());
    below + u8::from(round_up)
}

/// 2ᵏ for −1074 ≤ k ≤ 1023, exactly.
fn power_of_two(k: i64) -> f64 {
    let bits = if k < -1022 {
        1_u64 << (k + 1074)
    } else {
        (k + 1023).unsigned_abs() << 52
    };
    f64::from_bits(bits)
}
