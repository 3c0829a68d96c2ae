//! The radar: range and bearing, turned into positions, and the uncertainty of these.
//!
//! The paper has one measurement, and its transformation gives the filters the variances of x and y. [`crate::model::conversion`] makes a
//! position of range and bearing and removes the bias.

use crate::model::Conversion;
use crate::number::Real;
use nalgebra::Vector2;

/// Range and bearing of a position, m and rad.
pub fn polar(position: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(position.norm(), Real::atan2(&position[1], &position[0]))
}

/// The variances of x and of y of a converted measurement at a position, to first order in the noise, m².
///
/// The paper filters each coordinate by itself, so that the covariance of the two is not used.
///
/// Evidence: `the_variances_of_a_converted_measurement_are_right_to_first_order`.
pub fn converted_variances(position: Vector2<f64>, [range, bearing]: [f64; 2]) -> [f64; 2] {
    let at = polar(position);
    let covariance = Conversion::Standard.covariance(&at[0], &at[1], &range, &bearing);
    covariance.diagonal().into()
}
