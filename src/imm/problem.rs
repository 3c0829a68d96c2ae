//! What a run of the filter is given, and the checks that it must pass.
//!
//! After this file the reader knows the inputs of the cycle and every way in which they can be wrong. Nothing is repaired: a matrix
//! that is not quite symmetric or a row that does not quite sum to one is an error that names itself.
//!
//! ```text
//! Problem (the same at every step) ─┬─ check ─▶ Imm::new ─▶ step, step, …        InvalidProblem: the field, and the equation that needs it
//! Initial (step 0) ─────────────────┘
//! ```

use crate::filter::fixed_gain::FixedGain;
use crate::gaussian::Gaussian;
use crate::matrix::{all_finite, is_finite, is_positive_definite, is_positive_semidefinite, is_symmetric};
use crate::model::{Measurement, motion::Mode};
use crate::number::Real;
use crate::rule::Rule;
use nalgebra::SMatrix;

/// The inputs of the cycle that do not change from step to step.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem<T, const N: usize, const M: usize> {
    /// The modes, at least one.
    pub modes: Vec<Mode<T, N>>,
    /// `transition[i][j]` = P(mode j at k ∣ mode i at k−1); rows sum to one.
    pub transition: Vec<Vec<T>>,
    /// What the sensor sees.
    pub measurement: Measurement<T, N, M>,
    /// The measurement noise, R — sustika2015 (4), where it is diag(σ_r², σ_θ²): M × M, symmetric positive definite, in products of the
    /// units of the measurement.
    ///
    /// Example: a radar of 10 m and ½ rad. Deviations in the place of variances are a famous mistake.
    ///
    /// ```
    /// use immaculate::number::Real;
    /// use nalgebra::matrix;
    ///
    /// let noise = matrix![100.0, 0.0; 0.0, 0.25]; // diag(10², (1/2)²)
    /// assert_eq!(noise.map(|variance: f64| Real::sqrt(&variance)), matrix![10.0, 0.0; 0.0, 0.5]);
    /// ```
    ///
    /// Evidence: `the_constants_of_sustika2015_are_the_printed_ones` (traceability).
    pub measurement_noise: SMatrix<T, M, M>,
    /// The rule of a filter with points; none for the Kalman filter.
    pub rule: Option<Rule<T, N>>,
    /// Gain and innovation covariance of each mode, for filters with fixed gains; none for the others. With them no equation reads Q and
    /// R, which then say for which noises the gains are meant.
    pub fixed_gains: Option<Vec<FixedGain<T, N, M>>>,
}

/// The estimate at step 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Initial<T, const N: usize> {
    /// One estimate a mode. Filters with fixed gains have no covariance: it is zero.
    pub modes: Vec<Gaussian<T, N>>,
    /// One probability a mode; they sum to one.
    pub mode_probabilities: Vec<T>,
}

