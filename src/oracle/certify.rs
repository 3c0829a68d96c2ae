//! Certified traces: for every number the double nearest to the exact value, proven by enclosure.
//!
//! The equations are evaluated in [`Enclosure`] on the exact inputs of the file. If the enclosure of every number is so narrow that one
//! double is the nearest to all its points, these doubles are the trace. If not, or if a comparison cannot be decided, the run is repeated
//! with twice the bits. Long runs would need thousands of bits; they are carried from step to step instead, see
//! [`ellipsoid`](super::ellipsoid).

use super::carried::Numbers;
use super::invalid::{Class, Invalid};
use super::long_run::{LONGEST_PLAIN, LongRun, MOST_BITS_CARRIED, carry, is_long};
use super::noise;
use super::problem::ProblemFile;
use super::scale::scales;
use super::setup::Setup;
use super::trace::{Table, Trace, numbers_as_json};
use crate::imm::Quantity;
use crate::number::Enclosure;
use serde_json::{Value, json};

/// The bits of the first attempt. The longest runs of the published cases need some hundreds.
pub const FIRST_BITS: u32 = 256;

/// The bits of the last attempt: a run of a thousand steps needs fewer.
pub const MOST_BITS: u32 = 1 << 15;

/// An enclosure narrower than this part of its scale is as good as a point. If zero is in it, 0 is written, and if the middle between two
/// doubles is in it, the one whose last bit is zero: problems with symmetries and short numbers have such values, and no number of
/// bits would narrow their enclosures to the point itself.
const POINT: f64 = 6.223_015_277_861_142e-61; // 2⁻²⁰⁰

/// A trace that cannot be certified.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotCertified {
    /// The problem is wrong.
    #[error("{0}")]
    Invalid(#[from] Invalid),
    /// A step could not be computed, or a value not decided, with the most bits.
    #[error("{reason}, with {bits} bits")]
    Undecided {
        /// What.
        reason: String,
        /// The number of bits.
        bits: u32,
    },
}

impl NotCertified {
    /// The same of a run that enclosures alone were tried for, since it was not carried.
    fn after(self, stopped: &str) -> Self {
        match self {
            Self::Undecided { reason, bits } => Self::Undecided {
                reason: format!("{reason}; nor can the run be carried step by step: {stopped}"),
                bits,
            },
            invalid @ Self::Invalid(_) => invalid,
        }
    }
}

/// A certified trace.
#[derive(Debug, Clone, PartialEq)]
pub struct Certified {
    /// For each number the nearest double.
    pub trace: Trace,
    /// Its natural unit.
    pub scale: Trace,
    /// Its rounding noise in double precision, in its own units.
    pub noise: Trace,
    /// The bits that were enough.
    pub bits: u32,
    /// The digits that the worst enclosure of the run still had, relative to its scale.
    pub digits: u32,
}

/// Certifies a problem's trace, with more and more bits. Runs of more than a hundred steps are carried from step to step, where that can be
/// done: their time is in proportion to the steps.
///
/// Example: A published problem; c₀ = Σᵢ pᵢ₀ μᵢ of step 1 by hand, from the numbers of the file.
///
/// ```
/// use immaculate::imm::Quantity;
/// use immaculate::oracle::{case, certify::certify};
///
/// let case = case::all().unwrap().iter().find(|case| case.problem.id == "step.n4-m2.two-modes").unwrap();
/// let certified = certify(&case.problem).unwrap();
/// let c = certified.trace.get(1, Quantity::PredictedModeProbabilities, 0).unwrap();
/// let (p, mu) = (&case.problem.transition, &case.problem.initial.mode_probabilities);
/// assert_eq!(c[0], p[0][0] * mu[0] + p[1][0] * mu[1]);
/// ```
///
/// # Errors
///
/// [`NotCertified`] when the problem is wrong or the most bits are not enough.
pub fn certify(problem: &ProblemFile) -> Result<Certified, NotCertified> {
    problem.check()?;
    if !is_long(problem) {
        return certify_from(problem, FIRST_BITS);
    }
    let mut long = LongRun::of(problem);
    match long.carry(problem)?.stopped {
        None => with_noise(problem, long.trace, long.bits, digits(long.widest)),
        Some(stopped) => certify_from(problem, FIRST_BITS).map_err(|error| error.after(&stopped)),
    }
}

