//! The claims of derbez2000 on stability and boundedness, decided by proofs and instances.
//!
//! It shows which statements of the paper are proven, which are refuted, and under which hypotheses each refuted one becomes true.
//! Everything computed here is exact or enclosed; where something was only searched for, the evidence says so.

use super::instances::{
    copies_apart, distances_of_two_copies, gain_after_a_jump, growing_filter, growing_mixture, is_locally_unstable,
    locked_errors, mixed_covariances,
};
use crate::number::{Field, Rational, RationalFunction};
use crate::paper::specification::Specification;
use crate::paper::verdict::{JudgedClaim, proven_by, refuted_by};
use crate::statistics::estimate::figure;
use crate::steady::certificate::{Product, Quadratics};
use crate::steady::map::Map;
use crate::steady::pair::{acceleration_matrix, frozen_matrix, remark_1_matrix, velocity_matrix};
use crate::steady::polynomial::{MatrixRows, characteristic_polynomial, has_radius_below, rows_of};
use crate::steady::reach::{polynomial_text, unseen_part};
use crate::steady::riccati::SteadyState;
use crate::steady::simulated::NotSimulated;
use crate::steady::verdict::{Depth, Filters, StabilityVerdict as Joint, rows_text, word_text};
use nalgebra::{Matrix1, Matrix2, SMatrix};
use std::fmt::Write;

/// Points a side of the map in the ledger, and its decades of the tracking indices.
const MAP: (usize, [f64; 2]) = (29, [-4.0, 3.0]);

fn is_stable(matrix: &MatrixRows<Rational>) -> bool {
    has_radius_below(matrix, &Rational::new(1, 1)) == Some(true)
}

/// The theorem on bounded mixed covariances.
pub fn theorem(s: &Specification) -> JudgedClaim {
    let models = growing_mixture::<Rational>();
    let mut meets = true;
    for model in &models {
        let unseen = unseen_part(&rows_of(&model.transition), &rows_of(&model.measurement));
        meets &= unseen.len() == 1 && SteadyState::certify(model, 100).is_ok();
    }
    let traces: Vec<Rational> = mixed_covariances(30).iter().map(SMatrix::trace).collect();
    // The unseen variance: w' = (9/5) w + 86/5.
    let unseen: Vec<Rational> = mixed_covariances(30).iter().map(|p| p[(1, 1)].clone()).collect();
    let grows = unseen
        .windows(2)
        .all(|pair| pair[1] == pair[0].clone() * Rational::new(9, 5) + Rational::new(86, 5));
    let seen = run_growing(40).map_or_else(
        |reason| reason.to_string(),
        |(trace, farthest)| {
            format!(
                "trace {} after 40 steps of pseudo-random data, mode probabilities one half to {}",
                figure(trace),
                figure(farthest)
            )
        },
    );
    let evidence = format!(
        "Two models with F nilpotent and (H, F) observable, Q = I, R = 1, the paper's chain, exchanged by a mirror that the measurement does not \
         see: each filter by itself has a certified steady state and forgets its error in three steps, and the mode probabilities stay one half for \
         every data. The traces of the mixed covariance are, exactly, {}, …; the unseen variance obeys w' = (9/5)w + 86/5. The filter as a program \
         runs it: {seen}. It does hold, for any mode probabilities, if all models share a measurement matrix of full column rank, all Q and R are \
         positive definite, and noise and the mismatch of every model are bounded (proof in the documentation of this instance); for a measured \
         position alone it is open.",
        traces
            .iter()
            .take(4)
            .map(ToString::to_string)
            .collect::<Vec<_>>()
            .join(", "),
    );
    s.judgement("derbez2000-theorem", refuted_by(meets && grows), evidence)
}

/// The trace of the mixed covariance after a run, and the greatest distance of a mode probability from one half.
fn run_growing(steps: u32) -> Result<(f64, f64), NotSimulated> {
    let mut filter = growing_filter()?;
    let mut farthest = 0.0_f64;
    let mut trace = 0.0;
    for n in 0..steps {
        // Any data will do; these go through the numbers 0 to 16.
        let z = f64::from(n * n % 17) - 8.0;
        let step = filter.step(Some(&Matrix1::new(z)))?;
        farthest = farthest.max((step.mode_probabilities[0] - 0.5).abs());
        trace = step.mixed[0].covariance.trace();
    }
    Ok((trace, farthest))
}

