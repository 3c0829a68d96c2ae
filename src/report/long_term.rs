//! Figures 1 and 2 of derbez2000: the error of the predicted long-term error in per cent, as heat maps in SVG.
//!
//! An algorithm is right where the map is pale; it predicts too much (red) or too little (blue). If the manoeuvre begins with the run, no
//! form of it is right where constant velocity has the greater noise.

use super::chart::{Area, Axis, Caption, Drawn, Key, NotDrawn, draw_cells, edges, figure, panel};
use super::palette::{FILTERS, MEASURED, PAPER};
use crate::paper::monte_carlo::Generator;
use crate::steady::long_term::Form;
use crate::steady::simulated::{Grid, Start};
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

const PANEL_HEIGHT: u32 = 270;
/// Where the colours end, %; beyond it a prediction is wrong, and by how much is no longer seen.
const FULL: f64 = 100.0;
/// The number of colour steps: more could not be distinguished, and neighbours of one colour are drawn as one.
const SHADES: f64 = 10.0;
const TOO_LITTLE: RGBColor = FILTERS[0];
const TOO_MUCH: RGBColor = FILTERS[1];
const NO_PREDICTION: RGBColor = MEASURED;

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
        ("weights of (1)", Form::Reindexed, Start::AtTheTruth),
        ("corrected", Form::Corrected, Start::AtTheTruth),
        ("corrected, late start", Form::Corrected, Start::BeforeTheManoeuvre),
    ];
    let figures = [("Figure 1", Grid::figure_1(2.0)), ("Figure 2", Grid::figure_2(2.0))];
    let mut panels = Vec::new();
    for (words, form, start) in kinds {
        for (name, grid) in &figures {
            panels.push(Panel {
                title: format!("{name}: {words}"),
                percentages: grid.percentages(form, start, noise).map_err(NotDrawn::because)?,
                grid: grid.clone(),
            });
        }
    }
    heat_maps(&panels, figures.len())
}

/// The panels, several in a row, under one scale.
///
/// # Errors
///
/// [`NotDrawn`] when the figure cannot be drawn.
pub fn heat_maps(panels: &[Panel], columns: usize) -> Result<String, NotDrawn> {
    let rows = panels.len().div_ceil(columns.max(1)).max(1);
    let medians: Vec<String> = panels
        .iter()
        .map(|panel| format!(" {}: {:.0} %;", panel.title, median(panel)))
        .collect();
    let caption = Caption {
        name: "derbez2000-figures-1-and-2".to_owned(),
        title: "derbez2000, figures 1 and 2: predicted less simulated error".to_owned(),
        note: "In % of the simulated error; t = 2 s. Weights of (1): step 3 of the algorithm with them; corrected: with those that it \
               needs. Runs start at the truth; late start: the manoeuvre begins with the run."
            .to_owned(),
        says: format!("Heat maps of the predicted against the simulated long-term error. Median size of the difference:{}", medians.concat()),
        has_cells: true,
    };
    let legend = [
        ("too little, −100 %", -FULL),
        ("−50 %", -FULL / 2.0),
        ("50 %", FULL / 2.0),
        ("too much, 100 % or more", FULL),
        ("no prediction", f64::NAN),
    ]
    .map(|(words, percentage)| {
        let RGBAColor(r, g, b, opacity) = colour(percentage);
        (words.to_owned(), Key::Area(RGBColor(r, g, b), opacity))
    });
    let height = PANEL_HEIGHT * u32::try_from(rows).unwrap_or(1);
    figure(&caption, &legend, height, |area| {
        let areas = area.split_evenly((rows, columns.max(1)));
        areas
            .iter()
            .zip(panels)
            .try_for_each(|(area, panel)| draw_panel(area, panel))
    })
}

/// The median of the sizes of a panel's percentages, of those that there are.
fn median(panel: &Panel) -> f64 {
    let mut sizes: Vec<f64> = panel.percentages.iter().map(|percentage| percentage.abs()).collect();
    sizes.retain(|size| size.is_finite());
    sizes.sort_by(f64::total_cmp);
    sizes.get(sizes.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The colour of a percentage: none at zero.
fn colour(percentage: f64) -> RGBAColor {
    if percentage.is_nan() {
        return NO_PREDICTION.to_rgba();
    }
    let part = (percentage.abs() / FULL).min(1.0);
    let opacity = (part * SHADES).round() / SHADES;
    match opacity {
        0.0 => PAPER.mix(0.0),
        _ if percentage < 0.0 => TOO_LITTLE.mix(opacity),
        _ => TOO_MUCH.mix(opacity),
    }
}

fn draw_panel(area: &Area, of: &Panel) -> Drawn {
    let (columns, rows) = (edges(&of.grid.columns), edges(&of.grid.rows));
    let range = |edges: &[f64]| edges.first().copied().unwrap_or(0.0)..edges.last().copied().unwrap_or(1.0);
    let x = Axis::new(range(&columns), "acceleration (m/s²)", false);
    let y = Axis::new(range(&rows), of.grid.rows_are, false);
    let mut chart = panel(area, &of.title, [&x, &y], &[])?;
    let width = of.grid.columns.len();
    let percentage = |row: usize, column: usize| of.percentages.get(row * width + column);
    draw_cells(&mut chart, [&columns, &rows], |row, column| {
        colour(percentage(row, column).copied().unwrap_or(f64::NAN))
    })
}
