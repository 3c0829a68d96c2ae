//! The source as data: the items of `src/` and the tests of `tests/`, from the files built into the program.
//!
//! An item is found with its doc comment, its place and its code. The parser is the one that derive macros use, so items are not guessed
//! from lines.

use include_dir::{Dir, include_dir};
use proc_macro2::Span;
use std::collections::BTreeMap;
use std::sync::LazyLock;
use syn::spanned::Spanned;
use syn::{Attribute, Expr, Fields, ImplItem, Lit, Meta, TraitItem, Type, Visibility};

static SOURCE: Dir = include_dir!("$CARGO_MANIFEST_DIR/src");
static TESTS: Dir = include_dir!("$CARGO_MANIFEST_DIR/tests");

/// A file of Rust.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct File {
    /// Its path from the root of the tree.
    pub path: String,
    /// Its text.
    pub text: &'static str,
}

/// An item of the source with its doc comment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Item {
    /// The file's path from the root of the tree.
    pub path: String,
    /// The line of its name.
    pub line: usize,
    /// Its name, with that of its type where it has one: `mixture_mean`, `Sensor::mean`.
    pub name: String,
    /// What it is: function, method, constant, type, variant, field.
    pub kind: &'static str,
    /// Whether it is public.
    pub is_public: bool,
    /// Its doc comment, without the slashes.
    pub doc: String,
    /// Its code, without the doc comment.
    pub code: String,
}

impl Item {
    /// The name without that of its type.
    pub fn short_name(&self) -> &str {
        self.name.rsplit("::").next().unwrap_or(&self.name)
    }

    /// The name of its code in addresses.
    pub fn anchor(&self) -> String {
        let place = self.path.trim_start_matches("src/").trim_end_matches(".rs");
        format!("code-{}-{}", place.replace('/', "-"), self.name.replace("::", "-"))
    }
}

/// A test: where it stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Test {
    /// The file's path from the root of the tree.
    pub path: String,
    /// The line of its name.
    pub line: usize,
}

/// The files of `src/`, in the order of their paths.
pub fn source_files() -> Vec<File> {
    files(&SOURCE, "src")
}

/// The files of `tests/`, in the order of their paths.
pub fn test_files() -> Vec<File> {
    files(&TESTS, "tests")
}

/// The Rust files of a folder.
fn files(folder: &'static Dir, name: &str) -> Vec<File> {
    let mut folders = vec![folder];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        folders.extend(folder.dirs());
        let rust = folder
            .files()
            .filter(|file| file.path().extension().is_some_and(|end| end == "rs"));
        files.extend(rust.filter_map(|file| {
            let path = file.path().display().to_string().replace('\\', "/");
            let text = file.contents_utf8()?;
            Some(File {
                path: format!("{name}/{path}"),
                text,
            })
        }));
    }
    files.sort_by(|a, b| a.path.cmp(&b.path));
    files
}

/// All tests by their names.
pub fn tests() -> &'static BTreeMap<String, Test> {
    static TESTS: LazyLock<BTreeMap<String, Test>> = LazyLock::new(|| test_files().iter().flat_map(tests_of).collect());
    &TESTS
}

/// The tests of a file. They are found by their attribute, since many stand inside macros, which no parser looks into.
pub fn tests_of(file: &File) -> Vec<(String, Test)> {
    let mut tests = Vec::new();
    let mut is_test = false;
    for (line, text) in (1..).zip(file.text.lines().map(str::trim)) {
        is_test |= text == "#[test]";
        if let Some(rest) = text.strip_prefix("fn ").filter(|_| is_test) {
            let end = rest.find(['(', '<']).unwrap_or(rest.len());
            tests.push((
                rest[..end].to_owned(),
                Test {
                    path: file.path.clone(),
                    line,
                },
            ));
            is_test = false;
        }
    }
    tests
}

/// The items of a file that have a doc comment, in their order.
///
/// # Errors
///
/// What is not Rust, and where.
pub fn items_of(file: &File) -> Result<Vec<Item>, syn::Error> {
    let mut reader = Reader {
        path: &file.path,
        lines: file.text.lines().collect(),
        items: Vec::new(),
    };
    for item in &syn::parse_file(file.text)?.items {
        reader.item(item);
    }
    Ok(reader.items)
}

/// Goes through a file and keeps what has a doc comment.
struct Reader<'a> {
    path: &'a str,
    lines: Vec<&'a str>,
    items: Vec<Item>,
}

/// What an item is called, and what it is.
struct Named<'a> {
    owner: Option<&'a str>,
    name: &'a syn::Ident,
    kind: &'static str,
    is_public: bool,
}

