//! Goal: `spec/` and `src/` are two halves of one specification, and neither says anything that the other does not know.
//!
//! Method: both halves are read as they stand, `src/` as items with doc comments and `spec/` as data, and held against each other in both
//! directions: numbers and names, errata, evidence, parameters, constants, claims. Kind of evidence: traceability. It shows that
//! everything has its place; that what stands there is right is the other files' work.

use immaculate::book::doc::{Doc, backticked};
use immaculate::book::reference::{EquationReference, citations, headings};
use immaculate::book::source::{Item, items_of, source_files, tests};
use immaculate::model::Sensor;
use immaculate::model::motion::acceleration_input;
use immaculate::paper::scenario::{Course, Scenario};
use immaculate::paper::specification::{Choices, PublishedEquation, Specification};
use immaculate::paper::{Effort, Paper, derbez2000, liu2017, sustika2015, zhu2016};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

// Numbers: spec → src and src → spec

#[test]
fn every_equation_is_realised_by_an_item_of_the_source() {
    let realised: BTreeSet<EquationReference> = items().iter().flat_map(|item| headings(&item.doc)).collect();
    let missing: Vec<_> = equations().difference(&realised).cloned().collect();
    assert!(
        missing.is_empty(),
        "in spec/, and after no ` — ` of a doc comment in src/: {missing:?}"
    );
}

#[test]
fn every_equation_named_in_the_source_is_a_row_of_the_specification() {
    let rows = equations();
    let mut unknown = Vec::new();
    for file in source_files() {
        // Doc comments, comments and the equations that errors name.
        let text = file.text.replace("///", "").replace("//!", "");
        let named = citations(&text).into_iter();
        unknown.extend(
            named
                .filter(|equation| !rows.contains(equation))
                .map(|equation| (file.path.clone(), equation)),
        );
    }
    assert!(unknown.is_empty(), "in src/, and no row: {unknown:?}");
}

#[test]
fn an_equation_is_realised_by_an_item_and_not_by_the_head_of_a_file_or_a_comment() {
    for file in source_files() {
        let of_items = items_of(&file).unwrap();
        let realised: BTreeSet<EquationReference> = of_items.iter().flat_map(|item| headings(&item.doc)).collect();
        for named in headings(&file.text.replace("///", "").replace("//!", "")) {
            assert!(
                realised.contains(&named),
                "{}: {named} after a dash, at no item",
                file.path
            );
        }
    }
}

#[test]
fn citations_are_read_as_lists_and_ranges() {
    let read = |text: &str| -> Vec<String> { citations(text).iter().map(ToString::to_string).collect() };
    let zhu = |labels: &[&str]| -> Vec<String> { labels.iter().map(|label| format!("zhu2016 ({label})")).collect() };
    assert_eq!(read("zhu2016 (54)"), zhu(&["54"]));
    assert_eq!(read("zhu2016 (2)-(4), (28) and (9)"), zhu(&["2", "3", "4", "28"]));
    assert_eq!(read("zhu2016 (2),\n    (3)."), zhu(&["2", "3"]));
    assert_eq!(read("zhu2016 (2), (noise-input)."), zhu(&["2", "noise-input"]));
    assert_eq!(
        read("(2), zhu2016, zhu2016 (64, zhu2016 (not numbered), zhu2016 ()"),
        zhu(&[])
    );
    let both = "— zhu2016 (55), liu2017 (12). Then zhu2016 (1) — liu2017 (3), zhu2016 (turn-rate): x";
    assert_eq!(read(both).len(), 5);
    let realised: Vec<String> = headings(both).into_iter().map(|equation| equation.label).collect();
    assert_eq!(realised, ["55", "12", "3", "turn-rate"], "(1) stands after no dash");
}

#[test]
fn numbers_run_without_gaps_and_names_stand_for_the_rest() {
    for paper in Paper::ALL {
        assert_eq!(paper.specification().paper.key, paper.key());
    }
    for specification in specifications() {
        let key = &specification.paper.key;
        for (index, equation) in (1..).zip(&specification.equations) {
            assert_eq!(equation.number, Some(index), "{key}");
            assert_eq!(equation.name, None);
        }
        for equation in &specification.unnumbered {
            assert_eq!(equation.number, None);
            let name = equation.name.as_deref().unwrap_or_default();
            assert!(is_kebab_case(name), "{key}: `{name}`");
        }
    }
}

// Errata and evidence

