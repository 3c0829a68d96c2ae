//! The stability map as a picture: two fixed-gain filters are stable under any mixing in a band around equal noises.

use super::chart::{Axis, Caption, Key, NotDrawn, draw_cells, draw_path, edges, figure, panel};
use super::palette::{FILTERS, INK, PAPER};
use crate::number::{Rational, Real};
use crate::steady::map::{Map, MapPoint};
use crate::steady::verdict::StabilityVerdict;
use plotters::prelude::*;
use std::fmt::Write;

/// What a point may be, and its colour: paler where it takes more to prove.
const LEGEND: [(&str, RGBColor, f64); 6] = [
    ("stable: one quadratic form", FILTERS[0], 1.0),
    ("stable: forms with a memory", FILTERS[0], 0.45),
    ("unstable: product of two", FILTERS[1], 1.0),
    ("unstable: of three to five", FILTERS[1], 0.55),
    ("unstable: of six and more", FILTERS[1], 0.25),
    ("undecided", INK, 1.0),
];
const HEIGHT: u32 = 640;

/// The place in the legend.
fn kind(verdict: &StabilityVerdict) -> usize {
    match verdict {
        StabilityVerdict::Stable(found) if found.forms.len() == 1 => 0,
        StabilityVerdict::Stable(_) => 1,
        StabilityVerdict::Unstable(found) if found.word.len() <= 2 => 2,
        StabilityVerdict::Unstable(found) if found.word.len() <= 5 => 3,
        StabilityVerdict::Unstable(_) => 4,
        StabilityVerdict::Undecided { .. } => 5,
    }
}

/// log₁₀ of the tracking index of a point along an axis.
fn decade(point: &MapPoint, axis: usize) -> f64 {
    Real::ln(&Rational::to_f64(&point.indices[axis])) / Real::ln(&10.0)
}

/// A power of ten as a label.
fn power(exponent: f64) -> String {
    format!("1e{exponent:.0}")
}

/// The map, a square a point.
///
/// # Errors
///
/// [`NotDrawn`] when the figure cannot be drawn.
pub fn draw(map: &Map) -> Result<String, NotDrawn> {
    let kinds: Vec<Vec<usize>> = map
        .points
        .iter()
        .map(|row| row.iter().map(|point| kind(&point.verdict)).collect())
        .collect();
    // Rows are of constant velocity, columns of constant acceleration.
    let along = |axis: usize| -> Vec<f64> {
        match axis {
            0 => map
                .points
                .iter()
                .filter_map(|row| row.first())
                .map(|point| decade(point, 0))
                .collect(),
            _ => map
                .points
                .iter()
                .take(1)
                .flatten()
                .map(|point| decade(point, 1))
                .collect(),
        }
    };
    let (columns, rows) = (along(1), along(0));
    let (x_edges, y_edges) = (edges(&columns), edges(&rows));
    let (&[left, .., right], &[low, .., high]) = (&x_edges[..], &y_edges[..]) else {
        return Ok(String::new());
    };
    figure(&caption(&kinds), &legend(), HEIGHT, |area| {
        let mut x = Axis::new(left..right, "tracking index of constant acceleration, Λ_a", false);
        let mut y = Axis::new(low..high, "tracking index of constant velocity, Λ_v", false);
        for axis in [&mut x, &mut y] {
            (axis.format, axis.labels) = (power, 7);
        }
        let mut chart = panel(area, "", [&x, &y], &[])?;
        draw_cells(&mut chart, [&x_edges, &y_edges], |row, column| {
            let (_, colour, opacity) = LEGEND[kinds[row][column]];
            colour.mix(opacity)
        })?;
        let ends = [left.max(low), right.min(high)].map(|end| (end, end));
        draw_path(&mut chart, ends.to_vec(), PAPER, 4)?;
        draw_path(&mut chart, ends.to_vec(), INK, 2)
    })
}

fn caption(kinds: &[Vec<usize>]) -> Caption {
    let mut says = String::from("A square map of pairs of tracking indices, stable around equal ones. Points:");
    for (place, (name, ..)) in LEGEND.iter().enumerate() {
        let count = kinds.iter().flatten().filter(|kind| **kind == place).count();
        let _ = write!(says, " {name} {count};");
    }
    Caption {
        name: "stability-map".to_owned(),
        title: "Joint stability of two fixed-gain filters that mix".to_owned(),
        note: "A square a pair of tracking indices Λ = σ_w t²/σ_z; all but the undecided ones are proven.".to_owned(),
        says,
        has_cells: true,
    }
}

fn legend() -> Vec<(String, Key)> {
    let areas = LEGEND.iter();
    let areas = areas.map(|(name, colour, opacity)| ((*name).to_owned(), Key::Area(*colour, *opacity)));
    areas.chain([("equal indices".to_owned(), Key::Thin(INK, 0))]).collect()
}
