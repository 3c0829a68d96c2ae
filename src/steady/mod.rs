//! The steady state: filters with settled gains, and whether their estimates stay bounded.
//!
//! This folder derives fixed gains and their effect on a target that moves otherwise, and decides when several such filters are stable
//! together while they mix their estimates.
//!
//! - [`gains`]: the closed forms of the α-β and α-β-γ filters;
//! - [`riccati`]: the Riccati equation, by recursion and by doubling, and the proof of its solution;
//! - [`reach`]: when there is none, and why;
//! - [`polynomial`], [`linear`]: stability of one matrix, and linear systems, without an eigenvalue;
//! - [`mismatch`]: what a filter with a fixed gain makes of a target that it does not model;
//! - [`long_term`], [`simulated`]: the long-term error of the IMM filter, predicted and simulated;
//! - [`perturbation`]: moment matching as a perturbation of fixed gains;
//! - [`unrolled`]: the recursion undone;
//! - [`pair`]: the two filters of derbez2000 and three criteria of their joint stability;
//! - [`certificate`]: what proves joint stability, or its absence;
//! - [`by_hand`]: the same in numbers that can be followed with pencil and paper;
//! - [`certificate_file`]: the same as files, which anyone can check;
//! - [`search`]: how such proofs are found;
//! - [`closed_loops`]: any filters, and how the question is decided;
//! - [`verdict`]: the two filters of derbez2000;
//! - [`map`]: the answers over a range of noises.

pub mod by_hand;
pub mod certificate;
pub mod certificate_file;
pub mod closed_loops;
pub mod gains;
pub mod linear;
pub mod long_term;
pub mod map;
pub mod mismatch;
pub mod pair;
pub mod perturbation;
pub mod polynomial;
pub mod reach;
pub mod riccati;
pub mod search;
pub mod simulated;
pub mod unrolled;
pub mod verdict;
