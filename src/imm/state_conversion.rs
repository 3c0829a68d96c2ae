//! Modes whose states mean different things: each reads the estimates of the others in its own state.
//!
//! Constant velocity knows [x, y, ẋ, ẏ], a turn [x, y, speed, heading, turn rate]. Their means cannot be added before one is written in the
//! words of the other:
//!
//! ```text
//! x̂ⁱ, Pⁱ of mode i ─ c_ij ─▶ in the state of mode j ─ mixed for j ─▶ predicted and updated there ─ c_j ─▶ in the common state, combined
//! ```
//!
//! | who reads estimates     | in which state                                                                     |
//! |-------------------------|------------------------------------------------------------------------------------|
//! | mode j, to mix them     | its own                                                                            |
//! | the combined estimates  | the common one: that of the problem, in which the sensor's function is written, too |
//!
//! Where there is no conversion, both states are the same. All states have as many entries; a mode with fewer has some that it
//! [lacks](crate::model::motion::Mode::lacks). A mode with a state of its own measures h(c(x)), c its conversion to the common state.
//!
//! Source: K. Granström, P. Willett, Y. Bar-Shalom, "Systematic Approach to IMM Mixing for Unequal Dimension States", IEEE Transactions on
//! Aerospace and Electronic Systems 51(4), 2015, for what is added where a state has more entries. That c may be any function, taken to
//! first order, is derived at [`converted_estimate`].

use super::Problem;
use super::problem::Interaction;
use crate::filter::extended::{measurement_jacobian, motion_jacobian};
use crate::filter::kalman::predicted_covariance;
use crate::gaussian::Gaussian;
use crate::matrix::{Holds, Shapes};
use crate::model::motion::Motion;
use crate::number::{Field, Real};
use nalgebra::{Dim, OMatrix, OVector};
use std::borrow::Cow;

/// Who reads an estimate, and so in which state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reader {
    /// A mode, in its own state.
    Mode(usize),
    /// The combined estimates and the sensor, in the common state.
    Common,
}

/// How a reader reads the estimate of a mode: x_j = c(x_i) + a, a ~ (0, A).
#[derive(Debug, Clone, PartialEq)]
pub struct StateConversion<T: Field, N: Dim>
where
    Shapes: Holds<N>,
{
    /// Mode i, whose estimate is read.
    pub from: usize,
    /// Who reads it.
    pub to: Reader,
    /// c, from the state of mode i to that of the reader.
    pub map: Motion<T, N>,
    /// A, N × N, in products of the units of the reader's state: what the reader must assume where mode i does not know. It is zero where
    /// nothing is added; symmetric positive semidefinite.
    pub added: OMatrix<T, N, N>,
}

/// The conversions of a problem, and which entries of each mode's own state are angles.
#[derive(Debug, Clone, PartialEq)]
pub struct StateConversions<T: Field, N: Dim>
where
    Shapes: Holds<N>,
{
    /// The conversions, in any order. A pair that has none has the same state.
    pub list: Vec<StateConversion<T, N>>,
    /// Of each mode the entries of its state that are angles, in radians.
    pub angles: Vec<Vec<usize>>,
}

