//! The scenes from which most problems are made: generic numbers, one scene per shape.
//!
//! Nothing in them is symmetric, equal or zero by accident: every covariance has all its correlations, every F and H all its entries. The
//! modes' means differ by about a standard deviation and their covariances by factors of up to three. Q is a noticeable part of P, and R
//! has the size of H P Hᵀ. So no mistake hides behind a zero or a symmetry.

use super::draft::{Draft, covariance, estimate, filter, mode, rounded, rows, square};
use immaculate::oracle::problem::{EstimateFile, ModeFile, Rows};

/// A chain of three modes that is neither symmetric nor doubly stochastic.
pub fn three_mode_chain() -> Rows {
    rows([[0.85, 0.1, 0.05], [0.2, 0.7, 0.1], [0.08, 0.22, 0.7]])
}

/// Probabilities of three modes, not those that the chain tends to.
pub(super) const PROBABILITIES: [f64; 3] = [0.5, 0.3, 0.2];

/// One number that grows or decays, measured: n = 1, m = 1, two modes.
pub fn scalar() -> Draft {
    let part = |name, f, q, mean, p| (mode(name, rows([[f]]), rows([[q]])), estimate(&[mean], rows([[p]])));
    Draft::new(
        &["x"],
        &["m"],
        vec![part("decay", 0.94, 0.7, 5.0, 2.3), part("growth", 1.07, 1.1, 6.4, 3.9)],
    )
    .linear(rows([[1.2]]), rows([[3.1]]))
    .chain(rows([[0.9, 0.1], [0.25, 0.75]]), &[0.6, 0.4])
    .sees(&[[8.9]])
}

/// Position and velocity on a line, measured together: n = 2, m = 1, three modes.
pub fn axis() -> Draft {
    let names = ["constant velocity", "braking", "accelerating"];
    let transitions = [
        rows([[1.01, 0.98], [-0.02, 0.97]]),
        rows([[0.97, 0.91], [-0.06, 0.82]]),
        rows([[1.04, 1.06], [0.05, 1.13]]),
    ];
    let noises = [([1.4, 0.6], 0.3), ([1.9, 0.8], -0.25), ([1.1, 0.9], 0.45)];
    let estimates = [
        ([40.0, 6.0], [4.0, 1.5], 0.4),
        ([43.5, 4.7], [5.3, 1.2], -0.35),
        ([37.2, 7.4], [3.4, 2.1], 0.2),
    ];
    let parts = (0..3).map(|j| {
        let (noise, correlation) = noises[j];
        let (mean, deviations, along) = estimates[j];
        let mode = mode(names[j], transitions[j].clone(), covariance(&noise, &[correlation]));
        (mode, estimate(&mean, covariance(&deviations, &[along])))
    });
    Draft::new(&["x", "vx"], &["m", "m/s"], parts.collect())
        .linear(rows([[1.0, 0.2]]), rows([[21.0]]))
        .chain(three_mode_chain(), &PROBABILITIES)
        .sees(&[[54.0]])
}

/// The three modes of the plane.
fn plane_modes() -> [ModeFile; 3] {
    let straight = rows([
        [1.02, 0.97, 0.03, -0.05],
        [0.01, 0.95, -0.02, 0.06],
        [-0.04, 0.08, 0.98, 1.05],
        [0.02, -0.03, 0.015, 0.93],
    ]);
    let left = rows([
        [1.01, 0.98, -0.02, -0.15],
        [0.02, 0.96, 0.01, -0.29],
        [0.03, 0.16, 0.99, 0.97],
        [-0.01, 0.31, 0.02, 0.94],
    ]);
    let right = rows([
        [0.99, 0.96, 0.04, 0.2],
        [-0.015, 0.91, 0.025, 0.38],
        [-0.03, -0.22, 1.03, 0.94],
        [0.012, -0.41, -0.02, 0.9],
    ]);
    [
        mode(
            "nearly straight",
            straight,
            covariance(&[4.0, 1.1, 3.5, 1.2], &[0.3, -0.15, 0.2, 0.1, -0.2, 0.35]),
        ),
        mode(
            "left turn",
            left,
            covariance(&[5.0, 1.4, 4.2, 0.9], &[-0.25, 0.2, -0.1, 0.12, 0.3, -0.15]),
        ),
        mode(
            "right turn",
            right,
            covariance(&[3.6, 0.8, 5.5, 1.6], &[0.18, 0.22, -0.3, -0.12, 0.16, 0.4]),
        ),
    ]
}

/// The three estimates of the plane.
fn plane_estimates() -> [EstimateFile; 3] {
    [
        estimate(
            &[120.0, 8.0, -75.0, 12.0],
            covariance(&[10.0, 2.0, 12.0, 2.5], &[0.35, -0.2, 0.1, 0.15, -0.25, 0.4]),
        ),
        estimate(
            &[131.0, 5.6, -83.0, 14.5],
            covariance(&[13.0, 3.0, 10.5, 2.2], &[-0.3, 0.25, -0.12, -0.18, 0.28, 0.33]),
        ),
        estimate(
            &[111.5, 9.7, -66.0, 10.2],
            covariance(&[9.0, 2.4, 14.0, 3.1], &[0.45, 0.12, 0.3, -0.22, 0.17, -0.26]),
        ),
    ]
}

fn plane_parts() -> Draft {
    let parts = plane_modes().into_iter().zip(plane_estimates()).collect();
    Draft::new(&["x", "vx", "y", "vy"], &["m", "m/s", "m", "m/s"], parts).chain(three_mode_chain(), &PROBABILITIES)
}

