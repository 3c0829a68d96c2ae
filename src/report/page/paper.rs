//! The page of one paper: its scenarios in figures, its tables beside the computed ones, its claims and its errata.

use super::content::{Content, OfPaper};
use super::table::{framed, table};
use super::{errata, figures, ledger};
use crate::paper::Paper;
use crate::paper::comparison::ErrorQuantity;
use crate::paper::result::Reproduction;
use crate::paper::specification::{Citation, PublishedTable};
use crate::report::chart::NotDrawn;
use crate::report::reproduction::{self, SideBySide, compare};
use crate::report::standard_errors;
use crate::statistics::estimate::figure;
use maud::{Markup, html};

/// The page of a paper.
///
/// # Errors
///
/// [`NotDrawn`] when a figure cannot be drawn.
pub fn page(of_paper: &OfPaper, content: &Content) -> Result<Markup, NotDrawn> {
    let specification = of_paper.paper.specification();
    let key = of_paper.paper.key();
    let mut simulations = Vec::new();
    for reproductions in &of_paper.simulations {
        simulations.push(simulation(of_paper.paper, reproductions)?);
    }
    Ok(html! {
        h1 id=(key) { (key) ": " (specification.paper.title) }
        (citation(&specification.paper))
        p {
            a href=(format!("#{key}-claims")) { "claims" } " · " a href=(format!("#{key}-figures")) { "simulations" } " · "
            a href=(format!("#{key}-errata")) { "misprints" } " · " a href=(format!("#book-{key}")) { "equations" }
        }
        (ledger::section(of_paper))
        section aria-labelledby=(format!("{key}-figures")) {
            h2 id=(format!("{key}-figures")) { "What " (key) " simulates" }
            @if let Some(figure) = figures::published_and_computed(of_paper)? { (figure) }
            @for simulation in &simulations { (simulation) }
            @for figure in figures::of_paper(of_paper.paper, content)? { (figure) }
            @for table in &specification.tables { (unreproduced(of_paper, table)) }
        }
        (errata::section(of_paper.paper))
    })
}

fn citation(paper: &Citation) -> Markup {
    html! {
        p.citation {
            (paper.authors) ". " (paper.venue)
            @if !paper.doi.is_empty() { ", " a href=(format!("https://doi.org/{}", paper.doi)) { "doi:" (paper.doi) } }
            "."
        }
    }
}

/// One simulation: figures, tables, and each open choice by itself.
fn simulation(paper: Paper, reproductions: &[Reproduction]) -> Result<Markup, NotDrawn> {
    let Some(main) = reproductions.first() else {
        return Ok(html! {});
    };
    let figures = figures::of_simulation(main)?;
    let tables = &paper.specification().tables;
    let compared = tables.iter().map(|table| (table, compare(paper, main, table)));
    Ok(html! {
        h3 id=(name(main)) { (title(paper, main)) }
        p { (main.runs) " runs of " (main.steps) " steps, seed " (main.seed) "." }
        @for (table, comparisons) in compared {
            @if !comparisons.is_empty() { (side_by_side(table, &comparisons)) }
        }
        @for figure in figures { (figure) }
        (differences(main))
        (consistency(main))
        @if reproductions.len() > 1 {
            details {
                summary { "One open choice at a time, the others at their defaults" }
                (alternatives(paper, reproductions))
            }
        }
    })
}

/// The name of a simulation in anchors.
pub fn name(reproduction: &Reproduction) -> String {
    match reproduction.choices.chosen("scenario") {
        Some(scenario) => format!("{}-simulation-{scenario}", reproduction.paper),
        None => format!("{}-simulation", reproduction.paper),
    }
}

/// What is simulated, in the words of the specification.
fn title(paper: Paper, reproduction: &Reproduction) -> String {
    let specification = paper.specification();
    let scenarios = specification
        .parameters
        .iter()
        .find(|parameter| parameter.name == "scenario");
    let Some(scenarios) = scenarios else {
        return "The scenario at the printed parameters".to_owned();
    };
    let name = reproduction.choices.chosen("scenario").unwrap_or(&scenarios.default);
    let scenario = scenarios
        .alternatives
        .iter()
        .find(|alternative| alternative.name == name);
    scenario.map_or_else(String::new, |scenario| scenario.meaning.clone())
}

