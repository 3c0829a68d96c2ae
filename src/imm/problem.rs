//! The inputs of a run, and the checks that they must pass.
//!
//! Nothing is repaired: a matrix that is not quite symmetric, or a row that does not quite sum to one, is an error that names its place.
//!
//! ```text
//! Problem (the same at every step) ─┬─ check ─▶ Imm::new ─▶ step, step, …        InvalidProblem: the field, and the equation that needs it
//! Initial (step 0) ─────────────────┘
//! ```

use super::record::Needs;
use super::state_conversion::StateConversions;
use crate::filter::{Filter, Transform, Update};
use crate::gaussian::Gaussian;
use crate::matrix::{Holds, Shapes, rows};
use crate::model::sensor::position_matrix;
use crate::model::{Conversion, Sensor, motion::Mode};
use crate::number::{Field, Real};
use nalgebra::{Dim, OMatrix};
use std::borrow::Cow;

/// The inputs of the cycle that do not change from step to step.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem<T: Field, N: Dim, M: Dim>
where
    Shapes: Holds<N, M>,
{
    /// The modes, at least one.
    pub modes: Vec<Mode<T, N>>,
    /// The filter of each mode; a single one serves all modes.
    pub filters: Vec<Filter<T, N, M>>,
    /// Which estimates the filters start from.
    pub interaction: Interaction<T, N>,
    /// Which entries of the state are angles, in radians, such as a heading: [`angles`](super::angles). Most states have none. Modes may
    /// have states of their own, [`Interaction::Converted`]; then these are the angles of the state in which they are combined.
    pub angles: Vec<usize>,
    /// The Markov chain of the modes: `chain[i][j]` = P(mode j at k ∣ mode i at k−1); rows sum to one.
    pub chain: Vec<Vec<T>>,
    /// What the sensor sees.
    pub sensor: Sensor<T, N, M>,
    /// The measurement noise, R — sustika2015 (4), where it is diag(σ_r², σ_θ²): M × M, symmetric positive semidefinite, in products of
    /// the units of the measurement. A measurement may be exact; what it leaves of S must be definite.
    ///
    /// Example: a radar of 10 m and ½ rad. Deviations instead of variances are a famous mistake.
    ///
    /// ```
    /// use immaculate::number::Real;
    /// use nalgebra::matrix;
    ///
    /// let noise = matrix![100.0, 0.0; 0.0, 0.25]; // diag(10², (1/2)²)
    /// assert_eq!(noise.map(|variance: f64| Real::sqrt(&variance)), matrix![10.0, 0.0; 0.0, 0.5]);
    /// ```
    ///
    /// Evidence: `the_constants_of_sustika2015_are_the_printed_ones` (traceability).
    pub measurement_noise: OMatrix<T, M, M>,
}

