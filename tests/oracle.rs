//! The judge, judged: every variant of the catalogue is planted in this crate's own filter, which is then checked like any program.
//!
//! Goal: every mistake is caught in its own equation by the case that is meant for it, and named; no form is called wrong and no
//! convention a mistake; and it is known what each level of answer can and cannot tell apart.
//! Method: exhaustion over the catalogue and the published cases of ten steps and fewer, at three levels of answer; then snapshots of
//! what came of it.

use immaculate::imm::Quantity;
use immaculate::oracle::case::{self, Case, Expected};
use immaculate::oracle::check::{CaseReport, Outcome, Report, Selection, check};
use immaculate::oracle::diagnose::Diagnosis;
use immaculate::oracle::problem::{FilterFile, ProblemFile};
use immaculate::oracle::subject::{Answer, Broken, Level, Planted, Ready, Subject};
use immaculate::oracle::variant::{self, Kind, Variant, catalogue};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::LazyLock;

/// The cases with ten steps and fewer of filters with fewer than fifty points: the others show nothing more about equations, and take
/// long.
fn short_cases() -> Vec<String> {
    let is_light = |case: &&Case| {
        let n = case.problem.dimensions().n;
        let name = case.problem.filter.name();
        let draws_many = matches!(case.problem.filter, FilterFile::Cubature { .. });
        let has_many_points = (n > 5 && draws_many) || name.starts_with("gauss-hermite");
        case.problem.measurements.len() <= 10 && !has_many_points && matches!(case.expected, Expected::Trace(_))
    };
    let cases = case::all().unwrap().iter();
    cases.filter(is_light).map(|case| case.problem.id.clone()).collect()
}

/// Problems that ask of one more kind of filter what others ask of theirs: they show nothing more about mistakes.
fn is_asked_again(id: &str) -> bool {
    let (behaviour, kind) = id.split_once('.').unwrap_or_default();
    ["changing", "sensors", "input", "units", "outlier", "unreachable"].contains(&behaviour)
        && [
            "kalman",
            "extended",
            "cubature-3",
            "unscented",
            "converted",
            "fixed-gain",
        ]
        .contains(&kind)
}

/// The cases in which variants of a kind are planted. No form may be called wrong, and no convention a mistake, wherever it is asked.
fn cases_for(kind: Kind) -> Vec<String> {
    let mut ids = short_cases();
    if kind == Kind::Mistake {
        ids.retain(|id| !is_asked_again(id));
    }
    ids
}

fn report_of(variants: &[&str], level: Level, ids: &[String]) -> Report {
    let mut subject = Planted {
        variants: variants.iter().map(|&id| id.to_owned()).collect(),
        level,
    };
    let selection = Selection {
        ids: ids.to_vec(),
        ..Selection::default()
    };
    check(&mut subject, &selection, &|_| ()).unwrap()
}

/// The reports on all variants at all levels, computed once.
static REPORTS: LazyLock<Vec<(&'static Variant, [Report; 3])>> = LazyLock::new(|| {
    let of_variant = |variant: &'static Variant| {
        let ids = cases_for(variant.kind);
        let reports = Level::ALL.map(|level| report_of(&[&variant.id], level, &ids));
        (variant, reports)
    };
    catalogue().par_iter().map(of_variant).collect()
});

fn of_kind(kind: Kind) -> impl Iterator<Item = &'static (&'static Variant, [Report; 3])> {
    REPORTS.iter().filter(move |(variant, _)| variant.kind == kind)
}

/// The cases in which the first fault is in this equation.
fn caught_in_its_equation(report: &Report, quantity: Quantity) -> Vec<&str> {
    let cases = report.cases.iter().filter(|case| {
        let values = case.judgement.iter().flat_map(|judgement| &judgement.values);
        let first = values
            .filter(|value| value.finding.is_fault())
            .min_by_key(|value| value.place);
        first.is_some_and(|first| first.place.1 == quantity)
    });
    cases.map(|case| case.id.as_str()).collect()
}

/// What a diagnosis names: the ids, or nothing.
fn named(report: &Report) -> Vec<&str> {
    match &report.diagnosis {
        Diagnosis::One(variants) => variants.iter().map(|variant| variant.id.as_str()).collect(),
        _ => Vec::new(),
    }
}

/// Whether a report shows anything wrong or otherwise.
fn is_seen(report: &Report) -> bool {
    report.is_wrong() || report.faults().next().is_some()
}

/// Of this one the values are right until they are none: a filter that gives up there shows no wrong value.
const STOPS: &str = "likelihoods-exponentiated-before-comparing";

