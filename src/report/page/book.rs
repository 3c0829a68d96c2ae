//! The book as HTML: one chapter per paper, one section per equation, and the index between numbers and code.
//!
//! A section shows, in this order: the meaning of the equation, its formula, the misprint if there is one, the derivation and the code,
//! the tests, and the mistakes with the cases that catch them.
//!
//! An item that realises several equations of a paper stands in the section of the first; the others lead there.

use super::markup::{formula, paragraphs, sentence, table};
use super::table::framed;
use crate::book::doc::PartKind;
use crate::book::{Entry, Realisation, entries_of, realisations};
use crate::paper::Paper;
use crate::paper::specification::Erratum;
use crate::report::equation::status;
use maud::{Markup, html};

/// The equations of a paper.
pub fn chapter(paper: Paper) -> Markup {
    let of = &paper.specification().paper;
    html! {
        section class="chapter" id={ "book-" (paper.key()) } {
            h1 { "Equations of " (paper.key()) ": " (of.title) }
            p class="citation" {
                (of.authors) ". " (of.venue) "."
                @if !of.doi.is_empty() { " doi:" (of.doi) "." }
            }
            @for entry in entries_of(paper) { (section(entry)) }
        }
    }
}

/// An equation.
fn section(entry: &Entry) -> Markup {
    let equation = entry.equation;
    html! {
        section class="equation" id=(entry.anchor()) {
            h2 { (entry.reference) ": " (entry.title()) }
            p class="meaning" { (equation.meaning) }
            div class="formula" { (formula(&equation.latex)) }
            p class={ "status " (equation.status) } { (status(&equation.status)) }
            @if let Some(erratum) = &equation.erratum { (corrected(erratum, &equation.latex)) }
            @for realisation in &entry.realisations { (realised(realisation, entry)) }
            (held(entry))
            (caught(entry))
        }
    }
}

/// The printed form beside the right one, and why.
fn corrected(erratum: &Erratum, latex: &str) -> Markup {
    html! {
        div class="erratum" {
            h3 { "Erratum " code { (erratum.id) } " (" (erratum.kind) ")" }
            div class="forms" {
                figure class="printed" { figcaption { "as printed" } (formula(&erratum.printed)) }
                figure class="right" { figcaption { "corrected" } (formula(latex)) }
            }
            p { (erratum.why) }
            p { "Proof: " (erratum.proof) }
        }
    }
}

/// An item in full in the section of the first equation that it realises, and a link to it in the others.
fn realised(realisation: &Realisation, entry: &Entry) -> Markup {
    let item = &realisation.item;
    let anchor = item.anchor();
    let at = || html! { code { (item.name) } ", " (item.path) ":" (item.line) };
    let first = first_of(realisation, entry.paper);
    if let Some(first) = first.filter(|first| first.reference != entry.reference) {
        return html! {
            p class="elsewhere" {
                (at()) ": " (sentence(&realisation.doc.title, item))
                ", shown at " a href={ "#" (first.anchor()) } { (first.reference) } "."
            }
        };
    }
    let doc = &realisation.doc;
    // The index leads to the first place in the book.
    let is_first = Paper::ALL
        .into_iter()
        .find_map(|paper| first_of(realisation, paper))
        .is_some_and(|first| first.reference == entry.reference);
    html! {
        div class="code" id=[is_first.then_some(anchor)] {
            h3 { (sentence(&doc.title, item)) }
            @if !doc.remark.is_empty() { (paragraphs(&doc.remark, item)) }
            @for part in &doc.parts {
                @match part.kind {
                    PartKind::Formula => pre class="text-formula" { (part.text) },
                    PartKind::Dictionary => (table(&part.text, item, "The letters of the formula")),
                    PartKind::Derivation => div class="derivation" { (paragraphs(&part.text, item)) },
                    PartKind::Source => div class="source" { (paragraphs(&format!("Source: {}", part.text), item)) },
                    PartKind::Errata => div class="errata" { (paragraphs(&format!("Errata: {}", part.text), item)) },
                    PartKind::Errors => div class="errors" { (paragraphs(&format!("Errors: {}", part.text), item)) },
                    PartKind::Example => details class="example" {
                        summary { "Example" }
                        (paragraphs(&part.text, item))
                    },
                    // In lists of their own.
                    PartKind::Mistakes | PartKind::Evidence => "",
                }
            }
            details class="source-code" {
                summary { "Code: " (at()) }
                pre { code class="language-rust" { (item.code) } }
            }
        }
    }
}

