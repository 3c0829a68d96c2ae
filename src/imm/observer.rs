//! Who watches a step: every value as soon as it is there.

use super::Step;
use super::record::Quantity;
use crate::matrix::{Holds, Shapes};
use crate::number::Field;
use nalgebra::Dim;

/// Called with each traced value as soon as it is computed. It may replace the value; everything downstream then uses the replacement.
///
/// The filter that nobody observes has the observer `()`, which does nothing and costs nothing.
///
/// Example: what is computed in a step, by name.
///
/// ```
/// use immaculate::filter::Filter;
/// use immaculate::{gaussian::Gaussian, imm::{Imm, Initial, Interaction, Observer, Problem, Quantity, Step}};
/// use immaculate::model::{Sensor, motion::{Mode, Motion}};
/// use nalgebra::{U1, matrix, vector};
///
/// struct Names(Vec<&'static str>);
/// impl Observer<f64, U1, U1> for Names {
///     fn computed(&mut self, quantity: Quantity, _mode: usize, _now: &mut Step<f64, U1, U1>) {
///         self.0.push(quantity.name());
///     }
/// }
///
/// let problem = Problem {
///     modes: vec![Mode { name: "walk".into(), motion: Motion::Linear(matrix![1.0]), noise: matrix![1.0] }],
///     chain: vec![vec![1.0]],
///     sensor: Sensor::Linear(matrix![1.0]),
///     measurement_noise: matrix![2.0],
///     filters: vec![Filter::kalman()],
///     interaction: Interaction::Imm,
///     angles: vec![],
/// };
/// let initial = Initial {
///     modes: vec![Gaussian { mean: vector![0.0], covariance: matrix![1.0] }],
///     mode_probabilities: vec![1.0],
/// };
/// let mut names = Names(Vec::new());
/// Imm::new(problem, &initial)?.step_observed(None, &mut names)?;
/// assert_eq!(names.0[2..6], ["mixed.mean", "mixed.covariance", "predicted.mean", "predicted.covariance"]);
/// assert!(!names.0.contains(&"gain")); // without a detection
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Observer<T: Field, N: Dim, M: Dim>
where
    Shapes: Holds<N, M>,
{
    /// The quantity of mode j (0 for a quantity of all modes together) has just been computed and stands in the record.
    fn computed(&mut self, quantity: Quantity, j: usize, now: &mut Step<T, N, M>);
}

impl<T: Field, N: Dim, M: Dim> Observer<T, N, M> for ()
where
    Shapes: Holds<N, M>,
{
    fn computed(&mut self, _: Quantity, _: usize, _: &mut Step<T, N, M>) {}
}
