//! Goal: the search for certificates finds what there is to find, and the map shows it where it is.
//!
//! Method: spectral radii of matrices whose eigenvalues are known; all words of a length, one by one, beside the few that are tried; forms
//! where the best one is known on paper; the frozen criterion by the Schur-Cohn test, in exact arithmetic. What is found is checked
//! elsewhere, so that a worse search proves nothing wrong; here it is asked that it does not find less. Kind of evidence: property, on
//! matrices from a named generator with a seed; exact where it is said.

// Known radii of zero, and the same growth of the same word, are equal to the last bit.
#![allow(clippy::float_cmp)]

use immaculate::imm::probability::{mixing_probability, predicted_mode_probability};
use immaculate::number::{Field, Rational};
use immaculate::paper::monte_carlo::Generator;
use immaculate::steady::certificate::{Edge, Quadratics};
use immaculate::steady::gains;
use immaculate::steady::map::{CHAIN, Map, greatest_frozen_radius};
use immaculate::steady::pair::{acceleration_matrix, frozen_matrix, product, velocity_matrix};
use immaculate::steady::polynomial::has_radius_below;
use immaculate::steady::search::{fastest_runs, fastest_word, product_certificate, quadratics, spectral_radius};
use immaculate::steady::verdict::{Depth, Filters, StabilityVerdict};
use nalgebra::{Matrix2, Matrix3, SMatrix, matrix};

fn drawn<const N: usize>(generator: &mut Generator) -> SMatrix<f64, N, N> {
    SMatrix::from_fn(|_, _| 2.0 * generator.uniform() - 1.0)
}

#[test]
fn the_spectral_radius_is_the_greatest_size_of_an_eigenvalue() {
    let (sine, cosine) = (0.6, 0.8);
    for (matrix, radius) in [
        (matrix![0.5, 0.0, 0.0; 0.0, -0.75, 0.0; 0.0, 0.0, 0.25], 0.75),
        // A turn, by three halves its length, beside a smaller eigenvalue; and a block with one eigenvector.
        (
            matrix![cosine, -sine, 7.0; sine, cosine, -3.0; 0.0, 0.0, 0.5] * 1.5,
            1.5,
        ),
        (matrix![0.5, 100.0, 0.0; 0.0, 0.5, 100.0; 0.0, 0.0, 0.5], 0.5),
        (matrix![2.0, 0.0, 0.0; 1.0, 3.0, 0.0; 1.0, 1.0, -4.0] * 1e200, 4e200),
        (matrix![2.0, 0.0, 0.0; 1.0, 3.0, 0.0; 1.0, 1.0, -4.0] * 1e-200, 4e-200),
    ] {
        // The norm of a 2³⁹-th power: a block of three grows by its square and 10⁴ beside, e^((2 ln 2³⁹ + ln 10⁴)/2³⁹) = 1 + 1.2e-10.
        let found: f64 = spectral_radius(&matrix);
        assert!((found / radius - 1.0).abs() < 1.3e-10, "{found} for {radius}");
    }
    let nothing = matrix![0.0, 1.0, 2.0; 0.0, 0.0, 3.0; 0.0, 0.0, 0.0];
    assert_eq!(
        (spectral_radius(&nothing), spectral_radius(&Matrix3::zeros())),
        (0.0, 0.0)
    );
    assert!(
        spectral_radius(&Matrix2::from_element(f64::NAN)).is_nan()
            || spectral_radius(&Matrix2::from_element(f64::NAN)) == 0.0
    );
    assert_eq!(spectral_radius(&matrix![f64::INFINITY]), f64::INFINITY);
}

/// All words of up to a length.
fn words(letters: usize, longest: usize) -> Vec<Vec<usize>> {
    let mut all: Vec<Vec<usize>> = vec![Vec::new()];
    let mut last = all.clone();
    for _ in 0..longest {
        let longer = |word: &Vec<usize>| {
            (0..letters)
                .map(|letter| [&word[..], &[letter]].concat())
                .collect::<Vec<_>>()
        };
        last = last.iter().flat_map(longer).collect();
        all.extend(last.iter().cloned());
    }
    all.remove(0);
    all
}

