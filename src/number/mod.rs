//! The number systems in which the equations are evaluated.
//!
//! Each number system proves something different about an equation that is evaluated in it.
//!
//! Every equation of this crate is written once, generic over the number it computes with. The same text then runs on
//! ordinary doubles, on exact rationals, on surds and on rational functions of named unknowns, and each of these says
//! something else about it:
//!
//! | number system                         | bound it meets            | what an evaluation gives                        |
//! |---------------------------------------|---------------------------|-------------------------------------------------|
//! | `f64`                                 | [`Real`]                  | the ordinary, fast filter                       |
//! | [`Rational`]                          | [`Field`]                 | identities with no tolerance                    |
//! | [`Surd`]                              | [`Roots`]                 | cubature points as the papers write them        |
//! | [`RationalFunction`]                  | [`Roots`]                 | identities for all inputs, and for every n      |
//! | [`Enclosure`]                         | [`Real`]                  | certified digits, and inequalities as theorems  |
//! | [`RandomRounding`]                    | [`Real`]                  | how much of a difference is only arithmetic     |
//! | [`Dual`] over another                 | that of the other         | derivatives, proven or certified                |
//! | [`Gradient`] over another             | that of the other         | all derivatives at once                         |
//! | [`Interval`]                          | [`Real`]                  | bounds in doubles: fast, and not narrow         |
//! | [`Counted`]                           | [`Real`]                  | how many operations an evaluation takes         |
//!
//! Reading order: the three traits here; [`Rational`], [`Surd`], [`RationalFunction`] (with [`Polynomial`]), which are exact;
//! [`Enclosure`] and [`Interval`], which know how far they are off, and the doubles, which do not; [`Dual`], [`Gradient`] and
//! [`RandomRounding`] and [`Counted`], which say something about an evaluation besides its value.
//!
//! Three traits say what an equation needs, and an equation has the weakest bound it can live with:
//! [`Field`] (+ − × ÷), [`Roots`] (the square roots of rationals, all that cubature points need) and [`Real`]
//! (roots, exp, ln, sin, cos, atan2, the Stumpff functions, π, and an order).
//!
//! An operation that has no answer (a division by zero, say) is a value that says so, [`Field::undecided`], and never a
//! panic: it is unequal to everything, itself included, and every operation on it gives it again.
//!
//! Example: the gain of a filter with one state, p/(p + r), written once.
//!
//! ```
//! use immaculate::number::{Dual, Field, Rational, RationalFunction};
//!
//! fn gain<T: Field>(p: T, r: T) -> T {
//!     p.clone() / (p + r)
//! }
//!
//! // As a filter computes it, and exactly.
//! assert_eq!(gain(1.0, 3.0), 0.25);
//! assert_eq!(gain(Rational::integer(1), Rational::integer(2)), Rational::new(1, 3));
//! // Prediction and measurement share the weight, for all p and r: p/(p + r) + r/(r + p) = 1.
//! let [p, r] = ["p", "r"].map(RationalFunction::unknown);
//! assert_eq!(gain(p.clone(), r.clone()) + gain(r, p), RationalFunction::integer(1));
//! // The slope in p is r/(p + r)²: 3/16 at p = 1, r = 3.
//! assert_eq!(*gain(Dual::variable(1.0), Dual::constant(3.0)).slope(), 3.0 / 16.0);
//! ```

mod counted;
mod decimal;
mod dual;
mod enclosure;
mod float;
mod gradient;
mod interval;
mod operators;
mod polynomial;
mod radicals;
mod random_rounding;
mod rational;
mod rational_function;
mod surd;

pub use counted::Counted;
pub use dual::Dual;
pub use enclosure::Enclosure;
pub use gradient::Gradient;
pub use interval::Interval;
pub use polynomial::Polynomial;
pub use random_rounding::RandomRounding;
pub use rational::Rational;
pub use rational_function::RationalFunction;
pub use surd::Surd;

use nalgebra::{ClosedAddAssign, ClosedDivAssign, ClosedMulAssign, ClosedSubAssign, Scalar};
use num_traits::{One, Zero};
use std::ops::Neg;

/// A number that can be added, subtracted, multiplied and divided: all that most equations of a filter need.
///
/// The bounds are those under which nalgebra multiplies and adds matrices with shapes in their types.
///
/// Example: the same fraction in two number systems, and a division that has no answer.
///
/// ```
/// use immaculate::number::{Field, Rational};
///
/// assert_eq!((f64::ratio(1, 4), Rational::ratio(1, 4)), (0.25, Rational::new(1, 4)));
/// let undecided = Rational::integer(1) / Rational::integer(0);
/// assert!(!undecided.is_decided() && undecided != undecided.clone());
/// ```
pub trait Field:
    Scalar + Zero + One + ClosedAddAssign + ClosedSubAssign + ClosedMulAssign + ClosedDivAssign + Neg<Output = Self>
{
    /// The rational p/q in this number system: exact where it can be, else the nearest.
    fn rational(value: &Rational) -> Self;

    /// The value that says that an operation had no answer. It is unequal to every value, itself included.
    fn undecided() -> Self;

    /// Whether the value is a number: neither undecided nor infinite.
    ///
    /// Evidence: `only_a_number_is_decided`.
    fn is_decided(&self) -> bool;

    /// The fraction `numerator / denominator` of two integers.
    fn ratio(numerator: i64, denominator: i64) -> Self {
        Self::rational(&Rational::new(numerator, denominator))
    }

    /// An integer.
    fn integer(value: i64) -> Self {
        Self::ratio(value, 1)
    }
}

