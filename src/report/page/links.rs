//! Links between pages: a link names an anchor, and need not know its page.

use super::Page;
use std::collections::BTreeMap;

/// The pages with each link to an anchor of another page leading to that page.
pub fn joined(pages: Vec<Page>) -> Vec<Page> {
    let mut homes: BTreeMap<String, String> = BTreeMap::new();
    for page in &pages {
        for anchor in values(&page.html, " id=\"") {
            homes.entry(anchor.to_owned()).or_insert_with(|| page.file.clone());
        }
    }
    let joined = |page: Page| Page {
        html: with_homes(&page, &homes),
        file: page.file,
    };
    pages.into_iter().map(joined).collect()
}

/// The values of an attribute, which is given with its blank and its sign of equality.
fn values<'a>(html: &'a str, attribute: &str) -> Vec<&'a str> {
    let after = html.split(attribute).skip(1);
    after.filter_map(|rest| rest.split('"').next()).collect()
}

fn with_homes(page: &Page, homes: &BTreeMap<String, String>) -> String {
    let own = values(&page.html, " id=\"");
    let mut parts = page.html.split(" href=\"#");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let anchor = part.split('"').next().unwrap_or_default();
        let home = homes.get(anchor).filter(|_| !own.contains(&anchor));
        text.push_str(" href=\"");
        text.push_str(home.map_or("", String::as_str));
        text.push('#');
        text.push_str(part);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_leads_to_the_page_of_its_anchor_its_own_first() {
        let page = |file: &str, html: &str| Page {
            file: file.to_owned(),
            html: html.to_owned(),
        };
        let pages = joined(vec![
            page(
                "a.html",
                "<p id=\"one\"></p><a href=\"#two\">x</a><a href=\"#both\">y</a>",
            ),
            page("b.html", "<p id=\"two\"></p><p id=\"both\"></p><a href=\"#both\">x</a>"),
        ]);
        assert!(
            pages[0]
                .html
                .ends_with("<a href=\"b.html#two\">x</a><a href=\"b.html#both\">y</a>")
        );
        assert!(pages[1].html.ends_with("<a href=\"#both\">x</a>"));
    }
}
