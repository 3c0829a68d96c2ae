//! The converted measurement filter: range and bearing become a position first, and a Kalman filter does the rest.
//!
//! After this file the reader knows that the filter's only own equations come before it: what is measured is moved from polar to Cartesian
//! coordinates, its noise with it, and from there on the measurement is linear:
//!
//! ```text
//! z = [r, θ], R ─ conversion ─▶ z^c, R^c ─▶ ν = z^c − H x̂⁻,  S = H P⁻ Hᵀ + R^c ─▶ gain, update and likelihood of a Kalman filter
//! ```
//!
//! The position of a measurement is where its range and bearing point, whatever turn the bearing is counted from: no residual of angles is
//! ever formed, and there is none to be wrapped. The conversions themselves are in [`crate::model::conversion`].

use crate::model::Measurement;
use crate::number::Real;
use nalgebra::{SMatrix, SVector};

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
/// A measurement that is not converted has no answer.
///
/// Example: 5 m straight ahead, along x, of a sensor at (100, 20).
///
/// ```
/// use immaculate::filter::converted::converted_measurement;
/// use immaculate::model::{Conversion, Measurement, PolarComponent};
/// use nalgebra::{matrix, vector};
///
/// let radar = Measurement::<f64, 4, 2>::Converted {
///     components: [PolarComponent::Range, PolarComponent::Bearing],
///     position: [0, 2],
///     sensor: [100.0, 20.0],
///     conversion: Conversion::Standard,
/// };
/// let noise = matrix![4.0, 0.0; 0.0, 0.25];
/// // 100 + 5 · cos 0, 20 + 5 · sin 0
/// assert_eq!(converted_measurement(&radar, &vector![5.0, 0.0], &noise), vector![105.0, 20.0]);
/// ```
///
/// Evidence: `a_converted_measurement_is_where_range_and_bearing_point` (property).
pub fn converted_measurement<T: Real, const N: usize, const M: usize>(
    measurement: &Measurement<T, N, M>,
    z: &SVector<T, M>,
    noise: &SMatrix<T, M, M>,
) -> SVector<T, M> {
    let (Measurement::Converted { sensor, conversion, .. }, Some([r, b])) =
        (measurement, measurement.range_and_bearing())
    else {
        return SVector::from_fn(|_, _| T::undecided());
    };
    let position = conversion.position(&z[r], &z[b], &noise[(b, b)]);
    SVector::from_fn(|row, _| sensor[row].clone() + position[row].clone())
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
/// use immaculate::model::{Conversion, Measurement, PolarComponent};
/// use nalgebra::{matrix, vector};
///
/// let radar = Measurement::<f64, 4, 2>::Converted {
///     components: [PolarComponent::Range, PolarComponent::Bearing],
///     position: [0, 2],
///     sensor: [100.0, 20.0],
///     conversion: Conversion::Standard,
/// };
/// let noise = matrix![4.0, 0.0; 0.0, 0.25];
/// // σ_r², 10² · ¼
/// assert_eq!(converted_covariance(&radar, &vector![10.0, 0.0], &noise), matrix![4.0, 0.0; 0.0, 25.0]);
/// ```
///
/// Evidence: `the_converted_covariance_does_not_depend_on_the_order_of_the_components` (property).
pub fn converted_covariance<T: Real, const N: usize, const M: usize>(
    measurement: &Measurement<T, N, M>,
    z: &SVector<T, M>,
    noise: &SMatrix<T, M, M>,
) -> SMatrix<T, M, M> {
    let (Measurement::Converted { conversion, .. }, Some([r, b])) = (measurement, measurement.range_and_bearing())
    else {
        return SMatrix::from_fn(|_, _| T::undecided());
    };
    let covariance = conversion.covariance(&z[r], &z[b], &noise[(r, r)], &noise[(b, b)]);
    SMatrix::from_fn(|row, column| covariance[(row, column)].clone())
}

/// The position of a state as range and bearing from the sensor, in the order of the measurement's components: where R^c is evaluated by
/// those who take it at the prediction instead of at the measurement.
///
/// Source: liu2017 (31).
///
/// Example: 3 m and 4 m from the sensor, along x and y.
///
/// ```
/// use immaculate::filter::converted::polar_position;
/// use immaculate::{model::{Conversion, Measurement, PolarComponent}, number::Real};
/// use nalgebra::vector;
///
/// let radar = Measurement::<f64, 4, 2>::Converted {
///     components: [PolarComponent::Bearing, PolarComponent::Range],
///     position: [0, 2],
///     sensor: [100.0, 20.0],
///     conversion: Conversion::Standard,
/// };
/// // In the order of the components: the angle of (3, 4), and √(3² + 4²).
/// assert_eq!(polar_position(&radar, &vector![103.0, 7.0, 24.0, 8.0]), vector![Real::atan2(&4.0, &3.0), 5.0]);
/// ```
pub fn polar_position<T: Real, const N: usize, const M: usize>(
    measurement: &Measurement<T, N, M>,
    state: &SVector<T, N>,
) -> SVector<T, M> {
    match measurement {
        Measurement::Converted {
            components,
            position,
            sensor,
            ..
        } => Measurement::Polar {
            components: *components,
            position: *position,
            sensor: sensor.clone(),
        }
        .of(state),
        _ => measurement.of(state),
    }
}
