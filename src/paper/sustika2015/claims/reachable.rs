//! Can the open choices of the paper give the eight figures of tables 4 and 5?
//!
//! Every open choice is varied by itself, and every reading of (39). Each figure is compared in standard errors for the paper's number of
//! runs. A second question is whether the two columns of a table can come from the same runs.

use super::super::RUNS;
use super::evidence::{CONVERTED, Configuration, RadarEvidence, published};
use crate::paper::specification::Specification;
use crate::paper::verdict::{DECISIVE, JudgedClaim, Verdict};
use crate::statistics::Estimate;
use crate::statistics::estimate::{figure, mean};
use crate::statistics::fit_error::FitForm;

/// A configuration with a reading of (39) beside the tables.
struct Match {
    name: String,
    /// Published less computed in standard errors: tables 4 and 5, scenarios 1 and 2, both filters.
    figures: Vec<f64>,
    /// Published less computed in standard deviations of single runs.
    deviations: Vec<f64>,
    /// The same in standard errors of the difference of the columns, IMM-CMKF less IMM-UKF, as if both filters had seen the same.
    gaps: Vec<f64>,
}

/// How far a published mean over the paper's runs is from a computed one, in the standard error of their difference.
fn distance(computed: Estimate, published: f64, runs: usize) -> f64 {
    let share = (1.0 + runs as f64 / RUNS as f64).sqrt();
    (published - computed.value) / (computed.standard_error * share)
}

fn compare(s: &Specification, configuration: &Configuration, form: FitForm, form_name: &str) -> Match {
    let filters = [CONVERTED, configuration.unscented];
    let (mut figures, mut deviations, mut gaps) = (Vec::new(), Vec::new(), Vec::new());
    for (table, rows) in [4, 5].into_iter().zip(&configuration.tables) {
        for (scenario, runs) in (1..).zip(rows) {
            let published = published(s, table, scenario);
            let count = runs.0.len();
            for (filter, published) in filters.into_iter().zip(published) {
                let computed = runs.fit_in(form, filter);
                figures.push(distance(computed, published, count));
                deviations.push(-computed.distance_from(published) / (count as f64).sqrt());
            }
            let of_run =
                |run: &super::super::outcome::RunOutcome| Some(run.fit(form, filters[0])? - run.fit(form, filters[1])?);
            let gap = mean(&runs.0.iter().filter_map(of_run).collect::<Vec<f64>>());
            gaps.push(distance(gap, published[0] - published[1], count));
        }
    }
    Match {
        name: format!("{}, {form_name}", configuration.choices.describe()),
        figures,
        deviations,
        gaps,
    }
}

/// The greatest distance; infinite where there is none.
fn most(distances: &[f64]) -> f64 {
    distances.iter().fold(0.0, |most: f64, distance| {
        if distance.is_finite() {
            most.max(distance.abs())
        } else {
            f64::INFINITY
        }
    })
}

/// Distances in words.
fn listed(distances: &[f64]) -> String {
    let words: Vec<String> = distances.iter().map(|distance| format!("{distance:+.1}")).collect();
    words.join(", ")
}

/// Every configuration with every reading of (39), the defaults first.
fn all_matches(s: &Specification, runs: &RadarEvidence) -> Vec<Match> {
    let names = [
        "root of the sum of squares",
        "joint norm",
        "root mean square",
        "mean",
        "sum",
    ];
    let of = |configuration| {
        let forms = FitForm::ALL.into_iter().zip(names);
        forms.map(move |(form, name)| compare(s, configuration, form, name))
    };
    runs.configurations.iter().flat_map(of).collect()
}

/// How far single runs scatter in scenario 1 of table 4, with the truth drawn in this way, %.
fn scatter(runs: &RadarEvidence, truth: Option<&str>) -> f64 {
    let of_truth = |configuration: &&Configuration| configuration.choices.chosen("truth") == truth;
    let found = runs.configurations.iter().find(of_truth);
    found.map_or(f64::NAN, |configuration| {
        let runs = &configuration.tables[0][0];
        runs.fit(configuration.unscented).standard_error * (runs.0.len() as f64).sqrt()
    })
}

pub fn tables_reachable(s: &Specification, runs: &RadarEvidence) -> JudgedClaim {
    let mut matches = all_matches(s, runs);
    let default = matches.first().map_or_else(String::new, |first| {
        let (straight, manoeuvring) = first.figures.split_at(4);
        format!(
            "At the defaults {} in table 4 and {} in table 5 (scenarios 1 and 2, IMM-CMKF and IMM-UKF); the differences of the columns {}, if \
             both filters saw the same. ",
            listed(straight),
            listed(manoeuvring),
            listed(&first.gaps)
        )
    });
    let single = matches
        .first()
        .map_or_else(String::new, |first| listed(&first.deviations));
    matches.sort_by(|a, b| most(&a.figures).total_cmp(&most(&b.figures)));
    let reached = |matches: &[Match]| matches.iter().filter(|one| most(&one.figures) < DECISIVE).count();
    let paired = matches.iter().filter(|one| most(&one.gaps) < DECISIVE).count();
    let nearest = matches.first().map_or_else(String::new, |nearest| {
        format!(
            "The nearest ({}): {}; differences of the columns {}.",
            nearest.name,
            listed(&nearest.figures),
            listed(&nearest.gaps)
        )
    });
    let evidence = format!(
        "Published figures less those of the runs, in standard errors of 50 runs and of these. {default}Of {} configurations, the defaults and \
         each open choice by itself with each reading of (39), {} have all eight figures within four, and {paired} the four differences of the \
         columns. {nearest} It is not printed whether all runs had one trajectory, which would then have its own figures: single runs scatter \
         by {} % over trajectories and by {} % on the first (scenario 1 of table 4, IMM-UKF), and the eight published figures are {single} \
         of the former from the mean.",
        matches.len(),
        reached(&matches),
        figure(scatter(runs, None)),
        figure(scatter(runs, Some("one-trajectory"))),
    );
    let is_reached = reached(&matches) > 0;
    let verdict = if is_reached {
        Verdict::Confirmed
    } else {
        Verdict::NotReached
    };
    s.judgement("sustika2015-tables-reachable", verdict, evidence)
}
