//! The kind of a filter: how its estimate goes through the motion, and what it does with a measurement.
//!
//! A kind is said once, here, and each mode has its own: one mode may draw points where another uses its matrices. What a kind computes,
//! and what it does not, follows from this type.
//!
//! ```text
//! Filter { predict: Transform,              x̂⁰, P⁰ ─▶ x̂⁻, P⁻
//!          update:  By(Transform)           x̂⁻, P⁻ ─▶ ẑ, S, C ─▶ gain
//!                 | Iterated(times)         the same, relinearised at the updated estimate
//!                 | Converted(Conversion)   z ─▶ z^c, R^c, then as a Kalman filter
//!                 | Given(FixedGain) }      gain and S are numbers of the problem; there is no covariance of the state
//! ```

use super::fixed_gain::FixedGain;
use crate::matrix::{Holds, Shapes};
use crate::model::Conversion;
use crate::number::Field;
use crate::rule::Rule;
use nalgebra::{Dim, OMatrix};
use std::num::NonZeroUsize;

/// How the moments of a Gaussian go through a function.
#[derive(Debug, Clone, PartialEq)]
pub enum Transform<T: Field, N: Dim>
where
    Shapes: Holds<N>,
{
    /// Through a matrix, exactly: [`kalman`](super::kalman).
    Exact,
    /// The mean through the function, the covariance through its Jacobian: [`extended`](super::extended).
    Linearised,
    /// By the points of a rule, unscented and Gauss-Hermite rules included: [`cubature`](super::cubature).
    Points(Rule<T, N>),
}

/// What a filter does with a measurement.
#[derive(Debug, Clone, PartialEq)]
pub enum Update<T: Field, N: Dim, M: Dim>
where
    Shapes: Holds<N, M>,
{
    /// The moments of the predicted measurement by a transform, and the gain from them: [`update`](super::update).
    By(Transform<T, N>),
    /// Like the extended filter, several times, each at the previous estimate: [`iterated`](super::iterated).
    Iterated(NonZeroUsize),
    /// Range and bearing become a position first: [`converted`](super::converted).
    Converted(Conversion),
    /// Gain and innovation covariance are given: [`fixed_gain`](super::fixed_gain).
    Given(FixedGain<T, N, M>),
}

/// The filter of a mode.
///
/// Example: points for the measurement, matrices for the motion.
///
/// ```
/// use immaculate::filter::{Filter, Transform, Update};
/// use immaculate::rule::RuleName;
/// use nalgebra::{U2, U4};
///
/// let rule = RuleName::ThirdDegree.rule()?;
/// let update = Update::By(Transform::Points(rule));
/// let filter = Filter::<f64, U4, U2> { predict: Transform::Exact, update, noise_cross_covariance: None };
/// assert!(filter.has_covariances());
/// # Ok::<(), immaculate::rule::InvalidRule>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Filter<T: Field, N: Dim, M: Dim>
where
    Shapes: Holds<N, M>,
{
    /// How the estimate goes through the motion.
    pub predict: Transform<T, N>,
    /// What is done with a measurement.
    pub update: Update<T, N, M>,
    /// M = E[w vᵀ] of process and measurement noise, N × M; none if they are independent. For updates by a matrix or a Jacobian:
    /// [`correlated`](super::correlated).
    pub noise_cross_covariance: Option<OMatrix<T, N, M>>,
}

