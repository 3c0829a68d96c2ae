//! Runs the mutants of a room against the tests that reach them, until one fails.
//!
//! The order: mutants in steps through the room, so that an interrupted run is a systematic sample; tests by the number of mutants of the
//! same file that they have caught per second, so that the likeliest comes first.

use crate::mutant::{self, Build, Mutant};
use crate::trace::{self, End, Test, Traced};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::io::Write;
use std::path::Path;
use std::time::Duration;

/// What the tests say of a mutant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Outcome {
    Caught,
    /// A test did not end in ten times its time; that is noticed, too.
    OutOfTime,
    /// All tests that reach it passed.
    Survived,
    /// Those tests that were tried passed; the others would have taken longer than was given.
    Open,
    /// No test reaches it.
    NotReached,
}

/// A line of the results: what became of a mutant.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Verdict {
    pub name: String,
    pub outcome: Outcome,
    /// The test that noticed.
    pub by: Option<String>,
    /// The tests that passed.
    pub passed: BTreeSet<String>,
}

const STEP: usize = 16;

/// Runs the mutants of a room that have no verdict yet, or one that is open, with a number of seconds of tests for each.
pub fn run(work: &Path, room: &str, seconds: f64) -> Result<(), String> {
    let mutants: Vec<Mutant> = crate::read_json(&work.join("mutants.json"))?;
    let Traced { tests, too_slow, .. } = crate::read_json(&work.join("tests.json"))?;
    // A file of tests that is being built again can look at its mutants later.
    let (tests, gone): (Vec<Test>, Vec<Test>) = tests.into_iter().partition(|test| test.binary.exists());
    let is_partial = !too_slow.is_empty() || !gone.is_empty();
    let path = work.join(format!("results-{room}.jsonl"));
    let mut verdicts = read(&path);
    let mut skill: HashMap<(String, usize), (f64, f64)> = HashMap::new();
    learn(&verdicts, &mutants, &tests, &mut skill);
    let of_room: Vec<&Mutant> = mutants
        .iter()
        .filter(|mutant| mutant.build == Build::In && mutant::room(&mutant.file) == room)
        .collect();
    let mut file = std::fs::OpenOptions::new()
        .create(true)
        .append(true)
        .open(&path)
        .map_err(|e| e.to_string())?;
    let order = (0..STEP).map(|start| start.reverse_bits() >> (usize::BITS - STEP.trailing_zeros()));
    for mutant in order.flat_map(|start| of_room.iter().skip(start).step_by(STEP)) {
        let known = verdicts.get(&mutant.name);
        if known.is_some_and(|verdict| verdict.outcome != Outcome::Open && verdict.outcome != Outcome::NotReached) {
            continue;
        }
        let passed = known.map(|verdict| verdict.passed.clone()).unwrap_or_default();
        let mut verdict = judge(&work.join("tree"), mutant, &tests, passed, seconds, &mut skill)?;
        if is_partial && matches!(verdict.outcome, Outcome::Survived | Outcome::NotReached) {
            verdict.outcome = Outcome::Open;
        }
        let line = serde_json::to_string(&verdict).map_err(|error| error.to_string())?;
        writeln!(file, "{line}").map_err(|error| error.to_string())?;
        if !matches!(verdict.outcome, Outcome::Caught | Outcome::OutOfTime) {
            println!(
                "{:?} after {} tests: {}",
                verdict.outcome,
                verdict.passed.len(),
                verdict.name
            );
        }
        verdicts.insert(mutant.name.clone(), verdict);
    }
    Ok(())
}

/// The last verdict on each mutant in a file of results.
pub fn read(path: &Path) -> BTreeMap<String, Verdict> {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    text.lines()
        .filter_map(|line| serde_json::from_str::<Verdict>(line).ok())
        .map(|verdict| (verdict.name.clone(), verdict))
        .collect()
}

fn title(test: &Test) -> String {
    trace::title(&test.file, &test.name)
}

/// What earlier verdicts say of the tests.
fn learn(
    verdicts: &BTreeMap<String, Verdict>,
    mutants: &[Mutant],
    tests: &[Test],
    skill: &mut HashMap<(String, usize), (f64, f64)>,
) {
    let numbers: HashMap<String, usize> = tests
        .iter()
        .enumerate()
        .map(|(number, test)| (title(test), number))
        .collect();
    for mutant in mutants {
        let Some(verdict) = verdicts.get(&mutant.name) else {
            continue;
        };
        if let Some(number) = verdict.by.as_ref().and_then(|by| numbers.get(by)) {
            let entry = skill.entry((mutant.file.clone(), *number)).or_default();
            *entry = (entry.0 + 1.0, entry.1 + 1.0);
        }
        for number in verdict.passed.iter().filter_map(|passed| numbers.get(passed)) {
            skill.entry((mutant.file.clone(), *number)).or_default().1 += 1.0;
        }
    }
}

/// Runs the tests that reach a mutant.
fn judge(
    tree: &Path,
    mutant: &Mutant,
    tests: &[Test],
    mut passed: BTreeSet<String>,
    mut seconds: f64,
    skill: &mut HashMap<(String, usize), (f64, f64)>,
) -> Result<Verdict, String> {
    let verdict = |outcome, by, passed| Verdict {
        name: mutant.name.clone(),
        outcome,
        by,
        passed,
    };
    let mut reaching: Vec<(f64, usize)> = Vec::new();
    for (number, test) in tests
        .iter()
        .enumerate()
        .filter(|(_, test)| test.sites.contains(&mutant.site))
    {
        let (caught, tried) = skill.get(&(mutant.file.clone(), number)).copied().unwrap_or_default();
        // A test that reaches less is more about what it reaches.
        let narrow = 100.0 / (100.0 + test.sites.len() as f64);
        let chance = (caught + narrow) / (tried + 1.0);
        reaching.push((chance / (test.seconds + 0.01), number));
    }
    if reaching.is_empty() {
        return Ok(verdict(Outcome::NotReached, None, passed));
    }
    reaching.sort_by(|one, other| other.0.total_cmp(&one.0));
    let mut is_open = false;
    for (_, number) in reaching {
        let test = &tests[number];
        if passed.contains(&title(test)) {
            continue;
        }
        if test.seconds > seconds {
            is_open = true;
            continue;
        }
        seconds -= test.seconds;
        let mut command = trace::command(tree, &test.binary, &test.name);
        command.env("MUTANT", mutant.id.to_string());
        let end = trace::run(&mut command, Duration::from_secs_f64(5.0 + 10.0 * test.seconds))?;
        let entry = skill.entry((mutant.file.clone(), number)).or_default();
        entry.1 += 1.0;
        match end {
            End::Passed => passed.insert(title(test)),
            End::Failed | End::OutOfTime => {
                entry.0 += 1.0;
                let outcome = if end == End::Failed {
                    Outcome::Caught
                } else {
                    Outcome::OutOfTime
                };
                return Ok(verdict(outcome, Some(title(test)), passed));
            }
        };
    }
    Ok(verdict(
        if is_open { Outcome::Open } else { Outcome::Survived },
        None,
        passed,
    ))
}
