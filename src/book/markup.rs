//! Doc comments as Markdown and as plain text.
//!
//! A link in a doc comment leads to the code if the book has it; otherwise only its name remains.

use super::source::Item;
use super::{Realisation, realisations};
use pulldown_cmark::{BrokenLink, CowStr, Event, Options, Parser, Tag, TagEnd};

/// The cells of a table of a doc comment, row by row, as text.
pub fn text_rows(markdown: &str, of: &Item) -> Vec<Vec<String>> {
    let rows = cells(markdown, of).into_iter();
    rows.map(|row| row.into_iter().map(|cell| text_of(cell.into_iter())).collect())
        .collect()
}

/// A paragraph of a doc comment as text.
pub fn plain(markdown: &str, of: &Item) -> String {
    text_of(events(markdown, of).into_iter())
}

/// The words, without what sets them.
pub fn text_of<'a>(events: impl Iterator<Item = Event<'a>>) -> String {
    let mut text = String::new();
    for event in events {
        match event {
            Event::Text(words) | Event::Code(words) => text.push_str(&words),
            Event::SoftBreak | Event::HardBreak => text.push(' '),
            _ => {}
        }
    }
    text
}

/// A row of a table: what stands in each of its cells.
pub type MarkdownRow<'a> = Vec<Vec<Event<'a>>>;

/// The rows of the tables of a doc comment; the first is the header.
pub fn cells<'a>(markdown: &'a str, of: &Item) -> Vec<MarkdownRow<'a>> {
    rows(events(markdown, of))
}

/// The rows of the tables among events; the first is the header.
pub fn rows<'a>(events: impl IntoIterator<Item = Event<'a>>) -> Vec<MarkdownRow<'a>> {
    let mut rows: Vec<MarkdownRow> = Vec::new();
    for event in events {
        match event {
            Event::Start(Tag::TableHead | Tag::TableRow) => rows.push(Vec::new()),
            Event::Start(Tag::TableCell) => {
                if let Some(row) = rows.last_mut() {
                    row.push(Vec::new());
                }
            }
            Event::Start(Tag::Table(_))
            | Event::End(TagEnd::Table | TagEnd::TableHead | TagEnd::TableRow | TagEnd::TableCell) => {}
            inside => {
                if let Some(cell) = rows.last_mut().and_then(|row| row.last_mut()) {
                    cell.push(inside);
                }
            }
        }
    }
    rows
}

/// The markdown of an item, its links resolved.
pub fn events<'a>(markdown: &'a str, of: &Item) -> Vec<Event<'a>> {
    // A name in backticks and brackets is a link to the item of that name; anything else in brackets is a vector.
    let shortcut = |link: BrokenLink<'a>| {
        let is_name = link.reference.starts_with('`');
        is_name.then_some((link.reference, CowStr::Borrowed("")))
    };
    let parser = Parser::new_with_broken_link_callback(markdown, Options::ENABLE_TABLES, Some(shortcut));
    let as_meant = parser.map(|event| match event {
        // Angle brackets of a doc comment are meant.
        Event::Html(text) | Event::InlineHtml(text) => Event::Text(text),
        other => other,
    });
    led(as_meant, |address| target(address, of))
}

/// Events with each link led to its target; one that has none is its words.
pub fn led<'a>(events: impl IntoIterator<Item = Event<'a>>, target: impl Fn(&str) -> Option<String>) -> Vec<Event<'a>> {
    let mut is_link = Vec::new();
    let mut led = Vec::new();
    for event in events {
        match event {
            Event::Start(Tag::Link {
                link_type,
                dest_url,
                title,
                id,
            }) => {
                let target = target(&dest_url);
                is_link.push(target.is_some());
                let to = |dest_url: String| Tag::Link {
                    link_type,
                    dest_url: dest_url.into(),
                    title,
                    id,
                };
                led.extend(target.map(|address| Event::Start(to(address))));
            }
            Event::End(TagEnd::Link) => {
                if is_link.pop() == Some(true) {
                    led.push(event);
                }
            }
            other => led.push(other),
        }
    }
    led
}

/// Where a link leads: an address as it is, the path of an item to its code in the book, if it is there.
fn target(address: &str, of: &Item) -> Option<String> {
    if address.contains("://") {
        return Some(address.to_owned());
    }
    let path = address.trim_matches('`').rsplit('@').next().unwrap_or_default();
    let path = path.trim_end_matches("()").trim_start_matches("Self::");
    let named: Vec<&Realisation> = realisations().iter().filter(|one| is_named(&one.item, path)).collect();
    let near = named.iter().find(|one| one.item.path == of.path);
    near.or(named.first()).map(|one| format!("#{}", one.item.anchor()))
}

/// Whether a path leads to an item: the type's name counts if it is there.
fn is_named(item: &Item, path: &str) -> bool {
    item.name == path || path.ends_with(&format!("::{}", item.name)) || item.name.ends_with(&format!("::{path}"))
}
