//! Certificates as files, which anyone can check with a few multiplications of fractions.
//!
//! This is the format `immaculate-certificate/1`. A file names the filters by the inputs of their gains (damping roots, or noises and scan
//! time), and gives the proof. The matrices are recomputed from these inputs, so a proof about other filters proves nothing. Every number
//! is a fraction in quotes; "−1.5" and "-3/2" are the same.

use super::certificate::{Edge, NotProven, Product, Quadratics};
use super::verdict::{Filters, LETTERS, StabilityVerdict, word_text};
use crate::file::{digest, shortened};
use crate::number::Rational;
use nalgebra::SMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The format of certificate files.
pub const FORMAT: &str = "immaculate-certificate/1";

/// Numbers from here to here are noises and times that somebody may have; others are taken for mistakes of scale.
pub const SANE: [f64; 2] = [1e-12, 1e12];

/// A number of a certificate has at most this many bits above and below its fraction bar together: about three hundred decimal digits. A
/// proof multiplies them with each other, and the time grows with the square of their length.
const LONGEST_NUMBER: u64 = 1024;

/// The longest word of a proof of instability, letters. The longest one that is looked for has two runs of 64.
const LONGEST_WORD: usize = 128;

/// The most forms of a proof of stability: those with a memory of eight letters, the longest that is tried.
const MOST_FORMS: usize = 256;

/// The most edges between them: from each one for each of the two letters.
const MOST_EDGES: usize = 2 * MOST_FORMS;

/// A certificate as it stands in a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CertificateFile {
    /// `immaculate-certificate/1`.
    pub format: String,
    /// What it is about, for people.
    pub about: String,
    /// The filters.
    pub filters: FiltersFile,
    /// The proof.
    pub proof: ProofFile,
    /// SHA-256 of the filters and the proof, written as compact JSON one after the other: it detects accidental edits.
    pub digest: String,
}

/// The filters of a certificate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum FiltersFile {
    /// θ_v and θ_a.
    DampingRoots([String; 2]),
    /// What the gains were computed for.
    Noises(Noises),
}

/// Scan time and noises.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Noises {
    /// t, s.
    pub interval: String,
    /// R, m².
    pub measurement: String,
    /// q_v, (m/s²)².
    pub constant_velocity: String,
    /// q_a, (m/s²)².
    pub constant_acceleration: String,
}

/// The proof of a certificate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum ProofFile {
    /// Stable: quadratic forms on the nodes of a graph.
    Stable {
        /// From node, letter, to node.
        #[schemars(length(max = MOST_EDGES))]
        edges: Vec<(usize, char, usize)>,
        /// One symmetric matrix a node, by rows.
        #[schemars(with = "Vec<[[String; 3]; 3]>", length(max = MOST_FORMS))]
        forms: Vec<Vec<Vec<String>>>,
    },
    /// Unstable: a product with a spectral radius of at least `radius`.
    Unstable {
        /// The letters, the first acting first.
        #[schemars(length(max = LONGEST_WORD))]
        word: String,
        /// The bound.
        radius: String,
    },
}

/// Why a certificate file is refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum InvalidCertificate {
    /// Not the JSON of a certificate.
    #[error("is not a certificate: {0}")]
    Json(String),
    /// Another format.
    #[error("`format` is `{0}`, and not `{FORMAT}`")]
    Format(String),
    /// A text that is no fraction, or one that cannot be what it stands for.
    #[error("`{field}` {reason}")]
    Number {
        /// The field.
        field: String,
        /// What is wrong.
        reason: String,
    },
    /// The digest is that of other filters or another proof.
    #[error(
        "was changed after it was written: the digest of its filters and proof is {found}, and `digest` says {written}"
    )]
    Changed {
        /// The digest of what stands there.
        found: String,
        /// The digest that stands there.
        written: String,
    },
    /// A letter that names no filter, or a form that is not 3 × 3.
    #[error("`proof` {0}")]
    Proof(String),
    /// It proves nothing.
    #[error("proves nothing: {0}")]
    NotProven(#[from] NotProven),
}

