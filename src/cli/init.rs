//! `immaculate init`: writes a small filter that passes `immaculate check`, with its adapter, for users to replace with their own filter.
//!
//! An existing file is never touched. The templates are in `tests/adapters/templates/`; the files that they need stand beside it.

use super::search::quoted;
use super::{Done, Refusal, make_directory, write_file};
use clap::{Args, ValueEnum};
use std::fmt::Write;
use std::path::{Path, PathBuf};

#[derive(Clone, Copy, ValueEnum)]
enum Language {
    /// `my_filter.py`, with numpy
    Python,
    /// `main.cpp`, with Eigen, and the header that talks to Immaculate
    Cpp,
    /// `my_filter.m`, and the package `+immaculate`; not tried with MATLAB
    Octave,
    /// `src/main.rs`, with nalgebra
    Rust,
}

/// Writes a correct textbook filter with the adapter through which Immaculate talks to it. CHANGE HERE marks the place for your own
/// filter.
#[derive(Args)]
#[command(
    after_help = "It prints the commands to run next. An existing file is never overwritten: nothing is written then, and the exit status is 2."
)]
pub struct InitArguments {
    #[arg(value_enum)]
    language: Language,
    /// The folder; it is created if needed
    #[arg(value_name = "DIR", default_value = ".")]
    folder: PathBuf,
}

const HEADER: &str = include_str!("../../tests/adapters/cpp/immaculate.hpp");

/// The files of the package for Octave; each is a function.
macro_rules! octave_package {
    ($($name:literal),* $(,)?) => {
        [$((
            concat!("+immaculate/", $name),
            include_str!(concat!("../../tests/adapters/octave/+immaculate/", $name)),
        )),*]
    };
}
const OCTAVE: [(&str, &str); 9] = octave_package![
    "cells.m",
    "compare.m",
    "is_asked.m",
    "read_problem.m",
    "run_folder.m",
    "run_problem.m",
    "step_of.m",
    "test_folder.m",
    "write_answer.m",
];

impl Language {
    /// The files by their paths in the folder.
    fn files(self) -> Vec<(&'static str, &'static str)> {
        match self {
            Self::Python => vec![(
                "my_filter.py",
                include_str!("../../tests/adapters/templates/python/my_filter.py"),
            )],
            Self::Cpp => vec![
                ("main.cpp", include_str!("../../tests/adapters/templates/cpp/main.cpp")),
                (
                    "CMakeLists.txt",
                    include_str!("../../tests/adapters/templates/cpp/CMakeLists.txt"),
                ),
                ("immaculate.hpp", HEADER),
            ],
            Self::Octave => {
                let mut files = vec![(
                    "my_filter.m",
                    include_str!("../../tests/adapters/templates/octave/my_filter.m"),
                )];
                files.extend(OCTAVE);
                files
            }
            Self::Rust => vec![
                (
                    "src/main.rs",
                    include_str!("../../tests/adapters/templates/rust/main.rs"),
                ),
                (
                    "Cargo.toml",
                    include_str!("../../tests/adapters/templates/rust/manifest.toml"),
                ),
            ],
        }
    }

    /// The commands to run next, in the folder.
    fn commands(self) -> &'static [&'static str] {
        match self {
            Self::Python => &["immaculate check -- python3 my_filter.py"],
            Self::Cpp => &[
                "cmake -B build && cmake --build build",
                "immaculate check -- build/my_filter",
            ],
            Self::Octave => &[
                "immaculate cases copy problems",
                "octave-cli --eval \"immaculate.run_folder('problems', 'answers', my_filter())\"",
                "immaculate check --answers answers",
            ],
            Self::Rust => &["cargo build --release", "immaculate check -- target/release/my_filter"],
        }
    }
}

pub fn run(arguments: &InitArguments) -> Result<Done, Refusal> {
    let (folder, language) = (&arguments.folder, arguments.language);
    let files = language.files();
    for (name, _) in &files {
        let path = folder.join(name);
        // A link that leads nowhere is something, too.
        if path.symlink_metadata().is_ok() {
            let path = path.display();
            return Err(Refusal::request(format!(
                "{path} exists already and is not overwritten; give another folder"
            )));
        }
    }
    let mut text = String::from("WRITTEN\n");
    for (name, content) in &files {
        let path = folder.join(name);
        if let Some(parent) = path.parent() {
            make_directory(parent)?;
        }
        write_file(&path, content)?;
        let _ = writeln!(text, "  {}", path.display());
    }
    text.push_str("\nNEXT\n");
    if folder != Path::new(".") {
        let _ = writeln!(text, "  cd {}", quoted(&folder.display().to_string()));
    }
    for command in language.commands() {
        let _ = writeln!(text, "  {command}");
    }
    text.push_str("\nThe filter is right as it stands. Replace the part marked CHANGE HERE with your own.\n");
    Ok(text.into())
}
