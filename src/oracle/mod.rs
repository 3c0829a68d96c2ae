//! The oracle: certified cases, traces, and the judge of other filters.
//!
//! - [`shape`], [`setup`], [`run`]: from a file to a run in any number system.
//! - [`published`]: the problems of the certified cases.

pub mod invalid;
pub mod problem;
pub mod published;
pub mod run;
pub mod setup;
pub mod shape;
pub mod trace;
pub mod variant;
