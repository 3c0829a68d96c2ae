//! The catalogue of variants as text: one line each, or one in full with its effect, its source and the case that catches it.

use super::{never_broken, table, wrapped};
use crate::oracle::variant::{Kind, Variant};
use comfy_table::CellAlignment;
use serde_json::{Value, json};

/// One line per variant.
pub fn table_of(variants: &[Variant]) -> String {
    let mut table = table(&["variant", "kind", "equation of", "what you did"]);
    for column in table.column_iter_mut() {
        column.set_cell_alignment(CellAlignment::Left);
    }
    never_broken(&mut table, 0);
    for variant in variants {
        table.add_row(vec![
            &variant.id,
            variant.kind.name(),
            variant.quantity.name(),
            &variant.about,
        ]);
    }
    let count = |kind| variants.iter().filter(|variant| variant.kind == kind).count();
    let (mistakes, conventions, forms) = (count(Kind::Mistake), count(Kind::Convention), count(Kind::Form));
    format!("{table}\n{mistakes} mistakes, {conventions} conventions, {forms} forms\n")
}

/// One variant with all that is known of it.
pub fn in_full(variant: &Variant) -> String {
    let mut text = format!(
        "{}  ({}, equation of {})\n",
        variant.id,
        variant.kind.name(),
        variant.quantity.name()
    );
    for (name, paragraph) in [
        ("what", &variant.about),
        ("effect", &variant.effect),
        ("found in", &variant.source),
        ("caught by", &variant.case),
    ] {
        if !paragraph.is_empty() {
            text.push_str(&wrapped(&format!("{name}: {paragraph}"), "  "));
        }
    }
    text
}

/// A variant as JSON.
pub fn json(variant: &Variant) -> Value {
    json!({
        "id": variant.id,
        "kind": variant.kind.name(),
        "quantity": variant.quantity.name(),
        "applies": variant.applies,
        "about": variant.about,
        "effect": variant.effect,
        "source": variant.source,
        "case": variant.case,
        "convention": variant.convention,
        "value": variant.value,
    })
}
