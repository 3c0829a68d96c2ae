//! Small filters that decide derbez2000's statements on stability and boundedness.
//!
//! Each instance meets a statement's hypotheses but not its conclusion, in numbers small enough to follow by hand. What does hold instead
//! is here too.
//!
//! What holds in place of the theorem on bounded mixed covariances: *let all filters share a measurement matrix H of full column rank,
//! all Qⱼ and R be positive definite, and noise and mismatch dⱼ = Fⱼx̄ₙ − x̄ₙ₊₁ be bounded for every model j. Then all P⁰ʲ are bounded,
//! whatever the mode probabilities do.* Proof, with eᵢ the errors, Vᵢ = eᵢᵀPᵢ⁻¹eᵢ and V the greatest of them:
//!
//! 1. Every updated Pᵢ ⪯ C = (HᵀR⁻¹H)⁻¹, so there is a c with Fⱼ P Fⱼᵀ ⪯ c Qⱼ for all P ⪯ C.
//! 2. Mixing: (e, P) ↦ eᵀP⁻¹e is jointly convex, so the mixed error has e⁰ᵀ P̄⁻¹ e⁰ ≤ V for P̄ = Σ μᵢ∣ⱼ Pᵢ ⪯ P⁰ʲ, the mixture without its
//!    spread; P̄ ⪯ C.
//! 3. Prediction: Fⱼ P̄ Fⱼᵀ + s Qⱼ ⪰ (1 + s/c) Fⱼ P̄ Fⱼᵀ and convexity once more leave V/(1 + s/c) + dⱼᵀQⱼ⁻¹dⱼ/(1 − s), for any s in (0,
//!    1).
//! 4. Update: the least of (x − x̂⁻)ᵀ(P⁻)⁻¹(x − x̂⁻) + (z − Hx)ᵀR⁻¹(z − Hx) is taken at x̂, so V grows by no more than vᵀR⁻¹v.
//!
//! So V stays bounded, |eᵢ|² ≤ V ‖C‖, and with the errors the spread and P⁰ʲ. For a measured position alone, H has no full column rank:
//! whether the mixed covariances of the CA-CV filter of the paper are bounded is not decided here.
//!
//! Evidence: `a_measurement_of_the_whole_state_bounds_the_mixed_covariances` (property).

use super::TRANSITION;
use crate::filter::Filter;
use crate::filter::fixed_gain::FixedGain;
use crate::filter::{kalman, update};
use crate::gaussian::{Gaussian, mixture_covariance};
use crate::imm::{Imm, Initial, Interaction, Problem};
use crate::matrix::ldl;
use crate::model::Sensor;
use crate::model::acceleration::{constant_acceleration, modes, position_matrix};
use crate::model::motion::{Mode, Motion};
use crate::number::{Enclosure, Field, Rational, Real};
use crate::paper::monte_carlo::Generator;
use crate::steady::gains;
use crate::steady::polynomial::{has_radius_below, rows_of};
use crate::steady::riccati::Riccati;
use crate::steady::simulated::NotSimulated;
use nalgebra::{Matrix1, Matrix3, RowVector3, U1, U3, Vector3};

