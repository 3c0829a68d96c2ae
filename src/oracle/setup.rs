//! A problem in one number system, ready to be run and varied.
//!
//! Each number of a problem file is converted exactly, or perturbed.

use super::bound::{Bound, Functions};
use super::chain::ChainOfRates;
use super::invalid::{Class, Invalid};
use super::problem::{
    FilterFile, InteractionFile, MeasurementAt, MeasurementFile, ModeFile, ProblemFile, Rows, UNMIXED,
};
use super::variant;
use crate::filter::Filter;
use crate::filter::fixed_gain::FixedGain;
use crate::gaussian::Gaussian;
use crate::imm::state_conversion::Reader;
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
    /// The true states of steps 1, 2, …; none where nobody knows it.
    pub truths: Vec<Option<DVector<T>>>,
    /// The problems of the steps, counted from 1, in which it is another.
    pub changes: BTreeMap<usize, Problem<T, Dyn, Dyn>>,
    /// The rates of the chain in the steps, counted from 1, and at 0 those of the problem; empty where the chain is a matrix.
    pub rates: BTreeMap<usize, ChainOfRates<T>>,
}

impl<T: Real> Setup<T> {
    /// The filter at step 0. The problem is not checked: a variant's may be wrong on purpose.
    pub fn filter(&self) -> Imm<T, Dyn, Dyn> {
        Imm::unchecked(self.problem.clone(), self.equations.clone(), &self.initial)
    }

    /// The same with variants of the catalogue, one after the other.
    #[must_use]
    pub fn varied(mut self, variants: &[impl AsRef<str>]) -> Self {
        for id in variants {
            variant::apply(id.as_ref(), &mut self);
        }
        self
    }

    /// The problem, and those of the steps in which it is another.
    pub(super) fn problems(&self) -> impl Iterator<Item = &Problem<T, Dyn, Dyn>> {
        std::iter::once(&self.problem).chain(self.changes.values())
    }

    /// The rates of a step, counted from 1, as those of a problem of its own; empty where the step says its chain, or no rates are given.
    pub(super) fn rates_of(&self, step: usize) -> BTreeMap<usize, ChainOfRates<T>> {
        let own = self.rates.get(&step);
        own.map(|chain| (0, chain.clone())).into_iter().collect()
    }

    /// The problem of a step, counted from 1.
    pub fn problem_of(&self, step: usize) -> &Problem<T, Dyn, Dyn> {
        self.changes.get(&step).unwrap_or(&self.problem)
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
        Ok(self.setup_undeclared(number)?.varied(&self.declared))
    }

    /// The problem in a number system without the conventions that a program has declared. A number system that never runs one then needs
    /// no code for the whole catalogue.
    ///
    /// # Errors
    ///
    /// As [`ProblemFile::setup`].
    pub(crate) fn setup_undeclared<T: Real>(&self, number: fn(f64) -> T) -> Result<Setup<T>, Invalid> {
        self.setup_with_rules(number, |filter, place| self.rule(filter, place, number))
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
        let setup = self.setup_with_rules(RandomRounding::exact, |filter, place| {
            self.rule_in_doubles(filter, place)
        })?;
        Ok(setup.varied(&self.declared))
    }

    /// The problem in random rounding, every number perturbed.
    ///
    /// # Errors
    ///
    /// As [`ProblemFile::setup`].
    pub fn setup_perturbed(&self) -> Result<Setup<RandomRounding>, Invalid> {
        let perturbed = |value: &RandomRounding| RandomRounding::input(value.value());
        let perturbed_rule = |rule: Rule<RandomRounding, Dyn>| Rule {
            points: rule
                .points
                .iter()
                .map(|point| point.map(|value| perturbed(&value)))
                .collect(),
            weights: rule.weights.iter().map(perturbed).collect(),
            covariance_weights: rule.covariance_weights.iter().map(perturbed).collect(),
        };
        let setup = self.setup_with_rules(RandomRounding::input, |filter, place| {
            Ok(self.rule_in_doubles(filter, place)?.map(perturbed_rule))
        })?;
        Ok(setup.varied(&self.declared))
    }

    /// The rule in doubles. It is computed once and kept: a search asks for it thousands of times.
    fn rule_in_doubles(&self, filter: &FilterFile, place: &str) -> Result<Option<Rule<RandomRounding, Dyn>>, Invalid> {
        if !matches!(filter, FilterFile::Cubature { .. } | FilterFile::Unscented { .. }) {
            return Ok(None);
        }
        let name = format!("{filter:?} {}", self.state.len());
        let mut rules = RULES.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(rule) = rules.get(&name) {
            return Ok(rule.clone());
        }
        let rule = self.rule(filter, place, RandomRounding::exact)?;
        if rules.len() >= RULES_KEPT {
            rules.clear();
        }
        rules.insert(name, rule.clone());
        Ok(rule)
    }

