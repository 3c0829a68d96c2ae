//! The names of the rules.

use super::gauss_hermite::gauss_hermite;
use super::unscented::{Parameters, unscented};
use super::{ExactRule, InvalidRule, Rule, fifth_degree, printed, simplex, third_degree};
use crate::matrix::{Holds, Shapes};
use crate::number::Real;
use nalgebra::{Dim, DimName};
use std::str::FromStr;

/// A rule by name.
#[derive(Debug, Clone, PartialEq)]
pub enum RuleName {
    /// `cubature-3`: 2n points.
    ThirdDegree,
    /// `unscented`: 2n + 1 points; without parameters κ = 3 − n, α = 1, β = 0.
    Unscented(Option<Parameters>),
    /// `cubature-5`: 2n² + 1 points.
    FifthDegree,
    /// `simplex-5`: n² + 3n + 3 points.
    Simplex,
    /// `gauss-hermite-3` and others: mⁿ points.
    GaussHermite(usize),
    /// `cubature-5-printed`: with the weight that zhu2016 (13) prints.
    FifthDegreePrinted,
    /// `simplex-5-printed-11`: with the weight that liu2017 (11) prints.
    SimplexPrinted11,
    /// `simplex-5-printed-16`: with the weight that liu2017 (16) prints.
    SimplexPrinted16,
}

impl RuleName {
    /// All names.
    pub const NAMES: [&'static str; 11] = [
        "cubature-3",
        "unscented",
        "cubature-5",
        "simplex-5",
        "gauss-hermite-2",
        "gauss-hermite-3",
        "gauss-hermite-4",
        "gauss-hermite-5",
        "cubature-5-printed",
        "simplex-5-printed-11",
        "simplex-5-printed-16",
    ];

    /// The rule in exact form.
    ///
    /// # Errors
    ///
    /// [`InvalidRule`] when the rule does not exist in this dimension or with these parameters, and for a Gauss-Hermite rule,
    /// whose coordinates are nested roots: see [`gauss_hermite::nodes`](super::gauss_hermite::nodes).
    pub fn exact(&self, n: usize) -> Result<ExactRule, InvalidRule> {
        match self {
            Self::ThirdDegree => third_degree::third_degree(n),
            Self::Unscented(Some(parameters)) => unscented(n, parameters),
            Self::Unscented(None) => unscented(n, &Parameters::for_gaussian(n)),
            Self::FifthDegree => fifth_degree::fifth_degree(n),
            Self::Simplex => simplex::simplex(n),
            Self::GaussHermite(_) => Err(InvalidRule::NestedRoots),
            Self::FifthDegreePrinted => printed::fifth_degree(n),
            Self::SimplexPrinted11 => printed::simplex_11(n),
            Self::SimplexPrinted16 => printed::simplex_16(n),
        }
    }

    /// The rule in the numbers of a filter whose dimension is a type.
    ///
    /// # Errors
    ///
    /// As [`RuleName::exact`].
    pub fn rule<T: Real, N: DimName>(&self) -> Result<Rule<T, N>, InvalidRule>
    where
        Shapes: Holds<N>,
    {
        self.rule_in(N::name())
    }

    /// The rule in the numbers of a filter, in dimension n.
    ///
    /// # Errors
    ///
    /// As [`RuleName::exact`].
    pub fn rule_in<T: Real, N: Dim>(&self, n: N) -> Result<Rule<T, N>, InvalidRule>
    where
        Shapes: Holds<N>,
    {
        match self {
            Self::GaussHermite(m) => gauss_hermite(n, *m),
            name => Rule::from_exact(&name.exact(n.value())?),
        }
    }
}

impl FromStr for RuleName {
    type Err = InvalidRule;

    fn from_str(name: &str) -> Result<Self, InvalidRule> {
        Ok(match name {
            "cubature-3" => Self::ThirdDegree,
            "unscented" => Self::Unscented(None),
            "cubature-5" => Self::FifthDegree,
            "simplex-5" => Self::Simplex,
            "gauss-hermite-2" => Self::GaussHermite(2),
            "gauss-hermite-3" => Self::GaussHermite(3),
            "gauss-hermite-4" => Self::GaussHermite(4),
            "gauss-hermite-5" => Self::GaussHermite(5),
            "cubature-5-printed" => Self::FifthDegreePrinted,
            "simplex-5-printed-11" => Self::SimplexPrinted11,
            "simplex-5-printed-16" => Self::SimplexPrinted16,
            _ => {
                return Err(InvalidRule::UnknownName { name: name.to_owned() });
            }
        })
    }
}
