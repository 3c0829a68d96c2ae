//! The command line: the commands, printing, and the exit status. Each command is a file of `cli`.
//!
//! Exit status: 0 if the command is done or the reader of its output stopped reading; 1 if output could not be written, something
//! checked is wrong, or a filter could not compute a step; 2 if arguments or input are wrong or name something that does not exist.

mod cli;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Parser, Subcommand};
pub use cli::Refusal;
use cli::{Done, print};
use immaculate::file::shortened;
use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;

/// The executable specification of the interacting multiple model filter.
#[derive(Parser)]
#[command(name = "immaculate", version, about, arg_required_else_help = true)]
#[command(
    after_help = "Exit status: 0 done; 1 output could not be written, something checked is wrong, or a filter could not compute a step; 2 arguments or input are wrong or name something that does not exist. It is no error if the reader of the output stops reading."
)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Judge a filter in any language: whether it is right, or which equation is wrong and why
    Check(cli::check::CheckArguments),
    /// Write a small filter that passes `check`, with its adapter, in Python, C++, Octave or Rust; replace it with yours
    Init(cli::init::InitArguments),
    /// Run a problem file and print every value of every step, with --digits to proven digits
    Trace(cli::trace::TraceArguments),
    /// Say which filter to use for a problem file: every kind that applies on simulated truth, with errors, consistency and cost
    Compare(cli::compare::CompareArguments),
    /// List, show, copy or prove the certified cases
    Cases(cli::cases::CasesArguments),
    /// List the catalogue of mistakes, conventions and forms that `check` can name
    Variants(cli::variants::VariantsArguments),
    /// Show an equation of the papers: formula, erratum, derivation, code, tests, and the cases that catch mistakes in it
    Equation(cli::equation::EquationArguments),
    /// Write a static site: how filters are checked, mistakes, cases, the papers' figures and claims, the book of equations
    Report(cli::report::ReportArguments),
    /// Rerun the papers' simulations and print their tables beside the published ones
    Reproduce(cli::reproduce::ReproduceArguments),
    /// Judge the papers' claims, each by computation
    Claims(cli::claims::ClaimsArguments),
    /// List the open parameters of the papers' scenarios and their alternatives
    Choices(cli::choices::ChoicesArguments),
    /// List the points and weights of a cubature rule, exact and decimal, with its proven degree
    Rule(cli::rule::RuleArguments),
    /// Prove that two fixed-gain filters that mix their estimates are stable together, or unstable; map, certificates
    Stability(cli::stability::StabilityArguments),
    /// Act as a program under test: the built-in filter, with planted mistakes if you like
    Answer(cli::answer::AnswerArguments),
}

fn main() -> ExitCode {
    ExitCode::from(status_of(std::env::args_os()))
}

/// Runs the command that the arguments ask for, the first of them being the program's name. Prints its output and messages; returns the
/// exit status.
pub fn status_of(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    // A script whose variable is empty must not get the demonstration of a check.
    if arguments.last().is_some_and(|last| last == "--") {
        return complain("nothing to check: there is no program after `--`", 2);
    }
    let done = match Cli::try_parse_from(arguments) {
        Ok(cli) => run(&cli),
        // Help and version are output like any other; what is wrong with arguments goes to standard error.
        Err(error) if !error.use_stderr() => Ok(error.render().to_string().into()),
        Err(error) => {
            // Nothing is left to be done when not even the complaint can be written.
            let _ = error.print();
            if lacks_dashes(&error) {
                let sentence = "put `--` before the program that is checked: `immaculate check -- PROGRAM ARGUMENTS`";
                return complain(sentence, 2);
            }
            return 2;
        }
    };
    match done.and_then(|done| print(&done.text).map(|_| done)) {
        Ok(Done {
            complaint: None,
            status,
            ..
        }) => status,
        Ok(Done {
            complaint: Some(sentence),
            ..
        })
        | Err(Refusal::Output(sentence)) => complain(&sentence, 1),
        Err(Refusal::Request(sentence)) => complain(&sentence, 2),
    }
}

/// Whether the arguments are a check with a program but without the `--` before it.
fn lacks_dashes(error: &clap::Error) -> bool {
    let mut arguments = std::env::args_os().skip(1);
    let is_check = arguments.next().is_some_and(|command| command == "check");
    let is_word =
        matches!(error.get(ContextKind::InvalidArg), Some(ContextValue::String(word)) if !word.starts_with('-'));
    error.kind() == ErrorKind::UnknownArgument && is_check && is_word && arguments.all(|argument| argument != "--")
}

/// Runs the command that the arguments ask for.
///
/// # Errors
///
/// [`Refusal`] with the sentence and, by its kind, the exit status.
pub fn run(cli: &Cli) -> Result<Done, Refusal> {
    match &cli.command {
        Command::Reproduce(arguments) => cli::reproduce::run(arguments),
        Command::Claims(arguments) => cli::claims::run(arguments),
        Command::Report(arguments) => cli::report::run(arguments),
        Command::Rule(arguments) => cli::rule::run(arguments),
        Command::Choices(arguments) => Ok(cli::choices::run(arguments)),
        Command::Check(arguments) => cli::check::run(arguments),
        Command::Init(arguments) => cli::init::run(arguments),
        Command::Compare(arguments) => cli::compare::run(arguments),
        Command::Trace(arguments) => cli::trace::run(arguments),
        Command::Cases(arguments) => cli::cases::run(arguments),
        Command::Variants(arguments) => cli::variants::run(arguments),
        Command::Equation(arguments) => cli::equation::run(arguments),
        Command::Stability(arguments) => cli::stability::run(arguments),
        Command::Answer(arguments) => cli::answer::run(arguments),
    }
}

/// A sentence of bounded length on standard error. Whatever it quotes, it cannot steer a terminal.
fn complain(sentence: &str, status: u8) -> u8 {
    const KEPT: usize = 2000;
    let is_plain = |c: char| c == '\n' || !c.is_control();
    let shown = |c: char| if is_plain(c) { c } else { char::REPLACEMENT_CHARACTER };
    let sentence: String = shortened(sentence, KEPT).chars().map(shown).collect();
    // Nothing is left to be done when not even the complaint can be written.
    let _ = writeln!(std::io::stderr(), "immaculate: {sentence}");
    status
}
