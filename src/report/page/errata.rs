//! The errata of a paper: the printed and the corrected form side by side.
//!
//! After this file the reader knows what is wrong in a paper as printed, why, and which test shows it.

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
            p { (errata.len()) " of " (paper.specification().all_equations().count()) " equations." }
            @for (equation, erratum) in errata { (article(key, equation, erratum)) }
        }
    }
}

fn article(key: &str, equation: &Equation, erratum: &Erratum) -> Markup {
    html! {
        article.erratum id=(erratum.id) {
            h4 { (key) " " (equation.label()) " " span.id { (erratum.id) } }
            dl.forms {
                dt { "as printed" } dd { code { (erratum.printed) } }
                dt { "corrected" } dd { code { (equation.latex) } }
            }
            p { (erratum.why) }
            p { b { "Proof. " } (erratum.proof) }
            @if let Some(test) = &erratum.test { p.judged { b { "Test. " } code { (test) } } }
        }
    }
}
