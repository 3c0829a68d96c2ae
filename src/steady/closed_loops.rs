//! The matrices (I − KH)F of filters that exchange estimates, and how their joint stability is decided.
//!
//! The question is answered from cheap to expensive: short products that grow, a common quadratic form,
//! forms that remember the last letters, longer products; and how the joint spectral radius is bounded from both sides. Whatever is
//! answered was checked in exact or enclosing arithmetic.

use super::certificate::{Edge, NotProven, Product, Quadratics};
use super::pair::product;
use super::polynomial::{has_radius_below, rows_of};
use super::search;
use crate::matrix::{Holds, Shapes};
use crate::number::{Enclosure, Field, Rational};
use nalgebra::{Dim, OMatrix, U3};

/// The precision of enclosures: certificates have margins of far more than 2⁻¹⁰⁰.
pub const BITS: u32 = 192;

/// The matrices, and which mode may follow which.
#[derive(Debug, Clone)]
pub struct ClosedLoops<N: Dim = U3>
where
    Shapes: Holds<N>,
{
    /// One a mode.
    pub matrices: Entries<N>,
    /// `follows[i][j]`: filter j may start from the estimate of filter i, since the chain leads from mode i to mode j.
    pub follows: Vec<Vec<bool>>,
}

/// The entries of the matrices.
#[derive(Debug, Clone)]
pub enum Entries<N: Dim>
where
    Shapes: Holds<N>,
{
    /// Fractions of few digits: products of them are exact, and short.
    Exact(Vec<OMatrix<Rational, N, N>>),
    /// Enclosures of [`BITS`] bits.
    Enclosed(Vec<OMatrix<Enclosure, N, N>>),
}

