//! Goal: a verdict is what its definition says at every limit: right, inherited, a fault, nobody can tell.
//!
//! Method: one small problem whose values can be followed by hand, with errors, noises and units of which the answer is known; numbers are
//! dyadic, so that a limit is met exactly. Kind of evidence: exact.

#![allow(clippy::float_cmp, reason = "a limit is met exactly")]

use immaculate::imm::{Needs, Quantity as Q};
use immaculate::number::RandomRounding;
use immaculate::oracle::case::{self, Case as Published, Expected};
use immaculate::oracle::check::{CaseReport, Outcome, Report, Selection, check};
use immaculate::oracle::diagnose::{Diagnosis, Evidence, Share, diagnose};
use immaculate::oracle::formula::ComputedFormulas;
use immaculate::oracle::judge::{Case, Finding, Judged, Judgement, LIMIT, Place, Reference};
use immaculate::oracle::noise::spread;
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::run::{Computed, Triangle, run_in_doubles};
use immaculate::oracle::scale::scales;
use immaculate::oracle::subject::{Answer, Broken, Level, Planted, Precision, Ready, Subject};
use immaculate::oracle::trace::{Table, Trace};
use immaculate::oracle::variant::{Kind, Variant, catalogue, find};
use serde_json::json;
use std::collections::BTreeSet;

// Limits

/// Value 2, unit 4, noise 4 · 2⁻³⁰, that is 2⁻³⁰ units: 400 · 2⁻³⁰ is a hundred times the noise.
#[test]
fn an_error_of_a_hundred_noises_is_right_and_one_of_more_is_not() {
    let tiny = 2.0_f64.powi(-30);
    for (error, finding) in [
        (400.0, Finding::Right),
        (1.0, Finding::Right),
        (401.0, Finding::Fault),
        (-400.0, Finding::Right),
        (-401.0, Finding::Fault),
    ] {
        let mut scene = Scene::new();
        scene.set_unit(MEAN, &[4.0], &[4.0 * tiny]);
        scene.shown.set(MEAN.0, MEAN.1, MEAN.2, vec![2.0 + error * tiny]);
        let judged = scene.judged(MEAN);
        assert_eq!(judged.finding, finding, "{error}");
        // The error is given in units.
        assert_eq!(judged.error, error.abs() * tiny / 4.0);
    }
}

/// Where no run with random rounding was off, noise is a unit roundoff of the value's unit: 4 · 2⁻⁵³, a hundred of which are 100 · 2⁻⁵¹.
#[test]
fn a_noise_is_at_least_a_unit_roundoff() {
    for (error, is_right) in [(100.0, true), (101.0, false)] {
        let mut scene = Scene::new();
        scene.set_unit(MEAN, &[4.0], &[0.0]);
        scene
            .shown
            .set(MEAN.0, MEAN.1, MEAN.2, vec![2.0 + error * 2.0_f64.powi(-51)]);
        assert_eq!(scene.judged(MEAN).finding == Finding::Right, is_right, "{error}");
    }
}

/// One number of a value may be spared by rounding, in one algebra and not in another: the noise is that of the noisiest, in its unit.
#[test]
fn the_numbers_of_a_value_have_one_noise_in_their_units() {
    let place = (1, Q::PredictedModeProbabilities, 0);
    let tiny = 2.0_f64.powi(-30);
    for (error, finding) in [(100.0, Finding::Right), (101.0, Finding::Fault)] {
        let mut scene = Scene::new();
        // Units of 8 and 2: the first number's noise is 2⁻³⁰ of its unit, so the second may be off by 2 · 100 · 2⁻³⁰.
        scene.set_unit(place, &[8.0, 2.0], &[8.0 * tiny, 0.0]);
        scene.shown.set(1, place.1, 0, vec![0.5, 0.5 + 2.0 * error * tiny]);
        let judged = scene.judged(place);
        assert_eq!(judged.finding, finding, "{error}");
        let own = judged.own.unwrap();
        assert_eq!((own.index, own.shown, own.expected), (1, 0.5 + 2.0 * error * tiny, 0.5));
    }
}

/// A unit of 100 and a noise of 1: a hundred noises are the unit, and not yet more.
#[test]
fn a_value_is_drowned_where_a_hundred_noises_are_more_than_its_unit() {
    assert_eq!(LIMIT, 100.0);
    let is_drowned = |noise: f64| {
        let mut scene = Scene::new();
        scene.set_unit(MEAN, &[100.0], &[noise]);
        scene.reference.is_drowned(MEAN)
    };
    assert!(!is_drowned(1.0) && !is_drowned(0.0));
    assert!(is_drowned(1.0_f64.next_up()) && is_drowned(f64::INFINITY) && is_drowned(f64::NAN));
    // Of what is not there nothing is drowned.
    assert!(!Scene::new().reference.is_drowned((2, Q::Innovation, 0)));
}

/// Of a drowned value that is near the certified one nobody can tell whether it is right; one that is far from it and from its own inputs
/// is wrong all the same.
#[test]
fn nobody_can_tell_whether_a_drowned_value_is_right() {
    let mut scene = Scene::new();
    scene.set_unit(MEAN, &[1.0], &[1.0]);
    assert_eq!(scene.judged(MEAN).finding, Finding::CannotTell);
    scene.shown.set(MEAN.0, MEAN.1, MEAN.2, vec![1000.0]);
    assert_eq!(scene.judged(MEAN).finding, Finding::Fault);
}

/// A whole turn of an expected bearing is no error. Of an innovation it is one, since it was to be wrapped; and a range has no turns.
#[test]
fn a_turn_counts_in_an_innovation_and_not_in_an_expected_bearing() {
    let case = published("step.cubature-3");
    let certified = certified(case);
    let angles = case.problem.angles_of(&case.problem.sensors_at()[0]);
    let bearing = (0..2).find(|&row| angles[row]).unwrap();
    let turned = |quantity, row: usize, turns: f64| {
        let mut scene = Scene::of(&case.problem, certified);
        let mut values = certified.get(1, quantity, 0).unwrap().clone();
        values[row] += turns * 2.0 * std::f64::consts::PI;
        scene.shown.set(1, quantity, 0, values);
        scene.judged((1, quantity, 0)).finding
    };
    for turns in [1.0, -1.0, 2.0, 3.0] {
        assert_eq!(turned(Q::PredictedMeasurement, bearing, turns), Finding::Right);
        assert_eq!(turned(Q::PredictedMeasurement, 1 - bearing, turns), Finding::Fault);
        assert_eq!(turned(Q::Innovation, bearing, turns), Finding::Fault);
    }
    assert_eq!(turned(Q::PredictedMeasurement, bearing, 0.5), Finding::Fault);
}

