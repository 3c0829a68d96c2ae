//! Intervals of doubles: fast enclosures of 53 bits, for what needs to be proven and not to be narrow.
//!
//! An [`Interval`] is all numbers from m − r to m + r with doubles m and r. Every operation gives an interval that contains every result
//! of the operation on numbers of its operands: m is the operation on the midpoints, rounded to the nearest, and r takes the bound of how
//! far the operation moves within the operands, and the rounding of m:
//!
//! ```text
//! |fl(x ∘ y) − x ∘ y| ≤ u |fl(x ∘ y)| + η,   u = 2⁻⁵³,  η = 2⁻¹⁰⁷⁵      for ∘ one of + − × ÷, and for √
//! ```
//!
//! A radius is computed in doubles too, from at most six rounded operations on numbers that are not negative: it is raised by 2⁻⁶⁰⁰,
//! which is above all that underflow takes away, and by the factor 1 + 16u, which is above (1 − u)⁻⁸. The rounding mode is never changed.
//!
//! Zero and one without a radius stay exact: 0 + x is x, 0 x is zero, and 1 x is x. All other results have a radius.
//!
//! Elementary functions are those of [`Enclosure`] with 64 bits, whose proof is there. Where more digits are needed, so is [`Enclosure`]:
//! this is for the many derivatives along long runs, where a few digits are enough.

use super::operators::{division_operators, ring_operators};
use super::{Enclosure, Field, Rational, Real, Roots, Surd};
use num_traits::{One, Zero};
use std::cmp::Ordering;
use std::fmt;

/// u, the unit roundoff of a double.
const ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// 1 + 16u: what raises a radius above its own rounding.
const ABOVE: f64 = 1.0 + 8.0 * f64::EPSILON;

/// 1 − 16u: what lowers a bound below its own rounding.
const BELOW: f64 = 1.0 - 8.0 * f64::EPSILON;

/// 2⁻⁶⁰⁰, which is more than all that underflow takes away, and so large that products with it are still normal.
const UNDERFLOW: f64 = 2.409_919_865_102_884e-181;

/// 2⁻¹⁰⁰⁰, the same where it is divided by something small.
const UNDERFLOW_OF_NUMERATOR: f64 = 9.332_636_185_032_189e-302;

/// Up to here, 2⁵³, every integer is a double.
const LARGEST_EXACT_INTEGER: u64 = 1 << 53;

/// The bits with which elementary functions are computed.
const BITS: u32 = 64;

/// A number that is known to lie between two doubles, or the statement that an operation had no answer.
///
/// Example: a third, and what is left of it after a cancellation.
///
/// ```
/// use immaculate::number::{Field, Interval, Rational};
///
/// let third = Interval::exact(1.0) / Interval::exact(3.0);
/// assert!(third.contains(&Rational::new(1, 3)) && third.radius() < 1e-16);
/// let rest = third * Interval::exact(3.0) - Interval::exact(1.0);
/// assert!(rest.contains(&Rational::integer(0)) && rest.radius() < 1e-15);
/// assert!(!(Interval::exact(1.0) / rest).is_decided());
/// ```
///
/// Evidence: `an_interval_contains_what_exact_arithmetic_gives` (certified_runs).
#[derive(Clone, Copy)]
pub struct Interval {
    /// m; NaN for a value that is undecided.
    middle: f64,
    /// r; it may be infinite, which is undecided too.
    radius: f64,
}

impl Interval {
    const ZERO: Self = Self {
        middle: 0.0,
        radius: 0.0,
    };

    const UNDECIDED: Self = Self {
        middle: f64::NAN,
        radius: f64::NAN,
    };

    /// The double itself; undecided if it is not finite.
    pub fn exact(value: f64) -> Self {
        if !value.is_finite() {
            return Self::UNDECIDED;
        }
        Self {
            middle: value,
            radius: 0.0,
        }
    }