impl<T: Field, N: Dim, M: Dim> Filter<T, N, M>
where
    Shapes: Holds<N, M>,
{
    /// The Kalman filter: motion and measurement are matrices.
    pub fn kalman() -> Self {
        Self {
            predict: Transform::Exact,
            update: Update::By(Transform::Exact),
            noise_cross_covariance: None,
        }
    }

    /// The extended Kalman filter: motion and measurement by their Jacobians.
    ///
    /// Source: Smith, Schmidt and McGee 1962; Bar-Shalom, Li and Kirubarajan 2001, section 10.3.
    ///
    /// Example: a target expected 3 m east and 4 m north, of which the range is measured.
    ///
    /// ```
    /// use immaculate::filter::Filter;
    /// use immaculate::{gaussian::Gaussian, imm::{Imm, Initial, Interaction, Problem}};
    /// use immaculate::model::{PolarComponent, Sensor, motion::{Mode, Motion}};
    /// use nalgebra::{Matrix2, matrix, vector};
    ///
    /// let problem = Problem {
    ///     modes: vec![Mode { name: "still".into(), motion: Motion::Linear(Matrix2::identity()), noise: Matrix2::zeros() }],
    ///     filters: vec![Filter::extended()],
    ///     interaction: Interaction::Imm,
    ///     angles: vec![],
    ///     chain: vec![vec![1.0]],
    ///     sensor: Sensor::Polar { components: vec![PolarComponent::Range], position: [0, 1], location: [0.0, 0.0] },
    ///     measurement_noise: matrix![75.0],
    /// };
    /// let expected = Gaussian { mean: vector![3.0, 4.0], covariance: Matrix2::identity() * 25.0 };
    /// let initial = Initial { modes: vec![expected], mode_probabilities: vec![1.0] };
    /// let mut filter = Imm::new(problem, &initial)?;
    /// let step = filter.step(Some(&vector![9.0]))?;
    /// // H = [3/5, 4/5], S = 25 + 75, W = 25 Hᵀ / 100, and 9 m are 4 m more than the expected 5 m.
    /// assert!((step.gains[0] - vector![0.15, 0.2]).norm() < 1e-15);
    /// assert!((step.updated[0].mean - vector![3.6, 4.8]).norm() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Evidence: `a_step_of_an_extended_filter_is_its_equations` (extended).
    pub fn extended() -> Self {
        Self {
            predict: Transform::Linearised,
            update: Update::By(Transform::Linearised),
            noise_cross_covariance: None,
        }
    }

    /// The iterated extended Kalman filter, whose update is linearised several times.
    ///
    /// Source: Bar-Shalom, Li and Kirubarajan 2001, section 10.5.2.
    ///
    /// Example: a target expected 3 m east and 4 m north is known well to the east, and much farther away than it was thought.
    ///
    /// ```
    /// use immaculate::filter::Filter;
    /// use immaculate::{gaussian::Gaussian, imm::{Imm, Initial, Interaction, Problem}};
    /// use immaculate::model::{PolarComponent, Sensor, motion::{Mode, Motion}};
    /// use nalgebra::{Matrix2, matrix, vector};
    /// use std::num::NonZeroUsize;
    ///
    /// let problem = |filter| Problem {
    ///     modes: vec![Mode { name: "still".into(), motion: Motion::Linear(Matrix2::identity()), noise: Matrix2::zeros() }],
    ///     filters: vec![filter],
    ///     interaction: Interaction::Imm,
    ///     angles: vec![],
    ///     chain: vec![vec![1.0]],
    ///     sensor: Sensor::Polar { components: vec![PolarComponent::Range], position: [0, 1], location: [0.0, 0.0] },
    ///     measurement_noise: matrix![0.01],
    /// };
    /// let expected = Gaussian { mean: vector![3.0, 4.0], covariance: matrix![0.01, 0.0; 0.0, 25.0] };
    /// let initial = Initial { modes: vec![expected], mode_probabilities: vec![1.0] };
    /// let range = |filter| -> Result<f64, Box<dyn std::error::Error>> {
    ///     Ok(Imm::new(problem(filter), &initial)?.step(Some(&vector![10.0]))?.combined.mean.norm())
    /// };
    /// // With the derivative at the expected place, the correction is too long.
    /// assert!((range(Filter::extended())? - 10.0).abs() > 0.5);
    /// assert!((range(Filter::iterated(NonZeroUsize::new(5).unwrap()))? - 10.0).abs() < 0.01);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Evidence: `one_iteration_is_the_extended_filter_to_the_last_bit` (iterated).
    pub fn iterated(iterations: NonZeroUsize) -> Self {
        Self {
            predict: Transform::Linearised,
            update: Update::Iterated(iterations),
            noise_cross_covariance: None,
        }
    }

    /// Points for the motion and, drawn afresh, for the measurement.
    pub fn points(rule: Rule<T, N>) -> Self {
        Self {
            predict: Transform::Points(rule.clone()),
            update: Update::By(Transform::Points(rule)),
            noise_cross_covariance: None,
        }
    }

    /// The Kalman filter of a position that was converted from range and bearing.
    ///
    /// Source: sustika2015, section 3.1.
    ///
    /// ```text
    /// ν = z^c − H x̂⁻     S = H P⁻ Hᵀ + R^c
    /// ```
    ///
    /// Example: a target expected at (8, 0) is measured 10 m straight ahead, with σ_r = 2 m and σ_θ = ½ rad.
    ///
    /// ```
    /// use immaculate::filter::Filter;
    /// use immaculate::{gaussian::Gaussian, imm::{Imm, Initial, Interaction, Problem}};
    /// use immaculate::model::{Conversion, PolarComponent, Sensor, motion::{Mode, Motion}};
    /// use nalgebra::{Matrix2, matrix, vector};
    ///
    /// let problem = Problem {
    ///     modes: vec![Mode { name: "still".into(), motion: Motion::Linear(Matrix2::identity()), noise: Matrix2::zeros() }],
    ///     filters: vec![Filter::converted(Conversion::Standard)],
    ///     interaction: Interaction::Imm,
    ///     angles: vec![],
    ///     chain: vec![vec![1.0]],
    ///     sensor: Sensor::Polar {
    ///         components: vec![PolarComponent::Range, PolarComponent::Bearing],
    ///         position: [0, 1],
    ///         location: [0.0, 0.0],
    ///     },
    ///     measurement_noise: matrix![4.0, 0.0; 0.0, 0.25],
    /// };
    /// let expected = Gaussian { mean: vector![8.0, 0.0], covariance: matrix![4.0, 0.0; 0.0, 75.0] };
    /// let initial = Initial { modes: vec![expected], mode_probabilities: vec![1.0] };
    /// let mut filter = Imm::new(problem, &initial)?;
    /// let step = filter.step(Some(&vector![10.0, 0.0]))?;
    /// // R^c = diag(2², 10² · ¼), S = diag(4 + 4, 75 + 25)
    /// assert_eq!(step.innovation_covariances[0], matrix![8.0, 0.0; 0.0, 100.0]);
    /// assert_eq!(step.combined.mean, vector![9.0, 0.0]); // 8 + 4/8 · (10 − 8)
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Evidence: `a_converted_filter_is_the_kalman_filter_of_the_converted_measurements` (exact).
    pub fn converted(conversion: Conversion) -> Self {
        Self {
            predict: Transform::Exact,
            update: Update::Converted(conversion),
            noise_cross_covariance: None,
        }
    }

    /// A filter whose gain and innovation covariance are given — derbez2000 (fixed-gain-update), (fixed-gain-likelihood).
    ///
    /// Source: derbez2000, section 3, not numbered.
    ///
    /// ```text
    /// x̂⁰ʲ = Σᵢ μᵢ∣ⱼ x̂ⁱ     x̂⁻ʲ = Fʲ x̂⁰ʲ     νʲ = z − H x̂⁻ʲ     x̂ʲ = x̂⁻ʲ + Kʲ νʲ     ln Lⱼ = ln N(νʲ; 0, Sʲ)
    /// ```
    ///
    /// Probabilities and the combined mean are those of any interacting multiple model filter; there is no covariance anywhere. Kʲ and Sʲ
    /// are a [`FixedGain`]; no equation reads Q and R, which then say for which noises the gains are meant.
    ///
    /// Why: with its mixed states this is "the usual IMM algorithm", each of whose filters has the gain that it would end with if it
    /// were alone. The gain that the mixed covariance would give, which has the spread of the means in it, is another.
    ///
    /// Example: two filters with the gain ½, at 0 and at 4, exchange what they know and then see 6.
    ///
    /// ```
    /// use immaculate::filter::{Filter, fixed_gain::FixedGain};
    /// use immaculate::{gaussian::Gaussian, imm::{Imm, Initial, Interaction, Problem}};
    /// use immaculate::model::{Sensor, motion::{Mode, Motion}};
    /// use nalgebra::{matrix, vector};
    ///
    /// let still = Mode { name: "still".into(), motion: Motion::Linear(matrix![1.0]), noise: matrix![1.0] };
    /// let problem = Problem {
    ///     modes: vec![still.clone(), still],
    ///     chain: vec![vec![0.5, 0.5], vec![0.5, 0.5]],
    ///     sensor: Sensor::Linear(matrix![1.0]),
    ///     measurement_noise: matrix![1.0],
    ///     filters: vec![Filter::given(FixedGain { gain: matrix![0.5], innovation_covariance: matrix![2.0] }); 2],
    ///     interaction: Interaction::Imm,
    ///     angles: vec![],
    /// };
    /// let at = |x| Gaussian { mean: vector![x], covariance: matrix![0.0] };
    /// let initial = Initial { modes: vec![at(0.0), at(4.0)], mode_probabilities: vec![0.5, 0.5] };
    /// let mut filter = Imm::new(problem, &initial)?;
    /// let step = filter.step(Some(&vector![6.0]))?;
    /// // Both start from ½ · 0 + ½ · 4, and end at 2 + ½ · (6 − 2).
    /// assert_eq!([&step.mixed[0].mean, &step.mixed[1].mean], [&vector![2.0], &vector![2.0]]);
    /// assert_eq!([&step.updated[0].mean, &step.updated[1].mean], [&vector![4.0], &vector![4.0]]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Evidence: `identical_modes_with_fixed_gains_are_the_filter_alone` (exact).
    pub fn given(gain: FixedGain<T, N, M>) -> Self {
        Self {
            predict: Transform::Exact,
            update: Update::Given(gain),
            noise_cross_covariance: None,
        }
    }

    /// The same where process and measurement noise are correlated.
    ///
    /// Source: Simon, Optimal State Estimation, 2006, section 7.1.
    ///
    /// Example: the noises cancel in the innovation, and the measurement is believed more.
    ///
    /// ```
    /// use immaculate::filter::Filter;
    /// use immaculate::{gaussian::Gaussian, imm::{Imm, Initial, Interaction, Problem}};
    /// use immaculate::model::{Sensor, motion::{Mode, Motion}};
    /// use nalgebra::{matrix, vector};
    ///
    /// let problem = Problem {
    ///     modes: vec![Mode { name: "walk".into(), motion: Motion::Linear(matrix![1.0]), noise: matrix![1.0] }],
    ///     filters: vec![Filter::kalman().with_noise_cross_covariance(matrix![-1.0])],
    ///     interaction: Interaction::Imm,
    ///     angles: vec![],
    ///     chain: vec![vec![1.0]],
    ///     sensor: Sensor::Linear(matrix![1.0]),
    ///     measurement_noise: matrix![4.0],
    /// };
    /// let estimate = Gaussian { mean: vector![0.0], covariance: matrix![3.0] };
    /// let mut filter = Imm::new(problem, &Initial { modes: vec![estimate], mode_probabilities: vec![1.0] })?;
    /// let step = filter.step(Some(&vector![2.0]))?;
    /// // C = 3 + 1 − 1, S = 3 + 1 − 2 · 1 + 4, and 0 + 3/6 · 2.
    /// assert_eq!((step.cross_covariances[0], step.innovation_covariances[0]), (matrix![3.0], matrix![6.0]));
    /// assert_eq!(step.combined.mean, vector![1.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_noise_cross_covariance(self, noise_cross_covariance: OMatrix<T, N, M>) -> Self {
        Self {
            noise_cross_covariance: Some(noise_cross_covariance),
            ..self
        }
    }

    /// Whether it has covariances of the state; a filter whose gain is given has none.
    pub fn has_covariances(&self) -> bool {
        !matches!(self.update, Update::Given(_))
    }

    /// Whether it uses the Jacobian of the measurement, as extended filters do.
    pub fn linearises_the_measurement(&self) -> bool {
        matches!(self.update, Update::By(Transform::Linearised) | Update::Iterated(_))
    }

    /// How it converts a measurement, if it does.
    pub fn conversion(&self) -> Option<Conversion> {
        match self.update {
            Update::Converted(conversion) => Some(conversion),
            _ => None,
        }
    }

    /// The rules of its points, for the motion and for the measurement, where it draws any.
    pub fn rules(&self) -> [Option<&Rule<T, N>>; 2] {
        let predict = match &self.predict {
            Transform::Points(rule) => Some(rule),
            _ => None,
        };
        let update = match &self.update {
            Update::By(Transform::Points(rule)) => Some(rule),
            _ => None,
        };
        [predict, update]
    }

    /// As [`Filter::rules`], to be changed.
    pub fn rules_mut(&mut self) -> [Option<&mut Rule<T, N>>; 2] {
        let predict = match &mut self.predict {
            Transform::Points(rule) => Some(rule),
            _ => None,
        };
        let update = match &mut self.update {
            Update::By(Transform::Points(rule)) => Some(rule),
            _ => None,
        };
        [predict, update]
    }
}
