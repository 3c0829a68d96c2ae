//! The checks that a problem and its initial estimate must pass before they are run.
//!
//! Nothing is repaired: a matrix that is not quite symmetric or a row that does not quite sum to one is an error that names itself.

use super::{Initial, InvalidProblem, Problem};
use crate::filter::fixed_gain::FixedGain;
use crate::filter::{Filter, Transform, Update};
use crate::matrix::{
    Holds, Shapes, all_finite, is_finite, is_positive_definite, is_positive_semidefinite, is_symmetric,
};
use crate::model::Sensor;
use crate::model::function::Function;
use crate::model::motion::Motion;
use crate::number::{Field, Real};
use crate::rule::Rule;
use nalgebra::allocator::Allocator;
use nalgebra::{DMatrix, Dim, OMatrix, OVector};

impl<T: Real, N: Dim, M: Dim> Problem<T, N, M>
where
    Shapes: Holds<N, M>,
{
    /// Checks everything that the cycle relies on.
    ///
    /// Example: a row of the transition matrix that does not sum to one is named, with the equation that needs it.
    ///
    /// ```
    /// use immaculate::filter::Filter;
    /// use immaculate::{gaussian::Gaussian, imm::{Initial, Interaction, Problem}};
    /// use immaculate::model::{Sensor, motion::{Mode, Motion}};
    /// use nalgebra::{matrix, vector};
    ///
    /// let problem = Problem {
    ///     modes: vec![Mode { name: "walk".into(), motion: Motion::Linear(matrix![1.0]), noise: matrix![1.0] }],
    ///     chain: vec![vec![0.75]],
    ///     sensor: Sensor::Linear(matrix![1.0]),
    ///     measurement_noise: matrix![2.0],
    ///     filters: vec![Filter::kalman()],
    ///     interaction: Interaction::Imm,
    ///     angles: vec![],
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
        self.check_inputs(initial)?;
        self.check_initial(initial)
    }

    /// Checks everything but the numbers of the estimates: these must have the right shapes only.
    pub(super) fn check_inputs(&self, estimates: &Initial<T, N>) -> Result<(), InvalidProblem> {
        if self.modes.is_empty() {
            return Err(InvalidProblem::NoModes);
        }
        if self.filters.is_empty() {
            return Err(InvalidProblem::NoFilters);
        }
        self.check_shapes(estimates)?;
        self.check_chain()?;
        for (j, mode) in self.modes.iter().enumerate() {
            self.check_motion(j, &mode.motion)?;
            check_semidefinite(&mode.noise, format!("modes[{j}].Q"), "liu2017 (17)")?;
        }
        check_semidefinite(&self.measurement_noise, "R".into(), "liu2017 (19)")?;
        self.check_sensor()?;
        check_places_of_angles(&self.angles, self.n().value())?;
        self.check_filters()?;
        self.check_noise_cross_covariances()?;
        self.check_conversions()?;
        check_length("initial.modes", estimates.modes.len(), self.modes.len(), "zhu2016 (55)")
    }

    /// Checks the numbers of the initial estimate.
    fn check_initial(&self, initial: &Initial<T, N>) -> Result<(), InvalidProblem> {
        for (j, estimate) in initial.modes.iter().enumerate() {
            let field = format!("initial.modes[{j}].mean");
            check_finite(&estimate.mean, field, "zhu2016 (55)")?;
            let field = format!("initial.modes[{j}].covariance");
            if self.has_covariances() {
                check_semidefinite(&estimate.covariance, field, "zhu2016 (56)")?;
            } else if estimate.covariance.iter().any(|entry| !entry.is_zero()) {
                return Err(InvalidProblem::CovarianceGiven { field });
            }
        }
        let probabilities = &initial.mode_probabilities;
        let field = "initial.mode_probabilities";
        check_length(field, probabilities.len(), self.modes.len(), "zhu2016 (54)")?;
        check_probabilities(probabilities, field, "zhu2016 (54)")
    }

    /// Every matrix has the shape that the state of the first mode and R ask for. Shapes in the types cannot be wrong; the lists can.
    fn check_shapes(&self, initial: &Initial<T, N>) -> Result<(), InvalidProblem> {
        // A function can have another dimension even where the sides are types, which are then right.
        let n = N::try_to_usize().unwrap_or_else(|| self.n().value());
        let m = self.m().value();
        for (j, mode) in self.modes.iter().enumerate() {
            check_shape_of_motion(&mode.motion, fields_of_motion(j), n)?;
            check_shape(&mode.noise, format!("modes[{j}].Q"), (n, n))?;
        }
        check_shape(&self.measurement_noise, "R".into(), (m, m))?;
        match &self.sensor {
            Sensor::Linear(h) => check_shape(h, "measurement.H".into(), (m, n))?,
            Sensor::Polar { components, .. } => {
                let found = (components.len(), 1);
                check_same_shape(found, "measurement.components".into(), (m, 1))?;
            }
            Sensor::Function { function, space, given } => {
                let field = || "measurement".to_owned();
                check_shape_of_function(function, given.len(), field(), (m, n))?;
                check_same_shape((space.dimension(), 1), field(), (m, 1))?;
            }
        }
        for (j, estimate) in initial.modes.iter().enumerate() {
            check_shape(&estimate.mean, format!("initial.modes[{j}].mean"), (n, 1))?;
            check_shape(&estimate.covariance, format!("initial.modes[{j}].covariance"), (n, n))?;
        }
        Ok(())
    }

    /// A true state has the entries of the state, and is finite.
    pub(super) fn check_truth(&self, truth: &OVector<T, N>) -> Result<(), InvalidProblem> {
        check_shape(truth, "truth".into(), (self.n().value(), 1))?;
        check_finite(
            truth,
            "truth".into(),
            "Bar-Shalom, Li and Kirubarajan 2001, section 5.4",
        )
    }

    fn check_chain(&self) -> Result<(), InvalidProblem> {
        let (modes, equation) = (self.modes.len(), "zhu2016 (54)");
        check_length("transition", self.chain.len(), modes, equation)?;
        for (i, row) in self.chain.iter().enumerate() {
            let field = format!("transition[{i}]");
            check_length(&field, row.len(), modes, equation)?;
            check_probabilities(row, &field, equation)?;
        }
        Ok(())
    }

    /// The noises of motion and measurement have a joint covariance, and the filter takes them.
    fn check_noise_cross_covariances(&self) -> Result<(), InvalidProblem> {
        let (n, m) = (self.n().value(), self.m().value());
        for (j, mode) in self.modes.iter().enumerate() {
            let filter = self.filter(j);
            let Some(of_noises) = &filter.noise_cross_covariance else {
                continue;
            };
            let field = format!("modes[{j}].M");
            if !matches!(filter.update, Update::By(Transform::Exact | Transform::Linearised)) {
                return Err(InvalidProblem::CorrelationWithoutSlopes { field });
            }
            check_shape(of_noises, field.clone(), (n, m))?;
            check_finite(of_noises, field.clone(), "Simon 2006, section 7.1")?;
            let joint = DMatrix::from_fn(n + m, n + m, |row, column| match (row < n, column < n) {
                (true, true) => mode.noise[(row, column)].clone(),
                (true, false) => of_noises[(row, column - n)].clone(),
                (false, true) => of_noises[(column, row - n)].clone(),
                (false, false) => self.measurement_noise[(row - n, column - n)].clone(),
            });
            if !is_positive_semidefinite(&joint) {
                return Err(InvalidProblem::NotJoint { field });
            }
        }
        Ok(())
    }

    fn check_sensor(&self) -> Result<(), InvalidProblem> {
        match &self.sensor {
            Sensor::Linear(h) => check_finite(h, "measurement.H".into(), "zhu2016 (62)"),
            Sensor::Polar { position, location, .. } => {
                let dimension = self.n().value();
                if let Some(&index) = position.iter().find(|&&index| index >= dimension) {
                    return Err(InvalidProblem::Position { index, dimension });
                }
                if position[0] == position[1] {
                    return Err(InvalidProblem::PositionTwice { index: position[0] });
                }
                if location.iter().all(is_finite) {
                    return Ok(());
                }
                Err(InvalidProblem::NotFinite {
                    field: "measurement.sensor".into(),
                    equation: "liu2017 (31)",
                })
            }
            Sensor::Function { given, .. } => check_given_values(given, "measurement"),
        }
    }

    fn check_filters(&self) -> Result<(), InvalidProblem> {
        if self.filters.len() != 1 {
            check_length("filters", self.filters.len(), self.modes.len(), "zhu2016 (55)")?;
        }
        for (j, filter) in self.filters.iter().enumerate() {
            for rule in filter.rules().into_iter().flatten() {
                check_rule(rule, self.n().value())?;
            }
            match &filter.update {
                Update::By(Transform::Exact) if !matches!(self.sensor, Sensor::Linear(_)) => {
                    return Err(InvalidProblem::NotLinear {
                        field: "measurement".into(),
                    });
                }
                Update::By(_) | Update::Iterated(_) => {}
                Update::Converted(_) => self.check_conversion()?,
                Update::Given(_) if filter.predict != Transform::Exact => {
                    return Err(InvalidProblem::NothingToDrawFrom);
                }
                Update::Given(given) => self.check_given(j, given)?,
            }
        }
        if self.filters.iter().any(Filter::has_covariances) != self.has_covariances() {
            return Err(InvalidProblem::SomeGiven);
        }
        let mut conversions = self.filters.iter().filter_map(Filter::conversion);
        let first = conversions.next();
        if conversions.any(|conversion| Some(conversion) != first) {
            return Err(InvalidProblem::TwoConversions);
        }
        Ok(())
    }

    /// A motion has finite numbers, and is a matrix where no points are drawn.
    fn check_motion(&self, j: usize, motion: &Motion<T, N>) -> Result<(), InvalidProblem> {
        if !motion.is_linear() && self.filter(j).predict == Transform::Exact {
            let field = format!("modes[{j}].f");
            return Err(InvalidProblem::NotLinear { field });
        }
        check_numbers_of_motion(motion, fields_of_motion(j))
    }

    fn check_conversion(&self) -> Result<(), InvalidProblem> {
        if self.sensor.range_and_bearing().is_none() {
            return Err(InvalidProblem::NotRangeAndBearing);
        }
        if self.measurement_noise[(1, 0)].is_zero() {
            return Ok(());
        }
        Err(InvalidProblem::CorrelatedNoise)
    }

    fn check_given(&self, j: usize, given: &FixedGain<T, N, M>) -> Result<(), InvalidProblem> {
        if !matches!(self.sensor, Sensor::Linear(_)) {
            return Err(InvalidProblem::NotLinear {
                field: "measurement".into(),
            });
        }
        let (n, m) = (self.n().value(), self.m().value());
        let field = format!("filter.modes[{j}].gain");
        check_shape(&given.gain, field.clone(), (n, m))?;
        check_finite(&given.gain, field, "derbez2000 (2)")?;
        let field = format!("filter.modes[{j}].innovation_covariance");
        check_shape(&given.innovation_covariance, field.clone(), (m, m))?;
        check_covariance(&given.innovation_covariance, field, "derbez2000 (4)")
    }
}

