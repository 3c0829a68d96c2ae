//! Goal: the pages that `immaculate report` writes, and that of a verdict, are documents that any browser reads: valid, complete, reachable
//! by keyboard and aloud, and they ask the network for nothing.
//!
//! Method: the whole site is made from a few runs and read by the parser of a browser engine; then each rule is held against every element
//! of every page (exhaustion), and shown to fail on a page that breaks it. That the figures are right is the work of other files.

use immaculate::book;
use immaculate::oracle::check::{Selection, check};
use immaculate::oracle::subject::{Level, Planted};
use immaculate::paper::{Effort, Paper};
use immaculate::report::page::content::{Content, Extent, Watch};
use immaculate::report::page::{self, Page};
use immaculate::report::verdict;
use scraper::{ElementRef, Html, Selector};
use std::collections::BTreeSet;
use std::sync::LazyLock;

/// The site from few runs: what it says of the papers is then worth little, and how it says it is the same.
fn site() -> Vec<Page> {
    let extent = Extent {
        effort: Effort { runs: Some(3), seed: 1 },
        map_points: 5,
    };
    let watch = Watch {
        begin: &|_, _| (),
        advance: &|| (),
    };
    page::site(&Content::compute(extent, &watch).unwrap()).unwrap()
}

static SITE: LazyLock<Vec<Page>> = LazyLock::new(site);

/// The page of a verdict, on a filter that is wrong.
static VERDICT: LazyLock<Page> = LazyLock::new(|| {
    let variants = vec!["mixed-spread-omitted".to_owned(), "determinant-omitted".to_owned()];
    let (level, ids) = (
        Level::Everything,
        vec!["step.n4-m2".to_owned(), "zhu2016.kalman.run".to_owned()],
    );
    let selection = Selection {
        ids,
        ..Selection::default()
    };
    let report = check(&mut Planted { variants, level }, &selection, &|_| {}).unwrap();
    Page {
        file: "verdict.html".to_owned(),
        html: verdict::page::html(&report).unwrap(),
    }
});

/// A small page that keeps every rule, around a body.
fn small(body: &str) -> String {
    format!("<!DOCTYPE html><html lang=\"en\"><head><title>t</title></head><body><h1>t</h1>{body}</body></html>")
}

fn all<'a>(document: &'a Html, selector: &str) -> Vec<ElementRef<'a>> {
    document.select(&Selector::parse(selector).unwrap()).collect()
}

/// Asserts that a rule finds nothing wrong on any page, and something on a page that breaks it.
fn assert_rule(rule: fn(&str) -> Vec<String>, broken: &[&str]) {
    for page in SITE.iter().chain([&*VERDICT]) {
        let faults = rule(&page.html);
        assert!(
            faults.is_empty(),
            "{}: {:#?}",
            page.file,
            &faults[..faults.len().min(20)]
        );
    }
    assert!(rule(&small("<p>nothing is wrong here</p>")).is_empty());
    for body in broken {
        assert!(!rule(&small(body)).is_empty(), "not noticed: {body}");
    }
}

#[test]
fn the_page_is_read_without_an_error() {
    let rule = |page: &str| {
        Html::parse_document(page)
            .errors
            .iter()
            .map(ToString::to_string)
            .collect()
    };
    assert_rule(
        rule,
        &["<p>a</b>", "<table><p></table>", "<p id=\"a\" id=\"b\">", "&#0;"],
    );
}

#[test]
fn every_anchor_is_unique_and_every_link_arrives() {
    assert_rule(
        |page| {
            let document = Html::parse_document(page);
            let ids: Vec<&str> = all(&document, "[id]")
                .iter()
                .filter_map(|element| element.attr("id"))
                .collect();
            let known: BTreeSet<&str> = ids.iter().copied().collect();
            let mut faults: Vec<String> = known
                .iter()
                .filter(|id| ids.iter().filter(|other| other == id).count() > 1 || id.is_empty() || id.contains(' '))
                .map(|id| format!("the anchor {id:?} stands more than once, or is none"))
                .collect();
            for attribute in ["href", "aria-labelledby", "aria-describedby"] {
                for element in all(&document, &format!("[{attribute}]")) {
                    let target = element.attr(attribute).unwrap_or_default();
                    let names = match attribute {
                        "href" => target.strip_prefix('#').map(|name| vec![name]).unwrap_or_default(),
                        _ => target.split(' ').collect(),
                    };
                    let missing = names.into_iter().filter(|name| !known.contains(name));
                    faults.extend(missing.map(|name| format!("{attribute} to {name:?}, which is nowhere")));
                }
            }
            faults
        },
        &[
            "<p id=\"a\">x</p><p id=\"a\">y</p>",
            "<p id=\"a b\">x</p>",
            "<a href=\"#nowhere\">x</a>",
            "<section aria-labelledby=\"nowhere\"></section>",
        ],
    );
}

