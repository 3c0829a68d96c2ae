//! The joint stability of two fixed-gain filters, for people and programs.
//!
//! After this file the reader knows what `immaculate stability` prints: the gains, the spectral radii, the verdict on both readings of the
//! update, and the proof, so that it can be checked by hand or with another program.

use super::{table, wrapped};
use crate::number::{Enclosure, Field, Rational};
use crate::statistics::estimate::figure;
use crate::steady::certificate::{Product, Quadratics};
use crate::steady::certificate_file::CertificateFile;
use crate::steady::gains;
use crate::steady::map::{Map, greatest_frozen_radius};
use crate::steady::search::spectral_radius;
use crate::steady::verdict::{BITS, Filters, LETTERS, StabilityVerdict, rows_text, word_text};
use serde::Serialize;
use serde_json::{Value, json};
use std::fmt::Write;

/// Digits of gains that are printed; they are certain.
const DIGITS: u32 = 12;

/// One filter's steady state, as proven decimals; in coordinates with t = 1 and R = 1.
#[derive(Debug, Clone, Serialize)]
pub struct Steady {
    /// Its name.
    pub name: &'static str,
    /// Λ.
    pub tracking_index: String,
    /// θ.
    pub damping_root: String,
    /// α, β, γ/2: the gain is [α, β/t, γ/(2t²)].
    pub gain: [String; 3],
    /// S/R.
    pub innovation_variance: String,
    /// The spectral radius of (I − K H) F.
    pub spectral_radius: f64,
}

/// All that is said of two filters.
#[derive(Debug, Clone)]
pub struct StabilityAnswer {
    /// The steady states.
    pub steady: [Steady; 2],
    /// The greatest spectral radius of the frozen criterion under the paper's chain.
    pub frozen_radius: f64,
    /// The verdict on the mixed reading.
    pub verdict: StabilityVerdict,
}

impl StabilityAnswer {
    /// The answer about two filters.
    pub fn new(filters: &Filters, verdict: StabilityVerdict) -> Self {
        Self {
            steady: steady(filters),
            frozen_radius: greatest_frozen_radius(filters),
            verdict,
        }
    }
}

/// The steady states of both filters, at the precision of certificates.
fn steady(filters: &Filters) -> [Steady; 2] {
    let matrices = filters.in_doubles();
    let text = |value: &Enclosure| value.to_decimal(DIGITS).unwrap_or_else(|| value.to_string());
    Enclosure::with_precision(BITS, || {
        let [v, a] = &filters.roots();
        let one = Enclosure::integer(1);
        let of = |name, root: &Enclosure, index: &Enclosure, gain: &nalgebra::Vector3<Enclosure>, matrix| Steady {
            name,
            tracking_index: text(index),
            damping_root: text(root),
            gain: [0, 1, 2].map(|i| text(&gain[i])),
            innovation_variance: text(&gains::innovation_variance(root, &one)),
            spectral_radius: spectral_radius(matrix),
        };
        let (gain_v, gain_a) = (gains::alpha_beta_gain(v, &one), gains::alpha_beta_gamma_gain(a, &one));
        [
            of(
                "constant velocity",
                v,
                &gains::alpha_beta_index(v),
                &gain_v,
                &matrices[0],
            ),
            of(
                "constant acceleration",
                a,
                &gains::alpha_beta_gamma_index(a),
                &gain_a,
                &matrices[1],
            ),
        ]
    })
}

/// The answer for people.
pub fn text(about: &str, answer: &StabilityAnswer) -> String {
    let mut text = wrapped(about, "");
    let mut rows = table(&["steady filter", "Λ", "θ", "α", "β", "γ/2", "S/R", "spectral radius"]);
    for filter in &answer.steady {
        let mut row = vec![filter.name.to_owned()];
        let numbers = [&filter.tracking_index, &filter.damping_root]
            .into_iter()
            .chain(&filter.gain);
        row.extend(numbers.chain([&filter.innovation_variance]).map(|number| short(number)));
        row.push(figure(filter.spectral_radius));
        rows.add_row(row);
    }
    let _ = writeln!(text, "{rows}");
    text.push_str(&wrapped(
        "The gain is K = [α, β/t, γ/(2t²)]; all digits are proven by enclosure, and more of them are in --json.",
        "",
    ));
    text.push_str("\nUN-MIXED  certified stable\n");
    text.push_str(&wrapped(
        "Each filter goes on from its own estimate. (I − KH)F of either has all eigenvalues inside the unit circle for every positive \
         noise, and the output, a convex combination of bounded estimates, is bounded: here the paper's sentence is right.",
        "  ",
    ));
    let certified = match answer.verdict {
        StabilityVerdict::Undecided { .. } => "",
        _ => "certified ",
    };
    let _ = writeln!(text, "\nMIXED     {certified}{}", verdict_word(&answer.verdict));
    text.push_str(&wrapped(&proof(&answer.verdict), "  "));
    text.push_str(&matrices(&answer.verdict));
    text.push_str("\nFROZEN    not certified, searched\n");
    text.push_str(&wrapped(
        &format!(
            "With constant mode probabilities under the chain 0.95/0.05 the greatest spectral radius of diag(Aⱼ)(U ⊗ I) over 19 probabilities \
             from 1e-4 to 1 − 1e-4 is {}.",
            figure(answer.frozen_radius)
        ),
        "  ",
    ));
    text
}

