//! How the target moves and what the sensor sees.
//!
//! After this folder the reader knows the transition matrices and noise covariances of the papers' models and where they come from
//! ([`motion`], [`acceleration`] for one coordinate with its acceleration, and [`wiener`] for two), the two measurements
//! ([`measurement`]), how range and bearing become a position ([`conversion`]), what that does to their noise ([`conversion_moments`])
//! and how far it can be trusted ([`conversion_validity`]), and what happens to angles at ±π ([`angle`]).
//!
//! State order is [x, ẋ, y, ẏ] in metres and metres per second, and in [`wiener`] [x, y, ẋ, ẏ, ẍ, ÿ]; turn rates are in radians per
//! second, positive to the left.

pub mod acceleration;
pub mod angle;
pub mod conversion;
pub mod conversion_moments;
pub mod conversion_validity;
pub mod measurement;
pub mod motion;
pub mod wiener;

pub use conversion::Conversion;
pub use measurement::{Measurement, PolarComponent};
