//! Other filters in Rust: plain nalgebra, typed-kalman, numeris, oxictl.

use crate::contender::{Outcome, Run, Task};
use crate::cycle::{Estimate, around, log_density};
use crate::ours::rule;
use crate::scenario::{CHAIN, MODES, PROBABILITIES, Sensor, h, process_noise, start, transitions};
use nalgebra::{Matrix2, Matrix4, Matrix4x2, Vector2, Vector4};
use std::array::from_fn;
use std::f64::consts::{PI, TAU};
use std::hint::black_box;
use std::time::Instant;

/// The Kalman filter in plain nalgebra: what the arithmetic alone costs.
pub fn plain_nalgebra() -> Run {
    let (transitions, q, h, r) = (transitions(), process_noise(), h(), Sensor::Position.noise());
    around(move |j, (mean, covariance), z| {
        let f = &transitions[j];
        let (mean, covariance) = (f * mean, f * covariance * f.transpose() + q);
        let cross = covariance * h.transpose();
        let s = h * cross + r;
        let innovation = z - h * mean;
        // S = L D Lᵀ by hand
        let lower = s[(1, 0)] / s[(0, 0)];
        let (first, second) = (s[(0, 0)], s[(1, 1)] - lower * lower * s[(0, 0)]);
        let gain_1 = (cross.column(1) - cross.column(0) * lower) / second;
        let gain_0 = cross.column(0) / first - gain_1 * lower;
        let gain = Matrix4x2::from_columns(&[gain_0, gain_1]);
        let mut updated = covariance - gain * cross.transpose();
        updated.fill_upper_triangle_with_lower_triangle();
        let rest = innovation[1] - lower * innovation[0];
        let squared_distance = innovation[0] * innovation[0] / first + rest * rest / second;
        let log_likelihood = -0.5 * (squared_distance + (TAU * TAU * first * second).ln());
        ((mean, covariance), (mean + gain * innovation, updated), log_likelihood)
    })
}

/// typed-kalman's linear filter. It does not show S, which is computed again.
pub fn typed_kalman_linear() -> Run {
    let (transitions, q, h, r) = (transitions(), process_noise(), h(), Sensor::Position.noise());
    around(move |j, (mean, covariance), z| {
        let mut filter = typed_kalman::LinearKf::<4>::new(*mean, *covariance);
        filter.predict(&transitions[j], &q);
        let prediction = (*filter.state(), *filter.covariance());
        let s = h * prediction.1 * h.transpose() + r;
        let squared_distance = filter.update(&h, z, &r).expect("S is definite");
        (
            prediction,
            (*filter.state(), *filter.covariance()),
            log_density(squared_distance, &s),
        )
    })
}

struct Linear(Matrix4<f64>);

impl typed_kalman::ProcessModel<4> for Linear {
    fn predict(&self, state: &Vector4<f64>, _: f64) -> Vector4<f64> {
        self.0 * state
    }
}

struct RangeBearing;

impl typed_kalman::MeasurementModel<4, 2> for RangeBearing {
    fn measure(&self, state: &Vector4<f64>) -> Vector2<f64> {
        Sensor::RangeBearing.of(state)
    }

    fn residual(&self, a: &Vector2<f64>, b: &Vector2<f64>) -> Vector2<f64> {
        Vector2::new(a[0] - b[0], wrapped(a[1] - b[1]))
    }
}

fn wrapped(angle: f64) -> f64 {
    if angle > PI {
        angle - TAU
    } else if angle <= -PI {
        angle + TAU
    } else {
        angle
    }
}

/// typed-kalman's unscented filter. It does not show S, which is computed again.
pub fn typed_kalman_unscented() -> Run {
    let modes = transitions().map(Linear);
    let (q, r, s) = (
        process_noise(),
        Sensor::RangeBearing.noise(),
        innovation_covariance(Task::Unscented),
    );
    around(move |j, (mean, covariance), z| {
        let parameters = typed_kalman::UkfParams {
            alpha: 1.0,
            beta: 0.0,
            kappa: 1.0,
        };
        let mut filter = typed_kalman::Ukf::<4>::with_params(*mean, *covariance, parameters).expect("κ is right");
        filter.predict(&modes[j], &q, 1.0).expect("the covariance is definite");
        let prediction = (*filter.state(), *filter.covariance());
        let s = s(&prediction);
        let squared_distance = filter.update(&RangeBearing, z, &r).expect("S is definite");
        (
            prediction,
            (*filter.state(), *filter.covariance()),
            log_density(squared_distance, &s),
        )
    })
}

