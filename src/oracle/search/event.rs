//! The events of a random problem: detections, misses, outliers, and the situations that every filter must handle.
//!
//! Measurements are drawn around the filter's own predictions, step by step. Each situation that is added to a scene leaves its flag in
//! the problem, so that they can be counted.

use super::draw::{Draw, leading_identity, rounded, rounded_to_spread};
use super::scene::Offer;
use crate::imm::Quantity;
use crate::model::angle::wrap;
use crate::number::Real;
use crate::oracle::models::ModelParameters;
use crate::oracle::problem::{FORMAT_2, FilterFile, MeasurementFile, ProblemFile, Rows, SensorFile};
use crate::oracle::run::run_in_doubles;

/// Puts behaviours on a problem, and measurements into it; nothing if it cannot be run.
pub(super) fn happen(draw: &mut Draw, mut problem: ProblemFile, offer: &Offer) -> Option<ProblemFile> {
    if problem.modes.len() > 1 {
        close_paths(draw, &mut problem);
    }
    if is_of_matrices(&problem) && draw.happens(0.1) {
        in_other_units(draw, &mut problem);
    }
    if offer.is_format_2 {
        change(draw, &mut problem);
    }
    let misses = if draw.happens(0.3) { 0.4 } else { 0.0 };
    let misled = if draw.happens(0.12) { 0.4 } else { 0.0 };
    let lacks = offer.is_format_2 && draw.happens(0.1);
    for step in 0..problem.measurements.len() {
        if draw.happens(misses) {
            flag(&mut problem, "missed-detection");
            continue;
        }
        let is_outlier = draw.happens(misled);
        see(draw, &mut problem, step, is_outlier)?;
    }
    if lacks {
        lose_entries(draw, &mut problem);
    }
    if offer.is_format_2 && draw.happens(0.15) {
        know_truth(draw, &mut problem)?;
    }
    Some(problem)
}

fn flag(problem: &mut ProblemFile, flag: &str) {
    if !problem.flags.iter().any(|own| own == flag) {
        problem.flags.push(flag.to_owned());
    }
}

/// Whether motions and measurement are matrices.
fn is_of_matrices(problem: &ProblemFile) -> bool {
    matches!(problem.measurement, MeasurementFile::Linear { .. }) && has_matrices(problem)
}

/// Whether motions are matrices.
fn has_matrices(problem: &ProblemFile) -> bool {
    problem.modes.iter().all(|mode| !mode.transition.is_empty())
}

/// Sometimes no mode leads to one of them, or one mode to another, or a mode has no probability at first.
fn close_paths(draw: &mut Draw, problem: &mut ProblemFile) {
    let r = problem.modes.len();
    let (to, all) = (draw.below(r), draw.happens(0.12));
    if all || draw.happens(0.1) {
        let one = draw.below(r);
        for (from, row) in problem.transition.iter_mut().enumerate() {
            if all || from == one {
                close(row, to);
            }
        }
        flag(problem, if all { "unreachable" } else { "absorbing" });
    }
    if draw.happens(0.08) {
        close(&mut problem.initial.mode_probabilities, draw.below(r));
    }
}

/// Gives the probability at a place to its neighbour.
fn close(row: &mut [f64], place: usize) {
    let neighbour = (place + 1) % row.len();
    row[neighbour] = rounded(row[neighbour] + row[place], 3);
    row[place] = 0.0;
}

/// One component of the state in units that are a million times as large or small.
fn in_other_units(draw: &mut Draw, problem: &mut ProblemFile) {
    let (i, factor) = (
        draw.below(problem.state.len()),
        if draw.happens(0.5) { 1e6 } else { 1e-6 },
    );
    let of = |index: usize| if index == i { factor } else { 1.0 };
    let scale = |rows: &mut Rows, by: &dyn Fn(usize, usize) -> f64| {
        for (row, entries) in rows.iter_mut().enumerate() {
            for (column, entry) in entries.iter_mut().enumerate() {
                *entry = rounded(*entry * by(row, column), 6);
            }
        }
    };
    for mode in &mut problem.modes {
        scale(&mut mode.transition, &|row, column| of(row) / of(column));
        scale(&mut mode.noise, &|row, column| of(row) * of(column));
    }
    if let MeasurementFile::Linear { matrix } = &mut problem.measurement {
        scale(matrix, &|_, column| of(column).recip());
    }
    if let FilterFile::FixedGain { modes, .. } = &mut problem.filter {
        for mode in modes {
            scale(&mut mode.gain, &|row, _| of(row));
        }
    }
    for estimate in &mut problem.initial.modes {
        estimate.mean[i] = rounded(estimate.mean[i] * factor, 6);
        estimate
            .covariance
            .iter_mut()
            .for_each(|rows| scale(rows, &|row, column| of(row) * of(column)));
    }
    flag(problem, "units");
}

