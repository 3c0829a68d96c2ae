//! The catalogue of variants: the filter with some entries of its table exchanged, or with a changed problem.
//!
//! It contains every mistake, convention and form that can explain another program's values. A variant has two halves: a row of
//! `spec/variants.toml` describes it in words, and an arm in one of these files applies it. Every arm is a few lines, generic over the
//! number system, so that a variant runs wherever the filter does.
//!
//! | file            | whose equation is varied                                             |
//! |-----------------|----------------------------------------------------------------------|
//! | `input`         | none: the problem was read wrongly                                   |
//! | `mixing`        | predicted mode probabilities, mixing probabilities, mixed estimates  |
//! | `prediction`    | predicted estimates                                                  |
//! | `linearisation` | the Jacobians of extended filters                                    |
//! | `step`          | what differs from step to step                                       |
//! | `points`        | the points and weights of a rule                                     |
//! | `measurement`   | predicted measurement, innovation and their covariances              |
//! | `bearing`       | the measurement function of range and bearing, and its angles        |
//! | `conversion`    | the converted measurement and its covariance                         |
//! | `update`        | gain and updated estimates                                           |
//! | `missed`        | what is done without a detection                                     |
//! | `likelihood`    | log-likelihood                                                       |
//! | `probability`   | mode probabilities                                                   |
//! | `combination`   | combined estimates                                                   |
//! | `convention`    | choices that the papers leave open                                   |
//! | `state_angle`   | angles in the state                                                  |
//! | `state`         | how modes with states of their own read each other                   |
//! | `square_root`   | of these the square root of a covariance                             |
//! | `fixed_gain`    | what is given to filters with fixed gains, and their two readings    |
//! | `form`          | other algebra for the same exact value                               |
//!
//! An entry computes its value from the values that stand before it in the record, as the program that makes the mistake would: so it can
//! be run along another program's values too. Two variants compose when they exchange different entries; of the same entry the second wins.

mod applies;
mod bearing;
mod combination;
mod convention;
mod conversion;
mod fixed_gain;
mod form;
mod input;
mod likelihood;
mod linearisation;
mod measurement;
mod missed;
mod mixing;
mod points;
mod prediction;
mod probability;
mod square_root;
mod state;
mod state_angle;
mod step;
mod update;

pub use applies::Applies;

use super::setup::Setup;
use crate::filter::cubature;
use crate::gaussian::Gaussian;
use crate::imm::by_kind::{difference, seen};
use crate::imm::equations::{Factored, measurement_matrix, motion_matrix, noise, used};
use crate::imm::{Interaction, Needs, Problem, Quantity, Step};
use crate::model::Sensor;
use crate::number::Real;
use crate::rule::Rule;
use nalgebra::{DMatrix, DVector, Dyn};
use serde::de::{Deserializer, Error};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// What a variant is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// Wrong: printed in a paper, or seen in programs.
    Mistake,
    /// A choice that the papers leave open and that changes exact values.
    Convention,
    /// Other algebra for the same exact value; never wrong.
    Form,
}

impl Kind {
    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mistake => "mistake",
            Self::Convention => "convention",
            Self::Form => "form",
        }
    }
}

/// A row of the catalogue.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Variant {
    /// Its name; never changed.
    pub id: String,
    /// What it is.
    pub kind: Kind,
    /// The quantity in whose equation it is made, the first that it can change.
    #[serde(deserialize_with = "quantity")]
    pub quantity: Quantity,
    /// The same where measurements are converted, if it is another there.
    #[serde(default, deserialize_with = "quantity_if_any")]
    pub converted: Option<Quantity>,
    /// Where it can make a difference.
    pub applies: Applies,
    /// Whether the equation is right, and what it is given was read wrongly.
    #[serde(default)]
    pub input: bool,
    /// What was done, said to the one who did it.
    pub about: String,
    /// Its symptom.
    pub effect: String,
    /// Where it is found.
    pub source: String,
    /// The case that is meant for it.
    pub case: String,
    /// Of a convention: its key in problem files.
    pub convention: Option<String>,
    /// Of a convention: the value of that key.
    pub value: Option<String>,
}

impl Variant {
    /// In whose equation it is made, in filters that convert measurements or do not.
    pub fn quantity_in(&self, converts: bool) -> Quantity {
        self.converted.filter(|_| converts).unwrap_or(self.quantity)
    }

    /// Whether it is made in the equation of a quantity, in filters of any kind.
    pub fn is_made_in(&self, quantity: Quantity) -> bool {
        self.quantity == quantity || self.converted == Some(quantity)
    }

