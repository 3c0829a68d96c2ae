//! Goal: every named model of `spec/models.toml` is the motion, noise or measurement that it says it is.
//!
//! Method: the rows are run in enclosures, dual numbers and rational functions. Worked examples have the digits that were computed from
//! closed forms and integrals by another program. A motion composes over time and starts as its differential equation says, which only
//! the solution of that equation does; the white noise of a motion gathers over time along it. Slopes are those of differences. Where
//! this crate has a plain function, both agree. Kind of evidence: symbolic where a law holds for all values, enclosed elsewhere.

use immaculate::book::source::{items_of, source_files};
use immaculate::model::binding::{InvalidModel, Others, STEP};
use immaculate::model::function::Function;
use immaculate::model::motion::{
    acceleration_noise, constant_velocity, coordinated_turn, integrated_noise, turn_noise,
};
use immaculate::model::registry::{Example, ListedComponent, Model, ModelKind, model, models};
use immaculate::model::space::{Component, ComponentKind, Space};
use immaculate::model::{PolarComponent, Sensor, acceleration, wiener};
use immaculate::number::{Dual, Enclosure, Field, Rational, RationalFunction, Real};
use nalgebra::{SMatrix, SVector, U1, U2, U4, matrix};
use num_traits::Zero;
use std::collections::BTreeSet;

// The rows themselves

#[test]
fn every_row_is_complete() {
    let mut ids = BTreeSet::new();
    for row in models() {
        let id = &row.id;
        let is_kebab = id
            .chars()
            .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
        assert!(is_kebab && ids.insert(id.clone()), "{id}");
        assert!(
            !row.title.is_empty() && !row.state.is_empty() && !row.examples.is_empty(),
            "{id}"
        );
        assert!(
            row.source.year > 1900 && !row.source.author.is_empty() && !row.source.title.is_empty(),
            "{id}"
        );
        let (formulas, covariance) = (!row.formulas.is_empty(), !row.covariance.is_empty());
        let input = !row.input.is_empty() && !row.variances.is_empty();
        let is_noise = row.kind == ModelKind::Noise;
        assert_eq!(formulas, !is_noise, "{id}");
        assert_eq!(covariance ^ input, is_noise, "{id}");
        assert_eq!(!row.measured.is_empty(), row.kind == ModelKind::Measurement, "{id}");
        let rows = if covariance { &row.covariance } else { &row.input };
        if is_noise {
            let width = if covariance {
                row.state.len()
            } else {
                row.variances.len()
            };
            assert!(
                rows.len() == row.state.len() && rows.iter().all(|row| row.len() == width),
                "{id}"
            );
        }
        let gives: Vec<&str> = row.formulas.iter().map(|[name, _]| name.as_str()).collect();
        let parts = if row.kind == ModelKind::Motion {
            &row.state
        } else {
            &row.measured
        };
        let expected: Vec<&str> = parts.iter().map(|ListedComponent(part)| part.name.as_str()).collect();
        assert_eq!(gives, expected, "{id}: what the formulas give");
        for brackets in [('{', '}'), ('[', ']')] {
            let count = |c| row.latex.matches(c).count();
            assert_eq!(count(brackets.0), count(brackets.1), "{id}: latex");
        }
    }
    let count = |kind| models().iter().filter(|row| row.kind == kind).count();
    assert!(count(ModelKind::Motion) >= 10 && count(ModelKind::Noise) >= 14 && count(ModelKind::Measurement) >= 10);
}

#[test]
fn every_parameter_and_component_of_a_row_is_used() {
    for row in models() {
        let example = &row.examples[0];
        let function = bound(row, example);
        let formulas = function.formulas().unwrap();
        // A covariance may not depend on the state; nothing but a component that a motion keeps is idle otherwise.
        let needed = row.parameters.iter().map(|parameter| parameter.name.as_str());
        for name in needed.chain(row.inputs.iter().map(|[name, _]| name.as_str())) {
            assert!(formulas.uses(name), "{}: {name}", row.id);
        }
        for [name, _] in &example.state {
            let is_extra = row.axes.is_empty() && !row.state.iter().any(|ListedComponent(part)| part.name == *name);
            let is_idle = row.kind == ModelKind::Noise
                || is_extra
                || row.id == "position"
                || row.id == "range"
                || row.id == "bearing";
            assert!(is_idle || formulas.uses(name), "{}: {name}", row.id);
        }
    }
}

