//! Goal: a smoothed estimate is that of the state given all measurements, of one filter exactly, and of several that switch wherever
//! one Gaussian a mode can say it.
//!
//! Method: the equations in rationals and surds against the joint Gaussian of all states and measurements, against the normal equations of
//! least squares, and against the sum over all sequences of modes; recorded runs in enclosures, which contain these fractions. A recorded
//! run has logarithms in it, so that it cannot run in rationals. Simulated targets that switch, with a fixed seed: each comparison is
//! paired, and fails by chance with a probability below 10⁻⁶. Runs that must be refused are refused in a sentence.
#![allow(clippy::unwrap_used, reason = "in tests a panic is the failure")]

use immaculate::filter::{Filter, Transform, cubature, fixed_gain::FixedGain, kalman, update};
use immaculate::gaussian::{Gaussian, log_density, mixture_covariance, mixture_mean};
use immaculate::imm::probability::{evidence, mixing_probability, mode_probability, predicted_mode_probability};
use immaculate::imm::state_conversion::{Reader, StateConversion, StateConversions};
use immaculate::imm::{Imm, Initial, Interaction, Problem};
use immaculate::matrix::{is_positive_definite, is_positive_semidefinite, ldl};
use immaculate::model::function::Function;
use immaculate::model::motion::{Mode, Motion};
use immaculate::model::{PolarComponent, Sensor};
use immaculate::number::{Enclosure, Field, Rational, Real, Surd};
use immaculate::rule::unscented::{Parameters, unscented};
use immaculate::rule::{Rule, RuleName};
use immaculate::smoother::rauch_tung_striebel::{smoothed_covariance, smoothed_mean, smoother_gain};
use immaculate::smoother::switching::pair_probability;
use immaculate::smoother::{Recording, SmoothedStep, SwitchingSmoother, Unsmoothable};
use nalgebra::{DMatrix, Matrix2, SMatrix, U1, U2, U3, Vector1, Vector2, Vector3, matrix, vector};

fn ratio(numerator: i64, denominator: i64) -> Rational {
    Rational::new(numerator, denominator)
}

fn matrix_of<T: Field, const R: usize, const C: usize>(entries: [[i64; C]; R]) -> SMatrix<T, R, C> {
    SMatrix::from_fn(|row, column| T::integer(entries[row][column]))
}

/// A linear problem of two components of which one is measured; its motion changes from step to step.
struct Linear {
    start: Gaussian<Rational, U2>,
    motions: Vec<(Matrix2<Rational>, Matrix2<Rational>)>,
    h: SMatrix<Rational, 1, 2>,
    r: SMatrix<Rational, 1, 1>,
    measurements: Vec<Option<Rational>>,
}

/// Position and velocity over four steps, the second without a detection.
fn linear() -> Linear {
    let even = (matrix_of([[1, 1], [0, 1]]), matrix_of([[2, 1], [1, 3]]));
    let odd = (matrix_of([[1, 2], [-1, 1]]), matrix_of([[3, -1], [-1, 1]]));
    Linear {
        start: Gaussian {
            mean: vector![ratio(1, 1), ratio(-1, 2)],
            covariance: matrix_of([[5, 1], [1, 4]]),
        },
        motions: vec![even.clone(), odd.clone(), even, odd],
        h: matrix_of([[2, -1]]),
        r: matrix_of([[7]]),
        measurements: vec![Some(ratio(3, 1)), None, Some(ratio(-5, 2)), Some(ratio(11, 1))],
    }
}

/// What a filter knows of a step and of how it came there.
struct Filtered {
    updated: Gaussian<Rational, U2>,
    predicted: Gaussian<Rational, U2>,
    cross_covariance: Matrix2<Rational>,
}

impl Linear {
    /// The Kalman filter, by the plain equations; step 0 has no prediction and is left out.
    fn filtered(&self) -> Vec<Filtered> {
        let mut before = self.start.clone();
        let mut steps = Vec::new();
        for ((f, q), z) in self.motions.iter().zip(&self.measurements) {
            let predicted = Gaussian {
                mean: kalman::predicted_mean(f, &before.mean),
                covariance: kalman::predicted_covariance(f, &before.covariance, q),
            };
            let cross_covariance = kalman::cross_covariance(&before.covariance, f);
            let mut updated = predicted.clone();
            if let Some(z) = z {
                let s = kalman::innovation_covariance(&self.h, &predicted.covariance, &self.r);
                let gain = update::gain(&kalman::cross_covariance(&predicted.covariance, &self.h), &ldl(&s));
                let innovation = Vector1::new(z.clone()) - &self.h * &predicted.mean;
                updated = Gaussian {
                    mean: update::updated_mean(&predicted.mean, &gain, &innovation),
                    covariance: update::updated_covariance(&predicted.covariance, &gain, &s),
                };
            }
            before = updated.clone();
            steps.push(Filtered {
                updated,
                predicted,
                cross_covariance,
            });
        }
        steps
    }

    /// Every state by the equations of the smoother, from step 0 on.
    fn smoothed(&self) -> Vec<Gaussian<Rational, U2>> {
        let steps = self.filtered();
        let mut smoothed = vec![steps.last().unwrap().updated.clone()];
        for k in (0..steps.len()).rev() {
            let (next, after) = (&steps[k], smoothed.last().unwrap());
            let updated = if k == 0 { &self.start } else { &steps[k - 1].updated };
            let before = one_step_back(updated, &next.predicted, &next.cross_covariance, after);
            smoothed.push(before);
        }
        smoothed.reverse();
        smoothed
    }

