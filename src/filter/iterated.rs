//! The iterated extended Kalman filter: the measurement is linearised where the estimate turns out to be, and not where it was expected.
//!
//! ```text
//! x₀ = x̂⁻       Hᵢ = ∂h/∂x at xᵢ      ẑᵢ = h(xᵢ) + Hᵢ(x̂⁻ − xᵢ)
//! Sᵢ = Hᵢ P⁻ Hᵢᵀ + R      Wᵢ = P⁻ Hᵢᵀ Sᵢ⁻¹      xᵢ₊₁ = x̂⁻ + Wᵢ(z − ẑᵢ)
//! ```
//!
//! Each turn is the update of a linear filter whose measurement is the tangent of h at xᵢ. After N turns x_N is the updated mean, and ẑ,
//! ν, H, S, C, W, P and the likelihood of the step are those of the last turn: the equations of [`extended`](super::extended) and
//! [`update`], at x_{N−1} for x̂⁻. One turn is the extended filter.

use super::extended::measurement_jacobian;
use super::{kalman, update};
use crate::gaussian::Gaussian;
use crate::matrix::{Holds, NotPositiveDefinite, Shapes, check_positive_definite, ldl};
use crate::model::Sensor;
use crate::number::Real;
use nalgebra::{Dim, OMatrix, OVector};
use std::num::NonZeroUsize;

/// The measurement of a state by the tangent of h somewhere else, ẑᵢ = h(xᵢ) + Hᵢ(x̂⁻ − xᵢ).
///
/// Source: Bar-Shalom, Li and Kirubarajan 2001, section 10.5.2; Jazwinski 1970, section 8.3.
///
/// | symbol | here     | shape | meaning                                            |
/// |--------|----------|-------|----------------------------------------------------|
/// | h      | `sensor` |       | the measurement                                     |
/// | xᵢ     | `at`     | N     | where the tangent touches                           |
/// | x̂⁻     | `mean`   | N     | the predicted mean                                  |
///
/// Why: to first order about xᵢ the measurement is linear in x, and its value at x̂⁻ is what is expected. Without the second term the
/// correction would start from x̂⁻ with what is missing at xᵢ.
///
/// Example: the range of a target on the x-axis is x itself, whichever way it is expanded; off the axis the tangent at (3, 4) sees
/// (3, 0) at 3 · 3/5.
///
/// ```
/// use immaculate::filter::iterated::measurement_of_the_tangent;
/// use immaculate::model::{PolarComponent, Sensor};
/// use nalgebra::{U1, U2, vector};
///
/// let sensor = Sensor::<f64, U2, U1>::Polar { components: vec![PolarComponent::Range], position: [0, 1], location: [0.0, 0.0] };
/// let of = |at, mean| measurement_of_the_tangent(&sensor, &at, &mean)[0];
/// assert_eq!(of(vector![5.0, 0.0], vector![7.0, 0.0]), 7.0);
/// assert!((of(vector![3.0, 4.0], vector![3.0, 0.0]) - 1.8).abs() < 1e-15); // 5 + (3/5, 4/5) · (0, −4)
/// ```
///
/// Evidence: `an_iterated_update_ends_where_nothing_is_left_to_be_corrected` (iterated).
pub fn measurement_of_the_tangent<T: Real, N: Dim, M: Dim>(
    sensor: &Sensor<T, N, M>,
    at: &OVector<T, N>,
    mean: &OVector<T, N>,
) -> OVector<T, M>
where
    Shapes: Holds<N, M>,
{
    sensor.of(at) + measurement_jacobian(sensor, at) * (mean - at)
}