/// Remark 1: the averaged matrices.
pub fn stability_matrices(s: &Specification, map: &Map) -> JudgedClaim {
    let criteria = |mixing: [[Rational; 2]; 2], c: i64| {
        let n = |value: i64| Rational::integer(value);
        let matrices = [
            Matrix2::new(n(0), n(0), n(1), n(0)),
            Matrix2::new(n(0), n(c), n(0), n(0)),
        ];
        let averaged = mixing
            .iter()
            .all(|row| is_stable(&rows_of(&remark_1_matrix(row, &matrices))));
        let rows: Vec<Vec<Rational>> = mixing.iter().map(|row| row.to_vec()).collect();
        (averaged, is_stable(&frozen_matrix(&rows, &matrices)))
    };
    let q = |p: i64, q: i64| Rational::new(p, q);
    let lenient = criteria([[q(1, 4), q(3, 4)], [q(3, 4), q(1, 4)]], 2);
    let strict = criteria([[q(19, 20), q(1, 20)], [q(1, 20), q(19, 20)]], 25);
    let evidence = format!(
        "Exact, A₁ = [0 0; 1 0] and A₂ = [0 c; 0 0], both nilpotent. With c = 2 and μ₁∣₁ = μ₂∣₂ = 1/4 the averaged matrices are stable ({}) and \
         the filter is not ({}): ρ² = 9/8. With c = 25, the paper's chain and equal probabilities they are not ({}) and the filter is ({}): \
         ρ = 1/4. What controls the filter for constant probabilities is diag(Aⱼ)(U ⊗ I). For CV and CA filters under the paper's chain no \
         instability with constant probabilities was found: the greatest spectral radius over {} pairs of noises and 19 probabilities is {:.4} \
         (searched, not proven).",
        lenient.0,
        lenient.1,
        strict.0,
        strict.1,
        map.points.len() * map.points.len(),
        map.greatest_frozen_radius(),
    );
    s.judgement(
        "derbez2000-stability-matrices",
        refuted_by([lenient, strict] == [(true, false), (false, true)]),
        evidence,
    )
}

/// The two filters of the smallest numbers whose product grows.
fn unstable_pair() -> (Filters, Product) {
    let filters = Filters::Roots([Rational::new(3, 4), Rational::new(1, 6)]);
    (
        filters,
        Product {
            word: vec![1, 0],
            radius: Rational::new(109, 100),
        },
    )
}

/// Remark 1: one norm for all.
pub fn prior_data_discounted(s: &Specification) -> JudgedClaim {
    let (filters, product) = unstable_pair();
    let grows = filters.check_unstable(&product).is_ok();
    let matrices = [
        velocity_matrix(&Rational::new(3, 4)),
        acceleration_matrix(&Rational::new(1, 6)),
    ];
    let alone = matrices.iter().all(|matrix| is_stable(&rows_of(matrix)));
    let polynomial = polynomial_text(&characteristic_polynomial(&rows_of(&(&matrices[0] * &matrices[1]))));
    let evidence = format!(
        "Steady gains with θ = 3/4 (CV, q = 1/36) and θ = 1/6 (CA, q = 15625/441), R = t = 1: each (I − KH)F is stable, and their product has the \
         characteristic polynomial {polynomial}, which is positive at −1 and negative far below it: a root of −1.095. Each matrix has a norm \
         in which it contracts; the two have no common one. The sentence is true where the gains converge to one stable matrix, as in a single Kalman \
         filter.",
    );
    s.judgement("derbez2000-prior-data-discounted", refuted_by(grows && alone), evidence)
}

/// The sentence of section 5, literally.
pub fn convex_combination(s: &Specification) -> JudgedClaim {
    let n = |value: i64| Rational::new(value, 2);
    let a = Matrix2::new(n(1), n(20), n(0), n(1));
    let mean = remark_1_matrix(&[n(1), n(1)], &[a.clone(), a.transpose()]);
    let [alone, combined] = [&a, &mean].map(|matrix| is_stable(&rows_of(matrix)));
    let evidence = "A = [1/2 10; 0 1/2] and its transpose have the one eigenvalue 1/2, and their mean has 11/2. As a general statement the \
                    sentence is false; the next three entries say where it is true.";
    s.judgement(
        "derbez2000-convex-combination",
        refuted_by(alone && !combined),
        evidence.to_owned(),
    )
}

