//! Goal: what a figure draws stands where the labels of its axes say.
//!
//! Method: each figure is read back from its SVG: axes from their labels, then lines, bands, shades, marks and cells, and every one is held
//! against the value that it is of, which is taken from the runs or computed anew. Kind of evidence: exact, to two pixels: a label
//! stands at a whole pixel, and so does a point.

#![allow(
    clippy::float_cmp,
    reason = "widths are whole, and opacities are those that were chosen"
)]

mod common;

use common::runs;
use common::svg::{Frame, Shape, frames, rectangle_at, shapes};
use immaculate::model::Conversion;
use immaculate::model::conversion_moments::attenuation;
use immaculate::model::conversion_validity::{Validity, validity};
use immaculate::paper::Paper;
use immaculate::paper::comparison::ErrorQuantity;
use immaculate::paper::result::Reproduction;
use immaculate::paper::sustika2015::sweep::{Fit, SweepPoint, SweptParameter, SweptTrajectory, settings};
use immaculate::report::long_term::{Panel, heat_maps};
use immaculate::report::palette::{FILTERS, INK, MEASURED, SHADE, hexadecimal};
use immaculate::report::{conversion, figure, fit_error, path, published, reproduction, stability_map};
use immaculate::statistics::Estimate;
use immaculate::steady::map::Map;
use immaculate::steady::simulated::Grid;
use immaculate::steady::verdict::{Depth, StabilityVerdict};
use std::sync::OnceLock;

/// A label is rounded to a pixel and a point to another, at either end of a scale.
const PIXELS: f64 = 2.0;

#[test]
fn errors_over_time_go_through_their_values() {
    for reproduction in reproductions() {
        let drawn = shapes(&figure::errors(reproduction).unwrap());
        let panels = frames(&drawn);
        assert_eq!(panels.len(), 2, "position and velocity");
        for (panel, quantity) in panels.iter().zip([ErrorQuantity::Position, ErrorQuantity::Velocity]) {
            let histories = reproduction.filters.iter().map(|filter| {
                let history = filter.rmse.iter().find(|history| history.quantity == quantity).unwrap();
                Some((history.values.clone(), history.standard_errors.clone()))
            });
            let histories: Vec<_> = histories.collect();
            assert_histories(panel, &drawn, reproduction, &histories);
            let turns = |motion: &&str| motion.contains("turn") || motion.contains("acceleration");
            assert_shaded(
                panel,
                &drawn,
                &reproduction.times,
                &reproduction.motions.iter().map(turns).collect::<Vec<_>>(),
            );
            // No band leaves the panel, and the panel is not much higher than the highest.
            let highest = histories
                .iter()
                .flatten()
                .flat_map(|(values, errors)| values.iter().zip(errors));
            let highest = highest
                .map(|(value, error)| value + 2.0 * error)
                .filter(|edge| edge.is_finite())
                .fold(0.0, f64::max);
            let part = (panel.bottom - panel.y.pixel(highest)) / (panel.bottom - panel.top);
            assert!((0.93..=1.0).contains(&part), "{part}");
        }
    }
}

#[test]
fn mode_probabilities_over_time_go_through_their_values() {
    for reproduction in reproductions() {
        let drawn = shapes(&figure::mode_probabilities(reproduction).unwrap());
        let panels = frames(&drawn);
        let mut modes: Vec<&str> = Vec::new();
        for filter in reproduction.filters.iter().filter(|filter| filter.modes.len() > 1) {
            modes.extend(
                filter
                    .modes
                    .iter()
                    .map(String::as_str)
                    .filter(|mode| !modes.contains(mode))
                    .collect::<Vec<_>>(),
            );
        }
        assert_eq!(panels.len(), modes.len());
        for (panel, mode) in panels.iter().zip(modes) {
            assert!(
                (panel.y.pixel(1.0) - panel.top).abs() <= PIXELS && (panel.y.pixel(0.0) - panel.bottom).abs() <= PIXELS
            );
            let histories = reproduction.filters.iter().map(|filter| {
                let j = filter.modes.iter().position(|name| name == mode)?;
                let of = |steps: &[Vec<f64>]| steps.iter().map(|step| step[j]).collect::<Vec<_>>();
                let history = (
                    of(&filter.mode_probabilities),
                    of(&filter.mode_probability_standard_errors),
                );
                (filter.modes.len() > 1).then_some(history)
            });
            assert_histories(panel, &drawn, reproduction, &histories.collect::<Vec<_>>());
            let is_true: Vec<bool> = (0..reproduction.steps).map(|k| reproduction.is_true(mode, k)).collect();
            assert_shaded(panel, &drawn, &reproduction.times, &is_true);
        }
    }
}

