//! The functions of a filter as data: a matrix with an offset, or formulas.
//!
//! A motion f or a measurement h that is given as data is evaluated and differentiated here.
//!
//! ```text
//! y = M x + b          or          y = f(x; given; parameters)
//! ```
//!
//! *Given* is what may differ from step to step besides the state: the step length `T`, and inputs. *Parameters* are bound once, as exact
//! numbers.

use super::formula::{Formulas, InvalidFormula};
use crate::number::{Rational, Real};
use num_traits::Zero;
use thiserror::Error;

/// Why something is not a function.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum InvalidFunction {
    /// A matrix without entries.
    #[error("the matrix has no entries")]
    Empty,
    /// A row of another length.
    #[error("row {row} of the matrix has {has} entries and not {expected}, as the first row has")]
    Ragged {
        /// The row, counted from one.
        row: usize,
        /// Its length.
        has: usize,
        /// The length of the first row.
        expected: usize,
    },
    /// An offset of another length.
    #[error("the offset has {has} entries, and the matrix {rows} rows")]
    Offset {
        /// The length of the offset.
        has: usize,
        /// The rows of the matrix.
        rows: usize,
    },
    /// Formulas that cannot be read.
    #[error(transparent)]
    Formula(#[from] InvalidFormula),
    /// A state without what a function needs.
    #[error(transparent)]
    Lacking(#[from] Lacking),
    /// An entry that is not a number.
    #[error("`{0}` has no value")]
    Undecided(String),
}

/// A state lacks components that a model needs.
///
/// Example: a bearing of a target that only has a height.
///
/// ```
/// use immaculate::model::function::Lacking;
///
/// let lacking = Lacking::of("bearing", &["x", "y"], &["x", "z"]).unwrap();
/// assert_eq!(lacking.to_string(), "`bearing` needs the component `y`, and the state has `x` and `z`");
/// assert_eq!(Lacking::of("bearing", &["x", "y"], &["y", "vx", "x"]), None);
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("`{model}` needs the component{} {}, and the state has {}", if .missing.len() == 1 { "" } else { "s" }, listed(.missing), listed(.has))]
pub struct Lacking {
    /// What needs them.
    pub model: String,
    /// What the state lacks.
    pub missing: Vec<String>,
    /// What it has.
    pub has: Vec<String>,
}

impl Lacking {
    /// What a state lacks of what a model needs; `None` if nothing.
    pub fn of(model: &str, needs: &[&str], has: &[&str]) -> Option<Self> {
        let owned = |names: &mut dyn Iterator<Item = &&str>| names.map(|name| (*name).to_owned()).collect();
        let missing: Vec<String> = owned(&mut needs.iter().filter(|name| !has.contains(name)));
        (!missing.is_empty()).then(|| Self {
            model: model.to_owned(),
            missing,
            has: owned(&mut has.iter()),
        })
    }
}

/// Names in quotes, with commas and an `and`.
fn listed(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.split_last() {
        None => "nothing".to_owned(),
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
    }
}

/// A function of the state.
///
/// Example: two steps of the same motion, as a matrix and as formulas.
///
/// ```
/// use immaculate::model::function::Function;
/// use immaculate::number::{Field, Rational};
///
/// let rows = [[1, 2], [0, 1]].map(|row| row.map(Rational::integer).to_vec()).to_vec();
/// let matrix = Function::of_matrix(rows, None)?;
/// let formulas = Function::of_formulas(&["x", "vx"], &["T"], &[], &[], &[("x", "x + T*vx"), ("vx", "vx")])?;
///
/// assert_eq!(matrix.at(&[10.0, 3.0], &[]), [16.0, 3.0]); // 10 + 2 · 3
/// assert_eq!(formulas.at(&[10.0, 3.0], &[2.0]), [16.0, 3.0]);
/// assert_eq!(formulas.jacobian_at(&[10.0, 3.0], &[2.0]), [[1.0, 2.0], [0.0, 1.0]]);
/// # Ok::<(), immaculate::model::function::InvalidFunction>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Function {
    body: Body,
}

