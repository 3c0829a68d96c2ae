//! Goal: the files of a verdict say what the verdict says, and can be read by the programs that take them: readers of
//! JUnit, of Markdown, of HTML and of SVG.
//!
//! Method: this crate's own filter is checked as it is, with mistakes, with other forms, and with words that are markup; each file is read
//! back by a parser that forgives nothing, and held against the verdict. Kind of evidence: behaviour. The program is run for what it does
//! with paths.

mod common;

use common::program::{error_of, immaculate, names};
use common::svg::{Frame, frames, shapes};
use immaculate::oracle::behaviour::Behaviour;
use immaculate::oracle::check::{Outcome, Report, Selection, check};
use immaculate::oracle::judge::Finding;
use immaculate::oracle::subject::{Level, Planted};
use immaculate::report::verdict::{badge, junit, markdown, page};
use roxmltree::Document;
use scraper::{Html, Selector};
use std::path::PathBuf;
use std::process::Output;
use std::sync::LazyLock;

/// The verdict on this crate's filter with some variants planted in it, on the cases that begin so.
fn verdict(variants: &[&str], cases: &[&str]) -> Report {
    let mut program = Planted {
        variants: variants.iter().map(|id| (*id).to_owned()).collect(),
        level: Level::Everything,
    };
    let selection = Selection {
        ids: cases.iter().map(|id| (*id).to_owned()).collect(),
        ..Selection::default()
    };
    check(&mut program, &selection, &|_| {}).unwrap()
}

/// A mistake, seen in steps, in runs, and not at all in what must be rejected.
static WRONG: LazyLock<Report> = LazyLock::new(|| {
    verdict(
        &["mixed-spread-omitted"],
        &["step.n4-m2", "rejected.shape", "zhu2016.kalman.run"],
    )
});
static RIGHT: LazyLock<Report> = LazyLock::new(|| verdict(&[], &["step.n4-m2", "rejected.shape"]));

/// Verdicts of every kind, each with whether it is wrong.
fn verdicts() -> Vec<(Report, bool)> {
    let echo_wrong = Report {
        echo: Some(false),
        ..RIGHT.clone()
    };
    let mut skipped = RIGHT.clone();
    skipped.cases[0].outcome = Outcome::Skipped {
        reason: "no such filter".to_owned(),
    };
    let mut stopped = RIGHT.clone();
    stopped.cases[1].outcome = Outcome::Stopped {
        reason: "step 1: singular matrix".to_owned(),
    };
    vec![
        (WRONG.clone(), true),
        (RIGHT.clone(), false),
        (verdict(&["information-update"], &["singular"]), false),
        (echo_wrong, true),
        (skipped, false),
        (stopped, true),
    ]
}

// JUnit

#[test]
fn junit_fails_if_and_only_if_the_verdict_is_wrong() {
    let mut forms = 0;
    for (report, is_wrong) in verdicts() {
        assert_eq!(report.is_wrong(), is_wrong);
        let text = junit::junit(&report).unwrap();
        let document = Document::parse(&text).unwrap();
        let mut elements = 0;
        let count = |name: &str| document.descendants().filter(|node| node.has_tag_name(name)).count();
        assert_eq!(count("failure") > 0, is_wrong, "{text}");
        let skipped = report
            .cases
            .iter()
            .filter(|case| matches!(case.outcome, Outcome::Skipped { .. }))
            .count();
        assert_eq!(count("skipped"), skipped);
        // No more than the schema of Jenkins has: a reader that holds a file to it would take none of it.
        for (name, allowed) in [
            ("testsuites", &["name", "tests", "failures", "errors"][..]),
            ("testsuite", &["name", "tests", "failures", "errors", "skipped"]),
            ("testcase", &["name", "classname"]),
            ("failure", &["type", "message"]),
            ("skipped", &["message"]),
            ("system-out", &[]),
        ] {
            for node in document.descendants().filter(|node| node.has_tag_name(name)) {
                assert!(
                    node.attributes().all(|attribute| allowed.contains(&attribute.name())),
                    "{node:?}"
                );
                elements += 1;
            }
        }
        assert_eq!(
            elements,
            document.descendants().filter(roxmltree::Node::is_element).count(),
            "no other element"
        );
        // What readers show are the counts.
        let root = document.root_element();
        for (attribute, element) in [("tests", "testcase"), ("failures", "failure")] {
            assert_eq!(
                root.attribute(attribute),
                Some(count(element).to_string().as_str()),
                "{attribute}"
            );
        }
        forms += usize::from(!is_wrong && report.cases.iter().any(|case| case.outcome == Outcome::Wrong));
    }
    assert_eq!(forms, 1, "one of them has faults that are excused");
}

