//! Goal: whatever is wrong with an input, one sentence says what and where, and nothing panics.
//!
//! Method: for each variant of the library's errors a right input in which one thing is made wrong, and the error's whole sentence;
//! then random garbage in every field. Kind of evidence: exact (sentences are compared as text) and property (garbage).

mod common;

use common::{Scene, converted_scene, fixed_gain_scene, linear_scene, linear_scene_with, polar_scene, rule_of};
use immaculate::filter::fixed_gain::FixedGain;
use immaculate::filter::{Filter, Transform, Update};
use immaculate::gaussian::Gaussian;
use immaculate::imm::state_conversion::{Reader, StateConversion, StateConversions};
use immaculate::imm::{Cause, Equations, Gpb2, Imm, Initial, Interaction, InvalidProblem, PlainImm, Problem, Quantity};
use immaculate::matrix::{NotPositiveDefinite, cholesky};
use immaculate::model::angle::wrap;
use immaculate::model::function::Function;
use immaculate::model::motion::{Mode, Motion, coordinated_turn};
use immaculate::model::space::{Component, Space};
use immaculate::model::{Conversion, PolarComponent, Sensor};
use immaculate::number::Rational;
use immaculate::report::rule::describe;
use immaculate::rule::gauss_hermite::{MOST_POINTS, gauss_hermite};
use immaculate::rule::unscented::{Parameters, unscented};
use immaculate::rule::{InvalidRule, Rule, RuleName};
use nalgebra::{
    DMatrix, DVector, Dyn, Matrix2, Matrix3, Matrix4, SMatrix, U0, U2, U3, U4, U8, U100, Vector2, dvector, matrix,
    vector,
};
use proptest::prelude::*;
use std::num::NonZeroUsize;
use std::sync::Arc;

// Problems

/// Nothing is wrong with what the tests start from: an error is the doing of the change that was made.
#[test]
fn the_problems_that_are_spoilt_below_are_right() {
    for (name, scene) in common::all_scenes() {
        assert!(scene.filter().is_ok(), "{name}");
        assert!(scene.try_run().is_ok(), "{name}");
    }
    for converted in Conversion::ALL {
        assert!(converted_scene(converted, [0.0, 0.0]).try_run().is_ok());
    }
    assert!(fixed_gain_scene().try_run().is_ok());
    for sensor in [false, true] {
        let (problem, initial) = at_run_time(3, 2, sensor);
        assert!(Imm::new(problem, &initial).is_ok());
    }
}

#[test]
fn there_is_at_least_one_mode() {
    let mut scene = linear_scene();
    scene.problem.modes.clear();
    scene.problem.chain.clear();
    scene.initial.modes.clear();
    scene.initial.mode_probabilities.clear();
    assert_sentence(&scene, "`modes` is empty; the filter needs at least one (zhu2016 (54))");
}

#[test]
fn there_is_at_least_one_filter() {
    let mut scene = linear_scene();
    scene.problem.filters.clear();
    assert_sentence(
        &scene,
        "`filters` is empty; the modes need one each, or one for all (zhu2016 (55))",
    );
    // Without modes that is said first: who has no modes has no filters.
    scene.problem.modes.clear();
    assert_sentence(&scene, "`modes` is empty; the filter needs at least one (zhu2016 (54))");
}

#[test]
fn every_list_has_as_many_entries_as_there_are_modes() {
    let spoils: [(Spoil, &str); 8] = [
        (
            |scene| scene.problem.filters = vec![Filter::kalman(); 2],
            "`filters` has 2 entries where there are 3 modes (zhu2016 (55))",
        ),
        (
            |scene| scene.problem.filters = vec![Filter::kalman(); 4],
            "`filters` has 4 entries where there are 3 modes (zhu2016 (55))",
        ),
        (
            |scene| scene.problem.chain.truncate(2),
            "`transition` has 2 entries where there are 3 modes (zhu2016 (54))",
        ),
        (
            |scene| scene.problem.chain[1].push(0.0),
            "`transition[1]` has 4 entries where there are 3 modes (zhu2016 (54))",
        ),
        (
            |scene| scene.problem.chain[2].clear(),
            "`transition[2]` has 0 entries where there are 3 modes (zhu2016 (54))",
        ),
        (
            |scene| scene.initial.modes.truncate(1),
            "`initial.modes` has 1 entries where there are 3 modes (zhu2016 (55))",
        ),
        (
            |scene| scene.initial.mode_probabilities.push(0.0),
            "`initial.mode_probabilities` has 4 entries where there are 3 modes (zhu2016 (54))",
        ),
        (
            |scene| scene.problem.modes.truncate(2),
            "`transition` has 3 entries where there are 2 modes (zhu2016 (54))",
        ),
    ];
    assert_sentences(linear_scene, &spoils);
}

#[test]
fn rows_of_the_transition_matrix_and_initial_probabilities_sum_to_one() {
    let spoils: [(Spoil, &str); 4] = [
        (
            |scene| scene.problem.chain[1] = vec![0.5, 0.25, 0.125],
            "`transition[1]` sums to 0.875; it must sum to 1 (zhu2016 (54))",
        ),
        (
            // Probabilities to come from a mode sum to one over the columns: the matrix is transposed.
            |scene| {
                scene.problem.chain = vec![vec![0.5, 0.25, 0.5], vec![0.25, 0.5, 0.25], vec![0.25, 0.25, 0.25]];
            },
            "`transition[0]` sums to 1.25; it must sum to 1 (zhu2016 (54))",
        ),
        (
            |scene| scene.initial.mode_probabilities = vec![0.5, 0.25, 0.5],
            "`initial.mode_probabilities` sums to 1.25; it must sum to 1 (zhu2016 (54))",
        ),
        (
            |scene| scene.initial.mode_probabilities = vec![0.0; 3],
            "`initial.mode_probabilities` sums to 0.0; it must sum to 1 (zhu2016 (54))",
        ),
    ];
    assert_sentences(linear_scene, &spoils);
}

/// The sum may be off by what decimals of 15 digits make it, and no more.
#[test]
fn thirds_in_fifteen_digits_are_probabilities_and_in_fourteen_are_not() {
    let with = |third: f64| {
        let mut scene = linear_scene();
        scene.initial.mode_probabilities = vec![third; 3];
        scene.problem.chain[0] = vec![third; 3];
        scene
    };
    assert!(with(1.0 / 3.0).filter().is_ok());
    assert!(with(0.333_333_333_333_333).filter().is_ok());
    assert!(matches!(
        with(0.333_333_333_333_33).filter(),
        Err(InvalidProblem::NotNormalised { .. })
    ));
}

#[test]
fn probabilities_are_not_negative() {
    let spoils: [(Spoil, &str); 2] = [
        (
            |scene| scene.problem.chain[2] = vec![-0.25, 0.25, 1.0],
            "`transition[2]` has a negative entry, -0.25; it must be a probability (zhu2016 (54))",
        ),
        (
            |scene| scene.initial.mode_probabilities = vec![1.5, -0.5, 0.0],
            "`initial.mode_probabilities` has a negative entry, -0.5; it must be a probability (zhu2016 (54))",
        ),
    ];
    assert_sentences(linear_scene, &spoils);
}

#[test]
fn every_number_is_finite() {
    let spoils: [(Spoil, &str); 8] = [
        (
            |scene| scene.problem.chain[0][1] = f64::NAN,
            "`transition[0]` has an entry that is not finite (zhu2016 (54))",
        ),
        (
            |scene| scene.problem.modes[1].motion.matrix_mut().unwrap()[(3, 1)] = f64::INFINITY,
            "`modes[1].F` has an entry that is not finite (liu2017 (26))",
        ),
        (
            |scene| scene.problem.modes[2].noise[(0, 0)] = f64::NAN,
            "`modes[2].Q` has an entry that is not finite (liu2017 (17))",
        ),
        (
            |scene| scene.problem.measurement_noise[(1, 1)] = f64::INFINITY,
            "`R` has an entry that is not finite (liu2017 (19))",
        ),
        (
            |scene| scene.initial.modes[0].mean[2] = f64::NEG_INFINITY,
            "`initial.modes[0].mean` has an entry that is not finite (zhu2016 (55))",
        ),
        (
            |scene| scene.initial.modes[2].covariance[(3, 0)] = f64::NAN,
            "`initial.modes[2].covariance` has an entry that is not finite (zhu2016 (56))",
        ),
        (
            |scene| scene.initial.mode_probabilities[0] = f64::NAN,
            "`initial.mode_probabilities` has an entry that is not finite (zhu2016 (54))",
        ),
        (
            |scene| {
                let h = matrix![1.0, 0.0, 0.0, 0.0; 0.0, 0.0, f64::NAN, 0.0];
                scene.problem.sensor = Sensor::Linear(h);
            },
            "`measurement.H` has an entry that is not finite (zhu2016 (62))",
        ),
    ];
    assert_sentences(linear_scene, &spoils);

    let mut scene = polar_scene("cubature-5");
    scene.problem.sensor = polar([0, 2], [0.0, f64::INFINITY]);
    assert_sentence(
        &scene,
        "`measurement.sensor` has an entry that is not finite (liu2017 (31))",
    );
}

/// One bit is enough: nothing is symmetrised.
#[test]
fn covariances_are_symmetric_to_the_last_bit() {
    let spoils: [(Spoil, &str); 3] = [
        (
            |scene| scene.problem.modes[0].noise[(1, 0)] = 0.5_f64.next_up(),
            "`modes[0].Q` is not symmetric (liu2017 (17))",
        ),
        (
            |scene| scene.problem.measurement_noise[(0, 1)] = f64::MIN_POSITIVE,
            "`R` is not symmetric (liu2017 (19))",
        ),
        (
            |scene| scene.initial.modes[1].covariance[(0, 2)] += 1.0,
            "`initial.modes[1].covariance` is not symmetric (zhu2016 (56))",
        ),
    ];
    assert_sentences(linear_scene, &spoils);
}

