//! The right formula of each value as a tree, in every form that programs use.
//!
//! The search for a wrong formula starts here. The equations themselves are in `filter` and `imm`; a test checks that each tree equals
//! them.

use super::instance::Instance;
use super::tree::{Definition, Given, Leaf, Of, Operation, Tree, Value};
use crate::filter::{Transform, Update};
use crate::imm::{Interaction, Quantity};
use crate::model::motion::Motion;

/// How a filter draws its points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Drawing {
    /// It draws none.
    None,
    /// By a rule of its own.
    Rule,
    /// By the unscented rule, from α, β and κ.
    Unscented,
}

fn leaf(value: Value, of: Of) -> Tree {
    Tree::Leaf(Leaf { value, of })
}

/// A value of the mode itself, or of all together.
fn own(quantity: Quantity) -> Tree {
    leaf(Value::Traced(quantity), Of::Itself)
}

/// A value of each mode.
fn each(quantity: Quantity) -> Tree {
    leaf(Value::Traced(quantity), Of::Each)
}

/// A value of each mode a step before.
fn each_before(quantity: Quantity) -> Tree {
    leaf(Value::Traced(quantity), Of::EachBefore)
}

fn given(given: Given) -> Tree {
    leaf(Value::Given(given), Of::Itself)
}

fn defined(definition: Definition) -> Tree {
    leaf(Value::Defined(definition), Of::Itself)
}

/// M = E[w vᵀ].
fn of_noises() -> Tree {
    given(Given::NoiseCrossCovariance)
}

/// A formula that others are made of; none for a filter that has no such thing.
pub(super) fn definition(name: Definition, drawing: Drawing) -> Option<Tree> {
    use Given::{Alpha, Beta, Components, FirstPoint, Kappa, One, OtherPoints};
    let is_unscented = drawing == Drawing::Unscented;
    let squared = |tree: Tree| tree.unary(Operation::Square);
    let over = |a: Tree, b: Tree| Tree::of(Operation::Over, [a, b]);
    let drawn =
        |mean, covariance| own(mean) + own(covariance).unary(Operation::Factor) * defined(Definition::RulePoints);
    Some(match name {
        _ if drawing == Drawing::None => return None,
        Definition::Lambda => squared(given(Alpha)) * (given(Components) + given(Kappa)) - given(Components),
        Definition::Spread => given(Components) + defined(Definition::Lambda),
        Definition::Weight => over(given(One).unary(Operation::Half), defined(Definition::Spread)),
        Definition::FirstWeight => over(defined(Definition::Lambda), defined(Definition::Spread)),
        Definition::FirstCovarianceWeight => {
            defined(Definition::FirstWeight) + ((given(One) - squared(given(Alpha))) + given(Beta))
        }
        Definition::Weights if is_unscented => {
            defined(Definition::FirstWeight) * given(FirstPoint) + defined(Definition::Weight) * given(OtherPoints)
        }
        Definition::CovarianceWeights if is_unscented => {
            defined(Definition::FirstCovarianceWeight) * given(FirstPoint)
                + defined(Definition::Weight) * given(OtherPoints)
        }
        Definition::RulePoints if is_unscented => {
            defined(Definition::Spread).unary(Operation::Root) * given(Given::RuleAxes)
        }
        Definition::Weights => given(Given::Weights),
        Definition::CovarianceWeights => given(Given::CovarianceWeights),
        Definition::RulePoints => given(Given::RulePoints),
        Definition::MixedPoints => drawn(Quantity::MixedMean, Quantity::MixedCovariance),
        Definition::PropagatedPoints => defined(Definition::MixedPoints).unary(Operation::Move),
        Definition::PredictedPoints => drawn(Quantity::PredictedMean, Quantity::PredictedCovariance),
        Definition::MeasuredDeviations => {
            let measured = defined(Definition::PredictedPoints).unary(Operation::Measure);
            (measured - own(Quantity::PredictedMeasurement)).wrapped()
        }
    })
}

