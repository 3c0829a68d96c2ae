//! The certified cases as a page, by the situations that they put a filter in.

use super::table::framed;
use crate::oracle::behaviour::Behaviour;
use crate::oracle::case::{self, Case, Expected};
use crate::oracle::problem::FAMILIES;
use maud::{Markup, html};

/// The page: how many cases each behaviour has for each kind of filter, then the cases.
pub fn page() -> Markup {
    let cases: Vec<&Case> = case::all().map_or_else(|_| Vec::new(), |cases| cases.iter().collect());
    let (rejected, run): (Vec<&Case>, Vec<&Case>) = cases
        .iter()
        .partition(|case| matches!(case.expected, Expected::Rejection(_)));
    html! {
        h1 { "The certified cases" }
        p {
            (cases.len()) " problems with every value of every step. Each number is the double nearest to the exact value, proven by enclosure, and "
            "beside it stand its scale and its rounding noise. A published case never changes. " code { "immaculate cases show ID" } " prints one, "
            code { "immaculate cases copy DIR" } " writes them all, and " code { "immaculate cases verify" } " proves them again."
        }
        (overview(&run))
        @for behaviour in Behaviour::ALL {
            @let of: Vec<&Case> = run.iter().copied().filter(|case| Behaviour::of(&case.problem).contains(&behaviour)).collect();
            h2 id=(anchor(behaviour)) { (behaviour.name()) }
            (list(&format!("Cases with {}", behaviour.name()), &of))
        }
        h2 #cases-bad-input { "bad input" }
        p { "What a program that checks its input must reject. Declare " code { "\"validates\": false" } " if yours leaves that to its caller." }
        (list("Problems that must be rejected", &rejected))
    }
}

fn anchor(behaviour: Behaviour) -> String {
    format!("cases-{}", behaviour.name().replace(' ', "-").replace('±', ""))
}

/// How many cases there are, or why there are none.
fn overview(cases: &[&Case]) -> Markup {
    let count = |behaviour, family| {
        let meets = |case: &&&Case| Behaviour::of(&case.problem).contains(&behaviour) && has_family(case, family);
        cases.iter().filter(meets).count()
    };
    let caption = "The number of cases for each kind of filter; a dash where the situation cannot arise";
    framed(
        caption,
        &html! {
            table.numbers {
                caption { (caption) }
                thead { tr { th scope="col" { "situation" } @for family in FAMILIES { th scope="col" { (family) } } } }
                tbody {
                    @for behaviour in Behaviour::ALL {
                        tr {
                            th scope="row" { a href={ "#" (anchor(behaviour)) } { (behaviour.name()) } }
                            @for family in FAMILIES {
                                td {
                                    @match behaviour.impossible_for(family) {
                                        Some(why) => abbr title=(why) { "—" },
                                        None => (count(behaviour, family)),
                                    }
                                }
                            }
                        }
                    }
                }
            }
        },
    )
}

fn has_family(case: &Case, family: &str) -> bool {
    let problem = &case.problem;
    (0..problem.modes.len()).any(|mode| problem.filter_of(mode).family() == family)
}

fn list(caption: &str, cases: &[&Case]) -> Markup {
    framed(
        caption,
        &html! {
            table {
                caption.aloud { (caption) }
                thead { tr { th scope="col" { "case" } th scope="col" { "filter" } th scope="col" { "purpose" } } }
                tbody {
                    @for case in cases {
                        tr {
                            th scope="row" { code { (case.problem.id) } }
                            td { (case.problem.kinds().join(" + ")) }
                            td { (case.problem.about) }
                        }
                    }
                }
            }
        },
    )
}
