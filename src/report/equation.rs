//! An equation for people: its entry in the book, in one line and in full, with its code and the commands to run next.

use super::{never_broken, table, words_whole, wrapped};
use crate::book::doc::PartKind;
use crate::book::markup::{plain, text_rows};
use crate::book::{Entry, Realisation};
use comfy_table::CellAlignment;
use serde_json::{Value, json};
use std::fmt::Write;

/// One line per equation.
pub fn table_of(entries: &[&Entry]) -> String {
    let mut table = table(&["equation", "status", "what", "code"]);
    for column in table.column_iter_mut() {
        column.set_cell_alignment(CellAlignment::Left);
    }
    for entry in entries {
        let code: Vec<&str> = entry.realisations.iter().map(|one| one.item.name.as_str()).collect();
        table.add_row(vec![
            entry.reference.to_string(),
            entry.equation.status.clone(),
            entry.title(),
            code.join(", "),
        ]);
    }
    for column in [0, 1, 3] {
        words_whole(&mut table, column);
    }
    let next = "`immaculate equation zhu2016 56` shows one in full; the name of a value or a function works too";
    format!("{table}\n{} equations; {next}\n", entries.len())
}

/// An equation with everything that the book has about it.
pub fn in_full(entry: &Entry) -> String {
    let equation = entry.equation;
    let mut text = format!("{}  {}\n", entry.reference, entry.title());
    text.push_str(&wrapped(&equation.meaning, "  "));
    text.push_str(&wrapped(status(&equation.status), "  "));
    text.push_str("\nLATEX\n");
    text.push_str(&indented(&equation.latex, "  "));
    if let Some(erratum) = &equation.erratum {
        let _ = writeln!(text, "\nERRATUM  {} ({}), as printed", erratum.id, erratum.kind);
        text.push_str(&indented(&erratum.printed, "  "));
        text.push_str(&wrapped(&erratum.why, "  "));
        text.push_str(&wrapped(&format!("proof: {}", erratum.proof), "  "));
    }
    for realisation in &entry.realisations {
        text.push_str(&code(realisation));
    }
    text.push_str(&tests(entry));
    text.push_str(&mistakes(entry));
    text.push_str(&next(entry));
    text
}

/// The status in words.
pub fn status(status: &str) -> &'static str {
    match status {
        "as-printed" => "The paper prints this form.",
        "corrected" => "Corrected: the paper prints another form.",
        _ => "Reconstructed: the paper needs it but does not print it, or the available copy has lost it.",
    }
}

/// An item: its place, its doc comment part by part, and its code.
fn code(realisation: &Realisation) -> String {
    let (item, doc) = (&realisation.item, &realisation.doc);
    let mut text = format!("\nCODE  {} ({})  {}:{}\n", item.name, item.kind, item.path, item.line);
    let remark = if doc.remark.is_empty() {
        String::new()
    } else {
        format!(": {}", doc.remark)
    };
    text.push_str(&wrapped(&plain(&format!("{}{remark}", doc.title), item), "  "));
    for part in &doc.parts {
        let label = match part.kind {
            PartKind::Formula => {
                text.push_str(&indented(&part.text, "    "));
                continue;
            }
            PartKind::Dictionary => {
                text.push_str(&dictionary(&text_rows(&part.text, item)));
                continue;
            }
            // An example is in the documentation, tests and mistakes have lists of their own.
            PartKind::Example | PartKind::Mistakes | PartKind::Evidence => continue,
            PartKind::Derivation => "",
            PartKind::Source => "source: ",
            PartKind::Errata => "errata: ",
            PartKind::Errors => "errors: ",
        };
        text.push_str(&wrapped(&format!("{label}{}", plain(&part.text, item)), "  "));
    }
    text.push_str(&indented(&item.code, "    "));
    text
}

fn dictionary(rows: &[Vec<String>]) -> String {
    let mut rows = rows.iter();
    let header: Vec<&str> = rows.next().into_iter().flatten().map(String::as_str).collect();
    let mut table = table(&header);
    for column in table.column_iter_mut() {
        column.set_cell_alignment(CellAlignment::Left);
    }
    for row in rows {
        table.add_row(row);
    }
    format!("{table}\n")
}

