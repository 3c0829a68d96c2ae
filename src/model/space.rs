//! Spaces: which components a vector has, and which of them are angles.
//!
//! A space subtracts and averages vectors that contain angles.
//!
//! ```text
//! a, b ─ difference ─▶ a − b, angles wrapped          weights, values, centre ─ mean ─▶ Σ w v, angles averaged around the centre
//! ```
//!
//! A state and a measurement are treated alike: a heading in the state is an angle as a bearing in the measurement is.

use super::angle;
use super::formula::{InvalidName, check_names};
use crate::number::Real;
use thiserror::Error;

/// Whether values that differ by a full turn are the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ComponentKind {
    /// A number of the real line.
    Number,
    /// An angle in radians.
    Angle,
}

/// A component of a vector.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Component {
    /// The name under which formulas know it.
    pub name: String,
    /// The unit, for people.
    pub unit: String,
    /// Number or angle.
    pub kind: ComponentKind,
}

impl Component {
    /// A component that is a number.
    pub fn number(name: &str, unit: &str) -> Self {
        Self {
            name: name.to_owned(),
            unit: unit.to_owned(),
            kind: ComponentKind::Number,
        }
    }

    /// A component that is an angle, in radians.
    pub fn angle(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            unit: "rad".to_owned(),
            kind: ComponentKind::Angle,
        }
    }
}

/// Why components are not those of a space.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum InvalidSpace {
    /// There is no component.
    #[error("a space has at least one component")]
    Empty,
    /// A name cannot be used.
    #[error(transparent)]
    Name(#[from] InvalidName),
    /// An angle in another unit.
    #[error("`{name}` is an angle and has the unit `{unit}`; angles are in radians, `rad`")]
    NotInRadians {
        /// The component.
        name: String,
        /// Its unit.
        unit: String,
    },
}

/// What the components of a vector are.
///
/// Example: a state with a heading. From 135° to −135° it is a quarter turn to the left, across ±180°.
///
/// ```
/// use immaculate::model::space::{Component, Space};
/// use std::f64::consts::PI;
///
/// let state = Space::new(vec![Component::number("v", "m/s"), Component::angle("heading")])?;
/// assert_eq!(state.position("heading"), Some(1));
/// assert_eq!(state.difference(&[5.0, -0.75 * PI], &[3.0, 0.75 * PI]), [2.0, 0.5 * PI]);
/// # Ok::<(), immaculate::model::space::InvalidSpace>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Space {
    components: Vec<Component>,
}

impl Space {
    /// A space of these components.
    ///
    /// # Errors
    ///
    /// [`InvalidSpace`] if there is none, if a name is none, reserved or used twice, or if an angle is not in radians.
    pub fn new(components: Vec<Component>) -> Result<Self, InvalidSpace> {
        if components.is_empty() {
            return Err(InvalidSpace::Empty);
        }
        check_names(components.iter().map(|component| component.name.as_str()))?;
        for component in &components {
            if component.kind == ComponentKind::Angle && component.unit != "rad" {
                return Err(InvalidSpace::NotInRadians {
                    name: component.name.clone(),
                    unit: component.unit.clone(),
                });
            }
        }
        Ok(Self { components })
    }

    /// The space of some of the components.
    pub(super) fn only(&self, components: &[usize]) -> Self {
        let chosen = components.iter().filter_map(|&index| self.components.get(index));
        Self {
            components: chosen.cloned().collect(),
        }
    }

    /// The components, in order.
    pub fn components(&self) -> &[Component] {
        &self.components
    }

    /// How many components there are.
    pub fn dimension(&self) -> usize {
        self.components.len()
    }

    /// The names of the components, in order.
    pub fn names(&self) -> Vec<&str> {
        self.components
            .iter()
            .map(|component| component.name.as_str())
            .collect()
    }

    /// Where a component stands.
    pub fn position(&self, name: &str) -> Option<usize> {
        self.components.iter().position(|component| component.name == name)
    }

    /// Whether a component is an angle.
    pub fn is_angle(&self, component: usize) -> bool {
        self.components
            .get(component)
            .is_some_and(|component| component.kind == ComponentKind::Angle)
    }

