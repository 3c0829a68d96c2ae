//! Goal: whatever is wrong with an input, one sentence says what and where, with the equation that needs it, and nothing panics.
//!
//! Method: for each variant of the library's errors a right input in which one thing is made wrong, and the error's whole sentence;
//! then random garbage in every field. Kind of evidence: exact (sentences are compared as text) and property (garbage).

mod common;

use common::{Scene, converted_scene, fixed_gain_scene, linear_scene, linear_scene_with, polar_scene, rule_of};
use immaculate::filter::fixed_gain::FixedGain;
use immaculate::gaussian::Gaussian;
use immaculate::imm::cycle::Cause;
use immaculate::imm::{Equations, Imm, Initial, InvalidProblem, Problem};
use immaculate::matrix::{NotPositiveDefinite, cholesky};
use immaculate::model::angle::wrap;
use immaculate::model::motion::{Mode, coordinated_turn};
use immaculate::model::{Conversion, Measurement, PolarComponent};
use immaculate::number::Rational;
use immaculate::report::rule::describe;
use immaculate::rule::gauss_hermite::gauss_hermite;
use immaculate::rule::unscented::{Parameters, unscented};
use immaculate::rule::{InvalidRule, Rule, RuleName};
use nalgebra::{Matrix2, Matrix3, Matrix4, Vector2, matrix, vector};
use proptest::prelude::*;

// Problems

/// Nothing is wrong with what the tests start from: an error is the doing of the change that was made.
#[test]
fn the_problems_that_are_spoilt_below_are_right() {
    for (name, scene) in common::all_scenes() {
        assert!(scene.filter().is_ok(), "{name}");
        assert!(scene.try_run().is_ok(), "{name}");
    }
}

#[test]
fn there_is_at_least_one_mode() {
    let mut scene = linear_scene();
    scene.problem.modes.clear();
    scene.problem.transition.clear();
    scene.initial.modes.clear();
    scene.initial.mode_probabilities.clear();
    assert_sentence(&scene, "`modes` is empty; the filter needs at least one (zhu2016 (54))");
}

