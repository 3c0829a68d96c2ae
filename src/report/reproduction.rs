//! A reproduction as text: published and computed values side by side.

use super::outcome::outcome;
use super::{citation, fit_error, indent_of, standard_errors, table, wrapped};
use crate::paper::Paper;
use crate::paper::comparison::ErrorQuantity;
use crate::paper::result::{Consistency, ErrorFigure, Figure, FirstRun, Performance, Reproduction};
use crate::paper::specification::{Choices, PublishedTable, Specification};
use crate::statistics::Estimate;
use crate::statistics::estimate::figure;
use serde::Serialize;
use std::fmt::Write;

/// A published figure beside the computed one.
#[derive(Debug, Clone, Serialize)]
pub struct SideBySide {
    /// The published table's number.
    pub table: u32,
    /// The row's name in the published table.
    pub row: String,
    /// The unit.
    pub unit: String,
    /// The filter.
    pub filter: String,
    /// As published.
    pub published: f64,
    /// As computed.
    pub computed: f64,
    /// Standard error of the computed figure.
    pub standard_error: f64,
    /// Computed minus published, in standard errors.
    pub difference_in_standard_errors: f64,
}

/// Every figure of the paper's tables that the runs reproduce.
pub fn published_and_computed(paper: Paper, reproduction: &Reproduction) -> Vec<SideBySide> {
    let tables = &paper.specification().tables;
    tables
        .iter()
        .flat_map(|table| compare(paper, reproduction, table))
        .collect()
}

/// Every figure of one table that the runs reproduce.
pub fn compare(paper: Paper, reproduction: &Reproduction, table: &PublishedTable) -> Vec<SideBySide> {
    let mut comparisons = Vec::new();
    for row in &table.rows {
        let Some(of_row) = paper.figure_of_row(&reproduction.choices, table.number, &row.name) else {
            continue;
        };
        for (column, published) in table.columns.iter().zip(&row.values) {
            let of_column = |filter: &&Performance| filter.name.starts_with(column.as_str());
            let Some(filter) = reproduction.filters.iter().find(of_column) else {
                continue;
            };
            let Some(estimate) = reproduction.figure(&filter.name, of_row) else {
                continue;
            };
            comparisons.push(SideBySide {
                table: table.number,
                row: row.name.clone(),
                unit: row.unit.clone(),
                filter: filter.name.clone(),
                published: *published,
                computed: estimate.value,
                standard_error: estimate.standard_error,
                difference_in_standard_errors: estimate.distance_from(*published),
            });
        }
    }
    comparisons
}

/// The errors of a reproduction without their histories: what is kept of the runs under each open choice.
#[derive(Debug, Clone, Serialize)]
pub struct Errors<'a> {
    choices: &'a Choices,
    filters: Vec<FilterErrors<'a>>,
}

/// The errors of one filter.
#[derive(Debug, Clone, Serialize)]
struct FilterErrors<'a> {
    name: &'a str,
    failed_runs: usize,
    errors: &'a [ErrorFigure],
    #[serde(skip_serializing_if = "Option::is_none")]
    fit_error: Option<Estimate>,
}

/// See [`Errors`].
pub fn errors_of<'a>(reproduction: &'a Reproduction) -> Errors<'a> {
    let of_filter = |filter: &'a Performance| FilterErrors {
        name: &filter.name,
        failed_runs: filter.failures.len(),
        errors: &filter.errors,
        fit_error: filter.fit_error,
    };
    Errors {
        choices: &reproduction.choices,
        filters: reproduction.filters.iter().map(of_filter).collect(),
    }
}

