//! The claims of liu2017, each with its judge.
//!
//! After this file the reader knows by how much the four filters of the paper differ, and what could have made its table. The claims are
//! in `spec/liu2017/claims.toml`, in the same order; every judge computes its evidence and is called once in [`judge`].

use super::{BEARING_DEVIATION, RANGE_DEVIATION, quantity_of_row, scenario};
use crate::filter::kalman;
use crate::imm::Equations;
use crate::imm::printed::cubature_with_likelihood_21;
use crate::model::Measurement;
use crate::number::{Field, Rational, RationalFunction, Surd};
use crate::paper::Effort;
use crate::paper::experiment::Experiment;
use crate::paper::monte_carlo::{Generator, Progress, run, track};
use crate::paper::result::Quantity;
use crate::paper::scenario::{Contestant, Draw, Motion, Scenario};
use crate::paper::specification::{Choices, InvalidChoice, Specification, liu2017 as specification};
use crate::paper::verdict::{
    Judgement, RELEVANT, Verdict, all_of, better_by_a_thousandth, confirmed_if, in_words, proven_if,
};
use crate::rule::moment::{exactness, gaussian_moment, rule_moment};
use crate::rule::sphere::{every_dimension, on_simplex};
use crate::rule::{RuleName, fifth_degree, simplex};
use crate::statistics::estimate::{figure, paired_difference};
use nalgebra::{Matrix2, Matrix4, Vector2, Vector4, matrix};
use rayon::prelude::*;
use std::fmt::Write;

/// The positions of the contestants in the scenario.
const IMMUKF: usize = 0;
const IMMCKF: usize = 1;
const IMM5THCKF: usize = 2;
const IMM5THSSRCKF: usize = 3;

/// The filters that the proposed one is compared with.
const OTHERS: [usize; 3] = [IMMUKF, IMMCKF, IMM5THCKF];

/// Judges every claim.
///
/// # Errors
///
/// [`InvalidChoice`] when the specification lacks an alternative that a judge asks for.
pub fn judge(effort: Effort, progress: Progress) -> Result<Vec<Judgement>, InvalidChoice> {
    let printed = Experiment::new(scenario(&Choices::default())?, effort, progress);
    let s = specification();
    Ok(vec![
        better_accuracy(s, &printed),
        quicker_switching(s, &printed),
        fifth_degree_switching(s, &printed),
        no_divergence(s, &printed),
        point_counts(s),
        time_proportional_to_points(s),
        slightly_cheaper(s),
        degree_five(s),
        higher_accuracy_than_fifth_degree(s, &printed),
        linear_imm_cannot(s, &printed, effort, progress),
        cheaper_in_high_dimension(s),
        outperforms_in_manoeuvres(s, &printed),
        constant_velocity(s, &printed),
        table_1_gaps(s, &printed, effort, progress)?,
        likelihood_exponent_effect(s, effort, progress)?,
        printed_weights(s, &printed),
    ])
}

/// The verdict on "IMM5thSSRCKF is better than all others" over some steps, with the differences in words.
fn better_than_others(
    printed: &Experiment,
    quantities: &[Quantity],
    chosen: &dyn Fn(usize) -> bool,
) -> (Verdict, String) {
    let comparison = printed.comparison();
    let mut verdicts = Vec::new();
    let mut evidence = String::from("IMM5thSSRCKF minus");
    for other in OTHERS {
        let _ = write!(evidence, " {}:", printed.scenario.contestants[other].name);
        for &quantity in quantities {
            let unit = if quantity == Quantity::Velocity { "m/s" } else { "m" };
            let difference = comparison.difference_over(IMM5THSSRCKF, other, quantity, chosen);
            let error = comparison.error_over(other, quantity, chosen);
            verdicts.push(better_by_a_thousandth(difference, error));
            let relative = difference.value / error.value;
            let _ = write!(evidence, " {}, {} of it;", in_words(difference, unit), figure(relative));
        }
    }
    (all_of(&verdicts), evidence)
}

