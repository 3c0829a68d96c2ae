//! Writes all mutants of a file into it. Each is selected at run time.
//!
//! ```text
//! a + b      becomes   match (a, b) { (l, r) => match site(7, 2) { 0 => l + r, 1 => l - r, _ => l * r } }
//! fn f { s } becomes   fn f { match site(9, 1) { 1 => return Default::default(), _ => {} } s }
//! ```
//!
//! Each alternative has its own line, with the mutant's id in a comment that identifies the compiler's errors. A mutant replaces a node of
//! the expression tree. `cargo mutants` replaces the text of an operator, where the new operator's precedence can give another expression.

use crate::mutant::{Build, Listed, Mutant, Place};
use proc_macro2::Span;
use std::collections::HashMap;
use std::fmt::Write;
use std::ops::Range;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{BinOp, Expr};

const MODULE: &str = "::immaculate::chosen";

/// A piece of text that is put in, or that takes the place of another.
struct Edit {
    at: usize,
    /// What stands first at one place: what is closed (the innermost first), what is opened (the outermost first), what is replaced.
    order: (u8, i64),
    removed: usize,
    text: String,
}

/// A file on its way from its own text to the instrumented one.
pub struct Instrumented<'a> {
    text: &'a str,
    waiting: HashMap<(String, Range<usize>), Vec<&'a Listed>>,
    edits: Vec<Edit>,
    depth: i64,
    in_constant: usize,
    /// Whether the function that is read returns `impl Trait`: of one type, so that no other value can be returned early.
    is_opaque: bool,
    /// The mutants that have been met; their ids follow those of the files before.
    pub mutants: Vec<Mutant>,
    next: usize,
    refused: &'a HashMap<String, Build>,
}

