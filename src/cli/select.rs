//! The arguments that select published cases, for `cases` and `check`.

use super::Refusal;
use clap::Args;
use immaculate::oracle::case::{self, Case};
use immaculate::oracle::check::Selection;

#[derive(Args)]
pub struct Select {
    /// Only cases whose id begins with this; may be repeated
    #[arg(long = "case", value_name = "ID")]
    cases: Vec<String>,
    /// Only cases with this flag; may be repeated (`immaculate cases list` lists the flags)
    #[arg(long = "flag", value_name = "FLAG")]
    flags: Vec<String>,
    /// Only cases for this filter; may be repeated (`immaculate cases list` lists the filters)
    #[arg(long = "kind", value_name = "KIND")]
    kinds: Vec<String>,
}

impl Select {
    /// Whether nothing is chosen, which means everything.
    pub fn is_empty(&self) -> bool {
        self.cases.is_empty() && self.flags.is_empty() && self.kinds.is_empty()
    }

    /// The selection in the library's types.
    pub fn selection(&self) -> Selection {
        Selection {
            ids: self.cases.clone(),
            flags: self.flags.clone(),
            kinds: self.kinds.clone(),
        }
    }

    /// The selected cases; an empty selection is an error.
    pub fn cases(&self) -> Result<Vec<&'static Case>, Refusal> {
        let selection = self.selection();
        let all = case::all().map_err(Refusal::request)?;
        let selected: Vec<&Case> = all.iter().filter(|case| selection.has(case)).collect();
        if selected.is_empty() {
            return Err(Refusal::request(
                "no case matches the selection; `immaculate cases list` lists all cases",
            ));
        }
        Ok(selected)
    }
}