    /// Every state given the measurements of the first steps: the joint Gaussian of all states, and what is measured of it, in one piece.
    fn batch(&self, measured_steps: usize) -> Vec<Gaussian<Rational, U2>> {
        let steps = self.motions.len() + 1;
        let mut mean = vec![self.start.mean.clone()];
        // Row k: the states as sums of the start and of the noises of each step.
        let mut made_of = vec![vec![Matrix2::<Rational>::identity()]];
        for (f, _) in &self.motions {
            mean.push(f * mean.last().unwrap());
            let mut row: Vec<_> = made_of.last().unwrap().iter().map(|part| f * part).collect();
            row.push(Matrix2::identity());
            made_of.push(row);
        }
        let noise = |m: usize| {
            if m == 0 {
                &self.start.covariance
            } else {
                &self.motions[m - 1].1
            }
        };
        let block = |k: usize, l: usize| {
            let shared = made_of[k].iter().zip(&made_of[l]).enumerate();
            shared.fold(Matrix2::zeros(), |sum, (m, (a, b))| sum + a * noise(m) * b.transpose())
        };
        let joint = DMatrix::from_fn(2 * steps, 2 * steps, |i, k| block(i / 2, k / 2)[(i % 2, k % 2)].clone());
        let all = DMatrix::from_fn(2 * steps, 1, |i, _| mean[i / 2][i % 2].clone());
        let seen: Vec<usize> = (0..measured_steps)
            .filter(|&k| self.measurements[k].is_some())
            .collect();
        let of_step = |row: usize, i: usize| {
            if i / 2 == seen[row] + 1 {
                self.h[i % 2].clone()
            } else {
                ratio(0, 1)
            }
        };
        let h = DMatrix::from_fn(seen.len(), 2 * steps, of_step);
        let z = DMatrix::from_fn(seen.len(), 1, |row, _| self.measurements[seen[row]].clone().unwrap());
        let r = DMatrix::from_fn(seen.len(), seen.len(), |i, k| {
            if i == k { self.r[0].clone() } else { ratio(0, 1) }
        });
        let cross = &joint * h.transpose();
        let s = &h * &cross + r;
        let known = &all + &cross * solved(&s, &(z - &h * &all));
        let left = &joint - &cross * solved(&s, &cross.transpose());
        let of_state = |k: usize| Gaussian {
            mean: Vector2::from_fn(|i, _| known[(2 * k + i, 0)].clone()),
            covariance: Matrix2::from_fn(|i, l| left[(2 * k + i, 2 * k + l)].clone()),
        };
        (0..steps).map(of_state).collect()
    }
}

/// The step of Rauch, Tung and Striebel by its three equations.
fn one_step_back(
    updated: &Gaussian<Rational, U2>,
    predicted: &Gaussian<Rational, U2>,
    cross_covariance: &Matrix2<Rational>,
    after: &Gaussian<Rational, U2>,
) -> Gaussian<Rational, U2> {
    let gain = smoother_gain(cross_covariance, &predicted.covariance).unwrap();
    Gaussian {
        mean: smoothed_mean(&updated.mean, &gain, &(&after.mean - &predicted.mean)),
        covariance: smoothed_covariance(&updated.covariance, &gain, &after.covariance, &predicted.covariance),
    }
}

/// A⁻¹ B by Gauss and Jordan, which shares nothing with the factorisations of the crate.
fn solved(a: &DMatrix<Rational>, b: &DMatrix<Rational>) -> DMatrix<Rational> {
    let (mut a, mut b) = (a.clone(), b.clone());
    for column in 0..a.nrows() {
        let pivot = a[(column, column)].clone();
        for row in 0..a.nrows() {
            let factor = a[(row, column)].clone() / pivot.clone();
            if row == column {
                continue;
            }
            for k in 0..a.ncols() {
                let eliminated = factor.clone() * a[(column, k)].clone();
                a[(row, k)] -= eliminated;
            }
            for k in 0..b.ncols() {
                let eliminated = factor.clone() * b[(column, k)].clone();
                b[(row, k)] -= eliminated;
            }
        }
    }
    DMatrix::from_fn(b.nrows(), b.ncols(), |i, k| b[(i, k)].clone() / a[(i, i)].clone())
}

// One linear filter, exactly

#[test]
fn smoothed_estimates_are_the_joint_gaussian_given_all_measurements() {
    let problem = linear();
    assert_eq!(problem.smoothed(), problem.batch(4));
    // The last is the filter's, which is the joint Gaussian too; the others are not.
    let filtered: Vec<_> = problem.filtered().into_iter().map(|step| step.updated).collect();
    for (k, updated) in (1..).zip(&filtered) {
        assert_eq!(*updated, problem.batch(k)[k], "the filter at step {k}");
        assert_eq!(*updated == problem.smoothed()[k], k == 4, "step {k}");
    }
}

/// The smoothed states make the sum of squares of start, noises and measurements the least: its slope is zero at them, state by state.
#[test]
fn smoothed_means_are_the_solution_of_least_squares() {
    let problem = linear();
    let slopes = |states: &[Vector2<Rational>]| {
        let weighed = |covariance: &Matrix2<Rational>, error: Vector2<Rational>| {
            let dynamic = |rows: usize, columns: usize, of: &[Rational]| DMatrix::from_column_slice(rows, columns, of);
            let solution = solved(&dynamic(2, 2, covariance.as_slice()), &dynamic(2, 1, error.as_slice()));
            Vector2::new(solution[0].clone(), solution[1].clone())
        };
        let mut slopes = vec![Vector2::<Rational>::zeros(); states.len()];
        slopes[0] += weighed(&problem.start.covariance, &states[0] - &problem.start.mean);
        for (k, (f, q)) in problem.motions.iter().enumerate() {
            let pull = weighed(q, &states[k + 1] - f * &states[k]);
            slopes[k] -= f.transpose() * &pull;
            slopes[k + 1] += pull;
            if let Some(z) = &problem.measurements[k] {
                let error = (Vector1::new(z.clone()) - &problem.h * &states[k + 1]) / problem.r[0].clone();
                slopes[k + 1] -= problem.h.transpose() * error;
            }
        }
        slopes
    };
    let mut states: Vec<_> = problem.smoothed().into_iter().map(|estimate| estimate.mean).collect();
    assert!(slopes(&states).iter().all(|slope| *slope == Vector2::zeros()));
    states[2][0] += ratio(1, 1_000_000);
    assert!(!slopes(&states).iter().all(|slope| *slope == Vector2::zeros()));
}

#[test]
fn a_smoothed_covariance_is_at_most_the_updated_one() {
    let problem = linear();
    let (smoothed, filtered) = (problem.smoothed(), problem.filtered());
    for k in 0..=4 {
        let updated = if k == 0 {
            &problem.start
        } else {
            &filtered[k - 1].updated
        };
        let difference = &updated.covariance - &smoothed[k].covariance;
        assert!(is_positive_semidefinite(&difference), "step {k}");
        // Two later measurements see both components.
        assert_eq!(is_positive_definite(&difference), k <= 2, "step {k}");
    }
}