#[test]
fn nothing_is_asked_of_the_network_and_no_script_is_run() {
    assert_rule(
        |page| {
            let document = Html::parse_document(page);
            let mut faults = Vec::new();
            for element in all(
                &document,
                "script, link, iframe, object, embed, img, image, video, audio, base, form, [src], [srcset]",
            ) {
                faults.push(format!("<{}>", element.value().name()));
            }
            for element in all(&document, "*") {
                for (name, value) in element.value().attrs() {
                    if name.starts_with("on") || value.contains("url(") || value.starts_with("javascript:") {
                        faults.push(format!("{name}={value:?}"));
                    }
                }
            }
            for link in all(&document, "[href]") {
                let target = link.attr("href").unwrap_or_default();
                let file = target.split('#').next().unwrap_or_default();
                let is_page = file.is_empty() || SITE.iter().any(|page| page.file == file);
                if link.value().name() != "a" || !(is_page || target.starts_with("https://doi.org/")) {
                    faults.push(format!("a link to {target:?}"));
                }
            }
            for style in all(&document, "style") {
                let text: String = style.text().collect();
                faults.extend(
                    ["url(", "@import", "expression("]
                        .into_iter()
                        .filter(|word| text.contains(word))
                        .map(str::to_owned),
                );
            }
            faults
        },
        &[
            "<script>1</script>",
            "<img alt=\"\" src=\"data:,\">",
            "<p onclick=\"f()\">x</p>",
            "<p style=\"background:url(x)\">x</p>",
            "<a href=\"https://example.org/\">x</a>",
            "<a href=\"nowhere.html\">x</a>",
            "<style>@import 'x';</style>",
            "<svg><image href=\"#a\"/></svg>",
        ],
    );
    for page in SITE.iter() {
        let document = Html::parse_document(&page.html);
        let policies = all(&document, "head > meta[http-equiv=Content-Security-Policy]");
        assert_eq!(policies.len(), 1, "the page itself forbids it too");
        assert!(policies[0].attr("content").unwrap().starts_with("default-src 'none';"));
    }
}

/// The links of a page to places of the site that are not there.
fn dead_links(html: &str) -> Vec<String> {
    let document = Html::parse_document(html);
    let links = all(&document, "a[href]")
        .into_iter()
        .filter_map(|link| link.attr("href"));
    let is_dead = |link: &&str| {
        let Some((file, anchor)) = link.split_once('#') else {
            return false;
        };
        let home = SITE.iter().find(|page| page.file == file);
        !file.is_empty() && !home.is_some_and(|page| page.html.contains(&format!(" id=\"{anchor}\"")))
    };
    links.filter(is_dead).map(str::to_owned).collect()
}

#[test]
fn every_link_to_another_page_arrives_at_its_anchor() {
    assert_rule(
        dead_links,
        &[
            "<a href=\"book.html#nowhere\">x</a>",
            "<a href=\"nowhere.html#book\">x</a>",
        ],
    );
}

#[test]
fn every_page_is_reached_from_every_page() {
    for page in SITE.iter() {
        let document = Html::parse_document(&page.html);
        let menu = all(&document, "nav a[href]");
        let files: Vec<&str> = menu.iter().filter_map(|link| link.attr("href")).collect();
        assert_eq!(files, SITE.iter().map(|page| &*page.file).collect::<Vec<_>>());
        let open: Vec<_> = menu.iter().filter(|link| link.attr("aria-current").is_some()).collect();
        assert_eq!(open.len(), 1, "{}", page.file);
        assert_eq!(open[0].attr("href"), Some(&*page.file));
    }
}

