//! Scenario 3: varied filter noises, and the cause of the divergence.
//!
//! They count the noises at which each filter is better. No run with wrapped bearings diverges.

use super::super::divergence::Divergences;
use super::super::outcome::RunOutcome;
use super::super::sweep::{SweepPoint, SweepSetting};
use super::super::{DEGREE, DIVERGENT_FIT_ERROR, GOOD_FIT_ERROR, RUNS};
use super::evidence::{
    CONVERTED, PLAIN, RadarEvidence, Runs, WINDOWS, WRAPPED, clauses, is_matched, less_limit, setting_in_words, words,
};
use crate::paper::specification::Specification;
use crate::paper::verdict::{JudgedClaim, Tally, Verdict, all_below_zero, confirmed_if, sign_of, whichever};
use crate::statistics::Estimate;
use crate::statistics::estimate::{figure, mean};
use crate::statistics::fit_error::FitForm;
use std::cmp::Ordering;

/// A figure of a setting.
type At = (SweepSetting, Estimate);

/// A difference of two filters at every setting, or at those that do not match.
fn differences(swept: &[(SweepSetting, Runs)], [a, b]: [usize; 2], matched_too: bool) -> Vec<At> {
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

pub fn more_robust(s: &Specification, runs: &RadarEvidence) -> JudgedClaim {
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

pub fn no_difference_without_manoeuvre(s: &Specification, runs: &RadarEvidence) -> JudgedClaim {
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
        "{}: the filters differ by more than four standard errors at {significant}, which chance alone would do at one setting or more in \
         fewer than one of a hundred such sweeps; the greatest difference of wrapped IMM-UKF is {}.",
        runs.sweep_in_words(),
        at_in_words(greatest(&parts, |part| part.value.abs()), " % of IMM-CMKF"),
    );
    let verdict = confirmed_if(significant == 0);
    s.judgement("sustika2015-no-difference-without-manoeuvre", verdict, evidence)
}

pub fn mismatch_no_problem(s: &Specification, runs: &RadarEvidence) -> JudgedClaim {
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
        "{}: the greatest mean PFE is {} for IMM-CMKF, {} for wrapped IMM-UKF and {} for the never wrapped one. The limit is {GOOD_FIT_ERROR} %.",
        runs.sweep_in_words(),
        most(CONVERTED),
        most(WRAPPED),
        most(PLAIN),
    );
    let verdict = whichever(&[below([CONVERTED, WRAPPED]), below([CONVERTED, PLAIN])]);
    s.judgement("sustika2015-mismatch-no-problem", verdict, evidence)
}

/// Whether a filter diverges in a run: by the joint norm. The root of the sum of squares also exceeds the limit where the target stays near
/// an axis, so that a small error is a large part of a small coordinate.
fn diverges(run: &RunOutcome, filter: usize) -> bool {
    run.fit(FitForm::JointNorm, filter)
        .is_some_and(|fit| fit > DIVERGENT_FIT_ERROR)
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

fn blocks(swept: &[(SweepSetting, Runs)], filter: usize) -> Blocks {
    let mut blocks = Blocks::default();
    let fit = |run: &RunOutcome| run.fit(FitForm::RootSumSquare, filter);
    for (_, runs) in swept {
        for block in runs.0.chunks(RUNS) {
            let divergent = block.iter().filter(|run| diverges(run, filter)).count();
            let all: Vec<f64> = block.iter().filter_map(fit).collect();
            let rest: Vec<f64> = block
                .iter()
                .filter(|run| !diverges(run, filter))
                .filter_map(fit)
                .collect();
            let is_made_bad = mean(&all).value > GOOD_FIT_ERROR && mean(&rest).value < GOOD_FIT_ERROR;
            blocks.means += 1;
            blocks.divergent += divergent;
            blocks.with_divergence += usize::from(divergent > 0);
            blocks.made_bad += usize::from(is_made_bad);
        }
    }
    blocks
}

impl Blocks {
    fn words(&self) -> String {
        let Self {
            means,
            with_divergence,
            made_bad,
            divergent,
        } = self;
        if *divergent == 0 {
            return "none".to_owned();
        }
        format!(
            "{divergent} runs, in {with_divergence} of {means} means over {RUNS} runs, of which {made_bad} exceed {GOOD_FIT_ERROR} % with and not \
             without them"
        )
    }
}

pub fn divergence(s: &Specification, runs: &RadarEvidence) -> JudgedClaim {
    let of = |filter: usize| WINDOWS.map(|path| blocks(&runs.swept[path], filter));
    let [wrapped, plain] = [of(WRAPPED), of(PLAIN)];
    let evidence = format!(
        "{}. Runs of IMM-UKF that diverge, with a PFE above {DIVERGENT_FIT_ERROR} % by the joint norm: never wrapped, {}; wrapped, on the same \
         measurements, {}.",
        runs.sweep_in_words(),
        clauses(&WINDOWS, |path| plain[path - 1].words()),
        clauses(&WINDOWS, |path| wrapped[path - 1].words()),
    );
    let is_so = |blocks: &[Blocks; 2]| confirmed_if(blocks.iter().any(|blocks| blocks.made_bad > 0));
    let tally = Tally::of_verdicts(&[is_so(&plain), is_so(&wrapped)]);
    s.judgement("sustika2015-divergence", tally.verdict(), evidence)
        .over(tally)
}

/// A tally of the runs of several simulations, divergent by one of the forms.
fn tally<'a>(simulations: impl Iterator<Item = &'a Runs>, form: FitForm) -> Divergences {
    let mut runs = 0;
    let of = |simulation: &Runs| {
        runs = simulation.0.len();
        SweepPoint::of(&simulation.0, form)
    };
    let points: Vec<SweepPoint> = simulations.map(of).collect();
    Divergences::of(points.iter(), runs)
}