/// Two motions that a filter tells apart by nothing, whose mixed covariances grow without bound — derbez2000 (theorem).
///
/// ```text
///      ⎡ 0 1  1 ⎤
/// F₁ = ⎢ 0 3 −3 ⎥     F₂ = T F₁ T,  T = diag(1, 1, −1),  H = [1 0 0],  Q = I,  R = 1
///      ⎣ 0 3 −3 ⎦
/// ```
///
/// Why it meets the hypotheses: F₁³ = F₂³ = 0, so that each error by itself is forgotten in three steps, and both pairs (H, F) are
/// observable. Why the mixed covariances grow: T exchanges the filters and leaves H, so both see the same innovation with the same
/// variance for every data, and the mode probabilities stay one half. The measured entry never learns of the others: with P⁰ = diag(·, w,
/// w) the predicted position is uncorrelated with them. With the paper's chain the unseen variance obeys w′ = (9/5) w + 86/5.
///
/// Example: each motion forgets any state in three steps.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::paper::derbez2000::instances::growing_mixture;
/// use nalgebra::Matrix3;
///
/// for model in growing_mixture::<Rational>() {
///     let f = &model.transition;
///     assert_eq!(f * f * f, Matrix3::zeros());
/// }
/// ```
///
/// Errata: the theorem asks only for bounded errors of the single filters and detectable pairs, which this instance has; what holds in
/// its place is in the head of this file.
///
/// Evidence: `the_mixed_covariances_of_the_theorem_s_instance_grow` (exact).
pub fn growing_mixture<T: Field>() -> [Riccati<T, 3, 1>; 2] {
    let n = |value: i64| T::integer(value);
    let motion = |sign: i64| {
        Matrix3::new(
            n(0),
            n(1),
            n(sign), //
            n(0),
            n(3),
            n(-3 * sign), //
            n(0),
            n(3 * sign),
            n(-3),
        )
    };
    [1, -1].map(|sign| Riccati {
        transition: motion(sign),
        measurement: RowVector3::new(n(1), n(0), n(0)),
        noise: Matrix3::identity(),
        measurement_noise: Matrix1::new(n(1)),
    })
}

/// The mixed covariances P⁰¹ of [`growing_mixture`] at the first steps, exactly, from identities; the data are zero, and the mode
/// probabilities one half.
pub fn mixed_covariances(steps: usize) -> Vec<Matrix3<Rational>> {
    let models = growing_mixture::<Rational>();
    let weights = |j: usize| [0, 1].map(|i| Rational::new(if i == j { 19 } else { 1 }, 20));
    let mut estimates = vec![
        Gaussian {
            mean: Vector3::zeros(),
            covariance: Matrix3::identity()
        };
        2
    ];
    let mut mixed = Vec::new();
    for _ in 0..steps {
        let of = |j: usize| mixture_covariance(&weights(j), &estimates, &Vector3::zeros());
        let both = [of(0), of(1)];
        for ((model, estimate), mixed) in models.iter().zip(&mut estimates).zip(&both) {
            let predicted = kalman::predicted_covariance(&model.transition, mixed, &model.noise);
            let s = kalman::innovation_covariance(&model.measurement, &predicted, &model.measurement_noise);
            let gain = update::gain(&kalman::cross_covariance(&predicted, &model.measurement), &ldl(&s));
            estimate.covariance = update::updated_covariance(&predicted, &gain, &s);
        }
        mixed.push(both[0].clone());
    }
    mixed
}

/// The full IMM filter of [`growing_mixture`] as a program runs it, at step 0.
///
/// # Errors
///
/// [`crate::imm::InvalidProblem`] never: the instance is part of the program, and a test runs it.
pub fn growing_filter() -> Result<Imm<f64, U3, U1>, crate::imm::InvalidProblem> {
    let models = growing_mixture::<f64>();
    let mode = |(j, model): (usize, &Riccati<f64, 3, 1>)| Mode {
        name: format!("model {}", j + 1),
        motion: Motion::Linear(model.transition),
        noise: model.noise,
    };
    let problem = Problem {
        modes: models.iter().enumerate().map(mode).collect(),
        chain: TRANSITION.iter().map(|row| row.to_vec()).collect(),
        sensor: Sensor::Linear(models[0].measurement),
        measurement_noise: models[0].measurement_noise,
        filters: vec![Filter::kalman()],
        interaction: Interaction::Imm,
        angles: vec![],
    };
    Imm::new(problem, &identities(2))
}

/// Estimates of zero with identities as covariances, and equal probabilities.
pub fn identities<T: Field>(modes: i64) -> Initial<T, U3> {
    let estimate = Gaussian {
        mean: Vector3::zeros(),
        covariance: Matrix3::identity(),
    };
    let count = usize::try_from(modes).unwrap_or(0);
    Initial {
        modes: vec![estimate; count],
        mode_probabilities: vec![T::ratio(1, modes); count],
    }
}

