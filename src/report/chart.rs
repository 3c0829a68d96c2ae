//! The common parts of all figures: a title, a legend above the panels, panels with axes, lines with bands, cells.
//!
//! A figure can be read on a telephone: it is [`WIDTH`] pixels wide, with letters that are large for that width. Coinciding lines stay
//! visible: each is drawn thinner than the one below it and has markers of its own shape at its own places. If two points fall on one
//! pixel, one is drawn.

use super::broken;
use super::palette::{FILTERS, GRID, INK, PAPER, SHADE};
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::ops::Range;

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

/// The width of every figure.
pub const WIDTH: u32 = 720;
/// Sizes of letters, pixels.
const TITLE: f64 = 20.0;
const TEXT: f64 = 17.0;
const SMALL: f64 = 15.0;
/// What a panel without a title has around it, in which its axes are named.
pub(super) const LEFT: u32 = 78;
pub(super) const RIGHT: u32 = 22;
pub(super) const ABOVE: u32 = 10;
pub(super) const BELOW: u32 = 54;

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(super) type Chart<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
pub(super) type Drawn = Result<(), NotDrawn>;

/// What a figure is called and what it says.
pub(super) struct Caption {
    /// A name that no other figure of a page has.
    pub name: String,
    /// The line above the figure.
    pub title: String,
    /// Below it, what a reader has to know: runs, bands, shades.
    pub note: String,
    /// A sentence or two for readers who cannot see the figure.
    pub says: String,
    /// Whether it is made of cells, between which no gaps may be left.
    pub has_cells: bool,
}

/// How the line of a filter looks.
#[derive(Clone, Copy)]
pub(super) struct Look {
    pub colour: RGBColor,
    pub width: u32,
    shape: usize,
}

/// The looks of a number of lines: each thinner than the one before.
pub(super) fn looks(count: usize) -> Vec<Look> {
    let widths = (0..count).rev().map(|below| 2 + 2 * u32::try_from(below).unwrap_or(0));
    let colours = FILTERS.iter().cycle().enumerate();
    colours
        .zip(widths)
        .map(|((shape, colour), width)| Look {
            colour: *colour,
            width,
            shape,
        })
        .collect()
}

/// What stands beside the words of a legend.
pub(super) enum Key {
    /// A filter's line.
    Line(Look),
    /// A thin line, broken into dashes of a length and gaps of another, or whole where the length is zero.
    Thin(RGBColor, i32),
    /// A dot.
    Dot(RGBColor),
    /// A marker by itself: its shape, and whether only its outline.
    Mark(RGBColor, usize),
    /// An area.
    Area(RGBColor, f64),
}

/// Letters of a size in pixels.
pub(super) fn letters<'a>(size: f64) -> TextStyle<'a> {
    // The library writes 1/1.24 of the size that it is given.
    TextStyle::from(("sans-serif", 1.24 * size)).color(&INK)
}

/// The letters of labels, with an anchor.
pub(super) fn label<'a>(horizontal: HPos, vertical: VPos) -> TextStyle<'a> {
    letters(SMALL).pos(Pos::new(horizontal, vertical))
}

/// A whole figure: title, note, legend, and below them a body of the given height.
///
/// # Errors
///
/// [`NotDrawn`] when something of it cannot be drawn.
pub(super) fn figure(
    caption: &Caption,
    legend: &[(String, Key)],
    height: u32,
    body: impl FnOnce(&Area) -> Drawn,
) -> Result<String, NotDrawn> {
    let (titles, notes) = (lines(&caption.title, TITLE), lines(&caption.note, SMALL));
    let places = legend_places(legend);
    let pixels = |count: usize, of_one: i32| i32::try_from(count).unwrap_or(0) * of_one;
    let legend_top = 14 + pixels(titles.len(), 26) + pixels(notes.len(), 20);
    let rows = places.last().map_or(0, |(_, row)| row + 1);
    let top = u32::try_from(legend_top + 26 * rows + 6).unwrap_or(0);
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (WIDTH, top + height)).into_drawing_area();
        root.fill(&PAPER).map_err(NotDrawn::because)?;
        for (row, line) in titles.iter().enumerate() {
            write(&root, line, (12, 10 + pixels(row, 26)), letters(TITLE))?;
        }
        for (row, line) in notes.iter().enumerate() {
            let y = 12 + pixels(titles.len(), 26) + pixels(row, 20);
            write(&root, line, (12, y), letters(SMALL))?;
        }
        for ((words, key), (x, row)) in legend.iter().zip(places) {
            let y = legend_top + 26 * row + 13;
            draw_key(&root, key, (x, y))?;
            write(&root, words, (x + 46, y - 8), letters(TEXT))?;
        }
        let (_, area) = root.split_vertically(top);
        body(&area)?;
        root.present().map_err(NotDrawn::because)?;
    }
    Ok(with_words(&svg, caption))
}

