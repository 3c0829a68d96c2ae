//! Goal: every variant of the catalogue is what its formula says, and not only different.
//!
//! Method: each formula is written here a second time, with two states, two measurements and three modes, on plain matrices. A program is
//! made up whose values are all some per cent off, so that none follows from another; along its values a variant's equation has one
//! answer, and the formula must give it to the last digits. Kind of evidence: property.

#![allow(clippy::float_cmp, reason = "ones and zeros are exact")]

use immaculate::filter::fixed_gain::FixedGain;
use immaculate::filter::{Filter, Update};
use immaculate::gaussian::Gaussian;
use immaculate::imm::continuous::rates_of_sojourns;
use immaculate::imm::state_conversion::{Reader, StateConversion, StateConversions};
use immaculate::imm::{Equations, Initial, Interaction, Problem, Quantity};
use immaculate::model::function::Function;
use immaculate::model::motion::{Mode, Motion};
use immaculate::model::{Conversion, PolarComponent, Sensor};
use immaculate::oracle::chain::ChainOfRates;
use immaculate::oracle::run::Triangle;
use immaculate::oracle::setup::Setup;
use immaculate::oracle::trace::Trace;
use immaculate::oracle::variant::{Kind, apply, catalogue};
use immaculate::rule::{Rule, RuleName, unscented::unscented_in};
use nalgebra::{DMatrix, DVector, Dyn, Matrix2, Matrix3, SMatrix, Vector2, dmatrix, dvector, matrix, vector};
use std::f64::consts::PI;

/// What counts as the same number, in parts of the greatest number of its value: some hundred roundings.
const ROUNDING: f64 = 1e-12;

/// A scene: a problem of two states, two measurements and three modes.
type Scene = Setup<f64>;