#[test]
fn every_plain_function_that_a_row_names_is_there() {
    let functions: BTreeSet<String> = source_files()
        .iter()
        .flat_map(|file| items_of(file).unwrap())
        .filter(|item| item.is_public)
        .map(|item| {
            let place = item
                .path
                .trim_start_matches("src/")
                .trim_end_matches(".rs")
                .replace('/', "::");
            format!("{place}::{}", item.name)
        })
        .collect();
    let mut named = BTreeSet::new();
    for row in models() {
        if let Some(name) = &row.rust {
            assert!(functions.contains(name), "{}: {name}", row.id);
            named.insert(row.id.as_str());
        }
    }
    // Each of them is held against its function below.
    let held: BTreeSet<&str> = AGREEING.into_iter().collect();
    assert_eq!(named, held);
}

// How an example is run

/// The components of an example, with the kinds that the row gives them.
fn space(row: &Model, example: &Example) -> Space {
    let part = |name: &str| {
        let is_angle = row
            .state
            .iter()
            .any(|ListedComponent(part)| part.name == *name && part.kind == ComponentKind::Angle);
        if is_angle {
            Component::angle(name)
        } else {
            Component::number(name, "")
        }
    };
    Space::new(example.state.iter().map(|[name, _]| part(name)).collect()).unwrap()
}

fn decimal(text: &str) -> Rational {
    Rational::from_decimal(text).unwrap_or_else(|| panic!("{text}"))
}

/// A model bound as its kind is.
fn bind(row: &Model, state: &Space, parameters: &[(&str, Rational)]) -> Result<Function, InvalidModel> {
    match row.kind {
        ModelKind::Motion => row.motion(state, parameters, Others::Refuse),
        ModelKind::Noise => row.noise(state, parameters),
        ModelKind::Measurement => row.measurement(state, parameters).map(|(_, function)| function),
    }
}

fn bound(row: &Model, example: &Example) -> Function {
    let parameters: Vec<_> = example
        .parameters
        .iter()
        .map(|[name, value]| (name.as_str(), decimal(value)))
        .collect();
    bind(row, &space(row, example), &parameters).unwrap_or_else(|error| panic!("{}: {error}", row.id))
}

/// The numbers of an example in the order of the names of its formulas: state, what is given, parameters.
fn values<T: Field>(row: &Model, example: &Example, function: &Function) -> Vec<T> {
    let number = |text: &str| T::rational(&decimal(text));
    let mut values: Vec<T> = example.state.iter().map(|[_, value]| number(value)).collect();
    for name in function.given() {
        let [_, value] = example
            .given
            .iter()
            .find(|[given, _]| given == name)
            .expect("it is given");
        values.push(number(value));
    }
    for parameter in &row.parameters {
        let given = example
            .parameters
            .iter()
            .find(|[name, _]| *name == parameter.name)
            .map(|[_, value]| value);
        values.push(number(given.or(parameter.default.as_ref()).expect("it has a value")));
    }
    values
}

/// Every example: its row, itself, its function and its numbers.
fn examples() -> Vec<(&'static Model, &'static Example, Function, Vec<Enclosure>)> {
    let mut all = Vec::new();
    for row in models() {
        for example in &row.examples {
            let function = bound(row, example);
            let numbers = values(row, example, &function);
            all.push((row, example, function, numbers));
        }
    }
    all
}

/// Splits the numbers of an example into the state and what is given.
fn parts<'a>(function: &Function, numbers: &'a [Enclosure]) -> (&'a [Enclosure], &'a [Enclosure]) {
    let (state, rest) = numbers.split_at(function.components());
    (state, &rest[..function.given().len()])
}

