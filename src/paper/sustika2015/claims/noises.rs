//! Scenario 3: the filters' noises varied, and the cause of the divergence.
//!
//! After this file the reader knows at how many noises either filter is better, and that no run diverges whose bearings are wrapped.

use super::super::divergence::Tally;
use super::super::sweep::{Point, Setting};
use super::super::{DEGREE, DIVERGENT_FIT_ERROR, GOOD_FIT_ERROR, RUNS};
use super::evidence::{
    CONVERTED, Evidence, PLAIN, Runs, WINDOWS, WRAPPED, clauses, is_matched, less_limit, setting_in_words, words,
};
use crate::paper::specification::Specification;
use crate::paper::verdict::{Judgement, Verdict, all_below_zero, confirmed_if, in_words, sign_of, whichever};
use crate::statistics::Estimate;
use crate::statistics::estimate::{figure, mean};
use crate::statistics::fit_error::FitForm;
use std::cmp::Ordering;
use std::fmt::Write;

/// A figure of a setting.
type At = (Setting, Estimate);

/// A difference of two filters at every setting, or at those that do not match.
fn differences(swept: &[(Setting, Runs)], [a, b]: [usize; 2], matched_too: bool) -> Vec<At> {
    let chosen = swept.iter().filter(|(setting, _)| matched_too || !is_matched(setting));
    chosen
        .map(|(setting, runs)| (*setting, runs.difference(a, b)))
        .collect()
}

/// How many of them are certainly above zero, certainly below, and neither.
fn signs(all: &[At]) -> String {
    let count = |sign: Option<Ordering>| {
        all.iter()
            .filter(|(_, difference)| sign_of(*difference) == sign)
            .count()
    };
    format!(
        "larger at {}, smaller at {}, neither with certainty at {}",
        count(Some(Ordering::Greater)),
        count(Some(Ordering::Less)),
        count(None)
    )
}

/// The greatest of all, by a key.
fn greatest(all: &[At], key: impl Fn(&Estimate) -> f64) -> Option<At> {
    let by_key = |a: &&At, b: &&At| key(&a.1).total_cmp(&key(&b.1));
    all.iter().max_by(by_key).copied()
}

/// A figure and where it is, in words.
fn at_in_words(at: Option<At>, unit: &str) -> String {
    at.map_or_else(String::new, |(setting, estimate)| {
        format!("{} at {}", words(estimate, unit), setting_in_words(&setting))
    })
}

pub fn more_robust(s: &Specification, runs: &Evidence) -> Judgement {
    let of = |path: usize, unscented: usize| differences(&runs.swept[path], [unscented, CONVERTED], false);
    let evidence = format!(
        "{}, those where the noises do not match. PFE of wrapped IMM-UKF against that of IMM-CMKF: {}. Never wrapped: {}.",
        runs.sweep_in_words(),
        clauses(&[0, 1, 2], |path| {
            let all = of(path, WRAPPED);
            format!(
                "{} (least {}, greatest {})",
                signs(&all),
                at_in_words(greatest(&all, |difference| -difference.value), " %"),
                at_in_words(greatest(&all, |difference| difference.value), " %")
            )
        }),
        clauses(&[0, 1, 2], |path| signs(&of(path, PLAIN))),
    );
    let all = [0, 1, 2].map(|path| differences(&runs.swept[path], [CONVERTED, WRAPPED], false));
    let all: Vec<Estimate> = all.concat().into_iter().map(|(_, difference)| difference).collect();
    s.judgement("sustika2015-more-robust", all_below_zero(&all), evidence)
}

pub fn no_difference_without_manoeuvre(s: &Specification, runs: &Evidence) -> Judgement {
    let swept = &runs.swept[0];
    let all = differences(swept, [WRAPPED, CONVERTED], true);
    let significant = all
        .iter()
        .filter(|(_, difference)| sign_of(*difference).is_some())
        .count();
    let parts: Vec<At> = swept
        .iter()
        .map(|(setting, runs)| {
            let part = runs.part(WRAPPED, CONVERTED);
            (
                *setting,
                Estimate {
                    value: 100.0 * part.value,
                    standard_error: 100.0 * part.standard_error,
                },
            )
        })
        .collect();
    let evidence = format!(
        "{}: the filters differ by more than four standard errors at {significant}, where chance alone would do so at fewer than one in a \
         hundred such sweeps; the greatest difference of wrapped IMM-UKF is {}.",
        runs.sweep_in_words(),
        at_in_words(greatest(&parts, |part| part.value.abs()), " % of IMM-CMKF"),
    );
    let verdict = confirmed_if(significant == 0);
    s.judgement("sustika2015-no-difference-without-manoeuvre", verdict, evidence)
}

