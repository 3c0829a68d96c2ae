//! Section 5.2: scenarios 1 and 2 on the trajectory with manoeuvres.
//!
//! Table 1 seems to have the times of the manoeuvres the wrong way round. With the noises of scenario 2, these times decide which filter
//! is better.

use super::evidence::{
    CONVERTED, PLAIN, RadarEvidence, Runs, WINDOWS, WRAPPED, clauses, less_limit, opposite, published, words,
};
use super::straight::wrapped_and_not;
use crate::paper::specification::Specification;
use crate::paper::verdict::{JudgedClaim, Tally, Verdict, all_of, below_zero, in_words, proven_if};
use crate::statistics::Estimate;
use crate::statistics::estimate::figure;

/// IMM-CMKF less wrapped IMM-UKF in either window.
pub fn gaps(runs: &RadarEvidence, scenario: usize) -> [Estimate; 2] {
    runs.manoeuvring(scenario)
        .map(|runs| runs.difference(CONVERTED, WRAPPED))
}

pub fn better_when_manoeuvring(s: &Specification, runs: &RadarEvidence) -> JudgedClaim {
    let rows = [1, 2].map(|scenario| published(s, 5, scenario));
    let in_table = rows.iter().all(|[converted, unscented]| converted < unscented);
    let of = |scenario: usize| clauses(&WINDOWS, |path| wrapped_and_not(&runs.scenarios[scenario - 1][path]));
    let evidence = format!(
        "Table 5, IMM-CMKF less IMM-UKF: {:+.4} % in scenario 1, {:+.4} % in scenario 2. In the runs: scenario 1, {}; scenario 2, {}.",
        rows[0][0] - rows[0][1],
        rows[1][0] - rows[1][1],
        of(1),
        of(2),
    );
    let verdict = all_of(&[
        proven_if(in_table),
        below_zero(&gaps(runs, 1)).verdict(),
        below_zero(&gaps(runs, 2)).verdict(),
    ]);
    s.judgement("sustika2015-better-when-manoeuvring", verdict, evidence)
}

pub fn large_error_in_manoeuvres(s: &Specification, runs: &RadarEvidence) -> JudgedClaim {
    let gap = |runs: &Runs, filter: usize| runs.manoeuvre_less_rest(filter);
    let evidence = format!(
        "Scenario 1, root mean square position error in the steps of constant acceleration less that in the others: {}. That depends on where \
         the target is, too: far from the radar a degree is more metres.",
        clauses(&WINDOWS, |path| {
            let runs = &runs.scenarios[0][path];
            format!(
                "IMM-CMKF {} and wrapped IMM-UKF {}",
                in_words(gap(runs, CONVERTED), "m"),
                in_words(gap(runs, WRAPPED), "m")
            )
        }),
    );
    let tallies =
        [CONVERTED, WRAPPED].map(|filter| below_zero(&runs.manoeuvring(1).map(|runs| opposite(gap(runs, filter)))));
    let verdict = all_of(&tallies.map(Tally::verdict));
    let claim = s.judgement("sustika2015-large-error-in-manoeuvres", verdict, evidence);
    claim.over(tallies[0].and(tallies[1]))
}

/// Scenario 2 over scenario 1 with manoeuvres, less the same without.
fn hurts_more(runs: &RadarEvidence, path: usize, filter: usize) -> Estimate {
    let [matched, mismatched] = &runs.scenarios;
    mismatched[path].over_less(&matched[path], [&mismatched[0], &matched[0]], filter)
}

pub fn mismatch_hurts_manoeuvres(s: &Specification, runs: &RadarEvidence) -> JudgedClaim {
    let ratio_in = |table: u32, filter: usize| published(s, table, 2)[filter] / published(s, table, 1)[filter];
    let in_table = [0, 1].iter().all(|&filter| ratio_in(5, filter) > ratio_in(4, filter));
    let both = |path: usize| {
        [CONVERTED, WRAPPED]
            .map(|filter| words(runs.scenarios[1][path].over(&runs.scenarios[0][path], filter), ""))
            .join(" and ")
    };
    let evidence = format!(
        "Scenario 2 over scenario 1, IMM-CMKF and IMM-UKF. Tables: {:.2} and {:.2} with manoeuvres, {:.2} and {:.2} without. In the runs, wrapped: {}.",
        ratio_in(5, 0),
        ratio_in(5, 1),
        ratio_in(4, 0),
        ratio_in(4, 1),
        clauses(&[0, 1, 2], both),
    );
    let verdicts = [CONVERTED, WRAPPED]
        .map(|filter| below_zero(&WINDOWS.map(|path| opposite(hurts_more(runs, path, filter)))).verdict());
    let verdict = all_of(&[all_of(&verdicts), proven_if(in_table)]);
    s.judgement("sustika2015-mismatch-hurts-manoeuvres", verdict, evidence)
}

