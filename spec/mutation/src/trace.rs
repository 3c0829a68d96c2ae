//! Runs each test once, alone, and writes down how long it takes and which mutants it reaches.

use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeSet;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A test, as the unmutated program passes it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Test {
    pub binary: PathBuf,
    /// The file of `tests/` without its ending.
    pub file: String,
    pub name: String,
    pub seconds: f64,
    /// The first ids of the sites that it reaches.
    pub sites: BTreeSet<usize>,
}

/// How a test ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    Passed,
    Failed,
    OutOfTime,
}

/// Files whose tests read the sources as text and so cannot see a mutant; they would only cost time.
const READERS: [&str; 2] = ["style", "traceability"];

/// What is known of the tests.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Traced {
    pub tests: Vec<Test>,
    /// Those that did not end in the time that they were given, as `file::name`.
    pub too_slow: BTreeSet<String>,
    /// Those that fail without a mutant.
    pub failing: BTreeSet<String>,
}

/// What a test is called in the results.
pub fn title(file: &str, name: &str) -> String {
    format!("{file}::{name}")
}

/// Writes `tests.json`: what it does not have yet of these files of tests, or of all, each test within a time limit.
pub fn trace(work: &Path, seconds: f64, files: &[&str]) -> Result<(), String> {
    let tree = work.join("tree");
    let mut traced: Traced = crate::read_json(&work.join("tests.json")).unwrap_or_default();
    let known: BTreeSet<String> = traced.tests.iter().map(|test| title(&test.file, &test.name)).collect();
    let path = work.join("reached");
    for (file, binary) in binaries(&tree, files)? {
        for test in traced.tests.iter_mut().filter(|test| test.file == file) {
            test.binary.clone_from(&binary);
        }
        if READERS.contains(&file.as_str()) {
            continue;
        }
        for name in names(&binary)? {
            let title = title(&file, &name);
            if known.contains(&title) {
                continue;
            }
            let _ = std::fs::remove_file(&path);
            let start = Instant::now();
            let mut command = command(&tree, &binary, &name);
            command.env("MUTANT_TRACE", &path);
            let end = run(&mut command, Duration::from_secs_f64(seconds))?;
            let seconds = start.elapsed().as_secs_f64();
            println!("{title}: {end:?} in {seconds:.2} s");
            traced.too_slow.remove(&title);
            traced.failing.remove(&title);
            match end {
                End::Passed => {
                    let sites = reached(&path);
                    traced.tests.push(Test {
                        binary: binary.clone(),
                        file: file.clone(),
                        name,
                        seconds,
                        sites,
                    });
                }
                End::OutOfTime => {
                    traced.too_slow.insert(title);
                }
                End::Failed => {
                    traced.failing.insert(title);
                }
            }
        }
        crate::write_json(&work.join("tests.json"), &traced)?;
    }
    Ok(())
}

/// The test binaries of the copy, of these files or of all.
fn binaries(tree: &Path, files: &[&str]) -> Result<Vec<(String, PathBuf)>, String> {
    let mut chosen: Vec<&str> = files.iter().flat_map(|file| ["--test", file]).collect();
    if chosen.is_empty() {
        chosen.push("--tests");
    }
    let output = Command::new("cargo")
        .args(["test", "--no-run", "--message-format=json"])
        .args(chosen)
        .current_dir(tree)
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| error.to_string())?;
    let found = String::from_utf8_lossy(&output.stdout)
        .lines()
        .filter_map(|line| serde_json::from_str::<Value>(line).ok())
        .filter(|value| value["target"]["kind"][0] == "test")
        .filter_map(|value| {
            Some((
                value["target"]["name"].as_str()?.to_owned(),
                value["executable"].as_str()?.into(),
            ))
        })
        .collect();
    if output.status.success() {
        Ok(found)
    } else {
        Err("the tests of the copy do not build".into())
    }
}

fn names(binary: &Path) -> Result<Vec<String>, String> {
    let output = Command::new(binary)
        .args(["--list", "--format=terse"])
        .output()
        .map_err(|error| error.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    Ok(text
        .lines()
        .filter_map(|line| line.strip_suffix(": test"))
        .map(str::to_owned)
        .collect())
}

/// One test in a process of its own. Random tests do not look for the smallest counterexample, snapshots are only compared, and a
/// mutant that fills the memory is stopped.
pub fn command(tree: &Path, binary: &Path, name: &str) -> Command {
    let mut command = Command::new("sh");
    command
        .args(["-c", "ulimit -v 8000000; exec nice -n 19 \"$0\" --exact \"$1\""])
        .arg(binary)
        .arg(name)
        .current_dir(tree)
        .env("PROPTEST_MAX_SHRINK_ITERS", "0")
        .env("PROPTEST_DISABLE_FAILURE_PERSISTENCE", "true")
        .env("INSTA_UPDATE", "no")
        .env("INSTA_WORKSPACE_ROOT", tree)
        .env("RUST_BACKTRACE", "0")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .process_group(0);
    command
}

/// Waits for a test; what it has started ends with it.
pub fn run(command: &mut Command, limit: Duration) -> Result<End, String> {
    let start = Instant::now();
    let mut child = command.spawn().map_err(|error| error.to_string())?;
    let mut pause = Duration::from_micros(500);
    loop {
        if let Some(status) = child.try_wait().map_err(|error| error.to_string())? {
            return match status.code() {
                Some(0) => Ok(End::Passed),
                // The shell's words for a program that is not there or cannot be started.
                Some(126 | 127) => Err("a test binary cannot be started; trace its file again".into()),
                _ => Ok(End::Failed),
            };
        }
        if start.elapsed() > limit {
            let group = format!("-{}", child.id());
            let _ = Command::new("kill").args(["-KILL", "--", &group]).status();
            let _ = child.wait();
            return Ok(End::OutOfTime);
        }
        std::thread::sleep(pause);
        pause = (pause * 2).min(Duration::from_millis(20));
    }
}

fn reached(path: &Path) -> BTreeSet<usize> {
    let bytes = std::fs::read(path).unwrap_or_default();
    bytes
        .chunks_exact(4)
        .map(|four| u32::from_le_bytes([four[0], four[1], four[2], four[3]]) as usize)
        .collect()
}
