//! Goal: the house style is held by a test and not by memory.
//!
//! Method: the tree is read as text. Kind of evidence: style. What cannot be decided by reading lines (whether a name is good, a
//! sentence true) is not tried. Every exception is on a list with its reason, and an exception that is no longer needed fails.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// No file is longer.
const LONGEST_FILE: usize = 500;

/// Functions that may be longer than [`LONGEST_FUNCTION`] lines.
const LONG_FUNCTIONS: [(&str, &str, &str); 4] = [
    (
        "src/imm/equations.rs",
        "standard",
        "a table, one short entry an equation",
    ),
    (
        "src/paper/zhu2016/mod.rs",
        "scenario",
        "a table, one entry an open parameter",
    ),
    (
        "src/paper/liu2017/mod.rs",
        "scenario",
        "a table, one entry an open parameter",
    ),
    (
        "src/paper/liu2017/claims.rs",
        "table_1_gaps",
        "one explanation of the table after the other",
    ),
];
const LONGEST_FUNCTION: usize = 60;

/// Where the program may end instead of answering: only where the cause is a defect of the program itself.
const EXPECTATIONS: [(&str, usize, &str); 10] = [
    ("src/model/registry.rs", 1, "the files in spec/ are part of the program"),
    (
        "src/paper/derbez2000/scenario.rs",
        1,
        "the scenarios are part of the program",
    ),
    (
        "src/paper/sustika2015/scenario.rs",
        1,
        "the scenarios are part of the program",
    ),
    (
        "src/paper/sustika2015/contestants.rs",
        1,
        "the rule's parameters are part of the program",
    ),
    (
        "src/paper/sustika2015/truth.rs",
        1,
        "the covariances of constant models",
    ),
    (
        "src/paper/specification.rs",
        1,
        "the files in spec/ are part of the program",
    ),
    (
        "src/paper/scenario.rs",
        3,
        "the papers' scenarios, and their rules in four dimensions, are part of the program",
    ),
    ("src/paper/liu2017/mod.rs", 1, "a constant matrix of full rank"),
    (
        "src/paper/verdict.rs",
        1,
        "claims and judges are both part of the program",
    ),
    (
        "src/statistics/consistency.rs",
        1,
        "documented: a number of degrees of freedom is positive",
    ),
];

/// The widest line; the formatter breaks code sooner, and leaves comments and long sentences in quotes to the author.
const WIDEST_LINE: usize = 140;

#[test]
fn every_file_begins_with_a_sentence_that_says_what_it_is() {
    for file in rust("src").iter().chain(&rust("tests")) {
        let head: Vec<&str> = file.text.lines().take_while(|line| line.starts_with("//!")).collect();
        let paragraph: Vec<&str> = head
            .iter()
            .map(|line| line.trim_start_matches("//!").trim())
            .take_while(|line| !line.is_empty())
            .collect();
        let sentence = paragraph.join(" ");
        assert!(
            sentence.len() >= 20 && sentence.ends_with(['.', ':', '?']),
            "{}: the head is {sentence:?}",
            file.path
        );
    }
}

#[test]
fn every_test_file_states_goal_and_method() {
    for file in rust("tests").iter().filter(|file| file.path.matches('/').count() == 1) {
        let head: String = file.text.lines().take_while(|line| line.starts_with("//!")).collect();
        assert!(head.contains("Method: "), "{}: goal and method", file.path);
    }
}

#[test]
fn files_and_functions_are_as_long_as_a_reader_can_hold() {
    let mut needed = BTreeSet::new();
    for file in rust("src") {
        let lines = file.text.lines().count();
        assert!(lines <= LONGEST_FILE, "{}: {lines} lines", file.path);
        for (name, lines) in functions(&file.text) {
            if lines > LONGEST_FUNCTION {
                let listed = LONG_FUNCTIONS
                    .iter()
                    .any(|(path, f, _)| *path == file.path && *f == name);
                assert!(listed, "{}: {name} has {lines} lines", file.path);
                needed.insert(format!("{} {name}", file.path));
            }
        }
    }
    let functions = LONG_FUNCTIONS.iter().map(|(path, name, _)| format!("{path} {name}"));
    for exception in functions {
        assert!(needed.contains(&exception), "{exception} needs no exception any more");
    }
}

