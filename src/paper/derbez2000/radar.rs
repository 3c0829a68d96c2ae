//! What the radar sees: range and bearing, turned into positions, and how uncertain these are.
//!
//! After this file the reader knows the one measurement of the paper, what its transformation does to the noise, and the two ways to take
//! out its bias.

use crate::number::Real;
use nalgebra::Vector2;

/// Range and bearing of a position, m and rad.
pub fn polar(position: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(position.norm(), Real::atan2(&position[1], &position[0]))
}

/// The position of a range and a bearing, m: x = r cos θ, y = r sin θ.
pub fn position(polar: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(polar[0] * Real::cos(&polar[1]), polar[0] * Real::sin(&polar[1]))
}

/// How the bias of the transformation is taken out; E[cos θ] of a bearing with the variance σ² is e^(−σ²/2) times that of its mean.
///
/// Evidence: `debiasing_takes_out_the_bias_that_it_names`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Debiasing {
    /// Not at all.
    Nothing,
    /// e^(σ²/2) r cos θ: no bias given the truth.
    Multiplicative,
    /// r cos θ (1 − (e^(−σ²) − e^(−σ²/2))): the mean of the bias given the measurement is subtracted. Lerro and Bar-Shalom 1993.
    Additive,
}

impl Debiasing {
    /// The factor of a converted position, for a bearing of the variance `variance`.
    pub fn factor(self, variance: f64) -> f64 {
        match self {
            Self::Nothing => 1.0,
            Self::Multiplicative => Real::exp(&(variance / 2.0)),
            Self::Additive => 1.0 - (Real::exp(&-variance) - Real::exp(&(-variance / 2.0))),
        }
    }
}

/// The variances of x and of y of a converted measurement at a position, to first order in the noise, m².
///
/// ```text
/// R_x = σ_r² cos²θ + r² σ_θ² sin²θ,   R_y = σ_r² sin²θ + r² σ_θ² cos²θ
/// ```
///
/// Source: Bar-Shalom, Li and Kirubarajan 2001, section 10.4.3: the diagonal of J R Jᵀ. The paper filters each coordinate by itself, so
/// that the covariance of the two is not used.
///
/// Evidence: `the_variances_of_a_converted_measurement_are_right_to_first_order`.
pub fn converted_variances(position: Vector2<f64>, [range, bearing]: [f64; 2]) -> [f64; 2] {
    let squares = position.component_mul(&position);
    let squared_range = squares[0] + squares[1];
    let [along_x, along_y] = [squares[0] / squared_range, squares[1] / squared_range];
    [
        range * along_x + squared_range * bearing * along_y,
        range * along_y + squared_range * bearing * along_x,
    ]
}
