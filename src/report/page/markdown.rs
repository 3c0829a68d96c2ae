//! A page of `spec/`, or parts of the README, as HTML.
//!
//! A heading has the anchor that its words give it. A link to another page of the site leads there; a link to a file that is not on the
//! site is the file's name without a link.

use super::table::framed;
use crate::book::markup::{led, rows, text_of};
use maud::{Markup, PreEscaped, html};
use pulldown_cmark::html::push_html;
use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

/// The files of the tree that are pages, and the pages.
const PAGES: [(&str, &str); 8] = [
    ("README.md", "index.html"),
    ("checking.md", "checking.html"),
    ("findings.md", "findings.html"),
    ("formats.md", "formats.html"),
    ("guarantees.md", "guarantees.html"),
    ("library.md", "library.html"),
    ("notation.md", "notation.html"),
    ("variants.toml", "mistakes.html"),
];

/// A whole text; its title is the heading of the page.
pub fn page(text: &str) -> Markup {
    let events: Vec<Event> = Parser::new_ext(text, Options::ENABLE_TABLES).collect();
    let mut parts = Vec::new();
    let mut heading = String::new();
    let mut rest = &events[..];
    while let Some(event) = rest.first() {
        let (end, markup) = match event {
            Event::Start(Tag::Heading { level, .. }) => {
                let end = end_of(rest, TagEnd::Heading(*level));
                heading = text_of(rest[..end].iter().cloned());
                (end, set_heading(&rest[1..end - 1], *level as usize, &heading))
            }
            Event::Start(Tag::Table(_)) => {
                let end = end_of(rest, TagEnd::Table);
                (end, set_table(&rest[..end], &heading))
            }
            _ => {
                let end = rest
                    .iter()
                    .skip(1)
                    .position(stands_apart)
                    .map_or(rest.len(), |end| end + 1);
                (end, set(&rest[..end]))
            }
        };
        parts.push(markup);
        rest = &rest[end..];
    }
    html! { @for part in &parts { (part) } }
}

/// The sections of a text under these headings of the second level, in their order; before the first one stands the beginning, `""`.
pub fn sections(text: &str, headings: &[&str]) -> Markup {
    let mut all = text.split("\n## ");
    let beginning = all.next().unwrap_or_default();
    let with_titles: Vec<(&str, &str)> = all
        .map(|section| (section.lines().next().unwrap_or_default(), section))
        .collect();
    let chosen = headings.iter().map(|heading| match *heading {
        "" => beginning.to_owned(),
        heading => {
            let section = with_titles.iter().find(|(title, _)| *title == heading);
            section.map_or_else(String::new, |(_, section)| format!("\n## {section}"))
        }
    });
    page(&chosen.collect::<String>())
}

fn stands_apart(event: &Event) -> bool {
    matches!(event, Event::Start(Tag::Heading { .. } | Tag::Table(_)))
}

/// The number of events up to the end of a tag.
fn end_of(events: &[Event], tag: TagEnd) -> usize {
    let end = events.iter().position(|event| *event == Event::End(tag));
    end.map_or(events.len(), |end| end + 1)
}

/// The anchor of a heading: its words in small letters, joined by hyphens.
fn anchor(heading: &str) -> String {
    let kept: String = heading
        .to_lowercase()
        .chars()
        .filter(|letter| letter.is_alphanumeric() || matches!(letter, ' ' | '-'))
        .collect();
    kept.split_whitespace().collect::<Vec<_>>().join("-")
}

fn set_heading(inside: &[Event], level: usize, heading: &str) -> Markup {
    let (inside, anchor) = (set(inside), anchor(heading));
    html! {
        @match level {
            1 => h1 id=(anchor) { (inside) },
            2 => h2 id=(anchor) { (inside) },
            3 => h3 id=(anchor) { (inside) },
            _ => h4 id=(anchor) { (inside) },
        }
    }
}

/// A table whose first cells are the headers of their rows. Its caption is the heading under which it stands, which is there already for
/// those who see it.
fn set_table(events: &[Event], heading: &str) -> Markup {
    let rows = rows(events.iter().cloned());
    let (header, body) = rows
        .split_first()
        .map_or((&[][..], &[][..]), |(header, body)| (&header[..], body));
    let has_header = header.iter().any(|cell| !cell.is_empty());
    framed(
        heading,
        &html! {
            table {
                caption.aloud { (heading) }
                @if has_header { thead { tr { @for cell in header { th scope="col" { (set(cell)) } } } } }
                tbody {
                    @for row in body {
                        tr {
                            @for (place, cell) in row.iter().enumerate() {
                                @if place == 0 { th scope="row" { (set(cell)) } } @else { td { (set(cell)) } }
                            }
                        }
                    }
                }
            }
        },
    )
}

/// Events as HTML, links led to the pages of the site.
fn set(events: &[Event]) -> Markup {
    let mut text = String::new();
    push_html(&mut text, led(events.iter().cloned(), target).into_iter());
    PreEscaped(text)
}

/// Where a link of the tree leads on the site, if it does.
fn target(link: &str) -> Option<String> {
    if link.starts_with('#') || link.starts_with("https://doi.org/") {
        return Some(link.to_owned());
    }
    let (file, anchor) = link.split_once('#').map_or((link, ""), |(file, anchor)| (file, anchor));
    let name = file.rsplit('/').next()?;
    let (_, page) = PAGES
        .into_iter()
        .find(|(source, _)| *source == name && !file.contains("tests/") && !file.contains("python/"))?;
    Some(if anchor.is_empty() {
        page.to_owned()
    } else {
        format!("{page}#{anchor}")
    })
}
