//! Decimals: reading them exactly, and writing the nearest one.
//!
//! Reading loses no digit.

use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::Signed;
use std::cmp::Ordering;

/// The largest power of ten, up or down, that is read. It is far beyond the range of a double (about ±324), and keeps a
/// short text such as `1e999999999` from becoming a number of a billion digits.
const LARGEST_EXPONENT: i64 = 10_000;

/// The longest text that is read: reading takes time as the square of the number of digits.
const LONGEST_TEXT: usize = 10_000;

/// The exact value of a decimal: a sign, digits, perhaps a point among them, and perhaps a power of ten after `e`.
///
/// `None` if the text is anything else, or if its power of ten or the number of its digits is too large to be meant.
pub(super) fn read(text: &str) -> Option<BigRational> {
    if text.len() > LONGEST_TEXT {
        return None;
    }
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, read_exponent(exponent)?),
        None => (text, 0),
    };
    let (negative, digits) = split_sign(mantissa);
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let all_digits = format!("{whole}{fraction}");
    if !is_digits(&all_digits) {
        return None;
    }
    let magnitude = BigInt::parse_bytes(all_digits.as_bytes(), 10)?;
    let integer = if negative { -magnitude } else { magnitude };
    // whole.fraction · 10ᵉ is the integer of all digits · 10^(e − number of digits in the fraction).
    let exponent = exponent - i64::try_from(fraction.len()).ok()?;
    let power = BigInt::from(10).pow(u32::try_from(exponent.unsigned_abs()).ok()?);
    Some(if exponent < 0 {
        BigRational::new(integer, power)
    } else {
        BigRational::from_integer(integer * power)
    })
}

/// The integer nearest to `value · 10ᵈ`, ties to the even one: all digits of the nearest decimal with d digits after
/// the point.
pub(super) fn nearest(value: &BigRational, digits: u32) -> BigInt {
    nearest_integer(&(value.numer() * BigInt::from(10).pow(digits)), value.denom())
}

/// Writes `scaled / 10ᵈ` as a decimal with d digits after the point.
pub(super) fn write(scaled: &BigInt, digits: u32) -> String {
    let sign = if scaled.is_negative() { "-" } else { "" };
    let (whole, fraction) = scaled.abs().div_rem(&BigInt::from(10).pow(digits));
    if digits == 0 {
        return format!("{sign}{whole}");
    }
    let width = digits as usize;
    format!("{sign}{whole}.{:0>width$}", fraction.to_string())
}

/// The integer nearest to `numerator / denominator` (with a positive denominator), ties to the even one.
fn nearest_integer(numerator: &BigInt, denominator: &BigInt) -> BigInt {
    let (below, remainder) = numerator.div_mod_floor(denominator);
    let round_up = match (remainder * 2u8).cmp(denominator) {
        Ordering::Less => false,
        Ordering::Equal => below.is_odd(),
        Ordering::Greater => true,
    };
    below + BigInt::from(round_up)
}

/// Whether a text is one or more digits 0 to 9 and nothing else.
fn is_digits(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// Takes a leading sign from a text: whether it is a minus, and the rest.
fn split_sign(text: &str) -> (bool, &str) {
    match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    }
}

/// Reads the exponent of a decimal; `None` if it is not an integer or too large to be meant.
fn read_exponent(text: &str) -> Option<i64> {
    let exponent: i64 = text.parse().ok()?;
    (-LARGEST_EXPONENT..=LARGEST_EXPONENT)
        .contains(&exponent)
        .then_some(exponent)
}