/// The growth of a word a letter.
fn growth<const N: usize>(word: &[usize], matrices: &[SMatrix<f64, N, N>]) -> f64 {
    spectral_radius(&product(word, matrices)).powf(1.0 / word.len() as f64)
}

#[test]
fn no_word_grows_faster_than_the_fastest_one() {
    let mut generator = Generator::new(2000, 21);
    for (letters, longest) in [(2, 1), (2, 2), (2, 5), (2, 8), (3, 1), (3, 4)] {
        for _ in 0..6 {
            let matrices: Vec<Matrix3<f64>> = (0..letters).map(|_| drawn(&mut generator)).collect();
            let (word, found) = fastest_word(&matrices, longest);
            assert!(
                word.len() <= longest && (growth(&word, &matrices) / found - 1.0).abs() < 1e-9,
                "{word:?}"
            );
            let greatest = words(letters, longest)
                .iter()
                .map(|word| growth(word, &matrices))
                .fold(0.0, f64::max);
            // Rotations and powers of a word grow alike, to the rounding of spectral radii.
            assert!(
                (greatest / found - 1.0).abs() < 1e-9,
                "{word:?} {found}, and not {greatest}"
            );
            // It is no power of a shorter word, and the first of its rotations.
            let rotated = |k: usize| [&word[k..], &word[..k]].concat();
            assert!((1..word.len()).all(|k| word < rotated(k)), "{word:?}");
        }
    }
    // Of words that grow alike the first: a longer one has to grow more.
    let halves = [Matrix2::identity() * 0.5, Matrix2::identity() * 0.5];
    assert_eq!(fastest_word(&halves, 4).0, [0]);
}

#[test]
fn no_word_of_two_runs_grows_faster_than_the_fastest_one() {
    let mut generator = Generator::new(2000, 22);
    for longest in [1, 2, 5] {
        for _ in 0..8 {
            let matrices: [Matrix3<f64>; 2] = [drawn(&mut generator), drawn(&mut generator)];
            let (word, found) = fastest_runs(matrices.each_ref(), longest);
            let runs: Vec<Vec<usize>> = (1..=longest)
                .flat_map(|i| (1..=longest).map(move |j| [vec![0; i], vec![1; j]].concat()))
                .collect();
            assert!(runs.contains(&word), "{word:?}");
            let greatest = runs.iter().map(|word| growth(word, &matrices)).fold(0.0, f64::max);
            assert!((growth(&word, &matrices) / greatest - 1.0).abs() < 1e-9, "{word:?}");
            assert!(
                (found / greatest - 1.0).abs() < 1e-9,
                "{word:?} {found}, and not {greatest}"
            );
        }
    }
}

#[test]
fn a_certificate_of_growth_asks_for_nearly_all_of_what_there_is() {
    for growth in [7.5, 1.5, 1.01, 1.000_01, 1.0 + 1e-9] {
        for letters in [1_i32, 2, 7] {
            let found = product_certificate(vec![0; letters.unsigned_abs() as usize], growth).unwrap();
            let excess = growth.powi(letters) - 1.0;
            let asked = (found.radius.clone() - Rational::integer(1)).to_f64();
            assert_eq!(found.word, vec![0; letters.unsigned_abs() as usize]);
            // Three digits, less one or two units of the last of them: at most a fiftieth. The bound is below what there is.
            assert!(asked < excess, "{growth}: {asked} of {excess}");
            assert!(asked > excess * 0.98 * (1.0 - 1e-6), "{growth}: {asked} of {excess}");
            // And no more digits than that takes, or two.
            let is_written = |digits: &u32| {
                (found.radius.clone() * Rational::integer(10).pow(*digits))
                    .value()
                    .unwrap()
                    .is_integer()
            };
            let digits = (1..20).find(is_written).unwrap();
            assert!(
                digits <= 2 || excess * 10.0_f64.powi(digits.cast_signed()) <= 1000.0 * (1.0 + 1e-6),
                "{growth}: {}",
                found.radius
            );
        }
    }
    // What does not grow, or by no more than rounding, has none.
    for growth in [0.0, 0.5, 1.0, 1.0 + 1e-15] {
        assert_eq!(product_certificate(vec![0, 1], growth), None, "{growth}");
    }
}

