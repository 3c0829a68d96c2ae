//! Goal: a verdict is what its differences say, and a change of a judge shows which figures and which verdicts move.
//!
//! Method: the rules of verdicts by hand, case by case; judges on evidence that says the opposite; then every judge at a few runs, its
//! evidence as a snapshot. Kinds of evidence: exact for the rules and the opposites, snapshots for the rest. A few runs decide little: what
//! the judges find with their own numbers of runs is in `immaculate claims`, and what rests on no runs at all is here as it is there, but
//! for a smaller map of stability.

use immaculate::imm::{Failure, failure::Cause};
use immaculate::paper::derbez2000::relative::{Relative, below, extremes, within};
use immaculate::paper::derbez2000::{arithmetic, claims, long_term, search, stability};
use immaculate::paper::experiment::Experiment;
use immaculate::paper::liu2017::arithmetic::{point_counts, slightly_cheaper, time_proportional_to_points};
use immaculate::paper::liu2017::claims::is_explained;
use immaculate::paper::monte_carlo::run;
use immaculate::paper::simulation::Simulation;
use immaculate::paper::specification::{Choices, Specification, derbez2000, liu2017, zhu2016};
use immaculate::paper::sustika2015::claims::{is_mismatch_the_cause, ratio_less, the_window_decides};
use immaculate::paper::verdict::{
    JudgedClaim, Tally, Verdict, all_below_zero, all_of, below_zero, better_by_a_thousandth, confirmed_if, in_words,
    is_within_a_thousandth, proven_by, proven_if, refuted_by, sign_of, whichever,
};
use immaculate::paper::zhu2016::arithmetic::{all_rmse_smaller, better_than_ckf, load};
use immaculate::paper::{Effort, Paper};
use immaculate::statistics::Estimate;
use immaculate::steady::map::Map;
use immaculate::steady::verdict::Depth;
use nalgebra::Vector4;
use std::cmp::Ordering;
use std::fmt::Write;

// Verdicts

fn estimate(value: f64, standard_error: f64) -> Estimate {
    Estimate { value, standard_error }
}

/// Exact: quarters and whole numbers.
#[test]
fn four_standard_errors_decide_and_less_do_not() {
    for (distance, sign) in [
        (-4.25, Some(Ordering::Less)),
        (-4.0, Some(Ordering::Less)),
        (-3.75, None),
        (0.0, None),
        (3.75, None),
        (4.0, Some(Ordering::Greater)),
        (4.25, Some(Ordering::Greater)),
    ] {
        assert_eq!(sign_of(estimate(2.0 * distance, 2.0)), sign, "{distance}");
    }
    // What is not known decides nothing; what has no spread decides by itself, but for nothing at all.
    assert_eq!(sign_of(estimate(f64::NAN, 1.0)), None);
    assert_eq!(sign_of(estimate(0.0, 0.0)), None);
    assert_eq!(sign_of(estimate(1e-9, 0.0)), Some(Ordering::Greater));
    assert_eq!(
        in_words(estimate(-8.0, 2.0), "m"),
        "-8.000 ± 2.000 m (-4.0 standard errors)"
    );
}

#[test]
fn all_below_zero_needs_all_and_one_above_refutes() {
    let [below, unsure, above] = [-5.0, 1.0, 5.0].map(|value| estimate(value, 1.0));
    for (differences, verdict) in [
        (&[below, below][..], Verdict::Confirmed),
        (&[below, unsure], Verdict::Undecided),
        (&[unsure], Verdict::Undecided),
        (&[below, above], Verdict::Refuted),
        (&[unsure, above], Verdict::Refuted),
    ] {
        assert_eq!(all_below_zero(differences), verdict, "{differences:?}");
    }
    // Where one of them is meant and not said which, what they say together counts.
    for (differences, verdict) in [
        (&[below, below][..], Verdict::Confirmed),
        (&[above, above], Verdict::Refuted),
        (&[unsure, unsure], Verdict::Undecided),
        (&[below, above], Verdict::DependsOnChoice),
        (&[below, unsure, above], Verdict::DependsOnChoice),
        (&[below, unsure], Verdict::Undecided),
        (&[above, unsure], Verdict::Undecided),
    ] {
        assert_eq!(below_zero(differences).verdict(), verdict, "{differences:?}");
    }
}