    /// Whether it can make a difference here. Where it cannot, the variant leaves every value as it is.
    pub fn applies_to<T: Real>(&self, setup: &Setup<T>) -> bool {
        let exists = setup.problem.has_covariances() || !self.needs_covariances();
        exists && !(self.needs_one_state() && has_state_conversions(setup)) && self.applies.to(setup)
    }

    /// Whether it has no meaning where modes have states of their own: it takes the combined estimate for one of a mode, and nothing
    /// converts it; or it asks what a mode lacks of another's state, and a conversion says that.
    fn needs_one_state(&self) -> bool {
        OF_ONE_STATE.contains(&self.id.as_str())
    }

    /// Whether it has no meaning where there are no covariances.
    fn needs_covariances(&self) -> bool {
        matches!(self.applies, Applies::Kalman | Applies::Covariances) || self.quantity.needs(Needs::Covariances)
    }
}

/// The variants that need all modes to have one state.
const OF_ONE_STATE: [&str; 7] = [
    "common-mixing",
    "mixed-spread-about-combined-mean",
    "prediction-of-combined-covariance",
    "measurement-of-the-combined-prediction",
    "update-of-the-combined-prediction",
    "unequal-dimensions-index-wise",
    "unequal-dimensions-unbiased",
];

/// Whether modes have states of their own.
fn has_state_conversions<T: Real>(setup: &Setup<T>) -> bool {
    matches!(setup.problem.interaction, Interaction::Converted(_))
}

/// A quantity by its name.
fn quantity<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Quantity, D::Error> {
    let name = String::deserialize(deserializer)?;
    let named = Quantity::ALL.into_iter().find(|quantity| quantity.name() == name);
    named.ok_or_else(|| D::Error::custom(format!("there is no quantity {name:?}")))
}

fn quantity_if_any<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Quantity>, D::Error> {
    quantity(deserializer).map(Some)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CatalogueFile {
    variant: Vec<Variant>,
}

/// Reads a catalogue.
///
/// # Errors
///
/// What is wrong with the text, and where.
pub fn read(text: &str) -> Result<Vec<Variant>, toml::de::Error> {
    toml::from_str::<CatalogueFile>(text).map(|file| file.variant)
}

/// All variants, in the order of `spec/variants.toml`. The file is part of the program, and a test reads it: one that could not be read
/// would leave the catalogue empty.
///
/// Example: the mistake that leaves out the spread of the means.
///
/// ```
/// use immaculate::oracle::variant::{Kind, catalogue};
///
/// let variant = catalogue().iter().find(|variant| variant.id == "mixed-spread-omitted").unwrap();
/// assert_eq!(variant.kind, Kind::Mistake);
/// ```
pub fn catalogue() -> &'static [Variant] {
    static CATALOGUE: LazyLock<Vec<Variant>> =
        LazyLock::new(|| read(include_str!("../../../spec/variants.toml")).unwrap_or_default());
    &CATALOGUE
}

/// The variant of a name.
pub fn find(id: &str) -> Option<&'static Variant> {
    catalogue().iter().find(|variant| variant.id == id)
}

/// Makes a run one of a variant; whether there is one of this name. Several may be applied, one after the other. What has no meaning
/// without covariances leaves filters that carry none as they are, what is of several modes leaves one mode alone, and what needs one
/// state leaves modes with states of their own as they are.
pub fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let has_no_meaning = |variant: &Variant| {
        let is_of_modes = variant.applies == Applies::SeveralModes;
        (is_of_modes && setup.problem.modes.len() == 1)
            || (variant.needs_covariances() && !setup.problem.has_covariances())
            || (variant.needs_one_state() && has_state_conversions(setup))
    };
    if find(id).is_some_and(has_no_meaning) {
        return true;
    }
    if step::apply(id, setup) {
        return true;
    }
    if setup.changes.is_empty() {
        return apply_once(id, setup);
    }
    // A variant changes the problem of each step; the measurements and the initial estimate it changes once.
    let before = setup.clone();
    let is_one = apply_once(id, setup);
    for (&step, problem) in &before.changes {
        let mut of_step = Setup {
            problem: problem.clone(),
            equations: before.equations.clone(),
            initial: before.initial.clone(),
            measurements: before.measurements.clone(),
            truths: before.truths.clone(),
            changes: BTreeMap::new(),
            rates: before.rates_of(step),
        };
        apply_once(id, &mut of_step);
        setup.changes.insert(step, of_step.problem);
    }
    is_one
}

