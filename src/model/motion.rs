//! Motion models: constant velocity and coordinated turn, with their integrated process noise.
//!
//! In zhu2016 and liu2017 the matrices F and Q belong together. With white noise of spectral density q on the acceleration,
//!
//! ```text
//! F = e^{AT},     Q = ∫₀ᵀ e^{Aτ} L q Lᵀ e^{Aᵀτ} dτ
//! ```
//!
//! where A is the generator of the motion and L puts the noise on the velocities. A state is [x, ẋ, y, ẏ].
//!
//! Reading order: a [`Mode`] is such a pair with a name; [`constant_velocity`] and [`integrated_noise`] are the plainest one,
//! [`coordinated_turn`] and [`turn_noise`] the same along a circle, and [`acceleration_noise`] is the noise of zhu2016, whose acceleration
//! is constant over a step and not white.

use super::function::Function;
use crate::matrix::{Holds, Shapes, rows};
use crate::number::{Field, Real};
use nalgebra::{Dim, Matrix4, Matrix4x2, OMatrix, OVector, U1};
use std::borrow::Cow;
use std::sync::Arc;

/// A mode of the target: how its state moves and how uncertain that is — sustika2015 (1), liu2017 (1).
///
/// ```text
/// xₖ = f(xₖ₋₁) + wₖ₋₁,   wₖ₋₁ ~ N(0, Q)
/// ```
///
/// Why: the papers allow a nonlinear f here and use linear ones only, zhu2016 (61) and liu2017 (25), (28); [`Motion`] is either.
/// The cubature filters push their points through F one by one all the same.
///
/// Example: a mode is a motion, a noise and a name. Its state moves with F, and the uncertainty Q comes on top.
///
/// ```
/// use immaculate::model::motion::{Mode, Motion, constant_velocity, integrated_noise};
/// use nalgebra::vector;
///
/// let straight = Mode { name: "straight".into(), motion: Motion::Linear(constant_velocity(&2.0)), noise: integrated_noise(&3.0, &2.0) };
/// // 10 + 2 · 3 and 20 + 2 · (−1); after that x has the variance 3 · 2³/3, if it was known before
/// assert_eq!(straight.motion.of(&vector![10.0, 3.0, 20.0, -1.0]), vector![16.0, 3.0, 18.0, -1.0]);
/// assert_eq!(straight.noise[(0, 0)], 8.0);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Mode<T: Field, N: Dim>
where
    Shapes: Holds<N>,
{
    /// The mode's name.
    pub name: String,
    /// f.
    pub motion: Motion<T, N>,
    /// Q, N × N, symmetric positive semidefinite, in products of the units of the state.
    pub noise: OMatrix<T, N, N>,
}

impl<T: Field, N: Dim> Mode<T, N>
where
    Shapes: Holds<N>,
{
    /// Whether the motion has no such entry of the state — sustika2015 (padding). Only a matrix shows it.
    ///
    /// It sets it to zero, without noise, and knows it exactly ever after. That is how models of unequal dimensions share one state,
    /// constant velocity and constant acceleration for instance.
    ///
    /// Source: derbez2000 (5), where the last row of F is zero.
    ///
    /// Example: constant velocity among states with an acceleration.
    ///
    /// ```
    /// use immaculate::model::{acceleration, motion::{Mode, Motion}};
    ///
    /// let response = acceleration::embedded_velocity_response(&1.0);
    /// let mode = Mode {
    ///     name: "constant velocity".into(),
    ///     motion: Motion::Linear(acceleration::embedded_constant_velocity(&1.0)),
    ///     noise: acceleration::response_noise(&response, &1.0),
    /// };
    /// assert_eq!([0, 1, 2].map(|entry| mode.lacks(entry)), [false, false, true]);
    /// ```
    ///
    /// Evidence: `constant_velocity_among_six_components_has_the_unscented_moments_of_four_when_kappa_is_three_minus_n`,
    /// `an_entry_without_variance_has_a_row_of_zeros_in_the_square_root` (exact).
    pub fn lacks(&self, entry: usize) -> bool {
        let is_zero = |matrix: &OMatrix<T, N, N>| matrix.row(entry).iter().all(T::is_zero);
        matches!(&self.motion, Motion::Linear(f) if is_zero(f)) && is_zero(&self.noise)
    }
}

