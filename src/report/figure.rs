//! The papers' figures: errors and mode probabilities over time, as SVG.
//!
//! After this file the reader can look at what the tables average: when the target turns (shaded), how the errors rise, how fast the mode
//! probabilities follow, and, where a paper shows a run, its path. Filters that coincide are still seen: each line is drawn thinner over
//! the one before.

use crate::paper::result::{FirstRun, Performance, Quantity, Reproduction};
use plotters::coord::Shift;
use plotters::prelude::*;

/// A figure could not be drawn.
#[derive(Debug, thiserror::Error)]
#[error("the figure could not be drawn: {0}")]
pub struct NotDrawn(String);

impl NotDrawn {
    /// For the reason that the drawing library gives.
    pub(super) fn because(error: impl std::fmt::Display) -> Self {
        Self(error.to_string())
    }
}

/// One colour a filter, told apart by people who see colours differently (Okabe and Ito 2008).
const COLOURS: [RGBColor; 5] = [
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 158, 115),
    RGBColor(213, 94, 0),
    RGBColor(0, 0, 0),
];
/// The colour of what was measured.
const MEASURED: RGBColor = RGBColor(150, 150, 150);
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
        .map(|motion| motion.split(", ").any(|mode| !mode.ends_with("constant velocity")))
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
                "{}: RMSE over {} runs; {} shaded",
                title(reproduction),
                reproduction.runs,
                what_is_shaded(reproduction)
            ),
            label: quantity.label(),
            highest: 1.05 * values.copied().fold(0.0, f64::max),
            lines,
            shaded: turning.clone(),
        }
    };
    draw(reproduction, &[panel(Quantity::Position), panel(Quantity::Velocity)])
}

/// The paper, and the scenario where another than its first is shown.
fn title(reproduction: &Reproduction) -> String {
    match reproduction.choices.chosen("scenario") {
        Some(scenario) => format!("{}, {scenario}", reproduction.paper),
        None => reproduction.paper.to_owned(),
    }
}

/// What the shade of the figures of errors means.
fn what_is_shaded(reproduction: &Reproduction) -> &'static str {
    let accelerates = |motion: &&str| motion.contains("constant acceleration");
    if reproduction.motions.iter().any(accelerates) {
        "accelerations and turns"
    } else {
        "turns"
    }
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
            title: format!(
                "{}: probability of {mode}; shaded while it is true",
                title(reproduction)
            ),
            label: "mean probability",
            highest: 1.0,
            lines: reproduction.filters.iter().map(of_filter).collect(),
            shaded: (0..reproduction.steps).map(|k| reproduction.is_true(mode, k)).collect(),
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

/// The first run in the plane: where the target was, where it was measured, and where the filters thought it was; below it the errors of
/// x and of y in this run.
///
/// # Errors
///
/// [`NotDrawn`] when the figure cannot be drawn.
pub fn path(reproduction: &Reproduction, first_run: &FirstRun) -> Result<String, NotDrawn> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (WIDTH, 4 * PANEL_HEIGHT)).into_drawing_area();
        root.fill(&WHITE).map_err(not_drawn)?;
        let (plane, errors) = root.split_vertically(2 * PANEL_HEIGHT);
        draw_plane(&plane, reproduction, first_run)?;
        for (coordinate, area) in errors.split_evenly((2, 1)).iter().enumerate() {
            draw_errors(area, reproduction, first_run, coordinate)?;
        }
        root.present().map_err(not_drawn)?;
    }
    Ok(svg)
}

/// The filters' lines and their colours, each thinner than the one before.
fn lines(reproduction: &Reproduction) -> impl Iterator<Item = (&str, ShapeStyle)> {
    let widths = (1..).step_by(2).take(reproduction.filters.len()).collect::<Vec<u32>>();
    let styles = COLOURS.iter().cycle().zip(widths.into_iter().rev());
    let styles = styles.map(|(colour, width)| colour.stroke_width(width));
    reproduction
        .filters
        .iter()
        .map(|filter| filter.name.as_str())
        .zip(styles)
}

/// The least and the greatest of some values, with a margin.
fn range_of(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (mut low, mut high) = (f64::MAX, f64::MIN);
    for value in values.filter(|value| value.is_finite()) {
        low = low.min(value);
        high = high.max(value);
    }
    let margin = 0.05 * (high - low).max(f64::MIN_POSITIVE);
    low - margin..high + margin
}

