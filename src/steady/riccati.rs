//! The Riccati equation of the steady Kalman filter: two ways to solve it, and a proof that the solution is the right one.
//!
//! Two rational matrices prove that the steady state exists, is the only stabilising one, and lies between them.
//!
//! ```text
//! P = f(P),   f(P) = F (P − P Hᵀ (H P Hᵀ + R)⁻¹ H P) Fᵀ + Q         P: predicted covariance
//! ```
//!
//! | way                  | what it does                                                                              |
//! |----------------------|-------------------------------------------------------------------------------------------|
//! | [`Riccati::next`]    | one step of the filter's own recursion; the solution is its limit                          |
//! | [`Riccati::doubled`] | the same limit in steps that each double the number of recursions                          |
//! | [`SteadyState`]      | a lower and an upper bound, checked in exact arithmetic                                    |

use super::linear::{self, stein};
use super::polynomial::{is_stable_polynomial, rows_of};
use super::reach::{polynomial_text, unseen_part};
use crate::filter::{kalman, update};
use crate::matrix::{
    Holds, NotPositiveDefinite, Shapes, check_positive_definite, is_positive_semidefinite, is_symmetric, ldl, mirrored,
    rows,
};
use crate::number::{Enclosure, Field, Rational};
use nalgebra::{Dim, OMatrix, SMatrix};

/// What a steady Kalman filter is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Riccati<T, const N: usize, const M: usize> {
    /// F.
    pub transition: SMatrix<T, N, N>,
    /// H.
    pub measurement: SMatrix<T, M, N>,
    /// Q, positive semidefinite.
    pub noise: SMatrix<T, N, N>,
    /// R, positive definite.
    pub measurement_noise: SMatrix<T, M, M>,
}

impl<T: Field, const N: usize, const M: usize> Riccati<T, N, M> {
    /// The predicted covariance a step later — derbez2000 (2), (4).
    ///
    /// ```text
    /// S = H P Hᵀ + R,   K = P Hᵀ S⁻¹,   f(P) = F (P − K S Kᵀ) Fᵀ + Q
    /// ```
    ///
    /// | paper      | here        | shape | meaning                    |
    /// |------------|-------------|-------|----------------------------|
    /// | P₍n∣n−1₎   | `predicted` | N × N | predicted covariance       |
    /// | F, Q       | of the mode | N × N | motion and process noise   |
    /// | H, R       | of the sensor | M × N, M × M | measurement and its noise |
    ///
    /// Why: update and prediction of the Kalman filter; covariances do not depend on what is measured.
    ///
    /// Example: constant velocity with t = 1, q = 1 and R = 1, whose steady gain has α = 3/4 and β = 1/2.
    ///
    /// ```
    /// use immaculate::number::{Field, Rational};
    /// use immaculate::steady::riccati::Riccati;
    /// use nalgebra::matrix;
    ///
    /// let whole = Rational::integer;
    /// let filter = Riccati {
    ///     transition: matrix![1, 1; 0, 1].map(whole),
    ///     measurement: matrix![1, 0].map(whole),
    ///     noise: matrix![1, 2; 2, 4].map(|entry| Rational::new(entry, 4)), // [½, 1]ᵀ [½, 1]
    ///     measurement_noise: matrix![1].map(whole),
    /// };
    /// // P = [3 2; 2 2]: S = 4, K = [3/4, 1/2]ᵀ, P − K S Kᵀ = [3/4 1/2; 1/2 1]. Moved, [11/4 3/2; 3/2 1]; with the noise, P again.
    /// let steady = matrix![3, 2; 2, 2].map(whole);
    /// assert_eq!(filter.next(&steady), steady);
    /// ```
    ///
    /// Evidence: `the_alpha_beta_gain_solves_the_riccati_equation` (symbolic).
    #[must_use]
    pub fn next(&self, predicted: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
        kalman::predicted_covariance(&self.transition, &self.updated(predicted), &self.noise)
    }