#[test]
fn verdicts_are_put_together_by_their_worst_or_by_what_they_share() {
    use Verdict::{Confirmed, DependsOnChoice, Proven, Refuted, Undecided};
    for (verdicts, together, any) in [
        (&[Proven, Proven][..], Proven, Proven),
        (&[Confirmed, Proven], Confirmed, Confirmed),
        (&[Proven, Confirmed], Proven, Confirmed),
        (&[Confirmed, Refuted], Refuted, DependsOnChoice),
        (&[DependsOnChoice, Undecided, Refuted], Refuted, Undecided),
        (&[Confirmed, DependsOnChoice, Undecided], Undecided, Undecided),
        (&[Proven, DependsOnChoice], DependsOnChoice, Undecided),
        (&[], Undecided, Undecided),
    ] {
        assert_eq!(all_of(verdicts), together, "{verdicts:?}");
        assert_eq!(whichever(verdicts), any, "{verdicts:?}");
    }
    assert_eq!([true, false].map(proven_if), [Proven, Refuted]);
    assert_eq!([true, false].map(confirmed_if), [Confirmed, Refuted]);
    let words = Verdict::ALL.map(Verdict::words);
    assert_eq!(
        words,
        [
            "proven",
            "confirmed",
            "refuted",
            "depends on a choice",
            "not reached",
            "never published",
            "undecided"
        ]
    );
}

/// Better by more than a thousandth of 1000 m, which is a metre, with four standard errors to spare.
#[test]
fn better_means_better_by_a_thousandth() {
    for (difference, standard_error, verdict) in [
        (-5.25, 1.0, Verdict::Confirmed),
        (-4.75, 1.0, Verdict::Undecided),
        (-1.0, 0.25, Verdict::Undecided),
        (2.75, 1.0, Verdict::Undecided),
        (3.25, 1.0, Verdict::Refuted),
        (0.0, 0.0, Verdict::Refuted),
        // Exactly as much is neither more nor less.
        (-1.0, 0.0, Verdict::Undecided),
    ] {
        let found = better_by_a_thousandth(estimate(difference, standard_error), estimate(1000.0, 9.0));
        assert_eq!(found, verdict, "{difference} ± {standard_error}");
    }
}

/// Exact: a thousandth of 1000 m is a metre, and four times an eighth is a half.
#[test]
fn no_difference_is_certainly_less_than_a_thousandth_either_way() {
    for (difference, is_within) in [(0.0, true), (0.25, true), (-0.25, true), (0.5, false), (-0.75, false)] {
        let found = is_within_a_thousandth(estimate(difference, 0.125), estimate(1000.0, 9.0));
        assert_eq!(found, is_within, "{difference}");
    }
}

#[test]
fn what_does_not_come_out_shows_nothing() {
    assert_eq!([true, false].map(proven_by), [Verdict::Proven, Verdict::Undecided]);
    assert_eq!([true, false].map(refuted_by), [Verdict::Refuted, Verdict::Undecided]);
}

/// Exact: a published range of 8, which a configuration has, or of which chance is a fourth.
#[test]
fn a_range_is_explained_by_a_configuration_or_by_chance() {
    for (widest, standard_deviation, is_reached) in [
        (8.0, 0.0, true),
        (7.5, 2.0, true),
        (7.5, 1.75, false),
        (8.5, 1.75, true),
        (8.5, 2.25, true),
    ] {
        let found = is_explained(8.0, widest, standard_deviation);
        assert_eq!(found, is_reached, "{widest}, {standard_deviation}");
    }
}

/// Exact: over three times the paper's hundred runs its figure has √3 of the standard error of ours, so that both have twice ours.
#[test]
fn a_published_figure_is_met_within_four_standard_errors_of_both() {
    for (published, is_one) in [(17.75, true), (18.0, false), (2.25, true), (2.0, false)] {
        assert_eq!(
            search::is_met(published, estimate(10.0, 1.0), 300),
            is_one,
            "{published}"
        );
    }
}

/// Exact: two figures that are rounded to thousandths leave their difference a thousandth, and only that is added.
#[test]
fn a_difference_of_published_figures_is_met_within_their_rounding() {
    for (published, is_one) in [(10.001, true), (9.999, true), (10.0011, false), (9.9989, false)] {
        assert_eq!(
            search::is_difference_met(published, estimate(10.0, 1e-9), 300),
            is_one,
            "{published}"
        );
    }
}

/// Numbers of divergent runs of IMM-CMKF, IMM-UKF wrapped and never wrapped.
#[test]
fn wrapping_and_matching_noises_tell_the_cause_of_divergence() {
    for (matched, all, verdict) in [
        // Wrapping ends it, and runs diverge where noises match.
        ([0, 0, 1], [0, 2, 20], Verdict::Refuted),
        ([0, 0, 1], [9, 3, 20], Verdict::Undecided),
        ([0, 0, 0], [0, 2, 20], Verdict::Undecided),
        // Wrapping does not help, and where noises match none diverges that wraps.
        ([0, 0, 0], [0, 20, 20], Verdict::Confirmed),
        ([0, 0, 1], [0, 20, 20], Verdict::Confirmed),
        ([0, 1, 1], [0, 20, 20], Verdict::Undecided),
        ([0, 0, 0], [0, 19, 20], Verdict::Undecided),
        // None at all.
        ([0, 0, 0], [0, 0, 0], Verdict::Undecided),
    ] {
        assert_eq!(is_mismatch_the_cause(matched, all), verdict, "{matched:?} {all:?}");
    }
}

