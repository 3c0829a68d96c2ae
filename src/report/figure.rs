//! The papers' figures of averages: errors and mode probabilities over time, as SVG.
//!
//! A figure shows when the target turns (shaded), how the errors rise, how fast the mode probabilities follow, and how far a curve would
//! move if the runs were drawn again: the band is two standard errors wide on either side. Lines within a pixel of each other are
//! mentioned.

use super::chart::{
    Area, Axis, Caption, Drawn, Key, Line, Look, NotDrawn, draw_lines, figure, looks, panel, stretches,
};
use crate::paper::Paper;
use crate::paper::comparison::ErrorQuantity;
use crate::paper::result::{Performance, Reproduction};
use crate::statistics::estimate::figure as digits;
use std::fmt::Write;

const PANEL_HEIGHT: u32 = 300;
/// The height of what is inside a panel's axes, about.
const PIXELS: f64 = 210.0;
/// The band, in standard errors.
const BAND: f64 = 2.0;

/// A value at each step with its standard error.
type History<'a> = (Vec<f64>, Vec<f64>);

/// What one panel shows.
struct Panel {
    title: String,
    label: &'static str,
    highest: f64,
    /// The history of each filter; none for a filter that has no such value.
    histories: Vec<Option<History<'static>>>,
    /// Whether the truth is what the panel is about, step by step: these times are shaded.
    shaded: Vec<bool>,
}

/// RMSE of position and of velocity over time, the turns shaded.
///
/// # Errors
///
/// [`NotDrawn`] when the figure cannot be drawn.
pub fn errors(reproduction: &Reproduction) -> Result<String, NotDrawn> {
    let panels =
        [ErrorQuantity::Position, ErrorQuantity::Velocity].map(|quantity| panel_of_errors(reproduction, quantity));
    let mut says = format!(
        "Root mean square errors over time of {} filters. Overall:",
        reproduction.filters.len()
    );
    for filter in &reproduction.filters {
        let error = |quantity| {
            reproduction
                .error(&filter.name, quantity)
                .map_or(f64::NAN, |error| error.value)
        };
        let (position, velocity) = (error(ErrorQuantity::Position), error(ErrorQuantity::Velocity));
        let _ = write!(
            says,
            " {} {} m and {} m/s;",
            filter.name,
            digits(position),
            digits(velocity)
        );
    }
    let caption = Caption {
        name: format!("{}-errors", stem(reproduction)),
        title: format!("{}: root mean square errors", title(reproduction)),
        note: note(
            reproduction,
            &panels,
            &format!("Shaded: {}.", what_is_shaded(reproduction)),
        ),
        says,
        has_cells: false,
    };
    draw(reproduction, &caption, &panels)
}

fn panel_of_errors(reproduction: &Reproduction, quantity: ErrorQuantity) -> Panel {
    let history = |filter: &Performance| {
        let history = filter.rmse.iter().find(|history| history.quantity == quantity)?;
        Some((history.values.clone(), history.standard_errors.clone()))
    };
    let histories: Vec<_> = reproduction.filters.iter().map(history).collect();
    let highest = histories.iter().flatten().flat_map(|(values, errors)| {
        let edges = values.iter().zip(errors).map(|(value, error)| value + BAND * error);
        edges.filter(|edge| edge.is_finite())
    });
    let highest = 1.05 * highest.fold(0.0, f64::max);
    Panel {
        title: String::new(),
        label: match quantity {
            ErrorQuantity::Position => "RMSE of position (m)",
            _ => "RMSE of velocity (m/s)",
        },
        highest: if highest > 0.0 { highest } else { 1.0 },
        histories,
        shaded: turning(reproduction),
    }
}