#[test]
fn every_mathematical_erratum_names_a_test_that_exists() {
    let mut missing = Vec::new();
    for (label, equation) in all_equations() {
        let Some(erratum) = &equation.erratum else {
            continue;
        };
        match (erratum.kind.as_str(), &erratum.test) {
            ("mathematical", Some(test)) if tests().contains_key(test) => {}
            ("notational", None) => {}
            other => missing.push((label, other)),
        }
    }
    assert!(missing.is_empty(), "errata without a test: {missing:?}");
}

#[test]
fn every_mathematical_erratum_is_evidence_of_the_function_that_corrects_it() {
    let evidence: BTreeSet<String> = items().iter().flat_map(|item| evidence(&item.doc)).collect();
    for (label, equation) in all_equations() {
        if let Some(test) = equation.erratum.as_ref().and_then(|e| e.test.as_ref()) {
            assert!(evidence.contains(test), "{label}: `{test}` in no Evidence");
        }
    }
}

#[test]
fn every_test_named_as_evidence_exists() {
    let of_items = items().into_iter().map(|item| (item.path, item.doc));
    let of_files = source_files().into_iter().map(|file| (file.path, head(file.text)));
    let named = of_items
        .chain(of_files)
        .flat_map(|(path, doc)| evidence(&doc).into_iter().map(move |test| (path.clone(), test)));
    let missing: Vec<_> = named.filter(|(_, test)| !tests().contains_key(test)).collect();
    assert!(missing.is_empty(), "no such test: {missing:#?}");
}

#[test]
fn evidence_is_read_to_the_end_of_its_paragraph() {
    let text = "Why: `not_this`.\n\nEvidence: `one_law` (exact), as [`point`](fn@point),\n`another_law`.\n\n`nor_this`";
    assert_eq!(evidence(text), ["one_law", "another_law"]);
}

#[test]
fn status_kind_and_erratum_agree() {
    for (label, equation) in all_equations() {
        let status = equation.status.as_str();
        assert!(
            ["as-printed", "corrected", "reconstructed"].contains(&status),
            "{label}: {status}"
        );
        assert_eq!(
            equation.erratum.is_some(),
            status == "corrected",
            "{label}: an erratum, and only then `corrected`"
        );
        assert!(!equation.meaning.trim().is_empty(), "{label}");
        if let Some(erratum) = &equation.erratum {
            assert!(
                ["mathematical", "notational"].contains(&erratum.kind.as_str()),
                "{label}: {}",
                erratum.kind
            );
            assert_ne!(erratum.printed, equation.latex, "{label}: nothing corrected");
        }
    }
}

#[test]
fn ids_are_unique_and_begin_with_their_paper() {
    let mut seen = BTreeSet::new();
    for specification in specifications() {
        let equations = specification.equations.iter().chain(&specification.unnumbered);
        let errata = equations.filter_map(|equation| equation.erratum.as_ref());
        let claims = specification.claims.iter().map(|claim| &claim.id);
        for id in errata.map(|erratum| &erratum.id).chain(claims) {
            assert!(id.starts_with(&format!("{}-", specification.paper.key)), "{id}");
            assert!(is_kebab_case(id), "{id}");
            assert!(seen.insert(id.clone()), "{id} twice");
        }
        let names = specification.unnumbered.iter().flat_map(|e| &e.name);
        assert_unique(names.cloned());
    }
}

#[test]
fn latex_braces_and_environments_balance() {
    for (label, equation) in all_equations() {
        assert_eq!(unbalanced(&equation.latex), None, "{label}");
        if let Some(erratum) = &equation.erratum {
            assert_eq!(unbalanced(&erratum.printed), None, "{label}, as printed");
        }
    }
    for (text, wrong) in [
        (r"\frac{1}{2", "{"),
        (r"\left\{x\}", r"\left"),
        (r"\begin{cases}x\end{bmatrix}", r"\begin{cases}"),
        (r"x}\{", "}"),
    ] {
        assert_eq!(unbalanced(text).as_deref(), Some(wrong), "{text}");
    }
}

// The equation rooms: every public function says where it comes from