#[test]
fn every_worked_example_has_the_digits_that_are_written() {
    Enclosure::with_precision(300, || {
        for (row, example, function, numbers) in examples() {
            let (state, given) = parts(&function, &numbers);
            let result = function.at(state, given);
            assert_eq!(result.len(), example.result.len(), "{}", row.id);
            for (value, written) in result.iter().zip(&example.result) {
                // Half a unit of the last of 30 digits; a number with fewer digits is exact.
                let digits = written.bytes().filter(u8::is_ascii_digit).count();
                let scale = Rational::from_decimal("1e-29").unwrap();
                let slack = if digits >= 26 {
                    decimal(written).abs() * scale
                } else {
                    Rational::zero()
                };
                let off = value.clone() - Enclosure::rational(&decimal(written));
                let bound = slack.to_f64() + 1e-80;
                assert!(off.magnitude() <= bound, "{}: {value} is not {written}", row.id);
                // Another last digit is refused.
                let other = Enclosure::rational(&(decimal(written).abs() * Rational::from_decimal("1e-27").unwrap()));
                assert!(written == "0" || (off + other).magnitude() > bound);
            }
        }
    });
}

// Slopes

#[test]
fn every_model_has_the_slopes_of_its_differences() {
    // Central differences are off by h²/6 sup|f‴|, which is below 10⁶ h² at these numbers.
    Enclosure::with_precision(400, || {
        let h = Enclosure::exact(2.0_f64.powi(-100));
        let allowed = 1e6 * 2.0_f64.powi(-200);
        for (row, _, function, numbers) in examples() {
            let (state, given) = parts(&function, &numbers);
            let jacobian = function.jacobian_at(state, given);
            for column in 0..state.len() {
                let at = |by: Enclosure| {
                    let mut moved = state.to_vec();
                    moved[column] += by;
                    function.at(&moved, given)
                };
                let (ahead, behind) = (at(h.clone()), at(-h.clone()));
                for ((line, ahead), behind) in jacobian.iter().zip(ahead).zip(behind) {
                    let quotient = (ahead - behind) / (h.clone() + h.clone());
                    let off = quotient - line[column].clone();
                    assert!(off.magnitude() < allowed, "{}, column {column}: {off}", row.id);
                    assert!(
                        (off + Enclosure::exact(1e-40)).magnitude() > allowed,
                        "the bound refuses others"
                    );
                }
            }
            assert!(function.is_linear() == row.is_seen_to_be_linear(), "{}", row.id);
        }
    });
}

/// What is linear in the state, said once more by hand.
trait Linear {
    fn is_seen_to_be_linear(&self) -> bool;
}

impl Linear for Model {
    fn is_seen_to_be_linear(&self) -> bool {
        let linear = [
            "random-walk",
            "constant-velocity",
            "constant-acceleration",
            "constant-jerk",
            "singer",
            "coordinated-turn",
            "position",
        ];
        let of_state = [
            "coordinated-turn-unknown-rate-white-noise",
            "constant-turn-rate-and-speed-piecewise-noise",
        ];
        let of_state =
            of_state.contains(&self.id.as_str()) || self.id == "constant-turn-rate-and-acceleration-piecewise-noise";
        linear.contains(&self.id.as_str()) || (self.kind == ModelKind::Noise && !of_state)
    }
}

// Rates around zero

#[test]
fn a_rate_enclosed_around_zero_decides_every_model() {
    Enclosure::with_precision(300, || {
        let mut around = 0;
        for (row, _, function, numbers) in examples() {
            let formulas = function.formulas().unwrap();
            for (place, name) in formulas.names().iter().enumerate() {
                if !["w", "alpha", "steer", "a", "v", "heading"].contains(&name.as_str()) {
                    continue;
                }
                around += 1;
                let run = |value: Enclosure| {
                    let mut values = numbers.clone();
                    values[place] = value;
                    let jacobian = formulas.jacobian_at(&values, numbers.len());
                    (formulas.at(&values), jacobian.concat())
                };
                let (near, exact) = (run(Enclosure::around(0.0, 1e-60)), run(Enclosure::zero()));
                let all = near.0.iter().chain(&near.1).zip(exact.0.iter().chain(&exact.1));
                for (near, exact) in all {
                    assert!(near.is_decided() && near.width() < 1e-55, "{}, {name}: {near}", row.id);
                    assert!(
                        near.contains(&exact.lower()) || (near.clone() - exact.clone()).contains(&Rational::zero()),
                        "{}",
                        row.id
                    );
                }
            }
        }
        assert!(around > 20, "{around}");
        // What is printed has no answer there.
        let w = Enclosure::around(0.0, 1e-60);
        assert!(!((w.clone() * Enclosure::integer(2)).sin() / w).is_decided());
    });
}

