//! A fixed-gain filter on a target that it does not model: its lag, and its long-term error.
//!
//! Equation (7) of derbez2000, its solution, and the conditions for its existence.
//!
//! ```text
//! e₍n+1₎ = A₊ eₙ + b₊ − K₊ v₍n+1₎,   A₊ = (I − K₊H) F,   b₊ = (I − K₊H) b,   b = ΔF xₙ = a [t²/2, t, 1]ᵀ
//! m  = A₊ m + b₊                      the mean, where the error settles: the lag
//! C  = A₊ C A₊ᵀ + K₊ R K₊ᵀ            the covariance about it
//! Pᵉ = C + m mᵀ                       what (7) is solved by
//! ```
//!
//! Where the solution exists. All of it needs ρ(A₊) < 1. The gain K₊ comes from a Riccati equation, whose solution stabilises exactly if
//! (H, F) is detectable and no mode of F *on* the unit circle is out of reach of the noise G Q Gᵀ. The paper asks for (F, G) to be
//! stabilisable and says that the gains "may" be computed with a noise that is not zero. They must: constant velocity has a double mode at
//! 1, and with Q = 0 the gain falls to zero, A₊ becomes F, and nothing settles.

use super::linear::stein;
use super::perturbation::second_moment;
use crate::model::acceleration::acceleration_response;
use crate::number::Field;
use nalgebra::{Matrix3, RowVector3, Vector3};

/// A filter in its steady state, and what it does not know of its target.
#[derive(Debug, Clone, PartialEq)]
pub struct Mismatch<T> {
    /// A₊.
    pub closed_loop: Matrix3<T>,
    /// b₊.
    pub missed: Vector3<T>,
    /// K₊.
    pub gain: Vector3<T>,
    /// R.
    pub measurement_variance: T,
}

impl<T: Field> Mismatch<T> {
    /// The filter with motion F, measurement H and gain K₊ on a target that moves by b more than F says — derbez2000 (steady-matrices).
    ///
    /// Source: derbez2000, section 2.2, the definitions below (7).
    ///
    /// ```text
    /// A₊ = (I − K₊H) F,   b₊ = (I − K₊H) ΔF xₙ = (I − K₊H) b
    /// ```
    ///
    /// Example: for t = 1, a = 1, K = [3/4, 1/2, 0]ᵀ: b = [1/2, 1, 1]ᵀ and (I − K H) b = [1/2 − 3/8, 1 − 1/4, 1]ᵀ.
    ///
    /// ```
    /// use immaculate::model::acceleration::{embedded_constant_velocity, position_matrix};
    /// use immaculate::number::Rational;
    /// use immaculate::steady::mismatch::{Mismatch, motion_missed};
    /// use nalgebra::vector;
    ///
    /// let (q, one) = (Rational::new, Rational::new(1, 1));
    /// let gain = vector![q(3, 4), q(1, 2), q(0, 1)];
    /// let missed = motion_missed(&one, &one);
    /// let filter = Mismatch::new(&embedded_constant_velocity(&one), &position_matrix(), gain, &missed, one);
    /// assert_eq!(filter.missed, vector![q(1, 8), q(3, 4), q(1, 1)]);
    /// ```
    ///
    /// Evidence: `the_long_term_error_is_that_of_a_simulation` (statistics).
    pub fn new(
        transition: &Matrix3<T>,
        measurement: &RowVector3<T>,
        gain: Vector3<T>,
        motion_missed: &Vector3<T>,
        measurement_variance: T,
    ) -> Self {
        let kept = Matrix3::identity() - &gain * measurement;
        Self {
            closed_loop: &kept * transition,
            missed: kept * motion_missed,
            gain,
            measurement_variance,
        }
    }

    /// The lag: the mean of the error in its steady state, m = (I − A₊)⁻¹ b₊ — derbez2000 (proposition).
    ///
    /// Source: derbez2000 (7), in which it stands as (I − A₊)⁻¹ b₊; undecided where I − A₊ has no inverse.
    ///
    /// Example: A₊ = [1/4 1/4 0; −1/2 1/2 0; 0 0 0] and b₊ = [1/8, 3/4, 1]ᵀ carry m = [1/2, 1, 1]ᵀ into itself: 1/8 + 1/4 + 1/8 = 1/2 and
    /// −1/4 + 1/2 + 3/4 = 1.
    ///
    /// ```
    /// use immaculate::model::acceleration::{embedded_constant_velocity, position_matrix};
    /// use immaculate::number::Rational;
    /// use immaculate::steady::mismatch::{Mismatch, motion_missed};
    /// use nalgebra::vector;
    ///
    /// let (q, one) = (Rational::new, Rational::new(1, 1));
    /// let gain = vector![q(3, 4), q(1, 2), q(0, 1)];
    /// let missed = motion_missed(&one, &one);
    /// let filter = Mismatch::new(&embedded_constant_velocity(&one), &position_matrix(), gain, &missed, one);
    /// assert_eq!(filter.lag(), vector![q(1, 2), q(1, 1), q(1, 1)]);
    /// ```
    ///
    /// Evidence: `the_mismatch_equation_has_the_stated_solution`, `the_lag_has_a_closed_form` (symbolic).
    pub fn lag(&self) -> Vector3<T> {
        inverse(&(Matrix3::identity() - &self.closed_loop)) * &self.missed
    }