impl<'a> Instrumented<'a> {
    pub fn new(text: &'a str, listed: &[&'a Listed], next: usize, refused: &'a HashMap<String, Build>) -> Self {
        let starts: Vec<usize> = std::iter::once(0)
            .chain(text.match_indices('\n').map(|(at, _)| at + 1))
            .collect();
        let offset = |place: Place| {
            let line = starts[place.line - 1];
            let column = text[line..].char_indices().nth(place.column - 1);
            column.map_or(text.len(), |(at, _)| line + at)
        };
        let mut waiting: HashMap<_, Vec<&Listed>> = HashMap::new();
        for &mutant in listed {
            let mut range = offset(mutant.span.start)..offset(mutant.span.end);
            if mutant.genre == "StructField" {
                range.end = range.start; // its span has the comma, too
            }
            waiting.entry((mutant.genre.clone(), range)).or_default().push(mutant);
        }
        Self {
            text,
            waiting,
            edits: Vec::new(),
            depth: 0,
            in_constant: 0,
            is_opaque: false,
            mutants: Vec::new(),
            next,
            refused,
        }
    }

    /// The instrumented text.
    pub fn finish(mut self) -> (String, Vec<Mutant>) {
        let left: Vec<&Listed> = self.waiting.drain().flat_map(|(_, mutants)| mutants).collect();
        for mutant in left {
            self.add(mutant, Build::NotChosen("no expression of the tree".into()));
        }
        self.edits.sort_by_key(|edit| (edit.at, edit.order));
        let mut text = String::new();
        let mut done = 0;
        for edit in &self.edits {
            text.push_str(&self.text[done..edit.at]);
            text.push_str(&edit.text);
            done = edit.at + edit.removed;
        }
        text.push_str(&self.text[done..]);
        (text, self.mutants)
    }

    fn add(&mut self, mutant: &Listed, build: Build) -> usize {
        self.next += 1;
        self.mutants.push(Mutant {
            id: self.next,
            site: self.next,
            name: mutant.name.clone(),
            file: mutant.file.clone(),
            build,
        });
        self.next
    }

    /// The mutants at a place that can be in the build, with the first id of the site.
    fn take(&mut self, genre: &str, range: &Range<usize>) -> Option<(usize, Vec<&'a Listed>)> {
        let mutants = self.waiting.remove(&(genre.to_owned(), range.clone()))?;
        let mut viable = Vec::new();
        for mutant in mutants {
            if let Some(build) = self.refused.get(&mutant.name) {
                self.add(mutant, build.clone());
            } else if genre == "FnValue" && self.is_opaque {
                self.add(mutant, Build::NotChosen("the function returns impl Trait".into()));
            } else if self.in_constant > 0 {
                self.add(mutant, Build::NotChosen("in a constant".into()));
            } else {
                viable.push(mutant);
            }
        }
        if viable.is_empty() {
            return None;
        }
        let first = self.next + 1;
        for mutant in &viable {
            self.add(mutant, Build::In);
        }
        for mutant in self.mutants.iter_mut().filter(|mutant| mutant.id >= first) {
            mutant.site = first;
        }
        Some((first, viable))
    }

    fn open(&mut self, at: usize, text: String) {
        self.edits.push(Edit {
            at,
            order: (2, self.depth),
            removed: 0,
            text,
        });
    }

    fn close(&mut self, at: usize, text: String) {
        self.edits.push(Edit {
            at,
            order: (0, -self.depth),
            removed: 0,
            text,
        });
    }

    fn replace(&mut self, range: &Range<usize>, text: &str) {
        self.edits.push(Edit {
            at: range.start,
            order: (3, 0),
            removed: range.len(),
            text: text.to_owned(),
        });
    }

    fn binary(&mut self, node: &syn::ExprBinary) {
        let operator = range(node.op.span());
        if has_let(&node.left) || has_let(&node.right) {
            for mutant in self
                .waiting
                .remove(&("BinaryOperator".to_owned(), operator))
                .unwrap_or_default()
            {
                self.add(
                    mutant,
                    Build::Unviable("a let in a chain of conditions can only be followed by &&".into()),
                );
            }
            return;
        }
        let Some((first, mutants)) = self.take("BinaryOperator", &operator) else {
            return;
        };
        let (left, right) = (range(node.left.span()), range(node.right.span()));
        let symbol = &self.text[operator.clone()];
        let (before, between, after, alternative): (_, _, _, fn(&str) -> String) = match node.op {
            BinOp::And(_) | BinOp::Or(_) => return self.lazy(node, first, &mutants),
            BinOp::Eq(_) | BinOp::Ne(_) | BinOp::Lt(_) | BinOp::Le(_) | BinOp::Gt(_) | BinOp::Ge(_) => {
                ("(match (&(", "), &(", ")) { (l__, r__) => ", |symbol| {
                    format!("*l__ {symbol} *r__")
                })
            }
            _ if is_assignment(&node.op) => return self.assignment(node, first, &mutants),
            _ => ("(match ((", "), (", ")) { (l__, r__) => ", |symbol| {
                format!("l__ {symbol} r__")
            }),
        };
        let alternatives: Vec<String> = mutants.iter().map(|mutant| alternative(&mutant.replacement)).collect();
        let question = question(first, &alternative(symbol), &alternatives);
        self.open(left.start, before.to_owned());
        self.replace(&operator, between);
        self.close(right.end, format!("{after}{question} }})"));
    }

    /// `a && b` as "if a then b", whose mutant `a || b` is "if not a then b".
    fn lazy(&mut self, node: &syn::ExprBinary, first: usize, mutants: &[&Listed]) {
        let operator = range(node.op.span());
        let (left, right) = (range(node.left.span()), range(node.right.span()));
        let negation = if matches!(node.op, BinOp::And(_)) { "" } else { "!" };
        debug_assert_eq!(mutants.len(), 1);
        self.open(left.start, "(match (".to_owned());
        let middle = format!(") {{ l__ => if ({negation}l__) ^ {MODULE}::is({first}) /*#{first}*/ {{ (");
        self.replace(&operator, &middle);
        self.close(right.end, ") } else { l__ } })".to_owned());
    }

    fn assignment(&mut self, node: &syn::ExprBinary, first: usize, mutants: &[&Listed]) {
        let operator = range(node.op.span());
        let (left, right) = (range(node.left.span()), range(node.right.span()));
        let target = &self.text[left.clone()];
        let alternative = |symbol: &str| format!("{target} {symbol} r__");
        let alternatives: Vec<String> = mutants.iter().map(|mutant| alternative(&mutant.replacement)).collect();
        let question = question(first, &alternative(&self.text[operator.clone()]), &alternatives);
        self.replace(&(left.start..right.start), "(match (");
        self.close(right.end, format!(") {{ r__ => {question} }})"));
    }
}