#[test]
fn two_windows_say_which_filter_is_the_better_one_or_that_they_decide() {
    let [less, more, neither] = [-8.0, 8.0, 0.0].map(|difference| estimate(difference, 1.0));
    for (gaps, words) in [
        ([less, less], "IMM-CMKF is the better one in both windows"),
        ([more, more], "IMM-UKF is the better one in both windows"),
        (
            [less, more],
            "which filter is the better one depends on when the manoeuvres are",
        ),
        (
            [less, neither],
            "the runs do not tell in both windows which filter is the better one",
        ),
    ] {
        assert_eq!(the_window_decides(&gaps), words);
    }
}

/// By hand: ratios 2 and ½ of three runs, which add (½, −½, 0) to the first and nothing to the second. 10⁻¹⁵: the root of a third.
#[test]
fn two_ratios_of_the_same_runs_differ_with_the_error_of_their_difference() {
    let equal = [(2.0, 4.0); 3];
    let varied = [(10.0, 4.0), (6.0, 4.0), (8.0, 4.0)];
    let half = 0.5 / 3.0_f64.sqrt();
    for (pairs, others, value, error) in [
        (&varied, &equal, 1.5_f64, half),
        (&equal, &varied, -1.5, half),
        (&varied, &varied, 0.0, 0.0),
    ] {
        let found = ratio_less(pairs, others);
        assert!((found.value - value).abs() < 1e-15, "{found:?}");
        assert!((found.standard_error - error).abs() < 1e-15, "{found:?}");
    }
}

/// Exact: a limit of ½, and parts that are certain to within four times an eighth.
#[test]
fn a_configuration_counts_where_its_bounds_are_on_one_side_of_the_limit() {
    let tally = |count: fn(&[Relative], f64) -> Tally, value: f64, standard_error: f64| {
        let one = Relative {
            choices: String::new(),
            difference: estimate(value, standard_error),
        };
        let Tally {
            holds,
            fails,
            uncertain,
        } = count(&[one], 0.5);
        [holds, fails, uncertain]
    };
    let (holds, fails, neither) = ([1, 0, 0], [0, 1, 0], [0, 0, 1]);
    for (value, standard_error, is_within, is_below) in [
        (0.0, 0.0625, holds, holds),
        (0.0, 0.125, neither, neither),
        (0.0, 0.25, neither, neither),
        (0.375, 0.0625, neither, neither),
        (-0.375, 0.0625, neither, holds),
        (0.5, 0.0, neither, neither),
        (-0.5, 0.0, neither, holds),
        (1.0, 0.125, neither, neither),
        (1.25, 0.125, fails, fails),
        (-1.25, 0.125, fails, holds),
        (-1.0, 0.125, neither, holds),
    ] {
        assert_eq!(
            tally(within, value, standard_error),
            is_within,
            "within: {value} ± {standard_error}"
        );
        assert_eq!(
            tally(below, value, standard_error),
            is_below,
            "below: {value} ± {standard_error}"
        );
    }
    let of = |holds, fails, uncertain| Tally {
        holds,
        fails,
        uncertain,
    };
    assert_eq!(of(1, 2, 3).and(of(10, 20, 30)), of(11, 22, 33));
    assert_eq!(
        of(11, 22, 33).words(),
        "It holds in 11 of 66 configurations, fails in 22, and is uncertain in 33."
    );
    assert_eq!(
        of(46, 2, 0).words(),
        "It holds in 46 of 48 configurations, and fails in 2."
    );
    for (tally, verdict) in [
        (of(2, 0, 0), Verdict::Confirmed),
        (of(0, 2, 0), Verdict::Refuted),
        (of(0, 2, 1), Verdict::Undecided),
        (of(2, 0, 1), Verdict::Undecided),
        (of(0, 0, 1), Verdict::Undecided),
        (of(0, 0, 0), Verdict::Undecided),
        (of(1, 1, 0), Verdict::DependsOnChoice),
        (of(1, 1, 1), Verdict::DependsOnChoice),
    ] {
        assert_eq!(tally.verdict(), verdict, "{tally:?}");
    }
}

