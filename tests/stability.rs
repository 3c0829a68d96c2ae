//! Goal: the steady gains are the ones of the Riccati equation, and what is said of the stability of fixed-gain filters is proven.
//!
//! Method: identities on rational functions of the damping root, the scan time and the measurement variance (symbolic); exact rational
//! arithmetic and enclosures for what holds at given noises; each certificate is checked, then spoilt and refused. Kind of evidence:
//! stated with each test.

use immaculate::filter::Filter;
use immaculate::filter::kalman::{cross_covariance, innovation_covariance, predicted_covariance};
use immaculate::filter::update::{gain, updated_covariance};
use immaculate::gaussian::Gaussian;
use immaculate::imm::{Imm, Initial, Interaction, Problem};
use immaculate::matrix::{is_positive_definite, is_positive_semidefinite, ldl};
use immaculate::model::acceleration::{
    acceleration_part, acceleration_response, constant_acceleration, embedded_constant_velocity,
    embedded_velocity_response, position_matrix, response_noise,
};
use immaculate::model::{
    Sensor,
    motion::{Mode, Motion},
};
use immaculate::number::{Enclosure, Field, Rational, RationalFunction, Real};
use immaculate::paper::derbez2000::instances;
use immaculate::paper::monte_carlo::Generator;
use immaculate::steady::by_hand::ByHand;
use immaculate::steady::certificate::{Edge, NotProven, Product, Quadratics};
use immaculate::steady::certificate_file::{
    CertificateFile, FiltersFile, InvalidCertificate, Noises, ProofFile, read_number,
};
use immaculate::steady::closed_loops::{ClosedLoops, Entries};
use immaculate::steady::gains;
use immaculate::steady::linear::{solve, stein};
use immaculate::steady::map::Map;
use immaculate::steady::pair::{acceleration_matrix, frozen_matrix, product, remark_1_matrix, velocity_matrix};
use immaculate::steady::polynomial::{characteristic_polynomial, has_radius_below, is_stable_polynomial, rows_of};
use immaculate::steady::reach::{polynomial_text, unseen_part};
use immaculate::steady::riccati::{NoSteadyState, Riccati, SteadyState};
use immaculate::steady::verdict::{Depth, Filters, StabilityVerdict, rows_text, word_text};
use nalgebra::{Const, Matrix1, Matrix2, Matrix3, SMatrix, Vector2, Vector3};
use num_traits::{One, Zero};

type Unknown = RationalFunction;

fn unknown(name: &str) -> Unknown {
    Unknown::unknown(name)
}

// The motions and the gains (symbolic)

#[test]
fn the_two_motions_differ_by_the_acceleration() {
    let t = unknown("t");
    let difference = constant_acceleration(&t) - embedded_constant_velocity(&t);
    assert_eq!(difference, acceleration_part(&t));
    let state = Vector3::new(unknown("p"), unknown("v"), unknown("a"));
    assert_eq!(acceleration_part(&t) * &state, acceleration_response(&t) * unknown("a"));
    // The embedded model forgets the acceleration it is given and makes none.
    let after = embedded_constant_velocity(&t) * state;
    assert_eq!(
        after,
        Vector3::new(unknown("p") + t * unknown("v"), unknown("v"), Unknown::zero())
    );
}

#[test]
fn constant_acceleration_composes_over_time() {
    let (s, t) = (unknown("s"), unknown("t"));
    let both = constant_acceleration(&s) * constant_acceleration(&t);
    assert_eq!(both, constant_acceleration(&(s + t)));
}

/// One step of the Riccati recursion of a filter that measures the position.
fn riccati_step(
    f: &Matrix3<Unknown>,
    q: &Matrix3<Unknown>,
    r: &Unknown,
    p: &Matrix3<Unknown>,
) -> (Vector3<Unknown>, Matrix3<Unknown>) {
    let h = position_matrix();
    let s = innovation_covariance(&h, p, &Matrix1::new(r.clone()));
    let k = gain(&cross_covariance(p, &h), &ldl(&s));
    let updated = updated_covariance(p, &k, &s);
    (k, predicted_covariance(f, &updated, q))
}

#[test]
fn the_alpha_beta_gain_solves_the_riccati_equation() {
    let (root, r, t) = (unknown("theta"), unknown("R"), unknown("t"));
    // q = Λ² R/t⁴
    let index = gains::alpha_beta_index(&root);
    let variance =
        |index: &Unknown| index.clone() * index.clone() * r.clone() / (t.clone() * t.clone() * t.clone() * t.clone());
    let noise = |index: &Unknown| response_noise(&embedded_velocity_response(&t), &variance(index));
    let p = gains::alpha_beta_covariance(&root, &r, &t);
    let (k, next) = riccati_step(&embedded_constant_velocity(&t), &noise(&index), &r, &p);
    assert_eq!(next, p);
    assert_eq!(k, gains::alpha_beta_gain(&root, &t));
    assert_eq!(p[(0, 0)].clone() + r.clone(), gains::innovation_variance(&root, &r));
    // With another noise it is no solution.
    let (_, other) = riccati_step(
        &embedded_constant_velocity(&t),
        &noise(&(index + Unknown::one())),
        &r,
        &p,
    );
    assert_ne!(other, p);
}

#[test]
fn the_alpha_beta_gamma_gain_solves_the_riccati_equation() {
    let (root, r, t) = (unknown("theta"), unknown("R"), unknown("t"));
    let index = gains::alpha_beta_gamma_index(&root);
    let variance =
        |index: &Unknown| index.clone() * index.clone() * r.clone() / (t.clone() * t.clone() * t.clone() * t.clone());
    let noise = |index: &Unknown| response_noise(&acceleration_response(&t), &variance(index));
    let p = gains::alpha_beta_gamma_covariance(&root, &r, &t);
    let (k, next) = riccati_step(&constant_acceleration(&t), &noise(&index), &r, &p);
    assert_eq!(next, p);
    assert_eq!(k, gains::alpha_beta_gamma_gain(&root, &t));
    assert_eq!(p[(0, 0)].clone() + r.clone(), gains::innovation_variance(&root, &r));
    let (_, other) = riccati_step(&constant_acceleration(&t), &noise(&(index + Unknown::one())), &r, &p);
    assert_ne!(other, p);
}

// The damping roots (enclosed)

#[test]
fn the_damping_roots_give_back_their_index() {
    // From a target that hardly moves in a scan to one that is lost between two, on both sides of the index 12√3 = 20.78, where
    // the cubic goes from one real root to three.
    let indices = ["1e-12", "0.001", "0.7", "20.7", "20.8", "1000", "1e12"];
    for text in indices {
        let index = Rational::from_decimal(text).unwrap();
        Enclosure::with_precision(256, || {
            let index = Enclosure::rational(&index);
            for (root, back) in [
                (
                    gains::alpha_beta_root(&index),
                    gains::alpha_beta_index as fn(&Enclosure) -> Enclosure,
                ),
                (gains::alpha_beta_gamma_root(&index), gains::alpha_beta_gamma_index),
            ] {
                assert!(root > Enclosure::zero() && root < Enclosure::one(), "{text}");
                let difference = back(&root) / index.clone() - Enclosure::one();
                assert!(difference.contains(&Rational::zero()), "{text}: {difference}");
                // 256 bits less those of the index itself, whose square decides the root.
                assert!(difference.width() < 1e-40, "{text}: {difference}");
            }
        });
        // The same closed forms in doubles: nothing cancels. The root has some ten roundings, and the ten of a logarithm of up to
        // 30; the index is a power of up to three of 1 − θ, so they come back magnified by 3/(1 − θ) at most.
        let double = index.to_f64();
        let (velocity, acceleration) = (gains::alpha_beta_root(&double), gains::alpha_beta_gamma_root(&double));
        let back = [
            (gains::alpha_beta_index(&velocity), velocity),
            (gains::alpha_beta_gamma_index(&acceleration), acceleration),
        ];
        for (value, root) in back {
            let bound = 20.0 * f64::EPSILON * 3.0 / (1.0 - root);
            assert!((value / double - 1.0).abs() < bound, "{text}: {value}");
        }
    }
}