    /// P − K S Kᵀ, the covariance after the update.
    pub(super) fn updated(&self, predicted: &SMatrix<T, N, N>) -> SMatrix<T, N, N> {
        let innovation = kalman::innovation_covariance(&self.measurement, predicted, &self.measurement_noise);
        update::updated_covariance(predicted, &self.gain(predicted), &innovation)
    }

    /// The gain at a predicted covariance, K = P Hᵀ (H P Hᵀ + R)⁻¹ — derbez2000 (2), (4).
    ///
    /// Example: constant velocity at the predicted covariance of the example of [`Riccati::next`]; the process noise plays no part.
    ///
    /// ```
    /// use immaculate::number::{Field, Rational};
    /// use immaculate::steady::riccati::Riccati;
    /// use nalgebra::{matrix, vector};
    ///
    /// let whole = Rational::integer;
    /// let filter = Riccati {
    ///     transition: matrix![1, 1; 0, 1].map(whole),
    ///     measurement: matrix![1, 0].map(whole),
    ///     noise: matrix![0, 0; 0, 0].map(whole),
    ///     measurement_noise: matrix![1].map(whole),
    /// };
    /// // The first column of P over S = 3 + 1.
    /// let gain = filter.gain(&matrix![3, 2; 2, 2].map(whole));
    /// assert_eq!(gain, vector![Rational::new(3, 4), Rational::new(1, 2)]);
    /// ```
    pub fn gain(&self, predicted: &SMatrix<T, N, N>) -> SMatrix<T, N, M> {
        let innovation = kalman::innovation_covariance(&self.measurement, predicted, &self.measurement_noise);
        update::gain(
            &kalman::cross_covariance(predicted, &self.measurement),
            &ldl(&innovation),
        )
    }

    /// The matrix that carries the filter's error from one update to the next, A = (I − K H) F.
    ///
    /// Source: derbez2000, section 2.2, the definition of A₊ below (7).
    ///
    /// Example: constant velocity with the gain of the example of [`Riccati::gain`].
    ///
    /// ```
    /// use immaculate::number::{Field, Rational};
    /// use immaculate::steady::riccati::Riccati;
    /// use nalgebra::{matrix, vector};
    ///
    /// let whole = Rational::integer;
    /// let filter = Riccati {
    ///     transition: matrix![1, 1; 0, 1].map(whole),
    ///     measurement: matrix![1, 0].map(whole),
    ///     noise: matrix![0, 0; 0, 0].map(whole),
    ///     measurement_noise: matrix![1].map(whole),
    /// };
    /// // K = [3/4, 1/2]ᵀ: I − K H = [1/4 0; −1/2 1], times F.
    /// let gain = vector![Rational::new(3, 4), Rational::new(1, 2)];
    /// let carried = matrix![1, 1; -2, 2].map(|entry| Rational::new(entry, 4));
    /// assert_eq!(filter.closed_loop(&gain), carried);
    /// ```
    pub fn closed_loop(&self, gain: &SMatrix<T, N, M>) -> SMatrix<T, N, N> {
        closed_loop(gain, &self.measurement, &self.transition)
    }
}

/// (I − K H) F: [`Riccati::closed_loop`].
pub fn closed_loop<T: Field, N: Dim, M: Dim>(
    gain: &OMatrix<T, N, M>,
    measurement: &OMatrix<T, M, N>,
    transition: &OMatrix<T, N, N>,
) -> OMatrix<T, N, N>
where
    Shapes: Holds<N, M>,
{
    (OMatrix::identity_generic(rows(gain), rows(gain)) - gain * measurement) * transition
}