#[test]
fn the_extremes_are_named_with_their_configurations() {
    let one = |choices: &str, value: f64| Relative {
        choices: choices.into(),
        difference: estimate(value, 0.01),
    };
    let all = [one("first", 0.125), one("second", -0.5), one("third", 0.25)];
    assert_eq!(
        extremes(&all),
        "12.50 ± 1.000 % (first); from -50.00 ± 1.000 % (second) to 25.00 ± 1.000 % (third) over 3 configurations"
    );
    assert_eq!(extremes(&[]), "");
}

#[test]
fn an_experiment_is_bounded_where_no_run_fails_and_none_reaches_the_limit() {
    let mut scenario = Paper::Zhu2016.scenario(&Choices::default()).unwrap();
    scenario.contestants.truncate(1);
    let runs = run(&scenario, 2, 1, &|| ());
    let mut experiment = Experiment { scenario, runs };
    let errors = experiment.runs.iter().flat_map(|run| &run[0].errors);
    let greatest = errors.map(|error| (error[0] * error[0] + error[2] * error[2]).sqrt());
    let greatest = greatest.fold(0.0, f64::max);
    let (is_below, words) = experiment.stays_within(greatest.next_up());
    assert!(
        is_below && words.contains("(4 expected)") && words.contains("; no run fails and none reaches"),
        "{words}"
    );
    // The limit itself is reached.
    let (is_below, words) = experiment.stays_within(greatest);
    assert!(!is_below && words.contains("; a run fails or reaches"), "{words}");
    assert_eq!(experiment.failures(0), 0);
    experiment.runs[1][0].failure = Some(Failure {
        step: 100,
        mode: "left turn".into(),
        value: "measurement",
        cause: Cause::MeasurementNotFinite,
    });
    assert_eq!(
        (experiment.failures(0), experiment.stays_within(f64::INFINITY).0),
        (1, false)
    );
}

#[test]
fn a_judgement_has_the_words_of_its_claim() {
    for claim in &zhu2016().claims {
        let judgement = zhu2016().judgement(&claim.id, Verdict::Undecided, "evidence".into());
        let JudgedClaim {
            id,
            quote,
            place,
            question,
            verdict,
            configurations,
            evidence,
        } = judgement;
        assert_eq!(
            [&id, &quote, &place, &question],
            [&claim.id, &claim.quote, &claim.place, &claim.question]
        );
        assert_eq!((verdict, evidence.as_str()), (Verdict::Undecided, "evidence"));
        assert_eq!(configurations, None);
    }
}

// The ledgers

/// Three runs: a standard error, and as few as it takes.
const EFFORT: Effort = Effort { runs: Some(3), seed: 1 };

/// Verdict, claim and evidence, a line a sentence or a clause, so that a figure that moves is one line.
fn ledger(judgements: &[JudgedClaim]) -> String {
    let mut text = String::new();
    for judgement in judgements {
        let words: Vec<&str> = judgement.evidence.split(' ').map(without_rounding).collect();
        let lines = words.join(" ").replace("; ", ";\n  ").replace(". ", ".\n  ");
        let _ = writeln!(
            text,
            "{}: {}\n  {}\n  {}",
            judgement.id,
            judgement.verdict.words(),
            judgement.answer(),
            lines.trim_end()
        );
    }
    text
}

/// What is only rounding would be another number after another order of a sum; it is named instead.
fn without_rounding(word: &str) -> &str {
    let number = word.trim_end_matches([',', ';', '.', ')']).parse::<f64>();
    // Figures of the papers and of the runs are above a millionth, roundings of kilometres some 10⁻¹².
    match number {
        Ok(number) if number != 0.0 && number.abs() < 1e-9 => "(rounding)",
        _ => word,
    }
}

#[test]
fn the_ledger_of_zhu2016() {
    insta::assert_snapshot!(ledger(&Paper::Zhu2016.judge(EFFORT, &|| ()).unwrap()));
}

#[test]
fn the_ledger_of_liu2017() {
    insta::assert_snapshot!(ledger(&Paper::Liu2017.judge(EFFORT, &|| ()).unwrap()));
}

#[test]
fn the_ledger_of_sustika2015() {
    // More of them, from a seed with runs that diverge: what is counted of these is to be seen.
    let effort = Effort {
        runs: Some(20),
        seed: 3,
    };
    insta::assert_snapshot!(ledger(&Paper::Sustika2015.judge(effort, &|| ()).unwrap()));
}

#[test]
fn what_runs_say_of_derbez2000() {
    let s = derbez2000();
    let runs = claims::CoordinateEvidence::new(EFFORT, &|| ()).unwrap();
    insta::assert_snapshot!(ledger(&[
        claims::almost_as_well(s, &runs),
        claims::minor_covariance_changes(s, &runs, EFFORT),
        claims::sluggish_onset(s, &runs),
        claims::cartesian_filtering(s, EFFORT, &|| ()).unwrap(),
        claims::equal_on_acceleration(s, &runs),
        claims::thirty_per_cent(s, &runs),
        claims::full_imm_much_better(s, &runs),
        claims::third_set_supports(s, &runs),
    ]));
}

