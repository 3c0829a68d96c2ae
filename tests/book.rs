//! Goal: the book of equations is whole: every equation has its code, its tests, and the mistakes and cases that hold it, and every link in
//! the book leads somewhere.
//!
//! Method: the book is built as a reader gets it, from the files inside the program, and every entry and every tag is looked at. Each check
//! is a function of what it checks, and is shown to complain about something that is spoilt. Kind of evidence: traceability, by exhaustion;
//! the sentences themselves are read by people.

use immaculate::book::doc::{Doc, PartKind};
use immaculate::book::find::find;
use immaculate::book::markup::plain;
use immaculate::book::source::{File, items_of, source_files, test_files};
use immaculate::book::{Entry, Realisation, entries, entries_of, realisations};
use immaculate::imm::Quantity;
use immaculate::oracle::variant::{Applies, Kind, catalogue};
use immaculate::oracle::{case, problem::ProblemFile};
use immaculate::paper::Paper;
use immaculate::report::page::{book as html, markup};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

// What an equation has

#[test]
fn every_equation_has_code_and_a_test() {
    assert_eq!(entries().len(), 190);
    for entry in entries() {
        assert_eq!(lacks(entry), Vec::<&str>::new(), "{}", entry.reference);
    }
    let mut spoilt = entries()[0].clone();
    spoilt.evidence.clear();
    assert_eq!(lacks(&spoilt), ["test"]);
    spoilt.realisations.clear();
    assert_eq!(lacks(&spoilt), ["code", "test"]);
}

/// What a test is evidence of is worth as much as its kind. Of one that no item names, an erratum's, its file says the kind.
#[test]
fn every_test_of_an_equation_has_a_kind_of_evidence() {
    let kinds = [
        "exact",
        "symbolic",
        "enclosed",
        "property",
        "statistics",
        "traceability",
    ];
    for entry in entries() {
        for evidence in &entry.evidence {
            let word = evidence.kind.split([' ', ',']).next().unwrap();
            assert!(kinds.contains(&word), "{}: {evidence:?}", entry.reference);
        }
    }
    let of_erratum = "without_noise_in_the_gain_calculation_the_mismatched_error_is_not_bounded";
    let mut all = entries().iter().flat_map(|entry| &entry.evidence);
    assert_eq!(all.find(|evidence| evidence.test == of_erratum).unwrap().kind, "exact");
}

/// An item has its own evidence and that of the items which it names, the nearest ones of their names; an equation that of its items and
/// of its erratum.
#[test]
fn the_evidence_of_an_equation_is_that_of_its_items_and_of_those_they_name() {
    fn of_item(realisation: &Realisation) -> BTreeSet<String> {
        let mut tests: BTreeSet<String> = realisation.doc.evidence().into_iter().map(|named| named.test).collect();
        for name in realisation.doc.evidence_of() {
            let of_name = || realisations().iter().filter(|other| other.item.name == name);
            let near = of_name().find(|other| other.item.path == realisation.item.path);
            let other = near.or_else(|| of_name().next()).unwrap_or_else(|| panic!("no {name}"));
            tests.extend(of_item(other));
        }
        tests
    }
    let mut by_another = 0;
    for entry in entries() {
        let mut expected: BTreeSet<String> = entry.realisations.iter().flat_map(|item| of_item(item)).collect();
        expected.extend(entry.equation.erratum.iter().filter_map(|erratum| erratum.test.clone()));
        let found: BTreeSet<String> = entry.evidence.iter().map(|evidence| evidence.test.clone()).collect();
        assert_eq!(found, expected, "{}", entry.reference);
        by_another += usize::from(entry.realisations.iter().any(|item| !item.doc.evidence_of().is_empty()));
    }
    assert!(by_another > 10, "{by_another}");
}

