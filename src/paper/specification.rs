//! The papers' half of the specification, read from the files in `spec/`, which are built into the program.
//!
//! A paper's equations, tables, open parameters and claims are values here. Each open parameter of `spec/<paper>/scenario.toml` has a
//! default and alternatives, and a scenario's choices are named by them.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// Everything that `spec/` says about one paper.
#[derive(Debug, Clone)]
pub struct Specification {
    /// Who wrote it, and where.
    pub paper: Citation,
    /// What its filters are, in the words of `spec/variants.toml`.
    pub applies: Vec<String>,
    /// The numbered equations, in order.
    pub equations: Vec<PublishedEquation>,
    /// What the paper prints without a number, or needs and does not print.
    pub unnumbered: Vec<PublishedEquation>,
    /// The published tables.
    pub tables: Vec<PublishedTable>,
    /// The open parameters of the scenario.
    pub parameters: Vec<Parameter>,
    /// What the paper claims.
    pub claims: Vec<Claim>,
}

/// A paper's citation.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Citation {
    /// The key, `zhu2016`.
    pub key: String,
    /// The title.
    pub title: String,
    /// The authors.
    pub authors: Authors,
    /// Journal, volume, pages.
    pub venue: String,
    /// The digital object identifier.
    pub doi: String,
}

/// Authors as one string or a list.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(untagged)]
pub enum Authors {
    /// As one string.
    One(String),
    /// As a list.
    Many(Vec<String>),
}

impl std::fmt::Display for Authors {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::One(author) => f.write_str(author),
            Self::Many(authors) => f.write_str(&authors.join(", ")),
        }
    }
}

/// An equation of a paper.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct PublishedEquation {
    /// The printed number.
    pub number: Option<u32>,
    /// The name of an equation without a number.
    pub name: Option<String>,
    /// The correct form in LaTeX.
    pub latex: String,
    /// `as-printed`, `corrected` or `reconstructed`.
    pub status: String,
    /// What it says.
    pub meaning: String,
    /// The values of a filter's step that it is an equation of; none outside a step.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub quantities: Vec<String>,
    /// Where it is used, in the words of `spec/variants.toml`, if not wherever the paper's filters are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub applies: Option<Vec<String>>,
    /// Which mistakes of these values are made in it; where none is named, all that can be made where it is used.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mistakes: Vec<String>,
    /// Of an equation outside a step: why no case holds it, and what does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outside: Option<String>,
    /// What is wrong as printed.
    pub erratum: Option<Erratum>,
}

impl PublishedEquation {
    /// The printed number, or the name of an equation without one.
    pub fn label(&self) -> String {
        let number = self.number.map(|number| number.to_string());
        number.or_else(|| self.name.clone()).unwrap_or_default()
    }
}

/// What is wrong with an equation as printed.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Erratum {
    /// The erratum's name.
    pub id: String,
    /// The printed form in LaTeX.
    pub printed: String,
    /// What is wrong.
    pub why: String,
    /// Why it is wrong.
    pub proof: String,
    /// `mathematical` or `notational`.
    pub kind: String,
    /// The test in which the printed form fails and the corrected one passes.
    pub test: Option<String>,
}

/// A published table.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct PublishedTable {
    /// Its number.
    pub number: u32,
    /// Its caption.
    pub caption: String,
    /// The names of its columns.
    pub columns: Vec<String>,
    /// Its rows.
    pub rows: Vec<TableRow>,
}

/// A row of a published table.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct TableRow {
    /// The row's name.
    pub name: String,
    /// The unit of its values; `1` for a count.
    pub unit: String,
    /// One value a column.
    pub values: Vec<f64>,
}

/// An open parameter of a scenario.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// What the paper says about it.
    pub printed: String,
    /// The alternative that is used when no other is asked for.
    pub default: String,
    /// Those of the paper's scenarios that have this parameter; empty where all have.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub scenarios: Vec<String>,
    /// All alternatives, the default among them.
    #[serde(rename = "alternative")]
    pub alternatives: Vec<Alternative>,
}

impl Parameter {
    /// Whether one of the paper's scenarios has this parameter.
    pub fn belongs_to(&self, scenario: &str) -> bool {
        self.scenarios.is_empty() || self.scenarios.iter().any(|of| of == scenario)
    }
}

/// A value of an open parameter.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Alternative {
    /// Its name.
    pub name: String,
    /// What it means, with numbers and units.
    pub meaning: String,
}

/// What a paper claims.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// Its name.
    pub id: String,
    /// The paper's words.
    pub quote: String,
    /// Where they stand.
    #[serde(rename = "where")]
    pub place: String,
    /// What is asked precisely.
    pub question: String,
    /// What is computed to answer it.
    pub judged_by: String,
}

