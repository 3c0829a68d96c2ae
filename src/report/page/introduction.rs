//! What a stranger reads first.
//!
//! After this file the reader knows the page's first screen: what Immaculate is for, what it holds, and what became of the claims.

use super::content::{Content, OfPaper};
use super::ledger::count;
use super::table::framed;
use crate::oracle::case;
use crate::oracle::variant::{Kind, catalogue};
use crate::paper::Paper;
use crate::paper::specification::PublishedEquation;
use crate::paper::verdict::Verdict;
use maud::{Markup, html};

/// The page's first section.
pub fn section(content: &Content) -> Markup {
    html! {
        section aria-labelledby="introduction" {
            h2 #introduction { "In five minutes" }
            (purpose())
            (holdings())
            (outcome(content))
            (next_steps())
        }
    }
}

fn purpose() -> Markup {
    html! {
        p {
            "A tracking filter for a target that flies straight and turns runs several Kalman filters side by side and mixes them: the "
            i { "interacting multiple model" } " filter, IMM. Many programs have one. Few can say whether theirs is right, and none which "
            "equation is wrong if it is not."
        }
        p {
            "Immaculate is the specification of this filter that can be run. Every equation of four papers is one plain function under its "
            "printed number. The same function is evaluated on doubles, on exact fractions, on symbols and on enclosures of any precision, "
            "so that what it says is proven and not only tried."
        }
    }
}

/// What there is, counted.
fn holdings() -> Markup {
    let equations: Vec<&PublishedEquation> = Paper::ALL
        .into_iter()
        .flat_map(|paper| paper.specification().all_equations())
        .collect();
    let errata = equations.iter().filter(|equation| equation.erratum.is_some()).count();
    let of_kind = |kind: Kind| catalogue().iter().filter(|variant| variant.kind == kind).count();
    let claims: usize = Paper::ALL.iter().map(|paper| paper.specification().claims.len()).sum();
    let cases = case::all().map_or(0, <[case::Case]>::len);
    let holdings = [
        (
            equations.len(),
            "equations",
            "each with its code, derivation and evidence",
        ),
        (
            errata,
            "errata",
            "of the papers, the printed form beside the corrected one",
        ),
        (claims, "claims", "of the papers, each judged by a computation"),
        (
            cases,
            "cases",
            "whose every number is the double nearest to the exact value",
        ),
        (of_kind(Kind::Mistake), "mistakes", "that a check of a filter can name"),
    ];
    html! {
        ul.holdings {
            @for (count, what, how) in holdings { li { b { (count) } " " (what) span { (how) } } }
        }
    }
}

/// What became of each paper's claims.
fn outcome(content: &Content) -> Markup {
    let caption = "What became of the papers’ claims";
    let all = |verdict: Verdict| -> usize { content.papers.iter().map(|p| count(&p.judgements, verdict)).sum() };
    framed(
        caption,
        &html! {
            table.numbers {
                caption { (caption) }
                thead {
                    tr {
                        th scope="col" { "paper" }
                        @for verdict in Verdict::ALL { th scope="col" { (verdict.words()) } }
                    }
                }
                tbody {
                    @for of_paper in &content.papers { (row(of_paper)) }
                    tr.total {
                        th scope="row" { "all" }
                        @for verdict in Verdict::ALL { td { (all(verdict)) } }
                    }
                }
            }
        },
    )
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

fn next_steps() -> Markup {
    html! {
        h3 { "Where to go from here" }
        dl {
            dt { "To know whether your own filter is right" }
            dd {
                "let it answer the cases: " code { "immaculate check -- COMMAND" } " judges a program in any language, says in which "
                "equation it is wrong, and names the mistake where the catalogue has it."
            }
            dt { "To see what became of a paper" }
            dd { "read on: figures, tables, claims and errata of each follow." }
            dt { "To learn an equation" }
            dd {
                "look it up in the " a href="#book" { "book of equations" } " at the end of this page, or with "
                code { "immaculate equation zhu2016 56" } "."
            }
            dt { "To have all of this computed again" }
            dd { code { "cargo run --release -- report --out report.html" } ", and " code { "cargo test" } " for the proofs." }
        }
    }
}
