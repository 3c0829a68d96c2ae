//! The errors of a value over the steps of a case, as SVG.
//!
//! The plot shows whether an error was made once and is inherited, or is made again in every step: one line is the error against the
//! certified values, the other is the part that the value's own equation adds.

use crate::oracle::check::CaseReport;
use crate::oracle::judge::{Judged, LIMIT};
use crate::report::chart::{
    Axis, Caption, Drawn, Key, Line, NotDrawn, draw_lines, draw_path, figure, looks, panel, range_of,
};
use crate::report::fault::unit;
use crate::report::palette::MEASURED;
use std::ops::Range;

const HEIGHT: u32 = 300;
/// A smaller error than this is drawn here: no double has more digits.
const LEAST: f64 = 1e-17;
/// A larger one than this is drawn here.
const MOST: f64 = 1e17;
/// A case with fewer steps is not drawn.
const STEPS: usize = 3;

/// The errors of the quantity and mode of a value, in the steps of its case; nothing where there are too few.
///
/// # Errors
///
/// [`NotDrawn`] when the figure cannot be drawn.
pub(super) fn errors(case: &CaseReport, value: &Judged, name: &str) -> Result<Option<String>, NotDrawn> {
    let (_, quantity, mode) = value.place;
    let judged = case.judgement.iter().flat_map(|judgement| &judgement.values);
    let is_one = |other: &&Judged| (other.place.1, other.place.2) == (quantity, mode);
    let values: Vec<&Judged> = judged.filter(is_one).collect();
    if values.len() < STEPS {
        return Ok(None);
    }
    let at = |value: &Judged, error: f64| (value.place.0 as f64, decade(error));
    let certified: Vec<_> = values.iter().map(|value| at(value, value.error)).collect();
    let own = values.iter().filter_map(|value| Some(at(value, value.own?.size)));
    let allowed = values.iter().filter_map(|value| Some(at(value, allowed(value)?)));
    let (own, allowed): (Vec<_>, Vec<_>) = (own.collect(), allowed.collect());
    let of_mode = if quantity.is_of_mode() {
        format!("modes[{mode}].")
    } else {
        String::new()
    };
    let what = format!("{of_mode}{}", quantity.name());
    let caption = Caption {
        name: name.to_owned(),
        title: format!("{}: {what}", case.id),
        note: "Logarithmic scale; errors smaller than 1e-17 are drawn at 1e-17.".to_owned(),
        says: format!(
            "The error of {what} in each of {} steps, against the certified values and against its own equation.",
            values.len()
        ),
        has_cells: false,
    };
    let looks = looks(2);
    let mut legend = vec![
        ("against the certified value".to_owned(), Key::Line(looks[0])),
        ("made in this equation".to_owned(), Key::Line(looks[1])),
    ];
    if !allowed.is_empty() {
        legend.push(("could be rounding".to_owned(), Key::Thin(MEASURED, 0)));
    }
    let lines = [(certified, looks[0]), (own, looks[1])].map(|(points, look)| Line {
        look,
        points,
        band: Vec::new(),
    });
    let unit = match unit(quantity) {
        "" => "error".to_owned(),
        unit => format!("error ({})", unit.trim()),
    };
    figure(&caption, &legend, HEIGHT, |area| draw(area, &unit, &lines, allowed)).map(Some)
}

fn draw(area: &crate::report::chart::Area, unit: &str, lines: &[Line], allowed: Vec<(f64, f64)>) -> Drawn {
    let points = || lines.iter().flat_map(|line| &line.points).chain(&allowed);
    let x = Axis::new(range_of(points().map(|point| point.0)), "step", false);
    let mut y = Axis::new(whole(&range_of(points().map(|point| point.1))), unit, true);
    y.format = power;
    let mut chart = panel(area, "", [&x, &y], &[])?;
    draw_path(&mut chart, allowed, MEASURED, 2)?;
    draw_lines(&mut chart, lines)
}

/// The greatest error of a value that may be rounding, in its unit; unknown where there is no error to tell it from.
fn allowed(value: &Judged) -> Option<f64> {
    let own = value.own?;
    let noise = own.size / own.ratio;
    (noise.is_finite() && noise > 0.0).then_some(LIMIT * noise)
}

/// The decimal logarithm of an error, within what is drawn; what is no number is drawn on top.
fn decade(error: f64) -> f64 {
    let error = if error.is_nan() { MOST } else { error };
    libm::log10(error.clamp(LEAST, MOST))
}

/// A range between whole numbers.
fn whole(range: &Range<f64>) -> Range<f64> {
    range.start.floor()..range.end.ceil()
}

/// A power of ten by its decade; nothing between whole ones.
fn power(decade: f64) -> String {
    if (decade - decade.round()).abs() > 1e-6 {
        return String::new();
    }
    match decade.round() {
        0.0 => "1".to_owned(),
        whole => format!("1e{whole}"),
    }
}
