//! The formula that a program computed, if it is wrong and not in the catalogue.
//!
//! The right formula of each value is a small tree, in the forms that programs use. Trees one edit away are evaluated on the program's own
//! values. A tree was computed by the program if it gives the shown values, to rounding, wherever the right one does not.
//!
//! ```text
//! right ─▶ edit ─▶ candidates ─┬─ evaluated at the faulty values ─▶ the few that give them ─▶ at all values ─▶ the nearest
//! instance (a value and all that the program showed beside it) ─┘
//! ```
//!
//! Reading order: `tree`, `print` and `value` say what a formula is; `instance` where its numbers come from; `right` has the right ones,
//! `edit` what is near them, `search` finds the one that was computed, `fit` its number, and `condition` where; `solve` finds the input
//! that would explain what is shown, and `explain` puts numbers into the right formula.

mod condition;
mod edit;
mod explain;
mod fit;
mod instance;
mod print;
mod right;
mod search;
mod solve;
mod tree;
mod value;

pub use explain::Explanation;
pub(super) use explain::explain;
pub(crate) use explain::short;
pub(super) use search::find;
pub use search::{ComputedFormula, ComputedFormulas, unlike_the_equations};
