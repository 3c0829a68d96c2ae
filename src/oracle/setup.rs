//! A problem in one number system, ready to be run, and to be varied.
//!
//! After this file the reader knows how a problem file comes into any number system, each number of the file as it is, or perturbed.

use super::invalid::{Class, Invalid};
use super::problem::{FilterFile, MeasurementFile, ProblemFile, Rows, UNMIXED};
use crate::filter::fixed_gain::FixedGain;
use crate::gaussian::Gaussian;
use crate::imm::{Equations, Imm, Initial, Problem};
use crate::model::conversion::UnknownConversion;
use crate::model::motion::Mode;
use crate::model::{Measurement, PolarComponent};
use crate::number::{RandomRounding, Real};
use crate::rule::{Rule, RuleName, unscented};
use nalgebra::{SMatrix, SVector};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// All that a run needs.
#[derive(Debug, Clone)]
pub struct Setup<T, const N: usize, const M: usize> {
    /// The problem.
    pub problem: Problem<T, N, M>,
    /// The equations.
    pub equations: Equations<T, N, M>,
    /// The estimate at step 0.
    pub initial: Initial<T, N>,
    /// The measurements of steps 1, 2, …; none at a missed detection.
    pub measurements: Vec<Option<SVector<T, M>>>,
}

impl<T: Real, const N: usize, const M: usize> Setup<T, N, M> {
    /// The filter at step 0. The problem is not checked: a variant's may be wrong on purpose.
    pub fn filter(&self) -> Imm<T, N, M> {
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
    pub fn setup<T: Real, const N: usize, const M: usize>(
        &self,
        number: fn(f64) -> T,
    ) -> Result<Setup<T, N, M>, Invalid> {
        self.setup_with_rule(number, self.rule(number)?)
    }

    /// The problem in doubles.
    ///
    /// # Errors
    ///
    /// As [`ProblemFile::setup`].
    pub fn setup_in_doubles<const N: usize, const M: usize>(&self) -> Result<Setup<f64, N, M>, Invalid> {
        self.setup_with_rule(|value| value, self.rule_in_doubles()?)
    }

    /// The problem in random rounding, every number perturbed.
    ///
    /// # Errors
    ///
    /// As [`ProblemFile::setup`].
    pub fn setup_perturbed<const N: usize, const M: usize>(&self) -> Result<Setup<RandomRounding, N, M>, Invalid> {
        let list = |values: &[f64]| values.iter().copied().map(RandomRounding::input).collect();
        let rule = self.rule_in_doubles::<N>()?.map(|rule| Rule {
            points: rule
                .points
                .iter()
                .map(|point| point.map(RandomRounding::input))
                .collect(),
            weights: list(&rule.weights),
            covariance_weights: list(&rule.covariance_weights),
        });
        self.setup_with_rule(RandomRounding::input, rule)
    }

    /// The rule in doubles. It is computed once and kept: a search asks for it thousands of times.
    fn rule_in_doubles<const N: usize>(&self) -> Result<Option<Rule<f64, N>>, Invalid> {
        if !matches!(self.filter, FilterFile::Cubature { .. } | FilterFile::Unscented { .. }) {
            return Ok(None);
        }
        let name = format!("{:?} {N}", self.filter);
        let mut rules = RULES.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(columns) = rules.get(&name) {
            return Ok(columns.as_ref().map(of_columns));
        }
        let rule = self.rule(|value| value)?;
        if rules.len() >= RULES_KEPT {
            rules.clear();
        }
        rules.insert(name, rule.as_ref().map(as_columns));
        Ok(rule)
    }

    fn setup_with_rule<T: Real, const N: usize, const M: usize>(
        &self,
        number: fn(f64) -> T,
        rule: Option<Rule<T, N>>,
    ) -> Result<Setup<T, N, M>, Invalid> {
        let list = |values: &[f64]| -> Vec<T> { values.iter().map(|&value| number(value)).collect() };
        let modes = self.modes.iter().map(|mode| Mode {
            name: mode.name.clone(),
            transition: matrix(&mode.transition, number),
            noise: matrix(&mode.noise, number),
        });
        let estimates = self.initial.modes.iter().map(|estimate| Gaussian {
            mean: vector(&estimate.mean, number),
            covariance: estimate
                .covariance
                .as_ref()
                .map_or_else(SMatrix::zeros, |rows| matrix(rows, number)),
        });
        let problem = Problem {
            modes: modes.collect(),
            transition: self.transition.iter().map(|row| list(row)).collect(),
            measurement: self.measurement(number)?,
            measurement_noise: matrix(&self.noise, number),
            rule,
            fixed_gains: self.fixed_gains(number),
        };
        Ok(Setup {
            equations: match &self.filter {
                FilterFile::FixedGain { mixing, .. } if mixing == UNMIXED => Equations::fixed_gain_unmixed(),
                _ => Equations::standard(&problem),
            },
            problem,
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

    fn measurement<T: Real, const N: usize, const M: usize>(
        &self,
        number: fn(f64) -> T,
    ) -> Result<Measurement<T, N, M>, Invalid> {
        match &self.measurement {
            MeasurementFile::Linear { matrix: rows } => Ok(Measurement::Linear(matrix(rows, number))),
            MeasurementFile::RangeBearing {
                components,
                position,
                sensor,
            } => {
                let mut named = [PolarComponent::Range; M];
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
                let (components, position, sensor) = (named, *position, sensor.map(number));
                let FilterFile::Converted { conversion } = &self.filter else {
                    return Ok(Measurement::Polar {
                        components,
                        position,
                        sensor,
                    });
                };
                let unknown = |error: UnknownConversion| {
                    Invalid::new(Class::Unknown, "problem.filter.conversion", error.to_string())
                };
                let conversion = conversion.parse().map_err(unknown)?;
                Ok(Measurement::Converted {
                    components,
                    position,
                    sensor,
                    conversion,
                })
            }
        }
    }

    fn fixed_gains<T: Real, const N: usize, const M: usize>(
        &self,
        number: fn(f64) -> T,
    ) -> Option<Vec<FixedGain<T, N, M>>> {
        let FilterFile::FixedGain { modes, .. } = &self.filter else {
            return None;
        };
        let given = modes.iter().map(|mode| FixedGain {
            gain: matrix(&mode.gain, number),
            innovation_covariance: matrix(&mode.innovation_covariance, number),
        });
        Some(given.collect())
    }

    fn rule<T: Real, const N: usize>(&self, number: fn(f64) -> T) -> Result<Option<Rule<T, N>>, Invalid> {
        let (field, rule) = match &self.filter {
            FilterFile::Kalman {} | FilterFile::FixedGain { .. } | FilterFile::Converted { .. } => return Ok(None),
            FilterFile::Cubature { rule } => (
                "problem.filter.rule",
                rule.parse::<RuleName>().and_then(|name| name.rule()),
            ),
            FilterFile::Unscented { alpha, beta, kappa } => (
                "problem.filter",
                unscented::unscented_in(&number(*alpha), &number(*beta), &number(*kappa)),
            ),
        };
        rule.map(Some)
            .map_err(|error| Invalid::new(Class::Unknown, field, error.to_string()))
    }
}

/// A rule in doubles, as lists whose lengths are known at run time: points, weights, covariance weights.
type Columns = (Vec<Vec<f64>>, Vec<f64>, Vec<f64>);

/// The rules in doubles that were asked for, by filter and dimension.
static RULES: Mutex<BTreeMap<String, Option<Columns>>> = Mutex::new(BTreeMap::new());

/// So many rules are kept; every α, β and κ is another, and a program that answers for days may see any number of them.
const RULES_KEPT: usize = 100;

fn as_columns<const N: usize>(rule: &Rule<f64, N>) -> Columns {
    let points = rule.points.iter().map(|point| point.as_slice().to_vec()).collect();
    (points, rule.weights.clone(), rule.covariance_weights.clone())
}

fn of_columns<const N: usize>((points, weights, covariance_weights): &Columns) -> Rule<f64, N> {
    Rule {
        points: points.iter().map(|point| vector(point, |value| value)).collect(),
        weights: weights.clone(),
        covariance_weights: covariance_weights.clone(),
    }
}

/// A matrix of so many rows and columns from a list of rows.
fn matrix<T: Real, const R: usize, const C: usize>(rows: &Rows, number: fn(f64) -> T) -> SMatrix<T, R, C> {
    SMatrix::from_fn(|row, column| number(rows[row][column]))
}

/// A vector from a list.
fn vector<T: Real, const R: usize>(values: &[f64], number: fn(f64) -> T) -> SVector<T, R> {
    SVector::from_fn(|row, _| number(values[row]))
}