/// In coordinates y = T x + t everything is another, and the smoothed states are the same ones.
#[test]
fn smoothing_and_a_change_of_coordinates_commute() {
    let problem = linear();
    let (turn, shift) = (
        matrix_of::<Rational, 2, 2>([[2, 1], [-1, 3]]),
        vector![ratio(4, 3), ratio(-2, 1)],
    );
    let back = matrix_of::<Rational, 2, 2>([[3, -1], [1, 2]]) / ratio(7, 1);
    let turned = |estimate: &Gaussian<Rational, U2>| Gaussian {
        mean: &turn * &estimate.mean + &shift,
        covariance: &turn * &estimate.covariance * turn.transpose(),
    };
    let steps = problem.filtered();
    let mut after = turned(&steps[3].updated);
    for k in (0..4).rev() {
        let updated = if k == 0 { &problem.start } else { &steps[k - 1].updated };
        let (f, q) = &problem.motions[k];
        let of_motion = &turn * f * &back;
        // f(y) = T F T⁻¹ (y − t) + t, and the matrices that belong to it.
        let (updated, predicted) = (turned(updated), turned(&steps[k].predicted));
        let noise = &turn * q * turn.transpose();
        assert_eq!(
            kalman::predicted_covariance(&of_motion, &updated.covariance, &noise),
            predicted.covariance
        );
        let cross_covariance = kalman::cross_covariance(&updated.covariance, &of_motion);
        after = one_step_back(&updated, &predicted, &cross_covariance, &after);
        assert_eq!(after, turned(&problem.smoothed()[k]), "step {k}");
    }
}

#[test]
fn points_of_a_linear_motion_have_the_cross_covariance_of_its_matrix() {
    let root: Matrix2<Surd> = matrix_of([[2, 0], [1, 3]]);
    let covariance = &root * root.transpose();
    let (mean, f) = (
        vector![Surd::ratio(1, 3), Surd::integer(-2)],
        matrix_of([[1, 2], [-1, 5]]),
    );
    let mut rules: Vec<_> = [RuleName::ThirdDegree, RuleName::FifthDegree, RuleName::Simplex]
        .iter()
        .map(|name| name.exact(2).unwrap())
        .collect();
    rules.push(
        unscented(
            2,
            &Parameters {
                alpha: ratio(1, 3),
                beta: ratio(2, 1),
                kappa: ratio(1, 2),
            },
        )
        .unwrap(),
    );
    for exact in rules {
        let rule = Rule::<Surd, U2>::from_exact(&exact).unwrap();
        let points: Vec<_> = rule.points.iter().map(|xi| cubature::point(&root, xi, &mean)).collect();
        let moved: Vec<_> = points
            .iter()
            .map(|point| cubature::propagated_point(&f, point))
            .collect();
        let predicted = &f * &mean;
        let found = cubature::motion_cross_covariance(&rule.covariance_weights, &points, &mean, &moved, &predicted);
        assert_eq!(found, kalman::cross_covariance(&covariance, &f));
        // Rows are entries of the state before.
        assert_ne!(found, kalman::cross_covariance(&covariance, &f).transpose());
    }
}

// Recorded runs

/// The bits of enclosures: the runs here lose a few dozen.
const BITS: u32 = 200;

fn enclosed<const R: usize, const C: usize>(matrix: &SMatrix<Rational, R, C>) -> SMatrix<Enclosure, R, C> {
    matrix.map(|entry| Enclosure::rational(&entry))
}

fn enclosed_estimate<const N: usize>(
    of: &Gaussian<Rational, nalgebra::Const<N>>,
) -> Gaussian<Enclosure, nalgebra::Const<N>> {
    Gaussian {
        mean: enclosed(&of.mean),
        covariance: enclosed(&of.covariance),
    }
}

/// The linear problem at a step, with a filter.
fn problem_at(linear: &Linear, k: usize, filter: &Filter<Enclosure, U2, U1>) -> Problem<Enclosure, U2, U1> {
    let (f, q) = &linear.motions[k];
    Problem {
        modes: vec![Mode {
            name: "one".into(),
            motion: Motion::Linear(enclosed(f)),
            noise: enclosed(q),
        }],
        filters: vec![filter.clone()],
        interaction: Interaction::Imm,
        angles: vec![],
        chain: vec![vec![Enclosure::integer(1)]],
        sensor: Sensor::Linear(enclosed(&linear.h)),
        measurement_noise: enclosed(&linear.r),
    }
}

/// That an estimate contains fractions, and hardly anything else.
fn assert_contains<const N: usize>(
    found: &Gaussian<Enclosure, nalgebra::Const<N>>,
    exact: &Gaussian<Rational, nalgebra::Const<N>>,
    at: &str,
) {
    let pairs = found.mean.iter().zip(exact.mean.iter());
    for (found, exact) in pairs.chain(found.covariance.iter().zip(exact.covariance.iter())) {
        assert!(found.contains(exact), "{at}: {found:?} and {}", exact.to_f64());
        assert!(found.width() < 1e-30, "{at}: {}", found.width());
    }
}

/// Every kind of filter that is exact on a linear problem.
fn kinds() -> Vec<(&'static str, Filter<Enclosure, U2, U1>)> {
    let third = Filter::points(RuleName::ThirdDegree.rule().unwrap());
    let fifth = Transform::Points(RuleName::FifthDegree.rule().unwrap());
    let points_of_the_motion = Filter {
        predict: fifth,
        ..Filter::kalman()
    };
    vec![
        ("Kalman", Filter::kalman()),
        ("extended", Filter::extended()),
        ("cubature", third),
        ("points of the motion alone", points_of_the_motion),
    ]
}

