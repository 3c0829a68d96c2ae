//! Cubature rules: points and weights that replace a Gaussian integral by a sum.
//!
//! ```text
//! ∫ g(x) N(x; 0, I) dx  ≈  Σₛ wₛ g(ξₛ)
//! ```
//!
//! liu2017 writes the integral with another weight and splits it into a radius and a direction, x = r s with sᵀs = 1:
//! liu2017 (2), (3). It is the same integral in the variable √2 x, which makes a radius √(n/2 + 1) there a √(n + 2) here:
//!
//! ```text
//! ∫ f(x) e^(−xᵀx) dx = ∫ r^(n−1) e^(−r²) ∫ f(r s) dσ(s) dr,     f(x) = g(√2 x) / π^(n/2)
//! ```
//!
//! These are all the rules that the papers use, with the origin of their points and their degree of exactness. A rule is written down
//! once, in exact form, straight from its paper ([`ExactRule`]: coordinates are surds, weights are rationals). It is proven in that form
//! ([`moment`] for one dimension at a time, [`sphere`] for every dimension at once) and only then turned into the numbers of a filter
//! ([`Rule`]).
//!
//! | rule                                     | points      | degree | file              |
//! |------------------------------------------|-------------|--------|-------------------|
//! | third degree (cubature Kalman filter)    | 2n          | 3      | [`third_degree`]  |
//! | unscented                                | 2n + 1      | 3      | [`unscented`]     |
//! | fifth degree (zhu2016)                   | 2n² + 1     | 5      | [`fifth_degree`]  |
//! | simplex, fifth degree (liu2017)          | n² + 3n + 3 | 5      | [`simplex`]       |
//! | Gauss-Hermite product, a reference       | mⁿ          | 2m − 1 | [`gauss_hermite`] |
//! | weights that the papers print wrongly    |             | none   | [`printed`]       |
//!
//! (The unscented rule has degree 5 in one dimension when n + λ = 3.)
//!
//! ```
//! use immaculate::number::{Field, Rational, Surd};
//! use immaculate::rule::{moment::rule_moment, simplex::radial_rule, third_degree::third_degree};
//!
//! // n = 1: the integrals of x² and x⁴ are 1 and 3; the points ±1 with 1/2 each give 1 and 1.
//! let rule = third_degree(1).unwrap();
//! assert_eq!(rule_moment(&rule, &[2]), Surd::rational(&Rational::new(1, 1)));
//! assert_eq!(rule_moment(&rule, &[4]), Surd::rational(&Rational::new(1, 1)));
//!
//! // n = 4: a radius squared of 4/2 + 1 in the variable of liu2017 is one of 4 + 2 here.
//! let (_, _, squared) = radial_rule(&Rational::new(4, 1));
//! assert_eq!(Rational::new(2, 1) * squared, Rational::new(6, 1));
//! ```

pub mod fifth_degree;
pub mod gauss_hermite;
pub mod moment;
mod name;
pub mod printed;
pub mod simplex;
pub mod sphere;
pub mod third_degree;
pub mod unscented;

pub use name::RuleName;

use crate::matrix::{Holds, Shapes};
use crate::number::{Field, Rational, Roots, Surd};
use nalgebra::{Dim, OVector, U1};
use num_traits::Zero;

