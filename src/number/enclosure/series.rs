//! The elementary functions on integers: series with counted remainders and roundings.
//!
//! Each series states by how many units its result can be off, and why.
//!
//! A number x is kept as the integer X = ⌊x · 2ʷ⌋ or one beside it, and 2⁻ʷ is called a *unit*. What cuts a product short, a shift to the
//! right, takes away less than a unit. Every function gives its integer with a number of units, [`Fixed`], which the truth is
//! not farther away than: the remainder of the series, the error of its arguments and all roundings on the way together.
//!
//! The errors that the comments derive are of the order of the number of terms; guard bits below the result's last
//! bit make them small, and the count goes with the result, so that no guess about the guard bits can be wrong.

use super::dyadic::{Dyadic, bits, shifted};
use num_bigint::BigInt;
use num_traits::{Signed, Zero};
use std::cell::RefCell;

/// Guard bits of the series, beyond those which their doublings use up.
const GUARD: i64 = 20;

/// An integer with the number of units that the truth can be away from it.
#[derive(Clone)]
pub(super) struct Fixed {
    pub(super) value: BigInt,
    pub(super) error: u64,
}

impl Fixed {
    pub(super) fn new(value: BigInt, error: u64) -> Self {
        Self { value, error }
    }

    /// The same with fewer bits: the error in the larger units rounded up, and one for the bits that are cut.
    pub(super) fn cut(&self, bits: i64) -> Self {
        Self {
            value: shifted(&self.value, -bits),
            error: self
                .error
                .checked_shr(u32::try_from(bits).unwrap_or(u32::MAX))
                .unwrap_or(0)
                + 2,
        }
    }
}

/// The exponential of a dyadic |x| ≤ 1 in units of 2⁻ʷ, w ≥ 64.
///
/// ```text
/// eˣ = (eˢ)^(2ᵏ),   s = x / 2ᵏ,   eˢ = Σₙ sⁿ/n!
/// ```
///
/// Why: with |s| ≤ 1/2 the series is short; each squaring doubles the relative error.
///
/// The error, in units of 2⁻ᵛ, v = w + k + 20, for N terms:
/// - A term is the one before times s, cut, over n, cut: eₙ ≤ eₙ₋₁/2 + 2, so eₙ ≤ 4. When the computed term is zero, the true one
///   is at most 4, and all that follow at most 4 together (each is at most half of the one before).
/// - s is cut to v bits: |eˢ′ − eˢ| ≤ 2 units. So the sum is off by at most 4N + 6, and relatively (eˢ > 0.6) by ρ ≤ 8N + 12.
/// - Squaring makes ρ′ ≤ 2ρ + ρ² + 1/A² with A² ≥ 1/e, and ρ² is less than one unit: ρ′ ≤ 2ρ + 4. After k of them ρ ≤ 2ᵏ (8N + 16).
/// - The result is below e < 3: it is off by at most 3 · 2ᵏ (8N + 16) units of 2⁻ᵛ, which is 3 (8N + 16) / 2²⁰ units of 2⁻ʷ.
///
/// Source: R. P. Brent and P. Zimmermann, Modern Computer Arithmetic, 2010, section 4.3.1 and 4.4.
///
/// Evidence: `the_exponential_contains_its_series_with_remainder`.
pub(super) fn exponential(x: &Dyadic, w: i64) -> Fixed {
    let k = halvings(x, w);
    let v = w + k + GUARD;
    let (s, s_bits) = short_or_cut(&x.mantissa, k - x.exponent, v);
    let mut term = BigInt::from(1) << v.unsigned_abs();
    let mut sum = term.clone();
    let mut n = 0_u64;
    while !term.is_zero() {
        n += 1;
        term = shifted(&(&term * &s), -s_bits) / n;
        sum += &term;
    }
    for _ in 0..k {
        sum = shifted(&(&sum * &sum), -v);
    }
    Fixed::new(sum, 3 * (8 * n + 16)).cut_after_doublings(v - w, k)
}

impl Fixed {
    /// The same with fewer bits, where the error is still to be multiplied by 2ᵈ.
    fn cut_after_doublings(self, bits: i64, doublings: i64) -> Self {
        let error = Self::new(BigInt::zero(), self.error).cut(bits - doublings).error;
        Self {
            value: shifted(&self.value, -bits),
            error,
        }
    }
}

