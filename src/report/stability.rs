//! The joint stability of two fixed-gain filters, as text and as JSON.
//!
//! It prints the gains, the spectral radii, the verdict on both readings of the update, and the proof, so that a reader can check it by
//! hand or with another program.

use super::stability_proof::{Proof, word};
use super::{table, wrapped};
use crate::number::{Enclosure, Field, Rational};
use crate::statistics::estimate::figure;
use crate::steady::certificate::Product;
use crate::steady::certificate_file::CertificateFile;
use crate::steady::closed_loops::{Bounds, ClosedLoops};
use crate::steady::gains;
use crate::steady::map::{Map, greatest_frozen_radius};
use crate::steady::search::spectral_radius;
use crate::steady::verdict::{BITS, Depth, Filters, LETTERS, StabilityVerdict, word_text};
use serde::Serialize;
use serde_json::{Value, json};
use std::fmt::Write;

/// The most digits that are printed; only those are that every number of an enclosure is rounded to.
const DIGITS: u32 = 40;

/// The width in which a spectral radius is enclosed: 10⁻¹².
const RADIUS_DIGITS: u32 = 12;

/// One filter's steady state, as proven decimals.
#[derive(Debug, Clone, Serialize)]
pub struct Steady {
    /// Its name.
    pub name: &'static str,
    /// Λ.
    pub tracking_index: String,
    /// θ.
    pub damping_root: String,
    /// α.
    pub alpha: String,
    /// β.
    pub beta: String,
    /// γ.
    pub gamma: String,
    /// K = [α, β/t, γ/(2t²)].
    pub gain: [String; 3],
    /// S, m².
    pub innovation_variance: String,
    /// [α, β, γ/2]: K where t = 1.
    pub scaled_gain: [String; 3],
    /// S/R.
    pub scaled_innovation_variance: String,
    /// The spectral radius of (I − K H) F.
    pub spectral_radius: Between,
}

/// A number between two decimals, both proven.
#[derive(Debug, Clone, Serialize)]
pub struct Between {
    /// It is this or more.
    pub at_least: String,
    /// It is less than this.
    pub below: String,
}

/// The units of the filters: t, s, and R, m². One and one where filters are given by their damping roots.
pub type Units = [Rational; 2];

/// All that is said of two filters.
#[derive(Debug, Clone)]
pub struct StabilityAnswer {
    /// t and R.
    pub units: Units,
    /// The steady states.
    pub steady: [Steady; 2],
    /// The matrices.
    pub loops: ClosedLoops,
    /// The greatest spectral radius of the frozen criterion under the paper's chain.
    pub frozen_radius: f64,
    /// The verdict on the mixed reading.
    pub verdict: StabilityVerdict,
    /// The joint spectral radius.
    pub bounds: Bounds,
}

impl StabilityAnswer {
    /// The answer about two filters.
    pub fn new(filters: &Filters, units: Units, depth: Depth, verdict: StabilityVerdict) -> Self {
        let loops = filters.closed_loops();
        Self {
            steady: steady(filters, &units, &loops),
            units,
            frozen_radius: greatest_frozen_radius(filters),
            bounds: loops.bounds(depth, &verdict),
            loops,
            verdict,
        }
    }

    fn proof<'a>(&'a self, letters: &'a [String]) -> Proof<'a, nalgebra::U3> {
        Proof {
            letters,
            loops: &self.loops,
            verdict: &self.verdict,
            bounds: &self.bounds,
        }
    }
}

fn letters() -> Vec<String> {
    LETTERS.iter().map(char::to_string).collect()
}

/// As many digits as are right, and no more than [`DIGITS`].
fn digits(value: &Enclosure) -> String {
    let right = (1..=DIGITS).rev().find_map(|digits| value.to_decimal(digits));
    right.unwrap_or_else(|| value.to_string())
}