/// A published table beside the computed one.
fn side_by_side(published: &PublishedTable, comparisons: &[SideBySide]) -> Markup {
    let caption = format!(
        "Table {} of the paper, published beside computed. {}",
        published.number, published.caption
    );
    framed(
        &caption,
        &html! {
            table.numbers {
                caption { (caption) }
                thead { tr { @for cell in reproduction::HEADER { th scope="col" { (cell) } } } }
                @for row in comparisons.chunk_by(|one, other| one.row == other.row) {
                    tbody { (rows_of(row)) }
                }
            }
            p.note { (reproduction::DIFFERENCE_NOTE) }
        },
    )
}

/// The rows of one quantity, one row per filter.
fn rows_of(comparisons: &[SideBySide]) -> Markup {
    html! {
        @for (place, comparison) in comparisons.iter().enumerate() {
            tr {
                @if place == 0 {
                    th scope="rowgroup" rowspan=(comparisons.len()) { (comparison.row) " (" (comparison.unit) ")" }
                }
                th scope="row" { (comparison.filter) }
                td { (comparison.published) }
                td { (figure(comparison.computed)) }
                td { (figure(comparison.standard_error)) }
                td { (standard_errors(comparison.difference_in_standard_errors)) }
            }
        }
    }
}

/// A published table that no simulation is of: what the claims say of it is computed there.
fn unreproduced(of_paper: &OfPaper, published: &PublishedTable) -> Markup {
    let is_reproduced = |reproductions: &Vec<Reproduction>| {
        reproductions
            .first()
            .is_some_and(|main| !compare(of_paper.paper, main, published).is_empty())
    };
    if of_paper.simulations.iter().any(is_reproduced) {
        return html! {};
    }
    let caption = format!(
        "Table {} of the paper, as published; what it says is judged among the claims. {}",
        published.number, published.caption
    );
    let header: Vec<&str> = [""]
        .into_iter()
        .chain(published.columns.iter().map(String::as_str))
        .collect();
    let rows: Vec<Vec<String>> = published
        .rows
        .iter()
        .map(|row| {
            let unit = if row.unit == "1" {
                String::new()
            } else {
                format!(" ({})", row.unit)
            };
            let values = row.values.iter().map(ToString::to_string);
            [format!("{}{unit}", row.name)].into_iter().chain(values).collect()
        })
        .collect();
    table(&caption, &header, &rows)
}

/// The filters compared in pairs.
fn differences(reproduction: &Reproduction) -> Markup {
    let of = |quantity| reproduction.differences.iter().filter(move |d| d.quantity == quantity);
    let pairs = of(ErrorQuantity::Position).zip(of(ErrorQuantity::Velocity));
    let rows: Vec<Vec<String>> = pairs
        .map(|(position, velocity)| {
            let cells = [position, velocity].map(|difference| reproduction::with_distance(difference.estimate));
            let names = [format!("{} − {}", position.filter, position.minus)];
            names.into_iter().chain(cells.into_iter().flatten()).collect()
        })
        .collect();
    let caption = "Paired differences of root mean square errors: the same truth and noise for both filters";
    table(
        caption,
        &["", "position (m)", "/ s.e.", "velocity (m/s)", "/ s.e."],
        &rows,
    )
}

/// Whether the filters know their own errors.
fn consistency(reproduction: &Reproduction) -> Markup {
    let rows: Vec<Vec<String>> = reproduction
        .filters
        .iter()
        .map(|filter| {
            let [nees, nis] = [&filter.nees, &filter.nis];
            vec![
                filter.name.clone(),
                figure(nees.mean.value),
                reproduction::inside(nees),
                figure(nis.mean.value),
                reproduction::inside(nis),
                filter.failures.len().to_string(),
            ]
        })
        .collect();
    let expected = reproduction
        .filters
        .first()
        .map(|filter| [filter.nees.expected, filter.nis.expected]);
    let [nees, nis] = expected.unwrap_or([f64::NAN; 2]);
    let caption = format!(
        "Consistency. NEES compares errors with the filter’s own covariance ({nees} if they match, more if it is over-confident), NIS \
         innovations with theirs ({nis}). Inside: the part of the steps within the 95 % bounds of a matched filter."
    );
    table(&caption, &["", "NEES", "inside", "NIS", "inside", "failed runs"], &rows)
}

/// The error under each open choice.
fn alternatives(paper: Paper, reproductions: &[Reproduction]) -> Markup {
    let alternatives = reproduction::under_each_choice(paper, reproductions);
    let header: Vec<&str> = ["choice"]
        .into_iter()
        .chain(alternatives.filters.iter().copied())
        .collect();
    table(alternatives.measure, &header, &alternatives.rows)
}