impl<T: Field + PartialOrd, const N: usize, const M: usize> Riccati<T, N, M> {
    /// The predicted covariance after 2ᵏ steps of the recursion from zero, for k doublings; none where it cannot be computed.
    ///
    /// ```text
    /// A₀ = Fᵀ, G₀ = Hᵀ R⁻¹ H, P₀ = Q
    /// A₊ = A W A,   G₊ = G + A W G Aᵀ,   P₊ = P + Aᵀ P W A,   W = (I + G P)⁻¹
    /// ```
    ///
    /// Why: a step is P ↦ Q + F P (I + G P)⁻¹ Fᵀ, a fractional map, and the composition of two maps of this form is again of this form.
    /// The first step from zero gives Q.
    ///
    /// Source: Anderson 1978; Chu, Fan, Lin and Wang 2004.
    ///
    /// Example: for F = H = Q = R = 1: f(P) = P/(P + 1) + 1 goes 0, 1, 3/2, 8/5, 21/13: two Fibonacci numbers further at each step.
    ///
    /// ```
    /// use immaculate::number::Rational;
    /// use immaculate::steady::riccati::Riccati;
    /// use nalgebra::matrix;
    ///
    /// let one = matrix![Rational::new(1, 1)];
    /// let filter = Riccati { transition: one.clone(), measurement: one.clone(), noise: one.clone(), measurement_noise: one };
    /// assert_eq!(filter.doubled(0).unwrap()[0], Rational::new(1, 1));
    /// assert_eq!(filter.doubled(1).unwrap()[0], Rational::new(3, 2));
    /// assert_eq!(filter.doubled(2).unwrap()[0], Rational::new(21, 13));
    /// ```
    ///
    /// Evidence: `doubling_and_recursion_have_the_same_limit` (exact).
    pub fn doubled(&self, doublings: usize) -> Option<SMatrix<T, N, N>> {
        let inverse_noise = crate::matrix::solve(&ldl(&self.measurement_noise), &self.measurement);
        let mut a = self.transition.transpose();
        let mut g = self.measurement.transpose() * inverse_noise;
        let mut p = self.noise.clone();
        for _ in 0..doublings {
            let w = inverse(&(SMatrix::identity() + &g * &p))?;
            let aw = &a * &w;
            let next_p = &p + a.transpose() * &p * &w * &a;
            g = mirrored(&g + &aw * &g * a.transpose());
            a = aw * a;
            p = mirrored(next_p);
        }
        Some(p)
    }
}

/// The inverse of a matrix; none if it has none.
fn inverse<T: Field + PartialOrd, const N: usize>(matrix: &SMatrix<T, N, N>) -> Option<SMatrix<T, N, N>> {
    let identity = rows_of(&SMatrix::<T, N, N>::identity());
    let solved = linear::solve(rows_of(matrix), identity)?;
    Some(SMatrix::from_fn(|i, j| solved[i][j].clone()))
}

/// Two rational matrices between which the stabilising solution of a Riccati equation lies: a proof that anyone can check.
///
/// ```text
/// R + H L Hᵀ ≻ 0,   f(L) ≻ L,   L ≺ U,   f(U) ≺ U
/// ```
///
/// Why these four inequalities prove it. As long as R + H P Hᵀ ≻ 0, f(P) is the least over all gains K of
/// (F − KH) P (F − KH)ᵀ + Q + K R Kᵀ (with K for F K), so f is monotone and concave there.
///
/// - *Existence*: L ≺ f(L) ⪯ f(f(L)) ⪯ … ⪯ U rises and is bounded; its limit P is a fixed point in [L, U].
/// - *Stabilisation*: with D = P − L concavity gives D ≻ f(P) − f(L) ⪰ A D Aᵀ for A = F(I − KH) at P. So D ≻ 0 and D − A D Aᵀ ≻ 0, which
///   is Lyapunov's condition that the spectral radius of A is below one.
/// - *Uniqueness*: any fixed point P′ has P′ − P = f(P′) − f(P) ⪯ A (P′ − P) Aᵀ ⪯ … → 0, so P is the greatest; another that stabilises
///   would be the greatest too.
///
/// Source: Lancaster and Rodman, Algebraic Riccati Equations, 1995, for the monotonicity; the certificate is put together here.
///
/// Example: for F = H = Q = R = 1: P = P/(P + 1) + 1 is the golden section, 1.618…, and lies between 8/5 and 5/3: f(8/5) = 21/13 > 8/5 and
/// f(5/3) = 13/8 < 5/3.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::riccati::{Riccati, SteadyState};
/// use nalgebra::matrix;
///
/// let one = matrix![Rational::new(1, 1)];
/// let filter = Riccati { transition: one.clone(), measurement: one.clone(), noise: one.clone(), measurement_noise: one };
/// let between = |lower, upper| SteadyState { lower: matrix![lower], upper: matrix![upper] };
/// assert!(between(Rational::new(8, 5), Rational::new(5, 3)).check(&filter).is_ok());
/// // 13/8 = 1.625 is above it: f(13/8) = 34/21 < 13/8.
/// assert!(between(Rational::new(13, 8), Rational::new(5, 3)).check(&filter).is_err());
/// ```
///
/// Evidence: `a_steady_state_is_proven_by_two_bounds`, `a_spoilt_bound_proves_nothing` (exact).
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyState<const N: usize> {
    /// L.
    pub lower: SMatrix<Rational, N, N>,
    /// U.
    pub upper: SMatrix<Rational, N, N>,
}

