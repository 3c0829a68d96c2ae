//! The verdict as files, for people and for programs that collect test results.
//!
//! Nothing here judges: every file is made from the same values as the text and the JSON.
//!
//! | file       | what it makes                                                               |
//! |------------|-----------------------------------------------------------------------------|
//! | `mod`      | what all of them say: the verdict in words, its sentence, severity, coverage |
//! | `junit`    | JUnit XML, for GitLab, Jenkins and GitHub                                    |
//! | `markdown` | a summary for a pull request                                                 |
//! | `badge`    | a small picture                                                              |
//! | `page`     | a page with all of it                                                        |
//! | `causes`   | what explains the faults, for the page                                       |
//! | `plot`     | errors over the steps of a case, for the page                                |

pub mod badge;
mod causes;
pub mod junit;
pub mod markdown;
pub mod page;
mod plot;

use crate::imm::Quantity;
use crate::oracle::behaviour::Unasked;
use crate::oracle::check::{CaseReport, Outcome, Report};
use crate::oracle::diagnose::Diagnosis;
use crate::oracle::judge::{Finding, Judged};

/// A verdict without its figures.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Overall {
    Wrong,
    NothingJudged,
    OnWhatWasJudged,
    Right,
    Otherwise,
}

impl Overall {
    pub fn of(report: &Report) -> Self {
        match (&report.diagnosis, report.is_wrong()) {
            (_, true) => Self::Wrong,
            (Diagnosis::Nothing, false) if right_cases(report) == 0 => Self::NothingJudged,
            (Diagnosis::Nothing, false) if !report.is_complete() => Self::OnWhatWasJudged,
            (Diagnosis::Nothing, false) => Self::Right,
            (_, false) => Self::Otherwise,
        }
    }

    pub fn words(self) -> &'static str {
        match self {
            Self::Wrong => "WRONG",
            Self::NothingJudged => "NOTHING JUDGED",
            Self::OnWhatWasJudged => "RIGHT on what was judged",
            Self::Right => "RIGHT",
            Self::Otherwise => "RIGHT, but otherwise",
        }
    }
}

/// The number of cases with a certain outcome.
fn count(report: &Report, is: fn(&Outcome) -> bool) -> usize {
    report.cases.iter().filter(|case| is(&case.outcome)).count()
}

fn right_cases(report: &Report) -> usize {
    count(report, |outcome| {
        matches!(outcome, Outcome::Right | Outcome::Rejected { .. })
    })
}

/// The verdict in one sentence.
pub(super) fn sentence(report: &Report) -> String {
    let see = if Overall::of(report) == Overall::Otherwise {
        ", see above"
    } else {
        ""
    };
    let verdict = Overall::of(report).words();
    format!("{verdict}{see}: {}, {}", report.ready.name, figures(report))
}

/// The basis of a verdict: the precision, the number of cases by outcome, and the digits to which values are right.
fn figures(report: &Report) -> String {
    let parts: Vec<String> = [
        (right_cases(report), "right"),
        (
            count(report, Outcome::is_wrong),
            if report.is_excused() { "otherwise" } else { "wrong" },
        ),
        (
            count(report, |outcome| matches!(outcome, Outcome::CannotTell)),
            "drowned in rounding noise",
        ),
        (
            count(report, |outcome| matches!(outcome, Outcome::Skipped { .. })),
            "skipped",
        ),
    ]
    .into_iter()
    .filter(|(number, _)| *number > 0)
    .map(|(number, word)| format!("{number} {word}"))
    .collect();
    let least = report.cases.iter().filter_map(|case| Some((case.digits?, &case.id)));
    let least = least.reduce(|a, b| if b.0 < a.0 { b } else { a });
    let digits = least.map_or(String::new(), |(digits, id)| {
        format!("; right values to {digits:.1} digits or more, the fewest in {id}")
    });
    let (precision, cases) = (report.ready.precision, report.cases.len());
    let word = if cases == 1 { "case" } else { "cases" };
    format!("{precision}: {} of {cases} {word}{digits}", parts.join(", "))
}

/// How many values of the cases were judged, and how many they have.
pub(super) fn counts(report: &Report) -> (usize, usize) {
    let sum = |of: fn(&CaseReport) -> usize| report.cases.iter().map(of).sum();
    (sum(|case| case.judged), sum(|case| case.of))
}

/// A value of a case.
type InCase<'a> = (&'a CaseReport, &'a Judged);

/// The combined mean that is farthest from the certified one, if any is shown that is off by more than rounding.
fn farthest_mean(report: &Report) -> Option<InCase<'_>> {
    let all = report.cases.iter().flat_map(|case| {
        let values = case.judgement.iter().flat_map(|judgement| &judgement.values);
        values.map(move |value| (case, value))
    });
    // What is not finite is farther than any number.
    let size = |(_, value): &InCase| {
        if value.error.is_nan() {
            f64::INFINITY
        } else {
            value.error
        }
    };
    all.filter(|(_, value)| value.place.1 == Quantity::CombinedMean)
        .filter(|(_, value)| value.finding.is_fault() || value.finding == Finding::Propagated)
        .reduce(|a, b| if size(&b) > size(&a) { b } else { a })
}