/// A rule has as many weights as points, and its points as many coordinates as the state has components.
fn check_rule<T: Field, N: Dim>(rule: &Rule<T, N>, n: usize) -> Result<(), InvalidProblem>
where
    Shapes: Holds<N>,
{
    let (points, weights) = (rule.points.len(), rule.weights.len());
    let covariance_weights = rule.covariance_weights.len();
    if points == 0 || points != weights || points != covariance_weights {
        return Err(InvalidProblem::RuleLengths {
            points,
            weights,
            covariance_weights,
        });
    }
    for (s, point) in rule.points.iter().enumerate() {
        check_shape(point, format!("rule.points[{s}]"), (n, 1))?;
    }
    Ok(())
}

pub(super) fn check_shape<T: Field, R: Dim, C: Dim>(
    matrix: &OMatrix<T, R, C>,
    field: String,
    expected: (usize, usize),
) -> Result<(), InvalidProblem>
where
    Shapes: Allocator<R, C>,
{
    check_same_shape(matrix.shape(), field, expected)
}

fn check_same_shape(found: (usize, usize), field: String, expected: (usize, usize)) -> Result<(), InvalidProblem> {
    if found == expected {
        return Ok(());
    }
    Err(InvalidProblem::Shape { field, found, expected })
}

/// Where the matrix, or the function, of a mode's motion stands.
fn fields_of_motion(j: usize) -> [String; 2] {
    ["F", "f"].map(|key| format!("modes[{j}].{key}"))
}

