//! Goal: a mistake that is in no catalogue is found as the formula that was computed, and no right formula is another than the equation.
//!
//! Method: the right formulas, as trees, are evaluated on every published case and held against the equations. Mistakes that people made in
//! programs of their own are planted by exchanging an entry of the table of equations, and the formula that is found is asked for.
#![allow(clippy::unwrap_used, reason = "in tests a panic is the failure")]

use immaculate::imm::Quantity;
use immaculate::number::{Field, RandomRounding as Number};
use immaculate::oracle::case::{self, Expected};
use immaculate::oracle::check::{Report, Selection, check};
use immaculate::oracle::diagnose::Diagnosis;
use immaculate::oracle::formula::{ComputedFormulas, unlike_the_equations};
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::setup::Setup;
use immaculate::oracle::subject::{Answer, Broken, Level, Planted, Ready, Subject};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// This crate's filter with an edit in its problem or in its equations.
struct Edited {
    edit: fn(&mut Setup<Number>),
}

impl Subject for Edited {
    fn start(&mut self) -> Result<Ready, Broken> {
        Planted {
            variants: vec![],
            level: Level::Everything,
        }
        .start()
    }

    fn run(&mut self, problem: &ProblemFile) -> Answer {
        let mut setup = problem.setup_in_doubles().unwrap();
        (self.edit)(&mut setup);
        let computed = setup.run();
        let error = computed.failures.first().map(ToString::to_string);
        Answer::Steps {
            trace: computed.in_doubles(),
            error,
        }
    }
}

/// Short cases in which nothing is zero or one that need not be.
const CASES: [&str; 3] = ["step.n4-m2.three-modes", "steps.kalman", "missed.one"];

fn verdict(edit: fn(&mut Setup<Number>), cases: &[&str]) -> Report {
    let ids = cases.iter().map(|id| (*id).to_owned()).collect();
    check(
        &mut Edited { edit },
        &Selection {
            ids,
            ..Selection::default()
        },
        &|_| {},
    )
    .unwrap()
}

/// The formulas that are found, each as a line.
fn computed(edit: fn(&mut Setup<Number>), cases: &[&str]) -> Vec<String> {
    match verdict(edit, cases).diagnosis {
        Diagnosis::InParts {
            formulas: ComputedFormulas { found, .. },
            ..
        } => found
            .into_iter()
            .map(|one| {
                let condition = one
                    .condition
                    .map_or_else(String::new, |condition| format!(" ({condition})"));
                assert_eq!(one.explains, one.of, "{}", one.computed);
                format!("{} = {}{condition}", one.quantity.name(), one.computed)
            })
            .collect(),
        diagnosis => panic!("{diagnosis:?}"),
    }
}

fn number(value: f64) -> Number {
    Number::exact(value)
}

#[test]
fn every_right_formula_is_the_equation_on_every_published_case() {
    let unlike = |case: &case::Case| match case.expected {
        Expected::Rejection(_) => Vec::new(),
        Expected::Trace(_) => {
            let found = unlike_the_equations(&case.problem).unwrap();
            found
                .into_iter()
                .map(|((step, quantity, mode), formula)| {
                    format!(
                        "{}, step {step}, mode {mode}: {} is not {formula}",
                        case.problem.id,
                        quantity.name()
                    )
                })
                .collect()
        }
    };
    let found: Vec<String> = case::all().unwrap().par_iter().flat_map(unlike).collect();
    assert!(found.is_empty(), "{} are unlike:\n{}", found.len(), found.join("\n"));
}

#[test]
fn an_inverse_that_was_forgotten_is_named() {
    let found = computed(
        |setup| setup.equations.gain = |_, _, now, j| Ok(now.cross_covariances[j].clone()),
        &CASES,
    );
    assert_eq!(found, ["gain = cross_covariance"]);
}