#[test]
fn a_recorded_run_is_smoothed_by_these_equations() {
    let linear = linear();
    Enclosure::with_precision(BITS, || {
        for (name, kind) in kinds() {
            let initial = Initial {
                modes: vec![enclosed_estimate(&linear.start)],
                mode_probabilities: vec![Enclosure::integer(1)],
            };
            let mut filter = Imm::new(problem_at(&linear, 0, &kind), &initial).unwrap();
            let mut run = Recording::new(&filter).unwrap();
            for k in 0..4 {
                filter.change(problem_at(&linear, k, &kind)).unwrap();
                let z = linear.measurements[k]
                    .as_ref()
                    .map(|z| Vector1::new(Enclosure::rational(z)));
                filter.step(z.as_ref()).unwrap();
                run.record(&filter).unwrap();
                // A fixed lag: the state some steps ago, given what was measured so far.
                for lag in 0..=k + 1 {
                    let found = run.fixed_lag(lag).unwrap();
                    let at = format!("{name}, step {} of {}", k + 1 - lag, k + 1);
                    assert_eq!(found.step, k + 1 - lag);
                    assert_contains(&found.combined, &linear.batch(k + 1)[k + 1 - lag], &at);
                }
            }
            let smoothed = run.fixed_interval().unwrap();
            for (k, exact) in linear.batch(4).iter().enumerate() {
                assert_contains(&smoothed[k].combined, exact, &format!("{name}, step {k}"));
                assert_contains(&smoothed[k].modes[0], exact, &format!("{name}, step {k}"));
            }
        }
    });
}

// Several modes

/// Two or three modes of two components of which one is measured.
struct Switching {
    start: Vec<Gaussian<Rational, U2>>,
    probabilities: Vec<Rational>,
    chain: Vec<Vec<Rational>>,
    motions: Vec<(Matrix2<Rational>, Matrix2<Rational>)>,
    measurements: Vec<Option<Rational>>,
}

const LASTING: [[(i64, i64); 3]; 3] = [
    [(3, 4), (1, 4), (0, 1)],
    [(1, 8), (5, 8), (1, 4)],
    [(1, 3), (1, 6), (1, 2)],
];

/// Three modes that differ in everything, the third of three measurements missing.
fn switching() -> Switching {
    let at = |x: i64, v: i64, covariance| Gaussian {
        mean: vector![ratio(x, 2), ratio(v, 3)],
        covariance: matrix_of(covariance),
    };
    Switching {
        start: vec![
            at(1, 2, [[5, 1], [1, 4]]),
            at(-3, 1, [[3, -1], [-1, 2]]),
            at(2, -4, [[6, 2], [2, 5]]),
        ],
        probabilities: vec![ratio(1, 2), ratio(1, 3), ratio(1, 6)],
        chain: LASTING
            .iter()
            .map(|row| row.iter().map(|&(p, q)| ratio(p, q)).collect())
            .collect(),
        motions: vec![
            (matrix_of([[1, 1], [0, 1]]), matrix_of([[2, 1], [1, 3]])),
            (matrix_of([[1, 2], [-1, 1]]), matrix_of([[3, -1], [-1, 1]])),
            (matrix_of([[1, 0], [0, 1]]), matrix_of([[9, 0], [0, 4]])),
        ],
        measurements: vec![Some(ratio(4, 1)), Some(ratio(-5, 2)), None, Some(ratio(7, 1))],
    }
}

const FORMS: [SwitchingSmoother; 2] = [SwitchingSmoother::ExpectationCorrection, SwitchingSmoother::Kim];
const H: [[i64; 2]; 1] = [[2, -1]];
const R: i64 = 3;

impl Switching {
    fn modes(&self) -> usize {
        self.start.len()
    }

    fn problem(&self) -> Problem<Enclosure, U2, U1> {
        let mode = |(j, (f, q)): (usize, &(Matrix2<Rational>, Matrix2<Rational>))| Mode {
            name: format!("mode {j}"),
            motion: Motion::Linear(enclosed(f)),
            noise: enclosed(q),
        };
        Problem {
            modes: self.motions.iter().enumerate().map(mode).collect(),
            filters: vec![Filter::kalman()],
            interaction: Interaction::Imm,
            angles: vec![],
            chain: self
                .chain
                .iter()
                .map(|row| row.iter().map(Enclosure::rational).collect())
                .collect(),
            sensor: Sensor::Linear(matrix_of(H)),
            measurement_noise: matrix_of([[R]]),
        }
    }

    /// The recording of the whole run, and the filter at its end.
    fn recorded(&self) -> (Recording<Enclosure, U2>, Imm<Enclosure, U2, U1>) {
        let initial = Initial {
            modes: self.start.iter().map(enclosed_estimate).collect(),
            mode_probabilities: self.probabilities.iter().map(Enclosure::rational).collect(),
        };
        let mut filter = Imm::new(self.problem(), &initial).unwrap();
        let mut run = Recording::new(&filter).unwrap();
        for z in &self.measurements {
            let z = z.as_ref().map(|z| Vector1::new(Enclosure::rational(z)));
            filter.step(z.as_ref()).unwrap();
            run.record(&filter).unwrap();
        }
        (run, filter)
    }

    fn smoothed(&self, form: SwitchingSmoother) -> Vec<SmoothedStep<Enclosure, U2>> {
        self.recorded().0.by(form).fixed_interval().unwrap()
    }

    /// One of the modes by itself.
    fn alone(&self, j: usize) -> Self {
        Self {
            start: vec![self.start[j].clone()],
            probabilities: vec![ratio(1, 1)],
            chain: vec![vec![ratio(1, 1)]],
            motions: vec![self.motions[j].clone()],
            measurements: self.measurements.clone(),
        }
    }
}

/// That two enclosures are of one number, as far as they know it.
fn assert_one(a: &Enclosure, b: &Enclosure, at: &str) {
    let difference = a.clone() - b.clone();
    assert!(difference.contains(&ratio(0, 1)), "{at}: {a:?} and {b:?}");
    assert!(difference.width() < 1e-20, "{at}: {}", difference.width());
}

fn assert_one_estimate(a: &Gaussian<Enclosure, U2>, b: &Gaussian<Enclosure, U2>, at: &str) {
    let means = a.mean.iter().zip(b.mean.iter());
    for (a, b) in means.chain(a.covariance.iter().zip(b.covariance.iter())) {
        assert_one(a, b, at);
    }
}