    /// The vector with its angles in (−π, π].
    ///
    /// Source: [`angle::wrap`] for each component that is an angle.
    ///
    /// Example: three quarters of a turn to the left are one to the right; a number stays what it is.
    ///
    /// ```
    /// use immaculate::model::space::{Component, Space};
    /// use std::f64::consts::PI;
    ///
    /// let space = Space::new(vec![Component::number("range", "m"), Component::angle("bearing")])?;
    /// assert_eq!(space.wrap(&[7.0, 1.5 * PI]), [7.0, -0.5 * PI]);
    /// # Ok::<(), immaculate::model::space::InvalidSpace>(())
    /// ```
    ///
    /// Evidence: `a_wrapped_vector_differs_by_whole_turns_in_its_angles` (property).
    pub fn wrap<T: Real>(&self, vector: &[T]) -> Vec<T> {
        let mut wrapped = Vec::with_capacity(self.dimension());
        for component in 0..self.dimension() {
            wrapped.push(self.wrapped(component, entry(vector, component)));
        }
        wrapped
    }

    /// The difference a − b, its angles wrapped to (−π, π].
    ///
    /// Source: an angle's difference is an angle.
    ///
    /// Example: bearings of 135° and −135° are a quarter turn apart, across the negative x-axis.
    ///
    /// ```
    /// use immaculate::model::space::{Component, Space};
    /// use std::f64::consts::PI;
    ///
    /// let bearing = Space::new(vec![Component::angle("bearing")])?;
    /// assert_eq!(bearing.difference(&[0.75 * PI], &[-0.75 * PI]), [-0.5 * PI]);
    /// # Ok::<(), immaculate::model::space::InvalidSpace>(())
    /// ```
    ///
    /// Evidence: `a_space_measures_as_the_polar_measurement_does` (property).
    pub fn difference<T: Real>(&self, a: &[T], b: &[T]) -> Vec<T> {
        let mut difference = Vec::with_capacity(self.dimension());
        for component in 0..self.dimension() {
            difference.push(self.wrapped(component, entry(a, component) - entry(b, component)));
        }
        difference
    }

    /// The weighted mean of vectors.
    ///
    /// ```text
    /// v̄ = Σₛ wₛ vₛ,      for an angle:  v̄ = v_c + Σₛ wₛ wrap(vₛ − v_c)
    /// ```
    ///
    /// | symbol | here      | shape | meaning                                    |
    /// |--------|-----------|-------|--------------------------------------------|
    /// | wₛ     | `weights` | L     | weights that add up to one                 |
    /// | vₛ     | `values`  | L × n | the vectors                                |
    /// | v_c    | `centre`  | n     | the vector around which angles are averaged |
    ///
    /// Source: with Σ w = 1 the two forms are equal when no angle jumps, and only the second is right when one does.
    ///
    /// Example: the mean of 135° and −135°, seen from 180°, is 180°. As plain numbers it is 0°, the opposite direction.
    ///
    /// ```
    /// use immaculate::model::space::{Component, Space};
    /// use std::f64::consts::PI;
    ///
    /// let bearing = Space::new(vec![Component::angle("bearing")])?;
    /// let values = [vec![0.75 * PI], vec![-0.75 * PI]];
    /// // π + ½ · (−π/4) + ½ · (+π/4)
    /// assert_eq!(bearing.mean(&[0.5, 0.5], &values, &[PI]), [PI]);
    /// # Ok::<(), immaculate::model::space::InvalidSpace>(())
    /// ```
    ///
    /// Evidence: `a_space_measures_as_the_polar_measurement_does`,
    /// `the_mean_of_angles_does_not_depend_on_the_turn_they_are_counted_from` (property).
    pub fn mean<T: Real>(&self, weights: &[T], values: &[Vec<T>], centre: &[T]) -> Vec<T> {
        let mut mean = Vec::with_capacity(self.dimension());
        for component in 0..self.dimension() {
            let centre = entry(centre, component);
            let mut sum = T::zero();
            for (weight, value) in weights.iter().zip(values) {
                let value = entry(value, component);
                let value = if self.is_angle(component) {
                    angle::wrap(value - centre.clone())
                } else {
                    value
                };
                sum += weight.clone() * value;
            }
            if self.is_angle(component) {
                sum += centre;
            }
            mean.push(sum);
        }
        mean
    }

    /// A value of a component, wrapped if it is an angle.
    fn wrapped<T: Real>(&self, component: usize, value: T) -> T {
        if self.is_angle(component) {
            angle::wrap(value)
        } else {
            value
        }
    }
}

/// An entry of a vector; undecided where the vector is shorter than its space.
fn entry<T: Real>(vector: &[T], component: usize) -> T {
    vector.get(component).cloned().unwrap_or_else(T::undecided)
}
