//! Long runs: carried from step to step, with more bits where something stays undecided.
//!
//! A run of more than a hundred steps is carried, [`carried`](super::carried), so that its time grows with its length and its bits hardly
//! at all. What cannot be carried to its end is left to enclosures alone.

use super::carried::{Numbers, Stopped, walk};
use super::certify::{FIRST_BITS, nearest_into};
use super::invalid::Invalid;
use super::problem::ProblemFile;
use super::trace::Trace;

/// The bits that are added where a value of a long run stays undecided.
const MORE_BITS: u32 = 64;

/// The bits of the last attempt to carry a long run: the set of its errors is in doubles, which end at 2⁻¹⁰⁷⁴.
pub(super) const MOST_BITS_CARRIED: u32 = 832;

/// Runs of more steps are carried, [`super::carried`]. The published ones are not longer.
pub(super) const LONGEST_PLAIN: usize = 100;

/// Whether a problem has too many steps for enclosures alone, which would need thousands of bits.
pub(super) fn is_long(problem: &ProblemFile) -> bool {
    problem.measurements.len() > LONGEST_PLAIN
}

/// A run that is carried.
pub(super) struct LongRun {
    /// The doubles so far.
    pub(super) trace: Trace,
    /// The width of the widest enclosure relative to its scale.
    pub(super) widest: f64,
    /// The bits of the last attempt.
    pub(super) bits: u32,
}

impl LongRun {
    pub(super) fn of(problem: &ProblemFile) -> Self {
        Self {
            trace: Trace::empty(&problem.dimensions()),
            widest: 0.0,
            bits: FIRST_BITS,
        }
    }

    /// Puts the doubles nearest to the exact numbers into the trace, as far as that goes.
    pub(super) fn carry(&mut self, problem: &ProblemFile) -> Result<Farthest, Invalid> {
        let (trace, widest) = (&mut self.trace, &mut self.widest);
        let farthest = carry(problem, FIRST_BITS, &mut |step, numbers| {
            let width = nearest_into(trace, problem, numbers, step - 1)?;
            *widest = if step == 1 { width } else { widest.max(width) };
            Ok(())
        })?;
        self.bits = farthest.bits;
        Ok(farthest)
    }
}

/// How far a run was carried.
pub(super) struct Farthest {
    pub(super) steps: usize,
    /// The bits of the last attempt.
    pub(super) bits: u32,
    /// Why not to the end.
    pub(super) stopped: Option<String>,
}

/// Carries a run as far as it goes, with 64 bits more where something stays undecided. `seen` is given the numbers of each step, again in
/// each attempt.
///
/// Where twice 64 more bits take it no further, something else than bits is missing: a convention or a comparison that cannot be carried.
pub(super) fn carry(
    problem: &ProblemFile,
    first_bits: u32,
    seen: &mut dyn FnMut(usize, &Numbers) -> Result<(), String>,
) -> Result<Farthest, Invalid> {
    let (mut farthest, mut in_vain, mut bits) = (0, 0, first_bits);
    loop {
        let mut steps = 0;
        let walked = walk(problem, bits, &mut |step, numbers| {
            seen(step, numbers)?;
            steps = step;
            Ok(())
        });
        in_vain = if steps > farthest { 0 } else { in_vain + 1 };
        farthest = farthest.max(steps);
        match walked {
            Err(Stopped::Invalid(invalid)) => return Err(invalid),
            Err(Stopped::Undecided(_)) if in_vain < 2 && bits < MOST_BITS_CARRIED => bits += MORE_BITS,
            Err(Stopped::Undecided(reason) | Stopped::Lost(reason)) => {
                return Ok(Farthest {
                    steps: farthest,
                    bits,
                    stopped: Some(reason),
                });
            }
            Ok(()) => {
                return Ok(Farthest {
                    steps: farthest,
                    bits,
                    stopped: None,
                });
            }
        }
    }
}
