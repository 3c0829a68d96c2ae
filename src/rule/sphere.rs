//! The degree of a spherical-radial rule, for every dimension n ≥ 2 at once.
//!
//! (At n = 1 the sphere is two points and has no harmonics beyond degree one; the recurrence below divides by n − 1.)
//!
//! The degree of such a rule can be proven without its coordinates. The rules here consist of a centre and points ±s on one sphere. Odd
//! moments vanish by symmetry. Two conditions decide the even ones:
//!
//! 1. **The radial moments.** With weight W on the sphere of radius r, E r^(2k) of the Gaussian must be W r^(2k):
//!    n for k = 1, n(n + 2) for k = 2, n(n + 2)(n + 4) for k = 3.
//! 2. **The harmonic sums.** On the unit sphere, polynomials of degree ≤ d are sums of spherical harmonics Y of degree
//!    k ≤ d (times powers of |s|² = 1), and the true mean of Y over the sphere is zero for k ≥ 1. By the addition theorem
//!    Σ_Y Y(s) Y(t) is a positive multiple of the Gegenbauer polynomial Pₖ(s·t), so
//!
//!    ```text
//!    Σₛ Σₜ wₛ wₜ Pₖ(s·t)  ∝  Σ_Y ( Σₛ wₛ Y(s) )²
//!    ```
//!
//!    and the left side is zero exactly when every harmonic of degree k is integrated exactly, whatever the weights' signs.
//!
//! The left side needs only how often each inner product occurs ([`InnerProduct`]), and these numbers are polynomials in n. They
//! are given here for the three families of points, checked against the points themselves in the tests, and summed with n
//! unknown.

use super::{fifth_degree, simplex};
use crate::number::{Field, RationalFunction};

/// Ordered pairs of points (s, t) on the unit sphere that have the same weights and the same squared inner product.
#[derive(Debug, Clone, PartialEq)]
pub struct InnerProduct<T> {
    /// How many ordered pairs there are.
    pub pairs: T,
    /// The product of the two points' weights, as parts of the whole sphere's.
    pub weights: T,
    /// (s·t)².
    pub squared: T,
}

/// The Gegenbauer polynomial P₂ₖ(t) of the sphere in n dimensions, from t², with P₂ₖ(1) = 1.
///
/// ```text
/// P₀ = 1,   P₁ = t,   (m + n − 2) P₍m+1₎ = (2m + n − 2) t Pₘ − m P₍m−1₎
/// ```
///
/// Source: Müller, Spherical Harmonics, 1966, recurrence of the Legendre polynomials in n dimensions. Even members are
/// polynomials of t², and odd ones t times such a polynomial, so that no square root of an inner product is needed.
///
/// Example: on the circle, n = 2, P₂ₖ(cos θ) = cos 2kθ; at θ = 45°, where t² = 1/2, cos 90° = 0 and cos 180° = −1.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::sphere::gegenbauer;
///
/// let (n, half) = (Rational::new(2, 1), Rational::new(1, 2));
/// assert_eq!(gegenbauer(&n, 1, &half), Rational::new(0, 1));
/// assert_eq!(gegenbauer(&n, 2, &half), Rational::new(-1, 1));
/// ```
pub fn gegenbauer<T: Field>(n: &T, k: usize, squared: &T) -> T {
    let m = |value: usize| T::integer(i64::try_from(value).unwrap_or(i64::MAX));
    let step = |degree: usize| n.clone() + m(degree) - T::integer(2);
    let mut even = T::one(); // P₂ᵢ
    let mut odd_over_t = T::one(); // P₂ᵢ₊₁ / t
    for i in 1..=k {
        even = (step(2 * (2 * i - 1)) * squared.clone() * odd_over_t.clone() - m(2 * i - 1) * even) / step(2 * i - 1);
        odd_over_t = (step(4 * i) * even.clone() - m(2 * i) * odd_over_t) / step(2 * i);
    }
    even
}

