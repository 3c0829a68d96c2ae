//! A program that has the specification and nothing else: a step of a Kalman filter, by hand on the front page of the documentation.

use immaculate::filter::Filter;
use immaculate::gaussian::Gaussian;
use immaculate::imm::{Imm, Initial, Interaction, Problem};
use immaculate::model::Sensor;
use immaculate::model::motion::{Mode, Motion};
use nalgebra::{matrix, vector};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mode = Mode {
        name: "still".into(),
        motion: Motion::Linear(matrix![1.0]),
        noise: matrix![1.0],
    };
    let problem = Problem {
        modes: vec![mode],
        filters: vec![Filter::kalman()],
        interaction: Interaction::Imm,
        angles: vec![],
        chain: vec![vec![1.0]],
        sensor: Sensor::Linear(matrix![1.0]),
        measurement_noise: matrix![1.0],
    };
    let start = Gaussian {
        mean: vector![0.0],
        covariance: matrix![1.0],
    };
    let initial = Initial {
        modes: vec![start],
        mode_probabilities: vec![1.0],
    };
    let mut filter = Imm::new(problem, &initial)?;
    let step = filter.step(Some(&vector![3.0]))?;
    // The prediction has the variance 2, the innovation 3: two thirds of the way to the measurement.
    assert_eq!(step.gains[0], matrix![2.0 / 3.0]);
    assert_eq!(step.combined.mean, vector![2.0]);
    println!("one step: {}", step.combined.mean[0]);
    Ok(())
}