    /// The right side of the equation for the long-term error, as it is printed — derbez2000 (7).
    ///
    /// ```text
    /// Pᵉ = A₊PᵉA₊ᵀ + b₊b₊ᵀ + b₊b₊ᵀA₊ᵀ(I − A₊ᵀ)⁻¹ + A₊(I − A₊)⁻¹b₊b₊ᵀ + K₊RK₊ᵀ
    /// ```
    ///
    /// | paper | here                   | shape | meaning                                               |
    /// |-------|------------------------|-------|-------------------------------------------------------|
    /// | Pᵉ    | `error`                | 3 × 3 | second moment of the error, not only its covariance    |
    /// | A₊    | `closed_loop`          | 3 × 3 | carries the error from one update to the next           |
    /// | b₊    | `missed`               | 3     | what is added to it at every step                       |
    /// | K₊    | `gain`                 | 3     | the steady gain                                         |
    /// | R     | `measurement_variance` |       | m²                                                      |
    ///
    /// Why: the second moment of A₊e + b₊ − K₊v, where E e = (I − A₊)⁻¹b₊ in the steady state and v is independent of e. It is an equality
    /// for the whole matrix; the paper states it as a bound of its trace, which adds m² and (m/s)² and always contains a².
    ///
    /// Example: for t = a = R = 1, K = [3/4, 1/2, 0]ᵀ: the scatter [2/3 1/3; 1/3 1/3] and the lag m = [1/2, 1, 1]ᵀ, times its transpose.
    ///
    /// ```
    /// use immaculate::model::acceleration::{embedded_constant_velocity, position_matrix};
    /// use immaculate::number::Rational;
    /// use immaculate::steady::mismatch::{Mismatch, motion_missed};
    /// use nalgebra::{matrix, vector};
    ///
    /// let (q, one) = (Rational::new, Rational::new(1, 1));
    /// let gain = vector![q(3, 4), q(1, 2), q(0, 1)];
    /// let missed = motion_missed(&one, &one);
    /// let filter = Mismatch::new(&embedded_constant_velocity(&one), &position_matrix(), gain, &missed, one);
    /// let error = matrix![11, 10, 6; 10, 16, 12; 6, 12, 12].map(|entry| q(entry, 12));
    /// assert_eq!(filter.right_side(&error), error);
    /// ```
    ///
    /// Errata: (F, G) stabilisable is not enough for the solution to exist, see the head of this file.
    ///
    /// Evidence: `the_mismatch_equation_has_the_stated_solution` (symbolic), `the_long_term_error_is_that_of_a_simulation` (statistics),
    /// `without_process_noise_nothing_settles` (exact).
    pub fn right_side(&self, error: &Matrix3<T>) -> Matrix3<T> {
        let Self {
            closed_loop: a,
            missed: b,
            gain: k,
            ..
        } = self;
        let identity = Matrix3::<T>::identity;
        let carried = a * error * a.transpose();
        let missed = b * b.transpose();
        let after = &missed * a.transpose() * inverse(&(identity() - a.transpose()));
        let before = a * inverse(&(identity() - a)) * &missed;
        let noise = k * k.transpose() * self.measurement_variance.clone();
        carried + missed + after + before + noise
    }
}