/// How much a user of the filter would notice: the greatest error of the combined mean, in standard deviations. Nothing where all is right.
fn severity(report: &Report) -> Option<String> {
    if Overall::of(report) != Overall::Wrong {
        return None;
    }
    if report.hidden.contains(&Quantity::CombinedMean) {
        return Some("The error of the combined mean is unknown, because the program never showed it.".to_owned());
    }
    Some(match farthest_mean(report) {
        None => "The combined mean is right wherever it was shown and judged.".to_owned(),
        Some((case, value)) if value.error.is_finite() => {
            let (error, step) = (in_figures(value.error), value.place.0);
            format!(
                "The combined mean is off by up to {error} standard deviations: {}, step {step}.",
                case.id
            )
        }
        Some((case, value)) => format!(
            "The combined mean is not a number in {}, step {}.",
            case.id, value.place.0
        ),
    })
}

/// A size in two or three figures.
fn in_figures(size: f64) -> String {
    match size {
        _ if !(1e-3..1e6).contains(&size) => format!("{size:.1e}"),
        _ if size < 10.0 => format!("{size:.2}"),
        _ => format!("{size:.0}"),
    }
}

/// Whether a case alone makes the verdict wrong.
fn is_wrong(report: &Report, case: &CaseReport) -> bool {
    case.outcome.is_wrong() && !(case.outcome == Outcome::Wrong && report.is_excused())
}

/// Errors that belong to no single case: a heading and a sentence each.
fn of_the_whole(report: &Report) -> Vec<(&'static str, String)> {
    let observations = super::observation::sentences(&report.observations).into_iter();
    let mut wrong: Vec<_> = observations.map(|sentence| ("Answers as a whole", sentence)).collect();
    if report.echo == Some(false) {
        wrong.push(("Echo", ECHO_WRONG.to_owned()));
    }
    wrong
}

const ECHO_WRONG: &str =
    "ECHO WRONG: the product of matrix and vector is wrong. Does the program read matrices by columns?";

/// What was judged and what was not, one sentence each.
pub(super) fn coverage(report: &Report) -> Vec<String> {
    let (judged, of) = counts(report);
    let mut sentences = vec![format!("{judged} of {of} values in the selected cases were judged.")];
    sentences.extend(passed_over(report));
    sentences.extend(certified(report));
    if !report.hidden.is_empty() && judged > 0 {
        let names: Vec<&str> = report.hidden.iter().map(|quantity| quantity.name()).collect();
        sentences.push(format!(
            "Never shown: {}. A mistake there is found only through later values, and not at all if it has no effect by chance \
             or cancels later.",
            names.join(", ")
        ));
    }
    let not_asked = report.not_asked.iter();
    let not_asked = not_asked.filter(|case| case.why != Unasked::Selection).count();
    if not_asked > 0 {
        sentences.push(format!(
            "Cases not asked: {not_asked}. The program does not have their filter or format, or leaves input checks to its \
             caller."
        ));
    }
    match report.echo {
        None => sentences
            .push("The program gave no echo, so only the cases can show whether it reads matrices by rows.".to_owned()),
        Some(true) => {}
        Some(false) => sentences.push(ECHO_WRONG.to_owned()),
    }
    sentences
}

/// The values that were shown and not judged, by the reason.
fn passed_over(report: &Report) -> Vec<String> {
    let mut sentences = Vec::new();
    for (finding, sentence) in [
        (
            Finding::CannotTell,
            "cannot be judged: rounding in this precision moves them by as much as their scale",
        ),
        (
            Finding::Undetermined,
            "are undetermined: they depend on values that are not shown and may be wrong",
        ),
        (
            Finding::Unused,
            "belong to a mode of probability zero, which affects no output, and were ignored",
        ),
        (
            Finding::Stale,
            "should not exist (without a detection, or as covariances of fixed gains) and were ignored",
        ),
    ] {
        let values = report
            .cases
            .iter()
            .flat_map(|case| &case.judgement)
            .flat_map(|judgement| &judgement.values);
        let count = values.filter(|value| value.finding == finding).count();
        if count > 0 {
            sentences.push(format!("{count} {sentence}."));
        }
    }
    sentences
}

/// How far the user's problems are proven: one sentence for all that are proven to the end, and one for each of the others.
fn certified(report: &Report) -> Vec<String> {
    let of_case = |case: &CaseReport| Some((case.id.clone(), case.certified?, case.dimensions.steps()));
    let own = report.cases.iter().filter_map(of_case);
    let (whole, partly): (Vec<_>, Vec<_>) = own.partition(|(_, certified, all)| certified == all);
    let to_the_end = match &whole[..] {
        [] => None,
        [(id, ..)] => Some(format!("{id}: every expected value is certified.")),
        several => Some(format!(
            "{} problems: every expected value is certified.",
            several.len()
        )),
    };
    let to_a_step = partly.into_iter().map(|(id, certified, all)| {
        format!(
            "{id}: the expected values are certified to step {certified} of {all}. Later ones come from Immaculate's own run in doubles, \
             with its rounding noise; each equation is still judged on the program's own values."
        )
    });
    to_the_end.into_iter().chain(to_a_step).collect()
}
