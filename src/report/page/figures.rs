//! The figures of a paper on its page, with their captions.
//!
//! A drawing is the same as in a file; the page's style sets its colours on a dark screen.

use super::content::{Content, OfPaper, OfRuns};
use super::table::table;
use crate::paper::Paper;
use crate::paper::result::Reproduction;
use crate::paper::sustika2015::divergence::DivergenceRow;
use crate::paper::sustika2015::sweep::SweptTrajectory;
use crate::report::chart::NotDrawn;
use crate::report::{
    conversion, divergence, figure, fit_error, long_term, path, published, reproduction, stability_map,
};
use maud::{Markup, PreEscaped, html};

/// A drawing with its caption.
pub fn framed(svg: &str, caption: &str) -> Markup {
    html! {
        figure {
            div.drawing { (PreEscaped(svg)) }
            figcaption { (caption) }
        }
    }
}

/// Every published figure beside the computed one, where runs reproduce any.
///
/// # Errors
///
/// [`NotDrawn`] when it cannot be drawn.
pub fn published_and_computed(of_paper: &OfPaper) -> Result<Option<Markup>, NotDrawn> {
    let mains = of_paper
        .simulations
        .iter()
        .filter_map(|reproductions| reproductions.first());
    let comparisons: Vec<_> = mains
        .flat_map(|main| reproduction::published_and_computed(of_paper.paper, main))
        .collect();
    let Some(drawn) = published::published_and_computed(of_paper.paper, &comparisons) else {
        return Ok(None);
    };
    let caption = "The published figures, and what the paper’s own equations give with its own parameters.";
    Ok(Some(framed(&drawn?, caption)))
}

/// The figures of a simulation.
///
/// # Errors
///
/// [`NotDrawn`] when one cannot be drawn.
pub fn of_simulation(reproduction: &Reproduction) -> Result<Vec<Markup>, NotDrawn> {
    let mut figures = Vec::new();
    if let Some(first_run) = &reproduction.first_run {
        figures.push(framed(
            &path::path(reproduction, first_run)?,
            "The first run: where the target was, where it was measured, and where the filters thought it was.",
        ));
    }
    figures.push(framed(
        &figure::errors(reproduction)?,
        "Root mean square errors over time. Coinciding lines are drawn on top of each other, each thinner than the one below it.",
    ));
    figures.push(framed(
        &figure::mode_probabilities(reproduction)?,
        "Mean mode probabilities over time. A good filter follows the shading.",
    ));
    Ok(figures)
}

/// The figures of a paper that are of no single simulation.
///
/// # Errors
///
/// [`NotDrawn`] when one cannot be drawn.
pub fn of_paper(paper: Paper, content: &Content) -> Result<Vec<Markup>, NotDrawn> {
    match paper {
        Paper::Derbez2000 => of_derbez2000(content),
        Paper::Sustika2015 => of_sustika2015(content),
        Paper::Zhu2016 | Paper::Liu2017 => Ok(Vec::new()),
    }
}

fn of_derbez2000(content: &Content) -> Result<Vec<Markup>, NotDrawn> {
    let [stable, unstable, undecided] = content.map.counts();
    Ok(vec![
        html! { h3 #derbez2000-figures-long-term { "The predicted error beside the simulated one" } },
        framed(
            &long_term::figures_1_and_2(content.extent.effort.seed)?,
            "Figures 1 and 2 of the paper: by how many per cent the predicted long-term error is off. White is right.",
        ),
        html! { h3 #derbez2000-figures-stability { "Which fixed-gain filters are stable together" } },
        framed(
            &stability_map::draw(&content.map)?,
            &format!(
                "{stable} pairs of noises certified stable, {unstable} certified unstable, {undecided} undecided; each verdict is a \
                 quadratic form or a growing product that is checked in exact arithmetic."
            ),
        ),
    ])
}

fn of_sustika2015(content: &Content) -> Result<Vec<Markup>, NotDrawn> {
    let mut figures = vec![
        html! { h3 #sustika2015-figures-sweep { "Scenario 3: the fit error over the noises that the filters assume" } },
    ];
    for (trajectory, number) in SweptTrajectory::ALL.into_iter().zip([2, 4]) {
        figures.push(framed(
            &fit_error::draw(&content.sweep.results, trajectory, content.sweep.runs)?,
            &format!("Figure {number} of the paper: the percentage fit error over the filters’ noises."),
        ));
    }
    figures.push(html! { h3 #sustika2015-figures-divergence { "What makes the unscented filter diverge" } });
    figures.push(divergences(&content.divergence));
    figures.push(html! { h3 #sustika2015-figures-conversions { "Where converted measurements can be trusted" } });
    figures.push(framed(
        &conversion::figure()?,
        "The bias and the spread of the four conversions over the standard deviation of the bearing.",
    ));
    Ok(figures)
}

fn divergences(rows: &OfRuns<Vec<DivergenceRow>>) -> Markup {
    html! {
        (table(&divergence::legend(rows.runs), &divergence::HEADER, &divergence::cells(&rows.results)))
        p { (divergence::cause(&rows.results, rows.runs)) }
    }
}
