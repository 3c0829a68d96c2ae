//! The converted measurement filter: range and bearing become a position first, and a Kalman filter does the rest.
//!
//! The filter adds equations only at the beginning: the measurement and its noise are converted from polar to Cartesian coordinates. From
//! then on the measurement is linear:
//!
//! ```text
//! z = [r, θ], R ─ conversion ─▶ z^c, R^c ─▶ ν = z^c − H x̂⁻,  S = H P⁻ Hᵀ + R^c ─▶ gain, update and likelihood of a Kalman filter
//! ```
//!
//! The position of a measurement is where its range and bearing point, whatever turn the bearing is counted from: no residual of angles is
//! ever formed, and there is none to be wrapped. The conversions themselves are in [`crate::model::conversion`].

use crate::matrix::{Holds, Shapes, rows};
use crate::model::{Conversion, Sensor};
use crate::number::Real;
use nalgebra::{Dim, OMatrix, OVector, U1};

/// The converted measurement, in the coordinates of the state: the sensor's place plus the position seen from there.
///
/// ```text
/// z^c = s + [x(r, θ), y(r, θ)]ᵀ
/// ```
///
/// | paper  | here          | shape | meaning                                                                      |
/// |--------|---------------|-------|------------------------------------------------------------------------------|
/// | (r, θ) | `z`           | M     | range and bearing, m and rad, in the order of the measurement's components    |
/// | R      | `noise`       | M × M | its covariance; the variance of the bearing is what a debiased conversion needs |
/// | s      |               | 2     | the sensor's place, m; the paper's is the origin                              |
///
/// Source: sustika2015, section 3.1; [`Conversion::position`](crate::model::conversion::Conversion::position).
///
/// None if the sensor does not report one range and one bearing.
///
/// Example: 5 m straight ahead, along x, of a sensor at (100, 20).
///
/// ```
/// use immaculate::filter::converted::converted_measurement;
/// use immaculate::model::{Conversion, Sensor, PolarComponent};
/// use nalgebra::{U2, U4, matrix, vector};
///
/// let radar = Sensor::<f64, U4, U2>::Polar {
///     components: vec![PolarComponent::Range, PolarComponent::Bearing],
///     position: [0, 2],
///     location: [100.0, 20.0],
/// };
/// let noise = matrix![4.0, 0.0; 0.0, 0.25];
/// // 100 + 5 · cos 0, 20 + 5 · sin 0
/// let position = converted_measurement(Conversion::Standard, &radar, &vector![5.0, 0.0], &noise);
/// assert_eq!(position, Some(vector![105.0, 20.0]));
/// ```
///
/// Evidence: `a_converted_measurement_is_where_range_and_bearing_point` (property).
pub fn converted_measurement<T: Real, N: Dim, M: Dim>(
    conversion: Conversion,
    sensor: &Sensor<T, N, M>,
    z: &OVector<T, M>,
    noise: &OMatrix<T, M, M>,
) -> Option<OVector<T, M>>
where
    Shapes: Holds<N, M>,
{
    let [r, b] = sensor.range_and_bearing()?;
    let Sensor::Polar { location, .. } = sensor else {
        return None;
    };
    let position = conversion.position(&z[r], &z[b], &noise[(b, b)]);
    let converted = |row: usize| location[row].clone() + position[row].clone();
    Some(OVector::from_fn_generic(rows(z), U1, |row, _| converted(row)))
}

/// The covariance of the converted measurement, R^c of a range and a bearing.
///
/// | paper      | here    | shape | meaning                                        |
/// |------------|---------|-------|------------------------------------------------|
/// | (r, θ)     | `z`     | M     | where it is evaluated: what was measured        |
/// | σ_r², σ_θ² | `noise` | M × M | variances of range and bearing, m² and rad²     |
///
/// Source: sustika2015, section 3.1; [`Conversion::covariance`](crate::model::conversion::Conversion::covariance).
///
/// Example: 10 m away along x, with σ_r = 2 m and σ_θ = ½ rad: a variance of 4 m² along and of 25 m² across. R as it stands would say ¼ m²
/// across.
///
/// ```
/// use immaculate::filter::converted::converted_covariance;
/// use immaculate::model::{Conversion, Sensor, PolarComponent};
/// use nalgebra::{U2, U4, matrix, vector};
///
/// let radar = Sensor::<f64, U4, U2>::Polar {
///     components: vec![PolarComponent::Range, PolarComponent::Bearing],
///     position: [0, 2],
///     location: [100.0, 20.0],
/// };
/// let noise = matrix![4.0, 0.0; 0.0, 0.25];
/// // σ_r², 10² · ¼
/// let covariance = converted_covariance(Conversion::Standard, &radar, &vector![10.0, 0.0], &noise);
/// assert_eq!(covariance, Some(matrix![4.0, 0.0; 0.0, 25.0]));
/// ```
///
/// Evidence: `the_converted_covariance_does_not_depend_on_the_order_of_the_components` (property).
pub fn converted_covariance<T: Real, N: Dim, M: Dim>(
    conversion: Conversion,
    sensor: &Sensor<T, N, M>,
    z: &OVector<T, M>,
    noise: &OMatrix<T, M, M>,
) -> Option<OMatrix<T, M, M>>
where
    Shapes: Holds<N, M>,
{
    let [r, b] = sensor.range_and_bearing()?;
    let covariance = conversion.covariance(&z[r], &z[b], &noise[(r, r)], &noise[(b, b)]);
    let entry = |row, column| covariance[(row, column)].clone();
    Some(OMatrix::from_fn_generic(rows(z), rows(z), entry))
}
