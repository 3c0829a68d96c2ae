//! Goal: every simulation is what its choices say, draws what it says, and keeps of a run what it says.
//!
//! Method: the alternatives of every open parameter one by one, beside what `spec/` says they mean; draws beside the same random numbers
//! taken by hand, on circles and straight lines in closed form; and what is kept of a run beside its steps. Kinds of evidence: exact, and
//! property where a bound of roundings is said. No figure of a paper is looked at here; they are in `tests/scenario.rs`.

// What is exact is compared exactly.
#![allow(clippy::float_cmp)]

use immaculate::imm::Equations;
use immaculate::model::{Conversion, PolarComponent, Sensor};
use immaculate::paper::comparison::ErrorQuantity;
use immaculate::paper::derbez2000::contestants::Coordinates;
use immaculate::paper::derbez2000::contestants::MeasurementNoise;
use immaculate::paper::derbez2000::path::{PlaneState, Regime};
use immaculate::paper::derbez2000::scenario::{follow, track as track_coordinates};
use immaculate::paper::derbez2000::{self, contestants::Reading, radar};
use immaculate::paper::monte_carlo::Generator;
use immaculate::paper::result::Figure;
use immaculate::paper::scenario::track;
use immaculate::paper::scenario::{Contestant, Course, Scenario};
use immaculate::paper::simulation::Average;
use immaculate::paper::simulation::Simulation;
use immaculate::paper::specification::Choices;
use immaculate::paper::sustika2015::contestants::{Bearings, ConvertedAt, InitialCovariance, Mixing};
use immaculate::paper::sustika2015::scenario::FirstMeasurement;
use immaculate::paper::sustika2015::truth::TruthNoise;
use immaculate::paper::{Effort, Paper, liu2017, sustika2015, zhu2016};
use immaculate::rule::RuleName;
use immaculate::statistics::consistency::{nees, nis};
use immaculate::statistics::fit_error::FitForm;
use nalgebra::{Matrix4, Matrix6, U4, Vector2, Vector3, Vector4, Vector6};
use std::collections::BTreeSet;
use std::fmt::Debug;
use std::time::Duration;

// What is chosen

/// What one alternative means for a scenario, beside the scenario at the defaults.
type Meaning<S> = (&'static str, &'static str, fn(&S, &S) -> bool);

/// Every alternative but the defaults has a meaning here, each is what it says, and none is what the default is.
fn assert_meanings<S: Debug>(paper: Paper, with: impl Fn(&Choices) -> S, meanings: &[Meaning<S>]) {
    let named: BTreeSet<(&str, &str)> = meanings.iter().map(|(name, other, _)| (*name, *other)).collect();
    let parameters = &paper.specification().parameters;
    let others = parameters
        .iter()
        .filter(|parameter| parameter.name != "scenario")
        .flat_map(|parameter| {
            let all = parameter.alternatives.iter().map(|other| other.name.as_str());
            let others = all.filter(move |other| *other != parameter.default);
            others.map(move |other| (parameter.name.as_str(), other))
        });
    assert_eq!(named, others.collect::<BTreeSet<_>>(), "{paper:?}: every alternative");
    for (name, other, means) in meanings {
        let parameter = parameters.iter().find(|parameter| parameter.name == *name).unwrap();
        // A parameter of some scenarios is looked at in the first of them.
        let of = parameter
            .scenarios
            .first()
            .map_or_else(Choices::default, |of| Choices::of("scenario", of));
        let (chosen, default) = (with(&of.clone().with(name, other)), with(&of));
        assert!(means(&chosen, &default), "{paper:?}: {name}={other}");
        assert!(
            !means(&default, &default),
            "{paper:?}: {name}={other} is what the default is"
        );
    }
}

#[test]
fn every_alternative_of_zhu2016_means_what_its_sentence_says() {
    let noises = |scenario: &Scenario, factor: f64| {
        let of = |contestant: &Contestant| contestant.problem.modes.iter().map(|mode| mode.noise[(1, 1)]).collect();
        let all: Vec<Vec<f64>> = scenario.contestants.iter().map(of).collect();
        // One rounding of a product.
        all.iter()
            .flatten()
            .all(|noise| (noise / (10.0 * factor) - 1.0).abs() < 1e-15)
    };
    assert!(noises(&zhu2016::scenario(&Choices::default()).unwrap(), 1.0));
    assert_meanings::<Scenario>(
        Paper::Zhu2016,
        |choices| zhu2016::scenario(choices).unwrap(),
        &[
            ("measurement", "equal-noise", |s, d| {
                s.sensor == d.sensor && variances(s) == [20.0, 20.0]
            }),
            ("measurement", "range-bearing", |s, _| {
                is_polar(s) && variances(s) == [20.0, 1e-8]
            }),
            ("measurement", "range-bearing-coarse", |s, _| {
                is_polar(s) && variances(s) == [20.0, 1e-7]
            }),
            ("truth-noise", "as-in-the-filters", |s, _| {
                // G q Gᵀ with G = [½, 1] for either coordinate.
                s.truth_noise_root.is_some_and(|root| {
                    let one = nalgebra::matrix![2.5, 5.0; 5.0, 10.0];
                    let mut both = Matrix4::zeros();
                    both.fixed_view_mut::<2, 2>(0, 0).copy_from(&one);
                    both.fixed_view_mut::<2, 2>(2, 2).copy_from(&one);
                    (root * root.transpose() - both).amax() < 1e-14
                })
            }),
            ("filter-noise", "tenth", |s, d| same_noises(s, d, 0.1)),
            ("filter-noise", "hundredth", |s, d| same_noises(s, d, 0.01)),
            ("initial-probabilities", "stationary", |s, _| {
                // μ Π = μ, each term rounded a few times.
                let mu = &s.contestants[0].initial_probabilities;
                let chain = &s.contestants[0].problem.chain;
                let next = |j: usize| (0..3).map(|i| mu[i] * chain[i][j]).sum::<f64>();
                (0..3).all(|j| (next(j) - mu[j]).abs() < 1e-15) && s.contestants[3].initial_probabilities == [1.0]
            }),
            ("initial-probabilities", "mostly-constant-velocity", |s, _| {
                [0, 1, 2, 4]
                    .iter()
                    .all(|c| s.contestants[*c].initial_probabilities == [0.8, 0.1, 0.1])
            }),
            ("model-order", "left-second", |s, d| {
                let modes = |s: &Scenario| s.contestants[0].problem.modes.clone();
                let mut exchanged = modes(d);
                exchanged.swap(1, 2);
                modes(s) == exchanged && chain(s) == chain(d)
            }),
            ("initial-estimate", "drawn", |s, _| s.draws_initial_estimate),
            ("switch-instants", "from-21-to-40", |s, _| {
                turns(s) == [(Course::RightTurn, 21.0, 40.0), (Course::LeftTurn, 61.0, 80.0)]
            }),
            ("unscented", "kappa-0", |s, _| rule(s, 2) == Some(unscented(1, 1, 0, 0))),
            ("unscented", "scaled", |s, _| {
                rule(s, 2) == Some(unscented(1, 1000, 2, 0))
            }),
            ("single-model", "coordinated-turn", |s, d| {
                s.contestants[3].problem.modes == [d.contestants[0].problem.modes[1].clone()]
            }),
            ("single-model", "left-turn", |s, d| {
                s.contestants[3].problem.modes == [d.contestants[0].problem.modes[2].clone()]
            }),
            ("single-model", "constant-velocity-ten-times-noise", |s, d| {
                let (mode, default) = (&s.contestants[3].problem.modes[0], &d.contestants[3].problem.modes[0]);
                mode.motion == default.motion && mode.noise == default.noise * 10.0
            }),
            ("omtm-imm", "omitted", |s, d| names(s) == names(d)[..4]),
            ("pairing", "unpaired", |s, _| !s.paired),
            ("table-average", "mean", |s, _| s.average == Average::Mean),
        ],
    );
}