#[derive(Debug, Clone, PartialEq)]
enum Body {
    /// M by rows, and b.
    Matrix {
        matrix: Vec<Vec<Rational>>,
        offset: Vec<Rational>,
    },
    /// Formulas of the state, of what is given, and of the parameters, in this order.
    Formulas {
        formulas: Formulas,
        components: usize,
        parameters: Vec<Rational>,
    },
}

impl Function {
    /// A matrix by rows, and an offset or none.
    ///
    /// # Errors
    ///
    /// [`InvalidFunction`] if the matrix is empty or not rectangular, if the offset has another length, or an entry no value.
    pub fn of_matrix(matrix: Vec<Vec<Rational>>, offset: Option<Vec<Rational>>) -> Result<Self, InvalidFunction> {
        let rows = matrix.len();
        let expected = matrix.first().map_or(0, Vec::len);
        if expected == 0 {
            return Err(InvalidFunction::Empty);
        }
        for (index, row) in matrix.iter().enumerate() {
            let (row, has) = (index + 1, row.len());
            if has != expected {
                return Err(InvalidFunction::Ragged { row, has, expected });
            }
        }
        let offset = offset.unwrap_or_else(|| vec![Rational::zero(); rows]);
        if offset.len() != rows {
            let has = offset.len();
            return Err(InvalidFunction::Offset { has, rows });
        }
        if !matrix.iter().flatten().chain(&offset).all(Rational::is_decided) {
            return Err(InvalidFunction::Undecided(
                "an entry of the matrix or offset".to_owned(),
            ));
        }
        let body = Body::Matrix { matrix, offset };
        Ok(Self { body })
    }

    /// Formulas of the components of a state, of names that are given at every step, and of parameters with their values; with
    /// definitions before the formulas, each a name and a text.
    ///
    /// # Errors
    ///
    /// [`InvalidFunction`] if a formula cannot be read, or a parameter has no value.
    pub fn of_formulas(
        state: &[&str],
        given: &[&str],
        parameters: &[(&str, Rational)],
        definitions: &[(&str, &str)],
        formulas: &[(&str, &str)],
    ) -> Result<Self, InvalidFunction> {
        if let Some((name, _)) = parameters.iter().find(|(_, value)| !value.is_decided()) {
            return Err(InvalidFunction::Undecided((*name).to_owned()));
        }
        let of_parameters = parameters.iter().map(|(name, _)| *name);
        let names: Vec<&str> = state.iter().chain(given).copied().chain(of_parameters).collect();
        let formulas = Formulas::read(&names, definitions, formulas)?;
        Ok(Self {
            body: Body::Formulas {
                formulas,
                components: state.len(),
                parameters: parameters.iter().map(|(_, value)| value.clone()).collect(),
            },
        })
    }

    /// Some of the numbers that the function gives.
    pub(super) fn only(&self, rows: &[usize]) -> Self {
        let body = match &self.body {
            Body::Matrix { matrix, offset } => Body::Matrix {
                matrix: rows.iter().filter_map(|&row| matrix.get(row)).cloned().collect(),
                offset: rows.iter().filter_map(|&row| offset.get(row)).cloned().collect(),
            },
            Body::Formulas {
                formulas,
                components,
                parameters,
            } => Body::Formulas {
                formulas: formulas.only(rows),
                components: *components,
                parameters: parameters.clone(),
            },
        };
        Self { body }
    }

    /// How many components a state has.
    pub fn components(&self) -> usize {
        match &self.body {
            Body::Matrix { matrix, .. } => matrix.first().map_or(0, Vec::len),
            Body::Formulas { components, .. } => *components,
        }
    }

    /// How many numbers the function gives.
    pub fn dimension(&self) -> usize {
        match &self.body {
            Body::Matrix { matrix, .. } => matrix.len(),
            Body::Formulas { formulas, .. } => formulas.results().len(),
        }
    }

    /// The formulas; `None` for a matrix.
    pub fn formulas(&self) -> Option<&Formulas> {
        match &self.body {
            Body::Matrix { .. } => None,
            Body::Formulas { formulas, .. } => Some(formulas),
        }
    }

