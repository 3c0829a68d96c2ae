//! Variants of converted measurements: the position that is measured, and its covariance.
//!
//! After this file the reader knows how a conversion goes wrong by its axes, its signs and its noise, and which debiasing is taken for
//! which.

use super::super::setup::Setup;
use crate::filter::converted::{converted_covariance, converted_measurement};
use crate::imm::{Problem, Step};
use crate::model::angle::wrap;
use crate::model::conversion_moments::attenuation;
use crate::model::{Conversion, Measurement, PolarComponent};
use crate::number::Real;
use nalgebra::{SMatrix, SVector};

/// Applies a variant of converted measurements; whether it is one. On other filters they change nothing.
pub(super) fn apply<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    if !setup.equations.converts {
        return VARIANTS.contains(&id);
    }
    of_covariance(id, setup) || of_form(id, setup) || of_measurement(id, setup) || of_conversion(id, setup)
}

/// All variants of this file.
const VARIANTS: [&str; 14] = [
    "converted-covariance-not-rotated",
    "converted-covariance-of-polar-noise",
    "converted-covariance-cross-term-of-other-sign",
    "converted-covariance-cross-term-omitted",
    "converted-covariance-axes-exchanged",
    "converted-covariance-range-not-squared",
    "converted-covariance-by-jacobian",
    "converted-measurement-axes-exchanged",
    "converted-measurement-clockwise",
    "converted-innovation-wrapped",
    "conversion-not-debiased",
    "conversion-additive",
    "conversion-multiplicative",
    "conversion-modified-unbiased",
];

/// The covariance.
fn of_covariance<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    let entry = &mut setup.equations.converted_covariance;
    match id {
        // diag(a, b): the variances along and across the line of sight, taken for those of x and y
        "converted-covariance-not-rotated" => {
            *entry = |problem, _, now| {
                let Measurement::Converted { conversion, .. } = &problem.measurement else {
                    return usual(problem, now);
                };
                let ([range_variance, bearing_variance], [range, _]) = (variances(problem), measured(problem, now));
                let squared_range = range.clone() * range;
                let attenuation = attenuation(&bearing_variance);
                let variances = conversion.variances(&squared_range, &range_variance, &bearing_variance, &attenuation);
                SMatrix::from_fn(|row, column| {
                    if row == column {
                        variances[row].clone()
                    } else {
                        T::zero()
                    }
                })
            }
        }
        // diag(σ_r², σ_θ²): R as it is
        "converted-covariance-of-polar-noise" => *entry = |problem, _, _| problem.measurement_noise.clone(),
        // −σ_xy
        "converted-covariance-cross-term-of-other-sign" => {
            *entry = |problem, _, now| {
                usual(problem, now).map_with_location(|row, column, entry| if row == column { entry } else { -entry })
            }
        }
        // 0 for σ_xy
        "converted-covariance-cross-term-omitted" => {
            *entry = |problem, _, now| super::diagonal(&usual(problem, now), T::clone);
        }
        // σ_y² for σ_x² and the other way round
        "converted-covariance-axes-exchanged" => {
            *entry = |problem, _, now| {
                let usual = usual(problem, now);
                SMatrix::from_fn(|row, column| usual[(M - 1 - row, M - 1 - column)].clone())
            }
        }
        // r σ_θ² for r² σ_θ²: the variance of the bearing divided by the range before the usual equations see it
        "converted-covariance-range-not-squared" => {
            *entry = |problem, _, now| {
                let [range, _] = measured(problem, now);
                let mut noise = problem.measurement_noise.clone();
                for row in (0..M).filter(|&row| problem.measurement.reports(row) == Some(PolarComponent::Bearing)) {
                    noise[(row, row)] /= range.clone();
                }
                match &now.measurement {
                    Some(z) => converted_covariance(&problem.measurement, z, &noise),
                    None => noise,
                }
            }
        }
        _ => return false,
    }
    true
}

