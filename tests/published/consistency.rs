//! The consistency of a filter: the squares of the innovation and of the error, in units of their covariances.
//!
//! Both are asked in whole steps; the error is asked only in steps whose true state is known.

use super::draft::Draft;
use super::extended;
use super::scene::{PLANE_TRACK, plane};
use immaculate::oracle::problem::{FORMAT_2, ProblemFile};

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    let of_heading = extended::all()
        .into_iter()
        .find(|problem| problem.id == "heading.extended")
        .expect("a problem of another file");
    vec![
        plane()
            .sees(&PLANE_TRACK[..4])
            .without(&[3])
            .with(|problem| problem.format = FORMAT_2.into())
            .truth_at(1, &[131.0, 10.5, -71.0, 13.4])
            .truth_at(3, &[154.0, 9.1, -40.0, 17.0])
            .truth_at(4, &[166.0, 12.2, -24.0, 15.1])
            .named(
                "consistency.kalman",
                &["sequence", "missed-detection", "transition-order", "full-correlation", "truth"],
                "Where the target is, is known in three of four steps, one of them without a detection: the squares of the modes' innovations \
                 and of the combined estimate's error, by which a filter is called consistent. R in place of S, variances alone and the \
                 covariance of another estimate show here.",
            ),
        Draft(of_heading)
            .truth_at(1, &[15.1, 3.2, 5.4, -3.02])
            .truth_at(2, &[10.0, 2.1, 5.8, -2.7])
            .truth_at(3, &[5.2, 0.9, 6.1, 3.1])
            .truth_at(5, &[-1.0, -1.8, 5.7, -2.2])
            .named(
                "consistency.heading",
                &["sequence", "missed-detection", "state-angle", "spread", "full-correlation", "formulas", "truth"],
                "The steps of heading.extended with true headings on the other side of the cut: the error of a heading is wrapped before it \
                 is squared.",
            ),
    ]
}

impl Draft {
    /// The true state in a step, counted from 1.
    fn truth_at(self, step: usize, truth: &[f64]) -> Self {
        self.with(|problem| problem.measurements[step - 1].truth = Some(truth.to_vec()))
    }
}
