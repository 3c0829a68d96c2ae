//! The verdicts on claims, and the conditions for each.
//!
//! A judge computes its verdict; nothing is declared.

use super::specification::{Claim, Specification};
use crate::statistics::Estimate;
use crate::statistics::estimate::figure;
use serde::{Serialize, Serializer};
use std::cmp::Ordering;

/// What became of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// True, by exact arithmetic.
    Proven,
    /// True in this scenario, statistically.
    Confirmed,
    /// False: by a counterexample, by arithmetic, or statistically.
    Refuted,
    /// The runs decide neither way.
    Undecided,
    /// True for some values of what the paper does not print, and false for others.
    DependsOnChoice,
    /// No value of what the paper does not print gives it, which does not show that none exists.
    NotReached,
    /// Cannot be tried: a filter, a method or the data were not published.
    NeverPublished,
}

impl Verdict {
    /// All verdicts, the firmest first.
    pub const ALL: [Self; 7] = [
        Self::Proven,
        Self::Confirmed,
        Self::Refuted,
        Self::DependsOnChoice,
        Self::NotReached,
        Self::NeverPublished,
        Self::Undecided,
    ];

    /// The verdict as machines read it.
    pub fn name(self) -> String {
        self.words().replace(' ', "-")
    }

    /// The verdict in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Proven => "proven",
            Self::Confirmed => "confirmed",
            Self::Refuted => "refuted",
            Self::Undecided => "undecided",
            Self::DependsOnChoice => "depends on a choice",
            Self::NotReached => "not reached",
            Self::NeverPublished => "never published",
        }
    }

    /// What the verdict means, in a sentence.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Proven => "True, by exact arithmetic.",
            Self::Confirmed => "True in the runs, at four standard errors.",
            Self::Refuted => "False: by arithmetic, by a counterexample, or in the runs at four standard errors.",
            Self::Undecided => "The runs decide neither way.",
            Self::DependsOnChoice => "True for some values of what the paper does not print, and false for others.",
            Self::NotReached => {
                "No value of what the paper does not print gives it; that does not show that none exists."
            }
            Self::NeverPublished => "It cannot be tried: a filter, a method or the data were not published.",
        }
    }
}

impl Serialize for Verdict {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.name())
    }
}

/// How a claim fares under what the paper leaves open, by number of configurations.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Tally {
    /// Certainly true.
    pub holds: usize,
    /// Certainly false.
    pub fails: usize,
    /// Neither is certain.
    pub uncertain: usize,
}

impl Tally {
    /// Configurations in each of which a claim is certainly true, certainly false, or neither.
    pub fn of(answers: impl IntoIterator<Item = Option<bool>>) -> Self {
        let mut tally = Self::default();
        for answer in answers {
            match answer {
                Some(true) => tally.holds += 1,
                Some(false) => tally.fails += 1,
                None => tally.uncertain += 1,
            }
        }
        tally
    }

    /// The verdicts of single configurations.
    pub fn of_verdicts(verdicts: &[Verdict]) -> Self {
        Self::of(verdicts.iter().map(|verdict| match verdict {
            Verdict::Proven | Verdict::Confirmed => Some(true),
            Verdict::Refuted => Some(false),
            _ => None,
        }))
    }

    /// Both, of different configurations or filters.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            holds: self.holds + other.holds,
            fails: self.fails + other.fails,
            uncertain: self.uncertain + other.uncertain,
        }
    }

    /// Confirmed or refuted if every configuration agrees; if it is certainly true in some and certainly false in others, what was not
    /// printed decides.
    pub fn verdict(self) -> Verdict {
        match (self.holds, self.fails, self.uncertain) {
            (0, 0, _) => Verdict::Undecided,
            (_, 0, 0) => Verdict::Confirmed,
            (0, _, 0) => Verdict::Refuted,
            (0, ..) | (_, 0, _) => Verdict::Undecided,
            _ => Verdict::DependsOnChoice,
        }
    }

    /// The numbers in words.
    pub fn words(self) -> String {
        let Self {
            holds,
            fails,
            uncertain,
        } = self;
        let of = holds + fails + uncertain;
        match uncertain {
            0 => format!("It holds in {holds} of {of} configurations, and fails in {fails}."),
            _ => format!(
                "It holds in {holds} of {of} configurations, fails in {fails}, and is uncertain in {uncertain}."
            ),
        }
    }
}

/// A claim, its verdict and the evidence.
#[derive(Debug, Clone, Serialize)]
pub struct JudgedClaim {
    /// The claim's name.
    pub id: String,
    /// The paper's words.
    pub quote: String,
    /// Where they stand.
    pub place: String,
    /// What was asked.
    pub question: String,
    /// The answer.
    pub verdict: Verdict,
    /// In how many configurations it holds, where the paper leaves open which is meant.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub configurations: Option<Tally>,
    /// What it rests on, with the figures.
    pub evidence: String,
}

impl JudgedClaim {
    /// The same with the configurations over which it was judged.
    #[must_use]
    pub fn over(self, configurations: Tally) -> Self {
        Self {
            configurations: Some(configurations),
            ..self
        }
    }

    /// The answer in a sentence: what the verdict means, or in how many configurations the claim holds.
    pub fn answer(&self) -> String {
        match self.configurations {
            Some(configurations) => configurations.words(),
            None => self.verdict.meaning().to_owned(),
        }
    }
}

