//! The fifth-degree simplex rule of liu2017: the centre, the vertices of a regular simplex, the midpoints of its edges, and their
//! mirror images.
//!
//! n² + 3n + 3 points reach the degree of the 2n² + 1 points of [`fifth_degree`](super::fifth_degree). The paper prints their weights
//! three times, and each time wrongly.

use super::{ExactRule, InvalidRule, dimension_as_rational, opposite};
use crate::number::{Field, Rational, Surd};
use num_traits::Zero;
use std::cmp::Ordering;

/// The fifth-degree spherical simplex-radial rule — liu2017 (11), (15).
///
/// ```text
/// ξ = 0;   ±√(n+2) aⱼ, j = 1…n+1;   ±√(n+2) bⱼ, j = 1…n(n+1)/2
/// ```
///
/// | paper | here                  | number    | weight                  |
/// |-------|-----------------------|-----------|-------------------------|
/// | 0     | the centre            | 1         | [`centre_weight`]       |
/// | aⱼ    | ± [`vertices`]        | 2(n + 1)  | [`vertex_weight`]       |
/// | bⱼ    | ± [`edge_midpoints`]  | n(n + 1)  | [`edge_weight`]         |
///
/// Why: Mysovskikh's rule of degree five on the sphere, [`sphere_vertex_weight`] and [`sphere_edge_weight`], times the radial
/// rule, [`radial_rule`].
///
/// Example: for n = 2: the centre, ± three vertices of a triangle, ± its three edge midpoints, at the distance √4.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::simplex::simplex;
///
/// let rule = simplex(2).unwrap();
/// assert_eq!((rule.points.len(), rule.points[1][0].to_string()), (13, "2".to_owned()));
/// // 1/2 + 6 · 5/72 + 6 · 1/72
/// assert_eq!(rule.sum_of_weights(), Rational::new(1, 1));
/// // At n = 4 it has two points less than the fifth-degree rule.
/// assert_eq!(simplex(4).unwrap().points.len(), 31);
/// ```
///
/// Errata: (11) equates the integral and the sum, which are equal to degree five only, and prints half of the edges' weight; see
/// [`edge_weight`].
///
/// # Errors
///
/// [`InvalidRule::Dimension`] below dimension two: (6) divides by n − 1.
///
/// Evidence: `simplex_rule_is_exact_to_degree_five_and_not_six` (exact, n = 2…10),
/// `simplex_rule_has_degree_five_in_every_dimension` (symbolic).
pub fn simplex(n: usize) -> Result<ExactRule, InvalidRule> {
    let n_exact: Rational = dimension_as_rational(n);
    with_weights(
        n,
        &centre_weight(&n_exact),
        &vertex_weight(&n_exact),
        &edge_weight(&n_exact),
    )
}

/// The points of [`simplex`] with the given weights.
pub(super) fn with_weights(
    n: usize,
    centre: &Rational,
    vertex: &Rational,
    edge: &Rational,
) -> Result<ExactRule, InvalidRule> {
    if n < 2 {
        return Err(InvalidRule::Dimension {
            rule: "simplex-5",
            least: 2,
            dimension: n,
            reason: ": liu2017 (6) divides by n - 1",
        });
    }
    let radius = Surd::root(&dimension_as_rational(n + 2));
    let on_radius = |points: Vec<Vec<Surd>>| -> Vec<Vec<Surd>> {
        points
            .into_iter()
            .map(|point| point.into_iter().map(|x| x * radius.clone()).collect())
            .collect()
    };
    let vertices = on_radius(vertices(n));
    let midpoints = on_radius(edge_midpoints(n));
    Ok(ExactRule::from_orbits(
        n,
        vec![
            (centre.clone(), vec![vec![Surd::zero(); n]]),
            (vertex.clone(), vertices.clone()),
            (vertex.clone(), opposite(&vertices)),
            (edge.clone(), midpoints.clone()),
            (edge.clone(), opposite(&midpoints)),
        ],
    ))
}