#[test]
fn every_case_is_one_test_in_the_suite_of_its_filter() {
    let text = junit::junit(&WRONG).unwrap();
    let document = Document::parse(&text).unwrap();
    for case in &WRONG.cases {
        let is_it = |node: &roxmltree::Node| node.has_tag_name("testcase") && node.attribute("name") == Some(&case.id);
        let tests: Vec<_> = document.descendants().filter(is_it).collect();
        assert_eq!(tests.len(), 1, "{}", case.id);
        assert_eq!(tests[0].attribute("classname"), Some(case.filters[0].name()));
        assert_eq!(
            tests[0].parent().unwrap().attribute("name"),
            Some(case.filters[0].name())
        );
        let failure = tests[0].children().find(|node| node.has_tag_name("failure"));
        assert_eq!(failure.is_some(), case.outcome.is_wrong(), "{}", case.id);
        if let Some(failure) = failure {
            let words = failure.text().unwrap();
            assert!(words.contains(&format!("{}, step ", case.id)), "{words}");
            assert!(
                words.contains("FAULT  mixed.covariance") && words.contains("(mixed-spread-omitted; mistake)"),
                "{words}"
            );
        }
    }
}

// What a program says

#[test]
fn what_a_program_says_is_text_in_every_file() {
    const NAME: &str = "<b>\"x\"</b> & ]]> `` @all [a](b) |\u{1b}[31m\u{0}\n# y ``` <!--";
    let mut report = WRONG.clone();
    NAME.clone_into(&mut report.ready.name);
    report.cases[0].outcome = Outcome::Stopped {
        reason: format!("step 1: {NAME}\n````\n<script>1</script>"),
    };

    let text = junit::junit(&report).unwrap();
    let document = Document::parse(&text).unwrap();
    let name = document.root_element().attribute("name").unwrap();
    assert!(name.starts_with("<b>\"x\"</b> & ]]> `` @all [a](b) |"), "{name}");

    let html = Html::parse_document(&page::html(&report).unwrap());
    assert!(html.errors.is_empty(), "{:?}", html.errors);
    let found = |selector: &str| html.select(&Selector::parse(selector).unwrap()).count();
    assert_eq!((found("script"), found("h1 b"), found("h1")), (0, 0, 1));

    let text = markdown::markdown(&report);
    let outside = outside_of_code(&text);
    for markup in ["<script", "<!--", "@all", "](b)", "# y"] {
        assert!(
            text.contains(markup) && !outside.contains(markup),
            "{markup} in\n{outside}"
        );
    }
    assert!(
        outside_of_code("a `b` c\n```text\nd\n```\ne").lines().eq(["a  c", "e"]),
        "what is code is known"
    );
    Document::parse(&badge::badge(&report)).unwrap();
}

/// Markdown without its code, in lines and in fences.
fn outside_of_code(text: &str) -> String {
    let (mut outside, mut fence) = (String::new(), None);
    for line in text.lines() {
        let ticks = line.chars().take_while(|c| *c == '`').count();
        match fence {
            None if ticks >= 3 => fence = Some(ticks),
            Some(open) if ticks >= open && line.len() == ticks => fence = None,
            Some(_) => {}
            None => {
                let parts = line.split('`').step_by(2);
                outside.push_str(&parts.collect::<Vec<_>>().join(""));
                outside.push('\n');
            }
        }
    }
    outside
}

// Markdown

#[test]
fn markdown_begins_with_the_verdict_and_its_tables_are_tables() {
    for (report, is_wrong) in verdicts() {
        let text = markdown::markdown(&report);
        let first = text.lines().next().unwrap();
        assert_eq!(first.starts_with("### WRONG: `"), is_wrong, "{first}");
        assert_eq!(first.starts_with("### RIGHT"), !is_wrong, "{first}");
        assert_eq!(text.matches("<details>").count(), text.matches("</details>").count());
        let rows: Vec<usize> = text
            .lines()
            .filter(|line| line.starts_with('|'))
            .map(|line| line.matches('|').count())
            .collect();
        assert_eq!(rows.len(), 2 + Behaviour::ALL.len());
        assert!(rows.iter().all(|cells| *cells == rows[0]), "{text}");
        assert!(text.len() < 65_536, "the longest comment that GitHub takes");
    }
    assert!(markdown::markdown(&WRONG).contains("<details><summary>FAULT <code>mixed.covariance</code>"));
}

