//! Gradients: a number with its derivatives in several directions, so that one run of an equation gives a whole Jacobian.
//!
//! ```text
//! d(x ± y) = dx ± dy      d(x y) = y dx + x dy      d(x/y) = (dx − (x/y) dy)/y      d f(x) = f′(x) dx
//! ```
//!
//! A [`Dual`](super::Dual) number is one with a single direction. Here a number that does not change has no list of derivatives at all,
//! and what is computed from such numbers has none either: that a derivative is exactly zero in every direction, over all that an
//! interval holds, can then be read off ([`Gradient::is_constant`]).
//!
//! Over [`Enclosure`](super::Enclosure) or [`Interval`](super::Interval) the derivatives are those at every point of a box, each enclosed,
//! if the run finishes without anything undecided: roots and quotients exist on the whole box, and each comparison comes out the same
//! there. So the mean-value form holds: f(s) − f(m) = J (s − m) with a J inside, for all s and m of the box.
//!
//! Source: Wengert 1964, for the forward mode; R. E. Moore, Interval Analysis, 1966, for derivatives over a box.

use super::operators::{division_operators, ring_operators};
use super::{Field, Rational, Real, Roots, Surd};
use num_traits::{One, Zero};
use std::cmp::Ordering;
use std::fmt;

/// A number and its derivatives.
///
/// Example: x² y at (3, 2).
///
/// ```
/// use immaculate::number::{Field, Gradient};
///
/// let [x, y] = [(3.0, 0), (2.0, 1)].map(|(value, direction)| Gradient::variable(value, direction, 2));
/// let product = x.clone() * x.clone() * y;
/// assert_eq!((product.value(), product.slopes()), (&18.0, &[12.0, 9.0][..])); // 2xy, x²
/// // What is made of constants is a constant.
/// assert!((Gradient::constant(2.0) * Gradient::integer(3)).is_constant() && !x.is_constant());
/// ```
///
/// Evidence: `a_gradient_is_made_of_the_slopes_of_dual_numbers` (certified_runs).
#[derive(Clone)]
pub struct Gradient<T> {
    value: T,
    /// One derivative a direction, or none at all where the number does not change.
    slopes: Vec<T>,
}

impl<T: Field> Gradient<T> {
    /// A number that does not change.
    pub fn constant(value: T) -> Self {
        let slopes = Vec::new();
        Self { value, slopes }
    }

    /// The variable of one direction, counted from 0, of a number of directions.
    pub fn variable(value: T, direction: usize, directions: usize) -> Self {
        let unit = |k| if k == direction { T::one() } else { T::zero() };
        Self {
            value,
            slopes: (0..directions).map(unit).collect(),
        }
    }

    /// The number.
    pub fn value(&self) -> &T {
        &self.value
    }

    /// Its derivatives, one a direction; none for a constant.
    pub fn slopes(&self) -> &[T] {
        &self.slopes
    }

    /// Whether the number is known not to change in any direction.
    pub fn is_constant(&self) -> bool {
        self.slopes.is_empty()
    }

    /// The sum.
    fn plus(&self, other: &Self) -> Self {
        let sum = |a: &T, b: &T| a.clone() + b.clone();
        Self {
            value: sum(&self.value, &other.value),
            slopes: both(&self.slopes, &other.slopes, Clone::clone, Clone::clone, sum),
        }
    }

    /// The difference.
    fn minus(&self, other: &Self) -> Self {
        let difference = |a: &T, b: &T| a.clone() - b.clone();
        Self {
            value: difference(&self.value, &other.value),
            slopes: both(&self.slopes, &other.slopes, Clone::clone, |b| -b.clone(), difference),
        }
    }

    /// The product: y dx + x dy. What is multiplied by exactly zero does not count, and a factor of exactly one changes nothing.
    fn times(&self, other: &Self) -> Self {
        let (x, y) = (&self.value, &other.value);
        if self.is_constant() && x.is_one() {
            return other.clone();
        }
        if other.is_constant() && y.is_one() {
            return self.clone();
        }
        let dx: &[T] = if y.is_zero() { &[] } else { &self.slopes };
        let dy: &[T] = if x.is_zero() { &[] } else { &other.slopes };
        let by_y = |dx: &T| dx.clone() * y.clone();
        let by_x = |dy: &T| dy.clone() * x.clone();
        Self {
            value: x.clone() * y.clone(),
            slopes: both(dx, dy, by_y, by_x, |dx, dy| by_y(dx) + by_x(dy)),
        }
    }

    /// The quotient: (dx − (x/y) dy)/y. Where x is exactly zero, dy does not count.
    fn over(&self, other: &Self) -> Self {
        let inverse = T::one() / other.value.clone();
        let quotient = self.value.clone() / other.value.clone();
        let factor = -(quotient.clone() * inverse.clone());
        let dy: &[T] = if quotient.is_zero() { &[] } else { &other.slopes };
        let by_x = |dx: &T| dx.clone() * inverse.clone();
        let by_y = |dy: &T| dy.clone() * factor.clone();
        Self {
            value: quotient,
            slopes: both(&self.slopes, dy, by_x, by_y, |dx, dy| by_x(dx) + by_y(dy)),
        }
    }

    /// The number with the other sign.
    fn negative(&self) -> Self {
        Self {
            value: -self.value.clone(),
            slopes: self.slopes.iter().map(|slope| -slope.clone()).collect(),
        }
    }