/// A fraction p/q or a decimal.
///
/// Example: the same number twice, and a fraction in other terms.
///
/// ```
/// use immaculate::number::Rational;
/// use immaculate::steady::certificate_file::read_number;
///
/// assert_eq!(read_number("radius", "-3/2"), read_number("radius", "-1.5"));
/// assert_eq!(read_number("radius", "6/4"), Ok(Rational::new(3, 2)));
/// ```
///
/// # Errors
///
/// [`InvalidCertificate::Number`] for anything else.
pub fn read_number(field: &str, text: &str) -> Result<Rational, InvalidCertificate> {
    let (numerator, denominator) = text.split_once('/').unwrap_or((text, "1"));
    let parts = Rational::from_decimal(numerator.trim()).zip(Rational::from_decimal(denominator.trim()));
    let value = parts.map(|(p, q)| p / q).filter(Rational::is_decided);
    let value = value.ok_or_else(|| wrong(field, format!("is `{text}`, which is no decimal and no fraction")))?;
    if bits(&value) > LONGEST_NUMBER {
        return Err(wrong(field, format!("is {text}: it has too many digits")));
    }
    Ok(value)
}

/// The length of a fraction.
fn bits(value: &Rational) -> u64 {
    let value = value.value();
    value.map_or(0, |value| value.numer().bits() + value.denom().bits())
}

/// What is wrong with a number, which may be megabytes long.
fn wrong(field: &str, reason: impl AsRef<str>) -> InvalidCertificate {
    let (field, reason) = (field.to_owned(), shortened(reason.as_ref(), 500));
    InvalidCertificate::Number { field, reason }
}

impl Noises {
    /// The filters that have these noises.
    ///
    /// # Errors
    ///
    /// [`InvalidCertificate::Number`] for a noise or a time that is not positive, or beyond [`SANE`].
    pub fn filters(&self) -> Result<Filters, InvalidCertificate> {
        let positive = |field: &str, text: &str| {
            let value = read_number(field, text)?;
            if !value.is_positive() {
                let consequence = match field {
                    "measurement" => "without measurement noise the innovation is not weighed against anything",
                    "interval" => "the filters need a time between two scans",
                    _ => "without process noise the gain falls to zero and there is no steady state that stabilises",
                };
                return Err(wrong(
                    field,
                    format!("is {text}: it must be positive, since {consequence} (derbez2000 (2))"),
                ));
            }
            let size = value.to_f64();
            if !(SANE[0]..=SANE[1]).contains(&size) {
                let range = format!("{:e} to {:e}", SANE[0], SANE[1]);
                return Err(wrong(
                    field,
                    format!("is {text}, outside {range}: is its unit right? (derbez2000 (2))"),
                ));
            }
            Ok(value)
        };
        let t = positive("interval", &self.interval)?;
        let r = positive("measurement", &self.measurement)?;
        let noises = [
            positive("constant-velocity", &self.constant_velocity)?,
            positive("constant-acceleration", &self.constant_acceleration)?,
        ];
        Ok(Filters::of_noises(&t, &r, noises))
    }
}

impl FiltersFile {
    /// t, s, and R, m²; one and one for damping roots, which are without units.
    ///
    /// # Errors
    ///
    /// [`InvalidCertificate::Number`].
    pub fn units(&self) -> Result<[Rational; 2], InvalidCertificate> {
        match self {
            Self::DampingRoots(_) => Ok([Rational::new(1, 1), Rational::new(1, 1)]),
            Self::Noises(noises) => Ok([
                read_number("interval", &noises.interval)?,
                read_number("measurement", &noises.measurement)?,
            ]),
        }
    }

    /// The filters.
    ///
    /// # Errors
    ///
    /// [`InvalidCertificate::Number`].
    pub fn filters(&self) -> Result<Filters, InvalidCertificate> {
        let [v, a] = match self {
            Self::Noises(noises) => return noises.filters(),
            Self::DampingRoots(roots) => roots,
        };
        let root = |text: &String| {
            let value = read_number("damping-roots", text)?;
            if value.is_positive() && value < Rational::new(1, 1) {
                return Ok(value);
            }
            Err(wrong(
                "damping-roots",
                format!("has {text}, which is not between 0 and 1"),
            ))
        };
        Ok(Filters::Roots([root(v)?, root(a)?]))
    }
}

impl CertificateFile {
    /// A certificate from a verdict; none if it is undecided.
    pub fn new(about: String, filters: FiltersFile, verdict: &StabilityVerdict) -> Option<Self> {
        let proof = match verdict {
            StabilityVerdict::Stable(found) => {
                let edge = |edge: &Edge| (edge.from, LETTERS[edge.letter], edge.to);
                ProofFile::Stable {
                    edges: found.edges.iter().map(edge).collect(),
                    forms: found.forms.iter().map(rows_as_text).collect(),
                }
            }
            StabilityVerdict::Unstable(found) => ProofFile::Unstable {
                word: word_text(&found.word),
                radius: found.radius.to_string(),
            },
            StabilityVerdict::Undecided { .. } => return None,
        };
        Some(Self {
            format: FORMAT.to_owned(),
            about,
            digest: digest_of(&filters, &proof),
            filters,
            proof,
        })
    }