#[test]
fn what_arithmetic_says_of_derbez2000() {
    let s = derbez2000();
    insta::assert_snapshot!(ledger(&[
        arithmetic::constant_bounded_error(s),
        arithmetic::moment_matching_bound(s),
        arithmetic::moment_matching_size(s),
        arithmetic::nonlinear_filters(s),
        arithmetic::table_arithmetic(s),
        arithmetic::operation_counts(s),
        long_term::half_the_load(s),
        long_term::proposition(s),
    ]));
}

#[test]
fn what_small_filters_say_of_the_stability_of_derbez2000() {
    let s = derbez2000();
    insta::assert_snapshot!(ledger(&[
        stability::theorem(s),
        stability::prior_data_discounted(s),
        stability::convex_combination(s),
        stability::stable_unmixed(s),
        stability::stable_mixed(s),
        stability::local_instability(s),
    ]));
}

#[test]
fn what_a_small_map_says_of_the_stability_of_derbez2000() {
    let depth = Depth {
        word: 6,
        run: 6,
        memory: 1,
    };
    let (s, map) = (derbez2000(), Map::new(5, [-2.0, 2.0], depth, &|| ()));
    insta::assert_snapshot!(ledger(&[
        stability::stability_matrices(s, &map),
        stability::stable_mixed_unequal_noises(s, &map),
    ]));
}

#[test]
fn how_accurate_the_algorithm_of_derbez2000_is() {
    insta::assert_snapshot!(ledger(&[long_term::algorithm_accuracy(derbez2000(), EFFORT)]));
}

#[test]
fn how_near_a_search_comes_to_table_1_of_derbez2000() {
    insta::assert_snapshot!(ledger(&[search::table_1_reachable(derbez2000(), EFFORT, &|| ())]));
}

// The opposite evidence

/// A specification with a figure of a published table changed.
fn with_figure(s: &Specification, table: usize, row: &str, column: usize, value: f64) -> Specification {
    let mut changed = s.clone();
    let rows = &mut changed.tables[table].rows;
    let row = rows.iter_mut().find(|other| other.name.starts_with(row)).unwrap();
    row.values[column] = value;
    changed
}

/// Exact: each judge of a published table, on the table and on one that says the opposite.
#[test]
fn a_judge_of_a_table_follows_the_table() {
    let zhu = zhu2016();
    assert_eq!(all_rmse_smaller(zhu).verdict, Verdict::Refuted);
    let first_is_smallest = with_figure(zhu, 0, "RMSE_X", 0, 2.0);
    let judgement = all_rmse_smaller(&first_is_smallest);
    assert_eq!(judgement.verdict, Verdict::Proven, "{}", judgement.evidence);
    // A figure that is the same is not larger.
    let same = all_rmse_smaller(&with_figure(&first_is_smallest, 0, "RMSE_X", 1, 2.0));
    assert_eq!(same.verdict, Verdict::Refuted, "{}", same.evidence);

    // Of the load, more points and a longer time: here the time is shorter, or the same.
    assert_eq!(load(zhu).verdict, Verdict::Proven);
    let time = |column: usize| zhu.tables[0].rows.iter().find(|row| row.name == "Time").unwrap().values[column];
    for shorter in [time(1) / 2.0, time(1)] {
        assert_eq!(
            load(&with_figure(zhu, 0, "Time", 0, shorter)).verdict,
            Verdict::Refuted,
            "{shorter}"
        );
    }
    assert_eq!(better_than_ckf(zhu).verdict, Verdict::NeverPublished);
    let mut with_ckf = zhu.clone();
    with_ckf.tables[0].columns[4] = "CKF".to_owned();
    assert_eq!(better_than_ckf(&with_ckf).verdict, Verdict::Undecided);

    let liu = liu2017();
    assert_eq!(point_counts(liu).verdict, Verdict::Proven);
    assert_eq!(
        point_counts(&with_figure(liu, 1, "Number of Points", 2, 25.0)).verdict,
        Verdict::Refuted
    );
    assert_eq!(time_proportional_to_points(liu).verdict, Verdict::Refuted);
    let points = &liu.tables[1]
        .rows
        .iter()
        .find(|row| row.name.starts_with("Number of Points"))
        .unwrap()
        .values;
    let proportional = (0..4).fold(liu.clone(), |s, column| {
        with_figure(&s, 1, "Computational Time", column, points[column] / 128.0)
    });
    let judgement = time_proportional_to_points(&proportional);
    assert_eq!(judgement.verdict, Verdict::Proven);
    // Whole numbers of points over a power of two: the straight line through the origin, exactly.
    assert!(
        judgement
            .evidence
            .contains("is 0 s + 0.007812 s a point: 0 % of the time"),
        "{}",
        judgement.evidence
    );
    // A fifth more for one of them is too much, a sixth is not.
    for (factor, verdict) in [(1.25, Verdict::Refuted), (1.125, Verdict::Proven)] {
        let one_is_slower = with_figure(&proportional, 1, "Computational Time", 0, factor * points[0] / 128.0);
        assert_eq!(time_proportional_to_points(&one_is_slower).verdict, verdict, "{factor}");
    }
    assert_eq!(slightly_cheaper(liu).verdict, Verdict::Proven);
    let fifth = liu.tables[1]
        .rows
        .iter()
        .find(|row| row.name.starts_with("Computational Time"))
        .unwrap()
        .values[2];
    for time in [fifth, 2.0 * fifth] {
        let judgement = slightly_cheaper(&with_figure(liu, 1, "Computational Time", 3, time));
        assert_eq!(judgement.verdict, Verdict::Refuted, "{time}");
    }

    let derbez = derbez2000();
    assert_eq!(arithmetic::table_arithmetic(derbez).verdict, Verdict::Refuted);
    let repaired = with_figure(derbez, 0, "x-RMS", 1, 1.213);
    let judgement = arithmetic::table_arithmetic(&repaired);
    assert_eq!(judgement.verdict, Verdict::Proven, "{}", judgement.evidence);
    let spoilt = with_figure(&repaired, 1, "Overall", 2, 1.0);
    assert_eq!(arithmetic::table_arithmetic(&spoilt).verdict, Verdict::Refuted);
    assert_eq!(arithmetic::operation_counts(derbez).verdict, Verdict::Refuted);
}

