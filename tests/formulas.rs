//! Goal: a formula that is read means what it says in every number system, and one that is not read is refused with its place.
//!
//! Method: values by hand, identities in rational functions, enclosures and dual numbers; random texts, and random formulas whose text is
//! known. Kind of evidence: exact where a value is compared, property where texts are drawn. Beside each law stands a form that it
//! refuses.

// Doubles are compared exactly: that they are equal to the last bit is what these laws say.
#![allow(clippy::float_cmp)]

use immaculate::model::formula::{
    DEEPEST, Formulas, InvalidFormula, LARGEST_EXPONENT, LONGEST_TEXT, MOST_OPERATIONS, Written,
};
use immaculate::model::function::{Function, InvalidFunction};
use immaculate::model::space::{Component, InvalidSpace, Space};
use immaculate::model::{PolarComponent, Sensor};
use immaculate::number::{Dual, Enclosure, Field, RandomRounding, Rational, RationalFunction, Real};
use nalgebra::{SVector, U2};
use num_traits::{One, Zero};
use proptest::prelude::*;

// Values

/// Formulas of x, y and t without definitions.
fn read(texts: &[&str]) -> Result<Formulas, InvalidFormula> {
    let formulas: Vec<(&str, &str)> = texts.iter().map(|text| ("result", *text)).collect();
    Formulas::read(&["x", "y", "t"], &[], &formulas)
}

/// The value of a formula of x = 3, y = 4 and t = 2 in doubles.
fn value(text: &str) -> f64 {
    read(&[text])
        .unwrap_or_else(|error| panic!("{error}"))
        .at(&[3.0, 4.0, 2.0])[0]
}

