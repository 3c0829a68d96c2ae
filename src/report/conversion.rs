//! Where a converted measurement can be trusted: the rule as a table, and its reason as a picture.
//!
//! The table shows up to which nonlinearity ρ = r σ_θ²/σ_r each conversion's covariance is right, the meaning of the textbook's 0.4, and
//! on which side of it the radar of sustika2015 lies. The numbers are the closed forms of
//! [`conversion_validity`](crate::model::conversion_validity).

use super::chart::{Area, Axis, Caption, Drawn, Key, Line, NotDrawn, draw_lines, figure as whole, looks, panel};
use super::palette::{INK, MEASURED, SHADE};
use super::wrapped;
use crate::model::Conversion;
use crate::model::conversion_moments::attenuation;
use crate::model::conversion_validity::{Validity, nonlinearity, validity};
use crate::number::Real;
use plotters::prelude::*;

/// The deviations of the bearing that are shown, degrees.
const DEVIATIONS: [f64; 4] = [0.1, 1.0, 4.0, 20.0];
/// How far error and claim may be apart.
const TOLERANCE: f64 = 0.1;
/// How large a bias may be, in σ_r: that of the plain conversion at the rule of thumb.
const SMALL_BIAS: f64 = RULE / 2.0;
/// The rule of thumb: Bar-Shalom, Li and Kirubarajan 2001, section 10.4.3.
const RULE: f64 = 0.4;
/// Nearer than this multiple of σ_r, the noise of the range is no longer small against the range, and nothing is judged.
const NEAREST: f64 = 10.0;
/// Beyond this no radar is.
const FARTHEST: f64 = 100.0;
/// sustika2015: the first range, m; σ_r, m; and σ_θ, degrees, of its radar and of its second filter.
const RANGE: f64 = 1400.0;
const RANGE_DEVIATION: f64 = 10.0;
const BEARING_DEVIATIONS: [f64; 2] = [1.0, 4.0];

/// σ_θ² in rad² of a deviation in degrees.
fn variance_of(degrees: f64) -> f64 {
    let radians = degrees * f64::pi() / 180.0;
    radians * radians
}

/// How a conversion's error compares with its claim.
fn at(conversion: Conversion, nonlinearity: f64, degrees: f64) -> Validity<f64> {
    let variance = variance_of(degrees);
    validity(conversion, &nonlinearity, &variance, &attenuation(&variance))
}

/// In which sense a conversion may be right.
#[derive(Clone, Copy)]
enum Sense {
    /// Its error is what it claims, along and across the measured line of sight.
    Measured,
    /// The same along and across the true line of sight, where the claim is averaged over measurements.
    True,
    /// Its bias given the truth is small.
    Unbiased,
}

impl Sense {
    const ALL: [Self; 3] = [Self::Measured, Self::True, Self::Unbiased];

    /// What has to hold.
    fn about(self) -> &'static str {
        match self {
            Self::Measured => {
                "Mean squared error and claimed variance agree within 10 %, along and across the measured line of sight:"
            }
            Self::True => {
                "The same along and across the true line of sight, where the claim is averaged over measurements:"
            }
            Self::Unbiased => "The bias given the truth, which no averaging over scans takes away, is below 0.2 σ_r:",
        }
    }

    /// Whether it holds.
    fn holds(self, found: &Validity<f64>) -> bool {
        let agrees = |ratios: [f64; 2]| ratios.iter().all(|ratio| (ratio - 1.0).abs() <= TOLERANCE);
        match self {
            Self::Measured => agrees(found.as_measured),
            Self::True => agrees(found.as_true),
            Self::Unbiased => found.bias.abs() <= SMALL_BIAS,
        }
    }
}

/// The largest ρ up to which a conversion is right, from the nearest range on, to a part in 500.
fn largest(conversion: Conversion, degrees: f64, sense: Sense) -> String {
    let holds = |nonlinearity: f64| sense.holds(&at(conversion, nonlinearity, degrees));
    let mut nonlinearity = NEAREST * variance_of(degrees);
    if !holds(nonlinearity) {
        return "none".to_owned();
    }
    while holds(nonlinearity) {
        nonlinearity *= 1.002;
        if nonlinearity > FARTHEST {
            return "every".to_owned();
        }
    }
    format!("{nonlinearity:.2}")
}