/// A motion is of n components; `fields` says where its matrix and its function stand.
pub(super) fn check_shape_of_motion<T: Field, N: Dim>(
    motion: &Motion<T, N>,
    [of_matrix, of_function]: [String; 2],
    n: usize,
) -> Result<(), InvalidProblem>
where
    Shapes: Holds<N>,
{
    match motion {
        Motion::Linear(f) => check_shape(f, of_matrix, (n, n)),
        Motion::Affine { matrix, offset } => {
            check_shape(matrix, of_matrix, (n, n))?;
            check_shape(offset, of_function, (n, 1))
        }
        Motion::Function { function, given } => check_shape_of_function(function, given.len(), of_function, (n, n)),
    }
}

/// The numbers of a motion are finite.
pub(super) fn check_numbers_of_motion<T: Real, N: Dim>(
    motion: &Motion<T, N>,
    [of_matrix, of_function]: [String; 2],
) -> Result<(), InvalidProblem>
where
    Shapes: Holds<N>,
{
    match motion {
        Motion::Linear(f) => check_finite(f, of_matrix, "liu2017 (26)"),
        Motion::Affine { matrix, offset } => {
            check_finite(matrix, of_matrix, "liu2017 (26)")?;
            check_finite(offset, of_function, "liu2017 (1)")
        }
        Motion::Function { given, .. } => check_given_values(given, &of_function),
    }
}