/// As [`certify`], by enclosures alone, beginning with a number of bits.
///
/// # Errors
///
/// As [`certify`].
pub fn certify_from(problem: &ProblemFile, first_bits: u32) -> Result<Certified, NotCertified> {
    problem.check()?;
    with_more_and_more_bits(first_bits, |bits| certify_with(problem, bits)).map(|(certified, _)| certified)
}

/// The bits with which enclosures alone go as far as they do, for runs that cannot be carried: some ten seconds.
const BITS_OF_A_PREFIX: u32 = 2048;

/// The steps of a longer run that are certified where nobody asked for all: some minutes.
const MOST_STEPS_CARRIED: usize = 10_000;

/// The expected trace of a problem of any length: certified for the steps that are returned, in doubles for those after them.
///
/// A run of more than a hundred steps is carried from step to step, up to 10 000. Where that does not lead to the end, and for shorter
/// runs, twice as many steps are tried as before, until some do not certify with 2048 bits. No value of the doubles is proven; their
/// rounding noise, by which they are judged, is measured as that of the others is.
///
/// # Errors
///
/// [`Invalid`] for a problem that is wrong, or whose run in doubles stops before the end.
pub fn certified_as_far_as_it_goes(problem: &ProblemFile) -> Result<(Trace, usize), Invalid> {
    problem.check()?;
    let in_doubles = problem.setup_in_doubles()?.run();
    if let Some(failure) = in_doubles.failures.first() {
        return Err(Invalid::new(
            Class::NotFinite,
            "problem",
            format!("cannot be run to its end: {failure}"),
        ));
    }
    let mut trace = in_doubles.in_doubles();
    let all = problem.measurements.len();
    let (mut certified, mut bits) = (0, FIRST_BITS);
    if is_long(problem) {
        let mut beginning = problem.clone();
        beginning.measurements.truncate(MOST_STEPS_CARRIED);
        let mut long = LongRun {
            trace,
            ..LongRun::of(&beginning)
        };
        certified = long.carry(&beginning)?.steps;
        trace = long.trace;
        if certified > LONGEST_PLAIN {
            return Ok((trace, certified));
        }
    }
    while certified < all && bits <= BITS_OF_A_PREFIX {
        let steps = (2 * certified).max(8).min(all);
        let mut beginning = problem.clone();
        beginning.measurements.truncate(steps);
        let attempt = Enclosure::with_precision(bits, || {
            let undecided = |reason| NotCertified::Undecided { reason, bits };
            nearest(&beginning, &enclosed(&beginning, undecided)?).map_err(undecided)
        });
        match attempt {
            Ok((values, _)) => {
                for (step, quantity, mode) in values.all_places() {
                    if let Some(numbers) = values.get(step, quantity, mode) {
                        trace.set(step, quantity, mode, numbers.clone());
                    }
                }
                certified = steps;
            }
            Err(NotCertified::Undecided { .. }) => bits *= 2,
            Err(NotCertified::Invalid(invalid)) => return Err(invalid),
        }
    }
    Ok((trace, certified))
}

/// Tries with a number of bits, then with twice as many, until an attempt is decided; its result, and the bits.
fn with_more_and_more_bits<V>(
    first_bits: u32,
    mut attempt: impl FnMut(u32) -> Result<V, NotCertified>,
) -> Result<(V, u32), NotCertified> {
    let mut bits = first_bits;
    loop {
        match attempt(bits) {
            Ok(found) => return Ok((found, bits)),
            Err(NotCertified::Undecided { .. }) if bits < MOST_BITS => bits *= 2,
            Err(error) => return Err(error),
        }
    }
}

/// The values of a problem as enclosures, in the precision of the scope.
fn enclosed(
    problem: &ProblemFile,
    undecided: impl Fn(String) -> NotCertified,
) -> Result<Table<Vec<Enclosure>>, NotCertified> {
    let setup: Setup<Enclosure> = problem.setup(Enclosure::exact)?;
    let computed = setup.run();
    match computed.failures.first() {
        Some(failure) => Err(undecided(failure.to_string())),
        None => Ok(computed.values),
    }
}

