//! One filter: prediction and update of a single Gaussian.
//!
//! After this folder the reader knows the kinds of filter that run inside the interacting multiple model filter, and that the first two
//! share their last three equations:
//!
//! ```text
//! kalman:    x̂, P ─ F, Q ─▶ predicted ─ H, R ─▶ ẑ, S, C ─┐
//!                                                        ├─▶ gain ─▶ updated mean, updated covariance
//! cubature:  x̂, P ─▶ points ─ f, Q ─▶ predicted ─▶ fresh points ─ h, R ─▶ ẑ, S, C ─┘
//! ```
//!
//! - [`kalman`]: the linear equations;
//! - [`cubature`]: the same moments by points and weights, in the centred form of liu2017;
//! - [`raw`]: the moments about the origin that zhu2016 prints, equal in exact arithmetic and poorer in floating point;
//! - [`update`]: gain, updated mean, updated covariance, for both;
//! - [`converted`]: range and bearing turned into a position, for the linear equations;
//! - [`fixed_gain`]: the linear equations of the mean alone, with gain and innovation covariance that are given.

pub mod converted;
pub mod cubature;
pub mod fixed_gain;
pub mod kalman;
pub mod raw;
pub mod update;