/// S of a filter that does not show it, by points of its own.
fn innovation_covariance(task: Task) -> impl Fn(&Estimate) -> Matrix2<f64> {
    let rule = rule(task).expect("the task has points");
    move |(mean, covariance)| {
        let root = covariance.cholesky().expect("the covariance is definite").unpack();
        let values: Vec<_> = rule
            .points
            .iter()
            .map(|point| Sensor::RangeBearing.of(&(root * point + mean)))
            .collect();
        let centre: Vector2<f64> = values
            .iter()
            .zip(&rule.weights)
            .map(|(value, weight)| value * *weight)
            .sum();
        let mut s = Sensor::RangeBearing.noise();
        for (value, weight) in values.iter().zip(&rule.covariance_weights) {
            s += (value - centre) * (value - centre).transpose() * *weight;
        }
        s
    }
}

/// numeris' cubature or unscented filter. It does not show S, which is computed again.
pub fn numeris(task: Task) -> Run {
    use numeris::estimate::{Ckf, Ukf};
    use numeris::{Matrix, Vector};
    let rows = |matrix: &Matrix4<f64>| -> [[f64; 4]; 4] { from_fn(|i| from_fn(|j| matrix[(i, j)])) };
    let transitions = transitions().map(|f| rows(&f));
    let q = Matrix::new(rows(&process_noise()));
    let noise = Sensor::RangeBearing.noise();
    let r = Matrix::new([[noise[(0, 0)], 0.0], [0.0, noise[(1, 1)]]]);
    let s = innovation_covariance(task);
    let measure =
        |x: &Vector<f64, 4>| Vector::from_array(Sensor::RangeBearing.of(&Vector4::from_fn(|i, _| x[i])).into());
    let estimate = |x: &Vector<f64, 4>, p: &Matrix<f64, 4, 4>| -> Estimate {
        (Vector4::from_fn(|i, _| x[i]), Matrix4::from_fn(|i, j| p[(i, j)]))
    };
    around(move |j, (mean, covariance), z| {
        let (mean, covariance) = (Vector::from_array((*mean).into()), Matrix::new(rows(covariance)));
        let (f, z) = (&transitions[j], Vector::from_array([z[0], z[1]]));
        let motion = |x: &Vector<f64, 4>| Vector::from_array(from_fn(|i| (0..4).map(|l| f[i][l] * x[l]).sum()));
        // the two types have the same methods and no common trait
        macro_rules! step {
            ($filter:expr) => {{
                let mut filter = $filter;
                filter
                    .predict(motion, Some(&q))
                    .expect("the covariance is definite");
                let prediction = estimate(&filter.x, &filter.p);
                let s = s(&prediction);
                let squared_distance = filter.update(&z, measure, &r).expect("S is definite");
                (
                    prediction,
                    estimate(&filter.x, &filter.p),
                    log_density(squared_distance, &s),
                )
            }};
        }
        match task {
            Task::Unscented => step!(Ukf::<f64, 4, 2>::with_params(mean, covariance, 1.0, 0.0, 1.0)),
            _ => step!(Ckf::<f64, 4, 2>::new(mean, covariance)),
        }
    })
}

/// oxictl's interacting multiple model filter, which has a cycle of its own.
pub fn oxictl() -> Run {
    use oxictl::core::matrix::Matrix;
    use oxictl::estimator::imm::{ImmEstimator, ImmModel};
    let square = |matrix: &Matrix4<f64>| Matrix {
        data: from_fn(|i| from_fn(|j| matrix[(i, j)])),
    };
    Box::new(move |measurements| {
        let (mean, covariance) = start();
        let transitions = transitions();
        let models: [_; MODES] = from_fn(|j| ImmModel::<f64, 4, 2> {
            a: square(&transitions[j]),
            x_hat: Matrix {
                data: from_fn(|i| [mean[i]]),
            },
            p: square(&covariance),
            q: square(&process_noise()),
            likelihood: 1.0,
        });
        let h = Matrix {
            data: from_fn(|i| from_fn(|j| h()[(i, j)])),
        };
        let r = Matrix {
            data: from_fn(|i| from_fn(|j| Sensor::Position.noise()[(i, j)])),
        };
        let mut filter = ImmEstimator::new(models, CHAIN, h, r);
        filter.mu = PROBABILITIES;
        let measurements: Vec<_> = measurements.iter().map(|z| Matrix { data: [[z[0]], [z[1]]] }).collect();
        let mut combined = filter.fused_estimate();
        let begin = Instant::now();
        for z in &measurements {
            filter.mix_estimates();
            filter.update_all(black_box(z));
            filter.update_probabilities();
            combined = black_box(filter.fused_estimate());
        }
        let seconds = begin.elapsed().as_secs_f64();
        let mean = Vector4::from_fn(|i, _| combined.data[i][0]);
        (
            seconds,
            Outcome {
                mode_probabilities: filter.mu,
                mean,
            },
        )
    })
}
