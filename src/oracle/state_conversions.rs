//! Modes with different states in a problem file: their components, and the conversions between them.
//!
//! A problem needs one conversion for each ordered pair of modes whose states differ, and one from each mode whose state is not the
//! problem's to the combined estimates. [`imm::state_conversion`](crate::imm::state_conversion) defines their meaning.

use super::bound::{Bound, Functions, Scope};
use super::invalid::{Class, Invalid};
use super::models::ComponentFile;
use super::problem::{ProblemFile, Rows, if_there_at_all};
use super::setup::matrix;
use super::well_formed::{check_length, check_matrix};
use crate::imm::Interaction;
use crate::imm::state_conversion::{Reader, StateConversion, StateConversions};
use crate::model::motion::Motion;
use crate::model::nearest::nearest;
use crate::model::space::ComponentKind;
use crate::number::Real;
use nalgebra::{DMatrix, Dyn};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the estimates of one mode are read by another, or by the combined estimates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StateConversionFile {
    /// The name of the mode whose estimates are read.
    pub from: String,
    /// The name of the mode that reads them; absent, the combined estimates do.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "String")]
    pub to: Option<String>,
    /// The conversion as a matrix, n × n; or `formulas`.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "Rows")]
    pub matrix: Option<Rows>,
    /// The conversion as n formulas, in the names of the state of the mode that it comes from; or `matrix`.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "Vec<String>")]
    pub formulas: Option<Vec<String>>,
    /// The covariance that is added, n × n, of what the mode does not know; absent, nothing is.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "if_there_at_all"
    )]
    #[schemars(with = "Rows")]
    pub added: Option<Rows>,
}

/// From which mode to which reader.
type Ends = (usize, Reader);

impl ProblemFile {
    /// The components of the state of a mode, or of the problem's.
    pub fn components_of(&self, reader: Reader) -> &[ComponentFile] {
        match reader {
            Reader::Mode(j) => self.modes[j].models.state.as_deref().unwrap_or(&self.state),
            Reader::Common => &self.state,
        }
    }

    /// Which entries of the state of a mode, or of the problem's, are angles.
    pub(super) fn angles_of_state(&self, reader: Reader) -> Vec<usize> {
        let components = self.components_of(reader).iter().enumerate();
        let angles = components.filter(|(_, component)| component.kind == ComponentKind::Angle);
        angles.map(|(index, _)| index).collect()
    }

    /// The states have the same number of entries, and the conversions are those that are needed, of the right shapes.
    pub(super) fn check_state_conversions(&self) -> Result<(), Invalid> {
        let n = self.state.len();
        for (j, mode) in self.modes.iter().enumerate() {
            if let Some(state) = &mode.models.state {
                check_length(&format!("problem.modes[{j}].state"), state.len(), n)?;
            }
        }
        let mut there: Vec<Ends> = Vec::with_capacity(self.conversions.len());
        for (index, conversion) in self.conversions.iter().enumerate() {
            let place = format!("problem.conversions[{index}]");
            let ends = self.ends(conversion, &place)?;
            self.check_ends(ends, &there, &place)?;
            there.push(ends);
            check_contents(conversion, n, &place)?;
        }
        match self.needed().find(|ends| !there.contains(ends)) {
            None => Ok(()),
            Some(ends) => {
                let reason = format!("lacks the one {}, whose states differ", self.named(ends));
                Err(Invalid::new(Class::Format, "problem.conversions", reason))
            }
        }
    }

    /// Whether two readers have the same state: the same components in the same order, in units that do not contradict each other.
    fn are_alike(&self, a: Reader, b: Reader) -> bool {
        let is_same = |(a, b): (&ComponentFile, &ComponentFile)| {
            let differ = a.unit.as_ref().zip(b.unit.as_ref()).is_some_and(|(a, b)| a != b);
            a.name == b.name && a.kind == b.kind && !differ
        };
        self.components_of(a).iter().zip(self.components_of(b)).all(is_same)
    }

    /// The conversions that a problem needs.
    fn needed(&self) -> impl Iterator<Item = Ends> {
        let modes = 0..self.modes.len();
        let readers = modes.clone().map(Reader::Mode).chain([Reader::Common]);
        let pairs = readers.flat_map(move |to| modes.clone().map(move |from| (from, to)));
        pairs.filter(|(from, to)| !self.are_alike(Reader::Mode(*from), *to))
    }

    /// From which mode to which reader a conversion is.
    fn ends(&self, conversion: &StateConversionFile, place: &str) -> Result<Ends, Invalid> {
        let from = self.mode_of(&conversion.from, &format!("{place}.from"))?;
        Ok(match &conversion.to {
            None => (from, Reader::Common),
            Some(to) => (from, Reader::Mode(self.mode_of(to, &format!("{place}.to"))?)),
        })
    }

