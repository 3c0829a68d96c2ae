//! Goal: every figure of the program can be read, on white and on black, by eye and by ear, and shows what the runs say.
//!
//! Method: all figures are drawn from a few runs, with one seed, and read as text: colours, words, sizes, coordinates. Kind of evidence:
//! exhaustion over the figures; exact, but where a tolerance of pixels is said.

mod common;

use common::runs::{self, EFFORT};
use immaculate::compare::{Contest, Sample};
use immaculate::oracle::case;
use immaculate::paper::Paper;
use immaculate::paper::result::Reproduction;
use immaculate::paper::specification::Choices;
use immaculate::paper::sustika2015::sweep::{Sweep, SweptTrajectory};
use immaculate::report::palette::{self, hexadecimal};
use immaculate::report::{
    comparison_figure, conversion, figure, fit_error, long_term, path, published, reproduction, stability_map,
};
use immaculate::steady::map::Map;
use immaculate::steady::verdict::Depth;
use std::collections::BTreeSet;
use std::sync::OnceLock;

#[test]
fn every_figure_uses_the_colours_of_the_palette_and_no_other() {
    let known: BTreeSet<String> = palette::ALL.iter().map(|(_, colour)| hexadecimal(*colour)).collect();
    assert_eq!(known.len(), palette::ALL.len(), "no colour has two names");
    let mut used = BTreeSet::new();
    for (name, svg) in figures() {
        for attribute in ["fill", "stroke"] {
            for value in values(svg, attribute).into_iter().filter(|value| *value != "none") {
                assert!(known.contains(value), "{name}: {attribute} {value}");
                used.insert(value.to_owned());
            }
        }
        assert!(!svg.contains("style=") && !svg.contains("rgb("), "{name}");
    }
    assert_eq!(used, known, "every colour is needed");
}

#[test]
fn the_colours_of_filters_stand_out_on_white_and_on_a_dark_ground() {
    // Three to one is what WCAG 2.2 asks of graphics (success criterion 1.4.11).
    let dark = [0x14, 0x17, 0x1a];
    for ground in [[255; 3], dark] {
        for colour in palette::FILTERS.iter().chain([&palette::MEASURED]) {
            let ratio = contrast([colour.0, colour.1, colour.2], ground);
            assert!(ratio >= 3.0, "{} on {ground:?}: {ratio}", hexadecimal(*colour));
        }
    }
    // The scale ends where it should, and grey on white differs from ink.
    assert!((contrast([0; 3], [255; 3]) - 21.0).abs() < 1e-9);
}

#[test]
fn every_figure_has_a_title_and_a_sentence_under_ids_of_its_own() {
    let mut ids = BTreeSet::new();
    for (name, svg) in figures() {
        let head = &svg[..svg.find('>').unwrap()];
        assert!(
            head.contains("role=\"img\"") && head.contains("viewBox=\"0 0 720 "),
            "{name}: {head}"
        );
        let labels = values(head, "aria-labelledby")[0].split(' ').collect::<Vec<_>>();
        for (label, tag) in labels.iter().zip(["title", "desc"]) {
            let element = format!("<{tag} id=\"{label}\">");
            let start = svg.find(&element).unwrap_or_else(|| panic!("{name}: {element}")) + element.len();
            let words = &svg[start..start + svg[start..].find("</").unwrap()];
            assert!(words.chars().count() > 20, "{name}: {words}");
            assert!(ids.insert((*label).to_owned()), "{label} is used twice");
        }
        assert_eq!(values(svg, "id").len(), 2, "{name}");
    }
}

#[test]
fn every_figure_is_small_and_its_words_are_inside_it() {
    for (name, svg) in figures() {
        assert!(svg.len() < 150_000, "{name}: {} bytes", svg.len());
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
        let number = |attribute: &str, element: &str| values(element, attribute)[0].parse::<f64>().unwrap();
        let (width, height) = (number("width", svg), number("height", svg));
        assert!(height < 2.5 * width, "{name}: no higher than a page");
        for element in svg.split("<text").skip(1) {
            let (x, y, size) = (number("x", element), number("y", element), number("font-size", element));
            assert!(
                (0.0..=width).contains(&x) && (0.0..=height).contains(&y),
                "{name}: {element}"
            );
            // On a telephone of 380 pixels nothing is smaller than the 7.9 pixels of the labels of axes.
            assert!(size * 380.0 / width > 7.8, "{name}: letters of {size}");
        }
    }
}

