//! The errors in the text of a formula, each with its place.

use super::name::{InvalidName, LARGEST_STUMPFF};
use super::reader::{DEEPEST, LARGEST_EXPONENT, LONGEST_TEXT, MOST_OPERATIONS};
use thiserror::Error;

/// Why formulas cannot be read: one sentence, with the place.
///
/// Example: a name that is nearly right.
///
/// ```
/// use immaculate::model::formula::Formulas;
///
/// let error = Formulas::read(&["x", "vx", "T"], &[], &[("x", "x + T*xv")]).unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     "formula of `x`, column 7, at `x + T*xv`: `xv` is not known here; the nearest name is `vx`"
/// );
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum InvalidFormula {
    /// A name that the formulas are to use cannot be used.
    #[error(transparent)]
    Name(#[from] InvalidName),
    /// A text is wrong.
    #[error("formula of `{of}`, column {column}, at `{near}`: {fault}")]
    Text {
        /// What the formula gives, or the definition that it is.
        of: String,
        /// The character at which it is wrong, counted from one.
        column: usize,
        /// The text around it.
        near: String,
        /// What is wrong.
        fault: Fault,
    },
}

/// What is wrong at a place of a text.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Fault {
    /// The text is empty.
    #[error("nothing is written")]
    Empty,
    /// The text is too long.
    #[error("a formula has at most {LONGEST_TEXT} bytes")]
    TooLong,
    /// All texts together have too many operations.
    #[error("formulas have at most {MOST_OPERATIONS} operations together")]
    TooMany,
    /// Too deep.
    #[error("parentheses, calls and signs are nested more than {DEEPEST} deep; give the inner part a name")]
    TooDeep,
    /// A character that no formula has.
    #[error("`{found}` does not belong in a formula{advice}")]
    Character {
        /// The character, printable.
        found: String,
        /// What to write instead, with a semicolon before it, or nothing.
        advice: &'static str,
    },
    /// Digits that are not a double.
    #[error("`{0}` is larger than every double")]
    TooLarge(String),
    /// Digits that are not a number.
    #[error("`{0}` is not a number")]
    NotANumber(String),
    /// A value is expected.
    #[error("a number, name or parenthesis is missing before {0}")]
    MissingValue(String),
    /// An operator is expected.
    #[error("an operator is missing before {0}")]
    MissingOperator(String),
    /// A parenthesis is never closed.
    #[error("the parenthesis of column {opened} is not closed before {found}")]
    Unclosed {
        /// The column of the parenthesis.
        opened: usize,
        /// What stands where it should be closed.
        found: String,
    },
    /// A parenthesis is closed that was never opened.
    #[error("no parenthesis is open here")]
    Unopened,
    /// A comma outside of a call.
    #[error("a comma only stands between the arguments of a function; decimals have a point")]
    Comma,
    /// No such name.
    #[error("`{name}` is not known here{}", suggested(.nearest.as_deref()))]
    UnknownName {
        /// The name.
        name: String,
        /// The nearest one that is known, if one is near.
        nearest: Option<String>,
    },
    /// No such function.
    #[error("there is no function `{name}`{}", suggested(.nearest.as_deref()))]
    UnknownFunction {
        /// The name.
        name: String,
        /// The nearest one that there is, if one is near.
        nearest: Option<String>,
    },
    /// A Stumpff function of an order that is not offered.
    #[error("there is no function `{0}`: the Stumpff functions are c0 to c{LARGEST_STUMPFF}")]
    Order(String),
    /// A definition that stands later.
    #[error("`{0}` is only defined after this")]
    Later(String),
    /// A definition of itself.
    #[error("`{0}` is used in its own definition")]
    Itself(String),
    /// A function without parentheses.
    #[error("`{0}` is a function; its argument stands in parentheses, as in `{0}(…)`")]
    NotCalled(String),
    /// A number that is called.
    #[error("`{0}` is a number and not a function; a product is written `{0}*(…)`")]
    NotAFunction(String),
    /// Too few or too many arguments.
    #[error("`{function}` takes {takes} argument{} and not {given}", if *.takes == 1 { "" } else { "s" })]
    Arguments {
        /// The function.
        function: String,
        /// How many it takes.
        takes: usize,
        /// How many are given.
        given: usize,
    },
    /// An exponent that is not an integer in digits.
    #[error("an exponent is an integer in digits, such as `2` or `-1`; other powers are `sqrt(a)` and `exp(b*ln(a))`")]
    NotAnInteger,
    /// An exponent that is too large.
    #[error("the exponent {0} is beyond ±{LARGEST_EXPONENT}")]
    Exponent(String),
    /// Two powers in a row.
    #[error("two powers in a row; say with parentheses which is meant first")]
    PowerOfPower,
    /// A division by a constant that is zero.
    #[error("what stands here is a constant, exactly zero, and is divided by")]
    DivisionByZero,
    /// A function of a constant at which it has no value.
    #[error("`{0}` has no value at this constant")]
    NoValue(String),
}

/// The end of a sentence that suggests a name, or nothing.
fn suggested(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |name| format!("; the nearest name is `{name}`"))
}