/// Both eigenvalue signs, and a matrix whose diagonal hides that it is indefinite.
#[test]
fn covariances_are_positive_semidefinite() {
    let spoils: [(Spoil, &str); 7] = [
        (
            |scene| scene.problem.modes[1].noise[(2, 2)] = -1.0,
            "`modes[1].Q` is not positive semidefinite (liu2017 (17))",
        ),
        (
            // A negative variance and nothing else.
            |scene| {
                scene.problem.modes[1].noise.fill(0.0);
                scene.problem.modes[1].noise[(2, 2)] = -1.0;
            },
            "`modes[1].Q` is not positive semidefinite (liu2017 (17))",
        ),
        (
            // A covariance without variances.
            |scene| {
                scene.problem.modes[1].noise.fill(0.0);
                scene.problem.modes[1].noise[(0, 2)] = 1.0;
                scene.problem.modes[1].noise[(2, 0)] = 1.0;
            },
            "`modes[1].Q` is not positive semidefinite (liu2017 (17))",
        ),
        (
            |scene| {
                scene.problem.modes[1].noise[(0, 2)] = 5.0;
                scene.problem.modes[1].noise[(2, 0)] = 5.0;
            },
            "`modes[1].Q` is not positive semidefinite (liu2017 (17))",
        ),
        (
            |scene| scene.problem.measurement_noise[(1, 1)] = -1.0,
            "`R` is not positive semidefinite (liu2017 (19))",
        ),
        (
            |scene| {
                // The x-position and its velocity, correlated by more than one.
                scene.initial.modes[2].covariance[(0, 1)] = 5000.0;
                scene.initial.modes[2].covariance[(1, 0)] = 5000.0;
            },
            "`initial.modes[2].covariance` is not positive semidefinite (zhu2016 (56))",
        ),
        (
            |scene| scene.initial.modes[0].covariance[(0, 0)] = -1.0,
            "`initial.modes[0].covariance` is not positive semidefinite (zhu2016 (56))",
        ),
    ];
    assert_sentences(linear_scene, &spoils);

    // A process noise may have any rank: no noise at all is no mistake.
    let mut scene = linear_scene();
    for mode in &mut scene.problem.modes {
        mode.noise.fill(0.0);
    }
    assert!(scene.filter().is_ok());
}

/// The linear scene, whose noises have a covariance in common.
fn with_noise_in_common(filter: Filter<f64, U4, U2>, entry: f64) -> Scene {
    let mut scene = linear_scene();
    let mut of_noises = SMatrix::<f64, 4, 2>::zeros();
    of_noises[(1, 0)] = entry;
    scene.problem.filters = vec![filter.with_noise_cross_covariance(of_noises)];
    scene
}

/// E[w vᵀ]² is at most E[w²] E[v²]: here the greatest noise of vx is that of the first mode.
#[test]
fn noises_have_no_more_in_common_than_they_have() {
    let scene = linear_scene();
    let greatest = (scene.problem.modes[0].noise[(1, 1)] * scene.problem.measurement_noise[(0, 0)]).sqrt();
    assert!(with_noise_in_common(Filter::kalman(), 0.4 * greatest).filter().is_ok());
    assert_sentence(
        &with_noise_in_common(Filter::extended(), 1.1 * greatest),
        "`modes[0].M` is more than Q and R allow: [[Q, M], [Mᵀ, R]] is not positive semidefinite (Simon 2006, section 7.1)",
    );
    assert_sentence(
        &with_noise_in_common(Filter::kalman(), f64::NAN),
        "`modes[0].M` has an entry that is not finite (Simon 2006, section 7.1)",
    );
}

#[test]
fn correlated_noises_are_for_matrices_and_slopes() {
    let points = Filter::points(rule_of("cubature-5"));
    // Points for the motion see no measurement.
    let moved = Filter {
        predict: points.predict.clone(),
        ..Filter::kalman()
    };
    assert!(with_noise_in_common(moved, 1e-3).filter().is_ok());
    assert_sentence(
        &with_noise_in_common(points, 1e-3),
        "`modes[0].M` is given to a filter that takes no noise that is correlated; use a Kalman or an extended filter (Simon 2006, section 7.1)",
    );
}

#[test]
fn the_kalman_filter_has_linear_measurements_only() {
    let points = || Filter::points(rule_of("cubature-5"));
    // Points for the motion see no measurement.
    let moved = Filter {
        predict: points().predict,
        ..Filter::kalman()
    };
    for filters in [
        vec![Filter::kalman()],
        vec![points(), points(), Filter::kalman()],
        vec![moved],
    ] {
        let mut scene = polar_scene("cubature-5");
        scene.problem.filters = filters;
        assert_sentence(
            &scene,
            "`measurement` is not linear, and the Kalman filter takes matrices; use an extended, unscented or cubature filter (zhu2016 (42))",
        );
    }
}

/// The motion of a mode is that mode's filter's matter: others may draw points.
#[test]
fn the_kalman_filter_has_linear_motions_only() {
    let names = ["x", "vx", "y", "vy"];
    let formulas = [("x", "x + vx*vx"), ("vx", "vx"), ("y", "y"), ("vy", "vy")];
    let function = Arc::new(Function::of_formulas(&names, &[], &[], &[], &formulas).unwrap());
    let points = || Filter::points(rule_of("cubature-5"));
    let measured = Filter {
        predict: Transform::Exact,
        ..points()
    };
    for (filters, is_accepted) in [
        (vec![Filter::kalman()], false),
        (vec![points(), Filter::kalman(), points()], false),
        (vec![measured], false),
        (fixed_gain_scene().problem.filters, false),
        (vec![Filter::kalman(), points(), Filter::kalman()], true),
    ] {
        let mut scene = linear_scene();
        scene.problem.filters = filters;
        scene.problem.modes[1].motion = Motion::Function {
            function: function.clone(),
            given: vec![],
        };
        if is_accepted {
            assert!(scene.filter().is_ok());
        } else {
            assert_sentence(
                &scene,
                "`modes[1].f` is not linear, and the Kalman filter takes matrices; use an extended, unscented or cubature filter (zhu2016 (42))",
            );
        }
    }
}

#[test]
fn gains_are_given_to_all_modes_or_to_none() {
    let sentence = "`filters` has given gains for some modes only; estimates with and without covariances cannot be mixed (derbez2000 (2))";
    for j in 0..3 {
        // One of three computes its own gain, with the covariances of the one kind and of the other.
        let mut scene = fixed_gain_scene();
        scene.problem.filters[j] = Filter::kalman();
        assert_sentence(&scene, sentence);
        scene.initial = linear_scene().initial;
        assert_sentence(&scene, sentence);
        // One of three is given.
        let mut scene = linear_scene();
        scene.problem.filters = vec![Filter::points(rule_of("unscented")); 3];
        scene.problem.filters[j] = fixed_gain_scene().problem.filters[j].clone();
        assert_sentence(&scene, sentence);
    }
    // One for all is given to all.
    let mut scene = fixed_gain_scene();
    scene.problem.filters.truncate(1);
    assert!(scene.filter().is_ok());
}

/// There is nothing that points could be drawn from.
#[test]
fn a_filter_with_a_given_gain_draws_no_points() {
    let mut scene = fixed_gain_scene();
    for filter in &mut scene.problem.filters {
        filter.predict = Transform::Points(rule_of("cubature-3"));
    }
    assert_sentence(
        &scene,
        "`filters` has a given gain and draws points; without a covariance there is nothing to draw them from (derbez2000 (2))",
    );
}

#[test]
fn a_filter_with_fixed_gains_has_no_covariance() {
    let mut scene = fixed_gain_scene();
    scene.initial.modes[1].covariance[(2, 2)] = 1.0;
    assert_sentence(
        &scene,
        "`initial.modes[1].covariance` is given, but filters with fixed gains have no covariance (derbez2000 (2))",
    );
}

#[test]
fn fixed_gains_are_checked_mode_by_mode() {
    let with = |spoil: fn(&mut Vec<FixedGain<f64, U4, U2>>)| {
        let mut scene = fixed_gain_scene();
        let filters = std::mem::take(&mut scene.problem.filters);
        let mut modes: Vec<_> = filters.into_iter().filter_map(given).collect();
        spoil(&mut modes);
        scene.problem.filters = modes.into_iter().map(Filter::given).collect();
        scene
    };
    assert_sentence(
        &with(|modes| modes.truncate(2)),
        "`filters` has 2 entries where there are 3 modes (zhu2016 (55))",
    );
    assert_sentence(
        &with(|modes| modes[1].gain[(3, 1)] = f64::INFINITY),
        "`filter.modes[1].gain` has an entry that is not finite (derbez2000 (2))",
    );
    assert_sentence(
        &with(|modes| modes[2].innovation_covariance[(0, 0)] = f64::NAN),
        "`filter.modes[2].innovation_covariance` has an entry that is not finite (derbez2000 (4))",
    );
    assert_sentence(
        &with(|modes| modes[2].innovation_covariance[(0, 1)] += 1.0),
        "`filter.modes[2].innovation_covariance` is not symmetric (derbez2000 (4))",
    );
    assert_sentence(
        &with(|modes| modes[0].innovation_covariance[(1, 1)] = -900.0),
        "`filter.modes[0].innovation_covariance` is not positive definite (derbez2000 (4))",
    );

    let mut scene = fixed_gain_scene();
    scene.problem.sensor = polar([0, 2], [0.0, 0.0]);
    assert_sentence(
        &scene,
        "`measurement` is not linear, and the Kalman filter takes matrices; use an extended, unscented or cubature filter (zhu2016 (42))",
    );
    assert!(fixed_gain_scene().filter().is_ok());
}

#[test]
fn a_rule_has_one_weight_a_point() {
    // Of the rule for the motion and of the one for the measurement, of one filter for all and of one of three.
    for (filters, j, transform) in [(1, 0, 0), (1, 0, 1), (3, 0, 1), (3, 2, 0), (3, 2, 1)] {
        let with = |spoil: fn(&mut Rule<f64, U4>)| {
            let mut scene = polar_scene("cubature-3");
            scene.problem.filters = vec![scene.problem.filters[0].clone(); filters];
            spoil(scene.problem.filters[j].rules_mut()[transform].as_mut().unwrap());
            scene
        };
        assert_sentence(
            &with(|rule| rule.points.truncate(7)),
            "`rule` has 7 points, 8 weights and 8 covariance weights (zhu2016 (21))",
        );
        assert_sentence(
            &with(|rule| rule.weights.push(0.0)),
            "`rule` has 8 points, 9 weights and 8 covariance weights (zhu2016 (21))",
        );
        assert_sentence(
            &with(|rule| rule.covariance_weights.clear()),
            "`rule` has 8 points, 8 weights and 0 covariance weights (zhu2016 (21))",
        );
    }
}

/// Nothing has no mean.
#[test]
fn a_rule_has_points() {
    for transform in [0, 1] {
        let mut scene = linear_scene_with("cubature-3");
        if let Some(rule) = &mut scene.problem.filters[0].rules_mut()[transform] {
            rule.points.clear();
            rule.weights.clear();
            rule.covariance_weights.clear();
        }
        assert_sentence(
            &scene,
            "`rule` has 0 points, 0 weights and 0 covariance weights (zhu2016 (21))",
        );
    }
}

