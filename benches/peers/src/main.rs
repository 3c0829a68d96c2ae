//! One step of an interacting multiple model filter: this crate, others, and hand-written programs, interleaved in one process.
//!
//! ```text
//! cargo run --release                       the table: least and median time, ratio to this crate in the same round, who is right
//! cargo run --release -- growth             how the plain cycle grows with modes, components and points
//! cargo run --release -- only NAME TASK K   one contender alone, K runs, for a profiler; TASK counts from 0
//! ```
//!
//! All run the same measurements in turn, a round each. What is compared is the ratio in the same round: what else the machine does
//! slows both. A contender is right if its last estimate is that of this crate's recorded cycle but for rounding.

#[cfg(has_c)]
mod c;
mod contender;
mod cycle;
mod growth;
mod ours;
mod rust;
mod scenario;

use contender::{Contender, Outcome, Run, Task};
use scenario::STEPS;

/// Rounds of a table: enough that the median of the ratios repeats within two per cent.
const ROUNDS: usize = 101;

/// The greatest difference of two right programs after the run, in mode probabilities, and in parts of the position's deviation of 40 m:
/// rounding of 200 steps stays a thousand times below it, and no wrong equation that is known comes near it.
const ROUNDING: f64 = 1e-8;

fn contenders(task: Task) -> Vec<Contender> {
    let mut all = vec![];
    let mut add = |name, run: Run| all.push(Contender { name, run });
    add("immaculate, plain", ours::plain(task));
    add("immaculate, every value recorded", ours::recorded(task));
    match task {
        Task::Kalman => {
            add("nalgebra, by hand", rust::plain_nalgebra());
            add("typed-kalman 0.1.1 in a loop", rust::typed_kalman_linear());
            add("oxictl 0.1.1", rust::oxictl());
        }
        Task::Cubature3 => add("numeris 0.6.0 in a loop", rust::numeris(task)),
        Task::Unscented => {
            add("numeris 0.6.0 in a loop", rust::numeris(task));
            add("typed-kalman 0.1.1 in a loop", rust::typed_kalman_unscented());
        }
        Task::Cubature5 => {}
    }
    #[cfg(has_c)]
    add("C, by hand", c::run(task));
    all
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => Task::ALL.into_iter().for_each(table),
        ["growth"] => growth::tables(),
        ["only", name, task, runs] => only(
            name,
            task.parse().expect("TASK is 0 to 3"),
            runs.parse().expect("K is a number"),
        ),
        _ => panic!("nothing, `growth`, or `only NAME TASK K`"),
    }
}

/// One contender, alone.
fn only(name: &str, task: usize, runs: usize) {
    let measurements = Task::ALL[task].sensor().measurements();
    let mut found = contenders(Task::ALL[task])
        .into_iter()
        .filter(|contender| contender.name.contains(name));
    let mut contender = found.next().expect("a name of the table");
    for _ in 0..runs {
        (contender.run)(&measurements);
    }
}

/// All contenders of one task.
fn table(task: Task) {
    let measurements = task.sensor().measurements();
    let mut contenders = contenders(task);
    let mut times = vec![vec![]; contenders.len()];
    let mut outcomes = vec![];
    for _ in 0..ROUNDS {
        outcomes.clear();
        for (contender, times) in contenders.iter_mut().zip(&mut times) {
            (contender.run)(&measurements[..20]); // its code and data are in the caches
            let (seconds, outcome) = (contender.run)(&measurements);
            times.push(seconds / STEPS as f64 * 1e9);
            outcomes.push(outcome);
        }
    }
    println!("\n{}, three modes, n = 4, m = 2", task.name());
    println!(
        "{:<34} {:>8} {:>10} {:>16}   right",
        "", "least ns", "median ns", "ratio (quartiles)"
    );
    for (place, contender) in contenders.iter().enumerate() {
        let ratios = times[place]
            .iter()
            .zip(&times[0])
            .map(|(time, ours)| time / ours)
            .collect();
        let ([least, _, median, _], [_, low, ratio, high]) = (quartiles(times[place].clone()), quartiles(ratios));
        let verdict = verdict(&outcomes[place], &outcomes[0]);
        println!(
            "{:<34} {least:>8.0} {median:>10.0}   {ratio:.2} ({low:.2}–{high:.2})   {verdict}",
            contender.name
        );
    }
}

/// The least, the first quartile, the median, and the third quartile.
fn quartiles(mut values: Vec<f64>) -> [f64; 4] {
    values.sort_by(f64::total_cmp);
    let last = values.len() - 1;
    [values[0], values[last / 4], values[last / 2], values[3 * last / 4]]
}

fn verdict(outcome: &Outcome, ours: &Outcome) -> String {
    let probabilities = outcome.mode_probabilities.iter().zip(&ours.mode_probabilities);
    let of_probabilities = probabilities.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let of_mean = (outcome.mean - ours.mean).amax();
    if of_probabilities.max(of_mean / 40.0) < ROUNDING {
        return "yes".to_owned();
    }
    format!("no: mode probabilities off by {of_probabilities:.1e}, mean by {of_mean:.1e}")
}
