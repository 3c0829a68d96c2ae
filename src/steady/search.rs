//! The search for certificates, in doubles: what it finds is worth nothing until [`super::certificate`] has checked it.
//!
//! After this file the reader knows how a product that grows is found (by trying), and how quadratic forms that shrink are found: as the
//! point farthest inside a convex set, by Newton's method on a barrier. A library for semidefinite programming would bring a linear algebra
//! library in another language with it; the sets here have a few dozen unknowns.

use super::certificate::{Edge, Product, Quadratics};
use super::linear::stein;
use super::pair::product;
use crate::number::{Field, Rational, Real};
use nalgebra::{DMatrix, DVector, SMatrix};

/// The unknowns of one 3 × 3 form: its lower triangle.
const UNKNOWNS: usize = 6;
const TRIANGLE: [(usize, usize); UNKNOWNS] = [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)];

type Matrix = SMatrix<f64, 3, 3>;

/// The spectral radius of a matrix, from the norm of its 2³⁹-th power.
pub fn spectral_radius<const N: usize>(matrix: &SMatrix<f64, N, N>) -> f64 {
    let mut power = *matrix;
    let (mut logarithm, mut weight) = (0.0, 1.0);
    for _ in 0..40 {
        let size = power.amax();
        if size == 0.0 || !size.is_finite() {
            return size;
        }
        logarithm += weight * Real::ln(&size);
        power /= size;
        power *= power;
        weight /= 2.0;
    }
    Real::exp(&logarithm)
}

