//! How the time of a step grows with the modes, the components of the state, and the points: this crate's plain cycle, linear, m = 2.

use immaculate::filter::Filter;
use immaculate::gaussian::Gaussian;
use immaculate::imm::{Initial, Interaction, PlainImm, Problem};
use immaculate::matrix::{Holds, Shapes};
use immaculate::model::Sensor;
use immaculate::model::motion::{Mode, Motion};
use immaculate::rule::RuleName;
use nalgebra::{DefaultAllocator, DimName, OMatrix, OVector, U2, U4, U8, U16, U32, allocator::Allocator, vector};
use std::hint::black_box;
use std::time::Instant;

/// Steps that are timed at once, and how often: the least time is what the machine can do.
const STEPS: usize = 200;
const TIMES: usize = 31;

/// Prints the tables.
pub fn tables() {
    println!("\nMicroseconds a step over the modes, n = 4");
    row("modes", &[1.0, 2.0, 4.0, 8.0, 16.0], |name| {
        vec![
            least::<U4, 1>(name),
            least::<U4, 2>(name),
            least::<U4, 4>(name),
            least::<U4, 8>(name),
            least::<U4, 16>(name),
        ]
    });
    println!("\nMicroseconds a step over the components of the state, three modes");
    row("components", &[4.0, 8.0, 16.0, 32.0], |name| {
        vec![
            least::<U4, 3>(name),
            least::<U8, 3>(name),
            least::<U16, 3>(name),
            least::<U32, 3>(name),
        ]
    });
}

/// One table: a line a filter, with the exponent that fits best.
fn row(what: &str, sizes: &[f64], times: impl Fn(&str) -> Vec<f64>) {
    print!("{what:<14}");
    sizes.iter().for_each(|size| print!("{size:>9}"));
    println!("   exponent, and at the last doubling");
    for name in ["kalman", "cubature-3", "cubature-5"] {
        let times = times(name);
        print!("{name:<14}");
        times.iter().for_each(|time| print!("{time:>9.2}"));
        println!(
            "   {:.1}, {:.1}",
            exponent(sizes, &times),
            exponent(&sizes[sizes.len() - 2..], &times[times.len() - 2..])
        );
    }
}

/// The slope of the straight line through the logarithms.
fn exponent(sizes: &[f64], times: &[f64]) -> f64 {
    let (x, y): (Vec<f64>, Vec<f64>) = sizes
        .iter()
        .zip(times)
        .map(|(size, time)| (size.ln(), time.ln()))
        .unzip();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (centre_x, centre_y) = (mean(&x), mean(&y));
    let products: f64 = x.iter().zip(&y).map(|(x, y)| (x - centre_x) * (y - centre_y)).sum();
    let squares: f64 = x.iter().map(|x| (x - centre_x) * (x - centre_x)).sum();
    products / squares
}

/// The least time of a step in microseconds: pairs of position and velocity, the first two positions measured, modes that differ in noise.
fn least<N: DimName, const MODES: usize>(name: &str) -> f64
where
    Shapes: Holds<N, U2>,
    DefaultAllocator: Allocator<N, N> + Allocator<N>,
{
    let n = N::DIM;
    let transition = OMatrix::<f64, N, N>::from_fn(|i, j| f64::from(i == j || i % 2 == 0 && j == i + 1));
    let modes = (0..MODES).map(|j| Mode {
        name: j.to_string(),
        motion: Motion::Linear(transition.clone()),
        noise: OMatrix::<f64, N, N>::identity() * (0.1 * (j + 1) as f64),
    });
    let away = 0.1 / (MODES.max(2) - 1) as f64;
    let stays = if MODES == 1 {
        1.0
    } else {
        1.0 - away * (MODES - 1) as f64
    };
    let problem = Problem {
        modes: modes.collect(),
        chain: (0..MODES)
            .map(|i| (0..MODES).map(|j| if i == j { stays } else { away }).collect())
            .collect(),
        sensor: Sensor::Linear(OMatrix::<f64, U2, N>::from_fn(|i, j| f64::from(j == 2 * i))),
        measurement_noise: OMatrix::<f64, U2, U2>::identity() * 4.0,
        filters: vec![match name {
            "kalman" => Filter::kalman(),
            rule => Filter::points(
                rule.parse::<RuleName>()
                    .expect("a rule")
                    .rule()
                    .expect("it exists for every n"),
            ),
        }],
        interaction: Interaction::Imm,
        angles: vec![],
    };
    let estimate = Gaussian {
        mean: OVector::<f64, N>::zeros(),
        covariance: OMatrix::<f64, N, N>::identity(),
    };
    let initial = Initial {
        modes: vec![estimate; MODES],
        mode_probabilities: vec![1.0 / MODES as f64; MODES],
    };
    let fresh =
        PlainImm::<f64, N, U2, MODES>::new(problem, &initial).unwrap_or_else(|error| panic!("n = {n}: {error}"));
    let times = (0..TIMES).map(|_| {
        let mut filter = fresh.clone();
        let begin = Instant::now();
        for k in 0..STEPS {
            let z = vector![(k as f64).sin(), (0.5 * k as f64).cos()];
            black_box(filter.step(black_box(Some(&z))).expect("no step of this run fails"));
        }
        begin.elapsed().as_secs_f64() / STEPS as f64 * 1e6
    });
    times.fold(f64::INFINITY, f64::min)
}