/// The vertices of the regular simplex — liu2017 (5), (7).
///
/// ```text
///          −√( (n+1) / (n(n−m+2)(n−m+1)) )   m < j
/// aⱼ,ₘ  =   √( (n+1)(n−j+1) / (n(n−j+2)) )   m = j       1 ≤ m ≤ n,  1 ≤ j ≤ n+1
///           0                                m > j
/// ```
///
/// Why: unit vectors with aᵢ·aⱼ = −1/n and Σⱼ aⱼ = 0: as far from each other as n + 1 directions can be.
///
/// Example: for n = 2, an equilateral triangle: (1, 0), (−1/2, √3/2), (−1/2, −√3/2).
///
/// ```
/// use immaculate::number::Surd;
/// use immaculate::rule::simplex::vertices;
///
/// let [a, b, c]: [Vec<Surd>; 3] = vertices(2).try_into().unwrap();
/// assert_eq!([a[0].to_string(), b[0].to_string(), c[0].to_string()], ["1", "-1/2", "-1/2"]);
/// assert_eq!(b[1].clone() + c[1].clone(), a[1]); // √3/2 − √3/2 = 0
/// let product = a[0].clone() * b[0].clone() + a[1].clone() * b[1].clone();
/// assert_eq!(product.to_string(), "-1/2"); // −1/n
/// ```
///
/// Errata: (5) prints the index of the second coordinate as 1 (notational). For j = n + 1 the first branch alone occurs.
///
/// Evidence: `simplex_vertices_are_unit_vectors_with_equal_angles` (exact for n = 2…10, symbolic for all n).
pub fn vertices(n: usize) -> Vec<Vec<Surd>> {
    let n_exact = dimension_as_rational(n);
    let coordinate = |j: usize, m: usize| {
        let m_exact = dimension_as_rational(m);
        match m.cmp(&j) {
            Ordering::Less => -Surd::root(&below_diagonal_squared(&n_exact, &m_exact)),
            Ordering::Equal => Surd::root(&on_diagonal_squared(&n_exact, &m_exact)),
            Ordering::Greater => Surd::zero(),
        }
    };
    (1..=n + 1)
        .map(|j| (1..=n).map(|m| coordinate(j, m)).collect())
        .collect()
}

/// The square of a vertex's coordinate m < j in liu2017 (7): (n + 1) / (n(n − m + 2)(n − m + 1)).
///
/// Example: for n = 2, m = 1: 3/(2 · 3 · 2).
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::simplex::below_diagonal_squared;
///
/// assert_eq!(below_diagonal_squared(&Rational::new(2, 1), &Rational::new(1, 1)), Rational::new(1, 4));
/// ```
pub fn below_diagonal_squared<T: Field>(n: &T, m: &T) -> T {
    let n_minus_m = n.clone() - m.clone();
    (n.clone() + T::one()) / (n.clone() * (n_minus_m.clone() + T::integer(2)) * (n_minus_m + T::one()))
}

/// The square of a vertex's coordinate m = j in liu2017 (7): (n + 1)(n − j + 1) / (n(n − j + 2)).
///
/// Example: for n = 2: the second vertex has 1/4 below the diagonal and 3 · 1/(2 · 2) on it: a unit vector.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::simplex::{below_diagonal_squared, on_diagonal_squared};
///
/// let (n, one, two) = (Rational::new(2, 1), Rational::new(1, 1), Rational::new(2, 1));
/// assert_eq!(on_diagonal_squared(&n, &two), Rational::new(3, 4));
/// assert_eq!(below_diagonal_squared(&n, &one) + on_diagonal_squared(&n, &two), one);
/// ```
pub fn on_diagonal_squared<T: Field>(n: &T, j: &T) -> T {
    let n_minus_j = n.clone() - j.clone();
    (n.clone() + T::one()) * (n_minus_j.clone() + T::one()) / (n.clone() * (n_minus_j + T::integer(2)))
}

/// The midpoints of the simplex's edges, projected to the sphere — liu2017 (6).
///
/// ```text
/// b = √( n / (2(n−1)) ) · (aᵢ + aₗ),   i < l
/// ```
///
/// Why: |aᵢ + aₗ|² = 2 − 2/n, so these are unit vectors. At n = 2 they are the mirror images −aₖ of the third vertex, and the 13
/// points stand at 7 places; at n = 3 the midpoints of opposite edges are mirror images, and the 21 points stand at 15.
///
/// Example: for n = 2: √(2/(2 · 1)) = 1, and a₁ + a₂ = (1 − 1/2, √3/2) = −a₃.
///
/// ```
/// use immaculate::rule::simplex::{edge_midpoints, vertices};
///
/// let (vertices, midpoints) = (vertices(2), edge_midpoints(2));
/// let opposite: Vec<_> = vertices[2].iter().map(|x| -x.clone()).collect();
/// assert_eq!(midpoints[0], opposite);
/// ```
///
/// Evidence: as [`simplex`], `simplex_points_coincide_at_dimension_two` (exact).
pub fn edge_midpoints(n: usize) -> Vec<Vec<Surd>> {
    let vertices = vertices(n);
    let n_exact = dimension_as_rational(n);
    let scale = Surd::root(&(n_exact.clone() / (Rational::new(2, 1) * (n_exact - Rational::new(1, 1)))));
    let mut midpoints = Vec::new();
    for i in 0..=n {
        for l in i + 1..=n {
            let sums = vertices[i].iter().zip(&vertices[l]);
            midpoints.push(
                sums.map(|(a_i, a_l)| scale.clone() * (a_i.clone() + a_l.clone()))
                    .collect(),
            );
        }
    }
    midpoints
}

