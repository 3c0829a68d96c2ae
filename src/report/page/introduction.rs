//! The front page: what the project is, in a minute, and where everything else is.

use super::content::{Content, OfPaper};
use super::ledger::{count, mark};
use super::markdown;
use super::table::framed;
use crate::oracle::case;
use crate::oracle::variant::{Kind, catalogue};
use crate::paper::Paper;
use crate::paper::specification::PublishedEquation;
use crate::paper::verdict::Verdict;
use maud::{Markup, html};

const README: &str = include_str!("../../../README.md");

/// The first questions of a newcomer, and where the answers are.
const QUESTIONS: [(&str, &str, &str); 10] = [
    (
        "Is my filter right?",
        "#check-your-filter",
        "check your filter, in ten lines of your language",
    ),
    (
        "How does a verdict find the wrong equation?",
        "checking.html#from-a-wrong-number-to-its-cause",
        "from a wrong number to its cause",
    ),
    (
        "Which filters, models and sensors can be checked?",
        "#what-is-checked",
        "what is checked, and what is not",
    ),
    (
        "Does it work on my own models and data?",
        "#your-own-models-and-data",
        "your own models and data",
    ),
    (
        "My filter does it in another way. Is that wrong?",
        "formats.html#conventions",
        "conventions, and how to declare them",
    ),
    (
        "Which mistakes does it know?",
        "mistakes.html",
        "the catalogue, by equation",
    ),
    (
        "What is in the published cases?",
        "cases.html",
        "the cases, by situation",
    ),
    (
        "Why should I believe the numbers?",
        "guarantees.html",
        "what is guaranteed, and by which evidence",
    ),
    (
        "What does equation (56) say, and why?",
        "book.html",
        "the index of equations",
    ),
    ("What is wrong in the papers?", "findings.html", "the findings"),
];

/// The page.
pub fn page(content: &Content) -> Markup {
    html! {
        (markdown::sections(README, &[""]))
        (holdings())
        h2 #questions { "Ten questions" }
        dl.questions { @for (question, link, answer) in QUESTIONS { div { dt { (question) } dd { a href=(link) { (answer) } } } } }
        (markdown::sections(README, &["What it found in public filters", "What is checked", "Check your filter", "Your own models and data", "The papers"]))
        (outcome(content))
    }
}

/// The contents, counted.
fn holdings() -> Markup {
    let equations: Vec<&PublishedEquation> = Paper::ALL
        .into_iter()
        .flat_map(|paper| paper.specification().all_equations())
        .collect();
    let errata = equations.iter().filter(|equation| equation.erratum.is_some()).count();
    let mistakes = catalogue()
        .iter()
        .filter(|variant| variant.kind == Kind::Mistake)
        .count();
    let claims: usize = Paper::ALL.iter().map(|paper| paper.specification().claims.len()).sum();
    let cases = case::all().map_or(0, <[case::Case]>::len);
    let holdings = [
        (
            cases,
            "cases",
            "cases.html",
            "in which every number is the double nearest to the exact value",
        ),
        (mistakes, "mistakes", "mistakes.html", "that a verdict can name"),
        (
            equations.len(),
            "equations",
            "book.html",
            "each with code, derivation and evidence",
        ),
        (
            errata,
            "errata",
            "findings.html",
            "the printed form beside the corrected one",
        ),
        (claims, "claims", "#claims", "of the papers, each judged by computation"),
    ];
    html! {
        ul.holdings {
            @for (count, what, link, how) in holdings { li { b { (count) } " " a href=(link) { (what) } span { (how) } } }
        }
    }
}

/// What became of each paper's claims.
fn outcome(content: &Content) -> Markup {
    let caption = "What became of the papers’ claims";
    let all = |verdict: Verdict| -> usize { content.papers.iter().map(|p| count(&p.judgements, verdict)).sum() };
    html! {
        h3 #claims { "Their claims" }
        dl.legend { @for verdict in Verdict::ALL { div { dt { (mark(verdict)) } dd { (verdict.meaning()) } } } }
        (framed(
            caption,
            &html! {
                table.numbers {
                    caption { (caption) }
                    thead { tr { th scope="col" { "paper" } @for verdict in Verdict::ALL { th scope="col" { (verdict.words()) } } } }
                    tbody {
                        @for of_paper in &content.papers { (row(of_paper)) }
                        tr.total { th scope="row" { "all" } @for verdict in Verdict::ALL { td { (all(verdict)) } } }
                    }
                }
            },
        ))
    }
}

fn row(of_paper: &OfPaper) -> Markup {
    let key = of_paper.paper.key();
    html! {
        tr {
            th scope="row" { a href=(format!("#{key}-claims")) { (key) } }
            @for verdict in Verdict::ALL { td { (count(&of_paper.judgements, verdict)) } }
        }
    }
}
