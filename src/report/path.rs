//! The first run in the plane, as SVG: the target's path, the measurements, and the filters' estimates.
//!
//! It shows what the averages are made of: one run, with the same scale along both axes and the manoeuvres as a wide grey track. Below it
//! are the errors of x and of y in this run, which separate filters that look alike in the plane.

use super::chart::{
    ABOVE, Area, Axis, BELOW, Caption, Drawn, Key, LEFT, Line, Look, NotDrawn, RIGHT, WIDTH, draw_dots, draw_lines,
    draw_path, figure, label, looks, marker, panel, range_of, stretches,
};
use super::figure::{legend, stem, title, turning, what_is_shaded};
use super::palette::{INK, MEASURED, SHADE};
use crate::paper::result::{FirstRun, Reproduction};
use crate::statistics::estimate::figure as digits;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};
use std::fmt::Write;
use std::ops::Range;

/// The pixels between the axes of the plane: across, and down at least and at most.
const ACROSS: f64 = (WIDTH - LEFT - RIGHT) as f64;
const DOWN: [u32; 2] = [200, 520];
const ERRORS_HEIGHT: u32 = 240;

/// The first run in the plane, and below it the errors of x and of y in this run.
///
/// # Errors
///
/// [`NotDrawn`] when the figure cannot be drawn.
pub fn path(reproduction: &Reproduction, first_run: &FirstRun) -> Result<String, NotDrawn> {
    let (ranges, down) = equal_axes(first_run);
    let plane_height = down + ABOVE + BELOW;
    let turning = turning(reproduction);
    let mut entries = legend(reproduction, |_| true);
    entries.push(("truth".to_owned(), Key::Thin(INK, 0)));
    entries.push(("measured".to_owned(), Key::Dot(MEASURED)));
    if turning.contains(&true) {
        entries.push((what_is_shaded(reproduction).to_owned(), Key::Area(SHADE, 1.0)));
    }
    if first_run.sensor.is_some() {
        entries.push(("sensor".to_owned(), Key::Mark(INK, SENSOR)));
    }
    let caption = Caption {
        name: format!("{}-path", stem(reproduction)),
        title: format!("{}: the first run in the plane", title(reproduction)),
        note: format!(
            "Run 1 of seed {}; one scale for x and y. Below, estimate and measurement less truth.",
            reproduction.seed
        ),
        says: says(reproduction, first_run),
        has_cells: false,
    };
    figure(&caption, &entries, plane_height + 2 * ERRORS_HEIGHT, |area| {
        let (plane, errors) = area.split_vertically(plane_height);
        draw_plane(&plane, first_run, ranges, &turning)?;
        let areas = errors.split_evenly((2, 1));
        (0..2).try_for_each(|coordinate| draw_errors(&areas[coordinate], reproduction, first_run, coordinate))
    })
}

/// The shape of the sensor's mark: a triangle.
const SENSOR: usize = 2;

/// How far the filters are from the truth, in words.
fn says(reproduction: &Reproduction, first_run: &FirstRun) -> String {
    let mut says = format!(
        "The path of the target in the first run, with {} measured positions. Greatest distance of an estimate from the truth:",
        first_run.measured.len()
    );
    let greatest = |path: &[[f64; 2]]| {
        let distances = path.iter().zip(&first_run.truth).map(|(place, truth)| {
            let [x, y] = [place[0] - truth[0], place[1] - truth[1]];
            (x * x + y * y).sqrt()
        });
        digits(distances.fold(0.0, f64::max))
    };
    let filters = reproduction.filters.iter().map(|filter| filter.name.as_str());
    for (name, path) in filters.zip(&first_run.estimates) {
        let _ = write!(says, " {name} {} m;", greatest(path));
    }
    let _ = write!(says, " of a measurement {} m.", greatest(&first_run.measured));
    says
}

