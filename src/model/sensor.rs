//! The measurement: a linear function of the state, range and bearing, or these converted to a position.
//!
//! This file forms residuals and averages the measurements of cubature points, also if some components are angles ([`super::angle`]).
//!
//! ```text
//! state or point ─ of ─▶ Z          weights, Z, centre ─ mean ─▶ ẑ          z, ẑ ─ difference ─▶ ν = z − ẑ, angles wrapped
//! ```
//!
//! Range and bearing that a filter converts are a position to it: [`position_matrix`], and [`crate::filter::converted`].

use super::angle::wrap;
use super::function::Function;
use super::space::Space;
use crate::matrix::{Holds, Shapes, rows};
use crate::number::{Field, Real};
use nalgebra::{Dim, Dyn, OMatrix, OVector, U1};
use std::sync::Arc;

/// A component of a polar measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PolarComponent {
    /// The distance from the sensor, in metres.
    Range,
    /// The bearing, in radians, counter-clockwise from the x-axis.
    Bearing,
}

/// The function h of the measurement z = h(x) + v, v ~ N(0, R).
#[derive(Debug, Clone, PartialEq)]
pub enum Sensor<T: Field, N: Dim, M: Dim>
where
    Shapes: Holds<N, M>,
{
    /// A linear measurement — zhu2016 (62): h(x) = H x.
    ///
    /// Example: of [x, ẋ, y, ẏ] the position is seen.
    ///
    /// ```
    /// use immaculate::model::Sensor;
    /// use nalgebra::{matrix, vector};
    ///
    /// let position = Sensor::Linear(matrix![1.0, 0.0, 0.0, 0.0; 0.0, 0.0, 1.0, 0.0]);
    /// assert_eq!(position.of(&vector![3.0, 7.0, 4.0, 8.0]), vector![3.0, 4.0]);
    /// ```
    ///
    /// Errata: the paper prints Z = H + R, with the matrix added to the noise; H multiplies the state, and R names both the noise
    /// and its covariance.
    ///
    /// Evidence: `printed_measurement_adds_noise_to_the_matrix`.
    Linear(OMatrix<T, M, N>),
    /// A measurement in polar coordinates — sustika2015 (3), liu2017 (31): r = √(x² + y²), θ = tan⁻¹(y/x).
    ///
    /// Example: a target 3 m east and 4 m north of the sensor is 5 m away.
    ///
    /// ```
    /// use immaculate::model::{PolarComponent, Sensor};
    /// use nalgebra::{U1, U4, vector};
    ///
    /// let range = Sensor::<f64, U4, U1>::Polar { components: vec![PolarComponent::Range], position: [0, 2], location: [100.0, 0.0] };
    /// assert_eq!(range.of(&vector![103.0, 7.0, 4.0, 8.0]), vector![5.0]); // √(3² + 4²)
    /// ```
    ///
    /// Errata: tan⁻¹(y/x) confuses opposite directions; it is atan2(y, x) here.
    Polar {
        /// What each component of z is.
        components: Vec<PolarComponent>,
        /// Which entries of the state are the position (x, y).
        position: [usize; 2],
        /// Where the sensor stands, in metres.
        location: [T; 2],
    },
    /// Any function of the state; filters that draw points have no other need.
    ///
    /// Example: how fast the distance grows.
    ///
    /// ```
    /// use immaculate::model::{Sensor, function::Function, space::{Component, Space}};
    /// use nalgebra::{U1, vector};
    ///
    /// let text = "(x*vx + y*vy)/hypot(x, y)";
    /// let function = Function::of_formulas(&["x", "vx", "y", "vy"], &[], &[], &[], &[("range_rate", text)])?;
    /// let space = Space::new(vec![Component::number("range_rate", "m/s")])?;
    /// let doppler = Sensor::<f64, _, U1>::Function { function: function.into(), space: space.into(), given: vec![] };
    /// assert_eq!(doppler.of(&vector![3.0, 5.0, 4.0, -5.0]), vector![-1.0]); // (3 · 5 − 4 · 5)/5
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Evidence: `formulas_of_range_and_bearing_are_the_native_ones` (models_in_filters).
    Function {
        /// h.
        function: Arc<Function>,
        /// What the components of z are, and which of them are angles.
        space: Arc<Space>,
        /// The values of what the function is given besides the state, [`Function::given`].
        given: Vec<T>,
    },
}

