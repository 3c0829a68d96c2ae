//! Section 6: the paper's conclusions about both trajectories together.
//!
//! Some conclusions follow from the paper's own tables, others from the runs.

use super::super::{GOOD_FIT_ERROR, RUNS};
use super::evidence::{
    CONVERTED, PATHS, PLAIN, RadarEvidence, WINDOWS, WRAPPED, clauses, less_limit, opposite, published, words,
};
use super::manoeuvring::gaps;
use super::straight::wrapped_and_not;
use crate::paper::operations::{CoastalRadar, Sums};
use crate::paper::specification::Specification;
use crate::paper::verdict::{
    JudgedClaim, all_below_zero, all_of, below_zero, confirmed_if, in_words, proven_if, sign_of, whichever,
};
use crate::statistics::Estimate;
use crate::statistics::estimate::figure;
use std::cmp::Ordering;

/// "A little": by less than a tenth.
const LITTLE: f64 = 0.1;

pub fn a_little_better_without_mismatch(s: &Specification, runs: &RadarEvidence) -> JudgedClaim {
    let gains = [4, 5].map(|table| {
        let [converted, unscented] = published(s, table, 1);
        1.0 - unscented / converted
    });
    let in_tables = gains.iter().all(|gain| (0.0..LITTLE).contains(gain));
    let part = |path: usize| runs.scenarios[0][path].part(WRAPPED, CONVERTED);
    let unscented_less_converted = |path: usize| runs.scenarios[0][path].difference(WRAPPED, CONVERTED);
    let evidence = format!(
        "Scenario 1: IMM-UKF is better by {:.1} % in table 4 and by {:.1} % in table 5. In the runs, wrapped IMM-UKF less IMM-CMKF: {}.",
        100.0 * gains[0],
        100.0 * gains[1],
        clauses(&[0, 1, 2], |path| format!(
            "{}, {} % of it",
            in_words(unscented_less_converted(path), "%"),
            figure(100.0 * part(path).value)
        )),
    );
    // Better, and by less than a tenth: the part is below 0 and above −0.1.
    let at = |path: usize| {
        let not_much = opposite(less_limit(part(path), -LITTLE));
        all_below_zero(&[unscented_less_converted(path), not_much])
    };
    let verdict = all_of(&[at(0), whichever(&WINDOWS.map(at)), proven_if(in_tables)]);
    s.judgement("sustika2015-a-little-better-without-mismatch", verdict, evidence)
}

pub fn better_with_mismatch(s: &Specification, runs: &RadarEvidence) -> JudgedClaim {
    let [straight, manoeuvring] = [4, 5].map(|table| published(s, table, 2));
    let in_tables = [straight, manoeuvring]
        .iter()
        .all(|[converted, unscented]| converted < unscented);
    let predicted = runs
        .configurations
        .iter()
        .find(|configuration| configuration.choices.chosen("conversion-noise").is_some())
        .map_or_else(String::new, |configuration| {
            let gap = configuration.tables[0][1].difference(CONVERTED, WRAPPED);
            format!(
                " If IMM-CMKF took the converted covariance at the prediction in place of the measurement, its difference without manoeuvres \
                 would be {}: that is where it loses.",
                words(gap, " %")
            )
        });
    let evidence = format!(
        "Scenario 2, IMM-CMKF less IMM-UKF: table 4 {:+.4} %, table 5 {:+.4} %. In the runs: {}.{predicted}",
        straight[0] - straight[1],
        manoeuvring[0] - manoeuvring[1],
        clauses(&[0, 1, 2], |path| wrapped_and_not(&runs.scenarios[1][path])),
    );
    let verdict = all_of(&[
        proven_if(in_tables),
        all_below_zero(&[runs.straight(2).difference(CONVERTED, WRAPPED)]),
        below_zero(&gaps(runs, 2)).verdict(),
    ]);
    s.judgement("sustika2015-better-with-mismatch", verdict, evidence)
}

