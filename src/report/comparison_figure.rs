//! The comparison of a problem's filters as a figure: errors over the steps, with bands, and the NEES between its bounds.

use super::chart::{
    Area, Axis, Caption, Drawn, Key, Line, Look, NotDrawn, draw_lines, draw_path, figure, looks, panel, plain,
};
use super::comparison::{group_title, simulated, verdict};
use super::palette::{FILTERS, INK};
use crate::compare::standing::{Differs, FilterComparison, SquareTest, Standing, StandingTable};
use crate::number::Real;
use crate::statistics::Estimate;
use std::fmt::Write;
use std::ops::Range;

const PANEL_HEIGHT: u32 = 300;
/// The height of what is inside a panel's axes, about.
const PIXELS: f64 = 210.0;
/// The band, in standard errors.
const BAND: f64 = 2.0;

/// What differs in a table, in a word.
pub fn what(table: &StandingTable) -> &'static str {
    match table.differs {
        Differs::Filter => "filter",
        Differs::Interaction => "interaction",
    }
}

/// Errors over the steps, one panel a group of components, and the NEES.
///
/// # Errors
///
/// [`NotDrawn`] when the figure cannot be drawn.
pub fn draw(comparison: &FilterComparison, table: &StandingTable) -> Result<String, NotDrawn> {
    let (drawn, note) = chosen(table);
    let of_what = match &table.same {
        Some(same) => format!("{}s with {same}", what(table)),
        None => "filters".to_owned(),
    };
    let caption = Caption {
        name: format!("comparison-{}", what(table)),
        title: format!("{}: {of_what}", comparison.id),
        note: format!(
            "{} runs, seed {}; bands: ± {BAND} standard errors; scales are logarithmic where errors are far apart.{note}",
            table.common_runs, comparison.seed
        ),
        says: format!("{} {}", simulated(comparison), verdict(table)),
        has_cells: false,
    };
    let mut legend: Vec<(String, Key)> = drawn
        .iter()
        .zip(looks(drawn.len()))
        .map(|(one, look)| (one.name.clone(), Key::Line(look)))
        .collect();
    let has_nees = drawn.iter().any(|one| one.nees.is_some());
    if has_nees {
        legend.push(("bounds of NEES".to_owned(), Key::Thin(INK, 0)));
    }
    let panels = comparison.groups.len() + usize::from(has_nees);
    let height = PANEL_HEIGHT * u32::try_from(panels).unwrap_or(1).max(1);
    figure(&caption, &legend, height, |area| {
        let areas = area.split_evenly((panels.max(1), 1));
        for (group, area) in (0..comparison.groups.len()).zip(&areas) {
            let title = format!("RMSE of {}", group_title(&comparison.groups[group]));
            draw_errors(area, &title, &drawn, group)?;
        }
        match areas.last().filter(|_| has_nees) {
            Some(area) => draw_nees(area, &drawn),
            None => Ok(()),
        }
    })
}

/// The filters that are drawn, the file's own and the most accurate among them, and a sentence about the others. Of lines within a pixel
/// of each other one is drawn.
fn chosen(table: &StandingTable) -> (Vec<&Standing>, String) {
    let ranked: Vec<&Standing> = table.standings.iter().filter(|one| one.log_ratio.is_some()).collect();
    let own = ranked.iter().position(|one| one.is_own);
    let mut order: Vec<usize> = own.into_iter().collect();
    order.extend((0..ranked.len()).filter(|place| Some(*place) != own));
    let mut drawn: Vec<usize> = Vec::new();
    let mut close: Vec<Vec<&str>> = vec![Vec::new(); ranked.len()];
    let mut left_out = Vec::new();
    for place in order {
        let same = drawn
            .iter()
            .find(|other| are_close(ranked[**other], ranked[place], &ranked));
        if let Some(same) = same {
            close[*same].push(&ranked[place].name);
        } else if drawn.len() < FILTERS.len() {
            drawn.push(place);
        } else {
            left_out.push(ranked[place].name.as_str());
        }
    }
    let mut note = String::new();
    for place in drawn.iter().filter(|place| !close[**place].is_empty()) {
        let _ = write!(
            note,
            " Within a pixel of {}: {}.",
            ranked[*place].name,
            close[*place].join(", ")
        );
    }
    if !left_out.is_empty() {
        let _ = write!(note, " Not drawn: {}.", left_out.join(", "));
    }
    drawn.sort_unstable();
    (drawn.into_iter().map(|place| ranked[place]).collect(), note)
}

/// Whether two filters' lines are within a pixel of each other in all panels of errors.
fn are_close(a: &Standing, b: &Standing, all: &[&Standing]) -> bool {
    (0..a.groups.len()).all(|group| {
        let scale = Scale::of(
            all.iter()
                .flat_map(|one| one.groups[group].over_steps.iter().flat_map(|error| band(*error))),
        );
        let pixel = (scale.range.end - scale.range.start) / PIXELS;
        let pairs = a.groups[group].over_steps.iter().zip(&b.groups[group].over_steps);
        pairs
            .into_iter()
            .all(|(a, b)| (scale.place(a.value) - scale.place(b.value)).abs() < pixel)
    })
}

