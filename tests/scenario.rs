//! Goal: a change of the program shows its effect on the papers' figures.
//!
//! Method: snapshots of short experiments, rounded, with units. Kind of evidence: snapshot, the weakest there is. It says what the
//! program answers and not whether that is right; it is for people who compare it with the published tables, and with what stood
//! there before. How long anything took is left out, and the figures of 20 runs are rough: `immaculate reproduce` has the rest.

use immaculate::paper::comparison::ErrorQuantity;
use immaculate::paper::result::{Performance, Reproduction};
use immaculate::paper::specification::Choices;
use immaculate::paper::{Effort, Paper};
use immaculate::report::reproduction::published_and_computed;
use immaculate::statistics::estimate::figure;
use std::fmt::Write;

#[test]
fn zhu2016_at_its_defaults() {
    // Before, during and after the right turn from 20 s to 39 s and the left turn from 60 s to 79 s.
    insta::assert_snapshot!(experiment(Paper::Zhu2016, &[10, 19, 21, 30, 41, 50, 61, 70, 81, 100]));
}

#[test]
fn liu2017_at_its_defaults() {
    // Before, during and after the right turn from 21 s to 70 s and the left turn from 121 s to 170 s.
    insta::assert_snapshot!(experiment(
        Paper::Liu2017,
        &[10, 20, 25, 45, 75, 100, 125, 145, 175, 200]
    ));
}

#[test]
fn derbez2000_at_its_defaults() {
    // Scenario 2: acceleration to 20 s, straight to 40 s, a turn to 100 s, straight to 140 s.
    let manoeuvres = experiment(Paper::Derbez2000, &[2, 10, 20, 22, 30, 40, 42, 60, 100, 102, 140]);
    // Scenario 1, of which the paper publishes no figures: past the radar at 120 s.
    let acceleration = reproduce(Paper::Derbez2000, &Choices::of("scenario", "acceleration"));
    let mut text = format!("{manoeuvres}\nscenario 1, errors\n");
    for filter in &acceleration.filters {
        let _ = write!(text, "{:<12}", filter.name);
        for quantity in [ErrorQuantity::X, ErrorQuantity::Y, ErrorQuantity::Position] {
            let error = acceleration.error(&filter.name, quantity).unwrap();
            let _ = write!(
                text,
                " {:>16}",
                format!("{} ± {}", figure(error.value), rough(error.standard_error))
            );
        }
        text.push('\n');
    }
    insta::assert_snapshot!(text);
}

#[test]
fn derbez2000_under_each_open_choice() {
    insta::assert_snapshot!(open_choices(Paper::Derbez2000));
}

#[test]
fn sustika2015_under_each_open_choice() {
    let defaults = Choices::default();
    let mut text = format!(
        "{:<60} {:>18} {:>18} {:>18}\n",
        "percentage fit error", "IMM-CMKF", "IMM-UKF", "difference"
    );
    for simulation in Paper::Sustika2015.simulations(&defaults) {
        for choices in [vec![simulation.clone()], Paper::Sustika2015.open_choices(&simulation)].concat() {
            let reproduction = reproduce(Paper::Sustika2015, &choices);
            let figures = reproduction.filters.iter().map(|filter| filter.fit_error);
            let difference = reproduction.fit_differences[0].estimate;
            let _ = write!(text, "{:<60}", choices.describe());
            for estimate in figures.chain([Some(difference)]) {
                let cell = estimate.map_or("none".to_owned(), |e| {
                    format!("{:.3} ± {:.3}", e.value, e.standard_error)
                });
                let _ = write!(text, " {cell:>18}");
            }
            trim(&mut text);
        }
    }
    insta::assert_snapshot!(text);
}

#[test]
fn zhu2016_under_each_open_choice() {
    insta::assert_snapshot!(open_choices(Paper::Zhu2016));
}

#[test]
fn liu2017_under_each_open_choice() {
    insta::assert_snapshot!(open_choices(Paper::Liu2017));
}

// How the snapshots are written

fn reproduce(paper: Paper, choices: &Choices) -> Reproduction {
    let effort = Effort {
        runs: Some(20),
        seed: 1,
    };
    paper.reproduce(choices, effort, &|| ()).unwrap()
}

fn experiment(paper: Paper, seconds: &[u32]) -> String {
    let reproduction = reproduce(paper, &Choices::default());
    let mut text = format!(
        "{}: {} runs of {} steps, seed {}\n",
        reproduction.paper, reproduction.runs, reproduction.steps, reproduction.seed
    );
    text.push_str(&tables(paper, &reproduction));
    text.push_str(&consistency(&reproduction));
    text.push_str(&delays(&reproduction));
    text.push_str(&mode_probabilities(&reproduction, seconds));
    text
}