/// A variant, a quantity, and the formula by which the variant computes it in mode j, by rows.
type Row = (&'static str, Quantity, fn(At, usize) -> Vec<f64>);

use Quantity as Q;
use std::collections::BTreeMap;

// The laws

#[test]
fn the_chain_and_the_mixing_are_their_formulas() {
    holds(&kalman(), 2, MIXING);
}

#[test]
fn a_chain_that_is_made_of_rates_wrongly_is_its_formula() {
    let mut scene = kalman();
    let jumps = JUMPS.map(|row| row.to_vec()).to_vec();
    let rates = rates_of_sojourns(&TIMES, &jumps);
    let sojourns = Some((TIMES.to_vec(), jumps));
    let chain = ChainOfRates {
        rates,
        sojourns,
        interval: 0.5,
    };
    scene.rates.insert(0, chain);
    holds(&scene, 2, RATES);
}

#[test]
fn a_common_start_that_is_mixed_by_the_chain_is_its_formula() {
    let mut scene = kalman();
    scene.problem.interaction = Interaction::Gpb1;
    holds(&scene, 2, COMMON_START);
}

#[test]
fn the_prediction_is_its_formula() {
    holds(&kalman(), 2, PREDICTION);
    holds(&points("cubature-3"), 2, PREDICTION_BY_POINTS);
    holds(&scaled_points(), 2, SUMS_OVER_WEIGHTS);
}

#[test]
fn what_is_expected_of_a_measurement_is_its_formula() {
    holds(&kalman(), 2, MEASUREMENT);
    holds(&points("cubature-3"), 2, MEASUREMENT_BY_POINTS);
}

#[test]
fn correlated_noises_that_are_left_out_are_their_formulas() {
    holds(&correlated(), 2, CORRELATED);
}

#[test]
fn range_and_bearing_are_their_formulas() {
    holds(&polar(), 2, POLAR);
}

#[test]
fn jacobians_and_what_they_are_taken_for_are_their_formulas() {
    holds(&curving(), 2, JACOBIANS);
}

#[test]
fn steps_that_differ_are_their_formulas() {
    holds(&changing(), 2, STEPS);
}

#[test]
fn headings_are_averaged_by_their_formulas() {
    holds(&heading(), 2, HEADINGS);
}

#[test]
fn states_are_converted_by_their_formulas() {
    holds(&separate(), 2, STATES);
}

#[test]
fn a_converted_measurement_is_its_formula() {
    holds(&converted(Conversion::Standard), 2, CONVERTED);
    holds(&converted(Conversion::Additive), 2, NOT_DEBIASED);
}

#[test]
fn the_update_is_its_formula() {
    holds(&kalman(), 2, UPDATE);
    holds(&points("cubature-3"), 2, UPDATE_BY_POINTS);
    holds(&fixed(Interaction::Imm), 2, FIXED);
    holds(&fixed(Interaction::Unmixed), 2, FIXED_UNMIXED);
}

#[test]
fn a_step_without_a_detection_is_its_formula() {
    for mut scene in [kalman(), points("cubature-3")] {
        scene.measurements[1] = None;
        holds(&scene, 2, MISSED);
    }
}

#[test]
fn the_likelihood_is_its_formula() {
    holds(&kalman(), 2, LIKELIHOOD);
}

#[test]
fn the_mode_probabilities_are_their_formulas() {
    holds(&kalman(), 2, PROBABILITIES);
}

#[test]
fn the_combined_estimates_are_their_formulas() {
    holds(&kalman(), 2, COMBINATION);
}

#[test]
fn a_convention_is_its_formula() {
    holds(&kalman(), 1, FIRST_STEP);
    // From the second step on it is the filter's own.
    let shown = moved(&kalman());
    let own = kalman().run_along(&shown, |value| value, Triangle::Lower).values;
    let found = along(&kalman(), FIRST_STEP[0].0, &shown);
    for (step, quantity, j) in own.all_places().filter(|place| place.0 > 1) {
        assert_eq!(found.get(step, quantity, j), own.get(step, quantity, j), "{quantity:?}");
    }
    let mut scene = kalman();
    // The third mode lacks the second entry of the state.
    scene.problem.modes[2].noise = dmatrix![0.7, 0.0; 0.0, 0.0];
    holds(&scene, 2, UNEQUAL);
}

/// Exact: what is read wrongly is wrong in the problem, before any equation sees it.
#[test]
fn a_misread_input_is_another_problem() {
    for (id, misread) in INPUTS {
        for scene in [kalman(), points("cubature-3"), polar(), converted(Conversion::Standard)] {
            let mut expected = scene.clone();
            misread(&mut expected);
            let found = varied(&scene, id);
            assert_eq!(found.problem, expected.problem, "{id}");
            assert_eq!(found.initial, expected.initial, "{id}");
            assert_eq!(found.measurements, expected.measurements, "{id}");
        }
    }
    let flagged = catalogue()
        .iter()
        .filter(|variant| variant.input)
        .map(|variant| variant.id.as_str());
    assert!(
        flagged.eq(INPUTS.iter().map(|(id, _)| *id)),
        "the catalogue says which these are"
    );
}

/// Exact: a rule's weights are changed in this rule and in no other.
#[test]
fn a_weight_printed_wrongly_is_that_of_the_printed_rule() {
    for (id, name, printed) in [
        ("cubature-5-weight-13", "cubature-5", "cubature-5-printed"),
        ("simplex-5-weight-11", "simplex-5", "simplex-5-printed-11"),
        ("simplex-5-weight-16", "simplex-5", "simplex-5-printed-16"),
    ] {
        assert_ne!(points_of(name), points_of(printed));
        for other in ["cubature-3", "cubature-5", "simplex-5", "gauss-hermite-3"] {
            let expected = points_of(if other == name { printed } else { other });
            assert_eq!(rule(&varied(&points(other), id)), expected, "{id} in {other}");
        }
    }
}

/// Exact: the points and weights that are varied, in numbers.
#[test]
fn a_varied_rule_has_these_points_and_weights() {
    let of = |id, scene: &Scene| rule(&varied(scene, id));
    let (scene, plain) = (scaled_points(), rule(&scaled_points()));
    assert_eq!(
        of("covariance-weights-for-means", &scene).weights,
        plain.covariance_weights
    );
    assert_eq!(
        of("mean-weights-for-covariances", &scene).covariance_weights,
        plain.weights
    );
    let centre = plain
        .points
        .iter()
        .position(|point| *point == DVector::zeros(2))
        .unwrap();
    let without = |weights: &[f64]| {
        let mut weights = weights.to_vec();
        weights[centre] = 0.0;
        weights
    };
    let dropped = of("centre-point-dropped", &scene);
    assert_eq!(dropped.weights, without(&plain.weights));
    assert_eq!(dropped.covariance_weights, without(&plain.covariance_weights));
    assert_eq!(dropped.points, plain.points);
    // Points at √2 on the axes: on the unit sphere at 1, scaled by the square at 2. The centre stays.
    for (id, distance) in [("points-on-the-unit-sphere", 1.0), ("points-scaled-by-the-square", 2.0)] {
        let rule = of(id, &points("cubature-3"));
        assert!(
            rule.points
                .iter()
                .all(|point| (point.norm() - distance).abs() < ROUNDING),
            "{id}"
        );
        assert!(of(id, &scene).points.contains(&DVector::zeros(2)), "{id}");
    }
}

/// Exact: raw second moments are a form where the weights for covariances sum to one, and change nothing where they sum to more or to less.
#[test]
fn raw_moments_are_left_to_rules_whose_weights_sum_to_one() {
    // W = 2 + β − α²
    for (beta, sum) in [(0.0, 1.0), (0.5, 1.5), (-0.5, 0.5)] {
        let mut scene = scaled_points();
        scene.problem.filters = vec![Filter::points(unscented_in(Dyn(2), &1.0, &beta, &0.5).unwrap())];
        let weights = rule(&scene).covariance_weights;
        assert!((weights.iter().sum::<f64>() - sum).abs() < ROUNDING);
        let shown = moved(&scene);
        let own = scene.run_along(&shown, |value| value, Triangle::Lower).values;
        let is_own = along(&scene, "raw-moments", &shown) == own;
        assert_eq!(is_own, sum != 1.0, "{sum}");
    }
}

/// Exact: measurements that are put where there is none.
#[test]
fn a_detection_that_is_missing_is_filled_in() {
    let (first, fourth) = (Some(vector![1.0, 2.0]), Some(vector![3.0, 4.0]));
    let measured = |z: [Option<Vector2<f64>>; 5]| z.map(|z| z.map(|z| DVector::from_column_slice(z.as_slice())));
    let mut scene = kalman();
    scene.measurements = measured([None, first, None, None, fourth]).to_vec();
    let filled = |id| varied(&scene, id).measurements;
    let (zero, nothing) = (Some(Vector2::zeros()), None);
    assert_eq!(
        filled("missed-detection-as-zero"),
        measured([zero, first, zero, zero, fourth])
    );
    let last = measured([nothing, first, first, first, fourth]);
    assert_eq!(filled("missed-detection-as-the-last-measurement"), last);
}

/// The floors and the underflow of doubles, where likelihoods are that small: μⱼ = cⱼ Lⱼ / Σᵢ cᵢ Lᵢ with another L.
#[test]
fn small_likelihoods_are_raised_or_ignored_from_their_limit_on() {
    let bayes = |logarithms: [f64; 3], c: &[f64]| {
        let greatest = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let parts: Vec<f64> = (0..3).map(|i| c[i] * (logarithms[i] - greatest).exp()).collect();
        normalised(&parts)
    };
    let (ten, two) = (10.0_f64.ln(), 2.0_f64.ln());
    for (id, floor) in [
        ("likelihood-floor-1e-10", -10.0 * ten),
        ("likelihood-floor-1e-300", -300.0 * ten),
        ("likelihood-floor-smallest-double", -1022.0 * two),
    ] {
        let logarithms = [floor + 2.0, floor - 5.0, floor - 0.5];
        let (found, c) = weighed(id, logarithms);
        near(&found, &bayes(logarithms.map(|l| l.max(floor)), &c), id);
    }
    // Below half the smallest double all are zeros; one above is enough for Bayes' rule.
    let limit = -1075.0 * two;
    let id = "vanishing-likelihoods-ignored";
    let (found, c) = weighed(id, [limit - 1.0, limit - 2.0, limit - 7.0]);
    near(&found, &c, id);
    let above = [limit - 1.0, limit - 2.0, limit + 1.0];
    let (found, c) = weighed(id, above);
    near(&found, &bayes(above, &c), id);
    // Of likelihoods that a double can hold nothing is lost.
    let id = "likelihoods-exponentiated-before-comparing";
    let (found, c) = weighed(id, [-3.0, -2.0, -7.0]);
    near(&found, &bayes([-3.0, -2.0, -7.0], &c), id);
    // Probabilities themselves are raised after Bayes' rule, and divided by their sum again.
    let logarithms = [-1.0, -9.0, -20.0];
    for (id, floor) in [("probability-floor-1e-3", 1e-3), ("probability-floor-1e-6", 1e-6)] {
        let (found, c) = weighed(id, logarithms);
        let plain = bayes(logarithms, &c);
        assert!(plain[2] < 1e-6 && 1e-6 < plain[1] && plain[1] < 1e-3, "{plain:?}");
        near(
            &found,
            &normalised(&plain.iter().map(|value| value.max(floor)).collect::<Vec<_>>()),
            id,
        );
    }
}

/// Exact: of modes that are as probable as each other the first is taken, for the output and for the next step.
#[test]
fn of_equal_modes_the_first_is_the_most_probable() {
    let mut shown = moved(&kalman());
    shown.set(2, Q::ModeProbabilities, 0, vec![0.25, 0.375, 0.375]);
    let (estimates, mode) = (
        shown.get(2, Q::UpdatedMean, 1).cloned(),
        "combined-of-the-most-probable-mode",
    );
    assert_eq!(
        along(&kalman(), mode, &shown).get(2, Q::CombinedMean, 0),
        estimates.as_ref()
    );
    shown.set(2, Q::ModeProbabilities, 0, vec![0.25, 0.25, 0.5]);
    let estimates = shown.get(2, Q::UpdatedCovariance, 2).cloned();
    assert_eq!(
        along(&kalman(), mode, &shown).get(2, Q::CombinedCovariance, 0),
        estimates.as_ref()
    );

    let mut shown = moved(&kalman());
    shown.set(2, Q::PredictedModeProbabilities, 0, vec![0.25, 0.375, 0.375]);
    for (logarithms, greatest) in [
        ([-3.0, -3.0, -3.0], 1),
        ([-3.0, -4.0, -3.0], 2),
        ([-2.0, -4.0, -5.0], 0),
    ] {
        for (j, logarithm) in logarithms.into_iter().enumerate() {
            shown.set(2, Q::LogLikelihood, j, vec![logarithm]);
        }
        let alone: Vec<f64> = (0..3).map(|j| if j == greatest { 1.0 } else { 0.0 }).collect();
        let found = along(&kalman(), "most-probable-mode-alone", &shown);
        assert_eq!(found.get(2, Q::ModeProbabilities, 0), Some(&alone));
    }
}

/// N(ν; 0, S²) exists for one measurement: −½ ν²/S² − ln S − ½ ln 2π. Of two the likelihood stays.
#[test]
fn a_variance_taken_for_a_deviation_is_squared_where_there_is_one_measurement() {
    let id = "likelihood-variance-as-standard-deviation";
    let scene = scalar();
    let shown = scene.run().values;
    let mut other = scene.clone();
    assert!(apply(id, &mut other));
    let found = other.run_along(&shown, |value| value, Triangle::Lower).values;
    let number = |quantity| shown.get(1, quantity, 0).unwrap()[0];
    let (nu, s) = (number(Q::Innovation), number(Q::InnovationCovariance));
    let expected = -0.5 * (nu / s).powi(2) - s.ln() - 0.5 * (2.0 * PI).ln();
    near(found.get(1, Q::LogLikelihood, 0).unwrap(), &[expected], id);
    let shown = moved(&kalman());
    let plain = kalman().run_along(&shown, |value| value, Triangle::Lower).values;
    assert_eq!(along(&kalman(), id, &shown), plain);
}

/// Every variant has a formula in this file; one that is not a form has one that is not the filter's own.
#[test]
fn every_variant_of_the_catalogue_has_its_formula_here() {
    let source = include_str!("variant_formulas.rs");
    let ids = catalogue().iter().map(|variant| variant.id.as_str());
    let missing: Vec<&str> = ids.filter(|id| !source.contains(&format!("{id:?}"))).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

// How a formula is held against the code

/// Every row, in every mode: the variant along the moved values, and the formula on them. That it is not the filter's own formula is
/// shown by the numbers; of forms it is another one too, as these values follow from none.
fn holds(scene: &Scene, k: usize, rows: &[Row]) {
    let shown = moved(scene);
    let own = scene.run_along(&shown, |value| value, Triangle::Lower).values;
    let at = At {
        scene,
        shown: &shown,
        k,
    };
    for (id, quantity, formula) in rows {
        let found = along(scene, id, &shown);
        let modes = if quantity.is_of_mode() { 3 } else { 1 };
        let mut is_another = false;
        for j in 0..modes {
            let value = |trace: &Trace| {
                trace
                    .get(k, *quantity, j)
                    .unwrap_or_else(|| panic!("{id}: no {quantity:?}"))
                    .clone()
            };
            near(
                &value(&found),
                &formula(at, j),
                &format!("{id}, {quantity:?} of mode {j}"),
            );
            is_another |= value(&found) != value(&own);
        }
        let kind = catalogue()
            .iter()
            .find(|variant| variant.id == *id)
            .map(|variant| variant.kind);
        assert!(
            is_another || kind == Some(Kind::Form),
            "{id}: {quantity:?} is the filter's own"
        );
    }
}

fn near(found: &[f64], expected: &[f64], what: &str) {
    let size = expected.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
    let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= ROUNDING * size;
    let is_same = found.len() == expected.len() && found.iter().zip(expected).all(is_near);
    assert!(is_same, "{what}: {found:?} for {expected:?}");
}

fn varied(scene: &Scene, id: &str) -> Scene {
    let mut scene = scene.clone();
    assert!(apply(id, &mut scene), "{id}");
    scene
}

fn along(scene: &Scene, id: &str, shown: &Trace) -> Trace {
    varied(scene, id)
        .run_along(shown, |value| value, Triangle::Lower)
        .values
}

/// The values of the filter itself, each moved by some per cent; a covariance as a whole, so that it stays one.
fn moved(scene: &Scene) -> Trace {
    let mut count = 0;
    let mut factor = || {
        count += 1;
        1.0 + 0.1 * value(count)
    };
    scene.run().values.map(|(_, quantity, _), values| {
        if quantity.is_covariance() {
            let factor = factor();
            return values.iter().map(|value| value * factor).collect();
        }
        values.iter().map(|value| value * factor()).collect()
    })
}

/// The mode probabilities of a variant for log-likelihoods that are shown, and the predicted ones.
fn weighed(id: &str, logarithms: [f64; 3]) -> (Vec<f64>, Vec<f64>) {
    let mut shown = moved(&kalman());
    for (j, logarithm) in logarithms.into_iter().enumerate() {
        shown.set(2, Q::LogLikelihood, j, vec![logarithm]);
    }
    let found = along(&kalman(), id, &shown);
    let of = |trace: &Trace, quantity| trace.get(2, quantity, 0).unwrap().clone();
    (
        of(&found, Q::ModeProbabilities),
        of(&shown, Q::PredictedModeProbabilities),
    )
}

// What a formula is written with

/// The numbers of a step, by the letters of the papers: those of the problem, and those that are shown. A second letter says which: `0`
/// mixed, `p` predicted, `u` updated, `b` of the step before, `c` combined, `h` expected, `n` after the measurement.
#[derive(Clone, Copy)]
struct At<'a> {
    scene: &'a Scene,
    shown: &'a Trace,
    k: usize,
}

#[rustfmt::skip]
impl<'a> At<'a> {
    fn list(self, k: usize, quantity: Q, j: usize) -> Vec<f64> {
        if k == 0 && quantity == Q::ModeProbabilities {
            return self.scene.initial.mode_probabilities.clone();
        }
        self.shown.get(k, quantity, j).unwrap_or_else(|| panic!("{quantity:?} is not shown")).clone()
    }
    fn v(self, quantity: Q, j: usize) -> Vector2<f64> { Vector2::from_column_slice(&self.list(self.k, quantity, j)) }
    fn m(self, quantity: Q, j: usize) -> Matrix2<f64> { Matrix2::from_row_slice(&self.list(self.k, quantity, j)) }
    fn before(self) -> Self { Self { k: self.k - 1, ..self } }

    // of the problem
    fn p(self, i: usize, j: usize) -> f64 { self.scene.problem.chain[i][j] }
    fn f(self, j: usize) -> Matrix2<f64> { square_of(&self.scene.problem.modes[j % 3].motion.matrix()) }
    fn q(self, j: usize) -> Matrix2<f64> { square_of(&self.scene.problem.modes[j % 3].noise) }
    fn h(self) -> Matrix2<f64> { square_of(&self.scene.problem.h()) }
    fn r(self) -> Matrix2<f64> { square_of(&self.scene.problem.measurement_noise) }
    fn z(self) -> Vector2<f64> { Vector2::from_column_slice(self.scene.measurements[self.k - 1].as_ref().unwrap().as_slice()) }
    fn given(self, j: usize) -> &'a FixedGain<f64, Dyn, Dyn> {
        match &self.scene.problem.filter(j % 3).update {
            Update::Given(given) => given,
            _ => panic!("mode {j} computes its gain"),
        }
    }

    // of the step before
    fn mu(self, i: usize) -> f64 { self.list(self.k - 1, Q::ModeProbabilities, 0)[i] }
    fn xb(self, i: usize) -> Vector2<f64> { self.before().v(Q::UpdatedMean, i) }
    fn pb(self, i: usize) -> Matrix2<f64> { self.before().m(Q::UpdatedCovariance, i) }

    // of this step
    fn c(self, j: usize) -> f64 { self.list(self.k, Q::PredictedModeProbabilities, 0)[j] }
    fn mix(self, j: usize, i: usize) -> f64 { self.list(self.k, Q::MixingProbabilities, j)[i] }
    fn x0(self, j: usize) -> Vector2<f64> { self.v(Q::MixedMean, j) }
    fn p0(self, j: usize) -> Matrix2<f64> { self.m(Q::MixedCovariance, j) }
    fn xp(self, j: usize) -> Vector2<f64> { self.v(Q::PredictedMean, j) }
    fn pp(self, j: usize) -> Matrix2<f64> { self.m(Q::PredictedCovariance, j) }
    fn xcp(self) -> Vector2<f64> { self.v(Q::CombinedPredictionMean, 0) }
    fn zh(self, j: usize) -> Vector2<f64> { self.v(Q::PredictedMeasurement, j) }
    fn nu(self, j: usize) -> Vector2<f64> { self.v(Q::Innovation, j) }
    fn s(self, j: usize) -> Matrix2<f64> { self.m(Q::InnovationCovariance, j) }
    fn cross(self, j: usize) -> Matrix2<f64> { self.m(Q::CrossCovariance, j) }
    fn w(self, j: usize) -> Matrix2<f64> { self.m(Q::Gain, j) }
    fn x(self, j: usize) -> Vector2<f64> { self.v(Q::UpdatedMean, j) }
    fn pu(self, j: usize) -> Matrix2<f64> { self.m(Q::UpdatedCovariance, j) }
    fn l(self, j: usize) -> f64 { self.list(self.k, Q::LogLikelihood, j)[0] }
    fn mun(self, j: usize) -> f64 { self.list(self.k, Q::ModeProbabilities, 0)[j] }
    fn xc(self) -> Vector2<f64> { self.v(Q::CombinedMean, 0) }

    /// μᵢ∣ⱼ = pᵢⱼ μᵢ / Σₗ pₗⱼ μₗ
    fn mixing(self, i: usize, j: usize) -> f64 {
        self.p(i, j) * self.mu(i) / (0..3).map(|l| self.p(l, j) * self.mu(l)).sum::<f64>()
    }
    /// Points about a mean with a root: those of the third-degree rule, each of weight ¼.
    fn points(mean: Vector2<f64>, root: Matrix2<f64>) -> [Vector2<f64>; 4] {
        let r = 2.0_f64.sqrt();
        [vector![r, 0.0], vector![-r, 0.0], vector![0.0, r], vector![0.0, -r]].map(|point| mean + root * point)
    }
}

