//! Monte Carlo runs on all cores, with results that do not depend on their number.
//!
//! Each run has its own stream of one named generator, ChaCha with eight rounds, keyed by the seed. A run's numbers depend only on the
//! seed and the run. The Box-Muller transform makes Gaussian numbers with the portable functions of [`Real`], so every platform draws the
//! same.

use super::simulation::{Run, Simulation};
use crate::imm::{Imm, Step};
use crate::number::Real;
use nalgebra::{Const, SVector};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;
use std::time::Instant;

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

/// A filter along the measurements of a run, to their end or to the first step that cannot be computed; `record` keeps what is needed of a
/// step and the truth.
pub fn follow<const N: usize, const M: usize>(
    run: &mut Run,
    filter: &mut Imm<f64, Const<N>, Const<M>>,
    truth: &[SVector<f64, N>],
    measurements: &[SVector<f64, M>],
    record: fn(&mut Run, &Step<f64, Const<N>, Const<M>>, &SVector<f64, N>),
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
