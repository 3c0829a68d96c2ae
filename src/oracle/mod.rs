//! The oracle: certified cases, traces, and the judge of other filters.
//!
//! After this folder the reader knows how a filter in any language is told that it is right to so many digits, or wrong in this equation,
//! at this step, and most likely because of this.
//!
//! ```text
//! problem file ─▶ setup ─▶ run in enclosures ─▶ certified trace ─┐
//!            └──▶ program under test ─▶ answer ──────────────────┴─▶ judge ─▶ diagnose ─▶ report
//!                                          └─▶ run along its own values ─┘        └─ variants
//! ```
//!
//! - [`problem`] and its checks, [`trace`], [`csv`], [`schema`], [`invalid`]: the file formats;
//! - [`shape`], [`setup`], [`run`]: from a file to a run in any number system, by itself or along another program's values;
//! - [`certify`], [`noise`], [`scale`]: the exact values, how far rounding moves them, and in which unit an error is large;
//! - [`case`]: the published cases; [`certificate`]: certificates of joint stability as files;
//! - [`subject`], [`process`], [`folder`]: the program under test; [`answer`]: the other side of the protocol;
//! - [`judge`]: one case; [`variant`]: the catalogue of what can be done otherwise; [`diagnose`]: what was done; [`check`]: all cases.

pub mod answer;
pub mod case;
pub mod certificate;
pub mod certify;
pub mod check;
pub mod csv;
pub mod diagnose;
pub mod folder;
pub mod invalid;
pub mod judge;
pub mod noise;
pub mod problem;
pub mod process;
pub mod published;
pub mod run;
pub mod scale;
pub mod schema;
pub mod setup;
pub mod shape;
pub mod subject;
pub mod trace;
mod unreadable;
pub mod variant;
mod well_formed;
