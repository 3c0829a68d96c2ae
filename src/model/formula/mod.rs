//! Formulas as data: functions of named numbers, read from text and evaluated in every number system.
//!
//! Every accepted formula can be evaluated in bounded time.
//!
//! | file     | what is in it                                                          |
//! |----------|------------------------------------------------------------------------|
//! | here     | [`Formulas`], a flat list of operations: its values, its Jacobian       |
//! | `name`   | what may be a name, and which functions there are                       |
//! | `token`  | words, numbers and signs of a text, with their places                   |
//! | `reader` | from these to the list of operations                                    |
//! | `fold`   | which operations are constant, so that a division by zero is seen       |
//! | `error`  | what is wrong with a text, and where                                    |
//! | `text`   | from the list of operations back to text                                |
//!
//! What can be written:
//!
//! | written                                | means                                                                         |
//! |----------------------------------------|-------------------------------------------------------------------------------|
//! | `x`, `turn_rate`                       | a component, parameter or other number that the caller binds; a definition     |
//! | `2`, `0.1`, `1e-3`                     | the double nearest to the decimal                                              |
//! | `a + b`, `a - b`, `a * b`, `a / b`, `-a` | the four operations, × ÷ before + −; also `·`, `×`, `÷` and `−`              |
//! | `a^2`, `a^-1`, `a**2`                  | a power with an integer from −64 to 64, before × ÷ and before a minus sign      |
//! | `(a + b)`                              | parentheses, at most 100 deep                                                  |
//! | `pi`                                   | the circle number                                                              |
//! | `sqrt(a)`, `exp(a)`, `ln(a)`           | root, exponential, natural logarithm                                           |
//! | `sin(a)`, `cos(a)`, `tan(a)`           | of an angle in radians                                                         |
//! | `atan2(y, x)`, `hypot(x, y)`           | angle and length of the vector (x, y)                                          |
//! | `c0(t)` to `c9(t)`                     | Stumpff functions, [`Real::stumpff`]                                           |
//!
//! Before the formulas stand definitions, each a name for a formula of what stands before it; a definition is evaluated once, however
//! often it is used. There are no branches and no loops: every formula has a value wherever its operations have one.
//!
//! Why a list and not a tree: evaluation, printing and dropping are plain loops that no depth of nesting can exhaust, and what is
//! used twice is computed once.

mod error;
mod fold;
mod name;
mod reader;
mod text;
mod token;

pub use error::{Fault, InvalidFormula};
pub use name::{Elementary, InvalidName, LARGEST_STUMPFF, PI, check_names};
pub use reader::{DEEPEST, LARGEST_EXPONENT, LONGEST_TEXT, MOST_OPERATIONS};
pub use text::Written;

use crate::number::{Dual, Field, Rational, Real};

/// An operation on the results of earlier ones, which it names by their places in the list.
#[derive(Debug, Clone, PartialEq)]
enum Operation {
    /// An integer.
    Integer(i64),
    /// A double that is no integer of 64 bits, exactly.
    Number(Rational),
    /// A number that the caller binds.
    Name(usize),
    /// A definition.
    Definition(usize),
    Sum(usize, usize),
    Difference(usize, usize),
    Product(usize, usize),
    Quotient(usize, usize),
    Negative(usize),
    Power(usize, i64),
    Call(Elementary, Vec<usize>),
}

/// A text with a name: a definition, or the formula of a component.
#[derive(Debug, Clone, PartialEq)]
struct Entry {
    name: String,
    /// The operation that gives its value.
    result: usize,
}

/// Formulas of named numbers.
///
/// Example: range and bearing from a sensor at (1, 2), their values and their derivatives by x and y.
///
/// ```
/// use immaculate::model::formula::Formulas;
///
/// let polar = Formulas::read(
///     &["x", "y"],
///     &[("dx", "x - 1"), ("dy", "y - 2")],
///     &[("range", "hypot(dx, dy)"), ("bearing", "atan2(dy, dx)")],
/// )?;
/// assert_eq!(polar.at(&[4.0, 6.0])[0], 5.0); // √(3² + 4²)
/// // (dx, dy)/r and (−dy, dx)/r², at (dx, dy) = (4, 0)
/// assert_eq!(polar.jacobian_at(&[5.0, 2.0], 2), [[1.0, 0.0], [0.0, 0.25]]);
/// # Ok::<(), immaculate::model::formula::InvalidFormula>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Formulas {
    names: Vec<String>,
    definitions: Vec<Entry>,
    results: Vec<Entry>,
    operations: Vec<Operation>,
}

