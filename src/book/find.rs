//! Finds an equation by its number, its name, the value of the step that it gives, or the function that computes it.
//!
//! An unknown name is answered with the nearest known ones.

use super::{Entry, entries, entries_of};
use crate::paper::Paper;

/// A name that no equation has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no equation `{asked}`; the nearest names are {}", nearest.join(", "))]
pub struct Unknown {
    /// What was asked for.
    pub asked: String,
    /// The names that are most like it, as they can be asked for.
    pub nearest: Vec<String>,
}

/// The equations of a name, which may be written in several words: `zhu2016 56`, `zhu2016 (56)`, `zhu2016-56`, an unnumbered one's name,
/// a paper, an erratum, a quantity, a function; a number alone is one of every paper. In reading order.
///
/// # Errors
///
/// [`Unknown`] with the nearest names.
pub fn find(asked: &str) -> Result<Vec<&'static Entry>, Unknown> {
    let name = asked.trim();
    if let Some(paper) = Paper::ALL.into_iter().find(|paper| paper.key() == name) {
        return Ok(entries_of(paper).collect());
    }
    let anchor = anchor(name);
    let is_asked: [&dyn Fn(&Entry) -> bool; 4] = [
        &|entry| entry.anchor() == anchor,
        &|entry| entry.reference.label == name || entry.equation.erratum.as_ref().is_some_and(|e| e.id == name),
        &|entry| entry.quantities.iter().any(|quantity| quantity.name() == name),
        &|entry| {
            entry
                .realisations
                .iter()
                .any(|one| one.item.name == name || one.item.short_name() == name)
        },
    ];
    for is_asked in is_asked {
        let found: Vec<&Entry> = entries().iter().filter(|entry| is_asked(entry)).collect();
        if !found.is_empty() {
            return Ok(found);
        }
    }
    Err(Unknown {
        asked: name.to_owned(),
        nearest: nearest(name),
    })
}

/// Letters and digits, with one stroke where there is anything else.
fn anchor(name: &str) -> String {
    let words = name
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-")
}

/// The names that are most like another.
fn nearest(name: &str) -> Vec<String> {
    const SHOWN: usize = 3;
    const LONGEST: usize = 100;
    let mut names: Vec<String> = Vec::new();
    for entry in entries() {
        names.push(entry.anchor());
        names.extend(entry.equation.name.clone());
        names.extend(entry.quantities.iter().map(|quantity| quantity.name().to_owned()));
        names.extend(entry.realisations.iter().map(|one| one.item.short_name().to_owned()));
    }
    names.sort();
    names.dedup();
    // The comparison takes a time as the product of the lengths, and no name is nearly as long.
    let name: String = name.chars().take(LONGEST).collect();
    let asked = anchor(&name);
    let likeness = |other: &String| strsim::jaro_winkler(&asked, other).max(strsim::jaro_winkler(&name, other));
    names.sort_by(|a, b| likeness(b).total_cmp(&likeness(a)));
    names.truncate(SHOWN);
    names
}
