//! The flags that mark and select the published cases, and the property that each stands for.

/// Every flag, and what a problem with it is like.
pub const FLAGS: [(&str, &str); 58] = [
    (
        "single-equation",
        "All is trivial but one equation, or one group of them.",
    ),
    ("mixing", "It shows the mixing of the modes' estimates."),
    ("likelihood", "It shows the likelihoods of the modes."),
    ("combination", "It shows the combination of the modes' estimates."),
    ("update", "It shows prediction and update of one filter."),
    ("rule", "It shows the points and weights of a rule."),
    ("single-step", "There is one step, in which everything happens."),
    ("sequence", "There are a few steps, each of which needs those before."),
    ("run", "There are many steps."),
    ("published-scenario", "Modes, chain and noise are those of a paper."),
    (
        "full-correlation",
        "No covariance has a zero: nothing can hide behind one.",
    ),
    (
        "zeros",
        "Covariances have zeros, as papers have them: some mistakes cannot be seen.",
    ),
    (
        "row-order",
        "Matrices are far from symmetric: reading them by columns is seen.",
    ),
    (
        "transition-order",
        "The chain is not symmetric and the probabilities are unequal: a transposed transition matrix is seen.",
    ),
    (
        "spread",
        "The modes' means differ by about a standard deviation: what becomes of their spread is seen.",
    ),
    (
        "determinant",
        "The modes' innovation covariances differ in size: a likelihood without its determinant is seen.",
    ),
    ("one-mode", "There is one mode: the filter is the one inside it."),
    (
        "identical-modes",
        "All modes are the same: only the chain moves the probabilities.",
    ),
    (
        "as-kalman",
        "All is linear: every rule must give the Kalman filter's values.",
    ),
    (
        "not-stationary",
        "The initial probabilities are not those that the chain tends to.",
    ),
    ("first-step", "What is done at the first step is seen."),
    ("unreachable", "A mode has the predicted probability zero."),
    ("absorbing", "A mode cannot be left."),
    (
        "floor",
        "Likelihoods or probabilities are so small that a floor under them is seen.",
    ),
    ("outlier", "Every likelihood underflows a double."),
    ("missed-detection", "At least one step has no detection."),
    (
        "missed-in-a-row",
        "Several steps one after the other have no detection.",
    ),
    ("wrap", "A difference of bearings has to be wrapped."),
    (
        "straddling",
        "Bearings of the points of one prediction lie on both sides of the cut at pi.",
    ),
    ("mirror", "It is the mirror image of another problem."),
    (
        "components",
        "What and where the measured entries and the sensor are is unusual.",
    ),
    (
        "fresh-points",
        "The process noise is large: points that are not drawn afresh from the prediction are seen.",
    ),
    ("negative-weight", "The rule has a negative weight."),
    (
        "cancellation",
        "Weights of the rule are large and nearly cancel: a right filter loses digits.",
    ),
    (
        "curved",
        "The measurement is strongly curved over the width of an estimate.",
    ),
    (
        "square-root",
        "Another square root of a covariance gives another answer, which is a convention.",
    ),
    (
        "angle-mean",
        "Another mean of angles gives another answer, which is a convention.",
    ),
    (
        "far-from-origin",
        "Positions are larger than their deviations by a factor of a million.",
    ),
    ("units", "Numbers are very large or very small."),
    ("nearly-singular", "A covariance is nearly singular."),
    ("singular-noise", "The process noise is singular, which it may be."),
    (
        "fixed-gain",
        "Gains and innovation covariances are given, and there is no covariance of the state.",
    ),
    ("converted", "Range and bearing are converted to a position."),
    (
        "unequal-dimensions",
        "A mode lacks an entry of the state that another has; how they are mixed is a convention.",
    ),
    ("embedded", "A motion sets an entry of the state to zero."),
    (
        "formulas",
        "A motion or a measurement is a formula or a named model that is no matrix.",
    ),
    ("changing-steps", "F, Q, R or the chain are others in some steps."),
    (
        "state-angle",
        "An entry of the state is an angle, and estimates lie on both sides of its cut at pi.",
    ),
    (
        "states",
        "Modes have states of their own, and conversions say how they read each other.",
    ),
    (
        "missing-entry",
        "An entry of a measurement is missing, and the others are there.",
    ),
    (
        "exact",
        "An initial estimate or a measurement has no error in some direction: its covariance is singular.",
    ),
    (
        "several-sensors",
        "Sensors take turns, each with its own function and noise.",
    ),
    ("input", "A known input, or another offset, is part of the motion."),
    ("rejected", "It must be refused."),
    ("truth", "The true state is given in some steps: the error is squared."),
    (
        "correlated-noise",
        "The noises of motion and measurement have something in common.",
    ),
    (
        "rates",
        "The chain is given by rates or mean sojourn times, and the length of a step makes it.",
    ),
    (
        "interaction",
        "Modes start from the combined estimate, or each from its own, and not from mixed ones.",
    ),
];
