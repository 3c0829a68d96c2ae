//! Goal: what the answers of a program show as a whole is said before any equation is blamed: lost digits, lost symmetry, values shown as
//! something else, chance, and what is kept between problems.
//!
//! Method: programs in this process that are wrong in one way each, beside one that is right; what is random in them is a count, so that
//! every run is the same. Kind of evidence: behaviour, by examples, good and bad.

use immaculate::imm::Quantity;
use immaculate::oracle::case;
use immaculate::oracle::check::{Outcome, Report, Selection, check, check_problems};
use immaculate::oracle::diagnose::Diagnosis;
use immaculate::oracle::observation::{Observation, SingleInput};
use immaculate::oracle::problem::{MeasurementFile, ProblemFile};
use immaculate::oracle::run::{Triangle, run_in_doubles};
use immaculate::oracle::subject::{Answer, Broken, Level, Planted, Precision, Ready, Subject};
use immaculate::oracle::trace::Trace;
use immaculate::report;

/// Five cases of one step.
const FIVE: [&str; 5] = [
    "update.kalman",
    "update.cubature-3",
    "update.simplex-5",
    "update.cubature-5",
    "step.n4-m2.two-modes",
];

// Chance and state

/// The first of each is right: only asking again shows it.
#[test]
fn an_answer_that_depends_on_chance_is_wrong_though_every_value_is_right() {
    for ids in [&FIVE[..1], &FIVE[..]] {
        let by_chance = |trace: &mut Trace, asked: usize, _: usize| {
            if asked == ids.len() {
                change(trace, Quantity::CombinedMean, |value| value + 0.5);
            }
        };
        let report = verdict(&mut Program::new(by_chance), ids);
        assert!(report.cases.iter().all(|case| case.outcome == Outcome::Right));
        assert!(report.is_wrong());
        let [
            Observation::AnswersDiffer {
                id,
                difference: Some(difference),
                is_rounding: false,
            },
        ] = &report.observations[..]
        else {
            panic!("{:?}", report.observations);
        };
        assert_eq!(id, FIVE[0]);
        assert_eq!(
            (difference.place, difference.index),
            ((1, Quantity::CombinedMean, 0), 0)
        );
        let [first, again] = [difference.first, difference.again].map(Option::unwrap);
        assert!((again - first - 0.5).abs() < 1e-9, "{first} {again}");
        let text = text_of(&report);
        assert!(
            text.contains("update.kalman answers differently when asked again"),
            "{text}"
        );
        assert!(text.contains(" WRONG: "), "{text}");
        let json = report::check_json::json(&report);
        let seen = &json["observations"][0];
        assert_eq!(
            (&seen["seen"], &seen["wrong"]),
            (&"answers differ".into(), &true.into())
        );
        assert_eq!(seen["difference"]["quantity"], "combined.mean");
        assert_eq!(seen["difference"]["first"], first);
        assert_eq!(seen["difference"]["again"], again);
    }
}

/// Sums in an order of chance: no two runs are the same, and all are right.
#[test]
fn answers_that_differ_by_rounding_alone_are_right_and_said_to_differ() {
    let by_rounding = |trace: &mut Trace, asked: usize, _: usize| {
        if asked > 0 {
            change(trace, Quantity::CombinedMean, f64::next_up);
        }
    };
    let report = verdict(&mut Program::new(by_rounding), &FIVE[..1]);
    assert!(!report.is_wrong());
    assert!(
        matches!(
            report.observations[..],
            [Observation::AnswersDiffer { is_rounding: true, .. }]
        ),
        "{:?}",
        report.observations
    );
    assert!(text_of(&report).contains("only their rounding differs"));
}

#[test]
fn a_value_that_is_not_shown_again_is_a_difference() {
    let falls_silent = |trace: &mut Trace, asked: usize, _: usize| {
        if asked > 0 {
            *trace = Trace::empty(&trace.dimensions);
        }
    };
    let report = verdict(&mut Program::new(falls_silent), &FIVE[..1]);
    let text = text_of(&report);
    assert!(report.is_wrong() && text.contains("and is now not shown"), "{text}");
}