pub fn larger_error_in_figure_3(s: &Specification, runs: &RadarEvidence) -> JudgedClaim {
    let [converted, unscented] = published(s, 5, 2);
    let evidence = format!(
        "Table 5, which is to show it more clearly, has {converted} % for IMM-CMKF and {unscented} % for IMM-UKF, and the sentence after it says \
         that IMM-CMKF is the better one: the paper contradicts itself. In the runs, IMM-CMKF less IMM-UKF: {}: {}.",
        clauses(&WINDOWS, |path| wrapped_and_not(&runs.scenarios[1][path])),
        the_window_decides(&gaps(runs, 2)),
    );
    let verdict = proven_if(converted > unscented);
    s.judgement("sustika2015-larger-error-in-figure-3", verdict, evidence)
}

/// What two differences of the same filters in two windows say together.
pub fn the_window_decides(gaps: &[Estimate; 2]) -> &'static str {
    match below_zero(gaps).verdict() {
        Verdict::DependsOnChoice => "which filter is the better one depends on when the manoeuvres are",
        Verdict::Confirmed => "IMM-CMKF is the better one in both windows",
        Verdict::Refuted => "IMM-UKF is the better one in both windows",
        _ => "the runs do not tell in both windows which filter is the better one",
    }
}

/// "Almost the same": within a fiftieth.
const ALMOST: f64 = 0.02;

pub fn almost_the_same(s: &Specification, runs: &RadarEvidence) -> JudgedClaim {
    let [converted, unscented] = published(s, 5, 1);
    let part = converted / unscented - 1.0;
    let parts = runs.manoeuvring(1).map(|runs| runs.part(CONVERTED, WRAPPED));
    let per_cent = |part: Estimate| Estimate {
        value: 100.0 * part.value,
        standard_error: 100.0 * part.standard_error,
    };
    let evidence = format!(
        "Table 5: IMM-CMKF is off by {:+.2} % of IMM-UKF. In the runs, wrapped: {}. The limit is a fiftieth, 2 %.",
        100.0 * part,
        clauses(&WINDOWS, |path| in_words(per_cent(parts[path - 1]), "% of it")),
    );
    // The amount of the part less the limit.
    let within = parts.map(|part| {
        less_limit(
            Estimate {
                value: part.value.abs(),
                ..part
            },
            ALMOST,
        )
    });
    let tally = below_zero(&within);
    let verdict = all_of(&[tally.verdict(), proven_if(part.abs() < ALMOST)]);
    s.judgement("sustika2015-almost-the-same", verdict, evidence)
        .over(tally)
}

pub fn better_in_scenario_2(s: &Specification, runs: &RadarEvidence) -> JudgedClaim {
    let [converted, unscented] = published(s, 5, 2);
    let of_fifty = |path: usize, other: usize| {
        let runs = &runs.scenarios[1][path];
        runs.error_of_fifty(runs.difference(CONVERTED, other))
    };
    let distances = WINDOWS.map(|path| (converted - unscented).abs() / of_fifty(path, WRAPPED));
    let resolution = |path: usize| {
        let runs = &runs.scenarios[1][path];
        let [a, b] = [CONVERTED, WRAPPED].map(|filter| runs.error_of_fifty(runs.fit(filter)));
        format!(
            "{} paired, {} as two independent means",
            figure(of_fifty(path, WRAPPED)),
            figure((a * a + b * b).sqrt())
        )
    };
    let gaps = gaps(runs, 2);
    let evidence = format!(
        "Table 5: IMM-CMKF less IMM-UKF is {:+.4} %. In the runs: {}: {}. Standard error of such a difference over 50 runs, in %: {}; never \
         wrapped and paired, {}. The gap of table 5 is {} of the paired ones: 50 runs {} tell it.",
        converted - unscented,
        clauses(&WINDOWS, |path| wrapped_and_not(&runs.scenarios[1][path])),
        the_window_decides(&gaps),
        clauses(&WINDOWS, resolution),
        WINDOWS.map(|path| figure(of_fifty(path, PLAIN))).join(" and "),
        distances.map(figure).join(" and "),
        if distances.iter().all(|distance| *distance > 2.0) {
            "could"
        } else {
            "cannot"
        },
    );
    let tally = below_zero(&gaps);
    let verdict = all_of(&[tally.verdict(), proven_if(converted < unscented)]);
    s.judgement("sustika2015-better-in-scenario-2", verdict, evidence)
        .over(tally)
}
