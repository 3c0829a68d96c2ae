//! Copies the tree, writes the mutants into the copy, and takes out what the compiler refuses until it builds.

use crate::instrument::Instrumented;
use crate::mutant::{self, Build, Listed, Mutant};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Where the instrumented sources are in the copy, at the same depth as `src`, so that relative paths stay right.
const SOURCES: &str = "instrumented";

/// Makes the copy and its list of mutants, `mutants.json`.
pub fn prepare(tree: &Path, work: &Path) -> Result<(), String> {
    let listed = mutant::list(tree)?;
    println!("{} mutants listed", listed.len());
    let copy = work.join("tree");
    copy_tree(tree, &copy)?;
    let mut refused: HashMap<String, Build> = crate::read_json(&work.join("refused.json")).unwrap_or_default();
    for round in 1.. {
        let mutants = write_sources(tree, &copy, &listed, &refused)?;
        let errors = check(&copy)?;
        println!("round {round}: {} errors", errors.len());
        if errors.is_empty() {
            return crate::write_json(&work.join("mutants.json"), &mutants);
        }
        let before = refused.len();
        let mut unknown = BTreeSet::new();
        for error in &errors {
            refuse(&copy, error, &mutants, &mut refused, &mut unknown);
        }
        crate::write_json(&work.join("refused.json"), &refused)?;
        for error in unknown.iter().take(20) {
            println!("  no mutant stands at {error}");
        }
        if refused.len() == before {
            return Err("these errors are of no mutant".into());
        }
    }
    Ok(())
}

fn copy_tree(tree: &Path, copy: &Path) -> Result<(), String> {
    let files = Command::new("git")
        .args(["ls-files"])
        .current_dir(tree)
        .output()
        .map_err(|error| error.to_string())?;
    for file in String::from_utf8_lossy(&files.stdout)
        .lines()
        .filter(|file| *file != "Cargo.toml")
    {
        let to = copy.join(file);
        write(
            &to,
            &std::fs::read(tree.join(file)).map_err(|error| format!("{file}: {error}"))?,
        )?;
    }
    let manifest = std::fs::read_to_string(tree.join("Cargo.toml")).map_err(|error| error.to_string())?;
    let mut manifest: toml::Table = manifest.parse().map_err(|error| format!("Cargo.toml: {error}"))?;
    let text = format!(
        "[lib]\npath = \"{SOURCES}/lib.rs\"\n[[bin]]\nname = \"immaculate\"\npath = \"{SOURCES}/main.rs\"\n\
         [lints.rust]\nwarnings = \"allow\"\narithmetic_overflow = \"allow\"\nunconditional_panic = \"allow\"\n\
         overflowing_literals = \"allow\"\nunconditional_recursion = \"allow\"\n"
    );
    let changes: toml::Table = text.parse().map_err(|error| format!("the change: {error}"))?;
    manifest.extend(changes);
    write(&copy.join("Cargo.toml"), manifest.to_string().as_bytes())
}

/// Writes a file if it is another one, so that what did not change is not built again.
fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    if std::fs::read(path).is_ok_and(|old| old == bytes) {
        return Ok(());
    }
    let done = std::fs::create_dir_all(path.parent().unwrap_or(path)).and_then(|()| std::fs::write(path, bytes));
    done.map_err(|error| format!("{}: {error}", path.display()))
}