/// Mean mode probabilities over time, one panel per mode, shaded while it is the true one.
///
/// # Errors
///
/// [`NotDrawn`] when the figure cannot be drawn.
pub fn mode_probabilities(reproduction: &Reproduction) -> Result<String, NotDrawn> {
    let mut modes: Vec<&String> = Vec::new();
    let mut says =
        String::from("Mean probability of each mode over time. Averaged over the steps at which a mode is true:");
    for filter in reproduction.filters.iter().filter(|filter| filter.modes.len() > 1) {
        let new: Vec<_> = filter.modes.iter().filter(|mode| !modes.contains(mode)).collect();
        modes.extend(new);
        let _ = write!(says, " {} {:.2};", filter.name, of_true_modes(reproduction, filter));
    }
    let panels: Vec<Panel> = modes
        .into_iter()
        .map(|mode| panel_of_mode(reproduction, mode))
        .collect();
    let caption = Caption {
        name: format!("{}-mode-probabilities", stem(reproduction)),
        title: format!("{}: mode probabilities", title(reproduction)),
        note: note(reproduction, &panels, "Shaded: the mode is the true one."),
        says,
        has_cells: false,
    };
    draw(reproduction, &caption, &panels)
}

fn panel_of_mode(reproduction: &Reproduction, mode: &str) -> Panel {
    let history = |filter: &Performance| {
        let several = filter.modes.len() > 1;
        let j = filter.modes.iter().position(|name| name == mode).filter(|_| several)?;
        let of_mode = |steps: &[Vec<f64>]| steps.iter().map(|step| step[j]).collect();
        Some((
            of_mode(&filter.mode_probabilities),
            of_mode(&filter.mode_probability_standard_errors),
        ))
    };
    Panel {
        title: mode.to_owned(),
        label: "mean probability",
        highest: 1.0,
        histories: reproduction.filters.iter().map(history).collect(),
        shaded: (0..reproduction.steps).map(|k| reproduction.is_true(mode, k)).collect(),
    }
}

/// The mean probability of a filter's modes over the steps at which they are true.
fn of_true_modes(reproduction: &Reproduction, filter: &Performance) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    for (k, probabilities) in filter.mode_probabilities.iter().enumerate() {
        for (_, probability) in filter
            .modes
            .iter()
            .zip(probabilities)
            .filter(|(mode, _)| reproduction.is_true(mode, k))
        {
            sum += probability;
            count += 1;
        }
    }
    sum / f64::from(count)
}

/// What the names of a reproduction's files begin with: the paper, and the scenario where another than its first is shown.
pub fn stem(reproduction: &Reproduction) -> String {
    match reproduction.choices.chosen("scenario") {
        Some(scenario) => format!("{}-{scenario}", reproduction.paper),
        None => reproduction.paper.to_owned(),
    }
}

/// The paper and, where it has several, the scenario.
pub(super) fn title(reproduction: &Reproduction) -> String {
    let paper = reproduction.paper.parse::<Paper>().ok();
    let scenario = paper.and_then(|paper| paper.specification().chosen(&reproduction.choices, "scenario").ok());
    match scenario {
        Some(scenario) => format!("{}, {}", reproduction.paper, scenario.replace('-', " ")),
        None => reproduction.paper.to_owned(),
    }
}

/// Whether the target does anything but move at a constant velocity, step by step.
pub(super) fn turning(reproduction: &Reproduction) -> Vec<bool> {
    let turns = |motion: &&str| motion.split(", ").any(|mode| !mode.ends_with("constant velocity"));
    reproduction.motions.iter().map(turns).collect()
}

/// What the shade of the figures of errors means.
pub(super) fn what_is_shaded(reproduction: &Reproduction) -> &'static str {
    let accelerates = |motion: &&str| motion.contains("constant acceleration");
    if reproduction.motions.iter().any(accelerates) {
        "the target accelerates or turns"
    } else {
        "the target turns"
    }
}

