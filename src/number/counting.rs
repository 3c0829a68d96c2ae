//! Numbers that count their operations: the very same equations say what they cost.
//!
//! After this file the reader knows which operations count, under each of three conventions, and why a matrix product of these numbers
//! costs what it costs on paper.
//!
//! What counts: + and −, ×, ÷, √, and exp, ln, sin, cos, atan2, one each. What does not: a change of sign, a comparison, and what only
//! depends on constants of the program (2π, say), which is computed once.
//!
//! | convention                  | an n × m by m × p product  | zeros and ones in the inputs    |
//! |-----------------------------|----------------------------|---------------------------------|
//! | [`Convention::Matlab`]      | 2nmp                       | numbers like any other          |
//! | [`Convention::Dense`]       | nmp × and n(m − 1)p +      | numbers like any other          |
//! | [`Convention::Structural`]  | only what has to be done   | adding zero, multiplying by zero or one is free |
//!
//! The first is what the function `flops` of MATLAB up to version 5 counted, whose products added into a sum that starts empty.
//!
//! The matrix product of generic numbers in nalgebra is y ← α a x + β y with α = 1 and β = 0 or 1: it multiplies by ones and adds to zeros
//! that are nobody's numbers. So a number knows where it comes from: the zero and the one that a type has by itself are told from a zero
//! and a one among the inputs, and a number that was multiplied by the type's one is known as a factor, or a partial sum, of a product.
//!
//! Source: the count of MATLAB as its documentation described it: one for an addition, subtraction, multiplication, division or elementary
//! function of reals.

use super::operators::{division_operators, ring_operators};
use super::{Field, Rational, Real, Roots, Surd};
use num_traits::{One, Zero};
use std::cell::Cell;
use std::cmp::Ordering;
use std::fmt;

/// Which operations are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Convention {
    /// As MATLAB 5 counted: every matrix is full, and a sum starts with an addition into nothing.
    Matlab,
    /// Every matrix is full; a sum of n numbers has n − 1 additions.
    Dense,
    /// Zeros and ones among the inputs are known for what they are.
    Structural,
}

impl Convention {
    /// All conventions, from the one that counts most.
    pub const ALL: [Self; 3] = [Self::Matlab, Self::Dense, Self::Structural];
}

/// How many operations of each kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tally {
    /// + and − of two numbers.
    pub additions: usize,
    /// Additions into a sum that is still empty.
    pub first_additions: usize,
    /// ×.
    pub multiplications: usize,
    /// ÷.
    pub divisions: usize,
    /// √.
    pub roots: usize,
    /// exp, ln, sin, cos, atan2.
    pub functions: usize,
}

impl Tally {
    /// The number of operations under a convention.
    pub fn total(&self, convention: Convention) -> usize {
        let always = self.additions + self.multiplications + self.divisions + self.roots + self.functions;
        match convention {
            Convention::Matlab => always + self.first_additions,
            Convention::Dense | Convention::Structural => always,
        }
    }

    /// Both together.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        Self {
            additions: self.additions + other.additions,
            first_additions: self.first_additions + other.first_additions,
            multiplications: self.multiplications + other.multiplications,
            divisions: self.divisions + other.divisions,
            roots: self.roots + other.roots,
            functions: self.functions + other.functions,
        }
    }
}

thread_local! {
    /// What has been counted in the innermost scope.
    static TALLY: Cell<Tally> = const { Cell::new(Tally {
        additions: 0, first_additions: 0, multiplications: 0, divisions: 0, roots: 0, functions: 0,
    }) };
}

/// Where a number comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Origin {
    /// The zero of the type: the start of a sum, or a zero of the structure.
    Zero,
    /// The one of the type: a scaling by nothing, or a one of the structure.
    One,
    /// It depends on nothing that is given to the equation.
    Constant,
    /// It depends on what is given.
    Data,
    /// Data times the one of the type: a factor, or the sum so far, inside of a matrix product.
    Scaled,
}