/// By hand: half the distance of 1 from the next number, and the least number, below which a value may be zero.
#[test]
fn a_precision_has_a_roundoff_and_a_least_number() {
    let of = |precision: Precision| (precision.unit_roundoff(), precision.least_number());
    assert_eq!(
        of(Precision::Double),
        (2.0_f64.powi(-53), f64::MIN_POSITIVE * f64::EPSILON)
    );
    assert_eq!(of(Precision::Single), (2.0_f64.powi(-24), 2.0_f64.powi(-149)));
    // With two digits 1 is followed by 1.1, half the distance is 0.05.
    for (digits, roundoff) in [(2, 5e-2), (7, 5e-7), (15, 5e-15)] {
        let (found, least) = of(Precision::DecimalDigits(digits));
        assert!(
            (found - roundoff).abs() < 1e-3 * roundoff && least > 0.0,
            "{digits}: {found}"
        );
    }
}

/// 2⁻¹⁴⁹ is the least number of single precision: a hundred of them are a hundred noises of a value that is next to nothing.
#[test]
fn what_is_below_the_least_number_may_be_zero() {
    let place = (1, Q::PredictedModeProbabilities, 0);
    let least = 2.0_f64.powi(-149);
    for (times, precision, finding) in [
        (100.0, Precision::Single, Finding::Right),
        (101.0, Precision::Single, Finding::Fault),
        (100.0, Precision::Double, Finding::Fault),
    ] {
        let mut scene = Scene::new();
        scene.precision = precision;
        scene.reference.trace.set(1, place.1, 0, vec![1.0, times * least]);
        scene.set_unit(place, &[1.0, times * least], &[0.0, 0.0]);
        scene.shown.set(1, place.1, 0, vec![1.0, 0.0]);
        assert_eq!(scene.judged(place).finding, finding, "{times} in {precision}");
    }
}

/// A filter with fixed gains has no covariance. The unit of an entry of its mean is the deviation of its correction, √(K S Kᵀ), in the mode
/// where that is greatest, by hand: √(½ · 4 · ½) = 1 and √(3 · 4 · 3) = 6; √(2 · 1 · 2) = 2 and 0, which is no unit.
#[test]
fn a_mean_without_a_covariance_has_the_unit_of_its_correction() {
    let estimate = json!({ "mean": [1.0, 2.0] });
    let mode = json!({ "name": "walk", "F": [[1.0, 0.0], [0.0, 1.0]], "Q": [[1.0, 0.0], [0.0, 1.0]] });
    let with = |gains: [[f64; 2]; 2]| {
        let given = |[a, b]: [f64; 2], s: f64| json!({ "gain": [[a], [b]], "innovation_covariance": [[s]] });
        let mut problem = json!(Scene::new().problem);
        problem["state"] = json!(["x", "y"]);
        problem["units"] = json!(["m", "m"]);
        problem["modes"] = json!([mode, mode]);
        problem["measurement"]["H"] = json!([[1.0, 1.0]]);
        problem["filter"] =
            json!({ "kind": "fixed-gain", "mixing": "mixed", "modes": [given(gains[0], 4.0), given(gains[1], 1.0)] });
        problem["initial"]["modes"] = json!([estimate, estimate]);
        let problem = ProblemFile::read(&problem.to_string()).unwrap();
        let (trace, _) = run_in_doubles(&problem).unwrap();
        let scale = scales(&problem, &trace);
        (
            scale.get(1, Q::UpdatedMean, 1).unwrap().clone(),
            scale.get(1, Q::Innovation, 0).unwrap().clone(),
        )
    };
    assert_eq!(with([[0.5, 3.0], [2.0, 0.0]]), (vec![2.0, 6.0], vec![2.0]));
    assert_eq!(with([[0.5, 0.0], [0.25, 0.0]]), (vec![1.0, 1.0], vec![2.0]));
}

// Inputs that are not shown

/// The quantities between a value and the shown ones that it depends on, by hand: a step without a detection needs no measured value, a
/// step with one does, and behind what is shown nothing is looked for.
#[test]
fn what_is_hidden_is_what_lies_between_a_value_and_the_shown_ones() {
    let prediction = vec![
        Q::PredictedModeProbabilities,
        Q::MixingProbabilities,
        Q::MixedMean,
        Q::MixedCovariance,
        Q::PredictedMean,
    ];
    let measured = [
        Q::PredictedCovariance,
        Q::PredictedMeasurement,
        Q::Innovation,
        Q::InnovationCovariance,
        Q::CrossCovariance,
        Q::Gain,
    ];
    let with_measured: Vec<Q> = prediction.iter().copied().chain(measured).collect();
    let without_step = |step: usize, shown: &[Q]| {
        let mut scene = Scene::new();
        scene.hide(|place| place.0 == step && !shown.contains(&place.1));
        scene
    };
    // Step 2 has no detection, steps 1 and 3 have one.
    let hidden = |step| {
        without_step(step, &[Q::UpdatedMean])
            .judged((step, Q::UpdatedMean, 0))
            .hidden
    };
    assert_eq!(hidden(1), with_measured);
    assert_eq!(hidden(2), prediction);
    assert_eq!(hidden(3), with_measured);
    // What is computed from a step that is not shown at all is computed from what that was computed from.
    let mut all = with_measured.clone();
    all.push(Q::UpdatedMean);
    assert_eq!(without_step(1, &[]).judged((2, Q::MixedMean, 0)).hidden, all);
}

/// A mode's value is computed from that mode's of the same step, from those of all modes of the step before, and a value of all modes
/// from those of each.
#[test]
fn what_is_hidden_of_another_mode_matters_where_the_modes_meet() {
    let hidden = |of: Place, place: Place| {
        let mut scene = Scene::new();
        scene.hide(|other| other == of);
        scene.judged(place).hidden
    };
    let nothing: Vec<Q> = vec![];
    assert_eq!(hidden((1, Q::UpdatedMean, 1), (2, Q::MixedMean, 0)), [Q::UpdatedMean]);
    assert_eq!(hidden((2, Q::MixedMean, 1), (2, Q::PredictedMean, 0)), nothing);
    assert_eq!(hidden((2, Q::MixedMean, 0), (2, Q::PredictedMean, 0)), [Q::MixedMean]);
    assert_eq!(
        hidden((1, Q::UpdatedMean, 1), (1, Q::CombinedMean, 0)),
        [Q::UpdatedMean]
    );
    assert_eq!(
        hidden((1, Q::ModeProbabilities, 0), (2, Q::MixingProbabilities, 1)),
        [Q::ModeProbabilities]
    );
    assert_eq!(
        hidden((1, Q::ModeProbabilities, 0), (3, Q::MixingProbabilities, 1)),
        nothing
    );
}