/// Applies a variant to a problem that is the same in every step.
fn apply_once<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    input::apply(id, setup)
        || mixing::apply(id, setup)
        || prediction::apply(id, setup)
        || linearisation::apply(id, setup)
        || points::apply(id, setup)
        || measurement::apply(id, setup)
        || bearing::apply(id, setup)
        || conversion::apply(id, setup)
        || update::apply(id, setup)
        || missed::apply(id, setup)
        || likelihood::apply(id, setup)
        || probability::apply(id, setup)
        || combination::apply(id, setup)
        || state_angle::apply(id, setup)
        || state::apply(id, setup)
        || convention::apply(id, setup)
        || fixed_gain::apply(id, setup)
        || form::apply(id, setup)
}

/// Whether the filters of all modes draw points. Where some do, what is made of points and what is made of matrices are both left alone.
fn draws_points<T: Real>(setup: &Setup<T>) -> bool {
    setup
        .problem
        .filters
        .iter()
        .all(|filter| filter.rules() != [None, None])
}

/// Whether no filter draws points.
fn draws_no_points<T: Real>(setup: &Setup<T>) -> bool {
    setup
        .problem
        .filters
        .iter()
        .all(|filter| filter.rules() == [None, None])
}

/// Whether the noises of motion and measurement are correlated in a mode.
fn has_correlated_noises<T: Real>(setup: &Setup<T>) -> bool {
    let mut filters = setup.problem.filters.iter();
    filters.any(|filter| filter.noise_cross_covariance.is_some())
}

/// The points of an estimate with another square root of its covariance; none where the filter of mode j draws none.
fn drawn<T: Real>(
    problem: &Problem<T, Dyn, Dyn>,
    j: usize,
    estimate: &Gaussian<T, Dyn>,
    root: fn(&DMatrix<T>) -> Factored<DMatrix<T>>,
) -> Factored<Vec<DVector<T>>> {
    let Some(rule) = rule(problem, j) else {
        return Ok(Vec::new());
    };
    let root = root(&estimate.covariance)?;
    let points = rule.points.iter().map(|xi| cubature::point(&root, xi, &estimate.mean));
    Ok(points.collect())
}

/// The rule of the filter of mode j, if it draws points.
fn rule<T: Real>(problem: &Problem<T, Dyn, Dyn>, j: usize) -> Option<&Rule<T, Dyn>> {
    problem.filter(j).rules().into_iter().flatten().next()
}

/// The rows of a motion that are zero: it sets these entries of the state to zero, as constant velocity does where the state has an
/// acceleration.
fn zero_rows<T: Real>(motion: &DMatrix<T>) -> impl Iterator<Item = usize> + use<'_, T> {
    (0..motion.nrows()).filter(|&row| motion.row(row).iter().all(T::is_zero))
}

/// Whether the measurement is a matrix times the state.
fn is_linear<T: Real>(problem: &Problem<T, Dyn, Dyn>) -> bool {
    matches!(problem.sensor, Sensor::Linear(_))
}

/// The weights of the rule of mode j for means and for covariances; none without a rule.
fn weights<T: Real>(problem: &Problem<T, Dyn, Dyn>, j: usize) -> (&[T], &[T]) {
    match rule(problem, j) {
        Some(rule) => (&rule.weights, &rule.covariance_weights),
        None => (&[], &[]),
    }
}

/// Sum of the rule's weights for covariances.
fn sum_of_covariance_weights<T: Real>(problem: &Problem<T, Dyn, Dyn>, j: usize) -> T {
    let (_, weights) = weights(problem, j);
    weights.iter().cloned().fold(T::zero(), |sum, weight| sum + weight)
}

/// The probabilities by which the estimate of this step is combined. At step 0, whose combined estimate is computed too, these are the
/// only ones.
fn or_initial<'a, T: Real>(now: &'a Step<T, Dyn, Dyn>, weights: &'a [T]) -> &'a [T] {
    if now.step == 0 {
        &now.mode_probabilities
    } else {
        weights
    }
}

/// A number of modes, rows or points as a number of the number system.
fn number<T: Real>(count: usize) -> T {
    T::integer(i64::try_from(count).unwrap_or(i64::MAX))
}

/// The diagonal of a matrix, each entry changed, and zeros beside it.
fn diagonal<T: Real>(matrix: &DMatrix<T>, entry: fn(&T) -> T) -> DMatrix<T> {
    matrix.map_with_location(|row, column, _| {
        if row == column {
            entry(&matrix[(row, row)])
        } else {
            T::zero()
        }
    })
}
