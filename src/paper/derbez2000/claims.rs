//! The claims of derbez2000, each with its judge.
//!
//! The claims are in `spec/derbez2000/claims.toml`, in the same order. Every judge computes its evidence and is called once in [`judge`].
//! The judges that need no runs are in [`arithmetic`].

use super::arithmetic::published;
use super::contestants::{CA, CoordinateFilters, Coordinates, FIXED_GAIN, IMM, Reading};
use super::path::{PlaneState, Regime};
use super::relative::{Relative, below, extremes, relative, within};
use super::scenario::{CoordinateScenario, Steps, follow};
use super::{CLOSEST_POINT, arithmetic, long_term, scenario, search, stability};
use crate::imm::{Equations, Interaction};
use crate::paper::comparison::ErrorQuantity;
use crate::paper::experiment::Experiment;
use crate::paper::monte_carlo::Progress;
use crate::paper::specification::{Choices, InvalidChoice, Specification, derbez2000 as specification};
use crate::paper::verdict::{JudgedClaim, Tally, Verdict};
use crate::paper::{Effort, Paper};
use crate::statistics::Estimate;
use crate::statistics::delay::detection_delays;
use crate::statistics::estimate::{figure, mean};
use nalgebra::Matrix1;
use std::fmt::Write;

/// The positions of the two contestants that the judges add.
const OTHER_READING: usize = 3;
const WITHOUT_SPREAD: usize = 4;

/// A scenario and its runs.
pub type CoordinateRuns = Experiment<CoordinateScenario>;

/// What the judges ask about.
#[derive(Debug, Clone)]
pub struct CoordinateEvidence {
    /// Scenario 2 at its defaults, then under every alternative by itself.
    pub manoeuvres: Vec<CoordinateRuns>,
    /// Scenario 1, likewise.
    pub acceleration: Vec<CoordinateRuns>,
}

/// Judges every claim.
///
/// # Errors
///
/// [`InvalidChoice`] when the specification lacks an alternative that a judge asks for.
pub fn judge(effort: Effort, progress: Progress) -> Result<Vec<JudgedClaim>, InvalidChoice> {
    let s = specification();
    let runs = CoordinateEvidence::new(effort, progress)?;
    let map = stability::map();
    Ok(vec![
        long_term::half_the_load(s),
        almost_as_well(s, &runs),
        arithmetic::constant_bounded_error(s),
        minor_covariance_changes(s, &runs, effort),
        sluggish_onset(s, &runs),
        long_term::proposition(s),
        stability::theorem(s),
        long_term::algorithm_accuracy(s, effort),
        stability::stability_matrices(s, &map),
        stability::prior_data_discounted(s),
        arithmetic::moment_matching_bound(s),
        arithmetic::moment_matching_size(s),
        cartesian_filtering(s, effort, progress)?,
        equal_on_acceleration(s, &runs),
        thirty_per_cent(s, &runs),
        full_imm_much_better(s, &runs),
        third_set_supports(s, &runs),
        stability::convex_combination(s),
        stability::stable_unmixed(s),
        stability::stable_mixed(s),
        stability::stable_mixed_unequal_noises(s, &map),
        stability::local_instability(s),
        arithmetic::nonlinear_filters(s),
        arithmetic::table_arithmetic(s),
        arithmetic::operation_counts(s),
        search::table_1_reachable(s, effort, progress),
    ])
}

impl CoordinateEvidence {
    /// Runs both scenarios at their defaults and under every alternative by itself.
    ///
    /// # Errors
    ///
    /// [`InvalidChoice`] when the specification lacks an alternative that is asked for.
    pub fn new(effort: Effort, progress: Progress) -> Result<Self, InvalidChoice> {
        let paper = Paper::Derbez2000;
        let run = |choices: &Choices| {
            let mut scenario = scenario(choices)?;
            add_contestants(&mut scenario);
            Ok(Experiment::new(scenario, effort, progress))
        };
        let of_simulation = |choices: &Choices| -> Result<Vec<CoordinateRuns>, InvalidChoice> {
            let mut all = vec![choices.clone()];
            all.extend(paper.open_choices(choices));
            all.iter().map(run).collect()
        };
        let simulations = paper.simulations(&Choices::default());
        Ok(Self {
            manoeuvres: of_simulation(&simulations[0])?,
            acceleration: of_simulation(&simulations[1])?,
        })
    }
}

