//! `immaculate check --search`: looks for a problem on which a program fails.
//!
//! The problem that is found is written to a file, and the report ends with the command to see it again.

use super::progress::bar;
use super::{Done, Refusal, json_text, write_file};
use clap::Args;
use immaculate::oracle::case::problem_text;
use immaculate::oracle::check::NotMade;
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::search::{Request, Searched, ShrinkingLimits, search};
use immaculate::oracle::subject::Subject;
use immaculate::report;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The limits of shrinking: a number of problems and a time.
const SHRINKING: ShrinkingLimits = ShrinkingLimits {
    tries: 3000,
    time: Duration::from_secs(60),
};

#[derive(Args)]
pub struct SearchArguments {
    /// Search for this many seconds for a problem on which the program fails: random problems of all kinds that it declares, or variations
    /// of --problem; the first failure is shrunk, explained, and written to a file
    #[arg(long, value_name = "SECONDS", num_args = 0..=1, default_missing_value = "30", value_parser = clap::value_parser!(u64).range(1..=86400),
          conflicts_with_all = ["answers", "cases", "flags", "strict"])]
    search: Option<u64>,
    /// The seed of the search; another seed draws other problems
    #[arg(long, value_name = "N", default_value_t = 1, requires = "search")]
    seed: u64,
    /// Where the search writes the problem that it finds
    #[arg(
        long,
        value_name = "FILE",
        default_value = "immaculate-search.problem.json",
        requires = "search"
    )]
    out: PathBuf,
}

impl SearchArguments {
    /// The time for a search, if one is asked for.
    pub fn time(&self) -> Option<Duration> {
        self.search.map(Duration::from_secs)
    }
}

/// What a search is about.
pub struct About {
    /// The time.
    pub time: Duration,
    /// The kinds of filter; all if empty.
    pub kinds: Vec<String>,
    /// The problems to vary.
    pub problems: Vec<ProblemFile>,
    /// The command of the program.
    pub command: Vec<String>,
    /// Whether JSON is printed.
    pub is_json: bool,
}

pub fn run(arguments: &SearchArguments, about: About, subject: &mut dyn Subject) -> Result<Done, Refusal> {
    let request = Request {
        seed: arguments.seed,
        time: about.time,
        most: u64::MAX,
        kinds: about.kinds,
        around: about.problems,
        shrinking: SHRINKING,
    };
    let seconds = usize::try_from(about.time.as_secs()).unwrap_or(usize::MAX);
    let (bar, start) = (
        bar(seconds, "searching {wide_bar} {pos} of {len} s {msg}"),
        Instant::now(),
    );
    let progress = |message: &str| {
        bar.set_position(start.elapsed().as_secs());
        bar.set_message(message.to_owned());
    };
    let searched = search(subject, &request, &progress).map_err(|error| match error {
        NotMade::NoCase => Refusal::request(
            "--search: there are no problems for the filters that the program declares, or none that match --kind or --problem",
        ),
        error => Refusal::request(error),
    })?;
    bar.finish_and_clear();
    if let Some(found) = &searched.found {
        write_file(&arguments.out, &problem_text(&found.problem))?;
    }
    let again = again(&arguments.out, &about.command);
    let text = if about.is_json {
        json_text(&report::search::json(&searched, &again))
    } else {
        report::search::text(&searched, &again)
    };
    Ok(Done {
        status: status(&searched),
        ..text.into()
    })
}

fn status(searched: &Searched) -> u8 {
    match (searched.is_wrong(), searched.problems) {
        (true, _) => 1,
        (false, 0) => 2,
        (false, _) => 0,
    }
}

/// The command that checks the found problem again.
fn again(file: &Path, command: &[String]) -> String {
    let words: Vec<String> = command.iter().map(|word| quoted(word)).collect();
    format!(
        "immaculate check --problem {} -- {}",
        quoted(&file.display().to_string()),
        words.join(" ")
    )
}

/// A word as a shell reads it.
pub fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}