/// The harmonic sum Σₛ Σₜ wₛ wₜ P₂ₖ(s·t): zero exactly when all harmonics of degree 2k are integrated exactly over the sphere —
/// liu2017 (spherical-integral).
///
/// Source: Delsarte, Goethals and Seidel, Spherical codes and designs, 1977, for equal weights; the head of this file for any.
///
/// Example: four points on the circle, ±e₁ and ±e₂, of 1/4 each. For k = 1 their pairs give 8/16 · 1 + 8/16 · (−1), for k = 2 8/16 · 1 +
/// 8/16 · 1: the rule is right to degree 3 and not to 4.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::sphere::{harmonic_sum, on_axes};
///
/// let n = Rational::new(2, 1);
/// let rule = on_axes(&n, Rational::new(0, 1), &Rational::new(1, 4), n.clone());
/// assert_eq!(harmonic_sum(&n, 1, &rule.products), Rational::new(0, 1));
/// assert_eq!(harmonic_sum(&n, 2, &rule.products), Rational::new(1, 1));
/// ```
///
/// Evidence: `harmonic_sums_and_moments_find_the_same_degree` (exact), `gegenbauer_polynomials_are_orthogonal_on_the_sphere` (symbolic).
pub fn harmonic_sum<T: Field>(n: &T, k: usize, products: &[InnerProduct<T>]) -> T {
    let mut sum = T::zero();
    for product in products {
        let value = gegenbauer(n, k, &product.squared);
        sum += product.pairs.clone() * product.weights.clone() * value;
    }
    sum
}

/// Radial moment E r^(2k) of the standard Gaussian in n dimensions: n(n + 2) ⋯ (n + 2k − 2) — liu2017 (radial-integral), (gamma-function).
///
/// Source: r² is χ² with n degrees of freedom. In liu2017's variable r/√2 it is Γ(n/2 + k)/Γ(n/2), by Γ(x + 1) = x Γ(x).
///
/// Example: for n = 2, E r⁴.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::sphere::radial_moment;
///
/// assert_eq!(radial_moment(&Rational::new(2, 1), 2), Rational::new(8, 1)); // 2 · 4
/// ```
///
/// Evidence: `radial_rule_matches_the_moments_zero_two_and_four`, `fifth_degree_rule_has_degree_five_in_every_dimension` (symbolic).
pub fn radial_moment<T: Field>(n: &T, k: usize) -> T {
    let mut product = T::one();
    for i in 0..k {
        product *= n.clone() + T::integer(2) * T::integer(i64::try_from(i).unwrap_or(i64::MAX));
    }
    product
}

/// A centre and points ±s on a sphere, for a dimension that is a number of the field: a particular n, or the unknown n.
#[derive(Debug, Clone, PartialEq)]
pub struct SphericalRule<T> {
    /// The dimension.
    pub n: T,
    /// The weight of the centre.
    pub centre: T,
    /// The sum of the weights on the sphere.
    pub sphere: T,
    /// The square of the sphere's radius.
    pub radius_squared: T,
    /// The inner products of the directions, with the weights as parts of [`SphericalRule::sphere`].
    pub products: Vec<InnerProduct<T>>,
}

impl<T: Field> SphericalRule<T> {
    /// The degree of the rule, at most 7 — liu2017 (3).
    ///
    /// The weights sum to one, and then each even degree adds one radial moment and one harmonic sum. `None` when the weights do not sum
    /// to one.
    ///
    /// Source: the head of this file.
    ///
    /// Example: the third-degree rule, with n left unknown: the radius squared is n, and there is no centre.
    ///
    /// ```
    /// use immaculate::number::{Field, RationalFunction};
    /// use immaculate::rule::sphere::{every_dimension, on_axes};
    /// use immaculate::rule::third_degree::axis_weight;
    ///
    /// let n = every_dimension();
    /// let rule = on_axes(&n, RationalFunction::integer(0), &axis_weight(&n), n.clone());
    /// assert_eq!(rule.degree(), Some(3));
    /// ```
    ///
    /// Evidence: `harmonic_sums_and_moments_find_the_same_degree` (exact), `simplex_rule_has_degree_five_in_every_dimension` (symbolic).
    pub fn degree(&self) -> Option<usize> {
        if self.centre.clone() + self.sphere.clone() != T::one() {
            return None;
        }
        let mut degree = 1;
        let mut power = T::one();
        for k in 1..=3 {
            power *= self.radius_squared.clone();
            let radial = self.sphere.clone() * power.clone() == radial_moment(&self.n, k);
            let harmonic = harmonic_sum(&self.n, k, &self.products) == T::zero();
            if !(radial && harmonic) {
                break;
            }
            degree += 2;
        }
        Some(degree)
    }
}