/// The definitions that can be edited, each for all of its uses.
pub(super) fn definitions(drawing: Drawing) -> &'static [Definition] {
    use Definition::{
        CovarianceWeights, FirstCovarianceWeight, FirstWeight, Lambda, MeasuredDeviations, MixedPoints,
        PredictedPoints, PropagatedPoints, RulePoints, Spread, Weight, Weights,
    };
    match drawing {
        Drawing::None => &[],
        Drawing::Rule => &[
            RulePoints,
            Weights,
            CovarianceWeights,
            MixedPoints,
            PropagatedPoints,
            PredictedPoints,
            MeasuredDeviations,
        ],
        Drawing::Unscented => &[
            Lambda,
            Spread,
            Weight,
            FirstWeight,
            FirstCovarianceWeight,
            Weights,
            CovarianceWeights,
            RulePoints,
            MixedPoints,
            PropagatedPoints,
            PredictedPoints,
            MeasuredDeviations,
        ],
    }
}

/// What the moments of a mixture are made of: the estimates as they stand, or, where modes have states of their own, as they are read.
fn read_by(at: &Instance, means: Tree, covariances: Tree) -> (Tree, Tree) {
    if !matches!(at.problem().interaction, Interaction::Converted(_)) {
        return (means, covariances);
    }
    let slopes = means.clone().unary(Operation::ReadSlope);
    let covariances = moved(&slopes, covariances, given(Given::Added));
    (means.unary(Operation::Read), covariances)
}

/// Σ wᵢ (Pᵢ + (xᵢ − x)(xᵢ − x)ᵀ).
fn mixture(weights: Tree, means: Tree, covariances: Tree, mean: Tree) -> Tree {
    Tree::sum(weights, covariances + (means - mean).outer())
}

/// M P Mᵀ + N.
fn moved(matrix: &Tree, covariance: Tree, noise: Tree) -> Tree {
    (matrix.clone() * covariance) * matrix.clone().transpose() + noise
}

/// The right formulas of an instance, the plainest first. Estimates with angles in the state have none here.
pub(super) fn right(at: &Instance) -> Vec<Tree> {
    use Quantity::{
        CombinedCovariance, CombinedMean, CombinedPredictionCovariance, CombinedPredictionMean, MixedCovariance,
        MixedMean, MixingProbabilities, ModeProbabilities, Nees, PredictedCovariance, PredictedMean,
        PredictedModeProbabilities, UpdatedCovariance, UpdatedMean,
    };
    let has_headings = !at.problem().angles_of(at.reader()).is_empty();
    let before = || read_by(at, each_before(UpdatedMean), each_before(UpdatedCovariance));
    let predicted = || read_by(at, each(PredictedMean), each(PredictedCovariance));
    let updated = || read_by(at, each(UpdatedMean), each(UpdatedCovariance));
    let mean = |weights: Quantity, (means, _): (Tree, Tree)| vec![Tree::sum(own(weights), means)];
    let covariance = |weights: Quantity, (means, covariances): (Tree, Tree), about: Quantity| {
        vec![mixture(own(weights), means, covariances, own(about))]
    };
    match at.place.1 {
        MixedMean
        | MixedCovariance
        | CombinedPredictionMean
        | CombinedPredictionCovariance
        | CombinedMean
        | CombinedCovariance
        | PredictedMean
        | PredictedCovariance
        | UpdatedMean
        | Nees
            if has_headings =>
        {
            Vec::new()
        }
        PredictedModeProbabilities => {
            vec![given(Given::Chain).transpose() * leaf(Value::Traced(ModeProbabilities), Of::Before)]
        }
        MixingProbabilities if at.problem().interaction == Interaction::Unmixed => Vec::new(),
        MixingProbabilities if at.problem().interaction == Interaction::Gpb1 => {
            vec![leaf(Value::Traced(ModeProbabilities), Of::Before)]
        }
        MixingProbabilities => {
            let joint = Tree::of(
                Operation::Entrywise,
                [given(Given::Column), leaf(Value::Traced(ModeProbabilities), Of::Before)],
            );
            vec![joint.unary(Operation::Normalised)]
        }
        MixedMean => mean(MixingProbabilities, before()),
        MixedCovariance => covariance(MixingProbabilities, before(), MixedMean),
        CombinedPredictionMean => mean(PredictedModeProbabilities, predicted()),
        CombinedPredictionCovariance => covariance(PredictedModeProbabilities, predicted(), CombinedPredictionMean),
        CombinedMean => mean(ModeProbabilities, updated()),
        CombinedCovariance => covariance(ModeProbabilities, updated(), CombinedMean),
        Nees => vec![squared_distance(
            given(Given::Truth) - own(CombinedMean),
            own(CombinedCovariance),
        )],
        _ => of_filter(at),
    }
}

