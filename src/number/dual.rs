//! Dual numbers a + bε with ε² = 0: an equation evaluated on them gives its own derivative.
//!
//! Running code on them proves its first-order expansion.
//!
//! ```text
//! (a + bε) + (c + dε) = (a + c) + (b + d)ε
//! (a + bε) · (c + dε) = ac + (ad + bc)ε                     the product rule
//! (a + bε) / (c + dε) = a/c + (b − (a/c) d)/c · ε           the quotient rule
//! f(a + bε)           = f(a) + f′(a) b ε                    the chain rule
//! ```
//!
//! The two parts are numbers of any other system. Over rational functions a derivative is proven for all inputs; over enclosures it has
//! certified digits; over doubles it is the ordinary automatic differentiation, forward.
//!
//! A dual number without a value, ε itself say, has no inverse: dual numbers are a ring in which all else can be divided by, and not a
//! field. That is what [`Field::undecided`] is for.
//!
//! Source: Clifford 1873; for derivatives, Wengert 1964.

use super::operators::{division_operators, ring_operators};
use super::{Field, Rational, Real, Roots, Surd};
use num_traits::{One, Zero};
use std::cmp::Ordering;
use std::fmt;

/// A number and its first-order change.
///
/// Example: a derivative that is proven by evaluating the function.
///
/// ```
/// use immaculate::number::{Dual, Field, RationalFunction};
///
/// // The derivative of x/(1 + x) is 1/(1 + x)², for every x.
/// let (x, one) = (RationalFunction::unknown("x"), RationalFunction::integer(1));
/// let changing = Dual::variable(x.clone());
/// let fraction = changing.clone() / (Dual::constant(one.clone()) + changing);
/// let below = one.clone() + x;
/// assert_eq!(*fraction.slope(), one / (below.clone() * below));
/// ```
#[derive(Clone, PartialEq)]
pub struct Dual<T> {
    /// a.
    value: T,
    /// b.
    slope: T,
}

impl<T: Field> Dual<T> {
    /// a + bε.
    pub fn new(value: T, slope: T) -> Self {
        Self { value, slope }
    }

    /// A number that does not change: a + 0ε.
    pub fn constant(value: T) -> Self {
        Self::new(value, T::zero())
    }

    /// The number that everything is differentiated by: a + 1ε.
    pub fn variable(value: T) -> Self {
        Self::new(value, T::one())
    }

    /// a.
    pub fn value(&self) -> &T {
        &self.value
    }

    /// b, the derivative if the inputs were one [`Dual::variable`] and constants.
    pub fn slope(&self) -> &T {
        &self.slope
    }

    /// The sum.
    fn plus(&self, other: &Self) -> Self {
        Self::new(
            self.value.clone() + other.value.clone(),
            self.slope.clone() + other.slope.clone(),
        )
    }

    /// The difference.
    fn minus(&self, other: &Self) -> Self {
        Self::new(
            self.value.clone() - other.value.clone(),
            self.slope.clone() - other.slope.clone(),
        )
    }

    /// The product.
    fn times(&self, other: &Self) -> Self {
        Self::new(
            self.value.clone() * other.value.clone(),
            self.value.clone() * other.slope.clone() + self.slope.clone() * other.value.clone(),
        )
    }

    /// The quotient; undecided if the divisor has no value.
    fn over(&self, other: &Self) -> Self {
        let quotient = self.value.clone() / other.value.clone();
        let slope = (self.slope.clone() - quotient.clone() * other.slope.clone()) / other.value.clone();
        Self::new(quotient, slope)
    }

    /// The number with the other sign.
    fn negative(&self) -> Self {
        Self::new(-self.value.clone(), -self.slope.clone())
    }

    /// A function of the number, from its value and its derivative there.
    fn chain(&self, value: T, derivative: T) -> Self {
        Self::new(value, derivative * self.slope.clone())
    }
}

ring_operators!(Dual<T> [T: Field]);
division_operators!(Dual<T> [T: Field]);

impl<T: Field> Zero for Dual<T> {
    fn zero() -> Self {
        Self::constant(T::zero())
    }

    /// Whether both parts are zero: ε is not.
    fn is_zero(&self) -> bool {
        self.value.is_zero() && self.slope.is_zero()
    }
}

impl<T: Field> One for Dual<T> {
    fn one() -> Self {
        Self::constant(T::one())
    }
}

impl<T: Field> Field for Dual<T> {
    fn rational(value: &Rational) -> Self {
        Self::constant(T::rational(value))
    }

    fn undecided() -> Self {
        Self::new(T::undecided(), T::undecided())
    }

    fn is_decided(&self) -> bool {
        self.value.is_decided() && self.slope.is_decided()
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

impl<T: Roots> Roots for Dual<T> {
    fn surd(value: &Surd) -> Self {
        Self::constant(T::surd(value))
    }
}

impl<T: Real> Real for Dual<T> {
    fn pi() -> Self {
        Self::constant(T::pi())
    }

    /// d√x = dx/(2√x).
    fn sqrt(&self) -> Self {
        let root = self.value.sqrt();
        self.chain(root.clone(), T::one() / (T::integer(2) * root))
    }

    /// d eˣ = eˣ dx.
    fn exp(&self) -> Self {
        let power = self.value.exp();
        self.chain(power.clone(), power)
    }

    /// d ln x = dx/x.
    fn ln(&self) -> Self {
        self.chain(self.value.ln(), T::one() / self.value.clone())
    }

    /// d sin x = cos x dx.
    fn sin(&self) -> Self {
        self.chain(self.value.sin(), self.value.cos())
    }

    /// d cos x = −sin x dx.
    fn cos(&self) -> Self {
        self.chain(self.value.cos(), -self.value.sin())
    }

    /// d atan2(y, x) = (x dy − y dx)/(x² + y²).
    fn atan2(&self, x: &Self) -> Self {
        let y = self;
        let turned = x.value.clone() * y.slope.clone() - y.value.clone() * x.slope.clone();
        let squared = x.value.clone() * x.value.clone() + y.value.clone() * y.value.clone();
        Self::new(y.value.atan2(&x.value), turned / squared)
    }

    /// d c_k(t) = ½(k c₍k+2₎(t) − c₍k+1₎(t)) dt.
    fn stumpff(&self, k: usize) -> Self {
        let (next, second) = (self.value.stumpff(k + 1), self.value.stumpff(k + 2));
        let factor = T::integer(i64::try_from(k).unwrap_or(i64::MAX));
        self.chain(self.value.stumpff(k), (factor * second - next) / T::integer(2))
    }

    fn bits() -> u32 {
        T::bits()
    }

    /// The size of a rest says nothing of its slope, which is undecided where it is not zero.
    fn up_to(size: &Self) -> Self {
        Self::new(T::up_to(&size.value), T::up_to(&T::undecided()))
    }
}

impl<T: PartialOrd> PartialOrd for Dual<T> {
    /// The order in which ε is positive and smaller than every positive number: by the values, and by the slopes where these are equal.
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self.value.partial_cmp(&other.value) {
            Some(Ordering::Equal) => self.slope.partial_cmp(&other.slope),
            order => order,
        }
    }
}

impl<T: fmt::Display> fmt::Display for Dual<T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(&format!("{} + ({})ε", self.value, self.slope))
    }
}

impl<T: fmt::Debug> fmt::Debug for Dual<T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(&format!("{:?} + ({:?})ε", self.value, self.slope))
    }
}
