//! The checks of modes with states of their own: the conversions between them, and the angles of each.

use super::check::{
    check_length, check_numbers_of_motion, check_places_of_angles, check_semidefinite, check_shape,
    check_shape_of_motion,
};
use super::problem::Interaction;
use super::state_conversion::{Reader, StateConversion, StateConversions};
use super::{InvalidProblem, Problem};
use crate::filter::{Transform, Update};
use crate::matrix::{Holds, Shapes};
use crate::number::Real;
use nalgebra::Dim;

impl<T: Real, N: Dim, M: Dim> Problem<T, N, M>
where
    Shapes: Holds<N, M>,
{
    /// Every conversion is from a mode to another reader, there once, and of the right shape; shapes come before values.
    pub(super) fn check_conversions(&self) -> Result<(), InvalidProblem> {
        let Interaction::Converted(conversions) = &self.interaction else {
            return Ok(());
        };
        if !self.has_covariances() {
            return Err(InvalidProblem::ConversionsOfGiven);
        }
        let (n, modes) = (self.n().value(), self.modes.len());
        check_length("conversions.angles", conversions.angles.len(), modes, SOURCE)?;
        for angles in &conversions.angles {
            check_places_of_angles(angles, n)?;
        }
        for (index, conversion) in conversions.list.iter().enumerate() {
            check_ends(conversions, index, modes)?;
            let fields = fields(index);
            check_shape_of_motion(&conversion.map, fields.clone(), n)?;
            check_numbers_of_motion(&conversion.map, fields)?;
            let added = format!("conversions[{index}].added");
            check_shape(&conversion.added, added.clone(), (n, n))?;
            check_semidefinite(&conversion.added, added, SOURCE)?;
            self.check_measured(index, conversion)?;
        }
        Ok(())
    }

    /// A filter that needs a matrix of the measurement needs one from its mode's state to the common one, too; one that iterates has the
    /// common state.
    fn check_measured(&self, index: usize, conversion: &StateConversion<T, N>) -> Result<(), InvalidProblem> {
        if conversion.to != Reader::Common {
            return Ok(());
        }
        let needs_matrix = match &self.filter(conversion.from).update {
            Update::By(transform) => *transform == Transform::Exact,
            Update::Iterated(_) => {
                let reason = "is of a mode whose filter iterates; such a mode must have the problem's `state`";
                return Err(InvalidProblem::Conversion { index, reason });
            }
            Update::Converted(_) | Update::Given(_) => true,
        };
        if conversion.map.is_linear() || !needs_matrix {
            return Ok(());
        }
        let [_, field] = fields(index);
        Err(InvalidProblem::NotLinear { field })
    }
}

/// What needs it, as the sentences of errors name it.
const SOURCE: &str = "Granström, Willett and Bar-Shalom 2015";

/// Where the matrix, or the function, of a conversion stands.
fn fields(index: usize) -> [String; 2] {
    ["matrix", "formulas"].map(|key| format!("conversions[{index}].{key}"))
}

fn check_ends<T: Real, N: Dim>(
    conversions: &StateConversions<T, N>,
    index: usize,
    modes: usize,
) -> Result<(), InvalidProblem>
where
    Shapes: Holds<N>,
{
    let ends = |conversion: &StateConversion<T, N>| (conversion.from, conversion.to);
    let (from, to) = ends(&conversions.list[index]);
    let is_there = from < modes && !matches!(to, Reader::Mode(j) if j >= modes);
    let reason = if !is_there {
        "is of a mode that is not there"
    } else if to == Reader::Mode(from) {
        "is from a mode to itself, which reads its own estimate as it is"
    } else if conversions.list[..index].iter().any(|other| ends(other) == (from, to)) {
        "is there twice; each reader reads a mode in one way"
    } else {
        return Ok(());
    };
    Err(InvalidProblem::Conversion { index, reason })
}
