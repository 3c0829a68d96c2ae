//! A verdict as one page of HTML that needs no network and no script.
//!
//! It shows the verdict and how bad it is; the explanation; each faulty equation with the program's own numbers and its errors over the
//! steps; and what was judged and what was not.

use super::causes::causes;
use super::{InCase, Overall, coverage, farthest_mean, figures, is_wrong, of_the_whole, plot, severity};
use crate::book::reference::citations;
use crate::oracle::behaviour::{Behaviour, Grade};
use crate::oracle::check::{CaseReport, Report};
use crate::oracle::diagnose::Diagnosis;
use crate::paper::Paper;
use crate::paper::specification::PublishedEquation;
use crate::report::behaviour::{cell, open_questions};
use crate::report::chart::NotDrawn;
use crate::report::check::{reason, without_answer, words};
use crate::report::fault::{FaultyEquation, faulty_equations};
use crate::report::formula::in_numbers;
use crate::report::page::document;
use crate::report::page::figures::framed as drawing;
use crate::report::page::markup::formula;
use crate::report::page::table::framed;
use maud::{Markup, html};

/// The whole page.
///
/// # Errors
///
/// [`NotDrawn`] when a figure cannot be drawn.
pub fn html(report: &Report) -> Result<String, NotDrawn> {
    let faults = faulty_equations(report);
    let described = faults.iter().map(|fault| described(report, fault));
    let described = described.collect::<Result<Vec<Markup>, NotDrawn>>()?;
    let title = format!("{}: {}", Overall::of(report).words(), report.ready.name);
    let body = html! {
        a.skip href="#content" { "Skip to the content" }
        header {
            h1 { (mark(Overall::of(report))) " " (report.ready.name) }
            p.lead { "In " (figures(report)) "." }
            p.made { "Judged by immaculate " (env!("CARGO_PKG_VERSION")) }
        }
        main #content {
            (how_bad(report)?)
            @if report.diagnosis != Diagnosis::Nothing {
                section aria-labelledby="causes" { h2 #causes { "What explains it" } (causes(&report.diagnosis)) }
            }
            @if !described.is_empty() {
                section aria-labelledby="faults" {
                    h2 #faults { "Equations with a fault" }
                    @for fault in &described { (fault) }
                }
            }
            (behaviours(report))
            (judged(report))
            (cases(report))
        }
    };
    // What a program says may have characters that no document may.
    let is_forbidden = |c: char| c.is_control() && c != '\n';
    Ok(document(&title, &body).into_string().replace(is_forbidden, "\u{fffd}"))
}

/// The verdict: its words, which carry the meaning without their colour.
fn mark(verdict: Overall) -> Markup {
    let class = match verdict {
        Overall::Wrong => "fails",
        Overall::Right => "holds",
        Overall::OnWhatWasJudged | Overall::Otherwise | Overall::NothingJudged => "open",
    };
    html! { span class=(format!("verdict {class}")) { (verdict.words()) } }
}

/// The error of the filter's output, and what is wrong with the program as a whole.
fn how_bad(report: &Report) -> Result<Markup, NotDrawn> {
    let plot = match farthest_mean(report).filter(|_| Overall::of(report) == Overall::Wrong) {
        Some((case, value)) => plot::errors(case, value, "severity")?,
        None => None,
    };
    let without_answer = without_answer(report);
    Ok(html! {
        @if let Some(severity) = severity(report) { p.lead { (severity) } }
        @if let Some(plot) = plot { (drawing(&plot, "How far the combined estimate is from the certified one.")) }
        @for (heading, sentence) in of_the_whole(report) { p { b { (heading) ". " } (sentence) } }
        @for remark in &report.remarks { p { b { "Remark. " } (remark) } }
        @if !without_answer.is_empty() {
            p { "On the program’s own values these equations cannot be evaluated:" }
            ul { @for sentence in without_answer.iter().take(3) { li { (sentence) } } }
        }
    })
}