#[test]
fn the_program_does_not_end_by_accident() {
    for file in rust("src") {
        let code = without_comments_and_text(&file.text);
        for word in [
            ".unwrap()",
            "panic!",
            "todo!",
            "unimplemented!",
            "unreachable!",
            "dbg!",
            "process::exit",
        ] {
            assert!(!code.contains(word), "{}: {word}", file.path);
        }
        let allowed = EXPECTATIONS
            .iter()
            .find(|(path, ..)| *path == file.path)
            .map_or(0, |entry| entry.1);
        assert_eq!(code.matches(".expect(").count(), allowed, "{}: .expect(…)", file.path);
    }
}

#[test]
fn equations_call_no_function_that_differs_between_platforms() {
    // In the equation rooms no type is a double by name: all is generic, so every `.exp()` is that of the number system.
    let rooms = [
        "src/matrix.rs",
        "src/gaussian.rs",
        "src/rule/",
        "src/model/",
        "src/filter/",
        "src/imm/",
        "src/smoother/",
        "src/steady/gains.rs",
        "src/steady/linear.rs",
        "src/steady/polynomial.rs",
        "src/steady/reach.rs",
    ];
    // Where doubles are doubles, what IEEE 754 does not fix is called by the name of the number system: `Real::ln(&x)`.
    let of_a_double = [".exp()", ".ln()", ".sin()", ".cos()", ".atan2("];
    // And these nowhere: no number system has them.
    let nowhere = [
        ".powi(",
        ".powf(",
        ".mul_add(",
        ".hypot(",
        ".tan()",
        ".cbrt()",
        ".log10()",
        ".log2()",
        ".exp2()",
        ".ln_1p()",
        ".exp_m1()",
        ".sin_cos()",
        ".asin()",
        ".acos()",
        ".atan()",
    ];
    for file in rust("src") {
        let code = without_comments_and_text(&file.text);
        let is_room = rooms.iter().any(|room| file.path.starts_with(room));
        let is_number = file.path.starts_with("src/number/");
        if is_room {
            let is_word = |c: char| c.is_alphanumeric() || c == '_';
            let names_a_double = code.split(|c| !is_word(c)).any(|word| ["f64", "f32"].contains(&word));
            assert!(!names_a_double, "{} names a double", file.path);
        }
        for call in of_a_double.iter().filter(|_| !is_room && !is_number) {
            assert!(!code.contains(call), "{}: {call} of the platform", file.path);
        }
        for call in nowhere {
            assert!(!code.contains(call), "{}: {call}", file.path);
        }
    }
}

#[test]
fn unicode_is_for_comments_and_text() {
    for file in rust("src").iter().chain(&rust("tests")) {
        for (line, text) in (1..).zip(without_comments_and_text(&file.text).lines()) {
            assert!(text.is_ascii(), "{}:{line}: {text}", file.path);
        }
    }
}

#[test]
fn lines_have_no_tabs_and_a_width_that_can_be_read() {
    for file in rust("src").iter().chain(&rust("tests")) {
        for (number, line) in (1..).zip(file.text.lines()) {
            let at = format!("{}:{number}", file.path);
            assert!(!line.contains('\t'), "{at}: a tab");
            assert_eq!(line, line.trim_end(), "{at}: blanks at the end");
            let width = line.chars().count();
            let is_text = line.contains('"') || line.ends_with('\\');
            assert!(width <= WIDEST_LINE || is_text, "{at}: {width} wide");
        }
        assert!(
            file.text.ends_with('\n') && !file.text.ends_with("\n\n"),
            "{}: its end",
            file.path
        );
    }
}

#[test]
fn the_tree_speaks_of_nothing_outside_itself() {
    // Put together here, so that this file does not contain them.
    let words = [
        ["shar", "ed/"],
        ["hel", "per"],
        ["ses", "sion"],
        ["/wo", "rk/"],
        ["/tm", "p/"],
    ]
    .map(|parts| parts.concat());
    let mut tree = rust("src");
    for folder in ["tests", "benches", "spec", "examples", "fixtures"] {
        tree.extend(files(folder, &|_| true));
    }
    for name in ["README.md", "Cargo.toml", "CHANGELOG.md", "CONTRIBUTING.md"] {
        tree.extend(read(&root().join(name)));
    }
    assert!(tree.len() > 60, "the tree was read");
    for file in tree {
        for word in &words {
            assert!(!file.text.contains(word.as_str()), "{}: {word}", file.path);
        }
    }
}

