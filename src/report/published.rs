//! The published tables beside the computed ones, as SVG: one panel per row, one line per filter.
//!
//! The figure shows which published values the papers' own equations reproduce. The computed value is a dot with a bar of two standard
//! errors on either side; the published one is a diamond.

use super::chart::{Area, Axis, Caption, Drawn, Key, NotDrawn, draw_path, figure, label, marker, panel, range_of};
use super::outcome::outcome;
use super::palette::{FILTERS, MEASURED};
use super::reproduction::SideBySide;
use crate::paper::Paper;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

/// The pixels of a filter's line, and of what else is in a panel.
const LINE: u32 = 30;
const AROUND: u32 = 96;
/// The room for the filters' names, pixels.
const NAMES: u32 = 170;
const COMPUTED: RGBColor = FILTERS[0];
const PUBLISHED: RGBColor = FILTERS[1];
/// The shape of the mark of a published figure: a diamond.
const DIAMOND: usize = 3;

/// Every published figure of a paper that its runs reproduce, beside the computed one; the figures may be of several simulations, in the
/// order of the paper's tables. None where there are none.
///
/// # Errors
///
/// [`NotDrawn`] when the figure cannot be drawn.
pub fn published_and_computed(paper: Paper, comparisons: &[SideBySide]) -> Option<Result<String, NotDrawn>> {
    if comparisons.is_empty() {
        return None;
    }
    let rows: Vec<&[SideBySide]> = comparisons
        .chunk_by(|a, b| (a.table, &a.row) == (b.table, &b.row))
        .collect();
    let verdict = outcome(comparisons);
    let caption = Caption {
        name: format!("{}-published", paper.key()),
        title: format!("{}: published and computed", paper.key()),
        note: format!("{verdict} Bars: ± 2 standard errors; a short one is inside its dot."),
        says: format!("{verdict}{}", in_words(comparisons)),
        has_cells: false,
    };
    let legend = [
        ("computed".to_owned(), Key::Mark(COMPUTED, 0)),
        ("published".to_owned(), Key::Mark(PUBLISHED, DIAMOND)),
    ];
    let heights: Vec<u32> = rows
        .iter()
        .map(|row| AROUND + LINE * u32::try_from(row.len()).unwrap_or(1))
        .collect();
    Some(figure(&caption, &legend, heights.iter().sum(), |area| {
        let mut rest = area.clone();
        for (row, height) in rows.iter().zip(&heights) {
            let (here, below) = rest.split_vertically(*height);
            draw_row(&here, row)?;
            rest = below;
        }
        Ok(())
    }))
}

fn in_words(comparisons: &[SideBySide]) -> String {
    let words = |of: &SideBySide| {
        let computed = crate::statistics::estimate::figure(of.computed);
        format!(
            " {}, {}: published {}, computed {computed} {}.",
            of.row, of.filter, of.published, of.unit
        )
    };
    comparisons.iter().map(words).collect()
}

/// The ends of a bar.
fn bar(of: &SideBySide) -> [f64; 2] {
    [
        of.computed - 2.0 * of.standard_error,
        of.computed + 2.0 * of.standard_error,
    ]
}

/// One row of a table; its filters from top to bottom.
fn draw_row(area: &Area, row: &[SideBySide]) -> Drawn {
    let values = row.iter().flat_map(|of| bar(of).into_iter().chain([of.published]));
    let mut range = range_of(values);
    // From zero where that leaves room to see differences.
    if range.start > 0.0 && range.start < 0.6 * range.end || range.start < 0.0 {
        range.start = 0.0;
    }
    let start = range.start;
    let x = Axis::new(range, &row[0].unit, true);
    let lines = row.len() as f64;
    let mut y = Axis::new(-lines + 0.5..0.5, "", false);
    y.labels = 0;
    y.room = NAMES;
    let title = format!("Table {}: {}", row[0].table, row[0].row);
    let mut chart = panel(area, &title, [&x, &y], &[])?;
    for (number, of) in row.iter().enumerate() {
        let y = -(number as f64);
        let words =
            EmptyElement::at((start, y)) + Text::new(of.filter.clone(), (-10, 0), label(HPos::Right, VPos::Center));
        chart.draw_series([words]).map_err(NotDrawn::because)?;
        draw_path(&mut chart, vec![(of.computed, y), (of.published, y)], MEASURED, 1)?;
        let [from, to] = bar(of);
        draw_path(&mut chart, vec![(from, y), (to, y)], COMPUTED, 3)?;
        for end in [from, to] {
            let cap = EmptyElement::at((end, y)) + PathElement::new(vec![(0, -7), (0, 7)], COMPUTED.stroke_width(2));
            chart.draw_series([cap]).map_err(NotDrawn::because)?;
        }
        for (value, shape, colour) in [(of.computed, 0, COMPUTED), (of.published, DIAMOND, PUBLISHED)] {
            let mark = EmptyElement::at((value, y)) + Polygon::new(marker(shape, 6), colour.filled());
            chart.draw_series([mark]).map_err(NotDrawn::because)?;
        }
    }
    Ok(())
}
