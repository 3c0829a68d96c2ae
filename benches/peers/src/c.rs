//! The program in C, `c/imm.c`. This file is the only one with `unsafe`: it calls a function of another language.

use crate::contender::{Outcome, Run, Task};
use crate::ours::rule;
use crate::scenario::{CHAIN, MODES, PROBABILITIES, h, process_noise, start, transitions};
use nalgebra::{Matrix4, Vector4};
use std::array::from_fn;
use std::ffi::c_int;
use std::hint::black_box;
use std::time::Instant;

/// `MOST_POINTS` of `c/imm.c`.
const MOST_POINTS: usize = 33;

#[repr(C)]
#[derive(Clone, Copy)]
struct Gaussian {
    x: [f64; 4],
    p: [[f64; 4]; 4],
}

#[repr(C)]
struct Model {
    f: [[[f64; 4]; 4]; MODES],
    q: [[f64; 4]; 4],
    h: [[f64; 4]; 2],
    r: [[f64; 2]; 2],
    chain: [[f64; MODES]; MODES],
    points: c_int,
    point: [[f64; 4]; MOST_POINTS],
    weight: [f64; MOST_POINTS],
    covariance_weight: [f64; MOST_POINTS],
}

#[repr(C)]
struct State {
    mode: [Gaussian; MODES],
    combined: Gaussian,
    prediction: Gaussian,
    probability: [f64; MODES],
}

unsafe extern "C" {
    fn imm_step(model: *const Model, state: *mut State, z: *const f64);
}

fn rows(matrix: &Matrix4<f64>) -> [[f64; 4]; 4] {
    from_fn(|i| from_fn(|j| matrix[(i, j)]))
}

fn model(task: Task) -> Model {
    let (h, r) = (h(), task.sensor().noise());
    let rule = rule(task);
    let points = rule.as_ref().map_or(0, |rule| rule.points.len());
    let of_point = |s: usize| rule.as_ref().filter(|_| s < points);
    Model {
        f: transitions().map(|f| rows(&f)),
        q: rows(&process_noise()),
        h: from_fn(|i| from_fn(|j| h[(i, j)])),
        r: from_fn(|i| from_fn(|j| r[(i, j)])),
        chain: CHAIN,
        points: c_int::try_from(points).expect("few points"),
        point: from_fn(|s| of_point(s).map_or([0.0; 4], |rule| rule.points[s].into())),
        weight: from_fn(|s| of_point(s).map_or(0.0, |rule| rule.weights[s])),
        covariance_weight: from_fn(|s| of_point(s).map_or(0.0, |rule| rule.covariance_weights[s])),
    }
}

pub fn run(task: Task) -> Run {
    let model = model(task);
    Box::new(move |measurements| {
        let (mean, covariance) = start();
        let estimate = Gaussian {
            x: mean.into(),
            p: rows(&covariance),
        };
        let mut state = State {
            mode: [estimate; MODES],
            combined: estimate,
            prediction: estimate,
            probability: PROBABILITIES,
        };
        let begin = Instant::now();
        for z in measurements {
            // SAFETY: the types above are those of `c/imm.c`, which reads two doubles of z and keeps no pointer.
            unsafe { imm_step(&model, &mut state, black_box(z).as_ptr()) };
        }
        let seconds = begin.elapsed().as_secs_f64();
        (
            seconds,
            Outcome {
                mode_probabilities: state.probability,
                mean: Vector4::from(state.combined.x),
            },
        )
    })
}