impl<T: Field + PartialOrd> Mismatch<T> {
    /// The long-term error: the solution of the equation, C + m mᵀ — derbez2000 (7), (proposition).
    ///
    /// ```text
    /// C = A₊ C A₊ᵀ + K₊ R K₊ᵀ,   m = (I − A₊)⁻¹ b₊
    /// ```
    ///
    /// | paper | here       | shape | meaning                                        |
    /// |-------|------------|-------|------------------------------------------------|
    /// | Pᵉ    | the result | 3 × 3 | second moment of the error in the steady state  |
    ///
    /// Why: inserted into the right side of (7), m mᵀ gives (A₊m + b₊)(A₊m + b₊)ᵀ = m mᵀ, and C the rest. None where the equation has not
    /// exactly one solution. A solution is the long-term error only if ρ(A₊) < 1; that is for the caller to know, see
    /// [`has_radius_below`](super::polynomial::has_radius_below).
    ///
    /// Example: for t = a = R = 1, K = [3/4, 1/2, 0]ᵀ: a variance of 2/3 and a lag of 1/2, 2/3 + 1/4.
    ///
    /// ```
    /// use immaculate::model::acceleration::{embedded_constant_velocity, position_matrix};
    /// use immaculate::number::Rational;
    /// use immaculate::steady::mismatch::{Mismatch, motion_missed};
    /// use nalgebra::vector;
    ///
    /// let (q, one) = (Rational::new, Rational::new(1, 1));
    /// let missed = motion_missed(&one, &one);
    /// let filter = |gain| Mismatch::new(&embedded_constant_velocity(&one), &position_matrix(), gain, &missed, one.clone());
    /// let error = filter(vector![q(3, 4), q(1, 2), q(0, 1)]).long_term_error().unwrap();
    /// assert_eq!(error[(0, 0)], q(11, 12));
    /// // The gain that process noise of zero ends with: nothing settles.
    /// assert_eq!(filter(vector![q(0, 1), q(0, 1), q(0, 1)]).long_term_error(), None);
    /// ```
    ///
    /// Evidence: `the_mismatch_equation_has_the_stated_solution` (exact), `without_process_noise_nothing_settles` (exact).
    pub fn long_term_error(&self) -> Option<Matrix3<T>> {
        let noise = &self.gain * self.gain.transpose() * self.measurement_variance.clone();
        let covariance = stein(&self.closed_loop, &noise)?;
        let error = second_moment(&self.lag(), &covariance);
        error.iter().all(Field::is_decided).then_some(error)
    }
}

/// What a constant velocity filter does not know of a target with the acceleration a: b = ΔF xₙ = a [t²/2, t, 1]ᵀ — derbez2000
/// (constant-acceleration-input).
///
/// Source: derbez2000, section 2.2, not numbered.
///
/// Example: for a = 3, t = 2: 3 · [2, 2, 1].
///
/// ```
/// use immaculate::number::{Field, Rational};
/// use immaculate::steady::mismatch::motion_missed;
/// use nalgebra::vector;
///
/// let missed = motion_missed(&Rational::integer(3), &Rational::integer(2));
/// assert_eq!(missed, vector![6, 6, 3].map(Rational::integer));
/// ```
///
/// Evidence: `the_lag_has_a_closed_form` (symbolic).
pub fn motion_missed<T: Field>(acceleration: &T, interval: &T) -> Vector3<T> {
    acceleration_response(interval) * acceleration.clone()
}

/// The lag of the constant velocity filter with the gain [α, β/t, 0]ᵀ behind a constant acceleration, in closed form —
/// derbez2000 (proposition).
///
/// ```text
/// m = a [ t²(1 − α)/β,  t(2α − β)/(2β),  1 ]ᵀ
/// ```
///
/// | here           | unit | meaning                                          |
/// |----------------|------|--------------------------------------------------|
/// | `gain`         | 1, s⁻¹, s⁻² | [α, β/t, 0]ᵀ, `alpha_beta_gain` of [`super::gains`] |
/// | `acceleration` | m/s² | a                                                 |
/// | `interval`     | s    | t                                                 |
///
/// Source: the solution of derbez2000 (7); in the tracking literature Benedict and Bordner 1962.
///
/// Example: for α = 3/4, β = 1/2, t = 1, a = 1: (1/4)/(1/2) and (3/2 − 1/2)/(2 · 1/2).
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::mismatch::alpha_beta_lag;
/// use nalgebra::vector;
///
/// let (q, one) = (Rational::new, Rational::new(1, 1));
/// let lag = alpha_beta_lag(&vector![q(3, 4), q(1, 2), q(0, 1)], &one, &one);
/// assert_eq!(lag, vector![q(1, 2), q(1, 1), q(1, 1)]);
/// ```
///
/// Evidence: `the_lag_has_a_closed_form` (symbolic).
pub fn alpha_beta_lag<T: Field>(gain: &Vector3<T>, acceleration: &T, interval: &T) -> Vector3<T> {
    let (t, two) = (|| interval.clone(), || T::integer(2));
    let (alpha, beta) = (gain[0].clone(), gain[1].clone() * t());
    let position = t() * t() * (T::one() - alpha.clone()) / beta.clone();
    let velocity = t() * (two() * alpha - beta.clone()) / (two() * beta);
    Vector3::new(position, velocity, T::one()) * acceleration.clone()
}

