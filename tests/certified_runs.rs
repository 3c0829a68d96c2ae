//! Goal: a run that is carried from step to step by a midpoint and a set of errors is certified for any length, and nothing is lost from
//! the set.
//!
//! Method: each inequality is attacked in exact rationals. Points of a set of errors are moved and rounded in the worst way that is
//! found, and must be in the next set, whatever matrices it was made with; a wrong form of the inequality loses them. Intervals and
//! gradients are compared with exact arithmetic and with dual numbers. Then whole runs, against enclosures alone with thousands of bits.
//! Kind of evidence: exact, and enclosed; the inputs are drawn from a named generator with a seed.

// Doubles are compared exactly: that they are equal to the last bit is what these laws say.
#![allow(clippy::float_cmp)]

use immaculate::number::{Dual, Enclosure, Field, Gradient, Interval, Rational, Real};
use immaculate::oracle::certify::{certified_as_far_as_it_goes, certify, certify_from};
use immaculate::oracle::ellipsoid::{Choice, Ellipsoid};
use immaculate::oracle::problem::ProblemFile;
use nalgebra::DMatrix;
use num_traits::{One, Zero};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use serde_json::{Value, json};

// What is drawn

/// A double from −1 to 1.
fn signed(rng: &mut ChaCha8Rng) -> f64 {
    (rng.next_u64() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// A double of either sign, from 2^−spread to 2^spread.
fn of_any_size(rng: &mut ChaCha8Rng, spread: f64) -> f64 {
    Real::exp(&(signed(rng) * spread * 0.7)) * if rng.next_u64().is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// The rational that a double is.
fn rational(value: f64) -> Rational {
    Enclosure::exact(value).lower()
}

/// A random expression of variables, by + − × and ÷: the same one for the same seed, in any number system.
fn expression<T: Field>(seed: u64, variables: &[T]) -> T {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut values = variables.to_vec();
    values.push(T::integer(3));
    for _ in 0..8 {
        let mut drawn = || usize::try_from(rng.next_u64() % values.len() as u64).unwrap();
        let (a, b) = (drawn(), drawn());
        let (a, b) = (values[a].clone(), values[b].clone());
        values.push(match rng.next_u64() % 4 {
            0 => a + b,
            1 => a - b,
            2 => a * b,
            _ => a / (b.clone() * b + T::integer(1)),
        });
    }
    values.pop().unwrap()
}

// Intervals and gradients

#[test]
fn an_interval_contains_what_exact_arithmetic_gives() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut wide = 0;
    for seed in 0..3000 {
        let boxes: Vec<Interval> = (0..3)
            .map(|_| {
                let middle = of_any_size(&mut rng, 20.0);
                let radius =
                    [0.0, middle.abs() * 1e-12, middle.abs() * 0.01][usize::try_from(rng.next_u64() % 3).unwrap()];
                Interval::around(middle, radius)
            })
            .collect();
        let found = expression(seed, &boxes);
        wide += usize::from(found.radius() > 1e-9 * found.middle().abs());
        // The corners of the box, and a point inside.
        for _ in 0..4 {
            let inside: Vec<Rational> = boxes
                .iter()
                .map(|part| rational(part.middle()) + rational(part.radius()) * rational(signed(&mut rng).signum()))
                .collect();
            let exact = expression(seed, &inside);
            assert!(
                !found.is_decided() || found.contains(&exact),
                "{seed}: {found} is {exact}"
            );
        }
    }
    assert!(wide > 100, "{wide}");
}

#[test]
fn elementary_functions_of_an_interval_contain_those_of_its_points() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let functions: [fn(&Enclosure) -> Enclosure; 6] =
        [Real::sqrt, Real::exp, Real::ln, Real::sin, Real::cos, |x| x.stumpff(1)];
    let same: [fn(&Interval) -> Interval; 6] =
        [Real::sqrt, Real::exp, Real::ln, Real::sin, Real::cos, |x| x.stumpff(1)];
    for _ in 0..500 {
        let middle = of_any_size(&mut rng, 6.0).abs();
        let part = Interval::around(
            middle,
            middle * [0.0, 1e-13, 0.1][usize::try_from(rng.next_u64() % 3).unwrap()],
        );
        for end in [-1.0, 1.0] {
            Enclosure::with_precision(200, || {
                let point = Enclosure::exact(part.middle()) + Enclosure::exact(part.radius()) * Enclosure::exact(end);
                for (function, same) in functions.iter().zip(same) {
                    let (exact, found) = (function(&point), same(&part));
                    assert!(
                        found.contains(&exact.lower()) && found.contains(&exact.upper()),
                        "{found} {exact}"
                    );
                }
                let angle = Interval::exact(1.0).atan2(&part);
                assert!(angle.contains(&Enclosure::integer(1).atan2(&point).lower()));
            });
        }
    }
    let pi = Enclosure::with_precision(200, Enclosure::pi);
    assert!(Interval::pi().contains(&pi.lower()) && Interval::pi().contains(&pi.upper()));
}

#[test]
fn an_interval_says_what_it_cannot_decide() {
    let around_zero = Interval::around(0.0, 1e-3);
    assert!(!(Interval::exact(1.0) / around_zero).is_decided() && !Real::sqrt(&around_zero).is_decided());
    assert!(!around_zero.ln().is_decided() && !around_zero.atan2(&Interval::exact(-1.0)).is_decided());
    assert_eq!(around_zero.partial_cmp(&Interval::zero()), None);
    assert!(around_zero < Interval::exact(0.002) && around_zero > Interval::exact(-0.002));
    for undecided in [
        Interval::exact(f64::NAN),
        Interval::exact(f64::INFINITY),
        Interval::around(0.0, -1.0),
    ] {
        let same = undecided;
        assert!(!undecided.is_decided() && undecided != same);
        assert!(!(undecided * Interval::zero()).is_decided() && !(undecided + Interval::one()).is_decided());
    }
    let huge = Interval::exact(f64::MAX);
    assert!(!(huge * huge).is_decided() && !(huge + huge).is_decided());
    // What underflows is not lost.
    let tiny = Interval::exact(f64::MIN_POSITIVE);
    assert!(
        (tiny * tiny).contains(&(rational(f64::MIN_POSITIVE) * rational(f64::MIN_POSITIVE)))
            && !(tiny * tiny).is_zero()
    );
}

#[test]
fn a_gradient_is_made_of_the_slopes_of_dual_numbers() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    for seed in 0..300 {
        let at: Vec<Rational> = (0..3)
            .map(|_| Rational::new(i64::try_from(rng.next_u64() % 19).unwrap() - 9, 4))
            .collect();
        let variable = |(k, value): (usize, &Rational)| Gradient::variable(value.clone(), k, 3);
        let found = expression(seed, &at.iter().enumerate().map(variable).collect::<Vec<_>>());
        for direction in 0..3 {
            let part = |(k, value): (usize, &Rational)| {
                let slope = if k == direction {
                    Rational::one()
                } else {
                    Rational::zero()
                };
                Dual::new(value.clone(), slope)
            };
            let exact = expression(seed, &at.iter().enumerate().map(part).collect::<Vec<_>>());
            let slope = found.slopes().get(direction).cloned().unwrap_or_else(Rational::zero);
            assert_eq!((found.value(), &slope), (exact.value(), exact.slope()), "{seed}");
        }
    }
}

