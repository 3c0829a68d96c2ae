//! The ledger of a paper's claims.
//!
//! A judged claim shows the verdict, the paper's words, the question, the answer, its evidence, and how it was judged.

use super::content::OfPaper;
use crate::paper::verdict::{JudgedClaim, Verdict};
use maud::{Markup, html};

/// The claims of a paper, in its order.
pub fn section(of_paper: &OfPaper) -> Markup {
    let key = of_paper.paper.key();
    let judged_by = |judgement: &JudgedClaim| {
        let claims = &of_paper.paper.specification().claims;
        let claim = claims.iter().find(|claim| claim.id == judgement.id);
        claim.map_or("", |claim| claim.judged_by.as_str())
    };
    html! {
        section aria-labelledby=(format!("{key}-claims")) {
            h2 id=(format!("{key}-claims")) { "What " (key) " claims" }
            p {
                (counts(&of_paper.judgements)) ". Each verdict is computed; the evidence says from what. " a href="#claims" { "What the verdicts mean" } "."
            }
            @for judgement in &of_paper.judgements {
                article.claim id={ "claim-" (judgement.id) } {
                    h3 { (mark(judgement.verdict)) " " span.id { (judgement.id) } }
                    blockquote { p { (judgement.quote) } footer { (judgement.place) } }
                    p { b { "Question. " } (judgement.question) }
                    p { b { "Answer. " } (judgement.answer()) }
                    p { b { "Evidence. " } (judgement.evidence) }
                    p.judged { b { "Judged by. " } (judged_by(judgement)) }
                }
            }
        }
    }
}

/// A verdict: its word, which carries the meaning without its colour.
pub fn mark(verdict: Verdict) -> Markup {
    let class = match verdict {
        Verdict::Proven | Verdict::Confirmed => "holds",
        Verdict::Refuted => "fails",
        Verdict::Undecided | Verdict::DependsOnChoice | Verdict::NotReached | Verdict::NeverPublished => "open",
    };
    html! { span class=(format!("verdict {class}")) { (verdict.words()) } }
}

/// How many claims have a verdict.
pub fn count(judgements: &[JudgedClaim], verdict: Verdict) -> usize {
    judgements
        .iter()
        .filter(|judgement| judgement.verdict == verdict)
        .count()
}

/// How often each verdict was given, in a sentence.
fn counts(judgements: &[JudgedClaim]) -> String {
    let given = Verdict::ALL
        .into_iter()
        .map(|verdict| (count(judgements, verdict), verdict));
    let words: Vec<String> = given
        .filter(|(count, _)| *count > 0)
        .map(|(count, verdict)| format!("{count} {}", verdict.words()))
        .collect();
    format!("{} claims: {}", judgements.len(), words.join(", "))
}