/// Public functions of the rooms that realise no equation, and why. Everything else has a printed number or a line `Source:`.
const WITHOUT_SOURCE: [(&str, &[&str]); 6] = [
    (
        "their name is their definition",
        &[
            "is_symmetric",
            "is_finite",
            "all_finite",
            "is_angle",
            "reports",
            "distance_from",
        ],
    ),
    (
        "they read or count what a rule holds",
        &[
            "sum_of_weights",
            "sum_of_absolute_weights",
            "effective_points",
            "distinct_points",
        ],
    ),
    (
        "they make, convert or look up a value",
        &[
            "zeros",
            "of_kappa",
            "from_exact",
            "exact",
            "rule",
            "rule_in",
            "nearest",
            "every_dimension",
        ],
    ),
    ("they write for people", &["monomial_name", "figure"]),
    (
        "they say or change what kind of filter, motion or sensor it is",
        &[
            "kalman",
            "points",
            "has_covariances",
            "linearises_the_measurement",
            "conversion",
            "rules",
            "rules_mut",
            "matrix_mut",
            "offset",
        ],
    ),
    (
        "they make, read or describe a model that is data",
        &[
            "number",
            "angle",
            "new",
            "components",
            "dimension",
            "names",
            "position",
            "check_names",
            "read",
            "results",
            "uses",
            "rational_at",
            "is_linear_in",
            "written",
            "of_matrix",
            "of_formulas",
            "formulas",
            "given",
            "is_linear",
            "of",
            "models",
            "model",
            "name",
        ],
    ),
];

#[test]
fn every_public_equation_names_its_number_or_its_source() {
    let excused: BTreeSet<&str> = WITHOUT_SOURCE
        .iter()
        .flat_map(|(_, names)| names.iter().copied())
        .collect();
    let mut used = BTreeSet::new();
    let mut missing = Vec::new();
    let is_public_function = |item: &Item| item.is_public && ["function", "method"].contains(&item.kind);
    let functions = items().into_iter().filter(is_public_function);
    for function in functions.filter(|item| is_equation_room(&item.path)) {
        let named = !headings(&function.doc).is_empty() || !citations(&first_sentence(&function.doc)).is_empty();
        let sourced = function.doc.lines().any(|line| line.starts_with("Source:"));
        if named || sourced {
            continue;
        }
        if excused.contains(function.short_name()) {
            used.insert(function.short_name().to_owned());
        } else {
            missing.push(format!("{}: {}", function.path, function.name));
        }
    }
    assert!(missing.is_empty(), "no number and no source: {missing:#?}");
    for name in excused {
        assert!(used.contains(name), "`{name}` needs no excuse: take it off the list");
    }
}

// Examples: what an equation does is shown by numbers that can be followed by hand

/// The rooms in which every public equation has an example that is run.
const ROOMS_WITH_EXAMPLES: [&str; 11] = [
    "src/gaussian.rs",
    "src/matrix.rs",
    "src/model/",
    "src/filter/",
    "src/imm/",
    "src/smoother/",
    "src/rule/",
    "src/steady/",
    "src/statistics/",
    "src/paper/",
    "src/oracle/",
];

#[test]
fn every_public_equation_has_an_example_that_is_run() {
    let mut checked = 0;
    for item in items().iter().filter(|item| item.is_public) {
        let is_checked = ROOMS_WITH_EXAMPLES.iter().any(|room| item.path.starts_with(room));
        let names_a_source = item.doc.lines().any(|line| line.starts_with("Source:"));
        if is_checked && (names_a_source || !headings(&item.doc).is_empty()) {
            assert_eq!(wrong_with_the_example(&item.doc), None, "{}: {}", item.path, item.name);
            checked += 1;
        }
    }
    assert!(checked > 80, "the rooms were read: {checked}");
}

#[test]
fn an_example_is_code_that_is_run_and_asserts_and_stands_in_its_place() {
    let with =
        |fence: &str, code: &str| format!("Name.\n\nExample: two.\n\n```{fence}\n{code}\n```\n\nEvidence: `a`.\n");
    assert_eq!(wrong_with_the_example(&with("", "assert_eq!(1 + 1, 2);")), None);
    for fence in ["text", "ignore", "no_run", "compile_fail"] {
        let doc = with(fence, "assert_eq!(1 + 1, 2);");
        assert_eq!(wrong_with_the_example(&doc), Some("it has none that is run"), "{fence}");
    }
    assert_eq!(wrong_with_the_example("Name."), Some("it has none that is run"));
    let silent = with("", "1 + 1;");
    assert_eq!(wrong_with_the_example(&silent), Some("it asserts nothing"));
    let late = "Errata: one.\n\n".to_owned() + &with("", "assert!(true);");
    let wrong = "`Example:` stands before errors, errata and evidence";
    assert_eq!(wrong_with_the_example(&late), Some(wrong));
    let unnamed = with("", "assert!(true);").replace("Example: two.", "Two.");
    assert_eq!(wrong_with_the_example(&unnamed), Some(wrong));
}

