//! The oracle: certified cases, traces, and the judge of other filters.
//!
//! A filter in any language learns that it is right and to how many digits, or which equation is wrong, at which step, and most likely
//! why.
//!
//! ```text
//! problem file ─▶ setup ─▶ run in enclosures ─▶ certified trace ─┐
//!            └──▶ program under test ─▶ answer ──────────────────┴─▶ judge ─▶ diagnose ─▶ report
//!                                          └─▶ run along its own values ─┘        └─ variants
//! ```
//!
//! # How a case is made
//!
//! A [`problem`] is a file of short decimals, checked before it is run; [`flags`] has the words by which the published ones are marked.
//! [`setup`] puts its numbers into any number system, and [`run`] runs it there: by itself, or along
//! another program's values. [`trace`] is what comes out, under the names of the file format; [`csv`] says the same in a long table,
//! [`schema`] describes the files, and [`invalid`] has the sentence for each file that is refused.
//!
//! # How it is certified
//!
//! [`certify`] runs the problem on enclosures, with more and more bits, until one double is the nearest to all that each enclosure holds.
//! A run of more than a hundred steps is carried from step to step by an exact midpoint and an [`ellipsoid`] of errors.
//! Beside each value stand its unit, [`scale`], and how far rounding alone moves it, [`noise`]. [`case`](mod@case) keeps the files and the
//! lock of their digests: a published case never changes.
//!
//! # How a program is asked
//!
//! [`subject`] has the trait that a program under test is seen by. A filter in Rust implements it; [`process`] is one in any other
//! language, started once and spoken to in JSON lines; [`folder`] reads answers that were written to files; [`answer`] is the other side
//! of the protocol.
//!
//! # How it is judged
//!
//! [`judge`] compares each shown value with the certified one and, if it is off, with its own equation on the program's own earlier
//! values: what these explain was inherited, and what they do not explain is a fault. [`variant`] is the catalogue of what can be done
//! otherwise, and [`diagnose`] finds which of it was done. [`observation`] is what is seen in the answers as a whole.
//! [`check`](mod@check) does all of this over all cases:
//!
//! ```
//! use immaculate::oracle::check::{Selection, check};
//! use immaculate::oracle::subject::{Level, Planted};
//!
//! // A program under test: this crate's own filter, which shows everything. Yours implements `Subject` instead.
//! let mut program = Planted { variants: vec![], level: Level::Everything };
//! let case = Selection { ids: vec!["step.n4-m2.two-modes".into()], ..Selection::default() };
//! let report = check(&mut program, &case, &|_| {})?;
//! assert!(!report.is_wrong());
//!
//! // The same filter with the transition matrix read by columns: the first equation that uses it is at fault.
//! program.variants.push("transition-transposed".into());
//! let report = check(&mut program, &case, &|_| {})?;
//! let (_, judged) = report.faults().next().unwrap();
//! assert_eq!(judged.place.1.name(), "predicted_mode_probabilities");
//! println!("{}", immaculate::report::check::text(&report));
//! # Ok::<(), immaculate::oracle::check::NotMade>(())
//! ```

mod again;
mod alike;
pub mod answer;
pub mod behaviour;
mod bound;
mod carried;
pub mod case;
pub mod certify;
pub mod chain;
pub mod check;
mod conventions;
pub mod csv;
pub mod diagnose;
mod digits;
pub mod ellipsoid;
mod evidence;
mod filter_file;
pub mod flags;
pub mod folder;
pub mod formula;
pub mod invalid;
mod json;
pub mod judge;
mod long_run;
pub mod models;
pub mod noise;
pub mod observation;
mod pipes;
pub mod problem;
pub mod process;
mod reference;
pub mod run;
pub mod scale;
pub mod schema;
pub mod search;
pub mod setup;
mod shown_as;
mod single;
mod single_input;
pub mod state_conversions;
mod steps;
pub mod subject;
mod symmetry;
pub mod trace;
mod unreadable;
pub mod variant;
pub mod verdict;
mod well_formed;