fn write(area: &Area, words: &str, place: (i32, i32), style: TextStyle) -> Drawn {
    area.draw(&Text::new(words, place, style)).map_err(NotDrawn::because)
}

/// A text in lines that fit the figure. A letter is taken to be 0.54 of its size wide.
fn lines(text: &str, size: f64) -> Vec<String> {
    let room = f64::from(WIDTH - 24) / (0.54 * size);
    // As many characters as are sure to fit.
    let characters = (1..200).take_while(|count| f64::from(*count) <= room).count();
    broken(text, characters)
}

/// Where each entry of a legend begins: x, and its row.
fn legend_places(legend: &[(String, Key)]) -> Vec<(i32, i32)> {
    let (mut x, mut row) = (12, 0);
    let mut places = Vec::new();
    for (words, _) in legend {
        let width = 46 + 20 + 10 * i32::try_from(words.chars().count()).unwrap_or(0);
        if x > 12 && x + width > i32::try_from(WIDTH).unwrap_or(0) {
            (x, row) = (12, row + 1);
        }
        places.push((x, row));
        x += width;
    }
    places
}

fn draw_key(area: &Area, key: &Key, (x, y): (i32, i32)) -> Drawn {
    let line = |from: i32, to: i32, style: ShapeStyle| {
        area.draw(&PathElement::new(vec![(x + from, y), (x + to, y)], style))
            .map_err(NotDrawn::because)
    };
    match key {
        Key::Line(look) => {
            line(0, 38, look.colour.stroke_width(look.width))?;
            draw_marker(area, (x + 19, y), look.colour, look.shape)
        }
        Key::Thin(colour, 0) => line(0, 38, colour.stroke_width(2)),
        Key::Thin(colour, dash) => (0..38)
            .step_by(usize::try_from(2 * dash).unwrap_or(8))
            .try_for_each(|from| line(from, (from + dash).min(38), colour.stroke_width(2))),
        Key::Dot(colour) => area
            .draw(&Circle::new((x + 19, y), 3, colour.filled()))
            .map_err(NotDrawn::because),
        Key::Mark(colour, shape) => draw_marker(area, (x + 19, y), *colour, *shape),
        Key::Area(colour, opacity) => {
            let corners = [(x, y - 8), (x + 38, y + 8)];
            area.draw(&Rectangle::new(corners, colour.mix(*opacity).filled()))
                .map_err(NotDrawn::because)
        }
    }
}

/// The corners of a marker of a shape and size, about its centre: square, triangle, diamond, triangle upside down, octagon.
pub(super) fn marker(shape: usize, size: i32) -> Vec<(i32, i32)> {
    let (s, half) = (size, size / 2);
    match shape % 5 {
        0 => vec![
            (-s, half),
            (-half, s),
            (half, s),
            (s, half),
            (s, -half),
            (half, -s),
            (-half, -s),
            (-s, -half),
        ],
        1 => vec![(-s, -s), (s, -s), (s, s), (-s, s)],
        2 => vec![(-s, s), (s, s), (0, -s)],
        3 => vec![(0, -s - 1), (s + 1, 0), (0, s + 1), (-s - 1, 0)],
        _ => vec![(-s, -s), (s, -s), (0, s)],
    }
}

/// A marker with a rim of paper around it.
fn draw_marker(area: &Area, (x, y): (i32, i32), colour: RGBColor, shape: usize) -> Drawn {
    for (size, colour) in [(8, PAPER), (6, colour)] {
        let corners = marker(shape, size).into_iter().map(|(dx, dy)| (x + dx, y + dy));
        let polygon = Polygon::new(corners.collect::<Vec<_>>(), colour.filled());
        area.draw(&polygon).map_err(NotDrawn::because)?;
    }
    Ok(())
}