/// Two values that are both off, with one hidden gain behind them: the first is at fault, of the other it cannot be said. With the gain
/// shown, and right, both are at fault.
#[test]
fn what_is_built_on_a_suspected_value_is_undetermined() {
    let findings = |is_gain_shown: bool| {
        let mut scene = Scene::new();
        scene.shown.set(1, Q::UpdatedMean, 0, vec![9.0]);
        scene.shown.set(1, Q::UpdatedCovariance, 0, vec![9.0]);
        scene.hide(|place| place == (1, Q::Gain, 0) && !is_gain_shown);
        [Q::UpdatedMean, Q::UpdatedCovariance].map(|quantity| scene.judged((1, quantity, 0)).finding)
    };
    assert_eq!(findings(true), [Finding::Fault, Finding::Fault]);
    assert_eq!(findings(false), [Finding::Fault, Finding::Undetermined]);
}

/// A value that follows from a wrong one is inherited; one that should have followed from it and does not is a fault.
#[test]
fn an_error_that_follows_from_another_is_inherited() {
    let mut scene = Scene::new();
    // x̂ = 9 in both modes: the combined mean is 9 whatever their probabilities are.
    for j in 0..2 {
        scene.shown.set(1, Q::UpdatedMean, j, vec![9.0]);
    }
    scene.shown.set(1, Q::CombinedMean, 0, vec![9.0]);
    assert_eq!(scene.judged((1, Q::UpdatedMean, 0)).finding, Finding::Fault);
    assert_eq!(scene.judged((1, Q::CombinedMean, 0)).finding, Finding::Propagated);
    scene.shown.set(1, Q::CombinedMean, 0, vec![8.0]);
    assert_eq!(scene.judged((1, Q::CombinedMean, 0)).finding, Finding::Fault);
    // A number that is none is inherited by what is computed from it.
    scene.shown.set(1, Q::UpdatedMean, 1, vec![f64::NAN]);
    scene.shown.set(1, Q::CombinedMean, 0, vec![f64::NAN]);
    assert_eq!(scene.judged((1, Q::UpdatedMean, 1)).finding, Finding::NotFinite);
    assert_eq!(scene.judged((1, Q::CombinedMean, 0)).finding, Finding::Propagated);
}

/// A step that has no answer on the program's own values, since its S is negative, ends nothing where the program shows all that the next
/// step needs: what is off there is at fault. Where any of it is hidden nothing more can be said.
#[test]
fn a_step_without_an_answer_is_passed_over_where_the_next_is_shown_its_start() {
    let finding = |hidden: Option<Q>| {
        let mut scene = Scene::new();
        for j in 0..2 {
            scene.shown.set(1, Q::InnovationCovariance, j, vec![-1.0]);
        }
        scene.shown.set(2, Q::PredictedMean, 0, vec![50.0]);
        scene.hide(|place| place.0 == 1 && Some(place.1) == hidden);
        let Judgement { values, failures } = scene.case().judge(&[]).unwrap();
        assert!(failures[0].starts_with("step 1, mode `walk`, gain"), "{failures:?}");
        let place = (2, Q::PredictedMean, 0);
        values.into_iter().find(|judged| judged.place == place).unwrap().finding
    };
    assert_eq!(finding(None), Finding::Fault);
    assert_eq!(finding(Some(Q::CombinedMean)), Finding::Fault);
    for needed in [Q::UpdatedMean, Q::UpdatedCovariance, Q::ModeProbabilities] {
        assert_eq!(finding(Some(needed)), Finding::Undetermined, "{needed:?}");
    }
}

// What explains a value

/// An error of some ten thousand noises is far from none, though it is near enough to be looked at twice.
#[test]
fn an_explanation_leaves_no_error_of_more_than_a_hundred_noises() {
    let mut scene = Scene::new();
    let nothing = BTreeSet::new();
    assert!(scene.case().is_explained_by(&[], &nothing).unwrap());
    scene.shown.set(1, Q::CombinedMean, 0, vec![2.0 + 1e-11]);
    let judged = scene.judged((1, Q::CombinedMean, 0));
    let ratio = judged.own.unwrap().ratio;
    assert!(1e3 < ratio && ratio < 1e5, "{ratio}");
    assert!(!scene.case().is_explained_by(&[], &nothing).unwrap());
    // What is passed over needs no explanation.
    let passed = BTreeSet::from([(1, Q::CombinedMean, 0)]);
    assert!(scene.case().is_explained_by(&[], &passed).unwrap());
}

/// The triangles of a covariance that a prediction is made from differ by this many units, and so does the noise of the prediction: where
/// that is as large as a unit it would excuse anything, and a form is no excuse. Nor is it one for what is not finite.
#[test]
fn a_form_excuses_rounding_and_nothing_that_runs_away() {
    let case = published("step.n4-m2.two-modes");
    let explained = |apart: f64, variants: &[&str], is_finite: bool| {
        let mut scene = Scene::of(&case.problem, certified(case));
        let of = |trace: &Trace, quantity| trace.get(1, quantity, 0).unwrap().clone();
        let mut mixed = of(&scene.shown, Q::MixedCovariance);
        mixed[1] += apart * of(&scene.reference.scale, Q::MixedCovariance)[1];
        scene.shown.set(1, Q::MixedCovariance, 0, mixed);
        let mut predicted = of(&scene.shown, Q::PredictedCovariance);
        predicted[0] += 3.0 * apart * of(&scene.reference.scale, Q::PredictedCovariance)[0];
        if !is_finite {
            predicted[0] = f64::NAN;
        }
        scene.shown.set(1, Q::PredictedCovariance, 0, predicted);
        let nothing = BTreeSet::new();
        scene
            .case()
            .is_quantity_explained_by(variants, Q::PredictedCovariance, &nothing)
            .unwrap()
    };
    let form = "prediction-not-mirrored";
    assert!(explained(1e-9, &[], true) && explained(1e-9, &[form], true));
    assert!(explained(0.1, &[], true) && !explained(0.1, &[form], true));
    assert!(!explained(1e-9, &[form], false));
}

