//! A table that can be scrolled where the screen is narrow, and read aloud.
//!
//! After this file the reader knows how every table of the page is marked up: a caption, headers with their scope, and a region that takes
//! the keyboard's focus so that it can be scrolled without a mouse.

use maud::{Markup, html};

/// A table of numbers: the first cell of a row is its header.
pub fn table(caption: &str, header: &[&str], rows: &[Vec<String>]) -> Markup {
    framed(
        caption,
        &html! {
            table.numbers {
                caption { (caption) }
                thead { tr { @for cell in header { th scope="col" { (cell) } } } }
                tbody {
                    @for row in rows {
                        tr {
                            @for (place, cell) in row.iter().enumerate() {
                                @if place == 0 { th scope="row" { (cell) } } @else { td { (cell) } }
                            }
                        }
                    }
                }
            }
        },
    )
}

/// A table in a region that scrolls.
pub fn framed(caption: &str, table: &Markup) -> Markup {
    html! { div.scroll role="region" aria-label=(caption) tabindex="0" { (table) } }
}