    /// All numbers that are no farther than `radius` from `middle`; undecided if these are not finite, or the radius is negative.
    pub fn around(middle: f64, radius: f64) -> Self {
        if radius == 0.0 {
            return Self::exact(middle);
        }
        if radius > 0.0 && radius.is_finite() && middle.is_finite() {
            Self {
                middle,
                radius: radius * ABOVE + UNDERFLOW,
            }
        } else {
            Self::UNDECIDED
        }
    }

    /// An interval that contains an enclosure.
    ///
    /// Example: the root of two, from 200 bits.
    ///
    /// ```
    /// use immaculate::number::{Enclosure, Field, Interval, Real};
    ///
    /// let root = Enclosure::with_precision(200, || Real::sqrt(&Enclosure::integer(2)));
    /// let interval = Interval::containing(&root);
    /// assert!(interval.contains(&root.lower()) && interval.contains(&root.upper()));
    /// ```
    pub fn containing(enclosure: &Enclosure) -> Self {
        let (middle, width) = (enclosure.middle(), enclosure.width());
        if width == 0.0 && Enclosure::exact(middle) == *enclosure {
            return Self::exact(middle);
        }
        // The double is the one nearest to the middle.
        Self::around(middle, width / 2.0 + ROUNDOFF * middle.abs())
    }

    /// m.
    pub fn middle(self) -> f64 {
        self.middle
    }

    /// r.
    pub fn radius(self) -> f64 {
        self.radius
    }

    /// A double that is not below the magnitude of any number of the interval.
    pub fn magnitude(self) -> f64 {
        if self.radius == 0.0 {
            return self.middle.abs();
        }
        (self.middle.abs() + self.radius) * ABOVE
    }

    /// Whether the number is in the interval; false if either is undecided.
    pub fn contains(self, value: &Rational) -> bool {
        self.enclosure().contains(value)
    }

    /// The same interval as an enclosure.
    fn enclosure(self) -> Enclosure {
        Enclosure::around(self.middle, self.radius)
    }

    /// A function of enclosures at this interval.
    fn by_enclosure(self, function: impl Fn(&Enclosure) -> Enclosure) -> Self {
        Enclosure::with_precision(BITS, || Self::containing(&function(&self.enclosure())))
    }

    /// The sum. Source: |(X + Y) − (x + y)| ≤ r + s.
    fn plus(&self, other: &Self) -> Self {
        if self.is_zero() {
            return *other;
        }
        if other.is_zero() {
            return *self;
        }
        let middle = self.middle + other.middle;
        let radius = self.radius + other.radius + ROUNDOFF * middle.abs() + UNDERFLOW;
        Self {
            middle,
            radius: radius * ABOVE,
        }
    }

    /// The difference.
    fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negative())
    }

    /// The product. Source: |X Y − x y| ≤ |x| s + r (|y| + s).
    fn times(&self, other: &Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return if self.is_decided() && other.is_decided() {
                Self::ZERO
            } else {
                Self::UNDECIDED
            };
        }
        if other.is_one() {
            return *self;
        }
        if self.is_one() {
            return *other;
        }
        let middle = self.middle * other.middle;
        let moved = self.middle.abs() * other.radius + self.radius * (other.middle.abs() + other.radius);
        let radius = moved + ROUNDOFF * middle.abs() + UNDERFLOW;
        Self {
            middle,
            radius: radius * ABOVE,
        }
    }

    /// The quotient; undecided if the divisor may be zero.
    ///
    /// Source: X/Y − q = ((X − x) + (x − q y) − q (Y − y)) / Y, and |x − q y| ≤ u |x| for q = fl(x/y).
    fn over(&self, other: &Self) -> Self {
        let least = (other.middle.abs() - other.radius) * BELOW;
        if !self.is_decided() || !other.is_decided() || least <= 0.0 {
            return Self::UNDECIDED;
        }
        if self.is_zero() {
            return Self::ZERO;
        }
        let middle = self.middle / other.middle;
        let moved = self.radius + middle.abs() * other.radius + ROUNDOFF * self.middle.abs() + UNDERFLOW_OF_NUMERATOR;
        Self {
            middle,
            radius: (moved * ABOVE / least + UNDERFLOW) * ABOVE,
        }
    }

    /// The number with the other sign.
    fn negative(&self) -> Self {
        Self {
            middle: -self.middle,
            radius: self.radius,
        }
    }
}