/// Why a problem cannot be run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InvalidProblem {
    /// A list has the wrong length.
    #[error("`{field}` has {found} entries where there are {expected} modes ({equation})")]
    Length {
        /// The field.
        field: String,
        /// Its length.
        found: usize,
        /// The number of modes.
        expected: usize,
        /// The equation that needs it.
        equation: &'static str,
    },
    /// There are no modes.
    #[error(
        "`modes` is empty; the filter needs at least one ({equation})",
        equation = "zhu2016 (54)"
    )]
    NoModes,
    /// A value is not finite.
    #[error("`{field}` has an entry that is not finite ({equation})")]
    NotFinite {
        /// The field.
        field: String,
        /// The equation that needs it.
        equation: &'static str,
    },
    /// A probability is negative.
    #[error("`{field}` has a negative entry, {value}; it must be a probability ({equation})")]
    NegativeProbability {
        /// The field.
        field: String,
        /// The entry.
        value: String,
        /// The equation that needs it.
        equation: &'static str,
    },
    /// Probabilities do not sum to one.
    #[error("`{field}` sums to {sum}; it must sum to 1 ({equation})")]
    NotNormalised {
        /// The field.
        field: String,
        /// Its sum.
        sum: String,
        /// The equation that needs it.
        equation: &'static str,
    },
    /// A covariance is not symmetric.
    #[error("`{field}` is not symmetric ({equation})")]
    NotSymmetric {
        /// The field.
        field: String,
        /// The equation that needs it.
        equation: &'static str,
    },
    /// A covariance is not positive definite, or a process noise not positive semidefinite.
    #[error("`{field}` is not positive {kind} ({equation})")]
    NotPositive {
        /// The field.
        field: String,
        /// "definite" or "semidefinite".
        kind: &'static str,
        /// The equation that needs it.
        equation: &'static str,
    },
    /// A filter without points was given a measurement that is not linear.
    #[error(
        "`measurement` is not linear, and a filter without points has no other; use a cubature filter (zhu2016 (42))"
    )]
    NotLinear,
    /// A filter with points was given no rule, or the Kalman filter one.
    #[error("`rule` is {}, but the filter's equations {} (zhu2016 (2))", if *.given { "given" } else { "missing" }, if *.given { "draw no points" } else { "draw points" })]
    Rule {
        /// Whether a rule was given.
        given: bool,
    },
    /// Fixed gains were given to equations that compute their own, or not given to those that need them.
    #[error("`filter.modes` is {}, but the filter's equations {} gains (derbez2000 (2))", if *.given { "given" } else { "missing" }, if *.given { "compute their own" } else { "need fixed" })]
    FixedGains {
        /// Whether they were given.
        given: bool,
    },
    /// A covariance was given to a filter that has none.
    #[error(
        "`{field}` is given, but filters with fixed gains have no covariance ({equation})",
        equation = "derbez2000 (2)"
    )]
    CovarianceGiven {
        /// The field.
        field: String,
    },
    /// A measurement to be converted was given to equations that do not convert, or another to those that do.
    #[error("`measurement` is {} be converted, but the filter's equations {} (sustika2015 (22))", if *.given { "to" } else { "not to" }, if *.given { "do not convert" } else { "convert" })]
    Conversion {
        /// Whether it is to be converted.
        given: bool,
    },
    /// A measurement to be converted is not one range and one bearing.
    #[error(
        "`measurement.components` must be one range and one bearing to be converted to a position (sustika2015 (20))"
    )]
    NotRangeAndBearing,
    /// The noise of a measurement to be converted has a covariance between range and bearing.
    #[error(
        "`R` has a covariance between range and bearing; a conversion knows only their variances (sustika2015 (4))"
    )]
    CorrelatedNoise,
    /// A rule's points and weights differ in number.
    #[error("`rule` has {points} points, {weights} weights and {covariance_weights} covariance weights (zhu2016 (21))")]
    RuleLengths {
        /// The number of points.
        points: usize,
        /// The number of weights.
        weights: usize,
        /// The number of covariance weights.
        covariance_weights: usize,
    },
    /// The position of a polar measurement is not in the state.
    #[error("`measurement.position` names entry {index} of a state of {dimension} (liu2017 (31))")]
    Position {
        /// The entry, counted from 0.
        index: usize,
        /// The dimension of the state.
        dimension: usize,
    },
    /// Both coordinates of the position of a polar measurement are the same entry of the state.
    #[error("`measurement.position` names entry {index} twice; range and bearing need an x and a y (liu2017 (31))")]
    PositionTwice {
        /// The entry, counted from 0.
        index: usize,
    },
}