// The badge

#[test]
fn the_badge_says_what_the_verdict_says_and_can_be_read() {
    let complete = Report {
        // Nothing that was asked is left open where nothing was asked that is published.
        cases: RIGHT
            .cases
            .iter()
            .cloned()
            .map(|case| immaculate::oracle::check::CaseReport {
                certified: Some(1),
                ..case
            })
            .collect(),
        ..RIGHT.clone()
    };
    let excused = verdict(&["information-update"], &["singular"]);
    let wrong = WRONG.cases.iter().filter(|case| case.outcome.is_wrong()).count();
    for (report, words) in [
        (&*WRONG, format!("WRONG {wrong} of {}", WRONG.cases.len())),
        (&*RIGHT, "RIGHT on what was judged".to_owned()),
        (&complete, "RIGHT".to_owned()),
        (&excused, "RIGHT, but otherwise".to_owned()),
    ] {
        let text = badge::badge(report);
        let document = Document::parse(&text).unwrap();
        assert_eq!(
            document.root_element().attribute("aria-label"),
            Some(format!("immaculate: {words}").as_str())
        );
        let of = |name: &'static str| document.descendants().filter(move |node| node.has_tag_name(name));
        assert!(of("text").any(|node| node.text() == Some(&words)), "{text}");
        for ground in of("rect").filter_map(|node| node.attribute("fill")) {
            assert!(contrast_with_white(ground) >= 4.5, "{ground}");
        }
    }
    assert!(
        contrast_with_white("#777777") < 4.5,
        "a grey that is too light is known"
    );
}

/// The contrast of white letters on a ground, by WCAG 2.
fn contrast_with_white(ground: &str) -> f64 {
    let linear = |at: usize| {
        let value = f64::from(u8::from_str_radix(&ground[at..at + 2], 16).unwrap()) / 255.0;
        if value <= 0.04045 {
            value / 12.92
        } else {
            ((value + 0.055) / 1.055).powf(2.4)
        }
    };
    1.05 / (0.2126 * linear(1) + 0.7152 * linear(3) + 0.0722 * linear(5) + 0.05)
}

// The page. That it is valid, and asks for nothing, is the work of `page`.

#[test]
fn the_page_shows_the_errors_of_each_equation_over_the_steps() {
    let html = page::html(&WRONG).unwrap();
    let case = WRONG.cases.iter().find(|case| case.id == "zhu2016.kalman.run").unwrap();
    let judged = &case.judgement.as_ref().unwrap().values;
    let drawn: Vec<&str> = html
        .match_indices("<svg")
        .map(|(at, _)| &html[at..at + html[at..].find("</svg>").unwrap()])
        .collect();
    assert_eq!(drawn.len(), 2, "the combined mean, and the one equation with a fault");
    for (svg, name, finding) in [
        (drawn[0], "combined.mean", Finding::Propagated),
        (drawn[1], "mixed.covariance", Finding::Fault),
    ] {
        let values: Vec<_> = judged
            .iter()
            .filter(|value| value.place.1.name() == name && value.place.2 == 0)
            .collect();
        assert!(values.iter().any(|value| value.finding == finding), "{name}");
        let drawn = shapes(svg);
        let frame = &frames(&drawn)[0];
        let frame = Frame {
            y: frame.y.logarithmic(),
            ..frame.clone()
        };
        let points = |error: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
            (0..values.len())
                .map(|at| (values[at].place.0 as f64, error(at).clamp(1e-17, 1e17)))
                .collect()
        };
        frame.assert_line(&drawn, "#0072B2", &points(&|at| values[at].error), 1.5);
        frame.assert_line(&drawn, "#D55E00", &points(&|at| values[at].own.unwrap().size), 1.5);
    }
}