#[test]
fn the_measured_position_is_in_the_state() {
    let mut scene = polar_scene("cubature-5");
    scene.problem.sensor = polar([0, 4], [0.0, 0.0]);
    assert_sentence(
        &scene,
        "`measurement.position` names entry 4 of a state of 4 (liu2017 (31))",
    );
}

// Sides that are known at run time

/// A problem of three modes with sides that are known at run time: n components of the state, m of the measurement, which is linear or
/// range and bearing; a filter with points, one with points for the measurement only, and a third with points.
fn at_run_time(n: usize, m: usize, is_polar: bool) -> (Problem<f64, Dyn, Dyn>, Initial<f64, Dyn>) {
    let rule = || RuleName::ThirdDegree.rule_in(Dyn(n)).unwrap();
    let mode = |name: &str| Mode {
        name: name.to_owned(),
        motion: Motion::Linear(DMatrix::identity(n, n)),
        noise: DMatrix::identity(n, n),
    };
    let measured = Filter {
        predict: Transform::Exact,
        update: Update::By(Transform::Points(rule())),
        noise_cross_covariance: None,
    };
    let linear = Sensor::Linear(DMatrix::identity(m, n));
    let polar = Sensor::Polar {
        components: vec![PolarComponent::Range; m],
        position: [0, 1],
        location: [0.0, 0.0],
    };
    let problem = Problem {
        modes: vec![mode("one"), mode("two"), mode("three")],
        filters: vec![Filter::points(rule()), measured, Filter::points(rule())],
        interaction: Interaction::Imm,
        angles: vec![],
        chain: vec![vec![0.5, 0.25, 0.25]; 3],
        sensor: if is_polar { polar } else { linear },
        measurement_noise: DMatrix::identity(m, m),
    };
    let estimate = Gaussian {
        mean: DVector::from_element(n, 10.0),
        covariance: DMatrix::identity(n, n),
    };
    let initial = Initial {
        modes: vec![estimate; 3],
        mode_probabilities: vec![0.5, 0.25, 0.25],
    };
    (problem, initial)
}

/// A way to make a problem of this kind wrong.
type SpoilShape = fn(&mut Problem<f64, Dyn, Dyn>, &mut Initial<f64, Dyn>);

/// n = 3, m = 2. Shapes in types cannot be wrong.
#[test]
fn every_matrix_has_the_shape_that_the_state_and_the_measurement_ask_for() {
    let spoils: [(SpoilShape, &str); 15] = [
        // The motion of the first mode says how large the state is, so that all else is wrong with it.
        (
            |problem, _| problem.modes[0].motion = Motion::Linear(DMatrix::identity(4, 4)),
            "`modes[0].Q` is 3 × 3 where 4 × 4 is needed",
        ),
        (
            |problem, _| problem.modes[0].noise = DMatrix::identity(4, 4),
            "`modes[0].Q` is 4 × 4 where 3 × 3 is needed",
        ),
        (
            |problem, _| problem.modes[0].motion = Motion::Linear(DMatrix::identity(3, 4)),
            "`modes[0].F` is 3 × 4 where 3 × 3 is needed",
        ),
        (
            |problem, _| problem.modes[1].motion = Motion::Linear(DMatrix::identity(2, 3)),
            "`modes[1].F` is 2 × 3 where 3 × 3 is needed",
        ),
        (
            |problem, _| problem.modes[2].noise = DMatrix::identity(2, 2),
            "`modes[2].Q` is 2 × 2 where 3 × 3 is needed",
        ),
        (
            |problem, _| problem.measurement_noise = DMatrix::identity(2, 3),
            "`R` is 2 × 3 where 2 × 2 is needed",
        ),
        (
            |problem, _| problem.measurement_noise = DMatrix::identity(3, 3),
            "`measurement.H` is 2 × 3 where 3 × 3 is needed",
        ),
        (
            |problem, _| problem.sensor = Sensor::Linear(DMatrix::identity(2, 4)),
            "`measurement.H` is 2 × 4 where 2 × 3 is needed",
        ),
        (
            |_, initial| initial.modes[1].mean = DVector::zeros(2),
            "`initial.modes[1].mean` is 2 × 1 where 3 × 1 is needed",
        ),
        (
            |_, initial| initial.modes[2].covariance = DMatrix::identity(3, 2),
            "`initial.modes[2].covariance` is 3 × 2 where 3 × 3 is needed",
        ),
        // A rule of another dimension, for the motion and for the measurement; and one with a point that is not like its others.
        (
            |problem, _| problem.filters[0] = Filter::points(RuleName::FifthDegree.rule_in(Dyn(2)).unwrap()),
            "`rule.points[0]` is 2 × 1 where 3 × 1 is needed",
        ),
        (
            |problem, _| {
                let rule = RuleName::ThirdDegree.rule_in(Dyn(4)).unwrap();
                problem.filters[1].update = Update::By(Transform::Points(rule));
            },
            "`rule.points[0]` is 4 × 1 where 3 × 1 is needed",
        ),
        (
            |problem, _| {
                if let [Some(rule), _] = problem.filters[2].rules_mut() {
                    rule.points[5] = dvector![1.0];
                }
            },
            "`rule.points[5]` is 1 × 1 where 3 × 1 is needed",
        ),
        (
            |problem, initial| given_at_run_time(problem, initial, (2, 3), (2, 2)),
            "`filter.modes[2].gain` is 2 × 3 where 3 × 2 is needed",
        ),
        (
            |problem, initial| given_at_run_time(problem, initial, (3, 2), (3, 2)),
            "`filter.modes[2].innovation_covariance` is 3 × 2 where 2 × 2 is needed",
        ),
    ];
    for (spoil, sentence) in spoils {
        let (mut problem, mut initial) = at_run_time(3, 2, false);
        spoil(&mut problem, &mut initial);
        let error = Imm::new(problem, &initial).unwrap_err();
        assert_eq!(error.to_string(), sentence);
    }
    // As many components are reported as R has variances.
    for m in [0, 1, 3] {
        let (mut problem, initial) = at_run_time(3, 2, true);
        if let Sensor::Polar { components, .. } = &mut problem.sensor {
            components.resize(m, PolarComponent::Range);
        }
        let error = Imm::new(problem, &initial).unwrap_err();
        let sentence = format!("`measurement.components` is {m} × 1 where 2 × 1 is needed");
        assert_eq!(error.to_string(), sentence);
    }
    // The components of a sensor are a list even where all sides are types.
    let mut scene = polar_scene("cubature-3");
    if let Sensor::Polar { components, .. } = &mut scene.problem.sensor {
        components.push(PolarComponent::Range);
    }
    assert_sentence(&scene, "`measurement.components` is 3 × 1 where 2 × 1 is needed");
}

/// Gives a problem of n = 3 and m = 2 gains, the last of them with these shapes.
fn given_at_run_time(
    problem: &mut Problem<f64, Dyn, Dyn>,
    initial: &mut Initial<f64, Dyn>,
    gain: (usize, usize),
    covariance: (usize, usize),
) {
    let given = |gain: (usize, usize), covariance: (usize, usize)| {
        Filter::given(FixedGain {
            gain: DMatrix::identity(gain.0, gain.1),
            innovation_covariance: DMatrix::identity(covariance.0, covariance.1),
        })
    };
    let right = given((3, 2), (2, 2));
    problem.filters = vec![right.clone(), right, given(gain, covariance)];
    for estimate in &mut initial.modes {
        estimate.covariance.fill(0.0);
    }
}

/// A function of the state gives a state, from a state, and has the values of what it is given besides.
#[test]
fn functions_have_the_shapes_that_the_state_and_the_measurement_ask_for() {
    let step = |names: &[&str], given: &[&str]| {
        let formulas: Vec<_> = names.iter().map(|name| (*name, *name)).collect();
        Arc::new(Function::of_formulas(names, given, &[], &[], &formulas).unwrap())
    };
    let still = |given: Vec<f64>| Motion::Function {
        function: step(&["x", "y", "z"], &["T"]),
        given,
    };
    let flat = || Motion::Function {
        function: step(&["x", "y"], &[]),
        given: vec![],
    };
    let space = |names: &[&str]| {
        let components = names.iter().map(|name| Component::number(name, "m")).collect();
        Arc::new(Space::new(components).unwrap())
    };
    let seen = |function: &Arc<Function>, names: &[&str]| Sensor::Function {
        function: function.clone(),
        space: space(names),
        given: vec![],
    };
    let measure =
        |formulas: &[(&str, &str)]| Arc::new(Function::of_formulas(&["x", "y", "z"], &[], &[], &[], formulas).unwrap());
    let (one, two) = (measure(&[("a", "x*y")]), measure(&[("a", "x*y"), ("b", "z")]));
    let run = |spoil: &dyn Fn(&mut Problem<f64, Dyn, Dyn>)| {
        let (mut problem, initial) = at_run_time(3, 2, false);
        problem.filters.truncate(1);
        spoil(&mut problem);
        Imm::new(problem, &initial)
            .map(|_| ())
            .map_err(|error| error.to_string())
    };
    let refused = |spoil: &dyn Fn(&mut Problem<f64, Dyn, Dyn>), sentence: &str| {
        assert_eq!(run(spoil), Err(sentence.to_owned()));
    };
    assert_eq!(run(&|problem| problem.modes[1].motion = still(vec![1.0])), Ok(()));
    assert_eq!(run(&|problem| problem.sensor = seen(&two, &["a", "b"])), Ok(()));

    refused(
        &|problem| problem.modes[1].motion = flat(),
        "`modes[1].f` is 2 × 2 where 3 × 3 is needed",
    );
    // That of the first mode says how large the state is, so that all else is wrong with it.
    refused(
        &|problem| problem.modes[0].motion = flat(),
        "`modes[0].Q` is 3 × 3 where 2 × 2 is needed",
    );
    refused(
        &|problem| problem.modes[2].motion = still(vec![]),
        "`modes[2].f` is 0 × 1 where 1 × 1 is needed",
    );
    refused(
        &|problem| problem.modes[2].motion = still(vec![f64::NAN]),
        "`modes[2].f` has an entry that is not finite (liu2017 (1))",
    );
    refused(
        &|problem| problem.sensor = seen(&one, &["a", "b"]),
        "`measurement` is 1 × 3 where 2 × 3 is needed",
    );
    refused(
        &|problem| problem.sensor = seen(&two, &["a", "b", "c"]),
        "`measurement` is 3 × 1 where 2 × 1 is needed",
    );
    let offset = |offset: &[f64]| Motion::Affine {
        matrix: DMatrix::identity(3, 3),
        offset: DVector::from_column_slice(offset),
    };
    refused(
        &|problem| problem.modes[1].motion = offset(&[1.0]),
        "`modes[1].f` is 1 × 1 where 3 × 1 is needed",
    );
    refused(
        &|problem| problem.modes[1].motion = offset(&[1.0, f64::INFINITY, 0.0]),
        "`modes[1].f` has an entry that is not finite (liu2017 (1))",
    );
    // Where the sides are types a function is what can have another one.
    for j in [0, 1] {
        let mut scene = polar_scene("cubature-3");
        scene.problem.modes[j].motion = Motion::Function {
            function: step(&["x", "y", "z"], &[]),
            given: vec![],
        };
        assert_sentence(&scene, &format!("`modes[{j}].f` is 3 × 3 where 4 × 4 is needed"));
    }
}