impl<T: Real, N: Dim, M: Dim> Sensor<T, N, M>
where
    Shapes: Holds<N, M>,
{
    /// The measurement of a state without noise, h(x) — sustika2015 (2), (3), (30), zhu2016 (35)-(41), (62), liu2017 (1), (31).
    ///
    /// Example: a target to the south-west, whose bearing is −135°. The printed tan⁻¹(y/x) says 45°, the opposite direction.
    ///
    /// ```
    /// use immaculate::model::{PolarComponent, Sensor};
    /// use nalgebra::{U2, vector};
    /// use std::f64::consts::PI;
    ///
    /// let radar = Sensor::<f64, U2, U2>::Polar {
    ///     components: vec![PolarComponent::Range, PolarComponent::Bearing],
    ///     position: [0, 1],
    ///     location: [0.0, 0.0],
    /// };
    /// assert_eq!(radar.of(&vector![-1.0, -1.0]), vector![2.0_f64.sqrt(), -0.75 * PI]);
    /// assert_eq!((-1.0_f64 / -1.0).atan(), 0.25 * PI);
    /// ```
    ///
    /// Evidence: `a_range_bearing_measurement_is_the_polar_form_of_the_position` (property),
    /// `plain_arctangent_confuses_opposite_quadrants`, `printed_arctangent_converts_the_first_point_to_the_opposite_one`.
    pub fn of(&self, state: &OVector<T, N>) -> OVector<T, M> {
        match self {
            Self::Linear(h) => h * state,
            Self::Polar {
                components,
                position,
                location,
            } => {
                let x = state[position[0]].clone() - location[0].clone();
                let y = state[position[1]].clone() - location[1].clone();
                OVector::from_fn_generic(M::from_usize(components.len()), U1, |row, _| match components[row] {
                    PolarComponent::Range => (x.clone() * x.clone() + y.clone() * y.clone()).sqrt(),
                    PolarComponent::Bearing => y.atan2(&x),
                })
            }
            Self::Function { function, given, .. } => {
                let values = function.at(state.as_slice(), given);
                OVector::from_iterator_generic(self.dimension(), U1, values)
            }
        }
    }

    /// The number of components of z, as the type of that side.
    pub fn dimension(&self) -> M {
        match self {
            Self::Linear(h) => rows(h),
            Self::Polar { components, .. } => M::from_usize(components.len()),
            Self::Function { function, .. } => M::from_usize(function.dimension()),
        }
    }

    /// What the sensor reports as component: a range, a bearing, or, of a linear measurement or a function, neither.
    pub fn reports(&self, component: usize) -> Option<PolarComponent> {
        match self {
            Self::Linear(_) | Self::Function { .. } => None,
            Self::Polar { components, .. } => components.get(component).copied(),
        }
    }

    /// Where range and bearing stand in z, if it is one of each and nothing else: what is needed for a position.
    ///
    /// Source: sustika2015, section 3.1.
    ///
    /// Example: a radar that reports the bearing first, and one without a range.
    ///
    /// ```
    /// use immaculate::model::{PolarComponent::{Bearing, Range}, Sensor};
    /// use nalgebra::U2;
    ///
    /// let (position, location) = ([0, 1], [0.0, 0.0]);
    /// let radar = Sensor::<f64, U2, U2>::Polar { components: vec![Bearing, Range], position, location };
    /// assert_eq!(radar.range_and_bearing(), Some([1, 0]));
    /// let bearings = Sensor::<f64, U2, U2>::Polar { components: vec![Bearing, Bearing], position, location };
    /// assert_eq!(bearings.range_and_bearing(), None);
    /// ```
    pub fn range_and_bearing(&self) -> Option<[usize; 2]> {
        let m = self.dimension().value();
        let place = |wanted| (0..m).find(|&row| self.reports(row) == Some(wanted));
        let both = place(PolarComponent::Range).zip(place(PolarComponent::Bearing));
        both.filter(|_| m == 2).map(|(range, bearing)| [range, bearing])
    }

    /// Whether a component is an angle.
    pub fn is_angle(&self, component: usize) -> bool {
        match self {
            Self::Linear(_) => false,
            Self::Polar { .. } => self.reports(component) == Some(PolarComponent::Bearing),
            Self::Function { space, .. } => space.is_angle(component),
        }
    }

    /// The difference of two measurements, its angles wrapped to (−π, π] — liu2017 (residual).
    ///
    /// Source: an angle's difference is an angle; the papers subtract without saying so, and liu2017's target is never near ±π.
    ///
    /// Example: bearings of 135° and −135° are a quarter turn apart, across the negative x-axis. As plain numbers they are three quarters
    /// apart.
    ///
    /// ```
    /// use immaculate::model::{PolarComponent, Sensor};
    /// use nalgebra::{U1, U2, vector};
    /// use std::f64::consts::PI;
    ///
    /// let bearing = Sensor::<f64, U2, U1>::Polar { components: vec![PolarComponent::Bearing], position: [0, 1], location: [0.0, 0.0] };
    /// let (z, predicted) = (vector![0.75 * PI], vector![-0.75 * PI]);
    /// assert_eq!(bearing.difference(&z, &predicted), vector![-0.5 * PI]);
    /// assert_eq!(z - predicted, vector![1.5 * PI]);
    /// ```
    ///
    /// Evidence: `mirroring_the_scene_mirrors_the_answer`, `the_answer_does_not_depend_on_where_the_bearing_is_cut` (property).
    pub fn difference(&self, a: &OVector<T, M>, b: &OVector<T, M>) -> OVector<T, M> {
        let mut difference = a - b;
        for component in 0..difference.len() {
            if self.is_angle(component) {
                difference[component] = wrap(difference[component].clone());
            }
        }
        difference
    }

    /// The weighted mean of measurements — sustika2015 (31), zhu2016 (42)-(44), liu2017 (19).
    ///
    /// ```text
    /// ẑ = Σₛ wₛ Zₛ,      for an angle:  ẑ = Z_c + Σₛ wₛ wrap(Zₛ − Z_c)
    /// ```
    ///
    /// | paper | here         | shape | meaning                                       |
    /// |-------|--------------|-------|-----------------------------------------------|
    /// | wₛ    | `weights`    | L     | the rule's weights                            |
    /// | Zₛ    | `values`     | L × M | the measurements of the points                |
    /// | Z_c   | `centre`     | M     | the measurement of the points' centre x̂       |
    ///
    /// Why: with Σ w = 1 the two forms are equal when no angle jumps, and only the second is right when one does.
    ///
    /// Example: the mean of 135° and −135°, seen from the centre at 180°, is 180°. As plain numbers it is 0°, the opposite direction.
    ///
    /// ```
    /// use immaculate::model::{PolarComponent, Sensor};
    /// use nalgebra::{U1, U2, vector};
    /// use std::f64::consts::PI;
    ///
    /// let bearing = Sensor::<f64, U2, U1>::Polar { components: vec![PolarComponent::Bearing], position: [0, 1], location: [0.0, 0.0] };
    /// let values = [vector![0.75 * PI], vector![-0.75 * PI]];
    /// // π + ½ · (−π/4) + ½ · (+π/4)
    /// assert_eq!(bearing.mean(&[0.5, 0.5], &values, &vector![PI]), vector![PI]);
    /// assert_eq!(values[0] * 0.5 + values[1] * 0.5, vector![0.0]);
    /// ```
    ///
    /// Evidence: `the_answer_does_not_depend_on_where_the_bearing_is_cut` (property).
    pub fn mean(&self, weights: &[T], values: &[OVector<T, M>], centre: &OVector<T, M>) -> OVector<T, M> {
        let mut mean = OVector::zeros_generic(rows(centre), U1);
        for (weight, value) in weights.iter().zip(values) {
            for component in 0..mean.len() {
                mean[component] += weight.clone()
                    * if self.is_angle(component) {
                        wrap(value[component].clone() - centre[component].clone())
                    } else {
                        value[component].clone()
                    };
            }
        }
        for component in 0..mean.len() {
            if self.is_angle(component) {
                mean[component] += centre[component].clone();
            }
        }
        mean
    }
}