/// The mixture as one Gaussian, by the weights' own sum.
fn merged(parts: &[(Enclosure, Gaussian<Enclosure, U2>)]) -> (Enclosure, Gaussian<Enclosure, U2>) {
    let total = parts
        .iter()
        .fold(Enclosure::integer(0), |sum, (weight, _)| sum + weight.clone());
    let weights: Vec<_> = parts.iter().map(|(weight, _)| weight.clone() / total.clone()).collect();
    let components: Vec<_> = parts.iter().map(|(_, component)| component.clone()).collect();
    let mean = mixture_mean(&weights, &components);
    let covariance = mixture_covariance(&weights, &components, &mean);
    (total, Gaussian { mean, covariance })
}

/// A target whose mode is known at first, one step later: all that can be is mode j after the known one, and the sum over j is Bayes' rule.
#[test]
fn one_step_back_to_a_known_mode_is_the_posterior_of_bayes() {
    let mut scene = switching();
    scene.measurements.truncate(1);
    scene.probabilities = vec![ratio(0, 1), ratio(1, 1), ratio(0, 1)];
    let start = &scene.start[1];
    let z = scene.measurements[0].clone().unwrap();
    Enclosure::with_precision(BITS, || {
        let of_mode = |j: usize| {
            let (f, q) = &scene.motions[j];
            // What z says about the state before: H F x + H w + v.
            let seen = matrix_of::<Rational, 1, 2>(H) * f;
            let noise =
                matrix_of::<Rational, 1, 2>(H) * q * matrix_of::<Rational, 1, 2>(H).transpose() + matrix_of([[R]]);
            let s = kalman::innovation_covariance(&seen, &start.covariance, &noise);
            let gain = update::gain(&kalman::cross_covariance(&start.covariance, &seen), &ldl(&s));
            let innovation = Vector1::new(z.clone()) - &seen * &start.mean;
            let estimate = Gaussian {
                mean: update::updated_mean(&start.mean, &gain, &innovation),
                covariance: update::updated_covariance(&start.covariance, &gain, &s),
            };
            let likelihood = log_density(&enclosed(&innovation), &ldl(&enclosed(&s))).exp();
            (
                Enclosure::rational(&scene.chain[1][j]) * likelihood,
                enclosed_estimate(&estimate),
            )
        };
        let (_, expected) = merged(&[0, 1, 2].map(of_mode));
        for form in FORMS {
            let smoothed = &scene.smoothed(form)[0];
            assert_one_estimate(&smoothed.modes[1], &expected, "the known mode");
            assert_one_estimate(&smoothed.combined, &expected, "combined");
            assert_one(
                &smoothed.mode_probabilities[1],
                &Enclosure::integer(1),
                "its probability",
            );
            // A mode that was not there keeps its own estimate.
            assert_contains(&smoothed.modes[0], &scene.start[0], "another mode");
        }
    });
}

/// From a mode that is not known it is an approximation, and shows: nothing is measured, and the modes before move all the same.
#[test]
fn a_step_without_a_detection_moves_the_modes_before_it_a_little() {
    let mut scene = switching();
    scene.measurements = vec![None];
    Enclosure::with_precision(BITS, || {
        for form in FORMS {
            let smoothed = &scene.smoothed(form)[0];
            let shift = (smoothed.modes[0].mean[0].clone() - Enclosure::rational(&scene.start[0].mean[0])).magnitude();
            assert!((0.01..1.0).contains(&shift), "{form:?}: {shift}");
        }
        // By the chain alone the probabilities are right.
        let by_chain = &scene.smoothed(SwitchingSmoother::Kim)[0];
        for (found, exact) in by_chain.mode_probabilities.iter().zip(&scene.probabilities) {
            assert!(found.contains(exact));
        }
    });
}

#[test]
fn modes_that_never_change_are_smoothed_each_by_itself() {
    let mut scene = switching();
    scene.chain = (0..3)
        .map(|i| (0..3).map(|j| ratio(i64::from(i == j), 1)).collect())
        .collect();
    Enclosure::with_precision(BITS, || {
        let smoothed = FORMS.map(|form| scene.smoothed(form));
        let mut weights = Vec::new();
        for j in 0..3 {
            let (alone, filter) = scene.alone(j).recorded();
            for (k, step) in alone.fixed_interval().unwrap().iter().enumerate() {
                for smoothed in &smoothed {
                    assert_one_estimate(&smoothed[k].modes[j], &step.combined, &format!("mode {j}, step {k}"));
                }
            }
            // The likelihood of the run, step by step.
            let mut log_likelihood = Enclosure::integer(0);
            let mut again = Imm::new(
                filter.problem().clone(),
                &Initial {
                    modes: vec![enclosed_estimate(&scene.start[j])],
                    mode_probabilities: vec![Enclosure::integer(1)],
                },
            )
            .unwrap();
            for z in &scene.measurements {
                let z = z.as_ref().map(|z| Vector1::new(Enclosure::rational(z)));
                log_likelihood += again.step(z.as_ref()).unwrap().log_evidence.clone();
            }
            weights.push(Enclosure::rational(&scene.probabilities[j]) * log_likelihood.exp());
        }
        let total = weights
            .iter()
            .fold(Enclosure::integer(0), |sum, weight| sum + weight.clone());
        for (k, step) in smoothed.iter().flat_map(|steps| steps.iter().enumerate()) {
            for (j, weight) in weights.iter().enumerate() {
                let expected = weight.clone() / total.clone();
                assert_one(&step.mode_probabilities[j], &expected, &format!("mode {j}, step {k}"));
            }
        }
    });
}

/// Where all modes are the same, the measurements say nothing about them, and their probabilities follow the chain from the start.
#[test]
fn identical_modes_are_one_smoother_and_the_chain() {
    let mut scene = switching();
    scene.start = vec![scene.start[0].clone(); 3];
    scene.motions = vec![scene.motions[0].clone(); 3];
    Enclosure::with_precision(BITS, || {
        for form in FORMS {
            let mut probabilities = scene.probabilities.clone();
            let alone = scene.alone(0).smoothed(form);
            for (k, step) in scene.smoothed(form).iter().enumerate() {
                let at = format!("{form:?}, step {k}");
                assert_one_estimate(&step.combined, &alone[k].combined, &at);
                for (j, probability) in probabilities.iter().enumerate() {
                    assert_one_estimate(&step.modes[j], &alone[k].combined, &at);
                    assert!(step.mode_probabilities[j].contains(probability), "{at}");
                }
                let of_mode = |j| predicted_mode_probability(&scene.chain, &probabilities, j);
                probabilities = (0..3).map(of_mode).collect();
            }
        }
    });
}

