//! The simulated truth: what a problem's own model says that a target does and a sensor sees.
//!
//! Each run has its own stream of random numbers. All filters of a run see the same measurements.
//!
//! ```text
//! mode at step 0 ~ μ(0)     x(0) ~ N(x̂ⁱ(0), Pⁱ(0))
//! mode at step k ~ row of the chain of the mode before,  x(k) = f(x(k−1)) + w,  z(k) = h(x(k)) + v,  (w, v) ~ N(0, [Q M; Mᵀ R])
//! ```
//!
//! A step of the file without a measurement has none here; its sensor, length and changes are kept.

use super::NotCompared;
use crate::imm::state_conversion::Reader;
use crate::imm::{Problem, angles};
use crate::model::PolarComponent;
use crate::model::angle::wrap;
use crate::number::{RandomRounding, Real};
use crate::oracle::invalid::Invalid;
use crate::oracle::problem::ProblemFile;
use crate::oracle::setup::Setup;
use crate::paper::monte_carlo::Generator;
use nalgebra::{DMatrix, DVector, Dyn};
use rayon::prelude::*;
use std::collections::BTreeMap;

type Double = RandomRounding;
type State = DVector<Double>;

/// What is true and what is seen in one run.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedRun {
    /// The mode of steps 1, 2, …
    pub modes: Vec<usize>,
    /// The state of steps 1, 2, … in the common state of the problem.
    pub states: Vec<Vec<f64>>,
    /// The measurements of steps 1, 2, …; none at a missed detection.
    pub measurements: Vec<Option<Vec<f64>>>,
}

/// A problem's model, from which runs are drawn.
#[derive(Debug)]
pub struct TruthModel {
    setup: Setup<Double>,
    /// Square roots of the initial covariances.
    initial: Vec<DMatrix<f64>>,
    /// Square roots of the noises of each mode and the sensor.
    noises: Vec<DMatrix<f64>>,
    /// The same of the steps in which the problem is another.
    other_noises: BTreeMap<usize, Vec<DMatrix<f64>>>,
    /// Whether each step has a measurement.
    detections: Vec<bool>,
}

impl TruthModel {
    /// The model of a problem.
    ///
    /// # Errors
    ///
    /// [`Invalid`] for a problem that cannot be set up; a sentence for a covariance that is not positive semidefinite.
    pub fn new(problem: &ProblemFile) -> Result<Self, NotCompared> {
        let setup = problem.setup_in_doubles().map_err(NotCompared::Problem)?;
        let name = |j: usize| format!("mode `{}`", problem.modes[j].name);
        let mut initial = Vec::with_capacity(setup.initial.modes.len());
        for (j, estimate) in setup.initial.modes.iter().enumerate() {
            let root = square_root(&estimate.covariance.map(Double::value));
            initial.push(root.ok_or_else(|| NotCompared::covariance(format!("the initial estimate of {}", name(j))))?);
        }
        let roots_of = |of_step: &Problem<Double, Dyn, Dyn>, when: &str| {
            let root = |j: usize| {
                let place = || format!("the noises of {} and of the sensor{when}", name(j));
                square_root(&joint_noise(of_step, j)).ok_or_else(|| NotCompared::covariance(place()))
            };
            (0..of_step.modes.len()).map(root).collect::<Result<Vec<_>, _>>()
        };
        let noises = roots_of(&setup.problem, "")?;
        let mut other_noises = BTreeMap::new();
        for (step, of_step) in &setup.changes {
            other_noises.insert(*step, roots_of(of_step, &format!(" in step {step}"))?);
        }
        Ok(Self {
            detections: setup.measurements.iter().map(Option::is_some).collect(),
            setup,
            initial,
            noises,
            other_noises,
        })
    }

    /// Runs 0, 1, …, `count` − 1 of a seed.
    ///
    /// # Errors
    ///
    /// Where the model gives a state or a measurement that no filter takes.
    pub fn runs(&self, seed: u64, count: usize) -> Result<Vec<SimulatedRun>, NotCompared> {
        (0..count).into_par_iter().map(|run| self.run(seed, run)).collect()
    }