#[test]
fn every_alternative_of_liu2017_means_what_its_sentence_says() {
    assert_meanings::<Scenario>(
        Paper::Liu2017,
        |choices| liu2017::scenario(choices).unwrap(),
        &[
            ("initial-covariance", "cartesian-1600", |s, _| {
                initial(s) == [1600.0, 100.0, 1600.0, 100.0]
            }),
            ("initial-covariance", "zhu2016", |s, _| {
                initial(s) == [1000.0, 10.0, 1000.0, 10.0]
            }),
            ("initial-covariance", "wide", |s, _| initial(s) == [1e6, 1e4, 1e6, 1e4]),
            ("truth-noise", "as-in-the-filters", |s, d| {
                // (27) is positive definite with entries up to one.
                let of_filters = d.contestants[0].problem.modes[0].noise;
                s.truth_noise_root
                    .is_some_and(|root| (root * root.transpose() - of_filters).amax() < 1e-15)
            }),
            ("first-measurement", "at-1-s", |s, d| {
                let earlier = Vector4::new(15_180.0, -180.0, 800.0, 200.0);
                s.initial_state == earlier && s.schedule[1..] == d.schedule && s.first_time == 1.0
            }),
            ("turn-intervals", "from-22-to-71", |s, _| {
                turns(s) == [(Course::RightTurn, 22.0, 71.0), (Course::LeftTurn, 122.0, 171.0)]
            }),
            ("unscented", "kappa-half", |s, _| {
                rule(s, 0).is_some_and(|rule| rule.weights.iter().all(|w| *w == 1.0 / 9.0))
            }),
            ("unscented", "scaled", |s, _| {
                rule(s, 0) == Some(unscented(1, 1000, 2, 0))
            }),
            ("likelihood", "printed", |s, d| {
                let draw = d.draw(&mut Generator::new(1, 0));
                let printed = Contestant {
                    equations: Equations::standard().with_likelihood_21(),
                    ..d.contestants[0].clone()
                };
                let errors = |contestant: &Contestant| track(contestant, &draw).errors;
                errors(&s.contestants[0]) == errors(&printed) && errors(&printed) != errors(&d.contestants[0])
            }),
            ("initial-position", "100", |s, _| {
                s.initial_state == Vector4::new(15_000.0, -180.0, 100.0, 200.0)
            }),
            ("bearing-noise", "ten-times", |s, _| {
                // 0.07 rad, told to the filters as its square.
                variances(s)[0] == 1600.0 && (variances(s)[1] / 0.0049 - 1.0).abs() < 1e-15
            }),
            ("pairing", "unpaired", |s, _| !s.paired),
            ("runs", "100", |s, _| s.runs == 100),
        ],
    );
}

#[test]
fn every_alternative_of_derbez2000_means_what_its_sentence_says() {
    type S = derbez2000::scenario::CoordinateScenario;
    assert_meanings::<S>(
        Paper::Derbez2000,
        |choices| derbez2000::scenario(choices).unwrap(),
        &[
            ("mixing", "unmixed", |s, d| {
                // The fixed-gain filter alone is another.
                let runs = |s: &S| s.one_run(0, 1).into_iter().map(|run| run.errors).collect::<Vec<_>>();
                let (unmixed, mixed) = (runs(s), runs(d));
                let same = [0, 1, 2].map(|filter| unmixed[filter] == mixed[filter]);
                s.setup.reading == Reading::Unmixed && same == [true, false, true]
            }),
            ("scan-time", "1", |s, d| {
                s.setup.interval == 1.0 && s.path.places[9][0][1] == d.path.places[9][0][1] / 2.0
            }),
            ("noise-variance", "40", |s, _| s.setup.noise_variance == 40.0),
            ("noise-variance", "1", |s, _| s.setup.noise_variance == 1.0),
            ("noise-variance", "0-01", |s, _| s.setup.noise_variance == 0.01),
            ("measurement-variance", "per-step", |s, _| {
                let follow: Vec<bool> = s
                    .contestants
                    .iter()
                    .map(|contestant| contestant.follows_noise)
                    .collect();
                s.setup.noise == MeasurementNoise::OfEachMeasurement && follow == [true, false, true]
            }),
            ("measurement-variance", "range", |s, _| noises(s) == [[0.0025; 2]; 3]),
            ("measurement-variance", "0-05", |s, _| noises(s) == [[0.05; 2]; 3]),
            ("measurement-variance", "0-5", |s, _| noises(s) == [[0.5; 2]; 3]),
            ("debiasing", "multiplicative", |s, _| {
                s.conversion == Conversion::Multiplicative
            }),
            ("debiasing", "additive", |s, _| s.conversion == Conversion::Additive),
            ("initial-covariance", "small", |s, _| {
                s.contestants
                    .iter()
                    .map(|contestant| contestant.initial_variance)
                    .collect::<Vec<_>>()
                    == [1e-6, 0.0, 1e-6]
            }),
            ("path", "turning-point", |s, _| {
                s.path
                    .places
                    .iter()
                    .zip(1..)
                    .all(|(place, k)| along(place) == falls(k, 1.0))
                    && along(&s.path.start) == falls(0, 1.0)
            }),
            ("path", "reversed", |s, _| {
                let at = |k: i32| falls(k, if k <= 60 { -1.0 } else { 1.0 });
                s.path.places.iter().zip(1..).all(|(place, k)| along(place) == at(k)) && along(&s.path.start) == at(0)
            }),
            ("start", "100", |s, _| position(&s.path.start) == [0.0, 100.0]),
            ("start", "20", |s, _| position(&s.path.start) == [0.0, 20.0]),
            ("heading", "diagonal", |s, _| {
                let [x, y] = s.path.start;
                x[2] > 0.0 && (x[2] - y[2]).abs() < 1e-14 && (x[2].hypot(y[2]) - 5.0).abs() < 1e-14
            }),
            ("heading", "away", |s, _| {
                let [x, y] = s.path.start;
                x[2].abs() < 1e-15 && y[2] == 5.0
            }),
            ("initial-speed", "1", |s, _| s.path.start[0][1] == 1.0),
            ("initial-speed", "10", |s, _| s.path.start[0][1] == 10.0),
            ("acceleration", "1", |s, _| s.path.start[0][2] == 1.0),
            ("acceleration", "0-2", |s, _| s.path.start[0][2] == 0.2),
            ("turn-rate", "3-right", |s, _| turned(s, -180.0)),
            ("turn-rate", "1-left", |s, _| turned(s, 60.0)),
            ("turn-rate", "9-left", |s, _| turned(s, 540.0)),
        ],
    );
    // And the defaults themselves.
    let default = derbez2000::scenario(&Choices::default()).unwrap();
    assert!(turned(&default, 180.0) && default.setup.noise_variance == 5.0 && default.setup.interval == 2.0);
    assert_eq!(
        (position(&default.path.start), default.path.start[0]),
        ([0.0, 500.0], Vector3::new(0.0, 0.0, 5.0))
    );
    let from_rest = derbez2000::scenario(&Choices::of("scenario", "acceleration")).unwrap();
    // x = −36000 + 2.5 τ² with τ = 2k: whole numbers.
    let expected = |k: i32| Vector3::new(-36_000.0 + 10.0 * f64::from(k * k), 10.0 * f64::from(k), 5.0);
    assert!(
        from_rest
            .path
            .places
            .iter()
            .zip(1..)
            .all(|(place, k)| along(place) == expected(k))
    );
    assert!(
        from_rest
            .path
            .places
            .iter()
            .all(|place| place[1] == Vector3::new(500.0, 0.0, 0.0))
    );
}