/// Title and description for readers who cannot see the figure, and for the browser's tooltip.
fn with_words(svg: &str, caption: &Caption) -> String {
    let Caption { name, title, says, .. } = caption;
    let edges = if caption.has_cells {
        " shape-rendering=\"crispEdges\""
    } else {
        ""
    };
    let escaped = |text: &str| text.replace('&', "&amp;").replace('<', "&lt;");
    let Some((head, body)) = svg.split_once('>') else {
        return svg.to_owned();
    };
    format!(
        "{head}{edges} role=\"img\" aria-labelledby=\"{name}-title {name}-desc\">\n<title id=\"{name}-title\">{}</title>\n\
         <desc id=\"{name}-desc\">{}</desc>{body}",
        escaped(title),
        escaped(says)
    )
}

// Panels

/// One axis of a panel.
pub(super) struct Axis<'a> {
    pub range: Range<f64>,
    pub name: &'a str,
    /// About how many labels; none where there are none.
    pub labels: usize,
    /// Whether lines cross the panel at the labels.
    pub has_grid: bool,
    /// The room for the labels of a vertical axis, pixels.
    pub room: u32,
    pub format: fn(f64) -> String,
}

impl<'a> Axis<'a> {
    /// An axis with some labels, and lines across the panel if it is the vertical one.
    pub fn new(range: Range<f64>, name: &'a str, has_grid: bool) -> Self {
        Self {
            range,
            name,
            labels: 6,
            has_grid,
            room: LEFT - 8,
            format: plain,
        }
    }
}

/// A number of an axis without what rounding left behind.
pub(super) fn plain(value: f64) -> String {
    format!("{}", (value * 1e6).round() / 1e6 + 0.0)
}

/// A panel: what is shaded along x, the grid, the axes.
pub(super) fn panel<'a>(
    area: &Area<'a>,
    title: &str,
    [x, y]: [&Axis; 2],
    shaded: &[Range<f64>],
) -> Result<Chart<'a>, NotDrawn> {
    let mut builder = ChartBuilder::on(area);
    builder
        .margin_left(8)
        .margin_right(RIGHT)
        .margin_top(ABOVE)
        .margin_bottom(4);
    builder.x_label_area_size(BELOW - 4).y_label_area_size(y.room);
    if !title.is_empty() {
        builder.caption(title, letters(TEXT));
    }
    let mut chart = builder
        .build_cartesian_2d(x.range.clone(), y.range.clone())
        .map_err(NotDrawn::because)?;
    let shades = shaded.iter().map(|part| {
        let corners = [(part.start, y.range.start), (part.end, y.range.end)];
        Rectangle::new(corners, SHADE.filled())
    });
    chart.draw_series(shades).map_err(NotDrawn::because)?;
    let mut mesh = chart.configure_mesh();
    mesh.light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .axis_style(INK)
        .label_style(letters(SMALL))
        .axis_desc_style(letters(TEXT))
        .x_desc(x.name)
        .y_desc(y.name)
        .x_labels(x.labels)
        .y_labels(y.labels);
    if !x.has_grid {
        mesh.disable_x_mesh();
    }
    if !y.has_grid {
        mesh.disable_y_mesh();
    }
    let (x_format, y_format) = (x.format, y.format);
    mesh.x_label_formatter(&|value| x_format(*value))
        .y_label_formatter(&|value| y_format(*value))
        .draw()
        .map_err(NotDrawn::because)?;
    Ok(chart)
}

/// The least and the greatest of some values, with a margin.
pub(super) fn range_of(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (mut low, mut high) = (f64::MAX, f64::MIN);
    for value in values.filter(|value| value.is_finite()) {
        low = low.min(value);
        high = high.max(value);
    }
    if low > high {
        return 0.0..1.0;
    }
    let margin = 0.05 * (high - low).max(1e-9 * high.abs()).max(1e-9);
    low - margin..high + margin
}

/// The stretches of time in which something is so, half a step to either side.
pub(super) fn stretches(times: &[f64], is_so: &[bool]) -> Vec<Range<f64>> {
    let (Some(first), Some(last)) = (times.first(), times.last()) else {
        return Vec::new();
    };
    let half = (last - first) / (2.0 * (times.len().max(2) - 1) as f64);
    let mut stretches: Vec<Range<f64>> = Vec::new();
    for (time, _) in times.iter().zip(is_so).filter(|(_, is_so)| **is_so) {
        let (from, to) = ((time - half).max(*first), (time + half).min(*last));
        match stretches.last_mut() {
            Some(before) if from - before.end < half => before.end = to,
            _ => stretches.push(from..to),
        }
    }
    stretches
}