#[test]
fn operations_bind_as_in_a_textbook() {
    for (text, expected) in [
        ("x + y*t", 11.0),
        ("(x + y)*t", 14.0),
        ("x - y - t", -3.0),
        ("x - (y - t)", 1.0),
        ("x/y/t", 3.0 / 8.0),
        ("x/(y/t)", 1.5),
        ("x/y*t", 1.5),
        ("-x^2", -9.0),
        ("(-x)^2", 9.0),
        ("2*x^3", 54.0),
        ("x^-2*9", 1.0),
        ("x^(-1)*6", 2.0),
        ("x**2", 9.0),
        ("x^0 + x^1", 4.0),
        ("- -x", 3.0),
        ("x*-y", -12.0),
        ("+x - +y", -1.0),
        ("  x\t+\n y ", 7.0),
        ("hypot(x, y)", 5.0),
        ("sqrt(x*x + y*y)", 5.0),
        ("2.5e1 + .5 + 1.", 26.5),
        ("x·y × t − y ÷ t", 22.0),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
    // What another order would give.
    assert_ne!(value("x + y*t"), 14.0);
    assert_ne!(value("-x^2"), 9.0);
    assert_ne!(value("x - y - t"), value("x - (y - t)"));
}

#[test]
fn functions_are_those_of_the_number_system() {
    let (x, y) = (3.0_f64, 4.0_f64);
    for (text, expected) in [
        ("exp(x)", Real::exp(&x)),
        ("ln(x)", Real::ln(&x)),
        ("sin(x)", Real::sin(&x)),
        ("cos(x)", Real::cos(&x)),
        ("tan(x)", Real::sin(&x) / Real::cos(&x)),
        ("atan2(y, x)", y.atan2(x)),
        ("pi", std::f64::consts::PI),
        ("c0(x)", x.stumpff(0)),
        ("c9(x)", x.stumpff(9)),
    ] {
        assert_eq!(value(text).to_bits(), expected.to_bits(), "{text}");
    }
    // The first argument of atan2 is y.
    assert_ne!(value("atan2(y, x)"), value("atan2(x, y)"));
}

const EVERYTHING: &str = "hypot(x, y)*exp(-t) + atan2(y, x)^3/ln(x) - c2(t)*sin(pi*x)*cos(y)*tan(t) + sqrt(0.1*x)*t^-2";

#[test]
fn every_number_system_runs_the_same_formula() {
    let formula = read(&[EVERYTHING]).unwrap();
    let double = formula.at(&[3.0, 4.0, 2.0])[0];
    // Without noise the random rounding is the doubles, to the bit; with noise it is near.
    let exact = [3.0, 4.0, 2.0].map(RandomRounding::exact);
    assert_eq!(formula.at(&exact)[0].value().to_bits(), double.to_bits());
    let unit = f64::EPSILON / 2.0;
    let perturbed = RandomRounding::with(unit, 1, || formula.at(&exact)[0].value());
    assert!(perturbed != double && (perturbed - double).abs() < 1e-13);
    Enclosure::with_precision(200, || {
        let values = [3.0, 4.0, 2.0].map(Enclosure::exact);
        let enclosed = formula.at(&values)[0].clone();
        assert!(enclosed.relative_bits() > 180);
        assert!((enclosed.middle() - double).abs() < 1e-14);
        let duals = values.map(Dual::constant);
        let dual = formula.at(&duals)[0].clone();
        assert_eq!(dual.value().to_string(), enclosed.to_string());
        assert!(dual.slope().is_zero());
    });
}

#[test]
fn a_decimal_is_the_double_nearest_to_it() {
    Enclosure::with_precision(200, || {
        let formula = read(&["0.1*x/x", "1e-3", "9007199254740993"]).unwrap();
        let values = formula.at(&[3.0, 4.0, 2.0].map(Enclosure::exact));
        assert!(values[0].contains(&Rational::from_f64(0.1)) && !values[0].contains(&Rational::new(1, 10)));
        assert_eq!(values[1], Enclosure::exact(0.001));
        assert_eq!(values[2], Enclosure::exact(9_007_199_254_740_992.0));
    });
}

#[test]
fn formulas_without_functions_are_run_in_any_field() {
    let formula = read(&["(x + y)^2 - x^2 - 2*x*y", "x/y + y/x", "x^-3"]).unwrap();
    let [x, y, t] = ["x", "y", "t"].map(RationalFunction::unknown);
    let values = formula.rational_at(&[x.clone(), y.clone(), t]).unwrap();
    assert_eq!(values[0], &y * &y);
    assert_eq!(values[1], (&x * &x + &y * &y) / (&x * &y));
    assert_eq!(values[2], RationalFunction::one() / (&x * &x * &x));
    assert_ne!(values[0], &x * &y);
    // A function has no value among rational functions.
    assert!(read(&["sin(x)"]).unwrap().rational_at(&[x]).is_none());
}

#[test]
fn definitions_are_computed_once_and_in_order() {
    // Each definition doubles the one before; written out, the last has 2¹⁰⁰⁰ terms.
    let names: Vec<String> = (0..=1000).map(|k| format!("d{k}")).collect();
    let texts: Vec<String> = (0..=1000)
        .map(|k: usize| {
            k.checked_sub(1)
                .map_or("x".to_owned(), |before| format!("d{before}/2 + d{before}/2"))
        })
        .collect();
    let definitions: Vec<(&str, &str)> = names
        .iter()
        .map(String::as_str)
        .zip(texts.iter().map(String::as_str))
        .collect();
    let formulas = Formulas::read(&["x"], &definitions, &[("y", "d1000")]).unwrap();
    assert_eq!(formulas.at(&[7.0]), [7.0]);
    assert_eq!(formulas.jacobian_at(&[7.0], 1), [[1.0]]);
    assert!(formulas.is_linear_in(1));
    // In the other order they are refused.
    let sentence = Formulas::read(&["x"], &[("b", "a"), ("a", "x")], &[("y", "a")])
        .unwrap_err()
        .to_string();
    assert_eq!(
        sentence,
        "formula of `b`, column 1, at `a`: `a` is only defined after this"
    );
}

// Slopes

#[test]
fn a_jacobian_is_the_limit_of_difference_quotients() {
    // Exactly, for all values: the slope of dual numbers is that of the quotient at h = 0.
    let formula = read(&["x^3*y/t - x^-1", "(x + y)^2/(x - t)"]).unwrap();
    let names = ["x", "y", "t"].map(RationalFunction::unknown);
    for by in 0..3 {
        let mut moved = names.clone();
        moved[by] += RationalFunction::unknown("h");
        let duals = std::array::from_fn::<_, 3, _>(|index| {
            let slope = if index == by {
                RationalFunction::one()
            } else {
                RationalFunction::zero()
            };
            Dual::new(names[index].clone(), slope)
        });
        let slopes = formula.rational_at(&duals).unwrap();
        let (here, there) = (
            formula.rational_at(&names).unwrap(),
            formula.rational_at(&moved).unwrap(),
        );
        for ((slope, here), there) in slopes.iter().zip(here).zip(there) {
            let quotient = (there - here) / RationalFunction::unknown("h");
            let [x, y, t] = names.clone();
            let limit = quotient.substitute(&[("x", x), ("y", y), ("t", t), ("h", RationalFunction::zero())]);
            assert_eq!(slope.slope(), &limit);
        }
    }
    // In enclosures, with functions: central differences are off by h²/6 sup|f‴|, here below 1000 h².
    Enclosure::with_precision(400, || {
        let formula = read(&[EVERYTHING]).unwrap();
        let values = [3.0, 4.0, 2.0].map(Enclosure::exact);
        let jacobian = formula.jacobian_at(&values, 3);
        let h = Enclosure::exact(2.0_f64.powi(-60));
        for by in 0..3 {
            let shifted = |by_how_much: Enclosure| {
                let mut values = values.clone();
                values[by] += by_how_much;
                formula.at(&values)[0].clone()
            };
            let quotient = (shifted(h.clone()) - shifted(-h.clone())) / (h.clone() + h.clone());
            let off = (quotient - jacobian[0][by].clone()).magnitude();
            assert!(off < 1000.0 * h.magnitude() * h.magnitude(), "{by}: {off:e}");
            // The slope by another name is another.
            let other = &jacobian[0][(by + 1) % 3] - &jacobian[0][by];
            assert!(!other.contains(&Rational::zero()));
        }
    });
}

#[test]
fn what_is_linear_is_seen_from_its_operations() {
    let names = ["x", "y", "t"];
    let is_linear = |text: &str, by: usize| Formulas::read(&names, &[], &[("z", text)]).unwrap().is_linear_in(by);
    for text in [
        "x",
        "7",
        "t^2",
        "x + t*y",
        "-(x - y)/2",
        "x/t^3",
        "(x + 1)*sin(t)",
        "x*t*t",
        "x^1",
        "y^0",
        "0*x",
    ] {
        assert!(is_linear(text, 2), "{text}");
    }
    for text in [
        "x*y",
        "x^2",
        "x/y",
        "1/x",
        "sin(x)",
        "hypot(x, t)",
        "x^-1",
        "t*c1(y)",
        "(x + 1)*(y + 1)",
    ] {
        assert!(!is_linear(text, 2), "{text}");
    }
    // In t it is linear, and no more if t is a component of the state.
    assert!(is_linear("x + t*y", 2) && !is_linear("x + t*y", 3));
    assert!(!is_linear("x*x/x", 1), "decided by the operations alone");
}

// Places and sentences

/// The sentence about the text of a formula of x, vx and T.
fn sentence(text: &str) -> String {
    let refused = Formulas::read(&["x", "vx", "T"], &[("d", "x*2")], &[("x", text)]);
    refused.expect_err(text).to_string()
}

/// Each text with the sentence that refuses it.
fn check_sentences(cases: &[(&str, &str)]) {
    for (text, expected) in cases {
        assert_eq!(sentence(text), format!("formula of `x`, {expected}"));
    }
}

#[test]
fn names_and_calls_are_refused_with_their_place() {
    check_sentences(&[
        ("", "column 1, at ``: nothing is written"),
        (" \t", "column 1, at ` \\t`: nothing is written"),
        (
            "x + T*xv",
            "column 7, at `x + T*xv`: `xv` is not known here; the nearest name is `vx`",
        ),
        (
            "x + temperature",
            "column 5, at `x + temperature`: `temperature` is not known here",
        ),
        (
            "sine(x)",
            "column 1, at `sine(x)`: there is no function `sine`; the nearest name is `sin`",
        ),
        (
            "log(x)",
            "column 1, at `log(x)`: there is no function `log`; the nearest name is `ln`",
        ),
        (
            "atan2(x)",
            "column 1, at `atan2(x)`: `atan2` takes 2 arguments and not 1",
        ),
        (
            "2*sin(x, vx)",
            "column 3, at `2*sin(x, vx)`: `sin` takes 1 argument and not 2",
        ),
        ("sin()", "column 1, at `sin()`: `sin` takes 1 argument and not 0"),
        (
            "x(vx)",
            "column 1, at `x(vx)`: `x` is a number and not a function; a product is written `x*(…)`",
        ),
        (
            "pi(2)",
            "column 1, at `pi(2)`: `pi` is a number and not a function; a product is written `pi*(…)`",
        ),
        (
            "sin + x",
            "column 1, at `sin + x`: `sin` is a function; its argument stands in parentheses, as in `sin(…)`",
        ),
        (
            "c10(x)",
            "column 1, at `c10(x)`: there is no function `c10`: the Stumpff functions are c0 to c9",
        ),
    ]);
}

#[test]
fn signs_and_powers_are_refused_with_their_place() {
    check_sentences(&[
        (
            "(x + vx",
            "column 8, at `(x + vx`: the parenthesis of column 1 is not closed before the end",
        ),
        (
            "sin(x",
            "column 6, at `sin(x`: the parenthesis of column 4 is not closed before the end",
        ),
        ("x + vx)", "column 7, at `x + vx)`: no parenthesis is open here"),
        (
            "x, vx",
            "column 2, at `x, vx`: a comma only stands between the arguments of a function; decimals have a point",
        ),
        (
            "(1,5)*x",
            "column 3, at `(1,5)*x`: a comma only stands between the arguments of a function; decimals have a point",
        ),
        (
            "x + ",
            "column 5, at `x + `: a number, name or parenthesis is missing before the end",
        ),
        (
            "x + * vx",
            "column 5, at `x + * vx`: a number, name or parenthesis is missing before `*`",
        ),
        (
            "()",
            "column 2, at `()`: a number, name or parenthesis is missing before `)`",
        ),
        ("2 x", "column 3, at `2 x`: an operator is missing before `x`"),
        ("2exp(x)", "column 2, at `2exp(x)`: an operator is missing before `exp`"),
        ("2e", "column 2, at `2e`: an operator is missing before `e`"),
        ("2x", "column 2, at `2x`: an operator is missing before `x`"),
        ("(x)(vx)", "column 4, at `(x)(vx)`: an operator is missing before `(`"),
        (
            "x^y",
            "column 3, at `x^y`: an exponent is an integer in digits, such as `2` or `-1`; other powers are `sqrt(a)` and `exp(b*ln(a))`",
        ),
        (
            "x^0.5",
            "column 3, at `x^0.5`: an exponent is an integer in digits, such as `2` or `-1`; other powers are `sqrt(a)` and `exp(b*ln(a))`",
        ),
        ("x^-65", "column 4, at `x^-65`: the exponent 65 is beyond ±64"),
        (
            "x^99999999999999999999",
            "column 3, at `x^99999999999999999999`: the exponent 99999999999999999999 is beyond ±64",
        ),
        (
            "x^",
            "column 3, at `x^`: a number, name or parenthesis is missing before the end",
        ),
        (
            "x^2^3",
            "column 4, at `x^2^3`: two powers in a row; say with parentheses which is meant first",
        ),
        (
            "x/0",
            "column 3, at `x/0`: what stands here is a constant, exactly zero, and is divided by",
        ),
        (
            "sqrt(-4)",
            "column 1, at `sqrt(-4)`: `sqrt` has no value at this constant",
        ),
    ]);
}

#[test]
fn characters_and_numbers_are_refused_with_their_place() {
    check_sentences(&[
        ("1e400*x", "column 1, at `1e400*x`: `1e400` is larger than every double"),
        ("1e99999*x", "column 1, at `1e99999*x`: `1e99999` is not a number"),
        (".*x", "column 1, at `.*x`: `.` is not a number"),
        (
            "x[1]",
            "column 2, at `x[1]`: `[` does not belong in a formula; components are named, and parentheses are round",
        ),
        (
            "y = x",
            "column 3, at `y = x`: `=` does not belong in a formula; a formula is what stands after the `=`",
        ),
        (
            "x > 0 ? x : 0",
            "column 3, at `x > 0 ? x : 0`: `>` does not belong in a formula; formulas have no branches",
        ),
        (
            "π*x",
            "column 1, at `π*x`: `π` does not belong in a formula; write `pi`",
        ),
        (
            "ω*x",
            "column 1, at `ω*x`: `ω` does not belong in a formula; names have Latin letters without accents",
        ),
        (
            "x²",
            "column 2, at `x²`: `²` does not belong in a formula; write a power as `^2`",
        ),
        (
            "√x",
            "column 1, at `√x`: `√` does not belong in a formula; write `sqrt(…)`",
        ),
        (
            "x\u{0}",
            "column 2, at `x\\u{0}`: `\\u{0}` does not belong in a formula",
        ),
        ("\"x\"", "column 1, at `\"x\"`: `\"` does not belong in a formula"),
    ]);
    // Columns are characters, and a long text is cut around the place.
    let long = format!(
        "{} + ä + {}",
        vec!["x·vx"; 20].join(" + "),
        vec!["x·vx"; 20].join(" + ")
    );
    let expected = "column 141, at `…·vx + x·vx + x·vx + ä + x·vx + x·vx + x·…`: `ä` does not belong in a formula; \
                    names have Latin letters without accents";
    assert_eq!(sentence(&long), format!("formula of `x`, {expected}"));
}

#[test]
fn definitions_that_cannot_be_are_refused() {
    let refused = |names: &[&str], definitions: &[(&str, &str)]| {
        Formulas::read(names, definitions, &[("y", "x")])
            .expect_err("refused")
            .to_string()
    };
    assert_eq!(
        refused(&["x"], &[("a", "x + a")]),
        "formula of `a`, column 5, at `x + a`: `a` is used in its own definition"
    );
    assert_eq!(
        refused(&["x"], &[("a", "x + b"), ("b", "x")]),
        "formula of `a`, column 5, at `x + b`: `b` is only defined after this"
    );
    assert_eq!(refused(&["x", "x"], &[]), "the name `x` is used twice");
    assert_eq!(refused(&["x"], &[("x", "2")]), "the name `x` is used twice");
    assert_eq!(refused(&["x"], &[("a", "2"), ("a", "3")]), "the name `a` is used twice");
    for name in ["sin", "pi", "c0", "c77", "atan2"] {
        let expected = format!("`{name}` cannot be chosen as a name: formulas know it as a function or number");
        assert_eq!(refused(&["x", name], &[]), expected);
        assert_eq!(refused(&["x"], &[(name, "1")]), expected);
    }
    for name in ["", "2x", "x-y", "ω", "a b", &"a".repeat(65)] {
        assert!(
            refused(&["x", name], &[]).contains("is not a name: a name is a letter and"),
            "{name}"
        );
    }
    assert!(Formulas::read(&["x", "_c", "cx", &"a".repeat(64)], &[], &[("y", "x")]).is_ok());
}

#[test]
fn a_division_that_can_have_no_answer_is_refused() {
    for text in [
        "1/0",
        "x/(2 - 2)",
        "x/(0.5 - 1/2)",
        "1/sin(0)",
        "1/(cos(0) - 1)",
        "1/(sqrt(4) - 2)",
        "1/(hypot(3, 4) - 5)",
        "1/ln(1)",
        "1/(0*x)",
        "1/(x*(1 - 1)*2)",
        "(3 - 3)^-2",
        "1/(c2(0) - 1/2)",
        "1/-0",
        "1/(2^10 - 1024)",
        "1/(exp(0) - x^0)",
        "1/atan2(0, 2)",
        "1/0e5",
        "1/1e-400",
    ] {
        let said = sentence(text);
        assert!(
            said.ends_with("is a constant, exactly zero, and is divided by"),
            "{text}: {said}"
        );
    }
    let defined = Formulas::read(&["x"], &[("zero", "3 - 3")], &[("y", "x/zero")]).unwrap_err();
    assert!(defined.to_string().contains("column 3, at `x/zero`"), "{defined}");
    for text in ["sqrt(1 - 2)", "ln(0)", "ln(-1)", "atan2(0, 0)"] {
        assert!(sentence(text).ends_with("has no value at this constant"), "{text}");
    }
    // What is not a constant is not judged, nor is 0.1 · 3 − 0.3, which is not zero in doubles taken exactly.
    for text in [
        "1/x",
        "1/(x - x)",
        "1/(0.1*3 - 0.3)",
        "1/(sqrt(2) - 1)",
        "1/(sqrt(1/2) - 1)",
        "1/sin(pi)",
        "0/2",
        "x^-1",
    ] {
        assert!(read(&[text]).is_ok(), "{text}");
    }
    assert!(!read(&["1/(x - x)"]).unwrap().at(&[3.0])[0].is_decided());
}

// Bounds

#[test]
fn depth_length_and_number_of_operations_are_bounded() {
    let nested = |open: &str, depth: usize, close: &str| format!("{}x{}", open.repeat(depth), close.repeat(depth));
    for (open, close) in [("(", ")"), ("sin(", ")"), ("-", ""), ("2*(", ")"), ("-(", ")")] {
        let levels = open.matches(['(', '-']).count();
        assert!(read(&[&nested(open, DEEPEST / levels, close)]).is_ok(), "{open}");
        for depth in [DEEPEST / levels + 1, 1000] {
            assert!(
                sentence(&nested(open, depth, close)).contains("nested more than 100 deep"),
                "{open} {depth}"
            );
        }
    }
    assert!(sentence(&"(".repeat(9000)).contains("nested more than 100 deep"));
    // A megabyte is refused at once; a text as long as may be is read, run and printed.
    assert!(sentence(&"x + ".repeat(250_000)).ends_with("a formula has at most 10000 bytes"));
    let terms = LONGEST_TEXT / 2;
    let long = vec!["x"; terms].join("+");
    assert_eq!(read(&[&long]).unwrap().at(&[1.0]), [terms as f64]);
    assert_eq!(
        read(&[&long]).unwrap().written().formulas[0].1,
        long.replace('+', " + ")
    );
    assert!(sentence(&format!("{long} + x")).ends_with("a formula has at most 10000 bytes"));
    // Many formulas together.
    let fits = MOST_OPERATIONS / (2 * terms);
    assert!(read(&vec![long.as_str(); fits]).is_ok());
    let error = read(&vec![long.as_str(); fits + 1]).unwrap_err().to_string();
    assert!(
        error.ends_with("formulas have at most 20000 operations together"),
        "{error}"
    );
}

#[test]
fn constants_of_any_size_take_no_time() {
    // ((9⁶⁴)⁶⁴)⁶⁴ has 831 000 bits, and another power 53 million: not followed, and no zero.
    let tower = "(((9^64)^64)^64)^64";
    for text in [tower, &format!("1/{tower}"), &format!("1/({tower} - {tower})")] {
        let formula = read(&[text]).unwrap();
        Enclosure::with_precision(100, || drop(formula.at(&[Enclosure::one()])));
        assert!(formula.at(&[1.0]).len() == 1);
    }
    assert_eq!(
        read(&[&format!("x^{LARGEST_EXPONENT}")]).unwrap().at(&[2.0]),
        [2.0_f64.powi(64)]
    );
}

// Any text

/// Texts of the pieces that formulas are made of.
fn nearly_formulas() -> impl Strategy<Value = String> {
    let pieces = prop::sample::select(vec![
        "x", "y", "t", "d", "pi", "sin", "atan2", "c1", "c10", "hypot", "(", ")", "(", ")", ",", "+", "-", "*", "/",
        "^", "**", "·", "−", " ", "0", "2", "0.5", "1e3", "e", ".", "64", "-1", "[", "=", "π", "²", "\n", "\u{0}", "ä",
    ]);
    prop::collection::vec(pieces, 0..60).prop_map(|pieces| pieces.concat())
}

/// Formulas that are right, with the signs that a printer would not use.
fn right_formulas() -> impl Strategy<Value = String> {
    let leaf = prop::sample::select(vec!["x", "y", "t", "d", "2", "0.1", "7e-3", "pi", "1e20"]).prop_map(str::to_owned);
    leaf.prop_recursive(6, 60, 3, |inner| {
        let two = (inner.clone(), inner.clone());
        prop_oneof![
            two.clone().prop_map(|(a, b)| format!("{a} + {b}")),
            two.clone().prop_map(|(a, b)| format!("{a} - ({b})")),
            two.clone().prop_map(|(a, b)| format!("({a})·({b})")),
            two.clone().prop_map(|(a, b)| format!("({a})/(2 + ({b})^2)")),
            two.clone().prop_map(|(a, b)| format!("atan2({a}, {b})")),
            two.prop_map(|(a, b)| format!("({a})*-({b})")),
            inner.clone().prop_map(|a| format!("-{a}")),
            inner.clone().prop_map(|a| format!("sin({a})")),
            inner.clone().prop_map(|a| format!("c3({a})")),
            (inner.clone(), -4_i32..5).prop_map(|(a, n)| format!("(({a}))^{n}")),
            inner.prop_map(|a| format!("( {a} )")),
        ]
    })
}

/// What a text may do, read or refused: nothing but that.
fn look_at(text: &str) {
    match Formulas::read(&["x", "y", "t"], &[("d", "x*2")], &[("result", text)]) {
        Ok(formulas) => {
            let written = formulas.written();
            assert_eq!(read_again(&written).as_ref(), Ok(&formulas), "{text}");
            assert_eq!(formulas.at(&[0.0, -1.5, 1e300]).len(), 1);
            Enclosure::with_precision(30, || drop(formulas.at(&[0.0, -1.5, 1e300].map(Enclosure::exact))));
            assert_eq!(formulas.jacobian_at(&[1.0, 2.0, 3.0], 3)[0].len(), 3);
            let _ = formulas.is_linear_in(2);
        }
        Err(error) => {
            let sentence = error.to_string();
            assert!(
                sentence.len() < 600 && !sentence.contains('\n') && !sentence.contains('\u{0}'),
                "{sentence}"
            );
            if let InvalidFormula::Text { column, .. } = error {
                assert!((1..=text.chars().count() + 1).contains(&column), "{column}: {text}");
            }
        }
    }
}

fn read_again(written: &Written) -> Result<Formulas, InvalidFormula> {
    fn borrowed(texts: &[(String, String)]) -> Vec<(&str, &str)> {
        texts
            .iter()
            .map(|(name, text)| (name.as_str(), text.as_str()))
            .collect()
    }
    Formulas::read(
        &["x", "y", "t"],
        &borrowed(&written.definitions),
        &borrowed(&written.formulas),
    )
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    #[test]
    fn any_text_is_read_or_refused(text in any::<String>()) {
        look_at(&text);
    }

    #[test]
    fn any_text_of_the_right_pieces_is_read_or_refused(text in nearly_formulas()) {
        look_at(&text);
    }

    #[test]
    fn a_changed_formula_is_read_or_refused(
        text in right_formulas(),
        at in any::<prop::sample::Index>(),
        piece in nearly_formulas(),
        left_out in 0_usize..4,
    ) {
        let characters: Vec<char> = text.chars().collect();
        let at = at.index(characters.len());
        let rest = characters[at..].iter().skip(left_out);
        let changed: String = characters[..at].iter().copied().chain(piece.chars().take(3)).chain(rest.copied()).collect();
        look_at(&changed);
    }

    #[test]
    fn what_is_printed_is_read_again(text in right_formulas()) {
        let Ok(formulas) = Formulas::read(&["x", "y", "t"], &[("d", "x*2")], &[("result", &text)]) else {
            // Constants whose value would be a division by zero or a root of a negative number.
            return Ok(());
        };
        let written = formulas.written();
        let again = read_again(&written).unwrap();
        prop_assert_eq!(&again, &formulas);
        prop_assert_eq!(again.written(), written);
        let values = [1.5, -0.25, 3.0];
        prop_assert_eq!(again.at(&values)[0].to_bits(), formulas.at(&values)[0].to_bits());
    }
}

#[test]
fn parentheses_are_printed_where_they_are_needed_only() {
    for (text, printed) in [
        ("((x)) + (y*(t))", "x + y*t"),
        ("x - (y - t)", "x - (y - t)"),
        ("(x - y) - t", "x - y - t"),
        ("x/(y*t)", "x/(y*t)"),
        ("(x/y)*t", "x/y*t"),
        ("-(x + y)", "-(x + y)"),
        ("(-x)^2", "(-x)^2"),
        ("-(x^2)", "-x^2"),
        ("x - -y", "x - (-y)"),
        ("(x + y)**(-2)", "(x + y)^-2"),
        (
            "0.10*1e3*123456789012345678901234567890",
            "0.1*1000*1.2345678901234568e29",
        ),
    ] {
        assert_eq!(read(&[text]).unwrap().written().formulas[0].1, printed);
    }
    let shown = Formulas::read(&["x"], &[("a", "x^2")], &[("y", "a/2")])
        .unwrap()
        .to_string();
    assert_eq!(shown, "a = x^2\ny = a/2\n");
}

// Spaces

#[test]
fn components_of_a_space_have_names_of_their_own() {
    let of = |components: Vec<Component>| Space::new(components).map(|space| space.dimension());
    let number = |name: &str| Component::number(name, "m");
    assert_eq!(of(vec![number("x"), number("y"), Component::angle("heading")]), Ok(3));
    assert_eq!(of(Vec::new()), Err(InvalidSpace::Empty));
    let sentence = |components| of(components).unwrap_err().to_string();
    assert_eq!(
        sentence(vec![number("x"), Component::angle("x")]),
        "the name `x` is used twice"
    );
    let reserved = "`tan` cannot be chosen as a name: formulas know it as a function or number";
    assert_eq!(sentence(vec![number("tan")]), reserved);
    assert!(sentence(vec![number("x y")]).starts_with("`x y` is not a name"));
    let mut degrees = Component::angle("bearing");
    degrees.unit = "deg".into();
    assert_eq!(
        sentence(vec![degrees]),
        "`bearing` is an angle and has the unit `deg`; angles are in radians, `rad`"
    );
}

/// Range and bearing, as a space.
fn polar() -> Space {
    Space::new(vec![Component::number("range", "m"), Component::angle("bearing")]).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn a_space_measures_as_the_polar_measurement_does(
        a in [-9.0..9.0_f64, -9.0..9.0], b in [-9.0..9.0_f64, -9.0..9.0], centre in [-9.0..9.0_f64, -3.0..3.0], weight in 0.0..1.0_f64,
    ) {
        let measurement = Sensor::<f64, U2, U2>::Polar {
            components: vec![PolarComponent::Range, PolarComponent::Bearing],
            position: [0, 1],
            location: [0.0, 0.0],
        };
        let vector = |values: [f64; 2]| SVector::<f64, 2>::from(values);
        let difference = measurement.difference(&vector(a), &vector(b));
        prop_assert_eq!(&polar().difference(&a, &b)[..], difference.as_slice());
        let weights = [weight, 1.0 - weight];
        let mean = measurement.mean(&weights, &[vector(a), vector(b)], &vector(centre));
        prop_assert_eq!(&polar().mean(&weights, &[a.to_vec(), b.to_vec()], &centre)[..], mean.as_slice());
        // The bearing is not averaged as a number where only one of both jumps: it is off by a whole turn times the weight.
        if (a[1] - centre[1]).abs() > 3.2 && (b[1] - centre[1]).abs() < 3.1 && weight > 0.01 {
            prop_assert!((mean[1] - (weights[0] * a[1] + weights[1] * b[1])).abs() > 1e-3);
        }
    }

    #[test]
    fn a_wrapped_vector_differs_by_whole_turns_in_its_angles(range in -99.0..99.0_f64, bearing in -99.0..99.0_f64) {
        let wrapped = polar().wrap(&[range, bearing]);
        prop_assert_eq!(wrapped[0], range);
        let pi = std::f64::consts::PI;
        prop_assert!(wrapped[1] > -pi && wrapped[1] <= pi);
        let turns = (bearing - wrapped[1]) / (2.0 * pi);
        // At most 16 turns, each taken away with half a unit in the last place of 99.
        prop_assert!((turns - turns.round()).abs() < 1e-13);
    }
}

#[test]
fn the_mean_of_angles_does_not_depend_on_the_turn_they_are_counted_from() {
    Enclosure::with_precision(120, || {
        let turn = Enclosure::pi() * Enclosure::integer(2);
        let weights = [Enclosure::ratio(1, 4), Enclosure::ratio(3, 4)];
        let value = |bearing: Enclosure| vec![Enclosure::integer(5), bearing];
        let mean = |turns: i64| {
            let values = [
                value(Enclosure::exact(3.0) + turn.clone() * Enclosure::integer(turns)),
                value(Enclosure::exact(-3.0)),
            ];
            polar().mean(&weights, &values, &[Enclosure::zero(), Enclosure::exact(3.125)])
        };
        for turns in [-3, 1, 7] {
            let difference = polar().difference(&mean(turns), &mean(0));
            assert!(
                difference
                    .iter()
                    .all(|part| part.contains(&Rational::zero()) && part.magnitude() < 1e-30)
            );
        }
        // The mean of 3 and −3 is near the half turn, and not −1.5 as the numbers' is.
        assert!(mean(0)[1] > Enclosure::integer(3));
        // Whether an angle that is known to be near the half turn is above it is not decided, nor is the mean then.
        let unsure = [value(Enclosure::pi()), value(Enclosure::zero())];
        assert!(!polar().mean(&weights, &unsure, &[Enclosure::zero(), Enclosure::zero()])[1].is_decided());
    });
}

// Functions

#[test]
fn a_matrix_and_its_formulas_are_the_same_function() {
    let rows = vec![
        vec![Rational::new(1, 2), Rational::integer(-3)],
        vec![Rational::zero(), Rational::from_f64(0.1)],
    ];
    let matrix = Function::of_matrix(rows, Some(vec![Rational::integer(7), Rational::zero()])).unwrap();
    let formulas = [("a", "x/2 - 3*y + seven"), ("b", "0.1*y")];
    let same = Function::of_formulas(&["x", "y"], &[], &[("seven", Rational::integer(7))], &[], &formulas).unwrap();
    let other = Function::of_formulas(&["x", "y"], &[], &[("seven", Rational::integer(8))], &[], &formulas).unwrap();
    assert!(matrix.is_linear() && same.is_linear());
    assert_eq!(
        (matrix.components(), matrix.dimension()),
        (same.components(), same.dimension())
    );
    Enclosure::with_precision(200, || {
        let state = [3.0, -5.0].map(Enclosure::exact);
        // Halves, and products of a double with an integer, are exact.
        assert_eq!(matrix.at(&state, &[]), same.at(&state, &[]));
        assert_eq!(matrix.jacobian_at(&state, &[]), same.jacobian_at(&state, &[]));
        assert_ne!(matrix.at(&state, &[]), other.at(&state, &[]));
    });
    assert!(!matrix.at(&[1.0], &[])[0].is_decided(), "a state that is too short");
}

#[test]
fn what_is_given_stands_between_state_and_parameters() {
    let moved = Function::of_formulas(
        &["x", "v"],
        &["T", "u"],
        &[("gain", Rational::integer(10))],
        &[("push", "gain*u")],
        &[("x", "x + T*v"), ("v", "v + T*push")],
    )
    .unwrap();
    assert_eq!(moved.given(), ["T", "u"]);
    assert_eq!(moved.at(&[1.0, 2.0], &[0.5, 3.0]), [2.0, 17.0]);
    assert_eq!(moved.jacobian_at(&[1.0, 2.0], &[0.5, 3.0]), [[1.0, 0.5], [0.0, 1.0]]);
    assert!(!moved.at(&[1.0, 2.0], &[0.5])[1].is_decided(), "without the input");
}

#[test]
fn functions_that_are_none_are_refused() {
    let one = Rational::one;
    let sentence = |refused: Result<Function, InvalidFunction>| refused.unwrap_err().to_string();
    assert_eq!(
        sentence(Function::of_matrix(Vec::new(), None)),
        "the matrix has no entries"
    );
    assert_eq!(
        sentence(Function::of_matrix(vec![Vec::new()], None)),
        "the matrix has no entries"
    );
    assert_eq!(
        sentence(Function::of_matrix(vec![vec![one(), one()], vec![one()]], None)),
        "row 2 of the matrix has 1 entries and not 2, as the first row has"
    );
    assert_eq!(
        sentence(Function::of_matrix(vec![vec![one()]], Some(vec![one(), one()]))),
        "the offset has 2 entries, and the matrix 1 rows"
    );
    assert_eq!(
        sentence(Function::of_matrix(vec![vec![Rational::undecided()]], None)),
        "`an entry of the matrix or offset` has no value"
    );
    let undecided = [("a", Rational::undecided())];
    assert_eq!(
        sentence(Function::of_formulas(&["x"], &[], &undecided, &[], &[("y", "x")])),
        "`a` has no value"
    );
    let twice = Function::of_formulas(&["x", "T"], &["T"], &[], &[], &[("y", "x")]);
    assert_eq!(sentence(twice), "the name `T` is used twice");
}
