//! How a claim is judged.
//!
//! After this file the reader knows the verdicts and what each of them takes. A judge computes; nothing is declared.

use super::specification::{Claim, Specification};
use crate::statistics::Estimate;
use serde::Serialize;

/// What became of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// True, by exact arithmetic.
    Proven,
    /// True in this scenario, statistically.
    Confirmed,
    /// False: by a counterexample, by arithmetic, or statistically.
    Refuted,
    /// The runs decide neither way.
    Undecided,
    /// Cannot be decided from what was published.
    NotReproducible,
}

impl Verdict {
    /// The verdict in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Proven => "proven",
            Self::Confirmed => "confirmed",
            Self::Refuted => "refuted",
            Self::Undecided => "undecided",
            Self::NotReproducible => "not reproducible",
        }
    }
}

/// A claim, its verdict and the evidence.
#[derive(Debug, Clone, Serialize)]
pub struct Judgement {
    /// The claim's name.
    pub id: String,
    /// The paper's words.
    pub quote: String,
    /// Where they stand.
    pub place: String,
    /// What was asked.
    pub question: String,
    /// The answer.
    pub verdict: Verdict,
    /// What it rests on, with the figures.
    pub evidence: String,
}

/// How many standard errors a difference must have to count: 4, a false alarm in 16 000 for a Gaussian figure, so that among some
/// dozens of comparisons not one is expected.
pub const DECISIVE: f64 = 4.0;

/// Whether a difference is below zero, above it, or neither with certainty.
pub fn sign_of(difference: Estimate) -> Option<std::cmp::Ordering> {
    let distance = difference.distance_from(0.0);
    if distance <= -DECISIVE {
        Some(std::cmp::Ordering::Less)
    } else if distance >= DECISIVE {
        Some(std::cmp::Ordering::Greater)
    } else {
        None
    }
}

impl Specification {
    /// A judgement on the claim with this name.
    ///
    /// # Panics
    ///
    /// When the specification has no such claim: judges and claims are both part of the program, and a test holds them together.
    pub fn judgement(&self, id: &str, verdict: Verdict, evidence: String) -> Judgement {
        let claim: &Claim = self
            .claims
            .iter()
            .find(|claim| claim.id == id)
            .expect("every judge has a claim");
        Judgement {
            id: claim.id.clone(),
            quote: claim.quote.clone(),
            place: claim.place.clone(),
            question: claim.question.clone(),
            verdict,
            evidence,
        }
    }
}
