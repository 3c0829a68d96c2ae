//! Who is timed.

use crate::scenario::{MODES, Sensor};
use nalgebra::{Vector2, Vector4};

/// Runs all measurements from the start; gives the seconds of the steps alone, and what came out.
pub type Run = Box<dyn FnMut(&[Vector2<f64>]) -> (f64, Outcome)>;

/// What a run ends with.
#[derive(Clone, Copy)]
pub struct Outcome {
    pub mode_probabilities: [f64; MODES],
    pub mean: Vector4<f64>,
}

/// The filter that all contenders of a row are.
#[derive(Clone, Copy, PartialEq)]
pub enum Task {
    Kalman,
    Cubature3,
    /// With κ = 1, since some competitors have only κ ≥ 0.
    Unscented,
    Cubature5,
}

impl Task {
    pub const ALL: [Self; 4] = [Self::Kalman, Self::Cubature3, Self::Unscented, Self::Cubature5];

    pub fn name(self) -> &'static str {
        match self {
            Self::Kalman => "Kalman, position",
            Self::Cubature3 => "third-degree cubature, range and bearing",
            Self::Unscented => "unscented, range and bearing",
            Self::Cubature5 => "fifth-degree cubature, range and bearing",
        }
    }

    pub fn sensor(self) -> Sensor {
        match self {
            Self::Kalman => Sensor::Position,
            _ => Sensor::RangeBearing,
        }
    }
}

/// One implementation of one task.
pub struct Contender {
    pub name: &'static str,
    pub run: Run,
}
