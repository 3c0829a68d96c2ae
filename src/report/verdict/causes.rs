//! What explains the faults, as HTML.
//!
//! These are entries of the catalogue, alone or several together, and computed formulas that have no name.

use crate::oracle::diagnose::{Diagnosis, Share};
use crate::oracle::formula::{ComputedFormula, ComputedFormulas};
use crate::oracle::variant::Variant;
use maud::{Markup, html};

/// The diagnosis; empty if there is nothing to explain.
pub(super) fn causes(diagnosis: &Diagnosis) -> Markup {
    match diagnosis {
        Diagnosis::Nothing => html! {},
        Diagnosis::One(variants) => html! {
            (list(variants))
            p { "With this, " (EXPLAINED) @if variants.len() > 1 { " The shown values cannot distinguish them." } }
        },
        Diagnosis::Several(members) => html! {
            ol.causes { @for alternatives in members { li { (either(alternatives)) } } }
            p { "With these together, " (EXPLAINED) }
        },
        Diagnosis::Pairs(pairs) => html! {
            ol.causes { @for pair in pairs.iter().take(5) { li { (one(pair[0])) " " b { "and " } (one(pair[1])) } } }
            p {
                "With both, " (EXPLAINED)
                @if pairs.len() > 1 { " " (pairs.len()) " pairs do; the shown values cannot distinguish them." }
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

const EXPLAINED: &str = "every shown value is explained by the program’s own earlier values.";

/// The diagnosis when no single entry explains every value.
fn in_parts(parts: &[Share], unexplained: &[String], formulas: &ComputedFormulas, of: usize) -> Markup {
    html! {
        @if !unexplained.is_empty() && !formulas.is_complete {
            p { "No entry of the catalogue, alone or with others, explains every value." }
        }
        @for (index, part) in parts.iter().enumerate() {
            p {
                @if index == 0 { "This explains " (part.cases) " of the " (of) " cases with a fault:" }
                @else { "This, alone or with the others, explains " (part.cases) " more:" }
            }
            (list(&part.variants))
        }
        @if !unexplained.is_empty() && !parts.is_empty() {
            p {
                @if formulas.is_complete { "Not explained by the catalogue: " } @else { "Unexplained: " }
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
            @if let Some(condition) = &found.condition { ", " (condition) } ") this formula gives the shown value in "
            (found.explains) " of " (found.of) " faulty values:"
        }
        div.forms {
            figure.printed { figcaption { "computed" } p.id { (found.computed) } }
            figure.right { figcaption { "should be" } p.id { (found.right) } }
        }
    }
}

/// Alternatives; each explains the same.
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