#[test]
fn the_first_run_is_drawn_where_it_was() {
    for reproduction in reproductions() {
        let first_run = reproduction.first_run.as_ref().unwrap();
        let drawn = shapes(&path::path(reproduction, first_run).unwrap());
        let panels = frames(&drawn);
        let [plane, errors @ ..] = &panels[..] else {
            panic!("no plane")
        };
        let places = |path: &[[f64; 2]]| path.iter().map(|place| (place[0], place[1])).collect::<Vec<_>>();
        for (filter, estimates) in first_run.estimates.iter().enumerate() {
            plane.assert_line(&drawn, colour(filter), &places(estimates), PIXELS);
        }
        plane.assert_line(&drawn, &hexadecimal(INK), &places(&first_run.truth), PIXELS);
        plane.assert_dots(&drawn, &hexadecimal(MEASURED), &places(&first_run.measured), PIXELS);
        let marks = plane.polygons(&drawn, &hexadecimal(INK));
        let sensor = first_run.sensor.map(|place| plane.at(place.into()));
        assert_eq!(marks.len(), usize::from(sensor.is_some()));
        for (mark, sensor) in marks.iter().zip(sensor) {
            assert!(
                (mark.middle().0 - sensor.0).abs() <= PIXELS
                    && (mark.middle().1 - sensor.1).abs() <= 8.0 / 3.0 + PIXELS
            );
        }
        assert_eq!(errors.len(), 2);
        for (coordinate, panel) in errors.iter().enumerate() {
            let less_truth = |path: &[[f64; 2]]| {
                let pairs = path.iter().zip(&first_run.truth).zip(&reproduction.times);
                pairs
                    .map(|((place, truth), time)| (*time, place[coordinate] - truth[coordinate]))
                    .collect::<Vec<_>>()
            };
            for (filter, estimates) in first_run.estimates.iter().enumerate() {
                panel.assert_line(&drawn, colour(filter), &less_truth(estimates), PIXELS);
            }
            panel.assert_dots(&drawn, &hexadecimal(MEASURED), &less_truth(&first_run.measured), PIXELS);
        }
    }
}