/// The answer of `reproduce` for one simulation, as text: published beside computed, and the paired differences. In full also delays,
/// consistency and cost.
pub fn text(paper: Paper, reproduction: &Reproduction, is_full: bool) -> String {
    let specification = paper.specification();
    let mut text = head(specification, reproduction);
    for table in &specification.tables {
        let comparisons = compare(paper, reproduction, table);
        if !comparisons.is_empty() {
            let _ = writeln!(text, "\nTable {}. {}", table.number, table.caption);
            let _ = writeln!(text, "{}", errors(&comparisons));
            let _ = writeln!(text, "{}", outcome(&comparisons));
            if is_full {
                text.push_str(DIFFERENCE_NOTE);
            }
        }
    }
    text.push_str(&fit_error::execution_times(specification, reproduction).unwrap_or_default());
    if published_and_computed(paper, reproduction).is_empty() {
        let _ = writeln!(text, "\nErrors, of which the paper publishes no figures");
        let _ = writeln!(text, "{}", unpublished(reproduction));
    }
    let _ = writeln!(text, "\nPaired differences: the same truth and noise for both filters");
    let _ = writeln!(text, "{}", differences(reproduction));
    for difference in &reproduction.fit_differences {
        let Estimate { value, standard_error } = difference.estimate;
        let _ = writeln!(
            text,
            "{} − {}, percentage fit error: {} ± {} %, {} standard errors",
            difference.filter,
            difference.minus,
            figure(value),
            figure(standard_error),
            standard_errors(difference.estimate.distance_from(0.0))
        );
    }
    if !is_full {
        return text + &failures(reproduction);
    }
    if reproduction.filters.iter().any(|filter| !filter.delays.is_empty()) {
        let _ = writeln!(text, "\nDelay until the true mode is more likely than not");
        let _ = writeln!(text, "{}", delays(reproduction));
    }
    let _ = writeln!(text, "\nConsistency and cost");
    let _ = writeln!(text, "{}", consistency(reproduction));
    text.push_str(&consistency_note(reproduction));
    text.push_str(&failures(reproduction));
    text
}

pub(super) const DIFFERENCE_NOTE: &str = "\
Difference: computed minus published, in standard errors of the computed figure. The published one has its own, about as
large, so that up to some 4 the two agree.
";

fn consistency_note(reproduction: &Reproduction) -> String {
    let expected = |of: fn(&Performance) -> f64| reproduction.filters.first().map_or(f64::NAN, of);
    format!(
        "\
NEES compares errors with the filter's own covariance ({} if they match, more if it is over-confident), NIS innovations
with theirs ({}). Inside: the part of the steps whose mean over runs is within the 95 % bounds of a matched filter.
Time ratio: a step's time beside the first filter's, the median over runs and half the distance of the quartiles.
",
        expected(|filter| filter.nees.expected),
        expected(|filter| filter.nis.expected),
    )
}

fn head(specification: &Specification, reproduction: &Reproduction) -> String {
    format!(
        "{}{}{} runs of {} steps, seed {}; choices: {}\n",
        citation(&specification.paper),
        indent_of(&specification.paper),
        reproduction.runs,
        reproduction.steps,
        reproduction.seed,
        reproduction.choices.describe(),
    )
}

/// What each column is where published figures stand beside computed ones.
pub(super) const HEADER: [&str; 6] = [
    "",
    "filter",
    "published",
    "computed",
    "standard error",
    "difference / s.e.",
];

fn errors(comparisons: &[SideBySide]) -> comfy_table::Table {
    let mut table = table(&HEADER);
    if let Some(column) = table.column_mut(1) {
        column.set_cell_alignment(comfy_table::CellAlignment::Left);
    }
    let mut last = "";
    for comparison in comparisons {
        let row = if last == comparison.row {
            String::new()
        } else {
            format!("{} ({})", comparison.row, comparison.unit)
        };
        last = &comparison.row;
        table.add_row([
            row,
            comparison.filter.clone(),
            comparison.published.to_string(),
            figure(comparison.computed),
            figure(comparison.standard_error),
            standard_errors(comparison.difference_in_standard_errors),
        ]);
    }
    table
}

/// A difference of errors below this, in metres or metres per second, is what rounding leaves at positions of some 10⁴ m, where the
/// spacing of doubles is 4 · 10⁻¹²: it says nothing about the filters.
const ROUNDING: f64 = 1e-11;

/// The errors of every filter, where there is nothing to stand beside them.
fn unpublished(reproduction: &Reproduction) -> comfy_table::Table {
    let mut header = vec![""];
    header.extend(ErrorQuantity::ALL.iter().map(|quantity| quantity.label()));
    let mut table = table(&header);
    for filter in &reproduction.filters {
        let mut row = vec![filter.name.clone()];
        row.extend(filter.errors.iter().map(|error| figure(error.estimate.value)));
        table.add_row(row);
    }
    table
}

fn differences(reproduction: &Reproduction) -> comfy_table::Table {
    let mut table = table(&["", "position (m)", "/ s.e.", "velocity (m/s)", "/ s.e."]);
    let of = |quantity| reproduction.differences.iter().filter(move |d| d.quantity == quantity);
    for (position, velocity) in of(ErrorQuantity::Position).zip(of(ErrorQuantity::Velocity)) {
        let mut row = vec![format!("{} − {}", position.filter, position.minus)];
        for difference in [position, velocity] {
            row.extend(with_distance(difference.estimate));
        }
        table.add_row(row);
    }
    table
}

