//! A formula in words: with the names of the trace, as few brackets as it can be read with, and a fitted number in its place.

use super::explain::short;
use super::tree::{Definition, Given, Leaf, Of, Operation, Tree, Value};

/// How tightly a formula is bound: what is bound less is put in brackets inside of what is bound more.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Bound {
    Sum,
    Product,
    Whole,
}

impl Tree {
    /// The formula in words; `number` stands where one was fitted.
    pub(super) fn text(&self, number: Option<f64>) -> String {
        self.bound_text(number).0
    }

    fn bound_text(&self, number: Option<f64>) -> (String, Bound) {
        let (operation, parts) = match self {
            Self::Leaf(leaf) => return (leaf.text(), Bound::Whole),
            Self::Fitted => return (number.map_or_else(|| "c".to_owned(), rounded), Bound::Whole),
            Self::Node(operation, parts) => (*operation, parts),
        };
        let part = |index: usize, least: Bound| {
            let (text, bound) = parts[index].bound_text(number);
            if bound < least { format!("({text})") } else { text }
        };
        let plain = |index: usize| parts[index].text(number);
        let infix =
            |sign: &str, bound: Bound, right: Bound| (format!("{} {sign} {}", part(0, bound), part(1, right)), bound);
        let worded = |name: &str| (format!("{name} of {}", part(0, Bound::Whole)), Bound::Sum);
        let called = |name: &str| (format!("{name}({})", plain(0)), Bound::Whole);
        let before = |sign: &str| (format!("{sign}{}", part(0, Bound::Product)), Bound::Product);
        let after = |sign: &str| (format!("{}{sign}", part(0, Bound::Whole)), Bound::Whole);
        match operation {
            Operation::Plus => infix("+", Bound::Sum, Bound::Sum),
            Operation::Minus => infix("−", Bound::Sum, Bound::Product),
            Operation::Times => infix("·", Bound::Product, Bound::Product),
            Operation::Entrywise => infix("∘", Bound::Product, Bound::Whole),
            Operation::Over => infix("/", Bound::Product, Bound::Whole),
            Operation::Sum => {
                let (text, bound) = (
                    format!("{}·{}", part(0, Bound::Whole), part(1, Bound::Whole)),
                    Bound::Product,
                );
                (format!("Σᵢ {text}"), bound)
            }
            Operation::Stacked => parts[0].bound_text(number),
            Operation::Transpose => after("ᵀ"),
            Operation::Inverse => after("⁻¹"),
            Operation::Square => after("²"),
            Operation::Negative => before("−"),
            Operation::Twice => before("2·"),
            Operation::Half => before("½·"),
            Operation::Zero => ("0".to_owned(), Bound::Whole),
            Operation::Floor => infix_turned("with variances of at least", &part, &plain),
            Operation::Ceiling => infix_turned("with variances of at most", &part, &plain),
            Operation::OnDiagonal => (
                format!("{} + {}·I", part(1, Bound::Sum), part(0, Bound::Whole)),
                Bound::Sum,
            ),
            _ => operation.part_of().map_or_else(|| called(operation.name()), worded),
        }
    }
}

/// A bound of the diagonal, which stands before what it bounds in the tree.
fn infix_turned(
    words: &str,
    part: &dyn Fn(usize, Bound) -> String,
    plain: &dyn Fn(usize) -> String,
) -> (String, Bound) {
    (format!("{} {words} {}", part(1, Bound::Whole), plain(0)), Bound::Sum)
}

impl Operation {
    /// What of a value is kept, in words; none of an operation that is written as a function.
    fn part_of(self) -> Option<&'static str> {
        Some(match self {
            Self::Truncated => "whole part",
            Self::Single => "single precision",
            Self::Diagonal => "the diagonal alone",
            Self::Upper => "the upper triangle alone",
            Self::Lower => "the lower triangle alone",
            Self::FirstRow => "the first row alone",
            Self::FirstColumn => "the first column alone",
            Self::LastEntry => "the last entry alone",
            _ => return None,
        })
    }

    /// The name of a function.
    fn name(self) -> &'static str {
        match self {
            Self::LogDeterminant => "ln det",
            Self::Factor => "cholesky",
            Self::Exponential | Self::Likelihood => "exp",
            Self::Logarithm => "ln",
            Self::Root => "√",
            Self::Absolute => "abs",
            Self::Wrapped => "wrapped",
            Self::Normalised => "normalised",
            Self::Move => "f",
            Self::Measure => "h",
            Self::MotionSlope => "f'",
            Self::MeasurementSlope => "h'",
            Self::Read => "c",
            Self::ReadSlope => "c'",
            _ => "outer",
        }
    }
}

