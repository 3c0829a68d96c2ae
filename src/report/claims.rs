//! The ledger of claims as text.
//!
//! [`crate::paper::verdict`] defines the verdicts.

use super::{citation, wrapped};
use crate::paper::specification::Specification;
use crate::paper::verdict::{JudgedClaim, Verdict};
use serde_json::Value;
use std::fmt::Write;

/// One paragraph a claim: verdict, name, the paper's words, the question, the answer and the evidence.
pub fn text(judgements: &[JudgedClaim]) -> String {
    let mut text = String::new();
    for judgement in judgements {
        let _ = writeln!(
            text,
            "{:<19} {}",
            judgement.verdict.words().to_uppercase(),
            judgement.id
        );
        let quote = format!("“{}” ({})", judgement.quote, judgement.place);
        for paragraph in [&quote, &judgement.question, &judgement.answer(), &judgement.evidence] {
            text.push_str(&wrapped(paragraph, "    "));
        }
        text.push('\n');
    }
    text
}

/// How often each verdict was given, in one line.
pub fn summary(judgements: &[JudgedClaim]) -> String {
    let counts: Vec<String> = Verdict::ALL
        .into_iter()
        .map(|verdict| (verdict, judgements.iter().filter(|j| j.verdict == verdict).count()))
        .filter(|(_, count)| *count > 0)
        .map(|(verdict, count)| format!("{count} {}", verdict.words()))
        .collect();
    format!("{} claims: {}\n\n", judgements.len(), counts.join(", "))
}

/// What each verdict means.
pub fn legend() -> String {
    let line = |verdict: Verdict| format!("  {:<19} {}\n", verdict.words().to_uppercase(), verdict.meaning());
    Verdict::ALL.map(line).concat() + "\n"
}

/// The same as JSON.
pub fn legend_json() -> Value {
    let meaning = |verdict: Verdict| (verdict.name(), Value::from(verdict.meaning()));
    Verdict::ALL.into_iter().map(meaning).collect()
}

/// The paper whose claims follow.
pub fn heading(specification: &Specification) -> String {
    format!("{}\n", citation(&specification.paper))
}