/// Weight of each vertex on the unit sphere, as a part of its surface — liu2017 (4).
///
/// ```text
/// w_a / Aₙ = n(7 − n) / (2(n+1)²(n+2))
/// ```
///
/// Example: for n = 2: 2 · 5/(2 · 9 · 4) for each of 6 vertices and 2/(2 · 9 · 4) for each of 6 midpoints: the whole sphere.
///
/// ```
/// use immaculate::number::{Field, Rational};
/// use immaculate::rule::simplex::{sphere_edge_weight, sphere_vertex_weight};
///
/// let n = Rational::new(2, 1);
/// assert_eq!(sphere_vertex_weight(&n), Rational::new(5, 36));
/// let six = Rational::integer(6);
/// assert_eq!(six.clone() * sphere_vertex_weight(&n) + six * sphere_edge_weight(&n), Rational::new(1, 1));
/// ```
///
/// Errata: the paper prints (7 − n)n² / (2(n+1)²(n+2)²) here, which already contains the factor n/(n + 2) of the radial rule:
/// it is the weight of the Gaussian, [`vertex_weight`].
///
/// Evidence: `printed_sphere_weights_do_not_sum_to_the_surface` (exact).
pub fn sphere_vertex_weight<T: Field>(n: &T) -> T {
    let n_plus_1 = n.clone() + T::one();
    n.clone() * (T::integer(7) - n.clone())
        / (T::integer(2) * n_plus_1.clone() * n_plus_1 * (n.clone() + T::integer(2)))
}

/// Weight of each edge midpoint on the unit sphere, as a part of its surface — liu2017 (4).
///
/// ```text
/// w_b / Aₙ = 2(n − 1)² / (n(n+1)²(n+2))
/// ```
///
/// Example: for n = 2: 2/(2 · 9 · 4), printed 2/(2 · 9 · 16).
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::{printed, simplex::sphere_edge_weight};
///
/// let n = Rational::new(2, 1);
/// assert_eq!(sphere_edge_weight(&n), Rational::new(1, 36));
/// assert_eq!(printed::sphere_edge_weight(&n), Rational::new(1, 144));
/// ```
///
/// Errata: the paper prints 2(n−1)² / (2(n+1)²(n+2)²).
///
/// Evidence: `printed_sphere_weights_do_not_sum_to_the_surface` (exact).
pub fn sphere_edge_weight<T: Field>(n: &T) -> T {
    let n_minus_1 = n.clone() - T::one();
    let n_plus_1 = n.clone() + T::one();
    T::integer(2) * n_minus_1.clone() * n_minus_1
        / (n.clone() * n_plus_1.clone() * n_plus_1 * (n.clone() + T::integer(2)))
}

/// The radial rule of degree five, for the weight r^(n−1) e^(−r²) — liu2017 (8), (9), (10), (surface-area).
///
/// ```text
/// r₁ = 0,   r₂² = n/2 + 1,   ω₁ = Γ(n/2)/(n+2),   ω₂ = n Γ(n/2)/(2(n+2))
/// ```
///
/// Returned are (ω₁, ω₂, r₂²) with the weights as parts of ½Γ(n/2), the integral of the weight itself; so E r² of the standard
/// Gaussian, in whose variable the radius is √2 r, is 2ω₂r₂².
///
/// Why: two nodes must match l = 0, 2, 4: ω₁ + ω₂ = 1, ω₂r₂² = n/2, ω₂r₂⁴ = (n/2)(n/2 + 1).
///
/// Example: for n = 2: 2/4, 2/4, 2/2 + 1; the moments zero, two and four are 1, n/2 = 1 and (n/2)(n/2 + 1) = 2.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::simplex::radial_rule;
///
/// let (centre, sphere, squared) = radial_rule(&Rational::new(2, 1));
/// assert_eq!(squared, Rational::new(2, 1));
/// assert_eq!(centre + sphere.clone(), Rational::new(1, 1));
/// assert_eq!(sphere.clone() * squared.clone(), Rational::new(1, 1));
/// assert_eq!(sphere * squared.pow(2), Rational::new(2, 1));
/// ```
///
/// Errata: (9) prints r₂⁰ for r₂² in its second row; (10) names both radii r₁ and its sentence calls the rule third-degree. The
/// sphere's surface Aₙ = 2√(πⁿ)/Γ(n/2), which cancels here, is printed as an expression that is 2 for every n.
///
/// Evidence: `radial_rule_matches_the_moments_zero_two_and_four` (symbolic), `printed_radial_second_moment_row_is_violated`,
/// `printed_surface_area_is_two_in_every_dimension`.
pub fn radial_rule<T: Field>(n: &T) -> (T, T, T) {
    let n_plus_2 = n.clone() + T::integer(2);
    let centre = T::integer(2) / n_plus_2.clone();
    let sphere = n.clone() / n_plus_2;
    let radius_squared = n.clone() / T::integer(2) + T::one();
    (centre, sphere, radius_squared)
}

