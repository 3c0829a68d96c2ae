//! Goal: problems of any shape are read from files, certified, and computed with the same bits as filters whose shapes are in their types.
//!
//! Method: files are made for states and measurements of many sizes, with matrices that are not special in any way. Kind of evidence:
//! enclosures, and golden bits between two storages.

use immaculate::imm::{Imm, Interaction};
use immaculate::matrix::{Holds, Shapes};
use immaculate::number::RandomRounding;
use immaculate::oracle::certify::certify;
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::trace::Trace;
use nalgebra::{Const, DMatrix, Dim, OMatrix, OVector};
use serde_json::{Value, json};

/// A number between −1 and 1 with three decimals, another for each place.
fn number(seed: usize, row: usize, column: usize) -> f64 {
    let mixed = (seed * 7919 + row * 104_729 + column * 1_299_709 + 17) % 2001;
    (mixed as f64 - 1000.0) / 1000.0
}

fn matrix(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
    (0..rows)
        .map(|row| (0..columns).map(|column| entry(row, column)).collect())
        .collect()
}

/// A covariance: symmetric, and its diagonal greater than the rest of each row.
fn covariance(seed: usize, n: usize, size: f64) -> Vec<Vec<f64>> {
    matrix(n, n, |row, column| {
        if row == column {
            size * (1.5 + number(seed, row, row).abs())
        } else {
            size * number(seed, row.min(column), row.max(column)) / n as f64
        }
    })
}

/// A problem with two modes, three steps and a missed detection.
fn problem(n: usize, m: usize, filter: &Value) -> ProblemFile {
    let mode = |seed: usize| {
        json!({
            "name": format!("mode {seed}"),
            "F": matrix(n, n, |row, column| if row == column { 1.0 } else { 0.25 * number(seed, row, column) }),
            "Q": covariance(seed + 10, n, 0.5),
        })
    };
    let estimate = |seed: usize| {
        let mean: Vec<f64> = (0..n).map(|row| 10.0 * number(seed, row, 3)).collect();
        json!({ "mean": mean, "covariance": covariance(seed, n, 2.0) })
    };
    let z = |seed: usize| -> Vec<f64> { (0..m).map(|row| 12.0 * number(seed, row, 5)).collect() };
    let file = json!({
        "format": "immaculate-problem/1",
        "id": format!("shape.n{n}-m{m}"),
        "about": "A state and a measurement of another size.",
        "flags": [],
        "state": (0..n).map(|row| format!("x{row}")).collect::<Vec<_>>(),
        "units": vec!["1"; n],
        "modes": [mode(1), mode(2)],
        "measurement": { "kind": "linear", "H": matrix(m, n, |row, column| number(3, row, column)) },
        "R": covariance(4, m, 1.0),
        "filter": filter,
        "transition": [[0.9, 0.1], [0.2, 0.8]],
        "initial": { "mode_probabilities": [0.6, 0.4], "modes": [estimate(5), estimate(6)] },
        "conventions": {
            "square_root": "cholesky-lower",
            "angle_mean": "centre-point",
            "first_step": "mixed",
            "log_likelihood": "full",
        },
        "measurements": [{ "step": 1, "z": z(7) }, { "step": 2, "z": null }, { "step": 3, "z": z(8) }],
    });
    ProblemFile::read(&file.to_string()).expect("the problem is right")
}

fn kalman() -> Value {
    json!({ "kind": "kalman" })
}

fn cubature() -> Value {
    json!({ "kind": "cubature", "rule": "cubature-3" })
}

#[test]
fn problems_of_any_shape_are_certified() {
    for (n, m) in [(3, 2), (6, 3), (9, 4), (16, 6), (2, 5), (32, 16)] {
        let certified = certify(&problem(n, m, &kalman())).unwrap_or_else(|reason| panic!("{n} × {m}: {reason}"));
        assert!(certified.digits > 16, "{n} × {m}: {} digits", certified.digits);
        assert_eq!(certified.trace.dimensions.n, n);
    }
    for (n, m) in [(3, 2), (6, 3), (9, 4)] {
        let certified = certify(&problem(n, m, &cubature())).unwrap_or_else(|reason| panic!("{n} × {m}: {reason}"));
        assert!(certified.digits > 16, "{n} × {m}: {} digits", certified.digits);
    }
}

/// A linear filter with points of degree two has the Kalman filter's exact values: the certified doubles are the same ones, but for values
/// that lie within an enclosure's width of the middle between two doubles.
#[test]
fn certified_points_and_matrices_agree_on_linear_problems_of_any_shape() {
    for (n, m) in [(3, 2), (6, 3), (9, 4)] {
        let [exact, points] = [kalman(), cubature()].map(|filter| certify(&problem(n, m, &filter)).unwrap().trace);
        for (step, quantity, mode) in exact.all_places() {
            let (a, b) = (exact.get(step, quantity, mode), points.get(step, quantity, mode));
            assert_eq!(a, b, "{n} × {m}, step {step}, {}", quantity.name());
        }
    }
}