    /// A function of the number, from its value and its derivative there.
    fn chain(&self, value: T, derivative: impl FnOnce() -> T) -> Self {
        if self.is_constant() {
            return Self::constant(value);
        }
        let derivative = derivative();
        let slopes = self.slopes.iter().map(|slope| derivative.clone() * slope.clone());
        Self {
            value,
            slopes: slopes.collect(),
        }
    }
}

/// The derivatives of an operation on two numbers, of which either may have none: what the left one alone gives, the right one alone, or
/// both. Numbers of other directions have nothing in common, and give what is undecided.
fn both<T: Field>(
    left: &[T],
    right: &[T],
    of_left: impl Fn(&T) -> T,
    of_right: impl Fn(&T) -> T,
    of_both: impl Fn(&T, &T) -> T,
) -> Vec<T> {
    match (left.len(), right.len()) {
        (_, 0) => left.iter().map(of_left).collect(),
        (0, _) => right.iter().map(of_right).collect(),
        (a, b) if a == b => left
            .iter()
            .zip(right)
            .map(|(left, right)| of_both(left, right))
            .collect(),
        (a, b) => (0..a.max(b)).map(|_| T::undecided()).collect(),
    }
}

ring_operators!(Gradient<T> [T: Field]);
division_operators!(Gradient<T> [T: Field]);

impl<T: Field> Zero for Gradient<T> {
    fn zero() -> Self {
        Self::constant(T::zero())
    }

    /// Whether the value is zero, and stays so.
    fn is_zero(&self) -> bool {
        self.value.is_zero() && self.slopes.iter().all(T::is_zero)
    }
}

impl<T: Field> One for Gradient<T> {
    fn one() -> Self {
        Self::constant(T::one())
    }
}

impl<T: Field> Field for Gradient<T> {
    fn rational(value: &Rational) -> Self {
        Self::constant(T::rational(value))
    }

    fn undecided() -> Self {
        Self::constant(T::undecided())
    }

    fn is_decided(&self) -> bool {
        self.value.is_decided() && self.slopes.iter().all(T::is_decided)
    }

    /// The integer, by the shortest way of the system below.
    fn integer(value: i64) -> Self {
        Self::constant(T::integer(value))
    }

    /// The fraction, by the shortest way of the system below.
    fn ratio(numerator: i64, denominator: i64) -> Self {
        Self::constant(T::ratio(numerator, denominator))
    }
}

impl<T: Roots> Roots for Gradient<T> {
    fn surd(value: &Surd) -> Self {
        Self::constant(T::surd(value))
    }
}

impl<T: Real> Real for Gradient<T> {
    fn pi() -> Self {
        Self::constant(T::pi())
    }

    /// d√x = dx/(2√x).
    fn sqrt(&self) -> Self {
        let root = self.value.sqrt();
        self.chain(root.clone(), || T::one() / (T::integer(2) * root))
    }

    /// d eˣ = eˣ dx.
    fn exp(&self) -> Self {
        let power = self.value.exp();
        self.chain(power.clone(), || power)
    }

    /// d ln x = dx/x.
    fn ln(&self) -> Self {
        self.chain(self.value.ln(), || T::one() / self.value.clone())
    }

    /// d sin x = cos x dx.
    fn sin(&self) -> Self {
        self.chain(self.value.sin(), || self.value.cos())
    }

    /// d cos x = −sin x dx.
    fn cos(&self) -> Self {
        self.chain(self.value.cos(), || -self.value.sin())
    }

    /// d atan2(y, x) = (x dy − y dx)/(x² + y²).
    fn atan2(&self, x: &Self) -> Self {
        let angle = self.value.atan2(&x.value);
        if self.is_constant() && x.is_constant() {
            return Self::constant(angle);
        }
        let (y, x, dy, dx) = (&self.value, &x.value, &self.slopes, &x.slopes);
        let squared = x.clone() * x.clone() + y.clone() * y.clone();
        let (of_y, of_x) = (x.clone() / squared.clone(), -(y.clone() / squared));
        let by_y = |dy: &T| of_y.clone() * dy.clone();
        let by_x = |dx: &T| of_x.clone() * dx.clone();
        Self {
            value: angle,
            slopes: both(dy, dx, by_y, by_x, |dy, dx| by_y(dy) + by_x(dx)),
        }
    }

    /// d c_k(t) = ½(k c₍k+2₎(t) − c₍k+1₎(t)) dt.
    fn stumpff(&self, k: usize) -> Self {
        self.chain(self.value.stumpff(k), || {
            let factor = T::integer(i64::try_from(k).unwrap_or(i64::MAX));
            (factor * self.value.stumpff(k + 2) - self.value.stumpff(k + 1)) / T::integer(2)
        })
    }

    fn bits() -> u32 {
        T::bits()
    }

    /// The size of a rest says nothing of its slopes: those that it has are undecided.
    fn up_to(size: &Self) -> Self {
        Self {
            value: T::up_to(&size.value),
            slopes: size.slopes.iter().map(|_| T::undecided()).collect(),
        }
    }
}

impl<T: PartialEq> PartialEq for Gradient<T> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value && self.slopes == other.slopes
    }
}

impl<T: PartialOrd> PartialOrd for Gradient<T> {
    /// The order of the values: what an equation decides by a comparison, it decides for all that the values hold.
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}

impl<T: fmt::Display> fmt::Display for Gradient<T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let slopes: Vec<String> = self.slopes.iter().map(T::to_string).collect();
        formatter.pad(&format!("{} ∂ [{}]", self.value, slopes.join(", ")))
    }
}

impl<T: fmt::Debug> fmt::Debug for Gradient<T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(&format!("{:?} ∂ {:?}", self.value, self.slopes))
    }
}