fn tests(entry: &Entry) -> String {
    let mut text = "\nHELD BY\n".to_owned();
    for evidence in &entry.evidence {
        let _ = writeln!(text, "  {} ({})", evidence.test, evidence.kind);
        let _ = writeln!(text, "    {}:{}", evidence.path, evidence.line);
    }
    text
}

/// The mistakes and the cases that catch them, or why there are none.
fn mistakes(entry: &Entry) -> String {
    if let Some(reason) = &entry.equation.outside {
        return format!("\nOUTSIDE A STEP\n{}", wrapped(reason, "  "));
    }
    let quantities: Vec<&str> = entry.quantities.iter().map(|quantity| quantity.name()).collect();
    let mut text = format!("\nMISTAKES in {}\n", quantities.join(", "));
    let mut table = table(&["mistake or convention", "what you did", "case"]);
    for column in table.column_iter_mut() {
        column.set_cell_alignment(CellAlignment::Left);
    }
    never_broken(&mut table, 0);
    for variant in &entry.mistakes {
        table.add_row(vec![&variant.id, &variant.about, &variant.case]);
    }
    let _ = writeln!(text, "{table}");
    text
}

/// What can be run next.
fn next(entry: &Entry) -> String {
    let mut text = "\nNEXT\n".to_owned();
    let mut add = |command: String, what: &str| {
        let _ = writeln!(text, "  {command}\n    {what}");
    };
    if let Some(variant) = entry.mistakes.first() {
        add(
            format!("immaculate variants {}", variant.id),
            "the first mistake in full",
        );
        add(
            format!("immaculate cases show {}", variant.case),
            "the case meant to catch it",
        );
        add(
            format!("immaculate check --case {} -- COMMAND", variant.case),
            "your filter on it",
        );
    }
    if let Some(evidence) = entry.evidence.first() {
        let file = evidence.path.trim_start_matches("tests/").trim_end_matches(".rs");
        add(
            format!("cargo test --test {file} {}", evidence.test),
            "the first test, in the source",
        );
    }
    add(
        format!("immaculate claims {}", entry.paper.key()),
        "the paper's claims, judged",
    );
    text
}

/// Lines with blanks before them.
fn indented(text: &str, indent: &str) -> String {
    text.lines().fold(String::new(), |all, line| {
        let line = format!("{indent}{line}");
        all + line.trim_end() + "\n"
    })
}

/// An equation as JSON.
pub fn json(entry: &Entry) -> Value {
    let equation = entry.equation;
    let tests = entry.evidence.iter().map(|evidence| {
        json!({ "name": evidence.test, "kind": evidence.kind, "path": evidence.path, "line": evidence.line })
    });
    let mistakes = entry.mistakes.iter().map(|variant| {
        json!({ "id": variant.id, "kind": variant.kind.name(), "about": variant.about, "case": variant.case })
    });
    json!({
        "id": entry.anchor(),
        "paper": entry.paper.key(),
        "number": equation.number,
        "name": equation.name,
        "title": entry.title(),
        "latex": equation.latex,
        "status": equation.status,
        "meaning": equation.meaning,
        "erratum": equation.erratum,
        "code": entry.realisations.iter().map(|one| code_json(one)).collect::<Vec<_>>(),
        "tests": tests.collect::<Vec<_>>(),
        "quantities": equation.quantities,
        "mistakes": mistakes.collect::<Vec<_>>(),
        "cases": entry.cases(),
        "outside": equation.outside,
    })
}

fn code_json(realisation: &Realisation) -> Value {
    let (item, doc) = (&realisation.item, &realisation.doc);
    let of = |kind: PartKind| doc.of(kind).map(|text| plain(text, item)).collect::<Vec<_>>();
    let dictionaries = doc.of(PartKind::Dictionary).map(|text| text_rows(text, item));
    json!({
        "name": item.name,
        "kind": item.kind,
        "path": item.path,
        "line": item.line,
        "title": plain(&doc.title, item),
        "formulas": doc.of(PartKind::Formula).collect::<Vec<_>>(),
        "dictionary": dictionaries.flatten().collect::<Vec<_>>(),
        "derivation": of(PartKind::Derivation),
        "source": of(PartKind::Source),
        "errors": of(PartKind::Errors),
        "errata": of(PartKind::Errata),
        "code": item.code,
    })
}
