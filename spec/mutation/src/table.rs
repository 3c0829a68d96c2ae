//! The score of each room, and what survived.

use crate::mutant::{self, Build, Mutant};
use crate::run::{self, Outcome, Verdict};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// What became of the mutants of a room.
#[derive(Default, Clone, Copy)]
struct Score {
    mutants: usize,
    unviable: usize,
    not_chosen: usize,
    compile: usize,
    run: usize,
    caught: usize,
    out_of_time: usize,
    survived: usize,
}

/// Prints the table, and the survivors with the number of tests that passed.
pub fn table(work: &Path) -> Result<(), String> {
    let mutants: Vec<Mutant> = crate::read_json(&work.join("mutants.json"))?;
    let rooms: BTreeSet<&str> = mutants.iter().map(|mutant| mutant::room(&mutant.file)).collect();
    println!(
        "| room | mutants | do not compile | not chosen | compile | run | caught | of these out of time | survived | of those run, caught |"
    );
    println!(
        "|------|---------|----------------|------------|---------|-----|--------|----------------------|----------|----------------------|"
    );
    let mut survivors = Vec::new();
    let mut all = Score::default();
    for room in rooms {
        let verdicts = run::read(&work.join(format!("results-{room}.jsonl")));
        let mut score = Score::default();
        for mutant in mutants.iter().filter(|mutant| mutant::room(&mutant.file) == room) {
            for score in [&mut score, &mut all] {
                score.add(mutant, &verdicts);
            }
            if let Some(verdict) = verdicts.get(&mutant.name).filter(|verdict| is_survivor(verdict)) {
                survivors.push(format!("{:>4} tests  {}", verdict.passed.len(), mutant.name));
            }
        }
        score.print(room);
    }
    all.print("all");
    println!();
    for survivor in survivors {
        println!("{survivor}");
    }
    Ok(())
}

/// A mutant that no test has tried is none.
fn is_survivor(verdict: &Verdict) -> bool {
    !matches!(verdict.outcome, Outcome::Caught | Outcome::OutOfTime) && !verdict.passed.is_empty()
}

impl Score {
    fn add(&mut self, mutant: &Mutant, verdicts: &BTreeMap<String, Verdict>) {
        self.mutants += 1;
        match mutant.build {
            Build::Unviable(_) => self.unviable += 1,
            Build::NotChosen(_) => self.not_chosen += 1,
            Build::In => self.compile += 1,
        }
        let Some(verdict) = verdicts.get(&mutant.name) else {
            return;
        };
        let is_caught = matches!(verdict.outcome, Outcome::Caught | Outcome::OutOfTime);
        self.caught += usize::from(is_caught);
        self.out_of_time += usize::from(verdict.outcome == Outcome::OutOfTime);
        self.survived += usize::from(is_survivor(verdict));
        self.run += usize::from(is_caught || is_survivor(verdict));
    }

    fn print(&self, room: &str) {
        let Self {
            mutants,
            unviable,
            not_chosen,
            compile,
            run,
            caught,
            out_of_time,
            survived,
        } = self;
        let thousandths = (1000 * caught + run / 2) / (*run).max(1);
        let share = format!("{}.{} %", thousandths / 10, thousandths % 10);
        println!(
            "| `{room}` | {mutants} | {unviable} | {not_chosen} | {compile} | {run} | {caught} | {out_of_time} | {survived} | {share} |"
        );
    }
}
