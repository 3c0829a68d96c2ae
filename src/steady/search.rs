//! The search for certificates, in doubles: its results count only after [`super::certificate`] has checked them.
//!
//! Trial finds a product that grows. Quadratic forms that shrink are found as the point farthest inside a convex set, by Newton's method
//! on a barrier. A library for semidefinite programming would bring a linear algebra library in another language with it; the sets here
//! have a few dozen unknowns.

use super::certificate::{Edge, Product, Quadratics};
use super::pair::product;
use crate::matrix::{Holds, Shapes, rows};
use crate::number::{Field, Rational, Real};
use nalgebra::{DMatrix, DVector, Dim, OMatrix};

/// The spectral radius of a matrix, from the norm of its 2³⁹-th power.
pub fn spectral_radius<N: Dim>(matrix: &OMatrix<f64, N, N>) -> f64
where
    Shapes: Holds<N>,
{
    let mut power = matrix.clone();
    let (mut logarithm, mut weight) = (0.0, 1.0);
    for _ in 0..40 {
        let size = power.amax();
        if size == 0.0 || !size.is_finite() {
            return size;
        }
        logarithm += weight * Real::ln(&size);
        power /= size;
        power = &power * &power;
        weight /= 2.0;
    }
    Real::exp(&logarithm)
}

/// The word of at most a length whose product grows most a letter, and its growth a letter; only words that are no power of a shorter one
/// and come first among their rotations, which have the same spectral radius.
pub fn fastest_word<N: Dim>(matrices: &[OMatrix<f64, N, N>], longest: usize) -> (Vec<usize>, f64)
where
    Shapes: Holds<N>,
{
    fastest_allowed_word(matrices, longest, |_| true)
}

/// The same among the words that are allowed.
pub fn fastest_allowed_word<N: Dim>(
    matrices: &[OMatrix<f64, N, N>],
    longest: usize,
    is_allowed: impl Fn(&[usize]) -> bool,
) -> (Vec<usize>, f64)
where
    Shapes: Holds<N>,
{
    let mut best = (vec![0], 0.0);
    // Duval's order of the Lyndon words.
    let mut word = vec![0];
    while !word.is_empty() {
        if is_allowed(&word) {
            let growth = Real::exp(&(Real::ln(&spectral_radius(&product(&word, matrices))) / word.len() as f64));
            if growth > best.1 * (1.0 + 1e-12) {
                best = (word.clone(), growth);
            }
        }
        let period = word.len();
        while word.len() < longest {
            word.push(word[word.len() - period]);
        }
        while word.last() == Some(&(matrices.len() - 1)) {
            word.pop();
        }
        if let Some(last) = word.last_mut() {
            *last += 1;
        }
    }
    best
}

/// The word of a run of the first matrix and a run of the second whose product grows most a letter, and its growth a letter: what slow
/// filters need, whose shortest growing products are long.
pub fn fastest_runs<N: Dim>(matrices: [&OMatrix<f64, N, N>; 2], longest: usize) -> (Vec<usize>, f64)
where
    Shapes: Holds<N>,
{
    let powers = matrices.map(|matrix| {
        let next = |power: &OMatrix<f64, N, N>| Some(power * matrix);
        std::iter::successors(Some(matrix.clone()), next)
            .take(longest)
            .collect::<Vec<_>>()
    });
    let mut best = (Vec::new(), 0.0);
    for (i, first) in (1..=longest).zip(&powers[0]) {
        for (j, second) in (1..=longest).zip(&powers[1]) {
            let growth = Real::exp(&(Real::ln(&spectral_radius(&(second * first))) / (i + j) as f64));
            if growth > best.1 {
                best = (vec![(0, i), (1, j)], growth);
            }
        }
    }
    let runs = best.0.iter();
    (
        runs.flat_map(|(letter, length)| vec![*letter; *length]).collect(),
        best.1,
    )
}