/// A fitted number to six digits; one that everybody knows by its name.
fn rounded(number: f64) -> String {
    use std::f64::consts::{LN_2, PI, SQRT_2};
    let known = [
        (PI, "π"),
        (2.0 * PI, "2π"),
        (libm::log(2.0 * PI), "ln 2π"),
        (libm::log(2.0 * PI) / 2.0, "½ ln 2π"),
        (180.0 / PI, "180/π"),
        (PI / 180.0, "π/180"),
        (SQRT_2, "√2"),
        (SQRT_2.recip(), "1/√2"),
        (LN_2, "ln 2"),
    ];
    for (value, name) in known {
        for (sign, value) in [("", value), ("−", -value)] {
            if (number - value).abs() <= 1e-9 * value.abs() {
                return format!("{sign}{name}");
            }
        }
    }
    short(number)
}

impl Leaf {
    fn text(self) -> String {
        let name = match self.value {
            Value::Traced(quantity) => quantity.name(),
            Value::Given(given) => given.text(),
            Value::Defined(definition) => definition.text(),
        };
        match self.of {
            Of::Itself => name.to_owned(),
            Of::Each => format!("{name}[i]"),
            Of::First => format!("{name}[mode 0]"),
            Of::Last => format!("{name}[last mode]"),
            Of::Before => format!("previous {name}"),
            Of::EachBefore => format!("previous {name}[i]"),
            Of::Right => format!("the right {name}"),
            Of::EachRight => format!("the right {name}[i]"),
            Of::EachRightBefore => format!("the right previous {name}[i]"),
            Of::AtFirstStep => format!("{name} of the first step"),
        }
    }
}

impl Given {
    fn text(self) -> &'static str {
        match self {
            Self::MotionMatrix => "F",
            Self::MotionNoise => "Q",
            Self::MeasurementMatrix => "H",
            Self::MeasurementNoise => "R",
            Self::NoiseCrossCovariance => "M",
            Self::Measurement => "z",
            Self::LinearisationPoint => "the last iterate",
            Self::Truth => "truth",
            Self::Chain => "transition",
            Self::Column => "transition[·][j]",
            Self::Row => "transition[j][·]",
            Self::Identity => "I",
            Self::InitialMean => "initial mean",
            Self::InitialCovariance => "initial covariance",
            Self::InitialProbabilities => "initial mode_probabilities",
            Self::Gain => "the given gain",
            Self::InnovationCovariance => "the given innovation_covariance",
            Self::HalfLogOfTurns => "½ m ln 2π",
            Self::RulePoints => "the rule's ξ[i]",
            Self::RuleAxes => "axis[i]",
            Self::Weights => "the rule's w",
            Self::CovarianceWeights => "the rule's w of covariances",
            Self::Alpha => "α",
            Self::Beta => "β",
            Self::Kappa => "κ",
            Self::Components => "n",
            Self::Added => "A[i]",
            Self::One => "1",
            Self::FirstPoint => "e₀",
            Self::OtherPoints => "(1 − e₀)",
        }
    }
}

impl Definition {
    pub(super) fn text(self) -> &'static str {
        match self {
            Self::Lambda => "λ",
            Self::Spread => "spread",
            Self::Weight => "wᵢ",
            Self::FirstWeight => "w₀",
            Self::FirstCovarianceWeight => "w₀ of covariances",
            Self::Weights => "w",
            Self::CovarianceWeights => "w of covariances",
            Self::RulePoints => "ξ[i]",
            Self::MixedPoints => "mixed points[i]",
            Self::PropagatedPoints => "propagated points[i]",
            Self::PredictedPoints => "predicted points[i]",
            Self::MeasuredDeviations => "their measurements from predicted_measurement[i]",
        }
    }
}
