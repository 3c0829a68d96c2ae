//! Goal: the catalogue of variants says what the code does, and every variant does what its row says.
//!
//! Method: both halves are read, `spec/variants.toml` as data and `src/oracle/variant/` as text, and held against each other. Then every
//! variant is run in doubles beside the filter itself on small problems with generic numbers, on which no two terms are alike by chance,
//! and the first value that differs must be of the quantity that its row names. Kind of evidence: oracle.

use immaculate::filter::converted::converted_covariance;
use immaculate::filter::fixed_gain::FixedGain;
use immaculate::filter::{Filter, Transform, Update};
use immaculate::gaussian::{Gaussian, log_density};
use immaculate::imm::continuous::{rates_of_sojourns, transition_over};
use immaculate::imm::record::Input;
use immaculate::imm::state_conversion::{Reader, StateConversion, StateConversions};
use immaculate::imm::{Equations, Initial, Interaction, Needs, Problem, Quantity};
use immaculate::matrix::ldl;
use immaculate::model::function::Function;
use immaculate::model::motion::{Mode, Motion};
use immaculate::model::{Conversion, PolarComponent, Sensor};
use immaculate::number::Enclosure;
use immaculate::oracle::case::{self, Case, Expected};
use immaculate::oracle::chain::ChainOfRates;
use immaculate::oracle::run::Triangle;
use immaculate::oracle::setup::Setup;
use immaculate::oracle::trace::Trace;
use immaculate::oracle::variant::{Applies, Kind, Variant, apply, catalogue, find, read};
use immaculate::rule::{Rule, RuleName, unscented::unscented_in};
use nalgebra::{DMatrix, DVector, Dyn, dmatrix, dvector};
use std::collections::BTreeMap;
use std::collections::BTreeSet;
use std::num::NonZeroUsize;

/// What counts as another value, in parts of the quantity's size: far above the rounding of these problems (the greatest is 10⁻¹¹, of a
/// form that subtracts squares of positions), far below the effect of a mistake.
const CHANGE: f64 = 1e-6;

/// What counts as the same value; above the rounding of these problems.
const ROUNDING: f64 = 1e-9;

#[test]
fn the_two_halves_of_the_catalogue_agree() {
    let rows = read(include_str!("../spec/variants.toml")).expect("the catalogue can be read");
    assert_eq!(rows, catalogue());
    let ids: BTreeSet<String> = rows.iter().map(|variant| variant.id.clone()).collect();
    assert_eq!(ids.len(), rows.len(), "an id stands for one variant");
    let arms = names_in_the_code();
    let without_arm: Vec<_> = ids.difference(&arms).collect();
    let without_row: Vec<_> = arms.difference(&ids).collect();
    assert!(without_arm.is_empty(), "a row and no arm: {without_arm:?}");
    assert!(without_row.is_empty(), "an arm and no row: {without_row:?}");
    for variant in &rows {
        assert!(apply(&variant.id, &mut linear(3)), "{} is known", variant.id);
        assert!(apply(&variant.id, &mut polar(RULE)), "{} is known", variant.id);
        assert_eq!(find(&variant.id), Some(variant));
    }
    assert!(!apply("no-such-variant", &mut linear(3)));
    assert_eq!(find("no-such-variant"), None);
}

/// Exact: in the equation of its quantity, and, where it is another in filters that convert, in that one; by hand for one that has both.
#[test]
fn a_variant_is_made_in_the_equations_that_its_row_names() {
    let made_in = |variant: &Variant| {
        Quantity::ALL
            .into_iter()
            .filter(|quantity| variant.is_made_in(*quantity))
            .collect()
    };
    for variant in catalogue() {
        let named: BTreeSet<Quantity> = variant.converted.into_iter().chain([variant.quantity]).collect();
        let made: BTreeSet<Quantity> = made_in(variant);
        assert_eq!(made, named, "{}", variant.id);
        assert_eq!(serde_json::json!(variant.kind), variant.kind.name());
    }
    let both = find("measurement-noise-squared").unwrap();
    let expected = [Quantity::ConvertedMeasurement, Quantity::InnovationCovariance];
    assert_eq!(made_in(both), BTreeSet::from(expected));
    assert_eq!([true, false].map(|converts| both.quantity_in(converts)), expected);
}

#[test]
fn every_row_is_a_sentence_with_a_source() {
    for variant in catalogue() {
        let id = &variant.id;
        let is_word =
            |word: &str| !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit());
        assert!(
            id.split('-').count() > 1 && id.split('-').all(is_word),
            "{id}: words with hyphens"
        );
        assert!(
            variant.about.starts_with("you "),
            "{id}: it is said to the one who did it"
        );
        for text in [&variant.about, &variant.effect, &variant.source] {
            assert!(!text.is_empty() && !text.ends_with('.'), "{id}: {text:?}");
        }
        let is_convention = variant.kind == Kind::Convention;
        assert_eq!(variant.convention.is_some(), is_convention, "{id}");
        assert_eq!(variant.value.is_some(), is_convention, "{id}");
    }
    let mistakes = catalogue().iter().filter(|variant| variant.kind == Kind::Mistake);
    assert!(mistakes.count() >= 45);
}

#[test]
fn every_convention_is_one_that_a_program_can_declare() {
    let formats = include_str!("../spec/formats.md");
    let table = &formats[formats.find("## Conventions").expect("the table of conventions")..];
    let mut declared = BTreeSet::new();
    for variant in catalogue().iter().filter(|variant| variant.kind == Kind::Convention) {
        let (Some(key), Some(value)) = (&variant.convention, &variant.value) else {
            panic!("{}", variant.id)
        };
        let row = table.lines().find(|line| line.starts_with(&format!("| `{key}` |")));
        let others = row.expect("a row of the key").split('|').nth(3).expect("the others");
        assert!(others.contains(&format!("`{value}`")), "{}: {others}", variant.id);
        assert!(declared.insert((key, value)), "{} is there twice", variant.id);
    }
    let known: usize = table
        .lines()
        .filter(|line| line.starts_with("| `"))
        .map(others_known)
        .sum();
    assert_eq!(declared.len(), known, "every other convention has a variant");
}

