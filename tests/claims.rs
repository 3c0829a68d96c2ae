//! Goal: a verdict is what its differences say, and whoever changes a judge sees which figures and which verdicts move.
//!
//! Method: the rules of verdicts by hand, case by case; then every judge at three runs, its evidence as a snapshot. Kinds of evidence:
//! exact for the rules, snapshots for the judges. Three runs decide little: what the judges find with their own numbers of runs is in
//! `immaculate claims`, and what rests on no runs at all is here as it is there, but for a smaller map of stability.

use immaculate::imm::{Failure, cycle::Cause};
use immaculate::paper::derbez2000::relative::{Relative, Tally, extremes};
use immaculate::paper::derbez2000::{arithmetic, claims, long_term, search, stability};
use immaculate::paper::experiment::Experiment;
use immaculate::paper::monte_carlo::run;
use immaculate::paper::specification::{Choices, derbez2000, zhu2016};
use immaculate::paper::verdict::{
    Judgement, Verdict, all_below_zero, all_of, below_zero_whichever, better_by_a_thousandth, confirmed_if, in_words,
    proven_if, sign_of, whichever,
};
use immaculate::paper::{Effort, Paper};
use immaculate::statistics::Estimate;
use immaculate::steady::map::Map;
use immaculate::steady::verdict::Depth;
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
        (&[below, above], Verdict::NotReproducible),
        (&[below, unsure, above], Verdict::NotReproducible),
        (&[below, unsure], Verdict::Undecided),
        (&[above, unsure], Verdict::Undecided),
    ] {
        assert_eq!(below_zero_whichever(differences), verdict, "{differences:?}");
    }
}

#[test]
fn verdicts_are_put_together_by_their_worst_or_by_what_they_share() {
    use Verdict::{Confirmed, NotReproducible, Proven, Refuted, Undecided};
    for (verdicts, together, any) in [
        (&[Proven, Proven][..], Proven, Proven),
        (&[Confirmed, Proven], Confirmed, Undecided),
        (&[Proven, Confirmed], Proven, Undecided),
        (&[Confirmed, Refuted], Refuted, NotReproducible),
        (&[NotReproducible, Undecided, Refuted], Refuted, Undecided),
        (&[Confirmed, NotReproducible, Undecided], Undecided, Undecided),
        (&[Proven, NotReproducible], NotReproducible, Undecided),
        (&[], Undecided, Undecided),
    ] {
        assert_eq!(all_of(verdicts), together, "{verdicts:?}");
        assert_eq!(whichever(verdicts), any, "{verdicts:?}");
    }
    assert_eq!([true, false].map(proven_if), [Proven, Refuted]);
    assert_eq!([true, false].map(confirmed_if), [Confirmed, Refuted]);
    let words = [Proven, Confirmed, Refuted, Undecided, NotReproducible].map(Verdict::words);
    assert_eq!(
        words,
        ["proven", "confirmed", "refuted", "undecided", "not reproducible"]
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

/// Exact: a limit of ½, and parts that are certain to within four times an eighth.
#[test]
fn a_configuration_counts_where_its_bounds_are_on_one_side_of_the_limit() {
    let tally = |count: fn(&[Relative], f64) -> Tally, value: f64, standard_error: f64| {
        let one = Relative {
            choices: String::new(),
            difference: estimate(value, standard_error),
        };
        let Tally { holds, fails, neither } = count(&[one], 0.5);
        [holds, fails, neither]
    };
    let (holds, fails, neither) = ([1, 0, 0], [0, 1, 0], [0, 0, 1]);
    for (value, standard_error, within, below) in [
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
            tally(Tally::within, value, standard_error),
            within,
            "within: {value} ± {standard_error}"
        );
        assert_eq!(
            tally(Tally::below, value, standard_error),
            below,
            "below: {value} ± {standard_error}"
        );
    }
    let of = |holds, fails, neither| Tally { holds, fails, neither };
    assert_eq!(of(1, 2, 3).and(of(10, 20, 30)), of(11, 22, 33));
    assert_eq!(
        of(11, 22, 33).words(),
        "True 11 times, false 22 times, uncertain 33 times."
    );
    for (tally, verdict) in [
        (of(2, 0, 0), Verdict::Confirmed),
        (of(0, 2, 0), Verdict::Refuted),
        (of(0, 2, 1), Verdict::Undecided),
        (of(2, 0, 1), Verdict::Undecided),
        (of(1, 1, 0), Verdict::NotReproducible),
        (of(1, 1, 1), Verdict::NotReproducible),
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
    let greatest = errors.map(|error| error[0].hypot(error[2])).fold(0.0, f64::max);
    // The platform's `hypot` may differ from a root of squares in the last bit.
    let (below, words) = experiment.stays_within(greatest * (1.0 + 1e-12));
    assert!(
        below && words.contains(": IMM5CKF ") && words.contains("; no run fails and none reaches"),
        "{words}"
    );
    let (above, words) = experiment.stays_within(greatest * (1.0 - 1e-12));
    assert!(!above && words.contains("; a run fails or reaches"), "{words}");
    assert_eq!(experiment.failures(0), 0);
    experiment.runs[1][0].failure = Some(Failure {
        step: 100,
        mode: "left turn".into(),
        equation: "liu2017 (1)",
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
        let Judgement {
            id,
            quote,
            place,
            question,
            verdict,
            evidence,
        } = judgement;
        assert_eq!(
            [&id, &quote, &place, &question],
            [&claim.id, &claim.quote, &claim.place, &claim.question]
        );
        assert_eq!((verdict, evidence.as_str()), (Verdict::Undecided, "evidence"));
    }
}

// The ledgers

/// Three runs: a standard error, and as few as it takes.
const EFFORT: Effort = Effort { runs: Some(3), seed: 1 };

/// Verdict, claim and evidence, a line a sentence or a clause, so that a figure that moves is one line.
fn ledger(judgements: &[Judgement]) -> String {
    let mut text = String::new();
    for judgement in judgements {
        let words: Vec<&str> = judgement.evidence.split(' ').map(without_rounding).collect();
        let lines = words.join(" ").replace("; ", ";\n  ").replace(". ", ".\n  ");
        let _ = writeln!(
            text,
            "{}: {}\n  {}",
            judgement.id,
            judgement.verdict.words(),
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
    insta::assert_snapshot!(ledger(&Paper::Sustika2015.judge(EFFORT, &|| ()).unwrap()));
}

#[test]
fn what_runs_say_of_derbez2000() {
    let s = derbez2000();
    let runs = claims::Evidence::new(EFFORT, &|| ()).unwrap();
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
