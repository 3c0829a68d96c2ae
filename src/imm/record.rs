//! The record of one step: every value of the cycle under its name, and the table of those that a trace shows.
//!
//! [`Step`] has a place for each value, in the order in which they are computed. [`Quantity`] names the values that are traced: a row of
//! the table below says of each its name, its shape, whether each mode has its own, when it exists, and where it stands. The record that
//! is read and overwritten by name, traces, the judge and the file formats are made from these rows. The points of cubature filters are not
//! among them: programs draw them in different orders.

use super::entries::Entries;
pub use super::row::{Needs, Row, Side};
use crate::gaussian::Gaussian;
use crate::matrix::{Holds, Shapes};
use crate::number::Field;
use nalgebra::{Dim, OMatrix, OVector};

/// All values of step k. Lists have one entry a mode; step 0 is the initial estimate.
///
/// A value that a step does not have is not there: without a detection the lists of what comes from a measurement are empty.
/// Filters whose gains are given have no covariances of the state; where a [`Gaussian`] holds one, it is undecided.
#[derive(Debug, Clone, PartialEq)]
pub struct Step<T: Field, N: Dim, M: Dim>
where
    Shapes: Holds<N, M>,
{
    /// k, counted from 0.
    pub step: usize,
    /// The measurement z, or none at a missed detection and at step 0.
    pub measurement: Option<OVector<T, M>>,
    /// The true state, where it is known.
    pub truth: Option<OVector<T, N>>,
    /// cⱼ.
    pub predicted_mode_probabilities: Vec<T>,
    /// μᵢ∣ⱼ as `[j][i]`.
    pub mixing_probabilities: Vec<Vec<T>>,
    /// The mixed estimates x̂⁰ʲ, P⁰ʲ.
    pub mixed: Vec<Gaussian<T, N>>,
    /// Points of the mixed estimates, `[j][s]`; none for a filter that draws none.
    pub mixed_points: Vec<Vec<OVector<T, N>>>,
    /// The propagated points, `[j][s]`.
    pub propagated_points: Vec<Vec<OVector<T, N>>>,
    /// F, the Jacobians of the motions at the mixed means; of filters that linearise.
    pub motion_jacobians: Vec<Option<OMatrix<T, N, N>>>,
    /// The predicted estimates.
    pub predicted: Vec<Gaussian<T, N>>,
    /// The combined estimate before the measurement.
    pub combined_prediction: Gaussian<T, N>,
    /// The measurement as a position; of filters that convert it.
    pub converted_measurement: Option<OVector<T, M>>,
    /// R^c, the covariance of the converted measurement.
    pub converted_covariance: Option<OMatrix<T, M, M>>,
    /// Where the measurement is linearised, if not at the predicted mean: of filters that do it more than once.
    pub linearisation_points: Vec<Option<OVector<T, N>>>,
    /// H, the Jacobians of the measurement there; of filters that linearise.
    pub measurement_jacobians: Vec<Option<OMatrix<T, M, N>>>,
    /// Points drawn afresh from the predicted estimates, `[j][s]`; none for a filter that draws none.
    pub predicted_points: Vec<Vec<OVector<T, N>>>,
    /// The measurements of these points, `[j][s]`.
    pub measured_points: Vec<Vec<OVector<T, M>>>,
    /// ẑʲ.
    pub predicted_measurements: Vec<OVector<T, M>>,
    /// ν = z − ẑ, angles wrapped.
    pub innovations: Vec<OVector<T, M>>,
    /// S = P_zz.
    pub innovation_covariances: Vec<OMatrix<T, M, M>>,
    /// C = P_xz.
    pub cross_covariances: Vec<OMatrix<T, N, M>>,
    /// W.
    pub gains: Vec<OMatrix<T, N, M>>,
    /// The updated estimates; the predicted ones at a missed detection.
    pub updated: Vec<Gaussian<T, N>>,
    /// ln Lⱼ.
    pub log_likelihoods: Vec<T>,
    /// νᵀ S⁻¹ ν; none by equations without consistency.
    pub nis: Vec<Option<T>>,
    /// Λⱼ, the likelihoods relative to the greatest.
    pub relative_likelihoods: Vec<T>,
    /// C, the normaliser of the mode probabilities; 1 where nothing was measured.
    pub evidence: T,
    /// The log-likelihood of the measurement under all modes; 0 where nothing was measured.
    pub log_evidence: T,
    /// μⱼ; the predicted ones at a missed detection.
    pub mode_probabilities: Vec<T>,
    /// The combined estimate.
    pub combined: Gaussian<T, N>,
    /// (x − x̂)ᵀ P⁻¹ (x − x̂) of the combined estimate, where the true state x is known and P is definite.
    pub nees: Option<T>,
}