#[test]
fn the_map_names_a_room_that_realises_each_printed_number() {
    let items = items();
    let map = std::fs::read_to_string(root().join("src/lib.rs")).unwrap();
    let mut mapped = BTreeSet::new();
    for row in map.lines().filter(|line| line.starts_with("//! |")) {
        let rooms: Vec<String> = row
            .split("[`")
            .skip(1)
            .filter_map(|rest| rest.split_once("`]"))
            .map(|link| link.0.replace("::", "/"))
            .collect();
        for number in citations(row) {
            let is_room = |path: &str| rooms.iter().any(|room| path.starts_with(&format!("src/{room}")));
            let realises = |item: &Item| is_room(&item.path) && headings(&item.doc).contains(&number);
            assert!(items.iter().any(realises), "{number} is not in {rooms:?}");
            mapped.insert(number);
        }
    }
    let is_printed = |equation: &EquationReference| equation.label.parse::<u32>().is_ok();
    let printed: BTreeSet<EquationReference> = equations().into_iter().filter(is_printed).collect();
    assert_eq!(mapped, printed, "all of them, once or more");
}

/// Why a doc comment has no example that a reader can rely on; nothing if it has one.
fn wrong_with_the_example(doc: &str) -> Option<&'static str> {
    // Between the fences every other part is code; a fence without a word is one of Rust that is run.
    let is_run =
        |part: &&str| part.starts_with('\n') || part.starts_with("rust\n") || part.starts_with("should_panic\n");
    let examples: Vec<&str> = doc.split("```").skip(1).step_by(2).filter(is_run).collect();
    if examples.is_empty() {
        return Some("it has none that is run");
    }
    if !examples.iter().any(|code| code.contains("assert")) {
        return Some("it asserts nothing");
    }
    let place = |words: &[&str]| {
        doc.lines()
            .position(|line| words.iter().any(|word| line.starts_with(word)))
    };
    let is_in_place = match (
        place(&["Example:"]),
        place(&["# Errors", "Errata:", "Mistakes:", "Evidence:"]),
    ) {
        (Some(example), Some(after)) => example < after,
        (example, None) => example.is_some(),
        (None, Some(_)) => false,
    };
    (!is_in_place).then_some("`Example:` stands before errors, errata and evidence")
}

// Scenarios

#[test]
fn defaults_are_alternatives_and_names_are_unique() {
    for paper in Paper::ALL {
        let parameters = &paper.specification().parameters;
        assert_unique(parameters.iter().map(|parameter| parameter.name.clone()));
        for parameter in parameters {
            let names = || parameter.alternatives.iter().map(|a| a.name.clone());
            assert!(is_kebab_case(&parameter.name), "{}", parameter.name);
            assert!(
                names().any(|name| name == parameter.default),
                "{}: the default {} is no alternative",
                parameter.name,
                parameter.default
            );
            assert!(names().count() >= 2, "{} is not open", parameter.name);
            assert_unique(names());
        }
    }
}

#[test]
fn every_alternative_changes_the_scenario() {
    for paper in Paper::ALL {
        for parameter in &paper.specification().parameters {
            let mut texts = BTreeMap::new();
            for alternative in &parameter.alternatives {
                // In the scenario that has the parameter, where a paper has several.
                let simulation = match parameter.scenarios.first() {
                    Some(scenario) => Choices::of("scenario", scenario),
                    None => Choices::default(),
                };
                let choices = simulation.clone().with(&parameter.name, &alternative.name);
                let text = debug_text(paper, &choices);
                if alternative.name == parameter.default {
                    // Otherwise a difference would mean nothing.
                    assert!(text == debug_text(paper, &simulation), "{}", choices.describe());
                }
                if let Some(other) = texts.insert(text, &alternative.name) {
                    panic!(
                        "{}: {} is the same for {other} and {}",
                        paper.key(),
                        parameter.name,
                        alternative.name
                    );
                }
            }
        }
    }
}

