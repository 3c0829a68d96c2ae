//! Whether two fixed-gain filters that exchange estimates are stable: proven, refuted, or undecided.
//!
//! After this file the reader knows how the question is answered at one pair of filters, from cheap to dear: short products that grow, a
//! common quadratic form, forms that remember the last letters, longer products. Each answer is a certificate that was checked.

use super::certificate::{NotProven, Product, Quadratics};
use super::pair::{acceleration_matrix, velocity_matrix};
use super::search;
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

/// The precision at which the roots of tracking indices are enclosed: certificates have margins of far more than 2⁻¹⁰⁰.
pub const BITS: u32 = 192;

/// The longest root of which products are exact, bits of numerator and denominator: a product of letters has three times as many for each,
/// and takes a time that grows with the cube of their number.
const SHORT_ROOT: u64 = 32;

/// What is known of the joint stability of two filters.
#[derive(Debug, Clone, PartialEq)]
pub enum StabilityVerdict {
    /// Stable however the filters are mixed.
    Stable(Quadratics<3>),
    /// A sequence of mixing probabilities exists under which errors grow without bound.
    Unstable(Product),
    /// Neither was found.
    Undecided {
        /// The greatest growth a step of any product that was tried.
        growth: f64,
    },
}

/// How far the search goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Depth {
    /// The longest product of any letters.
    pub word: usize,
    /// The longest run in a product of two runs.
    pub run: usize,
    /// The longest memory of the forms, in letters.
    pub memory: u32,
}

impl Default for Depth {
    fn default() -> Self {
        Self {
            word: 16,
            run: 64,
            memory: 4,
        }
    }
}

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

    /// The matrices of the two filters as doubles, for searches.
    pub fn in_doubles(&self) -> [Matrix3<f64>; 2] {
        match self {
            Self::Roots([v, a]) => [velocity_matrix(&v.to_f64()), acceleration_matrix(&a.to_f64())],
            Self::SquaredIndices(_) => {
                Enclosure::with_precision(BITS, || self.enclosed().map(|a| a.map(|entry| entry.middle())))
            }
        }
    }

    /// The matrices as enclosures, at the precision of the scope.
    fn enclosed(&self) -> [Matrix3<Enclosure>; 2] {
        let [v, a] = self.roots();
        [velocity_matrix(&v), acceleration_matrix(&a)]
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

    /// Checks that quadratic forms prove these filters stable: exactly for roots of few digits, on enclosures for others.
    ///
    /// # Errors
    ///
    /// [`NotProven`], as [`Quadratics::check`].
    pub fn check_stable(&self, forms: &Quadratics<3>) -> Result<(), NotProven> {
        match self {
            Self::Roots([v, a]) if self.has_short_roots() => forms.check(&[velocity_matrix(v), acceleration_matrix(a)]),
            _ => Enclosure::with_precision(BITS, || forms.check(&self.enclosed())),
        }
    }

    /// Checks that a product proves these filters unstable: exactly for roots of few digits, on enclosures for others.
    ///
    /// # Errors
    ///
    /// [`NotProven`], as [`Product::check`].
    pub fn check_unstable(&self, product: &Product) -> Result<(), NotProven> {
        match self {
            Self::Roots([v, a]) if self.has_short_roots() => {
                product.check(&[velocity_matrix(v), acceleration_matrix(a)])
            }
            _ => Enclosure::with_precision(BITS, || product.check(&self.enclosed())),
        }
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
        let matrices = self.in_doubles();
        let (word, growth) = search::fastest_word(&matrices, depth.word.min(SHORT));
        if let Some(product) = self.grows(word, growth) {
            return StabilityVerdict::Unstable(product);
        }
        for memory in 0..=depth.memory {
            let edges = Quadratics::<3>::memory(LETTERS.len(), memory);
            let accepts = |forms: &Quadratics<3>| self.check_stable(forms).is_ok();
            if let Some(forms) = search::quadratics(&matrices, &edges, accepts) {
                return StabilityVerdict::Stable(forms);
            }
        }
        let words = [
            search::fastest_runs(&matrices, depth.run),
            search::fastest_word(&matrices, depth.word),
        ];
        let growth = f64::max(words[0].1, words[1].1);
        let grows = words.into_iter().find_map(|(word, growth)| self.grows(word, growth));
        grows.map_or(StabilityVerdict::Undecided { growth }, StabilityVerdict::Unstable)
    }

    /// A checked certificate of growth for a word.
    fn grows(&self, word: Vec<usize>, growth: f64) -> Option<Product> {
        let product = search::product_certificate(word, growth)?;
        self.check_unstable(&product).is_ok().then_some(product)
    }
}

/// Products up to this length are tried before forms.
const SHORT: usize = 8;
