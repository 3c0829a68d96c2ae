//! The comparison of a problem's filters as text: the verdict first, then errors, consistency and cost.

use super::{broken, never_broken, table, wrapped};
use crate::compare::NotCompared;
use crate::compare::group::GroupName;
use crate::compare::standing::{Calibration, Differs, FilterComparison, ROUNDING, SquareTest, Standing, StandingTable};
use crate::number::Real;
use crate::statistics::estimate::figure;
use std::fmt::Write;

/// The whole comparison. The columns of times scatter; everything else depends on the seed alone.
pub fn text(comparison: &FilterComparison) -> String {
    let mut text = wrapped(&simulated(comparison), "");
    text.push_str("\nVERDICT\n");
    for table in &comparison.tables {
        text.push_str(&wrapped(&verdict(table), "  "));
    }
    for table in &comparison.tables {
        text.push_str(&errors(comparison, table));
        text.push_str(&consistency_and_cost(table));
    }
    text.push_str(&absent(comparison));
    text.push_str(&legend(comparison));
    text
}

/// What is simulated, in a sentence.
pub fn simulated(comparison: &FilterComparison) -> String {
    let FilterComparison {
        id,
        runs,
        steps,
        detections,
        seed,
        ..
    } = comparison;
    let modes = match &comparison.modes[..] {
        [_] => "one mode".to_owned(),
        modes => format!("{} modes, whose changes follow its chain", modes.len()),
    };
    let missed = match steps - detections {
        0 => String::new(),
        missed => format!(" ({missed} of them without a measurement)"),
    };
    format!(
        "Simulated: {runs} runs of {steps} steps{missed}, drawn from the model of `{id}` ({modes}), seed {seed}; in each run, all filters see the \
         same measurements."
    )
}

/// The answer in a few sentences.
pub fn verdict(table: &StandingTable) -> String {
    let what = match table.differs {
        Differs::Filter => "filter",
        Differs::Interaction => "interaction",
    };
    let ranked: Vec<&Standing> = table.standings.iter().filter(|one| one.log_ratio.is_some()).collect();
    let Some((best, others)) = ranked.split_first() else {
        return format!("No {what} computes nine runs of ten to their end.");
    };
    if table.standings.len() == 1 {
        let cost = best.operations.map_or(String::new(), |count| {
            format!("; it takes {count:.0} operations a step")
        });
        return format!("No other {what} than {} applies{cost}.", best.name);
    }
    let is_decisive = |one: &Standing| is_decisive(one, table.decisive);
    let equal = names_of(others, is_rounding);
    let close = names_of(others, |one| !is_rounding(one) && !is_decisive(one));
    let mut text = format!("The most accurate {what} is {}", best.name);
    if !equal.is_empty() {
        let _ = write!(text, ", equal but for rounding to {}", listed(&equal));
    }
    if !close.is_empty() {
        let _ = write!(text, "; not distinguishable from it: {}", listed(&close));
    }
    if let Some(next) = others.iter().find(|one| is_decisive(one)) {
        let distance = next.log_ratio.map_or(0.0, |ratio| ratio.distance_from(0.0));
        let (name, ratio) = (&next.name, per_cent(next));
        let _ = write!(
            text,
            ". Next is {name}, with {ratio} more error, which is {distance:.0} standard errors"
        );
    } else if !others.is_empty() {
        text.push_str("; no difference is larger than chance explains");
    }
    text.push_str(". ");
    text.push_str(&consistent(&ranked));
    text.push_str(&cost(best, &ranked, table.decisive));
    text
}

/// Which filters are as accurate as they say.
fn consistent(ranked: &[&Standing]) -> String {
    if ranked.iter().all(|one| one.nees.is_none()) {
        return String::new();
    }
    let is_consistent = |one: &Standing| {
        let test = one.nees.as_ref();
        test.is_some_and(|test| test.calibration == Calibration::Consistent)
    };
    let names = names_of(ranked, is_consistent);
    match names[..] {
        [] => nearest(ranked),
        _ if names.len() == ranked.len() => "By NEES, all are as accurate as their covariances say. ".to_owned(),
        [one] => format!("By NEES, only {one} is as accurate as its covariance says. "),
        _ => format!(
            "By NEES, these are as accurate as their covariances say: {}. ",
            listed(&names)
        ),
    }
}