fn better_accuracy(s: &Specification, printed: &Experiment) -> Judgement {
    let quantities = [Quantity::Position, Quantity::Velocity];
    let (verdict, mut evidence) = better_than_others(printed, &quantities, &|_| true);
    let rows = s.tables[0].rows.iter();
    let published: Vec<String> = rows
        .map(|row| format!("{:+.1} %", 100.0 * (row.values[3] / row.values[0] - 1.0)))
        .collect();
    let _ = write!(evidence, " published against IMMUKF: {}.", published.join(" and "));
    s.judgement("liu2017-better-accuracy", verdict, evidence)
}

/// The mean delay of a filter over all switches and runs, s.
fn mean_delay(printed: &Experiment, contestant: usize) -> f64 {
    let delays = printed.comparison().delays(contestant);
    let detected: Vec<f64> = delays.iter().flatten().flatten().map(|delay| *delay as f64).collect();
    detected.iter().sum::<f64>() / detected.len() as f64
}

/// The runs and switches in which two filters' delays differ, of how many.
fn different_delays(printed: &Experiment, a: usize, b: usize) -> (usize, usize) {
    let comparison = printed.comparison();
    let (a, b) = (comparison.delays(a), comparison.delays(b));
    let pairs: Vec<_> = a.iter().flatten().zip(b.iter().flatten()).collect();
    (pairs.iter().filter(|(a, b)| a != b).count(), pairs.len())
}

fn quicker_switching(s: &Specification, printed: &Experiment) -> Judgement {
    let own = mean_delay(printed, IMM5THSSRCKF);
    let mut evidence = format!("Mean delay of IMM5thSSRCKF {own:.3} s;");
    let mut quicker = true;
    for other in OTHERS {
        let delay = mean_delay(printed, other);
        let (different, of) = different_delays(printed, IMM5THSSRCKF, other);
        let probability = printed
            .comparison()
            .greatest_probability_difference(IMM5THSSRCKF, other);
        // Quicker: by more than a hundredth of the sampling interval on average.
        quicker &= own < delay - 0.01;
        let _ = write!(
            evidence,
            " {} {delay:.3} s, different in {different} of {of} switches, mode probabilities never further apart than {};",
            printed.scenario.contestants[other].name,
            figure(probability),
        );
    }
    end_sentence(&mut evidence);
    let verdict = confirmed_if(quicker);
    s.judgement("liu2017-quicker-switching", verdict, evidence)
}

/// Ends a list of clauses with a full stop.
fn end_sentence(evidence: &mut String) {
    if evidence.ends_with(';') {
        let _ = evidence.pop();
        evidence.push('.');
    }
}

fn fifth_degree_switching(s: &Specification, printed: &Experiment) -> Judgement {
    let comparison = printed.comparison();
    let delays = [IMMUKF, IMMCKF, IMM5THCKF, IMM5THSSRCKF].map(|c| mean_delay(printed, c));
    let among = comparison.greatest_probability_difference(IMM5THCKF, IMM5THSSRCKF);
    let across = comparison.greatest_probability_difference(IMM5THSSRCKF, IMMUKF);
    let faster = delays[2].max(delays[3]) < delays[0].min(delays[1]) - 0.01;
    let evidence = format!(
        "Mean delays, in the order of the table: {delays:.3?} s. The mode probabilities of the two fifth-degree filters are never further \
         apart than {}, those of IMM5thSSRCKF and IMMUKF never further than {}: the first half of the sentence holds, the second does \
         {}hold.",
        figure(among),
        figure(across),
        if faster { "" } else { "not " },
    );
    let verdict = confirmed_if(faster);
    s.judgement("liu2017-fifth-degree-switching", verdict, evidence)
}

fn no_divergence(s: &Specification, printed: &Experiment) -> Judgement {
    // Diverged: further away than ten times the widest deviation of a measured position, 39.4 km · 7 mrad.
    let (bounded, evidence) = printed.stays_within(10.0 * 39_400.0 * BEARING_DEVIATION);
    s.judgement("liu2017-no-divergence", confirmed_if(bounded), evidence)
}