/// The combined estimates of all steps, of a run whose sides are known at run time.
fn combined(trace: &Trace, n: usize) -> Vec<u64> {
    use immaculate::imm::Quantity::{CombinedCovariance, CombinedMean};
    let values = (1..=3).flat_map(|step| [CombinedMean, CombinedCovariance].map(|quantity| (step, quantity)));
    let numbers = values.flat_map(|(step, quantity)| trace.get(step, quantity, 0).expect("it is there").clone());
    let bits: Vec<u64> = numbers.map(f64::to_bits).collect();
    assert_eq!(bits.len(), 3 * (n + n * n));
    bits
}

/// The same of a run whose sides are types.
fn combined_of_types<const N: usize, const M: usize>(problem: &ProblemFile) -> Vec<u64>
where
    Shapes: Holds<Const<N>, Const<M>>,
{
    let setup = problem.setup(|value| value).unwrap();
    let (n, m) = (Const::<N>, Const::<M>);
    let typed = immaculate::imm::Problem {
        modes: setup
            .problem
            .modes
            .iter()
            .map(|mode| immaculate::model::motion::Mode {
                name: mode.name.clone(),
                motion: immaculate::model::motion::Motion::Linear(of(&mode.motion.matrix(), n, n)),
                noise: of(&mode.noise, n, n),
            })
            .collect(),
        filters: vec![immaculate::filter::Filter::kalman()],
        interaction: Interaction::Imm,
        angles: Vec::new(),
        chain: setup.problem.chain.clone(),
        sensor: immaculate::model::Sensor::Linear(of(&setup.problem.h(), m, n)),
        measurement_noise: of(&setup.problem.measurement_noise, m, m),
    };
    let initial = immaculate::imm::Initial {
        modes: setup
            .initial
            .modes
            .iter()
            .map(|estimate| immaculate::gaussian::Gaussian {
                mean: OVector::from_iterator_generic(n, Const::<1>, estimate.mean.iter().copied()),
                covariance: of(&estimate.covariance, n, n),
            })
            .collect(),
        mode_probabilities: setup.initial.mode_probabilities.clone(),
    };
    let mut filter = Imm::new(typed, &initial).unwrap();
    let mut bits = Vec::new();
    for z in &setup.measurements {
        let z = z
            .as_ref()
            .map(|z| OVector::from_iterator_generic(m, Const::<1>, z.iter().copied()));
        let step = filter.step(z.as_ref()).unwrap();
        bits.extend(step.combined.mean.iter().map(|value: &f64| value.to_bits()));
        bits.extend(
            step.combined
                .covariance
                .transpose()
                .iter()
                .map(|value: &f64| value.to_bits()),
        );
    }
    bits
}

fn of<R: Dim, C: Dim>(matrix: &DMatrix<f64>, rows: R, columns: C) -> OMatrix<f64, R, C>
where
    nalgebra::DefaultAllocator: nalgebra::allocator::Allocator<R, C>,
{
    OMatrix::from_fn_generic(rows, columns, |row, column| matrix[(row, column)])
}

#[test]
fn shapes_in_types_and_at_run_time_give_the_same_bits() {
    fn check<const N: usize, const M: usize>()
    where
        Shapes: Holds<Const<N>, Const<M>>,
    {
        let problem = problem(N, M, &kalman());
        let at_run_time = problem.setup_in_doubles().unwrap().run().in_doubles();
        assert_eq!(
            combined(&at_run_time, N),
            combined_of_types::<N, M>(&problem),
            "{N} × {M}"
        );
    }
    check::<1, 1>();
    check::<3, 2>();
    check::<6, 3>();
    check::<8, 4>();
    check::<12, 5>();
}

#[test]
fn random_rounding_outside_of_its_scope_is_the_double() {
    let (a, b) = (0.1, 0.7);
    let of = |value: f64| RandomRounding::exact(value);
    assert_eq!(
        (of(a) * of(b) - of(b) / of(a)).value().to_bits(),
        (a * b - b / a).to_bits()
    );
}

#[test]
fn a_state_without_components_or_with_too_many_is_refused() {
    let mut file = serde_json::to_value(problem(2, 1, &kalman())).unwrap();
    file["state"] = json!([]);
    let refused = ProblemFile::read(&file.to_string()).unwrap_err().to_string();
    assert_eq!(refused, "problem.state: has 0 components; there must be 1 to 32");
    file["state"] = json!(vec!["x"; 33]);
    let refused = ProblemFile::read(&file.to_string()).unwrap_err().to_string();
    assert_eq!(refused, "problem.state: has 33 components; there must be 1 to 32");
    file = serde_json::to_value(problem(2, 1, &kalman())).unwrap();
    file["R"] = json!(vec![vec![0.0; 17]; 17]);
    let refused = ProblemFile::read(&file.to_string()).unwrap_err().to_string();
    assert_eq!(refused, "problem.R: has 17 components; there must be 1 to 16");
}