/// A certificate of growth from a word and its growth a letter; none if the growth is too near one to be certified.
///
/// The bound has three digits of what the spectral radius is above one, and is below it by one or two units of the last: short, and tight.
pub fn product_certificate(word: Vec<usize>, growth: f64) -> Option<Product> {
    let length = word.len() as f64;
    let radius = Real::exp(&(Real::ln(&growth) * length));
    let digits = (2..15).find(|digits| (radius - 1.0) * power_of_ten(*digits) > 100.0)?;
    let bound = (radius * power_of_ten(digits) - 1.0).floor();
    let radius = Rational::from_f64(bound) / Rational::integer(10).pow(digits);
    Some(Product { word, radius })
}

fn power_of_ten(exponent: u32) -> f64 {
    (0..exponent).fold(1.0, |power, _| power * 10.0)
}

/// Quadratic forms on a graph, rounded to the smallest integers that `check` accepts; none if there seem to be none.
pub fn quadratics<N: Dim>(
    matrices: &[OMatrix<f64, N, N>],
    edges: &[Edge],
    check: impl Fn(&Quadratics<N>) -> bool,
) -> Option<Quadratics<N>>
where
    Shapes: Holds<N>,
{
    let forms = forms(matrices, edges)?;
    let greatest = forms.iter().map(OMatrix::amax).fold(0.0, f64::max);
    let scales = (1..16).flat_map(|digits| [1.0, 2.0, 5.0].map(|factor| factor * power_of_ten(digits)));
    scales
        .map(|scale| Quadratics {
            edges: edges.to_vec(),
            forms: forms.iter().map(|form| in_integers(form, scale / greatest)).collect(),
        })
        .find(check)
}

fn in_integers<N: Dim>(form: &OMatrix<f64, N, N>, scale: f64) -> OMatrix<Rational, N, N>
where
    Shapes: Holds<N>,
{
    form.map(|entry| Rational::from_f64((entry * scale).round()))
}

/// Forms that every edge makes smaller by the greatest margin; none if there are none.
fn forms<N: Dim>(matrices: &[OMatrix<f64, N, N>], edges: &[Edge]) -> Option<Vec<OMatrix<f64, N, N>>>
where
    Shapes: Holds<N>,
{
    let side = rows(matrices.first()?);
    let matrices: Vec<DMatrix<f64>> = matrices.iter().map(of_any_side).collect();
    let coordinates = coordinates(&matrices)?;
    let back = coordinates.clone().try_inverse()?;
    let matrices: Vec<DMatrix<f64>> = matrices.iter().map(|matrix| &coordinates * matrix * &back).collect();
    let found = Barrier::new(&matrices, edges).maximise()?;
    let forms = found.iter().map(|form| coordinates.transpose() * form * &coordinates);
    let forms = forms.map(|form| (&form + form.transpose()) / 2.0);
    Some(
        forms
            .map(|form| OMatrix::from_fn_generic(side, side, |i, j| form[(i, j)]))
            .collect(),
    )
}

/// The same matrix, its side a number.
pub(super) fn of_any_side<T: Field, N: Dim>(matrix: &OMatrix<T, N, N>) -> DMatrix<T>
where
    Shapes: Holds<N>,
{
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)].clone())
}

/// Coordinates in which each matrix by itself shrinks vectors, as far as one change of coordinates can have it: the root of the sum of
/// their Lyapunov matrices.
fn coordinates(matrices: &[DMatrix<f64>]) -> Option<DMatrix<f64>> {
    let mut sum = DMatrix::zeros(matrices[0].nrows(), matrices[0].nrows());
    for matrix in matrices {
        sum += lyapunov(matrix)?;
    }
    Some(crate::matrix::cholesky(&sum).ok()?.transpose())
}

