//! The sweep of sustika2015: its results as a table, and figures 2 and 4 of the paper.
//!
//! The figures show how the percentage fit errors change with the noise that the filters assume, and whether the noise or the cut of the
//! bearings at ±π makes the unscented filter diverge. A line is a mean over runs; the band is two standard errors wide on either side. If
//! a filter diverges, the axis is logarithmic.

use super::chart::{
    Area, Axis, Caption, Drawn, Key, Line, Look, NotDrawn, draw_lines, draw_path, figure, looks, panel, plain,
};
use super::palette::INK;
use super::reproduction::time_ratio;
use super::{standard_errors, table};
use crate::number::Real;
use crate::paper::result::Reproduction;
use crate::paper::specification::Specification;
use crate::paper::sustika2015::sweep::{FILTERS, Fit, SweepPoint, SweepSetting, SweptParameter, SweptTrajectory};
use crate::paper::sustika2015::{DIVERGENT_FIT_ERROR, GOOD_FIT_ERROR};
use crate::statistics::Estimate;
use std::fmt::Write;

const PANEL_HEIGHT: u32 = 330;
/// Where a logarithmic axis begins, %.
const LEAST: f64 = 1.0;

/// The sweep as text: one table a trajectory and parameter, ten values of each, and what all of them say together.
pub fn text(sweep: &[(SweepSetting, SweepPoint)], runs: usize) -> String {
    let mut text = format!("Percentage fit errors in %, means over {runs} runs with their standard errors\n");
    for trajectory in SweptTrajectory::ALL {
        for parameter in SweptParameter::ALL {
            let points = points_of(sweep, trajectory, parameter);
            let _ = writeln!(text, "\n{}", title(trajectory, parameter));
            let _ = writeln!(text, "{}", values(&points));
        }
        text.push_str(&summary(sweep, trajectory, runs));
    }
    let _ = writeln!(
        text,
        "\nDiverged: the percentage fit error of a run exceeds {DIVERGENT_FIT_ERROR} %. With a jump: two of its measured bearings that follow\n\
         each other differ by more than π. The difference is the mean of IMM-UKF less IMM-CMKF, run by run, in its standard errors."
    );
    text
}

/// The ratio of the paper's execution times beside that of the computed ones with its scatter, which reproduces no table: the programs and
/// computers are others. None for a paper without such a table.
pub fn execution_times(specification: &Specification, reproduction: &Reproduction) -> Option<String> {
    let table = specification.tables.iter().find(|table| table.number == 6)?;
    let row = table.rows.iter().find(|row| row.unit == "s")?;
    let (&[first, second], [_, unscented]) = (&row.values[..], &reproduction.filters[..]) else {
        return None;
    };
    Some(format!(
        "\nExecution times of other programs on another computer cannot be reproduced. The ratio in table 6 is {:.2}; here it is\n\
         {}.\n",
        second / first,
        time_ratio(unscented),
    ))
}

fn points_of(
    sweep: &[(SweepSetting, SweepPoint)],
    trajectory: SweptTrajectory,
    parameter: SweptParameter,
) -> Vec<(f64, SweepPoint)> {
    let is_of = |setting: &SweepSetting| setting.trajectory == trajectory && setting.parameter == parameter;
    let points = sweep.iter().filter(|(setting, _)| is_of(setting));
    points.map(|(setting, point)| (setting.value, *point)).collect()
}

fn title(trajectory: SweptTrajectory, parameter: SweptParameter) -> String {
    let (number, trajectory) = match trajectory {
        SweptTrajectory::Straight => (2, "without manoeuvres"),
        SweptTrajectory::Manoeuvring => (4, "with manoeuvres"),
    };
    let panel = match parameter {
        SweptParameter::NoiseDensity => "a: the filters' q varied, σ_θ = 1° as in the truth",
        SweptParameter::BearingDegrees => "b: the filters' σ_θ varied, q = 0.1 as in the truth",
    };
    format!("Figure {number}{panel}; trajectory {trajectory}")
}

/// Ten values of a parameter, evenly spread.
fn values(points: &[(f64, SweepPoint)]) -> comfy_table::Table {
    let mut table = table(&[
        "",
        FILTERS[0],
        FILTERS[1],
        "difference / s.e.",
        FILTERS[2],
        "diverged",
        "with a jump",
    ]);
    let every = (points.len() / 10).max(1);
    for (value, point) in points.iter().skip(every - 1).step_by(every) {
        let [converted, unscented, plain] = &point.fits;
        table.add_row([
            value.to_string(),
            with_error(converted.mean),
            with_error(unscented.mean),
            standard_errors(point.unscented_less_converted.distance_from(0.0)),
            with_error(plain.mean),
            counts(&point.fits, |fit| fit.divergent),
            counts(&point.fits, |fit| fit.divergent_with_jump),
        ]);
    }
    table
}

fn with_error(estimate: Estimate) -> String {
    format!("{:.3} ± {:.3}", estimate.value, estimate.standard_error)
}

/// A count of each filter, in the order of the columns.
fn counts(fits: &[Fit; 3], of: fn(&Fit) -> usize) -> String {
    fits.each_ref().map(|fit| of(fit).to_string()).join(" / ")
}

