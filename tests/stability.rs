//! Goal: the steady gains are the ones of the Riccati equation, and what is said of the stability of fixed-gain filters is proven.
//!
//! Method: identities on rational functions of the damping root, the scan time and the measurement variance (symbolic); exact rational
//! arithmetic and enclosures for what holds at given noises; each certificate is checked, then spoilt and refused. Kind of evidence:
//! stated with each test.

use immaculate::filter::kalman::{cross_covariance, innovation_covariance, predicted_covariance};
use immaculate::filter::update::{gain, updated_covariance};
use immaculate::matrix::ldl;
use immaculate::model::acceleration::{
    acceleration_part, acceleration_response, constant_acceleration, embedded_constant_velocity,
    embedded_velocity_response, position_matrix, response_noise,
};
use immaculate::number::{Enclosure, Field, Rational, RationalFunction};
use immaculate::steady::gains;
use nalgebra::{Matrix1, Matrix3, Vector3};
use num_traits::{One, Zero};

type Unknown = RationalFunction;

fn unknown(name: &str) -> Unknown {
    Unknown::unknown(name)
}

// The motions and the gains (symbolic)

#[test]
fn the_two_motions_differ_by_the_acceleration() {
    let t = unknown("t");
    let difference = constant_acceleration(&t) - embedded_constant_velocity(&t);
    assert_eq!(difference, acceleration_part(&t));
    let state = Vector3::new(unknown("p"), unknown("v"), unknown("a"));
    assert_eq!(acceleration_part(&t) * &state, acceleration_response(&t) * unknown("a"));
    // The embedded model forgets the acceleration it is given and makes none.
    let after = embedded_constant_velocity(&t) * state;
    assert_eq!(
        after,
        Vector3::new(unknown("p") + t * unknown("v"), unknown("v"), Unknown::zero())
    );
}

#[test]
fn constant_acceleration_composes_over_time() {
    let (s, t) = (unknown("s"), unknown("t"));
    let both = constant_acceleration(&s) * constant_acceleration(&t);
    assert_eq!(both, constant_acceleration(&(s + t)));
}

/// One step of the Riccati recursion of a filter that measures the position.
fn riccati_step(
    f: &Matrix3<Unknown>,
    q: &Matrix3<Unknown>,
    r: &Unknown,
    p: &Matrix3<Unknown>,
) -> (Vector3<Unknown>, Matrix3<Unknown>) {
    let h = position_matrix();
    let s = innovation_covariance(&h, p, &Matrix1::new(r.clone()));
    let k = gain(&cross_covariance(p, &h), &ldl(&s));
    let updated = updated_covariance(p, &k, &s);
    (k, predicted_covariance(f, &updated, q))
}

#[test]
fn the_alpha_beta_gain_solves_the_riccati_equation() {
    let (root, r, t) = (unknown("theta"), unknown("R"), unknown("t"));
    // q = Λ² R/t⁴
    let index = gains::alpha_beta_index(&root);
    let variance =
        |index: &Unknown| index.clone() * index.clone() * r.clone() / (t.clone() * t.clone() * t.clone() * t.clone());
    let noise = |index: &Unknown| response_noise(&embedded_velocity_response(&t), &variance(index));
    let p = gains::alpha_beta_covariance(&root, &r, &t);
    let (k, next) = riccati_step(&embedded_constant_velocity(&t), &noise(&index), &r, &p);
    assert_eq!(next, p);
    assert_eq!(k, gains::alpha_beta_gain(&root, &t));
    assert_eq!(p[(0, 0)].clone() + r.clone(), gains::innovation_variance(&root, &r));
    // With another noise it is no solution.
    let (_, other) = riccati_step(
        &embedded_constant_velocity(&t),
        &noise(&(index + Unknown::one())),
        &r,
        &p,
    );
    assert_ne!(other, p);
}

#[test]
fn the_alpha_beta_gamma_gain_solves_the_riccati_equation() {
    let (root, r, t) = (unknown("theta"), unknown("R"), unknown("t"));
    let index = gains::alpha_beta_gamma_index(&root);
    let variance =
        |index: &Unknown| index.clone() * index.clone() * r.clone() / (t.clone() * t.clone() * t.clone() * t.clone());
    let noise = |index: &Unknown| response_noise(&acceleration_response(&t), &variance(index));
    let p = gains::alpha_beta_gamma_covariance(&root, &r, &t);
    let (k, next) = riccati_step(&constant_acceleration(&t), &noise(&index), &r, &p);
    assert_eq!(next, p);
    assert_eq!(k, gains::alpha_beta_gamma_gain(&root, &t));
    assert_eq!(p[(0, 0)].clone() + r.clone(), gains::innovation_variance(&root, &r));
    let (_, other) = riccati_step(&constant_acceleration(&t), &noise(&(index + Unknown::one())), &r, &p);
    assert_ne!(other, p);
}

// The damping roots (enclosed)

#[test]
fn the_damping_roots_give_back_their_index() {
    // From a target that hardly moves in a scan to one that is lost between two, on both sides of the index 12√3 = 20.78, where
    // the cubic goes from one real root to three.
    let indices = ["1e-12", "0.001", "0.7", "20.7", "20.8", "1000", "1e12"];
    for text in indices {
        let index = Rational::from_decimal(text).unwrap();
        Enclosure::with_precision(256, || {
            let index = Enclosure::rational(&index);
            for (root, back) in [
                (
                    gains::alpha_beta_root(&index),
                    gains::alpha_beta_index as fn(&Enclosure) -> Enclosure,
                ),
                (gains::alpha_beta_gamma_root(&index), gains::alpha_beta_gamma_index),
            ] {
                assert!(root > Enclosure::zero() && root < Enclosure::one(), "{text}");
                let difference = back(&root) / index.clone() - Enclosure::one();
                assert!(difference.contains(&Rational::zero()), "{text}: {difference}");
                // 256 bits less those of the index itself, whose square decides the root.
                assert!(difference.width() < 1e-40, "{text}: {difference}");
            }
        });
        // The same closed forms in doubles: nothing cancels. The root has some ten roundings, and the ten of a logarithm of up to
        // 30; the index is a power of up to three of 1 − θ, so they come back magnified by 3/(1 − θ) at most.
        let double = index.to_f64();
        let (velocity, acceleration) = (gains::alpha_beta_root(&double), gains::alpha_beta_gamma_root(&double));
        let back = [
            (gains::alpha_beta_index(&velocity), velocity),
            (gains::alpha_beta_gamma_index(&acceleration), acceleration),
        ];
        for (value, root) in back {
            let bound = 20.0 * f64::EPSILON * 3.0 / (1.0 - root);
            assert!((value / double - 1.0).abs() < bound, "{text}: {value}");
        }
    }
}
