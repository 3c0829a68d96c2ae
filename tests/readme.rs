//! The README tells the truth: its commands print what it shows.
//!
//! Method: each `console` block is a command and an excerpt of its output; every line of the excerpt must occur in the output, in that
//! order, spaces aside. The Rust block is run with the documentation's examples.

use std::process::Command;

#[test]
fn the_commands_of_the_readme_print_what_it_shows() {
    let readme = include_str!("../README.md");
    let blocks = readme
        .split("```console\n")
        .skip(1)
        .map(|rest| rest.split("```").next().unwrap());
    let mut compared = 0;
    for block in blocks {
        let mut lines = block.lines();
        let command = lines.next().unwrap();
        let Some(arguments) = command.strip_prefix("$ cargo run --release -- ") else {
            assert_eq!(command, "$ cargo test", "an unknown command in the README");
            continue;
        };
        let output = Command::new(env!("CARGO_BIN_EXE_immaculate"))
            .args(arguments.split(' '))
            .output()
            .unwrap();
        assert!(output.status.success());
        let output = String::from_utf8(output.stdout).unwrap();
        let mut printed = output.lines().map(without_spaces);
        for line in lines.filter(|line| !line.trim().is_empty()) {
            let shown = without_spaces(line);
            assert!(
                printed.any(|printed| printed == shown),
                "`{command}` does not print, or not in this place:\n{line}"
            );
            compared += 1;
        }
    }
    assert!(compared > 5, "the README shows the output of a command");
}

fn without_spaces(line: &str) -> String {
    line.split_whitespace().collect::<Vec<_>>().join(" ")
}
