//! A proof of joint stability in numbers that can be followed with pencil and paper.
//!
//! A proof about matrices that are not rational, or have many digits, becomes one about fractions: each matrix is replaced by a short
//! decimal one, C, and a bound of the distance, and the inequalities get the slack that the distance may cost.

use super::certificate::{Edge, Quadratics};
use super::closed_loops::{BITS, ClosedLoops, Entries};
use super::pair::product;
use super::polynomial::{MatrixRows, characteristic_polynomial, rows_of};
use super::search::of_any_side;
use crate::matrix::{Holds, Shapes, ldl};
use crate::number::{Enclosure, Field, Rational};
use nalgebra::{DMatrix, Dim, OMatrix};
use num_traits::Zero;

/// The inequalities of a proof by forms, for every matrix within a distance of given ones.
#[derive(Debug, Clone, PartialEq)]
pub struct ByHand {
    /// C, one a mode.
    pub matrices: Vec<DMatrix<Rational>>,
    /// No entry of A is farther than this from that of C; zero where they are equal.
    pub distance: Rational,
    /// The pivots of each form.
    pub forms: Vec<Vec<Rational>>,
    /// The inequality of each edge.
    pub edges: Vec<Decrease>,
}

/// One inequality: Pᵤ − AᵀPᵥA ⪰ Pᵤ − CᵀPᵥC − δI ≻ 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Decrease {
    /// From node, letter, to node.
    pub edge: Edge,
    /// δ.
    pub slack: Rational,
    /// Pᵤ − CᵀPᵥC − δI.
    pub matrix: DMatrix<Rational>,
    /// Its pivots, all positive.
    pub pivots: Vec<Rational>,
}

/// The most digits after the point that are tried.
const MOST_DIGITS: u32 = 15;

impl ByHand {
    /// The shortest such proof by given forms; none if they prove nothing with the digits that are tried.
    ///
    /// Example: one number, 1/2, and P = 1: 1 − 1/4 = 3/4.
    ///
    /// ```
    /// use immaculate::number::Rational;
    /// use immaculate::steady::{by_hand::ByHand, certificate::{Edge, Quadratics}, closed_loops::{ClosedLoops, Entries}};
    /// use nalgebra::matrix;
    ///
    /// let half = ClosedLoops::new(Entries::Exact(vec![matrix![Rational::new(1, 2)]]));
    /// let form = Quadratics { edges: Edge::memory(1, 0), forms: vec![matrix![Rational::new(1, 1)]] };
    /// let proof = ByHand::new(&half, &form).unwrap();
    /// assert_eq!(proof.edges[0].pivots, [Rational::new(3, 4)]);
    /// ```
    ///
    /// Evidence: `a_proof_by_hand_holds_for_every_matrix_within_its_distance` (exact).
    pub fn new<N: Dim>(loops: &ClosedLoops<N>, forms: &Quadratics<N>) -> Option<Self>
    where
        Shapes: Holds<N>,
    {
        match &loops.matrices {
            Entries::Exact(matrices) => {
                Self::within(matrices.iter().map(of_any_side).collect(), Rational::integer(0), forms)
            }
            Entries::Enclosed(matrices) => (1..=MOST_DIGITS).find_map(|digits| {
                let distance = Rational::new(1, 10).pow(digits);
                let short = |a: &OMatrix<Enclosure, N, N>| near(a, digits, &distance);
                let short: Option<Vec<_>> = Enclosure::with_precision(BITS, || matrices.iter().map(short).collect());
                Self::within(short?, distance, forms)
            }),
        }
    }

    fn within<N: Dim>(matrices: Vec<DMatrix<Rational>>, distance: Rational, forms: &Quadratics<N>) -> Option<Self>
    where
        Shapes: Holds<N>,
    {
        let all: Vec<_> = forms.forms.iter().map(of_any_side).collect();
        let decrease = |edge: &Edge| {
            let (c, from, to) = (&matrices[edge.letter], &all[edge.from], &all[edge.to]);
            let slack = slack(c, to, &distance);
            let mut matrix = from - c.transpose() * to * c;
            for i in 0..matrix.nrows() {
                matrix[(i, i)] -= slack.clone();
            }
            let pivots = positive_pivots(&matrix)?;
            let edge = *edge;
            Some(Decrease {
                edge,
                slack,
                matrix,
                pivots,
            })
        };
        Some(Self {
            forms: all.iter().map(positive_pivots).collect::<Option<_>>()?,
            edges: forms.edges.iter().map(decrease).collect::<Option<_>>()?,
            matrices,
            distance,
        })
    }
}

/// The pivots of a matrix if all are positive.
fn positive_pivots(matrix: &DMatrix<Rational>) -> Option<Vec<Rational>> {
    let pivots: Vec<_> = ldl(matrix).diagonal.iter().cloned().collect();
    pivots.iter().all(Rational::is_positive).then_some(pivots)
}