/// Modes of a state that is known are a hidden Markov chain: P(i at k ∣ all) is the sum over all sequences of modes.
#[test]
fn the_chain_read_backward_is_the_sum_over_all_sequences() {
    let scene = switching();
    let likelihoods = [
        [(1, 7), (3, 5), (2, 9)],
        [(4, 3), (1, 8), (5, 6)],
        [(2, 11), (3, 10), (7, 4)],
    ]
    .map(|step| step.map(|(numerator, denominator)| ratio(numerator, denominator)));
    // Forward.
    let (mut filtered, mut predicted) = (vec![scene.probabilities.clone()], Vec::new());
    for of_step in &likelihoods {
        let before = filtered.last().unwrap();
        let c: Vec<_> = (0..3)
            .map(|j| predicted_mode_probability(&scene.chain, before, j))
            .collect();
        let sum = evidence(of_step, &c);
        filtered.push((0..3).map(|j| mode_probability(&of_step[j], &c[j], &sum)).collect());
        predicted.push(c);
    }
    // Back.
    let mut smoothed = vec![filtered[3].clone()];
    for k in (0..3).rev() {
        let after = smoothed.last().unwrap();
        let of_mode = |i| {
            let of_pair = |j: usize| {
                let mixing = mixing_probability(&scene.chain, &filtered[k], &predicted[k][j], i, j);
                pair_probability(&mixing, &after[j])
            };
            (0..3).fold(ratio(0, 1), |sum, j| sum + of_pair(j))
        };
        smoothed.push((0..3).map(of_mode).collect());
    }
    smoothed.reverse();
    // All sequences.
    let mut sums = vec![vec![ratio(0, 1); 3]; 4];
    for sequence in 0..81_usize {
        let modes = [sequence / 27, sequence / 9 % 3, sequence / 3 % 3, sequence % 3];
        let mut weight = scene.probabilities[modes[0]].clone();
        for k in 0..3 {
            weight *= scene.chain[modes[k]][modes[k + 1]].clone() * likelihoods[k][modes[k + 1]].clone();
        }
        for k in 0..4 {
            sums[k][modes[k]] += weight.clone();
        }
    }
    for (sums, smoothed) in sums.iter().zip(&smoothed) {
        let total = sums[0].clone() + sums[1].clone() + sums[2].clone();
        for (sum, smoothed) in sums.iter().zip(smoothed) {
            assert_eq!(sum.clone() / total.clone(), *smoothed);
        }
    }
}

#[test]
fn permuting_the_modes_permutes_the_smoothed_ones() {
    let scene = switching();
    let order = [2, 0, 1];
    let permuted = Switching {
        start: order.map(|j| scene.start[j].clone()).to_vec(),
        probabilities: order.map(|j| scene.probabilities[j].clone()).to_vec(),
        chain: order
            .map(|i| order.map(|j| scene.chain[i][j].clone()).to_vec())
            .to_vec(),
        motions: order.map(|j| scene.motions[j].clone()).to_vec(),
        measurements: scene.measurements.clone(),
    };
    Enclosure::with_precision(BITS, || {
        let both = FORMS.map(|form| (scene.smoothed(form), permuted.smoothed(form)));
        for (k, (step, other)) in both
            .iter()
            .flat_map(|(plain, permuted)| plain.iter().zip(permuted).enumerate())
        {
            assert_one_estimate(&step.combined, &other.combined, &format!("step {k}"));
            for (place, &j) in order.iter().enumerate() {
                assert_one(
                    &step.mode_probabilities[j],
                    &other.mode_probabilities[place],
                    &format!("mode {j}, step {k}"),
                );
                assert_one_estimate(&step.modes[j], &other.modes[place], &format!("mode {j}, step {k}"));
            }
        }
    });
}

#[test]
fn a_lag_of_the_whole_run_is_the_fixed_interval() {
    let scene = switching();
    Enclosure::with_precision(BITS, || {
        let (mut run, filter) = scene.recorded();
        let smoothed = run.fixed_interval().unwrap();
        let updated = filter.current();
        assert_eq!(run.recorded(), 4);
        for (k, step) in smoothed.iter().enumerate() {
            let found = run.fixed_lag(4 - k).unwrap();
            assert_eq!(found.step, k);
            assert_one_estimate(&found.combined, &step.combined, &format!("step {k}"));
        }
        for j in 0..scene.modes() {
            assert_one(
                &smoothed[4].mode_probabilities[j],
                &updated.mode_probabilities[j],
                "the filter's own",
            );
            assert_one_estimate(&smoothed[4].modes[j], &updated.updated[j], "the filter's own");
        }
        assert_one_estimate(&smoothed[4].combined, &updated.combined, "the filter's own");
        // What is forgotten is not needed for a shorter lag.
        run.keep(2);
        assert_eq!(run.recorded(), 2);
        assert_one_estimate(&run.fixed_lag(2).unwrap().combined, &smoothed[2].combined, "kept");
        assert_eq!(run.fixed_lag(3).unwrap_err(), Unsmoothable::Lag { lag: 3, recorded: 2 });
    });
}

// Angles

/// A problem, its initial estimates, and what is measured.
type Scene = (Problem<f64, U3, U2>, Initial<f64, U3>, Vec<Vector2<f64>>);

