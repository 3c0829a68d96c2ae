//! Output for people: tables and figures.
//!
//! Each command's answer is formatted here. The JSON output serialises the values themselves; nothing is computed here.
//!
//! - [`rule`]: points and weights; [`trace`]: a run step by step; [`cases`], [`variants`], [`claims`]: the lists of what there is;
//! - [`reproduction`], [`published`], [`figure`], [`path`], [`long_term`], [`fit_error`], [`divergence`]: the papers' tables and figures,
//!   published and computed;
//! - [`outcome`]: what became of published figures, in a sentence;
//! - [`conversion`]: where a converted measurement can be trusted;
//! - [`comparison`], [`comparison_figure`]: which filter a problem should have;
//! - [`stability`], [`stability_bank`], [`stability_map`]: two fixed-gain filters, those of a problem file, and all pairs;
//! - [`check`], [`check_json`], [`verdict`]: the verdict on a program under test; [`search`]: what a search has found;
//! - [`chart`], [`palette`]: what all figures have in common;
//! - [`page`]: all of the papers' results in one file.

mod behaviour;
pub mod cases;
pub mod chart;
pub mod check;
pub mod check_json;
pub mod claims;
pub mod comparison;
pub mod comparison_figure;
pub mod conversion;
pub mod divergence;
pub mod equation;
mod fault;
pub mod figure;
pub mod fit_error;
mod formula;
pub mod literal;
pub mod long_term;
mod observation;
pub mod outcome;
pub mod page;
pub mod palette;
pub mod path;
pub mod published;
pub mod reproduction;
pub mod rule;
pub mod search;
pub mod stability;
pub mod stability_bank;
pub mod stability_map;
mod stability_proof;
pub mod trace;
pub mod variants;
pub mod verdict;

use crate::paper::specification::Citation;
use comfy_table::{CellAlignment, ColumnConstraint, ContentArrangement, LineStyle, Table, TableStyle, Width};

/// The width that all tables fit.
pub const WIDTH: u16 = 100;

/// A line above, below and under the header; nothing between rows.
const STYLE: TableStyle = TableStyle::new()
    .top_border(LineStyle::none().fill('─').junction('─'))
    .header_separator(LineStyle::none().fill('─').junction('─'))
    .bottom_border(LineStyle::none().fill('─').junction('─'));

/// A table with a header, its columns from the second on aligned to the right.
fn table(header: &[&str]) -> Table {
    let mut table = Table::new();
    table
        .load_style(STYLE)
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_width(WIDTH)
        .set_header(header.to_vec());
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// A column whose entries are not broken into lines: names that a reader may want to copy.
fn never_broken(table: &mut Table, index: usize) {
    if let Some(column) = table.column_mut(index) {
        column.set_constraint(ColumnConstraint::ContentWidth);
    }
}

/// A column that is as wide as its longest word at least, so that no identifier is broken.
fn words_whole(table: &mut Table, index: usize) {
    let mut longest = 0;
    for cell in table.row_iter().filter_map(|row| row.cell_iter().nth(index)) {
        for word in cell.content().split_whitespace() {
            longest = longest.max(word.chars().count());
        }
    }
    if let Some(column) = table.column_mut(index) {
        let width = u16::try_from(longest).unwrap_or(WIDTH) + column.padding_width();
        column.set_constraint(ColumnConstraint::LowerBoundary(Width::Fixed(width)));
    }
}

/// A number of standard errors, with its sign.
pub fn standard_errors(value: f64) -> String {
    if !value.is_finite() {
        return "—".to_owned();
    }
    if value.abs() < 10.0 {
        format!("{value:+.1}")
    } else {
        format!("{value:+.0}")
    }
}

/// A paper's key, title and source, the key standing out.
fn citation(paper: &Citation) -> String {
    let indent = indent_of(paper);
    let mut text = wrapped(&paper.title, &indent);
    text.replace_range(..indent.len(), &format!("{:<width$}", paper.key, width = indent.len()));
    let source = match paper.doi.as_str() {
        "" => paper.venue.clone(),
        doi => format!("{}, doi:{doi}", paper.venue),
    };
    text.push_str(&wrapped(&source, &indent));
    text
}

/// As wide as a paper's key and a blank, and nine at least.
fn indent_of(paper: &Citation) -> String {
    " ".repeat(9.max(paper.key.len() + 1))
}

/// A paragraph broken at words, every line indented.
fn wrapped(paragraph: &str, indent: &str) -> String {
    let mut text = String::new();
    for line in broken(paragraph, usize::from(WIDTH) - indent.len()) {
        text.push_str(indent);
        text.push_str(&line);
        text.push('\n');
    }
    text
}

/// A paragraph broken at words into lines of a maximum length; at least one line.
fn broken(paragraph: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in paragraph.split_whitespace() {
        let length = lines.last().map_or(0, |line| line.chars().count());
        if length > 0 && length + 1 + word.chars().count() > width {
            lines.push(word.to_owned());
        } else if let Some(line) = lines.last_mut() {
            if length > 0 {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    lines
}