#[test]
fn the_same_answer_again_is_no_observation_whether_right_or_wrong() {
    for variants in [vec![], vec!["mixed-spread-omitted".to_owned()]] {
        let mut program = Planted {
            level: Level::Everything,
            variants,
        };
        assert_eq!(verdict(&mut program, &FIVE).observations, []);
    }
}

/// Three are asked alone, of the four that are wrong: the first case was alone when it was asked.
#[test]
fn a_case_that_is_right_alone_and_wrong_among_others_is_told_so() {
    let mut program = Program::new(leaks);
    let report = verdict(&mut program, &FIVE);
    assert_eq!(
        report
            .cases
            .iter()
            .filter(|case| case.outcome == Outcome::Wrong)
            .count(),
        4
    );
    let [first, Observation::RightAlone { ids }] = &report.observations[..] else {
        panic!("{:?}", report.observations);
    };
    assert!(matches!(first, Observation::AnswersDiffer { id, .. } if id == FIVE[0]));
    let asked: Vec<&str> = report.cases[1..4].iter().map(|case| case.id.as_str()).collect();
    assert_eq!(*ids, asked);
    assert_eq!(program.starts, 4);
    let text = text_of(&report);
    assert!(
        text.contains("right when asked alone") && text.contains("something is kept between problems"),
        "{text}"
    );
    let json = report::check_json::json(&report);
    assert_eq!(json["observations"][1]["seen"], "right alone");
}

#[test]
fn a_problem_of_ones_own_is_asked_again_and_alone_too() {
    let own = |id: &str| {
        let mut problem = problem(FIVE[4]);
        problem.id = id.into();
        problem
    };
    let report = check_problems(&mut Program::new(leaks), &[own("mine"), own("mine-too")], &|_| {}).unwrap();
    let [Observation::AnswersDiffer { id, .. }, Observation::RightAlone { ids }] = &report.observations[..] else {
        panic!("{:?}", report.observations);
    };
    assert_eq!((id.as_str(), &ids[..]), ("mine", &["mine-too".to_owned()][..]));
}

/// Answers that were written before the check are what they are.
#[test]
fn what_cannot_be_started_anew_is_not_asked_alone() {
    let mut program = Program::new(leaks);
    program.forgets = false;
    let report = verdict(&mut program, &FIVE);
    assert!(matches!(report.observations[..], [Observation::AnswersDiffer { .. }]));
    assert_eq!(program.starts, 1);
}

// Lost digits

/// Short ones first: what is right and short is no observation, and what is printed short is none where that was declared.
#[test]
fn numbers_with_few_digits_are_said_to_be_printed_so_and_nothing_is_searched() {
    for (digits, words) in [
        (4, "more than 4 significant"),
        (6, "`\"precision\": {\"decimal_digits\": 6}`"),
        (9, "single"),
    ] {
        let printed = |value: f64| format!("{value:.*e}", digits - 1).parse().unwrap();
        let mut program = Program::new(|trace, _, _| of_all(trace, printed));
        let report = verdict(&mut program, &FIVE);
        assert_eq!(report.observations, [Observation::FewDigits { digits }]);
        assert_eq!((report.is_wrong(), &report.diagnosis), (true, &Diagnosis::Nothing));
        let text = text_of(&report);
        assert!(text.contains(words), "{text}");
        assert!(text.find("NOTICE") < text.find("FAULT"), "{text}");
        program.ready.precision = Precision::DecimalDigits(u32::try_from(digits).unwrap());
        assert_eq!(verdict(&mut program, &FIVE).observations, []);
    }
    let printed = |value: f64| format!("{value:.9e}").parse().unwrap();
    let report = verdict(&mut Program::new(|trace, _, _| of_all(trace, printed)), &FIVE);
    assert_eq!(report.observations, [], "ten digits are those of no precision");
}