/// What is known of the joint stability of filters.
#[derive(Debug, Clone, PartialEq)]
pub enum StabilityVerdict<N: Dim = U3>
where
    Shapes: Holds<N>,
{
    /// Stable however the filters are mixed.
    Stable(Quadratics<N>),
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

/// The joint spectral radius between two short decimals, both certified.
///
/// ```text
/// below ≤ ρ < above
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Bounds<N: Dim = U3>
where
    Shapes: Holds<N>,
{
    /// The product of this word has a spectral radius of at least `below` to the power of its letters.
    pub word: Vec<usize>,
    /// See above.
    pub below: Rational,
    /// The least rate found, with the forms that prove it; none if none was.
    pub above: Option<(Rational, Quadratics<N>)>,
}

/// Products up to this length are tried before forms.
const SHORT: usize = 8;

/// The bounds have four digits after the point.
const SCALE: f64 = 1e4;

/// The time of a search for words in multiplications: about a second.
const MOST_MULTIPLICATIONS: f64 = 5e8;

/// The most unknowns of a search for forms.
const MOST_UNKNOWNS: usize = 600;

impl<N: Dim> ClosedLoops<N>
where
    Shapes: Holds<N>,
{
    /// Matrices any of which may follow any other.
    pub fn new(matrices: Entries<N>) -> Self {
        let count = matrices.count();
        Self {
            matrices,
            follows: vec![vec![true; count]; count],
        }
    }

    /// The matrices as doubles, for searches.
    pub fn in_doubles(&self) -> Vec<OMatrix<f64, N, N>> {
        match &self.matrices {
            Entries::Exact(matrices) => matrices.iter().map(|a| a.map(|entry| entry.to_f64())).collect(),
            Entries::Enclosed(matrices) => matrices.iter().map(|a| a.map(|entry| entry.middle())).collect(),
        }
    }

    /// Checks that forms prove a joint spectral radius below a rate.
    ///
    /// # Errors
    ///
    /// [`NotProven`], as [`Quadratics::check_rate`].
    pub fn check_rate(&self, forms: &Quadratics<N>, rate: &Rational) -> Result<(), NotProven> {
        match &self.matrices {
            Entries::Exact(matrices) => forms.check_rate(matrices, rate),
            Entries::Enclosed(matrices) => Enclosure::with_precision(BITS, || forms.check_rate(matrices, rate)),
        }
    }

    /// Checks that a product proves instability.
    ///
    /// # Errors
    ///
    /// [`NotProven`], as [`Product::check`].
    pub fn check_unstable(&self, product: &Product) -> Result<(), NotProven> {
        match &self.matrices {
            Entries::Exact(matrices) => product.check(matrices),
            Entries::Enclosed(matrices) => Enclosure::with_precision(BITS, || product.check(matrices)),
        }
    }

    /// Whether the spectral radius of a product is below a bound; none if that is undecided.
    pub fn is_radius_below(&self, word: &[usize], bound: &Rational) -> Option<bool> {
        match &self.matrices {
            Entries::Exact(matrices) => has_radius_below(&rows_of(&product(word, matrices)), bound),
            Entries::Enclosed(matrices) => Enclosure::with_precision(BITS, || {
                has_radius_below(&rows_of(&product(word, matrices)), &Enclosure::rational(bound))
            }),
        }
    }

    /// Decides whether the filters are stable together.
    pub fn decide(&self, depth: Depth) -> StabilityVerdict<N> {
        let matrices = self.in_doubles();
        let longest = Self::affordable(&matrices, depth.word);
        let (word, growth) = self.fastest_word(&matrices, longest.min(SHORT));
        if let Some(product) = self.grows(word, growth) {
            return StabilityVerdict::Unstable(product);
        }
        for memory in 0..=depth.memory {
            if memory > 0 && !has_room(&matrices, memory) {
                break;
            }
            let edges = Edge::memory(matrices.len(), memory);
            let one = Rational::integer(1);
            let accepts = |forms: &Quadratics<N>| self.check_rate(forms, &one).is_ok();
            if let Some(forms) = search::quadratics(&matrices, &edges, accepts) {
                return StabilityVerdict::Stable(forms);
            }
        }
        let words = self.fastest_words(&matrices, depth);
        let growth = words.iter().map(|word| word.1).fold(0.0, f64::max);
        let grows = words.into_iter().find_map(|(word, growth)| self.grows(word, growth));
        grows.map_or(StabilityVerdict::Undecided { growth }, StabilityVerdict::Unstable)
    }

    /// The words that grow most a letter, of two runs and of any letters.
    fn fastest_words(&self, matrices: &[OMatrix<f64, N, N>], depth: Depth) -> Vec<(Vec<usize>, f64)> {
        let mut words = Vec::new();
        if let [first, second] = matrices {
            let fits = |run: &usize| cost(matrices) * (run * run) as f64 <= MOST_MULTIPLICATIONS;
            let longest = (1..=depth.run).take_while(fits).last().unwrap_or(1);
            words.push(search::fastest_runs([first, second], longest));
        }
        words.push(self.fastest_word(matrices, Self::affordable(matrices, depth.word)));
        words.retain(|(word, _)| self.is_allowed(word));
        words
    }

    /// The joint spectral radius from both sides.
    ///
    /// From below by the product that grows most a letter. From above by forms for A/λ, λ halved into its place; with a memory where the
    /// verdict has one.
    pub fn bounds(&self, depth: Depth, verdict: &StabilityVerdict<N>) -> Bounds<N> {
        let matrices = self.in_doubles();
        let words = self.fastest_words(&matrices, depth);
        let (word, growth) = (words.into_iter())
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or((vec![0], 0.0));
        let mut below = decimal(growth, f64::floor);
        let step = decimal(1.0 / SCALE, f64::round);
        let length = u32::try_from(word.len()).unwrap_or(u32::MAX);
        while below.is_positive() && self.is_radius_below(&word, &below.pow(length)) != Some(false) {
            below -= step.clone();
        }
        let memory = match verdict {
            StabilityVerdict::Stable(found) => found.forms.len().ilog(matrices.len().max(2)),
            _ => (0..=depth.memory)
                .rev()
                .find(|memory| has_room(&matrices, *memory))
                .unwrap_or(0),
        };
        let edges = Edge::memory(matrices.len(), memory);
        let above = self.least_rate(&matrices, &edges, growth, verdict);
        Bounds { word, below, above }
    }

    /// The least rate that forms on a graph prove, to a part in some thousands.
    fn least_rate(
        &self,
        matrices: &[OMatrix<f64, N, N>],
        edges: &[Edge],
        growth: f64,
        verdict: &StabilityVerdict<N>,
    ) -> Option<(Rational, Quadratics<N>)> {
        let at = |rate: f64| {
            let rate = decimal(rate, f64::ceil);
            let scaled: Vec<_> = matrices.iter().map(|a| a.clone() / rate.to_f64()).collect();
            let forms = search::quadratics(&scaled, edges, |forms| self.check_rate(forms, &rate).is_ok())?;
            Some((rate, forms))
        };
        let (mut low, mut high) = (growth, growth.max(0.01) * 1.02);
        let mut found = at(high);
        for _ in 0..8 {
            if found.is_some() {
                break;
            }
            (low, high) = (high, high + (high - growth));
            found = at(high);
        }
        for _ in 0..7 {
            let middle = f64::midpoint(low, high);
            match at(middle) {
                Some(better) => (high, found) = (middle, Some(better)),
                None => low = middle,
            }
        }
        // What was proven below one stays proven.
        match (found, verdict) {
            (Some(found), _) => Some(found),
            (None, StabilityVerdict::Stable(forms)) => Some((Rational::integer(1), forms.clone())),
            (None, _) => None,
        }
    }

    /// A word that the chain can repeat for ever.
    fn is_allowed(&self, word: &[usize]) -> bool {
        let next = word.iter().cycle().skip(1);
        word.iter().zip(next).all(|(&from, &to)| self.follows[from][to])
    }

    fn fastest_word(&self, matrices: &[OMatrix<f64, N, N>], longest: usize) -> (Vec<usize>, f64) {
        search::fastest_allowed_word(matrices, longest, |word| self.is_allowed(word))
    }

    /// The greatest length of words that can all be tried in some seconds.
    fn affordable(matrices: &[OMatrix<f64, N, N>], longest: usize) -> usize {
        let words = |length: &usize| {
            u32::try_from(*length)
                .ok()
                .and_then(|length| matrices.len().checked_pow(length))
        };
        let fits = |length: &usize| words(length).is_some_and(|n| n as f64 * cost(matrices) < MOST_MULTIPLICATIONS);
        (1..=longest).take_while(fits).last().unwrap_or(1)
    }

    /// A checked certificate of growth for a word.
    fn grows(&self, word: Vec<usize>, growth: f64) -> Option<Product> {
        let product = search::product_certificate(word, growth)?;
        self.check_unstable(&product).is_ok().then_some(product)
    }
}

/// What a spectral radius takes, in multiplications: forty squarings.
fn cost<N: Dim>(matrices: &[OMatrix<f64, N, N>]) -> f64
where
    Shapes: Holds<N>,
{
    40.0 * (matrices[0].nrows() as f64) * matrices[0].len() as f64
}

/// Whether forms with a memory have few enough unknowns.
fn has_room<N: Dim>(matrices: &[OMatrix<f64, N, N>], memory: u32) -> bool
where
    Shapes: Holds<N>,
{
    let side = matrices[0].nrows();
    let nodes = matrices.len().checked_pow(memory);
    nodes.is_some_and(|nodes| nodes.saturating_mul(side * (side + 1) / 2) <= MOST_UNKNOWNS)
}

/// A decimal of few digits.
fn decimal(value: f64, round: fn(f64) -> f64) -> Rational {
    Rational::from_f64(round(value * SCALE)) / Rational::from_f64(SCALE)
}

impl<N: Dim> Entries<N>
where
    Shapes: Holds<N>,
{
    /// How many matrices there are.
    pub fn count(&self) -> usize {
        match self {
            Self::Exact(matrices) => matrices.len(),
            Self::Enclosed(matrices) => matrices.len(),
        }
    }
}