impl<T: Field, N: Dim, M: Dim> Step<T, N, M>
where
    Shapes: Holds<N, M>,
{
    /// Step 0: the initial estimates and probabilities. Where a later step has another value of the same shape, the estimate stands for it
    /// until it is computed.
    pub fn initial(estimates: &[Gaussian<T, N>], mode_probabilities: &[T]) -> Self {
        Self {
            step: 0,
            measurement: None,
            truth: None,
            predicted_mode_probabilities: mode_probabilities.to_vec(),
            mixing_probabilities: vec![mode_probabilities.to_vec(); estimates.len()],
            mixed: estimates.to_vec(),
            motion_jacobians: Vec::new(),
            mixed_points: Vec::new(),
            propagated_points: Vec::new(),
            predicted: estimates.to_vec(),
            combined_prediction: estimates[0].clone(),
            converted_measurement: None,
            converted_covariance: None,
            linearisation_points: Vec::new(),
            measurement_jacobians: Vec::new(),
            predicted_points: Vec::new(),
            measured_points: Vec::new(),
            predicted_measurements: Vec::new(),
            innovations: Vec::new(),
            innovation_covariances: Vec::new(),
            cross_covariances: Vec::new(),
            gains: Vec::new(),
            updated: estimates.to_vec(),
            log_likelihoods: Vec::new(),
            nis: Vec::new(),
            relative_likelihoods: Vec::new(),
            evidence: T::one(),
            log_evidence: T::zero(),
            mode_probabilities: mode_probabilities.to_vec(),
            combined: estimates[0].clone(),
            nees: None,
        }
    }

    /// Takes out every value that comes from a measurement or is drawn anew: what stands there from an earlier step is not this step's.
    pub(super) fn clear(&mut self) {
        self.motion_jacobians.clear();
        self.mixed_points.clear();
        self.propagated_points.clear();
        self.converted_measurement = None;
        self.converted_covariance = None;
        self.linearisation_points.clear();
        self.measurement_jacobians.clear();
        self.predicted_points.clear();
        self.measured_points.clear();
        self.predicted_measurements.clear();
        self.innovations.clear();
        self.innovation_covariances.clear();
        self.cross_covariances.clear();
        self.gains.clear();
        self.log_likelihoods.clear();
        self.nis.clear();
        self.nees = None;
        self.relative_likelihoods.clear();
        self.evidence = T::one();
        self.log_evidence = T::zero();
    }
}