/// What a rule cannot be built from.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum InvalidRule {
    /// A name that no rule has.
    #[error("there is no rule `{name}`; there are {}", RuleName::NAMES.join(", "))]
    UnknownName {
        /// The name that was asked for.
        name: String,
    },
    /// A dimension in which the rule does not exist.
    #[error("the rule `{rule}` needs a dimension of at least {least}, not {dimension}{reason}")]
    Dimension {
        /// The rule.
        rule: &'static str,
        /// The least dimension in which it exists.
        least: usize,
        /// The dimension that was asked for.
        dimension: usize,
        /// Why, with the equation.
        reason: &'static str,
    },
    /// Parameters for which the square of the points' radius is not positive.
    #[error(
        "the unscented parameters give n + lambda = {radius_squared}, which must be positive: it is the square of the points' distance from the centre"
    )]
    Radius {
        /// n + λ.
        radius_squared: String,
    },
    /// Parameters for which the points' radius has no exact form here.
    #[error(
        "the unscented parameters give n + lambda = {radius_squared}, whose root has too many digits to be exact; give fewer decimals"
    )]
    RadiusDigits {
        /// n + λ.
        radius_squared: String,
    },
    /// A number of Gauss-Hermite nodes that has no closed form here.
    #[error("the Gauss-Hermite rule has 2 to 5 nodes a coordinate here, not {nodes}")]
    Nodes {
        /// The number that was asked for.
        nodes: usize,
    },
    /// A product rule with more points than are kept.
    #[error(
        "the Gauss-Hermite rule with {nodes} nodes a coordinate has {nodes}^{dimension} points in dimension {dimension}; at most {most} are computed"
    )]
    TooManyPoints {
        /// Nodes a coordinate.
        nodes: usize,
        /// The dimension.
        dimension: usize,
        /// The most points that a rule may have.
        most: usize,
    },
    /// A rule whose coordinates are not surds.
    #[error("the coordinates of a Gauss-Hermite product rule are nested roots, not surds")]
    NestedRoots,
    /// A dimension too large to be listed.
    #[error("dimension {dimension} is too large to be listed; at most {greatest}")]
    TooLarge {
        /// The dimension that was asked for.
        dimension: usize,
        /// The greatest that is listed.
        greatest: usize,
    },
    /// A rule of one dimension used in another.
    #[error("a rule of dimension {rule} cannot serve a state of dimension {state}")]
    StateDimension {
        /// The rule's dimension.
        rule: usize,
        /// The state's dimension.
        state: usize,
    },
}

/// A rule in exact form, for a dimension known at run time.
#[derive(Debug, Clone, PartialEq)]
pub struct ExactRule {
    /// The number of coordinates of a point, n.
    pub dimension: usize,
    /// The points ξₛ, in the order of their paper.
    pub points: Vec<Vec<Surd>>,
    /// The weights wₛ, one a point.
    pub weights: Vec<Rational>,
    /// The weights used for covariances: those of [`ExactRule::weights`] but for the centre of the (α, β, κ) unscented rule.
    pub covariance_weights: Vec<Rational>,
}

impl ExactRule {
    /// A rule whose covariances have the same weights as its means, given as orbits: points that share a weight.
    fn from_orbits(dimension: usize, orbits: Vec<(Rational, Vec<Vec<Surd>>)>) -> Self {
        let mut points = Vec::new();
        let mut weights = Vec::new();
        for (weight, orbit) in orbits {
            weights.extend(vec![weight; orbit.len()]);
            points.extend(orbit);
        }
        Self {
            dimension,
            points,
            covariance_weights: weights.clone(),
            weights,
        }
    }

    /// Sum of the weights: the moment of degree zero, 1 for every rule that is right.
    ///
    /// Example: at n = 4, of the rule of zhu2016 as it is and as it is printed.
    ///
    /// ```
    /// use immaculate::rule::{fifth_degree, printed};
    ///
    /// assert_eq!(fifth_degree::fifth_degree(4).unwrap().sum_of_weights().to_string(), "1");
    /// assert_eq!(printed::fifth_degree(4).unwrap().sum_of_weights().to_string(), "5/3");
    /// ```
    pub fn sum_of_weights(&self) -> Rational {
        self.weights
            .iter()
            .cloned()
            .fold(Rational::new(0, 1), |sum, weight| sum + weight)
    }

    /// Sum of the weights' absolute values, Σ|w|: the factor by which the rule can amplify an error of g.
    ///
    /// Example: for n = 4, κ = −1: weights −1/3 and eight times 1/6.
    ///
    /// ```
    /// use immaculate::rule::unscented::{Parameters, unscented};
    ///
    /// let rule = unscented(4, &Parameters::for_gaussian(4)).unwrap();
    /// assert_eq!(rule.sum_of_absolute_weights().to_string(), "5/3");
    /// ```
    pub fn sum_of_absolute_weights(&self) -> Rational {
        self.weights
            .iter()
            .fold(Rational::new(0, 1), |sum, weight| sum + weight.abs())
    }

