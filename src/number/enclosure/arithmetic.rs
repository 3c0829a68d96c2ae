//! Balls, and + − × ÷ √ on them with every rounding accounted for.
//!
//! The true result of an operation always lies inside the computed ball.
//!
//! A ball is a midpoint x and a radius r and stands for every number from x − r to x + r. Each operation computes the midpoint with
//! exact integers and rounds it once; how far that can be off is added to the radius. Besides, the radius takes the bound of how far
//! the operation moves when its operands move within their balls. All bounds are rounded upward ([`Bound`]).

use super::bound::Bound;
use super::dyadic::{Dyadic, bits, shifted};
use num_bigint::BigInt;
use num_integer::{Integer, Roots};
use num_traits::Zero;
use std::cmp::Ordering;

/// Numbers of 2^(2⁵⁰) and more are undecided, and those below 2^(−2⁵⁰) are replaced by a ball around zero: sums of exponents then
/// stay far from the ends of 64 bits.
pub(super) const EXPONENTS: i64 = 1 << 50;

/// The bits of a midpoint that are kept below the leading bit of its radius: more cannot matter, and cost time.
pub(super) const BITS_BELOW_RADIUS: i64 = 40;

/// All numbers from `middle` − `radius` to `middle` + `radius`.
#[derive(Clone)]
pub(super) struct Ball {
    pub(super) middle: Dyadic,
    pub(super) radius: Bound,
}

impl Ball {
    pub(super) fn exact(middle: Dyadic) -> Self {
        Self {
            middle,
            radius: Bound::ZERO,
        }
    }

    pub(super) fn zero() -> Self {
        Self::exact(Dyadic::zero())
    }

    pub(super) fn integer(value: i64) -> Self {
        Self::exact(Dyadic::new(value.into(), 0))
    }

    /// The ball with its midpoint rounded to a number of bits, the radius enlarged by the rounding; `None` beyond the exponents.
    ///
    /// The midpoint goes to the nearest multiple of the unit 2ᵏ, by at most 2ᵏ⁻¹; a multiple it is already stays exact. A radius
    /// is raised to at least 2^(−2p−64) of the midpoint, so that the ends of the ball are integers of a few thousand bits at most.
    pub(super) fn rounded(middle: Dyadic, radius: Bound, precision: i64) -> Option<Self> {
        let mut ball = Self { middle, radius };
        let top = ball.middle.top();
        if top > EXPONENTS || radius.top() > EXPONENTS {
            return None;
        }
        if top < -EXPONENTS && !ball.middle.is_zero() {
            ball.radius = ball.radius.plus(Bound::power(-EXPONENTS));
            ball.middle = Dyadic::zero();
        }
        let mut drop = bits(&ball.middle.mantissa) - precision;
        if !ball.radius.is_zero() {
            drop = drop.max(ball.radius.top() - BITS_BELOW_RADIUS - ball.middle.exponent);
        }
        if drop > 0 && !ball.middle.is_zero() {
            ball.drop_bits(drop);
        }
        if !ball.radius.is_zero() && !ball.middle.is_zero() {
            let least = ball.middle.top() - 2 * precision - 64;
            if ball.radius.top() < least {
                ball.radius = Bound::power(least);
            }
        }
        Some(ball)
    }

    /// Rounds the last bits of the midpoint away.
    fn drop_bits(&mut self, drop: i64) {
        let mantissa = &self.middle.mantissa;
        let last = drop.unsigned_abs();
        let is_exact = mantissa.trailing_zeros().is_none_or(|zeros| zeros >= last);
        let mut kept = shifted(mantissa, -drop);
        if !is_exact {
            // In two's complement, as the floor is: the first bit dropped says whether the next multiple is nearer.
            kept += i32::from(mantissa.bit(last - 1));
            self.radius = self.radius.plus(Bound::power(self.middle.exponent + drop - 1));
        }
        self.middle = if kept.is_zero() {
            Dyadic::zero()
        } else {
            Dyadic::new(kept, self.middle.exponent + drop)
        };
    }

    pub(super) fn is_exact(&self) -> bool {
        self.radius.is_zero()
    }

    pub(super) fn is_zero(&self) -> bool {
        self.is_exact() && self.middle.is_zero()
    }

    /// The lower end, exactly.
    pub(super) fn lower(&self) -> Dyadic {
        self.middle.negative().plus_bound(self.radius).negative()
    }

    /// The upper end, exactly.
    pub(super) fn upper(&self) -> Dyadic {
        self.middle.plus_bound(self.radius)
    }

    pub(super) fn negative(&self) -> Self {
        Self {
            middle: self.middle.negative(),
            radius: self.radius,
        }
    }

    /// The ball with a greater radius.
    pub(super) fn widened(mut self, by: Bound) -> Self {
        self.radius = self.radius.plus(by);
        self
    }

    /// The order of the numbers of two balls, if it is the same for all.
    pub(super) fn compare(&self, other: &Self) -> Option<Ordering> {
        if self.is_exact() && other.is_exact() {
            return Some(self.middle.compare(&other.middle));
        }
        if self.upper().compare(&other.lower()) == Ordering::Less {
            return Some(Ordering::Less);
        }
        (self.lower().compare(&other.upper()) == Ordering::Greater).then_some(Ordering::Greater)
    }

    /// A bound that is not above the magnitude of any number of the ball: |x| − r, or zero.
    pub(super) fn magnitude_below(&self) -> Bound {
        if self.is_exact() {
            return self.middle.bound_below();
        }
        let size = Self {
            middle: self.middle.abs(),
            radius: self.radius,
        };
        let lower = size.lower();
        if lower.is_negative() {
            Bound::ZERO
        } else {
            lower.bound_below()
        }
    }

