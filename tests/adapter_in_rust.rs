//! Goal: a filter in Rust is checked from its own tests, and an example of how that is done.
//!
//! Method: a Kalman IMM in plain `Vec<Vec<f64>>`, which shares no equation with this crate, is put under the trait `Subject` and run
//! over the published cases. Kind of evidence: oracle. The first half is the adapter; the lines that another filter would change are
//! marked CHANGE HERE. The second half is the filter.

use immaculate::imm::Quantity;
use immaculate::oracle::check::{Report, Selection, check};
use immaculate::oracle::problem::{FORMAT, MeasurementFile, ProblemFile};
use immaculate::oracle::subject::{Answer, Broken, Ready, Subject};
use immaculate::oracle::trace::Trace;
use immaculate::report::check::text;

#[test]
fn a_filter_that_shares_no_equation_with_this_crate_is_right() {
    let report = report_of(Example::default());
    assert!(!report.is_wrong(), "{}", text(&report));
    assert_eq!(report.faults().count(), 0);
    assert_eq!(report.hidden, [], "it shows everything");
}

#[test]
fn its_mistake_is_found_and_named() {
    let report = report_of(Example {
        is_chain_transposed: true,
    });
    assert!(report.is_wrong());
    let text = text(&report);
    assert!(text.contains("FAULT  predicted_mode_probabilities"), "{text}");
    assert!(text.contains("(transition-transposed; mistake)"), "{text}");
}

fn report_of(mut example: Example) -> Report {
    // Which cases are asked for: all that the filter is for.
    let selection = Selection::default();
    check(&mut example, &selection, &|_| {}).unwrap()
}

// The adapter

/// The filter under test.
#[derive(Default)]
struct Example {
    /// A planted mistake: the chain is read by columns.
    is_chain_transposed: bool,
}

impl Subject for Example {
    fn start(&mut self) -> Result<Ready, Broken> {
        Ok(Ready {
            name: "example in Rust".into(),     // CHANGE HERE
            kinds: Some(vec!["kalman".into()]), // CHANGE HERE: which filters there are
            formats: Some(vec![FORMAT.into()]), // F and Q are the same in every step here
            validates: false,
            ..Ready::default()
        })
    }

    fn run(&mut self, problem: &ProblemFile) -> Answer {
        let MeasurementFile::Linear { matrix } = &problem.measurement else {
            return Answer::Skipped {
                reason: "linear measurements only".into(),
            };
        };
        // CHANGE HERE: your filter from a problem
        let chain = &problem.transition;
        let mut imm = Imm {
            f: problem.modes.iter().map(|mode| mode.transition.clone()).collect(),
            q: problem.modes.iter().map(|mode| mode.noise.clone()).collect(),
            h: matrix.clone(),
            r: problem.noise.clone(),
            chain: if self.is_chain_transposed {
                transposed(chain)
            } else {
                chain.clone()
            },
            probabilities: problem.initial.mode_probabilities.clone(),
            estimates: problem
                .initial
                .modes
                .iter()
                .map(|estimate| Estimate {
                    x: estimate.mean.clone(),
                    p: estimate.covariance.clone().unwrap(),
                })
                .collect(),
        };
        let mut trace = Trace::empty(&problem.dimensions());
        for entry in &problem.measurements {
            let z: Vec<f64> = entry.entries().map(|(_, value)| value).collect();
            let step = imm.step(entry.z.is_some().then_some(z.as_slice()));
            show(&mut trace, entry.step, &step, entry.z.is_some());
        }
        Answer::Steps { trace, error: None }
    }
}

