//! Certified runs of any length: what a step passes on is carried as an exact midpoint and a set of errors.
//!
//! Enclosures alone lose some ten bits a step, so that a run of twice the length needs twice the bits. Most of that is no loss of the
//! filter, which forgets, but of the evaluation, which does not know that errors of one step and of the next are of the same numbers. So
//! after each step the numbers that it passes on,
//!
//! ```text
//! s = (updated means, lower triangles of the updated covariances, ln μⱼ),
//! ```
//!
//! are known to lie in m + {A v : |v| ≤ e}, with a midpoint m of as many bits as are computed with, exactly. The next step s′ = f(s) is
//! evaluated three times, by the very equations of the cycle:
//!
//! | on | from | gives |
//! |---|---|---|
//! | enclosures | the box around the set | every number of the trace, enclosed |
//! | enclosures | m alone | the next midpoint, and what was rounded: f(m) = m′ + w |
//! | gradients of intervals | the box around the set | J, the derivatives of f everywhere in the box |
//!
//! By the mean-value form f(s) = m′ + w + J (s − m) with some J of the intervals, and [`ellipsoid`](super::ellipsoid) gives the next set.
//! The mean-value form asks for a box on which f has derivatives. It does where the third evaluation ends with nothing undecided: see
//! [`Gradient`].
//!
//! An entry that nothing of the set moves, and that is exact, is left out of the set: rows of zeros in the covariance of an embedded
//! state, for one, stay exactly zero. A mode that cannot be reached has the probability zero and no logarithm; it stays so until the
//! chain reaches it.

use super::ellipsoid::Ellipsoid;
use super::invalid::Invalid;
use super::problem::ProblemFile;
use super::setup::Setup;
use super::trace::{Dimensions, Table};
use crate::imm::{Equations, Imm, Observer, Quantity, Step};
use crate::matrix::cholesky;
use crate::number::{Enclosure, Gradient, Interval, Real};
use nalgebra::{DMatrix, DVector, Dyn};

/// The numbers of one step, enclosed.
pub(super) type Numbers = Table<Vec<Enclosure>>;

/// Why a run was not carried to its end.
#[derive(Debug)]
pub(super) enum Stopped {
    /// The problem is wrong.
    Invalid(Invalid),
    /// A value of a step was not decided: more bits may help.
    Undecided(String),
    /// The set of errors could not be carried over a step: more bits will not help.
    Lost(String),
}

/// What a step passes on.
struct State<T> {
    /// Means and lower triangles, mode by mode; then ln μⱼ, zero for a mode that cannot be reached.
    entries: Vec<T>,
    /// Whether μⱼ is not exactly zero.
    reachable: Vec<bool>,
    /// The entries of a mean.
    n: usize,
}

/// What is known of it after a step.
struct Carried {
    /// m: points.
    middle: State<Enclosure>,
    /// The entries that have errors.
    live: Vec<usize>,
    /// Their errors; none where no entry has any.
    errors: Option<Ellipsoid>,
}

/// A problem in one number system that is run a step at a time.
struct Runner<T: Real> {
    setup: Setup<T>,
    filter: Imm<T, Dyn, Dyn>,
}

/// Runs a problem with a number of bits; `seen` is given the numbers of each step, counted from 1, and may stop the run.
///
/// # Errors
///
/// [`Stopped`] where the run was not carried to its end.
pub(super) fn walk(
    problem: &ProblemFile,
    bits: u32,
    seen: &mut dyn FnMut(usize, &Numbers) -> Result<(), String>,
) -> Result<(), Stopped> {
    if !problem.declared.is_empty() {
        let reason = "a run by a convention that is not the papers' is certified by enclosures alone";
        return Err(Stopped::Lost(reason.to_owned()));
    }
    Enclosure::with_precision(bits, || {
        let setup = problem.setup(Enclosure::exact).map_err(Stopped::Invalid)?;
        let mut middle = Runner::of(passing_on(setup.clone()));
        let mut whole = Runner::of(setup);
        let mut derivatives = Derivatives::of(problem).map_err(Stopped::Invalid)?;
        let mut carried: Option<Carried> = None;
        for index in 0..whole.setup.measurements.len() {
            let hull = carried.as_ref().map(Carried::hull);
            let mut numbers = Table::empty(&whole.dimensions_of(index + 1));
            whole
                .advance(index, hull.as_ref(), &mut numbers)
                .map_err(Stopped::Undecided)?;
            seen(index + 1, &numbers).map_err(Stopped::Undecided)?;
            let next = match carried.as_ref().zip(hull.as_ref()) {
                None => Carried::first(&whole.state()),
                Some((before, hull)) => {
                    let advanced = middle.advance(index, Some(&before.middle), &mut ());
                    advanced.map_err(Stopped::Undecided)?;
                    derivatives.carry(index, before, hull, &middle.state())
                }
            };
            carried = Some(next.map_err(|reason| Stopped::Lost(format!("step {}: {reason}", index + 1)))?);
        }
        Ok(())
    })
}