/// A choice that a scenario does not have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum InvalidChoice {
    /// Not of the form `parameter=alternative`.
    #[error("`{text}` is not of the form parameter=alternative")]
    Form {
        /// What was given.
        text: String,
    },
    /// No such parameter.
    #[error("{paper} has no parameter `{name}`; it has {known}")]
    Parameter {
        /// The paper.
        paper: String,
        /// The name that was asked for.
        name: String,
        /// The names that there are.
        known: String,
    },
    /// A scenario of the usual form, of a paper that has none.
    #[error("{paper} has no scenario of the form that was asked for, of filters with the state [x, vx, y, vy]")]
    OtherForm {
        /// The paper.
        paper: String,
    },
    /// A choice of what a sweep runs all of.
    #[error("a sweep runs every alternative of `{parameter}`; choose none")]
    Swept {
        /// The parameter.
        parameter: String,
    },
    /// No such alternative.
    #[error("the parameter `{parameter}` of {paper} has no alternative `{name}`; it has {known}")]
    Alternative {
        /// The paper.
        paper: String,
        /// The parameter.
        parameter: String,
        /// The name that was asked for.
        name: String,
        /// The names that there are.
        known: String,
    },
}

/// One alternative for each parameter that is not left at its default.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Choices(BTreeMap<String, String>);

impl Choices {
    /// The choice of one alternative.
    pub fn of(parameter: &str, alternative: &str) -> Self {
        Self::default().with(parameter, alternative)
    }

    /// These choices and one more.
    #[must_use]
    pub fn with(mut self, parameter: &str, alternative: &str) -> Self {
        self.0.insert(parameter.to_owned(), alternative.to_owned());
        self
    }

    /// These choices and others, which win.
    #[must_use]
    pub fn and(mut self, others: &Self) -> Self {
        self.0.extend(others.0.clone());
        self
    }

    /// Choices from texts of the form `parameter=alternative`.
    ///
    /// Example: as `--set` has it on the command line.
    ///
    /// ```
    /// use immaculate::paper::specification::Choices;
    ///
    /// let choices = Choices::parse(&["measurement=range-bearing".into()]).unwrap();
    /// assert_eq!(choices.chosen("measurement"), Some("range-bearing"));
    /// ```
    ///
    /// # Errors
    ///
    /// [`InvalidChoice::Form`] for a text without `=`.
    pub fn parse(texts: &[String]) -> Result<Self, InvalidChoice> {
        let mut choices = Self::default();
        for text in texts {
            let Some((parameter, alternative)) = text.split_once('=') else {
                return Err(InvalidChoice::Form { text: text.clone() });
            };
            choices = choices.with(parameter.trim(), alternative.trim());
        }
        Ok(choices)
    }

    /// The choices as `parameter=alternative`, or `defaults` where nothing is chosen.
    pub fn describe(&self) -> String {
        if self.0.is_empty() {
            return "defaults".to_owned();
        }
        let choices: Vec<String> = self.0.iter().map(|(p, a)| format!("{p}={a}")).collect();
        choices.join(", ")
    }

    /// The alternative that is chosen for a parameter; none where it is left at its default.
    pub fn chosen(&self, parameter: &str) -> Option<&str> {
        self.0.get(parameter).map(String::as_str)
    }

    /// The names of the parameters that are chosen.
    pub fn parameters(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }
}

impl Specification {
    /// The equations with a printed number, then those without.
    pub fn all_equations(&self) -> impl Iterator<Item = &PublishedEquation> {
        self.equations.iter().chain(&self.unnumbered)
    }