#[test]
fn the_constants_of_zhu2016_are_the_printed_ones() {
    let mut printed = printed_table("zhu2016");
    assert_turn_rate(&mut printed, zhu2016::TURN_RATE);
    let scenario = default_scenario(Paper::Zhu2016);
    let [right, left] = turns(&scenario);
    let Sensor::Linear(h) = &scenario.sensor else {
        panic!("(62) is linear");
    };
    let g = acceleration_input(&scenario.interval);
    let mut code = toml::Table::new();
    let mut put = |key: &str, value: toml::Value| {
        code.insert(key.to_owned(), value);
    };
    put("models", modes(&scenario));
    put("filters", filters(&scenario, &printed));
    put("sampling-interval", zhu2016::INTERVAL.into());
    put("steps", integer(scenario.schedule.len()));
    put("runs", integer(scenario.runs));
    put("initial-state", scenario.initial_state.as_slice().to_vec().into());
    let variances = scenario.initial_covariance.diagonal();
    put("initial-covariance-diagonal", variances.as_slice().to_vec().into());
    put(
        "acceleration-noise-diagonal",
        vec![zhu2016::ACCELERATION_VARIANCE; 2].into(),
    );
    put(
        "noise-input",
        rows(g.row_iter().map(|row| row.iter().copied().collect())),
    );
    put(
        "measurement-matrix",
        rows(h.row_iter().map(|row| row.iter().copied().collect())),
    );
    put(
        "measurement-noise-diagonal",
        zhu2016::MEASUREMENT_VARIANCES.to_vec().into(),
    );
    // "During 20 s ~ 40 s": the step at 40 s is the first that is straight again.
    put("right-turn-seconds", vec![right.0, right.1 + 1].into());
    put("left-turn-seconds", vec![left.0, left.1 + 1].into());
    put("transition", rows(zhu2016::TRANSITION.iter().map(|row| row.to_vec())));
    assert_eq!(code, printed);
}

#[test]
fn the_constants_of_liu2017_are_the_printed_ones() {
    let mut printed = printed_table("liu2017");
    assert_turn_rate(&mut printed, liu2017::TURN_RATE);
    let scenario = default_scenario(Paper::Liu2017);
    let [right, left] = turns(&scenario);
    let Sensor::Polar { location: sensor, .. } = &scenario.sensor else {
        panic!("(31) is range and bearing");
    };
    let mut code = toml::Table::new();
    let mut put = |key: &str, value: toml::Value| {
        code.insert(key.to_owned(), value);
    };
    put("models", modes(&scenario));
    put("filters", filters(&scenario, &printed));
    put("sampling-interval", liu2017::INTERVAL.into());
    put("first-second", integer(liu2017::FIRST_SECOND));
    put("last-second", integer(liu2017::LAST_SECOND));
    put("initial-velocity", liu2017::INITIAL_VELOCITY.to_vec().into());
    put("initial-x", scenario.initial_state[0].into());
    put("right-turn-seconds", vec![right.0, right.1].into());
    put("left-turn-seconds", vec![left.0, left.1].into());
    put("noise-density-constant-velocity", liu2017::NOISE_DENSITY.into());
    put("noise-density-turn", liu2017::NOISE_DENSITY.into());
    put("range-deviation", scenario.measurement_deviations[0].into());
    put("bearing-deviation", scenario.measurement_deviations[1].into());
    put("radar", sensor.to_vec().into());
    put("initial-probabilities", liu2017::INITIAL_PROBABILITIES.to_vec().into());
    put("transition", rows(liu2017::TRANSITION.iter().map(|row| row.to_vec())));
    assert_eq!(code, printed);
}

#[test]
fn the_constants_of_derbez2000_are_the_printed_ones() {
    let printed = printed_table("derbez2000");
    let of_choices = |choices: &Choices| derbez2000::scenario(choices).unwrap();
    let manoeuvres = of_choices(&Choices::default());
    let acceleration = of_choices(&Choices::of("scenario", "acceleration"));
    let imm = &manoeuvres.contestants[0];
    let mut code = toml::Table::new();
    let mut put = |key: &str, value: toml::Value| {
        code.insert(key.to_owned(), value);
    };
    let modes = imm.problems[0].modes.iter().map(|mode| mode.name.clone());
    put("models", modes.collect::<Vec<_>>().into());
    let filters = manoeuvres.contestants.iter().map(|filter| filter.name.clone());
    put("filters", filters.collect::<Vec<_>>().into());
    put("runs", integer(manoeuvres.runs));
    // The truth itself: its acceleration, and the step at which it is nearest to the radar.
    let places = &acceleration.path.places;
    let distance = |k: usize| places[k][0][0].hypot(places[k][1][0]);
    let nearest = (0..places.len())
        .min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
        .unwrap();
    assert!(
        places
            .iter()
            .all(|place| place[0][2].to_bits() == derbez2000::ACCELERATION.to_bits())
    );
    put("acceleration", derbez2000::ACCELERATION.into());
    put("scan-time", acceleration.setup.interval.into());
    put("closest-approach", distance(nearest).into());
    put("closest-point", integer(nearest + 1));
    put("points", integer(places.len()));
    put("phases", derbez2000::PHASES.map(integer).to_vec().into());
    assert_eq!(manoeuvres.path.places.len(), derbez2000::PHASES.iter().sum::<usize>());
    let [range, bearing] = manoeuvres.variances;
    put("range-variance", range.into());
    put("bearing-variance", bearing.into());
    put("initial-probabilities", imm.initial_probabilities.clone().into());
    put("initial-covariance-diagonal", vec![imm.initial_variance; 3].into());
    let counts = |counts: [u32; 3]| -> toml::Value { counts.map(i64::from).to_vec().into() };
    put("operations-section-4", counts(derbez2000::OPERATIONS_OF_SECTION_4));
    put("operations-section-4-1", counts(derbez2000::OPERATIONS_OF_SECTION_4_1));
    put("transition", rows(imm.problems[0].chain.iter().cloned()));
    assert_eq!(code, printed);
}