/// One coordinate's two modes with t = 1, from the squared noise of both and the measurement variance.
fn coordinate<T: Field>(noise_variances: &[T; 2], measurement_variance: T) -> Problem<T, U3, U1> {
    let ratio =
        |value: f64| T::rational(&Rational::from_decimal(&value.to_string()).unwrap_or_else(Rational::undecided));
    Problem {
        modes: modes(&T::one(), noise_variances).to_vec(),
        chain: TRANSITION
            .iter()
            .map(|row| row.iter().map(|value| ratio(*value)).collect())
            .collect(),
        sensor: Sensor::Linear(position_matrix()),
        measurement_noise: Matrix1::new(measurement_variance),
        filters: vec![Filter::kalman()],
        interaction: Interaction::Imm,
        angles: vec![],
    }
}

/// The gain of constant acceleration in the third step of the paper's full IMM filter, proven digits, if it starts from identities and a
/// target at rest at the origin is measured at 60, 60 and anywhere: t = 1, q = 5 for both modes, R = 0.05.
///
/// Why: the first two measurements leave the two modes' estimates far apart and with errors of opposite sign in position and velocity, so
/// that the mixed covariance predicts a strong negative correlation.
///
/// # Errors
///
/// [`NotSimulated`], if the precision does not do.
///
/// Evidence: `the_full_filter_comes_to_a_local_instability` (enclosed).
pub fn gain_after_a_jump() -> Result<Vector3<Enclosure>, NotSimulated> {
    Enclosure::with_precision(256, || {
        let five = || Enclosure::integer(5);
        let problem = coordinate(&[five(), five()], Enclosure::ratio(1, 20));
        let mut filter = Imm::new(problem, &identities(2))?;
        for z in [60, 60, 0] {
            filter.step(Some(&Matrix1::new(Enclosure::integer(z))))?;
        }
        Ok(filter.current().gains[1].clone())
    })
}

/// Whether (I − K H) F of constant acceleration is proven to have an eigenvalue of at least a magnitude, t = 1.
pub fn is_locally_unstable(gain: &Vector3<Enclosure>, magnitude: &Rational) -> bool {
    Enclosure::with_precision(256, || {
        let loop_of = (Matrix3::identity() - gain * position_matrix()) * constant_acceleration(&Enclosure::integer(1));
        has_radius_below(&rows_of(&loop_of), &Enclosure::rational(magnitude)) == Some(false)
    })
}

/// The fixed-gain IMM filter with damping roots, t = 1 and R = 1, from estimates and equal probabilities.
///
/// # Errors
///
/// [`crate::imm::InvalidProblem`] for roots that are not between zero and one.
pub fn fixed_gain_filter<T: Real>(
    roots: &[T; 2],
    mean: &Vector3<T>,
) -> Result<Imm<T, U3, U1>, crate::imm::InvalidProblem> {
    let (one, [v, a]) = (T::one(), roots);
    let fixed = |gain, root: &T| FixedGain {
        gain,
        innovation_covariance: Matrix1::new(gains::innovation_variance(root, &one)),
    };
    let problem = Problem {
        filters: vec![
            Filter::given(fixed(gains::alpha_beta_gain(v, &one), v)),
            Filter::given(fixed(gains::alpha_beta_gamma_gain(a, &one), a)),
        ],
        // Nothing reads the process noises: the gains were computed from them.
        ..coordinate(&[T::zero(), T::zero()], one.clone())
    };
    let mut initial = identities(2);
    for estimate in &mut initial.modes {
        estimate.mean = mean.clone();
        estimate.covariance = Matrix3::zeros();
    }
    Imm::new(problem, &initial)
}