/// The runs, the band, the shade, and the filters that cannot be distinguished.
fn note(reproduction: &Reproduction, panels: &[Panel], shaded: &str) -> String {
    let mut note = format!(
        "{} runs, seed {}; bands: ± {BAND} standard errors. {shaded}",
        reproduction.runs, reproduction.seed
    );
    for group in coinciding(reproduction, panels) {
        if let [first @ .., last] = &group[..] {
            let _ = write!(note, " Within a pixel of each other: {} and {last}.", first.join(", "));
        }
    }
    note
}

/// The groups of filters whose lines are within a pixel of that of the group's first, in all panels.
fn coinciding<'a>(reproduction: &'a Reproduction, panels: &[Panel]) -> Vec<Vec<&'a str>> {
    let same = |a: usize, b: usize| {
        panels.iter().all(|panel| {
            let (Some((a, _)), Some((b, _))) = (&panel.histories[a], &panel.histories[b]) else {
                return panel.histories[a].is_none() && panel.histories[b].is_none();
            };
            let pixel = panel.highest / PIXELS;
            a.iter().zip(b).all(|(a, b)| (a - b).abs() < pixel)
        })
    };
    let is_drawn = |filter: &usize| panels.iter().any(|panel| panel.histories[*filter].is_some());
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for filter in (0..reproduction.filters.len()).filter(is_drawn) {
        match groups.iter_mut().find(|group| same(group[0], filter)) {
            Some(group) => group.push(filter),
            None => groups.push(vec![filter]),
        }
    }
    let names = |group: Vec<usize>| {
        group
            .into_iter()
            .map(|f| reproduction.filters[f].name.as_str())
            .collect()
    };
    groups.into_iter().filter(|group| group.len() > 1).map(names).collect()
}

/// The legend of filters of which there is something to show.
pub(super) fn legend(reproduction: &Reproduction, is_shown: impl Fn(usize) -> bool) -> Vec<(String, Key)> {
    let names = reproduction.filters.iter().map(|filter| filter.name.clone());
    let entries = names.zip(looks(reproduction.filters.len())).enumerate();
    entries
        .filter(|(filter, _)| is_shown(*filter))
        .map(|(_, (name, look))| (name, Key::Line(look)))
        .collect()
}

/// Draws the panels one above the other.
fn draw(reproduction: &Reproduction, caption: &Caption, panels: &[Panel]) -> Result<String, NotDrawn> {
    let legend = legend(reproduction, |filter| {
        panels.iter().any(|panel| panel.histories[filter].is_some())
    });
    let count = u32::try_from(panels.len()).unwrap_or(1).max(1);
    figure(caption, &legend, PANEL_HEIGHT * count, |area| {
        let areas = area.split_evenly((panels.len().max(1), 1));
        areas
            .iter()
            .zip(panels)
            .try_for_each(|(area, panel)| draw_panel(area, panel, reproduction))
    })
}

fn draw_panel(area: &Area, of: &Panel, reproduction: &Reproduction) -> Drawn {
    let times = &reproduction.times;
    let x = Axis::new(times[0]..times[times.len() - 1], "time (s)", false);
    let y = Axis::new(0.0..of.highest, of.label, true);
    let mut chart = panel(area, &of.title, [&x, &y], &stretches(times, &of.shaded))?;
    let line = |(history, look): (&Option<History>, Look)| {
        let (values, errors) = history.as_ref()?;
        let edge = |value: f64| value.clamp(0.0, of.highest);
        let of_time = values
            .iter()
            .zip(errors)
            .filter(|(value, error)| value.is_finite() && error.is_finite());
        Some(Line {
            look,
            points: times.iter().copied().zip(values.iter().copied()).collect(),
            band: of_time
                .map(|(value, error)| [edge(value - BAND * error), edge(value + BAND * error)])
                .collect(),
        })
    };
    let lines: Vec<Line> = of
        .histories
        .iter()
        .zip(looks(of.histories.len()))
        .filter_map(line)
        .collect();
    draw_lines(&mut chart, &lines)
}