/// A function with every elementary one in it.
fn elementary<T: Real>(x: &T, y: &T) -> T {
    let range = (x.clone() * x.clone() + y.clone() * y.clone()).sqrt();
    let angle = y.atan2(x);
    range.ln() * angle.sin() + (-range.clone()).exp() * angle.cos() + (x.clone() / y.clone()).stumpff(1) * T::pi()
}

#[test]
fn a_gradient_over_a_box_holds_the_derivatives_at_its_points() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    for _ in 0..200 {
        let [x, y] = [1.0, 2.0].map(|shift| shift + signed(&mut rng).abs());
        let boxes = [x, y].map(|middle| Interval::around(middle, 1e-6));
        let [u, v] = [0, 1].map(|k| Gradient::variable(boxes[k], k, 2));
        let found = elementary(&u, &v);
        let inside = boxes.map(|part| part.middle() + part.radius() * 0.9 * signed(&mut rng));
        for direction in 0..2 {
            Enclosure::with_precision(200, || {
                let part = |k: usize| {
                    let slope = if k == direction {
                        Enclosure::one()
                    } else {
                        Enclosure::zero()
                    };
                    Dual::new(Enclosure::exact(inside[k]), slope)
                };
                let exact = elementary(&part(0), &part(1));
                assert!(found.slopes()[direction].contains(&exact.slope().lower()));
                assert!(found.value().contains(&exact.value().upper()));
            });
            assert!(found.slopes()[direction].radius() < 1e-3);
        }
    }
}