/// The runs of derbez2000 with the same error of a filter in x and y at every step of every run: a difference that is certain.
fn with_errors(runs: &claims::CoordinateEvidence, errors: &[(usize, f64)]) -> claims::CoordinateEvidence {
    let mut runs = runs.clone();
    for experiment in runs.manoeuvres.iter_mut().chain(&mut runs.acceleration) {
        for run in &mut experiment.runs {
            for (filter, error) in errors {
                run[*filter].errors.fill(Vector4::new(*error, 0.0, *error, 0.0));
            }
        }
    }
    runs
}

/// Exact, but for roundings that are far from the limits: errors that are certain parts of each other, on both sides of each limit.
#[test]
fn a_judge_of_derbez2000_follows_the_runs() {
    let s = derbez2000();
    let runs = claims::CoordinateEvidence::new(EFFORT, &|| ()).unwrap();
    // IMM, fixed gain, constant acceleration, the other reading of the second, and the first without the spread.
    let [imm, fixed, single, other, without] = [0, 1, 2, 3, 4];
    let (confirmed, refuted) = (Verdict::Confirmed, Verdict::Refuted);
    for (chosen, other_reading, verdict) in [
        (1.09, 1.09, confirmed),
        (0.5, 1.0, confirmed),
        (1.11, 1.11, refuted),
        // One reading is nearly as good and the other is not.
        (1.09, 1.11, Verdict::DependsOnChoice),
    ] {
        let runs = with_errors(&runs, &[(imm, 1.0), (fixed, chosen), (other, other_reading)]);
        let almost = claims::almost_as_well(s, &runs);
        assert_eq!(almost.verdict, verdict, "{chosen}: {}", almost.evidence);
    }
    for (error, verdict) in [(1.09, confirmed), (0.91, confirmed), (0.89, refuted), (1.11, refuted)] {
        let runs = with_errors(&runs, &[(imm, 1.0), (without, error)]);
        let minor = claims::minor_covariance_changes(s, &runs, EFFORT);
        assert_eq!(minor.verdict, verdict, "{error}: {}", minor.evidence);
    }
    for (error, verdict) in [
        (1.009, confirmed),
        (0.991, confirmed),
        (0.989, refuted),
        (1.011, refuted),
    ] {
        let runs = with_errors(&runs, &[(single, 1.0), (imm, error), (fixed, error), (other, error)]);
        let equal = claims::equal_on_acceleration(s, &runs);
        assert_eq!(equal.verdict, verdict, "{error}: {}", equal.evidence);
    }
    for (error, verdict) in [(0.89, confirmed), (0.91, refuted), (1.2, refuted)] {
        let runs = with_errors(&runs, &[(imm, error), (fixed, 1.0), (single, 1.0)]);
        let better = claims::full_imm_much_better(s, &runs);
        assert_eq!(better.verdict, verdict, "{error}: {}", better.evidence);
    }
    // The table itself has no thirty per cent; of one that has them, the runs are asked.
    let generous = with_figure(s, 0, "y-RMS", fixed, 0.2);
    for (error, verdict) in [(0.69, confirmed), (0.71, refuted)] {
        let runs = with_errors(&runs, &[(single, 1.0), (fixed, error)]);
        assert_eq!(claims::thirty_per_cent(&generous, &runs).verdict, verdict, "{error}");
        assert_eq!(claims::thirty_per_cent(s, &runs).verdict, refuted);
    }
}

