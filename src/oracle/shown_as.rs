//! Values that are right and shown as something else: a likelihood for its logarithm, probabilities in percent.
//!
//! ```text
//! shown ─▶ meant ─▶ within its rounding noise of the certified value, wherever it is shown?
//! ```
//!
//! Nothing is repaired: the verdict is on what is shown, and this says what was meant.

use super::evidence::Answered;
use super::judge::Case;
use super::observation::Observation;
use super::subject::Precision;
use super::trace::Trace;
use crate::imm::Quantity;

/// A way to show a value as something else.
struct ShownAs {
    /// What it is called, after "is shown as".
    name: &'static str,
    quantities: &'static [Quantity],
    /// The value that is meant by a number.
    meant: fn(f64) -> f64,
}

/// All of them.
static ALL: [ShownAs; 4] = [
    ShownAs {
        name: "its exponential: the likelihood, not its logarithm",
        quantities: &[Quantity::LogLikelihood],
        meant: libm::log,
    },
    ShownAs {
        name: "its negative",
        quantities: &[Quantity::LogLikelihood],
        meant: std::ops::Neg::neg,
    },
    ShownAs {
        name: "a logarithm to the base 10",
        quantities: &[Quantity::LogLikelihood],
        meant: |value| value * std::f64::consts::LN_10,
    },
    ShownAs {
        name: "percent",
        quantities: &[
            Quantity::PredictedModeProbabilities,
            Quantity::MixingProbabilities,
            Quantity::ModeProbabilities,
        ],
        meant: |value| value / 100.0,
    },
];

/// What is shown as something else, wherever it is shown.
pub(super) fn found(answered: &[Answered], precision: Precision) -> Vec<Observation> {
    let all = ALL
        .iter()
        .flat_map(|way| way.quantities.iter().map(move |quantity| (way, *quantity)));
    let is_so = |(way, quantity): &(&'static ShownAs, Quantity)| is_shown_as(answered, way, *quantity, precision);
    let found = all.filter(is_so);
    found
        .map(|(way, quantity)| Observation::ShownAs {
            quantity,
            way: way.name,
        })
        .collect()
}

/// Whether every value of a quantity is right, and those that are not as they stand when they are read in this way.
fn is_shown_as(answered: &[Answered], way: &ShownAs, quantity: Quantity, precision: Precision) -> bool {
    let mut is_seen = false;
    for of in answered {
        for place in of.shown.all_places().filter(|place| place.1 == quantity) {
            let Some(shown) = of.shown.finite(place.0, quantity, place.2) else {
                continue;
            };
            let is_right = |values: Vec<f64>| {
                let mut meant = Trace::empty(&of.shown.dimensions);
                meant.set(place.0, quantity, place.2, values);
                let case = Case {
                    problem: of.problem,
                    shown: &meant,
                    reference: &of.reference,
                    precision,
                };
                case.is_right(place)
            };
            if is_right(shown.clone()) {
                continue;
            }
            let meant: Vec<f64> = shown.iter().map(|value| (way.meant)(*value)).collect();
            // Values that underflowed on the way cannot be recovered.
            if meant.iter().any(|value| !value.is_finite()) {
                continue;
            }
            if !is_right(meant) {
                return false;
            }
            is_seen = true;
        }
    }
    is_seen
}
