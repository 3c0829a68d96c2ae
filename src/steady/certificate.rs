//! Certificates of joint stability and instability: small facts that decide the question and that anyone can check.
//!
//! One kind proves that filters stay stable however they are switched; the other proves that they do not. Checking takes a few
//! multiplications and pivots in exact or enclosing arithmetic, and does not trust the search that found the certificate.
//!
//! | certificate  | says                                                                 | is checked by                              |
//! |--------------|----------------------------------------------------------------------|--------------------------------------------|
//! | [`Quadratics`] | the joint spectral radius is below one                               | a positive definite matrix an edge          |
//! | [`Product`]  | it is above one                                                       | the Schur-Cohn test of one product          |

use super::pair::product;
use super::polynomial::{has_radius_below, rows_of};
use crate::matrix::{Holds, NotPositiveDefinite, Shapes, check_positive_definite, is_symmetric, ldl};
use crate::number::{Field, Rational};
use nalgebra::{Dim, OMatrix, U3};

/// An edge of a graph: from a node, by one of the matrices, to a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Edge {
    /// The node it leaves.
    pub from: usize,
    /// The matrix, counted from 0.
    pub letter: usize,
    /// The node it reaches.
    pub to: usize,
}

impl Edge {
    /// The graph with one node for each word of a length and an edge for each letter, to the word without its first letter and with the new
    /// one: forms that remember the last letters.
    ///
    /// Source: de Bruijn 1946; Lee and Dullerud 2006.
    ///
    /// Example: two letters, one remembered: a node is the last letter, and every edge leads to the node of its own letter.
    ///
    /// ```
    /// use immaculate::steady::certificate::Edge;
    ///
    /// let edges = Edge::memory(2, 1);
    /// assert_eq!(edges.len(), 4);
    /// assert!(edges.iter().all(|edge| edge.to == edge.letter));
    /// ```
    pub fn memory(letters: usize, length: u32) -> Vec<Self> {
        let nodes = letters.pow(length);
        let edges = (0..nodes).flat_map(|from| {
            (0..letters).map(move |letter| Self {
                from,
                letter,
                to: (from * letters + letter) % nodes,
            })
        });
        edges.collect()
    }
}

/// Quadratic forms on the nodes of a graph, each edge of which makes them smaller.
///
/// ```text
/// Pᵤ ≻ 0,   Pᵤ − A_σᵀ Pᵥ A_σ ≻ 0   for every edge u → v with the letter σ
/// ```
///
/// Why this proves a joint spectral radius below one, if every node has an edge for every letter: finitely many strict inequalities leave
/// room for a λ < 1 with A_σᵀ Pᵥ A_σ ⪯ λ Pᵤ. From any node there is a path for every word σ₁…σₙ, and along it xᵀPx shrinks
/// by λ at each step, so ‖A_{σₙ} ⋯ A_{σ₁}‖² ≤ λⁿ · (greatest eigenvalue)/(least eigenvalue) of the forms. With one node this is a common
/// quadratic Lyapunov function.
///
/// Source: Ahmadi, Jungers, Parrilo and Roozbehani 2014, path-complete graph Lyapunov functions.
///
/// Example: one node, P = 1, and the matrices 1/2 and −3/4: 1 − 1/4 > 0 and 1 − 9/16 > 0.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::certificate::{Edge, Quadratics};
/// use nalgebra::matrix;
///
/// let q = Rational::new;
/// let certificate = Quadratics { edges: Edge::memory(2, 0), forms: vec![matrix![q(1, 1)]] };
/// assert!(certificate.check(&[matrix![q(1, 2)], matrix![q(-3, 4)]]).is_ok());
/// // 1 − 1 is not above zero.
/// assert!(certificate.check(&[matrix![q(1, 2)], matrix![q(-1, 1)]]).is_err());
/// ```
///
/// Evidence: `the_paper_s_filters_are_certified_stable`, `a_spoilt_certificate_is_refused` (exact).
#[derive(Debug, Clone, PartialEq)]
pub struct Quadratics<N: Dim = U3>
where
    Shapes: Holds<N>,
{
    /// The graph.
    pub edges: Vec<Edge>,
    /// One form a node.
    pub forms: Vec<OMatrix<Rational, N, N>>,
}

/// A word whose product has a spectral radius of at least a bound above one.
///
/// Why this proves a joint spectral radius above one: powers of the product are products too, and grow like the powers of the bound.
///
/// Source: Rota and Strang 1960.
///
/// Example: each of the two forgets all in two steps; one after the other they are [0 0; 0 4].
///
/// ```
/// use immaculate::number::{Field, Rational};
/// use immaculate::steady::certificate::Product;
/// use nalgebra::matrix;
///
/// let matrices = [matrix![0, 2; 0, 0], matrix![0, 0; 2, 0]].map(|a| a.map(Rational::integer));
/// let grows = |word: &[usize]| Product { word: word.to_vec(), radius: Rational::integer(3) };
/// assert!(grows(&[0, 1]).check(&matrices).is_ok());
/// assert!(grows(&[0, 0]).check(&matrices).is_err());
/// ```
///
/// Evidence: `a_product_of_two_stable_filters_is_unstable`, `a_spoilt_certificate_is_refused` (exact).
#[derive(Debug, Clone, PartialEq)]
pub struct Product {
    /// The matrices, counted from 0, the first acting first.
    pub word: Vec<usize>,
    /// The bound.
    pub radius: Rational,
}