/// Points ±eᵢ on the axes with equal weights, and a centre: the third-degree rule and the unscented rule.
///
/// ```text
/// 2n points:  (s·t)² = 1 for s = ±t, else 0
/// ```
///
/// Source: counting.
///
/// Example: for n = 2: of 4 · 4 ordered pairs 8 are equal or opposite and 8 are at right angles.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::sphere::on_axes;
///
/// let n = Rational::new(2, 1);
/// let rule = on_axes(&n, Rational::new(0, 1), &Rational::new(1, 4), n.clone());
/// let pairs: Vec<String> = rule.products.iter().map(|pair| pair.pairs.to_string()).collect();
/// assert_eq!(pairs, ["8", "8"]);
/// assert_eq!(rule.degree(), Some(3));
/// ```
pub fn on_axes<T: Field>(n: &T, centre: T, axis_weight: &T, radius_squared: T) -> SphericalRule<T> {
    let two = T::integer(2);
    let points = two.clone() * n.clone();
    let sphere = points.clone() * axis_weight.clone();
    let part = axis_weight.clone() / sphere.clone();
    let weights = part.clone() * part;
    let products = vec![
        InnerProduct {
            pairs: points.clone() * two.clone(),
            weights: weights.clone(),
            squared: T::one(),
        },
        InnerProduct {
            pairs: points.clone() * (points - two),
            weights,
            squared: T::zero(),
        },
    ];
    SphericalRule {
        n: n.clone(),
        centre,
        sphere,
        radius_squared,
        products,
    }
}

/// Points on the axes and on the diagonals: the fifth-degree rule of zhu2016, with a given weight on the diagonals.
///
/// ```text
/// axis · axis:          2n points, each with 2 of (s·t)² = 1; the rest 0
/// axis · diagonal:      each axis point meets 4(n−1) diagonals of (s·t)² = 1/2; the rest 0
/// diagonal · diagonal:  2n(n−1) points, each with 2 of 1, 8(n−2) of 1/4; the rest 0
/// ```
///
/// Source: counting.
///
/// Example: for every n ≥ 2 at once: zhu2016's rule has degree five, and with the printed weight not even its weights sum to one.
///
/// ```
/// use immaculate::rule::sphere::{every_dimension, on_axes_and_diagonals};
/// use immaculate::rule::{fifth_degree, printed};
///
/// let n = every_dimension();
/// assert_eq!(on_axes_and_diagonals(&n, &fifth_degree::diagonal_weight(&n)).degree(), Some(5));
/// assert_eq!(on_axes_and_diagonals(&n, &printed::diagonal_weight(&n)).degree(), None);
/// ```
pub fn on_axes_and_diagonals<T: Field>(n: &T, diagonal_weight: &T) -> SphericalRule<T> {
    let integer = T::integer;
    let axis_points = integer(2) * n.clone();
    let diagonal_points = integer(2) * n.clone() * (n.clone() - T::one());
    let axis_weight = fifth_degree::axis_weight(n);
    let sphere = axis_points.clone() * axis_weight.clone() + diagonal_points.clone() * diagonal_weight.clone();
    let axis = axis_weight / sphere.clone();
    let diagonal = diagonal_weight.clone() / sphere.clone();

    let sharing_axis = integer(4) * (n.clone() - T::one());
    let sharing_one = integer(8) * (n.clone() - integer(2));
    let rest = |points: &T, others: &T| points.clone() - others.clone();
    let pair = |pairs: T, weights: T, squared: T| InnerProduct {
        pairs,
        weights,
        squared,
    };
    let axis_axis = axis.clone() * axis.clone();
    let axis_diagonal = axis * diagonal.clone();
    let diagonal_diagonal = diagonal.clone() * diagonal;
    let equal = integer(2);
    // Both orders of (axis, diagonal) are counted by the factor two.
    let products = vec![
        pair(axis_points.clone() * equal.clone(), axis_axis.clone(), T::one()),
        pair(axis_points.clone() * rest(&axis_points, &equal), axis_axis, T::zero()),
        pair(
            integer(2) * axis_points.clone() * sharing_axis.clone(),
            axis_diagonal.clone(),
            T::ratio(1, 2),
        ),
        pair(
            integer(2) * axis_points * rest(&diagonal_points, &sharing_axis),
            axis_diagonal,
            T::zero(),
        ),
        pair(
            diagonal_points.clone() * equal.clone(),
            diagonal_diagonal.clone(),
            T::one(),
        ),
        pair(
            diagonal_points.clone() * sharing_one.clone(),
            diagonal_diagonal.clone(),
            T::ratio(1, 4),
        ),
        pair(
            diagonal_points.clone() * rest(&diagonal_points, &(equal + sharing_one)),
            diagonal_diagonal,
            T::zero(),
        ),
    ];
    SphericalRule {
        n: n.clone(),
        centre: fifth_degree::centre_weight(n),
        sphere,
        radius_squared: n.clone() + integer(2),
        products,
    }
}

