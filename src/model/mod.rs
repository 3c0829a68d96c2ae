//! The motion of the target and the measurement of the sensor.
//!
//! This folder derives the transition matrices and noise covariances of the papers' models ([`motion`], [`acceleration`] for one
//! coordinate with its acceleration, and [`wiener`] for two) and the two measurements ([`sensor`]). It shows how range and bearing become
//! a position ([`conversion`]), what that does to their noise ([`conversion_moments`]), when it can be trusted ([`conversion_validity`]),
//! and how angles behave at ±π ([`angle`]).
//!
//! ```text
//! state ─ F, Q of a mode ─▶ state a step later ─ h, R of the sensor ─▶ measurement ( ─ conversion ─▶ position and its covariance )
//! ```
//!
//! Reading order: [`motion`], [`sensor`] and [`angle`] are all that zhu2016 and liu2017 need; [`acceleration`] is derbez2000's target;
//! [`wiener`] and the three files of the conversion are sustika2015's.
//!
//! Models that no paper prints are data: [`space`] says what a vector is, [`formula`] reads functions from text, [`function`] is f or h of
//! either form, [`registry`] has the named models of `spec/models.toml`, and [`binding`] fits one to a state.
//!
//! State order is [x, ẋ, y, ẏ] in metres and metres per second, and in [`wiener`] [x, y, ẋ, ẏ, ẍ, ÿ]; turn rates are in radians per
//! second, positive to the left.
//!
//! Example: a straight target and a turning one, seen by the same radar after a second.
//!
//! ```
//! use immaculate::model::motion::{constant_velocity, turn_matrix};
//! use immaculate::model::{PolarComponent, Sensor};
//! use nalgebra::{U1, U4, vector};
//!
//! let range = Sensor::<f64, U4, U1>::Polar { components: vec![PolarComponent::Range], position: [0, 2], location: [0.0, 0.0] };
//! let state = vector![0.0, 3.0, 4.0, 0.0]; // [x, ẋ, y, ẏ]: 4 m to the north, eastward at 3 m/s
//! // Straight it is at (3, 4), √(3² + 4²) away.
//! assert_eq!(range.of(&(constant_velocity(&1.0) * state)), vector![5.0]);
//! // With a quarter turn to the left, sin ωT = 1 and cos ωT = 0 at 3 rad/s, at (1, 4 + 1): √(1² + 5²).
//! let third = 1.0 / 3.0; // sin ωT / ω and (1 − cos ωT)/ω
//! assert_eq!(range.of(&(turn_matrix(&third, &third, &1.0, &0.0) * state)), vector![26.0_f64.sqrt()]);
//! ```

pub mod acceleration;
pub mod angle;
#[cfg(feature = "oracle")]
pub mod binding;
pub mod conversion;
pub mod conversion_moments;
pub mod conversion_validity;
pub mod formula;
pub mod function;
pub mod motion;
pub mod nearest;
#[cfg(feature = "oracle")]
pub mod registry;
pub mod sensor;
pub mod space;
pub mod wiener;

pub use conversion::Conversion;
pub use sensor::{PolarComponent, Sensor};