/// Other algebra for the covariance of the standard conversion.
fn of_form<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    if id != "converted-covariance-by-jacobian" {
        return false;
    }
    let is_standard = matches!(
        setup.problem.measurement,
        Measurement::Converted {
            conversion: Conversion::Standard,
            ..
        }
    );
    // J R Jᵀ with J = ∂(r cos θ, r sin θ)/∂z
    if is_standard {
        setup.equations.converted_covariance = |problem, _, now| {
            let [r, b] = measured(problem, now);
            let jacobian =
                SMatrix::<T, M, M>::from_fn(|row, column| match (row, problem.measurement.reports(column)) {
                    (0, Some(PolarComponent::Range)) => T::cos(&b),
                    (_, Some(PolarComponent::Range)) => T::sin(&b),
                    (0, _) => -(r.clone() * T::sin(&b)),
                    _ => r.clone() * T::cos(&b),
                });
            &jacobian * &problem.measurement_noise * jacobian.transpose()
        }
    }
    true
}

/// The position.
fn of_measurement<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    let equations = &mut setup.equations;
    let entry = &mut equations.converted_measurement;
    match id {
        // (s_x + r sin θ, s_y + r cos θ): a bearing from the y-axis
        "converted-measurement-axes-exchanged" => {
            *entry = |problem, _, now| {
                let (position, sensor) = (position(problem, now), sensor(problem));
                let seen = position - &sensor;
                SVector::from_fn(|row, _| sensor[row].clone() + seen[M - 1 - row].clone())
            }
        }
        // (s_x + r cos θ, s_y − r sin θ): a bearing clockwise
        "converted-measurement-clockwise" => {
            *entry = |problem, _, now| {
                let (position, sensor) = (position(problem, now), sensor(problem));
                let seen = position - &sensor;
                SVector::from_fn(|row, _| {
                    let seen = seen[row].clone();
                    sensor[row].clone() + if row == 0 { seen } else { -seen }
                })
            }
        }
        // wrap(y^c − ŷ)
        "converted-innovation-wrapped" => {
            equations.innovation = |_, _, now, j| {
                let mut innovation = &now.converted_measurement - &now.predicted_measurements[j];
                innovation[M - 1] = wrap(innovation[M - 1].clone());
                innovation
            }
        }
        _ => return false,
    }
    true
}

/// Another conversion than the problem's: of the measurement and of its covariance.
fn of_conversion<T: Real, const N: usize, const M: usize>(id: &str, setup: &mut Setup<T, N, M>) -> bool {
    let Measurement::Converted { conversion, .. } = &mut setup.problem.measurement else {
        return false;
    };
    *conversion = match id {
        "conversion-not-debiased" => Conversion::Standard,
        "conversion-additive" => Conversion::Additive,
        "conversion-multiplicative" => Conversion::Multiplicative,
        "conversion-modified-unbiased" => Conversion::ModifiedUnbiased,
        _ => return false,
    };
    true
}

/// The usual converted measurement.
fn position<T: Real, const N: usize, const M: usize>(problem: &Problem<T, N, M>, now: &Step<T, N, M>) -> SVector<T, M> {
    match &now.measurement {
        Some(z) => converted_measurement(&problem.measurement, z, &problem.measurement_noise),
        None => SVector::from_fn(|_, _| T::undecided()),
    }
}

/// The usual covariance.
fn usual<T: Real, const N: usize, const M: usize>(problem: &Problem<T, N, M>, now: &Step<T, N, M>) -> SMatrix<T, M, M> {
    match &now.measurement {
        Some(z) => converted_covariance(&problem.measurement, z, &problem.measurement_noise),
        None => SMatrix::from_fn(|_, _| T::undecided()),
    }
}

/// The sensor's place.
fn sensor<T: Real, const N: usize, const M: usize>(problem: &Problem<T, N, M>) -> SVector<T, M> {
    match &problem.measurement {
        Measurement::Converted { sensor, .. } => SVector::from_fn(|row, _| sensor[row].clone()),
        _ => SVector::zeros(),
    }
}

/// Range and bearing as they were measured.
fn measured<T: Real, const N: usize, const M: usize>(problem: &Problem<T, N, M>, now: &Step<T, N, M>) -> [T; 2] {
    let places = problem.measurement.range_and_bearing();
    let both = now.measurement.as_ref().zip(places);
    both.map_or_else(
        || [T::undecided(), T::undecided()],
        |(z, places)| places.map(|row| z[row].clone()),
    )
}

/// σ_r² and σ_θ².
fn variances<T: Real, const N: usize, const M: usize>(problem: &Problem<T, N, M>) -> [T; 2] {
    let (places, noise) = (problem.measurement.range_and_bearing(), &problem.measurement_noise);
    places.map_or_else(
        || [T::undecided(), T::undecided()],
        |places| places.map(|row| noise[(row, row)].clone()),
    )
}