    /// The problem in a number system; `rule_of` gives the rule of a filter, which stands at a place of the file, if it draws points.
    fn setup_with_rules<T: Real>(
        &self,
        number: fn(f64) -> T,
        rule_of: impl Fn(&FilterFile, &str) -> Result<Option<Rule<T, Dyn>>, Invalid>,
    ) -> Result<Setup<T>, Invalid> {
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
        let of_step = |entry: &MeasurementAt| {
            let there: Vec<f64> = entry.entries().map(|(_, value)| value).collect();
            entry.z.is_some().then(|| vector(&there, number))
        };
        let truth_of = |entry: &MeasurementAt| entry.truth.as_ref().map(|truth| vector(truth, number));
        let problem = Problem {
            modes: self.modes_in(&functions, number, interval),
            filters: self.filters(number, rule_of)?,
            interaction: match &self.filter {
                FilterFile::FixedGain { mixing, .. } if mixing == UNMIXED => Interaction::Unmixed,
                _ => match self.interaction() {
                    InteractionFile::Imm => self.converted(&functions, number, interval)?,
                    InteractionFile::Gpb1 => Interaction::Gpb1,
                    InteractionFile::Unmixed => Interaction::Unmixed,
                },
            },
            angles: self.angles_of_state(Reader::Common),
            chain: self.chain(number, interval),
            sensor: self.sensor(0, &functions, number, interval)?,
            measurement_noise: matrix(&self.noise, number),
        };
        Ok(Setup {
            changes: self.changes(&problem, &functions, number, interval)?,
            rates: self.rates_of_steps(number, interval),
            problem,
            equations: if self.lacks_consistency {
                Equations::standard().without_consistency()
            } else {
                Equations::standard()
            },
            initial: Initial {
                modes: estimates.collect(),
                mode_probabilities: list(&self.initial.mode_probabilities),
            },
            measurements: self.measurements.iter().map(of_step).collect(),
            truths: self.measurements.iter().map(truth_of).collect(),
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

    /// The rates of the chain: those of the problem at 0, and of each step without a chain of its own.
    fn rates_of_steps<T: Real>(&self, number: fn(f64) -> T, interval: Option<f64>) -> BTreeMap<usize, ChainOfRates<T>> {
        let own = self.measurements.iter().filter(|entry| entry.transition.is_none());
        let own = own.map(|entry| (entry.step, entry.interval.or(interval)));
        let all = std::iter::once((0, interval)).chain(own);
        all.filter_map(|(step, interval)| Some((step, self.chain_of_rates(number, interval)?)))
            .collect()
    }

    /// The problems of the steps in which it is another.
    fn changes<T: Real>(
        &self,
        problem: &Problem<T, Dyn, Dyn>,
        functions: &Functions,
        number: fn(f64) -> T,
        of_problem: Option<f64>,
    ) -> Result<BTreeMap<usize, Problem<T, Dyn, Dyn>>, Invalid> {
        let mut changes = BTreeMap::new();
        for entry in self.measurements.iter().filter(|entry| entry.has_changes()) {
            let mut changed = problem.clone();
            let interval = entry.interval.or(of_problem);
            if entry.interval.is_some() {
                changed.modes = self.modes_in(functions, number, interval);
                changed.chain = self.chain(number, interval);
                if let Interaction::Converted(_) = changed.interaction {
                    changed.interaction = self.converted(functions, number, interval)?;
                }
            }
            let sensor = self.sensor_of(entry).unwrap_or(0);
            changed.sensor = self.sensor(sensor, functions, number, interval)?;
            changed.measurement_noise = matrix(self.sensors_at()[sensor].noise, number);
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
            if let Some(rows) = entry.rows() {
                changed.sensor = changed.sensor.only(&rows);
                changed.measurement_noise = changed.measurement_noise.select_rows(&rows).select_columns(&rows);
                for filter in &mut changed.filters {
                    filter.noise_cross_covariance = filter
                        .noise_cross_covariance
                        .as_ref()
                        .map(|of_noises| of_noises.select_columns(&rows));
                }
            }
            changes.insert(entry.step, changed);
        }
        Ok(changes)
    }

    /// The sensor of this number, in a step of this length.
    fn sensor<T: Real>(
        &self,
        index: usize,
        functions: &Functions,
        number: fn(f64) -> T,
        interval: Option<f64>,
    ) -> Result<Sensor<T, Dyn, Dyn>, Invalid> {
        if let Some((bound, space)) = &functions.sensors[index] {
            return Ok(bound.sensor(space, number, interval));
        }
        let sensor_at = &self.sensors_at()[index];
        let place = format!("{}.measurement", sensor_at.place);
        match sensor_at.measurement {
            MeasurementFile::Formulas { .. } | MeasurementFile::Model { .. } => {
                let reason = "is no function of the state";
                Err(Invalid::new(Class::Unknown, place, reason))
            }
            MeasurementFile::Linear { matrix: rows } => Ok(Sensor::Linear(matrix(rows, number))),
            MeasurementFile::RangeBearing {
                components,
                position,
                sensor,
            } => {
                let mut named = vec![PolarComponent::Range; components.len()];
                for (row, (component, name)) in named.iter_mut().zip(components).enumerate() {
                    *component = match name.as_str() {
                        "range" => PolarComponent::Range,
                        "bearing" => PolarComponent::Bearing,
                        _ => {
                            let field = format!("{place}.components[{row}]");
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

    /// The filters: one a mode, or one for all.
    fn filters<T: Real>(
        &self,
        number: fn(f64) -> T,
        rule_of: impl Fn(&FilterFile, &str) -> Result<Option<Rule<T, Dyn>>, Invalid>,
    ) -> Result<Vec<Filter<T, Dyn, Dyn>>, Invalid> {
        if let FilterFile::FixedGain { modes, .. } = &self.filter {
            let given = modes.iter().map(|mode| FixedGain {
                gain: matrix(&mode.gain, number),
                innovation_covariance: matrix(&mode.innovation_covariance, number),
            });
            return Ok(given.map(Filter::given).collect());
        }
        let filter_of = |(filter, place): (&FilterFile, String)| {
            Ok(match filter {
                FilterFile::Converted { conversion } => {
                    let unknown = |error: UnknownConversion| {
                        Invalid::new(Class::Unknown, format!("{place}.conversion"), error.to_string())
                    };
                    Filter::converted(conversion.parse().map_err(unknown)?)
                }
                FilterFile::Extended { iterations: None } => Filter::extended(),
                FilterFile::Extended {
                    iterations: Some(times),
                } => Filter::iterated(*times),
                _ => match rule_of(filter, &place)? {
                    Some(rule) => Filter::points(rule),
                    None => Filter::kalman(),
                },
            })
        };
        let filters: Vec<_> = self
            .filters_with_places()
            .into_iter()
            .map(filter_of)
            .collect::<Result<_, _>>()?;
        Ok(self.with_noise_cross_covariances(filters, number))
    }

    /// The filters with the correlation of the noises of each mode, if any mode has one: one a mode then.
    fn with_noise_cross_covariances<T: Real>(
        &self,
        filters: Vec<Filter<T, Dyn, Dyn>>,
        number: fn(f64) -> T,
    ) -> Vec<Filter<T, Dyn, Dyn>> {
        let of_mode = |mode: &ModeFile| Some(matrix(mode.models.noise_cross_covariance.as_ref()?, number));
        if !self.has_correlated_noises() {
            return filters;
        }
        let modes = self.modes.iter().enumerate();
        let with = |(j, mode): (usize, &ModeFile)| Filter {
            noise_cross_covariance: of_mode(mode),
            ..filters.get(j).unwrap_or(&filters[0]).clone()
        };
        modes.map(with).collect()
    }

    /// The filters with their places in the file: one for all modes, or one a mode where a mode has its own.
    pub(super) fn filters_with_places(&self) -> Vec<(&FilterFile, String)> {
        let of_problem = || (&self.filter, "problem.filter".to_owned());
        if self.modes.iter().all(|mode| mode.models.filter.is_none()) {
            return vec![of_problem()];
        }
        let of_mode = |(j, mode): (usize, &'_ ModeFile)| match &mode.models.filter {
            Some(_) => (self.filter_of(j), format!("problem.modes[{j}].filter")),
            None => of_problem(),
        };
        self.modes.iter().enumerate().map(of_mode).collect()
    }

    fn rule<T: Real>(
        &self,
        filter: &FilterFile,
        place: &str,
        number: fn(f64) -> T,
    ) -> Result<Option<Rule<T, Dyn>>, Invalid> {
        let n = Dyn(self.state.len());
        let (field, rule) = match filter {
            FilterFile::Kalman {}
            | FilterFile::Extended { .. }
            | FilterFile::FixedGain { .. }
            | FilterFile::Converted { .. } => return Ok(None),
            FilterFile::Cubature { rule } => (
                format!("{place}.rule"),
                rule.parse::<RuleName>().and_then(|name| name.rule_in(n)),
            ),
            FilterFile::Unscented { alpha, beta, kappa } => (
                place.to_owned(),
                unscented::unscented_in(n, &number(*alpha), &number(*beta), &number(*kappa)),
            ),
        };
        rule.map(Some)
            .map_err(|error| Invalid::new(Class::Unknown, field, error.to_string()))
    }
}

/// The rules in doubles that were asked for, by filter and dimension.
static RULES: Mutex<BTreeMap<String, Option<Rule<RandomRounding, Dyn>>>> = Mutex::new(BTreeMap::new());

/// At most this many rules are kept; every α, β and κ is another, and a program that answers for days may see any number of them.
const RULES_KEPT: usize = 100;

/// A matrix from a list of rows.
pub(super) fn matrix<T: Real>(rows: &Rows, number: fn(f64) -> T) -> DMatrix<T> {
    DMatrix::from_fn(rows.len(), rows.first().map_or(0, Vec::len), |row, column| {
        number(rows[row][column])
    })
}

/// A vector from a list.
fn vector<T: Real>(values: &[f64], number: fn(f64) -> T) -> DVector<T> {
    DVector::from_iterator(values.len(), values.iter().map(|&value| number(value)))
}
