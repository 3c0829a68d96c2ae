//! What became of published figures, in a sentence.

use super::reproduction::SideBySide;
use super::wrapped;
use crate::paper::Paper;

/// What a reader takes for granted as chance: the published figure has a standard error of its own, about as large.
const CHANCE: f64 = 4.0;

/// How many of the figures are beyond chance, and of how many.
fn beyond_chance(comparisons: &[SideBySide]) -> [usize; 2] {
    let is_far = |of: &&SideBySide| of.difference_in_standard_errors.abs() > CHANCE;
    [comparisons.iter().filter(is_far).count(), comparisons.len()]
}

/// What became of some published figures, in a sentence.
pub fn outcome(comparisons: &[SideBySide]) -> String {
    let [far, all] = beyond_chance(comparisons);
    format!("{far} of {all} published figures are more than {CHANCE} standard errors from the computed ones.")
}

/// What the reader of several papers is about to see, before it begins: which papers' figures come out.
pub fn opening(published: &[(Paper, Vec<SideBySide>)]) -> String {
    let papers: Vec<String> = published
        .chunk_by(|a, b| a.0 == b.0)
        .filter_map(|of_paper| {
            let comparisons: Vec<SideBySide> = of_paper.iter().flat_map(|(_, of_one)| of_one.clone()).collect();
            let [far, all] = beyond_chance(&comparisons);
            (all > 0).then(|| format!("{} {far} of {all}", of_paper[0].0.key()))
        })
        .collect();
    if papers.is_empty() {
        return String::new();
    }
    let all: Vec<SideBySide> = published.iter().flat_map(|(_, of_one)| of_one.clone()).collect();
    let [far, count] = beyond_chance(&all);
    let does = if 2 * far > count {
        "Most published figures do not come out"
    } else {
        "Most published figures come out"
    };
    wrapped(
        &format!(
            "{does}: {far} of {count} are more than {CHANCE} standard errors from the computed ones ({}). The differences of the columns, on the same truth \
             and noise, are below each table.",
            papers.join(", ")
        ),
        "",
    ) + "\n"
}
