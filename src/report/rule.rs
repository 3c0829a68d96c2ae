//! A cubature rule as text: points and weights, exact and decimal, with the degree that its exact moments prove.
//!
//! The degree is proven each time, up to a certain dimension.

use super::table;
use crate::number::{Field, Surd};
use crate::rule::moment::{Exactness, exactness, gaussian_moment, monomial_name};
use crate::rule::{ExactRule, InvalidRule, RuleName, gauss_hermite};
use serde::Serialize;
use std::fmt::Write;

/// The greatest dimension that is listed.
pub const GREATEST_DIMENSION: usize = 32;
/// The greatest dimension in which the degree is proven by trying every monomial.
pub const GREATEST_PROVEN_DIMENSION: usize = 10;

/// A rule with everything that is printed of it.
#[derive(Debug, Clone, Serialize)]
pub struct Description {
    /// The rule's name.
    pub name: String,
    /// n.
    pub dimension: usize,
    /// The number of points.
    pub points: usize,
    /// The number of different places at which they stand.
    pub distinct_points: usize,
    /// The number of points with a weight other than zero.
    pub effective_points: usize,
    /// Σ w, exact.
    pub sum_of_weights: String,
    /// Σ |w|, exact.
    pub sum_of_absolute_weights: String,
    /// The degree, by the exact moments of all monomials; none when not even the weights' sum is right, or when it was not tried.
    pub proven_degree: Option<usize>,
    /// The first moment that is wrong.
    pub first_wrong_moment: Option<ListedMoment>,
    /// The points.
    pub list: Vec<RulePoint>,
}

/// A moment that a rule gets wrong.
#[derive(Debug, Clone, Serialize)]
pub struct ListedMoment {
    /// Which, `E x1^6`.
    pub moment: String,
    /// The rule's value, exact.
    pub rule: String,
    /// The Gaussian's value.
    pub gaussian: String,
}

/// A point and its weights.
#[derive(Debug, Clone, Serialize)]
pub struct RulePoint {
    /// The weight, exact.
    pub weight: String,
    /// The weight, the nearest double.
    pub weight_decimal: f64,
    /// The weight for covariances, where it differs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub covariance_weight: Option<String>,
    /// The coordinates, exact.
    pub coordinates: Vec<String>,
    /// The coordinates, the nearest doubles.
    pub coordinates_decimal: Vec<f64>,
}

/// Describes a rule in a dimension.
///
/// # Errors
///
/// [`InvalidRule`] when the rule does not exist there.
pub fn describe(name: &RuleName, shown: &str, n: usize) -> Result<Description, InvalidRule> {
    if n > GREATEST_DIMENSION {
        return Err(InvalidRule::TooLarge {
            dimension: n,
            greatest: GREATEST_DIMENSION,
        });
    }
    if let RuleName::GaussHermite(m) = name {
        return describe_gauss_hermite(*m, shown, n);
    }
    let rule = name.exact(n)?;
    let exactness = (n <= GREATEST_PROVEN_DIMENSION).then(|| exactness(&rule, 7));
    Ok(describe_exact(&rule, shown, exactness))
}

fn describe_exact(rule: &ExactRule, shown: &str, exactness: Option<Exactness>) -> Description {
    let list = rule
        .points
        .iter()
        .zip(rule.weights.iter().zip(&rule.covariance_weights))
        .map(|(point, (weight, covariance_weight))| RulePoint {
            weight: weight.to_string(),
            weight_decimal: weight.to_f64(),
            covariance_weight: (weight != covariance_weight).then(|| covariance_weight.to_string()),
            coordinates: point.iter().map(Surd::to_string).collect(),
            coordinates_decimal: point.iter().map(Surd::to_f64).collect(),
        })
        .collect();
    let failure = exactness.as_ref().and_then(|e| e.failure.clone());
    Description {
        name: shown.to_owned(),
        dimension: rule.dimension,
        points: rule.points.len(),
        distinct_points: rule.distinct_points(),
        effective_points: rule.effective_points(),
        sum_of_weights: rule.sum_of_weights().to_string(),
        sum_of_absolute_weights: rule.sum_of_absolute_weights().to_string(),
        proven_degree: exactness.and_then(|e| e.degree),
        first_wrong_moment: failure.map(|failure| ListedMoment {
            moment: monomial_name(&failure.exponents),
            rule: failure.rule.to_string(),
            gaussian: failure.gaussian.to_string(),
        }),
        list,
    }
}

