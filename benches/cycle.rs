//! One step of a three-mode interacting multiple model filter, n = 4, m = 2, with each filter.
//!
//! `cargo bench` prints the time of one step. Modes are constant velocity and two turns; the measurements are those of a target on
//! a straight line, so that no step is special. One step is one call of [`Imm::step`] and nothing else.

use divan::{Bencher, black_box};
use immaculate::filter::Filter;
use immaculate::gaussian::Gaussian;
use immaculate::imm::{Imm, Initial, Interaction, Problem};
use immaculate::model::motion::{Mode, Motion, constant_velocity, coordinated_turn, integrated_noise};
use immaculate::model::{Conversion, PolarComponent, Sensor};
use immaculate::rule::RuleName;
use nalgebra::{SMatrix, SVector, U2, U4, matrix, vector};

fn main() {
    divan::main();
}

/// The three-mode problem with a measurement and a rule.
fn filter(sensor: Sensor<f64, U4, U2>, noise: [f64; 2], kind: Filter<f64, U4, U2>) -> Imm<f64, U4, U2> {
    let turn = 3.0_f64.to_radians();
    let mode = |name: &str, transition| Mode {
        name: name.to_owned(),
        motion: Motion::Linear(transition),
        noise: integrated_noise(&1.0, &1.0),
    };
    let problem = Problem {
        modes: vec![
            mode("constant velocity", constant_velocity(&1.0)),
            mode("left turn", coordinated_turn(&turn, &1.0)),
            mode("right turn", coordinated_turn(&-turn, &1.0)),
        ],
        chain: vec![
            vec![0.95, 0.025, 0.025],
            vec![0.025, 0.95, 0.025],
            vec![0.025, 0.025, 0.95],
        ],
        sensor,
        measurement_noise: SMatrix::from_diagonal(&SVector::from(noise)),
        filters: vec![kind],
        interaction: Interaction::Imm,
        angles: vec![],
    };
    let estimate = Gaussian {
        mean: vector![15000.0, -180.0, 1000.0, 200.0],
        covariance: SMatrix::from_diagonal(&vector![1e4, 1e2, 1e4, 1e2]),
    };
    let initial = Initial {
        modes: vec![estimate; 3],
        mode_probabilities: vec![0.8, 0.1, 0.1],
    };
    Imm::new(problem, &initial).unwrap()
}

/// The filter with the points of a rule.
fn points(rule: &str) -> Filter<f64, U4, U2> {
    Filter::points(rule.parse::<RuleName>().unwrap().rule().unwrap())
}

/// Range and bearing from the origin.
fn range_bearing() -> Sensor<f64, U4, U2> {
    Sensor::Polar {
        components: vec![PolarComponent::Range, PolarComponent::Bearing],
        position: [0, 2],
        location: [0.0, 0.0],
    }
}

/// Steps along measurements of a straight line.
fn run(bencher: Bencher, mut filter: Imm<f64, U4, U2>, measure: fn(f64, f64) -> SVector<f64, 2>) {
    let (mut x, mut y) = (15000.0, 1000.0);
    bencher.bench_local(|| {
        x -= 180.0;
        y += 200.0;
        let z = measure(x, y);
        black_box(
            filter
                .step(black_box(Some(&z)))
                .expect("no step of this track fails")
                .step,
        )
    });
}

#[divan::bench(sample_size = 200, sample_count = 1000)]
fn linear_kalman(bencher: Bencher) {
    let h = matrix![1.0, 0.0, 0.0, 0.0; 0.0, 0.0, 1.0, 0.0];
    let filter = filter(Sensor::Linear(h), [1600.0, 1600.0], Filter::kalman());
    run(bencher, filter, |x, y| vector![x, y]);
}

#[divan::bench(sample_size = 200, sample_count = 200, args = ["cubature-3", "unscented", "simplex-5", "cubature-5"])]
fn linear_cubature(bencher: Bencher, rule: &str) {
    let h = matrix![1.0, 0.0, 0.0, 0.0; 0.0, 0.0, 1.0, 0.0];
    let filter = filter(Sensor::Linear(h), [1600.0, 1600.0], points(rule));
    run(bencher, filter, |x, y| vector![x, y]);
}

#[divan::bench(sample_size = 200, sample_count = 200, args = ["cubature-3", "unscented", "simplex-5", "cubature-5", "gauss-hermite-3"])]
fn range_bearing_cubature(bencher: Bencher, rule: &str) {
    let filter = filter(range_bearing(), [1600.0, 49e-6], points(rule));
    run(bencher, filter, |x, y| vector![x.hypot(y), y.atan2(x)]);
}

#[divan::bench(sample_size = 200, sample_count = 1000)]
fn range_bearing_converted(bencher: Bencher) {
    let filter = filter(
        range_bearing(),
        [1600.0, 49e-6],
        Filter::converted(Conversion::Standard),
    );
    run(bencher, filter, |x, y| vector![x.hypot(y), y.atan2(x)]);
}
