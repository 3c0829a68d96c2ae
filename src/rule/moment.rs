//! Exact moments of rules in one dimension n, and the degree that they prove.
//!
//! A rule has degree d if it integrates every monomial of degree up to d exactly and some monomial of degree d + 1 wrongly. No tolerance
//! is needed: coordinates are surds and weights are rationals, so both sides are exact numbers and are compared exactly.

use super::ExactRule;
use crate::number::{Field, Rational, Surd};
use num_traits::{One, Zero};

/// A monomial x₁^e₁ ⋯ xₙ^eₙ whose moment a rule gets wrong.
#[derive(Debug, Clone, PartialEq)]
pub struct WrongMoment {
    /// The exponents e₁ … eₙ.
    pub exponents: Vec<usize>,
    /// The rule's moment.
    pub rule: Surd,
    /// The Gaussian's moment.
    pub gaussian: Rational,
}

impl std::fmt::Display for WrongMoment {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            formatter,
            "{} = {}, where the Gaussian has {}",
            monomial_name(&self.exponents),
            self.rule,
            self.gaussian
        )
    }
}

/// The name of a monomial under an expectation: `E x1^2 x3`, or `E 1`.
///
/// Example: exponents of zero are left out.
///
/// ```
/// use immaculate::rule::moment::monomial_name;
/// assert_eq!(monomial_name(&[2, 0, 1]), "E x1^2 x3");
/// assert_eq!(monomial_name(&[0, 0]), "E 1");
/// ```
pub fn monomial_name(exponents: &[usize]) -> String {
    let factors: Vec<String> = exponents
        .iter()
        .enumerate()
        .filter(|(_, exponent)| **exponent > 0)
        .map(|(i, exponent)| match exponent {
            1 => format!("x{}", i + 1),
            _ => format!("x{}^{exponent}", i + 1),
        })
        .collect();
    if factors.is_empty() {
        return "E 1".to_owned();
    }
    format!("E {}", factors.join(" "))
}

/// What the exact moments of a rule show.
#[derive(Debug, Clone, PartialEq)]
pub struct Exactness {
    /// Every monomial up to this degree is exact; `None` when already the sum of the weights is wrong.
    pub degree: Option<usize>,
    /// A monomial of the next degree that is not exact; `None` when all degrees that were tried are exact.
    pub failure: Option<WrongMoment>,
}

/// The moment of a monomial under the standard Gaussian: Π (eᵢ − 1)!!, or zero when an exponent is odd — liu2017 (2), (gaussian-integral),
/// (change-of-variables).
///
/// ```text
/// ∫ f(x) N(x; 0, I) dx = π^(−n/2) ∫ f(√2 y) e^(−yᵀy) dy,   of x₁^e₁ ⋯ xₙ^eₙ: Π (eᵢ − 1)!!
/// ```
///
/// Why: E x^(2k) = 1·3·5⋯(2k − 1) for a standard Gaussian coordinate, and the coordinates are independent. liu2017 integrates against
/// e^(−xᵀx), which is the same in the variable x/√2.
///
/// Example: E x⁴ = 3 and E x² = 1; odd ones are zero.
///
/// ```
/// use immaculate::rule::moment::gaussian_moment;
///
/// assert_eq!(gaussian_moment(&[4, 2]).to_string(), "3"); // E x⁴ · E x² = 3 · 1
/// assert_eq!(gaussian_moment(&[1, 2]).to_string(), "0");
/// ```
///
/// Evidence: `harmonic_sums_and_moments_find_the_same_degree`, `a_rule_with_one_wrong_point_or_weight_loses_its_degree` (exact).
pub fn gaussian_moment(exponents: &[usize]) -> Rational {
    let mut product = Rational::one();
    for &exponent in exponents {
        if exponent % 2 == 1 {
            return Rational::zero();
        }
        for factor in (1..exponent).step_by(2) {
            product *= Rational::integer(i64::try_from(factor).unwrap_or(i64::MAX));
        }
    }
    product
}

/// The rule's moment of a monomial, Σₛ wₛ Πᵢ ξₛ,ᵢ^eᵢ.
///
/// Source: the definition of a rule.
///
/// Example: four points (±√2, 0), (0, ±√2) with 1/4 each: E x₁² = 2 · 1/4 · 2, E x₁⁴ = 2 · 1/4 · 4, and E x₁²x₂² = 0 for 1.
///
/// ```
/// use immaculate::rule::{moment::rule_moment, third_degree::third_degree};
///
/// let rule = third_degree(2).unwrap();
/// assert_eq!(rule_moment(&rule, &[2, 0]).to_string(), "1");
/// assert_eq!(rule_moment(&rule, &[4, 0]).to_string(), "2");
/// assert_eq!(rule_moment(&rule, &[2, 2]).to_string(), "0");
/// ```
pub fn rule_moment(rule: &ExactRule, exponents: &[usize]) -> Surd {
    let mut sum = Surd::zero();
    for (point, weight) in rule.points.iter().zip(&rule.weights) {
        let mut term = Surd::rational(weight);
        for (coordinate, &exponent) in point.iter().zip(exponents) {
            for _ in 0..exponent {
                term *= coordinate.clone();
            }
        }
        sum += term;
    }
    sum
}