#[test]
fn numbers_with_few_decimals_are_said_to_be_printed_so() {
    let printed = |value: f64| format!("{value:.6}").parse().unwrap();
    let mut program = Program::new(|trace, _, _| of_all(trace, printed));
    let report = verdict(&mut program, &["units.nanometres"]);
    assert_eq!(report.observations, [Observation::FewDecimals { decimals: 6 }]);
    assert!(report.is_wrong() && report.diagnosis == Diagnosis::Nothing);
}

#[test]
fn numbers_of_single_precision_are_told_from_doubles() {
    let mut program = Program::new(|trace, _, _| of_all(trace, single));
    let report = verdict(&mut program, &FIVE);
    assert_eq!(report.observations, [Observation::SinglePrecision]);
    assert!(report.is_wrong() && report.diagnosis == Diagnosis::Nothing);
    program.ready.precision = Precision::Single;
    let report = verdict(&mut program, &FIVE);
    assert!(!report.is_wrong() && report.observations.is_empty());
}

/// A step that is computed in double precision from input in single precision.
#[test]
fn input_that_was_rounded_to_single_precision_is_named() {
    let round = |values: &mut Vec<f64>| values.iter_mut().for_each(|value| *value = single(*value));
    let estimates = |problem: &mut ProblemFile| {
        for estimate in &mut problem.initial.modes {
            round(&mut estimate.mean);
            estimate.covariance.iter_mut().flatten().for_each(round);
        }
    };
    let everything = |problem: &mut ProblemFile| {
        estimates(problem);
        round(&mut problem.initial.mode_probabilities);
        problem.transition.iter_mut().for_each(round);
        problem.noise.iter_mut().for_each(round);
        if let MeasurementFile::Linear { matrix } = &mut problem.measurement {
            matrix.iter_mut().for_each(round);
        }
        for mode in &mut problem.modes {
            mode.transition.iter_mut().chain(&mut mode.noise).for_each(round);
        }
        problem
            .measurements
            .iter_mut()
            .filter_map(|entry| entry.z.as_mut())
            .for_each(|z| {
                z.iter_mut().flatten().for_each(|value| *value = single(*value));
            });
    };
    for (change, input) in [
        (&estimates as &dyn Fn(&mut ProblemFile), SingleInput::Estimates),
        (&everything, SingleInput::Everything),
    ] {
        let mut program = Program::new(|_, _, _| ());
        program.input = Some(change);
        let report = verdict(&mut program, &["step.n6.acceleration", FIVE[4]]);
        assert_eq!(report.observations, [Observation::SingleInput { input }]);
        assert!(report.is_wrong() && report.diagnosis == Diagnosis::Nothing);
    }
}

/// One double among thousands of short numbers: they are not short because of how they are printed.
#[test]
fn one_number_with_all_digits_is_enough_to_have_lost_none() {
    let mut program = Program::new(|trace, _, _| {
        let gain = trace.get(1, Quantity::Gain, 0).unwrap().clone();
        of_all(trace, |value| format!("{value:.5e}").parse().unwrap());
        trace.set(1, Quantity::Gain, 0, gain);
    });
    assert_eq!(verdict(&mut program, &FIVE).observations, []);
}

// Lost symmetry

/// (I − K H) P⁻ alone stays symmetric enough, since the prediction reads one triangle. With a prediction that takes both it runs away: each
/// equation is right on the values before it, and after forty steps nothing is.
#[test]
fn a_covariance_that_loses_its_symmetry_is_wrong_and_no_form_excuses_it() {
    let [naive, both] = ["update-by-identity-minus-gain", "prediction-not-mirrored"];
    let verdict_on = |variants: &[&str]| {
        let mut program = Planted {
            variants: variants.iter().map(|&id| id.to_owned()).collect(),
            level: Level::Everything,
        };
        verdict(&mut program, &["zhu2016.kalman.run"])
    };
    for variants in [&[naive][..], &[both]] {
        let report = verdict_on(variants);
        assert!(!report.is_wrong(), "{}", text_of(&report));
    }
    let report = verdict_on(&[naive, both]);
    let text = text_of(&report);
    assert!(report.is_wrong(), "{text}");
    let [Observation::SymmetryLost { ids, first, most, .. }] = &report.observations[..] else {
        panic!("{text}");
    };
    assert_eq!(*ids, ["zhu2016.kalman.run"]);
    assert!(first.1 < 1e-12 && most.1 > 1.0 && most.0 > 20, "{first:?} {most:?}");
    assert!(text.contains("P loses its symmetry, and rounding grows"), "{text}");
    assert!(!text.contains("CAUSE  No entry"), "{text}");
}

