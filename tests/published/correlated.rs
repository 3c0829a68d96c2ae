//! Correlated process and measurement noise.
//!
//! Two modes may have it and a third not. A missing entry removes its part of the correlation.

use super::draft::{Draft, rounded, rows};
use super::extended::extended;
use super::scene::{PLANE_TRACK, RADAR_TRACK, plane, radar};
use immaculate::oracle::problem::{FORMAT_2, ProblemFile};

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    let flags = [
        "sequence",
        "correlated-noise",
        "missed-detection",
        "missing-entry",
        "transition-order",
        "full-correlation",
    ];
    vec![
        plane()
            .sees(&PLANE_TRACK[..5])
            .without(&[2])
            .with(|problem| {
                problem.format = FORMAT_2.into();
                if let Some(z) = &mut problem.measurements[3].z {
                    z[0] = None;
                }
            })
            .shares_noise([11.0, 9.0])
            .named(
                "correlated.kalman",
                &flags,
                "Noise of the motion and of the measurement of the same step are correlated in two of three modes: the innovation covariance \
                 has H M and its transpose, the covariance of state and measurement M. One step has no detection, and one lacks an entry.",
            ),
        extended(radar("cubature-3"))
            .sees(&RADAR_TRACK[..4])
            .without(&[3])
            .with(|problem| {
                if let Some(z) = &mut problem.measurements[1].z {
                    z[1] = None;
                }
            })
            .shares_noise([9.0, 0.055])
            .named(
                "correlated.extended",
                &flags,
                "The same with range and bearing under extended filters, one of whose measurements is a range alone: M is seen through the \
                 Jacobian of the measurement.",
            ),
    ]
}

impl Draft {
    /// The first two of the plane's modes with M, from the deviations of the measurement.
    fn shares_noise(self, deviations: [f64; 2]) -> Self {
        let correlations = [
            [[0.25, -0.15], [0.12, 0.2], [-0.18, 0.3], [0.08, -0.12]],
            [[-0.2, 0.1], [0.22, 0.15], [0.1, -0.25], [0.16, 0.06]],
        ];
        self.with(|problem| {
            for (mode, correlations) in problem.modes.iter_mut().zip(correlations) {
                let mut shared = rows(correlations);
                for (i, row) in shared.iter_mut().enumerate() {
                    for (entry, deviation) in row.iter_mut().zip(deviations) {
                        *entry = rounded(*entry * mode.noise[i][i].sqrt() * deviation);
                    }
                }
                mode.models.noise_cross_covariance = Some(shared);
            }
        })
    }
}
