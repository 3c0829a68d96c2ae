//! The numbers of a problem by their role, which decides how they may be changed.
//!
//! One walk through the file changes and simplifies a problem.

use crate::oracle::models::{ModelParameters, NoiseFile};
use crate::oracle::problem::{FilterFile, MeasurementAt, MeasurementFile, ModeFile, ProblemFile, Rows};

/// Numbers of a problem.
pub(super) enum Place<'a> {
    /// F.
    Motion(&'a mut Rows),
    /// H, or a gain.
    Map(&'a mut Rows),
    /// A symmetric matrix.
    Covariance(&'a mut Rows),
    /// Rows that sum to one.
    Chain(&'a mut Rows),
    /// Numbers that sum to one.
    Probabilities(&'a mut Vec<f64>),
    /// The mean of an estimate.
    Mean(&'a mut Vec<f64>),
    /// z.
    Measured(&'a mut Vec<Option<f64>>),
    /// Where a sensor stands.
    Coordinate(&'a mut f64),
    /// A parameter, or the length of a step.
    Parameter(&'a mut f64),
}

/// All of them, in the order of the file.
pub(super) fn places(problem: &mut ProblemFile) -> Vec<Place<'_>> {
    let mut places = Vec::new();
    parameters(&mut problem.parameters, &mut places);
    for mode in &mut problem.modes {
        of_mode(mode, &mut places);
    }
    measurement(&mut problem.measurement, &mut places);
    places.push(Place::Covariance(&mut problem.noise));
    for sensor in &mut problem.sensors {
        measurement(&mut sensor.measurement, &mut places);
        places.push(Place::Covariance(&mut sensor.noise));
    }
    if let FilterFile::FixedGain { modes, .. } = &mut problem.filter {
        for mode in modes {
            places.push(Place::Map(&mut mode.gain));
            places.push(Place::Covariance(&mut mode.innovation_covariance));
        }
    }
    places.push(Place::Chain(&mut problem.transition));
    places.push(Place::Probabilities(&mut problem.initial.mode_probabilities));
    for estimate in &mut problem.initial.modes {
        places.push(Place::Mean(&mut estimate.mean));
        places.extend(estimate.covariance.as_mut().map(Place::Covariance));
    }
    for entry in &mut problem.measurements {
        of_step(entry, &mut places);
    }
    places
}

fn parameters<'a>(of: &'a mut ModelParameters, places: &mut Vec<Place<'a>>) {
    places.extend(of.0.iter_mut().map(|(_, value)| Place::Parameter(value)));
}

fn of_mode<'a>(mode: &'a mut ModeFile, places: &mut Vec<Place<'a>>) {
    let models = &mut mode.models;
    parameters(&mut models.parameters, places);
    match &mut models.motion {
        Some(motion) => parameters(&mut motion.parameters, places),
        None if models.formulas.is_none() => places.push(Place::Motion(&mut mode.transition)),
        None => {}
    }
    match &mut models.noise {
        Some(NoiseFile::Model(model)) => parameters(&mut model.parameters, places),
        Some(_) => {}
        None => places.push(Place::Covariance(&mut mode.noise)),
    }
    places.extend(models.noise_cross_covariance.as_mut().map(Place::Map));
}

fn measurement<'a>(of: &'a mut MeasurementFile, places: &mut Vec<Place<'a>>) {
    match of {
        MeasurementFile::Linear { matrix } => places.push(Place::Map(matrix)),
        MeasurementFile::RangeBearing { sensor, .. } => places.extend(sensor.iter_mut().map(Place::Coordinate)),
        MeasurementFile::Model { parameters: own, .. } => parameters(own, places),
        MeasurementFile::Formulas { .. } => {}
    }
}

fn of_step<'a>(entry: &'a mut MeasurementAt, places: &mut Vec<Place<'a>>) {
    places.extend(entry.z.as_mut().map(Place::Measured));
    places.extend(entry.interval.as_mut().map(Place::Parameter));
    places.extend(entry.transitions.iter_mut().flatten().map(Place::Motion));
    places.extend(entry.noises.iter_mut().flatten().map(Place::Covariance));
    places.extend(entry.matrix.as_mut().map(Place::Map));
    places.extend(entry.noise.as_mut().map(Place::Covariance));
    places.extend(entry.transition.as_mut().map(Place::Chain));
    places.extend(entry.truth.as_mut().map(Place::Mean));
}
