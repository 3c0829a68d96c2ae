//! Iterated extended filters: the measurement is linearised where the estimate turns out to be.
//!
//! One mode's filter may iterate while others do not. Iteration matters most for strong curvature.

use super::draft::{Draft, covariance};
use super::extended::extended;
use super::scene::{RADAR_TRACK, buoy, radar};
use immaculate::oracle::problem::{FilterFile, ProblemFile};
use std::num::NonZeroUsize;

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    let of = |times| FilterFile::Extended {
        iterations: NonZeroUsize::new(times),
    };
    let iterated = |draft: Draft, times| extended(draft).filter(of(times));
    vec![
        iterated(buoy(), 4)
            .with(|problem| {
                problem.initial.modes[0].covariance = Some(covariance(&[19.0, 16.0], &[0.45]));
                problem.noise = covariance(&[2.0, 0.03], &[-0.25]);
            })
            .named(
                "extended.iterated.one-mode",
                &["single-step", "one-mode", "curved", "full-correlation"],
                "A target near the sensor that is hardly known: the slopes of range and bearing where it was expected are far from those where \
                 it is. Four linearisations; predicted measurement, innovation and covariances are those of the last one.",
            ),
        iterated(radar("cubature-3"), 3)
            .with(|problem| problem.modes[1].models.filter = Some(of(2)))
            .with(|problem| {
                problem.modes[2].models.filter = Some(FilterFile::Extended { iterations: None });
            })
            .sees(&RADAR_TRACK[..4])
            .without(&[2])
            .with(|problem| {
                if let Some(z) = &mut problem.measurements[2].z {
                    z[0] = None;
                }
            })
            .named(
                "extended.iterated.generic",
                &["sequence", "missed-detection", "missing-entry", "spread", "transition-order", "full-correlation"],
                "Three linearisations in one mode, two in another and one in the third: the likelihood of each is that of its own last \
                 linearisation. One step has no detection, and one is a bearing alone.",
            ),
    ]
}