/// An equation with a fault: its formula, the first fault, the program's numbers in it, and errors over steps.
fn described(report: &Report, fault: &FaultyEquation) -> Result<Markup, NotDrawn> {
    let name = fault.quantity.name();
    let (case, value) = most_steps(fault);
    let plot = plot::errors(case, value, &format!("errors-{}", name.replace(['.', '_'], "-")))?;
    Ok(html! {
        article.claim {
            h3 { (if fault.is_otherwise { "Otherwise: " } else { "" }) code { (name) } }
            p.citation { (fault.equation()) }
            @if let Some(equation) = published(fault.equation()) { div.formula { (formula(&equation.latex)) } }
            p { (fault.sentence(report.ready.precision)) }
            @if let Some(explained) = &fault.first.explained {
                pre.in-numbers { @for line in in_numbers(explained) { (line) "\n" } }
            }
            @for sentence in fault.hidden().into_iter().chain(fault.others()) { p.note { (sentence) } }
            @if let Some(plot) = plot { (drawing(&plot, "Where this equation’s line is high, the error is made here; elsewhere it is inherited.")) }
        }
    })
}

/// The faulty value of an equation in the longest case: errors over steps are seen best there.
fn most_steps<'a>(fault: &FaultyEquation<'a>) -> InCase<'a> {
    let steps = |(case, _): &InCase| case.dimensions.steps();
    let first = (fault.case, fault.first);
    fault
        .values
        .iter()
        .copied()
        .fold(first, |a, b| if steps(&b) > steps(&a) { b } else { a })
}

/// The first equation of a paper that a text names; the others say the same in other letters.
fn published(names: &str) -> Option<&'static PublishedEquation> {
    let reference = citations(names).into_iter().next()?;
    let paper = Paper::ALL.into_iter().find(|paper| paper.key() == reference.paper)?;
    let mut equations = paper.specification().all_equations();
    equations.find(|equation| equation.label() == reference.label)
}

/// How the filter did in each situation.
fn behaviours(report: &Report) -> Markup {
    let grades = report.grades();
    let caption = "How the filter did in each situation, by the number of cases";
    let class = |grade: &Grade| match grade {
        Grade::Right(_) => Some("holds"),
        Grade::Wrong(..) => Some("fails"),
        _ => None,
    };
    html! {
        @if !grades.is_empty() {
            section aria-labelledby="behaviours" {
                h2 #behaviours { "Situations" }
                (framed(caption, &html! {
                    table {
                        caption { (caption) }
                        thead { tr { th scope="col" { "situation" } @for (family, _) in &grades { th scope="col" { (family) } } } }
                        tbody {
                            @for (index, behaviour) in Behaviour::ALL.into_iter().enumerate() {
                                tr {
                                    th scope="row" { (behaviour.name()) }
                                    @for (_, of_family) in &grades {
                                        td class=[class(&of_family[index].1)] { (cell(&of_family[index].1)) }
                                    }
                                }
                            }
                        }
                    }
                }))
                ul { @for sentence in open_questions(&grades) { li { (sentence) } } }
            }
        }
    }
}

/// What was judged and what was not.
fn judged(report: &Report) -> Markup {
    html! {
        section aria-labelledby="coverage" {
            h2 #coverage { "What was judged" }
            ul { @for sentence in coverage(report) { li { (sentence) } } }
        }
    }
}

/// All cases, those that are wrong first.
fn cases(report: &Report) -> Markup {
    let (wrong, others): (Vec<&CaseReport>, Vec<&CaseReport>) =
        report.cases.iter().partition(|case| is_wrong(report, case));
    let caption = "Every case: its verdict, how many values were judged, and to how many digits its right values agree";
    html! {
        section aria-labelledby="cases" {
            h2 #cases { "Cases" }
            details open[report.cases.len() <= 30] {
                summary {
                    (report.cases.len()) " cases, "
                    @match wrong.len() { 0 => "none of them wrong", many => { (many) " of them wrong" } }
                }
                (framed(caption, &html! {
                    table.numbers {
                        caption { (caption) }
                        thead { tr { th scope="col" { "case" } th scope="col" { "verdict" } th scope="col" { "judged" } th scope="col" { "digits" } } }
                        tbody { @for case in wrong.into_iter().chain(others) { (row(report, case)) } }
                    }
                }))
            }
        }
    }
}

fn row(report: &Report, case: &CaseReport) -> Markup {
    let class = is_wrong(report, case).then_some("fails");
    html! {
        tr {
            th scope="row" { (case.id) @if let Some(reason) = reason(case) { p.note { (reason) } } }
            td class=[class] { (words(&case.outcome)) }
            td { @if case.of > 0 { (case.judged) " of " (case.of) } }
            td { @if let Some(digits) = case.digits { (format!("{digits:.1}")) } }
        }
    }
}