/// Σ (Aᵏ)ᵀ Aᵏ, twice as many terms each time; none if it has no limit.
fn lyapunov(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    if spectral_radius(matrix) >= 1.0 {
        return None;
    }
    let (mut power, mut sum) = (matrix.clone(), DMatrix::identity(matrix.nrows(), matrix.nrows()));
    while power.amax() > 1e-30 {
        sum += power.transpose() * &sum * &power;
        power = &power * &power;
    }
    sum.iter().all(|entry| entry.is_finite()).then_some(sum)
}

/// A part of a constraint, s · Tᵀ Pᵤ T of the form Pᵤ of a node.
struct Part {
    node: usize,
    transformed: DMatrix<f64>,
    sign: f64,
}

/// A matrix that depends on some of the forms, C₀ + Σ s Tᵀ Pᵤ T − w t I, and is to stay positive definite.
struct Constraint {
    constant: f64,
    parts: Vec<Part>,
    /// Whether the margin t is taken away.
    has_margin: bool,
}

/// The convex set: forms between 0 and I, and a margin t by which every edge makes them smaller.
///
/// The unknowns are the lower triangles of the forms, one after the other, and t.
struct Barrier {
    side: usize,
    nodes: usize,
    constraints: Vec<Constraint>,
    start: DVector<f64>,
}

/// The places of the lower triangle.
fn triangle(side: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..side).flat_map(|i| (0..=i).map(move |j| (i, j)))
}

impl Barrier {
    fn new(matrices: &[DMatrix<f64>], edges: &[Edge]) -> Self {
        let side = matrices[0].nrows();
        let identity = || DMatrix::identity(side, side);
        let nodes = edges.iter().map(|edge| edge.from + 1).max().unwrap_or(0);
        let unknowns = side * (side + 1) / 2;
        let margin = nodes * unknowns;
        let mut start = DVector::zeros(margin + 1);
        let part = |node: usize, transformed: DMatrix<f64>, sign: f64| Part {
            node,
            transformed,
            sign,
        };
        let mut constraints = Vec::new();
        for node in 0..nodes {
            for (constant, sign) in [(0.0, 1.0), (1.0, -1.0)] {
                constraints.push(Constraint {
                    constant,
                    parts: vec![part(node, identity(), sign)],
                    has_margin: false,
                });
            }
            for (k, _) in triangle(side).enumerate().filter(|(_, (i, j))| i == j) {
                start[node * unknowns + k] = 0.5;
            }
        }
        for edge in edges {
            let a = &matrices[edge.letter];
            constraints.push(Constraint {
                constant: 0.0,
                parts: vec![part(edge.from, identity(), 1.0), part(edge.to, a.clone(), -1.0)],
                has_margin: true,
            });
            // ½ I is inside with this margin.
            start[margin] = f64::min(start[margin], -1.0 - a.norm_squared());
        }
        Self {
            side,
            nodes,
            constraints,
            start,
        }
    }

    /// The unknowns of one form.
    fn unknowns(&self) -> usize {
        self.side * (self.side + 1) / 2
    }

    fn form(&self, x: &DVector<f64>, node: usize) -> DMatrix<f64> {
        let mut form = DMatrix::zeros(self.side, self.side);
        for (k, (i, j)) in triangle(self.side).enumerate() {
            form[(i, j)] = x[node * self.unknowns() + k];
            form[(j, i)] = form[(i, j)];
        }
        form
    }

    /// What a constraint keeps positive definite.
    fn at(&self, constraint: &Constraint, x: &DVector<f64>) -> DMatrix<f64> {
        let margin = if constraint.has_margin { x[x.len() - 1] } else { 0.0 };
        let start = DMatrix::from_diagonal_element(self.side, self.side, constraint.constant - margin);
        constraint.parts.iter().fold(start, |sum, part| {
            sum + part.transformed.transpose() * self.form(x, part.node) * &part.transformed * part.sign
        })
    }