#[test]
fn every_equation_is_caught_by_a_case_or_says_why_none_can() {
    let cases: BTreeSet<&str> = case::all().unwrap().iter().map(|case| id_of(&case.problem)).collect();
    for entry in entries() {
        assert_eq!(tie(entry, &cases), Ok(()), "{}", entry.reference);
    }
    let within = &find("zhu2016 56").unwrap()[0];
    let outside = &find("zhu2016 64").unwrap()[0];
    let spoil = |entry: &Entry, change: fn(&mut Entry)| {
        let mut spoilt = entry.clone();
        change(&mut spoilt);
        tie(&spoilt, &cases).unwrap_err()
    };
    assert_eq!(spoil(within, |entry| entry.mistakes.clear()), "no mistake");
    assert_eq!(
        spoil(within, |entry| entry.quantities.clear()),
        "a quantity that is none"
    );
    assert_eq!(tie(within, &BTreeSet::new()).unwrap_err(), "a case that is none");
    let with = |entry: &Entry, outside: Option<&str>, mistakes: &[&str]| {
        let mut equation = entry.equation.clone();
        equation.outside = outside.map(ToOwned::to_owned);
        equation.mistakes = mistakes.iter().map(|id| (*id).to_owned()).collect();
        let equation = Box::leak(Box::new(equation));
        tie(
            &Entry {
                equation,
                ..entry.clone()
            },
            &cases,
        )
        .unwrap_err()
    };
    assert_eq!(with(within, Some("A reason."), &[]), "both or neither");
    assert_eq!(with(outside, None, &[]), "both or neither");
    assert_eq!(with(outside, Some("a word"), &[]), "no sentence");
    assert_eq!(
        with(within, None, &["mixed-spread-omitted", "update-subtracted"]),
        "a mistake that is not made in it"
    );
}

/// An equation's entry lists first the mistakes in it, and then the wrong inputs that it may get.
#[test]
fn mistakes_of_reading_come_after_those_of_the_equation() {
    let has_both = |entry: &&Entry| {
        [true, false]
            .iter()
            .all(|input| entry.mistakes.iter().any(|variant| variant.input == *input))
    };
    assert!(entries().iter().filter(has_both).count() > 10);
    for entry in entries() {
        assert!(
            entry.mistakes.is_sorted_by_key(|variant| variant.input),
            "{}",
            entry.reference
        );
    }
}

#[test]
fn every_mistake_of_the_catalogue_is_made_in_an_equation_of_a_paper() {
    let made: BTreeSet<&str> = entries()
        .iter()
        .flat_map(|entry| entry.mistakes.iter().map(|variant| variant.id.as_str()))
        .collect();
    let in_none: Vec<&str> = catalogue()
        .iter()
        .filter(|variant| variant.kind != Kind::Form)
        // No paper linearises, has steps that differ, an angle in the state, modes with states of their own, correlated noises, modes that
        // all start from the combined estimate, or a chain in continuous time.
        .filter(|variant| {
            !matches!(
                variant.applies,
                Applies::Linearised
                    | Applies::ChangingSteps
                    | Applies::StateAngles
                    | Applies::StateConversions
                    | Applies::CorrelatedNoises
                    | Applies::CommonStart
                    | Applies::Rates
                    | Applies::SojournTimes
            )
        })
        .map(|variant| variant.id.as_str())
        .filter(|id| !made.contains(id))
        .collect();
    assert_eq!(in_none, Vec::<&str>::new());
}

#[test]
fn the_words_for_where_a_variant_applies_are_those_of_the_file() {
    let words: BTreeSet<&str> = catalogue().iter().map(|variant| variant.applies.name()).collect();
    for variant in catalogue() {
        assert_eq!(serde_json::json!(variant.applies), variant.applies.name());
    }
    for paper in Paper::ALL {
        let used = paper.specification().applies.iter();
        let of_rows = entries()
            .iter()
            .filter_map(|entry| entry.equation.applies.as_ref())
            .flatten();
        for word in used.chain(of_rows) {
            assert!(words.contains(word.as_str()), "{}: {word}", paper.key());
        }
    }
}

