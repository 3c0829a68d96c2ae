//! Statistics over many runs: errors, their uncertainty, consistency, and the delay of detection.
//!
//! Every figure of the reproduced tables is computed here, with the amount by which it would change if the runs were drawn again.
//!
//! - [`rmse`]: root-mean-square errors over runs and over time;
//! - [`fit_error`]: errors beside the path itself, in per cent;
//! - [`estimate`]: a figure with its standard error, and paired differences of two figures;
//! - [`consistency`]: normalised squared errors and their χ² bounds;
//! - [`delay`]: how long a change of motion goes unnoticed.

pub mod consistency;
pub mod delay;
pub mod estimate;
pub mod fit_error;
pub mod rmse;

pub use estimate::Estimate;