#[test]
fn a_quantity_is_explained_for_itself() {
    let mut scene = Scene::new();
    scene.shown.set(1, Q::Innovation, 0, vec![7.0]);
    let explained = |quantity, passed: &[Place]| {
        let passed = passed.iter().copied().collect();
        scene.case().is_quantity_explained_by(&[], quantity, &passed).unwrap()
    };
    assert!(explained(Q::PredictedMean, &[]) && explained(Q::Gain, &[]));
    // 2 does not follow from an innovation of 7.
    assert!(!explained(Q::UpdatedMean, &[]));
    assert!(!explained(Q::Innovation, &[]) && !explained(Q::Innovation, &[(1, Q::Innovation, 1)]));
    assert!(explained(Q::Innovation, &[(1, Q::Innovation, 0)]));
}

// The noise

/// The greatest deviation of any run; infinite where a run has no value, or none that is a number.
#[test]
fn the_noise_is_the_greatest_deviation_of_a_run() {
    let dimensions = Scene::new().problem.dimensions();
    let mut centre = Trace::empty(&dimensions);
    for (j, value) in [8.0, -4.0].into_iter().enumerate() {
        centre.set(1, Q::UpdatedMean, j, vec![value]);
    }
    let spread_of = |runs: [Option<[f64; 2]>; 3]| {
        let run = |number: u64| {
            let mut values = Table::empty(&dimensions);
            for (j, value) in runs[usize::try_from(number).unwrap()].into_iter().flatten().enumerate() {
                values.set(1, Q::UpdatedMean, j, vec![RandomRounding::exact(value)]);
            }
            Ok(Computed {
                values,
                failures: Vec::new(),
            })
        };
        let noise = spread(&centre, f64::EPSILON / 2.0, 3, run).unwrap();
        [0, 1].map(|j| noise.get(1, Q::UpdatedMean, j).unwrap()[0])
    };
    let [first, second] = spread_of([Some([8.0, -4.0]), Some([11.0, -4.5]), Some([7.0, -4.0])]);
    // The outputs are rounded once more.
    assert!(
        (first - 3.0).abs() < 1e-14 && (second - 0.5).abs() < 1e-14,
        "{first} {second}"
    );
    assert_eq!(spread_of([Some([8.0, f64::NAN]), None, None]), [f64::INFINITY; 2]);
    let [first, second] = spread_of([Some([8.0, f64::NAN]), Some([8.0, -4.0]), Some([8.0, -4.0])]);
    assert!(first < 1e-14 && second == f64::INFINITY);
}

// The verdict over cases