/// The text that asks which mutant of a site is alive.
fn question(first: usize, itself: &str, alternatives: &[String]) -> String {
    let mut text = format!(
        "match {MODULE}::site({first}, {}) {{ 0 => {itself}, /*@{first}*/\n",
        alternatives.len()
    );
    for (number, alternative) in alternatives.iter().enumerate() {
        let pattern = if number + 1 == alternatives.len() {
            "_".to_owned()
        } else {
            (number + 1).to_string()
        };
        let _ = writeln!(text, "{pattern} => {alternative}, /*#{}*/", first + number);
    }
    text + "}"
}

fn range(span: Span) -> Range<usize> {
    span.byte_range()
}

/// Whether an operand of a chain of conditions is a `let`.
fn has_let(node: &Expr) -> bool {
    match node {
        Expr::Let(_) => true,
        Expr::Binary(binary) if matches!(binary.op, BinOp::And(_)) => has_let(&binary.left) || has_let(&binary.right),
        _ => false,
    }
}

fn is_assignment(operator: &BinOp) -> bool {
    use BinOp::{
        AddAssign, BitAndAssign, BitOrAssign, BitXorAssign, DivAssign, MulAssign, RemAssign, ShlAssign, ShrAssign,
        SubAssign,
    };
    matches!(
        operator,
        AddAssign(_)
            | SubAssign(_)
            | MulAssign(_)
            | DivAssign(_)
            | RemAssign(_)
            | BitXorAssign(_)
            | BitAndAssign(_)
            | BitOrAssign(_)
            | ShlAssign(_)
            | ShrAssign(_)
    )
}

