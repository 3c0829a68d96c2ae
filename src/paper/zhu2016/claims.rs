//! The claims of zhu2016, each with its judge.
//!
//! The claims are in `spec/zhu2016/claims.toml`, in the same order. Every judge computes its evidence and is called once in [`judge`]. The
//! judges that need no runs are in [`arithmetic`].

use super::{arithmetic, quantity_of_row, scenario};
use crate::filter::Filter;
use crate::model::motion::coordinated_turn;
use crate::number::Rational;
use crate::paper::Effort;
use crate::paper::comparison::{Comparison, ErrorQuantity};
use crate::paper::experiment::Experiment;
use crate::paper::monte_carlo::{Progress, run};
use crate::paper::scenario::{Contestant, Course, Scenario};
use crate::paper::specification::{Choices, InvalidChoice, Specification, zhu2016 as specification};
use crate::paper::verdict::{DECISIVE, JudgedClaim, Verdict, all_below_zero, confirmed_if, in_words, proven_if};
use crate::rule::sphere::{on_axes, on_axes_and_diagonals};
use crate::rule::unscented::Parameters;
use crate::rule::{Rule, RuleName, fifth_degree, third_degree, unscented};
use crate::statistics::estimate::figure;
use crate::steady::gains;
use crate::steady::mismatch::alpha_beta_lag;
use nalgebra::{U4, Vector4};
use std::fmt::Write;

/// The positions of the contestants in the scenario; the last is the Kalman filter that the judges add.
const IMM5CKF: usize = 0;
const IMMCKF: usize = 1;
const IMMUKF: usize = 2;
const SINGLE: usize = 3;
const STAND_IN: usize = 4;
const KALMAN: usize = 5;

/// The three filters that differ in their rule only.
const RULES: [usize; 3] = [IMM5CKF, IMMCKF, IMMUKF];

/// The components of the state, as the paper's table has them.
const COMPONENTS: [ErrorQuantity; 4] = [
    ErrorQuantity::X,
    ErrorQuantity::VelocityX,
    ErrorQuantity::Y,
    ErrorQuantity::VelocityY,
];

/// Two filters agree when no estimate differs by more than a millionth of the least standard deviation in the problem, √0.1 m. In a
/// hundred steps at positions of 10⁴ m rounding leaves far less; a difference of the filters would be far more.
const AGREEMENT: f64 = 0.3e-6;

/// Judges every claim.
///
/// # Errors
///
/// [`InvalidChoice`] when the specification lacks an alternative that a judge asks for.
pub fn judge(effort: Effort, progress: Progress) -> Result<Vec<JudgedClaim>, InvalidChoice> {
    let experiment = |parameter: &str, alternative: &str| {
        let scenario = scenario(&Choices::of(parameter, alternative))?;
        Ok(Experiment::new(scenario, effort, progress))
    };
    let printed = Experiment::new(with_kalman_filter()?, effort, progress);
    let single_models = [
        experiment("single-model", "constant-velocity")?,
        experiment("single-model", "coordinated-turn")?,
        experiment("single-model", "left-turn")?,
        experiment("single-model", "constant-velocity-ten-times-noise")?,
    ];
    let range_bearing = [
        experiment("measurement", "range-bearing")?,
        experiment("measurement", "range-bearing-coarse")?,
    ];
    let s = specification();
    Ok(vec![
        linear_accuracy(s, &printed),
        better_than_single_model(s, &single_models),
        better_than_omtm(s, &printed),
        arithmetic::all_rmse_smaller(s),
        captures_switches(s, &printed),
        switching_sensitivity(s, &printed),
        imm_beats_single_model(s, &single_models),
        arithmetic::three_dimensions_equal(s),
        negative_weights_diverge(s, &printed),
        arithmetic::negative_weights_vanish(s),
        arithmetic::equal_weights(s),
        no_divergence(s, &printed),
        single_model_worst(s, &single_models),
        arithmetic::load(s),
        nonlinear_filters_better_than_omtm(s, &printed),
        columns_differ(s, &printed),
        columns_differ_range_bearing(s, &range_bearing),
        table_1_reachable(s, &printed),
        printed_weight(s, &printed),
        arithmetic::better_than_ckf(s),
    ])
}