/// Sine and cosine of a dyadic 0 ≤ x ≤ 1 in units of 2⁻ʷ, w ≥ 64.
///
/// ```text
/// sin s = Σₙ (−1)ⁿ s²ⁿ⁺¹/(2n+1)!,   cos s = Σₙ (−1)ⁿ s²ⁿ/(2n)!,   s = x / 2ᵏ
/// sin 2s = 2 sin s cos s,   cos 2s = 1 − 2 sin² s
/// ```
///
/// The error, in units of 2⁻ᵛ, v = w + 2k + 20, for N terms:
/// - A term is the one before times s², cut, over an integer, cut; s² itself is off by at most a unit, s by one: eₙ ≤ eₙ₋₁/4 + 3, so
///   eₙ ≤ 4. When the computed term is zero, the true one is at most 4 and so is all that follows. Each sum is off by at most 4N + 6.
/// - Doubling: with both off by E, sin 2s is off by 2(|sin| + |cos|)E + 2E² + 2 ≤ 2√2 E + 3 and cos 2s by 4|sin|E + 2E² + 2 ≤ 2E + 3,
///   since the angle before a doubling is at most 1/2, so its sine below 1/2, and E² is less than half a unit.
///   So E′ ≤ 4E + 3, and after k doublings E ≤ 4ᵏ (4N + 7): (4N + 7) / 2²⁰ units of 2⁻ʷ.
///
/// Source: as [`exponential`].
///
/// Evidence: `sine_and_cosine_contain_their_series_with_remainder`.
pub(super) fn sine_and_cosine(x: &Dyadic, w: i64) -> (Fixed, Fixed) {
    let k = halvings(x, w) / 2 + 1;
    let v = w + 2 * k + GUARD;
    let (square, square_bits) = short_or_cut(&(&x.mantissa * &x.mantissa), 2 * (k - x.exponent), v);
    let one = BigInt::from(1) << v.unsigned_abs();
    let mut n = 0_u64;
    // Two series side by side: the terms of the sine have the integers one higher.
    let mut sums = [shifted(&x.mantissa, x.exponent - k + v), one.clone()];
    let mut terms = sums.clone();
    while terms.iter().any(|term| !term.is_zero()) {
        n += 1;
        let divisors = [2 * n * (2 * n + 1), (2 * n - 1) * 2 * n];
        for ((term, sum), divisor) in terms.iter_mut().zip(&mut sums).zip(divisors) {
            *term = shifted(&(&*term * &square), -square_bits) / divisor;
            if n % 2 == 1 {
                *sum -= &*term;
            } else {
                *sum += &*term;
            }
        }
    }
    let [mut sine, mut cosine] = sums;
    for _ in 0..k {
        let doubled = shifted(&(&sine * &cosine), 1 - v);
        cosine = &one - shifted(&(&sine * &sine), 1 - v);
        sine = doubled;
    }
    let cut = |value| Fixed::new(value, 4 * n + 7).cut_after_doublings(v - w, 2 * k);
    (cut(sine), cut(cosine))
}

/// Which of the two functions with the series Σ (±1)ⁿ u²ⁿ⁺¹/(2n+1) is meant.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Inverse {
    /// arctan u: the signs alternate.
    Tangent,
    /// artanh u = ½ ln((1 + u)/(1 − u)): they do not.
    HyperbolicTangent,
}

/// The inverse tangent, circular or hyperbolic, of |u| ≤ 1/4 in units of 2⁻ʷ.
///
/// ```text
/// arctan u = Σₙ (−1)ⁿ u²ⁿ⁺¹/(2n+1),   artanh u = Σₙ u²ⁿ⁺¹/(2n+1)
/// ```
///
/// The error for N terms: a power is the one before times u², both cut: eₙ ≤ eₙ₋₁/16 + 2 gives eₙ ≤ 3; over 2n + 1 ≥ 3, cut, each term is
/// off by at most 2. When the computed power is zero the true one is at most 3, and all terms from it on are 3/(2n+1) · 16/15 ≤ 2
/// together. So the sum is off by at most 2N + 2.
///
/// Evidence: `the_arcus_tangent_contains_its_series_with_remainder`, `the_logarithm_contains_its_series_with_remainder`.
pub(super) fn inverse_tangent(u: &BigInt, w: i64, which: Inverse) -> Fixed {
    let size = u.abs();
    let square = shifted(&(&size * &size), -w);
    let mut power = size.clone();
    let mut sum = size;
    let mut n = 0_u64;
    while !power.is_zero() {
        n += 1;
        power = shifted(&(&power * &square), -w);
        let term = &power / (2 * n + 1);
        if which == Inverse::Tangent && n % 2 == 1 {
            sum -= term;
        } else {
            sum += term;
        }
    }
    let sum = if u.is_negative() { -sum } else { sum };
    Fixed::new(sum, 2 * n + 2)
}