impl<'ast> Visit<'ast> for Instrumented<'_> {
    fn visit_expr(&mut self, node: &'ast Expr) {
        self.depth += 1;
        match node {
            Expr::Binary(binary) => {
                self.binary(binary);
                // The left side of an assignment is written again for each mutant, so it has none of its own.
                if is_assignment(&binary.op) {
                    self.visit_expr(&binary.right);
                } else {
                    visit::visit_expr(self, node);
                }
            }
            Expr::Unary(unary) => {
                let operator = range(unary.op.span());
                if let Some((first, _)) = self.take("UnaryOperator", &operator) {
                    let symbol = self.text[operator.clone()].to_owned();
                    let question = question(first, &format!("{symbol}v__"), &["v__".to_owned()]);
                    self.replace(&operator, "(match (");
                    self.close(range(unary.expr.span()).end, format!(") {{ v__ => {question} }})"));
                }
                visit::visit_expr(self, node);
            }
            Expr::Closure(_) => {
                let outside = std::mem::take(&mut self.in_constant);
                visit::visit_expr(self, node);
                self.in_constant = outside;
            }
            Expr::Repeat(repeat) => {
                self.visit_expr(&repeat.expr);
                self.in_constant += 1;
                self.visit_expr(&repeat.len);
                self.in_constant -= 1;
            }
            _ => visit::visit_expr(self, node),
        }
        self.depth -= 1;
    }

    fn visit_signature(&mut self, node: &'ast syn::Signature) {
        self.is_opaque = self.text[range(node.output.span())].contains("impl ");
        visit::visit_signature(self, node);
    }

    fn visit_expr_match(&mut self, node: &'ast syn::ExprMatch) {
        let is_for_all = |arm: &syn::Arm| arm.guard.is_none() && matches!(arm.pat, syn::Pat::Wild(_));
        if !node.arms.iter().any(is_for_all) {
            for place in node.arms.iter().map(|arm| range(arm.span())) {
                for mutant in self.waiting.remove(&("MatchArm".to_owned(), place)).unwrap_or_default() {
                    self.add(mutant, Build::Unviable("no arm is left for every value".into()));
                }
            }
        }
        visit::visit_expr_match(self, node);
    }

    fn visit_arm(&mut self, node: &'ast syn::Arm) {
        let whole = range(node.span());
        let without_comma = range(node.pat.span()).start..range(node.body.span()).end;
        let deleted = self
            .take("MatchArm", &whole)
            .or_else(|| self.take("MatchArm", &without_comma))
            .map(|(first, _)| format!("!{MODULE}::is({first}) /*#{first}*/ "));
        if let Some((_, guard)) = &node.guard {
            let place = range(guard.span());
            if let Some((first, mutants)) = self.take("MatchArmGuard", &place) {
                let mut text = format!("(match {MODULE}::site({first}, {}) {{ ", mutants.len());
                for (number, mutant) in mutants.iter().enumerate() {
                    let _ = writeln!(
                        text,
                        "{} => {}, /*#{}*/",
                        number + 1,
                        mutant.replacement,
                        first + number
                    );
                }
                self.open(place.start, text + "_ => (");
                self.close(place.end, ") })".to_owned());
            }
            if let Some(alive) = deleted {
                self.depth -= 1;
                self.open(place.start, format!("{alive}&& ("));
                self.close(place.end, ")".to_owned());
                self.depth += 1;
            }
        } else if let Some(alive) = deleted {
            self.close(range(node.pat.span()).end, format!(" if {alive}\n"));
        }
        visit::visit_arm(self, node);
    }

    fn visit_block(&mut self, node: &'ast syn::Block) {
        if let (Some(start), Some(end)) = (node.stmts.first(), node.stmts.last()) {
            let body = range(start.span()).start..range(end.span()).end;
            if let Some((first, mutants)) = self.take("FnValue", &body) {
                let mut text = format!(" match {MODULE}::site({first}, {}) {{\n", mutants.len());
                for (number, mutant) in mutants.iter().enumerate() {
                    let _ = writeln!(
                        text,
                        "{} => return {}, /*#{}*/",
                        number + 1,
                        mutant.replacement,
                        first + number
                    );
                }
                let brace = range(node.brace_token.span.open()).end;
                self.open(brace, text + "_ => {} }\n");
            }
        }
        visit::visit_block(self, node);
    }

    fn visit_expr_struct(&mut self, node: &'ast syn::ExprStruct) {
        for field in &node.fields {
            let start = range(field.span()).start;
            if let (Some(base), Some((first, _))) = (&node.rest, self.take("StructField", &(start..start))) {
                let base = self.text[range(base.span())].to_owned();
                let syn::Member::Named(name) = &field.member else {
                    continue;
                };
                let value = range(field.expr.span());
                let label = if field.colon_token.is_none() {
                    format!("{name}: ")
                } else {
                    String::new()
                };
                self.open(value.start, format!("{label}match {MODULE}::is({first}) {{ false => ("));
                self.close(
                    value.end,
                    format!("), /*@{first}*/\n true => ({base}).{name}, /*#{first}*/\n }}"),
                );
            }
        }
        visit::visit_expr_struct(self, node);
    }

    fn visit_item_const(&mut self, node: &'ast syn::ItemConst) {
        self.in_constant += 1;
        visit::visit_item_const(self, node);
        self.in_constant -= 1;
    }

    fn visit_impl_item_const(&mut self, node: &'ast syn::ImplItemConst) {
        self.in_constant += 1;
        visit::visit_impl_item_const(self, node);
        self.in_constant -= 1;
    }

    fn visit_item_static(&mut self, node: &'ast syn::ItemStatic) {
        self.in_constant += 1;
        visit::visit_item_static(self, node);
        self.in_constant -= 1;
    }

    fn visit_type(&mut self, node: &'ast syn::Type) {
        self.in_constant += 1;
        visit::visit_type(self, node);
        self.in_constant -= 1;
    }
}