/// The printed scenario, and after its contestants a Kalman filter with the same modes.
///
/// # Errors
///
/// [`InvalidChoice`] never: nothing is chosen.
pub fn with_kalman_filter() -> Result<Scenario, InvalidChoice> {
    let mut printed = scenario(&Choices::default())?;
    let kalman = kalman(&printed.contestants[IMM5CKF]);
    printed.contestants.push(kalman);
    Ok(printed)
}

/// The same modes with Kalman filters.
fn kalman(contestant: &Contestant) -> Contestant {
    let mut kalman = contestant.clone();
    "IMM-Kalman".clone_into(&mut kalman.name);
    kalman.problem.filters = vec![Filter::kalman()];
    kalman.points = None;
    kalman
}

/// The greatest difference of any estimate of two filters, in any component.
fn greatest_difference(comparison: &Comparison, a: usize, b: usize) -> f64 {
    comparison.greatest_estimate_difference(a, b).max()
}

/// The greatest difference of the three rules from the Kalman filter, in estimates and in probabilities.
fn distance_from_kalman(comparison: &Comparison) -> (f64, f64) {
    let estimates = RULES.map(|rule| greatest_difference(comparison, rule, KALMAN));
    let probabilities = RULES.map(|rule| comparison.greatest_probability_difference(rule, KALMAN));
    let greatest = |values: [f64; 3]| values.into_iter().fold(0.0, f64::max);
    (greatest(estimates), greatest(probabilities))
}

/// The three filters with points beside the Kalman filter.
pub fn linear_accuracy(s: &Specification, printed: &Experiment) -> JudgedClaim {
    let (estimates, probabilities) = distance_from_kalman(&printed.comparison());
    let evidence = format!(
        "Over all steps of {} runs no estimate of the three differs from the Kalman filter in the same cycle by more than {} (m, m/s) \
         and no mode probability by more than {}. That is rounding: with linear models every rule that is exact to degree two is the \
         Kalman filter.",
        printed.runs.len(),
        figure(estimates),
        figure(probabilities),
    );
    let verdict = confirmed_if(estimates > AGREEMENT);
    s.judgement("zhu2016-linear-accuracy", verdict, evidence)
}

/// The first filter beside the one of a single model, whichever that is.
pub fn better_than_single_model(s: &Specification, experiments: &[Experiment; 4]) -> JudgedClaim {
    let mut differences = Vec::new();
    let mut evidence = String::from("IMM5CKF minus single 5CKF, error of position:");
    for experiment in experiments {
        let comparison = experiment.comparison();
        let of = |quantity| comparison.difference(IMM5CKF, SINGLE, quantity);
        differences.extend(COMPONENTS.map(of));
        let words = in_words(of(ErrorQuantity::Position), "m");
        let _ = write!(evidence, " {} {words};", experiment.scenario.choices.describe());
    }
    let verdict = all_below_zero(&differences);
    let _ = write!(
        evidence,
        " all four components of the state: {}.",
        match verdict {
            Verdict::Confirmed => "certainly smaller each time",
            Verdict::Refuted => "larger at least once",
            _ => "not all decided",
        }
    );
    s.judgement("zhu2016-better-than-single-model", verdict, evidence)
}

/// The first filter beside a stand-in for one that the paper does not print.
pub fn better_than_omtm(s: &Specification, printed: &Experiment) -> JudgedClaim {
    let difference = printed
        .comparison()
        .difference(IMM5CKF, STAND_IN, ErrorQuantity::Position);
    let evidence = format!(
        "The paper gives no equation of OMTM-IMM and neither does what could be obtained of its source. Against the stand-in of this \
         crate, which decides nothing about it, the position error of IMM5CKF minus its own is {}.",
        in_words(difference, "m"),
    );
    s.judgement("zhu2016-better-than-omtm", Verdict::NeverPublished, evidence)
}

