//! What the sensor sees: a linear function of the state, range and bearing, or these converted to a position.
//!
//! After this file the reader knows the papers' measurements, how residuals are formed and how measurements of cubature points
//! are averaged when some of their components are angles ([`super::angle`]).
//!
//! ```text
//! state or point ─ of ─▶ Z          weights, Z, centre ─ mean ─▶ ẑ          z, ẑ ─ difference ─▶ ν = z − ẑ, angles wrapped
//! ```
//!
//! A converted measurement ([`Measurement::Converted`]) is linear once it has become a position; how it does is in
//! [`crate::filter::converted`].

use super::angle::wrap;
use super::conversion::Conversion;
use crate::number::Real;
use nalgebra::{SMatrix, SVector};

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
pub enum Measurement<T, const N: usize, const M: usize> {
    /// A linear measurement — zhu2016 (62): h(x) = H x.
    ///
    /// Example: of [x, ẋ, y, ẏ] the position is seen.
    ///
    /// ```
    /// use immaculate::model::Measurement;
    /// use nalgebra::{matrix, vector};
    ///
    /// let position = Measurement::Linear(matrix![1.0, 0.0, 0.0, 0.0; 0.0, 0.0, 1.0, 0.0]);
    /// assert_eq!(position.of(&vector![3.0, 7.0, 4.0, 8.0]), vector![3.0, 4.0]);
    /// ```
    ///
    /// Errata: the paper prints Z = H + R, with the matrix added to the noise; H multiplies the state, and R names both the noise
    /// and its covariance.
    ///
    /// Evidence: `printed_measurement_adds_noise_to_the_matrix`.
    Linear(SMatrix<T, M, N>),
    /// A measurement in polar coordinates — sustika2015 (3), liu2017 (31): r = √(x² + y²), θ = tan⁻¹(y/x).
    ///
    /// Example: a target 3 m east and 4 m north of the sensor is 5 m away.
    ///
    /// ```
    /// use immaculate::model::{Measurement, PolarComponent};
    /// use nalgebra::vector;
    ///
    /// let range = Measurement::Polar { components: [PolarComponent::Range], position: [0, 2], sensor: [100.0, 0.0] };
    /// assert_eq!(range.of(&vector![103.0, 7.0, 4.0, 8.0]), vector![5.0]); // √(3² + 4²)
    /// ```
    ///
    /// Errata: tan⁻¹(y/x) confuses opposite directions; it is atan2(y, x) here.
    Polar {
        /// What each component of z is.
        components: [PolarComponent; M],
        /// Which entries of the state are the position (x, y).
        position: [usize; 2],
        /// Where the sensor stands, in metres.
        sensor: [T; 2],
    },
    /// Range and bearing that the filter turns into a position before it uses them, [`converted`](crate::filter::converted). To the filter
    /// the position is what is measured: h(x) = H x, where H takes the position out of the state.
    Converted {
        /// What each component of z is: a range and a bearing, in either order.
        components: [PolarComponent; M],
        /// Which entries of the state are the position (x, y).
        position: [usize; 2],
        /// Where the sensor stands, in metres.
        sensor: [T; 2],
        /// How.
        conversion: Conversion,
    },
}

impl<T: Real, const N: usize, const M: usize> Measurement<T, N, M> {
    /// The measurement of a state without noise, h(x) — sustika2015 (2), (3), (30), zhu2016 (35)-(41), (62), liu2017 (1), (31).
    ///
    /// Example: a target to the south-west, whose bearing is −135°. The printed tan⁻¹(y/x) says 45°, the opposite direction.
    ///
    /// ```
    /// use immaculate::model::{Measurement, PolarComponent};
    /// use nalgebra::vector;
    /// use std::f64::consts::PI;
    ///
    /// let radar = Measurement::Polar {
    ///     components: [PolarComponent::Range, PolarComponent::Bearing],
    ///     position: [0, 1],
    ///     sensor: [0.0, 0.0],
    /// };
    /// assert_eq!(radar.of(&vector![-1.0, -1.0]), vector![2.0_f64.sqrt(), -0.75 * PI]);
    /// assert_eq!((-1.0_f64 / -1.0).atan(), 0.25 * PI);
    /// ```
    ///
    /// Evidence: `a_range_bearing_measurement_is_the_polar_form_of_the_position` (property),
    /// `plain_arctangent_confuses_opposite_quadrants`, `printed_arctangent_converts_the_first_point_to_the_opposite_one`.
    pub fn of(&self, state: &SVector<T, N>) -> SVector<T, M> {
        match self {
            Self::Linear(h) => h * state,
            Self::Polar {
                components,
                position,
                sensor,
            } => {
                let x = state[position[0]].clone() - sensor[0].clone();
                let y = state[position[1]].clone() - sensor[1].clone();
                SVector::from_fn(|row, _| match components[row] {
                    PolarComponent::Range => (x.clone() * x.clone() + y.clone() * y.clone()).sqrt(),
                    PolarComponent::Bearing => y.atan2(&x),
                })
            }
            Self::Converted { .. } => self.matrix() * state,
        }
    }