/// A double that counts what is done with it.
///
/// Example: a product of two full 3 × 3 matrices has 27 multiplications and 18 additions, or 2 · 27 operations as MATLAB counted.
///
/// ```
/// use immaculate::number::{Convention, Counting};
/// use nalgebra::Matrix3;
///
/// let full = Matrix3::from_fn(|i, j| Counting::input((2 + i + 3 * j) as f64, Convention::Matlab));
/// let (_, tally) = Counting::count(|| full * full);
/// assert_eq!((tally.multiplications, tally.additions), (27, 18));
/// assert_eq!(tally.total(Convention::Matlab), 2 * 27);
/// assert_eq!(tally.total(Convention::Dense), 27 + 18);
/// ```
#[derive(Clone, Copy)]
pub struct Counting {
    value: f64,
    origin: Origin,
}

impl Counting {
    /// Runs `work` and counts its operations. Scopes can be nested; the outer one counts what the inner one does too. A scope holds for
    /// the thread it is opened in.
    ///
    /// Evidence: `an_outer_count_includes_the_inner_one`.
    pub fn count<R>(work: impl FnOnce() -> R) -> (R, Tally) {
        struct Restore(Tally);
        impl Drop for Restore {
            fn drop(&mut self) {
                TALLY.set(self.0.and(&TALLY.get()));
            }
        }
        let _restore = Restore(TALLY.replace(Tally::default()));
        let result = work();
        (result, TALLY.get())
    }

    /// What an equation is given: under [`Convention::Structural`] a 0 and a 1 are known for what they are, else they are numbers.
    pub fn input(value: f64, convention: Convention) -> Self {
        #[allow(clippy::float_cmp, reason = "only the numbers themselves are meant")]
        let origin = match convention {
            Convention::Structural if value == 0.0 => Origin::Zero,
            Convention::Structural if value == 1.0 => Origin::One,
            _ => Origin::Data,
        };
        Self { value, origin }
    }

    /// The double.
    pub fn value(self) -> f64 {
        self.value
    }

    fn data(value: f64) -> Self {
        Self {
            value,
            origin: Origin::Data,
        }
    }

    fn constant(value: f64) -> Self {
        Self {
            value,
            origin: Origin::Constant,
        }
    }

    /// Whether the number depends on nothing that is given.
    fn is_constant(self) -> bool {
        matches!(self.origin, Origin::Zero | Origin::One | Origin::Constant)
    }

    /// The number as it is outside of a matrix product.
    fn settled(self) -> Self {
        let origin = if self.origin == Origin::Scaled {
            Origin::Data
        } else {
            self.origin
        };
        Self { origin, ..self }
    }

    /// A function of one number.
    fn function(self, value: f64, counted: fn(&mut Tally)) -> Self {
        if self.is_constant() {
            return Self::constant(value);
        }
        note(counted);
        Self::data(value)
    }
}

/// Counts one operation.
fn note(counted: fn(&mut Tally)) {
    let mut tally = TALLY.get();
    counted(&mut tally);
    TALLY.set(tally);
}

#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "the operators are wired for numbers of any size"
)]
impl Counting {
    /// The sum. One with the type's zero is the start of a sum; one with the sum so far of a matrix product takes back that its product
    /// was thought to be the first.
    fn plus(self, other: &Self) -> Self {
        let value = self.value + other.value;
        match (self.origin, other.origin) {
            (Origin::Zero, Origin::Data) | (Origin::Data, Origin::Zero) => {
                note(|tally| tally.first_additions += 1);
                Self::data(value)
            }
            (Origin::Zero, _) => other.settled(),
            (_, Origin::Zero) => self.settled(),
            (Origin::Data, Origin::Scaled) | (Origin::Scaled, Origin::Data) => {
                note(|tally| {
                    tally.additions += 1;
                    tally.first_additions = tally.first_additions.saturating_sub(1);
                });
                Self::data(value)
            }
            _ if self.is_constant() && other.is_constant() => Self::constant(value),
            _ => {
                note(|tally| tally.additions += 1);
                Self::data(value)
            }
        }
    }