/// How late the first filter notices a change of motion.
pub fn captures_switches(s: &Specification, printed: &Experiment) -> JudgedClaim {
    let comparison = printed.comparison();
    let delays = comparison.delays(IMM5CKF);
    let missed: usize = delays.iter().flatten().filter(|delay| delay.is_none()).count();
    let summaries: Vec<String> = delays.iter().map(|of_runs| delay_summary(of_runs)).collect();
    let evidence = format!(
        "Delay until the true mode is more likely than not, at the four switches: {}; never noticed: {missed}.",
        summaries.join(", "),
    );
    // In time: within three seconds, less than a sixth of the shortest motion.
    let late = delays.iter().flatten().any(|delay| delay.is_none_or(|delay| delay > 3));
    s.judgement("zhu2016-captures-switches", confirmed_if(!late), evidence)
}

/// Mean and greatest delay in words.
fn delay_summary(delays: &[Option<usize>]) -> String {
    let detected: Vec<usize> = delays.iter().flatten().copied().collect();
    let mean = detected.iter().sum::<usize>() as f64 / detected.len() as f64;
    let greatest = detected.iter().max().copied().unwrap_or(0);
    format!("{mean:.2} s (at most {greatest} s)")
}

/// Mode probabilities and delays of the three filters beside each other.
pub fn switching_sensitivity(s: &Specification, printed: &Experiment) -> JudgedClaim {
    let comparison = printed.comparison();
    let probabilities = [IMMCKF, IMMUKF].map(|other| comparison.greatest_probability_difference(IMM5CKF, other));
    let same_delays = [IMMCKF, IMMUKF]
        .iter()
        .all(|&other| comparison.delays(IMM5CKF) == comparison.delays(other));
    let evidence = format!(
        "The mode probabilities of IMM5CKF differ from those of IMMCKF by at most {} and from those of IMMUKF by at most {}, over all \
         steps of all runs; the delays at the four switches are {}.",
        figure(probabilities[0]),
        figure(probabilities[1]),
        if same_delays {
            "the same in every run"
        } else {
            "not the same in every run"
        },
    );
    s.judgement("zhu2016-switching-sensitivity", confirmed_if(!same_delays), evidence)
}

/// The first filter beside those of one model, in turns and on straight parts.
pub fn imm_beats_single_model(s: &Specification, experiments: &[Experiment; 4]) -> JudgedClaim {
    let mut evidence = String::from("IMM5CKF minus the single filter, error of position:");
    let mut differences = Vec::new();
    // The three models of the filter, with the noise that it gives them.
    for experiment in &experiments[..3] {
        let comparison = experiment.comparison();
        let schedule = &experiment.scenario.schedule;
        let straight = |k: usize| schedule[k] == Course::Straight;
        let turning = |k: usize| schedule[k] != Course::Straight;
        let over = |chosen: &dyn Fn(usize) -> bool| {
            comparison.difference_over(IMM5CKF, SINGLE, ErrorQuantity::Position, chosen)
        };
        let (in_turns, on_straights) = (over(&turning), over(&straight));
        let _ = write!(
            evidence,
            " {}: in turns {}, on straight parts {};",
            experiment.scenario.choices.describe(),
            in_words(in_turns, "m"),
            in_words(on_straights, "m"),
        );
        differences.extend([in_turns, on_straights]);
    }
    let verdict = all_below_zero(&differences);
    let _ = evidence.pop();
    evidence.push('.');
    s.judgement("zhu2016-imm-beats-single-model", verdict, evidence)
}