/// Phrases that are never right, each with better ones.
const HOUSE_WORDS: [(&str, &str); 14] = [
    ("so many", "this many, N, a number of"),
    ("is none of", "is not"),
    ("are none of", "are not"),
    ("told apart", "distinguished"),
    ("told from", "distinguished from"),
    ("is told of", "is called with, is informed of"),
    ("is told so", "is named"),
    ("seen of it", "its symptom, its measurement"),
    ("whoever", "a program that, anyone who"),
    ("in the place of", "instead of"),
    ("as ever", "as usual, unchanged"),
    ("slip of the pen", "accidental edit"),
    ("behind the point", "after the point"),
    ("reader knows", "say what the file is"),
];

#[test]
fn the_field_s_words_are_used_and_no_house_words() {
    let is_read = |path: &Path| {
        let extension = path.extension().and_then(|extension| extension.to_str());
        extension.is_some_and(|extension| ["rs", "md", "toml", "py", "m", "hpp", "cpp", "sh"].contains(&extension))
    };
    let mut tree = Vec::new();
    for folder in ["src", "tests", "benches", "spec", "python"] {
        tree.extend(files(folder, &is_read));
    }
    tree.extend(read(&root().join("README.md")));
    assert!(tree.len() > 300, "the tree was read");
    let mut found = Vec::new();
    for file in tree {
        // This file names the phrases, and the drafts of published problems have the words that were published.
        if file.path == "tests/style.rs" || file.path.starts_with("tests/published/") {
            continue;
        }
        for (line, text) in (1..).zip(file.text.lines()) {
            for (phrase, better) in house_words(text) {
                found.push(format!("{}:{line}: \"{phrase}\"; better: {better}", file.path));
            }
        }
    }
    assert!(found.is_empty(), "\n{}", found.join("\n"));
    assert_eq!(house_words("So many lines wait; nobody was as everyone.").len(), 1);
}

/// The house words of a line: whole words, in capitals or not.
fn house_words(line: &str) -> Vec<(&'static str, &'static str)> {
    let line = line.to_lowercase();
    let is_word = |c: Option<char>| c.is_some_and(char::is_alphanumeric);
    let stands_in = |phrase: &str| {
        line.match_indices(phrase).any(|(at, _)| {
            !is_word(line[..at].chars().next_back()) && !is_word(line[at + phrase.len()..].chars().next())
        })
    };
    HOUSE_WORDS
        .into_iter()
        .filter(|(phrase, _)| stands_in(phrase))
        .collect()
}

#[test]
fn every_file_of_tests_has_its_row_in_maintaining() {
    let page = read(&root().join("spec/maintaining.md")).unwrap().text;
    let rows: BTreeSet<&str> = page
        .lines()
        .filter_map(|line| line.strip_prefix("| `")?.split_once("` |"))
        .map(|(name, _)| name)
        .filter(|name| Path::new(name).extension().is_some_and(|extension| extension == "rs"))
        .collect();
    let tests = rust("tests");
    let names: BTreeSet<&str> = tests
        .iter()
        .filter_map(|file| file.path.strip_prefix("tests/"))
        .filter(|name| !name.contains('/'))
        .collect();
    let lacking: Vec<&&str> = names.difference(&rows).collect();
    assert!(lacking.is_empty(), "spec/maintaining.md has no row for {lacking:?}");
    let gone: Vec<&&str> = rows.difference(&names).collect();
    assert!(
        gone.is_empty(),
        "spec/maintaining.md has a row for {gone:?}, and there is no such file"
    );
}

#[test]
fn code_is_told_from_comments_and_text() {
    let code = without_comments_and_text(concat!(
        "let a = \"π // no comment \\\" still text\"; // π\n",
        "let b: &'static str = r\"π\"; /* π\n π */ let c = 'π'; let d = '\\'';\n",
    ));
    assert_eq!(
        code,
        "let a = \"\"; \nlet b: &'static str = r\"\";  let c = ' '; let d = ' ';\n"
    );
    let text = "impl A {\n    pub fn short() {}\n    fn longer<T>(\n        a: T,\n    ) {\n        a\n    }\n}\n";
    assert_eq!(functions(text), [("short".to_owned(), 1), ("longer".to_owned(), 5)]);
}