    /// The number of points whose weight is not zero.
    ///
    /// Example: for n = 4: the eight points on the axes have the weight 4 − n = 0.
    ///
    /// ```
    /// use immaculate::rule::fifth_degree::fifth_degree;
    ///
    /// let rule = fifth_degree(4).unwrap();
    /// assert_eq!((rule.points.len(), rule.effective_points()), (33, 25));
    /// ```
    pub fn effective_points(&self) -> usize {
        let zero = Rational::new(0, 1);
        self.weights.iter().filter(|weight| **weight != zero).count()
    }

    /// The number of different places at which the points stand.
    ///
    /// Example: for n = 2: a triangle's edge midpoints are opposite to its vertices, so that 13 points stand at 7 places.
    ///
    /// ```
    /// use immaculate::rule::simplex::simplex;
    ///
    /// let rule = simplex(2).unwrap();
    /// assert_eq!((rule.points.len(), rule.distinct_points()), (13, 7));
    /// ```
    pub fn distinct_points(&self) -> usize {
        (0..self.points.len())
            .filter(|&s| !self.points[..s].contains(&self.points[s]))
            .count()
    }
}

/// A rule in the numbers of a filter.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule<T: Field, N: Dim>
where
    Shapes: Holds<N>,
{
    /// The points ξₛ.
    pub points: Vec<OVector<T, N>>,
    /// The weights of means and cross-covariances, wₛ.
    pub weights: Vec<T>,
    /// The weights of covariances.
    pub covariance_weights: Vec<T>,
}

impl<T: Roots, N: Dim> Rule<T, N>
where
    Shapes: Holds<N>,
{
    /// Turns an exact rule into the numbers of a filter, each coordinate and weight by itself: in doubles each is the one
    /// nearest to the exact value.
    ///
    /// Example: at n = 4 the third-degree rule has the radius √4 and the weights 1/8.
    ///
    /// ```
    /// use immaculate::rule::{Rule, third_degree::third_degree};
    /// use nalgebra::U4;
    ///
    /// let rule = Rule::<f64, U4>::from_exact(&third_degree(4).unwrap()).unwrap();
    /// assert_eq!(rule.points[0][0], 2.0);
    /// assert_eq!(rule.weights, vec![0.125; 8]);
    /// ```
    ///
    /// # Errors
    ///
    /// [`InvalidRule::StateDimension`] when the state has another dimension than the rule.
    pub fn from_exact(exact: &ExactRule) -> Result<Self, InvalidRule> {
        if let Some(state) = N::try_to_usize().filter(|&state| state != exact.dimension) {
            return Err(InvalidRule::StateDimension {
                rule: exact.dimension,
                state,
            });
        }
        let n = N::from_usize(exact.dimension);
        let points = exact
            .points
            .iter()
            .map(|point| OVector::from_fn_generic(n, U1, |row, _| T::surd(&point[row])))
            .collect();
        Ok(Self {
            points,
            weights: exact.weights.iter().map(T::rational).collect(),
            covariance_weights: exact.covariance_weights.iter().map(T::rational).collect(),
        })
    }
}

/// `length` times the unit vector along the axis `axis`.
fn along_axis(dimension: usize, axis: usize, length: &Surd) -> Vec<Surd> {
    let mut point = vec![Surd::zero(); dimension];
    point[axis] = length.clone();
    point
}

/// The mirror images −ξ of points.
fn opposite(points: &[Vec<Surd>]) -> Vec<Vec<Surd>> {
    points
        .iter()
        .map(|point| point.iter().map(|coordinate| -coordinate.clone()).collect())
        .collect()
}

/// A dimension as a rational.
fn dimension_as_rational(dimension: usize) -> Rational {
    Rational::new(i64::try_from(dimension).unwrap_or(i64::MAX), 1)
}