// Motions are solutions of their equations

/// The right side of a motion's differential equation: the names of its numbers, and each number's rate of change, by hand.
fn equation_of_motion(id: &str, of: &dyn Fn(&str) -> Enclosure, component: &str) -> Enclosure {
    let (v, heading) = (|| of("v"), || of("heading"));
    match (id, component) {
        ("random-walk", _)
        | ("constant-velocity", "vx" | "vy" | "vz")
        | ("constant-acceleration", "ax")
        | ("constant-jerk", "jx")
        | ("constant-turn-rate-and-speed", "v")
        | (_, "w" | "a") => Enclosure::zero(),
        ("coordinated-turn" | "coordinated-turn-unknown-rate", "vx") => -of("w") * of("vy"),
        ("coordinated-turn" | "coordinated-turn-unknown-rate", "vy") => of("w") * of("vx"),
        ("singer", "ax") => -of("alpha") * of("ax"),
        ("constant-turn-rate-and-speed" | "constant-turn-rate-and-acceleration", "x") => v() * heading().cos(),
        ("constant-turn-rate-and-speed" | "constant-turn-rate-and-acceleration", "y") => v() * heading().sin(),
        ("constant-turn-rate-and-speed" | "constant-turn-rate-and-acceleration", "heading") => of("w"),
        ("constant-turn-rate-and-acceleration" | "bicycle", "v") => of("a"),
        ("bicycle", _) => {
            // tan β = l_r tan δ / (l_f + l_r), the slip angle between velocity and heading.
            let tangent = of("steer").sin() / of("steer").cos();
            let slip = (of("rear") * tangent.clone()).atan2(&(of("front") + of("rear")));
            match component {
                "x" => v() * (heading() + slip).cos(),
                "y" => v() * (heading() + slip).sin(),
                // v sin β / l_r, which is v cos β tan δ / (l_f + l_r).
                _ => v() * slip.cos() * tangent / (of("front") + of("rear")),
            }
        }
        (_, position @ ("x" | "y" | "z")) => of(&format!("v{position}")),
        (_, velocity) if velocity.starts_with('v') => of(&velocity.replace('v', "a")),
        (_, acceleration) => of(&acceleration.replace('a', "j")),
    }
}

#[test]
fn every_motion_starts_as_its_differential_equation_says() {
    Enclosure::with_precision(300, || {
        let mut checked = 0;
        for (row, _, function, numbers) in examples() {
            if row.kind != ModelKind::Motion {
                continue;
            }
            let formulas = function.formulas().unwrap();
            let names = formulas.names();
            let step = names.iter().position(|name| name == STEP).unwrap();
            let mut changing: Vec<Dual<Enclosure>> = numbers.iter().cloned().map(Dual::constant).collect();
            changing[step] = Dual::variable(Enclosure::zero());
            let of = |name: &str| numbers[names.iter().position(|known| known == name).unwrap()].clone();
            for (component, moved) in names.iter().zip(formulas.at(&changing)) {
                assert!(
                    (moved.value().clone() - of(component)).magnitude() < 1e-80,
                    "{}: no time, no motion",
                    row.id
                );
                let rate = equation_of_motion(&row.id, &of, component);
                let off = (moved.slope().clone() - rate).magnitude();
                assert!(off < 1e-80, "{}: {component} is off by {off:e}", row.id);
                checked += 1;
            }
        }
        assert!(checked > 60, "{checked}");
    });
}

#[test]
fn every_motion_composes_over_time() {
    Enclosure::with_precision(300, || {
        for (row, _, function, numbers) in examples() {
            if row.kind != ModelKind::Motion {
                continue;
            }
            let (state, given) = parts(&function, &numbers);
            let after = |state: &[Enclosure], time: f64| {
                let mut given = given.to_vec();
                given[0] = Enclosure::exact(time);
                function.at(state, &given)
            };
            let (both, one_by_one) = (after(state, 3.25), after(&after(state, 1.25), 2.0));
            let stayed = after(&after(state, 1.25), 1.75);
            let off = |a: &[Enclosure], b: &[Enclosure]| {
                a.iter()
                    .zip(b)
                    .map(|(a, b)| (a.clone() - b.clone()).magnitude())
                    .fold(0.0, f64::max)
            };
            assert!(off(&both, &one_by_one) < 1e-78, "{}", row.id);
            assert!(
                off(&both, &stayed) > 1e-3 || row.id == "random-walk",
                "{}: another time is another place",
                row.id
            );
        }
    });
}