/// How a state moves in a step: f of x(k) = f(x(k−1)) + w.
#[derive(Debug, Clone, PartialEq)]
pub enum Motion<T: Field, N: Dim>
where
    Shapes: Holds<N>,
{
    /// f(x) = F x, with F of N × N. All motions of the papers are of this kind.
    Linear(OMatrix<T, N, N>),
    /// f(x) = F x + b: a known input, such as gravity or a commanded acceleration, moves the state as well.
    Affine {
        /// F, N × N.
        matrix: OMatrix<T, N, N>,
        /// b.
        offset: OVector<T, N>,
    },
    /// Any function of the state; filters that draw points have no other need.
    Function {
        /// f.
        function: Arc<Function>,
        /// The values of what the function is given besides the state, [`Function::given`].
        given: Vec<T>,
    },
}

impl<T: Field, N: Dim> Motion<T, N>
where
    Shapes: Holds<N>,
{
    /// The number of components of the state, as the type of that side.
    pub fn dimension(&self) -> N {
        match self {
            Self::Linear(matrix) | Self::Affine { matrix, .. } => rows(matrix),
            Self::Function { function, .. } => N::from_usize(function.dimension()),
        }
    }

    /// Whether the motion is a matrix, perhaps with an offset; a filter that does not draw points needs that.
    pub fn is_linear(&self) -> bool {
        !matches!(self, Self::Function { .. })
    }

    /// F; of a function, which has none, every entry is undecided.
    ///
    /// Source: the matrix of the motion itself.
    ///
    /// Example: of a motion with an offset the matrix alone.
    ///
    /// ```
    /// use immaculate::model::motion::Motion;
    /// use nalgebra::{matrix, vector};
    ///
    /// let drift = Motion::Affine { matrix: matrix![2.0], offset: vector![3.0] };
    /// assert_eq!(*drift.matrix(), matrix![2.0]);
    /// assert_eq!(drift.of(&vector![5.0]), vector![13.0]); // 2 · 5 + 3
    /// ```
    pub fn matrix(&self) -> Cow<'_, OMatrix<T, N, N>> {
        match self {
            Self::Linear(matrix) | Self::Affine { matrix, .. } => Cow::Borrowed(matrix),
            Self::Function { .. } => {
                let n = self.dimension();
                Cow::Owned(OMatrix::from_fn_generic(n, n, |_, _| T::undecided()))
            }
        }
    }

    /// F, to be changed; `None` of a function.
    pub fn matrix_mut(&mut self) -> Option<&mut OMatrix<T, N, N>> {
        match self {
            Self::Linear(matrix) | Self::Affine { matrix, .. } => Some(matrix),
            Self::Function { .. } => None,
        }
    }

    /// b; `None` if there is none.
    pub fn offset(&self) -> Option<&OVector<T, N>> {
        match self {
            Self::Affine { offset, .. } => Some(offset),
            _ => None,
        }
    }
}

