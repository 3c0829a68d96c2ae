//! Goal: modes that all start from the combined estimate are the first-order filter of the literature; modes that each start from their
//! own are its static bank.
//!
//! Method: the equations in rational functions and rationals, and whole certified runs against one another: certified doubles of equal
//! values are equal. Problems that must be refused are refused in a sentence.
#![allow(clippy::unwrap_used, reason = "in tests a panic is the failure")]
#![allow(clippy::float_cmp, reason = "certified doubles of equal values are equal")]

mod common;

use common::problems::{published, read, refusal};
use immaculate::imm::Quantity;
use immaculate::imm::probability::{evidence, mixing_probability, mode_probability, predicted_mode_probability};
use immaculate::number::{Field, Rational, RationalFunction};
use immaculate::oracle::certify::certify;
use immaculate::oracle::trace::Trace;
use serde_json::{Value, json};

/// The certified values of a problem whose modes start as `interaction` says.
fn certified(problem: &Value, interaction: &str) -> Trace {
    let mut problem = problem.clone();
    problem["interaction"] = json!(interaction);
    certify(&read(&problem)).unwrap().trace
}

/// Three Kalman filters along four steps, one without a detection, under this chain.
fn under(chain: Value) -> Value {
    let mut problem = published("gpb1.kalman");
    problem["transition"] = chain;
    problem["initial"]["mode_probabilities"] = json!([0.5, 0.25, 0.25]);
    problem
}

const FORGETFUL: [[f64; 3]; 3] = [[0.5, 0.375, 0.125]; 3];
const LASTING: [[f64; 3]; 3] = [[0.75, 0.25, 0.0], [0.125, 0.625, 0.25], [0.25, 0.25, 0.5]];
const ETERNAL: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

// All from the combined estimate

#[test]
fn first_order_filters_start_every_mode_from_the_combined_estimate() {
    let trace = certified(&under(json!(LASTING)), "gpb1");
    for step in 2..=4 {
        let probabilities = trace.get(step - 1, Quantity::ModeProbabilities, 0);
        for j in 0..3 {
            let of = |quantity| trace.get(step, quantity, j);
            let before = |quantity| trace.get(step - 1, quantity, 0);
            assert_eq!(of(Quantity::MixingProbabilities), probabilities);
            assert_eq!(of(Quantity::MixedMean), before(Quantity::CombinedMean));
            assert_eq!(of(Quantity::MixedCovariance), before(Quantity::CombinedCovariance));
        }
    }
    // The chain moves the probabilities: cⱼ = Σᵢ pᵢⱼ μᵢ, in numbers that doubles hold.
    assert_eq!(
        trace.get(1, Quantity::PredictedModeProbabilities, 0).unwrap(),
        &[0.46875, 0.34375, 0.1875]
    );
    assert_ne!(trace, certified(&under(json!(LASTING)), "imm"));
}

/// pᵢⱼ = qⱼ for all i: μᵢ∣ⱼ = qⱼ μᵢ / (qⱼ Σᵢ μᵢ) = μᵢ, for all q and all μ that sum to one.
#[test]
fn where_the_chain_forgets_the_first_order_filter_is_the_interacting_one() {
    let [q, first] = ["q", "mu"].map(RationalFunction::unknown);
    let one = || RationalFunction::integer(1);
    let chain = vec![vec![q.clone(), one() - q]; 2];
    let probabilities = [first.clone(), one() - first];
    for j in 0..2 {
        let predicted = predicted_mode_probability(&chain, &probabilities, j);
        for i in 0..2 {
            let mixing = mixing_probability(&chain, &probabilities, &predicted, i, j);
            assert_eq!(mixing, probabilities[i], "{i} {j}");
        }
    }
    let problem = under(json!(FORGETFUL));
    assert_eq!(certified(&problem, "gpb1"), certified(&problem, "imm"));
}

#[test]
fn a_mode_that_is_alone_is_one_filter_however_it_starts() {
    let mut problem = under(json!([[1.0]]));
    problem["modes"].as_array_mut().unwrap().truncate(1);
    problem["initial"]["modes"].as_array_mut().unwrap().truncate(1);
    problem["initial"]["mode_probabilities"] = json!([1.0]);
    let alone = certified(&problem, "imm");
    assert_eq!(certified(&problem, "gpb1"), alone);
    assert_eq!(certified(&problem, "unmixed"), alone);
}

#[test]
fn identical_modes_are_one_filter_however_they_start() {
    let mut one = under(json!([[1.0]]));
    one["modes"].as_array_mut().unwrap().truncate(1);
    one["initial"]["modes"].as_array_mut().unwrap().truncate(1);
    one["initial"]["mode_probabilities"] = json!([1.0]);
    let alone = certified(&one, "imm");
    let mut three = under(json!(LASTING));
    for list in [["modes"].as_slice(), &["initial", "modes"]] {
        let list = list.iter().fold(&mut three, |value, key| &mut value[*key]);
        let first = list[0].clone();
        list.as_array_mut().unwrap().fill(first);
    }
    for interaction in ["imm", "gpb1", "unmixed"] {
        let found = certified(&three, interaction);
        for step in 1..=4 {
            for quantity in [Quantity::CombinedMean, Quantity::CombinedCovariance] {
                let of = |trace: &Trace| trace.get(step, quantity, 0).cloned();
                assert_eq!(of(&found), of(&alone), "{interaction}, step {step}");
            }
        }
    }
}