#[test]
fn published_and_computed_figures_are_marked_where_they_are() {
    for paper in Paper::ALL {
        let of_paper = reproductions()
            .iter()
            .filter(|reproduction| reproduction.paper == paper.key());
        let comparisons: Vec<_> = of_paper
            .flat_map(|of| reproduction::published_and_computed(paper, of))
            .collect();
        let drawn = shapes(&published::published_and_computed(paper, &comparisons).unwrap().unwrap());
        let rows: Vec<_> = comparisons
            .chunk_by(|a, b| (a.table, &a.row) == (b.table, &b.row))
            .collect();
        let panels = frames(&drawn);
        assert_eq!(panels.len(), rows.len());
        for (panel, row) in panels.iter().zip(rows) {
            let computed = panel.polygons(&drawn, colour(0));
            let diamonds = panel.polygons(&drawn, colour(1));
            let bars = panel.lines(&drawn, colour(0));
            let bars: Vec<_> = bars.iter().filter(|bar| bar.width == 3.0).collect();
            assert_eq!([computed.len(), diamonds.len()], [row.len(); 2]);
            let mut last = panel.top;
            for (place, of) in row.iter().enumerate() {
                let (dot, diamond) = (computed[place].middle(), diamonds[place].middle());
                assert!(
                    (dot.0 - panel.x.pixel(of.computed)).abs() <= PIXELS,
                    "{paper:?}, {}, {}",
                    of.row,
                    of.filter
                );
                assert!(
                    (diamond.0 - panel.x.pixel(of.published)).abs() <= PIXELS,
                    "{paper:?}, {}, {}",
                    of.row,
                    of.filter
                );
                // The two of a filter stand on one line, and filters from top to bottom.
                assert!((dot.1 - diamond.1).abs() <= 1.0 && dot.1 > last + 10.0);
                last = dot.1;
                // A bar that is shorter than a pixel is not drawn.
                let ends = [-2.0, 2.0].map(|errors| panel.x.pixel(of.computed + errors * of.standard_error));
                let is_of = |bar: &&&Shape| (bar.points[0].1 - dot.1).abs() <= 1.0;
                match bars.iter().find(is_of) {
                    Some(bar) => assert!(
                        (bar.points[0].0 - ends[0]).abs() <= PIXELS
                            && (bar.points[bar.points.len() - 1].0 - ends[1]).abs() <= PIXELS
                    ),
                    None => assert!(ends[1] - ends[0] <= PIXELS, "{} has no bar", of.filter),
                }
            }
        }
    }
}

#[test]
fn fit_errors_go_through_their_means_on_plain_and_on_logarithmic_axes() {
    // Means from below 3 % to above 10 %, times a factor: nowhere divergent, in places, and everywhere.
    for factor in [0.1, 1.0, 100.0] {
        let points: Vec<_> = settings()
            .into_iter()
            .map(|setting| (setting, point(setting.value, factor)))
            .collect();
        for trajectory in SweptTrajectory::ALL {
            let drawn = shapes(&fit_error::draw(&points, trajectory, 50).unwrap());
            let panels = frames(&drawn);
            assert_eq!(panels.len(), 2);
            for (panel, parameter) in panels.iter().zip(SweptParameter::ALL) {
                let of_panel: Vec<_> = points
                    .iter()
                    .filter(|(setting, _)| setting.trajectory == trajectory && setting.parameter == parameter)
                    .collect();
                let fits = || of_panel.iter().flat_map(|(_, point)| &point.fits);
                let greatest = fits()
                    .map(|fit| fit.mean.value + 2.0 * fit.mean.standard_error)
                    .fold(3.0, f64::max);
                // Divergent is what is above 10 %, and nothing of it could be seen beside what is not on an axis of its own.
                let mut panel = panel.clone();
                if greatest > 10.0 {
                    panel.y = panel.y.logarithmic();
                }
                // A logarithmic axis begins with one per cent.
                let least = if panel.y.is_logarithmic { 1.0 } else { f64::MIN };
                for filter in 0..3 {
                    let of_filter = of_panel
                        .iter()
                        .map(|(setting, point)| (setting.value, point.fits[filter].mean.value.max(least)));
                    panel.assert_line(&drawn, colour(filter), &of_filter.collect::<Vec<_>>(), PIXELS);
                }
                let limit = panel.lines(&drawn, &hexadecimal(INK));
                let limit: Vec<_> = limit.iter().filter(|line| line.width == 2.0).collect();
                assert_eq!(limit.len(), 1);
                assert!(
                    limit[0]
                        .points
                        .iter()
                        .all(|point| (point.1 - panel.y.pixel(3.0)).abs() <= PIXELS)
                );
            }
        }
    }
}

/// What some runs may show at a setting.
fn point(setting: f64, factor: f64) -> SweepPoint {
    let fit = |filter: f64| Fit {
        mean: Estimate {
            value: factor * (1.0 + filter * setting * setting),
            standard_error: 0.05 * factor * (1.0 + filter),
        },
        median: factor,
        divergent: 0,
        divergent_with_jump: 0,
        failed: 0,
    };
    let none = Estimate {
        value: 0.0,
        standard_error: 1.0,
    };
    SweepPoint {
        runs_with_jump: 0,
        fits: [fit(0.0), fit(1.0), fit(3.0)],
        unscented_less_converted: none,
        plain_less_converted: none,
    }
}