impl Reader<'_> {
    fn item(&mut self, item: &syn::Item) {
        let span = item.span();
        let mut keep = |attributes: &[Attribute], name: &syn::Ident, kind, visibility: &Visibility| {
            let named = Named {
                owner: None,
                name,
                kind,
                is_public: is_public(visibility),
            };
            self.keep(attributes, span, &named);
        };
        match item {
            syn::Item::Fn(item) => keep(&item.attrs, &item.sig.ident, "function", &item.vis),
            syn::Item::Const(item) => keep(&item.attrs, &item.ident, "constant", &item.vis),
            syn::Item::Static(item) => keep(&item.attrs, &item.ident, "constant", &item.vis),
            syn::Item::Type(item) => keep(&item.attrs, &item.ident, "type", &item.vis),
            syn::Item::Struct(item) => {
                keep(&item.attrs, &item.ident, "type", &item.vis);
                self.fields(&item.ident.to_string(), &item.fields);
            }
            syn::Item::Enum(item) => {
                keep(&item.attrs, &item.ident, "type", &item.vis);
                let owner = item.ident.to_string();
                for variant in &item.variants {
                    let is_public = is_public(&item.vis);
                    let named = Named {
                        owner: Some(&owner),
                        name: &variant.ident,
                        kind: "variant",
                        is_public,
                    };
                    self.keep(&variant.attrs, variant.span(), &named);
                    self.fields(&format!("{owner}::{}", variant.ident), &variant.fields);
                }
            }
            syn::Item::Trait(item) => {
                keep(&item.attrs, &item.ident, "trait", &item.vis);
                self.methods_of_trait(item);
            }
            syn::Item::Impl(item) => self.methods(item),
            syn::Item::Mod(item) => {
                for inner in item.content.iter().flat_map(|(_, items)| items) {
                    self.item(inner);
                }
            }
            _ => {}
        }
    }

    fn fields(&mut self, owner: &str, fields: &Fields) {
        for field in fields {
            if let Some(name) = &field.ident {
                let is_public = is_public(&field.vis);
                let named = Named {
                    owner: Some(owner),
                    name,
                    kind: "field",
                    is_public,
                };
                self.keep(&field.attrs, field.span(), &named);
            }
        }
    }

    fn methods(&mut self, block: &syn::ItemImpl) {
        let Type::Path(of) = block.self_ty.as_ref() else {
            return;
        };
        let owner = of.path.segments.last().map(|segment| segment.ident.to_string());
        for item in &block.items {
            let (attributes, name, kind, visibility) = match item {
                ImplItem::Fn(item) => (&item.attrs, &item.sig.ident, "method", &item.vis),
                ImplItem::Const(item) => (&item.attrs, &item.ident, "constant", &item.vis),
                _ => continue,
            };
            let named = Named {
                owner: owner.as_deref(),
                name,
                kind,
                is_public: is_public(visibility),
            };
            self.keep(attributes, item.span(), &named);
        }
    }

    fn methods_of_trait(&mut self, block: &syn::ItemTrait) {
        let owner = block.ident.to_string();
        for item in &block.items {
            if let TraitItem::Fn(method) = item {
                let is_public = is_public(&block.vis);
                let named = Named {
                    owner: Some(&owner),
                    name: &method.sig.ident,
                    kind: "method",
                    is_public,
                };
                self.keep(&method.attrs, item.span(), &named);
            }
        }
    }

    fn keep(&mut self, attributes: &[Attribute], span: Span, named: &Named) {
        let docs: Vec<(String, usize)> = attributes.iter().filter_map(doc_line).collect();
        let Some((_, last)) = docs.last() else {
            return;
        };
        let doc = docs.iter().fold(String::new(), |text, (line, _)| text + line + "\n");
        // Other attributes stand after the doc comment.
        let code = self.lines.get(*last..span.end().line).unwrap_or_default();
        let name = named.name.to_string();
        self.items.push(Item {
            path: self.path.to_owned(),
            line: named.name.span().start().line,
            name: named.owner.map_or(name.clone(), |owner| format!("{owner}::{name}")),
            kind: named.kind,
            is_public: named.is_public,
            doc,
            code: without_indentation(code),
        });
    }
}

fn is_public(visibility: &Visibility) -> bool {
    matches!(visibility, Visibility::Public(_))
}

/// The text of a doc comment's line, and where it ends.
fn doc_line(attribute: &Attribute) -> Option<(String, usize)> {
    let Meta::NameValue(pair) = &attribute.meta else {
        return None;
    };
    let Expr::Lit(value) = &pair.value else {
        return None;
    };
    let (true, Lit::Str(text)) = (pair.path.is_ident("doc"), &value.lit) else {
        return None;
    };
    let text = text.value();
    let text = text.strip_prefix(' ').unwrap_or(&text).trim_end();
    Some((text.to_owned(), attribute.span().end().line))
}

/// Lines moved to the left, as far as the first is indented.
fn without_indentation(lines: &[&str]) -> String {
    let indentation = lines.first().map_or(0, |line| line.len() - line.trim_start().len());
    let moved = lines.iter().map(|line| line.get(indentation..).unwrap_or_default());
    moved.fold(String::new(), |code, line| code + line + "\n")
}
