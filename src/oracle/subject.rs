//! The program under test, whatever it is: how it introduces itself, and how it answers.
//!
//! A filter in Rust is checked from its own tests through this trait. A process ([`super::process`]) and a folder of answers
//! ([`super::folder`]) implement it too.

use super::invalid::Invalid;
use super::problem::{FORMAT, ProblemFile};
use super::trace::Trace;
use crate::file::shortened;
use serde_json::Value;
use std::collections::BTreeMap;

/// The precision in which a program computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// 53 bits.
    Double,
    /// 24 bits.
    Single,
    /// A number of decimal digits.
    DecimalDigits(u32),
}

impl Precision {
    /// The unit roundoff: half the distance of 1 from the next number.
    pub fn unit_roundoff(self) -> f64 {
        match self {
            Self::Double => f64::EPSILON / 2.0,
            Self::Single => f64::from(f32::EPSILON) / 2.0,
            Self::DecimalDigits(digits) => (0..digits).fold(5.0, |unit, _| unit / 10.0),
        }
    }

    /// The least positive number: what is smaller may be zero.
    pub fn least_number(self) -> f64 {
        match self {
            Self::Double | Self::DecimalDigits(_) => f64::from_bits(1),
            Self::Single => f64::from(f32::from_bits(1)),
        }
    }
}

impl std::fmt::Display for Precision {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::Double => write!(f, "double precision"),
            Self::Single => write!(f, "single precision"),
            Self::DecimalDigits(digits) => write!(f, "{digits} decimal digits"),
        }
    }
}

/// What a program says of itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Ready {
    /// Its name.
    pub name: String,
    /// Its precision.
    pub precision: Precision,
    /// Its conventions where they differ from the cases'.
    pub conventions: BTreeMap<String, String>,
    /// The filters it has, by [`FilterFile::name`](super::problem::FilterFile::name); none means all.
    pub kinds: Option<Vec<String>>,
    /// The formats of problems that it reads; none means all.
    pub formats: Option<Vec<String>>,
    /// The echo's matrix times its vector.
    pub echo: Option<Vec<f64>>,
    /// Whether it checks its input.
    pub validates: bool,
}

impl Default for Ready {
    fn default() -> Self {
        Self {
            name: "unnamed".into(),
            precision: Precision::Double,
            conventions: BTreeMap::new(),
            kinds: None,
            formats: None,
            echo: None,
            validates: true,
        }
    }
}

/// The echo: a matrix that is not square, by rows, and a vector.
pub const ECHO: ([[f64; 3]; 2], [f64; 3]) = ([[1.0, 2.0, 3.0], [4.0, 5.0, 7.0]], [1.0, 10.0, 100.0]);

/// The echo's matrix times its vector.
pub fn echoed() -> Vec<f64> {
    let (matrix, vector) = ECHO;
    matrix
        .iter()
        .map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum())
        .collect()
}

impl Ready {
    /// Reads the message.
    ///
    /// # Errors
    ///
    /// The reason why it cannot be understood.
    pub fn read(message: &Value) -> Result<Self, String> {
        // Who says nothing of formats was written for the first one.
        let mut ready = Self {
            formats: Some(vec![FORMAT.to_owned()]),
            ..Self::default()
        };
        let object = message.as_object().ok_or("the ready message is not an object")?;
        for (key, value) in object {
            match key.as_str() {
                _ if value.is_null() => {}
                "type" | "fields" => {}
                "name" => ready.name = shortened(value.as_str().ok_or("`name` is not a string")?, 200),
                "precision" => ready.precision = read_precision(value)?,
                "conventions" => ready.conventions = read_conventions(value)?,
                "kinds" => ready.kinds = Some(words_of(key, value)?),
                "formats" => ready.formats = Some(words_of(key, value)?),
                "echo" => {
                    let list = value.as_array().ok_or("`echo` is not a list")?;
                    ready.echo = Some(list.iter().flat_map(numbers_of).collect());
                }
                "validates" => ready.validates = value.as_bool().ok_or("`validates` is not true or false")?,
                _ => return Err(format!("`{key}` is not a key of the ready message")),
            }
        }
        Ok(ready)
    }
}

/// The list of words under a key.
fn words_of(key: &str, value: &Value) -> Result<Vec<String>, String> {
    let list = value.as_array().ok_or_else(|| format!("`{key}` is not a list"))?;
    let words = list.iter().map(|word| word.as_str().map(str::to_owned));
    words
        .collect::<Option<_>>()
        .ok_or_else(|| format!("`{key}` has an entry that is not a string"))
}

