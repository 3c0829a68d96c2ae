//! `immaculate stability`: are two fixed-gain filters stable together when they mix their estimates?
//!
//! Noises lead to a verdict with its proof. Proofs are written, checked again, and drawn as a map.

use super::progress::bar;
use super::{Done, Refusal, json_text, make_directory, read_file, write_file};
use clap::Args;
use immaculate::report::{stability, stability_map};
use immaculate::steady::certificate_file::{CertificateFile, FiltersFile, Noises};
use immaculate::steady::map::Map;
use immaculate::steady::verdict::Depth;
use std::path::PathBuf;

/// Without arguments: the filters of derbez2000's figures 1 and 2.
#[derive(Args)]
#[command(
    after_help = "Exit status: 0 an answer was given (undecided is one), 1 a certificate that was checked proves nothing, 2 bad input."
)]
pub struct StabilityArguments {
    /// The scan time t, s
    #[arg(long, value_name = "T", default_value = "2", allow_negative_numbers = true)]
    interval: String,
    /// The variance R of the measured position, m²
    #[arg(long, value_name = "R", default_value = "0.05", allow_negative_numbers = true)]
    measurement_noise: String,
    /// The variance q_v of the acceleration in the constant velocity model, (m/s²)²
    #[arg(long, value_name = "Q", default_value = "5", allow_negative_numbers = true)]
    velocity_noise: String,
    /// The variance q_a of the change of acceleration in the constant acceleration model, (m/s²)²
    #[arg(long, value_name = "Q", default_value = "5", allow_negative_numbers = true)]
    acceleration_noise: String,
    /// In place of noises: the damping roots √(1 − α) of the two filters, as fractions or decimals between 0 and 1
    #[arg(
        long, num_args = 2, value_names = ["V", "A"], allow_negative_numbers = true,
        conflicts_with_all = ["interval", "measurement_noise", "velocity_noise", "acceleration_noise"]
    )]
    roots: Option<Vec<String>>,
    /// In place of noises: the fixed-gain filters of a problem file, any number of modes and components (`-` for standard input)
    #[arg(
        long, value_name = "FILE",
        conflicts_with_all = ["roots", "interval", "measurement_noise", "velocity_noise", "acceleration_noise", "certificate", "check", "map"]
    )]
    problem: Option<PathBuf>,
    /// Write the certificate to this file
    #[arg(long, value_name = "FILE")]
    certificate: Option<PathBuf>,
    /// Check a certificate file and say what it proves
    #[arg(long, value_name = "FILE", conflicts_with_all = ["map", "roots", "certificate"])]
    check: Option<PathBuf>,
    /// Draw the map over the tracking indices of the two filters
    #[arg(long, conflicts_with_all = ["roots", "certificate"])]
    map: bool,
    /// Points a side of the map
    #[arg(long, value_name = "N", default_value_t = 49, value_parser = clap::value_parser!(u16).range(2..=1000))]
    points: u16,
    /// The map goes from 10 to this power …
    #[arg(long, value_name = "E", default_value_t = -3, value_parser = clap::value_parser!(i8).range(-6..=6), allow_negative_numbers = true)]
    from: i8,
    /// … to this one
    #[arg(long, value_name = "E", default_value_t = 3, value_parser = clap::value_parser!(i8).range(-6..=6), allow_negative_numbers = true)]
    to: i8,
    /// The longest product that is tried letter by letter
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u8).range(1..=26))]
    word: u8,
    /// The longest memory of the forms that are tried, letters
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u8).range(0..=8))]
    memory: u8,
    /// Write the map as JSON, CSV and SVG to this directory
    #[arg(long, value_name = "DIR", requires = "map")]
    out: Option<PathBuf>,
    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &StabilityArguments) -> Result<Done, Refusal> {
    if let Some(path) = &arguments.check {
        return check(path, arguments.json);
    }
    if arguments.map {
        return map(arguments);
    }
    if let Some(path) = &arguments.problem {
        return super::stability_bank::run(path, depth(arguments), arguments.json);
    }
    let (filters_file, about) = described(arguments);
    let filters = filters_file.filters().map_err(Refusal::request)?;
    let (depth, units) = (depth(arguments), filters_file.units().map_err(Refusal::request)?);
    let answer = stability::StabilityAnswer::new(&filters, units, depth, filters.decide(depth));
    let certificate = CertificateFile::new(about.clone(), filters_file, &answer.verdict);
    if let Some(path) = &arguments.certificate {
        let Some(certificate) = &certificate else {
            return Err(Refusal::request(
                "there is no certificate to write: the filters are undecided",
            ));
        };
        write_file(path, &json_text(&serde_json::json!(certificate)))?;
    }
    let text = if arguments.json {
        json_text(&stability::json(&about, &answer, certificate.as_ref()))
    } else {
        stability::text(&about, &answer)
    };
    Ok(text.into())
}