/// What format 2 adds: inputs, steps that differ, a second sensor.
fn change(draw: &mut Draw, problem: &mut ProblemFile) {
    let before = problem.flags.len();
    if has_matrices(problem) && draw.happens(0.08) {
        add_input(draw, problem);
    }
    if draw.happens(0.15) {
        vary_steps(draw, problem);
    }
    if draw.happens(0.15)
        && !matches!(
            problem.filter,
            FilterFile::FixedGain { .. } | FilterFile::Converted { .. }
        )
        && !problem.has_correlated_noises()
    {
        add_sensor(draw, problem);
    }
    if problem.flags.len() > before {
        FORMAT_2.clone_into(&mut problem.format);
    }
}

/// F as formulas, with an input: x(k) = F x(k−1) + g u.
fn add_input(draw: &mut Draw, problem: &mut ProblemFile) {
    let names: Vec<String> = problem.state.iter().map(|component| component.name.clone()).collect();
    problem.parameters = ModelParameters(vec![("u0".to_owned(), rounded(draw.between(0.5, 3.0), 2))]);
    for mode in &mut problem.modes {
        let of_row = |entries: &Vec<f64>| {
            let terms: Vec<String> = entries
                .iter()
                .zip(&names)
                .map(|(entry, name)| format!("({entry:?})*{name}"))
                .collect();
            format!("{} + ({:?})*u0", terms.join(" + "), rounded(draw.between(-2.0, 2.0), 2))
        };
        mode.models.formulas = Some(mode.transition.iter().map(of_row).collect());
        mode.transition = Rows::new();
    }
    flag(problem, "input");
    flag(problem, "formulas");
}

/// F, Q, R, H and the chain become others in some steps; where motions know how long a step is, it is another in each.
fn vary_steps(draw: &mut Draw, problem: &mut ProblemFile) {
    let has_matrices = has_matrices(problem);
    let by = |rows: &Rows, factor: f64| -> Rows {
        let row = |entries: &Vec<f64>| entries.iter().map(|entry| rounded(entry * factor, 4)).collect();
        rows.iter().map(row).collect()
    };
    let (modes, noise, measurement) = (
        problem.modes.clone(),
        problem.noise.clone(),
        problem.measurement.clone(),
    );
    let has_length = problem.parameters.get("T").is_some();
    for entry in &mut problem.measurements {
        let mut factor = || {
            draw.one_of(&[0.5_f64, 1.0, 1.5, 2.0])
                .filter(|factor| (*factor - 1.0).abs() > 0.0)
        };
        if has_length {
            entry.interval = Some(rounded(draw.between(0.3, 1.5), 1));
        } else if has_matrices {
            entry.transitions = factor().map(|factor| {
                modes
                    .iter()
                    .map(|mode| by(&mode.transition, 0.8 + factor / 8.0))
                    .collect()
            });
            entry.noises = factor().map(|factor| modes.iter().map(|mode| by(&mode.noise, factor)).collect());
        }
        let mut factor = || {
            draw.one_of(&[0.5_f64, 1.0, 1.5, 2.0])
                .filter(|factor| (*factor - 1.0).abs() > 0.0)
        };
        entry.noise = factor().map(|factor| by(&noise, factor));
        if let (MeasurementFile::Linear { matrix }, Some(factor)) = (&measurement, factor()) {
            entry.matrix = Some(by(matrix, factor));
        }
        if modes.len() > 1 && draw.happens(0.3) {
            entry.transition = Some((0..modes.len()).map(|i| draw.probabilities(modes.len(), i)).collect());
        }
    }
    flag(problem, "changing-steps");
}

/// A second sensor, of one number or two, that sees in some steps.
fn add_sensor(draw: &mut Draw, problem: &mut ProblemFile) {
    let (m, n) = (1 + draw.below(2), problem.state.len());
    let mut matrix = leading_identity(m, n);
    for entry in matrix.iter_mut().flatten() {
        *entry = rounded(*entry + draw.between(-0.3, 0.3), 2);
    }
    let deviations = draw.deviations(m, 1.0, 4.0);
    problem.sensors = vec![SensorFile {
        name: "second".to_owned(),
        measurement: MeasurementFile::Linear { matrix },
        noise: draw.covariance(&deviations),
    }];
    for entry in &mut problem.measurements {
        if draw.happens(0.5) {
            entry.sensor = Some("second".to_owned());
            (entry.matrix, entry.noise) = (None, None);
        }
    }
    flag(problem, "several-sensors");
}

