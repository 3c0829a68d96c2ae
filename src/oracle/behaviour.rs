//! The situations that a filter may meet, and its verdict in each.
//!
//! A program that is right on everything it was asked need not be right. So the verdict lists, filter by filter, what it was never asked.

use super::problem::{FAMILIES, ProblemFile};
use super::verdict::{CaseReport, Outcome, Report, families};

/// Something that a filter may meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Behaviour {
    /// Nothing of what follows.
    OrdinaryData,
    /// An angle crosses ±π.
    Wrap,
    /// A step without a detection.
    MissedDetection,
    /// A measurement that lacks an entry.
    MissingEntry,
    /// Likelihoods that are zero as doubles.
    Underflow,
    /// A mode that no mode leads to.
    UnreachableMode,
    /// A covariance that is singular or nearly so.
    Singular,
    /// Very large or small numbers.
    Units,
    /// Many steps.
    LongRun,
    /// Steps that differ.
    ChangingSteps,
    /// Sensors in turn.
    SeveralSensors,
    /// A known input.
    Input,
}

impl Behaviour {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::OrdinaryData,
        Self::Wrap,
        Self::MissedDetection,
        Self::MissingEntry,
        Self::Underflow,
        Self::UnreachableMode,
        Self::Singular,
        Self::Units,
        Self::LongRun,
        Self::ChangingSteps,
        Self::SeveralSensors,
        Self::Input,
    ];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::OrdinaryData => "ordinary data",
            Self::Wrap => "angles across ±π",
            Self::MissedDetection => "missed detections",
            Self::MissingEntry => "missing entries",
            Self::Underflow => "likelihoods of zero",
            Self::UnreachableMode => "unreachable modes",
            Self::Singular => "singular covariances",
            Self::Units => "extreme units",
            Self::LongRun => "long runs",
            Self::ChangingSteps => "steps that differ",
            Self::SeveralSensors => "several sensors",
            Self::Input => "known inputs",
        }
    }

    /// The flags of cases that have it.
    fn flags(self) -> &'static [&'static str] {
        match self {
            Self::OrdinaryData => &[],
            Self::Wrap => &["wrap", "state-angle"],
            Self::MissedDetection => &["missed-detection"],
            Self::MissingEntry => &["missing-entry"],
            Self::Underflow => &["outlier"],
            Self::UnreachableMode => &["unreachable"],
            Self::Singular => &["exact", "embedded", "singular-noise", "nearly-singular"],
            Self::Units => &["units", "far-from-origin"],
            Self::LongRun => &["run"],
            Self::ChangingSteps => &["changing-steps"],
            Self::SeveralSensors => &["several-sensors"],
            Self::Input => &["input"],
        }
    }

    /// Those of a published case: what its flags say; without any it has ordinary data. A problem that must be rejected is not met at all.
    ///
    /// Example: two of the published cases.
    ///
    /// ```
    /// use immaculate::oracle::{behaviour::Behaviour, case};
    ///
    /// let of = |id: &str| Behaviour::of(&case::all().unwrap().iter().find(|case| case.problem.id == id).unwrap().problem);
    /// assert_eq!(of("update.kalman"), [Behaviour::OrdinaryData]);
    /// assert_eq!(of("wrap.clockwise"), [Behaviour::Wrap]);
    /// ```
    pub fn of(problem: &ProblemFile) -> Vec<Self> {
        let has = |flag: &str| problem.flags.iter().any(|own| own == flag);
        if has("rejected") {
            return Vec::new();
        }
        let is_flagged = |behaviour: &Self| behaviour.flags().iter().any(|flag| has(flag));
        let found: Vec<Self> = Self::ALL.into_iter().filter(is_flagged).collect();
        if found.is_empty() {
            return vec![Self::OrdinaryData];
        }
        found
    }

    /// Why filters of a family never meet it; none if they may.
    pub fn impossible_for(self, family: &str) -> Option<&'static str> {
        match (self, family) {
            (Self::Wrap, "kalman" | "fixed-gain") => Some("a linear measurement has no angle"),
            (Self::Wrap, "converted") => Some("a bearing that was converted to a position has nothing to wrap"),
            (Self::MissingEntry, "converted") => Some("a conversion needs range and bearing"),
            (Self::MissingEntry | Self::SeveralSensors, "fixed-gain") => {
                Some("gains are given for one whole measurement")
            }
            _ => None,
        }
    }
}