#[test]
fn a_mistake_or_convention_first_changes_the_quantity_in_whose_equation_it_is_made() {
    for variant in catalogue().iter().filter(|variant| variant.kind != Kind::Form) {
        let mut is_seen = false;
        for scene in scenes().iter().filter(|scene| scene.name != ITERATED) {
            let (expected, found) = (scene.run(&[]), scene.run(&[&variant.id]));
            let first = first_change(&expected, &found, ROUNDING);
            let quantity = variant.quantity_in(scene.converts());
            is_seen |= first == first_change(&expected, &found, CHANGE) && first == Some(quantity);
            let is_earlier = first.is_some_and(|first| first < quantity);
            assert!(!is_earlier, "{} changes {first:?} first on {}", variant.id, scene.name);
        }
        assert!(is_seen, "{} first changes {:?} nowhere", variant.id, variant.quantity);
    }
}

/// The judge's view: the filter's equations, evaluated on a program's own earlier values, leave the named one unexplained, and nothing
/// before it in the step; the variant's own equations leave nothing unexplained.
#[test]
fn along_its_own_values_a_variant_is_seen_where_it_is_made() {
    // Of this one the covariances are squared twice a step: soon the points' mean has no digits left, and then they overflow.
    let overflows = |variant: &Variant| variant.id == "points-without-root";
    let variants = catalogue()
        .iter()
        .filter(|variant| variant.kind != Kind::Form && !overflows(variant));
    for variant in variants {
        let mut is_seen = false;
        for scene in scenes().iter().filter(|scene| scene.name != ITERATED) {
            let shown = scene.run(&[&variant.id]);
            let unexplained = changes(&shown, &scene.along(&[], &shown));
            let made_in = variant.quantity_in(scene.converts());
            is_seen |= unexplained.contains(&made_in);
            let is_first = unexplained.iter().all(|&quantity| quantity >= made_in);
            assert!(is_first, "{} on {}: {unexplained:?}", variant.id, scene.name);
            let rest = changes(&shown, &scene.along(&[&variant.id], &shown));
            assert!(rest.is_empty(), "{} on {}: {rest:?}", variant.id, scene.name);
        }
        assert!(is_seen, "{} leaves {:?} explained", variant.id, variant.quantity);
    }
}

#[test]
fn a_form_changes_nothing_but_rounding() {
    for variant in catalogue().iter().filter(|variant| variant.kind == Kind::Form) {
        let mut is_another = false;
        for scene in scenes() {
            let (expected, found) = (scene.run(&[]), scene.run(&[&variant.id]));
            assert_eq!(expected.count(), found.count(), "{} on {}", variant.id, scene.name);
            let first = first_change(&expected, &found, ROUNDING);
            assert_eq!(first, None, "{} on {}", variant.id, scene.name);
            is_another |= expected != found;
        }
        assert!(is_another, "{} is the same arithmetic", variant.id);
    }
}

#[test]
fn a_variant_changes_nothing_where_it_does_not_apply() {
    let mut left_alone = BTreeSet::new();
    for variant in catalogue() {
        for scene in scenes().iter().filter(|scene| !variant.applies_to(&scene.setup)) {
            let (expected, found) = (scene.run(&[]), scene.run(&[&variant.id]));
            let first = first_change(&expected, &found, ROUNDING);
            assert_eq!(first, None, "{} on {}", variant.id, scene.name);
            left_alone.insert(format!("{:?}", variant.applies));
        }
    }
    assert_eq!(left_alone.len(), 20, "each limit was met: {left_alone:?}");
}

/// Exact, by hand: the words for where a variant can make a difference, in filters of each kind.
#[test]
fn a_variant_leaves_every_published_case_alone_to_which_it_does_not_apply() {
    let is_short = |case: &&Case| case.problem.measurements.len() <= 10 && matches!(case.expected, Expected::Trace(_));
    let mut changed = BTreeSet::new();
    for case in case::all().unwrap().iter().filter(is_short) {
        let setup = case.problem.setup_in_doubles().unwrap();
        let own = setup.run().in_doubles();
        for variant in catalogue().iter().filter(|variant| !variant.applies_to(&setup)) {
            let mut other = setup.clone();
            assert!(apply(&variant.id, &mut other));
            if other.run().in_doubles() != own {
                changed.insert((&variant.id, &case.problem.id));
            }
        }
    }
    assert!(changed.is_empty(), "{changed:?}");
}

