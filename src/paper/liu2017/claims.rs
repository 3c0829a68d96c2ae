//! The claims of liu2017, each with its judge.
//!
//! The claims are in `spec/liu2017/claims.toml`, in the same order. Every judge computes its evidence and is called once in [`judge`]. The
//! judges that need no runs are in [`arithmetic`].

use super::{BEARING_DEVIATION, arithmetic, quantity_of_row, scenario};
use crate::filter::Filter;
use crate::imm::{Equations, Problem};
use crate::model::Conversion;
use crate::number::{Field, Rational, RationalFunction, Surd};
use crate::paper::Effort;
use crate::paper::comparison::ErrorQuantity;
use crate::paper::experiment::Experiment;
use crate::paper::monte_carlo::{Progress, run};
use crate::paper::scenario::{Contestant, Course, Scenario};
use crate::paper::specification::{Choices, InvalidChoice, Specification, liu2017 as specification};
use crate::paper::verdict::{
    DECISIVE, JudgedClaim, RELEVANT, Tally, Verdict, all_of, better_by_a_thousandth, confirmed_if, in_words,
    is_within_a_thousandth, proven_if, refuted_by,
};
use crate::rule::moment::{gaussian_moment, rule_moment};
use crate::rule::sphere::every_dimension;
use crate::rule::{RuleName, fifth_degree, simplex};
use crate::statistics::estimate::figure;
use nalgebra::{Matrix4, Vector4};
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
pub fn judge(effort: Effort, progress: Progress) -> Result<Vec<JudgedClaim>, InvalidChoice> {
    let printed = Experiment::new(scenario(&Choices::default())?, effort, progress);
    let s = specification();
    let starts = starts(s, effort, progress)?;
    Ok(vec![
        better_accuracy(s, &printed, &starts),
        quicker_switching(s, &printed),
        fifth_degree_switching(s, &printed),
        no_divergence(s, &printed),
        arithmetic::point_counts(s),
        arithmetic::time_proportional_to_points(s),
        arithmetic::slightly_cheaper(s),
        arithmetic::degree_five(s),
        higher_accuracy_than_fifth_degree(s, &printed),
        linear_imm_cannot(s, &printed, effort, progress),
        arithmetic::cheaper_in_high_dimension(s),
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
    quantities: &[ErrorQuantity],
    chosen: &dyn Fn(usize) -> bool,
) -> (Verdict, String) {
    let comparison = printed.comparison();
    let mut verdicts = Vec::new();
    let mut evidence = String::from("IMM5thSSRCKF minus");
    for other in OTHERS {
        let _ = write!(evidence, " {}:", printed.scenario.contestants[other].name);
        for &quantity in quantities {
            let unit = if quantity == ErrorQuantity::Velocity {
                "m/s"
            } else {
                "m"
            };
            let difference = comparison.difference_over(IMM5THSSRCKF, other, quantity, chosen);
            let error = comparison.error_over(other, quantity, chosen);
            verdicts.push(better_by_a_thousandth(difference, error));
            let relative = difference.value / error.value;
            let _ = write!(evidence, " {}, {} of it;", in_words(difference, unit), figure(relative));
        }
    }
    (all_of(&verdicts), evidence)
}

/// The scenario with the initial covariances that are not its default: P₀ is not printed.
fn starts(s: &Specification, effort: Effort, progress: Progress) -> Result<Vec<Experiment>, InvalidChoice> {
    let of_start = s.single_alternatives().into_iter();
    let of_start = of_start.filter(|choices| choices.parameters().next() == Some("initial-covariance"));
    let run = |choices: Choices| Ok(Experiment::new(scenario(&choices)?, effort, progress));
    of_start.map(run).collect()
}

/// The errors of the proposed filter beside all others, at the default initial covariance and at the others.
pub fn better_accuracy(s: &Specification, printed: &Experiment, starts: &[Experiment]) -> JudgedClaim {
    let quantities = [ErrorQuantity::Position, ErrorQuantity::Velocity];
    let (first, mut evidence) = better_than_others(printed, &quantities, &|_| true);
    let mut verdicts = vec![first];
    for start in starts {
        let (verdict, words) = better_than_others(start, &quantities, &|_| true);
        verdicts.push(verdict);
        let _ = write!(evidence, " {}: {words}", start.scenario.choices.describe());
    }
    let rows = s.tables[0].rows.iter();
    let published: Vec<String> = rows
        .map(|row| format!("{:+.1} %", 100.0 * (row.values[3] / row.values[0] - 1.0)))
        .collect();
    let _ = write!(evidence, " published against IMMUKF: {}.", published.join(" and "));
    let tally = Tally::of_verdicts(&verdicts);
    s.judgement("liu2017-better-accuracy", tally.verdict(), evidence)
        .over(tally)
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

/// Its delays beside all others.
pub fn quicker_switching(s: &Specification, printed: &Experiment) -> JudgedClaim {
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

/// The delays of both fifth-degree filters beside the others.
pub fn fifth_degree_switching(s: &Specification, printed: &Experiment) -> JudgedClaim {
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

/// Whether any run fails or goes far off.
pub fn no_divergence(s: &Specification, printed: &Experiment) -> JudgedClaim {
    // Diverged: further away than ten times the widest deviation of a measured position, 39.4 km · 7 mrad.
    let (bounded, evidence) = printed.stays_within(10.0 * 39_400.0 * BEARING_DEVIATION);
    s.judgement("liu2017-no-divergence", confirmed_if(bounded), evidence)
}

/// The two fifth-degree rules beside each other, by moments and in the scenario.
pub fn higher_accuracy_than_fifth_degree(s: &Specification, printed: &Experiment) -> JudgedClaim {
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
    let difference = comparison.difference(IMM5THSSRCKF, IMM5THCKF, ErrorQuantity::Position);
    let error = comparison.error(IMM5THCKF, ErrorQuantity::Position);
    let _ = write!(
        evidence,
        " the simplex rule is closer in {closer} of them and farther in {farther}. In the scenario IMM5thSSRCKF minus IMM5thCKF is {}.",
        in_words(difference, "m"),
    );
    let verdict = better_by_a_thousandth(difference, error);
    s.judgement("liu2017-higher-accuracy-than-fifth-degree", verdict, evidence)
}

/// Kalman filters on converted measurements in the paper's modes: the noise of a measurement is that of its own conversion.
fn with_converted_measurements(contestant: &Contestant) -> Contestant {
    Contestant {
        name: "IMM with converted measurements".to_owned(),
        problem: Problem {
            filters: vec![Filter::converted(Conversion::Standard)],
            ..contestant.problem.clone()
        },
        equations: Equations::standard(),
        points: None,
        ..contestant.clone()
    }
}

fn linear_imm_cannot(s: &Specification, printed: &Experiment, effort: Effort, progress: Progress) -> JudgedClaim {
    let proposed = &printed.scenario.contestants[IMM5THSSRCKF];
    let both = Scenario {
        contestants: vec![proposed.clone(), with_converted_measurements(proposed)],
        ..printed.scenario.clone()
    };
    let both = Experiment::new(both, effort, progress);
    let (comparison, failed) = (both.comparison(), both.failures(1));
    let difference = comparison.difference(1, 0, ErrorQuantity::Position);
    let error = comparison.error(0, ErrorQuantity::Position);
    let relative = difference.value / error.value;
    let evidence = format!(
        "Kalman filters on measurements converted to positions, with the same modes, chain and noise: position error minus that of \
         IMM5thSSRCKF {}, {} of it; {failed} runs failed. Not \"directly\", but one conversion suffices.",
        in_words(difference, "m"),
        figure(relative),
    );
    // It deals with the problem when it loses less than a tenth.
    let deals_with_it = failed == 0 && relative < 0.1;
    s.judgement("liu2017-linear-imm-cannot", refuted_by(deals_with_it), evidence)
}

/// The errors of the proposed filter beside all others, in the turns.
pub fn outperforms_in_manoeuvres(s: &Specification, printed: &Experiment) -> JudgedClaim {
    let schedule = &printed.scenario.schedule;
    let turning = |k: usize| schedule[k] != Course::Straight;
    let (verdict, mut evidence) = better_than_others(printed, &[ErrorQuantity::Position], &turning);
    end_sentence(&mut evidence);
    s.judgement(
        "liu2017-outperforms-in-manoeuvres",
        verdict,
        format!("In the turns. {evidence}"),
    )
}

/// The same on straight parts.
pub fn constant_velocity(s: &Specification, printed: &Experiment) -> JudgedClaim {
    let schedule = &printed.scenario.schedule;
    let straight = |k: usize| schedule[k] == Course::Straight;
    let comparison = printed.comparison();
    let same = OTHERS.iter().all(|&other| {
        let difference = comparison.difference_over(IMM5THSSRCKF, other, ErrorQuantity::Position, &straight);
        let error = comparison.error_over(other, ErrorQuantity::Position, &straight);
        is_within_a_thousandth(difference, error)
    });
    let (_, mut evidence) = better_than_others(printed, &[ErrorQuantity::Position], &straight);
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
fn range(experiment: &Experiment, quantity: ErrorQuantity) -> f64 {
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
) -> Result<JudgedClaim, InvalidChoice> {
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
        reached &= is_explained(published, width, chance);
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
        Verdict::NotReached
    };
    Ok(s.judgement("liu2017-table-1-gaps", verdict, evidence))
}

/// Whether a published range is one of a configuration, or of chance at four standard deviations.
pub fn is_explained(published: f64, widest: f64, standard_deviation: f64) -> bool {
    widest >= published || DECISIVE * standard_deviation >= published
}

fn likelihood_exponent_effect(
    s: &Specification,
    effort: Effort,
    progress: Progress,
) -> Result<JudgedClaim, InvalidChoice> {
    let mut both = scenario(&Choices::default())?;
    let as_printed = both.contestants.iter().map(|contestant| Contestant {
        name: format!("{} as printed", contestant.name),
        equations: Equations::standard().with_likelihood_21(),
        ..contestant.clone()
    });
    let as_printed: Vec<Contestant> = as_printed.collect();
    both.contestants.extend(as_printed);
    let both = Experiment::new(both, effort, progress);
    let comparison = both.comparison();
    let (corrected, printed) = (IMM5THSSRCKF, IMM5THSSRCKF + 4);
    let schedule = &both.scenario.schedule;
    let turning = |k: usize| schedule[k] != Course::Straight;
    let straight = |k: usize| schedule[k] == Course::Straight;
    let over =
        |chosen: &dyn Fn(usize) -> bool, quantity| comparison.difference_over(printed, corrected, quantity, chosen);
    let evidence = format!(
        "Not the density: |2πS| carries n_z already, and the printed exponent squares the determinant when n_z = 2. IMM5thSSRCKF with it, \
         minus without: position in the turns {}, on straight parts {}, velocity over all {}; mode probabilities up to {} apart; mean delay \
         {:.2} s for {:.2} s. Smaller errors here do not make it a density.",
        in_words(over(&turning, ErrorQuantity::Position), "m"),
        in_words(over(&straight, ErrorQuantity::Position), "m"),
        in_words(over(&|_| true, ErrorQuantity::Velocity), "m/s"),
        figure(comparison.greatest_probability_difference(printed, corrected)),
        mean_delay(&both, printed),
        mean_delay(&both, corrected),
    );
    let changes = comparison.greatest_probability_difference(printed, corrected) > RELEVANT;
    Ok(s.judgement("liu2017-likelihood-exponent-effect", refuted_by(changes), evidence))
}

fn printed_weights(s: &Specification, printed: &Experiment) -> JudgedClaim {
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
            .map_or(f64::NAN, |e| ErrorQuantity::Position.squared(e).sqrt());
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
