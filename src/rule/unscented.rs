//! The unscented rule: the mean and 2n points on the axes, with one or three parameters.
//!
//! Both parametrisations of the unscented transform are here. The centre weight can be negative.

use super::{ExactRule, InvalidRule, Rule, along_axis, dimension_as_rational, opposite};
use crate::matrix::{Holds, Shapes};
use crate::number::{Field, Rational, Real, Surd};
use nalgebra::{Dim, OVector, U1};
use std::cmp::Ordering;

/// The parameters of the unscented rule.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameters {
    /// α, the spread of the points; 1 in the original form.
    pub alpha: Rational,
    /// β, what is known of the distribution's fourth moment; 0 in the original form.
    pub beta: Rational,
    /// κ; 3 − n matches the fourth moment of one coordinate.
    pub kappa: Rational,
}

impl Parameters {
    /// The original form with one parameter κ: α = 1, β = 0.
    ///
    /// Example: with α = 1, λ = n + κ − n = κ.
    ///
    /// ```
    /// use immaculate::number::Rational;
    /// use immaculate::rule::unscented::Parameters;
    ///
    /// let parameters = Parameters::of_kappa(Rational::new(1, 2));
    /// assert_eq!(parameters.lambda(4), Rational::new(1, 2));
    /// ```
    pub fn of_kappa(kappa: Rational) -> Self {
        Self {
            alpha: Rational::new(1, 1),
            beta: Rational::new(0, 1),
            kappa,
        }
    }

    /// κ = 3 − n, the value for Gaussian densities; negative for n > 3.
    ///
    /// Source: Julier and Uhlmann 2004.
    ///
    /// Example: for n = 2 and n = 4.
    ///
    /// ```
    /// use immaculate::number::Rational;
    /// use immaculate::rule::unscented::Parameters;
    ///
    /// assert_eq!(Parameters::for_gaussian(2).kappa, Rational::new(1, 1)); // 3 − 2
    /// assert_eq!(Parameters::for_gaussian(4).kappa, Rational::new(-1, 1)); // 3 − 4
    /// ```
    pub fn for_gaussian(n: usize) -> Self {
        Self::of_kappa(Rational::new(3, 1) - dimension_as_rational(n))
    }

    /// λ = α²(n + κ) − n.
    ///
    /// Source: Wan and van der Merwe, The unscented Kalman filter, 2001.
    ///
    /// Example: for n = 2, α = 1/2, κ = 1.
    ///
    /// ```
    /// use immaculate::number::Rational;
    /// use immaculate::rule::unscented::Parameters;
    ///
    /// let q = Rational::new;
    /// let parameters = Parameters { alpha: q(1, 2), beta: q(2, 1), kappa: q(1, 1) };
    /// assert_eq!(parameters.lambda(2), q(-5, 4)); // 1/4 · (2 + 1) − 2
    /// ```
    pub fn lambda(&self, n: usize) -> Rational {
        lambda(&dimension_as_rational(n), &self.alpha, &self.kappa)
    }
}

/// λ = α²(n + κ) − n.
///
/// Source: Wan and van der Merwe, The unscented Kalman filter, 2001.
///
/// Example: for n = 2, α = 1/2, κ = 1.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::unscented::lambda;
///
/// let q = Rational::new;
/// assert_eq!(lambda(&q(2, 1), &q(1, 2), &q(1, 1)), q(-5, 4)); // 1/4 · (2 + 1) − 2
/// ```
pub fn lambda<T: Field>(n: &T, alpha: &T, kappa: &T) -> T {
    alpha.clone() * alpha.clone() * (n.clone() + kappa.clone()) - n.clone()
}

