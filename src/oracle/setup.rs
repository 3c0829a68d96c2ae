//! A problem in one number system, ready to be run, and to be varied.
//!
//! After this file the reader knows how a problem file comes into any number system, each number of the file as it is, or perturbed.

use super::bound::{Bound, Functions};
use super::invalid::{Class, Invalid};
use super::problem::{FilterFile, MeasurementFile, ModeFile, ProblemFile, Rows, UNMIXED};
use crate::filter::Filter;
use crate::filter::fixed_gain::FixedGain;
use crate::gaussian::Gaussian;
use crate::imm::{Equations, Imm, Initial, Interaction, Problem};
use crate::model::binding::STEP;
use crate::model::conversion::UnknownConversion;
use crate::model::motion::{Mode, Motion};
use crate::model::{PolarComponent, Sensor};
use crate::number::{RandomRounding, Real};
use crate::rule::{Rule, RuleName, unscented};
use nalgebra::{DMatrix, DVector, Dyn};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// All that a run needs.
#[derive(Debug, Clone)]
pub struct Setup<T: Real> {
    /// The problem.
    pub problem: Problem<T, Dyn, Dyn>,
    /// The equations.
    pub equations: Equations<T, Dyn, Dyn>,
    /// The estimate at step 0.
    pub initial: Initial<T, Dyn>,
    /// The measurements of steps 1, 2, …; none at a missed detection.
    pub measurements: Vec<Option<DVector<T>>>,
    /// The problems of the steps, counted from 1, in which it is another.
    pub changes: BTreeMap<usize, Problem<T, Dyn, Dyn>>,
}

impl<T: Real> Setup<T> {
    /// The filter at step 0. The problem is not checked: a variant's may be wrong on purpose.
    pub fn filter(&self) -> Imm<T, Dyn, Dyn> {
        Imm::unchecked(self.problem.clone(), self.equations.clone(), &self.initial)
    }
}

impl ProblemFile {
    /// The problem in a number system; `number` puts a double there.
    ///
    /// The lists must have the right lengths, which [`ProblemFile::check`] sees to.
    ///
    /// # Errors
    ///
    /// [`Invalid`] for a measurement, rule or dimension that does not exist.
    pub fn setup<T: Real>(&self, number: fn(f64) -> T) -> Result<Setup<T>, Invalid> {
        self.setup_with_rule(number, self.rule(number)?)
    }

    /// The problem in doubles: in random rounding, which outside of its scope perturbs nothing.
    ///
    /// nalgebra multiplies plain doubles of run-time shapes by code that is chosen by the processor, with other bits; these it multiplies
    /// as it does matrices with shapes in their types, so that a run has the same bits on every machine.
    ///
    /// # Errors
    ///
    /// As [`ProblemFile::setup`].
    pub fn setup_in_doubles(&self) -> Result<Setup<RandomRounding>, Invalid> {
        self.setup_with_rule(RandomRounding::exact, self.rule_in_doubles()?)
    }

    /// The problem in random rounding, every number perturbed.
    ///
    /// # Errors
    ///
    /// As [`ProblemFile::setup`].
    pub fn setup_perturbed(&self) -> Result<Setup<RandomRounding>, Invalid> {
        let perturbed = |value: &RandomRounding| RandomRounding::input(value.value());
        let rule = self.rule_in_doubles()?.map(|rule| Rule {
            points: rule
                .points
                .iter()
                .map(|point| point.map(|value| perturbed(&value)))
                .collect(),
            weights: rule.weights.iter().map(perturbed).collect(),
            covariance_weights: rule.covariance_weights.iter().map(perturbed).collect(),
        });
        self.setup_with_rule(RandomRounding::input, rule)
    }

    /// The rule in doubles. It is computed once and kept: a search asks for it thousands of times.
    fn rule_in_doubles(&self) -> Result<Option<Rule<RandomRounding, Dyn>>, Invalid> {
        if !matches!(self.filter, FilterFile::Cubature { .. } | FilterFile::Unscented { .. }) {
            return Ok(None);
        }
        let name = format!("{:?} {}", self.filter, self.state.len());
        let mut rules = RULES.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(rule) = rules.get(&name) {
            return Ok(rule.clone());
        }
        let rule = self.rule(RandomRounding::exact)?;
        if rules.len() >= RULES_KEPT {
            rules.clear();
        }
        rules.insert(name, rule.clone());
        Ok(rule)
    }