/// What the filter lets us see of a step. CHANGE HERE: what yours can show; what is not set is not shown.
fn show(trace: &mut Trace, number: usize, step: &Step, is_detected: bool) {
    let mut whole = |quantity, values: &[f64]| trace.set(number, quantity, 0, values.to_vec());
    whole(Quantity::PredictedModeProbabilities, &step.predicted_probabilities);
    whole(Quantity::CombinedPredictionMean, &step.combined_prediction.x);
    whole(
        Quantity::CombinedPredictionCovariance,
        &step.combined_prediction.p.concat(),
    );
    whole(Quantity::ModeProbabilities, &step.probabilities);
    whole(Quantity::CombinedMean, &step.combined.x);
    whole(Quantity::CombinedCovariance, &step.combined.p.concat());
    for (j, mode) in step.modes.iter().enumerate() {
        let mut of_mode = |quantity, values: &[f64]| trace.set(number, quantity, j, values.to_vec());
        of_mode(Quantity::MixingProbabilities, &mode.mixing_probabilities);
        of_mode(Quantity::MixedMean, &mode.mixed.x);
        of_mode(Quantity::MixedCovariance, &mode.mixed.p.concat());
        of_mode(Quantity::PredictedMean, &mode.predicted.x);
        of_mode(Quantity::PredictedCovariance, &mode.predicted.p.concat());
        of_mode(Quantity::UpdatedMean, &mode.updated.x);
        of_mode(Quantity::UpdatedCovariance, &mode.updated.p.concat());
        if is_detected {
            of_mode(Quantity::PredictedMeasurement, &mode.predicted_measurement);
            of_mode(Quantity::Innovation, &mode.innovation);
            of_mode(Quantity::InnovationCovariance, &mode.s.concat());
            of_mode(Quantity::CrossCovariance, &mode.cross.concat());
            of_mode(Quantity::Gain, &mode.gain.concat());
            of_mode(Quantity::LogLikelihood, &[mode.log_likelihood]);
            of_mode(Quantity::Nis, &[mode.square]);
        }
    }
}

// The filter

type Rows = Vec<Vec<f64>>;

#[derive(Clone, Default)]
struct Estimate {
    x: Vec<f64>,
    p: Rows,
}

/// What one mode computes in a step.
#[derive(Default)]
struct Mode {
    mixing_probabilities: Vec<f64>,
    mixed: Estimate,
    predicted: Estimate,
    predicted_measurement: Vec<f64>,
    innovation: Vec<f64>,
    s: Rows,
    cross: Rows,
    gain: Rows,
    updated: Estimate,
    log_likelihood: f64,
    square: f64,
}

/// What all modes compute in a step.
struct Step {
    modes: Vec<Mode>,
    predicted_probabilities: Vec<f64>,
    combined_prediction: Estimate,
    probabilities: Vec<f64>,
    combined: Estimate,
}

struct Imm {
    f: Vec<Rows>,
    q: Vec<Rows>,
    h: Rows,
    r: Rows,
    /// `chain[i][j]`: from i to j.
    chain: Rows,
    probabilities: Vec<f64>,
    estimates: Vec<Estimate>,
}

impl Imm {
    fn step(&mut self, z: Option<&[f64]>) -> Step {
        let predicted_probabilities = applied(&transposed(&self.chain), &self.probabilities);
        let mut modes: Vec<Mode> = Vec::new();
        for (j, &c) in predicted_probabilities.iter().enumerate() {
            let weight = |i: usize| {
                // A mode that cannot be reached keeps its own estimate.
                if c > 0.0 {
                    self.chain[i][j] * self.probabilities[i] / c
                } else {
                    f64::from(u8::from(i == j))
                }
            };
            let mixing_probabilities: Vec<f64> = (0..self.f.len()).map(weight).collect();
            let mixed = mixture(&mixing_probabilities, &self.estimates);
            let f = &self.f[j];
            let predicted = Estimate {
                x: applied(f, &mixed.x),
                p: sum(&product(&product(f, &mixed.p), &transposed(f)), &self.q[j]),
            };
            let updated = predicted.clone();
            modes.push(Mode {
                mixing_probabilities,
                mixed,
                predicted,
                updated,
                ..Mode::default()
            });
        }
        if let Some(z) = z {
            for mode in &mut modes {
                self.update(mode, z);
            }
        }
        let probabilities = if z.is_some() {
            weighed(&predicted_probabilities, &modes)
        } else {
            predicted_probabilities.clone()
        };
        let predicted: Vec<Estimate> = modes.iter().map(|mode| mode.predicted.clone()).collect();
        let updated: Vec<Estimate> = modes.iter().map(|mode| mode.updated.clone()).collect();
        let combined_prediction = mixture(&predicted_probabilities, &predicted);
        let combined = mixture(&probabilities, &updated);
        self.estimates = updated;
        self.probabilities.clone_from(&probabilities);
        Step {
            modes,
            predicted_probabilities,
            combined_prediction,
            probabilities,
            combined,
        }
    }