#[test]
fn what_does_not_change_has_no_derivatives() {
    let x = Gradient::variable(Interval::around(2.0, 0.1), 0, 2);
    let (zero, two) = (Gradient::<Interval>::zero(), Gradient::<Interval>::integer(2));
    for constant in [
        two.clone() * zero.clone(),
        x.clone() * zero.clone(),
        zero.clone() / x.clone(),
        two.sqrt(),
        two.atan2(&two),
    ] {
        assert!(constant.is_constant(), "{constant}");
    }
    assert!(!(x.clone() - x.clone()).is_constant() && !(x.clone() + two).is_constant());
    // Numbers of other directions have nothing in common.
    let other = Gradient::variable(Interval::around(2.0, 0.1), 0, 3);
    assert!(!(x + other).is_decided());
}

// The set of errors

/// All that a step of a set is made of.
struct Attack {
    before: Ellipsoid,
    jacobian: DMatrix<Interval>,
    bounds: Vec<f64>,
    units: DMatrix<f64>,
}

const SIZE: usize = 3;

impl Attack {
    fn drawn(rng: &mut ChaCha8Rng) -> Self {
        let mut any = |spread| of_any_size(rng, spread);
        let shape = DMatrix::from_fn(SIZE, SIZE, |_, _| any(3.0));
        let jacobian = DMatrix::from_fn(SIZE, SIZE, |_, _| Interval::around(any(2.0), any(1.0).abs() * 1e-3));
        let units = DMatrix::from_fn(SIZE, SIZE, |i, j| match i.cmp(&j) {
            std::cmp::Ordering::Less => 0.0,
            std::cmp::Ordering::Equal => any(3.0).abs(),
            std::cmp::Ordering::Greater => any(1.0),
        });
        let size = any(5.0).abs() * 1e-9;
        Self {
            before: Ellipsoid { shape, size },
            jacobian,
            bounds: (0..SIZE).map(|_| size * any(3.0).abs()).collect(),
            units,
        }
    }

    /// The v and the corner of w that go farthest out of a set, about: of all corners the one with its own best direction.
    fn worst(&self, after: &Ellipsoid, corner: usize) -> (Vec<Rational>, [f64; SIZE]) {
        let signs = [0, 1, 2].map(|k| if corner >> k & 1 == 0 { 1.0 } else { -1.0 });
        let inverse = after.shape.clone().try_inverse().expect("a regular matrix");
        let moved = self.jacobian.map(Interval::middle) * &self.before.shape;
        let rounded = DMatrix::from_fn(SIZE, 1, |k, _| self.bounds[k] * signs[k]);
        let direction = (&inverse * &moved).transpose() * (&inverse * rounded);
        (direction.iter().map(|&entry| rational(entry)).collect(), signs)
    }