    /// The sum. Source: |(X + Y) − (x + y)| ≤ r + s.
    ///
    /// A summand below the last bit of the other one is not shifted to it, but put into the radius.
    ///
    /// Evidence: `sums_and_differences_contain_the_exact_ones`.
    pub(super) fn plus(&self, other: &Self, precision: i64) -> Option<Self> {
        if other.is_zero() {
            return Some(self.clone());
        }
        if self.is_zero() {
            return Some(other.clone());
        }
        let radius = self.radius.plus(other.radius);
        let (large, small) = if self.middle.top() >= other.middle.top() {
            (&self.middle, &other.middle)
        } else {
            (&other.middle, &self.middle)
        };
        if small.is_zero() {
            return Self::rounded(large.clone(), radius, precision);
        }
        if small.top() < large.top() - precision - 2 {
            return Self::rounded(large.clone(), radius.plus(small.bound_above()), precision);
        }
        Self::rounded(large.plus(small), radius, precision)
    }

    /// The product. Source: |X Y − x y| ≤ |x| s + |y| r + r s.
    ///
    /// Evidence: `products_contain_the_exact_ones`.
    pub(super) fn times(&self, other: &Self, precision: i64) -> Option<Self> {
        if self.is_zero() || other.is_zero() {
            return Some(Self::zero());
        }
        let mut radius = Bound::ZERO;
        if !other.is_exact() {
            radius = self.middle.bound_above().times(other.radius);
        }
        if !self.is_exact() {
            let reach = other.middle.bound_above().plus(other.radius);
            radius = radius.plus(reach.times(self.radius));
        }
        let exponent = self.middle.exponent + other.middle.exponent;
        let middle = Dyadic::new(&self.middle.mantissa * &other.middle.mantissa, exponent);
        Self::rounded(middle, radius, precision)
    }

    /// The quotient; `None` if the divisor's ball touches zero.
    ///
    /// ```text
    /// |X/Y − x/y| ≤ (r + |x/y| s) / (|y| − s)
    /// ```
    ///
    /// Source: X/Y − x/y = ((X − x) − (x/y)(Y − y)) / Y. The midpoint is ⌊x 2ᵏ/y⌋ with two bits to spare; a remainder that is not
    /// zero adds one unit.
    ///
    /// Evidence: `quotients_contain_the_exact_ones`.
    pub(super) fn over(&self, other: &Self, precision: i64) -> Option<Self> {
        let least = other.magnitude_below();
        if least.is_zero() {
            return None;
        }
        if self.is_zero() {
            return Some(Self::zero());
        }
        let (x, y) = (&self.middle, &other.middle);
        let k = (precision + 2 + bits(&y.mantissa) - bits(&x.mantissa)).max(0);
        let (quotient, remainder) = shifted(&x.mantissa, k).div_mod_floor(&y.mantissa);
        let middle = Dyadic::new(quotient, x.exponent - y.exponent - k);
        let mut radius = Bound::ZERO;
        if !self.is_exact() || !other.is_exact() {
            let unit = Bound::power(middle.exponent);
            let moved = middle.bound_above().plus(unit).times(other.radius);
            radius = self.radius.plus(moved).over(least)?;
        }
        if !remainder.is_zero() {
            radius = radius.plus(Bound::power(middle.exponent));
        }
        Self::rounded(middle, radius, precision)
    }

    /// The square root; `None` if the ball touches negative numbers.
    ///
    /// ```text
    /// |√X − √x| ≤ r / (√x + √(x − r)) ≤ r / √x
    /// ```
    ///
    /// Source: √X − √x = (X − x)/(√X + √x). The midpoint is the integer square root with two bits to spare; a remainder that is
    /// not zero adds one unit.
    ///
    /// Evidence: `the_square_root_squared_contains_the_number`.
    pub(super) fn sqrt(&self, precision: i64) -> Option<Self> {
        if self.is_zero() {
            return Some(Self::zero());
        }
        if self.lower().is_negative() {
            return None;
        }
        let x = &self.middle;
        // x = m 2ᵉ = (m 2ᵏ) 2ᵉ⁻ᵏ with e − k even, and m 2ᵏ of twice the bits that the root shall have.
        let mut k = (2 * (precision + 2) - bits(&x.mantissa)).max(0);
        k += (x.exponent - k).rem_euclid(2);
        let square = shifted(&x.mantissa, k);
        let root = Roots::sqrt(&square);
        let is_exact = &root * &root == square;
        let middle = Dyadic::new(root, (x.exponent - k) / 2);
        let mut radius = Bound::ZERO;
        if !self.is_exact() {
            radius = self.radius.over(self.root_sum_below(&middle))?;
        }
        if !is_exact {
            radius = radius.plus(Bound::power(middle.exponent));
        }
        Self::rounded(middle, radius, precision)
    }

    /// A bound that is not above √x + √(x − r), where `root` is not above √x: √x alone, or 2√x (1 − 2⁻ᵍ) if r ≤ 2⁻ᵍ x, since
    /// √(1 − δ) ≥ 1 − δ.
    fn root_sum_below(&self, root: &Dyadic) -> Bound {
        let gap = self.middle.top() - 1 - self.radius.top();
        if gap < 2 {
            return root.bound_below();
        }
        let gap = gap.min(60);
        let part = Dyadic::new(BigInt::from((1_i64 << gap) - 1), 1 - gap);
        Dyadic::new(&root.mantissa * &part.mantissa, root.exponent + part.exponent).bound_below()
    }
}
