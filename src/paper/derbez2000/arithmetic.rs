//! The claims of derbez2000 that arithmetic decides, on the published figures and exactly.
//!
//! These statements need no runs: they contradict the paper's own tables, or the equations decide them for all inputs at once.

use super::{OPERATIONS_OF_SECTION_4, OPERATIONS_OF_SECTION_4_1};
use crate::imm::probability::{mixing_probability, predicted_mode_probability};
use crate::model::acceleration::{acceleration_part, embedded_constant_velocity, position_matrix};
use crate::number::{Field, Rational, RationalFunction};
use crate::paper::specification::{PublishedTable, Specification};
use crate::paper::verdict::{JudgedClaim, Verdict, proven_by, proven_if};
use crate::statistics::estimate::figure;
use crate::steady::gains;
use crate::steady::mismatch::alpha_beta_lag;
use nalgebra::{Matrix3, SMatrix, Vector3};
use num_traits::Zero;
use std::fmt::Write;

/// The steady mean error, for every gain at once.
///
/// ```text
/// e' = A₊ e + b₊,   A₊ = (I − K₊H)F,   b₊ = (I − K₊H) ΔF x,   m = a [t²(1 − α)/β, t(2α − β)/(2β), 1]ᵀ
/// ```
///
/// Evidence: `without_noise_in_the_gain_calculation_the_mismatched_error_is_not_bounded`.
pub fn constant_bounded_error(s: &Specification) -> JudgedClaim {
    let [root, interval, acceleration] = ["root", "t", "a"].map(RationalFunction::unknown);
    // Jury's conditions for a second-order filter are 0 < α, 0 < β and β < 4 − 2α; the last leaves 4θ.
    let gain = gains::alpha_beta_gain(&root, &interval);
    let mean = alpha_beta_lag(&gain, &acceleration, &interval);
    let (alpha, beta) = (gain[0].clone(), gain[1].clone() * interval.clone());
    let [two, four] = [2, 4].map(RationalFunction::integer);
    let is_stable = four.clone() - two * alpha - beta == four * root.clone();
    let is_settled = is_stable && next_error(&mean, &root, &interval, &acceleration) == mean;
    // The scan time and accelerations of the paper, and the damping roots of its least and greatest noises.
    let mut evidence = String::from(
        "Symbolic, for every gain, scan time and acceleration: the error's mean settles at m = a[t²(1−α)/β, t(2α−β)/(2β), 1] and nowhere \
         else, since (I − KH)F is stable (4 − 2α − β = 4θ > 0). With t = 2 s and a = 5 m/s²:",
    );
    for (noise, measurement) in [(5.0, 0.05), (5.0, 0.5), (40.0, 0.05), (2.0, 0.05)] {
        let index: f64 = gains::tracking_index(&noise, &measurement, &2.0);
        let gain = gains::alpha_beta_gain(&gains::alpha_beta_root(&index), &2.0);
        let mean = alpha_beta_lag(&gain, &5.0, &2.0);
        let _ = write!(
            evidence,
            " q = {noise}, R = {measurement}: {} m, {} m/s;",
            figure(mean[0]),
            figure(mean[1])
        );
    }
    evidence.push_str(
        " the acceleration is off by all of a. The mean is constant, the error is not: it varies about the mean as in (7). It is bounded \
         as long as the noise in the gain calculation is not zero.",
    );
    s.judgement("derbez2000-constant-bounded-error", proven_by(is_settled), evidence)
}

/// The mean error after one more step, from one before it: the target's acceleration is a, the filter's is zero.
fn next_error<T: Field>(error: &Vector3<T>, root: &T, interval: &T, acceleration: &T) -> Vector3<T> {
    let gain: SMatrix<T, 3, 1> = gains::alpha_beta_gain(root, interval);
    let rest = Matrix3::identity() - gain * position_matrix();
    let accelerated = Vector3::new(T::zero(), T::zero(), acceleration.clone());
    let moved = embedded_constant_velocity(interval) * error + acceleration_part(interval) * accelerated;
    rest * moved
}

