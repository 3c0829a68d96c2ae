//! Runs much longer than any paper's: rounding must not add up to a failure.
//!
//! Method: measured, in doubles. A target on a straight line is tracked for tens of thousands of steps, with every covariance checked
//! at every step; then the one safeguard is taken away, and the same run fails.

mod common;

use common::{RULES, Scene, linear_scene, linear_scene_with};
use immaculate::imm::{Equations, Imm};
use immaculate::matrix::{cholesky, is_symmetric};
use immaculate::model::motion::Mode;
use nalgebra::{Matrix2, Matrix4x2, U2, U4, Vector2};

/// The first step that cannot be computed, or whose covariances are not symmetric positive definite.
fn first_failure(scene: &Scene, equations: &Equations<f64, U4, U2>, steps: usize) -> Option<usize> {
    let mut filter = Imm::with_equations(scene.problem.clone(), *equations, &scene.initial).unwrap();
    for k in 1..=steps {
        let time = k as f64;
        let z = Vector2::new(15000.0 - 180.0 * time, 1000.0 + 200.0 * time);
        // Every hundredth step is without a detection.
        let measurement = (k % 100 != 0).then_some(&z);
        let Ok(step) = filter.step(measurement) else {
            return Some(k);
        };
        let sound = step
            .updated
            .iter()
            .all(|estimate| is_symmetric(&estimate.covariance) && cholesky(&estimate.covariance).is_ok());
        if !sound {
            return Some(k);
        }
    }
    None
}

/// The chain and the noise of liu2017, with positions measured to 40 m.
fn long_scene() -> Scene {
    let mut scene = linear_scene();
    scene.problem.chain = (0..3)
        .map(|i| (0..3).map(|j| if i == j { 0.95 } else { 0.025 }).collect())
        .collect();
    scene.problem.measurement_noise = Matrix2::from_diagonal_element(1600.0);
    scene
}

#[test]
fn a_long_run_keeps_every_covariance_symmetric_and_positive_definite() {
    assert_eq!(first_failure(&long_scene(), &Equations::standard(), 100_000), None);
    for rule in RULES {
        let scene = linear_scene_with(rule);
        assert_eq!(first_failure(&scene, &Equations::standard(), 10_000), None, "{rule}");
    }
}

#[test]
fn without_the_mirrored_triangle_a_long_run_fails() {
    let unmirrored = Equations::<f64, U4, U2> {
        predicted_covariance: |problem, _, now, j| {
            let mode: &Mode<f64, U4> = &problem.modes[j];
            let f = *mode.motion.matrix();
            f * now.mixed[j].covariance * f.transpose() + mode.noise
        },
        updated_covariance: |_, _, now, j| {
            let gain: &Matrix4x2<f64> = &now.gains[j];
            now.predicted[j].covariance - gain * now.innovation_covariances[j] * gain.transpose()
        },
        ..Equations::standard()
    };
    let scene = long_scene();
    let mut filter = Imm::with_equations(scene.problem, unmirrored, &scene.initial).unwrap();
    let failure = (1..=100_000).find_map(|k| {
        let time = f64::from(k);
        let z = Vector2::new(15000.0 - 180.0 * time, 1000.0 + 200.0 * time);
        filter.step(Some(&z)).err()
    });
    let failure = failure.expect("the antisymmetric part grows until a covariance is lost");
    assert!(failure.to_string().contains("innovation covariance"), "{failure}");
}