#[test]
fn figures_are_the_same_bytes_with_any_number_of_threads() {
    let on_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(draw_all)
    };
    let one = on_threads(1);
    for ((name, svg), (_, other)) in one.iter().zip(on_threads(2)) {
        assert_eq!(*svg, other, "{name}");
    }
    for ((name, svg), (_, other)) in one.iter().zip(figures()) {
        assert_eq!(svg, other, "{name}");
    }
}

#[test]
fn filters_that_coincide_are_named_and_all_of_them_are_seen() {
    let (_, svg) = figures().iter().find(|(name, _)| name == "liu2017-errors").unwrap();
    // The note is broken into lines; its words follow each other.
    let words: Vec<&str> = svg.lines().filter(|line| !line.contains('<')).collect();
    let sentence = "Within a pixel of each other: IMMUKF, IMMCKF, IMM5thCKF and IMM5thSSRCKF.";
    assert!(words.join(" ").contains(sentence), "{words:?}");
    // Each is thinner than the one under it, by a pixel on either side.
    let mut widths = Vec::new();
    for colour in &palette::FILTERS[..4] {
        let stroke = format!("stroke=\"{}\"", hexadecimal(*colour));
        let lines = svg
            .lines()
            .filter(|line| line.starts_with("<polyline") && line.contains(&stroke));
        let of_colour: BTreeSet<&str> = lines.map(|line| values(line, "stroke-width")[0]).collect();
        assert_eq!(of_colour.len(), 1, "one width a filter");
        widths.push(of_colour.first().unwrap().parse::<u32>().unwrap());
    }
    assert_eq!(widths, [8, 6, 4, 2]);
    // And in zhu2016 the filter of one model is not said to be like the others.
    let (_, svg) = figures().iter().find(|(name, _)| name == "zhu2016-errors").unwrap();
    let words: Vec<&str> = svg.lines().filter(|line| !line.contains('<')).collect();
    assert!(words.join(" ").contains("IMM5CKF, IMMCKF and IMMUKF."), "{words:?}");
}

#[test]
fn every_published_figure_that_runs_reproduce_is_shown_beside_the_computed_one() {
    let diamond = hexadecimal(palette::FILTERS[1]);
    for (paper, rows, marks) in [
        (Paper::Derbez2000, 3, 9),
        (Paper::Sustika2015, 4, 8),
        (Paper::Zhu2016, 4, 20),
        (Paper::Liu2017, 2, 8),
    ] {
        let name = format!("{}-published", paper.key());
        let (_, svg) = figures().iter().find(|(other, _)| *other == name).unwrap();
        assert_eq!(svg.matches("\nTable ").count(), rows, "{name}: a panel a row");
        let drawn = svg
            .lines()
            .filter(|line| line.starts_with("<polygon") && line.contains(&diamond));
        assert_eq!(
            drawn.count(),
            marks + 1,
            "{name}: a mark a figure, and one in the legend"
        );
        for table in &paper.specification().tables {
            for row in &table.rows {
                let shown = svg.contains(&format!("Table {}: {}", table.number, row.name));
                let is_reproduced = paper
                    .simulations(&Choices::default())
                    .iter()
                    .any(|choices| paper.figure_of_row(choices, table.number, &row.name).is_some());
                assert_eq!(shown, is_reproduced, "{name}: table {}, {}", table.number, row.name);
            }
        }
    }
    assert!(published::published_and_computed(Paper::Liu2017, &[]).is_none());
}

#[test]
fn the_plane_has_one_scale_for_both_axes() {
    for reproduction in reproductions() {
        let first_run = reproduction
            .first_run
            .as_ref()
            .expect("paired filters have a run in common");
        let svg = path::path(reproduction, first_run).unwrap();
        // The truth is the thin line of ink; axes have two points, and on a straight path few pixels are distinct.
        let truth = svg
            .lines()
            .filter(|line| line.starts_with("<polyline") && line.contains("stroke=\"#000000\" stroke-width=\"1\""))
            .map(|line| pixels(values(line, "points")[0]))
            .max_by_key(Vec::len)
            .unwrap();
        let extent = |places: &mut dyn Iterator<Item = f64>| {
            let places: Vec<f64> = places.collect();
            places.iter().copied().fold(f64::MIN, f64::max) - places.iter().copied().fold(f64::MAX, f64::min)
        };
        let drawn = [0, 1].map(|c| extent(&mut truth.iter().map(|place| place[c])));
        let true_extent = [0, 1].map(|c| extent(&mut first_run.truth.iter().map(|place| place[c])));
        // Each end is rounded to a pixel: 2 pixels of an extent, and as much again for the pixels of the axes themselves.
        let scale = (drawn[0] + drawn[1]) / (true_extent[0] + true_extent[1]);
        for c in [0, 1] {
            let expected = scale * true_extent[c];
            assert!(
                (drawn[c] - expected).abs() <= 4.0,
                "{}: {drawn:?} {true_extent:?}",
                figure::stem(reproduction)
            );
        }
    }
}