/// Probabilities of model 1 at which the bounds of section 3.1 are looked at, in hundredths.
const PROBABILITIES: [i64; 7] = [1, 5, 20, 50, 80, 95, 99];

/// μ^{i|j} for p = 0.95 on the diagonal and the probability of model 1 in hundredths.
fn mixing(of_first: i64, previous: usize, current: usize) -> Rational {
    let transition = [[19, 1], [1, 19]].map(|row| row.map(|entry| Rational::new(entry, 20)).to_vec());
    let probabilities = [Rational::new(of_first, 100), Rational::new(100 - of_first, 100)];
    let predicted = predicted_mode_probability(&transition, &probabilities, current);
    mixing_probability(&transition, &probabilities, &predicted, previous, current)
}

/// The spread of the means of two models, one of which is right and the other off by one, beside its printed bound.
pub fn moment_matching_bound(s: &Specification) -> JudgedClaim {
    let mut evidence = String::from(
        "One coordinate, p = 0.95, model 1 off by 1 and model 2 right, so that P^{e,1} = 1 and P^{e,2} = 0. Exact spread of the mixed \
         estimate of model 2, μ^{1|2} μ^{2|2}, and its printed bound Σᵢ μ^{i|2} Σ_{l≠i} (μ^{i|l})² P^{e,l}; the same with μ^{l|i}, by μ₁:",
    );
    let mut holds = true;
    for of_first in PROBABILITIES {
        let [first, second] = [0, 1].map(|i| mixing(of_first, i, 1));
        let spread = first.clone() * second.clone();
        let bounds = [mixing(of_first, 1, 0).pow(2), first.pow(2)].map(|square| second.clone() * square);
        holds &= bounds.iter().any(|bound| spread <= *bound);
        let _ = write!(
            evidence,
            " {}: {}, {}, {};",
            Rational::new(of_first, 100).to_f64(),
            figure(spread.to_f64()),
            figure(bounds[0].to_f64()),
            figure(bounds[1].to_f64()),
        );
    }
    let even = mixing(50, 0, 1) / mixing(50, 1, 0).pow(2);
    let _ = write!(
        evidence,
        " for even odds, where the chain is as symmetric as can be, the spread is {} times the bound. What holds is μ^{{1|2}} μ^{{2|2}} ≤ ¼.",
        figure(even.to_f64())
    );
    s.judgement("derbez2000-moment-matching-bound", proven_if(holds), evidence)
}

/// ε = (μ^{1|2})² over the probabilities of model 1.
pub fn moment_matching_size(s: &Specification) -> JudgedClaim {
    let small = Rational::new(1, 20) * Rational::new(1, 20);
    let mut evidence = String::from("Exact, a = 0.95, (1 − a)² = 0.0025. ε = (μ^{1|2})² by μ₁:");
    let mut greatest = Rational::zero();
    for of_first in PROBABILITIES {
        let epsilon = mixing(of_first, 0, 1).pow(2);
        let _ = write!(
            evidence,
            " {}: {};",
            Rational::new(of_first, 100).to_f64(),
            figure(epsilon.to_f64())
        );
        if epsilon > greatest {
            greatest = epsilon;
        }
    }
    let even = mixing(50, 0, 1).pow(2);
    let _ = write!(
        evidence,
        " equal at even odds{} and up to {} times as much, just where one model has taken over.",
        if even == small { ", exactly," } else { "" },
        figure((greatest.clone() / small.clone()).to_f64()),
    );
    // Approximately equal: within a factor of two.
    let holds = greatest <= small * Rational::new(2, 1);
    s.judgement("derbez2000-moment-matching-size", proven_if(holds), evidence)
}

/// The published errors of table 1: x and y of IMM, fixed gain and CA.
pub fn published(s: &Specification) -> [[f64; 3]; 2] {
    let row = |name: &str| {
        let row = s.tables[0].rows.iter().find(|row| row.name == name);
        row.and_then(|row| <[f64; 3]>::try_from(&row.values[..]).ok())
            .unwrap_or([f64::NAN; 3])
    };
    ["x-RMS", "y-RMS"].map(row)
}