/// A proven decimal with six digits for the table.
fn short(number: &str) -> String {
    let value = Rational::from_decimal(number).map_or(f64::NAN, |number| number.to_f64());
    figure(value)
}

/// What the proof says, in words.
fn proof(verdict: &StabilityVerdict) -> String {
    match verdict {
        StabilityVerdict::Stable(found) if found.forms.len() == 1 => "However the two filters' estimates are mixed, errors shrink: xᵀPx gets smaller \
             whichever filter acts, since P, P − A_vᵀPA_v and P − A_aᵀPA_a are positive definite, A = (I − KH)F in coordinates scaled by \
             diag(1, t, t²). Checked:"
            .to_owned(),
        StabilityVerdict::Stable(found) => format!(
            "However the two filters' estimates are mixed, errors shrink: no single quadratic form was found, but {} that remember the last \
             {}, P(w) − AᵀP(w′)A being positive definite for every word w and letter, w′ being w without its first letter and with \
             the new one. Checked:",
            found.forms.len(),
            match found.forms.len().ilog2() {
                1 => "letter".to_owned(),
                letters => format!("{letters} letters"),
            },
        ),
        StabilityVerdict::Unstable(found) => format!(
            "Mode probabilities exist under which errors grow without bound, although each filter by itself is stable: the product {} \
             (letters in the order in which they act, {} letters) has a spectral radius of at least {} = {}, by the Schur-Cohn test of its \
             characteristic polynomial. Checked.",
            word(&found.word),
            found.word.len(),
            found.radius,
            figure(found.radius.to_f64()),
        ),
        StabilityVerdict::Undecided { growth } => format!(
            "Neither a form nor a growing product was found; the greatest growth a step of those tried is {growth:.6}. --memory and --word \
             search farther."
        ),
    }
}

/// A word with its runs as powers.
fn word(word: &[usize]) -> String {
    let superscript = |count: usize| {
        let digit = |c: char| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(c as usize - '0' as usize).unwrap_or(c);
        count.to_string().chars().map(digit).collect::<String>()
    };
    let runs = word.chunk_by(|a, b| a == b);
    runs.map(|run| match run {
        [letter] => LETTERS[*letter].to_string(),
        _ => format!("{}{}", LETTERS[run[0]], superscript(run.len())),
    })
    .collect::<Vec<_>>()
    .join(" ")
}

/// The forms, up to four of them.
fn matrices(verdict: &StabilityVerdict) -> String {
    let StabilityVerdict::Stable(Quadratics { forms, .. }) = verdict else {
        return String::new();
    };
    let mut text = String::new();
    for (node, form) in forms.iter().enumerate().take(4) {
        let name = match forms.len() {
            1 => "P".to_owned(),
            count => format!("P({})", memory_text(node, count.ilog2())),
        };
        let _ = writeln!(text, "    {name} = {}", rows_text(form));
    }
    if forms.len() > 4 {
        let _ = writeln!(text, "    … {} more: --certificate FILE writes them", forms.len() - 4);
    }
    text
}

fn memory_text(node: usize, length: u32) -> String {
    (0..length).rev().map(|bit| LETTERS[node >> bit & 1]).collect()
}

/// The answer for programs.
pub fn json(about: &str, answer: &StabilityAnswer, certificate: Option<&CertificateFile>) -> Value {
    json!({
        "about": about,
        "steady": answer.steady,
        "unmixed": { "verdict": "stable" },
        "mixed": { "verdict": verdict_word(&answer.verdict), "certificate": certificate },
        "frozen": { "greatest_spectral_radius": answer.frozen_radius, "certified": false },
    })
}

