//! Goal: the normalised squares of innovation and error are what they are called, nothing depends on them, and cases that were published
//! without them stay as they are.
//!
//! Method: against sums written out for two entries, against the likelihood, and across the cut of a heading; answers in which one is
//! wrong or too much; and mistakes that the search for formulas must name without a row of the catalogue.
#![allow(clippy::unwrap_used, reason = "in tests a panic is the failure")]

use immaculate::imm::{Needs, Quantity};
use immaculate::matrix::{ldl, quadratic_form};
use immaculate::number::RandomRounding as Number;
use immaculate::oracle::case::{self, Expected};
use immaculate::oracle::certify::{certified_as_far_as_it_goes, certify};
use immaculate::oracle::check::{Outcome, Report, Selection, check, check_problems};
use immaculate::oracle::diagnose::Diagnosis;
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::setup::Setup;
use immaculate::oracle::subject::{Answer, Broken, Ready, Subject};
use immaculate::oracle::trace::Trace;
use nalgebra::{DMatrix, DVector};
use serde_json::{Value, json};
use std::f64::consts::PI;

/// Rounding of some ten operations on numbers near one.
const ROUNDING: f64 = 1e-13;

fn published(id: &str) -> &'static case::Case {
    let mut all = case::all().unwrap().iter();
    all.find(|case| case.problem.id == id).unwrap()
}

/// aᵀ P⁻¹ a of two entries, by the adjugate.
fn square(a: &[f64], p: &[f64]) -> f64 {
    let determinant = p[0] * p[3] - p[1] * p[2];
    (p[3] * a[0] * a[0] - (p[1] + p[2]) * a[0] * a[1] + p[0] * a[1] * a[1]) / determinant
}

fn is_near(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= ROUNDING * expected.abs().max(1.0)
}

/// One entry less than the likelihood's exponent and determinant say would not do: ln L = −½ (νᵀ S⁻¹ ν + ln det 2πS).
#[test]
fn nis_is_the_exponent_of_the_likelihood() {
    let case = published("consistency.kalman");
    let Expected::Trace(trace) = &case.expected else {
        panic!("it is run")
    };
    let mut asked = 0;
    for (step, _, mode) in trace.all_places().filter(|place| place.1 == Quantity::Nis) {
        let value = |quantity| trace.get(step, quantity, mode);
        let Some(nis) = value(Quantity::Nis) else {
            assert_eq!(value(Quantity::Innovation), None, "without a detection");
            continue;
        };
        let s = value(Quantity::InnovationCovariance).unwrap();
        assert!(is_near(nis[0], square(value(Quantity::Innovation).unwrap(), s)));
        let determinant = 4.0 * PI * PI * (s[0] * s[3] - s[1] * s[2]);
        let exponent = -2.0 * value(Quantity::LogLikelihood).unwrap()[0] - determinant.ln();
        assert!(is_near(nis[0], exponent), "{nis:?} {exponent}");
        asked += 1;
    }
    assert_eq!(asked, 9);
}

/// (x − x̂)ᵀ P⁻¹ (x − x̂), with a heading across the cut: as numbers the error would be almost a whole turn.
#[test]
fn nees_is_of_the_wrapped_error_and_where_the_truth_is_known() {
    for id in ["consistency.kalman", "consistency.heading"] {
        let case = published(id);
        let Expected::Trace(trace) = &case.expected else {
            panic!("it is run")
        };
        for entry in &case.problem.measurements {
            let value = |quantity| trace.get(entry.step, quantity, 0);
            let Some(truth) = &entry.truth else {
                assert_eq!(value(Quantity::Nees), None, "nobody knows where it is");
                continue;
            };
            let mut error =
                DVector::from_vec(truth.clone()) - DVector::from_row_slice(value(Quantity::CombinedMean).unwrap());
            let turns = (error[3] / (2.0 * PI)).round();
            if id == "consistency.heading" {
                error[3] -= 2.0 * PI * turns;
            }
            let covariance = DMatrix::from_row_slice(4, 4, value(Quantity::CombinedCovariance).unwrap());
            let expected = error.dot(&covariance.lu().solve(&error).unwrap());
            let found = value(Quantity::Nees).unwrap()[0];
            assert!(
                (found - expected).abs() < 1e-10 * expected,
                "{id}, {}: {found} {expected}",
                entry.step
            );
        }
    }
    let heading = &published("consistency.heading").problem;
    let first = heading.measurements[0].truth.as_ref().unwrap()[3];
    assert!(first < -3.0 && heading.initial.modes[0].mean[3] > 3.0, "across the cut");
}