/// A product rule is described by the nodes of one coordinate: its points are all their combinations.
fn describe_gauss_hermite(m: usize, shown: &str, n: usize) -> Result<Description, InvalidRule> {
    let nodes = gauss_hermite::nodes(m)?;
    if n == 0 {
        return Err(InvalidRule::Dimension {
            rule: "gauss-hermite",
            least: 1,
            dimension: 0,
            reason: "",
        });
    }
    let count = u32::try_from(n).ok().and_then(|n| m.checked_pow(n));
    let points = count.ok_or(InvalidRule::TooLarge {
        dimension: n,
        greatest: usize::MAX.ilog(m) as usize,
    })?;
    // Odd moments vanish on both sides; a product rule has the degree of its one coordinate.
    let gaussian = |power: usize| gaussian_moment(&[power]);
    let wrong = |power: &usize| gauss_hermite::moment(&nodes, *power) != Surd::rational(&gaussian(*power));
    let failing = (0..=2 * m).find(wrong).unwrap_or(2 * m + 1);
    let list = nodes
        .iter()
        .map(|node| {
            let sign = ["-", "", ""][usize::try_from(node.sign + 1).unwrap_or(1)];
            let coordinate = match node.sign {
                0 => "0".to_owned(),
                _ => format!("{sign}√({})", node.square),
            };
            RulePoint {
                weight: node.weight.to_string(),
                weight_decimal: node.weight.to_f64(),
                covariance_weight: None,
                coordinates: vec![coordinate],
                coordinates_decimal: vec![node.sign as f64 * node.square.to_f64().sqrt()],
            }
        })
        .collect();
    Ok(Description {
        name: shown.to_owned(),
        dimension: n,
        points,
        distinct_points: points,
        effective_points: points,
        // The weights of a product are products of weights, and all are positive.
        sum_of_weights: gauss_hermite::moment(&nodes, 0).to_string(),
        sum_of_absolute_weights: gauss_hermite::moment(&nodes, 0).to_string(),
        proven_degree: failing.checked_sub(1),
        first_wrong_moment: Some(ListedMoment {
            moment: format!("E x1^{failing}"),
            rule: gauss_hermite::moment(&nodes, failing).to_string(),
            gaussian: gaussian(failing).to_string(),
        }),
        list,
    })
}

/// A description as text.
pub fn text(description: &Description) -> String {
    let mut text = String::new();
    let n = description.dimension;
    let _ = writeln!(text, "{} in dimension {n}", description.name);
    let _ = writeln!(
        text,
        "  {} points at {} places, {} of them with a weight other than zero",
        description.points, description.distinct_points, description.effective_points
    );
    let _ = writeln!(
        text,
        "  sum of weights {}, of their absolute values {}",
        description.sum_of_weights, description.sum_of_absolute_weights
    );
    let _ = match (&description.proven_degree, &description.first_wrong_moment) {
        (Some(degree), Some(_)) => writeln!(text, "  degree {degree}, proven by the exact moments of all monomials"),
        (None, Some(_)) => writeln!(text, "  no degree: not even the weights' sum is right"),
        (Some(degree), None) => writeln!(text, "  degree {degree} or more"),
        (None, None) => writeln!(
            text,
            "  degree not tried above dimension {GREATEST_PROVEN_DIMENSION}; the tests prove it for every dimension"
        ),
    };
    if let Some(wrong) = &description.first_wrong_moment {
        let _ = writeln!(
            text,
            "  first wrong moment {} = {}, where the Gaussian has {}",
            wrong.moment, wrong.rule, wrong.gaussian
        );
    }
    let product = description
        .list
        .first()
        .is_some_and(|point| point.coordinates.len() < n);
    if product {
        let _ = writeln!(
            text,
            "  the points are all combinations of these nodes, one for each coordinate"
        );
    }
    let mut table = table(&["", "weight", "", "coordinates", ""]);
    for (s, point) in description.list.iter().enumerate() {
        let decimals: Vec<String> = point.coordinates_decimal.iter().map(|x| format!("{x:.6}")).collect();
        let weight = match &point.covariance_weight {
            Some(other) => format!("{} (covariances {other})", point.weight),
            None => point.weight.clone(),
        };
        table.add_row([
            (s + 1).to_string(),
            weight,
            format!("{:.9}", point.weight_decimal),
            point.coordinates.join(", "),
            decimals.join(", "),
        ]);
    }
    let _ = writeln!(text, "{table}");
    text
}