/// A target that turns about the origin, seen from there, in a scene that is turned by an angle: state x, y and heading.
fn turned_scene(angle: f64) -> Scene {
    let mode = |name: &str, rate: &str, noise: f64| Mode {
        name: name.into(),
        motion: Motion::Function {
            function: Function::of_formulas(
                &["x", "y", "psi"],
                &[],
                &[],
                &[],
                &[
                    ("x", "x + 5*cos(psi)"),
                    ("y", "y + 5*sin(psi)"),
                    ("psi", &format!("psi + {rate}")),
                ],
            )
            .unwrap()
            .into(),
            given: vec![],
        },
        noise: matrix![1.0, 0.0, 0.0; 0.0, 1.0, 0.0; 0.0, 0.0, noise],
    };
    let problem = Problem {
        modes: vec![mode("straight", "0", 0.01), mode("turn", "1/4", 0.05)],
        filters: vec![Filter::extended()],
        interaction: Interaction::Imm,
        angles: vec![2],
        chain: vec![vec![0.875, 0.125], vec![0.25, 0.75]],
        sensor: Sensor::Polar {
            components: vec![PolarComponent::Range, PolarComponent::Bearing],
            position: [0, 1],
            location: [0.0, 0.0],
        },
        measurement_noise: matrix![4.0, 0.0; 0.0, 0.01],
    };
    let turn = matrix![angle.cos(), -angle.sin(), 0.0; angle.sin(), angle.cos(), 0.0; 0.0, 0.0, 1.0];
    let start = |heading: f64| {
        let mean: Vector3<f64> = turn * vector![30.0, -5.0, heading] + vector![0.0, 0.0, angle];
        let covariance = turn * matrix![9.0, 1.0, 0.0; 1.0, 4.0, 0.25; 0.0, 0.25, 0.25] * turn.transpose();
        Gaussian {
            mean,
            covariance: (covariance + covariance.transpose()) / 2.0,
        }
    };
    let initial = Initial {
        modes: vec![start(1.25), start(1.75)],
        mode_probabilities: vec![0.5, 0.5],
    };
    let wrapped = |bearing: f64| Real::atan2(&bearing.sin(), &bearing.cos());
    let seen = [[30.5, 0.03], [29.0, 0.21], [28.0, 0.4], [27.5, 0.63]];
    (
        problem,
        initial,
        seen.map(|[range, bearing]| vector![range, wrapped(bearing + angle)])
            .to_vec(),
    )
}

#[test]
fn turning_a_scene_turns_its_smoothed_states() {
    let smoothed = |angle: f64| {
        let (problem, initial, measurements) = turned_scene(angle);
        let mut filter = Imm::new(problem, &initial).unwrap();
        let mut run = Recording::new(&filter).unwrap();
        for z in &measurements {
            filter.step(Some(z)).unwrap();
            run.record(&filter).unwrap();
        }
        run.fixed_interval().unwrap()
    };
    let plain = smoothed(0.0);
    // Headings of 1 to 2.5 rad go across the cut for turns of 1 to 2, and the bearings for turns above 2.5.
    for angle in [0.5, 1.25, 1.75, 2.75, -2.0] {
        let turn = matrix![angle.cos(), -angle.sin(), 0.0; angle.sin(), angle.cos(), 0.0; 0.0, 0.0, 1.0];
        for (k, (plain, turned)) in plain.iter().zip(&smoothed(angle)).enumerate() {
            let mut estimates = vec![(&plain.combined, &turned.combined)];
            estimates.extend(plain.modes.iter().zip(&turned.modes));
            for (plain, turned) in estimates {
                let mut difference = turned.mean - (turn * plain.mean + vector![0.0, 0.0, angle]);
                difference[2] = Real::atan2(&difference[2].sin(), &difference[2].cos());
                let spread = turned.covariance - turn * plain.covariance * turn.transpose();
                // Roundings of some hundred operations on numbers of 30.
                assert!(
                    difference.norm() < 1e-11 && spread.norm() < 1e-10,
                    "{angle}, step {k}: {difference}{spread}"
                );
                assert!(turned.mean[2].abs() <= std::f64::consts::PI);
            }
        }
    }
}

// Targets that switch

/// A named generator, SplitMix64, whose numbers are the same everywhere.
struct Draw(u64);