/// The values and their places, without those that need the truth.
fn values_of(problem: &ProblemFile) -> Vec<((usize, Quantity, usize), Vec<u64>)> {
    let values = problem.setup_in_doubles().unwrap().run().in_doubles();
    let places = values.all_places().filter(|place| !place.1.needs(Needs::Truth));
    let bits = |values: &Vec<f64>| values.iter().map(|value| value.to_bits()).collect();
    places
        .filter_map(|place| Some((place, values.get(place.0, place.1, place.2).map(bits)?)))
        .collect()
}

#[test]
fn nothing_depends_on_the_truth() {
    let known = published("consistency.kalman").problem.clone();
    let mut unknown = known.clone();
    let mut other = known.clone();
    for entry in &mut unknown.measurements {
        entry.truth = None;
    }
    for entry in &mut other.measurements {
        entry.truth = Some(vec![1.0, -2.0, 3.0, 4.0]);
    }
    assert_eq!(values_of(&known), values_of(&unknown));
    assert_eq!(values_of(&known), values_of(&other));
}

/// An error in units of a covariance that is singular is none: the step is done, and the value is not there.
#[test]
fn a_singular_covariance_has_no_nees() {
    let mut problem = json!({
        "format": "immaculate-problem/2", "id": "exact", "state": ["x", "y"],
        "F": [[1, 0], [0, 1]], "Q": [[1, 0], [0, 0]],
        "measurement": { "kind": "linear", "H": [[1, 0]] }, "R": [[2]], "filter": { "kind": "kalman" },
        "initial": { "mean": [0, 0], "covariance": [[1, 0], [0, 0]] },
        "measurements": [{ "step": 1, "z": [4], "truth": [3, 0] }]
    });
    let nees = |problem: &Value| {
        let certified = certify(&ProblemFile::read(&problem.to_string()).unwrap()).unwrap();
        certified.trace.get(1, Quantity::Nees, 0).cloned()
    };
    assert_eq!(nees(&problem), None);
    // With a variance of its own the second entry counts: (3 − 2)²/1 + 0²/1.
    problem["initial"]["covariance"][1][1] = json!(1);
    assert_eq!(nees(&problem), Some(vec![1.0]));
}

#[test]
fn a_truth_that_cannot_be_compared_is_refused_with_its_place() {
    let whole: Value = serde_json::from_str(published("consistency.kalman").problem_text).unwrap();
    let refusal = |change: &dyn Fn(&mut Value)| {
        let mut problem = whole.clone();
        change(&mut problem);
        ProblemFile::read(&problem.to_string()).unwrap_err().to_string()
    };
    let truth = |truth: Value| refusal(&move |problem| problem["measurements"][3]["truth"] = truth.clone());
    let place = "problem.measurements[3].truth";
    assert_eq!(
        truth(json!([1, 2, 3])),
        format!("{place}: has 3 entries where 4 are needed")
    );
    assert!(truth(json!(null)).starts_with(place), "{}", truth(json!(null)));
    let of_format_1 = refusal(&|problem| problem["format"] = json!("immaculate-problem/1"));
    assert!(
        of_format_1.contains("truth") && of_format_1.contains("needs the format"),
        "{of_format_1}"
    );
    let mut fixed: Value = serde_json::from_str(published("step.fixed-gain").problem_text).unwrap();
    fixed["format"] = json!("immaculate-problem/2");
    let n = fixed["state"].as_array().unwrap().len();
    fixed["measurements"][0]["truth"] = json!(vec![0; n]);
    let of_gains = ProblemFile::read(&fixed.to_string()).unwrap_err().to_string();
    assert!(of_gains.contains("no covariance"), "{of_gains}");
}

/// Shows what the filter proper computes, with values changed.
struct Showing {
    change: fn(&mut Trace, &ProblemFile),
}

impl Subject for Showing {
    fn start(&mut self) -> Result<Ready, Broken> {
        Ok(Ready::default())
    }

    fn run(&mut self, problem: &ProblemFile) -> Answer {
        // As a program that knows nothing of when a case was published.
        let mut problem = problem.clone();
        problem.lacks_consistency = false;
        let mut trace = problem.setup_in_doubles().unwrap().run().in_doubles();
        (self.change)(&mut trace, &problem);
        Answer::Steps { trace, error: None }
    }
}

fn verdict_on(change: fn(&mut Trace, &ProblemFile), id: &str) -> Report {
    let ids = vec![id.to_owned()];
    check(
        &mut Showing { change },
        &Selection {
            ids,
            ..Selection::default()
        },
        &|_| {},
    )
    .unwrap()
}