#[test]
fn headings_nest_and_landmarks_are_named() {
    assert_rule(
        |page| {
            let document = Html::parse_document(page);
            let mut faults = Vec::new();
            let mut last = 0;
            for heading in all(&document, "h1, h2, h3, h4, h5, h6") {
                let level: u32 = heading.value().name()[1..].parse().unwrap();
                let text: String = heading.text().collect();
                if level > last + 1 || text.trim().is_empty() {
                    faults.push(format!("h{level} after h{last}: {text:?}"));
                }
                last = level;
            }
            if all(&document, "h1").len() != 1 {
                faults.push("not one h1".to_owned());
            }
            for landmark in all(&document, "nav, [role=region]") {
                if landmark
                    .attr("aria-label")
                    .or(landmark.attr("aria-labelledby"))
                    .is_none()
                {
                    faults.push(format!("a {} without a name", landmark.value().name()));
                }
            }
            faults
        },
        &[
            "<h3>x</h3>",
            "<h2> </h2>",
            "<h1>x</h1>",
            "<div role=\"region\" tabindex=\"0\"></div>",
            "<nav></nav>",
        ],
    );
}

#[test]
fn tables_and_figures_can_be_read_aloud() {
    assert_rule(
        |page| {
            let document = Html::parse_document(page);
            let has = |element: &ElementRef, selector: &str| {
                element.select(&Selector::parse(selector).unwrap()).next().is_some()
            };
            let mut faults = Vec::new();
            for table in all(&document, "table") {
                if !has(&table, "caption") {
                    faults.push("a table without a caption".to_owned());
                }
            }
            for header in all(&document, "th:not([scope])") {
                faults.push(format!("a header without a scope: {:?}", header.html()));
            }
            for region in all(&document, "[role=region]:not([tabindex='0'])") {
                faults.push(format!(
                    "a region that the keyboard cannot scroll: {:?}",
                    region.attr("aria-label")
                ));
            }
            for figure in all(&document, "figure") {
                if !has(&figure, "figcaption") {
                    faults.push("a figure without a caption".to_owned());
                }
            }
            for drawing in all(&document, "svg") {
                if drawing.attr("role") != Some("img") || !has(&drawing, "title") {
                    faults.push(format!(
                        "a drawing without a title: {:?}",
                        &drawing.html()[..200.min(drawing.html().len())]
                    ));
                }
            }
            faults
        },
        &[
            "<table><tr><td>1</td></tr></table>",
            "<table><caption>c</caption><tr><th>1</th></tr></table>",
            "<div role=\"region\" aria-label=\"x\"></div>",
            "<figure></figure>",
            "<svg></svg>",
            "<svg role=\"img\"></svg>",
        ],
    );
}

#[test]
fn every_claim_erratum_and_equation_of_every_paper_has_its_place() {
    let documents: Vec<Html> = SITE.iter().map(|page| Html::parse_document(&page.html)).collect();
    let elements = documents.iter().flat_map(|document| all(document, "[id]"));
    let ids: BTreeSet<&str> = elements.filter_map(|element| element.attr("id")).collect();
    for paper in Paper::ALL {
        let specification = paper.specification();
        let errata = specification
            .all_equations()
            .filter_map(|equation| equation.erratum.as_ref());
        let claims = specification.claims.iter().map(|claim| format!("claim-{}", claim.id));
        for id in errata.map(|erratum| format!("erratum-{}", erratum.id)).chain(claims) {
            assert!(ids.contains(id.as_str()), "{id}");
        }
        for part in ["figures", "claims", "errata"] {
            assert!(
                ids.contains(format!("{}-{part}", paper.key()).as_str()),
                "{}",
                paper.key()
            );
        }
        for entry in book::entries_of(paper) {
            assert!(ids.contains(entry.anchor().as_str()), "{}", entry.reference);
        }
    }
}

#[test]
fn every_formula_has_the_parts_that_its_marks_need() {
    assert_rule(
        |page| {
            let document = Html::parse_document(page);
            let without = |count: usize, marks: &str| -> Vec<String> {
                let marks = all(&document, marks).into_iter();
                let wrong = marks.filter(|mark| mark.child_elements().count() != count);
                wrong.map(|mark| mark.html()).collect()
            };
            let mut faults = without(2, "msup, msub, mfrac, mroot, munder, mover");
            faults.extend(without(3, "msubsup, munderover"));
            faults.extend(all(&document, "merror").iter().map(ElementRef::html));
            faults
        },
        &[
            "<math><msup><mi>x</mi></msup></math>",
            "<math><msubsup><mi>x</mi><mn>2</mn></msubsup></math>",
            "<math><merror><mi>x</mi></merror></math>",
        ],
    );
}

#[test]
fn the_same_seed_gives_the_same_bytes_with_any_number_of_threads() {
    let with_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(site)
    };
    assert!(with_threads(3) == *SITE);
}