/// Of filters that are not as accurate as they say, the one that is nearest.
fn nearest(ranked: &[&Standing]) -> String {
    let tests = ranked
        .iter()
        .filter_map(|one| Some((one.name.as_str(), one.nees.as_ref()?)));
    let distance = |test: &SquareTest| Real::ln(&(test.mean.value / test.expected)).abs();
    let nearest = tests.min_by(|(_, a), (_, b)| distance(a).total_cmp(&distance(b)));
    let Some((name, test)) = nearest else {
        return String::new();
    };
    let (found, expected) = (figure(test.mean.value), test.expected);
    format!(
        "By NEES, none is quite as accurate as its covariance says; nearest is {name}, with {found} where {expected} is expected. "
    )
}

/// What the most accurate filter costs, beside the cheapest that is as good and the cheapest of all.
fn cost(best: &Standing, ranked: &[&Standing], decisive: f64) -> String {
    let cheapest = |is_asked: &dyn Fn(&Standing) -> bool| {
        let asked = ranked.iter().filter(|one| is_asked(one) && one.operations.is_some());
        let costs = |one: &Standing| one.operations.unwrap_or(f64::INFINITY);
        asked.min_by(|a, b| costs(a).total_cmp(&costs(b))).copied()
    };
    let as_good = cheapest(&|one| !is_decisive(one, decisive));
    let (Some(as_good), Some(least)) = (as_good, cheapest(&|_| true)) else {
        return String::new();
    };
    let count = |one: &Standing| {
        one.operations
            .map_or_else(|| "—".to_owned(), |count| format!("{count:.0}"))
    };
    let mut text = format!("{} takes {} operations a step", best.name, count(best));
    if as_good.name == best.name && least.name == best.name {
        text.push_str(", the fewest of all");
    }
    if as_good.name != best.name {
        let relation = if is_rounding(as_good) {
            "equal to it"
        } else {
            "not distinguishable from it"
        };
        let _ = write!(text, "; {}, {relation}, takes {}", as_good.name, count(as_good));
    }
    if least.name != as_good.name {
        let (name, ratio) = (&least.name, per_cent(least));
        let _ = write!(
            text,
            "; the cheapest, {name}, takes {} and has {ratio} more error",
            count(least)
        );
    }
    text.push('.');
    text
}

fn names_of<'a>(standings: &[&'a Standing], is_so: impl Fn(&Standing) -> bool) -> Vec<&'a str> {
    standings
        .iter()
        .filter(|one| is_so(one))
        .map(|one| one.name.as_str())
        .collect()
}