/// The rule: up to which ρ each conversion is right; the numbers of sustika2015's radar; and what both mean.
pub fn table() -> String {
    let mut text = wrapped(
        "Converted measurements: up to which ρ = r σ_θ²/σ_r each is right, by σ_θ. The plain conversion's bias is ρ/2 in σ_r.",
        "",
    );
    for sense in Sense::ALL {
        text.push('\n');
        text.push_str(&wrapped(sense.about(), ""));
        text.push_str(&rule(sense));
    }
    for paragraph in [
        "none: not even at r = 10 σ_r, nearer than which nothing is judged; every: up to ρ = 100.",
        "The radar of sustika2015, r = 1.4 km, σ_r = 10 m: bias along the line of sight, and mean squared error over claim.",
    ] {
        text.push('\n');
        text.push_str(&wrapped(paragraph, ""));
    }
    text.push_str(&radar());
    text.push('\n');
    text.push_str(&meaning());
    text
}

/// A row a conversion, a column a deviation of the bearing.
fn rule(sense: Sense) -> String {
    let names = DEVIATIONS.map(|degrees| format!("{degrees}°"));
    let mut header = vec!["conversion"];
    header.extend(names.iter().map(String::as_str));
    let mut table = super::table(&header);
    for conversion in Conversion::ALL {
        let mut row = vec![conversion.name().to_owned()];
        row.extend(DEVIATIONS.map(|degrees| largest(conversion, degrees, sense)));
        table.add_row(row);
    }
    format!("{table}\n")
}

/// A row a conversion and deviation of the bearing of sustika2015.
fn radar() -> String {
    let mut table = super::table(&[
        "conversion",
        "σ_θ",
        "ρ",
        "bias (m)",
        "measured: along",
        "across",
        "true: along",
        "across",
    ]);
    for degrees in BEARING_DEVIATIONS {
        let rho = nonlinearity(&RANGE, &RANGE_DEVIATION, &variance_of(degrees));
        for conversion in Conversion::ALL {
            let found = at(conversion, rho, degrees);
            let mut row = vec![
                conversion.name().to_owned(),
                format!("{degrees}°"),
                format!("{rho:.3}"),
                // A zero has no sign here.
                format!("{:.2}", (100.0 * RANGE_DEVIATION * found.bias).round() / 100.0 + 0.0),
            ];
            row.extend(
                [found.as_measured, found.as_true]
                    .concat()
                    .iter()
                    .map(|ratio| format!("{ratio:.3}")),
            );
            table.add_row(row);
        }
    }
    format!("{table}\n")
}

/// What the numbers of the rule of thumb mean.
fn meaning() -> String {
    let small = at(Conversion::Standard, RULE, DEVIATIONS[0]);
    let degrees = RULE * 180.0 / f64::pi();
    // Far away, where the noise of the range no longer matters.
    let wide = at(Conversion::Standard, FARTHEST, degrees);
    let text = format!(
        "The rule of thumb for the standard conversion is ρ < {RULE} and σ_θ < {RULE} rad. At ρ = {RULE} its bias is {:.2} σ_r, and its \
         mean squared error {:.2} of what it claims along the measured line of sight; at σ_θ = {RULE} rad the error is {:.2} of the claim \
         across. Beyond the rule the standard conversion claims too little. The multiplicative one has no bias and the additive one \
         hardly any, and both claim too much on average; the modified unbiased one is right for a target of which nothing is known \
         before, and has twice the bias of the standard one given the truth.",
        small.bias, small.as_measured[0], wide.as_measured[1]
    );
    wrapped(&text, "")
}

// The figure

const PANEL_HEIGHT: u32 = 250;
/// The deviations of the columns, degrees.
const COLUMNS: [f64; 2] = [1.0, 20.0];
/// ρ to the right end of the panels.
const LAST: f64 = 1.6;
const POINTS: i32 = 120;

/// What a row of panels shows.
struct Row {
    title: &'static str,
    label: &'static str,
    lowest: f64,
    highest: f64,
    value: fn(&Validity<f64>) -> f64,
    /// What would be right, and within what.
    right: f64,
    within: f64,
}

const ROWS: [Row; 4] = [
    Row {
        title: "Bias along the line of sight",
        label: "bias (σ_r)",
        lowest: -1.7,
        highest: 0.3,
        value: |validity| validity.bias,
        right: 0.0,
        within: SMALL_BIAS,
    },
    Row {
        title: "Along the measured line",
        label: "error/claim",
        lowest: 0.0,
        highest: 3.1,
        value: |validity| validity.as_measured[0],
        right: 1.0,
        within: TOLERANCE,
    },
    Row {
        title: "Along the true line",
        label: "error/claim",
        lowest: 0.0,
        highest: 1.58,
        value: |validity| validity.as_true[0],
        right: 1.0,
        within: TOLERANCE,
    },
    Row {
        title: "Across the measured line",
        label: "error/claim",
        lowest: 0.0,
        highest: 1.58,
        value: |validity| validity.as_measured[1],
        right: 1.0,
        within: TOLERANCE,
    },
];