/// A form or a convention is no mistake and excuses what it explains; not an early end, and no mistake.
#[test]
fn what_is_excused_is_what_a_form_or_a_convention_explains() {
    let of_kind = |kind| catalogue().iter().find(|variant| variant.kind == kind).unwrap();
    for kind in [Kind::Form, Kind::Convention, Kind::Mistake] {
        let excuse = kind != Kind::Mistake;
        let mut report = report(Outcome::Wrong, Diagnosis::One(vec![of_kind(kind)]));
        assert_eq!((report.is_excused(), report.is_wrong()), (excuse, !excuse), "{kind:?}");
        report.cases[0].stopped = Some("a singular matrix".into());
        assert!(!report.is_excused() && report.is_wrong());
        // One that stopped and was right until then excuses the others.
        report.cases[0].outcome = Outcome::CannotTell;
        assert_eq!(report.is_excused(), excuse);
    }
    let pair = [of_kind(Kind::Form), of_kind(Kind::Mistake)];
    for diagnosis in [
        Diagnosis::Nothing,
        Diagnosis::Several(vec![vec![pair[0]], vec![pair[1]]]),
        Diagnosis::Pairs(vec![pair]),
    ] {
        assert!(!report(Outcome::Wrong, diagnosis).is_excused());
    }
    let by_filter = |other: &[&'static Variant]| {
        let one = |variants: &[&'static Variant]| Diagnosis::One(variants.to_vec());
        Diagnosis::ByFilter(
            [Diagnosis::Nothing, one(&pair[..1]), one(other)]
                .map(|of_filter| ("a filter".into(), of_filter))
                .into(),
        )
    };
    assert!(report(Outcome::Wrong, by_filter(&[])).is_excused());
    assert!(!report(Outcome::Wrong, by_filter(&pair[1..])).is_excused());
}

/// Far from the origin raw moments lose digits, and a doubled noise is a mistake: the one is otherwise, the other a fault.
#[test]
fn what_a_form_explains_is_no_fault_beside_a_mistake() {
    let pair = ["process-noise-doubled", "mixture-by-raw-moments"].map(|id| find(id).unwrap());
    let [mistake, form] = pair;
    let report = verdict(&mut planted(&[&mistake.id, &form.id]), "far.linear");
    let text = immaculate::report::check::text(&report);
    for (quantity, heading) in [(mistake.quantity, "FAULT"), (form.quantity, "OTHERWISE")] {
        assert_eq!(report.is_otherwise(quantity), heading == "OTHERWISE", "{text}");
        assert!(text.contains(&format!("{heading}  {}", quantity.name())), "{text}");
    }
    assert!(report.is_wrong() && !report.is_excused());
    // So it is where they were found one equation after the other, or in different cases.
    let part = |variant| Share {
        variants: vec![variant],
        cases: 1,
    };
    let in_parts = |unexplained: Vec<String>| Diagnosis::InParts {
        parts: pair.map(part).to_vec(),
        unexplained,
        formulas: ComputedFormulas::default(),
        of: 2,
        pairs: true,
    };
    for (diagnosis, is_otherwise) in [
        (Diagnosis::Several(pair.map(|variant| vec![variant]).to_vec()), true),
        (in_parts(vec![]), true),
        (in_parts(vec!["another".into()]), false),
        (Diagnosis::One(vec![mistake]), false),
        (Diagnosis::Nothing, false),
    ] {
        let report = Report {
            diagnosis,
            ..report.clone()
        };
        assert_eq!(
            report.is_otherwise(form.quantity),
            is_otherwise,
            "{:?}",
            report.diagnosis
        );
        assert!(!report.is_otherwise(mistake.quantity));
    }
}

#[test]
fn a_report_is_empty_where_nothing_was_judged() {
    let is_empty = |outcome| report(outcome, Diagnosis::Nothing).is_empty();
    let reason = String::new;
    for nothing in [
        Outcome::NothingShown,
        Outcome::CannotTell,
        Outcome::Skipped { reason: reason() },
    ] {
        assert!(is_empty(nothing));
    }
    for something in [
        Outcome::Right,
        Outcome::Wrong,
        Outcome::NotRejected,
        Outcome::Stopped { reason: reason() },
    ] {
        assert!(!is_empty(something));
    }
}

/// A program that shows the certified numbers has all the digits of a double, −log₁₀ 2⁻⁵³; one that is off by 2⁻⁴⁸ units, 14.4.
#[test]
fn the_digits_are_those_of_the_worst_value_that_is_right() {
    let digits = |error: f64| {
        let answer = move |problem: &ProblemFile| {
            let certified = certified(published(&problem.id));
            let mut shown = certified.clone();
            // The chain of this case gives 0.64 and 0.36; the unit of a probability is the probability.
            let chain = certified.get(1, Q::PredictedModeProbabilities, 0).unwrap();
            shown.set(
                1,
                Q::PredictedModeProbabilities,
                0,
                chain.iter().map(|c| c * (1.0 + error)).collect(),
            );
            shown
        };
        let report = verdict(&mut Shows::new(answer), "step.n4-m2.two-modes");
        assert_eq!(report.cases[0].outcome, Outcome::Right);
        report.cases[0].digits.unwrap()
    };
    assert!((digits(0.0) - 53.0 * 2.0_f64.log10()).abs() < 1e-9);
    assert!((digits(2.0_f64.powi(-48)) - 48.0 * 2.0_f64.log10()).abs() < 0.05);
}

/// Every quantity that was never shown is named, whatever the others are, and no other.
#[test]
fn what_was_never_shown_is_said() {
    let id = "step.n4-m2.two-modes";
    let answer = |problem: &ProblemFile| {
        let certified = certified(published(&problem.id));
        let mut shown = Trace::empty(&problem.dimensions());
        // The gain of one mode alone is shown, too.
        for place in [(1, Q::PredictedModeProbabilities, 0), (1, Q::Gain, 1)] {
            shown.set(
                place.0,
                place.1,
                place.2,
                certified.get(place.0, place.1, place.2).unwrap().clone(),
            );
        }
        shown
    };
    let report = verdict(&mut Shows::new(answer), id);
    let expected = Q::ALL.into_iter().filter(|quantity| {
        // This filter converts nothing, and linearises nothing.
        let is_there = |needed| matches!(needed, Needs::Covariances | Needs::Detection);
        quantity.exists(is_there) && ![Q::PredictedModeProbabilities, Q::Gain].contains(quantity)
    });
    assert_eq!(report.hidden, expected.collect::<Vec<_>>());
    assert_eq!(verdict(&mut planted(&[]), id).hidden, []);
    // A filter in Rust that says nothing at its end has nothing to remark.
    assert_eq!(report.remarks, Vec::<String>::new());
}

/// Exact: a program's covariances are symmetric, or should be. Reading their upper triangles is reading those of their transposes.
#[test]
fn the_upper_triangle_is_the_lower_one_of_the_transpose() {
    let case = published("update.kalman");
    let setup = case.problem.setup_in_doubles().unwrap();
    let run = setup.run().in_doubles();
    // The entries above the diagonal some per cent off, and the transposes of that.
    let size = |quantity: Q, values: &[f64]| {
        if quantity.is_covariance() {
            values.len().isqrt()
        } else {
            0
        }
    };
    let skewed = run.map(|(_, quantity, _), values| {
        let (mut values, n) = (values.clone(), size(quantity, values));
        for (row, column) in (0..n).flat_map(|row| (row + 1..n).map(move |column| (row, column))) {
            values[row * n + column] *= 1.01;
        }
        values
    });
    let transposed = skewed.map(|(_, quantity, _), values| match size(quantity, values) {
        0 => values.clone(),
        n => (0..n * n).map(|index| values[index % n * n + index / n]).collect(),
    });
    let along = |shown: &Trace, triangle| setup.run_along(shown, RandomRounding::exact, triangle).in_doubles();
    assert_eq!(along(&skewed, Triangle::Upper), along(&transposed, Triangle::Lower));
    assert_eq!(along(&transposed, Triangle::Upper), along(&skewed, Triangle::Lower));
    assert_ne!(along(&skewed, Triangle::Upper), along(&skewed, Triangle::Lower));
}

/// With two digits a hundred noises are more than any unit: nobody could be sure to go on. With the digits of a double the same program
/// has stopped. Of a long run it is the step after the last shown one that counts.
#[test]
fn a_program_that_stops_where_rounding_is_as_large_as_a_value_is_not_blamed() {
    let outcome = |precision: Precision, id: &str, steps: usize| {
        let mut program = Shows::new(move |problem: &ProblemFile| {
            let mut shown = Trace::empty(&problem.dimensions());
            let certified = certified(published(&problem.id));
            for place in certified.all_places().filter(|place| place.0 <= steps) {
                if let Some(values) = certified.get(place.0, place.1, place.2) {
                    shown.set(place.0, place.1, place.2, values.clone());
                }
            }
            shown
        });
        program.ready.precision = precision;
        program.error = Some("a singular matrix".into());
        verdict(&mut program, id).cases.remove(0).outcome
    };
    let stopped = Outcome::Stopped {
        reason: "a singular matrix".into(),
    };
    for steps in [0, 1] {
        assert_eq!(
            outcome(Precision::DecimalDigits(2), "step.n4-m2.two-modes", steps),
            Outcome::CannotTell
        );
        assert_eq!(outcome(Precision::Double, "step.n4-m2.two-modes", steps), stopped);
    }
    let (precision, id) = (Precision::Single, DROWNING);
    let case = published(id);
    let certified = certified(case);
    let reference = Reference::new(&case.problem, Some(certified), &[], precision).unwrap();
    let first = certified
        .all_places()
        .find(|place| reference.is_drowned(*place))
        .unwrap()
        .0;
    println!("{first}");
    assert!(first > 2, "{first}");
    assert_eq!(outcome(precision, id, first - 1), Outcome::CannotTell);
    assert_eq!(outcome(precision, id, first - 2), stopped);
}

/// A run of which a value drowns in the rounding of single precision some steps after the first.
const DROWNING: &str = "zhu2016.kalman.run";

/// A value that is right though what it is computed from is not was made by other means, and says nothing about what was done: the mistake
/// is named all the same.
#[test]
fn a_value_that_is_right_by_other_means_does_not_hide_a_mistake() {
    let id = "mixed-spread-omitted";
    let answer = |problem: &ProblemFile| {
        let Answer::Steps { trace, .. } = planted(&[id]).run(problem) else {
            panic!("an answer")
        };
        let certified = certified(published(&problem.id));
        let mut shown = trace;
        let covariance = certified.get(1, Q::CombinedCovariance, 0).unwrap();
        assert_ne!(shown.get(1, Q::CombinedCovariance, 0), Some(covariance));
        shown.set(1, Q::CombinedCovariance, 0, covariance.clone());
        shown
    };
    let report = verdict(&mut Shows::new(answer), "step.n4-m2.two-modes");
    assert_eq!(report.diagnosis, Diagnosis::One(vec![find(id).unwrap()]));
}

// What was done

/// A value that is no number must be explained, too: not by a variant that makes no difference where the others are looked at.
#[test]
fn what_is_not_finite_is_not_explained_by_what_gives_a_number() {
    let answer = |problem: &ProblemFile| {
        let certified = certified(published(&problem.id));
        let mut shown = certified.clone();
        shown.set(1, Q::CombinedMean, 0, vec![f64::NAN; 4]);
        shown
    };
    let report = verdict(&mut Shows::new(answer), "step.n4-m2.two-modes");
    assert_eq!(report.cases[0].outcome, Outcome::Wrong);
    // Of nothing else it is known to be wrong, so that nothing more is looked for than one variant.
    assert_eq!(in_words(&report.diagnosis), "nothing");
}

/// Where all is shown, mistakes are found one for each equation, in the order of the equations, up to six.
#[test]
fn as_many_mistakes_as_six_are_named_together_on_one_case() {
    let mistakes = [
        "chain-skipped",
        "mixed-spread-omitted",
        "process-noise-doubled",
        "measurement-noise-doubled",
        "update-subtracted",
        "determinant-omitted",
        "combined-spread-omitted",
    ];
    for (count, expected) in [
        (0, "nothing".to_owned()),
        (1, mistakes[0].to_owned()),
        (2, mistakes[..2].join(" and ")),
        (6, mistakes[..6].join(" and ")),
        (7, "none explains any of 1".to_owned()),
    ] {
        let evidence = [Scene::planted(&lively("one", "kalman"), &mistakes[..count])];
        assert_eq!(what_was_done(&evidence), expected);
    }
}

/// Of a filter that shows what it ends with, an update of the other sign may be one of the mean or of the innovation.
#[test]
fn where_too_little_is_shown_for_equations_one_by_one_all_pairs_are_tried() {
    let problem = lively("one", "kalman");
    let is_not_an_end = |place: Place| !matches!(place.1, Q::UpdatedMean | Q::UpdatedCovariance | Q::ModeProbabilities);
    for (planted, expected) in [
        (
            ["process-noise-doubled", "update-subtracted"],
            "process-noise-doubled with innovation-reversed, or process-noise-doubled with update-subtracted",
        ),
        (
            ["process-noise-doubled", "measurement-noise-doubled"],
            "process-noise-doubled with measurement-noise-doubled",
        ),
    ] {
        let mut scene = Scene::planted(&problem, &planted);
        scene.hide(is_not_an_end);
        assert_eq!(what_was_done(&[scene]), expected);
    }
}

/// With S = ¼ + 2 · ⅛ + ½ = 1 a likelihood that is not normalised at all, a mistake, is one without 2π, a convention.
#[test]
fn of_pairs_those_with_fewer_mistakes_are_named() {
    let mut problem = json!(unit_innovation_covariance());
    for mode in ["/modes/0/Q", "/modes/1/Q"] {
        *problem.pointer_mut(mode).unwrap() = json!([[0.125]]);
    }
    let problem = ProblemFile::read(&problem.to_string()).unwrap();
    let mistake = "process-noise-doubled";
    let mut scene = Scene::planted(&problem, &[mistake, "log-likelihood-without-two-pi"]);
    scene.hide(|place| !matches!(place.1, Q::UpdatedMean | Q::UpdatedCovariance | Q::LogLikelihood));
    for other in ["log-likelihood-without-two-pi", "likelihood-not-normalised"] {
        let is_explained = scene.case().is_explained_by(&[mistake, other], &BTreeSet::new());
        assert!(is_explained.unwrap(), "{other}");
    }
    assert_eq!(
        what_was_done(&[scene]),
        "process-noise-doubled with log-likelihood-without-two-pi"
    );
}

/// Equations cannot distinguish mistakes of different filters, and pairs even less.
#[test]
fn where_the_filters_of_a_program_have_different_mistakes_each_is_told_its_own() {
    let kalman = |variants: &[&str]| Scene::planted(&lively("linear", "kalman"), variants);
    let cubature = |variants: &[&str]| Scene::planted(&lively("points", "cubature"), variants);
    for (evidence, expected) in [
        (
            [kalman(&["update-subtracted"]), cubature(&["innovation-reversed"])],
            "cubature-3: innovation-reversed; kalman: update-subtracted",
        ),
        // Either is invisible in the other filter, so that the two together explain all as well.
        (
            [
                kalman(&["cross-covariance-of-mixed-covariance"]),
                cubature(&["cross-covariance-of-propagated-points"]),
            ],
            "cubature-3: cross-covariance-of-propagated-points; kalman: cross-covariance-of-mixed-covariance",
        ),
        (
            [kalman(&[]).wild(), cubature(&["innovation-reversed"])],
            "cubature-3: innovation-reversed; kalman: none explains any of 1",
        ),
        ([kalman(&[]).wild(), cubature(&[]).wild()], "none explains any of 2"),
    ] {
        assert_eq!(what_was_done(&evidence), expected);
    }
}

#[test]
fn where_nothing_explains_all_what_explains_most_is_named_with_what_it_leaves() {
    let planted = |id: &str, variant: &str| Scene::planted(&lively(id, "kalman"), &[variant]);
    for (second, expected) in [
        (
            "process-noise-doubled",
            "process-noise-doubled in 2, but for [third] of 3",
        ),
        (
            "update-subtracted",
            "process-noise-doubled in 1, update-subtracted in 1, but for [third] of 3",
        ),
    ] {
        let evidence = [
            planted("first", "process-noise-doubled"),
            planted("second", second),
            planted("third", "process-noise-doubled").wild(),
        ];
        assert_eq!(what_was_done(&evidence), expected);
    }
}

/// A mode of probability zero may hold whatever is finite: programs mix uniformly there, or not at all. What is not finite is in every sum.
#[test]
fn what_no_output_depends_on_is_no_fault() {
    for id in ["chain.unreachable", "extended.unreachable", "unreachable.fixed-gain"] {
        let case = published(id);
        let Expected::Trace(certified) = &case.expected else {
            panic!("{id} is run")
        };
        let scene = || Scene::of(&case.problem, certified);
        let is_unused = |(step, quantity, mode): Place| {
            let predicted = certified.get(step, Q::PredictedModeProbabilities, 0).unwrap();
            quantity.is_of_mode() && predicted[mode] == 0.0
        };
        let places = || {
            certified
                .all_places()
                .filter(|place| certified.get(place.0, place.1, place.2).is_some())
        };
        let mut other = scene();
        for (step, quantity, mode) in places().filter(|place| is_unused(*place)) {
            let values = certified.get(step, quantity, mode).unwrap();
            other.shown.set(
                step,
                quantity,
                mode,
                values.iter().map(|value| 2.0 * value + 1.0).collect(),
            );
        }
        for value in other.case().judge(&[]).unwrap().values {
            let expected = if is_unused(value.place) {
                Finding::Unused
            } else {
                Finding::Right
            };
            assert_eq!(value.finding, expected, "{id}: {:?}", value.place);
        }
        let (step, quantity, mode) = places().find(|place| is_unused(*place)).unwrap();
        let mut divided = scene();
        let count = certified.get(step, quantity, mode).unwrap().len();
        divided.shown.set(step, quantity, mode, vec![f64::NAN; count]);
        let findings = divided.case().judge(&[]).unwrap().values;
        let found = findings
            .iter()
            .find(|value| value.place == (step, quantity, mode))
            .unwrap();
        assert_eq!(found.finding, Finding::NotFinite, "{id}");
    }
}

/// With S = ¼ + ¼ + ½ = 1, whose logarithm is zero, a log-likelihood without 2π may be one that was not normalised at all, which is a
/// mistake. A program that may have a convention gets no report of it.
#[test]
fn what_may_be_a_convention_is_not_called_a_mistake() {
    let problem = unit_innovation_covariance();
    let (trace, _) = run_in_doubles(&problem).unwrap();
    assert_eq!(trace.get(1, Q::InnovationCovariance, 0), Some(&vec![1.0]));
    let mut scene = Scene::of(&problem, &trace);
    for j in 0..2 {
        // −½ 4² + ln √2π − ln √2π
        scene.shown.set(1, Q::LogLikelihood, j, vec![-8.0]);
    }
    let [convention, mistake] =
        ["log-likelihood-without-two-pi", "likelihood-not-normalised"].map(|id| find(id).unwrap());
    for variant in [convention, mistake] {
        assert!(scene.case().is_explained_by(&[&variant.id], &BTreeSet::new()).unwrap());
    }
    assert_eq!(what_was_done(&[scene]), convention.id);
}

/// A convention that is declared is judged by, on one case: the same values are another's without the declaration.
#[test]
fn a_declared_convention_is_right_and_an_undeclared_one_is_named() {
    let id = "log-likelihood-without-two-pi";
    let variant = find(id).unwrap();
    let undeclared = verdict(&mut planted(&[id]), "step.n4-m2.two-modes");
    assert_eq!(undeclared.diagnosis, Diagnosis::One(vec![variant]));
    let declared = verdict(&mut Declared(planted(&[id]), id), "step.n4-m2.two-modes");
    assert_eq!(
        (declared.diagnosis, &declared.cases[0].outcome),
        (Diagnosis::Nothing, &Outcome::Right)
    );
    // Who declares it and does not have it is another.
    let other = verdict(&mut Declared(planted(&[]), id), "step.n4-m2.two-modes");
    assert_eq!(other.cases[0].outcome, Outcome::Wrong);
    assert_eq!(other.faults().next().unwrap().1.place, (1, Q::LogLikelihood, 0));
}

// The scene

/// Two modes of a random walk, one state, one measurement: 0 ± 1 becomes 0 ± √2; R = 2, so that S = 4, the gain is ½ and the mean that
/// is measured to be 4 is 2. Step 2 has no detection.
struct Scene {
    problem: ProblemFile,
    shown: Trace,
    reference: Reference,
    precision: Precision,
}

/// The updated mean of the first mode in the first step, which is 2.
const MEAN: Place = (1, Q::UpdatedMean, 0);

impl Scene {
    fn new() -> Self {
        let estimate = json!({ "mean": [0.0], "covariance": [[1.0]] });
        let mode = |name: &str| json!({ "name": name, "F": [[1.0]], "Q": [[1.0]] });
        let problem = json!({
            "format": "immaculate-problem/1", "id": "by.hand", "about": "by hand", "flags": [], "state": ["x"], "units": ["m"],
            "modes": [mode("walk"), mode("walk again")],
            "measurement": { "kind": "linear", "H": [[1.0]] }, "R": [[2.0]], "filter": { "kind": "kalman" },
            "transition": [[0.75, 0.25], [0.25, 0.75]],
            "initial": { "mode_probabilities": [0.5, 0.5], "modes": [estimate, estimate] },
            "conventions": {
                "square_root": "cholesky-lower", "angle_mean": "centre-point", "first_step": "mixed", "log_likelihood": "full",
            },
            "measurements": [{ "step": 1, "z": [4.0] }, { "step": 2, "z": null }, { "step": 3, "z": [1.0] }],
        });
        let problem = ProblemFile::read(&problem.to_string()).unwrap();
        let (trace, stopped) = run_in_doubles(&problem).unwrap();
        assert_eq!((trace.get(1, Q::UpdatedMean, 0), stopped), (Some(&vec![2.0]), None));
        Self::of(&problem, &trace)
    }

    fn of(problem: &ProblemFile, certified: &Trace) -> Self {
        Self {
            problem: problem.clone(),
            shown: certified.clone(),
            reference: Reference::new(problem, Some(certified), &[], Precision::Double).unwrap(),
            precision: Precision::Double,
        }
    }

    /// Another unit and another noise of a value.
    fn set_unit(&mut self, (step, quantity, mode): Place, scale: &[f64], noise: &[f64]) {
        self.reference.scale.set(step, quantity, mode, scale.to_vec());
        self.reference.noise.set(step, quantity, mode, noise.to_vec());
    }

    fn hide(&mut self, is_hidden: impl Fn(Place) -> bool) {
        let mut shown = Trace::empty(&self.shown.dimensions);
        for place in self.shown.all_places().filter(|place| !is_hidden(*place)) {
            if let Some(values) = self.shown.get(place.0, place.1, place.2) {
                shown.set(place.0, place.1, place.2, values.clone());
            }
        }
        self.shown = shown;
    }

    /// What the own filter with these variants shows of a problem.
    fn planted(problem: &ProblemFile, variants: &[&str]) -> Self {
        let (certified, _) = run_in_doubles(problem).unwrap();
        let Answer::Steps { trace, error: None } = planted(variants).run(problem) else {
            panic!("{variants:?}: an answer")
        };
        let mut scene = Self::of(problem, &certified);
        scene.shown = trace;
        scene
    }

    /// With a mean in the first step that nothing explains.
    fn wild(mut self) -> Self {
        self.shown.set(1, Q::UpdatedMean, 0, vec![1234.5]);
        self
    }

    fn case(&self) -> Case<'_> {
        Case {
            problem: &self.problem,
            shown: &self.shown,
            reference: &self.reference,
            precision: self.precision,
        }
    }

    fn judged(&self, place: Place) -> Judged {
        let Judgement { values, failures } = self.case().judge(&[]).unwrap();
        assert!(failures.is_empty(), "{failures:?}");
        values.into_iter().find(|judged| judged.place == place).unwrap()
    }
}

