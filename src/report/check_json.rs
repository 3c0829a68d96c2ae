//! The verdict on a program under test as JSON.
//!
//! After this file the reader knows the same as from the text, for programs: every case, and every value that is not simply right.

use super::check::{counts, reason, words};
use crate::imm::Quantity;
use crate::oracle::check::Report;
use crate::oracle::diagnose::Diagnosis;
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
                .map(|value| value_json(value, case.filters[value.place.2].equation(value.place.1), &names))
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
        "not_asked": report.not_asked,
        "never_shown": names(&report.hidden),
        "diagnosis": diagnosis_json(&report.diagnosis),
        "remarks": report.remarks,
        "cases": cases,
    })
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
    })
}

/// What a finding is called.
fn finding(finding: Finding) -> &'static str {
    match finding {
        Finding::Right => "right",
        Finding::Propagated => "propagated",
        Finding::CannotTell => "cannot tell",
        Finding::Undetermined => "undetermined",
        Finding::Stale => "shown where there is none",
        Finding::NotFinite => "not finite",
        Finding::Fault => "fault",
    }
}

fn diagnosis_json(diagnosis: &Diagnosis) -> Value {
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
        Diagnosis::Unknown {
            best,
            unexplained,
            of,
            pairs,
        } => json!({
            "unknown": true,
            "pairs_tried": pairs,
            "best": list(best),
            "unexplained_by_the_first": unexplained,
            "faulty_cases": of,
        }),
    }
}