    /// An error after the step, exactly: J A v + w with |v| = e, J at corners of the intervals, and w at a corner of its box. `v` is any
    /// vector.
    fn error(&self, v: &[Rational], signs: [f64; SIZE], rng: &mut ChaCha8Rng) -> Vec<Rational> {
        let v = on_the_sphere(v, &rational(self.before.size));
        let mut sign = || rational(if rng.next_u64().is_multiple_of(2) { 1.0 } else { -1.0 });
        let moved = times(&self.before.shape, &v);
        (0..SIZE)
            .map(|i| {
                let mut sum = rational(self.bounds[i]) * rational(signs[i]);
                for (k, entry) in moved.iter().enumerate() {
                    let slope = self.jacobian[(i, k)];
                    sum += (rational(slope.middle()) + rational(slope.radius()) * sign()) * entry.clone();
                }
                sum
            })
            .collect()
    }
}

/// A matrix of doubles times a vector, exactly.
fn times(matrix: &DMatrix<f64>, vector: &[Rational]) -> Vec<Rational> {
    (0..matrix.nrows())
        .map(|i| {
            let terms = vector.iter().enumerate();
            terms.fold(Rational::zero(), |sum, (k, entry)| {
                sum + rational(matrix[(i, k)]) * entry.clone()
            })
        })
        .collect()
}

/// The vector scaled to a length that is not above e, and below it by no more than a part of 10⁻¹⁵.
fn on_the_sphere(vector: &[Rational], e: &Rational) -> Vec<Rational> {
    let square = vector.iter().fold(Rational::zero(), |sum, entry| sum + entry * entry);
    // A root from above.
    let root = rational(Real::sqrt(&(square.to_f64())) * (1.0 + 4.0 * f64::EPSILON));
    assert!(&root * &root >= square);
    vector.iter().map(|entry| entry * e / &root).collect()
}

/// Whether a point is in {A v : |v| ≤ e}, exactly: A is inverted by elimination.
fn is_in(set: &Ellipsoid, point: &[Rational]) -> bool {
    let n = point.len();
    let mut rows: Vec<Vec<Rational>> = (0..n)
        .map(|i| {
            (0..n)
                .map(|j| rational(set.shape[(i, j)]))
                .chain([point[i].clone()])
                .collect()
        })
        .collect();
    for k in 0..n {
        let pivot = (k..n).find(|&row| !rows[row][k].is_zero()).expect("a regular matrix");
        rows.swap(k, pivot);
        let first = rows[k].clone();
        for (i, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let _ = i;
            let factor = row[k].clone() / first[k].clone();
            for (entry, above) in row.iter_mut().zip(&first) {
                *entry -= factor.clone() * above.clone();
            }
        }
    }
    let square = (0..n).fold(Rational::zero(), |sum, k| {
        let v = rows[k][n].clone() / rows[k][k].clone();
        sum + &v * &v
    });
    let e = rational(set.size);
    square <= &e * &e
}

impl Attack {
    /// Points after the step, at random and as far out as is found: all must be in the set.
    fn make(&self, after: &Ellipsoid, rng: &mut ChaCha8Rng) {
        for corner in 0..8 {
            let (v, signs) = self.worst(after, corner);
            assert!(is_in(after, &self.error(&v, signs, rng)));
            let v = drawn_vector(rng);
            assert!(is_in(after, &self.error(&v, signs, rng)));
        }
    }
}

fn drawn_vector(rng: &mut ChaCha8Rng) -> Vec<Rational> {
    (0..SIZE).map(|_| rational(signed(rng))).collect()
}

