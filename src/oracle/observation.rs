//! Observations about the answers as a whole, beside the equations of single values.
//!
//! A verdict may report these before it names an equation. A program that prints few digits, answers by chance or keeps something from one
//! problem to the next cannot be corrected equation by equation.

use super::evidence::Answered;
use super::invalid::Invalid;
use super::judge::Place;
use super::run::Triangle;
use super::subject::Precision;
use super::trace::{Trace, same};
use super::verdict::CaseReport;
use super::{alike, digits, shown_as, single_input, symmetry};
use crate::imm::Quantity;

/// Something that is seen in the answers.
#[derive(Debug, Clone, PartialEq)]
pub enum Observation {
    /// The first case that was answered is answered differently at the end, in the same process.
    AnswersDiffer {
        /// The case.
        id: String,
        /// The first number that differs; none where the second answer has no values.
        difference: Option<Discrepancy>,
        /// Whether both answers are right: a sum in another order, say, rounds in another way.
        is_rounding: bool,
    },
    /// Cases that are wrong among the others, and right when asked alone, in a program started anew.
    RightAlone {
        /// The cases.
        ids: Vec<String>,
    },
    /// Every number has at most this many significant digits.
    FewDigits {
        /// How many.
        digits: usize,
    },
    /// Every number has at most this many digits after the decimal point.
    FewDecimals {
        /// How many.
        decimals: usize,
    },
    /// Every number is one of single precision, and a finer one was declared.
    SinglePrecision,
    /// Input was rounded to single precision, which explains every value.
    SingleInput {
        /// Which.
        input: SingleInput,
    },
    /// Every step shows the same values.
    StepsAlike {
        /// The case.
        id: String,
        /// The step whose values these are, if they are right in one.
        step: Option<usize>,
    },
    /// A covariance that was symmetric but for rounding is it no more.
    SymmetryLost {
        /// The cases, that in which it grows most first.
        ids: Vec<String>,
        /// The covariance in it, and its mode.
        covariance: (Quantity, usize),
        /// Its first step, and max |P − Pᵀ| there in its scale.
        first: (usize, f64),
        /// The same where it is greatest.
        most: (usize, f64),
    },
    /// One triangle of covariances is shown, and zeros in place of the other.
    OneTriangle {
        /// Which is shown.
        triangle: Triangle,
        /// The covariances.
        quantities: Vec<Quantity>,
    },
    /// A value that is right is shown as something else.
    ShownAs {
        /// The value.
        quantity: Quantity,
        /// As what.
        way: &'static str,
    },
}

/// Input that was rounded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SingleInput {
    /// The initial means and covariances.
    Estimates,
    /// Every matrix, vector and probability of the problem.
    Everything,
}

/// What is seen in answers, what matters most first.
///
/// # Errors
///
/// [`Invalid`] for a problem that cannot be set up.
pub(super) fn observe(
    answered: &[Answered],
    cases: &[CaseReport],
    precision: Precision,
    conventions: &[&str],
) -> Result<Vec<Observation>, Invalid> {
    let mut found: Vec<Observation> = digits::lost(answered, precision).into_iter().collect();
    found.extend(alike::steps_alike(answered, cases));
    found.extend(symmetry::halved(answered));
    found.extend(shown_as::found(answered, precision));
    if found.is_empty() {
        found.extend(single_input::found(answered, cases, precision, conventions)?);
    }
    found.extend(symmetry::lost(answered, cases, precision));
    Ok(found)
}

/// A number that is not the same in two answers.
#[derive(Debug, Clone, PartialEq)]
pub struct Discrepancy {
    /// Where.
    pub place: Place,
    /// Which number, by rows.
    pub index: usize,
    /// The number of the first answer; none where it is not shown.
    pub first: Option<f64>,
    /// That of the second.
    pub again: Option<f64>,
}

impl Observation {
    /// Whether a program that is right in every value is wrong all the same.
    pub fn is_wrong(&self) -> bool {
        matches!(self, Self::AnswersDiffer { is_rounding: false, .. })
    }

    /// Whether it says that answers depend on more than the problem.
    pub(super) fn is_unsteady(&self) -> bool {
        self.is_wrong() || matches!(self, Self::RightAlone { .. })
    }

    /// Whether it says that rounding grows in a case.
    pub(super) fn is_lost_symmetry_of(&self, case: &str) -> bool {
        matches!(self, Self::SymmetryLost { ids, .. } if ids.iter().any(|id| id == case))
    }

    /// Whether it is why values of a quantity are wrong in a case.
    pub(super) fn is_cause(&self, case: &str, quantity: Quantity) -> bool {
        match self {
            Self::FewDigits { .. } | Self::FewDecimals { .. } | Self::SinglePrecision | Self::SingleInput { .. } => {
                true
            }
            Self::StepsAlike { id, .. } => id == case,
            Self::OneTriangle { quantities, .. } => quantities.contains(&quantity),
            Self::ShownAs { quantity: shown, .. } => *shown == quantity,
            Self::AnswersDiffer { .. } | Self::RightAlone { .. } | Self::SymmetryLost { .. } => false,
        }
    }
}

impl Discrepancy {
    /// The first number in which two answers differ, bit for bit; what is not finite is all the same.
    pub fn between(first: &Trace, again: &Trace) -> Option<Self> {
        first.all_places().find_map(|place| {
            let values = [first, again].map(|trace| trace.get(place.0, place.1, place.2));
            let count = values.iter().flatten().map(|values| values.len()).max()?;
            let number = |values: Option<&Vec<f64>>, index: usize| values.and_then(|values| values.get(index).copied());
            let differs = |index: &usize| match values.map(|values| number(values, *index)) {
                [Some(first), Some(again)] => !same(first, again),
                [first, again] => first.is_some() != again.is_some(),
            };
            let index = (0..count).find(differs)?;
            let [first, again] = values.map(|values| number(values, index));
            Some(Self {
                place,
                index,
                first,
                again,
            })
        })
    }
}