/// The evaluations that give derivatives: in doubles, and with more digits where these are too few.
struct Derivatives<'a> {
    problem: &'a ProblemFile,
    quick: Runner<Gradient<Interval>>,
    fine: Option<Runner<Gradient<Enclosure>>>,
}

/// The bits of the fine derivatives.
const FINE_BITS: u32 = 128;

/// Derivatives that make the set grow by more than this factor have too few digits: what is left is rounding.
const MOST_GROWTH: f64 = 1.25;

impl<'a> Derivatives<'a> {
    fn of(problem: &'a ProblemFile) -> Result<Self, Invalid> {
        let quick = problem.setup_undeclared(|value| Gradient::constant(Interval::exact(value)))?;
        Ok(Self {
            problem,
            quick: Runner::of(passing_on(quick)),
            fine: None,
        })
    }

    /// The set after a step, whose midpoint came out as `state`.
    fn carry(
        &mut self,
        index: usize,
        before: &Carried,
        hull: &State<Enclosure>,
        state: &State<Enclosure>,
    ) -> Result<Carried, String> {
        let quick = self
            .quick
            .slopes(index, before, hull, Interval::containing, |slope| *slope);
        let quick = quick.and_then(|slopes| before.next(state, &slopes));
        if quick
            .as_ref()
            .is_ok_and(|next| next.size() <= MOST_GROWTH * before.size())
        {
            return quick;
        }
        let fine = Enclosure::with_precision(FINE_BITS, || {
            let runner = match &mut self.fine {
                Some(runner) => runner,
                none => {
                    let setup = self
                        .problem
                        .setup_undeclared(|value| Gradient::constant(Enclosure::exact(value)));
                    none.insert(Runner::of(passing_on(setup.map_err(|invalid| invalid.to_string())?)))
                }
            };
            runner.slopes(index, before, hull, Enclosure::clone, Interval::containing)
        });
        let fine = fine.and_then(|slopes| before.next(state, &slopes));
        match (quick, fine) {
            (Ok(quick), Ok(fine)) => Ok(if fine.size() < quick.size() { fine } else { quick }),
            (_, Ok(fine)) => Ok(fine),
            (quick, Err(_)) => quick,
        }
    }
}

/// The derivatives of what a step passes on.
struct Slopes {
    /// One row an entry; none where the entry is constant over the whole set.
    rows: Vec<Option<Vec<Interval>>>,
    reachable: Vec<bool>,
}

impl<T: Real> Runner<Gradient<T>> {
    /// The derivatives of the next state over a box, by the entries that have errors.
    fn slopes(
        &mut self,
        index: usize,
        before: &Carried,
        hull: &State<Enclosure>,
        number: fn(&Enclosure) -> T,
        interval: fn(&T) -> Interval,
    ) -> Result<Slopes, String> {
        let live = &before.live;
        let variable = |(place, entry): (usize, &Enclosure)| {
            let value = number(entry);
            match live.iter().position(|&other| other == place) {
                Some(direction) => Gradient::variable(value, direction, live.len()),
                None => Gradient::constant(value),
            }
        };
        let variables = State {
            entries: hull.entries.iter().enumerate().map(variable).collect(),
            reachable: hull.reachable.clone(),
            n: hull.n,
        };
        self.advance(index, Some(&variables), &mut ())?;
        let State { entries, reachable, .. } = self.state();
        if !entries.iter().all(|entry| entry.value().is_decided()) {
            return Err("a value that is passed on is not decided".to_owned());
        }
        let row = |entry: &Gradient<T>| (!entry.is_constant()).then(|| entry.slopes().iter().map(interval).collect());
        Ok(Slopes {
            rows: entries.iter().map(row).collect(),
            reachable,
        })
    }
}

/// The problem without the values that no later step reads.
fn passing_on<T: Real>(mut setup: Setup<T>) -> Setup<T> {
    setup.equations = Equations {
        combined_prediction_mean: |problem, _, _, _| DVector::from_element(problem.n().0, T::zero()),
        combined_prediction_covariance: |problem, _, _, _| {
            DMatrix::from_element(problem.n().0, problem.n().0, T::zero())
        },
        combined_mean: |problem, _, _, _| DVector::from_element(problem.n().0, T::zero()),
        combined_covariance: |problem, _, _, _| DMatrix::from_element(problem.n().0, problem.n().0, T::zero()),
        ..setup.equations.without_consistency()
    };
    setup
}