/// Why a steady state is not proven.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoSteadyState {
    /// A matrix of the problem is not what it must be.
    #[error("`{field}` {reason} (derbez2000 (2))")]
    Invalid {
        /// The field.
        field: &'static str,
        /// What it is not.
        reason: String,
    },
    /// There is a mode that is not measured and does not decay.
    #[error(
        "the pair (H, F) is not detectable: a part of the state that is not measured, with the characteristic polynomial {polynomial}, \
         does not decay (derbez2000, section 2.2)"
    )]
    NotDetectable {
        /// The characteristic polynomial of the part.
        polynomial: String,
    },
    /// There is a mode that no noise reaches and that does not decay.
    #[error(
        "the pair (F, Q) is not stabilisable: a part of the state that no noise reaches, with the characteristic polynomial \
         {polynomial}, does not decay, so that the gain falls to zero or the error is not forgotten (derbez2000, section 2.2)"
    )]
    NotStabilisable {
        /// The characteristic polynomial of the part.
        polynomial: String,
    },
    /// An inequality of the proof does not hold.
    #[error("the inequality {inequality} does not hold: the matrix {pivot}")]
    Inequality {
        /// Which.
        inequality: &'static str,
        /// Where.
        pivot: NotPositiveDefinite,
    },
    /// No bounds were found.
    #[error("no bounds that prove a steady state were found with {bits} bits")]
    NotFound {
        /// The precision of the search.
        bits: u32,
    },
}

impl<const N: usize> SteadyState<N> {
    /// Checks the four inequalities.
    ///
    /// # Errors
    ///
    /// [`NoSteadyState::Inequality`] with the first that does not hold.
    pub fn check<const M: usize>(&self, problem: &Riccati<Rational, N, M>) -> Result<(), NoSteadyState> {
        let Self { lower, upper } = self;
        let h = &problem.measurement;
        let innovation = kalman::innovation_covariance(h, lower, &problem.measurement_noise);
        check("R + H L Hᵀ ≻ 0", &innovation)?;
        check("f(L) − L ≻ 0", &(problem.next(lower) - lower))?;
        check("U − L ≻ 0", &(upper - lower))?;
        check("U − f(U) ≻ 0", &(upper - problem.next(upper)))
    }

