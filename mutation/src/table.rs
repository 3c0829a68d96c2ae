//! The score of each room, and what survived.

use crate::mutant::{self, Build, Mutant};
use crate::run::{self, Outcome};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Prints both.
pub fn table(work: &Path) -> Result<(), String> {
    let mutants: Vec<Mutant> = crate::read_json(&work.join("mutants.json"))?;
    let rooms: BTreeSet<&str> = mutants.iter().map(|mutant| mutant::room(&mutant.file)).collect();
    println!("| room | mutants | do not compile | not chosen | run | caught | out of time | survived | open | not reached |");
    println!("|------|---------|----------------|------------|-----|--------|-------------|----------|------|-------------|");
    let mut alive = Vec::new();
    let mut sum = [0; 9];
    for room in rooms {
        let verdicts = run::read(&work.join(format!("results-{room}.jsonl")));
        let of_room: Vec<&Mutant> = mutants.iter().filter(|mutant| mutant::room(&mutant.file) == room).collect();
        let mut outcomes: BTreeMap<Outcome, usize> = BTreeMap::new();
        for verdict in of_room.iter().filter_map(|mutant| verdicts.get(&mutant.name)) {
            *outcomes.entry(verdict.outcome).or_default() += 1;
            if !matches!(verdict.outcome, Outcome::Caught | Outcome::OutOfTime) {
                alive.push(format!("{:?}  {}", verdict.outcome, verdict.name));
            }
        }
        let count = |wanted: fn(&Build) -> bool| of_room.iter().filter(|mutant| wanted(&mutant.build)).count();
        let of = |outcome| outcomes.get(&outcome).copied().unwrap_or(0);
        let row = [
            of_room.len(),
            count(|build| matches!(build, Build::Unviable(_))),
            count(|build| matches!(build, Build::NotChosen(_))),
            outcomes.values().sum(),
            of(Outcome::Caught),
            of(Outcome::OutOfTime),
            of(Outcome::Survived),
            of(Outcome::Open),
            of(Outcome::NotReached),
        ];
        print_row(room, &row);
        for (total, value) in sum.iter_mut().zip(row) {
            *total += value;
        }
    }
    print_row("all", &sum);
    println!();
    for line in alive {
        println!("{line}");
    }
    Ok(())
}

fn print_row(room: &str, row: &[usize]) {
    let cells: Vec<String> = row.iter().map(ToString::to_string).collect();
    println!("| {room} | {} |", cells.join(" | "));
}
