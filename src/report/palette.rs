//! The colours of all figures, in one place, so that a page can replace them on a dark background.
//!
//! People who see colours differently can still distinguish the filters (Okabe and Ito 2008; the fifth is their sky blue, darkened). Each
//! colour has a contrast of at least three to one on white and on #14171a. Lighter shades are the same colour with an opacity.

use plotters::style::RGBColor;

/// Text, axes, the truth.
pub const INK: RGBColor = RGBColor(0, 0, 0);
/// The ground.
pub const PAPER: RGBColor = RGBColor(255, 255, 255);
/// Lines of a grid.
pub const GRID: RGBColor = RGBColor(208, 208, 208);
/// What a panel is about: turns, the true mode, the band within which something is right.
pub const SHADE: RGBColor = RGBColor(228, 228, 228);
/// What was measured, and what there is no answer for.
pub const MEASURED: RGBColor = RGBColor(138, 138, 138);
/// One colour a filter: blue, vermillion, green, purple, sky blue.
pub const FILTERS: [RGBColor; 5] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(58, 154, 217),
];

/// All of them, with the names by which a page may speak of them.
pub const ALL: [(&str, RGBColor); 10] = [
    ("ink", INK),
    ("paper", PAPER),
    ("grid", GRID),
    ("shade", SHADE),
    ("measured", MEASURED),
    ("filter-1", FILTERS[0]),
    ("filter-2", FILTERS[1]),
    ("filter-3", FILTERS[2]),
    ("filter-4", FILTERS[3]),
    ("filter-5", FILTERS[4]),
];

/// A colour as it stands in the SVG: `#0072B2`.
pub fn hexadecimal(colour: RGBColor) -> String {
    format!("#{:02X}{:02X}{:02X}", colour.0, colour.1, colour.2)
}