/// Negative weights, and what they do in the scenario.
pub fn negative_weights_diverge(s: &Specification, printed: &Experiment) -> JudgedClaim {
    let negative: Vec<String> = (4..=8)
        .filter_map(|n| unscented::unscented(n, &Parameters::for_gaussian(n)).ok())
        .map(|rule| {
            let negative = rule.weights.iter().filter(|w| **w < Rational::new(0, 1)).count();
            format!("{negative} of {} ({})", rule.weights.len(), rule.weights[0])
        })
        .collect();
    let comparison = printed.comparison();
    let difference = greatest_difference(&comparison, IMMUKF, KALMAN);
    let (nees, _) = comparison.consistency(IMMUKF);
    let evidence = format!(
        "Exact: for n = 4 to 8 only the centre's weight is negative: {}. In the paper's scenario (n = 4) IMMUKF equals the Kalman filter \
         to {} (m, m/s), with a mean NEES of {} where 4 is expected: nothing diverges. A negative weight can make a covariance indefinite \
         for a nonlinear function; it cannot for a linear one.",
        negative.join(", "),
        figure(difference),
        figure(nees.value),
    );
    s.judgement(
        "zhu2016-negative-weights-diverge",
        confirmed_if(difference > AGREEMENT),
        evidence,
    )
}

/// Whether any run fails or goes far off.
pub fn no_divergence(s: &Specification, printed: &Experiment) -> JudgedClaim {
    // Diverged: further away than ten times the deviation with which a run starts, √1000 m.
    let (bounded, evidence) = printed.stays_within(10.0 * 1000_f64.sqrt());
    s.judgement("zhu2016-no-divergence", confirmed_if(bounded), evidence)
}

/// The filter of one model beside all others.
pub fn single_model_worst(s: &Specification, experiments: &[Experiment; 4]) -> JudgedClaim {
    let mut differences = Vec::new();
    let mut evidence = String::from("Single 5CKF minus the worst of the others, error of position:");
    for experiment in experiments {
        let comparison = experiment.comparison();
        let others = [IMM5CKF, IMMCKF, IMMUKF, STAND_IN]
            .map(|other| comparison.difference(other, SINGLE, ErrorQuantity::Position));
        let nearest = others
            .into_iter()
            .max_by(|a, b| a.value.total_cmp(&b.value))
            .unwrap_or(others[0]);
        differences.extend(others);
        let _ = write!(
            evidence,
            " {}: {} m larger, ± {};",
            experiment.scenario.choices.describe(),
            figure(-nearest.value),
            figure(nearest.standard_error),
        );
    }
    evidence.push_str(" in the published table 5CKF is the worst in every row.");
    s.judgement("zhu2016-single-model-worst", all_below_zero(&differences), evidence)
}

/// Whether the three filters are anything but Kalman filters here.
pub fn nonlinear_filters_better_than_omtm(s: &Specification, printed: &Experiment) -> JudgedClaim {
    let (estimates, _) = distance_from_kalman(&printed.comparison());
    let evidence = format!(
        "On the printed, linear scenario each of the three equals the Kalman filter in the same cycle, to {} (m, m/s): whatever sets them \
         apart from OMTM-IMM, it is not that they are nonlinear.",
        figure(estimates),
    );
    let verdict = confirmed_if(estimates > AGREEMENT);
    s.judgement("zhu2016-nonlinear-filters-better-than-omtm", verdict, evidence)
}

