//! Names: the valid names of components, parameters and definitions, and the functions of formulas.

use crate::number::Real;
use std::collections::BTreeSet;
use thiserror::Error;

/// The longest name.
const LONGEST_NAME: usize = 64;

/// The greatest k of a Stumpff function that a formula can call.
pub const LARGEST_STUMPFF: usize = 9;

/// The circle number in a formula.
pub const PI: &str = "pi";

/// A function that a formula can call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Elementary {
    /// The circle number, a function of nothing.
    Pi,
    /// The square root.
    Sqrt,
    /// The exponential.
    Exp,
    /// The natural logarithm.
    Ln,
    /// The sine.
    Sin,
    /// The cosine.
    Cos,
    /// The tangent, sin x / cos x.
    Tan,
    /// The angle of the point (x, y): `atan2(y, x)`.
    Atan2,
    /// The length √(x² + y²).
    Hypot,
    /// The Stumpff function c_k.
    Stumpff(usize),
}

impl Elementary {
    /// The functions that are called with parentheses, but for the Stumpff functions `c0` to `c9`.
    const CALLED: [(&'static str, Self); 8] = [
        ("sqrt", Self::Sqrt),
        ("exp", Self::Exp),
        ("ln", Self::Ln),
        ("sin", Self::Sin),
        ("cos", Self::Cos),
        ("tan", Self::Tan),
        ("atan2", Self::Atan2),
        ("hypot", Self::Hypot),
    ];

    /// The function of a name.
    pub(super) fn named(name: &str) -> Option<Self> {
        let called = Self::CALLED.iter().find(|(known, _)| *known == name);
        let stumpff = || stumpff_order(name).filter(|&k| k <= LARGEST_STUMPFF);
        called
            .map(|(_, function)| *function)
            .or_else(|| stumpff().map(Self::Stumpff))
    }

    /// The name of the function.
    pub(super) fn name(self) -> String {
        match self {
            Self::Pi => PI.to_owned(),
            Self::Stumpff(k) => format!("c{k}"),
            _ => {
                let called = Self::CALLED.iter().find(|(_, function)| *function == self);
                called.map_or_else(String::new, |(name, _)| (*name).to_owned())
            }
        }
    }

    /// How many arguments it takes.
    pub(super) fn arity(self) -> usize {
        match self {
            Self::Pi => 0,
            Self::Atan2 | Self::Hypot => 2,
            _ => 1,
        }
    }

    /// The value at its arguments.
    pub(super) fn of<T: Real>(self, arguments: &[T]) -> T {
        match (self, arguments) {
            (Self::Pi, []) => T::pi(),
            (Self::Sqrt, [x]) => x.sqrt(),
            (Self::Exp, [x]) => x.exp(),
            (Self::Ln, [x]) => x.ln(),
            (Self::Sin, [x]) => x.sin(),
            (Self::Cos, [x]) => x.cos(),
            (Self::Tan, [x]) => x.sin() / x.cos(),
            (Self::Atan2, [y, x]) => y.atan2(x),
            (Self::Hypot, [x, y]) => (x.clone() * x.clone() + y.clone() * y.clone()).sqrt(),
            (Self::Stumpff(k), [t]) => t.stumpff(k),
            // The reader makes no call with another number of arguments.
            _ => T::undecided(),
        }
    }
}

/// The names of all functions, and of the circle number.
pub(super) fn functions() -> Vec<String> {
    let called = Elementary::CALLED.iter().map(|(name, _)| (*name).to_owned());
    let stumpff = (0..=LARGEST_STUMPFF).map(|k| format!("c{k}"));
    called.chain(stumpff).chain([PI.to_owned()]).collect()
}

/// The k of a name `c` with digits after it, whether there is such a function or not.
pub(super) fn stumpff_order(name: &str) -> Option<usize> {
    let digits = name.strip_prefix('c')?;
    let is_number = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then(|| digits.parse().unwrap_or(usize::MAX))
}

/// Why a name cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum InvalidName {
    /// It is not a letter or underscore with letters, digits and underscores after it.
    #[error("`{0}` is not a name: a name is a letter and up to 63 letters, digits and underscores")]
    NotAName(String),
    /// A function or number has it.
    #[error("`{0}` cannot be chosen as a name: formulas know it as a function or number")]
    Reserved(String),
    /// Two things have it.
    #[error("the name `{0}` is used twice")]
    Twice(String),
}

/// Checks that names differ from each other and from everything that formulas define.
///
/// Example: a component cannot be called as a function is.
///
/// ```
/// use immaculate::model::formula::{InvalidName, check_names};
///
/// assert_eq!(check_names(["x", "vx"]), Ok(()));
/// assert_eq!(check_names(["x", "c1"]), Err(InvalidName::Reserved("c1".into())));
/// assert_eq!(check_names(["x", "x"]), Err(InvalidName::Twice("x".into())));
/// ```
///
/// # Errors
///
/// [`InvalidName`] with the first name that is none, is reserved or stands twice.
pub fn check_names<'a>(names: impl IntoIterator<Item = &'a str>) -> Result<(), InvalidName> {
    let mut seen = BTreeSet::new();
    for name in names {
        if !is_name(name) {
            return Err(InvalidName::NotAName(shortened(name)));
        }
        if name == PI || Elementary::named(name).is_some() || stumpff_order(name).is_some() {
            return Err(InvalidName::Reserved(name.to_owned()));
        }
        if !seen.insert(name) {
            return Err(InvalidName::Twice(name.to_owned()));
        }
    }
    Ok(())
}

/// Whether a text has the form of a name.
fn is_name(text: &str) -> bool {
    let is_first = |c: char| c.is_ascii_alphabetic() || c == '_';
    text.len() <= LONGEST_NAME && text.starts_with(is_first) && text.chars().all(is_name_part)
}

/// Whether a character can stand inside a name.
pub(super) fn is_name_part(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// A text short enough to be quoted, on one line.
pub(super) fn shortened(text: &str) -> String {
    let mut quoted: String = text.chars().take(LONGEST_NAME).collect();
    if quoted.len() < text.len() {
        quoted.push('…');
    }
    printable(&quoted)
}

/// A text with what would break its line written out.
pub(super) fn printable(text: &str) -> String {
    text.chars().fold(String::new(), |mut line, c| {
        if c.is_control() {
            line.extend(c.escape_default());
        } else {
            line.push(c);
        }
        line
    })
}
