//! Range and bearing turned into a position, and the covariance that the position then has: four conversions.
//!
//! ```text
//! z = f r (cos θ, sin θ)                                     f: the factor of the conversion, near 1
//! R = a u uᵀ + b n nᵀ,   u = (cos θ, sin θ), n = (−sin θ, cos θ)    a along the line of sight, b across it
//!
//!                       f              is unbiased      R is
//! standard              1              never            J diag(σ_r², σ_θ²) Jᵀ, to first order
//! additive              1 − (w² − w)   to first order   E[ Cov[r u ∣ truth] ∣ z ]
//! multiplicative        1/w            given the truth  E[ (z − x)(z − x)ᵀ ∣ z ]
//! modified unbiased     w              given z          Cov[x ∣ z]
//!
//! w = e^(−σ_θ²/2)
//! ```
//!
//! In all four σ_r and σ_θ are of the sensor, r and θ are as measured. With w, which [`attenuation`] gives, all equations are polynomials
//! and quotients, so that they are proven as such. To first order in the variances all four have the same R, and the factors 1, 1 + σ²/2,
//! 1 + σ²/2 and 1 − σ²/2. Which of them still says the truth about its own error beyond that is in the table and the figure of
//! [`report::conversion`](crate::report::conversion).
//!
//! What rounding takes: the variances of the last three are differences of terms as large as r² that nearly cancel. Doubles lose up to
//! about r² 2⁻⁵¹ there: 4·10⁻⁶ m² at 100 km, beside σ_r² of some m². At σ_r = 1 mm and 100 km nothing would be left.

use super::conversion_moments::{attenuation, second_moments};
use crate::number::{Field, Real};
use nalgebra::{Matrix2, Vector2};
use std::fmt;
use std::str::FromStr;

/// A way to convert range and bearing into a position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Conversion {
    /// `standard`: as sustika2015 has it.
    Standard,
    /// `additive`: the mean of the bias is subtracted. Lerro and Bar-Shalom 1993.
    Additive,
    /// `multiplicative`: divided by what the noise takes away. Longbin, Xiaoquan, Yiyu, Kang and Bar-Shalom 1998.
    Multiplicative,
    /// `modified-unbiased`: the mean of where the target may be. Duan, Han and Li 2004.
    ModifiedUnbiased,
}

/// A conversion that does not exist was asked for.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{name}` is no conversion: standard, additive, multiplicative, modified-unbiased")]
pub struct UnknownConversion {
    /// What was asked for.
    pub name: String,
}

impl Conversion {
    /// All, in the order of their years.
    pub const ALL: [Self; 4] = [
        Self::Standard,
        Self::Additive,
        Self::Multiplicative,
        Self::ModifiedUnbiased,
    ];

