//! This crate: with the record of every value, and without.

use crate::contender::{Outcome, Run, Task};
use crate::scenario::{self, CHAIN, MODES, PROBABILITIES, h, process_noise, start, transitions};
use immaculate::filter::Filter;
use immaculate::gaussian::Gaussian;
use immaculate::imm::{Imm, Initial, Interaction, PlainImm, Problem};
use immaculate::model::motion::{Mode, Motion};
use immaculate::model::{PolarComponent, Sensor};
use immaculate::number::Rational;
use immaculate::rule::{Rule, RuleName, unscented::Parameters};
use nalgebra::{U2, U4};
use std::array::from_fn;
use std::hint::black_box;
use std::time::Instant;

/// The rule of a task; none for the Kalman filter.
pub fn rule(task: Task) -> Option<Rule<f64, U4>> {
    let name = match task {
        Task::Kalman => return None,
        Task::Cubature3 => RuleName::ThirdDegree,
        Task::Unscented => RuleName::Unscented(Some(Parameters::of_kappa(Rational::new(1, 1)))),
        Task::Cubature5 => RuleName::FifthDegree,
    };
    Some(name.rule().expect("the rule exists for four components"))
}

/// The problem and its start.
fn problem(task: Task) -> (Problem<f64, U4, U2>, Initial<f64, U4>) {
    let names = ["constant velocity", "left turn", "right turn"];
    let modes = transitions().into_iter().zip(names).map(|(transition, name)| Mode {
        name: name.to_owned(),
        motion: Motion::Linear(transition),
        noise: process_noise(),
    });
    let problem = Problem {
        modes: modes.collect(),
        chain: CHAIN.map(|row| row.to_vec()).to_vec(),
        sensor: match task.sensor() {
            scenario::Sensor::Position => Sensor::Linear(h()),
            scenario::Sensor::RangeBearing => Sensor::Polar {
                components: vec![PolarComponent::Range, PolarComponent::Bearing],
                position: [0, 2],
                location: [0.0, 0.0],
            },
        },
        measurement_noise: task.sensor().noise(),
        filters: vec![rule(task).map_or_else(Filter::kalman, Filter::points)],
        interaction: Interaction::Imm,
        angles: vec![],
    };
    let (mean, covariance) = start();
    let initial = Initial {
        modes: vec![Gaussian { mean, covariance }; MODES],
        mode_probabilities: PROBABILITIES.to_vec(),
    };
    (problem, initial)
}

/// [`Imm`], which fills a record of every value.
pub fn recorded(task: Task) -> Run {
    let (problem, initial) = problem(task);
    let fresh = Imm::new(problem, &initial).expect("the problem is right");
    Box::new(move |measurements| {
        let mut filter = fresh.clone();
        let begin = Instant::now();
        for z in measurements {
            black_box(filter.step(black_box(Some(z))).expect("no step of this run fails").step);
        }
        let seconds = begin.elapsed().as_secs_f64();
        let last = filter.current();
        let mode_probabilities = from_fn(|j| last.mode_probabilities[j]);
        (
            seconds,
            Outcome {
                mode_probabilities,
                mean: last.combined.mean,
            },
        )
    })
}

/// [`PlainImm`], which keeps the estimates alone.
pub fn plain(task: Task) -> Run {
    let (problem, initial) = problem(task);
    let fresh = PlainImm::<f64, U4, U2, MODES>::new(problem, &initial).expect("the problem is right");
    Box::new(move |measurements| {
        let mut filter = fresh.clone();
        let begin = Instant::now();
        for z in measurements {
            black_box(filter.step(black_box(Some(z))).expect("no step of this run fails"));
        }
        let seconds = begin.elapsed().as_secs_f64();
        let (mode_probabilities, mean) = (*filter.mode_probabilities(), filter.combined().mean);
        (
            seconds,
            Outcome {
                mode_probabilities,
                mean,
            },
        )
    })
}