#[test]
fn white_noise_gathers_along_its_motion() {
    // Q(s + t) = F(t) Q(s) F(t)ᵀ + Q(t): with what Q starts as, only the integral along the motion does that.
    Enclosure::with_precision(300, || {
        let mut laws = 0;
        for (row, _, noise, numbers) in examples() {
            let Some(of_motion) = row.id.strip_suffix("-white-noise") else {
                continue;
            };
            if of_motion == "coordinated-turn-unknown-rate" {
                // The rate's own noise is not carried along within a step; the rest is that of the known rate.
                continue;
            }
            let motion = model(of_motion).unwrap();
            let example = &row.examples[0];
            let of_motion =
                |name: &(&str, Rational)| motion.parameters.iter().any(|parameter| parameter.name == name.0);
            let parameters: Vec<_> = example
                .parameters
                .iter()
                .map(|[name, value]| (name.as_str(), decimal(value)))
                .collect();
            let parameters: Vec<_> = parameters.into_iter().filter(of_motion).collect();
            let motion = motion
                .motion(&space(row, example), &parameters, Others::Refuse)
                .unwrap();
            let (state, _) = parts(&noise, &numbers);
            let n = state.len();
            let time = Enclosure::exact;
            let q = |t: f64| noise.at(state, &[time(t)]);
            let f = motion.jacobian_at(state, &[time(2.0)]);
            let (before, during, both) = (q(1.25), q(2.0), q(3.25));
            for i in 0..n {
                for j in 0..n {
                    let mut sum = during[i * n + j].clone();
                    for k in 0..n {
                        for l in 0..n {
                            sum += f[i][k].clone() * before[k * n + l].clone() * f[j][l].clone();
                        }
                    }
                    let off = (both[i * n + j].clone() - sum).magnitude();
                    assert!(off < 1e-75, "{}, ({i}, {j}): {off:e}", row.id);
                    laws += 1;
                }
            }
        }
        assert!(laws > 40, "{laws}");
    });
}

#[test]
fn every_noise_is_symmetric_and_no_variance_is_negative() {
    Enclosure::with_precision(300, || {
        for (row, _, function, numbers) in examples() {
            if row.kind != ModelKind::Noise {
                continue;
            }
            let (state, given) = parts(&function, &numbers);
            let (n, q) = (state.len(), function.at(state, given));
            for i in 0..n {
                assert!(q[i * n + i] > Enclosure::zero(), "{}", row.id);
                for j in 0..n {
                    let off = q[i * n + j].clone() - q[j * n + i].clone();
                    assert!(off.contains(&Rational::zero()) && off.magnitude() < 1e-80, "{}", row.id);
                    // No correlation is beyond one.
                    let product = q[i * n + i].clone() * q[j * n + j].clone();
                    let square = q[i * n + j].clone() * q[i * n + j].clone();
                    assert!((product - square).upper() >= Rational::zero(), "{}", row.id);
                }
            }
        }
    });
}

#[test]
fn doubles_lose_of_singers_noise_what_its_row_says() {
    let note = model("singer-white-noise").unwrap().note.as_ref().unwrap();
    assert!(
        note.contains("10⁻¹³ of itself at b = 2, 10⁻¹¹ at b = 4 and 10⁻⁸ at b = 8, and has no right digit at b = 20")
    );
    for (b, least, greatest) in [
        (0.01, 0.0, 1e-14),
        (2.0, 0.0, 1e-13),
        (4.0, 0.0, 1e-11),
        (8.0, 1e-12, 1e-8),
        (20.0, 0.5, 1e9),
    ] {
        let parameters = [("alpha", Rational::from_f64(b)), ("variance", Rational::integer(1))];
        let noise = model("singer-white-noise")
            .unwrap()
            .noise(&numbers(&LINE), &parameters)
            .unwrap();
        let doubles = noise.at(&[0.0; 3], &[1.0]);
        Enclosure::with_precision(400, || {
            let exact = noise.at(&[0.0; 3].map(Enclosure::exact), &[Enclosure::integer(1)]);
            let off = |(double, exact): (&f64, &Enclosure)| ((double - exact.middle()) / exact.middle()).abs();
            let worst = doubles.iter().zip(&exact).map(off).fold(0.0, f64::max);
            assert!(worst >= least && worst < greatest, "{b}: {worst:e}");
        });
    }
}