impl<T: Real, N: Dim> Motion<T, N>
where
    Shapes: Holds<N>,
{
    /// The state a step later, without noise: F x, F x + b, or f(x).
    ///
    /// Source: zhu2016 (14), where f is a matrix.
    ///
    /// Example: the same motion as a matrix and as formulas.
    ///
    /// ```
    /// use immaculate::model::function::Function;
    /// use immaculate::model::motion::Motion;
    /// use nalgebra::{matrix, vector};
    ///
    /// let as_matrix = Motion::Linear(matrix![1.0, 2.0; 0.0, 1.0]);
    /// let function = Function::of_formulas(&["x", "vx"], &["T"], &[], &[], &[("x", "x + T*vx"), ("vx", "vx")])?;
    /// let as_formulas = Motion::Function { function: function.into(), given: vec![2.0] };
    /// for motion in [as_matrix, as_formulas] {
    ///     assert_eq!(motion.of(&vector![10.0, 3.0]), vector![16.0, 3.0]); // 10 + 2 · 3
    /// }
    /// # Ok::<(), immaculate::model::function::InvalidFunction>(())
    /// ```
    ///
    /// Evidence: `formulas_of_a_turn_are_its_matrix` (models_in_filters).
    pub fn of(&self, state: &OVector<T, N>) -> OVector<T, N> {
        match self {
            Self::Linear(matrix) => matrix * state,
            Self::Affine { matrix, offset } => matrix * state + offset,
            Self::Function { function, given } => {
                let values = function.at(state.as_slice(), given);
                OVector::from_iterator_generic(self.dimension(), U1, values)
            }
        }
    }
}

/// Transition matrix of constant velocity — liu2017 (25), (26), zhu2016 (constant-velocity).
///
/// ```text
/// F = diag( [1 T; 0 1], [1 T; 0 1] )
/// ```
///
/// | paper | here       | unit | meaning              |
/// |-------|------------|------|----------------------|
/// | T     | `interval` | s    | the sampling interval |
///
/// Why: e^{AT} with A = [0 1; 0 0] per axis, which is nilpotent: I + AT.
///
/// Example: two seconds at (3, −1) m/s.
///
/// ```
/// use immaculate::model::motion::constant_velocity;
/// use nalgebra::vector;
///
/// // 10 + 2 · 3, 20 + 2 · (−1)
/// assert_eq!(constant_velocity(&2.0) * vector![10.0, 3.0, 20.0, -1.0], vector![16.0, 3.0, 18.0, -1.0]);
/// ```
///
/// Errata: zhu2016 uses this model as its first and never prints it.
///
/// Evidence: `motion_composes_over_time` (symbolic), `a_turn_of_rate_zero_is_constant_velocity` (exact).
#[rustfmt::skip]
pub fn constant_velocity<T: Field>(interval: &T) -> Matrix4<T> {
    let (o, l, t) = (T::zero, T::one, || interval.clone());
    Matrix4::new(
        l(), t(), o(), o(), //
        o(), l(), o(), o(), //
        o(), o(), l(), t(), //
        o(), o(), o(), l(),
    )
}

