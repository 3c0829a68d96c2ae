//! What is known of a traced value: its name, its sides, and what it needs.

#[cfg(doc)]
use super::Equations;

/// The number of rows or columns of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// One.
    One,
    /// n, the components of the state.
    State,
    /// m, the components of the measurement.
    Measurement,
    /// r, the modes.
    Modes,
}

impl Side {
    /// The number, for n, m and r.
    pub fn count(self, n: usize, m: usize, r: usize) -> usize {
        match self {
            Self::One => 1,
            Self::State => n,
            Self::Measurement => m,
            Self::Modes => r,
        }
    }
}

/// What must be there for a value to exist.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    /// A filter with covariances of the state.
    Covariances,
    /// A detection in this step.
    Detection,
    /// A filter that linearises the measurement more than once. No value needs it, but some are computed from more.
    Iterations,
    /// A run that computes how consistent it is: the standard equations do, [`Equations::without_consistency`] do not.
    Consistency,
    /// The true state in this step.
    Truth,
    /// A filter that converts measurements.
    Conversion,
    /// A filter that linearises the motion.
    LinearisedMotion,
    /// A filter that linearises the measurement.
    LinearisedMeasurement,
}

/// A row of the table: what is known of a traced value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Row {
    /// The name in traces, with a dot where the value is nested.
    pub name: &'static str,
    /// The printed equations that give it.
    pub equation: &'static str,
    /// Its rows.
    pub rows: Side,
    /// Its columns.
    pub columns: Side,
    /// Whether each mode has its own; otherwise it belongs to all together.
    pub is_of_mode: bool,
    /// What must be there for it to exist.
    pub needs: &'static [Needs],
}