/// The other reading of the fixed-gain filter, and an IMM filter that leaves the spread of the means out of its mixed covariances.
fn add_contestants(scenario: &mut CoordinateScenario) {
    let (setup, variances) = (&scenario.setup, scenario.setup.measurement_variances(&scenario.path));
    let mut other = setup.fixed_gain(variances);
    let (name, interaction) = match setup.reading {
        Reading::Mixed => ("un-mixed", Interaction::Unmixed),
        Reading::Unmixed => ("mixed", Interaction::Imm),
    };
    name.clone_into(&mut other.name);
    for problem in &mut other.problems {
        problem.interaction = interaction.clone();
    }
    let without_spread = CoordinateFilters {
        name: "without spread".to_owned(),
        equations: Equations {
            mixed_covariance: |_, previous, now, j| {
                let weighted = now.mixing_probabilities[j].iter().zip(&previous.updated);
                weighted.map(|(weight, estimate)| estimate.covariance * *weight).sum()
            },
            ..Equations::standard()
        },
        ..setup.imm(variances)
    };
    scenario.contestants.extend([other, without_spread]);
}

fn any(_: Regime) -> bool {
    true
}

fn in_turn(motion: Regime) -> bool {
    motion == Regime::Turn
}

/// The fixed-gain filter beside the full one.
pub fn almost_as_well(s: &Specification, runs: &CoordinateEvidence) -> JudgedClaim {
    let position = |other: usize| relative(&runs.manoeuvres, [other, IMM], ErrorQuantity::Position, any);
    let (chosen, other) = (position(FIXED_GAIN), position(OTHER_READING));
    // Almost as well: worse by less than a tenth.
    let tally = below(&chosen, 0.1).and(below(&other, 0.1));
    let evidence = format!(
        "Scenario 2, position error less that of IMM, as a part of the latter. Mixed reading where nothing else is said: {}. The other \
         reading: {}.",
        extremes(&chosen),
        extremes(&other),
    );
    s.judgement("derbez2000-almost-as-well", tally.verdict(), evidence)
        .over(tally)
}

/// How large the spread of the means is beside the covariance to which it is added, for the position, in each step of either coordinate
/// and mode.
fn spread_ratios(runs: &CoordinateRuns, seed: u64) -> Vec<f64> {
    let scenario = &runs.scenario;
    let mut ratios = Vec::new();
    for run in 0..runs.runs.len() {
        let mut last: Option<[Vec<f64>; 2]> = None;
        let mut keep = |steps: Steps, _: &PlaneState| {
            let variances = steps.map(|step| {
                step.updated
                    .iter()
                    .map(|estimate| estimate.covariance[(0, 0)])
                    .collect()
            });
            if let Some(before) = last.replace(variances) {
                for (step, before) in steps.iter().zip(before) {
                    for (mixed, weights) in step.mixed.iter().zip(&step.mixing_probabilities) {
                        let without: f64 = weights
                            .iter()
                            .zip(&before)
                            .map(|(weight, variance)| weight * variance)
                            .sum();
                        ratios.push(mixed.covariance[(0, 0)] / without - 1.0);
                    }
                }
            }
        };
        follow(
            scenario,
            &scenario.contestants[IMM],
            &scenario.seen(run, seed),
            &mut keep,
        );
    }
    ratios.sort_by(f64::total_cmp);
    ratios
}