/// What is said of lists is said of them with sides that are known at run time too.
#[test]
fn problems_with_sides_known_at_run_time_are_checked_alike() {
    let spoils: [(SpoilShape, &str); 7] = [
        (
            |problem, _| problem.filters.truncate(2),
            "`filters` has 2 entries where there are 3 modes (zhu2016 (55))",
        ),
        (
            |problem, _| problem.filters.clear(),
            "`filters` is empty; the modes need one each, or one for all (zhu2016 (55))",
        ),
        (
            |_, initial| initial.modes.truncate(2),
            "`initial.modes` has 2 entries where there are 3 modes (zhu2016 (55))",
        ),
        (
            |problem, _| problem.filters[1] = Filter::converted(Conversion::Standard),
            "`measurement.components` must be one range and one bearing to be converted to a position (sustika2015 (20))",
        ),
        (
            |problem, _| {
                let given = FixedGain {
                    gain: DMatrix::identity(3, 2),
                    innovation_covariance: DMatrix::identity(2, 2),
                };
                problem.filters[1] = Filter::given(given);
            },
            "`filters` has given gains for some modes only; estimates with and without covariances cannot be mixed (derbez2000 (2))",
        ),
        (
            |problem, _| problem.measurement_noise[(0, 1)] = 0.5,
            "`R` is not symmetric (liu2017 (19))",
        ),
        (
            |problem, _| {
                let (components, location) = (vec![PolarComponent::Range; 2], [0.0, 0.0]);
                problem.sensor = Sensor::Polar {
                    components,
                    position: [2, 3],
                    location,
                };
            },
            "`measurement.position` names entry 3 of a state of 3 (liu2017 (31))",
        ),
    ];
    for (spoil, sentence) in spoils {
        let (mut problem, mut initial) = at_run_time(3, 2, false);
        spoil(&mut problem, &mut initial);
        let error = Imm::new(problem, &initial).unwrap_err();
        assert_eq!(error.to_string(), sentence);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever the shapes are, nothing panics: where one matrix has another shape it is named, and where none has the problem runs.
    #[test]
    fn a_matrix_of_another_shape_is_named(
        n in 2..5_usize, m in 1..4_usize, is_polar: bool, which in 0..9_usize, rows in 0..6_usize, columns in 0..6_usize, k in 1..3_usize,
    ) {
        let (mut problem, mut initial) = at_run_time(n, m, is_polar);
        let other = DMatrix::identity(rows, columns);
        let (field, expected) = match which {
            0 => {
                problem.modes[k].motion = Motion::Linear(other);
                (format!("modes[{k}].F"), (n, n))
            }
            1 => {
                problem.modes[k].noise = other;
                (format!("modes[{k}].Q"), (n, n))
            }
            2 => {
                initial.modes[k].covariance = other;
                (format!("initial.modes[{k}].covariance"), (n, n))
            }
            3 => {
                initial.modes[k].mean = DVector::zeros(rows);
                (format!("initial.modes[{k}].mean"), (n, 1))
            }
            4 => {
                problem.sensor = Sensor::Linear(other);
                ("measurement.H".to_owned(), (m, n))
            }
            5 => {
                // R has the right number of rows: it is these that say how many there are.
                problem.measurement_noise = DMatrix::identity(m, columns);
                ("R".to_owned(), (m, m))
            }
            6 => {
                problem.modes[0].motion = Motion::Linear(DMatrix::identity(n, columns));
                ("modes[0].F".to_owned(), (n, n))
            }
            7 => {
                for rule in problem.filters[k].rules_mut().into_iter().flatten() {
                    rule.points[k] = DVector::zeros(rows);
                }
                (format!("rule.points[{k}]"), (n, 1))
            }
            _ => ("nothing".to_owned(), (0, 0)),
        };
        let found = match which {
            0 | 1 | 2 | 4 => (rows, columns),
            3 | 7 => (rows, 1),
            5 => (m, columns),
            6 => (n, columns),
            _ => expected,
        };
        match Imm::new(problem, &initial) {
            Ok(mut filter) => {
                prop_assert_eq!(found, expected);
                let step = filter.step(Some(&DVector::from_element(m, 10.0))).unwrap();
                prop_assert_eq!(step.combined.mean.len(), n);
                prop_assert_eq!(filter.step(None).unwrap().step, 2);
            }
            Err(error) => prop_assert_eq!(error, InvalidProblem::Shape { field, found, expected }),
        }
    }
}

// A problem that changes

/// A wrong problem is refused in the middle of a run with the sentence that it has at the start, and the run goes on with the right one.
#[test]
fn a_filter_keeps_its_problem_when_it_is_to_go_on_with_a_wrong_one() {
    let spoils: [(Spoil, &str); 7] = [
        (
            |scene| scene.problem.filters.clear(),
            "`filters` is empty; the modes need one each, or one for all (zhu2016 (55))",
        ),
        (
            |scene| scene.problem.chain[1] = vec![0.5, 0.25, 0.125],
            "`transition[1]` sums to 0.875; it must sum to 1 (zhu2016 (54))",
        ),
        (
            |scene| scene.problem.modes[1].noise[(2, 2)] = -1.0,
            "`modes[1].Q` is not positive semidefinite (liu2017 (17))",
        ),
        (
            |scene| scene.problem.measurement_noise[(1, 1)] = -1.0,
            "`R` is not positive semidefinite (liu2017 (19))",
        ),
        (
            |scene| scene.problem.sensor = polar([0, 2], [0.0, 0.0]),
            "`measurement` is not linear, and the Kalman filter takes matrices; use an extended, unscented or cubature filter (zhu2016 (42))",
        ),
        (
            |scene| scene.problem.filters = vec![Filter::converted(Conversion::Standard)],
            "`measurement.components` must be one range and one bearing to be converted to a position (sustika2015 (20))",
        ),
        // Other modes are another run.
        (
            |scene| {
                scene.problem.modes.truncate(2);
                scene.problem.chain = vec![vec![0.5, 0.5]; 2];
            },
            "`initial.modes` has 3 entries where there are 2 modes (zhu2016 (55))",
        ),
    ];
    let right = linear_scene();
    let undisturbed = right.run();
    for (spoil, sentence) in spoils {
        let mut filter = right.filter().unwrap();
        for (z, expected) in right.measurements.iter().zip(&undisturbed) {
            let mut wrong = linear_scene();
            spoil(&mut wrong);
            let error = filter.change(wrong.problem).unwrap_err();
            assert_eq!(error.to_string(), sentence);
            assert_eq!(filter.problem(), &right.problem);
            let step = filter.step(z.as_ref()).unwrap();
            assert_eq!((&step.updated, &step.combined), (&expected.updated, &expected.combined));
        }
    }
}

/// A run with covariances goes on with covariances, and one without them has none to go on with.
#[test]
fn a_filter_does_not_go_on_with_gains_of_the_other_kind() {
    let (computed, given) = (linear_scene(), fixed_gain_scene());
    for (scene, other) in [(&computed, &given), (&given, &computed)] {
        let mut filter = scene.filter().unwrap();
        for (z, expected) in scene.measurements.iter().zip(scene.run()) {
            let refused = filter.change(other.problem.clone());
            assert_eq!(refused, Err(InvalidProblem::OtherKind));
            assert_eq!(filter.problem(), &scene.problem);
            let step = filter.step(z.as_ref()).unwrap();
            assert_eq!(step.combined.mean, expected.combined.mean);
        }
    }
}

/// A state has the sides that it had; a measurement may have others.
#[test]
fn a_filter_goes_on_with_another_sensor_and_not_with_another_state() {
    let (problem, initial) = at_run_time(3, 2, false);
    let mut filter = Imm::new(problem, &initial).unwrap();
    filter.step(Some(&dvector![10.0, 11.0])).unwrap();
    let error = filter.change(at_run_time(4, 2, false).0).unwrap_err();
    assert_eq!(
        error.to_string(),
        "`initial.modes[0].mean` is 3 × 1 where 4 × 1 is needed"
    );
    filter.step(Some(&dvector![9.0, 10.0])).unwrap();
    filter.change(at_run_time(3, 1, true).0).unwrap();
    assert_eq!(filter.step(Some(&dvector![14.0])).unwrap().gains[2].shape(), (3, 1));
    filter.step(None).unwrap();
    filter.change(at_run_time(3, 3, false).0).unwrap();
    assert_eq!(
        filter.step(Some(&dvector![9.0, 10.0, 11.0])).unwrap().gains[0].shape(),
        (3, 3)
    );
}

// The measured position

/// A target on the diagonal x = y is not where any other is. A converted measurement has the same position.
#[test]
fn the_measured_position_has_two_coordinates() {
    let twice = |index: usize| {
        let mut scenes = [
            polar_scene("cubature-5"),
            converted_scene(Conversion::Standard, [0.0, 0.0]),
        ];
        for scene in &mut scenes {
            scene.problem.sensor = polar([index, index], [0.0, 0.0]);
        }
        scenes
    };
    for scene in twice(0) {
        assert_sentence(
            &scene,
            "`measurement.position` names entry 0 twice; range and bearing need an x and a y (liu2017 (31))",
        );
    }
    // Of an entry that is not there it does not matter how often.
    for scene in twice(9) {
        assert_sentence(
            &scene,
            "`measurement.position` names entry 9 of a state of 4 (liu2017 (31))",
        );
    }
}

// Rules

#[test]
fn a_rule_that_does_not_exist_is_refused_with_the_names_of_those_that_do() {
    let error = "cubature-7".parse::<RuleName>().unwrap_err();
    assert_eq!(
        error.to_string(),
        "there is no rule `cubature-7`; there are cubature-3, unscented, cubature-5, simplex-5, gauss-hermite-2, gauss-hermite-3, \
         gauss-hermite-4, gauss-hermite-5, cubature-5-printed, simplex-5-printed-11, simplex-5-printed-16"
    );
    // All names that the sentence lists exist.
    for name in RuleName::NAMES {
        assert!(name.parse::<RuleName>().is_ok(), "{name}");
    }
    // Names are exact.
    for name in ["", "Cubature-3", " unscented", "gauss-hermite-6", "gauss-hermite"] {
        assert!(
            matches!(name.parse::<RuleName>(), Err(InvalidRule::UnknownName { .. })),
            "{name}"
        );
    }
}

#[test]
fn a_rule_has_a_least_dimension() {
    for (name, rule) in [
        ("cubature-3", "cubature-3"),
        ("unscented", "unscented"),
        ("cubature-5", "cubature-5"),
        ("cubature-5-printed", "cubature-5"),
    ] {
        let error = name.parse::<RuleName>().unwrap().exact(0).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!("the rule `{rule}` needs a dimension of at least 1, not 0")
        );
        assert_eq!(name.parse::<RuleName>().unwrap().rule::<f64, U0>().unwrap_err(), error);
    }
    let error = gauss_hermite::<f64, _>(U0, 3).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the rule `gauss-hermite` needs a dimension of at least 1, not 0"
    );
    for name in ["simplex-5", "simplex-5-printed-11", "simplex-5-printed-16"] {
        for n in 0..=1 {
            let sentence = name.parse::<RuleName>().unwrap().exact(n).unwrap_err().to_string();
            let beginning = format!("the rule `simplex-5` needs a dimension of at least 2, not {n}");
            assert!(sentence.starts_with(&beginning), "{sentence}");
            assert!(sentence.contains("liu2017"), "{sentence}");
        }
        assert!(name.parse::<RuleName>().unwrap().exact(2).is_ok());
    }
}