/// The numbers of points of the four rules in four dimensions, in the order of the table.
fn counted_points() -> [usize; 4] {
    let names = [
        RuleName::Unscented(None),
        RuleName::ThirdDegree,
        RuleName::FifthDegree,
        RuleName::Simplex,
    ];
    names.map(|name| name.exact(4).map_or(0, |rule| rule.points.len()))
}

/// The values of a row of the second table.
fn table_2<'a>(s: &'a Specification, name: &str) -> &'a [f64] {
    let row = s.tables[1].rows.iter().find(|row| row.name.starts_with(name));
    row.map_or(&[], |row| &row.values)
}

fn point_counts(s: &Specification) -> Judgement {
    let counted = counted_points();
    let published = table_2(s, "Number of Points");
    let counted_as_published: Vec<f64> = counted.iter().map(|points| *points as f64).collect();
    let equal = counted_as_published == published;
    let evidence = format!("Counted {counted:?}, published {published:?}.");
    s.judgement("liu2017-point-counts", proven_if(equal), evidence)
}

fn time_proportional_to_points(s: &Specification) -> Judgement {
    let (points, times) = (table_2(s, "Number of Points"), table_2(s, "Computational Time"));
    let per_point: Vec<f64> = times.iter().zip(points).map(|(time, points)| time / points).collect();
    let count = points.len() as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / count;
    let (mean_points, mean_time) = (mean(points), mean(times));
    let pairs = points.iter().zip(times);
    let covariance: f64 = pairs.map(|(p, t)| (p - mean_points) * (t - mean_time)).sum();
    let variance: f64 = points.iter().map(|p| (p - mean_points) * (p - mean_points)).sum();
    let slope = covariance / variance;
    let intercept = mean_time - slope * mean_points;
    let greatest = per_point.iter().copied().fold(f64::MIN, f64::max);
    let least = per_point.iter().copied().fold(f64::MAX, f64::min);
    let evidence = format!(
        "Published seconds a point: {per_point:.4?}, which differ by a factor {}. The straight line through the four is {} s + {} s a \
         point: {:.0} % of the time of the filter with the most points does not depend on them.",
        figure(greatest / least),
        figure(intercept),
        figure(slope),
        100.0 * intercept / times.iter().copied().fold(f64::MIN, f64::max),
    );
    // Approximately proportional: within a fifth.
    let verdict = proven_if(greatest / least < 1.2);
    s.judgement("liu2017-time-proportional-to-points", verdict, evidence)
}

fn slightly_cheaper(s: &Specification) -> Judgement {
    let fewer: Vec<usize> = (2..=10).filter(|&n| n * n + 3 * n + 3 < 2 * n * n + 1).collect();
    let [_, _, fifth, simplex] = counted_points();
    let times = table_2(s, "Computational Time");
    let evidence = format!(
        "n² + 3n + 3 < 2n² + 1 for n in {fewer:?} of 2 to 10, that is from n = 4 on. At n = 4 {simplex} points against {fifth}; but 8 of \
         the {fifth} have weight zero there and could be left out, and then the simplex rule is the costlier one. Published seconds: {} \
         against {}.",
        times[3], times[2],
    );
    s.judgement(
        "liu2017-slightly-cheaper",
        proven_if(simplex < fifth && times[3] < times[2]),
        evidence,
    )
}

fn degree_five(s: &Specification) -> Judgement {
    let n = every_dimension();
    let degree = on_simplex(&n, &simplex::edge_weight(&n)).degree();
    let failure = simplex::simplex(4).ok().and_then(|rule| exactness(&rule, 6).failure);
    let evidence = format!(
        "Symbolic, with the corrected weights and n unknown: the degree is {}. At n = 4 the first wrong moment is {}.",
        degree.map_or("none".to_owned(), |degree| degree.to_string()),
        failure.map_or("none".to_owned(), |failure| failure.to_string()),
    );
    s.judgement("liu2017-degree-five", proven_if(degree == Some(5)), evidence)
}

