//! The record of one step: every value of the cycle, under its name.
//!
//! After this file the reader knows what a step computes and in which order. Each field holds one value a mode (or one in all); each
//! is given by the entry of the same name in [`Equations`](super::Equations). The record is always filled in: that is what makes
//! the filter inspectable, and costs next to nothing.
//!
//! The fields are in the order in which they are computed. [`Quantity`](super::Quantity) names those that a trace shows.

use crate::gaussian::Gaussian;
use crate::number::Field;
use nalgebra::{SMatrix, SVector};

/// All values of step k. Lists have one entry a mode; step 0 is the initial estimate.
///
/// In a step without a detection [`Step::measurement`] is none, and the values that come from a measurement are undecided. So are all
/// covariances of filters that carry none, those with fixed gains; what a filter does not draw or convert is zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Step<T, const N: usize, const M: usize> {
    /// k, counted from 0.
    pub step: usize,
    /// The measurement z, or none at a missed detection and at step 0.
    pub measurement: Option<SVector<T, M>>,
    /// cⱼ.
    pub predicted_mode_probabilities: Vec<T>,
    /// μᵢ∣ⱼ as `[j][i]`.
    pub mixing_probabilities: Vec<Vec<T>>,
    /// The mixed estimates x̂⁰ʲ, P⁰ʲ.
    pub mixed: Vec<Gaussian<T, N>>,
    /// Square roots of the mixed covariances; for filters with points.
    pub mixed_square_roots: Vec<SMatrix<T, N, N>>,
    /// Points of the mixed estimates, `[j][s]`.
    pub mixed_points: Vec<Vec<SVector<T, N>>>,
    /// The propagated points, `[j][s]`.
    pub propagated_points: Vec<Vec<SVector<T, N>>>,
    /// The predicted estimates.
    pub predicted: Vec<Gaussian<T, N>>,
    /// Square roots of the predicted covariances; for filters with points.
    pub predicted_square_roots: Vec<SMatrix<T, N, N>>,
    /// Points drawn afresh from the predicted estimates, `[j][s]`.
    pub predicted_points: Vec<Vec<SVector<T, N>>>,
    /// The measurements of these points, `[j][s]`.
    pub measured_points: Vec<Vec<SVector<T, M>>>,
    /// The measurement as a position; of filters that convert it.
    pub converted_measurement: SVector<T, M>,
    /// R^c, the covariance of the converted measurement.
    pub converted_covariance: SMatrix<T, M, M>,
    /// ẑʲ.
    pub predicted_measurements: Vec<SVector<T, M>>,
    /// ν = z − ẑ, angles wrapped.
    pub innovations: Vec<SVector<T, M>>,
    /// S = P_zz.
    pub innovation_covariances: Vec<SMatrix<T, M, M>>,
    /// C = P_xz.
    pub cross_covariances: Vec<SMatrix<T, N, M>>,
    /// W.
    pub gains: Vec<SMatrix<T, N, M>>,
    /// The updated estimates; the predicted ones at a missed detection.
    pub updated: Vec<Gaussian<T, N>>,
    /// ln Lⱼ.
    pub log_likelihoods: Vec<T>,
    /// The combined estimate before the measurement.
    pub combined_prediction: Gaussian<T, N>,
    /// Λⱼ, the likelihoods relative to the greatest.
    pub relative_likelihoods: Vec<T>,
    /// C, the normaliser of the mode probabilities.
    pub evidence: T,
    /// The log-likelihood of the measurement under all modes.
    pub log_evidence: T,
    /// μⱼ; the predicted ones at a missed detection.
    pub mode_probabilities: Vec<T>,
    /// The combined estimate.
    pub combined: Gaussian<T, N>,
}

impl<T: Field, const N: usize, const M: usize> Step<T, N, M> {
    /// A record for a number of modes and of points, all zeros, to be filled in.
    pub fn zeros(modes: usize, points: usize) -> Self {
        Self {
            step: 0,
            measurement: None,
            predicted_mode_probabilities: vec![T::zero(); modes],
            mixing_probabilities: vec![vec![T::zero(); modes]; modes],
            mixed: vec![Gaussian::zeros(); modes],
            mixed_square_roots: vec![SMatrix::zeros(); modes],
            mixed_points: vec![vec![SVector::zeros(); points]; modes],
            propagated_points: vec![vec![SVector::zeros(); points]; modes],
            predicted: vec![Gaussian::zeros(); modes],
            predicted_square_roots: vec![SMatrix::zeros(); modes],
            predicted_points: vec![vec![SVector::zeros(); points]; modes],
            measured_points: vec![vec![SVector::zeros(); points]; modes],
            converted_measurement: SVector::zeros(),
            converted_covariance: SMatrix::zeros(),
            predicted_measurements: vec![SVector::zeros(); modes],
            innovations: vec![SVector::zeros(); modes],
            innovation_covariances: vec![SMatrix::zeros(); modes],
            cross_covariances: vec![SMatrix::zeros(); modes],
            gains: vec![SMatrix::zeros(); modes],
            updated: vec![Gaussian::zeros(); modes],
            log_likelihoods: vec![T::zero(); modes],
            combined_prediction: Gaussian::zeros(),
            relative_likelihoods: vec![T::zero(); modes],
            evidence: T::zero(),
            log_evidence: T::zero(),
            mode_probabilities: vec![T::zero(); modes],
            combined: Gaussian::zeros(),
        }
    }

    /// Makes every covariance of the state undecided, for filters that carry none: a zero would be taken for certainty.
    pub(super) fn forget_covariances(&mut self) {
        let modes = self
            .mixed
            .iter_mut()
            .chain(&mut self.predicted)
            .chain(&mut self.updated);
        for estimate in modes.chain([&mut self.combined_prediction, &mut self.combined]) {
            estimate.covariance.fill(T::undecided());
        }
        for covariance in &mut self.cross_covariances {
            covariance.fill(T::undecided());
        }
    }

    /// Makes every value that comes from a measurement undecided, for a step without one: what stands there from an earlier step
    /// must not be taken for this step's.
    pub(super) fn forget_measured_values(&mut self) {
        for j in 0..self.innovations.len() {
            self.predicted_measurements[j].fill(T::undecided());
            self.innovations[j].fill(T::undecided());
            self.innovation_covariances[j].fill(T::undecided());
            self.cross_covariances[j].fill(T::undecided());
            self.gains[j].fill(T::undecided());
            self.log_likelihoods[j] = T::undecided();
            self.relative_likelihoods[j] = T::undecided();
            self.predicted_square_roots[j].fill(T::undecided());
            for point in &mut self.predicted_points[j] {
                point.fill(T::undecided());
            }
            for value in &mut self.measured_points[j] {
                value.fill(T::undecided());
            }
        }
        self.converted_measurement.fill(T::undecided());
        self.converted_covariance.fill(T::undecided());
        self.evidence = T::undecided();
        self.log_evidence = T::undecided();
    }
}