/// Three steps of two modes in one dimension, in which every equation shows: means and variances are apart, and no noise is two or four.
fn lively(id: &str, filter: &str) -> ProblemFile {
    let mut problem = json!(Scene::new().problem);
    problem["id"] = json!(id);
    if filter == "cubature" {
        problem["filter"] = json!({ "kind": filter, "rule": "cubature-3" });
    }
    problem["modes"][0]["F"] = json!([[3.0]]);
    problem["modes"][0]["Q"] = json!([[1.5]]);
    problem["initial"]["modes"][0] = json!({ "mean": [3.0], "covariance": [[5.0]] });
    problem["R"] = json!([[3.0]]);
    ProblemFile::read(&problem.to_string()).unwrap()
}

/// One step with S = ¼ + ¼ + ½ = 1.
fn unit_innovation_covariance() -> ProblemFile {
    let mut problem = json!(Scene::new().problem);
    for mode in [
        "/modes/0/Q",
        "/modes/1/Q",
        "/initial/modes/0/covariance",
        "/initial/modes/1/covariance",
    ] {
        *problem.pointer_mut(mode).unwrap() = json!([[0.25]]);
    }
    problem["R"] = json!([[0.5]]);
    problem["measurements"].as_array_mut().unwrap().truncate(1);
    ProblemFile::read(&problem.to_string()).unwrap()
}