    fn update(&self, mode: &mut Mode, z: &[f64]) {
        let Estimate { x, p } = &mode.predicted;
        mode.predicted_measurement = applied(&self.h, x);
        mode.innovation = z
            .iter()
            .zip(&mode.predicted_measurement)
            .map(|(z, predicted)| z - predicted)
            .collect();
        mode.cross = product(p, &transposed(&self.h));
        mode.s = sum(&product(&self.h, &mode.cross), &self.r);
        let (inverse, determinant) = inverse(&mode.s);
        mode.gain = product(&mode.cross, &inverse);
        let correction = applied(&mode.gain, &mode.innovation);
        // Not K C', with which the antisymmetric part of rounding errors grows from step to step.
        let reduction = product(&product(&mode.gain, &mode.s), &transposed(&mode.gain));
        mode.updated.x = x.iter().zip(correction).map(|(x, correction)| x + correction).collect();
        mode.updated.p = sum(p, &scaled(&reduction, -1.0));
        let weighted = applied(&inverse, &mode.innovation);
        mode.square = mode.innovation.iter().zip(weighted).map(|(a, b)| a * b).sum();
        let two_pi = (2.0 * std::f64::consts::PI).ln() * f64::from(u32::try_from(z.len()).unwrap());
        mode.log_likelihood = -(mode.square + determinant.ln() + two_pi) / 2.0;
    }
}

/// Bayes' rule, with likelihoods relative to the greatest.
fn weighed(predicted: &[f64], modes: &[Mode]) -> Vec<f64> {
    let reachable = predicted.iter().zip(modes).filter(|(c, _)| **c > 0.0);
    let greatest = reachable
        .map(|(_, mode)| mode.log_likelihood)
        .fold(f64::NEG_INFINITY, f64::max);
    let weight = |(&c, mode): (&f64, &Mode)| {
        if c > 0.0 {
            c * (mode.log_likelihood - greatest).exp()
        } else {
            0.0
        }
    };
    let weights: Vec<f64> = predicted.iter().zip(modes).map(weight).collect();
    let whole: f64 = weights.iter().sum();
    weights.iter().map(|weight| weight / whole).collect()
}

/// Mean and covariance of a mixture.
fn mixture(weights: &[f64], estimates: &[Estimate]) -> Estimate {
    let n = estimates[0].x.len();
    let mut whole = Estimate {
        x: vec![0.0; n],
        p: vec![vec![0.0; n]; n],
    };
    for (weight, estimate) in weights.iter().zip(estimates) {
        for row in 0..n {
            whole.x[row] += weight * estimate.x[row];
        }
    }
    for (weight, estimate) in weights.iter().zip(estimates) {
        let spread: Vec<f64> = (0..n).map(|row| estimate.x[row] - whole.x[row]).collect();
        for row in 0..n {
            for column in 0..n {
                whole.p[row][column] += weight * (estimate.p[row][column] + spread[row] * spread[column]);
            }
        }
    }
    whole
}

fn applied(a: &Rows, x: &[f64]) -> Vec<f64> {
    a.iter()
        .map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum())
        .collect()
}

fn transposed(a: &Rows) -> Rows {
    (0..a[0].len())
        .map(|column| a.iter().map(|row| row[column]).collect())
        .collect()
}

fn product(a: &Rows, b: &Rows) -> Rows {
    let columns = transposed(b);
    a.iter().map(|row| applied(&columns, row)).collect()
}

fn sum(a: &Rows, b: &Rows) -> Rows {
    a.iter()
        .zip(b)
        .map(|(a, b)| a.iter().zip(b).map(|(a, b)| a + b).collect())
        .collect()
}

fn scaled(a: &Rows, factor: f64) -> Rows {
    a.iter().map(|row| row.iter().map(|a| a * factor).collect()).collect()
}

/// Inverse and determinant of a positive definite matrix, by Gauss and Jordan.
fn inverse(a: &Rows) -> (Rows, f64) {
    let n = a.len();
    let mut left = a.clone();
    let mut right: Rows = (0..n)
        .map(|i| (0..n).map(|k| f64::from(u8::from(i == k))).collect())
        .collect();
    let mut determinant = 1.0;
    for pivot in 0..n {
        let divisor = left[pivot][pivot];
        determinant *= divisor;
        for side in [&mut left, &mut right] {
            side[pivot].iter_mut().for_each(|entry| *entry /= divisor);
        }
        for row in (0..n).filter(|row| *row != pivot) {
            let factor = left[row][pivot];
            for side in [&mut left, &mut right] {
                let pivot_row = side[pivot].clone();
                side[row]
                    .iter_mut()
                    .zip(pivot_row)
                    .for_each(|(entry, above)| *entry -= factor * above);
            }
        }
    }
    (right, determinant)
}
