//! LaTeX and doc comments as HTML.
//!
//! Formulas are MathML, which browsers display without help.

use crate::book::markup::{cells, events};
use crate::book::source::Item;
use maud::{Markup, PreEscaped, html};
use pulldown_cmark::{Event, Tag, TagEnd};
use pulldown_latex::config::DisplayMode;
use pulldown_latex::{ParserError, RenderConfig, Storage, push_mathml};

/// A formula on a line of its own as MathML, with its LaTeX as annotation.
///
/// # Errors
///
/// What in it is no LaTeX.
pub fn math(latex: &str) -> Result<Markup, String> {
    let storage = Storage::new();
    let events: Result<Vec<_>, _> = pulldown_latex::Parser::new(latex, &storage).collect();
    let events = events.map_err(|error| error.to_string())?;
    // What stands in an annotation is text.
    let annotation = html! { (latex) }.into_string();
    let config = RenderConfig {
        display_mode: DisplayMode::Block,
        annotation: Some(&annotation),
        ..RenderConfig::default()
    };
    let mut text = String::new();
    let events = events.into_iter().map(Ok::<_, Box<ParserError>>);
    push_mathml(&mut text, events, config).map_err(|error| error.to_string())?;
    // The renderer writes the sign as it stands, and of a blank the name.
    let text = text.replace("<mo><</mo>", "<mo>&lt;</mo>");
    let text = text.replace("<mtext>&amp;nbsp;</mtext>", "<mspace width=\"0.33em\" />");
    Ok(PreEscaped(text))
}

/// A formula as MathML; one that cannot be read as it is written, which a test excludes.
pub fn formula(latex: &str) -> Markup {
    math(latex).unwrap_or_else(|_| html! { pre { (latex) } })
}

/// Paragraphs of a doc comment.
pub fn paragraphs(markdown: &str, of: &Item) -> Markup {
    rendered(events(markdown, of).into_iter())
}

/// A sentence of a doc comment, without a paragraph around it.
pub fn sentence(markdown: &str, of: &Item) -> Markup {
    let is_paragraph = |event: &Event| matches!(event, Event::Start(Tag::Paragraph) | Event::End(TagEnd::Paragraph));
    rendered(events(markdown, of).into_iter().filter(|event| !is_paragraph(event)))
}

/// A table of a doc comment, with what its columns and rows are.
pub fn table(markdown: &str, of: &Item, caption: &str) -> Markup {
    let mut rows = cells(markdown, of).into_iter();
    let header = rows.next().unwrap_or_default();
    html! {
        table class="dictionary" {
            caption { (caption) }
            thead { tr { @for cell in header { th scope="col" { (rendered(cell.into_iter())) } } } }
            tbody {
                @for row in rows {
                    tr {
                        @for (index, cell) in row.into_iter().enumerate() {
                            @let cell = rendered(cell.into_iter());
                            @if index == 0 { th scope="row" { (cell) } } @else { td { (cell) } }
                        }
                    }
                }
            }
        }
    }
}

fn rendered<'a>(events: impl Iterator<Item = Event<'a>>) -> Markup {
    let mut text = String::new();
    pulldown_cmark::html::push_html(&mut text, events);
    PreEscaped(text)
}
