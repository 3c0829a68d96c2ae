//! Where each filter stands: its errors beside those of the most accurate one, whether it is as accurate as it says, and what it costs.
//!
//! Runs are independent of each other, steps within a run are not: every standard error comes from one number a run.

use super::Contest;
use super::contenders::{Absentee, Entrants};
use super::group::{ErrorGroup, GroupName, group_name};
use super::race::FilterRun;
use crate::paper::verdict::DECISIVE;
use crate::statistics::Estimate;
use crate::statistics::consistency::bounds;
use crate::statistics::estimate::{
    MedianRatio, mean, median_ratio, paired_difference, paired_log_ratio, quantile, root_mean_square,
};
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// With this probability a matched filter is found inconsistent, by NEES in any step; and again by NIS.
pub const FALSE_ALARM: f64 = 0.01;

/// A filter has diverged when the NEES of its last step is beyond what a matched one exceeds with this probability.
pub const DIVERGED: f64 = 1e-9;

/// Errors are compared over runs in which no compared filter fails: this part of all runs at least. Filters that fail most are left out.
pub const COMMON_RUNS: f64 = 0.9;

/// Errors that differ by less than this part are equal: the unscented rule of α = 10⁻³ has weights of 10⁶, and rounding to match.
pub const ROUNDING: f64 = 1e-7;

/// The comparison of a problem's filters.
#[derive(Debug, Clone, Serialize)]
pub struct FilterComparison {
    /// The problem.
    pub id: String,
    /// The seed.
    pub seed: u64,
    /// The number of runs.
    pub runs: usize,
    /// The steps of each.
    pub steps: usize,
    /// The steps of each that have a measurement.
    pub detections: usize,
    /// The names of the modes.
    pub modes: Vec<String>,
    /// The components whose errors are summed, by name, with their unit.
    pub groups: Vec<GroupName>,
    /// The names and units of the components of the state.
    pub components: Vec<GroupName>,
    /// The probability with which a matched filter is found inconsistent.
    pub false_alarm: f64,
    /// The kinds of filter; and the interactions where there are several modes.
    pub tables: Vec<StandingTable>,
    /// The filters that do not apply, and why.
    pub absent: Vec<Absentee>,
}

/// What differs between the filters of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Differs {
    /// The kind of filter.
    Filter,
    /// The interaction.
    Interaction,
}

/// Filters that differ in one thing.
#[derive(Debug, Clone, Serialize)]
pub struct StandingTable {
    /// What differs.
    pub differs: Differs,
    /// What is the same: the file's interaction, or its filter; none with one mode.
    pub same: Option<String>,
    /// The number of runs over which errors are compared.
    pub common_runs: usize,
    /// A difference of at least this many standard errors counts: a false alarm as rare as beyond [`DECISIVE`] of a Gaussian figure, by
    /// Student's law, for the standard error is one of few runs.
    pub decisive: f64,
    /// The filters, the most accurate first.
    pub standings: Vec<Standing>,
}

/// Where a filter stands.
#[derive(Debug, Clone, Serialize)]
pub struct Standing {
    /// Its name.
    pub name: String,
    /// Whether it is the file's own.
    pub is_own: bool,
    /// The mean logarithm of its errors over those of the most accurate filter, all groups together; none where it fails too often.
    pub log_ratio: Option<Estimate>,
    /// Its errors by group.
    pub groups: Vec<GroupError>,
    /// The root mean square error of each component.
    pub components: Vec<f64>,
    /// Errors in units of its own covariance, by step.
    pub nees: Option<SquareTest>,
    /// Innovations in units of its own covariance.
    pub nis: Option<SquareTest>,
    /// The runs in which a step could not be computed.
    pub failed: usize,
    /// The first reason.
    pub failure: Option<String>,
    /// The runs at whose end the NEES is out of all reason; none without covariances.
    pub diverged: Option<usize>,
    /// The operations of a step.
    pub operations: Option<f64>,
    /// Its time over that of the file's own filter, run by run.
    pub time: Option<TimeRatio>,
}

/// The errors of a filter in a group of components.
#[derive(Debug, Clone, Serialize)]
pub struct GroupError {
    /// The root mean square over runs and steps.
    pub error: Estimate,
    /// How much more that is than the most accurate filter has.
    pub difference: Estimate,
    /// The root mean square over the runs at each step.
    pub over_steps: Vec<Estimate>,
}

