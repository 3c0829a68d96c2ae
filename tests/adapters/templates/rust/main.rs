//! My filter under test, as `cargo build --release && immaculate check -- target/release/my_filter` judges it.
//!
//! `MyFilter` is a correct textbook interacting multiple model filter with Kalman filters. Replace it with your own: Immaculate sees only
//! the parts marked CHANGE HERE.

use nalgebra::{DMatrix, DVector};
use serde_json::{Value, json};
use std::io::Write;

type Matrix = DMatrix<f64>;
type Vector = DVector<f64>;

const NAME: &str = "my filter"; // CHANGE HERE
const KINDS: [&str; 1] = ["kalman"]; // CHANGE HERE: which filters it has; `immaculate cases list` names them

#[derive(Clone)]
struct Estimate {
    mean: Vector,
    covariance: Matrix,
}

/// CHANGE HERE: your filter.
struct MyFilter {
    f: Vec<Matrix>,
    q: Vec<Matrix>,
    h: Matrix,
    r: Matrix,
    /// From mode i, the row, to mode j.
    transition: Matrix,
    estimates: Vec<Estimate>,
    probabilities: Vector,
}

impl MyFilter {
    /// CHANGE HERE: your filter from a problem. If it cannot do the problem, return an `Err` with the reason.
    fn new(problem: &Value) -> Result<Self, String> {
        // A single filter says here: if modes.len() > 1 { return Err("there is one mode only".to_owned()) }
        if problem["measurement"]["kind"] != "linear" {
            return Err("measurements are linear here".to_owned());
        }
        let modes = list(&problem["modes"]);
        let initial = list(&problem["initial"]["modes"]);
        Ok(Self {
            f: modes.iter().map(|mode| matrix(&mode["F"])).collect(),
            q: modes.iter().map(|mode| matrix(&mode["Q"])).collect(),
            h: matrix(&problem["measurement"]["H"]),
            r: matrix(&problem["R"]),
            transition: matrix(&problem["transition"]),
            estimates: initial
                .iter()
                .map(|mode| Estimate {
                    mean: vector(&mode["mean"]),
                    covariance: matrix(&mode["covariance"]),
                })
                .collect(),
            probabilities: vector(&problem["initial"]["mode_probabilities"]),
        })
    }

    /// CHANGE HERE: one step of your filter; z is none without a detection. It returns your filter's values, from `combined` alone to
    /// everything: the more it shows, the closer the verdict gets to the wrong line. For a step that it cannot do, return an `Err` with the
    /// reason.
    fn step(&mut self, z: Option<&Vector>) -> Result<Value, String> {
        let c = self.transition.transpose() * &self.probabilities;
        let mut modes = Vec::new();
        let mut now = Vec::new();
        for j in 0..c.len() {
            let (mixed, mut mode) = self.mix(&c, j);
            let predicted = Estimate {
                mean: &self.f[j] * &mixed.mean,
                covariance: &self.f[j] * &mixed.covariance * self.f[j].transpose() + &self.q[j],
            };
            mode["predicted"] = estimate(&predicted);
            modes.push(mode);
            now.push(predicted);
        }
        let combined_prediction = mixture(&c, &now);
        let mut log_likelihoods = Vector::zeros(c.len());
        for j in 0..c.len() {
            if let Some(z) = z {
                (now[j], log_likelihoods[j]) = self.update(z, &now[j], &mut modes[j])?;
            }
            modes[j]["updated"] = estimate(&now[j]);
        }
        self.estimates = now;
        self.probabilities = if z.is_some() {
            weighed(&c, &log_likelihoods)
        } else {
            c.clone()
        };
        Ok(json!({
            "predicted_mode_probabilities": c.as_slice(),
            "modes": modes,
            "combined_prediction": estimate(&combined_prediction),
            "mode_probabilities": self.probabilities.as_slice(),
            "combined": estimate(&mixture(&self.probabilities, &self.estimates)),
        }))
    }

    /// The mixed estimate of a mode. A mode that no mode leads to keeps its own estimate.
    fn mix(&self, c: &Vector, j: usize) -> (Estimate, Value) {
        let mut weights = Vector::zeros(c.len());
        weights[j] = 1.0;
        if c[j] > 0.0 {
            weights = self.transition.column(j).component_mul(&self.probabilities) / c[j];
        }
        let mixed = mixture(&weights, &self.estimates);
        let mode = json!({ "mixing_probabilities": weights.as_slice(), "mixed": estimate(&mixed) });
        (mixed, mode)
    }