    /// The mode of a name, which is to be that of one.
    fn mode_of(&self, name: &str, place: &str) -> Result<usize, Invalid> {
        let names = || self.modes.iter().map(|mode| mode.name.as_str());
        let Some(found) = names().position(|own| own == name) else {
            let near =
                nearest(name, names()).map_or_else(String::new, |near| format!("; the nearest name is `{near}`"));
            let reason = format!("is {name:?}, and no mode has this name{near}");
            return Err(Invalid::new(Class::Unknown, place, reason));
        };
        if names().skip(found + 1).any(|own| own == name) {
            let reason = format!("is {name:?}, which is the name of several modes; give each a name of its own");
            return Err(Invalid::new(Class::Format, place, reason));
        }
        Ok(found)
    }

    fn check_ends(&self, (from, to): Ends, before: &[Ends], place: &str) -> Result<(), Invalid> {
        let reason = if let Some(other) = before.iter().position(|ends| *ends == (from, to)) {
            format!(
                "is {} as problem.conversions[{other}] is; each is given once",
                self.named((from, to))
            )
        } else if self.are_alike(Reader::Mode(from), to) {
            format!(
                "is {}, and both have the same state; leave it out",
                self.named((from, to))
            )
        } else {
            return Ok(());
        };
        Err(Invalid::new(Class::Format, place, reason))
    }

    /// The ends of a conversion in words.
    fn named(&self, (from, to): Ends) -> String {
        let name = |mode: usize| &self.modes[mode].name;
        match to {
            Reader::Mode(to) => format!("from {:?} to {:?}", name(from), name(to)),
            Reader::Common => format!("from {:?} to the combined estimates (without `to`)", name(from)),
        }
    }

    /// The maps of the conversions, where they are given by formulas.
    pub(super) fn conversion_functions(&self, scope: &Scope) -> Result<Vec<Option<Bound>>, Invalid> {
        let mut functions = Vec::with_capacity(self.conversions.len());
        for (index, conversion) in self.conversions.iter().enumerate() {
            let Some(formulas) = &conversion.formulas else {
                functions.push(None);
                continue;
            };
            let place = format!("problem.conversions[{index}]");
            let (from, _) = self.ends(conversion, &place)?;
            let state = self.space_of(from)?;
            let bound = scope.bound(&state.names(), formulas, |row| format!("{place}.formulas[{row}]"))?;
            functions.push(Some(bound));
        }
        Ok(functions)
    }

    /// Which estimates the filters start from, in a step of this length: all of them, converted where states differ.
    pub(super) fn converted<T: Real>(
        &self,
        functions: &Functions,
        number: fn(f64) -> T,
        interval: Option<f64>,
    ) -> Result<Interaction<T, Dyn>, Invalid> {
        if self.conversions.is_empty() {
            return Ok(Interaction::Imm);
        }
        let n = self.state.len();
        let mut list = Vec::with_capacity(self.conversions.len());
        for (index, (conversion, bound)) in self.conversions.iter().zip(&functions.conversions).enumerate() {
            let (from, to) = self.ends(conversion, &format!("problem.conversions[{index}]"))?;
            let rows = conversion.matrix.as_ref();
            list.push(StateConversion {
                from,
                to,
                map: match bound {
                    Some(bound) => bound.motion(number, interval),
                    None => Motion::Linear(rows.map_or_else(|| DMatrix::zeros(n, n), |rows| matrix(rows, number))),
                },
                added: match &conversion.added {
                    Some(rows) => matrix(rows, number),
                    None => DMatrix::zeros(n, n),
                },
            });
        }
        let modes = (0..self.modes.len()).map(Reader::Mode);
        let angles = modes.map(|mode| self.angles_of_state(mode)).collect();
        Ok(Interaction::Converted(StateConversions { list, angles }))
    }
}

/// A conversion is a matrix or formulas, and what it adds has the right shape.
fn check_contents(conversion: &StateConversionFile, n: usize, place: &str) -> Result<(), Invalid> {
    match (&conversion.matrix, &conversion.formulas) {
        (Some(rows), None) => check_matrix(&format!("{place}.matrix"), rows, n, n)?,
        (None, Some(formulas)) => {
            let found = formulas.len();
            if found != n {
                let reason = format!("has {found} formulas where the state has {n} components");
                return Err(Invalid::new(Class::Shape, format!("{place}.formulas"), reason));
            }
        }
        (None, None) => {
            return Err(Invalid::new(
                Class::Format,
                place,
                "has neither `matrix` nor `formulas`",
            ));
        }
        (Some(_), Some(_)) => {
            let reason = "has both `matrix` and `formulas`; a conversion is said once";
            return Err(Invalid::new(Class::Format, place, reason));
        }
    }
    match &conversion.added {
        Some(rows) => check_matrix(&format!("{place}.added"), rows, n, n),
        None => Ok(()),
    }
}