fn higher_accuracy_than_fifth_degree(s: &Specification, printed: &Experiment) -> Judgement {
    let monomials = [
        [6, 0, 0, 0],
        [0, 0, 0, 6],
        [4, 2, 0, 0],
        [2, 2, 2, 0],
        [3, 3, 0, 0],
        [5, 0, 0, 1],
    ];
    let mut evidence = String::from("Exact moments of degree six at n = 4, fifth-degree, simplex, Gaussian:");
    let (mut closer, mut farther) = (0, 0);
    if let (Ok(fifth), Ok(simplex)) = (fifth_degree::fifth_degree(4), simplex::simplex(4)) {
        for exponents in monomials {
            let name = crate::rule::moment::monomial_name(&exponents);
            let values = [rule_moment(&fifth, &exponents), rule_moment(&simplex, &exponents)];
            let gaussian = gaussian_moment(&exponents);
            let [of_fifth, of_simplex] =
                [&values[0], &values[1]].map(|value| (value.clone() - Surd::rational(&gaussian)).abs());
            closer += usize::from(of_simplex < of_fifth);
            farther += usize::from(of_simplex > of_fifth);
            let _ = write!(evidence, " {name}: {}, {}, {gaussian};", values[0], values[1]);
        }
    }
    let comparison = printed.comparison();
    let difference = comparison.difference(IMM5THSSRCKF, IMM5THCKF, Quantity::Position);
    let error = comparison.error(IMM5THCKF, Quantity::Position);
    let _ = write!(
        evidence,
        " the simplex rule is closer in {closer} of them and farther in {farther}. In the scenario IMM5thSSRCKF minus IMM5thCKF is {}.",
        in_words(difference, "m"),
    );
    let verdict = better_by_a_thousandth(difference, error);
    s.judgement("liu2017-higher-accuracy-than-fifth-degree", verdict, evidence)
}

/// The covariance of a position converted from a range and a bearing, to first order in their noise.
///
/// Source: Bar-Shalom, Li and Kirubarajan 2001, section 10.4.3: J R Jᵀ with the Jacobian J of (r cos θ, r sin θ) at the measurement.
fn converted_covariance(position: &Vector2<f64>) -> Matrix2<f64> {
    let range = position.norm();
    let (cosine, sine) = (position[0] / range, position[1] / range);
    let jacobian = matrix![cosine, -range * sine; sine, range * cosine];
    let noise = Matrix2::from_diagonal(&Vector2::new(
        RANGE_DEVIATION * RANGE_DEVIATION,
        BEARING_DEVIATION * BEARING_DEVIATION,
    ));
    jacobian * noise * jacobian.transpose()
}

/// Kalman filters on converted measurements in the paper's modes: the noise of a measurement is that of its own conversion.
fn converted_measurement_filter(contestant: &Contestant) -> Contestant {
    let mut converted = contestant.clone();
    "IMM with converted measurements".clone_into(&mut converted.name);
    converted.problem.rule = None;
    converted.points = None;
    converted.problem.measurement = Measurement::Linear(matrix![1.0, 0.0, 0.0, 0.0; 0.0, 0.0, 1.0, 0.0]);
    converted.equations = Equations {
        innovation_covariance: |problem, _, now, j| {
            let noise = now
                .measurement
                .as_ref()
                .map_or(problem.measurement_noise, converted_covariance);
            let h = problem.measurement.matrix();
            kalman::innovation_covariance(&h, &now.predicted[j].covariance, &noise)
        },
        ..Equations::kalman()
    };
    converted
}