fn write_sources(
    tree: &Path,
    copy: &Path,
    listed: &[Listed],
    refused: &HashMap<String, Build>,
) -> Result<Vec<Mutant>, String> {
    let mut by_file: BTreeMap<&str, Vec<&Listed>> = BTreeMap::new();
    for mutant in listed {
        by_file.entry(&mutant.file).or_default().push(mutant);
    }
    let mut mutants = Vec::new();
    let mut waiting = vec![tree.join("src")];
    let mut paths: Vec<PathBuf> = Vec::new();
    while let Some(folder) = waiting.pop() {
        for entry in std::fs::read_dir(&folder).map_err(|error| error.to_string())? {
            let path = entry.map_err(|error| error.to_string())?.path();
            if path.is_dir() {
                waiting.push(path)
            } else {
                paths.push(path)
            }
        }
    }
    paths.sort();
    for path in paths {
        let name = path
            .strip_prefix(tree)
            .map_err(|error| error.to_string())?
            .display()
            .to_string();
        let to = copy.join(name.replacen("src", SOURCES, 1));
        let text = std::fs::read_to_string(&path).map_err(|error| format!("{name}: {error}"))?;
        if path.extension().is_none_or(|extension| extension != "rs") {
            write(&to, text.as_bytes())?;
            continue;
        }
        let syntax = syn::parse_file(&text).map_err(|error| format!("{name}: {error}"))?;
        let of_file = by_file.get(name.as_str()).map_or(&[][..], |list| list.as_slice());
        let next = mutants.last().map_or(0, |mutant: &Mutant| mutant.id);
        let mut file = Instrumented::new(&text, of_file, next, refused);
        syn::visit::visit_file(&mut file, &syntax);
        let (mut text, found) = file.finish();
        mutants.extend(found);
        if name == "src/lib.rs" {
            text.push_str("\npub mod chosen;\nextern crate self as immaculate;\n");
        }
        write(&to, text.as_bytes())?;
    }
    write(&copy.join(SOURCES).join("chosen.rs"), include_bytes!("chosen.rs"))?;
    Ok(mutants)
}

/// The compiler's errors.
fn check(copy: &Path) -> Result<Vec<Value>, String> {
    let output = Command::new("cargo")
        .args(["check", "--lib", "--bins", "--message-format=json"])
        .current_dir(copy)
        .output()
        .map_err(|error| error.to_string())?;
    let errors: Vec<Value> = String::from_utf8_lossy(&output.stdout)
        .lines()
        .filter_map(|line| serde_json::from_str::<Value>(line).ok())
        .filter(|value| value["reason"] == "compiler-message" && value["message"]["level"] == "error")
        .map(|value| value["message"].clone())
        .filter(|message| message["spans"].as_array().is_some_and(|spans| !spans.is_empty()))
        .collect();
    if errors.is_empty() && !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    Ok(errors)
}

/// Takes out the mutant at which an error stands; the whole site where the error is at the text that is not mutated.
fn refuse(
    copy: &Path,
    error: &Value,
    mutants: &[Mutant],
    refused: &mut HashMap<String, Build>,
    unknown: &mut BTreeSet<String>,
) {
    let sentence = error["message"].as_str().unwrap_or_default().to_owned();
    let empty = Vec::new();
    let spans = error["spans"].as_array().unwrap_or(&empty);
    let (primary, other): (Vec<&Value>, Vec<&Value>) = spans.iter().partition(|span| span["is_primary"] == true);
    let mut sites = Vec::new();
    for mut span in primary.iter().copied().chain(other) {
        while !span["expansion"].is_null() {
            span = &span["expansion"]["span"];
        }
        let file = span["file_name"].as_str().unwrap_or_default();
        let Ok(text) = std::fs::read_to_string(copy.join(file)) else {
            continue;
        };
        let lines: Vec<&str> = text.lines().collect();
        let (start, end) = (number(&span["line_start"]), number(&span["line_end"]));
        for line in &lines[start.saturating_sub(1)..end.min(lines.len())] {
            if let Some(id) = marker(line, "/*#") {
                if let Some(mutant) = mutants.iter().find(|mutant| mutant.id == id) {
                    refused.insert(mutant.name.clone(), Build::Unviable(sentence));
                }
                return;
            }
            sites.extend(marker(line, "/*@"));
        }
    }
    if let Some(site) = sites.first() {
        for mutant in mutants
            .iter()
            .filter(|mutant| mutant.site == *site && mutant.build == Build::In)
        {
            refused.insert(mutant.name.clone(), Build::NotChosen(sentence.clone()));
        }
        return;
    }
    let place = primary.first().map_or(String::new(), |span| {
        format!("{}:{}", span["file_name"], span["line_start"])
    });
    unknown.insert(format!("{place}: {sentence}"));
}

fn number(value: &Value) -> usize {
    value
        .as_u64()
        .and_then(|value| usize::try_from(value).ok())
        .unwrap_or(0)
}

/// The number in a comment of a line.
fn marker(line: &str, mark: &str) -> Option<usize> {
    let rest = &line[line.find(mark)? + mark.len()..];
    rest[..rest.find("*/")?].parse().ok()
}