/// f(a, b) = (a + 0.3 sin(b/10), b − 0.005 a b) of [`curving`]: its slopes.
fn slopes(x: Vector2<f64>) -> Matrix2<f64> {
    matrix![1.0, 0.03 * (x[1] / 10.0).cos(); -0.005 * x[1], 1.0 - 0.005 * x[0]]
}

/// The slopes of range and bearing, x being the second entry of the state and y the first.
fn polar_slopes(state: Vector2<f64>) -> Matrix2<f64> {
    let (x, y) = (state[1] - SENSOR[0], state[0] - SENSOR[1]);
    let square = x * x + y * y;
    matrix![y / square.sqrt(), x / square.sqrt(); x / square, -y / square]
}

#[rustfmt::skip]
const JACOBIANS: &[Row] = &[
    ("motion-jacobian-transposed", Q::MotionJacobian, |at, j| rows(slopes(at.x0(j)).transpose())),
    ("motion-jacobian-at-the-prediction", Q::MotionJacobian, |at, j| rows(slopes(at.xp(j)))),
    ("motion-jacobian-at-the-own-estimate", Q::MotionJacobian, |at, j| rows(slopes(at.xb(j)))),
    ("motion-jacobian-last-column-omitted", Q::MotionJacobian, |at, j| {
        let f = slopes(at.x0(j));
        rows(matrix![f[(0, 0)], 0.0; f[(1, 0)], f[(1, 1)]])
    }),
    ("motion-by-jacobian", Q::PredictedMean, |at, j| rows(slopes(at.x0(j)) * at.x0(j))),
    ("measurement-jacobian-at-the-mixed-mean", Q::MeasurementJacobian, |at, j| rows(polar_slopes(at.x0(j)))),
    ("measurement-jacobian-of-the-step-before", Q::MeasurementJacobian, |at, j| rows(at.before().m(Q::MeasurementJacobian, j))),
    ("bearing-jacobian-negated", Q::MeasurementJacobian, |at, j| rows(matrix![1.0, 0.0; 0.0, -1.0] * polar_slopes(at.xp(j)))),
    ("bearing-jacobian-in-degrees", Q::MeasurementJacobian, |at, j| {
        rows(matrix![1.0, 0.0; 0.0, 180.0 / PI] * polar_slopes(at.xp(j)))
    }),
    ("measurement-by-jacobian", Q::PredictedMeasurement, |at, j| rows(polar_slopes(at.xp(j)) * at.xp(j))),
];

/// Of [`correlated`]: H P⁻ Hᵀ + R and P⁻ Hᵀ, as of independent noises.
#[rustfmt::skip]
const CORRELATED: &[Row] = &[
    ("noise-correlation-omitted-in-the-innovation", Q::InnovationCovariance, |at, j| {
        rows(at.h() * at.pp(j) * at.h().transpose() + at.r())
    }),
    ("noise-correlation-omitted-in-the-gain", Q::CrossCovariance, |at, j| rows(at.pp(j) * at.h().transpose())),
    ("noise-correlation-omitted", Q::InnovationCovariance, |at, j| {
        rows(at.h() * at.pp(j) * at.h().transpose() + at.r())
    }),
    ("noise-correlation-omitted", Q::CrossCovariance, |at, j| rows(at.pp(j) * at.h().transpose())),
];

const TIMES: [f64; 3] = [4.0, 2.5, 1.25];
const JUMPS: [[f64; 3]; 3] = [[0.0, 0.75, 0.25], [0.5, 0.0, 0.5], [0.875, 0.125, 0.0]];

/// What leads from mode i to mode j in a step of ½ s: δᵢⱼ + gᵢⱼ/2.
fn euler(i: usize, j: usize) -> f64 {
    let rate = if i == j { -1.0 } else { JUMPS[i][j] } / TIMES[i];
    f64::from(u8::from(i == j)) + rate / 2.0
}

/// e^(G/2) with gᵢⱼ = τᵢ rᵢⱼ, by its series.
fn of_inverted_times(i: usize, j: usize) -> f64 {
    let generator = Matrix3::from_fn(|i, j| if i == j { -1.0 } else { JUMPS[i][j] } * TIMES[i] / 2.0);
    let (mut term, mut sum) = (Matrix3::identity(), Matrix3::identity());
    for k in 1..60 {
        term *= generator / f64::from(k);
        sum += term;
    }
    sum[(i, j)]
}

#[rustfmt::skip]
const RATES: &[Row] = &[
    ("chain-by-an-euler-step", Q::PredictedModeProbabilities, |a, _| each(|j| (0..3).map(|i| euler(i, j) * a.mu(i)).sum())),
    ("sojourn-times-as-rates", Q::PredictedModeProbabilities, |a, _| each(|j| {
        (0..3).map(|i| of_inverted_times(i, j) * a.mu(i)).sum()
    })),
];

/// Where every mode is to start from the combined estimate.
#[rustfmt::skip]
const COMMON_START: &[Row] = &[
    ("common-start-mixed-by-the-chain", Q::MixingProbabilities, |a, j| each(|i| a.mixing(i, j))),
    ("chain-skipped", Q::PredictedModeProbabilities, |a, _| each(|j| a.mu(j))),
];

/// In step 2 of [`changing`] F is 1.1 times, Q 1.5 times and R 1.3 times that of step 1.
#[rustfmt::skip]
const STEPS: &[Row] = &[
    ("motion-of-the-first-step", Q::PredictedMean, |at, j| rows(at.f(j) * at.x0(j))),
    ("process-noise-of-the-first-step", Q::PredictedCovariance, |at, j| {
        let f = at.f(j) * 1.1;
        rows(f * at.p0(j) * f.transpose() + at.q(j))
    }),
    ("measurement-noise-of-the-first-step", Q::InnovationCovariance, |at, j| {
        rows(at.h() * at.pp(j) * at.h().transpose() + at.r())
    }),
];

/// Σᵢ μᵢ∣ⱼ x̂ⁱ as numbers.
fn mixed_as_numbers(at: At, j: usize) -> Vec<f64> {
    rows((0..3).map(|i| at.xb(i) * at.mix(j, i)).sum::<Vector2<f64>>())
}

#[rustfmt::skip]
const HEADINGS: &[Row] = &[
    ("state-angles-as-numbers", Q::MixedMean, mixed_as_numbers),
    ("mixed-angles-as-numbers", Q::MixedMean, mixed_as_numbers),
    ("combined-angles-as-numbers", Q::CombinedMean, |at, _| {
        rows((0..3).map(|i| at.x(i) * at.mun(i)).sum::<Vector2<f64>>())
    }),
    ("state-angle-mean-vector", Q::MixedMean, |at, j| {
        let sum = |of: fn(f64) -> f64| (0..3).map(|i| at.mix(j, i) * of(at.xb(i)[1])).sum::<f64>();
        vec![mixed_as_numbers(at, j)[0], sum(f64::sin).atan2(sum(f64::cos))]
    }),
];

/// c of mode i for mode j, and its slopes: the second mode reads the others along a curve, and is read by them along a line.
fn read(at: At, i: usize, j: usize) -> (Vector2<f64>, Matrix2<f64>) {
    let x = at.xb(i);
    match (i, j) {
        (1, 0 | 2) => (BACK * x, BACK),
        (0 | 2, 1) => (
            vector![x[0] + 0.02 * x[1] * x[1], 1.2 * x[1] - 0.1 * x[0]],
            matrix![1.0, 0.04 * x[1]; -0.1, 1.2],
        ),
        _ => (x, Matrix2::identity()),
    }
}

/// A of mode i for mode j.
fn added(i: usize, j: usize) -> Matrix2<f64> {
    if (i, j) == (0, 1) { ADDED } else { Matrix2::zeros() }
}

const BACK: Matrix2<f64> = Matrix2::new(0.8, 0.3, -0.2, 0.9);
const ADDED: Matrix2<f64> = Matrix2::new(0.7, 0.2, 0.2, 0.5);

#[rustfmt::skip]
const STATES: &[Row] = &[
    ("states-mixed-unconverted", Q::MixedMean, |a, j| rows(sum(|i| a.xb(i) * a.mix(j, i)))),
    ("states-mixed-unconverted", Q::MixedCovariance, |a, j| of_before(a, |i| a.mix(j, i), a.x0(j))),
    ("states-combined-unconverted", Q::CombinedMean, |a, _| rows(sum(|j| a.x(j) * a.mun(j)))),
    ("states-combined-unconverted", Q::CombinedCovariance, |a, _| of_updated(a, |j| a.mun(j), a.xc())),
    ("state-conversion-jacobian-omitted", Q::MixedCovariance, |a, j| rows(sum(|i| {
        let (x, _) = read(a, i, j);
        (a.pb(i) + added(i, j) + square(x - a.x0(j))) * a.mix(j, i)
    }))),
    ("state-conversion-covariance-not-added", Q::MixedCovariance, |a, j| rows(sum(|i| {
        let (x, c) = read(a, i, j);
        (c * a.pb(i) * c.transpose() + square(x - a.x0(j))) * a.mix(j, i)
    }))),
];

const THIRD: f64 = 1.0 / 3.0;

/// By rows.
fn rows<const R: usize, const C: usize>(matrix: SMatrix<f64, R, C>) -> Vec<f64> {
    matrix.transpose().as_slice().to_vec()
}

fn each(value: impl Fn(usize) -> f64) -> Vec<f64> {
    (0..3).map(value).collect()
}

fn normalised(parts: &[f64]) -> Vec<f64> {
    let sum: f64 = parts.iter().sum();
    parts.iter().map(|part| part / sum).collect()
}

/// Σᵢ of the three modes.
fn sum<const R: usize, const C: usize>(term: impl Fn(usize) -> SMatrix<f64, R, C>) -> SMatrix<f64, R, C> {
    term(0) + term(1) + term(2)
}

/// A matrix of the problem, which has two rows and two columns.
fn square_of(matrix: &DMatrix<f64>) -> Matrix2<f64> {
    matrix.fixed_view::<2, 2>(0, 0).into_owned()
}

/// d dᵀ
fn square(d: Vector2<f64>) -> Matrix2<f64> {
    d * d.transpose()
}

/// (dᵀ d) in every entry
fn inner(d: Vector2<f64>) -> Matrix2<f64> {
    Matrix2::repeat(d.dot(&d))
}

fn inverse(a: Matrix2<f64>) -> Matrix2<f64> {
    a.try_inverse().unwrap()
}

fn diagonal(a: Matrix2<f64>) -> Matrix2<f64> {
    Matrix2::from_diagonal(&a.diagonal())
}

/// The lower triangle, and its mirror image above the diagonal.
fn lower(a: Matrix2<f64>) -> Matrix2<f64> {
    matrix![a.m11, a.m21; a.m21, a.m22]
}