impl<T: Real, N: Dim> Sensor<T, N, Dyn>
where
    Shapes: Holds<N, Dyn>,
{
    /// The sensor of a step in which only these components of z are there.
    ///
    /// Source: the rows of h(x); a component that is missing says nothing, whatever its noise has to do with that of the others.
    ///
    /// Example: a radar whose range is missing.
    ///
    /// ```
    /// use immaculate::model::{PolarComponent::{Bearing, Range}, Sensor};
    /// use nalgebra::{Dyn, U2, dvector, vector};
    ///
    /// let radar = Sensor::<f64, U2, Dyn>::Polar { components: vec![Range, Bearing], position: [0, 1], location: [0.0, 0.0] };
    /// assert_eq!(radar.only(&[1]).of(&vector![3.0, 0.0]), dvector![0.0]);
    /// ```
    ///
    /// Evidence: `entries_that_are_missing_are_those_of_a_sensor_that_does_not_see_them` (own_problems).
    #[must_use]
    pub fn only(&self, rows: &[usize]) -> Self {
        match self {
            Self::Linear(h) => Self::Linear(h.select_rows(rows)),
            Self::Polar {
                components,
                position,
                location,
            } => Self::Polar {
                components: rows.iter().filter_map(|&row| components.get(row)).copied().collect(),
                position: *position,
                location: location.clone(),
            },
            Self::Function { function, space, given } => Self::Function {
                function: function.only(rows).into(),
                space: space.only(rows).into(),
                given: given.clone(),
            },
        }
    }
}

/// The matrix that takes the position out of the state, M × N: h(x) = H x of a filter that converts range and bearing.
///
/// Source: sustika2015, section 3.1.
///
/// Example: x and y of a state [x, ẋ, y, ẏ].
///
/// ```
/// use immaculate::model::sensor::position_matrix;
/// use nalgebra::{U2, U4, matrix};
///
/// assert_eq!(position_matrix(&[0, 2], U2, U4), matrix![1.0, 0.0, 0.0, 0.0; 0.0, 0.0, 1.0, 0.0]);
/// ```
pub fn position_matrix<T: Field, N: Dim, M: Dim>(position: &[usize; 2], m: M, n: N) -> OMatrix<T, M, N>
where
    Shapes: Holds<N, M>,
{
    OMatrix::from_fn_generic(m, n, |row, column| {
        if position.get(row) == Some(&column) {
            T::one()
        } else {
            T::zero()
        }
    })
}