#[test]
fn every_list_has_as_many_entries_as_there_are_modes() {
    let spoils: [(Spoil, &str); 6] = [
        (
            |scene| scene.problem.transition.truncate(2),
            "`transition` has 2 entries where there are 3 modes (zhu2016 (54))",
        ),
        (
            |scene| scene.problem.transition[1].push(0.0),
            "`transition[1]` has 4 entries where there are 3 modes (zhu2016 (54))",
        ),
        (
            |scene| scene.problem.transition[2].clear(),
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
            |scene| scene.problem.transition[1] = vec![0.5, 0.25, 0.125],
            "`transition[1]` sums to 0.875; it must sum to 1 (zhu2016 (54))",
        ),
        (
            // Probabilities to come from a mode sum to one over the columns: the matrix is transposed.
            |scene| {
                scene.problem.transition = vec![vec![0.5, 0.25, 0.5], vec![0.25, 0.5, 0.25], vec![0.25, 0.25, 0.25]];
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
        scene.problem.transition[0] = vec![third; 3];
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
            |scene| scene.problem.transition[2] = vec![-0.25, 0.25, 1.0],
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
            |scene| scene.problem.transition[0][1] = f64::NAN,
            "`transition[0]` has an entry that is not finite (zhu2016 (54))",
        ),
        (
            |scene| scene.problem.modes[1].transition[(3, 1)] = f64::INFINITY,
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
                scene.problem.measurement = Measurement::Linear(h);
            },
            "`measurement.H` has an entry that is not finite (zhu2016 (62))",
        ),
    ];
    assert_sentences(linear_scene, &spoils);

    let mut scene = polar_scene("cubature-5");
    scene.problem.measurement = polar([0, 2], [0.0, f64::INFINITY]);
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
fn covariances_are_positive_definite_and_process_noises_semidefinite() {
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
            |scene| scene.problem.measurement_noise[(1, 1)] = 0.0,
            "`R` is not positive definite (liu2017 (19))",
        ),
        (
            |scene| {
                // The x-position and its velocity, correlated by more than one.
                scene.initial.modes[2].covariance[(0, 1)] = 5000.0;
                scene.initial.modes[2].covariance[(1, 0)] = 5000.0;
            },
            "`initial.modes[2].covariance` is not positive definite (zhu2016 (56))",
        ),
        (
            |scene| scene.initial.modes[0].covariance.fill(0.0),
            "`initial.modes[0].covariance` is not positive definite (zhu2016 (56))",
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

#[test]
fn the_kalman_filter_has_linear_measurements_only() {
    let mut scene = polar_scene("cubature-5");
    scene.problem.rule = None;
    scene.equations = Equations::kalman();
    assert_sentence(
        &scene,
        "`measurement` is not linear, and a filter without points has no other; use a cubature filter (zhu2016 (42))",
    );
}

#[test]
fn a_rule_is_given_exactly_to_the_filters_that_draw_points() {
    let mut scene = linear_scene();
    scene.problem.rule = Some(rule_of("simplex-5"));
    assert_sentence(
        &scene,
        "`rule` is given, but the filter's equations draw no points (zhu2016 (2))",
    );

    let mut scene = polar_scene("simplex-5");
    scene.problem.rule = None;
    assert_sentence(
        &scene,
        "`rule` is missing, but the filter's equations draw points (zhu2016 (2))",
    );
}

#[test]
fn fixed_gains_are_given_exactly_to_the_filters_that_need_them() {
    let mut scene = fixed_gain_scene();
    scene.equations = Equations::kalman();
    scene.initial = linear_scene().initial;
    for estimate in &mut scene.initial.modes {
        estimate.covariance.fill(0.0);
    }
    assert_sentence(
        &scene,
        "`filter.modes` is given, but the filter's equations compute their own gains (derbez2000 (2))",
    );

    let mut scene = linear_scene();
    scene.equations = Equations::fixed_gain_unmixed();
    assert_sentence(
        &scene,
        "`filter.modes` is missing, but the filter's equations need fixed gains (derbez2000 (2))",
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
    let with = |spoil: fn(&mut Vec<FixedGain<f64, 4, 2>>)| {
        let mut scene = fixed_gain_scene();
        spoil(scene.problem.fixed_gains.as_mut().unwrap());
        scene
    };
    assert_sentence(
        &with(|modes| modes.truncate(2)),
        "`filter.modes` has 2 entries where there are 3 modes (derbez2000 (2))",
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
    scene.problem.measurement = polar([0, 2], [0.0, 0.0]);
    assert_sentence(
        &scene,
        "`measurement` is not linear, and a filter without points has no other; use a cubature filter (zhu2016 (42))",
    );
    assert!(fixed_gain_scene().filter().is_ok());
}

#[test]
fn a_rule_has_one_weight_a_point() {
    let with = |spoil: fn(&mut Rule<f64, 4>)| {
        let mut scene = polar_scene("cubature-3");
        spoil(scene.problem.rule.as_mut().unwrap());
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

#[test]
fn the_measured_position_is_in_the_state() {
    let mut scene = polar_scene("cubature-5");
    scene.problem.measurement = polar([0, 4], [0.0, 0.0]);
    assert_sentence(
        &scene,
        "`measurement.position` names entry 4 of a state of 4 (liu2017 (31))",
    );
}

/// A target on the diagonal x = y is not where any other is. A converted measurement has the same position.
#[test]
fn the_measured_position_has_two_coordinates() {
    let twice = |index: usize| {
        let mut scenes = [
            polar_scene("cubature-5"),
            converted_scene(Conversion::Standard, [0.0, 0.0]),
        ];
        for scene in &mut scenes {
            if let Measurement::Polar { position, .. } | Measurement::Converted { position, .. } =
                &mut scene.problem.measurement
            {
                *position = [index, index];
            }
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
        assert_eq!(name.parse::<RuleName>().unwrap().rule::<f64, 0>().unwrap_err(), error);
    }
    let error = gauss_hermite::<f64, 0>(3).unwrap_err();
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
        assert_eq!(gauss_hermite::<f64, 2>(nodes).unwrap_err().to_string(), sentence);
        let by_name = RuleName::GaussHermite(nodes).rule::<f64, 2>();
        assert_eq!(by_name.unwrap_err().to_string(), sentence);
    }
    assert_eq!(
        RuleName::GaussHermite(3).exact(2).unwrap_err().to_string(),
        "the coordinates of a Gauss-Hermite product rule are nested roots, not surds"
    );
}

#[test]
fn a_rule_serves_states_of_its_own_dimension() {
    let exact = RuleName::FifthDegree.exact(3).unwrap();
    assert_eq!(
        Rule::<f64, 4>::from_exact(&exact).unwrap_err().to_string(),
        "a rule of dimension 3 cannot serve a state of dimension 4"
    );
    assert!(Rule::<f64, 3>::from_exact(&exact).is_ok());
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

/// The scenes of other measurements are refused by the converting table, and a scene to be converted by the others.
#[test]
fn what_is_to_be_converted_is_given_exactly_to_the_filters_that_convert() {
    let refused = |scene: &Scene| scene.filter().unwrap_err().to_string();
    let mut scene = linear_scene();
    scene.equations = Equations::converted();
    let sentence = "`measurement` is not to be converted, but the filter's equations convert (sustika2015 (22))";
    assert_eq!(refused(&scene), sentence);
    for equations in [Equations::kalman(), Equations::cubature()] {
        let mut scene = converted_scene(Conversion::Standard, [0.0, 0.0]);
        scene.problem.rule = polar_scene("cubature-3")
            .problem
            .rule
            .filter(|_| equations.draws_points);
        scene.equations = equations;
        let sentence = "`measurement` is to be converted, but the filter's equations do not convert (sustika2015 (22))";
        assert_eq!(refused(&scene), sentence);
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
    let mut scene = converted_scene(Conversion::Standard, [0.0, 0.0]);
    if let Measurement::Converted { components, .. } = &mut scene.problem.measurement {
        *components = [PolarComponent::Bearing; 2];
    }
    assert_eq!(
        refused(&scene),
        "`measurement.components` must be one range and one bearing to be converted to a position (sustika2015 (20))"
    );
    // A third component has no place in a position, whatever it is.
    let scene = converted_scene(Conversion::Standard, [0.0, 0.0]);
    for third in [PolarComponent::Range, PolarComponent::Bearing] {
        let problem = Problem {
            modes: scene.problem.modes.clone(),
            transition: scene.problem.transition.clone(),
            measurement: Measurement::Converted {
                components: [PolarComponent::Range, PolarComponent::Bearing, third],
                position: [0, 2],
                sensor: [0.0, 0.0],
                conversion: Conversion::Standard,
            },
            measurement_noise: Matrix3::identity(),
            rule: None,
            fixed_gains: None,
        };
        let refused = Imm::new(problem, Equations::converted(), &scene.initial);
        assert_eq!(refused.err(), Some(InvalidProblem::NotRangeAndBearing));
    }
    // Zero noises are no covariance.
    let mut scene = converted_scene(Conversion::Standard, [0.0, 0.0]);
    for zero in [0, 1] {
        scene.problem.measurement_noise = Matrix2::from_diagonal(&vector![1600.0, 49e-6]);
        scene.problem.measurement_noise[(zero, zero)] = 0.0;
        assert_eq!(refused(&scene), "`R` is not positive definite (liu2017 (19))");
    }
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
        "step 1, mode `all`, liu2017 (31): the measured range -3.0 is negative; a range is a distance"
    );
    assert_eq!(
        failure(vector![1414.0, 135.0]),
        "step 1, mode `all`, liu2017 (31): the measured bearing 135.0 is outside ±2π: is it in degrees?"
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
                    "step 1, mode `all`, liu2017 (1): the measurement has an entry that is not finite",
                );
            }
        }
    }
}

#[test]
fn a_bearing_in_degrees_is_refused() {
    let scene = polar_scene("simplex-5");
    assert_failure(
        &scene,
        vector![15000.0, 176.25],
        "step 1, mode `all`, liu2017 (31): the measured bearing 176.25 is outside ±2π: is it in degrees?",
    );
    assert_failure(
        &scene,
        vector![15000.0, -6.5],
        "step 1, mode `all`, liu2017 (31): the measured bearing -6.5 is outside ±2π: is it in degrees?",
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
        "step 1, mode `all`, zhu2016 (58): the log-likelihood of the measurement under all modes together is not finite",
    );
}

#[test]
fn an_estimate_that_overflows_is_an_error_even_without_a_detection() {
    // Each prediction multiplies the covariances by 10²⁰⁰: the second one is beyond the doubles.
    let mut scene = linear_scene();
    for mode in &mut scene.problem.modes {
        mode.transition *= 1e100;
    }
    let mut filter = scene.filter().unwrap();
    assert!(filter.step(None).is_ok());
    let failure = filter.step(None).unwrap_err();
    assert_eq!(
        failure.to_string(),
        "step 2, mode `all`, zhu2016 (60): the combined estimate has an entry that is not finite",
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
        "step 1, mode `left turn`, zhu2016 (1): the mixed covariance is not positive definite: pivot 3 of 4 is not positive",
    );

    let mut scene = linear_scene_with("cubature-5");
    scene.equations.predicted_covariance = |_, _, _, j| indefinite_if(j == 2);
    assert_failure(
        &scene,
        vector![0.0, 0.0],
        "step 1, mode `right turn`, zhu2016 (27): the predicted covariance is not positive definite: pivot 3 of 4 is not positive",
    );

    let mut scene = linear_scene();
    scene.equations.innovation_covariance = |_, _, _, _| matrix![1.0, 2.0; 2.0, 4.0];
    assert_failure(
        &scene,
        vector![0.0, 0.0],
        "step 1, mode `constant velocity`, zhu2016 (51): the innovation covariance is not positive definite: pivot 2 of 2 is not positive",
    );

    let mut scene = linear_scene();
    scene.equations.innovation_covariance = |_, _, _, _| matrix![f64::NAN, 0.0; 0.0, 1.0];
    assert_failure(
        &scene,
        vector![0.0, 0.0],
        "step 1, mode `constant velocity`, zhu2016 (51): the innovation covariance is not positive definite: pivot 1 of 2 is not a \
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
    assert_eq!(failure.equation, "liu2017 (1)");
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
fn any_rule() -> impl Strategy<Value = Option<Rule<f64, 2>>> {
    let of_garbage = (
        prop::collection::vec((any_double(), any_double()), 0..4),
        prop::collection::vec(any_double(), 0..4),
    );
    prop_oneof![
        8 => Just(None),
        12 => prop::sample::select(vec!["cubature-3", "unscented", "cubature-5", "simplex-5"])
            .prop_map(|name| Some(name.parse::<RuleName>().unwrap().rule().unwrap())),
        1 => of_garbage.prop_map(|(points, weights)| Some(Rule {
            points: points.into_iter().map(|(x, y)| vector![x, y]).collect(),
            covariance_weights: weights.clone(),
            weights,
        })),
    ]
}

/// Measurements with garbage in every field.
fn any_measurement() -> impl Strategy<Value = Measurement<f64, 2, 2>> {
    let polar = (0..2_usize, 0..=2_usize, any_double(), any_double()).prop_map(|(x, y, a, b)| Measurement::Polar {
        components: [PolarComponent::Range, PolarComponent::Bearing],
        position: [x, y],
        sensor: [a, b],
    });
    let converted =
        (0..2_usize, 0..=2_usize, any_double(), any_double()).prop_map(|(x, y, a, b)| Measurement::Converted {
            components: [PolarComponent::Range, PolarComponent::Bearing],
            position: [x, y],
            sensor: [a, b],
            conversion: Conversion::Standard,
        });
    prop_oneof![
        2 => converted,
        1 => any_matrix().prop_map(Measurement::Linear),
        4 => Just(Measurement::Linear(Matrix2::identity())),
        2 => polar,
    ]
}

/// A whole problem of two modes, mostly, with garbage in every field.
fn any_problem() -> impl Strategy<Value = (Problem<f64, 2, 2>, Initial<f64, 2>)> {
    let mode = (any_matrix(), any_covariance()).prop_map(|(transition, noise)| Mode {
        name: "mode".to_owned(),
        transition,
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
    let problem = (
        prop::collection::vec(mode, 2..=2),
        chain,
        any_measurement(),
        any_covariance(),
        any_rule(),
    );
    let initial = (prop::collection::vec(estimate, 2..=2), any_probabilities());
    (problem, initial).prop_map(
        |((modes, transition, measurement, measurement_noise, rule), (modes_0, probabilities))| {
            (
                Problem {
                    modes,
                    transition,
                    measurement,
                    measurement_noise,
                    rule,
                    fixed_gains: None,
                },
                Initial {
                    modes: modes_0,
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

/// Nothing panics; an error has a sentence that names a field or a step and an equation; and a step with a measurement has mode
/// probabilities between zero and one.
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
            let equations = match (&problem.rule, raw) {
                (None, _) if problem.measurement.is_converted() => Equations::converted(),
                (None, _) => Equations::kalman(),
                (Some(_), false) => Equations::cubature(),
                (Some(_), true) => Equations::raw_cubature(),
            };
            let mut filter = match Imm::new(problem, equations, &initial) {
                Ok(filter) => filter,
                Err(error) => {
                    fates.refused += 1;
                    let sentence = error.to_string();
                    prop_assert!(sentence.starts_with('`'), "{}", sentence);
                    prop_assert!(["2015 (", "2016 (", "2017 ("].iter().any(|year| sentence.contains(year)), "{}", sentence);
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
fn polar(position: [usize; 2], sensor: [f64; 2]) -> Measurement<f64, 4, 2> {
    Measurement::Polar {
        components: [PolarComponent::Range, PolarComponent::Bearing],
        position,
        sensor,
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
        InvalidProblem::NotFinite { .. } => "every_number_is_finite",
        InvalidProblem::NegativeProbability { .. } => "probabilities_are_not_negative",
        InvalidProblem::NotNormalised { .. } => "rows_of_the_transition_matrix_and_initial_probabilities_sum_to_one",
        InvalidProblem::NotSymmetric { .. } => "covariances_are_symmetric_to_the_last_bit",
        InvalidProblem::NotPositive { .. } => "covariances_are_positive_definite_and_process_noises_semidefinite",
        InvalidProblem::NotLinear => "the_kalman_filter_has_linear_measurements_only",
        InvalidProblem::Rule { .. } => "a_rule_is_given_exactly_to_the_filters_that_draw_points",
        InvalidProblem::FixedGains { .. } => "fixed_gains_are_given_exactly_to_the_filters_that_need_them",
        InvalidProblem::CovarianceGiven { .. } => "a_filter_with_fixed_gains_has_no_covariance",
        InvalidProblem::RuleLengths { .. } => "a_rule_has_one_weight_a_point",
        InvalidProblem::Conversion { .. } => "what_is_to_be_converted_is_given_exactly_to_the_filters_that_convert",
        InvalidProblem::NotRangeAndBearing | InvalidProblem::CorrelatedNoise => {
            "a_conversion_needs_one_range_one_bearing_and_their_variances"
        }
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
        InvalidRule::Nodes { .. } | InvalidRule::NestedRoots => "gauss_hermite_rules_have_two_to_five_nodes",
        InvalidRule::StateDimension { .. } => "a_rule_serves_states_of_its_own_dimension",
    }
}

/// The test of a variant.
fn cause_test(cause: &Cause) -> &'static str {
    match cause {
        Cause::NotPositiveDefinite { .. } => "a_covariance_that_stops_being_positive_definite_is_named",
        Cause::MeasurementNotFinite => "a_measurement_is_finite",
        Cause::BearingOutOfRange { .. } => "a_bearing_in_degrees_is_refused",
        Cause::NegativeRange { .. } => "a_negative_range_and_a_bearing_in_degrees_are_refused",
        Cause::EstimateNotFinite => "an_estimate_that_overflows_is_an_error_even_without_a_detection",
        Cause::NoEvidence => "a_measurement_that_no_mode_can_explain_is_refused",
    }
}