/// What the published columns differ by, beside what chance does.
pub fn columns_differ(s: &Specification, printed: &Experiment) -> JudgedClaim {
    // The premise, for n unknown: a rule of degree two or more is the Kalman filter on affine models.
    let n = crate::rule::sphere::every_dimension();
    let of = |value: i64| <crate::number::RationalFunction as crate::number::Field>::integer(value);
    let third = on_axes(&n, of(0), &third_degree::axis_weight(&n), n.clone());
    let lambda = of(3) - n.clone();
    let centre = unscented::centre_weight(&n, &lambda);
    let unscented = on_axes(&n, centre, &unscented::axis_weight(&n, &lambda), of(3));
    let fifth = on_axes_and_diagonals(&n, &fifth_degree::diagonal_weight(&n));
    let degrees = [third.degree(), unscented.degree(), fifth.degree()];
    let premise = degrees.iter().all(|degree| degree.is_some_and(|degree| degree >= 2));

    let comparison = printed.comparison();
    let mut evidence = format!(
        "Symbolic, for every n ≥ 2: the three rules have the degrees {}, and a rule of degree two or more is the Kalman filter on \
         linear models, so the columns must be equal. One and the same filter, run twice without pairing, differs \
         from itself by a standard deviation of",
        degrees
            .map(|degree| degree.map_or("none".to_owned(), |d| d.to_string()))
            .join(", "),
    );
    let mut beyond_chance = 0;
    for quantity in COMPONENTS {
        let spread = comparison.error(IMM5CKF, quantity).standard_error * 2_f64.sqrt();
        let published: Vec<f64> = s.tables[0]
            .rows
            .iter()
            .filter(|row| quantity_of_row(&row.name) == Some(quantity))
            .flat_map(|row| row.values[..3].to_vec())
            .collect();
        let range =
            published.iter().copied().fold(f64::MIN, f64::max) - published.iter().copied().fold(f64::MAX, f64::min);
        beyond_chance += usize::from(range > DECISIVE * spread);
        let _ = write!(
            evidence,
            " {} in {}, where the published columns range over {};",
            figure(spread),
            quantity.label(),
            figure(range)
        );
    }
    let _ = write!(
        evidence,
        " in {beyond_chance} of the 4 rows that is more than {DECISIVE} standard deviations: not the filters, and not the sampling of the \
         runs either."
    );
    s.judgement("zhu2016-columns-differ", proven_if(!premise), evidence)
}

/// The same where range and bearing are measured.
pub fn columns_differ_range_bearing(s: &Specification, experiments: &[Experiment; 2]) -> JudgedClaim {
    let mut evidence = String::from("IMM5CKF over IMMCKF, error of position:");
    let mut greatest: f64 = 0.0;
    for experiment in experiments {
        let comparison = experiment.comparison();
        let difference = comparison.difference(IMM5CKF, IMMCKF, ErrorQuantity::Position);
        let relative = difference.value / comparison.error(IMMCKF, ErrorQuantity::Position).value;
        greatest = greatest.max(relative.abs());
        let _ = write!(
            evidence,
            " {}: {}, {} of it;",
            experiment.scenario.choices.describe(),
            in_words(difference, "m"),
            figure(relative),
        );
    }
    let published = &s.tables[0].rows;
    let published_relative: Vec<String> = published
        .iter()
        .filter(|row| quantity_of_row(&row.name).is_some())
        .map(|row| format!("{:+.0} %", 100.0 * (row.values[0] / row.values[1] - 1.0)))
        .collect();
    let _ = write!(
        evidence,
        " published: {} in the four rows.",
        published_relative.join(", ")
    );
    // "By as much as table 1 says": at least a tenth of the smallest published ratio's distance from one, 7 %.
    let verdict = confirmed_if(greatest > 0.007);
    s.judgement("zhu2016-columns-differ-range-bearing", verdict, evidence)
}