/// Such gains make covariances that lose their symmetry and run away: what comes of a mistake does not hide it.
#[test]
fn a_mistake_is_named_though_rounding_grows_because_of_it() {
    let wrong = |setup: &mut Setup<Number>| setup.equations.gain = |_, _, now, j| Ok(now.cross_covariances[j].clone());
    let cases = ["steps.kalman", "missed.one"];
    assert_eq!(computed(wrong, &cases), ["gain = cross_covariance"]);
    assert_eq!(verdict(wrong, &cases).observations, []);
}

#[test]
fn a_product_entry_by_entry_is_named() {
    let found = computed(
        |setup| {
            setup.equations.gain = |_, _, now, j| {
                let (c, s) = (&now.cross_covariances[j], &now.innovation_covariances[j]);
                if c.shape() != s.shape() {
                    return Ok(c.clone());
                }
                let determinant = s[(0, 0)] * s[(1, 1)] - s[(0, 1)] * s[(1, 0)];
                let inverse = DMatrix::from_row_slice(2, 2, &[s[(1, 1)], -s[(0, 1)], -s[(1, 0)], s[(0, 0)]]);
                Ok(c.component_mul(&inverse).map(|entry| entry / determinant))
            };
        },
        &["likelihood.equal-distance.plane"],
    );
    assert_eq!(found, ["gain = cross_covariance ∘ innovation_covariance⁻¹"]);
}

#[test]
fn a_number_added_to_the_diagonal_is_named_with_its_size() {
    let found = computed(
        |setup| {
            setup.equations.updated_covariance = |_, _, now, j| {
                let (p, k, s) = (
                    &now.predicted[j].covariance,
                    &now.gains[j],
                    &now.innovation_covariances[j],
                );
                p - k * s * k.transpose() + DMatrix::identity(p.nrows(), p.nrows()) * number(1e-6)
            };
        },
        &CASES,
    );
    assert_eq!(
        found,
        ["updated.covariance = predicted.covariance − gain · innovation_covariance · gainᵀ + 1e-6·I"]
    );
}

#[test]
fn an_operand_taken_for_another_is_named() {
    let found = computed(
        |setup| {
            setup.equations.updated_covariance = |_, previous, now, j| {
                let (p, k, c) = (
                    &previous.updated[j].covariance,
                    &now.gains[j],
                    &now.cross_covariances[j],
                );
                p - k * c.transpose()
            };
        },
        &CASES,
    );
    assert_eq!(
        found,
        ["updated.covariance = previous updated.covariance − gain · innovation_covariance · gainᵀ"]
    );
}

#[test]
fn a_noise_that_was_scaled_is_named_with_its_factor() {
    let scale = |setup: &mut Setup<Number>| {
        for mode in &mut setup.problem.modes {
            mode.noise *= number(0.1);
        }
    };
    assert_eq!(
        computed(scale, &CASES),
        ["predicted.covariance = F · mixed.covariance · Fᵀ + 0.1 · Q"]
    );
}

#[test]
fn a_noise_that_is_another_is_solved_for() {
    let found = computed(
        |setup| {
            for mode in &mut setup.problem.modes {
                let entry = |i: usize, k: usize| [[3, 0, 0, 1], [0, 4, 1, 0], [0, 1, 5, 0], [1, 0, 0, 6]][i][k];
                mode.noise = DMatrix::from_fn(4, 4, |i, k| Number::ratio(entry(i, k), 10));
            }
        },
        &["steps.one-mode.kalman"],
    );
    assert_eq!(
        found,
        [
            "predicted.covariance = F · mixed.covariance · Fᵀ + Q, where Q = [0.3 0 0 0.1; 0 0.4 0.1 0; 0 0.1 0.5 0; 0.1 0 0 0.6]"
        ]
    );
}

#[test]
fn two_noises_that_were_exchanged_are_named() {
    let found = computed(
        |setup| {
            let noise = setup.problem.measurement_noise.clone();
            setup.problem.measurement_noise = setup.problem.modes[0].noise.clone();
            for mode in &mut setup.problem.modes {
                mode.noise.clone_from(&noise);
            }
        },
        &["likelihood.equal-distance.plane"],
    );
    assert_eq!(found[0], "predicted.covariance = F · mixed.covariance · Fᵀ + R");
    assert!(
        found[1].starts_with("innovation_covariance = H · predicted.covariance · Hᵀ + Q"),
        "{}",
        found[1]
    );
}