/// The lower Cholesky factor of a 2 × 2 matrix.
fn root(p: Matrix2<f64>) -> Matrix2<f64> {
    let a = p.m11.sqrt();
    let b = p.m21 / a;
    matrix![a, 0.0; b, (p.m22 - b * b).sqrt()]
}

/// The upper one: U Uᵀ = P.
fn upper(p: Matrix2<f64>) -> Matrix2<f64> {
    let c = p.m22.sqrt();
    let b = p.m21 / c;
    matrix![(p.m11 - b * b).sqrt(), b; 0.0, c]
}

/// The symmetric one by Cayley and Hamilton: S = (P + √|P| I) / √(tr P + 2 √|P|).
fn symmetric(p: Matrix2<f64>) -> Matrix2<f64> {
    let d = p.determinant().sqrt();
    (p + Matrix2::identity() * d) / (p.trace() + 2.0 * d).sqrt()
}

/// νᵀ S⁻¹ ν
fn distance(nu: Vector2<f64>, s: Matrix2<f64>) -> f64 {
    nu.dot(&(inverse(s) * nu))
}

/// ln N(ν; 0, S) of two components: −½ νᵀ S⁻¹ ν − ½ ln|S| − ln 2π
fn density(nu: Vector2<f64>, s: Matrix2<f64>) -> f64 {
    -0.5 * distance(nu, s) - 0.5 * s.determinant().ln() - (2.0 * PI).ln()
}

/// An angle between −π and π.
fn wrapped(angle: f64) -> f64 {
    angle - (angle / (2.0 * PI)).round() * 2.0 * PI
}

// The formulas

/// Σᵢ wᵢ [ Pⁱ + (x̂ⁱ − mean)(x̂ⁱ − mean)ᵀ ] of the estimates of the step before.
fn of_before(a: At, weight: impl Fn(usize) -> f64, mean: Vector2<f64>) -> Vec<f64> {
    rows(sum(|i| (a.pb(i) + square(a.xb(i) - mean)) * weight(i)))
}

#[rustfmt::skip]
const MIXING: &[Row] = &[
    ("transition-transposed", Q::PredictedModeProbabilities, |a, _| each(|j| (0..3).map(|i| a.p(j, i) * a.mu(i)).sum())),
    ("transition-transposed", Q::MixingProbabilities, |a, j| each(|i| a.p(j, i) * a.mu(i) / a.c(j))),
    ("chain-skipped", Q::PredictedModeProbabilities, |a, _| each(|j| a.mu(j))),
    ("chain-skipped", Q::MixingProbabilities, |a, j| each(|i| a.mixing(i, j))),
    ("modes-without-interaction", Q::PredictedModeProbabilities, |a, _| each(|j| a.mu(j))),
    ("modes-without-interaction", Q::MixingProbabilities, |_, j| each(|i| if i == j { 1.0 } else { 0.0 })),
    ("transition-transposed-in-mixing", Q::MixingProbabilities, |a, j| each(|i| a.p(j, i) * a.mu(i) / a.c(j))),
    ("mixing-not-normalised", Q::MixingProbabilities, |a, j| each(|i| a.p(i, j) * a.mu(i))),
    ("mixing-indices-swapped", Q::MixingProbabilities, |a, j| each(|i| a.mixing(j, i))),
    ("mixing-with-predicted-probabilities", Q::MixingProbabilities, |a, j| each(|i| a.p(i, j) * a.c(i) / a.c(j))),
    ("mixing-normalised-by-rows", Q::MixingProbabilities, |a, j| each(|i| a.p(i, j))),
    ("mixing-without-mode-probabilities", Q::MixingProbabilities, |a, j| normalised(&each(|i| a.p(i, j)))),
    ("mixing-with-mode-probabilities-alone", Q::MixingProbabilities, |a, _| each(|i| a.mu(i))),
    ("mixing-skipped", Q::MixedMean, |a, j| rows(a.xb(j))),
    ("mixing-skipped", Q::MixedCovariance, |a, j| rows(a.pb(j))),
    ("common-mixing", Q::MixedMean, |a, _| rows(a.before().v(Q::CombinedMean, 0))),
    ("common-mixing", Q::MixedCovariance, |a, _| rows(a.before().m(Q::CombinedCovariance, 0))),
    ("mixed-with-transposed-probabilities", Q::MixedMean, |a, j| rows(sum(|i| a.xb(i) * a.mixing(j, i)))),
    ("mixed-with-transposed-probabilities", Q::MixedCovariance, |a, j| of_before(a, |i| a.mixing(j, i), a.x0(j))),
    ("mixing-in-place", Q::MixedMean, |a, j| rows(sum(|i| if i < j { a.x0(i) } else { a.xb(i) } * a.mix(j, i)))),
    ("mixing-in-place", Q::MixedCovariance, |a, j| rows(sum(|i| {
        let (x, p) = if i < j { (a.x0(i), a.p0(i)) } else { (a.xb(i), a.pb(i)) };
        (p + square(x - a.x0(j))) * a.mix(j, i)
    }))),
    ("mixing-after-prediction", Q::MixedMean, |a, j| rows(a.xb(j))),
    ("mixing-after-prediction", Q::MixedCovariance, |a, j| rows(a.pb(j))),
    ("mixing-after-prediction", Q::PredictedMean, |a, j| rows(sum(|i| a.f(i) * a.x0(i) * a.mix(j, i)))),
    ("mixing-after-prediction", Q::PredictedCovariance, |a, j| rows(sum(|i| {
        let p = a.f(i) * a.p0(i) * a.f(i).transpose() + a.q(i);
        (p + square(a.f(i) * a.x0(i) - a.xp(j))) * a.mix(j, i)
    }))),
    ("mixed-spread-omitted", Q::MixedCovariance, |a, j| rows(sum(|i| a.pb(i) * a.mix(j, i)))),
    ("mixed-spread-about-combined-mean", Q::MixedCovariance, |a, j| of_before(a, |i| a.mix(j, i), a.before().v(Q::CombinedMean, 0))),
    ("mixed-spread-about-own-mean", Q::MixedCovariance, |a, j| of_before(a, |i| a.mix(j, i), a.xb(j))),
    ("mixed-spread-about-previous-index", Q::MixedCovariance, |a, j| rows(sum(|i| {
        let mean = sum(|l| a.xb(l) * a.mixing(l, i));
        (a.pb(i) + square(a.xb(i) - mean)) * a.mix(j, i)
    }))),
    ("covariances-not-mixed", Q::MixedCovariance, |a, j| rows(a.pb(j))),
    ("mixed-covariance-weights-squared", Q::MixedCovariance, |a, j| of_before(a, |i| a.mix(j, i).powi(2), a.x0(j))),
    ("mixed-spread-inner-product", Q::MixedCovariance, |a, j| rows(sum(|i| (a.pb(i) + inner(a.xb(i) - a.x0(j))) * a.mix(j, i)))),
    ("mixture-by-raw-moments", Q::MixedCovariance, |a, j| rows(sum(|i| (a.pb(i) + square(a.xb(i))) * a.mix(j, i)) - square(a.x0(j)))),
    ("summation-reversed", Q::MixedMean, |a, j| rows(sum(|i| a.xb(i) * a.mix(j, i)))),
    ("summation-reversed", Q::MixedCovariance, |a, j| of_before(a, |i| a.mix(j, i), a.x0(j))),
];

/// F P Fᵀ
fn turned(f: Matrix2<f64>, p: Matrix2<f64>) -> Matrix2<f64> {
    f * p * f.transpose()
}

#[rustfmt::skip]
const PREDICTION: &[Row] = &[
    ("process-noise-omitted", Q::PredictedCovariance, |a, j| rows(turned(a.f(j), a.p0(j)))),
    ("process-noise-doubled", Q::PredictedCovariance, |a, j| rows(turned(a.f(j), a.p0(j)) + a.q(j) * 2.0)),
    ("process-noise-of-the-next-mode", Q::PredictedCovariance, |a, j| rows(turned(a.f(j), a.p0(j)) + a.q(j + 1))),
    ("process-noise-of-the-first-mode", Q::PredictedCovariance, |a, j| rows(turned(a.f(j), a.p0(j)) + a.q(0))),
    ("process-noise-before-motion", Q::PredictedCovariance, |a, j| rows(turned(a.f(j), a.p0(j) + a.q(j)))),
    ("prediction-from-own-estimate", Q::PredictedMean, |a, j| rows(a.f(j) * a.xb(j))),
    ("prediction-from-own-estimate", Q::PredictedCovariance, |a, j| rows(turned(a.f(j), a.pb(j)) + a.q(j))),
    ("mean-not-moved", Q::PredictedMean, |a, j| rows(a.x0(j))),
    ("motion-applied-twice", Q::PredictedMean, |a, j| rows(a.f(j) * a.f(j) * a.x0(j))),
    ("embedded-entries-kept", Q::PredictedMean, |a, j| {
        let kept = if j == 2 { vector![0.0, a.x0(j)[1]] } else { Vector2::zeros() };
        rows(a.f(j) * a.x0(j) + kept)
    }),
    ("motion-of-the-next-mode", Q::PredictedMean, |a, j| rows(a.f(j + 1) * a.x0(j))),
    ("motion-of-the-first-mode", Q::PredictedMean, |a, j| rows(a.f(0) * a.x0(j))),
    ("prediction-transposed", Q::PredictedCovariance, |a, j| rows(turned(a.f(j).transpose(), a.p0(j)) + a.q(j))),
    ("covariance-not-moved", Q::PredictedCovariance, |a, j| rows(a.p0(j) + a.q(j))),
    ("motion-on-one-side", Q::PredictedCovariance, |a, j| rows(lower(a.f(j) * a.p0(j) + a.q(j)))),
    ("prediction-of-combined-covariance", Q::PredictedCovariance, |a, j| {
        rows(turned(a.f(j), a.before().m(Q::CombinedCovariance, 0)) + a.q(j))
    }),
    ("prediction-not-mirrored", Q::PredictedCovariance, |a, j| rows(turned(a.f(j), a.p0(j)) + a.q(j))),
];

/// Of the points X = x̂⁰ + L ξ, moved by F, about the predicted mean that is shown: F L Lᵀ Fᵀ + (F x̂⁰ − x̂⁻)(F x̂⁰ − x̂⁻)ᵀ + Q.
fn spread(a: At, j: usize, root: Matrix2<f64>) -> Vec<f64> {
    let mean = a.f(j) * a.x0(j) - a.xp(j);
    rows(turned(a.f(j) * root, Matrix2::identity()) + square(mean) + a.q(j))
}

#[rustfmt::skip]
const PREDICTION_BY_POINTS: &[Row] = &[
    ("points-from-rows-of-the-root", Q::PredictedCovariance, |a, j| spread(a, j, root(a.p0(j)).transpose())),
    ("points-without-root", Q::PredictedCovariance, |a, j| spread(a, j, a.p0(j))),
    ("points-without-correlation", Q::PredictedCovariance, |a, j| spread(a, j, diagonal(a.p0(j)).map(f64::sqrt))),
    ("points-on-the-unit-sphere", Q::PredictedCovariance, |a, j| spread(a, j, root(a.p0(j)) / 2.0_f64.sqrt())),
    ("points-scaled-by-the-square", Q::PredictedCovariance, |a, j| spread(a, j, root(a.p0(j)) * 2.0_f64.sqrt())),
    ("raw-predicted-covariance", Q::PredictedCovariance, |a, j| rows(turned(a.f(j), a.p0(j) + square(a.x0(j))))),
    ("prediction-spread-about-mixed-mean", Q::PredictedCovariance, |a, j| {
        rows(turned(a.f(j), a.p0(j)) + square(a.f(j) * a.x0(j) - a.x0(j)) + a.q(j))
    }),
    ("raw-moments", Q::PredictedCovariance, |a, j| rows(turned(a.f(j), a.p0(j) + square(a.x0(j))) - square(a.xp(j)) + a.q(j))),
    ("prediction-by-matrices", Q::PredictedMean, |a, j| rows(a.f(j) * a.x0(j))),
    ("prediction-by-matrices", Q::PredictedCovariance, |a, j| rows(turned(a.f(j), a.p0(j)) + a.q(j))),
    ("summation-reversed", Q::PredictedMean, |a, j| rows(a.f(j) * a.x0(j))),
    ("summation-reversed", Q::PredictedCovariance, |a, j| spread(a, j, root(a.p0(j)))),
];