/// The decimals with `digits` digits after the point that are nearest to the entries; none if one is farther than a distance.
fn near<N: Dim>(matrix: &OMatrix<Enclosure, N, N>, digits: u32, distance: &Rational) -> Option<DMatrix<Rational>>
where
    Shapes: Holds<N>,
{
    let short = matrix.map(|entry| {
        let text = Rational::from_f64(entry.middle()).to_decimal(digits);
        Rational::from_decimal(&text).unwrap_or_else(Rational::undecided)
    });
    let is_near = matrix.iter().zip(short.iter()).all(|(entry, short)| {
        let difference = entry.clone() - Enclosure::rational(short);
        let bound = Enclosure::rational(distance);
        difference <= bound && difference >= -bound
    });
    is_near.then(|| of_any_side(&short))
}

/// How much AᵀPA can be above CᵀPC if no entry of D = A − C is beyond ε.
///
/// ```text
/// AᵀPA − CᵀPC = CᵀPD + DᵀPC + DᵀPD ⪯ δI,   δ = ε (n maxᵢ Σₖ|(CᵀP)ᵢₖ| + Σᵢₖ|(CᵀP)ᵢₖ|) + ε² n Σᵢₖ|Pᵢₖ|
/// ```
///
/// Why: no eigenvalue of a symmetric matrix is above the greatest sum of the magnitudes of a row. A row of CᵀPD sums to at most n ε times
/// that of CᵀP, a row of its transpose to at most ε times the sum of all entries of CᵀP, and a row of DᵀPD to at most n ε² times that of P.
///
/// Example: 1/2 ± 1/10 with P = 1: 0.1 · (1/2 + 1/2) + 0.01, and indeed 0.6² = 0.25 + 0.11.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::by_hand::slack;
/// use nalgebra::dmatrix;
///
/// let q = Rational::new;
/// assert_eq!(slack(&dmatrix![q(1, 2)], &dmatrix![q(1, 1)], &q(1, 10)), q(11, 100));
/// ```
///
/// Evidence: `a_proof_by_hand_holds_for_every_matrix_within_its_distance` (exact).
pub fn slack(c: &DMatrix<Rational>, form: &DMatrix<Rational>, distance: &Rational) -> Rational {
    let rows = |matrix: &DMatrix<Rational>| -> Vec<Rational> {
        let sum = |i: usize| {
            matrix
                .row(i)
                .iter()
                .fold(Rational::zero(), |sum, entry| sum + entry.abs())
        };
        (0..matrix.nrows()).map(sum).collect()
    };
    let sum = |rows: &[Rational]| rows.iter().cloned().fold(Rational::zero(), |sum, row| sum + row);
    let n = Rational::from_f64(c.nrows() as f64);
    let (own, of_form) = (rows(&(c.transpose() * form)), rows(form));
    let greatest = own
        .iter()
        .cloned()
        .fold(Rational::zero(), |a, b| if b > a { b } else { a });
    distance * (n.clone() * greatest + sum(&own)) + distance * distance.clone() * n * sum(&of_form)
}

/// What shows that a product has a spectral radius of at least a bound r.
#[derive(Debug, Clone, PartialEq)]
pub struct Growth<T> {
    /// The product.
    pub product: MatrixRows<T>,
    /// Its characteristic polynomial p, from λ⁰ up.
    pub polynomial: Vec<T>,
    /// ±r with p(±r), where the sign of p shows a root beyond: p(r) ≤ 0, or (−1)ⁿ p(−r) ≤ 0. None where the root is not real, and the
    /// Schur-Cohn test alone decides.
    pub beyond: Option<(Rational, T)>,
}

impl<T: Field + PartialOrd> Growth<T> {
    /// What a word shows of a bound.
    ///
    /// Why: p is monic, so that it tends to infinity with λ; where p(r) is not positive a root lies at r or above it. Likewise below −r.
    ///
    /// Example: the number −3/2, and 5/4: p = λ + 3/2 is 1/4 at −5/4, so that a root is below.
    ///
    /// ```
    /// use immaculate::number::Rational;
    /// use immaculate::steady::by_hand::Growth;
    /// use nalgebra::matrix;
    ///
    /// let q = Rational::new;
    /// let growth = Growth::new(&[0], &[matrix![q(-3, 2)]], &q(5, 4));
    /// assert_eq!(growth.beyond, Some((q(-5, 4), q(1, 4))));
    /// ```
    pub fn new<N: Dim>(word: &[usize], matrices: &[OMatrix<T, N, N>], bound: &Rational) -> Self
    where
        Shapes: Holds<N>,
    {
        let product = rows_of(&product(word, matrices));
        let polynomial = characteristic_polynomial(&product);
        let is_odd = product.len() % 2 == 1;
        let at = |place: Rational, turns: bool| {
            let start = T::zero();
            let x = T::rational(&place);
            let value = polynomial
                .iter()
                .rev()
                .fold(start, |sum, c| sum * x.clone() + c.clone());
            let signed = if turns { -value.clone() } else { value.clone() };
            (signed <= T::zero()).then_some((place, value))
        };
        let beyond = at(bound.clone(), false).or_else(|| at(-bound.clone(), is_odd));
        Self {
            product,
            polynomial,
            beyond,
        }
    }
}
