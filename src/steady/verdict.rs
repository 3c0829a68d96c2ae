//! Whether two fixed-gain filters that mix their estimates are stable: proven, refuted, or undecided.
//!
//! A pair of filters is named by damping roots or by noises; what becomes of it are two matrices, of which [`super::closed_loops`] decides.

use super::certificate::{NotProven, Product, Quadratics};
pub use super::closed_loops::{BITS, Depth, StabilityVerdict};
use super::closed_loops::{ClosedLoops, Entries};
use super::pair::{acceleration_matrix, velocity_matrix};
use crate::number::{Enclosure, Field, Rational};
use nalgebra::{Matrix3, SMatrix};

/// The letters of the two filters in words.
pub const LETTERS: [char; 2] = ['v', 'a'];

/// The two filters, by what decides their gains.
#[derive(Debug, Clone, PartialEq)]
pub enum Filters {
    /// The damping roots θ_v and θ_a themselves: everything is rational.
    Roots([Rational; 2]),
    /// The tracking indices squared, Λ² = q t⁴/R, of which the roots are enclosed.
    SquaredIndices([Rational; 2]),
}

/// The longest root of which products are exact, bits of numerator and denominator: a product of letters has three times as many for each,
/// and takes a time that grows with the cube of their number.
const SHORT_ROOT: u64 = 32;

/// A form by rows, for people.
pub fn rows_text(form: &SMatrix<Rational, 3, 3>) -> String {
    let row = |i: usize| (0..3).map(|j| form[(i, j)].to_string()).collect::<Vec<_>>().join(" ");
    format!("[{}]", [0, 1, 2].map(row).join("; "))
}

/// A word in the letters of the filters.
pub fn word_text(word: &[usize]) -> String {
    word.iter().map(|&letter| LETTERS[letter]).collect()
}

impl Filters {
    /// The filters for a scan time t, s, a measurement variance R, m², and the variances q_v and q_a, (m/s²)².
    pub fn of_noises(interval: &Rational, measurement: &Rational, noises: [Rational; 2]) -> Self {
        Self::SquaredIndices(noises.map(|q| q / measurement.clone() * interval.pow(4)))
    }

    /// The matrices of the two filters: exact for roots of few digits, enclosed for others.
    pub fn closed_loops(&self) -> ClosedLoops {
        ClosedLoops::new(match self {
            Self::Roots([v, a]) if self.has_short_roots() => {
                Entries::Exact(vec![velocity_matrix(v), acceleration_matrix(a)])
            }
            _ => Entries::Enclosed(Enclosure::with_precision(BITS, || {
                let [v, a] = self.roots();
                vec![velocity_matrix(&v), acceleration_matrix(&a)]
            })),
        })
    }

    /// The matrices of the two filters as doubles, for searches.
    pub fn in_doubles(&self) -> [Matrix3<f64>; 2] {
        match self {
            Self::Roots([v, a]) => [velocity_matrix(&v.to_f64()), acceleration_matrix(&a.to_f64())],
            Self::SquaredIndices(_) => {
                let matrices = self.closed_loops().in_doubles();
                [matrices[0], matrices[1]]
            }
        }
    }

    /// The damping roots as enclosures, at the precision of the scope.
    pub fn roots(&self) -> [Enclosure; 2] {
        match self {
            Self::Roots(roots) => [0, 1].map(|j| Enclosure::rational(&roots[j])),
            Self::SquaredIndices(squares) => {
                let index = |j: usize| crate::number::Real::sqrt(&Enclosure::rational(&squares[j]));
                [
                    super::gains::alpha_beta_root(&index(0)),
                    super::gains::alpha_beta_gamma_root(&index(1)),
                ]
            }
        }
    }

    /// Whether the roots are known exactly, in so few digits that exact products of them are short.
    fn has_short_roots(&self) -> bool {
        let bits = |root: &Rational| root.value().map_or(0, |root| root.numer().bits() + root.denom().bits());
        match self {
            Self::Roots(roots) => roots.iter().all(|root| bits(root) <= SHORT_ROOT),
            Self::SquaredIndices(_) => false,
        }
    }

    /// Checks that quadratic forms prove these filters stable.
    ///
    /// # Errors
    ///
    /// [`NotProven`], as [`Quadratics::check`].
    pub fn check_stable(&self, forms: &Quadratics) -> Result<(), NotProven> {
        self.closed_loops().check_rate(forms, &Rational::integer(1))
    }

    /// Checks that a product proves these filters unstable.
    ///
    /// # Errors
    ///
    /// [`NotProven`], as [`Product::check`].
    pub fn check_unstable(&self, product: &Product) -> Result<(), NotProven> {
        self.closed_loops().check_unstable(product)
    }

    /// Decides whether the filters are stable together.
    ///
    /// Example: each is stable for every root in (0, 1); these two are not together: v² a grows.
    ///
    /// ```
    /// use immaculate::number::Rational;
    /// use immaculate::steady::verdict::{Depth, Filters, StabilityVerdict, word_text};
    ///
    /// let filters = Filters::Roots([Rational::new(3, 4), Rational::new(1, 6)]);
    /// let StabilityVerdict::Unstable(product) = filters.decide(Depth::default()) else { panic!("they are unstable") };
    /// assert_eq!(word_text(&product.word), "vva");
    /// ```
    pub fn decide(&self, depth: Depth) -> StabilityVerdict {
        self.closed_loops().decide(depth)
    }
}