/// The distances in position of two copies of the filter with θ = (4/5, 1/5), which see the same bounded data and start a millimetre apart,
/// after every hundredth step.
///
/// ```text
/// z = 30, −120, −30, 120, 30, …   x̂₀ = [120, 160, 0] or a millimetre farther
/// ```
///
/// Why they part: the first copy goes round (120, 160, 0) → (40, −160, −640/3) → −(120, 160, 0), where the constant acceleration filter
/// and the constant velocity filter win in turn by wide margins, in both copies alike. Both filters of a copy then go on from the winner,
/// and the difference obeys A_v A_a, whose eigenvalue −1.0295 is outside the unit circle.
///
/// # Errors
///
/// [`NotSimulated`], if the precision does not do.
///
/// Evidence: `two_copies_that_see_the_same_data_part` (enclosed).
pub fn distances_of_two_copies(steps: u32) -> Result<Vec<f64>, NotSimulated> {
    Enclosure::with_precision(24 * steps + 256, || {
        let copy = |apart: Enclosure| {
            let roots = [Enclosure::ratio(4, 5), Enclosure::ratio(1, 5)];
            let start = Vector3::new(
                Enclosure::integer(120) + apart,
                Enclosure::integer(160),
                Enclosure::integer(0),
            );
            fixed_gain_filter(&roots, &start)
        };
        let mut copies = [copy(Enclosure::integer(0))?, copy(Enclosure::ratio(1, 1000))?];
        let mut distances = Vec::new();
        for (n, z) in (1..=steps).zip([30, -120, -30, 120].into_iter().cycle()) {
            for copy in &mut copies {
                copy.step(Some(&Matrix1::new(Enclosure::integer(z))))?;
            }
            if n % 100 == 0 {
                let [first, second] = copies.each_ref().map(|copy| copy.current().combined.mean[0].clone());
                distances.push((second - first).to_f64().map_or(f64::NAN, f64::abs));
            }
        }
        Ok(distances)
    })
}

/// In how many of `runs` runs the copies of [`distances_of_two_copies`] are more than a millimetre apart after 300 and after 1000 steps,
/// if what both see has Gaussian noise of a deviation, m; in doubles.
///
/// Why there are fewer the more noise there is: the path that the copies go round is an unstable one. Noise takes them off it, and then
/// they forget.
///
/// # Errors
///
/// [`NotSimulated`], if a step cannot be computed.
///
/// Evidence: `noise_takes_two_copies_off_the_path_on_which_they_part` (statistical).
pub fn copies_apart(deviation: f64, runs: usize) -> Result<[usize; 2], NotSimulated> {
    let mut counts = [0; 2];
    for run in 0..runs {
        let mut generator = Generator::new(1, run as u64);
        let copy = |apart: f64| fixed_gain_filter(&[0.8, 0.2], &Vector3::new(120.0 + apart, 160.0, 0.0));
        let mut copies = [copy(0.0)?, copy(1e-3)?];
        for (n, z) in (1..=1000).zip([30.0, -120.0, -30.0, 120.0].into_iter().cycle()) {
            let seen = Matrix1::new(z + deviation * generator.standard_normal());
            for copy in &mut copies {
                copy.step(Some(&seen))?;
            }
            let [first, second] = copies.each_ref().map(|copy| copy.current().combined.mean[0]);
            let is_apart = usize::from((second - first).abs() > 1e-3);
            match n {
                300 => counts[0] += is_apart,
                1000 => counts[1] += is_apart,
                _ => {}
            }
        }
    }
    Ok(counts)
}

/// The errors, after a number of steps, of two copies of the filter with θ = (1/3, 1/2), whose joint stability is certified, on the same
/// data: a target that starts from rest with an acceleration of 20, z = 10 n². The first starts without an acceleration, the second with
/// the right one.
///
/// Why they stay apart: after a step of constant velocity both filters predict the same, so that the one with the larger innovation
/// variance wins again. Its error is bounded, as the certificate says; it is the bias of the constant velocity filter, for ever.
///
/// # Errors
///
/// [`NotSimulated`], if a step cannot be computed.
///
/// Evidence: `a_certified_filter_may_lock_into_the_wrong_mode` (property).
pub fn locked_errors(steps: u32) -> Result<[Vector3<f64>; 2], NotSimulated> {
    let mut errors = [Vector3::zeros(); 2];
    for (error, acceleration) in errors.iter_mut().zip([0.0, 20.0]) {
        let start = Vector3::new(0.0, 0.0, acceleration);
        let mut filter = fixed_gain_filter(&[1.0 / 3.0, 0.5], &start)?;
        for n in 1..=steps {
            let n = f64::from(n);
            let truth = Vector3::new(10.0 * n * n, 20.0 * n, 20.0);
            let step = filter.step(Some(&Matrix1::new(truth[0])))?;
            *error = step.combined.mean - truth;
        }
    }
    Ok(errors)
}
