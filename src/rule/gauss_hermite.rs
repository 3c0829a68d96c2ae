//! The Gauss-Hermite product rule: m nodes per coordinate, mⁿ points, degree 2m − 1; a reference of higher degree.
//!
//! Other rules are measured against this one where no closed form exists. The nodes of one coordinate are roots of a Hermite polynomial.
//! Up to m = 5 their squares and weights are surds, so the rule's moments are exact too: odd ones vanish by symmetry, even ones need only
//! the squares, and moments of a product are products of moments.

use super::{InvalidRule, Rule};
use crate::matrix::{Holds, Shapes};
use crate::number::{Field, Rational, Real, Surd};
use nalgebra::{Dim, OVector, U1};
use num_traits::{One, Zero};

/// A node of one coordinate: ±√`square`, or zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The sign of the node: −1, 0 or 1.
    pub sign: i64,
    /// The square of the node.
    pub square: Surd,
    /// The weight of the node.
    pub weight: Surd,
}

/// The nodes and weights of one coordinate for the standard Gaussian.
///
/// | m | nodes                | weights                |
/// |---|----------------------|------------------------|
/// | 2 | ±1                   | 1/2                    |
/// | 3 | 0; ±√3               | 2/3; 1/6               |
/// | 4 | ±√(3 ± √6)           | (3 ∓ √6)/12            |
/// | 5 | 0; ±√(5 ± √10)       | 8/15; (7 ∓ 2√10)/60    |
///
/// Source: Abramowitz and Stegun 25.4.46, in the variable √2 x. The filter of this rule is the Gauss-Hermite Kalman filter of
/// Ito and Xiong 2000.
///
/// Example: for m = 3: 0 with 2/3, ±√3 with 1/6 each.
///
/// ```
/// use immaculate::rule::gauss_hermite::nodes;
///
/// let nodes = nodes(3).unwrap();
/// let [centre, right] = [&nodes[0], &nodes[1]];
/// assert_eq!((centre.sign, centre.weight.to_string()), (0, "2/3".to_owned()));
/// assert_eq!((right.square.to_string(), right.weight.to_string()), ("3".to_owned(), "1/6".to_owned()));
/// ```
///
/// # Errors
///
/// [`InvalidRule::Nodes`] for another number of nodes.
///
/// Evidence: `gauss_hermite_rule_has_degree_two_m_minus_one` (exact).
pub fn nodes(m: usize) -> Result<Vec<Node>, InvalidRule> {
    let surd = |rational: Rational, coefficient: Rational, radicand: i64| {
        let root = Surd::root(&Rational::new(radicand, 1));
        Surd::rational(&rational) + Surd::rational(&coefficient) * root
    };
    let whole = |value: Rational| Surd::rational(&value);
    let q = Rational::new;
    let (centre, pairs) = match m {
        2 => (None, vec![(Surd::one(), whole(q(1, 2)))]),
        3 => (Some(whole(q(2, 3))), vec![(whole(q(3, 1)), whole(q(1, 6)))]),
        4 => (
            None,
            vec![
                (surd(q(3, 1), q(1, 1), 6), surd(q(1, 4), q(-1, 12), 6)),
                (surd(q(3, 1), q(-1, 1), 6), surd(q(1, 4), q(1, 12), 6)),
            ],
        ),
        5 => (
            Some(whole(q(8, 15))),
            vec![
                (surd(q(5, 1), q(1, 1), 10), surd(q(7, 60), q(-1, 30), 10)),
                (surd(q(5, 1), q(-1, 1), 10), surd(q(7, 60), q(1, 30), 10)),
            ],
        ),
        nodes => return Err(InvalidRule::Nodes { nodes }),
    };
    let mut all = Vec::new();
    if let Some(weight) = centre {
        all.push(Node {
            sign: 0,
            square: Surd::zero(),
            weight,
        });
    }
    for (square, weight) in pairs {
        for sign in [1, -1] {
            all.push(Node {
                sign,
                square: square.clone(),
                weight: weight.clone(),
            });
        }
    }
    Ok(all)
}