/// The un-mixed reading, for all noises.
pub fn stable_unmixed(s: &Specification) -> JudgedClaim {
    let root = RationalFunction::unknown("theta");
    let at = |coefficients: &[RationalFunction], sign: i64| {
        let mut sum = RationalFunction::integer(0);
        for (power, coefficient) in coefficients.iter().enumerate() {
            let factor = if power % 2 == 1 { sign } else { 1 };
            sum += coefficient.clone() * RationalFunction::integer(factor);
        }
        sum
    };
    let n = RationalFunction::integer;
    let (rest, sum) = (n(1) - root.clone(), n(1) + root.clone());
    let velocity = characteristic_polynomial(&rows_of(&velocity_matrix(&root)));
    let acceleration = characteristic_polynomial(&rows_of(&acceleration_matrix(&root)));
    // λ p(λ), and (λ − θ) p(λ): the values at 1 and −1 hold the factor.
    let first = at(&velocity, 1) == n(2) * rest.clone() * rest.clone() && at(&velocity, -1) == n(-4) * root.clone();
    let squares = n(2) * rest.clone() * rest.clone() * rest;
    let second = at(&acceleration, 1) * sum.clone() == squares && at(&acceleration, -1) == n(-8) * root;
    let evidence = "Symbolic, for every damping root θ in (0, 1), and so for all positive noises: the closed loop of CV has the characteristic \
                    polynomial λp(λ) with p(1) = 2(1 − θ)², p(−1) = 4θ, p(0) = θ²; that of CA (λ − θ)p(λ) with p(1) = 2(1 − θ)²/(1 + θ), \
                    p(−1) = 8θ/(1 + θ), p(0) = θ. Both are stable by Jury's conditions; each filter goes on from its own estimate, and a convex \
                    combination of bounded estimates is bounded. In this reading the paper is right.";
    s.judgement(
        "derbez2000-stable-unmixed",
        proven_by(first && second),
        evidence.to_owned(),
    )
}

/// The mixed reading at the paper's noises.
pub fn stable_mixed(s: &Specification) -> JudgedClaim {
    let mut evidence = String::from(
        "Common quadratic forms P, in coordinates scaled by diag(1, t, t²), with P − AᵀPA ≻ 0 for both filters, checked on proven enclosures of the \
         gains; q = 5:",
    );
    let mut all = true;
    for (interval, measurement) in [("1", "0.05"), ("1", "0.5"), ("2", "0.05"), ("2", "0.5")] {
        let verdict = decided(interval, measurement, ["5", "5"]);
        let Some(Joint::Stable(Quadratics { forms, .. })) = &verdict else {
            all = false;
            let _ = write!(evidence, " t = {interval}, R = {measurement}: not certified;");
            continue;
        };
        let _ = write!(
            evidence,
            " t = {interval}, R = {measurement}: {};",
            rows_text(&forms[0])
        );
    }
    let locked = locked_errors(200).map_or_else(
        |reason| reason.to_string(),
        |[first, second]| {
            format!(
                "errors in position and acceleration {} and {} against {} and {}",
                figure(first[0]),
                figure(first[2]),
                figure(second[0]),
                figure(second[2])
            )
        },
    );
    let _ = write!(
        evidence,
        " errors shrink however the filters are mixed. Stable does not mean that the past is forgotten: with θ = (1/3, 1/2), also certified, two copies that \
         see the same target of constant acceleration and start with and without its acceleration stay apart, one locked into constant velocity \
         ({locked}).",
    );
    s.judgement("derbez2000-stable-mixed", proven_by(all), evidence)
}

/// Where the band of equal noises ends: at t = R = 1 it does not reach q = 1e-7.
fn end_of_equal_noises() -> String {
    match decided("1", "1", ["1e-7", "1e-7"]) {
        Some(Joint::Unstable(product)) => format!(
            "with t = R = 1 and q = 1e-7 for both filters a product of {} letters is certified to grow",
            product.word.len()
        ),
        _ => "where is not decided".to_owned(),
    }
}