// Polynomials, linear systems, what is not seen (exact)

fn rational(text: &str) -> Rational {
    let (p, q) = text.split_once('/').unwrap_or((text, "1"));
    Rational::from_decimal(p).unwrap() / Rational::from_decimal(q).unwrap()
}

fn rationals<const R: usize, const C: usize>(rows: [[&str; C]; R]) -> SMatrix<Rational, R, C> {
    SMatrix::from_fn(|i, j| rational(rows[i][j]))
}

#[test]
fn a_matrix_is_a_root_of_its_characteristic_polynomial() {
    // Symbolic: Cayley and Hamilton, for all 3 × 3 matrices.
    let a = Matrix3::<Unknown>::from_fn(|i, j| unknown(&format!("a{i}{j}")));
    let coefficients = characteristic_polynomial(&rows_of(&a));
    let mut sum = Matrix3::<Unknown>::zeros();
    for coefficient in coefficients.iter().rev() {
        sum = sum * &a + Matrix3::identity() * coefficient.clone();
    }
    assert_eq!(sum, Matrix3::zeros());
    assert_eq!(coefficients[3], Unknown::one());
}

#[test]
fn the_schur_cohn_test_knows_where_roots_are() {
    // Polynomials from their roots, so that the answer is known: pairs re ± i·im and reals, among them some very near the circle.
    let roots = [
        "0",
        "1/2",
        "-9/10",
        "999999/1000000",
        "1",
        "-1",
        "1000001/1000000",
        "-3",
    ];
    let pairs = [("3/5", "3/5"), ("-3/5", "4/5"), ("3/5", "81/100"), ("0", "99/100")];
    let times = |p: &[Rational], q: &[Rational]| {
        let mut product = vec![Rational::zero(); p.len() + q.len() - 1];
        for (i, a) in p.iter().enumerate() {
            for (j, b) in q.iter().enumerate() {
                product[i + j] += a.clone() * b.clone();
            }
        }
        product
    };
    let mut inside_and_outside = [0, 0];
    for (first, (re, im)) in roots.iter().flat_map(|root| pairs.iter().map(move |pair| (root, pair))) {
        for second in roots {
            let (first, second, re, im) = (rational(first), rational(second), rational(re), rational(im));
            let square = re.clone() * re.clone() + im.clone() * im.clone();
            let pair = [square.clone(), -(re.clone() + re), Rational::one()];
            let of_real = |root: &Rational| [-root.clone(), Rational::one()];
            let polynomial = times(&times(&pair, &of_real(&first)), &of_real(&second));
            let expected = square < Rational::one() && first.abs() < Rational::one() && second.abs() < Rational::one();
            assert_eq!(is_stable_polynomial(&polynomial), Some(expected));
            inside_and_outside[usize::from(expected)] += 1;
        }
    }
    assert!(
        inside_and_outside.iter().all(|count| *count > 30),
        "both answers are given"
    );
    // With a bound: the spectral radius of a rotation by half its length is one half.
    let rotation = vec![
        vec![rational("0"), rational("-1/2")],
        vec![rational("1/2"), rational("0")],
    ];
    assert_eq!(has_radius_below(&rotation, &rational("1/2")), Some(false));
    assert_eq!(has_radius_below(&rotation, &rational("500001/1000000")), Some(true));
    // On enclosures that straddle the circle there is no answer.
    Enclosure::with_precision(64, || {
        let unsure = Enclosure::around(1.0, 1e-9);
        assert_eq!(is_stable_polynomial(&[unsure, Enclosure::integer(1)]), None);
    });
}

#[test]
fn elimination_solves_what_can_be_solved() {
    // A zero in the first place, so that rows must be exchanged.
    let matrix = rationals([["0", "2", "1"], ["3", "1/2", "0"], ["1", "1", "-1/3"]]);
    let solution = solve(rows_of(&matrix), rows_of(&SMatrix::<Rational, 3, 3>::identity())).unwrap();
    let inverse = SMatrix::<Rational, 3, 3>::from_fn(|i, j| solution[i][j].clone());
    assert_eq!(matrix * inverse, Matrix3::identity());
    let singular = rationals([["1", "2"], ["2", "4"]]);
    assert_eq!(
        solve(rows_of(&singular), rows_of(&SMatrix::<Rational, 2, 2>::identity())),
        None
    );
}

#[test]
fn the_stein_equation_is_solved_exactly() {
    let a = rationals([["1/2", "-1", "0"], ["1/3", "1/5", "2"], ["0", "-1/7", "1/4"]]);
    let c = rationals([["1", "2", "0"], ["2", "-3", "1/2"], ["0", "1/2", "5"]]);
    let x = stein(&a, &c).unwrap();
    assert_eq!(&a * &x * a.transpose() + &c, x);
    assert_eq!(x, x.transpose());
    // Two eigenvalues whose product is one: no solution, or many.
    let a = rationals([["2", "0"], ["0", "1/2"]]);
    assert_eq!(stein(&a, &SMatrix::identity()), None);
}

/// Exact: what is not seen has a polynomial of its own, whatever coordinates the state is written in. Here the hidden parts are those of a
/// diagonal motion, and the coordinates T have no ones to divide by.
#[test]
fn what_is_not_seen_does_not_depend_on_the_coordinates() {
    let motion = rationals([["1/2", "0", "0"], ["0", "3", "0"], ["0", "0", "-5"]]);
    let coordinates = rationals([["2", "3", "1"], ["-4", "5", "7"], ["3", "-2", "6"]]);
    let inverse = solve(rows_of(&coordinates), rows_of(&SMatrix::<Rational, 3, 3>::identity())).unwrap();
    let inverse = SMatrix::<Rational, 3, 3>::from_fn(|i, j| inverse[i][j].clone());
    assert_eq!(coordinates.clone() * &inverse, SMatrix::<Rational, 3, 3>::identity());
    let turned = &coordinates * motion * &inverse;
    for (sensor, unseen) in [
        ([["7", "0", "0"]], "λ^2 + 2λ − 15"),
        ([["0", "2", "0"]], "λ^2 + 9/2λ − 5/2"),
        ([["3", "2", "0"]], "λ + 5"),
        ([["3", "0", "2"]], "λ − 3"),
        ([["3", "2", "-4"]], "1"),
    ] {
        let sensor = rationals::<1, 3>(sensor) * &inverse;
        assert_eq!(
            polynomial_text(&unseen_part(&rows_of(&turned), &rows_of(&sensor))),
            unseen
        );
    }
}