    /// What is given at every step, in order: the names between those of the state and those of the parameters.
    pub fn given(&self) -> &[String] {
        match &self.body {
            Body::Matrix { .. } => &[],
            Body::Formulas {
                formulas,
                components,
                parameters,
            } => {
                let names = formulas.names();
                &names[*components..names.len() - parameters.len()]
            }
        }
    }

    /// The value at a state; undecided where an operation has no answer, or a number is missing.
    ///
    /// Source: M x + b, or the formulas one by one.
    ///
    /// Example: a temperature in other degrees.
    ///
    /// ```
    /// use immaculate::model::function::Function;
    /// use immaculate::number::{Field, Rational};
    ///
    /// let fahrenheit = Function::of_matrix(vec![vec![Rational::new(9, 5)]], Some(vec![Rational::integer(32)]))?;
    /// assert_eq!(fahrenheit.at(&[100.0], &[]), [212.0]); // 9/5 · 100 + 32
    /// # Ok::<(), immaculate::model::function::InvalidFunction>(())
    /// ```
    ///
    /// Evidence: `a_matrix_and_its_formulas_are_the_same_function` (enclosed).
    pub fn at<T: Real>(&self, state: &[T], given: &[T]) -> Vec<T> {
        match &self.body {
            Body::Matrix { matrix, offset } => {
                let mut values = Vec::with_capacity(matrix.len());
                for (row, offset) in matrix.iter().zip(offset) {
                    let mut sum = T::rational(offset);
                    for (column, entry) in row.iter().enumerate() {
                        let component = state.get(column).cloned().unwrap_or_else(T::undecided);
                        sum += T::rational(entry) * component;
                    }
                    values.push(sum);
                }
                values
            }
            Body::Formulas { formulas, .. } => formulas.at(&self.bound(state, given)),
        }
    }

    /// The Jacobian at a state: one row per component of the value, one column per component of the state.
    ///
    /// Source: M itself, or [`Formulas::jacobian_at`].
    ///
    /// Example: a turn rate that is zero.
    ///
    /// ```
    /// use immaculate::model::function::Function;
    ///
    /// let turned = Function::of_formulas(&["vx", "w"], &["T"], &[], &[], &[("x", "T*c1((w*T)^2)*vx")])?;
    /// // T and, since c₁ has derivative zero at zero, 0.
    /// assert_eq!(turned.jacobian_at(&[7.0, 0.0], &[2.0]), [[2.0, 0.0]]);
    /// # Ok::<(), immaculate::model::function::InvalidFunction>(())
    /// ```
    ///
    /// Evidence: as [`Formulas::jacobian_at`]; `a_matrix_and_its_formulas_are_the_same_function` (enclosed).
    pub fn jacobian_at<T: Real>(&self, state: &[T], given: &[T]) -> Vec<Vec<T>> {
        match &self.body {
            Body::Matrix { matrix, .. } => {
                let row = |row: &Vec<Rational>| row.iter().map(T::rational).collect();
                matrix.iter().map(row).collect()
            }
            Body::Formulas {
                formulas, components, ..
            } => formulas.jacobian_at(&self.bound(state, given), *components),
        }
    }

    /// Whether the function is a matrix and an offset, neither of which depends on the state: then the matrix is the Jacobian at any
    /// state, and the offset the value at zero. Formulas are judged by their operations, [`Formulas::is_linear_in`].
    pub fn is_linear(&self) -> bool {
        match &self.body {
            Body::Matrix { .. } => true,
            Body::Formulas {
                formulas, components, ..
            } => formulas.is_linear_in(*components),
        }
    }

    /// The values of all names of the formulas.
    fn bound<T: Real>(&self, state: &[T], given: &[T]) -> Vec<T> {
        let Body::Formulas {
            components, parameters, ..
        } = &self.body
        else {
            return Vec::new();
        };
        let places = |values: &[T], count: usize| -> Vec<T> {
            let value = |index| values.get(index).cloned().unwrap_or_else(T::undecided);
            (0..count).map(value).collect()
        };
        let mut values = places(state, *components);
        values.extend(places(given, self.given().len()));
        values.extend(parameters.iter().map(T::rational));
        values
    }
}