    /// The difference: free where one of the two is the type's zero.
    fn minus(self, other: &Self) -> Self {
        let value = self.value - other.value;
        match (self.origin, other.origin) {
            (_, Origin::Zero) => self.settled(),
            (Origin::Zero, _) => other.negative(),
            _ if self.is_constant() && other.is_constant() => Self::constant(value),
            _ => {
                note(|tally| tally.additions += 1);
                Self::data(value)
            }
        }
    }

    /// The product: free where one of the two is the type's zero or one. That of a factor inside of a matrix product is thought to be the
    /// first of its sum until it is added to another.
    fn times(self, other: &Self) -> Self {
        let value = self.value * other.value;
        match (self.origin, other.origin) {
            (Origin::Zero, _) | (_, Origin::Zero) => Self::zero(),
            (Origin::One, Origin::Data) => Self {
                value,
                origin: Origin::Scaled,
            },
            (Origin::One, _) => *other,
            (_, Origin::One) => self.settled(),
            (Origin::Scaled, _) => {
                note(|tally| {
                    tally.multiplications += 1;
                    tally.first_additions += 1;
                });
                Self::data(value)
            }
            _ if self.is_constant() && other.is_constant() => Self::constant(value),
            _ => {
                note(|tally| tally.multiplications += 1);
                Self::data(value)
            }
        }
    }

    /// The quotient: free where the divisor is the type's one, or the dividend its zero.
    fn over(self, other: &Self) -> Self {
        let value = self.value / other.value;
        match (self.origin, other.origin) {
            (_, Origin::One) => self.settled(),
            (Origin::Zero, Origin::Data | Origin::Scaled) => Self::zero(),
            _ if self.is_constant() && other.is_constant() => Self::constant(value),
            _ => {
                note(|tally| tally.divisions += 1);
                Self::data(value)
            }
        }
    }

    /// The number with the other sign, which costs nothing.
    fn negative(self) -> Self {
        match self.origin {
            Origin::Zero => self,
            Origin::One | Origin::Constant => Self::constant(-self.value),
            Origin::Data | Origin::Scaled => Self::data(-self.value),
        }
    }
}

ring_operators!(Counting);
division_operators!(Counting);

impl Zero for Counting {
    fn zero() -> Self {
        Self {
            value: 0.0,
            origin: Origin::Zero,
        }
    }

    fn is_zero(&self) -> bool {
        self.value == 0.0
    }
}

impl One for Counting {
    fn one() -> Self {
        Self {
            value: 1.0,
            origin: Origin::One,
        }
    }
}

impl Field for Counting {
    fn rational(value: &Rational) -> Self {
        Self::constant(value.to_f64())
    }

    fn undecided() -> Self {
        Self::constant(f64::NAN)
    }

    fn is_decided(&self) -> bool {
        self.value.is_finite()
    }
}

impl Roots for Counting {
    fn surd(value: &Surd) -> Self {
        Self::constant(value.to_f64())
    }
}

impl Real for Counting {
    fn pi() -> Self {
        Self::constant(f64::pi())
    }

    fn sqrt(&self) -> Self {
        self.function(Real::sqrt(&self.value), |tally| tally.roots += 1)
    }

    fn exp(&self) -> Self {
        self.function(Real::exp(&self.value), |tally| tally.functions += 1)
    }

    fn ln(&self) -> Self {
        self.function(Real::ln(&self.value), |tally| tally.functions += 1)
    }

    fn sin(&self) -> Self {
        self.function(Real::sin(&self.value), |tally| tally.functions += 1)
    }

    fn cos(&self) -> Self {
        self.function(Real::cos(&self.value), |tally| tally.functions += 1)
    }

    fn atan2(&self, x: &Self) -> Self {
        let value = Real::atan2(&self.value, &x.value);
        let depends = if self.is_constant() { x } else { self };
        depends.function(value, |tally| tally.functions += 1)
    }

    fn stumpff(&self, k: usize) -> Self {
        self.function(self.value.stumpff(k), |tally| tally.functions += 1)
    }
}

impl PartialEq for Counting {
    /// Equality of the doubles; where they come from does not matter.
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl PartialOrd for Counting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}

impl fmt::Display for Counting {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.value, formatter)
    }
}

impl fmt::Debug for Counting {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.value, formatter)
    }
}