#[test]
fn what_is_not_seen_and_does_not_decay_is_named() {
    let part = |motion, sensor: [[&str; 3]; 1]| {
        let sensor = rationals(sensor);
        polynomial_text(&unseen_part(&rows_of(&rationals::<3, 3>(motion)), &rows_of(&sensor)))
    };
    let acceleration = [["1", "1", "1/2"], ["0", "1", "1"], ["0", "0", "1"]];
    assert_eq!(part(acceleration, [["1", "0", "0"]]), "1");
    // Measured velocity never shows the position, measured acceleration neither of the two.
    assert_eq!(part(acceleration, [["0", "1", "0"]]), "λ − 1");
    assert_eq!(part(acceleration, [["0", "0", "1"]]), "λ^2 − 2λ + 1");
    assert_eq!(part(acceleration, [["0", "0", "0"]]), "λ^3 − 3λ^2 + 3λ − 1");
    // The embedded acceleration of constant velocity is not seen, and decays at once.
    assert_eq!(
        part([["1", "1", "0"], ["0", "1", "0"], ["0", "0", "0"]], [["1", "0", "0"]]),
        "λ"
    );
    // A polynomial that is zero is written as zero, and a one without an unknown is not left out.
    assert_eq!(polynomial_text(&[Rational::zero()]), "0");
    assert_eq!(polynomial_text(&["1", "0", "-1"].map(rational)), "−λ^2 + 1");
}

// The Riccati equation (exact)

/// A filter of one position with constant velocity or acceleration, from decimals.
fn coordinate(motion: Matrix3<Rational>, response: &Vector3<Rational>, q: &str, r: &str) -> Riccati<Rational, 3, 1> {
    Riccati {
        transition: motion,
        measurement: position_matrix(),
        noise: response_noise(response, &rational(q)),
        measurement_noise: Matrix1::new(rational(r)),
    }
}

#[test]
fn doubling_and_recursion_have_the_same_limit() {
    let t = rational("2");
    let problem = coordinate(constant_acceleration(&t), &acceleration_response(&t), "5", "1/20");
    // Three doublings from Q are eight steps of the recursion from Q.
    let mut predicted = problem.noise.clone();
    for _ in 0..7 {
        predicted = problem.next(&predicted);
    }
    assert_eq!(problem.doubled(3), Some(predicted));
}

#[test]
fn a_steady_state_is_proven_by_two_bounds() {
    // The paper's noises, and tracking indices from 10⁻⁶ to 10⁶.
    for (q, r, t) in [
        ("5", "1/20", "2"),
        ("5", "1/2", "1"),
        ("1", "1000000000000", "1"),
        ("1000000000000", "1", "1"),
    ] {
        let t = rational(t);
        let velocity = coordinate(embedded_constant_velocity(&t), &embedded_velocity_response(&t), q, r);
        let acceleration = coordinate(constant_acceleration(&t), &acceleration_response(&t), q, r);
        let proven = [&velocity, &acceleration].map(|problem| {
            let proof = SteadyState::certify(problem, 400).unwrap();
            proof.check(problem).unwrap();
            Enclosure::with_precision(300, || proof.gain(problem))
        });
        // The closed forms, from the same noises, agree to the last digit that the bounds determine.
        let closed = Enclosure::with_precision(300, || {
            let number = |value: &Rational| Enclosure::rational(value);
            let index = gains::tracking_index(&number(&rational(q)), &number(&rational(r)), &number(&t));
            [
                gains::alpha_beta_gain(&gains::alpha_beta_root(&index), &number(&t)),
                gains::alpha_beta_gamma_gain(&gains::alpha_beta_gamma_root(&index), &number(&t)),
            ]
        });
        for (proven, closed) in proven.iter().flatten().zip(closed.iter().flatten()) {
            let difference = Enclosure::with_precision(300, || proven.clone() - closed.clone());
            assert!(
                difference.contains(&Rational::zero()),
                "{q}, {r}: {proven} and {closed}"
            );
            assert!(difference.width() < 1e-40, "{q}, {r}: {difference}");
        }
    }
}

/// Exact, and compared in doubles: U − L is 2ε W with the Lyapunov matrix W = A W Aᵀ + I of the closed loop between them, A = F(I − KH),
/// and ε = 2^(−bits/2) of one more than the greatest entry.
#[test]
fn the_bounds_of_a_steady_state_are_as_far_apart_as_is_said() {
    let t = rational("2");
    for (q, r, bits) in [("5", "1/20", 60), ("1/1000", "3", 100), ("40", "1/1000", 200)] {
        let problem = coordinate(constant_acceleration(&t), &acceleration_response(&t), q, r);
        let SteadyState { lower, upper } = SteadyState::certify(&problem, bits).unwrap();
        let middle = (&lower + &upper) * Rational::new(1, 2);
        let greatest = middle.iter().map(|entry| entry.abs().to_f64()).fold(0.0, f64::max);
        let unit = (upper - lower).map(|entry| (entry * Rational::integer(2).pow(bits / 2)).to_f64());
        let shape = unit / (2.0 * (greatest + 1.0));
        let kept = Matrix3::identity() - problem.gain(&middle) * &problem.measurement;
        let a = (&problem.transition * kept).map(|entry| entry.to_f64());
        let left_over = shape - a * shape * a.transpose() - Matrix3::identity();
        // The middle is off by as much as the bounds are apart, 2⁻³⁰, and so are W and the distance; beside the size of W.
        assert!(left_over.abs().max() < 1e-8 * shape.abs().max(), "{q} {r}: {left_over}");
    }
}

#[test]
fn a_spoilt_bound_proves_nothing() {
    let t = rational("2");
    let problem = coordinate(constant_acceleration(&t), &acceleration_response(&t), "5", "1/20");
    let proof = SteadyState::certify(&problem, 100).unwrap();
    let inequality = |proof: &SteadyState<3>| match proof.check(&problem) {
        Err(NoSteadyState::Inequality { inequality, .. }) => inequality,
        other => panic!("{other:?}"),
    };
    // The bounds exchanged, one taken for both, and each moved over the solution.
    let exchanged = SteadyState {
        lower: proof.upper.clone(),
        upper: proof.lower.clone(),
    };
    assert_eq!(inequality(&exchanged), "f(L) − L ≻ 0");
    let collapsed = SteadyState {
        upper: proof.lower.clone(),
        ..proof.clone()
    };
    assert_eq!(inequality(&collapsed), "U − L ≻ 0");
    let width = &proof.upper - &proof.lower;
    let too_high = SteadyState {
        lower: &proof.lower + &width,
        upper: &proof.upper + &width,
    };
    assert_eq!(inequality(&too_high), "f(L) − L ≻ 0");
    let too_low = SteadyState {
        lower: &proof.lower - &width,
        upper: &proof.upper - &width,
    };
    assert_eq!(inequality(&too_low), "U − f(U) ≻ 0");
    // A filter that is not this one.
    let other = coordinate(constant_acceleration(&t), &acceleration_response(&t), "5", "1/2");
    assert!(proof.check(&other).is_err());
}

/// Exact: every entry of a covariance between the bounds is inside, those of the bounds themselves among them. U − L is of rank one, so
/// that no entry off the diagonal could be greater, and of entries of very different size.
#[test]
fn an_entry_of_the_steady_state_has_room_for_both_bounds() {
    let lower = rationals([["1", "1/3"], ["1/3", "1"]]);
    for direction in [["2", "1"], ["-1", "1000"], ["1/3", "-1/7"]] {
        let direction = rationals([direction]);
        let upper = &lower + direction.transpose() * &direction;
        let bounds = SteadyState {
            lower: lower.clone(),
            upper: upper.clone(),
        };
        Enclosure::with_precision(100, || {
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let entry = bounds.entry(i, j);
                assert!(
                    entry.contains(&lower[(i, j)]) && entry.contains(&upper[(i, j)]),
                    "{i}, {j}: {entry}"
                );
            }
        });
    }
}