/// Weight of the centre — liu2017 (16): 2/(n + 2), the radial rule's ω₁.
///
/// Example: for n = 2.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::simplex::centre_weight;
///
/// assert_eq!(centre_weight(&Rational::new(2, 1)), Rational::new(1, 2)); // 2/(2 + 2)
/// ```
///
/// Evidence: as [`simplex`].
pub fn centre_weight<T: Field>(n: &T) -> T {
    T::integer(2) / (n.clone() + T::integer(2))
}

/// Weight of each of the 2(n + 1) vertices — liu2017 (16): (7 − n)n² / (2(n+1)²(n+2)²).
///
/// Why: [`sphere_vertex_weight`] times n/(n + 2). Positive for n < 7, zero at n = 7, negative for n > 7.
///
/// Example: for n = 2: 5 · 4/(2 · 9 · 16); n = 8: −1 · 64/(2 · 81 · 100).
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::simplex::vertex_weight;
///
/// assert_eq!(vertex_weight(&Rational::new(2, 1)), Rational::new(5, 72));
/// assert_eq!(vertex_weight(&Rational::new(8, 1)), Rational::new(-8, 2025));
/// ```
///
/// Evidence: as [`simplex`], `signs_of_the_weights_are_as_documented` (exact).
pub fn vertex_weight<T: Field>(n: &T) -> T {
    let n_plus_1 = n.clone() + T::one();
    let n_plus_2 = n.clone() + T::integer(2);
    (T::integer(7) - n.clone()) * n.clone() * n.clone()
        / (T::integer(2) * n_plus_1.clone() * n_plus_1 * n_plus_2.clone() * n_plus_2)
}

/// Weight of each of the n(n + 1) edge midpoints — liu2017 (16): 2(n − 1)² / ((n+1)²(n+2)²).
///
/// Why: [`sphere_edge_weight`] times n/(n + 2).
///
/// Example: for n = 4: 1 centre, 10 vertices, 20 midpoints.
///
/// ```
/// use immaculate::number::{Field, Rational};
/// use immaculate::rule::{printed, simplex};
///
/// let n = Rational::new(4, 1);
/// let vertices = Rational::integer(10) * simplex::vertex_weight(&n);
/// let sum = |edge: Rational| simplex::centre_weight(&n) + vertices.clone() + Rational::integer(20) * edge;
/// // 1/3 + 10 · 2/75 + 20 · 1/50
/// assert_eq!(sum(simplex::edge_weight(&n)), Rational::new(1, 1));
/// // As (11) and (16) print it: 20 · 1/100 and 20 · 1/200 at the end
/// assert_eq!(sum(printed::edge_weight_11(&n)), Rational::new(4, 5));
/// assert_eq!(sum(printed::edge_weight_16(&n)), Rational::new(7, 10));
/// ```
///
/// Errata: (11) prints half of it, with a 2 in the denominator, and (16) an n-th of it, with an n there: the weights then sum to
/// 4/5 and 7/10 at n = 4. See [`printed`](super::printed).
///
/// Evidence: as [`simplex`], `printed_simplex_weights_of_11_break_the_zeroth_moment`,
/// `printed_simplex_weights_of_16_break_the_zeroth_moment` (exact).
pub fn edge_weight<T: Field>(n: &T) -> T {
    let n_minus_1 = n.clone() - T::one();
    let n_plus_1 = n.clone() + T::one();
    let n_plus_2 = n.clone() + T::integer(2);
    T::integer(2) * n_minus_1.clone() * n_minus_1 / (n_plus_1.clone() * n_plus_1 * n_plus_2.clone() * n_plus_2)
}
