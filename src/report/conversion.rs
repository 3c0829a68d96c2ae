//! Where a converted measurement can be trusted: a rule as a table, and its reason as a picture.
//!
//! After this file the reader knows up to which nonlinearity ρ = r σ_θ²/σ_r each conversion's covariance is right, what the 0.4 of the
//! textbook means, and on which side of it the radar of sustika2015 is. The numbers are the closed forms of
//! [`conversion_validity`](crate::model::conversion_validity).

use super::figure::{NotDrawn, not_drawn};
use super::wrapped;
use crate::model::Conversion;
use crate::model::conversion_moments::attenuation;
use crate::model::conversion_validity::{Validity, nonlinearity, validity};
use crate::number::Real;
use plotters::coord::Shift;
use plotters::prelude::*;

/// The deviations of the bearing that are shown, degrees.
const DEVIATIONS: [f64; 4] = [0.1, 1.0, 4.0, 20.0];
/// How far error and claim may be apart.
const TOLERANCE: f64 = 0.1;
/// How large a bias may be, in σ_r: that of the plain conversion at the rule of thumb.
const SMALL_BIAS: f64 = RULE / 2.0;
/// The rule of thumb: Bar-Shalom, Li and Kirubarajan 2001, section 10.4.3.
const RULE: f64 = 0.4;
/// Nearer than so many σ_r, the noise of the range is no longer small against it, and nothing is judged.
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

/// One colour a conversion, told apart by people who see colours differently (Okabe and Ito 2008), and the width of its line, thinner
/// over the one before.
const STYLES: [(RGBColor, u32); 4] = [
    (RGBColor(0, 0, 0), 5),
    (RGBColor(230, 159, 0), 5),
    (RGBColor(0, 114, 178), 2),
    (RGBColor(0, 158, 115), 2),
];
/// The band within which error and claim agree.
const BAND: RGBColor = RGBColor(232, 232, 232);
/// Marks of the rule of thumb and of sustika2015.
const MARK: RGBColor = RGBColor(213, 94, 0);
const WIDTH: u32 = 1000;
const LEGEND_WIDTH: u32 = 170;
const PANEL_HEIGHT: u32 = 260;
/// The deviations of the columns, degrees.
const COLUMNS: [f64; 2] = [1.0, 20.0];
/// ρ to the right end of the panels.
const LAST: f64 = 1.6;
const POINTS: i32 = 320;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

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
        title: "Along the measured line of sight",
        label: "error/claim",
        lowest: 0.0,
        highest: 3.0,
        value: |validity| validity.as_measured[0],
        right: 1.0,
        within: TOLERANCE,
    },
    Row {
        title: "Along the true line of sight",
        label: "error/claim",
        lowest: 0.0,
        highest: 1.5,
        value: |validity| validity.as_true[0],
        right: 1.0,
        within: TOLERANCE,
    },
    Row {
        title: "Across the measured line of sight",
        label: "error/claim",
        lowest: 0.0,
        highest: 1.5,
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
    let mut svg = String::new();
    {
        let rows = u32::try_from(ROWS.len()).unwrap_or(1);
        let root = SVGBackend::with_string(&mut svg, (WIDTH, PANEL_HEIGHT * rows)).into_drawing_area();
        root.fill(&WHITE).map_err(not_drawn)?;
        let (panels, legend) = root.split_horizontally(WIDTH - LEGEND_WIDTH);
        let areas = panels.split_evenly((ROWS.len(), COLUMNS.len()));
        let places = ROWS
            .iter()
            .flat_map(|row| COLUMNS.iter().map(move |column| (row, column)));
        for (area, (row, degrees)) in areas.iter().zip(places) {
            draw_panel(area, row, *degrees)?;
        }
        draw_legend(&legend)?;
        root.present().map_err(not_drawn)?;
    }
    Ok(svg)
}

