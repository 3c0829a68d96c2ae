//! From dimensions in a file to dimensions in types.
//!
//! After this file the reader knows for which numbers of states and measurements the oracle is built. The list is explicit, since each
//! shape is compiled in every number system.

use super::invalid::{Class, Invalid};

/// Something to be done for one shape.
pub trait Work {
    /// What it gives.
    type Output;

    /// Does it, for N entries of the state and M of the measurement.
    fn run<const N: usize, const M: usize>(self) -> Self::Output;
}

/// The shapes that exist.
pub const SHAPES: [(usize, usize); 9] = [(1, 1), (2, 1), (2, 2), (3, 1), (4, 1), (4, 2), (5, 2), (6, 2), (8, 2)];

/// Does the work for n entries of the state and m of the measurement.
///
/// # Errors
///
/// [`Invalid`] for a shape that is not in [`SHAPES`].
pub fn dispatch<W: Work>(n: usize, m: usize, work: W) -> Result<W::Output, Invalid> {
    Ok(match (n, m) {
        (1, 1) => work.run::<1, 1>(),
        (2, 1) => work.run::<2, 1>(),
        (2, 2) => work.run::<2, 2>(),
        (3, 1) => work.run::<3, 1>(),
        (4, 1) => work.run::<4, 1>(),
        (4, 2) => work.run::<4, 2>(),
        (5, 2) => work.run::<5, 2>(),
        (6, 2) => work.run::<6, 2>(),
        (8, 2) => work.run::<8, 2>(),
        _ => {
            let known: Vec<String> = SHAPES.iter().map(|(n, m)| format!("{n} and {m}")).collect();
            let reason = format!(
                "has {n} entries and R is {m} × {m}; this program is built for a state and a measurement of {}",
                known.join(", ")
            );
            return Err(Invalid::new(Class::Shape, "problem.state", reason));
        }
    })
}