/// The weights for covariances of the scaled unscented rule sum to W = 1 + (1 − α² + β), and they are about the centre, so that of the
/// deviation d of the mean W d dᵀ is left.
#[rustfmt::skip]
const SUMS_OVER_WEIGHTS: &[Row] = &[
    ("process-noise-inside-the-sum", Q::PredictedCovariance, |a, j| {
        rows(turned(a.f(j), a.p0(j)) + (square(a.f(j) * a.x0(j) - a.xp(j)) + a.q(j)) * WEIGHTS)
    }),
    ("measurement-noise-inside-the-sum", Q::InnovationCovariance, |a, j| {
        rows(turned(a.h(), a.pp(j)) + (square(a.h() * a.xp(j) - a.zh(j)) + a.r()) * WEIGHTS)
    }),
];

#[rustfmt::skip]
const MEASUREMENT: &[Row] = &[
    ("measurement-of-the-mixed-mean", Q::PredictedMeasurement, |a, j| rows(a.h() * a.x0(j))),
    ("measurement-of-the-combined-prediction", Q::PredictedMeasurement, |a, _| rows(a.h() * a.xcp())),
    ("innovation-reversed", Q::Innovation, |a, j| rows(a.zh(j) - a.z())),
    ("measurement-noise-omitted", Q::InnovationCovariance, |a, j| rows(turned(a.h(), a.pp(j)))),
    ("measurement-noise-doubled", Q::InnovationCovariance, |a, j| rows(turned(a.h(), a.pp(j)) + a.r() * 2.0)),
    ("measured-before-the-prediction", Q::InnovationCovariance, |a, j| rows(turned(a.h(), a.p0(j)) + a.r())),
    ("measured-before-the-prediction", Q::CrossCovariance, |a, j| rows(a.p0(j) * a.h().transpose())),
    ("cross-covariance-of-mixed-covariance", Q::CrossCovariance, |a, j| rows(a.p0(j) * a.h().transpose())),
];

/// H L Lᵀ Hᵀ + (H x − ẑ)(H x − ẑ)ᵀ + R of points about x.
fn seen(a: At, j: usize, x: Vector2<f64>, root: Matrix2<f64>) -> Vec<f64> {
    rows(turned(a.h() * root, Matrix2::identity()) + square(a.h() * x - a.zh(j)) + a.r())
}

#[rustfmt::skip]
const MEASUREMENT_BY_POINTS: &[Row] = &[
    ("points-from-rows-of-the-root", Q::InnovationCovariance, |a, j| seen(a, j, a.xp(j), root(a.pp(j)).transpose())),
    ("points-without-root", Q::InnovationCovariance, |a, j| seen(a, j, a.xp(j), a.pp(j))),
    ("points-without-correlation", Q::InnovationCovariance, |a, j| seen(a, j, a.xp(j), diagonal(a.pp(j)).map(f64::sqrt))),
    ("points-not-drawn-afresh", Q::PredictedMeasurement, |a, j| rows(a.h() * a.f(j) * a.x0(j))),
    ("points-not-drawn-afresh", Q::InnovationCovariance, |a, j| seen(a, j, a.f(j) * a.x0(j), a.f(j) * root(a.p0(j)))),
    ("points-not-moved", Q::PredictedMeasurement, |a, j| rows(a.h() * a.x0(j))),
    ("points-not-moved", Q::InnovationCovariance, |a, j| seen(a, j, a.x0(j), root(a.p0(j)))),
    ("measurement-noise-omitted", Q::InnovationCovariance, |a, j| rows(turned(a.h(), a.pp(j)) + square(a.h() * a.xp(j) - a.zh(j)))),
    ("cross-covariance-of-propagated-points", Q::CrossCovariance, |a, j| {
        let roots = a.f(j) * root(a.p0(j)) * root(a.pp(j)).transpose() * a.h().transpose();
        rows(roots + (a.f(j) * a.x0(j) - a.xp(j)) * (a.h() * a.xp(j) - a.zh(j)).transpose())
    }),
    ("raw-moments", Q::InnovationCovariance, |a, j| rows(turned(a.h(), a.pp(j) + square(a.xp(j))) - square(a.zh(j)) + a.r())),
    ("raw-moments", Q::CrossCovariance, |a, j| rows((a.pp(j) + square(a.xp(j))) * a.h().transpose() - a.xp(j) * a.zh(j).transpose())),
];

/// Where the sensor stands, and the coordinates of a state from there: the second entry of the state is x.
const SENSOR: [f64; 2] = [3.0, -2.0];

fn from(location: [f64; 2], state: Vector2<f64>) -> [f64; 2] {
    [state[1] - location[0], state[0] - location[1]]
}

/// Range and bearing of the points of the prediction, by another function of the coordinates.
fn each_point(a: At, j: usize, root: Matrix2<f64>, function: impl Fn(Vector2<f64>) -> [f64; 2]) -> [[f64; 2]; 4] {
    At::points(a.xp(j), root).map(function)
}

/// The mean of the points' ranges, and of their bearings as differences from that of the centre.
fn mean_of(a: At, j: usize, root: Matrix2<f64>, function: impl Fn(Vector2<f64>) -> [f64; 2]) -> Vec<f64> {
    let centre = function(a.xp(j))[1];
    let seen = each_point(a, j, root, function);
    let range = seen.iter().map(|[range, _]| range / 4.0).sum::<f64>();
    let bearing = seen
        .iter()
        .map(|[_, bearing]| wrapped(bearing - centre) / 4.0)
        .sum::<f64>();
    vec![range, centre + bearing]
}

/// The usual function.
fn usual(state: Vector2<f64>) -> [f64; 2] {
    let [x, y] = from(SENSOR, state);
    [x.hypot(y), y.atan2(x)]
}

/// The mean of the usual function with another bearing.
fn by_bearing(a: At, j: usize, bearing: fn(f64, f64) -> f64) -> Vec<f64> {
    mean_of(a, j, root(a.pp(j)), |state| {
        let [x, y] = from(SENSOR, state);
        [x.hypot(y), bearing(x, y)]
    })
}

/// Deviations of the points' measurements from ẑ, as plain numbers.
fn plain_deviations(a: At, j: usize) -> [Vector2<f64>; 4] {
    each_point(a, j, root(a.pp(j)), usual).map(|z| Vector2::from(z) - a.zh(j))
}

#[rustfmt::skip]
const POLAR: &[Row] = &[
    ("bearing-by-plain-arctangent", Q::PredictedMeasurement, |a, j| by_bearing(a, j, |x, y| (y / x).atan())),
    ("bearing-from-the-y-axis", Q::PredictedMeasurement, |a, j| by_bearing(a, j, f64::atan2)),
    ("bearing-clockwise", Q::PredictedMeasurement, |a, j| by_bearing(a, j, |x, y| -y.atan2(x))),
    ("bearing-in-degrees", Q::PredictedMeasurement, |a, j| by_bearing(a, j, |x, y| y.atan2(x).to_degrees())),
    ("range-without-root", Q::PredictedMeasurement, |a, j| mean_of(a, j, root(a.pp(j)), |state| {
        let [x, y] = from(SENSOR, state);
        [x * x + y * y, y.atan2(x)]
    })),
    ("sensor-position-ignored", Q::PredictedMeasurement, |a, j| mean_of(a, j, root(a.pp(j)), |state| {
        let [x, y] = from([0.0, 0.0], state);
        [x.hypot(y), y.atan2(x)]
    })),
    ("sensor-position-added", Q::PredictedMeasurement, |a, j| mean_of(a, j, root(a.pp(j)), |state| {
        let [x, y] = from(SENSOR.map(|coordinate| -coordinate), state);
        [x.hypot(y), y.atan2(x)]
    })),
    ("position-from-the-first-entries", Q::PredictedMeasurement, |a, j| mean_of(a, j, root(a.pp(j)), |state| {
        let [x, y] = from(SENSOR, vector![state[1], state[0]]);
        [x.hypot(y), y.atan2(x)]
    })),
    ("measurement-of-the-mean", Q::PredictedMeasurement, |a, j| usual(a.xp(j)).to_vec()),
    ("measurement-of-the-mixed-mean", Q::PredictedMeasurement, |a, j| usual(a.x0(j)).to_vec()),
    ("measurement-of-the-combined-prediction", Q::PredictedMeasurement, |a, _| usual(a.xcp()).to_vec()),
    ("bearing-mean-not-wrapped", Q::PredictedMeasurement, |a, j| plain_mean(a, j)),
    ("bearings-never-wrapped", Q::PredictedMeasurement, |a, j| plain_mean(a, j)),
    ("bearing-deviations-not-wrapped", Q::InnovationCovariance, |a, j| rows(plain_spread(a, j))),
    ("bearings-never-wrapped", Q::InnovationCovariance, |a, j| rows(plain_spread(a, j))),
    ("bearing-deviations-not-wrapped", Q::CrossCovariance, |a, j| rows(plain_cross(a, j))),
    ("bearings-never-wrapped", Q::CrossCovariance, |a, j| rows(plain_cross(a, j))),
    ("innovation-not-wrapped", Q::Innovation, |a, j| rows(a.z() - a.zh(j))),
    ("bearings-never-wrapped", Q::Innovation, |a, j| rows(a.z() - a.zh(j))),
    ("square-root-upper", Q::PredictedMeasurement, |a, j| mean_of(a, j, upper(a.pp(j)), usual)),
    ("square-root-symmetric", Q::PredictedMeasurement, |a, j| mean_of(a, j, symmetric(a.pp(j)), usual)),
    ("angle-mean-vector", Q::PredictedMeasurement, |a, j| {
        let seen = each_point(a, j, root(a.pp(j)), usual);
        let of = |function: fn(f64) -> f64| seen.iter().map(|z| function(z[1])).sum::<f64>();
        vec![seen.iter().map(|z| z[0] / 4.0).sum(), of(f64::sin).atan2(of(f64::cos))]
    }),
];

fn plain_mean(a: At, j: usize) -> Vec<f64> {
    let seen = each_point(a, j, root(a.pp(j)), usual);
    (0..2).map(|row| seen.iter().map(|z| z[row] / 4.0).sum()).collect()
}

fn plain_spread(a: At, j: usize) -> Matrix2<f64> {
    plain_deviations(a, j)
        .into_iter()
        .map(|d| square(d) / 4.0)
        .sum::<Matrix2<f64>>()
        + a.r()
}

fn plain_cross(a: At, j: usize) -> Matrix2<f64> {
    let points = At::points(a.xp(j), root(a.pp(j)));
    let pairs = points.into_iter().zip(plain_deviations(a, j));
    pairs.map(|(point, d)| (point - a.xp(j)) * d.transpose() / 4.0).sum()
}

/// What was measured: range and bearing.
fn polar_of(a: At) -> [f64; 2] {
    a.z().into()
}

/// The position of a range and a bearing, some times as far from the sensor.
fn position(a: At, times: f64) -> Vec<f64> {
    let [r, b] = polar_of(a);
    vec![SENSOR[0] + times * r * b.cos(), SENSOR[1] + times * r * b.sin()]
}

