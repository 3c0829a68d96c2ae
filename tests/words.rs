//! Goal: a change of the program shows its effect on the words, tables and pictures that people look at, and on the JSON
//! beside them.
//!
//! Method: snapshots of what is printed and drawn, from values that stand here and are small enough to be followed by eye; no filter is
//! run. Pictures are kept as SVG files, to be opened beside each other. Kind of evidence: snapshot, the weakest there is. It says what is
//! printed, and a person reads whether it is right.

use immaculate::book;
use immaculate::imm::Quantity::{self, CombinedMean, Gain, LogLikelihood, MixedCovariance, ModeProbabilities};
use immaculate::number::Rational;
use immaculate::oracle::behaviour::{Behaviour, NotAsked, Unasked};
use immaculate::oracle::case::{self, BadCase};
use immaculate::oracle::certify::Certified;
use immaculate::oracle::check::{CaseReport, Outcome, Report};
use immaculate::oracle::diagnose::{Diagnosis, Share};
use immaculate::oracle::formula::{ComputedFormula, ComputedFormulas};
use immaculate::oracle::invalid::{Class, Invalid};
use immaculate::oracle::judge::{Finding, Judged, Judgement, OwnError};
use immaculate::oracle::observation::{Discrepancy, Observation, SingleInput};
use immaculate::oracle::problem::{FilterFile, InteractionFile};
use immaculate::oracle::run::Triangle;
use immaculate::oracle::subject::{Broken, Precision, Ready};
use immaculate::oracle::trace::{Dimensions, Trace};
use immaculate::oracle::variant::{self, Variant};
use immaculate::paper::comparison::ErrorQuantity;
use immaculate::paper::result::{
    Consistency, Delay, Difference, ErrorFigure, ErrorHistory, FailedRun, FirstRun, FitDifference, Performance,
    Reproduction,
};
use immaculate::paper::specification::Choices;
use immaculate::paper::sustika2015::divergence::DivergenceRow;
use immaculate::paper::sustika2015::sweep::{Fit, SweepPoint, SweepSetting, SweptParameter, SweptTrajectory};
use immaculate::paper::verdict::{JudgedClaim, Tally, Verdict};
use immaculate::paper::{Effort, Paper};
use immaculate::report;
use immaculate::report::long_term::{Panel, heat_maps};
use immaculate::report::page::content::{Content, Extent, OfPaper, OfRuns};
use immaculate::report::reproduction::SideBySide;
use immaculate::rule::RuleName;
use immaculate::rule::unscented::Parameters;
use immaculate::statistics::Estimate;
use immaculate::statistics::estimate::MedianRatio;
use immaculate::steady::certificate::{Edge, Quadratics};
use immaculate::steady::map::Map;
use immaculate::steady::simulated::Grid;
use immaculate::steady::verdict::{Depth, Filters, StabilityVerdict};
use nalgebra::Matrix3;
use std::fmt::Write;
use std::time::Duration;

// The verdict on a program under test

#[test]
fn a_verdict_with_every_outcome_and_every_finding() {
    let report = of_every_outcome();
    insta::assert_snapshot!("verdict", report::check::text(&report));
    insta::assert_snapshot!("verdict_json", pretty(&report::check_json::json(&report)));
}

#[test]
fn a_verdict_in_which_all_is_right() {
    let mut text = String::new();
    for (echo, cases) in [
        (Some(true), vec![right("short", 15.65), right("long", 9.25)]),
        (None, vec![case("drowned", Outcome::CannotTell)]),
        (Some(false), vec![right("short", 15.65)]),
    ] {
        let report = Report {
            echo,
            cases,
            diagnosis: Diagnosis::Nothing,
            // Where nothing was judged, nothing is said of what was never shown.
            hidden: if echo.is_none() { vec![Gain] } else { Vec::new() },
            not_asked: Vec::new(),
            observations: Vec::new(),
            remarks: Vec::new(),
            ..of_every_outcome()
        };
        text.push_str(&report::check::text(&report));
        text.push('\n');
    }
    insta::assert_snapshot!("verdict_right", text);
}

