//! The site: static pages that show everything, for people who would rather look than run.
//!
//! Each page is complete in itself: it needs no network and no script, and tells the browser so. It reads at any width, on dark and light
//! screens, on paper, by keyboard and aloud. The same seed gives the same bytes.
//!
//! | file           | what it makes                                                         |
//! |----------------|-----------------------------------------------------------------------|
//! | `content`      | what is run for the pages                                             |
//! | `introduction` | the front page                                                        |
//! | `paper`        | one paper: figures, published beside computed                         |
//! | `figures`      | which figures a paper has, and what is to be seen on each             |
//! | `ledger`       | its claims with verdict and evidence                                  |
//! | `errata`       | the printed and the corrected form of what is wrong                   |
//! | `book`         | the equations of a paper, one by one, and the index between numbers and code |
//! | `mistakes`     | the catalogue of mistakes, conventions and forms                      |
//! | `cases`        | the certified cases by what a filter meets in them                    |
//! | `markdown`     | a page of `spec/` as HTML                                             |
//! | `links`        | on which page an anchor stands                                        |
//! | `markup`       | LaTeX and doc comments as HTML                                        |
//! | `table`        | a table that can be scrolled and read aloud                           |
//! | `style.css`    | how it looks                                                          |

pub mod book;
mod cases;
pub mod content;
mod errata;
pub(super) mod figures;
mod introduction;
mod ledger;
mod links;
mod markdown;
pub mod markup;
mod mistakes;
mod paper;
pub(super) mod table;

use super::chart::NotDrawn;
use super::palette::{self, hexadecimal};
use crate::paper::Paper;
use content::Content;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("style.css");

/// Nothing may be fetched: what a page needs is on it.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'";

/// A page of the site.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Page {
    /// The name of its file, such as `book.html`.
    pub file: String,
    /// What is in the file.
    pub html: String,
}

/// A page before it has its frame and its links.
struct Sheet {
    /// The group of the menu in which it stands.
    group: &'static str,
    file: String,
    /// Its name in the menu.
    name: String,
    body: Markup,
}

/// All pages, the front page first.
///
/// # Errors
///
/// [`NotDrawn`] when a figure cannot be drawn.
pub fn site(content: &Content) -> Result<Vec<Page>, NotDrawn> {
    let sheets = sheets(content)?;
    let pages = sheets.iter().map(|sheet| Page {
        file: sheet.file.clone(),
        html: framed(sheet, &sheets, content).into_string(),
    });
    Ok(links::joined(pages.collect()))
}

fn sheets(content: &Content) -> Result<Vec<Sheet>, NotDrawn> {
    let text = |group, file: &str, name: &str, text| sheet(group, file, name, markdown::page(text));
    let mut sheets = vec![
        sheet("", "index", "Immaculate", introduction::page(content)),
        text(
            "Check a filter",
            "checking",
            "How a filter is checked",
            include_str!("../../../spec/checking.md"),
        ),
        sheet("Check a filter", "mistakes", "Mistakes", mistakes::page()),
        sheet("Check a filter", "cases", "Cases", cases::page()),
        text(
            "Check a filter",
            "formats",
            "Files and protocol",
            include_str!("../../../spec/formats.md"),
        ),
        text(
            "Papers",
            "findings",
            "Findings",
            include_str!("../../../spec/findings.md"),
        ),
    ];
    for of_paper in &content.papers {
        let key = of_paper.paper.key();
        sheets.push(sheet("Papers", key, key, paper::page(of_paper, content)?));
    }
    sheets.push(sheet("Equations", "book", "Index", book::index()));
    for paper in Paper::ALL {
        let key = paper.key();
        sheets.push(sheet("Equations", &format!("book-{key}"), key, book::chapter(paper)));
    }
    sheets.push(text(
        "Equations",
        "notation",
        "Notation",
        include_str!("../../../spec/notation.md"),
    ));
    sheets.push(text(
        "Library",
        "library",
        "Use from Rust",
        include_str!("../../../spec/library.md"),
    ));
    sheets.push(text(
        "Library",
        "guarantees",
        "Guarantees",
        include_str!("../../../spec/guarantees.md"),
    ));
    Ok(sheets)
}

fn sheet(group: &'static str, file: &str, name: &str, body: Markup) -> Sheet {
    Sheet {
        group,
        file: format!("{file}.html"),
        name: name.to_owned(),
        body,
    }
}

/// A page with its head, the menu, and what it was made from.
fn framed(sheet: &Sheet, all: &[Sheet], content: &Content) -> Markup {
    let body = html! {
        a.skip href="#content" { "Skip to the content" }
        (menu(sheet, all))
        main #content { (sheet.body) }
        footer { (made_from(content)) }
    };
    document(&title(sheet), &body)
}

/// A document around its body: it looks as every page of this program does, and it may fetch nothing.
pub(super) fn document(title: &str, body: &Markup) -> Markup {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (PreEscaped(STYLE)) (PreEscaped(colours_of_drawings())) }
            }
            body { (body) }
        }
    }
}

fn title(sheet: &Sheet) -> String {
    match sheet.group {
        "" => "Immaculate: is your tracking filter right?".to_owned(),
        group => format!("{} · {group} · Immaculate", sheet.name),
    }
}

/// The pages by groups; the one that is open is marked.
fn menu(open: &Sheet, all: &[Sheet]) -> Markup {
    let link = |sheet: &Sheet| {
        let current = (sheet.file == open.file).then_some("page");
        html! { a href=(sheet.file) aria-current=[current] { (sheet.name) } }
    };
    html! {
        nav aria-label="Pages" {
            @for group in all.chunk_by(|one, other| one.group == other.group) {
                p {
                    @if !group[0].group.is_empty() { span.group { (group[0].group) } }
                    @for sheet in group { (link(sheet)) " " }
                }
            }
        }
    }
}

/// Rules that give the drawings the page's own ink, ground, grid and shade; the colours of filters are the same on any ground.
fn colours_of_drawings() -> String {
    let of_page = ["ink", "paper", "grid", "shade"];
    let drawn = palette::ALL.into_iter().filter(|(name, _)| of_page.contains(name));
    let rules = drawn.map(|(name, colour)| {
        let hexadecimal = hexadecimal(colour);
        format!(
            ".drawing [fill=\"{hexadecimal}\"] {{ fill: var(--{name}); }}\n\
             .drawing [stroke=\"{hexadecimal}\"] {{ stroke: var(--{name}); }}\n"
        )
    });
    rules.collect()
}

/// What the pages were made from.
fn made_from(content: &Content) -> Markup {
    let runs = match content.extent.effort.runs {
        Some(runs) => format!("{runs} runs of every simulation"),
        None => "each paper’s own number of runs".to_owned(),
    };
    html! {
        p.made {
            "Made by immaculate " (env!("CARGO_PKG_VERSION")) " with the seed " (content.extent.effort.seed) " and " (runs)
            "; the same seed gives the same pages. Your own copy: " code { "cargo run --release -- report --out site" } "."
        }
    }
}