impl<T: Real, const N: usize, const M: usize> Problem<T, N, M> {
    /// Checks everything that the cycle relies on.
    ///
    /// Example: a row of the transition matrix that does not sum to one is named, with the equation that needs it.
    ///
    /// ```
    /// use immaculate::{gaussian::Gaussian, imm::{Initial, Problem}};
    /// use immaculate::model::{Measurement, motion::Mode};
    /// use nalgebra::{matrix, vector};
    ///
    /// let problem = Problem {
    ///     modes: vec![Mode { name: "walk".into(), transition: matrix![1.0], noise: matrix![1.0] }],
    ///     transition: vec![vec![0.75]],
    ///     measurement: Measurement::Linear(matrix![1.0]),
    ///     measurement_noise: matrix![2.0],
    ///     rule: None,
    ///     fixed_gains: None,
    /// };
    /// let initial = Initial {
    ///     modes: vec![Gaussian { mean: vector![0.0], covariance: matrix![1.0] }],
    ///     mode_probabilities: vec![1.0],
    /// };
    /// let error = problem.check(&initial).unwrap_err();
    /// assert_eq!(error.to_string(), "`transition[0]` sums to 0.75; it must sum to 1 (zhu2016 (54))");
    /// ```
    ///
    /// # Errors
    ///
    /// [`InvalidProblem`] with the first field that is wrong.
    pub fn check(&self, initial: &Initial<T, N>) -> Result<(), InvalidProblem> {
        let modes = self.modes.len();
        if modes == 0 {
            return Err(InvalidProblem::NoModes);
        }
        self.check_transition()?;
        for (j, mode) in self.modes.iter().enumerate() {
            check_finite(&mode.transition, format!("modes[{j}].F"), "liu2017 (26)")?;
            check_process_noise(&mode.noise, format!("modes[{j}].Q"))?;
        }
        check_covariance(&self.measurement_noise, "R".into(), "liu2017 (19)")?;
        self.check_measurement()?;
        self.check_rule()?;
        self.check_fixed_gains()?;

        check_length("initial.modes", initial.modes.len(), modes, "zhu2016 (55)")?;
        for (j, estimate) in initial.modes.iter().enumerate() {
            let field = format!("initial.modes[{j}].mean");
            check_finite(&estimate.mean, field, "zhu2016 (55)")?;
            let field = format!("initial.modes[{j}].covariance");
            if self.fixed_gains.is_none() {
                check_initial_covariance(&estimate.covariance, &self.modes[j], field)?;
            } else if estimate.covariance.iter().any(|entry| !entry.is_zero()) {
                return Err(InvalidProblem::CovarianceGiven { field });
            }
        }
        let probabilities = &initial.mode_probabilities;
        let field = "initial.mode_probabilities";
        check_length(field, probabilities.len(), modes, "zhu2016 (54)")?;
        check_probabilities(probabilities, field, "zhu2016 (54)")
    }

    fn check_transition(&self) -> Result<(), InvalidProblem> {
        let (modes, equation) = (self.modes.len(), "zhu2016 (54)");
        check_length("transition", self.transition.len(), modes, equation)?;
        for (i, row) in self.transition.iter().enumerate() {
            let field = format!("transition[{i}]");
            check_length(&field, row.len(), modes, equation)?;
            check_probabilities(row, &field, equation)?;
        }
        Ok(())
    }

    fn check_measurement(&self) -> Result<(), InvalidProblem> {
        match &self.measurement {
            Measurement::Linear(h) => check_finite(h, "measurement.H".into(), "zhu2016 (62)"),
            Measurement::Polar { position, sensor, .. } | Measurement::Converted { position, sensor, .. } => {
                self.check_conversion()?;
                if let Some(&index) = position.iter().find(|&&index| index >= N) {
                    return Err(InvalidProblem::Position { index, dimension: N });
                }
                if position[0] == position[1] {
                    return Err(InvalidProblem::PositionTwice { index: position[0] });
                }
                if sensor.iter().all(is_finite) {
                    return Ok(());
                }
                Err(InvalidProblem::NotFinite {
                    field: "measurement.sensor".into(),
                    equation: "liu2017 (31)",
                })
            }
        }
    }

    fn check_conversion(&self) -> Result<(), InvalidProblem> {
        if !self.measurement.is_converted() {
            return Ok(());
        }
        if self.measurement.range_and_bearing().is_none() {
            return Err(InvalidProblem::NotRangeAndBearing);
        }
        if self.measurement_noise[(1, 0)].is_zero() {
            return Ok(());
        }
        Err(InvalidProblem::CorrelatedNoise)
    }

    fn check_fixed_gains(&self) -> Result<(), InvalidProblem> {
        let Some(modes) = &self.fixed_gains else {
            return Ok(());
        };
        check_length("filter.modes", modes.len(), self.modes.len(), "derbez2000 (2)")?;
        for (j, mode) in modes.iter().enumerate() {
            check_finite(&mode.gain, format!("filter.modes[{j}].gain"), "derbez2000 (2)")?;
            let field = format!("filter.modes[{j}].innovation_covariance");
            check_covariance(&mode.innovation_covariance, field, "derbez2000 (4)")?;
        }
        Ok(())
    }