/// A difference of errors, and how many standard errors it is from zero.
pub(super) fn with_distance(difference: Estimate) -> [String; 2] {
    if difference.value.abs() < ROUNDING {
        ["0".to_owned(), "rounding".to_owned()]
    } else {
        [figure(difference.value), standard_errors(difference.distance_from(0.0))]
    }
}

fn delays(reproduction: &Reproduction) -> comfy_table::Table {
    let changes = reproduction
        .filters
        .iter()
        .map(|filter| &filter.delays)
        .max_by_key(|delays| delays.len());
    let times: Vec<String> = changes
        .into_iter()
        .flatten()
        .map(|delay| format!("at {} s", delay.time))
        .collect();
    let mut header = vec!["mean (greatest) of the runs, s"];
    header.extend(times.iter().map(String::as_str));
    let mut table = table(&header);
    for filter in reproduction.filters.iter().filter(|filter| !filter.delays.is_empty()) {
        let mut row = vec![filter.name.clone()];
        for delay in &filter.delays {
            let missed = filter.completed_runs - delay.detected;
            let missed = match missed {
                0 => String::new(),
                missed => format!(", {missed} never"),
            };
            row.push(format!("{:.2} ({}{missed})", delay.mean, delay.greatest));
        }
        table.add_row(row);
    }
    table
}

fn consistency(reproduction: &Reproduction) -> comfy_table::Table {
    let header = [
        "",
        "NEES",
        "inside",
        "NIS",
        "inside",
        "points",
        "of weight ≠ 0",
        "time ratio",
        "failed runs",
    ];
    let mut table = table(&header);
    for filter in &reproduction.filters {
        let count = |points: Option<usize>| points.map_or_else(|| "—".to_owned(), |p| p.to_string());
        table.add_row([
            filter.name.clone(),
            figure(filter.nees.mean.value),
            inside(&filter.nees),
            figure(filter.nis.mean.value),
            inside(&filter.nis),
            count(filter.points),
            count(filter.effective_points),
            time_ratio(filter),
            filter.failures.len().to_string(),
        ]);
    }
    table
}

/// The time of a filter beside that of the first one, as a ratio with its scatter: times themselves are those of a machine.
pub(super) fn time_ratio(filter: &Performance) -> String {
    filter
        .time_ratio
        .map_or_else(|| "—".to_owned(), |ratio| ratio.to_string())
}

/// The part of the steps that is inside the bounds; a filter without covariances has none.
pub(super) fn inside(consistency: &Consistency) -> String {
    if consistency.mean.value.is_finite() {
        format!("{:.0} %", 100.0 * consistency.inside)
    } else {
        "—".to_owned()
    }
}

/// The runs that ended early, the first three of each filter by name.
fn failures(reproduction: &Reproduction) -> String {
    let mut text = String::new();
    for filter in reproduction.filters.iter().filter(|filter| !filter.failures.is_empty()) {
        let count = filter.failures.len();
        let _ = writeln!(text, "\n{}: {count} of {} runs failed.", filter.name, reproduction.runs);
        for failed in filter.failures.iter().take(3) {
            let _ = writeln!(text, "  run {}: {}", failed.run, failed.failure);
        }
        if count > 3 {
            let _ = writeln!(text, "  and {} more, all listed with --json", count - 3);
        }
    }
    text
}

/// The errors under each open choice by itself.
pub(super) struct Alternatives {
    /// What is measured, with its unit.
    pub measure: &'static str,
    /// The filters, one a column after the first.
    pub filters: Vec<&'static str>,
    /// The choice, then an error a filter.
    pub rows: Vec<Vec<String>>,
}

/// The position errors under each open choice, in the paper's measure.
pub(super) fn under_each_choice(paper: Paper, reproductions: &[Reproduction]) -> Alternatives {
    let columns = paper.specification().tables.first().map(|table| &table.columns);
    let filters: Vec<&str> = columns.into_iter().flatten().map(String::as_str).collect();
    let has_fit_error = |reproduction: &Reproduction| reproduction.filters.iter().any(|f| f.fit_error.is_some());
    let (of, measure) = if reproductions.iter().any(has_fit_error) {
        (Figure::FitError, "percentage fit error (%)")
    } else {
        (Figure::Error(ErrorQuantity::Position), "position error (m)")
    };
    let of_choice = |reproduction: &Reproduction| {
        let cells = filters.iter().map(|name| error_of(reproduction, name, of));
        [reproduction.choices.describe()].into_iter().chain(cells).collect()
    };
    Alternatives {
        measure,
        rows: reproductions.iter().map(of_choice).collect(),
        filters,
    }
}