/// A mean of normalised squared errors, and the bounds in which that of a matched filter lies.
#[derive(Debug, Clone, Serialize)]
pub struct SquareTest {
    /// The mean over runs and steps.
    pub mean: Estimate,
    /// Its expectation.
    pub expected: f64,
    /// The bounds: of NEES for the mean over the runs at one step, of NIS for the mean over runs and steps.
    pub bounds: (f64, f64),
    /// The mean over the runs at each step; empty for NIS.
    pub over_steps: Vec<f64>,
    /// The steps above the upper bound.
    pub above: usize,
    /// The steps below the lower bound.
    pub below: usize,
    /// What follows.
    pub calibration: Calibration,
}

/// Whether a filter is as accurate as its covariance says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Calibration {
    /// It is.
    Consistent,
    /// Its errors are larger.
    OverConfident,
    /// Its errors are smaller.
    TooCareful,
    /// They are larger at some steps and smaller at others.
    Both,
}

/// A ratio of times: it scatters with the load of the machine.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TimeRatio {
    /// Over the runs.
    #[serde(flatten)]
    pub ratio: MedianRatio,
    /// The median time of a step, µs.
    pub microseconds: f64,
}

/// All tables of a contest.
pub(super) fn compare(contest: &Contest, groups: &[ErrorGroup], outcomes: &[Vec<FilterRun>]) -> FilterComparison {
    let (entrants, first) = (&contest.entrants, &contest.runs[0]);
    let problem = &entrants.contenders[0].problem;
    let detections = first.measurements.iter().flatten();
    let scores = Scores {
        contest,
        groups: groups.len(),
        outcomes,
        measured: detections.clone().map(Vec::len).sum(),
        detections: detections.count(),
    };
    let mut tables = vec![scores.table(
        Differs::Filter,
        &entrants.kinds,
        entrants.interaction.map(str::to_owned),
    )];
    if entrants.interaction.is_some() {
        tables.push(scores.table(
            Differs::Interaction,
            &entrants.interactions,
            Some(entrants.filter.clone()),
        ));
    }
    let single = |entry| group_name(problem, &ErrorGroup { entries: vec![entry] });
    FilterComparison {
        id: problem.id.clone(),
        seed: contest.seed,
        runs: outcomes.len(),
        steps: first.states.len(),
        detections: scores.detections,
        modes: problem.modes.iter().map(|mode| mode.name.clone()).collect(),
        groups: groups.iter().map(|group| group_name(problem, group)).collect(),
        components: (0..problem.state.len()).map(single).collect(),
        false_alarm: FALSE_ALARM,
        tables,
        absent: entrants.absent.clone(),
    }
}

/// The outcomes of a contest.
struct Scores<'a> {
    contest: &'a Contest,
    groups: usize,
    outcomes: &'a [Vec<FilterRun>],
    /// The measured numbers of a run, and the steps in which they are measured.
    measured: usize,
    detections: usize,
}

/// The mean square of each run, by group.
type MeanSquares = Vec<Vec<f64>>;