/// The word of at most a length whose product grows most a letter, and its growth a letter; only words that are no power of a shorter one
/// and come first among their rotations, which have the same spectral radius.
pub fn fastest_word<const N: usize>(matrices: &[SMatrix<f64, N, N>], longest: usize) -> (Vec<usize>, f64) {
    let mut best = (vec![0], 0.0);
    // Duval's order of the Lyndon words.
    let mut word = vec![0];
    while !word.is_empty() {
        let growth = Real::exp(&(Real::ln(&spectral_radius(&product(&word, matrices))) / word.len() as f64));
        if growth > best.1 * (1.0 + 1e-12) {
            best = (word.clone(), growth);
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
pub fn fastest_runs<const N: usize>(matrices: &[SMatrix<f64, N, N>; 2], longest: usize) -> (Vec<usize>, f64) {
    let powers = matrices.map(|matrix| {
        let next = |power: &SMatrix<f64, N, N>| Some(power * matrix);
        std::iter::successors(Some(matrix), next)
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

/// A certificate of growth with a short bound, from a word and its growth a letter; none if the growth is too near one to be told.
pub fn product_certificate(word: Vec<usize>, growth: f64) -> Option<Product> {
    let length = word.len() as f64;
    let radius = Real::exp(&(Real::ln(&growth) * length));
    // A bound halfway down to one, with two digits more than it needs.
    let digits = (1..15).find(|digits| (radius - 1.0) * power_of_ten(*digits) > 20.0)?;
    let bound = ((1.0 + (radius - 1.0) / 2.0) * power_of_ten(digits)).floor();
    let radius = Rational::from_f64(bound) / Rational::integer(10).pow(digits);
    Some(Product { word, radius })
}

fn power_of_ten(exponent: u32) -> f64 {
    (0..exponent).fold(1.0, |power, _| power * 10.0)
}

/// Quadratic forms on a graph, rounded to the smallest integers that `check` accepts; none if there seem to be none.
pub fn quadratics(
    matrices: &[Matrix],
    edges: &[Edge],
    check: impl Fn(&Quadratics<3>) -> bool,
) -> Option<Quadratics<3>> {
    let forms = forms(matrices, edges)?;
    let greatest = forms.iter().map(Matrix::amax).fold(0.0, f64::max);
    let scales = (1..16).flat_map(|digits| [1.0, 2.0, 5.0].map(|factor| factor * power_of_ten(digits)));
    scales
        .map(|scale| Quadratics {
            edges: edges.to_vec(),
            forms: forms.iter().map(|form| in_integers(form, scale / greatest)).collect(),
        })
        .find(check)
}

fn in_integers(form: &Matrix, scale: f64) -> SMatrix<Rational, 3, 3> {
    form.map(|entry| Rational::from_f64((entry * scale).round()))
}

/// Forms that every edge makes smaller by the greatest margin; none if there are none.
fn forms(matrices: &[Matrix], edges: &[Edge]) -> Option<Vec<Matrix>> {
    let coordinates = coordinates(matrices)?;
    let back = coordinates.try_inverse()?;
    let matrices: Vec<Matrix> = matrices.iter().map(|matrix| coordinates * matrix * back).collect();
    let found = Barrier::new(&matrices, edges).maximise()?;
    let forms = found.iter().map(|form| coordinates.transpose() * form * coordinates);
    Some(forms.map(|form| (form + form.transpose()) / 2.0).collect())
}

/// Coordinates in which each matrix by itself shrinks vectors, as far as one change of coordinates can have it: the root of the sum of
/// their Lyapunov matrices.
fn coordinates(matrices: &[Matrix]) -> Option<Matrix> {
    let mut sum = Matrix::zeros();
    for matrix in matrices {
        sum += stein(&matrix.transpose(), &Matrix::identity())?;
    }
    Some(crate::matrix::cholesky(&sum).ok()?.transpose())
}

/// A matrix that depends on some of the unknowns, C₀ + Σ xᵢ Cᵢ, and is to stay positive definite.
struct Constraint {
    constant: Matrix,
    terms: Vec<(usize, Matrix)>,
}

impl Constraint {
    fn at(&self, x: &DVector<f64>) -> Matrix {
        self.terms
            .iter()
            .fold(self.constant, |sum, (index, matrix)| sum + matrix * x[*index])
    }
}

/// The convex set: forms between 0 and I, and a margin t by which every edge makes them smaller.
struct Barrier {
    nodes: usize,
    constraints: Vec<Constraint>,
    start: DVector<f64>,
}

impl Barrier {
    fn new(matrices: &[Matrix], edges: &[Edge]) -> Self {
        let nodes = edges.iter().map(|edge| edge.from + 1).max().unwrap_or(0);
        let margin = nodes * UNKNOWNS;
        let form = |node: usize, of: &dyn Fn(Matrix) -> Matrix| {
            let term = |(k, (i, j)): (usize, (usize, usize))| {
                let mut basis = Matrix::zeros();
                basis[(i, j)] = 1.0;
                basis[(j, i)] = 1.0;
                (node * UNKNOWNS + k, of(basis))
            };
            TRIANGLE.into_iter().enumerate().map(term).collect::<Vec<_>>()
        };
        let mut constraints = Vec::new();
        for node in 0..nodes {
            let zero = Matrix::zeros();
            constraints.push(Constraint {
                constant: zero,
                terms: form(node, &|basis| basis),
            });
            constraints.push(Constraint {
                constant: Matrix::identity(),
                terms: form(node, &|basis| -basis),
            });
        }
        let mut start = DVector::zeros(margin + 1);
        for edge in edges {
            let a = &matrices[edge.letter];
            let mut terms = form(edge.from, &|basis| basis);
            for (index, matrix) in form(edge.to, &|basis| -a.transpose() * basis * a) {
                match terms.iter_mut().find(|(own, _)| *own == index) {
                    Some((_, own)) => *own += matrix,
                    None => terms.push((index, matrix)),
                }
            }
            terms.push((margin, -Matrix::identity()));
            constraints.push(Constraint {
                constant: Matrix::zeros(),
                terms,
            });
            // ½ I is inside with this margin.
            start[margin] = f64::min(start[margin], -1.0 - a.norm_squared());
        }
        for node in 0..nodes {
            for k in [0, 2, 5] {
                start[node * UNKNOWNS + k] = 0.5;
            }
        }
        Self {
            nodes,
            constraints,
            start,
        }
    }

    /// Follows the central path until the margin is positive and half of what it can be, or known to stay negative.
    fn maximise(&self) -> Option<Vec<Matrix>> {
        let (mut x, margin) = (self.start.clone(), self.start.len() - 1);
        let gap = 3.0 * self.constraints.len() as f64;
        let mut weight = 1.0;
        while weight < 1e13 {
            x = self.centre(x, weight)?;
            if x[margin] > gap / weight {
                return Some((0..self.nodes).map(|node| form_of(&x, node)).collect());
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
            let root = constraint.at(x).cholesky()?;
            value -= 2.0 * root.l_dirty().diagonal().iter().map(Real::ln).sum::<f64>();
        }
        Some(value)
    }

    fn derivatives(&self, x: &DVector<f64>, weight: f64) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let mut gradient = DVector::zeros(x.len());
        gradient[x.len() - 1] = -weight;
        let mut hessian = DMatrix::zeros(x.len(), x.len());
        for constraint in &self.constraints {
            let inverse = constraint.at(x).try_inverse()?;
            let parts: Vec<(usize, Matrix)> = constraint.terms.iter().map(|(i, c)| (*i, inverse * c)).collect();
            for (i, left) in &parts {
                gradient[*i] -= left.trace();
                for (j, right) in &parts {
                    hessian[(*i, *j)] += left.component_mul(&right.transpose()).sum();
                }
            }
        }
        Some((gradient, hessian))
    }
}

fn form_of(x: &DVector<f64>, node: usize) -> Matrix {
    let mut form = Matrix::zeros();
    for (k, (i, j)) in TRIANGLE.into_iter().enumerate() {
        form[(i, j)] = x[node * UNKNOWNS + k];
        form[(j, i)] = x[node * UNKNOWNS + k];
    }
    form
}
