//! One filter: prediction and update of a single Gaussian.
//!
//! These are the kinds of filter that run inside the interacting multiple model filter. All kinds that compute their gain share the last
//! three equations:
//!
//! ```text
//! kalman:    x̂, P ─ F, Q ─▶ predicted ─ H, R ─▶ ẑ, S, C ────────────────────────────┐
//! extended:  the same, with the Jacobians of f and h as F and H ────────────────────┼─▶ update
//! cubature:  x̂, P ─▶ points ─ f, Q ─▶ predicted ─▶ fresh points ─ h, R ─▶ ẑ, S, C ──┘
//! ```
//!
//! Reading order:
//!
//! - [`kind`]: which of these a filter is;
//! - [`kalman`]: the linear equations;
//! - [`correlated`]: the same where the noises of motion and measurement are correlated;
//! - [`extended`]: the same with the Jacobians of motion and measurement;
//! - [`iterated`]: the measurement relinearised at the updated estimate;
//! - [`cubature`]: the same moments by points and weights, in the centred form of liu2017;
//! - [`raw`]: the moments about the origin that zhu2016 prints, equal in exact arithmetic and poorer in floating point;
//! - [`update`]: gain, updated mean, updated covariance, for both;
//! - [`converted`]: range and bearing turned into a position, for the linear equations;
//! - [`fixed_gain`]: the linear equations of the mean alone, with gain and innovation covariance that are given.
//!
//! Example: one step by the linear equations and by two points, which are the same filter.
//!
//! ```
//! use immaculate::filter::{cubature, kalman, update};
//! use immaculate::{matrix::{cholesky, ldl}, model::Sensor};
//! use nalgebra::{matrix, vector};
//!
//! let (mean, covariance) = (vector![5.0], matrix![4.0]);
//! let (f, q, h, r) = (matrix![2.0], matrix![9.0], matrix![2.0], matrix![100.0]);
//!
//! let x = kalman::predicted_mean(&f, &mean); // 2 · 5
//! let p = kalman::predicted_covariance(&f, &covariance, &q); // 2 · 4 · 2 + 9
//! let s = kalman::innovation_covariance(&h, &p, &r); // 2 · 25 · 2 + 100
//! let w = update::gain(&kalman::cross_covariance(&p, &h), &ldl(&s)); // 25 · 2 / 200
//! assert_eq!((x, p, s, w), (vector![10.0], matrix![25.0], matrix![200.0], matrix![0.25]));
//! // 10 + ¼ · (24 − 20), 25 − ¼ · 200 · ¼
//! assert_eq!(update::updated_mean(&x, &w, &(vector![24.0] - h * x)), vector![11.0]);
//! assert_eq!(update::updated_covariance(&p, &w, &s), matrix![12.5]);
//!
//! // The two points of the third-degree rule in one dimension: ±1, half and half.
//! let (weights, sensor) = ([0.5, 0.5], Sensor::Linear(h));
//! let draw = |mean, covariance| {
//!     let root = cholesky(covariance).unwrap();
//!     [1.0, -1.0].map(|xi| cubature::point(&root, &vector![xi], mean))
//! };
//! // 2 · (5 ± 2)
//! let points = draw(&mean, &covariance).map(|x| cubature::propagated_point(&f, &x));
//! assert_eq!(cubature::weighted_mean(&weights, &points), x);
//! assert_eq!(cubature::weighted_covariance(&weights, &points, &x, &q), p);
//! let values = draw(&x, &p).map(|x| sensor.of(&x)); // 2 · (10 ± 5)
//! let z = vector![20.0];
//! assert_eq!(cubature::innovation_covariance(&sensor, &weights, &values, &z, &r), s);
//! ```

pub mod converted;
pub mod correlated;
pub mod cubature;
pub mod extended;
pub mod fixed_gain;
pub mod iterated;
pub mod kalman;
pub mod kind;
pub mod raw;
pub mod update;

pub use kind::{Filter, Transform, Update};