    /// A run, counted from 0.
    ///
    /// # Errors
    ///
    /// As for [`TruthModel::runs`].
    pub fn run(&self, seed: u64, run: usize) -> Result<SimulatedRun, NotCompared> {
        let mut generator = Generator::of_run(seed, run);
        let probabilities = &self.setup.initial.mode_probabilities;
        let mut mode = drawn_index(probabilities, generator.uniform());
        let mut state = self.setup.initial.modes[mode].mean.clone();
        add_drawn(
            &mut state,
            &self.initial[mode],
            0,
            &normals(&mut generator, self.initial[mode].ncols()),
        );
        let mut drawn = SimulatedRun {
            modes: Vec::with_capacity(self.detections.len()),
            states: Vec::with_capacity(self.detections.len()),
            measurements: Vec::with_capacity(self.detections.len()),
        };
        for (k, is_detected) in self.detections.iter().enumerate() {
            let (step, problem) = (k + 1, self.setup.problem_of(k + 1));
            let wrong = |reason: String| NotCompared::Truth {
                run: run + 1,
                step,
                reason,
            };
            let before = mode;
            mode = drawn_index(&problem.chain[before], generator.uniform());
            state = self.read(problem, before, mode, &state, &mut generator)?;
            state = problem.modes[mode].motion.of(&state);
            let root = &self.other_noises.get(&step).unwrap_or(&self.noises)[mode];
            let noise = normals(&mut generator, root.ncols());
            add_drawn(&mut state, root, 0, &noise);
            state = angles::wrapped(problem.angles_of(Reader::Mode(mode)), state);
            if !state.iter().all(|entry| entry.value().is_finite()) {
                let name = &problem.modes[mode].name;
                return Err(wrong(format!(
                    "the motion of mode `{name}` leads to a state that is not finite"
                )));
            }
            let common = problem.in_common_state(mode, &state).into_owned();
            let mut z = problem.sensor.of(&common);
            add_drawn(&mut z, root, state.len(), &noise);
            drawn.modes.push(mode);
            drawn.states.push(common.iter().map(|entry| entry.value()).collect());
            let z = if *is_detected {
                Some(measured(problem, &z).map_err(wrong)?)
            } else {
                None
            };
            drawn.measurements.push(z);
        }
        Ok(drawn)
    }

    /// The state in which the next mode moves it: x_j = c(x_i) + a, a ~ N(0, A), where modes have states of their own.
    fn read(
        &self,
        problem: &Problem<Double, Dyn, Dyn>,
        before: usize,
        mode: usize,
        state: &State,
        generator: &mut Generator,
    ) -> Result<State, NotCompared> {
        let Some(conversion) = problem
            .state_conversion(before, Reader::Mode(mode))
            .filter(|_| before != mode)
        else {
            return Ok(state.clone());
        };
        let name = &self.setup.problem.modes[before].name;
        let root = square_root(&conversion.added.map(Double::value))
            .ok_or_else(|| NotCompared::covariance(format!("what a conversion from mode `{name}` adds")))?;
        let mut read = conversion.map.of(state);
        add_drawn(&mut read, &root, 0, &normals(generator, root.ncols()));
        Ok(read)
    }
}

/// A measurement as a sensor gives it, its angles within a turn.
fn measured(problem: &Problem<Double, Dyn, Dyn>, z: &State) -> Result<Vec<f64>, String> {
    let mut measured = Vec::with_capacity(z.len());
    for (row, value) in z.iter().enumerate() {
        let value = if problem.sensor.is_angle(row) {
            wrap(*value)
        } else {
            *value
        };
        if !value.value().is_finite() {
            return Err(format!("entry {row} of the measurement is not finite"));
        }
        if problem.sensor.reports(row) == Some(PolarComponent::Range) && value.value() < 0.0 {
            return Err(format!(
                "a range of {value} is measured: its noise is as large as the range"
            ));
        }
        measured.push(value.value());
    }
    Ok(measured)
}

/// The covariance of the noises of a mode and of the sensor together.
fn joint_noise(problem: &Problem<Double, Dyn, Dyn>, j: usize) -> DMatrix<f64> {
    let (q, r) = (&problem.modes[j].noise, &problem.measurement_noise);
    let (n, m) = (q.nrows(), r.nrows());
    let cross = problem.filter(j).noise_cross_covariance.as_ref();
    DMatrix::from_fn(n + m, n + m, |row, column| {
        let (high, low) = (row.max(column), row.min(column));
        match (high < n, low < n) {
            (true, _) => q[(high, low)].value(),
            (false, false) => r[(high - n, low - n)].value(),
            (false, true) => cross.map_or(0.0, |cross| cross[(low, high - n)].value()),
        }
    })
}

