//! What makes the unscented filter of sustika2015 diverge, as a table and a sentence.
//!
//! After this file the reader can see both paired differences, with the bearings wrapped and never wrapped, beside the counts of runs that
//! diverge.

use super::{standard_errors, table, wrapped};
use crate::paper::sustika2015::DIVERGENT_FIT_ERROR;
use crate::paper::sustika2015::divergence::{Row, Tally};
use crate::statistics::Estimate;

/// The rows as text.
pub fn text(rows: &[Row], runs: usize) -> String {
    let mut table = table(&[
        "simulation",
        "manoeuvres",
        "UKF − CMKF, wrapped",
        "never wrapped",
        "diverged",
        "with a jump",
    ]);
    for Row {
        scenario,
        window,
        point,
    } in rows
    {
        let counts = |of: [usize; 3]| of.map(|count| count.to_string()).join(" / ");
        table.add_row([
            (*scenario).to_owned(),
            (*window).to_owned(),
            difference(point.unscented_less_converted),
            difference(point.plain_less_converted),
            counts(point.fits.map(|fit| fit.divergent)),
            counts(point.fits.map(|fit| fit.divergent_with_jump)),
        ]);
    }
    let tally = Tally::of(rows.iter().map(|row| &row.point), runs);
    format!(
        "What makes the unscented filter diverge\n\n{table}\n\n{}\n{}\n",
        wrapped(
            &format!(
                "Differences are of percentage fit errors, in %, means over {runs} runs of the same truth and measurements, with their standard \
                 errors and in these. A run diverges when its percentage fit error exceeds {DIVERGENT_FIT_ERROR} %; the counts are of IMM-CMKF, \
                 IMM-UKF and IMM-UKF never wrapped."
            ),
            ""
        ),
        wrapped(&tally.cause(), "")
    )
}

fn difference(estimate: Estimate) -> String {
    let distance = standard_errors(estimate.distance_from(0.0));
    format!("{:+.3} ± {:.3} ({distance})", estimate.value, estimate.standard_error)
}