/// The mean of that filter's innovation in the steady state, a t²/β, m.
///
/// Source: H (F m + b), with m from [`alpha_beta_lag`]. The bias of step 4 of the paper's algorithm, a t²/2, is that of a filter without a
/// lag: smaller by the factor β/2.
///
/// Example: for a = 1, t = 1, β = 1/2: 1/(1/2), four times the a t²/2 of step 4.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::mismatch::alpha_beta_innovation;
/// use nalgebra::vector;
///
/// let (q, one) = (Rational::new, Rational::new(1, 1));
/// let bias = alpha_beta_innovation(&vector![q(3, 4), q(1, 2), q(0, 1)], &one, &one);
/// assert_eq!(bias, q(2, 1));
/// ```
///
/// Evidence: `the_lag_has_a_closed_form` (symbolic).
pub fn alpha_beta_innovation<T: Field>(gain: &Vector3<T>, acceleration: &T, interval: &T) -> T {
    acceleration.clone() * interval.clone() / gain[1].clone()
}

/// The covariance of that filter's error about its lag: what the measurement noise alone does.
///
/// ```text
///             R        ⎡ 2α² + β(2 − 3α)   β(2α − β)/t   0 ⎤
/// C = ──────────────── ⎢ β(2α − β)/t       2β²/t²        0 ⎥
///     α (4 − 2α − β)   ⎣ 0                 0             0 ⎦
/// ```
///
/// | here                   | unit | meaning                                            |
/// |------------------------|------|----------------------------------------------------|
/// | `gain`                 | 1, s⁻¹, s⁻² | [α, β/t, 0]ᵀ                                 |
/// | `measurement_variance` | m²   | R                                                   |
/// | `interval`             | s    | t                                                   |
///
/// Source: Benedict and Bordner 1962, variance reduction of the α-β filter.
///
/// Example: for α = 3/4, β = 1/2, R = t = 1: 1/(3/4 · (4 − 3/2 − 1/2)) = 2/3 times 2 · 9/16 + 1/2 · (2 − 9/4) = 1, 1/2 · (3/2 − 1/2) = 1/2
/// and 2 · 1/4 = 1/2.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::mismatch::alpha_beta_scatter;
/// use nalgebra::{matrix, vector};
///
/// let (q, one) = (Rational::new, Rational::new(1, 1));
/// let scatter = alpha_beta_scatter(&vector![q(3, 4), q(1, 2), q(0, 1)], &one, &one);
/// assert_eq!(scatter, matrix![2, 1, 0; 1, 1, 0; 0, 0, 0].map(|entry| q(entry, 3)));
/// ```
///
/// Evidence: `the_mismatch_equation_has_the_stated_solution` (symbolic).
#[rustfmt::skip]
pub fn alpha_beta_scatter<T: Field>(gain: &Vector3<T>, measurement_variance: &T, interval: &T) -> Matrix3<T> {
    let (o, t, n) = (T::zero, || interval.clone(), |value: i64| T::integer(value));
    let (a, b) = (|| gain[0].clone(), || gain[1].clone() * interval.clone());
    let position = n(2) * a() * a() + b() * (n(2) - n(3) * a());
    let mixed = b() * (n(2) * a() - b()) / t();
    let velocity = n(2) * b() * b() / (t() * t());
    let below = a() * (n(4) - n(2) * a() - b());
    let scaled = Matrix3::new(
        position, mixed.clone(), o(), //
        mixed, velocity, o(), //
        o(), o(), o(),
    );
    scaled * (measurement_variance.clone() / below)
}

/// The inverse by cofactors, A⁻¹ = adj A/|A|: the form that needs no pivot, so that it can be run on unknowns.
///
/// Source: Cramer 1750; undecided where |A| is zero.
///
/// Example: a triangular matrix, and one that has no inverse.
///
/// ```
/// use immaculate::number::{Field, Rational};
/// use immaculate::steady::mismatch::inverse;
/// use nalgebra::matrix;
///
/// let whole = Rational::integer;
/// let inverted = inverse(&matrix![1, 1, 0; 0, 1, 1; 0, 0, 1].map(whole));
/// assert_eq!(inverted, matrix![1, -1, 1; 0, 1, -1; 0, 0, 1].map(whole));
/// // A row twice: the determinant is zero, and no entry is decided.
/// let inverted = inverse(&matrix![1, 1, 0; 1, 1, 0; 0, 0, 1].map(whole));
/// assert!(inverted.iter().all(|entry| !entry.is_decided()));
/// ```
pub fn inverse<T: Field>(matrix: &Matrix3<T>) -> Matrix3<T> {
    let entry = |i: usize, j: usize| matrix[(i % 3, j % 3)].clone();
    // The cyclic order of rows and columns takes care of the signs.
    let cofactor =
        |i: usize, j: usize| entry(i + 1, j + 1) * entry(i + 2, j + 2) - entry(i + 1, j + 2) * entry(i + 2, j + 1);
    let mut determinant = T::zero();
    for j in 0..3 {
        determinant += entry(0, j) * cofactor(0, j);
    }
    Matrix3::from_fn(|i, j| cofactor(j, i) / determinant.clone())
}
