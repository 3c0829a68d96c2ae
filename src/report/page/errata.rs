//! The errata of a paper: the printed form beside the corrected one, the reason, and the test that shows it.

use super::markup::formula;
use crate::book::{Entry, entries_of};
use crate::paper::Paper;
use crate::paper::specification::Erratum;
use maud::{Markup, html};

/// The errata of a paper, in the paper's order.
pub fn section(paper: Paper) -> Markup {
    let key = paper.key();
    let errata: Vec<(&Entry, &Erratum)> = entries_of(paper)
        .filter_map(|entry| Some((entry, entry.equation.erratum.as_ref()?)))
        .collect();
    html! {
        section aria-labelledby=(format!("{key}-errata")) {
            h2 id=(format!("{key}-errata")) { "Misprints in " (key) }
            p { "The proofs are in the book of equations. " (errata.len()) " of " (entries_of(paper).count()) " equations are printed wrongly." }
            @for (entry, erratum) in errata { (article(entry, erratum)) }
        }
    }
}

/// An erratum; its proof stands with the equation in the book.
fn article(entry: &Entry, erratum: &Erratum) -> Markup {
    html! {
        article.erratum id={ "erratum-" (erratum.id) } {
            h3 { a href={ "#" (entry.anchor()) } { (entry.reference) } " " span.id { (erratum.id) } }
            p { (erratum.why) }
            div.forms {
                figure.printed { figcaption { "as printed" } (formula(&erratum.printed)) }
                figure.right { figcaption { "corrected" } (formula(&entry.equation.latex)) }
            }
        }
    }
}