ring_operators!(Interval);
division_operators!(Interval);

impl Zero for Interval {
    fn zero() -> Self {
        Self::ZERO
    }

    /// Whether the number is known to be zero: no other number is in the interval.
    fn is_zero(&self) -> bool {
        self.middle == 0.0 && self.radius == 0.0
    }
}

impl One for Interval {
    fn one() -> Self {
        Self::exact(1.0)
    }

    fn is_one(&self) -> bool {
        self.radius == 0.0 && self.middle.to_bits() == 1.0_f64.to_bits()
    }
}

impl Field for Interval {
    fn rational(value: &Rational) -> Self {
        Self::ZERO.by_enclosure(|_| Enclosure::rational(value))
    }

    fn undecided() -> Self {
        Self::UNDECIDED
    }

    fn is_decided(&self) -> bool {
        self.middle.is_finite() && self.radius.is_finite()
    }

    /// The integer itself if it is a double.
    fn integer(value: i64) -> Self {
        if value.unsigned_abs() <= LARGEST_EXACT_INTEGER {
            return Self::exact(value as f64);
        }
        Self::containing(&Enclosure::integer(value))
    }

    fn ratio(numerator: i64, denominator: i64) -> Self {
        Self::integer(numerator) / Self::integer(denominator)
    }
}

impl Roots for Interval {
    fn surd(value: &Surd) -> Self {
        Self::ZERO.by_enclosure(|_| Enclosure::surd(value))
    }
}

impl Real for Interval {
    /// The double nearest to π, and half its last place.
    fn pi() -> Self {
        Self::around(std::f64::consts::PI, f64::EPSILON)
    }

    /// Source: |√X − √x| ≤ r/√x.
    fn sqrt(&self) -> Self {
        if self.is_zero() {
            return Self::ZERO;
        }
        if !self.is_decided() || self.middle < self.radius {
            return Self::UNDECIDED;
        }
        let middle = self.middle.sqrt();
        let radius = self.radius / middle + ROUNDOFF * middle + UNDERFLOW;
        Self {
            middle,
            radius: radius * ABOVE,
        }
    }

    fn exp(&self) -> Self {
        self.by_enclosure(Real::exp)
    }

    fn ln(&self) -> Self {
        self.by_enclosure(Real::ln)
    }

    fn sin(&self) -> Self {
        self.by_enclosure(Real::sin)
    }

    fn cos(&self) -> Self {
        self.by_enclosure(Real::cos)
    }

    fn atan2(&self, x: &Self) -> Self {
        self.by_enclosure(|y| y.atan2(&x.enclosure()))
    }

    fn stumpff(&self, k: usize) -> Self {
        self.by_enclosure(|t| t.stumpff(k))
    }

    fn bits() -> u32 {
        f64::bits()
    }

    fn up_to(size: &Self) -> Self {
        Self::around(0.0, size.magnitude())
    }
}

impl PartialEq for Interval {
    /// Whether both are known to be the same number: points, and equal.
    fn eq(&self, other: &Self) -> bool {
        self.partial_cmp(other) == Some(Ordering::Equal)
    }
}

impl PartialOrd for Interval {
    /// The order, if all numbers of the one interval have it to all numbers of the other.
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        if self.radius == 0.0 && other.radius == 0.0 {
            return self.middle.partial_cmp(&other.middle);
        }
        // The ends are rounded to the nearest: the next double is outside.
        let lower = |interval: &Self| (interval.middle - interval.radius).next_down();
        let upper = |interval: &Self| (interval.middle + interval.radius).next_up();
        if upper(self) < lower(other) {
            Some(Ordering::Less)
        } else if lower(self) > upper(other) {
            Some(Ordering::Greater)
        } else {
            None
        }
    }
}

impl fmt::Display for Interval {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(&format!("{:e} ± {:e}", self.middle, self.radius))
    }
}

impl fmt::Debug for Interval {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, formatter)
    }
}