    fn setup_with_rule<T: Real>(&self, number: fn(f64) -> T, rule: Option<Rule<T, Dyn>>) -> Result<Setup<T>, Invalid> {
        let list = |values: &[f64]| -> Vec<T> { values.iter().map(|&value| number(value)).collect() };
        let functions = self.functions()?;
        let first = self.measurements.iter().position(|entry| entry.interval.is_some());
        let interval = self.parameters.get(STEP).or_else(|| self.interval(first?));
        let estimates = self.initial.modes.iter().map(|estimate| Gaussian {
            mean: vector(&estimate.mean, number),
            covariance: estimate.covariance.as_ref().map_or_else(
                || DMatrix::zeros(estimate.mean.len(), estimate.mean.len()),
                |rows| matrix(rows, number),
            ),
        });
        let problem = Problem {
            modes: self.modes_in(&functions, number, interval),
            filters: self.filters(number, rule)?,
            interaction: match &self.filter {
                FilterFile::FixedGain { mixing, .. } if mixing == UNMIXED => Interaction::Unmixed,
                _ => Interaction::Imm,
            },
            chain: self.transition.iter().map(|row| list(row)).collect(),
            sensor: self.sensor(&functions, number, interval)?,
            measurement_noise: matrix(&self.noise, number),
        };
        Ok(Setup {
            changes: self.changes(&problem, &functions, number)?,
            problem,
            equations: Equations::standard(),
            initial: Initial {
                modes: estimates.collect(),
                mode_probabilities: list(&self.initial.mode_probabilities),
            },
            measurements: self
                .measurements
                .iter()
                .map(|entry| entry.z.as_ref().map(|z| vector(z, number)))
                .collect(),
        })
    }

    /// The modes in a step of this length.
    fn modes_in<T: Real>(
        &self,
        functions: &Functions,
        number: fn(f64) -> T,
        interval: Option<f64>,
    ) -> Vec<Mode<T, Dyn>> {
        let of = |(mode, [motion, noise]): (&ModeFile, &[Option<Bound>; 2])| Mode {
            name: mode.name.clone(),
            motion: match motion {
                None => Motion::Linear(matrix(&mode.transition, number)),
                Some(bound) => bound.motion(number, interval),
            },
            noise: match noise {
                None => matrix(&mode.noise, number),
                Some(bound) => bound.noise(self.state.len(), number, interval),
            },
        };
        self.modes.iter().zip(&functions.modes).map(of).collect()
    }

    /// The problems of the steps in which it is another.
    fn changes<T: Real>(
        &self,
        problem: &Problem<T, Dyn, Dyn>,
        functions: &Functions,
        number: fn(f64) -> T,
    ) -> Result<BTreeMap<usize, Problem<T, Dyn, Dyn>>, Invalid> {
        let mut changes = BTreeMap::new();
        for entry in self.measurements.iter().filter(|entry| entry.has_changes()) {
            let mut changed = problem.clone();
            if let Some(interval) = entry.interval {
                changed.modes = self.modes_in(functions, number, Some(interval));
                changed.sensor = self.sensor(functions, number, Some(interval))?;
            }
            let motions = entry.transitions.iter().flatten();
            for (mode, rows) in changed.modes.iter_mut().zip(motions) {
                mode.motion = Motion::Linear(matrix(rows, number));
            }
            for (mode, rows) in changed.modes.iter_mut().zip(entry.noises.iter().flatten()) {
                mode.noise = matrix(rows, number);
            }
            if let Some(rows) = &entry.matrix {
                changed.sensor = Sensor::Linear(matrix(rows, number));
            }
            if let Some(rows) = &entry.noise {
                changed.measurement_noise = matrix(rows, number);
            }
            if let Some(rows) = &entry.transition {
                let list = |row: &Vec<f64>| row.iter().map(|&value| number(value)).collect();
                changed.chain = rows.iter().map(list).collect();
            }
            changes.insert(entry.step, changed);
        }
        Ok(changes)
    }