/// A target in the plane, its position measured askew: n = 4, m = 2, three modes, Kalman filters.
pub fn plane() -> Draft {
    let h = rows([[1.0, 0.1, -0.2, 0.05], [0.15, -0.08, 1.1, 0.12]]);
    plane_parts()
        .linear(h, covariance(&[11.0, 9.0], &[0.3]))
        .sees(&[[160.0, -35.0]])
}

/// Six measurements of the plane's target.
pub(super) const PLANE_TRACK: [[f64; 2]; 6] = [
    [160.0, -35.0],
    [155.0, -46.0],
    [181.0, -17.0],
    [174.0, -20.0],
    [201.0, -2.0],
    [190.0, 19.0],
];

/// Where the radar of most problems stands, m.
pub(super) const SENSOR: [f64; 2] = [-40.0, 25.0];

/// A target in the plane, its range and bearing measured from [`SENSOR`]: n = 4, m = 2, three modes.
pub fn radar(rule: &str) -> Draft {
    plane_parts()
        .polar(&["range", "bearing"], [0, 2], SENSOR, covariance(&[9.0, 0.055], &[0.3]))
        .filter(filter(rule))
        .sees(&[[207.0, -0.41]])
}

/// Six measurements of the radar's target.
pub(super) const RADAR_TRACK: [[f64; 2]; 6] = [
    [207.0, -0.41],
    [189.0, -0.45],
    [206.0, -0.27],
    [213.0, -0.31],
    [205.0, -0.16],
    [224.0, -0.13],
];

/// A target that is only a position, its range and bearing measured from near by: n = 2, m = 2, one mode.
pub fn buoy() -> Draft {
    let drift = mode(
        "drift",
        rows([[1.03, 0.08], [-0.06, 0.97]]),
        covariance(&[3.0, 4.0], &[-0.35]),
    );
    let start = estimate(&[50.0, 35.0], covariance(&[8.0, 6.0], &[0.45]));
    Draft::new(&["x", "y"], &["m", "m"], vec![(drift, start)])
        .polar(
            &["range", "bearing"],
            [0, 1],
            [-7.0, 11.0],
            covariance(&[5.0, 0.09], &[-0.25]),
        )
        .chain(rows([[1.0]]), &[1.0])
        .sees(&[[72.0, 0.28]])
}

/// A generic number for an entry of a large matrix, between −0.135 and 0.135 and not zero; so small that correlations of them are
/// positive definite up to n = 8.
fn small(row: usize, column: usize, variant: usize) -> f64 {
    let (low, high) = (row.min(column), row.max(column));
    let place = (7 * high + 3 * low + 5 * variant + low * high) % 9;
    0.03 * place as f64 - 0.105
}

/// A covariance of n entries with [`small`] correlations.
fn small_covariance(deviations: &[f64], variant: usize) -> Rows {
    let n = deviations.len();
    let pairs = (0..n).flat_map(|row| (0..row).map(move |column| (row, column)));
    let correlations: Vec<f64> = pairs.map(|(row, column)| small(row, column, variant)).collect();
    covariance(deviations, &correlations)
}

/// A target in the plane with an order of derivatives more for each letter of `letters`, its range and bearing measured from
/// [`SENSOR`]: the entries of the state are x, vx, ax, … and then y, vy, ay, …, and for odd n the speed u of a current
/// at the end.
pub fn derivatives(n: usize, rule: &str) -> Draft {
    let half = n / 2;
    let (names, units) = (["", "v", "a", "j"], ["m", "m/s", "m/s^2", "m/s^3"]);
    let order = |entry: usize| if entry < 2 * half { entry % half } else { 1 };
    let name = |entry: usize| match entry {
        entry if entry == 2 * half => "u".to_owned(),
        entry => format!("{}{}", names[order(entry)], if entry < half { "x" } else { "y" }),
    };
    let unit = |entry: usize| if entry == 2 * half { "m/s" } else { units[order(entry)] };
    let taylor = [1.0, 0.8, 0.32, 0.08];
    let transition = |variant: usize| {
        square(n, |row, column| {
            let is_same_axis = row / half == column / half && column < 2 * half && row <= column;
            let main = if is_same_axis {
                taylor[column - row]
            } else {
                f64::from(u8::from(row == column))
            };
            rounded(main + 0.2 * small(row, column + 2 * row, variant))
        })
    };
    let (starts, spreads) = ([1.0, 0.1, 0.03, 0.01], [1.0, 0.25, 0.12, 0.05]);
    let part = |variant: usize| {
        let shift = 9.0 * variant as f64;
        let mean = |entry: usize| {
            let start = if entry < half { 118.0 - shift } else { shift - 71.0 };
            rounded(start * starts[order(entry)])
        };
        let deviation = |entry: usize| rounded((10.0 + variant as f64 + 0.5 * entry as f64) * spreads[order(entry)]);
        let deviations: Vec<f64> = (0..n).map(deviation).collect();
        let noises: Vec<f64> = deviations.iter().map(|deviation| rounded(0.4 * deviation)).collect();
        let mean: Vec<f64> = (0..n).map(mean).collect();
        (
            mode(
                ["gentle", "sharp"][variant],
                transition(variant),
                small_covariance(&noises, variant + 2),
            ),
            estimate(&mean, small_covariance(&deviations, variant)),
        )
    };
    let (names, units): (Vec<String>, Vec<&str>) = (0..n).map(|entry| (name(entry), unit(entry))).unzip();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    Draft::new(&names, &units, vec![part(0), part(1)])
        .polar(
            &["range", "bearing"],
            [0, half],
            SENSOR,
            covariance(&[9.0, 0.055], &[0.3]),
        )
        .filter(filter(rule))
        .chain(rows([[0.9, 0.1], [0.25, 0.75]]), &[0.6, 0.4])
        .sees(&[[204.0, -0.48]])
}