/// The published errors beside what the printed noise can give.
pub fn table_1_reachable(s: &Specification, printed: &Experiment) -> JudgedClaim {
    let bound = |variance: f64| steady_bound(variance, super::ACCELERATION_VARIANCE);
    let [in_x, in_y] = super::MEASUREMENT_VARIANCES.map(bound);
    let comparison = printed.comparison();
    let row = |name: &str| {
        s.tables[0]
            .rows
            .iter()
            .find(|row| row.name == name)
            .map_or(&[][..], |row| &row.values)
    };
    let (x, y) = (row("RMSE_X"), row("RMSE_Y"));
    let computed = |quantity| {
        let errors = [IMM5CKF, SINGLE].map(|c| figure(comparison.error(c, quantity).value));
        errors.join(" and ")
    };
    let evidence = format!(
        "With variances of 20 and 0.1 m² even a single constant-velocity filter that is always in a turn has, after its transient, an error \
         of at most {} m in x and {} m in y; computed for IMM5CKF and 5CKF are {} m and {} m, published {} and {} m, and {} and {} m. Every \
         figure of the row RMSE_Y, and 5CKF in x, is out of reach of the printed noise.",
        figure(in_x),
        figure(in_y),
        computed(ErrorQuantity::X),
        computed(ErrorQuantity::Y),
        x.first().copied().unwrap_or(f64::NAN),
        x.get(3).copied().unwrap_or(f64::NAN),
        y.first().copied().unwrap_or(f64::NAN),
        y.get(3).copied().unwrap_or(f64::NAN),
    );
    let reachable = y.iter().all(|published| *published <= in_y);
    s.judgement("zhu2016-table-1-reachable", proven_if(reachable), evidence)
}

/// The greatest steady error of the single constant-velocity filter: the root of the measurement variance and of the squared lag under
/// the centripetal acceleration of a turn, a = |v| ω.
///
/// With the closed-form gains α, β of a piecewise constant acceleration the lag is (1 − α) a T² / β.
fn steady_bound(variance: f64, acceleration_variance: f64) -> f64 {
    let interval = super::INTERVAL;
    let index = gains::tracking_index(&acceleration_variance, &variance, &interval);
    let gain = gains::alpha_beta_gain(&gains::alpha_beta_root(&index), &interval);
    let [_, vx, _, vy] = super::INITIAL_STATE;
    let acceleration = (vx * vx + vy * vy).sqrt() * super::TURN_RATE;
    let lag = alpha_beta_lag(&gain, &acceleration, &interval)[0];
    (variance + lag * lag).sqrt()
}

/// A run with the weight as printed.
pub fn printed_weight(s: &Specification, printed: &Experiment) -> JudgedClaim {
    let n: Rational = Rational::new(4, 1);
    let sum = RuleName::FifthDegreePrinted
        .exact(4)
        .map_or(Rational::new(0, 1), |rule| rule.sum_of_weights());
    let fifth = &printed.scenario.contestants[IMM5CKF];
    let mut contestant = fifth.clone();
    let rule: Result<Rule<f64, U4>, _> = RuleName::FifthDegreePrinted.rule();
    contestant.problem.filters = rule.into_iter().map(Filter::points).collect();
    let alone = Scenario {
        contestants: vec![contestant],
        ..printed.scenario.clone()
    };
    let runs = run(&alone, 1, 1, &|| ());
    let first = runs[0][0].errors.first().copied().unwrap_or(Vector4::zeros());
    let last = runs[0][0].failure.as_ref().map_or_else(
        || {
            format!(
                "after 100 steps by {} m",
                figure(ErrorQuantity::Position.squared(&runs[0][0].errors[99]).sqrt())
            )
        },
        |failure| format!("and then fails: {failure}"),
    );
    let prediction = coordinated_turn(&0.0, &super::INTERVAL) * printed.scenario.initial_state;
    let evidence = format!(
        "Exact: with w₂ as printed the weights sum to {sum} at n = {n} and the predicted position of the first step is {} m for {} m. The \
         filter that uses it is off by {} m after the first measurement, {last}. The printed figures do not come from it.",
        figure(prediction[0] * sum.to_f64()),
        figure(prediction[0]),
        figure(ErrorQuantity::Position.squared(&first).sqrt()),
    );
    s.judgement(
        "zhu2016-printed-weight",
        proven_if(sum == Rational::new(1, 1)),
        evidence,
    )
}