/// The published figures and the computed ones with their standard errors.
fn tables(paper: Paper, reproduction: &Reproduction) -> String {
    let mut text = format!(
        "\n{:<22} {:<20} {:>10} {:>10} {:>8}\n",
        "", "", "published", "computed", "± s.e."
    );
    for comparison in published_and_computed(paper, reproduction) {
        let row = format!("{} ({})", comparison.row, comparison.unit);
        let _ = writeln!(
            text,
            "{row:<22} {:<20} {:>10} {:>10} {:>8}",
            comparison.filter,
            comparison.published,
            figure(comparison.computed),
            rough(comparison.standard_error),
        );
    }
    text
}

/// Normalised squared errors, 4 and 2 for a matched filter.
fn consistency(reproduction: &Reproduction) -> String {
    let mut text = format!(
        "\n{:<22} {:>8} {:>8} {:>8} {:>12}\n",
        "", "NEES", "NIS", "points", "failed runs"
    );
    for filter in &reproduction.filters {
        let points = filter.points.map_or("none".to_owned(), |points| points.to_string());
        let _ = writeln!(
            text,
            "{:<22} {:>8.2} {:>8.2} {points:>8} {:>12}",
            filter.name,
            filter.nees.mean.value,
            filter.nis.mean.value,
            filter.failures.len(),
        );
    }
    text
}

/// Mean and greatest delay of detection of each change of motion, s.
fn delays(reproduction: &Reproduction) -> String {
    let mut text = String::from("\ndelay of detection in s, mean (greatest)\n");
    for filter in reproduction.filters.iter().filter(|filter| !filter.delays.is_empty()) {
        let _ = write!(text, "{:<22}", filter.name);
        for delay in &filter.delays {
            let of_change = format!("{} s: {:.2} ({})", delay.time, delay.mean, delay.greatest);
            let missed = filter.completed_runs - delay.detected;
            let never = if missed == 0 {
                String::new()
            } else {
                format!(" {missed} never")
            };
            let _ = write!(text, " {:<18}", of_change + &never);
        }
        trim(&mut text);
    }
    text
}

/// Mean mode probabilities at a handful of times; filters that agree in all of them stand together.
fn mode_probabilities(reproduction: &Reproduction, seconds: &[u32]) -> String {
    let mut groups: Vec<(Vec<&str>, String)> = Vec::new();
    for filter in reproduction.filters.iter().filter(|filter| filter.modes.len() > 1) {
        let history = history(reproduction, filter, seconds);
        match groups.iter_mut().find(|group| group.1 == history) {
            Some(group) => group.0.push(&filter.name),
            None => groups.push((vec![&filter.name], history)),
        }
    }
    let mut text = String::from("\nmean mode probabilities\n");
    for (names, history) in groups {
        let _ = write!(text, "{}\n{history}", names.join(", "));
    }
    text
}

fn history(reproduction: &Reproduction, filter: &Performance, seconds: &[u32]) -> String {
    let mut text = format!("       s  {}\n", filter.modes.join(", "));
    for second in seconds {
        let time = f64::from(*second);
        // Times are whole seconds, made of whole seconds.
        let Some(k) = reproduction.times.iter().position(|t| t.to_bits() == time.to_bits()) else {
            continue;
        };
        let _ = write!(text, "{time:>8}");
        for probability in &filter.mode_probabilities[k] {
            let _ = write!(text, " {probability:>6.3}");
        }
        let _ = writeln!(text, "  {}", reproduction.motions[k]);
    }
    text
}

/// The position errors under each alternative, the other choices at their defaults.
fn open_choices(paper: Paper) -> String {
    let mut choices = vec![Choices::default()];
    choices.extend(paper.open_choices(&choices[0]));
    for other in &paper.simulations(&choices[0])[1..] {
        choices.push(other.clone());
        choices.extend(paper.open_choices(other));
    }
    let names: Vec<String> = reproduce(paper, &choices[0])
        .filters
        .into_iter()
        .map(|f| f.name)
        .collect();
    let mut text = format!("{:<50}", "position error in m");
    for name in &names {
        let _ = write!(text, " {name:>20}");
    }
    trim(&mut text);
    for choices in &choices {
        let reproduction = reproduce(paper, choices);
        let _ = write!(text, "{:<50}", choices.describe());
        for name in &names {
            let error = reproduction.error(name, ErrorQuantity::Position);
            let error = error.map_or("none".to_owned(), |error| figure(error.value));
            let _ = write!(text, " {error:>20}");
        }
        trim(&mut text);
    }
    text
}

/// Two digits: more mean nothing for a standard error of 20 runs.
fn rough(value: f64) -> String {
    match value {
        value if value >= 1.0 => format!("{value:.1}"),
        value if value >= 0.1 => format!("{value:.2}"),
        value if value >= 0.01 => format!("{value:.3}"),
        value => format!("{value:.4}"),
    }
}

/// Ends a line, without blanks.
fn trim(text: &mut String) {
    text.truncate(text.trim_end().len());
    text.push('\n');
}