#[test]
fn every_alternative_of_sustika2015_means_what_its_sentence_says() {
    type S = sustika2015::scenario::RadarScenario;
    let manoeuvres = |scenario: &S| {
        let motions = (2..).zip(&scenario.trajectory.motions);
        motions
            .filter(|(_, motion)| motion.name() == "constant acceleration")
            .map(|(second, _)| second)
            .collect::<Vec<usize>>()
    };
    assert_meanings::<S>(
        Paper::Sustika2015,
        |choices| sustika2015::scenario(choices).unwrap(),
        &[
            ("window", "printed", |s, _| {
                seconds(s) == (2..=50).chain(71..=120).collect::<Vec<_>>()
            }),
            ("window", "complement", |s, _| {
                seconds(s) == (51..=70).chain(121..=200).collect::<Vec<_>>()
            }),
            ("truth", "one-trajectory", |s, _| {
                s.trajectory.noise == TruthNoise::OneTrajectory
            }),
            ("truth", "noise-free", |s, _| s.trajectory.noise == TruthNoise::Free),
            ("first-measurement", "filtered", |s, _| {
                s.first_measurement == FirstMeasurement::FilteredAgain
            }),
            ("initial-covariance", "velocity-25", |s, _| {
                s.setup.initial
                    == InitialCovariance::OnePoint {
                        velocity: 25.0,
                        acceleration: 1.0,
                    }
            }),
            ("initial-covariance", "toolbox", |s, _| {
                let estimate = &s.setup.initial(&Vector2::new(1000.0, 0.5)).modes[1];
                let variances = Vector6::new(0.1, 0.1, 0.1, 0.1, 0.5, 0.5);
                estimate.covariance == Matrix6::from_diagonal(&variances)
            }),
            ("conversion", "additive", |s, _| {
                s.setup.conversion == Conversion::Additive
            }),
            ("conversion", "multiplicative", |s, _| {
                s.setup.conversion == Conversion::Multiplicative
            }),
            ("conversion", "modified-unbiased", |s, _| {
                s.setup.conversion == Conversion::ModifiedUnbiased
            }),
            ("conversion-noise", "predicted", |s, _| {
                s.setup.converted_at == ConvertedAt::Prediction
            }),
            ("unscented", "half", |s, _| s.setup.unscented == [0.5, 2.0, -3.0]),
            ("unscented", "zero", |s, _| {
                s.setup.unscented == [1.0, 0.0, 0.0] && s.contestants[1].points == Some((13, 12))
            }),
            ("unscented", "scaled", |s, _| s.setup.unscented == [1e-3, 2.0, 0.0]),
            ("wrapping", "never", |s, d| {
                let plain = d.setup.unscented(Bearings::Plain);
                s.contestants[1].name == plain.name && s.contestants[0].name == d.contestants[0].name
            }),
            ("mixing", "index-wise", |s, _| s.setup.mixing == Mixing::IndexWise),
            ("mixing", "unbiased", |s, _| s.setup.mixing == Mixing::Unbiased),
            ("fit-error", "joint-norm", |s, _| s.fit_form == FitForm::JointNorm),
            ("fit-error", "root-mean-square", |s, _| {
                s.fit_form == FitForm::RootMeanSquare
            }),
            ("fit-error", "mean", |s, _| s.fit_form == FitForm::Mean),
            ("fit-error", "sum", |s, _| s.fit_form == FitForm::Sum),
        ],
    );
    // The four scenarios: who knows the noise, and what the target does.
    let degree = std::f64::consts::PI / 180.0;
    for (name, noise_density, degrees, moving) in [
        ("matched-straight", 0.1, 1.0, vec![]),
        ("mismatched-straight", 0.01, 4.0, vec![]),
        ("matched-manoeuvring", 0.1, 1.0, (51..=70).chain(121..=150).collect()),
        (
            "mismatched-manoeuvring",
            0.01,
            4.0,
            (51..=70).chain(121..=150).collect(),
        ),
    ] {
        let scenario = sustika2015::scenario(&Choices::of("scenario", name)).unwrap();
        assert_eq!(scenario.setup.noise_density, noise_density, "{name}");
        assert_eq!(scenario.setup.deviations, [10.0, degrees * degree], "{name}");
        assert_eq!(manoeuvres(&scenario), moving, "{name}");
        assert_eq!(scenario.setup.unscented, [1.0, 0.0, -3.0]);
        assert_eq!(
            scenario.contestants[1].points,
            Some((13, 13)),
            "a centre with a negative weight counts"
        );
        for contestant in &scenario.contestants {
            let q = |mode: usize, entry: usize| contestant.problem.modes[mode].noise[(entry, entry)];
            // The last derivative that moves has the variance q T.
            assert_eq!([q(0, 2), q(1, 4)], [noise_density; 2], "{name}");
            let variance = (degrees * degree).powi(2);
            assert!(
                (contestant.problem.measurement_noise[(1, 1)] / variance - 1.0).abs() < 1e-15,
                "{name}"
            );
        }
    }
}

// What a simulation says of itself

#[test]
fn a_simulation_says_whose_it_is_and_who_competes() {
    for (paper, components, competitors) in [
        (
            Paper::Derbez2000,
            (6.0, 2.0),
            &[("IMM", 4), ("Fixed Gain", 4), ("CA", 1)][..],
        ),
        (Paper::Sustika2015, (6.0, 2.0), &[("IMM-CMKF", 2), ("IMM-UKF", 2)]),
        (
            Paper::Zhu2016,
            (4.0, 2.0),
            &[
                ("IMM5CKF", 3),
                ("IMMCKF", 3),
                ("IMMUKF", 3),
                ("5CKF", 1),
                ("OMTM-IMM (stand-in)", 3),
            ],
        ),
        (
            Paper::Liu2017,
            (4.0, 2.0),
            &[("IMMUKF", 3), ("IMMCKF", 3), ("IMM5thCKF", 3), ("IMM5thSSRCKF", 3)],
        ),
    ] {
        let simulation = paper.simulation(&Choices::default()).unwrap();
        assert_eq!((simulation.paper(), simulation.components()), (paper.key(), components));
        let filters = simulation.filters();
        let names = filters.iter().map(|filter| (filter.name.as_str(), filter.modes.len()));
        assert_eq!(names.collect::<Vec<_>>(), competitors);
        // What runs is what is said: the number of filters, and one probability for each mode.
        let runs = simulation.one_run(0, 1);
        assert_eq!(runs.len(), filters.len());
        for (run, filter) in runs.iter().zip(&filters) {
            let is_complete = |step: &Vec<f64>| step.len() == filter.modes.len();
            assert!(run.mode_probabilities.iter().all(is_complete), "{}", filter.name);
        }
    }
}