/// The ranges of x and of y on one scale, and the pixels of y.
fn equal_axes(first_run: &FirstRun) -> ([Range<f64>; 2], u32) {
    let places = || {
        let measured = first_run.truth.iter().chain(&first_run.measured);
        measured.chain(&first_run.sensor)
    };
    let [x, y] = [0, 1].map(|coordinate| range_of(places().map(|place| place[coordinate])));
    let (width, height) = (x.end - x.start, y.end - y.start);
    let wanted = ACROSS * height / width;
    let down = (DOWN[0]..DOWN[1])
        .find(|pixels| f64::from(*pixels) >= wanted)
        .unwrap_or(DOWN[1]);
    // Room for the word under the start.
    let metres_a_pixel = 1.1 * (width / ACROSS).max(height / f64::from(down));
    let around = |range: &Range<f64>, pixels: f64| {
        let (centre, half) = (f64::midpoint(range.start, range.end), metres_a_pixel * pixels / 2.0);
        centre - half..centre + half
    };
    ([around(&x, ACROSS), around(&y, f64::from(down))], down)
}

fn pairs(path: &[[f64; 2]]) -> Vec<(f64, f64)> {
    path.iter().map(|place| (place[0], place[1])).collect()
}

fn draw_plane(area: &Area, first_run: &FirstRun, [x, y]: [Range<f64>; 2], turning: &[bool]) -> Drawn {
    let mut x = Axis::new(x, "x (m)", true);
    x.labels = 5;
    let mut chart = panel(area, "", [&x, &Axis::new(y, "y (m)", true)], &[])?;
    let steps: Vec<_> = turning.iter().zip(&first_run.truth).collect();
    for manoeuvre in steps.chunk_by(|a, b| a.0 == b.0).filter(|steps| *steps[0].0) {
        let track = manoeuvre.iter().map(|(_, place)| (place[0], place[1])).collect();
        draw_path(&mut chart, track, SHADE, 22)?;
    }
    draw_dots(&mut chart, pairs(&first_run.measured), MEASURED)?;
    let lines: Vec<Line> = looks(first_run.estimates.len())
        .into_iter()
        .zip(&first_run.estimates)
        .map(|(look, path)| Line {
            look,
            points: pairs(path),
            band: Vec::new(),
        })
        .collect();
    draw_lines(&mut chart, &lines)?;
    draw_path(&mut chart, pairs(&first_run.truth), INK, 1)?;
    if let Some(start) = first_run.truth.first() {
        let mark = EmptyElement::at((start[0], start[1]))
            + Circle::new((0, 0), 7, INK.stroke_width(2))
            + Text::new("start", (10, 16), label(HPos::Left, VPos::Center));
        chart.draw_series([mark]).map_err(NotDrawn::because)?;
    }
    if let Some(sensor) = first_run.sensor {
        let mark = EmptyElement::at((sensor[0], sensor[1])) + Polygon::new(marker(SENSOR, 8), INK.filled());
        chart.draw_series([mark]).map_err(NotDrawn::because)?;
    }
    Ok(())
}

/// The errors of x (0) or y (1) in the first run.
fn draw_errors(area: &Area, reproduction: &Reproduction, first_run: &FirstRun, coordinate: usize) -> Drawn {
    let times = &reproduction.times;
    let errors = |path: &[[f64; 2]]| -> Vec<(f64, f64)> {
        let steps = times.iter().zip(path.iter().zip(&first_run.truth));
        steps
            .map(|(time, (place, truth))| (*time, place[coordinate] - truth[coordinate]))
            .collect()
    };
    let measured = errors(&first_run.measured);
    let line = |(look, path): (Look, &Vec<[f64; 2]>)| Line {
        look,
        points: errors(path),
        band: Vec::new(),
    };
    let lines: Vec<Line> = looks(first_run.estimates.len())
        .into_iter()
        .zip(&first_run.estimates)
        .map(line)
        .collect();
    let all = lines.iter().map(|line| &line.points).chain([&measured]).flatten();
    let y = Axis::new(
        range_of(all.map(|point| point.1)),
        ["error of x (m)", "error of y (m)"][coordinate],
        true,
    );
    let x = Axis::new(times[0]..times[times.len() - 1], "time (s)", false);
    let mut chart = panel(area, "", [&x, &y], &stretches(times, &turning(reproduction)))?;
    draw_dots(&mut chart, measured, MEASURED)?;
    draw_lines(&mut chart, &lines)
}
