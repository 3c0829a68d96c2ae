//! The values of a step that are traced: their names, their shapes, and what each is computed from.
//!
//! After this file the reader knows the vocabulary of traces and verdicts: twenty-one quantities, each given by the entry of the same
//! name in [`Equations`](super::Equations), in the order in which the wiring computes them. The points of cubature filters are not
//! among them: programs draw them in different orders.

use super::Step;
use crate::number::Field;
use nalgebra::SMatrix;

/// A traced value of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(
    missing_docs,
    reason = "each is the field of the same name of `Step`, where it is described"
)]
pub enum Quantity {
    PredictedModeProbabilities,
    MixingProbabilities,
    MixedMean,
    MixedCovariance,
    PredictedMean,
    PredictedCovariance,
    CombinedPredictionMean,
    CombinedPredictionCovariance,
    ConvertedMeasurement,
    ConvertedCovariance,
    PredictedMeasurement,
    Innovation,
    InnovationCovariance,
    CrossCovariance,
    Gain,
    UpdatedMean,
    UpdatedCovariance,
    LogLikelihood,
    ModeProbabilities,
    CombinedMean,
    CombinedCovariance,
}

/// What a kind of filter computes, of what not every kind does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Scope {
    /// Covariances of the state; filters with fixed gains have none.
    pub covariances: bool,
    /// Converted measurements.
    pub conversions: bool,
}

impl Scope {
    /// Whether filters of this kind compute a quantity.
    pub fn has(self, quantity: Quantity) -> bool {
        (self.covariances || !quantity.needs_covariances()) && (self.conversions || !quantity.needs_conversion())
    }
}

/// What a quantity is computed from: another of the same step, or of the step before. Of the same step and mode if both have a mode,
/// else of all modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Input {
    /// A quantity of the same step.
    Now(Quantity),
    /// A quantity of the step before.
    Before(Quantity),
}

use Input::{Before, Now};
use Quantity::{
    CombinedCovariance, CombinedMean, CombinedPredictionCovariance, CombinedPredictionMean, ConvertedCovariance,
    ConvertedMeasurement, CrossCovariance, Gain, Innovation, InnovationCovariance, LogLikelihood, MixedCovariance,
    MixedMean, MixingProbabilities, ModeProbabilities, PredictedCovariance, PredictedMean, PredictedMeasurement,
    PredictedModeProbabilities, UpdatedCovariance, UpdatedMean,
};

impl Quantity {
    /// All, in the order in which they are computed.
    pub const ALL: [Self; 21] = [
        PredictedModeProbabilities,
        MixingProbabilities,
        MixedMean,
        MixedCovariance,
        PredictedMean,
        PredictedCovariance,
        CombinedPredictionMean,
        CombinedPredictionCovariance,
        ConvertedMeasurement,
        ConvertedCovariance,
        PredictedMeasurement,
        Innovation,
        InnovationCovariance,
        CrossCovariance,
        Gain,
        UpdatedMean,
        UpdatedCovariance,
        LogLikelihood,
        ModeProbabilities,
        CombinedMean,
        CombinedCovariance,
    ];

