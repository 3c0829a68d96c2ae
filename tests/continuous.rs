//! Goal: the chain of a step of any length is e^(G T), whatever computes it, and what a file says of it is read or refused.
//!
//! Method: on enclosures against closed forms and against itself over other times; in rationals for what comes before; certified runs step
//! by step, and problems that must be refused. Kind of evidence: enclosed, exact.
#![allow(clippy::unwrap_used, reason = "in tests a panic is the failure")]
#![allow(clippy::float_cmp, reason = "the zeros of a chain are exact")]

mod common;

use common::problems::{published, refusal};
use immaculate::imm::Quantity;
use immaculate::imm::continuous::{rates_of_sojourns, transition_over};
use immaculate::number::{Enclosure, Field, Rational, Real};
use immaculate::oracle::certify::certify;
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::trace::Trace;
use serde_json::{Value, json};

type Chain<T> = Vec<Vec<T>>;

/// Rates of three modes, none like another.
const RATES: [[f64; 3]; 3] = [[-0.75, 0.5, 0.25], [0.125, -1.125, 1.0], [2.0, 0.0625, -2.0625]];

fn on<T: Clone>(rates: [[f64; 3]; 3], number: fn(f64) -> T) -> Chain<T> {
    rates.map(|row| row.map(number).to_vec()).to_vec()
}

fn at<R>(work: impl FnOnce() -> R) -> R {
    Enclosure::with_precision(256, work)
}

/// Whether an enclosure says no more than that a difference is zero, and says that with two hundred bits.
fn is_narrow_around_zero(difference: &Enclosure) -> bool {
    let tiny = Rational::new(1, 1 << 60) * Rational::new(1, 1 << 60) * Rational::new(1, 1 << 60);
    let bound = Enclosure::rational(&tiny);
    difference.contains(&Rational::integer(0)) && *difference < bound.clone() && *difference > -bound
}

fn product(a: &Chain<Enclosure>, b: &Chain<Enclosure>) -> Chain<Enclosure> {
    let entry =
        |i: usize, j: usize| (0..3).fold(Enclosure::integer(0), |sum, l| sum + a[i][l].clone() * b[l][j].clone());
    (0..3).map(|i| (0..3).map(|j| entry(i, j)).collect()).collect()
}

fn assert_equal(a: &Chain<Enclosure>, b: &Chain<Enclosure>) {
    for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
        assert!(is_narrow_around_zero(&(a.clone() - b.clone())), "{a:?} {b:?}");
    }
}

// e^(G T)

/// P₁₂ = a/(a + b) (1 − e^(−(a + b)T)), and with a and b exchanged P₂₁; from nothing to thousands of sojourns.
#[test]
fn a_chain_of_two_modes_is_its_closed_form() {
    for (a, b, interval) in [
        (0.5, 0.25, 1.0),
        (3.0, 1e-9, 0.125),
        (1e-12, 2e-12, 1.0),
        (700.0, 900.0, 4.0),
        (2.0, 3.0, 0.0),
    ] {
        at(|| {
            let [a, b, interval] = [a, b, interval].map(Enclosure::exact);
            let chain = transition_over(&[vec![-a.clone(), a.clone()], vec![b.clone(), -b.clone()]], &interval);
            let sum = a.clone() + b.clone();
            let part = (Enclosure::integer(1) - Real::exp(&(-sum.clone() * interval))) / sum;
            for (found, rate) in [(&chain[0][1], a), (&chain[1][0], b)] {
                assert!(
                    is_narrow_around_zero(&(found.clone() - rate * part.clone())),
                    "{found:?}"
                );
            }
        });
    }
}

#[test]
fn two_steps_of_a_half_are_one_step() {
    at(|| {
        for interval in [0.375, 3.0, 96.0] {
            let [half, whole] =
                [interval / 2.0, interval].map(|t| transition_over(&on(RATES, Enclosure::exact), &Enclosure::exact(t)));
            assert_equal(&product(&half, &half), &whole);
        }
        // So are steps of unequal lengths, in either order.
        let [a, b, both] =
            [0.25, 1.5, 1.75].map(|t| transition_over(&on(RATES, Enclosure::exact), &Enclosure::exact(t)));
        assert_equal(&product(&a, &b), &both);
        assert_equal(&product(&b, &a), &both);
        // The Euler step is not the exponential.
        let euler = Enclosure::integer(1) + Enclosure::exact(RATES[0][0] * 0.25);
        assert!(a[0][0] > euler);
    });
}