/// How many standard errors a difference must have to count: 4, a false alarm in 16 000 for a Gaussian figure, so that among some
/// dozens of comparisons not one is expected.
pub const DECISIVE: f64 = 4.0;

/// Whether a difference is below zero, above it, or neither with certainty.
///
/// Example: ten standard errors below zero, and half of one above.
///
/// ```
/// use immaculate::paper::verdict::sign_of;
/// use immaculate::statistics::Estimate;
/// use std::cmp::Ordering;
///
/// let difference = |value| Estimate { value, standard_error: 1.0 };
/// assert_eq!(sign_of(difference(-10.0)), Some(Ordering::Less));
/// assert_eq!(sign_of(difference(0.5)), None); // within its own uncertainty
/// ```
pub fn sign_of(difference: Estimate) -> Option<Ordering> {
    let distance = difference.distance_from(0.0);
    if distance <= -DECISIVE {
        Some(Ordering::Less)
    } else if distance >= DECISIVE {
        Some(Ordering::Greater)
    } else {
        None
    }
}

impl Specification {
    /// A judgement on the claim with this name.
    ///
    /// # Panics
    ///
    /// When the specification has no such claim: judges and claims are both part of the program, and a test holds them together.
    pub fn judgement(&self, id: &str, verdict: Verdict, evidence: String) -> JudgedClaim {
        let claim: &Claim = self
            .claims
            .iter()
            .find(|claim| claim.id == id)
            .expect("every judge has a claim");
        JudgedClaim {
            id: claim.id.clone(),
            quote: claim.quote.clone(),
            place: claim.place.clone(),
            question: claim.question.clone(),
            verdict,
            configurations: None,
            evidence,
        }
    }
}

/// A difference in words: `−0.893 ± 0.027 m (−33 standard errors)`.
pub fn in_words(difference: Estimate, unit: &str) -> String {
    let distance = difference.distance_from(0.0);
    format!(
        "{} ± {} {unit} ({distance:+.1} standard errors)",
        figure(difference.value),
        figure(difference.standard_error),
    )
}

/// The verdict on "the first is smaller", from the differences first − second: confirmed when all are certainly below zero, refuted when
/// one is certainly above, undecided otherwise.
pub fn all_below_zero(differences: &[Estimate]) -> Verdict {
    let signs: Vec<_> = differences.iter().map(|difference| sign_of(*difference)).collect();
    if signs.iter().all(|sign| *sign == Some(Ordering::Less)) {
        Verdict::Confirmed
    } else if signs.contains(&Some(Ordering::Greater)) {
        Verdict::Refuted
    } else {
        Verdict::Undecided
    }
}

/// The verdict where it was not published which of several is meant: theirs if they agree; if one is confirmed and another refuted, what
/// was not published decides.
pub fn whichever(verdicts: &[Verdict]) -> Verdict {
    match verdicts.first() {
        Some(first) if verdicts.iter().all(|verdict| verdict == first) => *first,
        _ => Tally::of_verdicts(verdicts).verdict(),
    }
}

/// "The first is smaller" where it was not published which of the differences first − second is meant.
pub fn below_zero(differences: &[Estimate]) -> Tally {
    Tally::of(
        differences
            .iter()
            .map(|difference| sign_of(*difference).map(Ordering::is_lt)),
    )
}

/// Proven or refuted, by arithmetic that decides the claim either way.
pub fn proven_if(holds: bool) -> Verdict {
    if holds { Verdict::Proven } else { Verdict::Refuted }
}

/// Proven by a proof. One that does not come out shows nothing, least of all the opposite.
pub fn proven_by(proof: bool) -> Verdict {
    if proof { Verdict::Proven } else { Verdict::Undecided }
}

/// Refuted by a counterexample. One that does not come out shows nothing, least of all the claim.
pub fn refuted_by(counterexample: bool) -> Verdict {
    if counterexample {
        Verdict::Refuted
    } else {
        Verdict::Undecided
    }
}

/// Confirmed or refuted, by runs.
pub fn confirmed_if(holds: bool) -> Verdict {
    if holds { Verdict::Confirmed } else { Verdict::Refuted }
}

/// The verdict on "the first is better", where better means smaller by more than a thousandth: from the difference first − second and the
/// error of the second. Refuted when it is certain that the first is not better by so much.
pub fn better_by_a_thousandth(difference: Estimate, error: Estimate) -> Verdict {
    let least = -RELEVANT * error.value;
    let certainty = DECISIVE * difference.standard_error;
    if difference.value + certainty < least {
        Verdict::Confirmed
    } else if difference.value - certainty > least {
        Verdict::Refuted
    } else {
        Verdict::Undecided
    }
}

/// The least part of an error that counts as a difference between filters: a thousandth, a tenth of the last digit that is published.
pub const RELEVANT: f64 = 1e-3;

/// Whether a difference is certainly less than a thousandth of an error, either way.
pub fn is_within_a_thousandth(difference: Estimate, error: Estimate) -> bool {
    difference.value.abs() + DECISIVE * difference.standard_error < RELEVANT * error.value
}

/// The verdict on several of which all must hold: refuted if one is, undecided if one is, dependent on a choice if one is, else the first.
pub fn all_of(verdicts: &[Verdict]) -> Verdict {
    for decisive in [Verdict::Refuted, Verdict::Undecided, Verdict::DependsOnChoice] {
        if verdicts.contains(&decisive) {
            return decisive;
        }
    }
    verdicts.first().copied().unwrap_or(Verdict::Undecided)
}