impl Scores<'_> {
    /// The filters of a table in their order.
    fn table(&self, differs: Differs, filters: &[usize], same: Option<String>) -> StandingTable {
        let (compared, common) = self.common_runs(filters);
        let squares: Vec<(usize, MeanSquares)> = compared
            .iter()
            .map(|&filter| (filter, self.mean_squares(filter, &common)))
            .collect();
        let counted = counted_groups(self.groups, &squares);
        let of_counted =
            |squares: &MeanSquares| counted.iter().map(|&group| squares[group].clone()).collect::<Vec<_>>();
        let mut order: Vec<(f64, usize, MeanSquares)> = squares
            .into_iter()
            .map(|(filter, squares)| (0.0, filter, squares))
            .collect();
        if let Some(reference) = order.first().map(|(_, _, squares)| of_counted(squares)) {
            for (ratio, _, squares) in &mut order {
                // Equal but for rounding: the order in which they are listed stays.
                let value = paired_log_ratio(&of_counted(squares), &reference).value;
                *ratio = if value.abs() < ROUNDING { 0.0 } else { value };
            }
        }
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut standings = Vec::with_capacity(filters.len());
        for (_, filter, squares) in &order {
            let best = &order[0].2;
            let ratio = paired_log_ratio(&of_counted(squares), &of_counted(best));
            let mut standing = self.unranked(differs, *filter);
            standing.log_ratio = Some(ratio);
            standing.groups = (0..self.groups)
                .map(|group| GroupError {
                    error: root_mean_square(&squares[group]),
                    difference: paired_difference(&squares[group], &best[group]),
                    over_steps: self.over_steps(*filter, &common, |outcome, k| outcome.squares[k][group]),
                })
                .collect();
            standing.components = self.components(*filter, &common);
            standing.nees = self.nees(*filter, &common);
            standing.nis = self.nis(*filter, &common);
            standings.push(standing);
        }
        let left_out = filters.iter().filter(|filter| !compared.contains(filter));
        standings.extend(left_out.map(|filter| self.unranked(differs, *filter)));
        StandingTable {
            differs,
            same,
            common_runs: common.len(),
            decisive: decisive(common.len()),
            standings,
        }
    }

    /// The filters whose errors are compared, and the runs in which none of them fails.
    fn common_runs(&self, filters: &[usize]) -> (Vec<usize>, Vec<usize>) {
        let mut compared = filters.to_vec();
        loop {
            let succeeds = |run: &usize| {
                compared
                    .iter()
                    .all(|&filter| self.outcomes[*run][filter].failure.is_none())
            };
            let common: Vec<usize> = (0..self.outcomes.len()).filter(succeeds).collect();
            let worst = compared
                .iter()
                .copied()
                .max_by_key(|&filter| (self.failed(filter), filter));
            match worst {
                Some(worst) if (common.len() as f64) < COMMON_RUNS * self.outcomes.len() as f64 => {
                    compared.retain(|&filter| filter != worst);
                }
                _ => return (compared, common),
            }
        }
    }

    fn failed(&self, filter: usize) -> usize {
        self.outcomes.iter().filter(|run| run[filter].failure.is_some()).count()
    }

    /// The mean square over the steps of each of some runs, by group.
    fn mean_squares(&self, filter: usize, runs: &[usize]) -> MeanSquares {
        let of = |group: usize, run: usize| {
            let squares = &self.outcomes[run][filter].squares;
            squares.iter().map(|step| step[group]).sum::<f64>() / squares.len() as f64
        };
        (0..self.groups)
            .map(|group| runs.iter().map(|&run| of(group, run)).collect())
            .collect()
    }

    fn over_steps(&self, filter: usize, runs: &[usize], square: impl Fn(&FilterRun, usize) -> f64) -> Vec<Estimate> {
        let steps = self.contest.runs[0].states.len();
        let at = |k: usize| {
            let squares: Vec<f64> = runs.iter().map(|&run| square(&self.outcomes[run][filter], k)).collect();
            root_mean_square(&squares)
        };
        (0..steps).map(at).collect()
    }

    fn components(&self, filter: usize, runs: &[usize]) -> Vec<f64> {
        let of = |entry: usize| {
            let squares: Vec<f64> = runs
                .iter()
                .map(|&run| self.outcomes[run][filter].components[entry])
                .collect();
            root_mean_square(&squares).value
        };
        (0..self.outcomes[0][filter].components.len()).map(of).collect()
    }

    /// The NEES of each step over the runs, with bounds that a matched filter leaves in no step but for the false alarm.
    fn nees(&self, filter: usize, runs: &[usize]) -> Option<SquareTest> {
        let n = self.outcomes[0][filter].components.len() as f64;
        let steps = self.contest.runs[0].states.len();
        let of_step =
            |k: usize| runs.iter().map(|&run| self.outcomes[run][filter].nees[k]).sum::<f64>() / runs.len() as f64;
        let over_steps: Vec<f64> = (0..steps).map(of_step).collect();
        let of_run = |&run: &usize| self.outcomes[run][filter].nees.iter().sum::<f64>() / steps as f64;
        let mean = mean(&runs.iter().map(of_run).collect::<Vec<f64>>());
        if !mean.value.is_finite() {
            return None;
        }
        let (low, high) = bounds(n, runs.len(), FALSE_ALARM / steps as f64);
        let above = over_steps.iter().filter(|nees| **nees > high).count();
        let below = over_steps.iter().filter(|nees| **nees < low).count();
        let calibration = Calibration::of(above > 0, below > 0);
        Some(SquareTest {
            mean,
            expected: n,
            bounds: (low, high),
            over_steps,
            above,
            below,
            calibration,
        })
    }

    /// The NIS of all steps and runs: innovations of a matched filter are independent from step to step.
    fn nis(&self, filter: usize, runs: &[usize]) -> Option<SquareTest> {
        let is_there = |&run: &usize| self.outcomes[run][filter].nis.len() == self.detections;
        if self.detections == 0 || !runs.iter().all(is_there) {
            return None;
        }
        let of_run = |&run: &usize| self.outcomes[run][filter].nis.iter().sum::<f64>() / self.detections as f64;
        let mean = mean(&runs.iter().map(of_run).collect::<Vec<f64>>());
        let expected = self.measured as f64 / self.detections as f64;
        let bounds = bounds(expected, self.detections * runs.len(), FALSE_ALARM);
        let calibration = Calibration::of(mean.value > bounds.1, mean.value < bounds.0);
        mean.value.is_finite().then(|| SquareTest {
            mean,
            expected,
            bounds,
            over_steps: Vec::new(),
            above: 0,
            below: 0,
            calibration,
        })
    }

    /// What is known of a filter without its errors.
    fn unranked(&self, differs: Differs, filter: usize) -> Standing {
        let entrants: &Entrants = &self.contest.entrants;
        let all = || self.outcomes.iter().map(|run| &run[filter]);
        let n = all().next().map_or(0, |outcome| outcome.components.len());
        let (_, limit) = bounds(n.max(1) as f64, 1, 2.0 * DIVERGED);
        let complete = || all().filter(|outcome| outcome.failure.is_none());
        let last = |outcome: &FilterRun| outcome.nees.last().copied().unwrap_or(f64::NAN);
        let has_nees = complete().any(|outcome| last(outcome).is_finite());
        Standing {
            name: match (differs, filter, entrants.interaction) {
                (Differs::Interaction, 0, Some(interaction)) => interaction.to_owned(),
                _ => entrants.contenders[filter].name.clone(),
            },
            is_own: filter == 0,
            log_ratio: None,
            groups: Vec::new(),
            components: Vec::new(),
            nees: None,
            nis: None,
            failed: self.failed(filter),
            failure: all().find_map(|outcome| outcome.failure.clone()),
            diverged: has_nees.then(|| complete().filter(|outcome| last(outcome) > limit).count()),
            operations: self.contest.operations[filter],
            time: self.time(filter),
        }
    }

    /// The time of a step beside that of the file's own filter, over the runs that both complete.
    fn time(&self, filter: usize) -> Option<TimeRatio> {
        let complete = self
            .outcomes
            .iter()
            .filter(|run| run[filter].failure.is_none() && run[0].failure.is_none());
        let times = complete.map(|run| (run[filter].time, run[0].time));
        let (mut own, of_file): (Vec<f64>, Vec<f64>) = times.unzip();
        Some(TimeRatio {
            ratio: median_ratio(&own, &of_file)?,
            microseconds: 1e6 * quantile(&mut own, 0.5)?,
        })
    }
}