    /// The alternative of a parameter: the chosen one, or the default.
    ///
    /// # Errors
    ///
    /// [`InvalidChoice`] when the parameter or the chosen alternative does not exist.
    pub fn chosen<'a>(&'a self, choices: &Choices, parameter: &str) -> Result<&'a str, InvalidChoice> {
        let paper = || self.paper.key.clone();
        let Some(known) = self.parameters.iter().find(|p| p.name == parameter) else {
            let names: Vec<&str> = self.parameters.iter().map(|p| p.name.as_str()).collect();
            return Err(InvalidChoice::Parameter {
                paper: paper(),
                name: parameter.to_owned(),
                known: names.join(", "),
            });
        };
        let name = choices.chosen(parameter).unwrap_or(&known.default);
        if let Some(alternative) = known.alternatives.iter().find(|a| a.name == name) {
            return Ok(&alternative.name);
        }
        let names: Vec<&str> = known.alternatives.iter().map(|a| a.name.as_str()).collect();
        Err(InvalidChoice::Alternative {
            paper: paper(),
            parameter: parameter.to_owned(),
            name: name.to_owned(),
            known: names.join(", "),
        })
    }

    /// Every choice names a parameter and an alternative of this paper.
    ///
    /// # Errors
    ///
    /// [`InvalidChoice`] for the first that does not.
    pub fn check(&self, choices: &Choices) -> Result<(), InvalidChoice> {
        for parameter in choices.parameters() {
            self.chosen(choices, parameter)?;
        }
        Ok(())
    }

    /// The choices of parameters that this paper has.
    pub fn choices_of_this_paper(&self, choices: &Choices) -> Choices {
        let known = |parameter: &str| self.parameters.iter().any(|p| p.name == parameter);
        let kept = choices.0.iter().filter(|(parameter, _)| known(parameter));
        Choices(kept.map(|(p, a)| (p.clone(), a.clone())).collect())
    }

    /// All choices of one alternative that is not a default, in the order of the file.
    pub fn single_alternatives(&self) -> Vec<Choices> {
        Self::alternatives(self.parameters.iter())
    }

    /// The same for one of the paper's scenarios, its default one where none is named: of the parameters that it has.
    pub fn alternatives_of(&self, scenario: Option<&str>) -> Vec<Choices> {
        let named = self.parameters.iter().find(|parameter| parameter.name == "scenario");
        let scenario = scenario.or(named.map(|parameter| parameter.default.as_str()));
        let parameters = self.parameters.iter().filter(|parameter| parameter.name != "scenario");
        Self::alternatives(
            parameters.filter(|parameter| scenario.is_none_or(|scenario| parameter.belongs_to(scenario))),
        )
    }

    fn alternatives<'a>(parameters: impl Iterator<Item = &'a Parameter>) -> Vec<Choices> {
        let mut all = Vec::new();
        for parameter in parameters {
            for alternative in &parameter.alternatives {
                if alternative.name != parameter.default {
                    all.push(Choices::of(&parameter.name, &alternative.name));
                }
            }
        }
        all
    }
}

/// The specification of derbez2000.
pub fn derbez2000() -> &'static Specification {
    static SPECIFICATION: LazyLock<Specification> = LazyLock::new(|| {
        parse([
            include_str!("../../spec/derbez2000/equations.toml"),
            include_str!("../../spec/derbez2000/tables.toml"),
            include_str!("../../spec/derbez2000/scenario.toml"),
            include_str!("../../spec/derbez2000/claims.toml"),
        ])
    });
    &SPECIFICATION
}

/// The specification of sustika2015.
pub fn sustika2015() -> &'static Specification {
    static SPECIFICATION: LazyLock<Specification> = LazyLock::new(|| {
        parse([
            include_str!("../../spec/sustika2015/equations.toml"),
            include_str!("../../spec/sustika2015/tables.toml"),
            include_str!("../../spec/sustika2015/scenario.toml"),
            include_str!("../../spec/sustika2015/claims.toml"),
        ])
    });
    &SPECIFICATION
}

/// The specification of zhu2016.
pub fn zhu2016() -> &'static Specification {
    static SPECIFICATION: LazyLock<Specification> = LazyLock::new(|| {
        parse([
            include_str!("../../spec/zhu2016/equations.toml"),
            include_str!("../../spec/zhu2016/tables.toml"),
            include_str!("../../spec/zhu2016/scenario.toml"),
            include_str!("../../spec/zhu2016/claims.toml"),
        ])
    });
    &SPECIFICATION
}

/// The specification of liu2017.
pub fn liu2017() -> &'static Specification {
    static SPECIFICATION: LazyLock<Specification> = LazyLock::new(|| {
        parse([
            include_str!("../../spec/liu2017/equations.toml"),
            include_str!("../../spec/liu2017/tables.toml"),
            include_str!("../../spec/liu2017/scenario.toml"),
            include_str!("../../spec/liu2017/claims.toml"),
        ])
    });
    &SPECIFICATION
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EquationsFile {
    applies: Vec<String>,
    paper: Citation,
    equation: Vec<PublishedEquation>,
    #[serde(default)]
    unnumbered: Vec<PublishedEquation>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TablesFile {
    table: Vec<PublishedTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScenarioFile {
    #[allow(
        dead_code,
        reason = "the fixed parameters are constants of the code; the file states them for readers"
    )]
    printed: toml::Table,
    parameter: Vec<Parameter>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ClaimsFile {
    claim: Vec<Claim>,
}

/// The four files of a paper. They are part of the program, and a test reads them: a file that cannot be read is a defect of the
/// program, not of its input.
fn parse([equations, tables, scenario, claims]: [&str; 4]) -> Specification {
    let equations: EquationsFile = read(equations);
    let tables: TablesFile = read(tables);
    let scenario: ScenarioFile = read(scenario);
    let claims: ClaimsFile = read(claims);
    Specification {
        paper: equations.paper,
        applies: equations.applies,
        equations: equations.equation,
        unnumbered: equations.unnumbered,
        tables: tables.table,
        parameters: scenario.parameter,
        claims: claims.claim,
    }
}

fn read<T: serde::de::DeserializeOwned>(text: &str) -> T {
    toml::from_str(text).expect("the specification's files are part of the program")
}