/// Vertices and edge midpoints of a simplex and their mirror images: the rule of liu2017, with a given weight on the midpoints.
///
/// ```text
/// vertex · vertex:      2(n+1) points, each with 2 of (s·t)² = 1, 2n of 1/n²
/// vertex · midpoint:    each vertex meets 2n midpoints of its own edges, (n−1)/(2n), and n(n−1) others, 2/(n(n−1))
/// midpoint · midpoint:  n(n+1) points, each with 2 of 1, 4(n−1) sharing a vertex, ((n−3)/(2(n−1)))²,
///                       and (n−1)(n−2) sharing none, (2/(n−1))²
/// ```
///
/// Source: aᵢ·aₗ = −1/n, b = √(n/(2(n−1))) (aᵢ + aₗ), and counting.
///
/// Example: for every n ≥ 2 at once: liu2017's rule has degree five with the right weight of the midpoints, and none as printed.
///
/// ```
/// use immaculate::rule::sphere::{every_dimension, on_simplex};
/// use immaculate::rule::{printed, simplex};
///
/// let n = every_dimension();
/// assert_eq!(on_simplex(&n, &simplex::edge_weight(&n)).degree(), Some(5));
/// assert_eq!(on_simplex(&n, &printed::edge_weight_11(&n)).degree(), None);
/// assert_eq!(on_simplex(&n, &printed::edge_weight_16(&n)).degree(), None);
/// ```
pub fn on_simplex<T: Field>(n: &T, edge_weight: &T) -> SphericalRule<T> {
    let integer = T::integer;
    let n_minus_1 = n.clone() - T::one();
    let vertices = integer(2) * (n.clone() + T::one());
    let midpoints = n.clone() * (n.clone() + T::one());
    let vertex_weight = simplex::vertex_weight(n);
    let sphere = vertices.clone() * vertex_weight.clone() + midpoints.clone() * edge_weight.clone();
    let vertex = vertex_weight / sphere.clone();
    let midpoint = edge_weight.clone() / sphere.clone();

    let square = |value: T| value.clone() * value;
    let pair = |pairs: T, weights: T, squared: T| InnerProduct {
        pairs,
        weights,
        squared,
    };
    let vertex_vertex = square(vertex.clone());
    let vertex_midpoint = vertex * midpoint.clone();
    let midpoint_midpoint = square(midpoint);
    let two_n = integer(2) * n.clone();
    // Both orders of (vertex, midpoint) are counted by the factor two.
    let products = vec![
        pair(vertices.clone() * integer(2), vertex_vertex.clone(), T::one()),
        pair(
            vertices.clone() * two_n.clone(),
            vertex_vertex,
            square(T::one() / n.clone()),
        ),
        pair(
            integer(2) * vertices.clone() * two_n.clone(),
            vertex_midpoint.clone(),
            n_minus_1.clone() / two_n,
        ),
        pair(
            integer(2) * vertices * n.clone() * n_minus_1.clone(),
            vertex_midpoint,
            integer(2) / (n.clone() * n_minus_1.clone()),
        ),
        pair(midpoints.clone() * integer(2), midpoint_midpoint.clone(), T::one()),
        pair(
            midpoints.clone() * integer(4) * n_minus_1.clone(),
            midpoint_midpoint.clone(),
            square((n.clone() - integer(3)) / (integer(2) * n_minus_1.clone())),
        ),
        pair(
            midpoints * n_minus_1.clone() * (n.clone() - integer(2)),
            midpoint_midpoint,
            square(integer(2) / n_minus_1),
        ),
    ];
    SphericalRule {
        n: n.clone(),
        centre: simplex::centre_weight(n),
        sphere,
        radius_squared: n.clone() + integer(2),
        products,
    }
}

/// The unknown dimension n.
pub fn every_dimension() -> RationalFunction {
    RationalFunction::unknown("n")
}