/// Transition matrix of a coordinated turn — zhu2016 (61), liu2017 (28), (29).
///
/// ```text
///     ⎡ 1   sin ωT / ω         0   (cos ωT − 1)/ω ⎤
/// F = ⎢ 0   cos ωT             0   −sin ωT        ⎥
///     ⎢ 0   (1 − cos ωT)/ω     1   sin ωT / ω     ⎥
///     ⎣ 0   sin ωT             0   cos ωT         ⎦
/// ```
///
/// | paper | here        | unit  | meaning                              |
/// |-------|-------------|-------|--------------------------------------|
/// | ω     | `turn_rate` | rad/s | rate of turn, positive to the left   |
/// | T     | `interval`  | s     | the sampling interval                |
///
/// Why: the velocity turns with rate ω, and the position is its integral. The two quotients are evaluated as Stumpff functions
/// ([`Real::stumpff`]), with θ = ωT:
///
/// ```text
/// sin ωT / ω = T c₁(θ²),     (1 − cos ωT)/ω = T θ c₂(θ²)
/// ```
///
/// They have a value at ω = 0, T and 0: constant velocity. So a rate that is only known to be near zero has a matrix too, and so has its
/// derivative by ω.
///
/// Example: a quarter turn to the left in one second, eastward at π/2 m/s. That is a circle of radius 1 m: the target ends at (1, 1),
/// northward.
///
/// ```
/// use immaculate::model::motion::{constant_velocity, coordinated_turn};
/// use nalgebra::vector;
/// use std::f64::consts::FRAC_PI_2;
///
/// let after = coordinated_turn(&FRAC_PI_2, &1.0) * vector![0.0, FRAC_PI_2, 0.0, 0.0];
/// // Two units in the last place of 1: the double nearest to π/2 is not π/2, and its cosine is 6·10⁻¹⁷.
/// assert!((after - vector![1.0, 0.0, 1.0, FRAC_PI_2]).amax() <= 2.0 * f64::EPSILON);
/// assert_eq!(coordinated_turn(&0.0, &2.0), constant_velocity(&2.0));
/// ```
///
/// Errata: both papers print turn rates of ±3° without "per second", and in degrees.
///
/// Evidence: `motion_composes_over_time` (symbolic), `a_turn_of_rate_zero_is_constant_velocity` (exact),
/// `a_turn_whose_rate_is_enclosed_around_zero_is_decided` (enclosed), `a_slow_turn_tends_to_constant_velocity` (property).
pub fn coordinated_turn<T: Real>(turn_rate: &T, interval: &T) -> Matrix4<T> {
    let angle = turn_rate.clone() * interval.clone();
    let square = angle.clone() * angle.clone();
    let along = interval.clone() * square.stumpff(1);
    let across = interval.clone() * angle.clone() * square.stumpff(2);
    turn_matrix(&along, &across, &angle.sin(), &angle.cos())
}

/// The matrix of [`coordinated_turn`] from sin ωT / ω, (1 − cos ωT)/ω, sin ωT and cos ωT — zhu2016 (61), liu2017 (29).
///
/// Example: the same quarter turn in exact numbers, sine 1 and cosine 0, at 2 rad/s and 2 m/s.
///
/// ```
/// use immaculate::model::motion::turn_matrix;
/// use nalgebra::vector;
///
/// // x: 2 · 1/2, ẋ: 2 · 0, y: 2 · (1 − 0)/2, ẏ: 2 · 1
/// assert_eq!(turn_matrix(&0.5, &0.5, &1.0, &0.0) * vector![0.0, 2.0, 0.0, 0.0], vector![1.0, 0.0, 1.0, 2.0]);
/// ```
///
/// Evidence: as [`coordinated_turn`].
#[rustfmt::skip]
pub fn turn_matrix<T: Field>(along: &T, across: &T, sine: &T, cosine: &T) -> Matrix4<T> {
    let (o, l) = (T::zero, T::one);
    let (s, c) = (|| sine.clone(), || cosine.clone());
    let (along, across) = (|| along.clone(), || across.clone());
    Matrix4::new(
        l(), along(), o(), -across(), //
        o(), c(), o(), -s(), //
        o(), across(), l(), along(), //
        o(), s(), o(), c(),
    )
}