#[test]
fn every_mistake_is_caught_in_its_own_equation_by_the_case_meant_for_it() {
    for (variant, reports) in of_kind(Kind::Mistake) {
        let everything = &reports[0];
        assert!(everything.is_wrong(), "{}", variant.id);
        if variant.id == STOPS {
            let stopped = |case: &&CaseReport| matches!(case.outcome, Outcome::Stopped { .. });
            assert!(
                everything
                    .cases
                    .iter()
                    .filter(stopped)
                    .any(|case| case.id == variant.case)
            );
            continue;
        }
        let caught = caught_in_its_equation(everything, variant.quantity);
        assert!(
            caught.contains(&variant.case.as_str()),
            "{} is caught by {caught:?} and not by {:?}",
            variant.id,
            variant.case
        );
    }
}

#[test]
fn every_mistake_is_named_alone_where_everything_is_shown() {
    for (variant, reports) in of_kind(Kind::Mistake).filter(|(variant, _)| variant.id != STOPS) {
        assert_eq!(named(&reports[0]), [variant.id.as_str()]);
    }
}

#[test]
fn where_less_is_shown_the_mistake_is_among_those_named_or_cannot_be_seen() {
    for (variant, reports) in of_kind(Kind::Mistake).filter(|(variant, _)| variant.id != STOPS) {
        for report in &reports[1..] {
            let is_named = named(report).contains(&variant.id.as_str());
            assert!(is_named || !is_seen(report), "{}: {:?}", variant.id, named(report));
        }
    }
}

#[test]
fn no_form_is_called_wrong() {
    for (variant, reports) in of_kind(Kind::Form) {
        for report in reports {
            assert!(!report.is_wrong(), "{}: {:?}", variant.id, report.diagnosis);
        }
    }
}

#[test]
fn every_convention_is_named_and_none_is_called_a_mistake() {
    for (variant, reports) in of_kind(Kind::Convention) {
        assert_eq!(named(&reports[0]), [variant.id.as_str()]);
        assert!(reports.iter().all(|report| !report.is_wrong()), "{}", variant.id);
    }
}

#[test]
fn a_declared_convention_is_judged_by_and_found_right() {
    for variant in catalogue().iter().filter(|variant| variant.kind == Kind::Convention) {
        let mut subject = Declared(Planted {
            variants: vec![variant.id.clone()],
            level: Level::Everything,
        });
        let ids = vec!["steps.".to_owned(), "convention.".to_owned(), "near.".to_owned()];
        let selection = Selection {
            ids,
            ..Selection::default()
        };
        let report = check(&mut subject, &selection, &|_| ()).unwrap();
        assert_eq!(report.diagnosis, Diagnosis::Nothing, "{}", variant.id);
        assert!(
            report.cases.iter().all(|case| case.outcome == Outcome::Right),
            "{}",
            variant.id
        );
    }
}

/// A program that says which convention it has.
struct Declared(Planted);

impl Subject for Declared {
    fn start(&mut self) -> Result<Ready, Broken> {
        let mut ready = self.0.start()?;
        let variant = variant::find(&self.0.variants[0]).unwrap();
        let (key, value) = (variant.convention.clone().unwrap(), variant.value.clone().unwrap());
        ready.conventions.insert(key, value);
        Ok(ready)
    }

    fn run(&mut self, problem: &ProblemFile) -> Answer {
        self.0.run(problem)
    }
}

#[test]
fn two_mistakes_at_once_are_both_named() {
    let pairs = [
        ["mixed-spread-omitted", "measurement-noise-doubled"],
        ["transition-transposed", "innovation-not-wrapped"],
        ["determinant-omitted", "probabilities-not-advanced"],
        ["cubature-5-weight-13", "combined-spread-omitted"],
        ["points-not-drawn-afresh", "covariances-not-mixed"],
    ];
    let ids = ["steps.", "step.", "missed.", "wrap.", "update."].map(str::to_owned);
    for pair in pairs {
        let report = report_of(&pair, Level::Everything, &ids);
        let Diagnosis::Several(found) = &report.diagnosis else {
            panic!("{pair:?}: {:?}", report.diagnosis);
        };
        let found: Vec<Vec<&str>> = found
            .iter()
            .map(|member| member.iter().map(|variant| variant.id.as_str()).collect())
            .collect();
        let mut expected = pair;
        expected.sort_by_key(|id| variant::find(id).map(|variant| variant.quantity));
        assert_eq!(found, expected.map(|id| vec![id]));
    }
}

