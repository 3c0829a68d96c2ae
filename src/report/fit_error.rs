//! The sweep of sustika2015 for people: what it says in a table, and figures 2 and 4 of the paper.
//!
//! After this file the reader can see how the percentage fit errors of the filters change with the noise that they take for granted, and
//! whether it is the noise or the cut of the bearings at ±π that makes the unscented filter diverge. A line is a mean over runs, the band
//! around it one standard error to either side; where a filter diverges, the axis is logarithmic. Filters that coincide are still seen:
//! each line is drawn thinner over the one before.

use super::figure::{NotDrawn, not_drawn};
use super::{standard_errors, table};
use crate::paper::result::Reproduction;
use crate::paper::specification::Specification;
use crate::paper::sustika2015::sweep::{FILTERS, Fit, Parameter, Point, Setting, Trajectory};
use crate::paper::sustika2015::{DIVERGENT_FIT_ERROR, GOOD_FIT_ERROR};
use crate::statistics::Estimate;
use plotters::coord::Shift;
use plotters::coord::ranged1d::{Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use std::fmt::Write;

/// One colour a filter, told apart by people who see colours differently (Okabe and Ito 2008).
const COLOURS: [RGBColor; 3] = [RGBColor(0, 114, 178), RGBColor(0, 158, 115), RGBColor(213, 94, 0)];
const WIDTH: u32 = 1000;
const PANEL_HEIGHT: u32 = 330;
const LEGEND_WIDTH: u32 = 190;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The sweep as text: one table a trajectory and parameter, ten values of each, and what all of them say together.
pub fn text(sweep: &[(Setting, Point)], runs: usize) -> String {
    let mut text = format!("Percentage fit errors in %, means over {runs} runs with their standard errors\n");
    for trajectory in Trajectory::ALL {
        for parameter in Parameter::ALL {
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

/// The paper's execution times beside the computed ones, of which only the ratio can be compared; none for a paper without such a table.
pub fn execution_times(specification: &Specification, reproduction: &Reproduction) -> Option<String> {
    let table = specification.tables.iter().find(|table| table.number == 6)?;
    let row = table.rows.iter().find(|row| row.unit == "s")?;
    let (&[first, second], [converted, unscented]) = (&row.values[..], &reproduction.filters[..]) else {
        return None;
    };
    let here = [converted, unscented].map(|filter| filter.microseconds_per_step);
    Some(format!(
        "\nTable 6. {} Published: {first} s and {second} s, the second {:.2} times the first.\n\
         Here: {:.1} and {:.1} µs a step, {:.2} times.\n",
        table.caption,
        second / first,
        here[0],
        here[1],
        here[1] / here[0],
    ))
}

fn points_of(sweep: &[(Setting, Point)], trajectory: Trajectory, parameter: Parameter) -> Vec<(f64, Point)> {
    let is_of = |setting: &Setting| setting.trajectory == trajectory && setting.parameter == parameter;
    let points = sweep.iter().filter(|(setting, _)| is_of(setting));
    points.map(|(setting, point)| (setting.value, *point)).collect()
}

fn title(trajectory: Trajectory, parameter: Parameter) -> String {
    let (number, trajectory) = match trajectory {
        Trajectory::Straight => (2, "without manoeuvres"),
        Trajectory::Manoeuvring => (4, "with manoeuvres"),
    };
    let panel = match parameter {
        Parameter::NoiseDensity => "a: the filters' q varied, σ_θ = 1° as in the truth",
        Parameter::BearingDegrees => "b: the filters' σ_θ varied, q = 0.1 as in the truth",
    };
    format!("Figure {number}{panel}; trajectory {trajectory}")
}

/// Ten values of a parameter, evenly spread.
fn values(points: &[(f64, Point)]) -> comfy_table::Table {
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
fn summary(sweep: &[(Setting, Point)], trajectory: Trajectory, runs: usize) -> String {
    let points: Vec<&Point> = sweep
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
pub fn draw(sweep: &[(Setting, Point)], trajectory: Trajectory, runs: usize) -> Result<String, NotDrawn> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (WIDTH, 2 * PANEL_HEIGHT)).into_drawing_area();
        root.fill(&WHITE).map_err(not_drawn)?;
        for (area, parameter) in root.split_evenly((2, 1)).iter().zip(Parameter::ALL) {
            let points = points_of(sweep, trajectory, parameter);
            draw_panel(
                area,
                &points,
                &format!("{}; {runs} runs", title(trajectory, parameter)),
                parameter,
            )?;
        }
        root.present().map_err(not_drawn)?;
    }
    Ok(svg)
}

fn draw_panel(area: &Area, points: &[(f64, Point)], title: &str, parameter: Parameter) -> Result<(), NotDrawn> {
    let (area, legend) = area.split_horizontally(WIDTH - LEGEND_WIDTH);
    let edges = || points.iter().flat_map(|(_, point)| point.fits.iter().flat_map(band));
    let highest = edges().filter(|edge| edge.is_finite()).fold(GOOD_FIT_ERROR, f64::max);
    let last = points.last().map_or(1.0, |(value, _)| *value);
    let mut chart = ChartBuilder::on(&area);
    chart
        .caption(title, ("sans-serif", 15))
        .margin(10)
        .margin_right(20)
        .x_label_area_size(35)
        .y_label_area_size(55);
    if highest > DIVERGENT_FIT_ERROR {
        let chart = chart.build_cartesian_2d(0.0..last, (1.0..1.3 * highest).log_scale());
        draw_lines(&mut chart.map_err(not_drawn)?, points, parameter)?;
    } else {
        let chart = chart.build_cartesian_2d(0.0..last, 0.0..1.1 * highest);
        draw_lines(&mut chart.map_err(not_drawn)?, points, parameter)?;
    }
    draw_legend(&legend)
}

/// One standard error below and above the mean.
fn band(fit: &Fit) -> [f64; 2] {
    let Estimate { value, standard_error } = fit.mean;
    // A logarithmic axis has no place for what is not positive; there it begins at 1 %.
    [(value - standard_error).max(0.5), value + standard_error]
}

type Chart<'a, 'b, Y> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, Y>>;

fn draw_lines<Y>(chart: &mut Chart<Y>, points: &[(f64, Point)], parameter: Parameter) -> Result<(), NotDrawn>
where
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    chart
        .configure_mesh()
        .disable_x_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc(match parameter {
            Parameter::NoiseDensity => "q of the filters (m²/s³, m²/s⁵)",
            Parameter::BearingDegrees => "σ_θ of the filters (°)",
        })
        .y_desc("PFE (%)")
        .x_label_formatter(&|x| format!("{x:.1}"))
        .y_label_formatter(&|y| format!("{y}"))
        .draw()
        .map_err(not_drawn)?;
    for ((filter, colour), width) in COLOURS.iter().enumerate().rev().zip([5, 3, 1]) {
        let finite: Vec<(f64, &Fit)> = points
            .iter()
            .map(|(value, point)| (*value, &point.fits[filter]))
            .filter(|(_, fit)| fit.mean.value.is_finite() && fit.mean.standard_error.is_finite())
            .collect();
        let lower = finite.iter().map(|(value, fit)| (*value, band(fit)[0]));
        let upper = finite.iter().rev().map(|(value, fit)| (*value, band(fit)[1]));
        let outline: Vec<(f64, f64)> = lower.chain(upper).collect();
        let around = Polygon::new(outline, colour.mix(0.2));
        chart.draw_series(std::iter::once(around)).map_err(not_drawn)?;
        let means = finite.iter().map(|(value, fit)| (*value, fit.mean.value));
        chart
            .draw_series(LineSeries::new(means, colour.stroke_width(width)))
            .map_err(not_drawn)?;
    }
    let last = points.last().map_or(1.0, |(value, _)| *value);
    let limit = [(0.0, GOOD_FIT_ERROR), (last, GOOD_FIT_ERROR)];
    chart
        .draw_series(LineSeries::new(limit, BLACK.stroke_width(1)))
        .map_err(not_drawn)?;
    Ok(())
}

fn draw_legend(legend: &Area) -> Result<(), NotDrawn> {
    let lines = FILTERS.into_iter().zip(COLOURS);
    let limit = format!("{GOOD_FIT_ERROR} %: good enough");
    let mut y = 45;
    for (name, colour) in lines.chain([(limit.as_str(), BLACK)]) {
        let line = PathElement::new(vec![(0, y), (20, y)], colour.stroke_width(2));
        legend.draw(&line).map_err(not_drawn)?;
        let text = Text::new(name.to_owned(), (26, y - 6), ("sans-serif", 13));
        legend.draw(&text).map_err(not_drawn)?;
        y += 20;
    }
    Ok(())
}