/// The table. A row: the value, its name, its rows and columns, of each mode or of all, what it needs, its place in [`Step`], and its
/// equations; `[j]` stands for the entry of mode j, `?` for a value that may not be there.
macro_rules! values {
    ($($value:ident $name:literal ($rows:ident, $columns:ident) $per:ident [$($needs:ident),*]
        $field:ident $([$mode:ident])? $(? $some:ident)? $(. $part:ident)?, $equation:literal;)*) => {
        /// A traced value of a step.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Quantity {
            $(#[doc = concat!("`", $name, "`.")] $value,)*
        }

        impl Quantity {
            /// All, in the order in which they are computed.
            pub const ALL: [Self; [$(stringify!($value)),*].len()] = [$(Self::$value),*];

            /// The rows of the table, in the same order.
            pub const ROWS: [Row; Self::ALL.len()] = [$(Row {
                name: $name,
                equation: $equation,
                rows: Side::$rows,
                columns: Side::$columns,
                is_of_mode: values!(@is_of_mode $per),
                needs: &[$(Needs::$needs),*],
            }),*];
        }

        impl<T: Field, N: Dim, M: Dim> Step<T, N, M>
        where
            Shapes: Holds<N, M>,
        {
            /// The numbers of a quantity, by columns; of mode j if the quantity has a mode.
            fn entries(&self, quantity: Quantity, j: usize) -> Option<&[T]> {
                match quantity {
                    $(Quantity::$value => {
                        Some(values!(@place self, j, get, as_ref, $field $([$mode])? $(? $some)? $(. $part)?).entries())
                    })*
                }
            }

            /// As [`Step::entries`], to be overwritten.
            fn entries_mut(&mut self, quantity: Quantity, j: usize) -> Option<&mut [T]> {
                match quantity {
                    $(Quantity::$value => {
                        Some(values!(@place self, j, get_mut, as_mut, $field $([$mode])? $(? $some)? $(. $part)?).entries_mut())
                    })*
                }
            }
        }
    };
    (@is_of_mode each) => { true };
    (@is_of_mode all) => { false };
    (@place $step:ident, $j:ident, $get:ident, $as:ident, $field:ident) => { $step.$field };
    (@place $step:ident, $j:ident, $get:ident, $as:ident, $field:ident . $part:ident) => { $step.$field.$part };
    (@place $step:ident, $j:ident, $get:ident, $as:ident, $field:ident ? $some:ident) => { $step.$field.$as()? };
    (@place $step:ident, $j:ident, $get:ident, $as:ident, $field:ident [$mode:ident] ? $some:ident) => { $step.$field.$get($j)?.$as()? };
    (@place $step:ident, $j:ident, $get:ident, $as:ident, $field:ident [$mode:ident]) => { $step.$field.$get($j)? };
    (@place $step:ident, $j:ident, $get:ident, $as:ident, $field:ident [$mode:ident] . $part:ident) => { $step.$field.$get($j)?.$part };
}

#[rustfmt::skip]
values! {
    PredictedModeProbabilities "predicted_mode_probabilities" (Modes, One) all []
        predicted_mode_probabilities, "zhu2016 (54), liu2017 (13)";
    MixingProbabilities "mixing_probabilities" (Modes, One) each []
        mixing_probabilities[j], "zhu2016 (54), liu2017 (13)";
    MixedMean "mixed.mean" (State, One) each []
        mixed[j].mean, "zhu2016 (55), liu2017 (12)";
    MixedCovariance "mixed.covariance" (State, State) each [Covariances]
        mixed[j].covariance, "zhu2016 (56), liu2017 (12)";
    PredictedMean "predicted.mean" (State, One) each []
        predicted[j].mean, "zhu2016 (21), liu2017 (17)";
    MotionJacobian "motion_jacobian" (State, State) each [LinearisedMotion]
        motion_jacobians[j]? f, "Bar-Shalom, Li and Kirubarajan 2001, section 10.3";
    PredictedCovariance "predicted.covariance" (State, State) each [Covariances]
        predicted[j].covariance, "zhu2016 (24), liu2017 (17)";
    CombinedPredictionMean "combined_prediction.mean" (State, One) all []
        combined_prediction.mean, "zhu2016 (59), liu2017 (23)";
    CombinedPredictionCovariance "combined_prediction.covariance" (State, State) all [Covariances]
        combined_prediction.covariance, "zhu2016 (60), liu2017 (24)";
    ConvertedMeasurement "converted_measurement" (Measurement, One) all [Conversion, Detection]
        converted_measurement? z, "sustika2015 (20)-(21)";
    ConvertedCovariance "converted_covariance" (Measurement, Measurement) all [Conversion, Detection]
        converted_covariance? r, "sustika2015 (22)-(26)";
    PredictedMeasurement "predicted_measurement" (Measurement, One) each [Detection]
        predicted_measurements[j], "zhu2016 (42), liu2017 (19)";
    Innovation "innovation" (Measurement, One) each [Detection]
        innovations[j], "zhu2016 (52), liu2017 (20)";
    MeasurementJacobian "measurement_jacobian" (Measurement, State) each [LinearisedMeasurement, Detection]
        measurement_jacobians[j]? h, "Bar-Shalom, Li and Kirubarajan 2001, section 10.3";
    InnovationCovariance "innovation_covariance" (Measurement, Measurement) each [Detection]
        innovation_covariances[j], "zhu2016 (45), liu2017 (19)";
    CrossCovariance "cross_covariance" (State, Measurement) each [Covariances, Detection]
        cross_covariances[j], "zhu2016 (48), liu2017 (19)";
    Gain "gain" (State, Measurement) each [Detection]
        gains[j], "zhu2016 (51), liu2017 (20)";
    UpdatedMean "updated.mean" (State, One) each []
        updated[j].mean, "zhu2016 (52), liu2017 (20)";
    UpdatedCovariance "updated.covariance" (State, State) each [Covariances]
        updated[j].covariance, "zhu2016 (53), liu2017 (20)";
    LogLikelihood "log_likelihood" (One, One) each [Detection]
        log_likelihoods[j], "zhu2016 (57), liu2017 (21)";
    Nis "nis" (One, One) each [Detection, Consistency]
        nis[j]? square, "Bar-Shalom, Li and Kirubarajan 2001, section 5.4";
    ModeProbabilities "mode_probabilities" (Modes, One) all []
        mode_probabilities, "zhu2016 (58), liu2017 (22)";
    CombinedMean "combined.mean" (State, One) all []
        combined.mean, "zhu2016 (59), liu2017 (23)";
    CombinedCovariance "combined.covariance" (State, State) all [Covariances]
        combined.covariance, "zhu2016 (60), liu2017 (24)";
    Nees "nees" (One, One) all [Covariances, Truth]
        nees? square, "Bar-Shalom, Li and Kirubarajan 2001, section 5.4";
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
    ConvertedMeasurement, CrossCovariance, Gain, Innovation, InnovationCovariance, LogLikelihood, MeasurementJacobian,
    MixedCovariance, MixedMean, MixingProbabilities, ModeProbabilities, MotionJacobian, Nees, Nis, PredictedCovariance,
    PredictedMean, PredictedMeasurement, PredictedModeProbabilities, UpdatedCovariance, UpdatedMean,
};