#[test]
fn the_constants_of_sustika2015_are_the_printed_ones() {
    let mut printed = printed_table("sustika2015");
    let of_scenario = |name: &str| sustika2015::scenario(&Choices::of("scenario", name)).unwrap();
    let (matched, mismatched) = (of_scenario("matched-straight"), of_scenario("mismatched-straight"));
    for (key, radians) in [
        ("bearing-deviation-degrees", matched.setup.deviations[1]),
        ("filter-bearing-deviation-degrees", mismatched.setup.deviations[1]),
    ] {
        let degrees = printed.remove(key).unwrap().as_float().unwrap();
        // The same product as in the constant, so the same double.
        assert_eq!((degrees * sustika2015::DEGREE).to_bits(), radians.to_bits());
    }
    let imm = &matched.contestants[0];
    let truth = matched.trajectory.draw(0, 1).truth;
    let mut code = toml::Table::new();
    let mut put = |key: &str, value: toml::Value| {
        code.insert(key.to_owned(), value);
    };
    let modes = imm.problem.modes.iter().map(|mode| mode.name.clone());
    put("models", modes.collect::<Vec<_>>().into());
    let filters = matched.contestants.iter().map(|filter| filter.name.to_owned());
    put("filters", filters.collect::<Vec<_>>().into());
    put("sampling-interval", sustika2015::INTERVAL.into());
    put("duration", integer(truth.len()));
    put("runs", integer(sustika2015::RUNS));
    put("radar", sustika2015::RADAR.to_vec().into());
    put("initial-position", vec![truth[0][0], truth[0][1]].into());
    put("initial-velocity", vec![truth[0][2], truth[0][3]].into());
    assert_eq!(
        sustika2015::NOISE_DENSITY.to_bits(),
        matched.setup.noise_density.to_bits()
    );
    put("noise-density", matched.setup.noise_density.into());
    put("range-deviation", matched.setup.deviations[0].into());
    let seconds = |[first, last]: [usize; 2]| toml::Value::from(vec![integer(first), integer(last)]);
    put(
        "manoeuvring-seconds",
        sustika2015::MANOEUVRING_SECONDS.map(seconds).to_vec().into(),
    );
    put("filter-noise-density", mismatched.setup.noise_density.into());
    put("filter-range-deviation", mismatched.setup.deviations[0].into());
    put("transition", rows(imm.problem.chain.iter().cloned()));
    put(
        "initial-probabilities",
        sustika2015::INITIAL_PROBABILITIES.to_vec().into(),
    );
    put(
        "initial-velocity-estimate",
        sustika2015::INITIAL_VELOCITY_ESTIMATE.to_vec().into(),
    );
    put(
        "swept-noise-densities",
        sustika2015::SWEPT_NOISE_DENSITIES.to_vec().into(),
    );
    put(
        "swept-bearing-deviations-degrees",
        sustika2015::SWEPT_BEARING_DEGREES.to_vec().into(),
    );
    put("good-fit-error", sustika2015::GOOD_FIT_ERROR.into());
    assert_eq!(code, printed);
}

#[test]
fn parameters_of_one_scenario_change_that_one() {
    for paper in [Paper::Derbez2000, Paper::Sustika2015] {
        let parameters = &paper.specification().parameters;
        let text = |choices: &Choices| debug_text(paper, choices);
        let scenarios = parameters
            .iter()
            .find(|parameter| parameter.name == "scenario")
            .unwrap();
        for scenario in scenarios.alternatives.iter().map(|alternative| &alternative.name) {
            let unchanged = text(&Choices::of("scenario", scenario));
            for parameter in parameters.iter().filter(|parameter| parameter.name != "scenario") {
                let belongs = parameter.belongs_to(scenario);
                for alternative in parameter.alternatives.iter().filter(|a| a.name != parameter.default) {
                    let choices = Choices::of("scenario", scenario).with(&parameter.name, &alternative.name);
                    assert_eq!(text(&choices) != unchanged, belongs, "{}", choices.describe());
                }
            }
        }
    }
}