/// What the spread of the means adds to the mixed covariances, and what leaving it out costs.
pub fn minor_covariance_changes(s: &Specification, runs: &CoordinateEvidence, effort: Effort) -> JudgedClaim {
    let mut evidence = String::from(
        "Spread of the means over the variance of the position that it is added to, full IMM at the defaults:",
    );
    for (name, experiments) in [("scenario 1", &runs.acceleration), ("scenario 2", &runs.manoeuvres)] {
        let ratios = spread_ratios(&experiments[0], effort.seed);
        let last = ratios.len().max(1) - 1;
        let quantile = |tenths: usize| ratios.get(last * tenths / 10).copied().unwrap_or(f64::NAN);
        let _ = write!(
            evidence,
            " {name}: {} at the median, {} at the ninth decile, {} at most;",
            figure(quantile(5)),
            figure(quantile(9)),
            figure(quantile(10)),
        );
    }
    let [first, second] = [&runs.acceleration, &runs.manoeuvres]
        .map(|experiments| relative(experiments, [WITHOUT_SPREAD, IMM], ErrorQuantity::Position, any));
    // Minor in performance: less than a tenth of the error.
    let tally = within(&first, 0.1).and(within(&second, 0.1));
    let _ = write!(
        evidence,
        " position error of the filter without the spread less with it: scenario 1 {}; scenario 2 {}. Minor is less than a tenth of the error.",
        extremes(&first),
        extremes(&second),
    );
    s.judgement("derbez2000-minor-covariance-changes", tally.verdict(), evidence)
        .over(tally)
}

/// The mean delay of a contestant in each run, in steps, over the changes of regime in either coordinate; a change that is never noticed
/// counts with all the steps until the next.
fn delays(runs: &CoordinateRuns, contestant: usize) -> Vec<f64> {
    let lanes = [0, 1].map(|c| {
        runs.scenario
            .accelerates(c)
            .into_iter()
            .map(usize::from)
            .collect::<Vec<_>>()
    });
    let of_lane = |true_modes: &[usize], probabilities: &[Vec<f64>]| -> Vec<f64> {
        let changes: Vec<usize> = (1..true_modes.len())
            .filter(|&k| true_modes[k] != true_modes[k - 1])
            .collect();
        let ends = changes.iter().skip(1).copied().chain([true_modes.len()]);
        let lengths = changes.iter().zip(ends).map(|(start, end)| end - start);
        let delays = detection_delays(true_modes, probabilities);
        delays
            .iter()
            .zip(lengths)
            .map(|(delay, length)| delay.unwrap_or(length) as f64)
            .collect()
    };
    let of_run = |run: &Vec<crate::paper::simulation::Run>| {
        let probabilities = &run[contestant].mode_probabilities;
        let lane = |c: usize| {
            probabilities
                .iter()
                .map(|p| p[2 * c..2 * c + 2].to_vec())
                .collect::<Vec<_>>()
        };
        let all: Vec<f64> = [0, 1].into_iter().flat_map(|c| of_lane(&lanes[c], &lane(c))).collect();
        all.iter().sum::<f64>() / all.len() as f64
    };
    runs.runs.iter().map(of_run).collect()
}

/// How late the fixed-gain filter notices a change of regime.
pub fn sluggish_onset(s: &Specification, runs: &CoordinateEvidence) -> JudgedClaim {
    let mut evidence = String::from(
        "Scenario 2, mean delay of the true model over all changes of regime in x and y, a change that is never noticed counting with all \
         steps until the next; fixed gain less IMM, as a part of the latter:",
    );
    let of_experiment = |experiment: &CoordinateRuns| {
        let (of_imm, of_fixed) = (delays(experiment, IMM), delays(experiment, FIXED_GAIN));
        let pairs: Vec<f64> = of_fixed.iter().zip(&of_imm).map(|(fixed, imm)| fixed - imm).collect();
        let (difference, delay) = (mean(&pairs), mean(&of_imm).value);
        Relative {
            choices: experiment.scenario.choices.describe(),
            difference: Estimate {
                value: difference.value / delay,
                standard_error: difference.standard_error / delay,
            },
        }
    };
    let all: Vec<Relative> = runs.manoeuvres.iter().map(of_experiment).collect();
    // Slower: certainly above zero.
    let faster = below(&all, 0.0);
    let tally = Tally {
        holds: faster.fails,
        fails: faster.holds,
        ..faster
    };
    let _ = write!(
        evidence,
        " {}; the delay of IMM at the defaults is {} steps.",
        extremes(&all),
        figure(mean(&delays(&runs.manoeuvres[0], IMM)).value),
    );
    s.judgement("derbez2000-sluggish-onset", tally.verdict(), evidence)
        .over(tally)
}

/// The powers of ten that the bearing's process noise takes, (rad/s²)².
const BEARING_NOISES: std::ops::RangeInclusive<i32> = -10..=2;

