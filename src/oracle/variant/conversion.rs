//! Variants of converted measurements: the converted position and its covariance.
//!
//! A conversion can go wrong by its axes, its signs, its noise, or its debiasing.

use super::super::setup::Setup;
use super::used;
use crate::filter::Update;
use crate::filter::converted::{converted_covariance, converted_measurement};
use crate::imm::Problem;
use crate::model::angle::wrap;
use crate::model::conversion_moments::attenuation;
use crate::model::{Conversion, PolarComponent, Sensor};
use crate::number::Real;
use nalgebra::{DMatrix, DVector, Dyn};

/// Applies a variant of converted measurements; whether it is one. On other filters they change nothing.
pub(super) fn apply<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    if setup.problem.conversion().is_none() {
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
fn of_covariance<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let entry = &mut setup.equations.converted_covariance;
    match id {
        // diag(a, b): the variances along and across the line of sight, taken for those of x and y
        "converted-covariance-not-rotated" => {
            *entry = |problem, z, _, _| {
                let ([range_variance, bearing_variance], [range, _]) = (variances(problem)?, measured(problem, z)?);
                let squared_range = range.clone() * range;
                let w = attenuation(&bearing_variance);
                let variances = problem
                    .conversion()?
                    .variances(&squared_range, &range_variance, &bearing_variance, &w);
                Some(DMatrix::from_diagonal(&DVector::from_row_slice(&variances)))
            }
        }
        // diag(σ_r², σ_θ²): R as it is
        "converted-covariance-of-polar-noise" => *entry = |problem, _, _, _| Some(problem.measurement_noise.clone()),
        // −σ_xy
        "converted-covariance-cross-term-of-other-sign" => {
            *entry = |problem, z, _, _| {
                let turned = |row, column, entry: T| if row == column { entry } else { -entry };
                Some(usual(problem, z)?.map_with_location(turned))
            }
        }
        // 0 for σ_xy
        "converted-covariance-cross-term-omitted" => {
            *entry = |problem, z, _, _| Some(super::diagonal(&usual(problem, z)?, T::clone));
        }
        // σ_y² for σ_x² and the other way round
        "converted-covariance-axes-exchanged" => {
            *entry = |problem, z, _, _| {
                let usual = usual(problem, z)?;
                let last = usual.nrows() - 1;
                Some(usual.map_with_location(|row, column, _| usual[(last - row, last - column)].clone()))
            }
        }
        // r σ_θ² for r² σ_θ²: the variance of the bearing divided by the range before the usual equations see it
        "converted-covariance-range-not-squared" => {
            *entry = |problem, z, _, _| {
                let [range, _] = measured(problem, z)?;
                let mut noise = problem.measurement_noise.clone();
                for row in
                    (0..noise.nrows()).filter(|&row| problem.sensor.reports(row) == Some(PolarComponent::Bearing))
                {
                    noise[(row, row)] /= range.clone();
                }
                converted_covariance(problem.conversion()?, &problem.sensor, z, &noise)
            }
        }
        _ => return false,
    }
    true
}

/// Other algebra for the covariance of the standard conversion.
fn of_form<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    if id != "converted-covariance-by-jacobian" {
        return false;
    }
    let is_standard = setup.problem.conversion() == Some(Conversion::Standard);
    // J R Jᵀ with J = ∂(r cos θ, r sin θ)/∂z
    if is_standard {
        setup.equations.converted_covariance = |problem, z, _, _| {
            let [r, b] = measured(problem, z)?;
            let slope = |row, column| match (row, problem.sensor.reports(column)) {
                (0, Some(PolarComponent::Range)) => T::cos(&b),
                (_, Some(PolarComponent::Range)) => T::sin(&b),
                (0, _) => -(r.clone() * T::sin(&b)),
                _ => r.clone() * T::cos(&b),
            };
            let jacobian = DMatrix::from_fn(2, problem.m().0, slope);
            Some(&jacobian * &problem.measurement_noise * jacobian.transpose())
        }
    }
    true
}

/// The position.
fn of_measurement<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let equations = &mut setup.equations;
    let entry = &mut equations.converted_measurement;
    match id {
        // (s_x + r sin θ, s_y + r cos θ): a bearing from the y-axis
        "converted-measurement-axes-exchanged" => {
            *entry = |problem, z, _, _| {
                let (position, sensor) = (position(problem, z)?, location(problem)?);
                let seen = position - &sensor;
                let last = seen.len() - 1;
                let exchanged = |row: usize| sensor[row].clone() + seen[last - row].clone();
                Some(DVector::from_fn(seen.len(), |row, _| exchanged(row)))
            }
        }
        // (s_x + r cos θ, s_y − r sin θ): a bearing clockwise
        "converted-measurement-clockwise" => {
            *entry = |problem, z, _, _| {
                let (position, sensor) = (position(problem, z)?, location(problem)?);
                let mirrored = |row: usize| {
                    if row == 0 {
                        position[row].clone()
                    } else {
                        sensor[row].clone() * T::integer(2) - position[row].clone()
                    }
                };
                Some(DVector::from_fn(position.len(), |row, _| mirrored(row)))
            }
        }
        // wrap(y^c − ŷ)
        "converted-innovation-wrapped" => {
            equations.innovation = |problem, z, now, j| {
                let mut innovation = used(problem, z, now, j) - &now.predicted_measurements[j];
                let last = innovation.len() - 1;
                innovation[last] = wrap(innovation[last].clone());
                innovation
            }
        }
        _ => return false,
    }
    true
}

/// Another conversion than the problem's: of the measurement and of its covariance.
fn of_conversion<T: Real>(id: &str, setup: &mut Setup<T>) -> bool {
    let other = match id {
        "conversion-not-debiased" => Conversion::Standard,
        "conversion-additive" => Conversion::Additive,
        "conversion-multiplicative" => Conversion::Multiplicative,
        "conversion-modified-unbiased" => Conversion::ModifiedUnbiased,
        _ => return false,
    };
    for filter in &mut setup.problem.filters {
        if let Update::Converted(conversion) = &mut filter.update {
            *conversion = other;
        }
    }
    true
}

/// The usual converted measurement.
fn position<T: Real>(problem: &Problem<T, Dyn, Dyn>, z: &DVector<T>) -> Option<DVector<T>> {
    converted_measurement(problem.conversion()?, &problem.sensor, z, &problem.measurement_noise)
}

/// The usual covariance.
fn usual<T: Real>(problem: &Problem<T, Dyn, Dyn>, z: &DVector<T>) -> Option<DMatrix<T>> {
    converted_covariance(problem.conversion()?, &problem.sensor, z, &problem.measurement_noise)
}

/// Where the sensor stands.
fn location<T: Real>(problem: &Problem<T, Dyn, Dyn>) -> Option<DVector<T>> {
    match &problem.sensor {
        Sensor::Polar { location, .. } => Some(DVector::from_row_slice(location)),
        Sensor::Linear(_) | Sensor::Function { .. } => None,
    }
}

/// Range and bearing as they were measured.
fn measured<T: Real>(problem: &Problem<T, Dyn, Dyn>, z: &DVector<T>) -> Option<[T; 2]> {
    let places = problem.sensor.range_and_bearing()?;
    Some(places.map(|row| z[row].clone()))
}

/// σ_r² and σ_θ².
fn variances<T: Real>(problem: &Problem<T, Dyn, Dyn>) -> Option<[T; 2]> {
    let places = problem.sensor.range_and_bearing()?;
    Some(places.map(|row| problem.measurement_noise[(row, row)].clone()))
}
