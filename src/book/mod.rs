//! The book of equations: the data of `spec/` and the source itself, joined equation by equation.
//!
//! For every equation of the papers the book shows its code, its derivation, its tests, the usual mistakes and the cases that catch them.
//! It adds no information of its own.
//!
//! ```text
//! spec/<paper>/equations.toml ─┐
//! src/   items, doc comments ──┼─▶ entries ─▶ the report, as text and as a page
//! tests/ names, places ────────┤
//! spec/variants.toml ──────────┘
//! ```
//!
//! - [`mod@reference`]: how comments name an equation;
//! - [`source`]: items and tests, from the files that are built into the program;
//! - [`doc`]: a doc comment in its parts;
//! - [`find`]: an equation by its number, name, quantity or function;
//! - [`markup`]: the markdown of doc comments, and as plain text.

pub mod doc;
pub mod find;
pub mod markup;
pub mod reference;
pub mod source;

use crate::imm::Quantity;
use crate::oracle::variant::{Applies, Kind, Variant, catalogue};
use crate::paper::Paper;
use crate::paper::specification::{PublishedEquation, Specification};
use doc::{Doc, Named};
use markup::plain;
use reference::EquationReference;
use source::{Item, Test};
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// An item of the source that realises equations.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Realisation {
    /// The item.
    pub item: Item,
    /// Its doc comment.
    pub doc: Doc,
}

/// A test that is evidence for an equation.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct TestEvidence {
    /// The test's name, which is the law that it holds.
    pub test: String,
    /// The kind of evidence, in the words of the doc comment; else of the test's file.
    pub kind: String,
    /// The test's file.
    pub path: String,
    /// The line of its name.
    pub line: usize,
}

/// An equation of a paper, with everything that is known of it.
#[derive(Debug, Clone)]
pub struct Entry {
    /// The paper.
    pub paper: Paper,
    /// Its number or name.
    pub reference: EquationReference,
    /// Its row in `spec/`.
    pub equation: &'static PublishedEquation,
    /// The items that realise it.
    pub realisations: Vec<&'static Realisation>,
    /// The tests that hold it.
    pub evidence: Vec<TestEvidence>,
    /// The values of a filter's step that it is an equation of; none outside a step.
    pub quantities: Vec<Quantity>,
    /// The mistakes that are made in it, and the conventions that change it.
    pub mistakes: Vec<&'static Variant>,
}

impl Entry {
    /// The name of its place in addresses: `zhu2016-56`.
    pub fn anchor(&self) -> String {
        self.reference.anchor()
    }

    /// The published cases that catch its mistakes, each once.
    pub fn cases(&self) -> Vec<&'static str> {
        let mut cases: Vec<&str> = Vec::new();
        for variant in &self.mistakes {
            if !variant.case.is_empty() && !cases.contains(&variant.case.as_str()) {
                cases.push(&variant.case);
            }
        }
        cases
    }

    /// What it is called, in plain words: the title of the first item that realises it, or its own name.
    pub fn title(&self) -> String {
        let first = self.realisations.first();
        first.map_or_else(
            || self.reference.label.clone(),
            |first| plain(&first.doc.title, &first.item),
        )
    }
}

/// The book: every equation of every paper in reading order, first those with a number.
pub fn entries() -> &'static [Entry] {
    static ENTRIES: LazyLock<Vec<Entry>> = LazyLock::new(|| {
        let papers = Paper::ALL.into_iter();
        papers
            .flat_map(|paper| {
                paper
                    .specification()
                    .all_equations()
                    .map(move |equation| entry(paper, equation))
            })
            .collect()
    });
    &ENTRIES
}

/// The equations of a paper, in reading order.
pub fn entries_of(paper: Paper) -> impl Iterator<Item = &'static Entry> {
    entries().iter().filter(move |entry| entry.paper == paper)
}

/// The items of the source that realise equations, in the order of the files.
pub fn realisations() -> &'static [Realisation] {
    static REALISATIONS: LazyLock<Vec<Realisation>> = LazyLock::new(|| {
        // Only files with such a comment are parsed: most realise nothing.
        let files = source::source_files().into_iter();
        let files = files.filter(|file| !reference::headings(&file.text.replace("///", "")).is_empty());
        // The files are those that were compiled.
        let items = files.flat_map(|file| source::items_of(&file).unwrap_or_default());
        let read = items.map(|item| Realisation {
            doc: Doc::read(&item.doc),
            item,
        });
        read.filter(|realisation| !realisation.doc.realises.is_empty())
            .collect()
    });
    &REALISATIONS
}

