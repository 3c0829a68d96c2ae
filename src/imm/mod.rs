//! The interacting multiple model filter: several filters that mix their estimates before every step.
//!
//! The whole cycle, in the order of evaluation:
//!
//! ```text
//! predicted mode probabilities   cⱼ = Σᵢ pᵢⱼ μᵢ                        [probability]
//! mixing probabilities           μᵢ∣ⱼ = pᵢⱼ μᵢ / cⱼ                    [probability]
//! mixed estimates                moments of the mixture                [crate::gaussian]
//! predicted, then updated        one filter a mode                     [crate::filter]
//! log-likelihoods                ln N(ν; 0, S)                         [crate::gaussian]
//! mode probabilities             μⱼ = Lⱼ cⱼ / Σᵢ Lᵢ cᵢ                [probability]
//! combined estimate              moments of the mixture                [crate::gaussian]
//! ```
//!
//! Reading order:
//!
//! - [`probability`]: the equations of the mode probabilities;
//! - [`continuous`]: the chain of a step of any length;
//! - [`problem`]: what a run is given, checked;
//! - [`record`]: every value of one step, and the table of those that are traced;
//! - [`row`]: what is known of each of these;
//! - [`equations`]: the table that says which equation gives each value; a variant of the filter exchanges entries of it;
//! - [`tables`]: some of these;
//! - [`update`]: the update of one mode, equation by equation;
//! - [`cycle`]: the one wiring that runs a table;
//! - [`plain`]: the cycle without a record;
//! - [`gpb2`]: the filter that follows every mode from every mode, and merges after the measurement;
//! - [`angles`]: what is averaged where an entry of the state is an angle;
//! - [`unequal`]: what is mixed where one mode has an entry of the state that another lacks;
//! - [`state_conversion`]: how modes whose states mean different things read each other;
//! - [`plain_bearing`]: bearings that are never wrapped;
//! - [`printed`]: what the papers print wrongly.
//!
//! Example: a whole step with two modes, value by value, is on the [front page](crate); [`Imm`] has one with one mode.

pub mod angles;
pub(crate) mod by_kind;
mod check;
mod check_states;
pub mod continuous;
pub mod cycle;
mod entries;
pub mod equations;
pub mod failure;
pub mod gpb2;
pub mod invalid;
pub mod observer;
pub mod plain;
pub mod plain_bearing;
pub mod printed;
pub mod probability;
pub mod problem;
pub mod record;
pub mod row;
pub mod state_conversion;
pub mod tables;
pub mod unequal;
pub mod update;

pub use cycle::Imm;
pub use equations::Equations;
pub use failure::{Cause, Failure};
pub use gpb2::Gpb2;
pub use invalid::InvalidProblem;
pub use observer::Observer;
pub use plain::PlainImm;
pub use problem::{Initial, Interaction, Problem};
pub use record::{Needs, Quantity, Step};