// The plain functions of this crate

/// The rows that name a plain function.
const AGREEING: [&str; 13] = [
    "constant-velocity",
    "constant-acceleration",
    "coordinated-turn",
    "constant-velocity-white-noise",
    "constant-velocity-piecewise-noise",
    "constant-acceleration-white-noise",
    "constant-acceleration-piecewise-noise",
    "coordinated-turn-white-noise",
    "coordinated-turn-piecewise-noise",
    "position",
    "range",
    "bearing",
    "range-bearing",
];

type Unknown = RationalFunction;

fn numbers(names: &[&str]) -> Space {
    Space::new(names.iter().map(|name| Component::number(name, "")).collect()).unwrap()
}

/// A function in rational functions of everything that it is a function of.
fn symbolically(id: &str, state: &[&str], parameters: &[&str]) -> Vec<Unknown> {
    let bindings: Vec<(&str, Rational)> = parameters.iter().map(|name| (*name, Rational::integer(1))).collect();
    let function = bind(model(id).unwrap(), &numbers(state), &bindings).unwrap();
    let formulas = function.formulas().unwrap();
    let unknowns: Vec<Unknown> = formulas.names().iter().map(|name| Unknown::unknown(name)).collect();
    formulas.rational_at(&unknowns).unwrap()
}

/// A matrix by rows, as a noise gives it.
fn by_rows<const N: usize>(matrix: &SMatrix<Unknown, N, N>) -> Vec<Unknown> {
    matrix.transpose().iter().cloned().collect()
}

const PLANE: [&str; 4] = ["x", "vx", "y", "vy"];
const LINE: [&str; 3] = ["x", "vx", "ax"];
const POSITIONS_FIRST: [&str; 6] = ["x", "y", "vx", "vy", "ax", "ay"];

#[test]
fn polynomial_models_are_the_plain_functions_for_all_values() {
    let (t, q) = (Unknown::unknown("T"), Unknown::unknown("q"));
    let moved = constant_velocity(&t) * SVector::from(PLANE.map(Unknown::unknown));
    assert_eq!(symbolically("constant-velocity", &PLANE, &[]), moved.as_slice());
    let moved = acceleration::constant_acceleration(&t) * SVector::from(LINE.map(Unknown::unknown));
    assert_eq!(symbolically("constant-acceleration", &LINE, &[]), moved.as_slice());
    let moved = wiener::constant_acceleration_in_the_plane(&t) * SVector::from(POSITIONS_FIRST.map(Unknown::unknown));
    assert_eq!(
        symbolically("constant-acceleration", &POSITIONS_FIRST, &[]),
        moved.as_slice()
    );

    let white = symbolically("constant-velocity-white-noise", &PLANE, &["q"]);
    assert_eq!(white, by_rows(&integrated_noise(&q, &t)));
    let piecewise = symbolically("constant-velocity-piecewise-noise", &PLANE, &["q"]);
    assert_eq!(piecewise, by_rows(&acceleration_noise(&q, &t)));
    assert_eq!(
        piecewise,
        symbolically("coordinated-turn-piecewise-noise", &PLANE, &["q"])
    );
    assert_ne!(white, piecewise, "the one is not the other");
    // Zero for the accelerations that constant velocity does not have.
    let embedded = symbolically("constant-velocity-white-noise", &POSITIONS_FIRST, &["q"]);
    assert_eq!(embedded, by_rows(&wiener::velocity_noise_in_the_plane(&q, &t)));
    let white = symbolically("constant-acceleration-white-noise", &POSITIONS_FIRST, &["q"]);
    assert_eq!(white, by_rows(&wiener::acceleration_noise_in_the_plane(&q, &t)));
    let piecewise = symbolically("constant-acceleration-piecewise-noise", &LINE, &["q"]);
    let response = acceleration::acceleration_response(&t);
    assert_eq!(piecewise, by_rows(&acceleration::response_noise(&response, &q)));
}

