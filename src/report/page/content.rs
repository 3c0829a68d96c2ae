//! The computations behind the pages.
//!
//! They are the same as those of the other commands, with the same seed and the same results: `reproduce`,
//! `reproduce sustika2015 --sweep`, `claims` and `stability --map`.

use crate::paper::monte_carlo::Progress;
use crate::paper::result::Reproduction;
use crate::paper::specification::{Choices, InvalidChoice};
use crate::paper::sustika2015::divergence::{self, DivergenceRow};
use crate::paper::sustika2015::sweep::{Sweep, SweepPoint, SweepSetting, settings};
use crate::paper::sustika2015::{self};
use crate::paper::verdict::JudgedClaim;
use crate::paper::{Effort, Paper};
use crate::steady::map::Map;
use crate::steady::verdict::Depth;

/// How much is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Extent {
    /// Runs and seed.
    pub effort: Effort,
    /// The points of a side of the stability map.
    pub map_points: usize,
}

/// Everything on the page that is computed.
#[derive(Debug, Clone)]
pub struct Content {
    /// How much was computed.
    pub extent: Extent,
    /// What was run of each paper.
    pub papers: Vec<OfPaper>,
    /// Scenario 3 of sustika2015.
    pub sweep: OfRuns<Vec<(SweepSetting, SweepPoint)>>,
    /// What makes the unscented filter of sustika2015 diverge.
    pub divergence: OfRuns<Vec<DivergenceRow>>,
    /// Which fixed-gain filters are stable together.
    pub map: Map,
}

/// Results, and from how many runs each of them is.
#[derive(Debug, Clone)]
pub struct OfRuns<T> {
    /// The number of runs.
    pub runs: usize,
    /// What they show.
    pub results: T,
}

/// What was run of one paper.
#[derive(Debug, Clone)]
pub struct OfPaper {
    /// The paper.
    pub paper: Paper,
    /// Its simulations: each under its defaults, then under each open choice by itself.
    pub simulations: Vec<Vec<Reproduction>>,
    /// Its claims, judged.
    pub judgements: Vec<JudgedClaim>,
}

/// An observer of the computation: called when a step begins, with its length if known, and for every unit of work.
pub struct Watch<'a> {
    /// A step begins.
    pub begin: &'a dyn Fn(String, Option<usize>),
    /// One run, or one point of the map, is done.
    pub advance: Progress<'a>,
}

impl Content {
    /// Runs everything.
    ///
    /// # Errors
    ///
    /// [`InvalidChoice`] never, unless the specification and the code disagree about the scenarios' parameters.
    pub fn compute(extent: Extent, watch: &Watch) -> Result<Self, InvalidChoice> {
        let of_paper = |paper: &Paper| OfPaper::compute(*paper, extent.effort, watch);
        Ok(Self {
            extent,
            papers: Paper::ALL.iter().map(of_paper).collect::<Result<_, _>>()?,
            sweep: sweep(extent.effort, watch)?,
            divergence: divergence(extent.effort, watch)?,
            map: map(extent.map_points, watch),
        })
    }
}

impl OfPaper {
    fn compute(paper: Paper, effort: Effort, watch: &Watch) -> Result<Self, InvalidChoice> {
        let mut simulations = Vec::new();
        for chosen in paper.simulations(&Choices::default()) {
            let mut plan = vec![chosen.clone()];
            plan.extend(paper.open_choices(&chosen));
            let runs = effort.runs.unwrap_or(paper.simulation(&chosen)?.runs());
            (watch.begin)(format!("simulating {}", paper.key()), Some(plan.len() * runs));
            let reproductions = plan
                .iter()
                .map(|choices| paper.reproduce(choices, effort, watch.advance));
            simulations.push(reproductions.collect::<Result<Vec<_>, _>>()?);
        }
        (watch.begin)(format!("judging {}", paper.key()), None);
        Ok(Self {
            paper,
            simulations,
            judgements: paper.judge(effort, watch.advance)?,
        })
    }
}

fn sweep(effort: Effort, watch: &Watch) -> Result<OfRuns<Vec<(SweepSetting, SweepPoint)>>, InvalidChoice> {
    let runs = effort.runs.unwrap_or(sustika2015::RUNS);
    (watch.begin)("sweeping sustika2015".to_owned(), Some(settings().len() * runs));
    let sweep = Sweep::new(&Choices::default(), runs, effort.seed)?;
    Ok(OfRuns {
        runs,
        results: sweep.run(watch.advance),
    })
}

fn divergence(effort: Effort, watch: &Watch) -> Result<OfRuns<Vec<DivergenceRow>>, InvalidChoice> {
    let runs = effort.runs.unwrap_or(divergence::RUNS);
    let length = divergence::SIMULATIONS.len() * runs;
    (watch.begin)("looking for what diverges".to_owned(), Some(length));
    Ok(OfRuns {
        runs,
        results: divergence::rows(runs, effort.seed, watch.advance)?,
    })
}

fn map(side: usize, watch: &Watch) -> Map {
    (watch.begin)("proving the stability map".to_owned(), Some(side * side));
    Map::new(side, [-3.0, 3.0], Depth::default(), watch.advance)
}