/// An estimate in another state.
///
/// Source: as an extended filter moves an estimate, with what is added in place of the process noise.
///
/// ```text
/// x̂ = c(x̂ⁱ),   P = C Pⁱ Cᵀ + A,   C = ∂c/∂x at x̂ⁱ
/// ```
///
/// | symbol   | here       | shape | meaning                                                    |
/// |----------|------------|-------|------------------------------------------------------------|
/// | c        | `map`      |       | from the state of the estimate to that of the reader       |
/// | A        | `added`    | N × N | the covariance of what the estimate does not know          |
/// | x̂ⁱ, Pⁱ   | `estimate` | N     | the estimate                                               |
///
/// Why: c(x̂ + δ) = c(x̂) + C δ + …, so to first order an error δ becomes C δ. What the reader has and the estimate has not is taken
/// as independent of the rest, around the value that c gives. It is [`predicted_covariance`] with C for F and A for Q.
///
/// Example: a velocity of (3, 4) read as speed and heading; the speed has the variance of the velocity along its direction.
///
/// ```
/// use immaculate::imm::state_conversion::converted_estimate;
/// use immaculate::{gaussian::Gaussian, model::{function::Function, motion::Motion}};
/// use nalgebra::{matrix, vector};
///
/// let polar = [("speed", "hypot(vx, vy)"), ("heading", "atan2(vy, vx)")];
/// let function = Function::of_formulas(&["vx", "vy"], &[], &[], &[], &polar)?;
/// let map = Motion::Function { function: function.into(), given: vec![] };
/// let estimate = Gaussian { mean: vector![3.0, 4.0], covariance: matrix![25.0, 0.0; 0.0, 25.0] };
/// let read = converted_estimate(&map, &matrix![2.0, 0.0; 0.0, 0.0], &estimate);
/// // C = [3/5 4/5; −4/25 3/25]: 25 · (9/25 + 16/25) + 2, and 25 · (16 + 9)/625
/// assert_eq!(read.mean[0], 5.0);
/// assert!((read.covariance - matrix![27.0, 0.0; 0.0, 1.0]).norm() < 1e-14);
/// # Ok::<(), immaculate::model::function::InvalidFunction>(())
/// ```
///
/// Evidence: `one_problem_in_two_coordinate_systems_has_one_combined_estimate` (state_conversions).
pub fn converted_estimate<T: Real, N: Dim>(
    map: &Motion<T, N>,
    added: &OMatrix<T, N, N>,
    estimate: &Gaussian<T, N>,
) -> Gaussian<T, N>
where
    Shapes: Holds<N>,
{
    let slopes = motion_jacobian(map, &estimate.mean);
    Gaussian {
        mean: map.of(&estimate.mean),
        covariance: predicted_covariance(&slopes, &estimate.covariance, added),
    }
}

impl<T: Real, N: Dim, M: Dim> Problem<T, N, M>
where
    Shapes: Holds<N, M>,
{
    /// How the estimate of a mode is read; `None` where both states are the same.
    #[inline(always)]
    pub fn state_conversion(&self, from: usize, to: Reader) -> Option<&StateConversion<T, N>> {
        let Interaction::Converted(conversions) = &self.interaction else {
            return None;
        };
        let mut list = conversions.list.iter();
        list.find(|conversion| (conversion.from, conversion.to) == (from, to))
    }

    /// Which entries of a reader's state are angles.
    #[inline(always)]
    pub fn angles_of(&self, reader: Reader) -> &[usize] {
        match (&self.interaction, reader) {
            (Interaction::Converted(conversions), Reader::Mode(j)) => &conversions.angles[j],
            _ => &self.angles,
        }
    }

    /// A state of mode j in the common state, in which the sensor's function is written.
    #[inline(always)]
    pub fn in_common_state<'a>(&self, j: usize, state: &'a OVector<T, N>) -> Cow<'a, OVector<T, N>> {
        match self.state_conversion(j, Reader::Common) {
            Some(conversion) => Cow::Owned(conversion.map.of(state)),
            None => Cow::Borrowed(state),
        }
    }

    /// The Jacobian of what the sensor sees of a state of mode j, ∂h(c(x))/∂x = H C.
    ///
    /// Source: the chain rule; H at c(x), C at x.
    pub(crate) fn slopes_of_measurement(&self, j: usize, at: &OVector<T, N>) -> OMatrix<T, M, N> {
        let slopes = measurement_jacobian(&self.sensor, &self.in_common_state(j, at));
        match self.state_conversion(j, Reader::Common) {
            Some(conversion) => slopes * motion_jacobian(&conversion.map, at),
            None => slopes,
        }
    }

    /// The matrix of what the filter of mode j measures of its state, H C, as [`Problem::h`] is that of the common state.
    #[inline(always)]
    pub(crate) fn h_of(&self, j: usize) -> Cow<'_, OMatrix<T, M, N>> {
        match self.state_conversion(j, Reader::Common) {
            Some(conversion) => Cow::Owned(&*self.h() * &*conversion.map.matrix()),
            None => self.h(),
        }
    }
}

/// The estimates of all modes in the state of a reader; as they are where there are no conversions.
#[inline(always)]
pub(crate) fn estimates_read<'a, T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    estimates: &'a [Gaussian<T, N>],
    reader: Reader,
) -> Cow<'a, [Gaussian<T, N>]>
where
    Shapes: Holds<N, M>,
{
    if !matches!(problem.interaction, Interaction::Converted(_)) {
        return Cow::Borrowed(estimates);
    }
    let mut read = Vec::with_capacity(estimates.len());
    for (i, estimate) in estimates.iter().enumerate() {
        read.push(match problem.state_conversion(i, reader) {
            Some(conversion) => converted_estimate(&conversion.map, &conversion.added, estimate),
            None => estimate.clone(),
        });
    }
    Cow::Owned(read)
}