type Value = fn(&Validity<f64>) -> f64;

#[test]
fn the_conversions_are_drawn_as_their_closed_forms_have_them() {
    let drawn = shapes(&conversion::figure().unwrap());
    let panels = frames(&drawn);
    // What is drawn, what would be right, and within what.
    let rows: [(Value, f64, f64); 4] = [
        (|found| found.bias, 0.0, 0.2),
        (|found| found.as_measured[0], 1.0, 0.1),
        (|found| found.as_true[0], 1.0, 0.1),
        (|found| found.as_measured[1], 1.0, 0.1),
    ];
    assert_eq!(panels.len(), 8);
    for (number, panel) in panels.iter().enumerate() {
        let (value, right, within) = rows[number / 2];
        let degrees: f64 = [1.0, 20.0][number % 2];
        let variance = degrees.to_radians() * degrees.to_radians();
        for (place, conversion) in Conversion::ALL.into_iter().enumerate() {
            let lines = panel.lines(&drawn, colour(place));
            // A line that has left the panel is not drawn; what is drawn is on the curve.
            for point in lines.iter().flat_map(|line| &line.points) {
                let rho = panel.x.place(point.0);
                let expected = value(&validity(conversion, &rho, &variance, &attenuation(&variance)));
                // A steep curve crosses some pixels within one of ρ.
                let next = value(&validity(
                    conversion,
                    &(rho + panel.x.place(1.0) - panel.x.place(0.0)),
                    &variance,
                    &attenuation(&variance),
                ));
                let steep = (panel.y.pixel(next) - panel.y.pixel(expected)).abs();
                assert!(
                    (point.1 - panel.y.pixel(expected)).abs() <= PIXELS + steep,
                    "panel {number}, {conversion:?}, ρ = {rho}"
                );
            }
            let inside = |rho: f64| {
                let drawn_at = panel
                    .y
                    .pixel(value(&validity(conversion, &rho, &variance, &attenuation(&variance))));
                (panel.top + 5.0..panel.bottom - 5.0).contains(&drawn_at)
            };
            let has_point = |rho: f64| {
                lines
                    .iter()
                    .flat_map(|line| &line.points)
                    .any(|point| (point.0 - panel.x.pixel(rho)).abs() <= 4.0)
            };
            for rho in [0.5, 0.7, 0.9, 1.1, 1.3, 1.5] {
                assert!(
                    !inside(rho) || has_point(rho),
                    "panel {number}: {conversion:?} at ρ = {rho}"
                );
            }
        }
        let band = panel.rectangles(&drawn, &hexadecimal(SHADE));
        let [band] = &band[..] else { panic!("one band a panel") };
        let edges = band.points.iter().map(|point| point.1);
        let (top, bottom) = (edges.clone().fold(f64::MAX, f64::min), edges.fold(f64::MIN, f64::max));
        assert!(
            (top - panel.y.pixel(right + within)).abs() <= PIXELS
                && (bottom - panel.y.pixel(right - within)).abs() <= PIXELS
        );
        let rule = panel.lines(&drawn, &hexadecimal(INK));
        let dashes: Vec<_> = rule.iter().filter(|line| line.width == 2.0).collect();
        assert!(
            dashes.len() > 5
                && dashes
                    .iter()
                    .all(|dash| (dash.points[0].0 - panel.x.pixel(0.4)).abs() <= PIXELS)
        );
        // The radar of sustika2015 at 1400 m, σ_r = 10 m, on the side of small deviations alone.
        let radar = [1.0_f64, 4.0].map(|degrees| panel.x.pixel(140.0 * degrees.to_radians() * degrees.to_radians()));
        let marks = panel.lines(&drawn, &hexadecimal(MEASURED));
        let is_at = |place: f64| marks.iter().any(|mark| (mark.points[0].0 - place).abs() <= PIXELS);
        assert_eq!(radar.map(is_at), [number % 2 == 0; 2]);
    }
}