    /// Finds and checks bounds whose distance is about 2 to the power −`bits`/2 of the solution's size.
    ///
    /// The middle comes from [`Riccati::doubled`] on enclosures, the distance from the Lyapunov equation W = A W Aᵀ + I of the closed loop
    /// there: f(P ± εW) is about P ± ε(W − I). Whatever is found is checked.
    ///
    /// Example: F = H = R = 1, with Q = 1 and with Q = 0.
    ///
    /// ```
    /// use immaculate::number::Rational;
    /// use immaculate::steady::riccati::{Riccati, SteadyState};
    /// use nalgebra::matrix;
    ///
    /// let number = |value| matrix![Rational::new(value, 1)];
    /// let filter = |noise| Riccati { transition: number(1), measurement: number(1), noise: number(noise), measurement_noise: number(1) };
    /// assert!(SteadyState::certify(&filter(1), 64).is_ok());
    /// // Without process noise the filter ends up believing itself, and says why there is no proof.
    /// let reason = SteadyState::certify(&filter(0), 64).unwrap_err().to_string();
    /// assert!(reason.contains("(F, Q) is not stabilisable"));
    /// ```
    ///
    /// # Errors
    ///
    /// [`NoSteadyState`] with the reason.
    pub fn certify<const M: usize>(problem: &Riccati<Rational, N, M>, bits: u32) -> Result<Self, NoSteadyState> {
        check_problem(problem)?;
        Self::find(problem, bits)
            .ok_or(NoSteadyState::NotFound { bits })
            .and_then(|found| found.check(problem).map(|()| found))
            .map_err(|error| why_not(problem).unwrap_or(error))
    }

    fn find<const M: usize>(problem: &Riccati<Rational, N, M>, bits: u32) -> Option<Self> {
        let middle = Enclosure::with_precision(2 * bits, || {
            let solution = problem.map(Enclosure::rational).doubled(DOUBLINGS)?;
            Some(solution.map(|entry| rounded(&entry.lower(), 2 * bits)))
        })?;
        if middle.iter().any(|entry| !entry.is_decided()) {
            return None;
        }
        let a = problem.transition.clone() * (SMatrix::identity() - problem.gain(&middle) * &problem.measurement);
        let shape = stein(&a.map(|entry| rounded(&entry, bits)), &SMatrix::identity())?;
        let shape = shape.map(|entry| rounded(&entry, bits));
        let size = middle
            .iter()
            .map(Rational::abs)
            .fold(Rational::new(0, 1), |a, b| if a > b { a } else { b });
        let distance = (size + Rational::new(1, 1)) * Rational::new(1, 2).pow(bits / 2);
        let apart = mirrored(shape * distance);
        let middle = mirrored(middle);
        Some(Self {
            lower: &middle - &apart,
            upper: &middle + &apart,
        })
    }

    /// An enclosure of an entry of the solution, at the precision of the scope.
    ///
    /// Source: 0 ⪯ P − L ⪯ U − L, and an entry of a semidefinite matrix is no greater than the root of the product of its diagonal entries.
    ///
    /// Example: 8/5 ± (5/3 − 8/5): it holds 13/8, whose distance from 8/5 is 1/40 < 1/15, and does not hold 2.
    ///
    /// ```
    /// use immaculate::number::{Enclosure, Rational};
    /// use immaculate::steady::riccati::SteadyState;
    /// use nalgebra::matrix;
    ///
    /// let bounds = SteadyState { lower: matrix![Rational::new(8, 5)], upper: matrix![Rational::new(5, 3)] };
    /// Enclosure::with_precision(64, || {
    ///     assert!(bounds.entry(0, 0).contains(&Rational::new(13, 8)));
    ///     assert!(!bounds.entry(0, 0).contains(&Rational::new(2, 1)));
    /// });
    /// ```
    pub fn entry(&self, i: usize, j: usize) -> Enclosure {
        let apart = |i: usize| self.upper[(i, i)].clone() - self.lower[(i, i)].clone();
        // The greater diagonal entry bounds the root of the product.
        let radius = if apart(i) > apart(j) { apart(i) } else { apart(j) };
        Enclosure::rational(&self.lower[(i, j)]) + Enclosure::rational(&radius) * Enclosure::around(0.0, 1.0)
    }