#[test]
fn known_examples_of_the_riccati_equation_are_solved() {
    // Benner, Laub and Mehrmann's collection of discrete examples, transposed into the filter's form. Their example 1 has an unstable
    // motion and the solution (1 + √5)/2 · [9 6; 6 4].
    let problem = Riccati {
        transition: rationals([["4", "-9/2"], ["3", "-7/2"]]),
        measurement: rationals([["1", "-1"]]),
        noise: rationals([["9", "6"], ["6", "4"]]),
        measurement_noise: Matrix1::new(Rational::one()),
    };
    let proof = SteadyState::certify(&problem, 300).unwrap();
    Enclosure::with_precision(300, || {
        let golden = (Enclosure::integer(1) + Enclosure::integer(5).sqrt()) / Enclosure::integer(2);
        for (i, j, factor) in [(0, 0, 9), (0, 1, 6), (1, 1, 4)] {
            let difference = proof.entry(i, j) - golden.clone() * Enclosure::integer(factor);
            assert!(
                difference.contains(&Rational::zero()) && difference.width() < 1e-40,
                "{difference}"
            );
        }
    });
    // Their example 2.3: F = [0 ε; 0 0]ᵀ with ε = 10⁶, so that the solution diag(1, 1 + ε²) has entries of very different size.
    let problem = Riccati {
        transition: rationals([["0", "0"], ["1000000", "0"]]),
        measurement: rationals([["0", "1"]]),
        noise: SMatrix::<Rational, 2, 2>::identity(),
        measurement_noise: Matrix1::new(Rational::one()),
    };
    let proof = SteadyState::certify(&problem, 300).unwrap();
    Enclosure::with_precision(300, || {
        for (i, value) in [(0, "1"), (1, "1000000000001")] {
            assert!(proof.entry(i, i).contains(&rational(value)), "{}", proof.entry(i, i));
        }
    });
    // A measurement noise of 10⁻¹² beside a motion that grows (as in their example 2.4), and one that is almost not detectable.
    for (epsilon, r) in [("1/1000000", "1/1000000000000"), ("1/1000", "1")] {
        let problem = Riccati {
            transition: rationals([["2", "0"], ["0", "1/2"]]),
            measurement: SMatrix::<Rational, 1, 2>::new(rational(epsilon), Rational::one()),
            noise: SMatrix::<Rational, 2, 2>::identity(),
            measurement_noise: Matrix1::new(rational(r)),
        };
        SteadyState::certify(&problem, 400).unwrap();
    }
}

#[test]
fn a_problem_without_a_steady_state_is_refused_with_its_reason() {
    let t = Rational::one();
    let motion = constant_acceleration(&t);
    let without_noise = coordinate(motion.clone(), &acceleration_response(&t), "0", "1");
    let error = SteadyState::certify(&without_noise, 100).unwrap_err();
    assert!(
        matches!(&error, NoSteadyState::NotStabilisable { polynomial } if polynomial == "λ^3 − 3λ^2 + 3λ − 1"),
        "{error}"
    );
    let mut unmeasured = coordinate(motion.clone(), &acceleration_response(&t), "1", "1");
    unmeasured.measurement = rationals([["0", "1", "0"]]);
    let error = SteadyState::certify(&unmeasured, 100).unwrap_err();
    assert!(
        matches!(&error, NoSteadyState::NotDetectable { polynomial } if polynomial == "λ − 1"),
        "{error}"
    );
    for (r, field) in [("0", "R"), ("-1", "R")] {
        let wrong = coordinate(motion.clone(), &acceleration_response(&t), "1", r);
        let error = SteadyState::certify(&wrong, 100).unwrap_err();
        assert!(
            matches!(&error, NoSteadyState::Invalid { field: f, .. } if *f == field),
            "{error}"
        );
    }
    let wrong = coordinate(motion.clone(), &acceleration_response(&t), "-1", "1");
    assert!(matches!(
        SteadyState::certify(&wrong, 100),
        Err(NoSteadyState::Invalid { field: "Q", .. })
    ));
    // Stabilisability is not necessary: a mode that no noise reaches and that grows is measured and so held; one on the circle is not.
    let held = |growth: &str| Riccati {
        transition: Matrix1::new(rational(growth)),
        measurement: Matrix1::new(Rational::one()),
        noise: Matrix1::new(Rational::zero()),
        measurement_noise: Matrix1::new(Rational::one()),
    };
    assert!(SteadyState::certify(&held("1"), 100).is_err());
    assert!(
        SteadyState {
            lower: Matrix1::new(rational("2")),
            upper: Matrix1::new(rational("4"))
        }
        .check(&held("2"))
        .is_ok()
    );
}

// One filter, and two (symbolic, exact)

#[test]
fn each_filter_by_itself_is_stable() {
    // Symbolic, for every damping root at once: λ² + bλ + c has both roots inside the circle exactly if its values at 1 and −1 are
    // positive and c is below one; these are the closed forms in the documentation, positive for 0 < θ < 1.
    let root = unknown("theta");
    let (one, rest) = (Unknown::one(), Unknown::one() - root.clone());
    let two_squares = Unknown::integer(2) * rest.clone() * rest;
    // λ p(λ)
    let [o, c, b, l] = characteristic_polynomial(&rows_of(&velocity_matrix(&root)))
        .try_into()
        .unwrap();
    assert_eq!((o, l), (Unknown::zero(), one.clone()));
    assert_eq!(one.clone() + b.clone() + c.clone(), two_squares);
    assert_eq!(one.clone() - b + c.clone(), Unknown::integer(4) * root.clone());
    assert_eq!(c, root.clone() * root.clone());
    // (λ − θ) p(λ) = λ³ + (b − θ)λ² + (c − θb)λ − θc
    let [last, middle, first, l] = characteristic_polynomial(&rows_of(&acceleration_matrix(&root)))
        .try_into()
        .unwrap();
    let (b, c) = (first + root.clone(), root.clone());
    assert_eq!((last, l), (-(root.clone() * c.clone()), one.clone()));
    assert_eq!(middle, c.clone() - root.clone() * b.clone());
    let sum = one.clone() + root.clone();
    assert_eq!((one.clone() + b.clone() + c.clone()) * sum.clone(), two_squares);
    assert_eq!((one - b + c) * sum, Unknown::integer(8) * root);
}