/// The diagnosis of faulty cases, in words; of cases that show the certified values, of cases without a fault.
fn what_was_done(scenes: &[Scene]) -> String {
    let evidence: Vec<Evidence> = scenes
        .iter()
        .map(|scene| Evidence {
            case: scene.case(),
            passed: BTreeSet::new(),
            is_faulty: scene.shown != scene.reference.trace,
            steps_to_fault: usize::MAX,
            is_beginning: false,
        })
        .collect();
    in_words(&diagnose(&evidence, &[]).unwrap())
}

fn in_words(diagnosis: &Diagnosis) -> String {
    let ids = |variants: &[&Variant], between: &str| {
        let ids: Vec<&str> = variants.iter().map(|variant| variant.id.as_str()).collect();
        ids.join(between)
    };
    let joined = |parts: Vec<String>, between: &str| parts.join(between);
    match diagnosis {
        Diagnosis::Nothing => "nothing".into(),
        Diagnosis::One(variants) => ids(variants, " or "),
        Diagnosis::Several(members) => joined(members.iter().map(|member| ids(member, " or ")).collect(), " and "),
        Diagnosis::Pairs(pairs) => joined(pairs.iter().map(|pair| ids(pair, " with ")).collect(), ", or "),
        Diagnosis::ByFilter(filters) => {
            let of_filter = |(name, found): &(String, Diagnosis)| format!("{name}: {}", in_words(found));
            joined(filters.iter().map(of_filter).collect(), "; ")
        }
        Diagnosis::InParts { parts, of, .. } if parts.is_empty() => format!("none explains any of {of}"),
        Diagnosis::InParts {
            parts, unexplained, of, ..
        } => {
            let part = |part: &Share| format!("{} in {}", ids(&part.variants, " or "), part.cases);
            let parts = joined(parts.iter().map(part).collect(), ", ");
            format!("{parts}, but for [{}] of {of}", unexplained.join(", "))
        }
    }
}