#[test]
fn a_simulation_says_how_long_it_is_and_is_as_long() {
    // First and last second, and the seconds of a step.
    for (paper, parameter, alternative, runs, [first, last, interval]) in [
        (Paper::Derbez2000, "scenario", "manoeuvres", 100, [2, 140, 2]),
        (Paper::Derbez2000, "scan-time", "1", 100, [1, 70, 1]),
        (Paper::Derbez2000, "scenario", "acceleration", 100, [2, 240, 2]),
        (Paper::Sustika2015, "first-measurement", "initiation", 50, [2, 200, 1]),
        (Paper::Sustika2015, "first-measurement", "filtered", 50, [1, 200, 1]),
        (Paper::Zhu2016, "pairing", "unpaired", 100, [1, 100, 1]),
        (Paper::Liu2017, "first-measurement", "at-2-s", 200, [2, 200, 1]),
        (Paper::Liu2017, "first-measurement", "at-1-s", 200, [1, 200, 1]),
        (Paper::Liu2017, "runs", "100", 100, [2, 200, 1]),
    ] {
        let choices = Choices::of(parameter, alternative);
        let simulation = paper.simulation(&choices).unwrap();
        assert_eq!((simulation.runs(), simulation.choices()), (runs, &choices));
        let times: Vec<f64> = (first..=last).step_by(interval).map(|second| second as f64).collect();
        assert_eq!(simulation.times(), times, "{alternative}");
        assert_eq!(
            (simulation.interval(), simulation.motions().len()),
            (interval as f64, times.len())
        );
        for run in simulation.one_run(0, 1) {
            let kept = [
                run.errors.len(),
                run.nees.len(),
                run.nis.len(),
                run.mode_probabilities.len(),
            ];
            assert_eq!((kept, run.failure), ([times.len(); 4], None), "{alternative}");
            // No step takes no time, and all together take no minute.
            assert!(run.time > Duration::ZERO && run.time < Duration::from_secs(60));
        }
    }
}

/// Both papers have a second; another interval shows what is multiplied.
#[test]
fn the_times_of_a_scenario_are_an_interval_apart() {
    let mut scenario = zhu2016::scenario(&Choices::default()).unwrap();
    (scenario.first_time, scenario.interval) = (10.0, 2.0);
    scenario.schedule.truncate(4);
    assert_eq!(
        (scenario.times(), scenario.interval()),
        (vec![10.0, 12.0, 14.0, 16.0], 2.0)
    );
}

#[test]
fn a_motion_has_the_name_of_the_mode_that_models_it() {
    for paper in Paper::ALL {
        for choices in paper.simulations(&Choices::default()) {
            let simulation = paper.simulation(&choices).unwrap();
            let motions: BTreeSet<&str> = simulation
                .motions()
                .into_iter()
                .flat_map(|motion| motion.split(", "))
                .collect();
            let modes = &simulation.filters()[0].modes;
            for motion in &motions {
                assert!(modes.iter().any(|mode| mode == motion), "{}: {motion}", paper.key());
            }
            // Every mode is right at some time, but where the target does one thing all the time.
            let only = match (paper, choices.chosen("scenario")) {
                // Along x it is accelerated, across it stands still.
                (Paper::Derbez2000, Some("acceleration")) => 2,
                (Paper::Sustika2015, None | Some("mismatched-straight")) => 1,
                _ => modes.len(),
            };
            assert_eq!(motions.len(), only, "{}, {}", paper.key(), choices.describe());
        }
    }
}

#[test]
fn a_paper_is_found_by_its_key_and_simulates_what_it_prints_first() {
    for (paper, key, simulations) in [
        (Paper::Derbez2000, "derbez2000", &["", "acceleration"][..]),
        (
            Paper::Sustika2015,
            "sustika2015",
            &[
                "",
                "mismatched-straight",
                "matched-manoeuvring",
                "mismatched-manoeuvring",
            ],
        ),
        (Paper::Zhu2016, "zhu2016", &[""]),
        (Paper::Liu2017, "liu2017", &[""]),
    ] {
        assert_eq!((key.parse::<Paper>(), paper.key()), (Ok(paper), key));
        assert_eq!(paper.specification().paper.key, key);
        let scenarios = |choices: &Choices| -> Vec<String> {
            let all = paper.simulations(choices);
            all.iter()
                .map(|choices| choices.chosen("scenario").unwrap_or("").to_owned())
                .collect()
        };
        assert_eq!(scenarios(&Choices::default()), simulations);
        // Who chooses one has chosen; other choices stay.
        let chosen = Choices::of("scenario", "acceleration").with("mixing", "unmixed");
        assert_eq!(paper.simulations(&chosen), [chosen]);
        let other = Choices::of("mixing", "unmixed");
        assert!(
            paper
                .simulations(&other)
                .iter()
                .all(|choices| choices.chosen("mixing") == Some("unmixed"))
        );
    }
    let sentence = "zhu2015".parse::<Paper>().unwrap_err();
    assert_eq!(
        sentence,
        "there is no paper `zhu2015`; there are derbez2000, sustika2015, zhu2016, liu2017"
    );
}

/// Counted by hand in `spec/`: two scenarios of derbez2000 share some of their parameters, and each has others of its own.
#[test]
fn the_open_choices_of_a_scenario_are_those_of_its_own_parameters() {
    for (paper, scenario, count, own, of_others) in [
        (Paper::Derbez2000, "manoeuvres", 23, "turn-rate=9-left", "path=reversed"),
        (
            Paper::Derbez2000,
            "acceleration",
            13,
            "path=reversed",
            "turn-rate=9-left",
        ),
        (
            Paper::Sustika2015,
            "matched-straight",
            19,
            "truth=noise-free",
            "window=printed",
        ),
        (
            Paper::Sustika2015,
            "matched-manoeuvring",
            21,
            "window=printed",
            "window=toolbox",
        ),
    ] {
        let chosen = Choices::of("scenario", scenario);
        let open: Vec<String> = paper.open_choices(&chosen).iter().map(Choices::describe).collect();
        assert_eq!(open.iter().collect::<BTreeSet<_>>().len(), open.len(), "each once");
        assert_eq!(open.len(), count, "{scenario}: {open:?}");
        assert!(
            open.iter()
                .all(|choices| choices.contains(&format!("scenario={scenario}")))
        );
        let has = |choice: &str| open.iter().any(|choices| choices.split(", ").any(|one| one == choice));
        assert!(has(own) && !has(of_others), "{scenario}: {open:?}");
    }
    // The first scenario is meant where none is chosen; and no default is an open choice.
    let count = |paper: Paper| paper.open_choices(&Choices::default()).len();
    assert_eq!(Paper::ALL.map(count), [23, 19, 19, 13]);
    // Of all scenarios together, and the scenarios themselves.
    let all = |paper: Paper| paper.specification().single_alternatives().len();
    assert_eq!(Paper::ALL.map(all), [26, 24, 19, 13]);
    for paper in Paper::ALL {
        let parameters = &paper.specification().parameters;
        for choices in paper.specification().single_alternatives() {
            let name = choices.parameters().next().unwrap();
            let parameter = parameters.iter().find(|parameter| parameter.name == name).unwrap();
            assert_ne!(
                choices.chosen(name),
                Some(parameter.default.as_str()),
                "{}",
                choices.describe()
            );
        }
    }
}

