//! Why a problem cannot be run: each error names the field and the equation that needs it.

/// Why a problem cannot be run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InvalidProblem {
    /// A list has the wrong length.
    #[error("`{field}` has {found} entries where there are {expected} modes ({equation})")]
    Length {
        /// The field.
        field: String,
        /// Its length.
        found: usize,
        /// The number of modes.
        expected: usize,
        /// The equation that needs it.
        equation: &'static str,
    },
    /// There are no modes.
    #[error(
        "`modes` is empty; the filter needs at least one ({equation})",
        equation = "zhu2016 (54)"
    )]
    NoModes,
    /// There are no filters.
    #[error(
        "`filters` is empty; the modes need one each, or one for all ({equation})",
        equation = "zhu2016 (55)"
    )]
    NoFilters,
    /// A value is not finite.
    #[error("`{field}` has an entry that is not finite ({equation})")]
    NotFinite {
        /// The field.
        field: String,
        /// The equation that needs it.
        equation: &'static str,
    },
    /// A probability is negative.
    #[error("`{field}` has a negative entry, {value}; it must be a probability ({equation})")]
    NegativeProbability {
        /// The field.
        field: String,
        /// The entry.
        value: String,
        /// The equation that needs it.
        equation: &'static str,
    },
    /// Probabilities do not sum to one.
    #[error("`{field}` sums to {sum}; it must sum to 1 ({equation})")]
    NotNormalised {
        /// The field.
        field: String,
        /// Its sum.
        sum: String,
        /// The equation that needs it.
        equation: &'static str,
    },
    /// A covariance is not symmetric.
    #[error("`{field}` is not symmetric ({equation})")]
    NotSymmetric {
        /// The field.
        field: String,
        /// The equation that needs it.
        equation: &'static str,
    },
    /// A covariance is not positive semidefinite, or that of a given innovation not definite.
    #[error("`{field}` is not positive {kind} ({equation})")]
    NotPositive {
        /// The field.
        field: String,
        /// "definite" or "semidefinite".
        kind: &'static str,
        /// The equation that needs it.
        equation: &'static str,
    },
    /// Process and measurement noise are more correlated than their covariances allow.
    #[error(
        "`{field}` is more than Q and R allow: [[Q, M], [Mᵀ, R]] is not positive semidefinite (Simon 2006, section 7.1)"
    )]
    NotJoint {
        /// The cross-covariance.
        field: String,
    },
    /// A filter that has no matrix of the measurement was given correlated noises.
    #[error(
        "`{field}` is given to a filter that takes no noise that is correlated; use a Kalman or an extended filter (Simon 2006, section 7.1)"
    )]
    CorrelationWithoutSlopes {
        /// The cross-covariance.
        field: String,
    },
    /// A Kalman filter was given a motion or a measurement that is not linear.
    #[error(
        "`{field}` is not linear, and the Kalman filter takes matrices; use an extended, unscented or cubature filter (zhu2016 (42))"
    )]
    NotLinear {
        /// The measurement, or the motion of a mode.
        field: String,
    },
    /// Some filters have given gains and others compute theirs.
    #[error(
        "`filters` has given gains for some modes only; estimates with and without covariances cannot be mixed (derbez2000 (2))"
    )]
    SomeGiven,
    /// A run with covariances is to go on without them, or the reverse.
    #[error(
        "`filters` gives gains where the run computes them, or the reverse; begin a new run instead (derbez2000 (2))"
    )]
    OtherKind,
    /// The filter of second order was given a problem of another one.
    #[error(
        "`interaction` says which estimates the modes start from, and the filter of second order starts each from every one; use `Interaction::Imm` (Chang and Athans 1978)"
    )]
    OtherInteraction,
    /// A plain filter was given another number of modes than it is built for.
    #[error(
        "`modes` has {found} entries where the filter is built for {expected}; give it as many modes as `MODES` says"
    )]
    OtherModes {
        /// The modes of the problem.
        found: usize,
        /// `MODES`.
        expected: usize,
    },
    /// A filter with a given gain is to draw points.
    #[error(
        "`filters` has a given gain and draws points; without a covariance there is nothing to draw them from (derbez2000 (2))"
    )]
    NothingToDrawFrom,
    /// A matrix has another shape than the state and the measurement ask for.
    #[error("`{field}` is {} × {} where {} × {} is needed", found.0, found.1, expected.0, expected.1)]
    Shape {
        /// The field.
        field: String,
        /// Its rows and columns.
        found: (usize, usize),
        /// The rows and columns that are needed.
        expected: (usize, usize),
    },
    /// A covariance was given to a filter that has none.
    #[error(
        "`{field}` is given, but filters with fixed gains have no covariance ({equation})",
        equation = "derbez2000 (2)"
    )]
    CovarianceGiven {
        /// The field.
        field: String,
    },
    /// Two modes convert the measurement in two ways.
    #[error(
        "`filters` has two conversions; all modes that convert the measurement need the same one (sustika2015 (22))"
    )]
    TwoConversions,
    /// A measurement to be converted is not one range and one bearing.
    #[error(
        "`measurement.components` must be one range and one bearing to be converted to a position (sustika2015 (20))"
    )]
    NotRangeAndBearing,
    /// The noise of a measurement to be converted has a covariance between range and bearing.
    #[error(
        "`R` has a covariance between range and bearing; a conversion knows only their variances (sustika2015 (4))"
    )]
    CorrelatedNoise,
    /// A conversion of estimates is of no two readers, or not the only one of them.
    #[error("`conversions[{index}]` {reason} (Granström, Willett and Bar-Shalom 2015)")]
    Conversion {
        /// The conversion, counted from 0.
        index: usize,
        /// What is wrong.
        reason: &'static str,
    },
    /// Estimates without covariances are to be converted.
    #[error(
        "`conversions` are of means and covariances, and filters with fixed gains have no covariance; give all modes one state (derbez2000 (2))"
    )]
    ConversionsOfGiven,
    /// A rule's points and weights differ in number.
    #[error("`rule` has {points} points, {weights} weights and {covariance_weights} covariance weights (zhu2016 (21))")]
    RuleLengths {
        /// The number of points.
        points: usize,
        /// The number of weights.
        weights: usize,
        /// The number of covariance weights.
        covariance_weights: usize,
    },
    /// An angle is not an entry of the state, or is named twice.
    #[error("`angles` names entry {index} of a state of {dimension}; it is not there, or named twice")]
    Angle {
        /// The entry, counted from 0.
        index: usize,
        /// The dimension of the state.
        dimension: usize,
    },
    /// The position of a polar measurement is not in the state.
    #[error("`measurement.position` names entry {index} of a state of {dimension} (liu2017 (31))")]
    Position {
        /// The entry, counted from 0.
        index: usize,
        /// The dimension of the state.
        dimension: usize,
    },
    /// Both coordinates of the position of a polar measurement are the same entry of the state.
    #[error("`measurement.position` names entry {index} twice; range and bearing need an x and a y (liu2017 (31))")]
    PositionTwice {
        /// The entry, counted from 0.
        index: usize,
    },
}