/// What all settings of a trajectory say of each filter.
fn summary(sweep: &[(SweepSetting, SweepPoint)], trajectory: SweptTrajectory, runs: usize) -> String {
    let points: Vec<&SweepPoint> = sweep
        .iter()
        .filter(|(setting, _)| setting.trajectory == trajectory)
        .map(|(_, point)| point)
        .collect();
    let jumps = points.first().map_or(0, |point| point.runs_with_jump);
    let mut text = format!(
        "{} settings; in {jumps} of the {runs} runs, the same at all settings, the measured bearing jumps.\n",
        points.len()
    );
    for (filter, name) in FILTERS.iter().enumerate() {
        let sum = |of: fn(&Fit) -> usize| points.iter().map(|point| of(&point.fits[filter])).sum::<usize>();
        let bad = points
            .iter()
            .filter(|point| point.fits[filter].mean.value >= GOOD_FIT_ERROR)
            .count();
        let _ = writeln!(
            text,
            "  {name}: the mean reaches {GOOD_FIT_ERROR} % at {bad} settings; {} runs of {} diverge, {} of these with a jump; {} fail.",
            sum(|fit| fit.divergent),
            points.len() * runs,
            sum(|fit| fit.divergent_with_jump),
            sum(|fit| fit.failed),
        );
    }
    text
}

/// Figure 2 or 4 of the paper: mean percentage fit errors over q and over σ_θ.
///
/// # Errors
///
/// [`NotDrawn`] when the figure cannot be drawn.
pub fn draw(
    sweep: &[(SweepSetting, SweepPoint)],
    trajectory: SweptTrajectory,
    runs: usize,
) -> Result<String, NotDrawn> {
    let caption = Caption {
        name: format!("sustika2015-sweep-{}", trajectory.name()),
        title: match trajectory {
            SweptTrajectory::Straight => "sustika2015, figure 2: fit errors without manoeuvres".to_owned(),
            SweptTrajectory::Manoeuvring => "sustika2015, figure 4: fit errors with manoeuvres".to_owned(),
        },
        note: format!(
            "Means over {runs} runs; bands: ± 2 standard errors. Line: {GOOD_FIT_ERROR} %, below which it is \"good enough for \
             implementation\"."
        ),
        says: summary(sweep, trajectory, runs).replace('\n', " "),
        has_cells: false,
    };
    let lines = FILTERS.into_iter().zip(looks(FILTERS.len()));
    let mut legend: Vec<(String, Key)> = lines.map(|(name, look)| (name.to_owned(), Key::Line(look))).collect();
    legend.push((format!("{GOOD_FIT_ERROR} %"), Key::Thin(INK, 0)));
    figure(&caption, &legend, 2 * PANEL_HEIGHT, |area| {
        let areas = area.split_evenly((2, 1));
        areas
            .iter()
            .zip(SweptParameter::ALL)
            .try_for_each(|(area, parameter)| draw_panel(area, &points_of(sweep, trajectory, parameter), parameter))
    })
}

/// A power of ten as a label.
fn power(exponent: f64) -> String {
    plain(Real::exp(&(exponent * Real::ln(&10.0))).round())
}

fn draw_panel(area: &Area, points: &[(f64, SweepPoint)], parameter: SweptParameter) -> Drawn {
    let edges = points.iter().flat_map(|(_, point)| point.fits.iter().flat_map(band));
    let highest = edges.filter(|edge| edge.is_finite()).fold(GOOD_FIT_ERROR, f64::max);
    let last = points.last().map_or(1.0, |(value, _)| *value);
    let is_logarithmic = highest > DIVERGENT_FIT_ERROR;
    let scaled = |value: f64| {
        if is_logarithmic {
            Real::ln(&value.max(LEAST)) / Real::ln(&10.0)
        } else {
            value
        }
    };
    let name = match parameter {
        SweptParameter::NoiseDensity => "q of the filters (m²/s³, m²/s⁵); truth: 0.1",
        SweptParameter::BearingDegrees => "σ_θ of the filters (°); truth: 1",
    };
    let x = Axis::new(0.0..last, name, false);
    let mut y = Axis::new(0.0..scaled(1.2 * highest), "fit error (%)", true);
    if is_logarithmic {
        (y.format, y.labels) = (power, 3);
    }
    let mut chart = panel(area, "", [&x, &y], &[])?;
    let line = |(filter, look): (usize, Look)| {
        let fits = points.iter().map(|(value, point)| (*value, &point.fits[filter]));
        let finite: Vec<(f64, &Fit)> = fits
            .filter(|(_, fit)| fit.mean.value.is_finite() && fit.mean.standard_error.is_finite())
            .collect();
        Line {
            look,
            points: finite
                .iter()
                .map(|(value, fit)| (*value, scaled(fit.mean.value)))
                .collect(),
            band: finite.iter().map(|(_, fit)| band(fit).map(scaled)).collect(),
        }
    };
    let lines: Vec<Line> = looks(FILTERS.len()).into_iter().enumerate().map(line).collect();
    let limit = vec![(0.0, scaled(GOOD_FIT_ERROR)), (last, scaled(GOOD_FIT_ERROR))];
    draw_path(&mut chart, limit, INK, 2)?;
    draw_lines(&mut chart, &lines)
}

/// Two standard errors below and above the mean.
fn band(fit: &Fit) -> [f64; 2] {
    let Estimate { value, standard_error } = fit.mean;
    [(value - 2.0 * standard_error).max(0.0), value + 2.0 * standard_error]
}