#[test]
fn a_covariance_of_which_one_triangle_is_shown_is_told_so() {
    for (triangle, is_kept) in [
        (
            Triangle::Upper,
            (|row, column| row <= column) as fn(usize, usize) -> bool,
        ),
        (Triangle::Lower, |row, column| row >= column),
    ] {
        let half = |trace: &mut Trace, _: usize, _: usize| {
            let side = trace.dimensions.n;
            for mode in 0..trace.dimensions.r {
                let mut values = trace.get(1, Quantity::UpdatedCovariance, mode).unwrap().clone();
                for index in (0..side * side).filter(|index| !is_kept(index / side, index % side)) {
                    values[index] = 0.0;
                }
                trace.set(1, Quantity::UpdatedCovariance, mode, values);
            }
        };
        let report = verdict(&mut Program::new(half), &FIVE);
        let quantities = vec![Quantity::UpdatedCovariance];
        assert_eq!(report.observations, [Observation::OneTriangle { triangle, quantities }]);
        assert!(report.is_wrong() && report.diagnosis == Diagnosis::Nothing);
    }
}

// Values shown as something else

#[test]
fn a_right_value_that_is_shown_as_something_else_is_told_as_what() {
    let percent = |value: f64| value * 100.0;
    let as_decimal = |value: f64| value / std::f64::consts::LN_10;
    let ways: [(Quantity, Shown, &str); 5] = [
        (Quantity::LogLikelihood, f64::exp, "the likelihood, not its logarithm"),
        (Quantity::LogLikelihood, |value| -value, "its negative"),
        (Quantity::LogLikelihood, as_decimal, "base 10"),
        (Quantity::ModeProbabilities, percent, "percent"),
        (Quantity::MixingProbabilities, percent, "percent"),
    ];
    for (quantity, other, words) in ways {
        let shown_as = |trace: &mut Trace, _: usize, _: usize| of(trace, quantity, other);
        let report = verdict(&mut Program::new(shown_as), &FIVE);
        let [Observation::ShownAs { quantity: shown, way }] = report.observations[..] else {
            panic!("{words}: {:?}", report.observations);
        };
        assert_eq!(shown, quantity);
        assert!(way.contains(words), "{way}");
        assert!(report.is_wrong() && report.diagnosis == Diagnosis::Nothing);
    }
    // Beside another mistake it is said, and the other one is found.
    let mut program =
        Program::new(|trace: &mut Trace, _: usize, _: usize| of(trace, Quantity::LogLikelihood, f64::exp));
    program.own.variants = vec!["combined-spread-omitted".into()];
    let report = verdict(&mut program, &FIVE[4..]);
    assert!(matches!(report.observations[..], [Observation::ShownAs { .. }]));
    assert_ne!(report.diagnosis, Diagnosis::Nothing);
    // A wrong value is not right because it is shown as something else.
    let worse = |trace: &mut Trace, _: usize, _: usize| of(trace, Quantity::LogLikelihood, |value| value.exp() * 1.01);
    assert_eq!(verdict(&mut Program::new(worse), &FIVE).observations, []);
}

#[test]
fn steps_that_all_show_one_record_are_told_whose_it_is() {
    let one_record = |trace: &mut Trace, _: usize, _: usize| {
        let last = trace.dimensions.steps();
        for (step, quantity, mode) in trace.clone().all_places() {
            if let Some(values) = trace.get(last, quantity, mode).cloned() {
                trace.set(step, quantity, mode, values);
            }
        }
    };
    let report = verdict(&mut Program::new(one_record), &["steps.kalman"]);
    let last = problem("steps.kalman").measurements.len();
    let alike = Observation::StepsAlike {
        id: "steps.kalman".into(),
        step: Some(last),
    };
    assert_eq!(report.observations, [alike]);
    assert!(report.is_wrong() && report.diagnosis == Diagnosis::Nothing);
    // One step is like itself.
    assert_eq!(verdict(&mut Program::new(one_record), &FIVE).observations, []);
}

