//! The verdict on a program: the outcome of each case, and what explains the faults.

use super::behaviour::{Behaviour, NotAsked};
use super::diagnose::Diagnosis;
use super::judge::{Finding, Judged, Judgement};
use super::observation::Observation;
use super::problem::{FilterFile, InteractionFile, ProblemFile};
use super::subject::{Broken, Ready};
use super::trace::Dimensions;
use super::variant::{Kind, Variant};
use crate::imm::Quantity;

/// How a case went.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// Every value that was shown is right or inherited from none but right ones.
    Right,
    /// At least one equation is not what it should be.
    Wrong,
    /// The noise is as large as the values.
    CannotTell,
    /// Rejected as it must be; the class that the program gave may be another one.
    Rejected {
        /// The program's class where it differs.
        other_class: Option<String>,
    },
    /// Not rejected, though it must be.
    NotRejected,
    /// Rejected, though it is a good problem.
    WronglyRejected {
        /// The program's reason.
        reason: String,
    },
    /// Passed over by the program.
    Skipped {
        /// Its reason.
        reason: String,
    },
    /// Nothing was shown.
    NothingShown,
    /// The program stopped by itself, before the end.
    Stopped {
        /// Its reason.
        reason: String,
    },
    /// No answer.
    Broken(Broken),
}

impl Outcome {
    /// Whether it says that something is wrong.
    pub fn is_wrong(&self) -> bool {
        matches!(
            self,
            Self::Wrong
                | Self::NotRejected
                | Self::WronglyRejected { .. }
                | Self::Stopped { .. }
                | Self::Broken(_)
                | Self::NothingShown
        )
    }
}

/// A case, judged.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseReport {
    /// Its id.
    pub id: String,
    /// The filter of each mode.
    pub filters: Vec<FilterFile>,
    /// Which estimates they start from.
    pub interaction: InteractionFile,
    /// What its filters meet in it, [`Behaviour::of`].
    pub behaviours: Vec<Behaviour>,
    /// Its dimensions.
    pub dimensions: Dimensions,
    /// How it went.
    pub outcome: Outcome,
    /// The judged values.
    pub judgement: Option<Judgement>,
    /// The number of values that were judged, of those that the case has.
    pub judged: usize,
    /// The number of values of the case.
    pub of: usize,
    /// The digits that the worst of the values that are right has, in its scale.
    pub digits: Option<f64>,
    /// Why the program stopped before the end, if it did.
    pub stopped: Option<String>,
    /// Of a problem that is not published, the steps whose values are certified; the expected values of the others are doubles.
    pub certified: Option<usize>,
}

impl CaseReport {
    /// The report of a case before anything of it is judged.
    pub fn new(problem: &ProblemFile) -> Self {
        Self {
            id: problem.id.clone(),
            filters: (0..problem.modes.len())
                .map(|mode| problem.filter_of(mode).clone())
                .collect(),
            interaction: problem.interaction(),
            behaviours: Behaviour::of(problem),
            dimensions: problem.dimensions(),
            outcome: Outcome::NothingShown,
            judgement: None,
            judged: 0,
            of: 0,
            digits: None,
            stopped: None,
            certified: None,
        }
    }

    /// Takes in the judged values: outcome, counts and digits.
    pub(super) fn judged_as(&mut self, judgement: Judgement, error: Option<String>, is_drowned: bool) {
        let findings = || judgement.values.iter().map(|value| value.finding);
        let decided = |finding: &Finding| matches!(finding, Finding::Right | Finding::Propagated) || finding.is_fault();
        self.judged = findings().filter(decided).count();
        self.digits = judgement
            .values
            .iter()
            .filter(|value| value.finding == Finding::Right)
            .map(|value| -libm::log10(value.error.max(f64::EPSILON / 2.0)))
            .reduce(f64::min);
        self.stopped.clone_from(&error);
        self.outcome = if findings().any(Finding::is_fault) {
            Outcome::Wrong
        } else if let Some(reason) = error.filter(|_| !is_drowned) {
            Outcome::Stopped { reason }
        } else if is_drowned {
            Outcome::CannotTell
        } else if judgement.values.is_empty() {
            Outcome::NothingShown
        } else if self.judged == 0 {
            Outcome::CannotTell
        } else {
            Outcome::Right
        };
        self.judgement = Some(judgement);
    }