#[test]
fn unscented_points_are_at_a_real_distance() {
    let refused = |kappa: i64| {
        let error = unscented(4, &Parameters::of_kappa(Rational::new(kappa, 1))).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!(
                "the unscented parameters give n + lambda = {}, which must be positive: it is the square of the points' distance from the \
                 centre",
                4 + kappa
            )
        );
    };
    refused(-4);
    refused(-5);
    let undecided = Parameters::of_kappa(Rational::new(1, 0));
    assert!(matches!(unscented(4, &undecided), Err(InvalidRule::Radius { .. })));
    assert!(unscented(4, &Parameters::of_kappa(Rational::new(-3, 1))).is_ok());
}

#[test]
fn unscented_points_are_at_a_distance_that_has_an_exact_form() {
    let of_kappa = |kappa: &str| unscented(4, &Parameters::of_kappa(Rational::from_decimal(kappa).unwrap()));
    let sentence = of_kappa("0.12345678901234567891").unwrap_err().to_string();
    assert_eq!(
        sentence,
        "the unscented parameters give n + lambda = 412345678901234567891/100000000000000000000, whose root has too many digits to be \
         exact; give fewer decimals"
    );
    assert!(of_kappa("0.12345").is_ok());
}

#[test]
fn gauss_hermite_rules_have_two_to_five_nodes() {
    for nodes in [0, 1, 6, usize::MAX] {
        let sentence = format!("the Gauss-Hermite rule has 2 to 5 nodes a coordinate here, not {nodes}");
        assert_eq!(gauss_hermite::<f64, _>(U2, nodes).unwrap_err().to_string(), sentence);
        let by_name = RuleName::GaussHermite(nodes).rule::<f64, U2>();
        assert_eq!(by_name.unwrap_err().to_string(), sentence);
    }
    assert_eq!(
        RuleName::GaussHermite(3).exact(2).unwrap_err().to_string(),
        "the coordinates of a Gauss-Hermite product rule are nested roots, not surds"
    );
}

/// A number of points that no memory holds is refused before anything is computed, also one that no integer holds.
#[test]
fn a_product_rule_has_a_greatest_number_of_points() {
    let sentence = |n: usize| {
        format!(
            "the Gauss-Hermite rule with 5 nodes a coordinate has 5^{n} points in dimension {n}; at most {MOST_POINTS} are computed"
        )
    };
    assert_eq!(gauss_hermite::<f64, _>(U8, 5).unwrap_err().to_string(), sentence(8));
    let by_name = RuleName::GaussHermite(5).rule::<f64, U100>();
    assert_eq!(by_name.unwrap_err().to_string(), sentence(100));
    for n in [8, 28, 100, 1 << 32, usize::MAX] {
        assert_eq!(gauss_hermite::<f64, _>(Dyn(n), 5).unwrap_err().to_string(), sentence(n));
    }
    // The nodes are asked for first, so that a rule that does not exist has no number of points.
    assert!(matches!(
        gauss_hermite::<f64, _>(U100, 6),
        Err(InvalidRule::Nodes { nodes: 6 })
    ));
    assert_eq!(gauss_hermite::<f64, _>(U8, 3).unwrap().points.len(), 6561);
}

#[test]
fn a_rule_serves_states_of_its_own_dimension() {
    let exact = RuleName::FifthDegree.exact(3).unwrap();
    assert_eq!(
        Rule::<f64, U4>::from_exact(&exact).unwrap_err().to_string(),
        "a rule of dimension 3 cannot serve a state of dimension 4"
    );
    assert!(Rule::<f64, U3>::from_exact(&exact).is_ok());
}

#[test]
fn a_rule_is_listed_up_to_a_greatest_dimension() {
    let sentence = describe(&RuleName::Simplex, "simplex-5", 1_000_000)
        .unwrap_err()
        .to_string();
    assert!(
        sentence.starts_with("dimension 1000000 is too large to be listed; at most "),
        "{sentence}"
    );
    assert!(describe(&RuleName::Simplex, "simplex-5", 3).is_ok());
}

/// A step has one converted measurement, for all modes that use it.
#[test]
fn all_modes_that_convert_do_it_in_one_way() {
    let converted = Filter::converted;
    let points = || Filter::points(rule_of("cubature-3"));
    let with = |filters: [Filter<f64, U4, U2>; 3]| {
        let mut scene = converted_scene(Conversion::Standard, [0.0, 0.0]);
        scene.problem.filters = filters.to_vec();
        scene
    };
    for one in Conversion::ALL {
        for other in Conversion::ALL.into_iter().filter(|other| *other != one) {
            for filters in [
                [converted(one), converted(one), converted(other)],
                [converted(one), points(), converted(other)],
                [points(), converted(one), converted(other)],
            ] {
                assert_sentence(
                    &with(filters),
                    "`filters` has two conversions; all modes that convert the measurement need the same one (sustika2015 (22))",
                );
            }
        }
        // Not all modes need to convert.
        assert!(with([converted(one), points(), converted(one)]).try_run().is_ok());
    }
}

#[test]
fn a_conversion_needs_one_range_one_bearing_and_their_variances() {
    let refused = |scene: &Scene| scene.filter().unwrap_err().to_string();
    let mut scene = converted_scene(Conversion::Standard, [0.0, 0.0]);
    scene.problem.measurement_noise = matrix![1600.0, 0.01; 0.01, 49e-6];
    assert_eq!(
        refused(&scene),
        "`R` has a covariance between range and bearing; a conversion knows only their variances (sustika2015 (4))"
    );
    let sentence =
        "`measurement.components` must be one range and one bearing to be converted to a position (sustika2015 (20))";
    let mut scene = converted_scene(Conversion::Standard, [0.0, 0.0]);
    if let Sensor::Polar { components, .. } = &mut scene.problem.sensor {
        *components = vec![PolarComponent::Bearing; 2];
    }
    assert_eq!(refused(&scene), sentence);
    // A position that is measured as it is has nothing to be converted.
    let mut scene = linear_scene();
    scene.problem.filters = vec![
        Filter::kalman(),
        Filter::converted(Conversion::Standard),
        Filter::kalman(),
    ];
    assert_eq!(refused(&scene), sentence);
    // A third component has no place in a position, whatever it is.
    let scene = converted_scene(Conversion::Standard, [0.0, 0.0]);
    for third in [PolarComponent::Range, PolarComponent::Bearing] {
        let problem = Problem {
            modes: scene.problem.modes.clone(),
            chain: scene.problem.chain.clone(),
            sensor: Sensor::Polar {
                components: vec![PolarComponent::Range, PolarComponent::Bearing, third],
                position: [0, 2],
                location: [0.0, 0.0],
            },
            measurement_noise: Matrix3::identity(),
            filters: vec![Filter::converted(Conversion::Standard)],
            interaction: Interaction::Imm,
            angles: vec![],
        };
        let refused = Imm::new(problem, &scene.initial);
        assert_eq!(refused.err(), Some(InvalidProblem::NotRangeAndBearing));
    }
    // A noise may be zero; a variance below it is none.
    let mut scene = converted_scene(Conversion::Standard, [0.0, 0.0]);
    for place in [0, 1] {
        scene.problem.measurement_noise = Matrix2::from_diagonal(&vector![1600.0, 49e-6]);
        scene.problem.measurement_noise[(place, place)] = 0.0;
        assert!(scene.try_run().is_ok());
        scene.problem.measurement_noise[(place, place)] = -1e-6;
        assert_eq!(refused(&scene), "`R` is not positive semidefinite (liu2017 (19))");
    }
}

#[test]
fn angles_are_entries_of_the_state_each_named_once() {
    for (angles, index) in [(vec![4], 4), (vec![1, 3, 1], 1)] {
        let mut scene = polar_scene("cubature-3");
        scene.problem.angles = angles;
        assert_eq!(
            scene.filter().err().unwrap().to_string(),
            format!("`angles` names entry {index} of a state of 4; it is not there, or named twice")
        );
    }
}

/// Of the linear scene's three modes the second has a state of its own, as a matrix says; that conversion, changed, is wrong.
fn with_conversions(change: impl FnOnce(&mut StateConversions<f64, U4>)) -> Scene {
    let mut scene = linear_scene();
    let conversion = |from, to| StateConversion {
        from,
        to,
        map: Motion::Linear(Matrix4::identity() * 2.0),
        added: Matrix4::zeros(),
    };
    let mut conversions = StateConversions {
        list: vec![
            conversion(0, Reader::Mode(1)),
            conversion(2, Reader::Mode(1)),
            conversion(1, Reader::Mode(0)),
            conversion(1, Reader::Mode(2)),
            conversion(1, Reader::Common),
        ],
        angles: vec![vec![]; 3],
    };
    change(&mut conversions);
    scene.problem.interaction = Interaction::Converted(conversions);
    scene
}