/// The degree of a rule by its exact moments, tried up to the degree `up_to`.
///
/// Source: the definition of the degree of a rule.
///
/// Example: four points at the distance √2 with 1/4 each, 2 · 1/4 · (√2)⁴ = 2.
///
/// ```
/// use immaculate::rule::{moment::exactness, third_degree::third_degree};
///
/// let exactness = exactness(&third_degree(2).unwrap(), 5);
/// assert_eq!(exactness.degree, Some(3));
/// assert_eq!(exactness.failure.unwrap().to_string(), "E x1^4 = 2, where the Gaussian has 3");
/// ```
pub fn exactness(rule: &ExactRule, up_to: usize) -> Exactness {
    for degree in 0..=up_to {
        if let Some(failure) = wrong_moment_of_degree(rule, degree) {
            return Exactness {
                degree: degree.checked_sub(1),
                failure: Some(failure),
            };
        }
    }
    Exactness {
        degree: Some(up_to),
        failure: None,
    }
}

/// The first monomial of a degree that the rule gets wrong, if there is one. The powers of earlier coordinates come first:
/// x₁⁴ before x₁²x₂².
///
/// Source: the definition of the degree of a rule.
///
/// Example: for n = 2: the axes give E x₁⁶ 2 · 1/16 · 2⁶ = 8, the diagonals 4 · 1/16 · (√2)⁶ = 2.
///
/// ```
/// use immaculate::rule::{fifth_degree::fifth_degree, moment::wrong_moment_of_degree};
///
/// let rule = fifth_degree(2).unwrap();
/// assert_eq!(wrong_moment_of_degree(&rule, 4), None);
/// let wrong = wrong_moment_of_degree(&rule, 6).unwrap();
/// assert_eq!(wrong.to_string(), "E x1^6 = 10, where the Gaussian has 15");
/// ```
pub fn wrong_moment_of_degree(rule: &ExactRule, degree: usize) -> Option<WrongMoment> {
    let terms: Vec<Surd> = rule.weights.iter().map(Surd::rational).collect();
    search(rule, &mut vec![0; rule.dimension], 0, degree, &terms)
}

/// Chooses the exponent of `coordinate` and goes on to the next; `terms` holds the product so far at each point, so a monomial
/// costs one product a point more than the one before it.
fn search(
    rule: &ExactRule,
    exponents: &mut Vec<usize>,
    coordinate: usize,
    remaining: usize,
    terms: &[Surd],
) -> Option<WrongMoment> {
    if remaining == 0 || coordinate + 1 == rule.dimension {
        let mut terms = terms.to_vec();
        for _ in 0..remaining {
            terms = multiplied(rule, coordinate, &terms);
        }
        exponents[coordinate] += remaining;
        let moment = terms.into_iter().fold(Surd::zero(), |sum, term| sum + term);
        let gaussian = gaussian_moment(exponents);
        let wrong = (moment != Surd::rational(&gaussian)).then(|| WrongMoment {
            exponents: exponents.clone(),
            rule: moment,
            gaussian,
        });
        exponents[coordinate] -= remaining;
        return wrong;
    }
    // The highest power first, so that the powers' terms are at hand when the recursion comes back down.
    let mut powers = vec![terms.to_vec()];
    for power in 0..remaining {
        let next = multiplied(rule, coordinate, &powers[power]);
        powers.push(next);
    }
    for power in (0..=remaining).rev() {
        exponents[coordinate] = power;
        let wrong = search(rule, exponents, coordinate + 1, remaining - power, &powers[power]);
        if wrong.is_some() {
            return wrong;
        }
    }
    exponents[coordinate] = 0;
    None
}

/// Each term times the point's coordinate.
fn multiplied(rule: &ExactRule, coordinate: usize, terms: &[Surd]) -> Vec<Surd> {
    let products = terms.iter().zip(&rule.points);
    products
        .map(|(term, point)| {
            if term.is_zero() {
                Surd::zero()
            } else {
                term.clone() * point[coordinate].clone()
            }
        })
        .collect()
}