/// Filters that are certain, in either coordinate, of what the target did some steps before.
#[test]
fn a_judge_of_delays_follows_the_mode_probabilities() {
    let runs = claims::CoordinateEvidence::new(EFFORT, &|| ()).unwrap();
    for ([imm, fixed], verdict) in [
        ([1, 2], Verdict::Confirmed),
        ([2, 1], Verdict::Refuted),
        ([2, 2], Verdict::Undecided),
    ] {
        let mut runs = runs.clone();
        for experiment in &mut runs.manoeuvres {
            let accelerates = [0, 1].map(|c| experiment.scenario.accelerates(c));
            for run in &mut experiment.runs {
                for (filter, steps) in [(0, imm), (1, fixed)] {
                    for (k, probabilities) in run[filter].mode_probabilities.iter_mut().enumerate() {
                        let believed = |c: usize| accelerates[c][k.saturating_sub(steps)];
                        let certain = |c: usize| if believed(c) { [0.0, 1.0] } else { [1.0, 0.0] };
                        *probabilities = [certain(0), certain(1)].concat();
                    }
                }
            }
        }
        let judgement = claims::sluggish_onset(derbez2000(), &runs);
        assert_eq!(judgement.verdict, verdict, "{}", judgement.evidence);
    }
}

/// Two contestants in each other's place.
fn exchanged(experiment: &Experiment, a: usize, b: usize) -> Experiment {
    let mut exchanged = experiment.clone();
    for run in &mut exchanged.runs {
        run.swap(a, b);
    }
    exchanged
}

/// A filter that is certain, at each step, of what the target did some steps before.
fn late(experiment: &Experiment, filter: usize, steps: usize) -> Experiment {
    let mut late = experiment.clone();
    let (motions, filters) = (experiment.scenario.motions(), experiment.scenario.filters());
    for run in &mut late.runs {
        for (k, probabilities) in run[filter].mode_probabilities.iter_mut().enumerate() {
            let believed = motions[k.saturating_sub(steps)];
            *probabilities = filters[filter]
                .modes
                .iter()
                .map(|mode| f64::from(u8::from(mode == believed)))
                .collect();
        }
    }
    late
}

/// One position error of one run, m.
fn with_error(experiment: &Experiment, metres: f64) -> Experiment {
    let mut far = experiment.clone();
    far.runs[1][2].errors[7] = Vector4::new(metres, 0.0, 0.0, 0.0);
    far
}

#[test]
fn a_judge_of_zhu2016_follows_the_runs() {
    use immaculate::paper::zhu2016::claims::{
        better_than_single_model, captures_switches, columns_differ_range_bearing, imm_beats_single_model,
        linear_accuracy, negative_weights_diverge, no_divergence, nonlinear_filters_better_than_omtm,
        single_model_worst, switching_sensitivity, with_kalman_filter,
    };
    type Judge<E> = fn(&Specification, &E) -> JudgedClaim;
    let s = zhu2016();
    let printed = Experiment::new(with_kalman_filter().unwrap(), EFFORT, &|| ());
    // The filter of one model, instead of one with three, is another filter.
    let [first, third_degree, unscented, single] = [0, 1, 2, 3];
    for (judge, filter) in [
        (linear_accuracy as Judge<Experiment>, first),
        (switching_sensitivity, first),
        (nonlinear_filters_better_than_omtm, first),
        (negative_weights_diverge, unscented),
    ] {
        let (as_it_is, other) = (judge(s, &printed), judge(s, &exchanged(&printed, filter, single)));
        assert_eq!(as_it_is.verdict, Verdict::Refuted, "{}", as_it_is.evidence);
        assert_eq!(other.verdict, Verdict::Confirmed, "{}", other.evidence);
    }
    let of = |parameter: &str, alternative: &str| {
        let scenario = Paper::Zhu2016.scenario(&Choices::of(parameter, alternative)).unwrap();
        Experiment::new(scenario, EFFORT, &|| ())
    };
    let models = [
        "constant-velocity",
        "coordinated-turn",
        "left-turn",
        "constant-velocity-ten-times-noise",
    ];
    let as_it_is = models.map(|model| of("single-model", model));
    // Every one of the models of the filter is asked about.
    for (place, model) in models[..3].iter().enumerate() {
        let mut one = as_it_is.clone();
        one[place] = exchanged(&one[place], first, single);
        let judgement = imm_beats_single_model(s, &one);
        assert_eq!(judgement.verdict, Verdict::Refuted, "{model}: {}", judgement.evidence);
    }
    let other_way = models.map(|model| exchanged(&of("single-model", model), first, single));
    for judge in [
        better_than_single_model as Judge<[Experiment; 4]>,
        imm_beats_single_model,
        single_model_worst,
    ] {
        let judgement = judge(s, &other_way);
        assert_eq!(judgement.verdict, Verdict::Refuted, "{}", judgement.evidence);
    }
    let polar = ["range-bearing", "range-bearing-coarse"].map(|alternative| of("measurement", alternative));
    let other = polar
        .each_ref()
        .map(|experiment| exchanged(experiment, third_degree, single));
    assert_eq!(columns_differ_range_bearing(s, &polar).verdict, Verdict::Refuted);
    assert_eq!(columns_differ_range_bearing(s, &other).verdict, Verdict::Confirmed);
    // Three seconds are in time, four are not; ten times √1000 m are too far.
    let noticed = [0, 3, 4].map(|steps| captures_switches(s, &late(&printed, first, steps)).verdict);
    assert_eq!(noticed, [Verdict::Confirmed, Verdict::Confirmed, Verdict::Refuted]);
    let far = [316.0, 316.3].map(|metres| no_divergence(s, &with_error(&printed, metres)).verdict);
    assert_eq!(far, [Verdict::Confirmed, Verdict::Refuted]);
}