#[test]
fn published_tables_are_rectangular_and_name_filters_that_are_run() {
    for paper in Paper::ALL {
        let filters = paper.simulation(&Choices::default()).unwrap().filters();
        for table in &paper.specification().tables {
            for row in &table.rows {
                assert_eq!(row.values.len(), table.columns.len(), "{}", row.name);
            }
            for column in &table.columns {
                let is_run = |name: &str| name.starts_with(column.as_str());
                assert!(filters.iter().any(|filter| is_run(&filter.name)), "{column}");
            }
        }
    }
}

// Claims

#[test]
fn every_claim_has_exactly_one_judgement() {
    // Enough runs for a standard error; the verdicts themselves are not looked at.
    let effort = Effort { runs: Some(3), seed: 1 };
    for paper in Paper::ALL {
        let judgements = paper.judge(effort, &|| ()).unwrap();
        let judged: Vec<&str> = judgements.iter().map(|judgement| judgement.id.as_str()).collect();
        let claims: Vec<&str> = paper
            .specification()
            .claims
            .iter()
            .map(|claim| claim.id.as_str())
            .collect();
        assert_eq!(judged, claims, "in the order of the file");
        for judgement in &judgements {
            assert!(!judgement.evidence.trim().is_empty(), "{}", judgement.id);
        }
    }
}

#[test]
fn every_name_in_the_notation_exists_in_the_source() {
    let notation = std::fs::read_to_string(root().join("spec/notation.md")).unwrap();
    let source: String = source_files().iter().map(|file| file.text).collect();
    let words: BTreeSet<&str> = source
        .split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
        .collect();
    let names = notation
        .lines()
        .filter(|line| line.starts_with('|'))
        .filter_map(|line| line.split('|').nth(3))
        .flat_map(backticked);
    for name in names {
        assert!(words.contains(name.as_str()), "spec/notation.md: `{name}`");
    }
}

// How both halves are read

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// What is held against the source: the specifications of all papers.
fn specifications() -> Vec<&'static Specification> {
    Vec::from(Paper::ALL.map(Paper::specification))
}

/// Every item of the source that has a doc comment.
fn items() -> Vec<Item> {
    source_files().iter().flat_map(|file| items_of(file).unwrap()).collect()
}

/// The comment at the head of a file.
fn head(text: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix("//!"));
    lines.fold(String::new(), |head, line| head + line.trim_start() + "\n")
}

/// The tests that a doc comment names.
fn evidence(doc: &str) -> Vec<String> {
    Doc::read(doc).evidence().into_iter().map(|named| named.test).collect()
}

fn first_sentence(doc: &str) -> String {
    doc.lines()
        .take_while(|line| !line.is_empty())
        .collect::<Vec<_>>()
        .join(" ")
}

/// The folders and files that hold equations.
fn is_equation_room(path: &str) -> bool {
    const ROOMS: [&str; 10] = [
        "src/gaussian.rs",
        "src/matrix.rs",
        "src/rule/",
        "src/model/",
        "src/filter/",
        "src/imm/probability.rs",
        "src/smoother/rauch_tung_striebel.rs",
        "src/smoother/switching.rs",
        "src/paper/zhu2016/diagonal_mixing.rs",
        "src/statistics/",
    ];
    ROOMS.iter().any(|room| path.starts_with(room))
}

/// All rows of the specification, with a number or a name.
fn equations() -> BTreeSet<EquationReference> {
    let of = |paper: Paper| {
        let specification = paper.specification();
        let equations = specification.equations.iter().chain(&specification.unnumbered);
        equations.map(move |equation| match equation.number {
            Some(number) => EquationReference::new(paper, number),
            None => EquationReference::new(paper, equation.name.as_deref().unwrap_or_default()),
        })
    };
    Paper::ALL.into_iter().flat_map(of).collect()
}

/// Every equation with a label for messages.
fn all_equations() -> Vec<(String, &'static PublishedEquation)> {
    let of = |specification: &'static Specification| {
        let equations = specification.equations.iter().chain(&specification.unnumbered);
        equations.map(|equation| {
            let number = equation.number.map(|number| format!("({number})"));
            let name = number.or_else(|| equation.name.clone()).unwrap_or_default();
            (format!("{} {name}", specification.paper.key), equation)
        })
    };
    specifications().into_iter().flat_map(of).collect()
}

