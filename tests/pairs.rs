//! Goal: two mistakes of which each shows in cases in which the other does not are both named.
//!
//! Method: pairs are drawn from the catalogue with a fixed seed and planted in this crate's filter, which answers cases of every kind. A
//! pair is taken where in some case the one shows and the other does not, and the other way round; names are read off the diagnosis.
#![allow(clippy::unwrap_used, reason = "in tests a panic is the failure")]

use immaculate::oracle::case;
use immaculate::oracle::check::{Selection, check};
use immaculate::oracle::diagnose::Diagnosis;
use immaculate::oracle::subject::{Level, Planted};
use immaculate::oracle::trace::Trace;
use immaculate::oracle::variant::{self, Kind, Variant, catalogue};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;

/// A short case of each family, with what tells most mistakes apart: three modes, a missed detection, a wrap, a conversion.
const CASES: [&str; 7] = [
    "converted.generic",
    "extended.generic",
    "missed.one",
    "step.n4-m2.three-modes",
    "steps.fixed-gain",
    "update.unscented.scaled",
    "wrap.clockwise",
];

/// The number of pairs.
const PAIRS: usize = 50;

/// At least this many of them are named.
const NAMED: usize = 45;

fn values(id: &str, planted: &[&str]) -> Trace {
    let cases = case::all().unwrap();
    let problem = &cases.iter().find(|case| case.problem.id == id).unwrap().problem;
    let mut setup = problem.setup_in_doubles().unwrap();
    for variant in planted {
        variant::apply(variant, &mut setup);
    }
    setup.run().in_doubles()
}

/// Whether a mistake shows in each of the cases: a number is off by more than any rounding.
fn shows(variant: &Variant) -> Vec<bool> {
    let is_off = |id: &str| {
        let (right, planted) = (values(id, &[]), values(id, &[variant.id.as_str()]));
        right.all_places().any(|(step, quantity, mode)| {
            let (right, planted) = (right.get(step, quantity, mode), planted.get(step, quantity, mode));
            match (right, planted) {
                (Some(right), Some(planted)) => {
                    let size = right.iter().fold(0.0_f64, |size, number| size.max(number.abs()));
                    let mut numbers = right.iter().zip(planted);
                    numbers.any(|(a, b)| !b.is_finite() || (a - b).abs() > 1e-6 * size)
                }
                (right, planted) => right.is_some() != planted.is_some(),
            }
        })
    };
    CASES.iter().map(|id| is_off(id)).collect()
}

/// Pairs of which each shows where the other does not.
fn drawn(pairs: usize) -> Vec<[&'static Variant; 2]> {
    let mistakes: Vec<&Variant> = catalogue()
        .iter()
        .filter(|variant| variant.kind == Kind::Mistake)
        .collect();
    let shown: Vec<Vec<bool>> = mistakes.par_iter().map(|variant| shows(variant)).collect();
    let is_alone = |a: usize, b: usize| shown[a].iter().zip(&shown[b]).any(|(a, b)| *a && !b);
    let mut random = ChaCha8Rng::seed_from_u64(17);
    let mut drawn = Vec::new();
    while drawn.len() < pairs {
        let [a, b] = [0; 2].map(|_| usize::try_from(random.next_u32()).unwrap() % mistakes.len());
        if is_alone(a, b) && is_alone(b, a) {
            drawn.push([mistakes[a], mistakes[b]]);
        }
    }
    drawn
}

/// The variants that a diagnosis names.
fn named(diagnosis: &Diagnosis) -> Vec<&'static Variant> {
    match diagnosis {
        Diagnosis::Nothing => Vec::new(),
        Diagnosis::One(variants) => variants.clone(),
        Diagnosis::Several(members) => members.concat(),
        Diagnosis::Pairs(pairs) => pairs.iter().flatten().copied().collect(),
        Diagnosis::ByFilter(filters) => filters.iter().flat_map(|(_, of_filter)| named(of_filter)).collect(),
        Diagnosis::InParts { parts, .. } => parts.iter().flat_map(|part| part.variants.clone()).collect(),
    }
}

#[test]
fn two_mistakes_that_show_in_different_cases_are_both_named() {
    let mut missed = Vec::new();
    for pair in drawn(PAIRS) {
        let mut program = Planted {
            variants: pair.map(|variant| variant.id.clone()).to_vec(),
            level: Level::Everything,
        };
        let ids = CASES.map(str::to_owned).to_vec();
        let report = check(
            &mut program,
            &Selection {
                ids,
                ..Selection::default()
            },
            &|_| {},
        )
        .unwrap();
        let named = named(&report.diagnosis);
        if !pair.iter().all(|variant| named.contains(variant)) {
            let found: Vec<&str> = named.iter().map(|variant| variant.id.as_str()).collect();
            missed.push(format!("{} and {}: {}", pair[0].id, pair[1].id, found.join(", ")));
        }
    }
    assert!(
        PAIRS - missed.len() >= NAMED,
        "{} of {PAIRS} are not named:\n{}",
        missed.len(),
        missed.join("\n")
    );
}