/// Angles are entries of a state, each named once.
pub(super) fn check_places_of_angles(angles: &[usize], dimension: usize) -> Result<(), InvalidProblem> {
    for (place, &index) in angles.iter().enumerate() {
        if index >= dimension || angles[..place].contains(&index) {
            return Err(InvalidProblem::Angle { index, dimension });
        }
    }
    Ok(())
}

/// A function takes the state and what it is given, and gives as many components as are needed.
fn check_shape_of_function(
    function: &Function,
    given: usize,
    field: String,
    expected: (usize, usize),
) -> Result<(), InvalidProblem> {
    let found = (function.dimension(), function.components());
    check_same_shape(found, field.clone(), expected)?;
    check_same_shape((given, 1), field, (function.given().len(), 1))
}

fn check_given_values<T: Real>(given: &[T], field: &str) -> Result<(), InvalidProblem> {
    if given.iter().all(is_finite) {
        return Ok(());
    }
    Err(InvalidProblem::NotFinite {
        field: field.to_owned(),
        equation: "liu2017 (1)",
    })
}

pub(super) fn check_length(
    field: &str,
    found: usize,
    expected: usize,
    equation: &'static str,
) -> Result<(), InvalidProblem> {
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

fn check_finite<T: Real, R: Dim, C: Dim>(
    matrix: &OMatrix<T, R, C>,
    field: String,
    equation: &'static str,
) -> Result<(), InvalidProblem>
where
    Shapes: Allocator<R, C>,
{
    if all_finite(matrix) {
        return Ok(());
    }
    Err(InvalidProblem::NotFinite { field, equation })
}

fn check_symmetric<T: Real, D: Dim>(
    matrix: &OMatrix<T, D, D>,
    field: &str,
    equation: &'static str,
) -> Result<(), InvalidProblem>
where
    Shapes: Holds<D>,
{
    check_finite(matrix, field.to_owned(), equation)?;
    if is_symmetric(matrix) {
        return Ok(());
    }
    Err(InvalidProblem::NotSymmetric {
        field: field.to_owned(),
        equation,
    })
}

fn check_covariance<T: Real, D: Dim>(
    matrix: &OMatrix<T, D, D>,
    field: String,
    equation: &'static str,
) -> Result<(), InvalidProblem>
where
    Shapes: Holds<D>,
{
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

/// A covariance of what may be known exactly, or of noise that there need not be: of an initial estimate, Q and R. Whether S is definite
/// shows at every step.
pub(super) fn check_semidefinite<T: Real, D: Dim>(
    matrix: &OMatrix<T, D, D>,
    field: String,
    equation: &'static str,
) -> Result<(), InvalidProblem>
where
    Shapes: Holds<D>,
{
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