/// `a`, `a and b`, `a, b and c`.
fn listed(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// Whether the errors are equal to those of the most accurate filter but for rounding.
fn is_rounding(one: &Standing) -> bool {
    one.log_ratio.is_some_and(|ratio| ratio.value.abs() < ROUNDING)
}

/// Whether the errors differ from those of the most accurate filter by more than chance.
fn is_decisive(one: &Standing, standard_errors: f64) -> bool {
    let distance = one.log_ratio.map_or(0.0, |ratio| ratio.distance_from(0.0));
    !is_rounding(one) && distance >= standard_errors
}

/// How much more error a filter has than the most accurate one, as exactly as it is known.
fn per_cent(one: &Standing) -> String {
    let Some(ratio) = one.log_ratio else {
        return "—".to_owned();
    };
    let factor = Real::exp(&ratio.value);
    let (value, error) = (100.0 * (factor - 1.0), 100.0 * factor * ratio.standard_error);
    let places = decimals(error).min(4);
    format!("{value:.places$} ± {error:.places$} %")
}

/// The names of a group with its unit.
pub(super) fn group_title(group: &GroupName) -> String {
    let names = group.names.join(", ");
    if group.unit.is_empty() {
        names
    } else {
        format!("{names} ({})", group.unit)
    }
}

fn heading(table: &StandingTable) -> String {
    match (table.differs, &table.same) {
        (Differs::Filter, Some(same)) => format!("FILTERS, with the file's interaction, {same}"),
        (Differs::Filter, None) => "FILTERS".to_owned(),
        (Differs::Interaction, same) => {
            format!(
                "INTERACTIONS, with the file's filter, {}",
                same.as_deref().unwrap_or_default()
            )
        }
    }
}

fn name_of(one: &Standing) -> String {
    if one.is_own {
        format!("{} *", one.name)
    } else {
        one.name.clone()
    }
}

/// Root mean square errors, all groups together and each by itself.
fn errors(comparison: &FilterComparison, of: &StandingTable) -> String {
    let groups: Vec<String> = comparison.groups.iter().map(group_title).collect();
    let mut header = vec!["RMSE", "above the best"];
    header.extend(groups.iter().map(String::as_str));
    let mut errors = table(&header);
    for (rank, one) in of.standings.iter().enumerate() {
        let mut row = vec![name_of(one)];
        row.push(match one.log_ratio {
            None => "not compared".to_owned(),
            Some(_) if rank == 0 => "best".to_owned(),
            Some(_) if is_rounding(one) => "equal".to_owned(),
            Some(_) => per_cent(one),
        });
        for group in &one.groups {
            row.push(if rank == 0 {
                format!(
                    "{} ± {}",
                    figure(group.error.value),
                    two_digits(group.error.standard_error)
                )
            } else {
                figure(group.error.value)
            });
        }
        row.resize(header.len(), String::new());
        errors.add_row(row);
    }
    never_broken(&mut errors, 0);
    let mut text = format!("\n{}\n{errors}\n", heading(of));
    if of.common_runs < comparison.runs {
        let sentence = format!(
            "Errors are compared over the {} of {} runs that all compared filters finish.",
            of.common_runs, comparison.runs
        );
        text.push_str(&wrapped(&sentence, ""));
    }
    if comparison.components.len() > comparison.groups.len() {
        text.push_str(&components(comparison, of));
    }
    text
}

/// Root mean square errors of single components.
fn components(comparison: &FilterComparison, of: &StandingTable) -> String {
    let names: Vec<String> = comparison.components.iter().map(group_title).collect();
    let mut header = vec!["by component"];
    header.extend(names.iter().map(String::as_str));
    let mut errors = table(&header);
    for one in of.standings.iter().filter(|one| one.log_ratio.is_some()) {
        let mut row = vec![name_of(one)];
        row.extend(one.components.iter().map(|error| figure(*error)));
        errors.add_row(row);
    }
    never_broken(&mut errors, 0);
    format!("\n{errors}\n")
}

/// NEES, NIS, divergence, operations, times; and which filters fail.
fn consistency_and_cost(of: &StandingTable) -> String {
    let mut rows = table(&[
        "consistency, cost",
        "NEES",
        "outside",
        "NIS",
        "diverged",
        "operations",
        "time",
    ]);
    let dash = || "—".to_owned();
    for one in &of.standings {
        let outside = |test: &SquareTest| match test.above + test.below {
            0 => "none".to_owned(),
            steps => format!("{steps} of {}", test.over_steps.len()),
        };
        let nis = |test: &SquareTest| {
            let mark = if test.calibration == Calibration::Consistent {
                ""
            } else {
                " !"
            };
            format!("{}{mark}", figure(test.mean.value))
        };
        rows.add_row([
            name_of(one),
            one.nees.as_ref().map_or_else(dash, |test| figure(test.mean.value)),
            one.nees.as_ref().map_or_else(dash, outside),
            one.nis.as_ref().map_or_else(dash, nis),
            one.diverged.map_or_else(dash, |count| count.to_string()),
            one.operations.map_or_else(dash, |count| format!("{count:.0}")),
            one.time.map_or_else(dash, |time| time.ratio.to_string()),
        ]);
    }
    never_broken(&mut rows, 0);
    let mut text = format!("\n{rows}\n");
    text.push_str(&wrapped(&expected(of), ""));
    if of.standings.iter().all(|one| one.failed == 0) {
        text.push_str("Every filter computes every step of every run.\n");
    }
    for one in of.standings.iter().filter(|one| one.failed > 0) {
        let runs = if one.failed == 1 {
            "1 run".to_owned()
        } else {
            format!("{} runs", one.failed)
        };
        let reason = one.failure.as_deref().unwrap_or_default();
        text.push_str(&wrapped(
            &format!("{} fails in {runs}, the first time in {reason}", one.name),
            "",
        ));
    }
    text
}

/// What a filter that is right has in the columns of squares.
fn expected(of: &StandingTable) -> String {
    let find = |of_one: fn(&Standing) -> Option<&SquareTest>| of.standings.iter().find_map(of_one);
    let bounds = |test: &SquareTest| format!("{:.3} to {:.3}", test.bounds.0, test.bounds.1);
    let mut parts = Vec::new();
    if let Some(test) = find(|one| one.nees.as_ref()) {
        parts.push(format!("NEES {}, at one step {}", test.expected, bounds(test)));
    }
    if let Some(test) = find(|one| one.nis.as_ref()) {
        parts.push(format!("NIS {}, {}", figure(test.expected), bounds(test)));
    }
    if parts.is_empty() {
        String::new()
    } else {
        format!("Expected: {}.", parts.join("; "))
    }
}

/// A standard error with two digits.
fn two_digits(value: f64) -> String {
    let places = decimals(value);
    format!("{value:.places$}")
}

/// The number of decimals with which a standard error has two digits; nine at most.
fn decimals(value: f64) -> usize {
    if !value.is_finite() || value == 0.0 {
        return 0;
    }
    let scientific = format!("{value:.1e}");
    let exponent = scientific
        .split_once('e')
        .and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    usize::try_from((1 - exponent.unwrap_or(0)).clamp(0, 9)).unwrap_or(0)
}

/// The filters that do not apply, with those of one reason together.
fn absent(comparison: &FilterComparison) -> String {
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for one in &comparison.absent {
        match reasons.iter_mut().find(|(reason, _)| *reason == one.reason) {
            Some((_, names)) => names.push(&one.name),
            None => reasons.push((&one.reason, vec![&one.name])),
        }
    }
    if reasons.is_empty() {
        return String::new();
    }
    let mut text = "\nNOT COMPARED\n".to_owned();
    for (reason, names) in reasons {
        text.push_str(&wrapped(&format!("{}: {reason}", listed(&names)), "  "));
    }
    text
}

/// How the tables are read.
fn legend(comparison: &FilterComparison) -> String {
    let alarm = comparison.false_alarm * 100.0;
    let decisive = comparison.tables.iter().map(|table| table.decisive).fold(0.0, f64::max);
    let mut lines = vec![
        "*: as in the file. ±: one standard error. `above the best`: how much more error than the first filter, as the geometric mean over \
         the columns; filters are paired run by run. unscented: α/β/κ."
            .to_owned(),
        format!(
            "A difference counts from {decisive:.1} standard errors on, which chance alone reaches once in 16 000 comparisons."
        ),
        format!(
            "outside: the steps at which the mean NEES of the runs is outside its bounds; a linear filter with the true model has any such \
             step with a probability of {alarm} % at most. NIS: the mean over runs and steps, ! if outside its bounds, with the same \
             probability. diverged: runs whose last NEES such a filter exceeds with a probability of 1e-9."
        ),
        "operations: of a step, without additions of 0 and multiplications by 0 or 1. time: of a step, over that of the file's filter; median \
         over the runs ± half the distance of the quartiles. It is that of this program's filter for any size."
            .to_owned(),
    ];
    if comparison.tables.len() > 1 {
        lines.push(
            "The bounds are those of one linear mode. The errors of a mixture are not Gaussian, so with several modes they are a guide."
                .to_owned(),
        );
    }
    let mut text = "\n".to_owned();
    for line in lines {
        for part in broken(&line, usize::from(super::WIDTH)) {
            text.push_str(&part);
            text.push('\n');
        }
    }
    text
}

/// Why there is no comparison, with the name of the file.
pub fn refusal(file: &str, reason: &NotCompared) -> String {
    format!("{file}: {reason}")
}