/// Why a certificate proves nothing.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotProven {
    /// An edge names something that does not exist.
    #[error("`quadratics.edges[{edge}]` names a node or a matrix that is not there")]
    Edge {
        /// The edge.
        edge: usize,
    },
    /// A word has no path in the graph; a graph without nodes has none for any.
    #[error("the graph is not complete: node {node} has no edge for matrix {letter}")]
    Incomplete {
        /// The node.
        node: usize,
        /// The matrix.
        letter: usize,
    },
    /// A form is not a positive definite quadratic form.
    #[error("`quadratics.forms[{node}]` {reason}")]
    Form {
        /// The node.
        node: usize,
        /// Why.
        reason: String,
    },
    /// An edge does not make the forms smaller.
    #[error("P − AᵀPA of `quadratics.edges[{edge}]` {pivot}")]
    Decrease {
        /// The edge.
        edge: usize,
        /// Where.
        pivot: NotPositiveDefinite,
    },
    /// The word is empty or names a matrix that does not exist.
    #[error("`product.word` is empty or names a matrix that is not there")]
    Word,
    /// The bound is not above one.
    #[error("`product.radius` is {radius}, which is not above 1")]
    Radius {
        /// The bound.
        radius: String,
    },
    /// The product's spectral radius is below the bound, or cannot be distinguished from it.
    #[error("the product's spectral radius {}", if *.decided { "is below `product.radius`" } else { "cannot be distinguished from `product.radius` with these numbers" })]
    Below {
        /// Whether it is known to be below.
        decided: bool,
    },
}

impl<N: Dim> Quadratics<N>
where
    Shapes: Holds<N>,
{
    /// Checks that the forms prove a joint spectral radius of the matrices below one.
    ///
    /// # Errors
    ///
    /// [`NotProven`] with the first condition that does not hold or cannot be decided.
    pub fn check<T: Field + PartialOrd>(&self, matrices: &[OMatrix<T, N, N>]) -> Result<(), NotProven> {
        self.check_rate(matrices, &Rational::integer(1))
    }

    /// Checks that the forms prove a joint spectral radius of the matrices below a rate λ, that is, λ²Pᵤ − A_σᵀ Pᵥ A_σ ≻ 0: the forms
    /// shrink by λ² at each step, and errors by λ, but for a constant factor.
    ///
    /// Example: 1/2 and −3/4 with P = 1: below 4/5, since 16/25 > 9/16, and not below 7/10.
    ///
    /// ```
    /// use immaculate::number::Rational;
    /// use immaculate::steady::certificate::{Edge, Quadratics};
    /// use nalgebra::matrix;
    ///
    /// let q = Rational::new;
    /// let matrices = [matrix![q(1, 2)], matrix![q(-3, 4)]];
    /// let form = Quadratics { edges: Edge::memory(2, 0), forms: vec![matrix![q(1, 1)]] };
    /// assert!(form.check_rate(&matrices, &q(4, 5)).is_ok());
    /// assert!(form.check_rate(&matrices, &q(7, 10)).is_err());
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Quadratics::check`].
    pub fn check_rate<T: Field + PartialOrd>(
        &self,
        matrices: &[OMatrix<T, N, N>],
        rate: &Rational,
    ) -> Result<(), NotProven> {
        self.check_graph(matrices.len())?;
        for (node, form) in self.forms.iter().enumerate() {
            let wrong = |reason: String| NotProven::Form { node, reason };
            if !is_symmetric(form) {
                return Err(wrong("is not symmetric".to_owned()));
            }
            check_positive_definite(&ldl(form)).map_err(|pivot| wrong(pivot.to_string()))?;
        }
        let square = T::rational(&(rate * rate.clone()));
        for (number, edge) in self.edges.iter().enumerate() {
            let a = &matrices[edge.letter];
            let [p, p_next] = [edge.from, edge.to].map(|node| self.forms[node].map(|entry| T::rational(&entry)));
            let decrease = p * square.clone() - a.transpose() * p_next * a;
            check_positive_definite(&ldl(&decrease)).map_err(|pivot| NotProven::Decrease { edge: number, pivot })?;
        }
        Ok(())
    }

    /// Every node has an edge for every letter.
    fn check_graph(&self, letters: usize) -> Result<(), NotProven> {
        let nodes = self.forms.len();
        let is_there = |edge: &Edge| edge.from < nodes && edge.to < nodes && edge.letter < letters;
        if let Some(edge) = self.edges.iter().position(|edge| !is_there(edge)) {
            return Err(NotProven::Edge { edge });
        }
        for node in 0..nodes.max(1) {
            for letter in 0..letters {
                let leaves = |edge: &Edge| edge.from == node && edge.letter == letter;
                if !self.edges.iter().any(leaves) {
                    return Err(NotProven::Incomplete { node, letter });
                }
            }
        }
        Ok(())
    }
}

impl Product {
    /// Checks that the product's spectral radius is at least the bound, and the bound above one.
    ///
    /// # Errors
    ///
    /// [`NotProven`] with the first condition that does not hold or cannot be decided.
    pub fn check<T: Field + PartialOrd, N: Dim>(&self, matrices: &[OMatrix<T, N, N>]) -> Result<(), NotProven>
    where
        Shapes: Holds<N>,
    {
        if self.word.is_empty() || self.word.iter().any(|&letter| letter >= matrices.len()) {
            return Err(NotProven::Word);
        }
        if self.radius.partial_cmp(&Rational::new(1, 1)) != Some(std::cmp::Ordering::Greater) {
            let radius = self.radius.to_string();
            return Err(NotProven::Radius { radius });
        }
        let rows = rows_of(&product(&self.word, matrices));
        match has_radius_below(&rows, &T::rational(&self.radius)) {
            Some(false) => Ok(()),
            answer => Err(NotProven::Below {
                decided: answer.is_some(),
            }),
        }
    }
}