#[test]
fn the_mixed_covariance_has_everything() {
    let found = find("zhu2016 (56)").unwrap();
    let [entry] = found.as_slice() else {
        panic!("one equation");
    };
    let [realisation] = entry.realisations.as_slice() else {
        panic!("one function");
    };
    assert_eq!(realisation.item.name, "mixture_covariance");
    assert_eq!(realisation.item.path, "src/gaussian.rs");
    assert!(
        realisation
            .item
            .code
            .starts_with("pub fn mixture_covariance<T: Field, N: Dim>(\n")
    );
    assert!(realisation.item.code.ends_with("    sum\n}\n"));
    let derivation: Vec<&str> = realisation.doc.of(PartKind::Derivation).collect();
    assert!(
        derivation[0].starts_with("Why: law of total covariance"),
        "{derivation:?}"
    );
    assert_eq!(realisation.doc.of(PartKind::Formula).count(), 1);
    assert_eq!(realisation.doc.of(PartKind::Dictionary).count(), 1);
    let test = &entry.evidence[0];
    assert_eq!(test.test, "mixed_moments_are_those_of_the_mixture");
    assert_eq!(
        (test.kind.as_str(), test.path.as_str()),
        ("symbolic", "tests/symbolic.rs")
    );
    assert_eq!(entry.quantities, [Quantity::MixedCovariance]);
    let mistakes: Vec<&str> = entry.mistakes.iter().map(|variant| variant.id.as_str()).collect();
    assert_eq!(mistakes[0], "mixed-spread-omitted");
    // Of filters whose states have unequal dimensions, which zhu2016 has not.
    assert!(!mistakes.contains(&"unequal-dimensions-index-wise"), "{mistakes:?}");
    assert!(entry.cases().contains(&"mixing.two-modes"));
}

// Formulas

#[test]
fn every_formula_is_mathml() {
    for entry in entries() {
        let printed = entry.equation.erratum.iter().map(|erratum| &erratum.printed);
        for latex in printed.chain([&entry.equation.latex]) {
            let math = markup::math(latex).unwrap_or_else(|error| panic!("{}: {error}", entry.reference));
            let math = math.into_string();
            assert!(math.starts_with("<math display=\"block\""), "{math}");
            assert!(!math.contains("merror"), "{}: {math}", entry.reference);
            let (shown, kept) = math.split_once("application/x-tex\">").unwrap();
            assert!(
                !shown.contains("&amp;"),
                "{}: no character is shown by its name: {shown}",
                entry.reference
            );
            let kept = kept.split_once("</annotation>").unwrap().0;
            let kept = kept.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
            assert_eq!(&kept, latex, "{}", entry.reference);
            assert_eq!(markup::formula(latex).into_string(), math, "{}", entry.reference);
        }
    }
    for wrong in [
        r"\frac{1}{2",
        r"\nosuch{x}",
        r"\begin{cases}x\end{bmatrix}",
        "x}",
        r"\left(x",
    ] {
        assert!(markup::math(wrong).is_err(), "{wrong}");
    }
}

// The book as HTML

static BOOK: LazyLock<String> = LazyLock::new(|| {
    let chapters = Paper::ALL.map(|paper| html::chapter(paper).into_string());
    chapters.concat() + &html::index().into_string()
});

