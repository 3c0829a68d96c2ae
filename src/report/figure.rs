//! The papers' figures: errors and mode probabilities over time, as SVG.
//!
//! After this file the reader can look at what the tables average: when the target turns (shaded), how the errors rise, and how fast the
//! mode probabilities follow. Filters that coincide are still seen: each line is drawn thinner over the one before.

use crate::paper::result::{Performance, Quantity, Reproduction};
use plotters::coord::Shift;
use plotters::prelude::*;

/// A figure could not be drawn.
#[derive(Debug, thiserror::Error)]
#[error("the figure could not be drawn: {0}")]
pub struct NotDrawn(String);

/// One colour a filter, told apart by people who see colours differently (Okabe and Ito 2008).
const COLOURS: [RGBColor; 5] = [
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 158, 115),
    RGBColor(213, 94, 0),
    RGBColor(0, 0, 0),
];
/// The shade of the times at which the target turns.
const TURN: RGBColor = RGBColor(235, 235, 235);
const PANEL_HEIGHT: u32 = 300;
const WIDTH: u32 = 1000;
const LEGEND_WIDTH: u32 = 160;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// What one panel shows.
struct Panel<'a> {
    title: String,
    label: &'a str,
    highest: f64,
    /// One value a step for each filter; none for a filter that has no such value.
    lines: Vec<Option<Vec<f64>>>,
    /// Whether the truth is what the panel is about, step by step: these times are shaded.
    shaded: Vec<bool>,
}

/// RMSE of position and of velocity over time, the turns shaded.
///
/// # Errors
///
/// [`NotDrawn`] when the figure cannot be drawn.
pub fn errors(reproduction: &Reproduction) -> Result<String, NotDrawn> {
    let turning: Vec<bool> = reproduction
        .motions
        .iter()
        .map(|motion| *motion != "constant velocity")
        .collect();
    let panel = |quantity: Quantity| {
        let history = |filter: &Performance| {
            let history = filter.rmse.iter().find(|history| history.quantity == quantity);
            history.map(|history| history.values.clone())
        };
        let lines: Vec<_> = reproduction.filters.iter().map(history).collect();
        let values = lines.iter().flatten().flatten().filter(|value| value.is_finite());
        Panel {
            title: format!(
                "{}: RMSE over {} runs; turns shaded",
                reproduction.paper, reproduction.runs
            ),
            label: quantity.label(),
            highest: 1.05 * values.copied().fold(0.0, f64::max),
            lines,
            shaded: turning.clone(),
        }
    };
    draw(reproduction, &[panel(Quantity::Position), panel(Quantity::Velocity)])
}

/// Mean mode probabilities over time, one panel a mode, shaded while it is the true one.
///
/// # Errors
///
/// [`NotDrawn`] when the figure cannot be drawn.
pub fn mode_probabilities(reproduction: &Reproduction) -> Result<String, NotDrawn> {
    let most = reproduction
        .filters
        .iter()
        .map(|filter| &filter.modes)
        .max_by_key(|modes| modes.len());
    let panel = |mode: &String| {
        let of_filter = |filter: &Performance| {
            let several = filter.modes.len() > 1;
            let j = filter.modes.iter().position(|name| name == mode).filter(|_| several)?;
            Some(filter.mode_probabilities.iter().map(|step| step[j]).collect())
        };
        Panel {
            title: format!("{}: probability of {mode}; shaded while it is true", reproduction.paper),
            label: "mean probability",
            highest: 1.0,
            lines: reproduction.filters.iter().map(of_filter).collect(),
            shaded: reproduction.motions.iter().map(|motion| motion == mode).collect(),
        }
    };
    let panels: Vec<Panel> = most.into_iter().flatten().map(panel).collect();
    draw(reproduction, &panels)
}

/// Draws the panels one above the other.
fn draw(reproduction: &Reproduction, panels: &[Panel]) -> Result<String, NotDrawn> {
    let mut svg = String::new();
    let count = u32::try_from(panels.len()).unwrap_or(1).max(1);
    {
        let root = SVGBackend::with_string(&mut svg, (WIDTH, PANEL_HEIGHT * count)).into_drawing_area();
        root.fill(&WHITE).map_err(not_drawn)?;
        let areas = root.split_evenly((panels.len().max(1), 1));
        for (area, panel) in areas.iter().zip(panels) {
            draw_panel(area, panel, reproduction)?;
        }
        root.present().map_err(not_drawn)?;
    }
    Ok(svg)
}

fn draw_panel(area: &Area, panel: &Panel, reproduction: &Reproduction) -> Result<(), NotDrawn> {
    let (area, legend) = area.split_horizontally(WIDTH - LEGEND_WIDTH);
    let times = &reproduction.times;
    let (first, last) = (times[0], times[times.len() - 1]);
    let highest = if panel.highest > 0.0 { panel.highest } else { 1.0 };
    let mut chart = ChartBuilder::on(&area)
        .caption(&panel.title, ("sans-serif", 16))
        .margin(10)
        .margin_right(20)
        .x_label_area_size(35)
        .y_label_area_size(55)
        .build_cartesian_2d(first..last, 0.0..highest)
        .map_err(not_drawn)?;
    let half = (last - first) / (2.0 * (times.len().max(2) - 1) as f64);
    let shades = times
        .iter()
        .zip(&panel.shaded)
        .filter(|(_, shaded)| **shaded)
        .map(|(time, _)| {
            let corners = [((time - half).max(first), 0.0), ((time + half).min(last), highest)];
            Rectangle::new(corners, TURN.filled())
        });
    chart.draw_series(shades).map_err(not_drawn)?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .light_line_style(TRANSPARENT)
        .x_label_formatter(&|time| time.to_string())
        .x_desc("time (s)")
        .y_desc(panel.label)
        .draw()
        .map_err(not_drawn)?;
    let mut width = 2 * u32::try_from(panel.lines.len()).unwrap_or(1) + 1;
    let mut y = 45;
    for ((filter, values), colour) in reproduction
        .filters
        .iter()
        .zip(&panel.lines)
        .zip(COLOURS.iter().cycle())
    {
        width = width.saturating_sub(2).max(1);
        let Some(values) = values else {
            continue;
        };
        let style = colour.stroke_width(width);
        let points = times
            .iter()
            .copied()
            .zip(values.iter().copied())
            .filter(|(_, value)| value.is_finite());
        chart.draw_series(LineSeries::new(points, style)).map_err(not_drawn)?;
        legend
            .draw(&PathElement::new(vec![(0, y), (20, y)], style))
            .map_err(not_drawn)?;
        let name = Text::new(filter.name.as_str(), (26, y - 6), ("sans-serif", 13));
        legend.draw(&name).map_err(not_drawn)?;
        y += 20;
    }
    Ok(())
}

pub(super) fn not_drawn(error: impl std::fmt::Display) -> NotDrawn {
    NotDrawn(error.to_string())
}