/// Bias, and mean squared error over claimed variance, of the four conversions over ρ; a column a deviation of the bearing.
///
/// # Errors
///
/// [`NotDrawn`] when the figure cannot be drawn.
pub fn figure() -> Result<String, NotDrawn> {
    let caption = Caption {
        name: "sustika2015-conversions".to_owned(),
        title: "Where a converted measurement can be trusted".to_owned(),
        note: "Error: mean squared error given the truth. Claim: mean of the variance in R. σ_θ = 0.1° and 4° look as 1° does. Lines begin \
               at r = 3 σ_r. Dotted: sustika2015 at 1.4 km, σ_θ = 1° and 4°."
            .to_owned(),
        says: table().replace(['\n', '─'], " ").split_whitespace().collect::<Vec<_>>().join(" "),
        has_cells: false,
    };
    let names = Conversion::ALL.map(|conversion| conversion.name().to_owned());
    let lines = names.into_iter().zip(looks(Conversion::ALL.len()));
    let mut legend: Vec<(String, Key)> = lines.map(|(name, look)| (name, Key::Line(look))).collect();
    legend.push(("right within 0.1 (bias 0.2)".to_owned(), Key::Area(SHADE, 1.0)));
    legend.push(("rule of thumb, ρ = 0.4".to_owned(), Key::Thin(INK, 7)));
    legend.push(("sustika2015".to_owned(), Key::Thin(MEASURED, 3)));
    let rows = u32::try_from(ROWS.len()).unwrap_or(1);
    whole(&caption, &legend, PANEL_HEIGHT * rows, |area| {
        let areas = area.split_evenly((ROWS.len(), COLUMNS.len()));
        let places = ROWS
            .iter()
            .flat_map(|row| COLUMNS.iter().map(move |column| (row, column)));
        areas
            .iter()
            .zip(places)
            .try_for_each(|(area, (row, degrees))| draw_panel(area, row, *degrees))
    })
}

fn draw_panel(area: &Area, row: &Row, degrees: f64) -> Drawn {
    let x = Axis::new(0.0..LAST, "ρ = r σ_θ²/σ_r", false);
    let mut y = Axis::new(row.lowest..row.highest, row.label, false);
    y.format = |value| format!("{:.1}", (10.0 * value).round() / 10.0 + 0.0);
    let mut chart = panel(area, &format!("{}, σ_θ = {degrees}°", row.title), [&x, &y], &[])?;
    let band = [(0.0, row.right - row.within), (LAST, row.right + row.within)];
    chart
        .draw_series([Rectangle::new(band, SHADE.filled())])
        .map_err(NotDrawn::because)?;
    let mut marks = vec![(RULE, INK, 7)];
    if degrees < BEARING_DEVIATIONS[1] {
        let of_radar = |degrees| nonlinearity(&RANGE, &RANGE_DEVIATION, &variance_of(degrees));
        marks.extend(BEARING_DEVIATIONS.map(|degrees| (of_radar(degrees), MEASURED, 3)));
    }
    for (rho, colour, dash) in marks {
        let ends = [(rho, row.lowest), (rho, row.highest)];
        let dashed = DashedLineSeries::new(ends, dash, dash, colour.stroke_width(2));
        chart.draw_series(dashed).map_err(NotDrawn::because)?;
    }
    // From three σ_r on: nearer, the range itself may be measured as negative.
    let first = 3.0 * variance_of(degrees);
    let line = |(conversion, look)| Line {
        look,
        points: (0..=POINTS)
            .map(|i| first + (LAST - first) * f64::from(i) / f64::from(POINTS))
            .map(|rho| (rho, (row.value)(&at(conversion, rho, degrees))))
            .filter(|(_, value)| (row.lowest..=row.highest).contains(value))
            .collect(),
        band: Vec::new(),
    };
    let lines = Conversion::ALL.into_iter().zip(looks(Conversion::ALL.len())).map(line);
    draw_lines(&mut chart, &lines.collect::<Vec<_>>())
}