fn spoil(trace: &mut Trace, _: &ProblemFile) {
    for (step, quantity, mode) in trace.clone().all_places().filter(|place| place.1 == Quantity::Nis) {
        if trace.get(step, quantity, mode).is_some() {
            trace.set(step, quantity, mode, vec![0.25]);
        }
    }
}

/// A case that was published before there was the value does not ask for it, and one that has it does.
#[test]
fn a_case_asks_for_what_it_was_published_with() {
    for change in [|_: &mut Trace, _: &ProblemFile| {}, spoil] {
        let report = verdict_on(change, "steps.kalman");
        assert_eq!(report.cases[0].outcome, Outcome::Right);
        assert_eq!(report.cases[0].judged, report.cases[0].of);
        assert!(!report.hidden.contains(&Quantity::Nis));
    }
    let right = verdict_on(|_, _| {}, "consistency.kalman");
    assert_eq!((right.is_wrong(), right.cases[0].judged), (false, right.cases[0].of));
    let wrong = verdict_on(spoil, "consistency.kalman");
    let mut faulty: Vec<Quantity> = wrong.faults().map(|(_, judged)| judged.place.1).collect();
    faulty.dedup();
    assert_eq!(faulty, [Quantity::Nis]);
}

/// A problem of one's own has them: nobody has published it.
#[test]
fn a_problem_of_ones_own_asks_for_them() {
    let problem = published("steps.kalman").problem_text;
    let problem = ProblemFile::read(problem).unwrap();
    let (trace, _) = certified_as_far_as_it_goes(&problem).unwrap();
    assert!(trace.get(1, Quantity::Nis, 2).is_some());
    let of = |change| check_problems(&mut Showing { change }, std::slice::from_ref(&problem), &|_| {}).unwrap();
    assert!(!of(|_, _| {}).is_wrong() && of(spoil).is_wrong());
}

/// This crate's filter with an entry of its table exchanged.
struct Edited(fn(&mut Setup<Number>));

impl Subject for Edited {
    fn start(&mut self) -> Result<Ready, Broken> {
        Ok(Ready::default())
    }

    fn run(&mut self, problem: &ProblemFile) -> Answer {
        let mut setup = problem.setup_in_doubles().unwrap();
        (self.0)(&mut setup);
        Answer::Steps {
            trace: setup.run().in_doubles(),
            error: None,
        }
    }
}

/// The formula that is found for what was computed.
fn computed(edit: fn(&mut Setup<Number>)) -> String {
    let ids = vec!["consistency.kalman".to_owned()];
    let report = check(
        &mut Edited(edit),
        &Selection {
            ids,
            ..Selection::default()
        },
        &|_| {},
    )
    .unwrap();
    match report.diagnosis {
        Diagnosis::InParts { formulas, .. } if formulas.found.len() == 1 => {
            format!("{} = {}", formulas.found[0].quantity.name(), formulas.found[0].computed)
        }
        diagnosis => panic!("{diagnosis:?}"),
    }
}

/// aᵀ P⁻¹ a.
fn squared(a: &DVector<Number>, p: &DMatrix<Number>) -> Number {
    quadratic_form(&ldl(p), a)
}

/// No row of the catalogue has them.
#[test]
fn mistakes_in_them_are_named_without_a_row_of_the_catalogue() {
    let found =
        computed(|setup| setup.equations.nis = |_, _, now, j| Some(now.innovations[j].dot(&now.innovations[j])));
    assert_eq!(found, "nis = innovationᵀ · innovation");
    let found = computed(|setup| {
        setup.equations.nis = |_, _, now, j| {
            let s = &now.innovation_covariances[j];
            Some(squared(&now.innovations[j], &DMatrix::from_diagonal(&s.diagonal())))
        };
    });
    assert_eq!(
        found,
        "nis = innovationᵀ · (the diagonal alone of innovation_covariance)⁻¹ · innovation"
    );
    let found = computed(|setup| {
        setup.equations.nis = |problem, _, now, j| Some(squared(&now.innovations[j], &problem.measurement_noise));
    });
    assert_eq!(found, "nis = innovationᵀ · R⁻¹ · innovation");
    let found = computed(|setup| {
        setup.equations.nees = |_, _, now, _| {
            let error = now.truth.as_ref()? - &now.combined.mean;
            Some(squared(&error, &now.combined_prediction.covariance))
        };
    });
    let error = "(truth − combined.mean)";
    assert_eq!(
        found,
        format!("nees = {error}ᵀ · combined_prediction.covariance⁻¹ · {error}")
    );
}
