//! A verdict as a badge: a small picture with the name of this program and the verdict in a few words.
//!
//! The colour says no more than the words. The badge needs no network and no fonts.

use super::Overall;
use crate::oracle::check::{Outcome, Report};

/// The width of a letter, pixels: no sans serif of this size is much wider on average; the words are stretched to the room they have.
const LETTER: usize = 7;
/// Beside the words, pixels.
const MARGIN: usize = 6;

/// The report as an SVG picture.
pub fn badge(report: &Report) -> String {
    let (words, colour) = words_and_colour(report);
    let name = "immaculate";
    let [left, right] = [name, words.as_str()].map(|text| LETTER * text.chars().count());
    let (middle, width) = (left + 2 * MARGIN, left + right + 4 * MARGIN);
    let text = |x: usize, length: usize, words: &str| {
        format!("<text x=\"{x}\" y=\"14\" textLength=\"{length}\" lengthAdjust=\"spacingAndGlyphs\">{words}</text>")
    };
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"20\" viewBox=\"0 0 {width} 20\" role=\"img\" \
         aria-label=\"{name}: {words}\">\n\
         <title>{name}: {words}</title>\n\
         <clipPath id=\"round\"><rect width=\"{width}\" height=\"20\" rx=\"3\"/></clipPath>\n\
         <g clip-path=\"url(#round)\">\n\
         <rect width=\"{middle}\" height=\"20\" fill=\"#3a424a\"/>\n\
         <rect x=\"{middle}\" width=\"{}\" height=\"20\" fill=\"{colour}\"/>\n\
         </g>\n\
         <g fill=\"#ffffff\" font-family=\"Verdana,DejaVu Sans,Geneva,sans-serif\" font-size=\"11\">\n{}\n{}\n</g>\n\
         </svg>\n",
        width - middle,
        text(MARGIN, left, name),
        text(middle + MARGIN, right, &words),
    )
}

/// The words, and a colour on which white letters have a contrast of 4.5 to one at least.
fn words_and_colour(report: &Report) -> (String, &'static str) {
    let (wrong, all) = (super::count(report, Outcome::is_wrong), report.cases.len());
    let verdict = Overall::of(report);
    match verdict {
        // The program as a whole may be wrong where no case is.
        Overall::Wrong if wrong > 0 => (format!("{} {wrong} of {all}", verdict.words()), "#a8321a"),
        Overall::Wrong => (verdict.words().to_owned(), "#a8321a"),
        Overall::Right => (verdict.words().to_owned(), "#1a6b3a"),
        Overall::OnWhatWasJudged | Overall::Otherwise => (verdict.words().to_owned(), "#33691e"),
        Overall::NothingJudged => (verdict.words().to_owned(), "#57606a"),
    }
}