/// One attempt with a number of bits.
fn certify_with(problem: &ProblemFile, bits: u32) -> Result<Certified, NotCertified> {
    let undecided = |reason: String| NotCertified::Undecided { reason, bits };
    let (trace, digits) = Enclosure::with_precision(bits, || {
        nearest(problem, &enclosed(problem, undecided)?).map_err(undecided)
    })?;
    with_noise(problem, trace, bits, digits)
}

/// A certified trace with its scale and noise.
fn with_noise(problem: &ProblemFile, trace: Trace, bits: u32, digits: u32) -> Result<Certified, NotCertified> {
    let scale = scales(problem, &trace);
    let unit_roundoff = f64::EPSILON / 2.0;
    let noise = noise::spread(&trace, unit_roundoff, noise::RUNS, |_| {
        Ok(problem.setup_perturbed()?.run())
    })?;
    Ok(Certified {
        trace,
        scale,
        noise,
        bits,
        digits,
    })
}

/// The doubles nearest to enclosures, and the digits of the widest one; what is not measured is left out.
///
/// # Errors
///
/// The first value that is not narrow enough.
fn nearest(problem: &ProblemFile, values: &Table<Vec<Enclosure>>) -> Result<(Trace, u32), String> {
    let mut trace = Trace::empty(&values.dimensions);
    let widest = nearest_into(&mut trace, problem, values, 0)?;
    Ok((trace, digits(widest)))
}

/// Sets the doubles nearest to enclosures in a trace, a number of steps later than they stand in their table; the width of the widest
/// enclosure relative to its scale.
pub(super) fn nearest_into(
    trace: &mut Trace,
    problem: &ProblemFile,
    values: &Table<Vec<Enclosure>>,
    later: usize,
) -> Result<f64, String> {
    let about = about(problem, values);
    let (mut widest, mut found) = (0.0_f64, Vec::new());
    for (step, quantity, mode) in values.all_places() {
        let Some(numbers) = values.get(step, quantity, mode) else {
            continue;
        };
        let mut doubles = Vec::with_capacity(numbers.len());
        for (index, number) in numbers.iter().enumerate() {
            let scale = about.get(step, quantity, mode).map_or(1.0, |scales| scales[index]);
            widest = widest.max(number.width() / scale);
            doubles.push(nearest_double(number, scale).ok_or_else(|| {
                let (name, step) = (quantity.name(), step + later);
                format!("step {step}, mode {mode}: number {index} of {name} is not decided")
            })?);
        }
        found.push(((step + later, quantity, mode), doubles));
    }
    for ((step, quantity, mode), doubles) in found {
        trace.set(step, quantity, mode, doubles);
    }
    Ok(widest)
}

/// The digits that are left of a width relative to its scale.
fn digits(widest: f64) -> u32 {
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and 400 000"
    )]
    let digits = (-libm::log10(widest.max(f64::MIN_POSITIVE))).max(0.0) as u32;
    digits
}

/// The scales of enclosures: their middles serve, since scales need two digits.
fn about(problem: &ProblemFile, values: &Table<Vec<Enclosure>>) -> Trace {
    let middles = values.map(|_, numbers| numbers.iter().map(Enclosure::middle).collect());
    scales(problem, &middles)
}

/// The double nearest to every number of an enclosure, or to the point that it is as good as.
fn nearest_double(number: &Enclosure, scale: f64) -> Option<f64> {
    if is_as_good_as_zero(number, scale) {
        return Some(0.0);
    }
    if let Some(double) = number.to_f64() {
        return Some(double);
    }
    let (below, above) = (number.lower().to_f64(), number.upper().to_f64());
    let is_tie = number.width() <= POINT * scale && below.next_up().to_bits() == above.to_bits();
    is_tie.then_some(if below.to_bits() % 2 == 0 { below } else { above })
}

/// Whether an enclosure holds zero and is as good as a point.
fn is_as_good_as_zero(number: &Enclosure, scale: f64) -> bool {
    number.middle().abs() <= POINT * scale && number.width() <= POINT * scale
}

impl Certified {
    /// The trace file.
    pub fn to_json(&self, id: &str) -> Value {
        json!({
            "format": super::trace::FORMAT,
            "id": id,
            "steps": self.trace.steps_as_json(),
            "scale": self.scale.to_json(|place, values| {
                let short: Vec<f64> = values.iter().map(|value| rounded(*value, 3)).collect();
                numbers_as_json(place, &self.scale.dimensions, &short)
            }),
            "noise": self.noise_by_quantity().to_json(|_, noise| json!(noise)),
        })
    }