#[test]
fn filters_that_see_different_draws_have_no_first_run_to_show() {
    let choices = Choices::of("pairing", "unpaired");
    let reproduction = Paper::Zhu2016.reproduce(&choices, EFFORT, &|| ()).unwrap();
    assert!(reproduction.first_run.is_none());
}

// How the figures are drawn and read

/// A simulation of each kind of each paper, three runs of it.
fn reproductions() -> &'static [Reproduction] {
    static ALL: OnceLock<Vec<Reproduction>> = OnceLock::new();
    ALL.get_or_init(runs::reproductions)
}

/// Every figure of the program with the name of its file.
fn figures() -> &'static [(String, String)] {
    static ALL: OnceLock<Vec<(String, String)>> = OnceLock::new();
    ALL.get_or_init(draw_all)
}

fn draw_all() -> Vec<(String, String)> {
    let mut all = Vec::new();
    let reproductions = runs::reproductions();
    for reproduction in &reproductions {
        let stem = figure::stem(reproduction);
        all.push((format!("{stem}-errors"), figure::errors(reproduction).unwrap()));
        all.push((
            format!("{stem}-modes"),
            figure::mode_probabilities(reproduction).unwrap(),
        ));
        let first_run = reproduction.first_run.as_ref().unwrap();
        all.push((format!("{stem}-path"), path::path(reproduction, first_run).unwrap()));
    }
    for paper in Paper::ALL {
        let of_paper = reproductions
            .iter()
            .filter(|reproduction| reproduction.paper == paper.key());
        let comparisons: Vec<_> = of_paper
            .flat_map(|of_one| reproduction::published_and_computed(paper, of_one))
            .collect();
        let svg = published::published_and_computed(paper, &comparisons).unwrap().unwrap();
        all.push((format!("{}-published", paper.key()), svg));
    }
    all.push(("conversions".into(), conversion::figure().unwrap()));
    all.push(("figures-1-and-2".into(), long_term::figures_1_and_2(1).unwrap()));
    let sweep = Sweep::new(&Choices::default(), 2, 1).unwrap();
    let points = sweep.run(&|| ());
    for trajectory in SweptTrajectory::ALL {
        let svg = fit_error::draw(&points, trajectory, sweep.runs).unwrap();
        all.push((format!("sweep-{}", trajectory.name()), svg));
    }
    let case = case::all()
        .unwrap()
        .iter()
        .find(|case| case.problem.id == "gpb1.kalman");
    let sample = Sample {
        runs: Some(4),
        seed: 1,
        steps: Some(8),
    };
    let result = Contest::new(&case.unwrap().problem, sample).unwrap().run(&|| ());
    for table in &result.tables {
        let name = format!("comparison-{}", comparison_figure::what(table));
        all.push((name, comparison_figure::draw(&result, table).unwrap()));
    }
    // From the certainly stable to the certainly unstable.
    let depth = Depth {
        word: 6,
        run: 6,
        memory: 1,
    };
    let map = Map::new(7, [-2.0, 2.0], depth, &|| ());
    all.push(("stability-map".into(), stability_map::draw(&map).unwrap()));
    all
}

/// The values of an attribute, in their order.
fn values<'a>(svg: &'a str, attribute: &str) -> Vec<&'a str> {
    let opening = format!(" {attribute}=\"");
    svg.split(&opening)
        .skip(1)
        .map(|rest| &rest[..rest.find('"').unwrap()])
        .collect()
}

/// The points of a line.
fn pixels(points: &str) -> Vec<[f64; 2]> {
    let pair = |pair: &str| {
        let (x, y) = pair.split_once(',').unwrap();
        [x.parse().unwrap(), y.parse().unwrap()]
    };
    points.split_whitespace().map(pair).collect()
}

/// The contrast ratio of WCAG 2: (L₁ + 0.05)/(L₂ + 0.05) with the relative luminances of sRGB.
fn contrast(a: [u8; 3], b: [u8; 3]) -> f64 {
    let luminance = |colour: [u8; 3]| {
        let linear = |channel: u8| {
            let part = f64::from(channel) / 255.0;
            if part <= 0.04045 {
                part / 12.92
            } else {
                ((part + 0.055) / 1.055).powf(2.4)
            }
        };
        0.2126 * linear(colour[0]) + 0.7152 * linear(colour[1]) + 0.0722 * linear(colour[2])
    };
    let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
    a.max(b) / a.min(b)
}
