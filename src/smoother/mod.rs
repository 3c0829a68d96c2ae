//! Smoothers: the state of a past step, given what was measured later.
//!
//! A filter says where the target is, a smoother where it was. It goes back through the steps of a run, of one filter or of several that
//! switch:
//!
//! ```text
//! forward      Imm::step ─▶ step 0, 1, …, K, recorded
//! back         step K is the filter's own ─▶ K−1 ─▶ … ─▶ 0
//! ```
//!
//! Reading order:
//!
//! - [`rauch_tung_striebel`]: one step back, for every kind of filter;
//! - [`switching`]: the same among modes;
//! - [`recording`]: the run, and the way back: over a fixed interval, or with a fixed lag;
//! - [`unsmoothable`]: why a run cannot be smoothed.
//!
//! What is exact. One linear mode: the estimate is the Gaussian of the state given all measurements, the solution of least squares. One
//! mode with another filter is as good as its filter. Several modes of which none ever changes are smoothed each by itself, and weighed by
//! Bayes' rule; several that are the same are one. One step back to a mode that is known is Bayes' rule, too.
//!
//! Everything else is approximate: what is a mixture in truth is one Gaussian a mode, as in the filter, and the smoothed estimate of the
//! later mode is taken for that of each pair. Even a step without a detection moves the modes before it a little.
//!
//! The measurements are not needed again: what they say is in the updated estimates. Process and measurement noise must be independent, and
//! the modes share one state.
//!
//! Example: a run with one mode is at [`Recording`].

pub mod rauch_tung_striebel;
pub mod recording;
pub mod switching;
pub mod unsmoothable;

pub use recording::{Recording, SmoothedStep};
pub use switching::SwitchingSmoother;
pub use unsmoothable::Unsmoothable;