#[test]
fn the_rows_of_a_chain_over_any_time_sum_to_one() {
    for interval in [0.0, 1e-9, 0.7, 40.0, 1e9] {
        at(|| {
            let chain = transition_over(&on(RATES, Enclosure::exact), &Enclosure::exact(interval));
            for row in &chain {
                let sum = row.iter().fold(Enclosure::integer(0), |sum, p| sum + p.clone());
                assert!(is_narrow_around_zero(&(sum - Enclosure::integer(1))), "{interval}");
            }
        });
        // Each double is a few units in the last place from the truth, however many squarings there are.
        let doubles = transition_over(&on(RATES, |x| x), &interval);
        let exact = at(|| transition_over(&on(RATES, Enclosure::exact), &Enclosure::exact(interval)));
        for (double, exact) in doubles.iter().flatten().zip(exact.iter().flatten()) {
            let exact = exact.to_f64().unwrap();
            assert!(
                (double - exact).abs() <= 64.0 * f64::EPSILON * exact,
                "{interval}: {double} {exact}"
            );
        }
    }
}

/// What lies between the first bits left out and the truth is in the enclosure: few bits contain what many find.
#[test]
fn an_enclosure_of_few_bits_contains_that_of_many() {
    let of = |bits: u32, interval: f64| {
        Enclosure::with_precision(bits, || {
            transition_over(&on(RATES, Enclosure::exact), &Enclosure::exact(interval))
        })
    };
    for interval in [0.03, 0.5, 7.0] {
        let many = of(400, interval);
        for bits in [40, 64, 90] {
            for (few, many) in of(bits, interval).iter().flatten().zip(many.iter().flatten()) {
                let inside = Enclosure::with_precision(400, || few.clone() - many.clone());
                assert!(inside.contains(&Rational::integer(0)), "{bits}: {few:?} {many:?}");
            }
        }
    }
}

#[test]
fn a_mode_that_no_rate_leads_to_is_never_reached() {
    let rates = [[0.0, 0.0, 0.0], [0.5, -1.0, 0.5], [0.25, 0.0, -0.25]];
    at(|| {
        let chain = transition_over(&on(rates, Enclosure::exact), &Enclosure::exact(3.0));
        let zeros: Vec<bool> = chain.iter().flatten().map(num_traits::Zero::is_zero).collect();
        assert_eq!(zeros, [false, true, true, false, false, false, false, true, false]);
        // By way of the third, too: the first takes everything in the end.
        assert!(chain[1][0] > Enclosure::exact(0.6) && chain[1][2] > Enclosure::exact(0.2));
    });
}

#[test]
fn rates_that_are_no_numbers_leave_the_chain_undecided() {
    let chain = transition_over(&[vec![0.0, f64::NAN], vec![1.0, 0.0]], &1.0);
    assert!(chain.iter().flatten().all(|entry| !entry.is_decided()));
}

// Sojourns

/// The time in a mode that is left at the rate g has the mean ∫₀^∞ e^(−gt) dt = 1/g, and it is left for j in the part gⱼ/g of all cases.
#[test]
fn a_mean_sojourn_time_is_the_mean_of_the_time_to_leave() {
    let ratio = |numerator, denominator| Rational::new(numerator, denominator);
    let times = [ratio(7, 2), ratio(1, 3), ratio(5, 1)];
    let jumps: Chain<Rational> = vec![
        vec![ratio(0, 1), ratio(1, 4), ratio(3, 4)],
        vec![ratio(2, 5), ratio(0, 1), ratio(3, 5)],
        vec![ratio(1, 1), ratio(0, 1), ratio(0, 1)],
    ];
    let rates = rates_of_sojourns(&times, &jumps);
    for i in 0..3 {
        assert_eq!(-rates[i][i].clone(), Rational::integer(1) / times[i].clone());
        for j in (0..3).filter(|j| *j != i) {
            assert_eq!(rates[i][j].clone() / -rates[i][i].clone(), jumps[i][j]);
        }
    }
}

// Problems

fn certified(problem: &Value) -> Trace {
    certify(&ProblemFile::read(&problem.to_string()).unwrap())
        .unwrap()
        .trace
}

/// Three Kalman filters along steps of five lengths, with rates.
fn by_rates() -> Value {
    published("rates.changing-steps")
}

/// The same by sojourn times: of rates that doubles divide exactly.
fn by_sojourns() -> [Value; 2] {
    let (mut rates, mut sojourns) = (by_rates(), by_rates());
    rates["rates"] = json!([[-0.25, 0.125, 0.125], [0.375, -0.5, 0.125], [0.0, 1.0, -1.0]]);
    sojourns.as_object_mut().unwrap().remove("rates");
    sojourns["sojourn_times"] = json!([4.0, 2.0, 1.0]);
    sojourns["jumps"] = json!([[0, 0.5, 0.5], [0.75, 0, 0.25], [0, 1, 0]]);
    [rates, sojourns]
}

#[test]
fn rates_and_sojourn_times_of_one_chain_are_one_problem() {
    let [rates, sojourns] = by_sojourns();
    assert_eq!(certified(&rates), certified(&sojourns));
}