#[test]
fn a_covariance_that_all_modes_share_is_named() {
    let found = computed(
        |setup| {
            setup.equations.predicted_mean = |problem, _, now, _| problem.modes[0].motion.of(&now.mixed[0].mean);
        },
        &["step.n4-m2.three-modes"],
    );
    assert_eq!(found, ["predicted.mean = predicted.mean[mode 0]"]);
}

#[test]
fn a_gate_is_named_with_where_it_shuts() {
    let found = computed(
        |setup| {
            setup.equations.updated_mean = |_, _, now, j| {
                let (s, v) = (&now.innovation_covariances[j], &now.innovations[j]);
                let is_near = v
                    .iter()
                    .zip(s.diagonal().iter())
                    .all(|(v, s)| v.value().abs() < 10.0 * s.value().sqrt());
                let mean = &now.predicted[j].mean;
                if is_near {
                    mean + &now.gains[j] * v
                } else {
                    mean.clone()
                }
            };
        },
        &["outlier.linear"],
    );
    assert_eq!(found.len(), 1);
    assert!(
        found[0].starts_with("updated.mean = predicted.mean (at step 2 only; where νᵀS⁻¹ν is "),
        "{}",
        found[0]
    );
}

#[test]
fn a_step_that_was_made_twice_is_named() {
    let found = computed(
        |setup| {
            setup.equations.predicted_covariance = |problem, _, now, j| {
                let (f, q) = (problem.modes[j].motion.matrix(), &problem.modes[j].noise);
                let once = f.as_ref() * &now.mixed[j].covariance * f.transpose() + q;
                f.as_ref() * once * f.transpose() + q
            };
        },
        &CASES,
    );
    assert_eq!(
        found,
        ["predicted.covariance = F · (F · mixed.covariance · Fᵀ + Q) · Fᵀ + Q"]
    );
}

#[test]
fn numbers_of_the_problem_cut_to_integers_are_named() {
    let found = computed(
        |setup| {
            for estimate in &mut setup.initial.modes {
                estimate.mean = DVector::from_iterator(
                    estimate.mean.len(),
                    estimate.mean.iter().map(|entry| number(entry.value().trunc())),
                );
            }
        },
        &["steps.kalman"],
    );
    assert_eq!(
        found[0],
        "mixed.mean = Σᵢ mixing_probabilities·(whole part of previous updated.mean[i]) (at step 1 only)"
    );
}

#[test]
fn a_parameter_of_the_unscented_rule_is_named_in_the_definition() {
    let found = computed(
        |setup| {
            // β left out of the first weight of covariances.
            for filter in &mut setup.problem.filters {
                for rule in filter.rules_mut().into_iter().flatten() {
                    rule.covariance_weights[0] -= Number::integer(2);
                }
            }
        },
        &["rule.unscented-scaled"],
    );
    let definition = "where w₀ of covariances = w₀ + 1 − α²";
    assert!(found.iter().all(|line| line.ends_with(definition)), "{found:#?}");
    assert!(!found.is_empty());
}

#[test]
fn a_term_that_is_missing_is_named_in_the_numbers_of_the_fault() {
    let report = verdict(
        |setup| {
            setup.equations.predicted_covariance = |problem, _, now, j| {
                let f = problem.modes[j].motion.matrix();
                f.as_ref() * &now.mixed[j].covariance * f.transpose()
            }
        },
        &["step.n4-m2.three-modes"],
    );
    let (_, judged) = report.faults().next().unwrap();
    assert_eq!(judged.place.1, Quantity::PredictedCovariance);
    let explained = judged.explained.as_ref().unwrap();
    assert_eq!(explained.equation, "F · mixed.covariance · Fᵀ + Q");
    assert_eq!(explained.term.as_deref(), Some("Q is left out"));
    assert!((explained.gives - judged.own.unwrap().expected).abs() <= 1e-12 * explained.gives.abs());
}
