//! Angles in the state, such as a heading: how estimates and points are averaged when some of their entries are angles.
//!
//! The papers have no angles in the state, and their sums know no circle: the mean of 179° and −179° is 0° as of numbers, and 180°
//! as of directions. Every mean here is therefore taken in one turn, that of a reference, and every deviation is wrapped:
//!
//! ```text
//! θ̄ = θ_r + Σᵢ wᵢ wrap(θᵢ − θ_r)          (θᵢ − θ̄) in (−π, π]
//! ```
//!
//! Moving the values into the turn of the reference before the plain equations see them is the same, and leaves the equations as they are
//! printed. An updated mean is wrapped to (−π, π]; another turn of any mean is the same angle.
//!
//! | average | its reference |
//! |---|---|
//! | mixed, combined, and combined prediction | the estimate of the first mode, in the state in which they are averaged |
//! | points that went through the motion | the mixed mean, moved |
//! | deviations from a mean | that mean |

use super::Equations;
use super::problem::Problem;
use super::state_conversion::{Reader, estimates_read};
use crate::filter::Transform;
use crate::gaussian::{Gaussian, mixture_covariance, mixture_mean};
use crate::matrix::{Holds, Shapes};
use crate::model::angle::wrap;
use crate::number::Real;
use nalgebra::{Dim, OVector};
use std::borrow::Cow;

/// A vector with its angles in the turn of a reference: θ_r + wrap(θ − θ_r).
///
/// Source: an angle that differs by whole turns is the same angle.
///
/// Example: −179° in the turn of 179° is 181°; the first entry is a number and stays.
///
/// ```
/// use immaculate::imm::angles::in_the_turn_of;
/// use nalgebra::vector;
///
/// let degree = std::f64::consts::PI / 180.0;
/// let moved = in_the_turn_of(&[1], &vector![0.0, 179.0 * degree], &vector![7.0, -179.0 * degree]);
/// assert!((moved - vector![7.0, 181.0 * degree]).norm() < 1e-15);
/// ```
///
/// Evidence: `turning_a_scene_by_whole_turns_changes_nothing` (angles_in_the_state).
pub fn in_the_turn_of<T: Real, N: Dim>(
    angles: &[usize],
    reference: &OVector<T, N>,
    vector: &OVector<T, N>,
) -> OVector<T, N>
where
    Shapes: Holds<N>,
{
    let mut moved = vector.clone();
    for &entry in angles {
        moved[entry] = reference[entry].clone() + wrap(vector[entry].clone() - reference[entry].clone());
    }
    moved
}

/// A mean with its angles in (−π, π].
#[inline(always)]
pub(crate) fn wrapped<T: Real, N: Dim>(angles: &[usize], mut mean: OVector<T, N>) -> OVector<T, N>
where
    Shapes: Holds<N>,
{
    for &entry in angles {
        mean[entry] = wrap(mean[entry].clone());
    }
    mean
}

/// The estimates of all modes in the state of a reader, their angles in the turn of the first one.
#[inline(always)]
pub(crate) fn estimates_near_first<'a, T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    estimates: &'a [Gaussian<T, N>],
    reader: Reader,
) -> Cow<'a, [Gaussian<T, N>]>
where
    Shapes: Holds<N, M>,
{
    let read = estimates_read(problem, estimates, reader);
    in_one_turn(problem.angles_of(reader), read, None)
}

/// The estimates of all modes in the state of a reader, their angles in the turn of a reference.
#[inline(always)]
pub(crate) fn estimates_near<'a, T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    estimates: &'a [Gaussian<T, N>],
    reader: Reader,
    reference: &OVector<T, N>,
) -> Cow<'a, [Gaussian<T, N>]>
where
    Shapes: Holds<N, M>,
{
    let read = estimates_read(problem, estimates, reader);
    in_one_turn(problem.angles_of(reader), read, Some(reference))
}

/// Estimates with their angles in the turn of a reference, or of the first of them; as they are where there is no angle.
#[inline(always)]
fn in_one_turn<'a, T: Real, N: Dim>(
    angles: &[usize],
    estimates: Cow<'a, [Gaussian<T, N>]>,
    reference: Option<&OVector<T, N>>,
) -> Cow<'a, [Gaussian<T, N>]>
where
    Shapes: Holds<N>,
{
    if angles.is_empty() {
        return estimates;
    }
    let reference = reference.unwrap_or(&estimates[0].mean);
    let near = |estimate: &Gaussian<T, N>| Gaussian {
        mean: in_the_turn_of(angles, reference, &estimate.mean),
        covariance: estimate.covariance.clone(),
    };
    Cow::Owned(estimates.iter().map(near).collect())
}