    fn check_rule(&self) -> Result<(), InvalidProblem> {
        let Some(rule) = &self.rule else {
            return Ok(());
        };
        let (points, weights) = (rule.points.len(), rule.weights.len());
        let covariance_weights = rule.covariance_weights.len();
        if points != weights || points != covariance_weights {
            return Err(InvalidProblem::RuleLengths {
                points,
                weights,
                covariance_weights,
            });
        }
        Ok(())
    }
}

fn check_length(field: &str, found: usize, expected: usize, equation: &'static str) -> Result<(), InvalidProblem> {
    if found == expected {
        return Ok(());
    }
    Err(InvalidProblem::Length {
        field: field.to_owned(),
        found,
        expected,
        equation,
    })
}

/// Probabilities are finite, not negative and sum to one. The sum may be off by 10⁻¹⁵ an entry: a decimal of 15 digits is, and 1/3
/// can be written in no better way.
fn check_probabilities<T: Real>(values: &[T], field: &str, equation: &'static str) -> Result<(), InvalidProblem> {
    let field = || field.to_owned();
    let mut sum = T::zero();
    for value in values {
        if !is_finite(value) {
            return Err(InvalidProblem::NotFinite {
                field: field(),
                equation,
            });
        }
        if *value < T::zero() {
            return Err(InvalidProblem::NegativeProbability {
                field: field(),
                value: format!("{value:?}"),
                equation,
            });
        }
        sum += value.clone();
    }
    let entries = i64::try_from(values.len()).unwrap_or(i64::MAX);
    let allowed = T::integer(entries) / T::integer(1_000_000_000_000_000);
    let excess = sum.clone() - T::one();
    if excess <= allowed.clone() && excess >= -allowed {
        return Ok(());
    }
    Err(InvalidProblem::NotNormalised {
        field: field(),
        sum: format!("{sum:?}"),
        equation,
    })
}

fn check_finite<T: Real, const R: usize, const C: usize>(
    matrix: &SMatrix<T, R, C>,
    field: String,
    equation: &'static str,
) -> Result<(), InvalidProblem> {
    if all_finite(matrix) {
        return Ok(());
    }
    Err(InvalidProblem::NotFinite { field, equation })
}

fn check_symmetric<T: Real, const D: usize>(
    matrix: &SMatrix<T, D, D>,
    field: &str,
    equation: &'static str,
) -> Result<(), InvalidProblem> {
    check_finite(matrix, field.to_owned(), equation)?;
    if is_symmetric(matrix) {
        return Ok(());
    }
    Err(InvalidProblem::NotSymmetric {
        field: field.to_owned(),
        equation,
    })
}

fn check_covariance<T: Real, const D: usize>(
    matrix: &SMatrix<T, D, D>,
    field: String,
    equation: &'static str,
) -> Result<(), InvalidProblem> {
    check_symmetric(matrix, &field, equation)?;
    if is_positive_definite(matrix) {
        return Ok(());
    }
    Err(InvalidProblem::NotPositive {
        field,
        kind: "definite",
        equation,
    })
}

/// An initial covariance is positive definite; an entry of the state that the mode lacks may have a row and a column of zeros.
fn check_initial_covariance<T: Real, const D: usize>(
    matrix: &SMatrix<T, D, D>,
    mode: &Mode<T, D>,
    field: String,
) -> Result<(), InvalidProblem> {
    let mut of_other_entries = matrix.clone();
    for entry in (0..D).filter(|&entry| mode.lacks(entry)) {
        if matrix.row(entry).iter().chain(&matrix.column(entry)).all(T::is_zero) {
            of_other_entries[(entry, entry)] = T::one();
        }
    }
    check_covariance(&of_other_entries, field, "zhu2016 (56)")
}

fn check_process_noise<T: Real, const D: usize>(
    matrix: &SMatrix<T, D, D>,
    field: String,
) -> Result<(), InvalidProblem> {
    let equation = "liu2017 (17)";
    check_symmetric(matrix, &field, equation)?;
    if is_positive_semidefinite(matrix) {
        return Ok(());
    }
    Err(InvalidProblem::NotPositive {
        field,
        kind: "semidefinite",
        equation,
    })
}
