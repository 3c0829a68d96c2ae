//! A table that scrolls on a narrow screen and can be read aloud.
//!
//! It has a caption, headers with their scope, and a region that takes the keyboard focus, so that it scrolls without a mouse.

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
