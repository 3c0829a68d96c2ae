//! The scale of each number of a trace: the unit in which its error is large or small.
//!
//! A mean is measured in its standard deviation, a covariance in √(Pᵢᵢ Pⱼⱼ), an innovation in √Sᵢᵢ, a probability in itself. The scales
//! come from the problem and its certified trace, never from the program under test.
//!
//! Filters with fixed gains have no covariance. What the measurement does to their means has one: the correction K ν has K S Kᵀ, which
//! at the equilibrium is P⁻ − P. The unit of an entry of a mean, of whatever mode, is the standard deviation of its correction in the mode
//! where that is greatest: a mode whose gain leaves an entry alone takes it from the others by mixing. An entry that no mode corrects,
//! like one of variance zero, has no unit of its own but that of the file.

use super::problem::{FilterFile, FixedGainFile, ProblemFile};
use super::trace::Trace;
use crate::imm::Quantity;

/// The unit of a probability that is zero, small enough that any other number is far away, and not zero itself.
const LEAST_PROBABILITY: f64 = 1e-300;

/// The scale of every number of a trace.
pub fn scales(problem: &ProblemFile, trace: &Trace) -> Trace {
    let corrections = match &problem.filter {
        FilterFile::FixedGain { modes, .. } => Some(corrections(modes, trace.dimensions.n)),
        _ => None,
    };
    let corrections = corrections.as_deref();
    trace.map(|(step, quantity, mode), values| scale(trace, corrections, (step, quantity, mode), values))
}

/// For each entry of the state √(K S Kᵀ)ᵢᵢ in the mode where it is greatest.
fn corrections(modes: &[FixedGainFile], n: usize) -> Vec<f64> {
    let variance = |mode: &FixedGainFile, i: usize| -> f64 {
        let (k, s) = (&mode.gain[i], &mode.innovation_covariance);
        (0..k.len())
            .flat_map(|row| (0..k.len()).map(move |column| k[row] * s[row][column] * k[column]))
            .sum()
    };
    (0..n)
        .map(|i| modes.iter().map(|mode| variance(mode, i)).fold(0.0, f64::max))
        .map(deviation)
        .collect()
}

/// The square root of a variance; 1 where there is none.
fn deviation(variance: f64) -> f64 {
    if variance == 0.0 { 1.0 } else { variance.sqrt() }
}

/// The products of the units of rows and columns.
fn outer(rows: &[f64], columns: &[f64]) -> Vec<f64> {
    rows.iter()
        .flat_map(|row| columns.iter().map(move |column| row * column))
        .collect()
}

/// What maps deviations of the columns to deviations of the rows.
fn ratio(rows: &[f64], columns: &[f64]) -> Vec<f64> {
    let inverse: Vec<f64> = columns.iter().map(|deviation| 1.0 / deviation).collect();
    outer(rows, &inverse)
}

fn scale(
    trace: &Trace,
    corrections: Option<&[f64]>,
    (step, quantity, mode): (usize, Quantity, usize),
    values: &[f64],
) -> Vec<f64> {
    use Quantity as Q;
    let n = trace.dimensions.n;
    let m = trace.dimensions.m[step - 1];
    // The square roots of a covariance's diagonal, of another quantity of the same step and mode; of states where there is no covariance,
    // those of the corrections.
    let deviations = |covariance: Q, size: usize| -> Vec<f64> {
        match (trace.get(step, covariance, mode), corrections) {
            (Some(entries), _) => (0..size).map(|i| deviation(entries[i * size + i])).collect(),
            (None, Some(corrections)) => corrections.to_vec(),
            (None, None) => vec![1.0; size],
        }
    };
    let square = |covariance: Q, size: usize| {
        let deviations = deviations(covariance, size);
        outer(&deviations, &deviations)
    };
    match quantity {
        Q::PredictedModeProbabilities | Q::MixingProbabilities | Q::ModeProbabilities => {
            values.iter().map(|value| value.max(LEAST_PROBABILITY)).collect()
        }
        Q::MixedMean => deviations(Q::MixedCovariance, n),
        Q::MotionJacobian => ratio(
            &deviations(Q::PredictedCovariance, n),
            &deviations(Q::MixedCovariance, n),
        ),
        Q::MeasurementJacobian => ratio(
            &deviations(Q::InnovationCovariance, m),
            &deviations(Q::PredictedCovariance, n),
        ),
        Q::PredictedMean => deviations(Q::PredictedCovariance, n),
        Q::CombinedPredictionMean => deviations(Q::CombinedPredictionCovariance, n),
        Q::UpdatedMean => deviations(Q::UpdatedCovariance, n),
        Q::CombinedMean => deviations(Q::CombinedCovariance, n),
        Q::MixedCovariance
        | Q::PredictedCovariance
        | Q::CombinedPredictionCovariance
        | Q::UpdatedCovariance
        | Q::CombinedCovariance => square(quantity, n),
        Q::ConvertedMeasurement => deviations(Q::ConvertedCovariance, m),
        Q::PredictedMeasurement | Q::Innovation => deviations(Q::InnovationCovariance, m),
        Q::ConvertedCovariance | Q::InnovationCovariance => square(quantity, m),
        Q::CrossCovariance => outer(
            &deviations(Q::PredictedCovariance, n),
            &deviations(Q::InnovationCovariance, m),
        ),
        Q::Gain => ratio(
            &deviations(Q::PredictedCovariance, n),
            &deviations(Q::InnovationCovariance, m),
        ),
        Q::LogLikelihood | Q::Nis | Q::Nees => vec![1.0],
    }
}