/// The contestant on range and bearing themselves, the process noise of the bearing multiplied by a factor.
fn polar(contestant: &CoordinateFilters, factor: f64, variances: [f64; 2]) -> CoordinateFilters {
    let mut polar = contestant.clone();
    let _ = write!(polar.name, " of range and bearing");
    polar.coordinates = Coordinates::Polar;
    for (problem, variance) in polar.problems.iter_mut().zip(variances) {
        problem.measurement_noise = Matrix1::new(variance);
    }
    for mode in &mut polar.problems[1].modes {
        mode.noise *= factor;
    }
    polar
}

/// Filters of x and y beside filters of range and bearing.
///
/// # Errors
///
/// [`InvalidChoice`] when the specification lacks an alternative that is asked for.
pub fn cartesian_filtering(
    s: &Specification,
    effort: Effort,
    progress: Progress,
) -> Result<JudgedClaim, InvalidChoice> {
    let mut evidence = String::from(
        "Scenario 1, position error of x and y less that of range and bearing with the best of 13 noises of the bearing.",
    );
    let mut all = Vec::new();
    for path in ["from-rest", "turning-point"] {
        let choices = Choices::of("scenario", "acceleration").with("path", path);
        let both = Experiment::new(both_coordinates(scenario(&choices)?), effort, progress);
        let comparison = both.comparison();
        let near = |k: usize| (k + 1).abs_diff(CLOSEST_POINT) <= 10;
        for (filter, name) in ["IMM", "CA"].into_iter().enumerate() {
            for (place, chosen) in [
                ("over all", &(|_: usize| true) as &dyn Fn(usize) -> bool),
                ("near the radar", &near),
            ] {
                let error = |c: usize| comparison.error_over(c, ErrorQuantity::Position, chosen).value;
                let polar = (2..both.scenario.contestants.len()).filter(|c| c % 2 == filter);
                let Some(best) = polar.min_by(|a, b| error(*a).total_cmp(&error(*b))) else {
                    continue;
                };
                let difference = comparison.difference_over(filter, best, ErrorQuantity::Position, chosen);
                let difference = Estimate {
                    value: difference.value / error(best),
                    standard_error: difference.standard_error / error(best),
                };
                all.push(Relative {
                    choices: format!("{name} {place}, path={path}"),
                    difference,
                });
            }
        }
    }
    for relative in &all {
        let _ = write!(evidence, " {};", relative.words());
    }
    let tally = below(&all, 0.0);
    evidence.push_str(
        " as parts of the latter. The noise of the bearing is not printed; with a bad one range and bearing are as poor as one likes.",
    );
    Ok(s.judgement("derbez2000-cartesian-filtering", tally.verdict(), evidence)
        .over(tally))
}

/// IMM and CA of x and y, then both of range and bearing with each of the noises.
fn both_coordinates(scenario: CoordinateScenario) -> CoordinateScenario {
    let mut contestants = vec![scenario.contestants[IMM].clone(), scenario.contestants[CA].clone()];
    for power in BEARING_NOISES {
        let tenth_or_ten = if power < 0 { 0.1 } else { 10.0 };
        let noise = (0..power.unsigned_abs()).fold(1.0, |noise, _| noise * tenth_or_ten);
        for filter in [0, 1] {
            let factor = noise / scenario.setup.noise_variance;
            contestants.push(polar(&contestants[filter], factor, scenario.variances));
        }
    }
    CoordinateScenario {
        contestants,
        ..scenario
    }
}

/// Scenario 1: all filters beside that of constant acceleration.
pub fn equal_on_acceleration(s: &Specification, runs: &CoordinateEvidence) -> JudgedClaim {
    let mut evidence = String::from("Scenario 1, position error less that of CA, as a part of the latter.");
    let mut tally = Tally::default();
    for (name, filter) in [
        ("IMM", IMM),
        ("Fixed gain", FIXED_GAIN),
        ("Its other reading", OTHER_READING),
    ] {
        let all = relative(&runs.acceleration, [filter, CA], ErrorQuantity::Position, any);
        let is_equal = |one: &&Relative| within(std::slice::from_ref(*one), 0.01).holds == 1;
        let equal: Vec<&str> = all.iter().filter(is_equal).map(|one| one.choices.as_str()).collect();
        let _ = write!(
            evidence,
            " {name}: {}; within a hundredth at: {}.",
            extremes(&all),
            equal.join("; ")
        );
        tally = tally.and(within(&all, 0.01));
    }
    s.judgement("derbez2000-equal-on-acceleration", tally.verdict(), evidence)
        .over(tally)
}