impl Observer<Enclosure, Dyn, Dyn> for Numbers {
    fn computed(&mut self, quantity: Quantity, j: usize, now: &mut Step<Enclosure, Dyn, Dyn>) {
        if let Some(values) = now.values(quantity, j) {
            self.set(1, quantity, j, values);
        }
    }
}

impl<T: Real> Runner<T> {
    fn of(setup: Setup<T>) -> Self {
        let filter = setup.filter();
        Self { setup, filter }
    }

    /// The dimensions of one step.
    fn dimensions_of(&self, step: usize) -> Dimensions {
        Dimensions {
            m: vec![self.setup.problem_of(step).m().0],
            ..Dimensions::new(self.setup.problem.n().0, 0, self.setup.problem.modes.len(), 0)
        }
    }

    /// Runs the step after the first `index`, from what the step before passed on; from the initial estimate where that is nothing.
    fn advance(
        &mut self,
        index: usize,
        from: Option<&State<T>>,
        observer: &mut impl Observer<T, Dyn, Dyn>,
    ) -> Result<(), String> {
        if !self.setup.changes.is_empty() {
            self.filter.change_unchecked(self.setup.problem_of(index + 1));
        }
        let has_covariances = self.setup.problem.has_covariances();
        if let Some(state) = from {
            let now = self.filter.current_mut();
            now.step = index;
            state.write(now, has_covariances);
        }
        self.filter.truth = self.setup.truths.get(index).cloned().flatten();
        let measurement = self.setup.measurements[index].as_ref();
        let step = self.filter.step_observed(measurement, observer);
        step.map(|_| ()).map_err(|failure| failure.to_string())
    }

    /// What the last step passes on.
    fn state(&self) -> State<T> {
        State::read(self.filter.current(), self.setup.problem.has_covariances())
    }
}

impl<T: Real> State<T> {
    fn read(step: &Step<T, Dyn, Dyn>, has_covariances: bool) -> Self {
        let mut entries = Vec::new();
        for estimate in &step.updated {
            entries.extend(estimate.mean.iter().cloned());
            for row in 0..if has_covariances { estimate.mean.len() } else { 0 } {
                entries.extend((0..=row).map(|column| estimate.covariance[(row, column)].clone()));
            }
        }
        let reachable: Vec<bool> = step.mode_probabilities.iter().map(|mu| !mu.is_zero()).collect();
        for (probability, &is_reachable) in step.mode_probabilities.iter().zip(&reachable) {
            entries.push(if is_reachable { Real::ln(probability) } else { T::zero() });
        }
        Self {
            entries,
            reachable,
            n: step.combined.mean.len(),
        }
    }

    fn write(&self, step: &mut Step<T, Dyn, Dyn>, has_covariances: bool) {
        let mut entries = self.entries.iter().cloned();
        let mut next = || entries.next().unwrap_or_else(T::undecided);
        for estimate in &mut step.updated {
            estimate.mean.iter_mut().for_each(|entry| *entry = next());
            for row in 0..if has_covariances { estimate.mean.len() } else { 0 } {
                for column in 0..=row {
                    let entry = next();
                    estimate.covariance[(column, row)] = entry.clone();
                    estimate.covariance[(row, column)] = entry;
                }
            }
        }
        for (probability, &is_reachable) in step.mode_probabilities.iter_mut().zip(&self.reachable) {
            let logarithm = next();
            *probability = if is_reachable { Real::exp(&logarithm) } else { T::zero() };
        }
    }
}

impl Carried {
    /// After the first step, whose only errors are those of rounding.
    fn first(state: &State<Enclosure>) -> Result<Self, String> {
        Self::of(state, |_| true, |bounds, units, _| Ellipsoid::around(bounds, units))
    }

    /// After another step, from the next midpoint as it was computed, and the derivatives.
    fn next(&self, state: &State<Enclosure>, slopes: &Slopes) -> Result<Self, String> {
        let Some(errors) = &self.errors else {
            return Self::first(state);
        };
        if slopes.reachable != state.reachable {
            return Err("whether a mode can be reached is not decided".to_owned());
        }
        let jacobian = |live: &[usize]| {
            DMatrix::from_fn(live.len(), self.live.len(), |row, column| {
                match &slopes.rows[live[row]] {
                    Some(slopes) => slopes[column],
                    None => Interval::exact(0.0),
                }
            })
        };
        let is_constant = |index: usize| slopes.rows[index].is_none();
        Self::of(state, is_constant, |bounds, units, live| {
            errors.image(&jacobian(live), bounds, units)
        })
    }