fn decided(interval: &str, measurement: &str, noises: [&str; 2]) -> Option<Joint> {
    let read = |text: &str| Rational::from_decimal(text);
    let noises = [read(noises[0])?, read(noises[1])?];
    let filters = Filters::of_noises(&read(interval)?, &read(measurement)?, noises);
    Some(filters.decide(Depth::default()))
}

/// The map of the ledger.
pub fn map() -> Map {
    Map::new(MAP.0, MAP.1, Depth::default(), &|| ())
}

/// The mixed reading at unequal noises.
pub fn stable_mixed_unequal_noises(s: &Specification, map: &Map) -> JudgedClaim {
    let [stable, unstable, undecided] = map.counts();
    let figure_2 = ["2", "10", "40"].map(|q| {
        let is_certified = ["1", "2"]
            .iter()
            .all(|t| matches!(decided(t, "0.05", [q, "5"]), Some(Joint::Stable(_))));
        format!(
            "q_v = {q}: {}",
            if is_certified {
                "certified stable"
            } else {
                "not certified"
            }
        )
    });
    let (filters, product) = unstable_pair();
    let is_refuted = unstable > 0 && filters.check_unstable(&product).is_ok();
    let apart = distances_of_two_copies(300).map_or_else(
        |reason| reason.to_string(),
        |distances| {
            distances
                .iter()
                .map(|distance| figure(*distance))
                .collect::<Vec<_>>()
                .join(", ")
        },
    );
    let evidence = format!(
        "Over the tracking indices of both filters, 10⁻⁴ to 10³ each way, {stable} of {} points are certified stable, {unstable} certified unstable, \
         {undecided} undecided: stable is a band around equal indices, which ends where these are small: {}. The noises of figure 2 (t = 1 and 2, R = 0.05) are in it: {}. The unstable pair \
         of the smallest numbers is θ = (3/4, 1/6), product {} with an eigenvalue of −1.095. Realised by data, θ = (4/5, 1/5): two copies of that filter, \
         with its own likelihoods and p = 0.95/0.05, see the same measurements 30, −120, −30, 120, … and start a millimetre apart; after 100, 200 and 300 \
         steps they are {apart} m apart (enclosed). That takes this start: the path is a periodic one, and unstable. {} With measurements that stay at zero no \
         loss was found.",
        stable + unstable + undecided,
        end_of_equal_noises(),
        figure_2.join(", "),
        word_text(&product.word),
        under_noise(),
    );
    s.judgement(
        "derbez2000-stable-mixed-unequal-noises",
        refuted_by(is_refuted),
        evidence,
    )
}

/// What noise does to the two copies, in words.
fn under_noise() -> String {
    let of = |deviation: f64| match copies_apart(deviation, NOISY_RUNS) {
        Ok([early, late]) => format!("{deviation} m {early} and {late}"),
        Err(reason) => format!("{deviation} m: {reason}"),
    };
    format!(
        "With noise on the measurements, of {NOISY_RUNS} runs the copies are farther apart than at the start after 300 and after 1000 steps in, by the \
         deviation of the noise, {}; 1 m is what the gains are made for.",
        [0.001, 0.1, 1.0, 3.0].map(of).join(", ")
    )
}

/// The runs of the copies under noise.
const NOISY_RUNS: usize = 40;

/// Eigenvalues outside the unit circle in the full IMM filter.
pub fn local_instability(s: &Specification) -> JudgedClaim {
    let bound = Rational::new(6, 5);
    let (found, gain) = match gain_after_a_jump() {
        Ok(gain) => {
            let figures = gain.map(|entry| figure(entry.middle()));
            (
                is_locally_unstable(&gain, &bound),
                figures.iter().cloned().collect::<Vec<_>>().join(", "),
            )
        }
        Err(reason) => (false, reason.to_string()),
    };
    let evidence = format!(
        "It does happen, with the paper's noises (q = 5 for both, R = 0.05, t = 1), identities as covariances, a target at rest at the origin and \
         measurements 60, 60: in the third step the gain of CA is [{gain}] and (I − KH)F has an eigenvalue of magnitude 1.21, at least 6/5 by the Schur-Cohn \
         test on enclosures of the whole run. For CV none was found in runs. It is local: the next gains are others.",
    );
    s.judgement("derbez2000-local-instability", proven_by(found), evidence)
}
