//! The natural unit of each number of a trace.
//!
//! After this file the reader knows in what an error is said to be large or small: a mean in its standard deviation, a covariance in
//! √(Pᵢᵢ Pⱼⱼ), an innovation in √Sᵢᵢ, a probability in itself. The units come from the certified trace, never from the program under test.

use super::trace::{Dimensions, Trace};
use crate::imm::Quantity;

/// The unit of a probability that is zero, small enough that any other number is far away, and not zero itself.
const LEAST_PROBABILITY: f64 = 1e-300;

/// The scale of every number of a trace.
pub fn scales(trace: &Trace) -> Trace {
    trace.map(|(step, quantity, mode), values| scale(trace, step, quantity, mode, values))
}

fn scale(trace: &Trace, step: usize, quantity: Quantity, mode: usize, values: &[f64]) -> Vec<f64> {
    use Quantity as Q;
    let Dimensions { n, m, .. } = trace.dimensions;
    // The square roots of a covariance's diagonal; of another quantity of the same step and mode.
    let deviations = |covariance: Q, size: usize| -> Vec<f64> {
        trace.get(step, covariance, mode).map_or_else(
            || vec![1.0; size],
            |entries| (0..size).map(|i| entries[i * size + i].sqrt()).collect(),
        )
    };
    let outer = |rows: &[f64], columns: &[f64]| -> Vec<f64> {
        rows.iter()
            .flat_map(|row| columns.iter().map(move |column| row * column))
            .collect()
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
        Q::PredictedMean => deviations(Q::PredictedCovariance, n),
        Q::CombinedPredictionMean => deviations(Q::CombinedPredictionCovariance, n),
        Q::UpdatedMean => deviations(Q::UpdatedCovariance, n),
        Q::CombinedMean => deviations(Q::CombinedCovariance, n),
        Q::MixedCovariance
        | Q::PredictedCovariance
        | Q::CombinedPredictionCovariance
        | Q::UpdatedCovariance
        | Q::CombinedCovariance => square(quantity, n),
        Q::PredictedMeasurement | Q::Innovation => deviations(Q::InnovationCovariance, m),
        Q::InnovationCovariance => square(quantity, m),
        Q::CrossCovariance => outer(
            &deviations(Q::PredictedCovariance, n),
            &deviations(Q::InnovationCovariance, m),
        ),
        Q::Gain => {
            let inverse: Vec<f64> = deviations(Q::InnovationCovariance, m).iter().map(|s| 1.0 / s).collect();
            outer(&deviations(Q::PredictedCovariance, n), &inverse)
        }
        Q::LogLikelihood => vec![1.0],
    }
}