    /// e, or zero where there are no errors.
    fn size(&self) -> f64 {
        self.errors.as_ref().map_or(0.0, |errors| errors.size)
    }

    /// The midpoint of a state, and the set of errors of the entries that are not exact constants: `set` makes it from the bounds of what
    /// was rounded, the units, and the places of these entries.
    fn of(
        state: &State<Enclosure>,
        is_constant: impl Fn(usize) -> bool,
        set: impl FnOnce(&[f64], &DMatrix<f64>, &[usize]) -> Option<Ellipsoid>,
    ) -> Result<Self, String> {
        if !state.entries.iter().all(|entry| entry.width().is_finite()) {
            return Err("a value that is passed on is not decided".to_owned());
        }
        let middle = State {
            entries: state.entries.iter().map(Enclosure::centre).collect(),
            reachable: state.reachable.clone(),
            n: state.n,
        };
        let rounded = |index: usize| state.entries[index].width() / 2.0;
        let live: Vec<usize> = (0..state.entries.len())
            .filter(|&index| !is_constant(index) || rounded(index) > 0.0)
            .collect();
        let errors = if live.is_empty() {
            None
        } else {
            let bounds: Vec<f64> = live.iter().map(|&index| rounded(index)).collect();
            let units = units(&middle).select_rows(&live).select_columns(&live);
            let lost =
                || "the set of errors is lost: its matrix is singular, or the derivatives are too wide".to_owned();
            Some(set(&bounds, &units, &live).ok_or_else(lost)?)
        };
        Ok(Self { middle, live, errors })
    }

    /// The box around the set.
    fn hull(&self) -> State<Enclosure> {
        let mut entries = self.middle.entries.clone();
        if let Some(errors) = &self.errors {
            for (&index, width) in self.live.iter().zip(errors.half_widths()) {
                entries[index] += Enclosure::around(0.0, width);
            }
        }
        State {
            entries,
            reachable: self.middle.reachable.clone(),
            n: self.middle.n,
        }
    }
}

/// The units in which the errors of a state are alike, T: for the mean of a mode a Cholesky factor of its covariance, for its
/// covariance products of two of its columns, for the logarithms of probabilities 1. The proof asks nothing of them.
fn units(middle: &State<Enclosure>) -> DMatrix<f64> {
    let (count, r, n) = (middle.entries.len(), middle.reachable.len(), middle.n);
    let of_mode = (count - r) / r;
    let mut units = DMatrix::identity(count, count);
    if of_mode == n {
        return units; // no covariances
    }
    for mode in 0..r {
        let first = mode * of_mode;
        let entry = |row: usize, column: usize| middle.entries[first + n + row * (row + 1) / 2 + column].middle();
        let root = root_of(&DMatrix::from_fn(n, n, |i, j| entry(i.max(j), i.min(j))));
        units.view_mut((first, first), (n, n)).copy_from(&root);
        for (i, (k, l)) in triangle(n).enumerate() {
            for (j, (a, b)) in triangle(n).enumerate() {
                let product = root[(k, a)] * root[(l, b)];
                let turned = root[(k, b)] * root[(l, a)];
                units[(first + n + i, first + n + j)] = if a == b { product } else { (product + turned) * 0.7 };
            }
        }
    }
    units
}

/// The places of a lower triangle, by rows.
fn triangle(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(|row| (0..=row).map(move |column| (row, column)))
}

/// About the Cholesky factor of a covariance, of whatever rank; entries without variance have the unit 1.
fn root_of(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let n = covariance.nrows();
    let deviation = |i: usize| {
        let variance = covariance[(i, i)];
        if variance > 0.0 { Real::sqrt(&variance) } else { 1.0 }
    };
    let correlation = DMatrix::from_fn(n, n, |i, j| {
        let ridge = if i == j { 1e-9 } else { 0.0 };
        let diagonal = if i == j && covariance[(i, i)] <= 0.0 {
            1.0
        } else {
            ridge
        };
        covariance[(i, j)] / deviation(i) / deviation(j) + diagonal
    });
    let root = cholesky(&correlation).unwrap_or_else(|_| DMatrix::identity(n, n));
    DMatrix::from_fn(n, n, |i, j| deviation(i) * root[(i, j)])
}