/// A field that also holds the square roots of rationals: the coordinates of cubature points.
///
/// Example: the distance of a cubature point, √3, exactly and as the nearest double.
///
/// ```
/// use immaculate::number::{Field, Rational, Roots, Surd};
///
/// let root = Surd::root(&Rational::new(3, 1));
/// assert_eq!(Surd::surd(&root) * Surd::surd(&root), Surd::integer(3));
/// assert_eq!(f64::surd(&root), 3.0_f64.sqrt());
/// ```
pub trait Roots: Field {
    /// The surd in this number system: exact where it can be, else the nearest.
    fn surd(value: &Surd) -> Self;
}

/// An ordered number with roots and elementary functions.
///
/// `partial_cmp` answers `None` where a comparison cannot be decided; an equation that branches on a comparison must
/// say what it does then.
///
/// Example: an angle on the cut is +π, and a root that does not exist is undecided.
///
/// ```
/// use immaculate::number::{Field, Real};
///
/// assert_eq!(Real::atan2(&0.0, &-1.0), f64::pi());
/// assert!(!Real::sqrt(&-1.0_f64).is_decided());
/// ```
pub trait Real: Roots + PartialOrd {
    /// The ratio of a circle's circumference to its diameter.
    fn pi() -> Self;
    /// The square root; [`Field::undecided`] for a negative number.
    #[must_use]
    fn sqrt(&self) -> Self;
    /// The exponential.
    #[must_use]
    fn exp(&self) -> Self;
    /// The natural logarithm; −∞ or [`Field::undecided`] at zero, [`Field::undecided`] below.
    #[must_use]
    fn ln(&self) -> Self;
    /// The sine of an angle in radians.
    #[must_use]
    fn sin(&self) -> Self;
    /// The cosine of an angle in radians.
    #[must_use]
    fn cos(&self) -> Self;
    /// The angle of the point (`x`, `self`) in (−π, π]: `y.atan2(&x)`.
    #[must_use]
    fn atan2(&self, x: &Self) -> Self;
    /// The Stumpff function c_k of this number.
    ///
    /// ```text
    /// c_k(t) = Σⱼ (−t)ʲ/(2j + k)!
    ///
    /// c₀(θ²) = cos θ,   c₁(θ²) = sin θ / θ,   c₂(θ²) = (1 − cos θ)/θ²,   c₃(θ²) = (θ − sin θ)/θ³
    /// ```
    ///
    /// Why: these quotients have a value at θ = 0 that a division cannot give. The functions c_k have no singularity, and
    /// c_k(0) = 1/k!; for t < 0 they are the quotients of cosh and sinh.
    ///
    /// Source: K. Stumpff, Himmelsmechanik I, 1959. Two identities tie them together: c_k(t) = 1/k! − t c₍k+2₎(t) and
    /// c_k′ = ½(k c₍k+2₎ − c₍k+1₎).
    ///
    /// Example: the limits at zero, exactly, and a half turn: sin π / π is 0 and (1 − cos π)/π² is 2/π².
    ///
    /// ```
    /// use immaculate::number::Real;
    ///
    /// assert_eq!([0, 1, 2, 3].map(|k| 0.0_f64.stumpff(k)), [1.0, 1.0, 0.5, 1.0 / 6.0]);
    /// let square = f64::pi() * f64::pi();
    /// assert!(square.stumpff(1).abs() < 1e-16 && (square.stumpff(2) * square - 2.0).abs() < 1e-15);
    /// ```
    ///
    /// Evidence: `stumpff_functions_contain_their_series_with_remainder` (enclosed),
    /// `each_stumpff_function_is_tied_to_the_one_two_above`, `the_slope_of_a_stumpff_function_is_made_of_the_next_two` (property).
    #[must_use]
    fn stumpff(&self, k: usize) -> Self;
    /// The bits to which numbers are computed here: how far a series is to be summed.
    ///
    /// Example: doubles, and enclosures of 200 bits.
    ///
    /// ```
    /// use immaculate::number::{Enclosure, Real};
    ///
    /// assert_eq!((f64::bits(), Enclosure::with_precision(200, Enclosure::bits)), (53, 200));
    /// ```
    fn bits() -> u32;
    /// What is left of a series that is summed no further, of which nothing is known but that its magnitude is at most `size`: all numbers
    /// from −`size` to `size`. Zero in number systems that do not know how far they are off.
    ///
    /// Example: an enclosure contains both ends, and a double is the middle.
    ///
    /// ```
    /// use immaculate::number::{Enclosure, Rational, Real};
    ///
    /// let rest = Enclosure::with_precision(64, || Enclosure::up_to(&Enclosure::exact(0.25)));
    /// assert!([-1, 0, 1].iter().all(|sign| rest.contains(&Rational::new(*sign, 4))));
    /// assert_eq!(f64::up_to(&0.25), 0.0);
    /// ```
    #[must_use]
    fn up_to(size: &Self) -> Self;
}