    /// The steady gain, at the precision of the scope.
    ///
    /// Source: derbez2000 (2), (4).
    ///
    /// Example: for F = H = Q = R = 1: P is the golden section φ, and K = φ/(φ + 1) = 1/φ = 0.618….
    ///
    /// ```
    /// use immaculate::number::{Enclosure, Rational};
    /// use immaculate::steady::riccati::{Riccati, SteadyState};
    /// use nalgebra::matrix;
    ///
    /// let one = matrix![Rational::new(1, 1)];
    /// let filter = Riccati { transition: one.clone(), measurement: one.clone(), noise: one.clone(), measurement_noise: one };
    /// let steady = SteadyState::certify(&filter, 64).unwrap();
    /// Enclosure::with_precision(128, || {
    ///     assert_eq!(steady.gain(&filter)[0].to_decimal(6).unwrap(), "6.18034e-1");
    /// });
    /// ```
    pub fn gain<const M: usize>(&self, problem: &Riccati<Rational, N, M>) -> SMatrix<Enclosure, N, M> {
        let solution = SMatrix::<Enclosure, N, N>::from_fn(|i, j| self.entry(i, j));
        problem.map(Enclosure::rational).gain(&solution)
    }
}

/// Enough doublings for a closed loop whose spectral radius differs from one by more than a millionth: 2³⁰ steps of the recursion.
pub(super) const DOUBLINGS: usize = 30;

fn check<const N: usize>(inequality: &'static str, matrix: &SMatrix<Rational, N, N>) -> Result<(), NoSteadyState> {
    check_positive_definite(&ldl(matrix)).map_err(|pivot| NoSteadyState::Inequality { inequality, pivot })
}

/// A rational with a number of bits after the point, below the given one by less than the last of them.
fn rounded(value: &Rational, bits: u32) -> Rational {
    let scale = Rational::new(2, 1).pow(bits);
    let scaled = value.clone() * scale.clone();
    scaled
        .value()
        .map_or_else(Rational::undecided, |scaled| Rational::from_big(scaled.floor()) / scale)
}

impl<const N: usize, const M: usize> Riccati<Rational, N, M> {
    /// The same problem in another number system.
    pub fn map<T: Field>(&self, number: impl Fn(&Rational) -> T) -> Riccati<T, N, M> {
        Riccati {
            transition: self.transition.map(|entry| number(&entry)),
            measurement: self.measurement.map(|entry| number(&entry)),
            noise: self.noise.map(|entry| number(&entry)),
            measurement_noise: self.measurement_noise.map(|entry| number(&entry)),
        }
    }
}

fn check_problem<const N: usize, const M: usize>(problem: &Riccati<Rational, N, M>) -> Result<(), NoSteadyState> {
    let invalid = |field, reason: &str| {
        Err(NoSteadyState::Invalid {
            field,
            reason: reason.to_owned(),
        })
    };
    if !is_symmetric(&problem.noise) || !is_positive_semidefinite(&problem.noise) {
        return invalid("Q", "is not symmetric positive semidefinite");
    }
    if !is_symmetric(&problem.measurement_noise) {
        return invalid("R", "is not symmetric");
    }
    check_positive_definite(&ldl(&problem.measurement_noise)).or_else(|pivot| invalid("R", &pivot.to_string()))
}

/// The first of the two conditions that does not hold, if there is one.
fn why_not<const N: usize, const M: usize>(problem: &Riccati<Rational, N, M>) -> Option<NoSteadyState> {
    let part = |polynomial: Vec<Rational>| {
        let decays = is_stable_polynomial(&polynomial) == Some(true);
        (!decays).then(|| polynomial_text(&polynomial))
    };
    let unmeasured = unseen_part(&rows_of(&problem.transition), &rows_of(&problem.measurement));
    if let Some(polynomial) = part(unmeasured) {
        return Some(NoSteadyState::NotDetectable { polynomial });
    }
    let transposed = rows_of(&problem.transition.transpose());
    let unreached = unseen_part(&transposed, &rows_of(&problem.noise));
    part(unreached).map(|polynomial| NoSteadyState::NotStabilisable { polynomial })
}