fn depth(arguments: &StabilityArguments) -> Depth {
    Depth {
        word: arguments.word.into(),
        memory: arguments.memory.into(),
        ..Depth::default()
    }
}

/// The filters that the arguments name, as a certificate has them, and in words.
fn described(arguments: &StabilityArguments) -> (FiltersFile, String) {
    if let Some([v, a]) = arguments.roots.as_deref() {
        let about = format!(
            "Two fixed-gain filters with the damping roots {v} (constant velocity) and {a} (constant acceleration)."
        );
        return (FiltersFile::DampingRoots([v.clone(), a.clone()]), about);
    }
    let noises = Noises {
        interval: arguments.interval.clone(),
        measurement: arguments.measurement_noise.clone(),
        constant_velocity: arguments.velocity_noise.clone(),
        constant_acceleration: arguments.acceleration_noise.clone(),
    };
    let about = format!(
        "Two fixed-gain filters of derbez2000: t = {} s, R = {} m², q_v = {} and q_a = {} (m/s²)².",
        noises.interval, noises.measurement, noises.constant_velocity, noises.constant_acceleration
    );
    (FiltersFile::Noises(noises), about)
}

/// Checks a certificate file.
fn check(path: &std::path::Path, json: bool) -> Result<Done, Refusal> {
    let text = read_file(path)?;
    let named = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let file = CertificateFile::read(&text).map_err(|error| Refusal::request(named(&error)))?;
    match file.check() {
        Ok(verdict) if json => {
            let value = serde_json::json!({ "about": file.about, "proves": stability::verdict_word(&verdict) });
            Ok(json_text(&value).into())
        }
        Ok(verdict) => Ok(format!("{}\nproven {}\n", file.about, stability::verdict_word(&verdict)).into()),
        Err(error) => Err(Refusal::Output(named(&error))),
    }
}

fn map(arguments: &StabilityArguments) -> Result<Done, Refusal> {
    if arguments.from >= arguments.to {
        return Err(Refusal::request("`--from` must be below `--to`"));
    }
    if let Some(directory) = &arguments.out {
        make_directory(directory)?;
    }
    let side = usize::from(arguments.points);
    let bar = bar(side * side, "deciding {wide_bar} {pos}/{len} points, {eta} left");
    let decades = [f64::from(arguments.from), f64::from(arguments.to)];
    let map = Map::new(side, decades, depth(arguments), &|| bar.inc(1));
    bar.finish_and_clear();
    if let Some(directory) = &arguments.out {
        let picture = stability_map::draw(&map).map_err(|error| Refusal::Output(error.to_string()))?;
        let files = [
            ("stability-map.json", json_text(&stability::map_json(&map))),
            ("stability-map.csv", stability::map_csv(&map)),
            ("stability-map.svg", picture),
        ];
        for (name, content) in files {
            write_file(&directory.join(name), &content)?;
        }
    }
    let text = if arguments.json {
        json_text(&stability::map_json(&map))
    } else {
        stability::map_text(&map)
    };
    Ok(text.into())
}