/// The y-error of the fixed-gain filter beside that of constant acceleration.
pub fn thirty_per_cent(s: &Specification, runs: &CoordinateEvidence) -> JudgedClaim {
    let [_, y] = published(s);
    // The printed figures are rounded in the third decimal.
    let greatest = 1.0 - (y[FIXED_GAIN] - 0.0005) / (y[CA] + 0.0005);
    let all = relative(&runs.manoeuvres, [FIXED_GAIN, CA], ErrorQuantity::Y, any);
    let tally = below(&all, -0.3);
    let evidence = format!(
        "Table 1 itself: 1 − {}/{} is {:.1} %, and at most {:.1} % before rounding; the overall error is smaller by {:.1} %. Scenario 2, \
         y-error of the fixed gain less that of CA, as a part of the latter: {}.",
        y[FIXED_GAIN],
        y[CA],
        100.0 * (1.0 - y[FIXED_GAIN] / y[CA]),
        100.0 * greatest,
        100.0 * overall_gain(s),
        extremes(&all),
    );
    // The claim refers to its table, which does not have it.
    let verdict = if greatest < 0.3 {
        Verdict::Refuted
    } else {
        tally.verdict()
    };
    s.judgement("derbez2000-thirty-per-cent", verdict, evidence).over(tally)
}

/// The part by which the printed overall error of the fixed gain is smaller than that of CA.
fn overall_gain(s: &Specification) -> f64 {
    let row = s.tables[0].rows.iter().find(|row| row.name == "Overall");
    row.map_or(f64::NAN, |row| 1.0 - row.values[FIXED_GAIN] / row.values[CA])
}

/// The full filter in the turn.
pub fn full_imm_much_better(s: &Specification, runs: &CoordinateEvidence) -> JudgedClaim {
    let [x, y] = published(s);
    let mut evidence = format!(
        "Table 1 has IMM at {} and {}, fixed gain at {} and {}, in x and y. Scenario 2 in the turn, position error of IMM less the other's, \
         as a part of the latter:",
        x[IMM], y[IMM], x[FIXED_GAIN], y[FIXED_GAIN]
    );
    let mut tally = Tally::default();
    for (name, other) in [("fixed gain", FIXED_GAIN), ("CA", CA)] {
        let all = relative(&runs.manoeuvres, [IMM, other], ErrorQuantity::Position, in_turn);
        let _ = write!(evidence, " {name}: {}.", extremes(&all));
        // Much better: by more than a tenth.
        tally = tally.and(below(&all, -0.1));
    }
    evidence.push_str(" Much better is by a tenth.");
    s.judgement("derbez2000-full-imm-much-better", tally.verdict(), evidence)
        .over(tally)
}

/// Scenario 3, whose data were not published.
pub fn third_set_supports(s: &Specification, runs: &CoordinateEvidence) -> JudgedClaim {
    let of_table = |name: &str| {
        let row = s.tables[1].rows.iter().find(|row| row.name == name);
        row.map_or(f64::NAN, |row| {
            let (low, high) = (
                row.values.iter().copied().fold(f64::MAX, f64::min),
                row.values.iter().copied().fold(0.0, f64::max),
            );
            high / low - 1.0
        })
    };
    let comparison = runs.manoeuvres[0].comparison();
    let error = comparison.error(IMM, ErrorQuantity::Position);
    let of_one_run = error.standard_error * (runs.manoeuvres[0].runs.len() as f64).sqrt() / error.value;
    let evidence = format!(
        "Scenario 3 filters measurements of another paper, which were not published. In table 2 the filters differ by {:.3} % in x, {:.3} % in y \
         and {:.3} % overall, in one run; the error of a single run of scenario 2 scatters by {:.1} %. Differences of this size in one run \
         support nothing.",
        100.0 * of_table("x-RMS"),
        100.0 * of_table("y-RMS"),
        100.0 * of_table("Overall"),
        100.0 * of_one_run,
    );
    s.judgement("derbez2000-third-set-supports", Verdict::NeverPublished, evidence)
}
