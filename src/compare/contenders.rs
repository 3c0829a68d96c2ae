//! Which filters a problem can be given to: every kind, every interaction, and each mode by itself.
//!
//! The reader of problem files decides what applies; its sentence is the reason why something does not.

use crate::oracle::problem::{
    EstimateFile, FORMAT_2, FilterFile, InteractionFile, MeasurementAt, ModeFile, ProblemFile, Rows, UNMIXED,
};
use serde::Serialize;
use std::num::NonZeroUsize;

/// A filter with more points than this is not compared: it would take all the time.
const MOST_POINTS: u128 = 1000;

/// There are at most this many filters and interactions, beside the modes alone.
pub(super) const MOST: usize = 19;

/// How often the iterated filter linearises.
const ITERATIONS: usize = 5;

/// A filter to be compared.
#[derive(Debug, Clone)]
pub struct Contender {
    /// Its name.
    pub name: String,
    /// The problem with this filter.
    pub problem: ProblemFile,
    /// Whether it is GPB2, which merges after the update; no problem file asks for it.
    pub is_second_order: bool,
}

/// A filter that the problem cannot be given to.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Absentee {
    /// Its name.
    pub name: String,
    /// Why.
    pub reason: String,
}

/// What is compared: the file's own filter first.
#[derive(Debug, Clone)]
pub struct Entrants {
    /// Every filter, each once.
    pub contenders: Vec<Contender>,
    /// Which of them differ in the kind of filter, with the file's interaction.
    pub kinds: Vec<usize>,
    /// Which of them differ in the interaction, with the file's filter.
    pub interactions: Vec<usize>,
    /// The name of the file's interaction; none with one mode.
    pub interaction: Option<&'static str>,
    /// The name of the file's filter.
    pub filter: String,
    /// The others.
    pub absent: Vec<Absentee>,
}

impl Entrants {
    /// The filters of a problem, whose own filter has already been found right.
    pub fn new(problem: &ProblemFile) -> Self {
        let filter = own_name(problem);
        let interaction = (problem.modes.len() > 1).then(|| interaction_name(problem));
        let mut entrants = Self {
            contenders: Vec::new(),
            kinds: vec![0],
            interactions: vec![0],
            interaction,
            filter: filter.clone(),
            absent: Vec::new(),
        };
        entrants.contenders.push(Contender {
            name: filter.clone(),
            problem: problem.clone(),
            is_second_order: false,
        });
        for kind in kinds(problem.state.len()) {
            let name = kind_name(&kind);
            if name == filter {
                continue;
            }
            if let Some(reason) = too_many_points(&kind, problem.state.len()) {
                entrants.absent.push(Absentee { name, reason });
            } else if let Some(place) = entrants.enter(name, with_filter(problem, kind)) {
                entrants.kinds.push(place);
            }
        }
        if interaction.is_some() {
            for (name, other) in other_interactions(problem) {
                let place = entrants.enter(name, Ok(other));
                entrants.interactions.extend(place);
            }
            if let Some(place) = entrants.enter("GPB2".to_owned(), second_order(problem)) {
                entrants.contenders[place].is_second_order = true;
                entrants.interactions.push(place);
            }
            for j in 0..problem.modes.len() {
                let name = format!("{} alone", problem.modes[j].name);
                let place = entrants.enter(name, alone(problem, j));
                entrants.interactions.extend(place);
            }
        }
        entrants
    }

    /// Takes in a filter that applies, or says why it does not.
    fn enter(&mut self, name: String, problem: Result<ProblemFile, String>) -> Option<usize> {
        let checked = problem.and_then(|problem| match problem.check() {
            Ok(()) => Ok(problem),
            Err(invalid) => Err(invalid.to_string()),
        });
        match checked {
            Ok(problem) => {
                self.contenders.push(Contender {
                    name,
                    problem,
                    is_second_order: false,
                });
                Some(self.contenders.len() - 1)
            }
            Err(reason) => {
                self.absent.push(Absentee { name, reason });
                None
            }
        }
    }
}

/// Every kind of filter for a state of n components, with its usual parameters.
fn kinds(n: usize) -> Vec<FilterFile> {
    let rule = |name: &str| FilterFile::Cubature { rule: name.into() };
    let conversion = |name: &str| FilterFile::Converted {
        conversion: name.into(),
    };
    vec![
        FilterFile::Kalman {},
        FilterFile::Extended { iterations: None },
        FilterFile::Extended {
            iterations: NonZeroUsize::new(ITERATIONS),
        },
        // Wan and van der Merwe 2000; Julier and Uhlmann 1997.
        FilterFile::Unscented {
            alpha: 1e-3,
            beta: 2.0,
            kappa: 0.0,
        },
        FilterFile::Unscented {
            alpha: 1.0,
            beta: 0.0,
            kappa: 3.0 - n as f64,
        },
        rule("cubature-3"),
        rule("cubature-5"),
        rule("simplex-5"),
        rule("gauss-hermite-3"),
        conversion("standard"),
        conversion("additive"),
        conversion("multiplicative"),
        conversion("modified-unbiased"),
    ]
}

/// The name of a kind, with its parameters.
fn kind_name(filter: &FilterFile) -> String {
    match filter {
        FilterFile::Extended {
            iterations: Some(times),
        } if times.get() > 1 => format!("extended {times} times"),
        FilterFile::Unscented { alpha, beta, kappa } => format!("unscented {alpha}/{beta}/{kappa}"),
        FilterFile::Converted { conversion } => format!("converted {conversion}"),
        other => other.name().to_owned(),
    }
}