/// The first brace, `\left`/`\right` or environment without its partner.
fn unbalanced(latex: &str) -> Option<String> {
    let mut open: Vec<String> = Vec::new();
    let close = |opening: String, closing: &str, open: &mut Vec<String>| {
        (open.pop().as_ref() != Some(&opening)).then(|| closing.to_owned())
    };
    let mut rest = latex;
    while let Some(at) = rest.find(['{', '}', '\\']) {
        rest = &rest[at..];
        let command: String = match rest.strip_prefix('\\') {
            Some(name) => {
                let letters = name.chars().take_while(char::is_ascii_alphabetic).count();
                rest[..=letters.max(1)].to_owned()
            }
            None => rest[..1].to_owned(),
        };
        rest = &rest[command.len()..];
        let argument = || format!("{{{}}}", rest.trim_start_matches('{').split('}').next().unwrap_or(""));
        let wrong = match command.as_str() {
            "{" | r"\left" => {
                open.push(command);
                None
            }
            r"\begin" => {
                open.push(format!("{command}{}", argument()));
                None
            }
            "}" => close("{".to_owned(), "}", &mut open),
            r"\right" => close(r"\left".to_owned(), r"\right", &mut open),
            r"\end" => {
                let expected = open.pop();
                (expected.as_deref() != Some(&format!(r"\begin{}", argument()))).then(|| expected.unwrap_or(command))
            }
            _ => None,
        };
        if wrong.is_some() {
            return wrong;
        }
    }
    open.pop()
}

fn is_kebab_case(name: &str) -> bool {
    !name.is_empty()
        && name
            .split('-')
            .all(|word| !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit()))
}

fn assert_unique(names: impl Iterator<Item = String>) {
    let mut seen = BTreeSet::new();
    for name in names {
        assert!(seen.insert(name.clone()), "{name} twice");
    }
}

fn default_scenario(paper: Paper) -> Scenario {
    paper.scenario(&Choices::default()).unwrap()
}

/// Everything in a simulation but the names of its choices.
fn debug_text(paper: Paper, choices: &Choices) -> String {
    let simulation = paper.simulation(choices).unwrap();
    let names = format!("{:?}", simulation.choices());
    format!("{simulation:?}").replace(&names, "")
}

/// The table `[printed]` of a paper's scenario.
fn printed_table(paper: &str) -> toml::Table {
    let path = root().join("spec").join(paper).join("scenario.toml");
    let file: toml::Table = std::fs::read_to_string(path).unwrap().parse().unwrap();
    file["printed"].as_table().unwrap().clone()
}

/// The turn rate is printed in degrees and kept in radians a second; it is taken off the table.
fn assert_turn_rate(printed: &mut toml::Table, rate: f64) {
    let degrees = printed.remove("turn-rate-degrees").unwrap().as_float().unwrap();
    // The same two operations as in the constant, so the same double.
    assert_eq!((degrees * std::f64::consts::PI / 180.0).to_bits(), rate.to_bits());
}

/// The first and the last second of the right and of the left turn.
fn turns(scenario: &Scenario) -> [(i64, i64); 2] {
    [Course::RightTurn, Course::LeftTurn].map(|turn| {
        let steps = || (0..scenario.schedule.len()).filter(|&k| scenario.schedule[k] == turn);
        let (first, last) = (steps().min().unwrap(), steps().max().unwrap());
        assert_eq!(steps().count(), last - first + 1, "one turn to each side");
        let second = |k: usize| scenario.time(k).to_string().parse().unwrap();
        (second(first), second(last))
    })
}

fn modes(scenario: &Scenario) -> toml::Value {
    let modes = scenario.contestants[0].problem.modes.iter();
    modes.map(|mode| mode.name.clone()).collect::<Vec<_>>().into()
}

/// The printed name of each contestant; a stand-in says so after it.
fn filters(scenario: &Scenario, printed: &toml::Table) -> toml::Value {
    let known: Vec<&str> = printed["filters"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|name| name.as_str())
        .collect();
    let contestants = scenario.contestants.iter();
    contestants
        .map(|contestant| {
            let stands_in_for = |name: &&str| contestant.name == format!("{name} (stand-in)");
            known
                .iter()
                .copied()
                .find(stands_in_for)
                .unwrap_or(&contestant.name)
                .to_owned()
        })
        .collect::<Vec<_>>()
        .into()
}

fn rows(rows: impl Iterator<Item = Vec<f64>>) -> toml::Value {
    rows.map(toml::Value::from).collect::<Vec<_>>().into()
}

fn integer(value: usize) -> toml::Value {
    i64::try_from(value).unwrap().into()
}
