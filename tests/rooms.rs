//! Goal: a room of the crate uses those above it and none below, and a public type has a name of its own.
//!
//! Method: the table of rooms is read from the front page of the documentation, and every path of every file of `src/` from its tokens,
//! so that comments and texts do not count. Kind of evidence: style. Each check is a function of what it checks, and is shown to complain
//! about something that is spoilt. That each feature builds by itself is the compiler's to say.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

// What may use what

#[test]
fn a_room_uses_those_above_it_and_none_below() {
    let table = table_of_rooms();
    let mut inner = 0;
    for (path, text) in sources() {
        let complaints = forbidden(&path, &text, &table);
        assert_eq!(complaints, Vec::<String>::new(), "{path}");
        inner += usize::from(room_of(&path).is_some());
    }
    assert!(inner > 150, "{inner} files are in rooms");
}

#[test]
fn an_import_from_below_is_refused() {
    let table = table_of_rooms();
    let complaints = |path: &str, text: &str| forbidden(path, text, &table).len();
    // Below, in each way of writing a path.
    assert_eq!(complaints("src/gaussian.rs", "use crate::imm::Step;"), 1);
    assert_eq!(complaints("src/gaussian.rs", "use super::imm::Step;"), 1);
    assert_eq!(complaints("src/rule/simplex.rs", "use super::super::imm::Step;"), 1);
    assert_eq!(
        complaints(
            "src/rule/mod.rs",
            "use crate::{number::Real, imm::{Step, Imm}, filter};"
        ),
        2
    );
    assert_eq!(
        complaints("src/rule/simplex.rs", "fn f() -> crate::imm::Step { todo }"),
        1
    );
    // Beside: the oracle and the papers.
    assert_eq!(complaints("src/steady/map.rs", "use crate::oracle::check;"), 1);
    assert_eq!(complaints("src/oracle/schema.rs", "use crate::steady::verdict;"), 1);
    // A room that is not in the table.
    assert_eq!(complaints("src/oracle/schema.rs", "use crate::attic::Trunk;"), 1);
    assert_eq!(complaints("src/attic/trunk.rs", ""), 1);
    // Above, its own, of another crate, in a comment or in quotes.
    for text in [
        "use crate::number::Real;",
        "use super::simplex::simplex; use super::{moment, printed};",
        "use nalgebra::imm;",
        "/// See [`Step`](crate::imm::Step).\nfn f() { let text = \"crate::imm\"; } // crate::imm",
        "pub(crate) fn imm() {}",
    ] {
        assert_eq!(complaints("src/rule/sphere.rs", text), 0, "{text}");
    }
    // The program's files call the library by its name.
    assert_eq!(
        complaints("src/cli/rule.rs", "use immaculate::rule::RuleName; use super::Refusal;"),
        0
    );
    assert_eq!(complaints("src/report/rule.rs", "use immaculate::cli::Refusal;"), 1);
}

/// A room: its name and the features any of which builds it; none for the specification.
struct Room {
    name: String,
    features: BTreeSet<String>,
}

/// The rooms in their order, from the table of the front page.
fn table_of_rooms() -> Vec<Room> {
    let page = std::fs::read_to_string(root().join("src/lib.rs")).unwrap();
    let (_, section) = page.split_once("//! # The rooms, in reading order").unwrap();
    let section = section.split("//! # ").next().unwrap();
    let mut rooms = Vec::new();
    for line in section.lines().filter(|line| line.starts_with("//! | ")).skip(1) {
        let cells: Vec<&str> = line.split('|').collect();
        let name = in_backticks(cells[1]).next().unwrap();
        rooms.push(Room {
            name: name.trim_start_matches("mod@").to_owned(),
            features: in_backticks(cells[3]).map(str::to_owned).collect(),
        });
    }
    assert_eq!(rooms.len(), 17);
    rooms
}

/// What stands in backticks.
fn in_backticks(cell: &str) -> impl Iterator<Item = &str> {
    cell.split('`').skip(1).step_by(2)
}

impl Room {
    /// Whether this room is built wherever another is; `cli` builds all.
    fn is_there_for(&self, other: &Room) -> bool {
        let is_built_by = |feature: &str| self.features.contains(feature) || feature == "cli";
        let by_all = !other.features.is_empty() && other.features.iter().all(|feature| is_built_by(feature));
        self.features.is_empty() || by_all
    }
}

/// The room that a file of `src/` is in; none for the front page and the start of the program.
fn room_of(path: &str) -> Option<&str> {
    let inside = path.strip_prefix("src/")?;
    let room = inside.split('/').next()?.trim_end_matches(".rs");
    (!["lib", "main"].contains(&room)).then_some(room)
}

/// The uses in a file that the table does not allow, in words.
fn forbidden(path: &str, text: &str, table: &[Room]) -> Vec<String> {
    let Some(room) = room_of(path) else {
        return Vec::new();
    };
    let place = |name: &str| table.iter().position(|other| other.name == name);
    let Some(own) = place(room) else {
        return vec![format!("{room} is not in the table of rooms")];
    };
    let mut complaints = Vec::new();
    for used in rooms_used(path, text) {
        match place(&used) {
            None => complaints.push(format!("{used} is not in the table of rooms")),
            Some(other) if other > own => complaints.push(format!("{room} uses {used}, which is below it")),
            Some(other) if !table[other].is_there_for(&table[own]) => {
                complaints.push(format!("{room} uses {used}, which its feature does not build"));
            }
            Some(_) => {}
        }
    }
    complaints
}