/// sustika2015 (22)-(26) of a range and a bearing.
fn turned_noise(a: At, r: f64, b: f64) -> [f64; 3] {
    let (along, across) = (a.r().m11, r * r * a.r().m22);
    let (c, s) = (b.cos(), b.sin());
    [
        across * s * s + along * c * c,
        across * c * c + along * s * s,
        (along - across) * s * c,
    ]
}

/// w = e^(−σ_θ²/2)
fn attenuation(a: At) -> f64 {
    (-a.r().m22 / 2.0).exp()
}

#[rustfmt::skip]
const CONVERTED: &[Row] = &[
    ("converted-measurement-axes-exchanged", Q::ConvertedMeasurement, |a, _| {
        let [r, b] = polar_of(a);
        vec![SENSOR[0] + r * b.sin(), SENSOR[1] + r * b.cos()]
    }),
    ("converted-measurement-clockwise", Q::ConvertedMeasurement, |a, _| {
        let [r, b] = polar_of(a);
        vec![SENSOR[0] + r * b.cos(), SENSOR[1] - r * b.sin()]
    }),
    ("sensor-position-ignored", Q::ConvertedMeasurement, |a, _| {
        let [r, b] = polar_of(a);
        vec![r * b.cos(), r * b.sin()]
    }),
    ("sensor-position-added", Q::ConvertedMeasurement, |a, _| {
        let [r, b] = polar_of(a);
        vec![r * b.cos() - SENSOR[0], r * b.sin() - SENSOR[1]]
    }),
    ("conversion-additive", Q::ConvertedMeasurement, |a, _| position(a, 1.0 - (attenuation(a).powi(2) - attenuation(a)))),
    ("conversion-multiplicative", Q::ConvertedMeasurement, |a, _| position(a, 1.0 / attenuation(a))),
    ("conversion-modified-unbiased", Q::ConvertedMeasurement, |a, _| position(a, attenuation(a))),
    ("converted-innovation-wrapped", Q::Innovation, |a, j| {
        let plain = a.v(Q::ConvertedMeasurement, 0) - a.zh(j);
        vec![plain[0], wrapped(plain[1])]
    }),
    ("innovation-reversed", Q::Innovation, |a, j| rows(a.zh(j) - a.v(Q::ConvertedMeasurement, 0))),
    ("converted-covariance-not-rotated", Q::ConvertedCovariance, |a, _| {
        vec![a.r().m11, 0.0, 0.0, polar_of(a)[0].powi(2) * a.r().m22]
    }),
    ("converted-covariance-of-polar-noise", Q::ConvertedCovariance, |a, _| rows(a.r())),
    ("converted-covariance-cross-term-of-other-sign", Q::ConvertedCovariance, |a, _| {
        let [x, y, xy] = turned_noise(a, polar_of(a)[0], polar_of(a)[1]);
        vec![x, -xy, -xy, y]
    }),
    ("converted-covariance-cross-term-omitted", Q::ConvertedCovariance, |a, _| {
        let [x, y, _] = turned_noise(a, polar_of(a)[0], polar_of(a)[1]);
        vec![x, 0.0, 0.0, y]
    }),
    ("converted-covariance-axes-exchanged", Q::ConvertedCovariance, |a, _| {
        let [x, y, xy] = turned_noise(a, polar_of(a)[0], polar_of(a)[1]);
        vec![y, xy, xy, x]
    }),
    ("converted-covariance-range-not-squared", Q::ConvertedCovariance, |a, _| {
        // (√r)² for r²
        let [r, b] = polar_of(a);
        let [x, y, xy] = turned_noise(a, r.sqrt(), b);
        vec![x, xy, xy, y]
    }),
    ("converted-covariance-by-jacobian", Q::ConvertedCovariance, |a, _| {
        let [x, y, xy] = turned_noise(a, polar_of(a)[0], polar_of(a)[1]);
        vec![x, xy, xy, y]
    }),
    ("converted-covariance-at-prediction", Q::ConvertedCovariance, |a, _| {
        let [r, b] = usual(a.xcp());
        let [x, y, xy] = turned_noise(a, r, b);
        vec![x, xy, xy, y]
    }),
    ("measurement-noise-omitted", Q::InnovationCovariance, |a, j| rows(turned(a.h(), a.pp(j)))),
    ("measurement-noise-doubled", Q::InnovationCovariance, |a, j| rows(turned(a.h(), a.pp(j)) + a.m(Q::ConvertedCovariance, 0) * 2.0)),
];

#[rustfmt::skip]
const NOT_DEBIASED: &[Row] = &[
    ("conversion-not-debiased", Q::ConvertedMeasurement, |a, _| position(a, 1.0)),
];

/// The gain of a covariance P: P Hᵀ (H P Hᵀ + R)⁻¹
fn gain(a: At, p: Matrix2<f64>) -> Matrix2<f64> {
    p * a.h().transpose() * inverse(turned(a.h(), p) + a.r())
}

/// P⁻ − W Cᵀ − C Wᵀ + W S Wᵀ with another S
fn joseph(a: At, j: usize, s: Matrix2<f64>) -> Vec<f64> {
    let once = a.w(j) * a.cross(j).transpose();
    rows(lower(a.pp(j) - once - once.transpose() + turned(a.w(j), s)))
}

#[rustfmt::skip]
const UPDATE: &[Row] = &[
    ("gain-of-mixed-covariance", Q::Gain, |a, j| rows(gain(a, a.p0(j)))),
    ("update-from-the-mixed-covariance", Q::Gain, |a, j| rows(gain(a, a.p0(j)))),
    ("update-from-the-mixed-covariance", Q::UpdatedCovariance, |a, j| rows((Matrix2::identity() - a.w(j) * a.h()) * a.p0(j))),
    ("gain-without-measurement-noise", Q::Gain, |a, j| rows(a.cross(j) * inverse(a.s(j) - a.r()))),
    ("gain-of-variances-alone", Q::Gain, |a, j| rows(a.cross(j) * inverse(diagonal(a.s(j))))),
    ("gain-by-entrywise-inverse", Q::Gain, |a, j| rows(a.cross(j) * a.s(j).map(|entry| 1.0 / entry))),
    ("gain-factors-exchanged", Q::Gain, |a, j| rows(inverse(a.s(j)) * a.cross(j))),
    ("gain-of-the-step-before", Q::Gain, |a, j| rows(a.before().w(j))),
    ("update-subtracted", Q::UpdatedMean, |a, j| rows(a.xp(j) - a.w(j) * a.nu(j))),
    ("update-of-the-mixed-mean", Q::UpdatedMean, |a, j| rows(a.x0(j) + a.w(j) * a.nu(j))),
    ("update-of-the-combined-prediction", Q::UpdatedMean, |a, j| rows(a.xcp() + a.w(j) * a.nu(j))),
    ("update-by-the-measurement", Q::UpdatedMean, |a, j| rows(a.xp(j) + a.w(j) * a.z())),
    ("covariance-not-updated", Q::UpdatedCovariance, |a, j| rows(a.pp(j))),
    ("covariance-update-added", Q::UpdatedCovariance, |a, j| rows(a.pp(j) + turned(a.w(j), a.s(j)))),
    ("covariance-update-of-mixed", Q::UpdatedCovariance, |a, j| rows(a.p0(j) - turned(a.w(j), a.s(j)))),
    ("covariance-update-without-s", Q::UpdatedCovariance, |a, j| rows(a.pp(j) - turned(a.w(j), Matrix2::identity()))),
    ("covariance-update-by-noise", Q::UpdatedCovariance, |a, j| rows(a.pp(j) - turned(a.w(j), a.r()))),
    ("joseph-update-without-noise", Q::UpdatedCovariance, |a, j| joseph(a, j, a.s(j) - a.r())),
    ("joseph-update-noise-doubled", Q::UpdatedCovariance, |a, j| joseph(a, j, a.s(j) + a.r())),
    ("joseph-update", Q::UpdatedCovariance, |a, j| rows(turned(Matrix2::identity() - a.w(j) * a.h(), a.pp(j)) + turned(a.w(j), a.r()))),
    ("update-by-cross-covariance", Q::UpdatedCovariance, |a, j| rows(a.pp(j) - a.w(j) * a.cross(j).transpose())),
    ("update-by-identity-minus-gain", Q::UpdatedCovariance, |a, j| rows((Matrix2::identity() - a.w(j) * a.h()) * a.pp(j))),
    ("information-update-of-the-mean", Q::UpdatedMean, |a, j| {
        let (before, of_measurement) = (inverse(a.pp(j)), a.h().transpose() * inverse(a.r()));
        rows(inverse(before + of_measurement * a.h()) * (before * a.xp(j) + of_measurement * (a.nu(j) + a.h() * a.xp(j))))
    }),
    ("information-update", Q::UpdatedCovariance, |a, j| rows(inverse(inverse(a.pp(j)) + a.h().transpose() * inverse(a.r()) * a.h()))),
    ("symmetrised-by-the-average", Q::UpdatedCovariance, |a, j| rows(a.pp(j) - turned(a.w(j), a.s(j)))),
    ("explicit-inverse", Q::Gain, |a, j| rows(a.cross(j) * inverse(a.s(j)))),
];

#[rustfmt::skip]
const UPDATE_BY_POINTS: &[Row] = &[
    ("joseph-update", Q::UpdatedCovariance, |a, j| joseph(a, j, a.s(j))),
];

#[rustfmt::skip]
const FIXED: &[Row] = &[
    ("gain-of-the-next-mode", Q::Gain, |a, j| rows(square_of(&a.given(j + 1).gain))),
    ("gain-of-the-first-mode", Q::Gain, |a, _| rows(square_of(&a.given(0).gain))),
    ("innovation-covariance-of-the-next-mode", Q::InnovationCovariance, |a, j| rows(square_of(&a.given(j + 1).innovation_covariance))),
    ("unmixed-for-mixed", Q::MixingProbabilities, |_, j| each(|i| if i == j { 1.0 } else { 0.0 })),
];

#[rustfmt::skip]
const FIXED_UNMIXED: &[Row] = &[
    ("mixed-for-unmixed", Q::MixingProbabilities, |a, j| each(|i| a.p(i, j) * a.mu(i) / a.c(j))),
];

/// H P⁻ Hᵀ + R, the innovation covariance of the detection that was missed.
fn missed_covariance(a: At, j: usize) -> Matrix2<f64> {
    turned(a.h(), a.pp(j)) + a.r()
}

/// The covariance after a detection that was missed.
fn as_if_detected(a: At, j: usize) -> Vec<f64> {
    let w = a.pp(j) * a.h().transpose() * inverse(missed_covariance(a, j));
    rows(a.pp(j) - turned(w, missed_covariance(a, j)))
}

#[rustfmt::skip]
const MISSED: &[Row] = &[
    ("missed-detection-as-zero-innovation", Q::UpdatedCovariance, as_if_detected),
    ("missed-detection-as-zero-innovation", Q::ModeProbabilities, |a, _| {
        normalised(&each(|j| a.c(j) * density(Vector2::zeros(), missed_covariance(a, j)).exp()))
    }),
    ("missed-detection-updates-the-covariance", Q::UpdatedCovariance, as_if_detected),
    ("missed-detection-not-predicted", Q::UpdatedMean, |a, j| rows(a.xb(j))),
    ("missed-detection-not-predicted", Q::UpdatedCovariance, |a, j| rows(a.pb(j))),
    ("missed-detection-only-mixed", Q::UpdatedMean, |a, j| rows(a.x0(j))),
    ("missed-detection-only-mixed", Q::UpdatedCovariance, |a, j| rows(a.p0(j))),
    ("probabilities-not-advanced", Q::ModeProbabilities, |a, _| each(|j| a.mu(j))),
    ("last-covariance-used-again", Q::ModeProbabilities, |a, _| {
        normalised(&each(|j| a.c(j) * density(Vector2::zeros(), a.before().s(j)).exp()))
    }),
    ("last-likelihood-used-again", Q::ModeProbabilities, |a, _| normalised(&each(|j| a.c(j) * a.before().l(j).exp()))),
];