#[test]
fn a_state_conversion_is_between_two_readers_and_there_once() {
    assert!(with_conversions(|_| {}).try_run().is_ok());
    let of = "(Granström, Willett and Bar-Shalom 2015)";
    let ends: [(usize, Reader, &str); 4] = [
        (3, Reader::Mode(1), "is of a mode that is not there"),
        (0, Reader::Mode(3), "is of a mode that is not there"),
        (
            1,
            Reader::Mode(1),
            "is from a mode to itself, which reads its own estimate as it is",
        ),
        (
            0,
            Reader::Mode(1),
            "is there twice; each reader reads a mode in one way",
        ),
    ];
    for (from, to, reason) in ends {
        let scene = with_conversions(|conversions| {
            (conversions.list[3].from, conversions.list[3].to) = (from, to);
        });
        assert_sentence(&scene, &format!("`conversions[3]` {reason} {of}"));
    }
    let scene = with_conversions(|conversions| drop(conversions.angles.pop()));
    assert_sentence(
        &scene,
        &format!("`conversions.angles` has 2 entries where there are 3 modes {of}"),
    );
    let scene = with_conversions(|conversions| conversions.angles[2] = vec![4]);
    assert_sentence(
        &scene,
        "`angles` names entry 4 of a state of 4; it is not there, or named twice",
    );
    let scene = with_conversions(|conversions| conversions.list[2].added[(1, 0)] = 1.0);
    assert_sentence(&scene, &format!("`conversions[2].added` is not symmetric {of}"));
    let scene = with_conversions(|conversions| conversions.list[2].added = indefinite_if(true));
    assert_sentence(
        &scene,
        &format!("`conversions[2].added` is not positive semidefinite {of}"),
    );
    let scene = with_conversions(|conversions| {
        conversions.list[4].map = Motion::Linear(Matrix4::identity() * f64::NAN);
    });
    assert_sentence(
        &scene,
        "`conversions[4].matrix` has an entry that is not finite (liu2017 (26))",
    );
}

#[test]
fn a_kalman_filter_needs_a_matrix_from_its_state_to_the_common_one() {
    let function = |results: usize| {
        let formulas = [("a", "a*a"), ("b", "b"), ("c", "c"), ("d", "d")];
        let function = Function::of_formulas(&["a", "b", "c", "d"], &[], &[], &[], &formulas[..results]).unwrap();
        Motion::Function {
            function: Arc::new(function),
            given: vec![],
        }
    };
    let mut scene = with_conversions(|conversions| conversions.list[4].map = function(4));
    assert_sentence(
        &scene,
        "`conversions[4].formulas` is not linear, and the Kalman filter takes matrices; use an extended, unscented or cubature filter \
         (zhu2016 (42))",
    );
    scene.problem.filters = vec![Filter::extended()];
    assert!(scene.filter().is_ok());
    // Between modes any function will do.
    assert!(
        with_conversions(|conversions| conversions.list[0].map = function(4))
            .filter()
            .is_ok()
    );
    let scene = with_conversions(|conversions| conversions.list[0].map = function(3));
    assert_sentence(&scene, "`conversions[0].formulas` is 3 × 4 where 4 × 4 is needed");
}

#[test]
fn a_filter_that_iterates_has_the_common_state() {
    let twice = Filter::iterated(NonZeroUsize::new(2).unwrap());
    let mut scene = with_conversions(|_| {});
    scene.problem.filters = vec![Filter::extended(), twice.clone(), Filter::extended()];
    assert_sentence(
        &scene,
        "`conversions[4]` is of a mode whose filter iterates; such a mode must have the problem's `state` (Granström, Willett and \
         Bar-Shalom 2015)",
    );
    scene.problem.filters = vec![twice, Filter::extended(), Filter::extended()];
    assert!(scene.filter().is_ok(), "the first mode has the common state");
}

#[test]
fn filters_with_fixed_gains_have_one_state() {
    let mut scene = fixed_gain_scene();
    scene.problem.interaction = with_conversions(|_| {}).problem.interaction;
    assert_sentence(
        &scene,
        "`conversions` are of means and covariances, and filters with fixed gains have no covariance; give all modes one state \
         (derbez2000 (2))",
    );
}

#[test]
fn a_negative_range_and_a_bearing_in_degrees_are_refused() {
    let failure = |z: Vector2<f64>| {
        let mut sentences = Vec::new();
        for scene in [
            converted_scene(Conversion::Standard, [0.0, 0.0]),
            polar_scene("cubature-3"),
        ] {
            sentences.push(scene.filter().unwrap().step(Some(&z)).unwrap_err().to_string());
        }
        assert_eq!(sentences[0], sentences[1]);
        sentences.remove(0)
    };
    assert_eq!(
        failure(vector![-3.0, 0.5]),
        "step 1, mode `all`, measurement: the measured range -3.0 is negative; a range is a distance"
    );
    assert_eq!(
        failure(vector![1414.0, 135.0]),
        "step 1, mode `all`, measurement: the measured bearing 135.0 is outside ±2π: is it in degrees?"
    );
}

// Coverage

/// Every variant of the library's errors has a test here: a new one does not compile until it has a line in one of the lists at the
/// end of this file, and a line must name a test that is here.
#[test]
fn every_error_has_a_test_in_this_file() {
    let source = include_str!("bad_input.rs");
    let quoted = source.split("=> \"").skip(1);
    let names: Vec<&str> = quoted.filter_map(|rest| rest.split('"').next()).collect();
    for name in &names {
        assert!(source.contains(&format!("#[test]\nfn {name}()")), "{name}");
    }
    assert!(names.contains(&problem_test(&InvalidProblem::NoModes)));
    assert!(names.contains(&rule_test(&InvalidRule::NestedRoots)));
    assert!(names.contains(&cause_test(&Cause::NoEvidence)));
}

// Steps

#[test]
fn a_measurement_is_finite() {
    for scene in [linear_scene(), polar_scene("simplex-5")] {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for component in 0..2 {
                let mut z = vector![1.0, 1.0];
                z[component] = bad;
                assert_failure(
                    &scene,
                    z,
                    "step 1, mode `all`, measurement: the measurement has an entry that is not finite",
                );
            }
        }
    }
}

/// Sides in types cannot be wrong; a measurement of another number of components, of a sensor of either kind, is refused.
#[test]
fn a_measurement_has_as_many_components_as_the_sensor_reports() {
    for is_polar in [false, true] {
        for components in [0, 1, 3, 100] {
            let (problem, initial) = at_run_time(3, 2, is_polar);
            let mut filter = Imm::new(problem, &initial).unwrap();
            let failure = filter.step(Some(&DVector::from_element(components, 10.0))).unwrap_err();
            let sentence =
                format!("step 1, mode `all`, measurement: the measurement has {components} components where R has 2");
            assert_eq!(failure.to_string(), sentence);
            assert_eq!(filter.current().step, 0);
            assert!(filter.step(Some(&dvector![10.0, 10.0])).is_ok());
        }
    }
}

#[test]
fn a_bearing_in_degrees_is_refused() {
    let scene = polar_scene("simplex-5");
    assert_failure(
        &scene,
        vector![15000.0, 176.25],
        "step 1, mode `all`, measurement: the measured bearing 176.25 is outside ±2π: is it in degrees?",
    );
    assert_failure(
        &scene,
        vector![15000.0, -6.5],
        "step 1, mode `all`, measurement: the measured bearing -6.5 is outside ±2π: is it in degrees?",
    );
    // Up to two turns apart a bearing is an angle in radians, wherever its owner cuts the circle; a range is not an angle.
    let two_turns = 2.0 * std::f64::consts::PI;
    for bearing in [6.25, two_turns, -two_turns] {
        let mut filter = scene.filter().unwrap();
        assert!(filter.step(Some(&vector![15000.0, bearing])).is_ok(), "{bearing}");
    }
}

#[test]
fn a_measurement_that_no_mode_can_explain_is_refused() {
    // The squared distance overflows: the log-likelihood is minus infinity in every mode.
    assert_failure(
        &linear_scene(),
        vector![1e200, 0.0],
        "step 1, mode `all`, mode_probabilities: the log-likelihood of the measurement under all modes together is not finite",
    );
}

#[test]
fn a_function_without_a_slope_where_it_is_linearised_is_named() {
    let mut scene = polar_scene("cubature-3");
    scene.problem.filters = vec![Filter::extended()];
    // The sensor stands where the first mode expects the target.
    let expected = scene.problem.modes[0].motion.of(&scene.initial.modes[0].mean);
    scene.problem.modes.truncate(1);
    scene.problem.chain = vec![vec![1.0]];
    scene.initial.modes.truncate(1);
    scene.initial.mode_probabilities = vec![1.0];
    let Sensor::Polar { position, location, .. } = &mut scene.problem.sensor else {
        panic!("a radar");
    };
    *location = position.map(|entry| expected[entry]);
    let (name, mut filter) = (scene.problem.modes[0].name.clone(), scene.filter().unwrap());
    let failure = filter.step(Some(&vector![10.0, 0.5])).unwrap_err();
    assert_eq!(
        failure.to_string(),
        format!(
            "step 1, mode `{name}`, measurement_jacobian: the function has no finite slope at the mean, as range and bearing have \
             none at the sensor"
        )
    );
    assert_eq!(filter.current().step, 0);
}

#[test]
fn a_plain_filter_has_as_many_modes_as_it_is_built_for() {
    let scene = linear_scene();
    let error = PlainImm::<f64, U4, U2, 2>::new(scene.problem.clone(), &scene.initial).unwrap_err();
    assert_eq!(
        error.to_string(),
        "`modes` has 3 entries where the filter is built for 2; give it as many modes as `MODES` says"
    );
    let mut wrong = scene.problem.clone();
    wrong.chain[0][0] = 0.5;
    let error = PlainImm::<f64, U4, U2, 3>::new(wrong.clone(), &scene.initial).unwrap_err();
    assert_eq!(error, Imm::new(wrong, &scene.initial).unwrap_err());
}