/// A line with a band around it, point by point from low to high; no band where the list is empty.
pub(super) struct Line {
    pub look: Look,
    pub points: Vec<(f64, f64)>,
    pub band: Vec<[f64; 2]>,
}

/// Bands, then lines, then markers: nothing that is thin is under something that is wide.
pub(super) fn draw_lines(chart: &mut Chart, lines: &[Line]) -> Drawn {
    for line in lines {
        let lower = line.points.iter().zip(&line.band).map(|((x, _), band)| (*x, band[0]));
        let upper = line.points.iter().zip(&line.band).map(|((x, _), band)| (*x, band[1]));
        let outline: Vec<(f64, f64)> = lower.chain(upper.rev()).collect();
        let outline = distinct(chart, outline);
        if outline.len() > 2 {
            let band = Polygon::new(outline, line.look.colour.mix(0.25));
            chart.draw_series([band]).map_err(NotDrawn::because)?;
        }
    }
    for line in lines {
        draw_path(chart, line.points.clone(), line.look.colour, line.look.width)?;
    }
    // One marker of each line in about a hundred pixels.
    let marks = usize::try_from(chart.plotting_area().dim_in_pixel().0 / 95)
        .unwrap_or(1)
        .max(1);
    for (number, line) in lines.iter().enumerate() {
        let period = line.points.len().div_ceil(marks).max(1);
        let first = period * (2 * number + 1) / (2 * lines.len());
        let marked = line.points.iter().skip(first).step_by(period);
        for point in marked {
            draw_at(chart, *point, line.look)?;
        }
    }
    Ok(())
}

/// The marker of a look at a place of a chart.
fn draw_at(chart: &mut Chart, place: (f64, f64), look: Look) -> Drawn {
    for (size, colour) in [(8, PAPER), (6, look.colour)] {
        let mark = EmptyElement::at(place) + Polygon::new(marker(look.shape, size), colour.filled());
        chart.draw_series([mark]).map_err(NotDrawn::because)?;
    }
    Ok(())
}

/// A line through some points.
pub(super) fn draw_path(chart: &mut Chart, points: Vec<(f64, f64)>, colour: RGBColor, width: u32) -> Drawn {
    let points = distinct(chart, points);
    let line = LineSeries::new(points, colour.stroke_width(width));
    chart.draw_series(line).map_err(NotDrawn::because)?;
    Ok(())
}

/// Dots at some places.
pub(super) fn draw_dots(chart: &mut Chart, points: Vec<(f64, f64)>, colour: RGBColor) -> Drawn {
    let points = distinct(chart, points).into_iter();
    let dots = points.map(|place| Circle::new(place, 2, colour.filled()));
    chart.draw_series(dots).map_err(NotDrawn::because)?;
    Ok(())
}

/// The points that are finite and not on the pixel of the one before.
fn distinct(chart: &Chart, points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let mut points: Vec<_> = points
        .into_iter()
        .filter(|(x, y)| x.is_finite() && y.is_finite())
        .collect();
    points.dedup_by_key(|point| chart.backend_coord(point));
    points
}

/// Cells between edges, row by row: neighbours of one colour are one rectangle.
pub(super) fn draw_cells(chart: &mut Chart, [x, y]: [&[f64]; 2], colour: impl Fn(usize, usize) -> RGBAColor) -> Drawn {
    for row in 0..y.len().saturating_sub(1) {
        let colours: Vec<RGBAColor> = (0..x.len().saturating_sub(1))
            .map(|column| colour(row, column))
            .collect();
        let mut column = 0;
        for same in colours.chunk_by(|a, b| a == b) {
            let corners = [(x[column], y[row]), (x[column + same.len()], y[row + 1])];
            let cell = Rectangle::new(corners, same[0].filled());
            chart.draw_series([cell]).map_err(NotDrawn::because)?;
            column += same.len();
        }
    }
    Ok(())
}

/// The edges of cells that are centred at evenly spaced values.
pub(super) fn edges(centres: &[f64]) -> Vec<f64> {
    let (first, last) = match centres {
        [first, .., last] => (*first, *last),
        [only] => (*only, *only),
        [] => return Vec::new(),
    };
    let spacing = match centres.len() {
        1 => 1.0,
        count => (last - first) / (count - 1) as f64,
    };
    (0..=centres.len())
        .map(|edge| first + (edge as f64 - 0.5) * spacing)
        .collect()
}