#[test]
fn the_image_of_an_ellipsoid_holds_every_image_of_its_points() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let mut made = 0;
    for _ in 0..30 {
        let attack = Attack::drawn(&mut rng);
        let Some(after) = attack.before.image(&attack.jacobian, &attack.bounds, &attack.units) else {
            continue;
        };
        made += 1;
        attack.make(&after, &mut rng);
        // The first set of a run: what was rounded, and nothing before.
        let first = Ellipsoid::around(&attack.bounds, &attack.units).unwrap();
        for corner in 0..8 {
            let sign = |k: usize| if corner >> k & 1 == 0 { 1.0 } else { -1.0 };
            let point: Vec<Rational> = (0..SIZE).map(|k| rational(attack.bounds[k] * sign(k))).collect();
            assert!(is_in(&first, &point));
            let widths = first.half_widths();
            assert!(attack.bounds.iter().zip(widths).all(|(bound, width)| *bound <= width));
        }
    }
    assert!(made > 20, "{made}");
}

/// The proof asks nothing of A′, X and b: a set that was made from bad ones is large, and holds all the same.
#[test]
fn any_choice_of_matrices_gives_a_set_that_holds() {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    let mut made = 0;
    for _ in 0..40 {
        let attack = Attack::drawn(&mut rng);
        let shape = DMatrix::from_fn(SIZE, SIZE, |i, j| {
            if i == j {
                of_any_size(&mut rng, 2.0)
            } else {
                signed(&mut rng) * 0.2
            }
        });
        let inverse = shape
            .clone()
            .try_inverse()
            .unwrap()
            .map(|entry| entry * (1.0 + 0.1 * signed(&mut rng)));
        let share = of_any_size(&mut rng, 3.0).abs();
        let choice = Choice { shape, inverse, share };
        let attacked = |choice: &Choice| {
            attack
                .before
                .image_as_chosen(&attack.jacobian, &attack.bounds, &attack.units, choice)
        };
        let Some(after) = attacked(&choice) else { continue };
        made += 1;
        attack.make(&after, &mut rng);
        // Neither a negative b, nor an X that is no inverse, nor a singular A′ is taken.
        assert_eq!(
            attacked(&Choice {
                share: -share,
                ..choice.clone()
            }),
            None
        );
        let inverse = choice.inverse.map(|entry| -entry);
        assert_eq!(
            attacked(&Choice {
                inverse,
                ..choice.clone()
            }),
            None
        );
        let shape = DMatrix::zeros(SIZE, SIZE);
        assert_eq!(
            attacked(&Choice {
                shape,
                ..choice.clone()
            }),
            None
        );
    }
    assert!(made > 20, "{made}");
}

/// In one dimension errors of e are moved by 1 and those of ρ added: e + ρ is reached. The bracket without 1 + 1/b before the old set
/// gives less.
#[test]
fn without_the_share_of_the_old_set_the_image_is_too_small() {
    let one = DMatrix::from_element(1, 1, 1.0);
    let jacobian = DMatrix::from_element(1, 1, Interval::exact(1.0));
    let (e, rho) = (1.0, 0.5);
    let before = Ellipsoid {
        shape: one.clone(),
        size: e,
    };
    let right = before.image(&jacobian, &[rho], &one).unwrap();
    let reached = vec![rational(e + rho)];
    assert!(is_in(&right, &reached) && right.half_widths()[0] < (e + rho) * (1.0 + 1e-12));
    // b = e/ρ is the best one.
    let b = e / rho;
    let wrong = Real::sqrt(&(1.0 + (1.0 + b) * (rho / e) * (rho / e)));
    let claimed = Ellipsoid {
        shape: DMatrix::from_element(1, 1, wrong),
        size: e,
    };
    assert!(!is_in(&claimed, &reached));
    // The residual sees that: with this A′ the set is made larger.
    let choice = Choice {
        shape: claimed.shape.clone(),
        inverse: one / wrong,
        share: b,
    };
    let corrected = before
        .image_as_chosen(&jacobian, &[rho], &claimed.shape.map(|_| 1.0), &choice)
        .unwrap();
    assert!(is_in(&corrected, &reached) && corrected.size > e * 1.1);
}