#[test]
fn where_a_variant_applies_is_what_its_word_says() {
    let words = |is_met: &dyn Fn(Applies) -> bool| -> BTreeSet<&str> {
        let all = catalogue().iter().map(|variant| variant.applies);
        all.filter(|applies| is_met(*applies)).map(Applies::name).collect()
    };
    let everywhere = ["all", "missed", "several modes"];
    let kalman = ["kalman", "covariances"];
    let dimensions = ["embedded motion", "unequal dimensions"];
    let of = |setup: &Setup<f64>| words(&|applies| applies.to(setup));
    let expected = |more: &[&[&'static str]]| everywhere.into_iter().chain(more.concat()).collect::<BTreeSet<_>>();
    assert_eq!(of(&linear(3)), expected(&[&kalman]));
    assert_eq!(of(&embedded()), expected(&[&kalman, &dimensions[..1]]));
    assert_eq!(of(&unequal(embedded())), expected(&[&kalman, &dimensions]));
    assert_eq!(
        of(&polar(RULE)),
        expected(&[&["points", "covariances", "angles", "bearings"]])
    );
    assert_eq!(of(&fixed(Interaction::Imm)), expected(&[&["fixed gains"]]));
    assert_eq!(of(&sojourns()), expected(&[&kalman, &["rates", "sojourn times"]]));
    assert_eq!(of(&common_start()), expected(&[&kalman, &["common start"]]));
    let separate = separate_states(Filter::kalman());
    assert_eq!(of(&separate), expected(&[&kalman, &["state conversions"]]));
    let of_converted = expected(&[&kalman, &dimensions, &["conversions", "bearings"]]);
    assert_eq!(of(&converted(Conversion::Standard)), of_converted);
    let mut one = linear(1);
    one.measurements[2] = one.measurements[1].clone();
    assert_eq!(of(&one), BTreeSet::from(["all", "kalman", "covariances"]));
}

#[test]
fn no_two_variants_are_the_same() {
    let scenes = scenes();
    let variants = catalogue().iter().filter(|variant| variant.kind != Kind::Form);
    let runs: Vec<(&str, Vec<Trace>)> = variants
        .map(|variant| {
            (
                variant.id.as_str(),
                scenes.iter().map(|scene| scene.run(&[&variant.id])).collect(),
            )
        })
        .collect();
    let mut same = Vec::new();
    for (place, (id, runs_of_one)) in runs.iter().enumerate() {
        for (other_id, runs_of_other) in &runs[..place] {
            let mut pairs = runs_of_one.iter().zip(runs_of_other);
            if pairs.all(|(a, b)| a.count() == b.count() && first_change(a, b, ROUNDING).is_none()) {
                same.push((*id, *other_id));
            }
        }
    }
    assert!(same.is_empty(), "{same:?}");
}

/// The values of a program with two mistakes, judged along its own values: the equations that do not explain them are those of the two.
#[test]
fn two_variants_compose() {
    let pairs = [
        ("transition-transposed", "measurement-noise-omitted"),
        ("mixed-spread-omitted", "determinant-omitted"),
        ("process-noise-doubled", "combined-spread-omitted"),
        ("innovation-reversed", "update-subtracted"),
        ("normaliser-22", "initial-probabilities-equal"),
    ];
    for (first, second) in pairs {
        let both = varied(linear(3), &[first, second]);
        let shown = both.run().values;
        let unexplained = changes(
            &shown,
            &linear(3).run_along(&shown, |value| value, Triangle::Lower).values,
        );
        let named = [first, second].map(|id| find(id).expect("it is in the catalogue").quantity);
        for quantity in named {
            assert!(unexplained.contains(&quantity), "{first} and {second}: {quantity:?}");
        }
        let other_way = varied(linear(3), &[second, first]).run().values;
        assert_eq!(other_way, shown, "{first} and {second} in the other order");
        // Each alone does not explain what both did.
        for id in [first, second] {
            let alone = varied(linear(3), &[id])
                .run_along(&shown, |value| value, Triangle::Lower)
                .values;
            assert!(!changes(&shown, &alone).is_empty(), "{id}");
        }
        let explained = both.run_along(&shown, |value| value, Triangle::Lower).values;
        assert!(changes(&shown, &explained).is_empty(), "{first} and {second}");
    }
}

/// An innovation of the other sign that is subtracted is right in the end.
#[test]
fn two_wrongs_can_make_a_right() {
    let expected = linear(3).run().values;
    let found = varied(linear(3), &["innovation-reversed", "update-subtracted"])
        .run()
        .values;
    assert_eq!(changes(&expected, &found), BTreeSet::from([Quantity::Innovation]));
}

/// A variant can be certified: on enclosures every value has an answer, and it is the one that doubles give.
#[test]
fn every_variant_can_be_evaluated_on_enclosures() {
    for variant in catalogue() {
        for mut setup in [linear(3), polar("cubature-3"), fixed(Interaction::Imm)] {
            // Two steps, and a detection in the first only: along the way doubles lose the digits of filters that are very wrong.
            setup.measurements.truncate(2);
            setup.measurements[1] = None;
            let doubles = varied(setup.clone(), &[&variant.id]).run().values;
            let certified = Enclosure::with_precision(300, || {
                let mut setup = on_enclosures(&setup);
                assert!(apply(&variant.id, &mut setup), "{}", variant.id);
                setup
                    .run()
                    .values
                    .map(|_, values| values.iter().map(middle).collect::<Vec<f64>>())
            });
            let first = first_change(&certified, &doubles, ROUNDING);
            assert_eq!(first, None, "{}", variant.id);
            // Rounding gives a singular covariance an inverse, and an enclosure does not.
            let count = |values: &Trace| {
                let places = values.all_places().filter(|place| place.1 != Quantity::Nees);
                places
                    .filter(|place| values.get(place.0, place.1, place.2).is_some())
                    .count()
            };
            assert_eq!(count(&certified), count(&doubles), "{}", variant.id);
        }
    }
}

/// The symmetric root and the upper one are roots: the points have the predicted covariance, as with the lower one, so that a linear
/// measurement of the points has the right covariances.
#[test]
fn every_square_root_gives_the_same_filter_on_a_linear_problem() {
    let mut setup = linear(3);
    setup.problem.filters = vec![points(RULE)];
    let expected = setup.run().values;
    for id in ["square-root-upper", "square-root-symmetric"] {
        let found = varied(setup.clone(), &[id]).run().values;
        assert_eq!(first_change(&expected, &found, ROUNDING), None, "{id}");
        assert_eq!(expected.count(), found.count());
    }
}

/// Where nothing was measured, the noise that a converting filter would have used is known only where it expected the measurement: at the
/// combined prediction. By P⁻ − P⁻ Hᵀ (H P⁻ Hᵀ + R^c)⁻¹ H P⁻ on the run's own values, with nalgebra's inverse.
#[test]
fn a_covariance_updated_without_a_detection_uses_the_converted_noise_at_the_prediction() {
    let setup = varied(
        converted(Conversion::Standard),
        &["missed-detection-updates-the-covariance"],
    );
    let step = 1 + setup.measurements.iter().position(Option::is_none).unwrap();
    let run = setup.run().values;
    let (sensor, measurement_noise) = (&setup.problem.sensor, &setup.problem.measurement_noise);
    let prediction = run.get(step, Quantity::CombinedPredictionMean, 0).unwrap();
    let at = sensor.of(&DVector::from_column_slice(prediction));
    let noise = converted_covariance(Conversion::Standard, sensor, &at, measurement_noise).unwrap();
    let h = &*setup.problem.h();
    for j in 0..setup.problem.modes.len() {
        let of_mode = |quantity| DMatrix::from_row_slice(4, 4, run.get(step, quantity, j).unwrap());
        let predicted = of_mode(Quantity::PredictedCovariance);
        let updated = |noise: &DMatrix<f64>| {
            let innovation_covariance = h * &predicted * h.transpose() + noise;
            let gain = &predicted * h.transpose() * innovation_covariance.try_inverse().unwrap();
            &predicted - gain * h * &predicted
        };
        let (found, expected) = (of_mode(Quantity::UpdatedCovariance), updated(&noise));
        assert!(
            (&found - &expected).amax() < ROUNDING * predicted.amax(),
            "mode {j}: {found} {expected}"
        );
        // R itself, in metres and radians, is another noise.
        assert!((found - updated(measurement_noise)).amax() > CHANGE * predicted.amax());
    }
}

/// The judge looks for the cause of a wrong value among the values that it is computed from. So these are found out: along shown values,
/// one of which is moved, exactly those move that are computed from it.
#[test]
fn a_value_is_computed_from_its_inputs_and_from_nothing_else() {
    let (mut seen, mut declared) = (BTreeSet::new(), BTreeSet::new());
    for setup in [
        linear(3),
        polar("cubature-3"),
        converted(Conversion::Standard),
        fixed(Interaction::Imm),
        extended(),
    ] {
        let shown = setup.run().values;
        let before = setup.run_along(&shown, |value| value, Triangle::Lower).values;
        let is_detected = |step: usize| setup.measurements[step - 1].is_some();
        let has = |step, needed| setup.problem.has(needed, 0) && (is_detected(step) || needed != Needs::Detection);
        let exists = |step, quantity: Quantity| quantity.exists(|needed| has(step, needed));
        let pair = |step, quantity: Quantity, input: Input| {
            let has_covariances = setup.problem.has_covariances();
            (quantity, format!("{input:?}"), is_detected(step), has_covariances)
        };
        for (step, moved, mode) in shown.all_places() {
            assert_eq!(shown.get(step, moved, mode).is_some(), exists(step, moved), "{moved:?}");
            let Some(values) = shown.get(step, moved, mode) else {
                continue;
            };
            let mut other = shown.clone();
            other.set(
                step,
                moved,
                mode,
                values.iter().map(|value| value * 1.001 + 1e-4).collect(),
            );
            let after = setup.run_along(&other, |value| value, Triangle::Lower).values;
            for place in before.all_places() {
                let (of_step, quantity, _) = place;
                let input = if of_step == step {
                    Input::Now(moved)
                } else {
                    Input::Before(moved)
                };
                let is_next = of_step == step || of_step == step + 1;
                let is_declared = is_next
                    && quantity
                        .inputs(|needed| has(of_step, needed))
                        .any(|declared| declared == input);
                if is_declared && exists(of_step, quantity) {
                    declared.insert(pair(of_step, quantity, input));
                }
                if differs(&before, &after, place, ROUNDING) {
                    assert!(is_declared, "{quantity:?} is computed from {input:?}");
                    seen.insert(pair(of_step, quantity, input));
                }
            }
        }
    }
    // What is declared and without effect: points about a mean have this mean, however far they are from it; and where deviations sum to
    // zero, it does not matter about which point the others are taken.
    let hidden = [
        (
            Quantity::PredictedMean,
            Input::Now(Quantity::MixedCovariance),
            false,
            true,
        ),
        (
            Quantity::PredictedMean,
            Input::Now(Quantity::MixedCovariance),
            true,
            true,
        ),
        (
            Quantity::CrossCovariance,
            Input::Now(Quantity::PredictedMeasurement),
            true,
            true,
        ),
    ];
    let hidden = hidden
        .map(|(quantity, input, is_detected, covariances)| (quantity, format!("{input:?}"), is_detected, covariances));
    let unseen: Vec<_> = declared.difference(&seen).cloned().collect();
    assert_eq!(unseen, hidden);
}

/// What is computed without a detection is computed from what is there without one.
#[test]
fn without_a_detection_nothing_is_computed_from_one() {
    for (covariances, conversions) in [(true, true), (true, false), (false, false)] {
        let has = |needed| match needed {
            Needs::Covariances => covariances,
            Needs::Conversion => conversions,
            Needs::LinearisedMotion | Needs::LinearisedMeasurement => covariances && !conversions,
            Needs::Detection | Needs::Iterations => false,
            Needs::Consistency | Needs::Truth => true,
        };
        for quantity in Quantity::ALL.into_iter().filter(|quantity| quantity.exists(has)) {
            for Input::Now(input) | Input::Before(input) in quantity.inputs(has) {
                assert!(input.exists(has), "{quantity:?} from {input:?}");
            }
        }
    }
}

/// Of the quantities of two rows and two columns exactly the covariances are symmetric, where a problem's numbers are generic.
#[test]
fn the_covariances_are_the_symmetric_matrices() {
    let run = square(3).run().values;
    let mut symmetric = BTreeSet::new();
    for (step, quantity, mode) in run.all_places() {
        if let (2, Some(values)) = (quantity.rank(), run.get(step, quantity, mode)) {
            let is_symmetric = (values[1] - values[2]).abs() <= ROUNDING * values[1].abs();
            assert_eq!(is_symmetric, quantity.is_covariance(), "{quantity:?}");
            symmetric.insert(quantity);
        }
    }
    assert!(symmetric.contains(&Quantity::Gain) && symmetric.contains(&Quantity::CombinedCovariance));
}

/// What a filter measures is what it uses: the converted measurement where it converts. An innovation reversed is the innovation with the
/// other sign, to the last bit, and the residual of the updated mean is z − H x̂ = ν + ẑ − H x̂.
#[test]
fn the_residuals_of_variants_are_of_what_the_filter_uses() {
    for setup in [linear(3), converted(Conversion::Standard)] {
        let shown = setup.run().values;
        let along = |id| {
            let varied = varied(setup.clone(), &[id]);
            varied.run_along(&shown, |value| value, Triangle::Lower).values
        };
        let (reversed, updated) = (along("innovation-reversed"), along("likelihood-of-updated-residual"));
        let innovations = shown.all_places().filter(|place| place.1 == Quantity::Innovation);
        for (step, quantity, j) in innovations.filter(|place| setup.measurements[place.0 - 1].is_some()) {
            let values = |quantity| shown.get(step, quantity, j).unwrap();
            let negative: Vec<f64> = values(quantity).iter().map(|value| -value).collect();
            assert_eq!(reversed.get(step, quantity, j), Some(&negative));
            let vector = |quantity| DVector::from_column_slice(values(quantity));
            let (mean, predicted) = (vector(Quantity::UpdatedMean), vector(Quantity::PredictedMeasurement));
            let residual = vector(quantity) + predicted - &*setup.problem.h() * mean;
            let covariance = DMatrix::from_row_slice(2, 2, values(Quantity::InnovationCovariance));
            let expected = log_density(&residual, &ldl(&covariance));
            let found = updated.get(step, Quantity::LogLikelihood, j).unwrap()[0];
            assert!(
                (found - expected).abs() < ROUNDING * expected.abs(),
                "{found} {expected}"
            );
        }
    }
}

// Problems with generic numbers

const RULE: &str = "cubature-5";

/// The scenes whose likelihoods are beyond doubles.
const OUTLIERS: [&str; 2] = ["outlier", "faint"];

/// A problem and its name.
struct Scene {
    name: &'static str,
    setup: Setup<f64>,
}

impl Scene {
    fn run(&self, ids: &[&str]) -> Trace {
        varied(self.setup.clone(), ids).run().values
    }

    fn along(&self, ids: &[&str], shown: &Trace) -> Trace {
        let varied = varied(self.setup.clone(), ids);
        varied.run_along(shown, |value| value, Triangle::Lower).values
    }

    fn converts(&self) -> bool {
        self.setup.problem.conversion().is_some()
    }
}

fn varied(mut setup: Setup<f64>, ids: &[&str]) -> Setup<f64> {
    for id in ids {
        assert!(apply(id, &mut setup), "{id}");
    }
    setup
}

fn scenes() -> Vec<Scene> {
    let mut other_order = polar("cubature-3");
    let scaled = unscented_in(Dyn(4), &0.5, &2.0, &0.0).unwrap();
    if let Sensor::Polar { components, .. } = &mut other_order.problem.sensor {
        components.reverse();
    }
    other_order.problem.filters = vec![Filter::points(scaled)];
    for z in other_order.measurements.iter_mut().flatten() {
        *z = dvector![z[1], z[0]];
    }
    let noise = &mut other_order.problem.measurement_noise;
    *noise = dmatrix![noise[(1, 1)], noise[(0, 1)]; noise[(0, 1)], noise[(0, 0)]];

    let mut outlier = linear(2);
    outlier.measurements[1] = Some(dvector![900.0, -700.0]);
    // Log-likelihoods of about −1022 and −699: below and above the logarithm of the smallest normal double, −708.
    let mut faint = linear(2);
    faint.measurements[0] = Some(dvector![132.0, -91.2]);
    let mut drawing = linear(2);
    drawing.problem.filters = vec![points("simplex-5")];
    let scenes = vec![
        ("linear", linear(3)),
        ("one mode", linear(1)),
        (OUTLIERS[0], outlier),
        (OUTLIERS[1], faint),
        ("linear with points", drawing),
        ("fixed gains", fixed(Interaction::Imm)),
        ("fixed gains, unmixed", fixed(Interaction::Unmixed)),
        ("common start", common_start()),
        ("sojourn times", sojourns()),
        ("embedded", embedded()),
        ("unequal dimensions", unequal(embedded())),
        ("converted", converted(Conversion::Standard)),
        ("converted and debiased", converted(Conversion::Additive)),
        ("fifth degree", polar(RULE)),
        ("simplex", polar("simplex-5")),
        ("scaled unscented", other_order),
        ("square", square(2)),
        ("extended", extended()),
        (ITERATED, iterated()),
        ("correlated noises", correlated()),
        ("changing steps", changing()),
        ("states of their own", separate_states(Filter::kalman())),
        ("states of their own, with points", separate_states(points(RULE))),
        ("heading", heading(Filter::extended())),
        ("heading with points", heading(points(RULE))),
        ("scalar", generic(1, 2, Sensor::Linear(dmatrix![0.8]), Filter::kalman())),
    ];
    scenes.into_iter().map(|(name, setup)| Scene { name, setup }).collect()
}

/// A filter with the points of a rule, for four entries of the state.
fn points(rule: &str) -> Filter<f64, Dyn, Dyn> {
    Filter::points(rule.parse::<RuleName>().unwrap().rule_in(Dyn(4)).unwrap())
}

/// Kalman filters.
fn linear(modes: usize) -> Setup<f64> {
    let mut h = matrix(2, 4, 80, 0.2);
    h[(0, 0)] += 1.0;
    h[(1, 2)] += 1.0;
    let mut setup = generic(4, modes, Sensor::Linear(h), Filter::kalman());
    setup.measurements[2] = None;
    setup
}

/// All modes start from the combined estimate.
fn common_start() -> Setup<f64> {
    let mut setup = linear(3);
    setup.problem.interaction = Interaction::Gpb1;
    setup
}

/// A chain that is given by sojourn times.
fn sojourns() -> Setup<f64> {
    let mut setup = linear(3);
    let jumps = [[0.0, 0.75, 0.25], [0.5, 0.0, 0.5], [0.875, 0.125, 0.0]];
    let (times, jumps) = (vec![3.0, 0.5, 2.0], jumps.map(|row| row.to_vec()).to_vec());
    let (rates, interval) = (rates_of_sojourns(&times, &jumps), 0.7);
    setup.problem.chain = transition_over(&rates, &interval);
    let sojourns = Some((times, jumps));
    let chain = ChainOfRates {
        rates,
        sojourns,
        interval,
    };
    setup.rates.insert(0, chain);
    setup
}

/// Kalman filters of as many measurements as entries of the state.
fn square(modes: usize) -> Setup<f64> {
    let h = matrix(2, 2, 70, 0.3) + DMatrix::identity(2, 2);
    generic(2, modes, Sensor::Linear(h), Filter::kalman())
}

/// Kalman filters whose noises have something in common.
fn correlated() -> Setup<f64> {
    let mut setup = linear(3);
    let filter = Filter::kalman().with_noise_cross_covariance(matrix(4, 2, 90, 0.4));
    setup.problem.filters = vec![filter];
    assert_eq!(setup.problem.check(&setup.initial).err(), None);
    setup
}

/// A scene in which R is used before it is shown: the last of several linearisations is where those before it have led.
const ITERATED: &str = "iterated";

/// Extended filters that linearise the measurement three times.
fn iterated() -> Setup<f64> {
    let mut setup = extended();
    for filter in &mut setup.problem.filters {
        filter.update = Update::Iterated(NonZeroUsize::new(3).unwrap());
    }
    setup
}

/// Filters with fixed gains: those of the initial covariances, so that the filter follows what it measures.
fn fixed(interaction: Interaction<f64, Dyn>) -> Setup<f64> {
    let mut setup = linear(3);
    let h = setup.problem.h().into_owned();
    let of_mode = |estimate: &Gaussian<f64, Dyn>| {
        let innovation_covariance = &h * &estimate.covariance * h.transpose() + &setup.problem.measurement_noise;
        let inverse = innovation_covariance.clone().try_inverse().unwrap();
        Filter::given(FixedGain {
            gain: &estimate.covariance * h.transpose() * inverse,
            innovation_covariance: (&innovation_covariance + innovation_covariance.transpose()) / 2.0,
        })
    };
    setup.problem.filters = setup.initial.modes.iter().map(of_mode).collect();
    setup.problem.interaction = interaction;
    for estimate in &mut setup.initial.modes {
        estimate.covariance.fill(0.0);
    }
    assert_eq!(setup.problem.check(&setup.initial).err(), None);
    setup
}

/// Kalman filters of which one sets an entry of the state to zero.
fn embedded() -> Setup<f64> {
    let mut setup = linear(3);
    setup.problem.modes[1].motion.matrix_mut().unwrap().row_mut(3).fill(0.0);
    setup
}

/// Converted measurements, of modes of unequal dimensions.
fn converted(conversion: Conversion) -> Setup<f64> {
    let mut setup = unequal(polar(RULE));
    setup.problem.filters = vec![Filter::converted(conversion)];
    setup.problem.measurement_noise = dmatrix![4.0, 0.0; 0.0, 0.01];
    setup
}

/// The second mode lacks the last entry of the state.
fn unequal(mut setup: Setup<f64>) -> Setup<f64> {
    let mode = &mut setup.problem.modes[1];
    mode.motion.matrix_mut().unwrap().row_mut(3).fill(0.0);
    mode.noise.row_mut(3).fill(0.0);
    mode.noise.column_mut(3).fill(0.0);
    setup
}

/// Range and bearing from a sensor to the east of the target, so that the bearing is cut where the target is.
fn polar(rule: &str) -> Setup<f64> {
    let sensor = Sensor::Polar {
        components: vec![PolarComponent::Range, PolarComponent::Bearing],
        position: [0, 2],
        location: [3.0, -2.0],
    };
    let mut setup = generic(4, 3, sensor, points(rule));
    setup.problem.measurement_noise = dmatrix![4.0, 0.02; 0.02, 0.01];
    for (j, estimate) in setup.initial.modes.iter_mut().enumerate() {
        estimate.mean = dvector![-50.0 + index(j), 0.7, -1.5 - 0.3 * index(j), 0.4];
        estimate.covariance *= 4.0;
    }
    let bearings = [3.1, -3.12, 3.05, -3.0, 3.13];
    for (k, z) in setup.measurements.iter_mut().enumerate() {
        *z = Some(dvector![52.0 + 1.3 * value(200 + k), bearings[k]]);
    }
    setup.measurements[3] = None;
    setup
}

/// A heading on both sides of ±π in the state [x, y, speed, heading], and a position that is measured.
fn heading(filter: Filter<f64, Dyn, Dyn>) -> Setup<f64> {
    let mut h = DMatrix::zeros(2, 4);
    h[(0, 0)] = 1.0;
    h[(1, 1)] = 1.0;
    let mut setup = generic(4, 3, Sensor::Linear(h), filter);
    for (j, mode) in setup.problem.modes.iter_mut().enumerate() {
        // Straight on, whatever the heading, which turns by itself: points of a linear motion have the means of matrices.
        let Motion::Linear(f) = &mut mode.motion else {
            panic!("a matrix")
        };
        f.row_mut(3).fill(0.0);
        f[(3, 3)] = 1.0;
        mode.motion = Motion::Affine {
            matrix: f.clone(),
            offset: dvector![-4.0, 0.0, 0.0, 0.3 * index(j)],
        };
        mode.noise *= 0.05;
    }
    setup.problem.angles = vec![3];
    for (j, estimate) in setup.initial.modes.iter_mut().enumerate() {
        estimate.mean = dvector![10.0 + index(j), -3.0, 4.0 + 0.5 * index(j), [3.0, -3.1, -2.9][j]];
        estimate.covariance *= 0.02; // no point is half a turn from its mean
    }
    for (k, z) in setup.measurements.iter_mut().enumerate() {
        *z = Some(dvector![6.5 - 3.9 * index(k), -3.4 + value(300 + k)]);
    }
    setup.measurements[3] = None;
    assert_eq!(setup.problem.check(&setup.initial).err(), None);
    setup
}

/// The second of three modes has a state of its own. It is read by a matrix, and reads the others by functions; one adds something.
fn separate_states(filter: Filter<f64, Dyn, Dyn>) -> Setup<f64> {
    let mut setup = linear(3);
    setup.problem.filters = vec![filter];
    let state = ["a", "b", "c", "d"];
    let function = |formulas: [&str; 4]| {
        let formulas: Vec<(&str, &str)> = state.into_iter().zip(formulas).collect();
        Motion::Function {
            function: Function::of_formulas(&state, &[], &[], &[], &formulas).unwrap().into(),
            given: Vec::new(),
        }
    };
    let back = matrix(4, 4, 900, 0.2) + DMatrix::identity(4, 4);
    let conversion = |from, to, map, added: DMatrix<f64>| StateConversion { from, to, map, added };
    let zero = || DMatrix::zeros(4, 4);
    let bent = ["a + 0.02*b*c", "1.2*b - 0.1*a", "c + 0.01*a*a", "d + 0.3*b"];
    let curved = ["1.1*a - 0.01*b*d", "b + 0.2*c", "c - 0.02*a*d", "0.9*d"];
    let list = vec![
        conversion(
            0,
            Reader::Mode(1),
            function(bent),
            DMatrix::from_diagonal(&dvector![0.0, 0.3, 0.0, 0.7]),
        ),
        conversion(2, Reader::Mode(1), function(curved), zero()),
        conversion(1, Reader::Mode(0), Motion::Linear(back.clone()), zero()),
        conversion(1, Reader::Mode(2), Motion::Linear(back.clone()), zero()),
        conversion(1, Reader::Common, Motion::Linear(back), zero()),
    ];
    let angles = vec![vec![]; 3];
    setup.problem.interaction = Interaction::Converted(StateConversions { list, angles });
    assert_eq!(setup.problem.check(&setup.initial).err(), None);
    setup
}

/// Kalman filters whose steps differ.
fn changing() -> Setup<f64> {
    let mut setup = linear(3);
    for step in [2, 4, 5] {
        let (mut problem, k) = (setup.problem.clone(), index(step));
        for mode in &mut problem.modes {
            *mode.motion.matrix_mut().unwrap() *= 1.0 + 0.05 * k;
            mode.noise *= 1.0 + 0.3 * k;
        }
        problem.measurement_noise *= 1.0 + 0.2 * k;
        setup.changes.insert(step, problem);
    }
    setup
}

/// Extended filters of range and bearing; the first mode moves along a curve.
fn extended() -> Setup<f64> {
    let mut setup = polar(RULE);
    setup.problem.filters = vec![Filter::extended()];
    let state = ["x", "vx", "y", "vy"];
    let curve = [
        ("x", "x + 0.9*vx*cos(0.3*vy) - 0.05*y"),
        ("vx", "0.95*vx - 0.1*vx*vy"),
        ("y", "y + 0.9*vy + 0.02*x*vx/10"),
        ("vy", "0.9*vy + 0.1*sin(vx)"),
    ];
    let function = Function::of_formulas(&state, &[], &[], &[], &curve).unwrap();
    setup.problem.modes[0].motion = Motion::Function {
        function: function.into(),
        given: Vec::new(),
    };
    assert_eq!(setup.problem.check(&setup.initial).err(), None);
    setup
}

/// Modes, noises, estimates and measurements with full matrices, for n entries of the state, and the same filter in all modes.
fn generic(n: usize, modes: usize, sensor: Sensor<f64, Dyn, Dyn>, filter: Filter<f64, Dyn, Dyn>) -> Setup<f64> {
    let m = sensor.dimension().0;
    let mode = |j: usize| Mode {
        name: format!("mode {j}"),
        motion: Motion::Linear(DMatrix::identity(n, n) + matrix(n, n, 100 * j, 0.2)),
        noise: covariance(n, 100 * j + 20, 1.0 + 2.0 * index(j)),
    };
    let estimate = |j: usize| Gaussian {
        mean: DVector::from_fn(n, |row, _| 8.0 + 3.0 * value(100 * j + 40 + row)),
        covariance: covariance(n, 100 * j + 60, 6.0),
    };
    let shares = |seed: usize| {
        let weights: Vec<f64> = (0..modes).map(|j| 1.2 + value(seed + j)).collect();
        let sum: f64 = weights.iter().sum();
        weights.iter().map(|weight| weight / sum).collect::<Vec<_>>()
    };
    let chain = (0..modes).map(|i| {
        let stay = |j: usize| if i == j { 0.6 + 0.1 * index(i) } else { 0.0 };
        let leave = 0.4 - 0.1 * index(i);
        let row = shares(300 + 10 * i);
        row.iter()
            .enumerate()
            .map(|(j, share)| stay(j) + leave * share)
            .collect()
    });
    let problem = Problem {
        modes: (0..modes).map(mode).collect(),
        filters: vec![filter],
        interaction: Interaction::Imm,
        angles: vec![],
        chain: chain.collect(),
        sensor,
        measurement_noise: covariance(m, 500, 3.0),
    };
    let initial = Initial {
        modes: (0..modes).map(estimate).collect(),
        mode_probabilities: shares(400),
    };
    assert_eq!(problem.check(&initial).err(), None);
    let measured = |k: usize| Some(DVector::from_fn(m, |row, _| 8.0 + 5.0 * value(600 + 10 * k + row)));
    let truth = |k: usize| Some(DVector::from_fn(n, |row, _| 6.0 * value(700 + 10 * k + row)));
    Setup {
        changes: BTreeMap::new(),
        rates: BTreeMap::new(),
        truths: (0..5).map(truth).collect(),
        problem,
        equations: Equations::standard(),
        initial,
        measurements: (0..5).map(measured).collect(),
    }
}

/// A number between −1 and 1 that is like no other: the multiples of the golden ratio are spread evenly.
fn value(seed: usize) -> f64 {
    2.0 * (0.618_033_988_749_895 * (index(seed) + 1.0)).fract() - 1.0
}

fn index(j: usize) -> f64 {
    f64::from(u32::try_from(j).unwrap())
}

fn matrix(rows: usize, columns: usize, seed: usize, size: f64) -> DMatrix<f64> {
    DMatrix::from_fn(rows, columns, |row, column| size * value(seed + 4 * row + column))
}

fn covariance(n: usize, seed: usize, size: f64) -> DMatrix<f64> {
    let root = DMatrix::identity(n, n) + matrix(n, n, seed, 0.5);
    &root * root.transpose() * size
}

/// The same problem, its numbers as exact enclosures.
fn on_enclosures(setup: &Setup<f64>) -> Setup<Enclosure> {
    let problem = &setup.problem;
    let modes = problem.modes.iter().map(|mode| Mode {
        name: mode.name.clone(),
        motion: Motion::Linear(mode.motion.matrix().map(Enclosure::exact)),
        noise: mode.noise.map(Enclosure::exact),
    });
    let estimates = setup.initial.modes.iter().map(|estimate| Gaussian {
        mean: estimate.mean.map(Enclosure::exact),
        covariance: estimate.covariance.map(Enclosure::exact),
    });
    let sensor = match &problem.sensor {
        Sensor::Linear(h) => Sensor::Linear(h.map(Enclosure::exact)),
        Sensor::Polar {
            components,
            position,
            location,
        } => Sensor::Polar {
            components: components.clone(),
            position: *position,
            location: location.map(Enclosure::exact),
        },
        Sensor::Function { .. } => unreachable!("no problem of this file has one"),
    };
    let on_enclosures = |vector: &DVector<f64>| vector.map(Enclosure::exact);
    Setup {
        changes: BTreeMap::new(),
        rates: BTreeMap::new(),
        truths: setup
            .truths
            .iter()
            .map(|truth| truth.as_ref().map(on_enclosures))
            .collect(),
        equations: Equations::standard(),
        problem: Problem {
            modes: modes.collect(),
            filters: problem.filters.iter().map(filter_on_enclosures).collect(),
            interaction: without_conversions(&problem.interaction),
            angles: problem.angles.clone(),
            chain: problem.chain.iter().map(|row| list(row)).collect(),
            sensor,
            measurement_noise: problem.measurement_noise.map(Enclosure::exact),
        },
        initial: Initial {
            modes: estimates.collect(),
            mode_probabilities: list(&setup.initial.mode_probabilities),
        },
        measurements: setup
            .measurements
            .iter()
            .map(|z| z.as_ref().map(|z| z.map(Enclosure::exact)))
            .collect(),
    }
}

fn without_conversions(interaction: &Interaction<f64, Dyn>) -> Interaction<Enclosure, Dyn> {
    match interaction {
        Interaction::Imm => Interaction::Imm,
        Interaction::Gpb1 => Interaction::Gpb1,
        Interaction::Unmixed => Interaction::Unmixed,
        Interaction::Converted(_) => unreachable!("no problem that is put on enclosures has one"),
    }
}

fn filter_on_enclosures(filter: &Filter<f64, Dyn, Dyn>) -> Filter<Enclosure, Dyn, Dyn> {
    let transform = |transform: &Transform<f64, Dyn>| match transform {
        Transform::Exact => Transform::Exact,
        Transform::Linearised => Transform::Linearised,
        Transform::Points(rule) => Transform::Points(Rule {
            points: rule.points.iter().map(|point| point.map(Enclosure::exact)).collect(),
            weights: list(&rule.weights),
            covariance_weights: list(&rule.covariance_weights),
        }),
    };
    Filter {
        predict: transform(&filter.predict),
        update: match &filter.update {
            Update::By(by) => Update::By(transform(by)),
            Update::Iterated(times) => Update::Iterated(*times),
            Update::Converted(conversion) => Update::Converted(*conversion),
            Update::Given(given) => Update::Given(FixedGain {
                gain: given.gain.map(Enclosure::exact),
                innovation_covariance: given.innovation_covariance.map(Enclosure::exact),
            }),
        },
        noise_cross_covariance: filter
            .noise_cross_covariance
            .as_ref()
            .map(|of_noises| of_noises.map(Enclosure::exact)),
    }
}

fn list(values: &[f64]) -> Vec<Enclosure> {
    values.iter().copied().map(Enclosure::exact).collect()
}

/// The number that is enclosed, as a double; not a number if there is no answer, or none of fifteen digits. An enclosure of zero counts
/// as zero.
fn middle(value: &Enclosure) -> f64 {
    let (lower, upper) = (value.lower().to_f64(), value.upper().to_f64());
    let is_narrow = upper - lower <= 1e-15 * upper.abs() || value.magnitude() < 1e-60;
    if is_narrow { lower } else { f64::NAN }
}

// How two runs are compared

const PROBABILITIES: [Quantity; 3] = [
    Quantity::PredictedModeProbabilities,
    Quantity::MixingProbabilities,
    Quantity::ModeProbabilities,
];

/// The first quantity of the first step in which two runs differ.
fn first_change(expected: &Trace, found: &Trace, tolerance: f64) -> Option<Quantity> {
    let mut places = expected
        .all_places()
        .filter(|&place| differs(expected, found, place, tolerance));
    places.next().map(|(_, quantity, _)| quantity)
}

/// All quantities in which two runs differ.
fn changes(expected: &Trace, found: &Trace) -> BTreeSet<Quantity> {
    let places = expected
        .all_places()
        .filter(|&place| differs(expected, found, place, ROUNDING));
    places.map(|(_, quantity, _)| quantity).collect()
}

/// Whether the values of a place differ by more than a part of their size, a probability of its own. What one of the runs does not have
/// is not compared.
fn differs(expected: &Trace, found: &Trace, place: (usize, Quantity, usize), tolerance: f64) -> bool {
    let (step, quantity, mode) = place;
    let (Some(expected), Some(found)) = (expected.get(step, quantity, mode), found.get(step, quantity, mode)) else {
        return false;
    };
    // Where all is zero, as after a start at the origin, rounding is measured in hundredths: most numbers here are of order one.
    let size = expected.iter().fold(0.01, |size: f64, value| size.max(value.abs()));
    let size = |value: f64| {
        if PROBABILITIES.contains(&quantity) {
            value.abs()
        } else {
            size
        }
    };
    let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= tolerance * size(*a) || (a.is_nan() && b.is_nan());
    !expected.iter().zip(found).all(is_near)
}

// How the halves are read

/// The names with hyphens in quotes, in the code of the variants.
fn names_in_the_code() -> BTreeSet<String> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/oracle/variant");
    let mut names = BTreeSet::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let text = std::fs::read_to_string(entry.unwrap().path()).unwrap();
        let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
        for line in code {
            let quoted = line.split('"').skip(1).step_by(2);
            let is_name = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
            names.extend(
                quoted
                    .filter(|text| text.contains('-') && text.chars().all(is_name))
                    .map(str::to_owned),
            );
        }
    }
    names
}

/// The number of values in the last column of a row of conventions.
fn others_known(row: &str) -> usize {
    let others = row.split('|').nth(3).unwrap_or_default();
    // The values stand in backquotes, and what they mean after a colon or in brackets.
    let names = others.split('`').skip(1).step_by(2);
    names.count()
}