/// The same of 1/m for an integer m ≥ 5, where the powers are divisions by m².
///
/// The error for N terms: as above, with eₙ ≤ eₙ₋₁/25 + 1 ≤ 2: at most 2N + 2.
fn inverse_tangent_of_fraction(m: u64, w: i64, which: Inverse) -> Fixed {
    let mut power = (BigInt::from(1) << w.unsigned_abs()) / m;
    let mut sum = power.clone();
    let mut n = 0_u64;
    while !power.is_zero() {
        n += 1;
        power /= m * m;
        let term = &power / (2 * n + 1);
        if which == Inverse::Tangent && n % 2 == 1 {
            sum -= term;
        } else {
            sum += term;
        }
    }
    Fixed::new(sum, 2 * n + 2)
}

/// A constant that is computed once for each thread, with as many bits as were ever asked for.
struct Constant {
    w: i64,
    value: Fixed,
}

thread_local! {
    static PI: RefCell<Option<Constant>> = const { RefCell::new(None) };
    static LN_2: RefCell<Option<Constant>> = const { RefCell::new(None) };
}

/// The circle number in units of 2⁻ʷ.
///
/// ```text
/// π = 16 arctan(1/5) − 4 arctan(1/239)
/// ```
///
/// Source: J. Machin, 1706.
///
/// Evidence: `known_digits_of_constants_are_certified`.
pub(super) fn pi(w: i64) -> Fixed {
    let tangent = |m, w| inverse_tangent_of_fraction(m, w, Inverse::Tangent);
    PI.with_borrow_mut(|known| constant(known, w, |w| weighted(&[(16, tangent(5, w)), (-4, tangent(239, w))])))
}

/// The natural logarithm of 2 in units of 2⁻ʷ.
///
/// ```text
/// ln 2 = 18 artanh(1/26) − 2 artanh(1/4801) + 8 artanh(1/8749)
/// ```
///
/// Source: X. Gourdon and P. Sebah, The logarithmic constant: log 2, 2004; it holds because (27/25)⁹ · (2400/2401) · (4375/4374)⁴ = 2.
///
/// Evidence: `known_digits_of_constants_are_certified`.
pub(super) fn ln_2(w: i64) -> Fixed {
    let tangent = |m, w| inverse_tangent_of_fraction(m, w, Inverse::HyperbolicTangent);
    let formula = |w| weighted(&[(18, tangent(26, w)), (-2, tangent(4801, w)), (8, tangent(8749, w))]);
    LN_2.with_borrow_mut(|known| constant(known, w, formula))
}

/// Σ cᵢ xᵢ: the errors add up with the magnitudes of the coefficients.
fn weighted(terms: &[(i64, Fixed)]) -> Fixed {
    let mut sum = Fixed::new(BigInt::zero(), 0);
    for (coefficient, term) in terms {
        sum.value += &term.value * coefficient;
        sum.error += term.error * coefficient.unsigned_abs();
    }
    sum
}

/// The constant with w bits, from the one that is known if that has enough.
fn constant(known: &mut Option<Constant>, w: i64, formula: impl Fn(i64) -> Fixed) -> Fixed {
    let constant = match known.take() {
        Some(constant) if constant.w > w => constant,
        _ => {
            let w = w + 64;
            let value = formula(w + 2 * GUARD).cut(2 * GUARD);
            Constant { w, value }
        }
    };
    let cut = constant.value.cut(constant.w - w);
    *known = Some(constant);
    cut
}

/// How often an argument is halved: about √w/2 times, where the work of the squarings balances that of the terms; less if it
/// is small already, but once at least.
fn halvings(x: &Dyadic, w: i64) -> i64 {
    let root = num_integer::Roots::sqrt(&w);
    // |x| < 2ᵗ is halved −t times already.
    (root / 2 + x.top().clamp(-root, 0)).max(1)
}

/// The number m · 2⁻ᵇ as it is if that takes no more than v bits after the point, else cut to v: the mantissa, and the bits after
/// the point.
fn short_or_cut(mantissa: &BigInt, b: i64, v: i64) -> (BigInt, i64) {
    if b > v {
        (shifted(mantissa, v - b), v)
    } else {
        (shifted(mantissa, (-b).max(0)), b.max(0))
    }
}

/// A double, cut to at most `places` bits after the point, with as short a mantissa as it has; zero if it is not finite.
pub(super) fn short(value: f64, places: i64) -> Dyadic {
    let Some(mut number) = Dyadic::from_f64(value) else {
        return Dyadic::zero();
    };
    if number.exponent < -places {
        number = Dyadic::new(number.fixed(places), -places);
    }
    let zeros = number.mantissa.trailing_zeros().unwrap_or(0);
    let zeros = i64::try_from(zeros).unwrap_or(0).min(bits(&number.mantissa));
    Dyadic::new(shifted(&number.mantissa, -zeros), number.exponent + zeros)
}