pub fn bad_in_manoeuvres(s: &Specification, runs: &RadarEvidence) -> JudgedClaim {
    let [converted, unscented] = published(s, 5, 2);
    let of_fifty = |path: usize, filter: usize| {
        let runs = &runs.scenarios[1][path];
        let fit = runs.fit(filter);
        Estimate {
            standard_error: runs.error_of_fifty(fit),
            ..fit
        }
    };
    let margins = [GOOD_FIT_ERROR - converted, unscented - GOOD_FIT_ERROR];
    let in_errors = WINDOWS.map(|path| {
        let least = |filter: usize, margin: f64| margin / of_fifty(path, filter).standard_error;
        least(CONVERTED, margins[0]).min(least(WRAPPED, margins[1]))
    });
    let evidence = format!(
        "Scenario 2, table 5: IMM-CMKF is {:.4} % below the limit of {GOOD_FIT_ERROR} %, IMM-UKF {:.4} % above. In the runs, with the standard error that \
         {RUNS} of them leave: {}. The smaller of the two published margins is {} of such standard errors.",
        margins[0],
        margins[1],
        clauses(&WINDOWS, |path| format!(
            "IMM-CMKF {}, IMM-UKF {} wrapped and {} never wrapped",
            words(of_fifty(path, CONVERTED), " %"),
            words(of_fifty(path, WRAPPED), " %"),
            words(of_fifty(path, PLAIN), " %"),
        )),
        in_errors.map(figure).join(" and "),
    );
    // Two standard errors: less than that is what chance does to one mean in twenty.
    let verdict = confirmed_if(in_errors.iter().all(|margin| *margin > 2.0));
    s.judgement("sustika2015-bad-in-manoeuvres", verdict, evidence)
}

pub fn suitable(s: &Specification, runs: &RadarEvidence) -> JudgedClaim {
    let simulations = || {
        [1, 2]
            .into_iter()
            .flat_map(|scenario| [0, 1, 2].map(|path| (scenario, path)))
    };
    let of = |(scenario, path): (usize, usize)| &runs.scenarios[scenario - 1][path];
    let name = |(scenario, path): (usize, usize)| format!("scenario {scenario} {}", PATHS[path]);
    let larger: Vec<String> = simulations()
        .filter(|&simulation| sign_of(of(simulation).difference(CONVERTED, WRAPPED)) == Some(Ordering::Greater))
        .map(name)
        .collect();
    let above: Vec<String> = simulations()
        .filter(|&simulation| {
            sign_of(less_limit(of(simulation).fit(CONVERTED), GOOD_FIT_ERROR)) != Some(Ordering::Less)
        })
        .map(|simulation| format!("{} {}", name(simulation), words(of(simulation).fit(CONVERTED), " %")))
        .collect();
    let operations =
        [CoastalRadar::Converted, CoastalRadar::Unscented].map(|filter| filter.operations(Sums::FromFirstTerm));
    let listed = |list: &[String]| {
        if list.is_empty() {
            "nowhere".to_owned()
        } else {
            list.join(", ")
        }
    };
    let evidence = format!(
        "Not surely below {GOOD_FIT_ERROR} %: {}. Error certainly larger than that of wrapped IMM-UKF: {}. Operations of a cycle, every matrix taken to be full: {} \
         against {}. The data of the paper are simulated; there is no radar in it.",
        listed(&above),
        listed(&larger),
        operations[0],
        operations[1],
    );
    let below = simulations().map(|simulation| less_limit(of(simulation).fit(CONVERTED), GOOD_FIT_ERROR));
    let good = all_below_zero(&below.collect::<Vec<Estimate>>());
    let parts = [
        good,
        confirmed_if(larger.is_empty()),
        proven_if(operations[0] < operations[1]),
    ];
    s.judgement("sustika2015-suitable", all_of(&parts), evidence)
}
