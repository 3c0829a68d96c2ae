//! Lost digits: numbers printed with too few digits, or computed in single precision by a program that declares double.
//!
//! Every number is examined: a single number with more digits shows that none were lost.

use super::evidence::Answered;
use super::observation::Observation;
use super::subject::Precision;

/// This many digits distinguish any two numbers of single precision; a number with no more is not a double.
const MOST: usize = 9;

/// At least this many numbers that should be long must be short. One in 10⁷ doubles is short by chance.
const LEAST: usize = 5;

/// The number of decimals that `%f` prints. A double below 10⁶ has at least ten.
const DECIMALS: usize = 6;
const SMALL: f64 = 1e6;

/// How long the numbers of a program are.
#[derive(Default)]
struct Longest {
    digits: usize,
    decimals: usize,
    is_double: bool,
    count: usize,
    small: usize,
}

/// Whether all numbers that should have more digits have few.
pub(super) fn lost(answered: &[Answered], precision: Precision) -> Option<Observation> {
    let mut longest = Longest::default();
    for of in answered {
        for (step, quantity, mode) in of.shown.all_places() {
            let values = of.shown.finite(step, quantity, mode);
            let certified = of.reference.trace.get(step, quantity, mode);
            for (shown, certified) in values.into_iter().flatten().zip(certified.into_iter().flatten()) {
                // What is zero is short in any precision, and so is what is short when it is right.
                if *shown == 0.0 || length(*certified).0 <= MOST {
                    continue;
                }
                longest.take(*shown);
                if longest.digits > MOST && longest.decimals > DECIMALS && longest.is_double {
                    return None;
                }
            }
        }
    }
    let is_finer = |than: Precision| precision.unit_roundoff() < than.unit_roundoff();
    let of_digits = |digits: usize| is_finer(Precision::DecimalDigits(u32::try_from(digits).unwrap_or(0)));
    if longest.count < LEAST {
        None
    } else if !longest.is_double && longest.digits > 1 && is_finer(Precision::Single) {
        Some(Observation::SinglePrecision)
    } else if (2..=MOST).contains(&longest.digits) && of_digits(longest.digits) {
        Some(Observation::FewDigits { digits: longest.digits })
    } else if longest.decimals <= DECIMALS && longest.small >= LEAST && of_digits(2 * DECIMALS) {
        Some(Observation::FewDecimals {
            decimals: longest.decimals,
        })
    } else {
        None
    }
}

impl Longest {
    fn take(&mut self, value: f64) {
        let (digits, decimals) = length(value);
        self.digits = self.digits.max(digits);
        self.decimals = self.decimals.max(decimals);
        #[allow(clippy::cast_possible_truncation, reason = "whether something is lost is asked")]
        let single = f64::from(value as f32);
        self.is_double |= single.to_bits() != value.to_bits();
        self.count += 1;
        self.small += usize::from(value.abs() < SMALL);
    }
}

/// The significant digits of the shortest decimal that reads as this number, and how many of them stand after the point.
fn length(value: f64) -> (usize, usize) {
    let text = format!("{value:e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let digits = mantissa.chars().filter(char::is_ascii_digit).count();
    let exponent: isize = exponent.parse().unwrap_or(0);
    let decimals = isize::try_from(digits).unwrap_or(isize::MAX) - 1 - exponent;
    (digits, usize::try_from(decimals).unwrap_or(0))
}
