//! The claims of derbez2000 on the long-term error and on the cost.
//!
//! They compare the algorithm's predictions with a simulation, under each form of its steps, and count the operations of the filters'
//! equations.

use super::{ACCELERATION, INTERVAL};
use crate::model::acceleration::{acceleration_response, embedded_constant_velocity, position_matrix};
use crate::number::RationalFunction;
use crate::paper::Effort;
use crate::paper::monte_carlo::Generator;
use crate::paper::operations::{CovarianceUpdate, OneCoordinate, Sums};
use crate::paper::specification::Specification;
use crate::paper::verdict::{JudgedClaim, Verdict, proven_by, refuted_by};
use crate::statistics::estimate::figure;
use crate::steady::gains;
use crate::steady::long_term::Form as Steps;
use crate::steady::mismatch::{Mismatch, alpha_beta_lag, alpha_beta_scatter};
use crate::steady::simulated::{Grid, POINTS, Start};
use std::fmt::Write;

/// Half the load of the CA Kalman filter.
pub fn half_the_load(s: &Specification) -> JudgedClaim {
    let mut evidence =
        String::from("Operations of one cycle, both coordinates, by the formula of the equations, every matrix full:");
    let mut ratios = Vec::new();
    for (sums, words) in Sums::ALL
        .into_iter()
        .zip(["every sum from nothing (MATLAB 5)", "sums from their first term"])
    {
        let of = |filter: OneCoordinate| CovarianceUpdate::ALL.map(|update| filter.operations(update, sums));
        let [fixed, single, imm] = OneCoordinate::ALL.map(of);
        let _ = write!(
            evidence,
            " {words}: fixed gain {}, CA {} to {}, IMM {} to {};",
            fixed[0], single[0], single[1], imm[0], imm[1],
        );
        ratios.extend(single.map(|single| fixed[0] as f64 / single as f64));
    }
    let [least, greatest] = [
        ratios.iter().copied().fold(f64::INFINITY, f64::min),
        ratios.iter().copied().fold(0.0, f64::max),
    ];
    let _ = write!(
        evidence,
        " printed: 242, 590, and 1332, 1322 or 1326. 242 and the three of the IMM filter lie between the cheapest and the dearest of these; 590 is more than \
         any, so that something was computed twice. Fixed gain over CA is {} to {}, printed {}: half where the update is the printed one, more with \
         P⁻ − K S Kᵀ.",
        figure(least),
        figure(greatest),
        figure(242.0 / 590.0),
    );
    // "Half": to within a tenth under every convention.
    let verdict = if greatest <= 0.6 {
        Verdict::Proven
    } else if least > 0.6 {
        Verdict::Refuted
    } else {
        Verdict::DependsOnChoice
    };
    s.judgement("derbez2000-half-the-load", verdict, evidence)
}

/// The proposition and (7).
pub fn proposition(s: &Specification) -> JudgedClaim {
    let [root, t, a, r] = ["theta", "t", "a", "R"].map(RationalFunction::unknown);
    let gain = gains::alpha_beta_gain(&root, &t);
    let missed = acceleration_response(&t) * a.clone();
    let mismatch = Mismatch::new(
        &embedded_constant_velocity(&t),
        &position_matrix(),
        gain.clone(),
        &missed,
        r.clone(),
    );
    let lag = alpha_beta_lag(&gain, &a, &t);
    let error = &lag * lag.transpose() + alpha_beta_scatter(&gain, &r, &t);
    let holds = mismatch.right_side(&error) == error;
    let example = |q: f64| {
        let gain = gains::alpha_beta_gain(
            &gains::alpha_beta_root(&gains::tracking_index(&q, &0.05, &INTERVAL)),
            &INTERVAL,
        );
        let error = alpha_beta_lag(&gain, &ACCELERATION, &INTERVAL);
        figure(error[0])
    };
    let evidence = format!(
        "Symbolic in the damping root, t, a and R: the second moment of the steady error, lag and scatter together, satisfies (7) as printed. So it is an \
         equality, for the whole matrix, and more than the bound of a trace that the paper states. The lag of the position at t = 2 s, a = 5 m/s², \
         R = 0.05 m² is {} m for q = 5 and {} m for q = 40. The hypothesis is not enough: (F, G) stabilisable must be (F, GQ^½) without a mode on the \
         unit circle that no noise reaches, and (H, F) detectable; with Q = 0 the gain falls to zero and nothing settles, so that one must, not may, use \
         a non-zero Q.",
        example(5.0),
        example(40.0),
    );
    s.judgement("derbez2000-proposition", proven_by(holds), evidence)
}

/// The accuracy of steps 0 to 6, figures 1 and 2.
pub fn algorithm_accuracy(s: &Specification, effort: Effort) -> JudgedClaim {
    let noise = |point: usize| {
        let mut generator = Generator::new(effort.seed, point as u64);
        move || generator.standard_normal()
    };
    let mut evidence = format!(
        "Median size of (predicted − simulated)/simulated over the grids, simulations of {POINTS} points that start at the truth unless the manoeuvre is said to \
         begin with the run:"
    );
    let mut printed_is_off = true;
    for interval in [1.0, 2.0] {
        for (name, grid) in [
            ("figure 1", Grid::figure_1(interval)),
            ("figure 2", Grid::figure_2(interval)),
        ] {
            let median = |form, start| grid.percentages(form, start, noise).map_or(f64::NAN, median_size);
            let printed = median(Steps::Printed, Start::AtTheTruth);
            printed_is_off &= printed > 100.0;
            let _ = write!(
                evidence,
                " {name}, t = {interval}: as printed {} %, with the weights of (1) in step 3 {} %, corrected {} %, corrected and with the manoeuvre {} %;",
                figure(printed),
                figure(median(Steps::Reindexed, Start::AtTheTruth)),
                figure(median(Steps::Corrected, Start::AtTheTruth)),
                figure(median(Steps::Corrected, Start::BeforeTheManoeuvre)),
            );
        }
    }
    evidence.push_str(
        " as printed the weights of step 3 add the whole error of constant velocity to a filter that is certain of constant acceleration, and the steps \
         run away. Where q_v > q_a and the manoeuvre begins with the run the filter may lock into constant velocity for ever, and no form predicts it. The \
         percentages of the paper's figures are not in its text.",
    );
    s.judgement("derbez2000-algorithm-accuracy", refuted_by(printed_is_off), evidence)
}

fn median_size(percentages: Vec<f64>) -> f64 {
    let mut sizes: Vec<f64> = percentages.into_iter().map(f64::abs).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.get(sizes.len() / 2).copied().unwrap_or(f64::NAN)
}
