//! `immaculate rule`: a cubature rule with its proven degree.

use super::{Done, Refusal, json_text};
use clap::Args;
use immaculate::number::Rational;
use immaculate::report;
use immaculate::rule::{RuleName, unscented};
use serde_json::json;

#[derive(Args)]
pub struct RuleArguments {
    /// The rule's name: cubature-3, unscented, cubature-5, simplex-5, gauss-hermite-2 to -5, and the printed forms
    /// cubature-5-printed, simplex-5-printed-11, simplex-5-printed-16
    name: String,
    /// The dimension n
    #[arg(long, short = 'n', value_name = "N")]
    dimension: usize,
    /// α of the unscented rule, as a decimal
    #[arg(long, value_name = "DECIMAL", allow_negative_numbers = true)]
    alpha: Option<String>,
    /// β of the unscented rule, as a decimal
    #[arg(long, value_name = "DECIMAL", allow_negative_numbers = true)]
    beta: Option<String>,
    /// κ of the unscented rule, as a decimal; 3 − n by default
    #[arg(long, value_name = "DECIMAL", allow_negative_numbers = true)]
    kappa: Option<String>,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &RuleArguments) -> Result<Done, Refusal> {
    let mut name: RuleName = arguments.name.parse().map_err(Refusal::request)?;
    let parameters = [&arguments.alpha, &arguments.beta, &arguments.kappa];
    if parameters.iter().any(|parameter| parameter.is_some()) {
        if !matches!(name, RuleName::Unscented(_)) {
            let sentence = "--alpha, --beta and --kappa are parameters of the rule `unscented`";
            return Err(Refusal::request(sentence));
        }
        name = RuleName::Unscented(Some(unscented_parameters(arguments)?));
    }
    let description = report::rule::describe(&name, &arguments.name, arguments.dimension).map_err(Refusal::request)?;
    if arguments.json {
        return Ok(json_text(&json!(description)).into());
    }
    Ok(report::rule::text(&description).into())
}

/// The given parameters; the others as in Julier and Uhlmann's original form.
fn unscented_parameters(arguments: &RuleArguments) -> Result<unscented::Parameters, Refusal> {
    let mut parameters = unscented::Parameters::for_gaussian(arguments.dimension);
    let given = [
        ("alpha", &arguments.alpha, &mut parameters.alpha),
        ("beta", &arguments.beta, &mut parameters.beta),
        ("kappa", &arguments.kappa, &mut parameters.kappa),
    ];
    for (name, text, parameter) in given {
        if let Some(text) = text {
            *parameter = Rational::from_decimal(text)
                .ok_or_else(|| Refusal::request(format!("--{name}: `{text}` is not a decimal number")))?;
        }
    }
    Ok(parameters)
}