    /// Follows the central path until the margin is positive and half of what it can be, or known to stay negative.
    fn maximise(&self) -> Option<Vec<DMatrix<f64>>> {
        let (mut x, margin) = (self.start.clone(), self.start.len() - 1);
        let gap = (self.side * self.constraints.len()) as f64;
        let mut weight = 1.0;
        while weight < 1e13 {
            x = self.centre(x, weight)?;
            if x[margin] > gap / weight {
                return Some((0..self.nodes).map(|node| self.form(&x, node)).collect());
            }
            if x[margin] + gap / weight < 0.0 {
                return None;
            }
            weight *= 5.0;
        }
        None
    }

    /// Newton's method on −weight · margin − Σ ln det.
    fn centre(&self, mut x: DVector<f64>, weight: f64) -> Option<DVector<f64>> {
        for _ in 0..40 {
            let (gradient, hessian) = self.derivatives(&x, weight)?;
            let step = hessian.cholesky()?.solve(&-&gradient);
            let decrement = -gradient.dot(&step);
            if decrement < 1e-6 {
                break;
            }
            let value = self.value(&x, weight)?;
            let mut length = 1.0;
            let next = loop {
                let candidate = &x + &step * length;
                match self.value(&candidate, weight) {
                    Some(found) if found <= value - 0.1 * length * decrement => break candidate,
                    _ if length < 1e-12 => return Some(x),
                    _ => length /= 2.0,
                }
            };
            x = next;
        }
        Some(x)
    }

    fn value(&self, x: &DVector<f64>, weight: f64) -> Option<f64> {
        let mut value = -weight * x[x.len() - 1];
        for constraint in &self.constraints {
            let root = self.at(constraint, x).cholesky()?;
            value -= 2.0 * root.l_dirty().diagonal().iter().map(Real::ln).sum::<f64>();
        }
        Some(value)
    }

    /// Gradient and Hessian.
    ///
    /// With W the inverse of a constraint's matrix, G = T W T′ᵀ for two of its parts and E = eᵢeⱼᵀ + eⱼeᵢᵀ for an unknown, the derivatives
    /// of −ln det are −s tr(E G) and s s′ tr(E G E′ Gᵀ): a few entries of G each.
    fn derivatives(&self, x: &DVector<f64>, weight: f64) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let (unknowns, margin) = (self.unknowns(), x.len() - 1);
        let places: Vec<(usize, usize)> = triangle(self.side).collect();
        // An entry of the diagonal stands in a form once, another twice.
        let share = |(i, j): (usize, usize)| if i == j { 0.5 } else { 1.0 };
        let mut gradient = DVector::zeros(x.len());
        gradient[margin] = -weight;
        let mut hessian = DMatrix::zeros(x.len(), x.len());
        for constraint in &self.constraints {
            let inverse = self.at(constraint, x).try_inverse()?;
            if constraint.has_margin {
                gradient[margin] += inverse.trace();
                hessian[(margin, margin)] += inverse.norm_squared();
            }
            for first in &constraint.parts {
                let left = &first.transformed * &inverse;
                let (own, square) = (&left * first.transformed.transpose(), &left * left.transpose());
                for (k, &(i, j)) in places.iter().enumerate() {
                    let at = first.node * unknowns + k;
                    let factor = 2.0 * share((i, j)) * first.sign;
                    gradient[at] -= factor * own[(i, j)];
                    if constraint.has_margin {
                        hessian[(at, margin)] -= factor * square[(i, j)];
                        hessian[(margin, at)] -= factor * square[(i, j)];
                    }
                }
                for second in &constraint.parts {
                    let g = &left * second.transformed.transpose();
                    let sign = 2.0 * first.sign * second.sign;
                    for (k, &(i, j)) in places.iter().enumerate() {
                        let row = first.node * unknowns + k;
                        for (l, &(a, b)) in places.iter().enumerate() {
                            let both = g[(i, a)] * g[(j, b)] + g[(i, b)] * g[(j, a)];
                            hessian[(row, second.node * unknowns + l)] += sign * share((i, j)) * share((a, b)) * both;
                        }
                    }
                }
            }
        }
        Some((gradient, hessian))
    }
}