fn published(id: &str) -> &'static Published {
    case::all()
        .unwrap()
        .iter()
        .find(|case| case.problem.id == id)
        .unwrap_or_else(|| panic!("no case {id}"))
}

fn certified(case: &Published) -> &Trace {
    let Expected::Trace(trace) = &case.expected else {
        panic!("a trace")
    };
    trace
}

/// The own filter with these variants, which shows everything.
fn planted(variants: &[&str]) -> Planted {
    Planted {
        variants: variants.iter().map(|&id| id.to_owned()).collect(),
        level: Level::Everything,
    }
}

fn verdict(subject: &mut dyn Subject, id: &str) -> Report {
    let selection = Selection {
        ids: vec![id.into()],
        ..Selection::default()
    };
    let report = check(subject, &selection, &|_| ()).unwrap();
    assert_eq!(report.cases.len(), 1, "{id}");
    report
}

/// A report of one case.
fn report(outcome: Outcome, diagnosis: Diagnosis) -> Report {
    let case = CaseReport {
        outcome,
        ..CaseReport::new(&Scene::new().problem)
    };
    Report {
        ready: Ready::default(),
        echo: None,
        cases: vec![case],
        not_asked: vec![],
        diagnosis,
        hidden: vec![],
        observations: vec![],
        remarks: vec![],
    }
}

/// A program that shows what a function says.
struct Shows<F> {
    ready: Ready,
    answer: F,
    error: Option<String>,
}

impl<F: Fn(&ProblemFile) -> Trace> Shows<F> {
    fn new(answer: F) -> Self {
        Self {
            ready: Ready::default(),
            answer,
            error: None,
        }
    }
}

impl<F: Fn(&ProblemFile) -> Trace> Subject for Shows<F> {
    fn start(&mut self) -> Result<Ready, Broken> {
        Ok(self.ready.clone())
    }

    fn run(&mut self, problem: &ProblemFile) -> Answer {
        Answer::Steps {
            trace: (self.answer)(problem),
            error: self.error.clone(),
        }
    }
}

/// A program that declares a convention.
struct Declared(Planted, &'static str);

impl Subject for Declared {
    fn start(&mut self) -> Result<Ready, Broken> {
        let mut ready = self.0.start()?;
        let variant = find(self.1).unwrap();
        ready
            .conventions
            .extend(variant.convention.clone().zip(variant.value.clone()));
        Ok(ready)
    }

    fn run(&mut self, problem: &ProblemFile) -> Answer {
        self.0.run(problem)
    }
}