/// Of the filter of the mode.
fn of_filter(at: &Instance) -> Vec<Tree> {
    use Quantity::{
        CrossCovariance, InnovationCovariance, MeasurementJacobian, MixedCovariance, MixedMean, MotionJacobian,
        PredictedCovariance, PredictedMean, PredictedMeasurement,
    };
    let filter = at.problem().filter(at.place.2);
    let motion = &at.problem().modes[at.place.2].motion;
    let (is_linear, is_plain) = (motion.is_linear(), matches!(motion, Motion::Linear(_)));
    let (weights, covariance_weights) = (defined(Definition::Weights), defined(Definition::CovarianceWeights));
    let by_motion = |matrix: Tree| moved(&matrix, own(MixedCovariance), given(Given::MotionNoise));
    let moments = |deviations: Tree, noise| Tree::sum(covariance_weights.clone(), deviations.outer()) + given(noise);
    let linear_motion = || by_motion(given(Given::MotionMatrix));
    match (at.place.1, &filter.predict) {
        (PredictedMean, Transform::Points(_)) => {
            let mut forms = vec![Tree::sum(weights, defined(Definition::PropagatedPoints))];
            forms.extend(is_linear.then(|| own(MixedMean).unary(Operation::Move)));
            forms
        }
        (PredictedMean, _) if is_plain => vec![given(Given::MotionMatrix) * own(MixedMean)],
        (PredictedMean, _) => vec![own(MixedMean).unary(Operation::Move)],
        (PredictedCovariance, Transform::Points(_)) => {
            let deviations = defined(Definition::PropagatedPoints) - own(PredictedMean);
            let mut forms = vec![moments(deviations, Given::MotionNoise)];
            forms.extend(is_linear.then(linear_motion));
            forms
        }
        (PredictedCovariance, Transform::Linearised) => vec![by_motion(own(MotionJacobian))],
        (PredictedCovariance, Transform::Exact) => vec![linear_motion()],
        (MotionJacobian, _) => vec![own(MixedMean).unary(Operation::MotionSlope)],
        (MeasurementJacobian, _) => vec![at.point_of_linearisation().unary(Operation::MeasurementSlope)],
        (PredictedMeasurement | InnovationCovariance | CrossCovariance, _) => of_measurement(at),
        _ => of_update(at),
    }
}

/// ẑ, S and C.
fn of_measurement(at: &Instance) -> Vec<Tree> {
    use Quantity::{
        ConvertedCovariance, CrossCovariance, InnovationCovariance, MeasurementJacobian, PredictedCovariance,
        PredictedMean, PredictedMeasurement,
    };
    let (matrix, noise) = match &at.problem().filter(at.place.2).update {
        Update::Given(_) if at.place.1 == InnovationCovariance => return vec![given(Given::InnovationCovariance)],
        Update::By(Transform::Points(_)) => return of_points(at),
        Update::By(Transform::Linearised) | Update::Iterated(_) => {
            (own(MeasurementJacobian), given(Given::MeasurementNoise))
        }
        Update::Converted(_) => (given(Given::MeasurementMatrix), own(ConvertedCovariance)),
        _ => (given(Given::MeasurementMatrix), given(Given::MeasurementNoise)),
    };
    match at.place.1 {
        PredictedMeasurement if at.measures_by_matrix() => vec![given(Given::MeasurementMatrix) * own(PredictedMean)],
        PredictedMeasurement if at.is_iterated() => {
            let point = || at.point_of_linearisation();
            let way_back = own(PredictedMean) - point();
            vec![point().unary(Operation::Measure) + point().unary(Operation::MeasurementSlope) * way_back]
        }
        PredictedMeasurement => vec![own(PredictedMean).unary(Operation::Measure)],
        CrossCovariance => {
            let by_state = own(PredictedCovariance) * matrix.transpose();
            vec![if at.has_correlated_noises() {
                by_state + of_noises()
            } else {
                by_state
            }]
        }
        _ if at.has_correlated_noises() => {
            let by_state = moved(&matrix, own(PredictedCovariance), noise.clone());
            let shared = matrix.clone() * of_noises();
            let by_cross = (matrix * own(CrossCovariance) + shared.clone().transpose()) + noise;
            vec![(by_state + shared.clone()) + shared.transpose(), by_cross]
        }
        _ => {
            let by_cross = matrix.clone() * own(CrossCovariance) + noise.clone();
            vec![moved(&matrix, own(PredictedCovariance), noise), by_cross]
        }
    }
}