#[test]
fn a_product_of_two_stable_filters_is_unstable() {
    // By hand: θ = 3/4 for constant velocity and 1/6 for constant acceleration, that is q = 1/36 and 15625/441 with R = t = 1.
    let matrices = [velocity_matrix(&rational("3/4")), acceleration_matrix(&rational("1/6"))];
    let indices = [
        gains::alpha_beta_index(&rational("3/4")),
        gains::alpha_beta_gamma_index(&rational("1/6")),
    ];
    assert_eq!(indices, [rational("1/6"), rational("125/21")]);
    let expected = [
        rationals([["9/16", "9/16", "0"], ["-1/8", "7/8", "0"], ["0", "0", "0"]]),
        rationals([
            ["1/36", "1/36", "1/72"],
            ["-25/18", "-7/18", "11/36"],
            ["-125/126", "-125/126", "127/252"],
        ]),
    ];
    assert_eq!(matrices, expected);
    for matrix in &matrices {
        assert_eq!(has_radius_below(&rows_of(matrix), &rational("76/100")), Some(true));
    }
    // λ(64λ² + 71λ + 1)/64 is 6/64 at −1 and negative far below: a root below −1.
    let both = product(&[1, 0], &matrices);
    let polynomial = characteristic_polynomial(&rows_of(&both));
    assert_eq!(polynomial, ["0", "1/64", "71/64", "1"].map(rational));
    let growth = Product {
        word: vec![1, 0],
        radius: rational("109/100"),
    };
    growth.check(&matrices).unwrap();
    // The radius is −1.0951…: a bound above it is refused.
    let too_much = Product {
        radius: rational("110/100"),
        ..growth.clone()
    };
    assert_eq!(too_much.check(&matrices), Err(NotProven::Below { decided: true }));
    let nothing = Product {
        radius: Rational::one(),
        ..growth
    };
    assert!(matches!(nothing.check(&matrices), Err(NotProven::Radius { .. })));
    let other = Product {
        word: vec![0],
        radius: rational("109/100"),
    };
    assert_eq!(other.check(&matrices), Err(NotProven::Below { decided: true }));
    // A word has letters, and each is one of the matrices.
    for word in [Vec::new(), vec![2], vec![1, 2, 0]] {
        let radius = rational("109/100");
        assert_eq!(Product { word, radius }.check(&matrices), Err(NotProven::Word));
    }
}

#[test]
fn a_graph_has_only_nodes_and_letters_that_are_there() {
    let matrices = [Matrix3::<Rational>::zeros()];
    let graph = |edges: Vec<Edge>| Quadratics {
        edges,
        forms: vec![Matrix3::identity()],
    };
    let (from, letter, to) = (0, 0, 0);
    let good = Edge { from, letter, to };
    assert_eq!(graph(vec![good]).check(&matrices), Ok(()));
    for bad in [
        Edge { from: 1, ..good },
        Edge { letter: 1, ..good },
        Edge { to: 1, ..good },
    ] {
        assert_eq!(
            graph(vec![good, bad]).check(&matrices),
            Err(NotProven::Edge { edge: 1 })
        );
    }
}

/// Exact: forms that remember two letters stand at the words ab, and the letter c leads from ab to bc.
#[test]
fn a_graph_that_remembers_goes_from_the_last_letters_to_the_next_ones() {
    for letters in [2, 3] {
        let edges = Edge::memory(letters, 2);
        assert_eq!(edges.len(), letters.pow(3));
        for (a, b, c) in (0..letters).flat_map(|a| (0..letters).flat_map(move |b| (0..letters).map(move |c| (a, b, c))))
        {
            let expected = Edge {
                from: a * letters + b,
                letter: c,
                to: b * letters + c,
            };
            assert!(edges.contains(&expected), "{expected:?}");
        }
    }
}

#[test]
fn a_convex_combination_of_stable_matrices_is_unstable() {
    // The paper's sentence taken literally. Each has the one eigenvalue 1/2, their mean 11/2.
    let a = rationals([["1/2", "10"], ["0", "1/2"]]);
    let half = rational("1/2");
    let mean = remark_1_matrix(&[half.clone(), half], &[a.clone(), a.transpose()]);
    assert_eq!(mean, rationals([["1/2", "5"], ["5", "1/2"]]));
    assert_eq!(has_radius_below(&rows_of(&a), &rational("51/100")), Some(true));
    assert_eq!(has_radius_below(&rows_of(&mean), &rational("11/2")), Some(false));
}

/// Mixing probabilities of two modes, from the weight of the first in each.
fn mixing(first: [&str; 2]) -> Vec<Vec<Rational>> {
    first
        .map(|weight| vec![rational(weight), Rational::one() - rational(weight)])
        .to_vec()
}

/// Whether the criterion of remark 1 and the frozen criterion call two filters stable.
fn criteria<const N: usize>(mixing: &[Vec<Rational>], matrices: &[SMatrix<Rational, N, N>; 2]) -> (bool, bool) {
    let is_stable = |rows| has_radius_below(&rows, &Rational::one()) == Some(true);
    for matrix in matrices {
        assert!(is_stable(rows_of(matrix)), "each by itself");
    }
    let remark_1 = mixing
        .iter()
        .all(|row| is_stable(rows_of(&remark_1_matrix(row, matrices))));
    (remark_1, is_stable(frozen_matrix(mixing, matrices)))
}

#[test]
fn remark_1_calls_stable_what_is_not() {
    let nilpotent = [rationals([["0", "0"], ["1", "0"]]), rationals([["0", "2"], ["0", "0"]])];
    assert_eq!(criteria(&mixing(["1/4", "3/4"]), &nilpotent), (true, false));
    // With the paper's chain, p = 0.95/0.05 and equal probabilities, three states are enough.
    let three = [
        rationals([["1/2", "0", "0"], ["-5", "-1/2", "-7/2"], ["-7", "0", "1/2"]]),
        rationals([["1/2", "1/2", "1"], ["0", "1/2", "0"], ["1/2", "2", "-1/2"]]),
    ];
    assert_eq!(criteria(&mixing(["19/20", "1/20"]), &three), (true, false));
    // And two filters of this paper under a chain that changes its mode nineteen times in twenty.
    let filters = [
        velocity_matrix(&rational("9/10")),
        acceleration_matrix(&rational("1/10")),
    ];
    assert_eq!(criteria(&mixing(["1/20", "19/20"]), &filters), (true, false));
}

#[test]
fn remark_1_calls_unstable_what_is_stable() {
    let nilpotent = |c| [rationals([["0", "0"], ["1", "0"]]), rationals([["0", c], ["0", "0"]])];
    assert_eq!(criteria(&mixing(["3/4", "1/4"]), &nilpotent("8")), (false, true));
    // With the paper's chain and equal probabilities.
    assert_eq!(criteria(&mixing(["19/20", "1/20"]), &nilpotent("25")), (false, true));
}

#[test]
fn the_frozen_matrix_carries_the_errors_of_the_filter() {
    let filters = [velocity_matrix(&rational("1/3")), acceleration_matrix(&rational("1/2"))];
    let mixing = mixing(["5/7", "1/9"]);
    let errors = [rationals([["1"], ["-2"], ["3"]]), rationals([["4"], ["0"], ["-1/2"]])];
    let joint = frozen_matrix(&mixing, &filters);
    for j in 0..2 {
        let mixed = &errors[0] * mixing[j][0].clone() + &errors[1] * mixing[j][1].clone();
        let after = &filters[j] * mixed;
        for row in 0..3 {
            let by_row = (0..6).fold(Rational::zero(), |sum, k| {
                sum + joint[3 * j + row][k].clone() * errors[k / 3][k % 3].clone()
            });
            assert_eq!(by_row, after[row]);
        }
    }
}

// Certificates (exact, enclosed)