/// By how much every edge makes forms smaller, in parts of the greatest of them: the least eigenvalue of Pᵤ − AᵀPᵥA.
fn margin(forms: &Quadratics, matrices: &[Matrix3<f64>]) -> f64 {
    let of_doubles = |form: &SMatrix<Rational, 3, 3>| form.map(|entry| entry.to_f64());
    let forms_and_edges = forms.edges.iter().map(|edge| {
        let (a, p, next) = (
            &matrices[edge.letter],
            of_doubles(&forms.forms[edge.from]),
            of_doubles(&forms.forms[edge.to]),
        );
        (p - a.transpose() * next * a).symmetric_eigenvalues().min()
    });
    let greatest = forms
        .forms
        .iter()
        .map(|form| of_doubles(form).symmetric_eigenvalues().max())
        .fold(0.0, f64::max);
    forms_and_edges.fold(f64::INFINITY, f64::min) / greatest
}

#[test]
fn forms_have_at_least_half_of_the_margin_that_there_can_be() {
    // On paper: turns shortened by a < 1 leave the margin 1 − a², that of the longest one, with P = I for all nodes; no forms have more,
    // as the longest turn has Pᵤ ⪰ AᵀPᵤA + t I, whose trace is tr P ≥ a² tr P + 3t, and tr P ≤ 3.
    let turn = matrix![0.6, -0.8, 0.0; 0.8, 0.6, 0.0; 0.0, 0.0, 1.0];
    let other = matrix![1.0, 0.0, 0.0; 0.0, 0.28, -0.96; 0.0, 0.96, 0.28];
    for (a, b) in [(0.5, 0.25), (0.9, 0.3), (0.99, 0.98)] {
        let matrices = [turn * a, other * b];
        for memory in 0..3 {
            let edges = Edge::memory(2, memory);
            // With many digits, so that what is rounded away is far less than the margin.
            let accepts = |forms: &Quadratics| forms.forms[0][(0, 0)].abs().to_f64() > 1e9;
            let found = quadratics(&matrices, &edges, accepts).unwrap();
            let optimum = 1.0 - a * a;
            let margin = margin(&found, &matrices);
            assert!(
                margin >= 0.5 * optimum && margin <= optimum * (1.0 + 1e-6),
                "{a} {b}: {margin} of {optimum}"
            );
        }
        // Integers as short as can be: the first scale that is accepted, with one digit.
        let short = quadratics(&matrices, &Edge::memory(2, 0), |_| true).unwrap();
        let greatest = short.forms[0]
            .iter()
            .map(|entry| entry.abs().to_f64())
            .fold(0.0, f64::max);
        assert_eq!(greatest, 10.0);
    }
    // A turn that is not shortened has none, and neither have two filters whose product grows.
    let edges = Edge::memory(2, 1);
    assert_eq!(quadratics(&[turn, other * 0.5], &edges, |_| true), None);
    let unstable = [velocity_matrix(&0.75), acceleration_matrix(&(1.0 / 6.0))];
    assert_eq!(quadratics(&unstable, &edges, |_| true), None);
}

/// The mixing probabilities under the paper's chain as `[j][i]`, exactly, where mode 0 has this probability.
fn exact_mixing(first: &Rational) -> Vec<Vec<Rational>> {
    let decimal = |entry: f64| Rational::from_decimal(&entry.to_string()).unwrap();
    let chain = CHAIN.map(|row| row.map(decimal).to_vec()).to_vec();
    let before = [first.clone(), Rational::integer(1) - first.clone()];
    let row = |j: usize| {
        let predicted = predicted_mode_probability(&chain, &before, j);
        (0..2)
            .map(|i| mixing_probability(&chain, &before, &predicted, i, j))
            .collect()
    };
    (0..2).map(row).collect()
}

