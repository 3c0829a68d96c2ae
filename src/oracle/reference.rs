//! The reference of a case: the certified values, their scales, and their rounding noise.
//!
//! The noise of a value is the unit of its errors. It comes from randomly rounded runs of the same equations, in the precision of the
//! program under test.

use super::invalid::Invalid;
use super::judge::{LIMIT, Place};
use super::noise;
use super::problem::{MeasurementAt, ProblemFile};
use super::run::Triangle;
use super::scale::scales;
use super::subject::Precision;
use super::trace::Trace;
use crate::imm::Quantity;
use crate::imm::state_conversion::Reader;
use crate::number::RandomRounding;

/// What a case is judged by.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// The certified trace, or that of the declared conventions.
    pub trace: Trace,
    /// Its scales.
    pub scale: Trace,
    /// The rounding noise in the precision of the program under test.
    pub noise: Trace,
    pub(super) turns: Turns,
}

/// Which numbers of a trace are angles, which count modulo 2π.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Turns {
    /// Of the measurement of each step.
    measured: Vec<Vec<bool>>,
    /// Entries of the state of each mode.
    of_modes: Vec<Vec<usize>>,
    /// Entries of the common state.
    combined: Vec<usize>,
}

impl Turns {
    fn of(problem: &ProblemFile) -> Self {
        let sensors = problem.sensors_at();
        let of_sensors: Vec<_> = sensors.iter().map(|sensor| problem.angles_of(sensor)).collect();
        let of_step = |entry: &MeasurementAt| {
            let all = &of_sensors[problem.sensor_of(entry).unwrap_or(0)];
            match entry.rows() {
                Some(rows) => rows.iter().map(|&row| all[row]).collect(),
                None => all.clone(),
            }
        };
        Self {
            measured: problem.measurements.iter().map(of_step).collect(),
            of_modes: (0..problem.modes.len())
                .map(|mode| problem.angles_of_state(Reader::Mode(mode)))
                .collect(),
            combined: problem.angles_of_state(Reader::Common),
        }
    }

    /// Whether a number of a value is one. An innovation is wrapped and is none.
    pub(super) fn has(&self, (step, quantity, mode): Place, index: usize) -> bool {
        match quantity {
            Quantity::PredictedMeasurement => self.measured[step - 1].get(index) == Some(&true),
            Quantity::MixedMean | Quantity::PredictedMean | Quantity::UpdatedMean => {
                self.of_modes[mode].contains(&index)
            }
            Quantity::CombinedPredictionMean | Quantity::CombinedMean => self.combined.contains(&index),
            _ => false,
        }
    }
}

/// A run of a problem's equations, with variants, along shown values, or by itself.
pub(super) struct Run<'a> {
    pub(super) problem: &'a ProblemFile,
    pub(super) variants: &'a [&'a str],
    pub(super) shown: Option<&'a Trace>,
    pub(super) precision: Precision,
}

impl Run<'_> {
    /// The values in doubles, and the steps that could not be evaluated.
    pub(super) fn values(&self) -> Result<(Trace, Vec<String>), Invalid> {
        let setup = self.problem.setup_in_doubles()?.varied(self.variants);
        let computed = match self.shown {
            Some(shown) => setup.run_along(shown, RandomRounding::exact, Triangle::Lower),
            None => setup.run(),
        };
        let failures = computed.failures.iter().map(ToString::to_string).collect();
        Ok((computed.in_doubles(), failures))
    }

    /// How far a number of randomly rounded runs deviate from the values.
    pub(super) fn noise(&self, values: &Trace, runs: u64) -> Result<Trace, Invalid> {
        noise::spread(values, self.precision.unit_roundoff(), runs, |number| {
            // The inputs are perturbed, too, so each run has a problem of its own.
            let setup = self.problem.setup_perturbed()?.varied(self.variants);
            let triangle = if number % 2 == 0 {
                Triangle::Lower
            } else {
                Triangle::Upper
            };
            Ok(match self.shown {
                Some(shown) => setup.run_along(shown, RandomRounding::input, triangle),
                None => setup.run(),
            })
        })
    }
}

impl Reference {
    /// The reference of a problem under variants (declared conventions), computed in doubles; `certified` is used where there are none.
    ///
    /// # Errors
    ///
    /// [`Invalid`] for a problem that cannot be set up.
    pub fn new(
        problem: &ProblemFile,
        certified: Option<&Trace>,
        conventions: &[&str],
        precision: Precision,
    ) -> Result<Self, Invalid> {
        let run = Run {
            problem,
            variants: conventions,
            shown: None,
            precision,
        };
        let (values, _) = run.values()?;
        let noise = run.noise(&values, noise::RUNS)?;
        let trace = match certified {
            Some(certified) if conventions.is_empty() => certified.clone(),
            _ => values,
        };
        Ok(Self {
            scale: scales(problem, &trace),
            trace,
            noise,
            turns: Turns::of(problem),
        })
    }

    /// That of the first steps alone.
    #[must_use]
    pub fn beginning(&self, steps: usize) -> Self {
        Self {
            trace: self.trace.beginning(steps),
            scale: self.scale.beginning(steps),
            noise: self.noise.beginning(steps),
            turns: self.turns.clone(),
        }
    }

    /// Whether a value is of a mode that nothing leads to: its weight is zero in all that follows.
    pub(super) fn is_unused(&self, (step, quantity, mode): Place) -> bool {
        let predicted = self.trace.get(step, Quantity::PredictedModeProbabilities, 0);
        quantity.is_of_mode() && predicted.is_some_and(|probabilities| probabilities[mode] == 0.0)
    }

    /// Whether the noise of a value is as large as its unit.
    pub fn is_drowned(&self, place: Place) -> bool {
        is_drowned(place, &self.noise, &self.scale)
    }
}

/// Whether a noise is as large as the unit of its value.
pub(super) fn is_drowned((step, quantity, mode): Place, noise: &Trace, scale: &Trace) -> bool {
    let pair = noise.get(step, quantity, mode).zip(scale.get(step, quantity, mode));
    pair.is_some_and(|(noise, scale)| {
        let mut numbers = noise.iter().zip(scale);
        numbers.any(|(noise, scale)| LIMIT * noise > *scale || noise.is_nan())
    })
}
