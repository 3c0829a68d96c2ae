//! `immaculate check` without a program: shows what a verdict looks like, and how to get one for your own filter.
//!
//! Nothing is staged: the demonstration is an ordinary check of this crate's own filter with a classic mistake in it.

use super::Refusal;
use immaculate::oracle::check::{Selection, check};
use immaculate::oracle::subject::{Level, Planted};
use immaculate::report;

/// The mistake and the cases; `immaculate answer` plants the same.
const MISTAKE: &str = "mixed-spread-omitted";
const CASES: &str = "step.n4-m2";

const ABOVE: &str = "\
This is what a verdict looks like. The filter under test is Immaculate's own, with a classic mistake planted in it:
the mixed covariance lacks the spread of the means. This command does the same:

  immaculate check --case step.n4-m2 -- immaculate answer --plant mixed-spread-omitted

";

const BELOW: &str = "
YOUR OWN FILTER
  immaculate init python
      writes my_filter.py, a correct textbook filter that marks where yours goes; also cpp, octave, rust
  immaculate check -- python3 my_filter.py
      judges it on all cases; --report verdict.html also writes the verdict as a page
  immaculate check --problem FILE -- python3 my_filter.py
      judges it on your own models and data
  immaculate check --help
      lists all options
";

/// The demonstration.
pub fn text() -> Result<String, Refusal> {
    let mut program = Planted {
        variants: vec![MISTAKE.to_owned()],
        level: Level::Everything,
    };
    let selection = Selection {
        ids: vec![CASES.to_owned()],
        ..Selection::default()
    };
    let report = check(&mut program, &selection, &|_| {}).map_err(Refusal::request)?;
    Ok(format!("{ABOVE}{}{BELOW}", report::check::text(&report)))
}