/// Which estimates the filters of the modes start from.
#[derive(Debug, Clone, PartialEq)]
pub enum Interaction<T: Field, N: Dim>
where
    Shapes: Holds<N>,
{
    /// Each from the estimates of all modes, mixed: the interacting multiple model filter.
    Imm,
    /// Each from the combined estimate of the step before: the generalised pseudo-Bayesian filter of first order. The one of second order
    /// is [`Gpb2`](super::Gpb2).
    ///
    /// Source: G. A. Ackerson and K. S. Fu, On State Estimation in Switching Environments, 1970; Y. Bar-Shalom, X. R. Li and
    /// T. Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, section 11.6.4 (GPB1).
    ///
    /// ```text
    /// μᵢ∣ⱼ = μᵢ for all j, so that x̂⁰ʲ = x̂ and P⁰ʲ = P
    /// ```
    ///
    /// Why: after each step the history of the modes is forgotten, and one Gaussian stands for all of it. The chain moves the
    /// probabilities, cⱼ = Σᵢ pᵢⱼ μᵢ, and has no say in where a mode starts. The interacting multiple model filter asks where mode j *came
    /// from*; both agree where that makes no difference, as pᵢⱼ = qⱼ for all i gives μᵢ∣ⱼ = qⱼ μᵢ / (qⱼ Σᵢ μᵢ) = μᵢ.
    ///
    /// Example: two modes that never change into each other. Both start from 2, with the spread of 0 and 4 about it.
    ///
    /// ```
    /// use immaculate::filter::Filter;
    /// use immaculate::{gaussian::Gaussian, imm::{Imm, Initial, Interaction, Problem}};
    /// use immaculate::model::{Sensor, motion::{Mode, Motion}};
    /// use nalgebra::{matrix, vector};
    ///
    /// let mode = |q| Mode { name: "walk".into(), motion: Motion::Linear(matrix![1.0]), noise: matrix![q] };
    /// let problem = Problem {
    ///     modes: vec![mode(1.0), mode(3.0)],
    ///     filters: vec![Filter::kalman()],
    ///     interaction: Interaction::Gpb1,
    ///     angles: vec![],
    ///     chain: vec![vec![1.0, 0.0], vec![0.0, 1.0]],
    ///     sensor: Sensor::Linear(matrix![1.0]),
    ///     measurement_noise: matrix![2.0],
    /// };
    /// let at = |x| Gaussian { mean: vector![x], covariance: matrix![1.0] };
    /// let initial = Initial { modes: vec![at(0.0), at(4.0)], mode_probabilities: vec![0.5, 0.5] };
    /// let mut filter = Imm::new(problem, &initial)?;
    /// let step = filter.step(None)?;
    /// let start = Gaussian { mean: vector![2.0], covariance: matrix![5.0] }; // ½ · 0 + ½ · 4, 1 + ½ · (0 − 2)² + ½ · (4 − 2)²
    /// assert_eq!(step.mixed, [start.clone(), start]);
    /// assert_eq!([&step.predicted[0].covariance, &step.predicted[1].covariance], [&matrix![6.0], &matrix![8.0]]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Evidence: `first_order_filters_start_every_mode_from_the_combined_estimate`,
    /// `where_the_chain_forgets_the_first_order_filter_is_the_interacting_one` (exact).
    Gpb1,
    /// Each from its own: the update of fixed gains read as it is printed, without mixed states — derbez2000 (fixed-gain-update).
    ///
    /// Source: derbez2000, section 3, not numbered.
    ///
    /// ```text
    /// μᵢ∣ⱼ = 1 for i = j and 0 else, so that x̂⁰ʲ = x̂ʲ
    /// ```
    ///
    /// Only the probabilities, which follow the chain, and the combined mean know of the other modes. Under a chain that is the unit matrix
    /// this is the static bank of filters (D. T. Magill, Optimal Adaptive Estimation of Sampled Stochastic Processes, 1965): each filter
    /// runs by itself, and μⱼ is proportional to μⱼ(0) times the product of its likelihoods. So is then [`Interaction::Imm`], as μᵢ∣ⱼ is
    /// one for i = j there.
    ///
    /// Example: the two filters of [`Filter::given`](crate::filter::Filter::given), each by itself.
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
    ///     interaction: Interaction::Unmixed,
    ///     angles: vec![],
    /// };
    /// let at = |x| Gaussian { mean: vector![x], covariance: matrix![0.0] };
    /// let initial = Initial { modes: vec![at(0.0), at(4.0)], mode_probabilities: vec![0.5, 0.5] };
    /// let mut filter = Imm::new(problem, &initial)?;
    /// let step = filter.step(Some(&vector![6.0]))?;
    /// // 0 + ½ · (6 − 0), 4 + ½ · (6 − 4)
    /// assert_eq!([&step.updated[0].mean, &step.updated[1].mean], [&vector![3.0], &vector![5.0]]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Evidence: `unmixed_modes_with_fixed_gains_stand_alone`, `a_static_bank_is_the_rule_of_bayes_on_products_of_likelihoods` (exact).
    Unmixed,
    /// As [`Interaction::Imm`], where modes have states of their own: [`state_conversion`](super::state_conversion).
    ///
    /// Source: there.
    ///
    /// Example: two walks, the second of which counts in units half as large. It is read by ½, and reads by 2.
    ///
    /// ```
    /// use immaculate::filter::Filter;
    /// use immaculate::imm::state_conversion::{Reader, StateConversion, StateConversions};
    /// use immaculate::{gaussian::Gaussian, imm::{Imm, Initial, Interaction, Problem}};
    /// use immaculate::model::{Sensor, motion::{Mode, Motion}};
    /// use nalgebra::{matrix, vector};
    ///
    /// let mode = |q| Mode { name: "walk".into(), motion: Motion::Linear(matrix![1.0]), noise: matrix![q] };
    /// let by = |factor, from, to| StateConversion { from, to, map: Motion::Linear(matrix![factor]), added: matrix![0.0] };
    /// let list = vec![by(2.0, 0, Reader::Mode(1)), by(0.5, 1, Reader::Mode(0)), by(0.5, 1, Reader::Common)];
    /// let problem = Problem {
    ///     modes: vec![mode(1.0), mode(4.0)],
    ///     filters: vec![Filter::kalman()],
    ///     interaction: Interaction::Converted(StateConversions { list, angles: vec![vec![], vec![]] }),
    ///     angles: vec![],
    ///     chain: vec![vec![0.5, 0.5], vec![0.5, 0.5]],
    ///     sensor: Sensor::Linear(matrix![1.0]),
    ///     measurement_noise: matrix![2.0],
    /// };
    /// let at = |x, p| Gaussian { mean: vector![x], covariance: matrix![p] };
    /// let initial = Initial { modes: vec![at(3.0, 1.0), at(6.0, 4.0)], mode_probabilities: vec![0.5, 0.5] };
    /// let mut filter = Imm::new(problem, &initial)?;
    /// let step = filter.step(Some(&vector![7.0]))?;
    /// assert_eq!([&step.mixed[0].mean, &step.mixed[1].mean], [&vector![3.0], &vector![6.0]]);
    /// assert_eq!(step.combined.mean, vector![5.0]); // 3 + ½ · (7 − 3), since the gain is (1 + 1) / (1 + 1 + 2)
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Evidence: `one_problem_in_two_coordinate_systems_has_one_combined_estimate` (state_conversions).
    Converted(StateConversions<T, N>),
}