fn draw_panel(area: &Area, row: &Row, degrees: f64) -> Result<(), NotDrawn> {
    let mut chart = ChartBuilder::on(area)
        .caption(format!("{}, σ_θ = {degrees}°", row.title), ("sans-serif", 15))
        .margin(8)
        .margin_right(16)
        .x_label_area_size(35)
        .y_label_area_size(50)
        .build_cartesian_2d(0.0..LAST, row.lowest..row.highest)
        .map_err(not_drawn)?;
    let band = [(0.0, row.right - row.within), (LAST, row.right + row.within)];
    let band = Rectangle::new(band, BAND.filled());
    chart.draw_series([band]).map_err(not_drawn)?;
    chart
        .configure_mesh()
        .disable_mesh()
        .x_desc("ρ = r σ_θ²/σ_r")
        .y_desc(row.label)
        .x_label_formatter(&|rho| format!("{rho:.1}"))
        .y_label_formatter(&|value| format!("{:.1}", (10.0 * value).round() / 10.0 + 0.0))
        .draw()
        .map_err(not_drawn)?;
    let mut marks = vec![RULE];
    if degrees < BEARING_DEVIATIONS[1] {
        marks.extend(BEARING_DEVIATIONS.map(|degrees| nonlinearity(&RANGE, &RANGE_DEVIATION, &variance_of(degrees))));
    }
    for (index, rho) in marks.into_iter().enumerate() {
        let ends = [(rho, row.lowest), (rho, row.highest)];
        let style = MARK.stroke_width(1);
        if index == 0 {
            let dashed = DashedLineSeries::new(ends, 6, 4, style);
            chart.draw_series(dashed).map_err(not_drawn)?;
        } else {
            let dotted = DashedLineSeries::new(ends, 2, 4, style);
            chart.draw_series(dotted).map_err(not_drawn)?;
        }
    }
    // From three σ_r on: nearer, the range itself may be measured as negative.
    let first = 3.0 * variance_of(degrees);
    for (conversion, (colour, width)) in Conversion::ALL.into_iter().zip(STYLES) {
        let points = (0..=POINTS)
            .map(|i| first + (LAST - first) * f64::from(i) / f64::from(POINTS))
            .map(|rho| (rho, (row.value)(&at(conversion, rho, degrees))))
            .filter(|(_, value)| (row.lowest..=row.highest).contains(value));
        let line = LineSeries::new(points, colour.stroke_width(width));
        chart.draw_series(line).map_err(not_drawn)?;
    }
    Ok(())
}

fn draw_legend(legend: &Area) -> Result<(), NotDrawn> {
    let text = |words: &str, y: i32| Text::new(words.to_owned(), (30, y - 6), ("sans-serif", 13));
    let mut y = 45;
    for (conversion, (colour, width)) in Conversion::ALL.into_iter().zip(STYLES) {
        let line = PathElement::new(vec![(2, y), (24, y)], colour.stroke_width(width));
        legend.draw(&line).map_err(not_drawn)?;
        legend.draw(&text(conversion.name(), y)).map_err(not_drawn)?;
        y += 20;
    }
    y += 10;
    let band = Rectangle::new([(2, y - 6), (24, y + 6)], BAND.filled());
    legend.draw(&band).map_err(not_drawn)?;
    legend
        .draw(&text("right within 0.1 (bias 0.2)", y))
        .map_err(not_drawn)?;
    for (dashes, words) in [
        (vec![(2, 8), (12, 18), (22, 24)], &["rule of thumb, ρ = 0.4"][..]),
        (
            vec![(2, 4), (8, 10), (14, 16), (20, 22)],
            &["sustika2015 at 1.4 km,", "σ_θ = 1° and 4°"],
        ),
    ] {
        y += 20;
        for (from, to) in dashes {
            let dash = PathElement::new(vec![(from, y), (to, y)], MARK.stroke_width(1));
            legend.draw(&dash).map_err(not_drawn)?;
        }
        for (line, words) in (0..).zip(words) {
            legend.draw(&text(words, y + 16 * line)).map_err(not_drawn)?;
        }
    }
    y += 46;
    for words in [
        "error: mean squared error",
        "given the truth",
        "claim: mean of the variance",
        "in R",
        "",
        "σ_θ = 0.1° and 4° look",
        "as 1° does",
        "",
        "lines begin at r = 3 σ_r",
    ] {
        let words = Text::new(words, (2, y - 6), ("sans-serif", 12));
        legend.draw(&words).map_err(not_drawn)?;
        y += 16;
    }
    Ok(())
}