    /// The name in files and on the command line.
    ///
    /// Source: the literature's names.
    ///
    /// Example: what a problem file calls them.
    ///
    /// ```
    /// use immaculate::model::Conversion;
    ///
    /// assert_eq!(Conversion::ALL.map(Conversion::name), ["standard", "additive", "multiplicative", "modified-unbiased"]);
    /// assert_eq!("additive".parse(), Ok(Conversion::Additive));
    /// ```
    pub fn name(self) -> &'static str {
        match self {
            Self::Standard => "standard",
            Self::Additive => "additive",
            Self::Multiplicative => "multiplicative",
            Self::ModifiedUnbiased => "modified-unbiased",
        }
    }

    /// The converted position z, m.
    ///
    /// Source: [`converted_position`], which is sustika2015 (20)-(21), times [`Conversion::factor`].
    ///
    /// Range and bearing as measured, m and rad, counter-clockwise from x; the standard one ignores the bearing's variance, rad².
    ///
    /// Example: 1000 m at 90°, with σ_θ = 0.1 rad: w = e^(−0.005), so that the noise takes 5 m away.
    ///
    /// ```
    /// use immaculate::model::Conversion;
    ///
    /// let y = |conversion: Conversion| conversion.position(&1000.0, &std::f64::consts::FRAC_PI_2, &0.01)[1];
    /// assert_eq!(Conversion::ALL.map(y).map(f64::round), [1000.0, 1005.0, 1005.0, 995.0]);
    /// ```
    ///
    /// Evidence: as [`converted_position`], [`additive_factor`], [`multiplicative_factor`] and [`modified_unbiased_factor`].
    pub fn position<T: Real>(self, range: &T, bearing: &T, bearing_variance: &T) -> Vector2<T> {
        let position = converted_position(range, &bearing.cos(), &bearing.sin());
        match self {
            Self::Standard => position,
            _ => position * self.factor(&attenuation(bearing_variance)),
        }
    }

    /// The covariance R of the converted position, m².
    ///
    /// Source: [`Conversion::variances`], turned by [`in_the_plane`]; of the standard one it is sustika2015 (22)-(26).
    ///
    /// Range and bearing as measured, m and rad, counter-clockwise from x; the variances of the sensor, m² and rad².
    ///
    /// Example: 1000 m at 90°, with σ_r = 10 m and σ_θ = 0.1 rad, is 100 m uncertain across and 10 m along, by the standard conversion; the
    /// others know that the arc bends.
    ///
    /// ```
    /// use immaculate::model::Conversion;
    ///
    /// let y = |conversion: Conversion| {
    ///     let r = conversion.covariance(&1000.0, &std::f64::consts::FRAC_PI_2, &100.0, &0.01);
    ///     r[(1, 1)].sqrt().round()
    /// };
    /// assert_eq!(Conversion::ALL.map(y), [10.0, 16.0, 16.0, 12.0]);
    /// ```
    ///
    /// Evidence: as [`converted_covariance`], [`additive_variances`], [`multiplicative_variances`] and [`modified_unbiased_variances`].
    pub fn covariance<T: Real>(self, range: &T, bearing: &T, range_variance: &T, bearing_variance: &T) -> Matrix2<T> {
        if self == Self::Standard {
            return converted_covariance(range, &bearing.cos(), &bearing.sin(), range_variance, bearing_variance);
        }
        let (squared_range, w) = (range.clone() * range.clone(), attenuation(bearing_variance));
        let variances = self.variances(&squared_range, range_variance, bearing_variance, &w);
        in_the_plane(&variances, &bearing.cos(), &bearing.sin())
    }

    /// The factor f of the conversion, from w.
    ///
    /// Source: the equation of that conversion in this file.
    ///
    /// Example: at w = 1/2, which is a bearing of no use, σ_θ = 67°.
    ///
    /// ```
    /// use immaculate::model::Conversion;
    /// // 1, 1 − (¼ − ½), 1/½, ½
    /// assert_eq!(Conversion::ALL.map(|conversion| conversion.factor(&0.5)), [1.0, 1.25, 2.0, 0.5]);
    /// ```
    ///
    /// Evidence: `the_covariances_agree_to_first_order_and_the_factors_do_not` (symbolic).
    pub fn factor<T: Field>(self, attenuation: &T) -> T {
        match self {
            Self::Standard => T::one(),
            Self::Additive => additive_factor(attenuation),
            Self::Multiplicative => multiplicative_factor(attenuation),
            Self::ModifiedUnbiased => modified_unbiased_factor(attenuation),
        }
    }

    /// The variances a and b along and across the line of sight, m².
    ///
    /// Source: the equation of that conversion in this file.
    ///
    /// Example: at 10 m with σ_r = 2 m, σ_θ² = 0.02, to the nearest square decimetre.
    ///
    /// ```
    /// use immaculate::model::{Conversion, conversion_moments::attenuation};
    ///
    /// let variances = |conversion: Conversion| {
    ///     conversion.variances(&100.0, &4.0, &0.02, &attenuation(&0.02)).map(|m2| (100.0 * m2).round() / 100.0)
    /// };
    /// assert_eq!(Conversion::ALL.map(variances), [[4.0, 2.0], [3.91, 2.15], [3.98, 2.04], [3.94, 2.04]]);
    /// ```
    ///
    /// Evidence: `the_covariances_agree_to_first_order_and_the_factors_do_not` (symbolic),
    /// `doubles_lose_the_squared_range_times_their_last_place` (enclosed).
    pub fn variances<T: Field>(
        self,
        squared_range: &T,
        range_variance: &T,
        bearing_variance: &T,
        attenuation: &T,
    ) -> [T; 2] {
        match self {
            Self::Standard => standard_variances(squared_range, range_variance, bearing_variance),
            Self::Additive => additive_variances(squared_range, range_variance, attenuation),
            Self::Multiplicative => multiplicative_variances(squared_range, range_variance, attenuation),
            Self::ModifiedUnbiased => modified_unbiased_variances(squared_range, range_variance, attenuation),
        }
    }
}

