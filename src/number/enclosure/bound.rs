//! Upper bounds: the radius of a ball, and every term that is added to it.
//!
//! Every rounding goes upwards, so a radius is never too small.
//!
//! A bound is a number m · 2ᵉ ≥ 0 with a mantissa of 30 bits, and every operation on it rounds upward: thirty bits are enough for the
//! size of an error, and integers of the machine are fast. It never becomes zero by rounding: a bound too small for its exponent is
//! raised to the smallest one. Where a bound is divided by a number, that number is a lower bound ([`Bound::below`]).

use std::cmp::Ordering;

/// The bits of a mantissa.
const BITS: i64 = 30;

/// What stands for the position of the leading bit of zero: below that of every other number, and far from overflow.
pub(super) const TOP_OF_ZERO: i64 = -(1 << 60);

/// The least exponent of a bound, far below everything that a ball can hold; see `EXPONENTS` of arithmetic.
const LEAST_EXPONENT: i64 = -(1 << 53);

/// A number m · 2ᵉ ≥ 0 that is a bound of another one.
#[derive(Clone, Copy)]
pub(super) struct Bound {
    /// Zero, or from 2²⁹ to 2³⁰ − 1.
    mantissa: u64,
    exponent: i64,
}

impl Bound {
    pub(super) const ZERO: Self = Self {
        mantissa: 0,
        exponent: 0,
    };

    /// The least bound that is not below m · 2ᵉ.
    pub(super) fn above(mantissa: u128, exponent: i64) -> Self {
        let (kept, dropped) = Self::split(mantissa, exponent);
        if !dropped {
            return kept;
        }
        let next = kept.mantissa + 1;
        // 2³⁰ · 2ᵉ is 2²⁹ · 2ᵉ⁺¹.
        let overflows = i64::from(next >> BITS != 0);
        Self {
            mantissa: next >> overflows,
            exponent: kept.exponent + overflows,
        }
        .not_vanishing()
    }

    /// The greatest bound that is not above m · 2ᵉ.
    pub(super) fn below(mantissa: u128, exponent: i64) -> Self {
        Self::split(mantissa, exponent).0
    }

    /// 2ᵉ.
    pub(super) fn power(exponent: i64) -> Self {
        Self::above(1, exponent)
    }

    /// The leading bits, and whether others were dropped.
    fn split(mantissa: u128, exponent: i64) -> (Self, bool) {
        if mantissa == 0 {
            return (Self::ZERO, false);
        }
        let excess = 128 - i64::from(mantissa.leading_zeros()) - BITS;
        let kept = if excess > 0 {
            mantissa >> excess
        } else {
            mantissa << -excess
        };
        let dropped = excess > 0 && kept << excess != mantissa;
        let bound = Self {
            mantissa: u64::try_from(kept).unwrap_or(u64::MAX),
            exponent: exponent + excess,
        };
        (bound.not_vanishing(), dropped)
    }

    /// The same, or the smallest bound if its exponent is below all.
    fn not_vanishing(self) -> Self {
        Self {
            exponent: self.exponent.max(LEAST_EXPONENT),
            ..self
        }
    }

    pub(super) fn is_zero(self) -> bool {
        self.mantissa == 0
    }

    pub(super) fn mantissa(self) -> u64 {
        self.mantissa
    }

    pub(super) fn exponent(self) -> i64 {
        self.exponent
    }

    /// The least t with the bound below 2ᵗ; below every other one for zero.
    pub(super) fn top(self) -> i64 {
        if self.is_zero() {
            TOP_OF_ZERO
        } else {
            self.exponent + BITS
        }
    }

    /// A bound of the sum.
    pub(super) fn plus(self, other: Self) -> Self {
        if self.is_zero() {
            return other;
        }
        if other.is_zero() {
            return self;
        }
        let (large, small) = if self.exponent >= other.exponent {
            (self, other)
        } else {
            (other, self)
        };
        let gap = large.exponent - small.exponent;
        if gap > 64 {
            // The small one is less than a unit of the large one.
            return Self::above(u128::from(large.mantissa) + 1, large.exponent);
        }
        Self::above(
            (u128::from(large.mantissa) << gap) + u128::from(small.mantissa),
            small.exponent,
        )
    }

    /// A bound of the product.
    pub(super) fn times(self, other: Self) -> Self {
        Self::above(
            u128::from(self.mantissa) * u128::from(other.mantissa),
            self.exponent + other.exponent,
        )
    }

    /// A lower bound of the product of two lower bounds.
    pub(super) fn times_below(self, other: Self) -> Self {
        Self::below(
            u128::from(self.mantissa) * u128::from(other.mantissa),
            self.exponent + other.exponent,
        )
    }

    /// A lower bound of the difference of a lower bound and an upper bound; zero if it is not positive.
    pub(super) fn minus_below(self, other: Self) -> Self {
        let gap = self.exponent - other.exponent;
        let (large, small, exponent) = if other.is_zero() {
            return self;
        } else if gap > 64 {
            // The other one is less than a unit of 2^(e−34), for a mantissa of 30 bits.
            (u128::from(self.mantissa) << 34, 1, self.exponent - 34)
        } else if gap >= 0 {
            (
                u128::from(self.mantissa) << gap,
                u128::from(other.mantissa),
                other.exponent,
            )
        } else {
            // Where the other one has the greater exponent, it is the greater one: mantissas are normalised.
            return Self::ZERO;
        };
        Self::below(large.saturating_sub(small), exponent)
    }

    /// The greater of two.
    pub(super) fn largest(self, other: Self) -> Self {
        if self.compare(other) == Ordering::Less {
            other
        } else {
            self
        }
    }

    /// A bound of the quotient, if the divisor is a lower bound and not zero.
    pub(super) fn over(self, divisor: Self) -> Option<Self> {
        if divisor.is_zero() {
            return None;
        }
        let scaled = u128::from(self.mantissa) << 64;
        let quotient = scaled / u128::from(divisor.mantissa);
        let is_exact = quotient * u128::from(divisor.mantissa) == scaled;
        Some(Self::above(
            quotient + u128::from(!is_exact),
            self.exponent - divisor.exponent - 64,
        ))
    }

    /// The bound times 2ᵏ.
    pub(super) fn shifted(self, k: i64) -> Self {
        Self::above(u128::from(self.mantissa), self.exponent + k)
    }

    pub(super) fn compare(self, other: Self) -> Ordering {
        let by_top = self.top().cmp(&other.top());
        by_top.then(self.mantissa.cmp(&other.mantissa))
    }
}