#[test]
fn every_kind_of_diagnosis() {
    let [mistake, second, third] = [
        "mixed-spread-omitted",
        "transition-transposed",
        "mixed-spread-inner-product",
    ]
    .map(found);
    let convention = of_kind(variant::Kind::Convention);
    let form = of_kind(variant::Kind::Form);
    let mut text = String::new();
    for diagnosis in [
        Diagnosis::One(vec![mistake]),
        Diagnosis::One(vec![mistake, second]),
        Diagnosis::One(vec![convention]),
        Diagnosis::Several(vec![vec![mistake], vec![second, third]]),
        Diagnosis::Several(vec![vec![form], vec![convention]]),
        Diagnosis::Pairs(vec![[mistake, second]]),
        Diagnosis::Pairs(vec![[mistake, second], [mistake, third]]),
        Diagnosis::ByFilter(vec![
            ("kalman".into(), Diagnosis::One(vec![mistake])),
            ("cubature".into(), Diagnosis::Nothing),
        ]),
        in_parts(&[(&[mistake], 2)], 6),
        in_parts(&[(&[mistake], 2), (&[second, third], 1)], 5),
        in_parts(&[(&[mistake], 2), (&[second], 1)], 0),
        Diagnosis::InParts {
            parts: Vec::new(),
            unexplained: vec!["case-1".into()],
            formulas: ComputedFormulas::default(),
            of: 1,
            pairs: false,
        },
        Diagnosis::InParts {
            parts: Vec::new(),
            unexplained: vec!["case-1".into()],
            formulas: formulas(),
            of: 1,
            pairs: false,
        },
    ] {
        let report = Report {
            cases: vec![wrong("a", vec![fault(MixedCovariance, 0)])],
            diagnosis,
            observations: Vec::new(),
            ..of_every_outcome()
        };
        let json = report::check_json::json(&report);
        let _ = write!(text, "{}\n{}\n\n", report::check::text(&report), json["diagnosis"]);
    }
    insta::assert_snapshot!("diagnoses", text);
}

#[test]
fn a_fault_in_every_quantity() {
    let faults = Quantity::ALL.map(|quantity| fault(quantity, 0)).to_vec();
    let report = Report {
        // Three cases in which the equations have no answer, which are all named.
        cases: vec![wrong("a", faults), wrong("b", Vec::new()), wrong("c", Vec::new())],
        diagnosis: Diagnosis::Nothing,
        observations: Vec::new(),
        ..of_every_outcome()
    };
    insta::assert_snapshot!("verdict_faults", report::check::text(&report));
}

/// A report in which every outcome and every finding occurs once at least.
fn of_every_outcome() -> Report {
    let own = |size: f64, ratio: f64, shown: f64| OwnError {
        index: 5,
        shown,
        expected: 5.540_625,
        ratio,
        size,
    };
    let value = |quantity, finding, own| Judged {
        place: (2, quantity, 0),
        finding,
        error: 0.25,
        own,
        hidden: Vec::new(),
        explained: None,
    };
    let mut stopped = wrong(
        "stopped-early",
        vec![
            fault(MixedCovariance, 1),
            Judged {
                hidden: vec![Gain],
                ..value(CombinedMean, Finding::Fault, Some(own(3.0, f64::INFINITY, 1e12)))
            },
            value(LogLikelihood, Finding::Fault, Some(own(1e-9, 2e6, 0.0))),
            value(Gain, Finding::NotFinite, Some(own(f64::NAN, f64::NAN, f64::NAN))),
            value(ModeProbabilities, Finding::NotFinite, None),
            value(ModeProbabilities, Finding::Propagated, None),
            value(ModeProbabilities, Finding::CannotTell, None),
            value(ModeProbabilities, Finding::Undetermined, None),
            value(ModeProbabilities, Finding::Stale, None),
            value(ModeProbabilities, Finding::Unused, None),
            value(ModeProbabilities, Finding::Right, None),
        ],
    );
    stopped.stopped = Some("LinAlgError: Singular matrix\n  in update".into());
    let reason = || "not mine".to_owned();
    let invalid = Invalid::new(Class::Shape, "steps[0].gain", "has 3 numbers, and 4 are expected");
    let cases = vec![
        right("right", 14.4),
        wrong("wrong", vec![fault(MixedCovariance, 0), fault(MixedCovariance, 1)]),
        wrong("wrong-too", vec![fault(MixedCovariance, 0)]),
        wrong("wrong-again", vec![fault(MixedCovariance, 0)]),
        stopped,
        case("cannot-tell", Outcome::CannotTell),
        case("rejected", Outcome::Rejected { other_class: None }),
        case(
            "rejected-otherwise",
            Outcome::Rejected {
                other_class: Some("shape".into()),
            },
        ),
        case("not-rejected", Outcome::NotRejected),
        case("wrongly-rejected", Outcome::WronglyRejected { reason: reason() }),
        case("skipped", Outcome::Skipped { reason: reason() }),
        case("nothing-shown", Outcome::NothingShown),
        case("stopped", Outcome::Stopped { reason: reason() }),
        case("unreadable", Outcome::Broken(Broken::Invalid(invalid))),
        case(
            "silent",
            Outcome::Broken(Broken::TimedOut {
                seconds: 10,
                hint: String::new(),
            }),
        ),
    ];
    Report {
        ready: Ready {
            name: "a program".into(),
            precision: Precision::Double,
            ..Ready::default()
        },
        echo: Some(true),
        cases,
        not_asked: [Unasked::Kind, Unasked::Format, Unasked::Validation]
            .map(unasked)
            .to_vec(),
        diagnosis: Diagnosis::One(vec![found("mixed-spread-omitted")]),
        hidden: vec![Gain, LogLikelihood],
        observations: of_every_kind(),
        remarks: vec!["the program wrote something to standard output that is not a message".into()],
    }
}