/// The moments of points: ẑ, S and C.
fn of_points(at: &Instance) -> Vec<Tree> {
    let weights = |name| defined(name);
    let deviations = || defined(Definition::MeasuredDeviations);
    match at.place.1 {
        // Angles are averaged as deviations from that of the mean.
        Quantity::PredictedMeasurement => {
            let centre = own(Quantity::PredictedMean).unary(Operation::Measure);
            let measured = defined(Definition::PredictedPoints).unary(Operation::Measure);
            let weighted = |list| Tree::sum(weights(Definition::Weights), list);
            vec![if at.measures_angles() {
                centre.clone() + weighted((measured - centre).wrapped())
            } else {
                weighted(measured)
            }]
        }
        Quantity::InnovationCovariance => {
            vec![
                Tree::sum(weights(Definition::CovarianceWeights), deviations().outer())
                    + given(Given::MeasurementNoise),
            ]
        }
        _ => {
            let of_state = defined(Definition::PredictedPoints) - own(Quantity::PredictedMean);
            vec![Tree::sum(
                weights(Definition::CovarianceWeights),
                of_state * deviations().transpose(),
            )]
        }
    }
}

/// The innovation, the gain, the update and its likelihood.
fn of_update(at: &Instance) -> Vec<Tree> {
    use Quantity::{
        ConvertedMeasurement, CrossCovariance, Gain, Innovation, InnovationCovariance, LogLikelihood,
        ModeProbabilities, Nis, PredictedMeasurement, PredictedModeProbabilities, UpdatedCovariance, UpdatedMean,
    };
    let update = &at.problem().filter(at.place.2).update;
    let likely = |likelihoods: Tree| {
        let weighed = [
            own(PredictedModeProbabilities),
            likelihoods.unary(Operation::Likelihood),
        ];
        Tree::of(Operation::Entrywise, weighed).unary(Operation::Normalised)
    };
    match (at.place.1, update) {
        (Innovation, Update::Converted(_)) => vec![own(ConvertedMeasurement) - own(PredictedMeasurement)],
        (Innovation, _) => vec![(given(Given::Measurement) - own(PredictedMeasurement)).wrapped()],
        (Gain, Update::Given(_)) => vec![given(Given::Gain)],
        (Gain, _) => {
            let of = |s: Tree| own(CrossCovariance) * s.inverse();
            let inlined = at.inlined_innovation_covariance().map(of);
            std::iter::once(of(own(InnovationCovariance))).chain(inlined).collect()
        }
        (UpdatedMean, _) => updated_means(at),
        (UpdatedCovariance, _) => updated_covariances(at),
        (LogLikelihood, _) => vec![likelihood(own(Innovation), own(InnovationCovariance))],
        (Nis, _) => vec![distance()],
        (ModeProbabilities, _) if !at.has_detection() => vec![own(PredictedModeProbabilities)],
        (ModeProbabilities, _) => vec![
            likely(each(LogLikelihood).unary(Operation::Stacked)),
            likely(likelihoods()),
        ],
        _ => Vec::new(),
    }
}

/// x + K ν, and with the gain or the innovation written out.
fn updated_means(at: &Instance) -> Vec<Tree> {
    let x = || own(Quantity::PredictedMean);
    if !at.has_detection() {
        return vec![x()];
    }
    let (k, innovation) = (|| own(Quantity::Gain), || own(Quantity::Innovation));
    let difference = given(Given::Measurement) - own(Quantity::PredictedMeasurement);
    let mut forms = vec![x() + k() * innovation()];
    if !matches!(at.problem().filter(at.place.2).update, Update::Converted(_)) {
        forms.push(x() + k() * difference.wrapped());
    }
    if !matches!(at.problem().filter(at.place.2).update, Update::Given(_)) {
        let of = |s: Tree| x() + (own(Quantity::CrossCovariance) * s.inverse()) * innovation();
        forms.push(of(own(Quantity::InnovationCovariance)));
        forms.extend(at.inlined_innovation_covariance().map(of));
    }
    forms
}