#[test]
fn a_judge_of_liu2017_follows_the_runs() {
    use immaculate::paper::liu2017::claims::{
        better_accuracy, constant_velocity, fifth_degree_switching, higher_accuracy_than_fifth_degree, no_divergence,
        outperforms_in_manoeuvres, quicker_switching,
    };
    let s = liu2017();
    let scenario = Paper::Liu2017.scenario(&Choices::default()).unwrap();
    let printed = Experiment::new(scenario, EFFORT, &|| ());
    let proposed = 3;
    // All others with the errors of the proposed filter, times a factor.
    let times = |factor: f64| {
        let mut scaled = printed.clone();
        for run in &mut scaled.runs {
            for filter in 0..proposed {
                run[filter].errors = run[proposed].errors.iter().map(|error| error * factor).collect();
            }
        }
        scaled
    };
    for (factor, better, same) in [
        (2.0, Verdict::Confirmed, Verdict::Refuted),
        (1.0, Verdict::Refuted, Verdict::Confirmed),
        (1.0005, Verdict::Refuted, Verdict::Confirmed),
        (0.5, Verdict::Refuted, Verdict::Refuted),
    ] {
        let runs = times(factor);
        for judgement in [
            better_accuracy(s, &runs, std::slice::from_ref(&runs)),
            outperforms_in_manoeuvres(s, &runs),
            higher_accuracy_than_fifth_degree(s, &runs),
        ] {
            assert_eq!(judgement.verdict, better, "{factor}: {}", judgement.evidence);
        }
        let judgement = constant_velocity(s, &runs);
        assert_eq!(judgement.verdict, same, "{factor}: {}", judgement.evidence);
    }
    // What holds at one initial covariance and not at another depends on what is not printed.
    let (better, worse) = (times(2.0), times(0.5));
    let judgement = better_accuracy(s, &better, std::slice::from_ref(&worse));
    assert_eq!(judgement.verdict, Verdict::DependsOnChoice, "{}", judgement.evidence);
    // The delays of the four filters, in steps of a second.
    for (delays, quicker, fifth_degree) in [
        ([2, 2, 2, 1], Verdict::Confirmed, Verdict::Refuted),
        ([2, 2, 1, 1], Verdict::Refuted, Verdict::Confirmed),
        ([2, 1, 1, 1], Verdict::Refuted, Verdict::Refuted),
        ([2, 2, 2, 2], Verdict::Refuted, Verdict::Refuted),
        ([1, 1, 2, 2], Verdict::Refuted, Verdict::Refuted),
    ] {
        let runs = (0..4).fold(printed.clone(), |runs, filter| late(&runs, filter, delays[filter]));
        assert_eq!(quicker_switching(s, &runs).verdict, quicker, "{delays:?}");
        assert_eq!(fifth_degree_switching(s, &runs).verdict, fifth_degree, "{delays:?}");
    }
    // Ten times 39.4 km · 7 mrad are 2758 m.
    let far = [2757.0, 2759.0].map(|metres| no_divergence(s, &with_error(&printed, metres)).verdict);
    assert_eq!(far, [Verdict::Confirmed, Verdict::Refuted]);
}