fn linear_imm_cannot(s: &Specification, printed: &Experiment, effort: Effort, progress: Progress) -> Judgement {
    let filter = converted_measurement_filter(&printed.scenario.contestants[IMM5THSSRCKF]);
    let one_run = |run: usize| {
        let stream = u64::try_from(run).unwrap_or(u64::MAX);
        let draw = printed.scenario.draw(&mut Generator::new(effort.seed, stream));
        let position = |z: &Vector2<f64>| Vector2::new(z[0] * libm::cos(z[1]), z[0] * libm::sin(z[1]));
        let converted = Draw {
            measurements: draw.measurements.iter().map(position).collect(),
            ..draw
        };
        progress();
        track(&filter, &converted)
    };
    let runs: Vec<_> = (0..printed.runs.len()).into_par_iter().map(one_run).collect();
    let failed = runs.iter().filter(|run| run.failure.is_some()).count();
    let mean_square = |errors: &[Vector4<f64>]| {
        errors
            .iter()
            .map(|error| Quantity::Position.squared(error))
            .sum::<f64>()
            / errors.len() as f64
    };
    let converted: Vec<f64> = runs.iter().map(|run| mean_square(&run.errors)).collect();
    let cubature: Vec<f64> = printed
        .runs
        .iter()
        .map(|run| mean_square(&run[IMM5THSSRCKF].errors))
        .collect();
    let difference = paired_difference(&converted, &cubature);
    let error = printed.comparison().error(IMM5THSSRCKF, Quantity::Position);
    let relative = difference.value / error.value;
    let evidence = format!(
        "Kalman filters on measurements converted to positions, with the same modes, chain and noise: position error minus that of \
         IMM5thSSRCKF {}, {} of it; {failed} runs failed. Not \"directly\", but one conversion suffices.",
        in_words(difference, "m"),
        figure(relative),
    );
    // It deals with the problem when it loses less than a tenth.
    let verdict = if failed == 0 && relative < 0.1 {
        Verdict::Refuted
    } else {
        Verdict::Confirmed
    };
    s.judgement("liu2017-linear-imm-cannot", verdict, evidence)
}

fn cheaper_in_high_dimension(s: &Specification) -> Judgement {
    let ratio = |n: i64| Rational::new(n * n + 3 * n + 3, 2 * n * n + 1);
    let ratios: Vec<String> = [4, 8, 16, 64, 1024]
        .into_iter()
        .map(|n| format!("{n}: {}", figure(ratio(n).to_f64())))
        .collect();
    let falling = (4..1024).all(|n| ratio(n + 1) < ratio(n) && ratio(n) < Rational::new(1, 1));
    let evidence = format!(
        "Points of the simplex rule over those of the fifth-degree rule, n² + 3n + 3 over 2n² + 1, by n: {}. It falls from n = 4 on, \
         towards one half; the third-degree rule, with 2n points, is cheaper than both.",
        ratios.join(", "),
    );
    s.judgement("liu2017-cheaper-in-high-dimension", proven_if(falling), evidence)
}

fn outperforms_in_manoeuvres(s: &Specification, printed: &Experiment) -> Judgement {
    let schedule = &printed.scenario.schedule;
    let turning = |k: usize| schedule[k] != Motion::Straight;
    let (verdict, mut evidence) = better_than_others(printed, &[Quantity::Position], &turning);
    end_sentence(&mut evidence);
    s.judgement(
        "liu2017-outperforms-in-manoeuvres",
        verdict,
        format!("In the turns. {evidence}"),
    )
}

fn constant_velocity(s: &Specification, printed: &Experiment) -> Judgement {
    let schedule = &printed.scenario.schedule;
    let straight = |k: usize| schedule[k] == Motion::Straight;
    let comparison = printed.comparison();
    let same = OTHERS.iter().all(|&other| {
        let difference = comparison.difference_over(IMM5THSSRCKF, other, Quantity::Position, &straight);
        let error = comparison.error_over(other, Quantity::Position, &straight);
        (difference.value.abs() + 4.0 * difference.standard_error) < RELEVANT * error.value
    });
    let (_, mut evidence) = better_than_others(printed, &[Quantity::Position], &straight);
    end_sentence(&mut evidence);
    let verdict = confirmed_if(same);
    let which = if same {
        "this sentence, not the one before it"
    } else {
        "not this sentence"
    };
    s.judgement(
        "liu2017-constant-velocity",
        verdict,
        format!("In uniform motion {which}. {evidence}"),
    )
}