#[test]
fn a_common_form_proves_stability_and_a_spoilt_one_does_not() {
    let filters = Filters::Roots([rational("1/3"), rational("1/2")]);
    let form = rationals([["12", "-2", "-2"], ["-2", "7", "-6"], ["-2", "-6", "20"]]);
    let proof = Quadratics {
        edges: Edge::memory(2, 0),
        forms: vec![form.clone()],
    };
    filters.check_stable(&proof).unwrap();
    assert_eq!(rows_text(&proof.forms[0]), "[12 -2 -2; -2 7 -6; -2 -6 20]");
    let spoilt = |change: &dyn Fn(&mut Quadratics)| {
        let mut proof = proof.clone();
        change(&mut proof);
        filters.check_stable(&proof).unwrap_err()
    };
    assert!(matches!(
        spoilt(&|p| p.forms[0][(0, 1)] = rational("2")),
        NotProven::Form { .. }
    ));
    let indefinite = spoilt(&|p| p.forms[0][(2, 2)] = rational("1"));
    assert!(matches!(indefinite, NotProven::Form { .. }), "{indefinite}");
    let growing = spoilt(&|p| p.forms[0][(2, 2)] = rational("200"));
    assert!(matches!(growing, NotProven::Decrease { edge: 0 | 1, .. }), "{growing}");
    assert_eq!(
        spoilt(&|p| {
            p.edges.pop();
        }),
        NotProven::Incomplete { node: 0, letter: 1 }
    );
    assert_eq!(spoilt(&|p| p.edges[1].to = 1), NotProven::Edge { edge: 1 });
    assert_eq!(spoilt(&|p| p.forms.clear()), NotProven::Edge { edge: 0 });
    assert!(
        spoilt(&|p| {
            p.forms.clear();
            p.edges.clear();
        })
        .to_string()
        .contains("not complete")
    );
    // It proves nothing about other filters.
    let others = Filters::Roots([rational("3/4"), rational("1/6")]);
    assert!(others.check_stable(&proof).is_err());
}

#[test]
fn whatever_is_decided_is_proven() {
    // A common form, forms with memory, a short product and a long one.
    let cases = [
        ("1/3", "1/2", 1, 0),
        ("4/5", "2/5", 2, 0),
        ("3/4", "1/6", 0, 3),
        ("967/1000", "3/4", 0, 20),
    ];
    for (v, a, forms, letters) in cases {
        let filters = Filters::Roots([rational(v), rational(a)]);
        match filters.decide(Depth::default()) {
            StabilityVerdict::Stable(found) => {
                filters.check_stable(&found).unwrap();
                assert_eq!(found.forms.len(), forms, "{v} {a}");
            }
            StabilityVerdict::Unstable(found) => {
                filters.check_unstable(&found).unwrap();
                assert_eq!(found.word.len(), letters, "{v} {a}");
                let written = word_text(&found.word);
                assert!(
                    written.starts_with("vv") && written.ends_with('a') && written.len() == letters,
                    "{written}"
                );
            }
            StabilityVerdict::Undecided { growth } => panic!("{v} {a}: {growth}"),
        }
    }
}

/// Exact: the joint spectral radius of two numbers is the greater magnitude, that of two shears that undo nothing is the golden ratio.
#[test]
fn the_joint_spectral_radius_is_between_its_bounds() {
    let number = |text: &str| SMatrix::<Rational, 1, 1>::new(rational(text));
    let shears = [rationals([["1", "1"], ["0", "1"]]), rationals([["1", "0"], ["1", "1"]])];
    let bounds = |loops: ClosedLoops<Const<1>>| {
        let found = loops.bounds(Depth::default(), &loops.decide(Depth::default()));
        (found.below, found.above.unwrap().0)
    };
    for (a, b, radius) in [("1/2", "-3/4", "3/4"), ("5/4", "-2", "2"), ("0", "1/3", "1/3")] {
        let (below, above) = bounds(ClosedLoops::new(Entries::Exact(vec![number(a), number(b)])));
        let radius = rational(radius);
        assert!(below <= radius && radius < above, "{below} {above}");
        assert!((above - below).to_f64() < 2e-3 * radius.to_f64() + 2e-4);
    }
    let loops = ClosedLoops::new(Entries::Exact(shears.to_vec()));
    let found = loops.bounds(Depth::default(), &loops.decide(Depth::default()));
    // ((1 + √5)/2 = 1.618…)
    assert_eq!(found.below, rational("1.618"));
    let (rate, forms) = found.above.unwrap();
    assert!(rate > rational("1.618") && rate < rational("1.63"), "{rate}");
    // What is said of the rate is what the forms prove, and a rate below the radius is not proven by them.
    loops.check_rate(&forms, &rate).unwrap();
    assert!(loops.check_rate(&forms, &rational("1.618")).is_err());
    assert_eq!(
        loops.is_radius_below(&found.word, &rational("1.618").pow(2)),
        Some(false)
    );
    assert_eq!(
        loops.is_radius_below(&found.word, &rational("1.6181").pow(2)),
        Some(true)
    );
}

/// Exact: a word counts only if the chain can repeat it.
#[test]
fn a_product_that_the_chain_does_not_allow_proves_nothing() {
    let filters = Filters::Roots([rational("3/4"), rational("1/6")]);
    let mut loops = filters.closed_loops();
    assert!(matches!(loops.decide(Depth::default()), StabilityVerdict::Unstable(_)));
    // From acceleration there is no way back to velocity.
    loops.follows[1][0] = false;
    let StabilityVerdict::Undecided { growth } = loops.decide(Depth::default()) else {
        panic!("only words of one letter can be repeated, and each of them shrinks")
    };
    assert!(growth < 1.0);
}

/// Exact: at every corner of the box around C, and so that the slack is no greater than the worst that its formula covers.
#[test]
fn a_proof_by_hand_holds_for_every_matrix_within_its_distance() {
    let filters = Filters::of_noises(&rational("2"), &rational("0.05"), [rational("5"), rational("5")]);
    let loops = filters.closed_loops();
    let form = rationals([["50", "21", "-1"], ["21", "12", "-1"], ["-1", "-1", "1"]]);
    let proof = Quadratics {
        edges: Edge::memory(2, 0),
        forms: vec![form.clone()],
    };
    let by_hand = ByHand::new(&loops, &proof).unwrap();
    assert!(by_hand.distance.is_positive());
    for found in &by_hand.edges {
        let c = &by_hand.matrices[found.edge.letter];
        assert!(found.pivots.iter().all(Rational::is_positive));
        for corner in 0..1 << 9_u32 {
            let a = Matrix3::from_fn(|i, j| {
                let sign = if corner >> (3 * i + j) & 1 == 1 { "1" } else { "-1" };
                c[(i, j)].clone() + by_hand.distance.clone() * rational(sign)
            });
            let decrease = &form - a.transpose() * &form * &a;
            // Above what was printed, and so positive definite.
            let printed = Matrix3::from_fn(|i, j| found.matrix[(i, j)].clone());
            assert!(is_positive_semidefinite(&(&decrease - printed)), "corner {corner}");
            assert!(is_positive_definite(&decrease), "corner {corner}");
        }
    }
    // Fractions of few digits need no distance, and a form that proves nothing has no proof.
    let exact = Filters::Roots([rational("1/3"), rational("1/2")]).closed_loops();
    let proof = Quadratics {
        edges: Edge::memory(2, 0),
        forms: vec![rationals([["12", "-2", "-2"], ["-2", "7", "-6"], ["-2", "-6", "20"]])],
    };
    assert_eq!(ByHand::new(&exact, &proof).unwrap().distance, rational("0"));
    let unstable = Filters::Roots([rational("3/4"), rational("1/6")]).closed_loops();
    assert_eq!(ByHand::new(&unstable, &proof), None);
}

// Certificates as files (exact, enclosed)

fn certificate_files() -> Vec<(String, String)> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/certificates");
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .map(|path| {
            (
                path.file_name().unwrap().to_string_lossy().into_owned(),
                std::fs::read_to_string(path).unwrap(),
            )
        })
        .collect();
    files.sort();
    files
}

