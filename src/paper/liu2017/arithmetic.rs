//! The claims of liu2017 that arithmetic decides, on the published figures and exactly.
//!
//! They concern the paper's numbers of points, its times, and the degree of its rule.

use crate::number::Rational;
use crate::paper::specification::Specification;
use crate::paper::verdict::{JudgedClaim, proven_if};
use crate::rule::moment::exactness;
use crate::rule::sphere::{every_dimension, on_simplex};
use crate::rule::{RuleName, simplex};
use crate::statistics::estimate::figure;

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

/// The points of the four rules, counted.
pub fn point_counts(s: &Specification) -> JudgedClaim {
    let counted = counted_points();
    let published = table_2(s, "Number of Points");
    let counted_as_published: Vec<f64> = counted.iter().map(|points| *points as f64).collect();
    let equal = counted_as_published == published;
    let evidence = format!("Counted {counted:?}, published {published:?}.");
    s.judgement("liu2017-point-counts", proven_if(equal), evidence)
}

/// The published times over the published numbers of points.
pub fn time_proportional_to_points(s: &Specification) -> JudgedClaim {
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

/// Points and published times of the two fifth-degree filters.
pub fn slightly_cheaper(s: &Specification) -> JudgedClaim {
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

/// The degree of the simplex rule, for every dimension.
pub fn degree_five(s: &Specification) -> JudgedClaim {
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

/// The points of the two fifth-degree rules by dimension.
pub fn cheaper_in_high_dimension(s: &Specification) -> JudgedClaim {
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