/// The unscented rule — sustika2015 (27)-(29), (sigma-point-weights), for zero mean and unit covariance.
///
/// ```text
/// λ = α²(n + κ) − n
/// ξ₀ = 0,              w₀ = λ/(n + λ),   for covariances w₀ + 1 − α² + β
/// ξₛ = ±√(n + λ) eᵢ,   wₛ = 1/(2(n + λ))
/// ```
///
/// Source: Julier and Uhlmann, Unscented filtering and nonlinear estimation, Proceedings of the IEEE 92, 2004 (α = 1, β = 0,
/// λ = κ); Wan and van der Merwe 2001 for α and β. The rule of the filter IMMUKF that both papers compare themselves with.
///
/// With κ = 0 it is the third-degree rule and a centre of weight zero; at n = 3 that is also κ = 3 − n.
///
/// With κ = 3 − n the points are at the distance √3 α in every dimension. Components without variance then change nothing: the points
/// along them fall on the centre and make up for its smaller weight. With another κ, as 0, they push the other points outwards.
/// sustika2015 prints neither the weights nor λ, and has states of four and of six components.
///
/// Example: for n = 2, κ = 3 − 2 = λ: points at the distance √3; weights 1/3 and four times 1/6.
///
/// ```
/// use immaculate::rule::unscented::{Parameters, unscented};
///
/// let rule = unscented(2, &Parameters::for_gaussian(2)).unwrap();
/// assert_eq!(rule.points[1][0].to_string(), "√3");
/// assert_eq!(format!("{} {}", rule.weights[0], rule.weights[1]), "1/3 1/6");
/// // n = 4, κ = −1: the centre counts −1/3, and a covariance need not be positive definite.
/// assert_eq!(unscented(4, &Parameters::for_gaussian(4)).unwrap().weights[0].to_string(), "-1/3");
/// ```
///
/// # Errors
///
/// [`InvalidRule::Dimension`] in dimension zero, [`InvalidRule::Radius`] when n + λ is not positive, [`InvalidRule::RadiusDigits`]
/// when its root is beyond [`Surd::root`].
///
/// Evidence: `unscented_rule_is_exact_to_degree_three_and_not_four` (exact),
/// `unscented_rule_has_degree_three_in_every_dimension` (symbolic),
/// `components_without_variance_change_an_unscented_rule_exactly_when_they_change_its_radius` (exact).
pub fn unscented(n: usize, parameters: &Parameters) -> Result<ExactRule, InvalidRule> {
    if n == 0 {
        return Err(InvalidRule::Dimension {
            rule: "unscented",
            least: 1,
            dimension: n,
            reason: "",
        });
    }
    let lambda = parameters.lambda(n);
    let radius_squared = dimension_as_rational(n) + lambda.clone();
    if !radius_squared.is_positive() {
        return Err(InvalidRule::Radius {
            radius_squared: radius_squared.to_string(),
        });
    }
    let radius = Surd::root(&radius_squared);
    if !radius.is_decided() {
        return Err(InvalidRule::RadiusDigits {
            radius_squared: radius_squared.to_string(),
        });
    }
    let axes: Vec<_> = (0..n).map(|i| along_axis(n, i, &radius)).collect();
    let mut points = axes.clone();
    points.extend(opposite(&axes));
    let centre = vec![along_axis(n, 0, &Surd::root(&Rational::new(0, 1)))];

    let n_exact = dimension_as_rational(n);
    let mut rule = ExactRule::from_orbits(
        n,
        vec![
            (centre_weight(&n_exact, &lambda), centre),
            (axis_weight(&n_exact, &lambda), points),
        ],
    );
    rule.covariance_weights[0] = centre_covariance_weight(&rule.weights[0], &parameters.alpha, &parameters.beta);
    Ok(rule)
}

