//! Problems that must be refused.
//!
//! There are one or two defects of each class. Each problem is a published one with exactly one thing wrong, so that a program can refuse
//! it only for that reason.

use super::converted::converted;
use super::draft::{Draft, seen};
use super::fixed_gain::plane_with_gains;
use super::scene::{plane, radar};
use immaculate::model::Conversion;
use immaculate::oracle::invalid::Class;
use immaculate::oracle::problem::{FilterFile, FixedGainFile, MeasurementFile, ProblemFile};

/// A problem, the class of the reason for which it must be refused, and the reason.
pub type Rejected = (ProblemFile, Class, &'static str);

/// The problems of this file.
pub fn all() -> Vec<Rejected> {
    [
        shapes(),
        probabilities(),
        covariances(),
        unknown(),
        fixed_gains(),
        conversions(),
    ]
    .concat()
}

/// step.n4-m2.two-modes with a change.
fn linear(id: &str, class: Class, reason: &'static str, change: impl FnOnce(&mut ProblemFile)) -> Rejected {
    refused(plane().keep(&[0, 1]), "step.n4-m2.two-modes", id, class, reason, change)
}

/// step.cubature-5 with a change.
fn polar(id: &str, class: Class, reason: &'static str, change: impl FnOnce(&mut ProblemFile)) -> Rejected {
    refused(radar("cubature-5"), "step.cubature-5", id, class, reason, change)
}

/// step.fixed-gain with a change of what is given, or of the reading.
fn fixed(
    id: &str,
    class: Class,
    reason: &'static str,
    change: impl FnOnce(&mut String, &mut Vec<FixedGainFile>),
) -> Rejected {
    let change = |problem: &mut ProblemFile| {
        if let FilterFile::FixedGain { mixing, modes } = &mut problem.filter {
            change(mixing, modes);
        }
    };
    refused(plane_with_gains("mixed"), "step.fixed-gain", id, class, reason, change)
}

/// converted.generic with a change.
fn convert(id: &str, class: Class, reason: &'static str, change: impl FnOnce(&mut ProblemFile)) -> Rejected {
    let about = format!("The problem converted.generic, but {reason}. It must be refused.");
    let draft = converted(Conversion::Standard, [9.0, 0.055]).with(change);
    (draft.named(id, &["rejected", "zeros"], &about), class, reason)
}

fn refused(
    draft: Draft,
    from: &str,
    id: &str,
    class: Class,
    reason: &'static str,
    change: impl FnOnce(&mut ProblemFile),
) -> Rejected {
    let about = format!("The problem {from}, but {reason}. It must be refused.");
    let problem = draft.with(change).named(id, &["rejected", "full-correlation"], &about);
    (problem, class, reason)
}

fn shapes() -> Vec<Rejected> {
    vec![
        linear(
            "rejected.shape.matrix",
            Class::Shape,
            "the last row of the first F has three entries where the state has four",
            |problem| problem.modes[0].transition[3].truncate(3),
        ),
        linear(
            "rejected.shape.measurement",
            Class::Shape,
            "the measurement has three entries where R is 2 x 2",
            |problem| problem.measurements[0].z = Some(seen(&[160.0, -35.0, 1.0])),
        ),
        linear(
            "rejected.shape.modes",
            Class::Shape,
            "there are three initial probabilities for two modes",
            |problem| problem.initial.mode_probabilities = vec![0.5, 0.3, 0.2],
        ),
    ]
}

fn probabilities() -> Vec<Rejected> {
    vec![
        linear(
            "rejected.probability.sum",
            Class::NotAProbability,
            "the first row of the transition matrix sums to 1.01",
            |problem| problem.transition[0] = vec![0.9, 0.11],
        ),
        linear(
            "rejected.probability.negative",
            Class::NotAProbability,
            "an initial probability is negative, although they sum to one",
            |problem| problem.initial.mode_probabilities = vec![1.25, -0.25],
        ),
    ]
}

fn covariances() -> Vec<Rejected> {
    vec![
        linear(
            "rejected.symmetric.initial",
            Class::NotSymmetric,
            "an initial covariance has one entry that its mirror image has not",
            |problem| {
                if let Some(covariance) = &mut problem.initial.modes[1].covariance {
                    covariance[0][2] += 0.5;
                }
            },
        ),
        linear(
            "rejected.symmetric.noise",
            Class::NotSymmetric,
            "R is not symmetric",
            |problem| problem.noise[1][0] = -29.7,
        ),
        linear(
            "rejected.definite.initial",
            Class::NotPositiveDefinite,
            "an initial covariance has a variance that is too small for its correlations",
            |problem| {
                if let Some(covariance) = &mut problem.initial.modes[0].covariance {
                    covariance[1][1] = 0.25;
                }
            },
        ),
        linear(
            "rejected.definite.process-noise",
            Class::NotPositiveDefinite,
            "the second Q has a negative variance",
            |problem| problem.modes[1].noise[3][3] = -0.81,
        ),
    ]
}

fn unknown() -> Vec<Rejected> {
    vec![
        polar(
            "rejected.unknown.rule",
            Class::Unknown,
            "its filter has the rule cubature-7, which does not exist",
            |problem| {
                problem.filter = FilterFile::Cubature {
                    rule: "cubature-7".to_owned(),
                };
            },
        ),
        polar(
            "rejected.unknown.component",
            Class::Unknown,
            "its second component is an elevation, which does not exist",
            |problem| {
                if let MeasurementFile::RangeBearing { components, .. } = &mut problem.measurement {
                    "elevation".clone_into(&mut components[1]);
                }
            },
        ),
        polar(
            "rejected.unknown.convention",
            Class::Unknown,
            "its square root is of a kind that does not exist",
            |problem| "by-guess".clone_into(&mut problem.conventions.square_root),
        ),
        polar(
            "rejected.angle.degrees",
            Class::Angle,
            "its bearing is in degrees",
            |problem| problem.measurements[0].z = Some(seen(&[207.0, -23.5])),
        ),
    ]
}

fn fixed_gains() -> Vec<Rejected> {
    vec![
        fixed(
            "rejected.shape.gain",
            Class::Shape,
            "the second gain has two rows of four entries where four of two are needed",
            |_, modes| modes[1].gain = vec![vec![0.316, 0.181, -0.077, 0.009], vec![0.1, -0.013, 0.586, 0.158]],
        ),
        fixed(
            "rejected.shape.fixed-gains",
            Class::Shape,
            "there are gains for two of three modes",
            |_, modes| modes.truncate(2),
        ),
        fixed(
            "rejected.symmetric.innovation",
            Class::NotSymmetric,
            "the last innovation covariance is not symmetric",
            |_, modes| modes[2].innovation_covariance[0][1] = 34.0,
        ),
        fixed(
            "rejected.definite.innovation",
            Class::NotPositiveDefinite,
            "the first innovation covariance has a variance that is too small for its covariance",
            |_, modes| modes[0].innovation_covariance[1][1] = 6.0,
        ),
        fixed(
            "rejected.unknown.mixing",
            Class::Unknown,
            "its reading of the update, half-mixed, does not exist",
            |mixing, _| "half-mixed".clone_into(mixing),
        ),
        refused(
            plane_with_gains("mixed"),
            "step.fixed-gain",
            "rejected.format.covariance",
            Class::Format,
            "an estimate has a covariance, which filters with fixed gains do not have",
            |problem| problem.initial.modes[0] = plane().0.initial.modes[0].clone(),
        ),
    ]
}

fn conversions() -> Vec<Rejected> {
    vec![
        convert(
            "rejected.range.negative",
            Class::Range,
            "its range is negative",
            |problem| problem.measurements[0].z = Some(seen(&[-207.0, -0.41])),
        ),
        convert(
            "rejected.unknown.conversion",
            Class::Unknown,
            "its conversion, by-guess, does not exist",
            |problem| {
                problem.filter = FilterFile::Converted {
                    conversion: "by-guess".to_owned(),
                };
            },
        ),
    ]
}
