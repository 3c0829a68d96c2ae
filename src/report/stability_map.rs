//! The stability map as a picture.
//!
//! After this file the reader can see where two fixed-gain filters are stable however they are mixed: a band around equal noises.

use super::figure::{NotDrawn, not_drawn};
use crate::number::{Rational, Real};
use crate::steady::map::{Map, Point};
use crate::steady::verdict::Verdict;
use plotters::prelude::*;

/// The colours of the legend, told apart by people who see colours differently (Okabe and Ito 2008).
const LEGEND: [(&str, RGBColor); 6] = [
    ("stable: one quadratic form", RGBColor(0, 114, 178)),
    ("stable: forms with a memory", RGBColor(86, 180, 233)),
    ("unstable: product of two", RGBColor(213, 94, 0)),
    ("unstable: of three to five", RGBColor(230, 159, 0)),
    ("unstable: of six and more", RGBColor(240, 228, 66)),
    ("undecided", RGBColor(0, 0, 0)),
];

fn colour(verdict: &Verdict) -> RGBColor {
    let place = match verdict {
        Verdict::Stable(found) if found.forms.len() == 1 => 0,
        Verdict::Stable(_) => 1,
        Verdict::Unstable(found) if found.word.len() <= 2 => 2,
        Verdict::Unstable(found) if found.word.len() <= 5 => 3,
        Verdict::Unstable(_) => 4,
        Verdict::Undecided { .. } => 5,
    };
    LEGEND[place].1
}

/// log₁₀ of the tracking index of a point along an axis.
fn decade(point: &Point, axis: usize) -> f64 {
    Real::ln(&Rational::to_f64(&point.indices[axis])) / Real::ln(&10.0)
}

/// The map, a square a point.
///
/// # Errors
///
/// [`NotDrawn`] when the figure cannot be drawn.
pub fn draw(map: &Map) -> Result<String, NotDrawn> {
    let mut svg = String::new();
    let points = || map.points.iter().flatten();
    let (Some(least), Some(greatest)) = (points().next(), points().last()) else {
        return Ok(svg);
    };
    let side = map.points.len().max(2) - 1;
    // A little wider than half, so that no gaps are left by rounding to pixels.
    let half = |axis: usize| 0.53 * (decade(greatest, axis) - decade(least, axis)) / side as f64;
    let range = |axis: usize| decade(least, axis) - half(axis)..decade(greatest, axis) + half(axis);
    {
        let root = SVGBackend::with_string(&mut svg, (860, 640)).into_drawing_area();
        root.fill(&WHITE).map_err(not_drawn)?;
        let (area, legend) = root.split_horizontally(640);
        let mut chart = ChartBuilder::on(&area)
            .caption("Joint stability of two fixed-gain filters that mix", ("sans-serif", 17))
            .margin(12)
            .x_label_area_size(45)
            .y_label_area_size(60)
            .build_cartesian_2d(range(1), range(0))
            .map_err(not_drawn)?;
        chart
            .configure_mesh()
            .disable_mesh()
            .x_desc("tracking index of constant acceleration, Λ_a")
            .y_desc("tracking index of constant velocity, Λ_v")
            .x_label_formatter(&|x| format!("1e{x:.0}"))
            .y_label_formatter(&|y| format!("1e{y:.0}"))
            .x_labels(7)
            .y_labels(7)
            .draw()
            .map_err(not_drawn)?;
        let squares = points().map(|point| {
            let (x, y) = (decade(point, 1), decade(point, 0));
            let corners = [(x - half(1), y - half(0)), (x + half(1), y + half(0))];
            Rectangle::new(corners, colour(&point.verdict).filled())
        });
        chart.draw_series(squares).map_err(not_drawn)?;
        let ends = [
            (decade(least, 1), decade(least, 1)),
            (decade(greatest, 1), decade(greatest, 1)),
        ];
        chart
            .draw_series(LineSeries::new(ends, WHITE.stroke_width(2)))
            .map_err(not_drawn)?;
        let mut y = 60;
        for (name, colour) in LEGEND {
            let mark = Rectangle::new([(0, y), (16, y + 16)], colour.filled());
            legend.draw(&mark).map_err(not_drawn)?;
            let text = Text::new(name, (24, y + 1), ("sans-serif", 13));
            legend.draw(&text).map_err(not_drawn)?;
            y += 26;
        }
        let note = Text::new("white line: equal indices", (0, y + 8), ("sans-serif", 13));
        legend.draw(&note).map_err(not_drawn)?;
        root.present().map_err(not_drawn)?;
    }
    Ok(svg)
}