impl Calibration {
    fn of(is_above: bool, is_below: bool) -> Self {
        match (is_above, is_below) {
            (false, false) => Self::Consistent,
            (true, false) => Self::OverConfident,
            (false, true) => Self::TooCareful,
            (true, true) => Self::Both,
        }
    }
}

/// How many standard errors of a mean over some runs are as rare as [`DECISIVE`] of a Gaussian figure.
///
/// Source: Student 1908: with a standard error of M runs the distance follows the t distribution of M − 1 degrees of freedom.
///
/// Example: two runs tell nearly nothing.
///
/// ```
/// use immaculate::compare::standing::decisive;
///
/// assert!(decisive(2) > 1e4);
/// assert!((4.0..4.01).contains(&decisive(10_000)));
/// ```
pub fn decisive(runs: usize) -> f64 {
    let beyond = Normal::standard().cdf(-DECISIVE);
    let student = StudentsT::new(0.0, 1.0, runs.saturating_sub(1) as f64);
    student.map_or(f64::INFINITY, |student| -student.inverse_cdf(beyond))
}

/// The groups that have an error in every filter; what a filter knows exactly has no ratio.
fn counted_groups(groups: usize, squares: &[(usize, MeanSquares)]) -> Vec<usize> {
    let has_error = |group: &usize| {
        let sums = squares.iter().map(|(_, squares)| squares[*group].iter().sum::<f64>());
        sums.into_iter().all(|sum| sum > 0.0 && sum.is_finite())
    };
    (0..groups).filter(has_error).collect()
}