    /// The noise of each quantity in units of its scale: the greatest of its numbers', and not less than a unit roundoff.
    pub fn noise_by_quantity(&self) -> Table<f64> {
        self.noise.map(|(step, quantity, mode), spread| {
            let scale = self.scale.get(step, quantity, mode);
            let relative = spread
                .iter()
                .enumerate()
                .map(|(index, spread)| spread / scale.map_or(1.0, |scale| scale[index]));
            rounded(relative.fold(f64::EPSILON / 2.0, f64::max), 2)
        })
    }
}

/// The long CSV of a published trace, with the scale and the noise of each number in two more columns.
pub fn long_csv(problem: &ProblemFile, trace: &Trace, trace_text: &str) -> String {
    // The noise stands in the file; the scale follows from the trace.
    let scale = scales(problem, trace);
    let file: Value = serde_json::from_str(trace_text).unwrap_or_default();
    super::csv::write(&problem.id, trace, ",scale,noise", |(step, quantity, mode), index| {
        let scale = scale.get(step, quantity, mode).map_or(1.0, |scale| scale[index]);
        let mut noise = &file["noise"][step - 1];
        if quantity.is_of_mode() {
            noise = &noise["modes"][mode];
        }
        for key in quantity.name().split('.') {
            noise = &noise[key];
        }
        format!(",{:?},{noise}", rounded(scale, 3))
    })
}

/// A number rounded to some significant digits.
fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

/// Certified decimals of a problem's trace: `digits` significant ones for every number.
///
/// # Errors
///
/// As [`certify`].
pub fn certified_decimals(problem: &ProblemFile, digits: u32) -> Result<(Table<Vec<String>>, u32), NotCertified> {
    problem.check()?;
    // 3.33 bits a digit, and some for what is lost on the way.
    let bits = digits.saturating_mul(4);
    let (mut decimals, mut stopped) = (Table::empty(&problem.dimensions()), None);
    if is_long(problem) && bits <= MOST_BITS_CARRIED {
        let carried = carry(problem, FIRST_BITS.max(bits), &mut |step, numbers| {
            decimals_into(&mut decimals, problem, numbers, digits, step - 1)
        })?;
        if carried.stopped.is_none() {
            return Ok((decimals, carried.bits));
        }
        stopped = carried.stopped;
    }
    let plain = with_more_and_more_bits(FIRST_BITS.max(bits.next_power_of_two()), |bits| {
        let undecided = |reason: String| NotCertified::Undecided { reason, bits };
        Enclosure::with_precision(bits, || {
            let values = enclosed(problem, undecided)?;
            decimals_into(&mut decimals, problem, &values, digits, 0).map_err(undecided)
        })
    });
    match (plain, stopped) {
        (Ok(((), bits)), _) => Ok((decimals, bits)),
        (Err(error), Some(stopped)) => Err(error.after(&stopped)),
        (Err(error), None) => Err(error),
    }
}

/// Sets certified decimals of enclosures in a table, a number of steps later than they stand in their own.
fn decimals_into(
    decimals: &mut Table<Vec<String>>,
    problem: &ProblemFile,
    values: &Numbers,
    digits: u32,
    later: usize,
) -> Result<(), String> {
    let about = about(problem, values);
    for (step, quantity, mode) in values.all_places() {
        let Some(numbers) = values.get(step, quantity, mode) else {
            continue;
        };
        let scale = about.get(step, quantity, mode);
        let texts = numbers.iter().enumerate().map(|(index, number)| {
            if is_as_good_as_zero(number, scale.map_or(1.0, |scale| scale[index])) {
                Some("0".to_owned())
            } else {
                number.to_decimal(digits)
            }
        });
        let texts: Option<Vec<String>> = texts.collect();
        let step = step + later;
        let place = || undecided_place(step, quantity, mode);
        decimals.set(step, quantity, mode, texts.ok_or_else(place)?);
    }
    Ok(())
}

fn undecided_place(step: usize, quantity: Quantity, mode: usize) -> String {
    format!(
        "step {step}, mode {mode}: {} is not decided to this many digits",
        quantity.name()
    )
}
