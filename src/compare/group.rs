//! Which components of the state are compared together: those whose errors have one unit.

use crate::model::space::ComponentKind;
use crate::oracle::problem::ProblemFile;
use serde::Serialize;

/// Components of the state whose errors have one unit and are summed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ErrorGroup {
    /// Their places in the state.
    pub entries: Vec<usize>,
}

/// Components with one unit.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct GroupName {
    /// Their names.
    pub names: Vec<String>,
    /// Their unit; empty where none is given.
    pub unit: String,
}

/// The components of the state that are compared together: those with one unit; an angle, or what has no unit, by itself.
pub fn groups(problem: &ProblemFile) -> Vec<ErrorGroup> {
    let mut groups: Vec<ErrorGroup> = Vec::new();
    let is_angle = |entry: usize| problem.state[entry].kind == ComponentKind::Angle;
    let unit_of = |entry: usize| unit(problem, entry);
    for entry in 0..problem.state.len() {
        let is_alike = |group: &&mut ErrorGroup| {
            let first = group.entries[0];
            !unit_of(entry).is_empty() && unit_of(first) == unit_of(entry) && !is_angle(first) && !is_angle(entry)
        };
        match groups.iter_mut().find(is_alike) {
            Some(group) => group.entries.push(entry),
            None => groups.push(ErrorGroup { entries: vec![entry] }),
        }
    }
    groups
}

/// The unit of a component.
fn unit(problem: &ProblemFile, entry: usize) -> &str {
    let own = problem.state[entry].unit.as_ref();
    own.or_else(|| problem.units.get(entry)).map_or("", String::as_str)
}

pub(super) fn group_name(problem: &ProblemFile, group: &ErrorGroup) -> GroupName {
    GroupName {
        names: group
            .entries
            .iter()
            .map(|&entry| problem.state[entry].name.clone())
            .collect(),
        unit: unit(problem, group.entries[0]).to_owned(),
    }
}