// How the tree is read

struct File {
    path: String,
    text: String,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> Option<File> {
    Some(File {
        text: std::fs::read_to_string(path).ok()?,
        path: path.strip_prefix(root()).ok()?.display().to_string().replace('\\', "/"),
    })
}

/// The text files of a folder that is there, in the order of their paths.
fn files(folder: &str, wanted: &dyn Fn(&Path) -> bool) -> Vec<File> {
    let mut folders = vec![root().join(folder)];
    let mut paths: Vec<PathBuf> = Vec::new();
    while let Some(folder) = folders.pop() {
        let Ok(entries) = std::fs::read_dir(folder) else {
            continue;
        };
        for path in entries.map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                // What a build leaves beside its sources is not of the tree.
                folders.extend(Some(path).filter(|path| path.file_name().is_none_or(|name| name != "target")));
            } else if wanted(&path) {
                paths.push(path);
            }
        }
    }
    paths.sort();
    paths.iter().filter_map(|path| read(path)).collect()
}

fn rust(folder: &str) -> Vec<File> {
    files(folder, &|path| {
        path.extension().is_some_and(|extension| extension == "rs")
    })
}

/// The functions of a file with their numbers of lines, from `fn` to the closing brace at the same indentation.
fn functions(text: &str) -> Vec<(String, usize)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    for (start, line) in lines.iter().enumerate() {
        let code = line.trim_start();
        let indentation = &line[..line.len() - code.len()];
        let Some(name) = [
            "fn ",
            "pub fn ",
            "pub(super) fn ",
            "pub(crate) fn ",
            "const fn ",
            "pub const fn ",
        ]
        .iter()
        .find_map(|words| code.strip_prefix(words)) else {
            continue;
        };
        let name = &name[..name.find(['(', '<']).unwrap_or(name.len())];
        let closing = format!("{indentation}}}");
        let last = lines[start..].iter().position(|line| *line == closing);
        let is_one_line = code.ends_with(['}', ';']);
        let length = last.filter(|_| !is_one_line).map_or(1, |last| last + 1);
        found.push((name.to_owned(), length));
    }
    found
}

/// A file without its comments, and with nothing in its quotes.
fn without_comments_and_text(text: &str) -> String {
    let mut code = String::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        if rest.starts_with("//") {
            rest = &rest[rest.find('\n').unwrap_or(rest.len())..];
        } else if rest.starts_with("/*") {
            rest = &rest[rest.find("*/").map_or(rest.len(), |end| end + 2)..];
        } else if let Some(raw) = raw_text(rest) {
            code.push_str("r\"\"");
            rest = &rest[raw..];
        } else if c == '"' {
            code.push_str("\"\"");
            rest = &rest[quoted(rest)..];
        } else if let Some(length) = character(rest) {
            code.push_str("' '");
            rest = &rest[length..];
        } else {
            code.push(c);
            rest = &rest[c.len_utf8()..];
        }
    }
    code
}

/// The length of a raw string at the start of a text.
fn raw_text(text: &str) -> Option<usize> {
    let hashes = text.strip_prefix('r')?.chars().take_while(|c| *c == '#').count();
    let body = text[1 + hashes..].strip_prefix('"')?;
    let end = format!("\"{}", "#".repeat(hashes));
    Some(text.len() - body.len() + body.find(&end)? + end.len())
}

/// The length of a string at the start of a text.
fn quoted(text: &str) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return at + 1,
            _ => {}
        }
    }
    text.len()
}

/// The length of a character in quotes at the start of a text; a lifetime is none.
fn character(text: &str) -> Option<usize> {
    let body = text.strip_prefix('\'')?;
    let first = body.chars().next()?;
    let inner = if first == '\\' {
        body[2..].find('\'')? + 2
    } else {
        first.len_utf8()
    };
    body[inner..].starts_with('\'').then_some(inner + 2)
}