#[test]
fn a_cell_of_the_stability_map_has_the_colour_of_its_verdict() {
    let depth = Depth {
        word: 6,
        run: 6,
        memory: 2,
    };
    for (side, depth) in [
        (7, depth),
        (
            7,
            Depth {
                word: 1,
                run: 1,
                memory: 0,
            },
        ),
    ] {
        let map = Map::new(side, [-2.0, 2.0], depth, &|| ());
        let drawn = shapes(&stability_map::draw(&map).unwrap());
        let panels = frames(&drawn);
        let (x, y) = (panels[0].x.logarithmic(), panels[0].y.logarithmic());
        for point in map.points.iter().flatten() {
            let [v, a] = point.indices.each_ref().map(immaculate::number::Rational::to_f64);
            let (fill, opacity) = match &point.verdict {
                StabilityVerdict::Stable(found) if found.forms.len() == 1 => (colour(0), 1.0),
                StabilityVerdict::Stable(_) => (colour(0), 0.45),
                StabilityVerdict::Unstable(found) if found.word.len() == 2 => (colour(1), 1.0),
                StabilityVerdict::Unstable(found) if found.word.len() <= 5 => (colour(1), 0.55),
                StabilityVerdict::Unstable(_) => (colour(1), 0.25),
                StabilityVerdict::Undecided { .. } => ("#000000", 1.0),
            };
            let cell = rectangle_at(&drawn, (x.pixel(a), y.pixel(v))).unwrap();
            assert_eq!(
                (cell.colour.as_str(), cell.opacity),
                (fill, opacity),
                "at Λ_v = {v}, Λ_a = {a}"
            );
        }
        // Equal indices are a line.
        let equal = panels[0].lines(&drawn, &hexadecimal(INK));
        let equal: Vec<_> = equal
            .iter()
            .filter(|line| line.width == 2.0)
            .flat_map(|line| &line.points)
            .collect();
        assert!(equal.len() >= 2);
        for point in equal {
            let (across, up) = (x.place(point.0), y.place(point.1));
            // A pixel of a label of a power of ten.
            assert!((across - up).abs() < 0.03, "10^{across} and 10^{up}");
        }
    }
}

#[test]
fn a_cell_of_a_heat_map_has_the_colour_of_its_percentage() {
    let grid = Grid {
        rows: vec![1.0, 2.0],
        rows_are: "of which there are two",
        columns: vec![10.0, 20.0, 30.0, 40.0],
        ..Grid::figure_1(2.0)
    };
    let percentages = vec![-200.0, -100.0, -52.0, -4.0, 4.0, 48.0, 100.0, f64::NAN];
    let panel = |title: &str, percentages: Vec<f64>| Panel {
        title: title.into(),
        grid: grid.clone(),
        percentages,
    };
    let turned: Vec<f64> = percentages.iter().rev().copied().collect();
    let panels = [panel("one", percentages.clone()), panel("two", turned.clone())];
    let svg = heat_maps(&panels, 2).unwrap();
    // The sizes that there are, in order: 4, 4, 48, 52, 100, 100, 200.
    assert!(svg.contains("one: 52 %;") && svg.contains("two: 52 %;"));
    let drawn = shapes(&svg);
    let frames = frames(&drawn);
    for (frame, percentages) in frames.iter().zip([percentages, turned]) {
        for (index, percentage) in percentages.iter().enumerate() {
            let at = (
                frame.x.pixel(grid.columns[index % 4]),
                frame.y.pixel(grid.rows[index / 4]),
            );
            let cell = rectangle_at(&drawn, at);
            let (fill, opacity) = match percentage {
                p if p.is_nan() => (hexadecimal(MEASURED), 1.0),
                // White is right, and needs no ink.
                p if p.abs() < 5.0 => {
                    assert!(cell.is_none(), "{percentage} %");
                    continue;
                }
                p if *p < 0.0 => (colour(0).to_owned(), (p.abs() / 100.0).min(1.0)),
                p => (colour(1).to_owned(), (p / 100.0).min(1.0)),
            };
            let cell = cell.unwrap();
            assert_eq!(cell.colour, fill, "{percentage} %");
            // In tenths.
            assert!(
                (cell.opacity - opacity).abs() <= 0.05 + 1e-9,
                "{percentage} %: {}",
                cell.opacity
            );
        }
    }
}