    fn sensor<T: Real>(
        &self,
        functions: &Functions,
        number: fn(f64) -> T,
        interval: Option<f64>,
    ) -> Result<Sensor<T, Dyn, Dyn>, Invalid> {
        if let Some((bound, space)) = &functions.sensor {
            return Ok(bound.sensor(space, number, interval));
        }
        match &self.measurement {
            MeasurementFile::Formulas { .. } | MeasurementFile::Model { .. } => {
                let reason = "is no function of the state";
                Err(Invalid::new(Class::Unknown, "problem.measurement", reason))
            }
            MeasurementFile::Linear { matrix: rows } => Ok(Sensor::Linear(matrix(rows, number))),
            MeasurementFile::RangeBearing {
                components,
                position,
                sensor,
            } => {
                let mut named = vec![PolarComponent::Range; components.len()];
                for (place, (component, name)) in named.iter_mut().zip(components).enumerate() {
                    *component = match name.as_str() {
                        "range" => PolarComponent::Range,
                        "bearing" => PolarComponent::Bearing,
                        _ => {
                            let field = format!("problem.measurement.components[{place}]");
                            let reason = format!("is {name:?}; a component is \"range\" or \"bearing\"");
                            return Err(Invalid::new(Class::Unknown, field, reason));
                        }
                    };
                }
                Ok(Sensor::Polar {
                    components: named,
                    position: *position,
                    location: sensor.map(number),
                })
            }
        }
    }

    /// The filters of the modes, with the rule of those that draw points.
    fn filters<T: Real>(
        &self,
        number: fn(f64) -> T,
        rule: Option<Rule<T, Dyn>>,
    ) -> Result<Vec<Filter<T, Dyn, Dyn>>, Invalid> {
        Ok(match (&self.filter, rule) {
            (_, Some(rule)) => vec![Filter::points(rule)],
            (FilterFile::Converted { conversion }, _) => {
                let unknown = |error: UnknownConversion| {
                    Invalid::new(Class::Unknown, "problem.filter.conversion", error.to_string())
                };
                vec![Filter::converted(conversion.parse().map_err(unknown)?)]
            }
            (FilterFile::FixedGain { modes, .. }, _) => {
                let given = modes.iter().map(|mode| FixedGain {
                    gain: matrix(&mode.gain, number),
                    innovation_covariance: matrix(&mode.innovation_covariance, number),
                });
                given.map(Filter::given).collect()
            }
            _ => vec![Filter::kalman()],
        })
    }

    fn rule<T: Real>(&self, number: fn(f64) -> T) -> Result<Option<Rule<T, Dyn>>, Invalid> {
        let n = Dyn(self.state.len());
        let (field, rule) = match &self.filter {
            FilterFile::Kalman {} | FilterFile::FixedGain { .. } | FilterFile::Converted { .. } => return Ok(None),
            FilterFile::Cubature { rule } => (
                "problem.filter.rule",
                rule.parse::<RuleName>().and_then(|name| name.rule_in(n)),
            ),
            FilterFile::Unscented { alpha, beta, kappa } => (
                "problem.filter",
                unscented::unscented_in(n, &number(*alpha), &number(*beta), &number(*kappa)),
            ),
        };
        rule.map(Some)
            .map_err(|error| Invalid::new(Class::Unknown, field, error.to_string()))
    }
}

/// The rules in doubles that were asked for, by filter and dimension.
static RULES: Mutex<BTreeMap<String, Option<Rule<RandomRounding, Dyn>>>> = Mutex::new(BTreeMap::new());

/// So many rules are kept; every α, β and κ is another, and a program that answers for days may see any number of them.
const RULES_KEPT: usize = 100;

/// A matrix from a list of rows.
fn matrix<T: Real>(rows: &Rows, number: fn(f64) -> T) -> DMatrix<T> {
    DMatrix::from_fn(rows.len(), rows.first().map_or(0, Vec::len), |row, column| {
        number(rows[row][column])
    })
}

/// A vector from a list.
fn vector<T: Real>(values: &[f64], number: fn(f64) -> T) -> DVector<T> {
    DVector::from_iterator(values.len(), values.iter().map(|&value| number(value)))
}