    /// The name in traces, with a dot where the value is nested.
    pub fn name(self) -> &'static str {
        match self {
            PredictedModeProbabilities => "predicted_mode_probabilities",
            MixingProbabilities => "mixing_probabilities",
            MixedMean => "mixed.mean",
            MixedCovariance => "mixed.covariance",
            PredictedMean => "predicted.mean",
            PredictedCovariance => "predicted.covariance",
            CombinedPredictionMean => "combined_prediction.mean",
            CombinedPredictionCovariance => "combined_prediction.covariance",
            ConvertedMeasurement => "converted_measurement",
            ConvertedCovariance => "converted_covariance",
            PredictedMeasurement => "predicted_measurement",
            Innovation => "innovation",
            InnovationCovariance => "innovation_covariance",
            CrossCovariance => "cross_covariance",
            Gain => "gain",
            UpdatedMean => "updated.mean",
            UpdatedCovariance => "updated.covariance",
            LogLikelihood => "log_likelihood",
            ModeProbabilities => "mode_probabilities",
            CombinedMean => "combined.mean",
            CombinedCovariance => "combined.covariance",
        }
    }

    /// The printed equations that give it.
    ///
    /// Example: from the name in a trace to the printed number.
    ///
    /// ```
    /// use immaculate::imm::Quantity;
    ///
    /// assert_eq!(Quantity::MixedCovariance.name(), "mixed.covariance");
    /// assert_eq!(Quantity::MixedCovariance.equation(), "zhu2016 (56), liu2017 (12)");
    /// ```
    pub fn equation(self) -> &'static str {
        match self {
            PredictedModeProbabilities | MixingProbabilities => "zhu2016 (54), liu2017 (13)",
            MixedMean => "zhu2016 (55), liu2017 (12)",
            MixedCovariance => "zhu2016 (56), liu2017 (12)",
            PredictedMean => "zhu2016 (21), liu2017 (17)",
            PredictedCovariance => "zhu2016 (24), liu2017 (17)",
            ConvertedMeasurement => "sustika2015 (20)-(21)",
            ConvertedCovariance => "sustika2015 (22)-(26)",
            PredictedMeasurement => "zhu2016 (42), liu2017 (19)",
            Innovation | UpdatedMean => "zhu2016 (52), liu2017 (20)",
            InnovationCovariance => "zhu2016 (45), liu2017 (19)",
            CrossCovariance => "zhu2016 (48), liu2017 (19)",
            Gain => "zhu2016 (51), liu2017 (20)",
            UpdatedCovariance => "zhu2016 (53), liu2017 (20)",
            LogLikelihood => "zhu2016 (57), liu2017 (21)",
            ModeProbabilities => "zhu2016 (58), liu2017 (22)",
            CombinedMean | CombinedPredictionMean => "zhu2016 (59), liu2017 (23)",
            CombinedCovariance | CombinedPredictionCovariance => "zhu2016 (60), liu2017 (24)",
        }
    }

    /// Whether each mode has its own; otherwise it belongs to all together.
    pub fn is_of_mode(self) -> bool {
        !matches!(
            self,
            PredictedModeProbabilities
                | CombinedPredictionMean
                | CombinedPredictionCovariance
                | ConvertedMeasurement
                | ConvertedCovariance
                | ModeProbabilities
                | CombinedMean
                | CombinedCovariance
        )
    }

    /// Whether it exists only where filters carry covariances of the state.
    pub fn needs_covariances(self) -> bool {
        matches!(
            self,
            MixedCovariance
                | PredictedCovariance
                | CombinedPredictionCovariance
                | CrossCovariance
                | UpdatedCovariance
                | CombinedCovariance
        )
    }

    /// Whether it exists only where filters convert measurements.
    pub fn needs_conversion(self) -> bool {
        matches!(self, ConvertedMeasurement | ConvertedCovariance)
    }

    /// Whether it exists only where there is a detection.
    pub fn needs_detection(self) -> bool {
        matches!(
            self,
            ConvertedMeasurement
                | ConvertedCovariance
                | PredictedMeasurement
                | Innovation
                | InnovationCovariance
                | CrossCovariance
                | Gain
                | LogLikelihood
        )
    }

    /// Rows and columns, for n entries of the state, m of the measurement and r modes. Vectors have one column, scalars one row too.
    pub fn shape(self, n: usize, m: usize, r: usize) -> (usize, usize) {
        match self {
            PredictedModeProbabilities | MixingProbabilities | ModeProbabilities => (r, 1),
            MixedMean | PredictedMean | CombinedPredictionMean | UpdatedMean | CombinedMean => (n, 1),
            MixedCovariance
            | PredictedCovariance
            | CombinedPredictionCovariance
            | UpdatedCovariance
            | CombinedCovariance => (n, n),
            ConvertedMeasurement | PredictedMeasurement | Innovation => (m, 1),
            ConvertedCovariance | InnovationCovariance => (m, m),
            CrossCovariance | Gain => (n, m),
            LogLikelihood => (1, 1),
        }
    }

    /// 0 for a scalar, 1 for a vector, 2 for a matrix.
    pub fn rank(self) -> usize {
        match self {
            LogLikelihood => 0,
            MixedCovariance
            | PredictedCovariance
            | CombinedPredictionCovariance
            | ConvertedCovariance
            | InnovationCovariance
            | CrossCovariance
            | Gain
            | UpdatedCovariance
            | CombinedCovariance => 2,
            _ => 1,
        }
    }

    /// Whether it is a covariance, and so symmetric.
    pub fn is_covariance(self) -> bool {
        self.rank() == 2 && !matches!(self, CrossCovariance | Gain)
    }

    /// What it is computed from, besides the problem and the measurement, by filters of a kind.
    pub fn inputs(self, has_detection: bool, scope: Scope) -> impl Iterator<Item = Input> {
        let exists = move |input: &Input| {
            let (Now(quantity) | Before(quantity)) = *input;
            scope.has(quantity)
        };
        let inputs = match self {
            InnovationCovariance | Gain if !scope.covariances => &[],
            _ => self.all_inputs(has_detection),
        };
        inputs.iter().copied().filter(exists)
    }

    /// What it is computed from by filters of any kind.
    fn all_inputs(self, has_detection: bool) -> &'static [Input] {
        match self {
            PredictedModeProbabilities => &[Before(ModeProbabilities)],
            MixingProbabilities => &[Before(ModeProbabilities), Now(PredictedModeProbabilities)],
            MixedMean => &[Now(MixingProbabilities), Before(UpdatedMean)],
            MixedCovariance => &[
                Now(MixingProbabilities),
                Now(MixedMean),
                Before(UpdatedMean),
                Before(UpdatedCovariance),
            ],
            PredictedMean => &[Now(MixedMean), Now(MixedCovariance)],
            PredictedCovariance => &[Now(MixedMean), Now(MixedCovariance), Now(PredictedMean)],
            CombinedPredictionMean => &[Now(PredictedModeProbabilities), Now(PredictedMean)],
            CombinedPredictionCovariance => &[
                Now(PredictedModeProbabilities),
                Now(PredictedMean),
                Now(PredictedCovariance),
                Now(CombinedPredictionMean),
            ],
            PredictedMeasurement => &[Now(PredictedMean), Now(PredictedCovariance)],
            // What was measured alone. (By the convention `at-prediction` R^c is of the combined prediction instead.)
            ConvertedMeasurement | ConvertedCovariance => &[],
            Innovation => &[Now(PredictedMeasurement), Now(ConvertedMeasurement)],
            InnovationCovariance => &[
                Now(PredictedMean),
                Now(PredictedCovariance),
                Now(PredictedMeasurement),
                Now(ConvertedCovariance),
            ],
            CrossCovariance => &[Now(PredictedMean), Now(PredictedCovariance), Now(PredictedMeasurement)],
            Gain => &[Now(InnovationCovariance), Now(CrossCovariance)],
            UpdatedMean if has_detection => &[Now(PredictedMean), Now(Gain), Now(Innovation)],
            UpdatedMean => &[Now(PredictedMean)],
            UpdatedCovariance if has_detection => &[Now(PredictedCovariance), Now(Gain), Now(InnovationCovariance)],
            UpdatedCovariance => &[Now(PredictedCovariance)],
            LogLikelihood => &[Now(Innovation), Now(InnovationCovariance)],
            ModeProbabilities if has_detection => &[Now(PredictedModeProbabilities), Now(LogLikelihood)],
            ModeProbabilities => &[Now(PredictedModeProbabilities)],
            CombinedMean => &[Now(ModeProbabilities), Now(UpdatedMean)],
            CombinedCovariance => &[
                Now(ModeProbabilities),
                Now(UpdatedMean),
                Now(UpdatedCovariance),
                Now(CombinedMean),
            ],
        }
    }
}