    /// The step of the first fault.
    pub(super) fn first_fault(&self) -> Option<usize> {
        let faults = self.judgement.iter().flat_map(Judgement::faults);
        faults.map(|value| value.place.0).min()
    }

    /// The families of its filters.
    pub fn families(&self) -> Vec<&'static str> {
        families(self.filters.iter())
    }

    /// The printed equations that give a quantity in a mode.
    pub fn equation(&self, quantity: Quantity, mode: usize) -> &'static str {
        self.interaction.equation(&self.filters[mode], quantity)
    }

    /// The columns of a quantity in a step of the case.
    pub fn columns(&self, step: usize, quantity: Quantity) -> usize {
        self.dimensions.shape(step, quantity).1
    }
}

/// The families of filters, each once.
pub(super) fn families<'a>(filters: impl Iterator<Item = &'a FilterFile>) -> Vec<&'static str> {
    let mut families: Vec<&str> = filters.map(FilterFile::family).collect();
    families.sort_unstable();
    families.dedup();
    families
}

/// The whole verdict.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// What the program said of itself.
    pub ready: Ready,
    /// Whether its echo is right; none if it gave none.
    pub echo: Option<bool>,
    /// The cases.
    pub cases: Vec<CaseReport>,
    /// The cases for which it has no filter, whose format it does not read, that its caller must check, or that were not selected.
    pub not_asked: Vec<NotAsked>,
    /// What explains the faults.
    pub diagnosis: Diagnosis,
    /// The quantities that were never shown.
    pub hidden: Vec<Quantity>,
    /// What is seen in the answers as a whole.
    pub observations: Vec<Observation>,
    /// What was strange on the way.
    pub remarks: Vec<String>,
}

impl Report {
    /// Whether all faults are those of a form or a convention, which are not wrong. They do not excuse an early end.
    pub fn is_excused(&self) -> bool {
        let is_early = |case: &CaseReport| case.outcome == Outcome::Wrong && case.stopped.is_some();
        self.diagnosis.is_excuse() && !self.cases.iter().any(is_early)
    }

    /// Whether the faults of a quantity are those of forms and conventions, which are not wrong, though others may be mistakes.
    pub fn is_otherwise(&self, quantity: Quantity) -> bool {
        let members: Vec<&[&Variant]> = match &self.diagnosis {
            Diagnosis::Several(members) => members.iter().map(Vec::as_slice).collect(),
            Diagnosis::InParts { parts, unexplained, .. } if unexplained.is_empty() => {
                parts.iter().map(|part| part.variants.as_slice()).collect()
            }
            Diagnosis::Pairs(pairs) => match &pairs[..] {
                [pair] => pair.chunks(1).collect(),
                _ => return self.is_excused(),
            },
            _ => return self.is_excused(),
        };
        let is_made_here = |member: &&[&Variant]| member.iter().any(|variant| variant.is_made_in(quantity));
        let mut made_here = members.into_iter().filter(is_made_here).flatten().peekable();
        self.is_excused() || made_here.peek().is_some() && made_here.all(|variant| variant.kind != Kind::Mistake)
    }

    /// Whether it rejects anything; so it is where it was not asked several problems that must be rejected.
    pub fn rejects_anything(&self) -> bool {
        let count = |is: fn(&Outcome) -> bool| self.cases.iter().filter(|case| is(&case.outcome)).count();
        count(|outcome| matches!(outcome, Outcome::Rejected { .. })) > 0
            || count(|outcome| *outcome == Outcome::NotRejected) < 2
    }

    /// Whether nothing could be judged at all.
    pub fn is_empty(&self) -> bool {
        let is_judged = |case: &CaseReport| {
            !matches!(
                case.outcome,
                Outcome::Skipped { .. } | Outcome::CannotTell | Outcome::NothingShown
            )
        };
        !self.cases.iter().any(is_judged)
    }

    /// Whether anything is wrong.
    pub fn is_wrong(&self) -> bool {
        let is_excused = self.is_excused();
        self.echo == Some(false)
            || self.observations.iter().any(Observation::is_wrong)
            || self.cases.iter().any(|case| match case.outcome {
                Outcome::Wrong => !is_excused,
                ref outcome => outcome.is_wrong(),
            })
    }

    /// The faults, each with its case.
    pub fn faults(&self) -> impl Iterator<Item = (&CaseReport, &Judged)> {
        self.cases.iter().flat_map(|case| {
            let faults = case.judgement.iter().flat_map(Judgement::faults);
            faults.map(move |value| (case, value))
        })
    }
}