/// The first equation of a paper that an item realises.
fn first_of(realisation: &Realisation, paper: Paper) -> Option<&'static Entry> {
    let realises = |entry: &&Entry| entry.realisations.iter().any(|other| other.item == realisation.item);
    entries_of(paper).find(realises)
}

/// The tests.
fn held(entry: &Entry) -> Markup {
    html! {
        @if !entry.evidence.is_empty() {
            h3 { "Tested by" }
            ul class="evidence" {
                @for evidence in &entry.evidence {
                    li { code { (evidence.test) } " (" (evidence.kind) "), " (evidence.path) ":" (evidence.line) }
                }
            }
        }
    }
}

/// The mistakes and their cases, or why there are none.
fn caught(entry: &Entry) -> Markup {
    if let Some(reason) = &entry.equation.outside {
        return html! { p class="outside" { (reason) } };
    }
    let quantities: Vec<&str> = entry.quantities.iter().map(|quantity| quantity.name()).collect();
    html! {
        details class="mistakes" {
            summary {
                "Mistakes in " @for (index, name) in quantities.iter().enumerate() {
                    @if index > 0 { ", " }
                    code { (name) }
                }
                ": " (entry.mistakes.len()) ", caught by " (entry.cases().len()) @if entry.cases().len() == 1 { " case" } @else { " cases" }
            }
            table {
                caption { "Mistakes and conventions in " (entry.reference) }
                thead { tr { th scope="col" { "name" } th scope="col" { "kind" } th scope="col" { "what you did" } th scope="col" { "case" } } }
                tbody {
                    @for variant in &entry.mistakes {
                        tr {
                            th scope="row" { code { (variant.id) } }
                            td { (variant.kind.name()) }
                            td { (variant.about) }
                            td { code { (variant.case) } }
                        }
                    }
                }
            }
        }
    }
}

/// The index: equations by number, name and status, and code by the equations that it realises.
pub fn index() -> Markup {
    html! {
        h1 #book { "The book of equations" }
        p {
            "Every equation with its derivation, the code that implements it, its tests, typical mistakes, "
            "and the cases that catch them. Code that implements several equations stands with the first. Symbols are explained under "
            a href="notation.html" { "notation" } "."
        }
        @for paper in Paper::ALL {
            h2 id={ "index-" (paper.key()) } { (paper.key()) }
            (framed(&format!("The equations of {}", paper.key()), &index_of(paper)))
        }
        h2 #index-code { "By code" }
        (framed("Every item of the source that implements equations", &by_code()))
    }
}

fn index_of(paper: Paper) -> Markup {
    html! {
        table {
            caption.aloud { "The equations of " (paper.key()) }
            thead {
                tr { th scope="col" { "equation" } th scope="col" { "name" } th scope="col" { "as printed" } th scope="col" { "code" } }
            }
            tbody {
                @for entry in entries_of(paper) {
                    tr {
                        th scope="row" { a href={ "#" (entry.anchor()) } { "(" (entry.reference.label) ")" } }
                        td { (entry.title()) }
                        td { (entry.equation.status) }
                        td { @for (index, one) in entry.realisations.iter().enumerate() { @if index > 0 { ", " } (link_to(one)) } }
                    }
                }
            }
        }
    }
}

fn by_code() -> Markup {
    html! {
        table {
            caption.aloud { "Every item of the source that implements equations" }
            thead { tr { th scope="col" { "code" } th scope="col" { "where" } th scope="col" { "equations" } } }
            tbody {
                @for realisation in realisations() {
                    tr {
                        th scope="row" { (link_to(realisation)) }
                        td { (realisation.item.path) ":" (realisation.item.line) }
                        td {
                            @for (index, reference) in realisation.doc.realises.iter().enumerate() {
                                @if index > 0 { ", " }
                                a href={ "#" (reference.anchor()) } { (reference) }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn link_to(realisation: &Realisation) -> Markup {
    html! { a href={ "#" (realisation.item.anchor()) } { code { (realisation.item.name) } } }
}