/// cⱼ = Σᵢ pᵢⱼ μᵢ with the chain of the step's own length, in every step; at length zero nothing moves.
#[test]
fn every_step_has_the_chain_of_its_length() {
    let problem = by_rates();
    let trace = certified(&problem);
    let rates: Chain<f64> = serde_json::from_value(problem["rates"].clone()).unwrap();
    let mut before: Vec<f64> = serde_json::from_value(problem["initial"]["mode_probabilities"].clone()).unwrap();
    for step in 1..=5 {
        let length = problem["measurements"][step - 1]["T"].as_f64().unwrap();
        let found = trace
            .get(step, Quantity::PredictedModeProbabilities, 0)
            .unwrap()
            .clone();
        let expected = at(|| {
            let rates: Chain<Enclosure> = rates
                .iter()
                .map(|row| row.iter().map(|g| Enclosure::exact(*g)).collect())
                .collect();
            let chain = transition_over(&rates, &Enclosure::exact(length));
            let part = |i: usize, j: usize| chain[i][j].clone() * Enclosure::exact(before[i]);
            let sum = |j| (0..3).fold(Enclosure::integer(0), |sum, i| sum + part(i, j));
            (0..3).map(|j| sum(j).to_f64().unwrap()).collect::<Vec<f64>>()
        });
        for (found, expected) in found.iter().zip(&expected) {
            // The probabilities before were rounded once, each by half a unit.
            assert!(
                (found - expected).abs() <= 2.0 * f64::EPSILON * expected,
                "{step}: {found} {expected}"
            );
        }
        if length == 0.0 {
            assert_eq!(found, before);
        }
        before.clone_from(trace.get(step, Quantity::ModeProbabilities, 0).unwrap());
    }
}

#[test]
fn who_does_not_claim_rates_is_not_asked_for_them() {
    for problem in by_sojourns() {
        let read = ProblemFile::read(&problem.to_string()).unwrap();
        assert_eq!(read.kinds(), ["kalman", "continuous-chain"]);
    }
}

#[test]
fn a_chain_that_is_none_is_refused_in_a_sentence() {
    let [rates, sojourns] = by_sojourns();
    let changed = |problem: &Value, pointer: &str, value: Value| {
        let mut problem = problem.clone();
        *problem.pointer_mut(pointer).unwrap() = value;
        refusal(&problem)
    };
    for (found, expected) in [
        (
            changed(&rates, "/rates/1", json!([0.375, -0.5, 0.25])),
            "problem.rates[1]: sums to 0.125; it must sum to 0: its diagonal is minus the rate at which the mode is left (Kolmogorov 1931)",
        ),
        (
            changed(&rates, "/rates/0", json!([0.0, -0.125, 0.125])),
            "problem.rates[0][1]: is -0.125; it must not be negative",
        ),
        (
            changed(&rates, "/rates", json!([[0.0]])),
            "problem.rates: has 1 entries where 3 are needed",
        ),
        (
            changed(&rates, "/measurements/2", json!({ "step": 3, "z": null })),
            "problem.measurements[2].T: is missing: problem.rates needs the length of every step",
        ),
        (
            changed(&rates, "/format", json!("immaculate-problem/1")),
            "problem.rates: needs the format \"immaculate-problem/2\", and this file says \"immaculate-problem/1\"",
        ),
        (
            changed(&sojourns, "/sojourn_times/1", json!(0)),
            "problem.sojourn_times[1]: is 0; a mode lasts for some time, longer than 0 (Doob 1953)",
        ),
        (
            changed(&sojourns, "/jumps/0", json!([0, 0.5, 0.25])),
            "problem.jumps[0]: sums to 0.75; it must sum to 1 (Doob 1953)",
        ),
        (
            changed(&sojourns, "/jumps/2", json!([0, 0.5, 0.5])),
            "problem.jumps[2][2]: is 0.5; a mode that is left is left for another, so it must be 0",
        ),
    ] {
        assert_eq!(found, expected);
    }
    let mut twice = rates.clone();
    twice["transition"] = json!([[1, 0, 0], [0, 1, 0], [0, 0, 1]]);
    assert_eq!(
        refusal(&twice),
        "problem: has more than one of `transition`, `rates` and `sojourn_times`; a chain is said once"
    );
    let without = |problem: &Value, key: &str| {
        let mut problem = problem.clone();
        problem.as_object_mut().unwrap().remove(key);
        refusal(&problem)
    };
    assert_eq!(without(&rates, "rates"), "problem.transition: is missing");
    assert_eq!(
        without(&sojourns, "jumps"),
        "problem.jumps: is missing, which says where a mode goes that is left after its `sojourn_times`"
    );
    assert_eq!(
        without(&sojourns, "sojourn_times"),
        "problem.sojourn_times: is missing, which says when a mode is left for its `jumps`"
    );
}