    /// Reads a certificate.
    ///
    /// # Errors
    ///
    /// [`InvalidCertificate`].
    pub fn read(text: &str) -> Result<Self, InvalidCertificate> {
        let file: Self = serde_json::from_str(text).map_err(|error| InvalidCertificate::Json(error.to_string()))?;
        if file.format != FORMAT {
            return Err(InvalidCertificate::Format(file.format));
        }
        let found = digest_of(&file.filters, &file.proof);
        if found != file.digest {
            let written = file.digest;
            return Err(InvalidCertificate::Changed { found, written });
        }
        Ok(file)
    }

    /// Checks the proof, and gives what it proves.
    ///
    /// # Errors
    ///
    /// [`InvalidCertificate`] with the reason why it proves nothing.
    pub fn check(&self) -> Result<StabilityVerdict, InvalidCertificate> {
        let filters = self.filters.filters()?;
        self.check_size()?;
        match &self.proof {
            ProofFile::Stable { edges, forms } => {
                let edge = |(from, letter, to): &(usize, char, usize)| {
                    let (from, letter, to) = (*from, read_letter(*letter)?, *to);
                    Ok::<_, InvalidCertificate>(Edge { from, letter, to })
                };
                let found = Quadratics {
                    edges: edges.iter().map(edge).collect::<Result<_, _>>()?,
                    forms: forms.iter().map(|form| read_form(form)).collect::<Result<_, _>>()?,
                };
                filters.check_stable(&found)?;
                Ok(StabilityVerdict::Stable(found))
            }
            ProofFile::Unstable { word, radius } => {
                let found = Product {
                    word: word.chars().map(read_letter).collect::<Result<_, _>>()?,
                    radius: read_number("proof.unstable.radius", radius)?,
                };
                filters.check_unstable(&found)?;
                Ok(StabilityVerdict::Unstable(found))
            }
        }
    }
}

impl CertificateFile {
    /// A proof that is larger than any that is written would take a time that nobody waits.
    fn check_size(&self) -> Result<(), InvalidCertificate> {
        let too_large = |what: &str| Err(InvalidCertificate::Proof(format!("has more than {what}")));
        match &self.proof {
            ProofFile::Stable { forms, .. } if forms.len() > MOST_FORMS => too_large(&format!("{MOST_FORMS} forms")),
            ProofFile::Stable { edges, .. } if edges.len() > MOST_EDGES => too_large(&format!("{MOST_EDGES} edges")),
            ProofFile::Unstable { word, .. } if word.len() > LONGEST_WORD => {
                too_large(&format!("{LONGEST_WORD} letters"))
            }
            _ => Ok(()),
        }
    }
}

/// The JSON Schema of these files.
pub fn schema() -> serde_json::Value {
    let mut schema = serde_json::json!(schemars::schema_for!(CertificateFile));
    schema["properties"]["format"]["const"] = serde_json::json!(FORMAT);
    // The type of an edge knows a letter, and not that there are two.
    let edges = "/$defs/ProofFile/oneOf/0/properties/stable/properties/edges/items/prefixItems/1";
    if let Some(letter) = schema.pointer_mut(edges) {
        *letter = serde_json::json!({ "enum": LETTERS });
    }
    schema
}

fn digest_of(filters: &FiltersFile, proof: &ProofFile) -> String {
    digest(&format!("{}{}", serde_json::json!(filters), serde_json::json!(proof)))
}

fn read_letter(letter: char) -> Result<usize, InvalidCertificate> {
    let place = LETTERS.iter().position(|known| *known == letter);
    place.ok_or_else(|| InvalidCertificate::Proof(format!("has the letter `{letter}`; there are `v` and `a`")))
}

fn rows_as_text(form: &SMatrix<Rational, 3, 3>) -> Vec<Vec<String>> {
    let row = |i| (0..3).map(|j| form[(i, j)].to_string()).collect();
    (0..3).map(row).collect()
}

fn read_form(rows: &[Vec<String>]) -> Result<SMatrix<Rational, 3, 3>, InvalidCertificate> {
    if rows.len() != 3 || rows.iter().any(|row| row.len() != 3) {
        return Err(InvalidCertificate::Proof("has a form that is not 3 × 3".to_owned()));
    }
    let mut form = SMatrix::<Rational, 3, 3>::zeros();
    for (i, row) in rows.iter().enumerate() {
        for (j, text) in row.iter().enumerate() {
            form[(i, j)] = read_number("proof.stable.forms", text)?;
        }
    }
    Ok(form)
}