impl Formulas {
    /// Reads formulas of these names, after definitions that stand in the order in which they may use each other.
    ///
    /// The first of each pair is the name of a definition, or that of what the formula gives; the latter only appears in errors.
    ///
    /// # Errors
    ///
    /// [`InvalidFormula`] with the place in the text, for everything that the head of this folder does not allow.
    pub fn read(
        names: &[&str],
        definitions: &[(&str, &str)],
        formulas: &[(&str, &str)],
    ) -> Result<Self, InvalidFormula> {
        reader::read(names, definitions, formulas)
    }

    /// The names that the caller binds, in the order in which their values are given.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// What the formulas give, in order.
    pub fn results(&self) -> Vec<&str> {
        self.results.iter().map(|entry| entry.name.as_str()).collect()
    }

    /// Some of the formulas alone.
    pub(in crate::model) fn only(&self, results: &[usize]) -> Self {
        let chosen = results.iter().filter_map(|&index| self.results.get(index));
        Self {
            results: chosen.cloned().collect(),
            ..self.clone()
        }
    }

    /// Whether a name is used, in a formula or a definition.
    pub fn uses(&self, name: &str) -> bool {
        let is_it = |operation: &Operation| matches!(operation, Operation::Name(index) if self.names[*index] == name);
        self.operations.iter().any(is_it)
    }

    /// The values of the formulas, from those of the names; undecided where an operation has no answer, or a value is missing.
    ///
    /// Source: each operation in the number system of the values, in the order in which it is written.
    ///
    /// Example: twelve certified digits of the diagonal of a square.
    ///
    /// ```
    /// use immaculate::model::formula::Formulas;
    /// use immaculate::number::Enclosure;
    ///
    /// let diagonal = Formulas::read(&["side"], &[], &[("diagonal", "hypot(side, side)")])?;
    /// let value = Enclosure::with_precision(60, || diagonal.at(&[Enclosure::exact(1.0)])[0].to_decimal(12));
    /// assert_eq!(value.unwrap(), "1.41421356237e0");
    /// # Ok::<(), immaculate::model::formula::InvalidFormula>(())
    /// ```
    ///
    /// Evidence: `operations_bind_as_in_a_textbook`, `every_number_system_runs_the_same_formula` (exact).
    pub fn at<T: Real>(&self, values: &[T]) -> Vec<T> {
        self.evaluate(values, Elementary::of)
    }

    /// The values in a number system that has no elementary functions; `None` if a formula or definition calls one.
    ///
    /// Example: the distance after a time t at constant acceleration, for all t.
    ///
    /// ```
    /// use immaculate::model::formula::Formulas;
    /// use immaculate::number::{Field, RationalFunction};
    ///
    /// let way = Formulas::read(&["a", "t"], &[], &[("way", "a*t^2/2")])?;
    /// let [a, t] = ["a", "t"].map(RationalFunction::unknown);
    /// let half = RationalFunction::ratio(1, 2);
    /// assert_eq!(way.rational_at(&[a.clone(), t.clone()]), Some(vec![half * a * t.clone() * t]));
    /// # Ok::<(), immaculate::model::formula::InvalidFormula>(())
    /// ```
    pub fn rational_at<T: Field>(&self, values: &[T]) -> Option<Vec<T>> {
        let is_call = |operation: &Operation| matches!(operation, Operation::Call(..));
        let has_calls = self.operations.iter().any(is_call);
        (!has_calls).then(|| self.evaluate(values, |_, _| T::undecided()))
    }

    /// The derivatives of the formulas with respect to the first `count` names: one row per formula, one column per name.
    ///
    /// Source: each column is the derivative of the formulas in [`Dual`] numbers, in which one name varies.
    ///
    /// Example: the area of a rectangle, and a third number that is held.
    ///
    /// ```
    /// use immaculate::model::formula::Formulas;
    ///
    /// let area = Formulas::read(&["a", "b", "scale"], &[], &[("area", "scale*a*b")])?;
    /// assert_eq!(area.jacobian_at(&[2.0, 3.0, 10.0], 2), [[30.0, 20.0]]); // 10 · 3, 10 · 2
    /// # Ok::<(), immaculate::model::formula::InvalidFormula>(())
    /// ```
    ///
    /// Evidence: `a_jacobian_is_the_limit_of_difference_quotients` (symbolic), `every_model_has_the_slopes_of_its_differences` (enclosed).
    pub fn jacobian_at<T: Real>(&self, values: &[T], by: usize) -> Vec<Vec<T>> {
        let mut rows = vec![Vec::with_capacity(by); self.results.len()];
        for column in 0..by {
            let mut changing = Vec::with_capacity(values.len());
            for (index, value) in values.iter().enumerate() {
                changing.push(if index == column {
                    Dual::variable(value.clone())
                } else {
                    Dual::constant(value.clone())
                });
            }
            for (row, value) in rows.iter_mut().zip(self.at(&changing)) {
                row.push(value.slope().clone());
            }
        }
        rows
    }