/// −a νᵀ S⁻¹ ν − b ln|S| − c · 2 ln 2π
fn weighted(a: At, j: usize, [exponent, determinant, constant]: [f64; 3]) -> Vec<f64> {
    let s = a.s(j);
    vec![-exponent * distance(a.nu(j), s) - determinant * s.determinant().ln() - constant * 2.0 * (2.0 * PI).ln()]
}

#[rustfmt::skip]
const LIKELIHOOD: &[Row] = &[
    ("likelihood-exponent-21", Q::LogLikelihood, |a, j| vec![-0.5 * distance(a.nu(j), a.s(j)) - (a.s(j) * 2.0 * PI).determinant().ln()]),
    ("two-pi-outside-57", Q::LogLikelihood, |a, j| vec![-0.5 * distance(a.nu(j), a.s(j)) - 0.5 * (2.0 * PI * a.s(j).determinant()).ln()]),
    ("determinant-omitted", Q::LogLikelihood, |a, j| weighted(a, j, [0.5, 0.0, 0.5])),
    ("likelihood-not-normalised", Q::LogLikelihood, |a, j| weighted(a, j, [0.5, 0.0, 0.0])),
    ("determinant-without-root", Q::LogLikelihood, |a, j| weighted(a, j, [0.5, 1.0, 0.5])),
    ("determinant-in-the-numerator", Q::LogLikelihood, |a, j| weighted(a, j, [0.5, -0.5, 0.5])),
    ("exponent-without-half", Q::LogLikelihood, |a, j| weighted(a, j, [1.0, 0.5, 0.5])),
    ("exponent-without-covariance", Q::LogLikelihood, |a, j| vec![weighted(a, j, [0.0, 0.5, 0.5])[0] - 0.5 * a.nu(j).norm_squared()]),
    ("likelihood-of-updated-residual", Q::LogLikelihood, |a, j| vec![density(a.z() - a.h() * a.x(j), a.s(j))]),
    ("likelihood-of-updated-covariance", Q::LogLikelihood, |a, j| vec![density(a.nu(j), turned(a.h(), a.pu(j)) + a.r())]),
    ("likelihood-of-updated-estimate", Q::LogLikelihood, |a, j| {
        vec![density(a.z() - a.h() * a.x(j), turned(a.h(), a.pu(j)) + a.r())]
    }),
    ("likelihood-of-measurement-noise", Q::LogLikelihood, |a, j| vec![density(a.nu(j), a.r())]),
    ("likelihood-of-variances-alone", Q::LogLikelihood, |a, j| vec![density(a.nu(j), diagonal(a.s(j)))]),
    ("likelihood-of-the-first-component", Q::LogLikelihood, |a, j| {
        let (nu, s) = (a.nu(j)[0], a.s(j).m11);
        vec![-0.5 * nu * nu / s - 0.5 * (2.0 * PI * s).ln()]
    }),
    ("log-likelihood-without-two-pi", Q::LogLikelihood, |a, j| weighted(a, j, [0.5, 0.5, 0.0])),
    ("explicit-inverse", Q::LogLikelihood, |a, j| vec![density(a.nu(j), a.s(j))]),
    ("likelihood-by-cholesky", Q::LogLikelihood, |a, j| vec![density(a.nu(j), a.s(j))]),
];

#[rustfmt::skip]
const PROBABILITIES: &[Row] = &[
    ("updated-with-old-probabilities", Q::ModeProbabilities, |a, _| normalised(&each(|j| a.l(j).exp() * a.mu(j)))),
    ("prior-omitted", Q::ModeProbabilities, |a, _| normalised(&each(|j| a.l(j).exp()))),
    ("normaliser-22", Q::ModeProbabilities, |a, _| normalised(&each(|j| a.c(j)))),
    ("probabilities-not-normalised", Q::ModeProbabilities, |a, _| each(|j| a.l(j).exp() * a.c(j))),
    ("likelihoods-reversed", Q::ModeProbabilities, |a, _| normalised(&each(|j| a.l(2 - j).exp() * a.c(j)))),
    ("likelihood-not-exponentiated", Q::ModeProbabilities, |a, _| normalised(&each(|j| a.l(j) * a.c(j)))),
    ("probabilities-by-log-sum-exp", Q::ModeProbabilities, |a, _| normalised(&each(|j| a.l(j).exp() * a.c(j)))),
];

/// Σⱼ wⱼ [ P + (x − mean)(x − mean)ᵀ ] of the updated estimates.
fn of_updated(a: At, weight: impl Fn(usize) -> f64, mean: Vector2<f64>) -> Vec<f64> {
    rows(sum(|j| (a.pu(j) + square(a.x(j) - mean)) * weight(j)))
}

/// The same of the predicted ones.
fn of_predicted(a: At, weight: impl Fn(usize) -> f64, mean: Vector2<f64>) -> Vec<f64> {
    rows(sum(|j| (a.pp(j) + square(a.xp(j) - mean)) * weight(j)))
}

#[rustfmt::skip]
const COMBINATION: &[Row] = &[
    ("prediction-combined-with-old-probabilities", Q::CombinedPredictionMean, |a, _| rows(sum(|j| a.xp(j) * a.mu(j)))),
    ("prediction-combined-with-old-probabilities", Q::CombinedPredictionCovariance, |a, _| of_predicted(a, |j| a.mu(j), a.xcp())),
    ("prediction-spread-omitted", Q::CombinedPredictionCovariance, |a, _| rows(sum(|j| a.pp(j) * a.c(j)))),
    ("combined-with-predicted-probabilities", Q::CombinedMean, |a, _| rows(sum(|j| a.x(j) * a.c(j)))),
    ("combined-with-predicted-probabilities", Q::CombinedCovariance, |a, _| of_updated(a, |j| a.c(j), a.xc())),
    ("combined-with-old-probabilities", Q::CombinedMean, |a, _| rows(sum(|j| a.x(j) * a.mu(j)))),
    ("combined-with-old-probabilities", Q::CombinedCovariance, |a, _| of_updated(a, |j| a.mu(j), a.xc())),
    ("combined-with-equal-weights", Q::CombinedMean, |a, _| rows(sum(|j| a.x(j) * THIRD))),
    ("combined-with-equal-weights", Q::CombinedCovariance, |a, _| of_updated(a, |_| THIRD, a.xc())),
    ("combined-of-predicted-estimates", Q::CombinedMean, |a, _| rows(sum(|j| a.xp(j) * a.mun(j)))),
    ("combined-of-predicted-estimates", Q::CombinedCovariance, |a, _| of_predicted(a, |j| a.mun(j), a.xc())),
    ("combined-spread-omitted", Q::CombinedCovariance, |a, _| rows(sum(|j| a.pu(j) * a.mun(j)))),
    ("combined-covariance-weights-squared", Q::CombinedCovariance, |a, _| of_updated(a, |j| a.mun(j).powi(2), a.xc())),
    ("combined-spread-inner-product", Q::CombinedCovariance, |a, _| rows(sum(|j| (a.pu(j) + inner(a.x(j) - a.xc())) * a.mun(j)))),
    ("combined-spread-about-prediction", Q::CombinedCovariance, |a, _| of_updated(a, |j| a.mun(j), a.xcp())),
    ("mixture-by-raw-moments", Q::CombinedCovariance, |a, _| rows(sum(|j| (a.pu(j) + square(a.x(j))) * a.mun(j)) - square(a.xc()))),
    ("summation-reversed", Q::CombinedMean, |a, _| rows(sum(|j| a.x(j) * a.mun(j)))),
    ("summation-reversed", Q::CombinedCovariance, |a, _| of_updated(a, |j| a.mun(j), a.xc())),
];

#[rustfmt::skip]
const FIRST_STEP: &[Row] = &[
    ("first-step-unmixed", Q::PredictedModeProbabilities, |a, _| each(|j| a.mu(j))),
    ("first-step-unmixed", Q::MixingProbabilities, |_, j| each(|i| if i == j { 1.0 } else { 0.0 })),
    ("first-step-predicted", Q::PredictedModeProbabilities, |a, _| each(|j| a.mu(j))),
    ("first-step-predicted", Q::MixingProbabilities, |_, j| each(|i| if i == j { 1.0 } else { 0.0 })),
    ("first-step-predicted", Q::PredictedMean, |a, j| rows(a.x0(j))),
    ("first-step-predicted", Q::PredictedCovariance, |a, j| rows(a.p0(j))),
];

/// A mean or covariance with the second entry of the third mode taken from mode j.
fn augmented(a: At, i: usize, j: usize) -> (Vector2<f64>, Matrix2<f64>) {
    let (mut x, mut p) = (a.xb(i), a.pb(i));
    if i == 2 {
        x[1] = a.xb(j)[1];
        p = matrix![p.m11, 0.0; 0.0, a.pb(j).m22];
    }
    (x, p)
}

/// Without the second row and column in the third mode.
fn index_wise(i: usize, moment: Matrix2<f64>) -> Matrix2<f64> {
    if i == 2 {
        matrix![moment.m11, 0.0; 0.0, 0.0]
    } else {
        moment
    }
}

#[rustfmt::skip]
const UNEQUAL: &[Row] = &[
    ("unequal-dimensions-index-wise", Q::MixedCovariance, |a, j| {
        rows(sum(|i| index_wise(i, a.pb(i) + square(a.xb(i) - a.x0(j))) * a.mix(j, i)))
    }),
    ("unequal-dimensions-index-wise", Q::CombinedCovariance, |a, _| {
        rows(sum(|j| index_wise(j, a.pu(j) + square(a.x(j) - a.xc())) * a.mun(j)))
    }),
    ("unequal-dimensions-unbiased", Q::MixedMean, |a, j| rows(sum(|i| augmented(a, i, j).0 * a.mix(j, i)))),
    ("unequal-dimensions-unbiased", Q::MixedCovariance, |a, j| rows(sum(|i| {
        let (x, p) = augmented(a, i, j);
        (p + square(x - a.x0(j))) * a.mix(j, i)
    }))),
];