impl Quantity {
    /// Its row of the table.
    ///
    /// Example: from the name in a trace to the printed number.
    ///
    /// ```
    /// use immaculate::imm::Quantity;
    ///
    /// assert_eq!(Quantity::MixedCovariance.row().name, "mixed.covariance");
    /// assert_eq!(Quantity::MixedCovariance.equation(), "zhu2016 (56), liu2017 (12)");
    /// ```
    pub fn row(self) -> &'static Row {
        &Self::ROWS[self as usize]
    }

    /// The name in traces, with a dot where the value is nested.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The printed equations that give it.
    pub fn equation(self) -> &'static str {
        self.row().equation
    }

    /// Whether each mode has its own; otherwise it belongs to all together.
    pub fn is_of_mode(self) -> bool {
        self.row().is_of_mode
    }

    /// Whether it exists only where something is there.
    pub fn needs(self, what: Needs) -> bool {
        self.row().needs.contains(&what)
    }

    /// Whether it exists, where `has` says what is there.
    pub fn exists(self, has: impl Fn(Needs) -> bool) -> bool {
        self.row().needs.iter().all(|&needed| has(needed))
    }

    /// Rows and columns, for n components of the state, m of the measurement and r modes. Vectors have one column, scalars one row too.
    pub fn shape(self, n: usize, m: usize, r: usize) -> (usize, usize) {
        let Row { rows, columns, .. } = self.row();
        (rows.count(n, m, r), columns.count(n, m, r))
    }

    /// 0 for a scalar, 1 for a vector, 2 for a matrix.
    pub fn rank(self) -> usize {
        let Row { rows, columns, .. } = self.row();
        usize::from(*rows != Side::One) + usize::from(*columns != Side::One)
    }

    /// Whether it is a covariance of one vector, and so symmetric; a Jacobian with as many rows as columns is not.
    pub fn is_covariance(self) -> bool {
        let Row {
            rows, columns, name, ..
        } = self.row();
        name.ends_with("covariance") && rows == columns
    }

    /// What it is computed from, besides the problem and the measurement, where `has` says what is there.
    pub fn inputs(self, has: impl Fn(Needs) -> bool) -> impl Iterator<Item = Input> {
        let inputs: &[Input] = match self {
            InnovationCovariance | Gain if !has(Needs::Covariances) => &[],
            MeasurementJacobian if has(Needs::Iterations) => &[Now(PredictedMean), Now(PredictedCovariance)],
            _ => self.all_inputs(has(Needs::Detection)),
        };
        inputs.iter().copied().filter(move |input| {
            let (Now(quantity) | Before(quantity)) = *input;
            // What is read of the step before is there with and without a detection.
            quantity.exists(|needed| needed == Needs::Detection || has(needed))
        })
    }

    /// What it is computed from by filters of any kind. A converted measurement is of what was measured alone; by the convention
    /// `at-prediction` R^c is of the combined prediction instead.
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
            MotionJacobian => &[Now(MixedMean)],
            PredictedCovariance => &[
                Now(MixedMean),
                Now(MixedCovariance),
                Now(MotionJacobian),
                Now(PredictedMean),
            ],
            CombinedPredictionMean => &[Now(PredictedModeProbabilities), Now(PredictedMean)],
            CombinedPredictionCovariance => &[
                Now(PredictedModeProbabilities),
                Now(PredictedMean),
                Now(PredictedCovariance),
                Now(CombinedPredictionMean),
            ],
            PredictedMeasurement => &[Now(PredictedMean), Now(PredictedCovariance)],
            ConvertedMeasurement | ConvertedCovariance => &[],
            Innovation => &[Now(PredictedMeasurement), Now(ConvertedMeasurement)],
            InnovationCovariance => &[
                Now(PredictedMean),
                Now(PredictedCovariance),
                Now(PredictedMeasurement),
                Now(MeasurementJacobian),
                Now(ConvertedCovariance),
            ],
            CrossCovariance => &[
                Now(PredictedMean),
                Now(PredictedCovariance),
                Now(PredictedMeasurement),
                Now(MeasurementJacobian),
            ],
            Gain => &[Now(InnovationCovariance), Now(CrossCovariance)],
            UpdatedMean if has_detection => &[Now(PredictedMean), Now(Gain), Now(Innovation)],
            MeasurementJacobian | UpdatedMean => &[Now(PredictedMean)],
            UpdatedCovariance if has_detection => &[Now(PredictedCovariance), Now(Gain), Now(InnovationCovariance)],
            UpdatedCovariance => &[Now(PredictedCovariance)],
            LogLikelihood | Nis => &[Now(Innovation), Now(InnovationCovariance)],
            ModeProbabilities if has_detection => &[Now(PredictedModeProbabilities), Now(LogLikelihood)],
            ModeProbabilities => &[Now(PredictedModeProbabilities)],
            CombinedMean => &[Now(ModeProbabilities), Now(UpdatedMean)],
            CombinedCovariance => &[
                Now(ModeProbabilities),
                Now(UpdatedMean),
                Now(UpdatedCovariance),
                Now(CombinedMean),
            ],
            Nees => &[Now(CombinedMean), Now(CombinedCovariance)],
        }
    }
}