/// A vertical scale from zero, or a logarithmic one where the values are far apart.
struct Scale {
    range: Range<f64>,
    is_logarithmic: bool,
}

/// From this ratio of the greatest value to the least on a scale is logarithmic.
const FAR_APART: f64 = 12.0;

impl Scale {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let (mut least, mut greatest) = (f64::INFINITY, 0.0_f64);
        for value in values.filter(|value| value.is_finite() && *value > 0.0) {
            (least, greatest) = (least.min(value), greatest.max(value));
        }
        let is_logarithmic = greatest > FAR_APART * least;
        let range = match (is_logarithmic, greatest > 0.0) {
            (true, _) => log10(least) - 0.05..log10(greatest) + 0.05,
            (false, true) => 0.0..1.05 * greatest,
            (false, false) => 0.0..1.0,
        };
        Self { range, is_logarithmic }
    }

    /// Where a value stands.
    fn place(&self, value: f64) -> f64 {
        if !self.is_logarithmic {
            value
        } else if value > 0.0 {
            log10(value).max(self.range.start)
        } else {
            self.range.start
        }
    }

    fn axis<'a>(&self, name: &'a str) -> Axis<'a> {
        let mut axis = Axis::new(self.range.clone(), name, true);
        if self.is_logarithmic {
            (axis.format, axis.labels) = (power, 4);
        }
        axis
    }
}

fn log10(value: f64) -> f64 {
    Real::ln(&value) / Real::ln(&10.0)
}

/// A power of ten as a label, to three digits.
fn power(exponent: f64) -> String {
    let value = Real::exp(&(exponent * Real::ln(&10.0)));
    let digits: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    plain(digits)
}

fn band(error: Estimate) -> [f64; 2] {
    let Estimate { value, standard_error } = error;
    [(value - BAND * standard_error).max(0.0), value + BAND * standard_error]
}

/// The axis of the steps.
fn steps_axis(count: usize) -> Axis<'static> {
    let range = if count > 1 { 1.0..count as f64 } else { 0.5..1.5 };
    Axis::new(range, "step", false)
}

fn draw_errors(area: &Area, title: &str, filters: &[&Standing], group: usize) -> Drawn {
    let errors = filters.iter().map(|one| &one.groups[group].over_steps);
    let scale = Scale::of(errors.clone().flatten().flat_map(|error| band(*error)));
    let axes = [
        &steps_axis(errors.clone().next().map_or(1, Vec::len)),
        &scale.axis(title),
    ];
    let mut chart = panel(area, "", axes, &[])?;
    let line = |(errors, look): (&Vec<Estimate>, Look)| {
        let finite = errors.iter().enumerate().filter(|(_, error)| error.value.is_finite());
        let (points, band) = finite
            .map(|(k, error)| {
                (
                    ((k + 1) as f64, scale.place(error.value)),
                    band(*error).map(|edge| scale.place(edge)),
                )
            })
            .unzip();
        Line { look, points, band }
    };
    let lines: Vec<Line> = errors.zip(looks(filters.len())).map(line).collect();
    draw_lines(&mut chart, &lines)
}

fn draw_nees(area: &Area, filters: &[&Standing]) -> Drawn {
    let tests = filters
        .iter()
        .zip(looks(filters.len()))
        .filter_map(|(one, look)| Some((one.nees.as_ref()?, look)));
    let tests: Vec<(&SquareTest, Look)> = tests.collect();
    let Some((first, _)) = tests.first() else { return Ok(()) };
    let count = first.over_steps.len();
    let bounds = [first.bounds.0, first.bounds.1];
    let scale = Scale::of(
        tests
            .iter()
            .flat_map(|(test, _)| test.over_steps.iter().copied())
            .chain(bounds),
    );
    let mut chart = panel(area, "", [&steps_axis(count), &scale.axis("NEES")], &[])?;
    let (start, end) = if count > 1 { (1.0, count as f64) } else { (0.5, 1.5) };
    let line = |(test, look): &(&SquareTest, Look)| {
        let values = test.over_steps.iter().enumerate();
        Line {
            look: *look,
            points: values.map(|(k, nees)| ((k + 1) as f64, scale.place(*nees))).collect(),
            band: Vec::new(),
        }
    };
    let lines: Vec<Line> = tests.iter().map(line).collect();
    draw_lines(&mut chart, &lines)?;
    for bound in bounds {
        draw_path(
            &mut chart,
            vec![(start, scale.place(bound)), (end, scale.place(bound))],
            INK,
            2,
        )?;
    }
    Ok(())
}
