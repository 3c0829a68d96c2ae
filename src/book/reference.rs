//! How comments name an equation: a paper's key, then printed numbers or names in parentheses.
//!
//! Lists and ranges have one fixed form. After a dash, a doc comment declares that its item *implements* an equation; anywhere else it
//! only mentions it.

use crate::paper::Paper;
use std::fmt;

/// An equation as comments name it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct EquationReference {
    /// The paper's key.
    pub paper: &'static str,
    /// The printed number in digits, or the name of an equation without one.
    pub label: String,
}

impl EquationReference {
    /// The reference to an equation of a paper.
    pub fn new(paper: Paper, label: impl fmt::Display) -> Self {
        Self {
            paper: paper.key(),
            label: label.to_string(),
        }
    }

    /// The name of the equation in addresses, which never changes.
    pub fn anchor(&self) -> String {
        format!("{}-{}", self.paper, self.label)
    }
}

impl fmt::Display for EquationReference {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} ({})", self.paper, self.label)
    }
}

/// All equations that a text names: a key, a blank, a list.
pub fn citations(text: &str) -> Vec<EquationReference> {
    let mut found = Vec::new();
    for paper in Paper::ALL {
        let key = paper.key();
        for (at, _) in text.match_indices(key) {
            if let Some(rest) = text[at + key.len()..].strip_prefix(' ') {
                found.extend(list(paper, rest).0);
            }
        }
    }
    found
}

/// The equations that a doc comment says its item realises: those of the lists after a dash.
pub fn headings(doc: &str) -> Vec<EquationReference> {
    doc.match_indices('—')
        .flat_map(|(at, dash)| heading(&doc[at + dash.len()..]).0)
        .collect()
}

/// The lists at the start of a text, one paper after the other, and what follows them.
pub fn heading(text: &str) -> (Vec<EquationReference>, &str) {
    let mut found = Vec::new();
    let mut rest = text;
    loop {
        let next = if found.is_empty() {
            rest
        } else {
            rest.trim_start_matches(',')
        };
        let start = next.trim_start();
        let Some(paper) = Paper::ALL.into_iter().find(|paper| start.starts_with(paper.key())) else {
            return (found, rest);
        };
        let (references, after) = list(paper, start[paper.key().len()..].trim_start());
        if references.is_empty() {
            return (found, rest);
        }
        found.extend(references);
        rest = after;
    }
}

/// The equations of a list `(1), (3)-(5), (a-name)` at the start of a text, and what follows it.
fn list(paper: Paper, text: &str) -> (Vec<EquationReference>, &str) {
    let mut found = Vec::new();
    let mut rest = text;
    loop {
        let next = if found.is_empty() {
            Some(rest)
        } else {
            rest.strip_prefix(',').map(str::trim_start)
        };
        let Some((first, after)) = next.and_then(in_parentheses) else {
            return (found, rest);
        };
        let range = after.strip_prefix('-').and_then(in_parentheses);
        let last = range.and_then(|(last, _)| last.parse::<u32>().ok());
        match (first.parse::<u32>(), last) {
            (Ok(first), Some(last)) => found.extend((first..=last).map(|number| EquationReference::new(paper, number))),
            _ => found.push(EquationReference::new(paper, first)),
        }
        rest = range.map_or(after, |(_, after)| after);
    }
}

/// A number or a name in parentheses at the start of a text, and what follows it. Anything else in parentheses is a remark.
fn in_parentheses(text: &str) -> Option<(&str, &str)> {
    let (label, rest) = text.strip_prefix('(')?.split_once(')')?;
    let is_number = label.parse::<u32>().is_ok();
    let is_of_name = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    let is_name = label.starts_with(|c: char| c.is_ascii_lowercase()) && label.chars().all(is_of_name);
    (is_number || is_name).then_some((label, rest))
}