fn draw_plane(area: &Area, reproduction: &Reproduction, first_run: &FirstRun) -> Result<(), NotDrawn> {
    let (area, legend) = area.split_horizontally(WIDTH - LEGEND_WIDTH);
    let all = || first_run.truth.iter().chain(&first_run.measured);
    let (x, y) = (
        range_of(all().map(|place| place[0])),
        range_of(all().map(|place| place[1])),
    );
    let mut chart = ChartBuilder::on(&area)
        .caption(format!("{}: the first run", title(reproduction)), ("sans-serif", 16))
        .margin(10)
        .margin_right(20)
        .x_label_area_size(35)
        .y_label_area_size(55)
        .build_cartesian_2d(x, y)
        .map_err(not_drawn)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("x (m)")
        .y_desc("y (m)")
        .draw()
        .map_err(not_drawn)?;
    let mut y = 45;
    let mut name = |name: &str, style: ShapeStyle| -> Result<(), NotDrawn> {
        let line = PathElement::new(vec![(0, y), (20, y)], style);
        legend.draw(&line).map_err(not_drawn)?;
        let text = Text::new(name.to_owned(), (26, y - 6), ("sans-serif", 13));
        legend.draw(&text).map_err(not_drawn)?;
        y += 20;
        Ok(())
    };
    for ((filter, style), estimates) in lines(reproduction).zip(&first_run.estimates) {
        let points = estimates.iter().map(|place| (place[0], place[1]));
        chart.draw_series(LineSeries::new(points, style)).map_err(not_drawn)?;
        name(filter, style)?;
    }
    let truth = BLACK.stroke_width(1);
    let points = first_run.truth.iter().map(|place| (place[0], place[1]));
    chart.draw_series(LineSeries::new(points, truth)).map_err(not_drawn)?;
    name("truth", truth)?;
    let dots = first_run
        .measured
        .iter()
        .map(|place| Circle::new((place[0], place[1]), 2, MEASURED.filled()));
    chart.draw_series(dots).map_err(not_drawn)?;
    // The legend of the dots is a dot, where the lines' next line would be.
    let y = 45 + 20 * i32::try_from(first_run.estimates.len() + 1).unwrap_or(0);
    let dot = Circle::new((10, y), 2, MEASURED.filled());
    legend.draw(&dot).map_err(not_drawn)?;
    let text = Text::new("measured", (26, y - 6), ("sans-serif", 13));
    legend.draw(&text).map_err(not_drawn)
}

/// The errors of x (0) or y (1) in the first run.
fn draw_errors(
    area: &Area,
    reproduction: &Reproduction,
    first_run: &FirstRun,
    coordinate: usize,
) -> Result<(), NotDrawn> {
    let (area, _) = area.split_horizontally(WIDTH - LEGEND_WIDTH);
    let times = &reproduction.times;
    let errors = |path: &[[f64; 2]]| -> Vec<f64> {
        let pairs = path.iter().zip(&first_run.truth);
        pairs
            .map(|(place, truth)| place[coordinate] - truth[coordinate])
            .collect()
    };
    let measured = errors(&first_run.measured);
    let estimated: Vec<Vec<f64>> = first_run.estimates.iter().map(|path| errors(path)).collect();
    let range = range_of(estimated.iter().chain([&measured]).flatten().copied());
    let mut chart = ChartBuilder::on(&area)
        .margin(10)
        .margin_right(20)
        .x_label_area_size(35)
        .y_label_area_size(55)
        .build_cartesian_2d(times[0]..times[times.len() - 1], range)
        .map_err(not_drawn)?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .light_line_style(TRANSPARENT)
        .x_label_formatter(&|time| time.to_string())
        .x_desc("time (s)")
        .y_desc(["error of x (m)", "error of y (m)"][coordinate])
        .draw()
        .map_err(not_drawn)?;
    for ((_, style), errors) in lines(reproduction).zip(&estimated) {
        let points = times.iter().copied().zip(errors.iter().copied());
        chart.draw_series(LineSeries::new(points, style)).map_err(not_drawn)?;
    }
    let places = times.iter().copied().zip(measured);
    let dots = places.map(|place| Circle::new(place, 2, MEASURED.filled()));
    chart.draw_series(dots).map_err(not_drawn)?;
    Ok(())
}

pub(super) fn not_drawn(error: impl std::fmt::Display) -> NotDrawn {
    NotDrawn::because(error)
}