// Programs under test

/// This crate's own filter, whose answers are changed by what was asked since it was last started, and ever.
struct Program<'a, F> {
    input: Option<&'a dyn Fn(&mut ProblemFile)>,
    ready: Ready,
    own: Planted,
    change: F,
    asked: usize,
    since_start: usize,
    starts: usize,
    forgets: bool,
}

impl<F: FnMut(&mut Trace, usize, usize)> Program<'_, F> {
    fn new(change: F) -> Self {
        Self {
            ready: Ready::default(),
            own: Planted {
                variants: Vec::new(),
                level: Level::Everything,
            },
            input: None,
            change,
            asked: 0,
            since_start: 0,
            starts: 0,
            forgets: true,
        }
    }
}

impl<F: FnMut(&mut Trace, usize, usize)> Subject for Program<'_, F> {
    fn start(&mut self) -> Result<Ready, Broken> {
        self.since_start = 0;
        self.starts += 1;
        Ok(self.ready.clone())
    }

    fn run(&mut self, problem: &ProblemFile) -> Answer {
        let mut answer = match self.input {
            None => self.own.run(problem),
            Some(change) => {
                let mut read = problem.clone();
                change(&mut read);
                let (trace, _) = run_in_doubles(&read).unwrap();
                Answer::Steps { trace, error: None }
            }
        };
        if let Answer::Steps { trace, .. } = &mut answer {
            (self.change)(trace, self.asked, self.since_start);
        }
        self.asked += 1;
        self.since_start += 1;
        answer
    }

    fn forgets_at_start(&self) -> bool {
        self.forgets
    }
}

/// Something of earlier problems goes into the later ones.
fn leaks(trace: &mut Trace, _: usize, since_start: usize) {
    if since_start > 0 {
        change(trace, Quantity::UpdatedMean, |value| value + 0.5);
    }
}

/// Changes the first number of a quantity at step 1.
fn change(trace: &mut Trace, quantity: Quantity, other: impl Fn(f64) -> f64) {
    let mut values = trace.get(1, quantity, 0).unwrap().clone();
    values[0] = other(values[0]);
    trace.set(1, quantity, 0, values);
}

/// What is shown in place of a number.
type Shown = fn(f64) -> f64;

/// What is left of a number in single precision.
#[allow(clippy::cast_possible_truncation, reason = "that is what is to be seen")]
fn single(value: f64) -> f64 {
    f64::from(value as f32)
}

/// Changes every number of a quantity.
fn of(trace: &mut Trace, quantity: Quantity, other: impl Fn(f64) -> f64) {
    for (step, shown, mode) in trace.clone().all_places().filter(|place| place.1 == quantity) {
        if let Some(values) = trace.get(step, shown, mode) {
            let values = values.iter().map(|value| other(*value)).collect();
            trace.set(step, shown, mode, values);
        }
    }
}

/// Changes every number.
fn of_all(trace: &mut Trace, other: impl Fn(f64) -> f64 + Copy) {
    for quantity in Quantity::ALL {
        of(trace, quantity, other);
    }
}

/// The report without its line breaks.
fn text_of(report: &Report) -> String {
    let text = report::check::text(report);
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn problem(id: &str) -> ProblemFile {
    let all = case::all().unwrap();
    all.iter().find(|case| case.problem.id == id).unwrap().problem.clone()
}

fn verdict(subject: &mut dyn Subject, ids: &[&str]) -> Report {
    let selection = Selection {
        ids: ids.iter().map(|&id| id.into()).collect(),
        ..Selection::default()
    };
    check(subject, &selection, &|_| {}).unwrap()
}