/// The next iterate, xᵢ₊₁ = x̂⁻ + Wᵢ(z − ẑᵢ).
///
/// Source: as [`measurement_of_the_tangent`]. It is a step of Gauss and Newton for the most probable state, the least of
/// (x − x̂⁻)ᵀ P⁻⁻¹ (x − x̂⁻) + (z − h(x))ᵀ R⁻¹ (z − h(x)): Bell and Cathey 1993.
///
/// | symbol  | here        | shape    | meaning                        |
/// |---------|-------------|----------|--------------------------------|
/// | x̂⁻, P⁻  | `predicted` | N, N × N | the predicted estimate         |
/// | xᵢ      | `at`        | N        | the iterate                    |
/// | z       | `z`         | M        | the measurement                |
/// | R       | `noise`     | M × M    | measurement noise              |
///
/// Example: half of the innovation is believed, and a linear measurement leaves nothing to the second turn.
///
/// ```
/// use immaculate::{filter::iterated::next_iterate, gaussian::Gaussian, model::Sensor};
/// use nalgebra::{matrix, vector};
///
/// let predicted = Gaussian { mean: vector![0.0], covariance: matrix![2.0] };
/// let next = |at| next_iterate(&Sensor::Linear(matrix![1.0]), &predicted, &at, &vector![4.0], &matrix![2.0]);
/// assert_eq!(next(vector![0.0]), Ok(vector![2.0]));
/// assert_eq!(next(vector![2.0]), Ok(vector![2.0]));
/// ```
///
/// # Errors
///
/// [`NotPositiveDefinite`] when Sᵢ is not.
///
/// Evidence: as [`measurement_of_the_tangent`].
pub fn next_iterate<T: Real, N: Dim, M: Dim>(
    sensor: &Sensor<T, N, M>,
    predicted: &Gaussian<T, N>,
    at: &OVector<T, N>,
    z: &OVector<T, M>,
    noise: &OMatrix<T, M, M>,
) -> Result<OVector<T, N>, NotPositiveDefinite>
where
    Shapes: Holds<N, M>,
{
    let h = measurement_jacobian(sensor, at);
    let innovation = sensor.difference(z, &measurement_of_the_tangent(sensor, at, &predicted.mean));
    let s = ldl(&kalman::innovation_covariance(&h, &predicted.covariance, noise));
    check_positive_definite(&s)?;
    let gain = update::gain(&kalman::cross_covariance(&predicted.covariance, &h), &s);
    Ok(update::updated_mean(&predicted.mean, &gain, &innovation))
}

/// Where the measurement is linearised for the last of several times, x_{N−1}; none where it is the predicted mean.
///
/// Source: as [`measurement_of_the_tangent`].
///
/// Example: one turn is linearised where the state is expected.
///
/// ```
/// use immaculate::{filter::iterated::linearisation_point, gaussian::Gaussian, model::Sensor};
/// use nalgebra::{matrix, vector};
/// use std::num::NonZeroUsize;
///
/// let predicted = Gaussian { mean: vector![0.0], covariance: matrix![2.0] };
/// let point = |turns| {
///     let turns = NonZeroUsize::new(turns).unwrap();
///     linearisation_point(turns, &Sensor::Linear(matrix![1.0]), &predicted, &vector![4.0], &matrix![2.0])
/// };
/// assert_eq!((point(1), point(2)), (Ok(None), Ok(Some(vector![2.0]))));
/// ```
///
/// # Errors
///
/// As [`next_iterate`].
///
/// Evidence: `one_iteration_is_the_extended_filter_to_the_last_bit` (iterated).
pub fn linearisation_point<T: Real, N: Dim, M: Dim>(
    iterations: NonZeroUsize,
    sensor: &Sensor<T, N, M>,
    predicted: &Gaussian<T, N>,
    z: &OVector<T, M>,
    noise: &OMatrix<T, M, M>,
) -> Result<Option<OVector<T, N>>, NotPositiveDefinite>
where
    Shapes: Holds<N, M>,
{
    let mut point = None;
    for _ in 1..iterations.get() {
        let at = point.as_ref().unwrap_or(&predicted.mean);
        point = Some(next_iterate(sensor, predicted, at, z, noise)?);
    }
    Ok(point)
}