/// Where the two unscented filters part in runs without a jump, and which of these diverge.
fn without_jump(scenarios: &[[Runs; 3]; 2]) -> String {
    let all = scenarios.iter().flatten().flat_map(|runs| &runs.0);
    let quiet: Vec<&RunOutcome> = all.filter(|run| !run.jumps).collect();
    let apart: Vec<&RunOutcome> = quiet.iter().copied().filter(|run| run.apart > THE_SAME).collect();
    let greatest = |of: fn(&RunOutcome) -> f64| apart.iter().map(|run| of(run)).fold(0.0, f64::max);
    format!(
        "In the {} of these runs without a jump the two unscented filters agree to a millimetre in all but {}, which differ by up to {} m and \
         of which {} diverge: their measured bearings come within {}° of the negative x-axis, and what the filter expects goes beyond.",
        quiet.len(),
        apart.len(),
        figure(greatest(|run| run.apart)),
        apart.iter().filter(|run| diverges(run, PLAIN)).count(),
        figure(greatest(|run| run.to_cut) / DEGREE),
    )
}

/// Estimates nearer than this are called the same, m: some orders above what roundings do, and below what any filter is good for.
const THE_SAME: f64 = 1e-3;

pub fn cause_of_divergence(s: &Specification, runs: &RadarEvidence) -> JudgedClaim {
    let scenarios = || runs.scenarios.iter().flatten();
    let both = tally(scenarios(), FitForm::JointNorm);
    let matched = tally(runs.scenarios[0].iter(), FitForm::JointNorm);
    let sweeps = tally(runs.swept.iter().flatten().map(|(_, runs)| runs), FitForm::JointNorm);
    let by_squares = tally(scenarios(), FitForm::RootSumSquare);
    let paired = |scenario: usize, path: usize| {
        let runs = &runs.scenarios[scenario - 1][path];
        let [wrapped, plain] = [WRAPPED, PLAIN].map(|unscented| runs.difference(unscented, CONVERTED));
        format!("{} and {}", words(wrapped, " %"), words(plain, " %"))
    };
    let evidence = format!(
        "A run diverges where its PFE exceeds {DIVERGENT_FIT_ERROR} % by the joint norm. Scenarios 1 and 2 on three trajectories: {} {} of the \
         never wrapped ones are in scenario 1, where the noises match. {} {}, three trajectories: {} PFE of IMM-UKF less that of IMM-CMKF, \
         wrapped and never wrapped: scenario 1, {}; scenario 2, {}. (By the root of the sum of squares {} runs of scenarios 1 and 2 exceed \
         {DIVERGENT_FIT_ERROR} %, of IMM-CMKF, IMM-UKF wrapped and never wrapped: it is also large where a coordinate of the target is small.)",
        both.cause(),
        matched.divergent[PLAIN],
        without_jump(&runs.scenarios),
        runs.sweep_in_words(),
        sweeps.cause(),
        clauses(&[0, 1, 2], |path| paired(1, path)),
        clauses(&[0, 1, 2], |path| paired(2, path)),
        by_squares.divergent.map(|count| count.to_string()).join(", "),
    );
    let all = [0, 1, 2].map(|filter| both.divergent[filter] + sweeps.divergent[filter]);
    let verdict = is_mismatch_the_cause(matched.divergent, all);
    s.judgement("sustika2015-cause-of-divergence", verdict, evidence)
}

/// Whether the mismatch of the noises is why runs of the unscented filter diverge, from how many do where the noises match and in all: of
/// IMM-CMKF, and of IMM-UKF wrapped and never wrapped.
///
/// The cut is the cause where wrapping ends it; the mismatch is not, where runs diverge without one.
pub fn is_mismatch_the_cause(matched: [usize; 3], all: [usize; 3]) -> Verdict {
    if matched[PLAIN] > 0 && 10 * all[WRAPPED] <= all[PLAIN] {
        Verdict::Refuted
    } else if all[PLAIN] > 0 && all[WRAPPED] >= all[PLAIN] && matched[WRAPPED] == 0 {
        Verdict::Confirmed
    } else {
        Verdict::Undecided
    }
}