/// Whatever may be seen in answers as a whole.
fn of_every_kind() -> Vec<Observation> {
    let difference = |again| Discrepancy {
        place: (2, MixedCovariance, 1),
        index: 3,
        first: Some(0.25),
        again,
    };
    let differ = |difference, is_rounding| Observation::AnswersDiffer {
        id: "right".into(),
        difference,
        is_rounding,
    };
    vec![
        differ(Some(difference(Some(0.5))), false),
        differ(Some(difference(None)), false),
        differ(None, false),
        differ(Some(difference(Some(0.25f64.next_up()))), true),
        Observation::RightAlone {
            ids: vec!["wrong".into(), "wrong-too".into()],
        },
        Observation::FewDigits { digits: 6 },
        Observation::FewDigits { digits: 9 },
        Observation::FewDecimals { decimals: 4 },
        Observation::SinglePrecision,
        Observation::SingleInput {
            input: SingleInput::Everything,
        },
        Observation::SingleInput {
            input: SingleInput::Estimates,
        },
        Observation::StepsAlike {
            id: "wrong".into(),
            step: Some(2),
        },
        Observation::StepsAlike {
            id: "wrong".into(),
            step: None,
        },
        Observation::SymmetryLost {
            ids: vec!["wrong".into(), "wrong-too".into()],
            covariance: (MixedCovariance, 1),
            first: (1, 7e-16),
            most: (40, 3000.0),
        },
        Observation::OneTriangle {
            triangle: Triangle::Lower,
            quantities: vec![MixedCovariance],
        },
        Observation::ShownAs {
            quantity: LogLikelihood,
            way: "its negative",
        },
    ]
}

