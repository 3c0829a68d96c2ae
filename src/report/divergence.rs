//! The cause of the divergence of sustika2015's unscented filter, as a table and a sentence.
//!
//! It shows both paired differences, with bearings wrapped and never wrapped, beside the counts of divergent runs.

use super::{standard_errors, table, wrapped};
use crate::paper::sustika2015::DIVERGENT_FIT_ERROR;
use crate::paper::sustika2015::divergence::{DivergenceRow, Divergences};
use crate::statistics::Estimate;

/// What each column of the table is.
pub(super) const HEADER: [&str; 6] = [
    "simulation",
    "manoeuvres",
    "UKF − CMKF, wrapped",
    "never wrapped",
    "diverged",
    "with a jump",
];

/// The cells of the table, a row a simulation.
pub(super) fn cells(rows: &[DivergenceRow]) -> Vec<Vec<String>> {
    let counts = |of: [usize; 3]| of.map(|count| count.to_string()).join(" / ");
    let of_row = |row: &DivergenceRow| {
        vec![
            row.scenario.to_owned(),
            row.window.to_owned(),
            difference(row.point.unscented_less_converted),
            difference(row.point.plain_less_converted),
            counts(row.point.fits.map(|fit| fit.divergent)),
            counts(row.point.fits.map(|fit| fit.divergent_with_jump)),
        ]
    };
    rows.iter().map(of_row).collect()
}

/// What the figures are of.
pub(super) fn legend(runs: usize) -> String {
    format!(
        "Differences are of percentage fit errors, in %, means over {runs} runs of the same truth and measurements, with their standard \
         errors and in these. A run diverges when its percentage fit error exceeds {DIVERGENT_FIT_ERROR} %; the counts are of IMM-CMKF, \
         IMM-UKF and IMM-UKF never wrapped."
    )
}

/// What the runs of all simulations together say.
pub(super) fn cause(rows: &[DivergenceRow], runs: usize) -> String {
    Divergences::of(rows.iter().map(|row| &row.point), runs).cause()
}

/// The rows as text.
pub fn text(rows: &[DivergenceRow], runs: usize) -> String {
    let mut table = table(&HEADER);
    for row in cells(rows) {
        table.add_row(row);
    }
    format!(
        "What makes the unscented filter diverge\n\n{table}\n\n{}\n{}\n",
        wrapped(&legend(runs), ""),
        wrapped(&cause(rows, runs), "")
    )
}

fn difference(estimate: Estimate) -> String {
    let distance = standard_errors(estimate.distance_from(0.0));
    format!("{:+.3} ± {:.3} ({distance})", estimate.value, estimate.standard_error)
}