/// The rooms that the paths of a file lead to.
fn rooms_used(path: &str, text: &str) -> Vec<String> {
    let inside = path.trim_start_matches("src/").trim_end_matches(".rs");
    // This many times `super` leads from the file to the root of its crate.
    let depth = inside.trim_end_matches("/mod").split('/').count();
    let mut used = BTreeSet::new();
    collect(text.parse().unwrap(), depth, path.starts_with("src/cli"), &mut used);
    used.into_iter().collect()
}

fn collect(tokens: TokenStream, depth: usize, is_program: bool, used: &mut BTreeSet<String>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut at = 0;
    while at < tokens.len() {
        if let TokenTree::Group(group) = &tokens[at] {
            collect(group.stream(), depth, is_program, used);
        }
        // A root: the crate, the crate by its name, or as often `super` as the file is deep.
        let starts_path = at == 0 || !is_colon(&tokens[at - 1]);
        let mut next = at;
        let mut supers = 0;
        while starts_path && is_word(tokens.get(next), "super") && is_separator(&tokens, next + 1) {
            supers += 1;
            next += 3;
        }
        // Of the program's own crate the rooms are `cli` alone.
        let is_root = if supers > 0 {
            supers == depth && !is_program
        } else {
            let is_crate = is_word(tokens.get(at), "crate") && !is_program || is_word(tokens.get(at), "immaculate");
            next = at + 3;
            starts_path && is_crate && is_separator(&tokens, at + 1)
        };
        if is_root {
            used.extend(first_words(tokens.get(next)));
        }
        at += 1;
    }
}

/// The first word of a path, or of each path of a group.
fn first_words(token: Option<&TokenTree>) -> Vec<String> {
    match token {
        Some(TokenTree::Ident(word)) => vec![word.to_string()],
        Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace => {
            let mut words = Vec::new();
            let mut is_first = true;
            for token in group.stream() {
                match token {
                    TokenTree::Ident(word) if is_first => {
                        words.push(word.to_string());
                        is_first = false;
                    }
                    TokenTree::Punct(comma) if comma.as_char() == ',' => is_first = true,
                    _ => {}
                }
            }
            words
        }
        _ => Vec::new(),
    }
}

fn is_word(token: Option<&TokenTree>, word: &str) -> bool {
    matches!(token, Some(TokenTree::Ident(ident)) if *ident == word)
}

fn is_colon(token: &TokenTree) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == ':')
}

fn is_separator(tokens: &[TokenTree], at: usize) -> bool {
    tokens.get(at).is_some_and(is_colon) && tokens.get(at + 1).is_some_and(is_colon)
}

// Names of types

/// Public types of which several have one name, in rooms that are still to be named.
const SEVERAL: [(&str, usize); 1] = [("Case", 2)];

#[test]
fn a_public_type_has_a_name_of_its_own() {
    let texts = sources();
    let mut found: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for (path, text) in &texts {
        for name in public_types(text) {
            found.entry(name).or_default().push(path);
        }
    }
    let several: Vec<(&str, usize)> = found
        .iter()
        .filter(|(_, paths)| paths.len() > 1)
        .map(|(name, paths)| (name.as_str(), paths.len()))
        .collect();
    let listed: Vec<(&str, usize)> = SEVERAL.to_vec();
    let words: Vec<String> = several
        .iter()
        .filter(|one| !listed.contains(one))
        .map(|(name, _)| format!("{name}: {}", found[*name].join(", ")))
        .collect();
    assert_eq!(words, Vec::<String>::new(), "public types with one name");
    for one in listed {
        assert!(several.contains(&one), "{one:?} needs no exception any more");
    }
}

#[test]
fn a_public_type_is_found_wherever_it_is_written() {
    let text = "pub struct A; pub(crate) struct B; enum C {} pub enum D { E } pub type F = u8; pub trait G {} \
                mod m { pub struct H<T>(T); } // pub struct I;\n fn f() { struct J; }";
    assert_eq!(public_types(text), ["A", "D", "F", "G", "H"]);
}

/// The names of the types, traits and aliases of a file that are public where they stand.
fn public_types(text: &str) -> Vec<String> {
    fn of(items: &[syn::Item], names: &mut Vec<String>) {
        for item in items {
            let (visibility, name) = match item {
                syn::Item::Struct(item) => (&item.vis, &item.ident),
                syn::Item::Enum(item) => (&item.vis, &item.ident),
                syn::Item::Type(item) => (&item.vis, &item.ident),
                syn::Item::Trait(item) => (&item.vis, &item.ident),
                syn::Item::Mod(item) => {
                    of(item.content.as_ref().map_or(&[][..], |content| &content.1[..]), names);
                    continue;
                }
                _ => continue,
            };
            if matches!(visibility, syn::Visibility::Public(_)) {
                names.push(name.to_string());
            }
        }
    }
    let mut names = Vec::new();
    of(&syn::parse_file(text).unwrap().items, &mut names);
    names
}

// How the tree is read

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The path and the text of every Rust file in `src/`, in the order of the paths.
fn sources() -> Vec<(String, String)> {
    let mut folders = vec![root().join("src")];
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let name = path
                    .strip_prefix(root())
                    .unwrap()
                    .display()
                    .to_string()
                    .replace('\\', "/");
                found.push((name, std::fs::read_to_string(&path).unwrap()));
            }
        }
    }
    found.sort();
    found
}
