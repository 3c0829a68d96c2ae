//! `immaculate answer`: this crate's own filter in doubles, as a program under test. It answers a check's messages as any program does.

use super::{Done, Refusal, print};
use clap::{Args, ValueEnum};
use immaculate::file::read_line;
use immaculate::oracle::answer::{Message, respond};
use immaculate::oracle::subject::{Level, Planted};
use immaculate::oracle::variant::find;

/// How much of a trace the filter shows.
#[derive(Clone, Copy, ValueEnum)]
enum Show {
    /// Every value of a trace
    Everything,
    /// Updated estimates, mode probabilities and the combined estimate
    Posteriors,
    /// Only the combined estimate
    Combined,
}

#[derive(Args)]
#[command(after_help = "Try: immaculate check -- immaculate answer --plant mixed-spread-omitted")]
pub struct AnswerArguments {
    /// Plant a variant of the catalogue, to see how it is found; may be repeated (`immaculate variants` lists them)
    #[arg(long = "plant", value_name = "VARIANT")]
    variants: Vec<String>,
    /// How much of a trace to show
    #[arg(long, value_enum, default_value = "everything")]
    show: Show,
}

pub fn run(arguments: &AnswerArguments) -> Result<Done, Refusal> {
    for id in &arguments.variants {
        if find(id).is_none() {
            return Err(Refusal::request(format!(
                "there is no variant `{id}`; `immaculate variants` lists them"
            )));
        }
    }
    let mut planted = Planted {
        variants: arguments.variants.clone(),
        level: match arguments.show {
            Show::Everything => Level::Everything,
            Show::Posteriors => Level::Posteriors,
            Show::Combined => Level::Combined,
        },
    };
    let wrong = |reason: String| Refusal::Request(format!("standard input: {reason}"));
    let mut input = std::io::stdin().lock();
    while let Some(line) = read_line(&mut input).map_err(|error| wrong(error.to_string()))? {
        let line = String::from_utf8(line).map_err(|_| wrong("a line that is not UTF-8".into()))?;
        match respond(&mut planted, &line) {
            Message::Reply(reply) => {
                if !print(&format!("{reply}\n"))? {
                    break;
                }
            }
            Message::Stop => break,
            Message::NotUnderstood(reason) => return Err(Refusal::request(reason)),
        }
    }
    Ok(String::new().into())
}