#[test]
fn turns_are_the_plain_functions() {
    Enclosure::with_precision(256, || {
        for (w, t) in [(0.25, 2.0), (-1.5, 0.75), (0.0, 3.0), (1e-30, 1.0)] {
            let (rate, interval, density) = (Rational::from_f64(w), Enclosure::exact(t), Rational::integer(3));
            let state = [10.0, 3.0, 20.0, -4.0].map(Enclosure::exact);
            let motion = model("coordinated-turn").unwrap();
            let motion = motion
                .motion(&numbers(&PLANE), &[("w", rate.clone())], Others::Refuse)
                .unwrap();
            let noise = model("coordinated-turn-white-noise").unwrap();
            let noise = noise.noise(&numbers(&PLANE), &[("w", rate), ("q", density)]).unwrap();
            let given = [interval.clone()];
            let turn = coordinated_turn(&Enclosure::exact(w), &interval);
            let expected = turn_noise(&Enclosure::integer(3), &Enclosure::exact(w), &interval);
            let pairs = motion
                .jacobian_at(&state, &given)
                .concat()
                .into_iter()
                .zip(turn.transpose().iter().cloned().collect::<Vec<_>>());
            let of_noise = noise
                .at(&state, &given)
                .into_iter()
                .zip(expected.transpose().iter().cloned().collect::<Vec<_>>());
            for (formula, plain) in pairs.chain(of_noise) {
                assert!(
                    (formula.clone() - plain.clone()).magnitude() < 1e-70,
                    "{formula} {plain}"
                );
            }
        }
    });
}

#[test]
fn measurements_are_the_plain_function_to_the_bit() {
    use PolarComponent::{Bearing, Range};
    let location = [5.0, -2.0];
    let given = [("sensor_x", Rational::integer(5)), ("sensor_y", Rational::integer(-2))];
    let polar = |components: Vec<PolarComponent>| Sensor::<f64, U4, U1>::Polar {
        components,
        position: [0, 2],
        location,
    };
    let both = Sensor::<f64, U4, U2>::Polar {
        components: vec![Range, Bearing],
        position: [0, 2],
        location,
    };
    let linear = Sensor::<f64, U4, U2>::Linear(matrix![1.0, 0.0, 0.0, 0.0; 0.0, 0.0, 1.0, 0.0]);
    for state in [
        [0.0, 1.0, 10.0, 2.0],
        [5.0, 0.0, 3.0, 0.0],
        [-7.1, 0.0, -2.0, 0.0],
        [1e6, 0.0, 0.3, 0.0],
    ] {
        let of = |id: &str, parameters: &[(&str, Rational)]| {
            let (space, h) = model(id).unwrap().measurement(&numbers(&PLANE), parameters).unwrap();
            (space, h.at(&state, &[]))
        };
        let vector = SVector::from(state);
        let (space, z) = of("range-bearing", &given);
        assert_eq!(z, both.of(&vector).as_slice());
        assert_eq!([0, 1].map(|part| space.is_angle(part)), [false, true]);
        assert_eq!(of("range", &given).1, polar(vec![Range]).of(&vector).as_slice());
        assert_eq!(of("bearing", &given).1, polar(vec![Bearing]).of(&vector).as_slice());
        assert_eq!(of("position", &[]).1, linear.of(&vector).as_slice());
        // From another place it is another bearing.
        assert_ne!(of("bearing", &[]).1, polar(vec![Bearing]).of(&vector).as_slice());
    }
}

// Binding

