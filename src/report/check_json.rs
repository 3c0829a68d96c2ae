//! The verdict on a program under test as JSON.
//!
//! It says the same as the text, for programs: every case, and every value that is not simply right.

use super::behaviour::{in_a_word, why};
use super::check::{reason, words};
use super::verdict::counts;
use crate::imm::Quantity;
use crate::oracle::behaviour::{Behaviour, Grade, Unasked};
use crate::oracle::check::Report;
use crate::oracle::diagnose::{Diagnosis, Share};
use crate::oracle::judge::{Finding, Judged};
use crate::oracle::variant::Variant;
use serde_json::{Value, json};

/// The report as JSON.
pub fn json(report: &Report) -> Value {
    let (judged, of) = counts(report);
    let names = |quantities: &[Quantity]| -> Vec<&str> { quantities.iter().map(|quantity| quantity.name()).collect() };
    let cases: Vec<Value> = report
        .cases
        .iter()
        .map(|case| {
            let values = case.judgement.iter().flat_map(|judgement| &judgement.values);
            let unusual: Vec<Value> = values
                .filter(|value| value.finding != Finding::Right)
                .map(|value| {
                    let equation = case.equation(value.place.1, value.place.2);
                    let mut json = value_json(value, equation, &names);
                    json["excused"] = json!(value.finding.is_fault() && report.is_otherwise(value.place.1));
                    json
                })
                .collect();
            json!({
                "id": case.id,
                "verdict": words(&case.outcome).to_lowercase(),
                "reason": reason(case),
                "wrong": case.outcome.is_wrong(),
                "judged": case.judged,
                "of": case.of,
                "digits": case.digits,
                "certified_steps": case.certified,
                "not_simply_right": unusual,
                "failures": case.judgement.as_ref().map(|judgement| &judgement.failures),
            })
        })
        .collect();
    json!({
        "format": "immaculate-report/1",
        "name": report.ready.name,
        "precision": report.ready.precision.to_string(),
        "conventions": report.ready.conventions,
        "wrong": report.is_wrong(),
        "echo": report.echo,
        "judged": judged,
        "of": of,
        "complete": report.is_complete(),
        "behaviours": behaviours_json(report),
        "not_asked": report.not_asked.iter().filter(|case| case.why != Unasked::Selection).count(),
        "never_shown": names(&report.hidden),
        "diagnosis": diagnosis_json(&report.diagnosis),
        "observations": super::observation::json(&report.observations),
        "remarks": report.remarks,
        "cases": cases,
    })
}

/// A row for each family of filters and each behaviour.
fn behaviours_json(report: &Report) -> Vec<Value> {
    let of_family = |(family, grades): (&'static str, Vec<(Behaviour, Grade)>)| {
        grades.into_iter().map(move |(behaviour, grade)| {
            let (cases, wrong) = match grade {
                Grade::Right(cases) => (cases, 0),
                Grade::Wrong(wrong, cases) | Grade::Otherwise(wrong, cases) => (cases, wrong),
                _ => (0, 0),
            };
            json!({
                "filter": family,
                "behaviour": behaviour.name(),
                "verdict": in_a_word(&grade),
                "reason": why(&grade),
                "cases": cases,
                "wrong": wrong,
            })
        })
    };
    report.grades().into_iter().flat_map(of_family).collect()
}

fn value_json(value: &Judged, equation: &str, names: &dyn Fn(&[Quantity]) -> Vec<&'static str>) -> Value {
    let (step, quantity, mode) = value.place;
    json!({
        "step": step,
        "quantity": quantity.name(),
        "mode": quantity.is_of_mode().then_some(mode),
        "equation": equation,
        "finding": finding(value.finding),
        "error_in_units": value.error,
        "own": value.own.map(|own| json!({
            "entry": own.index,
            "shown": own.shown,
            "expected": own.expected,
            "noise_ratio": own.ratio,
            "error_in_units": own.size,
        })),
        "hidden": names(&value.hidden),
        "explained": value.explained,
    })
}

/// What a finding is called.
fn finding(finding: Finding) -> &'static str {
    match finding {
        Finding::Right => "right",
        Finding::Propagated => "propagated",
        Finding::CannotTell => "cannot tell",
        Finding::Undetermined => "undetermined",
        Finding::Unused => "no output depends on it",
        Finding::Stale => "shown where there is none",
        Finding::NotFinite => "not finite",
        Finding::Fault => "fault",
    }
}

pub(super) fn diagnosis_json(diagnosis: &Diagnosis) -> Value {
    let one = |variant: &Variant| json!({ "id": variant.id, "kind": variant.kind.name(), "about": variant.about });
    let list = |variants: &[&Variant]| -> Vec<Value> { variants.iter().map(|variant| one(variant)).collect() };
    match diagnosis {
        Diagnosis::Nothing => Value::Null,
        Diagnosis::One(variants) => json!({ "one_of": list(variants) }),
        Diagnosis::Several(members) => {
            json!({ "together": members.iter().map(|member| json!({ "one_of": list(member) })).collect::<Vec<_>>() })
        }
        Diagnosis::Pairs(pairs) => {
            json!({ "one_pair_of": pairs.iter().map(|pair| json!(list(pair))).collect::<Vec<_>>() })
        }
        Diagnosis::ByFilter(filters) => {
            let of_filter = |(name, found): &(String, Diagnosis)| (name.clone(), diagnosis_json(found));
            json!({ "by_filter": filters.iter().map(of_filter).collect::<serde_json::Map<_, _>>() })
        }
        Diagnosis::InParts {
            parts,
            unexplained,
            formulas,
            of,
            pairs,
        } => {
            let of_part = |part: &Share| json!({ "one_of": list(&part.variants), "cases": part.cases });
            json!({
                "parts": parts.iter().map(of_part).collect::<Vec<_>>(),
                "unexplained": unexplained,
                "formulas": super::formula::json(formulas),
                "faulty_cases": of,
                "pairs_tried": pairs,
            })
        }
    }
}