/// The numbers of a value, whether it is one or a list.
fn numbers_of(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(list) => list.iter().flat_map(numbers_of).collect(),
        value => vec![value.as_f64().unwrap_or(f64::NAN)],
    }
}

fn read_precision(value: &Value) -> Result<Precision, String> {
    if let Some(word) = value.as_str() {
        return match word {
            "double" => Ok(Precision::Double),
            "single" => Ok(Precision::Single),
            _ => Err(format!(
                "precision {word:?} is not \"double\", \"single\" or {{\"decimal_digits\": …}}"
            )),
        };
    }
    value
        .get("decimal_digits")
        .and_then(Value::as_u64)
        .and_then(|digits| u32::try_from(digits).ok())
        .filter(|digits| (2..=15).contains(digits))
        .map(Precision::DecimalDigits)
        .ok_or_else(|| "`precision.decimal_digits` is not a number from 2 to 15".into())
}

fn read_conventions(value: &Value) -> Result<BTreeMap<String, String>, String> {
    // MATLAB and Octave write an empty object as an empty list.
    if value.as_array().is_some_and(Vec::is_empty) {
        return Ok(BTreeMap::new());
    }
    let object = value.as_object().ok_or("`conventions` is not an object")?;
    object
        .iter()
        .map(|(key, value)| {
            let value = value
                .as_str()
                .ok_or_else(|| format!("convention `{key}` is not a string"))?;
            Ok((key.clone(), value.to_owned()))
        })
        .collect()
}

/// What a program answers to a problem.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// Values, and an error if it could not go on.
    Steps {
        /// What it shows.
        trace: Trace,
        /// Why it stopped.
        error: Option<String>,
    },
    /// It does not do such problems.
    Skipped {
        /// Why.
        reason: String,
    },
    /// It refuses the problem.
    Rejected {
        /// The class of the reason, in its own words.
        class: String,
        /// The reason.
        reason: String,
    },
    /// It did not answer as it should.
    Broken(Broken),
}

/// An answer that is none.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Broken {
    /// Nothing came in time.
    #[error("no answer within {seconds} s{hint}")]
    TimedOut {
        /// The limit.
        seconds: u64,
        /// What may be the cause.
        hint: String,
    },
    /// The program ended.
    #[error("the program ended ({status}){stderr}")]
    Crashed {
        /// Its exit status.
        status: String,
        /// What it last wrote to standard error.
        stderr: String,
    },
    /// A line that is not a message.
    #[error("not a message: {reason}: {line}")]
    Garbage {
        /// The beginning of the line.
        line: String,
        /// Why.
        reason: String,
    },
    /// The answer to another case.
    #[error("asked for `{asked}`, answered `{answered}`")]
    OutOfOrder {
        /// The case that was asked for.
        asked: String,
        /// The case that was answered.
        answered: String,
    },
    /// The trace cannot be read.
    #[error("{0}")]
    Invalid(Invalid),
    /// A program that cannot be started.
    #[error("{0}")]
    NotStarted(String),
}

/// A filter under test.
///
/// Example: the smallest program under test, which shows one quantity and is judged by it.
///
/// ```
/// use immaculate::imm::Quantity;
/// use immaculate::oracle::check::{Selection, check};
/// use immaculate::oracle::problem::ProblemFile;
/// use immaculate::oracle::subject::{Answer, Broken, Ready, Subject};
/// use immaculate::oracle::trace::Trace;
///
/// /// The smallest program under test: it shows cⱼ = Σᵢ pᵢⱼ μᵢ of step 1 and nothing else.
/// struct ChainAlone;
///
/// impl Subject for ChainAlone {
///     fn start(&mut self) -> Result<Ready, Broken> {
///         Ok(Ready { name: "the chain alone".into(), ..Ready::default() })
///     }
///
///     fn run(&mut self, problem: &ProblemFile) -> Answer {
///         let before = &problem.initial.mode_probabilities;
///         let into = |j: usize| problem.transition.iter().zip(before).map(|(row, mu)| row[j] * mu).sum();
///         let mut trace = Trace::empty(&problem.dimensions());
///         trace.set(1, Quantity::PredictedModeProbabilities, 0, (0..before.len()).map(into).collect());
///         Answer::Steps { trace, error: None }
///     }
/// }
///
/// let case = Selection { ids: vec!["step.n4-m2.two-modes".into()], ..Selection::default() };
/// let report = check(&mut ChainAlone, &case, &|_| {}).unwrap();
/// assert!(!report.is_wrong());
/// assert_eq!((report.cases[0].judged, report.cases[0].of), (1, 32)); // right in what it shows, silent on the rest
/// ```
pub trait Subject {
    /// Introduces itself. It is called again to ask a case alone, and then nothing of earlier problems may be left.
    ///
    /// # Errors
    ///
    /// [`Broken`] when it cannot be used.
    fn start(&mut self) -> Result<Ready, Broken>;

