//! The steady state: filters whose gains have settled, and whether what they compute stays bounded.
//!
//! After this folder the reader knows where fixed gains come from, what they do to a target that moves otherwise, and when several
//! such filters that exchange their estimates are stable together.
//!
//! - [`gains`]: the closed forms of the α-β and α-β-γ filters;
//! - [`riccati`]: the Riccati equation, by recursion and by doubling, and the proof of its solution;
//! - [`reach`]: when there is none, and why;
//! - [`polynomial`], [`linear`]: stability of one matrix, and linear systems, without an eigenvalue.

pub mod gains;
pub mod linear;
pub mod polynomial;
pub mod reach;
pub mod riccati;
