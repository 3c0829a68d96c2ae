//! Goal: what `immaculate init` writes is right as it stands, and what is there already is left alone.
//!
//! Method: the program is run and its files are held against the templates; the filter in Rust is part of this file and is checked on all
//! cases that it declares, as a process. Those in other languages are checked by `tests/adapters/run.sh`, where their tools are. Kind of
//! evidence: behaviour, and oracle for the filter.

mod common;
#[path = "adapters/templates/rust/main.rs"]
mod my_filter;

use common::program::{error_of, immaculate, names};
use std::path::{Path, PathBuf};

/// The files of each language, beside the template's folder.
const WRITTEN: [(&str, &[(&str, &str)]); 3] = [
    (
        "python",
        &[("my_filter.py", "tests/adapters/templates/python/my_filter.py")],
    ),
    (
        "cpp",
        &[
            ("main.cpp", "tests/adapters/templates/cpp/main.cpp"),
            ("CMakeLists.txt", "tests/adapters/templates/cpp/CMakeLists.txt"),
            ("immaculate.hpp", "tests/adapters/cpp/immaculate.hpp"),
        ],
    ),
    (
        "rust",
        &[
            ("src/main.rs", "tests/adapters/templates/rust/main.rs"),
            ("Cargo.toml", "tests/adapters/templates/rust/manifest.toml"),
        ],
    ),
];

#[test]
fn init_writes_the_templates_and_says_what_comes_next() {
    for (language, files) in WRITTEN {
        let folder = folder(language);
        let text = written(language, &folder);
        for (name, template) in files {
            assert_eq!(read(&folder.join(name)), read(&root().join(template)), "{name}");
            assert!(text.contains(&format!("  {}\n", folder.join(name).display())), "{text}");
            assert!(!name.ends_with("main.cpp") || read(&folder.join(name)).contains("CHANGE HERE"));
        }
        let (_, next) = text.split_once("NEXT\n").unwrap();
        assert!(
            next.contains(&format!("cd '{}'", folder.display())) && next.contains("immaculate check"),
            "{text}"
        );
    }
    let folder = folder("octave");
    written("octave", &folder);
    assert_eq!(names(&folder), ["+immaculate", "my_filter.m"]);
    assert_eq!(
        names(&folder.join("+immaculate")),
        names(&root().join("tests/adapters/octave/+immaculate"))
    );
}

#[test]
fn init_overwrites_nothing() {
    let folder = folder("in the way");
    std::fs::create_dir_all(&folder).unwrap();
    // The last file that would be written is in the way: no other is written either.
    std::fs::write(folder.join("immaculate.hpp"), "mine").unwrap();
    let output = immaculate(&["init", "cpp", folder.to_str().unwrap()]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        error_of(&output).contains("immaculate.hpp exists already"),
        "{}",
        error_of(&output)
    );
    assert_eq!(names(&folder), ["immaculate.hpp"]);
    assert_eq!(read(&folder.join("immaculate.hpp")), "mine");
    // A file where the folder should be.
    let file = folder.join("immaculate.hpp");
    let output = immaculate(&["init", "python", file.to_str().unwrap()])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(read(&file), "mine");
}

#[test]
fn a_language_that_is_not_there_is_named_beside_those_that_are() {
    let output = immaculate(&["init", "fortran"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        error_of(&output).contains("python, cpp, octave, rust"),
        "{}",
        error_of(&output)
    );
}

#[test]
fn the_filter_in_rust_is_right_on_all_that_it_declares() {
    // The process is this test binary: it runs the template's `main` in the test below.
    let this = std::env::current_exe().unwrap();
    let this = this.to_str().unwrap();
    // Quietly: the harness would write the test's name before the first message, on the same line.
    let program = [
        this,
        "--ignored",
        "--exact",
        "the_filter_in_rust_itself",
        "--nocapture",
        "--quiet",
    ];
    let arguments = [&["check", "--"], &program[..]].concat();
    let output = immaculate(&arguments).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{text}");
    assert!(
        text.contains("RIGHT on what was judged: my filter, double precision: "),
        "{text}"
    );
    // None is skipped or drowned: all of them are right.
    let words: Vec<&str> = text.split_whitespace().collect();
    let is_all = |four: &[&str]| four[0] == four[3] && four[1..3] == ["right", "of"];
    assert!(words.windows(4).any(is_all), "{text}");
}

#[test]
#[ignore = "the program under test, which reads from standard input"]
fn the_filter_in_rust_itself() {
    my_filter::main();
}

/// What the program says of the files that it writes.
fn written(language: &str, folder: &Path) -> String {
    let output = immaculate(&["init", language, folder.to_str().unwrap()])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", error_of(&output));
    String::from_utf8(output.stdout).unwrap()
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A folder that is not there yet.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("init {name}"));
    let _ = std::fs::remove_dir_all(&folder);
    folder
}