#[test]
fn the_filter_of_second_order_is_given_the_problem_of_the_interacting_one() {
    for interaction in [Interaction::Gpb1, Interaction::Unmixed] {
        let mut scene = linear_scene();
        scene.problem.interaction = interaction;
        let error = Gpb2::new(scene.problem, &scene.initial).unwrap_err();
        assert_eq!(
            error.to_string(),
            "`interaction` says which estimates the modes start from, and the filter of second order starts each from every one; use \
             `Interaction::Imm` (Chang and Athans 1978)"
        );
    }
}

#[test]
fn an_estimate_that_overflows_is_an_error_even_without_a_detection() {
    // Each prediction multiplies the covariances by 10²⁰⁰: the second one is beyond the doubles.
    let mut scene = linear_scene();
    for mode in &mut scene.problem.modes {
        *mode.motion.matrix_mut().unwrap() *= 1e100;
    }
    let mut filter = scene.filter().unwrap();
    assert!(filter.step(None).is_ok());
    let failure = filter.step(None).unwrap_err();
    assert_eq!(
        failure.to_string(),
        "step 2, mode `all`, combined: the combined estimate has an entry that is not finite",
    );
    assert_eq!(filter.current().step, 1);
}

#[test]
fn a_covariance_that_stops_being_positive_definite_is_named() {
    // A problem that is checked starts from covariances; an exchanged equation can give something else.
    let mut scene = linear_scene_with("cubature-5");
    scene.equations.mixed_covariance = |_, _, _, j| indefinite_if(j == 1);
    assert_failure(
        &scene,
        vector![0.0, 0.0],
        "step 1, mode `left turn`, predicted.mean: the mixed covariance is not positive definite: pivot 3 of 4 is not positive",
    );

    let mut scene = linear_scene_with("cubature-5");
    scene.equations.predicted_covariance = |_, _, _, j| indefinite_if(j == 2);
    assert_failure(
        &scene,
        vector![0.0, 0.0],
        "step 1, mode `right turn`, predicted_measurement: the predicted covariance is not positive definite: pivot 3 of 4 is not positive",
    );

    let mut scene = linear_scene();
    scene.equations.innovation_covariance = |_, _, _, _| matrix![1.0, 2.0; 2.0, 4.0];
    assert_failure(
        &scene,
        vector![0.0, 0.0],
        "step 1, mode `constant velocity`, gain: the innovation covariance is not positive definite: pivot 2 of 2 is not positive",
    );

    let mut scene = linear_scene();
    scene.equations.innovation_covariance = |_, _, _, _| matrix![f64::NAN, 0.0; 0.0, 1.0];
    assert_failure(
        &scene,
        vector![0.0, 0.0],
        "step 1, mode `constant velocity`, gain: the innovation covariance is not positive definite: pivot 1 of 2 is not a \
         number, or of undecided sign",
    );
}

/// The step of the failure is the step that failed, and its cause can be matched.
#[test]
fn a_failure_names_the_step_at_which_it_happened() {
    let mut filter = linear_scene().filter().unwrap();
    filter.step(Some(&vector![14800.0, 1200.0])).unwrap();
    filter.step(None).unwrap();
    let failure = filter.step(Some(&vector![f64::NAN, 0.0])).unwrap_err();
    assert_eq!(failure.step, 3);
    assert_eq!(failure.mode, "all");
    assert_eq!(failure.value, "measurement");
    assert_eq!(failure.cause, Cause::MeasurementNotFinite);
    assert_eq!(filter.current().step, 2);
}

// Matrices and angles

#[test]
fn a_factorisation_names_its_first_bad_pivot() {
    let pivot_of = |matrix: &Matrix2<f64>| cholesky(matrix).unwrap_err();
    let negative = pivot_of(&matrix![1.0, 2.0; 2.0, 3.0]);
    assert_eq!(
        negative,
        NotPositiveDefinite {
            pivot: 1,
            dimension: 2,
            decided: true
        }
    );
    assert_eq!(
        negative.to_string(),
        "is not positive definite: pivot 2 of 2 is not positive"
    );
    let zero = pivot_of(&matrix![0.0, 1.0; 1.0, 1.0]);
    assert_eq!((zero.pivot, zero.decided), (0, true));
    let undecided = pivot_of(&matrix![1.0, f64::NAN; f64::NAN, 1.0]);
    assert_eq!((undecided.pivot, undecided.decided), (1, false));
    assert_eq!(
        undecided.to_string(),
        "is not positive definite: pivot 2 of 2 is not a number, or of undecided sign"
    );
}

#[test]
fn what_is_not_an_angle_has_no_equivalent() {
    for bad in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 1e300, -1e16] {
        assert!(wrap(bad).is_nan(), "{bad}");
    }
}

// Garbage

/// Numbers of every kind that a double has.
fn any_double() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -10.0..10.0,
        2 => any::<f64>(),
        1 => prop::sample::select(vec![
            f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, f64::MIN_POSITIVE, 5e-324, -5e-324, 0.0, -0.0, 1.0, 1e-300,
            1e154, -1e154, 1e200,
        ]),
    ]
}

/// A 2 × 2 matrix of garbage: of anything, or symmetric, or a covariance of any size.
fn any_matrix() -> impl Strategy<Value = Matrix2<f64>> {
    (any_double(), any_double(), any_double(), any_double(), 0..3).prop_map(|(a, b, c, d, kind)| match kind {
        0 => matrix![a, b; c, d],
        1 => matrix![a, b; b, d],
        _ => matrix![a * a, 0.0; 0.0, d * d],
    })
}

/// A covariance that is right, or of any size, or garbage.
fn any_covariance() -> impl Strategy<Value = Matrix2<f64>> {
    let of_any_size = (any_double(), any_double()).prop_map(|(a, b)| matrix![a.abs(), 0.0; 0.0, b.abs()]);
    prop_oneof![
        6 => Just(matrix![4.0, 1.0; 1.0, 2.0]),
        4 => of_any_size,
        1 => any_matrix(),
    ]
}

/// A list of probabilities that is right, or garbage of any length.
fn any_probabilities() -> impl Strategy<Value = Vec<f64>> {
    prop_oneof![
        12 => Just(vec![0.5, 0.5]),
        4 => Just(vec![1.0, 0.0]),
        1 => prop::collection::vec(any_double(), 0..4),
    ]
}

/// Rules with the right number of weights and with garbage.
fn any_rule() -> impl Strategy<Value = Rule<f64, U2>> {
    let of_garbage = (
        prop::collection::vec((any_double(), any_double()), 0..4),
        prop::collection::vec(any_double(), 0..4),
    );
    prop_oneof![
        12 => prop::sample::select(vec!["cubature-3", "unscented", "cubature-5", "simplex-5"])
            .prop_map(|name| name.parse::<RuleName>().unwrap().rule().unwrap()),
        1 => of_garbage.prop_map(|(points, weights)| Rule {
            points: points.into_iter().map(|(x, y)| vector![x, y]).collect(),
            covariance_weights: weights.clone(),
            weights,
        }),
    ]
}

/// Filters of every kind, sensible and not.
fn any_filter() -> impl Strategy<Value = Filter<f64, U2, U2>> {
    let transform = || prop_oneof![Just(Transform::Exact), any_rule().prop_map(Transform::Points)];
    let update = prop_oneof![
        4 => transform().prop_map(Update::By),
        1 => Just(Update::Converted(Conversion::Standard)),
        1 => (any_matrix(), any_covariance())
            .prop_map(|(gain, innovation_covariance)| Update::Given(FixedGain { gain, innovation_covariance })),
    ];
    prop_oneof![
        8 => Just(Filter::kalman()),
        8 => any_rule().prop_map(Filter::points),
        2 => Just(Filter::converted(Conversion::ModifiedUnbiased)),
        4 => (transform(), update).prop_map(|(predict, update)| Filter { predict, update, noise_cross_covariance: None }),
        2 => any_matrix().prop_map(|of_noises| Filter::kalman().with_noise_cross_covariance(of_noises)),
    ]
}

/// One filter for all, mostly, or a list of any length.
fn any_filters() -> impl Strategy<Value = Vec<Filter<f64, U2, U2>>> {
    prop_oneof![
        12 => any_filter().prop_map(|filter| vec![filter]),
        4 => prop::collection::vec(any_filter(), 2..=2),
        1 => prop::collection::vec(any_filter(), 0..4),
    ]
}

/// Measurements with garbage in every field.
fn any_measurement() -> impl Strategy<Value = Sensor<f64, U2, U2>> {
    let polar = (0..2_usize, 0..=2_usize, any_double(), any_double()).prop_map(|(x, y, a, b)| Sensor::Polar {
        components: vec![PolarComponent::Range, PolarComponent::Bearing],
        position: [x, y],
        location: [a, b],
    });
    let of_any_length = prop::collection::vec(any::<bool>(), 0..4).prop_map(|bearings| {
        let component = |is_bearing| {
            if is_bearing {
                PolarComponent::Bearing
            } else {
                PolarComponent::Range
            }
        };
        Sensor::Polar {
            components: bearings.into_iter().map(component).collect(),
            position: [0, 1],
            location: [0.0, 0.0],
        }
    });
    prop_oneof![
        1 => of_any_length,
        1 => any_matrix().prop_map(Sensor::Linear),
        4 => Just(Sensor::Linear(Matrix2::identity())),
        4 => polar,
    ]
}

/// A whole problem of two modes, mostly, with garbage in every field.
fn any_problem() -> impl Strategy<Value = (Problem<f64, U2, U2>, Initial<f64, U2>)> {
    let mode = (any_matrix(), any_covariance()).prop_map(|(transition, noise)| Mode {
        name: "mode".to_owned(),
        motion: Motion::Linear(transition),
        noise,
    });
    let estimate = (any_double(), any_double(), any_covariance()).prop_map(|(x, y, covariance)| Gaussian {
        mean: vector![x, y],
        covariance,
    });
    let chain = prop_oneof![
        12 => Just(vec![vec![0.5, 0.5], vec![0.25, 0.75]]),
        4 => Just(vec![vec![1.0, 0.0], vec![0.0, 1.0]]),
        1 => prop::collection::vec(any_probabilities(), 0..4),
    ];
    let interaction = prop_oneof![3 => Just(Interaction::Imm), 1 => Just(Interaction::Unmixed)];
    let problem = (
        prop::collection::vec(mode, 2..=2),
        chain,
        any_measurement(),
        any_covariance(),
        any_filters(),
        interaction,
    );
    // Filters with given gains have no covariances.
    let initial = (
        prop::collection::vec(estimate, 2..=2),
        any_probabilities(),
        any::<bool>(),
    );
    (problem, initial).prop_map(
        |((modes, chain, sensor, measurement_noise, filters, interaction), (estimates, probabilities, is_right))| {
            let mut estimates = estimates;
            if is_right && filters.iter().any(|filter| !filter.has_covariances()) {
                for estimate in &mut estimates {
                    estimate.covariance.fill(0.0);
                }
            }
            (
                Problem {
                    modes,
                    filters,
                    interaction,
                    angles: Vec::new(),
                    chain,
                    sensor,
                    measurement_noise,
                },
                Initial {
                    modes: estimates,
                    mode_probabilities: probabilities,
                },
            )
        },
    )
}