/// The half of the last printed digit: three decimals in table 1, four in table 2, and two in the one figure with two.
fn rounding(value: f64, table: u32) -> f64 {
    let hundredths = value * 100.0;
    match table {
        1 if (hundredths - hundredths.round()).abs() < 1e-9 => 0.005,
        1 => 0.0005,
        _ => 0.00005,
    }
}

/// Whether the overall errors of a table can be the roots of the sums of the squares above them.
fn overall(table: &PublishedTable, evidence: &mut String) -> bool {
    let row = |name: &str| table.rows.iter().find(|row| row.name == name).map(|row| &row.values);
    let (Some(x), Some(y), Some(printed)) = (row("x-RMS"), row("y-RMS"), row("Overall")) else {
        return false;
    };
    let mut all = true;
    for (c, column) in table.columns.iter().enumerate() {
        let root = |sign: f64| {
            let square = |value: f64| {
                let value = value + sign * rounding(value, table.number);
                value * value
            };
            (square(x[c]) + square(y[c])).sqrt()
        };
        let slack = rounding(printed[c], table.number).min(0.0005);
        let fits = root(-1.0) <= printed[c] + slack && printed[c] - slack <= root(1.0);
        all &= fits;
        let _ = write!(
            evidence,
            " {column} of table {}: between {:.5} and {:.5}, printed {}{};",
            table.number,
            root(-1.0),
            root(1.0),
            printed[c],
            if fits { "" } else { ", impossible" },
        );
    }
    all
}

/// The overall errors against their components.
pub fn table_arithmetic(s: &Specification) -> JudgedClaim {
    let mut evidence =
        String::from("√(x² + y²), from the least and the greatest values that round to the printed ones:");
    let verdicts: Vec<bool> = s.tables.iter().map(|table| overall(table, &mut evidence)).collect();
    evidence.push_str(" an x-RMS of 1.213 in place of 1.23, as for IMM, would give the printed 1.252.");
    s.judgement(
        "derbez2000-table-arithmetic",
        proven_if(verdicts.iter().all(|fits| *fits)),
        evidence,
    )
}

/// The three places that give operations.
pub fn operation_counts(s: &Specification) -> JudgedClaim {
    let of_table = s.tables[0].rows.iter().find(|row| row.name == "Cost/flops");
    let of_table: Vec<f64> = of_table.map(|row| row.values.clone()).unwrap_or_default();
    let as_in_the_table = |places: [u32; 3]| places.map(f64::from).as_slice() == of_table;
    let agree = as_in_the_table(OPERATIONS_OF_SECTION_4) && as_in_the_table(OPERATIONS_OF_SECTION_4_1);
    let ratio = |a: usize, b: usize| match (of_table.get(a), of_table.get(b)) {
        (Some(a), Some(b)) => figure(a / b),
        _ => figure(f64::NAN),
    };
    let evidence = format!(
        "IMM, Fixed Gain, CA: {OPERATIONS_OF_SECTION_4:?} in section 4, {OPERATIONS_OF_SECTION_4_1:?} in section 4.1 and {of_table:?} in \
         table 1. Section 4.1 names the filters in another order than their counts, and IMM has three values. By the table Fixed Gain \
         over CA is {}, IMM over CA {}.",
        ratio(1, 2),
        ratio(0, 2),
    );
    s.judgement("derbez2000-operation-counts", proven_if(agree), evidence)
}

/// Nothing tests it.
pub fn nonlinear_filters(s: &Specification) -> JudgedClaim {
    let evidence = "The paper runs no such filter and names two of other papers, by convolution and by chaos expansion, of which it gives no \
                    equation: there is nothing to reproduce.";
    s.judgement(
        "derbez2000-nonlinear-filters",
        Verdict::NeverPublished,
        evidence.to_owned(),
    )
}
