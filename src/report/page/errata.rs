//! The errata of a paper: the printed and the corrected form side by side.
//!
//! After this file the reader knows what is wrong in a paper as printed, why, and which test shows it.

use crate::book::markup::formula;
use crate::paper::Paper;
use crate::paper::specification::{Equation, Erratum};
use maud::{Markup, html};

/// The errata of a paper, in the paper's order.
pub fn section(paper: Paper) -> Markup {
    let key = paper.key();
    let equations = paper.specification().all_equations();
    let errata: Vec<(&Equation, &Erratum)> = equations
        .filter_map(|equation| Some((equation, equation.erratum.as_ref()?)))
        .collect();
    html! {
        section aria-labelledby=(format!("{key}-errata")) {
            h3 id=(format!("{key}-errata")) { "What is wrong as printed in " (key) }
            p { "The proofs are in the book of equations. " (errata.len()) " of " (paper.specification().all_equations().count()) " equations are wrong as printed." }
            @for (equation, erratum) in errata { (article(key, equation, erratum)) }
        }
    }
}

/// An erratum; its proof stands with the equation in the book.
fn article(key: &str, equation: &Equation, erratum: &Erratum) -> Markup {
    let anchor = match (equation.number, &equation.name) {
        (Some(number), _) => format!("#{key}-{number}"),
        (None, name) => format!("#{key}-{}", name.as_deref().unwrap_or_default()),
    };
    html! {
        article.erratum id={ "erratum-" (erratum.id) } {
            h4 { a href=(anchor) { (key) " " (equation.label()) } " " span.id { (erratum.id) } }
            p { (erratum.why) }
            div.forms {
                figure.printed { figcaption { "as printed" } (formula(&erratum.printed)) }
                figure.right { figcaption { "corrected" } (formula(&equation.latex)) }
            }
        }
    }
}
