//! Which of the published cases a command is about.
//!
//! After this file the reader knows the arguments with which cases are chosen, by `cases` and by `check` alike.

use super::Refusal;
use clap::Args;
use immaculate::oracle::case::{self, Case};
use immaculate::oracle::check::Selection;

#[derive(Args)]
pub struct Select {
    /// Only cases whose id begins with this; may be given again
    #[arg(long = "case", value_name = "ID")]
    cases: Vec<String>,
    /// Only cases with this flag; may be given again (`immaculate cases list` knows the flags)
    #[arg(long = "flag", value_name = "FLAG")]
    flags: Vec<String>,
    /// Only cases of this filter; may be given again (`immaculate cases list` knows the filters)
    #[arg(long = "kind", value_name = "KIND")]
    kinds: Vec<String>,
}

impl Select {
    /// Whether nothing is chosen, which is everything.
    pub fn is_empty(&self) -> bool {
        self.cases.is_empty() && self.flags.is_empty() && self.kinds.is_empty()
    }

    /// What is asked for, in the library's words.
    pub fn selection(&self) -> Selection {
        Selection {
            ids: self.cases.clone(),
            flags: self.flags.clone(),
            kinds: self.kinds.clone(),
        }
    }

    /// The cases that are asked for; it is a mistake to ask for none.
    pub fn cases(&self) -> Result<Vec<&'static Case>, Refusal> {
        let selection = self.selection();
        let all = case::all().map_err(Refusal::request)?;
        let selected: Vec<&Case> = all.iter().filter(|case| selection.has(case)).collect();
        if selected.is_empty() {
            return Err(Refusal::request(
                "no case has what was selected; `immaculate cases list` lists all",
            ));
        }
        Ok(selected)
    }
}