#[test]
fn choices_are_read_as_they_are_written_and_checked_against_the_paper() {
    let texts = ["pairing = unpaired".to_owned(), "runs=100".to_owned()];
    let choices = Choices::parse(&texts).unwrap();
    assert_eq!(choices, Choices::of("runs", "100").with("pairing", "unpaired"));
    assert_eq!(choices.describe(), "pairing=unpaired, runs=100");
    assert_eq!(Choices::default().describe(), "defaults");
    assert_eq!(choices.parameters().collect::<Vec<_>>(), ["pairing", "runs"]);
    let sentence = |choices: &Choices| liu2017::scenario(choices).unwrap_err().to_string();
    assert_eq!(
        Choices::parse(&["runs".to_owned()]).unwrap_err().to_string(),
        "`runs` is not of the form parameter=alternative"
    );
    assert_eq!(
        sentence(&Choices::of("runs", "50")),
        "the parameter `runs` of liu2017 has no alternative `50`; it has 200, 100"
    );
    let unknown = sentence(&Choices::of("omtm-imm", "omitted"));
    assert!(
        unknown.starts_with("liu2017 has no parameter `omtm-imm`; it has initial-covariance, "),
        "{unknown}"
    );
    // A choice of another paper's parameter is left to that paper.
    let of_both = choices.clone().with("omtm-imm", "omitted");
    assert_eq!(Paper::Liu2017.specification().choices_of_this_paper(&of_both), choices);
    let of_zhu = Paper::Zhu2016.specification().choices_of_this_paper(&of_both);
    assert_eq!(of_zhu, Choices::of("omtm-imm", "omitted").with("pairing", "unpaired"));
    // The later choice wins.
    let other = Choices::of("runs", "200").with("likelihood", "printed");
    assert_eq!(
        choices.and(&other).describe(),
        "likelihood=printed, pairing=unpaired, runs=200"
    );
}

#[test]
fn a_row_of_a_table_is_of_one_simulation_and_one_figure() {
    use ErrorQuantity::{Position, Velocity, VelocityX, VelocityY, X, Y};
    let of_error = |quantity| Some(Figure::Error(quantity));
    let default = Choices::default;
    let scenario = |name: &str| Choices::of("scenario", name);
    for (paper, choices, table, row, expected) in [
        (Paper::Derbez2000, default(), 1, "x-RMS", of_error(X)),
        (Paper::Derbez2000, default(), 1, "y-RMS", of_error(Y)),
        (Paper::Derbez2000, default(), 1, "Overall", of_error(Position)),
        (Paper::Derbez2000, default(), 1, "Cost/flops", None),
        // Table 2 is of scenario 3, and scenario 1 has none.
        (Paper::Derbez2000, default(), 2, "x-RMS", None),
        (Paper::Derbez2000, scenario("acceleration"), 1, "x-RMS", None),
        (Paper::Sustika2015, default(), 4, "1st scenario", Some(Figure::FitError)),
        (Paper::Sustika2015, default(), 4, "2nd scenario", None),
        (Paper::Sustika2015, default(), 5, "1st scenario", None),
        (
            Paper::Sustika2015,
            scenario("mismatched-straight"),
            4,
            "2nd scenario",
            Some(Figure::FitError),
        ),
        (
            Paper::Sustika2015,
            scenario("matched-manoeuvring"),
            5,
            "1st scenario",
            Some(Figure::FitError),
        ),
        (
            Paper::Sustika2015,
            scenario("mismatched-manoeuvring"),
            5,
            "2nd scenario",
            Some(Figure::FitError),
        ),
        (
            Paper::Sustika2015,
            scenario("mismatched-manoeuvring"),
            6,
            "2nd scenario",
            None,
        ),
        (Paper::Zhu2016, default(), 1, "RMSE_X", of_error(X)),
        (Paper::Zhu2016, default(), 1, "RMSE_X_V", of_error(VelocityX)),
        (Paper::Zhu2016, default(), 1, "RMSE_Y", of_error(Y)),
        (Paper::Zhu2016, default(), 1, "RMSE_Y_V", of_error(VelocityY)),
        (Paper::Zhu2016, default(), 1, "Time", None),
        (Paper::Liu2017, default(), 1, "Position ARMSE", of_error(Position)),
        (Paper::Liu2017, default(), 1, "Velocity ARMSE", of_error(Velocity)),
        (Paper::Liu2017, default(), 2, "Number of Points", None),
    ] {
        assert_eq!(
            paper.figure_of_row(&choices, table, row),
            expected,
            "{paper:?}, {}, {row}",
            choices.describe()
        );
    }
}

// What is drawn

/// Where constant speed on a circle to the left leads in a second, in closed form, from [x, ẋ, y, ẏ] and a rate in rad/s.
fn on_a_circle(state: &Vector4<f64>, rate: f64) -> Vector4<f64> {
    let [x, vx, y, vy] = (*state).into();
    // The centre is at a right angle to the left of the velocity, at v/ω.
    let (centre_x, centre_y) = (x - vy / rate, y + vx / rate);
    let (sine, cosine) = rate.sin_cos();
    let (from_x, from_y) = (x - centre_x, y - centre_y);
    Vector4::new(
        centre_x + cosine * from_x - sine * from_y,
        cosine * vx - sine * vy,
        centre_y + sine * from_x + cosine * from_y,
        sine * vx + cosine * vy,
    )
}

/// Where a second of a motion leads without noise.
fn moved(motion: Course, [x, vx, y, vy]: [f64; 4]) -> Vector4<f64> {
    let rate = 3.0_f64.to_radians();
    match motion {
        Course::Straight => Vector4::new(x + vx, vx, y + vy, vy),
        Course::LeftTurn => on_a_circle(&Vector4::new(x, vx, y, vy), rate),
        Course::RightTurn => on_a_circle(&Vector4::new(x, vx, y, vy), -rate),
    }
}

