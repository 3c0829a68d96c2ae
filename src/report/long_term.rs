//! Figures 1 and 2 of derbez2000: by how many per cent the predicted long-term error is off, as heat maps in SVG.
//!
//! After this file the reader can see where an algorithm is right (white), predicts too much (red) or too little (blue), and that with the
//! manoeuvre beginning with the run no form of it is right where constant velocity has the greater noise.

use super::figure::NotDrawn;
use crate::paper::monte_carlo::Generator;
use crate::steady::long_term::Form;
use crate::steady::simulated::{Grid, Start};
use plotters::coord::Shift;
use plotters::prelude::*;

/// One heat map: its title, the grid and a percentage for each of its settings, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// What is shown.
    pub title: String,
    /// The grid.
    pub grid: Grid,
    /// 100 (predicted − simulated)/simulated.
    pub percentages: Vec<f64>,
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

const PANEL_WIDTH: u32 = 480;
const PANEL_HEIGHT: u32 = 300;
const SCALE_HEIGHT: u32 = 60;
/// Where the colours end, %; beyond it a prediction is wrong, and by how much is no longer seen.
const FULL: f64 = 100.0;
/// The ends of the scale, told apart by people who see colours differently (Okabe and Ito 2008).
const TOO_LITTLE: (f64, f64, f64) = (0.0, 114.0, 178.0);
const TOO_MUCH: (f64, f64, f64) = (213.0, 94.0, 0.0);
const NO_PREDICTION: RGBColor = RGBColor(120, 120, 120);

/// Both figures for a scan time of two seconds: the algorithm with the weights of (1) in step 3, and corrected, beside simulations that
/// start at the truth, and corrected beside simulations with which the manoeuvre begins.
///
/// # Errors
///
/// [`NotDrawn`] when a figure cannot be drawn, or its settings not be simulated.
pub fn figures_1_and_2(seed: u64) -> Result<String, NotDrawn> {
    let noise = |point: usize| {
        let mut generator = Generator::new(seed, point as u64);
        move || generator.standard_normal()
    };
    let kinds = [
        ("weights of (1), from the truth", Form::Reindexed, Start::AtTheTruth),
        ("corrected, from the truth", Form::Corrected, Start::AtTheTruth),
        (
            "corrected, manoeuvre with the run",
            Form::Corrected,
            Start::BeforeTheManoeuvre,
        ),
    ];
    let mut panels = Vec::new();
    for (name, grid) in [("Figure 1", Grid::figure_1(2.0)), ("Figure 2", Grid::figure_2(2.0))] {
        for (words, form, start) in kinds {
            panels.push(Panel {
                title: format!("{name}: {words}"),
                percentages: grid.percentages(form, start, noise).map_err(NotDrawn::because)?,
                grid: grid.clone(),
            });
        }
    }
    heat_maps(&panels, kinds.len())
}

/// The panels, so many in a row, with one scale below them.
///
/// # Errors
///
/// [`NotDrawn`] when the figure cannot be drawn.
pub fn heat_maps(panels: &[Panel], columns: usize) -> Result<String, NotDrawn> {
    let columns = columns.max(1);
    let rows = panels.len().div_ceil(columns).max(1);
    let size = |count: usize, of_one: u32| u32::try_from(count).unwrap_or(1) * of_one;
    let (width, height) = (size(columns, PANEL_WIDTH), size(rows, PANEL_HEIGHT));
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (width, height + SCALE_HEIGHT)).into_drawing_area();
        root.fill(&WHITE).map_err(not_drawn)?;
        let (maps, scale) = root.split_vertically(height);
        for (area, panel) in maps.split_evenly((rows, columns)).iter().zip(panels) {
            draw_panel(area, panel)?;
        }
        draw_scale(&scale, width)?;
        root.present().map_err(not_drawn)?;
    }
    Ok(svg)
}

/// The colour of a percentage: white at zero.
fn colour(percentage: f64) -> RGBColor {
    if percentage.is_nan() {
        return NO_PREDICTION;
    }
    let part = (percentage.abs() / FULL).min(1.0);
    let end = if percentage < 0.0 { TOO_LITTLE } else { TOO_MUCH };
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between white, 255, and a colour's end"
    )]
    let channel = |end: f64| (255.0 + (end - 255.0) * part).round() as u8;
    RGBColor(channel(end.0), channel(end.1), channel(end.2))
}

/// The distance of two values of an axis, which are evenly spaced.
fn spacing(values: &[f64]) -> f64 {
    match values {
        [first, second, ..] => second - first,
        _ => 1.0,
    }
}

/// The axis over cells that are centred at the values.
fn axis(values: &[f64]) -> std::ops::Range<f64> {
    let half = spacing(values) / 2.0;
    let first = values.first().copied().unwrap_or(0.0);
    let last = values.last().copied().unwrap_or(0.0);
    first - half..last + half
}

fn draw_panel(area: &Area, panel: &Panel) -> Result<(), NotDrawn> {
    let Grid {
        rows,
        columns,
        rows_are,
        ..
    } = &panel.grid;
    let mut chart = ChartBuilder::on(area)
        .caption(&panel.title, ("sans-serif", 14))
        .margin(10)
        .margin_right(20)
        .x_label_area_size(35)
        .y_label_area_size(55)
        .build_cartesian_2d(axis(columns), axis(rows))
        .map_err(not_drawn)?;
    let (half_width, half_height) = (spacing(columns) / 2.0, spacing(rows) / 2.0);
    let places = rows.iter().flat_map(|row| columns.iter().map(|column| (*column, *row)));
    let cells = places.zip(&panel.percentages).map(|((x, y), percentage)| {
        let corners = [(x - half_width, y - half_height), (x + half_width, y + half_height)];
        Rectangle::new(corners, colour(*percentage).filled())
    });
    chart.draw_series(cells).map_err(not_drawn)?;
    chart
        .configure_mesh()
        .disable_mesh()
        .x_label_formatter(&|acceleration| format!("{acceleration:.0}"))
        .y_label_formatter(&|value| format!("{}", (value * 100.0).round() / 100.0))
        .x_desc("acceleration (m/s²)")
        .y_desc(*rows_are)
        .draw()
        .map_err(not_drawn)
}

/// The scale from −100 % to 100 % and beyond.
fn draw_scale(area: &Area, width: u32) -> Result<(), NotDrawn> {
    const STEPS: i32 = 41;
    const STEP_WIDTH: i32 = 10;
    let left = (i32::try_from(width).unwrap_or(i32::MAX) - STEPS * STEP_WIDTH) / 2;
    for step in 0..STEPS {
        let percentage = FULL * (2.0 * f64::from(step) / f64::from(STEPS - 1) - 1.0);
        let x = left + step * STEP_WIDTH;
        let cell = Rectangle::new([(x, 5), (x + STEP_WIDTH, 25)], colour(percentage).filled());
        area.draw(&cell).map_err(not_drawn)?;
    }
    let middle = left + STEPS * STEP_WIDTH / 2;
    let labels = [
        ("−100 % or less", left - 30),
        ("predicted as simulated", middle - 65),
        ("100 % or more", left + STEPS * STEP_WIDTH - 60),
    ];
    for (label, x) in labels {
        let text = Text::new(label, (x, 32), ("sans-serif", 13));
        area.draw(&text).map_err(not_drawn)?;
    }
    Ok(())
}

fn not_drawn(error: impl std::fmt::Display) -> NotDrawn {
    NotDrawn::because(error)
}
