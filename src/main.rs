//! The command line: reads arguments, calls the library, prints.
//!
//! Exit status: 0 when the command did what was asked, or nobody wanted to read on, 1 when its output could not be written or what it
//! checked is wrong, 2 when its arguments or its input are wrong or name something that does not exist.

mod cli;

pub use cli::Refusal;

use clap::{Args, Parser, Subcommand};
use cli::{Done, MOST_RUNS, check_that_memory_does, effort, json_text, papers, print};
use immaculate::number::Rational;
use immaculate::oracle::invalid::shortened;
use immaculate::paper::Paper;
use immaculate::paper::monte_carlo::Progress;
use immaculate::report;
use immaculate::rule::{RuleName, unscented};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::io::Write;
use std::process::ExitCode;

/// The executable specification of the interacting multiple model filter.
#[derive(Parser)]
#[command(version, about, arg_required_else_help = true)]
#[command(
    after_help = "Exit status: 0 done, 1 output could not be written or something that was checked is wrong, 2 the arguments or the input are wrong or name something that does not exist. A reader that stops reading is no error."
)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Rerun the papers' simulations and set their tables beside the published ones
    Reproduce(cli::reproduce::Reproduce),
    /// Judge what the papers claim, each claim by computation
    Claims(Claims),
    /// Write everything on one page: figures, tables, claims, errata, equations
    Report(cli::report::Report),
    /// List a cubature rule: points and weights, exact and decimal, with its proven degree
    Rule(Rule),
    /// List the open parameters of the papers' scenarios and their alternatives
    Choices(ListChoices),
    /// Judge a filter in any language: right to so many digits, or wrong in which equation, and why
    Check(cli::check::Check),
    /// Run a problem file and print every value of every step; with --digits, proven
    Trace(cli::trace::Trace),
    /// List, show, copy and prove the certified cases
    Cases(cli::cases::Cases),
    /// List the catalogue of mistakes, conventions and forms that `check` can name
    Variants(cli::variants::Variants),
    /// Show an equation of the papers: formula, erratum, derivation, code, tests, and what catches mistakes in it
    Equation(cli::equation::Equation),
    /// Prove two fixed-gain filters that exchange estimates stable together, or unstable; map, certificates
    Stability(cli::stability::Stability),
    /// Be a program under test: this crate's own filter, with mistakes planted on demand
    Answer(cli::answer::Answer),
}

#[derive(Args)]
struct Claims {
    /// The papers; all when none is given [possible: derbez2000, sustika2015, zhu2016, liu2017]
    papers: Vec<Paper>,
    /// The number of Monte-Carlo runs; when not given the paper's own, and 4000 of sustika2015, whose 50 tell little. At most
    /// 2000 of derbez2000 and of liu2017, 15000 of zhu2016: they are kept in memory
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=MOST_RUNS))]
    runs: Option<u64>,
    /// The seed of the random numbers
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

#[derive(Args)]
struct Rule {
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
    /// κ of the unscented rule, as a decimal; 3 − n when not given
    #[arg(long, value_name = "DECIMAL", allow_negative_numbers = true)]
    kappa: Option<String>,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
}

#[derive(Args)]
struct ListChoices {
    /// The papers; all when none is given [possible: derbez2000, sustika2015, zhu2016, liu2017]
    papers: Vec<Paper>,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

fn main() -> ExitCode {
    let done = match Cli::try_parse() {
        Ok(cli) => run(&cli),
        // Help and version are output like any other; what is wrong with arguments goes to standard error.
        Err(error) if !error.use_stderr() => Ok(error.render().to_string().into()),
        Err(error) => error.exit(),
    };
    match done.and_then(|done| print(&done.text).map(|_| done.status)) {
        Ok(status) => ExitCode::from(status),
        Err(Refusal::Output(sentence)) => complain(&sentence, 1),
        Err(Refusal::Request(sentence)) => complain(&sentence, 2),
    }
}

/// Does what the arguments ask for.
///
/// # Errors
///
/// [`Refusal`] with the sentence and, by its kind, the exit status.
pub fn run(cli: &Cli) -> Result<Done, Refusal> {
    match &cli.command {
        Command::Reproduce(arguments) => cli::reproduce::run(arguments),
        Command::Claims(arguments) => claims(arguments).map(Done::from),
        Command::Report(arguments) => cli::report::run(arguments),
        Command::Rule(arguments) => rule(arguments).map(Done::from),
        Command::Choices(arguments) => Ok(choices(arguments).into()),
        Command::Check(arguments) => cli::check::run(arguments),
        Command::Trace(arguments) => cli::trace::run(arguments),
        Command::Cases(arguments) => cli::cases::run(arguments),
        Command::Variants(arguments) => cli::variants::run(arguments),
        Command::Equation(arguments) => cli::equation::run(arguments),
        Command::Stability(arguments) => cli::stability::run(arguments),
        Command::Answer(arguments) => cli::answer::run(arguments),
    }
}

/// A sentence of bounded length on standard error. Whatever it quotes, it cannot steer a terminal.
fn complain(sentence: &str, status: u8) -> ExitCode {
    const KEPT: usize = 2000;
    let is_plain = |c: char| c == '\n' || !c.is_control();
    let shown = |c: char| if is_plain(c) { c } else { char::REPLACEMENT_CHARACTER };
    let sentence: String = shortened(sentence, KEPT).chars().map(shown).collect();
    // Nothing is left to be done when not even the complaint can be written.
    let _ = writeln!(std::io::stderr(), "immaculate: {sentence}");
    ExitCode::from(status)
}

fn claims(arguments: &Claims) -> Result<String, Refusal> {
    let effort = effort(arguments.runs, arguments.seed);
    check_that_memory_does(&papers(&arguments.papers), effort)?;
    let bar = ProgressBar::new_spinner().with_message("judging");
    bar.set_style(
        ProgressStyle::with_template("{spinner} {msg}: {pos} runs, {elapsed}")
            .unwrap_or_else(|_| ProgressStyle::default_spinner()),
    );
    let advance: Progress = &|| bar.inc(1);
    let mut text = String::new();
    let mut values = Vec::new();
    for paper in papers(&arguments.papers) {
        let judgements = paper.judge(effort, advance).map_err(Refusal::request)?;
        text.push_str(&report::claims::heading(paper.specification()));
        text.push_str(&report::claims::text(&judgements));
        text.push_str(&report::claims::summary(&judgements));
        values.push(json!({ "paper": paper.key(), "claims": judgements }));
    }
    bar.finish_and_clear();
    if arguments.json {
        return Ok(json_text(&json!({ "seed": arguments.seed, "papers": values })));
    }
    Ok(text)
}

fn rule(arguments: &Rule) -> Result<String, Refusal> {
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
        return Ok(json_text(&json!(description)));
    }
    Ok(report::rule::text(&description))
}

/// The parameters that are given, the others as in Julier and Uhlmann's original form.
fn unscented_parameters(arguments: &Rule) -> Result<unscented::Parameters, Refusal> {
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

fn choices(arguments: &ListChoices) -> String {
    let papers = papers(&arguments.papers);
    if arguments.json {
        let parameters =
            |paper: &Paper| json!({ "paper": paper.key(), "parameters": paper.specification().parameters });
        let values: Vec<_> = papers.iter().map(parameters).collect();
        return json_text(&json!({ "papers": values }));
    }
    papers
        .iter()
        .map(|paper| report::reproduction::choices(paper.specification()))
        .collect()
}