/// A row of numbers after another.
fn by_rows<T: Field, const R: usize, const C: usize>(matrix: &SMatrix<T, R, C>) -> Vec<T> {
    matrix.transpose().iter().cloned().collect()
}

/// The matrix whose rows these numbers are.
fn from_rows<T: Field, const R: usize, const C: usize>(values: &[T]) -> SMatrix<T, R, C> {
    SMatrix::from_fn(|row, column| values[row * C + column].clone())
}

impl<T: Field, const N: usize, const M: usize> Step<T, N, M> {
    /// The numbers of a quantity, by rows; of mode j if the quantity has a mode.
    pub fn values(&self, quantity: Quantity, j: usize) -> Vec<T> {
        match quantity {
            PredictedModeProbabilities => self.predicted_mode_probabilities.clone(),
            MixingProbabilities => self.mixing_probabilities[j].clone(),
            MixedMean => by_rows(&self.mixed[j].mean),
            MixedCovariance => by_rows(&self.mixed[j].covariance),
            PredictedMean => by_rows(&self.predicted[j].mean),
            PredictedCovariance => by_rows(&self.predicted[j].covariance),
            CombinedPredictionMean => by_rows(&self.combined_prediction.mean),
            CombinedPredictionCovariance => by_rows(&self.combined_prediction.covariance),
            ConvertedMeasurement => by_rows(&self.converted_measurement),
            ConvertedCovariance => by_rows(&self.converted_covariance),
            PredictedMeasurement => by_rows(&self.predicted_measurements[j]),
            Innovation => by_rows(&self.innovations[j]),
            InnovationCovariance => by_rows(&self.innovation_covariances[j]),
            CrossCovariance => by_rows(&self.cross_covariances[j]),
            Gain => by_rows(&self.gains[j]),
            UpdatedMean => by_rows(&self.updated[j].mean),
            UpdatedCovariance => by_rows(&self.updated[j].covariance),
            LogLikelihood => vec![self.log_likelihoods[j].clone()],
            ModeProbabilities => self.mode_probabilities.clone(),
            CombinedMean => by_rows(&self.combined.mean),
            CombinedCovariance => by_rows(&self.combined.covariance),
        }
    }