    /// What the sensor reports as component: a range, a bearing, or, of a linear measurement, neither.
    pub fn reports(&self, component: usize) -> Option<PolarComponent> {
        match self {
            Self::Linear(_) => None,
            Self::Polar { components, .. } | Self::Converted { components, .. } => Some(components[component]),
        }
    }

    /// Where range and bearing stand in z, if it is one of each and nothing else: what is needed for a position.
    ///
    /// Source: sustika2015, section 3.1.
    ///
    /// Example: a radar that reports the bearing first, and one without a range.
    ///
    /// ```
    /// use immaculate::model::{Measurement, PolarComponent::{Bearing, Range}};
    ///
    /// let (position, sensor) = ([0, 1], [0.0, 0.0]);
    /// let radar = Measurement::<f64, 2, 2>::Polar { components: [Bearing, Range], position, sensor };
    /// assert_eq!(radar.range_and_bearing(), Some([1, 0]));
    /// let bearings = Measurement::<f64, 2, 2>::Polar { components: [Bearing, Bearing], position, sensor };
    /// assert_eq!(bearings.range_and_bearing(), None);
    /// ```
    pub fn range_and_bearing(&self) -> Option<[usize; 2]> {
        let place = |wanted| (0..M).find(|&row| self.reports(row) == Some(wanted));
        let both = place(PolarComponent::Range).zip(place(PolarComponent::Bearing));
        both.filter(|_| M == 2).map(|(range, bearing)| [range, bearing])
    }

    /// Whether the filter converts it to a position.
    pub fn is_converted(&self) -> bool {
        matches!(self, Self::Converted { .. })
    }

    /// Whether a component of what the filter uses is an angle; a converted measurement has none.
    pub fn is_angle(&self, component: usize) -> bool {
        match self {
            Self::Linear(_) | Self::Converted { .. } => false,
            Self::Polar { components, .. } => components[component] == PolarComponent::Bearing,
        }
    }

    /// The matrix H of a linear or converted measurement; of another the undecided one, so that nothing that needs H has an answer.
    pub fn matrix(&self) -> SMatrix<T, M, N> {
        match self {
            Self::Linear(h) => h.clone(),
            Self::Polar { .. } => SMatrix::from_fn(|_, _| T::undecided()),
            Self::Converted { position, .. } => SMatrix::from_fn(|row, column| {
                if position.get(row) == Some(&column) {
                    T::one()
                } else {
                    T::zero()
                }
            }),
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
    /// use immaculate::model::{Measurement, PolarComponent};
    /// use nalgebra::vector;
    /// use std::f64::consts::PI;
    ///
    /// let bearing = Measurement::<f64, 2, 1>::Polar { components: [PolarComponent::Bearing], position: [0, 1], sensor: [0.0, 0.0] };
    /// let (z, predicted) = (vector![0.75 * PI], vector![-0.75 * PI]);
    /// assert_eq!(bearing.difference(&z, &predicted), vector![-0.5 * PI]);
    /// assert_eq!(z - predicted, vector![1.5 * PI]);
    /// ```
    ///
    /// Evidence: `mirroring_the_scene_mirrors_the_answer`, `the_answer_does_not_depend_on_where_the_bearing_is_cut` (property).
    pub fn difference(&self, a: &SVector<T, M>, b: &SVector<T, M>) -> SVector<T, M> {
        let mut difference = a - b;
        for component in 0..M {
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
    /// use immaculate::model::{Measurement, PolarComponent};
    /// use nalgebra::vector;
    /// use std::f64::consts::PI;
    ///
    /// let bearing = Measurement::<f64, 2, 1>::Polar { components: [PolarComponent::Bearing], position: [0, 1], sensor: [0.0, 0.0] };
    /// let values = [vector![0.75 * PI], vector![-0.75 * PI]];
    /// // π + ½ · (−π/4) + ½ · (+π/4)
    /// assert_eq!(bearing.mean(&[0.5, 0.5], &values, &vector![PI]), vector![PI]);
    /// assert_eq!(values[0] * 0.5 + values[1] * 0.5, vector![0.0]);
    /// ```
    ///
    /// Evidence: `the_answer_does_not_depend_on_where_the_bearing_is_cut` (property).
    pub fn mean(&self, weights: &[T], values: &[SVector<T, M>], centre: &SVector<T, M>) -> SVector<T, M> {
        let mut mean = SVector::zeros();
        for (weight, value) in weights.iter().zip(values) {
            for component in 0..M {
                mean[component] += weight.clone()
                    * if self.is_angle(component) {
                        wrap(value[component].clone() - centre[component].clone())
                    } else {
                        value[component].clone()
                    };
            }
        }
        for component in 0..M {
            if self.is_angle(component) {
                mean[component] += centre[component].clone();
            }
        }
        mean
    }
}