/// P − K S Kᵀ, P − K Cᵀ, (I − K H) P, the form of Joseph, and with the gain written out.
fn updated_covariances(at: &Instance) -> Vec<Tree> {
    let (p, k, c) = (
        || own(Quantity::PredictedCovariance),
        || own(Quantity::Gain),
        || own(Quantity::CrossCovariance),
    );
    if !at.has_detection() {
        return vec![p()];
    }
    let mut forms = vec![
        p() - (k() * own(Quantity::InnovationCovariance)) * k().transpose(),
        p() - k() * c().transpose(),
    ];
    let of_independent = at.slope().zip(at.noise()).filter(|_| !at.has_correlated_noises());
    if let Some((h, r)) = of_independent {
        let rest = given(Given::Identity) - k() * h;
        forms.push(rest.clone() * p());
        forms.push((rest.clone() * p()) * rest.transpose() + (k() * r) * k().transpose());
    }
    let of = |s: Tree| p() - c() * (s.inverse() * c().transpose());
    forms.extend(at.inlined_innovation_covariance().map(of));
    forms
}

/// ln L = −½ (νᵀ S⁻¹ ν + ln det S) − ½ m ln 2π.
fn likelihood(innovation: Tree, covariance: Tree) -> Tree {
    let distance = squared_distance(innovation, covariance.clone());
    let half = (distance + covariance.unary(Operation::LogDeterminant)).unary(Operation::Half);
    half.unary(Operation::Negative) - given(Given::HalfLogOfTurns)
}

/// The same of each mode, below one another.
fn likelihoods() -> Tree {
    likelihood(each(Quantity::Innovation), each(Quantity::InnovationCovariance)).unary(Operation::Stacked)
}

impl Instance<'_> {
    pub(super) fn has_detection(&self) -> bool {
        let record = self.run.steps.get(self.place.0).and_then(Option::as_ref);
        record.is_some_and(|record| record.measurement.is_some())
    }

    /// H, where the filter has one.
    fn slope(&self) -> Option<Tree> {
        match &self.problem().filter(self.place.2).update {
            Update::By(Transform::Linearised) | Update::Iterated(_) => Some(own(Quantity::MeasurementJacobian)),
            Update::By(Transform::Exact) | Update::Converted(_) => Some(given(Given::MeasurementMatrix)),
            _ => None,
        }
    }

    /// H C + R, and Mᵀ Hᵀ where the noises are correlated.
    fn inlined_innovation_covariance(&self) -> Option<Tree> {
        let (h, r) = self.slope().zip(self.noise())?;
        let of_state = h.clone() * own(Quantity::CrossCovariance);
        Some(if self.has_correlated_noises() {
            (of_state + (h * of_noises()).transpose()) + r
        } else {
            of_state + r
        })
    }

    /// Whether the measurement is linearised elsewhere than at the predicted mean.
    fn is_iterated(&self) -> bool {
        matches!(self.problem().filter(self.place.2).update, Update::Iterated(times) if times.get() > 1)
    }

    /// Where the measurement is linearised.
    fn point_of_linearisation(&self) -> Tree {
        if self.is_iterated() {
            given(Given::LinearisationPoint)
        } else {
            own(Quantity::PredictedMean)
        }
    }

    fn has_correlated_noises(&self) -> bool {
        self.problem().filter(self.place.2).noise_cross_covariance.is_some()
    }

    /// R, where the filter has one.
    fn noise(&self) -> Option<Tree> {
        match &self.problem().filter(self.place.2).update {
            Update::Converted(_) => Some(own(Quantity::ConvertedCovariance)),
            Update::By(_) | Update::Iterated(_) => Some(given(Given::MeasurementNoise)),
            Update::Given(_) => None,
        }
    }
}

/// aᵀ P⁻¹ a.
fn squared_distance(deviation: Tree, covariance: Tree) -> Tree {
    deviation.clone().transpose() * (covariance.inverse() * deviation)
}

/// The squared distance νᵀ S⁻¹ ν, by which programs decide whether they believe a measurement.
pub(super) fn distance() -> Tree {
    squared_distance(own(Quantity::Innovation), own(Quantity::InnovationCovariance))
}

/// Formulas from which the search starts as well, though they are not right: what programs do is often one edit further.
pub(super) fn starts(at: &Instance) -> Vec<Tree> {
    match at.place.1 {
        Quantity::ModeProbabilities if at.has_detection() => {
            vec![likelihoods().unary(Operation::Likelihood).unary(Operation::Normalised)]
        }
        _ => Vec::new(),
    }
}