/// Noise covariance of constant velocity under white acceleration noise — liu2017 (27), (30).
///
/// ```text
/// Q = q · diag( [T³/3 T²/2; T²/2 T], [T³/3 T²/2; T²/2 T] )
/// ```
///
/// | paper | here       | unit  | meaning                                  |
/// |-------|------------|-------|------------------------------------------|
/// | q     | `density`  | m²/s³ | spectral density of the acceleration     |
/// | T     | `interval` | s     | the sampling interval                    |
///
/// Why: ∫₀ᵀ [τ; 1] q [τ; 1]ᵀ dτ per axis. It has full rank.
///
/// liu2017 uses it for the turning modes too, in (30); the integral along a turn is [`turn_noise`], which differs in the terms
/// that couple the axes, by about ωT/3 of the entry T²/2.
///
/// Example: two seconds with q = 3.
///
/// ```
/// use immaculate::model::motion::integrated_noise;
/// use nalgebra::matrix;
///
/// // 3 · 2³/3, 3 · 2²/2, 3 · 2; the axes know nothing of each other.
/// let noise = integrated_noise(&3.0, &2.0);
/// assert_eq!(noise.fixed_view::<2, 2>(0, 0), matrix![8.0, 6.0; 6.0, 6.0]);
/// assert_eq!(noise.fixed_view::<2, 2>(0, 2), matrix![0.0, 0.0; 0.0, 0.0]);
/// ```
///
/// Evidence: `constant_velocity_noise_is_its_integral` (symbolic).
#[rustfmt::skip]
pub fn integrated_noise<T: Field>(density: &T, interval: &T) -> Matrix4<T> {
    let t = || interval.clone();
    let (o, q) = (T::zero, || density.clone());
    let position = || q() * t() * t() * t() / T::integer(3);
    let mixed = || q() * t() * t() / T::integer(2);
    let velocity = || q() * t();
    Matrix4::new(
        position(), mixed(), o(), o(), //
        mixed(), velocity(), o(), o(), //
        o(), o(), position(), mixed(), //
        o(), o(), mixed(), velocity(),
    )
}

/// Noise covariance of a coordinated turn under white acceleration noise.
///
/// ```text
///           ⎡ 2(T − s/ω)/ω²   (1 − c)/ω²      0               (T − s/ω)/ω ⎤
/// Q = q  ·  ⎢ (1 − c)/ω²      T               −(T − s/ω)/ω    0           ⎥      s = sin ωT, c = cos ωT
///           ⎢ 0               −(T − s/ω)/ω    2(T − s/ω)/ω²   (1 − c)/ω²  ⎥
///           ⎣ (T − s/ω)/ω     0               (1 − c)/ω²      T           ⎦
/// ```
///
/// The quotients are 2T³ c₃(θ²), T² c₂(θ²) and T² θ c₃(θ²) with θ = ωT, as in [`coordinated_turn`]. At ω = 0 they are those of
/// [`integrated_noise`].
///
/// Source: the integral at the head of this file along [`coordinated_turn`]; neither paper uses it.
///
/// Example: a quarter turn at 1 rad/s, which takes T = π/2, with q = 1. What [`integrated_noise`] lacks is the last block: noise on one
/// axis is carried into the other.
///
/// ```
/// use immaculate::model::motion::{integrated_noise, turn_noise};
/// use nalgebra::matrix;
///
/// let t = std::f64::consts::FRAC_PI_2;
/// let noise = turn_noise(&1.0, &1.0, &t);
/// let lag = t - 1.0; // T − sin ωT / ω
/// // Three roundings of numbers up to 2.
/// let off = noise.fixed_view::<2, 2>(0, 0) - matrix![2.0 * lag, 1.0; 1.0, t];
/// assert!(off.amax() <= 3.0 * f64::EPSILON);
/// let off = noise.fixed_view::<2, 2>(0, 2) - matrix![0.0, lag; -lag, 0.0];
/// assert!(off.amax() <= 3.0 * f64::EPSILON);
/// // Straight on, the same as an integral of polynomials.
/// assert_eq!(turn_noise(&3.0, &0.0, &2.0), integrated_noise(&3.0, &2.0));
/// ```
///
/// Evidence: `turn_noise_is_its_integral` (symbolic), `a_turn_whose_rate_is_enclosed_around_zero_is_decided` (enclosed).
pub fn turn_noise<T: Real>(density: &T, turn_rate: &T, interval: &T) -> Matrix4<T> {
    let angle = turn_rate.clone() * interval.clone();
    let square = angle.clone() * angle.clone();
    turn_noise_matrix(density, interval, &angle, &square.stumpff(2), &square.stumpff(3))
}

