//! Monte-Carlo runs: on all cores, and the same whatever their number.
//!
//! After this file the reader knows where the random numbers come from. Each run has a stream of its own of one named generator,
//! ChaCha with eight rounds, keyed by the seed; a run's numbers depend on the seed and the run alone. Gaussian numbers are made by
//! the Box-Muller transform with the portable functions of [`Real`], so that every platform draws the same.

use super::scenario::{Contestant, Draw};
use super::simulation::Simulation;
use crate::imm::{Failure, Imm, Initial, Step};
use crate::number::Real;
use crate::statistics::consistency::{nees, nis};
use nalgebra::{SVector, Vector4};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;
use std::time::{Duration, Instant};

/// A stream of random numbers.
#[derive(Debug, Clone)]
pub struct Generator(ChaCha8Rng);

impl Generator {
    /// The stream `stream` of the seed.
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Self(generator)
    }

    /// The stream of a run that has one, counted from 0.
    pub fn of_run(seed: u64, run: usize) -> Self {
        // No machine counts further than this.
        Self::new(seed, u64::try_from(run).unwrap_or(u64::MAX))
    }

    /// A number in (0, 1], uniform over the multiples of 2⁻⁵³.
    pub fn uniform(&mut self) -> f64 {
        const SPACING: f64 = 1.0 / (1_u64 << 53) as f64;
        ((self.0.next_u64() >> 11) + 1) as f64 * SPACING
    }

    /// A standard Gaussian number: √(−2 ln u) cos 2πv.
    ///
    /// Source: Box and Muller 1958.
    ///
    /// Example: the same stream of the same seed gives the same numbers on every platform: two uniform ones make a Gaussian one.
    ///
    /// ```
    /// use immaculate::number::Real;
    /// use immaculate::paper::monte_carlo::Generator;
    ///
    /// let mut uniform = Generator::new(1, 0);
    /// let (u, v) = (uniform.uniform(), uniform.uniform());
    /// let made = Real::sqrt(&(-2.0 * Real::ln(&u))) * Real::cos(&(2.0 * std::f64::consts::PI * v));
    /// assert_eq!(Generator::new(1, 0).standard_normal(), made);
    /// assert_ne!(Generator::new(1, 1).standard_normal(), made); // another run, another stream
    /// ```
    pub fn standard_normal(&mut self) -> f64 {
        let (u, v) = (self.uniform(), self.uniform());
        Real::sqrt(&(-2.0 * Real::ln(&u))) * Real::cos(&(2.0 * f64::pi() * v))
    }
}

/// Called once for each finished run of the scenario.
pub type Progress<'a> = &'a (dyn Fn() + Sync);

/// What one contestant did in one run.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Estimate minus truth, one a step; as many as were computed.
    pub errors: Vec<Vector4<f64>>,
    /// Normalised estimation errors squared.
    pub nees: Vec<f64>,
    /// Normalised innovations squared.
    pub nis: Vec<f64>,
    /// Mode probabilities.
    pub mode_probabilities: Vec<Vec<f64>>,
    /// The percentage fit error of the position, where the paper has one and the run came to its end.
    pub fit_error: Option<f64>,
    /// The step that could not be computed, if there was one.
    pub failure: Option<Failure>,
    /// Time spent in the filter's steps.
    pub time: Duration,
}

impl Run {
    /// A run that has not begun, with room for so many steps.
    pub fn with_room_for(steps: usize) -> Self {
        Self {
            errors: Vec::with_capacity(steps),
            nees: Vec::with_capacity(steps),
            nis: Vec::with_capacity(steps),
            mode_probabilities: Vec::with_capacity(steps),
            fit_error: None,
            failure: None,
            time: Duration::ZERO,
        }
    }
}

/// Runs a simulation; the result is `[run][filter]`.
pub fn run(simulation: &dyn Simulation, runs: usize, seed: u64, progress: Progress) -> Vec<Vec<Run>> {
    (0..runs)
        .into_par_iter()
        .map(|run| {
            let results = simulation.one_run(run, seed);
            progress();
            results
        })
        .collect()
}

/// One contestant on one draw, to its end or to the first step that cannot be computed.
///
/// # Panics
///
/// When the contestant's problem is not valid: the papers' problems are part of the program, and a test runs all of them.
pub fn track(contestant: &Contestant, draw: &Draw) -> Run {
    let mut run = Run::with_room_for(draw.truth.len());
    let initial = Initial {
        modes: vec![draw.initial.clone(); contestant.problem.modes.len()],
        mode_probabilities: contestant.initial_probabilities.clone(),
    };
    let mut filter = Imm::new(contestant.problem.clone(), contestant.equations, &initial)
        .expect("the scenarios' problems are part of the program");
    follow(&mut run, &mut filter, &draw.truth, &draw.measurements, record);
    run
}

/// A filter along the measurements of a run, to their end or to the first step that cannot be computed; `record` keeps what is needed of a
/// step and the truth.
pub fn follow<const N: usize, const M: usize>(
    run: &mut Run,
    filter: &mut Imm<f64, N, M>,
    truth: &[SVector<f64, N>],
    measurements: &[SVector<f64, M>],
    record: fn(&mut Run, &Step<f64, N, M>, &SVector<f64, N>),
) {
    for (truth, measurement) in truth.iter().zip(measurements) {
        let start = Instant::now();
        let step = filter.step(Some(measurement));
        run.time += start.elapsed();
        match step {
            Ok(step) => record(run, step, truth),
            Err(failure) => {
                run.failure = Some(failure);
                return;
            }
        }
    }
}

/// Keeps what the statistics need of a step.
fn record(run: &mut Run, step: &Step<f64, 4, 2>, truth: &Vector4<f64>) {
    run.errors.push(step.combined.mean - truth);
    run.nees.push(nees(&step.combined, truth));
    run.nis.extend(nis(step));
    run.mode_probabilities.push(step.mode_probabilities.clone());
}