/// What explains some cases, and the number of cases that nothing explains.
fn in_parts(parts: &[(&[&'static Variant], usize)], unexplained: usize) -> Diagnosis {
    let part = |(variants, cases): &(&[&'static Variant], usize)| Share {
        variants: variants.to_vec(),
        cases: *cases,
    };
    Diagnosis::InParts {
        parts: parts.iter().map(part).collect(),
        unexplained: (1..=unexplained).map(|number| format!("case-{number}")).collect(),
        formulas: ComputedFormulas::default(),
        of: unexplained + parts.iter().map(|(_, cases)| cases).sum::<usize>(),
        pairs: true,
    }
}

/// Formulas that explain all, one everywhere and one at some values only.
fn formulas() -> ComputedFormulas {
    let found = |quantity, computed: &str, right: &str, condition: Option<&str>| ComputedFormula {
        quantity,
        filters: vec!["kalman".into()],
        computed: computed.into(),
        right: right.into(),
        explains: 12,
        of: 12,
        condition: condition.map(str::to_owned),
    };
    ComputedFormulas {
        found: vec![
            found(
                Gain,
                "cross_covariance",
                "cross_covariance · innovation_covariance⁻¹",
                None,
            ),
            found(
                Quantity::UpdatedMean,
                "predicted.mean",
                "predicted.mean + gain · innovation",
                Some("at step 2 only"),
            ),
        ],
        is_complete: true,
    }
}

/// A case with long runs that was not asked.
fn unasked(why: Unasked) -> NotAsked {
    NotAsked {
        families: vec!["kalman"],
        behaviours: vec![Behaviour::LongRun],
        why,
    }
}

fn case(id: &str, outcome: Outcome) -> CaseReport {
    CaseReport {
        id: id.into(),
        filters: vec![FilterFile::Kalman {}; 2],
        interaction: InteractionFile::Imm,
        behaviours: match outcome {
            Outcome::Rejected { .. } | Outcome::NotRejected => Vec::new(),
            _ => vec![Behaviour::OrdinaryData],
        },
        dimensions: Dimensions::new(4, 2, 2, 2),
        outcome,
        judgement: None,
        judged: 0,
        of: 0,
        digits: None,
        stopped: None,
        certified: None,
    }
}

fn right(id: &str, digits: f64) -> CaseReport {
    CaseReport {
        judged: 30,
        of: 32,
        digits: Some(digits),
        ..case(id, Outcome::Right)
    }
}

fn wrong(id: &str, values: Vec<Judged>) -> CaseReport {
    CaseReport {
        judged: values.len(),
        of: 64,
        judgement: Some(Judgement {
            values,
            failures: vec![format!(
                "step 2 of {id}: the predicted covariance is not positive definite"
            )],
        }),
        ..case(id, Outcome::Wrong)
    }
}

/// A fault in the sixth number of a quantity.
fn fault(quantity: Quantity, mode: usize) -> Judged {
    Judged {
        place: (1, quantity, mode),
        finding: Finding::Fault,
        error: 0.137,
        own: Some(OwnError {
            index: 5,
            shown: 4.781_25,
            expected: 5.540_625,
            ratio: 2e14,
            size: 0.137,
        }),
        hidden: Vec::new(),
        explained: None,
    }
}

fn found(id: &str) -> &'static Variant {
    variant::find(id).expect("it is in the catalogue")
}

fn of_kind(kind: variant::Kind) -> &'static Variant {
    variant::catalogue()
        .iter()
        .find(|variant| variant.kind == kind)
        .expect("every kind has one")
}

// Published cases, and the catalogue

#[test]
fn cases_that_were_verified() {
    let cases = case::all().unwrap();
    let of = |id: &str| cases.iter().find(|case| case.problem.id == id).unwrap();
    let (two, three) = (of("step.n4-m2.two-modes"), of("step.n4-m2.three-modes"));
    let mut trace = Trace::empty(&two.problem.dimensions());
    trace.set(1, ModeProbabilities, 0, vec![0.25, 0.75]);
    trace.set(1, CombinedMean, 0, vec![1.0, 2.0, 3.0, 4.0]);
    let (scale, noise) = (trace.clone(), trace.clone());
    let certified = Certified {
        trace,
        scale,
        noise,
        bits: 128,
        digits: 30,
    };
    let outcomes = [
        (&two, Ok(Some(certified)), Duration::from_millis(250)),
        (&three, Ok(None), Duration::ZERO),
        (&three, Err(BadCase::Missing("a file".into())), Duration::ZERO),
    ];
    let text = format!(
        "{}\n{}",
        report::cases::verified(&outcomes),
        pretty(&report::cases::verified_json(&outcomes))
    );
    insta::assert_snapshot!("cases_verified", text);
    insta::assert_snapshot!("cases_listed", report::cases::list(&[two, three]));
    // In full a case is its two files under its name and what it is for.
    let shown = report::cases::show(two);
    assert!(shown.starts_with("step.n4-m2.two-modes\n  One step of two Kalman filters"));
    assert!(shown.ends_with(&format!("\n{}\n{}", two.problem_text, two.trace_text)));
}

#[test]
fn a_trace_step_by_step() {
    let cases = case::all().unwrap();
    let problem = &cases
        .iter()
        .find(|case| case.problem.id == "step.n4-m2.two-modes")
        .unwrap()
        .problem;
    let dimensions = problem.dimensions();
    // Every value is the number of its place.
    let mut values = Trace::empty(&problem.dimensions());
    for (step, quantity, mode) in values.clone().all_places() {
        let (rows, columns) = dimensions.shape(step, quantity);
        let numbers = (0..rows * columns).map(|index| (10 * index + mode) as f64).collect();
        values.set(step, quantity, mode, numbers);
    }
    let words = values.map(|_, numbers| numbers.iter().map(ToString::to_string).collect());
    insta::assert_snapshot!("trace", report::trace::text(problem, &words));
}

#[test]
fn variants_in_a_table_and_in_full() {
    let some = ["mixed-spread-omitted", "transition-transposed"].map(|id| found(id).clone());
    let mut text = report::variants::table_of(&some);
    for variant in &some {
        let _ = write!(
            text,
            "\n{}{}",
            report::variants::in_full(variant),
            pretty(&report::variants::json(variant))
        );
    }
    insta::assert_snapshot!("variants", text);
}

// The papers' figures

#[test]
fn reproductions_of_each_paper() {
    let mut text = String::new();
    for paper in Paper::ALL {
        let mut of_paper = reproduction(paper, Choices::default());
        // The first filter has five failures, of which three are named; of three all are.
        of_paper.filters[1].failures = failures(3);
        text.push_str(&report::reproduction::text(paper, &of_paper, true));
        let mut other = reproduction(paper, Choices::of("some-parameter", "otherwise"));
        other.filters[0].failures = failures(2);
        text.push_str(&report::reproduction::alternatives(paper, &[of_paper, other], true));
        text.push('\n');
    }
    // A scenario of which nothing is published.
    let acceleration = reproduction(Paper::Derbez2000, Choices::of("scenario", "acceleration"));
    text.push_str(&report::reproduction::text(Paper::Derbez2000, &acceleration, false));
    insta::assert_snapshot!("reproductions", text);
}

#[test]
fn reproductions_as_csv() {
    let of_paper = reproduction(Paper::Liu2017, Choices::default());
    let first_run = of_paper.first_run.as_ref().unwrap();
    let parts = [
        report::reproduction::errors_csv(&of_paper),
        report::reproduction::mode_probabilities_csv(&of_paper),
        report::reproduction::path_csv(&of_paper, first_run),
    ];
    insta::assert_snapshot!("reproduction_csv", parts.join("\n"));
}

#[test]
fn the_open_choices_of_each_paper() {
    let of_papers = Paper::ALL.map(|paper| report::reproduction::choices(paper.specification()));
    insta::assert_snapshot!("choices", of_papers.concat());
}

#[test]
fn claims_with_every_verdict() {
    let claims = Verdict::ALL.map(|verdict| JudgedClaim {
        id: format!("a-{}-claim", verdict.words().replace(' ', "-")),
        quote: "the proposed algorithm is better".into(),
        place: "section 4".into(),
        question: "Is it?".into(),
        verdict,
        configurations: (verdict == Verdict::DependsOnChoice).then_some(Tally {
            holds: 46,
            fails: 1,
            uncertain: 1,
        }),
        evidence: "Some figures, and what they are compared with: a sentence that is long enough to be broken once at the width of a page."
            .into(),
    });
    let parts = [
        report::claims::legend(),
        report::claims::heading(Paper::Zhu2016.specification()),
        report::claims::text(&claims),
        report::claims::summary(&claims),
        report::claims::summary(&claims[..2]),
    ];
    insta::assert_snapshot!("claims", parts.concat());
}

#[test]
fn the_sweep_and_what_makes_a_filter_diverge() {
    let points: Vec<_> = sweep()
        .into_iter()
        .map(|(setting, value)| (setting, point(value)))
        .collect();
    let text = format!(
        "{}\n{}",
        report::fit_error::text(&points, 50),
        report::divergence::text(&rows(), 50)
    );
    insta::assert_snapshot!("sweep", text);
}

/// Settings of a sweep, twenty of each kind, with a value that grows.
fn sweep() -> Vec<(SweepSetting, f64)> {
    let mut sweep = Vec::new();
    for trajectory in SweptTrajectory::ALL {
        for parameter in SweptParameter::ALL {
            let values = (1..=20).map(|k| f64::from(k) / 10.0);
            let factor = f64::from(1 + u8::from(trajectory == SweptTrajectory::Manoeuvring));
            let shift = f64::from(u8::from(parameter == SweptParameter::BearingDegrees)) / 4.0;
            sweep.extend(values.map(|value| {
                let setting = SweepSetting {
                    trajectory,
                    parameter,
                    value,
                };
                (setting, factor * value + shift)
            }));
        }
    }
    sweep
}

fn point(value: f64) -> SweepPoint {
    let estimate = |value| Estimate {
        value,
        standard_error: 0.05,
    };
    SweepPoint {
        runs_with_jump: 4,
        fits: [0, 1, 2].map(|filter| Fit {
            mean: estimate(value + filter as f64),
            median: value,
            divergent: 2 * filter,
            divergent_with_jump: filter,
            failed: usize::from(filter == 2),
        }),
        unscented_less_converted: estimate(-0.25),
        plain_less_converted: estimate(7.5),
    }
}

fn rows() -> [DivergenceRow; 2] {
    let row = |scenario, window, value| DivergenceRow {
        scenario,
        window,
        point: point(value),
    };
    [
        row("matched-manoeuvring", "toolbox", 1.0),
        row("mismatched-manoeuvring", "printed", 2.0),
    ]
}

/// Distinct figures, for as many filters as the paper's first table has columns; two steps.
fn reproduction(paper: Paper, choices: Choices) -> Reproduction {
    let names = &paper.specification().tables[0].columns;
    let filters: Vec<Performance> = names
        .iter()
        .enumerate()
        .map(|(number, name)| performance(paper, name, number))
        .collect();
    let difference = |quantity, value| Difference {
        filter: names[0].clone(),
        minus: names[1].clone(),
        quantity,
        estimate: Estimate {
            value,
            standard_error: 0.125,
        },
    };
    let fit_difference = FitDifference {
        filter: names[0].clone(),
        minus: names[1].clone(),
        estimate: Estimate {
            value: -0.5,
            standard_error: 0.125,
        },
    };
    Reproduction {
        paper: paper.key(),
        choices,
        runs: 20,
        steps: 2,
        times: vec![1.5, 3.0],
        seed: 7,
        motions: vec!["constant velocity", "right turn"],
        first_run: Some(FirstRun {
            truth: vec![[0.0, 0.0], [100.0, 50.0]],
            measured: vec![[1.0, -1.0], [98.0, 52.0]],
            estimates: names.iter().map(|_| vec![[0.5, 0.25], [101.0, 49.0]]).collect(),
            sensor: None,
        }),
        filters,
        // Above what rounding leaves, and below it.
        differences: vec![
            difference(ErrorQuantity::Position, 1.5),
            difference(ErrorQuantity::Velocity, 1e-13),
        ],
        fit_differences: Vec::from_iter((paper == Paper::Sustika2015).then_some(fit_difference)),
    }
}

fn performance(paper: Paper, name: &str, number: usize) -> Performance {
    let value = 10.0 * (number + 1) as f64;
    let estimate = |value| Estimate {
        value,
        standard_error: 0.25,
    };
    let history = |quantity, value| ErrorHistory {
        quantity,
        values: vec![value, 2.0 * value],
        standard_errors: vec![0.5, 0.25],
    };
    let consistency = |value, expected| Consistency {
        mean: estimate(value),
        expected,
        bounds: (3.0, 5.0),
        inside: 0.95,
    };
    let is_first = number == 0;
    Performance {
        name: name.into(),
        modes: vec!["constant velocity".into(), "right turn".into()],
        points: (!is_first).then_some(8 + number),
        effective_points: (!is_first).then_some(7 + number),
        completed_runs: 20,
        failures: failures(if is_first { 5 } else { 0 }),
        errors: ErrorQuantity::ALL
            .iter()
            .map(|quantity| ErrorFigure {
                quantity: *quantity,
                estimate: estimate(value),
            })
            .collect(),
        fit_error: (paper == Paper::Sustika2015).then(|| estimate(1.5 + number as f64)),
        rmse: vec![
            history(ErrorQuantity::Position, value),
            history(ErrorQuantity::Velocity, value / 4.0),
        ],
        mode_probabilities: vec![vec![0.75, 0.25], vec![0.125, 0.875]],
        mode_probability_standard_errors: vec![vec![0.01, 0.02], vec![0.03, 0.04]],
        nees: consistency(if number == 1 { f64::NAN } else { 4.5 }, 4.0),
        nis: consistency(2.125, 2.0),
        delays: vec![
            Delay {
                time: 3.0,
                detected: 20,
                mean: 2.5,
                greatest: 6.0,
            },
            Delay {
                time: 9.0,
                detected: 17,
                mean: 4.0,
                greatest: 8.0,
            },
        ],
        microseconds_per_step: 1.25 * (number + 1) as f64,
        time_ratio: Some(MedianRatio {
            median: (number + 1) as f64,
            scatter: 0.01,
        }),
    }
}

fn failures(count: usize) -> Vec<FailedRun> {
    let failed = |run| FailedRun {
        run,
        failure: "step 2, mode `right turn`: the mixed covariance is not positive definite".into(),
    };
    (1..=count).map(failed).collect()
}

// The papers' figures as pictures

#[test]
fn the_pictures_of_a_reproduction() {
    let mut of_paper = reproduction(Paper::Liu2017, Choices::default());
    // One filter has a step without a standard error, and two are within a pixel of each other.
    of_paper.filters[1].rmse[0].standard_errors[0] = f64::NAN;
    let same = of_paper.filters[2].rmse.clone();
    of_paper.filters[3].rmse = same;
    picture("errors", report::figure::errors(&of_paper).unwrap());
    picture(
        "mode_probabilities",
        report::figure::mode_probabilities(&of_paper).unwrap(),
    );
    let mut first_run = of_paper.first_run.take().unwrap();
    picture("path", report::path::path(&of_paper, &first_run).unwrap());
    first_run.sensor = Some([50.0, -20.0]);
    of_paper.motions = vec!["constant velocity", "constant acceleration"];
    picture("path_with_sensor", report::path::path(&of_paper, &first_run).unwrap());
    let mut comparisons = report::reproduction::published_and_computed(Paper::Liu2017, &of_paper);
    let published = |comparisons: &[SideBySide]| {
        let drawn = report::published::published_and_computed(Paper::Liu2017, comparisons);
        drawn.unwrap().unwrap()
    };
    picture("published", published(&comparisons));
    // Near to each other and far from zero, as most published figures are; and on either side of zero.
    for (place, of) in comparisons.iter_mut().enumerate() {
        (of.published, of.computed) = (100.0, 99.0 + place as f64 / 4.0);
    }
    picture("published_near", published(&comparisons[..4]));
    comparisons[0].computed = -1.0;
    picture("published_below_zero", published(&comparisons[..4]));
}

#[test]
fn the_pictures_of_a_sweep() {
    for (factor, name) in [(1.0, "sweep"), (20.0, "sweep_divergent")] {
        let points: Vec<_> = sweep()
            .into_iter()
            .map(|(setting, value)| (setting, point(factor * value)))
            .collect();
        picture(
            name,
            report::fit_error::draw(&points, SweptTrajectory::Manoeuvring, 50).unwrap(),
        );
    }
}

#[test]
fn the_picture_and_the_rule_of_the_conversions() {
    picture("conversions", report::conversion::figure().unwrap());
    insta::assert_snapshot!("conversions_rule", report::conversion::table());
}

#[test]
fn the_pictures_of_stability_and_of_predictions() {
    picture("map", report::stability_map::draw(&small_map()).unwrap());
    let grid = Grid {
        rows: vec![1.0, 2.0],
        columns: vec![10.0, 20.0, 30.0],
        ..Grid::figure_2(2.0)
    };
    let panel = |title: &str, sign: f64| Panel {
        title: title.into(),
        grid: grid.clone(),
        percentages: [-200.0, -50.0, 0.0, 50.0, 200.0, f64::NAN]
            .map(|value| sign * value)
            .to_vec(),
    };
    let panels = [panel("one", 1.0), panel("two", -1.0), panel("three", 0.5)];
    picture("heat_maps", heat_maps(&panels, 2).unwrap());
}

/// A picture is kept as a file of its own, which a browser shows.
fn picture(name: &str, svg: String) {
    insta::assert_binary_snapshot!(&format!("picture_{name}.svg"), svg.into_bytes());
}

// The page and the book

#[test]
fn an_equation_in_full() {
    // A value of a step with an erratum, one outside of steps, and one that several functions realise.
    for (name, asked) in [
        ("step", "zhu2016 57"),
        ("outside", "zhu2016 64"),
        ("several", "derbez2000 mixed-mean"),
    ] {
        let [entry] = book::find::find(asked).unwrap()[..] else {
            panic!("{asked} is one equation")
        };
        insta::assert_snapshot!(
            format!("equation_{name}"),
            without_lines(&report::equation::in_full(entry))
        );
        let json = without_lines(&pretty(&report::equation::json(entry)));
        let json: Vec<&str> = json.lines().filter(|line| !line.contains("\"line\":")).collect();
        insta::assert_snapshot!(format!("equation_{name}_json"), json.join("\n"));
    }
}

#[test]
fn equations_in_a_table() {
    let some: Vec<_> = book::entries_of(Paper::Liu2017).take(5).collect();
    insta::assert_snapshot!("equations", report::equation::table_of(&some));
}

#[test]
fn the_words_of_the_page() {
    let judgement = |verdict| JudgedClaim {
        id: "a-claim".into(),
        quote: "it is better".into(),
        place: "section 4".into(),
        question: "Is it?".into(),
        verdict,
        configurations: (verdict == Verdict::DependsOnChoice).then_some(Tally {
            holds: 46,
            fails: 1,
            uncertain: 1,
        }),
        evidence: "Some figures.".into(),
    };
    let of_paper = |paper: Paper| OfPaper {
        paper,
        simulations: paper
            .simulations(&Choices::default())
            .into_iter()
            .map(|choices| {
                vec![
                    reproduction(paper, choices.clone()),
                    reproduction(paper, choices.with("a", "b")),
                ]
            })
            .collect(),
        judgements: vec![judgement(Verdict::Proven), judgement(Verdict::Refuted)],
    };
    let content = Content {
        extent: Extent {
            effort: Effort {
                runs: Some(20),
                seed: 7,
            },
            map_points: 5,
        },
        papers: Paper::ALL.map(of_paper).to_vec(),
        sweep: OfRuns {
            runs: 50,
            results: sweep()
                .into_iter()
                .map(|(setting, value)| (setting, point(value)))
                .collect(),
        },
        divergence: OfRuns {
            runs: 50,
            results: rows().to_vec(),
        },
        map: small_map(),
    };
    let pages = report::page::site(&content).unwrap();
    let page = |file: &str| &pages.iter().find(|page| page.file == file).unwrap().html;
    let main = |file: &str| page(file).split_once("<main id=\"content\">").unwrap().1;
    // Drawings and formulas have tests of their own, and so have the book and README.
    let (_, outcome) = main("index.html").split_once("id=\"claims\">").unwrap();
    let papers = Paper::ALL.map(|paper| words_of(main(&format!("{}.html", paper.key()))));
    let front = words_of(outcome) + &papers.concat();
    // On a dark screen the drawings have the page's own ink, ground, grid and shade.
    for name in ["ink", "paper", "grid", "shade"] {
        for attribute in ["fill", "stroke"] {
            assert!(
                page("index.html").contains(&format!("{attribute}: var(--{name});")),
                "{attribute} {name}"
            );
        }
    }
    insta::assert_snapshot!("page", front);
}

#[test]
fn an_equation_in_the_book() {
    let chapter = report::page::book::chapter(Paper::Zhu2016).into_string();
    // One as it is printed, one that is corrected, one that is outside of steps, and one whose evidence is that of another.
    let mut text = String::new();
    for anchor in ["zhu2016-56", "zhu2016-24", "zhu2016-64", "zhu2016-14"] {
        let (_, section) = chapter.split_once(&format!("id=\"{anchor}\">")).unwrap();
        let section = section.split("<section class=\"equation\"").next().unwrap();
        let _ = writeln!(text, "{}", without_lines(&words_of(section)));
    }
    insta::assert_snapshot!("book", text);
    let index = without_lines(&words_of(&report::page::book::index().into_string()));
    let few: Vec<&str> = index.lines().take(60).collect();
    insta::assert_snapshot!("book_index", few.join("\n"));
}

/// What HTML says, without its drawings and formulas.
fn words_of(html: &str) -> String {
    let mut text = String::new();
    let mut is_shown = true;
    for part in html.split('<') {
        let (tag, words) = part.split_once('>').unwrap_or(("", part));
        for hidden in ["svg", "math"] {
            is_shown &= !tag.starts_with(hidden);
            is_shown |= tag == format!("/{hidden}");
        }
        if is_shown && !words.trim().is_empty() {
            let _ = writeln!(text, "{}", words.trim());
        }
    }
    text
}

/// A text without the lines at which code stands: they move with every change above them.
fn without_lines(text: &str) -> String {
    let mut parts = text.split(".rs:");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |all, part| {
        all + ".rs:" + part.trim_start_matches(|c: char| c.is_ascii_digit())
    })
}

// Rules, and fixed gains

#[test]
fn rules_with_and_without_a_degree() {
    let mut text = String::new();
    let mut describe = |rule: &RuleName, shown: &str, n: usize| {
        let description = report::rule::describe(rule, shown, n).unwrap();
        let lines = report::rule::text(&description);
        // The first points say how all are printed.
        let few: Vec<&str> = lines.lines().take(16).collect();
        let _ = writeln!(text, "{}\n", few.join("\n"));
    };
    // As printed, a rule has no degree; covariances may have weights of their own; of a product the nodes are shown; and above dimension
    // ten nothing is tried.
    for (name, n) in [
        ("simplex-5", 2),
        ("simplex-5-printed-16", 2),
        ("unscented", 2),
        ("gauss-hermite-3", 2),
        ("gauss-hermite-4", 1),
        ("gauss-hermite-5", 3),
        ("cubature-3", 11),
    ] {
        describe(&name.parse().unwrap(), name, n);
    }
    let [alpha, beta, kappa] = [Rational::new(1, 2), Rational::new(2, 1), Rational::new(0, 1)];
    describe(
        &RuleName::Unscented(Some(Parameters { alpha, beta, kappa })),
        "unscented, α = 1/2, β = 2, κ = 0",
        2,
    );
    insta::assert_snapshot!("rules", text);
    assert!(report::rule::describe(&RuleName::ThirdDegree, "cubature-3", 32).is_ok());
    assert!(report::rule::describe(&RuleName::ThirdDegree, "cubature-3", 33).is_err());
}
#[test]
fn pairs_of_fixed_gain_filters_that_are_stable_unstable_and_undecided() {
    let mut text = String::new();
    let q = Rational::new;
    let (equal, apart) = ([q(1, 2), q(1, 2)], [q(4, 5), q(46, 125)]);
    // One form; forms that remember; none of those that may be tried; a product that grows.
    for (roots, memory) in [(equal, 0), (apart.clone(), 2), (apart, 0), ([q(3, 4), q(1, 6)], 0)] {
        let depth = Depth {
            word: 3,
            run: 2,
            memory,
        };
        let filters = Filters::Roots(roots);
        let verdict = filters.decide(depth);
        let answer = report::stability::StabilityAnswer::new(&filters, [q(1, 1), q(1, 1)], depth, verdict);
        text.push_str(&report::stability::text("Two filters.", &answer));
        let _ = write!(
            text,
            "{}\n\n",
            pretty(&report::stability::json("Two filters.", &answer, None))
        );
    }
    // Eight forms, of which four are shown; that they prove nothing is not asked here.
    let verdict = StabilityVerdict::Stable(Quadratics {
        edges: Edge::memory(2, 3),
        forms: (1..=8).map(|k| Matrix3::from_diagonal_element(q(k, 1))).collect(),
    });
    let (filters, depth) = (
        Filters::Roots([q(1, 2), q(1, 2)]),
        Depth {
            word: 3,
            run: 2,
            memory: 0,
        },
    );
    let answer = report::stability::StabilityAnswer::new(&filters, [q(1, 1), q(1, 1)], depth, verdict);
    text.push_str(&report::stability::text("Two filters.", &answer));
    insta::assert_snapshot!("stability", text);
}

#[test]
fn the_map_of_stability_as_text_and_data() {
    let map = small_map();
    let counted = map
        .points
        .iter()
        .flatten()
        .filter(|point| matches!(point.verdict, StabilityVerdict::Stable(_)))
        .count();
    assert_eq!(counted, map.counts()[0]);
    let parts = [
        report::stability::map_text(&map),
        report::stability::map_csv(&map),
        pretty(&report::stability::map_json(&map)),
    ];
    insta::assert_snapshot!("stability_map", parts.join("\n"));
}

fn small_map() -> Map {
    let depth = Depth {
        word: 6,
        run: 6,
        memory: 2,
    };
    Map::new(5, [-2.0, 2.0], depth, &|| ())
}

fn pretty(value: &serde_json::Value) -> String {
    serde_json::to_string_pretty(value).unwrap()
}