    /// A mode after the measurement, and the logarithm of its likelihood.
    fn update(&self, z: &Vector, predicted: &Estimate, mode: &mut Value) -> Result<(Estimate, f64), String> {
        let measured = &self.h * &predicted.mean;
        let innovation = z - &measured;
        let cross = &predicted.covariance * self.h.transpose();
        let s = &self.h * &cross + &self.r;
        let root = s
            .clone()
            .cholesky()
            .ok_or("the innovation covariance is not positive definite")?;
        let gain = root.solve(&cross.transpose()).transpose();
        let log_determinant: f64 = root.l().diagonal().iter().map(|entry| 2.0 * entry.ln()).sum();
        let dimensions = f64::from(u32::try_from(z.len()).map_err(|error| error.to_string())?);
        let square = innovation.dot(&root.solve(&innovation));
        let log_likelihood = -(square + log_determinant + dimensions * std::f64::consts::TAU.ln()) / 2.0;
        mode["predicted_measurement"] = json!(measured.as_slice());
        mode["innovation"] = json!(innovation.as_slice());
        mode["innovation_covariance"] = rows(&s);
        mode["cross_covariance"] = rows(&cross);
        mode["gain"] = rows(&gain);
        mode["log_likelihood"] = json!(log_likelihood);
        mode["nis"] = json!(square);
        let covariance = &predicted.covariance - &gain * &s * gain.transpose();
        let updated = Estimate {
            mean: &predicted.mean + &gain * &innovation,
            covariance: (&covariance + covariance.transpose()) / 2.0, // what is not symmetric is rounding, and would grow
        };
        Ok((updated, log_likelihood))
    }
}

/// Mode probabilities after the measurement: in logarithms, for likelihoods may all be zero as doubles.
fn weighed(c: &Vector, log_likelihoods: &Vector) -> Vector {
    let reachable = || c.iter().zip(log_likelihoods.iter()).filter(|(c, _)| **c > 0.0);
    let greatest = reachable().map(|(_, log)| *log).fold(f64::NEG_INFINITY, f64::max);
    let weights = c.zip_map(
        log_likelihoods,
        |c, log| if c > 0.0 { c * (log - greatest).exp() } else { 0.0 },
    );
    let sum = weights.sum();
    weights / sum
}

/// Mean and covariance of a mixture, the spread of its means included.
fn mixture(weights: &Vector, estimates: &[Estimate]) -> Estimate {
    let n = estimates[0].mean.len();
    let mut mean = Vector::zeros(n);
    for (weight, estimate) in weights.iter().zip(estimates) {
        mean += &estimate.mean * *weight;
    }
    let mut covariance = Matrix::zeros(n, n);
    for (weight, estimate) in weights.iter().zip(estimates) {
        let apart = &estimate.mean - &mean;
        covariance += (&estimate.covariance + &apart * apart.transpose()) * *weight;
    }
    Estimate { mean, covariance }
}

// The rest talks to Immaculate and can stay as it is.

pub fn main() {
    for line in std::io::stdin().lines() {
        let Some(message) = line.ok().and_then(|line| serde_json::from_str::<Value>(&line).ok()) else {
            break;
        };
        let reply = match message["type"].as_str() {
            Some("start") => ready(&message["echo"]),
            Some("run") => run(&message["problem"]),
            _ => break,
        };
        if writeln!(std::io::stdout(), "{reply}").is_err() {
            break;
        }
    }
}

fn ready(echo: &Value) -> Value {
    let product = matrix(&echo["matrix"]) * vector(&echo["vector"]);
    json!({ "type": "ready", "name": NAME, "kinds": KINDS, "validates": false, "echo": product.as_slice() })
}

fn run(problem: &Value) -> Value {
    let mut mine = match MyFilter::new(problem) {
        Ok(mine) => mine,
        Err(reason) => return json!({ "type": "skipped", "id": problem["id"], "reason": reason }),
    };
    let mut reply = json!({ "type": "answer", "id": problem["id"], "steps": [] });
    let mut steps = Vec::new();
    for entry in list(&problem["measurements"]) {
        let z = entry["z"].is_array().then(|| vector(&entry["z"]));
        match mine.step(z.as_ref()) {
            Ok(mut shown) => {
                shown["step"] = entry["step"].clone();
                steps.push(shown);
            }
            Err(reason) => {
                reply["error"] = json!(format!("step {}: {reason}", entry["step"]));
                break;
            }
        }
    }
    reply["steps"] = Value::Array(steps);
    reply
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

fn vector(value: &Value) -> Vector {
    Vector::from_iterator(list(value).len(), list(value).iter().map(number))
}

fn matrix(value: &Value) -> Matrix {
    let rows = list(value);
    let columns = rows.first().map_or(0, |row| list(row).len());
    Matrix::from_row_iterator(rows.len(), columns, rows.iter().flat_map(list).map(number))
}

fn rows(matrix: &Matrix) -> Value {
    matrix
        .row_iter()
        .map(|row| json!(row.iter().collect::<Vec<_>>()))
        .collect()
}

fn estimate(estimate: &Estimate) -> Value {
    json!({ "mean": estimate.mean.as_slice(), "covariance": rows(&estimate.covariance) })
}