pub fn mismatch_no_problem(s: &Specification, runs: &Evidence) -> Judgement {
    let of = |filter: usize| -> Vec<At> {
        let swept = runs.swept[0].iter();
        swept.map(|(setting, runs)| (*setting, runs.fit(filter))).collect()
    };
    let below = |filters: [usize; 2]| {
        let all = filters.map(of).concat();
        let all: Vec<Estimate> = all
            .into_iter()
            .map(|(_, fit)| less_limit(fit, GOOD_FIT_ERROR))
            .collect();
        all_below_zero(&all)
    };
    let most = |filter: usize| at_in_words(greatest(&of(filter), |fit| fit.value), " %");
    let evidence = format!(
        "{}: the greatest mean PFE is {} for IMM-CMKF, {} for wrapped IMM-UKF and {} for the never wrapped one. The limit is {} %.",
        runs.sweep_in_words(),
        most(CONVERTED),
        most(WRAPPED),
        most(PLAIN),
        figure(GOOD_FIT_ERROR),
    );
    let verdict = whichever(&[below([CONVERTED, WRAPPED]), below([CONVERTED, PLAIN])]);
    s.judgement("sustika2015-mismatch-no-problem", verdict, evidence)
}

/// What the means over as many runs as the paper's show of one filter.
#[derive(Default)]
struct Blocks {
    /// All such means.
    means: usize,
    /// Those with a divergent run among them.
    with_divergence: usize,
    /// Those of them above the limit that would be below it without.
    made_bad: usize,
    /// Divergent runs.
    divergent: usize,
}

fn blocks(swept: &[(Setting, Runs)], filter: usize) -> Blocks {
    let mut blocks = Blocks::default();
    for (_, runs) in swept {
        let fits: Vec<f64> = runs
            .0
            .iter()
            .filter_map(|run| run.fit(FitForm::RootSumSquare, filter))
            .collect();
        for block in fits.chunks(RUNS) {
            let rest: Vec<f64> = block
                .iter()
                .copied()
                .filter(|fit| *fit <= DIVERGENT_FIT_ERROR)
                .collect();
            let has_divergence = rest.len() < block.len();
            let is_made_bad = mean(block).value > GOOD_FIT_ERROR && mean(&rest).value < GOOD_FIT_ERROR;
            blocks.means += 1;
            blocks.divergent += block.len() - rest.len();
            blocks.with_divergence += usize::from(has_divergence);
            blocks.made_bad += usize::from(has_divergence && is_made_bad);
        }
    }
    blocks
}

pub fn divergence(s: &Specification, runs: &Evidence) -> Judgement {
    let of = |filter: usize| WINDOWS.map(|path| blocks(&runs.swept[path], filter));
    let in_words = |blocks: &Blocks| {
        format!(
            "{} divergent runs; of {} means over {RUNS} runs {} contain one, and {} are above {} % with it that are below without",
            blocks.divergent,
            blocks.means,
            blocks.with_divergence,
            blocks.made_bad,
            figure(GOOD_FIT_ERROR)
        )
    };
    let [wrapped, plain] = [of(WRAPPED), of(PLAIN)];
    let evidence = format!(
        "{}, IMM-UKF, divergent where the PFE of a run exceeds {} %. Never wrapped: {}. Wrapped, on the same measurements: {}.",
        runs.sweep_in_words(),
        figure(DIVERGENT_FIT_ERROR),
        clauses(&WINDOWS, |path| in_words(&plain[path - 1])),
        clauses(&WINDOWS, |path| in_words(&wrapped[path - 1])),
    );
    let is_so = |blocks: &[Blocks; 2]| confirmed_if(blocks.iter().any(|blocks| blocks.made_bad > 0));
    let verdict = whichever(&[is_so(&plain), is_so(&wrapped)]);
    s.judgement("sustika2015-divergence", verdict, evidence)
}