/// The unscented rule with parameters that are numbers of a filter, such as doubles, whose radius has no form as a surd.
///
/// Source: as [`unscented`], of which it has the points and their order.
///
/// Example: for n = 2, α = 1, β = 0, κ = 1: λ = 1, and what is rounded is √3 and the quotients.
///
/// ```
/// use immaculate::rule::unscented::unscented_in;
///
/// let rule = unscented_in(nalgebra::U2, &1.0, &0.0, &1.0).unwrap();
/// assert_eq!(rule.points[1][0], 3.0_f64.sqrt());
/// assert_eq!(rule.weights[..2], [1.0 / 3.0, 1.0 / 6.0]);
/// ```
///
/// # Errors
///
/// [`InvalidRule::Radius`] when n + λ is not positive.
///
/// Evidence: `the_unscented_rule_of_doubles_is_the_exact_one_rounded`.
pub fn unscented_in<T: Real, N: Dim>(side: N, alpha: &T, beta: &T, kappa: &T) -> Result<Rule<T, N>, InvalidRule>
where
    Shapes: Holds<N>,
{
    let n = T::integer(i64::try_from(side.value()).unwrap_or(i64::MAX));
    let lambda = lambda(&n, alpha, kappa);
    let radius_squared = n.clone() + lambda.clone();
    if radius_squared.partial_cmp(&T::zero()) != Some(Ordering::Greater) {
        return Err(InvalidRule::Radius {
            radius_squared: format!("{radius_squared:?}"),
        });
    }
    let radius = radius_squared.sqrt();
    let mut points = vec![OVector::zeros_generic(side, U1)];
    for sign in [T::one(), -T::one()] {
        for i in 0..side.value() {
            let mut point = OVector::<T, N>::zeros_generic(side, U1);
            point[i] = sign.clone() * radius.clone();
            points.push(point);
        }
    }
    let mut weights = vec![axis_weight(&n, &lambda); points.len()];
    weights[0] = centre_weight(&n, &lambda);
    let mut covariance_weights = weights.clone();
    covariance_weights[0] = centre_covariance_weight(&weights[0], alpha, beta);
    Ok(Rule {
        points,
        weights,
        covariance_weights,
    })
}

/// The weight of the centre for covariances, w₀ + 1 − α² + β.
///
/// Source: as [`lambda`].
///
/// Example: for α = 1/2, β = 2: −5/3 + 1 − 1/4 + 2.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::unscented::centre_covariance_weight;
///
/// let q = Rational::new;
/// assert_eq!(centre_covariance_weight(&q(-5, 3), &q(1, 2), &q(2, 1)), q(13, 12));
/// // α = 1, β = 0: the same as for means
/// assert_eq!(centre_covariance_weight(&q(1, 3), &q(1, 1), &q(0, 1)), q(1, 3));
/// ```
pub fn centre_covariance_weight<T: Field>(centre_weight: &T, alpha: &T, beta: &T) -> T {
    centre_weight.clone() + T::one() - alpha.clone() * alpha.clone() + beta.clone()
}

/// The weight of the centre, λ/(n + λ).
///
/// Source: as [`unscented`].
///
/// Example: for n = 2 and n = 4 with κ = 3 − n.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::unscented::centre_weight;
///
/// let q = Rational::new;
/// assert_eq!(centre_weight(&q(2, 1), &q(1, 1)), q(1, 3)); // 1/(2 + 1)
/// assert_eq!(centre_weight(&q(4, 1), &q(-1, 1)), q(-1, 3)); // −1/(4 − 1)
/// ```
pub fn centre_weight<T: Field>(n: &T, lambda: &T) -> T {
    lambda.clone() / (n.clone() + lambda.clone())
}

/// The weight of each of the 2n points on the axes, 1/(2(n + λ)).
///
/// Source: as [`unscented`].
///
/// Example: for n = 2, λ = 1.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::rule::unscented::axis_weight;
///
/// let q = Rational::new;
/// assert_eq!(axis_weight(&q(2, 1), &q(1, 1)), q(1, 6)); // 1/(2 · (2 + 1))
/// ```
pub fn axis_weight<T: Field>(n: &T, lambda: &T) -> T {
    T::one() / (T::integer(2) * (n.clone() + lambda.clone()))
}