/// The same random numbers, taken by hand in the order that is stated: initial estimate, then for each step process noise and measurement
/// noise.
#[test]
fn a_draw_takes_its_numbers_in_the_stated_order() {
    let drawn = Choices::of("initial-estimate", "drawn");
    let noisy = Choices::of("truth-noise", "as-in-the-filters");
    for (paper, choices) in [
        (Paper::Zhu2016, Choices::default()),
        (Paper::Zhu2016, drawn.clone().and(&noisy)),
        (Paper::Zhu2016, drawn.with("measurement", "range-bearing")),
        (Paper::Liu2017, Choices::default()),
        (Paper::Liu2017, noisy.with("first-measurement", "at-1-s")),
    ] {
        let scenario = paper.scenario(&choices).unwrap();
        let name = format!("{}, {}", paper.key(), choices.describe());
        let draw = scenario.draw(&mut Generator::new(5, 3));
        let mut numbers = Generator::new(5, 3);
        let mut four = |drawn: bool| Vector4::from_fn(|_, _| if drawn { numbers.standard_normal() } else { 0.0 });
        let start = four(scenario.draws_initial_estimate);
        let deviations = scenario.initial_covariance.diagonal().map(f64::sqrt);
        assert_eq!(
            draw.initial.mean,
            scenario.initial_state + deviations.component_mul(&start),
            "{name}"
        );
        assert_eq!(draw.initial.covariance, scenario.initial_covariance);
        let mut state = scenario.initial_state;
        for (k, motion) in scenario.schedule.iter().enumerate() {
            let noise = Vector4::from_fn(|_, _| match scenario.truth_noise_root {
                Some(_) => numbers.standard_normal(),
                None => 0.0,
            });
            let root = scenario.truth_noise_root.unwrap_or_else(Matrix4::zeros);
            let expected = moved(*motion, state.into()) + root * noise;
            // Some 10⁴ m and a radius of some 5000 m, in a dozen roundings.
            assert!((draw.truth[k] - expected).amax() < 1e-9, "{name}, step {k}");
            state = draw.truth[k];
            let seen = match scenario.sensor {
                Sensor::Linear(_) => Vector2::new(state[0], state[2]),
                _ => Vector2::new(state[0].hypot(state[2]), state[2].atan2(state[0])),
            };
            let noise = scenario
                .measurement_deviations
                .map(|deviation| deviation * numbers.standard_normal());
            // The platform's functions may differ in the last bit.
            assert!((draw.measurements[k] - seen - noise).amax() < 1e-9, "{name}, step {k}");
        }
    }
}

#[test]
fn the_targets_turn_when_and_where_the_papers_say() {
    let turns_of = |paper: Paper| turns(&paper.scenario(&Choices::default()).unwrap());
    assert_eq!(
        turns_of(Paper::Zhu2016),
        [(Course::RightTurn, 20.0, 39.0), (Course::LeftTurn, 60.0, 79.0)]
    );
    assert_eq!(
        turns_of(Paper::Liu2017),
        [(Course::RightTurn, 21.0, 70.0), (Course::LeftTurn, 121.0, 170.0)]
    );
    // Twenty seconds at 3°/s and fifty: 60° and 150°, first clockwise, then back.
    for (paper, degrees) in [(Paper::Zhu2016, 60.0), (Paper::Liu2017, 150.0)] {
        let scenario = paper.scenario(&Choices::default()).unwrap();
        let truth = scenario.draw(&mut Generator::new(1, 0)).truth;
        let heading = |state: &Vector4<f64>| state[3].atan2(state[1]).to_degrees();
        let first = heading(&scenario.initial_state);
        let middle = truth.len() / 2;
        let turned = (heading(&truth[middle]) - first + degrees).rem_euclid(360.0);
        assert!(turned.min(360.0 - turned) < 1e-9, "{turned}");
        assert!((heading(truth.last().unwrap()) - first).abs() < 1e-9);
    }
}

/// As the head of `truth` has it: the trajectory from stream 2m, six numbers a step, the measurements from stream 2m + 1.
#[test]
fn a_draw_of_sustika2015_takes_its_numbers_from_its_two_streams() {
    let scenario = sustika2015::scenario(&Choices::of("scenario", "matched-manoeuvring")).unwrap();
    for run in [0, 3] {
        let draw = scenario.trajectory.draw(run, 5);
        let [mut of_truth, mut of_radar] = [0, 1].map(|which| Generator::new(5, 2 * run as u64 + which));
        let mut state = Vector6::new(-1000.0, 1000.0, 4.0, 3.0, 0.0, 0.0);
        for (k, (truth, seen)) in draw.truth.iter().zip(&draw.measurements).enumerate() {
            if k > 0 {
                let noise = Vector6::from_fn(|_, _| of_truth.standard_normal());
                let expected = if seconds(&scenario).contains(&(k + 1)) {
                    accelerated(&state, &noise)
                } else {
                    straight(&state, &noise)
                };
                assert!((truth - expected).amax() < 1e-9, "run {run}, step {k}");
            }
            state = *truth;
            let range = state[0].hypot(state[1]) + 10.0 * of_radar.standard_normal();
            let bearing = state[1].atan2(state[0]) + 1.0_f64.to_radians() * of_radar.standard_normal();
            let turns = (bearing / std::f64::consts::TAU).round();
            assert!(
                (seen - Vector2::new(range, bearing - turns * std::f64::consts::TAU)).amax() < 1e-9,
                "run {run}, step {k}"
            );
        }
    }
}

/// A second of constant velocity with the noise whose covariance is q [1/3 1/2; 1/2 1], q = 0.1: lower triangular roots by hand.
fn straight(state: &Vector6<f64>, noise: &Vector6<f64>) -> Vector6<f64> {
    let along = |c: usize| {
        let (position, velocity) = (state[c] + state[c + 2], state[c + 2]);
        let (first, second) = (noise[c], noise[c + 2]);
        // √q times the root of [1/3 1/2; 1/2 1]: [1/√3 0; √3/2 1/2].
        let root = 0.1_f64.sqrt();
        let moved = root / 3.0_f64.sqrt() * first;
        [
            position + moved,
            velocity + root * (3.0_f64.sqrt() / 2.0 * first + 0.5 * second),
        ]
    };
    let ([x, vx], [y, vy]) = (along(0), along(1));
    Vector6::new(x, y, vx, vy, 0.0, 0.0)
}

/// A second of constant acceleration with the noise whose covariance is q [1/20 1/8 1/6; 1/8 1/3 1/2; 1/6 1/2 1].
fn accelerated(state: &Vector6<f64>, noise: &Vector6<f64>) -> Vector6<f64> {
    let along = |c: usize| {
        let [p, v, a] = [state[c], state[c + 2], state[c + 4]];
        let [first, second, third] = [noise[c], noise[c + 2], noise[c + 4]];
        let root = 0.1_f64.sqrt();
        // Its root, row by row: [√5/10 0 0], [√5/4 √3/12 0], [√5/3 √3/3 1/3].
        let (five, three) = (5.0_f64.sqrt(), 3.0_f64.sqrt());
        let noises = [
            five / 10.0 * first,
            five / 4.0 * first + three / 12.0 * second,
            five / 3.0 * first + three / 3.0 * second + third / 3.0,
        ];
        [
            p + v + a / 2.0 + root * noises[0],
            v + a + root * noises[1],
            a + root * noises[2],
        ]
    };
    let ([x, vx, ax], [y, vy, ay]) = (along(0), along(1));
    Vector6::new(x, y, vx, vy, ax, ay)
}

