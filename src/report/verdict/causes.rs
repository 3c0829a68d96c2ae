//! What explains the faults, as HTML.
//!
//! After this file the reader knows how names of the catalogue, several together, and formulas without a name look on the page.

use crate::oracle::diagnose::{Diagnosis, Share};
use crate::oracle::formula::{ComputedFormula, ComputedFormulas};
use crate::oracle::variant::Variant;
use maud::{Markup, html};

/// The diagnosis; nothing where there is nothing to explain.
pub(super) fn causes(diagnosis: &Diagnosis) -> Markup {
    match diagnosis {
        Diagnosis::Nothing => html! {},
        Diagnosis::One(variants) => html! {
            (list(variants))
            p { "With this, " (EXPLAINED) @if variants.len() > 1 { " These cannot be told apart by what was shown." } }
        },
        Diagnosis::Several(members) => html! {
            ol.causes { @for alternatives in members { li { (either(alternatives)) } } }
            p { "With these together, " (EXPLAINED) }
        },
        Diagnosis::Pairs(pairs) => html! {
            ol.causes { @for pair in pairs.iter().take(5) { li { (one(pair[0])) " " b { "and " } (one(pair[1])) } } }
            p {
                "With both, " (EXPLAINED)
                @if pairs.len() > 1 { " " (pairs.len()) " pairs do, and cannot be told apart by what was shown." }
            }
        },
        Diagnosis::ByFilter(filters) => html! {
            @for (name, of_filter) in filters {
                h3 { "Filter " (name) }
                @if *of_filter == Diagnosis::Nothing { p { "Nothing is wrong." } } @else { (causes(of_filter)) }
            }
        },
        Diagnosis::InParts {
            parts,
            unexplained,
            formulas,
            of,
            ..
        } => in_parts(parts, unexplained, formulas, *of),
    }
}

const EXPLAINED: &str = "every value that was shown is explained by the program’s own values before it.";

/// What is said where no one thing explains all.
fn in_parts(parts: &[Share], unexplained: &[String], formulas: &ComputedFormulas, of: usize) -> Markup {
    html! {
        @if !unexplained.is_empty() && !formulas.is_complete {
            p { "Nothing in the catalogue, alone or with others, explains every value." }
        }
        @for (index, part) in parts.iter().enumerate() {
            p {
                @if index == 0 { "This explains " (part.cases) " of the " (of) " cases with a fault:" }
                @else { "And this, alone or with the others, " (part.cases) " more:" }
            }
            (list(&part.variants))
        }
        @if !unexplained.is_empty() && !parts.is_empty() {
            p {
                @if formulas.is_complete { "The catalogue leaves " } @else { "Unexplained: " }
                @for (index, id) in unexplained.iter().enumerate() { @if index > 0 { ", " } code { (id) } }
                "."
            }
        }
        @for found in &formulas.found { (computed(found)) }
    }
}

/// What was computed in place of the right formula.
fn computed(found: &ComputedFormula) -> Markup {
    html! {
        p {
            "In " code { (found.quantity.name()) } " (" (found.filters.join(", "))
            @if let Some(condition) = &found.condition { ", " (condition) } ") this gives what is shown in "
            (found.explains) " of " (found.of) " faulty values:"
        }
        div.forms {
            figure.printed { figcaption { "computed" } p.id { (found.computed) } }
            figure.right { figcaption { "should be" } p.id { (found.right) } }
        }
    }
}

/// Alternatives, of which each explains the same.
fn list(variants: &[&Variant]) -> Markup {
    html! { ul.causes { @for variant in variants { li { (one(variant)) } } } }
}

/// The same inside of a sentence.
fn either(variants: &[&Variant]) -> Markup {
    html! { @for (index, variant) in variants.iter().enumerate() { @if index > 0 { b { " or " } } (one(variant)) } }
}

fn one(variant: &Variant) -> Markup {
    html! { (variant.about) " " span.note { "(" code { (variant.id) } ", " (variant.kind.name()) ")" } }
}
