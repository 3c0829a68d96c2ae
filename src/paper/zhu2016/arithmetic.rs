//! The claims of zhu2016 that arithmetic decides, on the published figures and exactly.
//!
//! These statements need no runs: they contradict the paper's own table, or points and weights decide them.

use super::quantity_of_row;
use crate::number::Rational;
use crate::paper::specification::Specification;
use crate::paper::verdict::{JudgedClaim, Verdict, proven_if, refuted_by};
use crate::rule::unscented::Parameters;
use crate::rule::{ExactRule, fifth_degree, third_degree, unscented};
use crate::statistics::estimate::figure;
use std::fmt::Write;

/// The figures of table 1 against each other.
pub fn all_rmse_smaller(s: &Specification) -> JudgedClaim {
    let rows = s.tables[0]
        .rows
        .iter()
        .filter(|row| quantity_of_row(&row.name).is_some());
    let mut exceptions = Vec::new();
    for row in rows {
        for (column, value) in s.tables[0].columns.iter().zip(&row.values).skip(1) {
            if value <= &row.values[0] {
                exceptions.push(format!("{} of {column}, {value} against {}", row.name, row.values[0]));
            }
        }
    }
    let verdict = proven_if(exceptions.is_empty());
    let evidence = match verdict {
        Verdict::Proven => "Every other figure of table 1 is larger.".to_owned(),
        _ => format!("Table 1 itself has smaller figures: {}.", exceptions.join("; ")),
    };
    s.judgement("zhu2016-all-rmse-smaller", verdict, evidence)
}

/// The dimensions in which the unscented points with κ = 3 − n are those of the third-degree rule.
pub fn three_dimensions_equal(s: &Specification) -> JudgedClaim {
    let coincide = |n: usize| {
        let unscented = unscented::unscented(n, &Parameters::for_gaussian(n));
        let third = third_degree::third_degree(n);
        let (Ok(unscented), Ok(third)) = (unscented, third) else {
            return false;
        };
        unscented.weights[0] == Rational::new(0, 1)
            && unscented.points[1..] == third.points
            && unscented.weights[1..] == third.weights
    };
    let equal: Vec<usize> = (1..=10).filter(|&n| coincide(n)).collect();
    let evidence = format!(
        "Exact: with κ = 3 − n the centre has weight zero and the other points and weights are those of the third-degree rule for n in \
         {equal:?}, and for no other n from 1 to 10.",
    );
    s.judgement("zhu2016-three-dimensions-equal", proven_if(equal == [3]), evidence)
}

/// The negative weights of the fifth-degree rule in many dimensions: each, and all together.
pub fn negative_weights_vanish(s: &Specification) -> JudgedClaim {
    let dimensions = [4, 8, 16, 32, 64];
    let zero = Rational::new(0, 1);
    let mut evidence =
        String::from("Exact, n: weight w₁, sum of the negative weights, Σ|w|, and Σ|w| of the unscented rule:");
    let mut single = Vec::new();
    let mut sums = Vec::new();
    for n in dimensions {
        let w1: Rational = fifth_degree::axis_weight(&Rational::new(n, 1));
        let negative = Rational::new(2 * n, 1) * w1.clone();
        let absolute = Rational::new(1, 1) - Rational::new(2, 1) * negative.clone();
        let unscented = Rational::new(2 * n - 3, 3);
        let _ = write!(
            evidence,
            " {n}: {}, {}, {}, {};",
            figure(w1.to_f64()),
            figure(negative.to_f64()),
            figure(absolute.to_f64()),
            figure(unscented.to_f64()),
        );
        single.push(w1);
        sums.push(negative);
    }
    // n(4 − n)/(n + 2)² → −1 while (4 − n)/(2(n + 2)²) → 0.
    let sums_grow = sums.windows(2).all(|pair| pair[1] < pair[0]) && sums[0] == zero;
    evidence.push_str(
        " each negative weight goes to zero like −1/(2n), but there are 2n of them: their sum n(4 − n)/(n + 2)² goes to −1 and Σ|w| to 3. \
         Smaller than the unscented rule's (2n − 3)/3 for every n ≥ 4, so the comparison holds and its reason does not.",
    );
    s.judgement("zhu2016-negative-weights-vanish", refuted_by(sums_grow), evidence)
}

/// How many weights the fifth-degree rule has.
pub fn equal_weights(s: &Specification) -> JudgedClaim {
    let Ok(rule) = fifth_degree::fifth_degree(4) else {
        return s.judgement("zhu2016-equal-weights", Verdict::Undecided, String::new());
    };
    let mut distinct: Vec<String> = rule.weights.iter().map(ToString::to_string).collect();
    distinct.sort();
    distinct.dedup();
    let evidence = format!(
        "Exact, n = 4: {} points, an odd number, with {} different weights, {}; {} points have a weight other than zero.",
        rule.points.len(),
        distinct.len(),
        distinct.join(", "),
        rule.effective_points(),
    );
    s.judgement("zhu2016-equal-weights", proven_if(distinct.len() == 1), evidence)
}

/// Points, and the published times.
pub fn load(s: &Specification) -> JudgedClaim {
    let count = |rule: Result<ExactRule, _>| rule.map_or((0, 0), |r: ExactRule| (r.points.len(), r.effective_points()));
    let (points, effective) = count(fifth_degree::fifth_degree(4));
    let (third, _) = count(third_degree::third_degree(4));
    let Some(times) = s.tables[0].rows.iter().find(|row| row.name == "Time") else {
        return s.judgement("zhu2016-load", Verdict::NeverPublished, String::new());
    };
    let ratio = times.values[0] / times.values[1];
    let evidence = format!(
        "{points} points, {effective} of a weight other than zero, against {third}: {} (or {}) times as many evaluations of the models, \
         where the published seconds stand in the ratio {}. The load does increase; by how much depends on what does not depend on the \
         points.",
        figure(points as f64 / third as f64),
        figure(effective as f64 / third as f64),
        figure(ratio),
    );
    s.judgement("zhu2016-load", proven_if(effective > third && ratio > 1.0), evidence)
}

/// A filter that was not run.
pub fn better_than_ckf(s: &Specification) -> JudgedClaim {
    let columns = &s.tables[0].columns;
    let evidence = format!(
        "The filters that were run are {}; a single CKF is not among them.",
        columns.join(", ")
    );
    let was_run = columns.iter().any(|column| column == "CKF");
    let verdict = if was_run {
        Verdict::Undecided
    } else {
        Verdict::NeverPublished
    };
    s.judgement("zhu2016-better-than-ckf", verdict, evidence)
}