/// Draws the measurement of a step, counted from 0, about what one of the modes predicts: within some standard deviations of the
/// innovation, or a thousand away. Nothing if the steps before cannot be run.
pub(super) fn see(draw: &mut Draw, problem: &mut ProblemFile, step: usize, is_outlier: bool) -> Option<()> {
    let (centre, deviations) = predicted(draw, problem, step)?;
    let sensors = problem.sensors_at();
    let sensor = &sensors[problem.sensor_of(&problem.measurements[step])?];
    let (angles, ranges) = (problem.angles_of(sensor), problem.ranges_of(sensor));
    let width = if draw.happens(0.15) { 4.0 } else { 1.0 };
    let mut z = Vec::with_capacity(centre.len());
    for (index, (centre, deviation)) in centre.iter().zip(&deviations).enumerate() {
        let mut value = centre + width * deviation * draw.normal();
        let is_angle = angles.get(index) == Some(&true);
        if is_angle {
            value = wrap(value);
            // Beyond the cut is another word for the same direction.
            if value.abs() > 3.0 && draw.happens(0.2) {
                value -= 2.0 * f64::pi() * value.signum();
            }
        } else if is_outlier {
            value += 1000.0 * deviation;
        }
        if ranges.get(index) == Some(&true) {
            value = value.abs();
        }
        z.push(Some(rounded_to_spread(value, *deviation)));
    }
    problem.measurements[step].z = Some(z);
    if is_outlier {
        flag(problem, "outlier");
    }
    Some(())
}

/// What a mode predicts of a measurement, and how far that spreads.
fn predicted(draw: &mut Draw, problem: &ProblemFile, step: usize) -> Option<(Vec<f64>, Vec<f64>)> {
    let mut beginning = problem.clone();
    beginning.measurements.truncate(step + 1);
    let m = *problem.dimensions().m.get(step)?;
    beginning.measurements[step].z = Some(vec![Some(0.0); m]);
    if matches!(beginning.filter, FilterFile::Converted { .. }) {
        // A converted measurement is not the range and bearing that points predict.
        let rule = "cubature-3".to_owned();
        beginning.filter = FilterFile::Cubature { rule };
    }
    let (trace, _) = run_in_doubles(&beginning).ok()?;
    let mode = draw.below(problem.modes.len());
    let centre = trace.finite(step + 1, Quantity::PredictedMeasurement, mode)?.clone();
    let covariance = trace.finite(step + 1, Quantity::InnovationCovariance, mode)?;
    let deviations = (0..m).map(|row| Real::sqrt(&covariance[row * (m + 1)]));
    Some((centre, deviations.collect()))
}

/// Some measurements of several numbers lack one of them.
fn lose_entries(draw: &mut Draw, problem: &mut ProblemFile) {
    if matches!(
        problem.filter,
        FilterFile::Converted { .. } | FilterFile::FixedGain { .. }
    ) {
        return;
    }
    for step in 0..problem.measurements.len() {
        let Some(z) = problem.measurements[step].z.as_mut().filter(|z| z.len() > 1) else {
            continue;
        };
        if draw.happens(0.6) {
            let lost = draw.below(z.len());
            z[lost] = None;
            flag(problem, "missing-entry");
            FORMAT_2.clone_into(&mut problem.format);
        }
    }
}

/// The true states, within some standard deviations of the estimates. Filters with fixed gains have none to be compared with.
fn know_truth(draw: &mut Draw, problem: &mut ProblemFile) -> Option<()> {
    if matches!(problem.filter, FilterFile::FixedGain { .. }) {
        return Some(());
    }
    let (trace, _) = run_in_doubles(problem).ok()?;
    let n = problem.state.len();
    for entry in &mut problem.measurements {
        let mean = trace.finite(entry.step, Quantity::CombinedMean, 0)?;
        let covariance = trace.finite(entry.step, Quantity::CombinedCovariance, 0)?;
        let near = |i: usize| {
            let deviation = Real::sqrt(&covariance[i * (n + 1)]);
            rounded_to_spread(mean[i] + deviation * draw.normal(), deviation)
        };
        entry.truth = Some((0..n).map(near).collect());
    }
    FORMAT_2.clone_into(&mut problem.format);
    Some(())
}