/// A matrix S with S Sᵀ = P, for a covariance that may be singular; `None` where P is no covariance.
///
/// Source: Golub and Van Loan, Matrix Computations, 4th edition, section 4.2.8: the Cholesky factor, the greatest pivot first. A pivot
/// counts as zero below N · 2⁻⁵⁰ of its diagonal entry, as in [`crate::matrix::is_positive_semidefinite`].
///
/// Example: an acceleration of variance 4 over a second has one random number in it, not two.
///
/// ```
/// use immaculate::compare::truth::square_root;
/// use nalgebra::dmatrix;
///
/// let root = square_root(&dmatrix![1.0, 2.0; 2.0, 4.0]).unwrap();
/// assert_eq!(root, dmatrix![1.0, 0.0; 2.0, 0.0]);
/// assert_eq!(square_root(&dmatrix![1.0, 2.0; 2.0, 1.0]), None);
/// ```
pub fn square_root(covariance: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    if !crate::matrix::is_positive_semidefinite(covariance) {
        return None;
    }
    let n = covariance.nrows();
    let negligible = n as f64 * f64::EPSILON * 4.0;
    let mut root = DMatrix::zeros(n, n);
    let mut rest = covariance.clone();
    let mut left: Vec<usize> = (0..n).collect();
    let mut columns = 0;
    while !left.is_empty() {
        // The part of its variance that is left of each entry: units do not matter.
        let part = |i: usize| {
            if covariance[(i, i)] > 0.0 {
                rest[(i, i)] / covariance[(i, i)]
            } else {
                0.0
            }
        };
        let mut place = 0;
        for candidate in 1..left.len() {
            if part(left[candidate]) > part(left[place]) {
                place = candidate;
            }
        }
        let j = left.remove(place);
        if part(j) <= negligible {
            break;
        }
        let pivot = Real::sqrt(&rest[(j, j)]);
        root[(j, columns)] = pivot;
        for &i in &left {
            root[(i, columns)] = rest[(i, j)] / pivot;
        }
        for &i in &left {
            for &k in &left {
                rest[(i, k)] -= root[(i, columns)] * root[(k, columns)];
            }
        }
        columns += 1;
    }
    Some(root)
}

/// The index that a uniform number in (0, 1] selects, by probabilities; never one whose probability is zero.
fn drawn_index(probabilities: &[Double], uniform: f64) -> usize {
    let mut sum = 0.0;
    let mut last = 0;
    for (index, probability) in probabilities.iter().enumerate() {
        if probability.value() > 0.0 {
            sum += probability.value();
            last = index;
            if uniform <= sum {
                return index;
            }
        }
    }
    // Probabilities sum to one only up to rounding.
    last
}

fn normals(generator: &mut Generator, count: usize) -> Vec<f64> {
    (0..count).map(|_| generator.standard_normal()).collect()
}

/// Adds the rows of a square root from one on, times standard Gaussian numbers. The order of the sums is fixed, so the bits are, too.
fn add_drawn(vector: &mut State, root: &DMatrix<f64>, first: usize, normals: &[f64]) {
    for entry in 0..vector.len() {
        let mut sum = 0.0;
        for (column, normal) in normals.iter().enumerate() {
            sum += root[(first + entry, column)] * normal;
        }
        vector[entry] += Double::exact(sum);
    }
}

/// The problem with a number of steps: the file's own, from the first one on again where there are not as many. What was measured is
/// replaced in every run, and a truth that the file states is another.
///
/// # Errors
///
/// [`Invalid`] where the problem with these steps is refused.
pub fn with_steps(problem: &ProblemFile, steps: usize) -> Result<ProblemFile, Invalid> {
    let mut planned = problem.clone();
    let plan = problem.measurements.iter().cycle().take(steps).enumerate();
    planned.measurements = plan
        .map(|(k, entry)| {
            let mut entry = entry.clone();
            (entry.step, entry.truth) = (k + 1, None);
            entry
        })
        .collect();
    planned.check()?;
    Ok(planned)
}
