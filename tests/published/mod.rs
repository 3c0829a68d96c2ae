//! The problems of the certified cases, as they were drafted: what each is for, and which mistakes it is there to see. No two do the same
//! job. Most have generic numbers; where something is special, the flags and the purpose say so.
//!
//! - `draft`, `scene`: how a problem is written down, and the scenes that most are cut from;
//! - `equations`, `rules`: single equations, and each rule by itself;
//! - `steps`: whole steps, one and several, with nothing special;
//! - `chain`: the Markov chain, missed detections, outliers;
//! - `angles`: bearings around ±π, strong curvature, conventions;
//! - `numbers`: large positions, other units, singular covariances;
//! - `runs`: the papers' scenarios;
//! - `converted`: filters that convert their measurements, modes of unequal dimensions, and the scenario of the paper that has both;
//! - `fixed_gain`: filters whose gains are given, and the scenario of the paper that has them;
//! - `extended`: extended filters, several sensors, and steps that differ;
//! - `states`: modes with states of their own, and the conversions between them;
//! - `partial`: measurements of which an entry is missing, and what is exact in a direction;
//! - `behaviours`: for each kind of filter what it has in none of the others;
//! - `consistency`: the squares by which a filter is called consistent;
//! - `correlated`: process and measurement noise that have something in common;
//! - `iterated`: extended filters that linearise a measurement more than once;
//! - `pairs`: the common tracker, two modes of constant velocity;
//! - `continuous`: chains given by rates or mean sojourn times;
//! - `interaction`: modes that start from the combined estimate, or each from its own;
//! - `seen`: mixing and combination in steps that have a measurement;
//! - `rejected`: problems that must be refused;
//! - `write`: how a new case is certified, written and locked.

mod angles;
mod behaviours;
mod chain;
mod consistency;
mod continuous;
mod converted;
mod correlated;
mod draft;
mod equations;
mod extended;
mod fixed_gain;
mod interaction;
mod iterated;
mod numbers;
mod pairs;
mod partial;
mod rejected;
mod rules;
mod runs;
mod scene;
mod seen;
mod states;
mod steps;
pub mod write;

pub use rejected::Rejected;

use immaculate::oracle::problem::ProblemFile;

/// All problems that must be run, in the order in which a reader, or a new filter, meets them best: from single equations to runs.
pub fn all() -> Vec<ProblemFile> {
    [
        equations::all(),
        rules::all(),
        steps::all(),
        chain::all(),
        angles::all(),
        numbers::all(),
        runs::all(),
        fixed_gain::all(),
        converted::all(),
        extended::all(),
        partial::all(),
        behaviours::all(),
        consistency::all(),
        correlated::all(),
        iterated::all(),
        pairs::all(),
        seen::all(),
        states::all(),
        interaction::all(),
        continuous::all(),
    ]
    .concat()
}

/// All problems that must be refused, each with the class of the reason and the reason.
pub fn rejected() -> Vec<Rejected> {
    rejected::all()
}