/// The error of the filter whose name begins so, and how many of its runs failed.
fn error_of(reproduction: &Reproduction, name: &str, of: Figure) -> String {
    let filter = reproduction.filters.iter().find(|f| f.name.starts_with(name));
    let error = filter.and_then(|f| reproduction.figure(&f.name, of));
    let cell = error.map_or_else(|| "—".to_owned(), |error| figure(error.value));
    match filter.map_or(0, |f| f.failures.len()) {
        0 => cell,
        failed => format!("{cell} ({failed} failed)"),
    }
}

/// The same as text, one line an alternative; unless in full, only those under which a figure is another than at the defaults.
pub fn alternatives(paper: Paper, reproductions: &[Reproduction], is_full: bool) -> String {
    let mut alternatives = under_each_choice(paper, reproductions);
    let defaults = alternatives.rows.first().map(|row| row[1..].to_vec());
    let all = alternatives.rows.len();
    let mut place = 0;
    alternatives.rows.retain(|row| {
        place += 1;
        is_full || place == 1 || Some(&row[1..]) != defaults.as_deref()
    });
    let same = all - alternatives.rows.len();
    let mut header = vec![alternatives.measure];
    header.extend(&alternatives.filters);
    let mut table = table(&header);
    for row in alternatives.rows {
        table.add_row(row);
    }
    let left_out = match same {
        0 => String::new(),
        1 => "1 other choice changes none of these figures.\n".to_owned(),
        same => format!("{same} other choices change none of these figures.\n"),
    };
    format!("Each open choice by itself, the others at their defaults\n{table}\n{left_out}")
}

/// The open parameters of a scenario and their alternatives.
pub fn choices(specification: &Specification) -> String {
    let mut text = citation(&specification.paper);
    for parameter in &specification.parameters {
        let _ = writeln!(text, "\n{}", parameter.name);
        text.push_str(&wrapped(&format!("The paper prints: {}", parameter.printed), "    "));
        for alternative in &parameter.alternatives {
            let mark = if alternative.name == parameter.default {
                "*"
            } else {
                " "
            };
            let _ = writeln!(text, "  {mark} {}={}", parameter.name, alternative.name);
            text.push_str(&wrapped(&alternative.meaning, "        "));
        }
    }
    text.push_str("\n  * the default. Choose with: immaculate reproduce --set PARAMETER=ALTERNATIVE\n\n");
    text
}

/// RMSE over time as CSV: `time,filter,quantity,rmse,standard_error`.
pub fn errors_csv(reproduction: &Reproduction) -> String {
    let mut text = String::from("time,filter,quantity,rmse,standard_error\n");
    for filter in &reproduction.filters {
        for history in &filter.rmse {
            let values = history.values.iter().zip(&history.standard_errors);
            for (time, (value, standard_error)) in reproduction.times.iter().zip(values) {
                let quantity = history.quantity.label();
                let _ = writeln!(text, "{time},{},{quantity},{value},{standard_error}", filter.name);
            }
        }
    }
    text
}

/// Mean mode probabilities over time as CSV: `time,filter,mode,probability,truth,standard_error`, truth being 1 for the mode of the true
/// motion.
pub fn mode_probabilities_csv(reproduction: &Reproduction) -> String {
    let mut text = String::from("time,filter,mode,probability,truth,standard_error\n");
    for filter in &reproduction.filters {
        for (k, probabilities) in filter.mode_probabilities.iter().enumerate() {
            let estimates = probabilities.iter().zip(&filter.mode_probability_standard_errors[k]);
            for (mode, (probability, standard_error)) in filter.modes.iter().zip(estimates) {
                let truth = u8::from(reproduction.is_true(mode, k));
                let time = reproduction.times[k];
                let _ = writeln!(
                    text,
                    "{time},{},{mode},{probability},{truth},{standard_error}",
                    filter.name
                );
            }
        }
    }
    text
}

/// The first run as CSV: `time,what,x,y`, what being `truth`, `measured` or a filter.
pub fn path_csv(reproduction: &Reproduction, first_run: &FirstRun) -> String {
    let mut text = String::from("time,what,x,y\n");
    let filters = reproduction.filters.iter().map(|filter| filter.name.as_str());
    let names = ["truth", "measured"].into_iter().chain(filters);
    let paths = [&first_run.truth, &first_run.measured]
        .into_iter()
        .chain(&first_run.estimates);
    for (name, path) in names.zip(paths) {
        for (time, [x, y]) in reproduction.times.iter().zip(path) {
            let _ = writeln!(text, "{time},{name},{x},{y}");
        }
    }
    text
}
