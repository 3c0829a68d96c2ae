//! Running a problem: by itself, or along the values of another program.
//!
//! The judging rests on one idea. Whenever the program under test shows a value, the computed one is kept for comparison, and the run
//! continues with *the program's own* value. So each value is computed from the program's own earlier values, and where some are hidden,
//! from the last ones that it showed.

use super::invalid::Invalid;
use super::judge::Place;
use super::problem::ProblemFile;
use super::setup::Setup;
use super::trace::{Dimensions, Table, Trace};
use crate::imm::{Failure, Needs, Observer, Quantity, Step};
use crate::number::{RandomRounding, Real};
use nalgebra::Dyn;

/// What a run computed.
#[derive(Debug, Clone)]
pub struct Computed<T> {
    /// The values, each as it was computed.
    pub values: Table<Vec<T>>,
    /// The steps that could not be computed.
    pub failures: Vec<Failure>,
}

/// Keeps the computed values, and puts shown ones in their places.
struct Exchange<'a, T: Real> {
    computed: &'a mut Table<Vec<T>>,
    shown: Option<&'a Trace>,
    number: fn(f64) -> T,
    triangle: Triangle,
}

/// Which triangle of a program's covariances is read. They are symmetric up to rounding, or should be; how far the triangles are apart
/// is part of the rounding noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Triangle {
    /// The lower one, which is the one that the equations read.
    Lower,
    /// The upper one.
    Upper,
}

impl<T: Real> Observer<T, Dyn, Dyn> for Exchange<'_, T> {
    fn computed(&mut self, quantity: Quantity, j: usize, now: &mut Step<T, Dyn, Dyn>) {
        let shown = self.shown.and_then(|shown| shown.finite(now.step, quantity, j));
        let Some(values) = now.values(quantity, j) else { return };
        self.computed.set(now.step, quantity, j, values);
        if let Some(shown) = shown {
            now.replace(quantity, j, &own_values(quantity, shown, self.number, self.triangle));
        }
    }
}

/// Shown values in the number system; covariances by rows, or by columns where their upper triangle is to be read.
fn own_values<T: Real>(quantity: Quantity, shown: &[f64], number: fn(f64) -> T, triangle: Triangle) -> Vec<T> {
    let size = if quantity.is_covariance() {
        shown.len().isqrt()
    } else {
        0
    };
    let is_turned = triangle == Triangle::Upper && size > 0;
    let place = |index: usize| {
        if is_turned {
            index % size * size + index / size
        } else {
            index
        }
    };
    (0..shown.len()).map(|index| number(shown[place(index)])).collect()
}

/// Called with the record of each step as soon as it is done.
type Told<'a, T> = &'a mut dyn FnMut(Option<&Step<T, Dyn, Dyn>>);

impl<T: Real> Setup<T> {
    /// The dimensions of the problem.
    pub fn dimensions(&self) -> Dimensions {
        let m = |step: usize| self.problem_of(step).m().0;
        Dimensions {
            n: self.problem.n().0,
            r: self.problem.modes.len(),
            m: (1..=self.measurements.len()).map(m).collect(),
        }
    }

    /// Runs the problem.
    pub fn run(&self) -> Computed<T> {
        self.exchange(None, |_| T::undecided(), Triangle::Lower, &mut |_| {})
    }

    /// Runs the problem along the values that another program shows, which `number` puts into this number system.
    pub fn run_along(&self, shown: &Trace, number: fn(f64) -> T, triangle: Triangle) -> Computed<T> {
        self.exchange(Some(shown), number, triangle, &mut |_| {})
    }

    /// `done` is called with the record of each step, or with the reason why it could not be computed.
    fn exchange(&self, shown: Option<&Trace>, number: fn(f64) -> T, triangle: Triangle, done: Told<T>) -> Computed<T> {
        let mut filter = self.filter();
        let mut values = Table::empty(&self.dimensions());
        let mut failures = Vec::new();
        for (index, measurement) in self.measurements.iter().enumerate() {
            let mut exchange = Exchange {
                computed: &mut values,
                shown,
                number,
                triangle,
            };
            if !self.changes.is_empty() {
                filter.change_unchecked(self.problem_of(index + 1));
            }
            filter.truth = self.truths.get(index).cloned().flatten();
            let failure = match filter.step_observed(measurement.as_ref(), &mut exchange) {
                Ok(record) => {
                    done(Some(record));
                    continue;
                }
                Err(failure) => failure,
            };
            done(None);
            failures.push(failure);
            // The run can go on if the program shows all that the next step needs.
            let Some(shown) = shown else { break };
            let now = filter.current_mut();
            now.step = index + 1;
            if !resume(now, shown, number, self.problem.has_covariances()) {
                break;
            }
        }
        Computed { values, failures }
    }
}

