//! Immaculate: the executable specification of the interacting multiple model filter.
//!
//! The map, in reading order:
//!
//! | room           | what is in it                                                                            |
//! |----------------|------------------------------------------------------------------------------------------|
//! | [`number`]     | the number systems in which every equation is evaluated                                   |
//! | [`matrix`]     | Cholesky and L D Lᵀ, for every number system                                              |
//! | [`gaussian`]   | mean and covariance, density, moments of a mixture                                        |
//! | [`rule`]       | cubature rules in exact form, their moments and degrees                                   |
//! | [`model`]      | how the target moves, what the sensor sees                                                |
//! | [`filter`]     | one filter: Kalman, cubature, converted measurements, fixed gain                           |
//! | [`imm`]        | the cycle                                                                                 |
//! | [`steady`]     | steady gains, Riccati and Lyapunov equations, joint stability and its certificates         |
//! | [`oracle`]     | certified cases, traces, and the judge of other filters                                   |
//! | [`book`]       | every equation with its code, derivation, errata, tests, mistakes and cases               |
//!
//! Arrows run downwards: numbers know nothing, equations know numbers and matrices. Equations, filters and the cycle read no files,
//! draw no random numbers and print nothing.

pub mod book;
pub mod filter;
pub mod gaussian;
pub mod imm;
pub mod matrix;
pub mod model;
pub mod number;
pub mod oracle;
pub mod paper;
pub mod report;
pub mod rule;
pub mod statistics;
pub mod steady;

/// The README's example is run with the others.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