/// A run in small: a map of the plane that turns and forgets, x′ = ½ R x + ¼ x₀² + z, carried by the method, beside the exact run in
/// rationals. `planted` moves one midpoint without saying so.
fn small_run(steps: usize, planted: Option<usize>) -> Option<usize> {
    let map = |x: &[Rational], z: &Rational| -> Vec<Rational> {
        let [a, b] = [Rational::new(3, 10), Rational::new(4, 10)];
        vec![
            &a * &x[0] - &b * &x[1] + &x[0] * &x[0] / Rational::integer(16) + z.clone(),
            &b * &x[0] + &a * &x[1],
        ]
    };
    let unit = 2.0_f64.powi(-40);
    let round = |value: &Rational| (value.to_f64() / unit).round() * unit;
    let mut truth = vec![Rational::new(1, 3), Rational::new(1, 7)];
    let mut middle: Vec<f64> = truth.iter().map(round).collect();
    let units = DMatrix::identity(2, 2);
    let mut errors = Ellipsoid::around(&[unit, unit], &units).unwrap();
    for step in 1..=steps {
        let z = Rational::new(i64::try_from(step * 7919 % 101).unwrap(), 101);
        let hull = errors.half_widths();
        let slope = Interval::around(middle[0] / 8.0, hull[0] / 8.0);
        let [a, b] = [0.3, 0.4].map(|value| Interval::around(value, 1e-16));
        let jacobian = DMatrix::from_row_slice(2, 2, &[a + slope, -b, b, a]);
        let exact: Vec<Rational> = map(&middle.iter().map(|&value| rational(value)).collect::<Vec<_>>(), &z);
        middle = exact.iter().map(round).collect();
        errors = errors.image(&jacobian, &[unit * 0.5, unit * 0.5], &units)?;
        if planted == Some(step) {
            middle[1] += 8.0 * unit;
        }
        truth = map(&truth, &z);
        // The exact run doubles its digits in each step: it is cut, by less than any error that is looked for.
        truth = truth
            .iter()
            .map(|value| Enclosure::with_precision(400, || Enclosure::rational(value).centre().lower()))
            .collect();
        let off: Vec<Rational> = truth
            .iter()
            .zip(&middle)
            .map(|(value, middle)| value - &rational(*middle))
            .collect();
        if !is_in(&errors, &off) {
            return Some(step);
        }
    }
    assert!(
        errors.half_widths().iter().all(|&width| width < 8.0 * unit),
        "{errors:?}"
    );
    None
}

#[test]
fn a_carried_set_holds_the_exact_run_and_loses_it_where_a_midpoint_is_moved() {
    assert_eq!(small_run(300, None), None);
    for planted in [1, 50, 299] {
        assert_eq!(small_run(300, Some(planted)), Some(planted));
    }
}

// Whole runs