impl fmt::Display for Conversion {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

impl FromStr for Conversion {
    type Err = UnknownConversion;

    fn from_str(name: &str) -> Result<Self, UnknownConversion> {
        let found = Self::ALL.into_iter().find(|conversion| conversion.name() == name);
        found.ok_or_else(|| UnknownConversion { name: name.to_owned() })
    }
}

/// Converted position — sustika2015 (20)-(21).
///
/// ```text
/// x = r cos θ,   y = r sin θ
/// ```
///
/// | paper | here              | unit | meaning       |
/// |-------|-------------------|------|---------------|
/// | r     | `range`           | m    | as measured   |
/// | θ     | `cosine`, `sine`  |      | of the bearing |
///
/// Source: sustika2015, section 3.1.
///
/// Why: the definition of polar coordinates. Given the truth its mean is w r (cos θ, sin θ) with w = e^(−σ_θ²/2) < 1: the measured
/// positions lie on an arc, and their mean inside of it. The bias is r σ_θ²/2 towards the sensor, to first order.
///
/// Example: 5 m in the direction (3/5, 4/5).
///
/// ```
/// use immaculate::model::conversion::converted_position;
/// assert_eq!(converted_position(&5.0, &0.6, &0.8).as_slice(), [3.0, 4.0]);
/// ```
///
/// Evidence: `the_moments_are_those_of_range_and_bearing`, `the_standard_covariance_is_the_first_order_propagation` (symbolic).
pub fn converted_position<T: Field>(range: &T, cosine: &T, sine: &T) -> Vector2<T> {
    Vector2::new(range.clone() * cosine.clone(), range.clone() * sine.clone())
}

/// Converted covariance — sustika2015 (22)-(26).
///
/// ```text
/// R = ⎡ σ_x²  σ_xy ⎤     σ_x² = r² σ_θ² sin²θ + σ_r² cos²θ
///     ⎣ σ_xy  σ_y² ⎦     σ_y² = r² σ_θ² cos²θ + σ_r² sin²θ
///                        σ_xy = (σ_r² − r² σ_θ²) sin θ cos θ
/// ```
///
/// | paper | here               | unit | meaning        |
/// |-------|--------------------|------|----------------|
/// | r     | `range`            | m    | as measured    |
/// | θ     | `cosine`, `sine`   |      | of the bearing |
/// | σ_r²  | `range_variance`   | m²   | of the sensor  |
/// | σ_θ²  | `bearing_variance` | rad² | of the sensor  |
///
/// Source: sustika2015, section 3.1; Bar-Shalom, Li and Kirubarajan 2001, section 10.4.3.
///
/// Why: J diag(σ_r², σ_θ²) Jᵀ with the Jacobian J = (u, r n) of the position: the variances σ_r² along and r² σ_θ² across the line of
/// sight ([`standard_variances`]), turned ([`in_the_plane`]). What is left out is of second order in the variances; the rule of thumb is
/// that it is small while r σ_θ²/σ_r < 0.4 and σ_θ < 0.4 rad.
///
/// Example: 10 m away in the direction (3/5, 4/5), 1 m² along and 2 m² across the line of sight.
///
/// ```
/// use immaculate::{model::conversion::converted_covariance, number::Rational};
/// use nalgebra::matrix;
///
/// let q = Rational::new;
/// let r = converted_covariance(&q(10, 1), &q(3, 5), &q(4, 5), &q(1, 1), &q(2, 100));
/// // 2 · 16/25 + 1 · 9/25, (1 − 2) · 12/25, 2 · 9/25 + 1 · 16/25
/// assert_eq!(r, matrix![q(41, 25), q(-12, 25); q(-12, 25), q(34, 25)]);
/// ```
///
/// Evidence: `the_standard_covariance_is_the_first_order_propagation` (symbolic), `the_slopes_of_a_position_give_its_covariance`
/// (property).
pub fn converted_covariance<T: Field>(
    range: &T,
    cosine: &T,
    sine: &T,
    range_variance: &T,
    bearing_variance: &T,
) -> Matrix2<T> {
    let squared_range = range.clone() * range.clone();
    let variances = standard_variances(&squared_range, range_variance, bearing_variance);
    in_the_plane(&variances, cosine, sine)
}

/// A covariance in the plane from its variances along and across the line of sight: a u uᵀ + b n nᵀ.
///
/// ```text
/// ⎡ a cos²θ + b sin²θ   (a − b) sin θ cos θ ⎤
/// ⎣ (a − b) sin θ cos θ   a sin²θ + b cos²θ ⎦
/// ```
///
/// Source: u = (cos θ, sin θ) and n = (−sin θ, cos θ), multiplied out.
///
/// Example: straight ahead and to the left the axes are those of the plane.
///
/// ```
/// use immaculate::model::conversion::in_the_plane;
/// use nalgebra::matrix;
///
/// assert_eq!(in_the_plane(&[4.0, 9.0], &1.0, &0.0), matrix![4.0, 0.0; 0.0, 9.0]);
/// assert_eq!(in_the_plane(&[4.0, 9.0], &0.0, &1.0), matrix![9.0, 0.0; 0.0, 4.0]);
/// ```
///
/// Evidence: `a_covariance_has_its_variances_along_and_across_the_line_of_sight` (symbolic).
pub fn in_the_plane<T: Field>([along, across]: &[T; 2], cosine: &T, sine: &T) -> Matrix2<T> {
    let (a, b) = (|| along.clone(), || across.clone());
    let (c, s) = (|| cosine.clone(), || sine.clone());
    let crossed = || (a() - b()) * s() * c();
    Matrix2::new(
        a() * c() * c() + b() * s() * s(),
        crossed(),
        crossed(),
        a() * s() * s() + b() * c() * c(),
    )
}

/// The variances of the standard conversion along and across the line of sight, m²: a = σ_r², b = r² σ_θ².
///
/// Source: sustika2015 (24)-(26), at θ = 0.
///
/// Singular where r = 0, though the position of a target that is measured at the sensor is as uncertain in every direction.
///
/// Example: sustika2015's radar at 1.4 km, with σ_r = 10 m and σ_θ = 1°: 24 m across.
///
/// ```
/// use immaculate::model::conversion::standard_variances;
///
/// let degree = 1.0_f64.to_radians();
/// let [along, across] = standard_variances(&(1400.0 * 1400.0), &100.0, &(degree * degree));
/// assert_eq!([along.sqrt(), across.sqrt().round()], [10.0, 24.0]);
/// ```
///
/// Evidence: `every_covariance_is_positive_definite_but_the_standard_one_at_the_sensor` (symbolic).
pub fn standard_variances<T: Field>(squared_range: &T, range_variance: &T, bearing_variance: &T) -> [T; 2] {
    [range_variance.clone(), squared_range.clone() * bearing_variance.clone()]
}

/// The factor of the additive conversion.
///
/// ```text
/// f = 1 − (e^(−σ_θ²) − e^(−σ_θ²/2)) = 1 − (w² − w)
/// ```
///
/// Why: given the truth, r u is biased by (w − 1) times the true position; given the measurement, the true position is w r u on average.
/// The mean of the bias, w (w − 1) r u, is subtracted. What is left is the bias given the truth of (1 − (w² − w)) w − 1 = −(1 − w)²(1 + w)
/// times the position, of second order.
///
/// Source: Lerro and Bar-Shalom, IEEE Transactions on Aerospace and Electronic Systems 29(3), 1993, pages 1015-1022.
///
/// Example: at w = 1/2 the mean of the bias is ¼ − ½ of the position.
///
/// ```
/// use immaculate::model::conversion::additive_factor;
/// assert_eq!(additive_factor(&0.5), 1.25);
/// ```
///
/// Evidence: `the_additive_conversion_subtracts_the_mean_of_the_bias_and_has_the_mean_of_the_covariance` (symbolic).
pub fn additive_factor<T: Field>(attenuation: &T) -> T {
    let w = || attenuation.clone();
    T::one() - (w() * w() - w())
}

/// The variances of the additive conversion along and across the line of sight, m².
///
/// ```text
/// a = r² w⁴ (cosh 2σ² − cosh σ²) + σ_r² w⁴ (2 cosh 2σ² − cosh σ²) = ½(1 + w⁸)(r² + 2σ_r²) − ½ w² (1 + w⁴)(r² + σ_r²)
/// b = r² w⁴ (sinh 2σ² − sinh σ²) + σ_r² w⁴ (2 sinh 2σ² − sinh σ²) = ½(1 − w⁸)(r² + 2σ_r²) − ½ w² (1 − w⁴)(r² + σ_r²)
/// ```
///
/// Why: the covariance of r u given the truth, on average over where the truth may be given the measurement. The first form is the
/// published one at θ = 0, with σ = σ_θ; e^(−2σ²) is w⁴. It is a covariance about the mean of r u, to which f is not applied, and
/// not the mean squared error of z: the two differ in the second order.
///
/// Source: Lerro and Bar-Shalom 1993, as [`additive_factor`].
///
/// Example: at r = 0, σ_r² = 1, w² = 1/2 nothing but the range's noise is left, the same in all directions.
///
/// ```
/// use immaculate::{model::conversion::additive_variances, number::{Field, Rational, Surd}};
///
/// let w = Surd::root(&Rational::new(1, 2));
/// // ½ · 17/16 · 2 − ½ · ½ · 5/4, and ½ · 15/16 · 2 − ½ · ½ · 3/4
/// assert_eq!(additive_variances(&Surd::integer(0), &Surd::integer(1), &w), [Surd::ratio(3, 4), Surd::ratio(3, 4)]);
/// ```
///
/// Evidence: `the_additive_conversion_subtracts_the_mean_of_the_bias_and_has_the_mean_of_the_covariance`,
/// `the_additive_covariance_is_the_published_one` (symbolic).
pub fn additive_variances<T: Field>(squared_range: &T, range_variance: &T, attenuation: &T) -> [T; 2] {
    let squared = attenuation.clone() * attenuation.clone();
    let fourth = squared.clone() * squared.clone();
    let eighth = fourth.clone() * fourth.clone();
    let once = squared_range.clone() + range_variance.clone();
    let twice = once.clone() + range_variance.clone();
    let with_sign = |sign: i64| {
        let sign = || T::integer(sign);
        let moment = (T::one() + sign() * eighth.clone()) * twice.clone();
        let mean = squared.clone() * (T::one() + sign() * fourth.clone()) * once.clone();
        (moment - mean) / T::integer(2)
    };
    [with_sign(1), with_sign(-1)]
}

/// The factor of the multiplicative conversion.
///
/// ```text
/// f = e^(σ_θ²/2) = 1/w
/// ```
///
/// Why: given the truth, E[r u] is w times the true position.
///
/// Source: Longbin, Xiaoquan, Yiyu, Kang and Bar-Shalom, IEEE Transactions on Aerospace and Electronic Systems 34(3), 1998, pages
/// 1023-1027.
///
/// Example: what was halved is doubled.
///
/// ```
/// use immaculate::model::conversion::multiplicative_factor;
/// assert_eq!(multiplicative_factor(&0.5), 2.0);
/// ```
///
/// Evidence: `the_multiplicative_conversion_is_unbiased_given_the_truth_and_has_its_error_given_the_measurement` (symbolic).
pub fn multiplicative_factor<T: Field>(attenuation: &T) -> T {
    T::one() / attenuation.clone()
}

/// The variances of the multiplicative conversion along and across the line of sight, m².
///
/// ```text
/// a = (w⁻² − 2) r² + ½(1 + w⁴)(r² + σ_r²)
/// b = ½(1 − w⁴)(r² + σ_r²)
/// ```
///
/// Why: E[(z − x)(z − x)ᵀ ∣ z] with z = r u/w: z zᵀ = w⁻² r² u uᵀ, z E[x ∣ z]ᵀ = r² u uᵀ, and E[x xᵀ ∣ z]. The position is unbiased
/// given the truth, and the covariance is given the measurement, about a z that is not the mean then: what modified unbiased mends.
///
/// Source: Longbin et al. 1998, as [`multiplicative_factor`].
///
/// Example: at r² = 16, σ_r² = 16, w² = 1/2.
///
/// ```
/// use immaculate::{model::conversion::multiplicative_variances, number::{Field, Rational, Surd}};
///
/// let (w, sixteen) = (Surd::root(&Rational::new(1, 2)), Surd::integer(16));
/// // (2 − 2) · 16 + ½ · 5/4 · 32, and ½ · 3/4 · 32
/// assert_eq!(multiplicative_variances(&sixteen, &sixteen, &w), [Surd::integer(20), Surd::integer(12)]);
/// ```
///
/// Evidence: `the_multiplicative_conversion_is_unbiased_given_the_truth_and_has_its_error_given_the_measurement` (symbolic).
pub fn multiplicative_variances<T: Field>(squared_range: &T, range_variance: &T, attenuation: &T) -> [T; 2] {
    let squared = attenuation.clone() * attenuation.clone();
    let bias = (T::one() / squared.clone() - T::integer(2)) * squared_range.clone();
    let [along, across] = second_moments(squared_range, range_variance, attenuation);
    [bias + along, across]
}

/// The factor of the modified unbiased conversion.
///
/// ```text
/// f = e^(−σ_θ²/2) = w
/// ```
///
/// Why: given the measurement, w r u is the mean of where the target may be: nearer than r, as the arc bends towards the sensor.
///
/// Source: Duan, Han and Li, "Comments on unbiased converted measurements for tracking", IEEE Transactions on Aerospace and Electronic
/// Systems 40(4), 2004, pages 1374-1377.
///
/// Example: a target measured at 1000 m is expected at 500 m if its bearing is of no use.
///
/// ```
/// use immaculate::model::conversion::modified_unbiased_factor;
/// assert_eq!(modified_unbiased_factor(&0.5), 0.5);
/// ```
///
/// Evidence: `the_modified_unbiased_conversion_is_mean_and_covariance_given_the_measurement` (symbolic).
pub fn modified_unbiased_factor<T: Field>(attenuation: &T) -> T {
    attenuation.clone()
}

/// The variances of the modified unbiased conversion along and across the line of sight, m².
///
/// ```text
/// a = ½(1 + w⁴)(r² + σ_r²) − w² r²
/// b = ½(1 − w⁴)(r² + σ_r²)
/// ```
///
/// Why: Cov[x ∣ z] = E[x xᵀ ∣ z] − z zᵀ with z = w r u.
///
/// Source: Duan, Han and Li 2004, as [`modified_unbiased_factor`].
///
/// Example: at r² = 16, σ_r² = 16, w² = 1/2.
///
/// ```
/// use immaculate::{model::conversion::modified_unbiased_variances, number::{Field, Rational, Surd}};
///
/// let (w, sixteen) = (Surd::root(&Rational::new(1, 2)), Surd::integer(16));
/// // ½ · 5/4 · 32 − ½ · 16, and ½ · 3/4 · 32
/// assert_eq!(modified_unbiased_variances(&sixteen, &sixteen, &w), [Surd::integer(12), Surd::integer(12)]);
/// ```
///
/// Evidence: `the_modified_unbiased_conversion_is_mean_and_covariance_given_the_measurement` (symbolic).
pub fn modified_unbiased_variances<T: Field>(squared_range: &T, range_variance: &T, attenuation: &T) -> [T; 2] {
    let squared = attenuation.clone() * attenuation.clone();
    let [along, across] = second_moments(squared_range, range_variance, attenuation);
    [along - squared * squared_range.clone(), across]
}
