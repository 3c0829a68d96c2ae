//! The catalogue of mistakes, conventions and forms as a page.

use super::table::framed;
use crate::imm::Quantity;
use crate::oracle::variant::{Kind, Variant, catalogue};
use maud::{Markup, html};

/// The page: a table a quantity, in the order of computation.
pub fn page() -> Markup {
    let count = |kind| catalogue().iter().filter(|variant| variant.kind == kind).count();
    let of = |quantity: Quantity| catalogue().iter().filter(move |variant| variant.quantity == quantity);
    let met = Quantity::ALL
        .into_iter()
        .filter(|&quantity| of(quantity).next().is_some());
    html! {
        h1 { "Mistakes that a verdict can name" }
        p {
            (count(Kind::Mistake)) " mistakes, " (count(Kind::Convention)) " conventions and " (count(Kind::Form)) " forms, listed by the value "
            "whose equation they concern. A mistake is wrong. A convention is a choice that the papers leave open; a program declares its own. A form "
            "computes the same value with different algebra and is never called wrong. A search over formulas finds mistakes that are not listed."
        }
        p { "Try one: " code { "immaculate check -- immaculate answer --plant mixed-spread-omitted" } "." }
        @for quantity in met {
            h2 id={ "mistakes-" (quantity.name()) } { code { (quantity.name()) } }
            (table(quantity, &of(quantity).collect::<Vec<_>>()))
        }
    }
}

fn table(quantity: Quantity, variants: &[&Variant]) -> Markup {
    let caption = format!("Mistakes, conventions and forms in {}", quantity.name());
    framed(
        &caption,
        &html! {
            table {
                caption.aloud { (caption) }
                thead { tr { th scope="col" { "name" } th scope="col" { "what you did" } th scope="col" { "what it does" } th scope="col" { "met in" } } }
                tbody {
                    @for variant in variants {
                        tr id={ "mistake-" (variant.id) } {
                            th scope="row" { code { (variant.id) } @if variant.kind != Kind::Mistake { " (" (variant.kind.name()) ")" } }
                            td { (variant.about) }
                            td { (variant.effect) }
                            td { (variant.source) }
                        }
                    }
                }
            }
        },
    )
}
