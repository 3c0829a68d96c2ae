//! `immaculate stability --problem FILE`: are the fixed-gain filters of a problem file stable together?
//!
//! A problem has an answer if its filters do the same linear arithmetic at every step.

use super::{Done, Refusal, json_text, read_file};
use immaculate::filter::Update;
use immaculate::imm::Interaction;
use immaculate::model::Sensor;
use immaculate::model::motion::Motion;
use immaculate::number::Enclosure;
use immaculate::oracle::problem::{FilterFile, ProblemFile};
use immaculate::report::stability_bank::{self, Bank, BankAnswer};
use immaculate::steady::closed_loops::{BITS, ClosedLoops, Depth, Entries};
use immaculate::steady::riccati::closed_loop;
use nalgebra::{DMatrix, Dyn};
use std::path::Path;

type Problem = immaculate::imm::Problem<Enclosure, Dyn, Dyn>;

/// The answer about the filters of a file.
pub fn run(path: &Path, depth: Depth, json: bool) -> Result<Done, Refusal> {
    let named = |reason: &dyn std::fmt::Display| Refusal::Request(format!("{}: {reason}", path.display()));
    let problem = ProblemFile::read(&read_file(path)?).map_err(|error| named(&error))?;
    let bank = Enclosure::with_precision(BITS, || bank(&problem)).map_err(|reason| named(&reason))?;
    let answer = BankAnswer::new(bank, depth);
    Ok(if json {
        json_text(&stability_bank::json(&answer)).into()
    } else {
        stability_bank::text(&answer).into()
    })
}

/// The filters of a problem, or why they are not such whose stability can be asked.
fn bank(file: &ProblemFile) -> Result<Bank, String> {
    let FilterFile::FixedGain { .. } = file.filter else {
        return Err(format!(
            "`filter` is {}: the question is about filters with fixed gains; give \"kind\": \"fixed-gain\" and the gains that yours settle to",
            file.filter.name()
        ));
    };
    let setup = file.setup(Enclosure::exact).map_err(|error| error.to_string())?;
    let problem = &setup.problem;
    if !problem.angles.is_empty()
        || file
            .sensors_at()
            .iter()
            .any(|sensor| file.angles_of(sensor).contains(&true))
    {
        return Err("has an angle, and a difference of angles is no linear function of errors: without `angles` the answer is one about small \
                    errors"
            .to_owned());
    }
    for (step, changed) in &setup.changes {
        let is_same = motions(changed)? == motions(problem)?
            && seen(changed)? == seen(problem)?
            && changed.chain == problem.chain;
        if !is_same {
            return Err(format!(
                "step {step} of `measurements` has a motion, a measurement matrix or a transition matrix of its own: ask about one set of matrices, and \
                 leave it out"
            ));
        }
    }
    let (motions, h) = (motions(problem)?, seen(problem)?);
    let count = problem.modes.len();
    let loops = (0..count).map(|j| {
        let Update::Given(fixed) = &problem.filters[j % problem.filters.len()].update else {
            return Err(format!("`modes[{j}]` has no gain"));
        };
        Ok(closed_loop(&fixed.gain, &h, &motions[j]))
    });
    let is_mixed = !matches!(problem.interaction, Interaction::Unmixed);
    let follows = |i: usize, j: usize| {
        if is_mixed {
            problem.chain[i][j] > Enclosure::exact(0.0)
        } else {
            i == j
        }
    };
    Ok(Bank {
        about: file.about.clone(),
        names: file.modes.iter().map(|mode| mode.name.clone()).collect(),
        is_mixed,
        loops: ClosedLoops {
            matrices: Entries::Enclosed(loops.collect::<Result<_, _>>()?),
            follows: (0..count)
                .map(|i| (0..count).map(|j| follows(i, j)).collect())
                .collect(),
        },
    })
}

/// F of each mode.
fn motions(problem: &Problem) -> Result<Vec<DMatrix<Enclosure>>, String> {
    let matrix = |(j, mode): (usize, &immaculate::model::motion::Mode<Enclosure, Dyn>)| match &mode.motion {
        Motion::Linear(matrix) | Motion::Affine { matrix, .. } => Ok(matrix.clone()),
        Motion::Function { .. } => Err(format!(
            "`modes[{j}]` moves by formulas: errors are carried by a matrix only where F is one; give \"F\""
        )),
    };
    problem.modes.iter().enumerate().map(matrix).collect()
}

/// H.
fn seen(problem: &Problem) -> Result<DMatrix<Enclosure>, String> {
    match &problem.sensor {
        Sensor::Linear(matrix) => Ok(matrix.clone()),
        _ => Err("`measurement` is not linear: errors are carried by a matrix only where H is one".to_owned()),
    }
}