/// The range of the filters' overall errors in a quantity.
fn range(experiment: &Experiment, quantity: Quantity) -> f64 {
    let comparison = experiment.comparison();
    let errors: Vec<f64> = (0..experiment.scenario.contestants.len())
        .map(|c| comparison.error(c, quantity).value)
        .collect();
    errors.iter().copied().fold(f64::MIN, f64::max) - errors.iter().copied().fold(f64::MAX, f64::min)
}

/// The initial deviations that are swept, m and m/s: P₀ is not printed.
const POSITION_DEVIATIONS: [f64; 4] = [40.0, 150.0, 600.0, 2000.0];
const VELOCITY_DEVIATIONS: [f64; 3] = [5.0, 30.0, 150.0];

fn table_1_gaps(
    s: &Specification,
    printed: &Experiment,
    effort: Effort,
    progress: Progress,
) -> Result<Judgement, InvalidChoice> {
    let mut experiments = Vec::new();
    for choices in s.single_alternatives() {
        // Unpaired runs are what sampling does, not what the filters do; they have a figure of their own below.
        if choices.parameters().next() != Some("pairing") {
            let experiment = Experiment::new(scenario(&choices)?, effort, progress);
            experiments.push((choices.describe(), experiment));
        }
    }
    for position in POSITION_DEVIATIONS {
        for velocity in VELOCITY_DEVIATIONS {
            let mut swept = scenario(&Choices::default())?;
            let deviations = Vector4::new(position, velocity, position, velocity);
            swept.initial_covariance = Matrix4::from_diagonal(&deviations.component_mul(&deviations));
            let name = format!("initial deviations of {position} m and {velocity} m/s");
            experiments.push((name, Experiment::new(swept, effort, progress)));
        }
    }
    let mut evidence = String::new();
    let mut reached = true;
    for row in &s.tables[0].rows {
        let Some(quantity) = quantity_of_row(&row.name) else {
            continue;
        };
        let published = row.values[0] - row.values[3];
        let chance = 2_f64.sqrt() * printed.comparison().error(IMMUKF, quantity).standard_error;
        let widest = experiments
            .iter()
            .map(|(name, experiment)| (range(experiment, quantity), name))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let (width, name) = widest.map_or((f64::NAN, ""), |(width, name)| (width, name));
        let levels: Vec<f64> = experiments
            .iter()
            .map(|(_, experiment)| experiment.comparison().error(IMM5THSSRCKF, quantity).value)
            .collect();
        let lowest = levels.iter().copied().fold(f64::MAX, f64::min);
        let highest = levels.iter().copied().fold(f64::MIN, f64::max);
        // Explained: by the widest configuration, or by chance at four standard deviations.
        reached &= width >= published || 4.0 * chance >= published;
        let _ = write!(
            evidence,
            "{}: published range {} {}; paired, under the printed parameters {}; the widest of {} configurations {} ({name}), whose level \
             goes from {} to {}; standard deviation between two unpaired sets of runs {}. ",
            row.name,
            figure(published),
            row.unit,
            figure(range(printed, quantity)),
            experiments.len(),
            figure(width),
            figure(lowest),
            figure(highest),
            figure(chance),
        );
    }
    let failed: usize = experiments
        .iter()
        .map(|(_, e)| (0..4).map(|c| e.failures(c)).sum::<usize>())
        .sum();
    let _ = write!(evidence, "Failed runs in all configurations: {failed}.");
    let verdict = if reached {
        Verdict::Confirmed
    } else {
        Verdict::NotReproducible
    };
    Ok(s.judgement("liu2017-table-1-gaps", verdict, evidence))
}