impl Draw {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
        ((bits >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
    }

    /// By Box and Muller.
    fn normal(&mut self) -> f64 {
        let radius = Real::sqrt(&(-2.0 * Real::ln(&self.uniform())));
        radius * Real::cos(&(std::f64::consts::TAU * self.uniform()))
    }
}

/// The mean and the standard error of differences.
fn mean_and_error(differences: &[f64]) -> (f64, f64) {
    let n = differences.len() as f64;
    let mean = differences.iter().sum::<f64>() / n;
    let square = differences
        .iter()
        .map(|difference| (difference - mean) * (difference - mean))
        .sum::<f64>();
    (mean, Real::sqrt(&(square / (n - 1.0) / n)))
}

/// What the smoothers take away from the squared error of the position, run by run, for two modes with these noises of acceleration.
fn lessened(noises: [f64; 2], stay: f64, runs: usize) -> [Vec<f64>; 2] {
    let f = matrix![1.0, 1.0; 0.0, 1.0];
    let root = |q: f64| matrix![0.5, 0.05; 1.0, 0.0] * Real::sqrt(&q);
    let mode = |q: f64| Mode {
        name: format!("{q}"),
        motion: Motion::Linear(f),
        noise: root(q) * root(q).transpose(),
    };
    let problem = Problem::<f64, U2, U1> {
        modes: noises.map(mode).to_vec(),
        filters: vec![Filter::kalman()],
        interaction: Interaction::Imm,
        angles: vec![],
        chain: vec![vec![stay, 1.0 - stay], vec![1.0 - stay, stay]],
        sensor: Sensor::Linear(matrix![1.0, 0.0]),
        measurement_noise: matrix![1.0],
    };
    let start = Gaussian {
        mean: vector![0.0, 0.0],
        covariance: Matrix2::identity(),
    };
    let initial = Initial {
        modes: vec![start; 2],
        mode_probabilities: vec![0.5, 0.5],
    };
    let mut draw = Draw(7);
    let mut differences = [Vec::new(), Vec::new()];
    for _ in 0..runs {
        let mut filter = Imm::new(problem.clone(), &initial).unwrap();
        let mut run = Recording::new(&filter).unwrap();
        let mut mode = usize::from(draw.uniform() < 0.5);
        let mut state = vector![draw.normal(), draw.normal()];
        let (mut truth, mut filtered) = (Vec::new(), Vec::new());
        for _ in 0..50 {
            mode = if draw.uniform() < stay { mode } else { 1 - mode };
            state = f * state + root(noises[mode]) * vector![draw.normal(), draw.normal()];
            filter.step(Some(&Vector1::new(state[0] + draw.normal()))).unwrap();
            run.record(&filter).unwrap();
            truth.push(state[0]);
            filtered.push(filter.current().combined.mean[0]);
        }
        for (form, differences) in FORMS.into_iter().zip(&mut differences) {
            run = run.by(form);
            let smoothed = run.fixed_interval().unwrap();
            let square = |x: f64, truth: f64| (x - truth) * (x - truth);
            let of_step = |k: usize| square(filtered[k], truth[k]) - square(smoothed[k + 1].combined.mean[0], truth[k]);
            differences.push((0..50).map(of_step).sum::<f64>() / 50.0);
        }
    }
    differences
}

#[test]
fn smoothing_lessens_the_error_of_a_target_that_switches() {
    // Modes that are not far apart: both smoothers halve the squared error, which is below the measurement's, 1.
    for differences in lessened([1.0, 2.0], 0.9, 40) {
        let (mean, error) = mean_and_error(&differences);
        assert!(mean > 0.3 && mean > 5.0 * error, "{mean} ± {error}");
    }
    // A mode with hardly any noise: expectation correction still does, and the chain alone makes it worse than no smoothing.
    let [corrected, by_chain] = lessened([1e-4, 10.0], 0.9, 150).map(|differences| mean_and_error(&differences));
    assert!(corrected.0 > 5.0 * corrected.1, "{corrected:?}");
    assert!(by_chain.0 < -5.0 * by_chain.1, "{by_chain:?}");
}

// What is refused

/// Positions at which two filters of one component are, and the sentence of a run that cannot be smoothed.
fn sentence(change: impl FnOnce(&mut Problem<f64, U2, U1>)) -> String {
    let mode = |name: &str| Mode {
        name: name.into(),
        motion: Motion::Linear(matrix![1.0, 1.0; 0.0, 1.0]),
        noise: Matrix2::identity(),
    };
    let mut problem = Problem {
        modes: vec![mode("quiet"), mode("loud")],
        filters: vec![Filter::kalman()],
        interaction: Interaction::Imm,
        angles: vec![],
        chain: vec![vec![0.5, 0.5], vec![0.5, 0.5]],
        sensor: Sensor::Linear(matrix![1.0, 0.0]),
        measurement_noise: matrix![1.0],
    };
    change(&mut problem);
    let has_covariances = problem.has_covariances();
    let covariance = if has_covariances {
        Matrix2::identity()
    } else {
        Matrix2::zeros()
    };
    let start = Gaussian {
        mean: vector![0.0, 0.0],
        covariance,
    };
    let initial = Initial {
        modes: vec![start; 2],
        mode_probabilities: vec![0.5, 0.5],
    };
    let mut filter = Imm::new(problem, &initial).unwrap();
    let smoothed = Recording::new(&filter).and_then(|mut run| {
        for _ in 0..2 {
            filter.step(Some(&Vector1::new(1.0))).unwrap();
            run.record(&filter)?;
        }
        run.fixed_interval()
    });
    smoothed.unwrap_err().to_string()
}

#[test]
fn a_run_that_cannot_be_smoothed_says_where_and_what_to_do() {
    let singular = sentence(|problem| {
        let motion = matrix![1.0, 0.0; 0.0, 0.0];
        problem.modes[1].motion = Motion::Linear(motion);
        problem.modes[1].noise = motion;
    });
    let expected = "step 2, mode `loud`: the predicted covariance is not positive definite: pivot 2 of 2 is not positive; give that \
                    entry of the state process noise, or leave it out of the state";
    assert_eq!(singular, expected);
    let given = sentence(|problem| {
        let gain = FixedGain {
            gain: matrix![0.5; 0.25],
            innovation_covariance: matrix![2.0],
        };
        problem.filters = vec![Filter::given(gain)];
    });
    assert_eq!(
        given,
        "`filters` gives gains, and a smoother needs covariances; use filters that compute their gain"
    );
    let correlated = sentence(|problem| {
        problem.filters = vec![
            Filter::kalman(),
            Filter::kalman().with_noise_cross_covariance(matrix![0.5; 0.0]),
        ];
    });
    assert!(
        correlated.starts_with("mode `loud` has a `noise_cross_covariance`; "),
        "{correlated}"
    );
    let own_states = sentence(|problem| {
        let one = |from, to| StateConversion {
            from,
            to,
            map: Motion::Linear(Matrix2::identity()),
            added: Matrix2::zeros(),
        };
        let list = vec![one(0, Reader::Mode(1)), one(1, Reader::Mode(0))];
        let angles = vec![vec![], vec![]];
        problem.interaction = Interaction::Converted(StateConversions { list, angles });
    });
    assert!(
        own_states.starts_with("`conversions` give modes states of their own"),
        "{own_states}"
    );
}

#[test]
fn steps_are_recorded_once_each_and_a_lag_ends_with_the_run() {
    let linear = linear();
    Enclosure::with_precision(BITS, || {
        let initial = Initial {
            modes: vec![enclosed_estimate(&linear.start)],
            mode_probabilities: vec![Enclosure::integer(1)],
        };
        let mut filter = Imm::new(problem_at(&linear, 0, &Filter::kalman()), &initial).unwrap();
        let mut run = Recording::new(&filter).unwrap();
        assert_eq!(
            run.record(&filter),
            Err(Unsmoothable::OtherStep { expected: 1, found: 0 })
        );
        filter.step(None).unwrap();
        run.record(&filter).unwrap();
        let sentence = "the filter has another number of modes or components than the one that was recorded; begin a new recording";
        assert_eq!(run.record(&switching().recorded().1).unwrap_err().to_string(), sentence);
        filter.step(None).unwrap();
        filter.step(None).unwrap();
        let sentence = "step 3 is recorded where step 2 comes next; record every step once, as soon as it is made";
        assert_eq!(run.record(&filter).unwrap_err().to_string(), sentence);
        let sentence = "a lag of 2 is longer than the recorded run; ask for a lag of at most 1";
        assert_eq!(run.fixed_lag(2).unwrap_err().to_string(), sentence);
    });
}