/// The record of a step in doubles; none where it could not be computed.
pub(super) type Record = Option<Step<RandomRounding, Dyn, Dyn>>;

impl Setup<RandomRounding> {
    /// The records of all steps, step 0 first, with the values that another program shows in them; and what was computed.
    pub(super) fn steps_along(&self, shown: &Trace) -> (Vec<Record>, Computed<RandomRounding>) {
        let mut records = vec![Some(self.filter().current().clone())];
        let mut keep = |record: Option<&Step<_, _, _>>| records.push(record.cloned());
        let computed = self.exchange(Some(shown), RandomRounding::exact, Triangle::Lower, &mut keep);
        (records, computed)
    }
}

/// Takes over the estimates and probabilities that a program shows for a step; whether it shows them all.
fn resume<T: Real>(now: &mut Step<T, Dyn, Dyn>, shown: &Trace, number: fn(f64) -> T, keeps_covariances: bool) -> bool {
    let r = now.updated.len();
    let needed = (0..r)
        .flat_map(|j| [(Quantity::UpdatedMean, j), (Quantity::UpdatedCovariance, j)])
        .chain([(Quantity::ModeProbabilities, 0)])
        .filter(|(quantity, _)| keeps_covariances || !quantity.needs(Needs::Covariances));
    for (quantity, j) in needed {
        let Some(values) = shown.finite(now.step, quantity, j) else {
            return false;
        };
        let own: Vec<T> = values.iter().map(|&value| number(value)).collect();
        now.replace(quantity, j, &own);
    }
    true
}

/// Runs a problem in doubles; the trace, and why it stopped before the end if it did.
///
/// Example: the plain filter, beside the certified trace: every step is computed, and the digits of a double are nearly all right.
///
/// ```
/// use immaculate::oracle::case::{self, Expected};
/// use immaculate::oracle::run::run_in_doubles;
///
/// let case = case::all().unwrap().iter().find(|case| case.problem.id == "step.n4-m2.two-modes").unwrap();
/// let (trace, stopped) = run_in_doubles(&case.problem).unwrap();
/// assert_eq!(stopped, None);
/// let Expected::Trace(certified) = &case.expected else { panic!("it is no rejection") };
/// assert_eq!(trace.count(), certified.count());
/// ```
///
/// # Errors
///
/// [`Invalid`] for a problem that cannot be set up.
pub fn run_in_doubles(problem: &ProblemFile) -> Result<(Trace, Option<String>), Invalid> {
    let computed = problem.setup_in_doubles()?.run();
    Ok((
        computed.in_doubles(),
        computed.failures.first().map(ToString::to_string),
    ))
}

/// The first covariance that rounding has left without a meaning, in a sentence: it has a negative variance, which no filter may show.
pub fn lost_covariance(problem: &ProblemFile, values: &Trace) -> Option<String> {
    let negative = |place: &Place| {
        let (step, quantity, mode) = *place;
        let numbers = values.get(step, quantity, mode).filter(|_| quantity.is_covariance())?;
        let size = numbers.len().isqrt();
        let variances = numbers.iter().step_by(size + 1);
        let least = variances.copied().fold(f64::INFINITY, f64::min);
        let of_mode = if quantity.is_of_mode() {
            format!(", mode `{}`", problem.modes[mode].name)
        } else {
            String::new()
        };
        (least < 0.0).then(|| {
            format!(
                "step {step}{of_mode}, {}: a variance is {least:e}, by rounding; `--digits` gives certified numbers",
                quantity.name()
            )
        })
    };
    values.all_places().find_map(|place| negative(&place))
}

impl Computed<RandomRounding> {
    /// The values as doubles.
    pub fn in_doubles(&self) -> Trace {
        self.values
            .map(|_, values| values.iter().copied().map(RandomRounding::value).collect())
    }
}
