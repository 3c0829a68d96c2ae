//! Which situations a program was asked to handle, filter by filter.
//!
//! It prints the table of situations in a verdict, and the words for each grade.

use super::{table, wrapped};
use crate::oracle::behaviour::{Behaviour, Grade, Unasked};
use crate::oracle::check::Report;
use std::collections::BTreeMap;

/// A grade in a word, without its counts.
pub(super) fn in_a_word(grade: &Grade) -> &'static str {
    match grade {
        Grade::Right(_) => "right",
        Grade::Wrong(..) => "wrong",
        Grade::Otherwise(..) => "otherwise",
        Grade::CannotTell => "cannot tell",
        Grade::Skipped => "skipped",
        Grade::NotAsked(_) => "not asked",
        Grade::Impossible(_) => "not there",
    }
}

/// Why there is no other grade, if there is none.
pub(super) fn why(grade: &Grade) -> Option<&'static str> {
    match grade {
        Grade::NotAsked(Unasked::Kind) => Some("the cases need filters that the program does not have"),
        Grade::NotAsked(Unasked::Format) => Some("the cases are in a format that the program does not declare"),
        Grade::NotAsked(Unasked::Validation) => Some("the program leaves input checks to its caller"),
        Grade::NotAsked(Unasked::Selection) => Some("no such case was selected"),
        Grade::Impossible(why) => Some(why),
        _ => None,
    }
}

/// What stands in the table.
pub(super) fn cell(grade: &Grade) -> String {
    match grade {
        Grade::Right(cases) => format!("right {cases}"),
        Grade::Wrong(wrong, cases) => format!("WRONG {wrong} of {cases}"),
        Grade::Otherwise(otherwise, cases) => format!("otherwise {otherwise} of {cases}"),
        Grade::Impossible(_) => "—".to_owned(),
        other => in_a_word(other).to_owned(),
    }
}

/// One row per behaviour, one column per family of filters, and why something was not asked. Empty for unpublished problems.
pub(super) fn behaviours(report: &Report) -> String {
    let grades = report.grades();
    if grades.is_empty() {
        return String::new();
    }
    let header: Vec<&str> = std::iter::once("situation")
        .chain(grades.iter().map(|(family, _)| *family))
        .collect();
    let mut table = table(&header);
    for (index, behaviour) in Behaviour::ALL.into_iter().enumerate() {
        let cells = grades.iter().map(|(_, of_family)| cell(&of_family[index].1));
        table.add_row(
            std::iter::once(behaviour.name().to_owned())
                .chain(cells)
                .collect::<Vec<_>>(),
        );
    }
    let mut text = format!("\n{table}\n");
    for sentence in open_questions(&grades) {
        text.push_str(&wrapped(&sentence, "  "));
    }
    text
}

/// What was not asked: one sentence per reason.
pub(super) fn open_questions(grades: &[(&'static str, Vec<(Behaviour, Grade)>)]) -> Vec<String> {
    let mut open: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for (behaviour, grade) in grades.iter().flat_map(|(_, of_family)| of_family) {
        if let (Grade::NotAsked(_), Some(why)) = (grade, why(grade)) {
            let names = open.entry(why).or_default();
            if !names.contains(&behaviour.name()) {
                names.push(behaviour.name());
            }
        }
    }
    let sentence = |(why, names): (&str, Vec<&str>)| format!("Not asked, because {why}: {}.", names.join(", "));
    open.into_iter().map(sentence).collect()
}