#[test]
fn the_page_names_cause_equation_and_size() {
    let html = Html::parse_document(&page::html(&WRONG).unwrap());
    let text_of = |selector: &str| -> String {
        html.select(&Selector::parse(selector).unwrap())
            .flat_map(|element| element.text().collect::<Vec<_>>())
            .collect()
    };
    assert_eq!(text_of("h1 .verdict"), "WRONG");
    assert!(
        text_of("main > p.lead").contains("The combined mean is off by up to"),
        "{}",
        text_of("main > p.lead")
    );
    assert!(text_of(".causes").contains("you left the spread of the means out of the mixed covariance"));
    assert!(text_of("article h3").contains("mixed.covariance"));
    assert!(text_of("article .in-numbers").contains("yours 4.78125"));
    assert_eq!(
        html.select(&Selector::parse("article math").unwrap()).count(),
        1,
        "its formula"
    );
    let right = page::html(&RIGHT).unwrap();
    for words in ["What explains it", "Equations with a fault", "combined mean is off"] {
        assert!(!right.contains(words), "{words}");
    }
}

// The program

#[test]
fn the_program_writes_the_files_that_it_is_asked_for() {
    let folder = folder("written");
    let file = |name: &str| folder.join(name).display().to_string();
    let [xml, md, html, svg] = ["v.xml", "v.md", "v.html", "v.svg"].map(file);
    let files = ["--junit", &xml, "--markdown", &md, "--report", &html, "--badge", &svg];
    let output = checked(
        &[&["--case", "step.n4-m2"], &files[..]].concat(),
        "mixed-spread-omitted",
    );
    assert_eq!(output.status.code(), Some(1), "{}", error_of(&output));
    let plain = checked(&["--case", "step.n4-m2"], "mixed-spread-omitted");
    assert_eq!(output.stdout, plain.stdout, "what is printed is the same");
    let report = verdict(&["mixed-spread-omitted"], &["step.n4-m2"]);
    let read = |path: &str| std::fs::read_to_string(path).unwrap();
    // The process gives no other name than the library.
    assert_eq!(read(&xml), junit::junit(&report).unwrap());
    assert_eq!(read(&md), markdown::markdown(&report));
    assert_eq!(read(&html), page::html(&report).unwrap());
    assert_eq!(read(&svg), badge::badge(&report));
}

#[test]
fn a_file_that_cannot_be_written_is_refused_before_the_check() {
    let folder = folder("refused");
    let missing = folder.join("nowhere/verdict").display().to_string();
    for option in ["--junit", "--markdown", "--report", "--badge"] {
        for (path, reason) in [
            (missing.as_str(), "its directory does not exist"),
            (folder.to_str().unwrap(), "is a directory"),
        ] {
            let output = immaculate(&["check", option, path, "--", "/no/such/program"])
                .output()
                .unwrap();
            assert_eq!(output.status.code(), Some(1), "{option} {path}");
            let complaint = error_of(&output);
            // The program under test cannot be started: it was not come to.
            assert!(complaint.contains(path) && complaint.contains(reason), "{complaint}");
        }
    }
    assert_eq!(names(&folder), Vec::<String>::new());
}

#[test]
fn a_check_without_a_program_shows_what_a_verdict_is() {
    let output = immaculate(&["check"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "what was asked for was shown");
    let text = String::from_utf8(output.stdout.clone()).unwrap();
    for words in [
        "FAULT  mixed.covariance",
        "(mixed-spread-omitted; mistake)",
        "YOUR OWN FILTER",
        "immaculate init python",
    ] {
        assert!(text.contains(words), "{words} in\n{text}");
    }
    // It is the command that it says it is.
    let shown = checked(&["--case", "step.n4-m2"], "mixed-spread-omitted");
    assert!(text.contains("--case step.n4-m2 -- immaculate answer --plant mixed-spread-omitted"));
    assert!(text.contains(&String::from_utf8(shown.stdout).unwrap()));
    // A script whose program is an empty variable gets an error instead of a check. More arguments mean that a program was intended.
    for more in [
        &["--json"][..],
        &["--strict"],
        &["--kind", "kalman"],
        &["--badge", "b.svg"],
        &["--"],
    ] {
        let output = immaculate(&[&["check"], more].concat()).output().unwrap();
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{more:?}");
    }
}

/// The program checks its own filter with a variant in it.
fn checked(arguments: &[&str], variant: &str) -> Output {
    let own = env!("CARGO_BIN_EXE_immaculate");
    let program = ["--", own, "answer", "--plant", variant];
    immaculate(&[&["check"], arguments, &program].concat())
        .output()
        .unwrap()
}

/// An empty folder.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("verdict files {name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}