#[test]
fn the_state_says_which_axes_there_are_and_in_which_order() {
    let motion = |names: &[&str]| {
        model("constant-velocity")
            .unwrap()
            .motion(&numbers(names), &[], Others::Refuse)
            .unwrap()
    };
    let line = motion(&["y", "vy"]).at(&[1.0, 2.0], &[0.5]);
    assert_eq!(line, [2.0, 2.0]);
    let space = motion(&["vz", "x", "y", "z", "vy", "vx"]).at(&[6.0, 1.0, 2.0, 3.0, 5.0, 4.0], &[0.5]);
    assert_eq!(space, [6.0, 3.0, 4.5, 6.0, 5.0, 4.0]);
    let (measured, h) = model("position")
        .unwrap()
        .measurement(&numbers(&["vx", "x", "z"]), &[])
        .unwrap();
    assert_eq!(measured.names(), ["x", "z"]);
    assert_eq!(h.at(&[9.0, 1.0, 3.0], &[]), [1.0, 3.0]);
    // A turn among other components, in another order.
    let names = ["w", "vy", "temperature", "vx", "y", "x"];
    let turn = model("coordinated-turn-unknown-rate").unwrap();
    let kept = turn.motion(&numbers(&names), &[], Others::Keep).unwrap();
    let plain = coordinated_turn(&0.25, &2.0) * SVector::from([10.0, 3.0, 20.0, -4.0]);
    let moved = kept.at(&[0.25, -4.0, 7.0, 3.0, 20.0, 10.0], &[2.0]);
    assert_eq!(moved, [0.25, plain[3], 7.0, plain[1], plain[2], plain[0]]);
    let zero = turn.motion(&numbers(&names), &[], Others::Zero).unwrap();
    assert_eq!(zero.at(&[0.25, -4.0, 7.0, 3.0, 20.0, 10.0], &[2.0])[2].to_bits(), 0);
}

#[test]
fn a_model_that_does_not_fit_says_why() {
    let refused = |id: &str, state: &Space, parameters: &[(&str, i64)]| {
        let parameters: Vec<_> = parameters
            .iter()
            .map(|(name, value)| (*name, Rational::integer(*value)))
            .collect();
        bind(model(id).unwrap(), state, &parameters).unwrap_err().to_string()
    };
    let line = numbers(&["x", "vx"]);
    assert_eq!(
        refused("range-bearing", &line, &[]),
        "`range-bearing` needs the component `y`, and the state has `x` and `vx`"
    );
    assert_eq!(
        refused("constant-velocity", &numbers(&["x", "vx", "y", "z"]), &[]),
        "`constant-velocity` needs the components `vy` and `vz`, and the state has `x`, `vx`, `y` and `z`"
    );
    assert_eq!(
        refused("position", &numbers(&["v", "w"]), &[]),
        "`position` needs the component `x`, and the state has `v` and `w`"
    );
    assert_eq!(
        refused("constant-velocity", &numbers(&["x", "vx", "ax"]), &[]),
        "the motion `constant-velocity` says nothing of the component `ax` of the state; say whether it becomes zero or is kept"
    );
    assert_eq!(
        refused("coordinated-turn", &numbers(&PLANE), &[]),
        "the model `coordinated-turn` needs the parameter `w`, turn rate, positive to the left, in rad/s"
    );
    assert_eq!(
        refused("singer", &numbers(&LINE), &[("alpa", 1)]),
        "the model `singer` has no parameter `alpa`; the nearest name is `alpha`"
    );
    assert_eq!(
        refused("singer", &numbers(&LINE), &[("alpha", 1), ("alpha", 2)]),
        "the parameter `alpha` is given twice"
    );
    assert_eq!(
        refused(
            "constant-turn-rate-and-speed",
            &numbers(&["x", "y", "v", "heading", "w"]),
            &[]
        ),
        "`heading` is a number in the state, and an angle in the model `constant-turn-rate-and-speed`"
    );
    let as_motion = model("bearing").unwrap().motion(&line, &[], Others::Keep).unwrap_err();
    assert_eq!(
        as_motion.to_string(),
        "`bearing` is a model of a measurement and not of a motion"
    );
    assert_eq!(
        model("constant-velocty").unwrap_err().to_string(),
        "there is no model `constant-velocty`; the nearest name is `constant-velocity`"
    );
    assert_eq!(model("").unwrap_err().to_string(), "there is no model ``");
    assert_eq!(
        model(&"ω".repeat(100_000)).unwrap_err().to_string().chars().count(),
        64 + 20
    );
}