fn entry(paper: Paper, equation: &'static PublishedEquation) -> Entry {
    let reference = EquationReference::new(paper, equation.label());
    let all = realisations().iter();
    let realisations: Vec<&Realisation> = all.filter(|one| one.doc.realises.contains(&reference)).collect();
    let named = Quantity::ALL.into_iter();
    Entry {
        paper,
        equation,
        evidence: evidence(equation, &realisations),
        realisations,
        quantities: named
            .filter(|quantity| equation.quantities.iter().any(|name| name == quantity.name()))
            .collect(),
        mistakes: mistakes(paper.specification(), equation),
        reference,
    }
}

/// The tests that the items name, then those of the items that they refer to, then the erratum's.
fn evidence(equation: &PublishedEquation, realisations: &[&Realisation]) -> Vec<TestEvidence> {
    let mut named: Vec<Named> = Vec::new();
    for realisation in realisations {
        named.extend(evidence_of_item(realisation, 0));
    }
    let erratum = equation.erratum.as_ref().and_then(|erratum| erratum.test.clone());
    named.extend(erratum.map(|test| Named { test, kind: None }));
    let mut found: Vec<TestEvidence> = Vec::new();
    for Named { test, kind } in named {
        let Some(Test { path, line }) = source::tests().get(&test) else {
            continue;
        };
        if found.iter().all(|other| other.test != test) {
            let kind = kind.unwrap_or_else(|| kind_of_file(path));
            found.push(TestEvidence {
                test,
                kind,
                path: path.clone(),
                line: *line,
            });
        }
    }
    found
}

/// The tests of an item and of those whose evidence it has too; chains of these are short.
fn evidence_of_item(realisation: &Realisation, depth: usize) -> Vec<Named> {
    const DEEPEST: usize = 3;
    let mut named = realisation.doc.evidence();
    for name in realisation.doc.evidence_of() {
        let linked = realisations()
            .iter()
            .filter(|other| other.item.short_name() == name || other.item.name == name);
        // In the same file if there is one of this name.
        let near = linked.clone().find(|other| other.item.path == realisation.item.path);
        if let Some(other) = near.or_else(|| linked.clone().next())
            && depth < DEEPEST
        {
            named.extend(evidence_of_item(other, depth + 1));
        }
    }
    named
}

/// What a test file says that its kind of evidence is, in a word.
fn kind_of_file(path: &str) -> String {
    static KINDS: LazyLock<BTreeMap<String, String>> = LazyLock::new(|| {
        let kinds = source::test_files().into_iter().map(|file| {
            // It may go on in the next line.
            let text = file.text.replace("\n//! ", " ");
            let said = text.split("Kind of evidence: ").nth(1).unwrap_or_default();
            let word = said.split(|c: char| !c.is_alphabetic()).next().unwrap_or_default();
            (file.path, word.to_owned())
        });
        kinds.collect()
    });
    KINDS.get(path).cloned().unwrap_or_default()
}

/// The mistakes and conventions of an equation: those that its row names, or all of its quantities that can be made where it is used. What
/// is done to the equation itself comes before what it is given wrongly.
fn mistakes(specification: &Specification, equation: &PublishedEquation) -> Vec<&'static Variant> {
    let everywhere = [Applies::All, Applies::SeveralModes, Applies::Missed];
    let used = equation.applies.as_ref().unwrap_or(&specification.applies);
    let is_used = |applies: Applies| everywhere.contains(&applies) || used.iter().any(|name| name == applies.name());
    let converts = is_used(Applies::Conversions);
    let made = catalogue().iter().filter(|variant| {
        let quantity = variant.converted.filter(|_| converts).unwrap_or(variant.quantity);
        let is_of_quantity = equation.quantities.iter().any(|name| name == quantity.name());
        variant.kind != Kind::Form && is_of_quantity && is_used(variant.applies)
    });
    let is_named = |variant: &&Variant| equation.mistakes.is_empty() || equation.mistakes.contains(&variant.id);
    let mut named: Vec<&Variant> = made.filter(is_named).collect();
    named.sort_by_key(|variant| variant.input);
    named
}