/// The matrix of [`turn_noise`] from θ = ωT, c₂(θ²) and c₃(θ²).
///
/// Source: as [`turn_noise`].
///
/// Example: θ = 0, where c₂ = 1/2 and c₃ = 1/6.
///
/// ```
/// use immaculate::model::motion::{integrated_noise, turn_noise_matrix};
/// use immaculate::number::{Field, Rational};
///
/// let [three, two, zero] = [3, 2, 0].map(Rational::integer);
/// let noise = turn_noise_matrix(&three, &two, &zero, &Rational::new(1, 2), &Rational::new(1, 6));
/// assert_eq!(noise, integrated_noise(&three, &two));
/// ```
///
/// Evidence: as [`turn_noise`].
#[rustfmt::skip]
pub fn turn_noise_matrix<T: Field>(density: &T, interval: &T, angle: &T, c_2: &T, c_3: &T) -> Matrix4<T> {
    let (q, t) = (|| density.clone(), || interval.clone());
    let position = || q() * T::integer(2) * t() * t() * t() * c_3.clone();
    let mixed = || q() * t() * t() * c_2.clone();
    let velocity = || q() * t();
    let across = || q() * t() * t() * angle.clone() * c_3.clone();
    let o = T::zero;
    Matrix4::new(
        position(), mixed(), o(), across(), //
        mixed(), velocity(), -across(), o(), //
        o(), -across(), position(), mixed(), //
        across(), o(), mixed(), velocity(),
    )
}

/// How a piecewise constant acceleration enters the state: zhu2016's process noise weight matrix G — zhu2016 (noise-input).
///
/// ```text
/// G = [T²/2 0; T 0; 0 T²/2; 0 T]
/// ```
///
/// Source: zhu2016, section 4, not numbered.
///
/// Example: (3, −1) m/s² during two seconds.
///
/// ```
/// use immaculate::model::motion::acceleration_input;
/// use nalgebra::vector;
///
/// // 3 · 2²/2, 3 · 2, −1 · 2²/2, −1 · 2
/// assert_eq!(acceleration_input(&2.0) * vector![3.0, -1.0], vector![6.0, 6.0, -2.0, -2.0]);
/// ```
///
/// Evidence: `a_piecewise_constant_acceleration_enters_through_its_integral` (symbolic).
#[rustfmt::skip]
pub fn acceleration_input<T: Field>(interval: &T) -> Matrix4x2<T> {
    let t = || interval.clone();
    let o = T::zero;
    let half_square = || t() * t() / T::integer(2);
    Matrix4x2::new(
        half_square(), o(), //
        t(), o(), //
        o(), half_square(), //
        o(), t(),
    )
}

/// Noise covariance of a piecewise constant acceleration of variance `variance` per axis: Q = G q Gᵀ, of rank two —
/// zhu2016 (process-noise).
///
/// Source: zhu2016, section 4, not numbered: "process noise Q ~ N(0, q), q = diag(10, 10)", "process noise weight matrix G".
/// `variance` is in (m/s²)².
///
/// Example: position and velocity of an axis get their noise from one number, so that they are fully correlated: 12² = 12 · 12.
///
/// ```
/// use immaculate::model::motion::acceleration_noise;
/// use nalgebra::matrix;
///
/// // 3 · (2²/2)², 3 · (2²/2) · 2, 3 · 2²
/// assert_eq!(acceleration_noise(&3.0, &2.0).fixed_view::<2, 2>(0, 0), matrix![12.0, 12.0; 12.0, 12.0]);
/// // In one second they are ¾, 3/2 and 3.
/// assert_eq!(acceleration_noise(&3.0, &1.0).fixed_view::<2, 2>(0, 0), matrix![0.75, 1.5; 1.5, 3.0]);
/// ```
///
/// Evidence: `a_piecewise_constant_acceleration_enters_through_its_integral` (symbolic).
pub fn acceleration_noise<T: Field>(variance: &T, interval: &T) -> Matrix4<T> {
    let g = acceleration_input(interval);
    (&g * g.transpose()) * variance.clone()
}