/// What garbage comes to, counted: refused as a problem, failed in a step, ran.
#[derive(Debug, Default)]
struct Fates {
    refused: usize,
    failed: usize,
    ran: usize,
}

/// Nothing panics; an error has a sentence that names a field and an equation, or a step and a value; and a step with a measurement has
/// mode probabilities between zero and one.
#[test]
fn garbage_never_panics_and_either_errs_or_runs() {
    let mut fates = Fates::default();
    let fates_seen = std::cell::RefCell::new(&mut fates);
    let config = ProptestConfig {
        cases: 20_000,
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    let garbage = (
        any_problem(),
        prop::collection::vec((any_double(), any_double()), 1..4),
        any::<bool>(),
    );
    proptest!(config, |(((problem, initial), measurements, raw) in garbage)| {
            let mut fates = fates_seen.borrow_mut();
            let equations = if raw { Equations::standard().with_raw_moments() } else { Equations::standard() };
            let mut filter = match Imm::with_equations(problem, equations, &initial) {
                Ok(filter) => filter,
                Err(error) => {
                    fates.refused += 1;
                    let sentence = error.to_string();
                    prop_assert!(sentence.starts_with('`'), "{}", sentence);
                    // A shape has no equation of its own.
                    let has_equation = ["2000 (", "2006, ", "2015 (", "2016 (", "2017 ("].iter().any(|year| sentence.contains(year));
                    prop_assert!(has_equation || matches!(error, InvalidProblem::Shape { .. }), "{}", sentence);
                    return Ok(());
                }
            };
            let mut failed = false;
            for (x, y) in measurements {
                let before = filter.current().step;
                match filter.step(Some(&vector![x, y])) {
                    Ok(step) => {
                        for probability in &step.mode_probabilities {
    // However coarse the logarithms are, the greatest term is not above the sum.
                            prop_assert!((0.0..=1.0).contains(probability));
                        }
                    }
                    Err(failure) => {
                        failed = true;
                        prop_assert!(failure.to_string().starts_with("step "), "{}", failure);
                        let mut values = Quantity::ALL.iter().map(|quantity| quantity.name());
                        let is_named = values.any(|name| name == failure.value) || ["measurement", "combined"].contains(&failure.value);
                        prop_assert!(is_named, "{}", failure);
                        prop_assert_eq!(filter.current().step, before);
                    }
                }
                let _ = filter.step(None);
            }
            if failed {
                fates.failed += 1;
            } else {
                fates.ran += 1;
            }
        });
    // The garbage is worth its name, and not all of it is refused at the door.
    assert!(fates.refused > 1000, "{fates:?}");
    assert!(fates.failed > 50, "{fates:?}");
    assert!(fates.ran > 50, "{fates:?}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    /// The parts that the cycle is made of take garbage too.
    #[test]
    fn parts_take_garbage_without_a_panic(matrix in any_matrix(), angle in any_double(), interval in any_double()) {
        let _ = cholesky(&matrix);
        let factors = immaculate::matrix::ldl(&matrix);
        let _ = immaculate::matrix::check_positive_definite(&factors);
        let _ = immaculate::matrix::is_positive_semidefinite(&matrix);
        let _ = immaculate::gaussian::log_density(&vector![angle, interval], &factors);
        let _ = coordinated_turn(&angle, &interval);
        let wrapped = wrap(angle);
        prop_assert!(wrapped.is_nan() || (-std::f64::consts::PI < wrapped && wrapped <= std::f64::consts::PI));
    }
}

// Helpers

/// A way to make a right scene wrong.
type Spoil = fn(&mut Scene);

/// The scene is refused with this sentence.
fn assert_sentence(scene: &Scene, sentence: &str) {
    match scene.filter() {
        Ok(_) => panic!("accepted, but should say: {sentence}"),
        Err(error) => assert_eq!(error.to_string(), sentence),
    }
}

/// Each spoilt scene is refused with its sentence.
fn assert_sentences(right: fn() -> Scene, spoils: &[(Spoil, &str)]) {
    for (spoil, sentence) in spoils {
        let mut scene = right();
        spoil(&mut scene);
        assert_sentence(&scene, sentence);
    }
}

/// The first step fails with this sentence.
fn assert_failure(scene: &Scene, z: Vector2<f64>, sentence: &str) {
    let mut filter = scene.filter().expect("the scene is a valid problem");
    let failure = filter.step(Some(&z)).expect_err(sentence);
    assert_eq!(failure.to_string(), sentence);
}

/// Range and bearing of the entries `position` of the state.
fn polar(position: [usize; 2], location: [f64; 2]) -> Sensor<f64, U4, U2> {
    Sensor::Polar {
        components: vec![PolarComponent::Range, PolarComponent::Bearing],
        position,
        location,
    }
}

/// What a filter is given, if it is.
fn given(filter: Filter<f64, U4, U2>) -> Option<FixedGain<f64, U4, U2>> {
    match filter.update {
        Update::Given(given) => Some(given),
        _ => None,
    }
}

/// The identity, or with a third entry that makes it indefinite.
fn indefinite_if(indefinite: bool) -> Matrix4<f64> {
    let third = if indefinite { -1.0 } else { 1.0 };
    Matrix4::from_diagonal(&vector![1.0, 1.0, third, 1.0])
}

// Lists of tests

/// The test of a variant.
fn problem_test(error: &InvalidProblem) -> &'static str {
    match error {
        InvalidProblem::Length { .. } => "every_list_has_as_many_entries_as_there_are_modes",
        InvalidProblem::NoModes => "there_is_at_least_one_mode",
        InvalidProblem::NoFilters => "there_is_at_least_one_filter",
        InvalidProblem::Shape { .. } => "every_matrix_has_the_shape_that_the_state_and_the_measurement_ask_for",
        InvalidProblem::NotFinite { .. } => "every_number_is_finite",
        InvalidProblem::NegativeProbability { .. } => "probabilities_are_not_negative",
        InvalidProblem::NotNormalised { .. } => "rows_of_the_transition_matrix_and_initial_probabilities_sum_to_one",
        InvalidProblem::NotSymmetric { .. } => "covariances_are_symmetric_to_the_last_bit",
        InvalidProblem::NotPositive { .. } => "covariances_are_positive_semidefinite",
        InvalidProblem::NotJoint { .. } => "noises_have_no_more_in_common_than_they_have",
        InvalidProblem::CorrelationWithoutSlopes { .. } => "correlated_noises_are_for_matrices_and_slopes",
        InvalidProblem::NotLinear { .. } => "the_kalman_filter_has_linear_measurements_only",
        InvalidProblem::NothingToDrawFrom => "a_filter_with_a_given_gain_draws_no_points",
        InvalidProblem::SomeGiven => "gains_are_given_to_all_modes_or_to_none",
        InvalidProblem::OtherModes { .. } => "a_plain_filter_has_as_many_modes_as_it_is_built_for",
        InvalidProblem::OtherInteraction => "the_filter_of_second_order_is_given_the_problem_of_the_interacting_one",
        InvalidProblem::OtherKind => "a_filter_does_not_go_on_with_gains_of_the_other_kind",
        InvalidProblem::CovarianceGiven { .. } => "a_filter_with_fixed_gains_has_no_covariance",
        InvalidProblem::RuleLengths { .. } => "a_rule_has_one_weight_a_point",
        InvalidProblem::Angle { .. } => "angles_are_entries_of_the_state_each_named_once",
        InvalidProblem::TwoConversions => "all_modes_that_convert_do_it_in_one_way",
        InvalidProblem::NotRangeAndBearing | InvalidProblem::CorrelatedNoise => {
            "a_conversion_needs_one_range_one_bearing_and_their_variances"
        }
        InvalidProblem::Conversion { .. } => "a_state_conversion_is_between_two_readers_and_there_once",
        InvalidProblem::ConversionsOfGiven => "filters_with_fixed_gains_have_one_state",
        InvalidProblem::Position { .. } => "the_measured_position_is_in_the_state",
        InvalidProblem::PositionTwice { .. } => "the_measured_position_has_two_coordinates",
    }
}

/// The test of a variant.
fn rule_test(error: &InvalidRule) -> &'static str {
    match error {
        InvalidRule::UnknownName { .. } => "a_rule_that_does_not_exist_is_refused_with_the_names_of_those_that_do",
        InvalidRule::Dimension { .. } => "a_rule_has_a_least_dimension",
        InvalidRule::TooLarge { .. } => "a_rule_is_listed_up_to_a_greatest_dimension",
        InvalidRule::Radius { .. } => "unscented_points_are_at_a_real_distance",
        InvalidRule::RadiusDigits { .. } => "unscented_points_are_at_a_distance_that_has_an_exact_form",
        InvalidRule::TooManyPoints { .. } => "a_product_rule_has_a_greatest_number_of_points",
        InvalidRule::Nodes { .. } | InvalidRule::NestedRoots => "gauss_hermite_rules_have_two_to_five_nodes",
        InvalidRule::StateDimension { .. } => "a_rule_serves_states_of_its_own_dimension",
    }
}

/// The test of a variant.
fn cause_test(cause: &Cause) -> &'static str {
    match cause {
        Cause::NotPositiveDefinite { .. } => "a_covariance_that_stops_being_positive_definite_is_named",
        Cause::MeasurementLength { .. } => "a_measurement_has_as_many_components_as_the_sensor_reports",
        Cause::MeasurementNotFinite => "a_measurement_is_finite",
        Cause::BearingOutOfRange { .. } => "a_bearing_in_degrees_is_refused",
        Cause::NegativeRange { .. } => "a_negative_range_and_a_bearing_in_degrees_are_refused",
        Cause::EstimateNotFinite => "an_estimate_that_overflows_is_an_error_even_without_a_detection",
        Cause::NoSlope => "a_function_without_a_slope_where_it_is_linearised_is_named",
        Cause::NoEvidence => "a_measurement_that_no_mode_can_explain_is_refused",
    }
}