/// One estimate for several of one state, with the moments of their mixture; its angles are in (−π, π].
pub(crate) fn merged<T: Real, N: Dim>(angles: &[usize], weights: &[T], estimates: &[Gaussian<T, N>]) -> Gaussian<T, N>
where
    Shapes: Holds<N>,
{
    let mean = mixture_mean(weights, &in_one_turn(angles, Cow::Borrowed(estimates), None));
    let near = in_one_turn(angles, Cow::Borrowed(estimates), Some(&mean));
    let covariance = mixture_covariance(weights, &near, &mean);
    Gaussian {
        mean: wrapped(angles, mean),
        covariance,
    }
}

/// Points of mode j with their angles in the turn of a reference; as they are where there is no angle.
#[inline(always)]
pub(crate) fn points_near<'a, T: Real, N: Dim, M: Dim>(
    problem: &Problem<T, N, M>,
    j: usize,
    points: &'a [OVector<T, N>],
    reference: &OVector<T, N>,
) -> Cow<'a, [OVector<T, N>]>
where
    Shapes: Holds<N, M>,
{
    let angles = problem.angles_of(Reader::Mode(j));
    if angles.is_empty() {
        return Cow::Borrowed(points);
    }
    let near = |point| in_the_turn_of(angles, reference, point);
    Cow::Owned(points.iter().map(near).collect())
}

/// The mean of vectors with each of its angles that of the mean direction, atan2(Σ w sin θ, Σ w cos θ).
fn with_mean_directions<'a, T: Real, N: Dim>(
    angles: &[usize],
    weights: &[T],
    vectors: &(impl Iterator<Item = &'a OVector<T, N>> + Clone),
    mut mean: OVector<T, N>,
) -> OVector<T, N>
where
    Shapes: Holds<N>,
    OVector<T, N>: 'a,
{
    for &entry in angles {
        let (mut east, mut north) = (T::zero(), T::zero());
        for (weight, vector) in weights.iter().zip(vectors.clone()) {
            east += weight.clone() * vector[entry].cos();
            north += weight.clone() * vector[entry].sin();
        }
        mean[entry] = north.atan2(&east);
    }
    mean
}

impl<T: Real, N: Dim, M: Dim> Equations<T, N, M>
where
    Shapes: Holds<N, M>,
{
    /// Means of angles in the state by sine and cosine: another convention, which differs where the angles are far apart.
    #[must_use]
    pub fn with_mean_directions(self) -> Self {
        Self {
            mixed_mean: |problem, previous, now, j| {
                let mean = (Self::standard().mixed_mean)(problem, previous, now, j);
                let reader = Reader::Mode(j);
                let estimates = estimates_read(problem, &previous.updated, reader);
                let means = estimates.iter().map(|estimate| &estimate.mean);
                let weights = &now.mixing_probabilities[j];
                with_mean_directions(problem.angles_of(reader), weights, &means, mean)
            },
            predicted_mean: |problem, previous, now, j| {
                let mean = (Self::standard().predicted_mean)(problem, previous, now, j);
                match &problem.filter(j).predict {
                    Transform::Points(rule) => {
                        let points = now.propagated_points[j].iter();
                        with_mean_directions(problem.angles_of(Reader::Mode(j)), &rule.weights, &points, mean)
                    }
                    Transform::Exact | Transform::Linearised => mean,
                }
            },
            combined_prediction_mean: |problem, previous, now, j| {
                let mean = (Self::standard().combined_prediction_mean)(problem, previous, now, j);
                let estimates = estimates_read(problem, &now.predicted, Reader::Common);
                let means = estimates.iter().map(|estimate| &estimate.mean);
                with_mean_directions(&problem.angles, &now.predicted_mode_probabilities, &means, mean)
            },
            combined_mean: |problem, previous, now, j| {
                let mean = (Self::standard().combined_mean)(problem, previous, now, j);
                let estimates = estimates_read(problem, &now.updated, Reader::Common);
                let means = estimates.iter().map(|estimate| &estimate.mean);
                with_mean_directions(&problem.angles, &now.mode_probabilities, &means, mean)
            },
            ..self
        }
    }
}