/// A tally of the runs of several simulations.
fn tally<'a>(simulations: impl Iterator<Item = &'a Runs>) -> Tally {
    let mut runs = 0;
    let points: Vec<Point> = simulations
        .map(|simulation| {
            runs = simulation.0.len();
            Point::of(&simulation.0, FitForm::RootSumSquare)
        })
        .collect();
    Tally::of(points.iter(), runs)
}

/// How far apart the two unscented filters come in runs without a jump, and how near to the cut those of them are that diverge.
fn without_jump(scenarios: &[[Runs; 3]; 2]) -> String {
    let all = scenarios.iter().flatten().flat_map(|runs| &runs.0);
    let quiet = || all.clone().filter(|run| !run.jumps);
    let is_divergent = |run: &&super::super::outcome::Outcome| {
        run.fit(FitForm::RootSumSquare, PLAIN)
            .is_some_and(|fit| fit > DIVERGENT_FIT_ERROR)
    };
    let farthest = quiet().filter(is_divergent).map(|run| run.to_cut).fold(0.0, f64::max);
    let apart = |least: f64| {
        quiet()
            .filter(|run| run.to_cut >= least)
            .map(|run| run.apart)
            .fold(0.0, f64::max)
    };
    let mut text = format!(
        "In {} runs without a jump the two unscented filters are at most {} m apart",
        quiet().count(),
        figure(apart(0.0))
    );
    for degrees in [5.0, 20.0] {
        let _ = write!(
            text,
            ", {} m where no measured bearing comes within {degrees}° of the negative x-axis",
            figure(apart(degrees * DEGREE))
        );
    }
    if farthest > 0.0 {
        let _ = write!(
            text,
            "; those that diverge without a jump come within {}° of it",
            figure(farthest / DEGREE)
        );
    }
    text
}

pub fn cause_of_divergence(s: &Specification, runs: &Evidence) -> Judgement {
    let scenarios = [1, 2].map(|scenario| tally(runs.scenarios[scenario - 1].iter()));
    let sweeps = tally(runs.swept.iter().flatten().map(|(_, runs)| runs));
    let mut evidence = String::new();
    for (scenario, tally) in (1..).zip(&scenarios) {
        let _ = write!(evidence, "Scenario {scenario}, three trajectories: {} ", tally.cause());
    }
    let joint = |filter: usize| {
        let all = runs.scenarios.iter().flatten().flat_map(|runs| &runs.0);
        let fits = all.filter_map(|run| run.fit(FitForm::JointNorm, filter));
        fits.filter(|fit| *fit > DIVERGENT_FIT_ERROR).count().to_string()
    };
    let both = |scenario: usize, path: usize| {
        let runs = &runs.scenarios[scenario][path];
        format!(
            "{} wrapped, {} never wrapped",
            words(runs.difference(WRAPPED, CONVERTED), " %"),
            in_words(runs.difference(PLAIN, CONVERTED), "%")
        )
    };
    let _ = write!(
        evidence,
        "{}, three trajectories: {} {}. PFE of IMM-UKF less that of IMM-CMKF: scenario 1 {}; scenario 2 {}. (Where the target is near an axis \
         most of the time, a small error is a large part of that coordinate; by the joint norm {} runs of scenarios 1 and 2 diverge, of \
         IMM-CMKF, IMM-UKF wrapped and never wrapped.)",
        runs.sweep_in_words(),
        sweeps.cause(),
        without_jump(&runs.scenarios),
        clauses(&[0, 1, 2], |path| both(0, path)),
        clauses(&[0, 1, 2], |path| both(1, path)),
        [CONVERTED, WRAPPED, PLAIN].map(joint).join(", "),
    );
    // The cut is the cause where wrapping ends it, and the mismatch is not where there is divergence without one.
    let [matched, mismatched] = scenarios.map(|tally| tally.divergent);
    let [wrapped, plain] =
        [WRAPPED, PLAIN].map(|filter| matched[filter] + mismatched[filter] + sweeps.divergent[filter]);
    let verdict = if plain > 0 && 10 * wrapped <= plain && matched[PLAIN] > 0 {
        Verdict::Refuted
    } else if plain > 0 && wrapped >= plain && matched[WRAPPED] == 0 {
        Verdict::Confirmed
    } else {
        Verdict::Undecided
    };
    s.judgement("sustika2015-cause-of-divergence", verdict, evidence)
}