/// The spectral radius of one filter, by the Schur-Cohn test on either side.
pub(super) fn between<N: nalgebra::Dim>(loops: &ClosedLoops<N>, filter: usize) -> Between
where
    crate::matrix::Shapes: crate::matrix::Holds<N>,
{
    let near = Rational::from_f64(spectral_radius(&loops.in_doubles()[filter]));
    let is_below = |bound: &Rational| loops.is_radius_below(&[filter], bound);
    // Wider where a double is farther off, or the test cannot tell.
    for digits in (0..=RADIUS_DIGITS).rev() {
        let unit = Rational::new(1, 10).pow(digits);
        let middle = Rational::from_decimal(&near.to_decimal(digits)).unwrap_or_else(|| near.clone());
        let (low, high) = (middle.clone() - unit.clone(), middle + unit);
        if is_below(&high) == Some(true) && (!low.is_positive() || is_below(&low) == Some(false)) {
            let low = if low.is_positive() { low } else { Rational::integer(0) };
            return Between {
                at_least: low.to_decimal(digits),
                below: high.to_decimal(digits),
            };
        }
    }
    let unknown = || "unknown".to_owned();
    Between {
        at_least: unknown(),
        below: unknown(),
    }
}

/// The steady states of both filters, at the precision of certificates.
fn steady(filters: &Filters, units: &Units, loops: &ClosedLoops) -> [Steady; 2] {
    Enclosure::with_precision(BITS, || {
        let [v, a] = &filters.roots();
        let (one, two) = (Enclosure::integer(1), Enclosure::integer(2));
        let [t, r] = units.each_ref().map(Enclosure::rational);
        let of = |name, root: &Enclosure, index: &Enclosure, gains: [nalgebra::Vector3<Enclosure>; 2], filter| {
            let [scaled, gain] = gains;
            Steady {
                name,
                tracking_index: digits(index),
                damping_root: digits(root),
                alpha: digits(&scaled[0]),
                beta: digits(&scaled[1]),
                gamma: digits(&(scaled[2].clone() * two.clone())),
                gain: [0, 1, 2].map(|i| digits(&gain[i])),
                innovation_variance: digits(&gains::innovation_variance(root, &r)),
                scaled_gain: [0, 1, 2].map(|i| digits(&scaled[i])),
                scaled_innovation_variance: digits(&gains::innovation_variance(root, &one)),
                spectral_radius: between(loops, filter),
            }
        };
        let velocity = [&one, &t].map(|t| gains::alpha_beta_gain(v, t));
        let acceleration = [&one, &t].map(|t| gains::alpha_beta_gamma_gain(a, t));
        [
            of("constant velocity", v, &gains::alpha_beta_index(v), velocity, 0),
            of(
                "constant acceleration",
                a,
                &gains::alpha_beta_gamma_index(a),
                acceleration,
                1,
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
            .chain(&filter.scaled_gain);
        row.extend(
            numbers
                .chain([&filter.scaled_innovation_variance, &filter.spectral_radius.below])
                .map(|number| short(number)),
        );
        rows.add_row(row);
    }
    let _ = writeln!(text, "{rows}");
    let gains = answer.steady.iter().zip(LETTERS).map(|(filter, letter)| {
        let gain = filter.gain.each_ref().map(|entry| short(entry)).join(", ");
        format!(
            "K_{letter} = [{gain}] and S_{letter} = {} m²",
            short(&filter.innovation_variance)
        )
    });
    let [t, r] = &answer.units;
    text.push_str(&wrapped(
        &format!(
            "With t = {t} s and R = {r} m² the gain K = [α, β/t, γ/(2t²)] and the innovation variance S are {}. Four digits of each are shown; \
             --json has up to {DIGITS}, all proven.",
            gains.collect::<Vec<_>>().join("; ")
        ),
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
    let letters = letters();
    text.push_str(&answer.proof(&letters).text());
    text.push_str(&answer.proof(&letters).bounds_text());
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

/// A proven decimal with four digits for the table.
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
            word(&found.word, &letters()),
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

/// The answer for programs.
pub fn json(about: &str, answer: &StabilityAnswer, certificate: Option<&CertificateFile>) -> Value {
    let letters = letters();
    let mut mixed = json!({ "verdict": verdict_word(&answer.verdict), "certificate": certificate });
    if let (Some(mixed), Value::Object(proof)) = (mixed.as_object_mut(), answer.proof(&letters).json()) {
        mixed.extend(proof);
    }
    json!({
        "about": about,
        "interval": answer.units[0].to_string(),
        "measurement_variance": answer.units[1].to_string(),
        "steady": answer.steady,
        "unmixed": { "verdict": "stable" },
        "mixed": mixed,
        "frozen": { "greatest_spectral_radius": answer.frozen_radius, "certified": false },
    })
}

/// The verdict in one word.
pub fn verdict_word<N: nalgebra::Dim>(verdict: &StabilityVerdict<N>) -> &'static str
where
    crate::matrix::Shapes: crate::matrix::Holds<N>,
{
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