#[test]
fn the_run_that_is_shown_is_the_first_one() {
    let first_run = |paper: Paper, choices: &Choices| {
        let effort = Effort { runs: Some(2), seed: 4 };
        let reproduction = paper.reproduce(choices, effort, &|| ()).unwrap();
        let simulation = paper.simulation(choices).unwrap();
        let (errors, shown) = (simulation.one_run(0, 4), reproduction.first_run.unwrap());
        // What a filter estimated is the truth and its error.
        for (run, estimates) in errors.iter().zip(&shown.estimates) {
            for ((estimate, error), truth) in estimates.iter().zip(&run.errors).zip(&shown.truth) {
                assert_eq!(*estimate, [truth[0] + error[0], truth[1] + error[2]]);
            }
        }
        assert_eq!(
            (shown.estimates.len(), shown.truth.len()),
            (errors.len(), errors[0].errors.len())
        );
        (shown.truth, shown.measured, shown.sensor)
    };
    // The platform's sine and cosine may differ in the last bit, of some 10⁴ m.
    let assert_near = |measured: &[[f64; 2]], expected: Vec<[f64; 2]>| {
        assert_eq!(measured.len(), expected.len());
        let apart = measured
            .iter()
            .flatten()
            .zip(expected.iter().flatten())
            .map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-9);
    };
    let in_the_plane = |z: &Vector2<f64>| [z[0] * z[1].cos(), z[0] * z[1].sin()];

    let draw = |paper: Paper| {
        paper
            .scenario(&Choices::default())
            .unwrap()
            .draw(&mut Generator::new(4, 0))
    };
    let places = |truth: &[Vector4<f64>]| truth.iter().map(|state| [state[0], state[2]]).collect::<Vec<_>>();
    let (truth, measured, sensor) = first_run(Paper::Zhu2016, &Choices::default());
    let of_zhu = draw(Paper::Zhu2016);
    assert_eq!(
        (truth, sensor),
        (places(&of_zhu.truth), None),
        "positions are measured, from nowhere"
    );
    assert_near(&measured, of_zhu.measurements.iter().map(|z| (*z).into()).collect());

    let (truth, measured, sensor) = first_run(Paper::Liu2017, &Choices::default());
    let of_liu = draw(Paper::Liu2017);
    assert_eq!((truth, sensor), (places(&of_liu.truth), Some([0.0, 0.0])));
    assert_near(&measured, of_liu.measurements.iter().map(in_the_plane).collect());

    let (truth, measured, sensor) = first_run(Paper::Derbez2000, &Choices::of("debiasing", "multiplicative"));
    let scenario = derbez2000::scenario(&Choices::default()).unwrap();
    assert_eq!(truth, scenario.path.places.iter().map(position).collect::<Vec<_>>());
    // Without bias: e^(σ²/2) with σ² = 10⁻⁴ times what is seen at the defaults.
    let enlarged = |seen: &derbez2000::scenario::Seen| in_the_plane(&seen.polar).map(|x| x * (0.5e-4_f64).exp());
    assert_near(&measured, scenario.seen(0, 4).iter().map(enlarged).collect());
    assert_eq!(sensor, Some([0.0, 0.0]));

    for (alternative, first) in [("initiation", 1), ("filtered", 0)] {
        let (truth, measured, sensor) = first_run(Paper::Sustika2015, &Choices::of("first-measurement", alternative));
        let draw = sustika2015::scenario(&Choices::default())
            .unwrap()
            .trajectory
            .draw(0, 4);
        assert_eq!(
            truth,
            draw.truth[first..]
                .iter()
                .map(|state| [state[0], state[1]])
                .collect::<Vec<_>>()
        );
        assert_near(&measured, draw.measurements[first..].iter().map(in_the_plane).collect());
        assert_eq!(sensor, Some([0.0, 0.0]));
    }
}

// What is kept of a run of derbez2000

#[test]
fn what_is_kept_of_two_coordinates_is_an_error_in_the_plane_and_both_filters_words() {
    let scenario = derbez2000::scenario(&Choices::default()).unwrap();
    let cartesian = scenario.contestants[0].clone();
    let mut polar = cartesian.clone();
    polar.coordinates = Coordinates::Polar;
    for (problem, variance) in polar.problems.iter_mut().zip(scenario.variances) {
        problem.measurement_noise = nalgebra::Matrix1::new(variance);
    }
    let single = scenario.contestants[2].clone();
    for contestant in [&cartesian, &polar, &single] {
        let seen = scenario.seen(1, 1);
        let run = track_coordinates(&scenario, contestant, &seen);
        let mut k = 0;
        let mut keep = |steps: derbez2000::scenario::Steps, place: &PlaneState| {
            let [first, second] = steps.map(|step| step.combined.mean);
            let estimate = if contestant.coordinates == Coordinates::Polar {
                let (sine, cosine) = second[0].sin_cos();
                let across = first[0] * second[1];
                Vector4::new(
                    first[0] * cosine,
                    first[1] * cosine - across * sine,
                    first[0] * sine,
                    first[1] * sine + across * cosine,
                )
            } else {
                Vector4::new(first[0], first[1], second[0], second[1])
            };
            let truth = Vector4::new(place[0][0], place[0][1], place[1][0], place[1][1]);
            // Some 10⁴ m; the platform's sine and cosine may differ in the last bit.
            assert!(
                (run.errors[k] - (estimate - truth)).amax() < 1e-9,
                "{}, step {k}",
                contestant.name
            );
            let truth = contestant.coordinates.of(place);
            let both = |of: &dyn Fn(usize) -> f64| of(0) + of(1);
            assert_eq!(run.nees[k], both(&|c| nees(&steps[c].combined, &truth[c])));
            assert_eq!(run.nis[k], both(&|c| nis(steps[c]).unwrap()));
            let probabilities = steps.map(|step| step.mode_probabilities.clone()).concat();
            // Of a filter with one mode there is one number to show, and it is one.
            let shown = if contestant.name == "CA" {
                vec![1.0]
            } else {
                probabilities
            };
            assert_eq!(run.mode_probabilities[k], shown);
            k += 1;
        };
        follow(&scenario, contestant, &seen, &mut keep);
        assert_eq!((k, run.errors.len()), (70, 70));
    }
}

#[test]
fn a_filter_that_follows_the_noise_is_told_that_of_each_measurement_and_no_other_is() {
    for (alternative, follows) in [("mean", false), ("per-step", true)] {
        let scenario = derbez2000::scenario(&Choices::of("measurement-variance", alternative)).unwrap();
        let mean = scenario.setup.measurement_variances(&scenario.path);
        for contestant in [&scenario.contestants[0], &scenario.contestants[2]] {
            let seen = scenario.seen(0, 1);
            let mut measurements = seen.iter();
            let mut keep = |steps: derbez2000::scenario::Steps, _: &PlaneState| {
                let of_this = radar::converted_variances(measurements.next().unwrap().position, scenario.variances);
                let told = if follows { of_this } else { mean };
                for (step, told) in steps.iter().zip(told) {
                    for (predicted, innovation) in step.predicted.iter().zip(&step.innovation_covariances) {
                        let noise = innovation[0] - predicted.covariance[(0, 0)];
                        // S = P + R is rounded once.
                        assert!(
                            (noise - told).abs() < 1e-15 * innovation[0],
                            "{}: {noise} {told}",
                            contestant.name
                        );
                    }
                }
            };
            follow(&scenario, contestant, &seen, &mut keep);
            assert!(measurements.next().is_none());
        }
    }
}

