//! Goal: the cycle without a record is the recorded one, to the last bit.
//!
//! Method: whole runs in doubles through [`PlainImm`] and [`Imm`](immaculate::imm::Imm), step by step, for every kind of filter, sensor
//! and interaction, with steps without a detection. The estimates of the modes, their probabilities and the combined estimate have equal
//! bits, and a step that cannot be computed fails with the same sentence. Kind of evidence: property. Nothing is rounded differently, so
//! there is no tolerance.

mod common;

use common::{
    Scene, all_scenes, bits, bits_of, converted_scene, fixed_gain_scene, linear_scene, polar_scene,
    scene_over_the_sensor, unscented_of,
};
use immaculate::filter::Filter;
use immaculate::imm::state_conversion::{Reader, StateConversion, StateConversions};
use immaculate::imm::{Interaction, PlainImm};
use immaculate::model::Conversion;
use immaculate::model::motion::Motion;
use nalgebra::{Matrix4, U2, U4, matrix, vector};
use std::num::NonZeroUsize;

type Plain = PlainImm<f64, U4, U2, 3>;

/// A scene with other filters.
fn with_filters(mut scene: Scene, filters: Vec<Filter<f64, U4, U2>>) -> Scene {
    scene.problem.filters = filters;
    scene
}

/// The linear scene in which the third mode has a state in units half as large, and the entry 1 of its own is an angle.
fn converted_states() -> Scene {
    let mut scene = linear_scene();
    let by = |factor: f64, from, to| StateConversion {
        from,
        to,
        map: Motion::Linear(Matrix4::identity() * factor),
        added: Matrix4::identity() * 0.25,
    };
    let list = vec![
        by(2.0, 0, Reader::Mode(2)),
        by(2.0, 1, Reader::Mode(2)),
        by(0.5, 2, Reader::Mode(0)),
        by(0.5, 2, Reader::Mode(1)),
        by(0.5, 2, Reader::Common),
    ];
    let angles = vec![vec![], vec![], vec![1]];
    scene.problem.interaction = Interaction::Converted(StateConversions { list, angles });
    scene
}

/// Every kind of filter, of sensor and of interaction.
fn scenes() -> Vec<(String, Scene)> {
    let five = NonZeroUsize::new(5).expect("5 is not 0");
    let correlated = matrix![3.0, 1.0; 2.0, 4.0; 0.5, 3.0; 1.0, 2.0];
    let (linear, polar) = (linear_scene, || polar_scene("cubature-3"));
    let mut unmixed = fixed_gain_scene();
    unmixed.problem.interaction = Interaction::Unmixed;
    let mut first_order = polar();
    first_order.problem.interaction = Interaction::Gpb1;
    let mut bank = linear();
    bank.problem.interaction = Interaction::Unmixed;
    let mut angles = linear();
    angles.problem.angles = vec![3];
    let mut angles_of_points = polar();
    angles_of_points.problem.angles = vec![3];
    let mixed = vec![
        Filter::kalman(),
        Filter::extended(),
        common::linear_scene_with("unscented").problem.filters[0].clone(),
    ];
    let mut scenes = all_scenes();
    scenes.extend([
        ("fixed gains".into(), fixed_gain_scene()),
        ("fixed gains, unmixed".into(), unmixed),
        ("first order".into(), first_order),
        ("unmixed".into(), bank),
        (
            "converted".into(),
            converted_scene(Conversion::Standard, [100.0, -50.0]),
        ),
        (
            "extended, linear".into(),
            with_filters(linear(), vec![Filter::extended()]),
        ),
        (
            "extended, polar".into(),
            with_filters(polar(), vec![Filter::extended()]),
        ),
        ("iterated".into(), with_filters(polar(), vec![Filter::iterated(five)])),
        (
            "correlated noises".into(),
            with_filters(linear(), vec![Filter::kalman().with_noise_cross_covariance(correlated)]),
        ),
        (
            "a filter of its own for each mode".into(),
            with_filters(linear(), mixed),
        ),
        ("an angle in the state".into(), angles),
        ("an angle in the state, points".into(), angles_of_points),
        ("states of their own".into(), converted_states()),
    ]);
    scenes
}

#[test]
fn the_plain_cycle_has_the_bits_of_the_recorded_one() {
    let mut steps = 0;
    for (name, scene) in scenes() {
        let mut plain = Plain::new(scene.problem.clone(), &scene.initial).expect("the scene is a valid problem");
        let mut recorded = scene.filter().expect("the scene is a valid problem");
        assert_eq!(
            bits_of(plain.combined()),
            bits_of(&recorded.current().combined),
            "{name}, start"
        );
        for (k, z) in scene.measurements.iter().enumerate() {
            let step = recorded.step(z.as_ref()).expect("every step can be computed");
            let combined = plain.step(z.as_ref()).expect("every step can be computed").clone();
            assert_eq!(bits_of(&combined), bits_of(&step.combined), "{name}, step {}", k + 1);
            assert_eq!(
                bits(plain.mode_probabilities()),
                bits(&step.mode_probabilities),
                "{name}, step {}",
                k + 1
            );
            for (estimate, expected) in plain.modes().iter().zip(&step.updated) {
                assert_eq!(bits_of(estimate), bits_of(expected), "{name}, step {}", k + 1);
            }
            steps += 1;
        }
    }
    assert!(steps > 500, "{steps} steps are few");
}

/// Mixed and innovation covariances that are not definite, a sensor's own place, what is beyond doubles, and measurements that
/// are none.
#[test]
fn a_step_that_fails_says_the_same_and_leaves_the_filter_as_it_is() {
    let (mixed, seen) = (
        scene_over_the_sensor(unscented_of(-3)),
        scene_over_the_sensor(unscented_of(-5)),
    );
    let mut exact = linear_scene();
    exact.problem.measurement_noise.fill(0.0);
    exact
        .initial
        .modes
        .iter_mut()
        .for_each(|estimate| estimate.covariance.fill(0.0));
    exact.problem.modes.iter_mut().for_each(|mode| mode.noise.fill(0.0));
    let mut at_the_sensor = with_filters(polar_scene("cubature-3"), vec![Filter::extended()]);
    at_the_sensor
        .initial
        .modes
        .iter_mut()
        .for_each(|estimate| estimate.mean.fill(0.0));
    let mut outside = linear_scene();
    outside.measurements = vec![None, Some(vector![f64::NAN, 0.0])];
    let mut negative = polar_scene("cubature-3");
    negative.measurements = vec![Some(vector![-1.0, 0.0])];
    let mut degrees = polar_scene("cubature-3");
    degrees.measurements = vec![Some(vector![1000.0, 45.0])];
    let mut beyond = linear_scene();
    beyond.measurements = vec![Some(vector![1e200, 0.0])];
    let mut sentences = vec![];
    for scene in [mixed, seen, exact, at_the_sensor, outside, negative, degrees, beyond] {
        let mut plain = Plain::new(scene.problem.clone(), &scene.initial).expect("the scene is a valid problem");
        let mut before = plain.clone();
        let failure = scene.measurements.iter().find_map(|z| {
            before = plain.clone();
            plain.step(z.as_ref()).map(|_| ()).err()
        });
        let failure = failure.expect("the scene has a step that fails").to_string();
        assert_eq!(
            failure,
            scene.try_run().expect_err("the recorded filter fails, too").to_string()
        );
        assert_eq!(bits_of(plain.combined()), bits_of(before.combined()));
        assert_eq!(bits(plain.mode_probabilities()), bits(before.mode_probabilities()));
        sentences.push(failure);
    }
    insta::assert_snapshot!("failures", sentences.join("\n"));
}