// Each from its own

/// μⱼ(k) = μⱼ(0) Lⱼ(1) … Lⱼ(k) / Σᵢ μᵢ(0) Lᵢ(1) … Lᵢ(k), where no mode leads to another.
#[test]
fn a_static_bank_is_the_rule_of_bayes_on_products_of_likelihoods() {
    let ratio = |(numerator, denominator)| Rational::new(numerator, denominator);
    let chain: Vec<Vec<Rational>> = (0..3)
        .map(|i| (0..3).map(|j| Rational::integer(i64::from(i == j))).collect())
        .collect();
    let likelihoods = [
        [(1, 7), (3, 5), (2, 9)],
        [(4, 3), (1, 8), (5, 6)],
        [(2, 11), (3, 10), (7, 4)],
    ]
    .map(|step| step.map(ratio));
    let initial = [(1, 2), (1, 3), (1, 6)].map(ratio);
    let mut probabilities = initial.to_vec();
    let mut products = initial.to_vec();
    for of_step in &likelihoods {
        let predicted: Vec<Rational> = (0..3)
            .map(|j| predicted_mode_probability(&chain, &probabilities, j))
            .collect();
        let sum = evidence(of_step, &predicted);
        probabilities = (0..3)
            .map(|j| mode_probability(&of_step[j], &predicted[j], &sum))
            .collect();
        for (product, likelihood) in products.iter_mut().zip(of_step) {
            *product *= likelihood.clone();
        }
        let total = products
            .iter()
            .cloned()
            .fold(Rational::integer(0), |sum, product| sum + product);
        let expected: Vec<Rational> = products.iter().map(|product| product.clone() / total.clone()).collect();
        assert_eq!(probabilities, expected);
    }
}

/// The static bank is the interacting filter under the unit chain, and each mode is its filter alone, whatever the others are.
#[test]
fn the_modes_of_a_static_bank_stand_alone() {
    let problem = under(json!(ETERNAL));
    let bank = certified(&problem, "unmixed");
    assert_eq!(bank, certified(&problem, "imm"));
    assert_ne!(bank, certified(&problem, "gpb1"));
    for j in 0..3 {
        let mut alone = under(json!([[1.0]]));
        alone["modes"] = json!([problem["modes"][j]]);
        alone["initial"] = json!({ "mode_probabilities": [1.0], "modes": [problem["initial"]["modes"][j]] });
        let alone = certified(&alone, "imm");
        for step in 1..=4 {
            for quantity in [
                Quantity::UpdatedMean,
                Quantity::UpdatedCovariance,
                Quantity::LogLikelihood,
            ] {
                assert_eq!(
                    bank.get(step, quantity, j),
                    alone.get(step, quantity, 0),
                    "mode {j}, step {step}"
                );
            }
        }
    }
    // Under another chain the modes are still alone, and only their probabilities are others.
    let moving = certified(&under(json!(LASTING)), "unmixed");
    assert_eq!(
        moving.get(4, Quantity::UpdatedMean, 1),
        bank.get(4, Quantity::UpdatedMean, 1)
    );
    assert_ne!(
        moving.get(4, Quantity::ModeProbabilities, 0),
        bank.get(4, Quantity::ModeProbabilities, 0)
    );
}

// Problems

#[test]
fn who_does_not_claim_another_start_is_not_asked_for_it() {
    assert_eq!(read(&published("gpb1.kalman")).kinds(), ["kalman", "gpb1"]);
    assert_eq!(read(&published("unmixed.static-bank")).kinds(), ["extended", "unmixed"]);
    let mut plain = published("gpb1.kalman");
    plain["interaction"] = json!("imm");
    assert_eq!(read(&plain).kinds(), ["kalman"]);
    assert_eq!(
        read(&published("step.fixed-gain-unmixed")).kinds(),
        ["fixed-gain-unmixed"]
    );
}

#[test]
fn where_modes_start_is_said_once_and_by_a_known_word() {
    let mut problem = published("gpb1.kalman");
    problem["interaction"] = json!("gpb2");
    let sentence = "problem.interaction: unknown variant `gpb2`, expected one of `imm`, `gpb1`, `unmixed`";
    assert!(refusal(&problem).starts_with(sentence), "{}", refusal(&problem));
    problem["interaction"] = Value::Null;
    assert!(
        refusal(&problem).starts_with("problem.interaction: "),
        "{}",
        refusal(&problem)
    );
    problem["interaction"] = json!("gpb1");
    problem["format"] = json!("immaculate-problem/1");
    assert!(
        refusal(&problem).starts_with("problem.interaction: needs the format"),
        "{}",
        refusal(&problem)
    );
    let mut given = published("step.fixed-gain-unmixed");
    given["format"] = json!("immaculate-problem/2");
    given["interaction"] = json!("unmixed");
    assert_eq!(
        refusal(&given),
        "problem.interaction: is \"unmixed\", and `filter.mixing` says it of fixed gains; leave `interaction` out"
    );
    let mut states = published("states.kalman");
    states["interaction"] = json!("gpb1");
    assert_eq!(
        refusal(&states),
        "problem.interaction: is \"gpb1\", and `conversions` give modes states of their own, which \"imm\" alone mixes"
    );
    states["interaction"] = json!("imm");
    assert_eq!(read(&states).kinds(), ["kalman", "state-conversion"]);
}