/// The name of the file's own filter; modes may have filters of their own.
fn own_name(problem: &ProblemFile) -> String {
    let mut names: Vec<String> = (0..problem.modes.len())
        .map(|j| kind_name(problem.filter_of(j)))
        .collect();
    if names.windows(2).all(|pair| pair[0] == pair[1]) {
        names.truncate(1);
    }
    names.join(" / ")
}

fn too_many_points(kind: &FilterFile, n: usize) -> Option<String> {
    let FilterFile::Cubature { rule } = kind else {
        return None;
    };
    let sides: u128 = rule.strip_prefix("gauss-hermite-")?.parse().ok()?;
    let points = sides.saturating_pow(u32::try_from(n).unwrap_or(u32::MAX));
    (points > MOST_POINTS).then(|| format!("it draws {sides}^{n} points, and more than {MOST_POINTS} are not compared"))
}

/// The problem with one filter for all modes.
fn with_filter(problem: &ProblemFile, filter: FilterFile) -> Result<ProblemFile, String> {
    if let FilterFile::FixedGain { .. } = problem.filter {
        return Err("the file has fixed gains, and its initial estimates no covariances".to_owned());
    }
    let mut other = problem.clone();
    FORMAT_2.clone_into(&mut other.format);
    other.filter = filter;
    for mode in &mut other.modes {
        mode.models.filter = None;
    }
    Ok(other)
}

/// The name of the file's interaction.
fn interaction_name(problem: &ProblemFile) -> &'static str {
    match (&problem.filter, problem.interaction()) {
        (FilterFile::FixedGain { mixing, .. }, _) if mixing == UNMIXED => UNMIXED,
        (_, InteractionFile::Imm) => "IMM",
        (_, InteractionFile::Gpb1) => "GPB1",
        (_, InteractionFile::Unmixed) => UNMIXED,
    }
}

/// The problem with the interactions that are not the file's, by name; and the static bank, which believes that the mode never changes.
fn other_interactions(problem: &ProblemFile) -> Vec<(String, ProblemFile)> {
    let own = interaction_name(problem);
    let all = [
        ("IMM", InteractionFile::Imm),
        ("GPB1", InteractionFile::Gpb1),
        (UNMIXED, InteractionFile::Unmixed),
        ("static bank", InteractionFile::Unmixed),
    ];
    let mut others = Vec::new();
    for (name, interaction) in all.into_iter().filter(|(name, _)| *name != own) {
        let mut other = problem.clone();
        FORMAT_2.clone_into(&mut other.format);
        match (&mut other.filter, interaction) {
            (FilterFile::FixedGain { mixing, .. }, InteractionFile::Imm) => "mixed".clone_into(mixing),
            (FilterFile::FixedGain { mixing, .. }, InteractionFile::Unmixed) => UNMIXED.clone_into(mixing),
            _ => other.interaction = Some(interaction),
        }
        if name == "static bank" {
            let count = problem.modes.len();
            let row = |i: usize| (0..count).map(|j| f64::from(u8::from(i == j))).collect();
            with_chain(&mut other, &(0..count).map(row).collect());
        }
        others.push((name.to_owned(), other));
    }
    others
}

/// The problem as GPB2 reads it: that of the interacting filter.
fn second_order(problem: &ProblemFile) -> Result<ProblemFile, String> {
    if let FilterFile::FixedGain { .. } = problem.filter {
        return Err("the file has fixed gains, and GPB2 merges covariances".to_owned());
    }
    let mut other = problem.clone();
    if other.interaction() != InteractionFile::Imm {
        other.interaction = Some(InteractionFile::Imm);
    }
    Ok(other)
}

/// Replaces the chain of the problem, in every step.
fn with_chain(problem: &mut ProblemFile, chain: &Rows) {
    (problem.rates, problem.sojourn_times, problem.jumps) = (None, None, None);
    problem.transition.clone_from(chain);
    for entry in &mut problem.measurements {
        entry.transition = entry.transition.as_ref().map(|_| chain.clone());
    }
}

/// The filter of one mode by itself. It starts from the combined estimate of all modes, and believes that its mode is always the true one.
fn alone(problem: &ProblemFile, j: usize) -> Result<ProblemFile, String> {
    if !problem.conversions.is_empty() {
        return Err(
            "modes have states of their own, and one alone has no combined estimate in the common state".to_owned(),
        );
    }
    let setup = problem.setup_in_doubles().map_err(|invalid| invalid.to_string())?;
    let combined = &setup.filter().current().combined.clone();
    let has_covariance = problem.initial.modes[j].covariance.is_some();
    let rows = || -> Rows {
        let matrix = &combined.covariance;
        // The lower triangle, which is the one that the equations read.
        let entry = |row: usize, column: usize| matrix[(row.max(column), row.min(column))].value();
        (0..matrix.nrows())
            .map(|row| (0..matrix.ncols()).map(|column| entry(row, column)).collect())
            .collect()
    };
    let mut single = problem.clone();
    let mode: ModeFile = problem.modes[j].clone();
    single.modes = vec![mode];
    single.initial.mode_probabilities = vec![1.0];
    single.initial.modes = vec![EstimateFile {
        mean: combined.mean.iter().map(|entry| entry.value()).collect(),
        covariance: has_covariance.then(rows),
    }];
    single.interaction = None;
    with_chain(&mut single, &vec![vec![1.0]]);
    if let FilterFile::FixedGain { modes, .. } = &mut single.filter {
        *modes = vec![modes[j].clone()];
    }
    let of_mode = |list: &Option<Vec<Rows>>| list.as_ref().map(|list| vec![list[j].clone()]);
    for entry in &mut single.measurements {
        let MeasurementAt {
            transitions, noises, ..
        } = entry;
        (*transitions, *noises) = (of_mode(transitions), of_mode(noises));
    }
    Ok(single)
}
