//! The joint stability of the fixed-gain filters of a problem file, for people and programs.
//!
//! `immaculate stability --problem` prints each filter by itself, then all together with the proof.

use super::stability::{Between, between, verdict_word};
use super::stability_proof::{Proof, word};
use super::{table, wrapped};
use crate::steady::closed_loops::{Bounds, ClosedLoops, Depth, StabilityVerdict};
use nalgebra::Dyn;
use serde_json::{Value, json};
use std::fmt::Write;

/// The filters of a problem.
#[derive(Debug, Clone)]
pub struct Bank {
    /// What the file says of itself.
    pub about: String,
    /// The modes.
    pub names: Vec<String>,
    /// Whether filters start from mixed estimates.
    pub is_mixed: bool,
    /// Their matrices.
    pub loops: ClosedLoops<Dyn>,
}

/// What is known of them.
#[derive(Debug, Clone)]
pub struct BankAnswer {
    bank: Bank,
    depth: Depth,
    /// Letters of words: the numbers of the modes, from 0 as in `modes[0]`.
    letters: Vec<String>,
    radii: Vec<Between>,
    /// Whether each filter by itself is stable; none where that is undecided.
    alone: Option<bool>,
    together: Option<(StabilityVerdict<Dyn>, Bounds<Dyn>)>,
}

impl BankAnswer {
    /// Decides.
    pub fn new(bank: Bank, depth: Depth) -> Self {
        let count = bank.names.len();
        let one = crate::number::Rational::new(1, 1);
        let alone: Vec<Option<bool>> = (0..count).map(|j| bank.loops.is_radius_below(&[j], &one)).collect();
        let alone = if alone.contains(&Some(false)) {
            Some(false)
        } else {
            alone.into_iter().collect::<Option<Vec<_>>>().map(|_| true)
        };
        let together = (bank.is_mixed && count > 1).then(|| {
            let verdict = bank.loops.decide(depth);
            let bounds = bank.loops.bounds(depth, &verdict);
            (verdict, bounds)
        });
        Self {
            radii: (0..count).map(|j| between(&bank.loops, j)).collect(),
            letters: (0..count).map(|j| j.to_string()).collect(),
            alone,
            together,
            depth,
            bank,
        }
    }

    /// `stable`, `unstable` or `undecided`.
    fn word(&self) -> &'static str {
        match (&self.together, self.alone) {
            (Some((verdict, _)), _) => verdict_word(verdict),
            (None, Some(true)) => "stable",
            (None, Some(false)) => "unstable",
            (None, None) => "undecided",
        }
    }
}

/// The answer for people.
pub fn text(answer: &BankAnswer) -> String {
    let bank = &answer.bank;
    let mut text = wrapped(&bank.about, "");
    let mut rows = table(&["mode", "letter", "spectral radius of A = (I − KH)F, at least", "below"]);
    for ((name, letter), radius) in bank.names.iter().zip(&answer.letters).zip(&answer.radii) {
        rows.add_row([name, letter, &radius.at_least, &radius.below]);
    }
    let _ = writeln!(text, "{rows}");
    let certified = if answer.word() == "undecided" { "" } else { "certified " };
    let title = if bank.is_mixed { "MIXED   " } else { "UN-MIXED" };
    let _ = writeln!(text, "{title}  {certified}{}", answer.word());
    let Some((verdict, bounds)) = &answer.together else {
        text.push_str(&wrapped(alone(answer.word()), "  "));
        return text + &wrapped(EVERY_STEP, "  ");
    };
    text.push_str(&wrapped(&said(verdict, answer), "  "));
    let proof = Proof {
        letters: &answer.letters,
        loops: &bank.loops,
        verdict,
        bounds,
    };
    text.push_str(&proof.text());
    text.push_str(&proof.bounds_text());
    text + &wrapped(EVERY_STEP, "  ")
}

const EVERY_STEP: &str = "Every step is taken to have a measurement; a missed detection carries errors by F alone.";

fn alone(word: &str) -> &'static str {
    match word {
        "stable" => {
            "Each filter goes on from its own estimate, and each (I − KH)F has all eigenvalues inside the unit circle."
        }
        "unstable" => {
            "A filter goes on from its own estimate, and its (I − KH)F has an eigenvalue on the unit circle or outside."
        }
        _ => "A spectral radius is so near one that the two cannot be distinguished.",
    }
}

fn said(verdict: &StabilityVerdict<Dyn>, answer: &BankAnswer) -> String {
    match verdict {
        StabilityVerdict::Stable(found) if found.forms.len() == 1 => {
            "However the estimates are mixed, errors shrink: xᵀPx gets smaller whichever filter acts, since P and every P − AᵀPA are positive definite. \
             Checked:"
                .to_owned()
        }
        StabilityVerdict::Stable(found) => format!(
            "However the estimates are mixed, errors shrink: no single quadratic form was found, but {} that remember the last letters, \
             P(w) − AᵀP(w′)A being positive definite for every word w and letter, w′ being w without its first letter and with the new one. Checked:",
            found.forms.len()
        ),
        StabilityVerdict::Unstable(found) => format!(
            "Mode probabilities exist under which errors grow without bound: the product {} (letters in the order in which they act) has a spectral \
             radius of at least {}, and the transition matrix lets each mode follow the one before it. Checked:",
            word(&found.word, &answer.letters),
            found.radius,
        ),
        StabilityVerdict::Undecided { growth } => format!(
            "Neither was found. Tried: all products of up to {} letters that can be afforded and the transition matrix allows, of which the greatest \
             growth a step is {growth:.6}; quadratic forms with a memory of up to {} letters. --word and --memory search farther.",
            answer.depth.word, answer.depth.memory
        ),
    }
}

/// The answer for programs.
pub fn json(answer: &BankAnswer) -> Value {
    let modes = answer.bank.names.iter().zip(&answer.radii);
    let modes: Vec<Value> = modes
        .map(|(name, radius)| json!({ "name": name, "spectral_radius": radius }))
        .collect();
    let together = answer.together.as_ref().map(|(verdict, bounds)| {
        let proof = Proof {
            letters: &answer.letters,
            loops: &answer.bank.loops,
            verdict,
            bounds,
        };
        proof.json()
    });
    json!({
        "about": answer.bank.about,
        "mixing": if answer.bank.is_mixed { "mixed" } else { "unmixed" },
        "verdict": answer.word(),
        "modes": modes,
        "together": together,
    })
}