impl<T: Field, N: Dim, M: Dim> Step<T, N, M>
where
    Shapes: Holds<N, M>,
{
    /// The numbers of a quantity, by rows; of mode j if the quantity has a mode. None where the step has no such value.
    pub fn values(&self, quantity: Quantity, j: usize) -> Option<Vec<T>> {
        let by_columns = self.entries(quantity, j)?;
        let (rows, columns) = self.shape_of(quantity);
        let by_rows = (0..by_columns.len()).map(|place| by_columns[place % columns * rows + place / columns].clone());
        Some(by_rows.collect())
    }

    /// Replaces the numbers of a quantity, by rows, if the step has such a value. They must be as many as [`Step::values`]
    /// gives.
    pub fn replace(&mut self, quantity: Quantity, j: usize, values: &[T]) {
        let (rows, columns) = self.shape_of(quantity);
        if let Some(by_columns) = self.entries_mut(quantity, j) {
            for (place, value) in values.iter().enumerate() {
                by_columns[place % columns * rows + place / columns] = value.clone();
            }
        }
    }

    fn shape_of(&self, quantity: Quantity) -> (usize, usize) {
        let m = self.measurement.as_ref().map_or(0, OVector::len);
        quantity.shape(self.combined.mean.len(), m, self.updated.len())
    }
}