/// Why a case was not asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Unasked {
    /// The program has no such filter.
    Kind,
    /// The program does not read the format.
    Format,
    /// The program leaves bad input to its caller.
    Validation,
    /// It was not selected.
    Selection,
}

/// A case that was not asked.
#[derive(Debug, Clone, PartialEq)]
pub struct NotAsked {
    /// The families of its filters.
    pub families: Vec<&'static str>,
    /// What it has.
    pub behaviours: Vec<Behaviour>,
    /// Why.
    pub why: Unasked,
}

impl NotAsked {
    /// What is known of a problem that was not asked.
    pub(super) fn of(problem: &ProblemFile, why: Unasked) -> Self {
        Self {
            families: families((0..problem.modes.len()).map(|mode| problem.filter_of(mode))),
            behaviours: Behaviour::of(problem),
            why,
        }
    }
}

/// How a family of filters was judged in a behaviour.
#[derive(Debug, Clone, PartialEq)]
pub enum Grade {
    /// Everything judged is right; the number of cases.
    Right(usize),
    /// Something is wrong; the number of wrong cases, and of all.
    Wrong(usize, usize),
    /// Forms or conventions explain the faults; the number of such cases, and of all.
    Otherwise(usize, usize),
    /// Rounding noise is as large as the values.
    CannotTell,
    /// The program passed over all cases.
    Skipped,
    /// No case was asked.
    NotAsked(Unasked),
    /// There is no such thing.
    Impossible(&'static str),
}

impl Grade {
    /// Whether nothing is left open.
    pub fn is_closed(&self) -> bool {
        matches!(self, Self::Right(_) | Self::Otherwise(..) | Self::Impossible(_))
    }
}

impl Report {
    /// The families of filters that were asked anything published, each with its grade in every behaviour.
    pub fn grades(&self) -> Vec<(&'static str, Vec<(Behaviour, Grade)>)> {
        let has = |family: &str| {
            let mut published = self.cases.iter().filter(|case| case.certified.is_none());
            published.any(|case| case.families().contains(&family) && !case.behaviours.is_empty())
        };
        let of_family = |family: &'static str| {
            let grade = |behaviour: Behaviour| (behaviour, self.grade(family, behaviour));
            (family, Behaviour::ALL.map(grade).to_vec())
        };
        FAMILIES
            .into_iter()
            .filter(|family| has(family))
            .map(of_family)
            .collect()
    }

    /// Whether everything that a filter may meet was judged, for every filter that was asked anything.
    pub fn is_complete(&self) -> bool {
        let grades = self.grades();
        grades
            .iter()
            .flat_map(|(_, grades)| grades)
            .all(|(_, grade)| grade.is_closed())
    }

    fn grade(&self, family: &str, behaviour: Behaviour) -> Grade {
        let is_of = |case: &&CaseReport| case.families().contains(&family) && case.behaviours.contains(&behaviour);
        let cases: Vec<&CaseReport> = self.cases.iter().filter(is_of).collect();
        let count = |is: &dyn Fn(&Outcome) -> bool| cases.iter().filter(|case| is(&case.outcome)).count();
        let wrong = count(&Outcome::is_wrong);
        let right = count(&|outcome| *outcome == Outcome::Right);
        if wrong > 0 && self.is_excused() && count(&|outcome| *outcome == Outcome::Wrong) == wrong {
            return Grade::Otherwise(wrong, cases.len());
        }
        if wrong > 0 {
            return Grade::Wrong(wrong, cases.len());
        }
        if right > 0 {
            return Grade::Right(right);
        }
        if count(&|outcome| *outcome == Outcome::CannotTell) > 0 {
            return Grade::CannotTell;
        }
        if !cases.is_empty() {
            return Grade::Skipped;
        }
        if let Some(why) = behaviour.impossible_for(family) {
            return Grade::Impossible(why);
        }
        let unasked = self.not_asked.iter();
        let unasked = unasked.filter(|case| case.families.contains(&family) && case.behaviours.contains(&behaviour));
        Grade::NotAsked(unasked.map(|case| case.why).min().unwrap_or(Unasked::Selection))
    }
}