#[test]
fn the_paper_s_filters_are_certified_stable() {
    let mut stable = 0;
    for (name, text) in certificate_files() {
        let proven = CertificateFile::read(&text).unwrap().check().unwrap();
        assert_eq!(
            matches!(proven, StabilityVerdict::Stable(_)),
            !name.starts_with("unstable"),
            "{name}"
        );
        stable += usize::from(name.starts_with("derbez2000.t"));
    }
    // t = 1 and 2, R = 0.05 and 0.5, q = 5.
    assert_eq!(stable, 4);
}

#[test]
fn a_spoilt_certificate_is_refused() {
    for (name, text) in certificate_files() {
        // One digit changed, wherever it stands in the filters, the proof or the digest.
        let numbers = text.find("\"filters\"").unwrap()..text.len();
        for at in numbers.filter(|at| text.as_bytes()[*at].is_ascii_digit()) {
            let other = if &text[at..=at] == "7" { "8" } else { "7" };
            let spoilt = format!("{}{other}{}", &text[..at], &text[at + 1..]);
            let refused = CertificateFile::read(&spoilt);
            assert!(
                matches!(
                    refused,
                    Err(InvalidCertificate::Changed { .. } | InvalidCertificate::Json(_))
                ),
                "{name}, byte {at}: {refused:?}"
            );
        }
    }
    // With a digest made to fit, the proof itself is refused: a wrong form, filters it is not about, a bound too high.
    let read = |name: &str| {
        let files = certificate_files();
        let (_, text) = files.iter().find(|(own, _)| own == name).unwrap();
        CertificateFile::read(text).unwrap()
    };
    let reason = |file: &CertificateFile| file.check().unwrap_err().to_string();
    let mut form = read("derbez2000.t2.r0.05.json");
    let ProofFile::Stable { forms, .. } = &mut form.proof else {
        panic!("a stable pair")
    };
    forms[0][0][0] = "30".to_owned();
    assert!(reason(&form).contains("is not positive definite"), "{}", reason(&form));
    let mut filters = read("derbez2000.t2.r0.05.json");
    filters.filters = FiltersFile::DampingRoots(["3/4", "1/6"].map(str::to_owned));
    assert!(reason(&filters).contains("proves nothing"), "{}", reason(&filters));
    let mut bound = read("unstable.three-quarters-and-one-sixth.json");
    let ProofFile::Unstable { radius, .. } = &mut bound.proof else {
        panic!("an unstable pair")
    };
    *radius = "15/10".to_owned();
    assert!(reason(&bound).contains("is below"), "{}", reason(&bound));
}

#[test]
fn a_certificate_that_is_none_gets_a_sentence() {
    let good = certificate_files()[0].1.clone();
    for (from, to, reason) in [
        (
            "immaculate-certificate/1",
            "immaculate-certificate/2",
            "is `immaculate-certificate/2`",
        ),
        ("\"about\"", "\"abuot\"", "is not a certificate"),
        ("{", "", "is not a certificate"),
    ] {
        let error = CertificateFile::read(&good.replacen(from, to, 1))
            .unwrap_err()
            .to_string();
        assert!(error.contains(reason), "{error}");
    }
    let noises = |interval: &str, measurement: &str, q: &str| Noises {
        interval: interval.to_owned(),
        measurement: measurement.to_owned(),
        constant_velocity: q.to_owned(),
        constant_acceleration: "5".to_owned(),
    };
    for (wrong, reason) in [
        (
            noises("0", "1", "1"),
            "`interval` is 0: it must be positive, since the filters need a time",
        ),
        (
            noises("1", "-1", "1"),
            "since without measurement noise the innovation is not weighed",
        ),
        (noises("1", "1", "0"), "there is no steady state that stabilises"),
        (noises("1", "1e300", "1"), "is its unit right"),
        (noises("1e-30", "1", "1"), "is its unit right"),
        (noises("one", "1", "1"), "no decimal and no fraction"),
        (noises("1/0", "1", "1"), "no decimal and no fraction"),
    ] {
        let error = wrong.filters().unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
    }
    for roots in [["0", "1/2"], ["1/2", "1"], ["-1/2", "1/2"], ["x", "1/2"]] {
        assert!(
            FiltersFile::DampingRoots(roots.map(str::to_owned)).filters().is_err(),
            "{roots:?}"
        );
    }
}

/// Exact: the greatest that is read and the least that is not. A proof as large as that is refused for another reason: it is none.
#[test]
fn a_certificate_has_no_more_of_anything_than_is_ever_written() {
    let read = |name: &str| {
        let (_, text) = certificate_files().into_iter().find(|(own, _)| own == name).unwrap();
        CertificateFile::read(&text).unwrap()
    };
    let (stable, unstable) = (
        read("derbez2000.t2.r0.05.json"),
        read("unstable.three-quarters-and-one-sixth.json"),
    );
    let refused = |proof: ProofFile| {
        let file = CertificateFile {
            proof,
            ..stable.clone()
        };
        file.check().unwrap_err().to_string()
    };
    let ProofFile::Stable { edges, forms } = &stable.proof else {
        panic!("a stable pair")
    };
    let with = |edge_count: usize, form_count: usize| ProofFile::Stable {
        edges: edges.iter().cycle().take(edge_count).copied().collect(),
        forms: forms.iter().cycle().take(form_count).cloned().collect(),
    };
    let ProofFile::Unstable { radius, .. } = &unstable.proof else {
        panic!("an unstable pair")
    };
    let of_letters = |count: usize| ProofFile::Unstable {
        word: "v".repeat(count),
        radius: radius.clone(),
    };
    for (largest, too_large, reason) in [
        (with(2, 256), with(2, 257), "has more than 256 forms"),
        (with(512, 2), with(513, 2), "has more than 512 edges"),
        (of_letters(128), of_letters(129), "has more than 128 letters"),
    ] {
        assert!(!refused(largest).contains("has more than"), "{reason}");
        assert!(refused(too_large).contains(reason), "{reason}");
    }
    // Numerator and denominator together have 1024 bits, and 1025.
    let power = |bits: u32| Rational::integer(2).pow(bits).to_string();
    for text in [power(1022), format!("1/{}", power(1022))] {
        assert!(read_number("radius", &text).is_ok(), "{text}");
    }
    for text in [power(1023), format!("1/{}", power(1023)), format!("-{}", power(1030))] {
        let error = read_number("radius", &text).unwrap_err().to_string();
        assert!(error.contains("it has too many digits"), "{error}");
    }
}

#[test]
fn the_map_is_certified_but_for_a_few_points() {
    // Exact: every verdict on the map was checked; here a coarse map is checked again.
    let map = Map::new(9, [-2.0, 2.0], Depth::default(), &|| ());
    let [stable, unstable, undecided] = map.counts();
    assert_eq!(stable + unstable + undecided, 81);
    assert!(
        stable > 40 && unstable > 20 && undecided <= 2,
        "{stable} {unstable} {undecided}"
    );
    for point in map.points.iter().flatten() {
        let filters = Filters::Roots(point.roots.clone());
        match &point.verdict {
            StabilityVerdict::Stable(forms) => filters.check_stable(forms).unwrap(),
            StabilityVerdict::Unstable(product) => filters.check_unstable(product).unwrap(),
            StabilityVerdict::Undecided { growth } => assert!(*growth < 1.0, "{growth}"),
        }
        // Constant probabilities are one of the ways in which probabilities can be.
        let is_stable = matches!(point.verdict, StabilityVerdict::Stable(_));
        assert!(!is_stable || point.frozen_radius < 1.0);
    }
}

// What the paper states and does not hold (exact, enclosed), and what its filters do