/// The rule's moment Σ w x^power in one coordinate, exactly.
///
/// Source: the definition of a rule.
///
/// Example: for m = 3: E x⁴ = 2 · 1/6 · 9 = 3 is the Gaussian's; E x⁶ = 2 · 1/6 · 27 = 9, where the Gaussian has 15.
///
/// ```
/// use immaculate::rule::gauss_hermite::{moment, nodes};
///
/// let nodes = nodes(3).unwrap();
/// assert_eq!(moment(&nodes, 4).to_string(), "3");
/// assert_eq!(moment(&nodes, 6).to_string(), "9");
/// assert_eq!(moment(&nodes, 5).to_string(), "0");
/// ```
pub fn moment(nodes: &[Node], power: usize) -> Surd {
    let mut sum = Surd::zero();
    for node in nodes {
        let mut term = node.weight.clone();
        if power % 2 == 1 {
            // ± nodes share square and weight, so an odd power leaves nothing of a pair, and the centre is zero.
            continue;
        }
        for _ in 0..power / 2 {
            term *= node.square.clone();
        }
        sum += term;
    }
    sum
}

/// The most points that a product rule may have here: a filter holds as many states, several times, in each mode.
pub const MOST_POINTS: usize = 100_000;

/// The product rule in N dimensions with m nodes a coordinate.
///
/// ```text
/// ξ = (x₍i₁₎, …, x₍iₙ₎),   w = w₍i₁₎ ⋯ w₍iₙ₎
/// ```
///
/// Source: as [`nodes`].
///
/// Example: two coordinates with 0 and ±√3 each: nine points, the first of them the centre with 2/3 · 2/3.
///
/// ```
/// use immaculate::rule::gauss_hermite::gauss_hermite;
///
/// let rule = gauss_hermite::<f64, _>(nalgebra::U2, 3).unwrap();
/// assert_eq!(rule.points.len(), 9);
/// assert_eq!(rule.points[0].as_slice(), [0.0, 0.0]);
/// assert_eq!(rule.weights[0], 2.0 / 3.0 * (2.0 / 3.0));
/// ```
///
/// # Errors
///
/// [`InvalidRule::Nodes`] when m is not 2 to 5, [`InvalidRule::Dimension`] in dimension zero, [`InvalidRule::TooManyPoints`] for more than
/// [`MOST_POINTS`] of them.
pub fn gauss_hermite<T: Real, N: Dim>(side: N, m: usize) -> Result<Rule<T, N>, InvalidRule>
where
    Shapes: Holds<N>,
{
    let n = side.value();
    if n == 0 {
        return Err(InvalidRule::Dimension {
            rule: "gauss-hermite",
            least: 1,
            dimension: n,
            reason: "",
        });
    }
    let nodes = nodes(m)?;
    let Some(count) = u32::try_from(n)
        .ok()
        .and_then(|n| m.checked_pow(n))
        .filter(|&count| count <= MOST_POINTS)
    else {
        return Err(InvalidRule::TooManyPoints {
            nodes: m,
            dimension: n,
            most: MOST_POINTS,
        });
    };
    let mut points = Vec::new();
    let mut weights = Vec::new();
    for index in 0..count {
        let mut digits = index;
        let mut weight = T::one();
        let mut point = OVector::<T, N>::zeros_generic(side, U1);
        for coordinate in 0..n {
            let node = &nodes[digits % m];
            digits /= m;
            point[coordinate] = T::surd(&node.square).sqrt() * T::integer(node.sign);
            weight *= T::surd(&node.weight);
        }
        points.push(point);
        weights.push(weight);
    }
    Ok(Rule {
        points,
        covariance_weights: weights.clone(),
        weights,
    })
}