/// A problem of three modes, n = 4: positions for a Kalman filter, range and bearing across ±π for the others. `miss` says at which steps
/// there is no detection.
fn three_modes(filter: &Value, steps: usize, miss: fn(usize) -> bool) -> Value {
    let turn = |w: f64| {
        let (s, c) = if w == 0.0 {
            (1.0, 0.0)
        } else {
            (w.sin() / w, (1.0 - w.cos()) / w)
        };
        json!([
            [1, s, 0, -c],
            [0, w.cos(), 0, -w.sin()],
            [0, c, 1, s],
            [0, w.sin(), 0, w.cos()]
        ])
    };
    let noise = |q: f64| {
        json!([
            [q / 4.0, q / 2.0, 0, 0],
            [q / 2.0, q, 0, 0],
            [0, 0, q / 4.0, q / 2.0],
            [0, 0, q / 2.0, q]
        ])
    };
    let is_linear = filter["kind"] == "kalman";
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let measurements: Vec<Value> = (1..=steps)
        .map(|step| {
            // A circle whose bearings cross ±π again and again.
            let t = 0.05 * step as f64;
            let (x, y) = (-20_000.0 + 400.0 * t.sin(), 400.0 * t.cos() - 100.0);
            let z = if is_linear {
                [x + 20.0 * signed(&mut rng), y + 20.0 * signed(&mut rng)]
            } else {
                [
                    x.hypot(y) + 20.0 * signed(&mut rng),
                    y.atan2(x) + 0.002 * signed(&mut rng),
                ]
            };
            json!({ "step": step, "z": if miss(step) { Value::Null } else { json!(z) } })
        })
        .collect();
    let mode = |name: &str, w: f64, q: f64| json!({ "name": name, "F": turn(w), "Q": noise(q) });
    let estimate = json!({ "mean": [-20_000, 20, 300, 0], "covariance": [[400, 0, 0, 0], [0, 100, 0, 0], [0, 0, 400, 0], [0, 0, 0, 100]] });
    json!({
        "format": "immaculate-problem/2",
        "id": "carried",
        "state": ["x", "vx", "y", "vy"],
        "modes": [mode("straight", 0.0, 1.0), mode("left", 0.05, 2.0), mode("right", -0.05, 2.0)],
        "measurement": if is_linear {
            json!({ "kind": "linear", "H": [[1, 0, 0, 0], [0, 0, 1, 0]] })
        } else {
            json!({ "kind": "range-bearing", "components": ["range", "bearing"], "position": [0, 2], "sensor": [0, 0] })
        },
        "R": if is_linear { json!([[400, 0], [0, 400]]) } else { json!([[400, 0], [0, 1e-5]]) },
        "filter": filter,
        "transition": [[0.9, 0.05, 0.05], [0.1, 0.9, 0], [0.1, 0, 0.9]],
        "initial": { "mode_probabilities": [0.5, 0.25, 0.25], "modes": [estimate, estimate, estimate] },
        "measurements": measurements
    })
}

/// The problem, certified both ways: the run is carried with few bits, and every number is the one of enclosures alone.
fn agrees(file: &Value, plain_bits: u32) {
    let problem = ProblemFile::read(&file.to_string()).unwrap();
    let carried = certify(&problem).unwrap();
    let plain = certify_from(&problem, plain_bits).unwrap();
    assert!(carried.bits < 512, "{}", carried.bits);
    assert_eq!(carried.trace, plain.trace);
    assert_eq!(
        certified_as_far_as_it_goes(&problem).unwrap(),
        (plain.trace, problem.measurements.len())
    );
}

#[test]
fn a_carried_run_of_kalman_filters_is_that_of_enclosures_alone() {
    agrees(
        &three_modes(&json!({ "kind": "kalman" }), 200, |step| step % 30 > 25),
        4096,
    );
}

#[test]
fn a_carried_run_of_cubature_filters_is_that_of_enclosures_alone() {
    agrees(
        &three_modes(&json!({ "kind": "cubature", "rule": "cubature-3" }), 110, |step| {
            step % 7 == 3
        }),
        4096,
    );
}

/// Certification says with how many bits: a run that is carried takes no more of them when it is longer.
#[test]
fn a_longer_run_takes_no_more_bits() {
    let bits = |steps| {
        let file = three_modes(&json!({ "kind": "kalman" }), steps, |_| false);
        certify(&ProblemFile::read(&file.to_string()).unwrap()).unwrap().bits
    };
    let few = bits(120);
    assert!(few <= 320, "{few}");
    assert_eq!(bits(480), few);
}

/// A mode that no other leads to has the probability zero for ever; one that is left for good has one that shrinks.
#[test]
fn modes_that_cannot_be_reached_are_carried_as_exact_zeros() {
    let mut file = three_modes(&json!({ "kind": "kalman" }), 110, |_| false);
    file["transition"] = json!([[0.9, 0.1, 0], [0.1, 0.9, 0], [0, 0, 1]]);
    file["initial"]["mode_probabilities"] = json!([0.5, 0.5, 0]);
    agrees(&file, 4096);
}