fn likelihood_exponent_effect(
    s: &Specification,
    effort: Effort,
    progress: Progress,
) -> Result<Judgement, InvalidChoice> {
    let mut both = scenario(&Choices::default())?;
    let as_printed = both.contestants.iter().map(|contestant| Contestant {
        name: format!("{} as printed", contestant.name),
        equations: cubature_with_likelihood_21(),
        ..contestant.clone()
    });
    let as_printed: Vec<Contestant> = as_printed.collect();
    both.contestants.extend(as_printed);
    let both = Experiment::new(both, effort, progress);
    let comparison = both.comparison();
    let (corrected, printed) = (IMM5THSSRCKF, IMM5THSSRCKF + 4);
    let schedule = &both.scenario.schedule;
    let turning = |k: usize| schedule[k] != Motion::Straight;
    let straight = |k: usize| schedule[k] == Motion::Straight;
    let over =
        |chosen: &dyn Fn(usize) -> bool, quantity| comparison.difference_over(printed, corrected, quantity, chosen);
    let evidence = format!(
        "Not the density: |2πS| carries n_z already, and the printed exponent squares the determinant when n_z = 2. IMM5thSSRCKF with it, \
         minus without: position in the turns {}, on straight parts {}, velocity over all {}; mode probabilities up to {} apart; mean delay \
         {:.2} s for {:.2} s. Smaller errors here do not make it a density.",
        in_words(over(&turning, Quantity::Position), "m"),
        in_words(over(&straight, Quantity::Position), "m"),
        in_words(over(&|_| true, Quantity::Velocity), "m/s"),
        figure(comparison.greatest_probability_difference(printed, corrected)),
        mean_delay(&both, printed),
        mean_delay(&both, corrected),
    );
    let changes = comparison.greatest_probability_difference(printed, corrected) > RELEVANT;
    let verdict = if changes { Verdict::Refuted } else { Verdict::Undecided };
    Ok(s.judgement("liu2017-likelihood-exponent-effect", verdict, evidence))
}

fn printed_weights(s: &Specification, printed: &Experiment) -> Judgement {
    let mut evidence = String::from("Exact sums of the weights at n = 4, and the track of a filter with them:");
    let mut possible = false;
    for (number, name) in [(11, RuleName::SimplexPrinted11), (16, RuleName::SimplexPrinted16)] {
        let Ok(exact) = name.exact(4) else {
            continue;
        };
        let sum = exact.sum_of_weights();
        possible |= sum == Rational::new(1, 1);
        let proposed = &printed.scenario.contestants[IMM5THSSRCKF];
        let probabilities = proposed.initial_probabilities.clone();
        let contestant = Contestant::with_rule("printed", proposed.problem.clone(), &name, probabilities);
        let alone = Scenario {
            contestants: vec![contestant],
            ..printed.scenario.clone()
        };
        let runs = run(&alone, 1, 1, &|| ());
        let errors = &runs[0][0].errors;
        let first = errors
            .first()
            .map_or(f64::NAN, |e| Quantity::Position.squared(e).sqrt());
        let end = runs[0][0]
            .failure
            .as_ref()
            .map_or_else(|| "no step fails".to_owned(), ToString::to_string);
        let _ = write!(
            evidence,
            " ({number}) {sum}, off by {} m after the first measurement, {end};",
            figure(first)
        );
    }
    // The corrected weight over each of the printed ones, as functions of n.
    let n = every_dimension();
    let ratio_11 = simplex::edge_weight(&n) / crate::rule::printed::edge_weight_11(&n);
    let ratio_16 = simplex::edge_weight(&n) / crate::rule::printed::edge_weight_16(&n);
    let as_said = ratio_11 == RationalFunction::integer(2) && ratio_16 == n;
    if as_said {
        evidence.push_str(
            " symbolic: the weight of (11) is half of the right one and that of (16) an n-th of it, for every n.",
        );
    }
    s.judgement("liu2017-printed-weights", proven_if(possible), evidence)
}