    /// Runs a problem.
    fn run(&mut self, problem: &ProblemFile) -> Answer;

    /// Whether somebody has interrupted it: then nothing more is asked, and there is no verdict.
    ///
    /// Example: a filter whose author has seen enough after the first problem.
    ///
    /// ```
    /// use immaculate::oracle::check::{NotMade, Selection, check};
    /// use immaculate::oracle::problem::ProblemFile;
    /// use immaculate::oracle::subject::{Answer, Broken, Ready, Subject};
    ///
    /// struct Interrupted(usize);
    ///
    /// impl Subject for Interrupted {
    ///     fn start(&mut self) -> Result<Ready, Broken> {
    ///         Ok(Ready::default())
    ///     }
    ///
    ///     fn run(&mut self, _: &ProblemFile) -> Answer {
    ///         self.0 += 1;
    ///         Answer::Skipped { reason: "enough".into() }
    ///     }
    ///
    ///     fn is_interrupted(&self) -> bool {
    ///         true
    ///     }
    /// }
    ///
    /// let mut program = Interrupted(0);
    /// assert_eq!(check(&mut program, &Selection::default(), &|_| {}), Err(NotMade::Interrupted));
    /// assert_eq!(program.0, 1);
    /// ```
    fn is_interrupted(&self) -> bool {
        false
    }

    /// Ends; what was strange on the way, a sentence each.
    fn stop(&mut self) -> Vec<String> {
        Vec::new()
    }

    /// Whether it can be started again after its end, and answers anew then. Answers that were written before are what they are.
    fn forgets_at_start(&self) -> bool {
        true
    }
}

/// How much of a trace is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// Everything.
    Everything,
    /// What the next step needs, and the combined estimate: updated estimates and mode probabilities.
    Posteriors,
    /// The combined estimate alone.
    Combined,
}

impl Level {
    /// All levels, from most to least.
    pub const ALL: [Self; 3] = [Self::Everything, Self::Posteriors, Self::Combined];

    /// Whether a quantity is shown.
    pub fn shows(self, quantity: crate::imm::Quantity) -> bool {
        use crate::imm::Quantity::{
            CombinedCovariance, CombinedMean, ModeProbabilities, UpdatedCovariance, UpdatedMean,
        };
        match self {
            Self::Everything => true,
            Self::Posteriors => matches!(
                quantity,
                UpdatedMean | UpdatedCovariance | ModeProbabilities | CombinedMean | CombinedCovariance
            ),
            Self::Combined => matches!(quantity, CombinedMean | CombinedCovariance),
        }
    }
}

/// This crate's own filter in doubles, with variants of the catalogue planted in it: the judge is tested on it.
#[derive(Debug, Clone)]
pub struct Planted {
    /// The variants.
    pub variants: Vec<String>,
    /// How much it shows.
    pub level: Level,
}

impl Subject for Planted {
    fn start(&mut self) -> Result<Ready, Broken> {
        Ok(Ready {
            name: if self.variants.is_empty() {
                "Immaculate's own filter".into()
            } else {
                format!("Immaculate's own filter with {}", self.variants.join(" and "))
            },
            echo: Some(echoed()),
            ..Ready::default()
        })
    }

    fn run(&mut self, problem: &ProblemFile) -> Answer {
        if let Err(invalid) = problem.check() {
            return Answer::Rejected {
                class: invalid.class.name().into(),
                reason: invalid.to_string(),
            };
        }
        self.planted(problem)
            .unwrap_or_else(|invalid| Answer::Broken(Broken::Invalid(invalid)))
    }
}

impl Planted {
    /// Runs a problem in doubles with the variants; what is shown of it.
    fn planted(&self, problem: &ProblemFile) -> Result<Answer, Invalid> {
        let setup = problem.setup_in_doubles()?.varied(&self.variants);
        let computed = setup.run();
        let values = computed.in_doubles();
        let mut trace = Trace::empty(&setup.dimensions());
        for (step, quantity, mode) in values.all_places() {
            let Some(value) = values.get(step, quantity, mode) else {
                continue;
            };
            if self.level.shows(quantity) {
                trace.set(step, quantity, mode, value.clone());
            }
        }
        Ok(Answer::Steps {
            trace,
            error: computed.failures.first().map(ToString::to_string),
        })
    }
}