    /// Puts other numbers, by rows, in the place of a quantity. They must be as many as [`Step::values`] gives.
    pub fn replace(&mut self, quantity: Quantity, j: usize, values: &[T]) {
        match quantity {
            PredictedModeProbabilities => self.predicted_mode_probabilities = values.to_vec(),
            MixingProbabilities => self.mixing_probabilities[j] = values.to_vec(),
            MixedMean => self.mixed[j].mean = from_rows(values),
            MixedCovariance => self.mixed[j].covariance = from_rows(values),
            PredictedMean => self.predicted[j].mean = from_rows(values),
            PredictedCovariance => self.predicted[j].covariance = from_rows(values),
            CombinedPredictionMean => self.combined_prediction.mean = from_rows(values),
            CombinedPredictionCovariance => self.combined_prediction.covariance = from_rows(values),
            ConvertedMeasurement => self.converted_measurement = from_rows(values),
            ConvertedCovariance => self.converted_covariance = from_rows(values),
            PredictedMeasurement => self.predicted_measurements[j] = from_rows(values),
            Innovation => self.innovations[j] = from_rows(values),
            InnovationCovariance => self.innovation_covariances[j] = from_rows(values),
            CrossCovariance => self.cross_covariances[j] = from_rows(values),
            Gain => self.gains[j] = from_rows(values),
            UpdatedMean => self.updated[j].mean = from_rows(values),
            UpdatedCovariance => self.updated[j].covariance = from_rows(values),
            LogLikelihood => self.log_likelihoods[j] = values[0].clone(),
            ModeProbabilities => self.mode_probabilities = values.to_vec(),
            CombinedMean => self.combined.mean = from_rows(values),
            CombinedCovariance => self.combined.covariance = from_rows(values),
        }
    }
}