#[test]
fn the_frozen_radius_is_the_greatest_over_the_mode_probabilities() {
    // Exact: no probability from e⁻⁹ to 1 − e⁻⁹ has a greater radius, and one has no smaller one, to a part in a million.
    for (v, a) in [("1/3", "1/2"), ("3/4", "1/6"), ("9/10", "1/10"), ("1/10", "9/10")] {
        let (p, q) = (v.split_once('/').unwrap(), a.split_once('/').unwrap());
        let root = |(p, q): (&str, &str)| Rational::new(p.parse().unwrap(), q.parse().unwrap());
        let roots = [root(p), root(q)];
        let matrices = [velocity_matrix(&roots[0]), acceleration_matrix(&roots[1])];
        let found = greatest_frozen_radius(&Filters::Roots(roots));
        let is_below = |logit: f64, factor: f64| {
            let first = Rational::from_f64((1.0 / (1.0 + (-logit).exp()) * 1e12).round()) / Rational::from_f64(1e12);
            has_radius_below(
                &frozen_matrix(&exact_mixing(&first), &matrices),
                &Rational::from_f64(found * factor),
            )
            .unwrap()
        };
        let logits = || (-9..=9).map(f64::from);
        assert!(logits().all(|logit| is_below(logit, 1.0 + 1e-6)), "{v} {a}: {found}");
        assert!(!logits().all(|logit| is_below(logit, 1.0 - 1e-6)), "{v} {a}: {found}");
    }
}

#[test]
fn a_point_of_the_map_is_where_its_tracking_indices_are() {
    // Roots of three digits: of the lesser of their distances from zero and from one a unit of the third digit, so that neither a filter
    // that believes everything nor one that believes nothing is rounded away.
    let map = Map::new(
        4,
        [-6.0, 3.0],
        Depth {
            word: 1,
            run: 1,
            memory: 0,
        },
        &|| (),
    );
    for (row, points) in map.points.iter().enumerate() {
        for (column, point) in points.iter().enumerate() {
            let index = |k: usize| 10.0_f64.powi(3 * i32::try_from(k).unwrap() - 6);
            let exact = [
                gains::alpha_beta_root(&index(row)),
                gains::alpha_beta_gamma_root(&index(column)),
            ];
            for (root, exact) in point.roots.iter().zip(exact) {
                let distance = f64::min(exact, 1.0 - exact);
                // Half a unit of three digits, 1/200 of the distance at most.
                assert!(
                    (root.to_f64() - exact).abs() <= 0.005 * distance * (1.0 + 1e-9),
                    "{root} for {exact}"
                );
                // A short decimal.
                let is_written = |digits: &u32| {
                    (root.clone() * Rational::integer(10).pow(*digits))
                        .value()
                        .unwrap()
                        .is_integer()
                };
                let digits = (0..22).find(is_written).unwrap();
                assert!(
                    distance * 10.0_f64.powi(digits.cast_signed()) < 1000.0 * (1.0 + 1e-9),
                    "{root} has more digits"
                );
            }
            let [v, a] = &point.roots;
            assert_eq!(
                point.indices,
                [gains::alpha_beta_index(v), gains::alpha_beta_gamma_index(a)]
            );
            assert_eq!(
                point.frozen_radius,
                greatest_frozen_radius(&Filters::Roots(point.roots.clone()))
            );
        }
    }
    let radii = map.points.iter().flatten().map(|point| point.frozen_radius);
    let greatest = radii.clone().fold(0.0, f64::max);
    assert!(radii.clone().any(|radius| radius < greatest));
    assert_eq!(map.greatest_frozen_radius(), greatest);
    // Each verdict is counted once.
    let counted =
        |kind: fn(&StabilityVerdict) -> bool| map.points.iter().flatten().filter(|point| kind(&point.verdict)).count();
    let counts = [
        counted(|verdict| matches!(verdict, StabilityVerdict::Stable(_))),
        counted(|verdict| matches!(verdict, StabilityVerdict::Unstable(_))),
        counted(|verdict| matches!(verdict, StabilityVerdict::Undecided { .. })),
    ];
    assert_eq!((map.counts(), counts.iter().sum()), (counts, 16));
}