/// The verdict in one word.
pub fn verdict_word(verdict: &StabilityVerdict) -> &'static str {
    match verdict {
        StabilityVerdict::Stable(_) => "stable",
        StabilityVerdict::Unstable(_) => "unstable",
        StabilityVerdict::Undecided { .. } => "undecided",
    }
}

/// The map as characters: Λ_v upward, Λ_a to the right.
pub fn map_text(map: &Map) -> String {
    let mut text = String::from(
        "The mixed reading over the tracking indices: Λ_v of constant velocity upward, Λ_a of constant acceleration across.\n\n",
    );
    for row in map.points.iter().rev() {
        let symbols: String = row.iter().map(|point| symbol(&point.verdict)).collect();
        let index = row.first().map_or(f64::NAN, |point| point.indices[0].to_f64());
        let _ = writeln!(text, "  {:>9}  {symbols}", figure(index));
    }
    if let Some(row) = map.points.first() {
        let ends =
            [row.first(), row.last()].map(|point| figure(point.map_or(f64::NAN, |point| point.indices[1].to_f64())));
        let width = row.len().saturating_sub(ends[0].len()).max(ends[1].len() + 2);
        let _ = writeln!(text, "  {:>9}  {}{:>width$}", "Λ_v  Λ_a", ends[0], ends[1]);
    }
    let [stable, unstable, undecided] = map.counts();
    let _ = write!(
        text,
        "\n  · stable by a common quadratic form    + stable by forms with a memory\n  2…9, x unstable: letters of the growing product \
         found (x: ten or more)    ? undecided\n\n{stable} points certified stable, {unstable} certified unstable, {undecided} undecided, each \
         at rational damping roots and checked exactly.\n"
    );
    text.push_str(&wrapped(
        &format!(
            "With constant mode probabilities under the chain 0.95/0.05 the greatest spectral radius anywhere on the map is {:.6} (searched, \
             not certified).",
            map.greatest_frozen_radius()
        ),
        "",
    ));
    text
}

fn symbol(verdict: &StabilityVerdict) -> char {
    match verdict {
        StabilityVerdict::Stable(found) if found.forms.len() == 1 => '·',
        StabilityVerdict::Stable(_) => '+',
        StabilityVerdict::Unstable(Product { word, .. }) => {
            char::from_digit(word.len().try_into().unwrap_or(10), 10).unwrap_or('x')
        }
        StabilityVerdict::Undecided { .. } => '?',
    }
}

/// The map for programs: a point an entry, with its certificate in short.
pub fn map_json(map: &Map) -> Value {
    let points = map.points.iter().flatten().map(|point| {
        json!({
            "damping_roots": point.roots.each_ref().map(ToString::to_string),
            "tracking_indices": point.indices.each_ref().map(Rational::to_f64),
            "verdict": verdict_word(&point.verdict),
            "forms": match &point.verdict { StabilityVerdict::Stable(found) => Some(found.forms.len()), _ => None },
            "word": match &point.verdict { StabilityVerdict::Unstable(found) => Some(word_text(&found.word)), _ => None },
            "frozen_radius": point.frozen_radius,
        })
    });
    let [stable, unstable, undecided] = map.counts();
    json!({ "stable": stable, "unstable": unstable, "undecided": undecided, "points": points.collect::<Vec<_>>() })
}

/// The map as CSV.
pub fn map_csv(map: &Map) -> String {
    let mut text = String::from(
        "damping_root_v,damping_root_a,tracking_index_v,tracking_index_a,verdict,forms,word,frozen_radius\n",
    );
    for point in map.points.iter().flatten() {
        let (forms, word) = match &point.verdict {
            StabilityVerdict::Stable(found) => (found.forms.len().to_string(), String::new()),
            StabilityVerdict::Unstable(found) => (String::new(), word_text(&found.word)),
            StabilityVerdict::Undecided { .. } => Default::default(),
        };
        let [v, a] = point.roots.each_ref().map(Rational::to_f64);
        let [index_v, index_a] = point.indices.each_ref().map(Rational::to_f64);
        let _ = writeln!(
            text,
            "{v},{a},{index_v},{index_a},{},{forms},{word},{}",
            verdict_word(&point.verdict),
            point.frozen_radius
        );
    }
    text
}