// What is held against what

/// A value of each filter at each step, with its standard error.
type Histories = [Option<(Vec<f64>, Vec<f64>)>];

fn assert_histories(panel: &Frame, drawn: &[Shape], reproduction: &Reproduction, histories: &Histories) {
    let times = &reproduction.times;
    for (filter, history) in histories.iter().enumerate() {
        let Some((values, errors)) = history else {
            assert!(panel.lines(drawn, colour(filter)).is_empty());
            continue;
        };
        let points: Vec<_> = times.iter().copied().zip(values.iter().copied()).collect();
        panel.assert_line(drawn, colour(filter), &points, PIXELS);
        // The band: two standard errors to either side, inside the panel.
        let edge = |sign: f64| {
            let edges = values
                .iter()
                .zip(errors)
                .map(move |(value, error)| value + sign * 2.0 * error);
            times.iter().copied().zip(edges).filter(|(_, edge)| edge.is_finite())
        };
        let outline: Vec<(f64, f64)> = edge(-1.0).chain(edge(1.0)).collect();
        let widest = edge(1.0)
            .zip(edge(-1.0))
            .map(|(high, low)| panel.y.pixel(low.1) - panel.y.pixel(high.1))
            .fold(0.0, f64::max);
        let bands = panel.polygons(drawn, colour(filter));
        let bands: Vec<_> = bands.iter().filter(|band| band.opacity == 0.25).collect();
        assert!(
            bands.len() == 1 || bands.is_empty() && widest < PIXELS,
            "{}",
            reproduction.paper
        );
        for band in bands {
            panel.assert_through(&band.points, &outline, PIXELS);
        }
    }
}

/// The panel is shaded at the times of which something is so, half a step to either side, and at no other.
fn assert_shaded(panel: &Frame, drawn: &[Shape], times: &[f64], is_so: &[bool]) {
    let half = (times[1] - times[0]) / 2.0;
    let mut expected: Vec<[f64; 2]> = Vec::new();
    for (time, _) in times.iter().zip(is_so).filter(|(_, is_so)| **is_so) {
        match expected.last_mut() {
            Some(stretch) if (stretch[1] - (time - half)).abs() < half => stretch[1] = time + half,
            _ => expected.push([time - half, time + half]),
        }
    }
    let shades = panel.rectangles(drawn, &hexadecimal(SHADE));
    assert_eq!(shades.len(), expected.len());
    for (shade, ends) in shades.iter().zip(expected) {
        let ends = ends.map(|time| panel.x.pixel(time).clamp(panel.left, panel.right));
        let (left, right) = (shade.points[0].0, shade.points[1].0);
        assert!(
            (left - ends[0]).abs() <= PIXELS && (right - ends[1]).abs() <= PIXELS,
            "{left} to {right}, {ends:?}"
        );
    }
}

/// The colour of a filter, by its place.
fn colour(place: usize) -> &'static str {
    static COLOURS: OnceLock<Vec<String>> = OnceLock::new();
    &COLOURS.get_or_init(|| FILTERS.map(hexadecimal).to_vec())[place]
}

/// A simulation of each kind of each paper, three runs of it.
fn reproductions() -> &'static [Reproduction] {
    static ALL: OnceLock<Vec<Reproduction>> = OnceLock::new();
    ALL.get_or_init(runs::reproductions)
}