#[test]
fn the_mixed_covariances_of_the_theorem_s_instance_grow() {
    // Exact. Each filter by itself: observable, nilpotent, and with a certified steady state.
    for model in instances::growing_mixture::<Rational>() {
        assert_eq!(
            unseen_part(&rows_of(&model.transition), &rows_of(&model.measurement)),
            [Rational::one()]
        );
        let f = &model.transition;
        assert_eq!(f * f * f, Matrix3::zeros());
        let steady = SteadyState::certify(&model, 100).unwrap();
        let a = Enclosure::with_precision(100, || model.map(Enclosure::rational).closed_loop(&steady.gain(&model)));
        Enclosure::with_precision(100, || {
            assert_eq!(has_radius_below(&rows_of(&a), &Enclosure::ratio(1, 100)), Some(true));
        });
    }
    let mixed = instances::mixed_covariances(12);
    let traces: Vec<Rational> = mixed.iter().take(4).map(SMatrix::trace).collect();
    assert_eq!(traces, ["3", "155/4", "187853/1810", "26937143/122200"].map(rational));
    for pair in mixed.windows(2) {
        assert_eq!(
            pair[1][(1, 1)],
            pair[0][(1, 1)].clone() * rational("9/5") + rational("86/5")
        );
    }
    // The filter as it is run: the same covariances whatever is measured. 10⁻⁹: some forty steps of rounding in entries up to 10¹¹.
    let mut filter = instances::growing_filter().unwrap();
    for (n, expected) in (0..).zip(&mixed) {
        let step = filter.step(Some(&Matrix1::new(f64::from(n % 5) * 3.0 - 7.0))).unwrap();
        assert!((step.mode_probabilities[0] - 0.5).abs() < 1e-9);
        let spread_free = expected.map(|entry| entry.to_f64());
        assert!(step.mixed[0].covariance.trace() >= spread_free.trace() * (1.0 - 1e-9));
    }
}

#[test]
fn the_full_filter_comes_to_a_local_instability() {
    // Enclosed: the whole run, and the Schur-Cohn test of (I − KH)F.
    let gain = instances::gain_after_a_jump().unwrap();
    assert!(instances::is_locally_unstable(&gain, &rational("6/5")));
    assert!(!instances::is_locally_unstable(&gain, &rational("5/4")));
}

#[test]
fn two_copies_that_see_the_same_data_part() {
    // Enclosed. A millimetre that were forgotten would shrink; it grows by 1.02953⁵⁰ = 4.28 in a hundred steps.
    let distances = instances::distances_of_two_copies(300).unwrap();
    assert!(
        distances[0] > 1e-3 && distances.windows(2).all(|pair| pair[1] > 4.0 * pair[0]),
        "{distances:?}"
    );
}

/// Statistical: with noise of a thousandth of what the gains are made for all copies have parted after 300 steps, with three times of it
/// none. Seeds are fixed: no false alarm.
#[test]
fn noise_takes_two_copies_off_the_path_on_which_they_part() {
    let runs = 20;
    assert_eq!(instances::copies_apart(1e-3, runs).unwrap()[0], runs);
    assert_eq!(instances::copies_apart(3.0, runs).unwrap(), [0, 0]);
}

#[test]
fn a_certified_filter_may_lock_into_the_wrong_mode() {
    // Property, in doubles: the bias of the constant velocity filter is (−5/2, −10, −20) exactly, the other copy is off by less than a
    // hundredth; the difference is far beyond any rounding.
    let certified = Filters::Roots([rational("1/3"), rational("1/2")]);
    assert!(matches!(
        certified.decide(Depth::default()),
        StabilityVerdict::Stable(_)
    ));
    let [locked, free] = instances::locked_errors(300).unwrap();
    assert!((locked - Vector3::new(-2.5, -10.0, -20.0)).norm() < 1e-6, "{locked}");
    assert!(free.norm() < 1e-2, "{free}");
}

#[test]
fn a_measurement_of_the_whole_state_bounds_the_mixed_covariances() {
    // Property: the inequality of each step of the proof beside `growing_mixture`, on sixty random systems of two modes, thirty steps each,
    // with models that are not true. It is an inequality of exact numbers; 10⁻⁹ is far above the rounding of matrices of condition 10⁴.
    let mut generator = Generator::new(2000, 11);
    let mut within = |size: f64| size * (2.0 * generator.uniform() - 1.0);
    let mut needed = 0;
    for _ in 0..60 {
        let square = |within: &mut dyn FnMut(f64) -> f64, size: f64| Matrix2::from_fn(|_, _| within(size));
        let mut definite = |size: f64| {
            let root = square(&mut within, size);
            root * root.transpose() + Matrix2::identity() * (0.1 * size)
        };
        let (q, r) = ([definite(1.0), definite(1.0)], definite(0.5));
        let f = [square(&mut within, 1.5), square(&mut within, 1.5)];
        let h = square(&mut within, 1.0) + Matrix2::identity() * 2.0;
        let mode = |j: usize| Mode {
            name: format!("model {j}"),
            motion: Motion::Linear(f[j]),
            noise: q[j],
        };
        let problem = Problem {
            modes: vec![mode(0), mode(1)],
            chain: vec![vec![0.95, 0.05], vec![0.05, 0.95]],
            sensor: Sensor::Linear(h),
            measurement_noise: r,
            filters: vec![Filter::kalman()],
            interaction: Interaction::Imm,
            angles: vec![],
        };
        let estimate = Gaussian {
            mean: Vector2::zeros(),
            covariance: Matrix2::identity(),
        };
        let initial = Initial {
            modes: vec![estimate; 2],
            mode_probabilities: vec![0.5, 0.5],
        };
        let mut filter = Imm::new(problem, &initial).unwrap();
        let inverse = |matrix: &Matrix2<f64>| matrix.try_inverse().unwrap();
        let form =
            |matrix: &Matrix2<f64>, vector: &Vector2<f64>| (vector.transpose() * inverse(matrix) * vector)[(0, 0)];
        // c: F P Fᵀ ⪯ c Q for all P ⪯ C; a trace is no less than the greatest eigenvalue.
        let c_matrix = inverse(&(h.transpose() * inverse(&r) * h));
        let c = [0, 1]
            .map(|j| (inverse(&q[j]) * f[j] * c_matrix * f[j].transpose()).trace())
            .into_iter()
            .fold(0.0, f64::max);
        let mut truth = Vector2::new(within(1.0), within(1.0));
        let mut before = f64::INFINITY;
        for _ in 0..30 {
            let next = Vector2::new(within(1.0), within(1.0));
            let mismatch = [0, 1]
                .map(|j| form(&q[j], &(f[j] * truth - next)))
                .into_iter()
                .fold(0.0, f64::max);
            let noise = Vector2::new(within(1.0), within(1.0));
            truth = next;
            let step = filter.step(Some(&(h * truth + noise))).unwrap();
            let errors = step
                .updated
                .iter()
                .map(|own| form(&own.covariance, &(own.mean - truth)));
            let after = errors.fold(0.0, f64::max);
            // s = 1/2. The first step has covariances before it that no measurement has bounded.
            let bound = before / (1.0 + 0.5 / c) + mismatch / 0.5 + form(&r, &noise);
            assert!(after <= bound * (1.0 + 1e-9), "{after} above {bound}");
            // Without what the mismatch adds it would not hold.
            needed += usize::from(after > before / (1.0 + 0.5 / c) + form(&r, &noise));
            before = after;
        }
    }
    assert!(needed > 100, "{needed}");
}