/// The estimate at step 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Initial<T: Field, N: Dim>
where
    Shapes: Holds<N>,
{
    /// One estimate a mode. Filters with fixed gains have no covariance: it is zero.
    pub modes: Vec<Gaussian<T, N>>,
    /// One probability a mode; they sum to one.
    pub mode_probabilities: Vec<T>,
}

impl<T: Real, N: Dim, M: Dim> Problem<T, N, M>
where
    Shapes: Holds<N, M>,
{
    /// The number of components of the state, as the type of that side.
    pub fn n(&self) -> N {
        self.modes[0].motion.dimension()
    }

    /// The number of components of the measurement, as the type of that side.
    pub fn m(&self) -> M {
        rows(&self.measurement_noise)
    }

    /// The filter of mode j.
    #[inline(always)]
    pub fn filter(&self, j: usize) -> &Filter<T, N, M> {
        self.filters.get(j).unwrap_or(&self.filters[0])
    }

    /// The measurement matrix H: of a linear sensor its own, of range and bearing the matrix that takes the position out of the state,
    /// which is what filters see that convert the measurement. A function has none, and every entry is undecided.
    #[inline(always)]
    pub fn h(&self) -> Cow<'_, OMatrix<T, M, N>> {
        match &self.sensor {
            Sensor::Linear(h) => Cow::Borrowed(h),
            Sensor::Polar { position, .. } => Cow::Owned(position_matrix(position, self.m(), self.n())),
            Sensor::Function { .. } => Cow::Owned(OMatrix::from_fn_generic(self.m(), self.n(), |_, _| T::undecided())),
        }
    }

    /// Whether the filters have covariances of the state; those with given gains have none.
    #[inline(always)]
    pub fn has_covariances(&self) -> bool {
        self.filters.iter().all(Filter::has_covariances)
    }

    /// The initial estimates. A covariance that nobody computes is no number: a zero would be taken for certainty.
    pub(super) fn estimates_at_start(&self, initial: &Initial<T, N>) -> Vec<Gaussian<T, N>> {
        let mut estimates = initial.modes.clone();
        if !self.has_covariances() {
            for estimate in &mut estimates {
                estimate.covariance.fill(T::undecided());
            }
        }
        estimates
    }

    /// How the measurement is converted, if a filter does.
    pub fn conversion(&self) -> Option<Conversion> {
        self.filters.iter().find_map(Filter::conversion)
    }

    /// Whether what a value needs is there in mode j, apart from a detection and the true state.
    pub fn has(&self, needed: Needs, j: usize) -> bool {
        match needed {
            Needs::Covariances => self.has_covariances(),
            Needs::Conversion => self.conversion().is_some(),
            Needs::LinearisedMotion => self.filter(j).predict == Transform::Linearised,
            Needs::LinearisedMeasurement => self.filter(j).linearises_the_measurement(),
            Needs::Iterations => matches!(self.filter(j).update, Update::Iterated(times) if times.get() > 1),
            Needs::Detection | Needs::Consistency | Needs::Truth => true,
        }
    }
}