    /// Whether every formula is linear in the first names: a sum of them, each times a factor without them, and of a term without them.
    ///
    /// It is decided from the operations alone: `x*x/x` is not seen to be linear.
    ///
    /// Example: constant velocity is linear in the state, and not in state and time together.
    ///
    /// ```
    /// use immaculate::model::formula::Formulas;
    ///
    /// let moved = Formulas::read(&["x", "vx", "T"], &[], &[("x", "x + T*vx")])?;
    /// assert!(moved.is_linear_in(2) && !moved.is_linear_in(3));
    /// # Ok::<(), immaculate::model::formula::InvalidFormula>(())
    /// ```
    pub fn is_linear_in(&self, by: usize) -> bool {
        let degrees = self.degrees(by);
        self.results.iter().all(|entry| degrees[entry.result] <= 1)
    }

    /// The degree of every operation in the first names: 0, 1, or 2 for everything that is not a polynomial of degree one.
    fn degrees(&self, by: usize) -> Vec<u8> {
        let mut degrees: Vec<u8> = Vec::with_capacity(self.operations.len());
        for operation in &self.operations {
            let of = |index: &usize| degrees[*index];
            let degree = match operation {
                Operation::Integer(_) | Operation::Number(_) => 0,
                Operation::Name(index) => u8::from(*index < by),
                Operation::Definition(index) => degrees[self.definitions[*index].result],
                Operation::Sum(a, b) | Operation::Difference(a, b) => of(a).max(of(b)),
                Operation::Product(a, b) => of(a) + of(b),
                Operation::Quotient(a, b) => of(a) + 2 * of(b),
                Operation::Negative(a) => of(a),
                Operation::Power(a, exponent) => match exponent {
                    0 => 0,
                    1 => of(a),
                    _ => 2 * of(a),
                },
                Operation::Call(_, arguments) => 2 * arguments.iter().map(of).max().unwrap_or(0),
            };
            degrees.push(degree.min(2));
        }
        degrees
    }

    /// The values of all operations, one after the other, and of these the formulas'.
    fn evaluate<T: Field>(&self, values: &[T], call: impl Fn(Elementary, &[T]) -> T) -> Vec<T> {
        let mut results: Vec<T> = Vec::with_capacity(self.operations.len());
        for operation in &self.operations {
            let of = |index: &usize| results[*index].clone();
            let result = match operation {
                Operation::Integer(value) => T::integer(*value),
                Operation::Number(value) => T::rational(value),
                Operation::Name(index) => values.get(*index).cloned().unwrap_or_else(T::undecided),
                Operation::Definition(index) => results[self.definitions[*index].result].clone(),
                Operation::Sum(a, b) => of(a) + of(b),
                Operation::Difference(a, b) => of(a) - of(b),
                Operation::Product(a, b) => of(a) * of(b),
                Operation::Quotient(a, b) => of(a) / of(b),
                Operation::Negative(a) => -of(a),
                Operation::Power(a, exponent) => power(&of(a), *exponent),
                Operation::Call(function, arguments) => {
                    let arguments: Vec<T> = arguments.iter().map(of).collect();
                    call(*function, &arguments)
                }
            };
            results.push(result);
        }
        let of_formulas = self.results.iter().map(|entry| results[entry.result].clone());
        of_formulas.collect()
    }
}

/// xⁿ by squaring; 1/x⁻ⁿ for a negative n, and 1 for zero.
fn power<T: Field>(base: &T, exponent: i64) -> T {
    let mut left = exponent.unsigned_abs();
    let mut square = base.clone();
    let mut product: Option<T> = None;
    while left > 0 {
        if left % 2 == 1 {
            product = Some(match product {
                None => square.clone(),
                Some(product) => product * square.clone(),
            });
        }
        left /= 2;
        if left > 0 {
            square = square.clone() * square;
        }
    }
    let product = product.unwrap_or_else(T::one);
    if exponent < 0 { T::one() / product } else { product }
}