#[test]
fn four_mistakes_at_once_are_all_named() {
    let four = [
        "transition-transposed",
        "mixed-spread-omitted",
        "measurement-noise-doubled",
        "determinant-omitted",
    ];
    let ids = ["steps.", "step.", "update."].map(str::to_owned);
    let Diagnosis::Several(found) = report_of(&four, Level::Everything, &ids).diagnosis else {
        panic!("not several");
    };
    let found: Vec<&str> = found.iter().flatten().map(|variant| variant.id.as_str()).collect();
    assert_eq!(found, four);
}

#[test]
fn where_less_is_shown_two_mistakes_are_named_case_by_case() {
    let pair = ["mixed-spread-omitted", "measurement-noise-doubled"];
    let ids = ["steps.", "step.n4"].map(str::to_owned);
    let Diagnosis::InParts { parts, unexplained, .. } = report_of(&pair, Level::Posteriors, &ids).diagnosis else {
        panic!("not in parts");
    };
    let mut found: Vec<&str> = parts
        .iter()
        .flat_map(|part| &part.variants)
        .map(|variant| variant.id.as_str())
        .collect();
    found.sort_unstable();
    assert_eq!(found, ["measurement-noise-doubled", "mixed-spread-omitted"]);
    assert!(unexplained.is_empty());
}

#[test]
fn the_own_filter_has_full_marks_on_every_case() {
    let mut subject = Planted {
        variants: Vec::new(),
        level: Level::Everything,
    };
    let report = check(&mut subject, &Selection::default(), &|_| ()).unwrap();
    assert_eq!(report.cases.len(), case::all().unwrap().len());
    assert!(!report.is_wrong());
    assert_eq!(report.diagnosis, Diagnosis::Nothing);
    assert_eq!(report.observations, []);
}

/// What a level of answer says of a mistake.
fn mark(variant: &Variant, report: &Report) -> String {
    match named(report).len() {
        _ if !is_seen(report) => "not seen".into(),
        0 => "seen".into(),
        1 if named(report) == [variant.id.as_str()] => "named".into(),
        count => format!("1 of {count}"),
    }
}

#[test]
fn what_each_level_of_answer_can_tell() {
    let mut text = String::from(
        "Mistakes and conventions by what is shown: everything, posteriors, the combined estimate alone.\n\n",
    );
    let mut sums: BTreeMap<(usize, &str), usize> = BTreeMap::new();
    let visible = REPORTS.iter().filter(|(variant, _)| variant.kind != Kind::Form);
    for (variant, reports) in visible {
        let marks: Vec<String> = reports.iter().map(|report| mark(variant, report)).collect();
        for (level, mark) in marks.iter().enumerate() {
            let word = if mark.contains(" of ") { "one of several" } else { mark };
            let word = ["named", "one of several", "seen", "not seen"]
                .into_iter()
                .find(|known| *known == word)
                .unwrap();
            *sums.entry((level, word)).or_default() += 1;
        }
        let _ = writeln!(text, "{:<45} {:<9} {:<9} {}", variant.id, marks[0], marks[1], marks[2]);
    }
    for (level, name) in ["everything", "posteriors", "combined alone"].into_iter().enumerate() {
        let counts: Vec<String> = sums
            .iter()
            .filter(|((of_level, _), _)| *of_level == level)
            .map(|((_, word), count)| format!("{count} {word}"))
            .collect();
        let _ = writeln!(text, "\n{name}: {}", counts.join(", "));
    }
    insta::assert_snapshot!(text);
}

#[test]
fn which_case_catches_which_variant() {
    let cases = cases_for(Kind::Mistake);
    let mut text = String::from(
        "# in its own equation, + in one that follows from it, . not seen; the columns are these cases:\n",
    );
    for (column, id) in cases.iter().enumerate() {
        let _ = writeln!(text, "{:>4} {id}", column + 1);
    }
    for (variant, reports) in REPORTS.iter() {
        let own = caught_in_its_equation(&reports[0], variant.quantity);
        let marks: String = reports[0]
            .cases
            .iter()
            .filter(|case| cases.contains(&case.id))
            .map(|case| match case.outcome {
                _ if own.contains(&case.id.as_str()) => '#',
                Outcome::Wrong | Outcome::Stopped { .. } => '+',
                _ => '.',
            })
            .collect();
        let _ = writeln!(text, "{:<45} {marks}", variant.id);
    }
    insta::assert_snapshot!(text);
}