#[test]
fn a_run_of_two_coordinates_ends_with_the_step_that_cannot_be_computed() {
    for alternative in ["mean", "per-step"] {
        let scenario = derbez2000::scenario(&Choices::of("measurement-variance", alternative)).unwrap();
        let mut seen = scenario.seen(0, 1);
        seen[4].position[1] = f64::NAN;
        for contestant in &scenario.contestants {
            let run = track_coordinates(&scenario, contestant, &seen);
            let failure = run.failure.expect("what is measured is no number");
            assert_eq!(failure.step, 5, "{}, {alternative}: {failure}", contestant.name);
            assert_eq!(
                [
                    run.errors.len(),
                    run.nees.len(),
                    run.nis.len(),
                    run.mode_probabilities.len()
                ],
                [4; 4]
            );
        }
    }
}

// What is asked of a scenario

fn variances(scenario: &Scenario) -> [f64; 2] {
    let noise = |contestant: &Contestant| contestant.problem.measurement_noise;
    let first = noise(&scenario.contestants[0]);
    assert!(scenario.contestants.iter().all(|contestant| noise(contestant) == first));
    assert_eq!(first[(0, 1)], 0.0);
    // The noise that is drawn is the noise that the filters assume, except for a root and a square.
    let drawn = scenario.measurement_deviations.map(|deviation| deviation * deviation);
    assert_eq!(drawn, first.diagonal());
    // A printed variance is its root squared: twice rounded.
    [0, 1].map(|i| {
        let nearest = format!("{:.14e}", first[(i, i)]);
        nearest.parse().unwrap()
    })
}

fn is_polar(scenario: &Scenario) -> bool {
    let from_origin = Sensor::Polar {
        components: vec![PolarComponent::Range, PolarComponent::Bearing],
        position: [0, 2],
        location: [0.0, 0.0],
    };
    let of_filters = scenario.contestants.iter().map(|contestant| &contestant.problem.sensor);
    of_filters
        .chain([&scenario.sensor])
        .all(|measurement| *measurement == from_origin)
}

fn same_noises(scenario: &Scenario, default: &Scenario, factor: f64) -> bool {
    let modes = |scenario: &Scenario| -> Vec<_> {
        let of = |contestant: &Contestant| contestant.problem.modes.clone();
        scenario.contestants.iter().flat_map(of).collect()
    };
    let pairs = modes(scenario).into_iter().zip(modes(default));
    // One rounding of the variance, and one or two of the entries.
    pairs.into_iter().all(|(mode, default)| {
        mode.motion == default.motion && (mode.noise - default.noise * factor).amax() < 1e-15 * 10.0
    })
}

fn chain(scenario: &Scenario) -> Vec<Vec<f64>> {
    scenario.contestants[0].problem.chain.clone()
}

/// Each turn with the times of the first and the last state that it reaches.
fn turns(scenario: &Scenario) -> Vec<(Course, f64, f64)> {
    let mut turns: Vec<(Course, f64, f64)> = Vec::new();
    for (motion, time) in scenario.schedule.iter().zip(scenario.times()) {
        match turns.last_mut() {
            Some((last, _, end)) if last == motion && *end + 1.0 == time => *end = time,
            _ if *motion != Course::Straight => turns.push((*motion, time, time)),
            _ => {}
        }
    }
    turns
}

fn names(scenario: &Scenario) -> Vec<String> {
    scenario.filters().into_iter().map(|filter| filter.name).collect()
}

fn rule(scenario: &Scenario, contestant: usize) -> Option<immaculate::rule::Rule<f64, U4>> {
    let [rule, _] = scenario.contestants[contestant].problem.filters[0].rules();
    rule.cloned()
}

/// The unscented rule with α = over/under, β and κ.
fn unscented(over: i64, under: i64, beta: i64, kappa: i64) -> immaculate::rule::Rule<f64, U4> {
    let ratio = immaculate::number::Rational::new;
    let parameters = immaculate::rule::unscented::Parameters {
        alpha: ratio(over, under),
        beta: ratio(beta, 1),
        kappa: ratio(kappa, 1),
    };
    RuleName::Unscented(Some(parameters)).rule().unwrap()
}

fn initial(scenario: &Scenario) -> [f64; 4] {
    assert_eq!(
        scenario.initial_covariance,
        Matrix4::from_diagonal(&scenario.initial_covariance.diagonal())
    );
    scenario.initial_covariance.diagonal().into()
}

fn noises(scenario: &derbez2000::scenario::CoordinateScenario) -> Vec<[f64; 2]> {
    let of = |c: &derbez2000::contestants::CoordinateFilters| {
        c.problems.each_ref().map(|problem| problem.measurement_noise[0])
    };
    scenario.contestants.iter().map(of).collect()
}

fn along(place: &PlaneState) -> Vector3<f64> {
    place[0]
}

fn position(place: &PlaneState) -> [f64; 2] {
    [place[0][0], place[1][0]]
}

/// x, ẋ and ẍ of ±2.5 (τ − 120)² at τ = 2k: whole numbers.
fn falls(k: i32, sign: f64) -> Vector3<f64> {
    let time = f64::from(2 * k - 120);
    Vector3::new(2.5 * time * time, 5.0 * time, 5.0) * sign
}

/// Whether the turn has this angle in degrees, and the rate that its acceleration gives.
fn turned(scenario: &derbez2000::scenario::CoordinateScenario, degrees: f64) -> bool {
    let turning: Vec<usize> = (0..scenario.path.motions.len())
        .filter(|k| scenario.path.motions[*k] == Regime::Turn)
        .collect();
    assert_eq!(turning, (20..50).collect::<Vec<_>>());
    let velocity = |k: usize| Vector2::new(scenario.path.places[k][0][1], scenario.path.places[k][1][1]);
    let rate = (degrees / 60.0).to_radians();
    turning.iter().all(|&k| {
        let (before, after, [x, y]) = (velocity(k - 1), velocity(k), scenario.path.places[k]);
        let angle = (before[0] * after[1] - before[1] * after[0]).atan2(before.dot(&after));
        let acceleration = Vector2::new(x[2], y[2]);
        // Speeds of 100 m/s and less; a few roundings of products.
        (angle - 2.0 * rate).abs() < 1e-13 && (acceleration - Vector2::new(-after[1], after[0]) * rate).norm() < 1e-12
    })
}

fn seconds(scenario: &sustika2015::scenario::RadarScenario) -> Vec<usize> {
    let motions = (2..).zip(&scenario.trajectory.motions);
    motions
        .filter(|(_, motion)| motion.name() == "constant acceleration")
        .map(|(second, _)| second)
        .collect()
}
