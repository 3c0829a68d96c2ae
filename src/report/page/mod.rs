//! The page: one HTML file that shows everything, for people who would rather look than run.
//!
//! After this folder the reader knows how the page is put together. It needs no network and no script, says so to the browser, reads in
//! any width, on dark and light screens, on paper, by keyboard and aloud. The same seed gives the same bytes.
//!
//! | file           | what it makes                                                         |
//! |----------------|-----------------------------------------------------------------------|
//! | `content`      | what is run for the page                                              |
//! | `introduction` | what Immaculate is, and what came out, in five minutes                |
//! | `paper`        | one paper: figures, published beside computed                         |
//! | `figures`      | which figures a paper has, and what is to be seen on each             |
//! | `ledger`       | its claims with verdict and evidence                                  |
//! | `errata`       | the printed and the corrected form of what is wrong                   |
//! | `book`         | the equations of a paper, one by one, and the index between numbers and code |
//! | `markup`       | LaTeX and doc comments as HTML                                        |
//! | `table`        | a table that can be scrolled and read aloud                           |
//! | `style.css`    | how it looks                                                          |

pub mod book;
pub mod content;
mod errata;
mod figures;
mod introduction;
mod ledger;
pub mod markup;
mod paper;
mod table;

use super::chart::NotDrawn;
use super::palette::{self, hexadecimal};
use crate::paper::Paper;
use content::Content;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("style.css");

/// Nothing may be fetched: what the page needs is on it.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'";

/// The whole page.
///
/// # Errors
///
/// [`NotDrawn`] when a figure cannot be drawn.
pub fn html(content: &Content) -> Result<String, NotDrawn> {
    let papers = content.papers.iter().map(|of_paper| paper::section(of_paper, content));
    let papers = papers.collect::<Result<Vec<Markup>, NotDrawn>>()?;
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { "Immaculate: the executable specification of the IMM filter" }
                style { (PreEscaped(STYLE)) (PreEscaped(colours_of_drawings())) }
            }
            body {
                a.skip href="#content" { "Skip to the content" }
                (header(content))
                (contents(content))
                main #content {
                    (introduction::section(content))
                    @for paper in &papers { (paper) }
                    (equations())
                }
            }
        }
    };
    Ok(page.into_string())
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

/// The book of equations: the way from a number to everything about it, then the papers' equations in their order.
fn equations() -> Markup {
    html! {
        section.book aria-labelledby="book" {
            h2 #book { "The book of equations" }
            p {
                "Every equation with its derivation, the code that realises it, the tests that hold it, and the mistakes that are made in it "
                "with the cases that catch them. Code that realises several equations stands with the first."
            }
            details { summary { "All equations, by number and by code" } (book::index()) }
            @for paper in Paper::ALL { (book::chapter(paper)) }
        }
    }
}

/// The title, and what the page was made from.
fn header(content: &Content) -> Markup {
    let runs = match content.extent.effort.runs {
        Some(runs) => format!("{runs} runs of every simulation"),
        None => "each paper’s own number of runs".to_owned(),
    };
    html! {
        header {
            h1 { "Immaculate" }
            p.lead { "The executable specification of the interacting multiple model filter and of the filters inside it." }
            p.made {
                "Made by immaculate " (env!("CARGO_PKG_VERSION")) " with the seed " (content.extent.effort.seed) " and " (runs)
                "; the same seed gives the same page."
            }
        }
    }
}

/// The table of contents.
fn contents(content: &Content) -> Markup {
    html! {
        nav aria-label="Contents" {
            ol {
                li { a href="#introduction" { "In five minutes" } }
                @for of_paper in &content.papers {
                    @let key = of_paper.paper.key();
                    li {
                        a href=(format!("#{key}")) { (key) }
                        " "
                        span.parts {
                            a href=(format!("#{key}-figures")) { "figures" }
                            " " a href=(format!("#{key}-claims")) { "claims" }
                            " " a href=(format!("#{key}-errata")) { "errata" }
                            " " a href=(format!("#book-{key}")) { "equations" }
                        }
                    }
                }
                li { a href="#book" { "The book of equations" } }
            }
        }
    }
}
