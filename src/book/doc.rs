//! Doc comments of equations, split into their fixed parts.
//!
//! An equation is documented in a fixed order: name and numbers; formula; dictionary; why; example; errors; errata; evidence.

use super::reference::{EquationReference, heading, headings};

/// What a part of a doc comment is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum PartKind {
    /// The equation in letters.
    Formula,
    /// The letters of the papers beside the names of the code.
    Dictionary,
    /// Why it is so.
    Derivation,
    /// Where it is from.
    Source,
    /// When it is refused.
    Errors,
    /// An example that is run.
    Example,
    /// What the papers print wrongly.
    Errata,
    /// The mistakes that are made in it.
    Mistakes,
    /// The tests that hold it.
    Evidence,
}

/// A part of a doc comment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Part {
    /// What it is.
    pub kind: PartKind,
    /// Its markdown without the label, but for "Why:"; of a formula the lines alone.
    pub text: String,
}

/// A doc comment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Doc {
    /// The first paragraph up to its dash; all of it where it has none.
    pub title: String,
    /// What the first paragraph says after the numbers.
    pub remark: String,
    /// The equations that the item realises.
    pub realises: Vec<EquationReference>,
    /// The rest, part by part.
    pub parts: Vec<Part>,
}

/// A test that a doc comment names, with the kind of evidence in its words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Named {
    /// The test.
    pub test: String,
    /// The kind, if it is said.
    pub kind: Option<String>,
}

/// The words with which parts begin, and the headings under which they stand.
const LABELS: [(&str, PartKind); 10] = [
    ("Why:", PartKind::Derivation),
    ("Source:", PartKind::Source),
    ("Errata:", PartKind::Errata),
    ("Mistakes:", PartKind::Mistakes),
    ("Evidence:", PartKind::Evidence),
    ("Example:", PartKind::Example),
    ("# Errors", PartKind::Errors),
    ("# Panics", PartKind::Errors),
    ("# Examples", PartKind::Example),
    ("# Example", PartKind::Example),
];

impl Doc {
    /// Splits a doc comment.
    pub fn read(text: &str) -> Self {
        let mut blocks = blocks(text).into_iter();
        let first = blocks.next().unwrap_or_default().replace('\n', " ");
        let (title, remark) = match first.split_once('—') {
            Some((title, rest)) if !heading(rest).0.is_empty() => (title, heading(rest).1),
            _ => (first.as_str(), ""),
        };
        let mut parts: Vec<Part> = Vec::new();
        // What stands under a heading belongs to it, up to the next paragraph that begins with a word of its own.
        let mut under = None;
        for block in blocks {
            let label = LABELS.iter().find(|(word, _)| block.starts_with(word));
            if let Some((word, kind)) = label {
                // The code of an example belongs to its sentence.
                under = (word.starts_with('#') || *kind == PartKind::Example).then_some(*kind);
                // "Why:" is the beginning of a sentence that others may follow without it.
                let text = if *kind == PartKind::Derivation {
                    block.as_str()
                } else {
                    block[word.len()..].trim()
                };
                if !text.is_empty() {
                    parts.push(Part {
                        kind: *kind,
                        text: text.to_owned(),
                    });
                }
                continue;
            }
            let part = under.map_or_else(
                || unlabelled(&block),
                |kind| Part {
                    kind,
                    text: block.clone(),
                },
            );
            match parts.last_mut() {
                // The sentence of an example and its code are one part.
                Some(last) if last.kind == PartKind::Example && part.kind == PartKind::Example => {
                    last.text.push_str("\n\n");
                    last.text.push_str(&part.text);
                }
                _ => parts.push(part),
            }
        }
        Self {
            title: title.trim().to_owned(),
            remark: remark.trim_start_matches([':', ',', '.', ';']).trim().to_owned(),
            realises: headings(text),
            parts,
        }
    }

    /// The texts of the parts of a kind.
    pub fn of(&self, kind: PartKind) -> impl Iterator<Item = &str> {
        let parts = self.parts.iter().filter(move |part| part.kind == kind);
        parts.map(|part| part.text.as_str())
    }

    /// The tests that are named as evidence.
    pub fn evidence(&self) -> Vec<Named> {
        self.of(PartKind::Evidence).flat_map(named_tests).collect()
    }

    /// The items whose evidence this item has too: those that its evidence links to.
    pub fn evidence_of(&self) -> Vec<String> {
        let linked = self.of(PartKind::Evidence).flat_map(|text| {
            let after = text.split("[`").skip(1);
            after.filter_map(|rest| rest.split_once("`]").map(|(name, _)| name.to_owned()))
        });
        linked.collect()
    }
}

/// A paragraph without a label: a formula, a dictionary, or a part of the derivation.
fn unlabelled(block: &str) -> Part {
    if let Some(rest) = block.strip_prefix("```") {
        let (language, body) = rest.split_once('\n').unwrap_or_default();
        let body = body.trim_end().trim_end_matches("```").trim_end();
        let kind = if language == "text" {
            PartKind::Formula
        } else {
            PartKind::Example
        };
        let text = if language == "text" { body } else { block };
        return Part {
            kind,
            text: text.to_owned(),
        };
    }
    let kind = if block.starts_with('|') {
        PartKind::Dictionary
    } else {
        PartKind::Derivation
    };
    Part {
        kind,
        text: block.to_owned(),
    }
}

/// Paragraphs, and code with the empty lines that are in it.
fn blocks(text: &str) -> Vec<String> {
    let mut blocks: Vec<String> = Vec::new();
    let (mut is_open, mut is_code) = (false, false);
    for line in text.lines() {
        let is_fence = line.starts_with("```");
        if line.is_empty() && !is_code {
            is_open = false;
            continue;
        }
        match blocks.last_mut().filter(|_| is_open) {
            Some(block) => {
                block.push('\n');
                block.push_str(line);
            }
            None => blocks.push(line.to_owned()),
        }
        is_open = true;
        is_code ^= is_fence;
    }
    blocks
}

/// What stands between backticks, but for links, each with what the next parenthesis says.
fn named_tests(text: &str) -> Vec<Named> {
    let parts: Vec<&str> = text.split('`').collect();
    let mut tests: Vec<Named> = Vec::new();
    let mut without_kind = 0;
    for pair in parts.chunks(2) {
        if let Some(kind) = kind_of(pair[0]) {
            let first = tests.len() - without_kind;
            tests[first..]
                .iter_mut()
                .for_each(|test| test.kind = Some(kind.clone()));
            without_kind = 0;
        }
        if let [before, name] = pair
            && !before.ends_with('[')
        {
            tests.push(Named {
                test: (*name).to_owned(),
                kind: None,
            });
            without_kind += 1;
        }
    }
    tests
}

/// The kind of evidence that is said between two tests: ` (exact), `. What follows a link is its address.
fn kind_of(between: &str) -> Option<String> {
    let (kind, _) = between.trim_start().strip_prefix('(')?.split_once(')')?;
    Some(kind.split_whitespace().collect::<Vec<_>>().join(" "))
}

/// What stands between backticks in a text, but for links.
pub fn backticked(text: &str) -> Vec<String> {
    named_tests(text).into_iter().map(|named| named.test).collect()
}
