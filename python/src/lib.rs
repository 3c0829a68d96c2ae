//! Immaculate for Python: what the package `immaculate` calls.
//!
//! Whatever crosses the bridge is JSON under the names of `spec/formats.md`, as it is between a check and a program in any other language;
//! the Python side makes arrays of it. Nothing is computed here that the crate computes.

#![forbid(unsafe_code)]

mod problem;
mod subject;

/// The command line: the same file, so that `immaculate` in a terminal is the same program.
#[allow(dead_code, reason = "a program ends with `main`; Python has an end of its own")]
#[path = "../../src/main.rs"]
mod program;

use pyo3::prelude::*;

/// The extension module.
#[pymodule]
mod _immaculate {
    #[pymodule_export]
    use crate::problem::Problem;

    use crate::problem::refused;
    use crate::program;
    use crate::subject::PythonSubject;
    use immaculate::number::Rational;
    use immaculate::oracle::case;
    use immaculate::oracle::check::{Selection, check as check_cases, check_problems};
    use immaculate::oracle::problem::ProblemFile;
    use immaculate::report;
    use immaculate::rule::{Rule, RuleName, unscented};
    use nalgebra::{DVector, Dyn};
    use pyo3::prelude::*;
    use serde_json::json;
    use std::ffi::OsString;

    /// Judges what `asked` answers: the text and the JSON of the verdict, and whether nothing was judged.
    ///
    /// With problems it is asked these, else the published cases that have one of the ids, of the flags and of the kinds; an empty list
    /// has all.
    #[pyfunction]
    fn check(
        py: Python<'_>,
        asked: Py<PyAny>,
        problems: Vec<String>,
        selection: [Vec<String>; 3],
    ) -> PyResult<(String, String, bool)> {
        let own: Result<Vec<_>, _> = problems.iter().map(|text| ProblemFile::read(text)).collect();
        let own = own.map_err(refused)?;
        let [ids, flags, kinds] = selection;
        let selection = Selection { ids, flags, kinds };
        let mut subject = PythonSubject::new(asked);
        let report = py.detach(|| match own[..] {
            [] => check_cases(&mut subject, &selection, &|_| {}),
            _ => check_problems(&mut subject, &own, &|_| {}),
        });
        if let Some(interruption) = subject.interruption {
            return Err(interruption);
        }
        let report = report.map_err(refused)?;
        let json = report::check_json::json(&report).to_string();
        Ok((report::check::text(&report), json, report.is_empty()))
    }

    /// The published cases that are not to be rejected, each with its certified trace as JSON.
    #[pyfunction]
    fn cases() -> PyResult<Vec<(Problem, &'static str)>> {
        let cases = case::all().map_err(refused)?.iter();
        let good = cases.filter(|case| matches!(case.expected, case::Expected::Trace(_)));
        Ok(good
            .map(|case| (case.problem.clone().into(), case.trace_text))
            .collect())
    }

    /// A rule as JSON: points, weights, degree. The parameters are decimals, of the unscented rule.
    #[pyfunction]
    fn rule(name: &str, dimension: usize, parameters: [Option<String>; 3]) -> PyResult<String> {
        let mut rule: RuleName = name.parse().map_err(refused)?;
        if parameters.iter().any(Option::is_some) {
            let RuleName::Unscented(own) = &mut rule else {
                return Err(refused("alpha, beta and kappa are parameters of the rule `unscented`"));
            };
            let own = own.insert(unscented::Parameters::for_gaussian(dimension));
            for (text, parameter) in parameters.iter().zip([&mut own.alpha, &mut own.beta, &mut own.kappa]) {
                if let Some(text) = text {
                    let number = Rational::from_decimal(text);
                    *parameter = number.ok_or_else(|| refused(format!("{text} is not a decimal number")))?;
                }
            }
        }
        let degree = report::rule::describe(&rule, name, dimension)
            .map_err(refused)?
            .proven_degree;
        let doubles: Rule<f64, Dyn> = rule.rule_in(Dyn(dimension)).map_err(refused)?;
        let points: Vec<&[f64]> = doubles.points.iter().map(DVector::as_slice).collect();
        Ok(json!({
            "points": points,
            "weights": doubles.weights,
            "covariance_weights": doubles.covariance_weights,
            "degree": degree,
        })
        .to_string())
    }

    /// The command line with these arguments, the first of them the program's name; the exit status.
    #[pyfunction]
    fn command_line(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
        py.detach(|| program::status_of(arguments))
    }
}