#[test]
fn every_equation_has_a_section_and_every_link_leads_somewhere() {
    assert_eq!(broken_links(&BOOK), Vec::<String>::new());
    assert_eq!(repeated_ids(&BOOK), Vec::<String>::new());
    for entry in entries() {
        let section = format!("<section class=\"equation\" id=\"{}\">", entry.anchor());
        assert_eq!(BOOK.matches(&section).count(), 1, "{}", entry.reference);
        let links = BOOK.matches(&format!("href=\"#{}\"", entry.anchor())).count();
        assert!(
            links >= 2,
            "{}: from the index, and back from its code",
            entry.reference
        );
    }
    assert_eq!(broken_links(r##"<a href="#a"></a><p id="b">"##), ["a"]);
    assert_eq!(repeated_ids(r#"<p id="a"><p id="b"><p id="a">"#), ["a"]);
}

#[test]
fn the_code_of_an_item_stands_once_in_a_paper() {
    for realisation in realisations() {
        // Where the index leads.
        let id = format!("id=\"{}\"", realisation.item.anchor());
        assert_eq!(BOOK.matches(&id).count(), 1, "{id}");
    }
    for paper in Paper::ALL {
        let of_paper: BTreeSet<String> = entries_of(paper)
            .flat_map(|entry| entry.realisations.iter().map(|one| one.item.anchor()))
            .collect();
        let chapter = html::chapter(paper).into_string();
        assert_eq!(
            chapter.matches("class=\"source-code\"").count(),
            of_paper.len(),
            "{}",
            paper.key()
        );
    }
}

#[test]
fn headings_nest_and_tables_say_what_they_are() {
    assert_eq!(jumps(&format!("<h2>{}", *BOOK)), Vec::<String>::new());
    assert_eq!(jumps("<h2><h3><h5>"), ["h3 to h5"]);
    assert_eq!(bare_tables(&BOOK), 0);
    assert_eq!(bare_tables("<table><thead><tr><th>a</th></tr></thead></table>"), 2);
    for word in [" style=", "<script", "javascript:", " onclick"] {
        assert!(!BOOK.contains(word), "{word}");
    }
    // What a browser and a reader can take at once.
    assert!(BOOK.len() < 3_000_000, "{} bytes", BOOK.len());
}

#[test]
fn tags_are_closed_in_the_order_in_which_they_were_opened() {
    assert_eq!(unbalanced(&BOOK), None);
    assert_eq!(unbalanced("<p><b></p></b>").as_deref(), Some("b closed by p"));
    assert_eq!(unbalanced("<p><br>").as_deref(), Some("p"));
}

// The source inside the program

#[test]
fn the_program_shows_the_files_as_they_are() {
    let of_program: BTreeMap<String, &str> = source_files()
        .into_iter()
        .chain(test_files())
        .map(|file| (file.path, file.text))
        .collect();
    let mut on_disk = BTreeMap::new();
    for folder in ["src", "tests"] {
        rust_files(&root().join(folder), &mut on_disk);
    }
    // Cargo does not see a file that is new: a change of the file that takes the folders in does it.
    let again = "a file is new or gone since the program was built; `touch src/book/source.rs`, and again";
    assert!(of_program.keys().eq(on_disk.keys()), "{again}");
    for (path, text) in &on_disk {
        assert!(
            of_program[path] == text,
            "{path} was changed after the program was built"
        );
    }
}

#[test]
fn items_are_shown_with_their_own_code_and_place() {
    for realisation in realisations() {
        let item = &realisation.item;
        let text = std::fs::read_to_string(root().join(&item.path)).unwrap();
        let line = text.lines().nth(item.line - 1).unwrap();
        assert!(line.contains(item.short_name()), "{}:{}: {line}", item.path, item.line);
        assert!(
            !item.code.trim().is_empty() && !item.code.starts_with("///"),
            "{}",
            item.name
        );
        let last = item.code.lines().last().unwrap();
        assert!(text.contains(last), "{}: {last}", item.name);
    }
    let file = File {
        path: "src/example.rs".to_owned(),
        text: concat!(
            "/// Outer.\n#[derive(Debug)]\npub struct Of<T> {\n    /// Inner.\n    pub part: T,\n}\n\n",
            "impl<T> Of<T> {\n    /// What it does.\n    ///\n    /// More.\n    fn does(&self) {\n        // in a comment\n    }\n}\n",
            "/// A choice.\npub enum Choice {\n    /// One.\n    One,\n    Two,\n}\n",
            "/// Short.\ntype Short = u8;\n/// Kept.\npub static KEPT: u8 = 1;\n/// Fixed.\nconst FIXED: u8 = 2;\n",
            "/// Able.\npub trait Able {\n    /// Can.\n    fn can(&self);\n}\n",
            "mod inner {\n    impl super::Choice {\n        /// All.\n        pub const ALL: u8 = 3;\n    }\n}\n",
        ),
    };
    let items = items_of(&file).unwrap();
    let told: Vec<_> = items
        .iter()
        .map(|item| {
            (
                item.name.as_str(),
                item.kind,
                item.line,
                item.is_public,
                item.code.as_str(),
            )
        })
        .collect();
    let of_code = "#[derive(Debug)]\npub struct Of<T> {\n    /// Inner.\n    pub part: T,\n}\n";
    let choice = "pub enum Choice {\n    /// One.\n    One,\n    Two,\n}\n";
    let does = "fn does(&self) {\n    // in a comment\n}\n";
    assert_eq!(
        told,
        [
            ("Of", "type", 3, true, of_code),
            ("Of::part", "field", 5, true, "pub part: T,\n"),
            ("Of::does", "method", 12, false, does),
            ("Choice", "type", 17, true, choice),
            ("Choice::One", "variant", 19, true, "One,\n"),
            ("Short", "type", 23, false, "type Short = u8;\n"),
            ("KEPT", "constant", 25, true, "pub static KEPT: u8 = 1;\n"),
            ("FIXED", "constant", 27, false, "const FIXED: u8 = 2;\n"),
            (
                "Able",
                "trait",
                29,
                true,
                "pub trait Able {\n    /// Can.\n    fn can(&self);\n}\n"
            ),
            ("Able::can", "method", 31, true, "fn can(&self);\n"),
            ("Choice::ALL", "constant", 36, true, "pub const ALL: u8 = 3;\n"),
        ]
    );
    assert_eq!(items[2].doc, "What it does.\n\nMore.\n");
    assert!(
        items_of(&File {
            path: String::new(),
            text: "fn ("
        })
        .is_err()
    );
}

#[test]
fn a_doc_comment_is_split_into_its_parts() {
    let doc = Doc::read(concat!(
        "Name, y = x — zhu2016 (54), derbez2000 (mixed-mean): a remark.\n\n",
        "```text\na = b\n\nc = d\n```\n\n| paper | here |\n|---|---|\n| a | `b` |\n\n",
        "Some reason.\n\nWhy: it is so,\nand so.\n\n# Errors\n\n[`Wrong`] for this.\n\nAnd that.\n\nErrata: none.\n\n",
        "# Examples\n\n```\nuse it;\n```\n\nEvidence: `one` (exact), `two`, as [`point`](fn@point),\n`three` (symbolic,\nall n), `four`.\n\n`nor_this`",
    ));
    assert_eq!(doc.title, "Name, y = x");
    assert_eq!(doc.remark, "a remark.");
    let realised: Vec<String> = doc.realises.iter().map(ToString::to_string).collect();
    assert_eq!(realised, ["zhu2016 (54)", "derbez2000 (mixed-mean)"]);
    let parts: Vec<_> = doc.parts.iter().map(|part| (part.kind, part.text.as_str())).collect();
    assert_eq!(
        parts[..8],
        [
            (PartKind::Formula, "a = b\n\nc = d"),
            (PartKind::Dictionary, "| paper | here |\n|---|---|\n| a | `b` |"),
            (PartKind::Derivation, "Some reason."),
            (PartKind::Derivation, "Why: it is so,\nand so."),
            (PartKind::Errors, "[`Wrong`] for this."),
            (PartKind::Errors, "And that."),
            (PartKind::Errata, "none."),
            (PartKind::Example, "```\nuse it;\n```"),
        ]
    );
    let evidence: Vec<_> = doc
        .evidence()
        .into_iter()
        .map(|named| (named.test, named.kind.unwrap_or_default()))
        .collect();
    let told: Vec<(&str, &str)> = evidence
        .iter()
        .map(|(test, kind)| (test.as_str(), kind.as_str()))
        .collect();
    let all = "symbolic, all n";
    assert_eq!(told, [("one", "exact"), ("two", all), ("three", all), ("four", "")]);
    assert_eq!(doc.evidence_of(), ["point"]);
    assert_eq!(Doc::read("No numbers — and a dash.").title, "No numbers — and a dash.");
    // The sentence of an example and its code are one part, and what stands before it is another.
    let example = Doc::read("Name.\n\nWhy: so.\n\nExample: by hand.\n\n```\nuse it;\n```\n\nErrata: none.");
    let parts: Vec<_> = example
        .parts
        .iter()
        .map(|part| (part.kind, part.text.as_str()))
        .collect();
    let both = "by hand.\n\n```\nuse it;\n```";
    assert_eq!(
        parts,
        [
            (PartKind::Derivation, "Why: so."),
            (PartKind::Example, both),
            (PartKind::Errata, "none.")
        ]
    );
}

#[test]
fn links_lead_to_the_code_that_they_name_or_are_names() {
    let item = &find("mixture_covariance").unwrap()[0].realisations[0].item;
    let html = |text: &str| markup::sentence(text, item).into_string();
    assert_eq!(
        html("[`mixture_mean`]"),
        r##"<a href="#code-gaussian-mixture_mean"><code>mixture_mean</code></a>"##
    );
    assert_eq!(
        html("[p](fn@crate::filter::cubature::point)"),
        r##"<a href="#code-filter-cubature-point">p</a>"##
    );
    assert_eq!(
        html("[`nothing_of_this`] and [x](super::nothing)"),
        "<code>nothing_of_this</code> and x"
    );
    assert_eq!(html("G = [t²/2, t, 1]ᵀ"), "G = [t²/2, t, 1]ᵀ");
    assert_eq!(html("a < b, Vec<T>"), "a &lt; b, Vec&lt;T&gt;");
    assert_eq!(plain("[`mixture_mean`] of\n`x`", item), "mixture_mean of x");
}

#[test]
fn an_equation_is_found_by_any_of_its_names() {
    let anchors = |name: &str| -> Vec<String> { find(name).unwrap().iter().map(|entry| entry.anchor()).collect() };
    for name in ["zhu2016 56", "zhu2016 (56)", "zhu2016-56", " zhu2016  (56) "] {
        assert_eq!(anchors(name), ["zhu2016-56"], "{name}");
    }
    assert_eq!(anchors("derbez2000 mixed-mean"), ["derbez2000-mixed-mean"]);
    assert_eq!(anchors("64"), ["zhu2016-64"]);
    assert_eq!(anchors("5").len(), 4, "one of every paper");
    assert_eq!(anchors("padding"), ["sustika2015-padding"]);
    assert_eq!(anchors("zhu2016-w2"), ["zhu2016-13"], "an erratum");
    assert_eq!(anchors("turn-rate"), ["zhu2016-turn-rate", "liu2017-turn-rate"]);
    assert!(anchors("mixed.covariance").contains(&"zhu2016-56".to_owned()));
    assert!(anchors("mixture_covariance").contains(&"liu2017-24".to_owned()));
    assert_eq!(anchors("Sensor::mean"), anchors("mean"));
    assert_eq!(anchors("liu2017").len(), 43);
    for entry in entries() {
        assert_eq!(anchors(&entry.reference.to_string()), [entry.anchor()]);
    }
    for (wrong, near) in [
        ("zhu2016 65", "zhu2016-"),
        ("mixed.covarance", "mixed.covariance"),
        ("mixture_covarianse", "mixture_covariance"),
        ("", ""),
    ] {
        let complaint = find(wrong).unwrap_err();
        assert!(complaint.nearest.iter().any(|name| name.contains(near)), "{complaint}");
    }
}

// The checks

/// What every equation must have.
fn lacks(entry: &Entry) -> Vec<&'static str> {
    let has = [
        ("code", !entry.realisations.is_empty()),
        ("test", !entry.evidence.is_empty()),
    ];
    has.into_iter().filter(|(_, has)| !has).map(|(what, _)| what).collect()
}

/// What is wrong with the values, mistakes and cases of an equation, or with its reason for having none.
fn tie(entry: &Entry, cases: &BTreeSet<&str>) -> Result<(), &'static str> {
    let equation = entry.equation;
    match &equation.outside {
        Some(_) if !equation.quantities.is_empty() => return Err("both or neither"),
        None if equation.quantities.is_empty() => return Err("both or neither"),
        Some(reason) if !(reason.ends_with('.') && reason.len() > 30) => return Err("no sentence"),
        Some(_) => return Ok(()),
        None => {}
    }
    if entry.quantities.len() != equation.quantities.len() {
        return Err("a quantity that is none");
    }
    if entry.mistakes.is_empty() {
        return Err("no mistake");
    }
    if equation
        .mistakes
        .iter()
        .any(|id| entry.mistakes.iter().all(|made| made.id != *id))
    {
        return Err("a mistake that is not made in it");
    }
    if !entry.cases().iter().all(|id| cases.contains(id)) || entry.cases().is_empty() {
        return Err("a case that is none");
    }
    Ok(())
}

fn id_of(problem: &ProblemFile) -> &str {
    &problem.id
}

/// What stands after each occurrence of an attribute.
fn attributes(html: &str, start: &str) -> Vec<String> {
    let after = html.split(start).skip(1);
    after
        .map(|rest| rest.split('"').next().unwrap_or_default().to_owned())
        .collect()
}

fn broken_links(html: &str) -> Vec<String> {
    let ids: BTreeSet<String> = attributes(html, " id=\"").into_iter().collect();
    let links = attributes(html, "href=\"#").into_iter();
    links.filter(|link| !ids.contains(link)).collect()
}

fn repeated_ids(html: &str) -> Vec<String> {
    let mut seen = BTreeSet::new();
    let ids = attributes(html, " id=\"").into_iter();
    ids.filter(|id| !seen.insert(id.clone())).collect()
}

/// The tags in their order, without what stands in them.
fn tags(html: &str) -> impl Iterator<Item = &str> {
    html.split('<').skip(1).filter_map(|rest| {
        let end = rest.find([' ', '>', '\n']).unwrap_or(rest.len());
        let is_tag = rest.starts_with(|c: char| c.is_ascii_alphabetic() || c == '/');
        is_tag.then_some(&rest[..end])
    })
}

/// The headings that are more than one level below the one before.
fn jumps(html: &str) -> Vec<String> {
    let levels: Vec<u32> = tags(html)
        .filter_map(|tag| tag.strip_prefix('h')?.parse().ok())
        .collect();
    let jumps = levels.windows(2).filter(|pair| pair[1] > pair[0] + 1);
    jumps.map(|pair| format!("h{} to h{}", pair[0], pair[1])).collect()
}

/// How many tables have no caption, and headers no scope.
fn bare_tables(html: &str) -> usize {
    let captions = html.matches("<caption").count();
    html.matches("<table").count() - captions + html.matches("<th>").count()
}

/// The first tag that is not closed, or is closed by another.
fn unbalanced(html: &str) -> Option<String> {
    const EMPTY: [&str; 6] = ["br", "hr", "mspace", "mspace/", "br/", "hr/"];
    let mut open = Vec::new();
    for tag in tags(html).filter(|tag| !EMPTY.contains(tag)) {
        match tag.strip_prefix('/') {
            None => open.push(tag),
            Some(closed) => {
                let expected = open.pop();
                if expected != Some(closed) {
                    return Some(format!("{} closed by {closed}", expected.unwrap_or("nothing")));
                }
            }
        }
    }
    open.pop().map(ToOwned::to_owned)
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The Rust files of a folder by their paths from the root.
fn rust_files(folder: &Path, files: &mut BTreeMap<String, String>) {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            rust_files(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let name = path.strip_prefix(root()).unwrap().display().to_string();
            files.insert(name.replace('\\', "/"), std::fs::read_to_string(&path).unwrap());
        }
    }
}