/// A variant of the problem, and what it does to it.
type Misread = (&'static str, fn(&mut Scene));

/// The rows of a measurement that are bearings.
fn bearings(scene: &Scene) -> Vec<usize> {
    match &scene.problem.sensor {
        Sensor::Linear(_) | Sensor::Function { .. } => vec![],
        Sensor::Polar { .. } => vec![1],
    }
}

/// The diagonal of a matrix of the problem, and zeros beside it.
fn variances(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_diagonal(&matrix.diagonal())
}

#[rustfmt::skip]
const INPUTS: &[Misread] = &[
    ("motion-by-columns", |s| s.problem.modes.iter_mut().for_each(|mode| mode.motion.matrix_mut().unwrap().transpose_mut())),
    ("measurement-matrix-by-columns", |s| if let Sensor::Linear(h) = &mut s.problem.sensor { h.transpose_mut() }),
    ("process-noise-of-variances-alone", |s| s.problem.modes.iter_mut().for_each(|mode| mode.noise = variances(&mode.noise))),
    ("measurement-noise-of-variances-alone", |s| s.problem.measurement_noise = variances(&s.problem.measurement_noise)),
    ("measurement-noise-of-standard-deviations", |s| s.problem.measurement_noise = variances(&s.problem.measurement_noise).map(f64::sqrt)),
    ("measurement-noise-squared", |s| s.problem.measurement_noise = variances(&s.problem.measurement_noise).map(|r| r * r)),
    ("bearing-noise-in-degrees", |s| {
        for row in bearings(s) {
            for i in 0..2 {
                // In this order: an entry on the diagonal is multiplied twice.
                s.problem.measurement_noise[(row, i)] *= PI / 180.0;
                s.problem.measurement_noise[(i, row)] *= PI / 180.0;
            }
        }
    }),
    ("modes-reversed", |s| s.problem.modes.reverse()),
    ("initial-estimates-reversed", |s| s.initial.modes.reverse()),
    ("initial-probabilities-reversed", |s| s.initial.mode_probabilities.reverse()),
    ("initial-probabilities-equal", |s| s.initial.mode_probabilities = vec![THIRD; 3]),
    ("initial-estimate-of-the-first-mode", |s| s.initial.modes = vec![s.initial.modes[0].clone(); 3]),
    ("initial-covariance-of-variances-alone", |s| s.initial.modes.iter_mut().for_each(|e| e.covariance = variances(&e.covariance))),
    ("initial-covariance-of-standard-deviations", |s| {
        s.initial.modes.iter_mut().for_each(|e| e.covariance = variances(&e.covariance).map(f64::sqrt));
    }),
    ("initial-covariance-ignored", |s| s.initial.modes.iter_mut().for_each(|e| e.covariance = DMatrix::identity(2, 2))),
    ("initial-mean-ignored", |s| s.initial.modes.iter_mut().for_each(|e| e.mean = DVector::zeros(2))),
    ("measurement-of-the-next-step", |s| { s.measurements.remove(0); s.measurements.push(s.measurements.last().unwrap().clone()); }),
    ("measurement-of-the-step-before", |s| { s.measurements.pop(); s.measurements.insert(0, s.measurements[0].clone()); }),
    ("measurement-entries-reversed", |s| s.measurements.iter_mut().flatten().for_each(|z| *z = dvector![z[1], z[0]])),
    ("degrees-for-radians", |s| {
        for row in bearings(s) {
            s.measurements.iter_mut().flatten().for_each(|z| z[row] *= PI / 180.0);
        }
    }),
];

// The scenes

/// α, β and κ of the scaled unscented rule.
const SCALED: [f64; 3] = [0.5, 2.0, 0.5];

/// Σ of its weights for covariances: 1 + (1 − α² + β).
const WEIGHTS: f64 = 2.0 + SCALED[1] - SCALED[0] * SCALED[0];

/// Kalman filters with full matrices; the third motion sets the second entry of the state to zero.
fn kalman() -> Scene {
    let modes = [
        (dmatrix![1.1, 0.3; -0.2, 0.9], dmatrix![1.3, 0.4; 0.4, 0.8]),
        (dmatrix![0.8, -0.5; 0.4, 1.2], dmatrix![2.1, -0.3; -0.3, 1.7]),
        (dmatrix![0.9, 0.7; 0.0, 0.0], dmatrix![0.7, 0.1; 0.1, 0.3]),
    ];
    let estimates = [
        (dvector![5.0, -3.0], dmatrix![4.0, 1.0; 1.0, 3.0]),
        (dvector![7.0, -2.0], dmatrix![3.0, -0.7; -0.7, 5.0]),
        (dvector![4.0, -5.0], dmatrix![2.0, 0.4; 0.4, 2.5]),
    ];
    let mode = |(transition, noise)| Mode {
        name: "mode".into(),
        motion: Motion::Linear(transition),
        noise,
    };
    let estimate = |(mean, covariance)| Gaussian { mean, covariance };
    Setup {
        changes: BTreeMap::new(),
        rates: BTreeMap::new(),
        truths: vec![],
        problem: Problem {
            modes: modes.map(mode).to_vec(),
            chain: vec![vec![0.7, 0.2, 0.1], vec![0.15, 0.6, 0.25], vec![0.05, 0.4, 0.55]],
            sensor: Sensor::Linear(dmatrix![1.2, 0.3; -0.4, 0.9]),
            measurement_noise: dmatrix![2.0, 0.5; 0.5, 1.5],
            filters: vec![Filter::kalman()],
            interaction: Interaction::Imm,
            angles: vec![],
        },
        equations: Equations::standard(),
        initial: Initial {
            modes: estimates.map(estimate).to_vec(),
            mode_probabilities: vec![0.5, 0.3, 0.2],
        },
        measurements: vec![
            Some(dvector![6.0, -7.0]),
            Some(dvector![5.5, -4.0]),
            Some(dvector![4.0, -6.5]),
        ],
    }
}

/// The same with the points of a rule.
fn points(rule: &str) -> Scene {
    let mut scene = kalman();
    scene.problem.filters = vec![Filter::points(points_of(rule))];
    scene
}

/// The points and weights of a rule, by its name.
fn points_of(rule: &str) -> Rule<f64, Dyn> {
    rule.parse::<RuleName>().unwrap().rule_in(Dyn(2)).unwrap()
}

/// The rule of a scene's filter, the same for the motion and for the measurement.
fn rule(scene: &Scene) -> Rule<f64, Dyn> {
    let [filter] = &scene.problem.filters[..] else {
        panic!("one filter for all modes");
    };
    let [motion, measurement] = filter.rules();
    assert_eq!(motion, measurement);
    motion.expect("it draws points").clone()
}

/// The same with points whose weights for covariances do not sum to one.
fn scaled_points() -> Scene {
    let mut scene = kalman();
    let [alpha, beta, kappa] = SCALED;
    let rule: Rule<f64, Dyn> = unscented_in(Dyn(2), &alpha, &beta, &kappa).unwrap();
    assert!((rule.covariance_weights.iter().sum::<f64>() - WEIGHTS).abs() < ROUNDING);
    scene.problem.filters = vec![Filter::points(rule)];
    scene
}

/// Range and bearing of a target to the west of the sensor, so that the bearing is cut where the target is; the second entry of the
/// state is x.
fn polar() -> Scene {
    let mut scene = points("cubature-3");
    scene.problem.sensor = Sensor::Polar {
        components: vec![PolarComponent::Range, PolarComponent::Bearing],
        position: [1, 0],
        location: SENSOR,
    };
    scene.problem.measurement_noise = dmatrix![0.5, 0.01; 0.01, 0.02];
    for (j, estimate) in [0.0, 1.0, 2.0].into_iter().zip(&mut scene.initial.modes) {
        estimate.mean = dvector![-2.0 + 0.3 * j, -40.0 + j];
    }
    for mode in &mut scene.problem.modes {
        let f = mode.motion.matrix_mut().unwrap();
        *f = DMatrix::identity(2, 2) + &*f / 100.0;
    }
    scene.measurements = [3.1, -3.0, 3.05].map(|bearing| Some(dvector![42.0, bearing])).to_vec();
    scene
}

/// Extended filters of range and bearing, which all move along one curve.
fn curving() -> Scene {
    let mut scene = polar();
    scene.problem.filters = vec![Filter::extended()];
    let curve = [("a", "a + 0.3*sin(b/10)"), ("b", "b - 0.005*a*b")];
    let function = Function::of_formulas(&["a", "b"], &[], &[], &[], &curve).unwrap();
    for mode in &mut scene.problem.modes {
        mode.motion = Motion::Function {
            function: function.clone().into(),
            given: Vec::new(),
        };
    }
    scene
}

/// Kalman filters whose second step is another.
fn changing() -> Scene {
    let mut scene = kalman();
    let mut problem = scene.problem.clone();
    for mode in &mut problem.modes {
        *mode.motion.matrix_mut().unwrap() *= 1.1;
        mode.noise *= 1.5;
    }
    problem.measurement_noise *= 1.3;
    scene.changes.insert(2, problem);
    scene
}

/// The second entry of the state is a heading, near ±π in every mode and hardly measured.
fn heading() -> Scene {
    let mut scene = kalman();
    scene.problem.angles = vec![1];
    scene.problem.measurement_noise *= 1e4;
    for (mode, estimate) in scene.problem.modes.iter_mut().zip(&mut scene.initial.modes) {
        *mode.motion.matrix_mut().unwrap() = dmatrix![1.1, 0.3; 0.0, 1.0];
        estimate.covariance *= 0.01;
    }
    for (estimate, heading) in scene.initial.modes.iter_mut().zip([2.9, -2.2, 2.8]) {
        estimate.mean[1] = heading;
    }
    scene
}

/// The second mode has a state of its own.
fn separate() -> Scene {
    let mut scene = kalman();
    let dynamic = |matrix: Matrix2<f64>| dmatrix![matrix.m11, matrix.m12; matrix.m21, matrix.m22];
    let curve = [("a", "a + 0.02*b*b"), ("b", "1.2*b - 0.1*a")];
    let function = Function::of_formulas(&["a", "b"], &[], &[], &[], &curve).unwrap();
    let along_the_curve = || Motion::Function {
        function: function.clone().into(),
        given: Vec::new(),
    };
    let along_the_line = || Motion::Linear(dynamic(BACK));
    let conversion = |from, to, map, added| StateConversion {
        from,
        to,
        map,
        added: dynamic(added),
    };
    let list = vec![
        conversion(0, Reader::Mode(1), along_the_curve(), ADDED),
        conversion(2, Reader::Mode(1), along_the_curve(), Matrix2::zeros()),
        conversion(1, Reader::Mode(0), along_the_line(), Matrix2::zeros()),
        conversion(1, Reader::Mode(2), along_the_line(), Matrix2::zeros()),
        conversion(1, Reader::Common, along_the_line(), Matrix2::zeros()),
    ];
    let angles = vec![vec![]; 3];
    scene.problem.interaction = Interaction::Converted(StateConversions { list, angles });
    scene
}

/// The same converted to a position.
fn converted(conversion: Conversion) -> Scene {
    let mut scene = polar();
    scene.problem.filters = vec![Filter::converted(conversion)];
    scene.problem.measurement_noise = dmatrix![0.5, 0.0; 0.0, 0.02];
    scene
}

/// Filters with fixed gains.
fn fixed(interaction: Interaction<f64, Dyn>) -> Scene {
    let mut scene = kalman();
    let given = |j: f64| FixedGain {
        gain: dmatrix![0.5 + 0.1 * j, 0.02; 0.2, 0.3 - 0.05 * j],
        innovation_covariance: dmatrix![7.0 + j, 0.6; 0.6, 9.0 - j],
    };
    scene.problem.filters = [0.0, 1.0, 2.0].map(|j| Filter::given(given(j))).to_vec();
    scene.problem.interaction = interaction;
    for estimate in &mut scene.initial.modes {
        estimate.covariance.fill(0.0);
    }
    scene
}

/// [`kalman`] with noises that have something in common.
fn correlated() -> Scene {
    let mut scene = kalman();
    let filter = Filter::kalman().with_noise_cross_covariance(dmatrix![0.4, -0.3; 0.2, 0.5]);
    scene.problem.filters = vec![filter];
    scene
}

/// One state, one measurement, one mode.
fn scalar() -> Scene {
    Setup {
        changes: BTreeMap::new(),
        rates: BTreeMap::new(),
        truths: vec![],
        problem: Problem {
            modes: vec![Mode {
                name: "walk".into(),
                motion: Motion::Linear(dmatrix![0.9]),
                noise: dmatrix![1.5],
            }],
            filters: vec![Filter::kalman()],
            interaction: Interaction::Imm,
            angles: vec![],
            chain: vec![vec![1.0]],
            sensor: Sensor::Linear(dmatrix![0.8]),
            measurement_noise: dmatrix![2.0],
        },
        equations: Equations::standard(),
        initial: Initial {
            modes: vec![Gaussian {
                mean: dvector![3.0],
                covariance: dmatrix![4.0],
            }],
            mode_probabilities: vec![1.0],
        },
        measurements: vec![Some(dvector![5.0])],
    }
}

/// A number between −1 and 1 that is like no other: the multiples of the golden ratio are spread evenly.
fn value(seed: u32) -> f64 {
    2.0 * (0.618_033_988_749_895 * f64::from(seed)).fract() - 1.0
}
